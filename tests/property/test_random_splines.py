"""Random spline joints, held against their own outlines: no overlap, and the play by which they turn until they touch."""

import math
import random

import numpy as np
import pytest

from gearcad.geometry.gear import Gear
from gearcad.geometry.spline import SplineJoint
from gearcad.geometry.spline_inputs import HubInputs, ShaftInputs

PLACES = np.linspace(0.0, 1.0, 60)


def random_joint(draw: random.Random) -> SplineJoint:
    standard = draw.choice(["DIN 5480", "ISO 4156"])
    module, teeth = draw.choice([0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0]), draw.randint(10, 80)
    if standard == "DIN 5480":
        diameter = round(module * (teeth + 1.1 + 2 * draw.uniform(0.15, 0.45)), 3)
        fits = {"fit": f"{draw.randint(5, 12)}{draw.choice('hgfed')}"}, {"fit": f"{draw.randint(5, 12)}{draw.choice('HGF')}"}
        own = {"tolerance_actual": draw.uniform(5, 80), "tolerance_effective": draw.uniform(5, 50)}
        size = {"nominal_diameter": diameter}
    else:
        grade = draw.randint(4, 7)
        fits, own = ({"fit": f"{grade}{draw.choice('hfed')}"}, {"fit": f"{grade}H"}), {}
        size = {"pressure_angle": draw.choice([30.0, 37.5, 45.0])}
    shaft, hub = ShaftInputs(**fits[0], **own), HubInputs(**fits[1], **own)
    return SplineJoint(standard=standard, module=module, teeth=teeth, **size, shaft=shaft, hub=hub)


def half_angles(gear: Gear, radii: np.ndarray) -> np.ndarray:
    """Half angle of the tooth (rad) at radii, by the pieces of the outline: the greatest of those that reach a radius."""
    found = np.full(len(radii), np.nan)
    for curve in gear.profile.curves:
        radius, angle = curve.polar(np.linspace(0.0, 1.0, 4001))
        order = np.argsort(radius)
        inside = (radii >= radius.min()) & (radii <= radius.max())
        if radius.max() - radius.min() > 1e-6:
            found[inside] = np.interp(radii[inside], radius[order], angle[order])
    return found


def least_gap(shaft: Gear, hub: Gear) -> float:
    """Least angle (rad) between the flanks of a shaft's tooth and of the hub's space around it, over the radii of both."""
    low = max(abs(hub.tip_diameter), shaft.root_diameter) / 2
    high = min(abs(hub.root_diameter), shaft.tip_diameter) / 2
    radii = low + (high - low) * PLACES[1:-1]
    space = math.pi / shaft.teeth - half_angles(hub, radii)
    return float(np.nanmin(space - half_angles(shaft, radii)))


@pytest.mark.parametrize("joints", [50, pytest.param(500, marks=pytest.mark.long)])
def test_joints_turn_by_the_play_that_is_told(joints: int) -> None:
    """Both flanks are one involute, moved: the gap is the same everywhere, and half the play on either side."""
    draw, worst, judged = random.Random(5480), 0.0, 0
    for _ in range(joints):
        joint = random_joint(draw)
        shaft, hub = joint.parts["shaft"], joint.parts["hub"]
        sizes = {
            "effective": (shaft.effective_limit, hub.effective_limit, joint.effective_play_min),
            "actual": (shaft.actual_other, hub.actual_other, joint.actual_play_max),
        }
        interferes = any(each.code == "spline-interference" for each in joint.notices)
        for thickness, space, play in sizes.values():
            assert thickness is not None and space is not None and play is not None
            gap = least_gap(shaft.gear_of(thickness), hub.gear_of(space)) * joint.reference_diameter / 2
            told = play / 2
            if not interferes:
                worst = max(worst, abs(gap - told))
                judged += 1
                assert gap > -1e-6
        if not interferes and joint.backlash_angle is not None:
            turn = 2 * math.degrees(least_gap(shaft.gear, hub.gear))
            apart = abs(turn - joint.backlash_angle) * math.radians(joint.reference_diameter / 2)
            worst = max(worst, apart)
    assert worst < 1e-6
    assert judged > joints
