"""Inputs of a gear beside its teeth: module series, basic rack, shaper cutter, double helix, body with bore and keyway.

Lengths in mm, angles in degrees; lengths of basic rack and shaper cutter are coefficients of the normal module. The counterpart
of the rack is the tool that cuts the gear. So the tip radius of the tool equals the root radius of the rack.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from dataclasses import asdict, dataclass
from enum import Enum
from pathlib import Path
from typing import Annotated, Literal, NamedTuple, Protocol

from gearcad.core.errors import GeometryError, ParameterError, at_most
from gearcad.core.quantities import Derived, InPlaceOf, Range, Whole, Words, derive, is_given, require_fields, schema_of
from gearcad.core.records import JsonObject, concise
from gearcad.core.units import MM_PER_INCH, module_of_pitch
from gearcad.core.values import Values

ISO_54_I = (1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 32, 40, 50)
"""Modules that the standard prefers."""

ISO_54_II = (1.125, 1.375, 1.75, 2.25, 2.75, 3.5, 4.5, 5.5, 6.5, 7, 9, 11, 14, 18, 22, 28, 36, 45)


_HEIGHT = Range("", 0, 5, ends="(]")
_RADIUS = Range("", 0, 5)


@dataclass(frozen=True, kw_only=True)
class BasicRack:
    """Basic rack in the normal section: pressure angle in degrees, the rest in normal modules.

    `addendum` h_aP*, `dedendum` h_fP*, `root_radius` rho_fP* (a number, or "full" for one arc across the space).
    Raises ParameterError for a single value out of range; what depends on the gear (shift, thinning) is checked there.
    """

    pressure_angle: Annotated[float, Range("deg", 5, 45), Words("normal pressure angle", "α_n", "ISO 53")] = 20.0
    addendum: Annotated[float, _HEIGHT, Words("addendum of the rack", "h_aP*", "ISO 53")] = 1.0
    dedendum: Annotated[float, _HEIGHT, Words("dedendum of the rack", "h_fP*", "ISO 53")] = 1.25
    root_radius: Annotated[float | Literal["full"], _RADIUS, Words("root radius of the rack", "ρ_fP*", "ISO 53")] = 0.38

    __repr__ = concise

    def __post_init__(self) -> None:
        if isinstance(self.root_radius, str) and self.root_radius != "full":
            raise ParameterError("root_radius", self.root_radius, 'must be a number at least 0, or "full"')
        require_fields(self)

    def full_root_radius(self, dedendum: float | None = None, thinning: float = 0.0) -> float:
        """Return the largest root radius (in normal modules), see `full_root_radius`.

        `dedendum` replaces the rack's own where a root diameter is prescribed.
        """
        return full_root_radius(self.pressure_angle, self.dedendum if dedendum is None else dedendum, thinning)


def full_root_radius(pressure_angle: float, dedendum: Values, thinning: Values) -> Values:
    """Return the largest root radius (in normal modules): the arc that touches both flanks and the bottom of the rack's space.

    rho = (pi/4 + t/2 - h_fP tan a) cos a / (1 - sin a), with the tooth thinning t in normal modules (the tool's
    tooth is thicker by as much). Negative where the tool's flanks meet before its tip: no such tool exists.
    """
    angle = math.radians(pressure_angle)
    half_tip = math.pi / 4 + thinning / 2 - dedendum * math.tan(angle)
    return half_tip * math.cos(angle) / (1 - math.sin(angle))


ISO53_A = BasicRack(dedendum=1.25, root_radius=0.38)
"""Rack A of ISO 53: dedendum 1.25, root radius 0.38."""

ISO53_B = BasicRack(dedendum=1.25, root_radius=0.30)
"""Rack B of ISO 53: dedendum 1.25, root radius 0.30."""

ISO53_C = BasicRack(dedendum=1.25, root_radius=0.25)
"""Rack C of ISO 53: dedendum 1.25, root radius 0.25."""

ISO53_D = BasicRack(dedendum=1.40, root_radius=0.39)
"""Rack D of ISO 53: dedendum 1.40, root radius 0.39."""

NAMED_RACKS = {"ISO53_A": ISO53_A, "ISO53_B": ISO53_B, "ISO53_C": ISO53_C, "ISO53_D": ISO53_D}


_SHIFT = Range("", -5, 5)


@dataclass(frozen=True, kw_only=True)
class ShaperCutter:
    """Shaper cutter: number of teeth z_0, profile shift x_0, radius of the tip corner in normal modules.

    Without teeth there is no shaper: an external gear is cut by the counterpart of its rack, a ring has a form root, whose
    fillet is the corner itself. Without a tip radius the corner has that of the rack, or the full radius where that is
    smaller. Raises ParameterError.
    """

    teeth: Annotated[int | None, Whole(3, 2000), Words("cutter, number of teeth", "z_0")] = None
    profile_shift: Annotated[float, _SHIFT, Words("cutter, profile shift coefficient", "x_0")] = 0.0
    tip_radius: Annotated[float | None, _RADIUS, Words("cutter, tip radius", "ρ_aP0*")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)

    @property
    def present(self) -> bool:
        """Whether anything of a cutter was given."""
        return self.teeth is not None or self.tip_radius is not None


_PITCH = Range("1/inch", 0.127, 2540)
"""Range of the diametral pitches (1/inch) of permitted modules."""

NormalModule = Annotated[
    float, Range("mm", 0.01, 200), Words("normal module", "m_n", "4.2"), InPlaceOf("normal_diametral_pitch")
]
NormalDiametralPitch = Annotated[float, _PITCH, Words("normal diametral pitch", "P_nd")]

MODULE_OR_PITCH = ("normal_module", "normal_diametral_pitch")
"""Fields one of which is to be given."""


class _Sized(Protocol):
    @property
    def normal_module(self) -> float: ...
    @property
    def normal_diametral_pitch(self) -> float: ...


def derive_module(instance: _Sized) -> None:
    """Let the normal module follow from the diametral pitch that was given, or that from it. Raises GeometryError for both."""
    module, pitch = instance.normal_module, instance.normal_diametral_pitch
    if not is_given(pitch):
        derive(instance, "normal_diametral_pitch", MM_PER_INCH / module)
    elif not is_given(module):
        derive(instance, "normal_module", module_of_pitch(pitch))
    else:
        permitted = f"must be left out where normal_module is given ({module:g} mm is {MM_PER_INCH / module:.6g}/inch)"
        raise GeometryError("normal_diametral_pitch", pitch, permitted, "1/inch")


_GAP = Range("mm", 0, 10000)

HALF_PITCH = 0.5
"""Largest offset of the halves, in pitches, in either direction."""

_OFFSET = Range("", -HALF_PITCH, HALF_PITCH)


@dataclass(frozen=True, kw_only=True)
class DoubleHelix:
    """Gap and offset of the halves of a double helical gear; without a gap width the teeth are those of a single helix.

    `gap_width` (mm) is part of the face width; 0 lets the halves meet in a sharp apex, in one section. `offset` is how far
    the teeth of the upper half (beyond the gap) are turned on, counter-clockwise, in pitches: 0 where each tooth goes on
    behind the gap, 0.5 where it faces a space; -0.5 is the same. `gap_diameter` (mm) is that of the gear between the halves,
    None a quarter of a module below the root circle. The gear's helix angle is that of the lower half, which begins at z = 0.
    End chamfers are on both ends of each half, but for an apex.
    Raises ParameterError, or GeometryError for an offset without a gap.
    """

    gap_width: Annotated[float | None, _GAP, Words("gap between the halves", "b_g", "")] = None
    offset: Annotated[float, _OFFSET, Words("offset of the upper half, in pitches")] = 0.0
    gap_diameter: Annotated[float | None, Range("mm", 0, 2e6, ends="(]"), Words("diameter between the halves")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        if not self.gap_width:
            for name in ("offset", "gap_diameter"):
                if value := getattr(self, name):
                    raise GeometryError("gap_width", self.gap_width, f"must be above 0 mm where {name} is {value:g}", "mm")

    @property
    def present(self) -> bool:
        """Whether there are two halves."""
        return self.gap_width is not None


class Keyway(NamedTuple):
    """Width b of a keyway, and its depth t2 from the bore outwards."""

    width: float
    depth: float


SMALLEST_BORE = 6.0
"""The first range has it too, as charts of makers do."""

_UP_TO = (8, 10, 12, 17, 22, 30, 38, 44, 50, 58, 65, 75, 85, 95, 110, 130, 150, 170, 200, 230, 260, 290, 330, 380, 440, 500)
"""Ranges of bores; the upper limit belongs to a range."""

LARGEST_BORE = float(_UP_TO[-1])

_WIDTHS = (2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 18, 20, 22, 25, 28, 32, 36, 40, 45, 50, 56, 63, 70, 80, 90, 100)
_DEPTHS = (
    *(1.0, 1.4, 1.8, 2.3, 2.8, 3.3, 3.3, 3.3, 3.8, 4.3, 4.4, 4.9, 5.4, 5.4, 6.4, 7.4, 8.4, 9.4, 10.4, 11.4),
    *(12.4, 12.4, 14.4, 15.4, 17.4, 19.5),
)

_ALLOWANCES = ((6, 100.0), (32, 200.0), (100, 300.0))
"""Upper deviations (µm) of the depth of a keyway, up to a width (mm)."""


def keyway_of(bore: float) -> Keyway:
    """Return the keyway (mm) of DIN 6885 for a bore from 6 to 500 mm. Raises GeometryError for another bore.

    >>> keyway_of(40.0)
    Keyway(width=12.0, depth=3.3)
    """
    if not SMALLEST_BORE <= bore <= LARGEST_BORE:
        permitted = f"must be from {SMALLEST_BORE:g} to {LARGEST_BORE:g} mm for a keyway of DIN 6885"
        raise GeometryError("bore", bore, permitted, "mm")
    place = bisect_left(_UP_TO, bore)
    return Keyway(float(_WIDTHS[place]), _DEPTHS[place])


def depth_allowance(width: float) -> float | None:
    """Upper deviation (µm) of the depth t2 of a keyway of a width, the lower one is 0; None where no key is so wide."""
    return next((allowance for most, allowance in _ALLOWANCES if width <= most), None)


FEATURE = Range("mm", 0, None)

LEAST_FEATURE = 0.001
"""Smallest size (mm) of anything on a body; less could be neither made nor measured."""


class HubSide(Enum):
    """Sides on which the hub stands out: beyond z = face width (front), below z = 0 (back), or both."""

    FRONT = "front"
    BACK = "back"
    BOTH = "both"


@dataclass(frozen=True, kw_only=True)
class Body:
    """The gear's body. Lengths in mm, angles in degrees; 0 leaves a feature out.

    A `bore` given as the designation of a splined hub ("N 30 x 1.25 x 22 x 9H") becomes a `SplinedBore`: it counts as the round
    bore of its root circle, tooth 0 on +x, and has no keyway.
    `keyway_depth` is measured from the bore outwards (t2 of DIN 6885), the keyway lies on +x, under tooth 0. With `keyway` its
    width and depth are those of DIN 6885-1 for the bore, and read as numbers (see `Derived`).
    `hub_length` is how far the hub stands out on each `hub_side`. `rim_diameter` is the outside of an internal gear.
    `end_chamfer` is the axial length of the cone turned on both ends of the tip cylinder, `end_chamfer_angle` the angle
    between that cone and the gear axis, so that the radial depth is end_chamfer * tan(end_chamfer_angle).
    `tip_chamfer` is the radial height of the 45-degree chamfer along both tip edges of each tooth (transverse section).
    A ring has no bore, hub or keyway; its `bolt_circle` (mm) has `bolt_holes` holes of `bolt_diameter`, the first on +x.
    `web_thickness` b_s and `rim_thickness` s_R (below the root circle) are those of a blank that is no solid disc: only the
    rating knows them (C_R, Y_B), the solid is a full disc.
    `step` is a STEP file of a blank of one's own, an external gear's: the files of bodies have its teeth on that, and it has
    bore, keyway and hub itself.
    Raises ParameterError, or GeometryError for a keyway that does not fit its bore, or is none of DIN 6885.
    """

    bore: Annotated[float, FEATURE, Words("bore")] = 0.0
    keyway: Annotated[bool, Words("keyway by the bore", "", "DIN 6885")] = False
    keyway_width: Annotated[float, FEATURE, Words("keyway width", "", "DIN 6885")] = 0.0
    keyway_depth: Annotated[float, FEATURE, Words("keyway depth from the bore", "t_2", "DIN 6885")] = 0.0
    hub_diameter: Annotated[float, FEATURE, Words("hub diameter")] = 0.0
    hub_length: Annotated[float, FEATURE, Words("hub length on each side")] = 0.0
    hub_side: Annotated[HubSide, Words("side of the hub")] = HubSide.FRONT
    rim_diameter: Annotated[float | None, Range("mm", 0, None, ends="(]"), Words("rim diameter (rings)")] = None
    bolt_circle: Annotated[float, FEATURE, Words("bolt circle diameter (rings)")] = 0.0
    bolt_holes: Annotated[int, Whole(1, 1000, may_vanish=True), Words("number of bolt holes (rings)")] = 0
    bolt_diameter: Annotated[float, FEATURE, Words("bolt hole diameter (rings)")] = 0.0
    end_chamfer: Annotated[float, FEATURE, Words("end chamfer, axial length")] = 0.0
    end_chamfer_angle: Annotated[float, Range("deg", 5, 85), Words("end chamfer, angle to the axis")] = 45.0
    tip_chamfer: Annotated[float, FEATURE, Words("tip chamfer, radial height", "h_K", "6.1")] = 0.0
    step: Annotated[str | None, Words("blank of one's own, STEP file")] = None
    web_thickness: Annotated[float, FEATURE, Words("web of the blank, for the rating", "b_s", "ISO 6336-1")] = 0.0
    rim_thickness: Annotated[float, FEATURE, Words("rim of the blank, for the rating", "s_R", "ISO 6336-1")] = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        if isinstance(self.bore, str):
            from gearcad.geometry.splined_bore import SplinedBore  # only here: a spline costs those who have one

            object.__setattr__(self, "bore", SplinedBore(self.bore))
        require_fields(self)
        for name in (name for name, field in schema_of(Body).items() if field.permitted is FEATURE):
            if 0 < (value := getattr(self, name)) < LEAST_FEATURE:
                raise ParameterError(name, value, f"must be 0 or at least {LEAST_FEATURE} mm", "mm")
        if self.step is not None:
            self._check_step()
        self._refuse_keyway()
        self._derive_keyway()
        for pair in (("keyway_width", "keyway_depth"), ("hub_diameter", "hub_length"), ("web_thickness", "rim_thickness")):
            self._check_both(*pair)
        for pair in (("bolt_circle", "bolt_holes"), ("bolt_holes", "bolt_diameter"), ("bolt_diameter", "bolt_circle")):
            self._check_both(*pair)
        self._check_keyway()

    def _check_step(self) -> None:
        """Raise ParameterError for no name of a file, GeometryError for features that the blank has itself."""
        if not isinstance(self.step, str) or not self.step.strip():
            raise ParameterError("step", self.step, 'must be the name of a STEP file, such as "blank.step"')
        for name in ("bore", "keyway_width", "hub_diameter", "rim_diameter", "bolt_circle"):
            if (value := getattr(self, name)) and not getattr(value, "derived", False):
                raise GeometryError(name, value, "must be left out where step is given: the blank has its own", "mm")
        if self.keyway:
            raise GeometryError("keyway", True, "must be left out where step is given: the blank has its own")

    @property
    def bore_spline(self) -> str | None:
        """Designation of the splined hub that the bore is; None of a round bore."""
        designation: str | None = getattr(self.bore, "designation", None)
        return designation

    def _refuse_keyway(self) -> None:
        """Raise GeometryError for a keyway in a splined bore."""
        for name in ("keyway", "keyway_width", "keyway_depth"):
            if self.bore_spline and (value := getattr(self, name)) and (isinstance(value, bool) or is_given(value)):
                raise GeometryError(name, value, f"must be left out: the bore is a spline ({self.bore_spline})")

    def _derive_keyway(self) -> None:
        """Derive width and depth from the bore, if `keyway` asks for it; 0 without a keyway."""
        sizes = ("keyway_width", "keyway_depth")
        for name in sizes:
            if self.keyway and is_given(value := getattr(self, name)) and value:
                permitted = "must be left out where keyway is true: it follows from the bore by DIN 6885"
                raise GeometryError(name, value, permitted, "mm")
        if self.keyway and not self.bore:
            raise GeometryError("keyway", True, "must be left out without a bore: it is a keyway by the bore (DIN 6885)")
        found = keyway_of(self.bore) if self.keyway else (0.0, 0.0)
        for name, value in zip(sizes, found, strict=True):
            if self.keyway or not is_given(getattr(self, name)):
                object.__setattr__(self, name, Derived(value))

    def _check_both(self, first: str, second: str) -> None:
        """Raise GeometryError if only one of two sizes of one feature is given."""
        for one, other in ((first, second), (second, first)):
            if getattr(self, one) and not getattr(self, other):
                unit = "" if other == "bolt_holes" else "mm"
                permitted = f"must be above 0{unit and f' {unit}'}, as {one} is given"
                raise GeometryError(other, getattr(self, other), permitted, unit)

    def _check_keyway(self) -> None:
        if self.keyway_width and self.keyway_width > 0.9 * self.bore:
            raise GeometryError(
                "keyway_width", self.keyway_width, f"must be at most {at_most(0.9 * self.bore)} mm (0.9 of the bore)", "mm"
            )

    @property
    def opening_diameter(self) -> float:
        """Diameter of the circle about the axis that clears bore and keyway (mm); 0 without a bore."""
        if not self.keyway_width:
            return self.bore
        return float(((self.bore + 2 * self.keyway_depth) ** 2 + self.keyway_width**2) ** 0.5)

    @property
    def hub_ends(self) -> tuple[float, float]:
        """Lengths (mm) by which the hub stands out below z = 0 and beyond z = face width."""
        back = self.hub_length if self.hub_side in (HubSide.BACK, HubSide.BOTH) else 0.0
        front = self.hub_length if self.hub_side in (HubSide.FRONT, HubSide.BOTH) else 0.0
        return back, front

    def to_dict(self) -> JsonObject:
        """Return the inputs for JSON: of a splined bore also its designation, behind the diameter of its root circle (mm); of a
        blank of one's own the name of its file.
        """
        found: JsonObject = {}
        for name, value in asdict(self).items():
            found[name] = value
            if name == "bore" and self.bore_spline:
                found |= {"bore": float(self.bore), "bore_spline": self.bore_spline}
        step = found.pop("step")
        return found | {"hub_side": self.hub_side.value} | ({} if step is None else {"step": Path(step).name})
