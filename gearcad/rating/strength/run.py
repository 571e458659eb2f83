"""rate_strength: the full rating of a pair by ISO 6336 or DIN 3990."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from gearcad.errors import InputError, ParameterError
from gearcad.geometry import GearPair, RackPair
from gearcad.load import Load
from gearcad.material import Material, of_both
from gearcad.notice import Notice
from gearcad.per_gear import PerGear, Role
from gearcad.rating.factors import to_verify
from gearcad.rating.factors.life import endurance_cycles
from gearcad.rating.iso6336_5 import EnduranceLimits, endurance_limits_of
from gearcad.rating.load_factors import LoadFactors
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
from gearcad.rating.strength.rating import StrengthRating
from gearcad.rating.strength.reasons import Reasons
from gearcad.rating.strength.resistance import Resistance
from gearcad.rating.strength.root import notch_strength, root_resistance
from gearcad.rating.tolerances import GearTolerances, gear_tolerances

__all__ = ["rate_strength"]


def rate_strength(
    pair: GearPair | RackPair,
    materials: Material | PerGear[Material],
    load: Load,
    options: RatingOptions | None = None,
    *,
    face_load_factor: float | None = None,
    driver: Role = Role.PINION,
) -> StrengthRating:
    """Rate a pair, of one material or each gear of its own: safeties of flanks and roots, life, permissible torque, scuffing.

    `face_load_factor` stands in place of that of the options: K_Hbeta of a load distribution, for "fe". `driver` is the gear
    that drives, for scuffing. What the standard does not cover, or what is not known, is not judged, each for its reason.
    Raises ParameterError without a torque, for a spectrum beside an application factor, and for a hardness that its material
    has no limit of; GeometryError for a pair whose contact the standard does not describe.
    """
    options = options or RatingOptions()
    if options.bins and load.application_factor != 1:
        permitted = "must be 1 with a load spectrum, which has all loads in it (ISO 6336-6)"
        raise ParameterError("load.application_factor", load.application_factor, permitted)
    if face_load_factor is not None:
        options = replace(options, face_load_factor=face_load_factor)
    return _Task(pair=pair, materials=of_both(materials), load=load, options=options, driver=driver).rating


@dataclass(frozen=True, kw_only=True)
class _Task:
    """What is to be rated, and each step of it, found when it is first asked for."""

    pair: GearPair | RackPair
    materials: PerGear[Material]
    load: Load
    options: RatingOptions
    driver: Role

    # ------------------------------------------------------------------ what is held against each other

    @cached_property
    def halved(self) -> bool:
        """Whether a double helical pair is rated by one of its halves, which has half the torque."""
        return self.pair.pinion.double_helix.present

    @cached_property
    def rated(self) -> GearPair | RackPair:
        """The pair, or its lower halves."""
        return half_of(self.pair) if self.halved and isinstance(self.pair, GearPair) else self.pair

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
        """Oil, speed, roughness."""
        return Conditions.of(self.pair, self.load, self.options)

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
            return _given_factors(load, self.options)
        find = load_factors_of_half if self.halved else LoadFactors.of
        return find(self.rated, self.materials, load, self.options)

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
        cases = self.duty.cases() if known else ()
        return PartStrength(
            part=part,
            required=required,
            stress=max((case.stresses[part].pick(role) for case in cases), default=None),
            resistance=resistance,
            cycles=self.duty.cycles.pick(role),
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

    def assumed(self) -> Iterator[str]:
        """What was not given."""
        yield from self.conditions.assumed
        if self.hardening.assumed:
            yield self.hardening.assumed
        for role, material in self.materials.items():
            if material.group is not None and self.limits.pick(role).root is not None:
                notch = self.nominal.roots.pick(role).section.notch_parameter
                if said := notch_strength(material, material.group, notch).assumed:
                    yield f"{said} ({role.value})"
        if self.duty.cycles.pinion is None and self.load.speed:
            yield "no life and no load cycles are given: endurance limits hold, with Z_NT = Y_NT = 1"
        if not isinstance(self.load_factors, InputError):
            yield from self.load_factors.assumed
        if self.scuffing is not None and self.scuffing.judged:
            yield from self.scuffing.assumed

    def verify(self) -> Iterator[str]:
        """Symbols of what is to be verified."""
        yield from self.nominal.verify
        for each in self.limits:
            yield from each.verify
        yield from to_verify(
            self.options.standard,
            internal=isinstance(self.rated, GearPair) and self.rated.internal,
            limited_flank=self.limited(Part.FLANK),
            limited_root=self.limited(Part.ROOT),
        )
        if not isinstance(self.load_factors, InputError):
            yield from self.load_factors.verify
        if self.scuffing is not None and self.scuffing.judged:
            yield from self.scuffing.verify

    def limited(self, part: Part) -> bool:
        """Whether a gear has fewer load cycles than its endurance limit asks for."""
        found = ((self.resistance(part, role), self.duty.cycles.pick(role)) for role in Role)
        return any(each is not None and cycles is not None and cycles < endurance_cycles(each.points) for each, cycles in found)

    def notices(self) -> Iterator[Notice]:
        """Of the nominal rating, of load factors and scuffing."""
        yield from self.nominal.notices
        if not isinstance(self.load_factors, InputError):
            yield from self.load_factors.notices
        if self.scuffing is not None and self.scuffing.judged:
            yield from self.scuffing.notices

    @property
    def rating(self) -> StrengthRating:
        """All of it."""
        parts = {part: PerGear(*(self.part(part, role) for role in Role)) for part in Part}
        factors = None if isinstance(self.load_factors, InputError) else self.load_factors
        return StrengthRating(
            pair=self.pair,
            materials=self.materials,
            load=self.load,
            options=self.options,
            nominal=self.nominal,
            limits=self.limits,
            load_factors=factors,
            cases=() if factors is None else self.duty.cases(),
            flank=parts[Part.FLANK],
            root=parts[Part.ROOT],
            scuffing=self.scuffing,
            tolerances=self.tolerances,
            assumed=tuple(dict.fromkeys(self.assumed())),
            verify=tuple(dict.fromkeys(self.verify())),
            notices=tuple(dict.fromkeys(self.notices())),
        )


def _given_factors(load: Load, options: RatingOptions) -> LoadFactors:
    """Load factors of a rack, for which the standard has no methods. Raises ParameterError for one that is not given."""
    given = {"dynamic_factor": options.dynamic_factor, "face_load_factor": options.face_load_factor}
    given["transverse_load_factor"] = options.transverse_load_factor
    for name, value in given.items():
        if isinstance(value, str):
            raise ParameterError(f"rating.{name}", value, "must be a number for a rack, for which the standard has no method")
    dynamic, face, transverse = (float(value) for value in given.values())
    return LoadFactors(
        application=load.application_factor,
        mesh_load=options.mesh_load_factor,
        dynamic=dynamic,
        face_flank=face,
        face_root=face,
        transverse_flank=transverse,
        transverse_root=transverse,
    )
