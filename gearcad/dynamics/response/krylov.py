"""Many linear equations at once of which only products are known: GMRES, each with its own operator of the same size.

Y. Saad, M. H. Schultz, GMRES: a generalized minimal residual algorithm, SIAM J. Sci. Stat. Comput. 7 (1986). SciPy's solves
one equation at a time, which for the thousand small ones of a chart over speed takes ten times as long.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gearcad.arrays import Floats

__all__ = ["solve_all"]


_LOOK = 5
"""Steps after which the residual is looked at first; then after a quarter more."""


def solve_all(apply: Callable[[Floats], Floats], right: Floats, tolerance: float, most: int) -> tuple[Floats, Floats]:
    """x (s, d) with apply(x) = right (s, d), and the norms (s,) of what is left, below `tolerance` unless `most` steps end it.

    `apply` takes and gives (s, d), row by row a linear map of its own.
    """
    count, size = right.shape
    norms = np.linalg.norm(right, axis=1)
    if norms.max(initial=0.0) <= tolerance:
        return np.zeros_like(right), norms
    most = min(most, size)
    basis = np.empty((count, min(most, 4 * _LOOK) + 1, size))
    basis[:, 0] = _unit(right, norms)
    hessenberg = np.zeros((count, most + 1, most))
    look = _LOOK
    for step in range(most):
        if step + 1 == basis.shape[1]:
            basis = np.concatenate([basis, np.empty((count, min(step + 1, most - step), size))], axis=1)
        new = apply(basis[:, step])
        known = basis[:, : step + 1]
        # Twice: once leaves what rounding does to vectors that are nearly in the space already.
        for _ in range(2):
            parts = known @ new[:, :, None]
            new = new - (parts.transpose(0, 2, 1) @ known)[:, 0]
            hessenberg[:, : step + 1, step] += parts[:, :, 0]
        hessenberg[:, step + 1, step] = np.linalg.norm(new, axis=1)
        basis[:, step + 1] = _unit(new, hessenberg[:, step + 1, step])
        if step + 1 in (look, most):
            look += max(_LOOK, look // 4)
            weights, left = _least_squares(hessenberg[:, : step + 2, : step + 1], norms)
            if left.max() <= tolerance or step + 1 == most:
                return (weights[:, None] @ basis[:, : step + 1])[:, 0], left
    raise AssertionError("the last step returns")


def _unit(vectors: Floats, norms: Floats) -> Floats:
    return vectors / np.where(norms > 0, norms, 1.0)[:, None]


def _least_squares(hessenberg: Floats, norms: Floats) -> tuple[Floats, Floats]:
    """Weights (s, j) of the basis, and the norms (s,) of what they leave."""
    q, r = np.linalg.qr(hessenberg)
    right = q[:, 0] * norms[:, None]
    diagonal = np.diagonal(r, axis1=1, axis2=2)
    # Where an equation was solved before the others its further steps are zero, and weigh nothing.
    dead = np.abs(diagonal) <= 1e-14 * np.abs(diagonal).max(axis=1, keepdims=True)
    r = r + np.where(dead, 1.0 - diagonal, 0.0)[:, :, None] * np.eye(r.shape[1])
    weights = np.linalg.solve(r, np.where(dead, 0.0, right)[:, :, None])[:, :, 0]
    left = (hessenberg @ weights[:, :, None])[:, :, 0]
    left[:, 0] -= norms
    return weights, np.linalg.norm(left, axis=1)
