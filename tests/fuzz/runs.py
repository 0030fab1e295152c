"""Damaged programs run without a screen, into every output: a status of the four, and whole files, whatever they do."""

from __future__ import annotations

import csv
import io
import json
from contextlib import suppress
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING
from unittest.mock import patch
from zlib import crc32

import numpy as np

from desire_tui.batch.headless_listener import HeadlessListener
from desire_tui.batch.runner import ENDING_SECONDS, Runner, RunOptions
from desire_tui.engine.diagnostics import DesireError, render_all
from desire_tui.engine.outputs.formats import DATA, PICTURES
from desire_tui.engine.outputs.picture_options import FOR_PAPER
from desire_tui.engine.outputs.text_plot import text_plot
from desire_tui.engine.source import Source
from tests.fuzz.corpus import texts
from tests.fuzz.mutations import mutated

if TYPE_CHECKING:
    from random import Random
    from threading import Thread

STATUS = frozenset({"done", "failed", "stopped", "limit"})
SECONDS = 0.5
_PATIENCE = 60.0
_PICTURE_EVERY = 24


class _Runner(Runner):
    """Notes what a program goes on to compute after it was asked to end: on a busy machine that takes longer."""

    work_to_end = 0.0
    """Processor time, seconds."""

    def _end(self, thread: Thread, key: str, **facts: object) -> None:
        before = process_time()
        super()._end(thread, key, **facts)
        self.work_to_end = process_time() - before


def generate(rng: Random) -> str:
    """Return a damaged program."""
    return mutated(rng.choice(texts()), rng)


def check(text: str) -> None:
    """Run it, write every format of data, now and then a picture."""
    chance = crc32(text.encode("utf-8", "surrogatepass"))
    listener = HeadlessListener(lambda _: None, iter(["1", "x", "", "2.5"]), lambda _: None)
    options = RunOptions(
        timeout=SECONDS,
        folder=Path.cwd(),
        answer_stops=chance % 2 == 0,
        backend="reference" if chance % 5 == 0 else "native",
    )
    runner = _Runner(Source(text, "program.src"), options, listener)
    with patch("desire_tui.batch.runner.ENDING_SECONDS", _PATIENCE):
        runner.run()
    assert not runner.abandoned, "it did not end when it was asked to"
    assert runner.work_to_end < ENDING_SECONDS, "it went on when it was asked to end"
    assert runner.status in STATUS
    assert "Traceback" not in render_all(runner.problems)
    assert runner.status != "failed" or runner.problems
    result = runner.result()
    for data in DATA:
        file = io.StringIO() if data.is_text else io.BytesIO()
        data.write(result, file)
        file.seek(0)
        _READ[data.name](file)
    if runner.session.graph is not None:
        if chance % 3 == 0:
            text_plot(runner.session.graph, 80, 24, colored=chance % 2 == 0)
        if chance % _PICTURE_EVERY == 0:
            picture = PICTURES[chance // _PICTURE_EVERY % len(PICTURES)]
            with suppress(DesireError):  # a graph may be too large to draw
                assert picture.content(runner.session.graph, FOR_PAPER)


def _read_csv(file: io.StringIO) -> None:
    rows = list(csv.reader(file))
    assert len({len(row) for row in rows}) <= 1, "rows of different lengths"


def _read_json(file: io.StringIO) -> None:
    json.load(file, parse_constant=_no_number)


def _no_number(word: str) -> None:
    raise AssertionError(f"{word} is not JSON")


def _read_npz(file: io.BytesIO) -> None:
    with np.load(file, allow_pickle=False) as arrays:
        for name in arrays.files:
            assert arrays[name].dtype != object


def _read_parquet(file: io.BytesIO) -> None:
    from pyarrow import parquet

    parquet.read_table(file)


def _read_netcdf(file: io.BytesIO) -> None:
    from scipy.io import netcdf_file

    with netcdf_file(file, mmap=False) as data:
        assert all(variable[:].shape == variable.shape for variable in data.variables.values())


_READ = {
    "csv": _read_csv, "json": _read_json, "npz": _read_npz, "parquet": _read_parquet, "netcdf": _read_netcdf,
}  # fmt: skip
