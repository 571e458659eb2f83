"""What a notebook shows of a rack, or of a pinion and a rack: a small picture from +z, and the figures looked up first."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from gearcad import symbols
from gearcad.arrays import Floats
from gearcad.geometry.curves import parameters_within
from gearcad.geometry.gear import Gear
from gearcad.geometry.picture import CHORD_ERROR, drawing, gear_shapes, polygon, sheet
from gearcad.geometry.pose import Pose, RackPose
from gearcad.geometry.rack_data import RackData
from gearcad.geometry.rack_profile import RackProfile
from gearcad.schema import symbols_of

__all__ = ["rack_html", "rack_pair_html"]

_OF_RACK = "teeth length normal_module helix_angle face_width height tip_height root_depth".split()

_MOST_SHOWN = 12
"""Teeth on each side of the pinion that a picture shows."""


def rack_html(rack: RackData, profile: RackProfile) -> str:
    """A picture of the rack, and a table."""
    view = (0.0, -rack.tip_height, rack.length, rack.total_height)
    picture = drawing(view, lambda pixel: _outline(rack, profile, (0.0, rack.length), None, pixel))
    return sheet(rack.name, picture, [], _rows(rack))


def rack_pair_html(
    name: str,
    pinion: Gear,
    rack: RackData,
    profile: RackProfile,
    pose: RackPose,
    figures: Iterable[tuple[symbols.Symbol, float]],
) -> str:
    """A picture of both in mesh, the rack at its pose as far as it is near, and a table of the rack and the pair."""
    reach = _MOST_SHOWN * profile.pitch
    near = max(0.0, -pose.y - reach), min(rack.length, -pose.y + reach)
    tip = pinion.tip_diameter / 2
    low, high = min(near[0] + pose.y, -tip), max(near[1] + pose.y, tip)
    view = (-tip, -high, tip + pose.x + rack.height, high - low)

    def shapes(pixel: float) -> str:
        gear = "".join(gear_shapes(pinion, pinion.profile, Pose(0.0, 0.0, 0.0), pixel))
        return gear + _outline(rack, profile, near, pose, pixel)

    rows = _rows(rack)
    rows += [(symbol, [value]) for symbol, value in figures]
    return sheet(name, drawing(view, shapes), [], rows)


def _rows(rack: RackData) -> list[tuple[symbols.Symbol, list[float | None]]]:
    written = symbols_of(RackData) | symbols.RACK
    return [(written[name], [getattr(rack, name)]) for name in _OF_RACK]


def _outline(rack: RackData, profile: RackProfile, near: tuple[float, float], pose: RackPose | None, pixel: float) -> str:
    """The section at z = 0 of the pinion, or of a rack by itself, between two places along it (mm)."""
    first, last = (int(place // profile.pitch) for place in near)
    middles = (np.arange(first - 1, last + 2) + 0.5) * profile.pitch
    tooth = _tooth(profile, CHORD_ERROR * pixel)
    shift = 0.0 if pose is None else -rack.drift * pose.z
    x = (middles[:, None] + tooth[:, 0]).ravel() + shift
    y = np.tile(tooth[:, 1], len(middles))
    inside = (x > near[0]) & (x < near[1])
    ends = np.interp(near, x, y)
    top = np.column_stack([np.r_[near[0], x[inside], near[1]], np.r_[ends[0], y[inside], ends[1]]])
    points = np.concatenate([[[near[0], -rack.height], [near[1], -rack.height]], top[::-1]])
    if pose is not None:
        points = np.column_stack([pose.x - points[:, 1], pose.y + points[:, 0]])
    return f'<path d="{polygon(points, pixel)}"/>'


def _tooth(profile: RackProfile, chord_error: float) -> Floats:
    """Points (n, 2) of a tooth from space to space, without the last one."""
    half = np.concatenate([curve.points(parameters_within(curve, chord_error))[:-1] for curve in profile.curves])
    return np.concatenate([half, [[0.0, profile.tip_height]], half[:0:-1] * [-1, 1]])
