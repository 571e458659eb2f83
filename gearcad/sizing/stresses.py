"""Nominal and permissible stresses of many pairs at once: the formulas of `gearcad.rating` (ISO 6336, Method B) on arrays.

Solid discs of equal width, cut by a hob, without thinning. Lengths in mm, stresses in MPa, angles in degrees; what does not
depend on the face width has the shape of the pairs, all else that of pairs and widths together.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.core.records import Floats, PerGear, Role
from gearcad.core.values import Numbers, chosen
from gearcad.geometry.path_of_contact import overlap_ratio_of
from gearcad.material import Material, MaterialGroup
from gearcad.rating.contact_stress import (
    contact_factor,
    contact_ratio_factor,
    elasticity_of,
    helix_angle_factor,
    inner_point_rolls,
    nominal_contact_stress,
    profile_factor,
    zone_factor,
)
from gearcad.rating.editions import Edition, both
from gearcad.rating.factors import mesh_radius
from gearcad.rating.load_factor_formulas import circumferential_speed
from gearcad.rating.root_section import VirtualGear, hob_section, load_point
from gearcad.rating.root_stress import RootMesh, RootRating, virtual_contact_ratio
from gearcad.rating.strength.duty import Resistance
from gearcad.rating.strength.permissible import (
    FLANK_ROUGHNESS,
    ROOT_ROUGHNESS,
    Conditions,
    flank_resistance,
    notch_strength,
    root_resistance,
    viscosity_of,
    work_hardening,
)
from gearcad.rating.tooth_stiffness import MeshStiffness, basic_rack_factor, stiffness_of, tooth_flexibility
from gearcad.sizing.geometry import ManyPairs
from gearcad.sizing.task import SizeTask


@dataclass(frozen=True)
class NominalStresses:
    """sigma_H0, sigma_F0 and mesh stiffness of pairs with face widths `width` (mm), under the torque on the pinion (N·m).

    `outer_factor` K_A K_gamma raises the load that the stiffness is known for, not the stresses.
    """

    pairs: ManyPairs
    width: Floats
    torque: float
    outer_factor: float
    materials: PerGear[Material]
    edition: Edition
    accuracy_grade: int

    @cached_property
    def tangential_force(self) -> Floats:
        """Tangential force F_t (N)."""
        return 2000 * abs(self.torque) / self.pairs.diameters.pinion

    @cached_property
    def specific_load(self) -> Floats:
        """F_t K_A K_gamma/b (N/mm)."""
        return self.tangential_force * self.outer_factor / self.width

    @cached_property
    def overlap_ratio(self) -> Floats:
        """Overlap ratio eps_beta."""
        return np.asarray(overlap_ratio_of(self.width, self.pairs.helix_angle, self.pairs.normal_module))

    @cached_property
    def stiffness(self) -> MeshStiffness[Numbers]:
        """Mesh stiffness under the specific load; gear 1 has fewer teeth, or with equal teeth the larger shift."""
        pairs = self.pairs
        (z_1, z_2), (x_1, x_2) = pairs.teeth, pairs.shifts
        v_1, v_2 = pairs.gears.map(lambda gear: gear.virtual_teeth)
        swapped = (z_1 > z_2) | ((z_1 == z_2) & (x_1 < x_2))
        teeth = chosen(swapped, v_2, v_1), chosen(swapped, v_1, v_2)
        return stiffness_of(
            self.materials,
            self.specific_load,
            flexibility=tooth_flexibility(teeth, (chosen(swapped, x_2, x_1), chosen(swapped, x_1, x_2))),
            blank_factor=1.0,
            rack_factor=basic_rack_factor(pairs.rack.dedendum, pairs.rack.pressure_angle),
            helix_angle=pairs.helix_angle,
            transverse_contact_ratio=pairs.contact_ratio,
        )

    # ------------------------------------------------------------------ flanks

    @cached_property
    def contact_ratio_factor(self) -> Numbers:
        """Contact ratio factor Z_eps."""
        return contact_ratio_factor(self.pairs.contact_ratio, self.overlap_ratio)

    @cached_property
    def nominal_contact_stress(self) -> Numbers:
        """sigma_H0 at the pitch point."""
        pairs, pinion = self.pairs, self.pairs.gears.pinion
        zone = zone_factor(pinion.base_helix_angle, pinion.transverse_pressure_angle, pairs.working_transverse_pressure_angle)
        factors = zone * elasticity_of(self.materials) * helix_angle_factor(pairs.helix_angle, self.edition)
        return nominal_contact_stress(
            factors * self.contact_ratio_factor, self.tangential_force, pairs.diameters.pinion, self.width, pairs.gear_ratio
        )

    @cached_property
    def contact_factors(self) -> PerGear[Numbers]:
        """Single pair contact factors Z_B and Z_D of profiles that are not modified.

        nan where single contact would begin below a base circle, unless eps_beta is at least 1.
        """
        raised = profile_factor(self.edition, self.pairs.helix_angle, modified=False)

        def factor(own: Role) -> Numbers:
            inner, outer = inner_point_rolls(self.pairs.gears, self.pairs.contact_ratio, own)
            below = np.sqrt(np.where((inner > 0) & (outer > 0), inner * outer, np.nan))
            curvature = np.tan(np.radians(self.pairs.working_transverse_pressure_angle)) / below
            return raised * chosen(self.overlap_ratio >= 1, 1.0, contact_factor(curvature, self.overlap_ratio))

        return PerGear.each(factor)

    # ------------------------------------------------------------------ roots

    @cached_property
    def roots(self) -> PerGear[RootRating[Numbers]]:
        """Root stresses of both gears, which carry over their whole width; nan where no section is found."""
        pairs = self.pairs
        mesh: RootMesh[Numbers] = RootMesh(
            tangential_force=self.tangential_force,
            virtual_contact_ratio=virtual_contact_ratio(pairs.contact_ratio, pairs.gears.pinion.base_helix_angle),
            overlap_ratio=self.overlap_ratio,
            helix_angle=pairs.helix_angle,
            edition=self.edition,
            accuracy_grade=self.accuracy_grade,
        )

        def rated(role: Role) -> RootRating[Numbers]:
            gear = pairs.gears.pick(role)
            virtual: VirtualGear[Numbers] = VirtualGear.of(gear)
            load = load_point(virtual, mesh.virtual_contact_ratio)
            section = hob_section(gear, virtual, load)
            return mesh.rating(section, load, virtual, width=self.width, rim_thickness_factor=1.0)

        return PerGear.each(rated)


def load_cycles(task: SizeTask, ratio: Numbers) -> PerGear[Numbers] | None:
    """Load cycles of a tooth of each gear over the life, of wheels with so many times the teeth; None where none is given."""
    options = task.rating
    if options.load_cycles is not None:
        return PerGear(*(np.full_like(ratio, number) for number in both(options.load_cycles)))
    if options.life is None:
        return None
    turns, contacts = 60 * abs(task.load.speed) * options.life, both(options.contacts_per_turn)
    return PerGear(np.full_like(ratio, turns * contacts.pinion), turns / ratio * contacts.wheel)


@dataclass(frozen=True)
class Strengths:
    """sigma_HG and sigma_FG of pairs with these root ratings, after their life."""

    task: SizeTask
    pairs: ManyPairs
    root_ratings: PerGear[RootRating[Numbers]]

    @cached_property
    def _conditions(self) -> Conditions[Numbers]:
        """Conditions with the roughness that is assumed of all gears."""
        pairs, options = self.pairs, self.task.rating
        return Conditions(
            viscosity_40=viscosity_of(options),
            speed=circumferential_speed(pairs.diameters.pinion, self.task.load.speed),
            reduced_radius=mesh_radius(*pairs.base_diameters, np.tan(np.radians(pairs.working_transverse_pressure_angle))),
            flank_roughness=PerGear(FLANK_ROUGHNESS, FLANK_ROUGHNESS),
            root_roughness=PerGear(ROOT_ROUGHNESS, ROOT_ROUGHNESS),
            normal_module=pairs.normal_module,
            gear_ratio=pairs.gear_ratio,
        )

    @cached_property
    def flanks(self) -> PerGear[Numbers]:
        """Pitting stress limit sigma_HG of the flanks (MPa)."""
        limits = self.task.limits.map(lambda each: each.contact or 0.0)
        hardening = work_hardening(self.task.materials, self._conditions)

        def strength(role: Role) -> Numbers:
            group = _group(self.task.materials.pick(role))
            return self._after_life(role, flank_resistance(role, limits, group, hardening, self._conditions, self.task.rating))

        return PerGear.each(strength)

    @cached_property
    def roots(self) -> PerGear[Numbers]:
        """Root stress limit sigma_FG (MPa)."""

        def strength(role: Role) -> Numbers:
            material, root = self.task.materials.pick(role), self.root_ratings.pick(role)
            group, limit = _group(material), self.task.limits.pick(role).root or 0.0
            notch = notch_strength(material, group, root.section.notch_parameter).value
            return self._after_life(role, root_resistance(role, limit, group, notch, root, self._conditions, self.task.rating))

        return PerGear.each(strength)

    def _after_life(self, role: Role, resistance: Resistance[Numbers]) -> Numbers:
        cycles = load_cycles(self.task, self.pairs.gear_ratio)
        return resistance.stress(None if cycles is None else cycles.pick(role))


def _group(material: Material) -> MaterialGroup:
    """Return the group of a material, which the task has checked."""
    assert material.group is not None
    return material.group
