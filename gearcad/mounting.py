"""Mounting: the positions of the gears of a pair in the machine; SupportCompliance: what their supports give way under load.

A contact takes the compliance of supports as it is, whatever makes it: shafts on their bearings, or measured figures. A force
on a flank has a direction d in the transverse section and along the axis; its moment about the axis grows with the roll length
s of its place: r x d = (r x d)_0 + s m x d, m along the line of action. So two loads at each station do for all places.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, Any, NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError, InputError, format_number
from gearcad.core.quantities import OFFSET, Range, Words, require_fields
from gearcad.core.records import Floats, PerGear, concise, freeze
from gearcad.geometry import GearPair

__all__ = ["Mounting", "SupportCompliance"]

MOST_DEVIATION = 1000.0
"""Greatest deviation of a mounting (µm)."""

_DEVIATION = Range("µm", -MOST_DEVIATION, MOST_DEVIATION)


@dataclass(frozen=True, kw_only=True)
class Mounting:
    """Deviations of a pair in its housing and of its teeth; all 0 is the drawing. Deviations in µm, lengths in mm.

    The wheel's axis is turned about the middle of the common face width: `misalignment` is how far its sections move along
    the line of action from one end of the common face width to the other, positive if the wheel's flanks recede from the
    pinion's towards larger z, so that the gap grows; `misalignment_across` how far they move square to the plane of action,
    positive away from the pinion's axis. `pinion_pitch_error` and `wheel_pitch_error` are those of one tooth each, which
    meet in the middle pair: along the base tangent, positive if the flank stands proud. `centre_distance_change` is added
    to the centre distance. Raises ParameterError.
    """

    misalignment: Annotated[float, _DEVIATION, Words("misalignment in the plane of action", "F_βx", "ISO 6336-1")] = 0.0
    misalignment_across: Annotated[float, _DEVIATION, Words("misalignment across that plane")] = 0.0
    pinion_pitch_error: Annotated[float, _DEVIATION, Words("pitch error of a tooth of the pinion", "f_p1", "ISO 1328-1")] = 0.0
    wheel_pitch_error: Annotated[float, _DEVIATION, Words("pitch error of a tooth of the wheel", "f_p2", "ISO 1328-1")] = 0.0
    centre_distance_change: Annotated[float, OFFSET, Words("change of the centre distance", "Δa")] = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)

    @property
    def pitch_error(self) -> float:
        """Pitch error (µm) of the middle pair of teeth, both flanks together, positive if they stand proud."""
        return self.pinion_pitch_error + self.wheel_pitch_error

    @property
    def tilted(self) -> bool:
        """True if the wheel's axis is not parallel to the pinion's."""
        return bool(self.misalignment or self.misalignment_across)

    def mounted(self, pair: GearPair) -> GearPair:
        """Return the pair at the centre distance of this mounting. Raises GeometryError where the gears no
        longer mesh there.
        """
        change = self.centre_distance_change
        if not change:
            return pair
        distance = pair.centre_distance + change
        try:
            return replace(pair, centre_distance=distance)
        except InputError as error:
            at_fault = "" if error.parameter == "centre_distance" else f"{error.parameter} "
            permitted = f"makes a centre distance of {format_number(distance)} mm, but {at_fault}{error.permitted}"
            raise GeometryError("centre_distance_change", change, permitted, "mm").within("mounting") from error


STATIONS = 20
"""Stations over the common face width, unless others are wanted."""


class SupportedCells(NamedTuple):
    """Effect of supports on cells (n,): displacements (n, n) along the normals (mm/N), a gap (n,) in mm that needs no load.

    `turns` (n,) in mm/N are lags of the wheel along the normal by the twist of both supports at the middle of the face,
    `turned` (mm) is the lag without load.
    """

    matrix: Floats
    gap: Floats
    turns: Floats
    turned: float


@dataclass(frozen=True)
class SupportCompliance:
    """Compliance of the supports of both gears at `stations` (k,) in mm from the middle of the common face width.

    `matrices` (2 k, 2 k) are gaps along the base tangent (mm) by loads of 1 N in the transverse section: at each station by the
    force at the roll length 0, then by what each mm of roll length adds. `gaps` (2 k,) in mm are those without load, opening
    positive. `turns` (2 k,) and `turned` are lags along the base tangent by the twist at the middle of the face. `slides` (2,)
    are slopes (mm/mm over the face) of the wheel's way from the pinion's axis, square to the plane of action: without load, and
    by 1 N of an even load. `helix` is the base helix angle (rad).
    """

    stations: Floats
    matrices: PerGear[Floats]
    gaps: PerGear[Floats]
    turns: PerGear[Floats]
    turned: PerGear[float]
    slides: Floats
    helix: float

    def __post_init__(self) -> None:
        freeze(self)

    @cached_property
    def _spline(self) -> Any:
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.stations, np.eye(len(self.stations)))

    def _rows(self, across: Floats, lengths: Floats) -> Floats:
        """Return the weights (n, 2 k) of places on the values at the stations."""
        weights = self._spline(across)
        return np.hstack([weights, weights * lengths[:, None]])

    def cells(self, across: Floats, lengths: PerGear[Floats]) -> SupportedCells:
        """Return what the supports do to cells (n,) at places across the face and at roll lengths on both flanks (mm)."""
        flat = math.cos(self.helix)
        matrix, gap, turns = np.zeros((len(across), len(across))), np.zeros(len(across)), np.zeros(len(across))
        for own, given, turn, places in zip(self.matrices, self.gaps, self.turns, lengths, strict=True):
            rows = self._rows(across, places)
            matrix += flat**2 * (rows @ own @ rows.T)
            gap += flat * (rows @ given)
            turns += flat**2 * (rows @ turn)
        return SupportedCells((matrix + matrix.T) / 2, gap, turns, flat * sum(self.turned))

    @property
    def greatest_gap(self) -> float:
        """Greatest difference of the gap without load over the face (mm), at one roll length."""
        count = len(self.stations)
        return float(sum(np.ptp(gap[:count]) for gap in self.gaps))

    def slide(self, force: float) -> float:
        """Return the slope (mm/mm) of the wheel's way square to the plane of action under a base tangent force (N), even."""
        unloaded, loaded = self.slides.tolist()
        return float(unloaded + loaded * force)
