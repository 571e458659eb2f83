"""The methods of mesh stiffness by their names, and a pair compared by several of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from gearcad.contact.shared.bodies import BodyModel
from gearcad.core.errors import GearcadError, ParameterError
from gearcad.core.records import Notice
from gearcad.core.runtime import Agenda, Expected, Progress
from gearcad.geometry import GearPair, RackPair
from gearcad.geometry.gear import refuse_halves
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.rating.nominal_rating import Rating, rate, rate_rack
from gearcad.stiffness.beam import PotentialEnergy, WeberBanaschek
from gearcad.stiffness.comparison import MeanAtTorque, StiffnessComparison
from gearcad.stiffness.finite_elements import PlaneStrainContact, PlaneStressContact, SolidContact, StrainEnergy
from gearcad.stiffness.method import StiffnessMethod


@dataclass(frozen=True, kw_only=True)
class MethodB(StiffnessMethod):
    """c' and c_gamma of ISO 6336-1:2006, clause 9: c_gamma_beta is its secant stiffness, c_gamma_alpha its tangent stiffness.

    C_R by web and rim of the bodies; below 100 N/mm both fall with the fourth root of the load.
    """

    name = "iso6336"
    title = "ISO 6336-1, Method B"
    mean_only = True
    rack_form = True
    holds = ("all that Weber and Banaschek hold, times 0.8 from measurements (C_M)",)

    def _cycle(self, load: Load, count: int) -> MeshCycle:
        found = self._rating(load).stiffness
        half = 180 / self.engaged.pinion.teeth
        secant, tangent = (np.full(2, each * self.width) for each in (found.mesh_beta, found.mesh_alpha))
        return MeshCycle(
            **self.inputs(load),
            roll_angle=np.array([-half, half]),
            mesh_stiffness=secant,
            tangent_stiffness=tangent,
            transmission_error=self.force(load) / secant,
            single_stiffness=found.single * self.width,
        )

    def _rating(self, load: Load) -> Rating:
        """Return the nominal rating of the pair."""
        if isinstance(self.engaged, RackPair):
            return rate_rack(self.engaged, self.material, load)
        return rate(self.engaged, self.material, load)

    def notices(self, load: Load) -> Iterator[Notice]:
        for notice in self._rating(load).notices:
            if notice.code.startswith(("scope-", "stiffness-")):
                yield notice
        yield from super().notices(load)


_CLOSED: tuple[type[StiffnessMethod], ...] = (PotentialEnergy, WeberBanaschek, MethodB)
_ELEMENTS: tuple[type[StiffnessMethod], ...] = (StrainEnergy, PlaneStressContact, PlaneStrainContact, SolidContact)

METHODS = {method.name: method for method in (*_CLOSED, *_ELEMENTS)}
"""Classes of methods by name."""

CLOSED_FORMS = tuple(method.name for method in _CLOSED)
"""Methods without finite elements, which take milliseconds."""


_WHAT = "a mesh stiffness"

_PROGRAM = 0.4e9
"""Bytes of Python, its libraries, and plane bodies."""

_PARTS = (0.1, 0.3, 0.55, 0.77)
"""Shares of the load at which the stiffness is computed, beside that at the full load."""


def compare_methods(
    pair: GearPair | RackPair,
    material: Materials,
    load: Load,
    methods: Sequence[str | StiffnessMethod] = tuple(METHODS),
    *,
    body: BodyModel | None = None,
    mounting: Mounting | None = None,
    positions: int = 0,
    progress: Progress | None = None,
) -> StiffnessComparison:
    """Return the mesh stiffness of a pair by several methods, given by their names or as StiffnessMethod objects.

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
        pair=pair if isinstance(pair, RackPair) else mounting.mounted(pair),
        material=material,
        load=load,
        body=body,
        cycles=tuple(cycles),
        load_points=tuple(points),
        left_out=left_out,
        titles={name: method.title for name, method in METHODS.items()},
    )


def expected_methods(
    pair: GearPair | RackPair,
    material: Materials,
    methods: Sequence[str],
    *,
    body: BodyModel | None = None,
    mounting: Mounting | None = None,
    positions: int = 0,
) -> Expected:
    """Return the seconds and the memory that `compare_methods` is expected to take."""
    refuse_halves(pair.pinion, _WHAT)
    inputs = _MethodInputs(pair, material, body or BodyModel(), mounting or Mounting(), positions)
    every = [_expected(inputs.method(name)) for name in methods]
    return Expected(sum(each.seconds for each in every), _PROGRAM + max((each.memory for each in every), default=0.0))


class _MethodInputs(NamedTuple):
    """Inputs of all methods."""

    pair: GearPair | RackPair
    material: Materials
    body: BodyModel
    mounting: Mounting
    positions: int

    def method(self, wanted: str | StiffnessMethod) -> StiffnessMethod | GearcadError:
        """Return a method, or why it cannot treat the pair. Raises ParameterError for an unknown name."""
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
    """Return the time and memory a method is expected to take; nothing for a method that is left out."""
    try:
        return Expected(0.0, 0.0) if isinstance(method, GearcadError) else method.expected
    except GearcadError:
        return Expected(0.0, 0.0)


def _over_load(method: StiffnessMethod, load: Load, at_load: MeshCycle) -> list[MeanAtTorque]:
    """Return means at parts of the load, and at the load itself."""
    loads = [replace(load, torque=part * load.torque) for part in _PARTS] if method.load_dependent else []
    cycles = [method(each, method.load_positions) for each in loads]
    return [MeanAtTorque(method.name, cycle.torque, cycle.mean, cycle.tangent_mean) for cycle in (*cycles, at_load)]
