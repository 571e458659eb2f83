"""K_Hbeta and K_Fbeta of a pair: by Method C of ISO 6336-1, or as given."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from gearcad.errors import ParameterError
from gearcad.notice import Notice
from gearcad.per_gear import PerGear
from gearcad.rating.deviations import helix_slope_deviations, helix_slopes_of_grade_five
from gearcad.rating.editions import Edition
from gearcad.rating.face_load import (
    bearing_width,
    face_load_exponent,
    face_load_factor,
    root_face_load_factor,
    width_to_height,
)
from gearcad.rating.load_factor_options import ContactPattern, HelixModification
from gearcad.rating.load_factors.finding import GIVEN, Finding
from gearcad.rating.load_factors.loaded_mesh import LoadedMesh
from gearcad.rating.load_factors.misalignment import (
    UNLOADED_ENDS,
    HelixFactors,
    helix_factors,
    initial_misalignment,
    least_misalignment,
    manufacturing_misalignment,
    proven_misalignment,
    shaft_deflection,
)
from gearcad.rating.load_factors.shaft import assumed_shaft, shaft_notices, term_of

__all__ = ["Misalignment", "face_load_factors"]

_NOT_FOUND = 'must be "C" or a number here: a load distribution of our own is found by gearcad rate, before the rating'


def face_load_factors(mesh: LoadedMesh, mean_load: float) -> Finding:
    """K_Hbeta and K_Fbeta under F_m/b (N/mm). Raises ParameterError for a shaft that is half given, and as tolerances do."""
    method = mesh.options.face_load_factor
    if method == "fe":
        raise ParameterError("rating.face_load_factor", method, _NOT_FOUND)
    flank = (
        Finding(factors={"K_Hbeta": method}, sources={"K_Hbeta": GIVEN}, notices=tuple(_notices_of_given(method)))
        if not isinstance(method, str)
        else _method_c(mesh, mean_load)
    )
    return _with_root(mesh, flank)


class Misalignment(NamedTuple):
    """F_beta_x, and what it is of: f_sh, f_Hbeta of both gears, f_ma, B_1 and B_2, and the least that is taken. In µm."""

    deflection: float
    slopes: PerGear[float]
    manufacture: float
    factors: HelixFactors
    least: float
    initial: float

    @classmethod
    def of(cls, mesh: LoadedMesh, mean_load: float) -> Misalignment:
        """Under F_m/b (N/mm), by (52) or, with a proven contact pattern, (53). Raises ParameterError."""
        options = mesh.options
        slopes = helix_slope_deviations(mesh.pair, options)
        deflection = _shaft_deflection(mesh, mean_load)
        manufacture = options.manufacturing_misalignment
        if manufacture is None:
            manufacture = manufacturing_misalignment(*slopes)
        least = least_misalignment(mean_load, max(slopes))
        factors = helix_factors(options.helix_modification, options.standard)
        if options.contact_pattern is ContactPattern.PROVEN:
            compensation = options.given_compensation
            if compensation is None:
                compensation = min(helix_slopes_of_grade_five(mesh.pair, options))
            initial = proven_misalignment(deflection, compensation, factors, least)
        else:
            initial = initial_misalignment(deflection, manufacture, factors, least)
        return cls(deflection, slopes, manufacture, factors, least, initial)


def _method_c(mesh: LoadedMesh, mean_load: float) -> Finding:
    options, stiffness = mesh.options, mesh.stiffness.mesh_beta
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
    """Whether figure 13, (53) or what DIN 3990-1 has of modified flanks is in K_Hbeta: each by one source, or from memory."""
    options = mesh.options
    of_shaft = bool(options.pinion_offset) and options.shaft_deflection is None
    modified = options.helix_modification is not HelixModification.NONE
    of_din = options.standard is Edition.DIN_1987 and modified
    return of_shaft or of_din or options.contact_pattern is ContactPattern.PROVEN


def _shaft_deflection(mesh: LoadedMesh, mean_load: float) -> float:
    """f_sh (µm): as given, or by (57)."""
    if mesh.options.shaft_deflection is not None:
        return mesh.options.shaft_deflection
    compliance = helix_factors(mesh.options.helix_modification, mesh.options.standard).compliance
    diameter = mesh.pair.pinion.reference_diameter
    return shaft_deflection(mean_load, mesh.width, diameter, shaft_term=term_of(mesh), compliance=compliance)


def _notices(mesh: LoadedMesh, effective: float, mean_load: float) -> Iterator[Notice]:
    """Where little of the width carries, and of crowned gears that the options do not know of."""
    if (width := bearing_width(effective, mesh.stiffness.mesh_beta, mean_load)) < 1:
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
    """Above 2 a load that falls off evenly does not reach the other end: b_cal/b = 2/K_Hbeta (ISO 6336-1:2006, 7.5)."""
    if factor > 2:
        text = f"a load that falls off evenly so much would be carried by {2 / factor:.0%} of the face width"
        yield Notice("narrow-bearing", f"K_Hbeta = {factor:.4g}: {text}")


def _with_root(mesh: LoadedMesh, flank: Finding) -> Finding:
    """With K_Fbeta beside K_Hbeta."""
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
