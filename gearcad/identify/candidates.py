"""Candidates for a measured gear: the gears of the fits with their residuals, and how certain they are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

from gearcad.core.errors import InputError, SolverError, SpecError
from gearcad.core.quantities import NOT_GIVEN
from gearcad.core.records import Floats, JsonObject, Notice, Pictured, texts
from gearcad.geometry import BasicRack, Gear
from gearcad.geometry.tool_tables import ShelfTool, ToolRow
from gearcad.identify.fit import FittedHypothesis, read_off, touches
from gearcad.identify.measurements import Gauge, Measured, Reading
from gearcad.identify.standards import FREE, StandardRack, Unknown

_DIGITS = 4
_WIDTH = 10
"""Face width, in modules, of a gear whose width is not given."""

_RADIUS_STEP = 0.01
_SLACK = 0.05
"""Distance beside the involute, in modules, at which a gauge still passes: root radii and tip chamfers are not known."""


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A gear that may have been measured, and how probable it is beside the others.

    `residuals` are readings less what the gear has, in units of their uncertainties; uncertainties are standard ones, mm and
    degrees, other ways to have made the gear considered. `chi_square` has as many degrees of freedom as there are readings.
    """

    gear: Gear
    fit: FittedHypothesis
    rack: StandardRack
    probability: float
    chi_square: float
    predicted: tuple[float, ...]
    residuals: tuple[float, ...]
    off_involute: tuple[Reading, ...]
    tools: tuple[str, ...] = ()
    """Names of the tools of the shelf that would leave the root diameter that was measured, the nearest first."""

    @property
    def series(self) -> str:
        """The series of its size: "ISO 54 I", "ISO 54 II", "DIN 780 I", "DIN 780 II", "DP", or "free" for none."""
        return self.fit.hypothesis.size.series

    @property
    def transverse(self) -> bool:
        """Whether the size is that of the transverse section, so that the normal module is of no series."""
        return self.fit.hypothesis.transverse

    @property
    def diametral_pitch(self) -> float | None:
        """Diametral pitch (1/inch) of the size; None if the size is a module."""
        return self.fit.hypothesis.size.pitch

    @property
    def module_uncertainty(self) -> float:
        """Standard uncertainty of the normal module (mm); 0 for a module of a series."""
        return self.fit.uncertainty(Unknown.MODULE)

    @property
    def helix_uncertainty(self) -> float:
        return self.fit.uncertainty(Unknown.HELIX_ANGLE)

    @property
    def shift_uncertainty(self) -> float:
        return self.fit.uncertainty(Unknown.SHIFT)

    @property
    def thinning_uncertainty(self) -> float:
        """Standard uncertainty of the normal tooth thinning (mm)."""
        return self.gear.tooth_thinning * self.fit.uncertainty(Unknown.THINNING)

    def to_dict(self) -> JsonObject:
        """Return the candidate as identify.json has it."""
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
            "tools": list(self.tools),
            "predicted": list(self.predicted),
            "residuals": list(self.residuals),
        }

    def tools_of(self, measured: Measured, shelf: Sequence[ToolRow]) -> tuple[str, ...]:
        """Return the names of the tools of a shelf that are of this size and reach as deep as the root that was measured.

        The root diameter d + 2 m_n (x - h_aP0) of each may differ from the reading by two uncertainties of the reading and of
        making together, with the profile shift of the candidate. Without that reading there are none.
        """
        read = measured.find(Gauge.ROOT_DIAMETER)
        if read is None:
            return ()
        gear, off = self.gear, dict[str, float]()
        may = _ROOT_OFF * math.hypot(read.uncertainty, 2 * gear.normal_module * _DEPTH)
        for row in shelf:
            with suppress(SpecError):  # a row with a fault is told where it is used
                if not _of_size(row.tool, gear):
                    continue
                tool = row.tool
                pre = tool.premachining
                reach = pre.addendum_of(gear.normal_module) if pre.present else tool.rack.dedendum
                root = gear.reference_diameter + 2 * gear.normal_module * (gear.profile_shift - reach)
                off.setdefault(tool.name, abs(abs(root) - read.value))
        return tuple(sorted((name for name, each in off.items() if each <= may), key=off.__getitem__))

    @classmethod
    def of(cls, measured: Measured, fit: FittedHypothesis, probability: float) -> Candidate | None:
        """Return the candidate of a fit, or None if no such gear can be made."""
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


_DEPTH = 0.005
"""Uncertainty of the depth to which teeth are cut, in normal modules."""

_ROOT_OFF = 2.0
"""Uncertainties by which the root of a tool may differ from the one that was measured."""


def _of_size(tool: ShelfTool, gear: Gear) -> bool:
    """Return whether a tool is of the module and pressure angle of a gear; rings are cut by cutters."""
    if gear.internal and not tool.kind.startswith("cutter"):
        return False
    return tool.fits(gear.normal_module) and abs(tool.rack.pressure_angle - gear.rack.pressure_angle) < _SAME_ANGLE


_SAME_ANGLE = 1e-9


def on_involute(gear: Gear, place: Reading) -> bool:
    """Return whether a gauge touches the flanks of a gear, or does not measure flanks at all."""
    try:
        diameter = touches(gear.inspection, place)
    except (InputError, SolverError):
        return False
    lowest, highest = sorted((abs(gear.form_diameter), abs(gear.tip_form_diameter)))
    slack = _SLACK * gear.normal_module
    return diameter is None or lowest - slack <= diameter <= highest + slack


def _gear(measured: Measured, fit: FittedHypothesis) -> Gear | None:
    """Return the gear of a fit, its numbers rounded, with the largest root radius up to its rack's that can be made."""
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


def variance(slopes: Floats, fit: FittedHypothesis) -> float:
    """Return the variance of a reading that a fit leaves open, for these derivatives (u,) of the reading."""
    return float(slopes @ fit.covariance @ slopes)


_CERTAIN = 0.95
"""Least probability of a candidate that is called certain."""

_WORN = 0.12
"""Tooth thinning, in modules, above that of new gears."""

_OFF = 2.0
"""Uncertainties that a reading is off and is told."""

_UNUSUAL = {
    Unknown.MODULE: "module",
    Unknown.PRESSURE_ANGLE: "pressure angle",
    Unknown.HELIX_ANGLE: "helix angle",
    Unknown.SHIFT: "profile shift",
    Unknown.ADDENDUM: "height of the tips",
    Unknown.DEDENDUM: "depth of the roots",
    Unknown.THINNING: "tooth thinning",
    Unknown.MATE_SHIFT: "profile shift of the mate",
}

_LEAST_FIT = 0.002
"""The least probability that a chi-square as great as the best would have by chance, of readings that fit."""


@dataclass(frozen=True, kw_only=True)
class Deciding:
    """A further measurement, the predicted value of each candidate, and how far apart the predictions are.

    With `less` it is two readings, of which the difference counts. `apart` is the distance of each other candidate from the
    first, in units of what a reading of `place.uncertainty` and the fits leave open.
    """

    place: Reading
    less: Reading | None
    predicted: tuple[float, ...]
    apart: tuple[float, ...]

    def to_dict(self) -> JsonObject:
        """Return the measurement as identify.json has it."""
        said, less = self.place.to_dict(), None if self.less is None else self.less.to_dict()
        for each in (said, less or {}):
            each.pop("value", None)
        return {**said, "less": less, "predicted": list(self.predicted), "apart": list(self.apart)}


@dataclass(frozen=True, kw_only=True)
class Identification(Pictured):
    """Candidates, the most probable first; what would decide between those that are left; and the chance of such residuals.

    Those that are `alike` have the flanks of the best under another name, and run in its place.
    """

    measured: Measured
    candidates: tuple[Candidate, ...]
    deciding: tuple[Deciding, ...]
    alike: tuple[Candidate, ...]
    chance: float

    def __repr__(self) -> str:
        gear, best = self.best.gear, self.best
        size = f"m_n {gear.normal_module:.5g}"
        if best.diametral_pitch is not None:
            size = f"DP {best.diametral_pitch:g}{' transverse' if best.transverse else ''}"
        turned = f", helix {gear.helix_angle:.4g} deg" if gear.helix_angle else ""
        angle = f"{gear.rack.pressure_angle:g} deg{turned}, x {gear.profile_shift:.3f}"
        sure = "certain" if self.certain else "not certain"
        return f"<Identification of z = {self.measured.teeth}: {size}, {angle}, {100 * best.probability:.1f} %, {sure}>"

    @property
    def best(self) -> Candidate:
        return self.candidates[0]

    @property
    def fits(self) -> bool:
        """Whether the residuals of the best are as their uncertainties permit."""
        return self.chance >= _LEAST_FIT

    @property
    def certain(self) -> bool:
        """Whether the best fits, every gauge touches its flanks, and all others together are improbable."""
        return self.fits and not self.best.off_involute and self.best.probability >= _CERTAIN

    @property
    def unlisted(self) -> float:
        """Probability that the gear is none of the candidates listed."""
        return max(1 - sum(each.probability for each in self.candidates), 0.0)

    @property
    def rivals(self) -> tuple[Candidate, ...]:
        """Candidates beside the best that are not excluded; none if the best is certain."""
        return () if self.certain else tuple(each for each in self.candidates[1:] if each.probability >= (1 - _CERTAIN) / 5)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices to be read before a gear is made by this result."""
        found = list(self.measured.notices)
        if not self.fits:
            found.append(Notice("no-fit", f"no candidate fits: {self._misfit}; count and measure again"))
        if (thinning := self.best.gear.tooth_thinning) > _WORN * self.best.gear.normal_module:
            text = f"the teeth of the first candidate are {thinning:.2g} mm thinner than without backlash: worn, perhaps"
            found.append(Notice("thin-teeth", f"{text}; a gear that is made again has less tooth_thinning"))
        for each in self.best.off_involute:
            text = f"the {self.measured.label(each)} would not touch the involute of the first candidate"
            found.append(Notice("off-involute", text))
        return tuple(found)

    @property
    def _misfit(self) -> str:
        """Text that names the misfit of the best candidate: the worst reading, or else a property that hardly any gear has."""
        worst = max(range(len(self.measured.readings)), key=lambda each: abs(self.best.residuals[each]))
        if abs(off := self.best.residuals[worst]) >= _OFF:
            return f"the {self.measured.label(self.measured.readings[worst])} is {off:+.1f} uncertainties off"
        unusual = " and ".join(_UNUSUAL[each] for each in self.best.fit.unusual)
        return f"the first has the readings, but with a {unusual} as hardly any gear has"

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return the content of identify.json."""
        return {
            "kind": "identify",
            "teeth": self.measured.teeth,
            "mate_teeth": self.measured.mate_teeth,
            "readings": [each.to_dict() for each in self.measured.readings],
            "certain": self.certain,
            "chance": self.chance,
            "unlisted": self.unlisted,
            "candidates": [each.to_dict() for each in self.candidates],
            "alike": [self.candidates.index(each) + 1 for each in self.alike],
            "deciding": [each.to_dict() for each in self.deciding],
            "warnings": list(self.warnings),
            "notices": [each.to_dict() for each in self.notices],
        }
