"""One list says what can be written; texts that name the formats follow it."""

from __future__ import annotations

import inspect
from pathlib import Path

import pytest

import desire_tui
from desire_tui.cli import run
from desire_tui.commands import BY_ID
from desire_tui.engine.diagnostics.wording import wording_of
from desire_tui.engine.outputs.formats import CSV, FORMATS, PICTURES, PNG, endings

PAGES = Path(inspect.getfile(desire_tui)).parent / "help" / "pages"


def test_every_format_is_an_option_of_desire_run():
    options = {parameter.name: parameter for parameter in run.params}
    for known in FORMATS:
        assert options[known.name].opts == [f"--{known.name}"]
        assert options[known.name].help == known.about


def test_the_message_about_an_unknown_ending_names_all_pictures():
    assert endings(PICTURES) in wording_of("picture-kind").hint


def test_commands_and_help_name_all_formats():
    titles = ", ".join(known.title for known in PICTURES[:-1]) + f" or {PICTURES[-1].title}"
    assert titles in BY_ID["graph.snapshot"].help
    assert CSV.title in BY_ID["graph.export"].help
    assert f"graphs as {titles}" in (PAGES / "desktop.toml").read_text()


@pytest.mark.parametrize(
    ("formats", "sentence"), [(PICTURES, ".png, .svg or .pdf"), ([PNG, CSV], ".png or .csv"), ([PNG], ".png")]
)
def test_endings_as_a_sentence_names_them(formats, sentence):
    assert endings(formats) == sentence
