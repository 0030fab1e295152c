"""Two versions of the package side by side: `python -m benchmarks.against TREE`."""
