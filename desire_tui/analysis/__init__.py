"""After the curve: fits, sensitivities, steady states, phase planes, continuation, signals.

Each analysis is a module with a function `analyse(subject, request, progress) -> Result`; `registry` is the
table from which the desktop's commands, `desire spectrum …` and the Python functions are made.
"""
