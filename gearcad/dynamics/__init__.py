"""Dynamics of gear pairs and trains."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.dynamics.engagement import engaged
    from gearcad.dynamics.options import DynamicsOptions
    from gearcad.dynamics.pair import study_contact, study_pair
    from gearcad.dynamics.pair_result import ContactStudy, PairStudy
    from gearcad.dynamics.train import study_modes, study_train
    from gearcad.dynamics.train_result import ModalStudy, TrainStudy
    from gearcad.dynamics.trains.members import Inertia, Mesh, Shaft, StiffnessWave
    from gearcad.dynamics.trains.mesh_pair import MeshPair
    from gearcad.dynamics.trains.train import Train, TrainModel
else:
    from gearcad.lazy import lazily

__all__ = [
    "ContactStudy",
    "DynamicsOptions",
    "Inertia",
    "Mesh",
    "MeshPair",
    "ModalStudy",
    "PairStudy",
    "Shaft",
    "StiffnessWave",
    "Train",
    "TrainModel",
    "TrainStudy",
    "engaged",
    "study_contact",
    "study_modes",
    "study_pair",
    "study_train",
]

_INSIDE = "options trains.mesh_pair trains.members trains.train train_result pair_result engagement train pair"

if not TYPE_CHECKING:
    __getattr__ = lazily(__name__, __all__, tuple(_INSIDE.split()))
