"""Planetary sets of a gearbox: centrals, planets that mesh with planets or sit beside them, carriers, and their meshes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from typing import NamedTuple

from gearcad.core.errors import ParameterError, require_number, require_whole
from gearcad.core.records import JsonObject
from gearcad.geometry import Gear

_MOST_TEETH = 2000
MOST_PLANETS = 24
"""Largest number of planets of a name."""


@dataclass(frozen=True, kw_only=True)
class SetPlanet:
    """A planet of a set: `teeth`, the planet that it `meshes` with, or the planet `beside` which it sits on one body."""

    name: str
    teeth: int
    meshes: str = ""
    beside: str = ""

    def __post_init__(self) -> None:
        require_whole("teeth", self.teeth, at_least=3, at_most=_MOST_TEETH)
        if self.meshes and self.beside:
            raise ParameterError("beside", self.beside, "must not be given with meshes: a rim turns with its body")


@dataclass(frozen=True, kw_only=True)
class SetCentral:
    """A sun or a ring (`teeth` below 0) of a set, and the planet that it `meshes` with."""

    name: str
    teeth: int
    meshes: str

    def __post_init__(self) -> None:
        if isinstance(self.teeth, bool) or not isinstance(self.teeth, int) or not 3 <= abs(self.teeth) <= _MOST_TEETH:
            permitted = f"must be a whole number from 3 to {_MOST_TEETH}, or from -{_MOST_TEETH} to -3 for a ring"
            raise ParameterError("teeth", self.teeth, permitted)


@dataclass(frozen=True, kw_only=True)
class SetGear:
    """The `gear` of a central or a planet, whose teeth begin at `axial_position` (mm) above the bottom of its set.

    `clocking` (degrees) turns tooth 0 of a planet beside another against that one's, counter-clockwise. `centre_distance` (mm)
    is that of a planet's axis from the axis of the set, None for the one at which its first central meshes without backlash;
    `mate_distance` (mm) that from the planet with which it meshes, None likewise.

    For vibration: `mass` (kg) and `inertia` (kg·m²), None for those of its solid; of a sun or a ring `support_stiffness` (N/µm)
    of its bearing, None holds it and 0 lets it float, and `torsional_stiffness` (N·m/rad) of what holds or drives it;
    `mesh_stiffness` (N/µm) is the mean of its mesh with one planet, None for that of ISO 6336-1, and `mesh_error` (µm) the
    amplitude of its transmission error at the tooth frequency; `pin_stiffness` (N/µm) of a planet, None is rigid. Raises
    ParameterError.
    """

    gear: Gear
    axial_position: float = 0.0
    clocking: float = 0.0
    centre_distance: float | None = None
    mate_distance: float | None = None
    mass: float | None = None
    inertia: float | None = None
    support_stiffness: float | None = None
    torsional_stiffness: float | None = None
    mesh_stiffness: float | None = None
    mesh_error: float = 0.0
    pin_stiffness: float | None = None

    def __post_init__(self) -> None:
        require_number("axial_position", self.axial_position, "mm", at_least=-1e5, at_most=1e5)
        require_number("clocking", self.clocking, "deg", at_least=-360, at_most=360)
        for name in ("centre_distance", "mate_distance"):
            if (value := getattr(self, name)) is not None:
                require_number(name, value, "mm", above=0, at_most=1e5)
        require_number("mesh_error", self.mesh_error, "µm", at_least=0, at_most=1e3)
        _check_dynamics(self, "mass", "inertia", "mesh_stiffness", "pin_stiffness")
        _check_dynamics(self, "support_stiffness", "torsional_stiffness", may_vanish=True)

    @property
    def top(self) -> float:
        """Height of the upper end of its teeth (mm)."""
        return self.axial_position + self.gear.face_width


@dataclass(frozen=True, kw_only=True)
class SetCarrier:
    """Mass (kg) and inertia (kg·m²) of the carrier of a set, without which there are no modes, and stiffnesses as of a gear.

    Raises ParameterError.
    """

    mass: float | None = None
    inertia: float | None = None
    support_stiffness: float | None = None
    torsional_stiffness: float | None = None

    def __post_init__(self) -> None:
        _check_dynamics(self, "mass", "inertia")
        _check_dynamics(self, "support_stiffness", "torsional_stiffness", may_vanish=True)


_UNITS = {
    "mass": "kg",
    "inertia": "kg·m²",
    "support_stiffness": "N/µm",
    "torsional_stiffness": "N·m/rad",
    "mesh_stiffness": "N/µm",
    "pin_stiffness": "N/µm",
}


def _check_dynamics(own: object, *names: str, may_vanish: bool = False) -> None:
    """Raise ParameterError unless values are not given, or above 0 (or 0, if that may be)."""
    for name in names:
        if (value := getattr(own, name)) is not None:
            least = {"at_least": 0.0} if may_vanish else {"above": 0.0}
            require_number(name, value, _UNITS[name], at_most=1e12, **least)


@dataclass(frozen=True, kw_only=True)
class SetGearing:
    """The `gears` of a set by the names of centrals and planets, and the number of `planets` of each name, at equal angles.

    `axial_position` (mm) is the bottom of the set in its gearbox, None behind the set before it. Raises ParameterError.
    """

    planets: int
    gears: Mapping[str, SetGear]
    axial_position: float | None = None
    carrier: SetCarrier = field(default_factory=SetCarrier)

    def __post_init__(self) -> None:
        require_whole("planets", self.planets, at_least=1, at_most=MOST_PLANETS)
        if self.axial_position is not None:
            require_number("axial_position", self.axial_position, "mm", at_least=-1e5, at_most=1e5)


@dataclass(frozen=True, kw_only=True)
class MemberSet:
    """A planetary set: its centrals, its planets, and the carrier on which these sit; its `gearing`, if more than teeth is
    known of it. Raises ParameterError.
    """

    name: str
    centrals: tuple[SetCentral, ...]
    planets: tuple[SetPlanet, ...]
    carrier: str = "carrier"
    gearing: SetGearing | None = None

    def __post_init__(self) -> None:
        names = [each.name for each in self.planets]
        if not self.centrals or not names:
            raise ParameterError(self.name, None, "must have a sun or a ring, and a planet")
        every = [*names, *(each.name for each in self.centrals), self.carrier]
        if twice := [name for name in every if every.count(name) > 1]:
            raise ParameterError(f"{self.name}.{twice[0]}", twice[0], "must be the name of one member or planet")
        for part in self.parts:
            for key in ("meshes", "beside"):
                mate = getattr(part, key, "")
                if mate and (mate not in names or mate == part.name):
                    others = ", ".join(name for name in names if name != part.name) or "none"
                    raise ParameterError(f"{self.name}.{part.name}.{key}", mate, f"must be another planet of the set: {others}")
        beside = {each.name: each.beside for each in self.planets}
        for name in names:
            passed = [name]
            while beside[passed[-1]]:
                passed.append(beside[passed[-1]])
                if passed.count(passed[-1]) > 1:
                    raise ParameterError(f"{self.name}.{name}.beside", beside[name], "must not lead back to itself")
        if self.gearing is not None:
            self._check_gearing(self.gearing)

    def _check_gearing(self, gearing: SetGearing) -> None:
        """Raise ParameterError unless there is a gear with the teeth of each central and planet."""
        for part in self.parts:
            own = gearing.gears.get(part.name)
            if own is None or own.gear.teeth != part.teeth:
                value = None if own is None else own.gear.teeth
                raise ParameterError(f"{self.name}.{part.name}.teeth", value, f"must be {part.teeth}, those of its gear")

    @property
    def parts(self) -> tuple[SetCentral | SetPlanet, ...]:
        """Centrals, then planets."""
        return (*self.centrals, *self.planets)

    @property
    def members(self) -> tuple[str, ...]:
        """Names of carrier and centrals with that of the set, such as "set1.sun"."""
        return tuple(f"{self.name}.{each}" for each in (self.carrier, *(central.name for central in self.centrals)))

    def to_dict(self) -> JsonObject:
        """Return teeth and mates of centrals and planets by their names, and the name of the carrier."""
        planets = {
            each.name: {"teeth": each.teeth, "meshes": each.meshes or None, "beside": each.beside or None}
            for each in self.planets
        }
        centrals = {each.name: {"teeth": each.teeth, "meshes": each.meshes} for each in self.centrals}
        found: JsonObject = {"centrals": centrals, "planets": planets, "carrier": self.carrier}
        if self.gearing is not None:
            gears = {
                name: {each.name: getattr(own, each.name) for each in fields(own) if each.name != "gear"}
                for name, own in self.gearing.gears.items()
            }
            about = {"planets": self.gearing.planets, "axial_position": self.gearing.axial_position}
            found["gearing"] = {**about, "carrier": asdict(self.gearing.carrier), "gears": gears}
        return found

    def body_of(self, planet: str) -> str:
        """Return the name of the planet on whose body a planet sits."""
        beside = next(each.beside for each in self.planets if each.name == planet)
        return self.body_of(beside) if beside else planet


class GearboxMesh(NamedTuple):
    """A mesh: its name, its set's carrier, and body and teeth of both gears."""

    name: str
    carrier: str
    first: str
    first_teeth: int
    second: str
    second_teeth: int


def meshes_of(each: MemberSet) -> Iterator[GearboxMesh]:
    """Yield the meshes of a set: of its centrals, then of planets with planets."""
    teeth = {planet.name: planet.teeth for planet in each.planets}
    carrier = f"{each.name}.{each.carrier}"
    parts: Sequence[SetCentral | SetPlanet] = (*each.centrals, *(planet for planet in each.planets if planet.meshes))
    for part in parts:
        own = part.name if isinstance(part, SetCentral) else each.body_of(part.name)
        first, second = (f"{each.name}.{body}" for body in (own, each.body_of(part.meshes)))
        yield GearboxMesh(f"{each.name}.{part.name}-{part.meshes}", carrier, first, part.teeth, second, teeth[part.meshes])
