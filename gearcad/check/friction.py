"""Friction in a check: coefficient, power lost and efficiency over the mesh cycle, beside Ohlendorf's loss factor."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle
from gearcad.core.records import Floats, JsonObject, Notice, freeze
from gearcad.geometry.tooth_friction import MeshFriction, ohlendorf_loss_factor
from gearcad.rating.friction import LAW_WORDS


@dataclass(frozen=True, kw_only=True)
class MeshLosses:
    """Losses of a mesh by the friction of its flanks: `coefficient` by the law of `friction`, 0 without friction.

    `lost_torque` (n,) in N·m at `roll_angles` (n,) in deg, all positions, is the power that friction takes over the angular
    speed of the pinion; `mean_torque` (N·m) its mean over the base pitch. `mean_loss` (W) is None at rest. `ohlendorf` is H_V
    of Ohlendorf, None where it does not hold; `loss_factor` is H_V of this contact, None without friction.
    """

    friction: MeshFriction
    coefficient: float
    torque: float
    speed: float
    roll_angles: Floats
    lost_torque: Floats
    mean_torque: float
    ohlendorf: float | None

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def law(self) -> str:
        """Name of the law, a key of LAW_WORDS."""
        return self.friction.law

    @property
    def words(self) -> str:
        """Words on the law."""
        return LAW_WORDS[self.law]

    @property
    def efficiency(self) -> float:
        """Share of the power of the pinion that friction leaves on the mean; of that of the wheel where it drives."""
        lost = self.mean_torque / abs(self.torque)
        return 1 - lost if self.friction.driver.value == "pinion" else 1 / (1 + lost)

    @property
    def mean_loss(self) -> float | None:
        """Mean power that friction takes (W)."""
        return self.mean_torque * abs(self.speed) * math.pi / 30 if self.speed else None

    @property
    def loss_factor(self) -> float | None:
        """H_V of this contact: the share of the power that is lost, over the coefficient of friction."""
        return self.mean_torque / abs(self.torque) / self.coefficient if self.coefficient else None

    def to_dict(self) -> JsonObject:
        """Return the content of "friction" in check.json."""
        return {
            "law": self.law,
            "coefficient": self.coefficient,
            "driver": self.friction.driver.value,
            "mean_loss": self.mean_loss,
            "efficiency": self.efficiency,
            "H_V": self.ohlendorf,
            "H_V_contact": self.loss_factor,
            "roll_angle": self.roll_angles.tolist(),
            "lost_torque": self.lost_torque.tolist(),
            "unconfirmed": ["coefficient"] if self.law == "niemann" else [],
        }


def mesh_losses(task: CheckTask, cycle: Cycle) -> MeshLosses | None:
    """Return the losses of a cycle; None where no friction is asked for."""
    friction = task.friction
    if friction is None:
        return None
    return MeshLosses(
        friction=friction,
        coefficient=friction.coefficient(cycle.model.force(task.torque)),
        torque=task.torque,
        speed=task.load.speed,
        roll_angles=cycle.course("roll_angle"),
        lost_torque=cycle.course("lost_torque"),
        mean_torque=float(cycle.mean("lost_torque")[0]),
        ohlendorf=ohlendorf_loss_factor(task.gear_pair),
    )


def friction_notices(task: CheckTask) -> Iterator[Notice]:
    """Yield what is to be known of the friction of a check."""
    friction = task.friction
    if friction is None:
        return
    if friction.law == "niemann":
        text = "the coefficient of friction is the mean one of Niemann and ISO/TR 14179-2 as remembered: unconfirmed"
        yield Notice("friction-unconfirmed", text)
    if task.on_shafts is not None and friction.reference:
        yield Notice("friction-not-on-shafts", "friction acts on the teeth and bodies; it does not bend the shafts here")
