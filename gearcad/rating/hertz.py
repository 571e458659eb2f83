"""Hertz's line contact: two cylinders pressed together along a line (K. L. Johnson, Contact Mechanics, 1985, chapter 4).

z is the depth below the surface, x lies across the line of contact and y along it; the bodies are in plane strain.
Stresses are given on the axis of symmetry x = 0, where they are principal stresses; tension is positive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from gearcad.arrays import Floats
from gearcad.errors import plain_numbers, require_number

__all__ = [
    "LineContact",
    "Peak",
    "Stresses",
    "half_width",
    "half_width_by_curvature",
    "peak_pressure",
    "reduced_modulus",
    "reduced_radius",
]

Size = TypeVar("Size", float, Floats)

_GOLDEN = (math.sqrt(5) - 1) / 2


class Peak(NamedTuple):
    """The greatest value of a stress on the axis of symmetry (MPa), and the depth (mm) where it occurs."""

    depth: float
    value: float


@dataclass(frozen=True, eq=False)
class Stresses:
    """Stresses on the axis of symmetry at `depth` (mm), in MPa: read-only arrays of one shape."""

    depth: Floats
    sigma_x: Floats
    sigma_y: Floats
    sigma_z: Floats
    largest_shear: Floats
    von_mises: Floats


def reduced_modulus(youngs_moduli: tuple[float, float], poisson_ratios: tuple[float, float]) -> float:
    """E* of two bodies in plane strain (MPa): 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2 (Johnson, before 4.21)."""
    flexibility = [(1 - nu**2) / modulus for modulus, nu in zip(youngs_moduli, poisson_ratios, strict=True)]
    return 1 / sum(flexibility)


def reduced_radius(radii: tuple[float, float]) -> float:
    """R of two cylinders (mm): 1/R = 1/R_1 + 1/R_2 (Johnson, before 4.21); the radius of a hollow one is negative."""
    return radii[0] * radii[1] / (radii[0] + radii[1])


def half_width(load_per_width: Size, radius: Size, modulus: float) -> Size:
    """a (mm): a^2 = 4 P R/(pi E*) (Johnson 4.43). Numbers, or arrays of one shape."""
    result: Size = np.sqrt(4 * load_per_width * radius / (math.pi * modulus))
    return result


def half_width_by_curvature(load_per_width: float, curvature: float, modulus: float) -> float:
    """The same by the relative curvature 1/R (1/mm); infinite where one surface is hollower than the other is round."""
    return math.sqrt(4 * load_per_width / (math.pi * modulus * curvature)) if curvature > 0 else math.inf


def peak_pressure(load_per_width: Size, radius: Size, modulus: float) -> Size:
    """p_0 (MPa) in the middle of the contact: sqrt(P E*/(pi R)) = 2 P/(pi a) (Johnson 4.45). Numbers, or arrays."""
    result: Size = np.sqrt(load_per_width * modulus / (math.pi * radius))
    return result


@dataclass(frozen=True, kw_only=True)
class LineContact:
    """Two cylinders under a load per length of their line of contact.

    `load_per_width` P in N/mm, `radius` R the reduced radius of curvature in mm, `modulus` E* the reduced modulus in MPa,
    `poisson_ratio` that of the body whose stresses are wanted. Raises ParameterError.
    """

    load_per_width: float
    radius: float
    modulus: float
    poisson_ratio: float = 0.3

    def __post_init__(self) -> None:
        plain_numbers(self)
        require_number("load_per_width", self.load_per_width, "N/mm", above=0)
        require_number("radius", self.radius, "mm", above=0)
        require_number("modulus", self.modulus, "MPa", above=0)
        require_number("poisson_ratio", self.poisson_ratio, at_least=0, at_most=0.5)

    @property
    def half_width(self) -> float:
        """a (mm)."""
        return float(half_width(self.load_per_width, self.radius, self.modulus))

    @property
    def peak_pressure(self) -> float:
        """p_0 (MPa) in the middle of the contact."""
        return float(peak_pressure(self.load_per_width, self.radius, self.modulus))

    def pressure(self, x: ArrayLike) -> Any:
        """Pressure (MPa) at `x` (mm) from the middle: p_0 sqrt(1 - x^2/a^2), 0 outside (Johnson 4.44). Scalar or array."""
        across = np.asarray(x, float) / self.half_width
        found = self.peak_pressure * np.sqrt(np.clip(1 - across**2, 0, None))
        return float(found) if found.ndim == 0 else found

    def stresses(self, depth: ArrayLike) -> Stresses:
        """Stresses on the axis of symmetry at `depth` (mm, 0 or more; scalar or array). Raises ParameterError.

        sigma_z = -p_0 a/s and sigma_x = -p_0 ((a^2 + 2 z^2)/(a s) - 2 z/a) with s = sqrt(a^2 + z^2) (Johnson 4.46),
        the latter written as -p_0 a^3/(s (s + z)^2), which keeps its digits at any depth; sigma_y = nu (sigma_x + sigma_z).
        """
        z = np.array(depth, float)
        if not np.all(z >= 0):
            require_number("depth", float(np.min(z)), "mm", at_least=0)
        a, p_0 = self.half_width, self.peak_pressure
        s = np.hypot(a, z)
        sigma_z = -p_0 * a / s
        sigma_x = -p_0 * a**3 / (s * (s + z) ** 2)
        sigma_y = self.poisson_ratio * (sigma_x + sigma_z)
        # Nowhere on the axis is another stress below sigma_z.
        shear = (np.maximum(sigma_x, sigma_y) - sigma_z) / 2
        squares = (sigma_x - sigma_y) ** 2 + (sigma_y - sigma_z) ** 2 + (sigma_z - sigma_x) ** 2
        arrays = [np.asarray(found) for found in (z, sigma_x, sigma_y, sigma_z, shear, np.sqrt(squares / 2))]
        for array in arrays:
            array.flags.writeable = False
        return Stresses(*arrays)

    @property
    def greatest_shear(self) -> Peak:
        """The largest shear stress on the axis: 0.30028 p_0 at 0.78615 a for steel (Johnson 4.48: 0.30 p_0 at 0.78 a).

        With z = a sinh t the shear in the plane x-z is p_0 sinh t e^-t/cosh t, greatest where tanh t is the golden
        section. That in the plane y-z, p_0 (1/cosh t - 2 nu e^-t)/2, exceeds it for nu below 0.24.
        """
        nu = self.poisson_ratio
        in_section = math.atanh(_GOLDEN)
        b = 1 + 2 * nu
        along = math.log((b + math.sqrt(b**2 + 4 * nu * (1 - nu))) / (2 * (1 - nu))) / 2
        return self._greatest("largest_shear", (in_section, along))

    @property
    def greatest_von_mises(self) -> Peak:
        """The largest von Mises stress on the axis: 0.55752 p_0 at 0.70429 a for nu = 0.3.

        With z = a sinh t and T = tanh t it is p_0 e^-t sqrt((1 - 2 nu)^2 + 3 T^2), stationary where
        3 T^3 + 3 T^2 - 3 T + (1 - 2 nu)^2 = 0; for nu up to 0.19 it is greatest at the surface, (1 - 2 nu) p_0.
        """
        roots = np.roots([3, 3, -3, (1 - 2 * self.poisson_ratio) ** 2])
        inside = [float(root.real) for root in roots if abs(root.imag) < 1e-9 and 0 < root.real < 1]
        return self._greatest("von_mises", (0.0, *(math.atanh(root) for root in inside)))

    def _greatest(self, name: str, candidates: tuple[float, ...]) -> Peak:
        """The largest value of one of the `stresses` among the candidates t = arsinh(z/a)."""
        found = self.stresses(self.half_width * np.sinh(candidates))
        values = getattr(found, name)
        best = int(np.argmax(values))
        return Peak(float(found.depth[best]), float(values[best]))
