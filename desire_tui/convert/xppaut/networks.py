"""XPPAUT's network functions (`special k=conv(even,51,12,w,u0)`) as products of a matrix and a vector."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import Name, total
from desire_tui.convert.model import Network
from desire_tui.convert.xppaut.constants import constant
from desire_tui.convert.xppaut.expression_parser import parsed
from desire_tui.convert.xppaut.vocabulary import LINEAR, NotConvertibleError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.convert.xppaut.building import Building
    from desire_tui.convert.xppaut.declarations import Declaration

CELLS_MOST = 4_000_000
"""How large a matrix may be."""


def networks(building: Building) -> Iterator[Network]:
    """Yield the file's linear networks; others are left for the caller to refuse."""
    for one in building.of("special"):
        found = LINEAR.match(one.right)
        if found is None:
            continue
        building.used.append(one)
        words = [word.strip().lower() for word in found[3].split(",")]
        try:
            yield _network(building.spelling[found[1].lower()], found[2].lower(), words, one, building)
        except NotConvertibleError as reason:
            building.refuse(one.line, str(reason))


def _network(name: str, function: str, words: list[str], one: Declaration, building: Building) -> Network:
    kind = words.pop(0) if function == "conv" and words else function
    if len(words) != (5 if function == "sparse" else 4):
        raise NotConvertibleError(f"'{function}' has other arguments")
    first, second = (int(constant(parsed(word), building.places.constants)) for word in words[:2])
    rows, reach = (second, first) if function == "mmult" else (first, second)
    columns = reach if function == "mmult" else rows
    if not 1 <= rows * columns <= CELLS_MOST:
        raise NotConvertibleError(f"a network of {rows} times {columns} weights is not converted")
    tables = words[2:-1]
    for table in tables:
        if building.roles.get(table) != "table":
            raise NotConvertibleError(f"'{table}' is no table")
        if building.spelling[table] not in {made.name for made in building.model.tables}:
            raise NotConvertibleError(f"its table '{table}' is not converted")
    sources = tuple(building.spelling[building.places.shifted(words[-1], k)] for k in range(columns))
    kinds = {"e": "even", "p": "periodic", "0": "zero"} if function == "conv" else {kind[:1]: kind}
    if kind[:1] not in kinds:
        raise NotConvertibleError(f"'{kind}' is no way to go on beyond the ends")
    value = total([Name(source) for source in sources])
    return Network(name, value, one.line.comment, kinds[kind[:1]], rows, reach, sources,
                   tuple(building.spelling[table] for table in tables))  # fmt: skip
