"""What Python gives to jobs: gears, pairs and designs, with a load and other inputs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Unpack

from gearcad.designs import Design, GearDesign, Inputs, PairDesign
from gearcad.designs.keys import BESIDE
from gearcad.errors import ParameterError
from gearcad.geometry import Gear, GearPair
from gearcad.load import Load

__all__ = ["as_design"]


def as_design(subject: Design | GearPair | Gear, load: Load | None = None, **inputs: Unpack[Inputs]) -> Design:
    """A design as it is, or that of a gear or a pair, with what is given in place of its own. Raises ParameterError."""
    if isinstance(subject, Gear):
        subject = GearDesign(name=subject.name, gear=subject)
    elif isinstance(subject, GearPair):
        subject = PairDesign(name=subject.name, pair=subject)
    if not isinstance(subject, Design):
        raise ParameterError("subject", subject, "must be a GearPair, a Gear, or a design such as gearcad.read gives")
    given: dict[str, Any] = {**inputs, "load": load} if load is not None else {**inputs}
    for name, value in given.items():
        if not hasattr(subject, name):
            known = ", ".join(each for each in BESIDE if hasattr(subject, each))
            raise ParameterError(name, value, f"is nothing that a {subject.kind.value} has; it has {known}")
        if value is not None and not isinstance(value, BESIDE[name]):
            raise ParameterError(name, value, f"must be a {BESIDE[name].__name__}")
    return replace(subject, **given)
