"""Charts of a System over speed: linear, or running up and down where flanks part, with every maximum between the speeds.

SI units; frequencies are circular tooth frequencies of the first mesh (1/s).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.records import Bools, Complexes, Floats, Indices, Notice
from gearcad.core.runtime import Share, onwards, part, unheard
from gearcad.dynamics.response.branch_continuation import Branch, trace
from gearcad.dynamics.response.harmonic_balance import Motions
from gearcad.dynamics.response.kv_chart import KvChart, chart_of, extremes, idle_shafts, kv_chart
from gearcad.dynamics.response.linear_response import UNSTABLE, growth, harmonic_orders, periodic_response
from gearcad.dynamics.response.run_up import TimeRun, TimeRuns, without_values
from gearcad.dynamics.response.speed_curves import (
    HIGHEST_SOUGHT,
    LEAST_RATIO,
    LEFT_OUT,
    BoundedExtremes,
    SpeedCurves,
    speeds_between,
)
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import (
    Direction,
    PeriodicResponse,
    Unstable,
    frequency_ranges,
    instability,
    parting,
)
from gearcad.rating.dynamic_factor import DynamicFactor


def left_out(curves: SpeedCurves, told: BoundedExtremes) -> tuple[Notice, ...]:
    """Return a notice where more harmonics would be needed to leave out at most a hundredth of the load."""
    short = told.left_out > LEFT_OUT
    if not short.any():
        return ()
    most = curves.most_orders // max(curves.excitation.orders)
    text = (
        f"more than {most} harmonics of the tooth frequency would be needed at tooth frequencies (1/s) "
        f"{frequency_ranges(told.frequencies, short)}: what is left out may be more than 1 % of the load"
    )
    return (Notice("harmonics-left-out", text),)


def standstill(curves: SpeedCurves) -> tuple[Notice, ...]:
    """Return a notice if loads do not approach those at rest, however slowly gears turn."""
    factor = curves.standstill
    if factor < 1 + LEFT_OUT:
        return ()
    text = (
        f"the stiffness of a mesh jumps where teeth come into mesh, at any speed at once: towards standstill K_v tends to "
        f"{factor:.3f}, not to 1"
    )
    return (Notice("stiffness-jumps", text),)


def not_looked_for(frequencies: Floats) -> tuple[Notice, ...]:
    """Return a notice of low speeds, between which one resonance follows another."""
    if not len(frequencies):
        return ()
    text = (
        f"up to a tooth frequency of {frequencies[-1]:.5g} 1/s resonances between the speeds are not looked for: they are met "
        f"there by harmonics beyond the {HIGHEST_SOUGHT}th"
    )
    return (Notice("low-resonances", text),)


def hardly_damped(curves: SpeedCurves, frequencies: Floats) -> tuple[Notice, ...]:
    """Return a notice of resonances that are narrower than those looked for."""
    sharp = curves.sharp(frequencies)
    if not len(sharp):
        return ()
    text = (
        f"natural frequencies of {', '.join(f'{each:.5g}' for each in sharp / (2 * np.pi))} Hz have a damping ratio below "
        f"{LEAST_RATIO:g}: their resonances are higher than shown, and a chart may pass them by"
    )
    return (Notice("hardly-damped", text),)


def in_time(frequencies: Floats, marked: Bools) -> tuple[Notice, ...]:
    """Return a notice of the frequencies (1/s) at which loads are those of motions integrated in time."""
    if not marked.any():
        return ()
    text = (
        f"flanks part at tooth frequencies (1/s) {frequency_ranges(frequencies, marked)}: the loads there are integrated in "
        "time, running up slowly from standstill and down from the last speed"
    )
    return (Notice("integrated-in-time", text),)


BY_TIME = 'more damping (damping_ratio), fewer speeds, or [dynamics.transient] or campbell = "on", which integrate in time,'
"""Inputs of pairs and trains that give loads where runs in time would take too long."""


def no_value(frequencies: Floats, marked: Bools, reason: str, remedies: str = BY_TIME) -> Notice:
    """Return the notice of the frequencies (1/s) at which no loads are given, why, and the inputs that give some."""
    places = frequencies[marked]
    text = (
        f"no loads at {len(places)} speeds between tooth frequencies of {places[0]:g} and {places[-1]:g} 1/s, where flanks "
        f"would part: {reason}; {remedies} give some"
    )
    return Notice("no-value", text)


def fixed_harmonics(period: int, harmonics: int) -> Notice:
    """Return the notice that the common period is too long to have all its orders."""
    text = (
        f"the teeth of all meshes come again after {period} teeth only: K_v holds {harmonics} harmonics of the "
        "tooth frequencies, and what is left out, and resonances between the speeds, are not looked for"
    )
    return Notice("long-period", text)


MOST_ROUNDS = 12
"""Greatest number of rounds of speeds between: each quarters the intervals about a maximum."""

_LEAST_HARMONICS = 12
"""Least number of harmonics of motions that are followed."""

_MOST_UNKNOWNS = 80
"""Largest number of harmonics, of all meshes together, of motions that are followed: the errors of 18 teeth would take minutes.
"""

_MARGIN = 0.9
"""Share of the lowest frequency at which flanks part at which a branch begins."""

_LOWER = 0.75
"""Part of the frequency that is tried next if a branch cannot be followed from there; the end goes up by the same ratio.

The end goes up if flanks are still parted at it.
"""

_TRACED, _TOLD = 0.4, 0.8
"""Shares of the work: until the branch is followed, and until the loads of its motions are known. No more than a guess."""

_FOLD_DISTANCE = 1e-6
"""Relative: how near to a fold the motions on both sides of a jump are shown."""


@dataclass(frozen=True, eq=False)
class Parted:
    """A branch, the loads `told` of each of its motions, and which of them (s,) are seen running up, and running down."""

    branch: Branch
    told: BoundedExtremes
    curves: SpeedCurves

    def seen(self, direction: Direction) -> tuple[BoundedExtremes, Bools, Floats]:
        """Return loads (s,) over the branch's frequencies, whether they last, and the frequencies (1/s) of jumps."""
        chosen, jumps = self._chosen(direction)
        return self.told.at(chosen), self.branch.stable[chosen], jumps

    def refined(self, share: Share) -> Parted:
        """Return the branch with speeds between added, until both directions show every maximum or `MOST_ROUNDS` are done."""
        of = self._with(_fold_neighbours(self.branch))
        for number in range(MOST_ROUNDS):
            share(1 - 0.5**number)
            curves = [of.curves.curves(of.seen(direction)[0]) for direction in Direction]
            more = speeds_between(of.branch.frequencies, np.hstack(curves), 4 * _FOLD_DISTANCE)
            if not len(more):
                break
            of = of._with(more)
        return of

    def _with(self, frequencies: Floats) -> Parted:
        more = np.setdiff1d(frequencies, self.branch.frequencies)
        if not len(more):
            return self
        others = self.branch.at(more)
        if not len(others.frequencies):
            return self
        joined = BoundedExtremes.joined(self.told, loads(others, self.curves))
        return Parted(self.branch.with_motions(others), joined, self.curves)

    def at_least(self, frequencies: Floats) -> Parted:
        """Return the branch with motions at those of the frequencies (x,) in 1/s that it goes through."""
        return self._with(np.array([each for each in frequencies.tolist() if self.holds(each)]))

    def holds(self, frequency: float) -> bool:
        """Return whether the branch goes through a frequency (1/s)."""
        return bool(self.branch.frequencies[0] <= frequency <= self.branch.frequencies[-1])

    def running_up(self, frequency: float) -> tuple[Branch, Indices]:
        """Return a branch and which (1,) of its motions is seen running up to a frequency (1/s)."""
        of = self._with(np.array([frequency]))
        chosen = of._chosen(Direction.UP)[0]
        return of.branch, chosen[of.branch.frequencies == frequency]

    def _chosen(self, direction: Direction) -> tuple[Indices, Floats]:
        """Return which motions (s,) are seen, and the frequencies (1/s) of jumps."""
        # Near a fold more harmonics may find no motion where fewer did: the fold is a little before.
        found = np.isfinite(self.told.left_out)
        return replace(self.branch, stable=self.branch.stable & found).seen(direction)


def parted(curves: SpeedCurves, frequencies: Floats, apart: Floats, *, share: Share = unheard) -> Parted:
    """Return the branch over rising frequencies (s,) through all at which flanks are `apart` (x,) in the linear motion.

    `apart` are also frequencies at which the linear motion does not last. Raises SolverError if there is no such branch.
    """
    ends = np.array([_MARGIN * apart[0], apart[-1] / _MARGIN])
    places = np.searchsorted(frequencies, ends) + np.array([-1, 0])
    low, high = (int(place) for place in np.clip(places, 0, len(frequencies) - 1))
    high = max(high, min(low + 1, len(frequencies) - 1))
    while True:
        along, harmonics = frequencies[low : high + 1], _harmonics(curves, float(frequencies[low]))
        try:
            branch = trace(curves.system, curves.excitation, along, harmonics=harmonics, share=part(share, 0.0, _TRACED))
        except SolverError:
            if low == 0:
                raise
            low = max(0, int(np.searchsorted(frequencies, _LOWER * frequencies[low])) - 1)
            continue
        found = Parted(branch, loads(branch, curves, part(share, _TRACED, _TOLD)), curves)
        if high == len(frequencies) - 1 or found.seen(Direction.UP)[0].least[-1].min() > 0:
            return found.refined(part(share, _TOLD, 1.0))
        high = min(int(np.searchsorted(frequencies, frequencies[high] / _LOWER)), len(frequencies) - 1)


def _harmonics(curves: SpeedCurves, frequency: float) -> int:
    """Return the number of harmonics of the tooth frequencies. Raises SolverError if these are too many unknowns."""
    meshes = len(curves.system.stiffness)
    wanted = float(curves.felt_orders(np.array([frequency]))[0]) / max(curves.excitation.orders)
    wanted = min(wanted, _MOST_UNKNOWNS)
    for count in range(max(int(np.ceil(wanted)), _LEAST_HARMONICS), _LEAST_HARMONICS - 1, -1):
        unknowns = meshes * len(harmonic_orders(curves.excitation, count))
        if unknowns <= _MOST_UNKNOWNS:
            return count
    errors = any(mesh.error is not None and mesh.error.teeth > 1 for mesh in curves.excitation.meshes)
    fewer = "leave tooth errors out" if errors else "give tooth numbers with which all comes again sooner"
    raise SolverError(f"motions in which they part would have {unknowns} harmonics here; {fewer} to see them")


def loads(branch: Branch, curves: SpeedCurves, share: Share = unheard) -> BoundedExtremes:
    """Return the loads of every motion of a branch, with as many harmonics as it needs, or its own where these lead astray."""
    start, frequencies = branch.coefficients(), branch.frequencies[branch.index]
    told = curves.told(frequencies, start, share)[0]
    astray = np.flatnonzero(np.isinf(told.left_out))
    if not len(astray):
        return told
    own = extremes(branch.response(astray), curves.references[1], curves.tracked)
    instead = BoundedExtremes.of(own, frequencies[astray], np.full(len(astray), np.inf))
    rows = np.arange(len(frequencies))
    rows[astray] = len(frequencies) + np.arange(len(astray))
    return BoundedExtremes.joined(told, instead).at(rows)


def _fold_neighbours(branch: Branch) -> Floats:
    """Return frequencies (1/s) close to both sides of the folds."""
    near = np.concatenate([branch.folds * (1 - _FOLD_DISTANCE), branch.folds * (1 + _FOLD_DISTANCE)])
    return np.unique(near[(near > branch.frequencies[0]) & (near < branch.frequencies[-1])])


_PILOTS = 48
"""Number of speeds at which idle shafts are looked for."""

_DRAWN = 256
"""Harmonics of a motion that is drawn: flanks that touch again do so within a hundredth of a tooth."""

_LINEAR, _ASKED = 0.2, 0.5
"""Shares of the work: of linear motions where flanks may part, and of the speeds asked for. No more than a guess."""

_BESIDE, _AGREE, _JUMP = 0.012, 0.03, 0.15
"""Relative: how near to a speed a branch may have the load of a run, how far both may differ, and what step of it is a jump."""

_CLOSE = 0.01
"""Relative: speeds so near to a resonance of a low harmonic are looked at, however many high ones there are."""


@dataclass(frozen=True, eq=False)
class OverSpeed:
    """Charts `up` and, where flanks part, `down`, with the frequencies (1/s) of the `jumps` of both, and notices.

    They were found by `curves` of flanks that stick to each other, and a `branch` where those of the `excitation` part.
    """

    excitation: Excitation
    up: KvChart
    down: KvChart | None
    jumps: tuple[Floats, Floats]
    notices: tuple[Notice, ...]
    curves: SpeedCurves
    branch: Parted | None
    runs: TimeRuns | None = None
    """Runs in time, where the charts are those of these."""

    def response(self, frequency: float) -> PeriodicResponse:
        """Return the response seen running up to any one frequency (1/s), with enough harmonics to draw it over time.

        It is as stable as the same motion is in the chart.
        """
        places = np.array([frequency])
        if not self.curves.resolvable:
            return periodic_response(self.curves.system, self.curves.excitation, places, harmonics=self.curves.few)
        near = int(np.abs(self.up.frequencies - frequency).argmin())
        if self.runs is not None and self.down is not None and (self.up.least[near] <= 0).any():
            return self.runs.response(frequency, min(_DRAWN * max(self.excitation.orders), self.curves.most_orders))
        if self.branch is None or not self.branch.holds(frequency):
            stable = growth(self.curves.system, self.curves.excitation, places) <= UNSTABLE
            return replace(self.curves.response(self._motion(self.curves, frequency)), stable=stable)
        branch, row = self.branch.running_up(frequency)
        motion = self._motion(self.branch.curves, frequency, branch.coefficients()[row])
        if not motion.solved.all():
            return branch.response(row)
        return replace(self.branch.curves.response(motion), stable=branch.stable[row])

    def _motion(self, curves: SpeedCurves, frequency: float, start: Complexes | None = None) -> Motions:
        """Return the motion at a frequency (1/s) with the harmonics needed to draw it."""
        places = np.array([frequency])
        wanted = max(int(curves.orders(places)[0]), _DRAWN * max(curves.excitation.orders))
        balance = curves.balance(min(wanted, curves.most_orders))
        (motion,) = balance.solve(curves.excitation.fundamental * places, start)
        return motion


def over_speed(
    system: System,
    excitation: Excitation,
    frequencies: Floats,
    *,
    harmonics: int | None = None,
    method_b: DynamicFactor | None = None,
    remedies: str = BY_TIME,
    share: Share = unheard,
) -> OverSpeed:
    """Return charts at rising `frequencies` and as many between them as their curves need.

    `harmonics` of the tooth frequencies at most; else as many as leave out less than a hundredth of the load at rest.
    `remedies` are the inputs that give loads where runs in time would take too long. `share` receives how much is done.
    """
    share = onwards(share)
    excitation.fits(system)
    linear = _curves(system, excitation.bonded, frequencies, harmonics)
    if not linear.resolvable:
        return _few(linear, excitation, frequencies, method_b)
    told, skipped = _refined(linear, frequencies, part(share, 0.0, _LINEAR if excitation.parting else 1.0))
    stable = growth(system, linear.excitation, told.frequencies) <= UNSTABLE
    apart = np.asarray((told.least <= 0).any(axis=1), bool)
    sides, runs = [(told, stable, np.zeros(0))], None
    branch, notices = None, (*standstill(linear), *hardly_damped(linear, told.frequencies), *not_looked_for(skipped))
    if excitation.parting and (apart | ~stable).any():
        curves = SpeedCurves(system, excitation, harmonics, linear.idle)
        try:
            rest = part(share, _LINEAR, 1.0)
            branch = parted(curves, frequencies, told.frequencies[apart | ~stable], share=rest)
        except SolverError:
            branch = None
        sides, runs, more = _by_runs(linear, excitation, frequencies, told, stable, branch, remedies)
        branch, notices = (branch if runs is None else None), (*notices, *more)
    elif apart.any():
        notices = (*notices, parting(told.frequencies, apart))
    share(1.0)
    if branch is not None:
        sides = [_together(told, stable, branch, direction) for direction in (Direction.UP, Direction.DOWN)]
    told_unstable = Unstable.IN_TIME if runs is not None else Unstable.PARTING if excitation.parting else Unstable.LINEAR
    charts = [_chart(linear, each, lasting, method_b, told_unstable) for each, lasting, _ in sides]
    return OverSpeed(
        excitation=excitation,
        up=charts[0],
        down=charts[1] if len(charts) > 1 else None,
        jumps=(sides[0][2], sides[-1][2]),
        notices=notices,
        curves=linear,
        branch=branch,
        runs=runs,
    )


_Side = tuple[BoundedExtremes, Bools, Floats]
"""Loads, whether motions last, and frequencies of jumps."""


def _by_runs(
    linear: SpeedCurves,
    excitation: Excitation,
    frequencies: Floats,
    told: BoundedExtremes,
    stable: Bools,
    branch: Parted | None,
    remedies: str,
) -> tuple[list[_Side], TimeRuns | None, tuple[Notice, ...]]:
    """Return charts by runs in time unless the branch shows the same; without values where runs take too long."""
    runs = TimeRuns(linear, excitation, float(frequencies[-1]))
    flagged = runs.parts(told)
    reason = runs.reason(int(np.isin(frequencies, told.frequencies[flagged]).sum()))
    if not reason:
        try:
            both = runs.both
            if branch is not None and all(_same(runs, run, branch, frequencies) for run in both):
                return [], None, ()
            wanted = _speeds_of(runs, both, frequencies, told.frequencies[~flagged])
            places = np.setdiff1d(wanted, told.frequencies)
            contact = BoundedExtremes.joined(told, linear.told(places)[0]).rising() if len(places) else told
            contact = contact.at(np.flatnonzero(np.isin(contact.frequencies, wanted)))
            parting_there = runs.parts(contact)
            sides, shown = list[_Side](), np.zeros(len(contact.frequencies), bool)
            for run in both:
                found, by_time, repeats = runs.told(run, contact, parting_there)
                jumps = _run_jumps(runs, run)
                sides.append((found, repeats, jumps[(jumps >= frequencies[0]) & (jumps <= frequencies[-1])]))
                shown |= by_time
            return sides, runs, in_time(contact.frequencies, shown)
        except SolverError as error:
            reason = str(error)
    empty = without_values(told, np.flatnonzero(flagged))
    return [(empty, stable | flagged, np.zeros(0))], runs, (no_value(told.frequencies, flagged, reason, remedies),)


def _speeds_of(runs: TimeRuns, both: tuple[TimeRun, TimeRun], frequencies: Floats, contact: Floats) -> Floats:
    """Return the frequencies (1/s) asked for, those of motions in `contact`, and the rungs at which flanks part in a run."""
    nonlinear = np.any([run.nonlinear for run in both], axis=0)
    near = runs.rungs[nonlinear & (runs.rungs > frequencies[0]) & (runs.rungs < frequencies[-1])]
    place = np.clip(np.searchsorted(runs.rungs, contact) - 1, 0, len(runs.rungs) - 2)
    outside = contact[~(nonlinear[place] | nonlinear[place + 1])]
    return np.union1d(np.union1d(frequencies, near), outside)


def _same(runs: TimeRuns, run: TimeRun, branch: Parted, asked: Floats) -> bool:
    """Return whether a branch has the loads of a run at all its rungs within the frequencies `asked` (s,) in 1/s."""
    seen = branch.at_least(runs.rungs[run.nonlinear]).seen(run.direction)[0]
    forces = np.abs(runs.linear.system.stiffness * runs.linear.static.approach)
    for k, frequency in enumerate(runs.rungs.tolist()):
        if not run.nonlinear[k]:
            continue
        if not branch.holds(frequency):
            if asked[0] <= frequency <= asked[-1]:
                return False
            continue
        near = np.abs(seen.frequencies / frequency - 1) < _BESIDE
        if not near.any():
            continue
        most, own = seen.most[near] / forces, run.most[k] / forces
        if (own > most.max(axis=0) * (1 + _AGREE)).any() or (own < most.min(axis=0) * (1 - _AGREE)).any():
            return False
    return True


def _run_jumps(runs: TimeRuns, run: TimeRun) -> Floats:
    """Return the frequencies (1/s) at which loads of a run jump, in its order."""
    order = slice(None) if run.direction is Direction.UP else slice(None, None, -1)
    most, rungs = run.most[order], runs.rungs[order]
    nonlinear = run.nonlinear[order]
    step = np.abs(np.diff(most, axis=0)) > _JUMP * np.minimum(most[1:], most[:-1])
    return np.asarray(rungs[1:][step.any(axis=1) & (nonlinear[1:] | nonlinear[:-1])], float)


def _curves(system: System, excitation: Excitation, frequencies: Floats, harmonics: int | None) -> SpeedCurves:
    """Return the curves, with the shafts that some of the frequencies show to be idle."""
    curves = SpeedCurves(system, excitation, harmonics)
    if not curves.resolvable or np.isnan(curves.references[0]).all():
        return curves
    pilots = frequencies[np.unique(np.linspace(0, len(frequencies) - 1, _PILOTS).astype(int))]
    few = 2 * max(excitation.orders)
    torques = [curves.loads(each).torques for each in curves.balance(few).solve(excitation.fundamental * pilots)]
    return SpeedCurves(system, excitation, harmonics, idle_shafts(np.concatenate(torques), curves.references[0]))


def _refined(curves: SpeedCurves, frequencies: Floats, share: Share) -> tuple[BoundedExtremes, Floats]:
    """Return loads at the frequencies, where resonances are narrower than their distance, and where maxima are sharper.

    Returns also the frequencies (x,) at which there might be sharper maxima, but that are too low to look for them.
    """
    told, narrow = curves.told(frequencies, share=part(share, 0.0, _ASKED))
    skipped, more = np.zeros(0), narrow
    for number in range(MOST_ROUNDS):
        more = np.setdiff1d(np.union1d(more, speeds_between(told.frequencies, curves.curves(told))), told.frequencies)
        searched = curves.searched(more) | _near(more, narrow)
        skipped, more = np.union1d(skipped, more[~searched]), more[searched]
        if not len(more):
            break
        told, more = BoundedExtremes.joined(told, curves.told(more, share=_round_of(share, number))[0]).rising(), np.zeros(0)
    return told, skipped


def _round_of(share: Share, number: int) -> Share:
    """Return the share of a round of speeds between: each round takes half of the rest."""
    return part(share, 1 - (1 - _ASKED) / 2**number, 1 - (1 - _ASKED) / 2 ** (number + 1))


def _near(frequencies: Floats, places: Floats) -> Bools:
    """Return whether (s,) the frequencies lie close to any of the places (p,)."""
    known = np.sort(places)
    after = np.searchsorted(known, frequencies)
    beside = np.stack([np.concatenate([[-np.inf], known, [np.inf]])[after + side] for side in (0, 1)])
    return np.asarray((np.abs(beside - frequencies) <= _CLOSE * frequencies).any(axis=0), bool)


def _together(
    told: BoundedExtremes, stable: Bools, branch: Parted, direction: Direction
) -> tuple[BoundedExtremes, Bools, Floats]:
    """Return the linear motions outside the branch together with the motions of the branch."""
    inside, lasting, jumps = branch.seen(direction)
    outside = (told.frequencies < inside.frequencies[0]) | (told.frequencies > inside.frequencies[-1])
    joined = BoundedExtremes.joined(told.at(np.flatnonzero(outside)), inside)
    order = np.argsort(joined.frequencies, kind="stable")
    return joined.at(order), np.concatenate([stable[outside], lasting])[order], jumps


def _chart(
    curves: SpeedCurves, told: BoundedExtremes, stable: Bools, method_b: DynamicFactor | None, unstable: Unstable
) -> KvChart:
    return chart_of(
        curves.system,
        curves.static,
        told.frequencies,
        told,
        curves.tracked,
        orders_per_tooth=curves.excitation.orders[0],
        method_b=method_b,
        stable=stable,
        notices=(*instability(told.frequencies, stable, unstable), *left_out(curves, told)),
    )


def _few(curves: SpeedCurves, excitation: Excitation, frequencies: Floats, method_b: DynamicFactor | None) -> OverSpeed:
    """Return charts with a fixed number of harmonics, at these frequencies only."""
    found = periodic_response(curves.system, curves.excitation, frequencies, harmonics=curves.few)
    notice = fixed_harmonics(max(curves.excitation.orders), curves.few)
    return OverSpeed(excitation, kv_chart(found, method_b=method_b), None, (np.zeros(0), np.zeros(0)), (notice,), curves, None)
