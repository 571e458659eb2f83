"""Where two gears touch: the line contact of their flanks at a place on the line of action."""

from __future__ import annotations

import math

from gearcad.errors import GeometryError
from gearcad.geometry import GearPair
from gearcad.geometry.limits import at_most
from gearcad.material import Materials, elastic_constants, of_both
from gearcad.rating.hertz import LineContact, reduced_modulus, reduced_radius

__all__ = ["base_normal_force", "contact_at", "pitch_point_contact"]


def base_normal_force(pair: GearPair, torque: float) -> float:
    """F_bn = F_bt/cos beta_b with F_bt = |T_1|/r_b1: what all flanks carry together (N), for `torque` on the pinion (N·m)."""
    transverse = 2000 * abs(torque) / pair.pinion.base_diameter
    return transverse / math.cos(math.radians(pair.pinion.base_helix_angle))


def contact_at(
    pair: GearPair, material: Materials, *, distance: float, force: float, length: float | None = None
) -> LineContact:
    """Contact of one pair of teeth at `distance` from T1 on the line of action (mm, transverse section).

    `force` is what this pair of teeth carries, normal to the flanks (N), `length` the line that it spreads over evenly (mm;
    None: a line across the common face width, b/cos beta_b). The radii of curvature are those of the normal section,
    distance/cos beta_b and (T1T2 - distance)/cos beta_b, negative on the hollow flank of a ring. Raises GeometryError for a
    place that is not between T1 and T2, of an internal pair not beyond T1.

    Of two materials, stresses below the surface are those of the pinion.
    """
    materials = of_both(material)
    whole = pair.base_tangent.length
    if not 0 < distance < (math.inf if pair.internal else whole):
        permitted = f"must be above 0 and below {at_most(whole)} mm, between the base tangent points T1 and T2"
        if pair.internal:
            permitted = "must be above 0 mm, beyond the base tangent point T1"
        raise GeometryError("distance", distance, permitted, "mm")
    lean = math.cos(math.radians(pair.pinion.base_helix_angle))
    if length is None:
        length = pair.common_width.width / lean
    return LineContact(
        load_per_width=force / length,
        radius=reduced_radius((distance / lean, (whole - distance) / lean)),
        modulus=reduced_modulus(*elastic_constants(materials)),
        poisson_ratio=materials.pinion.poisson_ratio,
    )


def pitch_point_contact(pair: GearPair, material: Materials, torque: float) -> LineContact:
    """Contact at the pitch point of the middle plane under `torque` on the pinion (N·m).

    The force is spread evenly over all lines of contact at that roll angle: over the common face width of a spur pair
    that carries on one tooth there.
    """
    return contact_at(
        pair,
        material,
        distance=pair.path_of_contact.C,
        force=base_normal_force(pair, torque),
        length=pair.contact_line_length(0.0),
    )
