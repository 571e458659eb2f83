"""Summary of a mesh cycle: the figures that one reads first, of plane and solid gears."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, TypedDict

import numpy as np

from gearcad.contact.plane.cycle import (
    PlaneCycle,
    PlanePairContact,
    PlanePosition,
    contact_frame,
    greatest_von_mises,
    tooth_field,
)
from gearcad.contact.shared.loaded import INTERIOR, Cycle, Extreme, ExtremeQuantity, LoadedPosition, RootStress
from gearcad.core.records import Floats, JsonObject, PerGear, Role
from gearcad.rating.contact_stress import LineContact

if TYPE_CHECKING:
    from gearcad.contact.solid.cycle import SolidCycle, SolidPairContact, SolidPosition

_Position: TypeAlias = LoadedPosition[Any]
_Quantities: TypeAlias = tuple[ExtremeQuantity[_Position], ...]

Extremes: TypeAlias = dict[str, Extreme | None]
"""Figures by name; None for a figure without a value at any position."""


def _tension(role: Role) -> ExtremeQuantity[_Position]:
    return ExtremeQuantity(f"root_tension_{role.value}", lambda position: position.tension.pick(role).stress)


def _compression(role: Role) -> ExtremeQuantity[_Position]:
    return ExtremeQuantity(
        f"root_compression_{role.value}", lambda position: position.compression.pick(role).stress, least=True
    )


def _bore(role: Role) -> ExtremeQuantity[_Position]:
    def tension(position: _Position) -> float:
        found = position.bore_tension.pick(role)
        return math.nan if found is None else found

    return ExtremeQuantity(f"bore_tension_{role.value}", tension)


ROOTS: _Quantities = PerGear.each(_tension)
PRESSURE: ExtremeQuantity[_Position] = ExtremeQuantity("contact_pressure", lambda position: position.contact_pressure)
STRESSES: _Quantities = (*ROOTS, PRESSURE)

ERRORS: _Quantities = (
    ExtremeQuantity("transmission_error_max", lambda position: position.transmission_error, swing=True),
    ExtremeQuantity("transmission_error_min", lambda position: position.transmission_error, least=True, swing=True),
)
_COURSES: _Quantities = (
    *ERRORS,
    ExtremeQuantity("mesh_stiffness_max", lambda position: position.stiffness, swing=True),
    ExtremeQuantity("mesh_stiffness_min", lambda position: position.stiffness, least=True, swing=True),
)
"""Quantities that go up and down over the mesh; their swing is told."""

PLANE: _Quantities = (*STRESSES, *PerGear.each(_compression), *PerGear.each(_bore), *_COURSES)
SOLID: tuple[ExtremeQuantity[SolidPosition], ...] = (
    *PLANE,
    ExtremeQuantity("line_load_max", lambda position: position.line_load),
)
"""Names of all figures that a summary of solid gears has."""


_ABOUT = ("missing", "extremes", "mean_error")


def by_name(values: Mapping[str, Any]) -> JsonObject:
    """Return values by the names in `check.json`: a figure of both gears gets a name for each, `root_tension_pinion`."""
    document: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, PerGear):
            document |= {f"{name}_{gear}": of for gear, of in value._asdict().items()}
        else:
            document[name] = value
    return document


@dataclass(frozen=True, kw_only=True)
class Summary:
    """Figures of every model: stiffness in N/(mm·µm) of common face width, stresses in MPa, transmission error in µm.

    `contact_pressure` is the greatest away from the edges of the flanks, `von_mises` the greatest below that contact,
    `von_mises_depth` (mm) below the flank. `corner_positions` counts positions where the edge of a tip touches, whose pressure
    is not told. At the pitch point: pressure, half width (mm), and share of the load that the pair of teeth carries.
    `bore_tension_pinion` and `_wheel` are None where the bore is kept round; where it is not, root stresses are of all teeth.

    A figure that no position has is None, and `missing` has the reason. `extremes` are those found between the positions too,
    `mean_error` is what the positions may miss of the mean stiffness.
    """

    mesh_stiffness_mean: float
    mesh_stiffness_max: float
    mesh_stiffness_min: float
    single_stiffness: float
    transmission_error_peak_to_peak: float
    contact_pressure: float | None
    contact_pressure_pitch_point: float | None
    half_width_pitch_point: float | None
    share_pitch_point: float
    von_mises: float | None
    von_mises_depth: float | None
    root_tension: PerGear[float]
    root_compression: PerGear[float]
    bore_tension_pinion: float | None
    bore_tension_wheel: float | None
    corner_positions: int
    missing: dict[str, str]
    extremes: Extremes
    mean_error: float

    @property
    def bore_tension(self) -> PerGear[float | None]:
        """Tension on the bore of both gears (MPa); None where the bore is kept round."""
        return PerGear(self.bore_tension_pinion, self.bore_tension_wheel)

    @property
    def own_face_factors(self) -> dict[str, float]:
        """K_Hbeta and K_Fbeta that the stresses have from the model itself, by symbols; a plane has none."""
        return {}

    @property
    def sampling_error(self) -> dict[str, float]:
        """Errors that the positions may leave, by name: of extremes, relative to their size or swing, and of the mean
        stiffness.
        """
        known = {name: of.error for name, of in self.extremes.items() if of is not None}
        return {"mesh_stiffness_mean": self.mean_error, **known}

    def to_dict(self) -> JsonObject:
        """Return the figures as `check.json` has them, without the fields about the figures."""
        return by_name({name: value for name, value in vars(self).items() if name not in _ABOUT})


class SummaryFigures(NamedTuple):
    """The few that a sweep or a refinement needs, as in Summary."""

    mesh_stiffness: float
    contact_pressure: float | None
    root_tension: PerGear[float]


def root_peaks(cycle: Cycle) -> PerGear[RootStress]:
    """Return the greatest root tension of each gear."""
    return PerGear.each(lambda role: cycle.worst_position(role).tension.pick(role))


def figures(cycle: Cycle) -> SummaryFigures:
    """Return the mean mesh stiffness, greatest interior pressure and root tensions of a cycle."""
    worst = cycle.worst_contact
    tension = root_peaks(cycle).map(lambda peak: peak.stress)
    return SummaryFigures(float(cycle.mean("stiffness")[0]), worst[1].interior_pressure if worst else None, tension)


class AtPitchPoint(NamedTuple):
    """Share, pressure (MPa) and half width (mm) of a contact at the pitch point, or the reason why there are none of these."""

    share: float
    pressure: float | None = None
    half_width: float | None = None
    reason: str = ""

    @property
    def missing(self) -> dict[str, str]:
        """The reason for each figure that is not told."""
        return dict.fromkeys(("contact_pressure_pitch_point", "half_width_pitch_point"), self.reason) if self.reason else {}


class CommonFigures(TypedDict):
    """The fields of a Summary that are found in every model alike."""

    mesh_stiffness_mean: float
    mean_error: float
    mesh_stiffness_max: float
    mesh_stiffness_min: float
    single_stiffness: float
    transmission_error_peak_to_peak: float
    contact_pressure: float | None
    contact_pressure_pitch_point: float | None
    half_width_pitch_point: float | None
    share_pitch_point: float
    root_tension: PerGear[float]
    root_compression: PerGear[float]
    bore_tension_pinion: float | None
    bore_tension_wheel: float | None
    corner_positions: int
    extremes: Extremes


def common_figures(cycle: Cycle, extremes: Extremes, single: float, at_pitch_point: AtPitchPoint) -> CommonFigures:
    """Return the figures of a cycle and its extremes; `single` is the stiffness of one pair of teeth alone."""

    def value(name: str) -> float | None:
        return found.value if (found := extremes[name]) is not None else None

    def sure(name: str) -> float:
        found = extremes[name]
        assert found is not None  # every position has it
        return found.value

    mean, off = map(float, cycle.mean("stiffness"))
    return {
        "mesh_stiffness_mean": mean,
        "mean_error": off / mean,
        "mesh_stiffness_max": sure("mesh_stiffness_max"),
        "mesh_stiffness_min": sure("mesh_stiffness_min"),
        "single_stiffness": single,
        "transmission_error_peak_to_peak": sure("transmission_error_max") - sure("transmission_error_min"),
        "contact_pressure": value("contact_pressure"),
        "contact_pressure_pitch_point": at_pitch_point.pressure,
        "half_width_pitch_point": at_pitch_point.half_width,
        "share_pitch_point": at_pitch_point.share,
        "root_tension": PerGear.each(lambda role: sure(f"root_tension_{role.value}")),
        "root_compression": PerGear.each(lambda role: sure(f"root_compression_{role.value}")),
        "bore_tension_pinion": value("bore_tension_pinion"),
        "bore_tension_wheel": value("bore_tension_wheel"),
        "corner_positions": cycle.edge_positions,
        "extremes": extremes,
    }


_NEAR = 2.0
"""Half widths around a contact within which the stress below it is greatest."""

_PRESSURES = ("contact_pressure", "von_mises", "von_mises_depth", "von_mises_half_plane")
"""Figures that the worst contact away from the ends of the flanks decides."""


@dataclass(frozen=True, kw_only=True)
class PlaneSummary(Summary):
    """Summary of a plane cycle; `von_mises_half_plane` is what the pressures alone would make in a half-plane."""

    von_mises_half_plane: float | None


def summarise_plane(cycle: PlaneCycle, single: float) -> PlaneSummary:
    """Summarise a plane cycle; `single` is the stiffness of one pair of teeth alone."""
    worst, at_pitch = cycle.worst_contact, _plane_at_pitch(cycle.pitch_point_contact)
    below = [each for role in Role if (each := _plane_below(cycle, *worst, role)) is not None] if worst else []
    mises, depth = max(below, default=(None, None))
    extremes = {quantity.name: cycle.extreme(quantity) for quantity in PLANE}
    return PlaneSummary(
        **common_figures(cycle, extremes, single, at_pitch),
        von_mises=mises,
        von_mises_depth=depth,
        von_mises_half_plane=_half_plane(cycle, worst[1]) if worst else None,
        missing=at_pitch.missing | _missing(cycle, bool(worst), bool(below)),
    )


def _missing(cycle: PlaneCycle, inside: bool, below: bool) -> dict[str, str]:
    """Return the reason why there are no figures of the worst contact, by the names of the figures."""
    if not inside:
        reason = (
            f"at none of {len(cycle.every)} positions is a contact with a tenth of the load more than {INTERIOR:g} half widths "
            "away from the ends of both flanks and the starts of their linear reliefs"
        )
        return dict.fromkeys(_PRESSURES, reason)
    return {} if below else dict.fromkeys(_PRESSURES[1:3], "no point of the elements lies near enough to the contact")


def _plane_at_pitch(contact: PlanePairContact | None) -> AtPitchPoint:
    """Return the pressure and half width at the pitch point, or why there are none."""
    if contact is None:
        return AtPitchPoint(0.0, reason="the pair of teeth at the pitch point does not touch")
    if not contact.interior:
        return AtPitchPoint(
            contact.share,
            reason=f"the pitch point lies within {INTERIOR:g} half widths of an end of a flank, or of the start of a relief",
        )
    if math.isnan(contact.half_width):
        return AtPitchPoint(contact.share, reason="the pressures at the pitch point have no width to tell")
    return AtPitchPoint(contact.share, contact.peak_pressure, contact.half_width)


def _plane_below(
    cycle: PlaneCycle, position: PlanePosition, contact: PlanePairContact, role: Role
) -> tuple[float, float] | None:
    """Return the greatest von Mises stress (MPa) of a gear near a contact, and its depth (mm); None if no point of the field is
    near.
    """
    field = tooth_field(cycle, position, role, contact.tooth)
    centre, frame = contact_frame(cycle, contact)
    across, into_wheel = ((field.points - centre) @ frame).T
    near = np.hypot(across, into_wheel) < _NEAR * contact.hertz_half_width
    if not near.any():
        return None
    at = int(np.argmax(np.where(near, field.von_mises, 0.0)))
    return float(field.von_mises[at]), float(into_wheel[at] * PerGear(-1, 1).pick(role))


def _half_plane(cycle: PlaneCycle, contact: PlanePairContact) -> float:
    cells = contact.pair.cells
    stress, _ = greatest_von_mises(
        cells.place, cells.width, contact.pressures, contact.hertz_half_width, cycle.model.pinion.elasticity
    )
    return stress


_HARMONICS = 5


@dataclass(frozen=True, kw_only=True)
class SolidSummary(Summary):
    """Summary of a cycle of solid gears: greatest values and where they occur. Radii and heights are in mm, `across` is
    measured from the middle of the common face width.

    `transmission_error_harmonics` (µm) at the tooth frequency and its multiples; `contact_length_mean` (mm) of the lines that
    carry, all together; `line_load_max` (N/mm) away from the edges of the flanks; the face load factors are K_H_beta, of the
    whole cycle, and K_F_beta.
    """

    transmission_error_harmonics: tuple[float, ...]
    contact_pressure_across: float | None
    contact_pressure_radius: PerGear[float] | PerGear[None]
    root_tension_height: PerGear[float]
    root_tension_radius: PerGear[float]
    contact_length_mean: float
    line_load_max: float | None
    face_load_factor: float
    root_face_load_factor: PerGear[float]

    @property
    def own_face_factors(self) -> dict[str, float]:
        """K_F_beta is the lesser of both gears."""
        return {"K_Hbeta": self.face_load_factor, "K_Fbeta": min(self.root_face_load_factor)}


class WorstPlace(NamedTuple):
    """Position of the greatest pressure away from the edges of the flanks: `place` in cells of the line."""

    position: SolidPosition
    contact: SolidPairContact
    place: float

    def of(self, values: Floats) -> float:
        """Return the value at this place, interpolated in values (n,) of the line's cells."""
        return float(self.contact.between(values, self.place))


def worst_place(cycle: SolidCycle) -> WorstPlace | None:
    """Return the place of the greatest pressure away from the edges of the flanks; None if no place is away from them."""
    if (worst := cycle.worst_contact) is None:
        return None
    position, contact = worst
    return WorstPlace(position, contact, float(contact.inside[contact.between(contact.pressures, contact.inside).argmax()]))


def summarise_solid(cycle: SolidCycle, single: float) -> SolidSummary:
    """Summarise a cycle; `single` is the stiffness of one pair of teeth alone."""
    peaks = PerGear.each(lambda role: cycle.worst_position(role).tension.pick(role))
    worst, at_pitch = worst_place(cycle), _at_pitch(cycle.pitch_point_contact)
    below = _below(cycle, worst) if worst is not None else _Below(None, None, None, PerGear(None, None))
    extremes = {quantity.name: cycle.extreme(quantity) for quantity in SOLID}
    line_load = extremes["line_load_max"]
    return SolidSummary(
        **common_figures(cycle, extremes, single, at_pitch),
        von_mises=below.von_mises,
        von_mises_depth=below.depth,
        contact_pressure_across=below.across,
        contact_pressure_radius=below.radius,
        transmission_error_harmonics=tuple(cycle.harmonics[:_HARMONICS].tolist()),
        root_tension_height=peaks.map(lambda peak: peak.height),
        root_tension_radius=peaks.map(lambda peak: peak.radius),
        contact_length_mean=float(np.mean([_loaded_length(position) for position in cycle.positions])),
        line_load_max=line_load.value if line_load is not None else None,
        face_load_factor=cycle.face_load_factor,
        root_face_load_factor=PerGear.each(cycle.root_face_load_factor),
        missing=at_pitch.missing | ({} if worst else _nothing_inside(cycle)),
    )


_AT_WORST = ("contact_pressure", "contact_pressure_across", "contact_pressure_radius", "von_mises", "von_mises_depth")


def _nothing_inside(cycle: SolidCycle) -> dict[str, str]:
    """Return the reason why there are no figures of the worst place, by the names of the figures."""
    reason = (
        f"at none of {len(cycle.every)} positions do places more than {INTERIOR:g} half widths away from the edges of both "
        "flanks carry a tenth of the load"
    )
    return dict.fromkeys((*_AT_WORST, "line_load_max"), reason)


class _Below(NamedTuple):
    """Place of the greatest pressure (mm), with the stress below it (MPa) and its depth (mm)."""

    von_mises: float | None
    depth: float | None
    across: float | None
    radius: PerGear[float] | PerGear[None]


def _below(cycle: SolidCycle, worst: WorstPlace) -> _Below:
    line, stress = worst.contact.line, line_contact(cycle, worst).greatest_von_mises
    bodies, lengths = cycle.model.bodies, line.places.map(lambda places: worst.of(places[0]))
    radii = PerGear.each(lambda role: math.hypot(bodies.pick(role).flank.base_radius, lengths.pick(role)))
    return _Below(stress.value, stress.depth, worst.of(line.across), radii)


def _at_pitch(contact: SolidPairContact | None) -> AtPitchPoint:
    """Return the pressure and half width at the pitch point in the middle of the common face width, or why there are none."""
    if contact is None:
        return AtPitchPoint(0.0, reason="the pair of teeth at the pitch point does not touch")
    across = contact.line.across
    place = float(np.interp(0, across, np.arange(len(across)), math.nan, math.nan))
    if math.isnan(place) or not min(contact.forces[[math.floor(place), math.ceil(place)]]) > 0:
        return AtPitchPoint(
            contact.share, reason="nothing is carried at the pitch point in the middle of the common face width"
        )
    if not float(contact.between(contact.margin, place)) > 0:
        return AtPitchPoint(contact.share, reason=f"the pitch point lies within {INTERIOR:g} half widths of an edge")
    pressure, half_width = (float(contact.between(of, place)) for of in (contact.pressures, contact.half_widths))
    return AtPitchPoint(contact.share, pressure, half_width)


def line_contact(cycle: SolidCycle, worst: WorstPlace) -> LineContact:
    """Return two cylinders of the curvature of the flanks under the line load of a place."""
    materials = [body.material for body in cycle.model.bodies]
    return LineContact(
        load_per_width=worst.of(worst.contact.line_loads),
        radius=worst.of(worst.contact.radii),
        modulus=1 / sum((1 - of.poisson_ratio**2) / of.youngs_modulus for of in materials),
        poisson_ratio=materials[0].poisson_ratio,
    )


def _loaded_length(position: SolidPosition) -> float:
    return sum(float(contact.line.lengths[contact.forces > 0].sum()) for contact in position.contacts)
