"""Wear of a pair as it goes: Archard's law on our own pressures and sliding, step by step, and the worn pair under load."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from gearcad.check.plastic import contact_ratio_under_load
from gearcad.check.run import plane_model
from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import PlanePair
from gearcad.contact.plane.wear import CycleWear, WearGrid, cycle_wear, flank_grids, worn_pair
from gearcad.core.errors import GeometryError, ParameterError, SolverError, require_whole
from gearcad.core.quantities import Range, inputs_document
from gearcad.core.records import Floats, JsonObject, Notice, PerGear, Role, texts
from gearcad.core.runtime import Agenda, Progress
from gearcad.geometry import RackPair
from gearcad.material import Material, materials_document

_SPANS = 60
"""Spans of the splines along a flank."""

_MOST_STEPS = 400

_SWING = 0.05
"""Share of the root stress by which a state may stand off the mean of those before and after it."""

_TOLD = 121
"""Places along a flank at which a profile is told."""

_PER_METRE = 1e-3
"""mm² per N of a wear coefficient of 1 mm³/(N·m)."""


@dataclass(frozen=True, kw_only=True)
class WearOptions:
    """The greatest depth (µm) up to which a flank is worn, None for 0.1 m_n, in so many steps; positions over a base pitch."""

    loss: float | None = None
    steps: int = 50
    positions: int = 30

    def __post_init__(self) -> None:
        if self.loss is not None:
            Range("µm", 0.01, 1e4).require("loss", self.loss)
        require_whole("steps", self.steps, at_least=2, at_most=_MOST_STEPS // 4)
        require_whole("positions", self.positions, at_least=12, at_most=400)

    def loss_of(self, task: CheckTask) -> float:
        """Return the depth (µm) at which the wear ends."""
        return 100 * task.pair.pinion.normal_module if self.loss is None else self.loss


@dataclass(frozen=True, kw_only=True)
class WornState:
    """The pair after so many load cycles of a tooth of the pinion.

    `worn` are the coefficients (n,) in mm of the splines of both flanks; `depth` (µm) is the greatest, `mean_depth` (µm) that
    of the involute; `volume` (mm³) is what one flank has lost, `work` (N·m) force times sliding of one pair of flanks so far.
    `cycle` is the pair under load as it is now; stresses in MPa, transmission error peak to peak in µm.
    """

    cycles: float
    worn: PerGear[Floats]
    depth: PerGear[float]
    mean_depth: PerGear[float]
    volume: PerGear[float]
    work: float
    cycle: PlaneCycle = field(repr=False)

    @property
    def transmission_error(self) -> float:
        """Transmission error, peak to peak (µm)."""
        return float(np.ptp(self.cycle.values("transmission_error")))

    @property
    def root_stresses(self) -> PerGear[float]:
        """Greatest root tension of both gears (MPa)."""
        return PerGear.each(lambda role: float(self.cycle.worst_position(role).tension.pick(role).stress))

    @cached_property
    def contact_ratio(self) -> float:
        """Mean number of pairs of teeth that touch."""
        return contact_ratio_under_load(self.cycle)

    def to_dict(self) -> JsonObject:
        """Return the state as wear.json has it."""
        return {
            "cycles": self.cycles,
            "depth": _gears(self.depth),
            "mean_depth": _gears(self.mean_depth),
            "volume": _gears(self.volume),
            "work": self.work,
            "transmission_error_peak_to_peak": self.transmission_error,
            "contact_ratio_under_load": self.contact_ratio,
            "root_stress": _gears(self.root_stresses),
            "roll_angle": self.cycle.values("roll_angle").tolist(),
            "transmission_error": self.cycle.values("transmission_error").tolist(),
            "places": [[contact.place for contact in position.contacts] for position in self.cycle.positions],
            "load_share": [[contact.share for contact in position.contacts] for position in self.cycle.positions],
        }


@dataclass(frozen=True, kw_only=True)
class WearResult:
    """The wear of a pair up to a loss (µm): its states step by step, the first without wear; `life` in hours.

    `coefficients` are k_w (mm³/(N·m)), 0 of a gear that does not wear. `asked_cycles` are those of [rating], None without;
    `guideline` has W_m (µm) of VDI 2736-2 after these, of each gear for which it is known.
    """

    task: CheckTask
    options: WearOptions
    coefficients: PerGear[float]
    grids: PerGear[WearGrid]
    states: tuple[WornState, ...]
    asked_cycles: float | None
    guideline: dict[str, float]
    notices: tuple[Notice, ...]

    def __repr__(self) -> str:
        return f"<WearResult of {self.task.pair.name!r}: {self.loss:g} µm after {self.states[-1].cycles:.4g} load cycles>"

    @property
    def name(self) -> str:
        """Name of the pair."""
        return self.task.pair.name

    @property
    def loss(self) -> float:
        """Depth (µm) at which the wear ends."""
        return self.options.loss_of(self.task)

    @property
    def life_cycles(self) -> float:
        """Load cycles of a tooth of the pinion until the loss."""
        return self.states[-1].cycles

    @property
    def life(self) -> float | None:
        """Hours until the loss; None at rest."""
        speed = abs(self.task.load.speed)
        return self.life_cycles / (60 * speed) if speed else None

    def depth_at(self, cycles: float) -> PerGear[float] | None:
        """Return the greatest depths (µm) after so many load cycles of the pinion, between the states; None beyond them."""
        if cycles > self.life_cycles:
            return None
        known = [each.cycles for each in self.states]
        return PerGear.each(lambda role: float(np.interp(cycles, known, [each.depth.pick(role) for each in self.states])))

    @property
    def conclusion(self) -> str:
        """The life in one line."""
        hours = "" if self.life is None else f", {self.life:.4g} h"
        worn = " and ".join(role.value for role, each in self.coefficients.items() if each)
        return f"{self.name}: {self.loss:g} µm of wear ({worn}) after {self.life_cycles:.4g} load cycles of the pinion{hours}"

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def profile(self, state: WornState, role: Role) -> tuple[Floats, Floats]:
        """Return roll lengths (n,) in mm of a flank, and its depth (n,) in µm in a state."""
        grid = self.grids.pick(role)
        lengths = np.linspace(grid.first, grid.last, _TOLD)
        return lengths, 1000 * (grid.values(lengths) @ state.worn.pick(role))

    def to_dict(self) -> JsonObject:
        """Return the content of wear.json without its kind and name."""
        at_asked = None if self.asked_cycles is None else self.depth_at(self.asked_cycles)
        profiles = []
        for state in self.states:
            told: JsonObject = {"cycles": state.cycles}
            for role in Role:
                lengths, depth = self.profile(state, role)
                told[role.value] = {"roll_length": lengths.tolist(), "depth": depth.tolist()}
            profiles.append(told)
        return {
            "load": inputs_document(self.task.load),
            **materials_document(self.task.material),
            "wear_coefficient": _gears(self.coefficients),
            "loss": self.loss,
            "life": {"cycles": self.life_cycles, "hours": self.life},
            "asked": None if at_asked is None else {"cycles": self.asked_cycles, "depth": _gears(at_asked)},
            "guideline": self.guideline,
            "states": [state.to_dict() for state in self.states],
            "profiles": profiles,
            "notices": [notice.to_dict() for notice in self.notices],
            "warnings": list(self.warnings),
        }


def _gears(values: PerGear[float]) -> dict[str, float]:
    return {role.value: value for role, value in values.items()}


def wear_pair(task: CheckTask, options: WearOptions | None = None, progress: Progress | None = None) -> WearResult:
    """Return the wear of two external gears in the plane model, up to a loss. Raises ParameterError without wear coefficients.

    After each step the pair is pressed again with the flanks that are left, and loses by the new pressures. A step takes the
    mean of what the pair loses at its beginning and at its end (Heun), so its error goes with the square of its size.
    """
    options = options or WearOptions()
    if isinstance(task.pair, RackPair) or task.pair.internal or task.pair.pinion.helix_angle:
        raise GeometryError("pair", task.pair.name, "must be of two external spur gears for wear")
    coefficients = wear_coefficients(task)
    tell = Agenda(progress, {"wear": 1.0}).counted("wear", "step")
    model = plane_model(task)
    grids = flank_grids(model, _SPANS)
    run = _Run(task, options, model, grids, coefficients)
    states = [run.state(0.0, grids.map(lambda grid: np.zeros(grid.spans + 3)), 0.0)]
    loss = options.loss_of(task)
    for _ in range(_MOST_STEPS):
        tell(min(int(options.steps * max(states[-1].depth) / loss), options.steps - 1), options.steps)
        states.append(run.stepped(states[-1], loss / options.steps, loss))
        if max(states[-1].depth) >= loss * (1 - 1e-9):
            break
    else:
        raise SolverError(f"the loss of {loss:g} µm is not reached in {_MOST_STEPS} steps")
    rated = task.strength_rating
    asked = rated.flank.pinion.cycles
    return WearResult(
        task=task,
        options=options,
        coefficients=coefficients,
        grids=grids,
        states=tuple(states),
        asked_cycles=asked,
        guideline=_guideline(task),
        notices=(*_notices(task), *_swings(states)),
    )


def wear_coefficients(task: CheckTask) -> PerGear[float]:
    """Return k_w (mm³/(N·m)) of both gears: of the spec, or of the table of a plastic; 0 where it is not known.

    Raises ParameterError if neither is.
    """
    plastic = task.strength_rating.plastic

    def of(role: Role) -> float:
        material: Material = task.materials.pick(role)
        if material.wear_coefficient is not None:
            return material.wear_coefficient
        if plastic is None or not material.plastic:
            return 0.0
        found = plastic.reading(role, "wear_coefficient", None if plastic.temperatures is None else plastic.temperatures.flank)
        return found.value or 0.0

    found = PerGear.each(of)
    if not any(found):
        permitted = "must be given for one gear at least, in mm³/(N·m), or in a table of its material"
        raise ParameterError("material.wear_coefficient", None, permitted)
    return found


def _guideline(task: CheckTask) -> dict[str, float]:
    """Return W_m (µm) of VDI 2736-2 after the load cycles of [rating]."""
    plastic = task.strength_rating.plastic
    if plastic is None:
        return {}
    worn = {role.value: plastic.wear(role).value for role in Role}
    return {name: value for name, value in worn.items() if value is not None}


def _notices(task: CheckTask) -> Iterator[Notice]:
    """Yield what the wear leaves out."""
    yield Notice("wear-stiffness", "worn teeth count as stiff as new ones: wear changes the gaps of the flanks alone")
    if task.load.application_factor != 1:
        yield Notice("wear-load", "wear is that of the torque with K_A all the time")


def _swings(states: list[WornState]) -> Iterator[Notice]:
    """Yield a notice where root stresses swing from step to step: steps are then too large for the flanks to follow."""
    stress = np.array([tuple(state.root_stresses) for state in states])
    middle = stress[1:-1]
    swing = np.max(np.abs(middle - (stress[:-2] + stress[2:]) / 2) / middle, initial=0.0)
    if swing > _SWING:
        yield Notice("wear-steps", f"root stress swings by {100 * swing:.0f} % from step to step: give more steps")


def _frozen(values: Floats) -> Floats:
    """Return a copy that cannot be written."""
    made = values.copy()
    made.flags.writeable = False
    return made


@dataclass(frozen=True)
class _Run:
    """Inputs that all steps have in common."""

    task: CheckTask
    options: WearOptions
    model: PlanePair
    grids: PerGear[WearGrid]
    coefficients: PerGear[float]

    @property
    def passages(self) -> PerGear[float]:
        """Passages of a tooth of each gear through the mesh, for one of the pinion."""
        pair = self.model.gear_pair
        return PerGear(1.0, pair.pinion.teeth / pair.wheel.teeth)

    def state(self, cycles: float, worn: PerGear[Floats], work: float) -> WornState:
        """Return the pair with worn flanks under its load."""
        model = worn_pair(self.model, self.grids, worn) if any(each.any() for each in worn) else self.model
        cycle = PlaneCycle.run(model, self.task.torque, self.options.positions)
        areas = PerGear.each(lambda role: float(self.grids.pick(role).areas @ worn.pick(role)))
        lengths = self.grids.map(lambda grid: (grid.last**2 - grid.first**2) / (2 * grid.base_radius))
        return WornState(
            cycles=cycles,
            worn=worn.map(_frozen),
            depth=PerGear.each(lambda role: self._depth(role, worn.pick(role))),
            mean_depth=PerGear.each(lambda role: 1000 * areas.pick(role) / lengths.pick(role)),
            volume=areas.map(lambda area: area * self.model.width),
            work=work,
            cycle=cycle,
        )

    def _depth(self, role: Role, worn: Floats) -> float:
        grid = self.grids.pick(role)
        return float(1000 * (grid.values(np.linspace(grid.first, grid.last, 4 * grid.spans + 1)) @ worn).max())

    def _rates(self, taken: CycleWear) -> PerGear[Floats]:
        """Return what the splines lose (mm) for a load cycle of the pinion."""

        def rate(role: Role) -> Floats:
            factor = self.coefficients.pick(role) * _PER_METRE * self.passages.pick(role)
            found: Floats = factor * taken.lost.pick(role) / self.grids.pick(role).areas
            return found

        return PerGear.each(rate)

    def stepped(self, state: WornState, depth: float, loss: float) -> WornState:
        """Return the state after about `depth` (µm) more at the worst place, which ends at the loss (µm)."""
        begin = cycle_wear(state.cycle, self.grids)
        rates = self._rates(begin)
        fastest = max(self._depth(role, rate) for role, rate in rates.items())
        if fastest <= 0:
            raise SolverError("nothing is worn off: contact has no sliding")
        cycles = depth / fastest
        trial = self.state(0.0, self._added(state.worn, rates, cycles), 0.0)
        end = cycle_wear(trial.cycle, self.grids)
        mean = PerGear(*((one + two) / 2 for one, two in zip(rates, self._rates(end), strict=True)))
        cycles = self._until(state, mean, cycles, loss)
        work = (begin.work + end.work) / 2 * self.model.width * _PER_METRE * cycles
        return self.state(state.cycles + cycles, self._added(state.worn, mean, cycles), state.work + work)

    @staticmethod
    def _added(worn: PerGear[Floats], rates: PerGear[Floats], cycles: float) -> PerGear[Floats]:
        return PerGear(*(one + rate * cycles for one, rate in zip(worn, rates, strict=True)))

    def _until(self, state: WornState, rates: PerGear[Floats], cycles: float, loss: float) -> float:
        """Return the load cycles of a step, or less where the loss (µm) is reached before its end."""

        def greatest(count: float) -> float:
            return max(self._depth(role, worn) for role, worn in self._added(state.worn, rates, count).items())

        if greatest(cycles) <= loss:
            return cycles
        low, high = 0.0, cycles
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if greatest(middle) < loss else (low, middle)
        return high
