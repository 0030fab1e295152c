"""What MkDocs does beyond its own for the site: pages from other places, links, colours of programs.

README, CHANGELOG and CONTRIBUTING become pages; links to files outside of docs/ lead to the repository; a
gallery of all examples is drawn (`docs.gallery`). Pages that `mkdocs.yml` does not name stand under "More".
"""

from __future__ import annotations

import logging
import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mkdocs.structure.files import File
from pygments.lexers import LEXERS

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

ROOT = Path(__file__).parents[1]
PAGES_ELSEWHERE = {
    "README.md": "index.md",
    "CHANGELOG.md": "changes.md",
    "CONTRIBUTING.md": "contributing.md",
}
MORE = "More"
_LINK = re.compile(r"\]\(((?:\.\./)+)([^)#\s]+)(#[^)]*)?\)")
_log = logging.getLogger("mkdocs.plugins.desire")


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Teach Pygments the language, and name in the navigation what nobody did."""
    if str(ROOT) not in sys.path:
        sys.path.insert(0, str(ROOT))
    LEXERS["DesireLexer"] = ("docs.desire_lexer", "Desire", ("desire",), ("*.src",), ())
    named = set(_names(config.nav or []))
    found = [
        path.relative_to(config.docs_dir).as_posix() for path in sorted(Path(config.docs_dir).rglob("*.md"))
    ]
    rest = [*(page for page in found if page not in named), "contributing.md", "changes.md"]
    assert config.nav is not None
    config.nav.append({MORE: rest})
    return config


def _names(nav: Any) -> list[str]:
    if isinstance(nav, str):
        return [nav]
    return [name for part in (nav.values() if isinstance(nav, dict) else nav) for name in _names(part)]


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages from elsewhere, and the gallery with its pictures."""
    from docs.gallery import draw_all, gallery_page  # noqa: PLC0415 - not before `on_config` says where it is

    for source, page in PAGES_ELSEWHERE.items():
        text = _as_page(source, (ROOT / source).read_text(encoding="utf-8"), config.repo_url or "")
        files.append(File.generated(config, page, content=text))
    drawn = draw_all(Path(os.environ.get("DESIRE_GALLERY", ROOT / "build" / "gallery")))
    files.append(File.generated(config, "gallery.md", content=gallery_page(drawn)))
    for name, found in drawn.items():
        if found.picture is not None:
            files.append(File.generated(config, f"gallery/{name}.png", abs_src_path=str(found.picture)))
    return files


def _as_page(source: str, text: str, home: str) -> str:
    """Return a file of the top folder as a page: its links to docs/ lead to pages of the site."""
    text = re.sub(rf"\({re.escape(home)}/(?:blob|raw)/main/(?:docs/)?", "(", text)
    text = text.replace("(docs/", "(")
    for other, page in PAGES_ELSEWHERE.items():
        text = text.replace(f"({other})", f"({page})")
    return text if source != "README.md" else re.sub(r"^# .*", "# Desire for the terminal", text, count=1)


def on_page_markdown(markdown: str, *, page: Page, config: MkDocsConfig, **_: Any) -> str:
    """Let links that leave docs/ lead to the repository, or to the page that was made of their file."""
    depth = page.file.src_uri.count("/")

    def target(match: re.Match[str]) -> str:
        up, place, anchor = match[1], match[2], match[3] or ""
        if up.count("../") <= depth:
            return match[0]
        if place in PAGES_ELSEWHERE:
            return f"]({'../' * depth}{PAGES_ELSEWHERE[place]}{anchor})"
        return f"]({config.repo_url}/blob/main/{place}{anchor})"

    return _LINK.sub(target, markdown)
