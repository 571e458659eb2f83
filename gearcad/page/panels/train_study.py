"""The study of a planetary train, from which the rating and the load shares of its planets are read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.designs.design import Design
from gearcad.jobs.planetary import planetary
from gearcad.page.last import of_last

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.result import PlanetaryStudy

__all__ = ["train_study"]


@of_last
def train_study(design: Design) -> PlanetaryStudy:
    """That of a train; finite elements tell how stiff its meshes are, which takes a second."""
    return planetary(design)
