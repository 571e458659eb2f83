"""The fields that notices about a design are about: where one looks first when one wants them gone."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import Any

from gearcad.designs.design import Design
from gearcad.notice import Notice
from gearcad.page.fields import fields_of

__all__ = ["keys_of", "shown_notices"]

_ABOUT = {
    "undercut": "profile_shift rack.addendum",
    "thin-tip": "profile_shift tip_alteration",
    "full-radius": "rack.root_radius",
    "form-root": "cutter.teeth",
    "span-off-involute": "profile_shift tip_alteration",
    "balls-off-involute": "profile_shift",
    "narrow-for-span": "face_width",
    "narrow-for-pins": "face_width",
    "web-not-modelled": "body.web_thickness",
    "cutter-trims-tips": "cutter.teeth tip_alteration",
    "cutter-trims-on-infeed": "cutter.teeth",
    "rounded-shifts": "centre_distance tooth_thinning",
    "backlash-may-vanish": "tooth_thinning tooth_allowance centre_distance_tolerance",
    "low-contact-ratio": "centre_distance helix_angle",
    "fillet-interference": "tip_alteration rack.root_radius rack.addendum",
    "undercut-contact": "profile_shift",
    "radial-assembly": "teeth",
    "no-pin": "pin_diameter",
    "low-pin": "pin_diameter",
    "no-hunting-tooth": "teeth",
    "wide-backlash": "tooth_thinning",
    "stage-in-the-way": "axial_position",
    "unbalanced": "planets",
}
"""By the codes of notices, keys of the table that they are about, the first one first."""

_MOST = 2
"""Fields that are named with a notice: more would hide it."""


def keys_of(design: Design) -> frozenset[str]:
    """Those of the fields that the specs of a kind have."""
    return frozenset(field["key"] for table in fields_of(design, {}) for group in table["groups"] for field in group["fields"])


def shown_notices(notices: Collection[Notice], keys: Collection[str]) -> tuple[dict[str, Any], ...]:
    """Each notice once, with those of the `keys` of a spec's fields that it is about."""
    found: dict[str, Any] = {}
    for notice in notices:
        found.setdefault(str(notice), {"code": notice.code, "text": str(notice), "keys": _keys(notice, keys)})
    return tuple(found.values())


def _keys(notice: Notice, keys: Collection[str]) -> list[str]:
    """Of the table that the notice names; else of those of what is in mesh."""
    fields = _ABOUT.get(notice.code, "").split()
    for tables in (re.split(": |-", notice.where), ("pair", "pinion", "wheel", "planetary")):
        about = dict.fromkeys(f"{table}.{field}" for field in fields for table in tables)
        if found := [key for key in about if key in keys]:
            return found[:_MOST]
    return []
