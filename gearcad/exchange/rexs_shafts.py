"""Shafts in REXS, there and back: sections, bearings in the casing, forces; places of components.

The axes of a shaft are u along it (z of gearcad), w (x) and v (-y): a force (F_x, F_y, F_z) is F_w, -F_v, F_u there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Protocol

from gearcad.core.quantities import schema_of
from gearcad.designs.shaft_keys import SHAFT_LISTS
from gearcad.exchange.rexs_attributes import (
    ABSORPTIONS,
    BEARING_TYPES,
    LEAST_RIGID,
    NOT_GIVEN,
    OF_BEARING,
    OF_MATERIAL,
    OF_SEGMENT,
    RIGID,
    STIFFNESSES,
    attribute_value,
    key_value,
)
from gearcad.exchange.rexs_model import ModelBuilder, RexsComponent, RexsModel, RexsValue, in_order
from gearcad.shafts.beam import ShaftBearing, ShaftForce, ShaftSegment

_BEARING_KINDS = ("concept_bearing", "rolling_bearing_with_catalog_geometry", "rolling_bearing_with_detailed_geometry")
_MOST_STIFFNESS = {"radial_stiffness": 1e9, "axial_stiffness": 1e9, "tilting_stiffness": 1e15}
"""Greatest permitted stiffness of each key; beyond, a support is rigid."""

_SAME = 1e-6
"""Distance (mm) within which sections meet."""


ShaftRows = dict[str, list[dict[str, Any]]]
"""Tables of the lists of a shaft: its segments, bearings and forces."""


class KeysLeft(Protocol):
    """The keys of a table that are still to be written."""

    left: dict[str, Any]

    def take(self, *keys: str) -> None:
        """Leave keys out."""

    def custom(self, told: list[str], quiet: Sequence[str] = ()) -> dict[str, RexsValue]:
        """Return the attributes that keep what is left."""


def placed(origin: tuple[float, float, float]) -> dict[str, RexsValue]:
    """Return the attributes that put a component at an origin (mm, along u, v, w of the gear unit), without a turn."""
    return {
        "u_axis_vector": (1.0, 0.0, 0.0),
        "w_axis_vector": (0.0, 0.0, 1.0),
        "support_vector": tuple(each + 0.0 for each in origin),
        "reference_component_for_position": 1,
    }


def add_segments(
    model: ModelBuilder, shaft: int, segments: Sequence[ShaftSegment], keys: Sequence[KeysLeft], told: list[str]
) -> None:
    """Add the sections of a shaft from left to right, and its material, that of the first."""
    first, at = segments[0], 0.0
    material = {name: getattr(first, key) for key, name, _ in OF_MATERIAL[:5]}
    attributes = {
        name: attribute_value(float(value), factor)
        for (_, name, factor), value in zip(OF_MATERIAL[:5], material.values(), strict=True)
        if value is not None
    }
    number = model.add("material", "material of a shaft", attributes)
    model.relate("reference", origin=shaft, referenced=number)
    model.extend(shaft, {NOT_GIVEN: '["material"]'})
    for segment, own in zip(segments, keys, strict=True):
        sizes: dict[str, RexsValue] = {"u_coordinate_on_shaft": at}
        sizes |= {name: float(getattr(segment, key)) for key, name, _ in OF_SEGMENT}
        own.take("length", "outer_diameter", "inner_diameter")
        part = model.add("shaft_section", "", sizes | own.custom(told))
        model.relate("assembly", assembly=shaft, part=part)
        at += segment.length


def add_bearings(
    model: ModelBuilder,
    shaft: int,
    casing: int,
    origin: float,
    bearings: Sequence[ShaftBearing],
    keys: Sequence[KeysLeft],
    told: list[str],
) -> None:
    """Add the bearings between a shaft, which begins at `origin` (mm along u), and the casing."""
    for bearing, own in zip(bearings, keys, strict=True):
        attributes: dict[str, RexsValue] = {"u_coordinate_on_shaft_outer_side": origin + bearing.position}
        for key, name, factor in OF_BEARING:
            if (value := getattr(bearing, key)) is not None:
                attributes[name] = attribute_value(float(value), factor)
                own.take(key)
        far = bearing.Y2 if bearing.Y is None else bearing.Y
        if far is not None:
            attributes["axial_factor_y_2"] = float(far)
            own.take("Y2" if bearing.Y is None else "Y")
        for key, name, factor in STIFFNESSES:
            value = getattr(bearing, key)
            attributes[name] = RIGID if isinstance(value, str) else attribute_value(float(value), factor)
            own.take(key)
        across, along = bearing.offset
        attributes |= {"misalignment_in_w_direction": across, "misalignment_in_v_direction": 0.0 - along}
        both = "both_directions" if bearing.axial_stiffness else "no_direction"
        attributes["axial_force_absorption"] = both if bearing.pushes is None else ABSORPTIONS[bearing.pushes]
        attributes["radial_force_absorption"] = bool(bearing.radial_stiffness)
        own.take("offset", "pushes", "name")
        kind = "concept_bearing"
        if bearing.kind is not None:
            kind = "rolling_bearing_with_catalog_geometry"
            attributes |= {"bearing_type": BEARING_TYPES[bearing.kind], "catalogue_designation": bearing.name}
            own.take("kind")
        part = model.add(kind, bearing.name, attributes | own.custom(told))
        model.relate("side", assembly=part, inner_part=shaft, outer_part=casing)


def add_forces(
    model: ModelBuilder, shaft: int, forces: Sequence[ShaftForce], keys: Sequence[KeysLeft], told: list[str]
) -> None:
    """Add the forces on a shaft; torques are about its axis, those of forces beside the axis included."""
    for force, own in zip(forces, keys, strict=True):
        x, y, z = force.force
        _, _, _, m_x, m_y, m_z = (float(each) for each in force.load())
        attributes: dict[str, RexsValue] = {
            "u_coordinate_on_shaft": force.position,
            "transmits_torque": False,
            **dict(zip(_FORCES, (z, 0.0 - y, x), strict=True)),
            **dict(zip(_TORQUES, (m_z / 1000, 0.0 - m_y / 1000, m_x / 1000), strict=True)),
        }
        own.take("position", "force")
        if "at" not in own.left:
            attributes |= dict(zip(_TORQUES, (force.torque, 0.0 - force.moment[1], force.moment[0]), strict=True))
            own.take("torque", "moment")
        part = model.add("external_load", "force", attributes | own.custom(told))
        model.relate("assembly", assembly=shaft, part=part)


_FORCES = ("force_u_direction", "force_v_direction", "force_w_direction")
_TORQUES = ("torque_around_u_axis", "torque_around_v_axis", "torque_around_w_axis")


def shaft_lists(model: RexsModel, shaft: RexsComponent, others: Sequence[RexsComponent], told: list[str]) -> ShaftRows:
    """Return the segments, bearings and forces of a shaft as tables of a spec; a shaft without sections has none.

    `others` are gears of other meshes on the shaft, whose forces are not taken over.
    """
    sections, begin = _sections(model, shaft)
    rows: ShaftRows = {"shaft": list(_segments(model, shaft, sections, told)), "bearing": [], "force": []}
    if not sections:
        return rows
    for other in others:
        told.append(f"{other}: the forces of its mesh on {shaft} are not taken over")
    rows["bearing"] = list(_bearings(model, shaft, begin, told))
    rows["force"] = list(_force_rows(model, shaft, begin))
    return rows


def _sections(model: RexsModel, shaft: RexsComponent) -> tuple[list[RexsComponent], float]:
    """Return the sections of a shaft from left to right, and where the first begins (mm along u)."""
    sections = in_order(model.parts(shaft.number, "shaft_section"), "u_coordinate_on_shaft")
    return sections, sections[0].needed("u_coordinate_on_shaft") if sections else 0.0


def position_on_segments(model: RexsModel, shaft: RexsComponent, place: float) -> float:
    """Return the place of something on a shaft (mm along u) from the left end of its segments."""
    return place - _sections(model, shaft)[1]


def _segments(
    model: RexsModel, shaft: RexsComponent, sections: Sequence[RexsComponent], told: list[str]
) -> Iterator[dict[str, Any]]:
    materials = [] if shaft.text(NOT_GIVEN) else model.referenced(shaft.number, "material")
    made_of: dict[str, Any] = {}
    for key, name, factor in OF_MATERIAL[:5] if materials else ():
        if (written := materials[0].float_of(name)) is not None:
            made_of[key] = key_value(written, factor)
    end = None
    for section in sections:
        at, length = section.needed("u_coordinate_on_shaft"), section.needed("length")
        if end is not None and abs(at - end) > _SAME:
            section.fault("u_coordinate_on_shaft", f" = {at:g} mm: must be {end:g}, where the section before it ends")
        end = at + length
        row: dict[str, Any] = {"length": length}
        for key in ("outer_diameter", "inner_diameter"):
            sizes = [section.float_of(f"{key}_{side}") for side in ("begin", "end")]
            given = [each for each in sizes if each is not None]
            if len(set(given)) > 1:
                told.append(f"{section}: a cone is taken as a cylinder of its mean diameter")
            if given:
                row[key] = given[0] if len(set(given)) == 1 else sum(given) / len(given)
        if "outer_diameter" not in row:
            section.needed("outer_diameter_begin")
        yield row | made_of | section.custom(_KEYS)


_KEYS = tuple(name for kind in SHAFT_LISTS.values() for name in schema_of(kind))
"""Keys of the tables of shafts."""


def _bearings(model: RexsModel, shaft: RexsComponent, begin: float, told: list[str]) -> Iterator[dict[str, Any]]:
    found = []
    for role, mate in (("inner_part", "outer_part"), ("outer_part", "inner_part")):
        for relation in model.related("side", role, shaft.number):
            if mate not in relation.roles or "assembly" not in relation.roles:
                continue
            bearing, holder = model.components[relation.roles["assembly"]], model.components[relation.roles[mate]]
            if bearing.kind not in _BEARING_KINDS or holder.kind != "gear_casing":
                told.append(f"{bearing}: is not between {shaft} and a casing: left out")
                continue
            found.append((bearing, "inner_side" if role == "inner_part" else "outer_side"))
    for bearing, side in found:
        yield _bearing(bearing, bearing.needed(f"u_coordinate_on_shaft_{side}") - begin)


def _bearing(bearing: RexsComponent, position: float) -> dict[str, Any]:
    row: dict[str, Any] = {"position": position}
    name = bearing.text("catalogue_designation") or bearing.name
    if name:
        row["name"] = name
    kinds = {written: kind for kind, written in BEARING_TYPES.items()}
    if (kind := kinds.get(bearing.text("bearing_type") or "")) is not None:
        row["kind"] = kind
    for key, attribute, factor in OF_BEARING[1:]:
        if (written := bearing.float_of(attribute)) is not None:
            row[key] = key_value(written, factor)
    if (far := bearing.float_of("axial_factor_y_2")) is not None:
        row["Y2" if kind == "spherical" else "Y"] = far
    absorption = bearing.text("axial_force_absorption") or "no_direction"
    for key, attribute, factor in STIFFNESSES:
        written = bearing.float_of(attribute)
        if written is None:
            if key == "axial_stiffness" and absorption != "no_direction":
                row[key] = "rigid"
            continue
        value = key_value(written, factor)
        row[key] = "rigid" if written >= LEAST_RIGID or value > _MOST_STIFFNESS[key] else value
    sides = {written: side for side, written in ABSORPTIONS.items()}
    if absorption in sides:
        row["pushes"] = sides[absorption]
    across, along = (bearing.float_of(f"misalignment_in_{axis}_direction") or 0.0 for axis in "wv")
    if across or along:
        row["offset"] = [across, 0.0 - along]
    return row | bearing.custom(_KEYS)


def _force_rows(model: RexsModel, shaft: RexsComponent, begin: float) -> Iterator[dict[str, Any]]:
    for load in model.parts(shaft.number, "external_load"):
        u, v, w = (load.float_of(name) or 0.0 for name in _FORCES)
        m_u, m_v, m_w = (load.float_of(name) or 0.0 for name in _TORQUES)
        through = load.flag("transmits_torque")
        if not (u or v or w or m_v or m_w or (m_u and not through)):
            continue
        row: dict[str, Any] = {"position": load.needed("u_coordinate_on_shaft") - begin, "force": [w, 0.0 - v, u]}
        own = load.custom(_KEYS)
        if "at" not in own:
            row |= {} if through or not m_u else {"torque": m_u}
            row |= {"moment": [m_w, 0.0 - m_v]} if m_v or m_w else {}
        yield row | own


def coupling_position(model: RexsModel, shaft: RexsComponent, others: Sequence[RexsComponent]) -> float | None:
    """Return where a shaft takes or gives its torque (mm along u): at a load, else at another gear; or None."""
    for load in model.parts(shaft.number, "external_load"):
        if load.flag("transmits_torque"):
            return load.float_of("u_coordinate_on_shaft")
    return others[0].float_of("u_coordinate_on_shaft") if others else None
