"""Modifications of flanks as the page draws and changes them, and the transmission error of the plane model at once.

The bodies of a pair are meshed and condensed once, without modifications; a change of the flanks changes the gaps only.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from gearcad.check.options import CheckOptions, Model
from gearcad.check.run import plane_model
from gearcad.check.task import CheckTask
from gearcad.contact.plane.pair import PlanePair
from gearcad.core.errors import GearcadError, ParameterError
from gearcad.core.records import JsonObject, Role
from gearcad.designs.pair_designs import PairDesign
from gearcad.geometry import FlankModification, Gear, GearPair
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.mounting import Mounting
from gearcad.page.run_process import value_in_process
from gearcad.rating.options import RatingOptions

AMOUNTS = {
    "tip_relief": (0.0, 1000.0),
    "root_relief": (0.0, 1000.0),
    "profile_crowning": (-1000.0, 1000.0),
    "lead_crowning": (-1000.0, 1000.0),
    "helix_angle_modification": (-1000.0, 1000.0),
    "end_relief": (0.0, 1000.0),
}
"""Least and greatest amounts (µm) that can be drawn."""

LENGTHS = ("tip_relief_length", "root_relief_length", "end_relief_length")
"""Lengths (mm) that can be drawn: of roll, and along the axis."""

_LEAST_LENGTH = 0.05
_AMOUNT_DIGITS, _LENGTH_DIGITS = 1, 2
"""Least length (mm) that can be drawn, and decimals of amounts (µm) and lengths (mm)."""

_POINTS = 81
"""Points of the curves of a flank."""

QUICK = 20
"""Positions over a base pitch while a handle moves. Those of a check are three times as many, and these among them."""


@dataclass(frozen=True)
class DrawnModification:
    """Values by fields of a gear's modification, as they were drawn; `texts` has them under the keys of a spec."""

    role: Role
    values: Mapping[str, float]

    @classmethod
    def of(cls, role: str, values: Mapping[str, Any], design: PairDesign, *, finer: int = 0) -> DrawnModification:
        """Check what the browser sent. Values have so many decimals more where they are `finer`.

        Raises ParameterError for other names, for what is no number, or out of range.
        """
        if role not in {each.value for each in Role}:
            raise ParameterError("role", role, "must be pinion or wheel")
        form = design.gears[role].flank_form
        longest = {
            "tip_relief_length": form.last - form.first,
            "root_relief_length": form.last - form.first,
            "end_relief_length": form.width / 2,
        }
        found = {}
        for name, value in values.items():
            if name not in AMOUNTS and name not in LENGTHS:
                raise ParameterError("modification", name, "must be one that the page draws")
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
                raise ParameterError(name, value, "must be a number")
            low, high = AMOUNTS.get(name, (_LEAST_LENGTH, longest.get(name, 0.0)))
            digits = (_AMOUNT_DIGITS if name in AMOUNTS else _LENGTH_DIGITS) + finer
            scale = 10**digits
            # Rounded to a multiple within the range: a rounded length may not be longer than the flank.
            found[name] = min(max(round(float(value), digits), low), math.floor(high * scale) / scale)
        return cls(Role(role), found)

    @property
    def texts(self) -> dict[str, str]:
        """The values as they would be typed, by the keys of a spec."""
        return {f"{self.role.value}.modification.{name}": f"{value + 0.0:g}" for name, value in self.values.items()}


def drawn_gears(design: PairDesign) -> list[JsonObject]:
    """Return of both gears the values that can be drawn, and the curves of profile and lead of the left flank (mm, µm)."""
    return [_drawn_gear(role, gear) for role, gear in design.pair.gears.items()]


def _drawn_gear(role: Role, gear: Gear) -> JsonObject:
    form, modification = gear.flank_form, gear.modification
    rolls, heights = np.linspace(form.first, form.last, _POINTS), np.linspace(0.0, form.width, _POINTS)
    along = replace(form, modification=_only(modification, profile=False))
    profile = replace(form, modification=_only(modification, profile=True))
    return {
        "role": role.value,
        "first": form.first,
        "last": form.last,
        "width": form.width,
        "hand": form.hand,
        "base": form.base_radius,
        "values": {name: float(getattr(modification, name)) for name in (*AMOUNTS, *LENGTHS)},
        "profile": np.round(1000 * profile.depth(rolls, form.width / 2), 3).tolist(),
        "lead": np.round(1000 * along.depth((form.first + form.last) / 2, heights), 3).tolist(),
    }


_PROFILE = ("tip_relief", "root_relief", "profile_crowning", "pressure_angle_modification")


def _only(modification: FlankModification, *, profile: bool) -> FlankModification:
    """The part of a modification along the profile, or along the face width; amounts of the other part are 0."""
    amounts = ("lead_crowning", "helix_angle_modification", "end_relief") if profile else _PROFILE
    nothing: dict[str, Any] = dict.fromkeys((*amounts, "twist"), 0.0)
    return replace(modification, **nothing)


def live_error(design: PairDesign, count: int | None = None) -> JsonObject:
    """Return the transmission error (µm) of the plane model over the roll angle (deg), and its peak to peak.

    `count` positions, or as many as a check in the plane has. Where there is none, `why_not` has the reason.
    """
    try:
        task = design.check_task("the transmission error depends on it")
        positions = count or task.options.positions_of(Model.PLANE)
        bodies = _bodies(_plain(task.gear_pair), task.material, task.options, task.mounting)
        model = bodies.with_flanks(task.pair)
        angles = model.roll_angles(positions).tolist()
        errors = [1000 * model.solve(angle, task.torque).approach for angle in angles]
    except GearcadError as error:
        return {"angles": [], "errors": [], "peak_to_peak": None, "why_not": str(error), "along_face": False}
    return {
        "angles": angles,
        "errors": errors,
        "peak_to_peak": max(errors) - min(errors),
        "why_not": "",
        "along_face": any(gear.modification.along_face for gear in design.pair.gears),
    }


def _plain(pair: GearPair) -> GearPair:
    """The pair without modifications."""
    pinion, wheel = (replace(gear, modification=FlankModification()) for gear in pair.gears)
    return replace(pair, pinion=pinion, wheel=wheel)


@lru_cache(maxsize=4)
def _bodies(pair: GearPair, material: Materials, options: CheckOptions, mounting: Mounting) -> PlanePair:
    """Return the bodies of the plane model of a pair as mounted, kept for the latest pairs of all sessions.

    They are made in the process beside the server: gmsh, which meshes them, ends a process in whose threads it runs.
    """
    unloaded = CheckTask(
        pair=pair, material=material, load=Load(torque=1.0), mounting=mounting, options=options, rating_options=RatingOptions()
    )
    return value_in_process(plane_model, unloaded)
