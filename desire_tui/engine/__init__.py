"""The simulation engine. It never knows that a screen exists."""
