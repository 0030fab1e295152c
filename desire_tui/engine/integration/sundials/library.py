"""Finding and loading the SUNDIALS libraries.

scikit-sundae's wheel carries them privately (`scikit_sundae.libs/libsundials_cvode-….so`); its own Python
interface is not used. The build has 64-bit reals and **32-bit indices**, which is checked by looking at a
vector made by it.
"""

from __future__ import annotations

import ctypes
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.sundials.signatures import CORE, CVODE, SUPERLU, declare

WANTED = (7, 9)
"""Major and minor version of SUNDIALS that the signatures were written for."""


@dataclass(frozen=True)
class Libraries:
    """The loaded libraries; functions are attributes with their argument types declared."""

    core: ctypes.CDLL
    cvode: ctypes.CDLL


@cache
def libraries() -> Libraries:
    """Load SUNDIALS' core and CVODE (once). DesireError 460: not installed; 461: another version or build."""
    try:
        core = ctypes.CDLL(str(_find("core")))
        cvode = ctypes.CDLL(str(_find("cvode")))
        declare(core, CORE)
        declare(cvode, CVODE)
    except (OSError, AttributeError) as failure:
        raise DesireError(Diagnostic("solver-missing", facts={"reason": str(failure)})) from failure
    version = _version(core)
    if version[:2] != WANTED:
        found, wanted = ".".join(map(str, version)), ".".join(map(str, WANTED))
        raise DesireError(Diagnostic("solver-version", facts={"found": found, "wanted": wanted}))
    loaded = Libraries(core, cvode)
    if not _indices_are_32_bit(loaded):
        facts = {"found": "a build with 64-bit indices", "wanted": "32-bit indices"}
        raise DesireError(Diagnostic("solver-version", facts=facts))
    return loaded


@cache
def is_there() -> bool:
    """Whether SUNDIALS can be had: scikit-sundae has no wheel for every machine (Linux on ARM)."""
    try:
        libraries()
    except DesireError:
        return False
    return True


@cache
def superlu() -> ctypes.CDLL | None:
    """Load the sparse direct solver SuperLU_MT (it brings OpenBLAS: 0.1 s); None where the wheel has none."""
    try:
        library = ctypes.CDLL(str(_find("sunlinsolsuperlumt")))
        declare(library, SUPERLU)
    except (OSError, AttributeError):
        return None
    return library


def _find(part: str) -> Path:
    package = find_spec("sksundae")
    if package is None or package.origin is None:
        raise OSError("the package scikit-sundae is not installed")
    home = Path(package.origin).parent
    folders = (home.parent / "scikit_sundae.libs", home / ".dylibs")  # Linux's wheel, macOS's wheel
    for folder in folders:
        for name in sorted(folder.glob(f"libsundials_{part}[-.]*")):
            return name
    raise OSError(f"scikit-sundae's wheel has no library libsundials_{part}")


def _version(core: ctypes.CDLL) -> tuple[int, int, int]:
    major, minor, patch = ctypes.c_int(), ctypes.c_int(), ctypes.c_int()
    label = ctypes.create_string_buffer(32)
    core.SUNDIALSGetVersionNumber(
        ctypes.byref(major), ctypes.byref(minor), ctypes.byref(patch), label, len(label)
    )
    return major.value, minor.value, patch.value


def _indices_are_32_bit(loaded: Libraries) -> bool:
    """Look at a vector's content: `{int32 length; int32 own_data; double* data}`, the pointer at byte 8."""
    context = ctypes.c_void_p()
    loaded.core.SUNContext_Create(0, ctypes.byref(context))
    data = (ctypes.c_double * 3)(1.0, 2.0, 3.0)
    vector = loaded.cvode.N_VMake_Serial(3, ctypes.addressof(data), context)
    content = ctypes.cast(vector, ctypes.POINTER(ctypes.c_uint64))[0]
    words = (ctypes.c_uint64 * 2).from_address(content)
    good = words[0] & 0xFFFFFFFF == 3 and words[1] == ctypes.addressof(data)
    loaded.cvode.N_VDestroy_Serial(vector)
    loaded.core.SUNContext_Free(ctypes.byref(context))
    return good
