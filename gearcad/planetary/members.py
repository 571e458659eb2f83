"""What a planetary train is made of: centrals on the axis, rims of the planets, the carrier, pairs before or behind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from gearcad.errors import GeometryError, ParameterError, require_name
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.derived import NOT_GIVEN
from gearcad.ranges import DEVIATION, INERTIA, OFFSET, STIFFNESS, TORSIONAL_STIFFNESS, Range
from gearcad.reprs import concise
from gearcad.schema import NamedPart, Words

__all__ = ["Carrier", "Central", "PairStage", "Rim"]

_ANGLE = Range("deg", -360.0, 360.0)
_MASS = Range("kg", 1e-12, 1e9)
_SUPPORT = STIFFNESS._replace(may_vanish=True)


@dataclass(frozen=True, kw_only=True)
class Rim(NamedPart):
    """The teeth of one rim of every planet: `gear`, whose teeth begin `axial_position` (mm) above those of the first rim.

    Not given, the train puts them where they clear what meshes with the first rim.
    `clocking` (degrees) turns its tooth 0 against that of the first rim, counter-clockwise seen from +z, alike on all planets;
    "adjusted" turns that of each planet by itself until it fits where the planet stands, however many there are.
    `tooth_errors` in µm, one a planet (none: 0): how far its driven flanks stand proud, along the line of action.
    Raises ParameterError, GeometryError.
    """

    name: str
    gear: Gear
    clocking: Annotated[float | Literal["adjusted"], _ANGLE, Words("clocking against the first rim", "κ")] = 0.0
    axial_position: Annotated[float, OFFSET, Words("axial position of its teeth")] = NOT_GIVEN
    tooth_errors: Annotated[tuple[float, ...], DEVIATION, Words("errors of the planets' teeth")] = ()

    __repr__ = concise

    def __post_init__(self) -> None:
        self._check_fields()
        _require_gear(self.name, self.gear)
        if self.gear.internal:
            raise GeometryError(f"{self.name}.teeth", self.gear.teeth, "must be above 0: planets have outer teeth")


@dataclass(frozen=True, kw_only=True)
class Central(NamedPart):
    """A gear on the axis of the train, sun or ring, that meshes with the rim `meshes` of every planet, middle by middle.

    `support_stiffness` (N/µm) of its bearing: None holds it, 0 lets it float. `torsional_stiffness` (N·m/rad) is that of
    what holds or drives it: None is rigid. `mesh_stiffness` (N/µm) is the mean of the mesh with one planet: None computes it.
    `mass` (kg) and `inertia` (kg·m²): None takes those of its solid. `run_out` (µm) is the eccentricity of its teeth, half
    the total indicated reading. Raises ParameterError.
    """

    name: str
    gear: Gear
    meshes: str
    support_stiffness: Annotated[float | None, _SUPPORT, Words("stiffness of its bearing")] = None
    torsional_stiffness: Annotated[float | None, TORSIONAL_STIFFNESS, Words("torsional stiffness of what holds it")] = None
    mesh_stiffness: Annotated[float | None, STIFFNESS, Words("mean stiffness of the mesh with one planet")] = None
    mass: Annotated[float | None, _MASS, Words("mass", "m")] = None
    inertia: Annotated[float | None, INERTIA, Words("inertia", "J")] = None
    run_out: Annotated[float, DEVIATION, Words("eccentricity, half its run-out", "e")] = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        self._check_fields()
        _require_gear(self.name, self.gear)
        require_name(f"{self.name}.meshes", self.meshes)

    @property
    def mesh_name(self) -> str:
        """Of its mesh with the planets, such as "sun-planet"."""
        return f"{self.name}-{self.meshes}"


@dataclass(frozen=True, kw_only=True)
class Carrier(NamedPart):
    """What holds the pins on which the planets turn.

    `support_stiffness`, `torsional_stiffness`, `mass`, `inertia` and `run_out` (of its bearing) as of a Central; without mass
    and inertia there are no dynamics. `pin_diameter` (mm) of the pins, None takes the bores of the planets. `pin_stiffness`
    (N/µm) of one pin with its bearing, None is rigid. `pin_errors` (µm), one a planet (none: 0), tangential: positive in the
    direction in which the first central pushes the planet. `planet_mass` (kg) and `planet_inertia` (kg·m²) of one planet: None
    takes those of its solid. Raises ParameterError.
    """

    name: str = "carrier"
    support_stiffness: Annotated[float | None, _SUPPORT, Words("stiffness of its bearing")] = None
    torsional_stiffness: Annotated[float | None, TORSIONAL_STIFFNESS, Words("torsional stiffness of what holds it")] = None
    pin_diameter: Annotated[float | None, Range("mm", 0.0, 1e5, ends="(]"), Words("diameter of the pins")] = None
    pin_stiffness: Annotated[float | None, STIFFNESS, Words("stiffness of a pin and its bearing")] = None
    pin_errors: Annotated[tuple[float, ...], DEVIATION, Words("tangential errors of the pins")] = ()
    mass: Annotated[float | None, _MASS, Words("mass", "m")] = None
    inertia: Annotated[float | None, INERTIA, Words("inertia", "J")] = None
    run_out: Annotated[float, DEVIATION, Words("eccentricity, half its run-out", "e")] = 0.0
    planet_mass: Annotated[float | None, _MASS, Words("mass of a planet", "m_p")] = None
    planet_inertia: Annotated[float | None, INERTIA, Words("inertia of a planet", "J_p")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        self._check_fields()


@dataclass(frozen=True, kw_only=True)
class PairStage(NamedPart):
    """A pair on fixed axes before or behind the set: `pinion` and `wheel` name what turns with each gear.

    One of the two is a member of the set - of a pre-stage the wheel is the carrier - or of a stage before it; the other is a
    shaft of its own. `angle` (degrees) is where the axis that is not the train's lies, seen from the train's axis, from +x.
    Without `axial_position` (mm) the train puts it beside the set. Raises ParameterError.
    """

    name: str
    pair: GearPair
    pinion: str
    wheel: str
    angle: Annotated[float, _ANGLE, Words("direction of the other axis")] = 0.0
    axial_position: Annotated[float, OFFSET, Words("axial position of the pinion's teeth")] = NOT_GIVEN

    __repr__ = concise

    def __post_init__(self) -> None:
        self._check_fields()
        if not isinstance(self.pair, GearPair):
            raise ParameterError(f"{self.name}.pair", self.pair, "must be a GearPair")
        for end in ("pinion", "wheel"):
            require_name(f"{self.name}.{end}", getattr(self, end))
        if self.pinion == self.wheel:
            raise ParameterError(f"{self.name}.wheel", self.wheel, "must be another shaft than the pinion's")


def _require_gear(name: str, gear: object) -> None:
    if not isinstance(gear, Gear):
        raise ParameterError(f"{name}.gear", gear, "must be a Gear")
