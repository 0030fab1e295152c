"""An error is facts first, prose later, drawing last.

A pass reports `Diagnostic(key, span, facts)`; `wording` holds the sentences by key, together with Desire's
own error number; `render` draws the line with carets under the span.
"""

from __future__ import annotations

from desire_tui.engine.diagnostics.desire_error import DesireError
from desire_tui.engine.diagnostics.diagnostic import Diagnostic, Severity, internal_error
from desire_tui.engine.diagnostics.render import render, render_all
from desire_tui.engine.diagnostics.spelling import closest

__all__ = ["DesireError", "Diagnostic", "Severity", "closest", "internal_error", "render", "render_all"]
