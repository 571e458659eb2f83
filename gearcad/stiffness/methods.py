"""All methods under their names."""

from __future__ import annotations

from gearcad.mesh_cycle import METHOD_NAMES
from gearcad.stiffness.beam import PotentialEnergy, WeberBanaschek
from gearcad.stiffness.contact import PlaneStrainContact, PlaneStressContact, SolidContact
from gearcad.stiffness.method import StiffnessMethod
from gearcad.stiffness.standard import MethodB
from gearcad.stiffness.strain_energy import StrainEnergy

__all__ = ["CLOSED_FORMS", "METHODS"]

METHODS: dict[str, type[StiffnessMethod]] = dict(
    zip(
        METHOD_NAMES,
        (PotentialEnergy, WeberBanaschek, MethodB, StrainEnergy, PlaneStressContact, PlaneStrainContact, SolidContact),
        strict=True,
    )
)
"""From name to class."""

CLOSED_FORMS = tuple(method.name for method in (PotentialEnergy, WeberBanaschek, MethodB))
"""Those without finite elements: milliseconds."""
