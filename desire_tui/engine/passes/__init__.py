"""Passes over a lowered segment: what to run when, what depends on what, derivatives."""
