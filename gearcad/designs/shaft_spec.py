"""Shafts of a spec: [[shaft]], [[bearing]], [[force]] of one by itself, or of [pinion] and [wheel] of a pair; [shafts]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeVar

from gearcad.core.errors import InputError, SpecError, format_number, shown
from gearcad.core.quantities import schema_of
from gearcad.core.records import JsonObject, PerGear, Role
from gearcad.designs.design import Design, Where
from gearcad.designs.keys import OF_SHAFTED_GEARS, SHAFTS, DesignKind, has_shafts
from gearcad.designs.shaft_keys import SHAFT_LISTS
from gearcad.geometry import Gear, GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.rating.load_factors import FaceLoad, FaceLoadSource
from gearcad.rating.options import LoadBin, RatingOptions
from gearcad.rating.tooth_stiffness import mesh_stiffness
from gearcad.shafts.arrangement import ShaftOptions, with_stations
from gearcad.shafts.beam import ShaftBearing, ShaftSegment, SteppedShaft, core_diameter
from gearcad.shafts.bearing_shelf import bearing_of
from gearcad.shafts.face_load import MeshOnShafts, require_modelled
from gearcad.shafts.whirl import ShaftDisc, ring_disc

if TYPE_CHECKING:
    from gearcad.drawing.options import DrawingOptions

Part = TypeVar("Part")

_DRAWING = "drawing"
"""Table of the drawings' options, which a shaft by itself may have."""


@dataclass(frozen=True, kw_only=True)
class MountedShaft:
    """A shaft of a gear, with the middle of the common face at `mesh_position` (mm from its left end)."""

    shaft: SteppedShaft
    mesh_position: float


@dataclass(frozen=True, kw_only=True)
class PairShafts:
    """The shafts of both gears of a pair, None for a rigid one, and their options.

    `forces_torque` is the torque (N·m on the pinion) at which the forces of other meshes on these shafts hold.
    """

    gears: PerGear[MountedShaft | None]
    options: ShaftOptions
    forces_torque: float | None = None

    @property
    def mounted(self) -> dict[Role, MountedShaft]:
        """The shafts that are described."""
        return {role: own for role, own in self.gears.items() if own is not None}


@dataclass(frozen=True)
class ShaftArrangement:
    """Shafts by their names, with stations at whole steps, their speeds (rpm) and options.

    Of a pair the names are those of its gears, `positions` (mm) are the middles of the face on the shafts, and `mesh` is their
    mesh under the pair's load, None without a load.
    """

    name: str
    shafts: Mapping[str, SteppedShaft]
    speeds: Mapping[str, float]
    options: ShaftOptions
    positions: Mapping[str, float] = field(default_factory=dict)
    mesh: MeshOnShafts | None = None
    spectrum: tuple[LoadBin, ...] = ()
    """Loads of the rating's spectrum, as shares of the mesh's torque and of the speeds."""

    discs: Mapping[str, tuple[ShaftDisc, ...]] = field(default_factory=dict)
    """Gears on the shafts, as full discs up to their reference diameters around the shaft."""


@dataclass(frozen=True, kw_only=True)
class ShaftDesign(Design):
    """A shaft by itself on its bearings, under given forces, with its options."""

    kind: ClassVar[DesignKind] = DesignKind.SHAFT
    elsewhere: ClassVar[str] = "a shaft by itself is for `gearcad data`, build, draw, picture and shafts"

    shaft: SteppedShaft
    shafts: ShaftOptions = field(default_factory=ShaftOptions)
    drawing: DrawingOptions | None = None

    @classmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """Return the design that [[shaft]], [[bearing]], [[force]] and [shafts] describe. Raises SpecError."""
        for table in tables:
            if table not in (*SHAFT_LISTS, SHAFTS, _DRAWING):
                permitted = ", ".join([*(f"[[{each}]]" for each in SHAFT_LISTS), f"[{SHAFTS}], [{_DRAWING}]"])
                raise SpecError(f"{where(table)}: [{shown(table)}] cannot stand beside [[shaft]]: permitted are {permitted}")
        own = dict(tables.get(SHAFTS, {})) if isinstance(tables.get(SHAFTS), Mapping) else {}
        name = own.pop("name", default_name)
        options = _options({**tables, SHAFTS: own} if own or SHAFTS not in tables else tables, where)
        drawing = None
        if _DRAWING in tables:
            from gearcad.designs.spec import Spec
            from gearcad.drawing.options import DrawingOptions

            if not isinstance(tables[_DRAWING], Mapping):
                raise SpecError(f"{where(_DRAWING)}: {_DRAWING}: must be a table, headed [{_DRAWING}]", _DRAWING)
            drawing = Spec.of({_DRAWING: tables[_DRAWING]}, where).simple(_DRAWING, DrawingOptions)
        shaft = _shaft(tables, "", options.coupling, options, where)
        try:
            return cls(name=name, shaft=shaft, shafts=options, drawing=drawing)
        except InputError as error:
            key = f"{SHAFTS}.name"
            raise SpecError(f"{where(key)}: {SHAFTS}.{error}", key) from error

    @property
    def arrangement(self) -> ShaftArrangement:
        """The shaft with stations and its speed."""
        return ShaftArrangement(self.name, {"shaft": with_stations(self.shaft)}, {"shaft": self.shafts.speed}, self.shafts)

    def to_dict(self) -> JsonObject:
        """Return the document of `data.json`: the shaft's sizes, sections, bearings and mass."""
        return {**super().to_dict(), "shaft": self.shaft.sizes()}


def read_pair_shafts(tables: Mapping[str, Any], pair: GearPair, where: Where) -> PairShafts | None:
    """Return the shafts that the tables of a pair's spec describe, or None. Raises SpecError."""
    if not has_shafts(tables):
        return None
    try:
        require_modelled(pair)
    except InputError as error:
        key, unit = error.parameter, f" {error.unit}" if error.unit else ""
        raise SpecError(f"{where(key)}: {key} = {format_number(error.value)}{unit}: {error.permitted}", key) from error
    options = _options(tables, where)

    def mounted(role: Role) -> MountedShaft | None:
        own = tables.get(role.value, {})
        described = next((key for key in OF_SHAFTED_GEARS if key in own), None)
        if described is None:
            return None
        if "shaft" not in own:
            key = f"{role.value}.{described}"
            raise SpecError(f"{where(key)}: {key}: needs the shaft: segments headed [[{role.value}.shaft]]", key)
        shaft = _shaft(own, f"{role.value}.", _number(own, "coupling", role, where, 0.0), options, where)
        return MountedShaft(shaft=shaft, mesh_position=_mesh_position(own, role, shaft, pair.common_width.width, where))

    found = PerGear.each(mounted)
    if not any(found):
        permitted = f"needs a shaft: segments headed {' or '.join(f'[[{role.value}.shaft]]' for role in Role)}"
        raise SpecError(f"{where(SHAFTS)}: [{SHAFTS}]: {permitted}", SHAFTS)
    return PairShafts(gears=found, options=options)


def pair_arrangement(
    shafts: PairShafts,
    pair: GearPair,
    load: Load | None,
    materials: PerGear[Material],
    *,
    mounting: Mounting | None = None,
    rating: RatingOptions | None = None,
) -> ShaftArrangement:
    """Return the arrangement of a pair's shafts, with their mesh under the load where there is one with a torque."""
    mounted = {role.value: each for role, each in shafts.mounted.items()}
    speed = 0.0 if load is None else load.speed
    speeds = {Role.PINION.value: speed, Role.WHEEL.value: speed / pair.gear_ratio}
    found = ShaftArrangement(
        pair.name,
        {name: with_stations(each.shaft) for name, each in mounted.items()},
        {name: speeds[name] for name in mounted},
        shafts.options,
        {name: each.mesh_position for name, each in mounted.items()},
    )
    discs = {role.value: _discs(own, pair.gears.pick(role), materials.pick(role)) for role, own in shafts.mounted.items()}
    found = replace(found, discs=discs)
    if load is None or not load.torque:
        return found
    mounting = mounting or Mounting()
    mesh = MeshOnShafts(
        pair=mounting.mounted(pair),
        torque=load.torque * load.application_factor,
        shafts=PerGear.each(lambda role: found.shafts.get(role.value)),
        positions=PerGear.each(lambda role: found.positions.get(role.value, 0.0)),
        mesh_angle=found.options.mesh_angle,
        slices=found.options.slices,
        misalignment=mounting.misalignment,
        forces_torque=shafts.forces_torque,
    )
    rating = rating or RatingOptions()
    return replace(found, mesh=loaded_mesh(mesh, rating, materials), spectrum=rating.bins)


def _discs(mounted: MountedShaft, gear: Gear, material: Material) -> tuple[ShaftDisc, ...]:
    """Return a gear as a disc around its shaft, if it is larger."""
    disc = ring_disc(
        mounted.mesh_position,
        outer_diameter=gear.reference_diameter,
        inner_diameter=mounted.shaft.segment_at(mounted.mesh_position).outer_diameter,
        width=gear.face_width,
        density=material.density,
    )
    return () if disc is None else (disc,)


def loaded_mesh(mesh: MeshOnShafts, options: RatingOptions, materials: PerGear[Material]) -> MeshOnShafts:
    """Return the mesh with c_gammabeta and f_ma of the rating's options, to the worse side where both count.

    c_gammabeta is that of ISO 6336-1 under the mesh's load if none is given; f_ma is 0 then.
    """
    pair, stiffness = mesh.pair, options.face_mesh_stiffness
    if stiffness is None:
        force = 2000 * abs(mesh.torque) / pair.pinion.reference_diameter
        stiffness = float(mesh_stiffness(pair, materials, force / mesh.width).mesh_beta)
    sides = options.sides_of(options.manufacturing_misalignment or 0.0)
    found = [replace(mesh, stiffness=stiffness, misalignment=mesh.misalignment + side) for side in sides]
    return max(found, key=lambda each: each.face_load_factor)


def face_load_of(mesh: MeshOnShafts, misalignment: float = 0.0) -> FaceLoadSource:
    """Return the function by which a rating finds the load over the face of a mesh on its shafts.

    `misalignment` (µm over the face) is that of the mounting, to which that by manufacture is added.
    """
    rigid = [role.value for role, shaft in mesh.shafts.items() if shaft is None]
    assumed = tuple(f"K_Hbeta: the {name} has no shaft in the design and is held rigidly" for name in rigid)

    def found(torque: float, stiffness: float, manufacture: float) -> FaceLoad:
        loaded = replace(mesh, torque=torque, stiffness=stiffness, misalignment=misalignment + manufacture)
        return FaceLoad(
            factor=loaded.face_load_factor,
            factor_at_end=loaded.face_load_factor_at_end,
            deflection=loaded.misalignment_of_shafts,
            misalignment=loaded.misalignment,
            carrying=float((loaded.line_load > 0).mean()),
            assumed=assumed,
        )

    return found


def _mesh_position(own: Mapping[str, Any], role: Role, shaft: SteppedShaft, width: float, where: Where) -> float:
    """Return the middle of the face on a shaft (mm). Raises SpecError for a face that is not on it."""
    key = f"{role.value}.mesh_position"
    if "mesh_position" not in own:
        raise SpecError(f"{where(role.value)}: {key} is missing: the middle of the common face width on the shaft, in mm", key)
    position = _number(own, "mesh_position", role, where, 0.0)
    low, high = width / 2, shaft.length - width / 2
    if not low - 1e-9 <= position <= high + 1e-9:
        permitted = f"must be from {low:g} to {high:g} mm, so that the face is on the shaft"
        raise SpecError(f"{where(key)}: {key} = {position:g} mm: {permitted}", key)
    return position


def _number(own: Mapping[str, Any], key: str, role: Role, where: Where, default: float) -> float:
    value = own.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int | float):
        full = f"{role.value}.{key}"
        raise SpecError(f"{where(full)}: {full} = {format_number(value)}: must be a number, in mm", full)
    return float(value)


def _options(tables: Mapping[str, Any], where: Where) -> ShaftOptions:
    return read_part(ShaftOptions, tables.get(SHAFTS, {}), SHAFTS, where)


def _shaft(own: Mapping[str, Any], owner: str, coupling: float, options: ShaftOptions, where: Where) -> SteppedShaft:
    """Return the shaft of a table's lists."""
    parts: dict[str, tuple[Any, ...]] = {}
    for name, kind in SHAFT_LISTS.items():
        listed = own.get(name, [])
        key = f"{owner}{name}"
        if not isinstance(listed, list):
            raise SpecError(f"{where(key)}: {key}: must be headed [[{key}]], once for each", key)
        parts[name] = tuple(read_part(kind, each, f"{key}[{number}]", where) for number, each in enumerate(listed))
    try:
        shaft = SteppedShaft(
            segments=parts["shaft"],
            bearings=parts["bearing"],
            forces=parts["force"],
            coupling=coupling,
            gravity=options.gravity,
            places=options.stations,
        )
        shaft.compliance  # noqa: B018 - a loose shaft is told now
    except InputError as error:
        key, unit = f"{owner}{error.parameter}", f" {error.unit}" if error.unit else ""
        raise SpecError(f"{where(key)}: {key} = {format_number(error.value)}{unit}: {error.permitted}", key) from error
    return shaft


def read_part(kind: type[Part], content: Any, key: str, where: Where) -> Part:
    """Return what the table under a key makes. Raises SpecError."""
    if not isinstance(content, Mapping):
        raise SpecError(f"{where(key)}: {shown(key)} = {format_number(content)}: must be a table", key)
    schema = schema_of(kind)  # type: ignore[arg-type]
    for name in content:
        if name not in schema:
            full = f"{key}.{name}"
            raise SpecError(f"{where(full)}: {shown(full)}: unknown key; permitted are {', '.join(schema)}", full)
    given = {name: _plain(value, whole=schema[name].whole) for name, value in content.items()}
    if kind is ShaftBearing and isinstance(name := given.get("name"), str):
        given = {**bearing_of(name), **given}
    try:
        if kind is ShaftSegment and isinstance(spline := given.get("spline"), str) and "outer_diameter" not in given:
            given["outer_diameter"] = core_diameter(spline)
        missing = {name: None for name, field in schema.items() if field.required and name not in given}
        return kind(**given | missing)
    except InputError as error:
        full = f"{key}.{error.parameter}"
        if error.value is None:
            raise SpecError(f"{where(full)}: {full} is missing: {error.permitted}", full) from error
        unit = f" {error.unit}" if error.unit else ""
        raise SpecError(f"{where(full)}: {full} = {format_number(error.value)}{unit}: {error.permitted}", full) from error


def _plain(value: Any, *, whole: bool) -> Any:
    """Return a value with whole numbers as floats where floats are meant, lists as tuples."""
    if isinstance(value, list):
        return tuple(_plain(each, whole=whole) for each in value)
    return float(value) if isinstance(value, int) and not isinstance(value, bool) and not whole else value
