"""Solids and files: exact boundary representations (CadQuery), structured meshes, contours and points.

Everything starts from the ToothProfile; CadQuery, trimesh and ezdxf are imported when a function needs them.
"""

from gearcad.solids.assembly import pair_assembly
from gearcad.solids.gear_solid import gear_solid
from gearcad.solids.step import write_step

__all__ = ["gear_solid", "pair_assembly", "write_step"]
