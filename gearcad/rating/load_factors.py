"""LoadFactors: all load factors of a pair under a load, by ISO 6336-1 or DIN 3990-1, or as given.

The formulas of K_v (Method B) and of K_Hbeta (from a misalignment) are in `gearcad.rating.load_factor_formulas`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Generic, NamedTuple

from gearcad.core.errors import InputError, ParameterError
from gearcad.core.records import Notice, PerGear, is_assumed
from gearcad.core.values import Values, larger, smaller
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material, of_both
from gearcad.rating.contact_stress import contact_ratio_factor
from gearcad.rating.dynamic_factor import DynamicFactor, flank_wear
from gearcad.rating.editions import Edition
from gearcad.rating.load_factor_formulas import (
    STATED,
    STIFFENING_RATIO,
    UNLOADED_ENDS,
    FlankWear,
    HelixFactors,
    arrangement_factor,
    bearing_width,
    circumferential_speed,
    dynamic_factor_c,
    face_load_exponent,
    face_load_factor,
    flank_limit,
    helix_factors,
    initial_misalignment,
    inner_diameter,
    least_misalignment,
    lower_limit,
    manufacturing_misalignment,
    mass_of,
    offset_limit,
    pair_mass,
    proven_misalignment,
    root_face_load_factor,
    root_limit,
    shaft_deflection,
    shaft_term,
    speed_measure,
    speed_measure_limit,
    transverse_load_factor,
    width_to_height,
    within,
)
from gearcad.rating.nominal_rating import require_ratable
from gearcad.rating.options import (
    AlphaDeviation,
    BearingArrangement,
    ContactPattern,
    HelixModification,
    RatingOptions,
    accuracy_grades,
    base_pitch_deviations,
    helix_slope_deviations,
    helix_slopes_of_grade_five,
    profile_form_deviations,
)
from gearcad.rating.tolerances import Accuracy
from gearcad.rating.tooth_stiffness import MeshStiffness, mesh_stiffness

GIVEN = "given"
ASSUMED = "assumed"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """`factors` and the `details` behind them under their symbols, µm, N/mm, N/(mm·µm), rpm, kg/mm; a mapping is of both gears.

    `sources` are the clauses that factors are from. `unknown` are symbols of factors in whose place 1 stands, `verify` those
    that rest on a text that was not at hand.
    """

    factors: Mapping[str, float]
    sources: Mapping[str, str]
    details: Mapping[str, float | Mapping[str, float]] = field(default_factory=dict)
    unknown: tuple[str, ...] = ()
    notices: tuple[Notice, ...] = ()
    assumed: tuple[str, ...] = ()
    verify: tuple[str, ...] = ()


class FaceLoad(NamedTuple):
    """Load over the face on elastic shafts: K_Hbeta of the greatest slice, and carried on to the end of the face.

    `deflection` f_sh (µm) is the slope of the gap that the shafts leave under an even load, `misalignment` (µm) that beside it,
    both positive where the gap opens towards larger z; `carrying` the part of the face width that carries. `assumed` says what
    was not given of the shafts.
    """

    factor: float
    factor_at_end: float
    deflection: float
    misalignment: float
    carrying: float = 1.0
    assumed: tuple[str, ...] = ()


FaceLoadSource = Callable[[float, float, float], FaceLoad]
"""A function of the torque on the pinion (N·m, with all factors before K_Hbeta), c_gamma_beta (N/(mm·µm)) and f_ma (µm).

It returns the load over the face of one mesh on its shafts.
"""


@dataclass(frozen=True, kw_only=True)
class LoadedMesh:
    """Inputs of a rating that follow from pair and load. Loads in N and N/mm, lengths in mm, speed in m/s.

    `face_load` finds the load over the face on the shafts, where they are known.
    """

    pair: GearPair
    materials: PerGear[Material]
    load: Load
    options: RatingOptions
    face_load: FaceLoadSource | None = None

    @cached_property
    def width(self) -> float:
        """b: the common face width."""
        return self.pair.common_width.width

    @cached_property
    def specific_load(self) -> float:
        """F_t K_A K_gamma/b."""
        force = 2000 * abs(self.load.torque) / self.pair.pinion.reference_diameter
        return force * self.load.application_factor * self.options.mesh_load_factor / self.width

    @cached_property
    def stiffness(self) -> MeshStiffness[float]:
        """Mesh stiffness under the specific load, N/(mm·µm)."""
        return mesh_stiffness(self.pair, self.materials, self.specific_load)

    @property
    def face_stiffness(self) -> float:
        """c_gamma_beta, N/(mm·µm): as given, or that under the specific load."""
        given = self.options.face_mesh_stiffness
        return self.stiffness.mesh_beta if given is None else given

    @cached_property
    def speed(self) -> float:
        """v at the reference circle."""
        return circumferential_speed(self.pair.pinion.reference_diameter, self.load.speed)

    @cached_property
    def wear(self) -> FlankWear:
        """Running-in of the flanks of both gears. Raises ParameterError if it depends on a limit that is not known."""
        return flank_wear(self.materials)

    @cached_property
    def grade(self) -> int:
        """The accuracy grade of the coarser gear."""
        return max(accuracy_grades(self.pair, self.options))

    def cited(self, clause: str, method: str) -> str:
        """Return the citation of a clause of ISO 6336-1:2006, or of DIN 3990-1 without its clause.

        Later editions of ISO 6336-1 share the clauses as far as is known.
        """
        edition = self.options.standard
        if edition is Edition.DIN_1987:
            return f"{edition.dated_part(1)} ({method})"
        return f"{Edition.ISO_2006.dated_part(1)}, {clause} ({method})"


def term_of(options: RatingOptions, diameter: Values) -> Values:
    """K' l s/d_1^2 (d_1/d_sh)^4 by the pinion's reference diameter (mm): 0 in the middle between the bearings.

    Raises ParameterError where the pinion is not there but its shaft is not given.
    """
    place = options.pinion_place
    if not options.pinion_offset:
        if place is BearingArrangement.OVERHUNG:
            permitted = f'must not be 0 mm for bearing_arrangement "{place.value}": how far the pinion overhangs'
            raise ParameterError("rating.pinion_offset", options.pinion_offset, permitted, "mm")
        return 0.0
    span, shaft = options.bearing_span, options.shaft_diameter
    for name, value in (("bearing_span", span), ("shaft_diameter", shaft)):
        if value is None:
            raise ParameterError(f"rating.{name}", None, "must be given with pinion_offset: the shaft bends by it")
    assert span is not None and shaft is not None  # seen to just now
    factor = arrangement_factor(place, options.stiffening, diameter / shaft)
    return shaft_term(factor, span, options.pinion_offset, diameter, shaft)


def deflection_of(options: RatingOptions, mean_load: Values, width: Values, diameter: Values) -> Values:
    """Return f_sh (µm): as given, or by (57), under F_m/b (N/mm). Raises ParameterError for a shaft that is half given."""
    if options.shaft_deflection is not None:
        return options.shaft_deflection
    compliance = helix_factors(options.helix_modification, options.standard).compliance
    return shaft_deflection(mean_load, width, diameter, shaft_term=term_of(options, diameter), compliance=compliance)


def assumed_shaft(mesh: LoadedMesh) -> tuple[str, ...]:
    """Return one sentence if the pinion's place on its shaft, or its bearing arrangement, was assumed; else nothing."""
    options = mesh.options
    if options.pinion_offset and options.bearing_arrangement is None:
        return (f"bearing_arrangement = {options.pinion_place.value}: torque comes from the side of the nearer bearing",)
    if options.pinion_offset or options.bearing_span is not None:
        return ()
    return ("K_Hbeta: the pinion is in the middle between its bearings (s = 0), so f_sh is of the pinion alone",)


def shaft_notices(mesh: LoadedMesh) -> Iterator[Notice]:
    """Yield a notice for each way in which the shaft leaves the range of figure 13."""
    options = mesh.options
    span, shaft, offset = options.bearing_span, options.shaft_diameter, abs(options.pinion_offset)
    if span is None or shaft is None or not offset:
        return
    limit = offset_limit(options.pinion_place)
    if offset > limit * span:
        text = f"f_sh is stated for s/l up to {limit:g}, here {offset / span:.3g}"
        yield Notice("shaft-offset", f"K_Hbeta: {text}")
    ratio = mesh.pair.pinion.reference_diameter / shaft
    if options.stiffening and ratio < STIFFENING_RATIO:
        text = f"d_1/d_sh is {ratio:.3g}: a pinion stiffens its shaft from {STIFFENING_RATIO:g} on, so K' is that without"
        yield Notice("no-stiffening", f"K_Hbeta: {text}")


_NOT_FOUND = 'must be "C" or a number here: a load distribution of our own is found by gearcad rate, before the rating'
NO_SHAFTS = 'must be "C" or a number here: no gear has a shaft with its bearings, such as [[pinion.shaft]]'
"""Permitted sources of the face load factor without shafts."""


def face_load_factors(mesh: LoadedMesh, mean_load: float) -> Finding:
    """K_Hbeta and K_Fbeta under F_m/b (N/mm). Raises ParameterError for a shaft that is half given, and as tolerances do."""
    method = mesh.options.face_load_factor
    if method == "fe":
        raise ParameterError("rating.face_load_factor", method, _NOT_FOUND)
    if method == "shafts":
        return _with_root(mesh, _by_shafts(mesh, mean_load))
    flank = (
        Finding(factors={"K_Hbeta": method}, sources={"K_Hbeta": GIVEN}, notices=tuple(_notices_of_given(method)))
        if not isinstance(method, str)
        else _method_c(mesh, mean_load)
    )
    return _with_root(mesh, flank)


def _by_shafts(mesh: LoadedMesh, mean_load: float) -> Finding:
    """Return K_Hbeta of the load over the face on elastic shafts, f_ma to each of its sides, and Method C beside it.

    ISO 6336-1, annex E: F_m = F_t K_A K_gamma K_v, and the worse side counts. Raises ParameterError without shafts, and as
    tolerances do where f_ma is not given.
    """
    if mesh.face_load is None:
        raise ParameterError("rating.face_load_factor", "shafts", NO_SHAFTS)
    options, stiffness = mesh.options, mesh.face_stiffness
    given = options.manufacturing_misalignment
    manufacture = manufacturing_misalignment(*helix_slope_deviations(mesh.pair, options)) if given is None else given
    torque = math.copysign(mean_load * mesh.width * mesh.pair.pinion.reference_diameter / 2000, mesh.load.torque)
    found = {side: mesh.face_load(torque, stiffness, side) for side in options.sides_of(manufacture)}
    side, worst = max(found.items(), key=lambda each: each[1].factor)
    beside = _method_c_beside(mesh, mean_load, worst, stiffness)
    return Finding(
        factors={"K_Hbeta": worst.factor},
        sources={"K_Hbeta": mesh.cited("annex E", "line load on elastic shafts")},
        details={
            "F_m_b": mean_load,
            "f_sh": worst.deflection,
            "f_ma": side,
            "c_gamma_beta": stiffness,
            "K_Hbeta_end_of_face": worst.factor_at_end,
            **beside.details,
        },
        notices=tuple(_notices_of_line_load(worst)),
        assumed=(*worst.assumed, *beside.assumed),
        verify=("K_Hbeta",),
    )


def _notices_of_line_load(found: FaceLoad) -> Iterator[Notice]:
    """Yield a notice if only a part of the face width carries."""
    if found.carrying < 1:
        yield Notice("narrow-bearing", f"K_Hbeta: only {found.carrying:.0%} of the face width carries on its shafts")


def _method_c_beside(mesh: LoadedMesh, mean_load: float, found: FaceLoad, stiffness: float) -> Finding:
    """Return f_sh and K_Hbeta of Method C, and why the load over the face on shafts is another, step by step.

    First f_sh of the shafts takes the place of that of Method C; then its factor 1.33, B_1, B_2, the least misalignment and
    running-in are left out; what is left is the shape of the gap.
    """
    try:
        ours = _method_c(mesh, mean_load)
        same = _method_c(replace(mesh, options=replace(mesh.options, shaft_deflection=abs(found.deflection))), mean_load)
    except InputError:  # sizes or shafts that Method C does not cover
        return Finding(factors={}, sources={})
    straight = face_load_factor(abs(found.deflection + found.misalignment), stiffness, mean_load)
    of_c, of_same = ours.factors["K_Hbeta"], same.factors["K_Hbeta"]
    deflection = ours.details["f_sh"]
    assert isinstance(deflection, float | int)
    said = (
        f"K_Hbeta: {found.factor:.4g} on shafts beside {of_c:.4g} of Method C: f_sh = {found.deflection:.3g} µm of both shafts"
        f" in place of {deflection:.3g} µm makes {of_same - of_c:+.3g}, no factor 1.33, table 8, least misalignment and"
        f" running-in {straight - of_same:+.3g}, shape of the gap and modified flanks {found.factor - straight:+.3g}"
    )
    return Finding(
        factors={},
        sources={},
        details={"f_sh_C": deflection, "K_Hbeta_C": of_c, "K_Hbeta_C_shafts": of_same, "K_Hbeta_straight": straight},
        assumed=(said,),
    )


class Misalignment(NamedTuple, Generic[Values]):
    """F_beta_x and its parts in µm: f_sh, f_Hbeta of both gears, f_ma, B_1 and B_2, and the least value."""

    deflection: Values
    slopes: PerGear[Values]
    manufacture: Values
    factors: HelixFactors
    least: Values
    initial: Values

    @classmethod
    def of(cls, mesh: LoadedMesh, mean_load: float) -> Misalignment[float]:
        """Return the misalignment of a mesh under F_m/b (N/mm). Raises ParameterError."""
        pair, options = mesh.pair, mesh.options
        deflection = deflection_of(options, mean_load, mesh.width, pair.pinion.reference_diameter)
        slopes = helix_slope_deviations(pair, options)
        return Misalignment.from_options(
            options, deflection, slopes, lambda: helix_slopes_of_grade_five(pair, options), mean_load
        )

    @classmethod
    def from_options(
        cls,
        options: RatingOptions,
        deflection: Values,
        slopes: PerGear[Values],
        slopes_of_grade_five: Callable[[], PerGear[Values]],
        mean_load: Values,
    ) -> Misalignment[Values]:
        """Return the misalignment under F_m/b (N/mm), by (52) or, with a proven contact pattern, (53).

        `deflection` is f_sh, `slopes` are f_Hbeta.
        """
        given = options.manufacturing_misalignment
        manufacture = manufacturing_misalignment(*slopes) if given is None else abs(given)
        least = least_misalignment(mean_load, larger(*slopes))
        factors = helix_factors(options.helix_modification, options.standard)
        if options.contact_pattern is ContactPattern.PROVEN:
            compensation = options.given_compensation
            opposite = smaller(*slopes_of_grade_five()) if compensation is None else compensation
            initial = proven_misalignment(deflection, opposite, factors, least)
        else:
            initial = initial_misalignment(deflection, manufacture, factors, least)
        return Misalignment(deflection, slopes, manufacture, factors, least, initial)


def _method_c(mesh: LoadedMesh, mean_load: float) -> Finding:
    options, stiffness = mesh.options, mesh.face_stiffness
    off = Misalignment.of(mesh, mean_load)
    worn = float(mesh.wear.beta(off.initial, mesh.speed))
    effective = off.initial - worn
    given = options.shaft_deflection is not None
    return Finding(
        factors={"K_Hbeta": face_load_factor(effective, stiffness, mean_load)},
        sources={"K_Hbeta": mesh.cited("7.5", "Method C")},
        details={
            "F_m_b": mean_load,
            "f_sh": off.deflection,
            "f_Hbeta": {role.value: slope for role, slope in off.slopes.items()},
            "f_ma": off.manufacture,
            "B_1": off.factors.deflection,
            "B_2": off.factors.manufacture,
            "F_betax_min": off.least,
            "F_betax": off.initial,
            "y_beta": worn,
            "F_betay": effective,
            "c_gamma_beta": stiffness,
        },
        notices=(*(() if given else shaft_notices(mesh)), *_notices(mesh, effective, mean_load)),
        assumed=() if given else assumed_shaft(mesh),
        verify=("K_Hbeta",) if _recalled(mesh) else (),
    )


def _recalled(mesh: LoadedMesh) -> bool:
    """Return whether K_Hbeta rests on figure 13, (53) or DIN 3990-1's values for modified flanks.

    Each of them is known by one source, or from memory.
    """
    options = mesh.options
    of_shaft = bool(options.pinion_offset) and options.shaft_deflection is None
    modified = options.helix_modification is not HelixModification.NONE
    of_din = options.standard is Edition.DIN_1987 and modified
    return of_shaft or of_din or options.contact_pattern is ContactPattern.PROVEN


def _notices(mesh: LoadedMesh, effective: float, mean_load: float) -> Iterator[Notice]:
    """Yield notices if only a part of the face width carries, and if gears have helix modifications that the options do not
    state.
    """
    if (width := bearing_width(effective, mesh.face_stiffness, mean_load)) < 1:
        text = f"only {width:.0%} of the face width would carry: F_beta_y = {effective:.3g} µm is too much for this load"
        yield Notice("narrow-bearing", f"K_Hbeta: {text}")
    modified = [
        role.value
        for role, gear in mesh.pair.gears.items()
        if gear.modification.lead_crowning or gear.modification.end_relief or gear.modification.helix_angle_modification
    ]
    if modified and mesh.options.helix_modification is HelixModification.NONE:
        text = "flanks are modified along the face width, which Method C leaves out: helix_modification tells, or "
        yield Notice("helix-modification-unsaid", f'K_Hbeta: {text}face_load_factor = "fe"', " and ".join(modified))


def _notices_of_given(factor: float) -> Iterator[Notice]:
    """Yield a notice if a given K_Hbeta is above 2: then the load does not reach the other end of the teeth.

    For a load that falls off evenly, b_cal/b = 2/K_Hbeta (ISO 6336-1:2006, 7.5).
    """
    if factor > 2:
        text = f"a load that falls off evenly so much would be carried by {2 / factor:.0%} of the face width"
        yield Notice("narrow-bearing", f"K_Hbeta = {factor:.4g}: {text}")


def _with_root(mesh: LoadedMesh, flank: Finding) -> Finding:
    """Return the finding of K_Hbeta with K_Fbeta added."""
    factor, ratio = flank.factors["K_Hbeta"], width_to_height(mesh.pair)
    unloaded = mesh.options.helix_modification in UNLOADED_ENDS
    root = factor if unloaded else root_face_load_factor(factor, ratio)
    exponent = 1.0 if unloaded else face_load_exponent(ratio)
    return Finding(
        factors={**flank.factors, "K_Fbeta": root},
        sources={**flank.sources, "K_Fbeta": mesh.cited("7.6", "from K_Hbeta")},
        details={**flank.details, "b_h": ratio, "N_F": exponent},
        notices=flank.notices,
        assumed=flank.assumed,
        verify=(*flank.verify, *(("K_Fbeta",) if unloaded else ())),
    )


def alpha_deviations(options: RatingOptions, pitch: Values, profile: Values) -> tuple[Values, Values]:
    """Return the deviation f of K_Halpha, the larger of f_pb and f_falpha (µm), and the deviation that runs in."""
    deviation = larger(pitch, profile)
    return deviation, deviation if options.alpha_deviation_rule is AlphaDeviation.LITERAL else pitch


def transverse_load_factors(mesh: LoadedMesh, mean_load: float) -> Finding:
    """K_Halpha and K_Falpha under F_tH/b (N/mm), by the larger of f_pb and f_falpha. Raises ParameterError as tolerances do."""
    given = mesh.options.transverse_load_factor
    if not isinstance(given, str):
        return Finding(factors={"K_Halpha": given, "K_Falpha": given}, sources={"K_Halpha": GIVEN, "K_Falpha": GIVEN})
    pair, stiffness = mesh.pair, mesh.stiffness.mesh_alpha
    gamma, alpha = pair.total_contact_ratio, pair.transverse_contact_ratio
    pitch, profile = max(base_pitch_deviations(pair, mesh.options)), max(profile_form_deviations(pair, mesh.options))
    deviation, running_in = alpha_deviations(mesh.options, pitch, profile)
    worn = float(mesh.wear.alpha(running_in, mesh.speed))
    factor = transverse_load_factor(gamma, stiffness, deviation, worn, mean_load)
    of_flank = flank_limit(gamma, alpha, contact_ratio_factor(alpha, pair.overlap_ratio))
    of_root = root_limit(gamma, alpha)
    return Finding(
        factors={"K_Halpha": within(factor, of_flank), "K_Falpha": within(factor, of_root)},
        sources=dict.fromkeys(("K_Halpha", "K_Falpha"), mesh.cited("8.3", "Method B")),
        details={
            "F_tH_b": mean_load,
            "f_pb": pitch,
            "f_falpha": profile,
            "y_alpha": worn,
            "c_gamma_alpha": stiffness,
            "K_alpha": factor,
            "K_Halpha_max": of_flank,
            "K_Falpha_max": of_root,
        },
    )


_MAIN_END = 1.15

_NO_SPEED = Notice("no-speed", "K_v: the speed is 0 rpm, so K_v is not known; 1 stands in its place in all factors after it")
_MEMORY_GRADE = 12
"""The grade whose K_1 is from memory."""


def dynamic_factor(mesh: LoadedMesh) -> Finding:
    """K_v by the method of the options. Raises ParameterError for a grade that Method C or the tolerances do not cover."""
    method = mesh.options.dynamic_factor
    if not isinstance(method, str):
        return Finding(factors={"K_v": method}, sources={"K_v": GIVEN})
    if not mesh.speed:
        return Finding(factors={"K_v": 1.0}, sources={}, unknown=("K_v",), notices=(_NO_SPEED,))
    return _method_b(mesh) if method == "B" else _dynamic_method_c(mesh)


def _method_b(mesh: LoadedMesh) -> Finding:
    """Return K_v of Method B: from the resonance ratio, with the masses of both gear bodies."""
    masses = [mass_of(gear, material.density) for gear, material in zip(mesh.pair.gears, mesh.materials, strict=True)]
    mass = pair_mass(*masses)
    found = DynamicFactor.at(mesh.pair, mesh.materials, mesh.specific_load, mesh.stiffness, mass, mesh.options)
    speed = abs(mesh.load.speed)
    ratio, (b_p, b_f, b_k), (y_p, y_f) = speed / found.resonance_speed, found.effects(speed), found.allowances(speed)
    details = {
        "m_red": mass,
        "n_E1": found.resonance_speed,
        "N": ratio,
        "N_S": lower_limit(mesh.specific_load),
        "f_pb": found.pitch_deviation,
        "f_falpha": found.profile_deviation,
        "y_p": float(y_p),
        "y_f": float(y_f),
        "C_a": found.tip_relief,
        "B_p": float(b_p),
        "B_f": float(b_f),
        "B_k": b_k,
    }
    return Finding(
        factors={"K_v": float(found.values(speed))},
        sources={"K_v": mesh.cited("6.5", "Method B")},
        details=details,
        notices=(*found.notices, *_resonance_notices(details["N_S"], ratio)),
        assumed=tuple(_assumed_masses(mesh)),
    )


def _resonance_notices(lower: float, ratio: float) -> Iterator[Notice]:
    if lower < ratio <= _MAIN_END:
        text = f"the pair runs in its main resonance, N = {ratio:.3g}: K_v is uncertain there, and such speeds are best avoided"
        yield Notice("main-resonance", f"K_v: {text}")


def _assumed_masses(mesh: LoadedMesh) -> Iterator[str]:
    """Yield one sentence for each assumption about the bodies whose mass is in m_red."""
    yield "K_v: m_red of plain discs or rims of the gears' own material, without hubs, shafts and what else turns with them"
    if mesh.pair.internal and inner_diameter(mesh.pair.wheel) is None:
        yield "K_v: the ring is held, as its rim is not given: m_red is that of the pinion"


def _dynamic_method_c(mesh: LoadedMesh) -> Finding:
    """Return K_v of Method C: from speed and accuracy grade alone."""
    pair, edition = mesh.pair, mesh.options.standard
    measure = speed_measure(mesh.speed, float(pair.pinion.teeth), pair.gear_ratio)
    factor = dynamic_factor_c(mesh.specific_load, measure, pair.overlap_ratio, mesh.grade, edition)
    return Finding(
        factors={"K_v": factor},
        sources={"K_v": mesh.cited("6.6", "Method C")},
        details={"v_z1_100": measure},
        notices=tuple(_notices_of_c(mesh, measure)),
        verify=("K_v",) if mesh.grade == _MEMORY_GRADE or measure > STATED else (),
    )


def _notices_of_c(mesh: LoadedMesh, measure: float) -> Iterator[Notice]:
    """Yield a notice for each way in which the pair leaves the range that Method C is stated for."""
    limit = speed_measure_limit(mesh.pair.overlap_ratio)
    if measure >= limit:
        text = (
            f"stated below v z_1/100 sqrt(u²/(1 + u²)) = {limit:g} m/s, here {measure:.3g} m/s: well below the main resonance"
        )
        yield Notice("dynamic-factor-c-speed", f"K_v of Method C: {text}")
    if mesh.options.accuracy is not Accuracy.ISO_1995:
        text = f"its grades are those of {Accuracy.ISO_1995.value}, not the classes of {mesh.options.accuracy.value}"
        yield Notice("dynamic-factor-c-grade", f"K_v of Method C: {text}")


_OF_BODIES = "ISO 6336-1:2006, Method A: load along the face of solid bodies (finite elements)"


class BodyLoad(NamedTuple):
    """K_Hbeta that solid bodies find, whose flanks stand off by F_beta_y (µm): the mounting's if `mounted`, else C's."""

    factor: float
    misalignment: float
    mounted: bool

    @property
    def said(self) -> str:
        """Sentence that states the misalignment used for the solid bodies, and why K_Hbeta is larger than by Method C."""
        source = "[mounting]" if self.mounted else "Method C, as [mounting] has none"
        return (
            f"K_Hbeta: the solid bodies stand off by F_beta_y = {self.misalignment:.3g} µm of {source}; "
            "a force moves the teeth beside it too, so that they give way to a tilt less than c_gamma_beta of Method C says"
        )


LOAD_FACTORS = {
    "K_A": "application",
    "K_gamma": "mesh_load",
    "K_v": "dynamic",
    "K_Hbeta": "face_flank",
    "K_Fbeta": "face_root",
    "K_Halpha": "transverse_flank",
    "K_Falpha": "transverse_root",
}
"""Attributes of LoadFactors by the symbols of the factors, in the order of all outputs."""


@dataclass(frozen=True, kw_only=True)
class LoadFactors:
    """K_A, K_gamma, K_v, K_Hbeta, K_Fbeta, K_Halpha and K_Falpha; each is of the load times all before it.

    `details` are the figures behind them under their symbols (µm, N/mm, N/(mm·µm), rpm, kg/mm; a mapping is of both gears),
    `sources` the clause of each factor. `unknown` are symbols of factors in whose place 1 stands, `assumed` what was taken for
    granted, `verify` factors that rest on a text that was not at hand.
    """

    application: float = 1.0
    mesh_load: float = 1.0
    dynamic: float = 1.0
    face_flank: float = 1.0
    face_root: float = 1.0
    transverse_flank: float = 1.0
    transverse_root: float = 1.0
    details: Mapping[str, float | Mapping[str, float]] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict)
    unknown: tuple[str, ...] = ()
    notices: tuple[Notice, ...] = ()
    assumed: tuple[str, ...] = ()
    verify: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        pair: GearPair,
        materials: Material | PerGear[Material],
        load: Load,
        options: RatingOptions | None = None,
        face_load: FaceLoadSource | None = None,
    ) -> LoadFactors:
        """Return the load factors of a pair of one material or two, under a load; numbers in the options are used as given.

        `face_load` finds the load over the face for the options' face_load_factor "shafts".

        Raises ParameterError without a torque, for what a method needs and was not given, and beyond the tables of tolerances;
        GeometryError for a pair whose contact the standard does not describe, double helical ones among them.
        """
        require_ratable(pair, load)
        mesh = LoadedMesh(
            pair=pair, materials=of_both(materials), load=load, options=options or RatingOptions(), face_load=face_load
        )
        speed = dynamic_factor(mesh)
        mean_load = mesh.specific_load * speed.factors["K_v"]
        face = face_load_factors(mesh, mean_load)
        across = transverse_load_factors(mesh, mean_load * face.factors["K_Hbeta"])
        found = (speed, face, across)
        return cls(
            application=load.application_factor,
            mesh_load=mesh.options.mesh_load_factor,
            dynamic=speed.factors["K_v"],
            face_flank=face.factors["K_Hbeta"],
            face_root=face.factors["K_Fbeta"],
            transverse_flank=across.factors["K_Halpha"],
            transverse_root=across.factors["K_Falpha"],
            details={symbol: value for each in found for symbol, value in each.details.items()},
            sources={
                "K_A": ASSUMED if is_assumed(load.application_factor) else GIVEN,
                "K_gamma": ASSUMED if is_assumed(mesh.options.mesh_load_factor) else GIVEN,
                **{symbol: clause for each in found for symbol, clause in each.sources.items()},
            },
            unknown=tuple(symbol for each in found for symbol in each.unknown),
            notices=tuple(notice for each in found for notice in each.notices),
            assumed=tuple(text for each in found for text in each.assumed),
            verify=tuple(symbol for each in found for symbol in each.verify),
        )

    def with_bodies(self, found: BodyLoad) -> LoadFactors:
        """Return these load factors with K_Hbeta cited as found by solid bodies.

        The options must already hold that K_Hbeta as a number.
        """
        return replace(self, sources={**self.sources, "K_Hbeta": _OF_BODIES}, assumed=(*self.assumed, found.said))

    def to_dict(self) -> dict[str, float | None]:
        """Return the values under their symbols; None for those that are not known."""
        return {symbol: None if symbol in self.unknown else getattr(self, name) for symbol, name in LOAD_FACTORS.items()}
