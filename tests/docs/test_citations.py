"""Citations in code, tests, examples and docs name pages and sections that are there (docs/spec/README.md).

`language.md 8.2` is section 8.2 of docs/spec/language.md, a path is meant from the top of the repository.
`book 1.3.7` and `[B 1.3.7]` are sections of a printed book: of these only the form can be tested.
"""

from __future__ import annotations

import ast
import functools
import io
import re
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SPEC = ROOT / "docs" / "spec"
FOLDERS = ("desire_tui", "tests", "benchmarks", "examples", "docs", ".ci", ".github")
KINDS = {".py", ".md", ".src", ".lark", ".toml", ".tcss", ".yml", ".yaml"}
FILES = sorted(
    [p for folder in FOLDERS for p in (ROOT / folder).rglob("*") if p.suffix in KINDS]
    + [p for p in ROOT.iterdir() if (p.suffix in KINDS and p.name != "mkdocs.yml") or p.name == "Makefile"]
)

NUMBER = r"(?:\d+|A)(?:\.\d+)*"
NUMBERS = rf"{NUMBER}(?:(?:, | and |, and | to ){NUMBER}(?![\w.]*\w))*"
PAGE = re.compile(rf"(?<![\w'\"./<>-])((?:[\w.-]+/)*[\w-]+\.md)\b(?:`?,?(?: sections?)? ({NUMBERS}))?")
BOOK = re.compile(rf"\b[Bb]ook(?:'s)?,?(?: sections?)? ({NUMBERS})")
MARKED = re.compile(r"(?<!\w)\[B\b([^\]]*)\]")
BOOK_PLACE = r"(?:(?:[1-8]|A)(?:\.\d+){1,4}|Tables? [1-8A]\.\d+|Figs?\. [1-8A]\.\d+[a-d]?)"
MARK = re.compile(rf"(?: {BOOK_PLACE}(?:, {BOOK_PLACE})*(?:[;:] .*)?|[,;]? ?[a-z].*)?")
CITING = re.compile(r"\.md\b|\b[Bb]ook\b|\[B\b")
"""In every text in which one of the three above is found; most files of Python are not taken apart."""
HEADING = re.compile(r"^#+ (?:Chapter )?([\dA][\d./, A-]*)", re.MULTILINE)


@functools.cache
def sections(page: Path) -> frozenset[str]:
    """Return the numbers of a page's headings, with those of the sections that they lie in."""
    found: set[str] = set()
    for match in HEADING.finditer(page.read_text(encoding="utf-8")):
        for number in re.findall(NUMBER, match[1]):
            parts = number.split(".")
            found.update(".".join(parts[:n]) for n in range(1, len(parts) + 1))
    return frozenset(found)


def passages(path: Path) -> list[str]:
    """Return a file's prose, a paragraph an item: of Python comments and docstrings, else everything.

    Nothing of a file in which nothing can be a citation.
    """
    text = path.read_text(encoding="utf-8")
    if not CITING.search(text):
        return []
    if path.suffix == ".py":
        tree = ast.walk(ast.parse(text))
        strings = [
            n.value.value for n in tree if isinstance(n, ast.Expr) and isinstance(n.value, ast.Constant)
        ]
        tokens = tokenize.generate_tokens(io.StringIO(text).readline)
        comments = [(t.start[0], t.string) for t in tokens if t.type == tokenize.COMMENT]
        runs = "".join(
            f"\n{string}" if row - 1 == before else f"\n\n{string}"
            for (before, _), (row, string) in zip([(0, ""), *comments], comments, strict=False)
        )
        text = "\n\n".join([*(s for s in strings if isinstance(s, str)), runs])
    else:
        text = re.sub(r"\]\([^)\s]*\)", "]", text)  # where links lead is test_docs' business
    text = re.sub(r"^\s*(?:--\??|//|#+:?)(?=\s)", "", text, flags=re.MULTILINE)
    return [" ".join(part.split()) for part in re.split(r"\n\s*\n", text)]


def page_of(name: str) -> Path | None:
    places = [ROOT / name] if "/" in name else [SPEC / name.lower(), ROOT / name]
    return next((place for place in places if place.is_file()), None)


def faults(passage: str) -> list[str]:
    """Return the citations of one passage that lead nowhere."""
    found = []
    for name, numbers in PAGE.findall(passage):
        page = page_of(name)
        if page is None:
            found.append(f"{name}: no such page")
            continue
        there = sections(page)
        found += [f"{name} {n}: no such section" for n in re.findall(NUMBER, numbers) if n not in there]
    for numbers in BOOK.findall(passage):
        found += [f"book {n}" for n in re.findall(NUMBER, numbers) if not re.fullmatch(BOOK_PLACE, n)]
    found += [f"[B{inside}]" for inside in MARKED.findall(passage) if not MARK.fullmatch(inside)]
    return found


def test_citations_lead_somewhere():
    """What is searched holds citations at all: the searching itself cannot come to nothing unnoticed."""
    cited = [(path, passage) for path in FILES for passage in passages(path)]
    assert [(str(path.relative_to(ROOT)), fault) for path, text in cited for fault in faults(text)] == []
    names = [name.lower() for _, text in cited for name, _ in PAGE.findall(text)]
    assert names.count("language.md") > 40


@pytest.mark.parametrize(
    "citation",
    [
        "language.md 8.3",
        "(language.md section 16)",
        "language.md 8.2, 9.5 and 11",
        "as `models.md` 9.9 has it",
        "compatibility.md 7",
        "lexicon.md 2",
        "docs/neurons.md",
        "docs/neural.md 3",
        "book 9.1",
        "the book's section 0.3",
        "[B 9.1]",
        "[B 5.x]",
    ],
)
def test_a_wrong_citation_is_found(citation):
    assert len(faults(citation)) == 1


def test_a_citation_broken_over_two_lines_is_read(tmp_path):
    (tmp_path / "a.py").write_text(
        '"""Some words (language.md\n9.4)."""\n\nx = 1  # one\n# language.md\n# 9.5\n'
    )
    (tmp_path / "b.src").write_text("-- as language.md\n-- 9.9\n")
    found = [
        fault for name in ("a.py", "b.src") for text in passages(tmp_path / name) for fault in faults(text)
    ]
    assert found == [f"language.md {number}: no such section" for number in ("9.4", "9.5", "9.9")]
