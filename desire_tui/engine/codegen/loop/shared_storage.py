"""Storage for models of many states: threads share the loops over them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.counted_loops import elementwise, loop
from desire_tui.engine.codegen.ir.shared_loops import write_shared
from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.loop.array_storage import ArrayStorage
from desire_tui.engine.codegen.loop.state_blocks import FIELDS

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.loop.array_storage import Visit
    from desire_tui.engine.integration.tableaus import Row


class SharedStorage(ArrayStorage):
    """Array storage whose loops over the states go block by block, `share` being the address of `pool.share`.

    What a loop finds, each block leaves in two numbers at the context's `partial`; they are looked through in
    the order of the blocks.
    """

    saves_on_the_way = True

    def __init__(self, text: IrText, stages: int, width: int, share: int) -> None:
        super().__init__(text, stages, width, contiguous=False)
        self._share = share
        self._width = width

    def _block(self) -> _Block:
        return _Block(self.stages, self._width)

    def _run(self, block: _Block) -> None:
        write_shared(self.text, self._share, block.text, "null", self.context.load("block_count"), 1)

    def _states(self, body: Visit, factor: str = "") -> None:
        block = self._block()
        if factor:
            self.context.store("factor", factor)
            block._states(body, block.context.load("factor"))  # noqa: SLF001 - of its own kind
        else:
            block._states(body)  # noqa: SLF001
        self._run(block)

    def difference(self, row: Row, dt: str) -> tuple[str, str]:
        """Largest test difference and its state, the first of several."""
        self.context.store("factor", dt)
        block = self._block()
        block.leave_found(*block.difference(row, block.context.load("factor")))
        self._run(block)
        text, lanes = self.text, self.lanes
        most, where = text.alloca("double"), text.alloca("i64")
        text.do(f"store double 0.0, ptr {most}")
        text.do(f"store i64 0, ptr {where}")

        def one(found: str) -> None:
            value = text.op(f"load double, ptr {found}")
            before = text.op(f"load double, ptr {most}")
            larger = lanes.compare("ogt", value, before)
            text.do(f"store double {lanes.choose(larger, value, before)}, ptr {most}")
            state = text.op(f"load i64, ptr {text.op(f'getelementptr double, ptr {found}, i64 1')}")
            place = text.op(f"load i64, ptr {where}")
            text.do(f"store i64 {text.op(f'select i1 {larger}, i64 {state}, i64 {place}')}, ptr {where}")

        self._each_block(one)
        return text.op(f"load double, ptr {most}"), text.op(f"load i64, ptr {where}")

    def wildness(self) -> str:
        """Return the sum of x - x."""
        block = self._block()
        block.leave_found(block.wildness(), "0")
        self._run(block)
        total = self.text.alloca("double")
        self.text.do(f"store double 0.0, ptr {total}")

        def one(found: str) -> None:
            before, more = (self.text.op(f"load double, ptr {at}") for at in (total, found))
            self.text.do(f"store double {self.lanes.add(before, more)}, ptr {total}")

        self._each_block(one)
        return self.text.op(f"load double, ptr {total}")

    def keep_change(self) -> None:
        """k2 ← k1."""
        block = self._block()
        block.keep_change()
        self._run(block)

    def _each_block(self, one: Callable[[str], None]) -> None:
        """Visit what the blocks have found, in the order of the states."""
        partial = self.context.load("partial")

        def visit(block: str) -> None:
            place = self.text.op(f"mul i64 {block}, 2")
            one(self.text.op(f"getelementptr double, ptr {partial}, i64 {place}"))

        loop(self.text, "0", self.context.load("block_count"), 1, visit)


class _Block(ArrayStorage):
    """Loops over the states of block number %first, in a text of their own."""

    first, end = "%from", "%to"

    def __init__(self, stages: int, width: int) -> None:
        super().__init__(IrText(), stages, width, contiguous=True)
        text, context = self.text, self.context
        context.name("%m", "memory")
        self.name_vectors(context)
        number = text.op(f"mul i64 %first, {FIELDS}")
        text.do(f"%block = getelementptr i64, ptr {context.load('blocks')}, i64 {number}")
        for place, name in enumerate(("%from", "%to", "%slot", "%number")):
            text.do(f"{name} = load i64, ptr {text.op(f'getelementptr i64, ptr %block, i64 {place}')}")

    def _states(self, body: Visit, factor: str = "") -> None:
        x = self.text.op(f"getelementptr double, ptr %v, i64 {self.text.op('sub i64 %slot, %from')}")
        elementwise(
            self.text, self.end, self.vector, lambda lanes, i: body(lanes, i, x, i, factor), self.first
        )

    def leave_found(self, value: str, state: str) -> None:
        """Write what is found to the block's place."""
        place = self.text.op("mul i64 %number, 2")
        at = self.text.op(f"getelementptr double, ptr {self.context.load('partial')}, i64 {place}")
        self.text.do(f"store double {value}, ptr {at}")
        self.text.do(f"store i64 {state}, ptr {self.text.op(f'getelementptr double, ptr {at}, i64 1')}")
