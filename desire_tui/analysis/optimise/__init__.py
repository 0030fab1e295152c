"""`minimise J over k in [0, 5], r`: the values at which a quantity that runs leave is least or greatest."""
