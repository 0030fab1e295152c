"""A model's right-hand side and Jacobian as C functions of t and x, for other people's solvers."""
