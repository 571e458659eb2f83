"""Members of a train: inertias, shafts, meshes and their gear pairs, and the graph that they make."""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Annotated, Any, NamedTuple

from gearcad.contact.shared.bodies import BodyModel
from gearcad.core.errors import GeometryError, InputError, ParameterError, format_number, require_name, require_switch
from gearcad.core.quantities import (
    ANGULAR_DAMPING,
    BACKLASH,
    DAMPING,
    DAMPING_RATIO,
    DENSITY,
    DEVIATION,
    ELSEWHERE,
    INERTIA,
    LENGTH,
    MODULUS,
    NOT_GIVEN,
    PRELOAD,
    STIFFNESS,
    TORQUE,
    TORSIONAL_STIFFNESS,
    Derived,
    DerivedCount,
    InPlaceOf,
    NamedPart,
    Range,
    Whole,
    Words,
    is_given,
)
from gearcad.core.records import PerGear, Role, concise
from gearcad.dynamics.trains.shaft_layout import ShaftLayout, require_distinct
from gearcad.geometry import GearPair, RackPair
from gearcad.geometry.gear import refuse_halves
from gearcad.load import Load
from gearcad.material import Material, Materials
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.rating.options import RatingOptions


@dataclass(frozen=True, kw_only=True)
class MeshPair:
    """A pair of gears whose teeth are a mesh of a train, with its `material`, `mounting` and the model `body` of its bodies.

    `rating` has the accuracy grade of its teeth. `load` is the pair's own, if it has one: the train gives it another torque and
    speed. Raises GeometryError for double helical gears.
    """

    pair: GearPair
    material: Materials = field(default_factory=Material)
    mounting: Mounting = field(default_factory=Mounting)
    body: BodyModel = field(default_factory=BodyModel)
    rating: RatingOptions = field(default_factory=RatingOptions)
    load: Load | None = None

    __repr__ = concise

    def __post_init__(self) -> None:
        refuse_halves(self.pair.pinion, "dynamics")

    @property
    def mounted(self) -> GearPair:
        """Pair at the centre distance of its mounting. Raises GeometryError."""
        return self.mounting.mounted(self.pair)

    @property
    def backlash(self) -> float:
        """Backlash between the flanks along the line of action, as mounted (µm)."""
        return line_backlash(self.mounted)


def line_backlash(pair: GearPair | RackPair) -> float:
    """Return the backlash of a pair along the line of action, at its centre distance (µm)."""
    across = math.cos(math.radians(pair.working_transverse_pressure_angle))
    return max(1000 * pair.circumferential_backlash * across, 0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshCourse:
    """Mesh cycle of the pair of a mesh under the train's static load.

    `torque` (N·m) is that on its pinion, counter-clockwise positive. With `driver` it says which flanks carry: if the wheel
    drives, the torque is against the pinion's turn. `cycle` is the mesh cycle under this torque, by the method whose words are
    `title`, found in `rounds` rounds of stiffness and static force. `offset` (µm) is taken from its transmission error: where
    the force depends on the stiffness, train and cycle must have the same approach of the flanks at rest.
    """

    cycle: MeshCycle
    title: str
    torque: float
    driver: Role
    rounds: int = 1
    offset: float = 0.0

    @property
    def in_time(self) -> MeshCycle:
        """The cycle in the order in which contact moves: from root to tip of the gear that drives."""
        return self.cycle if self.driver is Role.PINION else self.cycle.backwards


GROUND = "ground"
"""Name of the end of a shaft that does not turn."""

BESIDE_PAIR = "not beside pair: it is that of its teeth"
"""End of the message about an input that the pair of a mesh already defines."""


class _DerivedRadii(PerGear[float]):
    """Base radii that follow from a pair, as Derived numbers do."""

    derived = True


_NO_RADII, _NO_TEETH = _DerivedRadii(math.nan, math.nan), DerivedCount(0)


class StiffnessWave(Enum):
    """Course of the stiffness of a mesh over one tooth."""

    COSINE = "cosine"
    SQUARE = "square"


@dataclass(frozen=True, kw_only=True)
class Inertia(NamedPart):
    """A rigid body that turns: a gear, a motor, a load. `inertia` in kg·m². Raises ParameterError.

    Without an `inertia` that of a gear of a pair is the one of its solid; a train finds it.
    """

    name: str
    inertia: Annotated[float, INERTIA, Words("inertia", "J")] = NOT_GIVEN

    __repr__ = concise

    def __post_init__(self) -> None:
        self._check_fields()
        if self.name == GROUND:
            raise ParameterError(
                "name", self.name, "is the name of the ground, which does not turn: give the inertia another name"
            )


@dataclass(frozen=True, kw_only=True)
class Shaft(NamedPart):
    """A shaft, or a coupling, from `start` to `end`: names of inertias, or "ground".

    Either `torsional_stiffness` in N·m/rad - then it has no mass in any model - or `length` and `diameter` in mm, bored out to
    `inner_diameter`, of `shear_modulus` in MPa and `density` in kg/m³. `damping_ratio` is that of the modes of the shaft's line
    (shafts and inertias, without meshes); `damping` a damper in N·m·s/rad that goes with the twist. `modes` is what the shaft
    adds to the elastic modes that its line keeps in the model "modes"; None keeps all. A `layout` - segments, bearings and the
    gears on the shaft - stands in the place of both stiffness and shape. Raises ParameterError, GeometryError.
    """

    name: str
    start: Annotated[str, Words("where it begins")]
    end: Annotated[str, Words("where it ends")]
    torsional_stiffness: Annotated[float | None, TORSIONAL_STIFFNESS, Words("torsional stiffness")] = None
    length: Annotated[float | None, LENGTH, Words("length")] = None
    diameter: Annotated[float | None, LENGTH, Words("diameter")] = None
    inner_diameter: Annotated[float, LENGTH._replace(least=0.0), Words("diameter of the bore")] = 0.0
    shear_modulus: Annotated[float, MODULUS, Words("shear modulus", "G")] = 80770.0
    density: Annotated[float, DENSITY, Words("density", "ρ")] = 7850.0
    damping_ratio: Annotated[float, DAMPING_RATIO, Words("damping ratio of the modes of its line", "ζ")] = 0.0
    damping: Annotated[float, ANGULAR_DAMPING, Words("damping of its twist")] = 0.0
    modes: Annotated[int | None, Whole(1, 40), Words("elastic modes that its line keeps of it")] = None
    layout: Annotated[ShaftLayout | None, Words("segments, bearings and gears of the shaft"), ELSEWHERE] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        self._check_fields()
        for end in ("start", "end"):
            require_name(f"{self.name}.{end}", getattr(self, end))
        self._check_shape()

    def _check_shape(self) -> None:
        """Raise GeometryError or ParameterError unless a shaft has either a stiffness or a shape.

        A hollow shaft must have a wall.
        """
        if self.layout is not None:
            for parameter, unit in _SHAPE.items():
                if (value := getattr(self, parameter)) != getattr(Shaft, parameter):
                    permitted = "not beside segments: they have the stiffness and the shape of the shaft"
                    raise GeometryError(f"{self.name}.{parameter}", value, permitted, unit)
            return
        if self.torsional_stiffness is not None:
            for parameter in ("length", "diameter"):
                if (value := getattr(self, parameter)) is not None:
                    permitted = "not beside torsional_stiffness: a shaft has either a stiffness or a shape"
                    raise GeometryError(f"{self.name}.{parameter}", value, permitted, "mm")
            return
        for parameter in ("length", "diameter"):
            if getattr(self, parameter) is None:
                raise ParameterError(f"{self.name}.{parameter}", None, "must be given, or else torsional_stiffness")
        if self.diameter is not None and self.inner_diameter >= self.diameter:
            permitted = f"must be below diameter {self.diameter:g} mm"
            raise GeometryError(f"{self.name}.inner_diameter", self.inner_diameter, permitted, "mm")

    @property
    def held(self) -> bool:
        """Whether one end of the shaft is held."""
        return GROUND in (self.start, self.end)

    @property
    def stiffness(self) -> float:
        """Torsional stiffness G I_p / L (N·m/rad); of segments that between its ends."""
        if self.layout is not None:
            return self.layout.stiffness
        if self.torsional_stiffness is not None:
            return self.torsional_stiffness
        assert self.length is not None
        return self.shear_modulus * 1e6 * self._polar_moment / (self.length / 1000)

    @property
    def inertia(self) -> float:
        """Moment of inertia rho I_p L about the axis (kg·m²); 0 for a shaft that is given by its stiffness."""
        if self.layout is not None:
            return self.layout.inertia
        if self.torsional_stiffness is not None:
            return 0.0
        assert self.length is not None
        return self.density * self._polar_moment * self.length / 1000

    @property
    def _polar_moment(self) -> float:
        """Polar moment of area of the section (m⁴)."""
        assert self.diameter is not None
        return math.pi / 32 * ((self.diameter / 1000) ** 4 - (self.inner_diameter / 1000) ** 4)

    def on_gears(self, meshes: Sequence[ToothMesh]) -> Shaft:
        """Return the shaft with the span of its layout, from its start to its end, by the places of the gears on it.

        Raises ParameterError and GeometryError for gears that are not of its ends, or not on it.
        """
        if self.layout is None:
            return self
        known = {mesh.name: mesh for mesh in meshes}
        places: dict[str, float] = {}  # of the ends that are gears on it
        for number, gear in enumerate(self.layout.gears):
            key = f"{self.name}.gears[{number}]"
            if gear.mesh not in known:
                raise ParameterError(f"{key}.mesh", gear.mesh, f"must be one of the meshes {', '.join(known)}")
            inertia = known[gear.mesh].gears.pick(gear.role)
            if inertia not in (self.start, self.end):
                permitted = f"is {inertia}, which is at neither end of the shaft: {self.start} and {self.end}"
                raise ParameterError(f"{key}.role", gear.role.value, permitted)
            places.setdefault(inertia, gear.position)
        coupling = self.layout.coupling
        if coupling is None:
            coupling = self.layout.length if self.start in places and self.end not in places else 0.0
        span = (places.get(self.start, coupling), places.get(self.end, coupling)) if places else (0.0, self.layout.length)
        layout = replace(self.layout, coupling=coupling, span=span)
        try:
            require_distinct(layout.gears)
            layout.require_span()
        except InputError as error:
            raise error.within(self.name) from None
        return replace(self, layout=layout)


_SHAPE = {"torsional_stiffness": "N·m/rad", "length": "mm", "diameter": "mm", "inner_diameter": "mm"}
"""Fields of a shaft that its segments stand for, and their units."""


@dataclass(frozen=True, kw_only=True)
class ToothMesh(NamedPart):
    """The teeth of `pinion` and `wheel` (names of inertias) in mesh.

    `base_radii` of both in mm; `teeth` of the pinion; `internal` for a ring gear as the wheel. `stiffness` along the line of
    action in N/µm is the mean, about which it varies by `variation` (relative amplitude) in a `shape`, delayed by `phase` (in
    tooth periods); `contact_ratio` says how long a square wave stays high. A `pair` in their place - a GearPair, or a MeshPair,
    which has its material and mounting - knows all of these but the phase: at phase 0 its pitch point is in contact.
    `damping` in N·s/m, or `damping_ratio` of the pair alone on its two inertias. `preload` (N) presses the flanks by opposite
    torques on both gears, beside the train's torques. `backlash` in µm along the line of action, by default that of the pair;
    None: flanks never part. `pitch_deviations` f_pt (µm, ISO 1328-1) of the pinion's teeth, one each, in the order in which
    they come into mesh. Raises ParameterError, GeometryError.
    """

    name: str
    pinion: Annotated[str, Words("inertia that its pinion is")]
    wheel: Annotated[str, Words("inertia that its wheel is")]
    pair: Annotated[MeshPair | GearPair | None, Words("pair of gears whose teeth these are"), ELSEWHERE] = None
    base_radii: Annotated[PerGear[float], LENGTH, Words("base radii of pinion and wheel", "r_b"), InPlaceOf("pair")] = _NO_RADII
    stiffness: Annotated[float, STIFFNESS, Words("mean stiffness along the line of action"), InPlaceOf("pair")] = NOT_GIVEN
    teeth: Annotated[int, Whole(1, 100_000), Words("number of teeth of the pinion", "z_1"), InPlaceOf("pair")] = _NO_TEETH
    damping: Annotated[float | None, DAMPING, Words("damping along the line of action")] = None
    damping_ratio: Annotated[float | None, DAMPING_RATIO, Words("damping ratio of the pair alone", "ζ")] = None
    variation: Annotated[float, Range("", 0, 1, ends="[)"), Words("relative amplitude of the stiffness")] = 0.0
    shape: Annotated[StiffnessWave, Words("how the stiffness varies over a tooth")] = StiffnessWave.COSINE
    contact_ratio: Annotated[float | None, Range("", 1.0, 100.0), Words("contact ratio of a square wave", "ε_α")] = None
    phase: Annotated[float, Range("", -1.0, 1.0), Words("delay of the stiffness, in tooth periods")] = 0.0
    backlash: Annotated[float | None, BACKLASH, Words("backlash along the line of action")] = NOT_GIVEN
    preload: Annotated[float, PRELOAD, Words("force that presses the flanks beside the load's")] = 0.0
    pitch_deviations: Annotated[tuple[float, ...], DEVIATION, Words("pitch deviations of the pinion's teeth", "f_pt")] = ()
    internal: Annotated[bool, Words("whether the wheel is a ring gear")] = False
    mesh_angle: Annotated[float, Range("deg", -360.0, 360.0), Words("angle of the wheel's axis, seen from the pinion's")] = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        if self.pair is not None:
            self._take_from_pair()
        else:
            self._take_none()
        self._check_fields()
        for role in Role:
            require_name(f"{self.name}.{role.value}", getattr(self, role.value))
        object.__setattr__(self, "base_radii", _two_radii(self.name, self.base_radii))
        object.__setattr__(self, "pitch_deviations", _deviations(self.name, self.pitch_deviations, self.teeth))
        require_switch(f"{self.name}.internal", self.internal)
        self._check_damping_and_wave()

    def _take_none(self) -> None:
        """Set the backlash of a mesh without a pair: flanks never part unless one is given.

        Raises ParameterError without base radii.
        """
        if not is_given(self.backlash):
            object.__setattr__(self, "backlash", None)
        if self.base_radii is _NO_RADII:
            permitted = "must be two lengths in mm: of pinion and wheel, or give pair instead"
            raise ParameterError(f"{self.name}.base_radii", None, permitted)

    def _take_from_pair(self) -> None:
        """Set the fields that the pair defines, as derived values.

        Raises ParameterError if `pair` is not a pair, and GeometryError for a field that is given too or a preload that is too
        high.
        """
        pair = MeshPair(pair=self.pair) if isinstance(self.pair, GearPair) else self.pair
        if not isinstance(pair, MeshPair):
            raise ParameterError(f"{self.name}.pair", pair, "must be a GearPair, or a MeshPair, which has its material too")
        self._require_nothing_beside()
        mounted = pair.mounted
        radii = mounted.gears.map(lambda gear: abs(gear.base_diameter) / 2)
        found = {"pair": pair, "base_radii": _DerivedRadii(*radii), "teeth": DerivedCount(mounted.pinion.teeth)}
        found |= {"internal": mounted.internal, "stiffness": Derived(self._stiffness_of_pair)}
        self._require_bearable(radii.pinion)
        if self.backlash is not None and not is_given(self.backlash):
            found["backlash"] = Derived(pair.backlash)
        for name, value in found.items():
            object.__setattr__(self, name, value)

    def _require_bearable(self, radius: float) -> None:
        """Raise GeometryError where the preload gives a pinion of that base radius (mm) more torque than a pair can have."""
        most = (TORQUE.most or math.inf) * 1000 / radius
        if self.preload > most:
            permitted = f"must be at most {most:.3g} N: no pair has more than {TORQUE.most:g} N·m on its pinion"
            raise GeometryError(f"{self.name}.preload", self.preload, permitted, "N")

    def _require_nothing_beside(self) -> None:
        """Raise GeometryError for a field that is given although the pair defines it."""
        derived, plain = ("base_radii", "stiffness", "teeth"), ("variation", "shape", "contact_ratio")
        given = {name: not getattr(getattr(self, name), "derived", False) for name in derived}
        given |= {name: getattr(self, name) != getattr(ToothMesh, name) for name in plain}
        for name, beside in given.items():
            if beside:
                raise GeometryError(f"{self.name}.{name}", getattr(self, name), BESIDE_PAIR)

    @property
    def _stiffness_of_pair(self) -> float:
        """Mean stiffness of the pair's teeth: nan, as it is unknown before their load is known."""
        return math.nan

    def _check_damping_and_wave(self) -> None:
        """Raise GeometryError for inputs that exclude each other.

        Raises ParameterError for a square wave without a contact ratio.
        """
        if self.damping is not None and self.damping_ratio is not None:
            raise GeometryError(
                f"{self.name}.damping_ratio", self.damping_ratio, "must be left out beside damping: one follows from the other"
            )
        if self.shape is StiffnessWave.SQUARE and self.variation:
            permitted = "not with a square wave: its contact ratio says how far it jumps"
            raise GeometryError(f"{self.name}.variation", self.variation, permitted)
        if self.shape is StiffnessWave.SQUARE and self.contact_ratio is None:
            raise ParameterError(f"{self.name}.contact_ratio", None, "must be given for a square wave")

    @property
    def gears(self) -> PerGear[str]:
        """Names of both inertias."""
        return PerGear(self.pinion, self.wheel)

    @property
    def radii(self) -> PerGear[float]:
        """Base radii (m) of both gears, negative for a ring gear.

        They are the motion along the line of action per rad of each gear, both counter-clockwise.
        """
        pinion, wheel = self.base_radii
        return PerGear(pinion / 1000, (-wheel if self.internal else wheel) / 1000)


def _deviations(name: str, values: Any, teeth: int) -> tuple[float, ...]:
    """Return the pitch deviations (µm): none, or one for each tooth. Raises ParameterError for another number of them."""
    if not isinstance(values, list | tuple) or len(values) not in (0, teeth):
        count = len(values) if isinstance(values, list | tuple) else values
        raise ParameterError(
            f"{name}.pitch_deviations", count, f"must be {teeth} numbers in µm: one for each tooth of the pinion"
        )
    return tuple(float(value) for value in values)


def _two_radii(name: str, values: Any) -> PerGear[float]:
    """Return the base radii (mm) as a PerGear. Raises ParameterError unless there are two."""
    if not isinstance(values, list | tuple) or len(values) != 2:
        raise ParameterError(f"{name}.base_radii", values, "must be two lengths in mm: of pinion and wheel")
    return values if isinstance(values, _DerivedRadii) else PerGear(*map(float, values))


_SAME_SPEED = 1e-6
"""Relative difference within which two ways round a loop give an inertia the same speed; rounded base radii would lock it."""

_BALANCED = 1e-3
"""Part of the greatest torque that may be left unbalanced: torques of four digits balance as well as that."""

_WRONG_SIGN = 0.05
"""Relative difference between the balancing torque and the given one with opposite sign, up to which the message suggests a
wrong sign.
"""


def turning_pieces(names: Sequence[str], shafts: Iterable[Shaft], meshes: Iterable[ToothMesh]) -> list[dict[str, float]]:
    """Return the connected pieces of a train, each with the speeds of its inertias relative to its first inertia.

    Raises GeometryError where a loop would turn an inertia at two speeds.
    """
    neighbours: dict[str, list[tuple[str, float]]] = {name: [] for name in names}
    for shaft in shafts:
        if not shaft.held:
            neighbours[shaft.start].append((shaft.end, 1.0))
            neighbours[shaft.end].append((shaft.start, 1.0))
    for mesh in meshes:
        ratio = -mesh.radii.pinion / mesh.radii.wheel
        neighbours[mesh.pinion].append((mesh.wheel, ratio))
        neighbours[mesh.wheel].append((mesh.pinion, 1 / ratio))
    pieces: list[dict[str, float]] = []
    for name in names:
        if not any(name in piece for piece in pieces):
            pieces.append(_piece(name, neighbours))
    return pieces


def _piece(first: str, neighbours: dict[str, list[tuple[str, float]]]) -> dict[str, float]:
    """Return the speeds of all inertias that are connected with the inertia `first`, relative to it.

    Raises GeometryError where a loop would turn an inertia at two speeds.
    """
    speeds, waiting = {first: 1.0}, deque([first])
    while waiting:
        here = waiting.popleft()
        for there, ratio in neighbours[here]:
            speed = speeds[here] * ratio
            if there not in speeds:
                speeds[there] = speed
                waiting.append(there)
            elif not math.isclose(speeds[there], speed, rel_tol=_SAME_SPEED):
                permitted = f"a loop of meshes and shafts turns {there} at {speeds[there]:.9g} and {speed:.9g} times the "
                raise GeometryError("meshes", there, permitted + f"speed of {first}: base radii must agree, unrounded")
    return speeds


class Graph(NamedTuple):
    """The members of a train, and the graph that they make: shafts and meshes join inertias by their names."""

    inertias: tuple[Inertia, ...]
    shafts: tuple[Shaft, ...]
    meshes: tuple[ToothMesh, ...]

    @property
    def reference(self) -> str:
        """Name of the first mesh's pinion, or of the first inertia where there is no mesh."""
        return self.meshes[0].pinion if self.meshes else self.inertias[0].name

    def pieces(self) -> list[dict[str, float]]:
        """Return the connected pieces of the train; see `turning_pieces`."""
        return turning_pieces([inertia.name for inertia in self.inertias], self.shafts, self.meshes)

    def speed_ratios(self) -> dict[str, float]:
        """Return the nominal speeds of a train in one piece, relative to the reference, by the names of inertias."""
        (speeds,) = self.pieces()
        reference = speeds[self.reference]
        return {name: speed / reference for name, speed in speeds.items()}

    def require_one_train(self, torques: Mapping[str, float]) -> None:
        """Raise ParameterError or GeometryError unless the members make one train, on whose inertias the torques act."""
        if not self.inertias:
            raise ParameterError("inertias", (), "must hold one inertia at least")
        for kind, members in zip(self._fields, self, strict=True):
            twice = [name for name, count in Counter(member.name for member in members).items() if count > 1]
            if twice:
                raise ParameterError(f"{kind}.name", twice[0], "names must differ")
        self._require_names(torques)
        self._require_one_piece()

    def require_balance(self, torques: Mapping[str, float]) -> None:
        """Raise GeometryError where torques, each reflected to the reference, leave something that would speed a train up."""
        ratios = self.speed_ratios()
        reflected = [torque * ratios[name] for name, torque in torques.items()]
        left = math.fsum(reflected)
        if reflected and abs(left) > _BALANCED * max(abs(torque) for torque in reflected):
            wrong, needed = _balancing(torques, ratios, left)
            permitted = (
                f"on {self.reference}, the sum of all, must be 0 on a train that no shaft holds: "
                f"give {wrong} = {needed:.10g} instead of {format_number(torques[wrong])} N·m, or hold the train"
            )
            raise GeometryError("torques", left, permitted, "N·m")

    def _require_names(self, torques: Mapping[str, float]) -> None:
        """Raise ParameterError or GeometryError unless members and torques name known inertias.

        Both ends of a member must differ.
        """
        names = [inertia.name for inertia in self.inertias]
        known = f"must be one of the inertias {', '.join(names)}"
        for shaft in self.shafts:
            for parameter in ("start", "end"):
                if (end := getattr(shaft, parameter)) not in (*names, GROUND):
                    raise ParameterError(f"{shaft.name}.{parameter}", end, f'{known}, or "{GROUND}"')
            if shaft.start == shaft.end:
                permitted = "must differ from start: a shaft joins two inertias or holds one"
                raise GeometryError(f"{shaft.name}.end", shaft.end, permitted)
        for mesh in self.meshes:
            for role, gear in mesh.gears.items():
                if gear not in names:
                    raise ParameterError(f"{mesh.name}.{role.value}", gear, known)
            if mesh.pinion == mesh.wheel:
                raise GeometryError(f"{mesh.name}.wheel", mesh.wheel, "must differ from pinion")
        for name in torques:
            if name not in names:
                raise ParameterError("torques", name, known)

    def _require_one_piece(self) -> None:
        """Raise GeometryError unless all members are connected."""
        ends = {end for shaft in self.shafts for end in (shaft.start, shaft.end)}
        geared = {gear for mesh in self.meshes for gear in mesh.gears}
        for inertia in self.inertias:
            if inertia.name not in ends | geared:
                raise GeometryError("inertias", inertia.name, "has neither a shaft nor a mesh: give it one, or leave it out")
        pieces = self.pieces()
        if len(pieces) > 1:
            parts = " | ".join(", ".join(piece) for piece in pieces)
            permitted = f"does not hang together with the rest ({parts}): join the pieces by a shaft or a mesh"
            raise GeometryError("inertias", next(iter(pieces[1])), permitted)


def _balancing(torques: Mapping[str, float], ratios: Mapping[str, float], left: float) -> tuple[str, float]:
    """Return the member to change first, and its torque (N·m) that balances the train: one with a wrong sign, else the last."""
    needed = {name: torque - left / ratios[name] for name, torque in torques.items() if ratios[name]}
    turned = [name for name, torque in needed.items() if math.isclose(torque, -torques[name], rel_tol=_WRONG_SIGN)]
    name = (turned or list(needed))[-1]
    return name, needed[name]
