"""Pairs that could scuff: load factors as they come, an oil, and both temperatures."""

from dataclasses import dataclass
from typing import Any

from gearcad import Gear, GearPair, Load, Material
from gearcad.core.records import PerGear, Role
from gearcad.material import MaterialGroup
from gearcad.rating import RatingOptions
from gearcad.rating.scuffing import Scuffing, scuffing

EH = PerGear(Material(group=MaterialGroup.CASE_HARDENED), Material(group=MaterialGroup.CASE_HARDENED))
OIL: dict[str, Any] = {
    "oil_viscosity_40": 220.0,
    "oil_viscosity_100": 19.0,
    "oil_temperature": 70.0,
    "oil_density": 900.0,
    "scuffing_stage": 12,
}


@dataclass(frozen=True)
class Factors:
    """Load factors of a flank."""

    application: float = 1.25
    mesh_load: float = 1.0
    dynamic: float = 1.05
    face_flank: float = 1.2
    transverse_flank: float = 1.1


def pair(
    teeth: tuple[int, int] = (21, 42),
    *,
    module: float = 2.0,
    shifts: tuple[float, float] = (0.3, 0.2),
    helix: float = 20.0,
    width: float = 30.0,
    roughness: float = 3.6,
    **gear: Any,
) -> GearPair:
    """A pair with its own centre distance; a ring is negative."""
    hand = 1 if teeth[1] < 0 else -1
    shared = {"normal_module": module, "face_width": width, "flank_roughness": roughness, **gear}
    return GearPair(
        pinion=Gear(teeth=teeth[0], helix_angle=helix, profile_shift=shifts[0], **shared),
        wheel=Gear(teeth=teeth[1], helix_angle=hand * helix, profile_shift=shifts[1], **shared),
    )


def scuffed(
    gears: GearPair,
    *,
    torque: float = 200.0,
    speed: float = 1500.0,
    factors: Factors | None = None,
    driver: Role = Role.PINION,
    **options: Any,
) -> Scuffing:
    """Its temperatures, of case-hardened gears in mineral oil unless said."""
    load, given = Load(torque=torque, speed=speed), RatingOptions(**(OIL | options))
    return scuffing(gears, EH, load, factors or Factors(), given, driver)
