"""RatingOptions: the [rating] table of a spec, and the flank deviations that it leads to."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from typing import Annotated, Any, Literal, NamedTuple

from gearcad.core.errors import GeometryError, ParameterError, format_number, is_finite_number, require_whole
from gearcad.core.quantities import LENGTH, OFFSET, WHEN_GIVEN, AssumedCount, AssumedNumber, Range, Whole, Words, require_fields
from gearcad.core.records import PerGear, Role, concise, is_assumed
from gearcad.geometry import Gear, GearPair
from gearcad.rating.editions import Both, Edition, both, take_both
from gearcad.rating.tolerances import Accuracy, FlankTolerances, flank_tolerances, gear_tolerances, grades

_SAFETY = Range("", 0.1, 100.0)
_MOST_BINS = 1000
_WHOLE = 1e-6
"""Permitted error of the sum of the shares of life: what rounding of their digits leaves."""

_PERMITTED = (
    "must be a list of [share of life, share of torque], or [share of life, share of torque, share of speed];"
    ' in a cell "0.1:1.25 0.9:0.8"'
)


class LoadBin(NamedTuple):
    """A share of the life under shares of torque and speed of the [load]."""

    life: float
    torque: float
    speed: float = 1.0


@dataclass(frozen=True, kw_only=True)
class DutyOptions:
    """Life, load spectrum and safeties. What may differ per gear is a number for both, or a list [pinion, wheel]."""

    life: Annotated[float | None, Range("h", 1e-6, 1e8), Words("life in operation", "L_h")] = None
    load_cycles: Annotated[Both | None, Range("", 1.0, 1e15), Words("load cycles of a flank", "N_L")] = None
    contacts_per_turn: Annotated[Both, Range("", 1e-3, 1000.0), Words("contacts of a flank per turn")] = AssumedNumber(1.0)
    spectrum: Annotated[
        tuple[tuple[float, ...], ...] | None,
        Words("load spectrum", "", "ISO 6336-6"),
    ] = None
    mean_stress_factor: Annotated[Both, Range("", 0.1, 2.0), Words("mean stress influence factor", "Y_M", "ISO 6336-3")] = (
        AssumedNumber(1.0)
    )
    pitting_permitted: Annotated[bool, Words("whether some pitting is permitted", "", "ISO 6336-2")] = False
    long_life_factor: Annotated[
        float, Range("", 0.85, 1.0), Words("life factor at 10^10 load cycles", "Z_NT", "ISO 6336-2, -3")
    ] = AssumedNumber(0.85)
    required_safety_flank: Annotated[float, _SAFETY, Words("required safety of the flank", "S_Hmin", "ISO 6336-2")] = (
        AssumedNumber(1.0)
    )
    required_safety_root: Annotated[float, _SAFETY, Words("required safety of the root", "S_Fmin", "ISO 6336-3")] = (
        AssumedNumber(1.4)
    )
    required_safety_scuffing: Annotated[float | None, _SAFETY, Words("required safety against scuffing", "S_Smin")] = None

    @property
    def bins(self) -> tuple[LoadBin, ...]:
        """The load spectrum; none without one."""
        return tuple(LoadBin(*each) for each in self.spectrum or ())

    def _check_duty(self) -> None:
        """Lists of both gears, and the spectrum. Raises ParameterError."""
        take_both(self, "load_cycles", "contacts_per_turn", "mean_stress_factor")
        if self.load_cycles is not None and self.life is not None:
            both = self.load_cycles
            given = list(both) if isinstance(both, tuple) else both
            raise ParameterError("load_cycles", given, f"must be left out beside life = {format_number(self.life)} h, or life")
        if self.spectrum is not None:
            object.__setattr__(self, "spectrum", _spectrum(self.spectrum))


def _spectrum(given: Any) -> tuple[tuple[float, ...], ...]:
    """Return a spectrum from lists of numbers or from the text of a cell. Raises ParameterError."""
    if isinstance(given, str):
        found = [_numbers(item) for item in given.split()]
    elif isinstance(given, list | tuple):
        found = [tuple(each) if isinstance(each, list | tuple) else () for each in given]
    else:
        raise ParameterError("spectrum", given, _PERMITTED)
    if not 1 <= len(found) <= _MOST_BINS:
        raise ParameterError("spectrum", given, f"must have from 1 to {_MOST_BINS} parts")
    bins = tuple(_bin(each, given) for each in found)
    if abs((total := math.fsum(each[0] for each in bins)) - 1) > _WHOLE:
        raise ParameterError("spectrum", given, f"must have shares of life that add up to 1, here {format_number(total)}")
    if not any(each[1] for each in bins):
        raise ParameterError("spectrum", given, "must have a share of torque above 0")
    return bins


def _numbers(item: str) -> tuple[float, ...]:
    """Return the numbers of a text such as 0.1:1.25; empty if it is no such text. A comma is a decimal sign here."""
    parts = re.split(":", item.replace(",", "."))
    try:
        return tuple(map(float, parts))
    except ValueError:
        return ()


def _bin(numbers: tuple[Any, ...], given: Any) -> tuple[float, ...]:
    """Return a share of the life, above 0, and shares of torque, 0 or more, and of speed, above 0. Raises ParameterError."""
    if len(numbers) not in (2, 3) or not all(map(is_finite_number, numbers)):
        raise ParameterError("spectrum", given, _PERMITTED)
    life, torque, speed = (*numbers, 1.0)[:3]
    if not (0 < life <= 1 and 0 <= torque <= 100 and 0 < speed <= 100):
        permitted = "must have shares of life above 0 up to 1, of torque from 0 to 100, of speed above 0 up to 100"
        raise ParameterError("spectrum", list(numbers), permitted)
    return tuple(map(float, numbers))


_FACTOR = Range("", 1.0, 100.0)
_DEVIATION = Range("µm", 0.0, 1e4)
_SIGNED = Range("µm", -1e4, 1e4)


class HelixModification(StrEnum):
    """Modification of flanks along the face width: B_1 and B_2 of ISO 6336-1, table 8."""

    NONE = "none"
    CROWNING = "crowning"
    """Crowning that compensates half of f_ma."""

    FULL_CROWNING = "full crowning"
    """Compensation by half of f_ma + f_sh."""

    HELIX_CORRECTION = "helix correction"
    """Helix modification that matches the deflection of the shafts under load."""

    CORRECTION_AND_CROWNING = "helix correction and crowning"
    END_RELIEF = "end relief"


class ContactPattern(StrEnum):
    """Position of the contact pattern: whether it shows that misalignments of manufacture and of shafts are opposite."""

    UNPROVEN = "unproven"
    PROVEN = "proven"


class BearingArrangement(StrEnum):
    """Place of the pinion on its shaft: figure 13 of ISO 6336-1."""

    BETWEEN_NEAR = "a"
    """Gear between bearings, torque from the side of the nearer one."""

    BETWEEN_FAR = "b"
    """Gear between bearings, torque from the side of the farther one."""

    OVERHUNG = "c"
    SECOND_MESH_NEAR = "d"
    """Gear on a shaft with another gear."""

    SECOND_MESH_FAR = "e"


class MisalignmentSides(StrEnum):
    """Sides to which the misalignment by manufacture turns the flanks where the load over the face is found on shafts."""

    WORSE = "worse"
    """Both sides are computed and the greater K_Hbeta counts, as ISO 6336-1, annex E, has it."""

    ONE = "one"
    """The side of its sign: positive opens the gap towards larger z."""


class AlphaDeviation(StrEnum):
    """The deviation from which y_alpha is taken, if K_Halpha depends on f_falpha because it is larger than f_pb."""

    LITERAL = "literal"
    """Running-in allowance y_alpha taken from the same deviation, f_falpha."""

    KISSSOFT_2017 = "KISSsoft 2017"
    """Running-in allowance y_alpha taken from f_pb, as that program does."""


@dataclass(frozen=True, kw_only=True)
class LoadFactorOptions:
    """Methods or values of the load factors, and what they go by. Deviations in µm, lengths in mm.

    What may differ per gear is a number for both, or a list [pinion, wheel].
    """

    dynamic_factor: Annotated[
        float | Literal["B", "C"], Range("", 0.1, 100.0), Words("dynamic factor, or its method", "K_v", "ISO 6336-1")
    ] = "B"
    face_load_factor: Annotated[
        float | Literal["C", "fe", "shafts"], _FACTOR, Words("face load factor, or its method", "K_Hβ", "ISO 6336-1")
    ] = "C"
    transverse_load_factor: Annotated[
        float | Literal["B"], _FACTOR, Words("transverse load factor, or its method", "K_Hα", "ISO 6336-1")
    ] = "B"
    mesh_load_factor: Annotated[float, _FACTOR, Words("mesh load factor", "K_γ", "ISO 6336-1")] = AssumedNumber(1.0)
    helix_modification: Annotated[HelixModification, Words("helix modification", "B_1", "ISO 6336-1")] = HelixModification.NONE
    contact_pattern: Annotated[ContactPattern, Words("favourable contact pattern", "", "ISO 6336-1")] = ContactPattern.UNPROVEN
    bearing_arrangement: Annotated[BearingArrangement | None, Words("place of the pinion", "K'", "ISO 6336-1, figure 13")] = (
        None
    )
    bearing_span: Annotated[float | None, LENGTH, Words("distance of the pinion's bearings", "l", "ISO 6336-1")] = None
    pinion_offset: Annotated[float, OFFSET, Words("pinion from between its bearings", "s", "ISO 6336-1")] = 0.0
    shaft_diameter: Annotated[float | None, LENGTH, Words("diameter of the pinion's shaft", "d_sh", "ISO 6336-1")] = None
    stiffening: Annotated[bool, Words("whether the pinion stiffens its shaft", "", "ISO 6336-1")] = False
    shaft_deflection: Annotated[float | None, _DEVIATION, Words("misalignment by deflected shafts", "f_sh", "ISO 6336-1")] = (
        None
    )
    manufacturing_misalignment: Annotated[float | None, _SIGNED, Words("misalignment by manufacture", "f_ma", "ISO 6336-1")] = (
        None
    )
    misalignment_sides: Annotated[MisalignmentSides, Words("sides of f_ma on shafts", "", "ISO 6336-1, annex E")] = (
        MisalignmentSides.WORSE
    )
    face_mesh_stiffness: Annotated[
        float | None, Range("N/(mm·µm)", 0.01, 1000.0), Words("mesh stiffness over the face", "c_γβ", "ISO 6336-1")
    ] = None
    base_pitch_deviation: Annotated[Both | None, _DEVIATION, Words("base pitch deviation", "f_pb", "ISO 1328-1")] = None
    profile_form_deviation: Annotated[Both | None, _DEVIATION, Words("profile form deviation", "f_fα", "ISO 1328-1")] = None
    helix_slope_deviation: Annotated[Both | None, _DEVIATION, Words("helix slope deviation", "f_Hβ", "ISO 1328-1")] = None
    alpha_deviation_rule: Annotated[AlphaDeviation, Words("deviation that runs in", "y_α", "ISO 6336-1")] = (
        AlphaDeviation.LITERAL
    )

    @property
    def pinion_place(self) -> BearingArrangement:
        """The `bearing_arrangement`, "a" where none is given."""
        return self.bearing_arrangement or BearingArrangement.BETWEEN_NEAR

    def sides_of(self, misalignment: float) -> tuple[float, ...]:
        """Return the misalignments (µm) by manufacture that count for one of that size, positive where the gap opens to z."""
        one = self.misalignment_sides is MisalignmentSides.ONE or not misalignment
        return (misalignment,) if one else (misalignment, -misalignment)

    def _check_load_factors(self) -> None:
        """Lists of both gears, and the sign of f_ma. Raises ParameterError."""
        if self.misalignment_sides is not MisalignmentSides.ONE and (self.manufacturing_misalignment or 0.0) < 0:
            _DEVIATION.require("manufacturing_misalignment", self.manufacturing_misalignment)
        take_both(self, "base_pitch_deviation", "profile_form_deviation", "helix_slope_deviation")


class OilType(StrEnum):
    """Kinds of gear oil, as the coefficient of friction goes by them."""

    MINERAL = "mineral"
    POLYALPHAOLEFIN = "PAO"
    POLYGLYCOL = "PG"
    """Polyglycol, not soluble in water."""

    SOLUBLE_POLYGLYCOL = "PG (water-soluble)"
    ESTER = "ester"
    """Phosphate ester."""

    TRACTION = "traction"
    """Traction fluid."""


class Lubrication(StrEnum):
    """Method of lubrication."""

    DIP = "dip"
    SPRAY = "spray"
    SUBMERGED = "submerged"


_VISCOSITY = Range("mm²/s", 0.5, 1e5)

_OF_OIL = ("oil_viscosity_100", "oil_temperature", "oil_density", "oil_type", "scuffing_stage")


@dataclass(frozen=True, kw_only=True)
class LubricantOptions:
    """The oil, and its load stage in the FZG test A/8.3/90 (`scuffing_stage`). If nothing is given, a rating assumes an oil."""

    oil_viscosity_40: Annotated[float | None, _VISCOSITY, Words("viscosity of the oil at 40 °C", "ν_40")] = None
    oil_viscosity_100: Annotated[float | None, _VISCOSITY, Words("viscosity of the oil at 100 °C", "ν_100")] = None
    oil_temperature: Annotated[float | None, Range("°C", -60.0, 250.0), Words("temperature of the oil", "θ_oil")] = None
    oil_density: Annotated[float | None, Range("kg/m³", 500.0, 2000.0), Words("density of the oil at 15 °C", "ρ_15")] = None
    oil_type: Annotated[OilType | None, Words("kind of oil", "X_L")] = None
    lubrication: Annotated[Lubrication | None, Words("how oil comes to the teeth", "X_S")] = None
    scuffing_stage: Annotated[int | None, Whole(1, 14), Words("FZG load stage of the oil, A/8.3/90", "", "ISO 14635-1")] = None
    relative_structure_factor: Annotated[float | None, Range("", 0.1, 3.0), Words("relative structure factor", "X_W")] = None
    friction: Annotated[
        float | None, Range("", 1e-6, 2.0), Words("friction of plastic teeth", "μ", "VDI 2736-2"), WHEN_GIVEN
    ] = None

    @property
    def oil_supply(self) -> Lubrication:
        """The `lubrication`, "dip" where none is given."""
        return self.lubrication or Lubrication.DIP

    def _check_lubricant(self) -> None:
        """An oil of which something is given has a viscosity, which heat lowers. Raises ParameterError and GeometryError."""
        known = next((name for name in _OF_OIL if getattr(self, name) is not None), None)
        if self.oil_viscosity_40 is None:
            if known is not None:
                raise ParameterError("oil_viscosity_40", None, f"must be given, in mm²/s at 40 °C, with {known}")
        elif self.oil_viscosity_100 is not None and self.oil_viscosity_100 >= self.oil_viscosity_40:
            permitted = f"must be below oil_viscosity_40, {self.oil_viscosity_40:g} mm²/s"
            raise GeometryError("oil_viscosity_100", self.oil_viscosity_100, permitted, "mm²/s")


class RootShift(StrEnum):
    """The profile shift that root stresses go by."""

    GENERATING = "generating"
    """x_E of the tooth as cut: with its thinning (ISO 6336-3)."""

    NOMINAL = "nominal"
    """x, which is the default of KISSsoft."""


@dataclass(frozen=True, kw_only=True)
class _Standards:
    standard: Annotated[Edition, Words("standard of the rating")] = Edition.ISO_2006
    accuracy: Annotated[Accuracy, Words("standard of the accuracy grade")] = Accuracy.ISO_1995
    accuracy_grade: Annotated[int, Words("accuracy grade", "", "ISO 1328-1")] = AssumedCount(6)
    root_shift: Annotated[RootShift, Words("profile shift of root stresses", "x_E", "ISO 6336-3")] = RootShift.GENERATING


@dataclass(frozen=True, kw_only=True)
class RatingOptions(LubricantOptions, LoadFactorOptions, DutyOptions, _Standards):
    """The `standard`, the `accuracy_grade` of both gears in an edition of ISO 1328-1 (`accuracy`), and all else of a rating.

    The grade decides on K_v and, from grade 4 on, on the root stress of deep teeth; a gear may have its own. What stands for
    both gears as a number may be a list [pinion, wheel]. Raises ParameterError, and GeometryError for an oil with impossible
    properties.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        first, last = grades(self.accuracy)
        require_whole("accuracy_grade", self.accuracy_grade, at_least=first, at_most=last)
        self._check_duty()
        self._check_load_factors()
        self._check_lubricant()

    @property
    def asks_strength(self) -> bool:
        """Whether a required safety is given, which asks for a verdict on strength."""
        safeties = (self.required_safety_flank, self.required_safety_root, self.required_safety_scuffing)
        return any(each is not None and not is_assumed(each) for each in safeties)

    @property
    def given_compensation(self) -> float | None:
        """Deflection (µm) that a proven contact pattern compensates: by DIN 3990-1:1987 the given f_ma; else None.

        ISO 6336-1 takes the helix slope deviation of grade 5 (53), and so does DIN 3990-1 here where no f_ma is given.
        """
        return self.manufacturing_misalignment if self.standard is Edition.DIN_1987 else None

    def grade_of(self, gear: Gear) -> int:
        """Return a gear's own accuracy grade, or else that of both."""
        return self.accuracy_grade if gear.accuracy_grade is None else gear.accuracy_grade


_FIFTH = 5


def accuracy_grades(pair: GearPair, options: RatingOptions) -> PerGear[int]:
    """Return each gear's own accuracy grade, else that of the options."""
    return pair.gears.map(options.grade_of)


def base_pitch_deviations(pair: GearPair, options: RatingOptions) -> PerGear[float]:
    """f_pb = f_pt cos alpha_t. Raises ParameterError as `flank_tolerances` does."""
    if options.base_pitch_deviation is not None:
        return both(options.base_pitch_deviation)
    across = math.cos(math.radians(pair.pinion.transverse_pressure_angle))
    return _tolerances(pair, options).map(lambda each: across * each.single_pitch)


def profile_form_deviations(pair: GearPair, options: RatingOptions) -> PerGear[float]:
    """f_falpha. Raises ParameterError as `flank_tolerances` does."""
    if options.profile_form_deviation is not None:
        return both(options.profile_form_deviation)
    return _tolerances(pair, options).map(lambda each: each.profile_form)


def helix_slope_deviations(pair: GearPair, options: RatingOptions) -> PerGear[float]:
    """f_Hbeta. Raises ParameterError for sizes that the standard does not cover."""
    if options.helix_slope_deviation is not None:
        return both(options.helix_slope_deviation)
    grades = accuracy_grades(pair, options)

    def of(role: Role) -> float:
        return gear_tolerances(pair.gears.pick(role), grades.pick(role), options.accuracy).helix_slope

    return PerGear.each(of)


def helix_slopes_of_grade_five(pair: GearPair, options: RatingOptions) -> PerGear[float]:
    """f_Hbeta5, whatever the grades of the gears. Raises ParameterError for sizes that the standard does not cover."""
    return pair.gears.map(lambda gear: gear_tolerances(gear, _FIFTH, options.accuracy).helix_slope)


def _tolerances(pair: GearPair, options: RatingOptions) -> PerGear[FlankTolerances]:
    grades = accuracy_grades(pair, options)

    def of(gear: Gear, grade: int) -> FlankTolerances:
        return _of_sizes(grade, abs(gear.reference_diameter), gear.normal_module, options.accuracy)

    return PerGear.each(lambda role: of(pair.gears.pick(role), grades.pick(role)))


_of_sizes = lru_cache(64)(flank_tolerances)
"""Known for the last gears: loads of a spectrum and torques that are sought ask for them again."""
