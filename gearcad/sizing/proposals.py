"""Proposals of a search: SizedPair with its full rating, and Sizing with all that came of the search.

Plane strain for spur gears, solid bodies for helical ones. Half as fine as a check, it is off by some percent, which is
enough to tell quiet pairs from others.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from gearcad.core.errors import GearcadError, InputError
from gearcad.core.quantities import inputs_document
from gearcad.core.records import JsonObject, PerGear, Pictured, Verdict
from gearcad.core.runtime import Agenda, Expected, Progress
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.pair_data import profile_shift_sum
from gearcad.material import Materials
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength import StrengthRating, rate_strength
from gearcad.sizing.rating import Rated
from gearcad.sizing.search import STEP, Heard, Survey, least_width, refined, survey
from gearcad.sizing.task import Criterion, SizeTask

Cloud: TypeAlias = np.ndarray[Any, np.dtype[np.float64]]
"""Masses (kg) and margins (2, n) of variants."""

_POSITIONS = 16
_CELLS = 40
_COARSER = 0.5


def transmission_error(pair: GearPair, material: Materials, torque: float) -> float:
    """Peak to peak (µm along the line of action) under a torque on the pinion (N·m, above 0).

    Raises SolverError, ParameterError and GeometryError.
    """
    from gearcad.contact.plane.pair import plane_pair
    from gearcad.contact.shared.loaded import EngagedPair
    from gearcad.contact.solid.pair import SolidSizes, solid_pair

    angles = EngagedPair(pair).roll_angles(_POSITIONS).tolist()
    if pair.pinion.helix_angle == 0:
        plane = plane_pair(pair, material)
        approaches = [plane.solve(angle, torque).approach for angle in angles]
    else:
        solid = solid_pair(pair, material, sizes=SolidSizes().refined(_COARSER), cells=_CELLS)
        approaches = [solid.solve(angle, torque).approach for angle in angles]
    return float(np.ptp(approaches)) * 1000


@dataclass(frozen=True, kw_only=True)
class SizedPair:
    """A pair by the values of its drawing, and the values of its ranking. Lengths in mm, helix angle in degrees, mass in kg.

    At `least_width`, unrounded, the least safety is just the one required, None where it was not sought; `margin` is the
    least of S_H/S_Hmin and S_F/S_Fmin.
    `ripple` is how much the lines of contact change in length, `temperature` the integral temperature (°C, None without one).
    `strength` is the full rating of the pair, and `transmission_error` (µm, peak to peak at the torque of the load) that of its
    flexible bodies, where they were worked out; `efficiency` that of the mesh, None without friction or where Ohlendorf's loss
    factor does not hold; `front` says that nothing among the best is both lighter and safer.
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
    efficiency: float | None = None

    @classmethod
    def of(cls, task: SizeTask, rated: Rated, *, narrowed: bool = True) -> SizedPair:
        """Return the sized pair of a variant, n = 1; its least width is sought unless `narrowed` is False."""
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
            efficiency=None if rated.efficiency is None or math.isnan(rated.efficiency[0]) else number(rated.efficiency),
        )

    @property
    def name(self) -> str:
        """Name such as 17-26-m3-h15."""
        return f"{self.teeth.pinion}-{self.teeth.wheel}-m{self.normal_module:g}-h{self.helix_angle:g}"

    @property
    def ratio(self) -> float:
        """Gear ratio u."""
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

    @property
    def mean_loss(self) -> float | None:
        """Power that the mesh loses (W); None without an efficiency or a speed."""
        load = self.task.load
        if self.efficiency is None or load.speed == 0:
            return None
        return (1 - self.efficiency) * load.torque * abs(load.speed) * math.pi / 30

    def pair(self) -> GearPair:
        """The pair, without backlash, its tips altered to keep the clearance of the rack. Raises GeometryError."""
        plain = self._pair(0.0)
        return self._pair(plain.tip_alteration) if plain.tip_alteration else plain

    def _pair(self, alteration: float) -> GearPair:
        shifts = PerGear(self.pinion_shift, self.shift_sum - self.pinion_shift)
        hands = PerGear(self.helix_angle, -self.helix_angle + 0.0)

        hob = self.task.hobs.get(self.normal_module)

        def gear(name: str, teeth: int, shift: float, helix: float) -> Gear:
            return Gear(
                name=name,
                teeth=teeth,
                normal_module=self.normal_module,
                face_width=self.face_width,
                helix_angle=helix,
                profile_shift=shift,
                tip_alteration=alteration,
                tool=hob,
                rack=self.task.rack if hob is None or hob.tool is None else hob.tool.rack,
            )

        gears = PerGear(*map(gear, PerGear._fields, self.teeth, shifts, hands))
        return GearPair(name=self.name, pinion=gears.pinion, wheel=gears.wheel, centre_distance=self.centre_distance)

    def to_dict(self) -> JsonObject:
        """Return the pair as a document for JSON."""
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
            **({} if self.task.friction is None else {"efficiency": self.efficiency, "mean_loss": self.mean_loss}),
        }


FRONT_SAMPLE = 50
"""Largest number of pairs of a front that go into a design table."""

_FIGURES = (
    "normal_module helix_angle face_width least_width centre_distance pinion_shift mass margin transverse_contact_ratio "
    "overlap_ratio ripple sliding temperature"
).split()


@dataclass(frozen=True, kw_only=True)
class Sizing(Pictured):
    """Proposals of a search: the best, a pair for each combination of teeth, module and helix angle; and what became of the
    rest.

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
    cloud: Cloud
    front: tuple[SizedPair, ...]
    strongest: SizedPair | None
    lightest: SizedPair | None

    def __repr__(self) -> str:
        best = f", best {self.found[0].name}" if self.found else ""
        return f"<Sizing: {len(self.found)} of {self.considered} variants{best}>"

    @property
    def best(self) -> SizedPair | None:
        """The first of `found`."""
        return self.found[0] if self.found else None

    @property
    def front_sample(self) -> tuple[SizedPair, ...]:
        """At most FRONT_SAMPLE pairs of the front, evenly spaced on it, the lightest and the safest among them."""
        number = len(self.front)
        places = dict.fromkeys(np.linspace(0, number - 1, min(number, FRONT_SAMPLE)).round().astype(int).tolist())
        return tuple(self.front[place] for place in places)

    @property
    def assumed(self) -> tuple[str, ...]:
        """Sentences on inputs that were not given and are used in the ratings of the pairs found, each once."""
        rated = (each.strength for each in self.found)
        return tuple(dict.fromkeys(text for strength in rated if strength is not None for text in strength.assumed))

    def to_dict(self) -> JsonObject:
        """Return the content of size.json."""
        task = self.task
        given = {name: getattr(task, name) for name in _OF_TASKS}
        return {
            "task": {
                **given,
                "criterion": task.criterion.value,
                "load": inputs_document(task.load),
                "materials": {role.value: inputs_document(material) for role, material in task.materials.items()},
                "rating": inputs_document(task.rating),
                "rack": asdict(task.rack),
                **({} if task.friction is None else {"friction": task.friction}),
                **({} if task.tool is None else {"tool": str(task.tool)}),
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
    """Return the reason why no proposal is judged against scuffing; None if all are."""
    if options.required_safety_scuffing is not None:
        return None
    lacking = ["required_safety_scuffing", *([] if options.scuffing_stage is not None else ["scuffing_stage"])]
    return f"scuffing not judged: {' and '.join(lacking)} not given"


_OF_RATED = ("least_width", "strength", "notices", "transmission_error")
"""Fields that only proposals have that were refined and rated in full."""

_OF_TASKS = (
    "ratio ratio_tolerance teeth modules helix_angles width_ratios shifts shift_sums centre_distance max_diameter max_mass "
    "max_width_in_modules least_contact_ratio least_tip_thickness"
).split()


REACH = 1.5
"""Largest mass, over that of the lightest pair, that a pair may have if another criterion than mass comes first."""

_REFINED, _LEAST_REFINED = 2, 40
"""Factor on the requested number of pairs that are kept, since not all may pass the full rating; and the least number kept."""

_VARIANTS_A_SECOND, _REFINEMENT_SECONDS, _ERROR_SECONDS = 4e5, 0.03, 2.0
_MEMORY = 4e8
"""Memory (bytes) of a sizing, numpy and scipy included."""

_REFINE, _ERROR = "refinement", "transmission error"


class PairsSoFar(NamedTuple):
    """The best pairs of a search that goes on, best first, and masses (kg) and margins (2, n) of the best of each combination.

    Pairs that are not `rated` in full may still become better ones, or go.
    """

    found: tuple[SizedPair, ...]
    cloud: Cloud
    rated: bool


HeardPairs = Callable[[Callable[[], PairsSoFar]], None]
"""Called now and then with a function that gives the best pairs so far, which costs something only when it is called."""


def search_pairs(
    task: SizeTask, *, count: int = 20, errors: int = 20, progress: Progress | None = None, heard: HeardPairs | None = None
) -> Sizing:
    """The best `count` pairs for a task, the first of them, as many as `errors`, with their transmission error.

    By Criterion.QUIET they are in the order of that in the end, of which the lines of contact know only half.

    All variants of the task are gone through, and the best refined; each that is shown is rated by `rate_strength`, and left
    out unless it passes that, too. `heard` is offered the best so far while that goes on.
    """
    most = max(_REFINED * count, _LEAST_REFINED)
    agenda = Agenda(progress, {STEP: _seconds(task), _REFINE: most * _REFINEMENT_SECONDS, _ERROR: errors * _ERROR_SECONDS})
    if task.criterion is not Criterion.MASS and task.max_mass is None:
        lightest = survey(replace(task, criterion=Criterion.MASS)).best
        if lightest is not None:
            task = replace(task, max_mass=float(f"{REACH * lightest.mass.min():.3g}"))
    offer = partial(_offer, heard, task, count)
    seen = survey(task, agenda, offer)
    unmade: list[str] = []
    found: list[SizedPair] = []
    cloud = _places(seen.best)
    for each in _judged(task, _refined(task, seen, most, agenda, partial(offer, cloud=cloud)), count, unmade):
        found.append(each)
        _offer_rated(heard, found, cloud)
    for number in range(min(errors, len(found))):
        agenda(_ERROR, number / errors, found[number].name)
        found[number] = _with_error(found[number])
        _offer_rated(heard, found, cloud)
    if task.criterion is Criterion.QUIET:
        found.sort(key=lambda each: math.inf if each.transmission_error is None else round(each.transmission_error, 2))
    return Sizing(
        task=task,
        found=tuple(found),
        considered=seen.considered,
        rated=seen.rated,
        removed=seen.removed,
        unmade=tuple(unmade),
        cloud=cloud,
        front=front_pairs(task, seen.front),
        strongest=None if seen.strongest is None else SizedPair.of(task, seen.strongest),
        lightest=None if seen.lightest is None else SizedPair.of(task, seen.lightest),
    )


def _offer(
    heard: HeardPairs | None, task: SizeTask, count: int, best: Callable[[], Rated | None], cloud: Cloud | None = None
) -> None:
    """Offer the first `count` of the best variants so far as pairs, with the cloud of all of them, or of those before."""
    if heard is None:
        return

    def pairs() -> PairsSoFar:
        rated = best()
        first = range(0 if rated is None else min(count, len(rated.order)))
        assert rated is not None or not first
        found = tuple(SizedPair.of(task, rated.picked([place]), narrowed=False) for place in first if rated is not None)
        return PairsSoFar(found, _places(rated) if cloud is None else cloud, rated=False)

    heard(pairs)


def _offer_rated(heard: HeardPairs | None, found: list[SizedPair], cloud: Cloud) -> None:
    """Offer pairs that are rated in full."""
    if heard is not None:
        heard(lambda: PairsSoFar(tuple(found), cloud, rated=True))


def expected(task: SizeTask, count: int, errors: int) -> Expected:
    """Return the expected time and memory of a search."""
    refinement = max(_REFINED * count, _LEAST_REFINED) * _REFINEMENT_SECONDS
    seconds = _seconds(task) + refinement + errors * _ERROR_SECONDS
    return Expected(seconds, _MEMORY, f"{task.variants:,} variants".replace(",", "\N{NO-BREAK SPACE}"))


def _seconds(task: SizeTask) -> float:
    return task.variants / _VARIANTS_A_SECOND


def _refined(task: SizeTask, seen: Survey, most: int, agenda: Agenda, heard: Heard) -> Rated | None:
    """The best combinations after refinement, best first."""
    if seen.best is None:
        return None
    return refined(task, seen.best, most, lambda part: agenda(_REFINE, part), heard)


def _judged(task: SizeTask, best: Rated | None, count: int, unmade: list[str]) -> Iterator[SizedPair]:
    """The first `count` that can be made and pass the full rating; `unmade` hears why others do not."""
    passed = 0
    for place in range(0 if best is None else len(best.order)):
        assert best is not None
        if passed == count:
            return
        sized = SizedPair.of(task, best.picked(np.array([place])))
        try:
            judged = _rated(sized)
        except InputError as error:
            unmade.append(f"{sized.name}: {error}")
            continue
        if judged.strength is not None and judged.strength.strength is not Verdict.PASSED:
            unmade.append(f"{sized.name}: {judged.strength.verdict}")
            continue
        passed += 1
        yield replace(judged, front=_on_front(best, place))


def _rated(sized: SizedPair) -> SizedPair:
    """Return a pair with its full rating. Raises InputError for a pair that cannot be made."""
    task = sized.task
    return replace(sized, strength=rate_strength(sized.pair(), task.materials, task.load, task.rating))


def _on_front(rated: Rated, place: int) -> bool:
    """Return whether a pair is on the front: no other is both lighter and safer, or as good in one and better in the other."""
    mass, margin = rated.mass, rated.margin
    better = (mass <= mass[place]) & (margin >= margin[place])
    return not bool(np.any(better & ((mass < mass[place]) | (margin > margin[place]))))


def _with_error(sized: SizedPair) -> SizedPair:
    """Return a pair with its transmission error, or unchanged if the error cannot be computed."""
    task = sized.task
    try:
        error = transmission_error(sized.pair(), task.materials, task.load.torque)
    except GearcadError:  # such as thin rims or gears of two elasticities: the line stays without
        return sized
    return replace(sized, transmission_error=error)


def _places(rated: Rated | None) -> Cloud:
    """Masses and margins (2, n)."""
    return np.zeros((2, 0)) if rated is None else np.array([rated.mass, rated.margin])
