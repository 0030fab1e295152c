"""Where a run's derivatives jump: found ahead where t alone decides, watched and located where states do.

Plain Python, compiled by `codegen.plain_python` for native code; the reference back end runs the same text.

    `program`   expressions of t as instructions
    `bounds`    what their values are over an interval of t, or at one t
    `ahead`     the next place where one of them switches
    `located`   whether a mode has switched, and where
    `clearance` a box of t and states in which no state can make anything switch
    `watch`     what the run loops call: how far a step may go, what has switched in it, what follows
    `memory`    the structure that they share
"""
