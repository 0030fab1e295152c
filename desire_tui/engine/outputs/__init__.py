"""Graphs as text and pictures, results as CSV, JSON and NPZ. Only here are plotext and matplotlib used."""
