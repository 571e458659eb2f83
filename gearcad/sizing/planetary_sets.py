"""Planetary sets for a task: tooth numbers for the ratio, then module and face width for the required safeties."""

from __future__ import annotations

import math
from bisect import insort
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated, Any, NamedTuple

import numpy as np

from gearcad.core.errors import InputError, ParameterError, SolverError
from gearcad.core.quantities import AssumedNumber, Range, Whole, Words, require_fields
from gearcad.core.records import JsonObject, Notice, Verdict, concise
from gearcad.core.runtime import Agenda, Expected, Progress
from gearcad.dynamics.planetary.planar_model import MemberMass, TrainMasses
from gearcad.dynamics.planetary.planetary_strength import PUBLISHED, PublishedFactor, TrainStrength, rate_train
from gearcad.geometry import Body, Gear
from gearcad.geometry.gear_parts import ISO_54_I
from gearcad.material import Material
from gearcad.planetary import Central, PlanetaryTrain, TrainLoad
from gearcad.planetary.members import old_torque_notice, torque_key
from gearcad.planetary.power import mesh_loads, power_flow
from gearcad.planetary.search import PlanetarySet, search
from gearcad.planetary.tooth_numbers import SearchTask
from gearcad.rating.material_limits import EnduranceLimits, endurance_limits
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength import RatedPart
from gearcad.sizing.proposals import unjudged_scuffing

_TORQUE = Range("N·m", 1e-6, 1e9)


@dataclass(frozen=True, kw_only=True)
class SetSizeTask:
    """Task of a set: `sets` has the ratio and what its teeth may be, in modules of 1 mm; the torque (N·m) is
    `input_torque` or `output_torque`, and `speed` (rpm) is that of the input. `torque` is the old name of `input_torque`.

    All gears are of one `material`, rings of `ring_material` if there is one. K_gamma is that of rules for the number of
    planets (ABS), unless `mesh_load_factor` is given. Face widths are at most `width_ratio` times the diameter of the smallest
    gear, `max_diameter` is the most over all teeth. Of the sets that the search finds the first `considered` are sized.
    Raises ParameterError.
    """

    sets: SearchTask
    input_torque: Annotated[float | None, _TORQUE, Words("torque on the input", "T")] = None
    output_torque: Annotated[float | None, _TORQUE, Words("torque on the output", "T")] = None
    torque: Annotated[float | None, _TORQUE, Words("torque on the input, old name", "T")] = None
    speed: Annotated[float, Range("rpm", 1e-3, 1e6), Words("speed of the input", "n")]
    material: Material
    ring_material: Material | None = None
    application_factor: Annotated[float, Range("", 0.1, 10.0), Words("application factor", "K_A", "ISO 6336-1")] = (
        AssumedNumber(1.0)
    )
    mesh_load_factor: Annotated[float | None, Range("", 1.0, 24.0), Words("mesh load factor", "K_γ", "ISO 6336-1")] = None
    rating: RatingOptions = field(default=RatingOptions())
    modules: tuple[float, ...] = (0.5, 0.6, 0.8, *ISO_54_I)
    max_diameter: Annotated[float | None, Range("mm", 1.0, 1e5), Words("most diameter over all teeth")] = None
    considered: Annotated[int, Whole(1, 10_000), Words("tooth numbers that are sized roughly")] = 120
    width_ratio: Annotated[float, Range("", 0.1, 3.0), Words("most face width over the smallest diameter", "b/d")] = 1.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        torque_key(self)
        if not self.modules or any(not 0.05 <= each <= 100 for each in self.modules):
            raise ParameterError("modules", list(self.modules), "must be numbers from 0.05 to 100 mm", "mm")
        object.__setattr__(self, "modules", tuple(sorted(set(self.modules))))
        for name, material in (("material", self.material), ("ring_material", self.ring_material or self.material)):
            limits = _limits(name, material)
            for limit, value in (("contact_endurance_limit", limits.contact), ("root_endurance_limit", limits.root)):
                if value is None:
                    permitted = 'must be given, in MPa, or a material of ISO 6336-5 such as "Eh MQ": nothing can be sized'
                    raise ParameterError(f"{name}.{limit}", None, permitted)

    @property
    def given_torque(self) -> tuple[str, float]:
        """The key of the load that a set has, and its torque (N·m)."""
        key = torque_key(self)
        value: float = getattr(self, key)
        return "input_torque" if key == "torque" else key, value

    @property
    def torque_words(self) -> str:
        """The torque and where it acts, in words."""
        key, value = self.given_torque
        return f"{value:g} N·m on the {key.removesuffix('_torque')}"

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notice that the torque is given under its old name; none otherwise."""
        return () if self.torque is None else (old_torque_notice("input_torque"),)

    def material_of(self, name: str) -> Material:
        """Return the material of a gear, by its name."""
        return (self.ring_material or self.material) if name.startswith("ring") else self.material

    def factor(self, planets: int) -> float:
        """Return K_gamma for a number of planets."""
        if self.mesh_load_factor is not None:
            return min(self.mesh_load_factor, float(planets))
        found = PUBLISHED[0].of(planets)
        return min((found or PublishedFactor(source="", factor=1.0, recalled=False)).factor, float(planets))


def _limits(name: str, material: Material) -> EnduranceLimits:
    """Return the endurance limits. Errors begin with the name of the field. Raises ParameterError."""
    try:
        return endurance_limits(material)
    except ParameterError as error:
        raise ParameterError(error.parameter.replace("material", name, 1), error.value, error.permitted, error.unit) from error


@dataclass(frozen=True, kw_only=True)
class SizedSet:
    """A set with its module and face width, made: the `train`, its `load`, and what it bears."""

    candidate: PlanetarySet
    train: PlanetaryTrain
    load: TrainLoad
    materials: dict[str, Material]
    strength: TrainStrength
    mass: float

    @property
    def name(self) -> str:
        """Name such as A-24-21-66-n3-m2-b30."""
        return self.train.name

    @cached_property
    def margins(self) -> dict[RatedPart, float]:
        """The least safety of flanks and of roots over what is required."""
        options = self.strength.options
        required = {RatedPart.FLANK: options.required_safety_flank, RatedPart.ROOT: options.required_safety_root}
        return {part: least / required[part] for part, least in self.least.items()}

    @cached_property
    def least(self) -> dict[RatedPart, float]:
        """The least safety of all flanks, and of all roots."""
        found = {}
        for part in RatedPart:
            known = [gear.least(part) for gear in self.strength.members.values()]
            found[part] = min((each.safety for each in known if each is not None), default=0.0)
        return found

    @property
    def bears(self) -> float:
        """Permissible torque over the load's torque, approximately: flank stress grows with the square root of torque."""
        return min(self.margins[RatedPart.FLANK] ** 2, self.margins[RatedPart.ROOT])

    @property
    def holds(self) -> bool:
        """Whether all parts were judged and have the required safety."""
        return self.strength.strength is Verdict.PASSED

    def to_dict(self) -> JsonObject:
        """Return the set as a document for JSON: mm, kg."""
        return {
            **self.candidate.to_dict(),
            "name": self.name,
            "module": self.candidate.task.module,
            "face_width": self.candidate.task.width,
            "mass": self.mass,
            "safety": {part.value: value for part, value in self.least.items()},
            "members": {name: gear.to_dict() for name, gear in self.strength.members.items()},
            "K_gamma": self.load.mesh_load_factor,
            "notices": [notice.to_dict() for notice in self.strength.notices],
        }


@dataclass(frozen=True, kw_only=True)
class SizedSets:
    """The lightest sets that hold, lightest first; `considered` are tooth numbers that were sized roughly, `refused` those that
    none of the modules lets hold, or that cannot be made."""

    task: SetSizeTask
    found: tuple[SizedSet, ...]
    considered: int
    refined: int
    refused: dict[str, str]

    @property
    def assumed(self) -> tuple[str, ...]:
        """Sentences on inputs that were not given and are used in the ratings of the sets found, each once."""
        return tuple(dict.fromkeys(text for each in self.found for text in each.strength.assumed))

    def to_dict(self) -> JsonObject:
        """Return the sets as a document for JSON."""
        return {
            "kind": "planetary sizes",
            "ratio": self.task.sets.ratio,
            "torque": self.task.given_torque[1],
            "torque_of": self.task.given_torque[0].removesuffix("_torque"),
            "speed": self.task.speed,
            "found": [each.to_dict() for each in self.found],
            "assumed": list(self.assumed),
            "not_judged": {} if (why := unjudged_scuffing(self.task.rating)) is None else {"scuffing": why},
            "considered": self.considered,
            "refined": self.refined,
            "refused": dict(self.refused),
        }


REFINED, MORE = 2, 10
"""Numbers of sets that are given a module and a width: so many times the requested number, plus some more."""

MARGIN = 0.7
"""The finest module that is tried, over the one that should do with the most width."""

RING_RIM = 3.5
"""Rim of a ring outside its roots, in modules: as good as a solid one (Y_B = 1)."""

LEAST_WIDTH = 5.0
"""Least face width in modules."""

_ROUGH, _SIZED = "tooth numbers", "sizes"
_ROUGH_SECONDS, _SIZED_SECONDS = 0.035, 0.37
_MEMORY = 4e8
"""Seconds of each set in both steps; bytes, numpy and scipy included."""

_FINE_WIDTH = 20.0
"""Face width (mm) up to which it goes by half millimetres."""


def size_sets(
    task: SetSizeTask,
    count: int = 20,
    progress: Progress | None = None,
    heard: Callable[[Sequence[SizedSet]], None] | None = None,
) -> SizedSets:
    """Return the `count` lightest sets that bear the task. Raises SolverError where none does.

    `heard` is called with the sets found so far, lightest first, each time that there is another one.
    """
    result = search(task.sets, task.considered)
    agenda = Agenda(progress, _seconds(len(result.found), count))
    rough: list[_Rough] = []
    refused: dict[str, str] = {}
    for place, candidate in enumerate(result.found):
        try:
            rough.append(_rough(task, candidate))
        except InputError as error:
            refused[candidate.name] = str(error)
        agenda(_ROUGH, (place + 1) / len(result.found))
    rough.sort(key=lambda each: (round(each.mass, 9), each.candidate.name))
    refined = rough[: REFINED * count + MORE]
    found: list[SizedSet] = []
    for place, each in enumerate(refined):
        sized = _sized(task, each)
        if sized is None:
            refused[each.candidate.name] = "no module and width within the limits let it hold"
        else:
            insort(found, sized, key=_by_mass)
            if heard is not None:
                heard(found[:count])
        agenda(_SIZED, (place + 1) / len(refined), each.candidate.name)
    if not found:
        raise SolverError(_nothing(task, len(result.found), refused))
    return SizedSets(task=task, found=tuple(found[:count]), considered=len(result.found), refined=len(refined), refused=refused)


def _by_mass(sized: SizedSet) -> tuple[float, str]:
    return round(sized.mass, 9), sized.name


def expected(task: SetSizeTask, count: int) -> Expected:
    """Return the expected time and memory of a search, at the most: it may find fewer tooth numbers."""
    steps = _seconds(task.considered, count)
    return Expected(sum(steps.values()), _MEMORY, f"up to {task.considered} sets of tooth numbers")


def _seconds(sets: int, count: int) -> dict[str, float]:
    """Seconds of each step."""
    return {_ROUGH: sets * _ROUGH_SECONDS, _SIZED: min(REFINED * count + MORE, sets) * _SIZED_SECONDS}


def _nothing(task: SetSizeTask, considered: int, refused: dict[str, str]) -> str:
    if not considered:
        return f"no set has ratio {task.sets.ratio:g} within {task.sets.tolerance:g} %, as its teeth are wanted"
    name, why = next(iter(refused.items()))
    return f"none of {considered} sets holds; {name}: {why}"


# ---------------------------------------------------------------------- one set


def made(task: SetSizeTask, candidate: PlanetarySet, module: float, width: float) -> SizedSet:
    """Return a set of a module and a face width (mm), rated. Raises InputError if it cannot be made."""
    own = replace(
        candidate,
        task=replace(candidate.task, module=module, face_width=width, tip_distance=None, diameter=None),
        centre_distance=candidate.centre_distance * module / candidate.task.module,
        diameter=candidate.diameter * module / candidate.task.module,
    )
    train = _train(own, f"{candidate.name}-m{module:g}-b{width:g}")
    key, torque = task.given_torque
    load = TrainLoad(
        **{key: torque},
        speed=task.speed,
        application_factor=task.application_factor,
        mesh_load_factor=task.factor(candidate.planets),
    )
    materials = {name: task.material_of(name) for name in train.gears}
    sections = {name: _section(gear, materials[name].density) for name, gear in train.gears.items()}
    loads = mesh_loads(train, power_flow(train, load))
    rating = rate_train(train, loads, {}, _masses(train, sections), materials, task.rating)
    return SizedSet(
        candidate=own,
        train=train,
        load=load,
        materials=materials,
        strength=rating.strength,
        mass=sum(each.mass * (candidate.planets if name in _rims(train) else 1) for name, each in sections.items()),
    )


def _train(candidate: PlanetarySet, name: str) -> PlanetaryTrain:
    """Return the train of a candidate, its rings with a rim that is as good as a solid one."""
    train = candidate.train()

    def ring(central: Central) -> Central:
        if not central.gear.internal:
            return central
        outside = abs(central.gear.root_diameter) + 2 * RING_RIM * central.gear.normal_module
        return replace(central, gear=replace(central.gear, body=Body(rim_diameter=float(math.ceil(outside)))))

    return replace(train, name=name, centrals=tuple(ring(each) for each in train.centrals))


def _rims(train: PlanetaryTrain) -> tuple[str, ...]:
    return tuple(rim.name for rim in train.rims)


class _Section(NamedTuple):
    """Mass (kg) and moment of inertia (kg·m²) of a gear."""

    mass: float
    inertia: float


def _section(gear: Gear, density: float) -> _Section:
    """Return mass and moment of inertia of a gear, from the outline of its teeth; the bores are left out.

    The outline is integrated about the axis: ∫ r^2/2 and ∫ r^4/4 over the angle.
    """
    outline = gear.profile.points(gear.normal_module / 100)
    radius, angle = np.hypot(*outline.T), np.unwrap(np.arctan2(outline[:, 1], outline[:, 0]))
    area, polar = (abs(float(np.trapezoid(radius**power / power, angle))) * gear.tooth_count for power in (2, 4))
    if gear.internal:
        outside = (gear.body.rim_diameter or 0.0) / 2
        area, polar = math.pi * outside**2 - area, math.pi / 2 * outside**4 - polar
    weight = density * gear.face_width * 1e-9
    return _Section(area * weight, polar * weight * 1e-6)


def _masses(train: PlanetaryTrain, sections: dict[str, _Section]) -> TrainMasses:
    """Return the masses of a train that K_v depends on."""
    rims = [sections[name] for name in _rims(train)]
    planet = MemberMass(mass=sum(each.mass for each in rims), inertia=sum(each.inertia for each in rims))
    members = {each.name: MemberMass(**sections[each.name]._asdict()) for each in train.centrals}
    return TrainMasses(members=members, planet=planet)


# ---------------------------------------------------------------------- module and width


class _Rough(NamedTuple):
    """A set, the mass (kg) that it has, about, where it just holds, and the module (mm) that does with the most width."""

    mass: float
    module: float
    candidate: PlanetarySet


def _rough(task: SetSizeTask, candidate: PlanetarySet) -> _Rough:
    """Return a rough size of a set, from one of its sizes.

    Mass, and the torque that it bears, grow with the cube of the module, and with the width.
    """
    module = min(task.modules, key=lambda each: abs(each - 2.0))
    sized = made(task, candidate, module, _widest(task, candidate, module) / 2)
    if not sized.bears:
        return _Rough(math.inf, module, candidate)
    return _Rough(sized.mass / sized.bears, module * (2 * sized.bears) ** (-1 / 3), candidate)


def _sized(task: SetSizeTask, rough: _Rough) -> SizedSet | None:
    """Return the lightest of all modules with the least width that holds; None where none does."""
    best: SizedSet | None = None
    candidate = rough.candidate
    for module in task.modules:
        widest = _widest(task, candidate, module)
        if module < MARGIN * rough.module and module != task.modules[-1]:
            continue
        if task.max_diameter is not None and candidate.diameter * module / candidate.task.module > task.max_diameter:
            break
        found = _narrowest(task, candidate, module, widest)
        if found is None:
            continue
        if best is not None and found.mass >= best.mass:
            break  # coarser ones are heavier still: the least width that holds falls by less than the area grows
        best = found
    return best


def _widest(task: SetSizeTask, candidate: PlanetarySet, module: float) -> float:
    """Return the most face width (mm), on its grid."""
    teeth = min(abs(each) for each in candidate.teeth.values())
    return max(_on_grid(task.width_ratio * teeth * module, math.floor), LEAST_WIDTH * module)


def _on_grid(width: float, rounded: Any) -> float:
    step = 0.5 if width < _FINE_WIDTH else 1.0
    return float(rounded(width / step) * step)


def _narrowest(task: SetSizeTask, candidate: PlanetarySet, module: float, widest: float) -> SizedSet | None:
    """Return the least width that holds; None if the most does not."""
    found = made(task, candidate, module, widest)
    if not found.holds:
        return None
    low, high = _on_grid(LEAST_WIDTH * module, math.ceil), widest
    width = _on_grid(high / found.bears, math.ceil)
    while low < high:
        width = min(max(width, low), high - (0.5 if high <= _FINE_WIDTH else 1.0))
        tried = made(task, candidate, module, width)
        if tried.holds:
            found, high = tried, width
            width = _on_grid(width / tried.bears, math.ceil)
        else:
            low = width + (0.5 if width < _FINE_WIDTH else 1.0)
            width = _on_grid(width / tried.bears if 0 < tried.bears < 1 else low, math.ceil)
    return found
