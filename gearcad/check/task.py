"""CheckTask: the pair, load and options of a check, and which contact its pictures show."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from gearcad.check.options import CheckOptions, Model
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.line_of_action import gears_loaded_left
from gearcad.contact.shared.loaded import LoadedCycle, LoadedPosition, PairContact, width_in_mesh
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import PerGear, Role
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.tooth_friction import MeshFriction
from gearcad.hardness_depth import depth_profile_of
from gearcad.load import Load
from gearcad.material import Material, Materials, TabledNumber, of_both
from gearcad.mounting import Mounting, SupportCompliance
from gearcad.rating.friction import mesh_friction, scuffing_of_check
from gearcad.rating.load_factor_formulas import face_load_factor, helix_factors, root_face_load_factor, width_to_height
from gearcad.rating.load_factors import BodyLoad, FaceLoadSource, deflection_of
from gearcad.rating.nominal_rating import Rating, rate, rate_rack
from gearcad.rating.options import RatingOptions
from gearcad.rating.scuffing import Scuffing
from gearcad.rating.strength import StrengthRating, rate_strength

if TYPE_CHECKING:
    from gearcad.shafts.face_load import MeshOnShafts


@dataclass(frozen=True, kw_only=True)
class CheckTask:
    """Task of a check; `pair` is as mounted. `body_load` is that of a load distribution, if one is asked for.

    `face_load` finds the load over the face on the shafts for the rating, where they are known. `shafts` is the mesh on them,
    None for rigid ones.
    """

    pair: GearPair | RackPair
    material: Materials
    load: Load
    mounting: Mounting
    options: CheckOptions
    rating_options: RatingOptions = field(default_factory=RatingOptions)
    body_load: BodyLoad | None = None
    face_load: FaceLoadSource | None = None
    shafts: MeshOnShafts | None = None
    rated_material: Materials | None = None
    """Materials of the rating, where `material` has the moduli of plastics at the temperature of their teeth."""

    @property
    def gear_pair(self) -> GearPair:
        """The pair of gears. Raises TypeError for a pinion and a rack, which solid bodies and shafts do not know."""
        if isinstance(self.pair, RackPair):
            raise TypeError("a pinion and a rack are no pair of gears")
        return self.pair

    @property
    def gears(self) -> Mapping[Role, Gear]:
        """The gears; of a pinion and a rack the pinion alone."""
        return {Role.PINION: self.pair.pinion} if isinstance(self.pair, RackPair) else dict(self.pair.gears.items())

    @property
    def face_widths(self) -> PerGear[float]:
        """Face widths of both gears, or of pinion and rack (mm)."""
        pair = self.pair
        mate = pair.rack if isinstance(pair, RackPair) else pair.wheel
        return PerGear(pair.pinion.face_width, mate.face_width)

    @property
    def width(self) -> float:
        """Common face width (mm)."""
        return width_in_mesh(self.pair)

    @property
    def materials(self) -> PerGear[Material]:
        """Materials of both gears."""
        return of_both(self.material)

    @property
    def torque(self) -> float:
        """Torque on the pinion, with the application factor (N·m)."""
        return self.load.torque * self.load.application_factor

    @property
    def torques(self) -> tuple[float, ...]:
        """Torques of the sweep (N·m)."""
        return self.options.torques or tuple(part * abs(self.torque) for part in (0.1, 0.3, 0.55, 0.77, 1.0))

    @property
    def model(self) -> Model:
        """Model that the options give the pair."""
        return self.options.model_for(self.pair)

    @property
    def is_section(self) -> bool:
        """True of a transverse section of helical teeth, which is no model of the gears."""
        return self.model is Model.PLANE and bool(self.pair.pinion.helix_angle)

    @property
    def body(self) -> BodyModel:
        """The bodies as the model of the pair takes them."""
        body = self.options.body
        return body.for_solids() if self.model is Model.SOLID else body

    @cached_property
    def on_shafts(self) -> MeshOnShafts | None:
        """The mesh on shafts under the torque of the check, with the misalignment that the solid contact has; None for rigid
        shafts.
        """
        if self.shafts is None:
            return None
        return replace(self.shafts, pair=self.gear_pair, torque=self.torque, misalignment=self.mounting.misalignment)

    @cached_property
    def supports(self) -> SupportCompliance | None:
        """Effect of the shafts on the solid contact; None for rigid ones."""
        return None if self.on_shafts is None else self.on_shafts.face.supports()

    @cached_property
    def friction(self) -> MeshFriction | None:
        """Friction of the flanks; None where none is asked for. Raises ParameterError where its law has no coefficient."""
        asked = self.options.friction
        if asked is None:
            return None
        if isinstance(self.pair, RackPair):
            raise ParameterError("check.friction", asked, "must be left out for a pinion and a rack")
        return mesh_friction(self.pair, self.materials, self.load, asked, self.rating_options)

    @cached_property
    def scuffing(self) -> Scuffing | None:
        """Temperatures by the standard, which those along the path go by; None where no oil film is asked for.

        Raises ParameterError where there are none, or the oil is not known.
        """
        if not self.options.asks_film:
            return None
        if isinstance(self.pair, RackPair) or self.is_section or any(each.plastic for each in self.materials):
            permitted = "must be left out for a rack, for sections of helical gears and for gears of plastic"
            raise ParameterError("check.film", self.options.film, permitted)
        if self.rating_options.oil_viscosity_40 is None:
            raise ParameterError("rating.oil_viscosity_40", None, "must be given, in mm²/s at 40 °C, with check.film")
        found = scuffing_of_check(self.pair, self.materials, self.load, self.rating_options)
        if found.integral is None:
            raise ParameterError("check.film", self.options.film, f"must be left out: {found.reason}")
        if self.options.pressure_viscosity is None and found.oil.pressure_viscosity is None:
            permitted = f"must be given, in 1/GPa, for an oil of type {found.oil.kind.value}"
            raise ParameterError("check.pressure_viscosity", None, permitted)
        return found

    @cached_property
    def rating(self) -> Rating:
        """Rating by ISO 6336 or DIN 3990, Method B: nominal stresses with K_A."""
        if isinstance(self.pair, RackPair):
            return rate_rack(self.pair, self.material, self.load, self.rating_options)
        return rate(self.pair, self.material, self.load, self.rating_options)

    @cached_property
    def strength_rating(self) -> StrengthRating:
        """The full rating. Raises what `rate_strength` raises."""
        material = self.material if self.rated_material is None else self.rated_material
        return rate_strength(
            self.pair, material, self.load, self.rating_options, body_load=self.body_load, face_load=self.face_load
        )


def check_task(
    pair: GearPair | RackPair,
    material: Materials,
    load: Load,
    options: CheckOptions | None = None,
    mounting: Mounting | None = None,
    rating: RatingOptions | None = None,
    face_load: FaceLoadSource | None = None,
    shafts: MeshOnShafts | None = None,
) -> CheckTask:
    """Return the task of a pair in its mounting, on its shafts; a pinion and a rack have neither.

    Raises ParameterError and GeometryError for what cannot be checked.
    """
    options, mounting = options or CheckOptions(), mounting or Mounting()
    task = CheckTask(
        pair=pair if isinstance(pair, RackPair) else mounting.mounted(pair),
        material=material,
        load=load,
        mounting=mounting,
        options=options,
        rating_options=rating or RatingOptions(),
        face_load=face_load,
        shafts=shafts,
    )
    _require_meshing(task)
    _ = task.friction, task.scuffing
    for each in task.materials:
        depth_profile_of(each)
    return _at_temperature(task)


def _at_temperature(task: CheckTask) -> CheckTask:
    """Return the task with the moduli of plastics at the temperature of their roots, where a table has them over it."""
    if not any(isinstance(each.youngs_modulus, TabledNumber) for each in task.materials):
        return task
    plastic = task.strength_rating.plastic
    found = None if plastic is None else plastic.temperatures

    def warm(role: Role) -> Material:
        material = task.materials.pick(role)
        if plastic is None or found is None or not isinstance(material.youngs_modulus, TabledNumber):
            return material
        modulus = plastic.reading(role, "youngs_modulus", found.root).value
        return material if modulus is None else replace(material, youngs_modulus=modulus)

    return replace(task, material=PerGear.each(warm), rated_material=task.material)


def _require_meshing(task: CheckTask) -> None:
    """Raise for what no contact analysis can make sense of."""
    if not task.torque:
        raise ParameterError("load.torque", task.torque, "must not be 0: without torque there is nothing to check", "N·m")
    if task.pair.transverse_contact_ratio < 1:
        ratio = task.pair.transverse_contact_ratio
        raise GeometryError(
            "pair.transverse_contact_ratio",
            ratio,
            "must be at least 1: between two pairs of teeth no tooth would be in contact",
        )


P = TypeVar("P", bound=LoadedPosition[Any])
C = TypeVar("C", bound=PairContact)


class ShownContact(NamedTuple, Generic[P, C]):
    """A contact and its position; `interior` if part of it is away from the edges of the flanks."""

    position: P
    contact: C
    interior: bool


def shown_contact(cycle: LoadedCycle[Any, P, C]) -> ShownContact[P, C]:
    """Return the contact of the greatest pressure away from edges, or of the greatest load where all are near them."""
    worst = cycle.worst_contact
    position, contact = worst or cycle.heaviest_contact
    return ShownContact(position, contact, worst is not None)


class FaceFactors(NamedTuple):
    """F_beta_y (µm), K_H_beta and K_F_beta."""

    misalignment: float
    flank: float
    root: float


def face_factors(task: CheckTask) -> FaceFactors:
    """Return the face load factors from the mounting's misalignment and both helix angle modifications alone.

    They hold over the common face width. Deflections of shafts and bodies, crowning, end relief and running in are no part of
    them; K_v is 1.
    """
    rating = task.rating
    misalignment = task.mounting.misalignment + sum(_mismatch(task))
    flank = face_load_factor(misalignment, rating.stiffness.mesh_beta, rating.specific_load)
    return FaceFactors(misalignment, flank, root_face_load_factor(flank, width_to_height(task.gear_pair)))


def method_c_on_shafts(task: CheckTask) -> tuple[float, float]:
    """Return f_sh (µm) and K_Hbeta by Method C with the shaft of [rating], under the load of the check.

    1.33 B_1 f_sh and the misalignment of `face_factors` add up; deviations of manufacture and running in are no part of it, K_v
    is 1. Raises ParameterError for a shaft that is half given.
    """
    rating, options = task.rating, task.rating_options
    deflection = float(deflection_of(options, rating.specific_load, task.width, task.pair.pinion.reference_diameter))
    factor = helix_factors(options.helix_modification, options.standard).deflection
    misalignment = 1.33 * factor * deflection + abs(face_factors(task).misalignment)
    return deflection, face_load_factor(misalignment, rating.stiffness.mesh_beta, rating.specific_load)


def _mismatch(task: CheckTask) -> PerGear[float]:
    """Return the growth (µm) of the gap towards larger z over the common width.

    It is that by the helix angle modification of each gear.
    """
    width, carries_left = task.width, task.torque > 0

    def grows(gear: Gear) -> float:
        hand = -1 if gear.helix_angle < 0 else 1
        depth = gear.modification.helix_angle_modification * hand * (-1 if carries_left else 1)
        return depth * width / gear.face_width

    return gears_loaded_left(task.gear_pair).map(grows)
