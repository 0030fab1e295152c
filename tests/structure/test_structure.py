"""Blocks, labels, definitions and data of a script find their partners (problems: tests/messages/parse)."""

from __future__ import annotations

import pytest

from desire_tui.engine.source import Source
from desire_tui.engine.structure.structure import script_structure, structure
from desire_tui.engine.syntax.parse import parse, parse_command


def of(text: str):
    return structure(parse(Source(text)))


BLOCKS = {
    "for i = 1 to 3 | x = 1 | next": {0: 2, 2: 0},
    "while x > 1 | x = 1 | end while": {0: 2, 2: 0},
    "repeat | x = 1 | until x > 1": {0: 2, 2: 0},
    "if x > 1 then | x = 1 | proceed": {0: 2, 2: 0},
    "if x > 1 then | x = 1 | else | x = 2 | proceed": {0: 2, 2: 4, 4: 0},
    "PROCEDURE p | x = 1 | end": {0: 2, 2: 0},
    "SUBMODEL p(x$) | x$ = 1 | end": {0: 2, 2: 0},
    "for i = 1 to 3 | for j = 1 to 3 | next | next": {0: 3, 3: 0, 1: 2, 2: 1},
    "if x > 1 then | repeat | until x > 1 | else | exit = 1 | proceed": {0: 3, 3: 5, 5: 0, 1: 2, 2: 1},
}


@pytest.mark.parametrize("text", BLOCKS)
def test_partners(text: str) -> None:
    found = of(text)
    assert not found.problems
    assert found.partner == BLOCKS[text]
    placed, _ = parse_command(Source(text))
    assert script_structure(placed, Source(text)).partner == BLOCKS[text]


def test_exit_leaves_the_innermost_loop_or_the_procedure() -> None:
    found = of(
        "for i = 1 to 3 | while i > 1 | if i > 2 then | exit | proceed | end while | exit | next\n"
        "PROCEDURE p | if x > 1 then | exit | proceed | end"
    )
    assert not found.problems
    assert found.exits == {3: 5, 6: 7, 10: None}


def test_labels_numbers_and_data() -> None:
    found = of("10 label a | data 1\n20 data 2 | x = 1\n30 go to 20 | go to a | restore 20")
    assert not found.problems
    assert found.labels == {"a": 0}
    assert found.numbers == {10: 0, 20: 2, 30: 4}
    assert found.data == [1, 2]
    assert [found.place(target) for target in ("a", "20", "25", "b")] == [0, 2, None, None]


def test_definitions() -> None:
    found = of(
        "PROCEDURE p(a; B) | B = a | end\nFUNCTION f(x) = x\nSUBMODEL s(v$) | d/dt v$ = -v$ | if v$ | v$ = 1 | end"
    )
    assert not found.problems
    procedure = found.procedures["p"]
    assert (procedure.opens, procedure.closes, procedure.node.values) == (0, 2, ("a",))
    assert found.functions["f"].node.dummies == ("x",)
    submodel = found.submodels["s"]
    assert (submodel.name, submodel.dummies, len(submodel.body)) == ("s", ("v$",), 3)


def test_jumps_out_of_blocks_and_within_them_are_fine() -> None:
    found = of(
        "label top | for i = 1 to 3 | label again | if i > 2 then | go to top | else | go to again | proceed | next"
    )
    assert not found.problems


@pytest.mark.parametrize(
    "text",
    [
        "go to a | if x > 1 then | label a | proceed",
        "if x > 1 then | go to a | else | label a | proceed",
        "PROCEDURE p | label a | end | go to a",
        "for i = 1 to 2 | label a | next | for j = 1 to 2 | go to a | next",
    ],
)
def test_jumps_into_blocks_are_errors(text: str) -> None:
    assert [problem.key for problem in of(text).problems] == ["jump-inside"]


def test_ifs_of_a_segment() -> None:
    found = of(
        "drun | drun b\nDYNAMIC\nif x\n y = 1\nelse\n y = 2\nend if\nif x\n y = 3\n"
        "label b\nif x\n if y\n  z = 1\n end if\nend if"
    )
    assert not found.problems
    assert found.segment_partner == {None: {0: 2, 2: 4, 4: 2}, "b": {0: 4, 4: 0, 1: 3, 3: 1}}


def test_a_bad_opener_does_not_make_its_closer_a_second_mistake() -> None:
    program = parse(Source("for i = 1 \n x = i\nnext\nif x >\n y = 1\nelse\n y = 2\nproceed"))
    assert [problem.key for problem in program.problems] == ["to-expected", "operand-missing"]
    assert structure(program).problems == ()
