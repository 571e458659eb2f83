"""StrengthTask: the steps of a full rating by ISO 6336 or DIN 3990, and the notices on its result."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain

from gearcad.core.errors import InputError, ParameterError, format_number
from gearcad.core.quantities import assumed_values, schema_of
from gearcad.core.records import Notice, PerGear, Role, is_assumed
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.gear import halves
from gearcad.load import Load
from gearcad.material import Material, MaterialGroup, of_both
from gearcad.rating.factors import endurance_cycles, to_verify
from gearcad.rating.load_factor_formulas import helix_factors, shaft_deflection
from gearcad.rating.load_factors import NO_SHAFTS, BodyLoad, FaceLoadSource, LoadFactors
from gearcad.rating.material_limits import EnduranceLimits, endurance_limits_of
from gearcad.rating.nominal_rating import Rating, rate, rate_rack
from gearcad.rating.options import RatingOptions
from gearcad.rating.plastic_formulas import PlasticGeometry
from gearcad.rating.root_stress import RootRating
from gearcad.rating.scuffing import Scuffing, scuffing
from gearcad.rating.strength.duty import Duty, PartStrength, RatedPart, Resistance, judged
from gearcad.rating.strength.permissible import (
    Conditions,
    WorkHardening,
    flank_resistance,
    notch_strength,
    root_resistance,
    work_hardening,
)
from gearcad.rating.strength.plastic import PlasticRating
from gearcad.rating.strength.rating import StrengthRating
from gearcad.rating.tolerances import GearTolerances, gear_tolerances
from gearcad.rating.tooth_stiffness import rim_of


def half_of(pair: GearPair) -> GearPair:
    """Return the lower half, which defines contact lines, overlap ratio and stresses."""
    return replace(pair, pinion=halves(pair.pinion)[0].gear, wheel=halves(pair.wheel)[0].gear)


def load_factors_of_half(half: GearPair, materials: PerGear[Material], load: Load, options: RatingOptions) -> LoadFactors:
    """Return the load factors of one half under its half of the load.

    f_sh is by (58) of ISO 6336-1, if it is not given.

    The pinion is taken to be in the middle between its bearings. Raises what `LoadFactors.of` raises.
    """
    found = LoadFactors.of(half, materials, load, options)
    mean_load = found.details.get("F_m_b")
    if options.shaft_deflection is not None or not isinstance(mean_load, float):
        return found
    deflection = shaft_deflection(
        mean_load,
        half.common_width.width,
        half.pinion.reference_diameter,
        shaft_term=0.0,
        compliance=helix_factors(options.helix_modification, options.standard).compliance,
        double_helical=True,
    )
    bent = LoadFactors.of(half, materials, load, replace(options, shaft_deflection=deflection))
    return replace(bent, assumed=found.assumed)


def given_factors(load: Load, options: RatingOptions, usual: float | None = None) -> LoadFactors:
    """Return the load factors as given in the options; `usual` stands for a method, if there is such a value.

    Raises ParameterError if one of them is not a number.
    """
    given = {"dynamic_factor": options.dynamic_factor, "face_load_factor": options.face_load_factor}
    given["transverse_load_factor"] = options.transverse_load_factor
    for name, value in given.items():
        if isinstance(value, str) and usual is not None:
            given[name] = usual
        elif isinstance(value, str):
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


@dataclass(frozen=True)
class Reasons:
    """Reasons why parts of a pair are not judged; `error` is the error that prevents its load factors."""

    pair: GearPair | RackPair
    materials: PerGear[Material]
    load: Load
    options: RatingOptions
    limits: PerGear[EnduranceLimits]
    roots: PerGear[RootRating[float]]
    error: InputError | None

    def of(self, part: RatedPart, role: Role) -> str:
        """Return the first reason; "" for a part that can be judged."""
        own = self._of_flank(role) if part is RatedPart.FLANK else self._of_root(role)
        return next(chain(self._of_material(part, role), own, self._of_load()), "")

    def _of_material(self, part: RatedPart, role: Role) -> Iterator[str]:
        limits, material = self.limits.pick(role), self.materials.pick(role)
        if material.plastic:
            yield "gears of plastic are rated by VDI 2736-2 in external pairs, not with a rack or a ring"
        limit, source = (
            (limits.contact, limits.contact_source) if part is RatedPart.FLANK else (limits.root, limits.root_source)
        )
        if limit is None:
            yield f"{'sigma_Hlim' if part is RatedPart.FLANK else 'sigma_Flim'} is {source}"
        elif material.group is None:
            yield "the material has no group, by which the life factor goes"

    def _of_flank(self, role: Role) -> Iterator[str]:
        if (ratio := self.pair.transverse_contact_ratio) > 2:
            yield f"Z_eps, Z_B and Z_D of ISO 6336-2 hold for a transverse contact ratio up to 2, here {ratio:.4g}"
        if self.limits.pick(role.mate).contact is None and not self.materials.pick(role.mate).plastic:
            yield f"sigma_Hlim of the {role.mate.value} is not known, and the oil film goes by the softer gear"

    def _of_root(self, role: Role) -> Iterator[str]:
        if isinstance(self.pair, RackPair) and role is Role.WHEEL:
            return
        gear = self.pair.pinion if role is Role.PINION or isinstance(self.pair, RackPair) else self.pair.wheel
        if thin := rim_of(gear).not_covered():
            yield thin
        if not self.roots.pick(role).section.on_fillet:
            yield "the tangent at 30 deg touches beyond the fillet, so Y_F and Y_S do not hold"

    def _of_load(self) -> Iterator[str]:
        options = self.options
        if not self.load.speed and (isinstance(options.dynamic_factor, str) or options.load_cycles is None):
            yield "the speed is 0 rpm: K_v, Z_v and load cycles are not known (give dynamic_factor and load_cycles)"
        elif options.bins and options.life is None and options.load_cycles is None:
            yield "a load spectrum needs life or load_cycles"
        if self.error is not None:
            yield str(self.error)


@dataclass(frozen=True, kw_only=True)
class StrengthTask:
    """The inputs of a rating, and each step of it, computed at the first access."""

    pair: GearPair | RackPair
    materials: PerGear[Material]
    load: Load
    options: RatingOptions
    driver: Role
    body_load: BodyLoad | None = None
    face_load: FaceLoadSource | None = None

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
        """Load of `rated`: half the torque if the pair is halved."""
        return replace(self.load, torque=self.load.torque / 2) if self.halved else self.load

    @cached_property
    def nominal(self) -> Rating:
        """Nominal rating, by geometry and torque."""
        if isinstance(self.rated, RackPair):
            return rate_rack(self.rated, self.materials, self.rated_load, self.options)
        return rate(self.rated, self.materials, self.rated_load, self.options)

    @cached_property
    def limits(self) -> PerGear[EnduranceLimits]:
        """Endurance limits."""
        return endurance_limits_of(self.materials)

    @cached_property
    def conditions(self) -> Conditions[float]:
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
        """Return the load factors of `rated` under a load.

        Raises what `LoadFactors.of` raises; for a rack, ParameterError if a factor is not given.
        """
        if isinstance(self.rated, RackPair):
            return given_factors(load, self.options)
        if any(each.plastic for each in self.materials):  # soft teeth even out deviations
            return given_factors(load, self.options, 1.0)
        if self.halved:
            found = load_factors_of_half(self.rated, self.materials, load, self.options)
        else:
            found = LoadFactors.of(self.rated, self.materials, load, self.options, self.face_load)
        return found if self.body_load is None else found.with_bodies(self.body_load)

    @cached_property
    def load_factors(self) -> LoadFactors | InputError:
        """Load factors of the load, or the error that prevents them."""
        try:
            self.duty.cases()
            return self.load_factors_of(self.rated_load)
        except InputError as error:
            return error

    # ------------------------------------------------------------------ parts

    @cached_property
    def reasons(self) -> Reasons:
        """Reasons why parts are not judged."""
        error = self.load_factors if isinstance(self.load_factors, InputError) else None
        return Reasons(self.rated, self.materials, self.load, self.options, self.limits, self.nominal.roots, error)

    @cached_property
    def hardening(self) -> WorkHardening[float]:
        """Work hardening factor Z_W."""
        return work_hardening(self.materials, self.conditions)

    def part(self, part: RatedPart, role: Role) -> PartStrength:
        """Return one flank or root: judged, or its known values with the reason why it is not judged."""
        if self.plastic is not None and self.materials.pick(role).plastic:
            return self.plastic.part(part, role)
        options, reason = self.options, self.reasons.of(part, role)
        required = options.required_safety_flank if part is RatedPart.FLANK else options.required_safety_root
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

    def resistance(self, part: RatedPart, role: Role) -> Resistance[float] | None:
        """sigma_HG or sigma_FG of a gear; None without its limits, or group."""
        group, limits = self.materials.pick(role).group, self.limits
        contact = limits.map(lambda each: each.contact)
        if group is None or group is MaterialGroup.PLASTIC:
            return None
        if part is RatedPart.FLANK:
            if self.materials.pick(role.mate).plastic:  # its softness has no part in the oil film
                contact = PerGear(contact.pick(role), contact.pick(role))
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
    def plastic(self) -> PlasticRating | None:
        """The rating by VDI 2736-2 of two external gears of which one is of plastic."""
        pair = self.rated
        if isinstance(pair, RackPair) or pair.internal or not any(each.plastic for each in self.materials):
            return None
        return PlasticRating(
            geometry=PlasticGeometry(pair),
            materials=self.materials,
            load=self.rated_load,
            options=self.options,
            cycles=self.duty.cycles,
            halves=2 if self.halved else 1,
        )

    @cached_property
    def scuffing(self) -> Scuffing | None:
        """Scuffing of gears whose load factors are known, under the hottest of the loads."""
        pair = self.rated
        if isinstance(pair, RackPair) or isinstance(self.load_factors, InputError):
            return None
        if any(each.plastic for each in self.materials):
            return None
        cases = self.duty.cases()
        found = [scuffing(pair, self.materials, case.load, case.factors, self.options, self.driver) for case in cases]
        return max(found, key=lambda each: 0.0 if each.integral is None else float(each.integral.value))

    @cached_property
    def tolerances(self) -> PerGear[GearTolerances[float] | None]:
        """Flank tolerances of both gears; None for a rack, and for gears outside the standard."""
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


def assumed_of(task: StrengthTask) -> Iterator[str]:
    """Yield one sentence for each input that was assumed."""
    yield from _defaults(task)
    yield from task.conditions.assumed
    if task.hardening.assumed:
        yield task.hardening.assumed
    for role, material in task.materials.items():
        if material.group is not None and not material.plastic and task.limits.pick(role).root is not None:
            notch = task.nominal.roots.pick(role).section.notch_parameter
            if said := notch_strength(material, material.group, notch).assumed:
                yield f"{said} ({task.nominal.names.pick(role)})"
    if isinstance(task.rated, RackPair) and task.duty.cycles.wheel is not None and task.options.load_cycles is None:
        yield "load cycles of the rack are those of the pinion"
    if task.duty.cycles.pinion is None and task.load.speed:
        yield "no life and no load cycles are given: endurance limits hold, with Z_NT = Y_NT = 1"
    if not isinstance(task.load_factors, InputError):
        yield from task.load_factors.assumed
    if task.scuffing is not None and task.scuffing.judged:
        yield from task.scuffing.assumed
    if task.plastic is not None:
        yield from task.plastic.assumed


def _defaults(task: StrengthTask) -> Iterator[str]:
    """Yield the defaults that a rating goes by and that nobody gave: of [rating], of the load and of the materials."""
    options = task.options
    for key, _ in assumed_values(options):
        if _counts(task, key):
            of = f" of {options.accuracy.value}" if key == "accuracy_grade" else ""
            yield f"{key} = {getattr(options, key):g}{of}"
    if is_assumed(task.load.application_factor) and not options.bins:
        yield f"application_factor = {task.load.application_factor:g}"
    found: dict[str, list[str]] = {}
    for role, material in task.materials.items():
        said = ", ".join(_constant(material, key) for key, _ in assumed_values(material) if key != "name")
        found.setdefault(said, []).append(task.nominal.names.pick(role))
    yield from (f"{said} of {' and '.join(names)}" for said, names in found.items() if said)


def _constant(material: Material, key: str) -> str:
    """Return a property of a material with its key and unit."""
    unit = schema_of(Material)[key].symbol.unit
    return f"material.{key} = {format_number(getattr(material, key))}{f' {unit}' if unit else ''}"


def _counts(task: StrengthTask, key: str) -> bool:
    """Return whether an option has an effect: the grade if a gear has none of its own, cycles if any are counted."""
    if key == "accuracy_grade":
        return any(gear.accuracy_grade is None for gear in task.pair_gears)
    if key in ("contacts_per_turn", "long_life_factor"):
        cycles = any(each is not None for each in task.duty.cycles)
        return cycles and not (key == "contacts_per_turn" and task.options.load_cycles is not None)
    return True


def verify_of(task: StrengthTask) -> Iterator[str]:
    """Yield the symbols of values to be verified."""
    yield from task.nominal.verify
    for each in task.limits:
        yield from each.verify
    yield from to_verify(
        task.options.standard,
        internal=isinstance(task.rated, GearPair) and task.rated.internal,
        limited_flank=_limited(task, RatedPart.FLANK),
        limited_root=_limited(task, RatedPart.ROOT),
    )
    if not isinstance(task.load_factors, InputError):
        yield from task.load_factors.verify
    if task.scuffing is not None and task.scuffing.judged:
        yield from task.scuffing.verify
    if task.plastic is not None:
        yield from task.plastic.verify


def _limited(task: StrengthTask, part: RatedPart) -> bool:
    """Return whether a gear has fewer load cycles than its endurance limit refers to."""
    found = ((task.resistance(part, role), task.duty.cycles.pick(role)) for role in Role)
    return any(each is not None and cycles is not None and cycles < endurance_cycles(each.points) for each, cycles in found)


_MATTERS = 0.01
"""Share of a damage from which its origin is named."""


def notices_of(task: StrengthTask, parts: Mapping[RatedPart, PerGear[PartStrength]]) -> Iterator[Notice]:
    """Yield the notices of the nominal rating, load factors, scuffing, and damage beyond the last corner of the S-N line."""
    yield from task.nominal.notices
    if not isinstance(task.load_factors, InputError):
        yield from task.load_factors.notices
    if task.scuffing is not None and task.scuffing.judged:
        yield from task.scuffing.notices
    if task.plastic is not None:
        yield from task.plastic.notices
    yield from _beyond_knee(parts, task.nominal.names)


def _beyond_knee(parts: Mapping[RatedPart, PerGear[PartStrength]], names: PerGear[str]) -> Iterator[Notice]:
    """Yield one notice for all parts with damage beyond the last corner of the S-N line."""
    found = [
        f"{share:.0%} of the {part.value} of the {names.pick(role)}"
        for part, both in parts.items()
        for role, each in both.items()
        if (share := each.beyond_knee) >= _MATTERS
    ]
    if found:
        text = "damage by loads that alone could be borne beyond 10^10 load cycles, where the S-N line goes on (ISO 6336-6)"
        yield Notice("beyond-knee", f"spectrum: {text}: {', '.join(found)}")


def rate_strength(
    pair: GearPair | RackPair,
    materials: Material | PerGear[Material],
    load: Load,
    options: RatingOptions | None = None,
    *,
    body_load: BodyLoad | None = None,
    face_load: FaceLoadSource | None = None,
    driver: Role = Role.PINION,
) -> StrengthRating:
    """Rate a pair, of one material or each gear of its own: safeties of flanks and roots, life, permissible torque, scuffing.

    `body_load` stands in place of the options' face_load_factor "fe": K_Hbeta of a load distribution; `face_load` finds K_Hbeta
    on elastic shafts for "shafts". `driver` is the gear that drives, for scuffing. What the standard does not cover, or what is
    not known, is not judged, each for its reason. Raises ParameterError without a torque, for a spectrum beside an application
    factor, and for a hardness that its material has no limit of; GeometryError for a pair whose contact the standard does not
    describe.
    """
    options = options or RatingOptions()
    if options.bins and load.application_factor != 1:
        permitted = "must be 1 with a load spectrum, which has all loads in it (ISO 6336-6)"
        raise ParameterError("load.application_factor", load.application_factor, permitted)
    if options.face_load_factor == "shafts" and face_load is None:
        raise ParameterError("rating.face_load_factor", "shafts", NO_SHAFTS)
    if body_load is not None:
        options = replace(options, face_load_factor=body_load.factor)
    both = of_both(materials)
    task = StrengthTask(
        pair=pair, materials=both, load=load, options=options, driver=driver, body_load=body_load, face_load=face_load
    )
    return _rating(task)


def _rating(task: StrengthTask) -> StrengthRating:
    """Return the full rating of a task."""
    parts = {part: PerGear(*(task.part(part, role) for role in Role)) for part in RatedPart}
    factors = None if isinstance(task.load_factors, InputError) else task.load_factors
    return StrengthRating(
        pair=task.pair,
        materials=task.materials,
        load=task.load,
        options=task.options,
        nominal=task.nominal,
        limits=task.limits,
        load_factors=factors,
        cases=() if factors is None else task.duty.cases(),
        governing=None if factors is None else task.duty.governing,
        flank=parts[RatedPart.FLANK],
        root=parts[RatedPart.ROOT],
        scuffing=task.scuffing,
        plastic=task.plastic,
        tolerances=task.tolerances,
        assumed=tuple(dict.fromkeys(assumed_of(task))),
        verify=tuple(dict.fromkeys(verify_of(task))),
        notices=tuple(dict.fromkeys(notices_of(task, parts))),
    )
