"""Which spline has been measured: every size of DIN 5480, ISO 4156 and ANSI B92.1 with so many teeth is held against readings.

The tolerance class is not known, so the tooth thickness (of a hub the space width) is fitted to spans and pins. It costs what
it is off the basic size; tips and roots may be off by what they are made to.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gearcad.core.errors import GeometryError, InputError, ParameterError
from gearcad.core.records import JsonObject, concise
from gearcad.core.units import module_of_pitch
from gearcad.geometry.spline import SplineJoint
from gearcad.geometry.spline_inputs import HubInputs, ShaftInputs
from gearcad.geometry.spline_part import Spline
from gearcad.geometry.spline_standards import (
    ANGLES,
    B92_1,
    DIN5480,
    GREATEST_SHIFT,
    HUB,
    ISO4156,
    LEAST_SHIFT,
    MODULES,
    PITCHES,
    ROOTS,
    SHAFT,
)
from gearcad.identify.measurements import Gauge, Measured, Reading

_MADE_TO = {Gauge.TIP_DIAMETER: 0.1, Gauge.ROOT_DIAMETER: 0.15}
"""Standard uncertainties (mm) of tip and root circles of splines, which have wide tolerances."""

_LOOSE, _FIT = 0.04, 0.05
"""Usual difference (mm) of the actual from the basic size, and its standard uncertainty."""

_USUAL_SHIFT = (-0.05, 0.45)
_UNUSUAL = 4.0
"""Profile shifts of DIN 5480, and what is added to chi² of sizes with others."""

_NEAR = 2.5
"""Distance (modules) of a tip or root reading from the reference diameter beyond which a module is not tried."""

_MISFIT = 9.0
"""Chi² per reading above which no size fits."""

_GAUGES = {
    SHAFT: (Gauge.TIP_DIAMETER, Gauge.ROOT_DIAMETER, Gauge.SPAN, Gauge.OVER_PINS, Gauge.OVER_BALLS),
    HUB: (Gauge.TIP_DIAMETER, Gauge.ROOT_DIAMETER, Gauge.SPAN, Gauge.BETWEEN_PINS, Gauge.BETWEEN_BALLS),
}
"""Readings that tell something of a spline."""

_ALIKE = 4.0
"""Difference of chi² up to which a candidate is as good as the best."""

_STEP = 0.01
"""Step (mm) of tooth thickness over which readings are differentiated."""


@dataclass(frozen=True, kw_only=True)
class SplineCandidate:
    """A spline that readings may be of: the part, its fitted tooth thickness or space width (mm), and how well it fits.

    `residuals` are how far each reading is off, in its uncertainties; `chi_square` is the sum of their squares and of what the
    fitted size and an unusual profile shift cost.
    """

    spline: Spline
    size: float
    residuals: tuple[float, ...]
    chi_square: float

    __repr__ = concise

    @property
    def designation(self) -> str:
        """Designation without a tolerance class."""
        return self.spline.designation

    @property
    def misfit(self) -> float:
        """Root of the mean square of the residuals, the costs among them."""
        return math.sqrt(self.chi_square / max(len(self.residuals), 1))

    def to_dict(self) -> JsonObject:
        """Return the candidate as documents have it."""
        joint = self.spline.joint
        return {
            "designation": self.designation,
            "standard": joint.standard,
            "module": joint.module,
            "pressure_angle": joint.pressure_angle,
            "root": self.spline.root,
            "profile_shift": joint.profile_shift,
            "size": self.size,
            "basic_size": self.spline.basic_size,
            "misfit": self.misfit,
            "chi_square": self.chi_square,
            "residuals": list(self.residuals),
        }


@dataclass(frozen=True, kw_only=True)
class SplineIdentification:
    """The splines that readings may be of, the best first."""

    measured: Measured
    candidates: tuple[SplineCandidate, ...]

    @property
    def best(self) -> SplineCandidate:
        """The candidate that fits best."""
        return self.candidates[0]

    @property
    def rivals(self) -> tuple[SplineCandidate, ...]:
        """Other sizes that are as good as the best: their chi² is at most 4 larger."""
        others = (each for each in self.candidates[1:] if each.designation != self.best.designation)
        return tuple(each for each in others if each.chi_square - self.best.chi_square <= _ALIKE)

    @property
    def fits(self) -> bool:
        """Whether the best one explains the readings."""
        return self.best.chi_square <= _MISFIT * len(self.measured.readings)

    def to_dict(self) -> JsonObject:
        """Return readings and candidates as documents have them."""
        return {
            "kind": "identify",
            "teeth": self.measured.teeth,
            "readings": [each.to_dict() for each in self.measured.readings],
            "fits": self.fits,
            "certain": self.fits and not self.rivals,
            "candidates": [each.to_dict() for each in self.candidates],
        }


def identify_spline(measured: Measured, count: int = 10) -> SplineIdentification:
    """Return the splines that readings may be of, at most `count`, the best first; teeth below 0 are those of a hub.

    Nominal diameters of DIN 5480 are tried in whole mm. Raises ParameterError for readings that tell nothing of a spline,
    GeometryError where no size has so many teeth.
    """
    part = HUB if measured.ring else SHAFT
    for each in measured.readings:
        if each.gauge not in _GAUGES[part]:
            raise ParameterError(each.gauge.value, each.value, "must be left out: it tells nothing of a spline")
    found = [_fitted(spline, measured) for spline in _sizes(measured, part)]
    made = sorted((each for each in found if each is not None), key=lambda each: each.chi_square)
    if not made:
        permitted = "must be counted again, or the readings taken again: no spline of a standard comes near them"
        raise GeometryError("teeth", measured.teeth, permitted)
    return SplineIdentification(measured=measured, candidates=tuple(made[:count]))


def _sizes(measured: Measured, part: str) -> Iterator[Spline]:
    """Yield the part of every size that has so many teeth and is not far from the readings of tips and roots."""
    teeth = abs(measured.teeth)
    for standard in (DIN5480, ISO4156, B92_1):
        modules = [module_of_pitch(pitch) for pitch in PITCHES] if standard == B92_1 else MODULES[standard]
        for module in modules:
            if not _is_near(measured, module, teeth):
                continue
            for angle in ANGLES[standard]:
                for root in _roots(measured, part) if standard == DIN5480 else ROOTS[standard]:
                    for diameter in _diameters(module, teeth) if standard == DIN5480 else (None,):
                        yield from _made(standard, part, module, teeth, angle, root, diameter)


def _roots(measured: Measured, part: str) -> tuple[str, ...]:
    """Return the roots of DIN 5480 that the readings can tell apart."""
    if part == HUB:
        return ("broached",)
    return ("hobbed",) if measured.find(Gauge.ROOT_DIAMETER) is None else ("hobbed", "rolled")


def _is_near(measured: Measured, module: float, teeth: int) -> bool:
    diameters = [each.value for each in measured.readings if each.gauge in _MADE_TO]
    return all(abs(each - module * teeth) <= _NEAR * module for each in diameters)


def _diameters(module: float, teeth: int) -> Iterator[float]:
    """Yield the nominal diameters (whole mm) of DIN 5480 that such teeth can have."""
    least, most = (module * (teeth + 1.1 + 2 * shift) for shift in (LEAST_SHIFT, GREATEST_SHIFT))
    yield from map(float, range(math.ceil(least), math.floor(most) + 1))


def _made(
    standard: str, part: str, module: float, teeth: int, angle: float, root: str, diameter: float | None
) -> Iterator[Spline]:
    """Yield the spline of a size, if there is one."""
    own: dict[str, ShaftInputs | HubInputs] = {part: (HubInputs if part == HUB else ShaftInputs)(root=root)}
    size = {} if diameter is None else {"nominal_diameter": diameter}
    try:
        joint = SplineJoint(standard=standard, module=module, teeth=teeth, pressure_angle=angle, **size, **own)  # type: ignore[arg-type]
    except InputError:
        return
    yield joint.parts[part]


@dataclass(frozen=True)
class _Prediction:
    """A reading of a spline: its value at the basic size, and its change with the size."""

    value: float
    slope: float
    uncertainty: float

    @staticmethod
    def of(spline: Spline, reading: Reading) -> _Prediction:
        """Return the prediction of a reading. Raises InputError and ValueError where the gauge does not fit."""
        if reading.gauge in _MADE_TO:
            tip = reading.gauge is Gauge.TIP_DIAMETER
            value = spline.tip_diameter if tip else spline.root_diameter
            return _Prediction(value, 0.0, math.hypot(reading.uncertainty, _MADE_TO[reading.gauge]))
        size = spline.basic_size
        one, other = _read(spline, reading, size), _read(spline, reading, size + _STEP)
        return _Prediction(one, (other - one) / _STEP, reading.uncertainty)


def _read(spline: Spline, reading: Reading, size: float) -> float:
    """Return what a gauge reads on teeth or spaces of a size (mm)."""
    inspection = spline.inspection_of(size)
    if reading.gauge is Gauge.SPAN:
        found = inspection.span_measurement(int(reading.size))
    else:
        found = inspection.between_pins(reading.size) if spline.is_hub else inspection.over_pins(reading.size)  # type: ignore[attr-defined]
    if found is None:
        raise ValueError("the gauge does not touch the flanks")
    return float(found)


def _fitted(spline: Spline, measured: Measured) -> SplineCandidate | None:
    """Return the candidate with the size that fits best; None where a gauge does not fit its teeth."""
    try:
        predicted = [_Prediction.of(spline, each) for each in measured.readings]
    except (InputError, ValueError):
        return None
    usual = _LOOSE if spline.is_hub else -_LOOSE
    weights, pull = 1 / _FIT**2, usual / _FIT**2
    for each, reading in zip(predicted, measured.readings, strict=True):
        weights += (each.slope / each.uncertainty) ** 2
        pull += each.slope * (reading.value - each.value) / each.uncertainty**2
    change = pull / weights
    residuals = tuple(
        (reading.value - each.value - each.slope * change) / each.uncertainty
        for each, reading in zip(predicted, measured.readings, strict=True)
    )
    least, most = _USUAL_SHIFT
    shift = spline.joint.profile_shift
    cost = _UNUSUAL if spline.joint.basis == DIN5480 and not least - 1e-9 <= shift <= most + 1e-9 else 0.0
    chi_square = sum(each**2 for each in residuals) + ((change - usual) / _FIT) ** 2 + cost
    return SplineCandidate(spline=spline, size=spline.basic_size + change, residuals=residuals, chi_square=chi_square)
