"""The solid of a carrier of planets."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.solids.carrier_plan import CarrierPlan

if TYPE_CHECKING:
    import cadquery

__all__ = ["carrier_solid"]


def carrier_solid(plan: CarrierPlan) -> cadquery.Solid:
    """Plates and pins as one solid."""
    import cadquery

    (low, high), body = plan.reach, cadquery.Workplane("XY")
    for bottom, top in plan.plates:
        plate = cadquery.Workplane("XY", origin=(0, 0, bottom)).circle(plan.outer)
        if plan.inner:
            plate = plate.circle(plan.inner)
        body = body.add(plate.extrude(top - bottom))
    pins = cadquery.Workplane("XY", origin=(0, 0, low)).pushPoints(plan.pins).circle(plan.diameter / 2).extrude(high - low)
    solid = body.union(pins).val()
    assert isinstance(solid, cadquery.Shape)
    return solid.Solids()[0]
