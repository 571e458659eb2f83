"""CampbellStudy: spectra of a pair of single teeth over a range of speeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.dynamics.tooth_springs.contact_model import ContactModel
from gearcad.dynamics.tooth_springs.speed_spectra import SpeedSpectra
from gearcad.notice import Notice

__all__ = ["CampbellStudy"]


@dataclass(frozen=True, kw_only=True, eq=False)
class CampbellStudy(SpeedSpectra):
    """That of a contact model, each speed from the same start: `deepest` has the start from y = 0 in it."""

    model: ContactModel

    @property
    def teeth(self) -> int:
        return self.model.teeth.pinion

    @property
    def natural_frequencies(self) -> dict[str, float]:
        """Lines of the diagram (Hz): with one pair, and with the mean number of pairs, which is met at high speed."""
        found = {"one pair": self.model.natural_frequency()}
        if self.model.contact_ratio != 1.0:
            found["mean stiffness"] = self.model.natural_frequency(self.model.contact_ratio)
        return found

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Those of the model, and what the motion adds to them."""
        found = list(self.model.notices)
        worst = int(np.argmax(self.deepest))
        if 1e-3 * self.deepest[worst] > self.model.normal_module:
            text = (
                f"the flanks penetrate by up to {1e-3 * self.deepest[worst]:.4g} mm (at {self.speeds[worst]:g} rpm), more than"
                f" the module of {self.model.normal_module:g} mm: no teeth do that"
            )
            found.append(Notice("deep-penetration", text))
        return (*found, *super().notices)
