"""XPPAUT's `.ode` files.

text ─ logical_lines ─ arrays ─→ declarations ─→ reader ─→ model.Model
                                 options          expression_parser, sums, events
"""
