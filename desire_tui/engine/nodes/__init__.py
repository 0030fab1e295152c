"""The nodes of a parsed program: what the user wrote, nothing more.

Offsets `start` and `end` of a node count from the start of **its statement's raw text**, so that a parsed
statement can be cached by its text and used again wherever it stands; `Placed.at` is the offset of that raw
text in the source. Two nodes are equal when they say the same, wherever they stand.
"""
