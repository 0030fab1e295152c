"""Networks in a program: the script fills a matrix of weights, the segment multiplies it with a vector."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.layout import joined

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.convert.model import Network, Table
    from desire_tui.convert.names import NameTable


def network_script(network: Network, tables: dict[str, Table], names: NameTable) -> Iterator[str]:
    """Yield the lines that declare and fill the matrix."""
    name, matrix, vector = _names(network, names)
    columns = len(network.sources)
    yield f"ARRAY {matrix}[{network.rows}, {columns}], {vector}[{columns}], {name}[{network.rows}]"
    row, column, place = (names.fresh(f"{word}_{name}") for word in ("i", "k", "q"))
    values = [f"{names(table)}[{len(tables[table].xs) + 4} + {{}}]" for table in network.tables]
    weight = values[0]
    yield f"for {row} = 1 to {network.rows}"
    match network.kind:
        case "sparse":
            at = f"({row} - 1)*{network.reach} + {column}"
            yield f"  for {column} = 0 to {network.reach - 1}"
            yield f"    {place} = 1 + trnc({values[1].format(at)})"
            weight = weight.format(at)
        case "mmult":
            yield f"  for {column} = 0 to {network.reach - 1}"
            yield f"    {place} = {column} + 1"
            weight = weight.format(f"({row} - 1)*{network.reach} + {column}")
        case kind:
            yield f"  for {column} = -{network.reach} to {network.reach}"
            yield f"    {place} = {row} + {column}"
            if kind == "even":
                yield f"    if {place} < 1 then {place} = 2 - {place} | proceed"
                yield f"    if {place} > {network.rows} then {place} = {2 * network.rows} - {place} | proceed"
            elif kind == "periodic":
                yield f"    {place} = 1 + mod({place} - 1, {network.rows})"
            weight = weight.format(f"{network.reach} + {column}")
    cell = f"{matrix}[{row}, {place}]"
    add = f"{cell} = {cell} + {weight}"
    inside = f"{place} >= 1 and {place} <= {columns}"
    yield f"    if {inside} then {add} | proceed"
    yield "  next"
    yield "next"


def network_segment(network: Network, names: NameTable) -> Iterator[str]:
    """Yield the lines that compute the sums."""
    name, matrix, vector = _names(network, names)
    yield from joined(f"{vector}[{k}] = {names(source)}" for k, source in enumerate(network.sources, 1))
    yield f"Vector {name} = {matrix}*{vector}"


def _names(network: Network, names: NameTable) -> tuple[str, str, str]:
    name = names(network.name)
    return name, names.beside(f"weights_{name}"), names.beside(f"inputs_{name}")
