"""Shafts of a train as beams: their segments, bearings and gears in a spec, and the forces that the meshes put on them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad.core.errors import GeometryError, InputError, ParameterError, SpecError, format_number, shown
from gearcad.core.records import PerGear, Role
from gearcad.designs.design import Where, read_tables
from gearcad.designs.shaft_spec import MountedShaft, PairShafts, ShaftArrangement, read_part
from gearcad.dynamics.trains.members import MeshPair, Shaft
from gearcad.dynamics.trains.shaft_layout import ShaftGear, ShaftLayout
from gearcad.dynamics.trains.train import Train
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.shafts.arrangement import ShaftOptions, with_stations
from gearcad.shafts.beam import GearForce, ShaftBearing, ShaftForce, ShaftSegment, SteppedShaft
from gearcad.shafts.face_load import FaceOnShafts, require_modelled

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

LAYOUT_LISTS: dict[str, type[DataclassInstance]] = {
    "segments": ShaftSegment,
    "bearings": ShaftBearing,
    "gears": ShaftGear,
    "forces": ShaftForce,
}
"""Lists of a shaft of a train, and what each table in them makes."""

LAYOUT_KEYS = (*LAYOUT_LISTS, "coupling")
"""Keys of a shaft of a train that make its layout; they may stand in a file, whose name is its `layout`."""

_OF_MESHES = ("mesh_angle", "speed", "coupling", "misalignment")
"""Options of shafts that each mesh or shaft of a train has of its own."""


# ---------------------------------------------------------------------- from a spec


def read_layout(given: dict[str, Any], where: Where, owner: str) -> None:
    """Replace the keys of a shaft's layout, or the name of their file, by the layout itself, in place. Raises SpecError."""
    if (file := given.get("layout")) is not None:
        key = f"{owner}.layout"
        if isinstance(file, Mapping):
            given["layout"] = _layout(file, where, key)
            return
        if not isinstance(file, str) or not file.strip() or "\0" in file:
            permitted = 'must be a file with segments, bearings and gears, as in layout = "shaft-2.toml"'
            raise SpecError(f"{where(key)}: {shown(key)} = {format_number(file)}: {permitted}", key)
        for beside in LAYOUT_KEYS:
            if beside in given:
                written = f"{owner}.{beside}"
                raise SpecError(
                    f"{where(written)}: {shown(written)}: must be left out beside layout, whose file has it", written
                )
        tables, inside = read_tables(Path(file))
        given["layout"] = _layout(tables, inside, "")
    elif own := {key: given.pop(key) for key in LAYOUT_KEYS if key in given}:
        given["layout"] = _layout(own, where, owner)


def _layout(given: Mapping[str, Any], where: Where, owner: str) -> ShaftLayout:
    def full(key: str) -> str:
        return f"{owner}.{key}" if owner else key

    for key in given:
        if key not in LAYOUT_KEYS:
            permitted = ", ".join(LAYOUT_KEYS)
            raise SpecError(f"{where(full(key))}: {shown(full(key))}: unknown key; permitted are {permitted}", full(key))
    if "segments" not in given:
        first = full(next(iter(given), "segments"))
        raise SpecError(f"{where(first)}: {shown(first)}: needs segments of the shaft", first)
    parts: dict[str, Any] = {}
    for name, kind in LAYOUT_LISTS.items():
        listed = given.get(name, [])
        if not isinstance(listed, list):
            permitted = "must be a list of tables, one for each"
            raise SpecError(f"{where(full(name))}: {shown(full(name))}: {permitted}", full(name))
        parts[name] = tuple(read_part(kind, each, f"{full(name)}[{number}]", where) for number, each in enumerate(listed))
    coupling = given.get("coupling")
    coupling = float(coupling) if isinstance(coupling, int) and not isinstance(coupling, bool) else coupling
    try:
        found = ShaftLayout(**parts, coupling=coupling)
        if found.bearings:
            found.stepped().compliance  # noqa: B018 - a loose shaft is told now
    except InputError as error:
        name, bracket, place = error.parameter.partition("[")
        key, unit = full(_NAMES.get(name, name) + bracket + place), f" {error.unit}" if error.unit else ""
        raise SpecError(f"{where(key)}: {shown(key)} = {format_number(error.value)}{unit}: {error.permitted}", key) from error
    return found


_NAMES = {"bearing": "bearings", "shaft": "segments", "force": "forces"}
"""Lists of a layout by the names that a beam has for them."""


def read_shaft_options(content: Any, where: Where) -> ShaftOptions:
    """Return the options of [shafts] beside [train]. Raises SpecError."""
    for key in content if isinstance(content, Mapping) else ():
        if key in _OF_MESHES:
            home = "[[train.mesh]]" if key == "mesh_angle" else "[[train.shaft]]" if key == "coupling" else "[train]"
            permitted = (
                f"must be left out beside [train]: {home} has it"
                if key != "misalignment"
                else "must be left out beside [train]"
            )
            raise SpecError(f"{where(f'shafts.{key}')}: shafts.{key}: {permitted}", f"shafts.{key}")
    return read_part(ShaftOptions, content, "shafts", where)


# ---------------------------------------------------------------------- under the loads of the train


def gear_force(pair: GearPair, torque: float, role: Role, mesh_angle: float, position: float) -> GearForce:
    """Return the force of a mesh on one of its gears, in the middle of the face at `position` (mm) of its shaft.

    `torque` (N·m) is that on the pinion; it acts at the pitch point, which gives the torque on the gear too. Raises
    GeometryError for rings and double helical gears.
    """
    require_modelled(pair)
    sign = -1 if torque < 0 else 1
    rigid: PerGear[SteppedShaft | None] = PerGear(None, None)
    face = FaceOnShafts.of(pair, sign, rigid, PerGear(0.0, 0.0), mesh_angle, 2)
    base_force = 2000 * abs(torque) / pair.pinion.base_diameter
    along = face.direction * (base_force if role is Role.WHEEL else -base_force)
    x, y, z = (float(each) for each in along)
    lever_x, lever_y, _ = face.lever(role)
    return GearForce(position=position, force=(x, y, z), at=(float(lever_x), float(lever_y)))


def gears_of(shaft: Shaft) -> tuple[ShaftGear, ...]:
    """Return the gears on a shaft; none of one without segments."""
    return () if shaft.layout is None else shaft.layout.gears


def require_faces(train: Train) -> None:
    """Raise GeometryError or ParameterError for a gear without a pair, on two shafts, or whose face is not on its shaft."""
    taken: dict[tuple[str, Role], str] = {}
    meshes = {mesh.name: mesh for mesh in train.meshes}
    for shaft in train.shafts:
        for number, gear in enumerate(gears_of(shaft)):
            key, pair = f"{shaft.name}.gears[{number}]", meshes[gear.mesh].pair
            if not isinstance(pair, MeshPair):
                raise ParameterError(f"{key}.mesh", gear.mesh, "must be a mesh with a pair: it has the face and the forces")
            if (other := taken.setdefault((gear.mesh, gear.role), shaft.name)) != shaft.name:
                raise ParameterError(f"{key}.mesh", gear.mesh, f"must be given once: its {gear.role.value} is on {other}")
            assert shaft.layout is not None
            low, high = pair.pair.common_width.width / 2, shaft.layout.length - pair.pair.common_width.width / 2
            if not low - _ENDS <= gear.position <= high + _ENDS:
                permitted = f"must be from {low:g} to {high:g} mm, so that the face is on the shaft"
                raise GeometryError(f"{key}.position", gear.position, permitted, "mm")


_ENDS = 1e-9
"""Distance (mm) by which a face may lie beyond the end of a shaft by rounding."""


def shaft_beams(
    train: Train, loads: Mapping[str, Load], options: ShaftOptions, without: tuple[str, Role] | None = None
) -> Iterator[tuple[Shaft, SteppedShaft]]:
    """Yield the shafts with segments and bearings as beams under the forces of their gears.

    `loads` are those of the pairs by the names of meshes, application factors included; that of `without` is left out.
    """
    meshes = {mesh.name: mesh for mesh in train.meshes}
    for shaft in train.shafts:
        if shaft.layout is None or not shaft.layout.bearings:
            continue
        forces = []
        for gear in shaft.layout.gears:
            mesh, load = meshes[gear.mesh], loads[gear.mesh]
            assert isinstance(mesh.pair, MeshPair)
            if (gear.mesh, gear.role) == without:
                continue
            torque = load.torque * load.application_factor
            try:
                forces.append(gear_force(mesh.pair.mounted, torque, gear.role, mesh.mesh_angle, gear.position))
            except InputError as error:
                raise error.within(mesh.name) from error
        yield shaft, shaft.layout.stepped(forces, options.gravity, options.stations)


def train_arrangement(name: str, train: Train, loads: Mapping[str, Load], options: ShaftOptions) -> ShaftArrangement | None:
    """Return the shafts of a train with segments and bearings, under the forces of all their gears; None without any."""
    ratios = train.speed_ratios
    found = dict(shaft_beams(train, loads, options))
    if not found:
        return None
    turned = {shaft.name: ratios[shaft.end if shaft.start not in ratios else shaft.start] * train.speed for shaft in found}
    return ShaftArrangement(name, {shaft.name: with_stations(beam) for shaft, beam in found.items()}, turned, options)


def mesh_shafts(train: Train, mesh: str, loads: Mapping[str, Load], options: ShaftOptions) -> PairShafts | None:
    """Return the shafts of a mesh's gears as those of a pair: forces of the other gears on them are given; None without any."""
    angle = next(each.mesh_angle for each in train.meshes if each.name == mesh)

    def mounted(role: Role) -> MountedShaft | None:
        for shaft, beam in shaft_beams(train, loads, options, without=(mesh, role)):
            for gear in gears_of(shaft):
                if (gear.mesh, gear.role) == (mesh, role):
                    return MountedShaft(shaft=beam, mesh_position=gear.position)
        return None

    found = PerGear.each(mounted)
    if not any(found):
        return None
    torque = loads[mesh].torque * loads[mesh].application_factor
    return PairShafts(gears=found, options=replace(options, mesh_angle=angle), forces_torque=torque)
