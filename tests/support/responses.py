"""Systems of few degrees of freedom for tests of forced vibration, put together by hand."""

from __future__ import annotations

import numpy as np

from gearcad.dynamics.trains.mesh_excitation import CosineStiffness, Excitation, MeshExcitation
from gearcad.dynamics.trains.shaft_lines import System

MOMENT, RADIUS = 2256.0, 0.0507
STATIC_FORCE = MOMENT / RADIUS
STIFFNESS, MESH_DAMPING, VARIATION = 7.05e8, 14660.0, 0.206
"""Of the train of J. Osinski's paper (2.1), (2.9), (2.10)."""


def oscillator(damping_ratio: float, stiffness: float = 1.0, load: float = 1.0) -> System:
    """y'' + 2 zeta y' + k y = load."""
    return System(
        squares=np.zeros(1),
        damping=np.zeros(1),
        mesh=np.ones((1, 1)),
        inertias=np.zeros((1, 0)),
        shaft_torques=np.zeros((1, 0)),
        load=np.full(1, load),
        stiffness=np.full(1, stiffness),
        mesh_damping=np.array([2 * damping_ratio]),
        names=(("mesh",), (), ()),
    )


def preloaded(frequencies: list[float], mesh: list[float], loss: float = 0.0) -> System:
    """Modes of the lines, with a damping ratio of each; opposite moments press the mesh and leave the shafts unloaded."""
    squares, shape = np.square(frequencies), np.array(mesh)
    return System(
        squares=squares,
        damping=2 * loss * np.array(frequencies),
        mesh=shape[:, None],
        inertias=np.zeros((len(mesh), 0)),
        shaft_torques=np.zeros((len(mesh), 0)),
        load=shape * STATIC_FORCE,
        stiffness=np.array([STIFFNESS]),
        mesh_damping=np.array([MESH_DAMPING]),
        names=(("mesh",), (), ()),
    )


def isolated() -> System:
    """The paper's pair without shafts, along the line of action."""
    return preloaded([0.0], [float(np.sqrt(RADIUS**2 / 0.0058 + 0.1353**2 / 0.2228))])


def two_stages(shaft_damping: float = 1.0) -> System:
    """The paper's two-stage train (3.1)-(3.5) with k3 = 1e7 N·m/rad, k = 7.5e8 N/m; moments +M on gear 1, -M on gear 4."""
    radius, inertia, k_1, k_3, k_5, half = 0.0902, 0.0446, 1e5, 1e7, 921.0, 2**-0.5
    gears = np.array([[1, 0, 0, 0], [0, half, half, 0], [0, half, -half, 0], [0, 0, 0, 1]]).T / np.sqrt(inertia)
    return System(
        squares=np.array([k_1, 0, 2 * k_3, k_5]) / inertia,
        damping=shaft_damping * np.array([1, 0, 2, 1]) / inertia,
        mesh=radius * np.stack([gears[:, 0] + gears[:, 1], gears[:, 2] + gears[:, 3]], axis=1),
        inertias=gears,
        shaft_torques=np.stack([k_1 * gears[:, 0], k_3 * (gears[:, 1] - gears[:, 2]), k_5 * gears[:, 3]], axis=1),
        load=MOMENT * (gears[:, 0] - gears[:, 3]),
        stiffness=np.full(2, 7.5e8),
        mesh_damping=np.full(2, MESH_DAMPING),
        names=(("first", "second"), ("1", "2", "3", "4"), ("input", "middle", "output")),
    )


def cosine(variation: float, *, phase: float = 0.0, backlash: float | None = None) -> Excitation:
    """Of a single mesh."""
    shape = CosineStiffness(variation=variation)
    return Excitation(meshes=(MeshExcitation(stiffness=shape, phase=phase, backlash=backlash),))
