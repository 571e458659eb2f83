"""What a gear and a pair have in common: the inputs beside the teeth, and the tables of a spec that hold them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypedDict

from gearcad.designs.design import DesignKind
from gearcad.designs.files import Where
from gearcad.designs.keys import MAIN_TABLES
from gearcad.designs.kinds.toothed import ToothedDesign, require_known_tables
from gearcad.designs.spec import Spec
from gearcad.errors import SpecError
from gearcad.geometry import GearPair

if TYPE_CHECKING:
    from gearcad.check.options import CheckOptions
    from gearcad.drawing.options import DrawingOptions
    from gearcad.dynamics.options import DynamicsOptions
    from gearcad.load import Load
    from gearcad.material import Materials
    from gearcad.meshing.options import MeshOptions
    from gearcad.mounting import Mounting
    from gearcad.rating.options import RatingOptions

__all__ = ["GearedDesign", "Inputs", "require_tables"]


class Inputs(TypedDict, total=False):
    """What a job may be given beside a pair and its load, under the names of a spec's tables."""

    material: Materials
    mounting: Mounting
    check: CheckOptions
    mesh: MeshOptions
    dynamics: DynamicsOptions
    rating: RatingOptions
    drawing: DrawingOptions


@dataclass(frozen=True, kw_only=True)
class GearedDesign(ToothedDesign):
    """A gear or a pair with the inputs that later stages need; None for those of which a spec says nothing."""

    load: Load | None = None
    mounting: Mounting | None = None
    check: CheckOptions | None = None
    mesh: MeshOptions | None = None
    dynamics: DynamicsOptions | None = None
    rating: RatingOptions | None = None

    @classmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> Spec:
        """The values of a spec, whose tables are those of this kind. Raises SpecError."""
        require_tables(tables, where)
        return Spec.of(tables, where)

    @property
    def assembly(self) -> GearPair | None:
        """What stands in mesh; None for a single gear."""
        return None


def require_tables(tables: Mapping[str, Any], where: Where) -> None:
    """Raise SpecError for tables that no gear and no pair has, and for those of a pair beside [gear]."""
    require_known_tables(tables, where)
    for other in MAIN_TABLES[DesignKind.PAIR]:
        if "gear" in tables and other in tables:
            raise SpecError(f"{where(other)}: [{other}] cannot stand beside [gear]: one spec makes a gear or a pair")
