"""Models of other programs as Desire programs: `desire convert`.

    file ── xppaut.reader ──┐
                            ├─→ model.Model ─→ program_text ─→ a program
    file ── sbml.reader ────┘    expressions      names, ordering, layout

A reader knows its format and nothing of Desire beyond the meaning of its functions; `program_text` and its
parts know Desire and no format. What cannot be taken over is a problem with its place in the file.
"""
