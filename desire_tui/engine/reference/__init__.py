"""The lowered segment evaluated by NumPy: the yardstick in tests."""
