"""Material of a gear: elastic constants, density, group and quality, and limits of strength."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, NamedTuple

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.quantities import (
    DENSITY,
    MODULUS,
    POISSON_RATIO,
    STRENGTH,
    WHEN_GIVEN,
    AssumedNumber,
    AssumedText,
    Range,
    Words,
    inputs_document,
    require_fields,
)
from gearcad.core.records import JsonObject, PerGear, concise, is_assumed
from gearcad.hardness_depth import Points, depth_points
from gearcad.material_shelf import FILE, properties_of

__all__ = [
    "GRADED_GROUPS",
    "STEEL_MODULUS",
    "Grade",
    "Limit",
    "Material",
    "MaterialGroup",
    "MaterialQuality",
    "Materials",
    "by_gear",
    "elastic_constants",
    "grade_of",
    "materials_document",
    "of_both",
]

STEEL_MODULUS = 206000.0
"""Young's modulus (MPa) of steel, used if no other value is given."""


class MaterialGroup(StrEnum):
    """Groups of gear materials under their abbreviations in ISO 6336-5."""

    STRUCTURAL_STEEL = "St"
    """Structural steel, wrought."""

    CAST_STEEL = "St (cast)"
    """Structural steel, cast."""

    THROUGH_HARDENED = "V"
    """Through-hardened alloy steel, wrought."""

    THROUGH_HARDENED_CARBON = "V (carbon)"
    """Through-hardened carbon steel, wrought."""

    THROUGH_HARDENED_CAST = "V (cast)"
    """Through-hardened alloy steel, cast."""

    THROUGH_HARDENED_CAST_CARBON = "V (cast carbon)"
    """Through-hardened carbon steel, cast."""

    NODULAR_IRON = "GGG"
    """Nodular cast iron, perlitic or bainitic."""

    FERRITIC_NODULAR_IRON = "GGG (ferr.)"
    MALLEABLE_IRON = "GTS"
    GREY_IRON = "GG"
    CASE_HARDENED = "Eh"
    SURFACE_HARDENED = "IF"
    """Flame or induction hardened."""

    NITRIDING_STEEL = "NT"
    """Nitriding steel, nitrided."""

    NITRIDED = "NV"
    """Through-hardening or case-hardening steel, nitrided."""

    NITROCARBURISED = "NV (nitrocar.)"
    """The same, nitrocarburised."""

    PLASTIC = "plastic"
    """Thermoplastic, rated by VDI 2736-2; ISO 6336-5 does not have it."""


GRADED_GROUPS = tuple(group for group in MaterialGroup if group is not MaterialGroup.PLASTIC)
"""Groups that have qualities in ISO 6336-5."""


class MaterialQuality(StrEnum):
    """Quality: the demands on material and heat treatment in ISO 6336-5."""

    MODEST = "ML"
    USUAL = "MQ"
    HIGH = "ME"


class Grade(NamedTuple):
    """A group in a quality, such as Eh MQ: what ISO 6336-5 has endurance limits for."""

    group: MaterialGroup
    quality: MaterialQuality

    def __str__(self) -> str:
        return f"{self.group.value} {self.quality.value}"


_GRADE = re.compile(
    rf"({'|'.join(re.escape(group.value) for group in GRADED_GROUPS)}) +({'|'.join(each.value for each in MaterialQuality)})"
)


def grade_of(name: str) -> Grade | None:
    """Return the grade that a name such as "Eh MQ" or "GGG (ferr.) ML" stands for; None for any other name."""
    found = _GRADE.fullmatch(name.strip())
    return None if found is None else Grade(MaterialGroup(found[1]), MaterialQuality(found[2]))


_HARDNESS = Range("", 50.0, 1500.0)
"""HV or HBW, as ISO 6336-5 has it of the group; there are the limits of each."""

_CORE_HARDNESS = Range("HRC", 10.0, 60.0)
_CASE_DEPTH = Range("mm", 0.01, 50.0)
_SHEAR_RATIO = Range("MPa/HV", 0.05, 2.0)
_HARDNESS_BOUNDS, _RESIDUAL_BOUNDS = (50.0, 1500.0, "HV"), (-3000.0, 3000.0, "MPa")

WEAR_COEFFICIENT = Range("mm³/(N·m)", 1e-15, 1.0)
"""Volume (mm³) that is worn off for each N of normal force and m of sliding."""

ROOM_TEMPERATURE = 23.0
"""Temperature (°C) at which a table's properties of a plastic stand in `Material`, as near as the table has it."""

_PLASTIC_RATIO, _PLASTIC_DENSITY = AssumedNumber(0.4), AssumedNumber(1400.0)
"""Poisson's ratio and density (kg/m³) of a plastic for which neither a spec nor a table has them."""


class TabledNumber(float):
    """A number of a material's table, where its value at room temperature stands for a curve over temperature."""

    __slots__ = ()

    tabled = True


Limit = float | tuple[float, float] | None
"""An allowable stress (MPa), the range in which it lies, or none."""


@dataclass(frozen=True, kw_only=True)
class Material:
    """Linear elastic material. `youngs_modulus` and the limits in MPa, `density` in kg/m³.

    `contact_limit` and `root_limit` are what a check holds local stresses against, or the range (low, high) in which that
    of the material lies; None gives no verdict. `group` says how flanks run in, and `contact_endurance_limit` (sigma_H_lim,
    MPa) how much where they are not hardened on the surface. With a `quality`, and the `hardness` of the flanks (HV; HBW of
    St, GGG, GTS and GG), a group has endurance limits by ISO 6336-5, unless they are given; `core_hardness` (HRC) counts
    for Eh MQ. A name such as "Eh MQ" gives group and quality. `yield_strength` is sigma_S or sigma_0.2, `tensile_strength`
    sigma_B, `wear_coefficient` k_w (mm³/(N·m)) that of Archard's law. What is below a flank: `hardness_profile`, pairs of depth
    (mm) and HV, or `case_depth` (mm) with `hardness` and `case_core_hardness` (HV); `residual_stress`, pairs of depth and MPa;
    `shear_ratio` K_tau (MPa/HV). A plastic takes what is not given from the row of its
    name in `materials.csv`. Raises ParameterError, and GeometryError for a group or a quality that is not that of the name.
    """

    name: Annotated[str, Words("material")] = AssumedText("steel")
    youngs_modulus: Annotated[float, MODULUS, Words("Young's modulus", "E")] = AssumedNumber(STEEL_MODULUS)
    poisson_ratio: Annotated[float, POISSON_RATIO, Words("Poisson's ratio", "ν")] = AssumedNumber(0.3)
    density: Annotated[float, DENSITY, Words("density", "ρ")] = AssumedNumber(7850.0)
    yield_strength: Annotated[float | None, STRENGTH, Words("yield strength", "σ_y")] = None
    contact_limit: Annotated[Limit, STRENGTH, Words("given limit of contact pressure")] = None
    root_limit: Annotated[Limit, STRENGTH, Words("given limit of local root stress")] = None
    group: Annotated[MaterialGroup | None, Words("material group", "", "ISO 6336-5")] = None
    contact_endurance_limit: Annotated[
        float | None, STRENGTH, Words("endurance limit of contact stress", "σ_Hlim", "ISO 6336-5")
    ] = None
    root_endurance_limit: Annotated[float | None, STRENGTH, Words("endurance limit of root stress", "σ_Flim", "ISO 6336-5")] = (
        None
    )
    quality: Annotated[MaterialQuality | None, Words("material quality", "", "ISO 6336-5")] = None
    hardness: Annotated[float | None, _HARDNESS, Words("hardness of the flanks (HV or HBW)", "", "ISO 6336-5")] = None
    core_hardness: Annotated[float | None, _CORE_HARDNESS, Words("hardness of the core", "", "ISO 6336-5")] = None
    tensile_strength: Annotated[float | None, STRENGTH, Words("tensile strength", "σ_B")] = None
    wear_coefficient: Annotated[float | None, WEAR_COEFFICIENT, Words("wear coefficient", "k_w", "VDI 2736-2"), WHEN_GIVEN] = (
        None
    )

    hardness_profile: Annotated[Points | None, Words("hardness over depth", "HV"), WHEN_GIVEN] = None
    case_depth: Annotated[float | None, _CASE_DEPTH, Words("case depth at 550 HV", "CHD"), WHEN_GIVEN] = None
    case_core_hardness: Annotated[float | None, _HARDNESS, Words("hardness below the case", "HV"), WHEN_GIVEN] = None
    residual_stress: Annotated[Points | None, Words("residual stress over depth", "σ_r"), WHEN_GIVEN] = None
    shear_ratio: Annotated[
        float | None, _SHEAR_RATIO, Words("permissible shear stress over hardness", "K_τ", "ISO/TS 6336-4"), WHEN_GIVEN
    ] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise ParameterError("name", self.name, "must be a text")
        require_fields(self)
        for name, bounds in (("hardness_profile", _HARDNESS_BOUNDS), ("residual_stress", _RESIDUAL_BOUNDS)):
            if (given := getattr(self, name)) is not None:
                object.__setattr__(self, name, depth_points(name, given, *bounds))
        self._take_grade()
        if self.plastic:
            self._take_properties()
        for name in ("contact_limit", "root_limit"):
            if isinstance(value := getattr(self, name), list | tuple):
                object.__setattr__(self, name, _range(name, value))

    def _take_grade(self) -> None:
        """Group and quality of a name that stands for them. Raises GeometryError where others are given."""
        named = grade_of(self.name)
        for field, value in () if named is None else named._asdict().items():
            given = getattr(self, field)
            if given not in (None, value):
                permitted = f"must be {value.value}, or left out, with the name {self.name}"
                raise GeometryError(field, given, permitted)
            object.__setattr__(self, field, value)

    def _take_properties(self) -> None:
        """Constants of a plastic that are not given: of its table, or assumed. Raises GeometryError and ParameterError."""
        if self.quality is not None:
            raise GeometryError("quality", self.quality, f"must be left out with the group {MaterialGroup.PLASTIC.value}")
        if is_assumed(self.name):
            object.__setattr__(self, "name", AssumedText("plastic"))
        tables = properties_of(self.name)
        usual = {"youngs_modulus": None, "poisson_ratio": _PLASTIC_RATIO, "density": _PLASTIC_DENSITY}
        for field, assumed in usual.items():
            given = getattr(self, field)
            if not is_assumed(given) and not isinstance(given, TabledNumber):
                continue
            found = assumed if field not in tables else TabledNumber(tables[field].nearest(ROOM_TEMPERATURE))
            if found is None:
                permitted = f"must be given for a plastic, in MPa, or in {FILE} under the name {self.name}"
                raise ParameterError(field, None, permitted)
            object.__setattr__(self, field, found)

    @property
    def plastic(self) -> bool:
        """Whether the material is a plastic, which VDI 2736-2 rates."""
        return self.group is MaterialGroup.PLASTIC

    @property
    def asks_strength(self) -> bool:
        """Whether a limit or a quality is given, or the material is a plastic, which asks for a verdict on strength."""
        limits = (self.contact_limit, self.root_limit, self.contact_endurance_limit, self.root_endurance_limit)
        return self.plastic or self.quality is not None or any(each is not None for each in limits)

    @property
    def grade(self) -> Grade | None:
        """Group and quality, if both are known."""
        return None if self.group is None or self.quality is None else Grade(self.group, self.quality)


Materials = Material | PerGear[Material]
"""The material of both gears, or of each."""


def of_both(material: Materials) -> PerGear[Material]:
    """Return the materials of both gears; one material may stand for both."""
    return PerGear(material, material) if isinstance(material, Material) else material


def by_gear(material: Materials) -> dict[str, Material]:
    """Return the materials under "pinion" and "wheel", or one under "" if both are the same."""
    materials = of_both(material)
    if materials.pinion == materials.wheel:
        return {"": materials.pinion}
    return {role.value: each for role, each in materials.items()}


def materials_document(material: Materials) -> JsonObject:
    """Return the materials as documents have them: "material" of both, or "materials" by gear."""
    if isinstance(material, Material):
        return {"material": inputs_document(material)}
    return {"materials": {role.value: inputs_document(each) for role, each in material.items()}}


def elastic_constants(materials: PerGear[Material]) -> tuple[PerGear[float], PerGear[float]]:
    """Return E (MPa) and nu of both gears."""
    return materials.map(lambda material: material.youngs_modulus), materials.map(lambda material: material.poisson_ratio)


def _range(name: str, values: Sequence[float]) -> tuple[float, float]:
    """Return two limits, the lower one first."""
    if len(values) != 2 or values[0] >= values[1]:
        raise ParameterError(name, list(values), "must be a number, or a range [low, high]", "MPa")
    return float(values[0]), float(values[1])
