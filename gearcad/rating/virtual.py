"""The virtual spur gear of a helical one, and where it is loaded (ISO 6336-3:2006, 6.2.2 and 6.2.3).

Lengths in mm, angles in degrees; equations are those of ISO 6336-3:2006. A spur gear is its own virtual gear; the equations
hold for rings with the signs of ISO 21771.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gearcad.geometry import Gear, involute

__all__ = ["LoadPoint", "VirtualGear", "load_point"]


@dataclass(frozen=True, kw_only=True)
class VirtualGear:
    """Spur gear with the teeth of a helical gear's normal section. Lengths in mm, the pressure angle in degrees.

    `teeth` z_n is any number. `tooth_angle` s_n/(m_n z_n) is the half tooth angle on the reference circle, in degrees.
    Of a ring number of teeth, diameters and half tooth angles are negative.
    """

    normal_module: float
    pressure_angle: float
    teeth: float
    reference_diameter: float
    base_diameter: float
    tip_diameter: float
    tooth_angle: float

    @classmethod
    def of(cls, gear: Gear) -> VirtualGear:
        """z_n (21), d_n (24), d_bn (26), d_an = d_n + d_a - d (27), with the tip form circle for d_a."""
        m_n, z_n, alpha_n = gear.normal_module, gear.virtual_teeth, gear.rack.pressure_angle
        d_n = m_n * z_n
        return cls(
            normal_module=m_n,
            pressure_angle=alpha_n,
            teeth=z_n,
            reference_diameter=d_n,
            base_diameter=d_n * math.cos(math.radians(alpha_n)),
            tip_diameter=d_n + gear.tip_form_diameter - gear.reference_diameter,
            tooth_angle=math.degrees(gear.normal_tooth_thickness / d_n),
        )

    @property
    def side(self) -> float:
        """The sign of its diameters."""
        return math.copysign(1.0, self.teeth)

    def half_angle(self, diameter: float) -> float:
        """Half tooth angle (degrees) of the involute at a diameter (mm) that is not inside the base circle."""
        at = math.degrees(math.acos(min(self.base_diameter / diameter, 1.0)))
        return self.tooth_angle + math.degrees(involute(self.pressure_angle) - involute(at))


@dataclass(frozen=True, kw_only=True)
class LoadPoint:
    """Outer point of single pair contact on the virtual gear: diameter d_en (mm), angles alpha_en, gamma_e, alpha_Fen (deg).

    Diameter and half angle are negative on a ring.
    """

    diameter: float
    pressure_angle: float
    half_angle: float
    load_angle: float

    def to_dict(self) -> dict[str, float]:
        """Values under their symbols."""
        return {"d_en": self.diameter, "alpha_Fen": self.load_angle}


def load_point(virtual: VirtualGear, virtual_contact_ratio: float) -> LoadPoint:
    """Where a single pair carries at the greatest lever, for the virtual contact ratio eps_alphan = eps_alpha/cos^2 beta_b.

    d_en = 2 sqrt((sqrt(d_an^2/4 - d_bn^2/4) - p_bn (eps_alphan - 1))^2 + d_bn^2/4) (28), p_bn = pi m_n cos alpha_n;
    alpha_en = arccos(d_bn/d_en) (29), gamma_e = s_n/(m_n z_n) + inv alpha_n - inv alpha_en (30),
    alpha_Fen = alpha_en - gamma_e (31). On a ring the root of (28) is negative, as all lengths from its base circle are.
    """
    r_an, r_bn = virtual.tip_diameter / 2, virtual.base_diameter / 2
    p_bn = math.pi * virtual.normal_module * math.cos(math.radians(virtual.pressure_angle))
    side = virtual.side
    along = side * math.sqrt((r_an - r_bn) * (r_an + r_bn)) - p_bn * (virtual_contact_ratio - 1)
    d_en = side * 2 * math.hypot(along, r_bn)
    alpha_en = math.degrees(math.atan2(side * along, side * r_bn))
    gamma_e = virtual.half_angle(d_en)
    return LoadPoint(diameter=d_en, pressure_angle=alpha_en, half_angle=gamma_e, load_angle=alpha_en - gamma_e)
