"""Vibration of planetary trains: against time integration, at rest, at the least and the greatest speeds, and by symmetry."""

from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np
import pytest
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from support.planetary import simple_train
from support.planetary_trains import MASSES, TRAINS, masses_of, on_springs

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Complexes, Floats
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.planetary.planar_model import SpringKind, TrainSprings, train_springs
from gearcad.dynamics.planetary.planetary_excitation import planetary_excitation, planetary_system, train_stiffness
from gearcad.dynamics.planetary.planetary_modes import ModeKind, mass_diagonal, planetary_modes
from gearcad.dynamics.planetary.planetary_response import PlanetaryResponse, fold, planetary_response, planets_alike
from gearcad.dynamics.planetary.quasi_static_run import run_train
from gearcad.dynamics.response.linear_response import periodic_response
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.response.speed_curves import settled
from gearcad.dynamics.trains.mesh_excitation import CosineStiffness, Excitation, MeshExcitation
from gearcad.dynamics.trains.steady_response import static_state
from gearcad.dynamics.trains.tooth_deviations import TransmissionError
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.poses import mesh_phases
from gearcad.planetary.power import mesh_loads, power_flow

STIFFNESS = (400.0, 500.0)
ELASTIC = {"support": 60.0, "pin": 200.0}


def _torques(train: PlanetaryTrain, torque: float = 100.0) -> dict[str, float]:
    """On the members (N·m), without losses."""
    a, b, carrier = train.members
    i0 = train.basic_ratio
    return {a: torque, b: -i0 * torque, carrier: (i0 - 1) * torque}


def _waves(train: PlanetaryTrain, variation: float = 0.2, error: float = 0.0) -> Excitation:
    """Cosine waves of stiffness and errors (µm) at phases of their own on each mesh."""
    size, phase, teeth, errors = _numbers(train, variation, error)
    first = train.meshes[0].rim.gear.teeth
    return Excitation(
        meshes=tuple(
            MeshExcitation(
                stiffness=CosineStiffness(variation=each),
                phase=np.degrees(lead),
                frequency_ratio=Fraction(int(count), first),
                error=TransmissionError(coefficients=np.array([0.3, wave])) if error else None,
            )
            for each, lead, count, wave in zip(size, phase, teeth, errors, strict=True)
        )
    )


def _numbers(train: PlanetaryTrain, variation: float, error: float) -> tuple[Floats, Floats, Floats, Complexes]:
    """Of each mesh the size of its waves, its phase (rad), the teeth of its rim, and half the complex error (µm)."""
    count = train.planets
    size = np.repeat([variation, variation / 2], count)
    phase = np.radians([37.0 * n + 80.0 * place for place in (0, 1) for n in range(count)])
    teeth = np.repeat([float(mesh.rim.gear.teeth) for mesh in train.meshes], count)
    return size, phase, teeth, np.full(2 * count, error * (0.4 + 0.3j))


# ---------------------------------------------------------------------- the system


@pytest.mark.parametrize("kind", TRAINS)
@pytest.mark.parametrize("pin", [200.0, None])
def test_the_system_has_the_modes_of_the_train(kind: str, pin: float | None) -> None:
    springs = train_springs(on_springs(TRAINS[kind], support=60.0, pin=pin, torsion=None), STIFFNESS)
    system = planetary_system(springs, MASSES, {})
    squares = np.linalg.eigvalsh(system.stiffness_matrix())
    assert squares == pytest.approx(planetary_modes(springs, MASSES).circular ** 2, rel=1e-9, abs=1e-9 * squares.max())


@pytest.mark.parametrize("kind", TRAINS)
@pytest.mark.parametrize("torsion", [None, 1e3])
@pytest.mark.parametrize("sense", [1, -1])
def test_at_rest_every_planet_carries_its_share(kind: str, torsion: float | None, sense: int) -> None:
    """Whatever holds the turning of members that are driven: it gives way until it carries their torques."""
    train = on_springs(TRAINS[kind], **ELASTIC, torsion=torsion)
    springs = train_springs(train, STIFFNESS, sense=sense)
    system = planetary_system(springs, MASSES, _torques(train, 100.0 * sense), driven=("a", "carrier"))
    static = static_state(system)
    shares = [
        abs(_torques(train)[mesh.central.name]) * 1000 / mesh.central_base_radius / train.planets
        for mesh in train.meshes
        for _ in range(train.planets)
    ]
    assert system.stiffness * static.approach == pytest.approx(shares, rel=1e-8)


def test_torques_that_do_not_balance_are_refused() -> None:
    springs = train_springs(on_springs(TRAINS["A"], **ELASTIC), STIFFNESS)
    system = planetary_system(springs, MASSES, {"a": 100.0, "carrier": -300.0})
    with pytest.raises(GeometryError, match="must balance"):
        static_state(replace(system, load=system.load + system.inertias[:, 0]))


# ---------------------------------------------------------------------- witnesses of the response


@pytest.mark.parametrize(("kind", "frequency"), [("A", 9000.0), ("A", 15_000.0), ("B", 20_000.0), ("D", 12_000.0)])
def test_against_integration_of_the_equations_of_motion(kind: str, frequency: float) -> None:
    """In the coordinates of the springs, with damping of modes that another solver finds."""
    train = on_springs(TRAINS[kind], **ELASTIC)
    springs = train_springs(train, STIFFNESS)
    excitation, ratio = _waves(train, error=1.0), 0.15
    system = planetary_system(springs, MASSES, _torques(train), damping_ratio=ratio)
    response = periodic_response(system, excitation, [frequency], harmonics=6, stability=False)
    period, count = 2 * np.pi / (excitation.fundamental * frequency), 1024
    approach = response.approach(count=count)[0]
    periods = int(np.ceil(0.02 / period))
    found = _integrated(springs, train, ratio, frequency, period * (periods + np.arange(count) / count))
    assert found == pytest.approx(approach, abs=2e-3 * np.ptp(approach, axis=0).max())
    assert np.ptp(approach, axis=0).max() > 0.1 * np.abs(approach).mean()


def _integrated(springs: TrainSprings, train: PlanetaryTrain, ratio: float, frequency: float, times: Floats) -> Floats:
    """Approaches (t, m) at late times."""
    mass = springs.basis.T @ np.diag(mass_diagonal(springs, MASSES)) @ springs.basis
    meshes = springs.select(SpringKind.MESH)
    others = np.setdiff1d(np.arange(len(springs.names)), meshes)
    lines = (springs.vectors[others].T * springs.stiffness[others]) @ springs.vectors[others]
    squares, modes = eigh(lines, mass)
    push = mass @ modes
    damping = (push * (2 * ratio * np.sqrt(np.maximum(squares, 0)))) @ push.T
    vectors, k = springs.vectors[meshes], springs.stiffness[meshes]
    c = 2 * ratio * np.sqrt(k * _light(train))
    load = sum(torque * springs.turning(name) for name, torque in _torques(train).items())
    inverse, size = np.linalg.inv(mass), len(mass)
    variation, phase, teeth, errors = _numbers(train, 0.2, 1e-6)
    rates = frequency * teeth / teeth[0]

    def motion(time: float, state: Floats) -> Floats:
        theta = rates * time + phase
        wave = 2 * errors * np.exp(1j * theta)
        gap = vectors @ state[:size] - 0.3e-6 - wave.real
        rate = vectors @ state[size:] + rates * wave.imag
        force = k * (1 - variation * np.cos(theta)) * gap + c * rate
        pull = load - lines @ state[:size] - damping @ state[size:] - vectors.T @ force
        return np.concatenate([state[size:], inverse @ pull])

    rest = np.linalg.lstsq(springs.matrix(), load, rcond=1e-11)[0]
    start = np.concatenate([rest, np.zeros(size)])
    solved = solve_ivp(motion, (0, times[-1]), start, "DOP853", t_eval=times, rtol=1e-6, atol=1e-11)
    return np.asarray(solved.y[:size].T @ vectors.T, float)


def _light(train: PlanetaryTrain) -> Floats:
    """Mass (m,) of turning central and planet along the line of action, nothing else moving."""
    result: list[float] = []
    for mesh in train.meshes:
        planet, central = MASSES.planet.inertia, MASSES.members[mesh.central.name].inertia
        assert planet and central
        moved = (mesh.rim_base_radius / 1000) ** 2 / planet
        moved += 0.0 if mesh.central.name == train.fixed else (mesh.central_base_radius / 1000) ** 2 / central
        result += [1 / moved] * train.planets
    return np.array(result)


@pytest.mark.parametrize("kind", TRAINS)
def test_towards_standstill_it_is_the_train_at_rest_in_every_position(kind: str) -> None:
    train = on_springs(TRAINS[kind], **ELASTIC)
    springs, excitation = train_springs(train, STIFFNESS), _waves(train, error=1.0)
    system = planetary_system(springs, MASSES, _torques(train), damping_ratio=0.1)
    slow = periodic_response(system, excitation, [5.0], harmonics=10, stability=False)
    meshes = springs.select(SpringKind.MESH)
    load = sum(torque * springs.turning(name) for name, torque in _torques(train).items())
    for phase, found in list(zip(slow.phases(), slow.approach()[0], strict=True))[::61]:
        k = springs.stiffness.copy()
        k[meshes] *= excitation.ratios(np.array(phase))
        right = load + springs.vectors[meshes].T @ (k[meshes] * excitation.errors(np.array(phase)))
        q = np.linalg.lstsq(springs.matrix(k), right, rcond=1e-11)[0]
        assert found == pytest.approx(springs.vectors[meshes] @ q, abs=2e-5 * np.abs(found).max())


@dataclass(frozen=True)
class _Course:
    """A cosine wave of stiffness (N/µm) over base pitches past the pitch point."""

    mean: float
    jumps: Floats = field(default_factory=lambda: np.zeros(0))

    def stiffness_at(self, ahead: ArrayLike) -> Floats:
        return np.asarray(self.mean * (1 - 0.2 * np.cos(2 * np.pi * np.asarray(ahead))), float)


@pytest.mark.parametrize("teeth", [(22, 20, -62), (20, 28, -76)])
def test_towards_standstill_it_is_the_train_as_it_runs_without_masses(teeth: tuple[int, int, int]) -> None:
    """By another solver, of forces, with planets in phase and not."""
    shifts = {22: (0.4, 0.3, -1.0), 20: (0.3, 0.3, -0.9)}[teeth[0]]
    train = on_springs(simple_train(teeth, shifts, 4), **ELASTIC)
    load = TrainLoad(torque=300.0, speed=1500.0)
    courses = {mesh.name: _Course(mean) for mesh, mean in zip(train.meshes, STIFFNESS, strict=True)}
    run = run_train(train, load, courses)
    waves = tuple(
        MeshExcitation(stiffness=CosineStiffness(variation=0.2), phase=360 * ahead)
        for mesh in train.meshes
        for ahead in mesh_phases(train)[mesh.name].ahead
    )
    masses = masses_of((0.7, 3e-4), carrier=(3.2, 6e-3), sun=(0.5, 4e-4), ring=(2.1, 9e-3))
    torques = power_flow(train, load).set_torques
    system = planetary_system(train_springs(train, STIFFNESS), masses, torques)
    k = Excitation(meshes=waves).ratios(2 * np.pi * run.rolled) * system.stiffness
    forces = k * settled(system, static_state(system), k, np.zeros_like(k))
    found = np.concatenate([run.forces[mesh.name] for mesh in train.meshes]).T
    assert forces == pytest.approx(found, rel=1e-6)
    assert (np.ptp(forces[:, 0]) > 0.005 * forces.mean()) == (teeth[0] == 22)


def test_at_the_greatest_speeds_only_the_stiffness_of_the_teeth_changes_their_load() -> None:
    """Nothing can follow: flanks keep the approach at which the mean of their forces is that at rest."""
    train = on_springs(TRAINS["A"], **ELASTIC)
    springs = train_springs(train, STIFFNESS)
    system = planetary_system(springs, MASSES, _torques(train), damping_ratio=1e-4)
    fast = 1000 * float(planetary_modes(springs, MASSES).circular[-1])
    response = periodic_response(system, _waves(train), [fast], harmonics=4, stability=False)
    factors = response.spring_forces().max(axis=1)[0] / (system.stiffness * response.static.approach)
    assert factors == pytest.approx([1.2] * 3 + [1.1] * 3, rel=1e-4)


@pytest.mark.parametrize("teeth", [(22, 20, -62), (20, 28, -76)])
def test_planets_one_after_the_other_carry_the_same_a_little_later(teeth: tuple[int, int, int]) -> None:
    """Out of phase and in phase; four planets, all with the phases of their teeth."""
    shifts = {22: (0.4, 0.3, -1.0), 20: (0.3, 0.3, -0.9)}[teeth[0]]
    train = on_springs(simple_train(teeth, shifts, 4), **ELASTIC)
    waves = [
        MeshExcitation(stiffness=CosineStiffness(variation=0.2), phase=360 * ahead)
        for mesh in train.meshes
        for ahead in train.phases[mesh.name].ahead
    ]
    masses = masses_of((0.7, 3e-4), carrier=(3.2, 6e-3), sun=(0.5, 4e-4), ring=(2.1, 9e-3))
    torques = dict(zip(("sun", "ring", "carrier"), _torques_of(train), strict=True))
    system = planetary_system(train_springs(train, STIFFNESS), masses, torques, damping_ratio=0.05)
    speeds = np.linspace(1000, 60_000, 97)
    response = periodic_response(system, Excitation(meshes=tuple(waves)), speeds, harmonics=5, stability=False)
    amplitudes = np.abs(response.approach_coefficients)
    assert amplitudes[:, :, :4] == pytest.approx(np.repeat(amplitudes[:, :, :1], 4, axis=2), rel=1e-7, abs=1e-13)
    assert amplitudes[:, :, 4:] == pytest.approx(np.repeat(amplitudes[:, :, 4:5], 4, axis=2), rel=1e-7, abs=1e-13)
    # Only waves that come to all planets at once turn the members.
    turning = np.abs(response.inertia_coefficients[:, 1:, 0]).max(axis=0)
    together = np.array([m * teeth[0] % 4 == 0 for m in range(1, 6)])
    assert (turning[together] > 1e6 * turning[~together].max(initial=1e-18)).all()


def _torques_of(train: PlanetaryTrain) -> tuple[float, float, float]:
    i0 = train.basic_ratio
    return 100.0, -100.0 * i0, 100.0 * (i0 - 1)


def test_narrow_resonances_show_between_speeds_far_apart() -> None:
    """Forty speeds and a damping ratio of 0.002, against a thousand about the greatest resonance."""
    train = on_springs(TRAINS["A"], **ELASTIC)
    system = planetary_system(train_springs(train, STIFFNESS), MASSES, _torques(train), damping_ratio=0.002)
    excitation = _waves(train, variation=0.02)
    chart = over_speed(system, excitation, np.linspace(5_000, 60_000, 40)).up
    place = int(chart.factors[:, 0].argmax())
    near = chart.frequencies[place] * np.linspace(0.99, 1.01, 1001)
    found = periodic_response(system, excitation, near, harmonics=5, stability=False)
    most = (found.senses * found.spring_forces()).max(axis=1) / (system.stiffness * found.static.approach)
    assert chart.factors[:, 0].max() == pytest.approx(most[:, 0].max(), rel=0.01)
    assert chart.factors[:, 0].max() > 1.3


# ---------------------------------------------------------------------- a train with its real teeth


def _run(train: PlanetaryTrain, load: TrainLoad, **options: float | int) -> PlanetaryResponse:
    stiffness = train_stiffness(train, mesh_loads(train, power_flow(train, load)), method="strain-energy", positions=24)
    return planetary_response(train, load, stiffness, MASSES, DynamicsOptions(speeds=12, **options))  # type: ignore[arg-type]


LOAD = TrainLoad(torque=300.0, speed=1500.0, mesh_efficiency=0.98, application_factor=1.25)


def test_where_shares_are_determinate_flanks_yield_by_the_transmission_error_of_their_pair() -> None:
    """Three planets, everything floating: each mesh carries its share, so its cycle tells all."""
    train = on_springs(TRAINS["A"], pin=200.0)
    loads = mesh_loads(train, power_flow(train, replace(LOAD, mesh_efficiency=1.0)))
    stiffness = train_stiffness(train, loads, method="strain-energy", positions=24)
    springs = train_springs(train, (stiffness["a-rim1"].tangent_mean, stiffness["b-rim1"].tangent_mean))
    system = planetary_system(springs, MASSES, _torques(train, 300 * 1.25 / (1 + 66 / 24)))
    forces = {name: each.normal_force * 1.25 for name, each in loads.items()}
    phases = mesh_phases(train)
    excitation = planetary_excitation(train, stiffness, phases, forces)
    for place, name in enumerate(stiffness):
        own, ahead = stiffness[name], np.array(phases[name].ahead)
        inner = np.flatnonzero((np.diff(own.ahead)[:-1] > 0) & (np.diff(own.ahead)[1:] > 0))[::3] + 1  # not where it jumps
        turned = own.ahead[inner]
        theta = 2 * np.pi * (turned[:, None] - ahead)
        for n in range(3):
            courses = excitation.ratios(theta[:, n]) * system.stiffness, excitation.errors(theta[:, n])
            found = settled(system, static_state(system), *courses)[:, 3 * place + n]
            assert 1e6 * found == pytest.approx(own.transmission_error[inner], rel=1e-9)


def test_a_train_over_speed() -> None:
    train = on_springs(TRAINS["A"], **ELASTIC)
    found = _run(train, LOAD, speed_from=3000.0, speed_to=12_000.0)
    assert found.speeds[0] == pytest.approx(3000.0) and found.speeds[-1] == pytest.approx(12_000.0)
    assert found.tooth_frequency == pytest.approx(24 * (1 - 24 / 90) / 60)
    assert {name: values.shape for name, values in found.factors.items()} == {
        "a-rim1": (len(found.speeds), 3),
        "b-rim1": (len(found.speeds), 3),
    }
    share = 300 * 1.25 / (1 + 66 / 24) * 1000 / train.meshes[0].central_base_radius / 3
    assert found.alike == 3
    assert found.up.static_forces == pytest.approx([share] * 6, rel=1e-9)
    assert "turning-axes" in [notice.code for notice in found.notices]
    ratios = found.damping_ratios
    assert np.isnan(ratios[0]) and 0.03 < ratios[1:].min() <= ratios[1:].max() < 0.2
    one = found.at(9000.0)
    force = (one.senses * one.spring_forces()).max(axis=1)[0] / share
    beside = [np.interp(9000.0, found.speeds, column) for column in found.up.factors.T]
    assert force == pytest.approx(beside, rel=0.02)
    plain = found.to_dict()
    assert plain["greatest"]["factor"] == pytest.approx(found.up.factors.max())
    assert len(plain["load_factor"]["a-rim1"]) == 3


# ---------------------------------------------------------------------- planets taken for one


@pytest.mark.parametrize(
    ("teeth", "planets", "alike"), [((24, 21, -66), 3, 3), ((22, 20, -62), 4, 2), ((22, 20, -62), 3, 1), ((20, 28, -76), 4, 4)]
)
def test_planets_in_phase_are_taken_for_one(teeth: tuple[int, int, int], planets: int, alike: int) -> None:
    """With the result of all of them, one by one."""
    shifts = {24: (0.3, 0.2, -0.7), 22: (0.4, 0.3, -1.0), 20: (0.3, 0.3, -0.9)}[teeth[0]]
    train = on_springs(simple_train(teeth, shifts, planets), **ELASTIC)
    springs, masses = (
        train_springs(train, STIFFNESS),
        masses_of((0.7, 3e-4), carrier=(3.2, 6e-3), sun=(0.5, 4e-4), ring=(2, 9e-3)),
    )
    assert planets_alike(springs.planar, train.phases) == alike
    torques = dict(zip(("sun", "ring", "carrier"), _torques_of(train), strict=True))
    speeds, found = np.linspace(5_000, 60_000, 23), []
    for many in (1, alike):
        system = planetary_system(fold(springs, many), masses, torques, damping_ratio=0.05, alike=many)
        waves = [
            MeshExcitation(stiffness=CosineStiffness(variation=0.2), phase=360 * ahead)
            for mesh in train.meshes
            for ahead in train.phases[mesh.name].ahead[: planets // many]
        ]
        response = periodic_response(system, Excitation(meshes=tuple(waves)), speeds, harmonics=5, stability=False)
        kept = planets // many
        found.append(response.approach_coefficients.reshape(len(speeds), -1, 2, kept))
        found[-1] = np.tile(found[-1], many)
    assert found[1] == pytest.approx(found[0], rel=1e-8, abs=1e-16)


def test_planets_that_differ_are_not_taken_for_one() -> None:
    train = TRAINS["A helical"]
    phases = train.phases
    assert planets_alike(train_springs(train, STIFFNESS).planar, phases) == 4
    uneven = (np.array([400.0, 401.0, 400.0, 401.0]), 500.0)
    assert planets_alike(train_springs(train, uneven).planar, phases) == 2
    planar = train_springs(train, STIFFNESS).planar
    assert planets_alike(replace(planar, angles=planar.angles + np.array([0, 0.1, 0, 0.1])), phases) == 2
    assert planets_alike(replace(planar, angles=planar.angles + np.array([0, 0.1, 0, 0])), phases) == 1


def test_modes_that_planets_in_phase_do_not_shake_can_grow() -> None:
    """At twice the frequency of a planet mode, where its stiffness comes and goes as it swings: far from symmetric motions."""
    train = on_springs(simple_train((60, 20, -100), (0.0, 0.0, 0.0), 5), **ELASTIC)
    masses = masses_of((0.7, 3e-4), carrier=(3.2, 6e-3), sun=(0.5, 4e-4), ring=(2.1, 9e-3))
    load = TrainLoad(torque=500.0, speed=1500.0)
    stiffness = train_stiffness(train, mesh_loads(train, power_flow(train, load)), method="strain-energy", positions=24)
    options = DynamicsOptions(speeds=33, speed_from=16_000.0, speed_to=21_000.0)
    found = planetary_response(train, load, stiffness, masses, options)
    assert found.alike == 5
    twice = 2 * found.modes.frequency[found.modes.of_kind(ModeKind.PLANET)][2]
    growing = found.up.frequencies[~found.up.stable] / (2 * np.pi)
    assert 0.97 * twice < growing.min() < twice < growing.max() < 1.03 * twice
    assert "planets-differ" in [notice.code for notice in found.notices]
    assert found.factors["sun-planet"].shape == (len(found.speeds), 5)


def test_a_mean_shakes_nothing() -> None:
    train = on_springs(TRAINS["A"], **ELASTIC)
    stiffness = train_stiffness(train, mesh_loads(train, power_flow(train, LOAD)), method="iso6336")
    with pytest.raises(ParameterError, match=r"stiffness = 'iso6336': must give the stiffness over the mesh cycle"):
        planetary_response(train, LOAD, stiffness, MASSES)


def test_stepped_planets_are_stable_at_low_speeds() -> None:
    """Their meshes come again after twenty teeth: in too few steps that looked like growth."""
    train = on_springs(TRAINS["D"], **ELASTIC)
    found = _run(train, LOAD, speed_from=6.0, speed_to=60.0, harmonics=2)
    assert found.up.stable.all()
    assert "unstable" not in [notice.code for notice in found.notices]
