"""Trees become functions over the values; what all generated code may use."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import Origins, ScriptFault
from desire_tui.engine.interpreter.random import Noise
from desire_tui.engine.library import integer_power, power, rounded
from desire_tui.engine.values import SCALAR_SLOTS
from desire_tui.engine.whole_numbers import WHOLE_MOST

if TYPE_CHECKING:
    import ast
    from collections.abc import Callable

    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.source import Source
    from desire_tui.engine.values import Values


class PythonCompiler:
    """Turns trees into functions over one set of values.

    `names` is what generated code sees: `c` the numbers, the library's functions under `f_NAME`, helpers.
    """

    def __init__(self, values: Values, origins: Origins) -> None:
        self.values = values
        self.origins = origins
        self.names: dict[str, Any] = helpers(values)
        self._count = 0

    def fresh(self, prefix: str) -> str:
        """Return a variable name that is used nowhere else."""
        self._count += 1
        return f"{prefix}{self._count}"

    def share(self, prefix: str, thing: object) -> str:
        """Make an object known to generated code; return its name there."""
        name = self.fresh(prefix)
        self.names[name] = thing
        return name

    def function(
        self,
        body: list[ast.stmt],
        placed: Placed | list[Placed],
        source: Source | None,
        parameters: tuple[str, ...] = (),
    ) -> Callable[..., Any]:
        """Compile code to a function. Of several statements, code in line n + 2 was made from number n."""
        module = py.function("s", parameters, body)
        code = compile(module, self.origins.file_name(placed, source), "exec")
        exec(code, self.names)  # noqa: S102 - our own code, made from a parsed expression
        made: Callable[..., Any] = self.names.pop("s")
        return made

    def evaluate(self, code: ast.expr, placed: Placed, source: Source | None) -> Any:
        """Evaluate an expression once."""
        return self.function([py.return_value(code)], placed, source)()


def helpers(values: Values) -> dict[str, Any]:
    """Return what every piece of generated code may use."""
    cells, defined = values.cells, values.defined

    def bad_subscript(value: float, size: int, place: int) -> int:
        raise ScriptFault("script-subscript-out-of-range", value=f"{value:g}", size=size, place=place)

    def overflow() -> None:
        raise ScriptFault("overflow")

    def undefined(name: str) -> float:
        raise ScriptFault("undefined-variable", name=name)

    def to_integer(value: float) -> float:
        if not -WHOLE_MOST <= value <= WHOLE_MOST:
            raise ScriptFault("integer-overflow", value=f"{value:g}")
        return rounded(value)

    def complex_at(slot: int) -> complex:
        return complex(cells[slot], cells[slot + 1])

    def set_complex(slot: int, value: complex) -> None:
        if not (value.real - value.real == 0.0 and value.imag - value.imag == 0.0):
            raise ScriptFault("overflow")
        cells[slot], cells[slot + 1] = value.real, value.imag

    def mark(box: list[int]) -> None:
        box[1] = 1
        if box[0] < SCALAR_SLOTS:
            defined[box[0]] = 1

    noise = Noise(values.random)

    def count_as_zero(box: list[int]) -> None:
        if not box[1]:
            box[1] = 1
            cells[box[0]] = 0.0

    return {
        "count_as_zero": count_as_zero,
        "ran": noise.uniform,
        "gauss": noise.normal,
        "__builtins__": {"int": int, "complex": complex},
        "c": cells,
        "bad_subscript": bad_subscript,
        "overflow": overflow,
        "undefined": undefined,
        "to_integer": to_integer,
        "complex_at": complex_at,
        "set_complex": set_complex,
        "mark": mark,
        "integer_power": integer_power,
        "power": power,
    }
