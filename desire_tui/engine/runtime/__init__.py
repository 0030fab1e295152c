"""Advances a model block by block, samples, pauses, stops."""
