"""Object files of LLVM's taken apart: the image that is mapped, and the addresses that must be put into it.

LLVM's large code model for x86-64 calls and reads by absolute addresses of 64 bits and nothing else, so one
kind of relocation is enough (System V ABI for x86-64, sections 4.1 to 4.4). Unwinding tables are left out: no
compiled function throws, and nothing throws through one.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from desire_tui.engine.codegen.jit.image import PAGE, Image

_HEADER = struct.Struct("<16sHHIQQQIHHHHHH")
_SECTION = struct.Struct("<IIQQQQIIQQ")
_SYMBOL = struct.Struct("<IBBHQQ")
_RELOCATION = struct.Struct("<QQq")
_ELF64_LITTLE = b"\x7fELF\x02\x01\x01"
_RELOCATABLE, _X86_64 = 1, 62
_SYMBOLS, _RELOCATIONS, _NO_BITS, _X86_64_UNWIND = 2, 4, 8, 0x70000001
_WRITABLE, _ALLOCATED = 1, 2
_UNDEFINED, _RESERVED = 0, 0xFF00
_ABSOLUTE_64 = 1


class UnknownFormError(Exception):
    """The file holds something that only LLVM's own linker knows."""


class _Section(NamedTuple):
    name: int
    kind: int
    flags: int
    address: int
    offset: int
    size: int
    link: int
    info: int
    alignment: int
    entry: int


def image_of(content: bytes) -> Image:
    """Lay an object file out. UnknownFormError."""
    try:
        return _image(content)
    except (struct.error, IndexError, KeyError) as error:
        raise UnknownFormError(str(error)) from error


def _image(content: bytes) -> Image:
    identity, kind, machine, _, _, _, start, *_, count, _ = _HEADER.unpack_from(content)
    if not identity.startswith(_ELF64_LITTLE) or (kind, machine) != (_RELOCATABLE, _X86_64):
        raise UnknownFormError("no object file for x86-64")
    sections = [_Section(*_SECTION.unpack_from(content, start + k * _SECTION.size)) for k in range(count)]
    kept = {
        k: section
        for k, section in enumerate(sections)
        if section.flags & _ALLOCATED and section.kind != _X86_64_UNWIND
    }
    parts, places = [bytearray(), bytearray()], {}
    for k, section in kept.items():
        if section.alignment > PAGE:
            raise UnknownFormError("alignment")
        writable = bool(section.flags & _WRITABLE)
        part = parts[writable]
        part += bytes(-len(part) % max(section.alignment, 1))
        places[k] = writable, len(part)
        end = section.offset + section.size
        part += bytes(section.size) if section.kind == _NO_BITS else content[section.offset : end]
    data_start = -(-len(parts[0]) // PAGE) * PAGE
    base = {k: at + (data_start if writable else 0) for k, (writable, at) in places.items()}
    (table,) = (section for section in sections if section.kind == _SYMBOLS)
    names = sections[table.link].offset
    symbols = list(_SYMBOL.iter_unpack(content[table.offset : table.offset + table.size]))

    def name_of(symbol: int) -> str:
        at = names + symbols[symbol][0]
        return content[at : content.index(b"\0", at)].decode("ascii")

    inside: list[tuple[int, int]] = []
    outside: list[tuple[int, str, int]] = []
    for section in sections:
        if section.kind != _RELOCATIONS or section.info not in base:
            continue
        stored = content[section.offset : section.offset + section.size]
        for offset, how, addend in _RELOCATION.iter_unpack(stored):
            symbol, what = how >> 32, how & 0xFFFFFFFF
            _, _, _, home, value, _ = symbols[symbol]
            if what != _ABSOLUTE_64 or home >= _RESERVED:
                raise UnknownFormError(f"relocation {what}")
            place = base[section.info] + offset
            if home == _UNDEFINED:
                outside.append((place, name_of(symbol), addend))
            else:
                inside.append((place, base[home] + value + addend))
    functions = {
        name_of(k): base[home] + value
        for k, (_, info, _, home, value, _) in enumerate(symbols)
        if info >> 4 and home in base
    }
    return Image(bytes(parts[0]), bytes(parts[1]), functions, tuple(inside), tuple(outside))
