"""Single teeth: a pair as a spring that reaches over its way through the mesh, and what pairs carry at rest. SI units.

Places are in base pitches from the middle of the path of contact, and rise as teeth go through the mesh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats, freeze
from gearcad.errors import ParameterError

__all__ = ["AtRest", "PairErrors", "ToothSpring", "at_rest"]


@dataclass(frozen=True, eq=False)
class PairErrors:
    """What is missing from the flanks of pair i of teeth, i modulo their number: `position` (n,) in the middle of the path, and
    `slope` (n,) for each base pitch further on, in m."""

    position: Floats = field(default_factory=lambda: np.zeros(1))
    slope: Floats = field(default_factory=lambda: np.zeros(1))

    def __post_init__(self) -> None:
        freeze(self)

    def times(self, factor: float) -> PairErrors:
        """The same, so many times as large."""
        return PairErrors(factor * self.position, factor * self.slope)

    def at(self, tooth: Floats, place: Floats) -> Floats:
        """Of pairs (...) at places (...)."""
        which = np.mod(tooth, len(self.position)).astype(np.intp)
        return np.asarray(self.position[which] + self.slope[which] * place, float)

    @property
    def greatest(self) -> float:
        """The most that is missing anywhere on the path, or stands out (m), at a place of 1 on both sides."""
        return float((np.abs(self.position) + np.abs(self.slope)).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class ToothSpring:
    """A pair of teeth over its way: `stiffness` (n,) in N/m and `gap` (n,) in m at even places from `first` to `last`.

    Straight lines between these; beyond them teeth never meet. `lead` is the place of pair 0 at phase 0 of the mesh;
    `contact_ratio` is the length of the path of contact.
    """

    first: float
    last: float
    stiffness: Floats
    gap: Floats
    lead: float
    contact_ratio: float

    def __post_init__(self) -> None:
        freeze(self)
        if self.stiffness.shape != self.gap.shape or len(self.gap) < 2 or self.last <= self.first:
            raise ParameterError("stiffness", f"{self.stiffness.shape}", f"must be as many as gaps, {self.gap.shape}")
        if not np.isfinite(self.gap).all() or not np.isfinite(self.stiffness).all() or self.stiffness.min() < 0:
            raise ParameterError("stiffness", "not finite", "must be finite, as gaps are, and not below 0")

    @property
    def places(self) -> Floats:
        """(n,) of both tables."""
        return np.linspace(self.first, self.last, len(self.gap))

    @property
    def pairs(self) -> int:
        """How many can be on their way at once."""
        return math.floor(self.last - self.first) + 1

    @property
    def backwards(self) -> ToothSpring:
        """For teeth that go their way the other way round."""
        return ToothSpring(
            first=-self.last,
            last=-self.first,
            stiffness=self.stiffness[::-1].copy(),
            gap=self.gap[::-1].copy(),
            lead=-self.lead,
            contact_ratio=self.contact_ratio,
        )

    def engaged(self, turns: Floats, errors: PairErrors) -> tuple[Floats, Floats]:
        """Stiffness (t, p) of the pairs on their way after so many tooth periods (t,) and their gaps with errors (t, p)."""
        nearest = np.ceil(turns + self.lead - self.last)
        tooth = nearest[:, None] + np.arange(float(self.pairs))
        place = (turns + self.lead)[:, None] - tooth
        inside = (place >= self.first) & (place <= self.last)
        stiffness = np.where(inside, np.interp(place, self.places, self.stiffness), 0.0)
        gap = np.interp(place, self.places, self.gap) + errors.at(tooth, place)
        return stiffness, np.where(inside, gap, np.inf)


class AtRest(NamedTuple):
    """A mesh at rest after some tooth periods (t,): `approach` (t,) in m, `forces` (t, p) in N of the pairs side by side.

    `stiffness` (N/m) is the mean of all pairs that carry.
    """

    approach: Floats
    forces: Floats
    stiffness: float

    @property
    def contact_ratio(self) -> float:
        """How many pairs carry on the mean."""
        return float((self.forces > 0).sum(axis=1).mean())


def at_rest(spring: ToothSpring, force: float, turns: Floats, errors: PairErrors | None = None) -> AtRest:
    """The approach at which all pairs together carry a force (N): sum K max(y - gap, 0) = F, which has one root.

    The pairs touch in the order of their gaps; with so many of them the root is that of a straight line.
    """
    stiffness, gap = spring.engaged(np.asarray(turns, float), errors or PairErrors())
    order = np.argsort(gap, axis=1)
    k, g = (np.take_along_axis(each, order, 1) for each in (stiffness, gap))
    closed = np.where(k > 0, k * np.where(np.isfinite(g), g, 0.0), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        each = (force + np.cumsum(closed, axis=1)) / np.cumsum(k, axis=1)
    following = np.concatenate([g[:, 1:], np.full((len(g), 1), np.inf)], axis=1)
    # The first so many pairs whose approach does not reach the next gap.
    which = np.argmax((each <= following) & np.isfinite(each), axis=1)
    approach = np.take_along_axis(each, which[:, None], 1)[:, 0]
    pressed = np.maximum(approach[:, None] - gap, 0.0)
    forces = np.asarray(stiffness * pressed, float)
    return AtRest(approach, forces, float(np.where(forces > 0, stiffness, 0.0).sum(axis=1).mean()))
