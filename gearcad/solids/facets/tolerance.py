"""How coarse triangles may be: the chord error that was asked for, as angles, distances and deviations of edges."""

from __future__ import annotations

import math

from gearcad.geometry import Gear

__all__ = ["HELIX_SHARE", "aim_for", "arc_step", "least_distance", "outermost_radius"]

_CONVEX = 0.75
"""Share of the chord error for the edges on modified flanks: a triangle on a convex place deviates up to 4/3 as much inside."""


HELIX_SHARE = 0.6
"""Share of the chord error that layers use up on helical rings: on their fillets the bend of the profile adds to it."""


def outermost_radius(gear: Gear) -> float:
    """Radius (mm) of the circle that the toothed side reaches out to: the tips, on a ring the roots."""
    return max(gear.profile.tip_diameter, gear.profile.root_diameter) / 2


def arc_step(radius: float, chord_error: float) -> float:
    """Largest angle (rad) that a chord of a circle may span within `chord_error` (mm)."""
    return 2 * math.acos(max(1 - chord_error / radius, 0.5))


def least_distance(gear: Gear, chord_error: float) -> float:
    """Distance (mm) below which two points are made one: nothing against the chord error, or two steps of a float32."""
    return max(1e-3 * chord_error, 3e-7 * outermost_radius(gear))


def aim_for(gear: Gear, chord_error: float) -> float:
    """Largest deviation (mm) of an edge that keeps a gear's triangles within `chord_error` (mm)."""
    return _CONVEX * chord_error if gear.modification.present else chord_error
