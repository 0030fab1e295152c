"""Files of measurements: their forms, their columns, what these are called in a program."""
