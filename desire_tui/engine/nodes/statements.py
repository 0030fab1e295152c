"""The statements of the language as unions of their classes: what each dispatch over statements must know.

A class that is missing in a dispatch is named by the type checker: every `match` over statements ends in
`assert_never`. A new class goes into one of the unions first (those of `segment` have theirs there).
"""

from __future__ import annotations

from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed, Simple
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import Display, GraphText, Plot, Request, Show, ShowArea
from desire_tui.engine.nodes.faulty import Faulty
from desire_tui.engine.nodes.files import (
    Connect,
    Data,
    Disconnect,
    Dump,
    Input,
    LoadData,
    Note,
    Read,
    Restore,
    Write,
)
from desire_tui.engine.nodes.segment import SegmentOnly

SharedStatement = Assign | Bare | Dot | Faulty | MatrixAssign | VectorAssign | If | Simple | Show | ShowArea
"""Statements of both the script and DYNAMIC segments."""

ScriptOnlyStatement = (
    For | While | Until | Label | GoTo | Procedure | CallProcedure
    | Declare | Function | Submodel
    | Data | LoadData | Read | Restore | Input | Write | Connect | Disconnect | Dump | Note
    | FileCommand | Irule | Seed | Drun | Fft | Display | GraphText | Plot
)  # fmt: skip
"""Statements and commands that no segment may hold."""

SegmentOnlyStatement = SegmentOnly | Request
"""Statements that only segments (and the submodels they invoke) may hold."""

Statement = SharedStatement | ScriptOnlyStatement | SegmentOnlyStatement
