"""Steps of explicit rules through what happens at a moment: `event`, `every`, jumps that a delay brings back.

Plain Python, compiled by `codegen.plain_python` for native code; the reference back end runs the same text.

    `memory`   the structure that all of it works on
    `blocks`   which events are due, and their blocks carried out
    `locate`   where in a step an event's expression rises through 0
    `steps`    the steps of a rule: fixed ones are split at a moment, variable ones end there
    `side_by_side`  steps that single ones of many runs in lock step make alone
    `setup`    the memory behind the structure
"""
