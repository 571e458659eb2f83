"""What a rating says of the gears of a set, by their own names in place of pinion and wheel."""

from __future__ import annotations

import re
from dataclasses import replace

from gearcad.per_gear import PerGear, Role
from gearcad.rating.strength.part import PartStrength
from gearcad.rating.strength.rating import StrengthRating

__all__ = ["called"]

_ROLES = re.compile(rf"(?<!\w)({'|'.join(role.value for role in Role)})(?!\w)")


def called(rating: StrengthRating, names: PerGear[str]) -> StrengthRating:
    """The rating with `names` in all that it says; documents keep values under "pinion" and "wheel"."""
    by_role = {role.value: name for role, name in names.items()}

    def said(text: str) -> str:
        return _ROLES.sub(lambda role: by_role[role[0]], text)

    def of_part(part: PartStrength) -> PartStrength:
        return replace(part, reason=said(part.reason))

    return replace(
        rating,
        own_names=names,
        flank=rating.flank.map(of_part),
        root=rating.root.map(of_part),
        assumed=tuple(map(said, rating.assumed)),
        verify=tuple(map(said, rating.verify)),
        notices=tuple(replace(each, text=said(each.text), where=said(each.where)) for each in rating.notices),
    )
