"""`desire check --json` and `--sarif`: what other tools read."""

from __future__ import annotations

import json

import pytest

from tests.batch.command_line import desire


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "a b.src").write_text("-- 𝛼 beyond 16 bits\nwrite '𝛼', zork\n", encoding="utf-8")
    (tmp_path / "good.src").write_text("y = 2\n")
    (tmp_path / "warned.src").write_text(
        "TMAX = 1\ndrun L\nDYNAMIC\nOUT\nlabel L\nd/dt x = 1\nlabel L\nd/dt x = 2\n"
    )
    return tmp_path


def test_json(folder):
    status, out, err = desire("check", ".", "--json", cwd=folder)
    assert (status, err) == (1, "")
    report = json.loads(out)
    assert (report["errors"], report["warnings"] > 0) == (1, True)
    programs = {entry["program"]: entry["problems"] for entry in report["programs"]}
    assert list(programs) == ["a b.src", "good.src", "warned.src"]
    (problem,) = programs["a b.src"]
    assert (problem["code"], problem["line"], problem["column"], problem["end_column"]) == (200, 2, 12, 16)
    assert programs["good.src"] == []


def test_sarif(folder):
    """Read by a library of others' own, which knows the standard's fields and types."""
    from sarif_pydantic import Sarif

    status, out, err = desire("check", ".", "missing.src", "--sarif", cwd=folder)
    assert (status, err) == (1, "")
    log = Sarif.model_validate(json.loads(out))
    assert log.version == "2.1.0"
    (run,) = log.runs
    rules = [rule.id for rule in run.tool.driver.rules]
    for result in run.results:
        assert rules[result.rule_index] == result.rule_id
    first = run.results[0]
    place = first.locations[0].physical_location
    assert (first.level.value, place.artifact_location.uri) == ("error", "a%20b.src")
    assert (place.region.start_line, place.region.start_column, place.region.end_column) == (2, 12, 16)
    assert json.loads(out)["runs"][0]["columnKind"] == "unicodeCodePoints"
    assert {result.level.value for result in run.results} == {"error", "warning"}
    missing = run.results[-1].locations[0].physical_location
    assert (missing.artifact_location.uri, missing.region) == ("missing.src", None)


def test_no_problems_are_empty_reports(folder):
    assert json.loads(desire("check", "good.src", "--json", cwd=folder)[1])["errors"] == 0
    status, out, _ = desire("check", "good.src", "--sarif", cwd=folder)
    assert status == 0
    assert json.loads(out)["runs"][0]["results"] == []
