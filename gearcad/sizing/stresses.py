"""Nominal and permissible stresses of many pairs at once: ISO 6336-1, -2 and -3, Method B, as arrays.

Solid discs of equal width, cut by a hob, without thinning. Lengths in mm, stresses in MPa, angles in radians; what does not
depend on the face width has the shape of the pairs, all else that of pairs and widths together.

Stresses in MPa, lengths in mm. Nothing here depends on the face width.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.core.records import Floats, PerGear, Role
from gearcad.core.values import interpolated_in_logs
from gearcad.material import Material, MaterialGroup
from gearcad.rating.editions import Edition, both, load_distribution_factor, modification_factor
from gearcad.rating.factors import (
    Points,
    endurance_cycles,
    equivalent_roughness,
    flank_points,
    flank_roughness_factor,
    flank_size_factor,
    lubricant_factor,
    mesh_radius,
    notch_sensitivity_factor,
    root_points,
    root_size_factor,
    root_surface_factor,
    speed_factor,
    static_notch_sensitivity_factor,
    static_work_hardening_factor,
    strength_range,
    through_hardened_factor,
    transition,
    work_hardening_factor,
)
from gearcad.rating.material_limits import Family
from gearcad.rating.strength.permissible import FLANK_ROUGHNESS, HARD, ROOT_ROUGHNESS, VISCOSITY, Y_ST, brinell, is_soft
from gearcad.rating.tooth_stiffness import CORRECTION_FACTOR, LOW_LOAD, basic_rack_factor, tooth_flexibility
from gearcad.sizing.geometry import ManyPairs, Numbers
from gearcad.sizing.task import SizeTask

_NEWTON_STEPS = 6
_SETTLED = 1e-12
"""Change of theta (rad) of the last step, beyond which there is no tangent."""


@dataclass(frozen=True)
class ManyRoots:
    """Root sections of one gear of many pairs at the 30-degree tangents (ISO 6336-3:2006, clause 6); nan without one."""

    pairs: ManyPairs
    role: Role

    @cached_property
    def _virtual(self) -> tuple[Floats, Floats]:
        """r_an and r_bn in normal modules."""
        m, z_n = self.pairs.normal_module, self.pairs.virtual_teeth.pick(self.role)
        rise = (self.pairs.tip_diameters.pick(self.role) - self.pairs.diameters.pick(self.role)) / m
        return (z_n + rise) / 2, z_n / 2 * math.cos(self.pairs.normal_angle)

    @cached_property
    def _load_point(self) -> tuple[Floats, Floats]:
        """(cos gamma_e - sin gamma_e tan alpha_Fen) d_en/m_n, by (28) to (31), and alpha_Fen."""
        pairs, alpha_n = self.pairs, self.pairs.normal_angle
        r_an, r_bn = self._virtual
        virtual_ratio = pairs.contact_ratio / np.cos(pairs.base_helix) ** 2
        along = np.sqrt((r_an - r_bn) * (r_an + r_bn)) - math.pi * math.cos(alpha_n) * (virtual_ratio - 1)
        alpha_en = np.arctan2(along, r_bn)
        at = np.maximum(alpha_en, 0.0)  # inside the base circle the half angle is that of the base circle
        thickness = math.pi / 2 + 2 * pairs.shifts.pick(self.role) * math.tan(alpha_n)
        half = thickness / pairs.virtual_teeth.pick(self.role) + math.tan(alpha_n) - alpha_n
        gamma_e = half - (np.tan(at) - at)
        alpha_fen = alpha_en - gamma_e
        lever = (np.cos(gamma_e) - np.sin(gamma_e) * np.tan(alpha_fen)) * 2 * np.hypot(along, r_bn)
        return lever, alpha_fen

    @cached_property
    def _section(self) -> tuple[Floats, Floats, Floats]:
        """s_Fn, rho_F and h_Fe in normal modules, by (12) to (18)."""
        pairs, rho, z_n = self.pairs, self.pairs.root_radius, self.pairs.virtual_teeth.pick(self.role)
        alpha_n, dedendum = pairs.normal_angle, pairs.rack.dedendum
        half_width = math.pi / 4 - dedendum * math.tan(alpha_n) - (1 - math.sin(alpha_n)) * rho / math.cos(alpha_n)
        g = rho - dedendum + pairs.shifts.pick(self.role)
        theta = _tangent(2 * g / z_n, 2 / z_n * (math.pi / 2 - half_width) - math.pi / 3)
        cosine = np.cos(theta)
        centre = g / cosine - rho
        chord = z_n * np.sin(math.pi / 3 - theta) + math.sqrt(3) * centre
        radius = rho + 2 * g**2 / (cosine * (z_n * cosine**2 - 2 * g))
        lever, _ = self._load_point
        return chord, radius, (lever - z_n * np.cos(math.pi / 3 - theta) - centre) / 2

    @cached_property
    def form_factor(self) -> Floats:
        """Form factor Y_F (equation 9)."""
        chord, _, arm = self._section
        _, alpha_fen = self._load_point
        result: Floats = 6 * arm * np.cos(alpha_fen) / (chord**2 * math.cos(self.pairs.normal_angle))
        return result

    @cached_property
    def stress_correction_factor(self) -> Floats:
        """Stress correction factor Y_S (equation 36)."""
        chord, _, arm = self._section
        slimness = chord / arm
        result: Floats = (1.2 + 0.13 * slimness) * np.power(self.notch_parameter, 1 / (1.21 + 2.3 / slimness))
        return result

    @cached_property
    def notch_parameter(self) -> Floats:
        """Notch parameter q_s (equation 38)."""
        chord, radius, _ = self._section
        return chord / (2 * radius)


def _tangent(slope: Floats, h: Floats) -> Floats:
    """theta (rad) of theta = slope tan theta - h, by six steps of Newton's from pi/6; nan where they do not settle."""
    theta = np.full_like(h, math.pi / 6)
    step = theta
    for _ in range(_NEWTON_STEPS):
        tangent = np.tan(theta)
        step = (theta - slope * tangent + h) / (1 - slope * (1 + tangent**2))
        theta = theta - step
    return np.where((np.abs(step) < _SETTLED) & (theta > 0) & (theta < math.pi / 2), theta, np.nan)


@dataclass(frozen=True)
class NominalStresses:
    """sigma_H0, sigma_F0 and mesh stiffness of pairs with face widths `width` (mm), under the torque on the pinion (N·m).

    `outer_factor` K_A K_gamma raises the load that the stiffness is known for, not the stresses.
    """

    pairs: ManyPairs
    width: Floats
    torque: float
    outer_factor: float
    elasticity_factor: float
    material_factor: float
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
        return self.width * np.sin(np.radians(np.abs(self.pairs.helix_angle))) / (math.pi * self.pairs.normal_module)

    # ------------------------------------------------------------------ stiffness

    @cached_property
    def high_load_single(self) -> Floats:
        """c' from 100 N/mm on (80): gear 1 has fewer teeth, or with equal teeth the larger shift."""
        pairs = self.pairs
        (z_1, z_2), (x_1, x_2), (v_1, v_2) = pairs.teeth, pairs.shifts, pairs.virtual_teeth
        swapped = (z_1 > z_2) | ((z_1 == z_2) & (x_1 < x_2))
        teeth = np.where(swapped, v_2, v_1), np.where(swapped, v_1, v_2)
        flexibility = tooth_flexibility(teeth, (np.where(swapped, x_2, x_1), np.where(swapped, x_1, x_2)))
        rack = basic_rack_factor(pairs.rack.dedendum, pairs.rack.pressure_angle)
        return CORRECTION_FACTOR * rack * pairs.cosine * self.material_factor / flexibility

    @cached_property
    def single(self) -> Floats:
        """c' of the load (90)."""
        return self.high_load_single * np.sqrt(np.sqrt(np.minimum(self.specific_load / LOW_LOAD, 1.0)))

    @cached_property
    def mesh_alpha(self) -> Floats:
        """c_gamma_alpha (91)."""
        return self.single * (0.75 * self.pairs.contact_ratio + 0.25)

    # ------------------------------------------------------------------ flanks

    @cached_property
    def zone_factor(self) -> Floats:
        """Zone factor Z_H."""
        a_t, a_wt, beta_b = self.pairs.transverse_angle, self.pairs.working_angle, self.pairs.base_helix
        result: Floats = np.sqrt(2 * np.cos(beta_b) / (np.cos(a_t) ** 2 * np.tan(a_wt)))
        return result

    @cached_property
    def contact_ratio_factor(self) -> Floats:
        """Contact ratio factor Z_eps."""
        ratio, overlap = self.pairs.contact_ratio, np.minimum(self.overlap_ratio, 1.0)
        result: Floats = np.sqrt((4 - ratio) / 3 * (1 - overlap) + overlap / ratio)
        return result

    @property
    def helix_angle_factor(self) -> Floats:
        """Helix angle factor Z_beta."""
        root = np.sqrt(self.pairs.cosine)
        return root if self.edition is Edition.DIN_1987 else 1 / root

    @cached_property
    def nominal_contact_stress(self) -> Floats:
        """sigma_H0 at the pitch point."""
        u = self.pairs.ratio
        factors = self.zone_factor * self.elasticity_factor * self.helix_angle_factor * self.contact_ratio_factor
        result: Floats = factors * np.sqrt(self.tangential_force / self.pairs.diameters.pinion * (u + 1) / u / self.width)
        return result

    @property
    def curvatures(self) -> PerGear[Floats]:
        """M_1 and M_2; nan where single contact would begin below a base circle."""
        return PerGear(*map(self._curvature, Role))

    def _curvature(self, own: Role) -> Floats:
        pairs = self.pairs
        rest = pairs.contact_ratio - 1
        reach = {role: 2 * pairs.tip_reach.pick(role) / pairs.base_diameters.pick(role) for role in Role}
        pitch = {role: 2 * math.pi / pairs.teeth.pick(role) for role in Role}
        inner, outer = reach[own] - pitch[own], reach[own.mate] - rest * pitch[own.mate]
        possible = (inner > 0) & (outer > 0)
        result: Floats = np.tan(pairs.working_angle) / np.sqrt(np.where(possible, inner * outer, np.nan))
        return result

    @cached_property
    def contact_factors(self) -> PerGear[Floats]:
        """Single pair contact factors Z_B and Z_D."""
        overlap, raised = np.minimum(self.overlap_ratio, 1.0), self._profile_factor
        return PerGear(*(raised * np.where(overlap >= 1, 1.0, np.maximum(m - overlap * (m - 1), 1.0)) for m in self.curvatures))

    @property
    def _profile_factor(self) -> Floats | float:
        """f_ZCa of 2019, of profiles that are not modified."""
        if self.edition is not Edition.ISO_2019:
            return 1.0
        spur, helical = (modification_factor(helix, modified=False) for helix in (0.0, 1.0))
        return np.where(self.pairs.helix_angle == 0, spur, helical)

    # ------------------------------------------------------------------ roots

    @cached_property
    def roots(self) -> PerGear[ManyRoots]:
        """The sections of both."""
        return PerGear(*(ManyRoots(self.pairs, role) for role in Role))

    @cached_property
    def root_helix_factor(self) -> Floats:
        """Helix angle factor Y_beta of the root."""
        helix = np.minimum(np.abs(self.pairs.helix_angle), 30.0)
        plain = 1 - np.minimum(self.overlap_ratio, 1.0) * helix / 120
        return plain / np.cos(np.radians(helix)) ** 3 if self.edition is Edition.ISO_2019 else plain

    @cached_property
    def _virtual_contact_ratio(self) -> Floats:
        """Virtual contact ratio eps_alphan."""
        result: Floats = self.pairs.contact_ratio / np.cos(self.pairs.base_helix) ** 2
        return result

    @property
    def load_distribution(self) -> Floats | float:
        """f_eps, by which Y_F is multiplied in the edition of 2019."""
        if self.edition is not Edition.ISO_2019:
            return 1.0
        return load_distribution_factor(self._virtual_contact_ratio, self.overlap_ratio)

    @cached_property
    def deep_tooth_factor(self) -> Floats:
        """Deep tooth factor Y_DT."""
        ratio = self._virtual_contact_ratio
        if self.accuracy_grade > 4 or self.edition is not Edition.ISO_2006:
            return np.ones_like(ratio)
        return np.where(ratio > 2.5, 0.7, np.where(ratio > 2.05, 2.366 - 0.666 * ratio, 1.0))

    @cached_property
    def nominal_root_stresses(self) -> PerGear[Floats]:
        """sigma_F0 of both gears, which carry over their whole width; of solid discs (Y_B = 1)."""
        per_width = self.tangential_force / self.pairs.normal_module * self.deep_tooth_factor
        common = self.root_helix_factor * self.load_distribution / self.width
        return PerGear(*(per_width * root.form_factor * root.stress_correction_factor * common for root in self.roots))


_SLOWEST = 1e-6
"""Speed (m/s) that stands for rest."""


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
    """sigma_HG and sigma_FG of pairs with these root sections, after their life."""

    task: SizeTask
    pairs: ManyPairs
    sections: PerGear[ManyRoots]

    @cached_property
    def _limits(self) -> tuple[PerGear[float], PerGear[float]]:
        """sigma_Hlim and sigma_Flim of both, which the task has seen to."""
        found = self.task.limits
        return PerGear(*(each.contact or 0.0 for each in found)), PerGear(*(each.root or 0.0 for each in found))

    @cached_property
    def _cycles(self) -> PerGear[Numbers] | None:
        return load_cycles(self.task, self.pairs.ratio)

    @cached_property
    def speed(self) -> Numbers:
        """v (m/s) at the reference circle."""
        return math.pi * self.pairs.diameters.pinion * abs(self.task.load.speed) / 60_000

    @cached_property
    def _viscosity(self) -> float:
        given = self.task.rating.oil_viscosity_40
        return VISCOSITY if given is None else given

    @cached_property
    def reduced_radius(self) -> Numbers:
        """rho_red at the pitch point (mm)."""
        return mesh_radius(*self.pairs.base_diameters, np.tan(self.pairs.working_angle))

    # ------------------------------------------------------------------ flanks

    @cached_property
    def flanks(self) -> PerGear[Numbers]:
        """Pitting stress limit sigma_HG of the flanks (MPa)."""
        return PerGear(self._flank(Role.PINION), self._flank(Role.WHEEL))

    def _flank(self, role: Role) -> Numbers:
        group, options = _group(self.task.materials.pick(role)), self.task.rating
        points = flank_points(group, pitting=options.pitting_permitted, long_life=options.long_life_factor)
        size = flank_size_factor(self.pairs.normal_module, group, options.standard)
        hardening = self._work_hardening if role is Role.WHEEL else (1.0, 1.0)
        factors = [*((1.0, each) for each in self._film), hardening]
        return self._limits[0].pick(role) * size * self._after_life(role, points, factors)

    @cached_property
    def _film(self) -> tuple[Numbers, ...]:
        """Z_L, Z_v, Z_R, by the limit of the softer gear."""
        softer, speed = min(self._limits[0]), np.maximum(self.speed, _SLOWEST)
        rough = flank_roughness_factor(softer, FLANK_ROUGHNESS, self.reduced_radius)
        return lubricant_factor(softer, self._viscosity), speed_factor(softer, speed), rough

    @property
    def _work_hardening(self) -> tuple[Numbers, Numbers]:
        """Z_W of the wheel, static and of endurance, as `work_hardening` of one pair."""
        pinion, wheel = self.task.materials
        hard: Numbers | None = brinell(pinion)
        soft: Numbers | None = brinell(wheel)
        if soft is None or not is_soft(_group(wheel)):
            return 1.0, 1.0
        if Family.of(_group(pinion)) in HARD:
            speed = np.maximum(self.speed, _SLOWEST)
            rough = equivalent_roughness(FLANK_ROUGHNESS, FLANK_ROUGHNESS, self.reduced_radius, self._viscosity, speed)
            return static_work_hardening_factor(soft), work_hardening_factor(soft, rough)
        if hard is None or not is_soft(_group(pinion)):
            return 1.0, 1.0
        return 1.0, through_hardened_factor(hard, soft, self.pairs.ratio)

    # ------------------------------------------------------------------ roots

    @cached_property
    def roots(self) -> PerGear[Numbers]:
        """Root stress limit sigma_FG (MPa)."""
        return PerGear(self._root(Role.PINION), self._root(Role.WHEEL))

    def _root(self, role: Role) -> Numbers:
        material = self.task.materials.pick(role)
        group, section = _group(material), self.sections.pick(role)
        surface = root_surface_factor(ROOT_ROUGHNESS, group)
        factors = [_notch(material, group, section), (1.0, surface), (1.0, root_size_factor(self.pairs.normal_module, group))]
        points = root_points(group, long_life=self.task.rating.long_life_factor)
        reversed_load = both(self.task.rating.mean_stress_factor).pick(role)
        return self._limits[1].pick(role) * Y_ST * reversed_load * self._after_life(role, points, factors)

    def _after_life(self, role: Role, points: Points, factors: list[tuple[Numbers, Numbers]]) -> Numbers:
        """The life factor times factors (static, endurance) after the load cycles of a gear."""
        cycles: Numbers = (
            np.full_like(self.pairs.ratio, endurance_cycles(points)) if self._cycles is None else self._cycles.pick(role)
        )
        result: Numbers = interpolated_in_logs(cycles, points)
        for static, endurance in factors:
            result = result * transition(cycles, static, endurance, points)
        return result


def _notch(material: Material, group: MaterialGroup, section: ManyRoots) -> tuple[Numbers, Numbers]:
    """Y_delta_relT, static and of endurance, by the strength of the material, or that of its group for which it is least."""
    own = material.tensile_strength if Family.of(group) is Family.GREY_IRON else material.yield_strength
    ends = (own,) if own is not None else strength_range(group) or (None,)
    notch, stress = section.notch_parameter, section.stress_correction_factor
    found = [
        (static_notch_sensitivity_factor(stress, group, each), notch_sensitivity_factor(notch, group, each)) for each in ends
    ]
    (static, endurance), (other_static, other) = found[0], found[-1]
    return np.where(endurance <= other, static, other_static), np.minimum(endurance, other)


def _group(material: Material) -> MaterialGroup:
    """Return the group of a material; the task has checked that it has one."""
    assert material.group is not None
    return material.group
