"""Requirements of a part on its sheet: sizes with limits (mm), roughness and geometrical tolerances (µm).

Where values are not given, those for an accuracy grade are ours, to be verified for each use.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Self

from gearcad.core.errors import ParameterError
from gearcad.core.quantities import is_given
from gearcad.core.records import Notice
from gearcad.drawing.drawing_subjects import DrawnGear, material_text, treatment_text
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.words import SheetWords, Size, as_hole, diameter, half_tolerance, toleranced
from gearcad.geometry import Body, Gear, Rack
from gearcad.geometry.bore_teeth import free_bore
from gearcad.geometry.fits import LARGEST_SIZE, grade_of_class, require_shaft, standard_tolerance
from gearcad.geometry.gear_parts import HALF_PITCH, depth_allowance
from gearcad.rating.options import RatingOptions
from gearcad.rating.tolerances import gear_tolerances


class Roughness(NamedTuple):
    """A roughness: its parameter ("Ra", "Rz"), its largest value (µm), and whether it was given."""

    parameter: str
    value: float
    given: bool = True

    def text(self, number: str) -> str:
        """Return the parameter with its value, which is given as a text in the language of the sheet."""
        return f"{self.parameter} {number}"


_FLANKS = ((4, 0.4), (6, 0.8), (7, 1.6), (8, 3.2))
"""Ra of flanks up to a grade: values of the preferred series that grinding, fine hobbing and hobbing reach."""

_COARSEST = 6.3

_GROUND = 5
"""Last accuracy grade that is not reached without grinding."""

_POSITION, _STEP, _ROUNDING = 0.035, 0.05, 1e-9
"""Position tolerance of bolt holes over their diameter, its step (mm), and the rounding error of the quotient."""

_GROUND_FIT = 6
"""Last grade of ISO 286 to which bores and rims are ground."""


def accuracy_grade_of(drawn: DrawnGear) -> int:
    """Return the accuracy grade of a gear; if none was given, the default grade of ratings."""
    return RatingOptions().accuracy_grade if drawn.grade is None else drawn.grade


def flank_roughness(drawn: DrawnGear) -> Roughness:
    """Return the roughness of the flanks (µm): Rz as given, else Ra by the accuracy grade."""
    given = drawn.gear.flank_roughness if isinstance(drawn.gear, Gear) else None
    if given is not None:
        return Roughness("Rz", given)
    grade = accuracy_grade_of(drawn)
    return Roughness("Ra", next((value for most, value in _FLANKS if grade <= most), _COARSEST), given=False)


def seat_roughness(drawn: DrawnGear, fit: str = "") -> float:
    """Return Ra (µm) of bore, rim and end faces: 0.8 for ground grades and for fits that need grinding, else 1.6."""
    ground = accuracy_grade_of(drawn) <= _GROUND or (bool(fit) and grade_of_class(fit) <= _GROUND_FIT)
    return 0.8 if ground else 1.6


def blank_runout(drawn: DrawnGear) -> float | None:
    """Return the run-out (µm) of tip cylinder and end faces: half of F_r, the run-out of the teeth by ISO 1328, in whole µm
    (ours).

    None for a rack, and where the standard does not cover the teeth.
    """
    if not isinstance(drawn.gear, Gear):
        return None
    try:
        teeth = gear_tolerances(drawn.gear, accuracy_grade_of(drawn), drawn.accuracy).runout
    except ParameterError:
        return None
    return max(float(teeth // 2), 1.0)


def back_parallelism(drawn: DrawnGear, rack: Rack) -> float:
    """Return the parallelism (µm) of a rack's tips to its back: the standard tolerance IT of its grade, 5 to 11, for its
    length.
    """
    grade = min(max(accuracy_grade_of(drawn), 5), 11)
    return standard_tolerance(grade, round(min(rack.length, LARGEST_SIZE), 3))


def hole_position(diameter: float) -> float:
    """Return the position tolerance (µm) of bolt holes: 3.5 % of their diameter (mm) in whole 0.05 mm, at least 0.025 mm. It
    is no more than half the clearance of medium holes (ISO 273).
    """
    return max(math.floor(_POSITION * diameter / _STEP + _ROUNDING) * _STEP, _STEP / 2) * 1000


def cylindricity(diameter: float, fit: str) -> float | None:
    """Return the cylindricity (µm) of a bore or a rim: a quarter of the tolerance of its fit, in whole µm. None without a fit,
    and beyond ISO 286.
    """
    if not fit:
        return None
    try:
        return max(float(standard_tolerance(grade_of_class(fit), diameter) // 4), 1.0)
    except ParameterError:
        return None


_PROPOSED = ("tip_runout", "face_runout", "bore_roughness", "keyway_symmetry", "bolt_position", "back_parallelism")
"""Options whose values are proposed by the program if they are not given."""


@dataclass(frozen=True, kw_only=True)
class Requirements:
    """The requirements of a part: sizes with their limits (mm; None if the part lacks them), roughness Ra or Rz, and
    geometrical tolerances (µm).

    `tip` is the tip diameter, `hub_width` the width of the gear with its hubs. `keyway_depth` is measured across the bore, d +
    t2. `length`, `height` (back to tips) and `reference_height` (back to reference line) are sizes of a rack. `bolts` are the
    bolt holes. `tip_runout`, `face_runout`, `keyway_symmetry` and `bolt_position` are to the datum axis. `cylindricity`
    applies to the datum surface itself: the bore, or the rim of a ring. `back_parallelism` is the parallelism of a rack's tips
    to its back, `back_flatness` the flatness of the back.
    """

    drawn: DrawnGear
    options: DrawingOptions
    face_width: Size
    flanks: Roughness
    bore_roughness: float
    face_roughness: float
    rest_roughness: float
    tip: Size | None = None
    bore: Size | None = None
    keyway_width: Size | None = None
    keyway_depth: Size | None = None
    hub_diameter: Size | None = None
    hub_width: Size | None = None
    rim: Size | None = None
    bolt_circle: Size | None = None
    bolts: Size | None = None
    gap_width: Size | None = None
    gap_diameter: Size | None = None
    end_chamfer: Size | None = None
    tip_chamfer: Size | None = None
    length: Size | None = None
    height: Size | None = None
    reference_height: Size | None = None
    tip_runout: float | None = None
    face_runout: float | None = None
    cylindricity: float | None = None
    keyway_symmetry: float | None = None
    bolt_position: float | None = None
    back_parallelism: float | None = None
    back_flatness: float | None = None

    @classmethod
    def of(cls, drawn: DrawnGear, options: DrawingOptions) -> Self:
        """Return the requirements of a part, with the `options` that hold for it (`DrawingOptions.of_part`).

        Raises ParameterError for the class of a hole at the tips of an external gear.
        """
        part = drawn.gear
        if drawn.spline is not None:
            options = _own_classes(options)
        own: dict[str, Any] = _rack(part) if isinstance(part, Rack) else _gear(part, options)
        of_part = _deviations(drawn, part, options) if isinstance(part, Gear) else _of_back(drawn, part, options)
        deviations: dict[str, Any] = dict(of_part)
        if drawn.spline is not None:
            return cls(
                drawn=drawn,
                options=options,
                face_width=toleranced(part.face_width, options.face_width_tolerance),
                flanks=Roughness("Ra", options.surface_roughness),
                bore_roughness=options.bore_roughness or options.surface_roughness,
                face_roughness=options.surface_roughness,
                rest_roughness=options.surface_roughness,
                **own,
            )
        return cls(
            drawn=drawn,
            options=options,
            face_width=toleranced(part.face_width, options.face_width_tolerance),
            flanks=flank_roughness(drawn),
            bore_roughness=options.bore_roughness or seat_roughness(drawn, _seat_fit(part, options)),
            face_roughness=options.bore_roughness or seat_roughness(drawn),
            rest_roughness=options.surface_roughness,
            **own,
            **deviations,
        )

    def material(self, words: SheetWords) -> str:
        """Return the material as the sheet names it; "" if unknown."""
        return material_text(self.drawn, self.options, words)

    def heat_treatment(self, words: SheetWords) -> str:
        """Return the heat treatment in the words of a language; "" if unknown."""
        return treatment_text(self.drawn, self.options, words)

    def tooth_notes(self, words: SheetWords) -> tuple[str, ...]:
        """Return the notes on facts that have no place in the table.

        These are undercut fillets, the offset direction of a double helical gear's halves, and values that follow from the
        accuracy grade alone.
        """
        part, options = self.drawn.gear, self.options
        by_grade = self.drawn.spline is None and (
            not self.flanks.given
            or any(getattr(self, name) is not None and getattr(options, name, None) is None for name in _PROPOSED)
        )
        turned = isinstance(part, Gear) and abs(part.double_helix.offset) not in (0.0, HALF_PITCH)
        undercut = isinstance(part, Gear) and part.undercut
        noted = {"note_undercut": undercut, "note_offset": turned, "note_by_grade": by_grade}
        return tuple(words[f"data.{key}"] for key, holds in noted.items() if holds)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of sizes whose fits have no limits here, and of run-outs not demanded for want of a datum or a standard."""
        return tuple(self._notices())

    def _notices(self) -> Iterator[Notice]:
        for name, size in vars(self).items():
            if isinstance(size, Size) and size.fit and size.upper is None:
                text = f"{name}: limits of {size.fit} at {size.value:.6g} mm are not tabled here; verify them in ISO 286-2"
                yield Notice("fit-without-limits", text)
            elif isinstance(size, Size) and size.value > LARGEST_SIZE:
                text = f"{name}: {size.value:.6g} mm is beyond ISO 286; general tolerances hold"
                yield Notice("beyond-fits", text)
        if not isinstance(self.drawn.gear, Gear) or self.drawn.spline is not None:
            return
        if _datum(self.drawn.gear) is None:
            name = "rim_diameter" if self.drawn.gear.internal else "bore"
            yield Notice("no-datum", f"run-out: not demanded, as there is no {name} that could be its datum")
        elif None in (self.tip_runout, self.face_runout):
            yield Notice("no-runout", "run-out: none is given, and ISO 1328 has no value for these teeth")


def _own_classes(options: DrawingOptions) -> DrawingOptions:
    """Return the options of a splined part, whose tips and rim have no tolerance class unless another than that of gears is
    given.
    """
    usual = DrawingOptions()
    tip, rim = options.tip_tolerance, options.rim_tolerance
    return replace(
        options,
        tip_tolerance="" if tip == usual.tip_tolerance else tip,
        rim_tolerance="" if rim == usual.rim_tolerance else rim,
    )


def _rack(rack: Rack) -> dict[str, Size]:
    found = {
        "length": Size(value=rack.length),
        "height": Size(value=rack.total_height),
        "reference_height": Size(value=rack.height, reference=True),
    }
    return found | ({"tip_chamfer": _chamfer(rack.tip_chamfer, "45")} if rack.tip_chamfer else {})


def _gear(gear: Gear, options: DrawingOptions) -> dict[str, Size]:
    body, mark = gear.body, options.language.decimal_mark
    found = _ring(gear, options) if gear.internal else _disc(gear, options)
    if body.end_chamfer:
        angle = f"{body.end_chamfer_angle:.4g}".replace(".", mark)
        found["end_chamfer"] = _chamfer(body.end_chamfer, angle, count=4 if gear.double_helix.gap_width else 2)
    if body.tip_chamfer:
        found["tip_chamfer"] = _chamfer(body.tip_chamfer, "45")
    if gear.double_helix.gap_width:
        found["gap_width"] = Size(value=gear.double_helix.gap_width)
        found["gap_diameter"] = _floor(gear)
    return found


def _chamfer(length: float, angle: str, count: int = 1) -> Size:
    return Size(value=length, prefix=f"{count}× " if count > 1 else "", suffix=f"×{angle}°")


def _floor(gear: Gear) -> Size:
    """Return the diameter (mm) of the groove between two halves: as given, else with as few decimals as distinguish it from
    the root circle.
    """
    given, module = is_given(gear.double_helix.gap_diameter), gear.normal_module
    return diameter(gear.gap_diameter, decimals=3 if given or module < 0.1 else 2 if module < 1.0 else 1)


def _disc(gear: Gear, options: DrawingOptions) -> dict[str, Size]:
    """Return the sizes of an external gear by name. Raises ParameterError for a tip diameter with the class of a hole."""
    body = gear.body
    if options.tip_tolerance:
        require_shaft("drawing.tip_tolerance", options.tip_tolerance)
    found = {"tip": diameter(gear.tip_diameter, options.tip_tolerance)}
    if body.bore_spline:
        found["bore"] = _splined_bore(gear, body.bore_spline, options.language.decimal_mark)
    elif body.bore:
        found["bore"] = diameter(body.bore, options.bore_tolerance, envelope=bool(options.bore_tolerance))
    if body.keyway_width:
        found["keyway_width"] = toleranced(body.keyway_width, options.keyway_tolerance)
        found["keyway_depth"] = _keyway_depth(body)
    if body.hub_diameter:
        found["hub_diameter"] = diameter(body.hub_diameter)
        found["hub_width"] = Size(value=gear.face_width + sum(body.hub_ends))
    return found


def _splined_bore(gear: Gear, designation: str, mark: str) -> Size:
    """Return the size of a splined bore: its designation, and the diameters of its roots and tips (mm)."""
    tips = f"{free_bore(gear):.3f}".rstrip("0").rstrip(".")
    from gearcad.geometry.spline_standards import read_designation

    standard = read_designation(designation).standard
    said = designation if designation.startswith(standard[:3]) else f"{standard} {designation}"
    said, tips = said.replace(".", mark), tips.replace(".", mark)
    return Size(value=float(gear.body.bore), prefix=f"{said} (⌀", suffix=f" / ⌀{tips})")


def _keyway_depth(body: Body) -> Size:
    """Return the size d + t2 (mm), which may be larger by the allowance of DIN 6885."""
    across, more = body.bore + body.keyway_depth, depth_allowance(body.keyway_width)
    return Size(value=across) if more is None else Size(value=across, upper=more / 1000, lower=0.0)


def _ring(gear: Gear, options: DrawingOptions) -> dict[str, Size]:
    """Return the sizes of a ring by name."""
    body = gear.body
    found = {"tip": diameter(abs(gear.tip_diameter), as_hole(options.tip_tolerance))}
    if body.rim_diameter is not None:
        found["rim"] = diameter(body.rim_diameter, options.rim_tolerance)
    if body.bolt_holes:
        found["bolt_circle"] = diameter(body.bolt_circle, exact=_datum(gear) is not None)
        found["bolts"] = Size(value=body.bolt_diameter, prefix=f"{body.bolt_holes}×⌀")
    return found


def _datum(gear: Gear) -> float | None:
    """Return the diameter (mm) of the datum surface: the bore, or the rim of a ring; None without one."""
    return gear.body.rim_diameter if gear.internal else gear.body.bore or None


def _seat_fit(part: Gear | Rack, options: DrawingOptions) -> str:
    """Return the tolerance class of the datum surface; "" of a splined bore, whose own class is in its designation."""
    if isinstance(part, Gear) and part.body.bore_spline:
        return ""
    return options.rim_tolerance if isinstance(part, Gear) and part.internal else options.bore_tolerance


def _deviations(drawn: DrawnGear, gear: Gear, options: DrawingOptions) -> dict[str, float | None]:
    """Return the geometrical tolerances (µm) of a gear by name; empty without a datum. Run-outs are as given, else by the
    grade.
    """
    datum = _datum(gear)
    if datum is None:
        return {}
    keyway = toleranced(gear.body.keyway_width, options.keyway_tolerance) if gear.body.keyway_width else None
    return {
        "tip_runout": options.tip_runout or blank_runout(drawn),
        "face_runout": options.face_runout or blank_runout(drawn),
        "cylindricity": cylindricity(datum, _seat_fit(gear, options)),
        "keyway_symmetry": None if keyway is None else options.keyway_symmetry or half_tolerance(keyway),
        "bolt_position": (options.bolt_position or hole_position(gear.body.bolt_diameter)) if gear.body.bolt_holes else None,
    }


def _of_back(drawn: DrawnGear, rack: Rack, options: DrawingOptions) -> dict[str, float | None]:
    """Return the parallelism (µm) of a rack's tips to its back, as given, else by the grade. The flatness of the back (µm) is
    half of it.
    """
    parallelism = options.back_parallelism or back_parallelism(drawn, rack)
    return {"back_parallelism": parallelism, "back_flatness": max(float(parallelism // 2), 1.0)}
