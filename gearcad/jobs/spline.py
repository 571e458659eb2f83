"""Job `check` of a spline joint: mean stresses and the contact of all its teeth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gearcad.core.errors import GeometryError
from gearcad.core.records import JsonObject, Notice
from gearcad.core.runtime import Progress
from gearcad.designs.design import Design
from gearcad.designs.gear_designs import SplineDesign
from gearcad.designs.keys import DesignKind
from gearcad.geometry.spline_standards import HUB, SHAFT
from gearcad.jobs.job import Job
from gearcad.material import Material
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.check.spline import SplineCheck


@dataclass(frozen=True, kw_only=True)
class CheckSpline(Job[SplineDesign, "SplineCheck"]):
    """The check of a spline joint under its [load]; its document is check.json, as that of pairs."""

    verb = "check"
    accepts = (DesignKind.SPLINE,)
    why = "it has no spline"

    def run(self, design: Design, progress: Progress | None = None) -> SplineCheck:
        from gearcad.check.spline import check_spline

        accepted = self.accepted(design, progress)
        if accepted.load is None:
            raise GeometryError("load.torque", None, "must be given to check a spline (in N·m)")
        return check_spline(accepted.spline, accepted.load, accepted.material or Material(), progress)

    def document(self, result: SplineCheck) -> JsonObject:
        about = {"kind": "check", "name": result.joint.name, "gearcad": __version__}
        return about | result.to_dict() | {"passed": result.passed, "strength": None, "not_judged": list(NOT_JUDGED)}

    def notices(self, result: SplineCheck) -> Sequence[Notice]:
        return (*result.joint.notices, *result.notices)

    def conclusion(self, name: str, result: SplineCheck) -> str:
        """Return one line: whether the figures are settled, and that strength was not judged."""
        settled = "numerics passed" if result.passed else "numerics FAILED: two meshes differ by more than 2 %"
        return f"{name}: {settled}; strength not judged: {', '.join(NOT_JUDGED)} (no permissible stresses are known)"


NOT_JUDGED = ("flank pressure", "root stress", "torsion")
"""Stresses that are told and not judged."""


def spline_lines(result: SplineCheck) -> list[str]:
    """Return the figures of a check for the screen."""
    mean, contact = result.mean, result.contact
    shaft, hub = contact.root_stresses
    rows = [
        ("Mean stresses", None, ""),
        (f"flank pressure, {result.joint.carrying_share:g} of the flanks carry", mean.flank_pressure, "MPa"),
        ("shear of the teeth", mean.tooth_shear, "MPa"),
        ("torsion of the shaft's core", mean.torsion, "MPa"),
        (f"Contact of all teeth, {result.of_play} {1000 * result.play:.1f} µm", None, ""),
        ("greatest share of a tooth", 100 * float(contact.shares.max()), "%"),
        ("share of the teeth that carry, by the greatest", result.carrying, ""),
        ("greatest mean pressure of a flank", float(contact.mean_pressures.max()), "MPa"),
        (f"greatest root stress, {SHAFT}", float(shaft.max()), "MPa"),
        (f"greatest root stress, {HUB}", float(hub.max()), "MPa"),
        ("difference of two meshes, at most", 100 * max(map(abs, result.convergence.values())), "%"),
    ]
    return [words if value is None else f"  {words:<52}{value:>12.4g} {unit}".rstrip() for words, value, unit in rows]
