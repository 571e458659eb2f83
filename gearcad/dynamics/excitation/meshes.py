"""What makes a train vibrate: mesh stiffness that changes from tooth to tooth, transmission errors, and the backlash.

Inputs in µm and degrees; what solvers take from them is in SI units, over the phase theta of the common period (rad).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import numpy as np

from gearcad.arrays import Complexes, Floats
from gearcad.dynamics.excitation.deviations import TransmissionError
from gearcad.dynamics.excitation.mesh_curves import StiffnessShape, cycle_phase, cycle_stiffness
from gearcad.dynamics.excitation.polyline import Polyline
from gearcad.dynamics.trains.system import System
from gearcad.errors import GeometryError, ParameterError, plain_numbers, require_number
from gearcad.mesh_cycle import MeshCycle

__all__ = ["Excitation", "MeshExcitation", "cycle_excitation"]


_MICRO = 1e-6


@dataclass(frozen=True, kw_only=True)
class MeshExcitation:
    """Of one mesh: the shape of its stiffness, its phase (deg, 360 a tooth), its transmission error and its backlash.

    `frequency_ratio` is its tooth frequency over that of the first mesh: z3/z2 for the second stage of a train. `backlash` (µm)
    is the clearance along the line of action between the flanks at the back: `None` where flanks never part (a linear mesh),
    `math.inf` where they part but never meet at the back.
    """

    stiffness: StiffnessShape
    phase: float = 0.0
    frequency_ratio: Fraction = Fraction(1)
    error: TransmissionError | None = None
    backlash: float | None = None

    def __post_init__(self) -> None:
        ratio = self.frequency_ratio
        if not isinstance(ratio, Fraction | int) or ratio <= 0:
            raise ParameterError("frequency_ratio", str(ratio), "must be a Fraction of tooth numbers above 0")
        plain_numbers(self)
        # A Fraction is exact: not one of the numbers that become floats.
        object.__setattr__(self, "frequency_ratio", Fraction(ratio))
        require_number("phase", self.phase, "deg")
        if self.backlash is not None and self.backlash != math.inf:
            require_number("backlash", self.backlash, "µm", at_least=0)

    @property
    def lead(self) -> float:
        """The phase in rad."""
        return math.radians(self.phase)


def cycle_excitation(
    cycle: MeshCycle, *, phase: float = 0.0, backlash: float | None = None, tangent: bool = True
) -> MeshExcitation:
    """Stiffness and transmission error of a MeshCycle; the mean stiffness of the mesh is its `tangent_mean` (or `mean`).

    The error is what is left of the loaded one without F/k: so at rest under the torque of the cycle the flanks approach
    each other by just the cycle's transmission error, modifications and nonlinear contact with it. Phase 0 is roll angle 0.
    """
    shape = cycle_stiffness(cycle, tangent=tangent)
    mean = cycle.tangent_mean if tangent else cycle.mean
    # Steps of the stiffness come again in it and take each other off where nothing vibrates: it must be as sharp as these.
    free = cycle.transmission_error - cycle.force / (mean * shape.stiffness)
    error = TransmissionError(line=Polyline(phase=cycle_phase(cycle), height=free))
    return MeshExcitation(stiffness=shape, phase=phase, error=error, backlash=backlash)


@dataclass(frozen=True, kw_only=True)
class Excitation:
    """Of all meshes of a system, in its order. `orders` says how many teeth of each mesh pass in the common period."""

    meshes: tuple[MeshExcitation, ...]

    def __post_init__(self) -> None:
        if not self.meshes:
            raise ParameterError("meshes", 0, "must be at least one mesh")
        # More teeth than this before everything comes again: the ratio is as good as irrational for a periodic solution.
        if max(self.orders) > 20_000:
            raise GeometryError(
                "frequency_ratio", max(self.orders), "must let all meshes come again within 20000 teeth", "teeth"
            )

    @cached_property
    def orders(self) -> tuple[int, ...]:
        """Tooth frequency of each mesh over the frequency of the common period."""
        periods = [(mesh.error.teeth if mesh.error else 1) / mesh.frequency_ratio for mesh in self.meshes]
        common = Fraction(math.lcm(*(each.numerator for each in periods)), math.gcd(*(each.denominator for each in periods)))
        return tuple(int(common * mesh.frequency_ratio) for mesh in self.meshes)

    @property
    def fundamental(self) -> float:
        """Frequency of the common period over the tooth frequency of the first mesh."""
        return 1 / self.orders[0]

    @property
    def parting(self) -> bool:
        """Whether any flanks may part."""
        return any(mesh.backlash is not None for mesh in self.meshes)

    @property
    def bonded(self) -> Excitation:
        """The same with flanks that never part."""
        return Excitation(meshes=tuple(replace(mesh, backlash=None) for mesh in self.meshes))

    def fits(self, system: System) -> None:
        """Raise ParameterError unless there is one mesh for each of the system's, of positive mean stiffness."""
        if len(self.meshes) != len(system.stiffness):
            raise ParameterError("meshes", len(self.meshes), f"must be as many as the system has: {len(system.stiffness)}")
        if not np.isfinite(system.stiffness).all() or system.stiffness.min() <= 0:
            raise ParameterError("mesh_stiffness", float(system.stiffness.min() * _MICRO), "must be above 0 N/µm", "N/µm")

    # ------------------------------------------------------------------ over the common period

    def ratios(self, theta: Floats) -> Floats:
        """Stiffness of each mesh over its mean (..., m) at phases of the common period (...)."""
        return np.stack([mesh.stiffness.values(q * theta + mesh.lead) for mesh, q in self._each()], axis=-1)

    def ratio_coefficients(self, count: int) -> Complexes:
        """Their Fourier coefficients (count + 1, m) over the common period."""
        result = np.zeros((count + 1, len(self.meshes)), complex)
        for j, (mesh, q) in enumerate(self._each()):
            own = mesh.stiffness.coefficients(count // q)
            result[: q * len(own) : q, j] = own * np.exp(1j * mesh.lead * np.arange(len(own)))
        return result

    def errors(self, theta: Floats) -> Floats:
        """Transmission error of each mesh (..., m) in m."""
        return self._errors(theta, slopes=False)

    def error_course(self, count: int) -> Floats:
        """Transmission errors (count, m) in m at even steps over the common period; those of many teeth much quicker."""
        return self._course(count, slopes=False)

    def error_slope_course(self, count: int) -> Floats:
        """Their derivatives with respect to theta (count, m), in m/rad."""
        return self._course(count, slopes=True)

    def _course(self, count: int, *, slopes: bool) -> Floats:
        theta = 2 * np.pi * np.arange(count) / count
        columns = np.zeros((count, len(self.meshes)))
        for j, (mesh, q) in enumerate(self._each()):
            if mesh.error is None:
                continue
            line, step = mesh.error.line, q // mesh.error.teeth
            # Orders that the steps cannot tell are left away.
            orders = np.arange(min(len(mesh.error.coefficients), (count // 2 - 1) // step + 1))
            waves = mesh.error.coefficients[: len(orders)] * np.exp(1j * mesh.lead * orders / mesh.error.teeth)
            spectrum = np.zeros(count // 2 + 1, complex)
            spectrum[step * orders] = waves * (1j * step * orders if slopes else 1.0)
            columns[:, j] = np.fft.irfft(spectrum, count, norm="forward")
            if line is not None:
                phase = q * theta + mesh.lead
                columns[:, j] += q * line.slopes(phase) if slopes else line.values(phase)
        return _MICRO * columns

    def error_slopes(self, theta: Floats) -> Floats:
        """Its derivative with respect to theta (..., m), in m/rad."""
        return self._errors(theta, slopes=True)

    def error_coefficients(self, count: int) -> Complexes:
        """Fourier coefficients (count + 1, m) of the transmission errors over the common period, in m."""
        result = np.zeros((count + 1, len(self.meshes)), complex)
        for j, (mesh, q) in enumerate(self._each()):
            if mesh.error is None:
                continue
            step = q // mesh.error.teeth
            own = mesh.error.orders(count // step)
            result[: step * len(own) : step, j] = _MICRO * own * np.exp(1j * mesh.lead * np.arange(len(own)) / mesh.error.teeth)
        return result

    @cached_property
    def backlashes(self) -> Floats:
        """Clearance at the back (m,) in m; nan for meshes whose flanks never part."""
        return np.array([math.nan if mesh.backlash is None else mesh.backlash * _MICRO for mesh in self.meshes])

    @cached_property
    def jumps(self) -> Floats:
        """Phases of the common period, from 0 to 2 pi, where the stiffness of any mesh jumps."""
        found = [
            np.mod((jump - mesh.lead + 2 * np.pi * np.arange(q)) / q, 2 * np.pi)
            for mesh, q in self._each()
            for jump in mesh.stiffness.jumps
        ]
        return np.unique(np.concatenate(found)) if found else np.zeros(0)

    def _each(self) -> list[tuple[MeshExcitation, int]]:
        return list(zip(self.meshes, self.orders, strict=True))

    def _errors(self, theta: Floats, *, slopes: bool) -> Floats:
        columns = []
        for mesh, q in self._each():
            if mesh.error is None:
                columns.append(np.zeros(np.shape(theta)))
                continue
            phase = q * theta + mesh.lead
            columns.append(_MICRO * (q * mesh.error.slopes(phase) if slopes else mesh.error.values(phase)))
        return np.stack(columns, axis=-1)
