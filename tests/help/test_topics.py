"""The help pages: complete, linked, found."""

from __future__ import annotations

from typing import get_args, get_type_hints

import pytest

from desire_tui.commands import COMMANDS
from desire_tui.engine.diagnostics.wording import all_wordings
from desire_tui.engine.nodes import expressions
from desire_tui.engine.nodes.commands import FileCommand, Word
from desire_tui.engine.nodes.declarations import Declare
from desire_tui.engine.nodes.display import Request
from desire_tui.engine.nodes.segment import Learn
from desire_tui.help.help_search import search
from desire_tui.help.page_catalogue import find, topics

ALIASES = {"zz": "erun", "rld": "reload", "quit": "bye", "old": "load", "MACRO": "SUBMODEL", "dimension": "ARRAY",
           "LEARN": "DELTA", "VECTOR": "Vector", "Delta": "Vectr delta", "else": "if", "until": "repeat"}  # fmt: skip


def keywords() -> list[str]:
    """Every word that the syntax tree knows as the beginning of a statement."""
    words = list(get_args(Word)) + list(
        get_args(get_type_hints(FileCommand, localns=vars(expressions))["word"])
    )
    for cls in (Declare, Request, Learn):
        words += get_args(get_type_hints(cls, localns=vars(expressions))["kind"])
    return sorted(set(words) - {"compare"})


@pytest.mark.parametrize("word", keywords())
def test_every_keyword_has_a_page(word):
    assert find(word) is not None


@pytest.mark.parametrize(("alias", "name"), ALIASES.items())
def test_an_alias_leads_to_its_statement(alias, name):
    assert find(alias).name == name


def test_case_decides_where_two_statements_differ_by_it_only():
    assert find("dispxy").name == "dispxy"
    assert find("DISPXY").name == "DISPXY"
    assert find("tmax").name == "TMAX"


def test_links_lead_somewhere():
    missing = [(page.name, word) for page in topics().values() for word in page.see if find(word) is None]
    assert missing == []


@pytest.mark.parametrize("page", topics().values(), ids=lambda page: page.name)
def test_a_page_says_what_it_is_about(page):
    assert page.summary
    assert page.markdown.startswith(f"# {page.name}\n")
    assert page.kind in ("error", "desktop") or page.syntax
    assert all(find(word) is not None for word in page.words)


def test_every_error_number_has_a_page():
    for wording in (wording for wording in all_wordings().values() if wording.code):
        page = find(str(wording.code))
        assert page is find(f"error {wording.code}")
        assert page.kind == "error"


def test_an_error_page_begins_with_the_usual_case_and_its_hints_are_sentences():
    assert find("200").summary.startswith("undefined variable")
    ends = [
        line[-2:] for page in topics().values() for line in page.text.split("\n") if line.startswith("Hint: ")
    ]
    assert len(ends) > 200
    assert [end for end in ends if end[-1] not in ".?" or end in ("?.", "..")] == []


def test_search_puts_names_before_mentions():
    assert search("drun")[0].name == "drun"
    assert search("integration rule")[0].name == "irule"
    assert search("zqxj") == []
    assert len(search("")) == len(topics())


@pytest.mark.parametrize(
    ("text", "first"),
    [
        ("sin", "sin"), ("ERMAX", "ERMAX"), ("ermax", "ERMAX"), ("error 94", "error 94"), ("94", "error 94"),
        ("phase plane", "phase"), ("phase portrait", "phase"), ("y against x", "dispxy"), ("initial condition", "d/dt"), ("step size", "DT"),
        ("loops", "for"), ("color", "display"), ("colour", "display"), ("how to stop a run", "running programs"),
        ("slider", "live mode"), ("zoom", "the graph"), ("breakpoints", "stepping and breakpoints"),
        ("undefined variable", "error 200"), ("subroutine", "PROCEDURE"), ("Runge-Kutta", "irule"), ("stiff", "irule"),
        ("monte carlo", "SEED"), ("fourier", "FFT"), ("save csv", "pictures and data"), ("crash", "files and tabs"),
    ],
)  # fmt: skip
def test_search_finds_what_is_meant(text, first):
    assert search(text)[0].name == first


@pytest.mark.parametrize(
    ("misspelt", "meant"),
    [("TMXA", "TMAX"), ("dispyx", "dispxy"), ("irul", "irule"), ("sqare root", "sqrt"), ("vektor", "Vector"),
     ("ERMXA", "ERMAX"), ("PROCEDRE", "PROCEDURE"), ("integrashun", "irule"), ("notebok", "notebook")],
)  # fmt: skip
def test_search_forgives_misspelling(misspelt, meant):
    assert meant in [page.name for page in search(misspelt)[:2]]


def test_where_no_page_has_all_words_those_with_most_come():
    assert search("irule zqxj")[0].name == "irule"


def test_every_action_of_the_desktop_has_a_page_and_every_word_of_the_command_line_leads_to_one():
    told = [action for page in topics().values() for action in page.actions]
    assert sorted(set(told)) == sorted(command.id for command in COMMANDS)
    words = {word for command in COMMANDS for word in command.words} - {
        "keys"
    }  # a page that the pane makes itself
    assert [word for word in words if find(word) is None] == []
    for command in COMMANDS:
        assert any(command.id in page.actions for page in search(command.title)), command.title
