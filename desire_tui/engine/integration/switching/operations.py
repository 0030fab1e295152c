"""The instructions of programs over t."""

from __future__ import annotations

from enum import IntEnum


class Operation(IntEnum):
    """What an instruction computes; from THRESHOLD on it switches."""

    ADD = 0
    SUB = 1
    MUL = 2
    DIV = 3
    NEG = 4
    SIN = 5
    COS = 6
    EXP = 7
    LN = 8
    SQRT = 9
    ATAN = 10
    TANH = 11
    THRESHOLD = 20
    SWTCH = 21
    SGN = 22
    ROUND = 23
    TRNC = 24
    FLOOR = 25
    DEADC = 26
    RECT = 27
    KINK = 40
    """From here on derivatives have a kink only."""
    LIM = 41
    ABS = 42
    SAT = 43
    SAT_ABOVE = 44
    DEADZ = 45
    TABLE = 46
    MAX = 60
    """From here on with two arguments."""
    MIN = 61


BY_NAME = {
    "add": Operation.ADD, "sub": Operation.SUB, "mul": Operation.MUL, "div": Operation.DIV,
    "neg": Operation.NEG, "sin": Operation.SIN, "cos": Operation.COS, "exp": Operation.EXP,
    "ln": Operation.LN, "sqrt": Operation.SQRT, "atan": Operation.ATAN, "tanh": Operation.TANH,
    "swtch": Operation.SWTCH, "sgn": Operation.SGN, "round": Operation.ROUND, "trnc": Operation.TRNC,
    "floor": Operation.FLOOR,
    "deadc": Operation.DEADC, "rect": Operation.RECT, "lim": Operation.LIM, "abs": Operation.ABS,
    "sat": Operation.SAT, "SAT": Operation.SAT_ABOVE, "deadz": Operation.DEADZ, "max": Operation.MAX,
    "min": Operation.MIN,
}  # fmt: skip
"""Operations of `lowered.expressions.Op`; `comp`, `tri`, `recip` and `ipow` are made of these."""
