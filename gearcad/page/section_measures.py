"""Measuring by hand in the section: modes, thicknesses, gaps, pins, and the tool at its gear.

Found without NiceGUI. Lengths in mm, angles in radians.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping
from enum import Enum
from typing import Any, NamedTuple

import numpy as np

from gearcad.core.errors import GearcadError
from gearcad.core.records import Floats, JsonObject
from gearcad.designs.design import Design
from gearcad.designs.pair_designs import PairDesign, RackPairDesign
from gearcad.geometry import Gear
from gearcad.verification.tool_sweep import Hob, Shaper, tool_of
from gearcad.verification.tool_teeth import Complexes, CutterTooth, JoinedTeeth, RackTooth

LARGEST = 1e5
"""Largest size of a value (mm) that can be drawn or asked for."""

_CORNER_POINTS = 12
_FLANK_POINTS = 40
_ROUND = 0.06
"""Points of a rounded corner of a tool, of half the outline of a cutter, and how far the roll goes beyond contact (rad)."""


class SectionMode(Enum):
    """Modes of drawing and measuring by hand in the section."""

    LOOK = "look"
    DRAW = "draw"
    THICKNESS = "thickness"
    GAP = "gap"
    PINS = "pins"
    TOOL = "tool"


class Asked(NamedTuple):
    """Request of a mode: the number of the gear, and a diameter (mm) on it or that of a pin; None for the usual one."""

    gear: int = 0
    size: float | None = None


def asked_of(told: Mapping[str, Any]) -> Asked:
    """Return what the browser asks for; what is no gear or no length (mm) is left out."""
    gear, size = told.get("gear"), told.get("size")
    length = float(size) if isinstance(size, int | float) and not isinstance(size, bool) else 0.0
    is_gear = isinstance(gear, int) and not isinstance(gear, bool) and 0 <= gear < _MOST_GEARS
    return Asked(int(gear or 0) if is_gear else 0, length if 0 < length < LARGEST else None)


_MOST_GEARS = 64
"""Number above every number of a gear."""


def thickness_at(gear: Gear, diameter: float | None) -> JsonObject:
    """Return the transverse thickness of a tooth, along the circle and as a chord, at a diameter (mm), if the tooth is there.

    Without a diameter that is d + 2 x m_n.
    """
    wanted = abs(gear.reference_diameter + 2 * gear.profile_shift * gear.normal_module) if diameter is None else diameter
    low, high = sorted((abs(gear.root_diameter), abs(gear.tip_diameter)))
    radius = min(max(wanted, low), high) / 2
    half = math.radians(gear.profile.half_angle(radius))
    return {"diameter": 2 * radius, "half": half, "arc": 2 * radius * half, "chord": 2 * radius * math.sin(half)}


def pins_at(gear: Gear, pin: float | None) -> JsonObject:
    """Return the dimension over two pins of a diameter (mm), between them in a ring, and the circle (mm) of their centres.

    Without a diameter the pins are the usual ones. `why_not` tells why there is none.
    """
    size = float(gear.ball_diameter) if pin is None else pin
    inspection = gear.inspection
    odd = math.cos(math.pi / (2 * gear.tooth_count)) if gear.tooth_count % 2 else 1.0
    try:
        over = float(inspection.between_pins(size) if gear.internal else inspection.over_pins(size))  # type: ignore[attr-defined]
        balls = float(inspection.between_balls(size) if gear.internal else inspection.over_balls(size))
    except GearcadError as error:
        return {"pin": size, "why_not": str(error)}
    circle = (balls + (size if gear.internal else -size)) / odd
    return {"pin": size, "over": over, "circle": circle, "odd": gear.tooth_count % 2, "internal": gear.internal, "why_not": ""}


def gaps_of(design: Design) -> JsonObject | None:
    """Return the gaps (mm) between the flanks that do not touch: along the pitch circles, the line of action, and normal."""
    if not isinstance(design, PairDesign | RackPairDesign):
        return None
    pair = design.pair
    along = float(pair.circumferential_backlash)
    return {
        "circumferential": along,
        "line_of_action": along * math.cos(math.radians(pair.working_transverse_pressure_angle)),
        "normal": float(pair.normal_backlash),
    }


def tool_at(gear: Gear) -> JsonObject:
    """Return outlines of the tool's tooth that makes a space, where it stands at turns (rad) of the gear: [re, im, ...] each.

    They are in the frame of the gear, whose tooth 0 lies on +x, seen from the tooth: the tool rolls over it.
    """
    tool = tool_of(gear)
    space = math.pi / gear.tooth_count
    outlines = [_mirrored(half) for half in _halves(tool, gear.normal_module)]
    reach = math.acos(min(abs(gear.base_diameter) / abs(gear.tip_diameter), 1.0)) if not gear.internal else 0.5
    turns = np.linspace(-1.0, 1.0, 61) * max(reach + _ROUND, 4 * space)
    place = _rack_place(tool) if isinstance(tool, Hob) else _cutter_place(tool)
    stands = [[_flat(place(outline, float(turn)) * cmath.exp(1j * space)) for outline in outlines] for turn in turns]
    return {"kind": "rack" if isinstance(tool, Hob) else "cutter", "turns": turns.tolist(), "stands": stands}


def _rack_place(tool: Hob) -> Callable[[Complexes, float], Complexes]:
    """The inverse of `Hob.seen`: a point of the rack in the frame of the gear, when this has turned."""

    def place(points: Complexes, turn: float) -> Complexes:
        across, out = points.real, points.imag
        placed: Complexes = (out + tool.reference + 1j * (across + tool.reference * turn)) * cmath.exp(-1j * turn)
        return placed

    return place


def _cutter_place(tool: Shaper) -> Callable[[Complexes, float], Complexes]:
    """The inverse of `Shaper.seen`: a point of the cutter in the frame of the gear, when this has turned."""

    def place(points: Complexes, turn: float) -> Complexes:
        turned = points * cmath.exp(1j * tool.side * turn / tool.share)
        placed: Complexes = (tool.side * turned + tool.centre_distance) * cmath.exp(-1j * turn)
        return placed

    return place


def _halves(tool: Hob | Shaper, module: float) -> list[Complexes]:
    """Halves of the teeth of a tool, from the middle of the tip on, in its transverse section."""
    teeth = tool.tooth.teeth if isinstance(tool.tooth, JoinedTeeth) else (tool.tooth,)
    return [_half_rack(each, module) if isinstance(each, RackTooth) else _half_cutter(each) for each in teeth]


def _half_rack(tooth: RackTooth, module: float) -> Complexes:
    """Half a tooth of a rack: land, rounded corner, and the flank to two modules above its line."""
    across, height = tooth.corner
    share = np.linspace(0.0, math.pi / 2 - tooth.angle, _CORNER_POINTS)
    corner = across + tooth.radius * np.sin(share) + 1j * (height - tooth.radius * np.cos(share))
    top = tooth.line + 2 * module
    end = tooth.half_thickness + (top - tooth.line) * math.tan(tooth.angle) + 1j * top
    half: Complexes = np.concatenate([[1j * tooth.tip], corner, [end]])
    return half.real / tooth.cosine + 1j * half.imag


def _half_cutter(tooth: Any) -> Complexes:
    """Half a tooth of a cutter, with fewer points."""
    outline: Complexes = tooth.outline if isinstance(tooth, CutterTooth) else np.zeros(1, complex)
    every = max(len(outline) // _FLANK_POINTS, 1)
    return np.concatenate([outline[:-1:every], outline[-1:]])


def _mirrored(half: Complexes) -> Complexes:
    """A whole tooth of its half: mirrored at the axis on which the half begins, the imaginary one of a rack."""
    other = -half.conj() if abs(half[0].real) < abs(half[0].imag) else half.conj()
    whole: Complexes = np.concatenate([half[::-1], other[1:]])
    return whole


def _flat(points: Complexes) -> list[float]:
    rows: Floats = np.column_stack([points.real, points.imag])
    found: list[float] = rows.round(3).ravel().tolist()
    return found
