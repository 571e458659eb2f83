"""KvChart: how much the load between the teeth and in the shafts exceeds the static one, over speed."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.dynamics.charts.displacements import BearingLoads, Displacements
from gearcad.dynamics.charts.displacements import columns as _columns
from gearcad.dynamics.charts.transmission import TransmissionErrors
from gearcad.dynamics.maxima import outstanding
from gearcad.notice import Notice, texts

__all__ = ["FactorPeak", "ForceDefinition", "KvChart"]


_PROMINENCE = 0.005
"""How far K_v must fall on both sides of a peak that counts as a resonance."""


class ForceDefinition(Enum):
    """Which force between the teeth K_v compares with the static one."""

    SPRING = "spring"
    """k(t) (y - e): (2.3) of J. Osinski's paper."""
    WITH_DAMPING = "with damping"
    """k(t) (y - e) + c (y' - e')."""


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
        """What to know before trusting it, in words."""
        return texts(self.notices)

    def peaks(self, mesh: int = 0) -> list[FactorPeak]:
        """Resonances of a mesh, in order of frequency: maxima of K_v that stand out from both sides."""
        known = np.flatnonzero(np.isfinite(self.factors[:, mesh]))
        found = known[outstanding(self.factors[known, mesh], _PROMINENCE)]
        return [FactorPeak(float(self.frequencies[i]), float(self.factors[i, mesh])) for i in found]

    @property
    def known(self) -> NDArray[np.bool_]:
        """Where (s,) there are loads: none where a motion with parted flanks was not found."""
        return np.asarray(np.isfinite(self.factors).all(axis=1), bool)

    @property
    def apart(self) -> NDArray[np.bool_]:
        """Where (s,) flanks part at some time, or would if they could."""
        return np.asarray(np.any(~(self.least > 0), axis=1), bool)

    @property
    def referred_shafts(self) -> list[int]:
        """Shafts that have an overload: the others carry nothing at rest."""
        return [shaft for shaft, column in enumerate(self.shaft_factors.T) if np.isfinite(column[self.known]).all()]

    @property
    def idle_shafts(self) -> list[str]:
        """Names of those without an overload."""
        kept = self.referred_shafts
        return [name for shaft, name in enumerate(self.shaft_names) if shaft not in kept]

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them."""
        return {
            "kv": self.factors,
            "kv_with_damping": self.damped,
            "shaft_overload": self.shaft_factors,
            **self.displacements.arrays(),
            **self.transmission.arrays(),
            **({} if self.bearings is None else self.bearings.arrays()),
        }

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it: 1/s, N, N·m; no value (null) where a shaft has no factor."""
        shafts = [[None if np.isnan(value) else float(value) for value in row] for row in self.shaft_factors.T]
        return {
            "frequency": self.frequencies.tolist(),
            "definition": ForceDefinition.SPRING.value,
            "kv": _columns(self.mesh_names, self.factors),
            "kv_with_damping": _columns(self.mesh_names, self.damped),
            "least_force": _columns(self.mesh_names, self.least * self.static_forces),
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
