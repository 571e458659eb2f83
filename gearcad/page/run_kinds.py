"""What the page can run on a design, each by the job of the command line, and what it can make of one to be taken along."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from gearcad.designs.design import Design
from gearcad.designs.kinds.pair import PairDesign
from gearcad.jobs.job import Job

__all__ = ["ANALYSES", "DOWNLOADS", "RUNS", "RunKind"]


@dataclass(frozen=True, kw_only=True)
class RunKind:
    """A job with its options; `report` is the file to read, `taken` the pattern of those to take along.

    `takes` tells for which designs it is, of the kinds that the job accepts.
    """

    job: Callable[[], Job[Any, Any]]
    report: str = ""
    taken: str = "*"
    made: Callable[[Design], Design] = lambda design: design
    takes: Callable[[Design], bool] = lambda design: True

    def accepts(self, design: Design) -> bool:
        """Whether a design is of a kind that it is for."""
        return design.kind in self.job().accepts and self.takes(design)


def _check(model: str) -> Callable[[], Job[Any, Any]]:
    def job() -> Job[Any, Any]:
        from gearcad.jobs.check import Check

        return Check(model=model)

    return job


def _stiffness() -> Job[Any, Any]:
    from gearcad.jobs.stiffness import Stiffness

    return Stiffness()


def _dynamics() -> Job[Any, Any]:
    from gearcad.jobs.dynamics import Dynamics

    return Dynamics()


def _planetary() -> Job[Any, Any]:
    from gearcad.jobs.planetary import Planetary

    return Planetary()


def _rate() -> Job[Any, Any]:
    from gearcad.jobs.rate import Rate

    return Rate()


def _data() -> Job[Any, Any]:
    from gearcad.jobs.data import Data

    return Data()


def _build(*formats: str) -> Callable[[], Job[Any, Any]]:
    def job() -> Job[Any, Any]:
        from gearcad.jobs.build import Build

        return Build(formats=formats)  # type: ignore[arg-type]

    return job


def _draw(*formats: str) -> Callable[[], Job[Any, Any]]:
    def job() -> Job[Any, Any]:
        from gearcad.jobs.draw import Draw

        return Draw(formats=formats)  # type: ignore[arg-type]

    return job


def _with_bodies(design: Design) -> Design:
    """The face load factor by the load distribution of solid bodies."""
    from gearcad.rating.options import RatingOptions

    if not isinstance(design, PairDesign):
        return design
    return replace(design, rating=replace(design.rating or RatingOptions(), face_load_factor="fe"))


def _is_pair(design: Design) -> bool:
    return isinstance(design, PairDesign)


ANALYSES = {
    "check-2d": RunKind(job=_check("2d"), report="report.html"),
    "check-3d": RunKind(job=_check("3d"), report="report.html"),
    "rate": RunKind(job=_rate, report="rate.html"),
    "rate-fe": RunKind(job=_rate, report="rate.html", made=_with_bodies, takes=_is_pair),
    "stiffness": RunKind(job=_stiffness, report="stiffness.html"),
    "dynamics": RunKind(job=_dynamics, report="dynamics.html"),
    "planetary": RunKind(job=_planetary, report="planetary.html"),
}
"""Jobs that solve, in the order in which one asks for them."""

DOWNLOADS = {
    "step": RunKind(job=_build("step"), taken="*.step"),
    "stl": RunKind(job=_build("stl"), taken="*.stl"),
    "3mf": RunKind(job=_build("3mf"), taken="*.3mf"),
    "glb": RunKind(job=_build("glb"), taken="*.glb"),
    "dxf": RunKind(job=_build("dxf"), taken="*.dxf"),
    "csv": RunKind(job=_build("csv"), taken="*.csv"),
    "drawing-pdf": RunKind(job=_draw("pdf"), taken="*.pdf"),
    "drawing-dxf": RunKind(job=_draw("dxf"), taken="*.dxf"),
    "drawing-svg": RunKind(job=_draw("svg"), taken="*.svg"),
    "data": RunKind(job=_data, taken="data.json"),
}
"""What is made to be taken along."""

RUNS = ANALYSES | DOWNLOADS
