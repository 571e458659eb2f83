"""The modes of the lines of which the model "modes" is made: what each line of shafts does by itself, the meshes taken away."""

from __future__ import annotations

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.trains.eigenmodes import ComponentModes, positive
from gearcad.dynamics.trains.lines import Lines
from gearcad.dynamics.trains.shafts import twist_shapes

__all__ = ["component_modes"]


def component_modes(lines: Lines) -> ComponentModes:
    """Those that the System of the lines keeps, each of mass 1, line by line; Osinski's (2.7) holds such a matrix."""
    modes = len(lines.system.squares)
    middle = [local.T @ twist_shapes(len(local) - 1, 0.5) for local in lines.shafts]
    shape: Floats = lines.system.inertias
    sign = positive(shape)[:, None]
    return ComponentModes(
        circular=np.sqrt(lines.system.squares),
        shape=sign * shape + 0.0,  # no -0
        middle=sign * (np.stack(middle, axis=1) if middle else np.zeros((modes, 0))) + 0.0,
        inertias=tuple(inertia.name for inertia in lines.parts.inertias),
        shafts=tuple(shaft.name for shaft in lines.parts.shafts),
    )
