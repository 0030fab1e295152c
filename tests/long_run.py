"""A program that runs until somebody ends it."""

LONG_RUN = """\
TMAX = 2E6 | DT = 0.001 | NN = 200001
irule 3 | x = 1
drun
DYNAMIC
d/dt x = v
d/dt v = -x
dispt x, v
"""
