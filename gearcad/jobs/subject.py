"""What Python gives to jobs: gears, pairs and designs, with a load and other inputs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias, Unpack

from gearcad.errors import ParameterError
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.material import Material
from gearcad.per_gear import PerGear

if TYPE_CHECKING:
    from gearcad.designs import Design, Inputs
    from gearcad.load import Load
    from gearcad.planetary import PlanetaryTrain, TrainLoad

__all__ = ["Subject", "as_design"]

Subject: TypeAlias = "Design | GearPair | Gear | RackPair | Rack | PlanetaryTrain"
"""What Python may give to a job."""


def as_design(subject: Subject, load: Load | TrainLoad | None = None, **inputs: Unpack[Inputs]) -> Design:
    """A design as it is, or that of what else may be given, with `inputs` in place of its own. Raises ParameterError.

    All kinds of designs are imported here: a command reads its own from a spec.
    """
    from gearcad.designs import Design, GearDesign, PairDesign, PlanetaryDesign, RackDesign, RackPairDesign
    from gearcad.designs.keys import BESIDE
    from gearcad.planetary import PlanetaryTrain, TrainLoad

    if isinstance(subject, Gear):
        subject = GearDesign(name=subject.name, gear=subject)
    elif isinstance(subject, GearPair):
        subject = PairDesign(name=subject.name, pair=subject)
    elif isinstance(subject, Rack):
        subject = RackDesign(name=subject.name, rack=subject)
    elif isinstance(subject, RackPair):
        subject = RackPairDesign(name=subject.name, pair=subject)
    elif isinstance(subject, PlanetaryTrain):
        subject = PlanetaryDesign(name=subject.name, train=subject)
    if not isinstance(subject, Design):
        permitted = "must be a GearPair, a Gear, a RackPair, a Rack, a PlanetaryTrain, or a design such as gearcad.read gives"
        raise ParameterError("subject", subject, permitted)
    kinds = {**BESIDE, **({"load": TrainLoad} if isinstance(subject, PlanetaryDesign) else {})}
    given: dict[str, Any] = {**inputs, "load": load} if load is not None else {**inputs}
    for name, value in given.items():
        if not hasattr(subject, name):
            known = ", ".join(each for each in BESIDE if hasattr(subject, each))
            raise ParameterError(name, value, f"is nothing that a {subject.kind.words} has; it has {known}")
        if name == "material" and isinstance(subject, PairDesign | RackPairDesign) and isinstance(value, PerGear):
            value.map(_require_material)
        elif name == "material" and isinstance(subject, PlanetaryDesign) and isinstance(value, Mapping):
            list(map(_require_material, value.values()))
        elif value is not None and not isinstance(value, kinds[name]):
            raise ParameterError(name, value, f"must be a {kinds[name].__name__}")
    return replace(subject, **given)


def _require_material(value: Any) -> None:
    if not isinstance(value, Material):
        raise ParameterError("material", value, "must be a Material")
