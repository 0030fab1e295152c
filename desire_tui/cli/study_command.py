"""`desire study`: a program's runs for many values of its quantities."""

from __future__ import annotations

import sys
from typing import Any

import click

from desire_tui.batch.ending import guarded
from desire_tui.cli.group import PROGRAMS
from desire_tui.cli.run_command import settings


@click.command()
@click.argument("file", type=PROGRAMS)
@click.option(
    "--over",
    multiple=True,
    metavar="NAME=VALUES",
    help="Vary over a grid: UC=0.2:0.3:101 (from, to, how many), k=1:1000:4:log, lead=0,5,10.",
)
@click.option(
    "--sample",
    multiple=True,
    metavar="NAME=DISTRIBUTION,…",
    help="Draw values: k=normal(40,4), r=lognormal(0,0.2), x0=uniform(-1,1); others as in scipy.stats.",
)
@click.option("--points", metavar="F", help="CSV file with values to run: names, then a line for each run.")
@click.option("--runs", type=int, metavar="N", help="How often values are drawn.")
@click.option(
    "--design",
    type=click.Choice(["random", "latin", "sobol"]),
    default="random",
    show_default=True,
    help="How values are drawn: each alone, as a Latin hypercube, as a Sobol sequence.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    metavar="N",
    help="For what is drawn and for ran(), gauss(). [default: 0, and the program's own SEED]",
)
@click.option(
    "--keep",
    multiple=True,
    required=True,
    metavar="QUANTITIES",
    help="What is kept of each run: x[end], max(x), min(x), mean(x), std(x), integral(x), t[x<1], y@0:2:0.1.",
)
@click.option("-o", "--output", metavar="F", help="Where the results go: .nc, .csv, or a folder .zarr.")
@click.option("--resume", is_flag=True, help="Go on with what the .zarr folder holds.")
@click.option("--threads", type=click.IntRange(min=1), metavar="N", help="[default: one for each core]")
@click.option(
    "--workers", type=click.IntRange(min=1), metavar="N", help="Worker processes of a local cluster."
)
@click.option("--cluster", metavar="ADDRESS", help="Scheduler of a Dask cluster: tcp://host:8786.")
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="NAME=VALUE",
    callback=settings,
    help="Override the script's own values, in all runs.",
)
@click.option("--input", "answers", metavar="F", help="File with the lines that `input` reads, in every run.")
@click.option("--segment", metavar="LABEL", help="The labelled segment whose run is meant.")
@click.option("--fast", is_flag=True, help="sin, exp … by the vector library, whose last 2 bits may differ.")
@click.option("--quiet", is_flag=True, help="No progress, no summary.")
@click.option("--allow-shell", is_flag=True, help="Let the program run shell commands.")
@click.option("--allow-write", is_flag=True, help="Let the program use any files.")
@click.option(
    "--backend",
    type=click.Choice(["native", "reference"]),
    default="native",
    show_default=True,
    help="Compiled code, or NumPy.",
)
def study(file: str, **options: Any) -> None:
    """Run a program for many values of its quantities, and keep some numbers of each run.

    A run that fails is a hole in the results, with its error's number. Exit status: 0 done, 1 the study
    cannot be made or all runs failed, 2 wrong usage, 3 stopped by Ctrl-C.
    """

    def work() -> int:
        from desire_tui.studies.command import study_file

        return study_file(file, options)

    sys.exit(guarded(work))
