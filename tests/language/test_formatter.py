"""The usual layout: what it is, that it says what the text said, and that it is its own."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings

from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.language.formatter import formatted
from tests.strategies import broken_texts, programs
from tests.syntax.format.program import format_program

ROOT = Path(__file__).parents[2]
PROGRAMS = sorted([*(ROOT / "examples").rglob("*.src"), *(ROOT / "tests" / "programs").rglob("*.src")])


def said(text):
    """Everything that a text says: its statements where they are, its problems, its comments."""
    program = parse(Source(text))
    segments = [
        (one.label, [p.node for p in one.body], [p.node for p in one.jacobian]) for one in program.segments
    ]
    return [(p.number, p.node) for p in program.script], segments, [p.key for p in program.problems]


BEFORE = """\


for k=1 to 3|x[k]=-2*( a+b )^ 2   -- table
if k>2 then
y = k | else   | y=0
   -- neither
   -- nor
proceed|next



write  'a  b' ,x;
DYNAMIC
d/dt   x = - k * x + f( t ,y )--decay
if t-1
z = 1
end if
OUT
  total = total +
     z    -- goes on
dispt x,y
"""
AFTER = """\
for k = 1 to 3 | x[k] = -2*(a + b)^2  -- table
  if k > 2 then
    y = k | else | y = 0
    -- neither
    -- nor
proceed | next


write 'a  b', x;
DYNAMIC
d/dt x = -k*x + f(t, y) --decay
if t - 1
  z = 1
end if
OUT
total = total +
   z      -- goes on
dispt x, y
"""


def test_the_usual_layout():
    assert formatted(BEFORE) == AFTER


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("210 x=1\n220 if x then\n230 y=2\n240 proceed\n", "210 x = 1\n220 if x then\n230   y = 2\n240 proceed\n"),
        ("a=1 -- one\nbb=22 -- two\nlong=333   -- three\n", "a = 1 -- one\nbb = 22 -- two\nlong = 333 -- three\n"),
        ("a=1   -- one\nbb=2  -- two\n", "a = 1   -- one\nbb = 2  -- two\n"),
        ("x=1\r\ny=2\r\n", "x = 1\r\ny = 2\r\n"),
        ("x=1", "x = 1\n"),
        ("", ""),
        ("\n \n", ""),
        ("ab_\nc=1\n", "ab_\nc=1\n"),
        ("x = 3 - - 2\n", "x = 3 - -2\n"),
        ("x = - - 2\n", "x = - -2\n"),
        ("x = 2 ^ - 1\n", "x = 2^-1\n"),
        ("event x\nx=0\nend event\n", "event x\nx = 0\nend event\n"),
        ("x = = 2\ny=1\n", "x = = 2\ny = 1\n"),
        ("DYNAMIC\nVector y ^ = [ m ] A % * x\nVector z = x { 1 } + P #\n", "DYNAMIC\nVector y^ = [m] A%*x\nVector z = x{1} + P#\n"),
        ("write # 2 , $ n , %m;\n", "write #2, $n, %m;\n"),
        ("x = 5 – 2\n", "x = 5 - 2\n"),
        ("event - 1\n", "event - 1\n"),
        ("y = A[i + -1]\n", "y = A[i + -1]\n"),
        ("y = A[i +-1]\n", "y = A[i+-1]\n"),
        ("3 x\n", "3 x\n"),
        ("sh _", "sh _"),
        ("x=1 _", "x=1 _"),
        ("x[i + -1] = y[i+1] + z[ - k]\n", "x[i + -1] = y[i+1] + z[-k]\n"),
    ],
)  # fmt: skip
def test_a_form(before, after):
    assert formatted(before) == after


@pytest.mark.parametrize("shard", range(8))
def test_programs_say_the_same_and_stay_so(shard):
    for path in PROGRAMS[shard::8]:
        text = path.read_text(encoding="utf-8")
        laid_out = formatted(text)
        assert said(laid_out) == said(text), path
        assert formatted(laid_out) == laid_out, path


@settings(deadline=None, max_examples=30)
@given(programs())
def test_any_program_says_the_same(program):
    text = format_program(program)
    laid_out = formatted(text)
    assert said(laid_out) == said(text)
    assert formatted(laid_out) == laid_out


@settings(deadline=None, max_examples=300)
@given(broken_texts)
def test_any_text_says_the_same(text):
    laid_out = formatted(text)
    assert said(laid_out) == said(text)
    assert formatted(laid_out) == laid_out
