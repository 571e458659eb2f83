"""Harmonic balance by products alone, with as many harmonics as a motion needs, linear or with flanks that part.

Stiffness and forces are multiplied in time, flexibilities by orders, so hundreds of orders cost little; a start near the
quasi-static motion needs few steps at low speed. GMRES: Y. Saad, M. H. Schultz, GMRES: a generalized minimal residual
algorithm, SIAM J. Sci. Stat. Comput. 7 (1986). SciPy's solves one equation at a time, which for the thousand small equations of
a chart over speed takes ten times as long. SI units, frequencies circular (1/s).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcad.core.records import Complexes, Floats
from gearcad.dynamics.trains.steady_response import Driven, Flexibility, at_orders

_LOOK = 5
"""Steps after which the residual is looked at first; then after a quarter more."""


def solve_all(apply: Callable[[Floats], Floats], right: Floats, tolerance: float, most: int) -> tuple[Floats, Floats]:
    """Return x (s, d) with apply(x) = right (s, d), and the norms (s,) of the residuals.

    These are below `tolerance` unless `most` steps end the iteration. `apply` takes and returns (s, d): each row is a linear
    map of its own.
    """
    count, size = right.shape
    norms = np.linalg.norm(right, axis=1)
    if norms.max(initial=0.0) <= tolerance:
        return np.zeros_like(right), norms
    most = min(most, size)
    basis = np.empty((count, min(most, 4 * _LOOK) + 1, size))
    basis[:, 0] = _unit(right, norms)
    hessenberg = np.zeros((count, most + 1, most))
    look = _LOOK
    for step in range(most):
        if step + 1 == basis.shape[1]:
            basis = np.concatenate([basis, np.empty((count, min(step + 1, most - step), size))], axis=1)
        new = apply(basis[:, step])
        known = basis[:, : step + 1]
        # Twice: once leaves what rounding does to vectors that are nearly in the space already.
        for _ in range(2):
            parts = known @ new[:, :, None]
            new = new - (parts.transpose(0, 2, 1) @ known)[:, 0]
            hessenberg[:, : step + 1, step] += parts[:, :, 0]
        hessenberg[:, step + 1, step] = np.linalg.norm(new, axis=1)
        basis[:, step + 1] = _unit(new, hessenberg[:, step + 1, step])
        if step + 1 in (look, most):
            look += max(_LOOK, look // 4)
            weights, left = _least_squares(hessenberg[:, : step + 2, : step + 1], norms)
            if left.max() <= tolerance or step + 1 == most:
                return (weights[:, None] @ basis[:, : step + 1])[:, 0], left
    raise AssertionError("the last step returns")


def _unit(vectors: Floats, norms: Floats) -> Floats:
    return vectors / np.where(norms > 0, norms, 1.0)[:, None]


def _least_squares(hessenberg: Floats, norms: Floats) -> tuple[Floats, Floats]:
    """Return weights (s, j) of the basis, and the norms (s,) of their residuals."""
    q, r = np.linalg.qr(hessenberg)
    right = q[:, 0] * norms[:, None]
    diagonal = np.diagonal(r, axis1=1, axis2=2)
    # Where an equation was solved before the others its further steps are zero, and weigh nothing.
    dead = np.abs(diagonal) <= 1e-14 * np.abs(diagonal).max(axis=1, keepdims=True)
    r = r + np.where(dead, 1.0 - diagonal, 0.0)[:, :, None] * np.eye(r.shape[1])
    weights = np.linalg.solve(r, np.where(dead, 0.0, right)[:, :, None])[:, :, 0]
    left = (hessenberg @ weights[:, :, None])[:, :, 0]
    left[:, 0] -= norms
    return weights, np.linalg.norm(left, axis=1)


_TOLERANCE = 1e-6
"""Default tolerance of the balance, root mean square over the period, in static deflections."""

_MOST_STEPS = 250
"""Greatest number of steps of GMRES: 70 are usual where a thousand well damped vibrations fit between two teeth."""

_MOST_NEWTON, _MOST_RESTARTS = 12, 2
"""Steps of Newton's method where flanks part; where they do not, one is exact, and others begin GMRES anew."""

_ASTRAY = 0.1
"""Part of the static deflection by which more harmonics may change a motion; beyond it another motion was found."""

_NUMBERS = 12_000_000
"""Greatest count of numbers in memory for one block of speeds."""


@dataclass(frozen=True, eq=False)
class Motions:
    """Motions with one number of orders at frequencies of the common period `omega` (s,): coefficients of orders 0 ... 2
    `orders`.

    `approach` (s, q, m), and the `forces` (s, q, m) at the mean system that make it by its `flexible`. Orders up to `orders`
    are in balance, those beyond follow from the forces of these. `solved` (s,): whether the balance was found.
    """

    omega: Floats
    orders: int
    approach: Complexes
    forces: Complexes
    flexible: Flexibility
    solved: NDArray[np.bool_]

    def only(self, kept: NDArray[np.bool_]) -> Motions:
        """Return the motions that are marked (s,)."""
        if kept.all():
            return self
        flexible = Flexibility(self.flexible.mesh[kept], self.flexible.others[kept])
        return Motions(self.omega[kept], self.orders, self.approach[kept], self.forces[kept], flexible, self.solved[kept])


@dataclass(frozen=True, eq=False)
class Resolution(Driven):
    """The balance of the orders 0 ... `orders` of a System's common period. Meshes with a backlash may part."""

    orders: int
    tolerance: float = _TOLERANCE

    @property
    def samples(self) -> int:
        """Number of samples in time, so that no product of stiffness and motion is mistaken for one of lower order."""
        return 4 * self.orders * (2 if self.excitation.parting else 1)

    @cached_property
    def stiffness(self) -> Floats:
        """Mesh stiffness (t, m) in N/m, of the orders that the samples can resolve."""
        return self._course(self.excitation.ratio_coefficients(2 * self.orders - 1) * self.system.stiffness)

    @cached_property
    def driving(self) -> Floats:
        """Driving force k e (t, m) in N: the product of both as they are, then its orders."""
        fine = 2 ** int(np.ceil(np.log2(max(4 * self.samples, 1024 * max(self.excitation.orders)))))
        theta = 2 * np.pi * np.arange(fine) / fine
        product = self.excitation.ratios(theta) * self.system.stiffness * self.excitation.error_course(fine)
        return self._course(np.fft.rfft(product, axis=0)[: 2 * self.orders] / fine)

    @cached_property
    def rates(self) -> Complexes:
        """Coefficients (q, m) of c de/dtheta."""
        orders = np.arange(2 * self.orders + 1)[:, None]
        return self.excitation.error_coefficients(2 * self.orders) * 1j * orders * self.system.mesh_damping

    @cached_property
    def settled(self) -> Complexes:
        """Coefficients (q, m) of the quasi-static motion, in contact, with which every search begins."""
        static, varying = self.static, self.stiffness - self.system.stiffness
        matrix = np.eye(varying.shape[1]) + static.unit_mesh * varying[:, None, :]
        right = static.approach + self.driving @ static.unit_mesh.T
        course = np.asarray(np.linalg.solve(matrix, right[:, :, None])[:, :, 0], float)
        return self._spectrum(course)[: self.orders + 1]

    def solve(self, omega: Floats, start: Complexes | None = None) -> Iterator[Motions]:
        """Yield the motions at frequencies of the common period (s,), from coefficients (s, q, m) if given, block by block."""
        count, size = self.system.mesh.shape[1], self.system.size
        rows = count + self.system.inertias.shape[1] + self.system.shaft_torques.shape[1]
        block = max(1, _NUMBERS // (2 * (self.orders + 1) * (count * (60 + 2 * rows) + 2 * size)))
        for i in range(0, len(omega), block):
            yield self._solve(omega[i : i + block], None if start is None else start[i : i + block])

    def _solve(self, omega: Floats, start: Complexes | None) -> Motions:
        orders = np.arange(2 * self.orders + 1)
        flexible = at_orders(self.system, self.static, omega, orders)
        mesh = flexible.mesh[:, : self.orders + 1]
        own = np.zeros((len(omega), self.orders + 1, mesh.shape[2]), complex)
        known = self.orders + 1 if start is None else min(start.shape[1], self.orders + 1)
        pushed = self.pushed(omega, orders)
        inside = pushed.rows <= self.orders
        rows, moved = pushed.rows[inside], pushed.approach[:, inside]
        if start is None:
            own += self.settled
            own[:, rows] += moved
        else:
            own[:, :known] = start[:, :known]
        left = np.full(len(omega), np.inf)
        for _ in range(_MOST_NEWTON if self.excitation.parting else 1 + _MOST_RESTARTS):
            forces, slopes = self._forces(own, omega)
            residual = own - np.einsum("shij,shj->shi", mesh, forces[:, : self.orders + 1])
            residual[:, 0] -= self.static.approach
            residual[:, rows] -= moved
            left = np.linalg.norm(_real(residual), axis=1)
            if (left <= 2 * self.tolerance * self.scale).all():
                break
            own = own - self._correction(mesh, slopes, residual)
        solved = left <= 10 * self.tolerance * self.scale
        if start is not None:
            solved &= np.linalg.norm(_real(own[:, :known] - start[:, :known]), axis=1) <= _ASTRAY * self.scale
        return self._beyond(omega, flexible, own, solved)

    def motions(self, omega: Floats, approach: Complexes) -> Motions:
        """Return motions of coefficients (s, q, m) known otherwise, with the forces that belong to them; none is solved."""
        flexible = at_orders(self.system, self.static, omega, np.arange(2 * self.orders + 1))
        own = np.zeros((len(omega), self.orders + 1, approach.shape[2]), complex)
        known = min(approach.shape[1], self.orders + 1)
        own[:, :known] = approach[:, :known]
        return self._beyond(omega, flexible, own, np.zeros(len(omega), bool))

    def _correction(self, mesh: Complexes, slopes: Floats, residual: Complexes) -> Complexes:
        """Return Newton's step: (1 + G (slopes - K)) step = residual."""
        varying, shape = slopes - self.system.stiffness, residual.shape

        def apply(vectors: Floats) -> Floats:
            step = _coefficients(vectors, shape)
            pushed = self._spectrum(varying * self._course(step))[..., : shape[1], :]
            return _real(step + np.einsum("shij,shj->shi", mesh, pushed))

        found, _ = solve_all(apply, _real(residual), 0.5 * self.tolerance * self.scale, _MOST_STEPS)
        return _coefficients(found, shape)

    def _beyond(self, omega: Floats, flexible: Flexibility, own: Complexes, solved: NDArray[np.bool_]) -> Motions:
        forces, _ = self._forces(own, omega)
        approach = np.einsum("shij,shj->shi", flexible.mesh, forces)
        if self.excitation.torques:
            pushed = self.pushed(omega, np.arange(2 * self.orders + 1))
            approach[:, pushed.rows] += pushed.approach
        approach[:, : self.orders + 1] = own
        return Motions(omega, self.orders, approach, forces, flexible, solved)

    def _forces(self, own: Complexes, omega: Floats) -> tuple[Complexes, Floats]:
        """Return K y - N(y) + c e' (s, 2q - 1, m) at the mean system, in N, and the slopes (..., t, m) of the tooth forces."""
        course = self._course(own)
        slopes = self.stiffness
        carried = self.stiffness * course - self.driving
        if self.excitation.parting:
            # By forces, not gaps: orders that samples cannot tell would let them jump where flanks touch.
            pressing, backlash = self.senses * carried, self.excitation.backlashes
            behind = np.minimum(pressing + self.stiffness * backlash, 0.0)
            apart = (pressing <= 0) & ~(behind < 0) & ~np.isnan(backlash)
            carried = np.where(np.isnan(backlash), carried, self.senses * (np.maximum(pressing, 0.0) + behind))
            slopes = np.where(apart, 0.0, self.stiffness)
        forces = self._spectrum(self.system.stiffness * course - carried)[..., : 2 * self.orders + 1, :]
        return forces + omega[:, None, None] * self.rates, slopes

    def _course(self, coefficients: Complexes) -> Floats:
        """Return courses (..., t, m) of coefficients (..., q, m)."""
        padded = np.zeros((*coefficients.shape[:-2], self.samples // 2 + 1, coefficients.shape[-1]), complex)
        padded[..., : coefficients.shape[-2], :] = coefficients
        return np.asarray(np.fft.irfft(padded, self.samples, axis=-2, norm="forward"), float)

    def _spectrum(self, course: Floats) -> Complexes:
        return np.asarray(np.fft.rfft(course, axis=-2, norm="forward"), complex)


def _real(coefficients: Complexes) -> Floats:
    """Return coefficients (s, q, m) as real vectors (s, 2qm), whose norm is the root mean square of the course."""
    weighted = coefficients * np.where(np.arange(coefficients.shape[1]) == 0, 1.0, np.sqrt(2))[:, None]
    return np.asarray(weighted.reshape(len(coefficients), -1).view(float), float)


def _coefficients(vectors: Floats, shape: tuple[int, ...]) -> Complexes:
    """Return the coefficients (s, q, m) of which `_real` makes these vectors (s, 2qm)."""
    weighted = np.ascontiguousarray(vectors).view(complex).reshape(shape)
    return np.asarray(weighted / np.where(np.arange(shape[1]) == 0, 1.0, np.sqrt(2))[:, None], complex)
