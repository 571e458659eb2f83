"""What a study of the dynamics looks at: the [dynamics] table of a spec."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from gearcad.errors import (
    GeometryError,
    ParameterError,
    as_choice,
    plain_numbers,
    require_number,
    require_one_of,
    require_whole,
)
from gearcad.geometry import GearPair
from gearcad.per_gear import PerGear
from gearcad.ranges import DAMPING, DURATION, INERTIA, SAMPLING, SPEED, STIFFNESS
from gearcad.rating.options import RatingOptions
from gearcad.reprs import concise

__all__ = ["DynamicsOptions", "PairModel"]

_CHART, _CAMPBELL = 1000, 41
"""Speeds where none are given."""

_RANGES = {
    "speed_from": SPEED._replace(least=0.0, signed=False),
    "speed_to": SPEED._replace(signed=False),
    "pinion_inertia": INERTIA,
    "wheel_inertia": INERTIA,
    "pinion_bearing_stiffness": STIFFNESS,
    "wheel_bearing_stiffness": STIFFNESS,
    "bearing_damping": DAMPING,
    "tooth_stiffness": STIFFNESS,
    "tooth_damping": DAMPING,
    "duration": DURATION,
    "sampling": SAMPLING,
}

_SWITCH = {"on": True, "off": False}

AUTO = "auto"


def _require_method(name: str) -> None:
    """Raise ParameterError unless a name is that of a stiffness method that knows the course over the mesh."""
    from gearcad.stiffness.methods import METHODS  # only here: a spec without such a name is read without the methods

    permitted = (AUTO, *(each for each, method in METHODS.items() if not method.mean_only))
    if name not in permitted:
        raise ParameterError("stiffness", name, f"must be one of {', '.join(permitted)}")


class PairModel(Enum):
    """What a pair's teeth are to its dynamics."""

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
    `seed`.

    Of pairs: the `model`, "mesh" or "contact". `stiffness` is the method of `gearcad stiffness` for a mesh; "auto" is plane
    strain for spur gears, whose teeth come into mesh by and by under load, and potential energy for helical ones.
    `damping_ratio` is that of the pair alone, `pinion_inertia` and `wheel_inertia` are in kg·m² (None: of their own solids).
    With `pinion_bearing_stiffness` and `wheel_bearing_stiffness` (N/µm across the axis) and a `bearing_damping` (N·s/m) the
    gears travel as well as turn: six degrees of freedom.

    Of the contact model: `tooth_stiffness` (N/µm) of one pair of teeth (None: mean mesh stiffness over the contact ratio),
    `tooth_damping` (N·s/m; None: by the damping ratio); each speed runs for `duration` (s), sampled at `sampling` (Hz).
    """

    speed_from: float | None = None
    speed_to: float | None = None
    speeds: int | None = None
    harmonics: int | None = None
    frequencies: int = 8
    accuracy_grade: int | None = None
    tooth_errors: str = "off"
    seed: int = 0
    model: str = PairModel.MESH.value
    stiffness: str = AUTO
    damping_ratio: float = 0.07
    pinion_inertia: float | None = None
    wheel_inertia: float | None = None
    pinion_bearing_stiffness: float | None = None
    wheel_bearing_stiffness: float | None = None
    bearing_damping: float = 0.0
    tooth_stiffness: float | None = None
    tooth_damping: float | None = None
    duration: float = 1.0
    sampling: float = 200_000.0

    __repr__ = concise

    def __post_init__(self) -> None:
        plain_numbers(self)
        if self.speeds is not None:
            require_whole("speeds", self.speeds, at_least=2, at_most=20_000)
        if self.harmonics is not None:
            require_whole("harmonics", self.harmonics, at_least=1, at_most=1000)
        require_whole("frequencies", self.frequencies, at_least=1, at_most=200)
        require_whole("seed", self.seed, at_least=0, at_most=2**32 - 1)
        if self.accuracy_grade is not None:
            require_whole("accuracy_grade", self.accuracy_grade, at_least=0, at_most=12)
        require_one_of("tooth_errors", self.tooth_errors, _SWITCH)
        as_choice("model", self.model, PairModel)
        if self.stiffness != AUTO:
            _require_method(self.stiffness)
        require_number("damping_ratio", self.damping_ratio, above=0, below=1)
        for name, permitted_range in _RANGES.items():
            if (value := getattr(self, name)) is not None:
                permitted_range.require(name, value)
        given = [(role, each) for role, each in self.bearing_stiffness.items() if each is not None]
        if len(given) == 1:
            (role, stiffness), permitted = given[0], "must be given together with that of the other gear: both stand on "
            raise GeometryError(f"{role.value}_bearing_stiffness", stiffness, permitted + "bearings, or neither", "N/µm")
        if self.speed_from is not None and self.speed_to is not None and self.speed_to <= self.speed_from:
            raise GeometryError("speed_to", self.speed_to, f"must be above speed_from, {self.speed_from:g} rpm", "rpm")
        if self.duration * self.sampling > 5e7:
            permitted = f"must be at most {5e7 / self.sampling:g} s at this sampling: 50 million samples a speed"
            raise ParameterError("duration", self.duration, permitted, "s")

    @property
    def inertias(self) -> PerGear[float | None]:
        """Of both gears (kg·m²), None for those of their own solids."""
        return PerGear(self.pinion_inertia, self.wheel_inertia)

    @property
    def bearing_stiffness(self) -> PerGear[float | None]:
        """Of both gears (N/µm), None where they turn on rigid axes."""
        return PerGear(self.pinion_bearing_stiffness, self.wheel_bearing_stiffness)

    @property
    def chart_speeds(self) -> int:
        """Of a chart of K_v."""
        return self.speeds or _CHART

    @property
    def slowest(self) -> float:
        """Part of its highest speed at which a chart begins, if nothing is said of it: few speeds asked for hide none."""
        return 1 / max(self.chart_speeds, _CHART)

    @property
    def campbell_speeds(self) -> int:
        """Of a Campbell study."""
        return self.speeds or _CAMPBELL

    def graded(self, rating: RatingOptions) -> DynamicsOptions:
        """With the accuracy grade of a rating, where there is none."""
        return self if self.accuracy_grade is not None else replace(self, accuracy_grade=rating.accuracy_grade)

    @property
    def errors(self) -> bool:
        """Whether teeth have deviations."""
        return _SWITCH[self.tooth_errors]

    def method_for(self, pair: GearPair) -> str:
        """Name of the method for a pair's mesh stiffness."""
        if self.stiffness != AUTO:
            return self.stiffness
        return "potential-energy" if pair.pinion.helix_angle else "plane-strain"

    @property
    def pair_model(self) -> PairModel:
        """The model as an enum."""
        return PairModel(self.model)
