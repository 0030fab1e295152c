"""The page and the few files it is made of: all from this machine, none by a path from a request."""

from __future__ import annotations

import html
from importlib.resources import files
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

_OWN = "desire_tui.serve"
_TERMINAL = "textual_serve"  # of textual-serve, the terminal emulator in the browser is used, not the server


class StaticFile(NamedTuple):
    """A file of the page."""

    content: bytes
    kind: str


_FILES = {
    "page.css": (_OWN, "static/page.css", "text/css"),
    "page.js": (_OWN, "static/page.js", "text/javascript"),
    "xterm.css": (_TERMINAL, "static/css/xterm.css", "text/css"),
    "textual.js": (_TERMINAL, "static/js/textual.js", "text/javascript"),
    "mono.ttf": (_TERMINAL, "static/fonts/RobotoMono-VariableFont_wght.ttf", "font/ttf"),
    "mono-italic.ttf": (_TERMINAL, "static/fonts/RobotoMono-Italic-VariableFont_wght.ttf", "font/ttf"),
}
_PAGE = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>Desire</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="static/xterm.css">
<link rel="stylesheet" href="static/page.css">
<script src="static/textual.js"></script>
<script src="static/page.js" defer></script>
</head>
<body>
<div class="ended">
<p>The session has ended, or this address is open in another window.</p>
<button type="button" id="again">Start again</button>
</div>
<div id="terminal" class="textual-terminal"
  data-session-websocket-url="{websocket}" data-font-size="{size}"></div>
</body>
</html>
"""
_SIZES, _SIZE = range(6, 49), 16


def static_files() -> dict[str, StaticFile]:
    """Read the files of the page."""
    return {
        name: StaticFile(_file(package, path).read_bytes(), kind)
        for name, (package, path, kind) in _FILES.items()
    }


def _file(package: str, path: str) -> Traversable:
    return files(package).joinpath(path)


def page(websocket_url: str, font_size: str) -> str:
    """Return the page that connects to a websocket; a font size that is none is the usual one."""
    size = int(font_size) if font_size.isdecimal() and len(font_size) < 3 else _SIZE
    return _PAGE.format(websocket=html.escape(websocket_url), size=size if size in _SIZES else _SIZE)
