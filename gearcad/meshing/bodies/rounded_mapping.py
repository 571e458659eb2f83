"""The mapping of scikit-fem with a search for places that ends where rounding does."""

from __future__ import annotations

from typing import Any

from skfem.mapping import MappingIsoparametric

from gearcad.core.records import Floats

__all__ = ["RoundedMapping"]

_STEP = 1e-9
"""Newton's step, in shares of an element, after which a place is within rounding: the next one would be its square."""


class RoundedMapping(MappingIsoparametric):  # type: ignore[misc]
    """Mapping whose search ends at rounding.

    In short elements far from the origin, its parent's search asks for steps that are smaller than rounding.
    """

    def invF(self, x: Floats, tind: Any = None, newton_max_iters: int = 50, newton_tol: float = _STEP) -> Floats:
        """Places (dimension, elements, n) in elements of the points x of the same shape."""
        found: Floats = super().invF(x, tind, newton_max_iters, newton_tol)
        return found
