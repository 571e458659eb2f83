"""Nominal rating of a pair, or of a pinion and a rack: Hertz, flank stress, root stress and mesh stiffness under a load.

The standards name no racks: what they say of a wheel is taken to that limit (u and z_2 infinite, x_2 = 0).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Notice, PerGear, Role, texts
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.geometry.gear import refuse_halves
from gearcad.load import Load
from gearcad.material import Material, Materials, elastic_constants, of_both
from gearcad.rating.contact_stress import (
    FlankRating,
    LineContact,
    base_normal_force,
    contact_factor,
    contact_ratio_factor,
    elasticity_notices,
    elasticity_of,
    flank_notices,
    flank_rating,
    helix_angle_factor,
    pitch_point_contact,
    profile_factor,
    reduced_modulus,
    zone_factor,
)
from gearcad.rating.editions import RECALLED, Edition, edition_notices, relieved
from gearcad.rating.options import RatingOptions, RootShift
from gearcad.rating.root_section import rack_load_point, rack_section, virtual_rack
from gearcad.rating.root_stress import (
    GrindingNotch,
    RootMesh,
    RootRating,
    deep_notices,
    finishing_notices,
    loaded_width,
    notch_notices,
    root_notices,
    root_rating,
)
from gearcad.rating.tooth_stiffness import (
    MeshStiffness,
    basic_rack_factor,
    blank_factor,
    blank_notices,
    load_notices,
    mesh_stiffness,
    stiffness_notices,
    stiffness_of,
    tooth_flexibility,
)


@dataclass(frozen=True, kw_only=True)
class Rating:
    """Values of ISO 6336, Method B, that depend on geometry, material and torque. Forces in N, stresses in MPa, widths in mm.

    sigma_H0, sigma_F0 and the Hertz contact at the pitch point are nominal: of the torque itself, without load factors.
    sigma_H and sigma_F include the application factor K_A, and take K_v, K_Hbeta, K_Halpha, K_Fbeta and K_Falpha as 1.
    """

    edition: Edition
    tangential_force: float
    normal_force: float
    application_factor: float
    specific_load: float
    stiffness: MeshStiffness[float]
    flank: FlankRating
    roots: PerGear[RootRating[float]]
    pitch_point: LineContact
    notices: tuple[Notice, ...]
    verify: tuple[str, ...] = ()
    """Symbols of what rests on a text of the standard that was not at hand."""
    names: ClassVar[PerGear[str]] = PerGear("pinion", "wheel")
    """Names of both gears in documents."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    @property
    def contact_stresses(self) -> PerGear[float]:
        """sigma_H (MPa): Z_B or Z_D times sigma_H0 sqrt(K_A) (ISO 6336-2, clause 5)."""
        stress = self.flank.nominal_stress * math.sqrt(self.application_factor)
        return self.flank.contact_factors.map(lambda factor: factor * stress)

    @property
    def root_stresses(self) -> PerGear[float]:
        """sigma_F (MPa): sigma_F0 K_A (ISO 6336-3, clause 5)."""
        return self.roots.map(lambda root: root.nominal_stress * self.application_factor)

    def to_dict(self) -> dict[str, Any]:
        """Return values under their symbols, those of one gear under "pinion" and "wheel"; `symbols.RATING` has the words."""
        contact, flanks, bending = self.pitch_point, self.contact_stresses, self.root_stresses
        gears = {
            self.names.pick(role): {**root.to_dict(), "sigma_H": flanks.pick(role), "sigma_F": bending.pick(role)}
            for role, root in self.roots.items()
        }
        return {
            "edition": self.edition.value,
            "F_t": self.tangential_force,
            "F_bn": self.normal_force,
            "K_A": self.application_factor,
            "w_t": self.specific_load,
            **self.stiffness.to_dict(),
            **self.flank.to_dict(),
            "rho_C": contact.radius,
            "p_0": contact.peak_pressure,
            "b_H": contact.half_width,
            **gears,
            **({"verify": list(self.verify), "unconfirmed": list(self.verify)} if self.verify else {}),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }


def rate(
    pair: GearPair,
    material: Materials,
    load: Load,
    options: RatingOptions | None = None,
) -> Rating:
    """Rate a pair of gears, both of one material or each of its own, by Method B.

    F_t is that of the torque at the reference circles. Contact stress and stiffness hold for the common face width. The
    accuracy grade matters for deep teeth only, see `deep_tooth_factor`. Raises ParameterError without a torque, GeometryError
    for a pair whose contact the standard does not describe.
    """
    options = options or RatingOptions()
    edition, materials = options.standard, of_both(material)
    require_ratable(pair, load)
    force = 2000 * abs(load.torque) / pair.pinion.reference_diameter
    specific = force * load.application_factor / pair.common_width.width
    mesh = RootMesh.of(pair, force, edition, max(map(options.grade_of, pair.gears)))
    roots = PerGear.each(lambda role: root_rating(_as_cut(pair.gears.pick(role), options), mesh, loaded_width(pair, role)))
    return Rating(
        edition=edition,
        tangential_force=force,
        normal_force=base_normal_force(pair, load.torque),
        application_factor=load.application_factor,
        specific_load=specific,
        stiffness=mesh_stiffness(pair, materials, specific),
        flank=flank_rating(pair, materials, force, edition),
        roots=roots,
        pitch_point=pitch_point_contact(pair, materials, load.torque),
        verify=_recalled(pair, edition, roots.wheel),
        notices=(
            *scope_notices(pair),
            *_ring_notices(pair),
            *edition_notices(edition, modified=relieved(pair.pinion.modification, pair.wheel.modification)),
            *fillet_notices(pair),
            *stiffness_notices(pair, specific),
            *flank_notices(pair),
            *elasticity_notices(materials),
            *(notice for role, gear in pair.gears.items() for notice in root_notices(gear, role, roots.pick(role), mesh)),
        ),
    )


def _recalled(pair: GearPair, edition: Edition, wheel: RootRating[float]) -> tuple[str, ...]:
    """Return the symbols to be verified in the rating of a ring, or in a rating by the edition of 2019."""
    formula = () if wheel.formula is None else ("wheel.formula",)
    ring = ("q_prime", "Z_D", "wheel.Y_B", *formula) if pair.internal else ()
    return (*ring, *(symbol for symbol in RECALLED if edition is Edition.ISO_2019 and symbol not in ring))


def _as_cut(gear: Gear, options: RatingOptions) -> Gear:
    """Return the gear whose root is rated: as it is thinned, or with the nominal thickness of its teeth."""
    if options.root_shift is RootShift.GENERATING:
        return gear
    return replace(gear, tooth_thinning=0.0, tooth_allowance=None)


def require_ratable(pair: GearPair | RackPair, load: Load) -> None:
    """Raise ParameterError without a torque, GeometryError for a pair whose contact the standard does not describe."""
    refuse_halves(pair.pinion, "a rating")
    if load.torque == 0:
        raise ParameterError("torque", load.torque, "must not be 0 N·m: a rating needs a load", "N·m")
    ratio = pair.transverse_contact_ratio
    if not 1 <= ratio < 3:
        meaning = "nothing touches for part of every pitch" if ratio < 1 else "Method B knows no deeper teeth"
        raise GeometryError("transverse_contact_ratio", ratio, f"must be at least 1 and below 3 for a rating: {meaning}")


def scope_notices(pair: GearPair | RackPair) -> Iterator[Notice]:
    """Yield a notice for each way in which the pair leaves the scope of the whole standard (ISO 6336-1, clause 1)."""
    if not 15 <= (angle := pair.pinion.rack.pressure_angle) <= 25:
        text = f"ISO 6336 is confirmed for pressure angles from 15 to 25 deg, here {angle:g} deg"
        yield Notice("scope-pressure-angle", text)
    if (helix := abs(pair.pinion.helix_angle)) > 30:
        yield Notice("scope-helix-angle", f"ISO 6336 is confirmed for helix angles up to 30 deg, here {helix:g} deg")


def _ring_notices(pair: GearPair) -> Iterator[Notice]:
    """Yield a notice that values in the rating of a ring are to be verified."""
    if pair.internal:
        text = (
            "Z_D = 1, Y_B and the root formulas of rings are as remembered of ISO 6336:2006, whose text was not at hand:"
            " verify them before they decide"
        )
        yield Notice("ring-to-verify", text)


def fillet_notices(pair: GearPair | RackPair, felt: float = 1e-9) -> Iterator[Notice]:
    """Yield a notice if the fillets take away more than `felt` of the pair's contact ratio."""
    usable, whole = pair.usable_contact_ratio, pair.transverse_contact_ratio
    if usable < whole - felt:
        text = f"the tips reach {whole:.4f}, which the rating uses, but the fillets leave {usable:.4f} of involute"
        yield Notice("fillets-limit-contact", f"contact ratio: {text}")


_FELT = 1e-4
"""Relative change of the contact ratio from which a notice is given: the rounded root radii of ISO 53 change that of standard
racks by some 1e-6.
"""


@dataclass(frozen=True, kw_only=True)
class RackRating(Rating):
    """The rating of a pinion and a rack; values of a wheel are those of the rack."""

    names: ClassVar[PerGear[str]] = PerGear("pinion", "rack")


def rate_rack(pair: RackPair, material: Materials, load: Load, options: RatingOptions | None = None) -> RackRating:
    """Rate a pinion and a rack, both of one material or each of its own, by Method B; raises as `rate` does.

    F_t is the force on the rack along its length. The rack's back is taken as held, so its Y_B is 1.
    """
    options, materials = options or RatingOptions(), of_both(material)
    require_ratable(pair, load)
    force = pair.rack_force(abs(load.torque))
    specific = force * load.application_factor / pair.common_width
    mesh = RootMesh.of(pair, force, options.standard, options.grade_of(pair.pinion))
    roots = PerGear(root_rating(pair.pinion, mesh, _loaded_width(pair, pair.pinion.face_width)), _rack_root(pair, mesh))
    normal = force / math.cos(math.radians(pair.pinion.transverse_pressure_angle))
    normal /= math.cos(math.radians(pair.pinion.base_helix_angle))
    return RackRating(
        edition=options.standard,
        tangential_force=force,
        normal_force=normal,
        application_factor=load.application_factor,
        specific_load=specific,
        stiffness=_stiffness(pair, materials, specific),
        flank=_flank(pair, materials, force, options.standard),
        roots=roots,
        pitch_point=rack_contact_at(
            pair, materials, distance=pair.path_of_contact.C, force=normal, length=pair.contact_line_length(0.0)
        ),
        verify=("q_prime", *(RECALLED if options.standard is Edition.ISO_2019 else ())),
        notices=(
            *_rack_notices(pair),
            *elasticity_notices(materials),
            *edition_notices(options.standard, modified=relieved(pair.pinion.modification)),
            *scope_notices(pair),
            *fillet_notices(pair, _FELT),
            *blank_notices(pair.pinion, "pinion"),
            *load_notices(specific, pair.transverse_contact_ratio),
            *root_notices(pair.pinion, Role.PINION, roots.pinion, mesh),
            *finishing_notices(pair.rack, roots.wheel, "rack root"),
            *_rack_root_notices(roots.wheel, mesh),
        ),
    )


def rack_contact_at(
    pair: RackPair,
    material: Materials,
    *,
    distance: float,
    force: float,
    length: float | None = None,
) -> LineContact:
    """Contact of a tooth of the pinion with the rack's plane flank at `distance` from T1 (mm), as `contact_at` of gears.

    The reduced radius is that of the pinion's flank in the normal section. Raises GeometryError for a place before T1.
    """
    if not distance > 0:
        raise GeometryError("distance", distance, "must be above 0 mm, beyond the base tangent point T1", "mm")
    lean, materials = math.cos(math.radians(pair.pinion.base_helix_angle)), of_both(material)
    return LineContact(
        load_per_width=force / (pair.common_width / lean if length is None else length),
        radius=distance / lean,
        modulus=reduced_modulus(*elastic_constants(materials)),
        poisson_ratio=materials.pinion.poisson_ratio,
    )


def _loaded_width(pair: RackPair, face_width: float) -> float:
    """Return b (mm) of a root: the common width, and at each end the overhang, at most m_n."""
    return pair.common_width + 2 * min((face_width - pair.common_width) / 2, pair.pinion.normal_module)


def _rack_root(pair: RackPair, mesh: RootMesh[float]) -> RootRating[float]:
    """Root stress of a rack; with a tolerance of its stock, the one with the greater stress."""
    width = _loaded_width(pair, pair.rack.face_width)

    def rated(rack: Rack) -> RootRating[float]:
        load = rack_load_point(rack, mesh.virtual_contact_ratio)
        section, notch = rack_section(rack, load), GrindingNotch.of(rack)
        return mesh.rating(section, load, virtual_rack(rack), width=width, rim_thickness_factor=1.0, notch=notch)

    rack = pair.rack
    if not (tolerance := rack.premachining.stock_tolerance):
        return rated(rack)
    stocks = [rack.stock + sign * tolerance for sign in (-1, 1)]
    ends = [rated(rack.with_stock(stock)) for stock in stocks if rack.can_have_stock(stock)]
    return max([*ends, rated(rack)], key=lambda rating: rating.nominal_stress)


def _stiffness(pair: RackPair, materials: PerGear[Material], specific_load: float) -> MeshStiffness[float]:
    """Return the mesh stiffness of a pinion and a rack: 1/z_n2 = 0, x_2 = 0, C_R and C_B are the means of pinion and rack."""
    pinion, rack = pair.pinion, pair.rack
    q = tooth_flexibility((pinion.virtual_teeth, math.inf), (pinion.profile_shift, 0.0))
    dedendum = rack.root_depth / rack.normal_module
    factors = [basic_rack_factor(each, pinion.rack.pressure_angle) for each in (pinion.dedendum, dedendum)]
    return stiffness_of(
        materials,
        specific_load,
        flexibility=q,
        blank_factor=(blank_factor(pinion) + 1) / 2,
        rack_factor=sum(factors) / 2,
        helix_angle=pinion.helix_angle,
        transverse_contact_ratio=pair.transverse_contact_ratio,
    )


def _flank(pair: RackPair, materials: PerGear[Material], force: float, edition: Edition) -> FlankRating:
    """Return the flank rating of a pinion and a rack, with (u + 1)/u = 1.

    The curvature at B and D over that at C is the pinion's. Raises GeometryError if single contact begins below the pinion's
    base circle.
    """
    pinion, path = pair.pinion, pair.path_of_contact
    zone = zone_factor(pinion.base_helix_angle, pinion.transverse_pressure_angle, pair.working_transverse_pressure_angle)
    elasticity = elasticity_of(materials)
    ratio = contact_ratio_factor(pair.transverse_contact_ratio, pair.overlap_ratio)
    helix = helix_angle_factor(pinion.helix_angle, edition)
    if pair.overlap_ratio < 1 and min(path.B, path.D) <= 0:
        permitted = "must be larger for a rating: single contact begins below the pinion's base circle"
        raise GeometryError("pinion.tip_diameter", pinion.tip_diameter, permitted, "mm")
    raised = profile_factor(edition, pinion.helix_angle, relieved(pinion.modification))
    inner = PerGear(path.B, path.D) if pair.overlap_ratio < 1 else PerGear(path.C, path.C)
    factors = zone * elasticity * ratio * helix
    return FlankRating(
        zone_factor=zone,
        elasticity_factor=elasticity,
        contact_ratio_factor=ratio,
        helix_angle_factor=helix,
        contact_factors=inner.map(lambda place: raised * contact_factor(math.sqrt(path.C / place), pair.overlap_ratio)),
        nominal_stress=factors * math.sqrt(force / (pinion.reference_diameter * pair.common_width)),
    )


def _rack_notices(pair: RackPair) -> Iterator[Notice]:
    text = (
        "ISO 6336 names no racks: this is its wheel of infinitely many teeth, with 1/z_n2 = 0 in q' (to be verified), C_R = 1"
        " and Y_B = 1 of a rack whose back is held"
    )
    yield Notice("rack-as-wheel", text)
    if (ratio := pair.transverse_contact_ratio) > 2:
        text = f"Z_eps, Z_B and Z_D hold for a contact ratio up to 2, here {ratio:.4f}"
        yield Notice("flank-contact-ratio", f"sigma_H: {text}: two pairs of teeth share the load at any time")


def _rack_root_notices(rating: RootRating[float], mesh: RootMesh[float]) -> Iterator[Notice]:
    if not rating.section.on_fillet:
        text = "the tangent at 30 deg touches beyond the fillet, so Y_F and Y_S do not hold"
        yield Notice("tangent-off-fillet", text, "rack root")
    yield from notch_notices(rating, "rack root")
    yield from deep_notices(mesh, "rack root")
