"""The half section of an external gear through its axis, in mm of the part: heights z along the axis, and radii.

As ISO 2203 sees a gear: a solid body up to the tip circle, or where it is cut up to the root circle, with no teeth on it.
"""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.geometry import Gear
from gearcad.solids.cone import EndCone

__all__ = ["Corner", "along_strip", "contour", "edges", "opening_radius", "overall", "root_lines", "strips"]

Corner = tuple[float, float]
"""Height z and radius."""


def overall(gear: Gear) -> tuple[float, float]:
    """Heights of the outermost end faces, those of hubs if there are any."""
    back, front = gear.body.hub_ends
    return -back, gear.face_width + front


def strips(gear: Gear) -> tuple[tuple[float, float], ...]:
    """From where to where there are teeth: twice if a gap parts the halves of a double helical gear, an apex parts nothing."""
    width, half = gear.face_width, gear.half_width
    return ((0.0, half), (width - half, width)) if gear.double_helix.gap_width else ((0.0, width),)


def opening_radius(gear: Gear) -> float:
    """How far bore and keyway open the half plane in which the keyway lies; 0 without a bore."""
    return gear.body.bore / 2 + (gear.body.keyway_depth if gear.body.keyway_width else 0.0)


def contour(gear: Gear, top: float, inner: float) -> list[Corner]:
    """From radius `inner` up the lower end face, along the teeth at radius `top`, and down the upper end face to `inner`."""
    low, high = overall(gear)
    hub, width = gear.body.hub_diameter / 2, gear.face_width
    back = [(low, inner), (low, hub), (0.0, hub)] if low < 0 else [(0.0, inner)]
    front = [(width, hub), (high, hub), (high, inner)] if high > width else [(width, inner)]
    return [*back, *_along_teeth(gear, top), *front]


def _along_teeth(gear: Gear, top: float) -> Iterator[Corner]:
    """Along the teeth, and the groove between two strips of them."""
    floor, before = gear.gap_diameter / 2, None
    for low, high in strips(gear):
        if before is not None:
            yield from ((before, floor), (low, floor))
        yield from along_strip(gear, low, high, top)
        before = high


def along_strip(gear: Gear, low: float, high: float, top: float) -> list[Corner]:
    """Along the teeth at radius `top` from `low` to `high`, one of their `strips`, and their end chamfers."""
    cone = EndCone.of(gear)
    back = float(cone.setback(top))
    flat = [(low + back, top), (high - back, top)]
    return [(low, cone.face_radius), *flat, (high, cone.face_radius)] if back else flat


def root_lines(gear: Gear) -> list[tuple[float, float]]:
    """From where to where teeth have a root that is seen in a section: a chamfer that is deeper than they are cuts it off."""
    back = float(EndCone.of(gear).setback(gear.root_diameter / 2))
    return [(low + back, high - back) for low, high in strips(gear)]


def edges(gear: Gear) -> list[Corner]:
    """Edges round the axis between the outermost end faces, as one sees them from outside: height, and largest radius there."""
    corners = contour(gear, gear.tip_diameter / 2, 0.0)
    largest = {z: max(radius for each, radius in corners if each == z) for z in sorted({z for z, _ in corners})}
    return list(largest.items())[1:-1]
