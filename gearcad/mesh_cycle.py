"""MeshCycle: the mesh stiffness of a pair over one base pitch, by any method, and the values derived from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import SolverError, require_whole
from gearcad.core.records import Floats, JsonObject, Notice, Pictured, texts

__all__ = ["FourierSeries", "MeshCycle"]

_TELLING = 1e-3
"""Share of the compliance below which a part of it is not significant."""


class FourierSeries(NamedTuple):
    """K(phi) = mean + sum_n (cosine_n cos n z phi + sine_n sin n z phi), phi the pinion's roll angle; all in N/µm."""

    mean: float
    cosine: Floats
    sine: Floats

    @property
    def amplitude(self) -> Floats:
        """Amplitude of each harmonic (N/µm)."""
        return np.hypot(self.cosine, self.sine)

    def to_dict(self) -> JsonObject:
        """Return the series as `stiffness.json` has it."""
        return {
            "mean": self.mean,
            "cosine": self.cosine.tolist(),
            "sine": self.sine.tolist(),
            "amplitude": self.amplitude.tolist(),
        }


@dataclass(frozen=True, kw_only=True)
class MeshCycle(Pictured):
    """Mesh stiffness of a pair over one base pitch, along the line of action in the transverse section.

    `roll_angle` (n,) in degrees of the pinion, 0 at the pitch point of the middle pair, rises over exactly one base pitch; both
    ends belong to it, and where the stiffness jumps the angle stands twice, with the values on both sides. `mesh_stiffness`
    (n,) is the secant F/delta, `tangent_stiffness` (n,) dF/ddelta at the load, in N/µm for the `width` (mm) in contact.
    `load_share` (n, m) is that of each of `pairs`, counted by the pinion's teeth, 0 the middle one. `compliance_parts` (n,) in
    µm/N sum up to 1/mesh_stiffness. `transmission_error` (n,) in µm is the wheel's lag along the line of action, `force` (N)
    what presses it there. `single_stiffness` (N/µm) is the greatest of one pair of teeth alone. `mean_only`: the
    method knows no course over the mesh, and the arrays hold its mean. `holds` names the compliances that it contains,
    `notices` what to know before trusting the method with this pair.
    """

    method: str
    holds: tuple[str, ...]
    torque: float
    force: float
    width: float
    roll_angle: Floats
    mesh_stiffness: Floats
    tangent_stiffness: Floats
    transmission_error: Floats
    pairs: tuple[int, ...] = ()
    load_share: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    compliance_parts: Mapping[str, Floats] = field(default_factory=dict)
    single_stiffness: float | None = None
    mean_only: bool = False
    notices: tuple[Notice, ...] = ()

    def __repr__(self) -> str:
        return f"<MeshCycle by {self.method} at {self.torque:g} N·m: {self.mean:.4g} N/µm, {len(self.roll_angle)} roll angles>"

    def __post_init__(self) -> None:
        arrays = [self.roll_angle, self.mesh_stiffness, self.tangent_stiffness, self.transmission_error]
        arrays += [self.load_share, *self.compliance_parts.values()]
        if not all(np.isfinite(array).all() for array in arrays) or self.mesh_stiffness.min() <= 0:
            raise SolverError(f"the mesh stiffness by method {self.method} has no positive value at some roll angles")
        for array in arrays:
            array.flags.writeable = False

    @property
    def notes(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    # ------------------------------------------------------------------ figures

    @cached_property
    def weights(self) -> Floats:
        """Weights (n,), of sum 1, that make the mean over the base pitch of any quantity of the cycle.

        Simpson's rule from jump to jump; the trapezoidal rule, which for a periodic curve is better still, where there is none.
        """
        angle = self.roll_angle
        cuts = [0, *(np.flatnonzero(np.diff(angle) == 0) + 1).tolist(), len(angle)]
        weights = np.zeros(len(angle))
        for start, end in pairwise(cuts):
            steps = np.diff(angle[start:end])
            if len(cuts) > 2 and len(steps) % 2 == 0 and np.allclose(steps, steps[0], rtol=1e-6):
                weights[start:end] = steps[0] / 3 * np.r_[1, np.tile([4, 2], len(steps) // 2 - 1), 4, 1]
            else:
                weights[start : end - 1] += steps / 2
                weights[start + 1 : end] += steps / 2
        result: Floats = weights / weights.sum()
        return result

    @property
    def mean(self) -> float:
        """Mean of the secant stiffness (N/µm)."""
        return float(self.weights @ self.mesh_stiffness)

    @property
    def tangent_mean(self) -> float:
        """Mean of the tangent stiffness (N/µm)."""
        return float(self.weights @ self.tangent_stiffness)

    @property
    def maximum(self) -> float:
        """Greatest secant stiffness (N/µm)."""
        return float(self.mesh_stiffness.max())

    @property
    def minimum(self) -> float:
        """Least secant stiffness (N/µm)."""
        return float(self.mesh_stiffness.min())

    @property
    def pitch_point(self) -> float:
        """Secant stiffness where the middle pair touches at the pitch point (N/µm)."""
        return float(self.stiffness_at(0.0))

    @property
    def secant_per_width(self) -> float:
        """Mean secant stiffness per face width (N/(mm·µm)): C_y_beta of ISO 6336-1."""
        return self.mean / self.width

    @property
    def tangent_per_width(self) -> float:
        """Mean tangent stiffness per face width (N/(mm·µm)): C_y_alpha of ISO 6336-1."""
        return self.tangent_mean / self.width

    @property
    def error_peak_to_peak(self) -> float:
        """Peak-to-peak transmission error over the cycle (µm)."""
        return float(np.ptp(self.transmission_error))

    def mean_of(self, values: Floats) -> float:
        """Return the mean over the base pitch of values (n,) of the cycle."""
        return float(self.weights @ values)

    def part_share(self, part: str) -> float:
        """Return the mean share of a part in the compliance (1 is 100 %)."""
        return self.mean_of(self.compliance_parts[part] * self.mesh_stiffness)

    @property
    def telling_parts(self) -> dict[str, Floats]:
        """Parts that are more than a thousandth of the compliance somewhere (µm/N)."""
        whole = 1 / self.mesh_stiffness
        return {name: part for name, part in self.compliance_parts.items() if (np.abs(part) > _TELLING * whole).any()}

    # ------------------------------------------------------------------ the curve

    @property
    def pitch_angle(self) -> float:
        """Roll angle of the pinion over one base pitch (deg)."""
        return float(self.roll_angle[-1] - self.roll_angle[0])

    @property
    def backwards(self) -> MeshCycle:
        """Cycle for a driving wheel: contact moves from tip to root of the pinion."""
        curves = {name: getattr(self, name)[::-1] for name in ("mesh_stiffness", "tangent_stiffness", "transmission_error")}
        parts = {name: part[::-1] for name, part in self.compliance_parts.items()}
        shares = self.load_share[::-1]
        return replace(self, roll_angle=-self.roll_angle[::-1], load_share=shares, compliance_parts=parts, **curves)

    def stiffness_at(self, roll_angle: ArrayLike, *, tangent: bool = False) -> Floats:
        """Return the secant (or tangent) stiffness (N/µm) at any roll angles (degrees); the curve is periodic."""
        values = self.tangent_stiffness if tangent else self.mesh_stiffness
        start = self.roll_angle[0]
        within = np.mod(np.asarray(roll_angle, float) - start, self.pitch_angle) + start
        result: Floats = np.interp(within, self.roll_angle, values)
        return result

    def fourier(self, harmonics: int = 10, *, tangent: bool = False) -> FourierSeries:
        """Return the first `harmonics` of the tooth frequency. Raises ParameterError for more than the curve can tell."""
        require_whole("harmonics", harmonics, at_least=1, at_most=max(1, (len(self.roll_angle) - 1) // 4))
        values = self.tangent_stiffness if tangent else self.mesh_stiffness
        turns = np.arange(1, harmonics + 1)[:, None] * (2 * np.pi * self.roll_angle / self.pitch_angle)
        weighted = 2 * self.weights * values
        return FourierSeries(float(self.weights @ values), np.cos(turns) @ weighted, np.sin(turns) @ weighted)

    def to_dict(self) -> JsonObject:
        """Return figures and curves as `stiffness.json` has them: N/µm, µm/N, µm, degrees; per face width N/(mm·µm)."""
        course: dict[str, Any] = (
            {}
            if self.mean_only
            else {
                "maximum": self.maximum,
                "minimum": self.minimum,
                "pitch_point": self.pitch_point,
                "transmission_error_peak_to_peak": self.error_peak_to_peak,
            }
        )
        return {
            "holds": list(self.holds),
            "width": self.width,
            "torque": self.torque,
            "force": self.force,
            "mean": self.mean,
            **course,
            "single_stiffness": self.single_stiffness,
            "tangent_mean": self.tangent_mean,
            "c_gamma_beta": self.secant_per_width,
            "c_gamma_alpha": self.tangent_per_width,
            "mean_only": self.mean_only,
            "notes": list(self.notes),
            "notices": [notice.to_dict() for notice in self.notices],
            "mesh_cycle": {
                "roll_angle": self.roll_angle.tolist(),
                "mesh_stiffness": self.mesh_stiffness.tolist(),
                "tangent_stiffness": self.tangent_stiffness.tolist(),
                "transmission_error": self.transmission_error.tolist(),
                "pairs": list(self.pairs),
                "load_share": self.load_share.tolist(),
                "compliance_parts": {name: part.tolist() for name, part in self.compliance_parts.items()},
            },
        }
