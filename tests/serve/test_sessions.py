"""What a visitor can do at a served desktop, and what becomes of his work."""

from __future__ import annotations

import base64
import os
import time
from typing import TYPE_CHECKING

import pytest
from aiohttp import ClientSession

from tests.serve.served import PATIENCE_S, Browser, Served

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

CTRL_O, CLICK = "\x0f", "\x1b[<0;20;2M\x1b[<0;20;2m"


NAMES_OUTSIDE = ("../secret.src", "{folder}/secret.src", "~/secret.src", "link.src", ".hidden.src")
NAMES_NOT_TO_WRITE = ("../new.src", ".profile", "numpy.py", "Makefile.mk", "sub/.git/x.src")


def fill(folder: Path) -> None:
    """Make the files of the one who serves: programs of a folder, and what a visitor must not see."""
    for name in ("models", "home", "state/desire-tui"):
        (folder / name).mkdir(parents=True)
    (folder / "models" / "own.src").write_text("own = 1\n")
    for name in ("secret.src", "home/secret.src", "models/.hidden.src"):
        (folder / name).write_text("password = 1234\n")
    (folder / "models" / "link.src").symlink_to(folder / "secret.src")


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Callable[..., Served]]:
    servers: list[Served] = []
    fill(tmp_path)

    def start(*words: str) -> Served:
        servers.append(Served(tmp_path, *words))
        return servers[-1]

    yield start
    for server in servers:
        if server.process.poll() is None:
            assert server.end() == 0


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A server for all tests of what one visitor can do; its owner has left unsaved work."""
    folder = tmp_path_factory.mktemp("served")
    fill(folder)
    (folder / "state" / "desire-tui" / "recovery-999999.json").write_text(
        '{"version": 1, "tabs": [{"path": null, "label": "diary", "text": "dear diary", "row": 0, "column": 0, "front": true}]}'
    )
    server = Served(folder, "own.src")
    yield server
    assert server.end() == 0


def until(condition: Callable[[], object]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def children(pid: int) -> list[int]:
    path = f"/proc/{pid}/task/{pid}/children"
    return [int(word) for word in open(path).read().split()] if os.path.exists(path) else []  # noqa: PTH110, PTH123


async def test_a_visitor_gets_no_shell_and_no_file_outside_and_is_not_asked(served: Served):
    outside = served.folder.parent
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        await browser.fails(f"sh touch {outside}/shelled", "error 450", mark=7001)
        await browser.fails(f"connect '{outside}/outside.dat' as output 3", "error 451", mark=7002)
        await browser.fails(f"notebook '{outside}/models/../outside.md'", "error 451", mark=7003)
        for mark, name in enumerate(NAMES_OUTSIDE, 7004):
            await browser.fails(f"old '{name.format(folder=outside)}'", "error 451", mark=mark)
            assert "password" not in browser.shown, name
        assert "Permission" not in browser.shown
        assert "Unsaved work" not in browser.shown  # the owner's is not a visitor's
    assert not any((outside / name).exists() for name in ("shelled", "outside.dat", "outside.md"))


async def test_the_desktop_saves_programs_in_the_folder_only(served: Served):
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        for mark, name in enumerate(NAMES_NOT_TO_WRITE, 7001):
            await browser.fails(f"keep '{name}'", "error 451", mark=mark)
            assert not (served.folder / name).exists()
        await browser.command("keep 'other.src'")
        await browser.until("Saved")
    assert (served.folder / "other.src").read_text() == "own = 1\n"


async def test_the_page_knows_unsaved_work_and_gets_pictures_and_data(served: Served):
    """It asks before it goes, by `beforeunload`, as long as there is unsaved work; files are downloads."""
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        await browser.command("x = 1 | TMAX = 1 | DT = 0.1 | NN = 5")
        await browser.press("\x0e")  # a new tab
        await browser.type("x = 1 | TMAX = 1 | DT = 0.1 | NN = 5\rdrun\rDYNAMIC\rd/dt x = -x\rdispt x\r")
        assert await browser.until_told("unsaved") is True
        await browser.press("\x1b[15~")  # F5
        await browser.until("TMAX reached")
        await browser.press("\x0c")  # the command line
        await browser.type("export 'data/own.csv'\r")
        file = await browser.until_told("file")
        assert file["name"] == "own.csv"
        assert base64.b64decode(file["base64"]) == (served.folder / "data" / "own.csv").read_bytes()
        assert base64.b64decode(file["base64"]).startswith(b"t,x")
        await browser.type("snapshot 'own.png'\r")
        file = await browser.until_told("file")
        assert base64.b64decode(file["base64"]).startswith(b"\x89PNG")
        await browser.type("keep 'mine.src'\r")
        assert await browser.until_told("unsaved") is False


async def test_the_open_dialog_shows_the_folder_only(served: Served):
    (served.folder / "second.src").write_text("second = 2\n")
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        await browser.type(CTRL_O)
        await browser.until("second.src")
        assert "secret" not in browser.shown
        await browser.command("second")
        await browser.until("second = 2")


async def test_what_is_allowed_by_the_one_who_serves(serve: Callable[..., Served], tmp_path: Path):
    served = serve("--allow-shell", "--allow-write")
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("F5")
        await browser.command("sh echo she\\\\lled")
        await browser.until("lled")
        await browser.command(f"old '{tmp_path}/secret.src'")
        await browser.until("password")


async def test_work_is_kept_when_the_page_goes_away(serve: Callable[..., Served], tmp_path: Path):
    served = serve("own.src")
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        await browser.press(CLICK)
        await browser.type("precious ")
        await browser.until("precious")
        await browser.websocket.close()
        until(lambda: not children(served.process.pid))
        assert any("precious" in file.read_text() for file in (tmp_path / "state").rglob("recovery-*.json"))
        again = await Browser.connect(session, served)
        await again.until("Unsaved work found")


async def test_nothing_goes_on_when_the_server_was_killed(serve: Callable[..., Served], tmp_path: Path):
    served = serve("own.src")
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        await browser.press(CLICK)
        await browser.type("precious ")
        await browser.until("precious")
        (child,) = children(served.process.pid)
        served.process.kill()
        served.process.wait()
        until(lambda: not os.path.exists(f"/proc/{child}"))  # noqa: PTH110
    assert any("precious" in file.read_text() for file in (tmp_path / "state").rglob("recovery-*.json"))


async def test_desktops_end_with_the_server(serve: Callable[..., Served]):
    served = serve("own.src")
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        (child,) = children(served.process.pid)
        assert served.end() == 0
        until(lambda: not os.path.exists(f"/proc/{child}"))  # noqa: PTH110
