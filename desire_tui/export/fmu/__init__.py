"""A run as an FMU (FMI 3.0): co-simulation by the program's own rule, model exchange for other solvers.

`description` writes modelDescription.xml, `glue.c` has FMI's functions around the exported C file, `content`
compiles and packs.
"""
