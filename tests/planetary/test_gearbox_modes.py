"""Modes and vibration of gearboxes: involutes by finite differences, single sets, chains in closed form."""

import json
import math
import random
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.linalg import eigh
from support.gearboxes import of_train, ravigneaux
from support.planetary_trains import MASSES, TRAINS, on_springs

import gearcad
from gearcad.cli import main
from gearcad.core.errors import GeometryError, SolverError
from gearcad.core.records import Floats
from gearcad.designs.reader import starter_text
from gearcad.dynamics.planetary.gearbox_model import GearboxModel
from gearcad.dynamics.planetary.gearbox_modes import GearboxModes, gearbox_modes, gearbox_response, mesh_forces
from gearcad.dynamics.planetary.planar_model import train_springs
from gearcad.dynamics.planetary.planetary_modes import ModeKind, planetary_modes
from gearcad.planetary.gearbox import Gearbox, GearboxShaft, GearboxState
from gearcad.planetary.gearbox_sets import MemberSet, SetCarrier

SHAFT = '[[planetary.shaft]]\nstart = "engine"\nend = "input"\ntorsional_stiffness = 1e4\n\n'

STEP = 1e-7
"""Displacements (m and rad) of finite differences."""


def with_springs(each: MemberSet, rng: random.Random, *, rigid: bool = True) -> MemberSet:
    """The set with random masses and stiffnesses; some bearings and pins are rigid, some bearings absent."""
    assert each.gearing is not None
    centrals = {central.name for central in each.centrals}

    def bearing() -> float | None:
        return rng.choice((None, 0.0, rng.uniform(5, 300)) if rigid else (0.0, rng.uniform(5, 300)))

    pin = rng.choice((None, rng.uniform(50, 500)) if rigid else (rng.uniform(50, 500),))
    gears = {}
    for name, own in each.gearing.gears.items():
        given: dict[str, Any] = {"mass": rng.uniform(0.2, 3), "inertia": rng.uniform(1e-4, 5e-3)}
        given |= {"mesh_stiffness": rng.uniform(100, 600), "mesh_error": rng.uniform(0, 5)}
        if name in centrals:
            given |= {"support_stiffness": bearing(), "torsional_stiffness": rng.choice((None, None, rng.uniform(1e3, 1e5)))}
        else:
            given |= {"pin_stiffness": pin}
        gears[name] = replace(own, **given)
    carrier = SetCarrier(mass=rng.uniform(1, 5), inertia=rng.uniform(1e-3, 2e-2), support_stiffness=bearing())
    return replace(each, gearing=replace(each.gearing, gears=gears, carrier=carrier))


def random_gearbox(seed: int) -> tuple[Gearbox, GearboxModes]:
    """Two sets with members joined, a shaft that twists, and a member held, in a state in which they run."""
    rng = random.Random(seed)
    while True:
        sets = []
        for name in ("p", "q"):
            kind = rng.choice(("A", "B", "C", "D", "ravigneaux", "ravigneaux"))
            each = ravigneaux(26, 19, 34, 20, 3) if kind == "ravigneaux" else of_train(kind)
            sets.append(with_springs(replace(each, name=name), rng))
        joined = [tuple(rng.choice(each.members) for each in sets)]
        if rng.random() < 0.5:
            joined.append(tuple(rng.choice(each.members) for each in sets))
        shaft = GearboxShaft(
            name="s", start="motor", end=rng.choice(sets[0].members), torsional_stiffness=rng.uniform(1e3, 1e5)
        )
        members = [name for each in sets for name in each.members]
        state = GearboxState(
            name="it",
            held=tuple(rng.sample(members, rng.choice((1, 2)))),
            joined=rng.choice(((), (tuple(rng.sample(members, 2)),))),
        )
        try:
            box = Gearbox(
                name="box",
                sets=tuple(sets),
                input="motor",
                output=rng.choice(sets[1].members),
                states=(state,),
                joined=tuple(joined),
                shafts=(shaft,),
                inertias={"motor": 0.02, sets[1].members[0]: 0.01},
            )
            found = box.state("it")
            if any(each is None for each in found.mesh_torques.values()):
                continue
            return box, gearbox_modes(GearboxModel(box, found))
        except (GeometryError, SolverError):
            continue


# ---------------------------------------------------------------------- exact kinematics, by themselves


class Exact:
    """Positions of all bodies and approaches of all springs at displacements, from involutes and points of the carrier."""

    def __init__(self, box: Gearbox) -> None:
        self.box, self.state = box, box.state("it")
        names = [*box.members, "motor"]
        self.root = {name: name for name in names}
        for group in (*box.joined, *self.state.state.joined):
            for other in group[1:]:
                old, new = self.root[other], self.root[group[0]]
                self.root = {name: new if root == old else root for name, root in self.root.items()}
        self.free: list[tuple[str, int]] = []
        for root in dict.fromkeys(self.root.values()):
            toothed = [name for name in names if self.root[name] == root and "." in name]
            if toothed and all(self.support(name) is not None for name in toothed):
                self.free += [(root, 0), (root, 1)]
            torsion = [self.torsion(name) for name in toothed]
            if not (any(name in self.state.state.held for name in toothed) and all(each is None for each in torsion)):
                self.free.append((root, 2))
        self.planets = [
            (each.name, body, n)
            for each in box.sets
            for body in dict.fromkeys(each.body_of(planet.name) for planet in each.planets)
            for n in range(each.gearing.planets)  # type: ignore[union-attr]
        ]
        for planet in self.planets:
            self.free += [(planet, axis) for axis in ((2,) if self.pin(planet) is None else (0, 1, 2))]  # type: ignore[misc]

    def own(self, member: str) -> Any:
        name, _, part = member.partition(".")
        gearing = next(each.gearing for each in self.box.sets if each.name == name)
        assert gearing is not None
        return gearing.gears.get(part, gearing.carrier)

    def support(self, member: str) -> float | None:
        found: float | None = self.own(member).support_stiffness
        return found

    def torsion(self, member: str) -> float | None:
        found: float | None = self.own(member).torsional_stiffness
        return found

    def pin(self, planet: tuple[str, str, int]) -> float | None:
        found: float | None = self.own(f"{planet[0]}.{planet[1]}").pin_stiffness
        return found

    def at(self, q: Floats) -> tuple[dict[str, Floats], dict[tuple[str, str, int], Floats]]:
        """x, y, turn of members, and of planets where they stand (m, rad)."""
        moved = {key: float(value) for key, value in zip(self.free, q, strict=True)}
        members = {name: np.array([moved.get((root, axis), 0.0) for axis in range(3)]) for name, root in self.root.items()}
        planets = {}
        for planet in self.planets:
            name, body, n = planet
            assembly = self.box.assemblies[name]
            rest = assembly.place_of(body, n) / 1000
            place = np.array([rest.real, rest.imag, 0.0])
            if self.pin(planet) is None:
                x, y, turn = members[f"{name}.{assembly.subject.carrier}"]
                turned = rest * np.exp(1j * turn)
                place[:2] = turned.real + x, turned.imag + y
            else:
                place[:2] += [moved.get((planet, 0), 0.0), moved.get((planet, 1), 0.0)]  # type: ignore[arg-type]
            place[2] = moved[planet, 2]  # type: ignore[index]
            planets[planet] = place
        return members, planets

    def approaches(self, q: Floats) -> list[float]:
        """How far each spring is pressed, but for constants."""
        members, planets = self.at(q)
        found = []
        for each in self.box.sets:
            assembly = self.box.assemblies[each.name]
            for mesh in assembly.meshes:
                gear = assembly.gearing.gears[mesh.first].gear
                radii = [abs(assembly.gearing.gears[name].gear.base_diameter) / 2000 for name in mesh]
                torque = self.state.mesh_torques[f"{each.name}.{mesh.name}"]
                assert torque is not None
                for n in range(assembly.gearing.planets):
                    central = members.get(f"{each.name}.{mesh.first}")
                    one = planets[each.name, each.body_of(mesh.first), n] if central is None else central
                    other = planets[each.name, each.body_of(mesh.second), n]
                    found.append(_approach(one, other, radii, internal=gear.internal, flank=torque))
        for planet in self.planets:
            if self.pin(planet) is not None:
                assembly = self.box.assemblies[planet[0]]
                rest = assembly.place_of(planet[1], planet[2]) / 1000
                x, y, turn = members[f"{planet[0]}.{assembly.subject.carrier}"]
                held = rest * np.exp(1j * turn) + complex(x, y)
                found += [held.real - planets[planet][0], held.imag - planets[planet][1]]
        for root, axis in self.free:
            if isinstance(root, str):
                found.append(float(members[root][axis]))
        for shaft in self.box.shafts:
            found.append(float(members[shaft.start][2] - members[shaft.end][2]))
        return found

    def stiffness(self) -> list[float]:
        found = []
        for each in self.box.sets:
            for mesh in self.box.assemblies[each.name].meshes:
                found += [1e6 * self.own(f"{each.name}.{mesh.first}").mesh_stiffness] * each.gearing.planets  # type: ignore[union-attr]
        for planet in self.planets:
            if (pin := self.pin(planet)) is not None:
                found += [1e6 * pin] * 2
        for root, axis in self.free:
            if isinstance(root, str):
                own = [name for name, other in self.root.items() if other == root and "." in name]
                bearing = sum(1e6 * (self.support(name) or 0.0) for name in own)
                found.append(bearing if axis < 2 else sum(self.torsion(name) or 0.0 for name in own))
        return found + [shaft.torsional_stiffness for shaft in self.box.shafts]

    def weights(self) -> list[float]:
        """Mass, mass, inertia of members and planets, as `flat` has them."""
        found = []
        for name in self.root:
            own = self.own(name) if "." in name else SetCarrier(mass=1e-30, inertia=1e-30)
            found += [own.mass, own.mass, own.inertia + self.box.inertias.get(name, 0.0)]
        for name, body, _ in self.planets:
            each = next(each for each in self.box.sets if each.name == name)
            rims = [self.own(f"{name}.{planet.name}") for planet in each.planets if each.body_of(planet.name) == body]
            found += [sum(rim.mass for rim in rims)] * 2 + [sum(rim.inertia for rim in rims)]
        return found

    def flat(self, q: Floats) -> Floats:
        members, planets = self.at(q)
        return np.concatenate([*members.values(), *planets.values()])

    def frequencies(self) -> Floats:
        """From K = J^T k J and M = P^T m P, J and P by finite differences of approaches and positions."""
        size = len(self.free)
        springs, places = [], []
        for step in STEP * np.eye(size):
            springs.append((np.array(self.approaches(step)) - np.array(self.approaches(-step))) / (2 * STEP))
            places.append((self.flat(step) - self.flat(-step)) / (2 * STEP))
        j, p = np.array(springs).T, np.array(places).T
        values = eigh((j.T * self.stiffness()) @ j, (p.T * self.weights()) @ p, eigvals_only=True)
        return np.sqrt(np.maximum(values, 0)) / (2 * np.pi)


def _approach(one: Floats, other: Floats, radii: list[float], *, internal: bool, flank: float) -> float:
    """How far two involute flanks overlap along the common tangent of their base circles, but for a constant.

    `flank` is the torque of the mesh on the second gear. Each flank ends a string that unwinds from its base circle.
    """
    between = other[:2] - one[:2]
    r1, r2 = radii
    sense = math.copysign(1.0, flank) * (1.0 if internal else -1.0)  # of the turn of the first gear that presses the flank
    alpha = math.acos((r1 - r2 if internal else r1 + r2) / float(np.hypot(*between)))
    direction = math.atan2(between[1], between[0])
    if direction < -2.0:
        direction += math.tau  # no jump for planets near 180 degrees
    rest = direction + (sense if internal else -sense) * alpha
    touch1 = one[:2] + r1 * np.array([math.cos(rest), math.sin(rest)])
    opposite = rest if internal else rest + math.pi
    touch2 = other[:2] + r2 * np.array([math.cos(opposite), math.sin(opposite)])
    length = float(np.hypot(*(touch2 - touch1)))
    if internal:
        return sense * (r1 * (one[2] - rest) - r2 * (other[2] - rest)) + length
    return sense * (r1 * (one[2] - rest) + r2 * (other[2] - rest)) - length


@pytest.mark.parametrize("seeds", [range(6), pytest.param(range(6, 30), marks=pytest.mark.long)], ids=["6", "30"])
def test_frequencies_of_two_sets_from_involutes_and_points_of_carriers_by_finite_differences(seeds: range) -> None:
    for seed in seeds:
        box, modes = random_gearbox(seed)
        exact = Exact(box).frequencies()
        assert len(exact) == len(modes.frequency), seed
        rigid = modes.rigid
        assert modes.frequency[rigid:] == pytest.approx(exact[rigid:], rel=2e-6, abs=1e-3), seed
        assert exact[:rigid].max(initial=0.0) < 1e-3 * exact.max(), seed
        assert modes.kinetic.sum(axis=1) == pytest.approx(1) and modes.potential[rigid:].sum(axis=1) == pytest.approx(1)


@pytest.mark.parametrize("kind", ["A", "B", "C", "D"])
@pytest.mark.parametrize("pin", [None, 200.0])
def test_one_set_has_the_modes_of_a_planetary_train(kind: str, pin: float | None) -> None:
    train = on_springs(TRAINS[kind], support=30.0, pin=pin)
    stiffness = 350.0, 470.0
    wanted = planetary_modes(train_springs(train, stiffness), MASSES)
    box = single(kind, stiffness, pin, support=30.0)
    found = gearbox_modes(GearboxModel(box, box.state("it")))
    assert found.frequency == pytest.approx(wanted.frequency, rel=1e-9, abs=1e-3)
    assert sorted((each.kind.value, each.multiplicity) for each in found.families) == sorted(
        (each.kind.value, each.multiplicity) for each in wanted.families
    )


def single(kind: str, stiffness: tuple[float, float], pin: float | None, *, support: float, name: str = "s") -> Gearbox:
    """The set of a train on springs, with the masses of the tests."""
    each = replace(of_train(kind), name=name)
    assert each.gearing is not None
    gears = dict(each.gearing.gears)
    for central, k in zip(each.centrals, stiffness, strict=True):
        own = MASSES.members[central.name]
        given = {"mass": own.mass, "inertia": own.inertia, "mesh_stiffness": k, "support_stiffness": support}
        gears[central.name] = replace(gears[central.name], **given)
    for number, planet in enumerate(each.planets):
        mass, inertia = MASSES.planet.mass, MASSES.planet.inertia
        share = 1 / len(each.planets)
        assert mass is not None and inertia is not None
        gears[planet.name] = replace(gears[planet.name], mass=mass * share, inertia=inertia * share, pin_stiffness=pin)
        assert number < 2
    own = MASSES.members["carrier"]
    carrier = SetCarrier(mass=own.mass, inertia=own.inertia, support_stiffness=support)
    subject = replace(each, gearing=replace(each.gearing, gears=gears, carrier=carrier))
    state = GearboxState(name="it", held=(f"{name}.b",))
    return Gearbox(name="box", sets=(subject,), input=f"{name}.a", output=f"{name}.carrier", states=(state,))


def test_two_sets_that_are_joined_in_all_members_have_the_modes_of_one() -> None:
    """Both as one: masses and stiffnesses of all bodies are doubled, so no frequency changes."""
    one, other = (single("A", (350.0, 470.0), 200.0, support=30.0, name=name) for name in ("p", "q"))
    alone = gearbox_modes(GearboxModel(one, one.state("it"))).frequency
    joined = tuple((f"p.{part}", f"q.{part}") for part in ("a", "b", "carrier"))
    box = replace(one, sets=(*one.sets, *other.sets), joined=joined)
    both = gearbox_modes(GearboxModel(box, box.state("it"))).frequency
    left = list(both)
    for frequency in alone:
        nearest = min(left, key=lambda each: abs(each - frequency))
        assert nearest == pytest.approx(frequency, rel=1e-9, abs=1e-3)
        left.remove(nearest)
    assert len(left) == 9  # the planets of both sets against each other, members at rest


def test_two_sets_on_a_shaft_that_hardly_twists_are_joined() -> None:
    one, other = (single("A", (350.0, 470.0), 200.0, support=0.0, name=name) for name in ("p", "q"))
    state = GearboxState(name="it", held=("p.b", "q.b"))
    box = Gearbox(name="box", sets=(*one.sets, *other.sets), input="p.a", output="q.carrier", states=(state,), joined=())
    stiff = GearboxShaft(name="s", start="p.carrier", end="q.a", torsional_stiffness=1e11)
    soft = replace(stiff, torsional_stiffness=1e-3)
    rotational = {}
    for name, each in (("stiff", replace(box, shafts=(stiff,))), ("joined", replace(box, joined=(("p.carrier", "q.a"),)))):
        modes = gearbox_modes(GearboxModel(each, each.state("it")))
        rotational[name] = [f.frequency for f in modes.families if f.kind is ModeKind.ROTATIONAL]
    assert rotational["stiff"][:-1] == pytest.approx(rotational["joined"], rel=1e-4, abs=1e-3)
    parted = replace(box, shafts=(soft,))
    modes = gearbox_modes(GearboxModel(parted, parted.state("it"))).frequency
    alone = gearbox_modes(GearboxModel(one, one.state("it"))).frequency
    assert modes[modes > 1] == pytest.approx(np.sort(np.concatenate([alone, alone]))[-int((modes > 1).sum()) :], rel=1e-6)


# ---------------------------------------------------------------------- vibration


def _lone_mesh() -> Gearbox:
    """A sun with one planet on a held carrier: two inertias and one spring."""
    box = single("A", (350.0, 470.0), None, support=0.0)
    each = box.sets[0]
    assert each.gearing is not None
    gears = {name: replace(own, support_stiffness=None) if name in "ab" else own for name, own in each.gearing.gears.items()}
    carrier = SetCarrier()
    state = GearboxState(name="it", held=("s.carrier",))
    subject = replace(each, gearing=replace(each.gearing, gears=gears, carrier=carrier))
    return replace(box, sets=(subject,), output="s.b", states=(state,))


def test_forces_of_a_chain_under_errors_in_closed_form() -> None:
    """Sun, planets and ring that only turn, all planets alike: three inertias over base radii, two springs."""
    box = _lone_mesh()
    modes = gearbox_modes(GearboxModel(box, box.state("it")))
    assembly, model = box.assemblies["s"], modes.model
    gears, n = assembly.gearing.gears, assembly.gearing.planets
    rb = {name: abs(own.gear.base_diameter) / 2000 for name, own in gears.items()}
    m1, m2, m3 = (
        gears["a"].inertia / rb["a"] ** 2,
        n * gears["rim1"].inertia / rb["rim1"] ** 2,
        gears["b"].inertia / rb["b"] ** 2,
    )  # type: ignore[operator]
    k1, k2 = n * 350e6, n * 470e6
    stiffness = np.array([[k1, -k1, 0], [-k1, k1 + k2, -k2], [0, -k2, k2]])
    mass, stretch = np.diag([m1, m2, m3]), np.array([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0]])
    squares, shapes = eigh(stiffness, mass)
    ratio, errors = 0.04, np.array([2e-6, 1e-6 * np.exp(0.7j)])
    own = np.array(
        [errors[0] if each.owner == "s.a-rim1" else errors[1] if each.kind == "mesh" else 0 for each in model.springs]
    )
    for frequency in (130.0, 900.0, 2500.0):
        omega = 2 * math.pi * frequency
        damping = mass @ shapes @ np.diag(2 * ratio * np.sqrt(np.maximum(squares, 0))) @ shapes.T @ mass
        pushed = -stretch.T @ (np.array([k1, k2]) * errors)
        q = np.linalg.solve(stiffness - omega**2 * mass + 1j * omega * damping, pushed)
        wanted = np.array([k1, k2]) * (stretch @ q + errors) / n
        found = mesh_forces(modes, own, np.array([frequency]), ratio)[0]
        for mesh, force in (("s.a-rim1", wanted[0]), ("s.b-rim1", wanted[1])):
            each = [found[place] for place, spring in enumerate(model.springs) if spring.owner == mesh]
            assert np.abs(each) == pytest.approx(abs(force), rel=1e-6), (frequency, mesh)


def test_forces_by_direct_solution_of_all_coordinates_and_the_phases() -> None:
    """With the full damping matrix in place of modes; planets out of phase balance: rotational modes are not shaken."""
    for seed in range(3):
        box, modes = random_gearbox(seed)
        model = modes.model
        basis, k = model.basis, model.stiffness
        v = model.vectors @ basis
        mass, stiffness = (basis.T * model.mass) @ basis, (v.T * k) @ v
        squares, shapes = eigh(stiffness, mass)
        damping = mass @ shapes @ np.diag(0.06 * np.sqrt(np.maximum(squares, 0))) @ shapes.T @ mass
        rng = np.random.default_rng(seed)
        errors = 1e-6 * (rng.normal(size=len(k)) + 1j * rng.normal(size=len(k)))
        for frequency in (217.0, 1234.0):
            omega = 2 * math.pi * frequency
            q = np.linalg.solve(stiffness - omega**2 * mass + 1j * omega * damping, -v.T @ (k * errors))
            wanted = k * (v @ q + errors)
            found = mesh_forces(modes, errors, np.array([frequency]), 0.03)[0]
            assert found == pytest.approx(wanted, rel=1e-6, abs=1e-6 * np.abs(wanted).max())
    box = single("A", (350.0, 470.0), 200.0, support=0.0)
    each = box.sets[0]
    assert each.gearing is not None
    gears = {name: replace(own, mesh_error=3.0) if name == "a" else own for name, own in each.gearing.gears.items()}
    box = replace(box, sets=(replace(each, gearing=replace(each.gearing, gears=gears)),))
    modes = gearbox_modes(GearboxModel(box, box.state("it")))
    response = gearbox_response(modes, np.linspace(100, 4000, 40))
    order = modes.model.tooth_order("s.a-rim1")
    assert order == pytest.approx(24 * 66 / 90, rel=1e-12)
    direct = np.zeros(len(modes.model.springs), complex)
    for n in range(3):
        direct[n] = 3e-6  # z 24 with three planets: all in phase
    wanted = np.abs(mesh_forces(modes, direct, order * response.speed / 60, 0.03))[:, :6]
    assert response.forces[:, 0] == pytest.approx(wanted[:, :3].max(axis=1), rel=1e-9)
    assert response.forces[:, 1] == pytest.approx(wanted[:, 3:].max(axis=1), rel=1e-9)


# ---------------------------------------------------------------------- specs


def test_the_starter_tells_modes_and_vibration_of_each_state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("ravigneaux", "simpson"):
        Path(f"{name}.toml").write_text(starter_text(name)[1], encoding="utf-8")
    told = CliRunner().invoke(main, ["planetary", "ravigneaux.toml"])
    assert told.exit_code == 0 and told.stdout.count("natural frequencies") == 5 and told.stdout.count("dynamic force") == 4
    study = gearcad.planetary(gearcad.read("simpson.toml"))  # type: ignore[call-overload]
    third = study.vibrations["3"].modes
    assert third.rigid == 1 and {each.kind for each in third.families} == set(ModeKind) - {ModeKind.MIXED}
    assert study.vibrations["3"].response is None
    text = Path("ravigneaux.toml").read_text(encoding="utf-8")
    given = gearcad.planetary(gearcad.read("ravigneaux.toml"))  # type: ignore[call-overload]
    response = given.vibrations["1"].response
    assert response is not None and response.speed.max() <= 6000
    document = json.loads(CliRunner().invoke(main, ["planetary", "ravigneaux.toml", "--json"]).stdout)
    vibration = document["states"]["1"]["vibration"]
    assert vibration["response"]["greatest"]["r.small-short"]["force"] == max(response.forces[:, 0])
    assert vibration["modes"]["mesh_stiffness"]["r.ring-long"]["method"] == "ISO 6336-1"
    assert [each["multiplicity"] for each in vibration["modes"]["families"]].count(2) > 3
    for old, new, missing in (
        ("mass = 2.4, ", "", "r.carrier.mass is missing: must be given"),
        ("[planetary.states]", f"{SHAFT}[planetary.states]", "inertia.engine is missing"),
    ):
        Path("it.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
        done = CliRunner().invoke(main, ["planetary", "it.toml"])
        assert done.exit_code == 0 and f"no modes: {missing}" in done.stdout, done.stdout
        assert json.loads(Path("output/ravigneaux/planetary.json").read_text())["why_not"]["modes"].startswith(missing)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("speed = 6000.0", "speed = -1.0", r"planetary\.speed = -1 rpm: must be"),
        ("input = 0.004", "input = 0.0", r"planetary\.inertia\.input = 0 kg·m²: must be"),
        ("mass = 2.4", "mass = 0.0", r"planetary\.set\[0\]\.carrier\.mass = 0 kg: must be"),
        ("mass = 2.4", "weight = 2.4", r"carrier\.weight: unknown key; permitted are name, mass, inertia"),
        ("pin_stiffness = 120.0 ", "pin_stiffness = 0.0 ", r"planet\[0\]\.pin_stiffness = 0 N/µm: must be"),
        ("pin_stiffness = 120.0 ", "support_stiffness = 1.0 ", r"unknown key here; it belongs to a sun or a ring"),
        ("[planetary.states]", SHAFT.replace("end =", "name =") + "[planetary.states]", r"shaft\[0\]\.end is missing"),
        ("[planetary.states]", SHAFT.replace("engine", "input") + "[planetary.states]", r"shaft\[0\]\.end = 'input': must be"),
    ],
)
def test_wrong_values_for_modes_are_one_line(
    old: str, new: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = starter_text("ravigneaux")[1]
    assert old in text
    Path("it.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    done = CliRunner().invoke(main, ["planetary", "it.toml"])
    assert done.exit_code == 2 and re.search(message, done.stderr), done.stderr
    assert done.stderr.startswith("Error: it.toml") and done.stderr.count("\n") == 1
