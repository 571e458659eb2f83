"""The pinion's shaft, as the options have it."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.errors import ParameterError
from gearcad.notice import Notice
from gearcad.rating.load_factor_options import BearingArrangement
from gearcad.rating.load_factors.loaded_mesh import LoadedMesh
from gearcad.rating.load_factors.misalignment import STIFFENING_RATIO, arrangement_factor, offset_limit, shaft_term

__all__ = ["assumed_shaft", "shaft_notices", "term_of"]


def term_of(mesh: LoadedMesh) -> float:
    """K' l s/d_1^2 (d_1/d_sh)^4: 0 of a pinion in the middle between its bearings.

    Raises ParameterError where the pinion is not there but its shaft is not given.
    """
    options, diameter = mesh.options, mesh.pair.pinion.reference_diameter
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


def assumed_shaft(mesh: LoadedMesh) -> tuple[str, ...]:
    """What stands for a shaft that is not given."""
    options = mesh.options
    if options.pinion_offset and options.bearing_arrangement is None:
        return (f"bearing_arrangement = {options.pinion_place.value}: torque comes from the side of the nearer bearing",)
    if options.pinion_offset or options.bearing_span is not None:
        return ()
    return ("K_Hbeta: the pinion is in the middle between its bearings (s = 0), so f_sh is of the pinion alone",)


def shaft_notices(mesh: LoadedMesh) -> Iterator[Notice]:
    """Where the shaft is not one of figure 13."""
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
