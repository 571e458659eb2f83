"""Natural modes of a planetary train by the planar model of Lin and Parker, and its Campbell data. SI units inside.

J. Lin and R. G. Parker, J. Vib. Acoust. 121 (1999) 316-321, for planets alike at equal angles: rotational modes, in which
carrier and centrals only turn; translational modes, in pairs, in which they only travel; planet modes, in which they rest, each
N - 3 times.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from gearcad.core.errors import GeometryError, ParameterError, require_number, require_whole
from gearcad.core.records import Floats, Indices, JsonObject, Notice, freeze
from gearcad.dynamics.planetary.planar_model import MemberMass, PlanarTrain, SpringKind, TrainMasses, TrainSprings
from gearcad.planetary import MeshPhases, PlanetaryTrain
from gearcad.planetary.train_data import speeds

_RIGID = 1e-11
"""Share of the highest frequency below which a mode bends no spring, but for rounding."""

_NEAR = 1e-6
"""Relative distance within which modes are told apart by their motion, not by their frequencies."""

_EQUAL = 1e-9
"""Relative distance within which frequencies are the same but for rounding."""

_STILL = 1e-5
"""Share of a mode by which a central at rest may move."""


_UNKNOWN = MemberMass(mass=None, inertia=None)


class ModeKind(Enum):
    """Motion of carrier and centrals in a mode."""

    ROTATIONAL = "rotational"
    """Rotational modes: the central members only turn, and all planets move alike."""

    TRANSLATIONAL = "translational"
    """Translational modes: the central members only travel. With three planets or more there are two at each frequency."""

    PLANET = "planet"
    """Planet modes: the central members are at rest."""

    MIXED = "mixed"
    """Mixed modes: the central members turn and travel."""


def mass_diagonal(springs: TrainSprings, masses: TrainMasses) -> Floats:
    """Return m, m, J/r^2 (3 (N + 3),) in kg of every body; 0 for coordinates that cannot move.

    Raises ParameterError for a body that moves and has no mass.
    """
    planar = springs.planar
    bodies = [(member.name, masses.members.get(member.name, _UNKNOWN), member.radius) for member in planar.members]
    bodies += [("planet", masses.planet, planar.planet_radius)] * planar.planets
    moving = np.abs(springs.basis).max(axis=1, initial=0.0) > 0
    result = np.zeros(len(springs.basis))
    for place, (name, body, radius) in enumerate(bodies):
        for axis, (key, value, unit) in enumerate(
            (("mass", body.mass, "kg"), ("mass", body.mass, "kg"), ("inertia", body.inertia, "kg·m²"))
        ):
            if not moving[3 * place + axis]:
                continue
            if value is None:
                raise ParameterError(f"{name}.{key}", None, f"must be given in {unit}: without it there are no dynamics")
            require_number(f"{name}.{key}", value, unit, above=0)
            result[3 * place + axis] = value if key == "mass" else value / radius**2
    return result


@dataclass(frozen=True, eq=False)
class MassSprings:
    """Springs and masses in coordinates z = L^T q, M = L L^T, so that orthonormal vectors are modes of mass 1.

    `rooted` (m, n) are elongations times the roots of the stiffness. Its singular values are the frequencies: a frequency of 0
    is 0 but for rounding, which its square is not.
    """

    springs: TrainSprings
    mass: Floats
    lower: Floats
    rooted: Floats

    @classmethod
    def of(cls, springs: TrainSprings, masses: TrainMasses) -> MassSprings:
        """Return springs and masses together. Raises ParameterError where a mass is missing."""
        mass = mass_diagonal(springs, masses)
        lower = np.asarray(np.linalg.cholesky((springs.basis.T * mass) @ springs.basis), float)
        rooted: Floats = np.linalg.solve(lower, (springs.vectors * np.sqrt(springs.stiffness)[:, None]).T).T
        return cls(springs, mass, lower, rooted)

    def places(self, modes: Floats) -> Floats:
        """Return all coordinates (3 (N + 3), g) in modes (n, g)."""
        result: Floats = self.springs.basis @ np.linalg.solve(self.lower.T, modes)
        return result

    def diagonal(self, modes: Floats) -> tuple[Floats, Floats]:
        """Return rising frequencies (g,) in 1/s, and the modes (n, g).

        They are those in the space that g orthonormal `modes` span.
        """
        _, values, within = np.linalg.svd(self.rooted @ modes)
        omega = np.zeros(modes.shape[1])
        omega[: len(values)] = values
        return omega[::-1], (modes @ within.T)[:, ::-1]


class Eigenspace(NamedTuple):
    """Modes (n, g) of a kind at one frequency."""

    kind: ModeKind
    omega: Floats
    modes: Floats


def eigenspaces(model: MassSprings) -> Iterator[Eigenspace]:
    """Yield neighbouring frequencies together, separated by kind, then by frequency again."""
    omega, modes = model.diagonal(np.eye(len(model.lower)))
    omega[omega <= _RIGID * omega[-1]] = 0.0
    for near in runs(omega, _NEAR):
        for kind, space in _kinds(model, modes[:, near]):
            own, turned = model.diagonal(space) if omega[near[-1]] else (np.zeros(space.shape[1]), space)
            for same in runs(own, _EQUAL):
                among = np.full(len(same), own[same].mean())
                yield Eigenspace(kind, among, _told_apart(model, turned[:, same], kind))


def runs(omega: Floats, near: float) -> list[Indices]:
    """Return the places of rising frequencies (n,) in runs without a gap."""
    gaps = np.flatnonzero(np.diff(omega) > near * omega[1:]) + 1
    return np.split(np.arange(len(omega)), gaps)


# ---------------------------------------------------------------------- kinds


def _kinds(model: MassSprings, modes: Floats) -> list[tuple[ModeKind, Floats]]:
    """Return the space of some modes (n, g), split into those of each kind.

    Modes of one frequency come in any mixture.
    """
    return split_kinds(_travel(model, modes), _turn(model, modes), modes)


def split_kinds(travel: Floats, turn: Floats, modes: Floats) -> list[tuple[ModeKind, Floats]]:
    """Return the space of some modes (n, g), split into those of each kind.

    `travel` and `turn` (r, g) are the motions of the members in them.
    """
    at_place, unturned, still = _unmoved(travel), _unmoved(turn), _unmoved(np.vstack([travel, turn]))
    rotational, translational = _without(at_place, still), _without(unturned, still)
    parts = np.hstack([rotational, translational, still])
    square = parts.shape[1] == modes.shape[1]
    if not square or np.abs(parts.T @ parts - np.eye(len(parts))).max() > _STILL:
        return [(ModeKind.MIXED, modes)]
    kinds = ModeKind.ROTATIONAL, ModeKind.TRANSLATIONAL, ModeKind.PLANET
    return [(kind, modes @ part) for kind, part in zip(kinds, (rotational, translational, still), strict=True) if part.size]


def _travel(model: MassSprings, modes: Floats) -> Floats:
    return _parts(model, modes, [0, 1, 3, 4, 6, 7])


def _turn(model: MassSprings, modes: Floats) -> Floats:
    return _parts(model, modes, [2, 5, 8])


def _parts(model: MassSprings, modes: Floats, rows: list[int]) -> Floats:
    """Return the motion of members in modes over that of all bodies, by way and by energy.

    Both are needed, for a heavy member moves little, a light one far.
    """
    places = model.places(modes)
    ways = places[rows] / np.linalg.norm(places, 2)
    return np.vstack([ways, np.sqrt(model.mass[rows])[:, None] * places[rows]])


def _unmoved(parts: Floats) -> Floats:
    """Return an orthonormal basis (g, d) of the combinations of g modes in which the parts (r, g) are at rest."""
    _, values, mixtures = np.linalg.svd(parts)
    return mixtures[int((values > _STILL).sum()) :].T


def _without(space: Floats, less: Floats) -> Floats:
    """Return an orthonormal basis of a space (g, d) without another space (g, e) within it."""
    if not space.shape[1]:
        return space
    _, _, mixtures = np.linalg.svd(less.T @ space)
    left: Floats = space @ mixtures[less.shape[1] :].T
    return left


# ---------------------------------------------------------------------- which of them


def _told_apart(model: MassSprings, modes: Floats, kind: ModeKind) -> Floats:
    """Return modes of one frequency in a unique basis: the second is at rest where the first moves, and so on; their signs are
    set.

    So they are not as rounding mixes them. Of a translational pair one travels along x, the other along y.
    """
    places, count = model.places(modes), modes.shape[1]
    sizes = np.linalg.norm(places, axis=1)
    if kind is ModeKind.TRANSLATIONAL and count == 2:
        first = 3 * int(sizes[[0, 3, 6]].argmax())
        rows = np.array([first, first + 1])
    else:
        rows = np.argsort(-np.round(sizes / sizes.max(), 6), kind="stable")[:1]
        rest = places
        for _ in range(count - 1):
            taken = rest[rows[-1]] / np.linalg.norm(rest[rows[-1]])
            rest = rest - np.outer(rest @ taken, taken)
            left = np.linalg.norm(rest, axis=1)
            rows = np.append(rows, int(np.round(left / left.max(), 6).argmax()))
    turned, lower = np.linalg.qr(places[rows].T)
    signs = np.where(np.diag(lower) < 0, -1.0, 1.0)
    result: Floats = modes @ (turned * signs)
    return result


_SAME = 1e-9
"""Relative distance within which angles and stiffnesses are the same but for rounding."""


class ModeFamily(NamedTuple):
    """Modes of a kind at one `frequency` (Hz): as many as `multiplicity`, from number `first` (0 is the lowest) on."""

    frequency: float
    kind: ModeKind
    multiplicity: int
    first: int

    def to_dict(self) -> JsonObject:
        """Return the family as a part of `planetary.json`."""
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
        """Names of carrier, centrals, "planet 1" and so on: the rows of a shape."""
        return (*self.springs.members, *(f"planet {n + 1}" for n in range(self.springs.planar.planets)))

    @property
    def turns(self) -> Floats:
        """Turns of the bodies (n, N + 3) in rad, for a modal mass of 1 kg."""
        planar = self.springs.planar
        radii = [member.radius for member in planar.members] + [planar.planet_radius] * planar.planets
        return np.asarray(self.shape[:, :, 2] / np.array(radii), float)

    def of_kind(self, kind: ModeKind) -> Indices:
        """Return the numbers of the modes of a kind, from 0."""
        return np.flatnonzero([each is kind for each in self.kinds])

    def to_dict(self) -> JsonObject:
        """Return plain lists."""
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
    """Return the modes of a train's springs and masses. Raises ParameterError where a mass is missing."""
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
    """Return the reason why modes are not rotational, translational or planet modes; "" where there is none."""
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


NEAR = 0.05
"""Part of the speed of a resonance within which a load gets a notice."""

_SHAKEN = 1e-6
"""Share of the excitation by all planets together below which excitations cancel but for rounding."""

_UNMESHED = 1e-9
"""Part of the potential energy that a mesh holds in a mode that does not move it."""


class LineKind(Enum):
    """Sources that shake a train."""

    MESH = "mesh"
    """Stiffness and transmission error of a central's meshes."""

    STAGE = "stage"
    """Those of a stage; its force turns against the carrier, so travel is shaken at the frequency of the carrier off it too."""

    PASS = "planet pass"
    """Planets that pass a tooth of a central."""

    TURN = "turn"
    """A planet that turns on its pin."""


class CampbellLine(NamedTuple):
    """A `harmonic` of a `source`: its frequency is `per_rpm` (Hz) times the speed of the input (rpm)."""

    kind: LineKind
    source: str
    harmonic: int
    per_rpm: float

    @property
    def name(self) -> str:
        """Name such as "2 x sun-planet"."""
        return self.source if self.harmonic == 1 else f"{self.harmonic} x {self.source}"


class Resonance(NamedTuple):
    """Meeting of a line and modes: `speed` of the input (rpm) and `frequency` (Hz), by numbers of `line` and `family`.

    `share` is the part of the possible excitation by the planets' meshes that is left with their phases: 0 where they cancel.
    It is None where that is not judged, for lines that are not meshes of the set.
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
    """Campbell diagram: `lines` over the input's speed up to `highest_speed` (rpm), `families` of modes, and `resonances`.

    Resonances are by rising speed. `shares` (l, f) of lines in families are those of the resonances, nan where they are not
    judged. `speed` (rpm, without its sign) is that of the load, where one is given.
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
        """Resonances at which modes are shaken."""
        return tuple(each for each in self.resonances if each.excited)

    @property
    def near(self) -> tuple[Resonance, ...]:
        """Resonances that excite modes within NEAR of the load's speed, the nearest first, even beyond the diagram."""
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
        """Notices that the load runs near a resonance.

        There is one for each mode and speed, of all harmonics that meet there.
        """
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
        """Return the kinds of the modes that a line shakes."""
        (row,) = [i for i, line in enumerate(self.lines) if (line.source, line.harmonic) == (source, harmonic)]
        found = {family.kind for family, share in zip(self.families, self.shares[row], strict=True) if share > 0}
        return tuple(kind for kind in ModeKind if kind in found)

    def to_dict(self) -> JsonObject:
        """Return plain lists; no value (null) where a share is not judged."""
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
    """Return the Campbell diagram up to a speed of the input (rpm), with `harmonics` harmonics of every mesh.

    `given_speeds` (rpm) are those of a differential beside its input at `highest_speed`: all rise alike. `speed` (rpm) is that
    of the load: resonances near it get a notice. Raises ParameterError, and GeometryError where the set turns as one.
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
    """Return the shares (f,) of the possible excitation of each family that a harmonic of a mesh has.

    It is |sum_n y_n exp(2 pi i m lambda_n)|, y_n the approach of the flanks of planet n in a mode, over the root of N sum
    y_n^2; of several modes the root of the sum of squares. It is 0 where the phases of the planets (`ahead`, base pitches)
    cancel it.
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
    """Return speeds of all shafts and of the planet against the carrier ("planet"), over that of the input.

    `given` are speeds in rpm. Raises ParameterError for an input at rest, GeometryError where the set turns as one.
    """
    turning = {name: speed for name, speed in given.items() if name != train.input}
    turning[train.input] = given[train.input] or 1.0
    found = speeds(train, turning)
    if not found.planet_relative:
        raise GeometryError("speeds", 0.0, "must let the planets turn on their pins: nothing meshes", "rpm")
    every = {**found.members, "planet": found.planet_relative}
    return {name: speed / turning[train.input] for name, speed in every.items()}


def _lines(train: PlanetaryTrain, turns: Mapping[str, float], harmonics: int) -> tuple[CampbellLine, ...]:
    """Return the lines of meshes of the set and of its stages with their harmonics, then lines of events once a turn."""
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
