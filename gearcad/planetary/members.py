"""Members of a planetary train: centrals, rims, carrier, stages; their meshes, materials and load."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Annotated, Any, Literal

from gearcad.core.errors import GeometryError, InputError, ParameterError, format_number, require_name
from gearcad.core.quantities import (
    APPLICATION_FACTOR,
    DEVIATION,
    FRICTION,
    INERTIA,
    NOT_GIVEN,
    OFFSET,
    SPEED,
    STIFFNESS,
    TORQUE,
    TORSIONAL_STIFFNESS,
    WHEN_GIVEN,
    AssumedNumber,
    NamedPart,
    Range,
    Words,
    require_fields,
)
from gearcad.core.records import Notice, PerGear, Role, concise
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.pair_data import PairData
from gearcad.material import Material, Materials

_EFFICIENCY = Range("", 0.0, 1.0, ends="(]")
_SHARING = Range("", 1.0, 24.0)
"""Permitted load sharing factor: from equal shares to all load on one of the largest number of planets."""

TORQUES = ("output_torque", "input_torque", "torque")
"""Keys of which one gives the torque of a train; `torque` is the old name of one of the others."""


def torque_key(instance: Any) -> str:
    """Return which of TORQUES an object gives. Raises ParameterError unless it is one."""
    given = [key for key in TORQUES if getattr(instance, key) is not None]
    if not given:
        raise ParameterError("output_torque", None, "must be given, in N·m on the output, or input_torque, on the input")
    if len(given) > 1:
        value = getattr(instance, given[1])
        raise ParameterError(given[1], value, f"must be left out beside {given[0]}: one torque follows from the other", "N·m")
    return given[0]


def old_torque_notice(new: str) -> Notice:
    """Return the notice of a train whose torque is given under its old name, `torque`, in place of `new`."""
    return Notice("old-name", f"torque is the old name of {new}, which means the same; write {new} instead", where="load")


@dataclass(frozen=True, kw_only=True)
class TrainLoad:
    """`output_torque` or `input_torque` in N·m, negative if the output drives back, and `speed` of the input in rpm.

    `torque` is the old name of `output_torque`. `mesh_efficiency` is that of every mesh with the carrier at rest: 1 has no
    losses; `friction`, a coefficient of the flanks, gives it where it is not given itself. `application_factor` K_A multiplies
    the torque in the ratings, and so does `mesh_load_factor` K_gamma, by how much the planet that carries most carries more
    than its share; None takes what is computed of the sharing. Raises ParameterError.
    """

    output_torque: Annotated[float | None, TORQUE, Words("torque on the output", "T")] = None
    input_torque: Annotated[float | None, TORQUE, Words("torque on the input", "T")] = None
    torque: Annotated[float | None, TORQUE, Words("torque on the output, old name", "T")] = None
    speed: Annotated[float, SPEED, Words("speed of the input", "n")] = 0.0
    mesh_efficiency: Annotated[float, _EFFICIENCY, Words("efficiency of a mesh", "η")] = AssumedNumber(1.0)
    application_factor: Annotated[float, APPLICATION_FACTOR, Words("application factor", "K_A", "ISO 6336-1")] = AssumedNumber(
        1.0
    )
    mesh_load_factor: Annotated[float | None, _SHARING, Words("mesh load factor of the planets", "K_γ", "ISO 6336-1")] = None
    friction: Annotated[float | None, FRICTION, Words("friction of the flanks", "µ"), WHEN_GIVEN] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        torque_key(self)

    @property
    def given_torque(self) -> float:
        """The torque that is given (N·m), on the output or on the input."""
        value: float = getattr(self, torque_key(self))
        return value

    @property
    def on_input(self) -> bool:
        """Whether the given torque is that of the input."""
        return self.input_torque is not None

    def times(self, factor: float) -> TrainLoad:
        """Return the same load with `factor` times its torque."""
        return replace(self, **{torque_key(self): self.given_torque * factor})

    def torque_words(self, output: str, input_: str) -> str:
        """Return the torque and the member on which it acts, in words."""
        return f"{format_number(self.given_torque)} N·m on {input_ if self.on_input else output}"

    @property
    def notices(self) -> Iterator[Notice]:
        """Notice that the torque is given under its old name; none otherwise."""
        if self.torque is not None:
            yield old_torque_notice("output_torque")


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
        """Name of its mesh with the planets, such as "sun-planet"."""
        return f"{self.name}-{self.meshes}"


@dataclass(frozen=True, kw_only=True)
class Carrier(NamedPart):
    """Carrier, which holds the pins on which the planets turn.

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
    Without `axial_position` (mm) the train puts it beside the set. `pinion_inertia` and `wheel_inertia` (kg·m²) are those of
    what turns with each gear beside the members of the set, the gear included: at the ratios of the stages they are added to
    the member of the set that turns with them, by teeth that do not give way. None is not counted. Raises ParameterError.
    """

    name: str
    pair: GearPair
    pinion: str
    wheel: str
    angle: Annotated[float, _ANGLE, Words("direction of the other axis")] = 0.0
    axial_position: Annotated[float, OFFSET, Words("axial position of the pinion's teeth")] = NOT_GIVEN
    pinion_inertia: Annotated[float | None, INERTIA, Words("inertia on the pinion's shaft", "J")] = None
    wheel_inertia: Annotated[float | None, INERTIA, Words("inertia on the wheel's shaft", "J")] = None

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


class SetType(Enum):
    """Sets with one carrier, told apart by which centrals are rings and whether the planets are stepped."""

    A = "A"
    """Type A: sun, planet, ring."""

    B = "B"
    """Type B: sun, stepped planet, ring."""

    C = "C"
    """Type C: sun, stepped planet, sun."""

    D = "D"
    """Type D: ring, stepped planet, ring."""


@dataclass(frozen=True, kw_only=True)
class SetMesh:
    """The mesh of a central with the rim of a planet: `pair` holds both, the smaller external gear as its pinion."""

    central: Central
    rim: Rim
    pair: GearPair

    @property
    def name(self) -> str:
        """Name of the mesh, such as "sun-planet"."""
        return self.central.mesh_name

    @property
    def external(self) -> bool:
        """Whether the central gear is a sun."""
        return not self.central.gear.internal

    @property
    def central_role(self) -> Role:
        """Role of the central in the pair."""
        return Role.PINION if self.pair.pinion is self.central.gear else Role.WHEEL

    @property
    def rim_role(self) -> Role:
        """Role of the planet's rim in the pair."""
        return self.central_role.mate

    @property
    def working_pressure_angle(self) -> float:
        """Working pressure angle alpha_wt in radians."""
        return math.radians(self.pair.working_transverse_pressure_angle)

    @property
    def central_base_radius(self) -> float:
        """r_b of the central (mm), a magnitude."""
        return base_radius(self.central.gear)

    @property
    def rim_base_radius(self) -> float:
        """r_b of the rim (mm)."""
        return base_radius(self.rim.gear)

    @classmethod
    def of(cls, central: Central, rim: Rim, centre_distance: float) -> SetMesh:
        """Return the mesh at a centre distance (mm, a magnitude; NaN: the one without backlash).

        Raises InputError, whose parameter begins with the mesh's name.
        """
        mates, signed = mates_of(central, rim), -centre_distance if central.gear.internal else centre_distance
        distance = NOT_GIVEN if math.isnan(signed) else signed
        try:
            pair = GearPair(pinion=mates.pinion, wheel=mates.wheel, name=mates.name, centre_distance=distance)
        except InputError as error:
            raise error.within(mates.name) from None
        return cls(central=central, rim=rim, pair=pair)


def mates_of(central: Central, rim: Rim) -> PairData:
    """Return the pair of a central and the rim it meshes with; the smaller external gear is the pinion.

    Whether they fit is not checked.
    """
    first = not central.gear.internal and central.gear.teeth <= rim.gear.teeth
    pinion, wheel = (central.gear, rim.gear) if first else (rim.gear, central.gear)
    return PairData(pinion=pinion, wheel=wheel, name=central.mesh_name)


def base_radius(gear: Gear) -> float:
    """r_b of a gear (mm), a magnitude."""
    return abs(gear.base_diameter) / 2


TrainMaterial = Material | Mapping[str, Material]
"""Material of all gears of a train, or of each gear by its name; steel for gears without one."""


def material_of(material: TrainMaterial | None, gear: str) -> Material:
    """Return the material of a gear, by the name of the central, the rim, or the gear of a stage."""
    if isinstance(material, Mapping):
        return material.get(gear, Material())
    return material or Material()


def mesh_material(material: TrainMaterial | None, mesh: SetMesh) -> Materials:
    """Return the material, or both materials, of the pair of a mesh."""
    names = {mesh.central_role: mesh.central.name, mesh.rim_role: mesh.rim.name}
    return _of_pair(material, PerGear.each(lambda role: names[role]))


def stage_material(material: TrainMaterial | None, stage: PairStage) -> Materials:
    """Return the material, or both materials, of the pair of a stage."""
    return _of_pair(material, stage.pair.gears.map(lambda gear: gear.name))


def _of_pair(material: TrainMaterial | None, names: PerGear[str]) -> Materials:
    pinion, wheel = (material_of(material, name) for name in names)
    return pinion if pinion == wheel else PerGear(pinion, wheel)
