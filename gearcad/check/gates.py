"""Gates of a check, which decide, and references with a band, which inform; thin rims."""

from __future__ import annotations

import math
from collections.abc import Iterator
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, NamedTuple

from gearcad.check.comparison import CheckStrength, Comparison, Subject, agrees, at_most, beside, strength_comparisons
from gearcad.check.summary import PRESSURE, ROOTS, PlaneSummary, SolidSummary, Summary
from gearcad.check.task import CheckTask, face_factors
from gearcad.contact.plane.cycle import PlaneCycle, conformal
from gearcad.contact.shared.bodies import Hold, Support, rim_ratio
from gearcad.contact.shared.loaded import Cycle
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.errors import format_number
from gearcad.core.records import Notice, PerGear, Role
from gearcad.geometry import Gear, RackPair
from gearcad.geometry.gear_data import RING_RIM_LIMIT
from gearcad.material import Limit, Material, by_gear
from gearcad.rating.load_factor_formulas import root_face_load_factor, width_to_height
from gearcad.rating.tooth_stiffness import RIM_LIMIT

if TYPE_CHECKING:
    from gearcad.check.convergence import Convergence
    from gearcad.check.on_shafts import LoadOnShafts

_SAME = 1e-9
"""Difference of radii (mm) below which they count as equal."""

_SOURCE = "s_R/h_t from 1.2 on, ISO 6336-3:2006 clause 9"


class _Rim(NamedTuple):
    """The rim of one gear: its support, and its thickness over the tooth depth as it is modelled."""

    role: Role
    gear: Gear
    support: Support
    radius: float

    @property
    def ratio(self) -> float:
        return rim_ratio(self.gear, self.radius)

    @property
    def stiffened(self) -> bool:
        """True if the gear has a thin rim, and the model keeps it from bending."""
        bore = self.gear.body.bore / 2
        thin = bool(bore) and rim_ratio(self.gear, bore) < RIM_LIMIT
        return thin and self.support.hold is Hold.RIGID and self.radius > bore - _SAME

    @property
    def words(self) -> str:
        thickness = self.ratio * (self.gear.tip_diameter - self.gear.root_diameter) / 2
        return f"the {self.role.value}'s rim ({thickness:.3g} mm, {self.ratio:.3g} tooth depths)"


def _rims(task: CheckTask) -> list[_Rim]:
    """Return the rims of both gears; a rack has none."""
    supports, radii = task.body.supports(task.pair), task.body.inner_radii(task.pair)
    return [_Rim(role, gear, supports.pick(role), radii.pick(role)) for role, gear in task.gears.items()]


def rim_gates(task: CheckTask) -> Iterator[Comparison]:
    """Yield a gate for a thin rim that is held rigidly: it does not bend, so the model does not show it."""
    for rim in _rims(task):
        if rim.stiffened:
            yield at_most(
                f"tooth depth over rim, {rim.role.value}",
                1 / rim.ratio if rim.ratio > 0 else None,
                1 / RIM_LIMIT,
                "",
                _SOURCE,
                f'a rim as thin as that bends, which a rigid bore keeps it from: {rim.role.value}_support = "free"',
                reason="nothing is left of the rim",
            )


def bending_limits(task: CheckTask, summary: Summary) -> Iterator[Comparison]:
    """Yield the comparisons of a rim that bends: compression of its roots and tension on its bore, beside the root limit (MPa).

    Where a rim bends, its roots are compressed more than stretched, and its bore is stretched too.
    """
    for rim in _rims(task):
        role = rim.role
        material = task.materials.pick(role)
        limit = material.root_limit
        least = limit[0] if isinstance(limit, tuple) else limit
        if least is None or not rim.support.bends:
            continue
        for words, value, note in (
            ("root compression", abs(summary.root_compression.pick(role)), "where a rim bends it changes sign"),
            ("tension on the bore", summary.bore_tension.pick(role), "where the rim bends"),
        ):
            source = f"limit of {material.name}"
            yield at_most(f"{words}, {rim.role.value}", value, least, "MPa", source, note, subject=Subject.STRENGTH)


def bending_notes(task: CheckTask, summary: Summary) -> PerGear[str]:
    """Return for each gear the note on its root tension against the standard's; empty if its rim does not bend."""

    def note(rim: _Rim) -> str:
        factor, compression = task.rating.roots.pick(rim.role).rim_thickness_factor, summary.root_compression.pick(rim.role)
        return (
            f"; the rim bends: Y_B = {factor:.3g} raises ISO's tension, in the FE it is the compression "
            f"({compression:.0f} MPa) that rises"
        )

    notes = {rim.role: note(rim) for rim in _rims(task) if rim.support.bends}
    return PerGear.each(lambda role: notes.get(role, ""))


def rim_notices(task: CheckTask, summary: Summary) -> Iterator[Notice]:
    """Yield notices on how a thin rim is modelled, and which of its results are evaluated."""
    for rim in _rims(task):
        owner, hold = rim.role.value, rim.support.hold
        if rim.gear.internal:
            yield from _of_ring(rim)
        elif rim.support.bends:
            yield Notice("thin-rim", _bending(rim, task, summary))
        elif rim.ratio < RIM_LIMIT and hold is Hold.RIGID:
            text = f'{rim.words} is held rigidly, which keeps it from bending; {owner}_support = "free" lets it'
            yield Notice("rigid-rim", text)
        elif hold is Hold.SHAFT:
            yield Notice("bonded-shaft", f"the {owner} is bonded to its shaft: a fit that opens under load is softer")
        if hold is Hold.KEY:
            yield Notice(
                "key",
                f"stresses of the {owner}: the key is placed under the tooth where they become greatest; its stiffness is that "
                "of a bore without a key, and the notch of the keyway is not part of the section",
            )


def _of_ring(rim: _Rim) -> Iterator[Notice]:
    thickness = rim.ratio * (rim.gear.tip_diameter - rim.gear.root_diameter) / 2 / rim.gear.normal_module
    if rim.support.hold is Hold.BOLTS:
        text = (
            f"the ring is {rim.support.describe(rim.radius)}: at each the sector of a tooth is rigid from there outwards, and "
            "nothing holds the rim between them; root stresses are those of the loaded teeth"
        )
        yield Notice("bolted-ring", text)
    elif thickness < RING_RIM_LIMIT:
        text = (
            f"the ring's rim ({thickness:.3g} m_n, below {RING_RIM_LIMIT:g}) is held all round, as by a stiff housing, which "
            f'keeps it from bending; {rim.role.value}_support = "bolts" lets it bend between them'
        )
        yield Notice("rigid-rim", text)


def _bending(rim: _Rim, task: CheckTask, summary: Summary) -> str:
    tension, compression, bore = (
        each.pick(rim.role) for each in (summary.root_tension, summary.root_compression, summary.bore_tension)
    )
    teeth = "its loaded teeth" if task.body.solid else "all its teeth"
    return (
        f"{rim.words} bends: its bore is {rim.support.words} {format_number(round(2 * rim.radius, 4))} mm; root tension "
        f"({tension:.0f} MPa) and compression ({compression:.0f} MPa) are the greatest of {teeth}, the tension "
        f"on its bore is {bore or 0:.0f} MPa"
    )


_REACTION = 0.005
"""Torque on a hub against that applied: interpolation between unit loads, not equilibrium, makes up what is missing."""

_SAMPLING = 0.002
"""Permitted sampling error of a stress."""


def compare_common(
    task: CheckTask,
    cycle: Cycle,
    summary: Summary,
    convergence: tuple[Convergence, ...],
    *,
    equilibrium: str,
    errors: tuple[float, ...],
    flicker: float = _SAMPLING,
) -> Iterator[Comparison]:
    """Gates first.

    `equilibrium` says where torques on the hubs are held against those applied, `errors` are what the mesh may do to each
    quantity, `flicker` is what positions may miss of a pressure.
    """
    yield from _reactions(cycle, equilibrium)
    yield from _mesh_errors(task, convergence, errors, summary)
    yield from _sampling(summary, flicker)
    yield from rim_gates(task)
    if task.is_section:  # no stress of a section is that of the gears
        return
    yield from _material_limits(task, summary)
    yield from bending_limits(task, summary)
    yield from strength_comparisons(CheckStrength.of(task, summary))
    yield from standards(task, summary)


def farness(computed: float, expected: float) -> float:
    """Return the relative distance of two values; infinite if one is not a number."""
    found = abs(computed / expected - 1)
    return found if math.isfinite(found) else math.inf


def _reactions(cycle: Cycle, source: str) -> Iterator[Comparison]:
    """Yield the torques (N·m) on the hubs, position by position, against those applied, where they differ most."""
    model = cycle.model
    force = model.force(cycle.torque) * model.width / 1000
    for role, body in model.bodies.items():
        nominal = force * body.flank.lever
        every = [(each.torques.pick(role), nominal * each.torque_ratios.pick(role)) for each in cycle.every]
        worst, applied = max(every, key=lambda torques: farness(*torques))
        if role is Role.WHEEL and isinstance(model.pair, RackPair):
            words = "equilibrium: the force along the rack, of the torque that is applied through the teeth"
            yield agrees("force along the rack, from its back", 1000 * worst, 1000 * applied, _REACTION, "N", words)
        else:
            yield agrees(f"torque reaction of the {role.value}", worst, applied, _REACTION, "N·m", source)


def _mesh_errors(
    task: CheckTask, convergence: tuple[Convergence, ...], limits: tuple[float, ...], summary: Summary
) -> Iterator[Comparison]:
    """Yield the estimated error of each quantity, by mesh and positions together, against what it may be (relative)."""
    for each, limit in zip(convergence, limits, strict=bool(convergence)):
        between = summary.sampling_error[each.key]
        source = "three meshes, Richardson, and what the positions may miss"
        note = f"{100 * each.error:.2g} % by the mesh ({each.order_words}), {100 * between:.2g} % by the positions"
        told = 100 * (each.error + between)
        quantity = each.quantity.replace(Role.WHEEL.value, task.rating.names.wheel)
        yield at_most(f"discretisation error, {quantity}", told, 100 * limit, "%", source, note)


def _sampling(summary: Summary, of_pressure: float) -> Iterator[Comparison]:
    """Yield the errors that the positions may leave in stresses, beside those permitted (%): root stresses, and contact
    pressure.
    """
    errors = summary.sampling_error
    for words, names, limit in (("root stresses", ROOTS, _SAMPLING), ("contact pressure", (PRESSURE,), of_pressure)):
        worst = max((each.name for each in names), key=lambda name: errors.get(name, math.inf))
        error = errors.get(worst, math.inf)
        yield at_most(
            f"sampling error of the {words}",
            100 * error,
            100 * limit,
            "%",
            "what can stand between the positions, by the curve beside them",
            reason="" if math.isfinite(error) else summary.missing.get(worst, "nothing is known of what stands beside it"),
        )


def _material_limits(task: CheckTask, summary: Summary) -> Iterator[Comparison]:
    """Yield the comparisons of stresses (MPa) with the limits that the materials have."""
    deep = f"{summary.von_mises_depth:.3g} mm deep" if summary.von_mises_depth is not None else ""
    away, missing = "the greatest away from the corners of the flanks", summary.missing.get
    every = [(f", {gear}" if gear else "", of) for gear, of in by_gear(task.material).items()]
    pressures = [(f"contact pressure{whose}", summary.contact_pressure, of, of.contact_limit) for whose, of in every]
    tensions = summary.root_tension
    roots = [
        (f"root stress, {task.rating.names.pick(role)}", tensions.pick(role), of, of.root_limit)
        for role, of in task.materials.items()
    ]
    below = [(f"von Mises stress below the flank{whose}", summary.von_mises, of, of.yield_strength) for whose, of in every]
    for found, told, reason in (
        (pressures, away, missing("contact_pressure", "")),
        (roots, "tension", ""),
        (below, deep, missing("von_mises", "")),
    ):
        for words, value, material, limit in found:
            yield from _within_limit(words, value, material, limit, told, reason)


def _within_limit(
    words: str, value: float | None, material: Material, limit: Limit, note: str, reason: str
) -> Iterator[Comparison]:
    """Yield a stress (MPa) against the limit of a material, if it has one."""
    if isinstance(limit, tuple):
        note += f"; the limit of this material lies between {limit[0]:g} and {limit[1]:g} MPa, and the lower one counts"
        limit = limit[0]
    if limit is not None:
        yield at_most(words, value, limit, "MPa", f"limit of {material.name}", note, reason, subject=Subject.STRENGTH)


def standards(task: CheckTask, summary: Summary) -> Iterator[Comparison]:
    """Root stress and stiffness against ISO 6336 or DIN 3990, with a band for what the two leave out differently."""
    edition = task.rating.edition
    root, stiffness = task.options.root_band / 100, task.options.stiffness_band / 100
    sharing = "ISO puts the whole load on one pair of teeth at its outer point; the FE shares it, and sees the true fillet"
    notes = bending_notes(task, summary)
    for role, rating in task.rating.roots.items():
        name = task.rating.names.pick(role)
        source = f"sigma_F0, {edition.dated_part(3)} Method B, over b = {rating.width:.4g} mm"
        value, reference = summary.root_tension.pick(role), task.rating.root_stresses.pick(role)
        yield beside(f"root stress, {name}", value, reference, root, "MPa", source, sharing + notes.pick(role))
    standard = task.rating.stiffness
    body = "ISO's discs are stiffer or softer than this body; see how the bodies are held"
    for words, value, reference, symbol in (
        ("mean mesh stiffness", summary.mesh_stiffness_mean, standard.mesh_alpha, "c_gamma_alpha"),
        ("single stiffness", summary.single_stiffness, standard.single, "c'"),
    ):
        source = f"{symbol}, {edition.dated_part(1)} Method B"
        yield beside(words, value, reference, stiffness, "N/(mm µm)", source, body)


_PRESSURE = 0.01
_HALF_WIDTH = 0.02
"""Permitted difference of contact and Hertz. The width is less sharp than the pressure: flanks are no parabolas up to the
ends of the contact, and teeth bend along it. High teeth (m 2, h_a 1.35) have 1.25 % on any mesh, with pressures within 0.8 %.
"""
_DISCRETISATION = 0.01


def compare_plane(
    task: CheckTask, cycle: PlaneCycle, summary: PlaneSummary, convergence: tuple[Convergence, ...]
) -> tuple[Comparison, ...]:
    """Return all comparisons, gates first."""
    equilibrium = "equilibrium: the torque that is applied through the teeth"
    common = compare_common(task, cycle, summary, convergence, equilibrium=equilibrium, errors=3 * (_DISCRETISATION,))
    return (*_hertz(cycle, summary), *common)


def _hertz(cycle: PlaneCycle, summary: PlaneSummary) -> Iterator[Comparison]:
    """Yield the peak pressure and half width against two cylinders under the load carried, where they are furthest apart.

    Contacts too wide for two cylinders, or beside a parabolic relief, are left out; where there are no others the
    comparison is for information.
    """
    every = [found for found in cycle.interior_contacts if found[1].two_cylinders]
    narrow = [found for found in every if not conformal(found[1])]
    contacts, compared = (every, beside) if every and not narrow else (narrow, agrees)
    source = "Hertz: two cylinders of the flanks' curvature under the load that this pair of teeth carries"
    for words, computed, reference, tolerance, unit in (
        ("peak contact pressure", attrgetter("peak_pressure"), attrgetter("hertz_pressure"), _PRESSURE, "MPa"),
        ("half width of contact", attrgetter("half_width"), attrgetter("hertz_half_width"), _HALF_WIDTH, "mm"),
    ):
        if not contacts:
            reason = summary.missing.get("contact_pressure", "all contacts are on parabolic reliefs, whose curvature changes")
            yield compared(words, None, None, tolerance, unit, source, reason=reason)
            continue
        found = [(farness(computed(contact), reference(contact)), position, contact) for position, contact in contacts]
        _, position, contact = max(found, key=itemgetter(0))
        note = f"the worst of {len(contacts)} interior contacts, at roll angle {position.roll_angle:.2f} deg"
        reason = "its pressures have no width to tell" if math.isnan(computed(contact)) else ""
        yield compared(words, computed(contact), reference(contact), tolerance, unit, source, note, reason)


_ERRORS = (0.01, 0.02, 0.02)
"""Permitted influence of the mesh on the mesh stiffness, and on the root stresses of both gears, each of which is that of
one point.
"""


_FLICKER = 0.03
"""Permitted sampling error of a pressure: where lines cross the start of a linear relief, it flickers from cell to cell."""


def compare_solid(
    task: CheckTask,
    cycle: SolidCycle,
    summary: SolidSummary,
    convergence: tuple[Convergence, ...],
    shafts: LoadOnShafts | None = None,
) -> tuple[Comparison, ...]:
    """Return all comparisons, gates first."""
    equilibrium = f"equilibrium: the torque that is applied through the teeth, at the worst of {len(cycle.every)} positions"
    common = compare_common(task, cycle, summary, convergence, equilibrium=equilibrium, errors=_ERRORS, flicker=_FLICKER)
    return (*common, *_contact(task, summary), *_face(task, summary, shafts))


def _contact(task: CheckTask, summary: SolidSummary) -> Iterator[Comparison]:
    """Yield the pressure and lines of contact against part 2 of the standard and the geometry."""
    band, rating = task.options.contact_band / 100, task.rating
    away, middle = "the FE's is the greatest of all places away from edges", "in the middle of the common face width"
    standard = rating.edition.dated_part(2)
    nominal = rating.flank.nominal_stress * math.sqrt(rating.application_factor)
    for words, key, reference, source, note in (
        ("contact pressure, pinion", "contact_pressure", rating.contact_stresses.pinion, "Z_B sigma_H0", away),
        ("contact pressure, wheel", "contact_pressure", rating.contact_stresses.wheel, "Z_D sigma_H0", away),
        ("contact pressure at the pitch point", "contact_pressure_pitch_point", nominal, "sigma_H0", middle),
    ):
        value, source, reason = getattr(summary, key), f"{source}, {standard} Method B", summary.missing.get(key, "")
        yield beside(words, value, reference, band, "MPa", source, note, reason)
    lengths = task.pair.contact_line_lengths
    yield beside(
        "mean length of the lines of contact",
        summary.contact_length_mean,
        lengths.mean,
        band,
        "mm",
        "epsilon_alpha b/cos beta_b",
        "the FE counts cells that carry: bent teeth touch early and late, and modified or misaligned flanks not everywhere",
    )
    yield beside(
        "greatest line load",
        summary.line_load_max,
        rating.normal_force * rating.application_factor / lengths.minimum,
        band,
        "N/mm",
        "F_bn over the least length of the lines of contact",
        "rigid gears, load even along all lines, where these are shortest: the FE is above it by how uneven the load is",
        summary.missing.get("line_load_max", ""),
    )


def _face(task: CheckTask, summary: SolidSummary, shafts: LoadOnShafts | None) -> Iterator[Comparison]:
    """Face load factors against Method C or, of a pair on its shafts, against annex E."""
    band, factors = task.options.contact_band / 100, face_factors(task)
    flank, root, source = factors.flank, factors.root, "ISO 6336-1:2006 Method C"
    note = (
        f"Method C knows F_beta_y = {abs(factors.misalignment):.3g} µm, from misalignment and helix angle modifications alone: "
        "no edges, crowning, or deflection of the bodies"
    )
    if shafts is not None:
        flank, source = shafts.mesh.face_load_factor, "ISO 6336-1:2006 annex E"
        root = root_face_load_factor(flank, width_to_height(task.gear_pair))
        deflection, factor = shafts.method_c
        note = (
            "annex E has the same shafts, and slices of teeth as springs that know nothing of each other; on rigid shafts the "
            f"bodies have {shafts.rigid_face_load_factor:.3f}, annex E has {shafts.annex_e_on_rigid_shafts:.3f}; Method C has "
            f"{factor:.3f} for f_sh = {deflection:.3g} µm"
        )
    for words, value, reference in (
        ("face load factor K_Hbeta", summary.face_load_factor, flank),
        ("face load factor K_Fbeta, pinion", summary.root_face_load_factor.pinion, root),
        ("face load factor K_Fbeta, wheel", summary.root_face_load_factor.wheel, root),
    ):
        yield beside(words, value, reference, band, "", source, note)
