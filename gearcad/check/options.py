"""Options of a check: the [check] table of a spec."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Annotated

from gearcad.contact.plane.sector import Plane
from gearcad.contact.shared.bodies import BodyModel, Cuts, Hold
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.quantities import (
    BAND,
    FRICTION,
    LENGTH,
    MODULUS,
    TORQUE,
    WHEN_GIVEN,
    AssumedNumber,
    Choice,
    Member,
    Range,
    Whole,
    Words,
    require_fields,
)
from gearcad.core.records import PerGear, concise
from gearcad.geometry import GearPair, RackPair
from gearcad.material import STEEL_MODULUS
from gearcad.rating.friction import FrictionLaw

__all__ = ["CheckOptions", "Model"]

_PLANES = {"strain": Plane.STRAIN, "stress": Plane.STRESS}
_AUTO = "auto"
_SWITCH = {"on": True, "off": False}


class Model(Enum):
    """Model of the gears in the finite elements."""

    PLANE = "2d"
    """A section through the middle of the common face width."""

    SOLID = "3d"
    """Bodies over their face widths, in contact along lines."""


_SECTION = "section"
"""Choice of the plane model, of helical teeth too."""

_MODELS = Choice((*(model.value for model in Model), _SECTION, _AUTO))
_POSITIONS = {Model.PLANE: 60, Model.SOLID: 24}
_SHAFT_BORE = LENGTH._replace(least=0.0)
_TORQUES = TORQUE._replace(signed=False)


@dataclass(frozen=True, kw_only=True)
class CheckOptions:
    """Options of the structural check. Raises ParameterError.

    `model` is "2d", "3d", "section", or "auto": solid bodies for helical gears, a plane for spur gears. A "section" is the
    plane model, of helical gears too: their transverse section under the load per width, which judges no strength.

    `positions` over one base pitch,
    0 for the model's own number (60 in the plane, 24 of solids); `refinement` makes the edges of all elements that many times
    shorter; `convergence` "off" leaves out the other meshes, and with them the estimate of the error. `body_teeth` of each
    body, 0 for the full ring, and what holds its `cuts`: "fixed", "sliding" or "free". `pinion_inner_diameter`,
    `wheel_inner_diameter` (mm): where the bodies are held, instead of the bore or 4 m_n below the root circle.
    `pinion_support`, `wheel_support`: how they are held there, "rigid" all round, on an elastic "shaft", by the "key", "free",
    or "auto": rigid if the rim is 1.2 tooth depths thick or the diameter is given, else free, or by the key if there is one. A
    ring is held on its rim, "rigid" all round ("auto" too) or by its "bolts".
    `shaft_modulus` (MPa) and `pinion_shaft_bore`, `wheel_shaft_bore` (mm, 0 for a solid one) are those of the shaft, or of a
    ring that is the hub; solid bodies know neither shaft nor key. `torques` (N·m
    on the pinion) of the sweep, () for five up to the load's. `root_band`, `stiffness_band` and `contact_band` (%): how far
    root stress, stiffness, and load and stress along the lines of contact may be from ISO 6336. `plane` is "strain" (wide
    gears) or "stress": of the plane model only, as `contact_band` is of the solid one. `friction` is the coefficient of
    friction of the flanks, or its law: "flash", "integral" or "niemann"; None for none.
    `film` "on" asks for temperatures and the oil film along the path of contact; `pressure_viscosity` is alpha_38 of the oil
    (1/GPa), `permissible_film` lambda_GFP.
    """

    model: Annotated[str, _MODELS, Words("model: plane (2d), solid bodies (3d) or section")] = _AUTO
    plane: Annotated[str, Choice(tuple(_PLANES)), Words("plane strain or plane stress")] = "strain"
    positions: Annotated[int, Whole(12, 1000, may_vanish=True), Words("positions over one base pitch")] = 0
    refinement: Annotated[float, Range("", 0.25, 4.0), Words("how much finer than usual the elements are")] = 1.0
    convergence: Annotated[str, Choice(tuple(_SWITCH)), Words("whether finer meshes tell the error")] = "on"
    body_teeth: Annotated[int, Whole(3, 999, may_vanish=True), Words("teeth of the body, 0 for the full ring")] = 0
    cuts: Annotated[str, Member(Cuts), Words("what holds the cuts of the body")] = "fixed"
    pinion_inner_diameter: Annotated[float | None, LENGTH, Words("diameter where the pinion is held")] = None
    wheel_inner_diameter: Annotated[float | None, LENGTH, Words("diameter where the wheel is held")] = None
    pinion_support: Annotated[str, Member(Hold), Words("what holds the pinion there")] = "auto"
    wheel_support: Annotated[str, Member(Hold), Words("what holds the wheel there")] = "auto"
    shaft_modulus: Annotated[float, MODULUS, Words("modulus of an elastic shaft", "E")] = AssumedNumber(STEEL_MODULUS)
    pinion_shaft_bore: Annotated[float, _SHAFT_BORE, Words("bore of the pinion's elastic shaft")] = 0.0
    wheel_shaft_bore: Annotated[float, _SHAFT_BORE, Words("bore of the wheel's elastic shaft")] = 0.0
    torques: Annotated[tuple[float, ...], _TORQUES, Words("torques of the sweep, on the pinion", "T_1")] = ()
    root_band: Annotated[float, BAND, Words("how far root stresses may be from the standard")] = 25.0
    stiffness_band: Annotated[float, BAND, Words("how far stiffness may be from the standard")] = 25.0
    contact_band: Annotated[float, BAND, Words("how far the contact stress may be from the standard")] = 25.0
    friction: Annotated[float | FrictionLaw | None, FRICTION, Words("friction of the flanks, or its law", "µ"), WHEN_GIVEN] = (
        None
    )
    film: Annotated[str | None, Choice(tuple(_SWITCH)), Words("temperature and oil film along the path"), WHEN_GIVEN] = None
    pressure_viscosity: Annotated[
        float | None, Range("1/GPa", 0.1, 100.0), Words("pressure viscosity of the oil at 38 °C", "α_38"), WHEN_GIVEN
    ] = None
    permissible_film: Annotated[
        float | None, Range("", 1e-3, 100.0), Words("permissible specific film", "λ_GFP", "ISO/TS 6336-22"), WHEN_GIVEN
    ] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        if not isinstance(self.torques, list | tuple):
            object.__setattr__(self, "torques", (self.torques,))
        require_fields(self)
        if self.body_teeth and self.body_teeth % 2 == 0:
            raise ParameterError("body_teeth", self.body_teeth, "must be odd (the loaded tooth stands in the middle), or 0")
        object.__setattr__(self, "torques", tuple(map(float, self.torques)))
        for name in ("pressure_viscosity", "permissible_film"):
            if (given := getattr(self, name)) is not None and not self.asks_film:
                raise ParameterError(name, given, 'must be left out without film = "on"')

    @property
    def asks_film(self) -> bool:
        """Whether temperatures and the oil film are asked for."""
        return self.film is not None and _SWITCH[self.film]

    def model_for(self, pair: GearPair | RackPair) -> Model:
        """Return the model of a pair. Raises GeometryError for helical gears in a plane, ParameterError for a solid rack."""
        helix = pair.pinion.helix_angle
        if self.model == _SECTION:
            return Model.PLANE
        if isinstance(pair, RackPair):
            return self._model_of_rack(helix)
        if self.model == _AUTO:
            return Model.SOLID if helix else Model.PLANE
        if helix and self.model == Model.PLANE.value:
            permitted = "must be 0 for model 2d: the lines of contact of helical teeth run across the flank, as in model 3d"
            raise GeometryError("pair.helix_angle", helix, permitted, "deg")
        return Model(self.model)

    def _model_of_rack(self, helix: float) -> Model:
        """Return the model of a pinion and a rack: sections, of spur teeth unless they are asked for."""
        if self.model == Model.SOLID.value:
            permitted = 'must be "2d", "section" or "auto" for a rack: there are no solid bodies of racks'
            raise ParameterError("check.model", self.model, permitted)
        if helix:
            permitted = 'must be 0 for a rack, which has no solid bodies; check.model = "section" takes the transverse section'
            raise GeometryError("pair.helix_angle", helix, permitted, "deg")
        return Model.PLANE

    def positions_of(self, model: Model) -> int:
        """Return the positions over one base pitch."""
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
