"""Curves of the greatest loads over speed, with the harmonics and the speeds that resonances need.

SI units; frequencies are circular tooth frequencies of the first mesh (1/s), omega those of the common period. Resonances are
found from the modes at the mean stiffness of the meshes; damping couples these little where resonances are narrow.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.core.records import Bools, Complexes, Floats, Indices
from gearcad.core.runtime import Share, unheard
from gearcad.dynamics.response.harmonic_balance import Motions, Resolution
from gearcad.dynamics.response.kv_chart import Extremes, extremes, torque_references
from gearcad.dynamics.trains.mesh_excitation import Excitation
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import Driven, PeriodicResponse, StaticState, outputs_of

LEAST_RATIO = 5e-4
"""Least damping ratio of the search. Modes with less are treated as having this ratio, so narrower resonances are not searched.
"""

FELT = 0.002
"""Part of the load at rest below which vibrations are not looked for."""

_SAMPLES = 4096
"""Number of samples of the quasi-static forces over a tooth."""


@dataclass(frozen=True, eq=False)
class Resonances:
    """Resonances of the elastic modes: natural frequencies `omega` (r,) in 1/s and damping ratios `ratio` (r,).

    `mesh` (r, m) are the shares that forces at the meshes (N) have in each mode. `told` (r,) is the greatest part of its load
    at rest by which a mesh or a shaft is loaded when the mode's coordinate is 1.
    """

    omega: Floats
    ratio: Floats
    mesh: Floats
    told: Floats
    shapes: Floats
    """The modes (n, r), of modal mass 1."""
    sharp: Bools
    """Marks (r,) of modes that are damped so little that they are taken to have more damping."""


def resonances(system: System, static: StaticState, references: Floats) -> Resonances:
    """Return the resonances of a System.

    `references` (s,) in N·m are the torques with which those of shafts are compared, nan where there is none.
    """
    squares, modes = np.linalg.eigh(system.stiffness_matrix())
    kept = squares > 1e-9 * squares.max()
    squares, modes = squares[kept], modes[:, kept]
    damping = np.einsum("nr,nk,kr->r", modes, system.damping_matrix(), modes)
    mesh = modes.T @ system.mesh
    own = mesh * system.stiffness / np.maximum(np.abs(system.stiffness * static.approach), 1e-300)
    shafts = (modes.T @ system.shaft_torques) / references
    told = np.nan_to_num(np.abs(np.hstack([own, shafts])), nan=0.0).max(axis=1)
    omega = np.sqrt(squares)
    ratio = damping / (2 * omega)
    return Resonances(omega, np.maximum(ratio, LEAST_RATIO), mesh, told, modes, ratio < LEAST_RATIO)


def settled(system: System, static: StaticState, stiffness: Floats, errors: Floats) -> Floats:
    """Return approaches (t, m) at rest, in contact, with stiffnesses (t, m) in N/m and errors (t, m), both in m."""
    matrix = np.eye(stiffness.shape[1]) + static.unit_mesh * (stiffness - system.stiffness)[:, None, :]
    right = static.approach + (stiffness * errors) @ static.unit_mesh.T
    return np.asarray(np.linalg.solve(matrix, right[:, :, None])[:, :, 0], float)


def quasi_static_spectrum(system: System, excitation: Excitation, static: StaticState) -> Complexes:
    """Return the amplitudes (q, m) in N that drive vibrations of each order of the common period at the least speeds."""
    count = _SAMPLES * max(excitation.orders)
    stiffness, errors = (
        excitation.ratios(2 * np.pi * np.arange(count) / count) * system.stiffness,
        excitation.error_course(count),
    )
    approach = settled(system, static, stiffness, errors)
    forces = system.stiffness * approach - stiffness * (approach - errors)
    spectrum = 2 * np.fft.rfft(forces, axis=0, norm="forward")
    spectrum[0] = 0.0
    return np.asarray(spectrum, complex)


def quasi_static_forces(system: System, excitation: Excitation, static: StaticState) -> Floats:
    """Return the amplitudes (q, m) in N that drive each order of the common period, or any higher one, at the least speeds."""
    spectrum = np.abs(quasi_static_spectrum(system, excitation, static))
    return np.asarray(np.maximum.accumulate(spectrum[::-1], axis=0)[::-1], float)


_ABOVE = 0.002
"""Part of a maximum by which a parabola through three points may rise above them."""

_FALL = 0.03
"""Part of a maximum by which its neighbours may lie below it, so that a parabola says something."""

_BEND = 0.02
"""Part of a value by which it may lie off the straight line between its neighbours."""

NARROWEST = 1e-4
"""Relative: intervals below that are not divided. Resonances with a damping ratio of 0.0005 are ten such intervals wide."""


def speeds_between(speeds: Floats, curves: Floats, narrowest: float = NARROWEST) -> Floats:
    """Return speeds (x,) at which curves (s, c) over rising speeds (s,) may hide more than a hundredth of a maximum.

    All values of the curves are positive. Over less than `narrowest` of a speed curves may jump: values beyond tell nothing
    there.
    """
    if len(speeds) < 3 or not curves.shape[1]:
        return np.zeros(0)
    steps = np.diff(speeds)
    wide = steps > narrowest * speeds[1:]
    tops, bends = _tops(steps, curves, wide), _bends(steps, curves) & wide[:-1] & wide[1:]
    fine, coarse = (np.concatenate([each, [False]]) | np.concatenate([[False], each]) for each in (tops, bends))
    parts = [(fine, (0.25, 0.5, 0.75)), (coarse & ~fine, (0.5,))]
    found = [speeds[:-1][which & wide] + part * steps[which & wide] for which, shares in parts for part in shares]
    return np.unique(np.concatenate(found))


def _tops(steps: Floats, curves: Floats, wide: Bools) -> Bools:
    """Return whether (s - 2,) a maximum at the inner speeds may be more than the value there."""
    here, sides = curves[1:-1], (wide[:-1, None], wide[1:, None])
    rise, fall = (np.where(side, here - beside, 0.0) for side, beside in zip(sides, (curves[:-2], curves[2:]), strict=True))
    before, after = steps[:-1, None], steps[1:, None]
    # A parabola through three points, from the one in the middle: slope and bend.
    bend = (rise / before + fall / after) / (before + after)
    slope = rise / before - bend * before
    above = np.divide(slope**2, 4 * bend, out=np.zeros_like(bend), where=(bend > 0) & sides[0] & sides[1])
    rough = (above > _ABOVE * here) | (np.maximum(rise, fall) > _FALL * here)
    return np.asarray(((rise >= 0) & (fall >= 0) & rough).any(axis=1), bool)


def _bends(steps: Floats, curves: Floats) -> Bools:
    """Return whether (s - 2,) values at the inner speeds are far from the straight lines between their neighbours."""
    share = (steps[:-1] / (steps[:-1] + steps[1:]))[:, None]
    straight = (1 - share) * curves[:-2] + share * curves[2:]
    return np.asarray((np.abs(curves[1:-1] - straight) > _BEND * curves[1:-1]).any(axis=1), bool)


MOST_ORDERS = 2048
"""Greatest number of orders of the common period that are brought into balance."""

_LEAST_HARMONICS, _LEAST_PARTING = 8, 32
"""Least harmonics of each tooth frequency, and of one where flanks part, because the time of parting must be resolved."""

_BEYOND_TORQUES = 2
"""Least number of orders over that of a torque on an inertia: the teeth make sidebands of it."""

_FEW = 6
"""Harmonics where the common period is too long to have all its orders."""

LEFT_OUT = 0.01
"""Part of a load that harmonics left out may carry; there are twice as many harmonics where it may be half of that."""

_REMAINDER = (0.0, 0.243, 0.352, 0.5, 1.0), (0.0, 1 / 7, 1 / 3, 1.0, 10.0)
"""Of waves that fall as a power of the order: those of orders 1.5 to 2 over those of 1 to 1.5, and what follows from 2 on over
both: of the fourth, third and second power, and of such as hardly fall."""


HIGHEST_SOUGHT = 64
"""Harmonic up to which resonances between speeds are looked for: there are so many of higher ones, each hardly felt."""

_TRACKED, _MOST_TRACKED = 64, 1024
"""Harmonics of the tooth frequencies, and orders of the common period, up to which amplitudes of the approach are told."""

_APART = 0.5
"""Half widths of resonances of neighbouring orders, over their distance, from which on they merge."""


@dataclass(frozen=True, eq=False)
class BoundedExtremes(Extremes):
    """Extremes at `frequencies` (s,), with bounds `left_out` (s,) of the share that harmonics left out have in forces and
    torques.

    A bound is infinite where no balance was found.
    """

    frequencies: Floats
    left_out: Floats

    @staticmethod
    def of(found: Extremes, frequencies: Floats, left_out: Floats) -> BoundedExtremes:
        """Return the extremes with their frequencies and bounds."""
        return BoundedExtremes(**vars(found), frequencies=frequencies, left_out=left_out)

    def rising(self) -> BoundedExtremes:
        """Return the same in order of rising frequencies."""
        return self.at(np.argsort(self.frequencies, kind="stable"))


@dataclass(frozen=True, eq=False)
class SpeedCurves(Driven):
    """Loads of a System over speed; `harmonics` of the tooth frequencies at most, where they are given.

    `idle` (n,): shafts that carry next to nothing at rest, so that their torque is held against nothing.
    """

    harmonics: int | None = None
    idle: Bools | None = None

    @cached_property
    def references(self) -> tuple[Floats, Floats]:
        """Torques of the shafts at rest (N·m), nan where they carry none, and the sense in which they act."""
        references, senses = torque_references(self.static.others[self.system.torque_outputs])
        return references if self.idle is None else np.where(self.idle, np.nan, references), senses

    @cached_property
    def modes(self) -> Resonances:
        return resonances(self.system, self.static, self.references[0])

    @cached_property
    def most_orders(self) -> int:
        """Greatest number of orders that may be brought into balance."""
        return MOST_ORDERS if self.harmonics is None else self.harmonics * max(self.excitation.orders)

    @cached_property
    def resolvable(self) -> bool:
        """Whether the common period is short enough to have all its orders."""
        torques = _BEYOND_TORQUES * max(self.excitation.torque_orders, default=0)
        return max(_LEAST_HARMONICS * max(self.excitation.orders), torques) <= MOST_ORDERS

    @cached_property
    def tolerance(self) -> float:
        """Tolerance of the balance: a resonance magnifies the residual, and crests are some times the root mean square."""
        return float(np.clip(3e-4 * self.modes.ratio.min(initial=1.0), 1e-9, 2e-5))

    @cached_property
    def driving(self) -> Floats:
        return quasi_static_forces(self.system, self.excitation, self.static)

    @property
    def few(self) -> int:
        """Number of harmonics of the tooth frequencies where the common period is too long to have all its orders."""
        return _FEW if self.harmonics is None else self.harmonics

    def orders(self, frequencies: Floats) -> Indices:
        """Return the number of orders (s,) that is tried first: powers of 2 of harmonics."""
        least, most = _LEAST_PARTING if self.excitation.parting else _LEAST_HARMONICS, max(self.excitation.orders)
        beyond = max(least, _BEYOND_TORQUES * max(self.excitation.torque_orders, default=0) / most)
        harmonics = 2 ** np.ceil(np.log2(np.maximum(self.felt_orders(frequencies) / most, beyond))).astype(int)
        return np.asarray(np.minimum(harmonics * most, self.most_orders), np.intp)

    def felt_orders(self, frequencies: Floats) -> Floats:
        """Return twice the highest order (s,) of a resonance that could be felt."""
        met = self.modes.omega / (self.excitation.fundamental * frequencies[:, None])
        return np.asarray(np.where(self._felt(met), 2 * met, 0.0).max(axis=1, initial=0.0), float)

    def searched(self, frequencies: Floats) -> Bools:
        """Return whether (s,) resonances between the speeds are looked for."""
        return self.felt_orders(frequencies) <= 2 * HIGHEST_SOUGHT * max(self.excitation.orders)

    def sharp(self, frequencies: Floats) -> Floats:
        """Return natural frequencies (1/s) of modes that could be felt at any of the frequencies, but are hardly damped."""
        met = self.modes.omega / (self.excitation.fundamental * frequencies[:, None])
        return self.modes.omega[self._felt(met).any(axis=0) & self.modes.sharp]

    def _felt(self, orders: Floats) -> Bools:
        """Return whether modes vibrate noticeably where they meet the orders (..., r)."""
        modes = self.modes
        forces = self.driving[np.minimum(orders, len(self.driving) - 1).astype(int)]
        driven = np.einsum("...rm,rm->...r", forces, np.abs(modes.mesh))
        if self.excitation.torques:
            reached = orders <= _BEYOND_TORQUES * max(self.excitation.torque_orders)
            driven = driven + np.where(reached, self._by_torques.max(axis=0, initial=0.0), 0.0)
        # A step drives as many orders at once as lie within the width of a resonance.
        magnified = np.maximum(1 / (2 * modes.ratio), orders)
        amplitudes = modes.told / modes.omega**2 * driven * magnified
        return np.asarray(amplitudes > FELT, bool)

    @cached_property
    def _by_torques(self) -> Floats:
        """Amplitudes (t, r) with which torques on inertias drive each mode, at each of their orders."""
        return 2 * np.abs(self.excitation.torque_vectors(self.system)[1] @ self.modes.shapes)

    @cached_property
    def standstill(self) -> float:
        """Limit of K_v at the least speeds: where the stiffness jumps, flanks keep their approach, so forces jump."""
        jumps, little = self.excitation.jumps, 1e-9
        if not len(jumps):
            return 1.0
        before, after = (
            (self.excitation.ratios(jumps + side), self.excitation.errors(jumps + side)) for side in (-little, little)
        )
        approach = settled(self.system, self.static, before[0] * self.system.stiffness, before[1])
        force = np.abs(after[0] * self.system.stiffness * (approach - after[1]))
        return float((force / np.abs(self.system.stiffness * self.static.approach)).max())

    # ------------------------------------------------------------------ motions

    def motions(self, frequencies: Floats, start: Complexes | None = None) -> Iterator[tuple[Indices, Motions, Floats]]:
        """Yield which of the frequencies (s,), their motions, and a bound (s,) of what is left out; from `start` (s, q, m)."""
        waiting, orders = np.arange(len(frequencies)), self.orders(frequencies)
        while len(waiting):
            count = int(orders[waiting].min())
            now = waiting[orders[waiting] == count]
            waiting = waiting[orders[waiting] != count]
            balance, place = self.balance(count), 0
            for found in balance.solve(self.excitation.fundamental * frequencies[now], None if start is None else start[now]):
                which = now[place : place + len(found.omega)]
                place += len(which)
                left = self._left_out(found)
                more = (left > LEFT_OUT / 2) & found.solved & (2 * count <= self.most_orders)
                orders[which[more]] = 2 * count
                waiting = np.concatenate([waiting, which[more]])
                if not more.all():
                    yield which[~more], found.only(~more), left[~more]

    def balance(self, orders: int) -> Resolution:
        """Return the balance with that number of orders of the common period."""
        return Resolution(self.system, self.excitation, orders, self.tolerance)

    @cached_property
    def tracked(self) -> Indices:
        """Orders (k,) of the common period whose amplitudes are given."""
        return np.arange(1, min(_TRACKED * max(self.excitation.orders), _MOST_TRACKED) + 1)

    def loads(self, motions: Motions) -> Extremes:
        """Return the greatest and least values of all outputs of the motions."""
        return extremes(self.response(motions), self.references[1], self.tracked, 16 * motions.orders)

    def response(self, motions: Motions) -> PeriodicResponse:
        """Return the response of the motions, with turns and torques."""
        pushed = self.pushed(motions.omega, np.arange(2 * motions.orders + 1))
        outputs = outputs_of(self.system, self.static, motions.flexible, motions.forces, pushed)
        return PeriodicResponse(
            system=self.system,
            excitation=self.excitation,
            frequencies=motions.omega / self.excitation.fundamental,
            harmonics=np.arange(2 * motions.orders + 1),
            approach_coefficients=motions.approach,
            inertia_coefficients=outputs.turns,
            torque_coefficients=outputs.torques,
            travel_coefficients=outputs.travels,
            stable=np.ones(len(motions.omega), bool),
        )

    def _left_out(self, motions: Motions) -> Floats:
        """Return a bound (s,) of the waves that are left out, over the greatest wave or the load at rest.

        The bound is that of the waves of orders beyond those known, all crests at once.
        """
        others = motions.flexible.others[:, :, self.system.torque_outputs]
        at_rest = (np.abs(self.system.stiffness * self.static.approach) / self._stiffest, self.references[0])
        torques = np.einsum("shij,shj->shi", others, motions.forces)
        if self.excitation.torques:
            pushed = self.pushed(motions.omega, np.arange(2 * motions.orders + 1))
            torques[:, pushed.rows] += pushed.others[:, :, self.system.torque_outputs]
        result, start, middle = np.zeros(len(motions.omega)), motions.orders, motions.orders * 3 // 2
        for waves, rest in zip((motions.approach, torques), at_rest, strict=True):
            sizes = 2 * np.abs(waves[:, 1:])
            whole = np.where(np.isnan(rest), np.inf, np.fmax(sizes.max(axis=1), rest))
            first, second = sizes[:, start:middle].sum(axis=1), sizes[:, middle:].sum(axis=1)
            fall = np.divide(second, first, out=np.zeros_like(first), where=first > 0)
            left = (first + second) / whole * np.interp(fall, *_REMAINDER)
            result = np.maximum(result, left.max(axis=1, initial=0.0))
        return np.asarray(np.where(motions.solved, result, np.inf), float)

    @cached_property
    def _stiffest(self) -> Floats:
        theta = 2 * np.pi * np.arange(1024 * max(self.excitation.orders)) / (1024 * max(self.excitation.orders))
        return np.asarray(self.excitation.ratios(theta).max(axis=0) * self.system.stiffness, float)

    # ------------------------------------------------------------------ what is told of them

    def told(
        self, frequencies: Floats, start: Complexes | None = None, share: Share = unheard
    ) -> tuple[BoundedExtremes, Floats]:
        """Return loads at frequencies (s,), and frequencies (x,) of resonances between these that a chart would not show."""
        done = 0
        order, parts, narrow = [np.zeros(0, np.intp)], [], [np.zeros(0)]
        for which, motions, left in self.motions(frequencies, start):
            parts.append(BoundedExtremes.of(self.loads(motions), frequencies[which], left))
            narrow.append(self._narrow(motions, frequencies))
            order.append(which)
            done += len(which)
            share(done / len(frequencies))
        return BoundedExtremes.joined(*parts).at(np.argsort(np.concatenate(order))), np.concatenate(narrow)

    def curves(self, told: BoundedExtremes) -> Floats:
        """Return the curves (s, c) of a chart: loads over those at rest, of meshes and of the shafts that carry some."""
        forces = np.abs(self.system.stiffness * self.static.approach)
        kept = np.isfinite(self.references[0])
        return np.hstack([told.most / forces, told.torques[:, kept] / self.references[0][kept]])

    def _narrow(self, motions: Motions, frequencies: Floats) -> Floats:
        """Return frequencies (1/s) about resonances that could be felt but lie between the given ones, as close as damping
        needs.

        An order of the forces at the nearest given frequency is nearly what it is where it meets a natural frequency.
        """
        modes, rates = self.modes, self.excitation.fundamental
        places = np.sort(frequencies)
        orders = np.arange(1, motions.forces.shape[1])[:, None]
        met = modes.omega / orders / rates
        nearest = places[_nearest(places, met)]
        own = motions.omega / rates
        rows = _nearest(own, met)
        inside = (met > places[0]) & (met < places[-1]) & np.isclose(own[rows], nearest, rtol=1e-12)
        forces = 2 * np.abs(motions.forces[rows, orders])
        driven = (forces * np.abs(modes.mesh)).sum(axis=-1)
        if self.excitation.torques:
            acting = self.excitation.torque_vectors(self.system)[0]
            inside_orders = acting < motions.forces.shape[1]
            driven[acting[inside_orders] - 1] += self._by_torques[inside_orders]
        heights = modes.told / modes.omega**2 * driven / (2 * modes.ratio)
        step = np.gradient(places)[_nearest(places, met)] if len(places) > 1 else np.zeros_like(met)
        # Those of neighbouring orders that are wider than their distance make no peaks of their own.
        apart = modes.ratio * orders < _APART * np.gcd.reduce(self.excitation.orders)
        apart &= orders <= HIGHEST_SOUGHT * max(self.excitation.orders)
        wanted = inside & apart & (heights > FELT) & (modes.ratio * met < step)
        found = [
            centre * (1 + ratio * _ladder(reach / (ratio * centre)))
            for centre, ratio, reach in zip(
                met[wanted], np.broadcast_to(modes.ratio, met.shape)[wanted], step[wanted], strict=True
            )
        ]
        near = np.concatenate(found) if found else np.zeros(0)
        return np.asarray(near[(near > places[0]) & (near < places[-1])], float)


def _nearest(places: Floats, wanted: Floats) -> Indices:
    """Return the indices of the nearest of rising places (p,)."""
    after = np.clip(np.searchsorted(places, wanted), 1, max(len(places) - 1, 1))
    if len(places) == 1:
        return np.zeros(wanted.shape, np.intp)
    return np.asarray(np.where(wanted - places[after - 1] < places[after] - wanted, after - 1, after), np.intp)


def _ladder(reach: float) -> Floats:
    """Return 0, and half widths of a resonance to both sides, each twice the one before, up to `reach`."""
    steps = 0.5 * 2.0 ** np.arange(max(1, int(np.ceil(np.log2(2 * reach)))))
    return np.concatenate([-steps[::-1], [0.0], steps])
