"""Reasons why finite elements and ISO 6336 differ for a pair, with the number of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from gearcad.check.convergence import SweepPoint
from gearcad.check.summary import PlaneSummary, SolidSummary, Summary, root_peaks, worst_place
from gearcad.check.task import CheckTask, face_factors
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.flank import ToothLoad
from gearcad.contact.shared.loaded import LEAST_TANGENT_ANGLE, Cycle, FlankCompliance
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.records import Floats, JsonObject, PerGear, Role
from gearcad.geometry import RackPair
from gearcad.meshing.outline import OutlineSide
from gearcad.rating.tooth_stiffness import mesh_stiffness_alpha


class PlaceOfShare(NamedTuple):
    """A place on the line of action (mm from T1), and the part of the load that a pair of teeth carries there."""

    place: float
    share: float


class LoadShare(NamedTuple):
    """Places (n,) on the line of action (mm from T1), in the order in which one pair of teeth goes through them; its shares."""

    places: Floats
    shares: Floats

    @classmethod
    def of(cls, cycle: Cycle) -> LoadShare:
        """Return the load share over a mesh cycle."""
        places, shares = np.array(sorted((contact.place, contact.share) for _, contact in cycle.contacts)).T
        return cls(places, shares)

    def at(self, place: float) -> float:
        """Return the share of the load at a place (mm from T1), interpolated between the positions solved."""
        return float(np.interp(place, self.places, self.shares))

    @property
    def most(self) -> PlaceOfShare:
        """The greatest share."""
        at = self.shares.argmax()
        return PlaceOfShare(float(self.places[at]), float(self.shares[at]))


_SAME_WIDTH = 1e-6
"""Part of the width below which two are one."""


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """Figures that explain a difference."""

    def to_dict(self) -> JsonObject:
        """Return the figures as `check.json` has them."""
        return {name: _plain(value) for name, value in vars(self).items()}


def _plain(value: Any) -> Any:
    if isinstance(value, PerGear):
        return {role.value: _plain(of) for role, of in value.items()}
    return value.to_dict() if isinstance(value, Explanation) else value


@dataclass(frozen=True, kw_only=True)
class Compared(Explanation):
    """A figure by finite elements, and what the standard has for it."""

    computed: float
    standard: float


@dataclass(frozen=True, kw_only=True)
class StiffnessExplanation(Explanation):
    """Stiffness in N/(mm·µm) of common face width: the `mean` of the mesh and the greatest of a `single` pair of teeth.

    `rim_depths`: how far below the root circle each body is flexible - outside that of a ring - (normal modules),
    `approach_shares` its part of the approach. `specific_load` (N/mm) is F_t K_A/b, `low_load_factor` what it leaves of the
    standard's stiffness, `sweep_least` and `sweep_greatest` what the torques of the sweep make of the mean. `mean_to_single`
    is the mean over the single stiffness.
    """

    mean: Compared
    single: Compared
    rim_depths: PerGear[float]
    blank_factor: float
    approach_shares: PerGear[float]
    specific_load: float
    low_load_factor: float
    sweep_least: float
    sweep_greatest: float
    mean_to_single: Compared


@dataclass(frozen=True, kw_only=True)
class RootCompared(Explanation):
    """Root stress (MPa) of one gear, at a tangent angle (deg) to the middle of the tooth.

    The standard spreads the load over its `width` (mm), the finite elements over the `common_width`: `on_common_width` (MPa) is
    what the standard would have there. The factors are Y_F and Y_S.
    """

    stress: Compared
    width: float
    common_width: float
    on_common_width: float
    tangent_angle: float
    form_factor: float
    stress_correction_factor: float

    @property
    def other_width(self) -> bool:
        """True if the two widths differ."""
        return abs(self.width / self.common_width - 1) > _SAME_WIDTH


R = TypeVar("R", bound=Explanation)


@dataclass(frozen=True, kw_only=True)
class Explanations(Explanation, Generic[R]):
    """Explanations of what a standard has for every check."""

    stiffness: StiffnessExplanation
    root_stress: PerGear[R]


def root_compared(task: CheckTask, cycle: Cycle, summary: Summary) -> PerGear[RootCompared]:
    """Return the root stresses of both gears by finite elements beside those of the standard (MPa)."""
    width, standards, peaks = cycle.model.width, task.rating.root_stresses, root_peaks(cycle)

    def compared(role: Role) -> RootCompared:
        standard, rating = standards.pick(role), task.rating.roots.pick(role)
        return RootCompared(
            stress=Compared(computed=summary.root_tension.pick(role), standard=standard),
            width=rating.width,
            common_width=width,
            on_common_width=standard * rating.width / width,
            tangent_angle=peaks.pick(role).tangent_angle,
            form_factor=rating.form_factor,
            stress_correction_factor=rating.stress_correction_factor,
        )

    return PerGear.each(compared)


def _rim_depth(task: CheckTask, role: Role, body: FlankCompliance) -> float:
    """Return how far below its roots a body is flexible (normal modules)."""
    if (gear := task.gears.get(role)) is not None:
        return body.flank.upward * (gear.profile.root_diameter / 2 - body.hub_radius) / gear.normal_module
    assert isinstance(task.pair, RackPair)
    rack = task.pair.rack
    return (rack.height - rack.root_depth) / rack.normal_module


def explain_stiffness(task: CheckTask, cycle: Cycle, summary: Summary, sweep: Sequence[SweepPoint]) -> StiffnessExplanation:
    """Return the explanation of the mesh stiffness: the bodies, the load, and how pairs of teeth share it."""
    standard, model = task.rating.stiffness, cycle.model
    parts = cycle.values("approach_parts").mean(axis=0)
    rims = [_rim_depth(task, role, model.bodies.pick(role)) for role in Role]
    swept = [point.mesh_stiffness for point in sweep]
    return StiffnessExplanation(
        mean=Compared(computed=summary.mesh_stiffness_mean, standard=standard.mesh_alpha),
        single=Compared(computed=summary.single_stiffness, standard=standard.single),
        rim_depths=PerGear(*rims),
        blank_factor=standard.blank_factor,
        approach_shares=PerGear(*(parts / parts.sum()).tolist()),
        specific_load=task.rating.specific_load,
        low_load_factor=standard.low_load_factor,
        sweep_least=min(swept),
        sweep_greatest=max(swept),
        mean_to_single=Compared(
            computed=summary.mesh_stiffness_mean / summary.single_stiffness,
            standard=mesh_stiffness_alpha(1.0, task.pair.transverse_contact_ratio),
        ),
    )


@dataclass(frozen=True, kw_only=True)
class RootConcentration(Explanation):
    """Stress over that of a beam, which is sigma_F0/Y_S (`beam_stress`, MPa), with all of the load on one pair of teeth.

    `root` has that of finite elements beside Y_S. In a grinding notch the greatest tension is `notch_stress` (MPa), and `notch`
    has its concentration beside Y_Sg; both are None without one.
    """

    beam_stress: float
    root: Compared
    notch_stress: float | None = None
    notch: Compared | None = None


@dataclass(frozen=True, kw_only=True)
class PlaneRootExplanation(Explanation):
    """Reasons of the root stress: `single_contact` (MPa) of finite elements with all of the load on one pair of teeth at its
    `outer_point`.

    There a pair carries the part `load_share` of the load. `rim_compression` (MPa) is that of a rim that bends, None of one
    that does not; `rim_thickness_factor` is Y_B. `concentration` is that of teeth that are cut before they are finished.
    """

    compared: RootCompared
    outer_point: str
    single_contact: float
    load_share: float
    rim_thickness_factor: float
    rim_compression: float | None
    concentration: RootConcentration | None = None

    def to_dict(self) -> JsonObject:
        """Return the figures as `check.json` has them; the concentration where there is one."""
        return {name: value for name, value in super().to_dict().items() if name != "concentration" or value is not None}


def _single_contact(cycle: PlaneCycle, role: Role) -> ToothLoad:
    """Return all of the load on tooth 0 at the outer point of single contact of a gear, D or B."""
    model, path = cycle.model, cycle.model.pair.path_of_contact
    return ToothLoad(0, PerGear(path.D, model.line.whole - path.B).pick(role), model.force(cycle.torque))


def root_at_single_contact(cycle: PlaneCycle, role: Role) -> float:
    """Return the root tension (MPa) of a gear with all of the load on one pair at its outer point, D or B."""
    return cycle.model.fillets.pick(role).extreme(OutlineSide.LEFT_FILLET, [_single_contact(cycle, role)]).stress


def root_concentration(task: CheckTask, cycle: PlaneCycle, role: Role) -> RootConcentration | None:
    """Return the concentration of stress in the root of a gear that is cut before it is finished; None for others.

    Beside a notch the rest of the root has the stress of its own.
    """
    gear, rating = task.gears.get(role), task.rating.roots.pick(role)
    outline = None if gear is None else gear.profile.root
    if outline is None:
        return None
    fillets, side = cycle.model.fillets.pick(role), OutlineSide.LEFT_FILLET
    stresses, radii = fillets.stresses(side, [_single_contact(cycle, role)]), fillets.places(side)[0]
    factor = rating.stress_correction_factor
    beam = task.rating.root_stresses.pick(role) * rating.width / cycle.model.width / factor
    notched = rating.notch is not None and outline.wheel
    low, high = sorted((float(outline.pieces[-1].polar(0.0)[0]), outline.form_radius))
    inside = (radii > low) & (radii < high) & notched
    angles = fillets.places(side)[1]
    root = float(stresses[~inside & (angles >= LEAST_TANGENT_ANGLE)].max())
    if rating.notch is None or not notched:
        return RootConcentration(beam_stress=beam, root=Compared(computed=root / beam, standard=factor))
    notch = float(stresses[inside].max())
    return RootConcentration(
        beam_stress=beam,
        root=Compared(computed=root / beam, standard=factor / rating.notch.factor(1.0)),
        notch_stress=notch,
        notch=Compared(computed=notch / beam, standard=factor),
    )


def explain_plane_roots(
    task: CheckTask, cycle: PlaneCycle, summary: PlaneSummary, load_share: LoadShare
) -> PerGear[PlaneRootExplanation]:
    """Return the explanations of the root stresses of both gears in the plane."""
    compared = root_compared(task, cycle, summary)
    path, supports = task.pair.path_of_contact, task.body.supports(task.pair)
    outer = PerGear(("D", path.D), ("B", path.B))

    def explained(role: Role) -> PlaneRootExplanation:
        letter, place = outer.pick(role)
        bends = supports.pick(role).bends
        return PlaneRootExplanation(
            compared=compared.pick(role),
            outer_point=letter,
            single_contact=root_at_single_contact(cycle, role),
            load_share=load_share.at(place),
            rim_thickness_factor=task.rating.roots.pick(role).rim_thickness_factor,
            rim_compression=summary.root_compression.pick(role) if bends else None,
            concentration=root_concentration(task, cycle, role),
        )

    return PerGear.each(explained)


@dataclass(frozen=True, kw_only=True)
class SolidRootExplanation(Explanation):
    """The greatest tension stands at a `height` (mm) and is `face_load_factor` (K_F_beta) times the `mean` (MPa) along the
    common width; `helix_angle_factor` is Y_beta.
    """

    compared: RootCompared
    height: float
    face_load_factor: float
    mean: float
    helix_angle_factor: float


@dataclass(frozen=True, kw_only=True)
class GreatestPressure(Explanation):
    """The greatest pressure (MPa) away from the edges: its roll angle (deg), place `across` (mm) from the middle of the common
    width, the line load (N/mm) and the reduced radius (mm) there.
    """

    pressure: float
    roll_angle: float
    across: float
    line_load: float
    radius: float


@dataclass(frozen=True, kw_only=True)
class LinesExplanation(Explanation):
    """The load along the lines of contact and along the face.

    `length` (mm) is the mean of the lines that carry, and that of rigid gears; the standard spreads F_bn K_A over the latter,
    to `mean_line_load` (N/mm) on `pitch_point_radius` (mm). K_H_beta of Method C comes from `misalignment` (F_beta_y, µm);
    that of the cycle is `greatest_across` mm from the middle.
    """

    greatest_pressure: GreatestPressure | None
    length: Compared
    mean_line_load: float
    pitch_point_radius: float
    face_load_factor: Compared
    greatest_across: float
    misalignment: float


@dataclass(frozen=True, kw_only=True)
class SolidExplanations(Explanations[SolidRootExplanation]):
    """Explanations of solid bodies, also of their lines of contact."""

    lines_of_contact: LinesExplanation


def explain_solid_roots(task: CheckTask, cycle: SolidCycle, summary: SolidSummary) -> PerGear[SolidRootExplanation]:
    """Return the explanations of the root stresses of both gears as solid bodies."""
    compared = root_compared(task, cycle, summary)

    def explained(role: Role) -> SolidRootExplanation:
        uneven = summary.root_face_load_factor.pick(role)
        return SolidRootExplanation(
            compared=compared.pick(role),
            height=summary.root_tension_height.pick(role),
            face_load_factor=uneven,
            mean=summary.root_tension.pick(role) / uneven,
            helix_angle_factor=task.rating.roots.pick(role).helix_angle_factor,
        )

    return PerGear.each(explained)


def explain_lines(task: CheckTask, cycle: SolidCycle, summary: SolidSummary) -> LinesExplanation:
    """Return the explanation of the load along the lines of contact and along the face in a cycle."""
    rating, factors = task.rating, face_factors(task)
    length = task.pair.contact_line_lengths.mean
    across, load = cycle.load_along_face
    greatest = across[np.abs(load - summary.face_load_factor * load.mean()).argmin()]
    return LinesExplanation(
        greatest_pressure=_greatest_pressure(cycle),
        length=Compared(computed=summary.contact_length_mean, standard=length),
        mean_line_load=rating.normal_force * rating.application_factor / length,
        pitch_point_radius=rating.pitch_point.radius,
        face_load_factor=Compared(computed=summary.face_load_factor, standard=factors.flank),
        greatest_across=float(greatest),
        misalignment=factors.misalignment,
    )


def _greatest_pressure(cycle: SolidCycle) -> GreatestPressure | None:
    if (worst := worst_place(cycle)) is None:
        return None
    contact = worst.contact
    return GreatestPressure(
        pressure=worst.of(contact.pressures),
        roll_angle=worst.position.roll_angle,
        across=worst.of(contact.line.across),
        line_load=worst.of(contact.line_loads),
        radius=worst.of(contact.radii),
    )
