"""Planetary trains for tests: types A to D, the Alm thesis's, trains with loads, and sets by numbers of teeth."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Floats
from gearcad.dynamics.planetary.planar_model import (
    MemberMass,
    MeshLine,
    PlanarMember,
    PlanarTrain,
    TrainMasses,
    TrainSprings,
    springs_of,
)
from gearcad.geometry import BasicRack, Body, Gear, GearPair
from gearcad.planetary import Carrier, Central, PairStage, PlanetaryTrain, Rim
from gearcad.planetary.train_data import TrainData


def _gear(teeth: int, module: float, shift: float, helix: float = 0.0) -> Gear:
    return Gear(teeth=teeth, normal_module=module, profile_shift=shift, face_width=20.0, helix_angle=helix)


def _train(planets: int, a: Gear, rims: tuple[Gear, ...], b: Gear, **keys: object) -> PlanetaryTrain:
    named = tuple(Rim(name=f"rim{i + 1}", gear=gear, axial_position=25.0 * i) for i, gear in enumerate(rims))
    return PlanetaryTrain(
        planets=planets,
        centrals=(Central(name="a", gear=a, meshes="rim1"), Central(name="b", gear=b, meshes=named[-1].name)),
        rims=named,
        input="a",
        output="carrier",
        fixed="b",
        **keys,  # type: ignore[arg-type]
    )


TRAINS = {
    "A": _train(3, _gear(24, 2, 0.3), (_gear(21, 2, 0.2),), _gear(-66, 2, -0.7)),
    "A helical": _train(4, _gear(20, 2, 0.0, -15), (_gear(28, 2, 0.0, 15),), _gear(-76, 2, 0.0, 15)),
    "B": _train(4, _gear(24, 2, 0.0), (_gear(40, 2, 0.0), _gear(22, 2.45, 0.2)), _gear(-74, 2.45, -0.33), centre_distance=64.0),
    "C": _train(3, _gear(30, 2, 0.2), (_gear(24, 2, 0.1), _gear(23, 2, 0.3)), _gear(31, 2, 0.0)),
    "D": _train(
        3, _gear(-70, 2.8, -1.2025), (_gear(22, 2.8, 0.5), _gear(21, 2.6, 0.5)), _gear(-72, 2.6, -1.6794), centre_distance=69.0
    ),
}
"""D is the set of the Alm thesis."""


def on_springs(train: PlanetaryTrain, **stiffness: float | None) -> PlanetaryTrain:
    """The same with one stiffness of supports, pins (`support`, `pin`; N/µm) and turning (`torsion`, N·m/rad) everywhere."""
    held = {"support_stiffness": stiffness.get("support", 0.0), "torsional_stiffness": stiffness.get("torsion")}
    centrals = tuple(replace(central, **held) for central in train.centrals)
    carrier = Carrier(pin_stiffness=stiffness.get("pin"), **held)  # type: ignore[arg-type]
    return replace(train, centrals=centrals, carrier=carrier)


def masses_of(planet: tuple[float, float], **members: tuple[float, float]) -> TrainMasses:
    """From mass (kg) and inertia (kg·m²) of each."""
    found = {name: MemberMass(mass=mass, inertia=inertia) for name, (mass, inertia) in members.items()}
    return TrainMasses(members=found, planet=MemberMass(mass=planet[0], inertia=planet[1]))


MASSES = masses_of((0.7, 3e-4), carrier=(3.2, 6e-3), a=(0.5, 4e-4), b=(2.1, 9e-3))
"""For any of the trains, on springs or not."""


def lin_parker_train(
    planets: int,
    *,
    meshes: tuple[float, float],
    angles: tuple[float, float],
    supports: dict[str, float],
    torsion: dict[str, float],
    pin: float,
    turned: float = 0.0,
    moved: float = 0.0,
) -> TrainSprings:
    """As in the paper, N/m and degrees: carrier c, sun s, ring r, with radii of 1 m, so that inertias are those over r².

    All planets are `turned`, the second is `moved` besides (rad).
    """
    places = turned + 2 * np.pi * np.arange(planets) / planets
    places[1] += moved
    members = tuple(PlanarMember(name=each, radius=1.0, support=supports[each], torsion=torsion[each]) for each in "csr")
    lines = tuple(
        MeshLine(name=name, external=name == "s-p", pressure_angle=float(np.radians(angle)), stiffness=np.full(planets, k))
        for name, k, angle in zip(("s-p", "r-p"), meshes, angles, strict=True)
    )
    return springs_of(PlanarTrain(angles=places, members=members, meshes=lines, pin=pin, planet_radius=1.0))  # type: ignore[arg-type]


def alm_set(*, rim_diameter: float | None = 240.0, **changes: Any) -> PlanetaryTrain:
    """Two rings on a stepped planet: m 2.8 mm 22/-70 and m 2.6 mm 21/-72 at 69 mm (x of ring 5 is -1.6794)."""
    body = Body(rim_diameter=rim_diameter)
    third = Gear(name="rim_3", teeth=22, normal_module=2.8, profile_shift=0.5, face_width=16)
    fourth = Gear(name="ring_4", teeth=-70, normal_module=2.8, profile_shift=-1.2025, face_width=14, body=body)
    stepped = Gear(name="rim_3p", teeth=21, normal_module=2.6, profile_shift=0.5, face_width=16)
    fifth = Gear(name="ring_5", teeth=-72, normal_module=2.6, profile_shift=-1.6794, face_width=14, body=body)
    given: dict[str, Any] = {
        "planets": 3,
        "centrals": (
            Central(name="ring_4", gear=fourth, meshes="rim_3"),
            Central(name="ring_5", gear=fifth, meshes="rim_3p"),
        ),
        "rims": (Rim(name="rim_3", gear=third), Rim(name="rim_3p", gear=stepped, axial_position=20)),
        "input": "carrier",
        "output": "ring_5",
        "fixed": "ring_4",
        "centre_distance": 69.0,
    }
    return PlanetaryTrain(**given | changes)


def pre_stage() -> PairStage:
    """That of the Alm thesis, m 1.5 mm 18/161 at 135 mm, before the carrier."""
    pinion = Gear(name="pinion_1", teeth=18, normal_module=1.5, profile_shift=0.3422, face_width=15)
    wheel = Gear(name="gear_2", teeth=161, normal_module=1.5, profile_shift=0.1682, face_width=10)
    pair = GearPair(pinion=pinion, wheel=wheel, centre_distance=135.0, name="pre_stage")
    return PairStage(name="pre_stage", pair=pair, pinion="pinion_1", wheel="carrier", angle=30.0)


def simple_set(
    sun: int = 24, planet: int = 21, *, helix_angle: float = 0.0, rim_diameter: float | None = None, **changes: Any
) -> PlanetaryTrain:
    """Sun, three planets (or four, where only these fit) and ring of m_n 2 mm without backlash: x 0.3, 0.2 and -0.7."""

    def gear(name: str, teeth: int, shift: float, helix: float, body: Body) -> Gear:
        return Gear(name=name, teeth=teeth, normal_module=2, profile_shift=shift, face_width=20, helix_angle=helix, body=body)

    ring = gear("ring", -(sun + 2 * planet), -0.7, -helix_angle, Body(rim_diameter=rim_diameter))
    given: dict[str, Any] = {
        "planets": 4 if 2 * (sun + planet) % 3 else 3,
        "centrals": (
            Central(name="sun", gear=gear("sun", sun, 0.3, helix_angle, Body()), meshes="planet"),
            Central(name="ring", gear=ring, meshes="planet"),
        ),
        "rims": (Rim(name="planet", gear=gear("planet", planet, 0.2, -helix_angle, Body())),),
        "carrier": Carrier(),
        "input": "sun",
        "output": "carrier",
        "fixed": "ring",
    }
    return PlanetaryTrain(**given | changes)


SUN_FORCE = 60000.0
"""N: sum of what the planets press the sun with."""


def sun_set(planets: int, *, floating: tuple[str, ...] = (), **changes: Any) -> PlanetaryTrain:
    """Sun 40, planet 20, ring -80 without shifts: working pressure angles are 22 deg. `floating` members have no bearing."""

    def gear(teeth: int) -> Gear:
        return Gear(teeth=teeth, normal_module=2, face_width=20, rack=BasicRack(pressure_angle=22.0))

    def support(name: str) -> float | None:
        return 0.0 if name in floating else None

    carrier = changes.pop("carrier", Carrier())
    given: dict[str, Any] = {
        "planets": planets,
        "centrals": (
            Central(name="sun", gear=gear(40), meshes="planet", support_stiffness=support("sun")),
            Central(name="ring", gear=gear(-80), meshes="planet", support_stiffness=support("ring")),
        ),
        "rims": (Rim(name="planet", gear=gear(20)),),
        "carrier": replace(carrier, support_stiffness=support("carrier")),
        "input": "sun",
        "output": "carrier",
        "fixed": "ring",
    }
    return PlanetaryTrain(**given | changes)


def output_torque(train: PlanetaryTrain, sun_force: float = SUN_FORCE) -> float:
    """Torque (N·m) on the carrier where the planets press the sun with this force."""
    return (1 - train.basic_ratio) * sun_force * train.meshes[0].central_base_radius / 1e3


@dataclass(frozen=True)
class Trapezoid:
    """Stiffness (N/µm) between `least` and `most`, straight over `ramp` base pitches, two pairs from 0 for `duty` of them."""

    least: float
    most: float
    duty: float
    ramp: float = 0.06

    @property
    def mean(self) -> float:
        """Over a base pitch: each ramp counts half."""
        return self.least + (self.most - self.least) * self.duty

    @property
    def jumps(self) -> Floats:
        """None."""
        return np.zeros(0)

    def stiffness_at(self, ahead: ArrayLike) -> Floats:
        """At places in base pitches."""
        place = np.mod(np.asarray(ahead, float), 1.0)
        rising, falling = np.clip(place / self.ramp, 0, 1), np.clip((place - self.duty) / self.ramp, 0, 1)
        found: Floats = self.least + (self.most - self.least) * np.where(place < self.duty, rising, 1 - falling)
        return found


@dataclass(frozen=True)
class Square:
    """Stiffness (N/µm) of two pairs from 0 for `duty` of a base pitch, of one for the rest."""

    least: float
    most: float
    duty: float

    @property
    def jumps(self) -> Floats:
        """Where the second pair comes and goes."""
        return np.array([0.0, self.duty])

    def stiffness_at(self, ahead: ArrayLike) -> Floats:
        """At places in base pitches."""
        return np.where(np.mod(np.asarray(ahead, float), 1.0) < self.duty, self.most, self.least)


def gear(teeth: int, module: float = 1.0, shift: float = 0.0, helix: float = 0.0, width: float = 14.0) -> Gear:
    return Gear(teeth=teeth, normal_module=module, profile_shift=shift, helix_angle=helix, face_width=width)


def unchecked_set(a: int, rim: int, rim_2: int, b: int, *, stepped: bool = True, **fields: Any) -> TrainData:
    """Centrals a and b with their rims and the carrier c; nothing need fit, for what teeth alone decide."""
    rims = (Rim(name="rim", gear=gear(rim)), Rim(name="rim_2", gear=gear(rim_2)))[: 2 if stepped else 1]
    centrals = (Central(name="a", gear=gear(a), meshes="rim"), Central(name="b", gear=gear(b), meshes=rims[-1].name))
    roles = {"planets": 1, "input": "a", "output": "b"} | fields
    return TrainData(centrals=centrals, rims=rims, **roles)


def stage(name: str, pinion: tuple[str, int], wheel: tuple[str, int]) -> PairStage:
    """A stage between two shafts, by their names and teeth."""
    pair = GearPair(pinion=gear(pinion[1]), wheel=gear(wheel[1]))
    return PairStage(name=name, pair=pair, pinion=pinion[0], wheel=wheel[0])


def alm_train(*, in_phase: bool = False, **fields: Any) -> PlanetaryTrain:
    """The train of the Alm thesis, shifts of the rings from its centre distance; or its variant with planets in phase.

    `fields` replace those of the train; without stages the carrier is the input.
    """
    teeth, module, shifts = (
        ((-75, 24, 21, -72), (2.7, 2.6), (-0.16, 0.1, 0.5, -1.6794))
        if in_phase
        else ((-70, 22, 21, -72), (2.8, 2.6), (-1.2025, 0.5, 0.5, -1.6794))
    )
    ring_4, rim_3, rim_3p, ring_5 = (gear(z, module[i > 1], shifts[i]) for i, z in enumerate(teeth))
    pair = GearPair(pinion=gear(18, 1.5, 0.3), wheel=gear(161, 1.5, 0.2), centre_distance=135.0)
    given = {
        "planets": 3,
        "centre_distance": 69.0,
        "centrals": (Central(name="ring_4", gear=ring_4, meshes="rim_3"), Central(name="ring_5", gear=ring_5, meshes="rim_3p")),
        "rims": (Rim(name="rim_3", gear=rim_3), Rim(name="rim_3p", gear=rim_3p, axial_position=20.0)),
        "fixed": "ring_4",
        "output": "ring_5",
        "stages": (PairStage(name="pre_stage", pair=pair, pinion="pinion_1", wheel="carrier"),),
    } | fields
    return PlanetaryTrain(**({"input": "pinion_1" if given["stages"] else "carrier"} | given))
