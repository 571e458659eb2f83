"""CheckResult: the result of a structural check, of plane or solid gears, and its document for check.json."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from operator import attrgetter
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, TypedDict

from gearcad.check import pictures
from gearcad.check.comparison import SECTION, CheckStrength, Comparison, Subject, verdict
from gearcad.check.convergence import SOLID_ORDER, Convergence, SweepPoint, SweepTrends
from gearcad.check.depth import MaterialExposure
from gearcad.check.explanation import (
    Explanations,
    LoadShare,
    PlaneRootExplanation,
    SolidExplanations,
    explain_lines,
    explain_plane_roots,
    explain_solid_roots,
    explain_stiffness,
)
from gearcad.check.friction import MeshLosses
from gearcad.check.notices import elastic_end
from gearcad.check.oil_film import OilFilm
from gearcad.check.on_shafts import LoadOnShafts
from gearcad.check.options import CheckOptions, Model
from gearcad.check.pictures import (
    AlongFace,
    Cells,
    DepthProfile,
    FilletCurves,
    ShownPlane,
    ShownSolid,
    StressField,
    ToothStress,
    ToothSurface,
    along_face,
)
from gearcad.check.plastic import PlasticCheck
from gearcad.check.relief_start import ReliefStart
from gearcad.check.summary import PlaneSummary, SolidSummary, Summary, root_peaks
from gearcad.check.task import CheckTask, shown_contact
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact
from gearcad.contact.plane.sector import Plane
from gearcad.contact.shared.loaded import Cycle, Extreme, LoadedPosition, RootStress
from gearcad.contact.solid.cycle import SolidCycle, SolidPairContact
from gearcad.core.errors import GearcadError
from gearcad.core.quantities import inputs_document, with_assumed
from gearcad.core.records import NOT_ASKED_WORDS, JsonObject, Notice, PerGear, Pictured, Role, Verdict, strength_verdict, texts
from gearcad.core.runtime import one_thread
from gearcad.geometry import GearPair, RackPair
from gearcad.load import Load
from gearcad.material import Materials, by_gear, materials_document
from gearcad.mounting import Mounting
from gearcad.rating.nominal_rating import Rating
from gearcad.rating.strength import RatedPart
from gearcad.stiffness import (
    CLOSED_FORMS,
    PlaneStrainContact,
    PlaneStressContact,
    SolidContact,
    StiffnessComparison,
    StiffnessMethod,
    compare_methods,
)


class StiffnessMethods(NamedTuple):
    """The closed forms and the model of a check, in this order; None for a `reason` where they cannot be had."""

    comparison: StiffnessComparison | None
    reason: str = ""

    def to_dict(self) -> JsonObject:
        """Return the figures of each as in `stiffness.json`, which has their curves too; stiffness in N/µm."""
        if self.comparison is None:
            return {"methods": {}, "left_out": {}, "reason": self.reason}
        document = self.comparison.to_dict()
        for method in document["methods"].values():
            del method["mesh_cycle"]
        return {"methods": document["methods"], "left_out": document["left_out"], "reason": ""}


def stiffness_methods(task: CheckTask, own: Callable[[Mounting], StiffnessMethod], positions: int) -> StiffnessMethods:
    """Return the check's `own` model, at its own even positions, beside the closed forms."""
    mounting = replace(task.mounting, centre_distance_change=0.0)  # the pair is as mounted already
    try:
        closed = compare_methods(task.pair, task.material, task.load, CLOSED_FORMS, body=task.options.body, mounting=mounting)
        # Positions and torque of the check itself: solid bodies know what they answer there.
        with one_thread():
            cycle = own(mounting)(task.load, positions)
    except GearcadError as error:
        return StiffnessMethods(None, str(error))
    return StiffnessMethods(replace(closed, cycles=(*closed.cycles, cycle)))


class MeanLag(NamedTuple):
    """Mean lag of the wheel behind the pinion, and each gear's part of it (µm along the line of action)."""

    whole: float
    parts: PerGear[float]


class PitchLineError(NamedTuple):
    """Mean lag of a rack along the pitch line, and how far it swings (µm)."""

    mean: float
    swing: float


def _pressure_cosine(pair: RackPair) -> float:
    """Return cos alpha_t: a distance along the line of action over that along the pitch line."""
    return math.cos(math.radians(pair.working_transverse_pressure_angle))


@dataclass(frozen=True, kw_only=True)
class CheckResult(Pictured, ABC):
    """A task, and all results of its check."""

    task: CheckTask
    cycle: Cycle
    summary: Summary
    sweep: tuple[SweepPoint, ...]
    convergence: tuple[Convergence, ...]
    comparisons: tuple[Comparison, ...]
    notices: tuple[Notice, ...]
    relief_starts: tuple[ReliefStart, ...] = ()
    losses: MeshLosses | None = None
    plastic: PlasticCheck | None = None
    exposure: Mapping[Role, MaterialExposure] = field(default_factory=dict)
    film: OilFilm | None = None

    model: ClassVar[Model]

    shown_by_reports: ClassVar[tuple[str, ...]]
    """Results that are solved for reports only."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.pair.name!r} at {self.torque:g} N·m: {self.verdict}>"

    # ------------------------------------------------------------------ the task

    @property
    def pair(self) -> GearPair | RackPair:
        """Gear pair as mounted."""
        return self.task.pair

    @property
    def names(self) -> PerGear[str]:
        """Names of both gears: pinion and wheel, or pinion and rack."""
        return self.rating.names

    @property
    def ring(self) -> bool:
        """True of a pinion in a ring."""
        return isinstance(self.pair, GearPair) and self.pair.internal

    @property
    def material(self) -> Materials:
        """Material of both gears, or of each."""
        return self.task.material

    @property
    def load(self) -> Load:
        """Load as it was given."""
        return self.task.load

    @property
    def mounting(self) -> Mounting:
        """Mounting of the pair; its change of the centre distance is in the pair already."""
        return self.task.mounting

    @property
    def options(self) -> CheckOptions:
        """Options as they were given."""
        return self.task.options

    @property
    def torque(self) -> float:
        """Torque on the pinion, with the application factor (N·m)."""
        return self.task.torque

    @property
    def rating(self) -> Rating:
        """Rating by ISO 6336 or DIN 3990, Method B: nominal stresses with K_A."""
        return self.task.rating

    @cached_property
    def safeties(self) -> CheckStrength:
        """The full rating, and safeties by the stresses of finite elements beside its own."""
        return CheckStrength.of(self.task, self.summary)

    # ------------------------------------------------------------------ over the mesh

    @property
    def single_positions(self) -> int:
        """Number of even positions that have one pair of teeth in contact."""
        return sum(len(position.contacts) == 1 for position in self.cycle.positions)

    @property
    def mean_lag(self) -> MeanLag:
        """The transmission error on the mean."""
        whole, parts = (self.cycle.mean(name)[0] for name in ("transmission_error", "approach_parts"))
        return MeanLag(float(whole), PerGear(*(1000 * parts).tolist()))

    @property
    def bending(self) -> PerGear[bool]:
        """Whether the rim of each gear bends."""
        return self.task.body.supports(self.pair).map(lambda support: support.bends)

    @property
    def pitch_line_error(self) -> PitchLineError | None:
        """The transmission error of a rack along the pitch line; None of gears."""
        if not isinstance(self.pair, RackPair):
            return None
        cosine = _pressure_cosine(self.pair)
        return PitchLineError(self.mean_lag.whole / cosine, self.summary.transmission_error_peak_to_peak / cosine)

    @cached_property
    def load_share(self) -> LoadShare:
        """Load share of one pair of teeth while it goes through the mesh."""
        return LoadShare.of(self.cycle)

    @cached_property
    def root_positions(self) -> PerGear[LoadedPosition[Any]]:
        """Position of the greatest root tension of each gear."""
        return PerGear.each(self.cycle.worst_position)

    @property
    def root_peaks(self) -> PerGear[RootStress]:
        """The greatest root tension of each gear."""
        return root_peaks(self.cycle)

    @property
    def trends(self) -> SweepTrends:
        """Trends of the figures over the torque."""
        return SweepTrends.of(self.sweep)

    def solve_shown(self) -> None:
        """Solve now what reports show, which is else solved when it is first asked for."""
        for name in self.shown_by_reports:
            getattr(self, name)

    @property
    @abstractmethod
    def explanations(self) -> Explanations[Any]:
        """Reasons why finite elements and the standard differ."""

    @cached_property
    def stiffness_methods(self) -> StiffnessMethods:
        """The mesh stiffness by the check's own model beside closed forms; solved when it is first asked for."""
        return stiffness_methods(self.task, self._as_method, len(self.cycle.positions))

    @abstractmethod
    def _as_method(self, mounting: Mounting) -> StiffnessMethod:
        """Return the bodies of the check as a method of mesh stiffness, for the pair as it is mounted."""

    # ------------------------------------------------------------------ files and documents

    @property
    def own_document(self) -> JsonObject:
        """Part of `check.json` that only this model has."""
        return {}

    @property
    def stress_files(self) -> Mapping[str, Callable[[Path], None]]:
        """Functions that write stress fields to a path, by the names of files; there are none in the plane."""
        return {}

    # ------------------------------------------------------------------ the verdict

    @property
    def bodies(self) -> dict[str, str]:
        """Words on how each body is modelled."""
        return self.task.body.describe(self.pair)

    @property
    def numerics(self) -> Verdict:
        """Whether the numbers are those of the model."""
        return verdict(self.comparisons, Subject.NUMERICS)

    @property
    def strength(self) -> Verdict:
        """The verdict on strength by `strength_verdict`: the rating's, with the limits of local stresses as further gates."""
        rating = self.safeties.rating
        if self.task.is_section and rating.asked:
            return Verdict.NOT_JUDGED
        gates = verdict(self.comparisons, Subject.STRENGTH)
        return strength_verdict(rating.asked, rating.required_verdicts, [gates] if gates is Verdict.FAILED else [])

    @property
    def passed(self) -> bool:
        """Whether no gate of the numerics fails, and strength is passed or not asked for."""
        return self.numerics is not Verdict.FAILED and not self.strength.falls_short

    @property
    def without_limit(self) -> tuple[str, ...]:
        """Stresses, in words, for which the material has no limit and which the rating does not judge."""
        limits = {
            "contact pressure": ("contact_limit", RatedPart.FLANK),
            "root stress": ("root_limit", RatedPart.ROOT),
            "von Mises stress below the flank": ("yield_strength", None),
        }
        return tuple(
            f"{words} of the {gear}" if gear else words
            for words, (limit, part) in limits.items()
            for gear, material in by_gear(self.material).items()
            if getattr(material, limit) is None and not self._rates(part)
        )

    def _rates(self, part: RatedPart | None) -> bool:
        """Return whether the rating judges this quantity of both gears."""
        return part is not None and all(each.rated.safety is not None for each in self.safeties.parts[part])

    @property
    def verdict(self) -> str:
        """Numerics and strength in one line."""
        numerics = "NOT passed" if self.numerics is Verdict.FAILED else self.numerics.value
        strength = {
            Verdict.NOT_JUDGED: f"not judged: {self._not_judged}",
            Verdict.NOT_ASKED: NOT_ASKED_WORDS,
        }.get(self.strength, self.strength.value)
        if below := self.safeties.below_required:
            standard = self.safeties.rating.options.standard.part(2)[:-2]
            strength += f" by {standard}; by finite elements {', '.join(below)}"
        if self.without_limit and self.strength in (Verdict.PASSED, Verdict.FAILED):
            strength += f"; not judged, no limit given: {', '.join(self.without_limit)}"
        ended = "; linear elasticity is exceeded, see the warnings" if elastic_end(self.task, self.summary) else ""
        return f"numerics {numerics}{ended}; strength {strength}"

    @property
    def _not_judged(self) -> str:
        """Return why strength was not judged: each reason of the rating once."""
        if self.task.is_section:
            return SECTION
        return "; ".join(dict.fromkeys(self.safeties.rating.not_judged.values()))

    # ------------------------------------------------------------------ what to know before trusting it

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    @property
    def all_notices(self) -> tuple[Notice, ...]:
        """Notices of the check, and those of the rating."""
        return (*self.notices, *(notice.within("rating") for notice in self.rating.notices))


def check_document(result: CheckResult) -> JsonObject:
    """Return everything of a check under the names of check.json."""
    document = {
        "kind": "check",
        "model": result.model.value,
        "load": inputs_document(result.load),
        "mounting": asdict(result.mounting),
        **materials_document(result.material),
        "options": inputs_document(result.options),
        "body": result.bodies,
        "mesh": {role.value: body.mesh_document for role, body in result.cycle.model.bodies.items()},
        **result.own_document,
        "positions": len(result.cycle.positions),
        "mesh_cycle": _cycle(result),
        "summary": result.summary.to_dict(),
        "not_evaluated": result.summary.missing,
        "extremes": {name: _extreme(of) for name, of in result.summary.extremes.items()},
        **({} if result.losses is None else {"friction": result.losses.to_dict()}),
        **({"depth": {role.value: of.to_dict() for role, of in result.exposure.items()}} if result.exposure else {}),
        **({} if result.film is None else result.film.to_dict()),
        "torque_sweep": [point.to_dict() for point in result.sweep],
        "torque_trends": result.trends.to_dict(),
        "rating": result.rating.to_dict(),
        "strength_rating": {key: value for key, value in result.safeties.rating.to_dict().items() if key != "nominal"},
        "safeties": result.safeties.to_dict(),
        "convergence": [each.to_dict() for each in result.convergence],
        "relief_starts": [start.to_dict() for start in result.relief_starts],
        **({} if result.plastic is None else {"plastic": result.plastic.to_dict()}),
        "comparisons": [comparison.to_dict() for comparison in result.comparisons],
        "explanations": result.explanations.to_dict(),
        "warnings": list(result.warnings),
        "notices": [notice.to_dict() for notice in result.notices],
        "not_judged": dict(result.safeties.rating.not_judged),
        "numerics": result.numerics.value,
        "strength": result.strength.value,
        "passed": result.passed,
        "verdict": result.verdict,
    }
    return with_assumed(document)


def reported_document(result: CheckResult) -> JsonObject:
    """Return the document with all that a report shows: also the mesh stiffness by other methods.

    This takes part of the check's time.
    """
    return check_document(result) | {"stiffness_methods": result.stiffness_methods.to_dict()}


def _extreme(of: Extreme | None) -> dict[str, float | None] | None:
    """Value, roll angle, and what the positions may miss of it (relative; null where nothing is known of that)."""
    if of is None:
        return None
    return {"value": of.value, "roll_angle": of.roll_angle, "error": of.error if math.isfinite(of.error) else None}


def _cycle(result: CheckResult) -> JsonObject:
    """Return the lists over the positions; those of load share and pressure hold one value for each of `pairs`, 0 out of
    contact.

    The pressure of a contact of edges alone is null: it depends on the mesh.
    """
    positions = result.cycle.positions
    by_tooth = [{contact.tooth: contact for contact in position.contacts} for position in positions]
    pairs = sorted(set().union(*by_tooth))
    return {
        "roll_angle": [position.roll_angle for position in positions],
        "mesh_stiffness": [position.stiffness for position in positions],
        "transmission_error": [position.transmission_error for position in positions],
        "pairs": pairs,
        "load_share": [[of[pair].share if pair in of else 0.0 for pair in pairs] for of in by_tooth],
        "contact_pressure": [[of[pair].interior_pressure if pair in of else 0.0 for pair in pairs] for of in by_tooth],
        "root_stress_pinion": [position.tension.pinion.stress for position in positions],
        "root_stress_wheel": [position.tension.wheel.stress for position in positions],
        "root_compression_pinion": [position.compression.pinion.stress for position in positions],
        "root_compression_wheel": [position.compression.wheel.stress for position in positions],
    }


@dataclass(frozen=True, kw_only=True, repr=False)
class PlaneCheck(CheckResult):
    """A check in the transverse section through the middle of the common face width."""

    cycle: PlaneCycle
    summary: PlaneSummary

    model: ClassVar[Model] = Model.PLANE

    shown_by_reports: ClassVar[tuple[str, ...]] = ("stiffness_methods", "stress_field", "fillet_curves")

    @cached_property
    def explanations(self) -> Explanations[PlaneRootExplanation]:
        return Explanations(
            stiffness=explain_stiffness(self.task, self.cycle, self.summary, self.sweep),
            root_stress=explain_plane_roots(self.task, self.cycle, self.summary, self.load_share),
        )

    @property
    def own_document(self) -> JsonObject:
        """Helix angle (deg) and load (N/mm) of a section of helical teeth; force (N) along a rack, and the rack's lag along the
        pitch line (µm) at the positions.
        """
        section: JsonObject = {}
        if self.task.is_section:
            load = self.cycle.model.force(self.torque)
            section["section"] = {"helix_angle": self.pair.pinion.helix_angle, "line_load": load, "notice": SECTION}
        if not isinstance(self.pair, RackPair):
            return section
        lag = self.cycle.values("transmission_error") / _pressure_cosine(self.pair)
        return section | {"rack": {"force": self.pair.rack_force(abs(self.torque)), "transmission_error": lag.tolist()}}

    @property
    def contacts_along_path(self) -> list[PlanePairContact]:
        """All contacts of the cycle in the order in which one pair of teeth goes through them."""
        return sorted((contact for _, contact in self.cycle.contacts), key=attrgetter("place"))

    @property
    def hertz_deviation(self) -> float | None:
        """The greatest deviation of a peak pressure from Hertz's; None if all contacts are near the ends of the flanks."""
        contacts = [contact for _, contact in self.cycle.interior_contacts if contact.two_cylinders]
        return max((abs(contact.peak_pressure / contact.hertz_pressure - 1) for contact in contacts), default=None)

    def _as_method(self, mounting: Mounting) -> StiffnessMethod:
        method = PlaneStressContact if self.options.plane_state is Plane.STRESS else PlaneStrainContact
        return method(
            pair=self.pair, material=self.material, body=self.options.body, mounting=mounting, bodies=self.cycle.model
        )

    # ------------------------------------------------------------------ what pictures show

    @cached_property
    def shown(self) -> ShownPlane:
        """The contact that pictures show."""
        return shown_contact(self.cycle)

    @cached_property
    def stress_field(self) -> StressField:
        """Stress field around the contact that is shown."""
        return pictures.stress_field(self.cycle, self.shown)

    @cached_property
    def fillet_curves(self) -> PerGear[FilletCurves]:
        """Fillet curves of both gears, each where its root tension is greatest."""
        return pictures.fillet_curves(self.cycle)

    @cached_property
    def depth_profile(self) -> DepthProfile:
        """Stresses below the contact that is shown."""
        return pictures.depth_profile(self.cycle, self.shown.contact)


class LineOfContact(TypedDict):
    """A line of contact in check.json; its lists (n,) go cell by cell along the face width.

    `across` is from the middle of the common face width; lengths in mm, loads in N/mm, pressures in MPa.
    """

    tooth: int
    across: list[float]
    pinion_roll_length: list[float]
    wheel_roll_length: list[float]
    length: list[float]
    line_load: list[float]
    pressure: list[float]
    half_width: list[float]
    on_edge: list[bool]
    interior: list[bool]


def load_distribution(cycle: SolidCycle) -> list[list[LineOfContact]]:
    """Return the lines of contact that carry, position by position."""
    return [[_line(contact) for contact in position.contacts] for position in cycle.positions]


def _line(contact: SolidPairContact) -> LineOfContact:
    line = contact.line
    return {
        "tooth": contact.tooth,
        "across": line.across.tolist(),
        "pinion_roll_length": line.places.pinion[0].tolist(),
        "wheel_roll_length": line.places.wheel[0].tolist(),
        "length": line.lengths.tolist(),
        "line_load": contact.line_loads.tolist(),
        "pressure": contact.pressures.tolist(),
        "half_width": contact.half_widths.tolist(),
        "on_edge": line.on_edge.tolist(),
        "interior": contact.interior.tolist(),
    }


@dataclass(frozen=True, kw_only=True, repr=False)
class SolidCheck(CheckResult):
    """A check of solid bodies; under a negative torque `cycle` is that of the mirrored pair.

    `tooth_stresses` are those of the most stressed tooth of each gear. `shafts` is the load over the face on the pair's shafts,
    None where they are rigid.
    """

    cycle: SolidCycle
    summary: SolidSummary
    tooth_stresses: PerGear[ToothStress]
    shafts: LoadOnShafts | None = None

    model: ClassVar[Model] = Model.SOLID

    shown_by_reports: ClassVar[tuple[str, ...]] = ("stiffness_methods", "along_face", "cells", "tooth_surfaces")

    greatest_order: ClassVar[float] = SOLID_ORDER
    """The greatest order of convergence that meshes of solids are credited with."""

    @cached_property
    def along_face(self) -> AlongFace:
        """Load and root stress over the face width."""
        return along_face(self.cycle)

    @cached_property
    def explanations(self) -> SolidExplanations:
        return SolidExplanations(
            stiffness=explain_stiffness(self.task, self.cycle, self.summary, self.sweep),
            root_stress=explain_solid_roots(self.task, self.cycle, self.summary),
            lines_of_contact=explain_lines(self.task, self.cycle, self.summary),
        )

    def _as_method(self, mounting: Mounting) -> StiffnessMethod:
        return SolidContact(
            pair=self.task.gear_pair,
            material=self.material,
            body=self.options.body,
            mounting=mounting,
            bodies=self.cycle.model,
        )

    # ------------------------------------------------------------------ files and documents

    @property
    def own_document(self) -> JsonObject:
        shafts = {} if self.shafts is None else {"shafts": self.shafts.to_dict()}
        return {"load_distribution": load_distribution(self.cycle), "face": self.along_face.to_dict(), **shafts}

    @property
    def stress_files(self) -> Mapping[str, Callable[[Path], None]]:
        return {f"stress_{role.value}.vtu": stress.write for role, stress in self.tooth_stresses.items()}

    # ------------------------------------------------------------------ what pictures show

    @cached_property
    def shown(self) -> ShownSolid:
        """The contact that pictures show."""
        return shown_contact(self.cycle)

    @cached_property
    def cells(self) -> Cells:
        """Cells of all lines of contact."""
        return pictures.loaded_cells(self.cycle)

    @cached_property
    def tooth_surfaces(self) -> PerGear[ToothSurface]:
        """Surfaces of the most stressed tooth of each gear."""
        return PerGear(*map(pictures.tooth_surface, self.tooth_stresses, self.task.gear_pair.gears))
