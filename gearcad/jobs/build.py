"""Build: a design in, its files out - solids, meshes, contours, points, and the data sheet as `data.json`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from gearcad.designs.design import Design
from gearcad.errors import GeometryError, ParameterError, require_number
from gearcad.geometry import Gear, GearPair, mesh_pose
from gearcad.output import json_text, staged_files
from gearcad.progress import Progress

if TYPE_CHECKING:
    from gearcad.solids import Facets

__all__ = ["DEFAULT_FORMATS", "Format", "build"]


class Format(Enum):
    """What can be written of a design; the value is the suffix of the file."""

    STEP = "step"
    STL = "stl"
    THREE_MF = "3mf"
    GLB = "glb"
    DXF = "dxf"
    CSV = "csv"


DEFAULT_FORMATS = (Format.STEP, Format.STL)

_SCENES = (Format.THREE_MF, Format.GLB)
_ASSEMBLED = (Format.STEP, *_SCENES)


class _Step(NamedTuple):
    """One file to write: its name, and what writes it when given the path."""

    file: str
    write: Callable[[Path], None]


def build(
    design: Design,
    folder: Path,
    formats: Iterable[Format] = DEFAULT_FORMATS,
    *,
    bracket: bool = False,
    chord_error: float = 0.005,
    circles: bool = False,
    progress: Progress | None = None,
) -> list[Path]:
    """Write the design's files into `folder` and return their paths in the order they were made.

    Per gear `pinion.step`, `wheel.step` or `gear.step` and so on; a pair also gets `assembly.*` in STEP, 3MF and GLB, posed in
    mesh; `bracket` puts it on two shafts with a bracket (STEP). `chord_error` (mm) bounds the facets of STL, 3MF and GLB;
    `circles` draws the tip, reference, base and root circles in DXF, where all else is to be cut. All files appear, or none.
    Raises ParameterError or GeometryError for wrong input, a folder that cannot be written too.
    """
    wanted = set(formats)
    manner = _Manner(chord_error, bracket, circles)
    _check(design, wanted, manner)
    steps = list(_plan(design, [kind for kind in Format if kind in wanted], manner))
    with staged_files(folder) as staging:
        for done, step in enumerate(steps):
            if progress is not None:
                progress(step.file, done, len(steps))
            step.write(staging / step.file)
    return [folder / step.file for step in steps]


def _check(design: Design, formats: set[Format], manner: _Manner) -> None:
    if not formats:
        raise ParameterError("format", "", f"must be one or more of {', '.join(kind.value for kind in Format)}")
    require_number("chord_error", manner.chord_error, "mm", above=0)
    if manner.bracket and design.pair is None:
        raise GeometryError("bracket", True, "needs a pair: a single gear has no assembly")
    if manner.bracket and Format.STEP not in formats:
        raise GeometryError("bracket", True, "needs the format step: the bracket is part of assembly.step")
    if manner.circles and Format.DXF not in formats:
        raise GeometryError("circles", True, "needs the format dxf: the circles are drawn there")


def _plan(design: Design, formats: list[Format], manner: _Manner) -> Iterator[_Step]:
    """Every file of the design, quickest first."""
    yield _Step("data.json", partial(_write_data, design))
    products = _products(design)
    for kind in reversed(formats):
        for name, gear in design.gears.items():
            yield _Step(f"{name}.{kind.value}", partial(_write_gear, kind, gear, name, products[name], manner))
        if design.pair is not None and kind in _ASSEMBLED:
            yield _Step(f"assembly.{kind.value}", partial(_write_assembly, kind, design.pair, manner))


def _products(design: Design) -> dict[str, str]:
    """What the parts are called inside files, by the names of these files."""
    from gearcad.solids.exact.assembly import part_names

    return part_names(design.pair) if design.pair is not None else {"gear": design.name}


@dataclass(frozen=True)
class _Manner:
    """How files are made; the facets of each gear, made once for all the formats that hold them."""

    chord_error: float
    bracket: bool
    circles: bool
    made: dict[int, Facets] = field(default_factory=dict)

    def facets(self, gear: Gear) -> Facets:
        from gearcad.solids import tessellate

        if id(gear) not in self.made:
            self.made[id(gear)] = tessellate(gear, self.chord_error)
        return self.made[id(gear)]


def _write_data(design: Design, path: Path) -> None:
    path.write_text(json_text(design.to_dict()), encoding="utf-8")


def _write_gear(kind: Format, gear: Gear, name: str, product: str, manner: _Manner, path: Path) -> None:
    from gearcad import solids
    from gearcad.solids.exact.assembly import PART_COLOURS

    if kind is Format.STEP:
        solids.write_step(solids.gear_solid(gear), path, name=product)
    elif kind is Format.STL:
        solids.write_stl(manner.facets(gear), path)
    elif kind in _SCENES:
        colour = PART_COLOURS.get(name, solids.Part.colour)
        part = solids.Part(name=product, facets=manner.facets(gear), colour=colour)
        solids.write_scene([part], path)
    elif kind is Format.DXF:
        solids.write_dxf(gear, path, circles=manner.circles)
    else:
        solids.write_points(gear, path)


def _write_assembly(kind: Format, pair: GearPair, manner: _Manner, path: Path) -> None:
    from gearcad import solids
    from gearcad.solids.exact.assembly import PART_COLOURS, part_names

    if kind is Format.STEP:
        solids.write_step(solids.pair_assembly(pair, bracket=manner.bracket), path, name=pair.name)
        return
    pose, names = mesh_pose(pair), part_names(pair)
    places = {"pinion": (pair.pinion, 0.0, (0.0, 0.0, 0.0)), "wheel": (pair.wheel, pose.rotation, (pose.x, 0.0, pose.z))}
    parts = [
        solids.Part(name=names[name], facets=manner.facets(gear), colour=PART_COLOURS[name], rotation=rotation, offset=offset)
        for name, (gear, rotation, offset) in places.items()
    ]
    solids.write_scene(parts, path)
