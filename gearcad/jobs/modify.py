"""Modify: tip relief and crowning for the load of a design, for least transmission error at a bounded pressure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Unpack

import numpy as np

from gearcad.arrays import Floats
from gearcad.check.options import CheckOptions, Model
from gearcad.contact.optimum.search import Found, Search, conditions
from gearcad.contact.optimum.start import start_search
from gearcad.contact.optimum.variants import AMOUNTS, with_amounts
from gearcad.contact.shared.loaded_left import loaded_left
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidPair, SolidSizes, solid_pair
from gearcad.designs import Design, DesignKind, Inputs, PairDesign
from gearcad.errors import GeometryError, ParameterError, as_choice
from gearcad.geometry import GearPair, ReliefShape
from gearcad.jobs.job import Job
from gearcad.jobs.proposal import SUFFIX, CycleFigures, Proposal, Robustness
from gearcad.jobs.subject import as_design
from gearcad.load import Load
from gearcad.material import Material, Materials, of_both
from gearcad.mounting import Mounting
from gearcad.notice import Notice
from gearcad.progress import Agenda, Progress
from gearcad.ranges import STRENGTH, TORQUE
from gearcad.version import __version__

__all__ = ["Modify", "modify", "unmirrored"]

_BODIES, _CYCLE, _SEARCH, _ROBUSTNESS = _STEPS = ("bodies of pinion and wheel", "mesh cycle", "search", "robustness")

_MORE_PRESSURE = 1.05
"""Share of the pressure of the plain flanks that a proposal may reach where the material's limit is out of reach."""


@dataclass(frozen=True, kw_only=True)
class Modify(Job[PairDesign, Proposal]):
    """Search tip relief and crowning for a pair at a torque (N·m on the pinion; None: that of its load, times its factor).

    `pressure` (MPa) None stands for the material's limit or, where that is out of reach, a little more than without
    modifications; `shape` of the tip relief None for the better one.
    """

    verb = "modify"
    accepts = (DesignKind.PAIR,)
    why = "flanks are modified for those of a mate"

    torque: float | None = None
    pressure: float | None = None
    shape: ReliefShape | None = None

    def __post_init__(self) -> None:
        if self.torque is not None:
            TORQUE.require("torque", self.torque)
        if self.pressure is not None:
            STRENGTH.require("pressure", self.pressure)
        if self.shape is not None:
            object.__setattr__(self, "shape", as_choice("shape", self.shape, ReliefShape))

    def _run(self, design: PairDesign, progress: Progress | None) -> Proposal:
        pair, torque = self._task(design)
        options, agenda = design.check or CheckOptions(), Agenda(progress, dict.fromkeys(_STEPS, 1.0))
        model = _model(design, pair, torque, options, agenda)
        agenda(_CYCLE)
        before = SolidCycle.run(model, torque, options.positions_of(Model.SOLID))
        agenda(_SEARCH)
        count, limits = len(before.positions), self._limits(design.material or Material())
        shapes = ReliefShape if self.shape is None else (self.shape,)
        tried = [_tried(model, torque, shape, limits, count, self.pressure is not None) for shape in shapes]
        best = _best(tried, limits)
        agenda(_ROBUSTNESS)
        pairs = (model.pair, best.cycle.model.pair)
        robustness = tuple(
            Robustness(each, *(best.search.peak_to_peak(of, each) for of in pairs)) for each in conditions(torque)
        )
        return Proposal(
            design=design,
            pair=with_amounts(pair, unmirrored(best.found.amounts, pair, torque), best.search.variants.shape),
            torque=torque,
            found=best.found,
            variants=sum(each.found.tried for each in tried),
            before=CycleFigures.of(before),
            after=CycleFigures.of(best.cycle),
            robustness=robustness,
        )

    def _task(self, design: PairDesign) -> tuple[GearPair, float]:
        """Pair and torque; raises for what cannot be searched."""
        torque = self.torque
        if torque is None:
            if design.load is None:
                raise ParameterError("load.torque", None, "must be given, in N·m on the pinion, here or as --torque")
            torque = design.load.torque * design.load.application_factor
        if not torque:
            raise ParameterError("load.torque", torque, "must not be 0: without torque flanks need no modification", "N·m")
        if design.pair.total_contact_ratio < 1:
            ratio = design.pair.total_contact_ratio
            raise GeometryError("pair.total_contact_ratio", ratio, "must be at least 1: the teeth lose each other")
        replace(design, name=design.name + SUFFIX)  # a name that gets too long is told before the work
        return design.pair, torque

    def _limits(self, material: Materials) -> list[float]:
        """The pressure (MPa) that is given, else what the materials bear for certain, if that is known of both."""
        if self.pressure is not None:
            return [self.pressure]
        limits = [each.contact_limit for each in of_both(material)]
        known = [limit[0] if isinstance(limit, tuple) else limit for limit in limits if limit is not None]
        return [min(known)] if len(known) == len(limits) else []

    def document(self, result: Proposal) -> dict[str, Any]:
        """What modify.json holds: µm, MPa, mm of roll; the changes under their keys of a spec."""
        return {"kind": "modify", "name": result.name, "gearcad": __version__, **result.to_dict()}

    def notices(self, result: Proposal) -> Sequence[Notice]:
        return result.notices

    def figures(self, document: dict[str, Any]) -> dict[str, Any]:
        """The modifications, and what the mesh comes to without and with them."""
        changes = {key: value for key, value in document["changes"].items() if key != "pair.name"}
        named = ("torque", "pressure_bound", "variants", "before", "after", "warnings")
        return {**{name: document[name] for name in named}, **changes}


def modify(
    subject: Design | GearPair,
    load: Load | None = None,
    *,
    torque: float | None = None,
    pressure: float | None = None,
    shape: ReliefShape | str | None = None,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> Proposal:
    """Search tip relief and crowning for a pair under a load: least transmission error, the contact pressure bounded.

    `torque` (N·m on the pinion) None stands for the load's, times its application factor; `pressure` (MPa) None for the
    material's limit or, where that is out of reach, a little more than without modifications; `shape` ("linear" or
    "parabolic") None for the better one. `material`, `mounting` and `check` (CheckOptions), as the load, stand in place of
    those of a design. `Proposal.pair` has the modified flanks.

    Raises ParameterError without a pair or a torque, GeometryError for a pair whose teeth lose each other, and what
    `gearcad.contact` raises.
    """
    chosen = None if shape is None else as_choice("shape", shape, ReliefShape)
    return Modify(torque=torque, pressure=pressure, shape=chosen).run(as_design(subject, load, **inputs), progress)


def _model(design: PairDesign, pair: GearPair, torque: float, options: CheckOptions, agenda: Agenda) -> SolidPair:
    """The solid bodies, as `gearcad check --model 3d` makes them."""
    mounting = design.mounting or Mounting()
    return solid_pair(
        loaded_left(mounting.mounted(pair), torque),
        design.material or Material(),
        body=options.body,
        sizes=SolidSizes().refined(options.refinement),
        mounting=replace(mounting, centre_distance_change=0.0),
        tell=agenda.within(_BODIES),
    )


class _Tried(NamedTuple):
    """A search, what it found, and the mesh cycle of that."""

    search: Search
    found: Found
    cycle: SolidCycle

    @property
    def peak_to_peak(self) -> float:
        """Of the transmission error (µm), solved in full."""
        return CycleFigures.of(self.cycle).transmission_error_peak_to_peak


def _tried(model: SolidPair, torque: float, shape: ReliefShape, limits: list[float], count: int, given: bool) -> _Tried:
    """Search with one shape of the tip relief, and solve what is found in full at `count` positions."""
    search = start_search(model, torque, shape)
    bounds = limits if given else [*limits, _MORE_PRESSURE * float(search.plain.pressures[0])]
    found = search.best(bounds)
    cycle = _cycle(model, found, shape, torque, count)
    over = CycleFigures.of(cycle).contact_pressure / found.bound
    if found.bounded and over > 1:
        # On finer lines, at more positions, there is more than the search saw: it has to stay so much lower.
        found = replace(search.best([found.bound / over]), bound=found.bound)
        cycle = _cycle(model, found, shape, torque, count)
    return _Tried(search, found, cycle)


def _best(tried: list[_Tried], limits: list[float]) -> _Tried:
    """The one that keeps to the bound, to that of the material first; of several the one of least transmission error, unless
    another is worth its price for edges of tips out of contact.
    """

    def missed(each: _Tried) -> tuple[bool, bool]:
        return not each.found.bounded, each.found.bound not in limits

    alike = [each for each in tried if missed(each) == min(map(missed, tried))]
    least = min(alike, key=lambda each: each.peak_to_peak)
    dearest = least.search.dearest(least.peak_to_peak)
    free = [each for each in alike if each.found.edges_free and each.peak_to_peak <= dearest]
    return min(free or [least], key=lambda each: each.peak_to_peak)


def _cycle(model: SolidPair, found: Found, shape: ReliefShape, torque: float, count: int) -> SolidCycle:
    modified = model.remade(with_amounts(model.pair, found.amounts, shape), model.mounting)
    return SolidCycle.run(modified, torque, count)


def unmirrored(amounts: Floats, pair: GearPair, torque: float) -> Floats:
    """Amounts (6,) for the pair as it is, from those for the one that `loaded_left` makes of it: a spur gear's helix turns."""
    turned = torque < 0 and not pair.pinion.helix_angle
    helix = np.array([name.endswith("helix_angle_modification") for name in AMOUNTS])
    return np.where(helix & turned, 0.0 - amounts, amounts)
