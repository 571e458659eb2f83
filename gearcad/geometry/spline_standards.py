"""Involute splines by DIN 5480, ISO 4156 and ANSI B92.1: proportions, fits, tolerances, and designations.

Lengths in mm, angles in degrees, deviations in µm. Sizes of hubs are positive here, as those of shafts, and both have the
profile shift of the shaft. Editions: DIN 5480-1:2006, ISO 4156-1:2005, ANSI B92.1-1970 (R1993).
"""

from __future__ import annotations

import math
import re
from bisect import bisect_left
from collections.abc import Mapping
from typing import NamedTuple

from gearcad.core.errors import GeometryError, ParameterError, format_number
from gearcad.core.units import module_of_pitch
from gearcad.geometry.fits import limit_deviations

DIN5480, ISO4156, B92_1 = "DIN 5480", "ISO 4156", "ANSI B92.1"
STANDARDS = (DIN5480, ISO4156, B92_1)

EDITIONS = {DIN5480: "DIN 5480-1:2006-03", ISO4156: "ISO 4156-1:2005", B92_1: "ANSI B92.1-1970 (R1993)"}
"""Editions whose figures are used."""

MODULES = {
    DIN5480: (0.5, 0.6, 0.75, 0.8, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0),
    ISO4156: (0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0),
}
"""Modules of the series (mm); others are permitted."""

PITCHES = (2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 24.0, 32.0, 40.0, 48.0, 64.0, 80.0, 128.0)
"""Diametral pitches P (1/inch) of ANSI B92.1; the depth of the teeth follows from P_s = 2 P."""

ANGLES = {DIN5480: (30.0,), ISO4156: (30.0, 37.5, 45.0), B92_1: (30.0, 37.5, 45.0)}
"""Pressure angles (degrees)."""

ROOTS = {DIN5480: ("hobbed", "rolled", "broached"), ISO4156: ("flat", "fillet"), B92_1: ("flat", "fillet")}
"""Words for the root of a part; the first is what a shaft has unless another is given."""

HUB, SHAFT = "hub", "shaft"


class Proportions(NamedTuple):
    """Form of one part in modules, added to the number of teeth: D_tip = m (z + tip), D_root = m (z + root).

    `form` bounds the circle at which the involute ends, before the form clearance is taken off or added; `radius` is that of
    the root's fillet.
    """

    tip: float
    root: float
    radius: float
    form: float


_ISO = {
    (SHAFT, 30.0, "flat"): Proportions(1.0, -1.5, 0.2, math.nan),
    (SHAFT, 30.0, "fillet"): Proportions(1.0, -1.8, 0.4, math.nan),
    (SHAFT, 37.5, "fillet"): Proportions(0.9, -1.4, 0.3, math.nan),
    (SHAFT, 45.0, "fillet"): Proportions(0.8, -1.2, 0.25, math.nan),
    (HUB, 30.0, "flat"): Proportions(math.nan, 1.5, 0.2, 1.0),
    (HUB, 30.0, "fillet"): Proportions(math.nan, 1.8, 0.4, 1.0),
    (HUB, 37.5, "fillet"): Proportions(math.nan, 1.4, 0.3, 0.9),
    (HUB, 45.0, "fillet"): Proportions(math.nan, 1.2, 0.25, 0.8),
}
"""ISO 4156: the tip of the hub and the form circle of the shaft follow from h_s."""

_ISO_FORM_TOOTH = {30.0: 0.6, 37.5: 0.55, 45.0: 0.5}
"""h_s/m of ISO 4156."""

_B92 = {
    (SHAFT, 30.0, "flat"): Proportions(1.0, -1.35, 0.2, -1.0),
    (SHAFT, 30.0, "fillet"): Proportions(1.0, -1.8, 0.4, -1.0),
    (SHAFT, 37.5, "fillet"): Proportions(1.0, -1.3, 0.3, -0.8),
    (SHAFT, 45.0, "fillet"): Proportions(1.0, -1.0, 0.25, -0.6),
    (HUB, 30.0, "flat"): Proportions(-1.0, 1.35, 0.2, 1.0),
    (HUB, 30.0, "fillet"): Proportions(-1.0, 1.8, 0.4, 1.0),
    (HUB, 37.5, "fillet"): Proportions(-0.8, 1.6, 0.3, 1.0),
    (HUB, 45.0, "fillet"): Proportions(-0.6, 1.4, 0.25, 1.0),
}
"""ANSI B92.1, in 1/P. The radii are those of ISO 4156: B92.1 states none for the tool."""

_FINE_PITCH = 12.0
"""Diametral pitch above which the root of a 30 degree fillet shaft is (N - 2)/P."""

_COARSEST_45 = 10.0
"""Least diametral pitch of 45 degree splines of ANSI B92.1."""

_MAJOR_FIT = Proportions(-1.0, 1.0, 0.2, 0.8)
"""Hub of ANSI B92.1 that is centred by its major diameter."""


def proportions(standard: str, part: str, angle: float, root: str, *, pitch: float, major_fit: bool) -> Proportions:
    """Return the proportions of a part by ISO 4156 or ANSI B92.1; `pitch` is in 1/inch. Raises GeometryError."""
    table = _ISO if standard == ISO4156 else _B92
    found = table.get((part, angle, root))
    if found is None:
        raise GeometryError("root", root, f'must be "fillet" at a pressure angle of {angle:g} deg ({standard})')
    if standard == ISO4156:
        return found
    if angle == 45.0 and part == SHAFT and pitch < _COARSEST_45:
        raise GeometryError("diametral_pitch", pitch, "must be at least 10/inch for 45 deg splines of ANSI B92.1", "1/inch")
    if major_fit and part == HUB:
        if (angle, root) != (30.0, "flat"):
            raise GeometryError("centring", "major", "needs a pressure angle of 30 deg and flat roots in ANSI B92.1")
        return _MAJOR_FIT
    if part == SHAFT and angle == 30.0 and root == "fillet" and pitch > _FINE_PITCH:
        return found._replace(root=-2.0)
    return found


def form_tooth_height(angle: float, module: float) -> float:
    """Return h_s (mm) of ISO 4156."""
    return _ISO_FORM_TOOTH[angle] * module


def basic_thickness(standard: str, angle: float, module: float) -> float:
    """Return the basic tooth thickness of splines without a profile shift (mm): pi m/2, in ANSI B92.1 more above 30 deg."""
    more = {37.5: 0.1, 45.0: 0.2}.get(angle, 0.0) if standard == B92_1 else 0.0
    return module * (math.pi / 2 + more)


_DIN_FORM_CLEARANCE = {3.0: 45.0}
"""Form clearance c_F (µm) of DIN 5480 by module: that of the one printed example. Others were not found."""

_B92_FORM_CLEARANCE = (0.002 * 25.4, 0.010 * 25.4)


def form_clearance(standard: str, module: float, reference_diameter: float) -> float | None:
    """Return the form clearance c_F (mm) between a tip and the mate's form circle; None where the standard's is not known."""
    if standard == ISO4156:
        return 0.1 * module
    if standard == B92_1:
        least, most = _B92_FORM_CLEARANCE
        return min(max(0.001 * reference_diameter, least), most)
    found = _DIN_FORM_CLEARANCE.get(module)
    return None if found is None else found / 1000


# ---------------------------------------------------------------------- fits


class SplineFit(NamedTuple):
    """Tolerance class of a part: letter of the fundamental deviation, "" in ANSI B92.1, and grade."""

    letter: str
    grade: int

    def __str__(self) -> str:
        return f"{self.grade}{self.letter}"


class SplineTolerances(NamedTuple):
    """Tolerances (µm): of the actual size, T_act, and what form and pitch deviations take, T_eff; None where it is unknown."""

    actual: float | None
    effective: float | None


_DIN_UP_TO = (12, 25, 50, 100, 200, 400)
_DIN_LADDER = (90, 100, 110, 125, 140, 160)
"""Steps (µm) of the deviations of DIN 5480 by d_B."""

_DIN_SHAFT = {
    **{"v": 1.0, "u": 0.9, "t": 0.8, "s": 0.7, "r": 0.6, "p": 0.5, "n": 0.4, "m": 0.3, "k": 0.2, "js": 0.1, "h": 0.0},
    **{"g": -0.1, "f": -0.2, "e": -0.3, "d": -0.4, "c": -0.6, "b": -0.8, "a": -1.0},
}
"""Deviation A_s of the thickness of a shaft's teeth, in steps."""

_DIN_HUB = {"F": "k", "G": "js", "H": "h", "J": "g", "K": "f", "M": "e"}
"""Hubs, by the shaft whose deviation theirs is."""

_DIN_TOLERANCES = {6: (18.0, 10.0, 1), 7: (25.0, 15.0, 1), 8: (40.0, 23.0, 2), 9: (56.0, 34.0, 2)}
"""T_act and T_eff (µm) of DIN 5480 that printed examples confirm, by grade: for d_B of 50 to 100 (1) or 100 to 200 mm (2) and
modules of 1.75 to 4 mm. The rest of its table 7 was not found.
"""

_DIN_RANGES = {1: (50.0, 100.0), 2: (100.0, 200.0)}
_DIN_MODULES = (1.75, 4.0)
_GRADES = {DIN5480: (5, 12), ISO4156: (4, 7), B92_1: (4, 7)}
_LETTERS = {
    (DIN5480, SHAFT): tuple(_DIN_SHAFT),
    (DIN5480, HUB): tuple(_DIN_HUB),
    (ISO4156, SHAFT): ("d", "e", "f", "h", "js", "k"),
    (ISO4156, HUB): ("H",),
    (B92_1, SHAFT): ("",),
    (B92_1, HUB): ("",),
}
_FIT = re.compile(r"\s*(\d{1,2})\s*([A-Za-z]{0,2})\s*")


def read_fit(standard: str, part: str, text: str) -> SplineFit:
    """Return the tolerance class that a text names, such as "9H". Raises ParameterError."""
    found, letters, (least, most) = _FIT.fullmatch(text), _LETTERS[standard, part], _GRADES[standard]
    if found and found[2] in letters and least <= int(found[1]) <= most:
        return SplineFit(found[2], int(found[1]))
    example = {"": f'as in "{least + 1}"'}.get(letters[0], f"and {'one of ' if len(letters) > 1 else ''}{', '.join(letters)}")
    raise ParameterError("fit", text, f"must be a grade from {least} to {most} {example} ({standard}, {part})")


def deviation(standard: str, part: str, fit: SplineFit, diameter: float, tolerances: SplineTolerances) -> float:
    """Return the fundamental deviation (µm) of the effective tooth thickness (shaft) or space width (hub).

    `diameter` (mm) is d_B in DIN 5480 and d in ISO 4156, whose js and k follow from the tolerances. Raises GeometryError.
    """
    if standard == B92_1 or fit.letter in ("h", "H"):
        return 0.0
    if standard == ISO4156:
        return _iso_deviation(fit, diameter, tolerances)
    if diameter > _DIN_UP_TO[-1]:
        permitted = f"must be at most {_DIN_UP_TO[-1]} mm for the deviations of DIN 5480"
        raise GeometryError("nominal_diameter", diameter, permitted, "mm")
    letter = _DIN_HUB[fit.letter] if part == HUB else fit.letter
    return float(
        math.trunc(
            _DIN_SHAFT[letter] * _DIN_LADDER[bisect_left(_DIN_UP_TO, diameter)] + math.copysign(1e-9, _DIN_SHAFT[letter])
        )
    )


def _iso_deviation(fit: SplineFit, diameter: float, tolerances: SplineTolerances) -> float:
    """es_v (µm) of a shaft: that of ISO 286 for d, e, f; T + lambda for k, half of it for js."""
    if fit.letter in ("js", "k"):
        total = (tolerances.actual or 0.0) + (tolerances.effective or 0.0)
        return total if fit.letter == "k" else total / 2
    return limit_deviations(f"{fit.letter}{fit.grade}", diameter).upper


_ISO_TOTAL = {4: (10.0, 40.0), 5: (16.0, 64.0), 6: (25.0, 100.0), 7: (40.0, 160.0)}
_ISO_PITCH = {4: (2.5, 6.3), 5: (3.55, 9.0), 6: (5.0, 12.5), 7: (7.1, 18.0)}
_ISO_FORM = {4: (1.6, 10.0), 5: (2.5, 16.0), 6: (4.0, 25.0), 7: (6.3, 40.0)}
_ISO_HELIX = {4: (0.8, 4.0), 5: (1.0, 5.0), 6: (1.25, 6.3), 7: (2.0, 10.0)}
"""Factors of ISO 4156-1 by grade: of T + lambda, F_p, f_f and F_beta."""


def tolerances_of(
    standard: str, fit: SplineFit, *, module: float, teeth: int, diameter: float, thickness: float, length: float
) -> SplineTolerances:
    """Return the tolerances of a part (µm): by the formulas of ISO 4156, in DIN 5480 where a printed value is known."""
    if standard == ISO4156:
        total, effective = _iso_total(fit.grade, diameter, thickness), _iso_variation(fit.grade, module, teeth, length)
        return SplineTolerances(total - effective, effective)
    if standard == DIN5480 and fit.grade in _DIN_TOLERANCES:
        actual, effective, place = _DIN_TOLERANCES[fit.grade]
        least, most = _DIN_RANGES[place]
        if least < diameter <= most and _DIN_MODULES[0] <= module <= _DIN_MODULES[1]:
            return SplineTolerances(actual, effective)
    return SplineTolerances(None, None)


def _iso_total(grade: int, diameter: float, thickness: float) -> float:
    """T + lambda (µm)."""
    of_diameter, of_thickness = _ISO_TOTAL[grade]
    unit = 0.004 * diameter + 2.1 if diameter > 500 else 0.45 * math.cbrt(diameter) + 0.001 * diameter
    return of_diameter * unit + of_thickness * (0.45 * math.cbrt(thickness) + 0.001 * thickness)


def _iso_variation(grade: int, module: float, teeth: int, length: float) -> float:
    """Effective variation lambda = .6 sqrt(F_p^2 + f_f^2 + F_beta^2) (µm)."""
    arc, depth = math.pi * module * teeth / 2, module + 0.0125 * module * teeth
    pitch = _ISO_PITCH[grade][0] * math.sqrt(arc) + _ISO_PITCH[grade][1]
    form = _ISO_FORM[grade][0] * depth + _ISO_FORM[grade][1]
    helix = _ISO_HELIX[grade][0] * math.sqrt(length) + _ISO_HELIX[grade][1]
    return 0.6 * math.sqrt(pitch**2 + form**2 + helix**2)


# ---------------------------------------------------------------------- designations

_NUMBER = r"(\d+(?:[.,]\d+)?)"
_TIMES = r"\s*[x×X*]\s*"
_DIN = re.compile(
    rf"(?:DIN\s*5480\s*[-–]?\s*)?([WN])\s*{_NUMBER}{_TIMES}{_NUMBER}(?:{_TIMES}{_NUMBER})?{_TIMES}(\d+)(?:{_TIMES}([\w]+))?"
)
_ISO_LIKE = re.compile(
    rf"(?:(?:ISO\s*4156|GB/T\s*3478(?:\.1)?|ANSI\s*B92\.1)\s*[-–:]?\s*)?(INT|EXT|INT/EXT)\s+(\d+)\s*[zT]?{_TIMES}"
    rf"{_NUMBER}(m|P|/{_NUMBER}P?){_TIMES}{_NUMBER}\s*([PR])(?:{_TIMES}([\w]+)(?:\s*/\s*([\w]+))?)?",
)
_ROOT_LETTERS = {"P": "flat", "R": "fillet"}
_DIN_PARTS = {"W": SHAFT, "N": HUB}

_SHAPES = (
    'must be like "W 30 x 1.25 x 22 x 8f", "N 30 x 1.25 x 22 x 9H", or both with / between them (DIN 5480), '
    '"EXT 24z x 2.5m x 30R x 5f", "INT/EXT 24z x 2.5m x 30R x 5H/5f" (ISO 4156), or "EXT 24T x 12/24P x 30R x 5" (ANSI B92.1)'
)


class Designation(NamedTuple):
    """Content of a designation: the standard, values under the keys of [spline], and those of each part under theirs."""

    standard: str
    values: Mapping[str, float | int]
    parts: Mapping[str, Mapping[str, str]]


def read_designation(text: str) -> Designation:
    """Return what a designation says. Raises ParameterError, with what is known or near."""
    if found := _ISO_LIKE.fullmatch(text.strip()):
        return _iso_designation(text, found)
    whole: Designation | None = None
    for each in re.split(r"\s*/\s*(?=(?:DIN\s*5480\s*[-–]?\s*)?[WN]\s*\d)", text.strip()):
        part = _din_designation(text, each)
        if whole is None:
            whole = part
            continue
        if whole.values != part.values or set(whole.parts) & set(part.parts):
            raise ParameterError("designation", text, "must name a hub N and a shaft W of the same diameter, module and teeth")
        whole = whole._replace(parts={**whole.parts, **part.parts})
    assert whole is not None
    return whole


def _din_designation(whole: str, text: str) -> Designation:
    """Return what one half of a designation of DIN 5480 says; a pressure angle of 30 may stand behind the module."""
    found = _DIN.fullmatch(text.strip())
    if found is None:
        raise ParameterError("designation", whole, _SHAPES)
    diameter, module, teeth = _number(found[2]), _number(found[3]), int(found[5])
    if found[4] is not None and _number(found[4]) != ANGLES[DIN5480][0]:
        raise ParameterError("designation", whole, "must have a pressure angle of 30 (DIN 5480), or none")
    require_series(DIN5480, "designation", whole, module=module)
    _require_din_teeth(whole, diameter, module, teeth)
    part = _DIN_PARTS[found[1]]
    values: dict[str, float | int] = {"nominal_diameter": diameter, "module": module, "teeth": teeth}
    return Designation(DIN5480, values, {part: {"fit": found[6]} if found[6] else {}})


LEAST_SHIFT, GREATEST_SHIFT = -0.5, 1.0
"""Profile shifts between which a spline of DIN 5480 makes sense; the standard itself uses -.05 to .45, in few rows more."""


def _require_din_teeth(text: str, diameter: float, module: float, teeth: int) -> None:
    """Raise ParameterError, with the number of teeth that fits, unless diameter, module and teeth belong together."""
    shift = din_profile_shift(diameter, module, teeth)
    if not LEAST_SHIFT <= shift <= GREATEST_SHIFT:
        fitting = max(math.ceil((diameter - 0.9 * module) / module - 1.1 - 1e-9), 1)
        raise ParameterError(
            "designation",
            text,
            f"must have a number of teeth near {fitting}: {teeth} teeth of module {module:g} mm need a profile shift "
            f"of {shift:.2f} at a diameter of {diameter:g} mm",
        )


def din_profile_shift(diameter: float, module: float, teeth: int) -> float:
    """Profile shift coefficient x of DIN 5480: x m = (d_B - m (z + 1.1))/2."""
    return (diameter - module * (teeth + 1.1)) / (2 * module)


def _iso_designation(whole: str, found: re.Match[str]) -> Designation:
    """Return what a designation of ISO 4156 or in its manner says: a module with m, or a diametral pitch with P."""
    standard = ISO4156 if found[4] == "m" else B92_1
    angle, root = _number(found[6]), _ROOT_LETTERS[found[7]]
    size: dict[str, float | int]
    if standard == ISO4156:
        size = {"module": _number(found[3])}
        require_series(standard, "designation", whole, module=_number(found[3]))
    else:
        size = {"diametral_pitch": _number(found[3])}
        if found[5] is not None and _number(found[5]) != 2 * _number(found[3]):
            raise ParameterError("designation", whole, f"must have a pitch like {found[3]}/{2 * _number(found[3]):g}")
        require_series(standard, "designation", whole, pitch=_number(found[3]))
    if angle not in ANGLES[standard]:
        raise ParameterError(
            "designation",
            whole,
            f"must have a pressure angle of 30, 37.5 or 45 deg; the nearest is {_nearest(angle, ANGLES[standard]):g}",
        )
    parts = [part for part, name in ((HUB, "INT"), (SHAFT, "EXT")) if name in found[1].split("/")]
    fits = [each for each in (found[8], found[9]) if each is not None]
    if fits and len(fits) != len(parts):
        raise ParameterError("designation", whole, "must have a class for each part, as in 5H/5f behind INT/EXT")
    values = {**size, "teeth": int(found[2]), "pressure_angle": angle}
    return Designation(standard, values, _classed(parts, fits, root))


def _classed(parts: list[str], fits: list[str], root: str) -> dict[str, dict[str, str]]:
    """Return root and tolerance class of each part, as far as they are said."""
    classes = [{"fit": fit} for fit in fits] or [{} for _ in parts]
    return {part: {"root": root, **each} for part, each in zip(parts, classes, strict=True)}


def _number(text: str) -> float:
    return float(text.replace(",", "."))


def _nearest(value: float, series: tuple[float, ...]) -> float:
    return min(series, key=lambda each: abs(each - value))


def require_series(standard: str, key: str, given: object, *, module: float = math.nan, pitch: float = math.nan) -> None:
    """Raise ParameterError for a module (mm) or diametral pitch (1/inch) of no series, with the nearest one that is."""
    if standard == B92_1 and pitch not in PITCHES:
        nearest = format_number(_nearest(pitch, PITCHES))
        raise ParameterError(key, given, f"must have a diametral pitch of the series of {standard}; the nearest is {nearest}")
    if standard != B92_1 and module not in MODULES[standard]:
        nearest = format_number(_nearest(module, MODULES[standard]))
        raise ParameterError(key, given, f"must have a module of the series of {standard}; the nearest is {nearest}")


def module_of(module: float, pitch: float) -> float:
    """Return the module (mm) that is given itself, or as a diametral pitch (1/inch) where it is not a number."""
    return module_of_pitch(pitch) if math.isnan(module) else module
