"""Boxes that have their places move to the middle of the room that is left to them. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from gearcad.drawing.shapes import Box, Point

__all__ = ["balanced"]

_ROUNDS = 3
"""Each group moves once a round, as the others then stand."""

_ASIDE = 5.0
"""What is not further aside than this is in the way."""


def balanced(groups: Sequence[Sequence[Box]], across: Sequence[bool], taken: Sequence[Box], free: Box) -> list[Point]:
    """How far each group of boxes moves as one: upwards, and where `across` says so to the side too."""
    stood = [list(group) for group in groups]
    for _ in range(_ROUNDS):
        for number, sideways in enumerate(across):
            others = [*taken, *(box for each, group in enumerate(stood) if each != number for box in group)]
            up = _to_middle(stood[number], others, free)
            stood[number] = [box.moved(0.0, up) for box in stood[number]]
            if sideways:
                right = _to_middle(map(_turned, stood[number]), list(map(_turned, others)), _turned(free))
                stood[number] = [box.moved(right, 0.0) for box in stood[number]]
    starts = [group[0] if group else Box(0.0, 0.0, 0.0, 0.0) for group in groups]
    ends = [group[0] if group else Box(0.0, 0.0, 0.0, 0.0) for group in stood]
    return [(end.left - start.left, end.bottom - start.bottom) for start, end in zip(starts, ends, strict=True)]


def _to_middle(group: Iterable[Box], others: Sequence[Box], free: Box) -> float:
    """How far up boxes go for as much room above as below them."""
    above, below = [], []
    for box in group:
        beside = [each for each in others if each.left < box.right + _ASIDE and box.left - _ASIDE < each.right]
        above.append(min([free.top, *(each.bottom for each in beside if each.bottom >= box.top)]) - box.top)
        below.append(box.bottom - max([free.bottom, *(each.top for each in beside if each.top <= box.bottom)]))
    return (min(above) - min(below)) / 2 if above else 0.0


def _turned(box: Box) -> Box:
    """What is across goes up."""
    return Box(box.bottom, box.left, box.top, box.right)
