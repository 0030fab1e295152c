"""Walks the experiment-protocol script."""
