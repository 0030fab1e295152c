"""`engine/data_classes` does what the standard library's `dataclasses` does."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from types import SimpleNamespace
from typing import ClassVar

import pytest

from desire_tui.engine import data_classes

LIBRARY = SimpleNamespace(dataclass=dataclasses.dataclass, field=dataclasses.field)


def classes(of) -> SimpleNamespace:
    """Return the same classes, made by one of the two modules."""

    @of.dataclass(frozen=True)
    class Point:
        x: float
        y: float = 2.0
        kind: ClassVar[str] = "point"

    @of.dataclass(frozen=True, slots=True)
    class Named:
        name: str
        marks: list[int] = of.field(default_factory=list, compare=False)
        secret: str = of.field(default="none", repr=False)

    @of.dataclass
    class Counter:
        start: int = 0
        seen: list[int] = of.field(default_factory=list)
        _last: int | None = of.field(default=None, init=False)

        def __post_init__(self) -> None:
            self.seen = [*self.seen, self.start]

    @of.dataclass(eq=False, repr=False)
    class Own:
        value: int

        def __repr__(self) -> str:
            return f"<{self.value}>"

    @of.dataclass(slots=True)
    class One:
        only: object

    @of.dataclass(frozen=True)
    class Nothing:
        pass

    @of.dataclass
    class Further(Counter):
        more: str = "m"

    return SimpleNamespace(**{name: kind for name, kind in locals().items() if isinstance(kind, type)})


OURS, THEIRS = classes(data_classes), classes(LIBRARY)
CALLS = {
    "Point": [((1.0,), {}), ((1.0, 2.0), {}), ((), {"y": 3.0, "x": 1.0})],
    "Named": [(("a",), {}), (("a", [1]), {}), (("b", [], "s"), {}), (("a", []), {"secret": "t"})],
    "Counter": [((), {}), ((3, [1]), {}), ((), {"seen": [2]})],
    "Own": [((1,), {}), ((1,), {})],
    "One": [((1,), {}), (([],), {}), ((float("nan"),), {})],
    "Nothing": [((), {})],
    "Further": [((), {}), ((1, [2], "n"), {}), ((), {"more": "n"})],
}
WRONG = [
    ("Point", (), {}),
    ("Point", (1, 2, 3), {}),
    ("Point", (1,), {"z": 1}),
    ("Counter", (), {"_last": 1}),
]


def objects(of: SimpleNamespace, name: str) -> list:
    return [getattr(of, name)(*copy.deepcopy(given), **copy.deepcopy(named)) for given, named in CALLS[name]]


def hash_or_none(value: object) -> int | None:
    try:
        return hash(value)
    except TypeError:
        return None


@pytest.mark.parametrize("name", CALLS)
def test_objects_are_those_of_the_library(name: str):
    ours, theirs = objects(OURS, name), objects(THEIRS, name)
    assert [repr(value) for value in ours] == [repr(value) for value in theirs]
    assert [[a == b for a in ours] for b in ours] == [[a == b for a in theirs] for b in theirs]
    if name != "Own":  # by identity
        assert [hash_or_none(value) for value in ours] == [hash_or_none(value) for value in theirs]
    for ours_one, theirs_one in zip(ours, theirs, strict=True):
        assert dataclasses.is_dataclass(ours_one)
        assert ours_one.__match_args__ == theirs_one.__match_args__
        assert [f.name for f in dataclasses.fields(ours_one)] == [
            f.name for f in dataclasses.fields(theirs_one)
        ]
        assert dataclasses.asdict(ours_one) == dataclasses.asdict(theirs_one)
        assert hasattr(ours_one, "__dict__") == hasattr(theirs_one, "__dict__")
        assert repr(copy.deepcopy(ours_one)) == repr(theirs_one)


@pytest.mark.parametrize("replace", [data_classes.replace, dataclasses.replace])
@pytest.mark.parametrize("of", [OURS, THEIRS])
def test_replace_takes_either_s_objects(of, replace):
    changed = replace(of.Named("a", [1], "s"), name="b")
    assert (changed.name, changed.marks, changed.secret) == ("b", [1], "s")
    with pytest.raises(TypeError):
        replace(of.Point(1.0), z=2)


@pytest.mark.parametrize(("name", "given", "named"), WRONG)
def test_wrong_calls_are_refused(name, given, named):
    for of in (OURS, THEIRS):
        with pytest.raises(TypeError):
            getattr(of, name)(*given, **named)


def test_defaults_of_the_class_are_those_of_the_library():
    for name in CALLS:
        for word in ("y", "kind", "marks", "secret", "start", "seen", "_last"):
            found = [getattr(getattr(of, name), word, None) for of in (OURS, THEIRS)]
            assert found[0] == found[1] or "member" in type(found[0]).__name__
    with pytest.raises(AttributeError):
        OURS.One(1).other = 2


@data_classes.dataclass(frozen=True, slots=True)
class Sent:
    """One that a cluster's worker gets."""

    number: int
    words: tuple[str, ...] = ()


def test_objects_travel():
    sent = Sent(3, ("a",))
    assert pickle.loads(pickle.dumps(sent)) == sent
