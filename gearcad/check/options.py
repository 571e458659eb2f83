"""What a check looks at: the [check] table of a spec."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from gearcad.contact.plane.elasticity import Plane
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.chain import Cuts
from gearcad.contact.shared.holding import Hold
from gearcad.errors import (
    GeometryError,
    ParameterError,
    as_choice,
    plain_numbers,
    require_number,
    require_one_of,
    require_whole,
)
from gearcad.geometry import GearPair
from gearcad.material import STEEL_MODULUS
from gearcad.per_gear import PerGear
from gearcad.ranges import BAND, LENGTH, MODULUS, TORQUE
from gearcad.reprs import concise

__all__ = ["CheckOptions", "Model"]

_PLANES = {"strain": Plane.STRAIN, "stress": Plane.STRESS}
_AUTO = "auto"
_SWITCH = {"on": True, "off": False}

_LEAST_POSITIONS = 12


class Model(Enum):
    """What the gears are to the finite elements."""

    PLANE = "2d"
    """A section through the middle of the common face width."""

    SOLID = "3d"
    """Bodies over their face widths, in contact along lines."""


_POSITIONS = {Model.PLANE: 60, Model.SOLID: 24}


@dataclass(frozen=True, kw_only=True)
class CheckOptions:
    """Options of the structural check. Raises ParameterError.

    `model` is "2d", "3d", or "auto": solid bodies for helical gears, a plane for spur gears. `positions` over one base pitch,
    0 for the model's own number (60 in the plane, 24 of solids); `refinement` makes the edges of all elements that many times
    shorter; `convergence` "off" leaves out the other meshes, and with them the estimate of the error. `body_teeth` of each
    body, 0 for the full ring, and what holds its `cuts`: "fixed", "sliding" or "free". `pinion_inner_diameter`,
    `wheel_inner_diameter` (mm): where the bodies are held, instead of the bore or 4 m_n below the root circle.
    `pinion_support`, `wheel_support`: how they are held there, "rigid" all round, on an elastic "shaft", by the "key", "free",
    or "auto": rigid if the rim is 1.2 tooth depths thick or the diameter is given, else free, or by the key if there is one.
    `shaft_modulus` (MPa) and `pinion_shaft_bore`, `wheel_shaft_bore` (mm, 0 for a solid one) are those of the shaft, or of a
    ring that is the hub; solid bodies know neither shaft nor key. `torques` (N·m
    on the pinion) of the sweep, () for five up to the load's. `root_band`, `stiffness_band` and `contact_band` (%): how far
    root stress, stiffness, and load and stress along the lines of contact may be from ISO 6336. `plane` is "strain" (wide
    gears) or "stress": of the plane model only, as `contact_band` is of the solid one.
    """

    model: str = _AUTO
    plane: str = "strain"
    positions: int = 0
    refinement: float = 1.0
    convergence: str = "on"
    body_teeth: int = 0
    cuts: str = "fixed"
    pinion_inner_diameter: float | None = None
    wheel_inner_diameter: float | None = None
    pinion_support: str = "auto"
    wheel_support: str = "auto"
    shaft_modulus: float = STEEL_MODULUS
    pinion_shaft_bore: float = 0.0
    wheel_shaft_bore: float = 0.0
    torques: tuple[float, ...] = ()
    root_band: float = 25.0
    stiffness_band: float = 25.0
    contact_band: float = 25.0

    __repr__ = concise

    def __post_init__(self) -> None:
        plain_numbers(self)
        require_one_of("model", self.model, (*(model.value for model in Model), _AUTO))
        require_one_of("plane", self.plane, _PLANES)
        require_one_of("convergence", self.convergence, _SWITCH)
        as_choice("cuts", self.cuts, Cuts)
        if self.positions != 0:
            require_whole("positions", self.positions, at_least=_LEAST_POSITIONS, at_most=1000)
        require_number("refinement", self.refinement, at_least=0.25, at_most=4)
        if self.body_teeth != 0:
            require_whole("body_teeth", self.body_teeth, at_least=3, at_most=999)
            if self.body_teeth % 2 == 0:
                raise ParameterError("body_teeth", self.body_teeth, "must be odd (the loaded tooth stands in the middle), or 0")
        for name in ("pinion_inner_diameter", "wheel_inner_diameter"):
            if getattr(self, name) is not None:
                LENGTH.require(name, getattr(self, name))
        for name in ("pinion_support", "wheel_support"):
            as_choice(name, getattr(self, name), Hold)
        MODULUS.require("shaft_modulus", self.shaft_modulus)
        for name in ("pinion_shaft_bore", "wheel_shaft_bore"):
            require_number(name, getattr(self, name), LENGTH.unit, at_least=0, at_most=LENGTH.most)
        torques = self.torques if isinstance(self.torques, list | tuple) else (self.torques,)
        for torque in torques:
            require_number("torques", torque, TORQUE.unit, at_least=TORQUE.least, at_most=TORQUE.most)
        object.__setattr__(self, "torques", tuple(float(torque) for torque in torques))
        for name in ("root_band", "stiffness_band", "contact_band"):
            BAND.require(name, getattr(self, name))

    def model_for(self, pair: GearPair) -> Model:
        """The model of a pair. Raises GeometryError for helical gears in a plane."""
        helix = pair.pinion.helix_angle
        if self.model == _AUTO:
            return Model.SOLID if helix else Model.PLANE
        if helix and self.model == Model.PLANE.value:
            permitted = "must be 0 for model 2d: the lines of contact of helical teeth run across the flank, as in model 3d"
            raise GeometryError("pair.helix_angle", helix, permitted, "deg")
        return Model(self.model)

    def positions_of(self, model: Model) -> int:
        """Positions over one base pitch."""
        return self.positions or _POSITIONS[model]

    @property
    def refines(self) -> bool:
        """True if other meshes tell the error."""
        return _SWITCH[self.convergence]

    @property
    def plane_state(self) -> Plane:
        """The plane state as the FE wants it."""
        return _PLANES[self.plane]

    @property
    def body(self) -> BodyModel:
        """The bodies as the FE wants them."""
        inner = PerGear(self.pinion_inner_diameter, self.wheel_inner_diameter)
        return BodyModel(
            teeth=self.body_teeth or None,
            cuts=Cuts(self.cuts),
            inner_diameters=inner,
            holds=PerGear(Hold(self.pinion_support), Hold(self.wheel_support)),
            shaft_modulus=self.shaft_modulus,
            shaft_bores=PerGear(self.pinion_shaft_bore, self.wheel_shaft_bore),
        )
