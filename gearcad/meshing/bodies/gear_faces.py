"""What each face of a gear's boundary representation is: told by what it lies on and where, not by an order of faces."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.errors import SolverError
from gearcad.geometry import Gear
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.helix import section_turn
from gearcad.geometry.turned import FlankCurve, flank_curves
from gearcad.meshing.bodies.brep import BrepFace, Surface
from gearcad.meshing.bodies.names import GAP, RIM, named_left

__all__ = ["ROOT", "GearFace", "GearFaces"]

ROOT = "root"
"""Of a root land, which is of two teeth."""

_NEAR = 1e-6
"""Radii and heights (mm) closer than this are the same: the CAD kernel's are exact to rounding."""

_NAMES = {CurveKind.FILLET: "fillet", CurveKind.INVOLUTE: "flank"}
"""Names of what the left and the right of a tooth each have; tip chamfers belong to the tip."""


@dataclass(frozen=True)
class GearFace:
    """A face of a gear. `name` is that of its side, where it has one only: a root land is of `tooth` and the next.

    `curve` is the number of the flank curve that it is swept from (None: no flank), on the side of its tooth that is `left` of
    the middle counter-clockwise, as y > 0 is of a tooth on +x; `radius` (mm) is that of a cylinder about `axis` (mm).
    """

    surface: Surface
    name: str
    tooth: int = 0
    curve: int | None = None
    left: bool = True
    radius: float = 0.0
    axis: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class GearFaces:
    """Tells the faces of one gear apart."""

    gear: Gear

    @cached_property
    def curves(self) -> list[FlankCurve]:
        """The curves that flanks are swept from, root to tip."""
        return flank_curves(self.gear)

    def told(self, faces: Sequence[BrepFace]) -> list[GearFace]:
        """What these faces are. Raises SolverError for one that a gear has not."""
        return [_TELL[face.surface](self, face) for face in faces]

    def _tooth(self, face: BrepFace) -> tuple[int, float]:
        """The tooth whose middle is nearest, and the angle (rad) from there."""
        x, y, z = face.middle
        pitch = 2 * math.pi / self.gear.tooth_count
        angle = math.atan2(y, x) - float(section_turn(self.gear, np.asarray(z)))
        tooth = round(angle / pitch)
        return tooth % self.gear.tooth_count, angle - tooth * pitch

    def _swept(self, face: BrepFace) -> GearFace:
        tooth, angle = self._tooth(face)
        inwards = -1 if self.gear.internal else 1
        ends = [inwards * float(curve.curve.polar(1.0)[0]) for curve in self.curves]
        number = min(int(np.searchsorted(ends, inwards * math.hypot(*face.middle[:2]))), len(ends) - 1)
        name = _NAMES.get(self.curves[number].curve.kind)
        side = "left" if named_left(self.gear, positive=angle > 0) else "right"
        return GearFace(face.surface, f"{side}_{name}_{tooth}" if name else f"tip_{tooth}", tooth, number, angle > 0)

    def _round(self, face: BrepFace) -> GearFace:
        gear, profile, radius = self.gear, self.gear.profile, math.hypot(*face.middle[:2])
        tooth, angle = self._tooth(face)
        middle = (profile.root_diameter + profile.tip_diameter) / 4
        if gear.internal and radius > profile.root_diameter / 2 + _NEAR:
            return self._outside(face, radius)
        if gear.double_helix.gap_width and abs(radius - gear.gap_diameter / 2) < _NEAR:
            return GearFace(face.surface, GAP, radius=gear.gap_diameter / 2)
        if radius < gear.body.bore / 2 + _NEAR:
            name, known = "bore", gear.body.bore / 2
        elif not -_NEAR < face.middle[2] < gear.face_width + _NEAR:
            name, known = "hub", gear.body.hub_diameter / 2
        elif (radius < middle) != gear.internal:
            name, known = ROOT, profile.root_diameter / 2
            tooth -= angle < 0
        else:
            name, known = f"tip_{tooth}", profile.tip_diameter / 2
        if abs(radius - known) > _NEAR:
            raise SolverError(f"the solid has a cylinder of radius {radius:.6g} mm that the gear has not")
        return GearFace(face.surface, name, tooth % gear.tooth_count, radius=known)

    def _outside(self, face: BrepFace, radius: float) -> GearFace:
        """The rim of a ring, or one of its bolt holes."""
        body = self.gear.body
        if body.rim_diameter is not None and abs(radius - body.rim_diameter / 2) < _NEAR:
            return GearFace(face.surface, RIM, radius=body.rim_diameter / 2)
        pitch = 2 * math.pi / max(body.bolt_holes, 1)
        place = pitch * round(math.atan2(face.middle[1], face.middle[0]) / pitch)
        axis = (body.bolt_circle / 2 * math.cos(place), body.bolt_circle / 2 * math.sin(place))
        if abs(math.dist(axis, face.middle[:2]) - body.bolt_diameter / 2) > _NEAR:
            raise SolverError(f"the solid has a cylinder at {radius:.6g} mm from the axis that the ring has not")
        return GearFace(face.surface, "bolt_holes", radius=body.bolt_diameter / 2, axis=axis)

    def _conical(self, face: BrepFace) -> GearFace:
        return GearFace(face.surface, "end_chamfers")

    def _flat(self, face: BrepFace) -> GearFace:
        if abs(face.normal[2]) < 0.5:
            return GearFace(face.surface, "keyway")
        back, front = self.gear.body.hub_ends
        heights = {"end_back": 0.0, "end_front": self.gear.face_width}
        if self.gear.double_helix.gap_width:
            half = self.gear.half_width
            heights |= {"gap_back": half, "gap_front": self.gear.face_width - half}
        heights |= {"hub_back": -back} if back else {}
        heights |= {"hub_front": self.gear.face_width + front} if front else {}
        for name, height in heights.items():
            if abs(face.middle[2] - height) < _NEAR:
                return GearFace(face.surface, name)
        raise SolverError(f"the solid has an end at z = {face.middle[2]:.6g} mm that the gear has not")


_TELL = {
    Surface.SPLINE: GearFaces._swept,
    Surface.CYLINDER: GearFaces._round,
    Surface.CONE: GearFaces._conical,
    Surface.PLANE: GearFaces._flat,
}
