"""Scalar statements of a pass as instructions."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.work_memory import context_fields, memory_fields
from desire_tui.engine.codegen.scalar import templates
from desire_tui.engine.codegen.scalar.expressions import ScalarExpressions
from desire_tui.engine.lowered.statements import (
    DelayLine,
    Deriv,
    DerivVec,
    GetHistory,
    Guard,
    LearningStep,
    Set,
    SetDot,
    SetMat,
    SetVec,
    StoreHistory,
    Terminate,
    UpdateTrackHold,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.codegen.ir.cells import Cells
    from desire_tui.engine.codegen.ir.text import IrText
    from desire_tui.engine.lowered.statements import Action, ArrayAction


class ScalarStatements:
    """Writes statements whose pass flags are already folded in (`slices`).

    Names the text must provide: `%v` values, `%dx` derivatives (with memory cells), `%m` the run's memory,
    `%c` the model's context, `%random` the state of `ran()`.
    """

    def __init__(self, text: IrText, cells: Cells) -> None:
        self.text = text
        self.cells = cells
        self.lanes = Lanes(text)
        self.scalars = ScalarExpressions(self.lanes, cells, "%random")
        self.memory = memory_fields(text)
        self.context = context_fields(text)

    def write(self, actions: Iterable[Action]) -> None:
        """Write statements in order."""
        for action in actions:
            self.statement(action)

    def statement(self, action: Action) -> None:
        """Write one statement."""
        self.scalars.forget()
        match action:
            case Set() | Deriv():
                value = templates.write(self.text, self.cells, action.value)
                if value is None:
                    if self.single_element(action):
                        return
                    value = self.scalars.value(action.value)
                if isinstance(action, Set):
                    self.cells.store(action.slot, value)
                else:
                    self.cells.derivative(action.state, value)
            case Guard():
                self._guard(action)
            case StoreHistory():
                self._store(action)
            case GetHistory():
                self._get(action)
            case DelayLine():
                self._delay(action)
            case UpdateTrackHold():
                self._track(action)
            case Terminate():
                self._terminate(action)
            case SetVec() | SetMat() | SetDot() | DerivVec() | LearningStep():
                self.arrays(action)
            case _:
                assert_never(action)

    def single_element(self, action: Set | Deriv) -> bool:  # noqa: ARG002 - for statements over arrays
        """Write a statement over arrays of one element; return False for an ordinary one."""
        return False

    def arrays(self, action: ArrayAction) -> None:
        """Write a statement over arrays."""
        raise TypeError(f"{type(action).__name__} among scalar statements")

    # ------------------------------------------------------------------ control

    def when(self, condition: str, body: Iterable[Action], orelse: Iterable[Action] = ()) -> None:
        """Write statements that run where an i1 is set, and others where not."""
        with_else = tuple(orelse)
        yes, no, done = (f"{stem}{self.text.fresh()}" for stem in ("yes", "no", "done"))
        self.text.branch(condition, yes, no if with_else else done)
        self.text.begin(yes)
        self.cells.forget()
        self.write(body)
        self.text.jump(done)
        if with_else:
            self.text.begin(no)
            self.cells.forget()
            self.write(with_else)
            self.text.jump(done)
        self.text.begin(done)
        self.cells.forget()

    def _guard(self, guard: Guard) -> None:
        match guard.kind:
            case "if":
                assert guard.condition is not None
                condition = self.scalars.value(guard.condition)
                positive = self.lanes.compare("ogt", condition, self.lanes.const(0.0))
                self.when(positive, guard.body, guard.orelse)
            case "sample":
                self.when(self._sampled(guard.every), guard.body)
            case "out" | "step":
                self.write(guard.body)
            case _:
                assert_never(guard.kind)

    def _sampled(self, every: int) -> str:
        """Whether this point's number, through continued runs, is a multiple; a joint has had its turn."""
        op = self.text.op
        before = op(f"add i64 {self.memory.load('points_before')}, {self.memory.load('point')}")
        number = op(f"add i64 {before}, 1")
        divisible = op(f"icmp eq i64 {op(f'srem i64 {number}, {every}')}, 0")
        return op(f"and i1 {divisible}, {self._fresh_point()}")

    def _fresh_point(self) -> str:
        """Whether this is not the joint of a continued run, which was already counted.

        The driver moves `point` on before the first step, so steps inside an interval never look like a
        joint.
        """
        op = self.text.op
        later = op(f"icmp ne i64 {self.memory.load('point')}, 0")
        alone = op(f"icmp eq i64 {self.memory.load('joined')}, 0")
        return op(f"or i1 {later}, {alone}")

    def _terminate(self, action: Terminate) -> None:
        op, lanes, zero = self.text.op, self.lanes, self.lanes.const(0.0)
        value, level = self.scalars.value(action.value), zero
        if action.level is not None:
            level = self.cells.load(action.level)
            above = op(f"and i1 {lanes.compare('ogt', value, zero)}, {lanes.compare('oge', level, zero)}")
            self.cells.store(action.level, lanes.choose(above, value, zero))
        fires = lanes.compare("ogt", value, level)
        before = self.context.load("term")
        first = op(f"and i1 {fires}, {op(f'icmp slt i64 {before}, 0')}")
        self.context.store("term", op(f"select i1 {first}, i64 {action.number}, i64 {before}"))

    # ------------------------------------------------------------------ histories

    def _position(self, counter: int) -> tuple[str, str]:
        at = self.text.op(f"getelementptr i64, ptr {self.memory.load('counters')}, i64 {counter}")
        return at, self.text.op(f"load i64, ptr {at}")

    def _element(self, slot: int, index: str) -> str:
        base = self.text.op(f"getelementptr double, ptr %v, i64 {slot}")
        return self.text.op(f"getelementptr double, ptr {base}, i64 {index}")

    def _skip_unless(self, condition: str) -> str:
        yes, done = f"yes{self.text.fresh()}", f"done{self.text.fresh()}"
        self.text.branch(condition, yes, done)
        self.text.begin(yes)
        return done

    def _rejoin(self, label: str) -> None:
        self.text.jump(label)
        self.text.begin(label)
        self.cells.forget()

    def _inside(self, position: str, count: int) -> str:
        room = self.text.op(f"icmp slt i64 {position}, {count}")
        return self.text.op(f"and i1 {room}, {self._fresh_point()}")

    def _store(self, action: StoreHistory) -> None:
        at, position = self._position(action.counter)
        value = self.cells.load(action.slot)
        done = self._skip_unless(self._inside(position, action.count))
        self.text.do(f"store double {value}, ptr {self._element(action.array_slot, position)}")
        self.text.do(f"store i64 {self.text.op(f'add i64 {position}, 1')}, ptr {at}")
        self._rejoin(done)

    def _get(self, action: GetHistory) -> None:
        at, position = self._position(action.counter)
        index = self._present(position)
        done = self._skip_unless(self.text.op(f"icmp ult i64 {index}, {action.count}"))
        value = self.text.op(f"load double, ptr {self._element(action.array_slot, index)}")
        self.cells.store(action.slot, value)
        self.text.do(f"store i64 {self.text.op(f'add i64 {index}, 1')}, ptr {at}")
        self._rejoin(done)

    def _present(self, position: str) -> str:
        """Return the record of this point: a joint's was made in the run before, and is read again.

        The script may have changed what the statement assigns: the first interval must not begin with that.
        """
        back = self.text.op(f"sext i1 {self.text.op(f'xor i1 {self._fresh_point()}, true')} to i64")
        return self.text.op(f"add i64 {position}, {back}")

    def _delay(self, action: DelayLine) -> None:
        op, count = self.text.op, action.count
        source = self.scalars.value(action.source)
        at, position = self._position(action.counter)
        lags = self.memory.load("lags")
        lag = op(f"load i64, ptr {op(f'getelementptr i64, ptr {lags}, i64 {action.counter}')}")
        fresh, index = self._fresh_point(), self._present(position)
        # At a joint the buffer holds this point already, in the place of the one `count` records before.
        known = op(f"and i1 {op(f'icmp sge i64 {index}, 0')}, {op(f'icmp ne i64 {lag}, {count}')}")
        done = self._skip_unless(op(f"or i1 {fresh}, {known}"))
        behind = op(f"add i64 {op(f'sub i64 {index}, {lag}')}, {count}")
        old_place = self._element(action.buffer_slot, op(f"urem i64 {behind}, {count}"))
        old = op(f"load double, ptr {old_place}")
        now = op(f"icmp eq i64 {lag}, 0")
        self.cells.store(action.slot, op(f"select i1 {now}, double {source}, double {old}"))
        place = self._element(action.buffer_slot, op(f"urem i64 {index}, {count}"))
        kept = op(f"load double, ptr {place}")
        self.text.do(f"store double {op(f'select i1 {fresh}, double {source}, double {kept}')}, ptr {place}")
        self.text.do(f"store i64 {op(f'add i64 {index}, 1')}, ptr {at}")
        self._rejoin(done)

    def _track(self, action: UpdateTrackHold) -> None:
        control = self.scalars.value(action.control)
        value = self.scalars.value(action.value)
        done = self._skip_unless(self.lanes.compare("ogt", control, self.lanes.const(0.0)))
        self.cells.store(action.held_slot, self.cells.load(action.tracked_slot))
        self.cells.store(action.tracked_slot, value)
        self._rejoin(done)
