"""Statements and expressions over numbers."""
