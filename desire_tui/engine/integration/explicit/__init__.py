"""Rules 4, 7 and 8 with steps beyond communication points, in plain Python that native code is made of.

The steps are those of `tableaus`, as `codegen.loop.variable_steps` makes them; states inside a step are those
of a cubic through both ends with the slopes there (Hermite), whose second slope is the next step's first
derivative. A sample's error is then of order 4, as that of rule 4 itself; one of order 5 inside a step takes
six derivatives at least (Owren and Zennaro, "Order barriers for continuous explicit Runge-Kutta methods",
Mathematics of Computation 56 (1991)), two more than the step.

    `memory`  what the solver knows between two steps
    `step`    a step; the solution inside it
    `solver`  the memory as an object, for both back ends
"""
