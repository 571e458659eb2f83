"""What the screen shows of a train's strength: the least safeties of every gear, and the verdict."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.strength import TrainStrength

__all__ = ["train_strength_lines"]

_LONGEST_LIFE = 1e6
"""Hours above which a life is told as more than that."""


def train_strength_lines(strength: TrainStrength, *, verdict: bool = True) -> Iterator[str]:
    """A line for each gear that was judged, scuffing of each mesh, the life, and the verdict unless it stands elsewhere."""
    from gearcad.rating.strength import Part

    for name, gear in strength.members.items():
        found = ((part, gear.least(part)) for part in Part)
        texts = [f"S_{part.index} {least.safety:.4g} in {least.mesh}" for part, least in found if least is not None]
        if texts:
            yield f"{f'safety of {name}':<22}{', '.join(texts)}"
    for mesh, rating in strength.meshes.items():
        if (scuffing := rating.scuffing) is not None and scuffing.risk is not None:
            safeties = {"S_int": scuffing.integral_safety, "S_B": scuffing.flash_safety}
            told = ", ".join(f"{symbol} {value:.4g}" for symbol, value in safeties.items() if value is not None)
            yield f"{f'scuffing {mesh}':<22}risk {scuffing.risk.value}: {told}"
    if strength.life is not None:
        life = strength.life
        text = "infinite" if math.isinf(life) else f"> {_LONGEST_LIFE:g} h" if life > _LONGEST_LIFE else f"{life:.4g} h"
        yield f"{'life':<22}{text}, with the required safeties"
    if verdict:
        yield f"{'strength':<22}{strength.verdict.removeprefix('strength ')}"
