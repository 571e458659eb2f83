"""Masses of trains: of their solids, against annuli in closed form, and as they are given."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.loaded_trains import alm_set, simple_set

from gearcad.dynamics.planetary.planar_model import MemberMass, train_masses
from gearcad.geometry import Body, Gear
from gearcad.material import Material
from gearcad.planetary import Carrier, PlanetaryTrain

STEEL = Material().density


def annulus(gear: Gear, inner: float, outer: float) -> tuple[float, float]:
    """kg and kg·m² of a disc of the gear's width between two diameters (mm)."""
    mass = STEEL * 1e-9 * math.pi / 4 * (outer**2 - inner**2) * gear.face_width
    return mass, mass * (outer**2 + inner**2) / 8 * 1e-6


def between(gear: Gear, hole: float = 0.0) -> tuple[tuple[float, float], tuple[float, float]]:
    """Annuli that are within the gear, and around it: to its root and to its tip circle."""
    if gear.internal:
        ends = [annulus(gear, abs(d), float(gear.body.rim_diameter or 0)) for d in (gear.root_diameter, gear.tip_diameter)]
    else:
        ends = [annulus(gear, hole, d) for d in (gear.root_diameter, gear.tip_diameter)]
    return ends[0], ends[1]


def section(gear: Gear) -> tuple[float, float]:
    """kg and kg·m² by the contour of the teeth as a polygon, and the circle of the rim: area and second moment by Green."""
    points = gear.profile.contour(1e-4)
    (x, y), (u, v) = points.T, np.roll(points, -1, axis=0).T
    across = x * v - u * y
    area = abs(float(across.sum())) / 2
    moment = abs(float(across @ (x * x + x * u + u * u + y * y + y * v + v * v))) / 12
    radius = float(gear.body.rim_diameter or 0) / 2
    area, moment = abs(math.pi * radius**2 - area), abs(math.pi / 2 * radius**4 - moment)
    return STEEL * 1e-9 * gear.face_width * area, STEEL * 1e-15 * gear.face_width * moment


def test_the_alm_set_is_weighed() -> None:
    train = alm_set()
    found = train_masses(train)
    for central in train.centrals:
        own = found.members[central.name]
        (least, least_inertia), (most, most_inertia) = between(central.gear)
        assert least < own.mass < most
        assert least_inertia < own.inertia < most_inertia
        assert (own.mass, own.inertia) == pytest.approx(section(central.gear), rel=1e-5)
    rims = [rim.gear for rim in train.rims]
    together = [sum(column) for column in zip(*map(section, rims), strict=True)]
    assert (found.planet.mass, found.planet.inertia) == pytest.approx(together, rel=1e-5)
    assert found.members["carrier"] == MemberMass(mass=None, inertia=None, why=found.missing[0])
    assert found.missing == ("carrier.mass and inertia: must be given: a carrier has no solid here",)


def test_a_ring_without_a_rim_has_no_mass_and_says_why() -> None:
    ring = train_masses(simple_set()).members["ring"]
    assert ring.mass is None
    assert ring.inertia is None
    assert ring.why.startswith("ring.body.rim_diameter is missing: must be given, at least 140.201 mm")


def test_what_is_given_wins() -> None:
    train = simple_set(carrier=Carrier(mass=3.0, inertia=0.01, planet_mass=0.4))
    centrals = [replace(each, mass=1.0, inertia=2e-3) for each in train.centrals]
    found = train_masses(replace(train, centrals=tuple(centrals)))
    assert found.members["ring"] == found.members["sun"] == MemberMass(mass=1.0, inertia=2e-3, given=("mass", "inertia"))
    assert found.members["carrier"] == MemberMass(mass=3.0, inertia=0.01, given=("mass", "inertia"))
    assert found.planet.mass == 0.4
    assert found.planet.given == ("mass",)
    least, most = (each[1] for each in between(train.rims[0].gear))
    assert least < found.planet.inertia < most
    assert not found.missing


def test_densities_by_name() -> None:
    steel, light = (train_masses(pinned(), each) for each in (Material(), {"planet": Material(density=STEEL / 2)}))
    assert light.planet.mass == pytest.approx(steel.planet.mass / 2)
    assert light.planet.inertia == pytest.approx(steel.planet.inertia / 2)


def pinned() -> PlanetaryTrain:
    """A set of which only the planet is weighed."""
    train = simple_set()
    return replace(train, centrals=tuple(replace(each, mass=1.0, inertia=1e-3) for each in train.centrals))


def test_a_bore_is_not_weighed() -> None:
    train = pinned()
    bored = replace(train.rims[0], gear=replace(train.rims[0].gear, body=Body(bore=20)))
    full, hollow = (train_masses(replace(train, rims=(rim,))).planet for rim in (train.rims[0], bored))
    mass, inertia = annulus(bored.gear, 0, 20)
    assert full.mass - hollow.mass == pytest.approx(mass, rel=1e-6)
    assert full.inertia - hollow.inertia == pytest.approx(inertia, rel=1e-6)
