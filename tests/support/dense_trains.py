"""Drives and planetary trains by dense matrices."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from random import Random

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.records import Bools, Floats
from gearcad.dynamics.planetary.planar_model import SpringKind, TrainSprings, train_springs
from gearcad.dynamics.trains.members import GROUND, Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.train import Train
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.planetary.power import power_flow

_PIECES = 24
"""Two-node elements of a shaft."""

_HARMONICS = 10


def random_drive(seed: int) -> Train:
    """Motor, stages and load on shafts that are heavy, light or mere couplings; every other one has backlash."""
    random = Random(seed)
    stages, held = 1 + seed % 3, random.random() < 0.3
    kinds = ("soft", "soft", "light") if seed % 5 < 2 else ("heavy", "light", "soft", "stiff")
    inertias, shafts, meshes = [], [], []
    before, teeth, ratio, scale = (GROUND, 0, 1.0, random.uniform(1.5, 3.0)) if held else ("motor", 0, 1.0, 2.5)
    if not held:
        inertias.append(Inertia(name="motor", inertia=10 ** random.uniform(-2, 0)))
    for stage in range(stages):
        pinion, wheel = f"p{stage}", f"w{stage}"
        shafts.append(_shaft(random, kinds, f"s{stage}", before, pinion))
        teeth = random.choice([16, 20, 24]) if not teeth else random.choice([teeth, teeth // 2])
        driven = teeth * random.choice([1, 2])
        radii = (scale * teeth, scale * driven)
        inertias += [
            Inertia(name=name, inertia=1e-3 * (r / 40) ** 4 * random.uniform(0.7, 2))
            for name, r in zip((pinion, wheel), radii, strict=True)
        ]
        meshes.append(
            ToothMesh(
                name=f"m{stage}",
                pinion=pinion,
                wheel=wheel,
                base_radii=radii,
                teeth=teeth,
                stiffness=random.uniform(150, 900),
                variation=random.uniform(0.05, 0.22),
                phase=random.uniform(0, 1),
                damping_ratio=random.uniform(0.06, 0.2),
                preload=20000.0 if held else 0.0,
                backlash=random.uniform(80, 200) if seed % 2 else None,
            )
        )
        before, teeth, ratio = wheel, driven, -ratio * radii[0] / radii[1]
    last = GROUND if held else "load"
    shafts.append(_shaft(random, kinds, "out", before, last))
    torques = {}
    if not held:
        inertias.append(Inertia(name="load", inertia=10 ** random.uniform(-1, 0.7)))
        torques = {"motor": 800.0, "load": -800.0 / ratio}
    return Train(name=f"drive-{seed}", model="exact", inertias=inertias, shafts=shafts, meshes=meshes, torques=torques)


def _shaft(random: Random, kinds: tuple[str, ...], name: str, start: str, end: str) -> Shaft:
    kind = random.choice(kinds)
    damping = {"damping_ratio": random.uniform(0.02, 0.08)}
    if kind == "soft":
        return Shaft(name=name, start=start, end=end, torsional_stiffness=10 ** random.uniform(2.5, 3.5), **damping)
    if kind == "stiff":
        return Shaft(name=name, start=start, end=end, torsional_stiffness=10 ** random.uniform(5, 6.5), **damping)
    sizes = ((300, 800), (40, 70)) if kind == "heavy" else ((60, 150), (20, 35))
    length, diameter = (random.uniform(*each) for each in sizes)
    return Shaft(name=name, start=start, end=end, length=length, diameter=diameter, modes=2, **damping)


def isolated_rpm(train: Train) -> float:
    """The highest speed (rpm of the first pinion) at which a mesh on its two gears alone resonates."""
    inertia = {each.name: each.inertia for each in train.inertias}
    found = []
    for mesh in train.meshes:
        mass = sum((r / 1000) ** 2 / inertia[gear] for gear, r in zip(mesh.gears, mesh.base_radii, strict=True))
        per_turn = abs(train.speed_ratios[mesh.pinion]) * mesh.teeth
        found.append(math.sqrt(1e6 * mesh.stiffness * mass) * 30 / math.pi / per_turn)
    return max(found)


@dataclass(frozen=True)
class DenseTrain:
    """Inertia, stiffness without meshes and damping (n, n); `mesh` (n, m); `forces` (m,) at rest; `orders` (m,) of the
    common period, `lag` (m,) in teeth, `shake` (m,) relative amplitudes, `mean` (m,) stiffness, `per_rpm` its rate (1/s)."""

    inertia: Floats
    stiffness: Floats
    damping: Floats
    mesh: Floats
    forces: Floats
    mean: Floats
    shake: Floats
    lag: Floats
    orders: tuple[int, ...]
    per_rpm: float

    def factors(self, rpm: float) -> tuple[Floats, Floats]:
        """Greatest and least force of every mesh (m,) over that at rest, at one speed."""
        m, top = len(self.mean), _HARMONICS * max(self.orders)
        omega = self.per_rpm * rpm
        whole = self.stiffness + (self.mesh * self.mean) @ self.mesh.T
        orders = np.arange(-top, top + 1)
        receptance = np.zeros((len(orders), m, m), complex)
        for row, order in enumerate(orders):
            if order > 0:
                at = whole - (order * omega) ** 2 * self.inertia + 1j * order * omega * self.damping
                receptance[row] = self.mesh.T @ np.linalg.solve(at, self.mesh.astype(complex))
                receptance[top - order] = receptance[row].conj()
        receptance[top] = self.mesh.T @ np.linalg.pinv(whole, rcond=1e-12) @ self.mesh
        # k_j (1 - v cos(q theta - lag)) less its mean couples the orders that are q apart.
        coupling = np.zeros((len(orders), m, len(orders), m), complex)
        for j, q in enumerate(self.orders):
            turn = np.exp(-2j * np.pi * self.lag[j])
            rows = np.arange(len(orders))
            for step, phase in ((q, turn), (-q, turn.conjugate())):
                inside = (rows - step >= 0) & (rows - step < len(orders))
                coupling[rows[inside], j, rows[inside] - step, j] = -self.mean[j] * self.shake[j] / 2 * phase
        matrix = np.einsum("hij,hjgk->higk", receptance, coupling)
        size = len(orders) * m
        rest = np.zeros((len(orders), m), complex)
        rest[top] = self.forces / self.mean
        waves = np.linalg.solve(np.eye(size) + matrix.reshape(size, size), rest.ravel()).reshape(-1, m)
        theta = 2 * np.pi * np.arange(64 * top) / (64 * top)
        approach = (np.exp(1j * np.outer(theta, orders)) @ waves).real
        ratio = 1 - self.shake * np.cos(np.outer(theta, self.orders) - 2 * np.pi * self.lag)
        force = self.mean * ratio * approach / self.forces
        return force.max(axis=0), force.min(axis=0)


def dense_train(train: Train, *, isolated: bool = False) -> DenseTrain:
    """The whole train, or its meshes alone on their gears under the forces that they have in the whole."""
    whole = _whole(train)
    forces, sense = _forces(train, *whole)
    inertia, stiffness, damping, mesh = whole
    mesh, names = mesh * sense, [each.name for each in train.inertias]
    if isolated:
        geared = [place for place, name in enumerate(names) if any(name in each.gears for each in train.meshes)]
        inertia, mesh = np.diag([train.inertias[each].inertia for each in geared]), mesh[geared]
        stiffness, damping = np.zeros_like(inertia), np.zeros_like(inertia)
    of = [each.inertia for each in train.inertias]
    c = []
    for each in train.meshes:
        compliance = sum((r / 1000) ** 2 / of[names.index(g)] for g, r in zip(each.gears, each.base_radii, strict=True))
        c.append(2 * (each.damping_ratio or 0.0) * math.sqrt(1e6 * each.stiffness / compliance))
    ratios = [_turns(train, each) for each in train.meshes]
    common = math.lcm(*(ratio.denominator for ratio in ratios))
    divisor = math.gcd(*(int(ratio * common) for ratio in ratios))
    orders = tuple(int(ratio * common) // divisor for ratio in ratios)
    return DenseTrain(
        inertia=inertia,
        stiffness=stiffness,
        damping=damping + (mesh * np.array(c)) @ mesh.T,
        mesh=mesh,
        forces=forces,
        mean=np.array([1e6 * each.stiffness for each in train.meshes]),
        shake=np.array([each.variation for each in train.meshes]),
        lag=np.array([each.phase for each in train.meshes]),
        orders=orders,
        per_rpm=math.pi / 30 * train.meshes[0].teeth / orders[0],
    )


def _turns(train: Train, mesh: ToothMesh) -> Fraction:
    """Tooth frequency over that of the first mesh, by whole numbers of teeth down the chain."""
    ratio = Fraction(1)
    for before, after in pairwise(train.meshes):
        if before is mesh:
            return ratio
        wheel = round(before.teeth * before.base_radii[1] / before.base_radii[0])
        ratio *= Fraction(after.teeth, wheel)
    return ratio


def _whole(train: Train) -> tuple[Floats, Floats, Floats, Floats]:
    """Inertia, stiffness and damping of the lines, and the meshes as both gears turn counter-clockwise."""
    names = {each.name: place for place, each in enumerate(train.inertias)}
    ends, size = [], len(names)
    for shaft in train.shafts:
        inner = list(range(size, size + _PIECES - 1)) if shaft.length else []
        size += len(inner)
        ends.append([names.get(shaft.start, -1), *inner, names.get(shaft.end, -1)])
    inertia, stiffness = np.zeros((size, size)), np.zeros((size, size))
    inertia[range(len(names)), range(len(names))] = [each.inertia for each in train.inertias]
    parts = []
    for shaft, nodes in zip(train.shafts, ends, strict=True):
        own, pieces = np.zeros((size, size)), len(nodes) - 1
        for a, b in pairwise(nodes):
            for i, j, k, mass in ((a, a, 1, 1 / 3), (b, b, 1, 1 / 3), (a, b, -1, 1 / 6), (b, a, -1, 1 / 6)):
                if i >= 0 and j >= 0:
                    own[i, j] += k * shaft.stiffness * pieces
                    inertia[i, j] += mass * shaft.inertia / pieces
        stiffness += own
        parts.append(own)
    mesh = np.zeros((size, len(train.meshes)))
    for j, each in enumerate(train.meshes):
        for gear, radius in zip(each.gears, each.base_radii, strict=True):
            mesh[names[gear], j] = radius / 1000
    return inertia, stiffness, _modal_damping(train, inertia, stiffness, parts), mesh


def _modal_damping(train: Train, inertia: Floats, stiffness: Floats, parts: list[Floats]) -> Floats:
    """Of the modes of the lines: each shaft's ratio, by its share in the strain energy."""
    lower = np.linalg.cholesky(inertia)
    inverse = np.linalg.inv(lower)
    squares, shapes = np.linalg.eigh(inverse @ stiffness @ inverse.T)
    shapes = inverse.T @ shapes
    rates = np.zeros(len(squares))
    elastic = squares > 1e-9 * squares.max()
    for shaft, own in zip(train.shafts, parts, strict=True):
        energy = np.einsum("in,ij,jn->n", shapes, own, shapes)
        rates[elastic] += 2 * shaft.damping_ratio * energy[elastic] / np.sqrt(squares[elastic])
    momentum = inertia @ shapes
    return np.asarray((momentum * rates) @ momentum.T, float)


def _forces(train: Train, _inertia: Floats, stiffness: Floats, _damping: Floats, mesh: Floats) -> tuple[Floats, Floats]:
    """At rest, and which way round flanks press."""
    mean = np.array([1e6 * each.stiffness for each in train.meshes])
    load = np.zeros(len(stiffness))
    for place, each in enumerate(train.inertias):
        load[place] = train.torques.get(each.name, 0.0)
    whole = np.linalg.pinv(stiffness + (mesh * mean) @ mesh.T, rcond=1e-13)
    found = mean * (mesh.T @ (whole @ load))
    sense = np.where(found < -1e-6 * np.abs(found).max(initial=0.0), -1.0, 1.0)
    load = load + (mesh * sense) @ np.array([each.preload for each in train.meshes])
    return np.abs(mean * (mesh.T @ (whole @ load))), sense


_HARD = 1e8
"""N/µm of pins that are rigid, so that they can have errors."""

_OPEN = 1e-8
"""Part of its stiffness that a mesh has left where it is open: nothing is loose."""


def dense_sharing(
    train: PlanetaryTrain,
    load: TrainLoad,
    stiffness: Mapping[str, ArrayLike],
    *,
    carrier_angle: float = 0.0,
    run_out_angles: dict[str, float] | None = None,
) -> tuple[Floats, float]:
    """Forces (2, N) of the meshes (N) and the output's twist (deg) against the load.

    A stage, if any, is one before the set, its wheel on the carrier: here it is a spring of the matrix, from the wheel to a
    pinion that stands in space, which the carrier sees turned back by `carrier_angle` (deg).
    """
    flow = power_flow(train, replace(load, mesh_efficiency=1.0))
    output = train.output
    sense = 1 if flow.set_torques[train.centrals[0].name] > 0 else -1
    staged = {end for stage in train.stages for end in (stage.pinion, stage.wheel)}
    held = [name for name in train.members if name != output and name not in staged]
    pinned = replace(train, carrier=replace(train.carrier, pin_stiffness=train.carrier.pin_stiffness or _HARD))
    first, second = (stiffness[mesh.name] for mesh in train.meshes)
    springs = train_springs(pinned, (first, second), held=held, sense=sense)
    k, v, gap = springs.stiffness, springs.vectors, _gaps(train, springs, sense, run_out_angles or {})
    for stage in train.stages:
        row = _stage_row(train, springs, math.radians(carrier_angle), flow.set_torques[train.carrier.name])
        k, v, gap = np.r_[k, 1e6 * np.asarray(stiffness[stage.name])], np.vstack([v, row]), np.r_[gap, 0.0]
    force = springs.turning(output) * flow.set_torques[output]
    meshes = np.array([springs.select(SpringKind.MESH, mesh.name) for mesh in train.meshes])
    press = np.zeros(len(k), bool)
    press[meshes] = True
    q = _least_energy(k, v, gap, force, press)
    forces = k * (v @ q - gap)
    twist = float(np.degrees(springs.turning(output) @ q)) * np.sign(flow.set_torques[output])
    return np.maximum(forces[meshes], 0.0), twist


def _least_energy(k: Floats, v: Floats, gap: Floats, force: Floats, press: Bools) -> Floats:
    """q of the least of the convex energy of springs of which some are soft when open: Newton's steps, halved as needed."""

    def stiffness(q: Floats) -> Floats:
        return np.where(press & (v @ q < gap), _OPEN * k, k)

    def energy(q: Floats) -> float:
        return float(stiffness(q) @ (v @ q - gap) ** 2 / 2 - force @ q)

    q = np.zeros(v.shape[1])
    for _ in range(200):
        now = stiffness(q)
        full = np.linalg.solve((v.T * now) @ v, force + v.T @ (now * gap))
        step = 1.0
        while step > 1e-9 and energy(q + step * (full - q)) > energy(q):
            step /= 2
        q = q + step * (full - q)
        if (stiffness(q) == now).all():
            return q
    raise AssertionError("the energy has not settled")


def _gaps(train: PlanetaryTrain, springs: TrainSprings, sense: int, angles: dict[str, float]) -> Floats:
    """In m: errors of pins and teeth, and run-outs at the angles (deg) that are given."""
    gap = np.zeros(len(springs.springs))
    gap[springs.select(SpringKind.PIN_TANGENTIAL)] = -sense * 1e-6 * np.array(train.carrier.pin_errors or 0.0)
    for mesh in train.meshes[: len(train.rims)]:
        gap[springs.select(SpringKind.MESH, mesh.name)] = -1e-6 * np.array(mesh.rim.tooth_errors or 0.0)
    for mesh in train.meshes:
        turned = math.radians(angles.get(mesh.central.name, 0.0))
        away = 1e-6 * mesh.central.run_out * np.array([math.cos(turned), math.sin(turned)])
        pressure = mesh.working_pressure_angle
        line = next(each for each in springs.planar.meshes if each.name == mesh.name)
        for n, place in enumerate(springs.select(SpringKind.MESH, mesh.name)):
            # Unit vector of the force on the central: along its rotation, off a sun's planet, out of a ring's.
            psi, back = springs.planar.angles[n], -line.sense
            outward = -1 if mesh.external else 1
            along = back * math.cos(pressure) * np.array([-math.sin(psi), math.cos(psi)])
            normal = along + outward * math.sin(pressure) * np.array([math.cos(psi), math.sin(psi)])
            gap[place] += normal @ away
    return gap


def _stage_row(train: PlanetaryTrain, springs: TrainSprings, carrier_angle: float, torque: float) -> Floats:
    """Elongation of the stage's mesh, positive where the pinion presses the wheel against the carrier's `torque`."""
    (stage,) = train.stages
    towards = math.radians(stage.angle) - carrier_angle
    pressure = math.radians(stage.pair.working_transverse_pressure_angle)
    side = math.copysign(1.0, torque)  # the flank pushes the wheel with the torque that the set asks for
    normal = side * math.cos(pressure) * np.array([-math.sin(towards), math.cos(towards)])
    normal -= math.sin(pressure) * np.array([math.cos(towards), math.sin(towards)])
    row = np.zeros(len(springs.basis))
    row[:2] = -normal
    row[2] = -side * abs(stage.pair.wheel.base_diameter) / 2 / float(train.centre_distance)
    found: Floats = row @ springs.basis
    return found
