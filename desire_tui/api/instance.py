"""A program in a session of its own, brought to its first run; and a pool of them, one for each thread."""

from __future__ import annotations

from contextlib import contextmanager
from math import inf
from threading import Lock
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

from desire_tui.api import interrupts
from desire_tui.batch.headless_listener import HeadlessListener
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.session import Session

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from desire_tui.engine.session.kept_expressions import KeptExpressions
    from desire_tui.engine.session.prepared_run import PreparedRun
    from desire_tui.engine.session.session import BackendName
    from desire_tui.engine.source import Source

ELEMENTS = 1 << 24
"""Array elements for which address space is reserved at first: many models may be loaded at once."""


class LoadOptions(NamedTuple):
    """How a program is brought to its first run."""

    segment: str | None = None
    answers: tuple[str, ...] = ()
    backend: BackendName = "native"
    allow_shell: bool = False
    allow_write: bool = False
    keep: KeptExpressions | None = None
    """Expressions that runs sample besides what the program displays."""


class Way(NamedTuple):
    """How settings of certain names take effect in one instance.

    `slots`: the numbers are put there when a run begins, then `follow` computes again what depends on them.
    No slots: the script has to run again with the values in place of its own. `computed` are the slots that
    `follow` may change.
    """

    slots: tuple[int, ...] | None
    follow: Callable[[], None] | None
    computed: tuple[int, ...] = ()


class Instance:
    """A program that one thread at a time may run. DesireError: it does not come to a run."""

    def __init__(self, source: Source, options: LoadOptions) -> None:
        self._source, self._options = source, options
        self._elements: int | None = ELEMENTS
        self.overrides: dict[str, float] | None = {}
        """What the script was run with in place of its own values; None: it did not come to the run."""
        self.ways: dict[tuple[str, ...], Way] = {}
        self._prepare()

    def _prepare(self) -> None:
        try:
            self._begin()
        except DesireError as error:
            if self._elements is None or all(d.key != "out-of-memory" for d in error.diagnostics):
                raise
            self._elements = None
            self._begin()

    def _begin(self) -> None:
        options = self._options
        self.listener = HeadlessListener(_ignore, iter(self._next_answer, None), _ignore)
        self.session = Session(
            self.listener, backend=options.backend, elements_most=self._elements,
            permissions=Permissions(shell=options.allow_shell, files=options.allow_write),
        )  # fmt: skip
        self.session.keep(options.keep)
        interrupts.watch(self.session.control)
        self._reach()

    def _reach(self) -> None:
        self._answers = iter(self._options.answers)
        self.ways = {names: way for names, way in self.ways.items() if way.slots is None}
        settings, self.overrides = self.overrides or {}, None
        self.session.override(settings)
        self.prepared: PreparedRun = self.session.prepare(self._source, self._options.segment)
        self.overrides = settings

    def _next_answer(self) -> str | None:
        return next(self._answers, None)

    def override(self, settings: Mapping[str, float]) -> None:
        """Run the script anew with these values in place of its own, unless it was run with them last."""
        if self.overrides != settings:
            self.overrides = dict(settings)
            self._reach()


def _ignore(_: object) -> None:
    return


Kind = TypeVar("Kind", bound=Instance)


class InstancePool(Generic[Kind]):
    """Instances of one program. Who takes one has it alone; one that was left by Ctrl-C is not used again.

    `idle_most` limits those that wait for somebody to take them.
    """

    def __init__(self, make: Callable[[], Kind], idle_most: float = inf) -> None:
        self.make = make
        self._idle: list[Kind] = []
        self._idle_most = idle_most
        self._lock = Lock()

    @contextmanager
    def one(self) -> Iterator[Kind]:
        """Lend an instance, the one that was given back last."""
        with self._lock:
            instance = self._idle.pop() if self._idle else None
        if instance is None:
            instance = self.make()
        else:
            interrupts.watch(instance.session.control)
        try:
            yield instance
        except Exception:
            self._give_back(instance)
            raise
        self._give_back(instance)

    def _give_back(self, instance: Kind) -> None:
        with self._lock:
            if len(self._idle) < self._idle_most:
                self._idle.append(instance)

    def __len__(self) -> int:
        return len(self._idle)
