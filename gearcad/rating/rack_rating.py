"""rate_rack: Hertz, flank stress, root stress and mesh stiffness of a pinion and a rack, a wheel of infinitely many teeth.

The standards name no racks: what they say of a wheel is taken to that limit (u and z_2 infinite, x_2 = 0).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from gearcad.errors import GeometryError
from gearcad.geometry import RackPair
from gearcad.load import Load
from gearcad.material import Material, Materials, elastic_constants, of_both
from gearcad.notice import Notice
from gearcad.per_gear import PerGear, Role
from gearcad.rating.edition_2019 import RECALLED, edition_notices, relieved
from gearcad.rating.editions import Edition
from gearcad.rating.hertz import LineContact, reduced_modulus
from gearcad.rating.iso6336_1 import (
    MeshStiffness,
    basic_rack_factor,
    blank_factor,
    blank_notices,
    load_notices,
    stiffness_of,
    tooth_flexibility,
)
from gearcad.rating.iso6336_2 import (
    FlankRating,
    contact_factor,
    contact_ratio_factor,
    elasticity_notices,
    elasticity_of,
    helix_angle_factor,
    profile_factor,
    zone_factor,
)
from gearcad.rating.iso6336_3 import RootMesh, RootRating, deep_notices, notch_notices, root_notices, root_rating
from gearcad.rating.options import RatingOptions
from gearcad.rating.rack_root import rack_load_point, rack_section, virtual_rack
from gearcad.rating.rate import Rating, fillet_notices, require_ratable, scope_notices

__all__ = ["RackRating", "rack_contact_at", "rate_rack"]

_FELT = 1e-4
"""Of the contact ratio: the root radii of ISO 53 are rounded, so standard racks take some 1e-6 of it."""


@dataclass(frozen=True, kw_only=True)
class RackRating(Rating):
    """The rating of a pinion and a rack; what a wheel has elsewhere is the rack's."""

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
    """b (mm) of a root: the common width, and what stands over at both ends, at most m_n at each."""
    return pair.common_width + 2 * min((face_width - pair.common_width) / 2, pair.pinion.normal_module)


def _rack_root(pair: RackPair, mesh: RootMesh) -> RootRating:
    load = rack_load_point(pair.rack, mesh.virtual_contact_ratio)
    section, width = rack_section(pair.rack, load), _loaded_width(pair, pair.rack.face_width)
    return mesh.rating(section, load, virtual_rack(pair.rack), width=width, rim_thickness_factor=1.0)


def _stiffness(pair: RackPair, materials: PerGear[Material], specific_load: float) -> MeshStiffness:
    """With 1/z_n2 = 0 and x_2 = 0; C_R and C_B are the means of pinion and rack."""
    pinion, rack = pair.pinion, pair.rack
    q = tooth_flexibility((pinion.virtual_teeth, math.inf), (pinion.profile_shift, 0.0))
    dedendum = rack.root_depth / rack.normal_module
    factors = [basic_rack_factor(each, pinion.rack.pressure_angle) for each in (pinion.dedendum, dedendum)]
    return stiffness_of(q, (blank_factor(pinion) + 1) / 2, sum(factors) / 2, pair, materials, specific_load)


def _flank(pair: RackPair, materials: PerGear[Material], force: float, edition: Edition) -> FlankRating:
    """With (u + 1)/u = 1; the curvature at B and D over that at C is the pinion's."""
    pinion, path = pair.pinion, pair.path_of_contact
    zone = zone_factor(pinion.base_helix_angle, pinion.transverse_pressure_angle, pair.working_transverse_pressure_angle)
    elasticity = elasticity_of(materials)
    ratio = contact_ratio_factor(pair.transverse_contact_ratio, pair.overlap_ratio)
    helix = helix_angle_factor(pinion.helix_angle, edition)
    if pair.overlap_ratio < 1 and min(path.B, path.D) <= 0:
        permitted = "must be larger for a rating: single contact begins below the pinion's base circle"
        raise GeometryError("pinion.tip_diameter", pinion.tip_diameter, permitted, "mm")
    raised = profile_factor(edition, pinion, relieved(pinion.modification))
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


def _rack_root_notices(rating: RootRating, mesh: RootMesh) -> Iterator[Notice]:
    if not rating.section.on_fillet:
        text = "the tangent at 30 deg touches beyond the fillet, so Y_F and Y_S do not hold"
        yield Notice("tangent-off-fillet", text, "rack root")
    yield from notch_notices(rating, "rack root")
    yield from deep_notices(mesh, "rack root")
