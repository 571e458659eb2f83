"""Build: a design in, its files out - solids, meshes, contours, points, and the data sheet as `data.json`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

from gearcad.designs import Design, GearDesign, GearedDesign, PairDesign
from gearcad.errors import GeometryError, ParameterError
from gearcad.output import json_text, staged_files
from gearcad.progress import Progress
from gearcad.solids import FileOptions, Format
from gearcad.solids.files.formats import formats_minding
from gearcad.solids.files.products import GearProduct, PairProduct

__all__ = ["DEFAULT_FORMATS", "build"]

DEFAULT_FORMATS = (Format.STEP, Format.STL)

_PLAIN = FileOptions()

_WHERE = {"bracket": "the bracket is part of assembly.step", "circles": "the circles are drawn there"}
"""Where options show that no file but those of a few formats can show."""


class _Step(NamedTuple):
    """One file to write: its name, and what writes it when given the path."""

    file: str
    write: Callable[[Path], None]


def build(
    design: Design,
    folder: Path,
    formats: Iterable[Format] = DEFAULT_FORMATS,
    options: FileOptions = _PLAIN,
    progress: Progress | None = None,
) -> list[Path]:
    """Write the design's files into `folder` and return their paths in the order they were made.

    Per gear `pinion.step`, `wheel.step` or `gear.step` and so on; a pair also gets `assembly.*`, posed in mesh, in the formats
    that have assemblies. All files appear, or none.
    Raises ParameterError or GeometryError for wrong input, a folder that cannot be written too.
    """
    geared = design.accepted(GearDesign, PairDesign, why="there are no teeth")
    wanted = set(formats)
    _check(geared, wanted, options)
    steps = list(_plan(geared, [kind for kind in Format if kind in wanted], options))
    with staged_files(folder) as staging:
        for done, step in enumerate(steps):
            if progress is not None:
                progress(step.file, done, len(steps))
            step.write(staging / step.file)
    return [folder / step.file for step in steps]


def _check(design: GearedDesign, formats: set[Format], options: FileOptions) -> None:
    if not formats:
        raise ParameterError("format", "", f"must be one or more of {', '.join(kind.value for kind in Format)}")
    if options.bracket and design.assembly is None:
        raise GeometryError("bracket", True, "needs a pair: a single gear has no assembly")
    for option, where in _WHERE.items():
        needed = formats_minding(option)
        if getattr(options, option) and not formats.intersection(needed):
            raise GeometryError(option, True, f"needs the format {' or '.join(kind.value for kind in needed)}: {where}")


def _plan(design: GearedDesign, formats: list[Format], options: FileOptions) -> Iterator[_Step]:
    """Every file of the design, quickest first."""
    yield _Step("data.json", partial(_write_data, design))
    pair = PairProduct(design.assembly, options) if design.assembly is not None else None
    gears = _products(design, pair, options)
    for kind in reversed(formats):
        for name, product in gears.items():
            yield _Step(f"{name}.{kind.value}", partial(kind.entry.write, product))
        if pair is not None and kind.entry.write_pair is not None:
            yield _Step(f"assembly.{kind.value}", partial(kind.entry.write_pair, pair))


def _products(design: GearedDesign, pair: PairProduct | None, options: FileOptions) -> dict[str, GearProduct]:
    """The gears as files hold them, by the names of these files."""
    if pair is not None:
        return {role.value: product for role, product in pair.gears.items()}
    return {name: GearProduct(gear=gear, name=design.name, options=options) for name, gear in design.gears.items()}


def _write_data(design: Design, path: Path) -> None:
    path.write_text(json_text(design.to_dict()), encoding="utf-8")
