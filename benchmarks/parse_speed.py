"""Parsing: 1401 scalar equations cold, after a one-line edit, again; a page of ordinary statements cold.

Yardstick, measured in the same process: `ast.parse`, Python's own parser in C, on the same equations.
Run: python -m benchmarks.parse_speed
"""

from __future__ import annotations

import ast
from time import process_time

from desire_tui.engine.source import Source
from desire_tui.engine.syntax import shapes
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.parsed_lines import forget_lines

REPEATS = 15


def ladder(count: int = 700) -> str:
    """The LC ladder of the book's section 2.2.4 as 2·count + 1 scalar equations (own text)."""
    lines = ["TMAX = 1.5 | DT = 0.001 | NN = 1501", "drun", "DYNAMIC", "d/dt i0 = 2*b*(v1 + rS*i0 - vS)"]
    for k in range(1, count + 1):
        lines.append(f"d/dt v{k} = a*(i{k} - i{k - 1})")
        lines.append(f"d/dt i{k} = b*(v{k + 1} - v{k})")
    return "\n".join([*lines, "dispt v10"])


PAGE = """
-- a page with one of nearly everything
display N14 | display C7 | display R | scale = 2
TMAX = 20 | DT = 0.01 | NN = 501 | irule 3
ARRAY X[10] + Y[10] = F | STATE x[3], V[2, 2] = v
data 1, 2, 3; 4, 5 | read X
FUNCTION f(a$, b$) = a$*cos(b$) + c
PROCEDURE p(n; R)
  for i = 1 to n step 2
    if i > 3 and R < 7 then write 'R =', R; i | else R = R + f(i, 0.5) | proceed
  next
end
x0 = 1.5 | call p(8; x0) | repeat | x0 = x0 - 1/(1 + x0^2) | until x0 < 0.1
while x0 < 1 | x0 = x0 + 0.25 | end while
drunr | write 'x0 = ', x0 | MATRIX A = $In(B) * C + 2*D%
DYNAMIC
u = 3*sin(w*t) | e = lim(u - y) | tdelay ud = D(u, 0.3)
d/dt y = ydot | d/dt ydot = -ww*y - r*ydot + u | Vectr d/dt x = A*x + b*u
OUT | DOT s = x*x + u*1 | term s - 10 | store S = s
dispt y, ydot, e
"""


def seconds(work, before=lambda: None) -> float:
    """Return the shortest processor time of several tries."""
    best = float("inf")
    for _ in range(REPEATS):
        before()
        began = process_time()
        work()
        best = min(best, process_time() - began)
    return best


def cold() -> None:
    """Forget all lines and shapes; the grammar's tables stay."""
    forget_lines()
    shapes.forget()


def main() -> None:
    """Print milliseconds and the ratio to the yardstick."""
    text = ladder()
    parse(Source("x = 1"))
    edits = iter(range(10**6))

    def edited() -> None:
        parse(Source(text.replace("d/dt v17 = a", f"d/dt v17 = {next(edits)}.5*a")))

    python = text.split("DYNAMIC\n")[1].replace("d/dt ", "ddt_").replace("dispt v10", "")
    yardstick = seconds(lambda: ast.parse(python))
    rows = {
        "1401 equations, cold": seconds(lambda: parse(Source(text)), cold),
        "1401 equations, one line edited": seconds(edited),
        "1401 equations, again": seconds(lambda: parse(Source(text))),
        "a page of 45 statements, cold": seconds(lambda: parse(Source(PAGE)), cold),
        "a page of 45 statements, shapes known": seconds(lambda: parse(Source(PAGE)), forget_lines),
    }
    print(f"{'Python reads the equations':40} {1e3 * yardstick:8.2f} ms")
    for name, value in rows.items():
        print(f"{name:40} {1e3 * value:8.2f} ms {value / yardstick:8.2f}")


if __name__ == "__main__":
    main()
