"""MeshCampbell: spectra of a train or pair over a range of speeds, its meshes with the stiffness of real teeth."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from gearcad.arrays import Floats
from gearcad.dynamics.tooth_springs.speed_spectra import SpeedSpectra
from gearcad.notice import Notice

__all__ = ["MeshCampbell"]


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshCampbell(SpeedSpectra):
    """That of the motions that have settled at each speed: of the first mesh's pinion, and of the approach of its flanks.

    `modes` are natural frequencies (Hz) that bend the teeth, by name; `settled` is for how long (s) each motion had run before.
    Speeds at which the motion grows beyond all numbers are `unbounded` (rpm), and are left out.
    """

    mesh: str
    pinion_teeth: int
    modes: dict[str, float] = field(default_factory=dict)
    settled: float
    unbounded: tuple[float, ...] = ()

    @property
    def teeth(self) -> int:
        return self.pinion_teeth

    @property
    def natural_frequencies(self) -> dict[str, float]:
        return self.modes

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before trusting it."""
        found = super().notices
        if self.unbounded:
            listed = ", ".join(f"{speed:g}" for speed in self.unbounded)
            text = f"no spectrum at {listed} rpm: flanks that never part vibrate more and more there"
            found = (*found, Notice("unbounded", text))
        return tuple(each.within("campbell") for each in found)

    def to_dict(self) -> dict[str, Any]:
        """A row per speed, for JSON."""
        return {"mesh": self.mesh, "settled": self.settled, "unbounded": list(self.unbounded), **super().to_dict()}

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them."""
        names = {"speed": "speeds", "frequency": "frequency", "pinion_speed": "pinion_speed", "approach": "approach"}
        return {f"campbell_{key}": getattr(self, name) for key, name in names.items()}
