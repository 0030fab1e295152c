"""LLVM: text in, addresses out. The only file that touches llvmlite (an import contract holds it so)."""

from __future__ import annotations

import functools
import threading
from dataclasses import dataclass
from hashlib import blake2b
from typing import TYPE_CHECKING, Any

from desire_tui.engine import disk_cache
from desire_tui.engine.codegen.ir import symbols

if TYPE_CHECKING:
    from collections.abc import Iterable

_ATTRIBUTES = """
attributes #0 = { nounwind }
attributes #1 = { nounwind willreturn memory(none) }
attributes #2 = { nounwind willreturn memory(argmem: read) }
"""
_STARTING = threading.Lock()


@dataclass(frozen=True)
class TargetMachine:
    """The machine compiled for: LLVM's binding, its target, and the widest useful vector of doubles."""

    llvm: Any
    target: Any
    triple: str
    cpu: str
    features: str
    width: int

    def options(self, level: int) -> Any:
        """Return a new target machine; an engine takes it over."""
        return self.target.create_target_machine(cpu=self.cpu, features=self.features, opt=level)


@functools.cache
def _machine() -> TargetMachine:
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    host = llvm.get_host_cpu_features()
    for name, address in symbols.scalar_addresses().items():
        llvm.add_symbol(f"desire.{name}.1", address)
    width = 8 if host.get("avx512f") and host.get("avx512dq") else 4 if host.get("avx2") else 2
    for name, address in symbols.vector_addresses(width).items():
        llvm.add_symbol(f"desire.{name}.{width}", address)
    return TargetMachine(
        llvm, llvm.Target.from_default_triple(), llvm.get_process_triple(), llvm.get_host_cpu_name(),
        host.flatten(), width,
    )  # fmt: skip


def machine() -> TargetMachine:
    """Return the machine; the first call loads LLVM (about 60 ms)."""
    with _STARTING:
        return _machine()


class MachineCode:
    """Compiled functions; their memory is freed with this object."""

    def __init__(self, engine: Any) -> None:
        self._engine = engine

    def address(self, name: str) -> int:
        """Return a function's address."""
        return int(self._engine.get_function_address(name))


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
    engine = _engine(text, level, slp=slp, vectorize=vectorize)
    engine.finalize_object()
    return MachineCode(engine)


def _engine(text: str, level: int, *, slp: bool, vectorize: bool) -> Any:
    """Optimise a module and give it to an engine, which makes the code when it is finalized."""
    host = machine()
    llvm = host.llvm
    module = llvm.parse_assembly(text)
    options = host.options(level)
    if level:
        tuning = llvm.create_pipeline_tuning_options(speed_level=level)
        tuning.slp_vectorization = slp
        tuning.loop_vectorization = vectorize
        tuning.loop_unrolling = vectorize
        tuning.loop_interleaving = vectorize
        builder = llvm.create_pass_builder(options, tuning)
        builder.getModulePassManager().run(module, builder)
    return llvm.create_mcjit_compiler(module, options)


def kept_code(name: str) -> MachineCode | None:
    """Return code that `compile_and_keep` stored for a processor like this one; None if there is none."""
    file = _file_of(name)
    content = disk_cache.read(file)
    if content is None or not content.startswith(_mark(file)):  # LLVM aborts the process on anything else
        return None
    host = machine()
    llvm = host.llvm
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), host.options(0))
    engine.add_object_file(llvm.ObjectFileRef.from_data(content[len(_mark(file)) :]))
    engine.finalize_object()
    return MachineCode(engine)


def compile_and_keep(text: str, name: str, *, level: int, vectorize: bool) -> MachineCode:
    """Compile as `compile_text` does; later processes find the code under `name`."""
    engine = _engine(text, level, slp=False, vectorize=vectorize)
    file = _file_of(name)
    engine.set_object_cache(lambda _, content: disk_cache.write(file, _mark(file) + content))
    engine.finalize_object()
    return MachineCode(engine)


def _mark(file: str) -> bytes:
    return file.encode() + b"\n"


def _file_of(name: str) -> str:
    import llvmlite

    host = machine()
    made_for = f"{llvmlite.__version__} {host.triple} {host.cpu} {host.features}"
    return f"code-{name}-{blake2b(made_for.encode(), digest_size=8).hexdigest()}.o"
