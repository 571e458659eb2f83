"""Rated: variants with what they bear and how they run."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.per_gear import PerGear
from gearcad.sizing.columns import Columns
from gearcad.sizing.geometry import ManyPairs
from gearcad.sizing.task import SizeTask

__all__ = ["REQUIRED", "Rated", "disc_mass", "line_ripple"]

FLANK, ROOT, SCUFFING, MASS = REQUIRED = ("flank safety", "root safety", "scuffing safety", "mass")
"""What is required of variants that have a rating, in words."""


@dataclass(frozen=True, kw_only=True)
class Rated(Columns):
    """Pairs with a face width `width` (mm), arrays (n,). `order` is the place of each in the whole search.

    `flank_safeties` S_H, `root_safeties` S_F; `margin` is the least of S_H/S_Hmin and S_F/S_Fmin, `mass` (kg) that of both
    gears, `temperature` (°C) the integral temperature, nan without a speed, `load_factors` K_A K_gamma K_v K_Hbeta K_Halpha.
    """

    order: Wholes
    pairs: ManyPairs
    width: Floats
    mass: Floats
    overlap_ratio: Floats
    flank_safeties: PerGear[Floats]
    root_safeties: PerGear[Floats]
    margin: Floats
    temperature: Floats
    load_factors: Floats

    @property
    def total_contact_ratio(self) -> Floats:
        """eps_gamma."""
        return self.pairs.contact_ratio + self.overlap_ratio

    @property
    def sliding(self) -> Floats:
        """Greatest specific sliding of both gears, a magnitude."""
        result: Floats = np.max(np.abs(self.pairs.sliding), axis=0)
        return result

    @property
    def ripple(self) -> Floats:
        """How much the length of the lines of contact changes over the mesh, over its mean."""
        return line_ripple(self.pairs.contact_ratio, self.overlap_ratio)

    def meets(self, condition: str, task: SizeTask) -> Bools:
        """Where one of the REQUIRED is as it must be."""
        if condition == MASS:
            return np.ones(len(self.order), bool) if task.max_mass is None else self.mass <= task.max_mass
        if condition == SCUFFING:
            most = task.most_temperature
            return np.ones(len(self.order), bool) if most is None else self.temperature <= most
        flank = condition == FLANK
        least = task.rating.required_safety_flank if flank else task.rating.required_safety_root
        result: Bools = np.minimum(*(self.flank_safeties if flank else self.root_safeties)) >= least
        return result

    def safe(self, task: SizeTask) -> Bools:
        """Where all are."""
        result: Bools = np.logical_and.reduce([self.meets(each, task) for each in REQUIRED])
        return result


def line_ripple(contact_ratio: Floats, overlap_ratio: Floats) -> Floats:
    """(l_max - l_min)/l_mean of all lines of contact: what noise goes by before the transmission error is known.

    Lines are b/cos beta_b long at eps_beta >= 1 only in part, but what is beyond whole numbers p, q of both ratios is all that
    changes: min(p, q) - max(0, p + q - 1), over eps_alpha eps_beta. Of a spur pair the limit, 1/eps_alpha.
    """
    p, q = np.mod(contact_ratio, 1.0), np.mod(overlap_ratio, 1.0)
    changing = np.minimum(p, q) - np.maximum(p + q - 1, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        helical = changing / (contact_ratio * overlap_ratio)
    return np.where(overlap_ratio > 0, helical, np.where(p > 0, 1 / contact_ratio, 0.0))


def disc_mass(pairs: ManyPairs, width: Floats, densities: PerGear[float]) -> Floats:
    """Mass of both gears (kg), each a disc whose section is midway between those of its tip and its root circle.

    That is within 1 % of the mass of the exact solids.
    """
    parts = zip(pairs.tip_diameters, pairs.root_diameters, densities, strict=True)
    sections = sum(math.pi / 8 * (tip**2 + root**2) * density for tip, root, density in parts)
    return np.asarray(sections * 1e-9) * width
