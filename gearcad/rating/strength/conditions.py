"""Conditions: what the permissible stresses of a mesh go by beside materials and life, and what of it is assumed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.load import Load
from gearcad.per_gear import PerGear
from gearcad.rating.factors import mesh_radius
from gearcad.rating.options import RatingOptions

__all__ = ["Conditions"]

VISCOSITY = 220.0
"""Of an oil ISO VG 220 at 40 °C (mm²/s), which is assumed where none is given."""

FLANK_ROUGHNESS = 4.8
ROOT_ROUGHNESS = 20.0
"""Rz (µm) that are assumed of ground flanks and of milled roots."""


@dataclass(frozen=True, kw_only=True)
class Conditions:
    """Viscosity at 40 °C (mm²/s), speed at the reference circle (m/s), rho_red at the pitch point (mm), Rz (µm), m_n (mm).

    `assumed` says in words what was not given.
    """

    viscosity_40: float
    speed: float
    reduced_radius: float
    flank_roughness: PerGear[float]
    root_roughness: PerGear[float]
    normal_module: float
    gear_ratio: float
    assumed: tuple[str, ...]

    @classmethod
    def of(cls, pair: GearPair | RackPair, load: Load, options: RatingOptions) -> Conditions:
        """Those of a pair at the speed of the load."""
        pinion = pair.pinion
        teeth: PerGear[Gear | Rack] = PerGear(pinion, pair.wheel if isinstance(pair, GearPair) else pair.rack)
        given = {name: PerGear(*(getattr(gear, name, None) for gear in teeth)) for name in _ROUGHNESS}
        return cls(
            viscosity_40=VISCOSITY if options.oil_viscosity_40 is None else options.oil_viscosity_40,
            speed=math.pi * pinion.reference_diameter * abs(load.speed) / 60_000,
            reduced_radius=_reduced_radius(pair),
            flank_roughness=_or(given["flank_roughness"], FLANK_ROUGHNESS),
            root_roughness=_or(given["root_roughness"], ROOT_ROUGHNESS),
            normal_module=pinion.normal_module,
            gear_ratio=pair.gear_ratio if isinstance(pair, GearPair) else math.inf,
            assumed=tuple(_assumed(given, options, "wheel" if isinstance(pair, GearPair) else "rack")),
        )


_ROUGHNESS = {"flank_roughness": FLANK_ROUGHNESS, "root_roughness": ROOT_ROUGHNESS}


def _or(values: PerGear[float | None], assumed: float) -> PerGear[float]:
    return values.map(lambda value: assumed if value is None else value)


def _reduced_radius(pair: GearPair | RackPair) -> float:
    """rho_red (mm): of a pinion and a rack that of the pinion's flank."""
    tangent = math.tan(math.radians(pair.working_transverse_pressure_angle))
    if isinstance(pair, RackPair):
        return pair.pinion.base_diameter / 2 * tangent
    return mesh_radius(pair.pinion.base_diameter, pair.wheel.base_diameter, tangent)


def _assumed(given: dict[str, PerGear[float | None]], options: RatingOptions, mate: str) -> Iterator[str]:
    if options.oil_viscosity_40 is None:
        yield f"oil_viscosity_40 = {VISCOSITY:g} mm²/s: oil ISO VG 220"
    for name, roughness in given.items():
        lacking = [gear for gear, value in zip(("pinion", mate), roughness, strict=True) if value is None]
        if lacking:
            yield f"{name} = {_ROUGHNESS[name]:g} µm (Rz) of {' and '.join(lacking)}"
