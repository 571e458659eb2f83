"""SplineJoint: a shaft and a hub with involute teeth that sit on one another (DIN 5480, ISO 4156, ANSI B92.1).

Lengths in mm, angles in degrees.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from functools import cached_property

from gearcad.core.errors import InputError
from gearcad.core.records import JsonObject, Notice, concise
from gearcad.geometry.spline_inputs import SplineInputs
from gearcad.geometry.spline_part import Spline, notices_document
from gearcad.geometry.spline_standards import B92_1, DIN5480, EDITIONS, HUB, ISO4156, SHAFT

_OWN_KEYS = ("designation", "nominal_diameter", "module", "diametral_pitch", "teeth", "pressure_angle", "centring", "length")
"""Keys of [spline] itself: an error about one of them is not of the shaft or the hub."""


@dataclass(frozen=True, kw_only=True)
class SplineJoint(SplineInputs):
    """A splined shaft, the hub on it, or both, and how they fit: see `SplineInputs` for what is given.

    Raises ParameterError for one value out of range, GeometryError for a combination that makes no spline.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        super().__post_init__()
        for part in self.parts.values():
            try:
                part.gear  # noqa: B018 - made now, so that a joint that exists has teeth
            except InputError as error:
                raise (error if error.parameter in _OWN_KEYS else error.within(part.part)) from None

    @cached_property
    def parts(self) -> dict[str, Spline]:
        """The shaft and the hub, as far as they are asked for."""
        return {part: Spline(joint=self, part=part) for part in self.named_parts}

    @property
    def hub_rotation(self) -> float:
        """Angle (degrees) by which the hub is turned so that a tooth of the shaft is in the middle of a space of the hub."""
        return 180 / self.count

    # ------------------------------------------------------------------ the fit

    @property
    def effective_play_min(self) -> float | None:
        """Least effective play E_v min - S_v max (mm, along the reference circle); negative for an interference."""
        return self._play(lambda hub, shaft: (hub.effective_limit, shaft.effective_limit))

    @property
    def effective_play_max(self) -> float | None:
        """Greatest effective play E_v max - S_v min (mm)."""
        return self._play(lambda hub, shaft: (hub.effective_other, shaft.effective_other))

    @property
    def actual_play_min(self) -> float | None:
        """Least play of the actual widths E_min - S_max (mm): that of parts without deviations of form and pitch."""
        return self._play(lambda hub, shaft: (hub.actual_limit, shaft.actual_limit))

    @property
    def actual_play_max(self) -> float | None:
        """Greatest play of the actual widths E_max - S_min (mm)."""
        return self._play(lambda hub, shaft: (hub.actual_other, shaft.actual_other))

    def _play(self, widths: Callable[[Spline, Spline], tuple[float | None, float | None]]) -> float | None:
        if len(self.parts) < 2:
            return None
        space, thickness = widths(self.parts[HUB], self.parts[SHAFT])
        return None if space is None or thickness is None else space - thickness

    @property
    def built_play(self) -> float | None:
        """Play (mm, along the reference circle) of the solids, which have the middle of the actual tolerances."""
        if len(self.parts) < 2:
            return None
        return self.parts[HUB].built_size - self.parts[SHAFT].built_size

    @property
    def backlash_angle(self) -> float | None:
        """Angle (degrees) by which hubs of the middle of the actual tolerances turn on such shafts: 2 (e - s)/d."""
        return None if (play := self.built_play) is None else math.degrees(2 * play / self.reference_diameter)

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about the joint."""
        return tuple(self._found())

    def _found(self) -> Iterator[Notice]:
        if len(self.parts) < 2:
            return
        shaft, hub = self.parts[SHAFT], self.parts[HUB]
        if hub.tip_diameter < shaft.form_diameter:
            text = f"the hub's tips (diameter {hub.tip_diameter:.4f} mm) reach below the shaft's form circle"
            yield Notice("spline-interference", f"{text} ({shaft.form_diameter:.4f} mm)")
        if shaft.tip_diameter > hub.form_diameter:
            text = f"the shaft's tips (diameter {shaft.tip_diameter:.4f} mm) reach beyond the hub's form circle"
            yield Notice("spline-interference", f"{text} ({hub.form_diameter:.4f} mm)")
        if (play := self.effective_play_min) is not None and play < 0:
            yield Notice("spline-press-fit", f"the fit has an interference of up to {-play * 1000:.1f} µm on the flanks")

    @property
    def unconfirmed(self) -> tuple[str, ...]:
        """Figures that rest on no printed source."""
        found = []
        if self.basis == DIN5480:
            found.append("DIN 5480: radii of the roots, root circle of rolled shafts")
            if self.centring == "major":
                found.append("DIN 5480: fits of the diameters that centre are not made")
            if self.form_clearance is None:
                found.append(f"DIN 5480: form clearance c_F of module {self.module:g} mm is not known")
        if self.basis == ISO4156 and self.pressure_angle > 30:
            found.append("ISO 4156: form circle of the hub at 37.5 and 45 deg")
        if self.basis == B92_1:
            found.append("ANSI B92.1: radii of the roots; tolerances are not known")
        return tuple(found)

    def to_dict(self) -> JsonObject:
        """Return the inputs of the joint, its plays (mm), and what is unconfirmed."""
        own = {each.name: getattr(self, each.name) for each in fields(self) if each.name not in ("shaft", "hub", "name")}
        derived = ("profile_shift", "reference_diameter", "base_diameter", "form_clearance", "effective_play_min")
        names = (*derived, "effective_play_max", "actual_play_min", "actual_play_max", "backlash_angle")
        found = own | {"edition": EDITIONS[self.basis]} | {name: getattr(self, name) for name in names}
        return found | {"unconfirmed": list(self.unconfirmed), **notices_document(self.notices)}
