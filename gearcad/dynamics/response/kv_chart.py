"""K_v chart: loads of meshes and shafts over their static loads, and displacements, over speed. SI units inside."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from enum import Enum
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Bools, Floats, Indices, JsonObject, Notice, texts
from gearcad.dynamics.time_domain.spectra import outstanding
from gearcad.dynamics.trains.shaft_lines import System
from gearcad.dynamics.trains.steady_response import PeriodicResponse, StaticState
from gearcad.rating.dynamic_factor import DynamicFactor

_BLOCK = 2_000_000
"""Samples that one block of speeds may have at a time."""


@dataclass(frozen=True, eq=False)
class Extremes:
    """Extremes at each speed (s,): `most` and `least` (s, m) are forces (N) of the springs between the flanks that carry.

    `damped` (s, m) are the greatest forces with those of the dampers; `torques` (s, n) the greatest in the sense of the static
    ones (N·m).

    Greatest and least are `approaches` (s, 2, m) of the flanks that carry (m), `turns` (s, 2, i) of the inertias (rad),
    `travels` (s, 2, t) of the axes (m) and `bearings` (s, 2, t) of the forces on their bearings (N); `resultants` (s, g) are
    the greatest of these. `lines` (s, k, m) are amplitudes (m) of the approach at some orders.
    """

    most: Floats
    least: Floats
    damped: Floats
    torques: Floats
    approaches: Floats
    turns: Floats
    travels: Floats
    bearings: Floats
    resultants: Floats
    lines: Floats

    @classmethod
    def joined(cls, *parts: Self) -> Self:
        """Return all parts, one after the other."""
        return cls(**{each.name: np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(cls)})

    def at(self, rows: Indices) -> Self:
        """Return the values of some `rows`, in this order."""
        return type(self)(**{each.name: getattr(self, each.name)[rows] for each in fields(self)})


def extremes(response: PeriodicResponse, signs: Floats, orders: Indices, samples: int | None = None) -> Extremes:
    """Return the extremes of a response, block by block of speeds.

    Torques are in the sense of `signs` (n,), lines at `orders` (k,) from 1 on.
    """
    count = samples or response.samples
    wide = count * max(response.approach_coefficients.shape[2], response.torque_coefficients.shape[2])
    block = max(1, _BLOCK // wide)
    return Extremes.joined(*_blocks(response, signs, orders, count, block))


def _blocks(response: PeriodicResponse, signs: Floats, orders: Indices, count: int, block: int) -> Iterator[Extremes]:
    for i in range(0, len(response.frequencies), block):
        which = slice(i, i + block)
        approach, torque = response.approach(which, count), response.shaft_torques(which, count)
        spring = response.carried(approach)
        force, bearing = response.senses * spring, response.bearing_forces(which, count)
        yield Extremes(
            most=force.max(axis=1),
            least=force.min(axis=1),
            damped=(response.senses * (spring + response.damping_forces(which, count))).max(axis=1),
            torques=np.where(signs, torque * signs, np.abs(torque)).max(axis=1),
            approaches=_both(response.senses * approach),
            turns=_both(response.turns(which, count)),
            travels=_both(response.travels(which, count)),
            bearings=_both(bearing),
            resultants=np.hypot(bearing[..., ::2], bearing[..., 1::2]).max(axis=1),
            lines=_lines(response, which, orders),
        )


def _both(course: Floats) -> Floats:
    """Return the greatest and least (s, 2, c) of courses (s, t, c)."""
    return np.stack([course.max(axis=1), course.min(axis=1)], axis=1)


def _lines(response: PeriodicResponse, which: slice, orders: Indices) -> Floats:
    """Return amplitudes (s, k, m) of the approach (m) at the orders; 0 where the response has no such order."""
    result = np.zeros((len(response.frequencies[which]), len(orders), response.approach_coefficients.shape[2]))
    _, own, wanted = np.intersect1d(response.harmonics, orders, assume_unique=True, return_indices=True)
    result[:, wanted] = 2 * np.abs(response.approach_coefficients[which, own])
    return result


_ARCSEC = 3600 * 180 / np.pi
_MICRO = 1e-6

_FREE = 1e-9
"""Part of the greatest below which squares of natural frequencies, and turns in such modes, are 0 but for rounding."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Displacements:
    """Displacements over the speeds (s,) of a chart; an amplitude is half of peak to peak over a period, about the mean.

    `turns` (s, i) are amplitudes of the inertias and `farthest` (s, i) their greatest turns out of the unloaded place, in
    arcsec, nan for those that nothing holds. `approaches` (s, m) are amplitudes of the approach of the flanks and `deepest` (s,
    m) the greatest of it, in µm.
    """

    turns: Floats
    farthest: Floats
    approaches: Floats
    deepest: Floats
    inertia_names: tuple[str, ...]
    mesh_names: tuple[str, ...]

    def of_meshes(self, columns: Indices, names: tuple[str, ...]) -> Displacements:
        """Return the displacements with other meshes, each of which moves as the mesh given in `columns`."""
        return replace(self, approaches=self.approaches[:, columns], deepest=self.deepest[:, columns], mesh_names=names)

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        return {
            "turn_amplitude": self.turns,
            "turn_greatest": self.farthest,
            "approach_amplitude": self.approaches,
            "approach_greatest": self.deepest,
        }

    def to_dict(self) -> JsonObject:
        """Return the entry of the displacements in `dynamics.json`: arcsec and µm, null where nothing holds an inertia."""
        return {
            "turn_amplitude": columns(self.inertia_names, self.turns),
            "turn_greatest": columns(self.inertia_names, self.farthest),
            "approach_amplitude": columns(self.mesh_names, self.approaches),
            "approach_greatest": columns(self.mesh_names, self.deepest),
        }


def displacements(system: System, found: Extremes) -> Displacements:
    """Return the displacements of extremes over speed."""
    farthest = np.abs(found.turns).max(axis=1)
    return Displacements(
        turns=_ARCSEC * _amplitudes(found.turns),
        farthest=_ARCSEC * np.where(_unheld(system), np.nan, farthest),
        approaches=_amplitudes(found.approaches) / _MICRO,
        deepest=found.approaches[:, 0] / _MICRO,
        inertia_names=system.names[1],
        mesh_names=system.names[0],
    )


def _unheld(system: System) -> Bools:
    """Return whether (i,) inertias can rotate without bending a spring; their rotation has no meaning."""
    squares, modes = np.linalg.eigh(system.stiffness_matrix())
    free = np.abs(system.inertias.T @ modes[:, squares <= _FREE * squares.max()])
    return np.asarray((free > _FREE * free.max(initial=0.0)).any(axis=1), bool)


@dataclass(frozen=True, kw_only=True, eq=False)
class BearingLoads:
    """Forces (N) of the axes of `gears` (g) on their bearings over the speeds (s,) of a chart, with the damping of the
    bearings.

    `static` (g,) at rest, which is the mean at any speed too; `greatest` (s, g) of the resultant. `along` (s, 2, g) are the
    greatest and the least along the line of action, as the static one points, `across` (s, 2, g) square to it. `travels_along`
    and `travels_across` (s, g) are amplitudes of the axes in µm.
    """

    gears: tuple[str, ...]
    static: Floats
    greatest: Floats
    along: Floats
    across: Floats
    travels_along: Floats
    travels_across: Floats

    def _over_speed(self) -> dict[str, Floats]:
        return {
            "greatest_force": self.greatest,
            "greatest_along": self.along[:, 0],
            "least_along": self.along[:, 1],
            "greatest_across": self.across[:, 0],
            "least_across": self.across[:, 1],
            "travel_amplitude_along": self.travels_along,
            "travel_amplitude_across": self.travels_across,
        }

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        return {"bearing_static_force": self.static, **{f"bearing_{name}": each for name, each in self._over_speed().items()}}

    def to_dict(self) -> JsonObject:
        """Return the entry of the bearing loads in `dynamics.json`: N and µm."""
        static = dict(zip(self.gears, self.static.tolist(), strict=True))
        return {"static_force": static, **{name: columns(self.gears, each) for name, each in self._over_speed().items()}}


def bearing_loads(system: System, static: StaticState, found: Extremes) -> BearingLoads | None:
    """Return the bearing loads of extremes over speed; None for axes that do not travel."""
    bearings = system.bearings
    if bearings is None:
        return None
    at_rest = bearings.stiffness @ static.others[system.torque_outputs.stop :]
    along, across = found.bearings[..., ::2], found.bearings[..., 1::2]
    # The pinion is pressed back where the wheel is pressed on.
    along = np.where(at_rest[::2] < 0, -along[:, ::-1], along)
    travels = _amplitudes(found.travels) / _MICRO
    return BearingLoads(
        gears=bearings.gears,
        static=np.hypot(at_rest[::2], at_rest[1::2]),
        greatest=found.resultants,
        along=along,
        across=_but_rounding(across, along),
        travels_along=travels[:, ::2],
        travels_across=_but_rounding(travels[:, 1::2], travels[:, ::2]),
    )


def _but_rounding(across: Floats, along: Floats) -> Floats:
    """Return the values across, or 0 if bearings are alike in all directions, since nothing then excites travel across the
    line.
    """
    return np.where(np.nanmax(np.abs(across)) > _FREE * np.nanmax(np.abs(along)), across, 0.0)


def _amplitudes(both: Floats) -> Floats:
    """Return amplitudes (s, c) of greatest and least values (s, 2, c)."""
    return np.asarray((both[:, 0] - both[:, 1]) / 2, float)


def columns(names: tuple[str, ...], values: Floats) -> dict[str, list[float | None]]:
    """Return the values (s, c) as a list for each name, None for nan."""
    plain = np.where(np.isnan(values), None, values)  # type: ignore[call-overload]
    return dict(zip(names, plain.T.tolist(), strict=True))


_FLOOR = 1e-3
"""Part of the greatest line of a mesh: lines below it at all speeds are left out."""

_MOST = 128
"""Lines that are kept: with 1000 speeds a megabyte a mesh."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TransmissionErrors:
    """Amplitudes (s, q, m) of the approach of the flanks of each mesh, in µm, over the speeds (s,) of a chart.

    `orders` (q,) are multiples of the tooth frequency of the first mesh, whole ones unless teeth differ or meshes have other
    tooth frequencies; times the teeth of its pinion they are orders of the pinion's shaft.
    """

    orders: Floats
    amplitudes: Floats

    def of_meshes(self, columns: Indices) -> TransmissionErrors:
        """Return the amplitudes of other meshes, each of which moves as the mesh given in `columns`."""
        return replace(self, amplitudes=self.amplitudes[:, :, columns])

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        return {"transmission_error_order": self.orders, "transmission_error": self.amplitudes}


def transmission_errors(orders: Floats, lines: Floats) -> TransmissionErrors:
    """Return the transmission errors (µm) of lines (s, k, m) in m at orders (k,).

    Lines are kept that exceed a thousandth of the greatest line of a mesh at some speed.
    """
    kept = lines_that_matter(np.nan_to_num(lines).max(axis=0, initial=0.0), _FLOOR, _MOST)
    return TransmissionErrors(orders=orders[kept], amplitudes=lines[:, kept] / _MICRO)


def lines_that_matter(sizes: Floats, floor: float, most: int) -> Indices:
    """Return the rows of `sizes` (k, m) above the share `floor` of the greatest of their mesh: at most
    `most`, in rising order.
    """
    greatest = sizes.max(axis=0, initial=0.0)
    shares = np.divide(sizes, greatest, out=np.zeros_like(sizes), where=greatest > 0).max(axis=1)
    highest = np.argsort(-shares, kind="stable")[:most]
    return np.sort(highest[shares[highest] > floor])


_PROMINENCE = 0.005
"""Least fall of K_v on both sides of a peak that counts as a resonance."""


class ForceDefinition(Enum):
    """Force between the teeth that K_v compares with the static one."""

    SPRING = "spring"
    """Force of the spring alone, k(t) (y - e): (2.3) of J. Osinski's paper."""
    WITH_DAMPING = "with damping"
    """Force of spring and damper: k(t) (y - e) + c (y' - e')."""


class FactorPeak(NamedTuple):
    """A resonance: circular tooth frequency of the first mesh (1/s), and the factor there."""

    frequency: float
    factor: float


@dataclass(frozen=True, kw_only=True, eq=False)
class KvChart:
    """Overload over `frequencies` (s,): circular tooth frequencies of the first mesh (1/s).

    `factors` (s, m) is K_v of each mesh: greatest force of the springs over a period over the `static_forces` (m,) in N,
    both of the flanks that carry, and `damped` (s, m) the same with the force of the dampers; `least` (s, m) is the least
    without it over the static one, negative where flanks pull or those behind them touch. `shaft_factors` (s, n) is the
    greatest torque, in the sense of the static one, over the `shaft_references` (n,) in N·m; nan in shafts that are neither
    loaded at rest nor have a reference. `displacements`, errors of `transmission` and loads of `bearings` are those of the same
    motions. `standard` (s,) is K_v of ISO 6336-1:2006, Method B, of the pair of the first mesh.
    """

    frequencies: Floats
    factors: Floats
    damped: Floats
    least: Floats
    static_forces: Floats
    shaft_factors: Floats
    shaft_references: Floats
    displacements: Displacements
    transmission: TransmissionErrors
    bearings: BearingLoads | None
    standard: Floats | None
    stable: NDArray[np.bool_]
    mesh_names: tuple[str, ...]
    shaft_names: tuple[str, ...]
    notices: tuple[Notice, ...]

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def peaks(self, mesh: int = 0) -> list[FactorPeak]:
        """Return the resonances of a mesh in order of frequency: maxima of K_v that stand out from both sides."""
        known = np.flatnonzero(np.isfinite(self.factors[:, mesh]))
        found = known[outstanding(self.factors[known, mesh], _PROMINENCE)]
        return [FactorPeak(float(self.frequencies[i]), float(self.factors[i, mesh])) for i in found]

    @property
    def known(self) -> NDArray[np.bool_]:
        """Marks (s,) of the frequencies with known loads; there are none where a motion with parted flanks was not found."""
        return np.asarray(np.isfinite(self.factors).all(axis=1), bool)

    @property
    def apart(self) -> NDArray[np.bool_]:
        """Marks (s,) of the frequencies at which flanks part at some time, or would if they could."""
        return np.asarray(np.any(~(self.least > 0), axis=1), bool)

    @property
    def referred_shafts(self) -> list[int]:
        """Indices of the shafts that have an overload: the others carry nothing at rest."""
        return [shaft for shaft, column in enumerate(self.shaft_factors.T) if np.isfinite(column[self.known]).all()]

    @property
    def idle_shafts(self) -> list[str]:
        """Names of the shafts without an overload."""
        kept = self.referred_shafts
        return [name for shaft, name in enumerate(self.shaft_names) if shaft not in kept]

    def arrays(self) -> dict[str, Floats]:
        """Return the arrays of the .npz file by name."""
        return {
            "kv": self.factors,
            "kv_with_damping": self.damped,
            "shaft_overload": self.shaft_factors,
            **self.displacements.arrays(),
            **self.transmission.arrays(),
            **({} if self.bearings is None else self.bearings.arrays()),
        }

    def to_dict(self) -> JsonObject:
        """Return the entry of the chart in `dynamics.json`: 1/s, N, N·m; null where a shaft has no factor."""
        shafts = [[None if np.isnan(value) else float(value) for value in row] for row in self.shaft_factors.T]
        return {
            "frequency": self.frequencies.tolist(),
            "definition": ForceDefinition.SPRING.value,
            "kv": columns(self.mesh_names, self.factors),
            "kv_with_damping": columns(self.mesh_names, self.damped),
            "least_force": columns(self.mesh_names, self.least * self.static_forces),
            "static_force": dict(zip(self.mesh_names, self.static_forces.tolist(), strict=True)),
            "shaft_overload": dict(zip(self.shaft_names, shafts, strict=True)),
            "peaks": {name: [each._asdict() for each in self.peaks(j)] for j, name in enumerate(self.mesh_names)},
            "displacements": self.displacements.to_dict(),
            "bearings": None if self.bearings is None else self.bearings.to_dict(),
            "kv_iso6336": None if self.standard is None else self.standard.tolist(),
            "stable": self.stable.tolist(),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }


_IDLE, _IDLE_MOSTLY = 50.0, 3.0
"""A shaft whose torque exceeds its static one so many times, and at half of the speeds still so many times, carries nothing at
rest that a factor could refer to: one that only resonates is quiet at most speeds."""


def kv_chart(
    response: PeriodicResponse,
    *,
    shaft_references: Sequence[float | None] | None = None,
    method_b: DynamicFactor | None = None,
) -> KvChart:
    """Return the chart of a response over speed, linear or of a sweep.

    `shaft_references` (N·m), one per shaft, replace the static torque where given: for shafts that carry none. `method_b` are
    the data of the pair of the first mesh. Raises GeometryError where a mesh carries no static load that K_v could refer to.
    """
    means = response.static.others[response.system.torque_outputs]
    _, signs = torque_references(means, shaft_references)
    return chart_of(
        response.system,
        response.static,
        response.frequencies,
        extremes(response, signs, response.harmonics[1:]),
        response.harmonics[1:],
        orders_per_tooth=response.excitation.orders[0],
        shaft_references=shaft_references,
        method_b=method_b,
        stable=response.stable,
        notices=response.notices,
    )


def chart_of(
    system: System,
    static: StaticState,
    frequencies: Floats,
    found: Extremes,
    orders: Indices,
    *,
    orders_per_tooth: int,
    shaft_references: Sequence[float | None] | None = None,
    method_b: DynamicFactor | None = None,
    stable: NDArray[np.bool_],
    notices: tuple[Notice, ...],
) -> KvChart:
    """Return the chart of extremes `found`, with their lines at `orders` (k,), `orders_per_tooth` of them to a tooth frequency.

    Raises GeometryError for a mesh without static force, to which K_v could not refer.
    """
    forces = np.abs(system.stiffness * static.approach)
    if forces.min() <= 1e-9 * forces.max():
        name = system.names[0][int(forces.argmin())]
        raise GeometryError("static_force", float(forces.min()), f"of mesh {name} must not be 0 N: K_v refers to it", "N")
    means = static.others[system.torque_outputs]
    references, _ = torque_references(means, shaft_references)
    given = np.array([value is not None for value in shaft_references or [None] * len(means)], bool)
    references = np.where(given | ~idle_shafts(found.torques, references), references, np.nan)
    return KvChart(
        frequencies=frequencies,
        factors=found.most / forces,
        damped=found.damped / forces,
        least=found.least / forces,
        static_forces=forces,
        shaft_factors=found.torques / references,
        shaft_references=references,
        displacements=displacements(system, found),
        transmission=transmission_errors(orders / orders_per_tooth, found.lines),
        bearings=bearing_loads(system, static, found),
        standard=None if method_b is None else method_b.values(frequencies * 30 / (np.pi * method_b.teeth)),
        stable=stable,
        mesh_names=system.names[0],
        shaft_names=system.names[2],
        notices=notices,
    )


def idle_shafts(torques: Floats, references: Floats) -> NDArray[np.bool_]:
    """Return whether shafts (n,) have greatest torques (s, n) over speed that are unrelated to those at rest (n,)."""
    if not torques.size:
        return np.zeros(len(references), bool)
    torques = torques[np.isfinite(torques).all(axis=1)]
    idle = (torques.max(axis=0) >= _IDLE * references) & (np.median(torques, axis=0) >= _IDLE_MOSTLY * references)
    return np.asarray(idle, bool)


def torque_references(means: Floats, given: Sequence[float | None] | None = None) -> tuple[Floats, Floats]:
    """Return reference torques (n,) in N·m, and the sense (n,) in which they act: 0 where it is unknown.

    Raises ParameterError unless as many are `given` as shafts, each above 0 N·m or None.
    """
    count = len(means)
    if given is not None and len(given) != count:
        raise ParameterError("shaft_references", len(given), f"must be one number or None for each of {count} shafts")
    loaded = np.abs(means) > 1e-9 * np.abs(means).max(initial=0.0)
    references = np.where(loaded, np.abs(means), np.nan)
    for i, value in enumerate(given or ()):
        if value is not None:
            if not np.isfinite(value) or value <= 0:
                raise ParameterError("shaft_references", value, "must be above 0 N·m", "N·m")
            references[i] = value
    return references, np.where(loaded, np.sign(means), 0.0)
