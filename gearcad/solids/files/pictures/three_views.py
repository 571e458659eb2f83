"""PNG of `gearcad build`: a scene as it looks from the front, from the side and from above one corner."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from gearcad.solids.files.part import Part
from gearcad.solids.files.pictures.images import write_png
from gearcad.solids.files.pictures.studio import studio
from gearcad.solids.files.pictures.views import Direction, framed, points_of

__all__ = ["write_picture"]

_SIZE = 760
"""Pixels of the height and the width of each view."""

_FRONT = Direction((0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
_SIDE = Direction((0.0, -1.0, 0.0), (0.0, 0.0, 1.0))
_CORNER = Direction((0.55, -0.9, 0.8), (0.0, 0.0, 1.0))


def write_picture(parts: Sequence[Part], path: Path | str, apart: Sequence[Part] = ()) -> None:
    """Write PNG: views along the axis, from the side and from above one corner, beside each other; then `apart`, if given.

    Each view is as large as its parts allow. Raises OutputError on a machine without OpenGL.
    """
    views = [(parts, view) for view in (_FRONT, _SIDE, _CORNER)] + ([(apart, _CORNER)] if apart else [])
    columns = 2 if len(views) == 4 else len(views)
    with studio((_SIZE, _SIZE), finer=2) as room:
        taken = [room.photograph(shown, framed(points_of(shown), view, 1.0)) for shown, view in views]
    rows = [np.concatenate(taken[start : start + columns], axis=1) for start in range(0, len(taken), columns)]
    write_png(np.concatenate(rows), Path(path))
