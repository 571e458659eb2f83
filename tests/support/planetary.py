"""Trains to look at, whether their gears overlap, and contacts of a mesh found by cutting exact flanks."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from gearcad import Gear, GearPair
from gearcad.core.records import Floats, PerGear, Role
from gearcad.geometry.gear_data import twist
from gearcad.planetary import Central, GearPlace, PairStage, PlanetaryTrain, Rim, SetMesh, TrainPose
from gearcad.planetary.train_data import TrainData
from support.ring_pairs import CHORD_ERROR, HalfTooth, RingMesh

NEIGHBOURS = 4
"""Teeth on each side of the line of centres that are looked at."""


def gear(teeth: int, module: float, shift: float = 0.0, **given: float) -> Gear:
    """A gear 20 mm wide."""
    return Gear(**{"teeth": teeth, "normal_module": module, "profile_shift": shift, "face_width": 20.0, **given})


def simple_train(
    teeth: tuple[int, int, int],
    shifts: tuple[float, float, float],
    planets: int,
    *,
    gears: tuple[Gear, Gear, Gear] | None = None,
    **given: object,
) -> PlanetaryTrain:
    """Sun, planet and ring (type A), of module 2 or as given: the ring is fixed, the sun drives."""
    sun, planet, ring = gears or (gear(z, 2.0, x) for z, x in zip(teeth, shifts, strict=True))
    return PlanetaryTrain(
        **{
            "planets": planets,
            "centrals": (Central(name="sun", gear=sun, meshes="planet"), Central(name="ring", gear=ring, meshes="planet")),
            "rims": (Rim(name="planet", gear=planet),),
            "fixed": "ring",
            "input": "sun",
            "output": "carrier",
            **given,
        }
    )


@dataclass(frozen=True)
class OuterMesh:
    """Two external gears at a distance of their axes (mm): the second one's axis on +x of the first one's.

    Do they overlap where they stand? Judged as a `RingMesh` does, on polygons.
    """

    first: Gear
    second: Gear
    distance: float

    @cached_property
    def _halves(self) -> tuple[HalfTooth, HalfTooth]:
        chord = CHORD_ERROR * self.first.transverse_module
        return HalfTooth.of(self.first.profile, chord), HalfTooth.of(self.second.profile, chord)

    def standing(self, first: Floats, second: Floats) -> Floats:
        """Least distance (n,) in mm along circles of gears turned by angles (n,) in rad; negative where they overlap."""
        one, two = self._halves
        towards = self._clear(self.first, first, one, self.second, second - np.pi, two)
        return np.minimum(towards, self._clear(self.second, second - np.pi, two, self.first, first, one))

    def _clear(self, own: Gear, turned: Floats, half: HalfTooth, mate: Gear, mate_turned: Floats, other: HalfTooth) -> Floats:
        """Of the corners of a gear's teeth near the line of centres, which lies at angle 0 for it, and for its mate too."""
        pitch, mate_pitch = 2 * math.pi / own.teeth, 2 * math.pi / mate.teeth
        teeth = (np.arange(-NEIGHBOURS, NEIGHBOURS + 1) - np.round(turned / pitch)[:, None]) * pitch + turned[:, None]
        angle = teeth[..., None] + np.r_[half.angle, -half.angle]
        radius = np.r_[half.radius, half.radius]
        across, along = self.distance - radius * np.cos(angle), -radius * np.sin(angle)  # seen from the mate, turned by pi
        at = np.hypot(across, along)
        off = np.abs(
            np.mod(np.arctan2(along, across) - mate_turned[:, None, None] + mate_pitch / 2, mate_pitch) - mate_pitch / 2
        )
        clear = np.where(at > other.radius[-1], math.inf, (off - other.at(at)) * at)
        result: Floats = np.where(at < other.radius[0], at - other.radius[0], clear).min(axis=(1, 2))
        return result


@dataclass(frozen=True)
class MeshWitness:
    """A central and a planet's rim, and how far their exact outlines are apart."""

    mesh: SetMesh

    @cached_property
    def _pair(self) -> RingMesh | OuterMesh:
        central, rim, distance = self.mesh.central.gear, self.mesh.rim.gear, abs(self.mesh.pair.centre_distance)
        return RingMesh(rim, central, distance) if central.internal else OuterMesh(central, rim, distance)

    def clearance(self, central: Floats, rim: Floats, psi: Floats) -> Floats:
        """Least distance (n,) in mm along circles; negative where they overlap.

        Sections of the central turned by `central`, of planets at `psi` turned by `rim` (n,) in rad.
        """
        if isinstance(self._pair, RingMesh):
            return self._pair.standing(rim - psi, central - psi, np.zeros(len(psi)))
        return self._pair.standing(central - psi, rim - psi)

    @property
    def working_radius(self) -> float:
        """Of the central (mm)."""
        return abs(self.mesh.pair.working_pitch_diameters.pick(self.mesh.central_role)) / 2

    def in_pose(self, pose: TrainPose, turned: float = 0.0) -> Floats:
        """The clearances in a pose with the central `turned` on (rad), of all planets; helical teeth at three heights."""
        central, rim = self.mesh.central, self.mesh.rim
        bottom = pose.heights[central.name], pose.heights[rim.name]
        low, high = max(bottom), min(bottom[0] + central.gear.face_width, bottom[1] + rim.gear.face_width)
        heights = np.array([low, (low + high) / 2, high] if central.gear.helix_angle else [low])
        psi = np.array([math.radians(planet.angle) for planet in pose.planets])
        own = np.array([math.radians(planet.rotations[rim.name]) for planet in pose.planets])
        rims = own + twist(rim.gear) * (heights - bottom[1])[:, None]
        at = math.radians(pose.rotations[central.name]) + turned + twist(central.gear) * (heights - bottom[0])[:, None]
        at, psi = np.broadcast_arrays(at, psi, rims)[:2]
        return self.clearance(at.ravel(), rims.ravel(), psi.ravel())


def train_clearance(train: TrainData, pose: TrainPose) -> float:
    """Least clearance (mm) of all meshes with the planets."""
    return min(float(MeshWitness(mesh).in_pose(pose).min()) for mesh in train.meshes)


def clearance(first: Gear, second: Gear, places: tuple[GearPlace, GearPlace], height: float) -> float:
    """Least distance (mm along circles) of two gears in the plane at `height` (mm)."""
    turns = [math.radians(p.rotation) + twist(g, height - p.height) for g, p in zip((first, second), places, strict=True)]
    one, two = places
    towards, distance = math.atan2(two.y - one.y, two.x - one.x), math.hypot(two.y - one.y, two.x - one.x)
    if second.internal:
        first, second, towards, turns = second, first, towards + math.pi, turns[::-1]
    a, b = (np.array([turn - towards]) for turn in turns)
    if first.internal:
        return float(RingMesh(second, first, distance).standing(b, a, np.zeros(1))[0])
    return float(OuterMesh(first, second, distance).standing(a, b)[0])


def stage_clearance(stage: PairStage, places: PerGear[GearPlace]) -> float:
    """Least clearance of a stage at both ends of the common width."""
    pinion, wheel = stage.pair.gears
    low = max(place.height for place in places)
    high = min(place.height + gear.face_width for place, gear in zip(places, stage.pair.gears, strict=True))
    return min(clearance(pinion, wheel, tuple(places), z) for z in (low, high))  # type: ignore[arg-type]


def thesis_train(**given: object) -> PlanetaryTrain:
    """The train of the Alm thesis, the profile shift of ring 5 as its 69 mm ask for."""
    thin = {"tooth_thinning": 0.03}
    rims = (
        Rim(name="rim_3", gear=gear(22, 2.8, 0.5, **thin)),
        Rim(name="rim_3p", gear=gear(21, 2.6, 0.5, **thin), axial_position=30.0),
    )
    centrals = (
        Central(name="ring_4", gear=gear(-70, 2.8, -1.2025, **thin), meshes="rim_3"),
        Central(name="ring_5", gear=gear(-72, 2.6, -1.6794, **thin), meshes="rim_3p"),
    )
    pair = GearPair(pinion=gear(18, 1.5, **thin), wheel=gear(161, 1.5, **thin), centre_distance=135.0)
    train = PlanetaryTrain(
        planets=3,
        centrals=centrals,
        rims=rims,
        fixed="ring_4",
        input="pinion_1",
        output="ring_5",
        centre_distance=69.0,
        stages=(PairStage(name="stage", pair=pair, pinion="pinion_1", wheel="carrier", angle=25.0, axial_position=60.0),),
    )
    return replace(train, **given)


@dataclass(frozen=True)
class Contacts:
    """`ahead` (n,): how far each contact is past the pitch point as it moves (mm); `radii` (n,): where on the pair's pinion."""

    ahead: Floats
    radii: Floats


@dataclass(frozen=True)
class _Placed:
    """A gear with its axis at `centre`, tooth 0 at `angle`, of which flanks on `side` (1: counter-clockwise one) carry."""

    gear: Gear
    centre: complex
    angle: float
    side: int

    def _ends(self) -> tuple[float, float]:
        ends = sorted((abs(self.gear.form_diameter) / 2, self.gear.profile.tip_form_diameter / 2))
        return ends[0], ends[1]

    def point(self, tooth: int, radius: float) -> complex:
        turn = self.angle + 2 * math.pi * tooth / self.gear.tooth_count
        half = math.radians(float(self.gear.profile.half_angle(radius)))
        return complex(self.centre + radius * np.exp(1j * (turn + self.side * half)))

    def normal(self, radius: float) -> complex:
        """That of the flank of tooth 0 when its point at a radius has come round to angle 0."""
        step = 1e-4
        low, high = (self.point(0, radius + each) for each in (-step, step))
        along = (high - low) / (self.point(0, radius) - self.centre)
        return 1j * along / abs(along)

    def cuts(self, origin: complex, direction: complex) -> dict[int, complex]:
        """Where the flank of each tooth cuts a line, if it does."""
        low, high = self._ends()

        def off(radius: float, tooth: int) -> float:
            return ((self.point(tooth, radius) - origin) / direction).imag

        found = {}
        for tooth in range(self.gear.tooth_count):
            near = abs(self.point(tooth, low) - origin) < 6 * self.gear.transverse_pitch
            if near and off(low, tooth) * off(high, tooth) <= 0:
                found[tooth] = self.point(tooth, brentq(off, low, high, args=(tooth,), xtol=1e-12))
        return found


def contacts(mesh: SetMesh, *, angle: float, psi: float, driver: Role, turning: int) -> Contacts:
    """Contacts where the central's tooth 0 is at `angle`, the planet at `psi` (rad), the central turning ccw (1) or cw (-1).

    The rim is turned until a flank of it passes through a cut of the central's with the line of action.
    """
    pair, central, rim = mesh.pair, mesh.central.gear, mesh.rim.gear
    rim_turning = -turning if mesh.external else turning
    carries = turning if driver is mesh.central_role else -turning
    rim_carries = rim_turning if driver is mesh.rim_role else -rim_turning
    working = abs(pair.working_pitch_diameters.pick(mesh.central_role)) / 2
    origin = working * np.exp(1j * psi)
    placed = _Placed(central, 0j, angle, carries)
    # The common normal at the pitch point is that of the flank there.
    direction = placed.normal(working) * np.exp(1j * psi)
    cut = placed.cuts(origin, direction)
    later = _Placed(central, 0j, angle + turning * 1e-4, carries).cuts(origin, direction)
    tooth = next(each for each in cut if each in later)
    forward = direction * math.copysign(1.0, ((later[tooth] - cut[tooth]) / direction).real)
    centre = abs(pair.centre_distance) * np.exp(1j * psi)
    touched = cut[min(cut, key=lambda each: abs(cut[each] - origin))]
    radius, at = abs(touched - centre), np.angle(touched - centre)
    loose = _Placed(rim, centre, 0.0, rim_carries)
    turned = _Placed(rim, centre, float(at - np.angle(loose.point(0, radius) - centre)), rim_carries)
    mates = np.array(list(turned.cuts(origin, direction).values()))
    # Both touch where both flanks reach the line: in the same points, or they would not roll.
    both = [each for each in cut.values() if abs(mates - each).min() < 1e-6]
    pinion = 0j if mesh.central_role is Role.PINION else centre
    return Contacts(np.array([((each - origin) / forward).real for each in both]), np.abs(np.array(both) - pinion))
