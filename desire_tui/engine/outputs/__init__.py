"""Graph to text canvas and picture files; runs to CSV, JSON and NPY. The only home of plotext and matplotlib."""
