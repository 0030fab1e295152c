"""BLAKE2b: names for contents. `hashlib` loads OpenSSL's library too, 3 ms of every start."""

from __future__ import annotations

try:
    from _blake2 import blake2b  # CPython's own, which `hashlib` hands on
except ImportError:
    from hashlib import blake2b

__all__ = ["blake2b"]
