"""`desire serve`: the desktop in a browser.

`server` answers requests that `guard` lets through: those for an announced address (`addresses`) with the
token of a visitor (`visitors`). A visitor's websocket starts a desktop of its own (`child_process`), and
`relay` carries packets between the two. `start` is what the command line calls.
"""
