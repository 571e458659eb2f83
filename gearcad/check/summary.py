"""The figures of a mesh cycle that one reads first."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypedDict

from gearcad.check.extremes import Extremes
from gearcad.contact.shared.loaded import Cycle, RootStress
from gearcad.per_gear import PerGear

__all__ = ["AtPitchPoint", "CommonFigures", "Figures", "Summary", "by_name", "common_figures", "figures", "root_peaks"]

_ABOUT = ("missing", "extremes", "mean_error")


def by_name(values: Mapping[str, Any]) -> dict[str, Any]:
    """As `check.json` has it: what both gears have gets a name for each, `root_tension_pinion`."""
    document: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, PerGear):
            document |= {f"{name}_{gear}": of for gear, of in value._asdict().items()}
        else:
            document[name] = value
    return document


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What every model tells: stiffness in N/(mm·µm) of common face width, stresses in MPa, transmission error in µm.

    `contact_pressure` is the greatest away from the edges of the flanks, `von_mises` the greatest below that contact,
    `von_mises_depth` (mm) below the flank. `corner_positions` counts positions where the edge of a tip touches, whose pressure
    is not told. At the pitch point: pressure, half width (mm), and share of the load that the pair of teeth carries.
    `bore_tension_pinion` and `_wheel` are None where the bore is kept round; where it is not, root stresses are of all teeth.

    A figure that no position has is None, and `missing` has the reason. `extremes` are those found between the positions too,
    `mean_error` is what the positions may miss of the mean stiffness.
    """

    mesh_stiffness_mean: float
    mesh_stiffness_max: float
    mesh_stiffness_min: float
    single_stiffness: float
    transmission_error_peak_to_peak: float
    contact_pressure: float | None
    contact_pressure_pitch_point: float | None
    half_width_pitch_point: float | None
    share_pitch_point: float
    von_mises: float | None
    von_mises_depth: float | None
    root_tension: PerGear[float]
    root_compression: PerGear[float]
    bore_tension_pinion: float | None
    bore_tension_wheel: float | None
    corner_positions: int
    missing: dict[str, str]
    extremes: Extremes
    mean_error: float

    @property
    def bore_tension(self) -> PerGear[float | None]:
        """Of both gears (MPa)."""
        return PerGear(self.bore_tension_pinion, self.bore_tension_wheel)

    @property
    def own_face_factors(self) -> dict[str, float]:
        """K_Hbeta and K_Fbeta that the stresses have from the model itself, by symbols; a plane has none."""
        return {}

    @property
    def sampling_error(self) -> dict[str, float]:
        """By name, what the positions may miss: of an extreme, relative to it or to its swing, and of the mean stiffness."""
        known = {name: of.error for name, of in self.extremes.items() if of is not None}
        return {"mesh_stiffness_mean": self.mean_error, **known}

    def to_dict(self) -> dict[str, Any]:
        """As `check.json` has it; what tells about the figures is no part of it."""
        return by_name({name: value for name, value in vars(self).items() if name not in _ABOUT})


class Figures(NamedTuple):
    """The few that a sweep or a refinement needs, as in Summary."""

    mesh_stiffness: float
    contact_pressure: float | None
    root_tension: PerGear[float]


def root_peaks(cycle: Cycle) -> PerGear[RootStress]:
    """The greatest root tension of each gear."""
    return PerGear.each(lambda role: cycle.worst_position(role).tension.pick(role))


def figures(cycle: Cycle) -> Figures:
    """Mean mesh stiffness, greatest interior pressure and root tensions of a cycle."""
    worst = cycle.worst_contact
    tension = root_peaks(cycle).map(lambda peak: peak.stress)
    return Figures(float(cycle.mean("stiffness")[0]), worst[1].interior_pressure if worst else None, tension)


class AtPitchPoint(NamedTuple):
    """Share, pressure (MPa) and half width (mm) of a contact at the pitch point, or the reason why there are none of these."""

    share: float
    pressure: float | None = None
    half_width: float | None = None
    reason: str = ""

    @property
    def missing(self) -> dict[str, str]:
        """The reason for each figure that is not told."""
        return dict.fromkeys(("contact_pressure_pitch_point", "half_width_pitch_point"), self.reason) if self.reason else {}


class CommonFigures(TypedDict):
    """The fields of a Summary that are found in every model alike."""

    mesh_stiffness_mean: float
    mean_error: float
    mesh_stiffness_max: float
    mesh_stiffness_min: float
    single_stiffness: float
    transmission_error_peak_to_peak: float
    contact_pressure: float | None
    contact_pressure_pitch_point: float | None
    half_width_pitch_point: float | None
    share_pitch_point: float
    root_tension: PerGear[float]
    root_compression: PerGear[float]
    bore_tension_pinion: float | None
    bore_tension_wheel: float | None
    corner_positions: int
    extremes: Extremes


def common_figures(cycle: Cycle, extremes: Extremes, single: float, at_pitch_point: AtPitchPoint) -> CommonFigures:
    """Those of a cycle and its extremes; `single` is the stiffness of one pair of teeth alone."""

    def value(name: str) -> float | None:
        return found.value if (found := extremes[name]) is not None else None

    def sure(name: str) -> float:
        found = extremes[name]
        assert found is not None  # every position has it
        return found.value

    mean, off = map(float, cycle.mean("stiffness"))
    return {
        "mesh_stiffness_mean": mean,
        "mean_error": off / mean,
        "mesh_stiffness_max": sure("mesh_stiffness_max"),
        "mesh_stiffness_min": sure("mesh_stiffness_min"),
        "single_stiffness": single,
        "transmission_error_peak_to_peak": sure("transmission_error_max") - sure("transmission_error_min"),
        "contact_pressure": value("contact_pressure"),
        "contact_pressure_pitch_point": at_pitch_point.pressure,
        "half_width_pitch_point": at_pitch_point.half_width,
        "share_pitch_point": at_pitch_point.share,
        "root_tension": PerGear.each(lambda role: sure(f"root_tension_{role.value}")),
        "root_compression": PerGear.each(lambda role: sure(f"root_compression_{role.value}")),
        "bore_tension_pinion": value("bore_tension_pinion"),
        "bore_tension_wheel": value("bore_tension_wheel"),
        "corner_positions": cycle.edge_positions,
        "extremes": extremes,
    }
