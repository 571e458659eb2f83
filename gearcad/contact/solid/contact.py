"""One pair of teeth of solid gears in contact: what its line carries, cell by cell, and where edges have no say."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.contact.shared.loaded import PairContact
from gearcad.contact.solid.contact_lines import ContactLine
from gearcad.per_gear import PerGear

__all__ = ["SolidPairContact"]


@dataclass(frozen=True)
class SolidPairContact(PairContact):
    """One pair of teeth in contact, `force` (N): per cell of its line (n,) forces in N, half widths in mm, pressures in MPa.

    `margin` (n,) in mm is by how much a cell is further than INTERIOR half widths of the plain flanks from all edges of both
    flanks and from the transitions of linear reliefs: where it is not positive the pressure depends on these. `start_pressures`
    are the greatest (MPa) at the starts of each gear's linear reliefs, NaN where none is told; `edge_pressure` (MPa) is the
    greatest beside edges of the flanks.
    """

    line: ContactLine
    forces: Floats
    half_widths: Floats
    pressures: Floats
    radii: Floats
    margin: Floats
    start_pressures: PerGear[float]
    edge_pressure: float
    force: float
    share: float

    @property
    def tooth(self) -> int:
        """Tooth of the pinion, 0 is the middle one."""
        return self.line.tooth

    @property
    def place(self) -> float:
        """Where the line crosses the middle of the common face width (mm from T1)."""
        return self.line.middle

    @property
    def line_loads(self) -> Floats:
        """Normal load per length of the line (n,) in N/mm."""
        result: Floats = self.forces / self.line.lengths
        return result

    @property
    def edge(self) -> bool:
        """True if the edge of a tip carries load."""
        return bool((self.line.on_edge & (self.forces > 0)).any())

    @property
    def interior(self) -> Bools:
        """Cells (n,) that carry away from all edges."""
        result: Bools = (self.margin > 0) & (self.forces > 0)
        return result

    @cached_property
    def inside(self) -> Floats:
        """Places (m,) away from all edges, in cells: those of interior cells, and where the edges' reach ends beside them.

        With these the greatest values along a line do not depend on which cell happens to lie inside.
        """
        across = np.diff(self.line.across)
        joined = (self.forces[1:] > 0) & (self.forces[:-1] > 0) & (across < 1.5 * across.min(initial=math.inf))
        ends = np.flatnonzero(joined & ((self.margin[1:] > 0) != (self.margin[:-1] > 0)))
        here, there = self.margin[ends], self.margin[ends + 1]
        return np.sort(np.r_[np.flatnonzero(self.interior), ends + here / (here - there)])

    def between(self, values: Floats, place: float | Floats) -> Floats:
        """Values (n,) of the cells at places between them."""
        return np.asarray(np.interp(place, np.arange(len(values)), values))

    @property
    def peak_pressure(self) -> float:
        """Greatest pressure (MPa) away from all edges, NaN if no place is."""
        return float(self.between(self.pressures, self.inside).max()) if len(self.inside) else math.nan

    @property
    def interior_pressure(self) -> float | None:
        """Greatest pressure (MPa) away from all edges; None if no place is."""
        return self.peak_pressure if len(self.inside) else None

    @property
    def peak_line_load(self) -> float:
        """Greatest line load (N/mm) away from all edges, NaN if no place is."""
        return float(self.between(self.line_loads, self.inside).max()) if len(self.inside) else math.nan
