"""Stiffness: that of a pair's mesh by every method, side by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Unpack

from gearcad.check.options import CheckOptions
from gearcad.designs import Design, DesignKind, Inputs, PairDesign
from gearcad.errors import ParameterError, require_whole
from gearcad.geometry import GearPair
from gearcad.jobs.job import Job, Writer
from gearcad.jobs.subject import as_design
from gearcad.load import Load
from gearcad.material import Material
from gearcad.notice import Notice
from gearcad.progress import Expected, Progress
from gearcad.schema import with_assumed
from gearcad.stiffness.compare import compare_methods, expected_methods
from gearcad.stiffness.comparison import StiffnessComparison
from gearcad.stiffness.curves import curves_csv
from gearcad.stiffness.methods import METHODS
from gearcad.symbols import STIFFNESS
from gearcad.version import __version__

__all__ = ["Stiffness", "stiffness"]

_NO_LOAD = "stiffness depends on it"


@dataclass(frozen=True, kw_only=True)
class Stiffness(Job[PairDesign, StiffnessComparison]):
    """Mesh stiffness by `methods`, at so many `positions` over one base pitch (0: those of each method).

    `fourier` says how many harmonics of each curve the document has.
    """

    verb = "stiffness"
    accepts = (DesignKind.PAIR,)
    why = "a single gear has no mesh"

    methods: Sequence[str] = tuple(METHODS)
    positions: int = 0
    fourier: int = 0

    def __post_init__(self) -> None:
        if isinstance(self.methods, str) or not isinstance(self.methods, Sequence) or not self.methods:
            raise ParameterError("methods", self.methods, 'must be a list of names, such as ["iso6336"]')
        if self.fourier != 0:
            fewest = min(
                (self.positions or METHODS[name].default_positions for name in self.methods if name in METHODS), default=0
            )
            require_whole("fourier", self.fourier, at_least=0, at_most=max(fewest // 4, 0))

    def _run(self, design: PairDesign, progress: Progress | None) -> StiffnessComparison:
        return compare_methods(
            design.pair,
            design.material or Material(),
            design.loaded(_NO_LOAD),
            self.methods,
            body=(design.check or CheckOptions()).body,
            mounting=design.mounting,
            positions=self.positions,
            progress=progress,
        )

    def _expected(self, design: PairDesign) -> Expected:
        design.loaded(_NO_LOAD)
        pair, material, body = design.pair, design.material or Material(), (design.check or CheckOptions()).body
        return expected_methods(pair, material, self.methods, body=body, mounting=design.mounting, positions=self.positions)

    def document(self, result: StiffnessComparison) -> dict[str, Any]:
        """What stiffness.json holds: N/µm, per face width N/(mm·µm), degrees, µm."""
        head = {"kind": "stiffness", "name": result.pair.name, "gearcad": __version__}
        return with_assumed(head | result.to_dict(self.fourier))

    def notices(self, result: StiffnessComparison) -> Sequence[Notice]:
        return result.notices

    def figures(self, document: dict[str, Any]) -> dict[str, Any]:
        """Of each method the figures over one base pitch; its notes, and why others are left out, are warnings."""
        methods = document["methods"]
        notes = [f"{of['title']}: {note}" for of in methods.values() for note in of["notes"]]
        notes += [f"{METHODS[name].title}: left out: {reason}" for name, reason in document["left_out"].items()]
        figures = {method: {name: of[name] for name in STIFFNESS if name in of} for method, of in methods.items()}
        return {**figures, "warnings": notes}

    def files(self, result: StiffnessComparison) -> dict[str, Writer]:
        """The curves as CSV, the report, the document."""
        return {
            "stiffness.csv": partial(_write_curves, result),
            "stiffness.html": partial(_write_report, result),
            "stiffness.json": partial(self.write_document, result),
        }


def _write_report(comparison: StiffnessComparison, path: Path) -> None:
    from gearcad.report import write_stiffness_report

    write_stiffness_report(comparison, comparison.pair.name, path)


def _write_curves(comparison: StiffnessComparison, path: Path) -> None:
    path.write_text(curves_csv(comparison), encoding="utf-8", newline="")


def stiffness(
    subject: Design | GearPair,
    load: Load | None = None,
    *,
    methods: Sequence[str] = tuple(METHODS),
    positions: int = 0,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> StiffnessComparison:
    """Mesh stiffness of a pair as mounted, under a load, by `methods`: names of `gearcad.stiffness.METHODS`.

    It is told at so many `positions` over one base pitch (0: those of each method). `material`, `mounting` and `check`
    (CheckOptions: where bodies are held), as the load, stand in place of those of a design; a pair has the defaults. A method
    that cannot treat the pair is left out, with its reason.

    >>> from gearcad import Gear, GearPair, Load
    >>> gears = [Gear(teeth=z, normal_module=2, face_width=20, tooth_thinning=0.03) for z in (20, 30)]
    >>> stiffness(GearPair(pinion=gears[0], wheel=gears[1]), Load(torque=60), methods=["iso6336", "potential-energy"])
    <StiffnessComparison of 'pair' at 60 N·m: iso6336 303.1, potential-energy 431.1 N/µm>

    Raises ParameterError without a pair or a load, or for an unknown method; where no method can treat the pair, what the first
    one raises.
    """
    return Stiffness(methods=methods, positions=positions).run(as_design(subject, load, **inputs), progress)
