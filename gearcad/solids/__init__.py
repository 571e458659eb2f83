"""Solids and files: exact boundary representations, structured meshes, contours and points.

Everything starts from the ToothProfile; CadQuery and ezdxf are imported when a function needs them.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.solids.colours import PART_COLOURS
    from gearcad.solids.exact.assembly import pair_assembly
    from gearcad.solids.exact.rack_assembly import rack_assembly
    from gearcad.solids.exact.rack_solid import rack_solid
    from gearcad.solids.exact.solid import gear_solid
    from gearcad.solids.exact.train_assembly import train_assembly
    from gearcad.solids.facets.rack_facets import tessellate_rack
    from gearcad.solids.facets.tessellation import Facets, tessellate
    from gearcad.solids.files.dxf import write_dxf
    from gearcad.solids.files.formats import Format
    from gearcad.solids.files.glb import write_glb
    from gearcad.solids.files.options import FileOptions
    from gearcad.solids.files.part import Part
    from gearcad.solids.files.points import write_points
    from gearcad.solids.files.rack_dxf import write_rack_dxf
    from gearcad.solids.files.rack_points import write_rack_points
    from gearcad.solids.files.scene import write_scene
    from gearcad.solids.files.step import write_step
    from gearcad.solids.files.stl import write_stl
    from gearcad.solids.files.three_mf import write_3mf
else:
    from gearcad.lazy import lazily

__all__ = [
    "PART_COLOURS",
    "Facets",
    "FileOptions",
    "Format",
    "Part",
    "gear_solid",
    "pair_assembly",
    "rack_assembly",
    "rack_solid",
    "tessellate",
    "tessellate_rack",
    "train_assembly",
    "write_3mf",
    "write_dxf",
    "write_glb",
    "write_points",
    "write_rack_dxf",
    "write_rack_points",
    "write_scene",
    "write_step",
    "write_stl",
]

if not TYPE_CHECKING:
    _FILES = (
        "formats",
        "options",
        "part",
        "scene",
        "stl",
        "three_mf",
        "glb",
        "dxf",
        "points",
        "rack_dxf",
        "rack_points",
        "step",
    )
    __getattr__ = lazily(
        __name__,
        __all__,
        (
            "colours",
            *(f"files.{home}" for home in _FILES),
            "facets.tessellation",
            "facets.rack_facets",
            "exact.solid",
            "exact.rack_solid",
            "exact.assembly",
            "exact.rack_assembly",
            "exact.train_assembly",
        ),
    )
