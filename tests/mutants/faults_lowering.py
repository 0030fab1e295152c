"""Faults in the lowering: persistence, states, the Jacobian's entries, names, submodels, subscripts, guards."""

from __future__ import annotations

from tests.mutants.anchors import PROGRAMS, Mutant, program


def _fault(old: str, new: str, *first: str) -> Mutant:
    return Mutant("lowering", old, new, (*first, "tests/lowering/test_persistence.py"))


LOWERING = (
    # persistence
    _fault(
        "self.ready.update((name, load) for name, load in ready.items() if name in then.ready)",
        "self.ready.update(ready | then.ready)",
        *program("dynamic/persistence_in_branches"),
    ),
    _fault(
        "self.set_slots.update((slot, None) for slot in slots if slot in then.slots)",
        "self.set_slots.update(slots | then.slots)",
        *program("dynamic/persistence_in_branches"),
    ),
    _fault(
        "self.set_ranges = ranges.common(then.ranges)",
        "pass",
        *program("dynamic/persistence_in_branches"),
    ),
    _fault(
        "while len(found) > left:",
        "while False:",
        *program("dynamic/persistence_in_branches"),
    ),
    _fault(
        "slot in slots or slot < SYSTEM_SLOTS or ranges.touches(slot, 1)",
        "slot in slots or slot < SYSTEM_SLOTS",
        "tests/lowering/test_lowering.py",
    ),
    _fault(
        "slot < SYSTEM_SLOTS or ranges.touches(slot, 1)",
        "ranges.touches(slot, 1)",
        *program("dynamic/rule_2_and_5", "dynamic/dt_between_runs"),
    ),
    _fault("early[at] < slot + count", "early[at] < slot", "tests/lowering/test_lowering.py"),
    _fault(
        "if not self.set_ranges.covers(slot, count):",
        "if not self.set_ranges.touches(slot, count):",
        "tests/lowering/test_lowering.py",
    ),
    # states
    _fault(
        "return found.first + slot - found.slot if",
        "return found.first if",
        *program("vectors/state_overlay", "vectors/elements_overridden"),
    ),
    _fault(
        "last[2] = max(last[2], end)",
        "last[2] = end",
        *program("vectors/state_overlay", "vectors/elements_overridden"),
    ),
    _fault("last[0] = min(last[0], i)", "pass", *program("vectors/state_overlay")),
    # the Jacobian's entries
    _fault(
        "JacobianEntry(int(row) - 1, int(column) - 1",
        "JacobianEntry(int(column) - 1, int(row) - 1",
        "tests/reference/test_jacobian_check.py",
    ),
    _fault(
        "builder.body[place:place] = context.before",
        "builder.body += context.before",
        "tests/passes/test_jacobian_pass.py",
    ),
    # names, submodels, subscripts
    _fault("return a == b or UNKNOWN in (a, b)", "return a == b", "tests/check/test_problems.py"),
    _fault(
        "return quantity.is_state or quantity.slot < SYSTEM_SLOTS or self.values",
        "return self.values",
        f"{PROGRAMS}[examples/appendix/avoiding_division.src]",
    ),
    _fault(
        "rename[dummy] = frame.rename.get(argument.name, argument.name)",
        "rename[dummy] = argument.name",
        *program("dynamic/nested_submodels"),
    ),
    _fault(
        "slot = slot * size + int(value) - 1",
        "slot = slot * size + round(value) - 1",
        "tests/lowering/test_lowering.py",
    ),
    _fault("self.flow.read_slot(quantity.slot) return Load", "return Load", "tests/passes/test_slices.py"),
    # guards
    _fault(
        "branches.get(serial, branch) == branch",
        "branches.get(serial) == branch",
        *program("errors/state_twice_in_two_ifs", "errors/state_twice_in_branch"),
    ),
    _fault(
        "branches.get(serial, branch) == branch",
        "serial not in branches",
        *program("errors/state_twice_in_two_ifs", "errors/state_twice_in_branch"),
    ),
    _fault(
        "self._close() self._reopen(inner) return True",
        "self._close()\n        return True",
        "tests/lowering/test_lowering.py",
    ),
    _fault(
        "Set(held[0], value, where, persistent=True)",
        "Set(held[0], value, where)",
        "tests/lowering/test_lowering.py",
    ),
    _fault(
        "whole(every * (1 + 1e-9), 1)",
        "whole(every, 1)",
        *program("dynamic/sample_fraction"),
        "tests/lowering/test_lowering.py",
    ),
    # expressions that are kept from the last time
    _fault(
        "if load is None or load.slot != slot:", "if load is None:", "tests/lowering/test_lowering_cache.py"
    ),
)
