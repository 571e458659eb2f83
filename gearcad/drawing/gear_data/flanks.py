"""What is done to flanks: roughness, modifications, material, and the tool of a shaped gear."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.drawing.gear_data.row import Row, RowWriter
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.quality import flank_roughness
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.treatment import material_text, treatment_text
from gearcad.geometry import FlankModification, Gear, Rack, ReliefShape
from gearcad.geometry.double_helix import HALF_PITCH
from gearcad.geometry.modification import TransitionSource
from gearcad.geometry.tooling import corner_radius, shaped
from gearcad.schema import symbols_of

__all__ = ["chamfer_rows", "cutter_rows", "double_helix_rows", "material_rows", "modification_rows", "roughness_rows"]

_SYMBOLS = symbols_of(FlankModification)


def roughness_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[Row]:
    """Of flanks, and of roots where it is given."""
    flanks = flank_roughness(drawn)
    text = f"{flanks.text(write.words.shortest(flanks.value, 2))} µm"
    name = "flank_roughness" if flanks.given else "flank_roughness_of_grade"
    yield write.text("flank_roughness", text, "", {name: flanks.value})
    if isinstance(drawn.gear, Gear) and (root := drawn.gear.root_roughness) is not None:
        yield write.text("root_roughness", f"Rz {write.words.shortest(root, 2)} µm", "", {"root_roughness": root})


def modification_rows(gear: Gear, write: RowWriter) -> Iterator[Row]:
    """The amount of each, the length of a relief and its transition; where there are some, that they stand in a diagram."""
    used, transitions = gear.modification.in_use, gear.flank_form.transitions
    for name in (name for name in used if not name.endswith(("_length", "_shape", "_transition"))):
        text, numbers = f"{write.words.shortest(used[name], 2)} µm", {f"modification.{name}": used[name]}
        if (length := used.get(f"{name}_length")) is not None:
            text += f" / {write.words.shortest(length, 3)} mm"
            numbers[f"modification.{name}_length"] = length
            if used[f"{name}_shape"] == ReliefShape.PARABOLIC.value:
                text += f", {write.word('parabolic')}"
        yield write.text(name, text, _SYMBOLS[name].symbol, numbers)
        if (transition := transitions.get(name)) is not None:
            text = f"{write.words.shortest(transition.length, 3)} mm"
            if transition.source is not TransitionSource.GIVEN:
                text += f" ({write.word(transition.source.value)})"
            yield write.text(f"{name}_transition", text, "t", {f"modification.{name}_transition": transition.length})
    if used:
        yield write.text("modifications", write.word("see_diagram"))


def cutter_rows(gear: Gear, write: RowWriter) -> Iterator[Row]:
    """The corner that makes the fillets of a shaped gear or a ring, and the shaper cutter where one does."""
    cutter = gear.cutter
    if shaped(gear):
        yield write.length("corner_radius", corner_radius(gear) * gear.normal_module, "ρ_a0")
    if cutter.teeth is None or gear.cutter_tip_diameter is None:
        return
    yield write.text("cutter_teeth", str(cutter.teeth), "z_0", {"cutter.teeth": cutter.teeth})
    shift = write.words.number(cutter.profile_shift, 4, signed=True)
    yield write.text("cutter_profile_shift", shift, "x_0", {"cutter.profile_shift": cutter.profile_shift})
    yield write.length("cutter_tip_diameter", gear.cutter_tip_diameter, "d_a0")


def chamfer_rows(part: Gear | Rack, write: RowWriter) -> Iterator[Row]:
    """The chamfer along the tip edges of every tooth."""
    name, height = ("tip_chamfer", part.tip_chamfer) if isinstance(part, Rack) else ("body.tip_chamfer", part.body.tip_chamfer)
    if height:
        yield write.text("tip_chamfer", f"{write.words.shortest(height)} × 45°", "h_K", {name: height})


def double_helix_rows(gear: Gear, write: RowWriter) -> Iterator[Row]:
    """How the teeth of the left half in the section stand to those of the right one, counter-clockwise as seen from the left.

    That is the upper half as seen from beyond it, or the lower one, which is as far behind, as seen from below: the same.
    Half a pitch is alike in both directions.
    """
    if offset := gear.double_helix.offset:
        half = abs(offset) == HALF_PITCH
        shown = write.words.number(HALF_PITCH if half else offset, 4, signed=not half)
        yield write.text("half_offset", shown, "", {"double_helix.offset": offset})


def material_rows(drawn: DrawnGear, write: RowWriter, options: DrawingOptions) -> Iterator[Row]:
    """What it is made of and how it is hardened, as far as anybody said."""
    for key, text in (
        ("material", material_text(drawn, options, write.words)),
        ("heat_treatment", treatment_text(drawn, options, write.words)),
    ):
        if text:
            yield write.text(key, text)
