"""Pairs as coarse solid bodies, made once for all tests: enough to compare methods with each other, not with nature."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from threadpoolctl import threadpool_limits

from gearcad import Body, Gear, GearPair, Material, ShaperCutter
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.solid.pair import SolidPair, SolidSizes, solid_pair
from gearcad.designs import read_spec

TEMPLATES = Path(__file__).parents[2] / "templates"

PAIRS = ("FZG C", "helical")

TORQUES = {"FZG C": 302.0, "helical": 60.0, "Alm": 12.7, "ring": 60.0}
"""N·m on the pinion."""


def coarse_pair(name: str) -> GearPair:
    """FZG C, Alm 18/161, or one of module 2 with 20 and 30 teeth at 20 degrees, or inside a ring of 54."""
    specs = {"FZG C": "fzg-c.toml", "Alm": "alm-18-161.toml"}
    if name in specs:
        pair = read_spec(TEMPLATES / specs[name]).pair
        assert pair is not None
        return pair
    pinion = Gear(teeth=20, normal_module=2, face_width=10, helix_angle=20, tooth_thinning=0.05, body=Body(bore=28))
    if name == "ring":
        cutter = ShaperCutter(teeth=18, tip_radius=0.15)
        ring = Gear(teeth=-54, normal_module=2, face_width=10, helix_angle=20, cutter=cutter)
        return GearPair(pinion=pinion, wheel=ring)
    wheel = Gear(teeth=30, normal_module=2, face_width=10, helix_angle=-20, tooth_thinning=0.05, body=Body(bore=48))
    return GearPair(pinion=pinion, wheel=wheel)


@cache
def coarse_model(name: str) -> SolidPair:
    """Three teeth of each gear, with half as many elements in their sections as usual."""
    with threadpool_limits(1):
        body, sizes = BodyModel(teeth=3), SolidSizes().refined(0.7)
        return solid_pair(coarse_pair(name), Material(), body=body, sizes=sizes)
