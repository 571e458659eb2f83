"""What the teeth of all meshes do in each step of a motion at one speed, until it comes again but for errors. SI units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.excitation.meshes import MeshExcitation
from gearcad.dynamics.tooth_errors.springs import ToothSpring

if TYPE_CHECKING:
    from gearcad.dynamics.tooth_errors.kernel import Pattern

__all__ = ["repeated_teeth", "single_pattern", "smooth_pattern"]

_WITHIN = 16
"""Places within a step, over which a mean is taken where curves jump."""

_MICRO = 1e-6


def repeated_teeth(ratios: Sequence[Fraction], periods: Sequence[int] | None = None) -> int:
    """Teeth of the first mesh until all meshes come again, of these tooth frequencies over that of the first.

    `periods` are those of their own teeth, 1 each if not given.
    """
    own = [Fraction(period) / ratio for period, ratio in zip(periods or [1] * len(ratios), ratios, strict=True)]
    common = Fraction(math.lcm(*(each.numerator for each in own)), math.gcd(*(each.denominator for each in own)))
    return int(common)


def single_pattern(springs: Sequence[ToothSpring], ratios: Sequence[Fraction], per_tooth: int) -> Pattern:
    """Of pairs one by one, in so many steps to a tooth of the first mesh."""
    from gearcad.dynamics.tooth_errors.kernel import Pattern

    again = repeated_teeth(ratios)
    # One more than there can be at once: a step may hold the end of one and the beginning of the next.
    count, pairs = again * per_tooth, 1 + max(spring.pairs for spring in springs)
    stiffness, gap, place = (np.zeros((count, len(springs), pairs)) for _ in range(3))
    tooth = np.zeros((count, len(springs)), np.int64)
    for j, (spring, ratio) in enumerate(zip(springs, ratios, strict=True)):
        step = float(ratio) / per_tooth
        along = step * np.arange(count) + spring.lead
        first = np.ceil(along - spring.last - step / 2)
        at = (along - first)[:, None] - np.arange(pairs)
        # What of a step lies between the ends of a pair's way, where its spring begins and ends.
        inside = np.minimum(at + step / 2, spring.last) - np.maximum(at - step / 2, spring.first)
        stiffness[:, j] = np.clip(inside / step, 0.0, 1.0) * np.interp(at, spring.places, spring.stiffness)
        gap[:, j], place[:, j], tooth[:, j] = np.interp(at, spring.places, spring.gap), at, first
    teeth = np.array([int(again * ratio) for ratio in ratios])
    return Pattern(stiffness, gap, place, tooth, teeth, np.zeros((count, len(springs))), np.zeros((count, len(springs))))


def smooth_pattern(
    meshes: Sequence[MeshExcitation], stiffness: Floats, senses: Floats, per_tooth: int, frequency: float
) -> Pattern:
    """Of meshes as one spring each, of mean `stiffness` (m,); `frequency` is that of the first mesh's teeth (Hz)."""
    from gearcad.dynamics.tooth_errors.kernel import Pattern

    ratios = [mesh.frequency_ratio for mesh in meshes]
    again = repeated_teeth(ratios)
    count = again * per_tooth
    springs, error, rate = np.zeros((count, len(meshes), 1)), np.zeros((count, len(meshes))), np.zeros((count, len(meshes)))
    for j, (mesh, ratio) in enumerate(zip(meshes, ratios, strict=True)):
        step = 2 * math.pi * float(ratio) / per_tooth
        phase = step * np.arange(count) + mesh.lead
        within = phase[:, None] + step * ((np.arange(_WITHIN) + 0.5) / _WITHIN - 0.5)
        springs[:, j, 0] = stiffness[j] * mesh.stiffness.values(within).mean(axis=1)
        if mesh.error is not None and mesh.error.line is not None:
            scale = _MICRO * float(senses[j])
            error[:, j] = scale * mesh.error.line.values(within).mean(axis=1)
            before, behind = (mesh.error.line.values(phase + side * step / 2) for side in (-1, 1))
            rate[:, j] = scale * (behind - before) * frequency * per_tooth
    zeros, teeth = np.zeros_like(springs), np.array([int(again * ratio) for ratio in ratios])
    return Pattern(springs, zeros, zeros, np.zeros((count, len(meshes)), np.int64), teeth, error, rate)
