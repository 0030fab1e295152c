"""`fit k, r = 10 in [1, 100] to x ~ position`: parameters and initial values by least squares.

`request`       what is asked
`measurements`  the files' columns that are fitted to, over the times of the run
`curves`        runs with their derivatives, at the times of measurements
`solve`         nonlinear least squares, weights, robust losses
`estimates`     standard errors, correlations, intervals, criteria
`report`        tables and charts
`analysis`      all of it, one behind the other
"""
