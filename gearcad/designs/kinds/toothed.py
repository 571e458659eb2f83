"""What gears, racks and their pairs have in common: tables beside those of the teeth, and the document that holds them."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from gearcad.designs.design import Design
from gearcad.designs.drawings import drawing_documents, drawings_of
from gearcad.designs.files import Where
from gearcad.designs.keys import BESIDE, KEYS, explain_unknown_table
from gearcad.designs.materials import materials_of
from gearcad.designs.spec import Spec
from gearcad.errors import SpecError, format_number, shown
from gearcad.geometry import GearPair, RackPair
from gearcad.material import Material
from gearcad.per_gear import PerGear
from gearcad.schema import parts_of, with_assumed

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    from gearcad.drawing.options import DrawingOptions, PartDrawing

__all__ = ["ToothedDesign", "beside_teeth", "require_known_tables"]


@dataclass(frozen=True, kw_only=True)
class ToothedDesign(Design):
    """A design with teeth; a table beside them, such as [material], is a field of its name, None where a spec says nothing."""

    drawing: DrawingOptions | None = None
    drawings: Mapping[str, PartDrawing] = field(default_factory=dict)
    """What the sheets of gears have of their own, by the gears' names in `gears`."""

    @classmethod
    @abstractmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> Spec:
        """The values of a spec, whose tables are those of this kind. Raises SpecError."""

    @property
    def made_of(self) -> tuple[str, ...]:
        """The gears that may have materials of their own."""
        return ()

    @property
    def assembly(self) -> GearPair | RackPair | None:
        """What stands in mesh; None for a gear or a rack by itself."""
        return None

    def to_dict(self) -> dict[str, Any]:
        """The document of `data.json`: inputs and derived properties under their field names (mm, degrees).

        "assumed" has the inputs that nobody gave, such as "load.application_factor = 1".
        """
        document = super().to_dict()
        for table in BESIDE:
            value = getattr(self, table, None)
            if isinstance(value, PerGear):  # a material for each gear
                value = dict(zip(self.made_of, value, strict=True))
            if isinstance(value, Mapping):
                document["materials"] = {name: asdict(material) for name, material in value.items()}
            elif value is not None:
                document[table] = _plain(value)
        document |= drawing_documents(self.drawing, self.drawings)
        return with_assumed(document)


def _plain(options: DataclassInstance) -> dict[str, Any]:
    """The fields of a table, without parts that are not there."""
    absent = [part for part in parts_of(type(options)) if getattr(options, part) is None]
    return {key: value for key, value in asdict(options).items() if key not in absent}


def require_known_tables(tables: Mapping[str, Any], where: Where) -> None:
    """Raise SpecError for what no design with teeth has, and for what is no table."""
    for table, content in tables.items():
        if table not in KEYS:
            raise SpecError(f"{where(table)}: {shown(table)}: {explain_unknown_table(table)}")
        if not isinstance(content, Mapping):
            raise SpecError(f"{where(table)}: {table} = {format_number(content)}: must be a table, headed [{table}]")


def beside_teeth(spec: Spec, tables: Mapping[str, Any], gears: tuple[str, ...] = ()) -> dict[str, Any]:
    """What the tables beside those of the teeth make, as keyword arguments of a ToothedDesign.

    Those of `gears` may have materials of their own: "material" is then PerGear of two, else that of all.
    """
    made: dict[str, Any] = {
        table: spec.simple(table, BESIDE[table]) for table in BESIDE if table in tables and table != "material"
    }
    if own := drawings_of(spec):
        made["drawings"] = own
    if (material := materials_of(spec, gears)) is not None:
        made["material"] = PerGear(*material.values()) if isinstance(material, dict) else material
    elif "material" in tables:
        made["material"] = Material()
    return made
