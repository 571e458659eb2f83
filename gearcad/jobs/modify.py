"""Modify: tip relief and crowning for the load of a design, for least transmission error at a bounded pressure."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, Unpack

import numpy as np

from gearcad.arrays import Floats
from gearcad.check.options import CheckOptions, Model
from gearcad.check.solid.summary import worst_place
from gearcad.contact.optimum.search import Found, Search, conditions, start_search
from gearcad.contact.optimum.variants import AMOUNTS, Condition, with_amounts
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidPair, SolidSizes, loaded_left, solid_pair
from gearcad.designs import Design, Inputs, PairDesign, as_design
from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry import GearPair, ReliefShape
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.per_gear import Role
from gearcad.progress import Progress
from gearcad.ranges import STRENGTH, TORQUE

__all__ = ["Figures", "Proposal", "Robustness", "propose", "unmirrored"]


_STEPS = ("bodies of pinion and wheel", "mesh cycle", "search", "robustness")

_MORE_PRESSURE = 1.05
"""Share of the pressure of the plain flanks that a proposal may reach where the material's limit is out of reach."""

_BESIDE = 1.01
"""Share of the bound from which on a pressure, solved in full, is worth a warning."""

_SUFFIX = "-modified"


@dataclass(frozen=True, kw_only=True)
class Figures:
    """What a mesh cycle comes to: transmission error in µm, stresses in MPa, and at how many positions a tip's edge carries."""

    transmission_error_peak_to_peak: float
    transmission_error_harmonics: tuple[float, float, float]
    contact_pressure: float
    root_tension_pinion: float
    root_tension_wheel: float
    face_load_factor: float
    edge_positions: int

    @classmethod
    def of(cls, cycle: SolidCycle) -> Figures:
        """Those of a cycle. Raises ParameterError where no place of contact is away from edges."""
        worst = worst_place(cycle)
        if worst is None:
            permitted = "must leave a place of contact away from the edges of the flanks: beside them no pressure is told"
            raise ParameterError("torque", cycle.torque, permitted, "N·m")
        first, second, third = cycle.harmonics[:3].tolist()
        pinion, wheel = (cycle.worst_position(role).tension.pick(role).stress for role in Role)
        return cls(
            transmission_error_peak_to_peak=float(np.ptp(cycle.values("transmission_error"))),
            transmission_error_harmonics=(first, second, third),
            contact_pressure=worst.of(worst.contact.pressures),
            root_tension_pinion=pinion,
            root_tension_wheel=wheel,
            face_load_factor=cycle.face_load_factor,
            edge_positions=cycle.edge_positions,
        )


class Robustness(NamedTuple):
    """Transmission error, peak to peak (µm), as the pair is and as proposed, under another condition than the load."""

    condition: Condition
    before: float
    after: float

    def to_dict(self) -> dict[str, float]:
        """Flat."""
        return {**asdict(self.condition), "before": self.before, "after": self.after}


@dataclass(frozen=True, kw_only=True)
class Proposal:
    """Modifications for a design at a torque (N·m on the pinion), and what they do; `pair` is the design's with them."""

    design: PairDesign
    pair: GearPair
    torque: float
    found: Found
    variants: int
    before: Figures
    after: Figures
    robustness: tuple[Robustness, ...]

    def __repr__(self) -> str:
        errors = (each.transmission_error_peak_to_peak for each in (self.before, self.after))
        return f"<Proposal for {self.design.name!r} at {self.torque:g} N·m: {' -> '.join(f'{each:.3g}' for each in errors)} µm>"

    @property
    def name(self) -> str:
        """Of the modified design."""
        return self.design.name + _SUFFIX

    @cached_property
    def changes(self) -> dict[str, float | str]:
        """The keys of the spec that change, with their values."""
        found: dict[str, float | str] = {"pair.name": self.name}
        for owner in ("pinion", "wheel"):
            old, new = (getattr(pair, owner).modification for pair in (self.design.pair, self.pair))
            for name, value in new.to_dict().items():
                if value != old.to_dict()[name] and (name in new.in_use or not name.endswith(("_length", "_shape"))):
                    found[f"{owner}.modification.{name}"] = value
        return found

    @property
    def notes(self) -> dict[str, str]:
        """Units, to stand behind new keys."""
        numbers = [key for key, value in self.changes.items() if not isinstance(value, str)]
        return {key: "mm of roll" if key.endswith("_length") else "µm" for key in numbers}

    @property
    def warnings(self) -> tuple[str, ...]:
        """What an engineer should know before making this."""
        after, bound, found = self.after, self.found.bound, []
        if not self.found.bounded or after.contact_pressure > _BESIDE * bound:
            found.append(f"the contact pressure is {after.contact_pressure:.0f} MPa, above the bound of {bound:.0f} MPa")
        if after.edge_positions:
            found.append(
                f"a tip edge still touches at {after.edge_positions} positions: to free it would cost transmission error or "
                "pressure above the bound"
            )
        if after.transmission_error_peak_to_peak > self.before.transmission_error_peak_to_peak:
            found.append("the transmission error is not less than it was: the flanks as they are break the bounds")
        return tuple(found)

    def to_dict(self) -> dict[str, Any]:
        """The document that `gearcad modify --json` prints."""
        return {
            "torque": self.torque,
            "pressure_bound": self.found.bound,
            "variants": self.variants,
            "changes": self.changes,
            "before": asdict(self.before),
            "after": asdict(self.after),
            "robustness": [each.to_dict() for each in self.robustness],
            "warnings": list(self.warnings),
        }


def propose(
    subject: Design | GearPair,
    load: Load | None = None,
    *,
    torque: float | None = None,
    pressure: float | None = None,
    shape: ReliefShape | None = None,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> Proposal:
    """Search tip relief and crowning for a pair under a load.

    `torque` (N·m on the pinion) None stands for the load's, `pressure` (MPa) None for the material's limit or, where that is
    out of reach, a little more than without modifications, `shape` None for the better one. `material`, `mounting` and
    `check`, as the load, stand in place of those of a design.

    Raises ParameterError for a design without pair or load, and what `gearcad.contact` does.
    """
    design = as_design(subject, load, **inputs).accepted(PairDesign, why="flanks are modified for those of a mate")
    pair, torque = _task(design, torque, pressure)
    from threadpoolctl import threadpool_limits

    options = design.check or CheckOptions()
    with threadpool_limits(1):
        model = _model(design, pair, torque, options, progress)
        _tell(progress, "mesh cycle")
        before = SolidCycle.run(model, torque, options.positions_of(Model.SOLID))
        _tell(progress, "search")
        count, limits = len(before.positions), _limits(design.material or Material(), pressure)
        tried = [
            _tried(model, torque, each, limits, count, pressure is not None) for each in ([shape] if shape else ReliefShape)
        ]
        best = _best(tried, limits)
        _tell(progress, "robustness")
        pairs = (model.pair, best.cycle.model.pair)
        robustness = tuple(
            Robustness(each, *(best.search.peak_to_peak(of, each) for of in pairs)) for each in conditions(torque)
        )
    return Proposal(
        design=design,
        pair=with_amounts(pair, unmirrored(best.found.amounts, pair, torque), best.search.variants.shape),
        torque=torque,
        found=best.found,
        variants=sum(each.search.tried for each in tried),
        before=Figures.of(before),
        after=Figures.of(best.cycle),
        robustness=robustness,
    )


def _tell(progress: Progress | None, step: str, share: float = 0.0) -> None:
    if progress is not None:
        progress(step, _STEPS.index(step) + share, len(_STEPS))


def _task(design: PairDesign, torque: float | None, pressure: float | None) -> tuple[GearPair, float]:
    """Pair and torque; raises for what cannot be searched."""
    if torque is not None:
        TORQUE.require("torque", torque)
    elif design.load is None:
        raise ParameterError("load.torque", None, "must be given, in N·m on the pinion, here or as --torque")
    else:
        torque = design.load.torque * design.load.application_factor
    if not torque:
        raise ParameterError("load.torque", torque, "must not be 0: without torque flanks need no modification", "N·m")
    if pressure is not None:
        STRENGTH.require("pressure", pressure)
    if design.pair.total_contact_ratio < 1:
        ratio = design.pair.total_contact_ratio
        raise GeometryError("pair.total_contact_ratio", ratio, "must be at least 1: the teeth lose each other")
    replace(design, name=design.name + _SUFFIX)  # a name that gets too long is told before the work
    return design.pair, torque


def _model(design: PairDesign, pair: GearPair, torque: float, options: CheckOptions, progress: Progress | None) -> SolidPair:
    """The solid bodies, as `gearcad check --model 3d` makes them."""
    mounting = design.mounting or Mounting()
    return solid_pair(
        loaded_left(mounting.mounted(pair), torque),
        design.material or Material(),
        body=options.body,
        sizes=SolidSizes().refined(options.refinement),
        mounting=replace(mounting, centre_distance_change=0.0),
        tell=lambda share: _tell(progress, _STEPS[0], share),
    )


def _limits(material: Material, pressure: float | None) -> list[float]:
    """The pressure (MPa) that is given, else what the material bears for certain, if that is known."""
    if pressure is not None:
        return [pressure]
    limit = material.contact_limit
    return [] if limit is None else [limit[0] if isinstance(limit, tuple) else limit]


class _Tried(NamedTuple):
    """A search, what it found, and the mesh cycle of that."""

    search: Search
    found: Found
    cycle: SolidCycle

    @property
    def peak_to_peak(self) -> float:
        """Of the transmission error (µm), solved in full."""
        return Figures.of(self.cycle).transmission_error_peak_to_peak


def _tried(model: SolidPair, torque: float, shape: ReliefShape, limits: list[float], count: int, given: bool) -> _Tried:
    """Search with one shape of the tip relief, and solve what is found in full at `count` positions."""
    search = start_search(model, torque, shape)
    bounds = limits if given else [*limits, _MORE_PRESSURE * float(search.plain.pressures[0])]
    found = search.best(bounds)
    cycle = _cycle(model, found, shape, torque, count)
    over = Figures.of(cycle).contact_pressure / found.bound
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
