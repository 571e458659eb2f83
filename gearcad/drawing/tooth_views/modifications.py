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


def modification_figures(drawn: DrawnGear, draughting: Draughting) -> tuple[Figure, ...]:
    """That of the profile and that along the face, each where there is something to show; none of a rack.

    That along the face lies as the section of the gear does; both say from which end z is counted.
    """
    gear, words = drawn.gear, draughting.words
    if not isinstance(gear, Gear):
        return ()
    figures = []
    if (profile := profile_depths(gear)) is not None:
        notes = tuple(_notes(gear, profile, drawn.direction, words))
        figures.append(depth_diagram(words["rings.profile_diagram"], "L", profile, notes, draughting))
    if (helix := helix_depths(gear)) is not None:
        notes = tuple(_notes(gear, helix, drawn.direction, words))
        lying = helix if gear.double_helix.present or drawn.direction > 0 else helix.turned
        figures.append(depth_diagram(words["rings.helix_diagram"], "z", lying, notes, draughting))
    return tuple(figures)


def _notes(gear: Gear, depths: Depths, direction: int, words: Words) -> Iterator[str]:
    """What signs mean, and where it matters where z begins and how flanks are looked at."""
    yield words["rings.depth_sign"]
    near, far = ("left", "right") if direction > 0 else ("right", "left")
    several = len(depths.series) > 1
    if several or depths.diameters is None:
        yield words["rings.z_of_halves" if gear.double_helix.present else f"rings.z_from_{near}"]
    if any(each.key.startswith("flank_") for each in depths.series):
        yield words[f"rings.flanks_from_{far}"]
