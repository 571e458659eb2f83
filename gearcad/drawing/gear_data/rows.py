"""The rows of the gear data table in the order of DIN 3966-1 and ISO 1340."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.drawing.gear_data.accuracy import grade_row, tolerance_notices, tolerance_rows
from gearcad.drawing.gear_data.flanks import (
    chamfer_rows,
    cutter_rows,
    double_helix_rows,
    material_rows,
    modification_rows,
    roughness_rows,
)
from gearcad.drawing.gear_data.mates import mate_rows
from gearcad.drawing.gear_data.row import Row, RowWriter
from gearcad.drawing.gear_data.teeth import diameter_rows, teeth_rows
from gearcad.drawing.gear_data.thickness import thickness_rows
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.quality import flank_roughness
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.words import Words
from gearcad.geometry import Gear, Rack
from gearcad.notice import Notice

__all__ = ["gear_notices", "gear_rows"]

_SMALL_MODULE = 0.3
"""Below it (mm) lengths have a digit more."""


def gear_rows(drawn: DrawnGear, words: Words, options: DrawingOptions | None = None) -> tuple[Row, ...]:
    """Those of an external gear, a ring, a rack or a double helical gear; every key stands once.

    `options` are those that hold for it (`DrawingOptions.of_part`), in whose words material and heat treatment stand.
    """
    write = RowWriter(words, 4 if drawn.gear.normal_module < _SMALL_MODULE else 3)
    own = _rack(drawn, drawn.gear, write) if isinstance(drawn.gear, Rack) else _gear(drawn, drawn.gear, write)
    return (*own, *material_rows(drawn, write, options or DrawingOptions()))


def _gear(drawn: DrawnGear, gear: Gear, write: RowWriter) -> Iterator[Row]:
    yield from teeth_rows(drawn, write)
    yield from diameter_rows(gear, write)
    yield from double_helix_rows(gear, write)
    yield grade_row(drawn, write)
    yield from thickness_rows(gear, write)
    yield from mate_rows(drawn, write)
    yield from tolerance_rows(drawn, write)
    yield from roughness_rows(drawn, write)
    yield from modification_rows(gear, write)
    yield from cutter_rows(gear, write)
    yield from chamfer_rows(gear, write)


def _rack(drawn: DrawnGear, rack: Rack, write: RowWriter) -> Iterator[Row]:
    yield from teeth_rows(drawn, write)
    yield write.length("normal_pitch", rack.normal_pitch, "p_n")
    if rack.helix_angle:
        yield write.length("transverse_pitch", rack.transverse_pitch, "p_t")
    yield write.length("reference_height", rack.height, "H_0", "height")
    yield write.length("tip_height", rack.tip_height, "h_a")
    yield write.length("root_depth", rack.root_depth, "h_f")
    yield write.length("normal_tooth_thickness", rack.normal_tooth_thickness, "s_n")
    yield write.plain("ball_diameter", rack.pin_diameter, "D_M", name="pin_diameter")
    if rack.over_pin is None:
        yield write.text("over_pin", f"— ({write.word('off_involute')})", "M")
    else:
        yield write.length("over_pin", rack.over_pin, "M")
    yield from mate_rows(drawn, write)
    yield from tolerance_rows(drawn, write)
    yield from roughness_rows(drawn, write)
    yield from chamfer_rows(rack, write)


def gear_notices(drawn: DrawnGear, options: DrawingOptions | None = None) -> tuple[Notice, ...]:
    """What the table assumes, and what it has no numbers for."""
    return tuple(_notices(drawn, options or DrawingOptions()))


def _notices(drawn: DrawnGear, options: DrawingOptions) -> Iterator[Notice]:
    yield from tolerance_notices(drawn)
    if isinstance(drawn.gear, Gear) and drawn.gear.tooth_allowance is None:
        text = (
            "tooth thickness: thickness, span and size over balls have no limits: give tooth_allowance in the table of the "
            'gear (such as "cd25" in [pinion])'
        )
        yield Notice("no-thickness-limits", text)
    if not flank_roughness(drawn).given:
        text = "roughness of the flanks: flank_roughness is not given; the Ra by the accuracy grade is ours, verify it"
        yield Notice("roughness-of-grade", text)
    if not options.material and (drawn.material is None or options.material == ""):
        yield Notice("no-material", "material: none is given")
