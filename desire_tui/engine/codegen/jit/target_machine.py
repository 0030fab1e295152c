"""The machine compiled for, and LLVM's library. The only file that touches llvmlite (an import contract)."""

from __future__ import annotations

import functools
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from desire_tui.engine.codegen.ir import symbols
from desire_tui.engine.codegen.jit.host import Host, find_host

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.engine.codegen.jit.linker import Linker
    from desire_tui.engine.codegen.jit.machine_code import MachineCode

_STARTING = threading.Lock()
_THREAD = threading.local()


class TargetMachine:
    """The machine compiled for. LLVM's library is loaded by the first who wants something compiled."""

    def __init__(self, host: Host) -> None:
        self.host = host
        self.width = host.width
        """The widest useful vector of doubles."""
        self.triple, self.cpu, self.features = host.triple, host.cpu, host.features
        self.fuses = "+fma" in self.features.split(",") or self.triple.startswith(("aarch64", "arm64"))
        """Whether a·b + c is one instruction."""
        self._options: dict[int, Any] = {}
        self._symbols: dict[str, int] = {}
        self._linker: Linker | None = None
        self._lock = threading.Lock()

    def options(self, level: int) -> Any:
        """Return LLVM's target machine for a level: one for the whole process, as it takes 0.8 MB."""
        with self._lock:
            known = self._options.get(level)
            if known is None:
                known = self._options[level] = (
                    llvm_library()
                    .Target.from_default_triple()
                    .create_target_machine(cpu=self.cpu, features=self.features, opt=level, jit=True)
                )
            return known

    def add_symbol(self, name: str, address: int) -> None:
        """Let code compiled from now on call a function of this process by a name."""
        with self._lock:
            if self._symbols.get(name) == address:
                return
            self._symbols[name] = address
            linker, self._linker = self._linker, None
        if linker is not None:
            linker.close()

    def address_of(self, name: str) -> int:
        """Return the address of a function of this process. KeyError: there is none."""
        with self._lock:
            known = self._symbols.get(name)
        return known if known is not None else symbols.process_address(name)

    def link(self, content: bytes, exported: Iterable[str]) -> MachineCode:
        """Put an object file into memory as LLVM does it."""
        from desire_tui.engine.codegen.jit.linker import Linker

        options = self.options(0)
        with self._lock:
            if self._linker is None or self._linker.is_full:
                self._linker = Linker(llvm_library(), options, self._symbols)
            return self._linker.link(content, exported)


@functools.cache
def llvm_library() -> Any:
    """Load LLVM, which takes 50 ms."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm


class LlvmNotLoadedError(Exception):
    """LLVM would have to be loaded, which is not allowed here."""


@contextmanager
def loading_llvm(*, allowed: bool) -> Iterator[None]:
    """Let this thread compile in the block; if that is not `allowed`, only where LLVM is loaded already."""
    _THREAD.may_not_load = not allowed
    try:
        yield
    finally:
        _THREAD.may_not_load = False


def require_llvm() -> None:
    """LlvmNotLoadedError: LLVM is not loaded, and this thread must not load it now."""
    if getattr(_THREAD, "may_not_load", False) and not llvm_library.cache_info().currsize:
        raise LlvmNotLoadedError


def load_llvm() -> None:
    """Load LLVM before somebody waits for it."""
    with _STARTING:
        llvm_library()


def _ask_llvm(library: str) -> Host:
    llvm = llvm_library()
    features = llvm.get_host_cpu_features().flatten()
    return Host(llvm.get_process_triple(), llvm.get_host_cpu_name(), features, library or _version())


def _version() -> str:
    import llvmlite

    return str(llvmlite.__version__)


@functools.cache
def _machine() -> TargetMachine:
    found = TargetMachine(find_host(_ask_llvm))
    for name, address in symbols.scalar_addresses().items():
        found.add_symbol(f"desire.{name}.1", address)
    both = symbols.sine_and_cosine()
    if both is not None:
        found.add_symbol("desire.sincos.1", both)
    for name, address in symbols.vector_addresses(found.width).items():
        found.add_symbol(f"desire.{name}.{found.width}", address)
    return found


def machine() -> TargetMachine:
    """Return the machine."""
    with _STARTING:
        return _machine()
