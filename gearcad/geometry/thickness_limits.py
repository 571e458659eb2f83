"""ThicknessLimits: what gauges may find on teeth whose thickness has allowances. Lengths in mm."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

from gearcad.errors import GeometryError
from gearcad.geometry.inspection import Inspection
from gearcad.geometry.profile import base_half_angle
from gearcad.geometry.tooth_allowance import ToothAllowance

__all__ = ["Limits", "ThicknessLimits"]


class Limits(NamedTuple):
    """The least and the greatest of a dimension (mm)."""

    least: float
    greatest: float


@dataclass(frozen=True, kw_only=True)
class ThicknessLimits:
    """The dimensions (mm) between which teeth are good, by the gauges of the gear itself; None for those that do not fit it."""

    allowance: ToothAllowance
    normal_tooth_thickness: Limits
    span_measurement: Limits | None
    over_balls: Limits | None
    over_pins: Limits | None
    between_balls: Limits | None
    between_pins: Limits | None

    @classmethod
    def of(cls, inspection: Inspection, allowance: ToothAllowance) -> ThicknessLimits:
        """Those of a gear whose `inspection` is that of teeth in the middle of their allowances."""
        half, internal = allowance.tolerance / 2000, inspection.teeth < 0
        extremes = tuple(_with_thickness(inspection, inspection.normal_tooth_thickness + each) for each in (-half, half))
        count, ball = inspection.spanned, inspection.ball_diameter

        def limits(measure: Callable[[Inspection], float], measured: bool) -> Limits | None:
            """Thick teeth make spans larger, those over the spaces of a ring smaller."""
            with suppress(GeometryError):  # a ball that falls to the base circle of thin teeth measures nothing
                return Limits(*sorted(map(measure, extremes))) if measured else None
            return None

        return cls(
            allowance=allowance,
            normal_tooth_thickness=Limits(*(each.normal_tooth_thickness for each in extremes)),
            span_measurement=limits(lambda gauge: gauge.span_measurement(count or 1), count is not None),
            over_balls=limits(lambda gauge: gauge.over_balls(ball), not internal),
            over_pins=limits(lambda gauge: gauge.over_pins(ball), not internal),
            between_balls=limits(lambda gauge: gauge.between_balls(ball), internal),
            between_pins=limits(lambda gauge: gauge.between_balls(ball), internal and not inspection.helix_angle),
        )

    def to_dict(self) -> dict[str, float]:
        """A_sne and A_sni in µm, and the limits of each gauge that fits, in mm: `over_balls_least`."""
        allowances = {"allowance_upper": self.allowance.upper, "allowance_lower": self.allowance.lower}
        for each in fields(self):
            if isinstance(limits := getattr(self, each.name), Limits):
                allowances |= {f"{each.name}_{side}": value for side, value in limits._asdict().items()}
        return allowances


def _with_thickness(inspection: Inspection, thickness: float) -> Inspection:
    half_angle = base_half_angle(inspection.teeth, thickness, inspection.normal_module, inspection.transverse_pressure_angle)
    return replace(inspection, normal_tooth_thickness=thickness, base_half_angle=half_angle)
