"""Gears of REXS: the keys of a gear from its component, its flanks, their modifications and the tool that cuts them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from gearcad.core.errors import shown
from gearcad.designs.keys import FIELDS
from gearcad.designs.spec import AUTO
from gearcad.exchange.rexs_attributes import (
    NOT_GIVEN,
    OF_CUTTER,
    OF_FLANK,
    OF_GEAR,
    OF_MODIFICATIONS,
    OF_PREMACHINING,
    OF_SETTINGS,
    OF_TOOL,
    SHAPES,
    STEP,
    KeyAttribute,
    key_value,
    plainest,
    shift_with_thinning,
)
from gearcad.exchange.rexs_model import RexsComponent, RexsModel

GEARS = ("cylindrical_gear", "ring_gear")
"""Types of components that are gears."""

DIAMETERS = ("tip_diameter", "root_diameter")
"""Keys of a foreign gear that are left out where they make no gear."""

_TOOLS = ("rack_shaped_tool", "cutter_wheel_tool")


class RexsGear:
    """The keys of a gear of a model; lines about what is assumed are told."""

    def __init__(self, model: RexsModel, gear: RexsComponent, told: list[str]) -> None:
        self.model, self.gear, self.told = model, gear, told
        self.internal = gear.kind == "ring_gear"
        self.informed: dict[str, float] = {}
        self.flank, other = self._flanks()
        for key, attribute, _ in OF_FLANK:
            if other.text(attribute) != self.flank.text(attribute):
                told.append(f"{gear}: {attribute} of its flanks differs: that of the left flank is taken ({key})")

    def _flanks(self) -> tuple[RexsComponent, RexsComponent]:
        """Return the left and the right flank; the gear itself where it has none."""
        for relation in self.model.related("flank", "gear", self.gear.number):
            left, right = (relation.roles.get(side) for side in ("left", "right"))
            both = [self.model.components[each] for each in (left, right) if each is not None]
            if both:
                return both[0], both[-1]
        return self.gear, self.gear

    def keys(self) -> dict[str, Any]:
        """Return the keys under their dotted names."""
        sign = -1 if self.internal else 1
        teeth = self.gear.needed_whole("number_of_teeth")
        keys: dict[str, Any] = {"name": self.gear.name or "gear", "teeth": sign * abs(teeth)}
        self.gear.needed("normal_module"), self.gear.needed("face_width")
        keys |= values_of(self.gear, OF_GEAR)
        keys.setdefault("helix_angle", 0.0)
        keys |= values_of(self.flank, OF_FLANK)
        keys.setdefault("profile_shift", AUTO)
        for key in ("body.bore", "body.tip_chamfer", "body.end_chamfer"):
            if not keys.get(key):
                keys.pop(key, None)
        not_given = self.gear.list_of(NOT_GIVEN)
        for key in DIAMETERS:
            if (size := self.gear.float_of(key)) is not None:
                (self.informed if key in not_given else keys)[key] = sign * abs(size)
        self._thickness(keys)
        self._modifications(keys)
        self._tool(keys)
        keys |= self.gear.custom(FIELDS["gear"])
        if "normal_diametral_pitch" in keys:
            keys.pop("normal_module", None)
        return keys

    def _thickness(self, keys: dict[str, Any]) -> None:
        """Add the allowance of DIN 3967, or else the thinning that the finished profile shift means."""
        series = self.gear.text("tooth_thickness_deviation_tolerance_series_din_3967_1978")
        if series is not None:
            keys["tooth_allowance"] = series
            return
        finished = self.flank.float_of("addendum_modification_coefficient_after_finishing")
        if finished is None or keys["profile_shift"] == AUTO or finished >= keys["profile_shift"]:
            return
        shift, module, angle = keys["profile_shift"], keys["normal_module"], keys.get("rack.pressure_angle", 20.0)
        exact = (shift - finished) / ((shift - shift_with_thinning(shift, module, angle, 1.0)) or 1.0)
        keys["tooth_thinning"] = plainest(exact, lambda value: shift_with_thinning(shift, module, angle, value), finished)

    def _modifications(self, keys: dict[str, Any]) -> None:
        """Add the modifications of the left flank, or of the gear."""
        for origin in dict.fromkeys((self.flank.number, self.gear.number)):
            for part in self.model.referenced(origin, *OF_MODIFICATIONS):
                pairs = OF_MODIFICATIONS[part.kind]
                for key, value in values_of(part, pairs).items():
                    if value:
                        keys.setdefault(f"modification.{key}", value)
                shape = part.text("shape_of_relief")
                if part.kind in SHAPES and shape in ("linear", "parabolic"):
                    keys.setdefault(f"modification.{SHAPES[part.kind]}", shape)
                elif shape is not None and shape != "linear":
                    self.told.append(f"{part}: shape_of_relief = {shown(shape, 40)} is taken as linear")
        if keys.get("modification.tip_relief_shape") == "linear":
            keys.pop("modification.tip_relief_shape")

    def _tool(self, keys: dict[str, Any]) -> None:
        """Add the tool that cuts first."""
        tool, settings = self._first_tool()
        if tool is None:
            if not self.internal:
                self.told.append(f"{self.gear}: has no tool: dedendum and root radius of ISO 53 A are taken")
            return
        allowance = settings.float_of("machining_allowance") if settings is not None else None
        before = bool(allowance) or bool(tool.float_of("protuberance_amount"))
        step = tool.text(STEP) or ("premachining" if before else "cutter" if tool.kind == "cutter_wheel_tool" else "rack")
        if step == "premachining":
            self._premachining(keys, tool, settings)
        elif step == "cutter":
            keys["cutter.teeth"] = tool.needed_whole("number_of_teeth")
            keys |= values_of(tool, OF_CUTTER)
            keys.setdefault("cutter.profile_shift", 0.0)
            if tool.text(STEP) is None:
                keys |= values_of(tool, OF_TOOL[:1])
        else:
            keys |= values_of(tool, OF_TOOL)

    def _premachining(self, keys: dict[str, Any], tool: RexsComponent, settings: RexsComponent | None) -> None:
        found = values_of(tool, OF_PREMACHINING)
        if tool.text(STEP) is None:
            for key, own in (
                ("tool_pressure_angle", keys.get("rack.pressure_angle", 20.0)),
                ("tool_module", keys["normal_module"]),
            ):
                if found.get(f"premachining.{key}") == own:
                    del found[f"premachining.{key}"]
            self.told.append(f"{self.gear}: the tool that finishes the flanks is not taken over")
        if settings is not None:
            found |= values_of(settings, OF_SETTINGS)
        if tool.kind == "cutter_wheel_tool":
            found["premachining.cutter_teeth"] = tool.needed_whole("number_of_teeth")
            found["premachining.cutter_profile_shift"] = tool.float_of("addendum_modification_coefficient") or 0.0
            for key in ("tool_pressure_angle", "tool_module"):
                found.pop(f"premachining.{key}", None)
        for key in tool.list_of(NOT_GIVEN):
            found.pop(key, None)
        if not found.get("premachining.protuberance"):
            found.pop("premachining.protuberance", None)
            found.pop("premachining.protuberance_angle", None)
        keys |= {key: value for key, value in found.items() if value}
        keys.setdefault("premachining.tool_tip_radius", found.get("premachining.tool_tip_radius", 0.0))

    def _first_tool(self) -> tuple[RexsComponent | None, RexsComponent | None]:
        """Return the tool of the first step and its settings; versions up to 1.2 refer from the gear to the tool."""
        for relation in self.model.related("manufacturing_step", "workpiece", self.flank.number):
            tool, settings = relation.roles.get("tool"), relation.roles.get("manufacturing_settings")
            if tool is not None:
                return self.model.components[tool], None if settings is None else self.model.components[settings]
        for kind in ("ordered_reference", "reference"):
            for relation in self.model.related(kind, "origin", self.gear.number):
                referenced = self.model.components[relation.roles.get("referenced", self.gear.number)]
                if referenced.kind in _TOOLS:
                    return referenced, self.flank
        return None, None


def values_of(component: RexsComponent, pairs: Sequence[KeyAttribute]) -> dict[str, Any]:
    """Return the values of keys that attributes of a component say; the first attribute of a key counts."""
    found: dict[str, Any] = {}
    for key, attribute, factor in pairs:
        if key not in found and (written := component.float_of(attribute)) is not None:
            found[key] = key_value(written, factor)
    return found
