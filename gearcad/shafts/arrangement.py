"""Arrangement of shafts: their options, the life of their bearings under what the shafts put on them, and their document."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, Any

import numpy as np

from gearcad.core.errors import InputError
from gearcad.core.quantities import SPEED, Range, Whole, Words, require_fields
from gearcad.core.records import JsonObject, Notice, concise
from gearcad.shafts.beam import ShaftBearing, ShaftState, SteppedShaft
from gearcad.shafts.bearing_life import (
    BALL_KINDS,
    OPPOSED_KINDS,
    RECALLED,
    EquivalentLoad,
    basic_life,
    deep_groove_load,
    fatigue_limit_load,
    life_factor,
    life_in_hours,
    one_sided_load,
    opposed_axial_loads,
    reference_viscosity,
    reliability_factor,
    two_factor_load,
)
from gearcad.shafts.strength import RECALLED as RECALLED_STRENGTH
from gearcad.shafts.strength import ShoulderSafety, shoulder_safeties
from gearcad.shafts.whirl import ShaftDisc, ShaftWhirl

_FEWEST_STATIONS = 100
_STEPS = (1.0, 2.0, 5.0, 10.0)
"""Parts of a power of ten that a step between stations may be."""


@dataclass(frozen=True, kw_only=True)
class ShaftOptions:
    """Options of shafts: `coupling` (mm) of a shaft by itself, `gravity` (m/s², along x, y, z), and what bearing life takes.

    `speed` (rpm) of a shaft by itself, the `viscosity` (mm²/s) of the oil at its temperature, `contamination_factor` e_C and
    `life_reliability` (%). `mesh_angle` (degrees) is where the wheel's axis lies from the pinion's, from x; `slices` are those
    of the face. `stations` (mm) are further places whose state is wanted. Raises ParameterError.
    """

    coupling: Annotated[float, Range("mm", 0, 1e7), Words("position of the coupling")] = 0.0
    gravity: Annotated[tuple[float, float, float], Words("gravity", "g")] = (0.0, 0.0, 0.0)
    speed: Annotated[float, SPEED, Words("speed of the shaft", "n")] = 0.0
    mesh_angle: Annotated[float, Range("deg", -360, 360), Words("angle of the wheel's axis")] = 0.0
    slices: Annotated[int, Whole(2, 400), Words("slices of the face")] = 40
    stations: Annotated[tuple[float, ...], Words("further stations")] = ()
    viscosity: Annotated[float | None, Range("mm²/s", 0.1, 1e5), Words("viscosity of the oil", "ν")] = None
    contamination_factor: Annotated[float | None, Range("", 0, 1), Words("contamination factor", "e_C", "ISO 281")] = None
    life_reliability: Annotated[float, Range("%", 90, 99), Words("reliability of bearing life", "", "ISO 281")] = 90.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        reliability_factor(self.life_reliability)


@dataclass(frozen=True)
class BearingLife:
    """Life of a bearing under its radial and axial force (N), in million revolutions and hours; None with a reason."""

    name: str
    radial: float
    axial: float
    equivalent: EquivalentLoad | None = None
    revolutions: float | None = None
    hours: float | None = None
    modified_hours: float | None = None
    reasons: tuple[str, ...] = ()

    def to_dict(self) -> JsonObject:
        """Return the figures under the names of ISO 281: L10 in million revolutions, L10h and Lnmh in hours."""
        return {
            "name": self.name,
            "radial_force": self.radial,
            "axial_force": self.axial,
            "equivalent_load": None if self.equivalent is None else self.equivalent.load,
            "L10": _finite(self.revolutions),
            "L10h": _finite(self.hours),
            "Lnmh": _finite(self.modified_hours),
            "not_judged": list(self.reasons),
        }


def _finite(value: float | None) -> float | None:
    return None if value is None or math.isinf(value) else value


def bearing_life(bearing: ShaftBearing, radial: float, axial: float | str, speed: float, options: ShaftOptions) -> BearingLife:
    """Return the life of a bearing under its radial and axial force (N) at a speed (rpm; 0 without hours).

    A text instead of the axial force says why that is not known.
    """
    known = 0.0 if isinstance(axial, str) else axial
    found = BearingLife(bearing.name, radial, known)
    load = axial if isinstance(axial, str) else _equivalent(bearing, radial, axial)
    if isinstance(load, str):
        return replace(found, reasons=(load,))
    assert bearing.C is not None
    ball = bearing.kind in BALL_KINDS
    revolutions = basic_life(bearing.C, load.load, ball=ball)
    if not speed:
        return replace(found, equivalent=load, revolutions=revolutions, reasons=("hours: no speed is given",))
    hours = life_in_hours(revolutions, speed)
    made = replace(found, equivalent=load, revolutions=revolutions, hours=hours)
    factor = _modification(bearing, load.load, speed, options, ball=ball)
    if isinstance(factor, str):
        return replace(made, reasons=(factor,))
    return replace(made, modified_hours=reliability_factor(options.life_reliability) * factor * hours)


def _equivalent(bearing: ShaftBearing, radial: float, axial: float) -> EquivalentLoad | str:
    """Return the equivalent load, or why there is none."""
    if bearing.kind is None:
        return "life: kind is not given" if bearing.C is not None else "life: kind and C are not given"
    if bearing.C is None:
        return "life: C is not given"
    if bearing.kind == "deep groove":
        if axial and (bearing.f0 is None or bearing.C0 is None):
            if bearing.Y is not None and bearing.e is not None:
                return two_factor_load(radial, axial, limit=bearing.e, below=(1.0, 0.0), beyond=(0.56, bearing.Y))
            return "life: f0 and C0, or e and Y, are not given, and there is an axial force"
        return deep_groove_load(radial, axial, f0=bearing.f0 or 0.0, static_rating=bearing.C0 or 1.0)
    if bearing.kind == "cylindrical":
        return EquivalentLoad(radial, 0.0, 0.0) if not axial else "life: a cylindrical roller bearing bears no axial force"
    if bearing.kind == "spherical":
        if bearing.e is None or bearing.Y1 is None or bearing.Y2 is None:
            return "life: e, Y1 and Y2 are not given"
        return two_factor_load(radial, axial, limit=bearing.e, below=(1.0, bearing.Y1), beyond=(0.67, bearing.Y2))
    if bearing.e is None or bearing.Y is None:
        return "life: e and Y are not given"
    return one_sided_load(bearing.kind, radial, axial, limit=bearing.e, factor=bearing.Y)


def _modification(bearing: ShaftBearing, load: float, speed: float, options: ShaftOptions, *, ball: bool) -> float | str:
    """Return a_ISO, or why there is none."""
    if options.viscosity is None or options.contamination_factor is None:
        return "modified life: viscosity and contamination_factor are not given"
    if bearing.pitch_diameter is None:
        return "modified life: pitch_diameter is not given"
    limit = bearing.C_u
    if limit is None and bearing.C0 is not None:
        limit = fatigue_limit_load(bearing.C0, bearing.pitch_diameter, ball=ball)
    if limit is None:
        return "modified life: neither C_u nor C0 is given"
    try:
        ratio = options.viscosity / reference_viscosity(speed, bearing.pitch_diameter)
        return life_factor(ratio, options.contamination_factor * limit / load, ball=ball) if load else 1.0
    except InputError:
        return "modified life: the oil is thinner than ISO 281 covers (kappa below 0.1)"


def with_stations(shaft: SteppedShaft) -> SteppedShaft:
    """Return the shaft with further stations at whole steps, so that its lines can be drawn."""
    wanted = shaft.length / _FEWEST_STATIONS
    power = 10.0 ** math.floor(math.log10(wanted))
    step = next(power * each for each in _STEPS if power * each >= wanted * (1 - 1e-9))
    return replace(shaft, places=(*shaft.places, *np.arange(0.0, shaft.length, step).tolist()))


@dataclass(frozen=True)
class ShaftResult:
    """A shaft under its loads, and the lives of its bearings at a speed (rpm)."""

    state: ShaftState
    speed: float
    options: ShaftOptions
    discs: tuple[ShaftDisc, ...] = ()
    bins: tuple[tuple[float, ShaftResult], ...] = ()
    """Shares of time and the shaft under each load of a spectrum."""

    def is_ball(self, name: str) -> bool:
        """Return whether the bearing of a name has balls."""
        found = {each.name or f"bearing {number}": each for number, each in enumerate(self.state.shaft.bearings, 1)}
        return found[name].kind in BALL_KINDS

    @cached_property
    def lives(self) -> tuple[BearingLife, ...]:
        """Lives of the bearings, over the spectrum if there is one."""
        if not self.bins:
            return tuple(self._lives())
        shares = [share for share, _ in self.bins]
        return tuple(_lasting(each, shares, self.bins) for each in zip(*(one.lives for _, one in self.bins), strict=True))

    def _lives(self) -> Iterator[BearingLife]:
        bearings = self.state.shaft.bearings
        radial = [float(np.hypot(*force[:2])) for force in self.state.reactions]
        axial = self._axial_forces(radial)
        for number, (bearing, across, along) in enumerate(zip(bearings, radial, axial, strict=True), 1):
            named = bearing if bearing.name else replace(bearing, name=f"bearing {number}")
            yield bearing_life(named, across, along, self.speed, self.options)

    def _axial_forces(self, radial: Sequence[float]) -> list[float | str]:
        """Return the axial forces (N) of the bearings, or why one is not known: two opposed ones also have their own thrust."""
        found: list[float | str] = []
        for force, across in zip(self.state.reactions, radial, strict=True):
            along = abs(float(force[2]))
            found.append(0.0 if along < _NO_FORCE * max(across, 1.0) else along)
        bearings = self.state.shaft.bearings
        one_sided = [number for number, each in enumerate(bearings) if each.kind in OPPOSED_KINDS]
        if not one_sided:
            return found
        if (why := _not_opposed(bearings, one_sided)) is not None:
            for number in one_sided:
                found[number] = f"life: {why}"
            return found
        left, right = sorted(one_sided, key=lambda number: bearings[number].pushes or "")
        outer = -math.fsum(float(force[2]) for force in self.state.reactions)  # thrust on the shaft, taken by what pushes left
        factors = bearings[left].Y, bearings[right].Y
        assert factors[0] is not None and factors[1] is not None
        loads = opposed_axial_loads((radial[left], radial[right]), (factors[0], factors[1]), outer)
        found[left], found[right] = loads
        return found

    @property
    def greatest_deflection(self) -> tuple[float, float]:
        """Greatest deflection (µm) and its position (mm)."""
        across = 1000 * np.hypot(*self.state.moved.reshape(-1, 6)[:, :2].T)
        return float(across.max()), float(self.state.shaft.nodes[across.argmax()])

    @property
    def greatest_stress(self) -> tuple[float, float]:
        """Greatest nominal equivalent stress (MPa) and its position (mm)."""
        stresses, nodes = self.state.stresses, self.state.shaft.nodes
        part, end = np.unravel_index(int(stresses.argmax()), stresses.shape)
        return float(stresses.max()), float(nodes[part + end])

    @cached_property
    def shoulders(self) -> list[ShoulderSafety]:
        """Safeties at the shoulders by DIN 743."""
        return shoulder_safeties(self.state)

    def to_dict(self) -> JsonObject:
        """Return reactions, stations, bearings, safeties of shoulders and critical speeds."""
        return self.state.to_dict() | {
            "bearings": [each.to_dict() for each in self.lives],
            "shoulders": [each.to_dict() for each in self.shoulders],
            **self.speeds,
        }

    @cached_property
    def speeds(self) -> JsonObject:
        """Critical speeds and natural frequencies of bending."""
        return self.whirl.to_dict(self.speed)

    @cached_property
    def whirl(self) -> ShaftWhirl:
        """Whirl of the shaft with the discs of its gears."""
        return ShaftWhirl.of(self.state.shaft, self.discs)


def _not_opposed(bearings: Sequence[ShaftBearing], one_sided: Sequence[int]) -> str | None:
    """Return why bearings that push to one side are no opposed pair whose thrust is known, or None."""
    own = [bearings[number] for number in one_sided]
    if len(own) != 2:
        return f"{len(own)} bearings push the shaft to one side, two opposed ones are in the model"
    if any(each.pushes is None for each in own):
        return 'pushes ("left" or "right") is not given'
    if own[0].pushes == own[1].pushes:
        return f"both bearings push the shaft to the {own[0].pushes}: nothing holds it"
    if any(each.Y is None for each in own):
        return "e and Y are not given"
    if any(each.axial_stiffness for number, each in enumerate(bearings) if number not in one_sided):
        return "a third bearing holds the shaft axially too"
    return None


def _lasting(lives: Sequence[BearingLife], shares: Sequence[float], bins: Sequence[tuple[float, ShaftResult]]) -> BearingLife:
    """Return the life of a bearing over a spectrum (Miner): 1/L_h is the sum of the shares of time over the lives of each.

    The equivalent load is the cubic mean, or that with the exponent of rollers, over the revolutions.
    """
    first = next((each for each in lives if each.revolutions is None), lives[0])
    if first.revolutions is None or any(each.equivalent is None or each.hours is None for each in lives):
        return first
    turns = [share * abs(result.speed) for share, result in zip(shares, (result for _, result in bins), strict=True)]
    hours = _harmonic([each.hours for each in lives], shares)
    assert hours is not None
    modified = _harmonic([each.modified_hours for each in lives], shares)
    revolutions = hours * 60 * math.fsum(turns) / 1e6
    most = max(lives, key=lambda each: each.equivalent.load if each.equivalent else 0.0)
    assert most.equivalent is not None and most.revolutions is not None
    power = math.log(most.revolutions / revolutions) if math.isfinite(revolutions) and most.revolutions else 0.0
    exponent = 3.0 if bins[0][1].is_ball(lives[0].name) else 10 / 3
    load = most.equivalent._replace(load=most.equivalent.load * math.exp(power / exponent))
    return replace(most, equivalent=load, revolutions=revolutions, hours=hours, modified_hours=modified)


def _harmonic(lives: Sequence[float | None], shares: Sequence[float]) -> float | None:
    """Return the life (h) of parts with shares of time, or None where one is not known."""
    if any(each is None for each in lives):
        return None
    damage = math.fsum(share / life for life, share in zip(lives, shares, strict=True) if life)
    return 1 / damage if damage else math.inf


_NO_FORCE = 1e-9
"""Axial force over the radial one that is rounding."""


@dataclass(frozen=True)
class ArrangementResult:
    """Shafts by their names, and the load over the face of their mesh, where they have one; `name` is that of the design."""

    name: str
    shafts: Mapping[str, ShaftResult]
    mesh: JsonObject | None = None

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about the result."""
        return tuple(self._found())

    def _found(self) -> Iterator[Notice]:
        yield Notice("no-clearance", "bearings have neither clearance nor preload")
        for name, shaft in self.shafts.items():
            speeds = shaft.speeds["critical_speeds"]
            if speeds and abs(shaft.speed) > _NEAR * speeds[0]:
                text = f"{name}: its speed of {abs(shaft.speed):.0f} rpm is near or above its first critical speed,"
                yield Notice("critical-speed", f"{text} {speeds[0]:.0f} rpm")

    @property
    def least_life(self) -> float | None:
        """Least basic life (h) of all bearings of which it is known."""
        hours = (life.hours for shaft in self.shafts.values() for life in shaft.lives)
        return min((each for each in hours if each is not None), default=None)

    @property
    def unconfirmed(self) -> list[str]:
        """Figures that rest on memory, if any do."""
        lives = any(life.revolutions is not None for shaft in self.shafts.values() for life in shaft.lives)
        strength = any(not each.reason for shaft in self.shafts.values() for each in shaft.shoulders)
        return [*([RECALLED] if lives else []), *([RECALLED_STRENGTH] if strength else [])]

    @property
    def not_judged(self) -> list[str]:
        """Reasons why parts were not judged."""
        found = [
            f"{name}: {life.name}: {why}" for name, shaft in self.shafts.items() for life in shaft.lives for why in life.reasons
        ]
        shoulders = [(name, each) for name, shaft in self.shafts.items() for each in shaft.shoulders]
        for name, why in dict.fromkeys((name, each.reason) for name, each in shoulders if each.reason):
            places = ", ".join(f"{each.position:g}" for own, each in shoulders if (own, each.reason) == (name, why))
            found.append(f"{name}: shoulders at {places} mm (DIN 743): {why}")
        return [*found, "strength of the shafts at keys, grooves, press fits and splines (DIN 743)"]

    @property
    def least_safeties(self) -> tuple[float | None, float | None]:
        """Least safeties of all shoulders against fatigue and yield, as far as they are known."""
        known = [each for shaft in self.shafts.values() for each in shaft.shoulders if not each.reason]
        fatigue = min((each.fatigue for each in known if each.fatigue is not None), default=None)
        static = min((each.static for each in known if each.static is not None), default=None)
        return fatigue, static

    def to_dict(self) -> dict[str, Any]:
        """Return the content of shafts.json."""
        found: dict[str, Any] = {"shafts": {name: shaft.to_dict() for name, shaft in self.shafts.items()}}
        unconfirmed = {"unconfirmed": self.unconfirmed}
        return found | ({} if self.mesh is None else {"mesh": self.mesh}) | unconfirmed


_NEAR = 0.8
"""Share of the first critical speed from which a speed is told."""
