"""LLVM: text in, addresses out."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import TYPE_CHECKING, TypeVar

from desire_tui.engine.codegen.ir import symbols
from desire_tui.engine.codegen.jit import stored_code
from desire_tui.engine.codegen.jit.image import Image
from desire_tui.engine.codegen.jit.llvm_turn import in_turn
from desire_tui.engine.codegen.jit.movable_text import has_addresses, movable_text
from desire_tui.engine.codegen.jit.placed_code import NotPlacedError, PlacedCode, can_place
from desire_tui.engine.codegen.jit.target_machine import llvm_library, machine, require_llvm
from desire_tui.engine.digest import blake2b

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.codegen.jit.machine_code import MachineCode
    from desire_tui.engine.codegen.jit.stored_code import ObjectFile

__all__ = ["compile_and_keep", "compile_text", "kept_code", "machine", "module_text", "name_on_disk"]

_ATTRIBUTES = """
attributes #0 = { nounwind }
attributes #1 = { nounwind willreturn memory(none) }
attributes #2 = { nounwind willreturn memory(argmem: read) }
"""
Made = TypeVar("Made")
_DEFINITION = re.compile(r"^define (?!internal|private)[^@\n]*@([\w.$]+)\(", re.MULTILINE)


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


def _compile_in_turn(make: Callable[[], Made], length: int) -> Made:
    require_llvm()
    return in_turn(make, length)


def kept_code(name: str) -> MachineCode | None:
    """Return code that `compile_and_keep` stored for a processor like this one; None if there is none."""
    found = stored_code.find(name, machine().host)
    if found is None:
        return None
    try:
        return _placed(found) if isinstance(found, Image) else in_turn(lambda: _placed(found), 0)
    except (NotPlacedError, KeyError):
        return None


def name_on_disk(text: str, *, level: int, slp: bool = False) -> str | None:
    """Return the name by which `kept_code` finds a text that `compile_text` kept; None: it has addresses."""
    return None if has_addresses(text) else _name_of(text, level, slp=slp, vectorize=False, passes=True)


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
    llvm = llvm_library()
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
