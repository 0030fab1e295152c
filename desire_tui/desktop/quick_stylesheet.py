"""Finds the styles of widgets; what is the same for many of them is worked out once.

A third of a desktop's start was this search: for each of 160 nodes (widgets, and parts of them such as a
cursor) Textual goes through all rules twice, and weighs anew which of those that hold prevails. Textual is
pinned; it has no public way.
"""
# ruff: noqa: SLF001 - what `Stylesheet.apply` reads and notes at a node has no public names

from __future__ import annotations

from itertools import count
from operator import is_
from typing import TYPE_CHECKING, cast
from weakref import WeakKeyDictionary

from textual.css.match import _check_selectors
from textual.css.styles import RulesMap, Styles
from textual.css.stylesheet import Stylesheet

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.css.model import RuleSet, Selector
    from textual.css.types import Specificity3
    from textual.dom import DOMNode

BY_NEIGHBOURS = frozenset({"first-of-type", "last-of-type", "first-child", "last-child", "empty"})
BY_COUNT = frozenset({"odd", "even"})
INITIAL = Styles()
"""What holds where no rule says anything."""


class NumberedSelector:
    """One of a rule's selectors; equal numbers mean the same rule and the same weight."""

    def __init__(self, number: int, rule: RuleSet, parts: list[Selector], specificity: Specificity3) -> None:
        self.number = number
        self.rule = rule
        self.parts = parts
        self.specificity = specificity

    def holds(self, node: DOMNode, path: list[DOMNode]) -> bool:
        """Whether it chooses a node, which stands at the end of `path`; most fail at their last part."""
        return self.parts[-1].check(node) and (len(self.parts) == 1 or _check_selectors(self.parts, path))


class Candidates:
    """The selectors that can choose nodes of certain names, and what Textual notes of them at the node."""

    def __init__(self, selectors: list[NumberedSelector]) -> None:
        self.selectors = selectors
        pseudo_classes = frozenset[str]().union(*(selector.rule.pseudo_classes for selector in selectors))
        self._notes = (
            "hover" in pseudo_classes, "focus-within" in pseudo_classes,
            not pseudo_classes.isdisjoint(BY_NEIGHBOURS), not pseudo_classes.isdisjoint(BY_COUNT),
        )  # fmt: skip

    def note(self, node: DOMNode) -> None:
        """Note which changes of its state give a node other styles."""
        (
            node._has_hover_style, node._has_focus_within, node._has_order_style, node._has_odd_or_even,
        ) = self._notes  # fmt: skip


class StyleTables:
    """What follows from rules alone, whatever the node; rules never change, other colours make new ones."""

    def __init__(self) -> None:
        self._numbered: dict[RuleSet, list[NumberedSelector]] = {}
        self._numbers = count()
        self._of_rules: dict[tuple[RuleSet, ...], dict[frozenset[str], Candidates]] = {}
        self.of_selectors: dict[tuple[int, ...], RulesMap] = {}
        """By the numbers of selectors, what they say together."""
        self.as_stored: dict[tuple[int, ...], RulesMap] = {}
        """The same as nodes keep it: in a rule `text_style` is a word."""

    def of_names(self, rules: Iterable[RuleSet]) -> dict[frozenset[str], Candidates]:
        """Return what was found among these rules for nodes of certain names, to be read and added to."""
        return self._of_rules.setdefault(tuple(rules), {})

    def selectors(self, rule: RuleSet) -> list[NumberedSelector]:
        """Return a rule's selectors, the same objects whenever it is asked for."""
        found = self._numbered.get(rule)
        if found is None:
            found = self._numbered[rule] = [
                NumberedSelector(next(self._numbers), rule, selectors.selectors, selectors.specificity)
                for selectors in rule.selector_set
            ]
        return found


class QuickStylesheet(Stylesheet):
    """Textual's style sheet with a quicker `apply`; the styles are the same."""

    def __init__(self, *, variables: dict[str, str] | None = None) -> None:
        super().__init__(variables=variables)
        self._tables = StyleTables()
        self._of_names: dict[frozenset[str], Candidates] = {}
        self._given: WeakKeyDictionary[DOMNode, tuple[tuple[int, ...], int]] = WeakKeyDictionary()
        """The selectors by which a node has its styles, and their count of changes then."""
        self._seen: list[RuleSet] | None = None
        """The rules that the tables are about."""
        self._mapped: tuple[list[RuleSet], dict[str, list[RuleSet]]] = [], {}
        """The rules of the last map, and the map."""

    def copy(self) -> Stylesheet:
        """Return a style sheet with the same sources."""
        copied = QuickStylesheet(variables=self._variables.copy())
        copied.source = self.source.copy()
        return copied

    def set_variables(self, variables: dict[str, str]) -> None:
        """Take other colours: all rules will be parsed anew."""
        super().set_variables(variables)
        self._seen = None
        self._tables = StyleTables()

    @property
    def rules_map(self) -> dict[str, list[RuleSet]]:
        """The rules by what they choose; widgets bring theirs level by level, and the map is continued."""
        if self._rules_map is None:
            rules = self.rules
            before, by_name = self._mapped
            if len(before) > len(rules) or not all(map(is_, before, rules)):
                before, by_name = [], {}
            for rule in rules[len(before) :]:
                for name in rule.selector_names:
                    by_name.setdefault(name, []).append(rule)
            self._mapped = rules, by_name
            self._rules_map = by_name
        return self._rules_map

    def apply(
        self, node: DOMNode, *, animate: bool = False, cache: dict[tuple[object, ...], RulesMap] | None = None
    ) -> None:
        """Give a node the styles that the rules say; `cache` is Textual's and not used."""
        del cache
        candidates = self._candidates(node)
        candidates.note(node)
        path = node.css_path_nodes
        chosen = [selector for selector in candidates.selectors if selector.holds(node, path)]
        if chosen:
            key = tuple([selector.number for selector in chosen])
            base = node.styles.base
            if self._given.get(node) != (key, base._updates):
                if base._rules:
                    self.replace_rules(node, self._styles(key, chosen), animate=animate)
                else:
                    self._give_first(node, key, chosen)
                self._given[node] = key, base._updates
        self._process_component_classes(node)

    def _styles(self, key: tuple[int, ...], chosen: list[NumberedSelector]) -> RulesMap:
        said = self._tables.of_selectors.get(key)
        if said is None:
            said = self._tables.of_selectors[key] = prevailing(chosen)
        return said

    def _give_first(self, node: DOMNode, key: tuple[int, ...], chosen: list[NumberedSelector]) -> None:
        """Give a new node its styles, at once: one by one each asks for a new layout."""
        base, styles = node.styles.base, self._styles(key, chosen)
        as_stored = self._tables.as_stored.get(key)
        if as_stored is None:
            self.replace_rules(node, styles)
            as_stored = base.get_rules()
            as_stored.pop("layout", None)  # an object for each node
            self._tables.as_stored[key] = as_stored
            return
        base.merge_rules(as_stored)
        if "layout" in styles:
            base.layout = styles["layout"]
        node.refresh(layout=True)
        node.notify_style_update()

    def _candidates(self, node: DOMNode) -> Candidates:
        rules_map = self.rules_map
        if self._seen is not self._rules:
            self._seen = self._rules
            self._of_names = self._tables.of_names(self._rules)
        names = frozenset(rules_map.keys() & node._selector_names)
        found = self._of_names.get(names)
        if found is None:
            possible = {id(rule) for name in names for rule in rules_map[name]}
            rules = (rule for rule in reversed(self._rules) if id(rule) in possible)
            found = Candidates([selector for rule in rules for selector in self._tables.selectors(rule)])
            self._of_names[names] = found
        return found


def prevailing(selectors: Iterable[NumberedSelector]) -> RulesMap:
    """Return what is said with the greatest weight of each property."""
    said: dict[str, list[tuple[tuple[int, ...], object]]] = {}
    for selector in selectors:
        rule = selector.rule
        for name, weight, value in rule.styles.extract_rules(
            selector.specificity, rule.is_default_rules, rule.tie_breaker
        ):
            said.setdefault(name, []).append((weight, value))
    return cast("RulesMap", {name: _value(name, values) for name, values in said.items()})


def _value(name: str, said: list[tuple[tuple[int, ...], object]]) -> object:
    """Return a property's value; `initial` (None) is what widgets say, in a widget what Textual has."""

    def greatest(values: list[tuple[tuple[int, ...], object]]) -> object:
        return max(values, key=lambda weighed: weighed[0])[1]

    value = greatest(said)
    if value is not None:
        return value
    by_widgets = [weighed for weighed in said if not weighed[0][0]]
    if len(by_widgets) == len(said):
        return getattr(INITIAL, name)
    return greatest(by_widgets) if by_widgets else None
