"""Masses and inertias of a planetary train: of its gears' exact solids, or as they are given."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from gearcad.errors import GearcadError
from gearcad.geometry import Gear
from gearcad.planetary import Central, PlanetaryTrain
from gearcad.planetary.materials import TrainMaterial, material_of

__all__ = ["MemberMass", "TrainMasses", "train_masses"]


@dataclass(frozen=True, kw_only=True)
class MemberMass:
    """`mass` in kg and `inertia` in kg·m² about its own axis; None where it is unknown, and `why`.

    `given` names those of the two that are not of the solid.
    """

    mass: float | None
    inertia: float | None
    given: tuple[str, ...] = ()
    why: str = ""

    def to_dict(self) -> dict[str, Any]:
        """As documents have it."""
        found = {"mass": self.mass, "inertia": self.inertia, "given": list(self.given)}
        return {**found, "why": self.why} if self.why else found


@dataclass(frozen=True, kw_only=True)
class TrainMasses:
    """Of both centrals and the carrier by their names (`members`), and of one planet with all its rims.

    The carrier is without its planets.
    """

    members: Mapping[str, MemberMass]
    planet: MemberMass

    @property
    def missing(self) -> tuple[str, ...]:
        """Why masses or inertias are unknown, one line each; () where all are known."""
        return tuple(each.why for each in (*self.members.values(), self.planet) if each.why)

    def to_dict(self) -> dict[str, Any]:
        """As documents have them."""
        return {**{name: each.to_dict() for name, each in self.members.items()}, "planet": self.planet.to_dict()}


def train_masses(train: PlanetaryTrain, material: TrainMaterial | None = None) -> TrainMasses:
    """Of a train whose gears are of one `material`, or of one each, by the name of the central or rim.

    What is given wins; only what is not is weighed.
    """
    carrier, densities = train.carrier, _densities(train, material)
    members = {central.name: _central(central, densities[central.name]) for central in train.centrals}
    rims = {rim.name: (rim.gear, densities[rim.name]) for rim in train.rims}
    planet = _either(rims, carrier.planet_mass, carrier.planet_inertia)
    return TrainMasses(members={**members, carrier.name: _carrier(train)}, planet=planet)


def _densities(train: PlanetaryTrain, material: TrainMaterial | None) -> dict[str, float]:
    """In kg/m³, of each central and rim."""
    return {each.name: material_of(material, each.name).density for each in (*train.centrals, *train.rims)}


def _central(central: Central, density: float) -> MemberMass:
    return _either({central.name: (central.gear, density)}, central.mass, central.inertia)


def _carrier(train: PlanetaryTrain) -> MemberMass:
    """That of the carrier as it is given: it has no solid."""
    carrier = train.carrier
    values = {"mass": carrier.mass, "inertia": carrier.inertia}
    given = tuple(name for name, value in values.items() if value is not None)
    absent = [name for name, value in values.items() if value is None]
    why = f"{carrier.name}.{' and '.join(absent)}: must be given: a carrier has no solid here" if absent else ""
    return MemberMass(**values, given=given, why=why)


def _either(gears: Mapping[str, tuple[Gear, float]], mass: float | None, inertia: float | None) -> MemberMass:
    """What is given, and else that of gears of some densities together on one axis."""
    given = tuple(name for name, value in (("mass", mass), ("inertia", inertia)) if value is not None)
    if len(given) == 2:
        return MemberMass(mass=mass, inertia=inertia, given=given)
    try:
        weighed = [_weighed(name, gear, density) for name, (gear, density) in gears.items()]
    except _NoSolid as error:
        return MemberMass(mass=mass, inertia=inertia, given=given, why=str(error))
    own_mass, own_inertia = (sum(column) for column in zip(*weighed, strict=True))
    return MemberMass(mass=own_mass if mass is None else mass, inertia=own_inertia if inertia is None else inertia, given=given)


class _NoSolid(Exception):
    """Why a gear has no solid."""


def _weighed(name: str, gear: Gear, density: float) -> tuple[float, float]:
    """Mass (kg) and inertia (kg·m²) of a gear. Raises _NoSolid."""
    from gearcad.solids.exact.inertia import mass_properties

    try:
        found = mass_properties(gear, density)
    except GearcadError as error:
        raise _NoSolid(f"{name}.{error}") from error
    return found.mass, found.inertia
