"""Friction of flanks that slide on each other: its coefficient by a number or a law, and the efficiency of a mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import Literal

from gearcad.core.errors import ParameterError
from gearcad.core.records import JsonObject, PerGear, Role
from gearcad.core.values import Values
from gearcad.geometry import GearPair
from gearcad.geometry.tooth_friction import MeshFriction, ohlendorf_loss_factor
from gearcad.load import Load
from gearcad.material import Material
from gearcad.rating.options import LoadBin, RatingOptions
from gearcad.rating.scuffing import RZ_OVER_RA, USUAL_ROUGHNESS, Scuffing, scuffing
from gearcad.rating.scuffing_temperatures import LEAST_LOAD

FrictionLaw = Literal["flash", "integral", "niemann"]
"""Mean coefficients over the path of contact: of ISO/TR 13989-1 and -2, and of Niemann and ISO/TR 14179-2 (unconfirmed)."""

LAW_WORDS: dict[str, str] = {
    "flash": "mean coefficient of ISO/TR 13989-1 (flash temperature)",
    "integral": "mean coefficient of ISO/TR 13989-2 (integral temperature)",
    "niemann": "mean coefficient of Niemann and ISO/TR 14179-2, unconfirmed",
    "constant": "constant coefficient",
}

_EXPONENT = 0.2
"""Power of the load with which the coefficients of all laws grow."""


class _Application:
    """Load factors of which all but K_A are 1, as the check has them."""

    mesh_load = dynamic = face_flank = transverse_flank = 1.0

    def __init__(self, application: float) -> None:
        self.application = application


def mesh_friction(
    pair: GearPair, materials: PerGear[Material], load: Load, friction: float | FrictionLaw, options: RatingOptions
) -> MeshFriction:
    """Return the friction of a pair under its load, by a number or a law; of load factors laws have K_A alone.

    The pinion drives, or the wheel where the torque is against the speed. Raises ParameterError where a law has no coefficient.
    """
    driver = _driver(load)
    if not isinstance(friction, str):
        return MeshFriction(reference=float(friction), driver=driver)
    base = pair.pinion.base_diameter / 2
    force = abs(load.torque) * load.application_factor * 1000 / base / pair.common_width.width
    rated = scuffing_of_check(pair, materials, load, options)
    if rated.integral is None or not force:
        why = rated.reason or "without torque there is none"
        raise ParameterError("check.friction", friction, f"must be a number: {why}")
    coefficient, least = float(rated.integral.friction), 0.0
    if friction == "integral":
        least = LEAST_LOAD * force / float(rated.integral.specific_load)
    elif friction == "flash":
        if rated.flash is None:
            raise ParameterError("check.friction", friction, 'must be a number, "integral" or "niemann" for this contact ratio')
        coefficient = rated.flash.friction
    else:
        mesh = rated.integral.mesh
        rolling = 2 * math.pi * abs(load.speed) / 30_000 * base * math.tan(math.radians(mesh.working_pressure_angle))
        roughness = sum(gear.flank_roughness or USUAL_ROUGHNESS for gear in pair.gears) / 2 / RZ_OVER_RA
        coefficient = mean_coefficient(
            force, rolling, float(mesh.pitch_radius), rated.oil.dynamic_viscosity, roughness, rated.oil.lubricant_factor
        )
    return MeshFriction(
        reference=coefficient, driver=driver, law=friction, exponent=_EXPONENT, reference_force=force, least_force=least
    )


def _driver(load: Load) -> Role:
    """Return the gear that drives: the wheel where the torque is against the speed."""
    return Role.WHEEL if load.torque * load.speed < 0 else Role.PINION


def scuffing_of_check(pair: GearPair, materials: PerGear[Material], load: Load, options: RatingOptions) -> Scuffing:
    """Return the temperatures of a pair under its load, of load factors with K_A alone. Raises what `scuffing` raises."""
    return scuffing(pair, materials, load, _Application(load.application_factor), options, _driver(load))


def mean_coefficient(
    force: Values, sum_velocity: Values, radius: Values, viscosity: float, roughness: float, oil: float
) -> Values:
    """Return mu_m = 0.048 (F_bt/(b v_sumC rho_C))^0.2 eta^-0.05 Ra^0.25 X_L.

    By G. Niemann and H. Winter, and ISO/TR 14179-2, as remembered: unconfirmed. `force` F_bt/b in N/mm, `sum_velocity` of
    both flanks at the pitch point in m/s, reduced `radius` there in mm, `viscosity` in mPa s, `roughness` Ra in µm, `oil` X_L.
    """
    found: Values = 0.048 * (force / (sum_velocity * radius)) ** 0.2 * viscosity**-0.05 * roughness**0.25 * oil
    return found


@dataclass(frozen=True, kw_only=True)
class MeshEfficiency:
    """Efficiency of a mesh by Ohlendorf's loss factor H_V and a coefficient of friction, that of the governing load.

    With a load spectrum `efficiency` and `mean_loss` (W, None at rest) are the means over the life.
    """

    efficiency: float
    mean_loss: float | None
    coefficient: float
    loss_factor: float
    law: str

    def to_dict(self) -> JsonObject:
        """Return the content of "mesh_efficiency" in rate.json."""
        return {
            "efficiency": self.efficiency,
            "mean_loss": self.mean_loss,
            "coefficient": self.coefficient,
            "H_V": self.loss_factor,
            "law": self.law,
            "source": "H_V of Ohlendorf",
            "unconfirmed": ["coefficient"] if self.law == "niemann" else [],
        }


def mesh_efficiency(
    pair: GearPair, materials: PerGear[Material], load: Load, friction: float | FrictionLaw, options: RatingOptions
) -> MeshEfficiency | None:
    """Return the efficiency of a pair, over the load spectrum of the options if they have one; None where H_V does not hold.

    Raises ParameterError where a law has no coefficient.
    """
    factor = ohlendorf_loss_factor(pair)
    if factor is None:
        return None
    found, power, lost, spent = [], 0.0, 0.0, 0.0
    for part in options.bins or (LoadBin(1.0, 1.0),):
        of_part = replace(load, torque=load.torque * part.torque, speed=load.speed * part.speed)
        if not of_part.torque:
            continue
        law = mesh_friction(pair, materials, of_part, friction, options)
        force = abs(of_part.torque) * of_part.application_factor * 2000 / pair.pinion.base_diameter / pair.common_width.width
        through = abs(of_part.torque) * (abs(of_part.speed) if load.speed else 1.0)
        found.append((abs(of_part.torque), law.coefficient(force), law))
        power, spent = power + part.life * through, spent + part.life
        lost += part.life * through * law.coefficient(force) * factor
    if not found:
        return None
    _, coefficient, law = max(found, key=itemgetter(0))
    share = lost / power
    return MeshEfficiency(
        efficiency=1 - share if law.driver is Role.PINION else 1 / (1 + share),
        mean_loss=lost / spent * math.pi / 30 if load.speed else None,
        coefficient=coefficient,
        loss_factor=factor,
        law=law.law,
    )
