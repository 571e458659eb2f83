"""Diagrams of the flank modifications of a gear: of its profile, and along its face (ISO 21771). Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.drawing.shapes import Figure
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.tooth_views.depths import Depths, helix_depths, profile_depths
from gearcad.drawing.tooth_views.diagram import depth_diagram
from gearcad.drawing.words import Draughting, Words
from gearcad.geometry import Gear

__all__ = ["modification_figures"]


def modification_figures(drawn: DrawnGear, draughting: Draughting, direction: int = 1) -> tuple[Figure, ...]:
    """That of the profile and that along the face, each where there is something to show; none of a rack.

    `direction` is 1 where z goes to the right in the section of the gear, -1 to the left: the diagrams say from which end.
    """
    gear, words = drawn.gear, draughting.words
    if not isinstance(gear, Gear):
        return ()
    figures = []
    if (profile := profile_depths(gear)) is not None:
        notes = tuple(_notes(gear, profile, direction, words))
        figures.append(depth_diagram(words["rings.profile_diagram"], "L", profile, notes, draughting))
    if (helix := helix_depths(gear)) is not None:
        notes = tuple(_notes(gear, helix, direction, words))
        figures.append(depth_diagram(words["rings.helix_diagram"], "z", helix, notes, draughting))
    return tuple(figures)


def _notes(gear: Gear, depths: Depths, direction: int, words: Words) -> Iterator[str]:
    """Where z begins and how flanks are looked at, where it matters."""
    near, far = ("left", "right") if direction > 0 else ("right", "left")
    several = len(depths.series) > 1
    if gear.double_helix.present:
        if several or depths.diameters is None:
            yield words["rings.z_of_halves"]
    elif several:
        yield words[f"rings.z_from_{near}"]
    if any(each.key.startswith("flank_") for each in depths.series):
        yield words[f"rings.flanks_from_{far}"]
