"""The geometry of many external pairs at once: GearPair's formulas (ISO 21771) as arrays.

Lengths in mm, angles in radians, but for the helix angle, which is in degrees as in a Gear. Flanks have no backlash and gears
no thinning; tips are altered as `tip_alteration = "auto"` has it, to keep the clearance of the rack.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.geometry import BasicRack
from gearcad.geometry.involute import inverse_involute, involute
from gearcad.per_gear import PerGear, Role
from gearcad.sizing.columns import Columns
from gearcad.sizing.many_teeth import form_reach, involute_of, tip_thickness

__all__ = ["ManyPairs", "distance_for", "shift_sum_at"]


@dataclass(frozen=True, kw_only=True)
class ManyPairs(Columns):
    """Pairs by what one gives of them, arrays of one shape; all that follows has that shape.

    `key` is the place of a variant in the whole search, which does not depend on the order in which anything was given.
    """

    key: Wholes
    teeth: PerGear[Floats]
    normal_module: Floats
    helix_angle: Floats
    centre_distance: Floats
    shifts: PerGear[Floats]
    rack: BasicRack

    # ------------------------------------------------------------------ angles

    @cached_property
    def normal_angle(self) -> float:
        """alpha_n."""
        return math.radians(self.rack.pressure_angle)

    @cached_property
    def cosine(self) -> Floats:
        """cos beta."""
        return np.cos(np.radians(self.helix_angle))

    @cached_property
    def transverse_angle(self) -> Floats:
        """alpha_t."""
        return np.arctan(math.tan(self.normal_angle) / self.cosine)

    @cached_property
    def base_helix(self) -> Floats:
        """beta_b."""
        return np.arcsin(np.sin(np.radians(np.abs(self.helix_angle))) * math.cos(self.normal_angle))

    @cached_property
    def working_angle(self) -> Floats:
        """alpha_wt, of a centre distance beyond the base circles."""
        bases = self.base_diameters.pinion + self.base_diameters.wheel
        result: Floats = np.arccos(np.minimum(bases / (2 * self.centre_distance), 1.0))
        return result

    # ------------------------------------------------------------------ circles

    @cached_property
    def transverse_module(self) -> Floats:
        """m_t."""
        return self.normal_module / self.cosine

    @cached_property
    def diameters(self) -> PerGear[Floats]:
        """d."""
        return PerGear(*(z * self.transverse_module for z in self.teeth))

    @cached_property
    def base_diameters(self) -> PerGear[Floats]:
        """d_b."""
        across = np.cos(self.transverse_angle)
        return PerGear(*(d * across for d in self.diameters))

    @cached_property
    def tip_alteration(self) -> Floats:
        """k of both gears: (a - a_d)/m_n - (x_1 + x_2), never positive."""
        change = (self.centre_distance - (self.diameters.pinion + self.diameters.wheel) / 2) / self.normal_module
        result: Floats = np.minimum(change - (self.shifts.pinion + self.shifts.wheel), 0.0)
        return result

    @cached_property
    def tip_diameters(self) -> PerGear[Floats]:
        """d_a."""
        rise = self.rack.addendum + self.tip_alteration
        return PerGear(*(d + 2 * self.normal_module * (rise + x) for d, x in zip(self.diameters, self.shifts, strict=True)))

    @cached_property
    def root_diameters(self) -> PerGear[Floats]:
        """d_f."""
        dedendum = self.rack.dedendum
        return PerGear(*(d - 2 * self.normal_module * (dedendum - x) for d, x in zip(self.diameters, self.shifts, strict=True)))

    @cached_property
    def virtual_teeth(self) -> PerGear[Floats]:
        """z_n = z/(cos^2 beta_b cos beta)."""
        divisor = np.cos(self.base_helix) ** 2 * self.cosine
        return PerGear(*(z / divisor for z in self.teeth))

    @property
    def ratio(self) -> Floats:
        """u."""
        return self.teeth.wheel / self.teeth.pinion

    # ------------------------------------------------------------------ path of contact

    @cached_property
    def tangent(self) -> Floats:
        """T1T2 = a sin alpha_wt."""
        result: Floats = self.centre_distance * np.sin(self.working_angle)
        return result

    @cached_property
    def tip_reach(self) -> PerGear[Floats]:
        """Length of the base tangent out to the tip circle, of either gear; 0 inside the base circle."""
        return PerGear(
            *(
                np.sqrt(np.maximum((tip - base) * (tip + base), 0.0)) / 2
                for tip, base in zip(self.tip_diameters, self.base_diameters, strict=True)
            )
        )

    @property
    def lowest_contact(self) -> PerGear[Floats]:
        """Length of the base tangent out to the lowest point that the mate's tip reaches; negative beyond the base circle."""
        return PerGear(self.tangent - self.tip_reach.wheel, self.tangent - self.tip_reach.pinion)

    @property
    def form_reach(self) -> PerGear[Floats]:
        """Length of the base tangent out to the root form circle that a hob leaves; below 0 the tooth is undercut."""
        return PerGear(*map(self._form_reach, self.diameters, self.shifts))

    def _form_reach(self, diameter: Floats, shift: Floats) -> Floats:
        straight = self.rack.dedendum - self.root_radius * (1 - math.sin(self.normal_angle))
        return form_reach(diameter, self.transverse_angle, self.normal_module * (straight - shift))

    @property
    def root_radius(self) -> float:
        """rho_fP in normal modules, with "full" resolved."""
        radius = self.rack.root_radius
        return self.rack.full_root_radius() if radius == "full" else float(radius)

    @cached_property
    def base_pitch(self) -> Floats:
        """p_bt."""
        return math.pi * self.transverse_module * np.cos(self.transverse_angle)

    @cached_property
    def contact_ratio(self) -> Floats:
        """eps_alpha, from the tip circles."""
        return (self.tip_reach.pinion + self.tip_reach.wheel - self.tangent) / self.base_pitch

    @property
    def sliding(self) -> PerGear[Floats]:
        """Specific sliding at the lowest point of either flank, where it is greatest in size: 1 - (z/z_mate) rho_mate/rho.

        Minus infinity where the mate's tip reaches the base tangent point.
        """
        own, tips = self.lowest_contact, self.tip_reach
        made = []
        for role in Role:
            ratio, rho = self.teeth.pick(role) / self.teeth.pick(role.mate), own.pick(role)
            with np.errstate(divide="ignore", invalid="ignore"):
                made.append(np.where(rho > 0, 1 - ratio * tips.pick(role.mate) / rho, -np.inf))
        return PerGear(*made)

    # ------------------------------------------------------------------ tips

    @property
    def tip_thicknesses(self) -> PerGear[Floats]:
        """s_an, normal tooth thickness on the tip circle; below 0 the flanks meet before."""
        parts = (self.diameters, self.base_diameters, self.tip_diameters, self.shifts)
        return PerGear(*map(self._tip_thickness, *parts))

    def _tip_thickness(self, d: Floats, base: Floats, tip: Floats, shift: Floats) -> Floats:
        thickness = self.transverse_module * (math.pi / 2 + 2 * shift * math.tan(self.normal_angle))
        return tip_thickness(d, base, tip, thickness, self.transverse_angle, self.helix_angle)

    @property
    def meshes(self) -> Bools:
        """Where the base circles are apart."""
        result: Bools = self.base_diameters.pinion + self.base_diameters.wheel < 2 * self.centre_distance
        return result


def shift_sum_at(
    distance: Floats | float, teeth: Floats, normal_module: Floats, helix_angle: Floats, pressure_angle: float
) -> Floats:
    """x_1 + x_2 without backlash at a centre distance (mm), for sums of teeth; nan where the base circles overlap.

    As `profile_shift_sum` of one pair; angles in degrees.
    """
    cosine = np.cos(np.radians(helix_angle))
    transverse = np.arctan(math.tan(math.radians(pressure_angle)) / cosine)
    nearest = normal_module / cosine * teeth / 2 * np.cos(transverse)
    with np.errstate(invalid="ignore"):
        working = np.arccos(np.where(nearest < distance, nearest / distance, np.nan))
    result: Floats = teeth * (involute_of(working) - involute_of(transverse)) / (2 * math.tan(math.radians(pressure_angle)))
    return result


def distance_for(shift_sum: Floats, teeth: Floats, normal_module: Floats, helix_angle: Floats, pressure_angle: float) -> Floats:
    """Centre distance (mm) without backlash with x_1 + x_2, for sums of teeth; nan where there is none.

    As `zero_backlash_centre_distance` of one pair; angles in degrees.
    """
    cosine = np.cos(np.radians(helix_angle))
    transverse = np.arctan(math.tan(math.radians(pressure_angle)) / cosine)
    value = involute(np.degrees(transverse)) + 2 * math.tan(math.radians(pressure_angle)) * shift_sum / teeth
    working = np.radians(inverse_involute(np.maximum(value, 0.0)))
    reference = normal_module / cosine * teeth / 2
    result: Floats = np.where(value > 0, reference * np.cos(transverse) / np.cos(working), np.nan)
    return result
