"""SizedPair: one pair that a search proposes; Sizing: all that came of the search."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from gearcad.geometry import Gear, GearPair
from gearcad.geometry.shift import profile_shift_sum
from gearcad.per_gear import PerGear
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength import StrengthRating
from gearcad.reprs import Pictured
from gearcad.sizing.rated import Rated
from gearcad.sizing.refine import least_width
from gearcad.sizing.task import SizeTask

__all__ = ["FRONT_SAMPLE", "SizedPair", "Sizing", "front_pairs", "unjudged_scuffing"]


@dataclass(frozen=True, kw_only=True)
class SizedPair:
    """A pair by what one writes on a drawing, and what it is ranked by. Lengths in mm, helix angle in degrees, mass in kg.

    At `least_width`, unrounded, the least safety is just the one required, None where it was not sought; `margin` is the
    least of S_H/S_Hmin and S_F/S_Fmin.
    `ripple` is how much the lines of contact change in length, `temperature` the integral temperature (°C, None without one).
    `strength` is the full rating of the pair, and `transmission_error` (µm, peak to peak at the torque of the load) that of its
    flexible bodies, where they were worked out; `front` says that nothing among the best is both lighter and safer.
    """

    task: SizeTask
    teeth: PerGear[int]
    normal_module: float
    helix_angle: float
    face_width: float
    least_width: float | None
    centre_distance: float
    pinion_shift: float
    mass: float
    margin: float
    transverse_contact_ratio: float
    overlap_ratio: float
    ripple: float
    sliding: float
    temperature: float | None
    flank_safeties: PerGear[float]
    root_safeties: PerGear[float]
    front: bool = False
    strength: StrengthRating | None = None
    transmission_error: float | None = None

    @classmethod
    def of(cls, task: SizeTask, rated: Rated, *, narrowed: bool = True) -> SizedPair:
        """That of a variant, n = 1; its least width is sought unless it is not `narrowed`."""
        pairs, temperature = rated.pairs, float(rated.temperature[0])

        def number(values: Any) -> float:
            return float(values[0])

        return cls(
            task=task,
            teeth=PerGear(*(round(number(each)) for each in pairs.teeth)),
            normal_module=number(pairs.normal_module),
            helix_angle=number(pairs.helix_angle),
            face_width=number(rated.width),
            least_width=least_width(task, rated) if narrowed else None,
            centre_distance=number(pairs.centre_distance),
            pinion_shift=number(pairs.shifts.pinion),
            mass=number(rated.mass),
            margin=number(rated.margin),
            transverse_contact_ratio=number(pairs.contact_ratio),
            overlap_ratio=number(rated.overlap_ratio),
            ripple=number(rated.ripple),
            sliding=number(rated.sliding),
            temperature=None if math.isnan(temperature) else temperature,
            flank_safeties=PerGear(*map(number, rated.flank_safeties)),
            root_safeties=PerGear(*map(number, rated.root_safeties)),
        )

    @property
    def name(self) -> str:
        """Such as 17-26-m3-h15."""
        return f"{self.teeth.pinion}-{self.teeth.wheel}-m{self.normal_module:g}-h{self.helix_angle:g}"

    @property
    def ratio(self) -> float:
        """u."""
        return self.teeth.wheel / self.teeth.pinion

    @property
    def shift_sum(self) -> float:
        """x_1 + x_2 that meshes without backlash at the centre distance."""
        return profile_shift_sum(
            normal_module=self.normal_module,
            teeth=self.teeth,
            helix_angle=self.helix_angle,
            pressure_angle=self.task.rack.pressure_angle,
            centre_distance=self.centre_distance,
        )

    def pair(self) -> GearPair:
        """The pair, without backlash, its tips altered to keep the clearance of the rack. Raises GeometryError."""
        plain = self._pair(0.0)
        return self._pair(plain.tip_alteration) if plain.tip_alteration else plain

    def _pair(self, alteration: float) -> GearPair:
        shifts = PerGear(self.pinion_shift, self.shift_sum - self.pinion_shift)
        hands = PerGear(self.helix_angle, -self.helix_angle + 0.0)

        def gear(name: str, teeth: int, shift: float, helix: float) -> Gear:
            return Gear(
                name=name,
                teeth=teeth,
                normal_module=self.normal_module,
                face_width=self.face_width,
                helix_angle=helix,
                profile_shift=shift,
                tip_alteration=alteration,
                rack=self.task.rack,
            )

        gears = PerGear(*map(gear, PerGear._fields, self.teeth, shifts, hands))
        return GearPair(name=self.name, pinion=gears.pinion, wheel=gears.wheel, centre_distance=self.centre_distance)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        given = {each: getattr(self, each) for each in _FIGURES}
        pairs = {each: getattr(self, each)._asdict() for each in ("teeth", "flank_safeties", "root_safeties")}
        judged = None if self.strength is None else self.strength.strength.value
        return {
            "name": self.name,
            **pairs,
            "ratio": self.ratio,
            **given,
            "shift_sum": self.shift_sum,
            "strength": judged,
            "notices": [] if self.strength is None else [notice.to_dict() for notice in self.strength.notices],
            "transmission_error": self.transmission_error,
            "front": self.front,
        }


FRONT_SAMPLE = 50
"""Most pairs of a front that go into a design table."""

_FIGURES = (
    "normal_module helix_angle face_width least_width centre_distance pinion_shift mass margin transverse_contact_ratio "
    "overlap_ratio ripple sliding temperature"
).split()


@dataclass(frozen=True, kw_only=True)
class Sizing(Pictured):
    """What a search found: the best, a pair for each combination of teeth, module and helix angle; and what became of the rest.

    Of `considered` variants `removed` has how many each condition took, in the order in which it was asked; `rated` were rated.
    `unmade` says of good ones why they cannot be made. `cloud` has masses (kg) and margins (2, n) of the best of each
    combination; `front` are the variants that none is both lighter and safer than, lightest first, before refinement and the
    full rating. `strongest` is the safest that was rated, `lightest` the lightest that is safe, whatever mass is permitted.
    """

    task: SizeTask
    found: tuple[SizedPair, ...]
    considered: int
    rated: int
    removed: dict[str, int]
    unmade: tuple[str, ...]
    cloud: np.ndarray[Any, np.dtype[np.float64]]
    front: tuple[SizedPair, ...]
    strongest: SizedPair | None
    lightest: SizedPair | None

    def __repr__(self) -> str:
        best = f", best {self.found[0].name}" if self.found else ""
        return f"<Sizing: {len(self.found)} of {self.considered} variants{best}>"

    @property
    def best(self) -> SizedPair | None:
        """The first."""
        return self.found[0] if self.found else None

    @property
    def front_sample(self) -> tuple[SizedPair, ...]:
        """At most FRONT_SAMPLE of the front, evenly by their places on it, the lightest and the safest among them."""
        number = len(self.front)
        places = dict.fromkeys(np.linspace(0, number - 1, min(number, FRONT_SAMPLE)).round().astype(int).tolist())
        return tuple(self.front[place] for place in places)

    @property
    def assumed(self) -> tuple[str, ...]:
        """What was not given and goes into the rating of what was found, in words."""
        rated = (each.strength for each in self.found)
        return tuple(dict.fromkeys(text for strength in rated if strength is not None for text in strength.assumed))

    def to_dict(self) -> dict[str, Any]:
        """What size.json holds."""
        task = self.task
        given = {name: getattr(task, name) for name in _OF_TASKS}
        return {
            "task": {
                **given,
                "criterion": task.criterion.value,
                "load": asdict(task.load),
                "materials": {role.value: asdict(material) for role, material in task.materials.items()},
                "rating": asdict(task.rating),
                "rack": asdict(task.rack),
            },
            "found": [each.to_dict() for each in self.found],
            "considered": self.considered,
            "rated": self.rated,
            "removed": self.removed,
            "unmade": list(self.unmade),
            "strongest": None if self.strongest is None else self.strongest.to_dict(),
            "lightest": None if self.lightest is None else self.lightest.to_dict(),
            "assumed": list(self.assumed),
            "not_judged": {} if (why := unjudged_scuffing(task.rating)) is None else {"scuffing": why},
            "front": [{name: value for name, value in each.to_dict().items() if name not in _OF_RATED} for each in self.front],
        }


def front_pairs(task: SizeTask, rated: Rated | None) -> tuple[SizedPair, ...]:
    """Variants as pairs, lightest first."""
    if rated is None:
        return ()
    order = np.lexsort((rated.margin, rated.mass))
    return tuple(replace(SizedPair.of(task, rated.picked([place]), narrowed=False), front=True) for place in order)


def unjudged_scuffing(options: RatingOptions) -> str | None:
    """Why no proposal is judged against scuffing; None where all are."""
    if options.required_safety_scuffing is not None:
        return None
    lacking = ["required_safety_scuffing", *([] if options.scuffing_stage is not None else ["scuffing_stage"])]
    return f"scuffing not judged: {' and '.join(lacking)} not given"


_OF_RATED = ("least_width", "strength", "notices", "transmission_error")
"""What only those have that were refined and rated in full."""

_OF_TASKS = (
    "ratio ratio_tolerance teeth modules helix_angles width_ratios shifts shift_sums centre_distance max_diameter max_mass "
    "max_width_in_modules least_contact_ratio least_tip_thickness"
).split()
