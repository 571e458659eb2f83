"""Links that hold a whole design: its name and the text of its spec, packed into the address."""

from __future__ import annotations

import base64
import binascii
import zlib
from pathlib import Path

from gearcad.designs.design import require_plain_name
from gearcad.errors import GearcadError, ParameterError
from gearcad.page.workbench import Workbench

__all__ = ["DESIGN", "linked_bench", "pack", "unpack"]

DESIGN = "design"
"""Its name in the address."""

LONGEST = 8000
"""Characters of a link: what browsers, servers and mails let through."""

LARGEST_TEXT = 1 << 18
"""Bytes that a link may unfold to."""

_NO_LINK = "is no link of this page, or not all of it"
_BETWEEN = "\0"


def pack(name: str, text: str) -> str:
    """What stands in the address for a design. Raises ParameterError for a text that no address can hold."""
    packed = base64.urlsafe_b64encode(zlib.compress(f"{name}{_BETWEEN}{text}".encode(), 9)).decode("ascii").rstrip("=")
    if len(packed) > LONGEST:
        raise ParameterError(DESIGN, name, f"must fit into {LONGEST} characters of a link: save it to a file")
    return packed


def unpack(packed: str) -> tuple[str, str]:
    """Name and text of the design in a link. Raises ParameterError for anything else, and for what unfolds to too much."""
    try:
        if len(packed) > LONGEST or not packed.isascii():
            raise ValueError
        opened = zlib.decompressobj()
        content = opened.decompress(base64.b64decode(packed + "=" * (-len(packed) % 4), b"-_", validate=True), LARGEST_TEXT)
        if not opened.eof or opened.unused_data:
            raise ValueError
        name, between, text = content.decode("utf-8").partition(_BETWEEN)
    except (ValueError, binascii.Error, zlib.error) as error:
        raise ParameterError(DESIGN, packed, _NO_LINK) from error
    if not between:
        raise ParameterError(DESIGN, packed, _NO_LINK)
    require_plain_name(name)
    return name, text


def linked_bench(packed: str, text: str, name: str, folder: Path) -> Workbench:
    """A workbench with the design of a link, or with this text where there is none.

    What makes no gear, or is no link at all, is a fault of the text beneath it.
    """
    try:
        linked, of_link = unpack(packed) if packed else (name, text)
        return Workbench(of_link, linked, folder)
    except ParameterError as error:
        bench = Workbench(text, name, folder)
        bench.blame(str(error))
    except GearcadError:
        bench = Workbench(text, name, folder)
        bench.open(of_link, linked)
    return bench
