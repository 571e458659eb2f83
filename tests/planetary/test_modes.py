"""Natural modes and Campbell data of planetary trains: kinds of any set, closed forms, and what shakes which mode."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq
from support.planetary import thesis_train
from support.planetary_trains import MASSES, TRAINS, alm_set, lin_parker_train, masses_of, on_springs, pre_stage

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.dynamics.planetary.planar_model import (
    MemberMass,
    PlanarTrain,
    TrainMasses,
    springs_of,
    train_masses,
    train_springs,
)
from gearcad.dynamics.planetary.planetary_modes import (
    LineKind,
    ModeKind,
    PlanetaryCampbell,
    PlanetaryModes,
    mass_diagonal,
    modal_shares,
    planetary_campbell,
    planetary_modes,
)
from gearcad.planetary import Carrier, PlanetaryTrain
from gearcad.planetary.poses import train_harmonics
from gearcad.planetary.train_data import speeds

STIFFNESS = (400.0, 500.0)
ELASTIC = {"support": 60.0, "pin": 200.0, "torsion": 1e5}


def _families(modes: PlanetaryModes) -> dict[ModeKind, list[int]]:
    """Multiplicities of each kind, by rising frequency."""
    return {kind: [each.multiplicity for each in modes.families if each.kind is kind] for kind in ModeKind}


@pytest.mark.parametrize("kind", TRAINS)
@pytest.mark.parametrize("planets", range(2, 7))
def test_planets_at_equal_angles_have_the_modes_of_lin_and_parker(kind: str, planets: int) -> None:
    planar = train_springs(on_springs(TRAINS[kind], **ELASTIC), STIFFNESS).planar
    lines = tuple(replace(line, stiffness=np.full(planets, line.stiffness[0])) for line in planar.meshes)
    springs = springs_of(replace(planar, angles=0.4 + 2 * np.pi * np.arange(planets) / planets, meshes=lines))
    modes = planetary_modes(springs, MASSES)
    assert _families(modes) == {
        ModeKind.ROTATIONAL: [1] * 6,
        ModeKind.TRANSLATIONAL: [2] * 6 if planets > 2 else [1] * 9,
        ModeKind.PLANET: [planets - 3] * 3 if planets > 3 else [],
        ModeKind.MIXED: [],
    }
    assert modes.rigid == 0


@pytest.mark.parametrize("kind", TRAINS)
@pytest.mark.parametrize("pin", [200.0, None])
def test_modes_solve_the_equations_of_motion(kind: str, pin: float | None) -> None:
    """Those of a matrix put together otherwise, by another solver; energies are shared out."""
    springs = train_springs(on_springs(TRAINS[kind], support=60.0, pin=pin), STIFFNESS)
    modes = planetary_modes(springs, MASSES)
    mass = springs.basis.T @ np.diag(mass_diagonal(springs, MASSES)) @ springs.basis
    squares = eigh(springs.matrix(), mass, eigvals_only=True)
    assert modes.circular**2 == pytest.approx(squares, rel=1e-9, abs=1e-9 * squares.max())
    left = springs.matrix() @ modes.reduced.T - mass @ modes.reduced.T * modes.circular**2
    assert np.abs(left).max() < 1e-12 * np.abs(springs.matrix()).max() * np.abs(modes.reduced).max()
    assert modes.reduced @ mass @ modes.reduced.T == pytest.approx(np.eye(len(modes)), abs=1e-9)
    assert modes.kinetic.sum(axis=1) == pytest.approx(1.0)
    assert modes.potential[modes.rigid :].sum(axis=1) == pytest.approx(1.0)


@pytest.mark.parametrize("kind", TRAINS)
def test_planets_on_a_carrier_at_rest_between_two_rims(kind: str) -> None:
    """Everything stands but central a and the planets' turning: N - 1 planet modes, and two of a chain of two bodies."""
    train = TRAINS[kind]
    springs = train_springs(train, STIFFNESS, held=("carrier", "b"))
    modes = planetary_modes(springs, MASSES)
    a, b = train.meshes
    planet, central = MASSES.planet.inertia, MASSES.members["a"].inertia
    assert planet is not None and central is not None
    k_a, k_b = 400e6 * (a.rim_base_radius / 1000) ** 2, 500e6 * (b.rim_base_radius / 1000) ** 2
    alone = np.sqrt((k_a + k_b) / planet)
    count, ratio = train.planets, a.central_base_radius / a.rim_base_radius
    sign = 1 if a.external else -1
    chain = np.array([[k_a + k_b, sign * ratio * k_a], [sign * ratio * k_a, ratio**2 * k_a]]) * count
    together = np.sqrt(eigh(chain, np.diag([count * planet, central]), eigvals_only=True))
    assert modes.circular == pytest.approx(np.sort([*[alone] * (count - 1), *together]), rel=1e-12)
    assert sorted(_families(modes)[ModeKind.PLANET]) == [count - 1]
    assert _families(modes)[ModeKind.ROTATIONAL] == [1, 1]


@pytest.mark.parametrize("kind", TRAINS)
def test_what_nothing_holds_has_modes_of_no_frequency(kind: str) -> None:
    train = TRAINS[kind]
    free = planetary_modes(train_springs(on_springs(train, support=None, pin=200.0), STIFFNESS, held=()), MASSES)
    assert free.rigid == 2 and free.kinds[:2] == (ModeKind.ROTATIONAL,) * 2
    floating = planetary_modes(train_springs(on_springs(train, pin=200.0), STIFFNESS, held=()), MASSES)
    # Two meshes and two pins hold six ways of each pattern of planets: besides the train as a whole, centrals can shift.
    assert floating.rigid == 6
    assert sorted(kind.value for kind in floating.kinds[:6]) == ["rotational"] * 2 + ["translational"] * 4
    held = planetary_modes(train_springs(on_springs(train, **ELASTIC), STIFFNESS), MASSES)
    assert held.rigid == 0 and held.frequency[0] > 10


@pytest.mark.parametrize("kind", TRAINS)
def test_rigid_pins_and_supports_are_the_limit_of_stiff_ones(kind: str) -> None:
    exact = planetary_modes(train_springs(on_springs(TRAINS[kind], support=None, pin=None), STIFFNESS), MASSES)
    stiff = planetary_modes(train_springs(on_springs(TRAINS[kind], support=1e9, pin=1e9), STIFFNESS), MASSES)
    assert stiff.frequency[: len(exact)] == pytest.approx(exact.frequency, rel=1e-5, abs=1e-3)


def _crossing(stiffness: float) -> PlanetaryModes:
    springs = lin_parker_train(
        5,
        meshes=(3e8, 4.2e8),
        angles=(25.0, 21.0),
        supports={"c": 8e7, "r": 1.5e8, "s": 3e7},
        torsion={"c": stiffness, "r": 9e8, "s": 0.0},
        pin=1.2e8,
    )
    bodies = {
        "c": MemberMass(mass=3.2, inertia=3.9),
        "r": MemberMass(mass=2.1, inertia=2.6),
        "s": MemberMass(mass=0.5, inertia=0.45),
    }
    return planetary_modes(springs, TrainMasses(members=bodies, planet=MemberMass(mass=0.7, inertia=0.6)))


@pytest.mark.parametrize(("other", "place"), [(ModeKind.TRANSLATIONAL, 0), (ModeKind.PLANET, 0)])
@pytest.mark.parametrize("off", [0.0, 1e-12, 1e-9, 1e-7, 1e-5])
def test_kinds_are_known_where_frequencies_meet(other: ModeKind, place: int, off: float) -> None:
    """A rotational mode is led onto a translational pair, and onto a pair of planet modes."""

    def gap(stiffness: float) -> float:
        modes = _crossing(stiffness)
        place_r = 0 if other is ModeKind.TRANSLATIONAL else 1
        mine = [family.frequency for family in modes.families if family.kind is ModeKind.ROTATIONAL][place_r]
        return mine - [family.frequency for family in modes.families if family.kind is other][place]

    met = brentq(gap, 1e6, 3e9, xtol=1e-6, rtol=1e-15)
    modes = _crossing(met * (1 + off))
    assert _families(modes) == {
        ModeKind.ROTATIONAL: [1] * 6,
        ModeKind.TRANSLATIONAL: [2] * 6,
        ModeKind.PLANET: [2] * 3,
        ModeKind.MIXED: [],
    }


@pytest.mark.parametrize("factor", [1e-6, 1e6, 1e9])
@pytest.mark.parametrize("body", ["carrier", "a", "planet"])
def test_kinds_do_not_depend_on_how_heavy_a_body_is(body: str, factor: float) -> None:
    springs = train_springs(on_springs(TRAINS["A helical"], **ELASTIC), STIFFNESS)
    members = {name: _times(each, factor if name == body else 1.0) for name, each in MASSES.members.items()}
    planet = _times(MASSES.planet, factor if body == "planet" else 1.0)
    modes = planetary_modes(springs, TrainMasses(members=members, planet=planet))
    found = _families(modes)
    assert found[ModeKind.ROTATIONAL] == [1] * 6 and found[ModeKind.TRANSLATIONAL] == [2] * 6
    assert found[ModeKind.PLANET] == [1] * 3


def _times(body: MemberMass, factor: float) -> MemberMass:
    assert body.mass and body.inertia
    return MemberMass(mass=body.mass * factor, inertia=body.inertia * factor)


def test_shapes_are_those_of_their_kind() -> None:
    modes = planetary_modes(train_springs(on_springs(TRAINS["B"], **ELASTIC), STIFFNESS), MASSES)
    scale = np.abs(modes.shape).max(axis=(1, 2), keepdims=True)
    shape = modes.shape / scale
    rotational, translational, planet = (modes.of_kind(kind) for kind in list(ModeKind)[:3])
    assert np.abs(shape[rotational][:, :3, :2]).max() < 1e-9
    assert np.ptp(shape[rotational][:, 3:], axis=1).max() < 1e-9
    assert np.abs(shape[translational][:, :3, 2]).max() < 1e-9
    assert np.abs(shape[planet][:, :3]).max() < 1e-9
    assert np.abs(shape[planet][:, 3:].sum(axis=1)).max() < 1e-9
    for first, second in translational.reshape(-1, 2):
        # Along x, then along y, and the second is the first turned by a quarter.
        leading = int(np.abs(modes.shape[first, :3, 0]).argmax())
        assert modes.shape[first, leading, 1] == pytest.approx(0.0, abs=1e-9)
        assert modes.shape[second, leading, :2] == pytest.approx([0.0, modes.shape[first, leading, 0]], abs=1e-9)


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ("angles", "the planets are not at equal angles"),
        ("stiffness", "the planets are not alike in the stiffness of a-rim1"),
        ("one", "there is one planet only"),
    ],
)
def test_modes_without_a_kind_say_why(changed: str, why: str) -> None:
    planar = train_springs(on_springs(TRAINS["A"], **ELASTIC), STIFFNESS).planar
    modes = planetary_modes(springs_of(_changed(planar, changed)), MASSES)
    mixed = len(modes.of_kind(ModeKind.MIXED))
    assert mixed >= 9
    assert modes.notices[0].code == "modes-mixed"
    assert modes.notices[0].text == f"{mixed} of {len(modes)} modes are of no kind: {why}"


def _changed(planar: PlanarTrain, changed: str) -> PlanarTrain:
    if changed == "angles":
        return replace(planar, angles=planar.angles + np.array([0.0, 0.1, 0.0]))
    if changed == "one":
        first, second = (replace(line, stiffness=line.stiffness[:1]) for line in planar.meshes)
        return replace(planar, angles=planar.angles[:1], meshes=(first, second))
    first, second = planar.meshes
    return replace(planar, meshes=(replace(first, stiffness=first.stiffness * np.array([1.0, 1.2, 1.0])), second))


def test_two_pairs_of_opposite_planets_keep_rotational_and_translational_modes() -> None:
    """As Lin and Parker (2000) found."""
    planar = train_springs(on_springs(TRAINS["A helical"], **ELASTIC), STIFFNESS).planar
    modes = planetary_modes(springs_of(replace(planar, angles=np.array([0.0, 1.3, np.pi, 1.3 + np.pi]))), MASSES)
    assert _families(modes) == {
        ModeKind.ROTATIONAL: [1] * 6,
        ModeKind.TRANSLATIONAL: [1] * 12,
        ModeKind.PLANET: [1] * 3,
        ModeKind.MIXED: [],
    }


def test_what_moves_has_a_mass() -> None:
    springs = train_springs(on_springs(TRAINS["A"], pin=200.0), STIFFNESS)
    none = TrainMasses(members={**MASSES.members, "carrier": MemberMass(mass=None, inertia=None)}, planet=MASSES.planet)
    with pytest.raises(ParameterError, match=r"carrier.mass is missing: must be given in kg"):
        planetary_modes(springs, none)
    still = train_springs(TRAINS["A"], STIFFNESS, held=("carrier",))
    assert len(planetary_modes(still, none)) == 5
    bad = replace(MASSES, planet=MemberMass(mass=0.7, inertia=0.0))
    with pytest.raises(ParameterError, match=r"planet.inertia = 0 kg·m²: must be a number above 0"):
        planetary_modes(springs, bad)


RULE = {
    "24/3": "RRRRRR",
    "25/3": "TTRTTR",
    "26/3": "TTRTTR",
    "24/4": "RRRRRR",
    "25/4": "TPTRTP",
    "26/4": "PRPRPR",
    "27/4": "TPTRTP",
    "24/5": "TPPTRT",
    "27/5": "PTTPRP",
    "28/6": "PPRPPR",
    "27/6": "PRPRPR",
}
"""Teeth of a central and planets: kinds that the harmonics 1 to 6 of its meshes excite, by k = m z mod N."""


@pytest.mark.parametrize("case", RULE)
@pytest.mark.parametrize("sign", [1, -1])
def test_forces_on_modes_follow_the_rule_of_phases(case: str, sign: int) -> None:
    """Found with the modes themselves, which know nothing of the rule."""
    teeth, planets = (int(each) for each in case.split("/"))
    springs = lin_parker_train(
        planets,
        meshes=(3e8, 4.2e8),
        angles=(25.0, 21.0),
        supports={"c": 8e7, "r": 1.5e8, "s": 3e7},
        torsion={"c": 5e7, "r": 9e8, "s": 0.0},
        pin=1.2e8,
    )
    modes = planetary_modes(springs, masses_of((0.7, 0.6), c=(3.2, 3.9), r=(2.1, 2.6), s=(0.5, 0.45)))
    ahead = sign * teeth * np.arange(planets) / planets + 0.37
    for harmonic, expected in enumerate(RULE[case], 1):
        for mesh in ("s-p", "r-p"):
            shares = modal_shares(modes, mesh, ahead, harmonic)
            found = {family.kind for family, share in zip(modes.families, shares, strict=True) if share}
            kind = {"R": ModeKind.ROTATIONAL, "T": ModeKind.TRANSLATIONAL, "P": ModeKind.PLANET}[expected]
            assert found == {kind} or (planets == 3 and kind is ModeKind.PLANET and not found)
            assert shares.max() <= 1 + 1e-12
            if kind is ModeKind.ROTATIONAL:
                assert shares[shares > 0] == pytest.approx(1.0)


def _campbell(train: PlanetaryTrain, highest: float, **given: object) -> PlanetaryCampbell:
    modes = planetary_modes(train_springs(train, STIFFNESS), MASSES)
    return planetary_campbell(train, modes, train.phases, highest, **given)  # type: ignore[arg-type]


def test_frequencies_of_a_sun_planet_ring_train() -> None:
    """Sun in, ring fixed: n_c = n_s z_s/(z_s + |z_r|)."""
    train = on_springs(TRAINS["A"], support=60.0, pin=200.0)
    campbell = _campbell(train, 20_000.0, harmonics=3)
    carrier = Fraction(24, 90)
    mesh, planet = float(66 * carrier / 60), float(Fraction(66, 21) * carrier / 60)
    assert [(line.name, line.kind) for line in campbell.lines] == [
        ("a-rim1", LineKind.MESH),
        ("2 x a-rim1", LineKind.MESH),
        ("3 x a-rim1", LineKind.MESH),
        ("b-rim1", LineKind.MESH),
        ("2 x b-rim1", LineKind.MESH),
        ("3 x b-rim1", LineKind.MESH),
        ("planets past a", LineKind.PASS),
        ("planets past b", LineKind.PASS),
        ("planet on its pin", LineKind.TURN),
    ]
    passing = [float(3 * (1 - carrier) / 60), float(3 * carrier / 60)]
    expected = [*(m * mesh for m in (1, 2, 3, 1, 2, 3)), *passing, planet]
    assert [line.per_rpm for line in campbell.lines] == pytest.approx(expected, rel=1e-12)


def test_resonances_are_where_lines_meet_modes() -> None:
    campbell = _campbell(on_springs(TRAINS["B"], support=60.0, pin=200.0), 20_000.0)
    assert [each.speed for each in campbell.resonances] == sorted(each.speed for each in campbell.resonances)
    for each in campbell.resonances:
        line, family = campbell.lines[each.line], campbell.families[each.family]
        assert line.per_rpm * each.speed == pytest.approx(family.frequency) == pytest.approx(each.frequency)
        assert 0 < each.speed <= 20_000
        if line.kind is LineKind.MESH:
            assert each.excited == (campbell.shares[each.line, each.family] > 0)
        else:
            assert each.excited is None
    met = sum(0 < family.frequency / line.per_rpm <= 20_000 for line in campbell.lines for family in campbell.families)
    assert len(campbell.resonances) == met > len(campbell.excited) > 0
    # 24 teeth and four planets: all in phase; 74 teeth: each against the next.
    assert campbell.kinds_excited("a-rim1", 1) == (ModeKind.ROTATIONAL,)
    assert campbell.kinds_excited("b-rim2", 1) == (ModeKind.PLANET,)
    assert campbell.kinds_excited("b-rim2", 2) == (ModeKind.ROTATIONAL,)
    plain = campbell.to_dict()
    assert plain["lines"][0]["name"] == "a-rim1" and plain["shares"][-1][0] is None


def test_a_load_near_a_resonance_is_told() -> None:
    train = on_springs(TRAINS["B"], support=60.0, pin=200.0)
    met = _campbell(train, 20_000.0).excited[0]
    for share, told in ((1.0, True), (0.951, True), (1.049, True), (0.949, False), (1.051, False)):
        # Whether the speed is drawn or not, and whichever way the input turns.
        for highest, sense in ((20_000.0, 1), (100.0, -1)):
            campbell = _campbell(train, highest, speed=sense * share * met.speed)
            assert campbell.speed == pytest.approx(share * met.speed)
            assert all(each.excited and abs(campbell.speed / each.speed - 1) <= 0.05 for each in campbell.near)
            found = [each for each in campbell.near if (each.line, each.family) == (met.line, met.family)]
            assert bool(found) == told
            words = [notice.text for notice in campbell.notices if f"{met.speed:.5g} rpm" in notice.text]
            assert bool(words) == told
            assert not told or campbell.lines[met.line].name in words[0]
    # Beside one at which the planets take each other off nothing is told of it.
    idle = next(each for each in _campbell(train, 20_000.0).resonances if each.excited is False)
    near = _campbell(train, 20_000.0, speed=idle.speed).near
    assert (idle.line, idle.family) not in {(each.line, each.family) for each in near}
    assert not _campbell(train, 20_000.0).notices and not _campbell(train, 20_000.0, speed=0.0).near


def test_unequal_planets_are_excited_by_their_own_phases() -> None:
    """At angles where teeth let them stand the sums do not vanish."""
    train = on_springs(TRAINS["A"], support=60.0, pin=200.0)
    modes = planetary_modes(train_springs(train, STIFFNESS), MASSES)
    even, uneven = np.array([0.0, 1 / 3, 2 / 3]), np.array([0.0, 0.3, 2 / 3])
    rotational = [place for place, family in enumerate(modes.families) if family.kind is ModeKind.ROTATIONAL][1:]
    assert not modal_shares(modes, "a-rim1", even, 1)[rotational].any()
    expected = abs(np.exp(2j * np.pi * uneven).sum()) / 3
    assert modal_shares(modes, "a-rim1", uneven, 1)[rotational] == pytest.approx(expected)


@pytest.mark.parametrize("kind", TRAINS)
def test_sums_over_phases_say_the_same_as_the_modes(kind: str) -> None:
    """Torque and force of a harmonic on the members, which know of no modes."""
    train = on_springs(TRAINS[kind], support=60.0, pin=200.0)
    modes = planetary_modes(train_springs(train, STIFFNESS), MASSES)
    campbell = planetary_campbell(train, modes, train.phases, 1000.0)
    for name, sums in train_harmonics(train).items():
        for each in sums:
            kinds = campbell.kinds_excited(name, each.harmonic)
            assert each.excited == (ModeKind.ROTATIONAL in kinds, ModeKind.TRANSLATIONAL in kinds)


def test_stages_and_stepped_planets_have_lines_of_their_own() -> None:
    """The train of the Alm thesis: 18 teeth on the shaft that drives, and rims of 22 and 21."""
    train = thesis_train()
    masses = masses_of((0.7, 3e-4), carrier=(3.2, 6e-3), ring_4=(2.0, 9e-3), ring_5=(2.1, 9e-3))
    modes = planetary_modes(train_springs(train, STIFFNESS), masses)
    campbell = planetary_campbell(train, modes, train.phases, 3000.0, harmonics=1)
    found = {line.name: line.per_rpm for line in campbell.lines}
    carrier = Fraction(18, 161)
    assert found["stage"] == pytest.approx(18 / 60)
    assert found["ring_4-rim_3"] == pytest.approx(float(70 * carrier / 60))
    assert found["ring_5-rim_3p"] == pytest.approx(float(70 * Fraction(21, 22) * carrier / 60))
    # Everything is held in place but the turning: what would travel is a matter of the planets alone.
    assert campbell.kinds_excited("ring_4-rim_3", 1) == (ModeKind.PLANET,)
    assert campbell.kinds_excited("ring_5-rim_3p", 1) == (ModeKind.ROTATIONAL,)


def test_a_differential_needs_its_second_speed() -> None:
    train = replace(on_springs(TRAINS["A"], support=60.0, pin=200.0), fixed=None)
    with pytest.raises(ParameterError, match="must have one more"):
        _campbell(train, 3000.0)
    campbell = _campbell(train, 3000.0, given_speeds={"b": -1000.0}, harmonics=1)
    carrier = (24 * 3000 - 66 * 1000) / 90
    assert campbell.lines[0].per_rpm == pytest.approx(24 * (3000 - carrier) / 60 / 3000)
    with pytest.raises(GeometryError, match="nothing meshes"):
        _campbell(train, 3000.0, given_speeds={"b": 3000.0})


def test_inertias_of_stages_count_at_their_ratios() -> None:
    """Kinetic energy by the exact speeds of all shafts is that of the members with what the stages add."""
    train = alm_set(stages=(replace(pre_stage(), pinion_inertia=2e-5, wheel_inertia=3e-3),), input="pinion_1")
    carrier = Carrier(mass=3.0, inertia=5e-3)
    plain = train_masses(replace(train, carrier=carrier, stages=(pre_stage(),))).members
    found = train_masses(replace(train, carrier=carrier)).members
    turning = speeds(train, {"pinion_1": 1000.0}).members["carrier"]
    energy = 5e-3 * turning**2 + 3e-3 * turning**2 + 2e-5 * 1000.0**2
    assert found["carrier"].inertia == pytest.approx(energy / turning**2, rel=1e-12)
    assert found["carrier"].mass == plain["carrier"].mass == 3.0 and plain["carrier"].inertia == 5e-3
    assert found["ring_5"].inertia == plain["ring_5"].inertia
