"""What documents say of a train."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gearcad.notice import texts
from gearcad.planetary.clearances import free_distance
from gearcad.planetary.members import Carrier, Central, Rim
from gearcad.planetary.train_data import TrainData
from gearcad.planetary.train_notices import train_notices
from gearcad.schema import schema_of

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["train_document"]

_GIVEN = ("planets", "input", "output", "fixed", "tip_distance", "basic_ratio", "positions", "unbalance")


def train_document(train: TrainData) -> dict[str, Any]:
    """What a train is given and derives, its meshes among it, for JSON; the gears have documents of their own."""
    parts: list[Central | Rim | Carrier] = [*train.centrals, *train.rims, train.carrier]
    notices = tuple(train_notices(train))
    return {
        "set_type": train.set_type.value,
        **{key: getattr(train, key) for key in _GIVEN},
        "centre_distance": float(train.centre_distance),
        "free_tip_distance": free_distance(train),
        "planet_angles": list(train.angles),
        "members": {part.name: _fields(part) for part in parts},
        "meshes": {mesh.name: mesh.pair.to_dict() for mesh in train.meshes},
        "stages": {stage.name: _fields(stage) | stage.pair.to_dict() for stage in train.stages},
        "warnings": list(texts(notices)),
        "notices": [notice.to_dict() for notice in notices],
    }


def _fields(part: DataclassInstance) -> dict[str, Any]:
    """What is given of a part beside its gears; lists as JSON has them."""
    fields = {
        name: getattr(part, name) for name, field in schema_of(type(part)).items() if field.part is None and name != "name"
    }
    return {name: list(value) if isinstance(value, tuple) else value for name, value in fields.items()}
