"""Random gears, measured with noise, are named by `identify`, or it says that it does not know.

Each is measured with a standard deviation of 0.02 mm: number of teeth, tip and root diameter, whether it is a spur gear, the
helix angle of its tips to 1 degree, and what the way of measuring has beside (see `measured_gears`). What is named is module or
pitch, pressure angle, spur or helical, and helix angle and shift within three of the uncertainties that are stated.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from support.measured_gears import FINE, NO_FLANK, WAYS, bench, names

from gearcad.identify import identify_gear


class Score(NamedTuple):
    """Gears measured, named first, named among the first three, called certain, and rightly so; and the sum of the
    probabilities that were stated for the first.
    """

    gears: int
    first: int
    three: int
    certain: int
    rightly: int
    stated: float

    def __add__(self, other: Score) -> Score:  # type: ignore[override]
        return Score(*(one + another for one, another in zip(self, other, strict=True)))


def score(seed: int, way: str, gears: int, *, helix_known: bool = True, modules: tuple[float, ...] = ()) -> Score:
    rng, whole = np.random.default_rng(seed), Score(0, 0, 0, 0, 0, 0.0)
    for _ in range(gears):
        one = bench(rng, way, helix_known=helix_known, modules=modules)
        found = identify_gear(one.measured)
        right = [names(each, one.gear) for each in found.candidates]
        stated = found.best.probability if found.fits else 0.0
        whole += Score(1, right[0], any(right[:3]), found.certain, found.certain and right[0], stated)
    return whole


def test_most_gears_are_named() -> None:
    whole = sum((score(5, way, 3) for way in WAYS), Score(0, 0, 0, 0, 0, 0.0))
    assert whole.gears == 12 and whole.first >= 11 and whole.three >= 11
    assert whole.certain >= 8 and whole.rightly >= whole.certain - 1


@pytest.mark.long
def test_500_gears() -> None:
    """The first is right in 90 % at least, one of the first three in 98 %, and of what is called certain 97 %; and no fewer
    are right than the probabilities promise.
    """
    scores = {way: score(100 + number, way, 125) for number, way in enumerate(WAYS)}
    for way, each in scores.items():
        print(f"{way:18}{each}")
    whole = sum(scores.values(), Score(0, 0, 0, 0, 0, 0.0))
    print(f"{'all':18}{whole}")
    assert whole.gears == 500
    assert whole.first >= 0.90 * whole.gears
    assert whole.three >= 0.98 * whole.gears
    assert whole.rightly >= 0.97 * whole.certain
    assert whole.certain >= 0.6 * whole.gears
    assert whole.first >= whole.stated - 0.03 * whole.gears


@pytest.mark.long
def test_what_cannot_be_told_is_called_ambiguous() -> None:
    """Unknown helix angles, flanks that nothing touched, and modules below 0.55 mm, whose base pitches the noise hides."""
    unknown = score(200, "two spans", 100, helix_known=False)
    flankless = score(202, NO_FLANK, 100)
    fine = score(201, "two spans", 100, modules=FINE)
    for each in (unknown, flankless, fine):
        print(each)
        assert each.rightly >= 0.95 * each.certain
    assert unknown.first >= 0.85 * unknown.gears
    assert flankless.certain < 0.2 * flankless.gears
    assert fine.certain < 0.6 * fine.gears


@pytest.mark.long
def test_standard_sizes_of_the_transverse_section_are_among_the_first() -> None:
    """They are rare, and one reading in five has a size of the normal section beside it, which comes first then."""
    gears = first = three = certain = rightly = 0
    for number, way in enumerate(WAYS):
        rng = np.random.default_rng(900 + number)
        for _ in range(30):
            one = bench(rng, way, transverse=True)
            found = identify_gear(one.measured)
            off = [abs(each.gear.normal_module - one.gear.normal_module) for each in found.candidates]
            right = [miss <= 3 * each.module_uncertainty + 1e-4 for miss, each in zip(off, found.candidates, strict=True)]
            gears, first, three = gears + 1, first + right[0], three + any(right[:3])
            certain, rightly = certain + found.certain, rightly + (found.certain and right[0])
    print(gears, first, three, certain, rightly)
    assert first >= 0.6 * gears and three >= 0.95 * gears
    assert certain < 0.5 * gears and rightly >= 0.85 * certain
