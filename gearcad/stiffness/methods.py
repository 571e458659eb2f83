"""All methods under their names, the quick ones first."""

from __future__ import annotations

from gearcad.stiffness.beam import PotentialEnergy, WeberBanaschek
from gearcad.stiffness.contact import PlaneStrainContact, PlaneStressContact, SolidContact
from gearcad.stiffness.method import StiffnessMethod
from gearcad.stiffness.standard import MethodB
from gearcad.stiffness.strain_energy import StrainEnergy

__all__ = ["CLOSED_FORMS", "METHODS"]

_CLOSED: tuple[type[StiffnessMethod], ...] = (PotentialEnergy, WeberBanaschek, MethodB)
_ELEMENTS: tuple[type[StiffnessMethod], ...] = (StrainEnergy, PlaneStressContact, PlaneStrainContact, SolidContact)

METHODS = {method.name: method for method in (*_CLOSED, *_ELEMENTS)}
"""From name to class."""

CLOSED_FORMS = tuple(method.name for method in _CLOSED)
"""Those without finite elements: milliseconds."""
