"""Values that a caller gives a model's parameters: which names there are, and how each value takes effect."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.api.instance import Way
from desire_tui.batch.set_option import from_mapping
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.nodes.names import assigned
from desire_tui.engine.session.dependent_assignments import dependents
from desire_tui.engine.session.overrides import name_and_subscripts, problems_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.api.instance import Instance
    from desire_tui.engine.diagnostics import Diagnostic


def numbers(values: Mapping[str, Any]) -> dict[str, float]:
    """Return settings by names of scalars and elements. ValueError: a value that is no finite number."""
    plain = {name: value for name, value in values.items() if type(value) is float and value - value == 0.0}
    return plain if len(plain) == len(values) else from_mapping(values)


def name_problems(names: Iterable[str], instance: Instance) -> list[Diagnostic]:
    """Return what is wrong with the names of settings."""
    return problems_of(*instance.prepared.script, dict.fromkeys(names, 0.0))


def way_of(names: tuple[str, ...], instance: Instance) -> Way:
    """Return how settings of these names take effect. DesireError 409, 55, 73: they cannot."""
    problems = name_problems(names, instance)
    if problems:
        raise DesireError(*problems)
    session, prepared = instance.session, instance.prepared
    slots = tuple(slot_of(name, instance) for name in names)
    own = {name_and_subscripts(name)[0] for name in names}
    following = dependents(*prepared.script, prepared.place, own)
    if following is None or None in slots:
        return Way(None, None)
    found = tuple(slot for slot in slots if slot is not None)
    targets = (target for placed in following for target in assigned(placed.node).targets)
    computed = (session.values.names[target.name] for target in targets)
    follows = set[int]().union(*(range(q.slot, q.slot + q.slots) for q in computed))
    if not follows.union(found).isdisjoint(slot for slot, _ in prepared.segment.constants):
        return Way(None, None)  # a subscript, a SAMPLE's m: the segment itself becomes another
    return Way(found, session.repeated(following) if following else None, tuple(sorted(follows)))


def slot_of(name: str, instance: Instance) -> int | None:
    """Return where a scalar or an element stands; None: it is not there when the run begins."""
    values = instance.session.values
    own, subscripts = name_and_subscripts(name)
    quantity = values.find(own)
    if quantity is None or len(subscripts) != len(quantity.shape) or quantity.slots != quantity.size:
        return None
    at = 0
    for k, n in zip(subscripts, quantity.shape, strict=True):
        if not 1 <= k <= n:
            return None
        at = at * n + k - 1
    return quantity.slot + at
