"""STEP files (AP214, mm): named and coloured parts, no curves in parameter space, and equal bytes for equal input."""

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

__all__ = ["write_step"]

_HEADER = re.compile(rb"HEADER;.*?ENDSEC;\n", re.DOTALL)
_PREPROCESSOR = re.compile(rb"'(Open CASCADE STEP processor [^']*)'")
_SCHEMA = re.compile(rb"FILE_SCHEMA\(\('([^']*)'\)\)")
_TOKEN = re.compile(rb"'gearcad-name-(\d+)'")
_OCCURRENCE = re.compile(rb"^(#\d+ = NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'\d+'([^;]*)\);", re.MULTILINE)
_LINE_BREAK = re.compile(rb"\n *")
_PIECE = re.compile(rb",|[^,]+")
_LONGEST_LINE = 72
"""Of the kernel, where it begins a new one between parameters and commas."""

_COLOUR_BLOCK = re.compile(
    rb"^#(\d+) = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION\([^;]*;"
    rb"\s*#\d+ = STYLED_ITEM\('color',\([^)]*\),#(\d+)\);"
    rb".*?(?=^#\d+ = MECHANICAL_DESIGN|^ENDSEC)",
    re.DOTALL | re.MULTILINE,
)
_REFERENCE = re.compile(rb"#(\d+)")
_ENTITY = re.compile(rb"^#\d+ = ", re.MULTILINE)

_kernel = RLock()
"""Held while the kernel's global settings are changed."""


def write_step(model: cadquery.Assembly | cadquery.Solid, path: Path | str, *, name: str) -> None:
    """Write a solid, as one part called `name`, or an assembly, which has names of its own, to `path` (STEP AP214, mm).

    Curves in the parameters of surfaces are left out (write.surfacecurve.mode 0): readers rebuild them, and the file is a
    third to a half smaller. Names may hold any character. Running numbers are fixed, and the time stamp (see `header`).
    Raises SolverError if the kernel cannot write, ParameterError for a date that is none, and OSError if the file cannot
    be written.
    """
    import cadquery
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.STEPCAFControl import STEPCAFControl_Writer
    from OCP.STEPControl import STEPControl_StepModelType

    path = Path(path)
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
    content = _with_header(_reproducible(stream.getvalue()), model.name if assembled else name)
    path.write_bytes(names.put_into(content))


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

    numbers = {"write.surfacecurve.mode": 0, "write.precision.mode": 0}
    texts = {"write.step.schema": "AP214IS", "xstep.cascade.unit": "MM", "write.step.unit": "MM"}
    with _kernel:
        _initialise()
        before = {name: Interface_Static.IVal_s(name) for name in numbers}
        before_texts = {name: Interface_Static.CVal_s(name) for name in texts}
        try:
            _set(numbers, texts)
            yield
        finally:
            _set(before, before_texts)


def _initialise() -> None:
    """Without a controller the settings do not exist yet."""
    from OCP.STEPCAFControl import STEPCAFControl_Controller

    STEPCAFControl_Controller.Init_s()


def _set(numbers: dict[str, int], texts: dict[str, str]) -> None:
    from OCP.Interface import Interface_Static

    for setting, value in numbers.items():
        Interface_Static.SetIVal_s(setting, value)
    for setting, text in texts.items():
        Interface_Static.SetCVal_s(setting, text)


def _with_header(content: bytes, name: str) -> bytes:
    """With a header of our own: the kernel's calls the file a Shape Model of Author's, and stamps the time."""
    preprocessor, schema = (found[1].decode("ascii") for kind in (_PREPROCESSOR, _SCHEMA) if (found := kind.search(content)))
    ours = part21.header(name, preprocessor, schema).encode("ascii")
    return _HEADER.sub(lambda _: ours, content, count=1)


def _reproducible(content: bytes) -> bytes:
    """The kernel numbers occurrences through the whole session: count them by file."""
    number = count(1)
    return _sort_colours(_OCCURRENCE.sub(lambda match: _numbered(match, next(number)), content))


def _numbered(occurrence: re.Match[bytes], number: int) -> bytes:
    """An occurrence with a number of its own, its lines broken where the kernel breaks them with that."""
    text, line = b"", occurrence[1] + b"'%d'" % number
    for piece in (*_PIECE.findall(_LINE_BREAK.sub(b"", occurrence[2])), b");"):
        if len(line) + len(piece) > _LONGEST_LINE:
            text, line = text + line + b"\n", b"  "
        line += piece
    return text + line


def _sort_colours(content: bytes) -> bytes:
    """Order the colours at the end of the data by the entity they colour: the kernel's order is that of addresses in memory.

    Each block of entities is renumbered to its new place; a block refers to itself and to geometry before all blocks, as
    long as no two parts share a colour.
    """
    blocks = list(_COLOUR_BLOCK.finditer(content))
    if len(blocks) < 2:
        return content
    first = number = int(blocks[0][1])
    ordered = b""
    for block in sorted(blocks, key=lambda block: int(block[2])):
        ordered += _renumber(block[0], first, number - int(block[1]))
        number += len(_ENTITY.findall(block[0]))
    return content[: blocks[0].start()] + ordered + content[blocks[-1].end() :]


def _renumber(block: bytes, first: int, shift: int) -> bytes:
    """Shift every entity number from `first` on."""
    return _REFERENCE.sub(lambda match: b"#%d" % (int(match[1]) + (shift if int(match[1]) >= first else 0)), block)
