"""A train as one writes it down: inertias, shafts between them, meshes of their teeth, and how finely shafts are modelled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import Any

from gearcad.dynamics.trains.graph import GROUND, check_train, speed_ratios
from gearcad.errors import GeometryError, ParameterError, as_choice, plain_numbers, require_name, require_number, require_whole
from gearcad.ranges import (
    ANGULAR_DAMPING,
    BACKLASH,
    DAMPING,
    DAMPING_RATIO,
    DENSITY,
    DEVIATION,
    INERTIA,
    LENGTH,
    MODULUS,
    PRELOAD,
    SPEED,
    STIFFNESS,
    TORQUE,
    TORSIONAL_STIFFNESS,
    Range,
)
from gearcad.reprs import concise

__all__ = ["GROUND", "Inertia", "Mesh", "Shaft", "StiffnessWave", "Train", "TrainModel"]


class TrainModel(Enum):
    """How much of the shafts a train knows: the levels of modelling of Osinski's paper, and what lies beyond them."""

    ISOLATED = "isolated"
    """No shafts: the meshes and the inertias in them, loaded by the mesh forces of the whole train."""
    MASSLESS = "massless"
    """Shafts are springs."""
    MODES = "modes"
    """Shafts have mass; each line of shafts and inertias keeps its first modes (the paper's quasi-normal coordinates)."""
    ELEMENTS = "elements"
    """Shafts have mass; one hierarchical element of degree `order` each, which is good for order/3 half waves or so."""
    EXACT = "exact"
    """Natural frequencies of the wave equation itself; forced response as with elements."""


class StiffnessWave(Enum):
    """How the stiffness of a mesh varies over one tooth."""

    COSINE = "cosine"
    SQUARE = "square"


class _Part:
    """A part of a train, known by its name."""

    name: str

    def _named(self) -> None:
        """Plain numbers, and a name that an error can begin with."""
        require_name("name", self.name)
        plain_numbers(self)

    def _number(self, parameter: str, permitted: Range) -> None:
        """Check one field, unless it is None."""
        value = getattr(self, parameter)
        if value is not None:
            permitted.require(f"{self.name}.{parameter}", value)


@dataclass(frozen=True, kw_only=True)
class Inertia(_Part):
    """A rigid body that turns: a gear, a motor, a load. `inertia` in kg·m². Raises ParameterError."""

    name: str
    inertia: float

    __repr__ = concise

    def __post_init__(self) -> None:
        self._named()
        self._number("inertia", INERTIA)
        if self.name == GROUND:
            raise ParameterError("name", self.name, "is what does not turn: an inertia needs another name")


@dataclass(frozen=True, kw_only=True)
class Shaft(_Part):
    """A shaft, or a coupling, from `start` to `end`: names of inertias, or "ground".

    Either `torsional_stiffness` in N·m/rad - then it has no mass in any model - or `length` and `diameter` in mm, bored out to
    `inner_diameter`, of `shear_modulus` in MPa and `density` in kg/m³. `damping_ratio` is that of the modes of the shaft's line
    (shafts and inertias, without meshes); `damping` a damper in N·m·s/rad that goes with the twist. `modes` is what the shaft
    adds to the elastic modes that its line keeps in the model "modes"; None keeps all. Raises ParameterError, GeometryError.
    """

    name: str
    start: str
    end: str
    torsional_stiffness: float | None = None
    length: float | None = None
    diameter: float | None = None
    inner_diameter: float = 0.0
    shear_modulus: float = 80770.0
    density: float = 7850.0
    damping_ratio: float = 0.0
    damping: float = 0.0
    modes: int | None = None

    __repr__ = concise

    def __post_init__(self) -> None:
        self._named()
        self._number("torsional_stiffness", TORSIONAL_STIFFNESS)
        self._number("length", LENGTH)
        self._number("diameter", LENGTH)
        self._number("shear_modulus", MODULUS)
        self._number("density", DENSITY)
        self._number("damping_ratio", DAMPING_RATIO)
        self._number("damping", ANGULAR_DAMPING)
        if self.modes is not None:
            require_whole(f"{self.name}.modes", self.modes, at_least=1, at_most=40)
        self._check_shape()

    def _check_shape(self) -> None:
        """Stiffness or shape, not both; a hollow shaft has a wall."""
        if self.torsional_stiffness is not None:
            for parameter in ("length", "diameter"):
                if (value := getattr(self, parameter)) is not None:
                    permitted = "not beside torsional_stiffness: a shaft has either a stiffness or a shape"
                    raise GeometryError(f"{self.name}.{parameter}", value, permitted, "mm")
            return
        for parameter in ("length", "diameter"):
            if getattr(self, parameter) is None:
                raise ParameterError(f"{self.name}.{parameter}", None, "must be given, or else torsional_stiffness")
        self._number("inner_diameter", LENGTH._replace(least=0.0))
        if self.diameter is not None and self.inner_diameter >= self.diameter:
            permitted = f"must be below diameter {self.diameter:g} mm"
            raise GeometryError(f"{self.name}.inner_diameter", self.inner_diameter, permitted, "mm")

    @property
    def held(self) -> bool:
        """Whether one end does not turn."""
        return GROUND in (self.start, self.end)


@dataclass(frozen=True, kw_only=True)
class Mesh(_Part):
    """The teeth of `pinion` and `wheel` (names of inertias) in mesh.

    `base_radii` of both in mm; `teeth` of the pinion; `internal` for a ring gear as the wheel. `stiffness` along the line of
    action in N/µm is the mean, about which it varies by `variation` (relative amplitude) in a `shape`, delayed by `phase` (in
    tooth periods); `contact_ratio` says how long a square wave stays high. `damping` in N·s/m, or `damping_ratio` of the pair
    alone on its two inertias. `preload` (N) presses the flanks by opposite torques on both gears, beside the train's torques.
    `backlash` in µm along the line of action; None: flanks never part. `pitch_deviations` f_pt (µm, ISO 1328-1) of the pinion's
    teeth, one each, in the order in which they come into mesh. Raises ParameterError, GeometryError.
    """

    name: str
    pinion: str
    wheel: str
    base_radii: tuple[float, float]
    stiffness: float
    teeth: int
    damping: float | None = None
    damping_ratio: float | None = None
    variation: float = 0.0
    shape: StiffnessWave = StiffnessWave.COSINE
    contact_ratio: float | None = None
    phase: float = 0.0
    backlash: float | None = None
    preload: float = 0.0
    pitch_deviations: tuple[float, ...] = ()
    internal: bool = False

    __repr__ = concise

    def __post_init__(self) -> None:
        self._named()
        object.__setattr__(self, "shape", as_choice(f"{self.name}.shape", self.shape, StiffnessWave))
        object.__setattr__(self, "base_radii", _two_radii(self.name, self.base_radii))
        require_whole(f"{self.name}.teeth", self.teeth, at_least=1, at_most=100_000)
        self._number("stiffness", STIFFNESS)
        self._number("damping", DAMPING)
        self._number("damping_ratio", DAMPING_RATIO)
        require_number(f"{self.name}.variation", self.variation, at_least=0, below=1)
        self._number("contact_ratio", Range("", 1.0, 100.0))
        self._number("phase", Range("", -1.0, 1.0))
        self._number("backlash", BACKLASH)
        self._number("preload", PRELOAD)
        object.__setattr__(self, "pitch_deviations", _deviations(self.name, self.pitch_deviations, self.teeth))
        if not isinstance(self.internal, bool):
            raise ParameterError(f"{self.name}.internal", self.internal, "must be true or false")
        if self.damping is not None and self.damping_ratio is not None:
            raise GeometryError(f"{self.name}.damping_ratio", self.damping_ratio, "not beside damping: one says the other")
        if self.shape is StiffnessWave.SQUARE and self.variation:
            permitted = "not with a square wave: its contact ratio says how far it jumps"
            raise GeometryError(f"{self.name}.variation", self.variation, permitted)
        if self.shape is StiffnessWave.SQUARE and self.contact_ratio is None:
            raise ParameterError(f"{self.name}.contact_ratio", None, "must be given for a square wave")

    @property
    def radii(self) -> tuple[float, float]:
        """What the turns of pinion and wheel, both counter-clockwise, move along the line of action (m per rad)."""
        pinion, wheel = self.base_radii
        return pinion / 1000, (-wheel if self.internal else wheel) / 1000


def _deviations(name: str, values: Any, teeth: int) -> tuple[float, ...]:
    """Pitch deviations, checked: none, or one for each tooth."""
    if not isinstance(values, list | tuple) or len(values) not in (0, teeth):
        count = len(values) if isinstance(values, list | tuple) else values
        raise ParameterError(
            f"{name}.pitch_deviations", count, f"must be {teeth} numbers in µm: one for each tooth of the pinion"
        )
    for value in values:
        DEVIATION.require(f"{name}.pitch_deviations", value)
    return tuple(float(value) for value in values)


def _two_radii(name: str, values: Any) -> tuple[float, float]:
    """Base radii, checked."""
    if not isinstance(values, list | tuple) or len(values) != 2:
        raise ParameterError(f"{name}.base_radii", values, "must be two lengths in mm: of pinion and wheel")
    for value in values:
        LENGTH.require(f"{name}.base_radii", value)
    return float(values[0]), float(values[1])


@dataclass(frozen=True, kw_only=True)
class Train:
    """Inertias, the shafts between them, the meshes of their teeth, and the torques on them.

    `model` says what is known of the shafts: one word changes it. `torques` in N·m by the names of inertias, counter-clockwise
    positive; on a train that no shaft holds they must balance. `speed` in rpm is that of the first mesh's pinion. `order` is
    the degree of the polynomials on a shaft with mass. Raises ParameterError and GeometryError.
    """

    name: str = "train"
    model: TrainModel = TrainModel.ELEMENTS
    inertias: tuple[Inertia, ...]
    shafts: tuple[Shaft, ...] = ()
    meshes: tuple[Mesh, ...] = ()
    torques: Mapping[str, float] = field(default_factory=dict)
    speed: float = 0.0
    order: int = 12

    __repr__ = concise

    def __post_init__(self) -> None:
        require_name("name", self.name)
        plain_numbers(self)
        object.__setattr__(self, "model", as_choice("model", self.model, TrainModel))
        for parameter in ("inertias", "shafts", "meshes"):
            object.__setattr__(self, parameter, tuple(getattr(self, parameter)))
        object.__setattr__(self, "torques", dict(self.torques))
        for inertia, torque in self.torques.items():
            TORQUE.require(f"torques.{inertia}", torque)
        SPEED.require("speed", self.speed)
        require_whole("order", self.order, at_least=2, at_most=40)
        check_train(self)
        self._check_modes()

    def _check_modes(self) -> None:
        """Elements of a low degree have no accurate high modes to be kept."""
        for shaft in self.shafts if self.model is TrainModel.MODES else ():
            if shaft.torsional_stiffness is None and shaft.modes is not None and 2 * shaft.modes > self.order:
                permitted = f"must be at most half the order {self.order} of the elements, for accurate modes"
                raise ParameterError(f"{shaft.name}.modes", shaft.modes, permitted)

    @property
    def held(self) -> bool:
        """Whether a shaft holds the train: otherwise it turns as a whole, at 0 Hz."""
        return any(shaft.held for shaft in self.shafts)

    @cached_property
    def speed_ratios(self) -> dict[str, float]:
        """Nominal turns of every inertia per turn of the first mesh's pinion, counter-clockwise positive."""
        return speed_ratios(self)

    @property
    def tooth_frequencies(self) -> dict[str, float]:
        """Of every mesh, at `speed` (Hz)."""
        return {mesh.name: abs(self.speed_ratios[mesh.pinion] * self.speed) * mesh.teeth / 60 for mesh in self.meshes}
