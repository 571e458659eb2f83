"""Options of dynamics: the [dynamics] table of a spec, and notices of options without effect."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from typing import Annotated, NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.quantities import (
    DAMPING,
    DURATION,
    INERTIA,
    SAMPLING,
    SPEED,
    STIFFNESS,
    AssumedNumber,
    Choice,
    Member,
    Range,
    Whole,
    Words,
    require_fields,
)
from gearcad.core.records import Bools, Floats, JsonObject, Notice, PerGear, concise
from gearcad.dynamics.time_domain.contact_model import EngagedPairs
from gearcad.dynamics.time_domain.transient_result import TransientOptions
from gearcad.dynamics.trains.tooth_deviations import ErrorDistribution
from gearcad.geometry import GearPair, RackPair
from gearcad.rating.options import RatingOptions

_CHART, _CAMPBELL, _DRAWN = 1000, 41, 200
"""Numbers of speeds where none are given: of the chart, of the Campbell diagram and of drawn curves."""

_MOST_CAMPBELL = 101
"""Speeds at which the motion of a mesh is integrated: a chart has more."""

OF_PAIRS = "of pairs"
"""Marks what a train has in its own parts, or has no use for."""

OF_TRAINS_OF_PAIRS = "of trains of pairs"
"""Marks what of that a train has use for whose meshes are those of pairs."""

_MASS = Range("kg", 1e-12, 1e12)
_SPEED = SPEED._replace(signed=False)

_SWITCH = {"on": True, "off": False}

_UNIFORM = ErrorDistribution.UNIFORM.value

AUTO = "auto"


def _require_method(name: str) -> None:
    """Raise ParameterError unless a name is that of a stiffness method that knows the course over the mesh."""
    from gearcad.stiffness.methods import METHODS  # only here: a spec without such a name is read without the methods

    permitted = (AUTO, *(each for each, method in METHODS.items() if not method.mean_only))
    if name not in permitted:
        raise ParameterError("stiffness", name, f"must be one of {', '.join(permitted)}")


class PairModel(Enum):
    """Model of a pair's teeth in its dynamics."""

    MESH = "mesh"
    """One spring whose stiffness varies over the mesh, with backlash."""

    CONTACT = "contact"
    """A spring for each pair of teeth in the zone of contact (Uhlir's thesis)."""


@dataclass(frozen=True, kw_only=True)
class DynamicsOptions:
    """Options of a study of the dynamics. Raises ParameterError and GeometryError.

    Of trains and pairs: chart over `speeds` speeds of the (first) pinion (None: 1000, or 41 of a contact model) from
    `speed_from` to `speed_to` (rpm; None: up to half as much again as its last resonance), and as many between them as
    its maxima need; with at most so many `harmonics` of the tooth frequency (None: as many as leave out less than a hundredth
    of the load); `frequencies` natural frequencies of a train; `accuracy_grade` (ISO 1328-1; None: that of the rating) is
    that of K_v by ISO 6336-1 and, with `tooth_errors` "on", of random pitch deviations of the pinions' teeth, drawn with
    `seed` by an `error_distribution`, "uniform" or "normal". With `error_samples` or `premature_engagement` "on" errors are
    drawn so often, for both gears, in a study of their own in time, over `speeds` speeds (None: 200): K_v as it lies over many
    gears. Premature engagement: each pair of teeth is a spring by itself, and carries where bent teeth reach each other.

    The machine runs under load from `operating_from` to `operating_to` (rpm of the first pinion, or of a planetary train's
    input; None: from the first speed of the chart up to the load's own, or else to the last of the chart): its greatest load
    there is told first. Of trains with several models side by side, a model is enough if its loads agree there within
    `level_tolerance` (part of the load at rest).

    With `transient` the train runs in time as well, with a speed or torques that change. With `campbell` "on" its motion is
    integrated at 41 speeds of the chart (or so many as `speeds`, up to 101), each for `duration` (s) after it has settled,
    sampled at `sampling` (Hz), for the spectra of a Campbell diagram; the contact model always has one.

    Of pairs: the `model`, "mesh" or "contact". `stiffness` is the method of `gearcad stiffness` for a mesh; "auto" is plane
    strain for spur gears, whose teeth come into mesh by and by under load, and potential energy for helical ones, strain energy
    where one of these is a ring.
    `damping_ratio` is that of the pair alone; both are also those of the pairs of a train, whose meshes may have damping of
    their own. `pinion_inertia` and `wheel_inertia` are in kg·m² (None: of their own solids). Of a pinion and a rack `rack_mass`
    (kg) is that of the rack and of all that moves with it (None: of the rack's own solid).
    With `pinion_bearing_stiffness` and `wheel_bearing_stiffness` (N/µm across the axis) and a `bearing_damping` (N·s/m) the
    gears travel as well as turn: six degrees of freedom.

    Of the contact model: `tooth_stiffness` (N/µm) of one pair of teeth (None: mean mesh stiffness over the contact ratio),
    `tooth_damping` (N·s/m; None: by the damping ratio); `zone` says which pairs carry: those between "rigid tips", between
    "penetrating tips", or always "one pair", the simple model. Each speed runs for `duration` (s), sampled at `sampling` (Hz).
    """

    speed_from: Annotated[float | None, _SPEED._replace(least=0.0), Words("least speed of the chart", "n_1")] = None
    speed_to: Annotated[float | None, _SPEED, Words("greatest speed of the chart", "n_1")] = None
    speeds: Annotated[int | None, Whole(2, 20_000), Words("speeds of the chart")] = None
    harmonics: Annotated[int | None, Whole(1, 1000), Words("harmonics of the tooth frequency")] = None
    frequencies: Annotated[int, Whole(1, 200), Words("natural frequencies of a train")] = 8
    accuracy_grade: Annotated[int | None, Whole(0, 12), Words("accuracy grade", "", "ISO 1328-1")] = None
    tooth_errors: Annotated[str, Choice(tuple(_SWITCH)), Words("whether teeth have deviations")] = "off"
    seed: Annotated[int, Whole(0, 2**32 - 1), Words("seed of the deviations")] = 0
    operating_from: Annotated[float | None, _SPEED._replace(least=0.0), Words("least operating speed", "n_1")] = None
    operating_to: Annotated[float | None, _SPEED, Words("greatest operating speed", "n_1")] = None
    level_tolerance: Annotated[float, Range("", 1e-4, 1.0), Words("how far models may differ, in parts of the load")] = 0.05
    error_distribution: Annotated[str, Member(ErrorDistribution), Words("distribution of the deviations")] = _UNIFORM
    error_samples: Annotated[int, Whole(1, 10_000), Words("samples of the deviations")] = 1
    premature_engagement: Annotated[str, Choice(tuple(_SWITCH)), Words("whether teeth may meet before their path")] = "off"
    model: Annotated[str, Member(PairModel), Words("what the teeth are: mesh or contact"), OF_PAIRS] = PairModel.MESH.value
    stiffness: Annotated[str, Words("method of the mesh stiffness"), OF_PAIRS, OF_TRAINS_OF_PAIRS] = AUTO
    damping_ratio: Annotated[
        float, Range("", 0.0, 1.0, ends="()"), Words("damping ratio of the pair", "ζ"), OF_PAIRS, OF_TRAINS_OF_PAIRS
    ] = AssumedNumber(0.07)
    pinion_inertia: Annotated[float | None, INERTIA, Words("inertia of the pinion", "J_1"), OF_PAIRS] = None
    wheel_inertia: Annotated[float | None, INERTIA, Words("inertia of the wheel", "J_2"), OF_PAIRS] = None
    rack_mass: Annotated[float | None, _MASS, Words("mass that moves with a rack", "m_2"), OF_PAIRS] = None
    pinion_bearing_stiffness: Annotated[float | None, STIFFNESS, Words("stiffness of the pinion's bearings"), OF_PAIRS] = None
    wheel_bearing_stiffness: Annotated[float | None, STIFFNESS, Words("stiffness of the wheel's bearings"), OF_PAIRS] = None
    bearing_damping: Annotated[float, DAMPING, Words("damping of the bearings"), OF_PAIRS] = 0.0
    tooth_stiffness: Annotated[float | None, STIFFNESS, Words("stiffness of one pair of teeth"), OF_PAIRS] = None
    tooth_damping: Annotated[float | None, DAMPING, Words("damping of one pair of teeth"), OF_PAIRS] = None
    zone: Annotated[str, Member(EngagedPairs), Words("which pairs of teeth carry"), OF_PAIRS] = EngagedPairs.RIGID_TIPS.value
    transient: TransientOptions | None = None
    campbell: Annotated[str, Choice(tuple(_SWITCH)), Words("whether spectra over speed are integrated")] = "off"
    duration: Annotated[float, DURATION, Words("time that each speed runs")] = 1.0
    sampling: Annotated[float, SAMPLING, Words("samples of each speed per second")] = 200_000.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        if self.stiffness != AUTO:
            _require_method(self.stiffness)
        given = [(role, each) for role, each in self.bearing_stiffness.items() if each is not None]
        if len(given) == 1:
            (role, stiffness), permitted = given[0], "must be given together with that of the other gear: both stand on "
            raise GeometryError(f"{role.value}_bearing_stiffness", stiffness, permitted + "bearings, or neither", "N/µm")
        if self.transient is not None and self.pair_model is PairModel.CONTACT:
            permitted = 'must be "mesh" beside [dynamics.transient]: springs between single teeth run at even speeds'
            raise GeometryError("model", self.model, permitted)
        if self.speed_from is not None and self.speed_to is not None and self.speed_to <= self.speed_from:
            raise GeometryError("speed_to", self.speed_to, f"must be above speed_from, {self.speed_from:g} rpm", "rpm")
        if self.operating_from is not None and self.operating_to is not None and self.operating_to <= self.operating_from:
            permitted = f"must be above operating_from, {self.operating_from:g} rpm"
            raise GeometryError("operating_to", self.operating_to, permitted, "rpm")
        if self.error_samples > 1 and not self.errors:
            permitted = 'must be 1 unless tooth_errors is "on": teeth without errors are all alike'
            raise ParameterError("error_samples", self.error_samples, permitted)
        if self.distribution is not ErrorDistribution.UNIFORM and not self.errors:
            permitted = f'must be left at {_UNIFORM} unless tooth_errors is "on": there are no deviations to be drawn'
            raise ParameterError("error_distribution", self.error_distribution, permitted)
        if self.duration * self.sampling > 5e7:
            permitted = f"must be at most {5e7 / self.sampling:g} s at this sampling: 50 million samples a speed"
            raise ParameterError("duration", self.duration, permitted, "s")

    @property
    def inertias(self) -> PerGear[float | None]:
        """Moments of inertia of both gears (kg·m²); None for that of the gear's own solid."""
        return PerGear(self.pinion_inertia, self.wheel_inertia)

    @property
    def bearing_stiffness(self) -> PerGear[float | None]:
        """Bearing stiffness of both gears (N/µm); None for gears on rigid axes."""
        return PerGear(self.pinion_bearing_stiffness, self.wheel_bearing_stiffness)

    @property
    def chart_speeds(self) -> int:
        """Number of speeds with which a chart of K_v begins."""
        return self.speeds or _CHART

    @property
    def slowest(self) -> float:
        """Part of its highest speed at which a chart begins without `speed_from`; a small number of speeds
        does not raise it.
        """
        return 1 / max(self.chart_speeds, _CHART)

    @property
    def campbell_speeds(self) -> int:
        """Number of speeds of a Campbell study."""
        return self.speeds or _CAMPBELL

    @property
    def spectra(self) -> bool:
        """Whether the motion of a mesh is integrated over speed."""
        return _SWITCH[self.campbell]

    @property
    def mesh_campbell_speeds(self) -> int:
        """Number of speeds at which the motion of a mesh is integrated; it is limited, because a chart may have thousands."""
        return min(self.campbell_speeds, _MOST_CAMPBELL)

    def graded(self, rating: RatingOptions) -> DynamicsOptions:
        """Return the options with the accuracy grade of a rating if they have none."""
        return self if self.accuracy_grade is not None else replace(self, accuracy_grade=rating.accuracy_grade)

    @property
    def errors(self) -> bool:
        """Whether teeth have deviations."""
        return _SWITCH[self.tooth_errors]

    @property
    def premature(self) -> bool:
        """Whether each pair of teeth is a spring by itself, and may meet before its path of contact begins."""
        return _SWITCH[self.premature_engagement]

    @property
    def drawn(self) -> bool:
        """Whether errors of teeth have a study of their own, in time; else they are part of the excitation of the charts."""
        return self.premature or self.error_samples > 1

    @property
    def distribution(self) -> ErrorDistribution:
        """Distribution of the deviations as an enum."""
        return ErrorDistribution(self.error_distribution)

    @property
    def error_speeds(self) -> int:
        """Number of speeds for which tooth errors are drawn."""
        return self.speeds or _DRAWN

    def method_for(self, pair: GearPair | RackPair) -> str:
        """Return the name of the method for a pair's mesh stiffness. Raises GeometryError for helical racks."""
        if self.stiffness != AUTO:
            return self.stiffness
        if not pair.pinion.helix_angle:
            return "plane-strain"
        if isinstance(pair, RackPair):
            permitted = "must be 0 for a rack: no method knows the stiffness of helical racks over the mesh"
            raise GeometryError("pair.helix_angle", pair.pinion.helix_angle, permitted, "deg")
        return "strain-energy" if pair.internal else "potential-energy"

    @property
    def pair_model(self) -> PairModel:
        """The model as an enum."""
        return PairModel(self.model)

    @property
    def engaged_pairs(self) -> EngagedPairs:
        """The zone as an enum."""
        return EngagedPairs(self.zone)


_OF_LEVELS = ("level_tolerance",)
_OF_CHARTS = ("operating_from", "operating_to")
_OF_CONTACT = (
    "tooth_errors",
    "error_distribution",
    "error_samples",
    "premature_engagement",
    "harmonics",
    "accuracy_grade",
    "seed",
)
_OF_BEARINGS = ("pinion_bearing_stiffness", "wheel_bearing_stiffness", "bearing_damping")


def idle_without_levels(options: DynamicsOptions) -> tuple[Notice, ...]:
    """Return a notice of options for several models of a train, which have no effect on one model or a pair."""
    return _idle(options, _OF_LEVELS, "a train with a list of models, held against each other")


def idle_in_contact(options: DynamicsOptions) -> tuple[Notice, ...]:
    """Return notices of options without effect in the contact model: those of the model "mesh" and of several models."""
    found = _idle(options, (*_OF_CONTACT, *_OF_CHARTS, *_OF_BEARINGS), f'the model "{PairModel.MESH.value}" of a pair')
    return (*found, *idle_without_levels(options))


def _idle(options: DynamicsOptions, keys: tuple[str, ...], subject: str) -> tuple[Notice, ...]:
    """Return a notice of those `keys` that are not at their default but have no effect; `subject` says what they are for."""
    default = DynamicsOptions()
    given = [key for key in keys if getattr(options, key) != getattr(default, key)]
    if not given:
        return ()
    verb = "is" if len(given) == 1 else "are"
    return (Notice("option-without-effect", f"without effect here: {', '.join(given)}, which {verb} for {subject}"),)


def undamped_bearings(options: DynamicsOptions) -> tuple[Notice, ...]:
    """Return a notice if gears are on bearings and only the teeth damp them."""
    if options.pinion_bearing_stiffness is None or options.bearing_damping:
        return ()
    text = (
        "the bearings are undamped: resonances of gears that travel are as sharp as the damping of the teeth leaves them, and "
        "there may be speeds at which no steady motion lasts; bearing_damping (N·s/m) damps them"
    )
    return (Notice("undamped-bearings", text),)


_ROUNDING = 1e-9
"""Relative difference of speeds below which they count as equal."""


class RangeSource(Enum):
    """Source of the operating range."""

    GIVEN = "operating range"
    SPEED = "speed of the train"
    CHART = "whole chart"


class OperatingRange(NamedTuple):
    """Operating range from `first` to `last` (rpm of the first pinion, or of a planetary train's input), and its `source`."""

    first: float
    last: float
    source: RangeSource

    @property
    def words(self) -> str:
        """The range and its source in words, for use in a sentence."""
        given = {
            RangeSource.GIVEN: "the operating range",
            RangeSource.SPEED: "up to the speed of the train",
            RangeSource.CHART: "the whole chart, for no operating range is given",
        }
        return f"from {self.first:.5g} to {self.last:.5g} rpm ({given[self.source]})"

    @property
    def heading(self) -> str:
        """The range as part of a line on the screen; "" for the whole chart."""
        return "" if self.source is RangeSource.CHART else f"from {self.first:.5g} to {self.last:.5g} rpm "

    def rows(self, speeds: Floats) -> Bools:
        """Return whether (s,) each of the speeds (s,) lies in the range."""
        return np.asarray((speeds >= self.first * (1 - _ROUNDING)) & (speeds <= self.last * (1 + _ROUNDING)), bool)

    def within(self, speeds: Floats) -> OperatingRange:
        """Return the range, or the whole chart of rising `speeds` (s,) where none of these lies in it."""
        if self.rows(speeds).any():
            return self
        return OperatingRange(float(speeds[0]), float(speeds[-1]), RangeSource.CHART)

    def to_dict(self) -> JsonObject:
        """Return the entry of the range in `dynamics.json`."""
        return {**self._asdict(), "source": self.source.value}


def operating_range(speed: float, options: DynamicsOptions, chart: tuple[float, float]) -> OperatingRange:
    """Return the operating range of the options; else from the first speed of the chart up to `speed`, or to the chart's last.

    `speed` (rpm) is that of the load, 0 if it is not known. Raises GeometryError if the range would end before it begins.
    """
    first, last, own = options.operating_from, options.operating_to, abs(speed)
    given = first is not None or last is not None
    end = last if last is not None else own or chart[1]
    if first is not None and first >= end:
        what = "operating_to" if last is not None else "the speed of the train" if own else "the last speed of the chart"
        raise GeometryError("operating_from", first, f"must be below {what}, {end:.5g} rpm", "rpm")
    source = RangeSource.GIVEN if given else RangeSource.SPEED if own else RangeSource.CHART
    begin = first if first is not None else chart[0] if chart[0] < end else 0.0
    return OperatingRange(begin, end, source)
