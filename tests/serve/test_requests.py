"""Which requests get in: those of the page that was announced, with its token."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest
from aiohttp import ClientSession, WSServerHandshakeError

from tests.serve.served import Browser, Served

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    server = Served(tmp_path_factory.mktemp("serve"), "--visitors", "2")
    yield server
    assert server.end() == 0


async def status(url: str, **headers: str) -> int:
    async with ClientSession() as session, session.get(url, headers=headers, allow_redirects=False) as answer:
        return answer.status


async def handshake(url: str, **headers: str) -> int:
    """Return the status of the answer to a websocket's request."""
    async with ClientSession() as session:
        try:
            async with session.ws_connect(url, headers=headers):
                return 101
        except WSServerHandshakeError as refused:
            return refused.status


async def test_the_page_is_for_its_address_only(served: Served):
    assert await status(served.url) == 200
    assert await status(served.url + "static/textual.js") == 200


@pytest.mark.parametrize(
    "path", ["", "static/textual.js", "static/page.css", "ws", "download/1", "elsewhere"]
)
async def test_without_the_token_there_is_nothing(served: Served, path: str):
    wrong = served.url[:-2] + ("A" if served.url[-2] != "A" else "B")
    for base in (served.origin, wrong, served.url[:-2], served.origin + "/%00", served.origin + "/é"):
        assert await status(f"{base}/{path}") == 403


async def test_tokens_cannot_be_guessed(served: Served):
    tokens = {url.split("/")[3] for url in served.urls}
    assert len(tokens) == 2
    assert all(len(token) == 43 for token in tokens)


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://127.0.0.1:1", "https://{host}", ""]
)
async def test_a_page_from_elsewhere_gets_nothing(served: Served, origin: str):
    origin = origin.format(host=served.origin.removeprefix("http://"))
    assert await handshake(served.url + "ws", Origin=origin) == 403
    assert await status(served.url, Origin=origin) == 403


async def test_a_websocket_without_a_page_gets_nothing(served: Served):
    assert await handshake(served.url + "ws") == 403


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "127.0.0.1.evil.example:{port}"]
)
async def test_a_host_that_was_not_announced_gets_nothing(served: Served, host: str):
    host = host.format(port=served.origin.split(":")[2])
    assert await status(served.url, Host=host) == 421
    assert await handshake(served.url + "ws", Host=host, Origin=f"http://{host}") == 421


async def test_the_machine_has_other_names_for_itself(served: Served):
    port = served.origin.split(":")[2]
    assert await status(served.url, Host=f"localhost:{port}", Origin=f"http://localhost:{port}") == 200


async def test_nothing_comes_from_elsewhere(served: Served):
    async with ClientSession() as session, session.get(served.url) as answer:
        page, headers = await answer.text(), answer.headers
    assert "https:" not in page
    assert "http:" not in page
    policy = headers["Content-Security-Policy"]
    assert policy.startswith("default-src 'none'; script-src 'self';")
    assert f"connect-src ws://{served.origin.removeprefix('http://')};" in policy
    assert headers["X-Frame-Options"] == "DENY"
    assert headers["Referrer-Policy"] == "no-referrer"
    assert "Server" not in headers
    for name in page.split('"')[1::2]:
        if name.startswith("static/"):
            assert await status(served.url + name) == 200


@pytest.mark.parametrize(
    "path", ["static/", "static", "static/..%2fserver.py", "static/%2e%2e/server.py", "static/js/textual.js"]
)
async def test_no_folder_is_listed_and_none_is_left(served: Served, path: str):
    assert await status(served.url + path) in (403, 404)


async def test_one_session_for_each_address_and_visitors_do_not_see_each_other(served: Served):
    async with ClientSession() as session:
        first = await Browser.connect(session, served)
        await first.until("F5")
        assert await handshake(served.url + "ws", Origin=served.origin) == 409
        second = await Browser.connect(session, served, served.urls[1])
        await second.until("F5")
        assert await handshake(served.urls[1] + "ws", Origin=served.origin) == 409

        # a page that is loaded again gets the next session as soon as the one before has ended
        await first.websocket.close()
        again = await Browser.connect(session, served)
        await again.until("F5")


async def test_what_is_no_message_is_passed_over(served: Served):
    async with ClientSession() as session:
        browser = await Browser.connect(session, served)
        await browser.until("F5")
        for wrong in ("", "{}", "[", "[]", "[1]", '["stdin"]', '["stdin", 3]', '["resize", 3]', "[" * 100_000, '["resize", {"width": "x", "height": 1e999}]', '["resize", {"width": -1, "height": 1e9}]', '["quit"]'):  # fmt: skip
            await browser.websocket.send_str(wrong)
        await browser.websocket.send_json(["resize", {"width": 100, "height": 60}])
        await browser.command("x = 41 + 1 | write x")
        await browser.until("42")


async def test_the_page_has_the_focus_asks_before_it_goes_and_keeps_files(served: Served):
    async with ClientSession() as session, session.get(served.url + "static/page.js") as answer:
        script = await answer.text()
    assert '.xterm-helper-textarea")?.focus()' in script
    assert 'addEventListener("beforeunload"' in script
    assert "link.download = name" in script
    for style in ("page.css", "xterm.css"):
        async with ClientSession() as session, session.get(served.url + "static/" + style) as answer:
            assert "http" not in (await answer.text()).replace("https://github.com", "").partition("*/")[2]


async def test_no_log_holds_a_token(served: Served):
    await status(served.url)
    await asyncio.sleep(0)
    assert served.url.split("/")[3] not in served.complaints


def test_warnings_for_what_others_can_reach(tmp_path: Path):
    server = Served(
        tmp_path, "--host", "0.0.0.0", "--public-url", "http://models.example:8080", "--allow-shell"
    )
    try:
        assert server.url.startswith("http://models.example:8080/")
        assert "other machines can reach" in server.complaints
        assert "not encrypted" in server.complaints
        assert "a shell on this machine" in server.complaints
    finally:
        assert server.end() == 0


def test_no_warning_on_the_own_machine(served: Served):
    assert served.complaints == ""
