"""DXF of a planetary train: the section of every gear, in its place in mesh."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dxf import drawing
from gearcad.geometry.helix import section_turn
from gearcad.solids.files.contour import extent_of, gear_contour
from gearcad.solids.files.dxf import draw_circles, draw_section
from gearcad.solids.train_layout import Standing, TrainLayout

if TYPE_CHECKING:
    from ezdxf.document import Drawing

__all__ = ["section_angle", "write_train_dxf"]

_SHADES = (1, 5, 3, 30, 6, 4, 2, 40)
"""Colours (AutoCAD index) of the layers, in turn."""

_NOT_IN_LAYERS = re.compile(r'[<>/\\":;?*|=`,]')


def write_train_dxf(layout: TrainLayout, path: Path | str, *, accuracy: float = 0.0005, circles: bool = False) -> None:
    """Write the transverse sections of all gears as DXF (R2010, mm), each a closed polyline of arcs in its place.

    Gears that mesh are cut by one plane: rims and centrals in the middle of their teeth, a stage in the middle of its pinion's.
    What is of one gear, bore, rim and bolt holes included, is on a layer of its name; all planets share those of their rims.
    `circles` draws tip, reference, base and root circles on a layer CIRCLES. The header states how far the drawing reaches.
    Equal input gives equal bytes. Raises ParameterError for an `accuracy` (mm) below 1e-7.
    """
    layers = {key: _NOT_IN_LAYERS.sub("_", key) for key in layout.bodies}
    contours = {key: gear_contour(body.gear, accuracy) for key, body in layout.bodies.items()}
    colours = {layers[key]: (_SHADES[i % len(_SHADES)], "CONTINUOUS") for i, key in enumerate(layers)}
    low, high = np.full(2, math.inf), np.full(2, -math.inf)
    with drawing(path, colours) as document:
        for standing in layout.standing:
            key = standing.body.key
            placed = _draw(document, standing, contours[key], section_angle(layout, standing), layers[key], circles=circles)
            least, most = extent_of(placed)
            rim = standing.body.gear.body.rim_diameter or 0.0
            place = np.array(standing.offset[:2])
            low, high = np.minimum(low, least), np.maximum(high, most)
            if rim:
                low, high = np.minimum(low, place - rim / 2), np.maximum(high, place + rim / 2)
        document.modelspace().reset_extents((*low, 0.0), (*high, 0.0))


def section_angle(layout: TrainLayout, standing: Standing) -> float:
    """How far (rad) the section of a gear is turned in the plane that cuts its mesh."""
    gear = standing.body.gear
    height = gear.face_width / 2
    if standing in layout.stages:
        number = layout.stages.index(standing)
        pinion = layout.stages[number - number % 2]
        height = pinion.z + pinion.body.gear.face_width / 2 - standing.z
    return math.radians(standing.rotation) + float(section_turn(gear, np.array([height]))[0])


def _draw(document: Drawing, standing: Standing, contour: Floats, turn: float, layer: str, *, circles: bool) -> Floats:
    """Draw a gear in its place; its contour there."""
    from ezdxf.math import Matrix44

    space = document.modelspace()
    x, y, _ = standing.offset
    place = Matrix44.z_rotate(turn) @ Matrix44.translate(x, y, 0.0)
    before = len(space)
    draw_section(space, standing.body.gear, contour)
    for entity in space[before:]:
        entity.dxf.layer = layer
    if circles:
        draw_circles(document, standing.body.gear)
    for entity in space[before:]:
        entity.transform(place)
    cosine, sine = math.cos(turn), math.sin(turn)
    across, along, bulge = contour.T
    return np.stack([cosine * across - sine * along + x, sine * across + cosine * along + y, bulge], -1)
