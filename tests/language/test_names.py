"""What names mean, where they are defined, and what a rename changes and refuses."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui.engine.source import Source, Span
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.words import KEYWORDS
from desire_tui.language.descriptions import described, kind_of
from desire_tui.language.names import ProgramNames
from desire_tui.language.outline import folds, outline
from desire_tui.language.rename import RenameRefusedError, renamed
from tests.programs.execution import execute
from tests.strategies import broken_texts

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").rglob("*.src"))

TEXT = """\
ARRAY in$[1], out$[1] -- dummies
SUBMODEL twice(in$, out$, a)
  Vector out$ = in$*a
end
PROCEDURE add(x, y; z)
  z = x + y
end
FUNCTION f(x) = x*gain + y
STATE s[3], v[3] | ARRAY buffer[9]
gain = 2 | y = 3 | w = 1
units 'y m, w s'
label again
call add(gain, y; w)
x = f(w) + sin(y)
TMAX = 1 | NN = 2
if x < 0 then go to again | else proceed
drun | drun second
DYNAMIC
invoke twice(s, v, gain)
tdelay late = buffer(y, 0.1)
Vectr d/dt s = v
d/dt y = -late + t
label second
y2 = f(y)
dispt y2
"""


def places(names, offset):
    found = names.at(offset)
    assert found is not None
    return [(Source(TEXT).position(one.start).row, one.use) for one in names.of(found.symbol)]


def offset(row, word, nth=1):
    source = Source(TEXT)
    at = source.line_starts[row - 1] - 1
    for _ in range(nth):
        at = TEXT.index(word, at + 1)
    assert source.position(at).row == row
    return at


@pytest.mark.parametrize(
    ("row", "word", "nth", "rows", "kind"),
    [
        (2, "a)", 1, [2, 3], "argument of SUBMODEL twice"),
        (2, "in$", 1, [1, 2, 3], "real array [1]"),  # declared for the SUBMODEL: one thing with its argument
        (2, "twice", 1, [2, 19], "SUBMODEL"),
        (5, "x", 1, [5, 6], "argument of PROCEDURE add"),
        (5, "add", 1, [5, 13], "PROCEDURE"),
        (8, "x", 1, [8, 8], "argument of FUNCTION f"),
        (8, "y", 1, [8, 10, 11, 13, 14, 20, 22, 24], "state"),
        (8, "f(", 1, [8, 14, 24], "FUNCTION"),
        (10, "gain", 1, [8, 10, 13, 19], "parameter"),
        (12, "again", 1, [12, 16], "label"),
        (14, "x", 1, [14, 16], "variable of the script"),
        (17, "second", 1, [17, 23], "label of a segment"),
        (19, "s,", 1, [9, 19, 21], "state array [3]"),
        (20, "buffer", 1, [9, 20], "real array [9]"),
        (24, "y2", 1, [24, 25], "variable of the segment"),
        (14, "sin", 1, [14], "library function"),
        (22, "t\n", 1, [22], "system variable"),
    ],
)
def test_a_name_means_the_same_at_all_its_places(row, word, nth, rows, kind):
    names = ProgramNames(Source(TEXT))
    at = offset(row, word, nth)
    assert [one for one, _ in places(names, at)] == rows
    assert kind_of(names, names.at(at).symbol) == kind


@pytest.mark.parametrize(
    ("row", "word", "defined", "first"),
    [(24, "y)", 22, 10), (20, "late", 20, None), (13, "gain", 10, 10), (21, "s ", 9, 9), (6, "z", 5, 5),
     (16, "again", 12, 12)],
)  # fmt: skip
def test_where_a_name_is_defined_and_first_given_a_value(row, word, defined, first):
    names = ProgramNames(Source(TEXT))
    symbol = names.at(offset(row, word)).symbol
    assert names.source.position(names.definition(symbol).start).row == defined
    value = names.first_value(symbol)
    assert (None if value is None else names.source.position(value.start).row) == first


def test_a_description_has_the_lines_and_values():
    names = ProgramNames(Source(TEXT))
    told = described(names, names.at(offset(24, "y)")), {"y": 1.5})
    assert told.startswith("`y` · *state* · line 22\n\n```desire\nd/dt y = -late + t\n```")
    assert "```desire\ny = 3\n```" in told
    assert told.endswith("\n\nafter the last run 1.5")
    assert described(names, names.at(offset(10, "gain")), {}).endswith("\n\nvalue 2")
    told = described(names, names.at(offset(13, "add")), {})
    assert "PROCEDURE add(x, y; z)\n  z = x + y\nend\n" in told


def test_the_outline_and_the_folds():
    names = ProgramNames(Source(TEXT))
    entries = outline(names)
    assert [entry.name for entry in entries if entry.kind in {"definition", "function", "segment"}] == [
        "twice", "add", "f", "DYNAMIC", "second",
    ]  # fmt: skip
    segment = next(entry for entry in entries if entry.name == "DYNAMIC")
    assert [(child.name, child.kind) for child in segment.children] == [("late", "variable"), ("y", "state")]
    assert TEXT[slice(*segment.span)].splitlines()[-1] == "d/dt y = -late + t"
    assert folds(names, TEXT.split("\n")) == [(1, 3), (4, 6), (17, 21), (22, 24)]


# ---------------------------------------------------------------------------------------------- renaming


def changed(text, spans, new):
    for span in sorted(spans, reverse=True):
        text = text[: span.start] + new + text[span.end :]
    return text


@pytest.mark.parametrize(
    ("row", "word", "new", "reason"),
    [
        (10, "gain", "y", "'y' is taken: it is an argument in line 5"),
        (10, "gain", "a", "'a' is taken: it is an argument in line 2"),
        (10, "gain", "drun", "'drun' is a word of the language: choose another name"),
        (10, "gain", "sin", "'sin' is a function of the library: choose another name"),
        (10, "gain", "TMAX", "'TMAX' is a variable of the system: choose another name"),
        (
            10,
            "gain",
            "2x",
            "'2x' is no name: a name is a letter, then letters of the alphabet, digits, _ or $",
        ),
        (
            10,
            "gain",
            "a b",
            "'a b' is no name: a name is a letter, then letters of the alphabet, digits, _ or $",
        ),
        (
            10,
            "gain",
            "x -- y",
            "'x -- y' is no name: a name is a letter, then letters of the alphabet, digits, _ or $",
        ),
        (10, "gain", "", "'' is no name: a name is a letter, then letters of the alphabet, digits, _ or $"),
        (14, "sin", "cosine", "'sin' is a library function of the language: it keeps its name"),
        (12, "again", "second", "'second' is taken: it is a label in line 17"),
    ],
)
def test_a_rename_is_refused(row, word, new, reason):
    names = ProgramNames(Source(TEXT))
    with pytest.raises(RenameRefusedError) as told:
        renamed(names, names.at(offset(row, word)).symbol, new)
    assert str(told.value) == reason


def test_a_label_may_have_a_variables_name_and_units_follow():
    names = ProgramNames(Source(TEXT))
    assert "label gain\n" in changed(
        TEXT, renamed(names, names.at(offset(12, "again")).symbol, "gain"), "gain"
    )
    again = changed(TEXT, renamed(names, names.at(offset(22, "y")).symbol, "height"), "height")
    assert "units 'height m, w s'" in again
    assert "PROCEDURE add(x, y; z)\n  z = x + y\n" in again  # another y


def test_a_renamed_program_computes_the_same(tmp_path):
    before = execute(TEXT, "native", tmp_path)
    assert before.error is None, before.error
    names = ProgramNames(Source(TEXT))
    for symbol in names.symbols:
        if symbol.is_own:
            text = changed(TEXT, renamed(names, symbol, "fresh"), "fresh")
            after = execute(text, "native", tmp_path)
            assert after.error is None, (symbol, after.error)
            where = "fresh" if symbol == names.at(offset(24, "y2")).symbol else "y2"
            assert after.quantities[where] == before.quantities["y2"]


@pytest.mark.parametrize("shard", range(4))
def test_every_name_of_the_examples_can_be_changed_and_back(shard):
    for path in EXAMPLES[shard::4]:
        text = path.read_text(encoding="utf-8")
        names = ProgramNames(Source(text))
        for symbol in names.symbols:
            assert names.definition(symbol) is not None or not symbol.is_own, (path, symbol)
        symbol = next(one for one in names.symbols if one.is_own and one.name not in KEYWORDS)
        new = changed(text, renamed(names, symbol, "fresh_name"), "fresh_name")
        again = ProgramNames(Source(new))
        back = next(one for one in again.symbols if one.name == "fresh_name")
        assert changed(new, renamed(again, back, symbol.name), symbol.name) == text, path


@settings(deadline=None, max_examples=150)
@given(broken_texts, st.sampled_from(["q9", "x", "to", "d"]))
def test_a_rename_in_any_text_keeps_what_can_be_read(text, new):
    names = ProgramNames(Source(text))
    for symbol in names.symbols:
        try:
            spans = renamed(names, symbol, new)
        except RenameRefusedError:
            continue
        after = parse(Source(changed(text, spans, new)))
        assert len(after.problems) == len(names.program.problems)
        assert all(isinstance(span, Span) and 0 <= span.start < span.end <= len(text) for span in spans)
