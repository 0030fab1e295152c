"""What `plain_words` reads without click is what click reads; what it does not read is click's."""

from __future__ import annotations

import contextlib
import io
import sys

import click
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui import __main__, plain_words
from desire_tui.cli import check, run

FILES = ["a.src", "-", "b=c.src", "s t.src", "--", "run", ""]
NUMBERS = ["0", "1", "2.5", "-3", "nan", "inf", "1e400", "150", "9", "x", "", "1_0", " 4"]
VALUES = [
    "8x5",
    "6×4",
    "99x99",
    "paper",
    "Screen",
    "screen",
    "native",
    "out.csv",
    "-",
    "a=3",
    "v[2]=3",
    "A=1,2;3,4",
    "a=b",
    *NUMBERS,
]
OPTIONS = sorted({word for command in (run, check) for option in command.params for word in option.opts})
WORDS = st.one_of(
    st.sampled_from(FILES + VALUES + OPTIONS + ["--he", "-j4", "--help", "-x", "--quie", "--plot=1"]),
    st.tuples(st.sampled_from(OPTIONS), st.sampled_from(VALUES)).map("=".join),
)
COMMAND_LINES = st.lists(
    st.one_of(
        WORDS.map(lambda word: [word]), st.tuples(st.sampled_from(OPTIONS), st.sampled_from(VALUES)).map(list)
    ),
    max_size=5,
).map(lambda parts: [word for part in parts for word in part])


def read_by_click(command: click.Command, words: list[str]) -> dict | None:
    """Return the parameters; None: usage is wrong, or something else is asked for."""
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            return command.make_context(command.name, list(words)).params
    except (click.UsageError, click.exceptions.Exit):
        return None


@pytest.mark.parametrize(
    ("command", "read"), [(run, plain_words.run_words), (check, plain_words.check_words)]
)
@given(words=COMMAND_LINES)
@settings(max_examples=60, deadline=None)
def test_both_read_the_same(command, read, words):
    found = read(words)
    if found is not None:
        files, options = found
        assert {"files": files, **options} == read_by_click(command, words)


@pytest.mark.parametrize(
    "option", [o for o in run.params if isinstance(o, click.Option)], ids=lambda o: o.name
)
def test_every_option_of_run_is_read_without_click(option):
    value = {"jobs": "2", "size": "6x4", "dpi": "300", "style": "paper", "settings": "a=3", "timeout": "5",
             "backend": "reference"}.get(option.name, "f")  # fmt: skip
    words = ["p.src", option.opts[0], *([] if option.is_flag else [value])]
    found = plain_words.run_words(words)
    assert found is not None
    assert {"files": found[0], **found[1]} == read_by_click(run, words)


def test_every_flag_of_check_is_read_without_click():
    for option in check.params[1:]:
        assert plain_words.check_words(["p.src", option.opts[0]]) is not None


@pytest.mark.parametrize(
    "words",
    [["run"], ["run", "--help"], ["check", "--json", "--sarif", "a.src"], ["run", "a.src", "--dpi", "1"]],
)
def test_the_rest_is_click_s(words):
    assert plain_words.obey(words) is None


def test_what_cannot_be_meant_together_is_said_by_click(tmp_path, capsys):
    program = tmp_path / "p.src"
    program.write_text("x = 1\n")
    with pytest.raises(SystemExit) as end:
        __main__.main(["run", str(program), "--csv", "-", "--json", "-"])
    assert end.value.code == 2
    assert "only one file can go to standard output" in capsys.readouterr().err


def test_the_command_does_not_import_click(tmp_path, monkeypatch, capsys):
    program = tmp_path / "p.src"
    program.write_text("write 3\n")
    monkeypatch.setitem(sys.modules, "desire_tui.cli", None)
    with pytest.raises(SystemExit) as end:
        __main__.main(["run", str(program), "--quiet"])
    assert (end.value.code, capsys.readouterr().out) == (0, "")
