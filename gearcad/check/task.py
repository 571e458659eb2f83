"""CheckTask: what is to be checked."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from gearcad.check.options import CheckOptions, Model
from gearcad.contact.shared.bodies import BodyModel
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.rating import Rating, RatingOptions, rate

__all__ = ["CheckTask"]


@dataclass(frozen=True, kw_only=True)
class CheckTask:
    """What is to be checked; `pair` is as mounted."""

    pair: GearPair
    material: Material
    load: Load
    mounting: Mounting
    options: CheckOptions
    rating_options: RatingOptions = field(default_factory=RatingOptions)

    @property
    def torque(self) -> float:
        """On the pinion, with the application factor (N·m)."""
        return self.load.torque * self.load.application_factor

    @property
    def torques(self) -> tuple[float, ...]:
        """Of the sweep (N·m)."""
        return self.options.torques or tuple(part * abs(self.torque) for part in (0.1, 0.3, 0.55, 0.77, 1.0))

    @property
    def model(self) -> Model:
        """That which the options give the pair."""
        return self.options.model_for(self.pair)

    @property
    def body(self) -> BodyModel:
        """The bodies as the model of the pair takes them."""
        body = self.options.body
        return body.for_solids() if self.model is Model.SOLID else body

    @cached_property
    def rating(self) -> Rating:
        """By ISO 6336 or DIN 3990, Method B."""
        return rate(self.pair, self.material, self.load, self.rating_options)
