"""A train as one writes it down: its members, the torques on them, and how finely shafts are modelled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import Annotated

from gearcad.dynamics.trains.graph import Graph
from gearcad.dynamics.trains.members import Inertia, Mesh, Shaft
from gearcad.errors import GeometryError, ParameterError, require_name
from gearcad.ranges import SPEED, TORQUE, Whole
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields

__all__ = ["Train", "TrainModel"]


class TrainModel(Enum):
    """How much of the shafts a train knows: the levels of modelling of Osinski's paper, and what lies beyond them."""

    ISOLATED = "isolated"
    """No shafts: the meshes and the inertias in them, loaded by the mesh forces of the whole train."""
    MASSLESS = "massless"
    """Shafts are springs."""
    MODES = "modes"
    """Shafts have mass; each line of shafts and inertias keeps its first modes (the paper's quasi-normal coordinates)."""
    ELEMENTS = "elements"
    """Shafts have mass; one hierarchical element of degree `order` each, which is good for order/3 half waves or so."""
    EXACT = "exact"
    """Natural frequencies of the wave equation itself; response as with elements, of a higher degree where it is needed."""


@dataclass(frozen=True, kw_only=True)
class Train:
    """Inertias, the shafts between them, the meshes of their teeth, and the torques on them.

    `model` says what is known of the shafts: one word changes it. `torques` in N·m by the names of inertias, counter-clockwise
    positive; on a train that no shaft holds they must balance. `speed` in rpm is that of the first mesh's pinion. `order` is
    the degree of the polynomials on a shaft with mass. Raises ParameterError and GeometryError.
    """

    name: str = "train"
    model: Annotated[TrainModel, Words("what is known of the shafts")] = TrainModel.ELEMENTS
    inertias: tuple[Inertia, ...]
    shafts: tuple[Shaft, ...] = ()
    meshes: tuple[Mesh, ...] = ()
    torques: Mapping[str, float] = field(default_factory=dict)
    speed: Annotated[float, SPEED, Words("speed of the first mesh's pinion", "n_1")] = 0.0
    order: Annotated[int, Whole(2, 40), Words("degree of the polynomials on a shaft with mass")] = 12

    __repr__ = concise

    def __post_init__(self) -> None:
        require_name("name", self.name)
        require_fields(self)
        for parameter in ("inertias", "shafts", "meshes"):
            object.__setattr__(self, parameter, tuple(getattr(self, parameter)))
        object.__setattr__(self, "torques", dict(self.torques))
        for inertia, torque in self.torques.items():
            TORQUE.require(f"torques.{inertia}", torque)
        self._graph.require_one_train(self.torques)
        if self.model is TrainModel.ISOLATED and not self.meshes:
            raise GeometryError("model", self.model, "a train without meshes has nothing that is left without shafts")
        if not self.held:
            self._graph.require_balance(self.torques)
        self._check_modes()

    def _check_modes(self) -> None:
        """Elements of a low degree have no accurate high modes to be kept."""
        for shaft in self.shafts if self.model is TrainModel.MODES else ():
            if shaft.torsional_stiffness is None and shaft.modes is not None and 2 * shaft.modes > self.order:
                permitted = f"must be at most half the order {self.order} of the elements, for accurate modes"
                raise ParameterError(f"{shaft.name}.modes", shaft.modes, permitted)

    @property
    def held(self) -> bool:
        """Whether a shaft holds the train: otherwise it turns as a whole, at 0 Hz."""
        return any(shaft.held for shaft in self.shafts)

    @property
    def _graph(self) -> Graph:
        return Graph(self.inertias, self.shafts, self.meshes)

    @cached_property
    def speed_ratios(self) -> dict[str, float]:
        """Nominal turns of every inertia per turn of the first mesh's pinion, counter-clockwise positive."""
        return self._graph.speed_ratios()

    @property
    def tooth_frequencies(self) -> dict[str, float]:
        """Of every mesh, at `speed` (Hz)."""
        return {mesh.name: abs(self.speed_ratios[mesh.pinion] * self.speed) * mesh.teeth / 60 for mesh in self.meshes}
