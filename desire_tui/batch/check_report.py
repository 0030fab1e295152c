"""The problems of programs for other tools: JSON as `desire run --json` has them, and SARIF 2.1.0.

SARIF: Static Analysis Results Interchange Format, OASIS standard, 2020; sections are those of its text.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.outputs.results import problem_data
from desire_tui.version import __version__

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"


def as_json(found: Mapping[str, Sequence[Diagnostic]]) -> str:
    """Return programs with their problems, and how many there are, as one JSON object."""
    every = [problem for problems in found.values() for problem in problems]
    content = {
        "desire": __version__,
        "programs": [
            {"program": program, "problems": [asdict(problem_data(problem)) for problem in problems]}
            for program, problems in found.items()
        ],
        "errors": sum(problem.severity == "error" for problem in every),
        "warnings": sum(problem.severity == "warning" for problem in every),
    }
    return json.dumps(content, ensure_ascii=False, indent=1) + "\n"


def as_sarif(found: Mapping[str, Sequence[Diagnostic]]) -> str:
    """Return the problems as a SARIF log of one run; its rules are our messages by key."""
    every = [(program, problem) for program, problems in found.items() for problem in problems]
    keys = sorted({problem.key for _, problem in every})
    run = {
        "tool": {"driver": {"name": "desire", "version": __version__, "rules": [_rule(key) for key in keys]}},
        "columnKind": "unicodeCodePoints",  # 3.14.17: else columns count halves of characters
        "artifacts": [{"location": {"uri": _uri(program)}} for program in found],
        "results": [_result(program, problem, keys.index(problem.key)) for program, problem in every],
    }
    log = {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}
    return json.dumps(log, ensure_ascii=False, indent=1) + "\n"


def _rule(key: str) -> dict[str, Any]:
    about = Diagnostic(key)
    rule: dict[str, Any] = {
        "id": key,
        "name": f"error {about.code}",
        "shortDescription": {"text": about.message},
    }
    if about.hint:
        rule["help"] = {"text": about.hint}
    return rule


def _result(program: str, problem: Diagnostic, rule: int) -> dict[str, Any]:
    sentence = problem.message + (f" (hint: {problem.hint})" if problem.hint else "")
    result: dict[str, Any] = {
        "ruleId": problem.key,
        "ruleIndex": rule,
        "level": problem.severity,
        "message": {"text": sentence},
        "locations": [_location(program, problem)],
    }
    places = [
        {"id": number, "message": {"text": other.message}, **_location(program, other)}
        for number, other in enumerate(problem.related, 1)
    ]
    return {**result, "relatedLocations": places} if places else result


def _location(program: str, problem: Diagnostic) -> dict[str, Any]:
    data = problem_data(problem)
    place: dict[str, Any] = {"artifactLocation": {"uri": _uri(program)}}
    if data.line is not None:
        place["region"] = {
            "startLine": data.line, "startColumn": data.column,
            "endLine": data.end_line, "endColumn": data.end_column,
        }  # fmt: skip
    return {"physicalLocation": place}


def _uri(program: str) -> str:
    """Return a name as a URI reference (3.4.3): relative ones are so to where the check ran."""
    path = Path(program)
    return path.as_uri() if path.is_absolute() else quote(path.as_posix())
