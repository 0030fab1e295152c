"""The examples: their order, what they say about themselves, and the search over them."""

from __future__ import annotations

import re

import pytest

from desire_tui.panes.example_catalogue import CHAPTERS, examples, search

EVERY = examples()


def test_chapters_come_in_the_order_of_the_book_and_the_appendix_and_further_subjects_last():
    folders = list(dict.fromkeys(example.folder for example in EVERY))
    assert folders == [f"ch{number}" for number in range(1, 9)] + ["appendix", "stability", "networks"]
    assert set(CHAPTERS) == set(folders)
    assert EVERY[0].chapter == "Chapter 1"
    assert EVERY[-1].chapter == "Networks"
    assert EVERY[-1].subject == "Neural networks and fuzzy logic"
    names = [example.name for example in EVERY if example.folder == "ch2"]
    assert names == sorted(names)


def test_a_folder_of_ones_own_comes_after_those_of_the_book(tmp_path):
    for folder in ("mine", "ch2", "appendix"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "a.src").write_text("x = 1\n")
    found = examples(tmp_path)
    assert [example.chapter for example in found] == ["Chapter 2", "Appendix", "Mine"]
    assert [example.about for example in found] == ["", "", ""]


@pytest.mark.parametrize("example", EVERY, ids=lambda e: f"{e.folder}/{e.name}")
def test_an_example_says_what_it_shows(example):
    assert len(example.about.split()) >= 5
    assert example.body
    assert "--?" not in example.body
    assert example.about.split(". ")[0] not in example.body


@pytest.mark.parametrize(
    ("words", "first"),
    [
        ("lorenz", "lorenz"),
        ("STEP response", "step_response"),
        ("bouncing", "bouncing_ball"),
        ("mackey glass", "mackey_glass"),
        ("phase portrait", "pendulum_phase_portrait"),
    ],
)
def test_a_search_puts_names_first(words, first):
    assert search(words, EVERY)[0].name == first


def test_a_search_looks_into_descriptions_and_programs_and_wants_every_word():
    assert {"epidemic"} <= {e.name for e in search("susceptible", EVERY)}
    assert {"mackey_glass", "satellite_roll"} <= {e.name for e in search("tdelay", EVERY)}
    assert all("tdelay" in e.text for e in search("tdelay", EVERY))
    assert search("lorenz nosuchword", EVERY) == []
    assert search("  ", EVERY) == EVERY
    assert {e.name for e in EVERY if e.folder == "ch7"} <= {e.name for e in search("chapter 7", EVERY)}


def test_no_example_prints_a_word_and_a_number_without_a_blank():
    """`write 'speed'; v` prints `speed53.9`."""
    joined = re.compile(r"\bwrite\b.*?'[^']*[\w:=]'\s*;\s*\w")
    lines = [(example.name, line) for example in examples() for line in example.text.splitlines()]
    assert [entry for entry in lines if joined.search(entry[1])] == []
