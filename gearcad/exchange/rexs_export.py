"""Export of gears and pairs as REXS: gears with flanks, tools and modifications, materials, oil, load, shafts and bearings.

What REXS has no attribute for is kept under names of our own, and told in `RexsExport.kept`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import reduce
from typing import Any

from gearcad.core.errors import ParameterError
from gearcad.core.records import Role
from gearcad.designs import Design, GearDesign, PairDesign
from gearcad.designs.spec_writers import SpecTables, gear_tables, pair_tables
from gearcad.exchange.rexs_attributes import (
    NOT_GIVEN,
    OF_CUTTER,
    OF_FLANK,
    OF_GEAR,
    OF_LUBRICANT,
    OF_MATERIAL,
    OF_MODIFICATIONS,
    OF_PREMACHINING,
    OF_SETTINGS,
    OF_TOOL,
    SERIES,
    SHAPES,
    STEP,
    KeyAttribute,
    attribute_value,
    custom_id,
    finished_shift,
)
from gearcad.exchange.rexs_model import ModelBuilder, RexsValue
from gearcad.exchange.rexs_shafts import add_bearings, add_forces, add_segments, placed
from gearcad.geometry import Gear
from gearcad.geometry.involute import tangent_length
from gearcad.material import Material
from gearcad.rating.material_limits import hardness_scale

_OWN_SIZES = ("tip_diameter", "root_diameter")
"""Diameters that other programs get although they follow from other keys."""


@dataclass(frozen=True)
class RexsExport:
    """The text of a file of REXS for a design, and a line for each key that REXS has no attribute for."""

    name: str
    text: str
    kept: tuple[str, ...]


class _KeysLeft:
    """The keys of a table that are still to be written, and the lines about those that REXS does not have."""

    def __init__(self, table: str, values: Mapping[str, Any]) -> None:
        self.table, self.left = table, dict(values)

    def take(self, *keys: str) -> None:
        """Leave keys out of what is to be written, as attributes of REXS say the same."""
        for key in keys:
            self.left.pop(key, None)

    def custom(self, told: list[str], quiet: Sequence[str] = ()) -> dict[str, RexsValue]:
        """Return the attributes that keep what is left, and tell them but for those that attributes of REXS imply."""
        for key in self.left:
            if key not in quiet:
                where = f"{self.table}.{key}"
                told.append(f"{where}: REXS has no attribute for it; kept as {custom_id(key)}, for gearcad alone")
        return {custom_id(key): _json(value) for key, value in self.left.items()}


def _json(value: Any) -> str:
    """Return a value of a key as JSON."""
    if isinstance(value, Enum):
        value = value.value
    if isinstance(value, float):
        value = float(value)
    return json.dumps(value, ensure_ascii=False, default=lambda each: each.value)


def _not_given(keys: Sequence[str]) -> dict[str, RexsValue]:
    """Return the attribute that lists keys which follow from others; none where there are none."""
    return {NOT_GIVEN: _json(list(keys))} if keys else {}


def _value(owner: Any, key: str) -> Any:
    """Return the value of a dotted key, as a number or a text."""
    value = reduce(lambda of, part: getattr(of, part, None), key.split("."), owner)
    return value.value if isinstance(value, Enum) else value


def _attributes(owner: Any, pairs: Sequence[KeyAttribute], keys: _KeysLeft) -> dict[str, RexsValue]:
    """Return the attributes that say what keys of an object say, and take those keys; what is not there is left out."""
    found: dict[str, RexsValue] = {}
    for key, attribute, factor in pairs:
        value = _value(owner, key)
        if isinstance(value, float | int) and not math.isnan(value):
            found[attribute] = attribute_value(float(value), factor)
            keys.take(key)
    return found


def export_rexs(design: Design) -> RexsExport:
    """Return the file of REXS for a gear or a pair. Raises ParameterError for another kind of design."""
    if not isinstance(design, GearDesign | PairDesign):
        permitted = "must be a gear or a pair: planetary sets, racks, splines, shafts by themselves and trains are not exported"
        raise ParameterError("kind", design.kind.value, permitted)
    return _RexsWriter(design).made()


def _without_tools(design: GearDesign | PairDesign) -> GearDesign | PairDesign:
    """Return the design whose gears say themselves what their tools of the shelf say."""
    if isinstance(design, GearDesign):
        return replace(design, gear=replace(design.gear, tool=None)) if design.gear.tool else design
    pinion, wheel = (replace(gear, tool=None) if gear.tool else gear for gear in (design.pair.pinion, design.pair.wheel))
    return replace(design, pair=replace(design.pair, pinion=pinion, wheel=wheel))


class _RexsWriter:
    """The steps of an export, one model and one list of lines."""

    def __init__(self, given: GearDesign | PairDesign) -> None:
        self.given, self.told = given, list[str]()
        self.design = _without_tools(given)
        pair = isinstance(self.design, PairDesign)
        self.tables: SpecTables = pair_tables(self.design) if isinstance(self.design, PairDesign) else gear_tables(self.design)
        self.model = ModelBuilder()
        self.gears = {"pinion": 0, "wheel": 0} if pair else {"gear": 0}
        self.tools = {name: gear.tool for name, gear in self.given.gears.items()}

    def made(self) -> RexsExport:
        """Return the file."""
        attributes = placed((0.0, 0.0, 0.0)) | {"number_of_gears": 1, "gear_shift_index": 1}
        self.unit = self.model.add("gear_unit", self.design.name, attributes)
        self.casing = self.model.add("gear_casing", "casing")
        self.model.relate("assembly", assembly=self.unit, part=self.casing)
        for name, gear in self.design.gears.items():
            self.gears[name] = self._gear(name, gear)
        if isinstance(self.design, PairDesign):
            self._pair(self.design)
        self._materials()
        self._beside()
        return RexsExport(self.design.name, self.model.text(), tuple(self.told))

    def _table(self, name: str) -> dict[str, Any]:
        found = self.tables.get(name, {})
        return found if isinstance(found, dict) else {}

    def _rows(self, name: str) -> list[_KeysLeft]:
        found = self.tables.get(name, [])
        return [_KeysLeft(f"{name}[{at}]", each) for at, each in enumerate(found) if isinstance(each, dict)]

    def _gear(self, name: str, gear: Gear) -> int:
        """Add a gear with its flanks, modifications and tool, and return its number."""
        keys = _KeysLeft(name, self._table(name))
        keys.take("name", "teeth", "mesh_position", "coupling")
        if gear.body.bore_spline:
            keys.left["body.bore"] = gear.body.bore_spline
        attributes: dict[str, RexsValue] = {"number_of_teeth": gear.tooth_count}
        attributes |= {key: abs(float(getattr(gear, key))) for key in _OWN_SIZES}
        not_given = [key for key in _OWN_SIZES if key not in keys.left]
        keys.take(*_OWN_SIZES)
        sizes = [each for each in OF_GEAR if not each.key.startswith("body.") or _value(gear, each.key)]
        spline = keys.left.get("body.bore") if gear.body.bore_spline else None
        attributes |= _attributes(gear, sizes, keys) | placed((0.0, 0.0, 0.0)) | {"datum_face_orientation": "negative"}
        if spline is not None:
            keys.left["body.bore"] = spline
        if gear.tooth_allowance and SERIES.fullmatch(gear.tooth_allowance):
            attributes["tooth_thickness_deviation_tolerance_series_din_3967_1978"] = gear.tooth_allowance
            keys.take("tooth_allowance")
        number = self.model.add("ring_gear" if gear.internal else "cylindrical_gear", gear.name, attributes)
        flanks = self._flanks(gear, keys)
        self.model.relate("flank", gear=number, **flanks)
        self._modifications(gear, flanks, keys)
        self._tool(name, gear, flanks, keys)
        self.model.extend(number, keys.custom(self.told, ("tip_alteration", "tooth_thinning")) | _not_given(not_given))
        return number

    def _flanks(self, gear: Gear, keys: _KeysLeft) -> dict[str, int]:
        """Add both flanks and return their numbers."""
        shared = [each for each in OF_FLANK if not each.key.startswith("body.") or _value(gear, each.key)]
        attributes = _attributes(gear, shared, keys)
        if gear.tooth_thinning:
            name = "addendum_modification_coefficient_after_finishing"
            attributes[name] = finished_shift(gear, float(gear.tooth_thinning))
            if gear.tooth_allowance is None:
                keys.take("tooth_thinning")
        return {side: self.model.add("cylindrical_gear_flank", f"{gear.name} {side}", attributes) for side in ("left", "right")}

    def _modifications(self, gear: Gear, flanks: Mapping[str, int], keys: _KeysLeft) -> None:
        """Add the modifications of both flanks."""
        modification, profile = gear.modification, gear.profile
        for kind, (amount, *others) in OF_MODIFICATIONS.items():
            if not getattr(modification, amount.key):
                continue
            own = _KeysLeft("", {})
            attributes = _attributes(modification, (amount, *others), own)
            if kind in SHAPES:
                attributes["shape_of_relief"] = _value(modification, SHAPES[kind])
            if kind.endswith("_crowning"):
                attributes[f"shape_of_{kind}"] = "parabolic"
            if kind in ("tip_relief", "root_relief"):
                at_end, side = (profile.tip_form_diameter, -1) if kind == "tip_relief" else (profile.form_diameter, 1)
                roll = tangent_length(at_end, profile.base_diameter) + side * getattr(modification, f"{kind}_length")
                attributes[f"{kind}_datum_diameter"] = 2 * math.hypot(profile.base_diameter / 2, roll)
            taken = [amount.key, *(each.key for each in others), *([SHAPES[kind]] if kind in SHAPES else [])]
            keys.take(*(f"modification.{key}" for key in taken))
            for side_name, flank in flanks.items():
                part = self.model.add(kind, f"{gear.name} {side_name}", attributes)
                self.model.relate("reference", origin=flank, referenced=part)

    def _tool(self, name: str, gear: Gear, flanks: Mapping[str, int], keys: _KeysLeft) -> None:
        """Add the tool that cuts the teeth, with its settings; a ring without a cutter has none."""
        module, pressure = float(gear.normal_module), gear.rack.pressure_angle
        attributes: dict[str, RexsValue] = {"normal_module": module, "normal_pressure_angle": pressure}
        settings: dict[str, RexsValue] = {}
        pre, kind, step, not_given = gear.premachining, "rack_shaped_tool", "rack", []
        if pre.present:
            step = "premachining"
            for key in ("tool_addendum", "tool_pressure_angle", "tool_module"):
                if getattr(pre, key) is None:
                    not_given.append(f"premachining.{key}")
            present = [each for each in OF_PREMACHINING if _value(gear, each.key)]
            attributes |= _attributes(gear, present, keys)
            attributes["addendum_coefficient_reference_profile"] = pre.addendum_of(module)
            if isinstance(pre.stock, str):
                settings["machining_allowance"] = pre.stock_of(module)
            settings |= _attributes(gear, OF_SETTINGS, keys)
            if pre.cutter_teeth is not None:
                kind = "cutter_wheel_tool"
                attributes |= {
                    "number_of_teeth": pre.cutter_teeth,
                    "addendum_modification_coefficient": pre.cutter_profile_shift,
                }
                keys.take("premachining.cutter_teeth", "premachining.cutter_profile_shift")
        elif gear.cutter.teeth is not None:
            kind, step = "cutter_wheel_tool", "cutter"
            attributes |= {"number_of_teeth": gear.cutter.teeth, **_attributes(gear, OF_CUTTER, keys)}
            keys.take("cutter.teeth")
            if gear.cutter_tip_diameter is not None:
                reach = abs(gear.cutter_tip_diameter) / 2 - gear.cutter.teeth * gear.transverse_module / 2
                attributes["addendum_coefficient_reference_profile"] = reach / module - gear.cutter.profile_shift
        elif gear.internal:
            return
        else:
            attributes |= _attributes(gear, OF_TOOL, keys)
            if gear.rack.root_radius == "full":
                attributes["tip_radius_factor"] = float(gear.root_radius)
                keys.left["rack.root_radius"] = "full"
        attributes |= {STEP: step} | _not_given(not_given)
        if (shelf := self.tools[name]) is not None:
            self.told.append(f"{name}.tool: REXS has no shelf: the tool {shelf} is written with its sizes")
        tool = self.model.add(kind, f"tool of {gear.name}" if shelf is None else str(shelf), attributes)
        for side, flank in flanks.items():
            used = self.model.add("cylindrical_gear_manufacturing_settings", f"{gear.name} {side}", settings)
            self.model.relate("manufacturing_step", 1, workpiece=flank, tool=tool, manufacturing_settings=used)

    def _pair(self, design: PairDesign) -> None:
        """Add the stage, the shafts and the load."""
        pair, keys = design.pair, _KeysLeft("pair", self._table("pair"))
        keys.take("name", "centre_distance")
        shafts = _KeysLeft("shafts", self._table("shafts"))
        angle = 0.0 if design.shafts is None else design.shafts.options.mesh_angle
        shafts.take("mesh_angle")
        attributes: dict[str, RexsValue] = {
            "center_distance": abs(float(pair.centre_distance)),
            "rotating_angle_around_neg_u_axis": 0.0 - angle,
        }
        given = "centre_distance" in self._table("pair")
        load = _KeysLeft("load", self._table("load"))
        if design.load is not None and "application_factor" in load.left:
            attributes["application_factor_iso_6336_2006"] = design.load.application_factor
            load.take("application_factor")
        stage = self.model.add("cylindrical_stage", pair.name, attributes)
        self.stage = stage
        self.model.extend(stage, keys.custom(self.told) | _not_given([] if given else ["centre_distance"]))
        self.model.relate("assembly", assembly=self.unit, part=stage)
        self.model.relate("stage", stage=stage, gear_1=self.gears["pinion"], gear_2=self.gears["wheel"])
        load.take("torque", "speed")
        self._shafts(design, angle)
        self.model.extend(self.unit, _prefixed("shafts", shafts, self.told) | _prefixed("load", load, self.told))

    def _shafts(self, design: PairDesign, angle: float) -> None:
        """Add a shaft for each gear, with what the design says of it; the pinion's has the load."""
        mounted = {} if design.shafts is None else design.shafts.mounted
        middle = {role: mounted[role].mesh_position if role in mounted else 0.0 for role in Role}
        distance, turn = abs(float(design.pair.centre_distance)), math.radians(angle)
        for role in Role:
            away = distance if role is Role.WHEEL else 0.0
            origin = (middle[Role.PINION] - middle[role], 0.0 - away * math.sin(turn), away * math.cos(turn))
            attributes = placed(origin) | {"defines_speed": role is Role.PINION and design.load is not None}
            if role is Role.PINION and design.load is not None and design.load.speed:
                attributes["rotational_speed"] = design.load.speed
            shaft = self.model.add("shaft", f"shaft of {role.value}", attributes)
            gear = self.gears[role.value]
            self.model.relate("assembly", assembly=self.unit, part=shaft)
            self.model.relate("assembly", assembly=shaft, part=gear)
            middle_point = (origin[0] + middle[role], *origin[1:])
            self.model.extend(gear, {"u_coordinate_on_shaft": middle[role], "support_vector": middle_point})
            self._on_shaft(design, role, shaft, origin[0])

    def _on_shaft(self, design: PairDesign, role: Role, shaft: int, origin: float) -> None:
        """Add what lies on the shaft of a gear: segments, bearings, forces and the load."""
        own = None if design.shafts is None else design.shafts.gears.pick(role)
        keys = {name: self._rows(f"{role.value}.{name}") for name in ("shaft", "bearing", "force")}
        if own is not None:
            add_segments(self.model, shaft, own.shaft.segments, keys["shaft"], self.told)
            add_bearings(self.model, shaft, self.casing, origin, own.shaft.bearings, keys["bearing"], self.told)
            add_forces(self.model, shaft, own.shaft.forces, keys["force"], self.told)
        attributes: dict[str, RexsValue] = {
            "u_coordinate_on_shaft": 0.0 if own is None else own.shaft.coupling,
            "transmits_torque": True,
            "defines_torque": role is Role.PINION and design.load is not None,
        }
        if role is Role.PINION and design.load is not None:
            attributes["torque_around_u_axis"] = design.load.torque
        if design.load is not None or own is not None:
            coupling = self.model.add("external_load", f"coupling of {role.value}", attributes)
            self.model.relate("assembly", assembly=shaft, part=coupling)

    def _materials(self) -> None:
        """Add the materials that are given, and what refers to them."""
        for table, names in {"material": tuple(self.gears), **{f"{name}.material": (name,) for name in self.gears}}.items():
            if table not in self.tables:
                continue
            keys = _KeysLeft(table, self._table(table))
            number = self.model.add("material", *_material(self._material_of(names[0]), keys, self.told))
            for name in names:
                self.model.relate("reference", origin=self.gears[name], referenced=number)

    def _material_of(self, name: str) -> Material:
        if isinstance(self.design, PairDesign):
            return self.design.materials.pick(Role(name))
        return self.design.material or Material()

    def _beside(self) -> None:
        """Add oil and life of the rating, and keep the other tables."""
        done = ("pair", "shafts", "load", "material", *self.gears)
        for name, values in self.tables.items():
            if name in done or name.endswith(".material") or not isinstance(values, dict):
                continue
            keys = _KeysLeft(name, values)
            if name == "rating":
                self._oil(keys)
            self.model.extend(self.unit, _prefixed(name, keys, self.told))

    def _oil(self, keys: _KeysLeft) -> None:
        rating = getattr(self.design, "rating", None)
        oil = [each for each in OF_LUBRICANT if each.key in keys.left]
        origin = getattr(self, "stage", self.casing)
        if attributes := _attributes(rating, oil, keys):
            number = self.model.add("lubricant", "oil", attributes)
            self.model.relate("reference", origin=origin, referenced=number)
        if "oil_temperature" in keys.left:
            self.model.extend(origin, _attributes(rating, [KeyAttribute("oil_temperature", "temperature_lubricant")], keys))
        if "life" in keys.left:
            self.model.extend(self.unit, _attributes(rating, [KeyAttribute("life", "operating_time")], keys))


def _prefixed(table: str, keys: _KeysLeft, told: list[str]) -> dict[str, RexsValue]:
    """Return what keeps the keys of a table that REXS has no component for."""
    return {custom_id(f"{table}.{key[len(custom_id('')) :]}"): value for key, value in keys.custom(told).items()}


def _material(material: Material, keys: _KeysLeft, told: list[str]) -> tuple[str, dict[str, RexsValue]]:
    """Return the name and the attributes of a material."""
    not_given = [key for key in ("name", "youngs_modulus", "poisson_ratio", "density") if key not in keys.left]
    attributes: dict[str, RexsValue] = {"material_designation": material.name}
    keys.take("name")
    attributes |= _attributes(material, OF_MATERIAL, keys)
    if material.hardness is not None:
        kind = "brinell" if material.group is not None and hardness_scale(material.group) == "HBW" else "vickers"
        attributes[f"surface_hardness_{kind}"] = material.hardness
        keys.take("hardness")
    return material.name, attributes | keys.custom(told) | _not_given(not_given)
