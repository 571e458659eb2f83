"""A plain carrier for planets with bores: pins through them, between two plates beyond everything that turns there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain

from gearcad.errors import GeometryError
from gearcad.solids.train_layout import TrainLayout
from gearcad.solids.train_room import Sweep, overlap, sweeps

__all__ = ["CarrierPlan", "carrier_plan"]

_RIM, _THICKNESS, _GAP = 0.6, 0.5, 0.1
"""Of a plate beside the pins, its thickness, and the gap between it and what turns, as shares of the pin's diameter."""

_Extent = tuple[float, float]


@dataclass(frozen=True)
class CarrierPlan:
    """Pins of one `diameter` about the axes `pins` (x, y), over the heights `reach`, and the plates they stand in (mm).

    The plates are rings from `inner` to `outer` radius; `plates` has the heights between which each lies, one or two.
    """

    pins: tuple[tuple[float, float], ...]
    diameter: float
    inner: float
    outer: float
    reach: _Extent
    plates: tuple[_Extent, ...]

    def lifted(self, by: float) -> CarrierPlan:
        """The same, higher by so much (mm)."""
        low, high = self.reach
        return replace(self, reach=(low + by, high + by), plates=tuple((bottom + by, top + by) for bottom, top in self.plates))


def carrier_plan(layout: TrainLayout) -> CarrierPlan:
    """The carrier of a train in mesh; a plate for which a stage leaves no room is left out.

    Raises GeometryError for planets without bores, and where there is room for no plate.
    """
    rims = layout.planets[0]
    for rim in rims:
        if not rim.body.gear.body.bore:
            permitted = "must be above 0 mm: the pins of the carrier go through it"
            raise GeometryError(f"{rim.body.key}.body.bore", 0.0, permitted, "mm")
    bore, given = min(rim.body.gear.body.bore for rim in rims), layout.train.carrier.pin_diameter
    if given is not None and given > bore:
        raise GeometryError("carrier.pin_diameter", given, f"must be at most {bore:g} mm, the bore of the planets", "mm")
    diameter = bore if given is None else given
    distance, half = float(layout.train.centre_distance), (0.5 + _RIM) * diameter
    radii = max(distance - half, 0.0), distance + half
    extents = [each.extent for each in chain(layout.centrals, rims)]
    low, high = min(low for low, _ in extents), max(high for _, high in extents)
    gap, thickness = _GAP * diameter, _THICKNESS * diameter
    sides = ((low - gap - thickness, low - gap), (high + gap, high + gap + thickness))
    stages = [sweep for each in layout.stages for sweep in sweeps(each)]
    plates = tuple(_free(sides, radii, ((low - gap, low), (high, high + gap)), stages))
    if not plates:
        words = ", ".join(f"{bottom:.6g} to {top:.6g}" for bottom, top in sides)
        permitted = f"must be left out: the stages are where its plates would be, at heights of {words} mm"
        raise GeometryError("carrier", True, permitted)
    ends = [end for plate in plates for end in plate]
    pins = [rim.extent for rim in rims]
    reach = min(*ends, *(low for low, _ in pins)), max(*ends, *(high for _, high in pins))
    return CarrierPlan(tuple((planet.x, planet.y) for planet in layout.pose.planets), diameter, *radii, reach, plates)


def _free(sides: tuple[_Extent, ...], radii: _Extent, gaps: tuple[_Extent, ...], stages: list[Sweep]) -> Iterator[_Extent]:
    """The plates in whose way, and in whose pins' way, nothing stands."""
    for plate, gap in zip(sides, gaps, strict=True):
        reach = min(*plate, *gap), max(*plate, *gap)
        if not any(overlap(reach, sweep.heights) and overlap(radii, sweep.about_the_train()) for sweep in stages):
            yield plate
