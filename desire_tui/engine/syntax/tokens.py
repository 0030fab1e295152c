"""The tokenizer: the one lexical truth for the parser, the statement splitter and the editor's highlighting.

language.md section 2. It knows what only a reader of whole statements can know: a keyword is a keyword at a
statement's start alone, and `then`, `to`, `step` … are special only where their own statement expects an
operator.
"""

from __future__ import annotations

import re

from desire_tui.engine.syntax.heads import add_head
from desire_tui.engine.syntax.joined_rows import joints
from desire_tui.engine.syntax.literals import add_odd, is_prime, too_large
from desire_tui.engine.syntax.statement_tokens import (
    MATFUN,
    NAME,
    NUMBER,
    OCTAL,
    OPERAND_END,
    PRIME,
    STRING,
    LogicalLine,
    StatementTokens,
    TokenFault,
)
from desire_tui.engine.syntax.typography import normalised
from desire_tui.engine.syntax.words import CLOSERS, OPENERS, SOFT_WORDS, STAND_ALONE

LINE_MAX = 1_000_000
"""Characters in one line, continuations included."""
DEPTH_MAX = 100
"""Open brackets; every later pass may recurse once or twice for each."""

INFINITE_MIN = len("1e309")
"""Shorter numbers are finite."""

CONTINUES = frozenset("+*/^=-_")
"""What a row ends with that goes on in the next one."""
_STARRED = frozenset({"drun", "drunr", "SHOW"})
"""Statements that may end in `*`."""
_OPEN = frozenset(OPENERS.values())
_LOGICAL = frozenset({"and", "or", "not"})
_OPERAND_STARTS = frozenset({NAME, NUMBER, OCTAL, "("})
_SIGNS = frozenset("+-")
_RELATIONS = frozenset({"<", ">", "=", "<=", ">=", "<>"})

# \x1a, Ctrl-Z, is what DOS ended a file with: a blank.
_TOKEN = re.compile(
    r"""(?:[ \t\r\n\f\v\x1a]|_[ \t\r]*\Z)*(?:
      ([A-Za-z](?:[A-Za-z0-9$]|_(?![ \t\r]*\Z))*)                     # 1 name or keyword
    | ((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?(?![0-9A-Za-z.$_]))  # 2 number
    | (--[^\n]*|—[^\n]*)                                             # 3 comment
    | (<=|>=|<>|\#\#|%%|[-+*/^=<>()\[\]{},;%\#])                       # 4 operator or bracket
    | (\|)                                                            # 5 end of the statement
    | ('[^'\n]*'|"[^"\n]*")                                           # 6 string
    | (\$(?:In|Tr)(?=[ \t]*\()|\$)                                     # 7 $In(A), $Tr(A); $ of write
    | (&&?[0-9A-Za-z]*)                                              # 8 octal, hexadecimal, minimum
    | (['"][^\n]*)                                                    # 9 a quote nobody closed
    | (\.?[0-9][A-Za-z0-9.$_]*|\.)                                     # 10 not a number, perhaps
    | (!=|:=|.)                                                       # 11 nothing we know
    )?""",
    re.VERBOSE,
)
_WAY = re.compile(r"[ \t]*(input|output)(?![A-Za-z0-9$_])")
_OPERAND_FOLLOWS = re.compile(r"[ \t]*[A-Za-z0-9.(&]")


def scan(text: str) -> LogicalLine:
    """Split a line (continuation lines included) into the tokens of its statements. Never raises."""
    written = text
    if not text.isascii():
        text = normalised(text)
    if "\n" in text and "_" in text and (joined := joints(text)) is not None:
        return joined.replace_offsets(scan(joined.text))
    chunks: list[StatementTokens] = []
    comments: list[tuple[int, int]] = []
    match = _TOKEN.match
    pos, words, in_if, depth, base = 0, None, False, 0, 0
    open_string = ""
    chunk: StatementTokens | None = None
    # The open chunk's lists in local names: this is the hot loop of a cold start, and calls would double it.
    kinds: list[str]
    texts: list[str]
    starts: list[int]
    ends: list[int]
    if len(text) > LINE_MAX:
        chunks.append(StatementTokens(0, fault=TokenFault("line-too-long", 0, 1, {"limit": LINE_MAX})))
        return LogicalLine(chunks, comments, continues="")
    while True:
        found = match(text, pos)
        assert found is not None
        group = found.lastindex
        if group is None:
            break
        start, pos = found.span(group)
        lexeme = found[group]
        if group == 3:
            comments.append((start, pos))
            continue
        if group == 5:
            chunk, words, depth = None, None, 0
            continue
        if chunk is None:
            chunk = StatementTokens(start)
            chunks.append(chunk)
            base, kinds, texts, starts, ends = start, chunk.kinds, chunk.texts, chunk.starts, chunk.ends
            if group == 1:
                pos = add_head(chunk, text, lexeme, start, pos)
                word = chunk.kinds[0]
                words = SOFT_WORDS.get(word)
                if word in ("else", "proceed"):
                    chunk = None
                continue
        if group == 1:
            if words is not None and lexeme in words and _is_soft(chunk, lexeme, text, pos):
                chunk.add(lexeme, lexeme, start, pos)
                if lexeme == "then":
                    chunk, words, depth, in_if = None, None, 0, True
                elif lexeme == "as" and (way := _WAY.match(text, pos)):
                    pos = way.end()
                    chunk.add(way[1], way[1], way.start(1), pos)
                continue
            if in_if and lexeme in ("else", "proceed") and _is_over(chunk):
                chunks.append(StatementTokens(start))
                chunks[-1].add(lexeme, lexeme, start, pos)
                chunk, words, depth = None, None, 0
                continue
            kinds.append(NAME)
            texts.append(lexeme)
            starts.append(start - base)
            ends.append(pos - base)
        elif group == 2:
            if len(lexeme) >= INFINITE_MIN and too_large(lexeme):
                chunk.fault = chunk.fault or TokenFault("number-too-large", start - base, pos - base)
            kinds.append(NUMBER)
            texts.append(lexeme)
            starts.append(start - base)
            ends.append(pos - base)
        elif group == 4:
            kinds.append(lexeme)
            texts.append(lexeme)
            starts.append(start - base)
            ends.append(pos - base)
            if lexeme in _OPEN:
                depth += 1
                if depth > DEPTH_MAX and chunk.fault is None:
                    chunk.fault = TokenFault(
                        "nested-too-deep", start - base, pos - base, {"limit": DEPTH_MAX}
                    )
            elif lexeme in CLOSERS:
                depth -= 1
        elif group in {6, 9} and is_prime(chunk, text, start):
            pos = start + 1
            chunk.add(PRIME, PRIME, start, pos)
        elif group == 6:
            chunk.add(STRING, lexeme, start, pos)
        elif group == 7:
            chunk.add(MATFUN if len(lexeme) > 1 else "$", lexeme, start, pos)
        else:
            pos = add_odd(chunk, group, lexeme, start)
            open_string = written[start] if group == 9 and pos == len(text) else ""
    code_from = comments[-1][1] if comments else 0
    if text[code_from:].rstrip().endswith("_"):
        continues = open_string or "_"
    else:
        continues = kinds[-1] if chunk and _wants_more(chunk) else ""
    if "not" in text:
        for chunk in chunks:
            _mark_negations(chunk)
    return LogicalLine(chunks, comments, continues=continues)


def mark_logical_words(chunk: StatementTokens) -> bool:
    """Take `and`, `or` and `not` for what they are in an expression, `(t > 1 and t < 2)*x`; False: none is.

    Asked where a statement cannot be read: in no other do these words stand where an operator could. A sign
    may follow, `(t > 1 or -x > 0)`; behind `not` where an `and` or `or` stands before it: else a variable of
    that name may be subtracted from, but see `_mark_negations`.
    """
    kinds, found = chunk.kinds, False
    for at, text in enumerate(chunk.texts):
        if kinds[at] == NAME and text in _LOGICAL and 0 < at < len(kinds) - 1:
            before, behind = kinds[at - 1], kinds[at + 1]
            is_plain = text != "not" or before in _LOGICAL
            follows = behind in _OPERAND_STARTS or (is_plain and behind in _SIGNS)
            if follows and (before in OPERAND_END) == (text != "not"):
                kinds[at] = text
                found = True
    return found


def _mark_negations(chunk: StatementTokens) -> None:
    """Take `not` for the word where it begins a relation in parentheses with a sign, `(not -x > 0)`.

    Programs that call a variable so have no such values: relations are conditions of `if` there.
    """
    kinds = chunk.kinds
    for at in range(1, len(kinds) - 1):
        is_name = kinds[at] == NAME and chunk.texts[at] == "not"
        if is_name and kinds[at - 1] == "(" and kinds[at + 1] in _SIGNS:
            depth = 1
            for kind in kinds[at + 1 :]:
                depth += (kind in _OPEN) - (kind in CLOSERS)
                if depth == 1 and kind in _RELATIONS:
                    kinds[at] = "not"
                if depth == 0 or kinds[at] == "not":
                    break


def _is_soft(chunk: StatementTokens, lexeme: str, text: str, pos: int) -> bool:
    """Whether a special word stands where its statement expects one (else it is a variable's name)."""
    last = chunk.kinds[-1]
    if lexeme == "not":
        return last not in OPERAND_END and bool(_OPERAND_FOLLOWS.match(text, pos))
    return last in OPERAND_END


def _is_over(chunk: StatementTokens) -> bool:
    """Whether the statement could end before `else` or `proceed` behind a `then`."""
    kinds = chunk.kinds
    if not kinds:
        return True  # nothing but a strange character
    return kinds[-1] in OPERAND_END or (len(kinds) == 1 and kinds[0] in STAND_ALONE)


def _wants_more(chunk: StatementTokens) -> bool:
    kinds = chunk.kinds
    return bool(kinds) and kinds[-1] in CONTINUES and not (kinds[-1] == "*" and kinds[0] in _STARRED)
