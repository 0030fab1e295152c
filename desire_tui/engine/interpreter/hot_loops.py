"""Loops that go round often become one function each (`loop_fusion`), where their statements allow it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.interpreter.loop_fusion import NotFusible, fuse, may_be_fused

if TYPE_CHECKING:
    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.statement_context import StatementContext

HOT = 200
"""Passes before a loop is made into a function: that takes as long as some 200 passes."""
_WRITTEN_ANEW = (8, 64)
"""Ways out taken: statements in rare branches were reached meanwhile, and can be in the function."""
_GIVEN_UP = 256
"""Ways out taken before a function that is mostly left at once is given up."""
_PASSES_WORTH_IT = 4
"""Between two ways out."""


def warm(context: StatementContext, plain: Operation, again: int) -> Operation:
    """Return the operation of the statement that ends a loop's pass.

    `plain` is the operation as it stands; it returns the address `again` for one more pass.
    """
    text = context.code.text
    if not may_be_fused(text, text.structure.partner[context.place]):
        return plain
    passes = 0
    loop = _HotLoop(context, plain, again)

    def counting() -> int:
        nonlocal passes
        following = plain()
        if following == again:
            passes += 1
            if passes == HOT:
                loop.write()
        return following

    return counting


class _HotLoop:
    """One loop, at the statement that ends its pass."""

    def __init__(self, context: StatementContext, plain: Operation, again: int) -> None:
        self._context = context
        self._plain = plain
        self._again = again
        self._opening = context.code.text.structure.partner[context.place]
        self._passes = [0]
        self._ways_out = 0

    def write(self) -> None:
        """Make the loop into a function, and use it from now on; a loop that cannot be one stays as it is."""
        context, plain, again = self._context, self._plain, self._again
        table, after = context.machine.code_table, context.next
        first, last = context.code.base + self._opening, context.address
        must_leave = context.machine.must_leave
        try:
            run = fuse(context.machine, context.code, self._opening, self._passes)
        except NotFusible:
            table.replace_operation(context.address, plain)
            return

        def entering() -> int:
            following = plain()
            if following != again or must_leave(first, last):
                return following
            following = run()
            if following != after:
                self._left()
            return following

        table.replace_operation(context.address, entering)

    def _left(self) -> None:
        """Note that a way out was taken."""
        self._ways_out += 1
        if self._ways_out in _WRITTEN_ANEW:
            self.write()
        elif self._ways_out == _GIVEN_UP and self._passes[0] < _PASSES_WORTH_IT * _GIVEN_UP:
            self._context.machine.code_table.replace_operation(self._context.address, self._plain)
