"""Rate: whether a pair or a planetary train holds, how long, and what it would bear, by ISO 6336 or DIN 3990."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from gearcad.designs import Design, DesignKind, Inputs, PairDesign, PlanetaryDesign, RackPairDesign
from gearcad.dynamics.planetary.strength import TrainStrength
from gearcad.errors import SolverError
from gearcad.jobs.job import Job, Writer
from gearcad.jobs.rate_columns import rate_columns
from gearcad.jobs.subject import Subject, as_design
from gearcad.load import Load
from gearcad.notice import Notice
from gearcad.planetary import TrainLoad
from gearcad.progress import Progress
from gearcad.rating.load_factors import BodyLoad
from gearcad.rating.strength import StrengthRating, rate_strength
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.result import PlanetaryStudy

__all__ = ["Rate", "load_words", "rate", "strength_in_study"]

KEYS = {"torque": "load.torque", "hardness": "material.hardness"}
"""Keys of values that only the rating finds to be wrong."""

_NO_LOAD = "without it there is no stress"


@dataclass(frozen=True, kw_only=True)
class Rate(Job[PairDesign | RackPairDesign | PlanetaryDesign, StrengthRating | TrainStrength]):
    """The rating of a pair as mounted, or of the meshes of a planetary train, by the standard that its [rating] names.

    Without `report` there is rate.json alone.
    """

    verb = "rate"
    accepts = (DesignKind.PAIR, DesignKind.RACK_PAIR, DesignKind.PLANETARY)
    why = "a single gear carries nothing"

    report: bool = True

    def _run(
        self, design: PairDesign | RackPairDesign | PlanetaryDesign, _progress: Progress | None
    ) -> StrengthRating | TrainStrength:
        if isinstance(design, PlanetaryDesign):
            return _of_train(design)
        load = design.loaded(_NO_LOAD)
        if isinstance(design, RackPairDesign):
            return rate_strength(design.pair, design.materials, load, design.rating)
        pair = design.pair if design.mounting is None else design.mounting.mounted(design.pair)
        return rate_strength(pair, design.materials, load, design.rating, body_load=_of_bodies(design, load))

    def document(self, result: StrengthRating | TrainStrength) -> dict[str, Any]:
        """Values under their symbols, those of one gear under "pinion" and "wheel"; `symbols.STRENGTH` has the words."""
        return {"kind": self.verb, "name": result.name, "gearcad": __version__, **result.to_dict()}

    def for_row(self, _design: Design, _parts: Collection[str]) -> Rate:
        return replace(self, report=False)

    def notices(self, result: StrengthRating | TrainStrength) -> Sequence[Notice]:
        return result.notices

    def conclusion(self, name: str, result: StrengthRating | TrainStrength) -> str:
        at = f" at {load_words(result)}" if isinstance(result, StrengthRating) else ""
        return f"{name}{at}: {result.verdict}"

    def figures(self, document: dict[str, Any]) -> dict[str, Any]:
        """What a line of a table has of it."""
        return rate_columns(document)

    def files(self, result: StrengthRating | TrainStrength) -> dict[str, Writer]:
        """The document and the report; of a planetary train a report for each mesh."""
        found: dict[str, Writer] = {"rate.json": partial(self.write_document, result)}
        if not self.report:
            return found
        if isinstance(result, StrengthRating):
            return {**found, "rate.html": partial(_write_report, result, result.name)}
        reports = {
            f"rate-{name}.html": partial(_write_report, each, f"{result.name}, {name}") for name, each in result.meshes.items()
        }
        return {**found, **reports}


def load_words(rating: StrengthRating) -> str:
    """At what a pair is rated: torque and speed."""
    load = rating.load
    torque = f"{load.torque:.6g} N·m" if rating.own_names is None else f"{load.torque:.6g} N·m on {rating.own_names.pinion}"
    return f"{torque}, {load.speed:.6g} rpm" if load.speed else torque


def _of_bodies(design: PairDesign, load: Load) -> BodyLoad | None:
    """K_Hbeta of the load distribution of solid bodies, if the options ask for it."""
    options = design.rating
    if options is None or options.face_load_factor != "fe":
        return None
    from gearcad.check.load_distribution import load_distribution

    found = load_distribution(design.pair, design.materials, load, options, mounting=design.mounting, check=design.check)
    return found.body_load


def _of_train(design: PlanetaryDesign) -> TrainStrength:
    """That of its study, in which planets share the load."""
    from gearcad.dynamics.planetary.study import study_planetary  # only here: pairs do not need the dynamics

    load = design.loaded(_NO_LOAD)
    found = study_planetary(
        design.train, load, design.speeds, material=design.material, dynamics=design.dynamics, rating=design.rating
    )
    return strength_in_study(design, found)


def strength_in_study(design: PlanetaryDesign, study: PlanetaryStudy) -> TrainStrength:
    """The rating of a train, of its study. Raises ParameterError without a load, SolverError where the study has none."""
    design.loaded(_NO_LOAD)
    if study.rating is None:
        raise SolverError(f"{design.name} is not rated: {study.why_not['rating']}")
    return study.rating.strength


def _write_report(result: StrengthRating, name: str, path: Path) -> None:
    from gearcad.report import write_rate_report

    write_rate_report(result, name, path)


def rate(subject: Subject, load: Load | TrainLoad | None = None, **inputs: Unpack[Inputs]) -> StrengthRating | TrainStrength:
    """Rate a pair as mounted, under a load, by ISO 6336 or DIN 3990: safeties of flanks and roots, life, permissible torque.

    `material`, `mounting` and `rating` (RatingOptions), as the load, stand in place of those of a design; a pair has the
    defaults. What the standard does not cover, or what is not known - without an endurance limit or a speed nothing is - is not
    judged, and says why; `nominal` has the stresses that geometry and torque alone decide. A pinion and a rack are rated as a
    wheel of infinitely many teeth, without mounting; a planetary train mesh by mesh, as TrainStrength.

    >>> from gearcad import Gear, GearPair, Load, Material
    >>> gears = [Gear(teeth=z, normal_module=2, face_width=20) for z in (20, 30)]
    >>> pair, load = GearPair(pinion=gears[0], wheel=gears[1]), Load(torque=60, speed=1500)
    >>> rating = rate(pair, load, material=Material(name="Eh MQ"))
    >>> f"{rating.nominal.root_stresses[0]:.0f} and {rating.nominal.root_stresses[1]:.0f} MPa in the roots, nominally"
    '221 and 211 MPa in the roots, nominally'
    >>> rating
    <StrengthRating of 'pair' at 60 N·m: strength passed>

    Raises ParameterError without a pair or a torque, GeometryError for a pair whose contact the standard does not describe.
    """
    return Rate(report=False).run(as_design(subject, load, **inputs))
