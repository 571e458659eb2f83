"""What decks do not treat is refused, so that a deck and our own check are of the same gears."""

from __future__ import annotations

from gearcad.check.task import CheckTask
from gearcad.contact.shared.chain import Cuts
from gearcad.contact.shared.holding import Hold
from gearcad.errors import GeometryError, ParameterError, format_number

__all__ = ["require_same_flanks", "require_treatable"]

_UNTILTED = ("misalignment", "misalignment_across")
_PITCH_ERRORS = ("pinion_pitch_error", "wheel_pitch_error")


def require_treatable(task: CheckTask) -> None:
    """Raise ParameterError or GeometryError for supports, cuts and mountings that decks do not have."""
    _require_one_elasticity(task)
    _require_rigid_hubs(task)
    for name in (*_UNTILTED, *_PITCH_ERRORS):
        if value := getattr(task.mounting, name):
            raise ParameterError(f"mounting.{name}", value, "must be 0 for a deck: it has the gears as they are drawn", "µm")


def _require_one_elasticity(task: CheckTask) -> None:
    pinion, wheel = task.materials
    for name, unit in (("youngs_modulus", "MPa"), ("poisson_ratio", "")):
        if (own := getattr(wheel, name)) != (other := getattr(pinion, name)):
            permitted = f"must be that of the pinion, {format_number(other)}, for a deck, which has one elastic material"
            raise ParameterError(f"wheel.material.{name}", own, permitted, unit)


def _require_rigid_hubs(task: CheckTask) -> None:
    body = task.body
    for role, support in body.supports(task.pair).items():
        if support.hold is not Hold.RIGID:
            held = "rim" if task.pair.gears.pick(role).internal else "bore"
            permitted = f'must be "{Hold.RIGID.value}" for a deck, which holds the {held} all round'
            raise ParameterError(f"check.{role.value}_support", support.hold.value, permitted)
        if body.teeth_held(task.pair.gears.pick(role)) is not None and body.cuts is not Cuts.FIXED:
            raise ParameterError("check.cuts", body.cuts.value, f'must be "{Cuts.FIXED.value}" for a deck')


def require_same_flanks(task: CheckTask) -> None:
    """Raise GeometryError where flanks are modified along the face, and gears do not meet in the middle of theirs.

    A plane deck is of the sections in the middle of both gears, our own check of those in the middle of the common width.
    """
    middle = task.pair.common_width.offset
    for offset, gear in zip((middle, middle - task.pair.axial_offset), task.pair.gears, strict=True):
        if gear.modification.along_face and offset:
            permitted = "must be 0 for a plane deck of flanks that are modified along the face width"
            raise GeometryError("pair.axial_offset", task.pair.axial_offset, permitted, "mm")
