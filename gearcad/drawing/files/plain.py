"""Texts as files can hold them: one line, and as codes of DXF where a letter would be one."""

from __future__ import annotations

import re
import unicodedata

__all__ = ["as_code", "as_read", "one_line"]

_PERCENT = re.compile(r"%(?=%)|(?<=%)%")
_BACKSLASH, _AS_CODE = re.compile(r"\\(?=[UM]\+)", re.IGNORECASE), r"\U+005C"
_REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


def one_line(words: str) -> str:
    """Without control characters: a space for each, and a mark for halves of letters, which no file can hold."""
    return "".join(map(_printable, words))


def as_code(words: str) -> str:
    """A text for an entity of DXF, in which "%%c", "^J", and a backslash with "U+2300" or "M+18140" would be codes.

    >>> as_code("90 %, 50%%c")
    '90 %, 50%%%%%%c'
    """
    words = _BACKSLASH.sub(lambda _: _AS_CODE, one_line(words))
    return _PERCENT.sub("%%%", words).replace("^", "^ ")


def as_read(code: str) -> str:
    """What `as_code` was made of.

    >>> as_read(as_code("90 %, 50%%c ^ <&>"))
    '90 %, 50%%c ^ <&>'
    """
    return code.replace("%%%", "%").replace("^ ", "^").replace(_AS_CODE, "\\")


def _printable(letter: str) -> str:
    kind = unicodedata.category(letter)
    if kind == "Cs":
        return _REPLACEMENT
    return " " if kind in ("Cc", "Zl", "Zp") else letter
