"""One table of everything the desktop can do.

Keys, command palette, command line, help pages and documentation are made from it. `id` is `part.action`:
the method `action` of the app's controller `part` carries it out (see `actions/`).
"""

from __future__ import annotations

from textual.binding import Binding

from desire_tui.analysis.registry import ANALYSES
from desire_tui.engine.data_classes import dataclass


@dataclass(frozen=True, slots=True)
class Command:
    """One action: what it is called, what it does, and the ways to it."""

    id: str
    title: str
    help: str
    keys: str = ""
    """Keys, separated by commas; the first is the one shown."""
    words: tuple[str, ...] = ()
    """First words of a command line that mean this action."""
    argument: str = ""
    """How an argument is written on the command line, empty if there is none."""


COMMANDS = (
    # ------------------------------------------------------------------------------------------------ running
    Command("run.start", "Run", "Accept the front tab, forget all names, compile and run", "f5", ("erun",
            "zz")),
    Command("run.accept", "OK", "Make the front tab the active program without running it", "f2", ("ok",)),
    Command("run.again", "Run again", "Run the active program, keeping irule and scale", "shift+f5",
            ("run",)),
    Command("run.proceed", "Go on", "Continue after STOP, or to the next traced statement", "f10", ("go",)),
    Command("run.pause", "Pause", "Pause the run, or resume it; with text selected, copy it first", "ctrl+c"),
    Command("run.end", "End the run", "End the run or script that goes on or is paused", "shift+f10"),
    Command("run.trace", "Trace", "Single-step through the script; each step is shown in the editor",
            "f12", ("trace",)),
    Command("run.breakpoint", "Breakpoint", "Set or remove a breakpoint on the cursor's line", "f9"),
    Command("run.clear_breakpoints", "Clear breakpoints", "Remove the breakpoints of all tabs"),
    Command("run.live", "Live mode", "Give parameters sliders; moving one re-runs the program", "alt+l",
            ("live",), "name"),
    Command("run.live_overlay", "Live overlay", "Live runs overlay their curves instead of replacing them"),
    Command("run.live_write", "Write sliders", "Write the values of the sliders into the program"),
    Command("run.report", "Run report", "Print what the last run did: steps, calls, DT, why it ended",
            "alt+d"),
    # -------------------------------------------------------------------------------------------------- files
    Command("file.new", "New tab", "Open an empty editor tab", "ctrl+n", ("tab",)),
    Command("file.clear", "New program", "Clear the program: empty tab, no names, scale 1, irule 1",
            words=("new",)),
    Command("file.clear_now", "New program at once", "As new, without asking", words=("NEW",)),
    Command("file.open", "Open", "Open a file in a new tab", "ctrl+o", ("load", "old"), "'file'"),
    Command("file.save", "Save", "Save the front tab over its file", "ctrl+s", ("keep",), "'file'"),
    Command("file.save_numbered", "Save numbered", "Save with line numbers",
            words=("keep+",), argument="'file'"),
    Command("file.save_as", "Save as", "Save the front tab under another name", "ctrl+shift+s"),
    Command("file.reload", "Reload", "Back to the last-saved version", words=("reload", "rld")),
    Command("file.edit_copy", "Edit a copy", "Open a copy of the active program in a new tab", words=("ed",)),
    Command("file.edit_numbered", "Edit numbered", "As ed, with line numbers", words=("edit",)),
    Command("file.close", "Close tab", "Close the front tab; asks where unsaved work would go", "ctrl+w"),
    Command("file.next", "Next tab", "Show the next editor tab", "ctrl+pagedown"),
    Command("file.previous", "Previous tab", "Show the editor tab before", "ctrl+pageup"),
    Command("file.move_left", "Move tab left", "Give the front tab the place of the one before",
            "ctrl+shift+pageup"),
    Command("file.move_right", "Move tab right", "Give the front tab the place of the next",
            "ctrl+shift+pagedown"),
    Command("file.split", "Side by side", "Show two tabs side by side (a single one twice), or one again",
            "ctrl+backslash", ("split",)),
    Command("file.twice", "Second view", "Show the front tab twice side by side, or once again", "alt+v",
            ("twice",)),
    Command("file.external", "External editor", "Edit the front tab in $EDITOR", words=("external",)),
    Command("file.examples", "Examples", "Browse the example programs", "f11", ("examples",)),
    Command("file.quit", "Quit", "Leave Desire; asks where unsaved work would go", "ctrl+q", ("quit",
            "bye")),
    # ------------------------------------------------------------------------------------------------ editing
    Command("edit.find", "Find", "Find text in the front tab", "ctrl+f", ("find",), "text"),
    Command("edit.replace", "Replace", "Find and replace in the front tab", "ctrl+r"),
    Command("edit.find_next", "Find next", "Go to the next place of the text searched", "f3"),
    Command("edit.find_previous", "Find previous", "Go to the place before", "shift+f3"),
    Command("edit.match_case", "Match case", "In a search, tell capitals from small letters", "alt+c"),
    Command("edit.whole_words", "Whole words", "In a search, find whole names and numbers only", "alt+w"),
    Command("edit.expression", "Regular expression", "In a search, take the text as an expression", "alt+x"),
    Command("edit.in_selection", "Search the selection", "In a search, stay inside the lines selected",
            "alt+m"),
    Command("edit.replace_all", "Replace all", "Replace every place of the text searched", "alt+a"),
    Command("edit.goto", "Go to line", "Put the cursor on a line", "ctrl+g", ("line",), "number"),
    Command("edit.comment", "Comment", "Turn the selected lines into comments, or back",
            "ctrl+underscore,ctrl+t"),
    Command("edit.complete", "Complete", "Offer names, functions and statements at the cursor",
            "ctrl+at,ctrl+@,ctrl+space"),
    Command("edit.next_problem", "Next problem", "Go to the next problem in the front tab", "f8"),
    Command("edit.previous_problem", "Previous problem", "Go to the problem before", "shift+f8"),
    Command("edit.fix", "Take the suggestion", "Replace the word at the problem by the one meant", "alt+u"),
    Command("edit.fold", "Fold", "Fold what an example must show at its end, or open it", "alt+z"),
    Command("edit.duplicate", "Duplicate line", "Repeat the cursor's line below it", "ctrl+d"),
    Command("edit.move_up", "Move line up", "Move the selected lines up by one", "alt+shift+up"),
    Command("edit.move_down", "Move line down", "Move the selected lines down by one", "alt+shift+down"),
    Command("edit.indent", "Indent", "Move the selected lines right by a level; Tab does so with several"),
    Command("edit.dedent", "Dedent", "Move the selected lines left by a level", "shift+tab"),
    Command("edit.cut", "Cut", "Cut the selected text, or the line, to the clipboard", "ctrl+x"),
    Command("edit.copy", "Copy", "Copy the selected text, or the line; during a run, too", "ctrl+insert"),
    Command("edit.paste", "Paste", "Insert what was copied or cut", "ctrl+v"),
    Command("edit.undo", "Undo", "Undo the last change", "ctrl+z"),
    Command("edit.redo", "Redo", "Redo what was undone", "ctrl+y"),
    Command("edit.select_all", "Select all", "Select the whole text of the front tab", "ctrl+a"),
    # -------------------------------------------------------------------------------------------------- graph
    Command("graph.full", "Full-screen graph", "The graph alone, or all panes again", "f7", ("full",)),
    Command("graph.zoom_in", "Zoom in", "Magnify the graph around its middle", "alt+equals_sign,alt+plus"),
    Command("graph.zoom_out", "Zoom out", "Show more of the graph", "alt+minus"),
    Command("graph.left", "Pan left", "Move the graph's window left", "alt+left"),
    Command("graph.right", "Pan right", "Move the graph's window right", "alt+right"),
    Command("graph.up", "Pan up", "Move the graph's window up", "alt+up"),
    Command("graph.down", "Pan down", "Move the graph's window down", "alt+down"),
    Command("graph.fit", "Fit", "The scale that holds all curves, during a run too", "shift+f7,alt+f",
            ("fit",)),
    Command("graph.log", "Log axes", "Logarithmic ordinate, then both axes, then neither", words=("logaxis",),
            argument="x"),
    Command("graph.equal", "Equal scales", "The same scale along both axes, so that circles are round"),
    Command("graph.reset", "Program's scale", "Back to the scale the program set", "alt+0"),
    Command("graph.read", "Read-out", "Show a cursor line with the values of all curves", "alt+r"),
    Command("graph.legend", "Colour keys", "Show or hide the colour keys", "alt+k"),
    Command("graph.older", "Older graph", "Page back through the last graphs", "alt+pageup"),
    Command("graph.newer", "Newer graph", "Page forward through the last graphs", "alt+pagedown"),
    Command("graph.snapshot", "Snapshot", "Save the graph as PNG, SVG or PDF", "alt+s",
            ("snapshot",), "'file'"),
    Command("graph.picture", "Show picture", "Show the graph as a picture, as snapshot saves it", "alt+i",
            ("picture",)),
    Command("graph.export", "Export samples", "Save the samples of the last run as CSV",
            words=("export",), argument="'file'"),
    Command("graph.chart", "Plot quantity", "Plot a quantity, or several on one page: an array over its "
            "index, others over the last run, columns of data files as points", "alt+g", ("graph",),
            "name, name"),
    Command("graph.overlay", "Overlay", "Lay an older graph over the one shown, or take it away", "alt+o",
            ("overlay",), "number"),
    # ------------------------------------------------------------------------------------------------ studies
    Command("study.start", "Study", "Run the front tab for many values; charts grow meanwhile",
            words=("study",), argument="--over k=1:10:10 --keep x[end]"),
    Command("study.pause", "Pause the study", "Make no new runs of the study, or go on"),
    Command("study.stop", "Stop the study", "End the study; what was made stays"),
    Command("study.chart", "Chart of the study", "Another chart: fan, curves, histogram, map, scatter …"),
    Command("study.save", "Save the study", "Save what the study kept as NetCDF, CSV or Zarr"),
    # ---------------------------------------------------------------------------------------- after the curve
    *(Command(f"analysis.{one.name}", one.title, one.summary, words=(one.name,), argument=one.example)
      for one in ANALYSES),
    Command("analysis.over", "Continue over its range",
            "Follow steady states and cycles over the range of the parameter in focus: c there"),
    Command("analysis.orbit", "Start an orbit", "In the phase plane shown, from a place; a click does it too",
            words=("orbit",), argument="0.5, 1"),
    Command("analysis.stop", "Stop the analysis", "End the analysis that goes on; what it found stays"),
    Command("analysis.save", "Save results", "Save what the last analysis found: CSV, JSON, PNG, SVG, PDF",
            words=("results",), argument="'file'"),
    # --------------------------------------------------------------------------------------------------- view
    Command("view.next_pane", "Next pane", "Move to the next pane", "f6"),
    Command("view.previous_pane", "Pane before", "Move to the pane before", "shift+f6"),
    Command("view.command_line", "Command line", "Move to the command line", "ctrl+l"),
    Command("view.editor", "Editor", "Move to the editor", "alt+e"),
    Command("view.maximize", "Maximize pane", "The focused pane alone, or all panes again", "f4",
            ("maximize",)),
    Command("view.wider", "Wider pane", "Move the line beside the focused pane outwards", "alt+full_stop"),
    Command("view.narrower", "Narrower pane", "Move the line beside the focused pane inwards", "alt+comma"),
    Command("view.higher", "Higher pane", "Give the focused pane a row of the one above or below it",
            "alt+apostrophe"),
    Command("view.lower", "Lower pane", "Give a row of the focused pane to the one above or below it",
            "alt+semicolon"),
    Command("view.even", "Panes as at first", "Forget where the lines between the panes were moved to"),
    Command("view.jump", "Jump", "Label panes and tabs with letters; the next letter goes there", "alt+j"),
    Command("view.quantities", "Quantities", "Show parameters, states and arrays with their values",
            "alt+q", ("quantities",)),
    Command("view.problems", "Problems", "Show all problems of the programs", "alt+p", ("problems",)),
    Command("view.hide", "Hide side pane", "Hide quantities, problems and help", "alt+h"),
    Command("view.theme", "Theme", "Change to the next theme, or to the named one", "alt+t",
            ("theme",), "name"),
    Command("view.search_output", "Search output", "Search the command pane's output", "alt+y"),
    Command("view.history", "Former commands", "Commands of this and former sessions, to take one again",
            words=("history",)),
    Command("view.copy_output", "Copy output", "Copy the command pane's output to the clipboard"),
    Command("view.copy_graph", "Copy samples", "Copy the last run's samples to the clipboard, tab-separated"),
    Command("view.palette", "Command palette", "All actions, by name", "ctrl+p"),
    # --------------------------------------------------------------------------------------------------- help
    Command("help.word", "Help", "Help on the word at the cursor", "f1", ("help",), "'topic'"),
    Command("help.keys", "Keys", "All keys on a sheet, with a search", "shift+f1", ("keys",)),
    Command("help.tour", "Tour", "Point at one pane after the other; again: the next", "alt+n", ("tour",)),
    Command("help.config", "Configuration", "Open the configuration file in a tab", words=("config",)),
)  # fmt: skip

REFERENCE_WORDS = frozenset(
    {
        "erun", "zz", "run", "go", "ed", "edit", "keep", "keep+", "reload", "rld", "load", "old", "new",
        "NEW", "snapshot", "help", "trace", "bye", "quit",
    }
)  # fmt: skip
"""Words of the language reference; the others give way to a quantity of their name."""
BY_ID = {command.id: command for command in COMMANDS}
BY_WORD = {word: command for command in reversed(COMMANDS) for word in command.words}
"""Of two actions with one word (`fit`, `fit k to x ~ y`) the first in the table."""
COMMAND_LINE_WORDS = tuple((word, command.help) for command in COMMANDS for word in command.words)
"""First words of command lines with a line about each, for completion."""
_ASKED = {one.name: BY_ID[f"analysis.{one.name}"] for one in ANALYSES}


def bindings() -> list[Binding]:
    """Key bindings of the app. They have priority, so that no pane's own key hides an action."""
    return [
        Binding(
            key,
            f"do('{command.id}')",
            command.title,
            id=_binding_id(command.id, number),
            priority=True,
            show=False,
        )
        for command in COMMANDS
        for number, key in enumerate(command.keys.split(","))
        if key
    ]


def binding_ids(command: Command) -> list[str]:
    """Ids under which a command's keys can be remapped."""
    return [_binding_id(command.id, number) for number, _ in enumerate(command.keys.split(","))]


def _binding_id(command_id: str, number: int) -> str:
    return command_id if number == 0 else f"{command_id}.{number}"


def parse_line(line: str) -> tuple[Command, str] | None:
    """Split a command line into an action of the table and its argument; None if it is Desire's own language.

    A word followed by anything but nothing, a quoted text or a plain word is not taken: `run = 3` assigns.
    """
    word, _, rest = line.strip().partition(" ")
    if "'" in word or '"' in word:  # keep'f'
        cut = min(at for at in (word.find("'"), word.find('"')) if at >= 0)
        word, rest = word[:cut], word[cut:] + " " + rest
    command = BY_WORD.get(word)
    rest = rest.strip()
    if command is None or rest[:1] in {"=", "[", "("} or _has_several_statements(line):
        return None
    if rest and not command.argument:
        command = _ASKED.get(word)
        if command is None:
            return None
    if len(rest) >= 2 and rest[0] in "'\"" and rest[-1] == rest[0]:
        rest = rest[1:-1]
    return command, rest


def _has_several_statements(line: str) -> bool:
    if "|" not in line:
        return False
    from desire_tui.engine.syntax.tokens import scan

    return len(scan(line).chunks) > 1
