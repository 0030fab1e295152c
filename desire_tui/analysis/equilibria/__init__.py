"""Places where a program's states stand still: found from many starts, and named by their eigenvalues."""
