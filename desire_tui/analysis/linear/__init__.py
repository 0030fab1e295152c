"""`linearise u -> y`: the linear system near a place, its poles, its answers to sines and steps."""
