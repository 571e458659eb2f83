"""The study of a planetary train, from which the rating and the load shares of its planets are read."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from gearcad.designs.design import Design
from gearcad.jobs.planetary import planetary

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.result import PlanetaryStudy

__all__ = ["train_study"]


class _Studied(NamedTuple):
    design: Design
    study: PlanetaryStudy


_last: list[_Studied] = []
"""That of the last design: another panel asks for it next."""


def train_study(design: Design) -> PlanetaryStudy:
    """That of a train; finite elements tell how stiff its meshes are, which takes a second."""
    if not _last or _last[0].design != design:
        _last[:] = [_Studied(design, planetary(design))]
    return _last[0].study
