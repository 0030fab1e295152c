"""What a step does with each state, where there are many: by blocks that threads share.

The same as in `step`, and no number depends on who does a block, nor on the number of threads.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.switching.mathematics import fused
from desire_tui.engine.integration.taylor.memory import FOUND, STATES_OF_A_BLOCK

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Address, Reals
    from desire_tui.engine.integration.taylor.memory import Taylor


def scan(s: Taylor) -> float:
    """Keep the states at the step's start; find the largest of the last two coefficients, of scaled states.

    Leave them in `found`, in the first block's place, whose the second is in `found_states`; return the sum.
    """
    s.share(s.scan_block, s.itself, s.itself, s.itself, s.block_count, 1)
    total: float = s.found[3]
    for block in range(1, s.block_count):
        place = FOUND * block
        s.found[0] = max(s.found[0], s.found[place])
        s.found[1] = max(s.found[1], s.found[place + 1])
        if s.found[place + 2] > s.found[2]:
            s.found[2] = s.found[place + 2]
            s.found_states[0] = s.found_states[place]
        total += s.found[place + 3]
    return total


def scan_block(s: Taylor, _values: Address, _context: Address, block: int, _next: int) -> None:
    """Do so for a block of states: the largest magnitude, the largest of both coefficients, their sum."""
    start = block * STATES_OF_A_BLOCK
    stop = min(start + STATES_OF_A_BLOCK, s.n)
    order = s.order
    most = 0.0
    before = 0.0
    last = 0.0
    worst = 0
    total = 0.0
    for k in range(s.piece_count):
        at = s.pieces[4 * k]
        place = s.pieces[4 * k + 2] + order * s.pieces[4 * k + 3] - at
        down = place - s.pieces[4 * k + 3]
        for i in range(max(start, at), min(stop, at + s.pieces[4 * k + 1])):
            s.base[i] = s.y[i]
            s.base_rest[i] = s.rest[i]
            size = max(s.largest[i], abs(s.y[i]))
            s.largest[i] = size
            most = max(most, size)
            if size == 0.0:
                size = 1.0
            size = 1.0 / max(size, s.floor)
            a = abs(s.coefficients[down + i]) * size
            b = abs(s.coefficients[place + i]) * size
            total += a + b
            before = max(before, a)
            if b > last:
                last = b
                worst = i
    place = FOUND * block
    s.found[place] = most
    s.found[place + 1] = before
    s.found[place + 2] = last
    s.found[place + 3] = total
    s.found_states[place] = worst


def move(s: Taylor, h: float) -> None:
    """Put the solution at the step's end into `y`, what it is rounded by into `rest` (`step.add_up`)."""
    s.h_now = h
    s.share(s.move_block, s.itself, s.itself, s.itself, s.block_count, 1)


def move_block(s: Taylor, _values: Address, _context: Address, block: int, _next: int) -> None:
    """Do so for a block of states."""
    start = block * STATES_OF_A_BLOCK
    stop = min(start + STATES_OF_A_BLOCK, s.n)
    c: Reals = s.coefficients
    y: Reals = s.y
    h: float = s.h_now
    for k in range(s.piece_count):
        at = s.pieces[4 * k]
        apart = s.pieces[4 * k + 3]
        low = max(start, at)
        high = min(stop, at + s.pieces[4 * k + 1])
        j = s.order
        place = s.pieces[4 * k + 2] + j * apart - at
        for i in range(low, high):
            y[i] = c[place + i]
        while j >= 2:
            j -= 1
            place -= apart
            for i in range(low, high):
                y[i] = fused(y[i], h, c[place + i])
    for i in range(start, stop):
        x: float = s.base[i]
        change = y[i] * h + s.base_rest[i]
        moved = x + change
        part = moved - x
        y[i] = moved
        s.rest[i] = (x - (moved - part)) + (change - part)
