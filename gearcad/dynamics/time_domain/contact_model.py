"""A pair of spur gears as two turning discs: with one spring (simple model), or with teeth that come and go (contact model).

After J. Uhlir, Spur gear mesh model for dynamic simulations, CTU Prague 2021, chapter 3. Both angles count counter-clockwise,
so the approach of the flanks is y = R_b1 phi_1 + R_b2 phi_2, and the coupling terms that (3.5) to (3.51) print with a minus
have a plus; the last entry of the matrix in (3.50) has R_b2 squared.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Any

from gearcad.core.errors import GeometryError, ParameterError, as_choice, plain_numbers, require_number, require_whole
from gearcad.core.records import Notice, PerGear
from gearcad.geometry import GearPair

SOFT = 0.1
"""Static approach in normal modules above which the stiffness is none that teeth have: steel ones give some thousandths."""


class EngagedPairs(Enum):
    """Pairs of teeth that carry."""

    RIGID_TIPS = "rigid tips"
    """Pairs between the points at which the tip circles cross the line of action."""
    PENETRATING_TIPS = "penetrating tips"
    """The same, but each gear's place is measured on its own flank: the zone shrinks by the approach."""
    ONE_PAIR = "one pair"
    """Always one pair: the simple model, as long as it is in contact."""


def disc_inertia(diameter: float, width: float, density: float) -> float:
    """Return J = pi/32 d^4 b rho in kg·m² of a full disc (mm, mm, kg/m³): Uhlir (3.4) with the reference diameter."""
    for name, value, unit in (("diameter", diameter, "mm"), ("width", width, "mm"), ("density", density, "kg/m^3")):
        require_number(name, value, unit, above=0)
    return math.pi / 32 * (1e-3 * diameter) ** 4 * 1e-3 * width * density


@dataclass(frozen=True, kw_only=True)
class ContactModel:
    """Two gears under balanced torques, whose engaged pairs of teeth are equal springs, f = N k y, with a damper b beside them.

    `teeth`, `base_radii` (mm) and `inertias` (kg·m²) of pinion and wheel, teeth and radius negative of a ring, which turns with
    the pinion; `normal_module` and `base_pitch` in mm; `first_contact` and `last_contact` in mm from T1, between which pairs
    carry; `pair_stiffness` k of one pair in N/µm; `damping` b in N·s/m, which acts also where the flanks have parted; `torque`
    on the pinion in N·m.
    `backlash` (mm along the line of action) lets the back flanks touch as well: `back_place` (mm) is then the sum of the
    places of the two flanks of one tooth of the pinion, each from the base tangent point of its own line of action.
    """

    teeth: PerGear[int]
    normal_module: float
    base_radii: PerGear[float]
    base_pitch: float
    first_contact: float
    last_contact: float
    inertias: PerGear[float]
    pair_stiffness: float
    damping: float
    torque: float
    zone: EngagedPairs = EngagedPairs.RIGID_TIPS
    backlash: float | None = None
    back_place: float | None = None

    def __post_init__(self) -> None:
        plain_numbers(self)
        object.__setattr__(self, "zone", as_choice("zone", self.zone, EngagedPairs))
        for name in ("teeth", "base_radii", "inertias"):
            values = getattr(self, name)
            if not isinstance(values, list | tuple) or len(values) != 2:
                raise ParameterError(name, values, "must be two numbers, of pinion and wheel")
            object.__setattr__(self, name, PerGear(*values))
        for gear, (teeth, radius, inertia) in enumerate(zip(self.teeth, self.base_radii, self.inertias, strict=True)):
            side = -1 if gear == 1 and isinstance(teeth, int) and teeth < 0 else 1
            require_whole(f"teeth[{gear}]", side * teeth, at_least=1, at_most=10000)
            require_number(f"base_radii[{gear}]", side * radius, "mm", above=0)
            require_number(f"inertias[{gear}]", inertia, "kg·m²", above=0)
        for name, unit in (("normal_module", "mm"), ("base_pitch", "mm"), ("pair_stiffness", "N/µm"), ("torque", "N·m")):
            require_number(name, getattr(self, name), unit, above=0)
        require_number("damping", self.damping, "N·s/m", at_least=0)
        require_number("first_contact", self.first_contact, "mm")
        require_number("last_contact", self.last_contact, "mm", above=self.first_contact)
        if (self.backlash is None) != (self.back_place is None):
            raise ParameterError("backlash", self.backlash, "must be given together with back_place")
        if self.backlash is not None:
            require_number("backlash", self.backlash, "mm", at_least=0)
            require_number("back_place", self.back_place, "mm")

    @classmethod
    def from_pair(
        cls,
        pair: GearPair,
        *,
        inertias: PerGear[float],
        pair_stiffness: float,
        damping: float,
        torque: float,
        zone: EngagedPairs = EngagedPairs.RIGID_TIPS,
        back_flanks: bool = False,
    ) -> ContactModel:
        """Return the model of a spur pair: its path of contact from A to E; its backlash if the back flanks may touch.

        Raises GeometryError for a helical pair.
        """
        if pair.pinion.helix_angle != 0:
            permitted = "must be 0: the contact model has pairs of teeth that touch over their whole width at once"
            raise GeometryError("pinion.helix_angle", pair.pinion.helix_angle, permitted, "deg")
        angles = math.radians(pair.pinion.profile.base_half_angle + pair.working_transverse_pressure_angle)
        back: dict[str, Any] = {}
        if back_flanks:
            # A reflection in the line of centres takes one line of action to the other, and a turn to its opposite.
            back = {"backlash": max(pair.normal_backlash, 0.0), "back_place": pair.pinion.base_diameter * angles}
        return cls(
            teeth=pair.gears.map(lambda gear: gear.teeth),
            normal_module=pair.pinion.normal_module,
            base_radii=pair.gears.map(lambda gear: gear.base_diameter / 2),
            base_pitch=pair.pinion.transverse_base_pitch,
            first_contact=pair.path_of_contact.A,
            last_contact=pair.path_of_contact.E,
            inertias=inertias,
            pair_stiffness=pair_stiffness,
            damping=damping,
            torque=torque,
            zone=zone,
            **back,
        )

    # ------------------------------------------------------------------ figures

    @property
    def masses(self) -> PerGear[float]:
        """J/R_b^2 of pinion and wheel along the line of action (kg)."""
        return PerGear(
            *(inertia / (1e-3 * radius) ** 2 for inertia, radius in zip(self.inertias, self.base_radii, strict=True))
        )

    @property
    def reduced_mass(self) -> float:
        """Reduced mass m_1 m_2/(m_1 + m_2) (kg)."""
        one, other = self.masses
        return one * other / (one + other)

    @property
    def pinion_share(self) -> float:
        """Part of the approach that is the pinion's: m_2/(m_1 + m_2)."""
        one, other = self.masses
        return other / (one + other)

    @property
    def contact_ratio(self) -> float:
        """Mean number of engaged pairs, 1 in the simple model."""
        if self.zone is EngagedPairs.ONE_PAIR:
            return 1.0
        return (self.last_contact - self.first_contact) / self.base_pitch

    @property
    def force(self) -> float:
        """Static force along the line of action (N)."""
        return self.torque / (1e-3 * self.base_radii.pinion)

    @property
    def static_approach(self) -> float:
        """Approach of the flanks (µm) where one pair carries the static force."""
        return self.force / self.pair_stiffness

    @property
    def damping_ratio(self) -> float:
        """Damping ratio b/(2 sqrt(k m)) with one pair in contact."""
        return self.damping / (2 * math.sqrt(1e6 * self.pair_stiffness * self.reduced_mass))

    def natural_frequency(self, pairs: float = 1.0) -> float:
        """Return sqrt(N k/m)/(2 pi) in Hz, undamped; `pairs` N may be a mean, such as the contact ratio."""
        require_number("pairs", pairs, above=0)
        return math.sqrt(1e6 * pairs * self.pair_stiffness / self.reduced_mass) / (2 * math.pi)

    def tooth_frequency(self, speed: float, harmonic: int = 1) -> float:
        """Return i z_1 n/60 in Hz at a speed of the pinion in rpm: Uhlir (3.55)."""
        return harmonic * self.teeth.pinion * speed / 60

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of parameters that are unlike those of gears."""
        found = []
        rest = 1e-3 * self.static_approach
        depth = rest / self.normal_module
        if depth > SOFT:
            more = ": the teeth pass through each other" if depth > 1 else ""
            text = (
                f"tooth_stiffness = {self.pair_stiffness:.4g} N/µm of one pair of teeth: the flanks penetrate by {rest:.4g} mm"
                f" at rest, {depth:.3g} of the module{more}; teeth are far stiffer"
            )
            found.append(Notice("soft-teeth", text))
        if self.contact_ratio < 1:
            text = f"contact ratio {self.contact_ratio:.4f}: below 1 no pair carries for a part of the time"
            found.append(Notice("low-contact-ratio", text))
        return tuple(found)
