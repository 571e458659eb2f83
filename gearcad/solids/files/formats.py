"""The formats of files: what each holds, which options it minds, and what writes it - an entry here, and a file of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from gearcad.solids.files.options import FileOptions
    from gearcad.solids.files.products import GearProduct, PairProduct
    from gearcad.solids.files.rack_products import RackPairProduct, RackProduct
    from gearcad.solids.files.train_products import CarrierProduct, TrainProduct

    PartProduct = GearProduct | RackProduct
    AssemblyProduct: TypeAlias = PairProduct | RackPairProduct | TrainProduct

__all__ = ["Format", "formats_minding"]


class Format(Enum):
    """What can be written of a design, slowest first; the value is the suffix of the file."""

    STEP = "step"
    STL = "stl"
    THREE_MF = "3mf"
    GLB = "glb"
    PNG = "png"
    DXF = "dxf"
    CSV = "csv"

    @property
    def entry(self) -> Entry:
        """What there is to know of it."""
        return _ENTRIES[self]

    def minded(self, options: FileOptions) -> dict[str, Any]:
        """Those of the options that matter to it, by name."""
        return {name: getattr(options, name) for name in self.entry.options}


@dataclass(frozen=True)
class Entry:
    """One format: what it holds, in words; what writes a gear or a rack, and what stands in mesh (None: it has no assemblies);
    which fields of FileOptions matter to it; whether it holds bodies, so that a ring needs its rim; what writes a planetary
    train, where that is more than of a pair, and what its carrier by itself, which has no teeth.
    """

    words: str
    write: Callable[[PartProduct, Path], None]
    write_pair: Callable[[AssemblyProduct, Path], None] | None = None
    options: tuple[str, ...] = ()
    of_bodies: bool = True
    write_train: Callable[[TrainProduct, Path], None] | None = None
    write_carrier: Callable[[CarrierProduct, Path], None] | None = None


def formats_minding(option: str) -> list[Format]:
    """The formats to which a field of FileOptions matters."""
    return [kind for kind in Format if option in kind.entry.options]


def _step(product: PartProduct | CarrierProduct | AssemblyProduct, path: Path) -> None:
    from gearcad.solids.files.step import write_product

    write_product(product.solid(), path)


def _stl(product: PartProduct | CarrierProduct, path: Path) -> None:
    from gearcad.solids.files.stl import write_stl

    write_stl(product.facets, path)


def _3mf(product: PartProduct | CarrierProduct | AssemblyProduct, path: Path) -> None:
    from gearcad.solids.files.three_mf import write_3mf

    write_3mf(product.scene(), path)


def _glb(product: PartProduct | CarrierProduct | AssemblyProduct, path: Path) -> None:
    from gearcad.solids.files.glb import write_glb

    write_glb(product.scene(), path)


def _turning_glb(product: TrainProduct, path: Path) -> None:
    from gearcad.solids.files.glb import write_glb

    write_glb(product.scene(), path, product.turning())


def _png(product: PartProduct | CarrierProduct | AssemblyProduct, path: Path) -> None:
    from gearcad.solids.files.pictures.three_views import write_picture

    write_picture(product.scene(), path)


def _train_png(product: TrainProduct, path: Path) -> None:
    from gearcad.solids.files.pictures.three_views import write_picture

    write_picture(product.scene(), path, product.other_scene())


def _dxf(product: PartProduct | TrainProduct, path: Path) -> None:
    product.write_dxf(path)


def _csv(product: PartProduct, path: Path) -> None:
    product.write_points(path)


_FACETED = ("chord_error",)
_PLACED = ("carrier", "exploded")

_ENTRIES = {
    Format.STEP: Entry("the exact solid", _step, _step, ("bracket", *_PLACED), write_train=_step, write_carrier=_step),
    Format.STL: Entry("facets within --chord-error", _stl, None, (*_FACETED, "carrier"), write_carrier=_stl),
    Format.THREE_MF: Entry("facets, for printing", _3mf, _3mf, (*_FACETED, *_PLACED), write_train=_3mf, write_carrier=_3mf),
    Format.GLB: Entry(
        "facets, for viewers", _glb, _glb, (*_FACETED, *_PLACED, "turning"), write_train=_turning_glb, write_carrier=_glb
    ),
    Format.PNG: Entry(
        "a picture from three sides", _png, _png, (*_FACETED, *_PLACED), write_train=_train_png, write_carrier=_png
    ),
    Format.DXF: Entry("exact section, for cutting", _dxf, None, ("circles",), of_bodies=False, write_train=_dxf),
    Format.CSV: Entry("points of flank and fillet", _csv, of_bodies=False),
}
