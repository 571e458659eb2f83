"""Gears as objects of build123d: solids with joints at the axis and, of a pair, at the pitch point.

>>> from gearcad import Gear, GearPair, build123d
>>> pinion = Gear(teeth=20, normal_module=2, face_width=20)
>>> part = build123d.gear(pinion)  # doctest: +SKIP
>>> wheel = Gear(teeth=41, normal_module=2, face_width=18)
>>> small, large = build123d.pair(GearPair(pinion=pinion, wheel=wheel))  # doctest: +SKIP

The package build123d is not one of gearcad's requirements: `pip install "build123d<0.13"`. CadQuery shares its kernel, so that
nothing is converted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gearcad.core.errors import require_number
from gearcad.geometry import Gear, GearPair, Rack

if TYPE_CHECKING:
    from build123d import Solid

__all__ = ["gear", "pair", "rack"]

AXIS, MESH = "axis", "mesh"
"""Labels of the joints: about the axis of a gear, and at the pitch point in the middle of the common face width."""


def gear(gear: Gear) -> Solid:
    """Return a gear as a build123d solid, teeth from z = 0 to its face width, tooth 0 on +x, with the joint "axis".

    That joint is a revolute one about z at z = 0: what is connected there turns with `angle`. Raises GeometryError as
    `gear_solid` does.
    """
    from build123d import Axis, RevoluteJoint

    from gearcad.solids import gear_solid

    found = _solid(gear_solid(gear), gear.name or "gear")
    RevoluteJoint(AXIS, to_part=found, axis=Axis.Z)
    return found


def rack(rack: Rack) -> Solid:
    """Return a rack as a build123d solid, in the coordinates of the rack."""
    from gearcad.solids import rack_solid

    return _solid(rack_solid(rack), rack.name or "rack")


def pair(pair: GearPair, *, angle: float = 0.0) -> tuple[Solid, Solid]:
    """Return pinion and wheel of a pair posed in mesh, the backlash split evenly, with the joints "axis" and "mesh".

    `angle` (degrees) turns the pinion counter-clockwise, and the wheel with it by the gear ratio. Joints "mesh" are rigid ones:
    `pinion.joints["mesh"].connect_to(wheel.joints["mesh"])` brings the wheel back into mesh wherever the pinion was moved to.
    Raises ParameterError for an angle that is not a number, GeometryError as `gear_solid` does.
    """
    from build123d import Location, RigidJoint

    require_number("angle", angle, "deg")
    pose = pair.wheel_pose(angle)
    small, large = gear(pair.pinion), gear(pair.wheel)
    small.location = Location((0, 0, 0), (0, 0, angle))
    large.location = Location((pose.x, 0, pose.z), (0, 0, pose.rotation))
    height = pair.pinion.face_width / 2 + pair.common_width.offset
    there = Location((pair.working_pitch_diameters.pinion / 2, 0, height))
    for part in (small, large):
        RigidJoint(MESH, to_part=part, joint_location=there)
    return small, large


def _solid(found: Any, label: str) -> Solid:
    """Return a CadQuery solid as one of build123d: both hold the same object of the kernel."""
    from build123d import Solid

    solid: Solid = Solid(found.wrapped)
    solid.label = label
    return solid
