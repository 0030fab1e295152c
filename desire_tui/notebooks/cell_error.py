"""What is wrong with a `%%desire` cell."""

from __future__ import annotations


class CellError(Exception):
    """Ends the cell: its text is shown as it is, without the way that led to it (IPython asks for this)."""

    def _render_traceback_(self) -> list[str]:
        return str(self).splitlines()
