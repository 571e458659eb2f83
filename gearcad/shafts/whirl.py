"""Whirling of shafts in bending: natural frequencies and critical speeds, with consistent masses and gyroscopic moments.

Bearings are alike in all directions, so both planes are one complex plane: K + omega Omega G - omega^2 M is singular, omega
positive for forward whirl and negative for backward whirl (Friswell et al., Dynamics of Rotating Machines, 5.4). Inside
formulas N, mm, t and s.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, NamedTuple

import numpy as np

from gearcad.core.quantities import Range, Words, require_fields
from gearcad.core.records import Floats, JsonObject, concise
from gearcad.shafts.beam import ShaftSegment, SteppedShaft

_TONNES = 1e-12
"""t/mm³ of a density of 1 kg/m³."""

_MASS, _INERTIA = 1e-3, 1e3
"""t of 1 kg, and t mm² of 1 kg m²."""

_FEWEST_PARTS = 48
"""Parts of a shaft, at least: of a bar six diameters long the first critical speed is then 1e-5 too high, the third 5e-4."""

_SHOWN = 3
"""Critical speeds and frequencies of each sense in documents."""


@dataclass(frozen=True, kw_only=True)
class ShaftDisc:
    """A rigid disc on a shaft, such as a gear: mass (kg), moments of inertia (kg·m²) about the axis and across it."""

    position: Annotated[float, Range("mm", 0, 1e7), Words("position of the disc")]
    mass: Annotated[float, Range("kg", 0, 1e9), Words("mass of the disc")]
    polar_inertia: Annotated[float, Range("kg·m²", 0, 1e12), Words("moment of inertia about the axis")] = 0.0
    transverse_inertia: Annotated[float, Range("kg·m²", 0, 1e12), Words("moment of inertia across the axis")] = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)


def ring_disc(
    position: float, *, outer_diameter: float, inner_diameter: float, width: float, density: float
) -> ShaftDisc | None:
    """Return the disc of a ring (mm, kg/m³) around a shaft, or None if the shaft is as thick."""
    if outer_diameter <= inner_diameter:
        return None
    mass = density * 1e-9 * math.pi / 4 * (outer_diameter**2 - inner_diameter**2) * width
    square = 1e-6 * (outer_diameter**2 + inner_diameter**2)
    return ShaftDisc(
        position=position,
        mass=mass,
        polar_inertia=mass * square / 8,
        transverse_inertia=mass * (square / 16 + 1e-6 * width**2 / 12),
    )


class BeamInertia(NamedTuple):
    """Mass matrices (4, 4) of a part of a shaft in one plane (t, mm): of its movement, and of the turning of its sections."""

    movement: Floats
    turning: Floats


def beam_inertia(part: ShaftSegment, length: float) -> BeamInertia:
    """Return the consistent mass matrices of a Timoshenko beam of so much length (mm) (Friswell et al., 5.4.3)."""
    shear = part.shear_deflection(length)
    one, two = 312 + 588 * shear + 280 * shear**2, (44 + 77 * shear + 35 * shear**2) * length
    three, four = 108 + 252 * shear + 140 * shear**2, -(26 + 63 * shear + 35 * shear**2) * length
    five, six = (8 + 14 * shear + 7 * shear**2) * length**2, -(6 + 14 * shear + 7 * shear**2) * length**2
    movement = np.array([[one, two, three, four], [two, five, -four, six], [three, -four, one, -two], [four, six, -two, five]])
    movement *= part.density * _TONNES * part.area * length / (840 * (1 + shear) ** 2)
    far, near = (3 - 15 * shear) * length, (4 + 5 * shear + 10 * shear**2) * length**2
    cross = (-1 - 5 * shear + 5 * shear**2) * length**2
    turning = np.array([[36, far, -36, far], [far, near, -far, cross], [-36, -far, 36, -far], [far, cross, -far, near]])
    turning *= part.density * _TONNES * part.second_moment / (30 * length * (1 + shear) ** 2)
    return BeamInertia(movement, turning)


@dataclass(frozen=True)
class ShaftWhirl:
    """Whirl of a shaft with discs, whose nodes are those of `shaft` and the discs' positions."""

    shaft: SteppedShaft
    discs: tuple[ShaftDisc, ...] = ()

    @classmethod
    def of(cls, shaft: SteppedShaft, discs: Sequence[ShaftDisc] = ()) -> ShaftWhirl:
        """Return the whirl of a shaft whose parts are short enough for its first modes, whatever its stations are."""
        places = np.linspace(0.0, shaft.length, _FEWEST_PARTS + 1)[1:-1].tolist()
        return cls(replace(shaft, places=(*places, *(each.position for each in discs))), tuple(discs))

    @cached_property
    def _matrices(self) -> tuple[Floats, Floats, Floats]:
        """Stiffness, mass and gyroscopic matrix (k, k) of the free displacements and turns in one plane."""
        shaft = self.shaft
        stiffness, held = shaft.plane_stiffness()
        mass, gyroscopic = np.zeros_like(stiffness), np.zeros_like(stiffness)
        for number, (part, length) in enumerate(zip(shaft.parts, np.diff(shaft.nodes).tolist(), strict=True)):
            own, inertia = slice(2 * number, 2 * number + 4), beam_inertia(part, length)
            mass[own, own] += inertia.movement + inertia.turning
            gyroscopic[own, own] += 2 * inertia.turning
        for disc in self.discs:
            first = 2 * shaft.node_at(disc.position)
            mass[first, first] += _MASS * disc.mass
            mass[first + 1, first + 1] += _INERTIA * disc.transverse_inertia
            gyroscopic[first + 1, first + 1] += _INERTIA * disc.polar_inertia
        free = np.setdiff1d(np.arange(len(stiffness)), sorted(held))
        both = np.ix_(free, free)
        return stiffness[both], mass[both], gyroscopic[both]

    def _by_stiffness(self, matrix: Floats) -> Floats:
        """R^-1 A R^-T of a symmetric matrix A (k, k) with the Cholesky factor R of the stiffness."""
        factor = np.linalg.cholesky(self._matrices[0])
        found: Floats = np.linalg.solve(factor, np.linalg.solve(factor, matrix).T)
        return (found + found.T) / 2

    def critical_speeds(self, count: int = _SHOWN, *, forward: bool = True) -> list[float]:
        """Return the lowest speeds (rpm) at which a whirl turns as fast as the shaft, in its sense or against it.

        In its sense K - Omega^2 (M - G) is singular. Discs of great polar inertia leave fewer speeds.
        """
        _, mass, gyroscopic = self._matrices
        values = np.linalg.eigvalsh(self._by_stiffness(mass - gyroscopic if forward else mass + gyroscopic))
        found = sorted((each for each in values.tolist() if each > 0), reverse=True)
        return [30 / math.pi / math.sqrt(each) for each in found[:count]]

    def frequencies(self, speed: float = 0.0, count: int = _SHOWN) -> dict[str, list[float]]:
        """Return the lowest natural frequencies (Hz) of "forward" and "backward" whirl at a speed (rpm); the same at rest."""
        _, mass, gyroscopic = self._matrices
        root = np.linalg.cholesky(mass)
        factor = np.linalg.cholesky(self._matrices[0])
        own: Floats = np.linalg.solve(factor, root)
        turned = -math.pi / 30 * abs(speed) * self._by_stiffness(gyroscopic)
        values = np.linalg.eigvalsh(np.block([[turned, own], [own.T, np.zeros_like(own)]]))
        forward, backward = np.sort(values[values > 0])[::-1], np.sort(-values[values < 0])[::-1]
        return {
            name: (1 / (2 * math.pi * each[:count])).tolist() for name, each in (("forward", forward), ("backward", backward))
        }

    def to_dict(self, speed: float) -> JsonObject:
        """Return critical speeds of forward and backward whirl (rpm), and natural frequencies at a speed (Hz)."""
        return {
            "critical_speeds": self.critical_speeds(),
            "critical_speeds_backward": self.critical_speeds(forward=False),
            "natural_frequencies": self.frequencies(speed),
        }
