"""Forces of tip edges beyond the ends of the path of contact: levers and directions by drawn involutes, and by energy."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from gearcad import Body, Gear, GearPair
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import plane_pair
from gearcad.contact.shared.line_of_action import LineOfAction, line_of_action
from gearcad.contact.shared.tip_edge import tip_edges
from gearcad.core.records import PerGear, Role
from gearcad.geometry import FlankModification
from gearcad.material import Material

BODIES = {"body": Body(bore=30)}
EXTERNAL = GearPair(
    pinion=Gear(teeth=16, normal_module=4.5, face_width=14, profile_shift=0.1817, **BODIES),  # type: ignore[arg-type]
    wheel=Gear(teeth=24, normal_module=4.5, face_width=14, profile_shift=0.1715, **BODIES),  # type: ignore[arg-type]
)
RING = GearPair(pinion=Gear(teeth=22, normal_module=3, face_width=20), wheel=Gear(teeth=-70, normal_module=3, face_width=20))

STEP = 1e-5
"""Rotation (rad) and roll length (mm) of differences."""

DRAWN = 1e-6
"""Error of levers (over the base radius) and angles (rad) by these differences."""

ENERGY = 0.04
"""Of what the ratio of torques has beyond 1: up to 3.6 % were measured, which flanks in the middle of the path have as well.

With levers of the unloaded flanks it is up to 10 %, with those of the turned ones without deflection 14 %.
"""

Curve = Callable[[float], np.ndarray]


def drawn(base: float, contact: float, sense: int, shift: float = 0.0) -> Curve:
    """Points of an involute in coordinates along the tangent and the line of action, its own touching point at the origin.

    The string of the length rho leaves the base circle at the angle -t, t = (rho - contact)/r_b; the mate's is seen from the
    other side (`sense` -1).
    """

    def point(length: float) -> np.ndarray:
        turn = (length - contact) / base
        along, up = np.array([math.cos(turn), -math.sin(turn)]), np.array([math.sin(turn), math.cos(turn)])
        return sense * (base * along + length * up - np.array([base, contact])) + np.array([0.0, shift])

    return point


def normal(curve: Curve, length: float) -> np.ndarray:
    """The unit normal of a curve that points up the line of action."""
    along = curve(length + STEP) - curve(length - STEP)
    square = np.array([along[1], -along[0]]) / math.hypot(*along)
    return square if square[1] > 0 else -square


def drawn_edge(line: LineOfAction, role: Role, contact: float, opposite: float) -> tuple[float, float]:
    """The arm over the base radius and the tilt (rad) of a tip that just touches its mate's involute."""
    own, mate = line.flanks.pick(role), line.flanks.pick(Role.WHEEL if role is Role.PINION else Role.PINION)
    flank = drawn(own.base_radius, contact, 1)
    corner, centre = flank(own.last), np.array([-own.base_radius, -contact])
    apart = drawn(mate.base_radius, opposite, -1)
    near, far = opposite, opposite + 12 * (contact - own.last)
    touched = brentq(lambda length: float(apart(length)[0] - corner[0]), near, far, xtol=1e-14)
    other = drawn(mate.base_radius, opposite, -1, float(corner[1] - apart(touched)[1]))
    up = normal(other, touched)

    def advanced(turn: float) -> float:
        """Distance (mm) of the corner beyond its mate's flank when its gear has turned."""
        cosine, sine = math.cos(turn), math.sin(turn)
        at = centre + np.array([[cosine, -sine], [sine, cosine]]) @ (corner - centre)
        foot = brentq(
            lambda length: float((at - other(length)) @ (other(length + STEP) - other(length - STEP))),
            touched - 0.05,
            touched + 0.05,
            xtol=1e-14,
        )
        return float((at - other(foot)) @ normal(other, foot))

    lever = (advanced(STEP) - advanced(-STEP)) / (2 * STEP)
    of_tip = normal(flank, own.last)
    return lever / own.base_radius, math.atan2(*up) - math.atan2(*of_tip)


@pytest.mark.parametrize("beyond", [0.2, 0.7])
@pytest.mark.parametrize(("pair", "role"), [(EXTERNAL, Role.PINION), (EXTERNAL, Role.WHEEL), (RING, Role.PINION)])
def test_levers_and_tilts_are_those_of_drawn_involutes(pair: GearPair, role: Role, beyond: float) -> None:
    line = line_of_action(pair)
    contact = line.flanks.pick(role).last + beyond
    opposite = line.whole - contact
    at = PerGear(contact, opposite) if role is Role.PINION else PerGear(opposite, contact)
    found = tip_edges(line, at.map(lambda length: np.array([length])))
    arm, tilt = drawn_edge(line, role, contact, opposite)
    assert abs(arm - 1) > 0.002
    assert float(found.arms.pick(role)[0]) == pytest.approx(arm, abs=DRAWN)
    assert float(found.tilts.pick(role)[0]) == pytest.approx(tilt, abs=DRAWN)
    other = Role.WHEEL if role is Role.PINION else Role.PINION
    assert (float(found.arms.pick(other)[0]), float(found.tilts.pick(other)[0])) == (1.0, 0.0)


def test_forces_between_the_ends_of_the_path_are_normal() -> None:
    """Also where a tip has just come to the line of action; from there on levers change steadily."""
    line = line_of_action(EXTERNAL)
    path = EXTERNAL.path_of_contact
    lengths = np.r_[np.linspace(path.A + 1e-9, path.E - 1e-9, 9), path.E + 1e-4]
    found = tip_edges(line, PerGear(lengths, line.whole - lengths))
    assert (found.arms.pinion[:-1] == 1).all()
    assert (found.arms.wheel == 1).all()
    assert 0 < 1 - found.arms.pinion[-1] < 1e-4
    assert 0 < found.tilts.pinion[-1] < 1e-4


def test_a_root_relief_turns_the_force_of_its_mates_tip() -> None:
    """The slope of a linear relief adds to the tilt: per mm of roll, times the roll of a mm along the tangent."""
    pinion, wheel = EXTERNAL.gears
    relief = FlankModification(root_relief=30.0, root_relief_length=7.0)
    wheels = (wheel, replace(wheel, modification=relief))
    lines = [line_of_action(GearPair(pinion=pinion, wheel=of)) for of in wheels]
    length = np.array([lines[0].flanks.pinion.last + 0.5])
    plain, relieved = (float(tip_edges(line, PerGear(length, line.whole - length)).tilts.pinion[0]) for line in lines)
    rolls = lines[0].flanks.wheel.facing(lines[0].whole - length, -lines[0].flanks.pinion.along_tangent(length, length - 0.5))[
        0
    ]
    slope = -0.030 / 7.0 * wheel.base_diameter / 2 / float(rolls[0])
    assert relieved - plain == pytest.approx(slope, rel=0.02)


@pytest.mark.parametrize("angle", [-5.7, -5.3, 5.3, 5.7], ids=["pinion", "pinion, late", "wheel, early", "wheel"])
def test_work_of_both_torques_is_the_elastic_energy(angle: float) -> None:
    """Over the path ds of the mesh the pinion does the work F (ds + d delta), the wheel takes F kappa ds, the rest is stored.

    So the ratio kappa of the torques follows from the slopes of approach and energy, which know no levers.
    """
    cycle, step = PlaneCycle(plane_pair(EXTERNAL, Material()), 302.0), 0.02
    before, here, after = (cycle.solve(angle + way * step) for way in (-1, 0, 1))
    path = 2 * math.radians(step) * cycle.model.base_radius
    energy = (sum(after.approach_parts) - sum(before.approach_parts)) / 2 / path
    ratio = 1 + (after.approach - before.approach) / path - energy
    found = here.torque_ratios.wheel
    assert abs(found - 1) > 0.005
    assert found - 1 == pytest.approx(ratio - 1, rel=ENERGY)
    hub = here.torques.wheel / (302.0 * 24 / 16)
    assert hub == pytest.approx(found, abs=0.002)
