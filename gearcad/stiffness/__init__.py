"""Mesh stiffness by every method, each in the form GearPair, Material, Load -> MeshCycle."""

from gearcad.stiffness.beam import PotentialEnergy, WeberBanaschek
from gearcad.stiffness.compare import compare_methods
from gearcad.stiffness.comparison import StiffnessComparison
from gearcad.stiffness.contact import PlaneStrainContact, PlaneStressContact, SolidContact
from gearcad.stiffness.method import StiffnessMethod
from gearcad.stiffness.methods import CLOSED_FORMS, METHODS
from gearcad.stiffness.standard import MethodB
from gearcad.stiffness.strain_energy import StrainEnergy

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
