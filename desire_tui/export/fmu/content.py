"""A run as an FMU: source, description and a shared library, in one archive."""

from __future__ import annotations

import platform
import re
import subprocess
import sys
from hashlib import blake2b
from importlib.resources import files
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING
from zipfile import ZIP_DEFLATED, ZipFile

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic, closest
from desire_tui.export.c.model_file import ModelFile
from desire_tui.export.fmu.description import Description
from desire_tui.export.fmu.hooks import hooks, is_continuous
from desire_tui.export.run import exported_run

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.export.formats import Export
    from desire_tui.export.run import ExportedRun

_FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-fvisibility=hidden")
_ANY_RULE = 3
"""Stands in the source where nothing steps by it."""
_NOT_C = re.compile(r"\W", re.ASCII)
_MACHINES = {"AMD64": "x86_64", "arm64": "aarch64"}
_BUILD = """<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
  <BuildConfiguration modelIdentifier="{identifier}">
    <SourceFileSet language="C99" compilerOptions="-ffp-contract=off">
      <SourceFile name="glue.c"/>
    </SourceFileSet>
    <Library name="m" external="true"/>
  </BuildConfiguration>
</fmiBuildDescription>
"""


def content(export: Export) -> bytes:
    """Return the archive.

    DesireError 530: what an FMU does not have here; 531: there is no compiler; 520: an input is no parameter.
    """
    run = exported_run(export)
    _check_inputs(export, run.parameters)
    file, steps = _file(run)
    text = file.text()
    token = blake2b(text.encode(), digest_size=16).hexdigest()
    stem = Path(export.source.file_name).stem
    identifier = _NOT_C.sub("_", stem) or "model"
    if identifier[0].isdigit():
        identifier = f"model_{identifier}"
    model = f"{text}\n{hooks(file, token)}"
    glue = (files(__package__) / "glue.c").read_text("utf-8")
    description = Description(file, identifier, token, export.inputs, steps=steps).xml()
    archive = BytesIO()
    with ZipFile(archive, "w", ZIP_DEFLATED) as packed:
        packed.writestr("modelDescription.xml", description)
        packed.writestr(f"binaries/{_platform()}/{identifier}{_ending()}", _library(model, glue))
        packed.writestr("sources/model.c", model)
        packed.writestr("sources/glue.c", glue)
        packed.writestr("sources/buildDescription.xml", _BUILD.format(identifier=identifier))
    return archive.getvalue()


def _file(run: ExportedRun) -> tuple[ModelFile, bool]:
    """Return the C file's parts, and whether it steps by the program's own rule.

    A rule that C does not have here (9 to 17, a switch that is located) leaves model exchange, which needs
    none. DesireError 530.
    """
    try:
        return ModelFile(run), True
    except DesireError:
        if not is_continuous(run.segment):
            raise
        return ModelFile(replace(run, plan=replace(run.plan, rule=_ANY_RULE))), False


def _check_inputs(export: Export, known: Mapping[str, float]) -> None:
    problems = []
    for name in export.inputs:
        if name not in known:
            near = closest(name, known)
            remedy = f"did you mean {near}?" if near else f"there are {', '.join(list(known)[:8])}"
            facts = {"what": f"'{name}' is no parameter, which an input has to be", "remedy": remedy}
            problems.append(Diagnostic("analysis-form", None, facts, export.source))
    if problems:
        raise DesireError(*problems)


def _library(model: str, glue: str) -> bytes:
    """Return the shared library. DesireError 531."""
    with TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "model.c").write_text(model, "utf-8")
        (place / "glue.c").write_text(glue, "utf-8")
        made = place / "made"
        command = ["cc", *_FLAGS, str(place / "glue.c"), "-o", str(made), "-lm"]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - our words
        except OSError as reason:
            facts = {"format": "an FMU", "reason": str(reason.strerror or reason)}
            raise DesireError(Diagnostic("export-compiler", None, facts)) from None
        if done.returncode:
            facts = {
                "format": "an FMU",
                "reason": done.stderr.strip().splitlines()[0] if done.stderr else "cc failed",
            }
            raise DesireError(Diagnostic("export-compiler", None, facts))
        return made.read_bytes()


def _platform() -> str:
    machine = _MACHINES.get(platform.machine(), platform.machine())
    return f"{machine}-{'darwin' if sys.platform == 'darwin' else 'linux'}"


def _ending() -> str:
    return ".dylib" if sys.platform == "darwin" else ".so"
