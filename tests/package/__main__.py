"""Builds the source archive and the wheel, and tries the wheel as a new user would: `make dist`.

In an empty folder, in a new virtual environment, from the package index: `python -m tests.package [PYTHON …]`,
each PYTHON an interpreter (`python3.13`) to try it with.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
DIST = ROOT / "dist"
IN_THE_SOURCE_ARCHIVE = (
    "README.md", "CHANGELOG.md", "LICENSE", "Makefile", "docs/getting-started.md", "docs/pictures/lorenz.png",
    "docs/desire.1", "tests/conftest.py", "tests/programs/original", "examples/ch2/lorenz.src", "benchmarks/__main__.py",
)  # fmt: skip
IN_THE_WHEEL = (
    "desire_tui/py.typed", "desire_tui/examples/ch2/lorenz.src", "desire_tui/engine/syntax/desire.lark",
    "desire_tui/help/pages/runs.toml",
)  # fmt: skip
API = """
import desire_tui
run = desire_tui.load("x = 1 | TMAX = 1 | DT = 0.001 | drun\\nDYNAMIC\\nd/dt x = -x\\ndispt x\\n").run()
assert abs(run["x"][-1] - 0.36787944) < 1e-5, run["x"][-1]
"""
STIFF = (
    "irule 14 | ERMAX = 1.0E-6 | x = 1 | TMAX = 1 | NN = 3\ndrun\nDYNAMIC\nd/dt x = -1000*x + 1000\ndispt x\n"
)


def main() -> None:
    """Build, look into what was built, try it with this interpreter or those named."""
    source, wheel = build()
    look_into(source, wheel)
    for python in sys.argv[1:] or [sys.executable]:
        with tempfile.TemporaryDirectory(prefix="desire-trial-") as folder:
            try_wheel(wheel, python, Path(folder))
    sys.stdout.write(f"{source}\n{wheel}\n")


def build() -> tuple[Path, Path]:
    """Build both, the wheel from the source archive: what is missing there is missed here."""
    shutil.rmtree(DIST, ignore_errors=True)
    command = [sys.executable, "-m", "build", "--outdir", str(DIST), str(ROOT)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    (source,), (wheel,) = DIST.glob("*.tar.gz"), DIST.glob("*.whl")
    return source, wheel


def look_into(source: Path, wheel: Path) -> None:
    """See that what users and packagers want is there, and nothing of a development folder."""
    with tarfile.open(source) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    missing = [name for name in IN_THE_SOURCE_ARCHIVE if name not in names]
    assert not missing, f"{source.name} lacks {missing}"
    with zipfile.ZipFile(wheel) as packed:
        files = packed.namelist()
    missing = [name for name in IN_THE_WHEEL if name not in files]
    missing += [] if any(name.endswith("share/man/man1/desire.1") for name in files) else ["desire.1"]
    assert not missing, f"{wheel.name} lacks {missing}"
    strange = [name for name in files if not name.startswith("desire_tui")]
    assert not strange, f"{wheel.name} holds {strange}"


def try_wheel(wheel: Path, python: str, folder: Path) -> None:
    """Install the wheel and use it, nothing else being there."""
    environment = folder / "environment"
    subprocess.run([python, "-m", "venv", str(environment)], check=True)
    here = folder / "empty"
    here.mkdir()
    inside = {
        **{name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_ENV"))},
        "PATH": f"{environment / 'bin'}{os.pathsep}{os.environ['PATH']}", "HOME": str(folder),
        "XDG_CACHE_HOME": str(folder / "cache"), "XDG_STATE_HOME": str(folder / "state"),
    }  # fmt: skip

    def call(*words: str, status: int = 0) -> str:
        done = subprocess.run(words, cwd=here, env=inside, capture_output=True, text=True, check=False)
        assert done.returncode == status, f"{words}: {done.returncode}\n{done.stdout}\n{done.stderr}"
        assert "Traceback" not in done.stderr, done.stderr
        return done.stdout + done.stderr

    uv = shutil.which("uv", path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    pip = (uv, "pip") if uv is not None else ("python", "-m", "pip")
    where = ("--python", str(environment / "bin" / "python")) if uv is not None else ()
    call(*pip, "install", "--quiet", *where, str(wheel))
    sys.stdout.write(call("desire", "--version"))
    assert "desire-tui[serve]" in call("desire", "serve", status=2)
    call("desire", "examples", "--copy", "examples")
    call("desire", "check", "examples/ch2")
    call("desire", "run", "examples/ch2/lorenz.src", "--png", "lorenz.png", "--csv", "lorenz.csv")
    assert (here / "lorenz.png").read_bytes().startswith(b"\x89PNG")
    assert "d/dt" in call("desire", "help", "d/dt")
    (here / "stiff.src").write_text(STIFF, encoding="utf-8")
    call("desire", "run", "stiff.src", "--json", "stiff.json")
    call("python", "-c", API)
    assert (environment / "share/man/man1/desire.1").is_file()
    call(*pip, "uninstall", "--quiet", *(where or ("--yes",)), "scikit-sundae")  # as on Linux on ARM
    call("desire", "run", "stiff.src", "--json", "without.json")
    for name in ("stiff", "without"):
        content = json.loads((here / f"{name}.json").read_text(encoding="utf-8"))
        assert abs(content["quantities"]["x"] - 1) < 1e-6, content["quantities"]
    (here / "adams.src").write_text(STIFF.replace("irule 14", "irule 9"), encoding="utf-8")
    assert "error 460" in call("desire", "run", "adams.src", status=1)


if __name__ == "__main__":
    main()
