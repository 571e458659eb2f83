"""Mesh stiffness by every method, each in the form GearPair, Material, Load -> MeshCycle."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.stiffness.beam import PotentialEnergy, WeberBanaschek
    from gearcad.stiffness.compare import compare_methods
    from gearcad.stiffness.comparison import StiffnessComparison
    from gearcad.stiffness.contact import PlaneStrainContact, PlaneStressContact, SolidContact
    from gearcad.stiffness.method import StiffnessMethod
    from gearcad.stiffness.methods import CLOSED_FORMS, METHODS
    from gearcad.stiffness.standard import MethodB
    from gearcad.stiffness.strain_energy import StrainEnergy
else:
    from gearcad.lazy import lazily

__all__ = [
    "CLOSED_FORMS",
    "METHODS",
    "MethodB",
    "PlaneStrainContact",
    "PlaneStressContact",
    "PotentialEnergy",
    "SolidContact",
    "StiffnessComparison",
    "StiffnessMethod",
    "StrainEnergy",
    "WeberBanaschek",
    "compare_methods",
]

_INSIDE = "method beam standard strain_energy contact methods comparison compare"

if not TYPE_CHECKING:
    __getattr__ = lazily(__name__, __all__, tuple(_INSIDE.split()))
