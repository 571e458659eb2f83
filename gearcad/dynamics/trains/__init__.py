"""Trains of shafts and meshes: as one writes them down, and how they vibrate freely."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.dynamics.trains.eigenmodes import NaturalModes
    from gearcad.dynamics.trains.lines import lines_of
    from gearcad.dynamics.trains.members import GROUND, Inertia, Mesh, Shaft, StiffnessWave
    from gearcad.dynamics.trains.modes import count_below, natural_modes
    from gearcad.dynamics.trains.parts import static_forces
    from gearcad.dynamics.trains.six_dof import PairOnBearings
    from gearcad.dynamics.trains.system import System
    from gearcad.dynamics.trains.train import Train, TrainModel
else:
    from gearcad.lazy import lazily

__all__ = [
    "GROUND",
    "Inertia",
    "Mesh",
    "NaturalModes",
    "PairOnBearings",
    "Shaft",
    "StiffnessWave",
    "System",
    "Train",
    "TrainModel",
    "count_below",
    "lines_of",
    "natural_modes",
    "static_forces",
]

if not TYPE_CHECKING:
    __getattr__ = lazily(__name__, __all__, ("members", "train", "system", "parts", "lines", "six_dof", "eigenmodes", "modes"))
