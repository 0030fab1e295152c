"""Models for others: a program's run as C, FMU or LaTeX."""
