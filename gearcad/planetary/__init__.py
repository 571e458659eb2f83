"""Planetary trains: sets of planets of any type, their speeds, torques, assembly, phases and poses. Numpy only."""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.planetary.load import TrainLoad
    from gearcad.planetary.members import Carrier, Central, PairStage, Rim
    from gearcad.planetary.mesh import SetMesh, SetType
    from gearcad.planetary.phases import Drive, MeshPhases, drive_of, mesh_phases, phases_between
    from gearcad.planetary.poses import GearPlace, PlanetPose, StagePose, TrainPose
    from gearcad.planetary.train import PlanetaryTrain

__all__ = [
    "Carrier",
    "Central",
    "Drive",
    "GearPlace",
    "MeshPhases",
    "PairStage",
    "PlanetPose",
    "PlanetaryTrain",
    "Rim",
    "SetMesh",
    "SetType",
    "StagePose",
    "TrainLoad",
    "TrainPose",
    "drive_of",
    "mesh_phases",
    "phases_between",
]

if not TYPE_CHECKING:
    from gearcad.lazy import lazily

    __getattr__ = lazily(
        __name__,
        __all__,
        (
            "load",
            "members",
            "train",
            "mesh",
            "phases",
            "poses",
        ),
    )
