"""What is stored of a program's start: when it is taken, when not, and that nothing is read without need."""

from __future__ import annotations

import ctypes
import marshal

import pytest

from desire_tui.engine import disk_cache
from desire_tui.engine.codegen import native_model
from desire_tui.engine.codegen.jit import compiler
from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowered.segment import Segment
from desire_tui.engine.session import workspace
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.engine.values import Values
from desire_tui.engine.warm_start import start_file
from desire_tui.engine.warm_start.segment_facts import layout_digest, segment_facts
from tests.lowering.programs import segment
from tests.warm_start.starts import LORENZ, is_restored, model_of, new_session, segment_of, started


@pytest.fixture
def first(stored):
    """What the first start leaves behind."""
    outcome, restored = started(LORENZ)
    assert not restored
    return outcome


def files(folder, kind="start-"):
    return sorted(path for path in folder.iterdir() if path.name.startswith(kind))


def test_a_second_start_reads_no_equation_and_compiles_nothing(first, monkeypatch):
    monkeypatch.setattr(compiler, "_compiled", lambda *_, **__: pytest.fail("compiled"))
    assert started(LORENZ) == (first, True)
    with new_session() as session:
        session.erun(Source(LORENZ))
        assert is_restored(session)


@pytest.mark.parametrize("lines", ["u = x*y", "step\nu = x*y", "u = x*y\nstep"])
def test_its_equations_are_there_when_somebody_asks(stored, monkeypatch, lines):
    text = LORENZ.replace("u = x*y", lines)
    started(text)
    with new_session() as session:
        session.erun(Source(text, "program.src"))
        restored, program = segment_of(session), session.program
        assert is_restored(session)
        session.execute("a = 3 | late = 2 | ARRAY more[3]")  # what came later is not seen
        with new_session() as other:
            monkeypatch.setattr(workspace, "STORED_LEAST", 10**6)
            other.erun(Source(text, "program.src"))
            plain = segment_of(other)
            assert type(restored) is not type(plain)
            for field in ("body", "names", *plain.__match_args__):
                assert getattr(restored, field) == getattr(plain, field)
            for part, known in zip(program.segments, other.program.segments, strict=True):
                assert (part.body, part.jacobian) == (known.body, known.jacobian)
                assert (part.label, part.at) == (known.label, known.at)


def test_scratch_memory_is_that_of_the_first_start(stored):
    text = LORENZ.replace("u = x*y", "Vector v = tanh(W*q) + W*v2\nu = x*y").replace(
        "drun", "ARRAY v[3], v2[3], q[3], W[3,3] | drun"
    )
    temps = []
    for _ in range(2):
        with new_session() as session:
            session.erun(Source(text))
            temps.append(model_of(session)._tables.temps)
    assert is_restored(session)
    assert temps[0] == temps[1] > 0


def test_values_that_override_the_scripts(first):
    for restored in (True, False):
        with new_session() as session:
            session.override({} if restored else {"a": 3.0})
            session.erun(Source(LORENZ))
            assert (type(segment_of(session)) is not Segment) is restored
    assert session.runs[0].start.parameters["a"] == 3.0


def test_what_cannot_be_restored_is_not_stored():
    made, values = segment("d/dt x = -x\nu = x", x=1)
    layout = values.layout()
    assert segment_facts(made, 1, layout, layout) is not None
    assert segment_facts(made, 1, layout, replace(layout, arrays=layout.arrays + 8)) is None
    assert segment_facts(made, 1, layout, replace(layout, defined=b"\1" + layout.defined[1:])) is None
    assert segment_facts(replace(made, counters=1), 1, layout, layout) is None


def test_changed_characters_are_another_program(first):
    changed = LORENZ.replace("u - b*z", "u + b*z")
    outcome, restored = started(changed)
    assert not restored
    assert outcome.samples != first.samples
    assert started(changed) == (outcome, True)
    assert started(LORENZ) == (first, True)


@pytest.mark.parametrize("damage", [b"", b"\0" * 1000, "cut", "bit"])
def test_a_damaged_file_is_not_there(first, stored, damage):
    (file,) = files(stored)
    content = file.read_bytes()
    forms = {"cut": content[:-1], "bit": content[:-1] + bytes([content[-1] ^ 1])}
    file.write_bytes(forms.get(damage, damage))
    assert started(LORENZ) == (first, False)
    assert started(LORENZ) == (first, True)


@pytest.mark.parametrize(
    "form", [(), 7, ("{name}",), ("{name}", 7), ("{name}", ()), ("{name}", ((1, 2), ((3, 4),)))]
)
def test_a_file_of_another_form_is_not_there(first, stored, form):
    (file,) = files(stored)
    named = (
        tuple(file.name if part == "{name}" else part for part in form) if isinstance(form, tuple) else form
    )
    disk_cache.write(file.name, marshal.dumps(named))
    assert started(LORENZ) == (first, False)


def test_another_programs_file_is_not_taken(first, stored):
    other = LORENZ.replace("28", "27")
    started(other)
    names = [start_file.name_of(text) for text in (LORENZ, other)]
    (stored / names[1]).replace(stored / names[0])
    assert started(LORENZ) == (first, False)


def test_another_engines_file_is_not_taken(first, monkeypatch):
    monkeypatch.setattr(start_file, "engine_digest", lambda: b"another")
    assert started(LORENZ) == (first, False)
    assert started(LORENZ) == (first, True)


def test_an_engine_that_was_changed_meanwhile_stores_nothing(stored, monkeypatch):
    monkeypatch.setattr(start_file, "engine_digest", lambda: None)
    assert started(LORENZ)[1] is started(LORENZ)[1] is False
    assert not stored.exists()


def test_a_folder_of_others_is_not_read(first, monkeypatch):
    monkeypatch.setattr(disk_cache, "holds_only_ours", lambda: False)
    assert started(LORENZ) == (first, False)


@pytest.fixture
def compiled(monkeypatch):
    """Levels of what is compiled."""
    compile_now, levels = compiler._compiled, []

    def counted(text, level, **how):
        levels.append(level)
        return compile_now(text, level, **how)

    monkeypatch.setattr(compiler, "_compiled", counted)
    return levels


def test_code_that_is_gone_is_compiled_again(code, compiled):
    first, _ = started(LORENZ)
    pieces = len(compiled)
    assert pieces > 0
    for file in files(code, "code-"):
        file.unlink()
    assert started(LORENZ) == (first, True)
    assert len(compiled) == 2 * pieces
    assert started(LORENZ) == (first, True)
    assert len(compiled) == 2 * pieces


def test_another_machine_compiles_for_itself(code, compiled, monkeypatch):
    first, _ = started(LORENZ)
    pieces = len(compiled)
    monkeypatch.setattr(compiler.machine(), "host", compiler.machine().host._replace(library="another"))
    assert started(LORENZ) == (first, True)
    assert len(compiled) == 2 * pieces


def test_fast_code_needs_no_equations_either(first):
    for compiled_before in (False, True):
        with new_session() as session:
            session.erun(Source(LORENZ))
            for _ in model_of(session).improve():
                pass
            assert is_restored(session) is compiled_before
            session.execute("reset | x = 1 | y = 1 | z = 20 | t = 0 | drun")
            run = session.runs[-1]
            assert run.rows[: run.count].tobytes() == first.samples[0]


def test_code_whose_form_depends_on_earlier_programs(code):
    with new_session() as session:
        session.erun(Source(LORENZ))
        model = model_of(session)
        assert model.noted() is not None
        model._tables.calls = {"step": [("p", (ctypes.c_uint64 * 1)(3))]}
        assert model.noted() is None
    with new_session() as session:
        session.erun(Source(LORENZ))
        assert is_restored(session)
        tables = model_of(session)._tables
        tables._written = {}  # as if all pieces were called with data now
        before = [entry.value for entries in tables._entries.values() for entry in entries]
        for file in files(code, "code-"):
            file.unlink()
        for _ in tables.improve():
            pass
        assert before == [entry.value for entries in tables._entries.values() for entry in entries]


def test_models_of_few_states_and_many_lines_are_stored_too(stored, monkeypatch):
    few = LORENZ.replace("DYNAMIC\n", "DYNAMIC\n" + "".join(f"v{k} = x + {k}\n" for k in range(20)))
    monkeypatch.setattr(native_model, "SMALL", 20)
    for text, is_stored in ((few, True), (LORENZ, False)):
        first, _ = started(text)
        assert started(text) == (first, is_stored)


def test_code_for_another_rule_is_written_for_it(first):
    with new_session() as session:
        session.erun(Source(LORENZ))
        restored, segments = segment_of(session), session._workspace.segments
        assert (
            segments.model(restored, 4)._tables.calls.keys()
            == segments.model(restored, 3)._tables.calls.keys()
        )
        assert not is_restored(session)


ASKED = """input k | input n | ARRAY c[n] | c[1] = 2 | c[2] = 5 | c[3] = k
x = 1 | TMAX = 0.1 | NN = 3 | DT = 0.05
drun
DYNAMIC
d/dt x = c[k]*x
dispt x
"""


def test_what_the_script_computes_belongs_to_it(stored):
    answers = [("1", "4"), ("2", "4"), ("2", "5"), ("3", "5")]
    outcomes = [started(ASKED, *given)[0] for given in answers]
    assert len({outcome.samples[0] for outcome in outcomes}) == 3
    for given, outcome in zip(answers, outcomes, strict=True):
        assert started(ASKED, *given)[0] == outcome
    assert started(ASKED, *answers[0]) == (outcomes[0], True)


def test_equations_read_later_are_those_of_the_run(stored):
    started(ASKED, "2", "4")
    with new_session("2", "4") as session:
        session.erun(Source(ASKED))
        assert is_restored(session)
        session.execute("k = 3")
        assert segment_of(session).body[0].value.args[0] == Load(session.values.names["c"].slot + 1)


def test_layouts_differ_by_all_that_lowering_reads():
    def changed(change):
        values = Values()
        values.assign(values.scalar("x").slot, 1.0)
        values.scalar("y")
        values.array("A", (2, 3))
        change(values)
        return layout_digest(values.layout())

    changes = [
        lambda values: None,
        lambda values: values.scalar("z"),
        lambda values: values.unnamed(1),
        lambda values: values.room(8),
        lambda values: values.assign(values.names["y"].slot, 0.0),
        lambda values: setattr(values.names["y"], "is_state", True),
        lambda values: setattr(values.names["A"], "is_state", True),
        lambda values: setattr(values.names["A"], "of_file", True),
        lambda values: setattr(values.names["A"], "shape", (3, 2)),
        lambda values: setattr(values.names["A"], "kind", type(values.names["A"].kind).INTEGER),
        lambda values: setattr(values.names["y"], "slot", 99),
        lambda values: values.names.update(y2=values.names.pop("y")),
    ]
    digests = [changed(change) for change in changes]
    assert len({*digests}) == len(changes)
    assert [changed(change) for change in changes] == digests


def test_programs_this_process_knows_and_those_of_editors_are_not_looked_for(stored):
    with new_session() as session:
        session.erun(Source(LORENZ))
        assert session._workspace.segments.start is not None
        session.erun(Source(LORENZ.replace("28", "27")))  # most of its lines are known
        assert session._workspace.segments.start is None
    assert len(files(stored)) == 1
    with new_session():
        checking = Session(Listener())
        checking.erun(Source(LORENZ))
        assert checking._workspace.segments.start is None
    assert len(files(stored)) == 1


def test_small_programs_are_not_stored(stored, monkeypatch):
    monkeypatch.undo()
    with new_session() as session:
        session.erun(Source(LORENZ))
        assert session._workspace.segments.start is None


def test_old_files_give_way(stored, monkeypatch):
    monkeypatch.setattr(start_file, "_BYTES_MOST", 3000)
    for number in range(6):
        started(LORENZ.replace("28", str(20 + number)))
    assert 1 <= len(files(stored)) < 4
