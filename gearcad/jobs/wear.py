"""Verb `wear`: how a pair wears by Archard's law, step by step, and how the worn pair shares its load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Unpack

from gearcad.check.wear import WearOptions, WearResult, wear_pair
from gearcad.core.records import JsonObject, Notice
from gearcad.core.runtime import Progress, one_thread
from gearcad.designs import Design, DesignKind, Inputs, PairDesign
from gearcad.geometry import GearPair
from gearcad.jobs.job import ReportedJob, Writer, as_design
from gearcad.load import Load
from gearcad.version import __version__

__all__ = ["Wear", "wear"]

_NO_LOAD = "without it nothing slides under pressure"


@dataclass(frozen=True, kw_only=True)
class Wear(ReportedJob[PairDesign, WearResult]):
    """The wear of a pair of spur gears up to a `loss` (µm) of the flank that wears most, None for 0.1 m_n."""

    verb = "wear"
    accepts = (DesignKind.PAIR,)
    why = "a single gear has nothing to wear against"

    loss: float | None = None
    steps: int = 50
    positions: int = 30

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> WearResult:
        design = self.accepted(design, progress)
        options = WearOptions(loss=self.loss, steps=self.steps, positions=self.positions)
        return wear_pair(design.check_task(_NO_LOAD), options, progress)

    def document(self, result: WearResult) -> JsonObject:
        """Return the content of wear.json: depths in µm, volumes in mm³ of one flank, roll lengths in mm."""
        return {"kind": self.verb, "name": result.name, "gearcad": __version__, **result.to_dict()}

    def notices(self, result: WearResult) -> Sequence[Notice]:
        return result.notices

    def conclusion(self, _name: str, result: WearResult) -> str:
        return result.conclusion

    def files(self, result: WearResult) -> dict[str, Writer]:
        """Return the document and the report."""
        found: dict[str, Writer] = {"wear.json": partial(self.write_document, result)}
        return {**found, "wear.html": partial(_write_report, result, self.head)} if self.report else found


def _write_report(result: WearResult, head: Mapping[str, str], path: Path) -> None:
    from gearcad.report.wear import write_wear_report

    write_wear_report(result, path, head)


def wear(
    subject: Design | GearPair,
    load: Load | None = None,
    *,
    loss: float | None = None,
    steps: int = 50,
    positions: int = 30,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> WearResult:
    """Wear a pair of external spur gears by Archard's law, up to a `loss` (µm) of the flank that wears most.

    Depth grows by the pressures and the sliding of the loaded contact in the plane, which is solved again after each of some
    `steps`, at `positions` over a base pitch. Materials need a `wear_coefficient`, one of them at least; the other gear then
    does not wear. `material`, `mounting`, `check` and `rating`, as the load, stand in place of those of a design.

    Raises ParameterError without a pair, a load or a wear coefficient, GeometryError for rings, racks and helical gears.
    """
    design = as_design(subject, load, **inputs)
    return Wear(loss=loss, steps=steps, positions=positions, report=False).run(design, progress)
