"""Studies: one program, thousands of runs. What varies, what is kept, how the runs are made and stored."""
