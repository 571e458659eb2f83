"""SizeTask: the load, the life and the permitted sizes of a pair to be found."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property
from typing import Annotated, Any

from gearcad.core.errors import GeometryError, ParameterError, is_finite_number
from gearcad.core.quantities import FRICTION, LENGTH, Range, Whole, Words, require_fields
from gearcad.core.records import PerGear, concise, naming
from gearcad.geometry import ISO53_A, BasicRack
from gearcad.geometry.gear_parts import ISO_54_I, ISO_54_II
from gearcad.geometry.tool_shelf import ToolName, find_tool
from gearcad.load import Load
from gearcad.material import Material, MaterialGroup
from gearcad.rating.friction import FrictionLaw
from gearcad.rating.material_limits import EnduranceLimits, endurance_limits
from gearcad.rating.options import BearingArrangement, RatingOptions
from gearcad.rating.scuffing_temperatures import Oil, ScuffingLimits, structure_factor

__all__ = ["ISO_54_I", "ISO_54_II", "MOST_VARIANTS", "Criterion", "SizeTask"]

_TIP_THICKNESS, _HARD_TIP_THICKNESS = 0.2, 0.4
"""Least normal thickness of a tip, in normal modules; that of case-hardened teeth, which would be brittle."""

_HELIX_ANGLES = (0.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0, 22.0, 24.0)
_WIDTH_RATIOS = (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2)
_SHIFTS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
"""What is tried unless the user says otherwise."""

_MOST_VALUES = 10_000

MOST_VARIANTS = 500_000_000
"""Largest number of variants: about a quarter of an hour."""

_TEETH = Whole(5, 500)
_RANGES = {
    "modules": Range("mm", 0.05, 100.0),
    "helix_angles": Range("deg", 0.0, 45.0),
    "width_ratios": Range("", 0.02, 5.0),
    "shifts": Range("", -2.0, 2.0),
    "shift_sums": Range("", -2.0, 4.0),
}


class Criterion(StrEnum):
    """The first criterion of the ranking."""

    MASS = "mass"
    SAFETY = "safety"
    """The lesser of S_H/S_Hmin and S_F/S_Fmin."""

    QUIET = "quiet"
    """Variation of the length of the lines of contact over the mesh cycle."""

    SLIDING = "sliding"
    """The greatest specific sliding."""

    SCUFFING = "scuffing"
    """The integral temperature."""

    EFFICIENCY = "efficiency"
    """The efficiency of the mesh, by Ohlendorf's loss factor."""


@dataclass(frozen=True, kw_only=True)
class SizeTask:
    """Task of a search: an external pair that drives the wheel `ratio` times slower than the pinion, under the `load` of the
    pinion, with the safeties, the life and all else of `rating`. Lengths in mm, helix angles in degrees, magnitudes.

    Tuples are what is tried: `teeth` of the pinion are least and most, `modules` normal modules, `width_ratios` b/d_1, `shifts`
    those of the pinion; `shift_sums` x_1 + x_2, where no `centre_distance` is given, about: centre distances get round figures.
    The wheel has every number of teeth within `ratio_tolerance` (%). `max_diameter` is the most of any tip circle, `max_mass`
    (kg) of both gears, None REACH times that of the lightest where another criterion than mass comes first, and
    `max_width_in_modules` that of b/m_n; `least_tip_thickness` (normal modules) None is 0.4 where case-hardened, else 0.2. The
    order of tuples has no say. `friction` of the flanks, a coefficient or the law "integral" or "niemann", gives an efficiency;
    None is none, or "integral" where efficiency comes first. A `tool` of the shelf, a hob that makes all of the teeth, stands
    in place of the `rack`; its tip radius may go with the module. Raises ParameterError, SpecError for a table of tools with a
    fault.
    """

    load: Load
    ratio: Annotated[float, Range("", 1.0, 20.0), Words("gear ratio wanted", "u")]
    materials: PerGear[Material]
    rating: RatingOptions = field(default=RatingOptions())
    rack: Annotated[BasicRack, Words("basic rack of ISO 53")] = field(default=ISO53_A)
    tool: Annotated[str | None, Words("tool of the shelf")] = None
    ratio_tolerance: Annotated[float, Range("%", 0.0, 50.0), Words("most deviation of the ratio")] = 2.0
    teeth: Annotated[tuple[int, int], Words("numbers of teeth of the pinion, least and most", "z_1")] = (14, 40)
    modules: Annotated[tuple[float, ...], Words("normal modules", "m_n")] = ISO_54_I[:11]
    helix_angles: Annotated[tuple[float, ...], Words("helix angles", "β")] = _HELIX_ANGLES
    width_ratios: Annotated[tuple[float, ...], Words("face widths over the pinion's reference diameter", "b/d_1")] = (
        _WIDTH_RATIOS
    )
    shifts: Annotated[tuple[float, ...], Words("profile shifts of the pinion", "x_1")] = _SHIFTS
    shift_sums: Annotated[tuple[float, ...], Words("sums of the profile shifts", "x_1 + x_2")] = (0.0, 0.25, 0.5, 0.75, 1.0)
    centre_distance: Annotated[float | None, LENGTH, Words("centre distance", "a")] = None
    max_diameter: Annotated[float | None, LENGTH, Words("most diameter of a tip circle")] = None
    max_mass: Annotated[float | None, Range("kg", 0.0, None, ends="(]"), Words("most mass of both gears")] = None
    max_width_in_modules: Annotated[float, Range("", 1.0, 100.0), Words("most face width in modules", "b/m_n")] = 30.0
    least_contact_ratio: Annotated[float, Range("", 1.0, 2.0), Words("least transverse contact ratio", "ε_α")] = 1.2
    least_tip_thickness: Annotated[float | None, Range("", 0.0, 1.0), Words("least thickness of tips", "s_an/m_n")] = None
    criterion: Annotated[Criterion, Words("what comes first")] = Criterion.MASS
    friction: Annotated[float | FrictionLaw | None, FRICTION, Words("friction of the flanks, or its law", "µ")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        if self.load.torque <= 0:
            raise ParameterError("torque", self.load.torque, "must be a number above 0 N·m, on the pinion", "N·m")
        self._check_teeth()
        for name, permitted in _RANGES.items():
            object.__setattr__(self, name, _sorted(name, getattr(self, name), permitted))
        self._take_tool()
        self._check_variants()
        self._check_limits()
        self._take_friction()

    def _take_friction(self) -> None:
        """Take the default law where efficiency comes first. Raises ParameterError for a law that has no coefficient here."""
        if self.friction is None and self.criterion is Criterion.EFFICIENCY:
            object.__setattr__(self, "friction", "integral")
        if self.friction == "flash":
            raise ParameterError("friction", self.friction, 'must be a number, "integral" or "niemann"')
        if isinstance(self.friction, str) and self.load.speed == 0:
            raise ParameterError("friction", self.friction, "must be a number at 0 rpm: laws go by the speed")

    def _take_tool(self) -> None:
        """Take the rack of the tool, if there is one. Raises ParameterError unless it cuts every module that is tried."""
        if self.tool is None:
            return
        tools = {module: name.tool for module, name in self.hobs.items() if name.tool is not None}
        rack = next(iter(tools.values())).rack
        for module, tool in tools.items():
            if tool.kind != "hob":
                raise ParameterError("tool", tool.name, f"must be a hob that makes all of the teeth; this is a {tool.kind}")
            if replace(tool.rack, root_radius=0.0) != replace(rack, root_radius=0.0):
                raise ParameterError("tool", tool.name, f"must have one depth for all modules; that of {module:g} mm differs")
        if self.rack not in (ISO53_A, rack):
            raise ParameterError("tool", str(self.tool), "must be left out where a rack is given")
        object.__setattr__(self, "rack", rack)

    @cached_property
    def hobs(self) -> dict[float, ToolName]:
        """The tool by the modules that are tried; none without one. Raises ParameterError and SpecError."""
        if self.tool is None:
            return {}
        try:
            return {module: find_tool(self.tool, module) for module in self.modules}
        except GeometryError as error:
            raise ParameterError("tool", error.value, error.permitted) from None

    @property
    def root_radii(self) -> tuple[float, ...] | None:
        """Tip radius of the tool by module (normal modules); None where it is the same for all."""
        racks = [name.tool.rack for name in self.hobs.values() if name.tool is not None]
        if len({rack.root_radius for rack in racks}) < 2:
            return None
        return tuple(rack.full_root_radius() if rack.root_radius == "full" else float(rack.root_radius) for rack in racks)

    def _check_variants(self) -> None:
        """Check that there are variants, and not too many to try all."""
        if not self.teeth_pairs:
            permitted = (
                f"must be more, or the range of teeth wider: no pinion from {self.teeth[0]} to {self.teeth[1]} teeth has one"
            )
            raise ParameterError("ratio_tolerance", self.ratio_tolerance, permitted, "%")
        if (number := self.variants) > MOST_VARIANTS:
            permitted = f"must make at most {MOST_VARIANTS:.0e} variants together, here {number:.1e}: take coarser steps"
            raise ParameterError("ranges", number, permitted)

    def _check_teeth(self) -> None:
        given = tuple(self.teeth)
        if len(given) != 2:
            raise ParameterError("teeth", list(given), "must be two whole numbers, the least and the most")
        for end in given:
            _TEETH.require("teeth", end)
        if given[0] > given[1]:
            raise ParameterError("teeth", list(given), "must have the least first")
        object.__setattr__(self, "teeth", given)

    def _check_limits(self) -> None:
        """Raise ParameterError unless both materials have a group and endurance limits, and for options that sizing does not
        use.
        """
        options = self.rating
        if options.spectrum is not None:
            raise ParameterError("spectrum", "given", "must be left out: give the torque that is equivalent to it")
        if options.face_load_factor in ("fe", "shafts"):
            permitted = 'must be "C" or a number: no variant has a load distribution yet'
            raise ParameterError("face_load_factor", options.face_load_factor, permitted)
        if options.required_safety_scuffing is not None and options.scuffing_stage is None:
            raise ParameterError("scuffing_stage", None, "must be given with a required safety against scuffing")
        self._check_shaft()
        if self.load.speed == 0 and (options.dynamic_factor in ("B", "C") or (options.life and not options.load_cycles)):
            raise ParameterError("speed", 0, "must be above 0 rpm: K_v and load cycles go by it", "rpm")
        for role, material in self.materials.items():
            if material.group is None:
                with naming(role):
                    raise ParameterError("material.group", None, 'must be given, such as "Eh": life and factors go by it')
        for role, limits in self.limits.items():
            for name, value in (("contact_endurance_limit", limits.contact), ("root_endurance_limit", limits.root)):
                if value is None:
                    with naming(role):
                        permitted = 'must be given, in MPa, or a material of ISO 6336-5 such as "Eh MQ": nothing can be sized'
                        raise ParameterError(f"material.{name}", None, permitted)

    def _check_shaft(self) -> None:
        """A pinion that is not in the middle between its bearings needs a shaft that is known."""
        options = self.rating
        overhung = options.pinion_place is BearingArrangement.OVERHUNG
        if overhung and not options.pinion_offset:
            raise ParameterError("pinion_offset", 0, 'must not be 0 mm for bearing_arrangement "c": how far it overhangs', "mm")
        for name in ("bearing_span", "shaft_diameter") if options.pinion_offset else ():
            if getattr(options, name) is None:
                raise ParameterError(name, None, "must be given with pinion_offset: the shaft bends by it")

    @property
    def limits(self) -> PerGear[EnduranceLimits]:
        """sigma_Hlim and sigma_Flim of both materials. Raises ParameterError."""
        return self.materials.map(endurance_limits)

    @property
    def variants(self) -> int:
        """Number of pairs with a face width."""
        sums = 1 if self.centre_distance is not None else len(self.shift_sums)
        sizes = (self.modules, self.helix_angles, self.shifts, self.width_ratios)
        return len(self.teeth_pairs) * sums * math.prod(map(len, sizes))

    @property
    def most_temperature(self) -> float | None:
        """Integral temperature (°C) with the safety against scuffing that is required; None where none is."""
        options, required = self.rating, self.rating.required_safety_scuffing
        if required is None:
            return None
        oil, structure = Oil.of(options), options.relative_structure_factor or structure_factor(self.materials)
        return ScuffingLimits.of(oil, options.scuffing_stage or 0, structure).integral / required

    @property
    def tip_thicknesses(self) -> PerGear[float]:
        """Least normal tip thickness s_an/m_n of both gears."""
        return self.materials.map(self._tip_thickness)

    def _tip_thickness(self, material: Material) -> float:
        if self.least_tip_thickness is not None:
            return self.least_tip_thickness
        return _HARD_TIP_THICKNESS if material.group is MaterialGroup.CASE_HARDENED else _TIP_THICKNESS

    @property
    def teeth_pairs(self) -> tuple[tuple[int, int], ...]:
        """z_1 and z_2 whose ratio is within the tolerance, in order."""
        share = self.ratio_tolerance / 100 + 1e-12
        made = []
        for z_1 in range(self.teeth[0], self.teeth[1] + 1):
            low, high = (z_1 * self.ratio * (1 + side * share) for side in (-1, 1))
            made += [(z_1, z_2) for z_2 in range(max(math.ceil(low), 5), math.floor(high) + 1)]
        return tuple(made)


def _sorted(name: str, given: Any, permitted: Range) -> tuple[float, ...]:
    """Return the values in order, each once. Raises ParameterError."""
    values: Sequence[Any] = given if isinstance(given, list | tuple) else [given]
    if not 1 <= len(values) <= _MOST_VALUES:
        raise ParameterError(name, len(values), f"must have from 1 to {_MOST_VALUES} values")
    for value in values:
        permitted.require(name, value)
        assert is_finite_number(value)
    return tuple(sorted({float(value) for value in values}))
