"""What a search among modifications begins with: cells and positions, plain flanks, the least and greatest amounts."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.optimum.search import Search
from gearcad.contact.optimum.variants import AMOUNTS, Condition, Variants, with_amounts
from gearcad.contact.solid.pair import KnownResponses, SolidPair
from gearcad.errors import GeometryError
from gearcad.geometry import GearPair, ReliefShape

__all__ = ["start_search"]


class _Sampling(NamedTuple):
    """Cells of a line of contact, positions over a base pitch, and as many more at either end of the path of contact."""

    cells: int
    positions: int
    at_ends: int


_HELICAL = _Sampling(16, 24, 0)
_SPUR = _Sampling(8, 32, 8)
"""By which a variant is judged: where a line runs across the flank its cells are at many places of it at once, where it does
not positions must be.
"""

_MOST_RELIEF = 1.5
_MOST_CROWNING = 0.5
"""Largest tip relief of a gear and largest crowning, as shares of the greatest deflection of the teeth."""

_MOST_HELIX = 1.5
"""Largest change of the pinion's helix, as a share of the one that makes up for the misalignment."""

_SHORTEST = 0.1
_LONGEST = 0.5
"""Shortest and longest tip relief, as shares of the path of contact: in its middle flanks stay exact."""


def start_search(model: SolidPair, torque: float, shape: ReliefShape) -> Search:
    """Prepare a search at a torque (N·m) for a model whatever its own tip relief and crowning; the helix angle is modified
    only against a misalignment of its mounting.
    """
    nothing = np.zeros(len(AMOUNTS))
    sampling = _HELICAL if model.helix else _SPUR
    bare = replace(
        model.remade(with_amounts(model.pair, nothing, shape), model.mounting), cells=sampling.cells, known=KnownResponses()
    )
    start = np.array([0.0, 0.0, 0.0, 0.0, 0.0, _aligning(bare)])
    plain = Variants(bare, shape, sampling.positions, torque, sampling.at_ends).outcomes(start[None], Condition(torque))
    low, high = _bounds(bare, shape, float(plain.transmission_errors.max()))
    roomy = bare.remade(with_amounts(bare.pair, high, shape), bare.mounting)
    variants = Variants(roomy, shape, sampling.positions, torque, sampling.at_ends)
    return Search(variants, torque, low, high, start, variants.outcomes(start[None], Condition(torque)))


def _aligning(model: SolidPair) -> float:
    """Helix angle modification (µm) of the pinion that turns its loaded, left flanks as far as the wheel is misaligned."""
    form = model.pair.pinion.flank_form
    return form.hand * model.mounting.misalignment * form.width / model.width


def _bounds(model: SolidPair, shape: ReliefShape, deflection: float) -> tuple[Floats, Floats]:
    """The least and the greatest amounts (6,)."""
    path, pair = model.pair.path_of_contact, model.pair
    reach = path.E - path.A
    longest = [min(_LONGEST * reach, gear.flank_form.last - gear.flank_form.first) for gear in pair.gears]
    helix = _MOST_HELIX * abs(_aligning(model))
    low = np.array([0.0, _SHORTEST * reach, 0.0, _SHORTEST * reach, 0.0, -helix])
    relief, crowning = np.ceil(_MOST_RELIEF * deflection), np.ceil(_MOST_CROWNING * deflection)
    high = np.array([relief, longest[0], relief, longest[1], crowning, helix])
    while not _fits(pair, high, shape):
        high[[0, 2, 4]] = np.floor(0.9 * high[[0, 2, 4]])
    return low, high


def _fits(pair: GearPair, amounts: Floats, shape: ReliefShape) -> bool:
    """Whether flanks can be taken back that far; nothing at all always fits."""
    try:
        with_amounts(pair, amounts, shape)
    except GeometryError:
        return not amounts[[0, 2, 4]].any()
    return True
