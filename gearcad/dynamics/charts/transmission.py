"""The dynamic transmission error: how far the flanks of a mesh approach each other as they vibrate, order by order."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gearcad.arrays import Floats, Indices

__all__ = ["TransmissionErrors", "lines_that_matter", "transmission_errors"]


_MICRO = 1e-6

_FLOOR = 1e-3
"""Of the greatest line of a mesh: those that are below at all speeds are left away."""

_MOST = 128
"""Lines that are kept: with 1000 speeds a megabyte a mesh."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TransmissionErrors:
    """Amplitudes (s, q, m) of the approach of the flanks of each mesh, in µm, over the speeds (s,) of a chart.

    `orders` (q,) are multiples of the tooth frequency of the first mesh, whole ones unless teeth differ or meshes have other
    tooth frequencies; times the teeth of its pinion they are orders of the pinion's shaft.
    """

    orders: Floats
    amplitudes: Floats

    def of_meshes(self, columns: Indices) -> TransmissionErrors:
        """With other meshes, each of which does what one of these does."""
        return replace(self, amplitudes=self.amplitudes[:, :, columns])

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them."""
        return {"transmission_error_order": self.orders, "transmission_error": self.amplitudes}


def transmission_errors(orders: Floats, lines: Floats) -> TransmissionErrors:
    """Of lines (s, k, m) in m at orders (k,): those that are a thousandth of the greatest line of a mesh at some speed."""
    kept = lines_that_matter(np.nan_to_num(lines).max(axis=0, initial=0.0), _FLOOR, _MOST)
    return TransmissionErrors(orders=orders[kept], amplitudes=lines[:, kept] / _MICRO)


def lines_that_matter(sizes: Floats, floor: float, most: int) -> Indices:
    """Which of sizes (k, m) are above so much of the greatest of their mesh: so many at most, in rising order."""
    greatest = sizes.max(axis=0, initial=0.0)
    shares = np.divide(sizes, greatest, out=np.zeros_like(sizes), where=greatest > 0).max(axis=1)
    highest = np.argsort(-shares, kind="stable")[:most]
    return np.sort(highest[shares[highest] > floor])
