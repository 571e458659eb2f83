"""What a check looks at: the [check] table of a spec."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.errors import ParameterError, as_choice, plain_numbers, require_number, require_whole
from gearcad.fea.chain import Cuts
from gearcad.fea.elasticity import Plane
from gearcad.fea.flexible_pair import BodyModel

__all__ = ["CheckOptions"]

_PLANES = {"strain": Plane.STRAIN, "stress": Plane.STRESS}


@dataclass(frozen=True, kw_only=True)
class CheckOptions:
    """Options of the structural check. Raises ParameterError.

    `plane` is "strain" (wide gears) or "stress"; `positions` over one base pitch; `body_teeth` of each body, 0 for the full
    ring, and what holds its `cuts`: "fixed", "sliding" or "free". `pinion_inner_diameter`, `wheel_inner_diameter` (mm):
    where the bodies are held, instead of the bore or 4 m_n below the root circle. `torques` (N·m on the pinion) of the
    sweep, () for five up to the load's. `root_band` and `stiffness_band` (%): how far the FE may be from ISO 6336.
    """

    plane: str = "strain"
    positions: int = 60
    body_teeth: int = 0
    cuts: str = "fixed"
    pinion_inner_diameter: float | None = None
    wheel_inner_diameter: float | None = None
    torques: tuple[float, ...] = ()
    root_band: float = 25.0
    stiffness_band: float = 25.0

    def __post_init__(self) -> None:
        plain_numbers(self)
        if self.plane not in _PLANES:
            raise ParameterError("plane", self.plane, 'must be "strain" or "stress"')
        as_choice("cuts", self.cuts, Cuts)
        require_whole("positions", self.positions, at_least=12, at_most=1000)
        if self.body_teeth != 0:
            require_whole("body_teeth", self.body_teeth, at_least=3, at_most=999)
            if self.body_teeth % 2 == 0:
                raise ParameterError("body_teeth", self.body_teeth, "must be odd (the loaded tooth stands in the middle), or 0")
        for name in ("pinion_inner_diameter", "wheel_inner_diameter"):
            if getattr(self, name) is not None:
                require_number(name, getattr(self, name), "mm", above=0)
        torques = self.torques if isinstance(self.torques, list | tuple) else (self.torques,)
        for torque in torques:
            require_number("torques", torque, "N·m", above=0)
        object.__setattr__(self, "torques", tuple(float(torque) for torque in torques))
        for name in ("root_band", "stiffness_band"):
            require_number(name, getattr(self, name), "%", above=0)

    @property
    def plane_state(self) -> Plane:
        """The plane state as the FE wants it."""
        return _PLANES[self.plane]

    @property
    def body(self) -> BodyModel:
        """The bodies as the FE wants them."""
        inner = (self.pinion_inner_diameter, self.wheel_inner_diameter)
        return BodyModel(teeth=self.body_teeth or None, cuts=Cuts(self.cuts), inner_diameters=inner)
