"""What the flanks and roots of many pairs bear: sigma_HG and sigma_FG of ISO 6336-2 and -3, by the factors of `rating.factors`.

Stresses in MPa, lengths in mm. Nothing here depends on the face width.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.material import Material, MaterialGroup
from gearcad.per_gear import PerGear, Role
from gearcad.rating.both import both
from gearcad.rating.factors import (
    Points,
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
from gearcad.rating.factors.elementwise import interpolated_in_logs
from gearcad.rating.factors.families import Family
from gearcad.rating.factors.life import endurance_cycles
from gearcad.rating.strength.conditions import FLANK_ROUGHNESS, ROOT_ROUGHNESS, VISCOSITY
from gearcad.rating.strength.flank import HARD, brinell, is_soft
from gearcad.rating.strength.root import Y_ST
from gearcad.sizing.columns import Numbers
from gearcad.sizing.geometry import ManyPairs
from gearcad.sizing.stresses import ManyRoots
from gearcad.sizing.task import SizeTask

__all__ = ["Strengths", "load_cycles"]

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
        """sigma_HG."""
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
        """sigma_FG."""
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
    """That of a material which has one: the task has seen to it."""
    assert material.group is not None
    return material.group
