"""Colours for editors before the language server answers, made from the language's own tables of words.

A TextMate grammar (VS Code, Sublime Text, GitHub) and a Vim syntax file. Regular expressions cannot know what
the tokenizer knows: where the two disagree, the server's colours hold.
"""

from __future__ import annotations

import json

from desire_tui.engine.library import LIBRARY
from desire_tui.engine.syntax.words import KEYWORDS
from desire_tui.engine.values import SYSTEM_VARIABLES

_SMALL = ("then", "to", "step", "and", "or", "not", "as")
_TWO = (r"go\s+to", r"end\s+(?:if|while|event)", r"Vectr?\w*\s+(?:d/dt|delta)", "d/dt", "list\\+", "keep\\+")
_BEGIN = r"(?:^|(?<=\|)|(?<=\bthen)|(?<=\belse)|(?<=\bproceed))"
"""Where a statement begins."""
_NUMBER = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"


def _words() -> list[str]:
    return sorted(KEYWORDS, key=lambda word: (-len(word), word))


def textmate() -> str:
    """Return the TextMate grammar as JSON."""
    keywords = "|".join((*_TWO, *_words()))
    functions = "|".join(sorted(LIBRARY, key=lambda name: (-len(name), name)))
    end = r"(?![A-Za-z0-9$_])"
    grammar = {
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "name": "Desire",
        "scopeName": "source.desire",
        "comment": "made by python -m docs.generate from the tables of words; edit docs/editor_grammars.py",
        "patterns": [
            {"name": "comment.line.double-dash.desire", "match": "(?:--|\u2014).*$"},
            {"name": "string.quoted.single.desire", "match": "'[^']*'"},
            {"name": "string.quoted.double.desire", "match": '"[^"]*"'},
            {
                "match": rf"{_BEGIN}\s*([0-9]+(?=\s))?\s*({keywords}){end}(?!\s*=)",
                "captures": {
                    "1": {"name": "comment.line-number.desire"},
                    "2": {"name": "keyword.control.desire"},
                },
            },
            {
                "name": "keyword.operator.word.desire",
                "match": rf"(?<![A-Za-z0-9$_])(?:{'|'.join(_SMALL)}){end}",
            },
            {"name": "support.function.desire", "match": rf"(?<![A-Za-z0-9$_])(?:{functions})(?=\s*\()"},
            {
                "name": "support.variable.desire",
                "match": rf"(?<![A-Za-z0-9$_])(?:{'|'.join(SYSTEM_VARIABLES)}){end}",
            },
            {
                "name": "constant.numeric.desire",
                "match": rf"(?<![A-Za-z0-9$_.])(?:&&?[0-9A-Fa-f]+|{_NUMBER}){end}",
            },
            {"name": "variable.other.desire", "match": "[A-Za-z][A-Za-z0-9$_]*"},
            {"name": "keyword.operator.desire", "match": "<=|>=|<>|[-+*/^=<>&%#|]"},
        ],
    }
    return json.dumps(grammar, indent=2, ensure_ascii=False) + "\n"


def vim() -> str:
    """Return the Vim syntax file."""
    begin = r"\%(^\s*\%(\d\+\s\)\?\s*\||\s*\|\<then\s\+\|\<else\s\+\)\@<="
    keywords = r"\|".join(("go\\s\\+to", "end\\s\\+\\%(if\\|while\\|event\\)", "d/dt", *_words()))
    functions = r"\|".join(sorted(LIBRARY))
    return "\n".join((
        '" made by python -m docs.generate from the tables of words; edit docs/editor_grammars.py',
        'if exists("b:current_syntax") | finish | endif',
        "syntax case match",
        "syntax iskeyword @,48-57,_,$",
        r"syntax match desireOperator '[-+*/^=<>&%#|]'",
        r"syntax match desireNumber '\<&&\?\x\+\>'",
        r"syntax match desireNumber '\<\d\+\.\?\d*\%([eE][+-]\?\d\+\)\?\>'",
        r"syntax match desireNumber '\.\d\+\%([eE][+-]\?\d\+\)\?\>'",
        f"syntax keyword desireSystem {' '.join(SYSTEM_VARIABLES)}",
        f"syntax keyword desireWord {' '.join(_SMALL)}",
        rf"syntax match desireFunction '\<\%({functions}\)\ze\s*('",
        rf"syntax match desireKeyword '{begin}\%({keywords}\)\>\%(\s*=\)\@!'",
        "syntax region desireString start=+'+ end=+'+ oneline",
        'syntax region desireString start=+"+ end=+"+ oneline',
        r"syntax match desireComment '\%(--\|—\).*$'",
        "highlight default link desireOperator Operator",
        "highlight default link desireNumber Number",
        "highlight default link desireSystem Identifier",
        "highlight default link desireWord Keyword",
        "highlight default link desireFunction Function",
        "highlight default link desireKeyword Statement",
        "highlight default link desireString String",
        "highlight default link desireComment Comment",
        "let b:current_syntax = 'desire'",
        "",
    ))  # fmt: skip
