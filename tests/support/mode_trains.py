"""Planetary trains of types A to D, and one whose planets are helical, for tests of their springs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gearcad.dynamics.planetary.planar_model import (
    MemberMass,
    MeshLine,
    PlanarMember,
    PlanarTrain,
    TrainMasses,
    TrainSprings,
    springs_of,
)
from gearcad.geometry import Gear
from gearcad.planetary import Carrier, Central, PlanetaryTrain, Rim


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
