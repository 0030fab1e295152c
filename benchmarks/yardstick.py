"""C programs to measure against: written, compiled and run by the benchmark itself."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path
from statistics import median

FLAGS = ("-O3", "-march=native")
_FRAME = """
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
{declarations}
int main(void) {{
    struct timespec begun, ended;
    for (int repeat = 0; repeat < {repeats}; repeat++) {{
        {before}
        clock_gettime({clock}, &begun);
        {work}
        clock_gettime({clock}, &ended);
        printf("%.9f %.17g\\n", (ended.tv_sec - begun.tv_sec) + 1e-9*(ended.tv_nsec - begun.tv_nsec),
        {result});
    }}
}}
"""


def run_c(
    declarations: str,
    before: str,
    work: str,
    result: str,
    *,
    repeats: int = 5,
    cpu: bool = False,
    flags: tuple[str, ...] = (),
) -> tuple[float, float]:
    """Return the median seconds of `work` and the value of the expression `result` after it.

    `flags`: more of the compiler's. `cpu`: seconds of the processor, which other programs on the machine do
    not lengthen.
    """
    clock = "CLOCK_PROCESS_CPUTIME_ID" if cpu else "CLOCK_MONOTONIC"
    text = _FRAME.format(
        declarations=declarations, before=before, work=work, result=result, repeats=repeats, clock=clock
    )
    with tempfile.TemporaryDirectory() as folder:
        source, program = Path(folder, "yardstick.c"), Path(folder, "yardstick")
        source.write_text(text, encoding="ascii")
        subprocess.run(["gcc", *FLAGS, *flags, str(source), "-o", str(program), "-lm"], check=True)
        lines = subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout.splitlines()
    times = [float(line.split()[0]) for line in lines]
    return median(times), float(lines[-1].split()[1])
