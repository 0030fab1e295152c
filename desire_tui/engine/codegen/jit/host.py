"""The machine compiled for, as LLVM sees it; told by a note on disk where LLVM itself need not be loaded."""

from __future__ import annotations

import marshal
import os
import sys
from importlib.util import find_spec
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine import disk_cache
from desire_tui.engine.digest import blake2b

if TYPE_CHECKING:
    from collections.abc import Callable

_FORMAT = 1
_MARSHAL = 2
"""The oldest form with all that is needed: every Python reads it."""
_FLEETING = (
    b"processor",
    b"cpu MHz",
    b"bogomips",
    b"BogoMIPS",
    b"core id",
    b"physical id",
    b"apicid",
    b"initial apicid",
)
"""What Linux tells of the first processor that differs between two looks, or between processors."""
_FIRST_PROCESSOR = 8192


class Host(NamedTuple):
    """What decides which code is made."""

    triple: str
    cpu: str
    features: str
    """As LLVM takes them: `+avx2,-avx512f,…`."""
    library: str
    """LLVM's, as a file: another one is another compiler."""

    @property
    def width(self) -> int:
        """The widest useful vector of doubles."""
        found = set(self.features.split(","))
        return 8 if {"+avx512f", "+avx512dq"} <= found else 4 if "+avx2" in found else 2

    @property
    def digest(self) -> str:
        """A name for all of it."""
        return blake2b(repr(tuple(self)).encode(), digest_size=8).hexdigest()


def find_host(ask: Callable[[str], Host]) -> Host:
    """Return the machine, from the note if there is one; `ask` LLVM else, given its `library`."""
    library, processor = _library(), _processor()
    if library is None or processor is None:
        return ask(library or "")
    name = f"machine-{blake2b(f'{_FORMAT} {library} {processor!r}'.encode(), digest_size=8).hexdigest()}"
    content = disk_cache.read(name) if disk_cache.holds_only_ours() else None
    if content is not None:
        return Host(*marshal.loads(content))  # noqa: S302 - a file of ours, whole
    found = ask(library)
    disk_cache.write(name, marshal.dumps(tuple(found), _MARSHAL))
    return found


def _library() -> str | None:
    """Return a text that tells LLVM's library from others. ImportError: there is none."""
    spec = find_spec("llvmlite")
    if spec is None or spec.origin is None:
        raise ImportError(name="llvmlite")
    for name in ("libllvmlite.so", "libllvmlite.dylib"):
        try:
            status = os.stat(os.path.join(os.path.dirname(spec.origin), "binding", name))  # noqa: PTH116, PTH118, PTH120 - pathlib would add 5 ms to every start
        except OSError:
            continue
        return f"{spec.origin} {status.st_size} {status.st_mtime_ns}"
    return None


def _processor() -> bytes | None:
    """Return what Linux tells of the first processor; None: nothing."""
    if sys.platform != "linux":
        return None
    try:
        with open("/proc/cpuinfo", "rb", buffering=0) as file:  # noqa: PTH123 - as above
            told = file.read(_FIRST_PROCESSOR)
    except OSError:
        return None
    first = told.partition(b"\n\n")[0]
    kept = [line for line in first.splitlines() if not line.startswith(_FLEETING)]
    uname = os.uname()
    return b"\n".join([uname.machine.encode(), *kept]) if kept else None
