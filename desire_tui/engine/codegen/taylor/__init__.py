"""Recurrences of Taylor coefficients as native code (rule 17): loops over the order, one function for a model.

    `layout`       where coefficients stand
    `scalar`       series of numbers
    `vector`       series of arrays: loops over elements
    `recurrences`  the function that holds them
    `series_code`  it compiled, quick code first
"""
