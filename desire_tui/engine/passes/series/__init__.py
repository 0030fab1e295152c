"""A segment's derivatives as Taylor series: which elementary series they are made of, for rule 17.

`series_program` takes a derivative pass apart into nodes whose k-th coefficients follow from lower ones
(Moore 1966; Griewank and Walther, "Evaluating Derivatives", chapter 13):

    `nodes`       a series, a constant, the whole program
    `graph`       makes them, each once
    `functions`   the library's functions as such nodes
    `reading`     which series stands in a slot where a statement reads it
    `expressions` expressions to nodes
    `translation` statements to nodes
    `fused_terms` terms with constant factors joined with their sums
    `grouping`    numbers' series that are alike, put together as arrays
    `pieces`      kinks and tables as choices between smooth pieces, so that switches are located

What the coefficients are is told, twice, by `codegen.taylor` and `reference.taylor`.
"""
