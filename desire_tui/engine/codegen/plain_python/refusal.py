"""The error for what `plain_python` does not compile."""

from __future__ import annotations


class PlainPythonError(Exception):
    """Names the module, line and function of a construct that cannot be compiled."""
