"""What all methods share: a pair, its material and bodies, in the form `method(load) -> MeshCycle`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

from gearcad.contact.shared.bodies import BodyModel
from gearcad.errors import GeometryError, ParameterError, require_whole
from gearcad.geometry import GearPair
from gearcad.geometry.halves import refuse_halves
from gearcad.load import Load
from gearcad.material import Material, Materials, of_both
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.notice import Notice
from gearcad.per_gear import PerGear
from gearcad.progress import Expected, Share, unheard

__all__ = ["StiffnessMethod", "left_out"]

FEWEST_POSITIONS, MOST_POSITIONS = 12, 5000


@dataclass(frozen=True, kw_only=True)
class StiffnessMethod(ABC):
    """A method for the mesh stiffness of a pair of gears of one material or two: called with a load, it gives the MeshCycle.

    `body` says where the bodies are held, `mounting` how the gears stand; `positions` over one base pitch, 0 for the
    method's own number. Raises ParameterError and GeometryError for what the method cannot treat.
    """

    pair: GearPair
    material: Materials = field(default_factory=Material)
    body: BodyModel = field(default_factory=BodyModel)
    mounting: Mounting = field(default_factory=Mounting)
    positions: int = 0
    tell: Share = field(default=unheard, compare=False, repr=False)
    """Hears how much of a long method is done."""

    name: ClassVar[str]
    title: ClassVar[str]
    holds: ClassVar[tuple[str, ...]]
    default_positions: ClassVar[int] = 200
    load_dependent: ClassVar[bool] = True
    no_internal_form: ClassVar[str] = ""
    """Why the method has none, so that it refuses rings."""
    mean_only: ClassVar[bool] = False
    """True of a method that knows no course over the mesh."""
    load_positions: ClassVar[int] = 48
    """Positions, 0 for as many as ever, at which other loads than that of the pair are tried."""
    seconds: ClassVar[float] = 0.2
    """What the method is expected to take."""

    def __post_init__(self) -> None:
        if not (isinstance(self.positions, int) and self.positions == 0):
            require_whole("positions", self.positions, at_least=FEWEST_POSITIONS, at_most=MOST_POSITIONS)
        refuse_halves(self.pair.pinion, self.name)
        if self.pair.internal and self.no_internal_form:
            permitted = f"must be above 0 for {self.name}: {self.no_internal_form}"
            raise GeometryError("wheel.teeth", self.pair.wheel.teeth, permitted)
        ratio = self.mounted.usable_contact_ratio
        if ratio < 1:
            whole = self.mounted.transverse_contact_ratio
            reason = "the teeth lose each other" if whole < 1 else f"fillets take away what the tips' {whole:.4f} promise"
            raise GeometryError("pair.usable_contact_ratio", ratio, f"must be at least 1 for a mesh stiffness: {reason}")

    def __call__(self, load: Load, positions: int = 0) -> MeshCycle:
        """The mesh cycle under a load, at so many `positions` for once if any are given.

        Raises ParameterError without a torque, and what the method's solver raises.
        """
        if not load.torque:
            raise ParameterError("load.torque", load.torque, "must not be 0: stiffness depends on the load", "N·m")
        return self._cycle(load, positions or self.positions or self.default_positions)

    @property
    def expected(self) -> Expected:
        """What a comparison is expected to take with this method: its cycle under several loads."""
        return Expected(self.seconds, 0.0)

    @abstractmethod
    def _cycle(self, load: Load, count: int) -> MeshCycle: ...

    @property
    def materials(self) -> PerGear[Material]:
        """Those of both gears."""
        return of_both(self.material)

    @cached_property
    def mounted(self) -> GearPair:
        """The pair at the centre distance of its mounting."""
        return self.mounting.mounted(self.pair)

    @property
    def width(self) -> float:
        """Common face width (mm), on which all of the load is."""
        return self.mounted.common_width.width

    def torque(self, load: Load) -> float:
        """What the pinion carries, application factor included (N·m, positive)."""
        return abs(load.torque) * load.application_factor

    def force(self, load: Load) -> float:
        """F_bt: what all flanks carry together along the line of action (N)."""
        return 2000 * self.torque(load) / self.mounted.pinion.base_diameter

    def inputs(self, load: Load) -> dict[str, Any]:
        """What a MeshCycle tells of its method, the load and the pair, under the names there."""
        return {
            "method": self.name,
            "holds": self.holds,
            "torque": self.torque(load),
            "force": self.force(load),
            "width": self.width,
            "mean_only": self.mean_only,
            "notices": tuple(self.notices(load)),
        }

    def notices(self, load: Load) -> Iterator[Notice]:
        """What to know before trusting the method with this pair under a load: here what nominal teeth leave out."""
        gears = self.mounted.gears.items()
        found = [f"the {role.value}'s flank modifications" for role, gear in gears if gear.modification.present]
        found += ["misalignment and pitch errors"] if self.mounting.tilted or self.mounting.pitch_error else []
        yield from left_out(found)


def left_out(found: Sequence[str]) -> Iterator[Notice]:
    """That a method does not see these features of a pair, in words."""
    if found:
        yield Notice("left-out", f"leaves out {' and '.join(found)}")
