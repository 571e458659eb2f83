"""How far everything moves over speed: turns of the inertias, approach of the flanks, axes on bearings and what these carry."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gearcad.arrays import Bools, Floats, Indices
from gearcad.dynamics.charts.extremes import Extremes
from gearcad.dynamics.response.flexibility import StaticState
from gearcad.dynamics.trains.system import System

__all__ = ["BearingLoads", "Displacements", "bearing_loads", "columns", "displacements"]


_ARCSEC = 3600 * 180 / np.pi
_MICRO = 1e-6

_FREE = 1e-9
"""Of the greatest: squares of natural frequencies that are 0 but for rounding, and turns in such modes."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Displacements:
    """Over the speeds (s,) of a chart; an amplitude is half of peak to peak over a period, about the mean.

    `turns` (s, i) are amplitudes of the inertias and `farthest` (s, i) their greatest turns out of the unloaded place, in
    arcsec, nan for those that nothing holds. `approaches` (s, m) are amplitudes of the approach of the flanks and `deepest`
    (s, m) the greatest of it, in µm.
    """

    turns: Floats
    farthest: Floats
    approaches: Floats
    deepest: Floats
    inertia_names: tuple[str, ...]
    mesh_names: tuple[str, ...]

    def of_meshes(self, columns: Indices, names: tuple[str, ...]) -> Displacements:
        """With other meshes, each of which does what one of these does."""
        return replace(self, approaches=self.approaches[:, columns], deepest=self.deepest[:, columns], mesh_names=names)

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them."""
        return {
            "turn_amplitude": self.turns,
            "turn_greatest": self.farthest,
            "approach_amplitude": self.approaches,
            "approach_greatest": self.deepest,
        }

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it: arcsec and µm, null where nothing holds an inertia."""
        return {
            "turn_amplitude": columns(self.inertia_names, self.turns),
            "turn_greatest": columns(self.inertia_names, self.farthest),
            "approach_amplitude": columns(self.mesh_names, self.approaches),
            "approach_greatest": columns(self.mesh_names, self.deepest),
        }


def displacements(system: System, found: Extremes) -> Displacements:
    """Of what was found over speed."""
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
    """Which inertias (i,) turn where no spring is bent: how far they are turned means nothing."""
    squares, modes = np.linalg.eigh(system.stiffness_matrix())
    free = np.abs(system.inertias.T @ modes[:, squares <= _FREE * squares.max()])
    return np.asarray((free > _FREE * free.max(initial=0.0)).any(axis=1), bool)


@dataclass(frozen=True, kw_only=True, eq=False)
class BearingLoads:
    """What the axes of `gears` (g) press their bearings with over the speeds (s,) of a chart (N), their damping with it.

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
        """As the .npz file has them."""
        return {"bearing_static_force": self.static, **{f"bearing_{name}": each for name, each in self._over_speed().items()}}

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it: N and µm."""
        static = dict(zip(self.gears, self.static.tolist(), strict=True))
        return {"static_force": static, **{name: columns(self.gears, each) for name, each in self._over_speed().items()}}


def bearing_loads(system: System, static: StaticState, found: Extremes) -> BearingLoads | None:
    """Of what was found over speed; None of axes that stay where they are."""
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
    """0 where bearings are alike in all directions: nothing drives what is across the line of action."""
    return np.where(np.nanmax(np.abs(across)) > _FREE * np.nanmax(np.abs(along)), across, 0.0)


def _amplitudes(both: Floats) -> Floats:
    """(s, c) of greatest and least (s, 2, c)."""
    return np.asarray((both[:, 0] - both[:, 1]) / 2, float)


def columns(names: tuple[str, ...], values: Floats) -> dict[str, list[float | None]]:
    """Of values (s, c), no value (null) for nan."""
    plain = np.where(np.isnan(values), None, values)  # type: ignore[call-overload]
    return dict(zip(names, plain.T.tolist(), strict=True))
