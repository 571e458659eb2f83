"""Mounting: the positions of the gears of a pair in the machine, where they differ from the drawing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from gearcad.core.errors import GeometryError, InputError, format_number
from gearcad.core.quantities import OFFSET, Range, Words, require_fields
from gearcad.core.records import concise
from gearcad.geometry import GearPair

__all__ = ["Mounting"]

_DEVIATION = Range("µm", -1000.0, 1000.0)


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
