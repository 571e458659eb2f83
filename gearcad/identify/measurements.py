"""Measurements of a gear: readings of calipers, pins and rulers, each with its standard uncertainty."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from itertools import pairwise
from typing import Annotated, Any

from gearcad.core.errors import ParameterError, is_finite_number, plain_numbers, require_whole
from gearcad.core.quantities import Range, Whole, Words
from gearcad.core.records import JsonObject, Notice

LENGTH, ANGLE = Range("mm", 0, 1e6, ends="(]"), Range("deg", -60, 60, ends="()")
"""Permitted readings of lengths (mm) and angles (deg)."""

UNCERTAINTY, ANGLE_UNCERTAINTY = Range("mm", 1e-5, 100), Range("deg", 1e-5, 45)
"""Uncertainty, from that of gauge blocks to a guess."""

TEETH = Whole(3, 2000, negative=(-10, "a ring"))


class Gauge(StrEnum):
    """The measured quantity."""

    TIP_DIAMETER = "tip_diameter"
    ROOT_DIAMETER = "root_diameter"
    SPAN = "span"
    """Span over a number of teeth, or over spaces on a ring."""

    OVER_PINS = "over_pins"
    OVER_BALLS = "over_balls"
    BETWEEN_PINS = "between_pins"
    BETWEEN_BALLS = "between_balls"
    HELIX_ANGLE = "helix_angle"
    """Angle on the reference circle, as a drawing has it."""

    TIP_HELIX_ANGLE = "tip_helix_angle"
    """Angle on the tip circle, as a gear rolled over paper shows it."""

    CHORDAL_THICKNESS = "chordal_thickness"
    """Chord by a tooth caliper, at a height below the tip."""

    LEAD = "lead"
    CENTRE_DISTANCE = "centre_distance"
    MATE_TIP_DIAMETER = "mate_tip_diameter"

    @property
    def unit(self) -> str:
        """Unit of its readings."""
        return "deg" if self in ANGLES else "mm"

    @property
    def sized(self) -> bool:
        """Whether a reading of this gauge needs a size."""
        return self in _SIZED

    @property
    def size_in_words(self) -> str:
        """Name of that size in words."""
        if self is Gauge.SPAN:
            return "teeth spanned"
        return "height below the tip" if self is Gauge.CHORDAL_THICKNESS else "diameter of pins or balls"


ANGLES = (Gauge.HELIX_ANGLE, Gauge.TIP_HELIX_ANGLE)
_SIZED = {
    Gauge.SPAN: "span over {:g} {}",
    Gauge.OVER_PINS: "size over pins of {:g} mm",
    Gauge.OVER_BALLS: "size over balls of {:g} mm",
    Gauge.BETWEEN_PINS: "size between pins of {:g} mm",
    Gauge.BETWEEN_BALLS: "size between balls of {:g} mm",
    Gauge.CHORDAL_THICKNESS: "chord {:g} mm below the tip",
}
_OF_RINGS = (Gauge.BETWEEN_PINS, Gauge.BETWEEN_BALLS)
_OF_EXTERNAL = (Gauge.OVER_PINS, Gauge.OVER_BALLS, Gauge.CHORDAL_THICKNESS)
_OF_MATES = (Gauge.CENTRE_DISTANCE, Gauge.MATE_TIP_DIAMETER)
_OF_HELICES = (*ANGLES, Gauge.LEAD)


@dataclass(frozen=True, kw_only=True)
class Reading:
    """One reading of a gauge: `value` and its standard `uncertainty` (mm, of angles degrees).

    `size` is the number of teeth or spaces of a span, the diameter of pins or balls, or the height of a chord below the tip
    (mm); other gauges have none. Diameters of a ring are positive, as they are read.
    """

    gauge: Gauge
    value: float
    uncertainty: float
    size: float = 0.0

    def __post_init__(self) -> None:
        name, angle = self.gauge.value, self.gauge in ANGLES
        (ANGLE if angle else LENGTH).require(name, self.value)
        (ANGLE_UNCERTAINTY if angle else UNCERTAINTY).require(f"{name}.uncertainty", self.uncertainty)
        if self.gauge is Gauge.SPAN:
            require_whole("span_teeth", self.size, at_least=1, at_most=TEETH.most)
        elif self.gauge in _SIZED:
            LENGTH.require(f"{name}.{self._size}", self.size)
        for field in ("value", "uncertainty"):
            object.__setattr__(self, field, float(getattr(self, field)))

    @property
    def _size(self) -> str:
        """Key of the size in documents."""
        return "height" if self.gauge is Gauge.CHORDAL_THICKNESS else "diameter"

    @property
    def place(self) -> tuple[Gauge, float]:
        """Gauge and size of the reading."""
        return self.gauge, self.size

    def label(self, *, ring: bool = False) -> str:
        """Return the measured quantity in words."""
        words = _SIZED.get(self.gauge, self.gauge.value.replace("_", " "))
        return words.format(self.size, "spaces" if ring else "teeth")

    def to_dict(self) -> JsonObject:
        """Return the reading as documents have it."""
        size = {"teeth": int(self.size)} if self.gauge is Gauge.SPAN else {self._size: self.size}
        beside = size if self.gauge in _SIZED else {}
        return {"gauge": self.gauge.value, **beside, "value": self.value, "uncertainty": self.uncertainty}


@dataclass(frozen=True, kw_only=True)
class Measured:
    """A gear on the bench: its number of `teeth` (below 0 of a ring), readings, and the teeth of its mate, if there is one.

    Raises ParameterError for readings that no such gear can have.
    """

    teeth: int
    readings: tuple[Reading, ...]
    mate_teeth: int | None = None

    def __post_init__(self) -> None:
        for name, number in (("teeth", self.teeth), ("mate_teeth", self.mate_teeth)):
            if number is not None:
                TEETH.require(name, number)
        self._check_gauges()
        self._check_spans()
        self._check_mate()
        if not any(each.gauge not in _OF_HELICES for each in self.readings):
            permitted = "must be given, or another length: root diameter, span, over pins, centre distance"
            raise ParameterError("tip_diameter", None, permitted)

    @property
    def ring(self) -> bool:
        return self.teeth < 0

    @cached_property
    def spur(self) -> bool | None:
        """Whether the helix angle is known to be 0, or known not to be 0; None where nothing is known of it."""
        said = [each for each in self.readings if each.gauge in _OF_HELICES]
        return None if not said else any(each.gauge in ANGLES and each.value == 0 for each in said)

    @property
    def left_hand(self) -> bool:
        return any(each.gauge in ANGLES and each.value < 0 for each in self.readings)

    @property
    def spans(self) -> list[Reading]:
        """Readings over teeth or spaces, the fewest first."""
        return sorted((each for each in self.readings if each.gauge is Gauge.SPAN), key=lambda each: each.size)

    def find(self, gauge: Gauge) -> Reading | None:
        """Return the first reading of a gauge."""
        return next((each for each in self.readings if each.gauge is gauge), None)

    def label(self, reading: Reading) -> str:
        """Return a reading in words."""
        return reading.label(ring=self.ring)

    @property
    def notices(self) -> Iterable[Notice]:
        """Notices about what the readings leave undecided, whatever the gear is."""
        if self._across_tips_less:
            less = self._across_tips_less
            text = f"an odd number of teeth: calipers across the tips read about {less:.2g} mm less than the tip diameter"
            yield Notice("odd-tips", text)

    @property
    def _across_tips_less(self) -> float:
        """Shortfall (mm) of parallel jaws across the pointed tips of an odd number of teeth; 0 for all other gears.

        Against the tip diameter they read d_a (1 - cos(pi/z))/2 less.
        """
        tip = self.find(Gauge.TIP_DIAMETER)
        if tip is None or self.ring or self.teeth % 2 == 0:
            return 0.0
        return tip.value * (1 - math.cos(math.pi / self.teeth)) / 2

    def _check_gauges(self) -> None:
        seen = set()
        for each in self.readings:
            if each.place in seen:
                raise ParameterError(each.gauge.value, each.value, f"must be given once: {self.label(each)} is there already")
            seen.add(each.place)
            if each.gauge in (_OF_EXTERNAL if self.ring else _OF_RINGS):
                kind, way = ("a ring", "between") if self.ring else ("an external gear", "over")
                raise ParameterError(
                    each.gauge.value, each.value, f"must be left out: {kind} is measured {way} pins or balls", "mm"
                )
        said = [each for each in self.readings if each.gauge in _OF_HELICES]
        if self.spur and len(said) > 1:
            raise ParameterError(
                said[1].gauge.value, said[1].value, "must be left out where a helix angle is 0", said[1].gauge.unit
            )
        angles = [each for each in said if each.gauge in ANGLES]
        if len({each.value < 0 for each in angles}) > 1:
            permitted = f"must have the sign of the {self.label(angles[0])}, {angles[0].value:g} deg"
            raise ParameterError(angles[1].gauge.value, angles[1].value, permitted, "deg")

    def _check_spans(self) -> None:
        for each in self.spans:
            require_whole("span_teeth", each.size, at_least=1, at_most=abs(self.teeth))
        for fewer, more in pairwise(self.spans):
            if more.value <= fewer.value:
                permitted = f"must be above the span over {fewer.size:g}, {fewer.value:g} mm"
                raise ParameterError("span", more.value, permitted, "mm")
        if self.spans and self.ring and self.spur is False:
            raise ParameterError(
                "span", self.spans[0].value, "must be left out: a helical ring is measured between balls", "mm"
            )

    def _check_mate(self) -> None:
        of_mate = [each for each in self.readings if each.gauge in _OF_MATES]
        if of_mate and self.mate_teeth is None:
            raise ParameterError("mate_teeth", None, f"must be given with the {self.label(of_mate[0])}")
        if self.mate_teeth is not None:
            if not of_mate:
                raise ParameterError("centre_distance", None, "must be given with the teeth of the mate")
            if (self.teeth < 0 and self.mate_teeth < 0) or self.teeth + self.mate_teeth == 0:
                raise ParameterError("mate_teeth", self.mate_teeth, f"must be of a gear that meshes with {self.teeth} teeth")


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
        """Measured gear, with the uncertainty of each reading."""
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
        """Return the uncertainty of a reading without one of its own."""
        if gauge in ANGLES:
            return self.angle_uncertainty
        return _OF_LEAD * value if gauge is Gauge.LEAD and is_finite_number(value) and value > 0 else self.uncertainty
