"""`phase`: field, nullclines, steady states, manifolds of saddles and basins in the plane of two states."""
