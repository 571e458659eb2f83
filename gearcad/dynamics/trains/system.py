"""The torsional system that all solvers work on: modes of the shaft lines, coupled by the meshes.

Inside the dynamics rooms numbers are in SI units (m, N, kg, s, rad): inputs and results are in those of the house.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats

__all__ = ["Bearings", "System"]


@dataclass(frozen=True, eq=False)
class Bearings:
    """What holds the axes of `gears` (g) that travel: `travel` (n, 2g) of each (m), along the line of action and across it.

    `stiffness` (2g, 2g) in N/m and `damping` (2g, 2g) in N·s/m are those of the travels.
    """

    gears: tuple[str, ...]
    travel: Floats
    stiffness: Floats
    damping: Floats


@dataclass(frozen=True, eq=False)
class System:
    """z'' + damping z' + squares z + mesh f = load, with y = mesh^T z and f_j = k_j(t) y_j + c_j y_j'.

    z (n,) are coordinates of the shaft lines' own modes, of modal mass 1; a line that is not held has modes with squares 0.
    `mesh` (n, m) gives the approach y of the flanks along the line of action (m) in each of m meshes, positive where they
    press; `inertias` (n, i) the turn of each inertia (rad), `shaft_torques` (n, s) the torque in each shaft (N·m). `load` (n,)
    are the mean torques on the inertias; `stiffness` (m,) the mean of k_j (N/m), `mesh_damping` (m,) c_j (N·s/m).
    """

    squares: Floats
    damping: Floats
    mesh: Floats
    inertias: Floats
    shaft_torques: Floats
    load: Floats
    stiffness: Floats
    mesh_damping: Floats
    names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]
    """Of meshes, inertias and shafts."""
    bearings: Bearings | None = None
    """Of axes that travel, where some do."""

    @property
    def size(self) -> int:
        """How many coordinates there are."""
        return len(self.squares)

    @property
    def outputs(self) -> Floats:
        """(n, i + s + t): turns of the inertias, torques in the shafts, travels of the axes, per coordinate."""
        travels = [] if self.bearings is None else [self.bearings.travel]
        return np.hstack([self.inertias, self.shaft_torques, *travels])

    @property
    def torque_outputs(self) -> slice:
        """Which of the outputs are torques in the shafts."""
        first = self.inertias.shape[1]
        return slice(first, first + self.shaft_torques.shape[1])

    def stiffness_matrix(self, stiffness: Floats | None = None) -> Floats:
        """(n, n), with the meshes at their mean stiffness or another (m,) in N/m."""
        k = self.stiffness if stiffness is None else stiffness
        result: Floats = np.diag(self.squares) + (self.mesh * k) @ self.mesh.T
        return result

    def damping_matrix(self) -> Floats:
        """(n, n) in the coordinates: that of the lines and of the meshes."""
        result: Floats = np.diag(self.damping) + (self.mesh * self.mesh_damping) @ self.mesh.T
        return result
