"""gmsh, loaded where something is meshed with it and nowhere else: what needs neither triangles nor tetrahedra runs without."""

from __future__ import annotations

from typing import Any

from gearcad.errors import SolverError

__all__ = ["load_gmsh"]

_INSTEAD = 'solid checks (model = "3d"), stiffness "potential-energy" and all that is not meshed do without'


def load_gmsh() -> Any:
    """The module. Raises SolverError where it is not installed, or lacks a library of the system."""
    try:
        import gmsh
    except (ImportError, OSError) as error:
        raise SolverError(f"gmsh cannot be loaded ({error}): pip install gmsh; {_INSTEAD}") from error
    return gmsh
