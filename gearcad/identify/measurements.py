"""Measurements: what one writes down of a gear on the bench, in a file or behind options, under the names of the gauges."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any

from gearcad.errors import ParameterError, is_finite_number, plain_numbers
from gearcad.identify.measured import (
    ANGLE,
    ANGLE_UNCERTAINTY,
    ANGLES,
    LENGTH,
    TEETH,
    UNCERTAINTY,
    Gauge,
    Measured,
    Reading,
)
from gearcad.schema import Words

__all__ = ["Measurements", "Value"]

Value = float | tuple[float, float]
"""A reading, or a reading and its standard uncertainty."""

_OF_LEAD = 0.01
"""Uncertainty of a lead that is given without one, relative to it."""


@dataclass(frozen=True, kw_only=True)
class Measurements:
    """Readings of a gear by what was measured: lengths in mm, angles in degrees, each with its own standard uncertainty or
    without; spans by the number of teeth, others by the diameter of the pins or balls, or by the height below the tip.

    Raises ParameterError for readings that no gear can have.
    """

    teeth: Annotated[int, TEETH, Words("number of teeth, as counted; below 0 of a ring", "z")]
    tip_diameter: Annotated[Value | None, LENGTH, Words("over the tips; calipers read less over an odd number of teeth")] = None
    root_diameter: Annotated[Value | None, LENGTH, Words("of the bottoms of the spaces")] = None
    span: Annotated[Mapping[int, Value] | None, LENGTH, Words("over K teeth, of a spur ring over K spaces")] = None
    over_pins: Annotated[Mapping[float, Value] | None, LENGTH, Words("over two pins of diameter D")] = None
    over_balls: Annotated[Mapping[float, Value] | None, LENGTH, Words("over two balls of diameter D")] = None
    between_pins: Annotated[Mapping[float, Value] | None, LENGTH, Words("between two pins, of a spur ring")] = None
    between_balls: Annotated[Mapping[float, Value] | None, LENGTH, Words("between two balls, of a ring")] = None
    chordal_thickness: Annotated[
        Mapping[float, Value] | None, LENGTH, Words("of a tooth, by a tooth caliper set to the height H below the tip")
    ] = None
    helix_angle: Annotated[
        Value | None, ANGLE, Words("on the reference circle; 0 for spur teeth; below 0 for a left hand", "β")
    ] = None
    tip_helix_angle: Annotated[Value | None, ANGLE, Words("on the tips, as the gear rolled over paper prints it")] = None
    lead: Annotated[Value | None, LENGTH, Words("along the axis, of one whole turn of a tooth", "p_z")] = None
    centre_distance: Annotated[Value | None, LENGTH, Words("of the pair in which it runs", "a")] = None
    mate_teeth: Annotated[int | None, TEETH, Words("of the gear with which it runs; below 0 of a ring")] = None
    mate_tip_diameter: Annotated[Value | None, LENGTH, Words("of the gear with which it runs")] = None
    uncertainty: Annotated[float, UNCERTAINTY, Words("standard uncertainty of lengths without their own")] = 0.02
    angle_uncertainty: Annotated[float, ANGLE_UNCERTAINTY, Words("of angles; of a lead 1 %")] = 1.0

    def __post_init__(self) -> None:
        plain_numbers(self)
        UNCERTAINTY.require("uncertainty", self.uncertainty)
        ANGLE_UNCERTAINTY.require("angle_uncertainty", self.angle_uncertainty)
        self.measured  # noqa: B018 - built when they are given, so that what is there can be measured

    @cached_property
    def measured(self) -> Measured:
        """What was measured, each reading with its uncertainty."""
        return Measured(teeth=self.teeth, readings=tuple(self._readings()), mate_teeth=self.mate_teeth)

    def _readings(self) -> Iterator[Reading]:
        for gauge in Gauge:
            given = getattr(self, gauge.value)
            if given is None:
                continue
            if not gauge.sized:
                yield self._reading(gauge, 0.0, given)
                continue
            if not isinstance(given, Mapping):
                raise ParameterError(gauge.value, given, f"must be {{{gauge.size_in_words}: reading}}")
            for size, value in given.items():
                yield self._reading(gauge, size, value)

    def _reading(self, gauge: Gauge, size: float, value: Any) -> Reading:
        if isinstance(value, tuple | list):
            if len(value) != 2:
                raise ParameterError(gauge.value, value, "must be a number, or a number and its uncertainty")
            return Reading(gauge=gauge, value=value[0], uncertainty=value[1], size=size)
        return Reading(gauge=gauge, value=value, uncertainty=self._usual(gauge, value), size=size)

    def _usual(self, gauge: Gauge, value: Any) -> float:
        """The uncertainty of a reading that has none of its own."""
        if gauge in ANGLES:
            return self.angle_uncertainty
        return _OF_LEAD * value if gauge is Gauge.LEAD and is_finite_number(value) and value > 0 else self.uncertainty
