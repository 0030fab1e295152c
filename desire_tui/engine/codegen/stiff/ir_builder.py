"""A little comfort over llvmlite's builder for the fixed functions of `callbacks` and `interval`.

They do not depend on the model, so they are built once a process: clarity before speed here.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from llvmlite import ir

from desire_tui.engine.integration.problem import SolverProblem

if TYPE_CHECKING:
    import ctypes
    from collections.abc import Iterator, Sequence

POINTER, INT, INT32, REAL, FLAG = (
    ir.PointerType(), ir.IntType(64), ir.IntType(32), ir.DoubleType(), ir.IntType(1),
)  # fmt: skip
VOID = ir.VoidType()
BYTE = ir.IntType(8)


class FixedFunction:
    """A function being built: its builder, its arguments, fields of the C structures, loops."""

    def __init__(self, module: ir.Module, name: str, result: Any, arguments: Sequence[Any]) -> None:
        self.module = module
        self.function = ir.Function(module, ir.FunctionType(result, arguments), name)
        self.arguments = self.function.args
        self.build = ir.IRBuilder(self.function.append_basic_block("entry"))

    def get(self, structure: Any, field: str, of: type[ctypes.Structure] = SolverProblem) -> Any:
        """Load a field of the structure at a pointer; addresses come as pointers."""
        place, kind = self.field(structure, field, of)
        return self.build.load(place, typ=kind)

    def put(self, structure: Any, field: str, value: Any, of: type[ctypes.Structure] = SolverProblem) -> None:
        """Store a field."""
        self.build.store(value, self.field(structure, field, of)[0])

    def add(self, structure: Any, field: str, value: Any, of: type[ctypes.Structure] = SolverProblem) -> None:
        """Count a whole-numbered field up."""
        place, kind = self.field(structure, field, of)
        self.build.store(self.build.add(self.build.load(place, typ=kind), value), place)

    def at(self, array: Any, index: Any, kind: Any = REAL) -> Any:
        """Address of an array's element."""
        return self.build.gep(array, [index], source_etype=kind)

    def load(self, array: Any, index: Any, kind: Any = REAL) -> Any:
        """Element of an array; 32-bit whole numbers come widened."""
        value = self.build.load(self.at(array, index, kind), typ=kind)
        return self.build.sext(value, INT) if kind is INT32 else value

    def store(self, array: Any, index: Any, value: Any) -> None:
        """Set an array's element."""
        self.build.store(value, self.at(array, index, value.type))

    def call(self, pointer: Any, result: Any, arguments: Sequence[Any]) -> Any:
        """Call a C function by its address."""
        kind = ir.FunctionType(result, [a.type for a in arguments])
        return self.build.call(_Callee(pointer, kind), arguments)

    def outside(self, name: str, result: Any, arguments: Sequence[Any]) -> Any:
        """Call a C function that was bound to a name."""
        known = self.module.globals.get(name)
        if known is None:
            known = ir.Function(self.module, ir.FunctionType(result, [a.type for a in arguments]), name)
        return self.build.call(known, arguments)

    def intrinsic(self, name: str, *arguments: Any) -> Any:
        """Call an LLVM intrinsic over doubles."""
        kind = ir.FunctionType(REAL, [REAL] * len(arguments))
        return self.build.call(self.module.declare_intrinsic(name, [REAL], kind), arguments)

    def copy(self, to: Any, source: Any, bytes_: Any) -> None:
        """`memcpy`."""
        kind = ir.FunctionType(VOID, [POINTER, POINTER, INT, FLAG])
        function = self.module.globals.get("llvm.memmove.p0.p0.i64") or ir.Function(
            self.module, kind, "llvm.memmove.p0.p0.i64"
        )
        self.build.call(function, [to, source, bytes_, FLAG(0)])

    @contextmanager
    def loop(self, start: Any, stop: Any) -> Iterator[Any]:
        """Repeat the body for start ≤ i < stop."""
        build = self.build
        head, body, end = (self.function.append_basic_block(n) for n in ("head", "body", "end"))
        before = build.block
        build.branch(head)
        build.position_at_end(head)
        index = build.phi(INT)
        index.add_incoming(start, before)
        build.cbranch(build.icmp_signed("<", index, stop), body, end)
        build.position_at_end(body)
        yield index
        index.add_incoming(build.add(index, INT(1)), build.block)
        build.branch(head)
        build.position_at_end(end)

    def field(self, structure: Any, field: str, of: type[ctypes.Structure]) -> tuple[Any, Any]:
        """Return a field's place and what is there; arrays and pointers are pointers."""
        offset: int = getattr(of, field).offset
        fields: Any = of._fields_
        code = getattr(next(kind for name, kind in fields if name == field), "_type_", None)
        kinds = {"d": REAL, "i": INT32, "l": INT, "q": INT}
        kind = kinds.get(code, POINTER) if isinstance(code, str) else POINTER
        return self.build.gep(structure, [INT(offset)], source_etype=BYTE), kind


class _Callee:
    """An opaque pointer with the type of the function that it points at, which the builder wants to know."""

    def __init__(self, pointer: Any, kind: ir.FunctionType) -> None:
        self.type, self.function_type = pointer.type, kind
        self.get_reference = pointer.get_reference
