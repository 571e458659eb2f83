"""Tolerances of gear flanks by ISO 1328-1 (1995 and 2013) and ISO 1328-2:1997. Deviations in µm, lengths in mm.

A grade more is the square root of 2 more; values are rounded as the standard has them. A grade of 1995 and the class of 2013
of the same number are not the same tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from types import MappingProxyType
from typing import Generic, NamedTuple, Protocol

import numpy as np

from gearcad.core.errors import ParameterError, require_whole
from gearcad.core.quantities import Range, Whole
from gearcad.core.records import JsonObject
from gearcad.core.values import Values, number_or_array
from gearcad.geometry import Gear
from gearcad.rating import iso1328_1995, iso1328_2013
from gearcad.rating.editions import graded


class Accuracy(StrEnum):
    """The editions of the standard, whose grades are not the same."""

    ISO_1995 = "ISO 1328-1:1995"
    """Accuracy grades 0 to 12, to which ISO 6336:2006 refers."""

    ISO_2013 = "ISO 1328-1:2013"
    """Flank tolerance classes 1 to 11."""


class Equations(Protocol):
    """Equations of tolerances that both editions have."""

    def single_pitch(self, d: Values, m_n: Values, /) -> Values: ...
    def sector_pitch(self, d: Values, m_n: Values, k: Values, teeth: Values, /) -> Values: ...
    def cumulative_pitch(self, d: Values, m_n: Values, /) -> Values: ...
    def profile_slope(self, d: Values, m_n: Values, /) -> Values: ...
    def profile_form(self, d: Values, m_n: Values, /) -> Values: ...
    def profile_total(self, d: Values, m_n: Values, /) -> Values: ...
    def helix_slope(self, d: Values, b: Values, /) -> Values: ...
    def helix_form(self, d: Values, b: Values, /) -> Values: ...
    def helix_total(self, d: Values, b: Values, /) -> Values: ...
    def runout(self, d: Values, m_n: Values, /) -> Values: ...


_EQUATIONS: Mapping[Accuracy, Equations] = {Accuracy.ISO_1995: iso1328_1995, Accuracy.ISO_2013: iso1328_2013}
_GRADES = {Accuracy.ISO_1995: (0, 12), Accuracy.ISO_2013: (1, 11)}

_MODULES = Range("mm", 0.5, 70)
_COVERED: Mapping[Accuracy, Mapping[str, Range | Whole]] = {
    Accuracy.ISO_1995: MappingProxyType(
        {"reference_diameter": Range("mm", 5, 10_000), "normal_module": _MODULES, "face_width": Range("mm", 4, 1000)}
    ),
    Accuracy.ISO_2013: MappingProxyType(
        {
            "teeth": Whole(5, 1000),
            "helix_angle": Range("deg", 0, 45),
            "reference_diameter": Range("mm", 5, 15_000),
            "normal_module": _MODULES,
            "face_width": Range("mm", 4, 1200),
        }
    ),
}


def equations(accuracy: Accuracy) -> Equations:
    """Return the equations of an edition, for grade 5."""
    return _EQUATIONS[accuracy]


def covered(accuracy: Accuracy) -> Mapping[str, Range | Whole]:
    """Return the sizes that an edition covers, as magnitudes; one that is not named is not limited."""
    return _COVERED[accuracy]


def grades(accuracy: Accuracy) -> tuple[int, int]:
    """First and last grade of an edition."""
    return _GRADES[accuracy]


_OF_BOTH = {
    "f_pt": "single_pitch",
    "F_pk": "sector_pitch",
    "F_p": "cumulative_pitch",
    "f_Halpha": "profile_slope",
    "f_falpha": "profile_form",
    "F_alpha": "profile_total",
    "f_Hbeta": "helix_slope",
    "f_fbeta": "helix_form",
    "F_beta": "helix_total",
    "F_r": "runout",
}
_OF_1995 = {"F_i2": "radial_composite", "f_i2": "radial_tooth_to_tooth"}
_SYMBOLS = {
    Accuracy.ISO_1995: _OF_BOTH | _OF_1995,
    Accuracy.ISO_2013: {f"{'f_p' if symbol == 'f_pt' else symbol}T": name for symbol, name in _OF_BOTH.items()},
}
"""The standard's symbols in ASCII, and the properties that they stand for: F_i2 and f_i2 are F_i'' and f_i''."""

_RECALLED = {Accuracy.ISO_1995: ("F_i2", "f_i2"), Accuracy.ISO_2013: ("F_pkT",)}
"""Tolerances whose standard was not at hand: the ranges of sizes of radial composite deviations, and the equation of F_pkT."""

_RADIAL_DIAMETER = Range("mm", 5, 10_000)
_RADIAL_MODULE = Range("mm", 0.2, 70)
_RADIAL_GRADES = (4, 12)
_CONTACT_RATIO = Range("", 0, None, ends="(]")


@dataclass(frozen=True, kw_only=True)
class GearTolerances(Generic[Values]):
    """Tolerances in µm of flanks of a `grade` in an edition of ISO 1328-1 and, with that of 1995, in ISO 1328-2:1997.

    Sizes (mm, deg) are magnitudes: numbers, or arrays that broadcast against each other. `face_width` is that of the teeth of
    one hand. Each tolerance raises ParameterError where a number is none that the standard covers, and is nan at such elements
    of arrays. Raises ParameterError for another grade.
    """

    accuracy: Accuracy
    grade: int
    teeth: Values
    reference_diameter: Values
    normal_module: Values
    face_width: Values
    helix_angle: Values

    def __post_init__(self) -> None:
        first, last = grades(self.accuracy)
        require_whole("accuracy_grade", self.grade, at_least=first, at_most=last)

    # ------------------------------------------------------------------ pitch

    @property
    def single_pitch(self) -> Values:
        """Single pitch deviation f_pt (ISO 1328-1:1995) or f_pT (2013)."""
        return self._graded(equations(self.accuracy).single_pitch(self._diameter, self._module))

    @property
    def sector_pitch(self) -> Values:
        """F_pk; F_pkT: over `sector_pitches`."""
        sizes = self._diameter, self._module, self.sector_pitches, self.teeth
        return self._graded(equations(self.accuracy).sector_pitch(*sizes))

    @property
    def sector_pitches(self) -> Values:
        """k, two at least: z/8 cut off to a whole number by ISO 1328-1:1995, rounded by the edition of 2013."""
        eighth = np.divide(self.teeth, 8) + (0.0 if self.accuracy is Accuracy.ISO_1995 else 0.5)
        return number_or_array(self.teeth, np.maximum(np.floor(eighth), 2.0))

    @property
    def cumulative_pitch(self) -> Values:
        """F_p; F_pT."""
        return self._graded(equations(self.accuracy).cumulative_pitch(self._diameter, self._module))

    @property
    def runout(self) -> Values:
        """F_r; F_rT."""
        return self._graded(equations(self.accuracy).runout(self._diameter, self._module))

    # ------------------------------------------------------------------ profile and helix

    @property
    def profile_slope(self) -> Values:
        """Profile slope deviation f_Halpha (1995) or f_HalphaT (2013)."""
        return self._graded(equations(self.accuracy).profile_slope(self._diameter, self._module))

    @property
    def profile_form(self) -> Values:
        """Profile form deviation f_falpha (1995) or f_falphaT (2013)."""
        return self._graded(equations(self.accuracy).profile_form(self._diameter, self._module))

    @property
    def profile_total(self) -> Values:
        """F_alpha; F_alphaT."""
        return self._graded(equations(self.accuracy).profile_total(self._diameter, self._module))

    @property
    def helix_slope(self) -> Values:
        """Helix slope deviation f_Hbeta (1995) or f_HbetaT (2013)."""
        return self._graded(equations(self.accuracy).helix_slope(self._diameter, self._width))

    @property
    def helix_form(self) -> Values:
        """Helix form deviation f_fbeta (1995) or f_fbetaT (2013)."""
        return self._graded(equations(self.accuracy).helix_form(self._diameter, self._width))

    @property
    def helix_total(self) -> Values:
        """F_beta; F_betaT."""
        return self._graded(equations(self.accuracy).helix_total(self._diameter, self._width))

    # ------------------------------------------------------------------ composite, 1995 and 1997 alone

    @property
    def radial_composite(self) -> Values:
        """F_i''; raises ParameterError for grades below 4, and for a class of 2013."""
        return graded(iso1328_1995.radial_composite(*self._radial_sizes), self.grade)

    @property
    def radial_tooth_to_tooth(self) -> Values:
        """f_i'', likewise."""
        return graded(iso1328_1995.radial_tooth_to_tooth(*self._radial_sizes), self.grade)

    def tooth_to_tooth(self, total_contact_ratio: Values) -> Values:
        """f_i' = K (4.3 + f_pt + F_alpha) of grade 5, with K = 0.2 (ε_γ + 4)/ε_γ, from ε_γ = 4 on 0.4.

        With tolerances that are not rounded (ISO 1328-1:1995, annex A). Raises ParameterError for a class of 2013.
        """
        return self._graded(self._tooth_to_tooth(total_contact_ratio))

    def single_flank_composite(self, total_contact_ratio: Values) -> Values:
        """F_i' = F_p + f_i', likewise."""
        pitch = iso1328_1995.cumulative_pitch(self._diameter, self._module)
        return self._graded(pitch + self._tooth_to_tooth(total_contact_ratio))

    def _tooth_to_tooth(self, total_contact_ratio: Values) -> Values:
        self._require_1995()
        ratio = _within("total_contact_ratio", total_contact_ratio, _CONTACT_RATIO)
        d, m_n = self._diameter, self._module
        share = 0.2 * (4 / np.minimum(ratio, 4.0) + 1)
        pair = 4.3 + iso1328_1995.single_pitch(d, m_n) + iso1328_1995.profile_total(d, m_n)
        return number_or_array(total_contact_ratio, np.multiply(share, pair))

    @property
    def _radial_sizes(self) -> tuple[Values, Values]:
        self._require_1995()
        require_whole("accuracy_grade", self.grade, at_least=_RADIAL_GRADES[0], at_most=_RADIAL_GRADES[1])
        diameter = _within("reference_diameter", self.reference_diameter, _RADIAL_DIAMETER)
        return diameter, _within("normal_module", self.normal_module, _RADIAL_MODULE)

    def _require_1995(self) -> None:
        if self.accuracy is not Accuracy.ISO_1995:
            permitted = f'must be "{Accuracy.ISO_1995.value}" for composite deviations: this edition has no equation for them'
            raise ParameterError("accuracy", self.accuracy.value, permitted)

    # ------------------------------------------------------------------ all of them

    def to_dict(self, total_contact_ratio: Values | None = None) -> JsonObject:
        """Return the tolerances (µm) under the standard's symbols in ASCII.

        Those that it does not cover are None, and `not_covered` says why.

        `verify` names those that rest on a text that was not at hand.
        With a contact ratio a grade of 1995 also has f_i1 and F_i1, which are f_i' and F_i' (as F_i2 is F_i'').
        """
        each: dict[str, Callable[[], Values]] = {
            symbol: partial(getattr, self, name) for symbol, name in _SYMBOLS[self.accuracy].items()
        }
        if self.accuracy is Accuracy.ISO_1995 and total_contact_ratio is not None:
            each["f_i1"] = partial(self.tooth_to_tooth, total_contact_ratio)
            each["F_i1"] = partial(self.single_flank_composite, total_contact_ratio)
        found: dict[str, Values | None] = dict.fromkeys(each)
        reasons: dict[str, None] = {}
        for symbol, tolerance in each.items():
            try:
                found[symbol] = tolerance()
            except ParameterError as error:
                reasons[str(error)] = None
        verify = [symbol for symbol in _RECALLED[self.accuracy] if found[symbol] is not None]
        return {
            "accuracy": self.accuracy.value,
            "grade": self.grade,
            **found,
            "verify": verify,
            "unconfirmed": verify,
            "not_covered": list(reasons),
        }

    # ------------------------------------------------------------------ sizes that the standard covers

    @property
    def _diameter(self) -> Values:
        return self._covered("reference_diameter")

    @property
    def _module(self) -> Values:
        return self._covered("normal_module")

    @property
    def _width(self) -> Values:
        return self._covered("face_width")

    def _covered(self, name: str) -> Values:
        permitted = covered(self.accuracy).get(name)
        values: Values = getattr(self, name)
        return values if permitted is None else _within(name, values, permitted)

    def _graded(self, fifth: Values) -> Values:
        """Return tolerances of the grade, from those of grade 5; nan where a size outside the equations is not covered."""
        for name in ("teeth", "helix_angle"):
            if name not in covered(self.accuracy):
                continue
            fifth = number_or_array(fifth, np.where(np.isnan(self._covered(name)), np.nan, fifth))
        return graded(fifth, self.grade)


def _within(name: str, values: Values, permitted: Range | Whole) -> Values:
    """Return the values, nan for elements of an array that are not permitted.

    Raises ParameterError for a number that is not permitted.
    """
    if not isinstance(values, np.ndarray):
        permitted.require(name, values)
        return values
    least, most = (bound if bound is not None else np.inf for bound in (permitted.least, permitted.most))
    return number_or_array(values, np.where((values >= least) & (values <= most), values, np.nan))


def gear_tolerances(gear: Gear, grade: int, accuracy: Accuracy = Accuracy.ISO_1995) -> GearTolerances[float]:
    """Return the tolerances (µm) of one gear; a ring counts by its magnitudes.

    Raises ParameterError for a grade that the edition does not have.
    """
    return GearTolerances(
        accuracy=accuracy,
        grade=grade,
        teeth=gear.tooth_count,
        reference_diameter=abs(gear.reference_diameter),
        normal_module=gear.normal_module,
        face_width=gear.half_width,
        helix_angle=abs(gear.helix_angle),
    )


class FlankTolerances(NamedTuple):
    """Tolerances (µm): f_pt, F_p, f_Halpha and f_falpha; f_pT, F_pT, f_HalphaT and f_falphaT of 2013."""

    single_pitch: float
    cumulative_pitch: float
    profile_slope: float
    profile_form: float


_ANY_TEETH, _ANY_WIDTH = 20, 10.0
"""Number of teeth and face width that stand in where the tolerances do not depend on them."""


def flank_tolerances(
    accuracy_grade: int, reference_diameter: float, normal_module: float, accuracy: Accuracy = Accuracy.ISO_1995
) -> FlankTolerances:
    """Return the flank tolerances (µm) for d from 5 to 10,000 mm (15,000 mm in 2013) and m_n from 0.5 to 70 mm.

    Raises ParameterError beyond.
    """
    of = GearTolerances[float](
        accuracy=accuracy,
        grade=accuracy_grade,
        teeth=_ANY_TEETH,
        reference_diameter=reference_diameter,
        normal_module=normal_module,
        face_width=_ANY_WIDTH,
        helix_angle=0.0,
    )
    return FlankTolerances(of.single_pitch, of.cumulative_pitch, of.profile_slope, of.profile_form)
