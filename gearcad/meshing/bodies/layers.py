"""Layers of a swept body: how thick they are, and where over the face width."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import ParameterError
from gearcad.geometry import Gear
from gearcad.geometry.halves import halves
from gearcad.geometry.helix import twist
from gearcad.meshing.section.grading import Grading, graded
from gearcad.meshing.section.outline import MeshSizes

__all__ = ["body_planes", "check_planes"]


_LONGER = 4.0
"""How much longer an edge along the tooth may be than one across its flank: there little changes along the helix."""

_THINNER = 0.4
"""Thickness of a layer at an end of the face, or where an end relief begins, over that in the middle."""

_GROWTH = 0.3
"""How fast layers become thicker from there, per distance."""

_OFF_HELIX = 0.25e-3
"""How far (mm) an edge of second order may be off its helix between its nodes; as much is left to the section's edges."""

_FEWEST = 2
"""Layers of the narrowest gear."""


def body_planes(gear: Gear, sizes: MeshSizes, layers: int | None = None) -> Floats:
    """Heights z (n + 1,) in mm of the planes between layers, closer together at the ends of the face and of end reliefs.

    As many as the sizes ask for, or so many `layers`; of double helical teeth as many in both halves. Raises ParameterError for
    fewer than the end reliefs ask for.
    """
    if gear.double_helix.present:
        lower = body_planes(halves(gear)[0].gear, sizes, None if layers is None else (layers + 1) // 2)
        return np.concatenate([lower, gear.face_width - lower[-2::-1]])
    gradings = _gradings(gear, _thickness(gear, sizes))
    counts = [max(1, math.ceil(grading.edges - 1e-9)) for grading in gradings]
    if layers is None and sum(counts) < _FEWEST:
        layers = _FEWEST
    if layers is not None:
        counts = _shared([grading.edges for grading in gradings], layers)
    parts = [grading.ends(count) for grading, count in zip(gradings, counts, strict=True)]
    return np.concatenate([*(part[:-1] for part in parts), parts[-1][-1:]])


def check_planes(gear: Gear, planes: Floats) -> None:
    """Raise ParameterError for planes (n,) that do not go up from z = 0 to the face width."""
    if planes.ndim != 1 or len(planes) < 2 or not (np.diff(planes) > 0).all() or planes[0] or planes[-1] != gear.face_width:
        permitted = f"must go up from 0 to the face width, {gear.face_width:.10g} mm"
        raise ParameterError("planes", planes.tolist(), permitted, "mm")


def _thickness(gear: Gear, sizes: MeshSizes) -> float:
    """The greatest thickness (mm) of a layer.

    Over a layer that turns by phi a parabola is off a point that turns on the radius R by R phi^3/(72 sqrt 3) at the most.
    """
    wanted = _LONGER * sizes.flank * gear.normal_module
    if not gear.helix_angle:
        return wanted
    turn: float = (72 * math.sqrt(3) * _OFF_HELIX / (gear.profile.tip_diameter / 2)) ** (1 / 3)
    return min(wanted, turn / abs(twist(gear)))


def _gradings(gear: Gear, thickness: float) -> list[Grading]:
    """The face width graded in pieces between its ends and those of end reliefs."""
    ends = np.array([0.0, *gear.flank_form.height_breaks, gear.face_width])
    lengths = np.diff(ends)
    thin = np.minimum(_THINNER * thickness, np.minimum(np.r_[lengths, np.inf], np.r_[np.inf, lengths]))

    def piece(low: float, high: float) -> Grading:
        def size(run: Floats, _whole: float) -> Floats:
            near = thin + _GROWTH * np.abs(low + run[:, None] - ends)
            result: Floats = np.minimum(thickness, near.min(axis=1))
            return result

        return graded(lambda z: np.stack([z, np.zeros_like(z)], -1), size, low, high)

    return [piece(low, high) for low, high in pairwise(ends.tolist())]


def _shared(wanted: list[float], layers: int) -> list[int]:
    """Layers of each piece, at least one, of so many in all, in proportion to what is wanted (Webster's divisors)."""
    if layers < len(wanted):
        permitted = f"must be at least {len(wanted)}: one on each side of where an end relief begins"
        raise ParameterError("layers", layers, permitted)
    given = [1] * len(wanted)
    for _ in range(layers - len(wanted)):
        given[max(range(len(wanted)), key=lambda k: wanted[k] / (given[k] + 0.5))] += 1
    return given
