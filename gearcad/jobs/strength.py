"""Jobs `check`, `rate` and `stiffness`: finite element contact, safeties, and mesh stiffness of a pair."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, TypedDict, Unpack

from gearcad.check.columns import check_columns
from gearcad.check.options import CheckOptions, Model
from gearcad.check.result import CheckResult, check_document, reported_document
from gearcad.check.run import check_pair, expected_check
from gearcad.check.task import CheckTask
from gearcad.core.errors import ParameterError, SolverError, require_whole
from gearcad.core.quantities import with_assumed
from gearcad.core.records import JsonObject, Notice
from gearcad.core.runtime import Expected, Progress, one_thread
from gearcad.core.symbols import STIFFNESS, STRENGTH_FIGURES
from gearcad.designs import Design, DesignKind, Inputs, PairDesign, PlanetaryDesign, RackPairDesign
from gearcad.designs.keys import RIGID_SHAFTS
from gearcad.dynamics.planetary.planetary_strength import TrainStrength
from gearcad.geometry import GearPair, RackPair
from gearcad.jobs.job import ReportedJob, Subject, Writer, as_design
from gearcad.jobs.train import suited
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.planetary import TrainLoad
from gearcad.rating.friction import mesh_efficiency
from gearcad.rating.load_factors import BodyLoad
from gearcad.rating.strength import INFINITE, StrengthRating, rate_strength
from gearcad.stiffness.comparison import StiffnessComparison, curves_csv
from gearcad.stiffness.methods import METHODS, compare_methods, expected_methods
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.planetary_result import PlanetaryStudy


_NO_LOAD = "without it there is no stress"


@dataclass(frozen=True, kw_only=True)
class Check(ReportedJob[PairDesign | RackPairDesign, CheckResult]):
    """The structural check of a pair, or of a pinion and a rack.

    `model` ("2d" or "3d") wins over that of the design's own [check].

    Without `report` there is check.json alone, and nothing is solved for the report only.
    """

    verb = "check"
    accepts = (DesignKind.PAIR, DesignKind.RACK_PAIR)
    why = "a single gear has nothing to press against"
    sometimes: ClassVar[tuple[str, ...]] = ("stress_pinion.vtu", "stress_wheel.vtu")

    model: str | None = None

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> CheckResult:
        design = self.accepted(design, progress)
        result = check_pair(self._task(design), progress)
        if self.report:
            result.solve_shown()
        return result

    def expected(self, design: Design) -> Expected:
        return expected_check(self._task(self.accepted(design)))

    def _task(self, design: PairDesign | RackPairDesign) -> CheckTask:
        """Return the task of the design, by the model of the job if it has one."""
        return design.check_task(_NO_LOAD, self._options(design))

    def _options(self, design: PairDesign | RackPairDesign) -> CheckOptions:
        options = design.check or CheckOptions()
        return options if self.model is None else replace(options, model=self.model)

    def document(self, result: CheckResult) -> JsonObject:
        """Return the content of check.json.

        Stiffness is in N/(mm·µm) of common face width, transmission error in µm, stresses in MPa.
        """
        return reported_document(result) if self.report else check_document(result)

    def notices(self, result: CheckResult) -> Sequence[Notice]:
        return result.all_notices

    def design_notices(self, design: Design) -> Sequence[Notice]:
        """Return the notices of a design; solid bodies sit on its shafts."""
        on_shafts = isinstance(design, PairDesign) and self._options(design).model_for(design.pair) is Model.SOLID
        return [each for each in super().design_notices(design) if not (on_shafts and each.code == RIGID_SHAFTS)]

    def conclusion(self, name: str, result: CheckResult) -> str:
        return f"{name} at {result.torque:g} N·m: {result.verdict}"

    def figures(self, document: JsonObject) -> JsonObject:
        """Return verdicts, deviations, errors, summary, safeties and rating for one line of a table."""
        return check_columns(document)

    def files(self, result: CheckResult) -> dict[str, Writer]:
        """check.json, the report, and of solid bodies the stresses in the most stressed tooth of each gear."""
        document: dict[str, Writer] = {"check.json": partial(self.write_document, result)}
        if not self.report:
            return document
        return {**document, "report.html": partial(_check_write_report, result, self.head), **result.stress_files}


def _check_write_report(result: CheckResult, head: Mapping[str, str], path: Path) -> None:
    from gearcad.report import write_report

    write_report(result, result.pair.name, path, head)


def check(
    subject: Design | GearPair | RackPair,
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

    A train of pairs has MeshResults, one for each of its meshes. Raises ParameterError without a pair or a load, ParameterError
    and GeometryError for what cannot be checked, SolverError where a solver fails.
    """
    design = as_design(subject, load, **inputs)
    return suited(Check(model=model, report=False), design).run(design, progress)


_VERDICT = ("passed", "strength")


def rate_columns(document: Mapping[str, Any]) -> JsonObject:
    """Return the figures of a rate.json for one line of a table.

    They are the verdict, safeties of each gear and the least, torque, life, scuffing, factors and stresses. Of a planetary
    train they are the verdict, the least safeties and the life of all its meshes. A life without end is no number: it has a
    column.
    """
    verdict, warnings = {name: document[name] for name in _VERDICT}, {"warnings": document["warnings"]}
    if "meshes" in document:
        return {**verdict, **_of_meshes([_least_of(each) for each in document["meshes"].values()]), **warnings}
    safety = document["safety"]
    return {
        **verdict,
        "S_H": safety["flank"],
        "S_F": safety["root"],
        **_least_of(document),
        "S_int": safety["scuffing"]["integral"],
        "S_B": safety["scuffing"]["flash"],
        **{symbol: factor for symbol, factor in document["factors"].items() if symbol in STRENGTH_FIGURES},
        **{symbol: stress for symbol, stress in document["stresses"].items() if symbol in STRENGTH_FIGURES},
        **warnings,
    }


class _LeastFigures(TypedDict):
    """The least safeties of flank and root of a pair, its permissible torque (N·m) and its life (h), None where not known."""

    S_H_min: float | None
    S_F_min: float | None
    permissible_torque: float | None
    life: float | None
    life_infinite: bool | None


def _of_meshes(every: list[_LeastFigures]) -> JsonObject:
    """Return the least of all meshes, whose torques are on different gears."""
    finite = [each["life"] for each in every if each["life"] is not None]
    known = bool(every) and all(each["life_infinite"] is not None for each in every)
    flank, root = ([each["S_H_min"] for each in every], [each["S_F_min"] for each in every])
    return {
        **({"S_H_min": _least(flank), "S_F_min": _least(root)} if every else {}),
        "life": min(finite) if known and finite else None,
        "life_infinite": not finite if known else None,
    }


def _least_of(document: Mapping[str, Any]) -> _LeastFigures:
    """Return the least of both gears, and of flanks and roots."""
    life = document["life"]["least"]
    return {
        "S_H_min": _least(document["safety"]["flank"].values()),
        "S_F_min": _least(document["safety"]["root"].values()),
        "permissible_torque": document["permissible_torque"]["least"],
        "life": None if life == INFINITE else life,
        "life_infinite": None if life is None else life == INFINITE,
    }


def _least(values: Collection[float | None]) -> float | None:
    """Return the least value, or None where one is not known."""
    known = [value for value in values if value is not None]
    return min(known) if len(known) == len(values) else None


KEYS = {"torque": "load.torque", "hardness": "material.hardness"}
"""Keys of values that only the rating can refuse."""


@dataclass(frozen=True, kw_only=True)
class Rate(ReportedJob[PairDesign | RackPairDesign | PlanetaryDesign, StrengthRating | TrainStrength]):
    """The rating of a pair as mounted, or of the meshes of a planetary train, by the standard that its [rating] names.

    Without `report` there is rate.json alone.
    """

    verb = "rate"
    accepts = (DesignKind.PAIR, DesignKind.RACK_PAIR, DesignKind.PLANETARY)
    why = "a single gear carries nothing"

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> StrengthRating | TrainStrength:
        design = self.accepted(design, progress)
        if isinstance(design, PlanetaryDesign):
            return _of_train(design)
        load = design.loaded(_NO_LOAD)
        if isinstance(design, RackPairDesign):
            return rate_strength(design.pair, design.materials, load, design.rating)
        pair = design.pair if design.mounting is None else design.mounting.mounted(design.pair)
        by_bodies = _of_bodies(design, load)
        found = rate_strength(pair, design.materials, load, design.rating, body_load=by_bodies, face_load=design.face_load)
        friction = None if design.check is None else design.check.friction
        if friction is None:
            return found
        return replace(found, efficiency=mesh_efficiency(pair, found.materials, load, friction, found.options))

    def design_notices(self, design: Design) -> Sequence[Notice]:
        """Return the notices of a design, without that on shafts where K_Hbeta is that on them."""
        options = getattr(design, "rating", None)
        on_shafts = options is not None and options.face_load_factor in ("shafts", "fe")
        return [each for each in super().design_notices(design) if not (on_shafts and each.code == RIGID_SHAFTS)]

    def document(self, result: StrengthRating | TrainStrength) -> JsonObject:
        """Return the values under their symbols, those of one gear under "pinion" and "wheel"; `symbols.STRENGTH` has the
        words.
        """
        return {"kind": self.verb, "name": result.name, "gearcad": __version__, **result.to_dict()}

    def notices(self, result: StrengthRating | TrainStrength) -> Sequence[Notice]:
        return result.notices

    def conclusion(self, name: str, result: StrengthRating | TrainStrength) -> str:
        at = f" at {load_words(result)}" if isinstance(result, StrengthRating) else ""
        return f"{name}{at}: {result.verdict}"

    def figures(self, document: JsonObject) -> JsonObject:
        """Return the figures for one line of a table."""
        return rate_columns(document)

    def files(self, result: StrengthRating | TrainStrength) -> dict[str, Writer]:
        """Return the document and the report; of a planetary train a report for each mesh."""
        found: dict[str, Writer] = {"rate.json": partial(self.write_document, result)}
        if not self.report:
            return found
        if isinstance(result, StrengthRating):
            return {**found, "rate.html": partial(_write_report, result, result.name, self.head)}
        reports = {
            f"rate-{name}.html": partial(_write_report, each, f"{result.name}, {name}", self.head)
            for name, each in result.meshes.items()
        }
        return {**found, **reports}


def load_words(rating: StrengthRating) -> str:
    """Return in words the load of a rating: torque and speed."""
    load = rating.load
    torque = f"{load.torque:.6g} N·m" if rating.own_names is None else f"{load.torque:.6g} N·m on {rating.own_names.pinion}"
    return f"{torque}, {load.speed:.6g} rpm" if load.speed else torque


def _of_bodies(design: PairDesign, load: Load) -> BodyLoad | None:
    """K_Hbeta of the load distribution of solid bodies, if the options ask for it."""
    options = design.rating
    if options is None or options.face_load_factor != "fe":
        return None
    from gearcad.check.run import load_distribution

    return load_distribution(design.check_task(_NO_LOAD)).body_load


def _of_train(design: PlanetaryDesign) -> TrainStrength:
    """Return the rating of a planetary train from its study, in which planets share the load."""
    from gearcad.dynamics.planetary.planetary_study import study_planetary  # only here: pairs do not need the dynamics

    load = design.loaded(_NO_LOAD)
    found = study_planetary(
        design.train, load, design.speeds, material=design.material, dynamics=design.dynamics, rating=design.rating
    )
    return strength_in_study(design, found)


def strength_in_study(design: PlanetaryDesign, study: PlanetaryStudy) -> TrainStrength:
    """Return the rating of a train, of its study. Raises ParameterError without a load,
    SolverError where the study has none.
    """
    design.loaded(_NO_LOAD)
    if study.rating is None:
        raise SolverError(f"{design.name} is not rated: {study.why_not['rating']}")
    return study.rating.strength


def _write_report(result: StrengthRating, name: str, head: Mapping[str, str], path: Path) -> None:
    from gearcad.report import write_rate_report

    write_rate_report(result, name, path, head)


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
    design = as_design(subject, load, **inputs)
    return suited(Rate(report=False), design).run(design)


_STIFFNESS_NO_LOAD = "stiffness depends on it"


@dataclass(frozen=True, kw_only=True)
class Stiffness(ReportedJob[PairDesign | RackPairDesign, StiffnessComparison]):
    """Mesh stiffness by `methods`, at so many `positions` over one base pitch (0: those of each method).

    `fourier` says how many harmonics of each curve the document has.
    """

    verb = "stiffness"
    accepts = (DesignKind.PAIR, DesignKind.RACK_PAIR)
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

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> StiffnessComparison:
        design = self.accepted(design, progress)
        return compare_methods(
            design.pair,
            design.material or Material(),
            design.loaded(_STIFFNESS_NO_LOAD),
            self.methods,
            body=(design.check or CheckOptions()).body,
            mounting=_mounting(design),
            positions=self.positions,
            progress=progress,
        )

    def expected(self, design: Design) -> Expected:
        design = self.accepted(design)
        design.loaded(_STIFFNESS_NO_LOAD)
        pair, material, body = design.pair, design.material or Material(), (design.check or CheckOptions()).body
        return expected_methods(pair, material, self.methods, body=body, mounting=_mounting(design), positions=self.positions)

    def document(self, result: StiffnessComparison) -> JsonObject:
        """Return the content of stiffness.json: N/µm, per face width N/(mm·µm), degrees, µm."""
        head = {"kind": "stiffness", "name": result.pair.name, "gearcad": __version__}
        return with_assumed(head | result.to_dict(self.fourier))

    def notices(self, result: StiffnessComparison) -> Sequence[Notice]:
        return result.notices

    def figures(self, document: JsonObject) -> JsonObject:
        """Return the figures of each method over one base pitch.

        Notes of the methods, and the reasons why others are left out, are warnings.
        """
        methods = document["methods"]
        notes = [f"{of['title']}: {note}" for of in methods.values() for note in of["notes"]]
        notes += [f"{METHODS[name].title}: left out: {reason}" for name, reason in document["left_out"].items()]
        figures = {method: {name: of[name] for name in STIFFNESS if name in of} for method, of in methods.items()}
        return {**figures, "warnings": notes}

    def files(self, result: StiffnessComparison) -> dict[str, Writer]:
        """Return the curves as CSV, the report, the document."""
        return {
            "stiffness.csv": partial(_write_curves, result),
            **({"stiffness.html": partial(_stiffness_write_report, result, self.head)} if self.report else {}),
            "stiffness.json": partial(self.write_document, result),
        }


def _mounting(design: PairDesign | RackPairDesign) -> Mounting | None:
    """Return the mounting of a design; a pinion and a rack have none."""
    return design.mounting if isinstance(design, PairDesign) else None


def _stiffness_write_report(comparison: StiffnessComparison, head: Mapping[str, str], path: Path) -> None:
    from gearcad.report import write_stiffness_report

    write_stiffness_report(comparison, comparison.pair.name, path, head)


def _write_curves(comparison: StiffnessComparison, path: Path) -> None:
    path.write_text(curves_csv(comparison), encoding="utf-8", newline="")


def stiffness(
    subject: Design | GearPair | RackPair,
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
    design = as_design(subject, load, **inputs)
    return suited(Stiffness(methods=methods, positions=positions), design).run(design, progress)
