"""What a package index shows and what an installer does: metadata, extras, systems that will not do."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

import desire_tui
from desire_tui import __main__
from desire_tui.engine.outputs.formats import DATA
from desire_tui.systems import ON_WINDOWS
from tests.batch.command_line import desire

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
README = (ROOT / "README.md").read_text(encoding="utf-8")
LINUX_ON_ARM = {"sys_platform": "linux", "platform_machine": "aarch64"}


def names(requirements, **machine):
    """Return what would be installed on a machine."""
    needed = [Requirement(text) for text in requirements]
    return {need.name for need in needed if need.marker is None or need.marker.evaluate(machine or None)}


def test_there_is_a_wheel_of_every_dependency_for_linux_on_arm():
    everywhere = names(PROJECT["dependencies"], sys_platform="linux", platform_machine="x86_64")
    assert everywhere - names(PROJECT["dependencies"], **LINUX_ON_ARM) == {"scikit-sundae"}
    assert "scikit-sundae" in names(PROJECT["dependencies"], sys_platform="darwin", platform_machine="arm64")


def test_all_is_every_extra_for_users_and_developers_have_what_users_may_have():
    extras = PROJECT["optional-dependencies"]
    everything = set().union(*(Requirement(part).extras for part in extras["all"]))
    assert everything == extras.keys() - {"all", "dev", "docs", "bench"}
    for_users = set().union(*(names(extras[name]) for name in everything))
    assert for_users <= names(extras["dev"])
    assert not for_users & names(PROJECT["dependencies"])


def test_the_readme_begins_with_the_installation_and_its_links_lead_out_of_an_index_too():
    first = re.search(r"```sh\n(.*)\n", README)
    assert first is not None
    assert first[1].startswith("pip install desire-tui")
    links = re.findall(r"\]\(([^)]+)\)", README)
    home = PROJECT["urls"]["Homepage"]
    for link in links:
        place = re.fullmatch(rf"{home}/(?:raw|blob)/main/(.*)", link)
        assert place is not None, link
        assert (ROOT / place[1]).exists(), link
    assert any(link.endswith((".svg", ".gif")) for link in links)


@pytest.mark.parametrize("library", ["aiohttp", "textual_serve"])
def test_serving_without_its_libraries_names_the_extra(library, monkeypatch):
    monkeypatch.setattr(
        "desire_tui.cli.serve_command.find_spec", lambda name: None if name == library else object()
    )
    status, _, err = desire("serve")
    assert status == 2
    assert f"{library.replace('_', '-')}: pip install 'desire-tui[serve]'" in err


def test_an_extra_is_named_where_a_format_needs_it():
    extra = names(PROJECT["optional-dependencies"]["data"])
    assert {known.needs for known in DATA if known.needs} <= extra


def test_windows_gets_a_sentence(monkeypatch):
    monkeypatch.setattr("sys.platform", "win32")
    with pytest.raises(SystemExit) as end:
        __main__.main(["run", "x.src"])
    assert end.value.code == ON_WINDOWS
    assert "WSL" in ON_WINDOWS
    for use in (
        lambda: desire_tui.run("x = 1 | y = 2"),
        lambda: desire_tui.load("x.src"),
        lambda: desire_tui.Session,
    ):
        with pytest.raises(OSError, match="WSL"):
            use()
