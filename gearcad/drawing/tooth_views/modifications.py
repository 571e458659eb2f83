"""Diagrams of the flank modifications of a gear: of its profile, and along its face (ISO 21771). Lengths in mm of paper."""

from __future__ import annotations

from gearcad.drawing.shapes import Figure
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.tooth_views.depths import Depths, helix_depths, profile_depths
from gearcad.drawing.tooth_views.diagram import depth_diagram
from gearcad.drawing.words import Draughting, Words
from gearcad.geometry import FlankModification, Gear
from gearcad.schema import symbols_of

__all__ = ["modification_figures"]

_SYMBOLS = symbols_of(FlankModification)

_OF_PROFILE = ("tip_relief", "root_relief", "profile_crowning", "pressure_angle_modification", "twist")
_ALONG_FACE = ("lead_crowning", "end_relief", "helix_angle_modification")


def modification_figures(drawn: DrawnGear, draughting: Draughting, direction: int = 1) -> tuple[Figure, ...]:
    """That of the profile and that along the face, each where there is something to show; none of a rack.

    `direction` is 1 where z goes to the right in the section of the gear, -1 to the left: the diagrams say from which end.
    """
    gear, words = drawn.gear, draughting.words
    if not isinstance(gear, Gear):
        return ()
    figures = []
    if (profile := profile_depths(gear)) is not None:
        legend = _legend(gear, _OF_PROFILE, words) + _ends(profile, direction, words)
        figures.append(depth_diagram(words["rings.profile_diagram"], "L_y", profile, legend, draughting))
    if (helix := helix_depths(gear)) is not None:
        title = words["rings.halves_diagram" if gear.double_helix.present else "rings.helix_diagram"]
        legend = _legend(gear, _ALONG_FACE, words) + _ends(helix, direction, words)
        figures.append(depth_diagram(title, "z", helix, legend, draughting))
    return tuple(figures)


def _legend(gear: Gear, names: tuple[str, ...], words: Words) -> list[str]:
    """A line for each in use: symbol, amount, length, shape."""
    used, lines = gear.modification.in_use, []
    for name in (name for name in names if name in used):
        line = f"{_SYMBOLS[name].symbol} = {words.shortest(used[name], 2)} µm"
        if (length := used.get(f"{name}_length")) is not None:
            shape = words[f"rings.{used[f'{name}_shape']}"]
            line += f", {_SYMBOLS[f'{name}_length'].symbol} = {words.shortest(length, 3)} mm, {shape}"
        lines.append(line)
    return lines


def _ends(depths: Depths, direction: int, words: Words) -> list[str]:
    """Where z begins and how flanks are looked at, where it is not all alike."""
    if len(depths.series) == 1:
        return []
    flanks = any(each.key.startswith("flank_") for each in depths.series)
    near, far = ("left", "right") if direction > 0 else ("right", "left")
    return [words[f"rings.z_from_{near}"], *([words[f"rings.flanks_from_{far}"]] if flanks else [])]
