"""What a visitor can do at a served desktop, and what becomes of his work."""

from __future__ import annotations

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


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Callable[..., Served]]:
    servers: list[Served] = []
    (tmp_path / "secret.src").write_text("password = 1234\n")
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "own.src").write_text("own = 1\n")

    def start(*words: str) -> Served:
        servers.append(Served(tmp_path, *words))
        return servers[-1]

    yield start
    for server in servers:
        if server.process.poll() is None:
            assert server.end() == 0


def until(condition: Callable[[], object]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def children(pid: int) -> list[int]:
    path = f"/proc/{pid}/task/{pid}/children"
    return [int(word) for word in open(path).read().split()] if os.path.exists(path) else []  # noqa: PTH110, PTH123


async def test_shell_and_files_outside_are_refused_without_a_question(
    serve: Callable[..., Served], tmp_path: Path
):
    served = serve("own.src")
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        await browser.command(f"sh touch {tmp_path}/shelled")
        await browser.until("error 450")
        await browser.command(f"connect '{tmp_path}/outside.dat' as output 3")
        await browser.until("error 451")
        await browser.command(f"notebook '{tmp_path}/models/../outside.md'")
        await browser.until("error 451")
        assert "Permission" not in browser.shown
    assert not any((tmp_path / name).exists() for name in ("shelled", "outside.dat", "outside.md"))


@pytest.mark.parametrize(
    "name", ["../secret.src", "{folder}/secret.src", "~/secret.src", "link.src", ".hidden.src"]
)
async def test_the_desktop_opens_no_file_outside(serve: Callable[..., Served], tmp_path: Path, name: str):
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "secret.src").write_text("password = 1234\n")
    (tmp_path / "models" / ".hidden.src").write_text("password = 1234\n")
    (tmp_path / "models" / "link.src").symlink_to(tmp_path / "secret.src")
    served = serve()
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("F5")
        await browser.command(f"old '{name.format(folder=tmp_path)}'")
        await browser.until("error 451")
        assert "password" not in browser.shown


@pytest.mark.parametrize("name", ["../new.src", ".profile", "numpy.py", "Makefile.mk", "sub/.git/x.src"])
async def test_the_desktop_saves_programs_in_the_folder_only(
    serve: Callable[..., Served], tmp_path: Path, name: str
):
    served = serve("own.src")
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        await browser.command(f"keep '{name}'")
        await browser.until("error 451")
        assert not (served.folder / name).exists()
        await browser.command("keep 'other.src'")
        await browser.until("Saved")
    assert (served.folder / "other.src").read_text() == "own = 1\n"


async def test_the_open_dialog_shows_the_folder_only(serve: Callable[..., Served]):
    served = serve("own.src")
    (served.folder / "second.src").write_text("second = 2\n")
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        await browser.type(CTRL_O)
        await browser.until("second.src")
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


async def test_the_owners_unsaved_work_is_not_a_visitors(serve: Callable[..., Served], tmp_path: Path):
    state = tmp_path / "state" / "desire-tui"
    state.mkdir(parents=True)
    (state / "recovery-999999.json").write_text(
        '{"version": 1, "tabs": [{"path": null, "label": "diary", "text": "dear diary", "row": 0, "column": 0, "front": true}]}'
    )
    served = serve("own.src")
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("own.src")
        await browser.command("x = 41 + 1 | write x")
        await browser.until("42")
        assert "Unsaved work" not in browser.shown
