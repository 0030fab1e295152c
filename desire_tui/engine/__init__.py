"""The simulation engine. It never knows that a screen exists."""

from time import time_ns

IMPORTED_AT = time_ns()
"""When this process began to read the engine's files, in nanoseconds since 1970."""
