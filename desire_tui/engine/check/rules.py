"""Under which integration rule a program will run a segment, as far as its text tells."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.rules import RULES
from desire_tui.engine.nodes.commands import Drun, Irule
from desire_tui.engine.nodes.expressions import Number

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.nodes.program import Placed


def known_rule(script: Iterable[Placed], label: str | None) -> int | None:
    """Return the rule of every run of a segment, if each `irule` of the script is that number, else None."""
    rules: set[int] = set()
    for placed in script:
        node = placed.node
        if isinstance(node, Irule) and node.rule is not None:
            if not isinstance(node.rule, Number) or node.rule.value not in RULES:
                return None
            rules.add(int(node.rule.value))
        elif isinstance(node, Drun) and node.label == label and not rules:
            return None  # a run before: under the rule that was set when the program began
    return rules.pop() if len(rules) == 1 else None
