"""Graphs to text and picture files, runs to CSV, JSON, NPY. The only home of plotext and matplotlib."""
