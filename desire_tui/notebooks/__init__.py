"""Desire in Jupyter: `%load_ext desire_tui`, then cells that begin with `%%desire`."""
