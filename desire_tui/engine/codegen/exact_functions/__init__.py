"""Functions of the C library for many numbers at a time, with its bits."""
