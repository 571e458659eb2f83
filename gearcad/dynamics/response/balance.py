"""The equations of harmonic balance of a train whose flanks part, and Newton's method on them. SI units.

What the teeth carry is found in time and taken back to orders by FFT, its derivative likewise, so the Jacobian is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools, Complexes, Floats, Indices
from gearcad.dynamics.response.driven import Driven, pressed
from gearcad.dynamics.response.flexibility import at_orders, both_sides

__all__ = ["TOLERANCE", "Balance", "real_course"]


_MOST_NEWTON = 30
_BLOCK = 1_000_000
"""Complex numbers that the derivatives of one block of motions may have."""

TOLERANCE = 1e-10
"""Last step of Newton's method, in static deflections."""


@dataclass(frozen=True, eq=False)
class Balance(Driven):
    """The equations y - y_static - G (K y - N(y) + c e') = 0 of all orders, N what the teeth carry. Orders are signed here."""

    orders: Indices

    @cached_property
    def signed(self) -> Indices:
        """(2q - 1,): the orders on both sides of 0."""
        return np.concatenate([-self.orders[:0:-1], self.orders])

    @cached_property
    def count(self) -> int:
        """Samples in time: products of the highest orders must not be mistaken for lower ones."""
        return int(max(256, 2 ** int(np.ceil(np.log2(8 * max(int(self.orders[-1]), 1))))))

    @cached_property
    def stiffness(self) -> Floats:
        """(t, m) in N/m, without the orders that the samples cannot tell."""
        coefficients = self.excitation.ratio_coefficients(self.count // 2 - 1) * self.system.stiffness
        return np.asarray(np.fft.irfft(coefficients * self.count, self.count, axis=0), float)

    @cached_property
    def errors(self) -> Floats:
        """Transmission errors (t, m) in m at the samples."""
        return self.excitation.errors(2 * np.pi * np.arange(self.count) / self.count)

    @cached_property
    def error_rates(self) -> Complexes:
        """(q, m): coefficients of c de/dtheta."""
        half = self.excitation.error_coefficients(int(self.orders[-1]))[self.orders]
        return np.asarray(both_sides(half[None])[0] * 1j * self.signed[:, None] * self.system.mesh_damping, complex)

    def gaps(self, approach: Complexes) -> Floats:
        """y - e (..., t, m) in m."""
        spectrum = np.zeros((*approach.shape[:-2], self.count, approach.shape[-1]), complex)
        spectrum[..., self.signed, :] = approach
        return np.asarray(np.fft.ifft(spectrum, axis=-2).real * self.count - self.errors, float)

    def slopes(self, approach: Complexes) -> Floats:
        """k(t) g'(y - e) (..., t, m) in N/m."""
        gap, backlash = self.senses * self.gaps(approach), self.excitation.backlashes
        apart = (gap <= 0) & ~(gap <= -backlash) & ~np.isnan(backlash)
        return np.asarray(np.where(apart, 0.0, self.stiffness), float)

    def forces(self, approach: Complexes, omega: Floats | float) -> tuple[Complexes, Complexes]:
        """K y - N(y) + c e' (..., q, m), and its derivative with respect to omega."""
        carried = self.stiffness * pressed(self.gaps(approach), self.excitation.backlashes, self.senses)
        spectrum = np.fft.fft(carried, axis=-2)[..., self.signed, :] / self.count
        rate = self.error_rates
        return approach * self.system.stiffness - spectrum + np.asarray(omega)[..., None, None] * rate, rate

    def equations(self, approach: Complexes, omega: float) -> tuple[Complexes, Complexes, Complexes]:
        """Residual (qm,), its derivatives (qm, qm) with respect to the approach and (qm,) to omega."""
        residual, jacobian, forces, mesh = self._linearised(approach[None], np.array([omega]))
        step = 1e-6 * omega
        beside = both_sides(at_orders(self.system, self.static, omega + np.array([step, -step]), self.orders).mesh)
        bend = (beside[0] - beside[1]) / (2 * step)
        with_omega = -np.einsum("hij,hj->hi", bend, forces[0]) - np.einsum("hij,hj->hi", mesh[0], self.error_rates)
        return residual[0], jacobian[0], with_omega.ravel()

    def _linearised(self, approach: Complexes, omega: Floats) -> tuple[Complexes, Complexes, Complexes, Complexes]:
        """Of motions (s, q, m): residuals (s, qm), derivatives (s, qm, qm), forces (s, q, m), flexibilities (s, q, m, m)."""
        mesh = both_sides(at_orders(self.system, self.static, omega, self.orders).mesh)
        forces = self.forces(approach, omega)[0]
        residual = approach - np.einsum("shij,shj->shi", mesh, forces)
        residual[:, len(self.orders) - 1] -= self.static.approach
        spectrum = np.fft.fft(self.slopes(approach), axis=-2) / self.count
        spectrum[:, 0] -= self.system.stiffness
        coupling = spectrum[:, np.mod(self.signed[:, None] - self.signed, self.count)]
        size = residual[0].size
        jacobian = np.eye(size) + np.einsum("shij,shlj->shilj", mesh, coupling).reshape(-1, size, size)
        return residual.reshape(-1, size), jacobian, forces, mesh

    def solve(self, approach: Complexes, omega: Floats) -> tuple[Complexes, Bools]:
        """The motions (s, q, m) at frequencies (s,), by Newton's method from near ones; and for which of them it converges."""
        approach, found = np.array(approach), np.zeros(len(omega), bool)
        block = max(1, _BLOCK // approach[0].size ** 2) if len(omega) else 1
        for i in range(0, len(omega), block):
            self._newton(approach, omega, found, np.arange(i, min(i + block, len(omega))))
        return approach, found

    def _newton(self, approach: Complexes, omega: Floats, found: Bools, rows: Indices) -> None:
        """Newton's steps for some rows of the motions, in place; `found` tells for which they come to rest."""
        for _ in range(_MOST_NEWTON):
            residual, jacobian, *_ = self._linearised(approach[rows], omega[rows])
            change = np.linalg.solve(jacobian, residual[:, :, None]).reshape(len(rows), *approach.shape[1:])
            approach[rows] = real_course(approach[rows] - change)
            largest = np.abs(change).max(axis=(1, 2))
            done = largest <= TOLERANCE * self.scale
            found[rows[done]] = True
            rows = rows[~done & np.isfinite(largest)]
            if not len(rows):
                return


def real_course(approach: Complexes) -> Complexes:
    """Coefficients (..., q, m) of signed orders without what rounding adds and no real motion has: it would grow."""
    return np.asarray((approach + approach[..., ::-1, :].conj()) / 2, complex)
