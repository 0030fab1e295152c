"""Faults in what goes before a run: the interpreter, the check, the structure of a script."""

from __future__ import annotations

from tests.mutants.anchors import Mutant


def _interpreter(old: str, new: str, *first: str) -> Mutant:
    return Mutant("interpreter", old, new, first)


def _check(old: str, new: str) -> Mutant:
    return Mutant(
        "check", old, new, ("tests/check/test_problems.py", "tests/check/test_names_of_segments.py")
    )


def _structure(old: str, new: str) -> Mutant:
    return Mutant("structure", old, new, ("tests/structure",))


SCRIPTS = (
    _interpreter("floor((last - first) / step + _ROUNDING) + 1", "floor((last - first) / step) + 1", "tests/interpreter/test_edges.py"),
    _interpreter("if k_{n} >= m_{n}: pass", "if k_{n} > m_{n}: pass", "tests/interpreter/test_hot_loops.py"),
    _interpreter("if isinstance(node.ctx, ast.Store):", "if slot == 0:", "tests/interpreter/test_hot_loops.py"),
    _interpreter("return [*self._saved(), py.return_value", "return [py.return_value", "tests/interpreter/test_hot_loops.py"),
    _interpreter("asked[:0] = py.parsed", "asked[:0] = [] and py.parsed", "tests/interpreter/test_hot_loops.py"),
    _interpreter("if any(isinstance(dummy, Reference)", "if all(isinstance(dummy, Reference)", "tests/interpreter/test_hot_loops.py"),
    _interpreter("value = loop[2] + k * loop[3]", "value = cells[int(loop[4])] + loop[3]", "tests/interpreter/test_edges.py"),
    _interpreter("if not 1 <= node.value <= size:", "if not 1 <= node.value < size + 1:", "tests/interpreter/test_script_errors.py"),
    _interpreter("if whole >= -0x8000", "if whole > -0x8000", "tests/interpreter/test_edges.py"),
    _interpreter("if piece + _PIECE < first + row else", "if piece + _PIECE <= first + row else", "tests/interpreter/test_edges.py"),
    _interpreter("if separator and not (raw and ends_line(last)):", "if separator:", "tests/interpreter/test_writing.py"),
    _check("if label != text.label:", "if True:"),
    _check("names.difference(submodel.dummies)", "names"),
    _check("self._before.setdefault(node.label, set(self._seen.scalars))",
           "self._before[node.label] = set(self._seen.scalars)"),
    _check("often.add(name) values.pop(name, None)", "often.add(name)"),
    _check("subscripted.update(procedure.node.references, procedure.node.values)",
           "subscripted.update(procedure.node.references)"),
    _check("if not stopped:", "if True:"),
    _structure("block not in _around(survey, place)", "block != survey.found.inside[place]"),
    _structure("found.partner.get(opener) if is_loop else None", "found.partner.get(opener)"),
    _structure("for definition in _around(survey, place) - _around(survey, to):",
               "for definition in _around(survey, place):"),
    _structure("partner[place] = last", "partner[place] = place"),
)  # fmt: skip
