"""Rule 17: Taylor series of the solution, in plain Python that native code is compiled from.

Jorba and Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor
methods", Experimental Mathematics 14 (2005): order from the tolerance, step from the last two coefficients.

    `memory`  what the solver knows between two steps
    `step`    a step: coefficients, size, sum; the solution inside it
    `shared_steps`  the same for many states, by blocks that threads share
    `roots`   the first root of a polynomial in a step
    `solver`  the memory as an object, for both back ends
"""
