"""Parts of a transverse section, as the page draws them: gears, racks, meshes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import Gear, Rack
from gearcad.geometry.curves import parameters_within
from gearcad.geometry.helix import section_turn
from gearcad.geometry.path import PathOfContact
from gearcad.geometry.touching import first_touch
from gearcad.solids.colours import PART_COLOURS, Colour

__all__ = ["CHORD", "body_of", "colour_of", "drift", "mesh_of", "plain", "rack_of", "turns"]

CHORD = 2e-4
"""Error of outlines, in normal modules: seen only where a flank fills the window."""

_DIGITS = 5
"""Of a coordinate, in mm."""


def turns(gear: Gear, rotation: float, z: float) -> list[list[float]]:
    """How far sections are turned (rad) at heights of the first gear (mm), straight between those that are told."""
    own = np.array([0.0, gear.face_width])
    if gear.double_helix.present:
        middle = gear.face_width / 2
        own = np.array([0.0, middle, np.nextafter(middle, gear.face_width), gear.face_width])
    table: list[list[float]] = np.column_stack([own + z, rotation + section_turn(gear, own)]).tolist()
    return table


def drift(rack: Rack, travel: float, z: float) -> list[list[float]]:
    """The same of a rack, as lengths (mm)."""
    return [[z, travel], [z + rack.face_width, travel + rack.drift * rack.face_width]]


def mesh_of(pinion: Gear, path: PathOfContact, angle: float, length: float | None) -> dict[str, Any]:
    """The mesh of the first two bodies, the pinion's tooth pointing at the mate at no turn; `length` is T1T2 (mm).

    `side` is 1 where the pinion's left flanks touch when those of the first body do, -1 where its right flanks do.
    """
    return {
        "of": [0, 1],
        "towards": 0.0,
        "side": 1,
        "base": pinion.base_diameter / 2,
        "angle": math.radians(angle),
        "path": list(path),
        "pitch": pinion.transverse_base_pitch,
        "length": length,
        "first": first_touch(pinion, pinion.profile, angle),
    }


def body_of(
    name: str,
    gear: Gear,
    colour: Colour,
    place: tuple[float, float],
    turned: Iterable[Iterable[float]],
    ratio: float,
    beside: Mapping[str, float] | None = None,
    *,
    rest: float = 0.0,
    slack: float = 0.0,
) -> dict[str, Any]:
    """A gear where it stands; `beside` are further circles by what they are called.

    Its keyway and bolt holes are turned by `rest` (rad), whatever the height. It turns by `slack` (rad) until the left flanks
    of the first body touch.
    """
    body = gear.body
    return {
        "name": name,
        "colour": colour_of(colour),
        "place": list(place),
        "turns": turned,
        "rest": rest,
        "ratio": ratio,
        "slack": slack,
        "teeth": gear.teeth,
        "tooth": _listed(gear.profile.points(CHORD * gear.normal_module)),
        "bore": body.bore,
        "keyway": [body.keyway_width, body.keyway_depth],
        "bolts": [body.bolt_circle, body.bolt_holes, body.bolt_diameter],
        "rim": body.rim_diameter,
        "circles": {
            "tip": abs(gear.tip_diameter),
            "reference": abs(gear.reference_diameter),
            "base": abs(gear.base_diameter),
            "form": abs(gear.form_diameter),
            "root": abs(gear.root_diameter),
            **(beside or {}),
        },
    }


def rack_of(
    rack: Rack, place: tuple[float, float], angle: float, travel: Iterable[Iterable[float]], ratio: float, slack: float = 0.0
) -> dict[str, Any]:
    """A rack where it stands, its own x axis at an angle (rad); lines are heights above its reference line.

    It moves by `slack` (mm) until the left flanks of the first body touch.
    """
    error, profile = CHORD * rack.normal_module, rack.profile
    half = np.concatenate([curve.points(parameters_within(curve, error))[:-1] for curve in profile.curves])
    tooth = np.concatenate([half, [[0.0, profile.tip_height]], half[::-1] * [-1, 1]])
    return {
        "name": "rack",
        "colour": colour_of(PART_COLOURS["rack"]),
        "place": list(place),
        "angle": angle,
        "turns": travel,
        "ratio": ratio,
        "slack": slack,
        "pitch": profile.pitch,
        "length": rack.length,
        "height": rack.height,
        "tooth": _listed(tooth),
        "circles": {"tip": rack.tip_height, "reference": 0.0, "form": -rack.form_depth, "root": -rack.root_depth},
    }


def colour_of(colour: Colour) -> str:
    """As CSS has it."""
    return f"rgb({', '.join(str(round(255 * share)) for share in colour)})"


def _listed(points: Floats) -> list[float]:
    listed: list[float] = points.round(_DIGITS).ravel().tolist()
    return listed


def plain(found: Any) -> Any:
    """What is sent, its numbers without what ours remember of where they come from."""
    if isinstance(found, Mapping):
        return {key: plain(value) for key, value in found.items()}
    if isinstance(found, (list, tuple)):
        return [plain(value) for value in found]
    return float(found) if isinstance(found, float) else found
