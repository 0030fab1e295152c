"""Modules and settings in the current folder, beside a stranger's program, are not ours."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from aiohttp import ClientSession

from tests.serve.served import ROOT, Browser, Served

if TYPE_CHECKING:
    from pathlib import Path

PROGRAM = "DT=0.1 | TMAX=1 | NN=11\nx=1\ndrun\nDYNAMIC\nd/dt x=-x\ndispt x\n"
HOSTILE = "open({mark!r}, 'w').close()\nraise SystemExit('hostile')\n"
LIBRARIES = (
    "numpy",
    "textual",
    "click",
    "lark",
    "llvmlite",
    "aiohttp",
    "matplotlib",
    "sksundae",
    "platformdirs",
    "rich",
)


def plant(folder: Path, mark: Path) -> None:
    for name in LIBRARIES:
        (folder / f"{name}.py").write_text(HOSTILE.format(mark=str(mark)))
    (folder / "own.src").write_text(PROGRAM)


@pytest.mark.parametrize("path", ["{root}", ":{root}:.:"])
@pytest.mark.parametrize(
    "start", [["-m", "desire_tui"], ["-c", "from desire_tui.__main__ import main; main()"]]
)
def test_a_run_imports_nothing_from_the_current_folder(tmp_path: Path, start: list[str], path: str):
    (tmp_path / "cwd").mkdir()
    plant(tmp_path / "cwd", tmp_path / "mark")
    env = {**os.environ, "PYTHONPATH": path.format(root=ROOT)}
    for words in (
        ["run", "own.src", "--png", "graph.png", "--csv", "-"],
        ["check", "own.src"],
        ["--version"],
    ):
        done = subprocess.run(
            [sys.executable, *start, *words],
            cwd=tmp_path / "cwd",
            env=env,
            capture_output=True,
            text=True,
            check=False,
        )
        assert (done.returncode, done.stderr) == (0, "")
    assert not (tmp_path / "mark").exists()


@pytest.mark.parametrize("python", [(), ("-P",)])
async def test_a_served_desktop_imports_nothing_from_there(tmp_path: Path, python: tuple[str, ...]):
    (tmp_path / "models").mkdir()
    plant(tmp_path / "models", tmp_path / "mark")
    served = Served(tmp_path, "own.src", python=python)
    try:
        async with ClientSession() as session:
            browser = await Browser.connect(session, served)
            await browser.until("own.src")
            await browser.command("zz")
            await browser.command("x = 41 + 1 | write x")
            await browser.until("42")
    finally:
        assert served.end() == 0
    assert not (tmp_path / "mark").exists()


def test_settings_of_the_current_folder_do_not_start_latex(tmp_path: Path):
    """matplotlib reads `matplotlibrc` there; TeX can read files."""
    (tmp_path / "matplotlibrc").write_text("text.usetex: True\n")
    (tmp_path / "own.src").write_text(PROGRAM)
    tools = tmp_path / "tools"
    tools.mkdir()
    for tool in ("latex", "dvipng"):
        (tools / tool).write_text(f"#!/bin/sh\ntouch {tmp_path}/mark\nexit 1\n")
        (tools / tool).chmod(0o755)
    env = {**os.environ, "PYTHONPATH": str(ROOT), "PATH": f"{tools}:{os.environ['PATH']}"}
    done = subprocess.run(
        [sys.executable, "-m", "desire_tui", "run", "own.src", "--png", "graph.png"],
        cwd=tmp_path, env=env, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    assert not (tmp_path / "mark").exists()
