"""Compare: a pair by several methods, and what that is expected to take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from gearcad.contact.shared.bodies import BodyModel
from gearcad.errors import GearcadError, ParameterError
from gearcad.geometry import GearPair
from gearcad.geometry.halves import refuse_halves
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.progress import Agenda, Expected, Progress
from gearcad.stiffness.comparison import MeanAtTorque, StiffnessComparison
from gearcad.stiffness.method import StiffnessMethod
from gearcad.stiffness.methods import METHODS

__all__ = ["compare_methods", "expected_methods"]


_WHAT = "a mesh stiffness"

_PROGRAM = 0.4e9
"""Bytes of Python, its libraries, and plane bodies."""

_PARTS = (0.1, 0.3, 0.55, 0.77)
"""Of the load, at which the stiffness is wanted beside that at the load."""


def compare_methods(
    pair: GearPair,
    material: Materials,
    load: Load,
    methods: Sequence[str | StiffnessMethod] = tuple(METHODS),
    *,
    body: BodyModel | None = None,
    mounting: Mounting | None = None,
    positions: int = 0,
    progress: Progress | None = None,
) -> StiffnessComparison:
    """Mesh stiffness of a pair by several methods: their names, or methods that are made already.

    A method that cannot treat the pair is left out with its reason; if none can, the first reason is raised. Raises
    GeometryError at once for a double helical pair.
    """
    refuse_halves(pair.pinion, _WHAT)
    body, mounting = body or BodyModel(), mounting or Mounting()
    inputs = _MethodInputs(pair, material, body, mounting, positions)
    made = [(_name_of(each), inputs.method(each)) for each in methods]
    agenda = Agenda(progress, {name: _expected(method).seconds for name, method in made})
    cycles, points, left_out, failures = [], [], dict[str, str](), []
    for given, (name, method) in zip(methods, made, strict=True):
        agenda(name)
        try:
            if isinstance(method, GearcadError):
                raise method
            if isinstance(given, str):
                method = replace(method, tell=agenda.within(name))
            cycles.append(method(load))
            points += _over_load(method, load, cycles[-1])
        except GearcadError as error:
            left_out[name] = str(error)
            failures.append(error)
    if not cycles:
        raise failures[0]
    return StiffnessComparison(
        pair=mounting.mounted(pair),
        material=material,
        load=load,
        body=body,
        cycles=tuple(cycles),
        load_points=tuple(points),
        left_out=left_out,
        titles={name: method.title for name, method in METHODS.items()},
    )


def expected_methods(
    pair: GearPair,
    material: Materials,
    methods: Sequence[str],
    *,
    body: BodyModel | None = None,
    mounting: Mounting | None = None,
    positions: int = 0,
) -> Expected:
    """What `compare_methods` is expected to take."""
    refuse_halves(pair.pinion, _WHAT)
    inputs = _MethodInputs(pair, material, body or BodyModel(), mounting or Mounting(), positions)
    every = [_expected(inputs.method(name)) for name in methods]
    return Expected(sum(each.seconds for each in every), _PROGRAM + max((each.memory for each in every), default=0.0))


class _MethodInputs(NamedTuple):
    """What methods are made of."""

    pair: GearPair
    material: Materials
    body: BodyModel
    mounting: Mounting
    positions: int

    def method(self, wanted: str | StiffnessMethod) -> StiffnessMethod | GearcadError:
        """A method, or why it cannot treat the pair. Raises ParameterError for an unknown name."""
        if not isinstance(wanted, str):
            return wanted
        if wanted not in METHODS:
            raise ParameterError("method", wanted, f"must be one of {', '.join(METHODS)}")
        try:
            return METHODS[wanted](**self._asdict())
        except GearcadError as error:
            return error


def _name_of(method: str | StiffnessMethod) -> str:
    return method if isinstance(method, str) else method.name


def _expected(method: StiffnessMethod | GearcadError) -> Expected:
    """Nothing of a method that is left out."""
    try:
        return Expected(0.0, 0.0) if isinstance(method, GearcadError) else method.expected
    except GearcadError:
        return Expected(0.0, 0.0)


def _over_load(method: StiffnessMethod, load: Load, at_load: MeshCycle) -> list[MeanAtTorque]:
    """Means at parts of the load, and at the load itself."""
    loads = [replace(load, torque=part * load.torque) for part in _PARTS] if method.load_dependent else []
    cycles = [method(each, method.load_positions) for each in loads]
    return [MeanAtTorque(method.name, cycle.torque, cycle.mean, cycle.tangent_mean) for cycle in (*cycles, at_load)]
