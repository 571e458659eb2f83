"""A pair in mesh: how its gears stand when their flanks touch, and where on the flanks that is.

Left flanks touch, those that carry under a positive torque, or with `left` False the right ones: all is then seen in a mirror,
the plane x-z, and roll angles count clockwise.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import GearPair
from gearcad.geometry.helix import twist
from gearcad.geometry.pose import Pose
from gearcad.meshing.bodies.mesh import ElementMesh, joined
from gearcad.per_gear import PerGear, Role

__all__ = ["contacts", "posed", "poses"]


def posed(
    pair: GearPair, meshes: PerGear[ElementMesh], roll_angle: float, approach: float = 0.0, *, left: bool = True
) -> ElementMesh:
    """Both gears in one mesh: pinion about the z axis, wheel about x = a, unmodified flanks of tooth 0 in contact.

    At `roll_angle` (deg, of the pinion, 0 at the pitch point) they touch in the middle of the common face width. Meshes are
    both of sections or both of solids, in coordinates of their gears; the pinion is turned further by what makes flanks
    approach by `approach` (mm along the line of action).
    """
    solid = meshes.pinion.element.shape.dimension == 3
    places = poses(pair, roll_angle, approach, solid=solid, left=left)
    return joined({role.value: _moved(meshes.pick(role), place) for role, place in places.items()})


def poses(pair: GearPair, roll_angle: float, approach: float = 0.0, *, solid: bool, left: bool = True) -> PerGear[Pose]:
    """The poses of both gears of `posed`: of solids, or of sections, which are not turned by the helix and lie at z = 0."""
    angle = math.radians(pair.working_transverse_pressure_angle)
    lengths = _lengths(pair, roll_angle)
    rolled = PerGear(lengths.pinion + approach, lengths.wheel)
    z = PerGear(0.0, (pair.pinion.face_width - pair.wheel.face_width) / 2 + pair.axial_offset)
    middle = _middle(pair, z.wheel)

    def pose(role: Role, facing: float, x: float) -> Pose:
        gear = pair.gears.pick(role)
        # The tangent point of the base circle is behind the line of centres by the pressure angle, the tooth that touches half
        # a tooth behind its flank.
        turn = facing - angle + 2 * rolled.pick(role) / gear.base_diameter - math.radians(gear.base_half_angle)
        helix = twist(gear, middle - z.pick(role)) if solid else 0.0
        return Pose(math.degrees((turn if left else -turn) - helix), x, z.pick(role) if solid else 0.0)

    facing = 0.0 if pair.internal else math.pi
    return PerGear(pose(Role.PINION, 0.0, 0.0), pose(Role.WHEEL, facing, pair.centre_distance))


def contacts(pair: GearPair, roll_angle: float, beyond: float = 0.0, *, left: bool = True) -> PerGear[Mapping[int, float]]:
    """Where the flanks of unmodified teeth touch in the middle of the common face width: teeth of each gear, and roll lengths
    (mm) on their flanks.

    Tooth j of the pinion meets tooth -j of the wheel, or tooth j of a ring, whose roll lengths are negative. Pairs up to
    `beyond` (mm on the line of action) outside the path of contact count too; their places are the ends of the flanks.
    """
    middle, pitch = _lengths(pair, roll_angle).pinion, pair.pinion.transverse_base_pitch
    first, last = pair.usable_path
    teeth = range(math.ceil((first - beyond - middle) / pitch), math.floor((last + beyond - middle) / pitch) + 1)
    places = {tooth: min(max(middle + tooth * pitch, first), last) for tooth in teeth}
    sense, follows = 1 if left else -1, 1 if pair.internal else -1
    whole = pair.base_tangent.length
    return PerGear(
        {sense * tooth: place for tooth, place in places.items()},
        {follows * sense * tooth: whole - place for tooth, place in places.items()},
    )


def _middle(pair: GearPair, wheel_z: float) -> float:
    """Height (mm) on the pinion of the middle of the common face width, or of the common width of the lower halves."""
    if not pair.double_helical:
        return pair.pinion.face_width / 2 + pair.common_width.offset
    return (max(0.0, wheel_z) + min(pair.pinion.half_width, wheel_z + pair.wheel.half_width)) / 2


def _lengths(pair: GearPair, roll_angle: float) -> PerGear[float]:
    """Roll lengths (mm) at which the flanks of tooth 0 touch."""
    length = pair.path_of_contact.C + math.radians(roll_angle) * pair.pinion.base_diameter / 2
    return PerGear(length, pair.base_tangent.length - length)


def _moved(mesh: ElementMesh, pose: Pose) -> ElementMesh:
    """The mesh turned about the z axis and shifted."""
    turn = math.radians(pose.rotation)
    cosine, sine = math.cos(turn), math.sin(turn)
    points: Floats = mesh.points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return replace(mesh, points=points + np.array([pose.x, 0.0, pose.z]))
