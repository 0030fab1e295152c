"""`desire run` and `desire check` as they are mostly called, without click, which takes 30 ms to import.

Scripts call them a thousand times. What is not an option written out with a value that fits, a flag or the
name of a file is click's: abbreviations, `--help`, everything that is wrong and must be said so. A test
compares what both make of the same words.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.batch.ending import WrongUsage, guarded
from desire_tui.engine.outputs.formats import FORMATS
from desire_tui.engine.outputs.picture_options import DPI_LEAST, DPI_MOST, inches

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    Reader = Callable[[str], object]

CHECK_FLAGS = {"--json": "as_json", "--sarif": "as_sarif"}
RUN_FLAGS = {
    "--plot": "plot", "--go": "go", "--quiet": "quiet", "--raw": "raw",
    "--allow-shell": "allow_shell", "--allow-write": "allow_write",
}  # fmt: skip
_UNSAID = {
    "jobs": 1, "size": None, "dpi": 150, "style": None, "answers": None, "timeout": None, "backend": "native",
}  # fmt: skip


def obey(words: Sequence[str]) -> int | None:
    """Do what the words after `desire` ask for and return the exit status; None: they are click's to read."""
    read = run_words(words[1:]) if words[0] == "run" else check_words(words[1:])
    if read is None:
        return None
    work = _run if words[0] == "run" else _check
    try:
        return guarded(lambda: work(*read))
    except WrongUsage:
        return None


def run_words(words: Sequence[str]) -> tuple[tuple[str, ...], dict[str, Any]] | None:
    """Return programs and options as click does; None: it would find more in the words, or faults."""
    settings: list[str] = []
    readers: dict[str, tuple[str, Reader]] = {
        "-j": ("jobs", lambda text: _within(int(text), 0)),
        "--jobs": ("jobs", lambda text: _within(int(text), 0)),
        "--size": ("size", _size),
        "--dpi": ("dpi", lambda text: _within(float(text), DPI_LEAST, DPI_MOST)),
        "--style": ("style", lambda text: _one_of(text, "paper", "screen")),
        "--set": ("settings", settings.append),
        "--input": ("answers", str),
        "--timeout": ("timeout", lambda text: _within(float(text), 5e-324)),
        "--backend": ("backend", lambda text: _one_of(text, "native", "reference")),
        **{f"--{known.name}": (known.name, str) for known in FORMATS},
    }
    options: dict[str, Any] = {**_UNSAID, **dict.fromkeys(known.name for known in FORMATS)}
    files = _read(words, RUN_FLAGS, readers, options)
    if files is None:
        return None
    options["settings"] = {}
    if settings:
        from desire_tui.batch.set_option import from_texts

        try:
            options["settings"] = from_texts(settings)
        except ValueError:
            return None
    return files, options


def check_words(words: Sequence[str]) -> tuple[tuple[str, ...], dict[str, Any]] | None:
    """Return programs and options as click does; None: it would find more in the words, or faults."""
    options: dict[str, Any] = {}
    files = _read(words, CHECK_FLAGS, {}, options)
    return None if files is None or all(options.values()) else (files, options)


def _read(
    words: Sequence[str],
    flags: Mapping[str, str],
    readers: Mapping[str, tuple[str, Reader]],
    options: dict[str, Any],
) -> tuple[str, ...] | None:
    """Put what is said into `options`; return the names of files, at least one, or None."""
    options.update(dict.fromkeys(flags.values(), False))
    files: list[str] = []
    rest = iter(words)
    for word in rest:
        name, is_given, value = word.partition("=")
        if word in flags:
            options[flags[word]] = True
        elif word in readers or (is_given and name in readers and name.startswith("--")):
            key, reader = readers[name]
            try:
                options[key] = reader(value if is_given else next(rest))
            except (ValueError, StopIteration):
                return None
        elif word.startswith("-") and word != "-":
            return None
        else:
            files.append(word)
    return tuple(files) or None


def _within(number: float, least: float, most: float = float("inf")) -> float:
    if not least <= number <= most:
        raise ValueError
    return number


def _one_of(text: str, *choices: str) -> str:
    if text not in choices:
        raise ValueError
    return text


def _size(text: str) -> tuple[float, float]:
    size = inches(text)
    if size is None:
        raise ValueError
    return size


def _run(files: Sequence[str], options: dict[str, Any]) -> int:
    from desire_tui.batch.run_programs import run_programs

    return run_programs(files, options)


def _check(files: Sequence[str], options: dict[str, Any]) -> int:
    from desire_tui.batch.check_files import check_files

    return check_files(files, "json" if options["as_json"] else "sarif" if options["as_sarif"] else "text")
