"""StrengthTask: what is to be rated, and each step of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from gearcad.errors import InputError
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.per_gear import PerGear, Role
from gearcad.rating.iso6336_5 import EnduranceLimits, endurance_limits_of
from gearcad.rating.load_factors import BodyLoad, LoadFactors
from gearcad.rating.options import RatingOptions
from gearcad.rating.rack_rating import rate_rack
from gearcad.rating.rate import Rating, rate
from gearcad.rating.scuffing import Scuffing, scuffing
from gearcad.rating.strength.conditions import Conditions
from gearcad.rating.strength.duty import Duty
from gearcad.rating.strength.flank import WorkHardening, flank_resistance, work_hardening
from gearcad.rating.strength.halved import half_of, load_factors_of_half
from gearcad.rating.strength.judge import judged
from gearcad.rating.strength.part import Part, PartStrength
from gearcad.rating.strength.rack_factors import given_factors
from gearcad.rating.strength.reasons import Reasons
from gearcad.rating.strength.resistance import Resistance
from gearcad.rating.strength.root import notch_strength, root_resistance
from gearcad.rating.tolerances import GearTolerances, gear_tolerances

__all__ = ["StrengthTask"]


@dataclass(frozen=True, kw_only=True)
class StrengthTask:
    """What is to be rated, and each step of it, found when it is first asked for."""

    pair: GearPair | RackPair
    materials: PerGear[Material]
    load: Load
    options: RatingOptions
    driver: Role
    body_load: BodyLoad | None = None

    # ------------------------------------------------------------------ what is held against each other

    @cached_property
    def halved(self) -> bool:
        """Whether a double helical pair is rated by one of its halves, which has half the torque."""
        return self.pair.pinion.double_helix.present

    @cached_property
    def rated(self) -> GearPair | RackPair:
        """The pair, or its lower halves."""
        return half_of(self.pair) if self.halved and isinstance(self.pair, GearPair) else self.pair

    @property
    def pair_gears(self) -> tuple[Gear, ...]:
        """The gears of the pair; of a pinion and a rack the pinion."""
        return (self.pair.pinion,) if isinstance(self.pair, RackPair) else tuple(self.pair.gears)

    @cached_property
    def rated_load(self) -> Load:
        """What `rated` carries."""
        return replace(self.load, torque=self.load.torque / 2) if self.halved else self.load

    @cached_property
    def nominal(self) -> Rating:
        """By geometry and torque."""
        if isinstance(self.rated, RackPair):
            return rate_rack(self.rated, self.materials, self.rated_load, self.options)
        return rate(self.rated, self.materials, self.rated_load, self.options)

    @cached_property
    def limits(self) -> PerGear[EnduranceLimits]:
        """Endurance limits."""
        return endurance_limits_of(self.materials)

    @cached_property
    def conditions(self) -> Conditions:
        """Oil, speed, roughness; under a spectrum the speed is that of its greatest torque."""
        speed = max(self.options.bins, key=lambda each: each.torque).speed if self.options.bins else 1.0
        return Conditions.of(self.pair, replace(self.load, speed=self.load.speed * speed), self.options)

    @cached_property
    def duty(self) -> Duty:
        """The loads over the life."""
        ratio = self.rated.gear_ratio if isinstance(self.rated, GearPair) else 1.0
        return Duty(
            nominal=self.nominal,
            load=self.rated_load,
            options=self.options,
            gear_ratio=ratio,
            whole_torque=self.load.torque,
            factors=self.load_factors_of,
        )

    def load_factors_of(self, load: Load) -> LoadFactors:
        """Of a load of `rated`. Raises what `LoadFactors.of` raises; of a rack what is not given."""
        if isinstance(self.rated, RackPair):
            return given_factors(load, self.options)
        find = load_factors_of_half if self.halved else LoadFactors.of
        found = find(self.rated, self.materials, load, self.options)
        return found if self.body_load is None else found.with_bodies(self.body_load)

    @cached_property
    def load_factors(self) -> LoadFactors | InputError:
        """Of the load, or what is in their way."""
        try:
            self.duty.cases()
            return self.load_factors_of(self.rated_load)
        except InputError as error:
            return error

    # ------------------------------------------------------------------ parts

    @cached_property
    def reasons(self) -> Reasons:
        """Why parts are not judged."""
        error = self.load_factors if isinstance(self.load_factors, InputError) else None
        return Reasons(self.rated, self.materials, self.load, self.options, self.limits, self.nominal.roots, error)

    @cached_property
    def hardening(self) -> WorkHardening:
        """Z_W."""
        return work_hardening(self.materials, self.conditions)

    def part(self, part: Part, role: Role) -> PartStrength:
        """One flank or root: judged, or what is known of it and why it is not."""
        options, reason = self.options, self.reasons.of(part, role)
        required = options.required_safety_flank if part is Part.FLANK else options.required_safety_root
        resistance = self.resistance(part, role)
        if resistance is not None and not reason:
            return judged(part, role, self.duty, resistance, required)
        known = not isinstance(self.load_factors, InputError) and not self.load_factors.unknown
        return PartStrength(
            part=part,
            required=required,
            stress=self.duty.governing.stresses[part].pick(role) if known else None,
            resistance=resistance,
            cycles=self.duty.loaded_cycles.pick(role),
            reason=reason,
        )

    def resistance(self, part: Part, role: Role) -> Resistance | None:
        """sigma_HG or sigma_FG of a gear; None without its limits, or group."""
        group, limits = self.materials.pick(role).group, self.limits
        contact = limits.map(lambda each: each.contact)
        if group is None:
            return None
        if part is Part.FLANK:
            if contact.pinion is None or contact.wheel is None:
                return None
            known = PerGear(contact.pinion, contact.wheel)
            return flank_resistance(role, known, group, self.hardening, self.conditions, self.options)
        if (limit := limits.pick(role).root) is None:
            return None
        root = self.nominal.roots.pick(role)
        strength = notch_strength(self.materials.pick(role), group, root.section.notch_parameter).value
        return root_resistance(role, limit, group, strength, root, self.conditions, self.options)

    # ------------------------------------------------------------------ beside them

    @cached_property
    def scuffing(self) -> Scuffing | None:
        """Against scuffing, of gears whose load factors are known: under the hottest of the loads."""
        pair = self.rated
        if isinstance(pair, RackPair) or isinstance(self.load_factors, InputError):
            return None
        cases = self.duty.cases()
        found = [scuffing(pair, self.materials, case.load, case.factors, self.options, self.driver) for case in cases]
        return max(found, key=lambda each: 0.0 if each.integral is None else float(each.integral.value))

    @cached_property
    def tolerances(self) -> PerGear[GearTolerances[float] | None]:
        """Of both gears; None of a rack, and of gears that the standard has none for."""
        return PerGear.each(self._tolerances)

    def _tolerances(self, role: Role) -> GearTolerances[float] | None:
        if role is Role.PINION:
            gear = self.pair.pinion
        elif isinstance(self.pair, RackPair):
            return None
        else:
            gear = self.pair.wheel
        grade = self.options.accuracy_grade if gear.accuracy_grade is None else gear.accuracy_grade
        try:
            return gear_tolerances(gear, grade, self.options.accuracy)
        except InputError:
            return None
