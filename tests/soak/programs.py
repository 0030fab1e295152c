"""Programs that are edited, run and checked for hours."""

from __future__ import annotations

LOOP_RUNS = 1000


def chain(number: int, equations: int = 300) -> str:
    """Return a model of many states; each `number` gives a text that no one has seen."""
    lines = ["display N1 | display C8 | scale = 2", "a = 0.5", "NN = 50 | DT = 0.01 | TMAX = 1"]
    lines += [f"x{i} = {1 + i % 7}" for i in range(equations)]
    lines += ["drun", "DYNAMIC"]
    for i in range(equations):
        before = f"x{(i - 1) % equations}"
        factor = number if i == number % equations else i
        lines.append(f"d/dt x{i} = a * ({before} - x{i}) + sin({factor} * t) * 0.0{1 + i % 9}")
    lines.append("dispt x0, x1, x2")
    return "\n".join(lines) + "\n"


def small(number: int) -> str:
    """Return an oscillator whose numbers are written into native code."""
    return f"""\
display N1 | display C8 | scale = 1
w = {1 + number % 13}.{number} | x = 1 | NN = 200 | DT = 0.001 | TMAX = 1
drun
DYNAMIC
d/dt x = y | d/dt y = -w * x - {number % 97}.{number % 89} * y
dispt x, y
"""


def loop(number: int) -> str:
    """Return a study of many runs."""
    return f"""\
display 0
NN = 5 | DT = 0.01 | TMAX = 0.1 | k = {number}
for i = 1 to {LOOP_RUNS}
x = i | drun
next
write 'ready'; x
DYNAMIC
d/dt x = -k * x
dispt x
"""


def vectors(number: int) -> str:
    """Return a model over arrays, and a delay line."""
    return f"""\
display N1 | display C8 | scale = 2
STATE v[100] | ARRAY w[100] | ARRAY buffer[100]
for i = 1 to 100
v[i] = i / 100 | w[i] = {number % 31}.5
next
NN = 20 | DT = 0.01 | TMAX = 0.5
drun
DYNAMIC
Vectr d/dt v = w - {number}.0 * 0.001 * v
d/dt u = w[1] - u
tdelay z = buffer(u, 0.05)
dispt z
"""


def stiff(number: int) -> str:
    """Return a stiff model."""
    return f"""\
display N1 | display C8 | scale = 1 | irule 16
y1 = 1 | y2 = 0 | y3 = 0 | ERMAX = 0.0001 | NN = 20 | DT = 0.0001 | TMAX = 1
drun
DYNAMIC
d/dt y1 = -0.04 * y1 + 1{number % 1000:04d} * y2 * y3
d/dt y2 = 0.04 * y1 - 1{number % 1000:04d} * y2 * y3 - 30000000 * y2^2
d/dt y3 = 30000000 * y2^2
dispt y1, y3
"""


def misspelt(number: int, equations: int = 300) -> str:
    """Return a text in which no name is known."""
    lines = ["drun", "DYNAMIC"]
    lines += [f"d/dt x{number}_{i} = unknown{number}a{i} + other{i}b{number}" for i in range(equations)]
    return "\n".join(lines).replace("_", "q") + "\n"
