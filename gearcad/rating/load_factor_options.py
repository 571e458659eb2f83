"""What of the [rating] table says how load factors are found: of speed, across the face width, between pairs of teeth."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Literal

from gearcad.ranges import LENGTH, OFFSET, Range
from gearcad.rating.both import Both, take_both
from gearcad.schema import AssumedNumber, Words

__all__ = ["AlphaDeviation", "BearingArrangement", "ContactPattern", "HelixModification", "LoadFactorOptions"]

_FACTOR = Range("", 1.0, 100.0)
_DEVIATION = Range("µm", 0.0, 1e4)


class HelixModification(StrEnum):
    """How flanks are taken back along the face width: B_1 and B_2 of ISO 6336-1, table 8."""

    NONE = "none"
    CROWNING = "crowning"
    """By half of f_ma."""

    FULL_CROWNING = "full crowning"
    """By half of f_ma + f_sh."""

    HELIX_CORRECTION = "helix correction"
    """To what the load makes of the shafts."""

    CORRECTION_AND_CROWNING = "helix correction and crowning"
    END_RELIEF = "end relief"


class ContactPattern(StrEnum):
    """Whether the contact pattern shows that misalignments of manufacture and of shafts lie opposite."""

    UNPROVEN = "unproven"
    PROVEN = "proven"


class BearingArrangement(StrEnum):
    """Where the pinion stands on its shaft: figure 13 of ISO 6336-1."""

    BETWEEN_NEAR = "a"
    """Between bearings, torque from the side of the nearer one."""

    BETWEEN_FAR = "b"
    """Between bearings, torque from the side of the farther one."""

    OVERHUNG = "c"
    SECOND_MESH_NEAR = "d"
    """On a shaft with another gear."""

    SECOND_MESH_FAR = "e"


class AlphaDeviation(StrEnum):
    """Which deviation y_alpha is taken from, where K_Halpha goes by f_falpha because it is larger than f_pb."""

    LITERAL = "literal"
    """From the same one."""

    KISSSOFT_2017 = "KISSsoft 2017"
    """From f_pb: what that program does."""


@dataclass(frozen=True, kw_only=True)
class LoadFactorOptions:
    """Methods or values of the load factors, and what they go by. Deviations in µm, lengths in mm.

    What may differ per gear is a number for both, or a list [pinion, wheel].
    """

    dynamic_factor: Annotated[
        float | Literal["B", "C"], Range("", 0.1, 100.0), Words("dynamic factor, or its method", "K_v", "ISO 6336-1")
    ] = "B"
    face_load_factor: Annotated[
        float | Literal["C", "fe"], _FACTOR, Words("face load factor, or its method", "K_Hβ", "ISO 6336-1")
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
    manufacturing_misalignment: Annotated[
        float | None, _DEVIATION, Words("misalignment by manufacture", "f_ma", "ISO 6336-1")
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

    def _check_load_factors(self) -> None:
        """Lists of both gears. Raises ParameterError."""
        take_both(self, "base_pitch_deviation", "profile_form_deviation", "helix_slope_deviation")
