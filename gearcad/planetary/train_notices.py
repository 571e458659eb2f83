"""What to know of a planetary train before making it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import replace

from gearcad.notice import Notice
from gearcad.planetary.mesh import SetMesh
from gearcad.planetary.stage_room import stage_notices
from gearcad.planetary.train_data import TrainData

__all__ = ["train_notices"]

_WIDE = 0.1
"""Backlash in normal modules that no gear is made with on purpose."""

_BALANCED = 1e-9
"""Unbalance that is rounding."""


def train_notices(train: TrainData) -> Iterator[Notice]:
    """Those of the pairs, backlash, teeth that meet too often, stages in the way, planets that do not balance each other."""
    for mesh in train.meshes:
        yield from _named(mesh)
        module, backlash = mesh.pair.pinion.normal_module, mesh.pair.circumferential_backlash
        if backlash > _WIDE * module:
            text = f"its backlash is {backlash:.4g} mm, {backlash / module:.2g} normal modules"
            yield Notice("wide-backlash", text, where=mesh.name)
        central, rim = mesh.central.gear.tooth_count, mesh.rim.gear.tooth_count
        if (common := math.gcd(central, rim)) > 1:
            text = f"{central} and {rim} teeth have the factor {common}: a tooth meets only one in {common} of its mate's"
            yield Notice("no-hunting-tooth", text, where=mesh.name)
    for stage in train.stages:
        yield from (notice.within(stage.name) for notice in stage.pair.notices)
    yield from stage_notices(train)
    if train.adjusted:
        text = "the rims of each planet are clocked by themselves: the planets are not alike, and each fits in its own place"
        yield Notice("adjusted-planets", text)
    if train.unbalance > _BALANCED:
        alone = "a planet alone has nothing that balances it" if train.planets == 1 else "the planets do not balance each other"
        yield Notice("unbalanced", f"{alone}: they pull outwards as {train.unbalance:.4g} of one (|sum exp(i psi)|)")


def _named(mesh: SetMesh) -> Iterator[Notice]:
    """The notices of a pair, whose gears are called by their names."""
    names = {mesh.central_role.value: mesh.central.name, mesh.rim_role.value: mesh.rim.name}
    for notice in mesh.pair.notices:
        text = re.sub(r"\b(?:the )?(pinion|wheel)\b", lambda found: names[found[1]], notice.text)
        yield replace(notice, text=text).within(mesh.name)
