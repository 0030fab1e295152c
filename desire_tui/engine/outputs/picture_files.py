"""Graphs as picture files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.files import write_bytes
from desire_tui.engine.outputs.formats import PICTURES
from desire_tui.engine.outputs.picture_options import FOR_PAPER

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.formats import PictureFormat
    from desire_tui.engine.outputs.picture_options import PictureOptions


def picture_format(path: Path) -> PictureFormat:
    """Return the kind of picture that a name stands for. DesireError 34: none."""
    known = next((known for known in PICTURES if known.ending == path.suffix.lower()), None)
    if known is None:
        raise DesireError(Diagnostic("picture-kind", facts={"path": path}))
    return known


def write_picture(graph: Graph, path: Path, options: PictureOptions = FOR_PAPER) -> None:
    """Write a graph. DesireError 34: an ending that is no picture's; 106: the file cannot be written."""
    content = picture_format(path).content(graph, options)
    write_bytes(path, lambda file: file.write(content))


def write_pictures(graphs: Sequence[Graph], path: Path, options: PictureOptions = FOR_PAPER) -> None:
    """Write one graph to `path`, several to `NAME-1.png`, `NAME-2.png` …, or as pages of one document.

    DesireError as `write_picture`.
    """
    if len(graphs) == 1:
        write_picture(graphs[0], path, options)
        return
    document = picture_format(path).document
    if document is not None:
        content = document(graphs, options)
        write_bytes(path, lambda file: file.write(content))
        return
    for number, graph in enumerate(graphs, 1):
        write_picture(graph, path.with_name(f"{path.stem}-{number}{path.suffix}"), options)
