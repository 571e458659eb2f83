"""PlasticRating: temperature, root, flank, wear, deformation and static load of a pair with a gear of plastic (VDI 2736-2)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

from gearcad.core.errors import shown
from gearcad.core.records import JsonObject, Notice, PerGear, Role, Verdict, is_assumed
from gearcad.geometry import GearPair
from gearcad.load import Load, ToothLubrication
from gearcad.material import Material, TabledNumber
from gearcad.material_shelf import FILE, PropertyTable, SourcedValue, properties_of
from gearcad.rating.contact_stress import elasticity_factor
from gearcad.rating.options import RatingOptions
from gearcad.rating.plastic_formulas import (
    IN_OIL,
    IN_PLASTIC,
    IN_STEEL,
    PERMITTED_DEFORMATION,
    PERMITTED_LOCAL_WEAR,
    PERMITTED_WEAR,
    REQUIRED_FLANK,
    REQUIRED_ROOT,
    REQUIRED_STATIC,
    Y_ST,
    HeatCoefficients,
    PlasticGeometry,
    ToothHeat,
    mean_wear,
    tooth_deformation,
    usual_friction,
)
from gearcad.rating.strength.duty import PartStrength, RatedPart, torque_at_safety

GUIDELINE = "VDI 2736-2:2014"

_TOLERANCE = 1e-10
"""Change of a temperature (K) at which the iteration ends."""

_MOST_STEPS = 500

_HOTTEST = 1e4
"""Temperature (°C) at which the iteration stops."""


@dataclass(frozen=True, kw_only=True)
class PlasticPart(PartStrength):
    """The flank or root of a gear of plastic; `borne` is sigma_HlimN Z_R or sigma_FlimN Y_St (MPa).

    `unconfirmed` is a safety that rests on values from memory: it is told, and decides nothing.
    """

    borne: float | None = None
    unconfirmed: float | None = None

    @property
    def strength(self) -> float | None:
        """Strength (MPa) after the load cycles, at the temperature of the part."""
        return self.borne


class PlasticProof(NamedTuple):
    """Wear, or the static load, of a gear: a value and what is permitted, or the reason why there is none."""

    value: float | None
    permitted: float | None
    reason: str = ""
    recalled: bool = False

    @property
    def verdict(self) -> Verdict:
        """Whether the value is within what is permitted."""
        if self.value is None or self.permitted is None or self.recalled:
            return Verdict.NOT_JUDGED
        return Verdict.PASSED if self.value <= self.permitted else Verdict.FAILED


class Temperatures(NamedTuple):
    """Temperatures (°C) of the flanks and roots of a mesh, and its coefficient of friction."""

    flank: float
    root: float
    friction: float


@dataclass(frozen=True, kw_only=True)
class PlasticRating:
    """The rating of a pair of which one gear or both are of plastic, under a load.

    `cycles` are the load cycles of a tooth of each gear, None where they are not known. `halves` is 2 for a double helical
    pair, whose half carries half the torque. Values are None where an input is missing.
    """

    geometry: PlasticGeometry
    materials: PerGear[Material]
    load: Load
    options: RatingOptions
    cycles: PerGear[float] | PerGear[None]
    halves: int = 1
    tolerance: float = _TOLERANCE

    @property
    def pair(self) -> GearPair:
        """The pair, or its half."""
        return self.geometry.pair

    @property
    def both(self) -> bool:
        """Whether both gears are of plastic."""
        return all(each.plastic for each in self.materials)

    @property
    def plastic_roles(self) -> tuple[Role, ...]:
        """The gears of plastic."""
        return tuple(role for role, each in self.materials.items() if each.plastic)

    # ------------------------------------------------------------------ load

    @property
    def torques(self) -> PerGear[float]:
        """Torques on both gears (N·m)."""
        torque = abs(self.load.torque)
        return PerGear(torque, torque * self.pair.gear_ratio)

    @property
    def tangential_force(self) -> float:
        """F_t (N) at the reference circle."""
        return 2000 * self.torques.pinion / self.pair.pinion.reference_diameter

    @property
    def load_factor(self) -> float:
        """K_F and K_H: K_A, times what load factors are given as numbers; soft teeth even out the others."""
        given = (self.options.dynamic_factor, self.options.face_load_factor, self.options.transverse_load_factor)
        factors = [each for each in given if not isinstance(each, str)]
        return self.load.application_factor * self.options.mesh_load_factor * math.prod(factors)

    @property
    def power(self) -> float:
        """Rolling power P (W) of the whole pair."""
        return self.torques.pinion * self.halves * abs(self.load.speed) * 2 * math.pi / 60

    @property
    def velocity(self) -> float:
        """Circumferential velocity v_t (m/s) at the working pitch circle."""
        return math.pi * self.pair.working_pitch_diameters.pinion * abs(self.load.speed) / 60000

    # ------------------------------------------------------------------ properties of the materials

    @cached_property
    def _tables(self) -> PerGear[Mapping[str, PropertyTable]]:
        return self.materials.map(lambda each: properties_of(each.name) if each.plastic else {})

    def reading(self, role: Role, quantity: str, temperature: float | None) -> SourcedValue:
        """Return a property of a gear's material at a temperature (°C) and the gear's load cycles; a spec counts first."""
        material, tables = self.materials.pick(role), self._tables.pick(role)
        given = getattr(material, quantity, None)
        if given is not None and not (isinstance(given, TabledNumber) and quantity in tables):
            return SourcedValue(given, "given")
        if quantity in tables:
            return tables[quantity].at(temperature, self.cycles.pick(role))
        return SourcedValue(
            None, "", f"{quantity} of {shown(str(material.name), 60)} is not known: give it, or rows of it in {FILE}"
        )

    # ------------------------------------------------------------------ temperature

    @property
    def coefficients(self) -> HeatCoefficients | None:
        """k_theta of flank and root; None without a lubrication."""
        if self.load.lubrication is None:
            return None
        if self.load.lubrication is ToothLubrication.OIL:
            return IN_OIL
        return IN_PLASTIC if self.both else IN_STEEL

    @cached_property
    def heat(self) -> ToothHeat | None:
        """The heat of the mesh; None without an ambient temperature."""
        load, pair = self.load, self.pair
        if load.ambient_temperature is None:
            return None
        area, resistance = load.housing_area, load.housing_resistance
        return ToothHeat(
            ambient=load.ambient_temperature,
            power=self.power,
            tooth_loss=self.geometry.tooth_loss,
            width=pair.common_width.width * self.halves,
            teeth=pair.pinion.teeth,
            velocity=self.velocity,
            normal_module=pair.pinion.normal_module,
            housing=0.0 if area is None or resistance is None else resistance / area,
            duty=1.0 if load.duty is None else load.duty,
        )

    def _friction(self, temperature: float | None) -> SourcedValue:
        """Return the coefficient of friction: given, of the table of a plastic, or the usual one of the lubrication."""
        if self.options.friction is not None:
            return SourcedValue(self.options.friction, "given")
        for role in self.plastic_roles:
            if "friction" in self._tables.pick(role):
                return self.reading(role, "friction", temperature)
        if self.load.lubrication is None:
            return SourcedValue(None, "", "the coefficient of friction is not known: give rating.friction, or load.lubrication")
        if (usual := usual_friction(self.materials, self.load.lubrication)) is None:
            names = " and ".join(str(each.name) for each in self.materials)
            return SourcedValue(None, "", f"the friction of {names}, dry, is not known: give rating.friction")
        return SourcedValue(usual, "VDI 2736-2" if self.load.lubrication is ToothLubrication.OIL else "recalled")

    @cached_property
    def _found(self) -> tuple[Temperatures | None, str]:
        """Temperatures by a fixed point, since friction may depend on them; or the reason why there are none."""
        heat, coefficients = self.heat, self.coefficients
        if heat is None:
            return None, "the ambient temperature is not given: load.ambient_temperature"
        if coefficients is None:
            return None, "the lubrication is not given: load.lubrication"
        if not self.load.speed:
            return Temperatures(heat.ambient, heat.ambient, math.nan), ""
        flank = heat.ambient
        for _ in range(_MOST_STEPS):
            friction = self._friction(flank)
            if friction.value is None:
                return None, friction.reason
            reached = heat.temperature(friction.value, coefficients.flank)
            if not abs(reached) < _HOTTEST:
                return None, f"the temperature of the flank rises beyond {_HOTTEST:g} °C"
            if abs(reached - flank) <= self.tolerance:
                return Temperatures(reached, heat.temperature(friction.value, coefficients.root), friction.value), ""
            flank = (flank + reached) / 2  # so that friction that falls with temperature does not swing
        return None, f"the temperature of the flank does not settle in {_MOST_STEPS} steps"

    @property
    def temperatures(self) -> Temperatures | None:
        """Temperatures of flanks and roots, the same of both gears; None where something is not known."""
        return self._found[0]

    @property
    def _flank_temperature(self) -> float | None:
        return None if self.temperatures is None else self.temperatures.flank

    @property
    def _root_temperature(self) -> float | None:
        return None if self.temperatures is None else self.temperatures.root

    # ------------------------------------------------------------------ stresses

    @cached_property
    def flank_stress(self) -> SourcedValue:
        """sigma_H (MPa): Z_E of both moduli at the temperature of the flanks."""
        moduli = PerGear.each(lambda role: self.reading(role, "youngs_modulus", self._flank_temperature))
        for each in moduli:
            if each.value is None:
                return each
        ratios = self.materials.map(lambda each: float(each.poisson_ratio))
        z_e = elasticity_factor((moduli.pinion.value or 0.0, moduli.wheel.value or 0.0), (ratios.pinion, ratios.wheel))
        u, pinion = self.pair.gear_ratio, self.pair.pinion
        per_area = self.load_factor * self.tangential_force / (pinion.reference_diameter * self.pair.common_width.width)
        return SourcedValue(z_e * math.prod(self.geometry.contact_factors) * math.sqrt(per_area * (u + 1) / u))

    @cached_property
    def nominal_root_stresses(self) -> PerGear[float]:
        """sigma_F0 (MPa) of both gears, loaded at their tips."""
        module = self.pair.pinion.normal_module
        return self.geometry.roots.map(lambda each: each.stress(self.tangential_force, module))

    @property
    def root_stresses(self) -> PerGear[float]:
        """sigma_F (MPa) of both gears: K_F sigma_F0."""
        return self.nominal_root_stresses.map(lambda stress: stress * self.load_factor)

    def limit(self, part: RatedPart, role: Role) -> SourcedValue:
        """Return sigma_HlimN or sigma_FlimN (MPa) of a gear at the temperature of the part, after its load cycles."""
        if self.options.bins:
            return SourcedValue(None, "", "a load spectrum is not rated for gears of plastic")
        if part is RatedPart.FLANK:
            return self.reading(role, "contact_endurance_limit", self._flank_temperature)
        return self.reading(role, "root_endurance_limit", self._root_temperature)

    def required(self, part: RatedPart) -> float:
        """Return the required safety: as given, or that of the guideline."""
        flank = part is RatedPart.FLANK
        given = self.options.required_safety_flank if flank else self.options.required_safety_root
        return (REQUIRED_FLANK if flank else REQUIRED_ROOT) if is_assumed(given) else given

    def safety(self, part: RatedPart, role: Role) -> float | None:
        """Return the safety of a flank or root, whatever it rests on; None where something is not known."""
        stress = self.flank_stress.value if part is RatedPart.FLANK else self.root_stresses.pick(role)
        limit = self.limit(part, role).value
        return None if not stress or limit is None else limit * _factor(part) / stress

    def part(self, part: RatedPart, role: Role) -> PlasticPart:
        """Return the flank or root of a gear of plastic: judged, or with the reason why it is not."""
        limit = self.limit(part, role)
        of_flank = part is RatedPart.FLANK
        stress = self.flank_stress.value if of_flank else self.root_stresses.pick(role)
        reason = limit.reason or (self.flank_stress.reason if of_flank else "")
        if not reason and limit.recalled:
            reason = f"sigma_{part.index}limN of {self.materials.pick(role).name} is as recalled: confirm it"
        if reason and self._found[1] and "temperature" in reason:
            reason = f"{reason}: {self._found[1]}"
        safety = self.safety(part, role)
        return PlasticPart(
            part=part,
            required=self.required(part),
            stress=stress,
            cycles=self.cycles.pick(role),
            safety=None if reason else safety,
            reason=reason,
            borne=None if limit.value is None else limit.value * _factor(part),
            unconfirmed=safety if reason else None,
            find_torque=None if reason else lambda: self.permissible_torque(part, role),
        )

    def permissible_torque(self, part: RatedPart, role: Role) -> float | None:
        """Return the torque (N·m) on the pinion at which a part has its required safety; heat grows with the torque."""

        def safety(scale: float) -> float:
            return replace(self, load=replace(self.load, torque=self.load.torque * scale)).safety(part, role) or 0.0

        scale = torque_at_safety(safety, self.required(part), 1.0)
        return scale * self.torques.pinion * self.halves if math.isfinite(scale) else None

    # ------------------------------------------------------------------ wear, deformation, static load

    def wear(self, role: Role) -> PlasticProof:
        """Return the mean wear (µm) of the flanks of a gear, and what is permitted."""
        coefficient, cycles = self.reading(role, "wear_coefficient", self._flank_temperature), self.cycles.pick(role)
        permitted = PERMITTED_WEAR * self.pair.pinion.normal_module * 1000
        if coefficient.value is None:
            return PlasticProof(None, permitted, coefficient.reason)
        if cycles is None:
            return PlasticProof(None, permitted, "wear needs life, or load_cycles")
        gear = self.pair.gears.pick(role)
        length = self.geometry.flank_lengths.pick(role)
        width = self.pair.common_width.width
        worn = mean_wear(
            self.torques.pick(role), cycles, self.geometry.tooth_loss, coefficient.value, width, gear.teeth, length
        )
        return PlasticProof(worn, permitted, recalled=coefficient.recalled)

    @cached_property
    def deformation(self) -> SourcedValue:
        """lambda (mm), the deformation of a pair of teeth, with the moduli at the temperature of the roots."""
        moduli = PerGear.each(lambda role: self.reading(role, "youngs_modulus", self._root_temperature))
        for each in moduli:
            if each.value is None:
                return each
        known = moduli.map(lambda each: each.value or 0.0)
        width, helix = self.pair.common_width.width, self.pair.pinion.helix_angle
        return SourcedValue(tooth_deformation(self.tangential_force, width, helix, known))

    def static(self, role: Role) -> PlasticProof:
        """Return the static root stress (MPa) of a gear under K_A, and what is permitted: 2 sigma_S/S_Smin."""
        limit = self.reading(role, "yield_strength", self._root_temperature)
        stress = self.nominal_root_stresses.pick(role) * self.load.application_factor
        if limit.value is None:
            return PlasticProof(stress, None, limit.reason)
        return PlasticProof(stress, 2 * limit.value / REQUIRED_STATIC, recalled=limit.recalled)

    # ------------------------------------------------------------------ verdicts, and what they rest on

    @property
    def proofs(self) -> Mapping[str, PlasticProof]:
        """Proofs beside those of flanks and roots, by name: wear of dry gears and of known coefficient, known static load."""
        found: dict[str, PlasticProof] = {}
        for role in self.plastic_roles:
            wear, static = self.wear(role), self.static(role)
            if wear.value is not None or self.load.lubrication is ToothLubrication.DRY:
                found[f"wear of the {role.value}"] = wear
            if static.permitted is not None:
                found[f"static load of the {role.value}"] = static
        return found

    @property
    def verify(self) -> Iterator[str]:
        """Symbols of what rests on one source, or on memory."""
        friction = self._friction(self._flank_temperature)
        if self.temperatures is not None and self.coefficients not in (None, IN_OIL):
            yield "k_theta"
        if friction.recalled:
            yield "mu"
        for role in self.plastic_roles:
            yield from (f"sigma_{part.index}limN" for part in RatedPart if self.limit(part, role).recalled)
            if self.wear(role).recalled:
                yield "k_w"
            if self.static(role).permitted is not None:
                yield "S_Smin"
        yield "lambda_zul"

    @property
    def assumed(self) -> Iterator[str]:
        """One sentence for each input that was assumed."""
        load, found = self.load, self.temperatures
        if found is not None and load.speed:
            if self.options.friction is None:
                yield f"friction = {found.friction:g}, {self._friction(found.flank).source}"
            if load.duty is None:
                yield "duty = 1: under load all the time"
            if load.housing_area is None or load.housing_resistance is None:
                yield "the housing is open: without housing_area and housing_resistance it holds back no heat"
        for part in RatedPart:
            given = self.options.required_safety_flank if part is RatedPart.FLANK else self.options.required_safety_root
            if is_assumed(given):
                yield f"required safety of a {part.value} of plastic = {self.required(part):g}"

    @property
    def notices(self) -> Iterator[Notice]:
        """Notices on inputs that have no effect, and on the scope of the guideline."""
        load = self.load
        if (load.housing_area is None) != (load.housing_resistance is None):
            missing = "housing_resistance" if load.housing_resistance is None else "housing_area"
            yield Notice("plastic-housing", f"the housing counts only with {missing} too", "temperature")
        if self._found[0] is None:
            yield Notice("plastic-temperature", f"temperatures are not known: {self._found[1]}", "temperature")

    # ------------------------------------------------------------------ document

    def to_dict(self) -> JsonObject:
        """Return the values under their symbols; those of one gear under "pinion" and "wheel", None for what is not known."""
        geometry, found = self.geometry, self.temperatures
        flank, root = (None, None) if found is None else (found.flank, found.root)
        wear = {role: self.wear(role) for role in Role if self.wear(role).value is not None}
        return {
            "guideline": GUIDELINE,
            "F_t": self.tangential_force,
            "P": self.power,
            "v_t": self.velocity,
            "K_F": self.load_factor,
            "mu": None if found is None or math.isnan(found.friction) else found.friction,
            "temperature": {"flank": _of_both(PerGear(flank, flank)), "root": _of_both(PerGear(root, root))},
            "H_V": geometry.tooth_loss,
            "eps_1": geometry.tip_ratios.pinion,
            "eps_2": geometry.tip_ratios.wheel,
            "l_Fl": _of_both(geometry.flank_lengths),
            "E": _of_both(self._readings("youngs_modulus", flank)),
            "Y_Fa": _of_both(geometry.roots.map(lambda each: each.form_factor)),
            "Y_Sa": _of_both(geometry.roots.map(lambda each: each.stress_correction_factor)),
            "Y_eps": geometry.roots.pinion.contact_ratio_factor,
            "sigma_F": _of_both(self.root_stresses),
            "sigma_H": self.flank_stress.value,
            "sigma_FlimN": _of_both(self._limits(RatedPart.ROOT)),
            "sigma_HlimN": _of_both(self._limits(RatedPart.FLANK)),
            "required": {part.value: self.required(part) for part in RatedPart},
            "k_w": _of_both(self._readings("wear_coefficient", flank)),
            "wear": {
                role.value: {
                    "mean": each.value,
                    "permitted": each.permitted,
                    "permitted_local": PERMITTED_LOCAL_WEAR * self.pair.pinion.normal_module * 1000,
                }
                for role, each in wear.items()
            },
            "deformation": self.deformation.value,
            "static": {
                role.value: {"sigma_Fmax": self.static(role).value, "permitted": self.static(role).permitted}
                for role in self.plastic_roles
            },
            "unconfirmed": self._unconfirmed(),
        }

    def _readings(self, quantity: str, temperature: float | None) -> PerGear[float | None]:
        return PerGear.each(lambda role: self.reading(role, quantity, temperature).value)

    def _limits(self, part: RatedPart) -> PerGear[float | None]:
        """Return the limits of the gears of plastic."""
        return PerGear.each(lambda role: self.limit(part, role).value if role in self.plastic_roles else None)

    def _unconfirmed(self) -> JsonObject:
        """Return figures that rest on memory, and decide nothing."""
        module = self.pair.pinion.normal_module
        safeties = {
            f"S_{part.index}": {
                role.value: found.unconfirmed
                for role in self.plastic_roles
                if (found := self.part(part, role)).unconfirmed is not None
            }
            for part in RatedPart
        }
        return {
            "permitted_deformation": PERMITTED_DEFORMATION * module,
            **{symbol: values for symbol, values in safeties.items() if values},
        }


def _factor(part: RatedPart) -> float:
    """Return what an endurance limit is multiplied by: Y_St of roots, Z_R = 1 of flanks."""
    return 1.0 if part is RatedPart.FLANK else Y_ST


def _of_both(values: PerGear[Any]) -> dict[str, Any]:
    return {role.value: value for role, value in values.items()}
