"""Check: contact and root stress of a pair under its load by finite elements, beside Hertz and ISO 6336."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, ClassVar, Unpack

from gearcad.check.document import check_document, reported_document
from gearcad.check.options import CheckOptions
from gearcad.check.result import CheckResult
from gearcad.check.run import check_pair, expected_check
from gearcad.designs import Design, DesignKind, Inputs, PairDesign
from gearcad.geometry import GearPair
from gearcad.jobs.job import Job, Writer
from gearcad.jobs.subject import as_design
from gearcad.load import Load
from gearcad.material import Material
from gearcad.notice import Notice
from gearcad.progress import Expected, Progress

__all__ = ["Check", "check"]

_NO_LOAD = "without it there is no stress"


@dataclass(frozen=True, kw_only=True)
class Check(Job[PairDesign, CheckResult]):
    """The structural check of a pair; `model` ("2d" or "3d") wins over that of the design's own [check].

    Without `report` there is check.json alone, and nothing is solved for the report only.
    """

    verb = "check"
    accepts = (DesignKind.PAIR,)
    why = "a single gear has nothing to press against"
    sometimes: ClassVar[tuple[str, ...]] = ("stress_pinion.vtu", "stress_wheel.vtu")

    model: str | None = None
    report: bool = True

    def _run(self, design: PairDesign, progress: Progress | None) -> CheckResult:
        load, material, options = design.loaded(_NO_LOAD), design.material or Material(), self._options(design)
        result = check_pair(design.pair, material, load, options, progress, design.mounting, design.rating)
        if self.report:
            result.solve_shown()
        return result

    def _expected(self, design: PairDesign) -> Expected:
        load, material, options = design.loaded(_NO_LOAD), design.material or Material(), self._options(design)
        return expected_check(design.pair, material, load, options, design.mounting, design.rating)

    def _options(self, design: PairDesign) -> CheckOptions | None:
        if self.model is None:
            return design.check
        return replace(design.check or CheckOptions(), model=self.model)

    def document(self, result: CheckResult) -> dict[str, Any]:
        """What check.json holds: stiffness in N/(mm·µm) of common face width, transmission error in µm, stresses in MPa."""
        return reported_document(result) if self.report else check_document(result)

    def for_row(self, _design: Design, _parts: Collection[str]) -> Check:
        return replace(self, report=False)

    def notices(self, result: CheckResult) -> Sequence[Notice]:
        return result.all_notices

    def conclusion(self, name: str, result: CheckResult) -> str:
        return f"{name} at {result.torque:g} N·m: {result.verdict}"

    def figures(self, document: dict[str, Any]) -> dict[str, Any]:
        """The verdict, the summary and the rating."""
        verdict = {name: document[name] for name in ("passed", "numerics", "strength")}
        return {**verdict, **document["summary"], "rating": document["rating"], "warnings": document["warnings"]}

    def files(self, result: CheckResult) -> dict[str, Writer]:
        """check.json, the report, and of solid bodies the stresses in the most stressed tooth of each gear."""
        document: dict[str, Writer] = {"check.json": partial(self.write_document, result)}
        if not self.report:
            return document
        return {**document, "report.html": partial(_write_report, result), **result.stress_files}


def _write_report(result: CheckResult, path: Path) -> None:
    from gearcad.report import write_report

    write_report(result, result.pair.name, path)


def check(
    subject: Design | GearPair,
    load: Load | None = None,
    *,
    model: str | None = None,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> CheckResult:
    """Check a pair as mounted, under a load, by finite elements: contact and root stress, beside Hertz and ISO 6336.

    `model` is "2d" (a plane section) or "3d" (solid bodies); None stands for 3d where gears are helical. `material`,
    `mounting`, `check` (CheckOptions) and `rating` (RatingOptions), as the load, stand in place of those of a design; a pair
    has the defaults.

    >>> from gearcad import Gear, GearPair, Load
    >>> from gearcad.check import CheckOptions
    >>> gears = [Gear(teeth=z, normal_module=2, face_width=20, tooth_thinning=0.03) for z in (20, 30)]
    >>> quick = CheckOptions(positions=12, refinement=0.5, convergence="off", body_teeth=3, torques=[20])
    >>> result = check(GearPair(pinion=gears[0], wheel=gears[1]), Load(torque=20), check=quick)
    >>> f"{result.rating.to_dict()['p_0']:.0f} MPa by Hertz, {result.summary.contact_pressure_pitch_point:.0f} MPa here"
    '683 MPa by Hertz, 683 MPa here'

    Raises ParameterError without a pair or a load, ParameterError and GeometryError for what cannot be checked, SolverError
    where a solver fails.
    """
    return Check(model=model, report=False).run(as_design(subject, load, **inputs), progress)
