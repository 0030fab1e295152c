"""The text of one LLVM function as it grows: fresh names, blocks, and what the module must declare.

Text rather than llvmlite's builder objects: writing 1,401 equations as strings takes 3 ms, as objects 200 ms.
"""

from __future__ import annotations

import struct


def bits(value: float) -> int:
    """Return the bits of a double."""
    found: int = struct.unpack("<Q", struct.pack("<d", value))[0]
    return found


def literal(value: float) -> str:
    """Return a double as LLVM writes it exactly: its bits in hexadecimal."""
    return f"0x{bits(value):016X}"


class IrText:
    """Lines of a function's body.

    `declarations` collects what the module must hold besides: declarations of the functions called, and
    helpers' text.
    """

    __slots__ = ("_count", "allocas", "declarations", "label", "lines", "stem")

    def __init__(self, stem: str = "v") -> None:
        self.lines: list[str] = []
        self.allocas: list[str] = []
        self.declarations: set[str] = set()
        self.stem = stem
        self.label = "entry"
        self._count = 0

    def fresh(self) -> str:
        """Return a new name without its `%`."""
        self._count += 1
        return f"{self.stem}{self._count}"

    def op(self, code: str) -> str:
        """Append an instruction that gives a value; return the value's name."""
        self._count += 1
        name = f"%{self.stem}{self._count}"
        self.lines.append(f"{name} = {code}")
        return name

    def do(self, code: str) -> None:
        """Append an instruction that gives none."""
        self.lines.append(code)

    def alloca(self, kind: str, name: str | None = None) -> str:
        """Reserve a stack cell in the entry block, where LLVM can promote it to a register."""
        name = name or f"%{self.fresh()}"
        self.allocas.append(f"{name} = alloca {kind}")
        return name

    def begin(self, label: str) -> None:
        """Start a block; the one before must have ended."""
        self.lines.append(f"{label}:")
        self.label = label

    def jump(self, label: str) -> None:
        """End the block."""
        self.lines.append(f"br label %{label}")

    def branch(self, condition: str, yes: str, no: str) -> None:
        """End the block in two ways."""
        self.lines.append(f"br i1 {condition}, label %{yes}, label %{no}")

    def body(self) -> str:
        """Return the whole, entry block first."""
        return "\n".join(("entry:", *self.allocas, *self.lines))
