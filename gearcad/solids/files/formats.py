"""Formats of files: what each holds, which options it minds, and its writer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from gearcad.core.records import Floats
from gearcad.solids.exact.solid import AssembledProduct
from gearcad.solids.facets.tessellation import Facets

if TYPE_CHECKING:
    from gearcad.solids.files.gear_train_products import GearTrainProduct
    from gearcad.solids.files.gearbox_products import GearboxProduct
    from gearcad.solids.files.products import FileOptions, GearProduct, PairProduct, RackPairProduct, RackProduct, SplineProduct
    from gearcad.solids.files.shaft_products import ShaftProduct
    from gearcad.solids.files.train_products import CarrierProduct, TrainProduct

    PartProduct: TypeAlias = GearProduct | RackProduct
    BodyProduct: TypeAlias = CarrierProduct | ShaftProduct
    AssemblyProduct: TypeAlias = (
        PairProduct | RackPairProduct | SplineProduct | TrainProduct | GearTrainProduct | GearboxProduct
    )


class Format(Enum):
    """Format of a design's files, slowest first; the value is the suffix of the file."""

    STEP = "step"
    STL = "stl"
    THREE_MF = "3mf"
    GLB = "glb"
    PNG = "png"
    DXF = "dxf"
    CSV = "csv"

    @property
    def entry(self) -> SolidFormat:
        """Entry of this format: words, writers and the options that matter to it."""
        return _ENTRIES[self]

    def minded(self, options: FileOptions) -> dict[str, Any]:
        """Return the options that matter to this format, by name."""
        return {name: getattr(options, name) for name in self.entry.options}


@dataclass(frozen=True)
class SolidFormat:
    """One format: what it holds, in words; what writes a gear or a rack, and what stands in mesh (None: it has no assemblies);
    which fields of FileOptions matter to it; whether it holds bodies, so that a ring needs its rim; what writes a planetary
    train, where that is more than of a pair, and what a body without teeth by itself: its carrier, or a shaft of a pair.
    """

    words: str
    write: Callable[[PartProduct, Path], None]
    write_pair: Callable[[AssemblyProduct, Path], None] | None = None
    options: tuple[str, ...] = ()
    of_bodies: bool = True
    write_train: Callable[[TrainProduct, Path], None] | None = None
    write_body: Callable[[BodyProduct, Path], None] | None = None


def formats_minding(option: str) -> list[Format]:
    """Return the formats to which a field of FileOptions matters."""
    return [kind for kind in Format if option in kind.entry.options]


def _step(product: PartProduct | BodyProduct | AssemblyProduct, path: Path) -> None:
    from gearcad.solids.files.step import StepSchema, write_product, write_step

    schema = StepSchema.AP242 if product.options.ap242 else StepSchema.AP214
    if blanks := product.blanks:
        from gearcad.solids.exact.own_blank import assembly_with_blanks, toothed_blank

        solid = product.solid()
        if isinstance(solid, AssembledProduct):
            write_step(assembly_with_blanks(solid, blanks), path, name=solid.name, schema=schema)
        else:
            write_step(toothed_blank(blanks[solid.name]), path, name=solid.name, schema=schema)
        return
    write_product(product.solid(), path, schema)


def _stl(product: PartProduct | BodyProduct, path: Path) -> None:
    write_stl(product.facets, path)


def _3mf(product: PartProduct | BodyProduct | AssemblyProduct, path: Path) -> None:
    from gearcad.solids.files.scenes import write_3mf

    write_3mf(product.scene(), path)


def _glb(product: PartProduct | BodyProduct | AssemblyProduct, path: Path) -> None:
    from gearcad.solids.files.scenes import write_glb

    write_glb(product.scene(), path)


def _turning_glb(product: TrainProduct, path: Path) -> None:
    from gearcad.solids.files.scenes import write_glb

    write_glb(product.scene(), path, product.turning())


def _png(product: PartProduct | BodyProduct | AssemblyProduct, path: Path) -> None:
    from gearcad.solids.files.studio import write_picture

    write_picture(product.scene(), path)


def _train_png(product: TrainProduct, path: Path) -> None:
    from gearcad.solids.files.studio import write_picture

    write_picture(product.scene(), path, product.other_scene())


def _dxf(product: PartProduct | TrainProduct, path: Path) -> None:
    product.write_dxf(path)


def _csv(product: PartProduct, path: Path) -> None:
    product.write_points(path)


_FACETED = ("chord_error",)
_PLACED = ("carrier", "exploded")

_ENTRIES = {
    Format.STEP: SolidFormat(
        "the exact solid", _step, _step, ("bracket", *_PLACED, "ap242"), write_train=_step, write_body=_step
    ),
    Format.STL: SolidFormat("facets within --chord-error", _stl, None, (*_FACETED, "carrier"), write_body=_stl),
    Format.THREE_MF: SolidFormat("facets, for printing", _3mf, _3mf, (*_FACETED, *_PLACED), write_train=_3mf, write_body=_3mf),
    Format.GLB: SolidFormat(
        "facets, for viewers", _glb, _glb, (*_FACETED, *_PLACED, "turning"), write_train=_turning_glb, write_body=_glb
    ),
    Format.PNG: SolidFormat(
        "a picture from three sides", _png, _png, (*_FACETED, *_PLACED), write_train=_train_png, write_body=_png
    ),
    Format.DXF: SolidFormat("exact section, for cutting", _dxf, None, ("circles",), of_bodies=False, write_train=_dxf),
    Format.CSV: SolidFormat("points of flank and fillet", _csv, of_bodies=False),
}


_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attributes", "<u2")])
_HEADER = 80

_NO_AREA = 1e-13
"""Twice the area (mm²) of a triangle that has no normal."""


def write_stl(facets: Facets, path: Path | str) -> None:
    """Write binary STL, in mm (the format states no unit) and single precision."""
    corners = facets.vertices[facets.faces]
    triangles = np.zeros(len(corners), _TRIANGLE)
    triangles["normal"], triangles["corners"] = _normals(corners), corners
    with Path(path).open("wb") as file:
        file.write(bytes(_HEADER) + np.uint32(len(triangles)).astype("<u4").tobytes())
        file.write(triangles.data)


def _normals(corners: Floats) -> Floats:
    """Return the unit normals (n, 3) of triangles (n, 3, 3), outwards; 0 where there is no area."""
    sides = corners[:, 1:] - corners[:, :2]
    normals = np.cross(sides[:, 0], sides[:, 1])
    sizes = np.sqrt((normals * normals) @ np.ones(3))
    flat = sizes <= _NO_AREA
    normals[flat], sizes[flat] = 0.0, 1.0
    return normals * (1.0 / sizes)[:, None]
