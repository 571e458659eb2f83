"""Natural modes of a planetary train by the planar model of Lin and Parker, told apart by what the centrals do in them.

J. Lin and R. G. Parker, J. Vib. Acoust. 121 (1999) 316-321, for planets alike at equal angles: rotational modes, in which
carrier and centrals only turn; translational ones, in pairs, in which they only travel; planet modes, in which they rest, each
N - 3 times. SI units inside.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats, Indices, freeze
from gearcad.dynamics.planetary.eigenspaces import MassSprings, ModeKind, eigenspaces
from gearcad.dynamics.planetary.masses import TrainMasses
from gearcad.dynamics.planetary.planar import PlanarTrain
from gearcad.dynamics.planetary.springs import TrainSprings
from gearcad.notice import Notice

__all__ = ["ModeFamily", "ModeKind", "PlanetaryModes", "planetary_modes", "why_mixed"]

_SAME = 1e-9
"""Relative: angles and stiffnesses that are the same but for rounding."""


class ModeFamily(NamedTuple):
    """Modes of a kind at one `frequency` (Hz): as many as `multiplicity`, from number `first` (0 is the lowest) on."""

    frequency: float
    kind: ModeKind
    multiplicity: int
    first: int

    def to_dict(self) -> dict[str, Any]:
        """As `planetary.json` has it."""
        return {"frequency": self.frequency, "kind": self.kind.value, "multiplicity": self.multiplicity}


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanetaryModes:
    """The n natural modes by rising `frequency` (n,) in Hz, without damping, at the mean stiffness of the meshes.

    `shape` (n, N + 3, 3) is x, y, u of carrier and centrals, then zeta (outwards), eta (along the rotation), u of the planets,
    in m for a modal mass of 1 kg; u is the turn times the radius. `reduced` (n, c) is the same in the coordinates of the
    springs, `elongation` (n, m) in m that of the springs. `potential` (n, m) are the springs' shares in the potential energy,
    `kinetic` (n, N + 3) the bodies' in the kinetic energy; each sums up to 1, but the first `rigid` modes, at 0 Hz, have no
    potential energy. `notices` say why modes are mixed.
    """

    springs: TrainSprings
    frequency: Floats
    kinds: tuple[ModeKind, ...]
    families: tuple[ModeFamily, ...]
    shape: Floats
    reduced: Floats
    elongation: Floats
    potential: Floats
    kinetic: Floats
    rigid: int
    notices: tuple[Notice, ...]

    def __post_init__(self) -> None:
        freeze(self)

    def __len__(self) -> int:
        return len(self.frequency)

    @property
    def circular(self) -> Floats:
        """Natural frequencies (n,) in 1/s."""
        return 2 * np.pi * self.frequency

    @property
    def bodies(self) -> tuple[str, ...]:
        """Carrier, centrals, "planet 1" and so on: the rows of a shape."""
        return (*self.springs.members, *(f"planet {n + 1}" for n in range(self.springs.planar.planets)))

    @property
    def turns(self) -> Floats:
        """(n, N + 3): turns of the bodies in rad, for a modal mass of 1 kg."""
        planar = self.springs.planar
        radii = [member.radius for member in planar.members] + [planar.planet_radius] * planar.planets
        return np.asarray(self.shape[:, :, 2] / np.array(radii), float)

    def of_kind(self, kind: ModeKind) -> Indices:
        """Numbers of its modes, from 0."""
        return np.flatnonzero([each is kind for each in self.kinds])

    def to_dict(self) -> dict[str, Any]:
        """Plain lists."""
        return {
            "frequencies": [family.to_dict() for family in self.families],
            "kind": [kind.value for kind in self.kinds],
            "frequency": self.frequency.tolist(),
            "bodies": list(self.bodies),
            "springs": list(self.springs.names),
            "shape": self.shape.tolist(),
            "potential": self.potential.tolist(),
            "kinetic": self.kinetic.tolist(),
            "rigid": self.rigid,
            "notices": [notice.to_dict() for notice in self.notices],
        }


def planetary_modes(springs: TrainSprings, masses: TrainMasses) -> PlanetaryModes:
    """The modes of a train's springs and masses. Raises ParameterError where a mass is missing."""
    model = MassSprings.of(springs, masses)
    blocks = sorted(eigenspaces(model), key=lambda block: float(block.omega.mean()))
    omega = np.concatenate([block.omega for block in blocks])
    kinds = tuple(block.kind for block in blocks for _ in block.omega)
    places = np.hstack([model.places(block.modes) for block in blocks])
    reduced = np.asarray(np.linalg.solve(model.lower.T, np.hstack([block.modes for block in blocks])), float)
    elongation = (springs.vectors @ reduced).T
    squares = (omega**2)[:, None]
    potential = np.divide(springs.stiffness * elongation**2, squares, out=np.zeros_like(elongation), where=squares > 0)
    shape = places.T.reshape(len(omega), -1, 3)
    firsts = np.cumsum([0, *(len(block.omega) for block in blocks)])
    return PlanetaryModes(
        springs=springs,
        frequency=omega / (2 * np.pi),
        kinds=kinds,
        families=tuple(
            ModeFamily(float(block.omega[0] / (2 * np.pi)), block.kind, len(block.omega), int(first))
            for block, first in zip(blocks, firsts[:-1], strict=True)
        ),
        shape=shape,
        reduced=reduced.T,
        elongation=elongation,
        potential=potential,
        kinetic=(model.mass.reshape(-1, 3) * shape**2).sum(axis=2),
        rigid=int((omega == 0).sum()),
        notices=_notices(springs.planar, kinds),
    )


def why_mixed(planar: PlanarTrain) -> str:
    """What keeps modes from being rotational, translational or planet modes; "" where nothing does."""
    count = planar.planets
    turns = np.sort(np.mod(planar.angles, 2 * np.pi))
    if count == 1:
        return "there is one planet only"
    if np.abs(np.diff(turns) - 2 * np.pi / count).max() > _SAME:
        return "the planets are not at equal angles"
    uneven = [line.name for line in planar.meshes if np.ptp(line.stiffness) > _SAME * line.stiffness.max()]
    if uneven:
        return f"the planets are not alike in the stiffness of {' and '.join(uneven)}"
    return ""


def _notices(planar: PlanarTrain, kinds: tuple[ModeKind, ...]) -> tuple[Notice, ...]:
    mixed = sum(kind is ModeKind.MIXED for kind in kinds)
    if not mixed:
        return ()
    reason = why_mixed(planar) or "its stiffnesses differ so much that rounding decides"
    return (Notice("modes-mixed", f"{mixed} of {len(kinds)} modes are of no kind: {reason}", "modes"),)
