"""The tokenizer: the one lexical truth for the parser, the statement splitter and the editor's highlighting.

Language.md section 2. It knows what only a reader of whole statements can know: a keyword is a keyword at a
statement's start alone, and `then`, `to`, `step` … are special only where their own statement expects an operator.
A token's kind is its own text for operators and keywords (aliases replaced), or one of the classes below.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from desire_tui.engine.syntax.words import CLOSERS, KEYWORDS, OPENERS, RAW_AFTER, SOFT_WORDS, STAND_ALONE

NAME, NUMBER, OCTAL, STRING, RAW, LETTER, MATFUN = "NAME", "NUMBER", "OCTAL", "STRING", "RAW", "LETTER", "MATFUN"
CLASSES = frozenset({NAME, NUMBER, OCTAL, STRING, RAW, LETTER, MATFUN})

LINE_MAX = 1_000_000
"""Characters in one line, continuations included."""
DEPTH_MAX = 100
"""Open brackets; every later pass may recurse once or twice for each."""

_CONTINUES = frozenset("+*/^=-")
_OPERAND_END = frozenset({NAME, NUMBER, OCTAL, STRING, LETTER, ")", "]", "}", "%", "#"})
_ASKING = frozenset({"if", "while", "until"})
_OPEN = frozenset(OPENERS.values())

_TOKEN = re.compile(
    r"""(?:[ \t\r\n\f\v]|_[ \t\r]*(?:\n|\Z))*(?:
      ([A-Za-z](?:[A-Za-z0-9$]|_(?![ \t\r]*(?:\n|\Z)))*)              # 1 name or keyword
    | ((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?(?![0-9A-Za-z.$_]))  # 2 number
    | (--[^\n]*|—[^\n]*)                                             # 3 comment
    | (<=|>=|<>|\#\#|%%|[-+*/^=<>()\[\]{},;%\#])                       # 4 operator or bracket
    | (\|)                                                            # 5 end of the statement
    | ('[^'\n]*'|"[^"\n]*")                                           # 6 string
    | (\$(?:In|Tr)(?=[ \t]*\()|\$)                                     # 7 $In(A), $Tr(A); $ of write
    | (&&?[0-9A-Za-z]*)                                              # 8 octal, hexadecimal, minimum
    | (['"][^\n]*)                                                    # 9 a quote nobody closed
    | (\.?[0-9][A-Za-z0-9.$_]*|\.)                                     # 10 not a number, perhaps
    | (.)                                                             # 11 nothing we know
    )?""",
    re.VERBOSE,
)
_OCTAL = re.compile(r"&[0-7]+\Z|&&[0-9A-Fa-f]+\Z")
_NUMBER_START = re.compile(r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_SECOND_WORD = {
    "go": re.compile(r"[ \t]+(to)(?![A-Za-z0-9$_])"),
    "end": re.compile(r"[ \t]+(if|while)(?![A-Za-z0-9$_])"),
}
_D_DT = re.compile(r"[ \t]*(d/dt)(?![A-Za-z0-9$_])")
_WAY = re.compile(r"[ \t]*(input|output)(?![A-Za-z0-9$_])")
_DELTA = re.compile(r"[ \t]*(delta)(?=[ \t]+[A-Za-z])")
_ASSIGNED = re.compile(r"[ \t]*=")
_SUBSCRIPTED = re.compile(r"[ \t]*\[")
_BRACKETS = re.compile(r"[\[\]|\n]")
_MODE = re.compile(r"[ \t]*(?:([ABCFNQRWY])(?![A-Za-z$_\[(])|([012])(?=[ \t\r]*(?:\n|\||--|\Z|else|proceed)))")
_FFT_KIND = re.compile(r"[ \t]*([FIRC])(?=[ \t]*[,;])")
_REST = re.compile(r"[ \t]*((?:'[^'\n]*'|\"[^\"\n]*\"|(?!--|—)[^|\n'\"])*)")
_OPERAND_FOLLOWS = re.compile(r"[ \t]*[A-Za-z0-9.(&]")


@dataclass(slots=True)
class Chunk:
    """The tokens of one statement; positions count from its first token, which stands at `base` of the line."""

    base: int
    kinds: list[str] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)
    starts: list[int] = field(default_factory=list)
    ends: list[int] = field(default_factory=list)
    fault: Fault | None = None

    def add(self, kind: str, text: str, start: int, end: int) -> None:
        """Append a token that stands at `start` … `end` of the line."""
        self.kinds.append(kind)
        self.texts.append(text)
        self.starts.append(start - self.base)
        self.ends.append(end - self.base)


@dataclass(frozen=True, slots=True)
class Fault:
    """Something wrong in a statement: wording key, place counted from the statement's start, facts."""

    key: str
    start: int
    end: int
    facts: dict[str, object] = field(default_factory=dict)


@dataclass(slots=True)
class Line:
    """A logical line: its statements, its comments' places, and whether it goes on in the next line."""

    chunks: list[Chunk]
    comments: list[tuple[int, int]]
    continues: bool


def scan(text: str) -> Line:
    """Split a line (continuation lines included) into the tokens of its statements. Never raises."""
    if not text.isascii():
        text = normalised(text)
    chunks: list[Chunk] = []
    comments: list[tuple[int, int]] = []
    match = _TOKEN.match
    pos, words, in_if, depth, base = 0, None, False, 0, 0
    chunk: Chunk | None = None
    # The open chunk's lists, in local names: this loop is the hot one of a cold start, and calls would double it.
    kinds: list[str]
    texts: list[str]
    starts: list[int]
    ends: list[int]
    if len(text) > LINE_MAX:
        chunks.append(Chunk(0, fault=Fault("line-too-long", 0, 1, {"limit": LINE_MAX})))
        return Line(chunks, comments, continues=False)
    while True:
        found = match(text, pos)
        assert found is not None
        group = found.lastindex
        if group is None:
            break
        start, pos = found.span(group)
        token = found[group]
        if group == 3:
            comments.append((start, pos))
            continue
        if group == 5:
            chunk, words, depth = None, None, 0
            continue
        if chunk is None:
            chunk = Chunk(start)
            chunks.append(chunk)
            base, kinds, texts, starts, ends = start, chunk.kinds, chunk.texts, chunk.starts, chunk.ends
            if group == 1:
                kind = KEYWORDS.get(token)
                pos = _start(chunk, text, token, kind, start, pos)
                word = chunk.kinds[0]
                words = SOFT_WORDS.get(word)
                if word in ("else", "proceed"):
                    chunk = None
                continue
        if group == 1:
            if words is not None and token in words and _is_soft(chunk, token, text, pos):
                chunk.add(token, token, start, pos)
                if token == "then":
                    chunk, words, depth, in_if = None, None, 0, True
                elif token == "as" and (way := _WAY.match(text, pos)):
                    pos = way.end()
                    chunk.add(way[1], way[1], way.start(1), pos)
                continue
            if in_if and token in ("else", "proceed") and _is_over(chunk):
                chunk, words, depth = Chunk(start, [token], [token], [0], [pos - start]), None, 0
                chunks.append(chunk)
                chunk = None
                continue
            kinds.append(NAME)
            texts.append(token)
            starts.append(start - base)
            ends.append(pos - base)
        elif group == 2:
            kinds.append(NUMBER)
            texts.append(token)
            starts.append(start - base)
            ends.append(pos - base)
        elif group == 4:
            kinds.append(token)
            texts.append(token)
            starts.append(start - base)
            ends.append(pos - base)
            if token in _OPEN:
                depth += 1
                if depth > DEPTH_MAX and chunk.fault is None:
                    chunk.fault = Fault("nested-too-deep", start - base, pos - base, {"limit": DEPTH_MAX})
            elif token in CLOSERS:
                depth -= 1
        elif group == 6:
            chunk.add(STRING, token, start, pos)
        elif group == 7:
            chunk.add(MATFUN if len(token) > 1 else "$", token, start, pos)
        else:
            pos = _odd(chunk, group, token, start)
    continues = bool(chunk and _wants_more(chunk)) or text[comments[-1][1] if comments else 0 :].rstrip().endswith("_")
    return Line(chunks, comments, continues)


def _start(chunk: Chunk, text: str, token: str, kind: str | None, start: int, pos: int) -> int:
    """Add the first word of a statement, and with it all that only this keyword allows; return where to go on."""
    if token == "d" and (found := _D_DT.match(text, start)):
        chunk.add("d/dt", "d/dt", start, found.end())
        return found.end()
    if kind is None or _is_variable(text, token, pos):
        chunk.add(NAME, token, start, pos)
        return pos
    second = _SECOND_WORD.get(token)
    if second and (found := second.match(text, pos)):
        kind, pos = f"{token} {found[1]}", found.end()
    elif token in ("list", "keep") and text.startswith("+", pos):
        kind, pos = f"{token}+", pos + 1
    chunk.add(kind, text[start:pos], start, pos)
    if kind in RAW_AFTER:
        return _rest(chunk, text, pos)
    if kind in ("Vector", "MATRIX"):
        found = _D_DT.match(text, pos) or (_DELTA.match(text, pos) if kind == "Vector" else None)
        if found:
            chunk.add(found[1], found[1], found.start(1), found.end())
            return found.end()
    elif kind == "display":
        if found := _MODE.match(text, pos):
            group = found.lastindex or 0
            chunk.add(LETTER, found[group], found.start(group), found.end(group))
            return found.end(group)
    elif kind == "FFT":
        if found := _FFT_KIND.match(text, pos):
            chunk.add(LETTER, found[1], found.start(1), found.end(1))
            return found.end(1)
    elif kind == "dump" and (found := re.compile(r"[ \t]+(run)(?![A-Za-z0-9$_])").match(text, pos)):
        chunk.add("run", "run", found.start(1), found.end())
        return found.end()
    return pos


def _is_variable(text: str, token: str, pos: int) -> bool:
    """Whether the keyword that ends at `pos` is assigned like a variable: `input = 0`, `data[3] = 1`."""
    if _ASSIGNED.match(text, pos):
        return True
    if token in _ASKING and not text.startswith("[", pos):
        return False  # `if [a, b] = z then` compares complex numbers
    found = _SUBSCRIPTED.match(text, pos)
    if not found:
        return False
    depth = 1
    for bracket in _BRACKETS.finditer(text, found.end()):
        mark = bracket[0]
        depth += 1 if mark == "[" else -1 if mark == "]" else 0
        if depth == 0:
            return _ASSIGNED.match(text, bracket.end()) is not None
        if mark in "|\n":
            break
    return False


def _rest(chunk: Chunk, text: str, pos: int) -> int:
    """Add the rest of the statement as one token, a string if it is one."""
    found = _REST.match(text, pos)
    assert found is not None
    rest = found[1].rstrip()
    if rest:
        start = found.start(1)
        whole = rest[0] in "'\"" and rest.find(rest[0], 1) == len(rest) - 1
        chunk.add(STRING if whole else RAW, rest, start, start + len(rest))
    return found.end()


def _is_soft(chunk: Chunk, token: str, text: str, pos: int) -> bool:
    """Whether a special word stands where its statement expects one (else it is a variable's name)."""
    last = chunk.kinds[-1]
    if token == "not":
        return last not in _OPERAND_END and bool(_OPERAND_FOLLOWS.match(text, pos))
    return last in _OPERAND_END


def _is_over(chunk: Chunk) -> bool:
    """Whether the statement could end before `else` or `proceed` behind a `then`."""
    kinds = chunk.kinds
    return kinds[-1] in _OPERAND_END or (len(kinds) == 1 and kinds[0] in STAND_ALONE)


def _wants_more(chunk: Chunk) -> bool:
    kinds = chunk.kinds
    return bool(kinds) and kinds[-1] in _CONTINUES


def _odd(chunk: Chunk, group: int, token: str, start: int) -> int:
    """Add what is rare or wrong; return where to go on."""
    base, end = chunk.base, start + len(token)
    fault = None
    if group == 8:
        if token == "&":
            chunk.add("&", token, start, end)
        elif _OCTAL.match(token) and octal_in_range(token):
            chunk.add(OCTAL, token, start, end)
        elif token[1].isalpha():
            end = start + 1
            chunk.add("&", "&", start, end)
        else:
            size = _OCTAL.match(token) is not None
            key = "octal-too-large" if size else "octal-digits"
            fault = Fault(key, start - base, end - base, {"text": token})
            chunk.add(OCTAL, "&0", start, end)
    elif group == 9:
        fault = Fault("quote-unclosed", start - base, end - base, {"quote": token[0]})
        chunk.add(STRING, token + token[0], start, end)
    elif group == 10:
        good = _NUMBER_START.match(token)
        if good is not None and token[good.end()] not in ".$_" and not re.match(r"[eE](?![A-Za-z])", token[good.end() :]):
            end = start + good.end()
            chunk.add(NUMBER, good[0], start, end)
        else:
            fault = Fault("number-format", start - base, end - base, {"text": token})
            chunk.add(NUMBER, "0", start, end)
    else:
        fault = Fault("strange-character", start - base, end - base, {"char": token})
    if chunk.fault is None:
        chunk.fault = fault
    return end


def octal_in_range(token: str) -> bool:
    """Whether an `&` or `&&` literal fits into 16 bits."""
    return _digits(token) <= 0xFFFF


def octal_value(token: str) -> float:
    """Value of `&17370` (octal) or `&&FC2` (hexadecimal): 16 bits, two's complement [B 8.3.2]."""
    bits = _digits(token)
    return float(bits - 0x10000 if bits > 0x7FFF else bits)


def _digits(token: str) -> int:
    return int(token[2:], 16) if token.startswith("&&") else int(token[1:], 8)


_ASCII = {
    "\u2018": "'", "\u2019": "'", "\u201a": "'", "\u201b": "'", "\u201c": '"', "\u201d": '"', "\u201e": '"',
    "\u2010": "-", "\u2011": "-", "\u2012": "-", "\u2013": "-", "\u2212": "-", "\u00a0": " ", "\u2007": " ",
    "\u202f": " ", "\u2009": " ", "\u2002": " ", "\u2003": " ", "\ufeff": " ", "\u2028": " ", "\u00d7": "*",
}  # fmt: skip


def normalised(text: str) -> str:
    """Pasted typographic characters as ASCII, one for one so that offsets stay; strings' insides are left alone."""
    out: list[str] = []
    closing = ""
    comment = False
    for char in text:
        plain = _ASCII.get(char, char)
        if comment:
            comment = char != "\n"
            out.append(char)
        elif closing:
            ends = char in closing or char == "\n"
            out.append(plain if ends else char)
            if ends:
                closing = ""
        else:
            if plain in "'\"":
                # An ASCII quote is closed by itself; a typographic one by any of its kind.
                closing = char if char == plain else "".join(c for c, p in _ASCII.items() if p == plain) + plain
            elif plain == "-" and out and out[-1] == "-":
                comment = True
            out.append(plain)
    return "".join(out)
