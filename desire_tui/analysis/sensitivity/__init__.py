"""`sensitivity k, r of x`: what changes with what, along a run and over whole ranges."""
