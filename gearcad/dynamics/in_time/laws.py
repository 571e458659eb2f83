"""What the teeth of one mesh are to a motion in time: springs over the places of a tooth, gaps, errors, backlash. SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.excitation.meshes import Excitation, MeshExcitation
from gearcad.errors import ParameterError, require_whole

__all__ = ["MeshLaw", "SpringTable", "lumped_laws"]

CELLS = 4096
"""Of even width that a table is cut into: of a tooth, or of the way of one tooth through the mesh."""

_PER_TOOTH = 1024
"""Samples of an error over a tooth: between them it runs straight."""

_MOST_SAMPLES = 4_000_000
"""Of an error that comes again after thousands of teeth only."""

_MOST_TEETH = 10**9

_JUMP = 1e-6
"""Of the greatest value: less is the slope between the two sides of one place."""

_MICRO = 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class SpringTable:
    """Stiffness (n,) in N/m and gap (n,) in m of the flanks of one tooth at its `place` (n,), in base pitches.

    Places rise; where one stands twice, the curves jump. Between them both are straight, and beyond the ends there is no
    spring. `opening`: the gap is one of flanks that stand apart on both sides of the tooth, as before its contact begins; else
    it is an error, that moves both flanks and is met by the damper as well. Raises ParameterError.
    """

    place: Floats
    stiffness: Floats
    gap: Floats
    opening: bool

    def __post_init__(self) -> None:
        place, stiffness, gap = (np.array(each, float) for each in (self.place, self.stiffness, self.gap))
        if place.ndim != 1 or len(place) < 2 or not place.shape == stiffness.shape == gap.shape:
            raise ParameterError("place", f"{place.shape}", "must be two or more, each with one stiffness and one gap")
        if not all(np.isfinite(each).all() for each in (place, stiffness, gap)):
            raise ParameterError("place", "not finite", "must be finite numbers, as stiffness and gap")
        if (np.diff(place) < 0).any() or place[-1] == place[0]:
            raise ParameterError("place", float(place[-1]), "must rise, in base pitches")
        if stiffness.min() < 0:
            raise ParameterError("stiffness", float(stiffness.min()), "must be at least 0 at every place", "N/m")
        for name, array in (("place", place), ("stiffness", stiffness), ("gap", gap)):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @cached_property
    def cells(self) -> Floats:
        """(CELLS, 8): integral of the stiffness before each cell, its mean and slope there, the same three of stiffness times
        gap, error and its slope."""
        edges = np.linspace(self.place[0], self.place[-1], CELLS + 1)
        width = edges[1] - edges[0]
        found = np.zeros((CELLS, 8))
        for column, sums in zip((0, 3), self._sums(edges), strict=True):
            found[:, column], found[:, column + 1] = sums[:-1], np.diff(sums) / width
        inside = 1e-3 * width
        for column, values in ((2, self._stiffness), (5, lambda at: self._stiffness(at) * self._gap(at))):
            slope = (values(edges[1:] - inside) - values(edges[:-1] + inside)) / (width - 2 * inside)
            found[:, column] = np.where(self._broken(edges), 0.0, slope)
        if not self.opening:
            error = self._gap(edges)
            found[:, 6], found[:, 7] = error[:-1], np.diff(error) / width
        found.flags.writeable = False
        return found

    def _stiffness(self, at: Floats) -> Floats:
        return np.asarray(np.interp(at, self.place, self.stiffness), float)

    def _gap(self, at: Floats) -> Floats:
        return np.asarray(np.interp(at, self.place, self.gap), float)

    def _broken(self, edges: Floats) -> np.ndarray:
        """Which cells have a jump inside or at an edge."""
        off = [np.abs(np.diff(each)) > _JUMP * np.abs(each).max() for each in (self.stiffness, self.gap)]
        jumps = self.place[1:][(np.diff(self.place) == 0) & (off[0] | off[1])]
        return np.asarray(np.searchsorted(jumps, edges[1:], "right") > np.searchsorted(jumps, edges[:-1]))

    def _sums(self, at: Floats) -> tuple[Floats, Floats]:
        """Integrals of stiffness, and of stiffness times gap, from the first place to those asked for; exact ones."""
        steps = np.diff(self.place)
        safe = np.where(steps > 0, steps, 1.0)
        k, g = self.stiffness[:-1], self.gap[:-1]
        dk, dg = (np.where(steps > 0, np.diff(each) / safe, 0.0) for each in (self.stiffness, self.gap))

        def within(which: np.ndarray | slice, x: Floats) -> tuple[Floats, Floats]:
            one = x * (k[which] + dk[which] * x / 2)
            two = x * (
                k[which] * g[which] + x * ((k[which] * dg[which] + dk[which] * g[which]) / 2 + x * dk[which] * dg[which] / 3)
            )
            return one, two

        before = [np.concatenate([[0.0], np.cumsum(each)]) for each in within(slice(None), steps)]
        which = np.clip(np.searchsorted(self.place, at, side="right") - 1, 0, len(steps) - 1)
        one, two = within(which, at - self.place[which])
        return before[0][which] + one, before[1][which] + two


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshLaw:
    """One mesh: a spring for each pair of teeth, all by one table, and what is different from tooth to tooth.

    `order` teeth pass in the common period, `lead` base pitches early; tooth i is met at a place of `order` times the turns of
    the common period + `lead` - i. `position` (z,) in m and `slope` (z,) in m per base pitch from `middle` are more gap of the
    teeth, in turn. `error` (k,) in m, even samples over `error_teeth` base pitches, is what all flanks must approach first.
    `backlash` (m) is the clearance at the back: nan where flanks never part, inf where they never meet at the back. All of it
    is positive as the mean load presses the flanks.
    """

    table: SpringTable
    order: int = 1
    lead: float = 0.0
    position: Floats = field(default_factory=lambda: np.zeros(1))
    slope: Floats = field(default_factory=lambda: np.zeros(1))
    middle: float = 0.0
    error: Floats = field(default_factory=lambda: np.zeros(1))
    error_teeth: int = 1
    backlash: float = math.nan

    def __post_init__(self) -> None:
        require_whole("order", self.order, at_least=1, at_most=_MOST_TEETH)
        require_whole("error_teeth", self.error_teeth, at_least=1, at_most=_MOST_TEETH)
        for name in ("position", "slope", "error"):
            array = np.array(getattr(self, name), float)
            if array.ndim != 1 or not len(array) or not np.isfinite(array).all():
                raise ParameterError(name, f"{array.shape}", "must be finite numbers in a row", "m")
            object.__setattr__(self, name, array)
        if self.position.shape != self.slope.shape:
            raise ParameterError(
                "position", f"{self.position.shape}", f"must be one number per tooth, as slope {self.slope.shape}"
            )
        if not math.isnan(self.backlash) and self.backlash < 0:
            raise ParameterError("backlash", self.backlash, "must be at least 0, or nan for flanks that never part", "m")


def lumped_laws(excitation: Excitation, stiffness: Floats, senses: Floats) -> tuple[MeshLaw, ...]:
    """Every mesh as one spring whose stiffness changes, of the means `stiffness` (m,) in N/m, as the harmonic balance has it.

    `senses` (m,) say which flanks the mean load presses.
    """
    return tuple(
        _lumped(mesh, order, float(k), float(sense))
        for mesh, order, k, sense in zip(excitation.meshes, excitation.orders, stiffness, senses, strict=True)
    )


def _lumped(mesh: MeshExcitation, order: int, stiffness: float, sense: float) -> MeshLaw:
    """Over one base pitch; what comes again with every tooth stands in the table, other errors in long rows."""
    line = None if mesh.error is None else mesh.error.line
    corners = [np.linspace(0, 2 * np.pi, CELLS + 1), mesh.stiffness.jumps, *([] if line is None else [line.phase, line.jumps])]
    phase = np.unique(np.concatenate([np.mod(each, 2 * np.pi) for each in corners] + [[0.0]]))
    # Both sides of every place: curves may jump there.
    phase = np.append(phase, 2 * np.pi)
    begin, end = phase[:-1], phase[1:]
    inside = 1e-9 * (end - begin)
    place = np.column_stack([begin, end]).ravel() / (2 * np.pi)
    at = np.column_stack([begin + inside, end - inside]).ravel()
    table = SpringTable(
        place=place,
        stiffness=stiffness * mesh.stiffness.values(at),
        gap=np.zeros(len(place)) if line is None else sense * _MICRO * line.values(at),
        opening=False,
    )
    error, teeth = _long_error(mesh, sense)
    backlash = math.nan if mesh.backlash is None else _MICRO * mesh.backlash
    return MeshLaw(table=table, order=order, lead=mesh.lead / (2 * np.pi), error=error, error_teeth=teeth, backlash=backlash)


def _long_error(mesh: MeshExcitation, sense: float) -> tuple[Floats, int]:
    """What of the error comes again with the gears, and after how many teeth."""
    if mesh.error is None or not mesh.error.coefficients.any():
        return np.zeros(1), 1
    own, teeth = mesh.error.coefficients, mesh.error.teeth
    count = max(min(_PER_TOOTH * teeth, _MOST_SAMPLES), 2 * len(own))
    spectrum = np.zeros(count // 2 + 1, complex)
    spectrum[: len(own)] = own
    return sense * _MICRO * np.fft.irfft(spectrum, count, norm="forward"), teeth
