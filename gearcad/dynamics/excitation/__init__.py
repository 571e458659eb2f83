"""What makes a train vibrate: stiffness and errors of its meshes."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.dynamics.excitation.deviations import (
        ErrorDistribution,
        ToothDeviations,
        TransmissionError,
        random_deviations,
        tooth_errors,
    )
    from gearcad.dynamics.excitation.mesh_curves import (
        CosineStiffness,
        CurveStiffness,
        StiffnessShape,
        cycle_stiffness,
        square_stiffness,
    )
    from gearcad.dynamics.excitation.meshes import Excitation, MeshExcitation, cycle_excitation
    from gearcad.dynamics.excitation.polyline import Polyline
    from gearcad.dynamics.excitation.sources import pair_excitation, pair_train, train_excitation
else:
    from gearcad.lazy import lazily

__all__ = [
    "CosineStiffness",
    "CurveStiffness",
    "ErrorDistribution",
    "Excitation",
    "MeshExcitation",
    "Polyline",
    "StiffnessShape",
    "ToothDeviations",
    "TransmissionError",
    "cycle_excitation",
    "cycle_stiffness",
    "pair_excitation",
    "pair_train",
    "random_deviations",
    "square_stiffness",
    "tooth_errors",
    "train_excitation",
]

if not TYPE_CHECKING:
    __getattr__ = lazily(__name__, __all__, ("polyline", "mesh_curves", "deviations", "meshes", "sources"))
