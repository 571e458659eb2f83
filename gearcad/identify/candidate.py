"""A gear that may have been measured: the Gear of a fit, with its residuals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from gearcad.arrays import Floats
from gearcad.errors import InputError, SolverError
from gearcad.geometry import BasicRack, Gear
from gearcad.geometry.derived import NOT_GIVEN
from gearcad.identify.fit import Fit
from gearcad.identify.gauges import read_off, touches
from gearcad.identify.measured import Measured, Reading
from gearcad.identify.standards import FREE, StandardRack
from gearcad.identify.unknowns import Unknown

__all__ = ["Candidate", "on_involute", "variance"]

_DIGITS = 4
_WIDTH = 10
"""Face width in modules of a gear whose width nobody asked for."""

_RADIUS_STEP = 0.01
_SLACK = 0.05
"""How far beside the involute a gauge is let pass, in modules: root radii and tip chamfers are not known."""


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A gear that may have been measured, and how probable it is beside the others.

    `residuals` are readings less what the gear has, in units of their uncertainties; uncertainties are standard ones, mm and
    degrees, other ways to have made the gear considered. `chi_square` has as many degrees of freedom as there are readings.
    """

    gear: Gear
    fit: Fit
    rack: StandardRack
    probability: float
    chi_square: float
    predicted: tuple[float, ...]
    residuals: tuple[float, ...]
    off_involute: tuple[Reading, ...]

    @property
    def series(self) -> str:
        """The series of its size: "ISO 54 I", "ISO 54 II", "DIN 780 I", "DIN 780 II", "DP", or "free" for none."""
        return self.fit.hypothesis.size.series

    @property
    def transverse(self) -> bool:
        """Whether its size is that of the transverse section, so that its normal module is of no series."""
        return self.fit.hypothesis.transverse

    @property
    def diametral_pitch(self) -> float | None:
        """Of a size that is one (1/inch)."""
        return self.fit.hypothesis.size.pitch

    @property
    def module_uncertainty(self) -> float:
        """Of the normal module, 0 of one of a series."""
        return self.fit.uncertainty(Unknown.MODULE)

    @property
    def helix_uncertainty(self) -> float:
        return self.fit.uncertainty(Unknown.HELIX_ANGLE)

    @property
    def shift_uncertainty(self) -> float:
        return self.fit.uncertainty(Unknown.SHIFT)

    @property
    def thinning_uncertainty(self) -> float:
        """Of the normal tooth thinning (mm)."""
        return self.gear.tooth_thinning * self.fit.uncertainty(Unknown.THINNING)

    def to_dict(self) -> dict[str, Any]:
        """As identify.json has it."""
        gear = self.gear
        return {
            "probability": self.probability,
            "chi_square": self.chi_square,
            "series": self.series,
            "transverse": self.transverse,
            "normal_module": gear.normal_module,
            "module_uncertainty": self.module_uncertainty,
            "normal_diametral_pitch": None if self.transverse else self.diametral_pitch,
            "pressure_angle": gear.rack.pressure_angle,
            "helix_angle": gear.helix_angle,
            "helix_uncertainty": self.helix_uncertainty,
            "profile_shift": gear.profile_shift,
            "shift_uncertainty": self.shift_uncertainty,
            "tooth_thinning": gear.tooth_thinning,
            "thinning_uncertainty": self.thinning_uncertainty,
            "tip_alteration": gear.tip_alteration,
            "rack": {"name": self.rack.name, "addendum": gear.rack.addendum, "dedendum": gear.rack.dedendum},
            "predicted": list(self.predicted),
            "residuals": list(self.residuals),
        }

    @classmethod
    def of(cls, measured: Measured, fit: Fit, probability: float) -> Candidate | None:
        """That of a fit; None where no such gear can be made."""
        gear = _gear(measured, fit)
        if gear is None:
            return None
        predicted = read_off(measured, measured.readings, fit.unknowns)
        return cls(
            gear=gear,
            fit=fit,
            rack=fit.ways.racks[fit.best],
            probability=probability,
            chi_square=fit.chi_square,
            predicted=tuple(float(each) for each in predicted),
            residuals=tuple(
                (abs(each.value) - float(value)) / each.uncertainty
                for each, value in zip(measured.readings, predicted, strict=True)
            ),
            off_involute=tuple(each for each in measured.readings if not on_involute(gear, each)),
        )


def on_involute(gear: Gear, place: Reading) -> bool:
    """Whether a gauge touches the flanks of a gear, or has nothing to do with them."""
    try:
        diameter = touches(gear.inspection, place)
    except (InputError, SolverError):
        return False
    lowest, highest = sorted((abs(gear.form_diameter), abs(gear.tip_form_diameter)))
    slack = _SLACK * gear.normal_module
    return diameter is None or lowest - slack <= diameter <= highest + slack


def _gear(measured: Measured, fit: Fit) -> Gear | None:
    """The gear of a fit, its numbers rounded, with the largest root radius up to its rack's that can be made."""
    values, rack, size = fit.unknowns, fit.ways.racks[fit.best], fit.hypothesis.size
    sign = -1 if measured.left_hand else 1
    dedendum = round(float(values[Unknown.DEDENDUM]), _DIGITS)
    angle = round(float(values[Unknown.PRESSURE_ANGLE]), _DIGITS)
    helix = round(float(values[Unknown.HELIX_ANGLE]), _DIGITS)
    module = float(f"{float(values[Unknown.MODULE]):.6g}") if size.series == FREE else size.module
    pitch = size.pitch
    if fit.hypothesis.transverse:
        module, pitch = float(f"{size.module * math.cos(math.radians(helix)):.8g}"), None
    try:
        thinning = round(math.exp(float(values[Unknown.THINNING])), _DIGITS)
        full = BasicRack(pressure_angle=angle, dedendum=dedendum).full_root_radius(thinning=thinning / module)
        radius = min(rack.root_radius, math.floor(full / _RADIUS_STEP) * _RADIUS_STEP)
        return Gear(
            name="identified",
            teeth=measured.teeth,
            normal_module=module if pitch is None else NOT_GIVEN,
            normal_diametral_pitch=NOT_GIVEN if pitch is None else pitch,
            face_width=float(f"{_WIDTH * module:.2g}"),
            helix_angle=sign * helix,
            profile_shift=round(float(values[Unknown.SHIFT]), _DIGITS),
            tip_alteration=round(float(values[Unknown.ADDENDUM]) - rack.addendum, _DIGITS) + 0.0,
            tooth_thinning=thinning,
            rack=BasicRack(
                pressure_angle=angle, addendum=rack.addendum, dedendum=dedendum, root_radius=round(max(radius, 0.0), 2)
            ),
        )
    except (InputError, OverflowError):  # a fit far from the readings may have a thinning beyond any float
        return None


def variance(slopes: Floats, fit: Fit) -> float:
    """Of a reading, by what a fit leaves open, where it has these derivatives (u,)."""
    return float(slopes @ fit.covariance @ slopes)
