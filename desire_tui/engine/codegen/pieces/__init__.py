"""Passes cut into functions of a few dozen statements, and tables of their addresses."""
