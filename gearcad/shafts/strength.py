"""Strength of a shaft at its shoulders by DIN 743 (2012): static safety against yield, and safety against fatigue.

Bending goes round with the shaft, fully reversed; torque and axial force are steady and count as mean stresses, which stay as
they are (case 1). Steel is quenched and tempered, its strengths are those of a diameter of 16 mm. d, D, r, t in mm, stresses in
MPa, Rz in µm. The text was not at hand: the formulas are recalled, and reproduce a published example of a shoulder.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from gearcad.core.records import JsonObject
from gearcad.shafts.beam import ShaftState

RECALLED = "DIN 743: formulas of shoulders, K_1 of quenched and tempered steel, K_2F, gamma_F and endurance limits from R_m"
"""Figures that rest on memory, for the list of unconfirmed figures."""

_HARDENED = 1.05
"""gamma_F of bending for shoulders: alpha_sigma from 1.5 to 2; 1.1 from 2 to 3, 1.15 beyond."""

_STATIC = 1.2
"""K_2F of solid shafts in bending and torsion."""


@dataclass(frozen=True, kw_only=True)
class Shoulder:
    """A shoulder of a solid shaft: smaller diameter `d`, larger one `D`, fillet radius `r` (mm), strengths and roughness."""

    d: float
    D: float
    r: float
    tensile_strength: float
    yield_strength: float
    roughness: float

    @property
    def t(self) -> float:
        """Depth t of the shoulder (mm)."""
        return (self.D - self.d) / 2

    @property
    def stress_concentration(self) -> tuple[float, float]:
        """Stress concentration factors alpha_sigma of bending and alpha_tau of torsion."""
        deep, round_ = self.r / self.t, self.r / self.d
        wide = round_ * (1 + 2 * round_) ** 2
        bending = 1 + 1 / math.sqrt(0.62 * deep + 11.6 * wide + 0.2 * deep**3 * self.d / self.D)
        torsion = 1 + 1 / math.sqrt(3.4 * deep + 38 * wide + deep**2 * self.d / self.D)
        return bending, torsion

    @cached_property
    def notch_factors(self) -> tuple[float, float]:
        """Notch factors beta_sigma and beta_tau: alpha/n, n = 1 + sqrt(G') 10^-(0.33 + sigma_S/712)."""
        narrow = 1 / (4 * math.sqrt(self.t / self.r) + 2) if self.d / self.D > 0.67 else 0.0
        gradients = 2.3 * (1 + narrow) / self.r, 1.15 / self.r
        exponent = 10 ** -(0.33 + self.yield_strength / 712)
        bending, torsion = (
            alpha / (1 + math.sqrt(gradient) * exponent)
            for alpha, gradient in zip(self.stress_concentration, gradients, strict=True)
        )
        return bending, torsion

    @property
    def size_of_strength(self) -> float:
        """K_1 of the tensile strength by the larger diameter: 1 - 0.26 lg(d_eff/16)."""
        return 1 - 0.26 * math.log10(min(max(self.D, 16.0), 300.0) / 16)

    @property
    def size_of_yield(self) -> float:
        """K_1 of the yield strength by the larger diameter: 1 - 0.34 lg(d_eff/16)."""
        return 1 - 0.34 * math.log10(min(max(self.D, 16.0), 300.0) / 16)

    @property
    def factors(self) -> tuple[float, float]:
        """K_sigma and K_tau: beta/K_2 + 1/K_F - 1."""
        size = 1 - 0.2 * math.log10(min(max(self.d, 7.5), 150.0) / 7.5) / math.log10(20)
        strength = self.size_of_strength * self.tensile_strength
        rough = 1 - 0.22 * math.log10(max(self.roughness, 1.0)) * (math.log10(strength / 20) - 1)
        bending, torsion = self.notch_factors
        return bending / size + 1 / rough - 1, torsion / size + 1 / (0.575 * rough + 0.425) - 1

    @property
    def alternating_limits(self) -> tuple[float, float]:
        """sigma_bWK and tau_tWK: 0.5 and 0.3 of the tensile strength, times K_1, over K_sigma and K_tau."""
        strength = self.size_of_strength * self.tensile_strength
        bending, torsion = self.factors
        return 0.5 * strength / bending, 0.3 * strength / torsion

    @property
    def yield_limits(self) -> tuple[float, float]:
        """sigma_bFK and tau_tFK: K_1 K_2F gamma_F sigma_S, of torsion over the root of 3."""
        alpha = self.stress_concentration[0]
        hardened = 1.0 if alpha < 1.5 else _HARDENED if alpha < 2 else 1.1 if alpha < 3 else 1.15
        strength = self.size_of_yield * self.yield_strength * _STATIC
        return strength * hardened, strength / math.sqrt(3)

    def safeties(self, bending: float, torsion: float, axial: float) -> tuple[float, float]:
        """Return the safety against fatigue and that against yield under nominal stresses (MPa); infinite without any."""
        limit, _ = self.alternating_limits
        sensitivity = limit / (2 * self.size_of_strength * self.tensile_strength - limit)
        left = limit - sensitivity * math.sqrt(axial**2 + 3 * torsion**2)
        fatigue = max(left, 0.0) / bending if bending else math.inf
        across, along = self.yield_limits
        used = math.hypot((bending + abs(axial)) / across, torsion / along)
        return fatigue, 1 / used if used else math.inf


@dataclass(frozen=True)
class ShoulderSafety:
    """Safeties at a shoulder of a shaft at a position (mm); None with the reason."""

    position: float
    fatigue: float | None = None
    static: float | None = None
    reason: str = ""

    def to_dict(self) -> JsonObject:
        """Return position, "S_D" against fatigue and "S_F" against yield."""
        finite = {
            "S_D": None if self.fatigue is None or math.isinf(self.fatigue) else self.fatigue,
            "S_F": None if self.static is None or math.isinf(self.static) else self.static,
        }
        return {"position": self.position, **finite, "not_judged": [self.reason] if self.reason else []}


def shoulder_safeties(state: ShaftState) -> list[ShoulderSafety]:
    """Return the safeties at all shoulders between segments of a shaft under its load."""
    shaft, found = state.shaft, []
    pairs = zip(shaft.ends[1:-1], shaft.segments[:-1], shaft.segments[1:], strict=True)
    for position, left, right in pairs:
        if left.outer_diameter == right.outer_diameter:
            continue
        thin, thick = sorted((left, right), key=lambda each: each.outer_diameter)
        missing = [
            name
            for name, value in (
                ("fillet_radius", left.fillet_radius),
                ("tensile_strength", thin.tensile_strength),
                ("yield_strength", thin.yield_strength),
                ("roughness", thin.roughness),
            )
            if value is None
        ]
        if missing:
            found.append(ShoulderSafety(position, reason=f"{', '.join(missing)} not given"))
            continue
        if left.inner_diameter or right.inner_diameter:
            found.append(ShoulderSafety(position, reason="hollow shafts are not covered"))
            continue
        assert left.fillet_radius is not None and thin.tensile_strength is not None
        assert thin.yield_strength is not None and thin.roughness is not None
        shoulder = Shoulder(
            d=thin.outer_diameter,
            D=thick.outer_diameter,
            r=left.fillet_radius,
            tensile_strength=thin.tensile_strength,
            yield_strength=thin.yield_strength,
            roughness=thin.roughness,
        )
        node = shaft.node_at(position)
        cut = state.cuts[node - 1, 1] if thin is left else state.cuts[node, 0]
        bending = math.hypot(cut[3], cut[4]) / thin.section_modulus
        fatigue, static = shoulder.safeties(bending, abs(cut[5]) / (2 * thin.section_modulus), cut[2] / thin.area)
        found.append(ShoulderSafety(position, float(fatigue), float(static)))
    return found
