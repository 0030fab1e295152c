"""Statements over arrays."""
