"""Campbell data of a planetary train: what shakes it over the speed of its input, and which natural modes that meets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.planetary.modes import ModeFamily, ModeKind, PlanetaryModes
from gearcad.dynamics.planetary.springs import SpringKind
from gearcad.errors import GeometryError, require_whole
from gearcad.notice import Notice
from gearcad.planetary import MeshPhases, PlanetaryTrain
from gearcad.planetary.speeds import speeds

__all__ = [
    "NEAR",
    "CampbellLine",
    "LineKind",
    "PlanetaryCampbell",
    "Resonance",
    "modal_shares",
    "planetary_campbell",
    "speeds_per_input",
]

NEAR = 0.05
"""Of the speed of a resonance: a load that runs so near is told of."""

_SHAKEN = 1e-6
"""Of what all planets together could do to a mode: rounding of what takes itself off."""

_UNMESHED = 1e-9
"""Of the potential energy: what a mesh holds of a mode that does not move it."""


class LineKind(Enum):
    """What shakes a train."""

    MESH = "mesh"
    """Stiffness and transmission error of a central's meshes."""

    STAGE = "stage"
    """Those of a stage; its force turns against the carrier, so travel is shaken at the frequency of the carrier off it too."""

    PASS = "planet pass"
    """Planets that pass a tooth of a central."""

    TURN = "turn"
    """A planet that turns on its pin."""


class CampbellLine(NamedTuple):
    """A `harmonic` of what is called `source`: its frequency is `per_rpm` (Hz) times the speed of the input (rpm)."""

    kind: LineKind
    source: str
    harmonic: int
    per_rpm: float

    @property
    def name(self) -> str:
        """Such as "2 x sun-planet"."""
        return self.source if self.harmonic == 1 else f"{self.harmonic} x {self.source}"


class Resonance(NamedTuple):
    """Where a line meets modes: `speed` of the input (rpm) and `frequency` (Hz), by numbers of `line` and `family`.

    `share` is how much of what the planets' meshes could do to the modes they do with their phases: 0 where they take each
    other off; None where that is not judged, of what is no mesh of the set.
    """

    speed: float
    frequency: float
    line: int
    family: int
    share: float | None

    @property
    def excited(self) -> bool | None:
        """Whether the modes are shaken there; None where that is not judged."""
        return None if self.share is None else self.share > 0


@dataclass(frozen=True, kw_only=True, eq=False)
class PlanetaryCampbell:
    """`lines` over the input's speed up to `highest_speed` (rpm), the modes' `families`, and where both meet, by rising speed.

    `shares` (l, f) of lines in families are those of the resonances, nan where they are not judged. `speed` (rpm, without its
    sign) is that of the load, where one is given.
    """

    train: PlanetaryTrain
    speed: float | None
    highest_speed: float
    lines: tuple[CampbellLine, ...]
    families: tuple[ModeFamily, ...]
    shares: Floats
    resonances: tuple[Resonance, ...]

    @property
    def excited(self) -> tuple[Resonance, ...]:
        """Those at which modes are shaken."""
        return tuple(each for each in self.resonances if each.excited)

    @property
    def near(self) -> tuple[Resonance, ...]:
        """Those that excite modes, within NEAR of which the load runs, the nearest first, even beyond the diagram."""
        if not self.speed:
            return ()
        found = [
            Resonance(family.frequency / line.per_rpm, family.frequency, row, column, float(self.shares[row, column]))
            for row, line in enumerate(self.lines)
            for column, family in enumerate(self.families)
            if self.shares[row, column] > 0
        ]
        by_distance = sorted((abs(self.speed / each.speed - 1), place) for place, each in enumerate(found))
        return tuple(found[place] for distance, place in by_distance if distance <= NEAR)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """That the load runs near a resonance: one for each mode and speed, of all harmonics that meet there."""
        together: dict[tuple[int, str], list[Resonance]] = {}
        for each in self.near:
            together.setdefault((each.family, f"{each.speed:.6g}"), []).append(each)
        return tuple(Notice("near-resonance", self._near_words(met)) for met in together.values())

    def _near_words(self, met: list[Resonance]) -> str:
        speed, family = self.speed or 0.0, self.families[met[0].family]
        away = 100 * (speed / met[0].speed - 1)
        apart = f"{abs(away):.2g} % {'above' if away > 0 else 'below'}" if abs(away) >= 1e-3 else "at"
        lines = " and ".join(self.lines[each.line].name for each in met)
        last = family.first + family.multiplicity
        modes = f"mode {last}" if family.multiplicity == 1 else f"modes {family.first + 1} to {last}"
        return (
            f"{speed:.5g} rpm of {self.train.input} is {apart} the resonance at {met[0].speed:.5g} rpm, where {lines} "
            f"{'excites' if len(met) == 1 else 'excite'} {modes} ({family.kind.value}, {family.frequency:.5g} Hz); "
            f"told within {100 * NEAR:g} %, damping is not judged"
        )

    def kinds_excited(self, source: str, harmonic: int) -> tuple[ModeKind, ...]:
        """Kinds of the modes that a line shakes."""
        (row,) = [i for i, line in enumerate(self.lines) if (line.source, line.harmonic) == (source, harmonic)]
        found = {family.kind for family, share in zip(self.families, self.shares[row], strict=True) if share > 0}
        return tuple(kind for kind in ModeKind if kind in found)

    def to_dict(self) -> dict[str, Any]:
        """Plain lists; no value (null) where a share is not judged."""
        return {
            "speed": self.speed,
            "highest_speed": self.highest_speed,
            "lines": [{**line._asdict(), "kind": line.kind.value, "name": line.name} for line in self.lines],
            "families": [family.to_dict() for family in self.families],
            "shares": [[None if np.isnan(share) else float(share) for share in row] for row in self.shares],
            "resonances": [{**each._asdict(), "excited": each.excited} for each in self.resonances],
            "near": [{**each._asdict(), "excited": each.excited} for each in self.near],
        }


def planetary_campbell(
    train: PlanetaryTrain,
    modes: PlanetaryModes,
    phases: Mapping[str, MeshPhases],
    highest_speed: float,
    *,
    harmonics: int = 6,
    given_speeds: Mapping[str, float] | None = None,
    speed: float | None = None,
) -> PlanetaryCampbell:
    """Up to a speed of the input (rpm), with so many `harmonics` of every mesh.

    `given_speeds` (rpm) are those of a differential beside its input at `highest_speed`: all rise alike. `speed` (rpm) of the
    load: resonances near it are told. Raises ParameterError, and GeometryError where the set turns as one.
    """
    require_whole("harmonics", harmonics, at_least=1, at_most=1000)
    turns = speeds_per_input(train, {**(given_speeds or {}), train.input: highest_speed})
    lines = _lines(train, turns, harmonics)
    shares = np.full((len(lines), len(modes.families)), np.nan)
    for row, line in enumerate(lines):
        if line.kind is LineKind.MESH:
            shares[row] = modal_shares(modes, line.source, np.array(phases[line.source].ahead), line.harmonic)
    met = [
        Resonance(meeting, family.frequency, row, column, None if np.isnan(shares[row, column]) else float(shares[row, column]))
        for row, line in enumerate(lines)
        for column, family in enumerate(modes.families)
        if 0 < (meeting := family.frequency / line.per_rpm) <= highest_speed
    ]
    return PlanetaryCampbell(
        train=train,
        speed=abs(speed) if speed else None,
        highest_speed=highest_speed,
        lines=lines,
        families=modes.families,
        shares=shares,
        resonances=tuple(sorted(met, key=lambda each: each.speed)),
    )


def modal_shares(modes: PlanetaryModes, mesh: str, ahead: Floats, harmonic: int) -> Floats:
    """(f,): what a harmonic of a mesh does to the modes of each family, over what it could if it came rightly for each planet.

    |sum_n y_n exp(2 pi i m lambda_n)|, y_n the approach of the flanks of planet n in a mode, over the root of N sum y_n^2; of
    several modes the root of the sum of squares. 0 where the phases of the planets (`ahead`, base pitches) take it off.
    """
    columns = modes.springs.select(SpringKind.MESH, mesh)
    waves = np.exp(2j * np.pi * harmonic * ahead)
    result = np.zeros(len(modes.families))
    for place, family in enumerate(modes.families):
        own = slice(family.first, family.first + family.multiplicity)
        approach = modes.elongation[own][:, columns]
        moved = family.first < modes.rigid or modes.potential[own][:, columns].sum() > _UNMESHED
        most = np.sqrt(len(waves)) * np.linalg.norm(approach)
        share = np.linalg.norm(approach @ waves) / most if moved and most else 0.0
        result[place] = share if share > _SHAKEN and family.frequency else 0.0
    return result


def speeds_per_input(train: PlanetaryTrain, given: Mapping[str, float]) -> dict[str, float]:
    """Speeds of all shafts and the planet's against the carrier ("planet"), over that of the input; these are `given` in rpm.

    Raises ParameterError for an input at rest, GeometryError where the set turns as one.
    """
    turning = {name: speed for name, speed in given.items() if name != train.input}
    turning[train.input] = given[train.input] or 1.0
    found = speeds(train, turning)
    if not found.planet_relative:
        raise GeometryError("speeds", 0.0, "must let the planets turn on their pins: nothing meshes", "rpm")
    every = {**found.members, "planet": found.planet_relative}
    return {name: speed / turning[train.input] for name, speed in every.items()}


def _lines(train: PlanetaryTrain, turns: Mapping[str, float], harmonics: int) -> tuple[CampbellLine, ...]:
    """Meshes of the set and of its stages with their harmonics, then what comes once a turn."""
    meshes = [(LineKind.MESH, mesh.name, mesh.rim.gear.teeth * turns["planet"]) for mesh in train.meshes]
    meshes += [(LineKind.STAGE, stage.name, stage.pair.pinion.teeth * turns[stage.pinion]) for stage in train.stages]
    found = [
        CampbellLine(kind, name, harmonic, abs(harmonic * per_turn) / 60)
        for kind, name, per_turn in meshes
        for harmonic in range(1, harmonics + 1)
    ]
    passing = [(each.name, turns[train.carrier.name] - turns[each.name]) for each in train.centrals]
    found += [
        CampbellLine(LineKind.PASS, f"planets past {name}", 1, abs(train.planets * against) / 60) for name, against in passing
    ]
    found.append(CampbellLine(LineKind.TURN, "planet on its pin", 1, abs(turns["planet"]) / 60))
    return tuple(line for line in found if line.per_rpm)
