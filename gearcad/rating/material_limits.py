"""Endurance limits of ISO 6336-5:2016, sigma_Hlim and sigma_Flim, by group, quality and hardness of a material.

Within its range of hardness x a limit is a straight line A x + B (clause 5, table 1). The coefficients rest on one public
transcription, not on the text of the standard, so that what is taken from here is to be verified.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple, TypeVar

from gearcad.core.errors import GeometryError, ParameterError, format_number
from gearcad.core.records import PerGear
from gearcad.material import Grade, Material, MaterialGroup, MaterialQuality

_T = TypeVar("_T")


class Family(Enum):
    """The columns of the tables of ISO 6336-2 and -3."""

    STRUCTURAL = "St"
    THROUGH_HARDENED = "V"
    """Through hardened steels, with perlitic and bainitic nodular iron and malleable iron."""

    GREY_IRON = "GG"
    FERRITIC_NODULAR_IRON = "GGG (ferr.)"
    CASE_HARDENED = "Eh"
    SURFACE_HARDENED = "IF"
    NITRIDED = "NT, NV"
    NITROCARBURISED = "NV (nitrocar.)"

    @classmethod
    def of(cls, group: MaterialGroup) -> Family:
        """Return the family of a group of materials. Raises GeometryError for a plastic."""
        if group is MaterialGroup.PLASTIC:
            raise GeometryError("material.group", group.value, "must be a metal: ISO 6336 has no factors of plastics")
        return _FAMILIES[group]


_FAMILIES = {
    MaterialGroup.STRUCTURAL_STEEL: Family.STRUCTURAL,
    MaterialGroup.CAST_STEEL: Family.STRUCTURAL,
    MaterialGroup.THROUGH_HARDENED: Family.THROUGH_HARDENED,
    MaterialGroup.THROUGH_HARDENED_CARBON: Family.THROUGH_HARDENED,
    MaterialGroup.THROUGH_HARDENED_CAST: Family.THROUGH_HARDENED,
    MaterialGroup.THROUGH_HARDENED_CAST_CARBON: Family.THROUGH_HARDENED,
    MaterialGroup.NODULAR_IRON: Family.THROUGH_HARDENED,
    MaterialGroup.MALLEABLE_IRON: Family.THROUGH_HARDENED,
    MaterialGroup.FERRITIC_NODULAR_IRON: Family.FERRITIC_NODULAR_IRON,
    MaterialGroup.GREY_IRON: Family.GREY_IRON,
    MaterialGroup.CASE_HARDENED: Family.CASE_HARDENED,
    MaterialGroup.SURFACE_HARDENED: Family.SURFACE_HARDENED,
    MaterialGroup.NITRIDING_STEEL: Family.NITRIDED,
    MaterialGroup.NITRIDED: Family.NITRIDED,
    MaterialGroup.NITROCARBURISED: Family.NITROCARBURISED,
}

_CAST_STEELS = (
    MaterialGroup.CAST_STEEL,
    MaterialGroup.THROUGH_HARDENED_CAST,
    MaterialGroup.THROUGH_HARDENED_CAST_CARBON,
)


def per_family(columns: Mapping[tuple[Family, ...], _T]) -> dict[Family, _T]:
    """Return a table as the standard prints it, where families share columns, by family."""
    return {family: entry for families, entry in columns.items() for family in families}


def is_cast_steel(group: MaterialGroup) -> bool:
    """Structural or through-hardened steel that was cast."""
    return group in _CAST_STEELS


STANDARD = "ISO 6336-5:2016"

_GIVEN = "given"
_ML, _MQ, _ME = MaterialQuality.MODEST, MaterialQuality.USUAL, MaterialQuality.HIGH


class _Line(NamedTuple):
    """A limit (MPa) by hardness: A x + B from `least` to `most`, beyond `flat` no higher; a constant has no range."""

    slope: float
    constant: float
    least: float
    most: float
    flat: float | None = None

    def at(self, hardness: float | None) -> float:
        """Return the limit (MPa) at a hardness that is in the range; a constant limit needs no hardness."""
        if hardness is None:
            return self.constant
        return self.slope * min(hardness, self.most if self.flat is None else self.flat) + self.constant


_Lines = Mapping[MaterialQuality, tuple[_Line, _Line]]
"""Lines of each quality: for the contact, and for the root."""

_Ranges = Mapping[MaterialQuality, tuple[float, float]]
_Coefficients = Sequence[tuple[float, ...]]


def _lines(ranges: _Ranges, contact: _Coefficients, root: _Coefficients, of_root: _Ranges | None = None) -> _Lines:
    """Return the lines of contact and root for each material quality.

    `contact` and `root` are coefficients (A, B) or (A, B, flat) for ML, MQ and ME; the lines of the root may have ranges
    `of_root`.
    """
    return {
        quality: (_line(contact[number], ranges[quality]), _line(root[number], (of_root or ranges)[quality]))
        for number, quality in enumerate(MaterialQuality)
    }


def _line(coefficients: tuple[float, ...], limits: tuple[float, float]) -> _Line:
    slope, constant, *flat = coefficients
    return _Line(slope, constant, *limits, *flat)


def _all(least: float, most: float) -> dict[MaterialQuality, tuple[float, float]]:
    return dict.fromkeys(MaterialQuality, (least, most))


_NODULAR = _lines(
    {**_all(175, 300), _ME: (200, 300)},
    [(1.434, 211), (1.434, 211), (1.500, 250)],
    [(0.350, 119), (0.350, 119), (0.380, 134)],
)

_LINES: dict[MaterialGroup, _Lines] = {
    MaterialGroup.STRUCTURAL_STEEL: _lines(
        _all(110, 210),
        [(1.000, 190), (1.000, 190), (1.520, 250)],
        [(0.455, 69), (0.455, 69), (0.386, 147)],
    ),
    MaterialGroup.CAST_STEEL: _lines(
        _all(140, 210),
        [(0.986, 131), (0.986, 131), (1.143, 237)],
        [(0.313, 62), (0.313, 62), (0.254, 137)],
    ),
    MaterialGroup.MALLEABLE_IRON: _lines(
        {**_all(135, 250), _ME: (175, 250)},
        [(1.371, 143), (1.371, 143), (1.333, 267)],
        [(0.345, 77), (0.345, 77), (0.403, 128)],
    ),
    MaterialGroup.NODULAR_IRON: _NODULAR,
    MaterialGroup.FERRITIC_NODULAR_IRON: _NODULAR,
    MaterialGroup.GREY_IRON: _lines(
        {**_all(150, 240), _ME: (175, 275)},
        [(1.033, 132), (1.033, 132), (1.465, 122)],
        [(0.256, 8), (0.256, 8), (0.200, 53)],
    ),
    MaterialGroup.THROUGH_HARDENED_CARBON: _lines(
        _all(135, 210),
        [(0.963, 283), (0.925, 360), (0.838, 432)],
        [(0.250, 108), (0.240, 163), (0.283, 202)],
        of_root=_all(115, 215),
    ),
    MaterialGroup.THROUGH_HARDENED: _lines(
        {**_all(200, 360), _ME: (200, 390)},
        [(1.313, 188), (1.313, 373), (2.213, 260)],
        [(0.423, 104), (0.425, 187), (0.358, 231)],
    ),
    MaterialGroup.THROUGH_HARDENED_CAST_CARBON: _lines(
        _all(130, 215),
        [(0.831, 300), (0.831, 300), (0.951, 345)],
        [(0.224, 117), (0.224, 117), (0.286, 167)],
    ),
    MaterialGroup.THROUGH_HARDENED_CAST: _lines(
        _all(200, 360),
        [(1.276, 298), (1.276, 298), (1.350, 356)],
        [(0.364, 161), (0.364, 161), (0.356, 186)],
    ),
    MaterialGroup.CASE_HARDENED: _lines(
        {**_all(660, 800), _ML: (600, 800)},
        [(0, 1300), (0, 1500), (0, 1650)],
        [(0, 312), (0, 425), (0, 525)],
    ),
    MaterialGroup.SURFACE_HARDENED: _lines(
        {**_all(500, 615), _ML: (485, 615)},
        [(0.740, 602), (0.541, 882), (0.505, 1013)],
        [(0.305, 76), (0.138, 290, 570), (0.271, 237)],
    ),
    MaterialGroup.NITRIDING_STEEL: _lines(
        _all(650, 900),
        [(0, 1125), (0, 1250), (0, 1450)],
        [(0, 270), (0, 420), (0, 468)],
    ),
    MaterialGroup.NITRIDED: _lines(
        _all(450, 650),
        [(0, 788), (0, 998), (0, 1217)],
        [(0, 258), (0, 363), (0, 432)],
    ),
    MaterialGroup.NITROCARBURISED: _lines(
        _all(300, 650),
        [(0, 650), (1.167, 425, 450), (1.167, 425, 450)],
        [(0, 224), (0.653, 94, 450), (0.653, 94, 450)],
    ),
}

_BRINELL = (
    MaterialGroup.STRUCTURAL_STEEL,
    MaterialGroup.CAST_STEEL,
    MaterialGroup.MALLEABLE_IRON,
    MaterialGroup.NODULAR_IRON,
    MaterialGroup.FERRITIC_NODULAR_IRON,
    MaterialGroup.GREY_IRON,
)

_CASE_MQ = Grade(MaterialGroup.CASE_HARDENED, _MQ)
_SOFT_CORE, _HARD_CORE, _HARD_CORE_LIMIT = 25.0, 30.0, 500.0
"""HRC that the core of Eh MQ has at least; from which on its root endures more, and how much (MPa).

Between the two it is 461 MPa if the steel hardens well enough (Jominy), which is not asked for: 425 MPa is the safe side.
"""


@dataclass(frozen=True, kw_only=True)
class EnduranceLimits:
    """sigma_Hlim and sigma_Flim (MPa) of a material, and where each is from; where it is None, why it is not known."""

    contact: float | None
    root: float | None
    contact_source: str
    root_source: str

    @property
    def verify(self) -> tuple[str, ...]:
        """Symbols of limits from the table of the standard, which was not at hand."""
        sources = {"sigma_Hlim": self.contact_source, "sigma_Flim": self.root_source}
        return tuple(symbol for symbol, source in sources.items() if source.startswith(STANDARD))


def hardness_scale(group: MaterialGroup) -> str:
    """Return the hardness scale, HBW or HV, in which the standard has limits of a group."""
    return "HBW" if group in _BRINELL else "HV"


def endurance_limits(material: Material) -> EnduranceLimits:
    """Limits that are given, else those of its grade at its hardness; None of both without a grade.

    Raises ParameterError for a hardness that is outside the range of the grade, or is not given where limits depend on it.
    """
    contact, contact_source = _limit(material, material.contact_endurance_limit, root=False)
    root, root_source = _limit(material, material.root_endurance_limit, root=True)
    return EnduranceLimits(contact=contact, root=root, contact_source=contact_source, root_source=root_source)


def endurance_limits_of(materials: PerGear[Material]) -> PerGear[EnduranceLimits]:
    """Return the endurance limits of both gears. Raises ParameterError.

    Errors name the gear, unless both gears are of one material.
    """
    if materials.pinion == materials.wheel:
        both = endurance_limits(materials.pinion)
        return PerGear(both, both)
    return materials.map(endurance_limits)


def _limit(material: Material, given: float | None, *, root: bool) -> tuple[float | None, str]:
    """Return a limit (MPa) of contact or root and its source; None and the reason if it is not known."""
    if given is not None:
        return given, _GIVEN
    if material.plastic:
        return None, "VDI 2736-2, by temperature and load cycles"
    if (grade := material.grade) is None:
        lacking = "group" if material.group is None else "quality"
        return None, f"not known: the material has no {lacking}, and no limit is given"
    line = _LINES[grade.group][grade.quality][root]
    _require_hardness(material.hardness, line, grade)
    source = f"{STANDARD}, {grade}"
    if material.hardness is not None:
        source += f", {format_number(material.hardness)} {hardness_scale(grade.group)}"
    core = material.core_hardness
    if not root or grade != _CASE_MQ or core is None:
        return line.at(material.hardness), source
    if core < _SOFT_CORE:
        permitted = f"must be at least {_SOFT_CORE:g} HRC for {grade} ({STANDARD}); or give root_endurance_limit itself"
        raise ParameterError("material.core_hardness", core, permitted, "HRC")
    limit = _HARD_CORE_LIMIT if core >= _HARD_CORE else line.at(material.hardness)
    return limit, f"{source}, core {format_number(core)} HRC"


def _require_hardness(hardness: float | None, line: _Line, grade: Grade) -> None:
    """Raise ParameterError unless a limit is known at this hardness."""
    scale = hardness_scale(grade.group)
    span = f"from {line.least:g} to {line.most:g} {scale}, for which {STANDARD} has limits of {grade}"
    if hardness is None and line.slope:
        raise ParameterError("material.hardness", None, f"must be given, {span}; or give the endurance limits themselves")
    if hardness is not None and not line.least <= hardness <= line.most:
        raise ParameterError("material.hardness", hardness, f"must be {span}", scale)
