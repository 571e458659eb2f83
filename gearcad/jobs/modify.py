"""Job `modify`: tip relief and crowning for the load of a design, on its shafts where it has any."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Annotated, ClassVar, NamedTuple, Unpack

import numpy as np

from gearcad.check.options import CheckOptions, Model
from gearcad.check.relief_start import start_notice
from gearcad.check.summary import ERRORS, PRESSURE, SOLID
from gearcad.contact.load_range import LoadRange
from gearcad.contact.modification_search import FoundModification, Search, conditions, start_search
from gearcad.contact.modification_variants import AMOUNTS, Condition, with_amounts
from gearcad.contact.shared.line_of_action import loaded_left
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidPair, SolidSizes, solid_pair
from gearcad.core.errors import GeometryError, ParameterError, as_choice
from gearcad.core.quantities import STRENGTH, TORQUE, Words
from gearcad.core.records import Floats, JsonObject, Notice, Pictured, texts
from gearcad.core.runtime import Agenda, Progress, one_thread
from gearcad.designs import Design, DesignKind, Inputs, PairDesign
from gearcad.geometry import GearPair, ReliefShape
from gearcad.jobs.job import Job, as_design
from gearcad.load import Load
from gearcad.material import Material, Materials, of_both
from gearcad.mounting import Mounting
from gearcad.rating.load_factor_formulas import manufacturing_misalignment
from gearcad.rating.options import RatingOptions, helix_slope_deviations
from gearcad.shafts.face_load import MeshOnShafts
from gearcad.shafts.lead_search import LeadProposal, propose_lead
from gearcad.version import __version__

SUFFIX = "-modified"
"""Suffix of the name of a modified design."""


@dataclass(frozen=True, kw_only=True)
class CycleFigures:
    """Figures of a check of one mesh cycle.

    They are the transmission error in µm, stresses in MPa, and the number of positions at which the edge of a tip carries load.
    """

    transmission_error_peak_to_peak: float
    transmission_error_harmonics: tuple[float, float, float]
    contact_pressure: float
    root_tension_pinion: float
    root_tension_wheel: float
    face_load_factor: float
    edge_positions: int

    @classmethod
    def of(cls, cycle: SolidCycle) -> CycleFigures:
        """Return the figures of a cycle, with the extremes of a check.

        Raises ParameterError if all contact is beside edges.
        """
        extremes = {quantity.name: found.value for quantity in SOLID if (found := cycle.extreme(quantity)) is not None}
        if "contact_pressure" not in extremes:
            permitted = "must leave a place of contact away from the edges of the flanks: beside them no pressure is told"
            raise ParameterError("torque", cycle.torque, permitted, "N·m")
        first, second, third = cycle.harmonics[:3].tolist()
        return cls(
            transmission_error_peak_to_peak=extremes["transmission_error_max"] - extremes["transmission_error_min"],
            transmission_error_harmonics=(first, second, third),
            contact_pressure=extremes["contact_pressure"],
            root_tension_pinion=extremes["root_tension_pinion"],
            root_tension_wheel=extremes["root_tension_wheel"],
            face_load_factor=cycle.face_load_factor,
            edge_positions=cycle.edge_positions,
        )


class Robustness(NamedTuple):
    """Transmission error, peak to peak (µm), before and after the proposal, under another condition than the load."""

    condition: Condition
    before: float
    after: float

    def to_dict(self) -> dict[str, float]:
        """Return the entry in the document of a proposal: the fields of the condition, and both errors (µm)."""
        return {**asdict(self.condition), "before": self.before, "after": self.after}


class LoadErrors(NamedTuple):
    """Transmission errors, peak to peak (k,) in µm, before and after the proposal, under the loads of a search."""

    loads: LoadRange
    before: tuple[float, ...]
    after: tuple[float, ...]

    @property
    def statistics(self) -> tuple[float, float]:
        """The statistic (µm) that is made least, before and after."""
        before, after = (float(self.loads.of(np.array(each))) for each in (self.before, self.after))
        return before, after

    def to_dict(self) -> JsonObject:
        """Return the entry in the document of a proposal: torques in N·m, transmission errors in µm."""
        before, after = self.statistics
        names = ("torque", "weight", "before", "after")
        each = zip(self.loads.torques, self.loads.weights, self.before, self.after, strict=True)
        return {
            "objective": self.loads.statistic.value,
            "before": before,
            "after": after,
            "each": [dict(zip(names, row, strict=True)) for row in each],
        }


class LeadOnShafts(NamedTuple):
    """f_sh and f_ma (µm), and K_Hbeta of the load over the face on the shafts, of the worse side, before and after."""

    f_sh: float
    f_ma: float
    K_Hbeta_before: float
    K_Hbeta_after: float


@dataclass(frozen=True, kw_only=True)
class Proposal(Pictured):
    """Modifications for a design at a torque (N·m on the pinion), and their effects; `pair` is the design's pair with them.

    `bound` (MPa) is that of the contact pressure. All figures are those that a check of solid bodies finds; `lead` is what the
    modifications along the face make of the load on the shafts of the design, if it has any.
    """

    model: ClassVar[Model] = Model.SOLID

    design: PairDesign
    pair: GearPair
    torque: float
    bound: float
    variants: int
    before: CycleFigures
    after: CycleFigures
    robustness: tuple[Robustness, ...]
    lead: LeadOnShafts | None = None
    loads: LoadErrors | None = None

    def __repr__(self) -> str:
        errors = (each.transmission_error_peak_to_peak for each in (self.before, self.after))
        return f"<Proposal for {self.design.name!r} at {self.torque:g} N·m: {' -> '.join(f'{each:.3g}' for each in errors)} µm>"

    @property
    def name(self) -> str:
        """Name of the modified design."""
        return self.design.name + SUFFIX

    @cached_property
    def changes(self) -> dict[str, float | str]:
        """The keys of the spec that change, with their values."""
        found: dict[str, float | str] = {"pair.name": self.name}
        for role, gear in self.pair.gears.items():
            old, new = self.design.pair.gears.pick(role).modification.to_dict(), gear.modification.to_dict()
            for name, value in new.items():
                if value != old[name] and (name in gear.modification.in_use or not name.endswith(("_length", "_shape"))):
                    found[f"{role.value}.modification.{name}"] = value
        return found

    @property
    def notes(self) -> dict[str, str]:
        """Units, to stand behind new keys."""
        numbers = [key for key, value in self.changes.items() if not isinstance(value, str)]
        return {key: "mm of roll" if key.endswith("_length") else "µm" for key in numbers}

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices that an engineer should know before manufacture."""
        after, bound, found = self.after, self.bound, []
        if after.contact_pressure > bound:
            text = f"the contact pressure is {after.contact_pressure:.0f} MPa, above the bound of {bound:.0f} MPa"
            found.append(Notice("pressure-above-bound", text))
        if after.edge_positions:
            text = (
                f"a tip edge still touches at {after.edge_positions} positions: freeing it would raise the transmission error "
                "or the pressure above the bound"
            )
            found.append(Notice("tip-edge-contact", text))
        if after.transmission_error_peak_to_peak > self.before.transmission_error_peak_to_peak:
            text = (
                "the transmission error is not less than before: the present flanks exceed the bounds, so they are no valid "
                "alternative"
            )
            found.append(Notice("transmission-error-not-less", text))
        found.extend(start_notice(self.pair))
        return tuple(found)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices as texts."""
        return texts(self.notices)

    def to_dict(self) -> JsonObject:
        """Return the proposal under the names of its document."""
        return {
            "model": self.model.value,
            "torque": self.torque,
            "pressure_bound": self.bound,
            "variants": self.variants,
            "changes": self.changes,
            "before": asdict(self.before),
            "after": asdict(self.after),
            "robustness": [each.to_dict() for each in self.robustness],
            **({} if self.loads is None else {"loads": self.loads.to_dict()}),
            **({} if self.lead is None else {"shafts": self.lead._asdict()}),
            "warnings": list(self.warnings),
            "notices": [each.to_dict() for each in self.notices],
        }


_BODIES, _CYCLE, _SEARCH, _ROBUSTNESS = _STEPS = ("bodies of pinion and wheel", "mesh cycle", "search", "robustness")

_MORE_PRESSURE = 1.05
"""Share of the pressure of the plain flanks that a proposal may reach where the material's limit is out of reach."""

_ROUNDS = 5
_SEEN = 0.02
"""Largest number of rounds of a search, each at the positions that a check of the last proposal adds, and the share of the
transmission error by which the search may differ at the end: its lines have fewer cells.
"""

_BELOW = 0.999
"""Share of the bound that a search aims at: less than its lattice and its pressures are exact."""

_NEARBY = 6
"""Largest number of neighbours of a proposal that are checked: those that the search ranks best."""

_TURNS = 8
"""Largest number of positions that a check adds to a search."""


@dataclass(frozen=True, kw_only=True)
class Modify(Job[PairDesign, Proposal]):
    """Search tip relief and crowning for a pair at a torque (N·m on the pinion; None: the loads of [modify], or that of its
    load, times its factor).

    `pressure` (MPa) None stands for the material's limit or, where that is out of reach, a little more than without
    modifications; `shape` of the tip relief None for the better one.
    """

    verb = "modify"
    accepts = (DesignKind.PAIR,)
    why = "flanks are modified for those of a mate"
    with_shafts = True

    torque: Annotated[float | None, TORQUE, Words("torque on the pinion", "T_1")] = None
    pressure: Annotated[float | None, STRENGTH, Words("most contact pressure")] = None
    shape: Annotated[ReliefShape | None, Words("shape of the tip relief")] = None

    def __post_init__(self) -> None:
        if self.torque is not None:
            TORQUE.require("torque", self.torque)
        if self.pressure is not None:
            STRENGTH.require("pressure", self.pressure)
        if self.shape is not None:
            object.__setattr__(self, "shape", as_choice("shape", self.shape, ReliefShape))

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> Proposal:
        design = self.accepted(design, progress)
        loads = None if self.torque is not None or design.modify is None else design.modify.range
        pair, torque = self._task(design, loads)
        options, agenda = design.check or CheckOptions(), Agenda(progress, dict.fromkeys(_STEPS, 1.0))
        on_shafts = _lead_on_shafts(design, torque)
        model = _model(design, pair, torque, options, agenda, on_shafts)
        agenda(_CYCLE)
        count, limits = options.positions_of(Model.SOLID), self._limits(design.material or Material())
        before, others = _checked(model, torque, count), _under_others(model, torque, loads, count)
        agenda(_SEARCH)
        shapes = ReliefShape if self.shape is None else (self.shape,)
        tried = [
            each
            for shape in shapes
            for each in _tried(model, torque, shape, limits, count, self.pressure is not None, on_shafts, loads)
        ]
        best = _polished(model, _best(tried, limits), count)
        agenda(_ROBUSTNESS)
        models = (model, best.cycle.model)
        told = [each.transmission_error_peak_to_peak for each in (CycleFigures.of(before), best.figures)]
        robustness = tuple(
            Robustness(each, *(told if each == Condition(torque) else [_swing(of, each, count) for of in models]))
            for each in conditions(torque)
        )
        return Proposal(
            design=design,
            pair=with_amounts(pair, unmirrored(best.found.amounts, pair, torque), best.search.variants.shape),
            torque=torque,
            bound=best.bound,
            variants=sum(max(each.found.tried for each in [*tried, best] if each.shape is shape) for shape in shapes),
            before=CycleFigures.of(before),
            after=best.figures,
            robustness=robustness,
            lead=None if on_shafts is None else on_shafts.figures,
            loads=None
            if loads is None
            else LoadErrors(loads, _errors(loads, before, others), _errors(loads, best.cycle, best.others)),
        )

    def _task(self, design: PairDesign, loads: LoadRange | None) -> tuple[GearPair, float]:
        """Pair and torque, the greatest of the loads; raises for what cannot be searched."""
        torque = self.torque if loads is None else loads.greatest
        if torque is None:
            if design.load is None:
                raise ParameterError("load.torque", None, "must be given, in N·m on the pinion, here or as --torque")
            torque = design.load.torque * design.load.application_factor
        if not torque:
            raise ParameterError("load.torque", torque, "must not be 0: without torque flanks need no modification", "N·m")
        if design.pair.total_contact_ratio < 1:
            ratio = design.pair.total_contact_ratio
            raise GeometryError(
                "pair.total_contact_ratio", ratio, "must be at least 1: between two pairs of teeth no tooth would be in contact"
            )
        replace(design, name=design.name + SUFFIX)  # a name that gets too long is told before the work
        return design.pair, torque

    def _limits(self, material: Materials) -> list[float]:
        """Return the given pressure (MPa), else the pressure that both materials certainly bear, if known."""
        if self.pressure is not None:
            return [self.pressure]
        limits = [each.contact_limit for each in of_both(material)]
        known = [limit[0] if isinstance(limit, tuple) else limit for limit in limits if limit is not None]
        return [min(known)] if len(known) == len(limits) else []

    def document(self, result: Proposal) -> JsonObject:
        """Return the content of modify.json: µm, MPa, mm of roll; the changes under their keys of a spec."""
        return {"kind": "modify", "name": result.name, "gearcad": __version__, **result.to_dict()}

    def notices(self, result: Proposal) -> Sequence[Notice]:
        return result.notices

    def figures(self, document: JsonObject) -> JsonObject:
        """Return the modifications, and what the mesh comes to without and with them."""
        changes = {key: value for key, value in document["changes"].items() if key != "pair.name"}
        named = ("torque", "pressure_bound", "variants", "before", "after", "shafts", "warnings")
        return {**{name: document[name] for name in named if name in document}, **changes}


def modified_spec(text: str, proposal: Proposal) -> str:
    """Return the text of a spec with the modifications of a proposal for it. Raises SpecError where it cannot be edited."""
    from gearcad.designs.reader import edit_spec

    edited = edit_spec(text, proposal.changes, proposal.notes)
    # Starters say behind a name where results go.
    return edited.replace(f"go to output/{proposal.design.name}/", f"go to output/{proposal.name}/")


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


class _OnShafts(NamedTuple):
    """The mesh of a design on its shafts at a torque, the misalignment f_ma (µm), and the modifications that both ask for."""

    mesh: MeshOnShafts
    manufacture: float
    found: LeadProposal

    def turned(self, model: SolidPair) -> SolidPair:
        """Return bodies on rigid shafts that are turned by f_sh: how far all shafts give way is none of a search's business."""
        mounting = model.mounting
        off = mounting.misalignment + self.mesh.misalignment_of_shafts
        return model.on(None).remade(model.pair, replace(mounting, misalignment=off))

    @property
    def figures(self) -> LeadOnShafts:
        """The figures that the proposal has."""
        return LeadOnShafts(self.mesh.misalignment_of_shafts, self.manufacture, self.found.before, self.found.after)

    def amounts(self, pair: GearPair, torque: float) -> tuple[float, float]:
        """Return lead crowning and helix angle modification (µm) for the pair that `loaded_left` makes of a pair."""
        found = np.array([0.0, 0.0, 0.0, 0.0, self.found.lead_crowning, self.found.helix_angle_modification])
        crowning, helix = unmirrored(found, pair, torque)[4:].tolist()
        return crowning, helix


def _lead_on_shafts(design: PairDesign, torque: float) -> _OnShafts | None:
    """Return the modifications along the face for the shafts of a design at a torque (N·m); None without shafts.

    f_ma is that of [rating], or of the accuracy grade, to the worse of its sides. Raises as tolerances do.
    """
    found = replace(design, load=Load(torque=torque)).arrangement
    if found is None or found.mesh is None:
        return None
    options = design.rating or RatingOptions()
    given = options.manufacturing_misalignment
    manufacture = manufacturing_misalignment(*helix_slope_deviations(design.pair, options)) if given is None else given
    mesh = replace(found.mesh, misalignment=(design.mounting or Mounting()).misalignment)
    return _OnShafts(mesh, manufacture, propose_lead(mesh, options.sides_of(manufacture)))


def _model(
    design: PairDesign, pair: GearPair, torque: float, options: CheckOptions, agenda: Agenda, on_shafts: _OnShafts | None
) -> SolidPair:
    """Return the solid bodies on their shafts, as `gearcad check --model 3d` makes them."""
    mounting = design.mounting or Mounting()
    made = solid_pair(
        loaded_left(mounting.mounted(pair), torque),
        design.material or Material(),
        body=options.body,
        sizes=SolidSizes().refined(options.refinement),
        mounting=replace(mounting, centre_distance_change=0.0),
        tell=agenda.within(_BODIES),
    )
    return made if on_shafts is None else made.on(on_shafts.mesh.face.supports())


class _Tried(NamedTuple):
    """A search, what it found, and the mesh cycle of that with the figures of a check; `bound` (MPa) is that asked for."""

    search: Search
    found: FoundModification
    cycle: SolidCycle
    figures: CycleFigures
    bound: float
    others: tuple[SolidCycle, ...] = ()

    @property
    def error(self) -> float:
        """Transmission error, peak to peak (µm), that is to be least; of several loads their statistic."""
        loads = self.search.loads
        if loads is None:
            return self.figures.transmission_error_peak_to_peak
        return float(loads.of(np.array(_errors(loads, self.cycle, self.others))))

    @property
    def turns(self) -> Floats:
        """Roll angles (deg) that a check under all loads adds to a search."""
        return np.concatenate([_turns(each) for each in (self.cycle, *self.others)])

    @property
    def shape(self) -> ReliefShape:
        """Shape of the tip relief."""
        return self.search.variants.shape

    @property
    def bounded(self) -> bool:
        """Whether the pressure that a check finds keeps to the bound."""
        return self.figures.contact_pressure <= self.bound

    @property
    def price(self) -> float:
        """Transmission error, peak to peak (µm), and what a pressure above the bound costs."""
        over = float(self.search.price(np.array(self.figures.contact_pressure), self.bound))
        return self.error + over


def _tried(
    model: SolidPair,
    torque: float,
    shape: ReliefShape,
    limits: list[float],
    count: int,
    given: bool,
    on_shafts: _OnShafts | None,
    loads: LoadRange | None = None,
) -> list[_Tried]:
    """Search with one shape of the tip relief: what it came to for the first bound that is kept, else for the last."""
    if on_shafts is None:
        search = start_search(model, torque, shape, loads=loads)
    else:
        search = start_search(on_shafts.turned(model), torque, shape, on_shafts.amounts(model.pair, torque), loads)
    plain = _modified(model, search.start, shape, torque, count).extreme(PRESSURE)
    seen = float(search.plain.pressures[0])
    greatest = seen if plain is None else plain.value
    bounds = limits if given else [*limits, _MORE_PRESSURE * greatest]
    while True:
        aims = [bound * seen / greatest for bound in bounds] if plain is not None else bounds
        found = search.best(aims)
        bounds = bounds[aims.index(found.bound) :]
        every = _closer(model, search, found, bounds[0], count)
        if len(bounds) == 1 or any(each.bounded for each in every):
            return every
        bounds = bounds[1:]


def _closer(model: SolidPair, search: Search, found: FoundModification, bound: float, count: int) -> list[_Tried]:
    """Check proposals and search again, at the positions where their extremes are and for a pressure that the search sees."""
    every: list[_Tried] = []
    while True:
        here = _found(model, search, found, bound, count)
        every.append(here)
        close = here.error - found.peak_to_peak <= _SEEN * here.error
        if len(every) == _ROUNDS or (close and (every[-1].bounded or not found.bounded)):
            return every
        search = search.closer(here.turns)
        seen = float(search.outcomes(found.amounts[None]).pressures[0]) / here.figures.contact_pressure
        again = search.again(found, _BELOW * seen * bound)
        if every[-1].bounded and np.array_equal(again.amounts, found.amounts):
            return every
        found = again


def _polished(model: SolidPair, best: _Tried, count: int) -> _Tried:
    """Return the best, by the figures of a check, of a proposal and those neighbours that the search takes for better."""
    search = best.search.closer(best.turns)
    seen = float(search.outcomes(best.found.amounts[None]).pressures[0]) / best.figures.contact_pressure
    for found in search.better(best.found, seen * best.bound, _NEARBY):
        other = _found(model, search, found, best.bound, count)
        if other.price < best.price and other.bounded >= best.bounded:
            best = other
    return best


def _found(model: SolidPair, search: Search, found: FoundModification, bound: float, count: int) -> _Tried:
    """Return what a check under all loads makes of what a search found."""
    cycle = _modified(model, found.amounts, search.variants.shape, search.torque, count)
    others = _under_others(cycle.model, search.torque, search.loads, count)
    return _Tried(search, found, cycle, CycleFigures.of(cycle), bound, others)


def _under_others(model: SolidPair, torque: float, loads: LoadRange | None, count: int) -> tuple[SolidCycle, ...]:
    """Return the mesh cycles of a model under the loads other than the torque, in their order."""
    others = () if loads is None else (each for each in loads.torques if each != torque)
    return tuple(SolidCycle.run(model, each, count).searched(ERRORS) for each in others)


def _errors(loads: LoadRange, cycle: SolidCycle, others: Sequence[SolidCycle]) -> tuple[float, ...]:
    """Return the transmission errors, peak to peak (k,) in µm, under the loads."""
    swings = {each.torque: float(np.ptp(each.course("transmission_error"))) for each in others}
    swings[cycle.torque] = CycleFigures.of(cycle).transmission_error_peak_to_peak
    return tuple(swings[torque] for torque in loads.torques)


def _turns(cycle: SolidCycle) -> Floats:
    """Return the roll angles (deg) where the transmission error turns nearest to its ends, and of the greatest pressure."""
    angles, errors = cycle.course("roll_angle"), cycle.course("transmission_error")
    up = np.diff(errors, append=errors[:1]) > 0
    turns = np.flatnonzero(up != np.roll(up, 1))
    inside = np.minimum(errors.max() - errors, errors - errors.min())
    nearest = turns[np.argsort(inside[turns], kind="stable")][:_TURNS]
    worst = cycle.extreme(PRESSURE)
    return np.append(angles[nearest], [] if worst is None else worst.roll_angle)


def _best(tried: list[_Tried], limits: list[float]) -> _Tried:
    """Return the one that keeps to the bound, to that of the material first; of several the one of least transmission error,
    unless another is worth its price for edges of tips out of contact.
    """

    def missed(each: _Tried) -> tuple[bool, bool]:
        return not each.bounded, each.bound not in limits

    alike = [each for each in tried if missed(each) == min(map(missed, tried))]
    least = min(alike, key=lambda each: each.price)
    dearest = least.search.dearest(least.price)
    free = [each for each in alike if each.found.edges_free and each.price <= dearest]
    return min(free or [least], key=lambda each: each.price)


def _modified(model: SolidPair, amounts: Floats, shape: ReliefShape, torque: float, count: int) -> SolidCycle:
    """Return the mesh cycle of a pair with amounts (6,) in place of its own, as a check has it."""
    return _checked(model.remade(with_amounts(model.pair, amounts, shape), model.mounting), torque, count)


def _checked(model: SolidPair, torque: float, count: int) -> SolidCycle:
    """Return the mesh cycle of a model at `count` positions and, as a check has it, where its extremes are."""
    return SolidCycle.run(model, torque, count).searched(SOLID)


def _swing(model: SolidPair, condition: Condition, count: int) -> float:
    """Return the transmission error of a model under a condition, peak to peak (µm), its extremes sought as by a check."""
    mounted = model.remade(model.pair, condition.mounted(model.mounting))
    cycle = SolidCycle.run(mounted, condition.torque, count).searched(ERRORS)
    return float(np.ptp(cycle.course("transmission_error")))


def unmirrored(amounts: Floats, pair: GearPair, torque: float) -> Floats:
    """Return the amounts (6,) for the pair as it is, from those for the pair that `loaded_left` makes of it: a spur gear's
    helix modification changes its sign.
    """
    turned = torque < 0 and not pair.pinion.helix_angle
    helix = np.array([name.endswith("helix_angle_modification") for name in AMOUNTS])
    return np.where(helix & turned, 0.0 - amounts, amounts)
