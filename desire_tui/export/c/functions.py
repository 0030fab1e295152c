"""The function library in C: the formulas of `codegen.ir.functions`, written out where they are used."""

from __future__ import annotations

from desire_tui.engine.random_sequence import INCREMENT, MASK, MULTIPLIER, SCALE

C_NAMES = {
    "sin": "sin", "cos": "cos", "tan": "tan", "asin": "asin", "acos": "acos", "atan": "atan", "sinh": "sinh",
    "cosh": "cosh", "tanh": "tanh", "exp": "exp", "ln": "log", "log": "log10", "pow": "pow", "atan2": "atan2",
    "sqrt": "sqrt", "abs": "fabs", "round": "round", "trnc": "trunc", "floor": "floor",
}  # fmt: skip
"""Functions of C's own library."""

_ONE_LINE = {
    "recip": "1.0 / x",
    "lim": "x <= 0.0 ? 0.0 : x",
    "swtch": "comp(x, 0.0, 1.0)",
    "sat": "x > 1.0 ? 1.0 : x <= -1.0 ? -1.0 : x",
    "SAT": "x > 1.0 ? 1.0 : x <= 0.0 ? 0.0 : x",
    "deadz": "x - sat(x)",
    "deadc": "x > 1.0 ? 1.0 : x < -1.0 ? -1.0 : x <= 1.0 ? 0.0 : x",
    "sgn": "x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x + 0.0",
    "rect": "fabs(x) < 1.0 ? 1.0 : fabs(x) >= 1.0 ? 0.0 : x",
    "tri": "1.0 - fabs(x)",
    "sinc": "x == 0.0 ? 1.0 : sin(x) / x",
    "sigmoid": "1.0 / (1.0 + exp(-x))",
    "SIGMOID": "x <= 0.0 ? 0.0 : isinf(x * x) ? 1.0 : x * x / (1.0 + x * x)",
}
_NEEDS = {
    "swtch": ("comp",),
    "deadz": ("sat",),
    "gauss": ("uniform",),
    "ran": ("uniform",),
    "table2": ("bracket",),
}
_TEXTS = {
    "comp": "static double comp(double x, double minus, double plus)\n"
    "{\n    return x > 0.0 ? plus : x <= 0.0 ? minus : x;\n}\n",
    "max": "static double maximum(double x, double y)\n{\n    return isnan(x) ? x : y <= x ? x : y;\n}\n",
    "min": "static double minimum(double x, double y)\n{\n    return isnan(x) ? x : y >= x ? x : y;\n}\n",
    "ipow": """/* x to a whole power, as repeated products from the top bit. */
static double whole_power(double x, int n)
{
    unsigned size = n < 0 ? -(unsigned)n : (unsigned)n, bit = 1;
    double result = x;
    if (n == 0)
        return 1.0;
    while (bit <= size / 2)
        bit *= 2;
    for (bit /= 2; bit > 0; bit /= 2) {
        result = result * result;
        if (size & bit)
            result = result * x;
    }
    return n < 0 ? 1.0 / result : result;
}
""",
    "uniform": f"""/* 0 <= u < 1, as POSIX's drand48. */
static double uniform(void)
{{
    random_state = ({MULTIPLIER:#x}u * random_state + {INCREMENT}u) & {MASK:#x}u;
    return (double)random_state * {SCALE!r};
}}
""",
    "ran": "static double ran(void)\n{\n    return 2.0 * uniform() - 1.0;\n}\n",
    "gauss": """static double gauss(void)
{
    double u = uniform(), radius = sqrt(-2.0 * log(u));
    return radius * cos(6.283185307179586 * uniform());
}
""",
    "table1": """/* Linear interpolation: n breakpoints, then n values; constant outside. */
static double table1(double x, const double *table, int n)
{
    int k;
    if (isnan(x))
        return x;
    if (x <= table[0])
        return table[n];
    if (x >= table[n - 1])
        return table[2 * n - 1];
    for (k = 1; table[k] <= x; k++)
        ;
    table += k - 1;
    return table[n] + (table[n + 1] - table[n]) * ((x - table[0]) / (table[1] - table[0]));
}
""",
    "bracket": """/* The interval that holds x, and x's place in it (0 to 1). */
static int bracket(double x, const double *points, int n, double *part)
{
    int k;
    *part = 0.0;
    if (x <= points[0] || n == 1)
        return 0;
    if (x >= points[n - 1])
        return n - 1;
    for (k = 1; points[k] <= x; k++)
        ;
    *part = (x - points[k - 1]) / (points[k] - points[k - 1]);
    return k - 1;
}
""",
    "table2": """/* Bilinear interpolation of f[n][m] over xs[n] and ys[m]; constant outside. */
static double table2(double x, double y, const double *f, int n, int m, const double *xs, const double *ys)
{
    double p, q, lower, upper;
    int i, k, i2, k2;
    if (isnan(x) || isnan(y))
        return NAN;
    i = bracket(x, xs, n, &p);
    k = bracket(y, ys, m, &q);
    i2 = i + 1 < n ? i + 1 : n - 1;
    k2 = k + 1 < m ? k + 1 : m - 1;
    lower = f[i * m + k] + (f[i * m + k2] - f[i * m + k]) * q;
    upper = f[i2 * m + k] + (f[i2 * m + k2] - f[i2 * m + k]) * q;
    return lower + (upper - lower) * p;
}
""",
    "row_product": """/* Row i of a matrix (or column i, with stride `across`) times a vector. */
static double row_product(const double *row, int across, const double *x, int n)
{
    double sum = 0.0;
    int k;
    for (k = 0; k < n; k++)
        sum += row[k * across] * x[k];
    return sum;
}
""",
    "shifted": """/* Element i of a vector of n, 0 outside. */
static double shifted(const double *x, int n, int i)
{
    return i >= 0 && i < n ? x[i] : 0.0;
}
""",
    "pattern_row": """/* The row of a matrix that iRow chooses, the first one after the last. */
static int pattern_row(double number, int rows)
{
    long row = fabs(number) < 1e15 ? (long)(number - 1.0) % rows : 0;
    return (int)(row < 0 ? row + rows : row);
}
""",
}


def definitions(used: set[str]) -> str:
    """Return the C functions behind the names that are used, those they need first."""
    wanted: list[str] = []

    def want(name: str) -> None:
        for needed in _NEEDS.get(name, ()):
            want(needed)
        if name not in wanted and (name in _TEXTS or name in _ONE_LINE):
            wanted.append(name)

    for name in sorted(used):
        want(name)
    parts = [
        _TEXTS.get(name) or f"static double {name}(double x)\n{{\n    return {_ONE_LINE[name]};\n}}\n"
        for name in wanted
    ]
    return "\n".join(parts)
