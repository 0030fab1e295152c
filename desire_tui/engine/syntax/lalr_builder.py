"""The LALR tables of a grammar, made by lark and read through its interactive parser.

`choices()` of lark's interactive parser is the row of the state it is in: for each symbol that may come, the
next state, or the rule to reduce by. Copies of it, fed with the symbols that lead on, get into every state.
The fields of rules and terminals found there are public, though lark's manual does not list them.
"""

from __future__ import annotations

from typing import Any

START = "start"
"""The grammar's start symbol."""


def build(grammar: str) -> dict[str, Any]:
    """Return the tables as `lalr_tables` stores them; terminals by their text, the tokenizer's names."""
    from lark import Lark, Token

    # Nothing is ever read with lark's lexer: two lexers would be two truths, and lark's cannot see context.
    parser = Lark(
        grammar, parser="lalr", lexer="basic", keep_all_tokens=True, maybe_placeholders=False, start=START
    )
    kinds = {t.name: t.pattern.value.replace("\\", "") for t in parser.terminals if t.pattern.type == "str"}
    walkers: list[Any] = [
        parser.parse_interactive()
    ]  # one in each state, in the order of the states' numbers
    numbers: dict[Any, int] = {}
    rules: dict[Any, int] = {}
    actions: list[dict[str, int]] = []
    gotos: list[dict[str, int]] = []
    accept = -1
    for walker in walkers:  # grows as states are found
        action: dict[str, int] = {}
        goto: dict[str, int] = {}
        actions.append(action)
        gotos.append(goto)
        if len(gotos) - 1 == accept:
            continue
        for symbol, (what, target) in walker.choices().items():
            if str(what) == "Reduce":
                action[kinds.get(symbol, symbol)] = -1 - rules.setdefault(target, len(rules))
                continue
            if target not in numbers:
                numbers[target] = len(walkers)
                walkers.append(walker.copy())
                if symbol == START:
                    accept = numbers[target]
                else:
                    walkers[-1].feed_token(Token(symbol, ""))
            is_rule = symbol.islower() or (symbol.startswith("__") and symbol not in kinds)
            (goto if is_rule else action)[kinds.get(symbol, symbol)] = numbers[target]
    return {
        "start": 0,
        "accept": accept,
        "actions": actions,
        "gotos": gotos,
        "rules": [_production(rule) for rule in rules],
    }


def _production(rule: Any) -> tuple[str, int, str, bool]:
    """Return the fields of a `lalr_tables.Rule`."""
    origin, size = str(rule.origin.name), len(rule.expansion)
    inner = origin.startswith("_")
    method = str(rule.alias or ("" if inner or (rule.options.expand1 and size == 1) else origin))
    return origin, size, method, inner
