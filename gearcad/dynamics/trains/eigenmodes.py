"""NaturalModes: the natural frequencies of a train, the shapes of its modes, and where their energy is."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from gearcad.arrays import Floats, freeze

__all__ = ["ComponentModes", "NaturalModes", "positive"]


def positive(shape: Floats) -> Floats:
    """Signs (n,) with which the first inertia that turns at least half as far as any, of modes (n, i), turns positively."""
    far = np.abs(shape) >= 0.5 * np.abs(shape).max(axis=1, keepdims=True)
    return np.where(shape[np.arange(len(shape)), far.argmax(axis=1)] < 0, -1.0, 1.0)


@dataclass(frozen=True, eq=False)
class ComponentModes:
    """n modes of lines of shafts, each by itself, without its meshes, that make up a train.

    `circular` (n,) in 1/s; `shape` (n, i) are turns of the inertias in rad and `middle` (n, s) those of the middles of shafts,
    of a modal mass of 1 kg·m², signs as of natural modes; 0 in other lines.
    """

    circular: Floats
    shape: Floats
    middle: Floats
    inertias: tuple[str, ...]
    shafts: tuple[str, ...]

    def __post_init__(self) -> None:
        freeze(self)

    def to_dict(self) -> dict[str, Any]:
        """Turns by the names of what turns."""
        return {
            "circular": self.circular.tolist(),
            "shape": dict(zip(self.inertias, self.shape.T.tolist(), strict=True)),
            "middle": dict(zip(self.shafts, self.middle.T.tolist(), strict=True)),
        }


@dataclass(frozen=True, eq=False)
class NaturalModes:
    """n natural modes of a train at the mean stiffness of its meshes, without damping, by rising frequency.

    `frequency` (n,) in Hz, `circular` in 1/s; `rpm` (n, m) is the speed of the train (of its first mesh's pinion) at which the
    tooth frequency of each mesh meets the mode. `shape` (n, i) are turns of the inertias in rad, scaled to a modal mass of
    1 kg·m²; the first inertia that turns at least half as far as any turns positively. `shaft_shape` (n, s, p) are turns at
    `places` (p,), 0 ... 1 from start to end of every shaft; `approach` (n, m) is that of the flanks in mm, positive as the mean
    torques press them. `kinetic_inertias` (n, i) and `kinetic_shafts` (n, s) are shares in the kinetic energy,
    `potential_shafts` (n, s) and `potential_meshes` (n, m) in the potential energy. Each pair sums up to 1, but the first
    `rigid` modes, at 0 Hz, have no potential energy. `missed` counts the natural frequencies below the highest of these that
    the train has besides, with the full mass of its shafts unless the model leaves it away. `component_modes` are those of
    the lines of which the model "modes" is made.
    """

    frequency: Floats
    circular: Floats
    rpm: Floats
    shape: Floats
    places: Floats
    shaft_shape: Floats
    approach: Floats
    kinetic_inertias: Floats
    kinetic_shafts: Floats
    potential_shafts: Floats
    potential_meshes: Floats
    inertias: tuple[str, ...]
    shafts: tuple[str, ...]
    meshes: tuple[str, ...]
    rigid: int
    missed: int
    component_modes: ComponentModes | None = None

    def __post_init__(self) -> None:
        freeze(self)

    def __len__(self) -> int:
        return len(self.frequency)

    @property
    def unit_shape(self) -> Floats:
        """(n, i): `shape` with the squares of the turns of all inertias summing up to 1."""
        length = np.linalg.norm(self.shape, axis=1, keepdims=True)
        result: Floats = np.divide(self.shape, length, out=np.zeros_like(self.shape), where=length > 0)
        return result

    @property
    def leading_parts(self) -> tuple[tuple[str, ...], ...]:
        """Of each elastic mode, in words, what moves most and what gives way most: one part where both are the same."""
        return tuple(() if mode < self.rigid else self._leading(mode) for mode in range(len(self)))

    @property
    def most_toothed(self) -> tuple[int, float] | None:
        """The mode (from 0) whose potential energy is most in the teeth, and their share; None without elastic ones."""
        shares = self.potential_meshes[self.rigid :]
        if not shares.size:
            return None
        mode = int(shares.sum(axis=1).argmax())
        return mode + self.rigid, float(shares[mode].sum())

    def to_dict(self) -> dict[str, Any]:
        """Plain lists, under the names of the fields, and the leading parts."""
        values = {each.name: getattr(self, each.name) for each in fields(self) if each.name != "component_modes"}
        plain = {
            name: value.tolist() if isinstance(value, np.ndarray) else list(value) if isinstance(value, tuple) else value
            for name, value in values.items()
        }
        components = None if self.component_modes is None else self.component_modes.to_dict()
        return {
            **plain,
            "unit_shape": self.unit_shape.tolist(),
            "leading_parts": [list(names) for names in self.leading_parts],
            "component_modes": components,
        }

    def _leading(self, mode: int) -> tuple[str, ...]:
        moving = _shared(self.inertias, self.kinetic_inertias[mode]) + _shared(self.shafts, self.kinetic_shafts[mode], "shaft ")
        bent = _shared(self.shafts, self.potential_shafts[mode], "shaft ")
        bent += _shared(self.meshes, self.potential_meshes[mode], "mesh ")
        return tuple(dict.fromkeys(max(each)[1] for each in (moving, bent)))


def _shared(names: tuple[str, ...], shares: Floats, kind: str = "") -> list[tuple[float, str]]:
    """Shares in an energy, with the names of what has them, of which the kind is a part."""
    return [
        (float(share), name if name.startswith(kind.strip()) else kind + name)
        for name, share in zip(names, shares, strict=True)
    ]
