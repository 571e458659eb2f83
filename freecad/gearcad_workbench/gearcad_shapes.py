"""Shapes of FreeCAD from the STEP files of gearcad, with the faces in an order that keeps its numbers.

FreeCAD calls faces and edges by numbers. Those of a gear's body come first: walls of bore, keyway, hub and rim, then the end
faces, then the teeth. So Face1 ... n of the body, and the edges of its walls, have the same numbers for every number of teeth.
"""

import tempfile
from pathlib import Path

import Part
from FreeCAD import Placement, Rotation, Vector

WALL, END, TOOTH = 0, 1, 2
"""Places of the faces in the order."""

_NEAR = 1e-6
"""Distance (mm) within which a point is on the root circle, and a normal parallel to the axis."""


def shapes_of(design):
    """Return the shape of each part of a design by its name, or the shape "assembly" where its parts stand in several places.

    Parts are gears, racks, and pinion and wheel of a pair, each at z = 0 on its own axis.
    """
    from gearcad.designs.keys import DesignKind
    from gearcad.jobs.build import products_of
    from gearcad.solids.files.formats import Format
    from gearcad.solids.files.products import FileOptions

    step = Format.STEP.entry
    parts, assembly = products_of(design, FileOptions())
    if design.kind in (DesignKind.GEAR, DesignKind.RACK, DesignKind.PAIR) or assembly is None:
        return {name: ordered(_read(step.write, part), getattr(part, "gear", None)) for name, part in parts.items()}
    write = step.write_train if design.kind is DesignKind.PLANETARY else step.write_pair
    return {"assembly": _read(write, assembly)}


def posed(design, shapes, angle):
    """Return one shape of all parts, a pair in mesh with its pinion turned by `angle` (deg) about its own axis."""
    from gearcad.designs.keys import DesignKind

    if design.kind is not DesignKind.PAIR:
        found = list(shapes.values())
        return found[0] if len(found) == 1 else Part.makeCompound(found)
    pose, axis = design.pair.wheel_pose(angle), Vector(0, 0, 1)
    pinion, wheel = (shapes[name].copy() for name in ("pinion", "wheel"))
    pinion.Placement = Placement(Vector(0, 0, 0), Rotation(axis, angle))
    wheel.Placement = Placement(Vector(pose.x, 0, pose.z), Rotation(axis, pose.rotation))
    return Part.makeCompound([pinion, wheel])


def ordered(shape, gear):
    """Return the solid of a gear with its faces in the order wall, end, tooth; a solid of something else as it is."""
    if gear is None or shape.ShapeType != "Solid":
        return shape
    root = abs(float(gear.root_diameter)) / 2
    faces = sorted(shape.Faces, key=lambda face: _place(face, root, gear.teeth < 0))
    return Part.Solid(Part.Shell(faces))


def _place(face, root, internal):
    """Return the place of a face in the order; `root` is the radius (mm) of the root circle."""
    radii = [(vertex.X**2 + vertex.Y**2) ** 0.5 for vertex in face.Vertexes]
    if min(radii) > root + _NEAR if internal else max(radii) < root - _NEAR:
        return WALL
    level = isinstance(face.Surface, Part.Plane) and abs(abs(face.Surface.Axis.z) - 1) < _NEAR
    beyond = max(radii) > root + _NEAR if internal else min(radii) < root - _NEAR
    return END if level and (beyond or len(face.Edges) > 6) else TOOTH


def _read(write, product):
    """Return the shape in the STEP file that `write` makes of a product."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "part.step"
        write(product, file)
        shape = Part.read(str(file))
    return shape.Solids[0] if len(shape.Solids) == 1 else shape
