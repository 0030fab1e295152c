"""The language's words: keywords with their other spellings, and words special in one statement only."""

from __future__ import annotations

from desire_tui.engine.diagnostics import closest

KEYWORDS = {
    word: word
    for word in """
    if for while until repeat next exit label PROCEDURE call end SUBMODEL FUNCTION data read restore input
    write connect disconnect dump time note sh help irule SEED trace drun drunr reset clear STOP go MATRIX
    DELTA Vector Delta DOT AVG FFT display plot SHOW edit ed list keep load else proceed DYNAMIC OUT SAMPLE
    step term dispt dispxy DISPXY type stash recover CLEARN PLEARN INTP JACOBIAN store get tdelay delay
    trkhld func func2 invoke ARRAY STATE INTEGER COMPLEX erun run bye new NEW reload snapshot notebook
    compare auto title xlabel ylabel units event every fast
    """.split()  # noqa: SIM905 - a list of words reads better than a wall of quotes
} | {
    "dimension": "ARRAY", "LEARN": "DELTA", "zz": "erun", "rld": "reload", "MACRO": "SUBMODEL", "quit": "bye",
    "VECTOR": "Vector", "Vectr": "Vector", "VECTR": "Vector", "MAT": "MATRIX", "Mat": "MATRIX",
    "Matrix": "MATRIX", "delta": "Delta", "UPDATE": "Delta", "old": "load",
}  # fmt: skip
"""Each keyword with its kind: itself, or the word that it is another spelling of."""

SOFT_WORDS: dict[str, frozenset[str]] = {
    "if": frozenset({"then", "and", "or", "not"}),
    "while": frozenset({"and", "or", "not"}),
    "until": frozenset({"and", "or", "not"}),
    "for": frozenset({"to", "step"}),
    "connect": frozenset({"as"}),
}
"""Words that are special inside one kind of statement, where an operator is expected."""

RAW_AFTER = frozenset({"sh", "help", "keep", "keep+", "load", "snapshot", "notebook", "compare"})
"""Commands that take the rest of their statement as it stands."""

STAND_ALONE = frozenset(
    """
    exit STOP go reset clear time trace next repeat end write drun drunr irule restore dump note erun run
    bye new NEW reload list ed edit auto SHOW
    """.split()  # noqa: SIM905 - as above
) | {"list+", "end while"}
"""Words that can be a whole statement: behind a `then`, `else` and `proceed` may follow them directly."""

RELATIONS = frozenset({"=", "<", ">", "<=", ">=", "<>"})
OPENERS = {")": "(", "]": "[", "}": "{"}
"""Each closing bracket with its opening one."""
CLOSERS = frozenset(OPENERS)

_TWO_WORDS = ("go to", "end if", "end while", "end event", "d/dt", "Vectr d/dt", "Vectr delta")
_ELSEWHERE = {
    "print": "write", "echo": "write", "goto": "go to", "dim": "dimension", "wend": "end while",
    "endwhile": "end while", "done": "end while", "return": "exit", "break": "exit", "endif": "end if",
    "fi": "proceed", "stop": "STOP", "def": "FUNCTION", "sub": "PROCEDURE", "exec": "call", "gosub": "call",
    "rem": "--",
}  # fmt: skip
"""What users of other languages type."""


def keyword_like(text: str) -> str | None:
    """Return the keyword that was probably meant, or None."""
    folded = text.casefold()
    if folded in _ELSEWHERE:
        return _ELSEWHERE[folded]
    candidates = (*KEYWORDS, *_TWO_WORDS)
    same = [word for word in candidates if word.casefold() == folded]
    if same:
        return same[0]
    stem = text.rstrip("0123456789")
    if stem in KEYWORDS and stem != text:
        return f"{stem} {text[len(stem) :]}"
    return closest(text, candidates)
