"""Desire in a terminal: an interactive simulation IDE for dynamic systems."""
