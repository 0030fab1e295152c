"""LLVM: text in, addresses out. The only file that touches llvmlite (an import contract holds it so)."""

from __future__ import annotations

import functools
import re
import threading
from hashlib import blake2b
from typing import TYPE_CHECKING, Any

from desire_tui.engine import disk_cache
from desire_tui.engine.codegen.ir import symbols
from desire_tui.engine.codegen.jit.linker import Linker
from desire_tui.engine.codegen.jit.llvm_turn import in_turn

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.codegen.jit.linker import MachineCode

_ATTRIBUTES = """
attributes #0 = { nounwind }
attributes #1 = { nounwind willreturn memory(none) }
attributes #2 = { nounwind willreturn memory(argmem: read) }
"""
_FORMAT = 2
"""Of stored code: exported names before the object file."""
_STARTING = threading.Lock()
_DEFINITION = re.compile(r"^define (?!internal|private)[^@\n]*@([\w.$]+)\(", re.MULTILINE)


class TargetMachine:
    """The machine compiled for: LLVM's binding, its target, and the widest useful vector of doubles."""

    def __init__(self, llvm: Any, target: Any, width: int) -> None:
        self.llvm = llvm
        self.width = width
        self.triple: str = llvm.get_process_triple()
        self.cpu: str = llvm.get_host_cpu_name()
        self.features: str = llvm.get_host_cpu_features().flatten()
        self.fuses = "+fma" in self.features.split(",") or self.triple.startswith(("aarch64", "arm64"))
        """Whether a·b + c is one instruction."""
        self._target = target
        self._options: dict[int, Any] = {}
        self._symbols: dict[str, int] = {}
        self._linker: Linker | None = None
        self._lock = threading.Lock()

    def options(self, level: int) -> Any:
        """Return LLVM's target machine for a level: one for the whole process, as it takes 0.8 MB."""
        with self._lock:
            known = self._options.get(level)
            if known is None:
                known = self._options[level] = self._target.create_target_machine(
                    cpu=self.cpu, features=self.features, opt=level, jit=True
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

    def link(self, content: bytes, exported: Iterable[str]) -> MachineCode:
        """Put an object file into memory."""
        options = self.options(0)
        with self._lock:
            if self._linker is None or self._linker.is_full:
                self._linker = Linker(self.llvm, options, self._symbols)
            return self._linker.link(content, exported)


@functools.cache
def _machine() -> TargetMachine:
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    host = llvm.get_host_cpu_features()
    width = 8 if host.get("avx512f") and host.get("avx512dq") else 4 if host.get("avx2") else 2
    found = TargetMachine(llvm, llvm.Target.from_default_triple(), width)
    for name, address in symbols.scalar_addresses().items():
        found.add_symbol(f"desire.{name}.1", address)
    both = symbols.sine_and_cosine()
    if both is not None:
        found.add_symbol("desire.sincos.1", both)
    for name, address in symbols.vector_addresses(width).items():
        found.add_symbol(f"desire.{name}.{width}", address)
    return found


def machine() -> TargetMachine:
    """Return the machine; the first call loads LLVM (about 60 ms)."""
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


def compile_text(text: str, *, level: int, slp: bool = False, vectorize: bool = False) -> MachineCode:
    """Compile a module at level 0 … 3. Level 0 is for quick code: no optimisation passes at all."""
    host = machine()

    def make() -> MachineCode:
        return host.link(_object_file(text, level, slp=slp, vectorize=vectorize), _exported(text))

    return in_turn(make, len(text))


def _exported(text: str) -> list[str]:
    """Return the names of the functions that a module defines for others."""
    return _DEFINITION.findall(text)


def _object_file(text: str, level: int, *, slp: bool, vectorize: bool) -> bytes:
    """Optimise a module and translate it."""
    host = machine()
    llvm = host.llvm
    context = llvm.create_context()  # the global one would keep every constant of every program
    module = llvm.parse_assembly(text, context=context)
    options = host.options(level)
    if level:
        tuning = llvm.create_pipeline_tuning_options(speed_level=level)
        tuning.slp_vectorization = slp
        tuning.loop_vectorization = vectorize
        tuning.loop_unrolling = vectorize
        tuning.loop_interleaving = vectorize
        builder = llvm.create_pass_builder(options, tuning)
        passes = builder.getModulePassManager()
        passes.run(module, builder)
        # `passes.close` finds the wrong base class's method and frees nothing: 90 KB each time
        llvm.newpassmanagers.NewPassManager._dispose(passes)  # noqa: SLF001
        passes.detach()
        builder.close()
    content = bytes(options.emit_object(module))
    module.close()
    context.close()
    return content


def kept_code(name: str) -> MachineCode | None:
    """Return code that `compile_and_keep` stored for a processor like this one; None if there is none."""
    file = _file_of(name)
    content = disk_cache.read(file) if disk_cache.holds_only_ours() else None  # native code is run unseen
    if content is None or not content.startswith(_mark(file)):  # LLVM aborts the process on anything else
        return None
    exported, _, code = content[len(_mark(file)) :].partition(b"\n")
    host = machine()
    return in_turn(lambda: host.link(code, exported.decode("ascii").split()), 0)


def compile_and_keep(text: str, name: str, *, level: int, vectorize: bool) -> MachineCode:
    """Compile as `compile_text` does; later processes find the code under `name`."""
    host, exported, file = machine(), _exported(text), _file_of(name)

    def make() -> MachineCode:
        content = _object_file(text, level, slp=False, vectorize=vectorize)
        disk_cache.write(file, _mark(file) + " ".join(exported).encode("ascii") + b"\n" + content)
        return host.link(content, exported)

    return in_turn(make, len(text))


def _mark(file: str) -> bytes:
    return file.encode() + b"\n"


def _file_of(name: str) -> str:
    import llvmlite

    host = machine()
    made_for = f"{_FORMAT} {llvmlite.__version__} {host.triple} {host.cpu} {host.features}"
    return f"code-{name}-{blake2b(made_for.encode(), digest_size=8).hexdigest()}.o"
