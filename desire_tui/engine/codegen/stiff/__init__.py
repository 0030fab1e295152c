"""Stiff."""
