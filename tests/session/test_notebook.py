"""The notebook: what it keeps, that it reads as Markdown, and what happens when it cannot be written."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from markdown_it import MarkdownIt

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.session import notebook as notebook_module
from desire_tui.engine.session import notebook_markdown
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

DECAY = """\
TMAX = 1 | DT = 0.01 | NN = 11
a = 1
x = 1
drun
write 'x is '; x
DYNAMIC
d/dt x = -a*x
dispt x
"""
SILENT = "x = 1\nwrite 'only words'\n"


class Kept(Listener):
    def __init__(self) -> None:
        self.warnings: list[Diagnostic] = []

    def problems(self, diagnostics) -> None:
        self.warnings += diagnostics


class Book:
    """A session with a notebook."""

    def __init__(self, folder: Path, name: str = "book.md") -> None:
        self.listener = Kept()
        self.session = Session(self.listener, folder=folder, permissions=Permissions(files=True))
        self.path = folder / name
        self.session.execute(f"notebook '{name}'")

    def zz(self, text: str, name: str = "decay.src") -> None:
        self.session.erun(Source(text, name))

    @property
    def text(self) -> str:
        return self.path.read_text(encoding="utf-8")

    def blocks(self, kind: str) -> list[str]:
        return [t.content for t in MarkdownIt().parse(self.text) if t.type == "fence" and t.info == kind]

    @property
    def items(self) -> list[str]:
        tokens = MarkdownIt().parse(self.text)
        places = [n for n, t in enumerate(tokens) if t.type == "list_item_open"]
        return [next(t.content for t in tokens[n:] if t.type == "inline") for n in places]


@pytest.fixture
def notebook(tmp_path) -> Book:
    return Book(tmp_path)


def patched(old: str, difference: str) -> str:
    """Apply a unified diff."""
    lines, result, at = old.rstrip("\n").split("\n"), [], 0
    for line in difference.splitlines()[2:]:
        if found := re.match(r"@@ -(\d+)", line):
            start = int(found[1]) - 1
            result += lines[at:start]
            at = start
        elif line[0] == "+":
            result.append(line[1:])
        else:
            assert lines[at] == line[1:]
            at += 1
            result += [line[1:]] if line[0] == " " else []
    return "\n".join(result + lines[at:])


def test_the_first_version_stands_whole_the_next_as_its_difference(notebook):
    second = DECAY.replace("a = 1\n", "a = 3\n")
    notebook.zz(DECAY)
    notebook.zz(second)
    assert notebook.blocks("desire") == [DECAY]
    (difference,) = notebook.blocks("diff")
    assert re.findall(r"^[-+][^-+].*$", difference, re.MULTILINE) == ["-a = 1", "+a = 3"]
    assert patched(DECAY, difference) == second.rstrip("\n")
    assert "decay.src version 2" in difference


@given(st.lists(st.sampled_from(["a = 1", "b = 2", "```", "", "  x = 0.5", "-- é"]), max_size=12),
       st.lists(st.sampled_from(["a = 1", "b = 2", "````", "", "  x = 0.5", "-- ö"]), max_size=12))  # fmt: skip
@settings(max_examples=200, deadline=None)
def test_every_version_can_be_restored(first, second):
    old, new = "\n".join(["t = 0", *first, "c = 1"]) + "\n", "\n".join(["t = 0", *second, "c = 2"]) + "\n"
    (whole,) = [
        t for t in MarkdownIt().parse(notebook_markdown.program_page("p", 1, old, None)) if t.type == "fence"
    ]
    assert whole.content.rstrip("\n") == old.rstrip("\n")
    (change,) = [
        t for t in MarkdownIt().parse(notebook_markdown.program_page("p", 2, new, old)) if t.type == "fence"
    ]
    again = patched(old, change.content) if change.info == "diff" else change.content
    assert again.rstrip("\n") == new.rstrip("\n")


def test_an_unchanged_program_is_not_repeated_and_one_gone_back_to_is_named(notebook):
    notebook.zz(DECAY)
    notebook.zz(DECAY)
    assert len(notebook.blocks("desire")) == 1
    notebook.zz(SILENT, "silent.src")
    notebook.zz(DECAY)
    assert notebook.blocks("desire") == [DECAY, SILENT]
    assert "**decay.src**, version 1, again" in notebook.text


def test_commands_stand_with_what_they_print_and_after_the_program_they_run(notebook):
    notebook.zz(DECAY)
    notebook.session.execute("write 'twice '; 2*x")
    start, printed, command = notebook.blocks("text")
    assert start == "> zz\n"
    assert float(printed.removeprefix("x is ")) == pytest.approx(math.exp(-1), rel=1e-4)
    line, answer = command.splitlines()
    assert line == "> write 'twice '; 2*x"
    assert float(answer.removeprefix("twice ")) == pytest.approx(2 * math.exp(-1), rel=1e-4)
    assert notebook.text.index("```desire") < notebook.text.index("> zz") < notebook.text.index("- Run 1")


def test_runs_tell_settings_and_end_and_many_become_a_few(notebook):
    notebook.zz(DECAY)
    assert notebook.items == ["Run 1: rule 1, t = 0 … 1, DT = 0.01, 100 steps, TMAX reached"]
    notebook.zz(DECAY.replace("drun", "for k = 1 to 40 | drunr | next"))
    assert len(notebook.items) == 1 + 8 + 2
    assert notebook.items[-2:] == [
        "… 31 more",
        "Run 40: rule 1, t = 0 … 1, DT = 0.01, 100 steps, TMAX reached",
    ]


def test_live_mode_leaves_its_last_run_only(notebook):
    notebook.zz(DECAY)
    for a in range(30):
        notebook.session.override({"a": 0.5 + a})
        notebook.zz(DECAY)
        notebook.session.override({})
    notebook.session.execute("write 'done'")
    assert "Live mode, 30 times; the last run:" in notebook.text
    assert notebook.items[1:] == ["Run 1, a = 29.5: rule 1, t = 0 … 1, DT = 0.01, 100 steps, TMAX reached"]
    assert len(list(notebook.path.parent.glob("*.png"))) == 2  # the program's, and live mode's last


def test_pictures_of_graphs_stand_where_they_were_made(notebook):
    notebook.zz(DECAY)
    notebook.zz(DECAY.replace("a = 1", "a = 2"))
    notebook.session.execute("snapshot 'my graph.svg'")
    links = [
        c.attrs["src"]
        for t in MarkdownIt().parse(notebook.text)
        for c in t.children or ()
        if c.type == "image"
    ]
    assert links == ["book-1.png", "book-2.png", "my%20graph.svg"]
    for name in ("book-1.png", "book-2.png"):
        assert (notebook.path.parent / name).read_bytes().startswith(b"\x89PNG")


def test_no_picture_without_news_in_the_graph(notebook):
    notebook.zz(SILENT)
    notebook.zz(DECAY)
    notebook.session.execute("write x")
    notebook.session.execute("x = 2")
    assert len(list(notebook.path.parent.glob("*.png"))) == 1


def test_a_picture_never_replaces_a_file(tmp_path):
    (tmp_path / "book-1.png").write_text("mine")
    notebook = Book(tmp_path)
    notebook.zz(DECAY)
    assert (tmp_path / "book-1.png").read_text() == "mine"
    assert (tmp_path / "book-2.png").exists()


def test_what_went_wrong_is_kept(notebook):
    with pytest.raises(DesireError):
        notebook.zz("x = 1/0\n")
    assert notebook.blocks("text") == ["> zz\nerror 5: division by zero\n"]


def test_notes_and_odd_characters(notebook):
    notebook.session.execute("note 'so *far* '; 1.5")
    assert "\nso *far* 1.5\n" in notebook.text
    assert notebook.blocks("text") == []
    notebook.zz("write 'a```b'\n", "my_odd *name*.src")
    assert "a```b\n" in notebook.blocks("text")[-1]
    assert "<p><strong>my_odd *name*.src</strong>, version 1</p>" in MarkdownIt().render(notebook.text)


def test_a_comparison_and_a_report_are_kept(notebook):
    notebook.zz(DECAY)
    for command in ("compare rule 3", "dump run"):
        notebook.session.execute(command)
        head, *table = notebook.blocks("text")[-1].splitlines()
        assert head == f"> {command}"
        assert len(table) > 2


def test_long_output_is_cut(notebook):
    notebook.zz("for k = 1 to 5000 | write 'line number '; k | next\n")
    printed = notebook.blocks("text")[-1]
    assert len(printed) < 21_000
    assert re.search(r"… \d+ more characters$", printed.rstrip())


def test_another_session_goes_on_in_the_same_file(tmp_path):
    Book(tmp_path).zz(DECAY)
    again = Book(tmp_path)
    again.zz(DECAY)
    assert again.blocks("desire") == [DECAY, DECAY]
    heads = [t.tag for t in MarkdownIt().parse(again.text) if t.type == "heading_open"]
    assert heads == ["h1", "h2", "h2"]


def test_off_and_on(notebook):
    notebook.zz(DECAY)
    notebook.session.execute("notebook off")
    before = notebook.text
    notebook.session.execute("write 'not this'")
    assert notebook.text == before
    notebook.session.execute("notebook on")
    notebook.zz(DECAY.replace("a = 1", "a = 2"))
    assert len(notebook.blocks("diff")) == 1
    assert "not this" not in notebook.text


@pytest.mark.parametrize("name", ["missing/book.md", "folder"])
def test_a_notebook_that_cannot_be_written_is_refused(tmp_path, name):
    (tmp_path / "folder").mkdir()
    session = Session(Kept(), folder=tmp_path)
    with pytest.raises(DesireError) as caught:
        session.execute(f"notebook '{name}'")
    assert caught.value.diagnostics[0].code == 106
    session.execute("write 1")  # nothing is left half on


@pytest.fixture
def full_disk(monkeypatch):
    """Return a function from whose call on the disk is full."""
    return lambda: monkeypatch.setattr(
        notebook_module, "open_for_program", lambda *_: Path("/dev/full").open("a")
    )


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_disk_that_is_full_from_the_start(tmp_path, full_disk):
    full_disk()
    with pytest.raises(DesireError) as caught:
        Book(tmp_path)
    assert "No space left" in caught.value.diagnostics[0].message


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_disk_that_fills_up_costs_the_notebook_not_the_run(notebook, full_disk):
    full_disk()
    notebook.zz(DECAY)
    assert notebook.session.runs[-1].ended == "tmax"
    assert [w.key for w in notebook.listener.warnings] == ["notebook-lost"]
    assert "No space left on device" in notebook.listener.warnings[0].message
    notebook.session.execute("write 1")
    assert len(notebook.listener.warnings) == 1


def test_a_folder_that_vanishes_costs_the_notebook_not_the_run(tmp_path):
    (tmp_path / "inner").mkdir()
    notebook = Book(tmp_path, "inner/book.md")
    notebook.path.unlink()
    notebook.path.parent.rmdir()
    notebook.zz(DECAY)
    assert notebook.session.runs[-1].ended == "tmax"
    assert [w.key for w in notebook.listener.warnings] == ["notebook-lost"]


def test_a_file_that_vanishes_begins_anew_and_says_so(notebook):
    notebook.zz(DECAY)
    notebook.path.unlink()
    notebook.zz(DECAY.replace("a = 1", "a = 2"))
    assert [w.key for w in notebook.listener.warnings] == ["notebook-vanished"]
    assert notebook.text.startswith("# book\n")
    assert notebook.blocks("desire") == [
        DECAY.replace("a = 1", "a = 2")
    ]  # a difference alone would be worthless
