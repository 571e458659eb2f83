"""What diagrams of modifications show: depths over the profile and along the face, from the flank's own depth function."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from gearcad.arrays import Floats
from gearcad.geometry import Gear

__all__ = ["Depths", "Series", "helix_depths", "profile_depths"]

_BETWEEN = 24
"""Points of a curve between two places where it is not smooth."""


@dataclass(frozen=True)
class Series:
    """One curve: the key of its words, depths (µm) at the `places` and all along `fine` of its Depths."""

    key: str
    at_places: Floats
    along: Floats


@dataclass(frozen=True)
class Depths:
    """Depths (µm) over roll lengths or heights z (mm): `places` are the ends, the middle, and where reliefs begin.

    `fine` are the places of the points of a curve, `diameters` those of the places (None along the face).
    """

    places: Floats
    fine: Floats
    series: tuple[Series, ...]
    diameters: Floats | None = None

    @property
    def extent(self) -> tuple[float, float]:
        """Least and greatest of all depths and 0."""
        every = np.concatenate([[0.0], *(each.along for each in self.series)])
        return float(every.min()), float(every.max())

    @property
    def turned(self) -> Self:
        """The same from the last place to the first."""
        series = tuple(replace(each, at_places=each.at_places[::-1], along=each.along[::-1]) for each in self.series)
        diameters = None if self.diameters is None else self.diameters[::-1]
        return replace(self, places=self.places[::-1], fine=self.fine[::-1], series=series, diameters=diameters)


def profile_depths(gear: Gear) -> Depths | None:
    """Over roll lengths from root form to tip form circle, at mid face width; with twist at both ends too.

    What changes along the face only is left out. None where nothing is done to the profile.
    """
    form = gear.flank_form
    if not form.modification.on_profile:
        return None
    middle = (form.first + form.last) / 2
    centre = [middle] if form.modification.profile_crowning else []
    places = np.array(sorted({form.first, *form.relief_starts, *centre, form.last}))
    heights = {"profile_middle": form.width / 2}
    if form.modification.twist:
        heights = {"profile_start": 0.0, **heights, "profile_end": form.width}

    def depth(rolls: Floats, z: float) -> Floats:
        along: Floats = form.depth(middle, z) - form.depth(middle, form.width / 2)
        result: Floats = 1000 * (form.depth(rolls, z) - along)
        return result

    fine = _fine(np.union1d(places, form.roll_breaks))
    series = tuple(Series(key, depth(places, z), depth(fine, z)) for key, z in heights.items())
    return Depths(places, fine, series, 2 * np.hypot(form.base_radius, places))


def helix_depths(gear: Gear) -> Depths | None:
    """Along the face at mid profile, what is done to the profile there left out; of both flanks where they differ.

    None where nothing is done along the face.
    """
    form = gear.flank_form
    of = form.modification
    if not any((of.lead_crowning, of.end_relief, of.helix_angle_modification)):
        return None
    middle = (form.first + form.last) / 2
    places = np.array(sorted({0.0, *form.height_breaks, form.width / 2, form.width}))
    fine = _fine(places)
    right = gear.internal  # with its tip up, the flank of a ring's tooth with y > 0 is the one on the right
    flanks = {"flank_right": right, "flank_left": not right} if of.helix_angle_modification else {"flanks": True}

    def depth(heights: Floats, left: bool) -> Floats:
        at_middle = form.depth(middle, form.width / 2, left=left)
        result: Floats = 1000 * (form.depth(middle, heights, left=left) - at_middle)
        return result

    return Depths(places, fine, tuple(Series(key, depth(places, left), depth(fine, left)) for key, left in flanks.items()))


def _fine(places: Floats) -> Floats:
    """The places and points between them."""
    steps = np.arange(len(places) * _BETWEEN - _BETWEEN + 1) / _BETWEEN
    result: Floats = np.interp(steps, np.arange(len(places)), places)
    return result
