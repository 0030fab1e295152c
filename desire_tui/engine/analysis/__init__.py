"""Nodes to a lowered program: names, kinds, shapes, order, guards."""
