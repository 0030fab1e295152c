"""Generated pages are current; what the documentation shows works and prints what it says; links lead somewhere."""

from __future__ import annotations

import re
import shlex
import tomllib
from dataclasses import fields
from pathlib import Path

import pytest
from click.testing import CliRunner

from desire_tui.engine.outputs.results import PlotPoint, Result, ResultProblem
from desire_tui.engine.outputs.run import Run
from desire_tui.engine.outputs.sampled_run import CurveData
from docs.generate import PAGES
from tests.programs.execution import execute

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
WRITTEN = [
    ROOT / "README.md",
    *(p for p in sorted([*DOCS.glob("*.md"), *DOCS.glob("tutorial/*.md")]) if p.name not in PAGES),
]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(path: Path, language: str) -> list[tuple[str, str]]:
    """Return the page's blocks of a language, each with what the block behind `prints` shows."""
    text = path.read_text(encoding="utf-8")
    found = []
    matches = list(FENCE.finditer(text))
    for here, after in zip(matches, [*matches, None][1:], strict=True):
        if here[1] == language:
            prints = after is not None and text[here.end() : after.start()].strip() == "prints"
            found.append((here[2], after[2] if after is not None and prints else ""))
    return found


def every(language: str) -> list:
    return [
        pytest.param(code, shown, id=f"{path.name}-{number}")
        for path in WRITTEN
        for number, (code, shown) in enumerate(blocks(path, language), 1)
    ]


@pytest.mark.parametrize("name", PAGES)
def test_generated_page_is_current(name):
    page = (ROOT / "docs" / name).read_text(encoding="utf-8")
    assert page == PAGES[name](), f"docs/{name}: run python -m docs.generate"


@pytest.mark.parametrize(("program", "shown"), every("desire"))
def test_program_in_the_documentation_runs(program, shown, tmp_path):
    outcome = execute(program, "native", tmp_path)
    assert outcome.error is None, str(outcome.error)
    if shown:
        assert outcome.console == shown


@pytest.mark.parametrize(("code", "shown"), every("python"))
def test_python_in_the_documentation_runs(code, shown, tmp_path, monkeypatch):
    del shown
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "<documentation>", "exec"), {})


@pytest.mark.parametrize(("commands", "shown"), every("sh"))
def test_command_lines_in_the_documentation_work(commands, shown, tmp_path, monkeypatch):
    from desire_tui.cli import main

    del shown
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    for model in DOCS.glob("*.ode"):
        (tmp_path / model.name).symlink_to(model)
    targets = set(re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    for line in commands.splitlines():
        words = shlex.split(line, comments=True)
        if words[:1] == ["make"]:
            assert set(words[1:]) <= targets, line
        elif words[:1] == ["desire"] and words[1:2] in (
            ["run"],
            ["check"],
            ["help"],
            ["completion"],
            ["study"],
            ["convert"],
            ["fmt"],
        ):
            result = CliRunner().invoke(main, words[1:])
            assert result.exit_code == 0, f"{line}\n{result.output}"


@pytest.mark.parametrize(
    "path",
    [*WRITTEN, *(ROOT / "docs" / name for name in PAGES), *sorted((ROOT / "docs" / "spec").glob("*.md"))],
    ids=lambda path: str(path.relative_to(ROOT)),
)
def test_links_lead_somewhere(path):
    text = FENCE.sub("", path.read_text(encoding="utf-8"))
    text = re.sub(r"`[^`\n]*`", "", text)
    links = re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", text)
    assert [link for link in links if not (path.parent / link).exists()] == []


def test_the_cookbook_has_25_tasks_with_a_program_each_that_prints():
    text = (DOCS / "cookbook.md").read_text(encoding="utf-8")
    tasks = [int(number) for number in re.findall(r"^### (\d+)\. ", text, re.MULTILINE)]
    assert tasks == list(range(1, 26))
    programs = blocks(DOCS / "cookbook.md", "desire")
    assert len(programs) == len(tasks)
    assert all(shown for _, shown in programs)


@pytest.mark.parametrize("name", [name for name in PAGES if name.endswith(".md")])
def test_no_braces_of_templates_are_left(name):
    """Doubled braces and names in braces are what a sentence's template is written with."""
    text = FENCE.sub("", (DOCS / name).read_text(encoding="utf-8"))
    assert re.findall(r"\{\{|\}\}|\{[a-z]{2,}[^{}]*\}", text) == []


def test_the_page_on_json_has_every_field():
    text = (DOCS / "json.md").read_text(encoding="utf-8")
    names = {
        field.name
        for kind in (Result, Run, CurveData, ResultProblem, PlotPoint)
        for field in fields(kind)
        if "in_memory" not in field.metadata
    }
    assert {name for name in names if f"`{name}`" not in text} == set()


def test_the_site_names_pages_that_are_there():
    listed = re.findall(r"([\w/-]+\.md)$", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"), re.MULTILINE)
    made = {"index.md", "gallery.md"}  # by docs/site_hooks.py
    assert len(listed) > 30
    assert [page for page in listed if page not in made and not (DOCS / page).is_file()] == []


def test_the_originals_error_numbers_are_those_of_the_messages():
    text = (ROOT / "docs" / "spec" / "errors.md").read_text(encoding="utf-8")
    table, _, unused = text.partition("Not in use here")
    listed = set()
    for cell in re.findall(r"^\| ([\d, –]+) \|", table, re.MULTILINE):
        for first, last in re.findall(r"(\d+)(?:–(\d+))?", cell):
            listed |= set(range(int(first), int(last or first) + 1))
    messages = (ROOT / "docs" / "errors.md").read_text(encoding="utf-8")
    used = {int(number) for number in re.findall(r"^### error (\d+)", messages, re.MULTILINE)}
    assert listed - {int(number) for number in re.findall(r"\d+", unused)} == {n for n in used if n < 400}


def test_the_guards_of_the_invariants_are_there():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    rows = [row for row in text.splitlines() if row.startswith("| ")]
    paths = set(re.findall(r"`((?:tests|docs|desire_tui|\.github)/[\w./-]+)`", text))
    assert len(paths) > 20
    assert {path for path in paths if not (ROOT / path).exists()} == set()
    assert [row for row in rows if "---" not in row and "guarded by" not in row and "`" not in row] == []


def test_python_versions_agree():
    """What pyproject.toml promises is what hosted CI runs, and the oldest is what the tools check against."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    prefix = "Programming Language :: Python :: "
    promised = [c.removeprefix(prefix) for c in project["project"]["classifiers"] if c.startswith(prefix)]
    workflow = (ROOT / ".github" / "workflows" / "check.yml").read_text(encoding="utf-8")
    (matrix,) = re.findall(r"python: \[(.*)\]", workflow)
    assert re.findall(r"[\d.]+", matrix) == promised
    oldest = promised[0]
    assert project["project"]["requires-python"] == f">={oldest}"
    assert project["tool"]["mypy"]["python_version"] == oldest
    assert project["tool"]["ruff"]["target-version"] == f"py{oldest.replace('.', '')}"


def test_every_dependency_says_what_it_is_for():
    lines = (
        (ROOT / "pyproject.toml").read_text(encoding="utf-8").partition("\ndependencies = [")[2].splitlines()
    )
    end = lines.index("[project.scripts]")
    assert [line for line in lines[:end] if re.match(r'    "', line) and "# " not in line] == []


def test_everything_exported_is_in_the_python_reference():
    import desire_tui

    page = (ROOT / "docs" / "python_reference.md").read_text(encoding="utf-8")
    for name in set(desire_tui.__all__) - {"__version__"}:
        assert f"\n## {name}\n" in page or f"\n### desire_tui.{name}\n" in page, name
