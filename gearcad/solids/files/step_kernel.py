"""STEP by the CAD kernel's writer, of what was gone on with in CadQuery: any names, equal bytes for equal input."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from itertools import count
from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING

from gearcad.errors import SolverError
from gearcad.solids.files import part21
from gearcad.solids.files.xcaf import assembly_document, part_document

if TYPE_CHECKING:
    import cadquery

__all__ = ["write_by_kernel"]

_HEADER = re.compile(rb"HEADER;.*?ENDSEC;\n", re.DOTALL)
_TOKEN = re.compile(rb"'gearcad-name-(\d+)'")
_OCCURRENCE = re.compile(rb"^(#\d+ = NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'\d+'([^;]*;)", re.MULTILINE)
_LINE_BREAK = re.compile(rb"\n *")
_COLOUR_BLOCK = re.compile(
    rb"^#(\d+) = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION\([^;]*;"
    rb"\s*#\d+ = STYLED_ITEM\('color',\([^)]*\),#(\d+)\);"
    rb".*?(?=^#\d+ = MECHANICAL_DESIGN|^ENDSEC)",
    re.DOTALL | re.MULTILINE,
)
_REFERENCE = re.compile(rb"#\d+")
_ENTITY = re.compile(rb"^(#\d+) = ", re.MULTILINE)

_kernel = RLock()
"""Held while the kernel's global settings are changed."""


def write_by_kernel(model: cadquery.Assembly | cadquery.Shape, path: Path | str, name: str) -> None:
    """Write a shape, as one part called `name`, or an assembly, which has names of its own.

    Running numbers are fixed, and the header. Raises what `write_step` raises.
    """
    import cadquery
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.STEPCAFControl import STEPCAFControl_Writer
    from OCP.STEPControl import STEPControl_StepModelType

    names = _Names()
    with _settings():
        writer = STEPCAFControl_Writer()
        writer.SetColorMode(True)
        writer.SetNameMode(True)
        assembled = isinstance(model, cadquery.Assembly)
        document = assembly_document(model, names.token) if assembled else part_document(model, names.token(name))
        transferred = writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs)
        stream = BytesIO()  # the kernel is silent about a disk that is full, Python is not
        written = transferred and writer.WriteStream(stream) == IFSelect_RetDone
    if not written:
        raise SolverError(f"the CAD kernel could not write {path}")
    header = part21.header(model.name if assembled else name).encode("ascii")
    content = names.put_into(_reproducible(stream.getvalue()))
    Path(path).write_bytes(_HEADER.sub(lambda _: header, content, count=1))


class _Names:
    """Short tokens that stand for names while the kernel writes: it takes no care of characters when it breaks lines."""

    def __init__(self) -> None:
        self._names: list[str] = []

    def token(self, name: str) -> str:
        self._names.append(name)
        return f"gearcad-name-{len(self._names) - 1}"

    def put_into(self, content: bytes) -> bytes:
        """The content with names for tokens."""
        return _TOKEN.sub(lambda match: part21.string(self._names[int(match[1])]).encode("ascii"), content)


@contextmanager
def _settings() -> Iterator[None]:
    """The kernel's global settings of this module while it writes; afterwards the user's are back."""
    from OCP.Interface import Interface_Static
    from OCP.STEPCAFControl import STEPCAFControl_Controller

    numbers = {"write.surfacecurve.mode": 0, "write.precision.mode": 0}
    texts = {"write.step.schema": "AP214IS", "xstep.cascade.unit": "MM", "write.step.unit": "MM"}
    with _kernel:
        STEPCAFControl_Controller.Init_s()  # without a controller the settings do not exist yet
        before = {name: Interface_Static.IVal_s(name) for name in numbers}
        before_texts = {name: Interface_Static.CVal_s(name) for name in texts}
        try:
            _set(numbers, texts)
            yield
        finally:
            _set(before, before_texts)


def _set(numbers: dict[str, int], texts: dict[str, str]) -> None:
    from OCP.Interface import Interface_Static

    for setting, value in numbers.items():
        Interface_Static.SetIVal_s(setting, value)
    for setting, text in texts.items():
        Interface_Static.SetCVal_s(setting, text)


def _reproducible(content: bytes) -> bytes:
    """The kernel numbers occurrences through the whole session, and breaks lines by it: count them by file, a line each."""
    number = count(1)

    def numbered(occurrence: re.Match[bytes]) -> bytes:
        return occurrence[1] + b"'%d'" % next(number) + _LINE_BREAK.sub(b"", occurrence[2])

    return _sort_colours(_OCCURRENCE.sub(numbered, content))


def _sort_colours(content: bytes) -> bytes:
    """Order the colours at the end of the data by the entity they colour: the kernel's order is that of addresses in memory.

    Their entities are numbered anew. What parts of one colour share stands with one of them, whichever the kernel wrote first.
    """
    blocks = list(_COLOUR_BLOCK.finditer(content))
    if len(blocks) < 2:
        return content
    ordered = b"".join(block[0] for block in sorted(blocks, key=lambda block: int(block[2])))
    anew = {old: b"#%d" % number for number, old in enumerate(_ENTITY.findall(ordered), int(blocks[0][1]))}
    ordered = _REFERENCE.sub(lambda match: anew.get(match[0], match[0]), ordered)
    return content[: blocks[0].start()] + ordered + content[blocks[-1].end() :]
