"""LLVM: text in, addresses out. The only file that touches llvmlite (an import contract holds it so)."""

from __future__ import annotations

import functools
import re
import threading
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, TypeVar

from desire_tui.engine.codegen.ir import symbols
from desire_tui.engine.codegen.jit import stored_code
from desire_tui.engine.codegen.jit.host import Host, find_host
from desire_tui.engine.codegen.jit.image import Image
from desire_tui.engine.codegen.jit.llvm_turn import in_turn
from desire_tui.engine.codegen.jit.movable_text import has_addresses, movable_text
from desire_tui.engine.codegen.jit.placed_code import NotPlacedError, PlacedCode, can_place
from desire_tui.engine.digest import blake2b

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from desire_tui.engine.codegen.jit.linker import Linker
    from desire_tui.engine.codegen.jit.machine_code import MachineCode
    from desire_tui.engine.codegen.jit.stored_code import ObjectFile

_ATTRIBUTES = """
attributes #0 = { nounwind }
attributes #1 = { nounwind willreturn memory(none) }
attributes #2 = { nounwind willreturn memory(argmem: read) }
"""
_STARTING = threading.Lock()
_THREAD = threading.local()
Made = TypeVar("Made")
_DEFINITION = re.compile(r"^define (?!internal|private)[^@\n]*@([\w.$]+)\(", re.MULTILINE)


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
                    _llvm()
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
                self._linker = Linker(_llvm(), options, self._symbols)
            return self._linker.link(content, exported)


@functools.cache
def _llvm() -> Any:
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


def _compile_in_turn(make: Callable[[], Made], length: int) -> Made:
    if getattr(_THREAD, "may_not_load", False) and not _llvm.cache_info().currsize:
        raise LlvmNotLoadedError
    return in_turn(make, length)


def load_llvm() -> None:
    """Load LLVM before somebody waits for it."""
    with _STARTING:
        _llvm()


def _ask_llvm(library: str) -> Host:
    llvm = _llvm()
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


def module_text(functions: Iterable[str], needs: Iterable[str]) -> str:
    """Return a module: functions, and what they call (declarations, helpers)."""
    host = machine()
    extra: list[str] = []
    vectors = symbols.vector_addresses(host.width)
    for need in sorted(set(needs)):
        name = _lanes_of(need)
        if name is not None and name[1] > 1 and name[0] not in vectors:
            extra.append(symbols.lane_by_lane(*name))
            extra.append(_scalar_declaration(name[0]))
        else:
            extra.append(need)
    return "\n".join(
        (
            f'target triple = "{host.triple}"',
            *dict.fromkeys(extra),
            *functions,
            _ATTRIBUTES,
        )
    )


def _lanes_of(need: str) -> tuple[str, int] | None:
    """Return the name and width in `declare … @desire.NAME.WIDTH(…)`."""
    if not need.startswith("declare") or "@desire." not in need:
        return None
    name, width = need.split("@desire.", 1)[1].split("(", 1)[0].rsplit(".", 1)
    return name, int(width)


def _scalar_declaration(name: str) -> str:
    arguments = "double, double" if name in symbols.TWO_ARGUMENTS else "double"
    return f"declare double @desire.{name}.1({arguments}) #1"


def compile_text(
    text: str,
    *,
    level: int,
    slp: bool = False,
    vectorize: bool = False,
    passes: bool = True,
    keep: bool = False,
) -> MachineCode:
    """Compile a module at level 0 … 3. Level 0 is for quick code: no optimisation passes at all.

    Without `passes` neither at other levels: only registers and the order of instructions are chosen well.
    `keep`: later processes find the code, and so does this one if an earlier one compiled the same.
    """
    how = {"slp": slp, "vectorize": vectorize, "passes": passes}
    if keep and has_addresses(text):
        moved = _compile_movable(text, level, how) if can_place() else None
        if moved is not None:
            return moved
    elif keep:
        name = _name_of(text, level, **how)
        return kept_code(name) or compile_and_keep(text, name, level=level, **how)
    return _compile_in_turn(lambda: _placed(_compiled(text, level, **how)), len(text))


def _compile_movable(text: str, level: int, how: dict[str, bool]) -> MachineCode | None:
    """Compile a text with addresses so that other processes find the code; None: only LLVM can link it."""
    host = machine()
    moved = movable_text(text, _DEFINITION.findall(text))
    name = _name_of(moved.text, level, **how)

    def address_of(symbol: str) -> int:
        return moved.addresses[symbol] if symbol in moved.addresses else host.address_of(symbol)

    def placed(image: Image) -> MachineCode:
        functions = {known: image.functions[now] for known, now in moved.names.items()}
        return PlacedCode(image._replace(functions=functions), address_of)

    def make() -> MachineCode | None:
        made = _compiled(moved.text, level, **how)
        if not isinstance(made, Image):
            return None
        stored_code.keep(name, host.host, made)
        return placed(made)

    found = stored_code.find(name, host.host)
    if isinstance(found, Image):
        with suppress(NotPlacedError, KeyError):
            return placed(found)
    return _compile_in_turn(make, len(text))


def kept_code(name: str) -> MachineCode | None:
    """Return code that `compile_and_keep` stored for a processor like this one; None if there is none."""
    found = stored_code.find(name, machine().host)
    if found is None:
        return None
    try:
        return _placed(found) if isinstance(found, Image) else in_turn(lambda: _placed(found), 0)
    except (NotPlacedError, KeyError):
        return None


def compile_and_keep(
    text: str, name: str, *, level: int, slp: bool = False, vectorize: bool = False, passes: bool = True
) -> MachineCode:
    """Compile as `compile_text` does; later processes find the code under `name`."""

    def make() -> MachineCode:
        made = _compiled(text, level, slp=slp, vectorize=vectorize, passes=passes)
        stored_code.keep(name, machine().host, made)
        return _placed(made)

    return _compile_in_turn(make, len(text))


def _name_of(text: str, level: int, *, slp: bool, vectorize: bool, passes: bool) -> str:
    how = f"{level} {slp:d} {vectorize:d} {passes:d}\n"
    return blake2b((how + text).encode(), digest_size=16).hexdigest()


def _compiled(text: str, level: int, **how: bool) -> Image | ObjectFile:
    content = _object_file(text, level, **how)
    if can_place():
        from desire_tui.engine.codegen.jit.object_file import UnknownFormError, image_of

        with suppress(UnknownFormError):
            return image_of(content)
    return content, tuple(_DEFINITION.findall(text))


def _placed(code: Image | ObjectFile) -> MachineCode:
    host = machine()
    return PlacedCode(code, host.address_of) if isinstance(code, Image) else host.link(*code)


def _object_file(text: str, level: int, *, slp: bool, vectorize: bool, passes: bool = True) -> bytes:
    """Optimise a module and translate it."""
    llvm = _llvm()
    context = llvm.create_context()  # the global one would keep every constant of every program
    module = llvm.parse_assembly(text, context=context)
    options = machine().options(level)
    if level and passes:
        tuning = llvm.create_pipeline_tuning_options(speed_level=level)
        tuning.slp_vectorization = slp
        tuning.loop_vectorization = vectorize
        tuning.loop_unrolling = vectorize
        tuning.loop_interleaving = vectorize
        builder = llvm.create_pass_builder(options, tuning)
        manager = builder.getModulePassManager()
        manager.run(module, builder)
        # `manager.close` finds the wrong base class's method and frees nothing: 90 KB each time
        llvm.newpassmanagers.NewPassManager._dispose(manager)  # noqa: SLF001
        manager.detach()
        builder.close()
    content = bytes(options.emit_object(module))
    module.close()
    context.close()
    return content
