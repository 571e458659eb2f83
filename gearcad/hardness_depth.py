"""Hardness and residual stress over the depth below a flank: points that are given, or Lang's curve of a case depth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcad.core.errors import ParameterError, format_number, is_finite_number
from gearcad.core.records import Floats

if TYPE_CHECKING:
    from gearcad.material import Material

Points = tuple[tuple[float, ...], ...]
"""Depths (mm) and values."""

AT_CASE_DEPTH = 550.0
"""Hardness (HV) at the case depth CHD."""

_STEEP, _BENT = 0.0381, 0.2662
"""Coefficients of Lang's curve, as remembered: unconfirmed."""

_DEEPEST, _FEWEST, _MOST = 100.0, 2, 50


def depth_points(parameter: str, given: Any, low: float, high: float, unit: str) -> Points:
    """Return rising depths (mm) with values in `unit` within bounds, from lists of two numbers or the text of a cell.

    Raises ParameterError.
    """
    permitted = f"must be pairs of depth (mm) and {unit}, such as [[0.0, {high / 2:g}], [1.0, {high / 4:g}]]"
    found = given
    if isinstance(given, str):
        try:
            found = [[float(each) for each in item.replace(",", ".").split(":")] for item in given.split()]
        except ValueError:
            raise ParameterError(parameter, given, permitted) from None
    if not isinstance(found, list | tuple) or not _FEWEST <= len(found) <= _MOST:
        raise ParameterError(parameter, given, f"{permitted}; from {_FEWEST} to {_MOST} of them")
    for each in found:
        if not isinstance(each, list | tuple) or len(each) != 2 or not all(map(is_finite_number, each)):
            raise ParameterError(parameter, given, permitted)
        if not (0 <= each[0] <= _DEEPEST and low <= each[1] <= high):
            within = f"depths from 0 to {_DEEPEST:g} mm, values from {low:g} to {high:g} {unit}"
            raise ParameterError(parameter, given, f"must have {within}")
    depths = [each[0] for each in found]
    if any(after <= before for before, after in pairwise(depths)):
        raise ParameterError(parameter, given, "must have depths that rise")
    return tuple((float(depth), float(value)) for depth, value in found)


@dataclass(frozen=True, kw_only=True)
class HardnessProfile:
    """Hardness (HV) and residual stress (MPa) over the depth below a flank; `law` is "points" or "lang".

    `residual` are points, none for no residual stress; `deepest` (mm) is where the case has ended. `ratio` is the permissible
    shear stress over the hardness, K_tau (MPa/HV); `assumed` if it was not given.
    """

    law: str
    points: Points
    surface: float
    core: float
    case_depth: float
    residual: Points
    ratio: float
    assumed: bool

    @property
    def deepest(self) -> float:
        """Depth (mm) from which the hardness no longer changes; of Lang's curve three case depths."""
        return self.points[-1][0] if self.points else 3 * self.case_depth

    def hardness(self, depth: Floats) -> Floats:
        """Return the hardness (HV) at depths (n,) in mm: straight between points, or HV_c + (HV_s - HV_c) 10^(-0.0381 z -
        0.2662 z^2) with z = z_550 depth/CHD, z_550 such that it is 550 HV at CHD (Lang; unconfirmed).
        """
        depth = np.asarray(depth, float)
        if self.points:
            depths, values = np.array(self.points).T
            return np.asarray(np.interp(depth, depths, values), float)
        share = (AT_CASE_DEPTH - self.core) / (self.surface - self.core)
        at_case_depth = (math.sqrt(_STEEP**2 - 4 * _BENT * math.log10(share)) - _STEEP) / (2 * _BENT)
        z = at_case_depth * depth / self.case_depth
        return np.asarray(self.core + (self.surface - self.core) * 10 ** (-_STEEP * z - _BENT * z**2), float)

    def permissible_shear(self, depth: Floats) -> Floats:
        """Return tau_per = K_tau HV (MPa), an amplitude, at depths (n,) in mm."""
        return self.ratio * self.hardness(depth)

    def residual_stress(self, depth: Floats) -> Floats:
        """Return the residual stress (MPa) along the surface, alike in both directions, at depths (n,) in mm."""
        depth = np.asarray(depth, float)
        if not self.residual:
            return np.zeros_like(depth)
        depths, stresses = np.array(self.residual).T
        return np.asarray(np.interp(depth, depths, stresses), float)

    @property
    def unconfirmed(self) -> tuple[str, ...]:
        """Names of what rests on memory."""
        return (*(("K_tau",) if self.assumed else ()), *(("hardness over depth by Lang",) if self.law == "lang" else ()))


USUAL_RATIO = 0.4
"""K_tau (MPa/HV) of case-hardened steel, as remembered: unconfirmed."""


def depth_profile_of(material: Material) -> HardnessProfile | None:
    """Return the profile of a material; None if it has none. Raises ParameterError where a part of it is missing."""
    points = material.hardness_profile or ()
    if not points and material.case_depth is None:
        return None
    surface, core = material.hardness or 0.0, material.case_core_hardness or 0.0
    if not points and not 0 < core < AT_CASE_DEPTH < surface:
        limit = format_number(AT_CASE_DEPTH)
        if not 0 < core < AT_CASE_DEPTH:
            given = material.case_core_hardness
            raise ParameterError("material.case_core_hardness", given, f"must be given with case_depth, below {limit} HV")
        raise ParameterError("material.hardness", material.hardness, f"must be given with case_depth, above {limit} HV")
    return HardnessProfile(
        law="points" if points else "lang",
        points=points,
        surface=surface,
        core=core,
        case_depth=material.case_depth or 0.0,
        residual=material.residual_stress or (),
        ratio=USUAL_RATIO if material.shear_ratio is None else material.shear_ratio,
        assumed=material.shear_ratio is None,
    )
