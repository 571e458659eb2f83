"""Solids and files: exact boundary representations (CadQuery), structured meshes, contours and points.

Everything starts from the ToothProfile; CadQuery, trimesh and ezdxf are imported when a function needs them.
"""

from gearcad.solids.exact.assembly import PART_COLOURS, pair_assembly
from gearcad.solids.exact.gear_solid import gear_solid
from gearcad.solids.facets.tessellation import Facets, tessellate
from gearcad.solids.files.contour import write_dxf
from gearcad.solids.files.mesh_files import Part, write_scene, write_stl
from gearcad.solids.files.points import write_points
from gearcad.solids.files.step import write_step

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
