"""Graphs and samples to files, canvases and text."""
