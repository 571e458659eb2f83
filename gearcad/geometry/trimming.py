"""Does a shaper cutter trim the tips of its ring, as it rolls or on its way in? It can foul them as any pinion."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.internal_interference import InternalTips, ToothTips
from gearcad.geometry.profile import ToothProfile
from gearcad.geometry.shaper import ShaperTip
from gearcad.geometry.shaping import cutter_fits
from gearcad.geometry.tooling import corner_radius, shaper_tip
from gearcad.notice import Notice

__all__ = ["trimming_notices"]

_CORNER_POINTS = 9
"""Points of the cutter's corner that are looked at."""

_ROUNDING = 1e-6
"""Trimming, in normal modules, that counts as none."""


@dataclass(frozen=True)
class _CutterTips(ToothTips):
    """The rounded tips of a cutter: points of the corner from the end of its involute on."""

    @classmethod
    def rounded(cls, tip: ShaperTip, teeth: int) -> _CutterTips:
        """Those of a cutter's corner."""
        along, across = tip.outline(np.linspace(tip.last_angle, 0.0, _CORNER_POINTS if tip.radius else 1))
        edges = zip(np.hypot(along, across).tolist(), np.arctan2(across, along).tolist(), strict=True)
        return cls(teeth, tip.base_radius, tip.base_half_angle, tuple(edges))

    @cached_property
    def corner(self) -> tuple[Floats, Floats]:
        """Radius (mm) and half tooth angle (rad) of its points."""
        radius, angle = np.array(self.edges).T
        return radius, angle


def trimming_notices(gear: GearData, profile: ToothProfile) -> Iterator[Notice]:
    """What a ring's cutter takes from its tips; nothing without a cutter."""
    teeth = gear.cutter.teeth
    if not gear.internal or teeth is None:
        return
    tips, least = _tips(gear, profile, teeth), -_ROUNDING * gear.normal_module
    rolling, way_in = tips.trochoid_margin, tips.radial_margin
    if rolling < least:
        hint = _fewer(gear, profile, lambda each: each.trochoid_margin)
        yield Notice("cutter-trims-tips", f"cutter: as it rolls it trims the tips of the ring by {-rolling:.3g} mm{hint}")
    elif way_in < least:
        hint = _fewer(gear, profile, lambda each: each.radial_margin)
        text = f"cutter: fed in radially it trims the tips of the ring by {-way_in:.3g} mm{hint}"
        yield Notice("cutter-trims-on-infeed", text)


def _tips(gear: GearData, profile: ToothProfile, teeth: int) -> InternalTips:
    """Those of the cutter inside its ring."""
    tip = shaper_tip(gear, corner_radius(gear))
    return InternalTips(_CutterTips.rounded(tip, teeth), ToothTips.of(profile), tip.centre_distance)


def _fewer(gear: GearData, profile: ToothProfile, margin: Callable[[InternalTips], float]) -> str:
    """The largest number of teeth of a cutter that would do, in words."""
    plain = GearData(**{each.name: getattr(gear, each.name) for each in fields(GearData)})
    for teeth in range((gear.cutter.teeth or 0) - 1, 2, -1):
        other = replace(plain, cutter=replace(gear.cutter, teeth=teeth))
        if not cutter_fits(other):
            return ""
        if margin(_tips(other, profile, teeth)) >= 0:
            return f"; one of {teeth} teeth does not"
    return ""
