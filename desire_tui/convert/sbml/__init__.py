"""Models in SBML, levels 1 to 3, read by libSBML.

    text ─ document ─→ symbols ─→ reader ─→ model.Model
                       mathml     reactions, species, events, triggers

libSBML brings every file to level 3, writes functions out and makes local parameters global; the rest knows
one form only.
"""
