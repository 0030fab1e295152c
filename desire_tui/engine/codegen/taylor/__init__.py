"""Recurrences of Taylor coefficients as native code (rule 17): a function for a model.

`layout`       where coefficients stand
`scalar`       series of numbers
`vector`       series of arrays: loops over elements
`short_arrays` the same of short arrays, in registers: coefficients 0 in `short_starts`, lanes moved by
               `shuffles`, sums of products by `row_sums`
`tiles`        the same of long arrays, a part at a time in the cache, shared by threads; `tile_layout`: where
               its coefficients stand
`sums`         numbers' sums of products, kept in registers as the order rises
`recurrences`  the function that holds them: a loop over the order
`straight_line`, `straight_sums`  the same without a loop, for fast code of small models
`fused`        products and sums rounded once
`series_code`  it compiled, quick code first
"""
