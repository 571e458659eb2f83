"""Planetary sets for a task: tooth numbers for the ratio, then module and face width for the safeties that are asked for."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from gearcad.dynamics.planetary.masses import MemberMass, TrainMasses
from gearcad.dynamics.planetary.mesh_rating import rate_train
from gearcad.errors import InputError, SolverError
from gearcad.geometry import Body, Gear
from gearcad.planetary import Central, PlanetaryTrain, TrainLoad
from gearcad.planetary.mesh_loads import mesh_loads
from gearcad.planetary.power import power_flow
from gearcad.planetary.search import Candidate, search
from gearcad.progress import Agenda, Expected, Progress
from gearcad.sizing.set_task import SetSizeTask
from gearcad.sizing.sized_set import SizedSet, SizedSets

__all__ = ["expected", "size_sets"]

REFINED, MORE = 2, 10
"""Of these, as many times the sets that are asked for, and some more, are given a module and a width."""

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


def size_sets(task: SetSizeTask, count: int = 20, progress: Progress | None = None) -> SizedSets:
    """The `count` lightest sets that bear the task. Raises SolverError where none does."""
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
            found.append(sized)
        agenda(_SIZED, (place + 1) / len(refined), each.candidate.name)
    if not found:
        raise SolverError(_nothing(task, len(result.found), refused))
    found.sort(key=lambda each: (round(each.mass, 9), each.name))
    return SizedSets(task=task, found=tuple(found[:count]), considered=len(result.found), refined=len(refined), refused=refused)


def expected(task: SetSizeTask, count: int) -> Expected:
    """What that takes at the most: the search may find fewer tooth numbers."""
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


def made(task: SetSizeTask, candidate: Candidate, module: float, width: float) -> SizedSet:
    """A set of a module and a face width (mm), rated. Raises InputError where it cannot be made."""
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


def _train(candidate: Candidate, name: str) -> PlanetaryTrain:
    """That of a candidate, its rings with a rim that is as good as a solid one."""
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
    """By the outline of its teeth, integrated about the axis: ∫ r^2/2 and ∫ r^4/4 over the angle; the bores are left out."""
    outline = gear.profile.points(gear.normal_module / 100)
    radius, angle = np.hypot(*outline.T), np.unwrap(np.arctan2(outline[:, 1], outline[:, 0]))
    area, polar = (abs(float(np.trapezoid(radius**power / power, angle))) * gear.tooth_count for power in (2, 4))
    if gear.internal:
        outside = (gear.body.rim_diameter or 0.0) / 2
        area, polar = math.pi * outside**2 - area, math.pi / 2 * outside**4 - polar
    weight = density * gear.face_width * 1e-9
    return _Section(area * weight, polar * weight * 1e-6)


def _masses(train: PlanetaryTrain, sections: dict[str, _Section]) -> TrainMasses:
    """Those that K_v goes by."""
    rims = [sections[name] for name in _rims(train)]
    planet = MemberMass(mass=sum(each.mass for each in rims), inertia=sum(each.inertia for each in rims))
    members = {each.name: MemberMass(**sections[each.name]._asdict()) for each in train.centrals}
    return TrainMasses(members=members, planet=planet)


# ---------------------------------------------------------------------- module and width


class _Rough(NamedTuple):
    """A set, the mass (kg) that it has, about, where it just holds, and the module (mm) that does with the most width."""

    mass: float
    module: float
    candidate: Candidate


def _rough(task: SetSizeTask, candidate: Candidate) -> _Rough:
    """By one of its sizes: mass, and the torque that it bears, grow with the cube of the module, and with the width."""
    module = min(task.modules, key=lambda each: abs(each - 2.0))
    sized = made(task, candidate, module, _widest(task, candidate, module) / 2)
    if not sized.bears:
        return _Rough(math.inf, module, candidate)
    return _Rough(sized.mass / sized.bears, module * (2 * sized.bears) ** (-1 / 3), candidate)


def _sized(task: SetSizeTask, rough: _Rough) -> SizedSet | None:
    """The lightest of all modules with the least width that holds; None where none does."""
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


def _widest(task: SetSizeTask, candidate: Candidate, module: float) -> float:
    """The most face width (mm), on its grid."""
    teeth = min(abs(each) for each in candidate.teeth.values())
    return max(_on_grid(task.width_ratio * teeth * module, math.floor), LEAST_WIDTH * module)


def _on_grid(width: float, rounded: Any) -> float:
    step = 0.5 if width < _FINE_WIDTH else 1.0
    return float(rounded(width / step) * step)


def _narrowest(task: SetSizeTask, candidate: Candidate, module: float, widest: float) -> SizedSet | None:
    """The least width that holds; None if the most does not."""
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
