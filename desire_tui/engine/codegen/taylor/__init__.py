"""Recurrences of Taylor coefficients as native code (rule 17): a loop over the order, a function for a model.

`layout`       where coefficients stand
`scalar`       series of numbers
`vector`       series of arrays: loops over elements
`recurrences`  the function that holds them
`series_code`  it compiled, quick code first
"""
