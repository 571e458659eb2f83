"""Springs of planetary trains: rigid motions, the approach of involute flanks after small displacements, and what is held."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from support.mode_trains import TRAINS, on_springs

from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats
from gearcad.dynamics.planetary.planar_model import SpringKind, TrainSprings, held_members, train_springs
from gearcad.geometry import GearPair
from gearcad.planetary import PairStage, PlanetaryTrain

EVERY = pytest.mark.parametrize("kind", TRAINS)
SENSES = pytest.mark.parametrize("sense", [1, -1])

STIFFNESS = (400.0, 500.0)


def _floating(kind: str, sense: int = 1) -> TrainSprings:
    """Nothing held, pins that give way."""
    return train_springs(on_springs(TRAINS[kind], pin=200.0), STIFFNESS, held=(), sense=sense)


def _with(springs: TrainSprings, **values: float) -> Floats:
    """Coordinates of which some are given, planets alike, the others 0."""
    result = np.zeros(len(springs.coordinates))
    for place, name in enumerate(springs.coordinates):
        owner, coordinate = name.split(".")
        result[place] = values.get(f"{owner.split()[0]}_{coordinate}", 0.0)
    return result


@EVERY
@SENSES
def test_a_rigid_turn_elongates_nothing(kind: str, sense: int) -> None:
    springs = _floating(kind, sense)
    radii = {member.name: member.radius for member in springs.planar.members}
    distance = radii["carrier"]
    q = _with(
        springs, **{f"{name}_u": r for name, r in radii.items()}, planet_eta=distance, planet_u=springs.planar.planet_radius
    )
    assert np.abs(springs.vectors @ q).max() < 1e-15


@EVERY
@SENSES
def test_a_rigid_shift_elongates_nothing(kind: str, sense: int) -> None:
    springs = _floating(kind, sense)
    q = np.zeros(len(springs.coordinates))
    for place, name in enumerate(springs.coordinates):
        owner, coordinate = name.split(".")
        if owner.startswith("planet"):
            psi = springs.planar.angles[int(owner.split()[1]) - 1]
            q[place] = {"zeta": math.cos(psi), "eta": -math.sin(psi), "u": 0.0}[coordinate]
        else:
            q[place] = float(coordinate == "x")
    assert np.abs(springs.vectors @ q).max() < 1e-14


@EVERY
@SENSES
def test_rolling_by_the_basic_ratio_elongates_nothing(kind: str, sense: int) -> None:
    springs, train = _floating(kind, sense), TRAINS[kind]
    a, b = (member.radius for member in springs.planar.members[1:])
    mesh = train.meshes[0]
    planet = -mesh.central.gear.teeth / mesh.rim.gear.teeth
    q = _with(springs, a_u=a, b_u=b / train.basic_ratio, planet_u=planet * springs.planar.planet_radius)
    # u = r theta with the magnitude of a base radius.
    assert np.abs(springs.vectors @ q).max() < 1e-15 * 10


@EVERY
@SENSES
def test_elongations_are_those_of_involutes_after_small_displacements(kind: str, sense: int) -> None:
    springs = _floating(kind, sense)
    rng = np.random.default_rng(5)
    for _ in range(3):
        q = rng.uniform(-1, 1, len(springs.coordinates))
        step = 1e-7
        moved = [_elongations(TRAINS[kind], springs, sign * step * q, sense) for sign in (1, -1)]
        assert springs.vectors @ q == pytest.approx((moved[0] - moved[1]) / (2 * step), abs=1e-6)


def _elongations(train: PlanetaryTrain, springs: TrainSprings, q: Floats, sense: int) -> Floats:
    """Of bodies that stand where `q` puts them: flanks as involutes of base circles, pins as points of the carrier."""
    places = springs.basis @ q
    distance = float(train.centre_distance) / 1000
    result: list[float] = []
    bodies = {name: places[3 * i : 3 * i + 3] for i, name in enumerate(springs.members)}
    planets = []
    for n, psi in enumerate(springs.planar.angles):
        zeta, eta, u = places[9 + 3 * n : 12 + 3 * n]
        out = np.array([math.cos(psi), math.sin(psi)])
        along = np.array([-out[1], out[0]])
        planets.append(((distance + zeta) * out + eta * along, u / springs.planar.planet_radius))
    senses = [sense, sense if train.basic_ratio < 0 else -sense]
    for mesh, flank in zip(train.meshes, senses, strict=True):
        r = mesh.central_base_radius / 1000
        x, y, u = bodies[mesh.central.name]
        for psi, (centre, turn) in zip(springs.planar.angles, planets, strict=True):
            rest = distance * np.array([math.cos(psi), math.sin(psi)])
            approaches = [
                _overlap(psi, np.array(here[:2]), here[2], r, there, turned, mesh.rim_base_radius / 1000, mesh.external, flank)
                for here, there, turned in (((x, y, u / r), centre, turn), ((0.0, 0.0, 0.0), rest, 0.0))
            ]
            result.append(approaches[0] - approaches[1])
    x, y, u = bodies["carrier"]
    for psi, (centre, _) in zip(springs.planar.angles, planets, strict=True):
        angle = psi + u / distance
        pin = np.array([x, y]) + distance * np.array([math.cos(angle), math.sin(angle)])
        gap = pin - centre
        result += [gap @ [math.cos(psi), math.sin(psi)], gap @ [-math.sin(psi), math.cos(psi)]]
    return np.array(result)


def _overlap(
    psi: float, c1: Floats, turn1: float, r1: float, c2: Floats, turn2: float, r2: float, external: bool, flank: int
) -> float:
    """How far two involute flanks overlap on the common tangent of their base circles, but for a constant.

    A flank is where the string that unwinds from its base circle ends: its length grows as the gear turns with it.
    """
    between = c2 - c1
    apart = float(np.hypot(*between))
    off = np.array([math.cos(psi), math.sin(psi)]) @ between, np.array([-math.sin(psi), math.cos(psi)]) @ between
    direction = psi + math.atan2(off[1], off[0])
    alpha = math.acos((r1 + r2 if external else r1 - r2) / apart)
    tangent = direction - flank * alpha if external else direction + flank * alpha
    touch1 = c1 + r1 * np.array([math.cos(tangent), math.sin(tangent)])
    other = tangent + math.pi if external else tangent
    touch2 = c2 + r2 * np.array([math.cos(other), math.sin(other)])
    length = float(np.hypot(*(touch2 - touch1)))
    if external:
        return flank * (r1 * (turn1 - tangent) + r2 * (turn2 - tangent)) - length
    return flank * (r1 * (turn1 - tangent) - r2 * (turn2 - tangent)) + length


@EVERY
def test_the_torques_that_hold_a_train_at_rest_press_all_flanks(kind: str) -> None:
    """With the carrier turned by the sum of both, by T_b = -i0 T_a."""
    train = TRAINS[kind]
    springs = train_springs(on_springs(train, support=None, pin=None), STIFFNESS, held=("carrier",))
    i0 = train.basic_ratio
    load = 100 * (springs.turning("a") - i0 * springs.turning("b"))
    q = np.linalg.lstsq(springs.matrix(), load, rcond=1e-11)[0]
    forces = springs.stiffness * (springs.vectors @ q)
    assert springs.matrix() @ q == pytest.approx(load, rel=1e-9, abs=1e-12 * np.abs(load).max())
    for mesh, torque in zip(train.meshes, (100, 100 * i0), strict=True):
        expected = abs(torque) * 1000 / mesh.central_base_radius / train.planets
        assert forces[springs.select(SpringKind.MESH, mesh.name)] == pytest.approx(expected, rel=1e-9)


@EVERY
def test_what_is_held_is_the_limit_of_stiff_supports(kind: str) -> None:
    train = TRAINS[kind]
    exact = train_springs(on_springs(train, support=None, pin=None), STIFFNESS)
    stiff = train_springs(on_springs(train, support=1e9, pin=1e9), STIFFNESS)
    results = []
    for springs in (exact, stiff):
        load = 50 * springs.turning("a")
        held = springs.matrix() + 1e5 * np.outer(springs.turning("carrier"), springs.turning("carrier"))
        q = np.linalg.solve(held, load)
        results.append((springs.stiffness * (springs.vectors @ q))[: 2 * train.planets])
    assert results[0] == pytest.approx(results[1], rel=1e-5)


def test_only_what_can_move_has_coordinates() -> None:
    springs = train_springs(TRAINS["A"], STIFFNESS)
    assert springs.coordinates == ("carrier.u", "a.u", "planet 1.u", "planet 2.u", "planet 3.u")
    assert springs.names == ("a-rim1 1", "a-rim1 2", "a-rim1 3", "b-rim1 1", "b-rim1 2", "b-rim1 3")
    floating = train_springs(on_springs(TRAINS["A"], support=20.0, pin=200.0, torsion=1e4), STIFFNESS)
    assert len(floating.coordinates) == 18
    assert floating.names[6:] == (
        *(f"pin {n} {way}" for n in (1, 2, 3) for way in ("radial", "tangential")),
        *(f"{member} {way}" for member in ("carrier", "a", "b") for way in ("x", "y", "turning")),
    )
    radius = floating.planar.members[0].radius
    assert floating.stiffness[floating.select(SpringKind.TORSION, "carrier")] == pytest.approx(1e4 / radius**2)


def test_a_fixed_shaft_of_a_stage_holds_the_member_that_it_is_geared_to() -> None:
    train = TRAINS["D"]
    assert held_members(train) == ("b",)
    assert held_members(replace(train, fixed=None)) == ()
    pair = GearPair(pinion=replace(train.rims[0].gear, profile_shift=0.0), wheel=replace(train.rims[0].gear, profile_shift=0.0))
    staged = replace(
        train, fixed="motor", input="a", output="b", stages=(PairStage(name="pre", pair=pair, pinion="motor", wheel="carrier"),)
    )
    assert held_members(staged) == ("carrier",)


def test_what_is_no_stiffness_or_member_is_refused() -> None:
    train = TRAINS["A"]
    with pytest.raises(ParameterError, match=r"held = 'sun': must be one of a, b, carrier"):
        train_springs(train, STIFFNESS, held=("sun",))
    with pytest.raises(ParameterError, match="a number, or one for each of 3 planets"):
        train_springs(train, (np.ones(4), 1.0))
    with pytest.raises(ParameterError, match="must be above 0 N/µm"):
        train_springs(train, (400.0, 0.0))
