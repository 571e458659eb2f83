"""What gears are made to: sizes, pressure angles and basic racks, each with how usual it is. The weights are our judgement."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.geometry.diametral import module_of_pitch
from gearcad.geometry.iso54 import ISO_54_I, ISO_54_II

__all__ = ["ANGLES", "FREE", "FREE_ANGLE", "RACKS", "SIZES", "StandardRack", "StandardSize"]


@dataclass(frozen=True)
class StandardSize:
    """A normal module (mm), the diametral pitch (1/inch) that it stands for or None, its series, and its weight."""

    module: float
    pitch: float | None
    series: str
    weight: float


@dataclass(frozen=True)
class StandardRack:
    """A basic rack in normal modules, and its weight at pressure angles (degrees); None stands for all others.

    Its dedendum may have a constant part (mm), and may be known no better than to a `spread`.
    """

    name: str
    addendum: float
    dedendum: float
    root_radius: float
    weights: dict[float | None, float]
    constant: float = 0.0
    spread: float = 0.0
    largest_module: float = 1e9

    def dedendum_at(self, module: float) -> float:
        """Its dedendum for a normal module (mm), in modules."""
        return self.dedendum + self.constant / module

    def weight(self, angle: float, module: float) -> float:
        """How usual it is at a pressure angle and a normal module."""
        return 0.0 if module > self.largest_module else self.weights.get(angle, self.weights[None])


FREE = "free"
"""The series of a size that no series has."""

_FINE_I = (0.1, 0.12, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8)
_FINE_II = (0.35, 0.45, 0.55, 0.7, 0.75, 0.9)
_USUAL_PITCHES = (2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 18, 20, 24, 28, 32, 36, 40, 48, 64, 72, 80, 96, 120)
_COARSE_PITCHES = (1, 1.25, 1.5, 1.75, 2.25, 2.5, 2.75, 3.5, 4.5, 5.5, 7, 9, 11, 13, 15)
_FINE_PITCHES = (22, 25, 26, 30, 44, 50, 56, 60, 100, 128, 150, 200)

SIZES = tuple(
    sorted(
        (
            *(StandardSize(float(module), None, "ISO 54 I", 1.0) for module in ISO_54_I),
            *(StandardSize(float(module), None, "ISO 54 II", 0.4) for module in ISO_54_II),
            *(StandardSize(module, None, "DIN 780 I", 1.0) for module in _FINE_I),
            *(StandardSize(module, None, "DIN 780 II", 0.4) for module in _FINE_II),
            *(StandardSize(module_of_pitch(pitch), float(pitch), "DP", 0.5) for pitch in _USUAL_PITCHES),
            *(StandardSize(module_of_pitch(pitch), float(pitch), "DP", 0.15) for pitch in (*_COARSE_PITCHES, *_FINE_PITCHES)),
        ),
        key=lambda size: size.module,
    )
)
"""ISO 54:1996, modules below 1 mm as DIN 780-1 has them, and diametral pitches as catalogues have them."""

ANGLES = {20.0: 1.0, 14.5: 0.12, 25.0: 0.06, 22.5: 0.04, 15.0: 0.04, 17.5: 0.04, 30.0: 0.01}
"""Normal pressure angles (degrees), and how usual they are beside 20."""

FREE_ANGLE = 0.002
"""How usual any other pressure angle is, with a size of no series."""

RACKS = (
    StandardRack("ISO 53 A, B, C; JIS; AGMA", 1.0, 1.25, 0.38, {None: 0.6, 14.5: 0.12}),
    StandardRack("ISO 53 D", 1.0, 1.4, 0.39, {None: 0.1, 14.5: 0.02}),
    StandardRack("AGMA, full fillet", 1.0, 1.35, 0.3, {None: 0.05}),
    StandardRack("1.2 deep", 1.0, 1.2, 0.3, {None: 0.05}),
    StandardRack("AGMA fine pitch", 1.0, 1.2, 0.3, {None: 0.1}, constant=0.0508, largest_module=1.271),
    StandardRack("Brown & Sharpe", 1.0, 1.157, 0.209, {None: 0.04, 14.5: 0.6}),
    StandardRack("stub", 0.8, 1.0, 0.3, {None: 0.04, 14.5: 0.01}),
    StandardRack("another depth", 1.0, 1.27, 0.3, {None: 0.1, 14.5: 0.1}, spread=0.12),
    StandardRack("another stub", 0.8, 1.0, 0.3, {None: 0.02, 14.5: 0.01}, spread=0.08),
)
"""ISO 53:1998, AGMA 201.02 (full depth, fine pitch, full fillet), the Brown & Sharpe system of 14.5 degrees, and stub teeth."""
