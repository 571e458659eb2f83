"""Springs between single teeth, integrated from event to event."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.dynamics.tooth_springs.campbell_study import CampbellStudy
    from gearcad.dynamics.tooth_springs.contact_model import ContactModel, EngagedPairs, disc_inertia
    from gearcad.dynamics.tooth_springs.history import Start, TimeHistory
    from gearcad.dynamics.tooth_springs.motion import time_history
    from gearcad.dynamics.tooth_springs.spectra import Spectrum, amplitude_spectrum
else:
    from gearcad.lazy import lazily

__all__ = [
    "CampbellStudy",
    "ContactModel",
    "EngagedPairs",
    "Spectrum",
    "Start",
    "TimeHistory",
    "amplitude_spectrum",
    "disc_inertia",
    "time_history",
]

if not TYPE_CHECKING:
    __getattr__ = lazily(__name__, __all__, ("contact_model", "spectra", "history", "motion", "campbell_study"))
