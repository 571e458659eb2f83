"""Verdict on the models of a train: which model is enough, and what a coarse model lacks.

At a speed the forces of the teeth load a mesh or a shaft by several natural modes of the reference. The mode with the most load
in a part that the coarse model lacks decides, by the share of that part in its energy. Such parts are the mass of shafts if the
model has none, and for a model without shafts also their springs and the inertias and meshes behind them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Set
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Floats, JsonObject
from gearcad.dynamics.level_agreement import OUTSIDE, SHIFT, Agreement, CurveName, Difference, NotJudged, percent
from gearcad.dynamics.options import OperatingRange
from gearcad.dynamics.response.speed_curves import LEAST_RATIO, quasi_static_spectrum
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.trains.members import GROUND
from gearcad.dynamics.trains.steady_response import static_state
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.dynamics.trains.train_modes import NaturalModes, natural_modes
from gearcad.dynamics.variant_comparison import SideBySide

_NAMED, _OF_GREATEST = 0.05, 1 / 3
"""Shares that are named: those of at least a twentieth and of a third of the greatest share; the greatest always."""

_HARMONICS = 16
"""Number of harmonics of the tooth frequencies that are examined as excitation."""

_HARDLY = 0.02
"""Part of the greatest load of a mode below which a mode does not decide."""

_RIGID = 1e-9
"""Part of the greatest square of a natural frequency below which a mode turns as a whole."""


class Share(NamedTuple):
    """Share of a part of the train in the energy of a natural mode.

    `kind` is "mass" or "spring" of a shaft, "inertia" or "mesh"; `name` is the name of that part. `through` are the shafts that
    join the part to the mesh in question.
    """

    kind: str
    name: str
    share: float
    through: tuple[str, ...] = ()

    @property
    def part(self) -> str:
        """Description of the part in words."""
        part = {
            "mass": f'the mass of shaft "{self.name}"',
            "spring": f'the twist of shaft "{self.name}"',
            "inertia": f'inertia "{self.name}"',
            "mesh": f'the neighbouring mesh "{self.name}"',
        }[self.kind]
        behind = " and ".join(f'"{each}"' for each in self.through)
        return f"{part} behind shaft {behind}" if behind else part

    @property
    def energy(self) -> str:
        """Kind of energy of which the part has a share: "kinetic" or "potential"."""
        return "kinetic" if self.kind in ("mass", "inertia") else "potential"

    @property
    def words(self) -> str:
        """Share, energy and part in words, for use in a sentence."""
        return f"{percent(self.share)} of its {self.energy} energy in {self.part}"

    def to_dict(self) -> JsonObject:
        """Return the entry of the share in `dynamics.json`."""
        return {**self._asdict(), "through": list(self.through), "energy": self.energy}


class Decision(NamedTuple):
    """The natural mode of the reference that decides at a `speed` (rpm): number `mode` (1 is the lowest) with its `frequency`
    (Hz).

    A `harmonic` of the tooth frequency of mesh `teeth` excites the mode. `shares`, the greatest first, are its parts that the
    level lacks.
    """

    curve: CurveName
    speed: float
    teeth: str
    harmonic: float
    mode: int
    frequency: float
    shares: tuple[Share, ...]

    def to_dict(self) -> JsonObject:
        """Return the entry of the decision in `dynamics.json`."""
        return {**self._asdict(), "curve": self.curve._asdict(), "shares": [each.to_dict() for each in self.shares]}


def decision(reference: TrainStudy, level: TrainModel, curve: CurveName, speed: float) -> Decision:
    """Return what the level lacks at a speed (rpm) where its curve differs from that of the reference.

    Of the modes that load the curve, the mode with the most load in a part that the level lacks decides.
    """
    shaken = _shaken(reference, curve, speed)
    highest = max(each.omega for each in shaken)
    modes = natural_modes(reference.train, up_to=highest / (2 * np.pi) * (1 + 1e-6))
    found = []
    for each in shaken:
        mode = int(np.abs(modes.circular - each.omega).argmin())
        lacking = sorted(_lacking(reference.train, modes, mode, level, curve), key=lambda share: -share.share)
        found.append((each.load * (lacking[0].share if lacking else 0.0), mode, each, lacking))
    _, mode, most, lacking = max(found, key=lambda each: each[0])
    return Decision(
        curve=curve,
        speed=speed,
        teeth=reference.up.mesh_names[most.teeth],
        harmonic=most.order / reference.excitation.orders[most.teeth],
        mode=mode + 1,
        frequency=float(modes.frequency[mode]),
        shares=_named(lacking),
    )


def _named(shares: list[Share]) -> tuple[Share, ...]:
    """Return the greatest share and those not far below it."""
    least = max(_NAMED, _OF_GREATEST * shares[0].share) if shares else 0.0
    return tuple(each for place, each in enumerate(shares) if place == 0 or each.share >= least)


# ---------------------------------------------------------------------- what vibrates


class _Shaken(NamedTuple):
    """A vibrating mode: its natural frequency `omega` (1/s) and the `load` that it adds to a curve.

    `order` is the order of the common period at which that load is greatest, `teeth` the mesh that excites the mode most.
    """

    omega: float
    load: float
    order: int
    teeth: int


def _shaken(study: TrainStudy, curve: CurveName, speed: float) -> list[_Shaken]:
    """Return the modes that load a curve, without those that hardly do.

    The forces are those of changing stiffness and tooth errors on a train that does not vibrate, without their load at rest.
    """
    system, excitation = study.system, study.excitation.bonded
    squares, shapes = np.linalg.eigh(system.stiffness_matrix())
    elastic = squares > _RIGID * squares.max()
    squares, shapes = squares[elastic], shapes[:, elastic]
    damping = np.einsum("nr,nk,kr->r", shapes, system.damping_matrix(), shapes)
    forces = quasi_static_spectrum(system, excitation, static_state(system))[1 : 1 + _HARMONICS * max(excitation.orders)]
    driven = forces[:, None, :] * (shapes.T @ system.mesh)
    rate = excitation.fundamental * speed * np.pi * study.train.meshes[0].teeth / 30
    omega = rate * np.arange(1, len(forces) + 1)[:, None]
    damped = np.maximum(damping, 2 * LEAST_RATIO * np.sqrt(squares))
    receptance = 1 / (squares - omega**2 + 1j * damped * omega) - 1 / squares
    load = np.abs(driven.sum(axis=2) * receptance) * np.abs(shapes.T @ _loaded(study, curve))
    orders, most = load.argmax(axis=0), load.max(axis=0)
    return [
        _Shaken(float(np.sqrt(squares[r])), float(most[r]), int(orders[r]) + 1, int(np.abs(driven[orders[r], r]).argmax()))
        for r in np.flatnonzero(most >= _HARDLY * most.max())
    ]


def _loaded(study: TrainStudy, curve: CurveName) -> Floats:
    """Return the load of a curve (N or N·m) for a value of 1 of each coordinate (n,)."""
    system = study.system
    if curve.kind == "mesh":
        column = system.names[0].index(curve.name)
        return np.asarray(system.mesh[:, column] * system.stiffness[column], float)
    return system.shaft_torques[:, system.names[2].index(curve.name)]


# ---------------------------------------------------------------------- what is lacking


def _lacking(train: Train, modes: NaturalModes, mode: int, level: TrainModel, curve: CurveName) -> Iterator[Share]:
    """Yield the shares of a mode of the reference in parts that the level lacks.

    Of each shaft the level without shafts lacks mass and spring; only the greater share is given.
    """
    isolated = level is TrainModel.ISOLATED
    for name, moving, bent in zip(modes.shafts, modes.kinetic_shafts[mode], modes.potential_shafts[mode], strict=True):
        if isolated and bent > moving:
            yield Share("spring", name, float(bent))
        else:
            yield Share("mass", name, float(moving))
    if not isolated:
        return
    own = _own_gears(train, curve.name)
    behind = _shafts_between(train, own)
    for name, moving in zip(modes.inertias, modes.kinetic_inertias[mode], strict=True):
        if name not in own:
            yield Share("inertia", name, float(moving), behind[name])
    for mesh, bent in zip(train.meshes, modes.potential_meshes[mode], strict=True):
        if mesh.pinion not in own:
            yield Share("mesh", mesh.name, float(bent), min(behind[mesh.pinion], behind[mesh.wheel], key=len))


def _own_gears(train: Train, mesh: str) -> set[str]:
    """Return the names of the gears of a mesh and of those that mesh with them; they vibrate together without shafts."""
    own = set[str]()
    for each in train.meshes:
        if each.name == mesh:
            own |= set(each.gears)
    while more := {gear for each in train.meshes if own & set(each.gears) for gear in each.gears} - own:
        own |= more
    return own


def _shafts_between(train: Train, own: Set[str]) -> dict[str, tuple[str, ...]]:
    """Return for every inertia the shafts that join it to the `own` gears, on the way with the fewest parts."""
    ways: dict[str, tuple[str, ...]] = dict.fromkeys(sorted(own), ())
    waiting = deque(ways)
    while waiting:
        here = waiting.popleft()
        beside = [(shaft.name, {shaft.start, shaft.end}) for shaft in train.shafts if not shaft.held]
        beside += [("", set(mesh.gears)) for mesh in train.meshes]
        for name, ends in beside:
            for there in sorted(ends - {here, GROUND}) if here in ends else ():
                if there not in ways:
                    ways[there] = (*ways[here], name) if name else ways[here]
                    waiting.append(there)
    return ways


_DESCRIBED_MODES = 2
"""Number of modes that a sentence describes; tables have all of them."""


class LevelStatus(Enum):
    """Result of the verdict on a model."""

    ENOUGH = "enough"
    """All loads agree at all speeds."""
    NOT_ENOUGH = "not enough"
    """Some load is too small or too great at some speed."""
    OPEN = "not shown"
    """All loads agree where that can be judged, but it cannot be everywhere."""


class LevelResonance(NamedTuple):
    """A resonance of the reference, higher than the tolerance, at a `speed` (rpm), and the greatest K_v of the level `near` it.

    `own_speed` and `own_factor` are those of the level's resonance, None if it has none there. The resonance is `missed` if the
    level has none there and says too little.
    """

    mesh: str
    speed: float
    factor: float
    near: float
    own_speed: float | None
    own_factor: float | None
    missed: bool

    @property
    def moved(self) -> float | None:
        """Relative difference in speed of the level's resonance from that of the reference; None if the level has none."""
        return None if self.own_speed is None else self.own_speed / self.speed - 1

    def to_dict(self) -> JsonObject:
        """Return the entry of the resonance in `dynamics.json`."""
        return {**self._asdict(), "moved": self.moved}


@dataclass(frozen=True, kw_only=True, eq=False)
class LevelVerdict:
    """Verdict on a `model` compared with the `reference`: loads may differ by `tolerance`, in parts of the load at rest.

    `resonances` are those of the reference in the range; `decisions` say what the model lacks where it fails.
    """

    model: TrainModel
    reference: TrainModel
    tolerance: float
    agreement: Agreement
    resonances: tuple[LevelResonance, ...]
    decisions: tuple[Decision, ...]

    @property
    def status(self) -> LevelStatus:
        """Result of the verdict; `OPEN` if no load differs too much but not all can be judged."""
        if self.too_little is not None or self.too_much is not None:
            return LevelStatus.NOT_ENOUGH
        found = self.agreement
        unjudged = found.not_judged or found.unheld or found.doubts or not found.under
        return LevelStatus.OPEN if unjudged else LevelStatus.ENOUGH

    @property
    def too_little(self) -> Difference | None:
        """Greatest underestimate of a load, on the unsafe side; None if it is within the tolerance."""
        return self._beyond(self.agreement.underestimate)

    @property
    def too_much(self) -> Difference | None:
        """Greatest overestimate of a load, on the safe side; None if it is within the tolerance."""
        return self._beyond(self.agreement.overestimate)

    def _beyond(self, found: Difference | None) -> Difference | None:
        return found if found is not None and found.excess > self.tolerance else None

    @property
    def missed(self) -> tuple[LevelResonance, ...]:
        """Missed resonances, those that the model underestimates most first."""
        return tuple(sorted((each for each in self.resonances if each.missed), key=lambda each: each.near - each.factor))

    # ------------------------------------------------------------------ in words

    @property
    def sentence(self) -> str:
        """The verdict in one sentence, with its numbers."""
        return f'"{self.model.value}" {"; ".join(self._clauses())}'

    @property
    def headline(self) -> str:
        """First clause of the verdict's sentence; it names only the first failure."""
        first = next(self._clauses())
        if self.status is LevelStatus.NOT_ENOUGH:
            first = f"is not enough: {next(self._failures())}"
        return f'"{self.model.value}" {first}'

    def _clauses(self) -> Iterator[str]:
        name, of = f'"{self.reference.value}"', self.agreement
        if of.underestimate is None or of.overestimate is None:
            yield f"cannot be held against {name} at any of these speeds"
        elif self.status is LevelStatus.NOT_ENOUGH:
            yield f"is not enough: {', and '.join(self._failures())}"
            yield from self._reasons()
        else:
            open_words = "agrees where it can be judged" if self.status is LevelStatus.OPEN else "is enough"
            yield (
                f"{open_words}: its loads are at most {percent(max(of.underestimate.excess, 0.0))} of the load at rest below "
                f"those of {name}, and {percent(max(of.overestimate.excess, 0.0))} above"
            )
        if self.model is TrainModel.ISOLATED:
            yield "of shafts it says nothing"
        yield from self._gaps()

    def _failures(self) -> Iterator[str]:
        """Yield the failures in words, loads that are too small before those too great."""
        little, much, missed = self.too_little, self.too_much, self.missed
        if missed:
            yield self._missed_words()
        if little is not None and not any(_names(each, little) for each in missed[:1]):
            where = f"{_load(little.curve)} at {_rpm(little.speed)} is {little.greater:.3f}, not {little.other:.3f}"
            yield f"it says up to {percent(little.excess)} of the load too little ({where})"
        if much is not None:
            where = f"{_load(much.curve)} at {_rpm(much.speed)} is {much.other:.3f}, not {much.greater:.3f}"
            safe = ", which is on the safe side" if little is None else ""
            yield f"it says up to {percent(much.excess)} of the load too much{safe} ({where})"

    def _missed_words(self) -> str:
        first, *others = self.missed
        words = f"it misses the resonance of {first.mesh} at {_rpm(first.speed)} (K_v {first.factor:.3f}, not {first.near:.3f})"
        return words + (f" and {len(others)} other{'s' if len(others) > 1 else ''}" if others else "")

    def _reasons(self) -> Iterator[str]:
        """Yield in words what the model lacks, for the modes that decide most, each mode once."""
        first = {each.mode: each for each in reversed(self.decisions) if each.shares}
        for each in [each for each in self.decisions if first.get(each.mode) is each][:_DESCRIBED_MODES]:
            mode = f"at {_rpm(each.speed)} natural mode {each.mode} ({each.frequency:.5g} Hz) decides"
            yield f"{mode}, with {' and '.join(share.words for share in each.shares)}"

    def _gaps(self) -> Iterator[str]:
        """Yield in words what is not judged or not sure."""
        for each in self.agreement.not_judged:
            charts = f" in {' and '.join(each.charts)}" if len(each.charts) == 1 else ""
            yield f"not judged from {each.first:.5g} to {each.last:.5g} rpm: {each.reason.value}{charts}"
        if self.agreement.unheld:
            yield f"not judged: the overload of {', '.join(self.agreement.unheld)}, which only one of both has"
        for doubt in self.agreement.doubts:
            yield f"not sure: {doubt.words}, in {' and '.join(doubt.charts)}"

    def to_dict(self) -> JsonObject:
        """Return the entry of the verdict in `dynamics.json`."""
        return {
            "model": self.model.value,
            "status": self.status.value,
            "underestimates": [each.to_dict() for each in self.agreement.under],
            "overestimates": [each.to_dict() for each in self.agreement.over],
            "resonances": [each.to_dict() for each in self.resonances],
            "missed": [each.to_dict() for each in self.missed],
            "not_judged": [each.to_dict() for each in self.agreement.not_judged],
            "shafts_not_judged": list(self.agreement.unheld),
            "doubts": [each.to_dict() for each in self.agreement.doubts],
            "deciding": [each.to_dict() for each in self.decisions],
            "sentence": self.sentence,
        }


def _names(resonance: LevelResonance, difference: Difference) -> bool:
    """Return whether both belong to the same maximum."""
    near = abs(difference.speed / resonance.speed - 1) < 0.05
    return near and difference.curve == CurveName("mesh", resonance.mesh)


def _load(curve: CurveName) -> str:
    return f"K_v of {curve.name}" if curve.kind == "mesh" else f"the overload of shaft {curve.name}"


def _rpm(speed: float) -> str:
    return f"{speed:.5g} rpm"


_COARSEST_FIRST = (
    TrainModel.ISOLATED,
    TrainModel.MASSLESS,
    TrainModel.MODES,
    TrainModel.ELEMENTS,
    TrainModel.EXACT,
)


def finest_first(models: Iterable[TrainModel]) -> list[TrainModel]:
    """Return the models sorted by how much they represent of the shafts, the finest first."""
    return sorted(models, key=_COARSEST_FIRST.index, reverse=True)


@dataclass(frozen=True, kw_only=True, eq=False)
class LevelStudy(SideBySide):
    """Models of one train held against the finest of them, over the speeds at which it runs under load.

    A model is enough if, at every speed of that range, for K_v of every mesh and the overload of every shaft that it has:
    the reference's greatest load is at most `tolerance` above the greatest that the model has within `SHIFT` of that speed
    (else the model says too little), and the model's is at most `tolerance` above the greatest that the reference has there
    (else it says too much, which is on the safe side). Loads are the greater of running up and down, in parts of the
    reference's load at rest. A resonance is missed if K_v of the reference rises to it by more than the tolerance, the model
    says too little there by more than that, and has no maximum within 10 % of its speed. `verdicts` are of all models
    but the reference, the coarsest first.
    """

    over: OperatingRange
    tolerance: float
    verdicts: tuple[LevelVerdict, ...]

    @property
    def models(self) -> tuple[TrainModel, ...]:
        """Models in the order of the studies."""
        return tuple(study.train.model for study in self.studies)

    @property
    def reference(self) -> int:
        """Index of the finest model."""
        return self.models.index(finest_first(self.models)[0])

    @property
    def speed_tolerance(self) -> float:
        """Relative difference in speed that a resonance may have."""
        return SHIFT

    @property
    def enough(self) -> LevelVerdict | None:
        """Verdict on the coarsest model that is enough; None if only the reference is."""
        return next((each for each in self.verdicts if each.status is LevelStatus.ENOUGH), None)

    @property
    def idle_shafts(self) -> tuple[str, ...]:
        """Indices of the shafts that carry almost nothing at rest in some model; their overload has no meaning."""
        known = dict.fromkeys(name for study in self.studies for name in study.up.shaft_names)
        return tuple(name for name in known if name not in self.shaft_names)

    @property
    def sentence(self) -> str:
        """Text of all sentences: which model is enough, with its numbers, and what decides."""
        return " ".join(self.sentences)

    @property
    def sentences(self) -> tuple[str, ...]:
        """Sentences on the whole study, on each model, and on shafts that are not judged."""
        return self._said(f"{each.sentence}." for each in self.verdicts)

    @property
    def headlines(self) -> tuple[str, ...]:
        """The sentences with only the first clause on each model, for the screen."""
        return self._said(f"{each.headline}." for each in self.verdicts)

    @property
    def beyond_charts(self) -> tuple[NotJudged, ...]:
        """Parts of the operating range that the charts do not show."""
        found = (each for verdict in self.verdicts for each in verdict.agreement.not_judged if each.reason in OUTSIDE)
        return tuple({(each.first, each.last): each for each in found}.values())

    def _said(self, verdicts: Iterable[str]) -> tuple[str, ...]:
        """Return a sentence on the whole study with what is not judged, those on each model, and one on shafts not judged."""
        finest = f'"{self.models[self.reference].value}"'
        found = f"no model coarser than {finest} is shown to be enough"
        if self.enough is not None:
            found = f'the coarsest model that is enough is "{self.enough.model.value}"'
        allowed = f"within {100 * self.tolerance:.3g} % of the load at rest and {100 * self.speed_tolerance:.3g} % of the speed"
        gaps = [f"{each.first:.5g} to {each.last:.5g} rpm, {each.reason.value}" for each in self.beyond_charts]
        words = self.over.words[0].upper() + self.over.words[1:]
        over = f"{words}, of which not judged: {'; '.join(gaps)}" if gaps else words
        parts = [f"{over}, held against {finest}, {allowed}: {found}.", *verdicts]
        if self.idle_shafts:
            parts.append(f"Shafts that carry next to nothing at rest are not judged: {', '.join(self.idle_shafts)}.")
        return tuple(parts)

    def to_dict(self) -> JsonObject:
        """Return the document of the study for `dynamics.json`."""
        return {
            **super().to_dict(),
            "operating_range": self.over.to_dict(),
            "level_tolerance": self.tolerance,
            "speed_tolerance": self.speed_tolerance,
            "verdicts": [each.to_dict() for each in self.verdicts],
            "enough": None if self.enough is None else self.enough.model.value,
            "idle_shafts": list(self.idle_shafts),
            "sentence": self.sentence,
        }
