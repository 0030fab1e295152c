"""Nodes as text that parses back to the same nodes.

Used by `list` and `edit`, and by tests: `parse(format(x)) == x` for every tree.
"""
