"""The transverse section that the page draws: outlines of the gears in mesh, their circles, and the path of contact."""

from __future__ import annotations

import math
from typing import Any

from gearcad.designs.design import Design
from gearcad.designs.kinds.pair import PairDesign
from gearcad.geometry import Gear
from gearcad.geometry.helix import twist
from gearcad.page.components.section import SectionView
from gearcad.page.panels import Panel

__all__ = ["SectionPanel", "section_of"]

_CHORD = 2e-3
"""Error of outlines, in normal modules: nobody sees it."""

_DIGITS = 4
"""Of a coordinate, in mm."""


class SectionPanel(Panel[dict[str, Any] | None]):
    """The mesh in its transverse section; that of a kept design as thin lines over it."""

    compares = True

    def __init__(self) -> None:
        self._view = SectionView("transverse section of the mesh")

    def find(self, design: Design) -> dict[str, Any] | None:
        return section_of(design)

    def show(self, found: dict[str, Any] | None) -> None:
        self._view.show(found)

    def keep(self, found: dict[str, Any] | None) -> None:
        self._view.keep(found)

    def pose(self, turn: float) -> None:
        """Turn the first gear by so many radians."""
        self._view.pose(turn)


def section_of(design: Design) -> dict[str, Any] | None:
    """Gears of a pair, or one gear, at the pinion's z = 0: a place, a turn (rad), an outline (mm) and circles each.

    `ratio` is how far each turns while the first turns once. None for kinds that the page draws otherwise.
    """
    if isinstance(design, PairDesign):
        return _of_pair(design)
    gear = design.gears.get("gear")
    return None if gear is None else {"gears": [_gear("gear", gear, 0.0, 0.0, 1.0)], "line": None}


def _of_pair(design: PairDesign) -> dict[str, Any]:
    pair = design.pair
    pose = pair.wheel_pose()
    turn = math.radians(pose.rotation) - twist(pair.wheel, pose.z)
    path, angle = pair.path_of_contact, math.radians(pair.working_transverse_pressure_angle)
    pitches = pair.working_pitch_diameters
    return {
        "gears": [
            _gear("pinion", pair.pinion, 0.0, 0.0, 1.0) | {"pitch": abs(pitches.pinion)},
            _gear("wheel", pair.wheel, pose.x, turn, -pair.pinion.teeth / pair.wheel.teeth) | {"pitch": abs(pitches.wheel)},
        ],
        "line": {"base": pair.pinion.base_diameter / 2, "angle": angle, "path": list(path), "length": pair.base_tangent.length},
    }


def _gear(name: str, gear: Gear, x: float, turn: float, ratio: float) -> dict[str, Any]:
    outline = gear.profile.contour(_CHORD * gear.normal_module).round(_DIGITS)
    return {
        "name": name,
        "x": float(x),  # plain: a derived centre distance is no number of JSON
        "turn": turn,
        "ratio": ratio,
        "teeth": gear.teeth,
        "outline": outline.ravel().tolist(),
        "bore": gear.body.bore,
        "rim": gear.body.rim_diameter,
        "circles": {
            "tip": abs(gear.tip_diameter),
            "reference": abs(gear.reference_diameter),
            "base": abs(gear.base_diameter),
            "form": abs(gear.form_diameter),
            "root": abs(gear.root_diameter),
        },
    }
