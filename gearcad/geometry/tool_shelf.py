"""Shelf of tools: the tables of tools that a design sees, and gears that take a tool by its name.

A name is looked for in the folder of the design, then in the user's configuration folder, then in the table of gearcad.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from gearcad.core.errors import (
    GeometryError,
    ParameterError,
    SpecError,
    format_number,
    is_finite_number,
    printable,
    shown,
    shown_path,
)
from gearcad.core.quantities import is_given
from gearcad.core.runtime import templates
from gearcad.core.shelf_tables import Place, user_folder
from gearcad.core.units import module_of_pitch
from gearcad.geometry.tool_tables import FILE, OWN_FILE, PARTS, SAME_MODULE, ShelfTool, ToolRow, read_tools

_NEAREST = 3
"""Number of names that a message suggests."""


class ToolName(str):
    """The name of a tool, with the `folder` of the design that has it; `tool` is what was found, None until it is looked for.

    `Gear(tool="DIN 3972 II")` takes a plain text too, whose folder is the current one.
    """

    folder: Path = Path()
    tool: ShelfTool | None = None

    @classmethod
    def of(cls, name: str, folder: Path | None = None, tool: ShelfTool | None = None) -> ToolName:
        """Return the name as seen from a folder; without one, from that of the name itself."""
        made = cls(name)
        made.folder = getattr(name, "folder", Path()) if folder is None else folder
        made.tool = tool
        return made

    def seen_from(self, folder: Path) -> str:
        """Return the name for a design in another folder: where it is a design's own tool, with the way to its table."""
        from os.path import relpath

        rows = [row for row in Shelf(self.folder).named(self) if row.table.place is Place.DESIGN]
        if not rows or "/" in self or self.folder.resolve() == folder.resolve():
            return str(self)
        return f"{Path(relpath(self.folder, folder)).as_posix()}/{self}"


def user_table() -> Path:
    """Return the path of the table of tools in the user's configuration folder, be it there or not."""
    return user_folder() / FILE


class Shelf(NamedTuple):
    """The tables of tools that a design in a folder sees."""

    folder: Path = Path()

    @property
    def places(self) -> tuple[tuple[Path, Place], ...]:
        """The tables in the order in which a name is looked for, be they there or not."""
        own = templates() / OWN_FILE
        return (self.folder / FILE, Place.DESIGN), (user_table(), Place.USER), (own, Place.OWN)

    def rows(self) -> Iterator[ToolRow]:
        """Yield the rows of all tables. Raises SpecError for a table that cannot be read."""
        for path, place in self.places:
            try:
                stamp = path.stat()
            except (OSError, ValueError):
                continue
            yield from read_tools(path, place, (stamp.st_mtime_ns, stamp.st_size))

    @classmethod
    def own(cls) -> tuple[ToolRow, ...]:
        """Return the rows of the table of gearcad."""
        path = templates() / OWN_FILE
        stamp = path.stat()
        return read_tools(path, Place.OWN, (stamp.st_mtime_ns, stamp.st_size))

    def named(self, name: str) -> list[ToolRow]:
        """Return the rows of a name in the order of the tables; large and small letters are alike where none is spelt so."""
        plain = " ".join(name.split())
        rows = list(self.rows())
        exact = [row for row in rows if row.name == plain]
        if exact:
            return exact
        folded = [row for row in rows if row.name.casefold() == plain.casefold()]
        if folded or "/" not in plain:
            return folded
        folder, _, last = plain.rpartition("/")
        beyond = Shelf(self.folder / folder)
        return [row for row in beyond.rows() if row.table.place is Place.DESIGN and row.name == last.strip()]

    def find(self, name: str, module: float | None) -> ShelfTool:
        """Return the tool of a name for a normal module (mm), None for any. Raises InputError and SpecError."""
        rows = self.named(name)
        if not rows:
            raise ParameterError("tool", str(name), self._absent(name))
        for table in dict.fromkeys(row.table for row in rows):
            here = [row for row in rows if row.table == table]
            suits = [row for row in here if row.module is not None and _alike(row.module, module)]
            suits += [row for row in here if row.module is None]
            if suits:
                return suits[0].tool
        modules = ", ".join(format_number(each) for each in sorted({row.module for row in rows if row.module is not None}))
        permitted = f"must be a tool of module {format_number(module)} mm; it is there for module {shown(modules)} mm"
        raise GeometryError("tool", str(name), permitted)

    def _absent(self, name: str) -> str:
        names = list(dict.fromkeys(row.name for row in self.rows()))
        folded = {each.casefold(): each for each in names}
        near = difflib.get_close_matches(" ".join(name.split()).casefold(), folded, n=_NEAREST, cutoff=0.0)
        nearest = ", ".join(f'"{folded[each]}"' for each in near)
        paths = [path for path, place in self.places if place is not Place.OWN]
        if "/" in name:
            paths.append(self.folder / name.rpartition("/")[0] / FILE)
        files = ", ".join(printable(shown_path(path)) for path in paths)
        return f"must be a tool of the shelf; the nearest are {nearest}; looked in {files} and the table of gearcad"

    def text_of(self, name: str) -> str:
        """Return the rows of a name as one text, by which a change is noticed; "" where they cannot be read."""
        try:
            return "\n".join(f"{row.table.columns} {row.cells}" for row in self.named(name))
        except SpecError:
            return ""


def _alike(one: float, other: float | None) -> bool:
    return other is None or math.isclose(one, other, rel_tol=SAME_MODULE)


def find_tool(name: str, module: float | None) -> ToolName:
    """Return a name with its tool, which is looked for in the folder of the name. Raises InputError and SpecError."""
    if not isinstance(name, str):
        raise ParameterError("tool", name, "must be the name of a tool, a text in quotation marks")
    folder = getattr(name, "folder", Path())
    found = Shelf(folder).find(name, module)
    return ToolName.of(name if "/" in name else found.name, folder, found)


def module_given(module: Any, pitch: Any) -> float | None:
    """Return the normal module (mm) of what is given, or of a diametral pitch (1/inch); None where neither is a number."""
    if is_given(module) and is_finite_number(module) and module > 0:
        return float(module)
    if is_given(pitch) and is_finite_number(pitch) and pitch > 0:
        return module_of_pitch(float(pitch))
    return None


def equip(gear: Any) -> None:
    """Give a gear the rack, cutter or premachining of its tool, if it names one.

    A gear that has a tool already keeps its name as long as it has the parts of that tool. Raises InputError and SpecError.
    """
    name = gear.tool
    if name is None:
        return
    if isinstance(name, ToolName) and name.tool is not None:
        module = module_given(gear.normal_module, gear.normal_diametral_pitch)
        kept = all(getattr(gear, part) == made for part, made in name.tool.parts.items())
        if not kept or (module is not None and not name.tool.fits(module)):
            object.__setattr__(gear, "tool", None)
        return
    found = find_tool(name, module_given(gear.normal_module, gear.normal_diametral_pitch))
    assert found.tool is not None
    for part, made in found.tool.parts.items():
        given = getattr(gear, part)
        if given not in (made, PARTS[part]()):
            raise GeometryError(part, given, f'must be left out: the tool is given (tool = "{found}")')
        object.__setattr__(gear, part, made)
    object.__setattr__(gear, "tool", found)
