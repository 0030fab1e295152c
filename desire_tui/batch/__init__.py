"""Headless runs: programs without a screen. Knows nothing of Textual."""
