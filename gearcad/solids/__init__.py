"""Solids and files: exact boundary representations (CadQuery), structured meshes, contours and points.

Everything starts from the ToothProfile; CadQuery, trimesh and ezdxf are imported when a function needs them.
"""

from gearcad.solids.assembly import PART_COLOURS, pair_assembly
from gearcad.solids.contour import write_dxf
from gearcad.solids.gear_solid import gear_solid
from gearcad.solids.mesh_files import Part, write_scene, write_stl
from gearcad.solids.points import write_points
from gearcad.solids.step import write_step
from gearcad.solids.tessellation import Facets, tessellate

__all__ = [
    "PART_COLOURS",
    "Facets",
    "Part",
    "gear_solid",
    "pair_assembly",
    "tessellate",
    "write_dxf",
    "write_points",
    "write_scene",
    "write_step",
    "write_stl",
]
