"""Shafts of a spec: [[shaft]], [[bearing]], [[force]] of one by itself, or of [pinion] and [wheel] of a pair; [shafts]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from gearcad.contact.shared.face_load import MeshOnShafts
from gearcad.core.errors import InputError, SpecError, format_number, shown
from gearcad.core.quantities import schema_of
from gearcad.core.records import PerGear, Role
from gearcad.designs.design import Where, read_tables, require_plain_name
from gearcad.designs.keys import OF_SHAFTS, SHAFTS, DesignKind, has_shafts, without_shafts
from gearcad.designs.reader import design_from_tables, kind_of
from gearcad.shafts.arrangement import ShaftOptions, with_stations
from gearcad.shafts.beam import ShaftBearing, ShaftForce, ShaftSegment, SteppedShaft

_LISTS = dict(zip(OF_SHAFTS, (ShaftSegment, ShaftBearing, ShaftForce), strict=True))
"""Lists of tables, and what each table makes."""

Part = TypeVar("Part")


@dataclass(frozen=True)
class ShaftArrangement:
    """Shafts by their names with their speeds (rpm), their options, and the mesh of a pair."""

    name: str
    shafts: Mapping[str, SteppedShaft]
    speeds: Mapping[str, float]
    options: ShaftOptions
    mesh: MeshOnShafts | None = None


def read_arrangement(path: Path | str) -> ShaftArrangement:
    """Return the shafts of a spec. Raises SpecError."""
    tables, where = read_tables(path)
    name = Path(path).stem
    if "shaft" in tables or "bearing" in tables:
        return _alone(tables, where, name)
    if kind_of(tables) is not DesignKind.PAIR or not has_shafts(tables):
        permitted = "must have [[shaft]] and [[bearing]], or a pair with [[pinion.shaft]] or [[wheel.shaft]]"
        raise SpecError(f"{where('')}: {permitted}")
    return _of_pair(tables, where, name)


def _alone(tables: Mapping[str, Any], where: Where, name: str) -> ShaftArrangement:
    """Return a shaft by itself."""
    for table in tables:
        if table not in (*_LISTS, SHAFTS):
            permitted = ", ".join(f"[[{each}]]" for each in _LISTS)
            raise SpecError(
                f"{where(table)}: [{shown(table)}] cannot stand beside [[shaft]]: permitted are {permitted}, [{SHAFTS}]"
            )
    options = _options(tables, where)
    shaft = _shaft(tables, "", options.coupling, options, where)
    require_plain_name(name)
    return ShaftArrangement(name, {"shaft": shaft}, {"shaft": options.speed}, options)


def _of_pair(tables: Mapping[str, Any], where: Where, name: str) -> ShaftArrangement:
    """Return the shafts of a pair's gears, and their mesh under the pair's load."""
    from gearcad.designs.pair_designs import PairDesign
    from gearcad.rating.tooth_stiffness import mesh_stiffness

    design = design_from_tables(without_shafts(tables), where=where, default_name=name)
    assert isinstance(design, PairDesign)
    load, options, pair = design.loaded("shafts are loaded by it"), _options(tables, where), design.pair
    if pair.internal:
        raise SpecError(
            f"{where('wheel.teeth')}: wheel.teeth = {pair.wheel.teeth}: must be above 0: shafts of rings are not made"
        )
    shafts, positions = dict[Role, SteppedShaft](), dict[Role, float]()
    for role in Role:
        own = tables[role.value]
        if "shaft" not in own:
            continue
        coupling = _number(own, "coupling", role, where, 0.0)
        shafts[role] = _shaft(own, f"{role.value}.", coupling, options, where)
        positions[role] = _mesh_position(own, role, shafts[role], pair.common_width.width, where)
    torque = load.torque * load.application_factor
    stiffness = options.face_mesh_stiffness
    if stiffness is None:
        force = 2000 * abs(torque) / pair.pinion.reference_diameter
        stiffness = float(mesh_stiffness(pair, design.materials, force / pair.common_width.width).mesh_beta)
    crowned = sum(gear.modification.lead_crowning for gear in pair.gears)
    mesh = MeshOnShafts(
        pair=pair,
        torque=torque,
        shafts=PerGear.each(shafts.get),
        positions=PerGear.each(lambda role: positions.get(role, 0.0)),
        mesh_angle=options.mesh_angle,
        stiffness=stiffness,
        slices=options.slices,
        crowning=crowned,
        slope=options.misalignment,
    )
    speeds = {Role.PINION: load.speed, Role.WHEEL: load.speed / pair.gear_ratio}
    named = {role.value: shaft for role, shaft in shafts.items()}
    return ShaftArrangement(design.name, named, {role.value: speeds[role] for role in shafts}, options, mesh)


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
    return _made(ShaftOptions, tables.get(SHAFTS, {}), SHAFTS, where)


def _shaft(own: Mapping[str, Any], owner: str, coupling: float, options: ShaftOptions, where: Where) -> SteppedShaft:
    """Return the shaft of a table's lists."""
    parts: dict[str, tuple[Any, ...]] = {}
    for name, kind in _LISTS.items():
        listed = own.get(name, [])
        key = f"{owner}{name}"
        if not isinstance(listed, list):
            raise SpecError(f"{where(key)}: {key}: must be headed [[{key}]], once for each", key)
        parts[name] = tuple(_made(kind, each, f"{key}[{number}]", where) for number, each in enumerate(listed))
    try:
        shaft = SteppedShaft(
            segments=parts["shaft"],
            bearings=parts["bearing"],
            forces=parts["force"],
            coupling=coupling,
            gravity=options.gravity,
            places=options.stations,
        )
        shaft = with_stations(shaft)
        shaft.compliance  # noqa: B018 - a loose shaft is told now
    except InputError as error:
        key, unit = f"{owner}{error.parameter}", f" {error.unit}" if error.unit else ""
        raise SpecError(f"{where(key)}: {key} = {format_number(error.value)}{unit}: {error.permitted}", key) from error
    return shaft


def _made(kind: type[Part], content: Any, key: str, where: Where) -> Part:
    """Return what the table under a key makes. Raises SpecError."""
    if not isinstance(content, Mapping):
        raise SpecError(f"{where(key)}: {shown(key)} = {format_number(content)}: must be a table", key)
    schema = schema_of(kind)  # type: ignore[arg-type]
    for name in content:
        if name not in schema:
            full = f"{key}.{name}"
            raise SpecError(f"{where(full)}: {shown(full)}: unknown key; permitted are {', '.join(schema)}", full)
    given = {name: _plain(value, whole=schema[name].whole) for name, value in content.items()}
    missing = {name: None for name, field in schema.items() if field.required and name not in given}
    try:
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
