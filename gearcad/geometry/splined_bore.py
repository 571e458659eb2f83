"""SplinedBore: a bore with the teeth of a splined hub, which counts as the round bore of its root circle.

Lengths in mm. Teeth and diameters are positive. The outline of the teeth is that of a `Spline`; here stands what the body of a
gear has to know of them, so that a gear can have a splined bore and a splined hub can be a gear.
"""

from __future__ import annotations

import math
from typing import Any, Self

from gearcad.core.errors import GeometryError, InputError, ParameterError, require_whole
from gearcad.core.units import module_of_pitch
from gearcad.geometry.spline_standards import (
    ANGLES,
    DIN5480,
    HUB,
    ISO4156,
    SHAFT,
    Designation,
    Proportions,
    SplineTolerances,
    deviation,
    proportions,
    read_designation,
    read_fit,
)

LEAST_TEETH, MOST_TEETH = 6, 500
"""Numbers of teeth that a spline can have."""

HUBS = '"N 30 x 1.25 x 22 x 9H" (DIN 5480), "INT 24z x 2.5m x 30R x 5H" (ISO 4156) or "INT 24T x 12/24P x 30R x 5" (ANSI B92.1)'
"""Designations of hubs, for messages."""

_USUAL_HUB = "9H"
"""Tolerance class of the hub of DIN 5480 that messages suggest."""


class SplinedBore(float):
    """A bore with the teeth of a splined hub: the number is the diameter of their root circle (mm).

    What asks for the diameter of a bore (rim, rating, finite elements) gets that of the root circle. Two splined bores are
    equal if their designations are; none equals a number, so that no solid of a round bore is taken for it. Raises
    ParameterError for a text that names no hub, and GeometryError for a hub whose teeth are not possible.
    """

    __slots__ = ("designation",)

    designation: str
    """Designation of the hub, such as "N 30 x 1.25 x 22 x 9H"."""

    def __new__(cls, designation: str) -> Self:
        """Return the bore that a designation names."""
        text = " ".join(designation.replace(",", ".").split())
        bore = super().__new__(cls, _root_diameter(text))
        bore.designation = text
        return bore

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SplinedBore) and other.designation == self.designation

    def __ne__(self, other: object) -> bool:
        return not self == other

    def __hash__(self) -> int:
        return hash((type(self), self.designation))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.designation!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.designation,)


def _root_diameter(text: str) -> float:
    """Return the diameter of the root circle (mm) of the hub that a designation names. Raises InputError of `bore`."""
    try:
        said = read_designation(text)
    except ParameterError as error:
        if error.permitted.startswith("must be like"):
            raise ParameterError("bore", text, f"must be a number at least 0 mm, or a hub such as {HUBS}") from None
        raise ParameterError("bore", text, error.permitted) from None
    if tuple(said.parts) != (HUB,):
        raise ParameterError("bore", text, f'must be the hub alone: write "{_hub_of(said)}"')
    try:
        return _checked_root_diameter(said)
    except InputError as error:
        raise GeometryError("bore", text, f"{error.parameter} {error.permitted}") from None


def _hub_of(said: Designation) -> str:
    """Return the designation of the hub that belongs to a designated shaft, or of the one that is designated beside it."""
    own = said.parts.get(HUB, {}).get("fit")
    teeth = said.values["teeth"]
    if said.standard == DIN5480:
        return f"N {said.values['nominal_diameter']:g} x {said.values['module']:g} x {teeth} x {own or _USUAL_HUB}"
    form = "P" if said.parts[HUB if own else SHAFT]["root"] == "flat" else "R"
    angle = f"{said.values['pressure_angle']:g}{form}"
    grade = read_fit(said.standard, SHAFT, said.parts[SHAFT]["fit"]).grade
    if said.standard == ISO4156:
        return f"INT {teeth}z x {said.values['module']:g}m x {angle} x {own or f'{grade}H'}"
    pitch = said.values["diametral_pitch"]
    return f"INT {teeth}T x {pitch:g}/{2 * pitch:g}P x {angle} x {own or grade}"


def _checked_root_diameter(said: Designation) -> float:
    """Return the diameter of the root circle (mm). Raises InputError of the value of a designation that makes no hub."""
    values, part = said.values, said.parts[HUB]
    teeth = values["teeth"]
    require_whole("number of teeth", teeth, at_least=LEAST_TEETH, at_most=MOST_TEETH)
    fit = read_fit(said.standard, HUB, part["fit"]) if "fit" in part else None
    if said.standard == DIN5480:
        root, module = values["nominal_diameter"], values["module"]
        if fit is not None:  # its deviation is known up to 400 mm
            deviation(said.standard, HUB, fit, root, SplineTolerances(None, None))
        _require_involutes(root - 2 * module, module * teeth, ANGLES[DIN5480][0])
        return float(root)
    module = values["module"] if said.standard == ISO4156 else module_of_pitch(values["diametral_pitch"])
    form = _proportions(said)
    if said.standard != ISO4156:  # there the tip circle follows from the form circle of the shaft, beyond the base circle
        _require_involutes(module * (teeth + form.tip), module * teeth, values["pressure_angle"])
    return float(module * (teeth + form.root))


def _proportions(said: Designation) -> Proportions:
    values, root = said.values, said.parts[HUB]["root"]
    pitch = values.get("diametral_pitch", math.nan)
    return proportions(said.standard, HUB, values["pressure_angle"], root, pitch=pitch, major_fit=False)


def _require_involutes(tip: float, reference: float, angle: float) -> None:
    """Raise GeometryError unless the tips (a diameter, mm) lie outside the base circle of a hub."""
    base = reference * math.cos(math.radians(angle))
    if tip <= base:
        permitted = f"must lie outside the base circle (diameter {tip:.6g} mm, base circle {base:.6g} mm)"
        raise GeometryError("tips", None, permitted)
