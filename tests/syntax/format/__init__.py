"""Nodes as text that parses back to the same nodes: `parse(format(x)) == x` for every tree."""
