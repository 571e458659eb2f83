"""Designs of a single gear, `[gear]`, and of a rack, `[rack]`; what gears, racks and pairs have in common."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypedDict

from gearcad.core.errors import GeometryError, SpecError, format_number, shown
from gearcad.core.quantities import inputs_document, parts_of, with_assumed
from gearcad.core.records import JsonObject, PerGear
from gearcad.designs.design import Described, Design, Where
from gearcad.designs.keys import BESIDE, KEYS, MAIN_TABLES, DesignKind, explain_unknown_table
from gearcad.designs.spec import AUTO, Spec, drawing_documents, drawings_of, khk_reminder, materials_of
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.material import Material

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    from gearcad.check.options import CheckOptions
    from gearcad.contact.load_range import ModifyOptions
    from gearcad.designs.shaft_spec import PairShafts
    from gearcad.drawing.options import DrawingOptions, PartDrawing
    from gearcad.dynamics.options import DynamicsOptions
    from gearcad.geometry.spline import SplineJoint
    from gearcad.load import Load
    from gearcad.material import Materials
    from gearcad.meshing.options import MeshOptions
    from gearcad.mounting import Mounting
    from gearcad.rating.options import RatingOptions
    from gearcad.verification.claims import VerificationOptions


@dataclass(frozen=True, kw_only=True)
class ToothedDesign(Design):
    """A design with teeth; a table beside them, such as [material], is a field of its name, None where a spec says nothing."""

    drawing: DrawingOptions | None = None
    verify: VerificationOptions | None = None
    drawings: Mapping[str, PartDrawing] = field(default_factory=dict)
    """Options that belong to the sheet of one gear only, by the gears' names in `gears`."""

    @classmethod
    @abstractmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> Spec:
        """Return the values of a spec, whose tables are those of this kind. Raises SpecError."""

    @property
    def made_of(self) -> tuple[str, ...]:
        """Gears that may have materials of their own."""
        return ()

    @property
    def assembly(self) -> GearPair | RackPair | None:
        """Pair in mesh, or None for a single gear or rack."""
        return None

    def to_dict(self) -> JsonObject:
        """Return the document of `data.json`: inputs and derived properties under their field names (mm, degrees).

        "assumed" has the inputs that nobody gave, such as "load.application_factor = 1".
        """
        document = super().to_dict()
        for table in BESIDE:
            value = getattr(self, table, None)
            if isinstance(value, PerGear):  # a material for each gear
                value = dict(zip(self.made_of, value, strict=True))
            if isinstance(value, Mapping):
                document["materials"] = {name: inputs_document(material) for name, material in value.items()}
            elif value is not None:
                document[table] = _plain(value)
        document |= drawing_documents(self.drawing, self.drawings)
        document = with_assumed(document)
        if self.gears and all(gear.accuracy_grade is not None for gear in self.gears.values()):  # that of [rating] is not used
            document["assumed"] = [line for line in document["assumed"] if not line.startswith("rating.accuracy_grade ")]
        return document


def _plain(options: DataclassInstance) -> dict[str, Any]:
    """Return the fields of a table, without parts that are not there."""
    absent = [part for part in parts_of(type(options)) if getattr(options, part) is None]
    return {key: value for key, value in inputs_document(options).items() if key not in absent}


def require_known_tables(tables: Mapping[str, Any], where: Where) -> None:
    """Raise SpecError for keys that no design with teeth has, and for values that should be tables."""
    for table, content in tables.items():
        if table not in KEYS:
            raise SpecError(f"{where(table)}: {shown(table)}: {explain_unknown_table(table)}")
        if not isinstance(content, Mapping):
            raise SpecError(f"{where(table)}: {table} = {format_number(content)}: must be a table, headed [{table}]")


def beside_teeth(spec: Spec, tables: Mapping[str, Any], gears: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the objects of the tables beside the teeth, as keyword arguments of a ToothedDesign.

    The gears named in `gears` may have materials of their own. Then "material" is a PerGear of two, otherwise one Material for
    all.
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


class Inputs(TypedDict, total=False):
    """Inputs that a job may get in addition to a pair and its load, under the names of a spec's tables."""

    material: Materials
    mounting: Mounting
    check: CheckOptions
    mesh: MeshOptions
    dynamics: DynamicsOptions
    rating: RatingOptions
    drawing: DrawingOptions
    verify: VerificationOptions
    modify: ModifyOptions
    shafts: PairShafts


@dataclass(frozen=True, kw_only=True)
class GearedDesign(ToothedDesign):
    """A gear or a pair with the inputs that later stages need; inputs that the spec does not give are None."""

    load: Load | None = None
    mounting: Mounting | None = None
    check: CheckOptions | None = None
    mesh: MeshOptions | None = None
    dynamics: DynamicsOptions | None = None
    rating: RatingOptions | None = None
    modify: ModifyOptions | None = None

    @classmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> Spec:
        """Return the values of a spec, whose tables are those of this kind. Raises SpecError."""
        require_tables(tables, where)
        return Spec.of(tables, where)

    @property
    def assembly(self) -> GearPair | None:
        """Pair in mesh, or None for a single gear."""
        return None


def require_tables(tables: Mapping[str, Any], where: Where) -> None:
    """Raise SpecError for tables that no gear and no pair has, and for those of a pair beside [gear]."""
    require_known_tables(tables, where)
    for other in MAIN_TABLES[DesignKind.PAIR]:
        if "gear" in tables and other in tables:
            raise SpecError(f"{where(other)}: [{other}] cannot stand beside [gear]: one spec makes a gear or a pair")


@dataclass(frozen=True, kw_only=True)
class GearDesign(GearedDesign):
    """A single gear, with the inputs that later stages need."""

    kind: ClassVar[DesignKind] = DesignKind.GEAR

    gear: Gear
    material: Material | None = None

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """Return the design that [gear] describes. Raises SpecError."""
        spec = cls.spec(tables, where)
        beside = beside_teeth(spec, tables)
        name = spec.name("gear", default_name)
        with spec.blame("gear"):
            inputs = spec.gear_inputs("gear")
            for key in ("profile_shift", "tip_alteration"):
                if inputs.get(key) == AUTO:
                    raise GeometryError(key, AUTO, "must be a number: only the gears of a pair know what to derive it from")
            with khk_reminder("", inputs, lambda other: Gear(**other)):
                gear = Gear(**inputs | {"name": name})
            return cls(name=name, gear=gear, **beside)

    @property
    def gears(self) -> dict[str, Gear]:
        """The one gear of the design."""
        return {"gear": self.gear}


@dataclass(frozen=True, kw_only=True)
class RackDesign(ToothedDesign):
    """A rack, and its material."""

    kind: ClassVar[DesignKind] = DesignKind.RACK
    elsewhere: ClassVar[str] = "a rack by itself is for `gearcad data`, `gearcad build` and `gearcad draw`"

    rack: Rack
    material: Material | None = None

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """Return the design that [rack] describes. Raises SpecError."""
        spec = cls.spec(tables, where)
        beside = beside_teeth(spec, tables)
        if own := spec.given_of("rack.material"):
            key = next(iter(own.values())).key
            raise SpecError(f"{where(key)}: {key}: is of a rack that has a pinion: write it in [material]", key)
        name = spec.name("rack", default_name)
        with spec.blame("rack"):
            return cls(name=name, rack=Rack(**spec.rack_inputs("rack") | {"name": name}), **beside)

    @classmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> Spec:
        """Return the values of a spec of [rack], [material], [drawing] and [verify]. Raises SpecError."""
        require_tables_of_racks(tables, where, DesignKind.RACK, ("material", "drawing", "verify"))
        return Spec.of(tables, where)

    @property
    def described(self) -> Mapping[str, Described]:
        """The one rack of the design."""
        return {"rack": self.rack}


@dataclass(frozen=True, kw_only=True)
class SplineDesign(ToothedDesign):
    """A spline joint: a shaft, a hub, or both, and their material. Its gears are the outlines of both."""

    kind: ClassVar[DesignKind] = DesignKind.SPLINE
    elsewhere: ClassVar[str] = "a spline is for gearcad data, build, draw, mesh, check and verify"

    spline: SplineJoint
    material: Material | None = None
    load: Load | None = None
    mesh: MeshOptions | None = None

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """Return the design that [spline] describes. Raises SpecError."""
        from gearcad.geometry.spline import SplineJoint

        spec = cls.spec(tables, where)
        beside = beside_teeth(spec, tables)
        name = spec.name("spline", default_name)
        with spec.blame("spline"):
            inputs = spec.fields_of("spline") | {"name": name}
        return cls(name=name, spline=spec.simple("spline", SplineJoint, values=inputs), **beside)

    @classmethod
    def spec(cls, tables: Mapping[str, Any], where: Where) -> Spec:
        """Return the values of a spec of [spline] and of the tables beside it. Raises SpecError."""
        require_known_tables(tables, where)
        for table in tables:
            if table not in ("spline", *OF_SPLINES):
                others = ", ".join(f"[{name}]" for name in OF_SPLINES)
                raise SpecError(f"{where(table)}: [{table}] cannot stand beside [spline]: permitted are {others}")
        return Spec.of(tables, where)

    @property
    def gears(self) -> dict[str, Gear]:
        """The shaft and the hub as gears, a hub internal, each as far as it is asked for."""
        return {name: part.gear for name, part in self.spline.parts.items()}

    @property
    def described(self) -> Mapping[str, Described]:
        """Shaft, hub and their joint."""
        return {**self.spline.parts, "joint": self.spline}


OF_SPLINES = ("material", "load", "drawing", "mesh", "verify")
"""Tables that may stand beside [spline]."""


def require_tables_of_racks(tables: Mapping[str, Any], where: Where, kind: DesignKind, beside: tuple[str, ...]) -> None:
    """Raise SpecError unless all tables are those of the kind, or of these beside it."""
    require_known_tables(tables, where)
    for table in tables:
        if table not in (*MAIN_TABLES[kind], *beside):
            others = ", ".join(f"[{name}]" for name in beside)
            with_whom = "[rack]" if kind is DesignKind.RACK else "a pinion and a [rack]"
            raise SpecError(f"{where(table)}: [{table}] cannot stand beside {with_whom}: permitted are {others}")
