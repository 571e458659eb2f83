"""Natural modes of trains whose carrier turns, against the full equations of motion: exact involutes on a turning carrier."""

from dataclasses import replace

import numpy as np
import pytest
from support.planetary_trains import MASSES, TRAINS, on_springs

from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats
from gearcad.dynamics.planetary.gyroscopic_modes import TurningMatrices, gyroscopic_modes
from gearcad.dynamics.planetary.planar_model import MemberMass, TrainMasses, TrainSprings, springs_of, train_springs
from gearcad.dynamics.planetary.planetary_modes import ModeKind, planetary_modes


class _Exact:
    """Forces on all bodies of a train in a frame that turns with `speed` (1/s), at any displacement: no linear step anywhere.

    Coordinates: x, y (m) and turn (rad) of carrier, centrals and planets.
    """

    def __init__(self, springs: TrainSprings, masses: TrainMasses, speed: float) -> None:
        self.planar, self.speed = springs.planar, speed
        bodies = [masses.members[member.name] for member in self.planar.members] + [masses.planet] * self.planar.planets
        self.mass = np.array([[each.mass, each.mass, each.inertia] for each in bodies], float)
        self.distance = self.planar.members[0].radius
        self.rest = np.zeros((len(bodies), 3))
        self.rest[3:, 0], self.rest[3:, 1] = (self.distance * f(self.planar.angles) for f in (np.cos, np.sin))

    def forces(self, moved: Floats) -> Floats:
        at = self.rest + moved.reshape(self.rest.shape)
        found = self.mass * [1.0, 1.0, 0.0] * self.speed**2 * at
        for place, member in enumerate(self.planar.members):
            found[place, :2] -= (member.support or 0.0) * at[place, :2]
            found[place, 2] -= (member.torsion or 0.0) * member.radius**2 * at[place, 2]
        carrier = at[0]
        for planet, angle in enumerate(self.planar.angles, 3):
            arm = self.distance * np.array([np.cos(angle + carrier[2]), np.sin(angle + carrier[2])])
            pull = self.planar.pin * (at[planet, :2] - carrier[:2] - arm)
            found[planet, :2] -= pull
            found[0, :2] += pull
            found[0, 2] += arm[0] * pull[1] - arm[1] * pull[0]
        for place, line in enumerate(self.planar.meshes, 1):
            sign, radius = (1.0 if line.external else -1.0), self.planar.members[place].radius
            of_planet = self.planar.planet_radius * line.rim_ratio
            both = radius + sign * of_planet
            for planet, (angle, stiffness) in enumerate(zip(self.planar.angles, line.stiffness, strict=True), 3):
                apart = at[planet, :2] - at[place, :2]
                length = np.hypot(*apart)
                out, along = apart / length, np.array([-apart[1], apart[0]]) / length
                turned = np.angle((apart[0] + 1j * apart[1]) * np.exp(-1j * angle))
                pressure = np.arccos(abs(both) / length)
                start = np.arccos(abs(both) / self.distance)
                involute = (np.tan(pressure) - pressure) - (np.tan(start) - start)
                approach = line.sense * (radius * (at[place, 2] - turned) + sign * of_planet * (at[planet, 2] - turned))
                approach -= sign * abs(both) * involute
                force = stiffness * approach
                across = -line.sense * np.cos(pressure) * along - sign * np.sin(pressure) * out
                found[planet, :2] -= force * across
                found[place, :2] += force * across
                found[place, 2] -= force * line.sense * radius
                found[planet, 2] -= force * line.sense * sign * of_planet
        return found.ravel()

    def slopes(self, moved: Floats) -> Floats:
        steps = 1e-7 * np.eye(len(moved))
        return np.array([(self.forces(moved + step) - self.forces(moved - step)) / 2e-7 for step in steps]).T

    def roots(self) -> Floats:
        """Return frequencies (1/s), rising, of small motions about the position at rest on the turning carrier."""
        moved = np.zeros(self.rest.size)
        for _ in range(12):
            moved -= np.linalg.lstsq(self.slopes(moved), self.forces(moved), rcond=1e-13)[0]
        assert np.abs(self.forces(moved)).max() < 1e-9 * np.abs(self.speed**2 * self.mass[:, 0] * self.distance).max() + 1e-7
        size = len(moved)
        coriolis = np.zeros((size, size))
        x = np.arange(0, size, 3)
        coriolis[x, x + 1], coriolis[x + 1, x] = 2 * self.mass[:, 0] * self.speed, -2 * self.mass[:, 1] * self.speed
        inverse = 1 / self.mass.ravel()[:, None]
        unit = 1e4
        below = [inverse * self.slopes(moved) / unit**2, inverse * coriolis / unit]
        system = np.block([[np.zeros((size, size)), np.eye(size)], below])
        return np.sort(unit * np.linalg.eigvals(system).imag)[size:]


def _random(seed: int) -> tuple[TrainSprings, TrainMasses]:
    """Return a set of random kind, stiffnesses, masses, sense; every third with planets at unequal angles."""
    rng = np.random.default_rng(seed)
    kind = list(TRAINS)[seed % len(TRAINS)]
    train = on_springs(TRAINS[kind], support=rng.uniform(30, 300), pin=rng.uniform(100, 900), torsion=10 ** rng.uniform(4, 6))
    planar = train_springs(train, (rng.uniform(200, 700), rng.uniform(200, 700)), sense=rng.choice([1, -1])).planar
    if seed % 3 == 2:
        planar = replace(planar, angles=planar.angles + rng.uniform(-0.1, 0.1, planar.planets))
    members = {name: MemberMass(mass=m * rng.uniform(0.5, 2), inertia=j * rng.uniform(0.5, 2)) for name, m, j in _weights()}
    planet = MemberMass(mass=MASSES.planet.mass * rng.uniform(0.5, 2), inertia=MASSES.planet.inertia * rng.uniform(0.5, 2))
    return springs_of(planar), TrainMasses(members=members, planet=planet)


def _weights() -> list[tuple[str, float, float]]:
    return [(name, each.mass, each.inertia) for name, each in MASSES.members.items()]


def _frequencies(springs: TrainSprings, masses: TrainMasses, speed: float) -> Floats:
    modes = gyroscopic_modes(springs, masses, 30 * speed / np.pi, count=2)
    assert modes.unstable_from is None
    return 2 * np.pi * np.sort(modes.frequency[-1])


QUICK = 6
"""Random sets of the default tests; the others are long."""

SETS = [pytest.param(seed, marks=[] if seed < QUICK else pytest.mark.long) for seed in range(30)]


@pytest.mark.parametrize("seed", SETS)
def test_small_motions_of_the_exact_equations(seed: int) -> None:
    """What is left falls with the fourth power of the speed, and is far below what the turning carrier does."""
    springs, masses = _random(seed)
    still = np.sort(planetary_modes(springs, masses).circular)
    slow, left = 0.02 * still[0], []
    for speed in (2 * slow, slow):
        exact, ours = _Exact(springs, masses, speed).roots(), _frequencies(springs, masses, speed)
        left.append(np.abs(exact / ours - 1).max())
        assert np.abs(exact / still - 1).max() > 100 * left[-1]
    assert left[0] < 1e-6
    assert left[1] < max(left[0] / 10, 1e-9)


def test_a_member_on_its_bearing_whirls_at_its_frequency_less_and_plus_the_speed() -> None:
    """A central whose mesh is next to nothing: in a frame that turns, w - W and w + W."""
    train = on_springs(TRAINS["A"], support=60.0, pin=200.0, torsion=1e5)
    springs = train_springs(train, (1e-9, 1e-9))
    modes = gyroscopic_modes(springs, MASSES, 3000.0, count=3)
    for central in springs.members[1:]:
        mass = MASSES.members[central].mass
        assert mass is not None
        alone, speed = np.sqrt(60e6 / mass), 2 * np.pi * 3000 / 60
        for wanted in (alone - speed, alone + speed):
            assert np.abs(2 * np.pi * modes.frequency[-1] / wanted - 1).min() < 1e-9


@pytest.mark.parametrize("kind", TRAINS)
@pytest.mark.parametrize("pin", [200.0, None])
def test_a_train_that_is_free_to_turn_stays_free(kind: str, pin: float | None) -> None:
    springs = train_springs(on_springs(TRAINS[kind], support=60.0, pin=pin), (400.0, 500.0))
    still, modes = planetary_modes(springs, MASSES), gyroscopic_modes(springs, MASSES, 5000.0)
    assert ((modes.frequency == 0).sum(axis=1) == still.rigid).all()
    assert modes.unstable_from is None
    assert np.sort(modes.frequency[0]) == pytest.approx(still.frequency, rel=1e-9)
    assert sorted(each.value for each in modes.kinds) == sorted(each.value for each in still.kinds)


def test_rigid_pins_are_the_limit_of_stiff_ones() -> None:
    found = []
    for pin in (None, 1e7):
        springs = train_springs(on_springs(TRAINS["B"], support=60.0, pin=pin, torsion=1e5), (400.0, 500.0))
        found.append(np.sort(gyroscopic_modes(springs, MASSES, 4000.0, count=2).frequency[-1])[:8])
    assert found[0] == pytest.approx(found[1], rel=1e-4)


def test_planet_modes_keep_their_number_at_any_speed_and_pairs_part() -> None:
    """N - 3 at each frequency (Cooley and Parker, J. Sound Vib. 331 (2012)); the pairs of a carrier at rest become two."""
    planar = train_springs(on_springs(TRAINS["A"], support=60.0, pin=200.0, torsion=1e5), (400.0, 500.0)).planar
    lines = tuple(replace(line, stiffness=np.full(6, line.stiffness[0])) for line in planar.meshes)
    springs = springs_of(replace(planar, angles=2 * np.pi * np.arange(6) / 6, meshes=lines))
    modes = gyroscopic_modes(springs, MASSES, 6000.0, count=3)
    of_planets = modes.frequency[:, [kind is ModeKind.PLANET for kind in modes.kinds]]
    assert of_planets.shape == (3, 9)
    assert np.ptp(of_planets.reshape(3, 3, 3), axis=2).max() < 1e-6 * of_planets.max()
    travelling = modes.frequency[:, [kind is ModeKind.TRANSLATIONAL for kind in modes.kinds]]
    pairs = np.diff(travelling, axis=1)[:, ::2]
    assert pairs[0].max() < 1e-6 * travelling.max()
    assert pairs[-1].min() > 1e-5 * travelling.max()


def test_all_but_turning_motions_weigh_in_the_matrices() -> None:
    """G does no work, and K_2 is symmetric."""
    springs, masses = _random(2)
    found = TurningMatrices.of(springs, masses)
    assert np.abs(found.gyroscopic + found.gyroscopic.T).max() == 0
    assert np.abs(found.by_square - found.by_square.T).max() < 1e-12 * np.abs(found.by_square).max()


@pytest.mark.parametrize("speed", [-1.0, float("nan"), float("inf")])
def test_a_speed_that_is_none(speed: float) -> None:
    springs = train_springs(on_springs(TRAINS["A"], support=60.0, pin=200.0), (400.0, 500.0))
    with pytest.raises(ParameterError, match=r"highest_speed .* must be a finite speed of at least 0 rpm"):
        gyroscopic_modes(springs, MASSES, speed)
