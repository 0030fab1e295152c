"""Programs started as in a new process, with all that can be seen of a start."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.compiler_state import CompilerState
from desire_tui.engine.codegen.pieces import kept_pieces, rolled_pieces
from desire_tui.engine.diagnostics import DesireError, render_all
from desire_tui.engine.lowered.segment import Segment
from desire_tui.engine.lowering import lowering_cache
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.engine.syntax import shapes
from desire_tui.engine.syntax.parsed_lines import forget_lines

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.nodes.program import SegmentText

LORENZ = """TMAX = 0.4 | DT = 0.01 | NN = 5
a = 10 | b = 8/3 | r = 28 | x = 1 | y = 1 | z = 20
irule 3
drun
write "x ="; x
DYNAMIC
u = x*y
d/dt x = a*(y - x)
d/dt y = x*(r - z) - y
d/dt z = u - b*z
dispt x, u, z
"""


class Heard(Listener):
    """Keeps what a headless front end hears, and gives the answers that a script asks for."""

    wants_check = False

    def __init__(self, *answers: str) -> None:
        self.text = ""
        self.answers = iter(answers)

    def console_text(self, text):
        self.text += text

    def ask(self, prompt):
        return next(self.answers)

    def program_accepted(self, program, problems):
        self.text += render_all(problems)

    def problems(self, diagnostics):
        self.text += render_all(diagnostics)


class Seen(NamedTuple):
    """What a program leaves behind."""

    text: str
    """Console output and messages."""
    samples: list[bytes]
    records: list[str]
    names: list[tuple[object, ...]]
    numbers: list[bytes]


@contextmanager
def new_session(*answers: str) -> Iterator[Session]:
    """Make a session that knows of earlier ones what is on disk."""
    forget_lines()
    shapes.forget()
    lowering_cache.forget()
    kept_pieces.forget()
    rolled_pieces.forget()
    compiler = CompilerState(keep=True)
    compiler.improver.add = lambda work: None  # type: ignore[method-assign]  # what runs is the same in each run
    try:
        yield Session(Heard(*answers), compiler=compiler)
    finally:
        compiler.close()


def segment_of(session: Session):
    """Return the segment that ran last."""
    return [*session._workspace.segments._kept.values()][-1]


def model_of(session: Session):
    """Return the model that ran last."""
    return [*session._workspace.segments.backend._models.values()][-1][2]


def is_restored(session: Session) -> bool:
    """Whether the segment that ran last came without its statements, and nobody wanted them."""
    segment = segment_of(session)
    is_whole = type(segment) is Segment or "body" in vars(segment)
    return not is_whole and not any(map(is_parsed, session.program.segments))


def is_parsed(text: SegmentText) -> bool:
    """Whether a segment's statements have been read."""
    try:
        object.__getattribute__(text, "body")
    except AttributeError:
        return False
    return True


def started(text: str, *answers: str) -> tuple[Seen, bool]:
    """Run a program as a new process does; return what it leaves behind, and if any segment was restored."""
    with new_session(*answers) as session:
        try:
            session.erun(Source(text, "program.src"))
        except DesireError as error:
            session._listener.text += render_all(error.diagnostics)
        kept = session._workspace.segments._kept.values()
        restored = any(type(segment) is not Segment for segment in kept)
        return seen(session), restored


def seen(session: Session) -> Seen:
    values, records = session.values, session.runs
    return Seen(
        session._listener.text,
        [record.rows[: record.count].tobytes() for record in records],
        [
            repr((r.ended, r.message, r.columns, r.requests, r.start.parameters, r.start.initial, r.t0, r.nn))
            for r in records
        ],
        [(q.name, q.slot, q.shape, q.kind, q.is_state, values.is_defined(q)) for q in values],
        [part.tobytes() for _, part in values.saved().numbers],
    )
