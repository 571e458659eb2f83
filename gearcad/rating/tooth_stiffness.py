"""Tooth and mesh stiffness by ISO 6336-1:2006, clause 9, Method B (the same in DIN 3990-1:1987), with the rim's thickness.

An external gear's rim is measured in tooth heights, that of a ring in normal modules.

Stiffness per face width in N/(mm·µm), flexibility in mm·µm/N, helix and pressure angles in degrees. Gear 1 is the one with
fewer teeth; equations are those of ISO 6336-1:2006. A ring is gear 2, and in q' a rack: 1/z_n2 = 0 (to be verified), x_2 with
the sign of ISO 21771.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Generic

from gearcad.core.records import Notice, PerGear
from gearcad.core.values import Values, cos, fourth_root, radians, smaller
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.gear_data import RING_RIM_LIMIT
from gearcad.material import Material
from gearcad.rating.editions import Edition

RIM_LIMIT = 1.2
"""Ratio s_R/h_t (external gears) from which on a rim is as stiff as a solid body."""

THINNEST = 0.5
"""Ratio s_R/h_t above which the standard asks rims to stay."""

THINNEST_RING = 1.75
"""Ratio s_R/m_n above which the standard asks rims of rings to stay."""


def rim_thickness_ratio(gear: Gear) -> float:
    """s_R/h_t: rim below the root circle, down to the web if one is given, else to bore and keyway, over the tooth height."""
    rim = gear.body.rim_thickness or (gear.root_diameter - gear.body.opening_diameter) / 2
    return rim / ((gear.tip_diameter - gear.root_diameter) / 2)


def rim_thickness_factor(ratio: float, edition: Edition) -> float:
    """Y_B = 1.6 ln(2.242 h_t/s_R) (clause 9) for s_R/h_t below 1.2, else 1; DIN 3990-3 has none."""
    return 1.0 if ratio >= RIM_LIMIT or edition is Edition.DIN_1987 else 1.6 * math.log(2.242 / ratio)


def ring_rim_ratio(gear: Gear) -> float | None:
    """s_R/m_n of a ring: from the root circle out to the rim diameter, or as given; None where neither is."""
    body = gear.body
    if body.rim_thickness:
        return body.rim_thickness / gear.normal_module
    return None if body.rim_diameter is None else (body.rim_diameter + gear.root_diameter) / 2 / gear.normal_module


def ring_rim_factor(ratio: float, edition: Edition) -> float:
    """Y_B = 1.15 ln(8.324 m_n/s_R) (clause 9, to be verified) for s_R/m_n below 3.5, else 1; DIN 3990-3 has none."""
    return 1.0 if ratio >= RING_RIM_LIMIT or edition is Edition.DIN_1987 else 1.15 * math.log(8.324 / ratio)


@dataclass(frozen=True)
class RatedRim(ABC):
    """Rim of one gear; `ratio` is its relative thickness, None for a ring whose rim is not given."""

    ratio: float | None

    @abstractmethod
    def factor(self, edition: Edition) -> float:
        """Rim thickness factor Y_B."""

    @abstractmethod
    def notices(self, edition: Edition, where: str) -> Iterator[Notice]:
        """Yield the notices on the strength of the rim."""

    @abstractmethod
    def not_covered(self) -> str:
        """Return the reason why the standard has no Y_B for the rim; "" if it has."""


class ExternalRim(RatedRim):
    """Rim below the teeth of an external gear; `ratio` is s_R/h_t."""

    ratio: float

    def factor(self, edition: Edition) -> float:
        return rim_thickness_factor(self.ratio, edition)

    def notices(self, edition: Edition, where: str) -> Iterator[Notice]:
        if self.ratio < RIM_LIMIT:
            avoid = f"is at most {THINNEST:g}, which the standard asks to avoid"
            said = avoid if self.ratio <= THINNEST else f"weakens the root (below {RIM_LIMIT:g})"
            yield Notice("thin-rim", f"{self.ratio:.3g} tooth heights under the root {said}; {_known(self, edition)}", where)

    def not_covered(self) -> str:
        if self.ratio > THINNEST:
            return ""
        return f"Y_B holds for rims of more than {THINNEST:g} tooth heights under the root, here {self.ratio:.3g}"


class RingRim(RatedRim):
    """Rim outside the teeth of a ring; `ratio` is s_R/m_n."""

    def factor(self, edition: Edition) -> float:
        return 1.0 if self.ratio is None else ring_rim_factor(self.ratio, edition)

    def notices(self, edition: Edition, where: str) -> Iterator[Notice]:
        if self.ratio is None:
            text = f"body.rim_diameter is not given: Y_B is 1, as of a rim of at least {RING_RIM_LIMIT:g} m_n"
            yield Notice("rim-not-given", text, where)
        elif self.ratio < RING_RIM_LIMIT:
            avoid = f"is at most {THINNEST_RING:g}, which the standard asks to avoid"
            said = avoid if self.ratio <= THINNEST_RING else f"weakens the root (below {RING_RIM_LIMIT:g})"
            yield Notice("thin-rim", f"{self.ratio:.3g} m_n outside the root {said}; {_known(self, edition)}", where)

    def not_covered(self) -> str:
        if self.ratio is None or self.ratio > THINNEST_RING:
            return ""
        return f"Y_B holds for rims of more than {THINNEST_RING:g} m_n outside the root, here {self.ratio:.3g}"


def _known(rim: RatedRim, edition: Edition) -> str:
    factor = rim.factor(edition)
    return f"Y_B = {factor:.4g}" if factor > 1 else "the standard chosen has no factor for it"


def rim_of(gear: Gear) -> RatedRim:
    """Return the rim of a gear or a ring."""
    return RingRim(ring_rim_ratio(gear)) if gear.internal else ExternalRim(rim_thickness_ratio(gear))


CORRECTION_FACTOR = 0.8
"""C_M (83): what measured stiffness keeps of the theoretical one."""

STEEL_MODULUS = 206000.0
"""E_St (MPa), the Young's modulus behind the series for q'."""

STEEL = (190000.0, 216000.0)
"""Young's moduli (MPa) of what engineers call steel: the standard's steel/steel pairing, whose stiffness is not converted."""

LOW_LOAD = 100.0
"""Specific load F_t K_A/b (N/mm) below which the stiffness falls with the load."""

THIN_WEB, THICK_WEB = 0.2, 1.2
"""Least and largest ratio b_s/b that C_R takes into account."""

THIN_RIM = 1.0
"""Least ratio s_R/m_n that C_R takes into account."""

HIGH_LOAD = 1600.0
"""Greatest specific load (N/mm) that Method B was confirmed for."""


@dataclass(frozen=True, kw_only=True)
class MeshStiffness(Generic[Values]):
    """Factors and stiffnesses of clause 9. `single`, `mesh_alpha` and `mesh_beta` are c', c_gamma_alpha and c_gamma_beta.

    These are those of the load of the rating; `high_load_single` is c' from a specific load of 100 N/mm on.
    """

    flexibility: Values
    theoretical: Values
    blank_factor: Values
    rack_factor: Values
    material_factor: float
    low_load_factor: Values
    high_load_single: Values
    transverse_contact_ratio: Values

    @cached_property
    def single(self) -> Values:
        """c' under the load: (90) reduces it below 100 N/mm."""
        return self.high_load_single * self.low_load_factor

    @cached_property
    def mesh_alpha(self) -> Values:
        """c_gamma_alpha of the load (91)."""
        return mesh_stiffness_alpha(self.single, self.transverse_contact_ratio)

    @cached_property
    def mesh_beta(self) -> Values:
        """c_gamma_beta of the load (92)."""
        return mesh_stiffness_beta(self.mesh_alpha)

    def to_dict(self) -> dict[str, Values]:
        """Return the values under their symbols.

        Those for the load itself end in `_lowload` (equal where the load is not low).
        """
        high_alpha = mesh_stiffness_alpha(self.high_load_single, self.transverse_contact_ratio)
        return {
            "q_prime": self.flexibility,
            "c_th": self.theoretical,
            "C_M": CORRECTION_FACTOR,
            "C_R": self.blank_factor,
            "C_B": self.rack_factor,
            "xi": self.material_factor,
            "c_prime": self.high_load_single,
            "c_gamma_alpha": high_alpha,
            "c_gamma_beta": mesh_stiffness_beta(high_alpha),
            "low_load_factor": self.low_load_factor,
            "c_prime_lowload": self.single,
            "c_gamma_alpha_lowload": self.mesh_alpha,
            "c_gamma_beta_lowload": self.mesh_beta,
        }


def tooth_flexibility(virtual_teeth: tuple[Values, Values], profile_shifts: tuple[Values, Values]) -> Values:
    """q' (82): least flexibility of a pair of teeth, by the series of table 9. Gear 1, with fewer teeth, comes first.

    Numbers, or arrays of many pairs.

    `math.inf` virtual teeth are those of a rack, or of a ring.
    """
    (z_n1, z_n2), (x_1, x_2) = virtual_teeth, profile_shifts
    return (
        0.04723
        + 0.15551 / z_n1
        + 0.25791 / z_n2
        - 0.00635 * x_1
        - 0.11654 * x_1 / z_n1
        - 0.00193 * x_2
        - 0.24188 * x_2 / z_n2
        + 0.00529 * x_1**2
        + 0.00182 * x_2**2
    )


def theoretical_stiffness(flexibility: Values) -> Values:
    """c'_th = 1/q' (81)."""
    return 1 / flexibility


def gear_blank_factor(web_thickness: float = 1.0, rim_thickness: float = 1.0) -> float:
    """C_R (84), (85): 1 for solid discs, else 1 + ln(b_s/b)/(5 e^(s_R/(5 m_n))).

    `web_thickness` b_s/b in face widths and `rim_thickness` s_R/m_n in normal modules; the standard takes b_s/b within
    0.2 ... 1.2 and s_R/m_n at least 1, and values beyond as these limits.
    """
    web, rim = min(max(web_thickness, THIN_WEB), THICK_WEB), max(rim_thickness, THIN_RIM)
    return 1 + math.log(web) / (5 * math.exp(rim / 5))


def basic_rack_factor(dedendum: float, pressure_angle: float) -> float:
    """C_B (86) = (1 + 0.5 (1.2 - h_fP/m_n)) (1 - 0.02 (20 - alpha_n)); `dedendum` in normal modules."""
    return (1 + 0.5 * (1.2 - dedendum)) * (1 - 0.02 * (20 - pressure_angle))


def material_factor(youngs_modulus: float) -> float:
    """xi = E/E_St (88), (89) of a pair made of one material; 1 for steels (190 ... 216 GPa), which (80) was made for."""
    return 1.0 if STEEL[0] <= youngs_modulus <= STEEL[1] else youngs_modulus / STEEL_MODULUS


def pair_modulus(materials: PerGear[Material]) -> float:
    """2 E_1 E_2/(E_1 + E_2) (MPa), which stands for E in xi where the gears differ."""
    first, second = (material.youngs_modulus for material in materials)
    return first * (2 * second / (first + second))  # exactly E of two that are equal


def low_load_factor(specific_load: Values) -> Values:
    """((F_t K_A/b)/100)^0.25 (90) below 100 N/mm, else 1; `specific_load` F_t K_A/b in N/mm."""
    return fourth_root(smaller(specific_load / LOW_LOAD, 1.0))


def single_stiffness(theoretical: Values, blank_factor: Values, rack_factor: Values, helix_angle: Values) -> Values:
    """c' = c'_th C_M C_R C_B cos beta (80)."""
    return theoretical * CORRECTION_FACTOR * blank_factor * rack_factor * cos(radians(helix_angle))


def mesh_stiffness_alpha(single: Values, transverse_contact_ratio: Values) -> Values:
    """c_gamma_alpha = c' (0.75 epsilon_alpha + 0.25) (91)."""
    return single * (0.75 * transverse_contact_ratio + 0.25)


def mesh_stiffness_beta(mesh_alpha: Values) -> Values:
    """c_gamma_beta = 0.85 c_gamma_alpha (92)."""
    return 0.85 * mesh_alpha


def mesh_stiffness(pair: GearPair, materials: PerGear[Material], specific_load: float) -> MeshStiffness[float]:
    """Return the stiffness of a pair at a specific load F_t K_A/b (N/mm); C_R, as C_B, is the mean of both gears."""
    first, second = _by_teeth(pair)
    shifts = first.profile_shift, second.profile_shift
    return stiffness_of(
        materials,
        specific_load,
        flexibility=tooth_flexibility((_virtual_teeth(first), _virtual_teeth(second)), shifts),
        blank_factor=sum(blank_factor(gear) for gear in (first, second)) / 2,
        rack_factor=sum(basic_rack_factor(gear.dedendum, gear.rack.pressure_angle) for gear in (first, second)) / 2,  # (87)
        helix_angle=pair.pinion.helix_angle,
        transverse_contact_ratio=pair.transverse_contact_ratio,
    )


def stiffness_of(
    materials: PerGear[Material],
    specific_load: Values,
    *,
    flexibility: Values,
    blank_factor: Values,
    rack_factor: Values,
    helix_angle: Values,
    transverse_contact_ratio: Values,
) -> MeshStiffness[Values]:
    """Return the mesh stiffness of a pair at a specific load F_t K_A/b (N/mm), from q', C_R and C_B."""
    xi, theoretical = material_factor(pair_modulus(materials)), theoretical_stiffness(flexibility)
    return MeshStiffness(
        flexibility=flexibility,
        theoretical=theoretical,
        blank_factor=blank_factor,
        rack_factor=rack_factor,
        material_factor=xi,
        low_load_factor=low_load_factor(specific_load),
        high_load_single=xi * single_stiffness(theoretical, blank_factor, rack_factor, helix_angle),
        transverse_contact_ratio=transverse_contact_ratio,
    )


def stiffness_notices(pair: GearPair, specific_load: float) -> Iterator[Notice]:
    """Yield a notice for each way in which the pair or its load leaves the range that clause 9 states for its formulas."""
    for role, gear in pair.gears.items():
        yield from blank_notices(gear, role.value)
    first, second = _by_teeth(pair)
    if first.profile_shift < second.profile_shift:
        here = f"{first.profile_shift:g} and {second.profile_shift:g}"
        yield Notice("stiffness-shift-order", f"c': q' is stated for x_1 >= x_2, here {here}")
    if not -0.5 <= (total := pair.profile_shift_sum) <= 2.0:
        yield Notice("stiffness-shift-sum", f"c': q' is stated for x_1 + x_2 from -0.5 to 2, here {total:.6g}")
    yield from load_notices(specific_load, pair.transverse_contact_ratio)


def load_notices(specific_load: float, transverse_contact_ratio: float) -> Iterator[Notice]:
    """Yield a notice for load (N/mm) or contact ratio outside the range that clause 9 states."""
    if specific_load > HIGH_LOAD:
        text = f"c': confirmed up to a specific load of {HIGH_LOAD:g} N/mm, here {specific_load:.0f} N/mm"
        yield Notice("stiffness-high-load", text)
    if (ratio := transverse_contact_ratio) < 1.2:
        text = f"c_gamma: stated from a contact ratio of 1.2, here {ratio:.4f}: up to 10 % too high"
        yield Notice("stiffness-contact-ratio", text)


def blank_notices(gear: Gear, owner: str) -> Iterator[Notice]:
    """Yield a notice for each way in which the body of a gear ("pinion" or "wheel") leaves the range of C_R."""
    web, rim = _blank(gear)
    if gear.internal:
        yield from _ring_notices(gear)
    elif not gear.body.web_thickness and (height := rim_thickness_ratio(gear)) < RIM_LIMIT:
        text = f"c': C_R is 1 of a solid disc, but the {owner} has only {height:.3g} tooth heights under the root"
        yield Notice("stiffness-solid-disc", text)
    if not THIN_WEB <= web <= THICK_WEB:
        limit = THIN_WEB if web < THIN_WEB else THICK_WEB
        text = f"c': C_R knows webs of {THIN_WEB:g} to {THICK_WEB:g} b, the {owner}'s {web:.3g} b counts as {limit:g} b"
        yield Notice("stiffness-web", text)
    if rim < THIN_RIM:
        text = f"c': C_R knows rims from {THIN_RIM:g} m_n on, the {owner}'s {rim:.3g} m_n counts as {THIN_RIM:g} m_n"
        yield Notice("stiffness-rim", text)


def _ring_notices(gear: Gear) -> Iterator[Notice]:
    """Yield notices on q' for a ring, to be verified, and on C_R, which covers webs and leaves out the ring's rim."""
    text = "c': q' takes the ring for a rack (1/z_n2 = 0), as remembered of ISO 6336-1, whose text was not at hand: verify it"
    yield Notice("stiffness-ring-to-verify", text)
    if not gear.body.web_thickness:
        rim = ring_rim_ratio(gear)
        known = "not given" if rim is None else f"{rim:.3g} m_n"
        text = f"c': C_R is 1 for the ring, which has no web; its rim (s_R {known}) is not in c'"
        yield Notice("stiffness-ring-rim", text)


def _virtual_teeth(gear: Gear) -> float:
    """Return z_n as the formula of q' takes it."""
    return math.inf if gear.internal else gear.virtual_teeth


def blank_factor(gear: Gear) -> float:
    """C_R of one gear."""
    return gear_blank_factor(*_blank(gear))


def _blank(gear: Gear) -> tuple[float, float]:
    """Return b_s/b and s_R/m_n of the blank; 1 and 1, for which C_R is 1, of a solid disc."""
    body = gear.body
    return (body.web_thickness / gear.face_width, body.rim_thickness / gear.normal_module) if body.web_thickness else (1.0, 1.0)


def _by_teeth(pair: GearPair) -> tuple[Gear, Gear]:
    """Gear 1 and gear 2 of the standard: fewer teeth first, with equal teeth the larger profile shift first."""
    first, second = sorted(pair.gears, key=lambda gear: (gear.tooth_count, -gear.profile_shift))
    return first, second
