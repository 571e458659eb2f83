"""What FreeCAD runs for test_freecad_workbench.py: features made, changed, saved and opened again; the figures as JSON.

The arguments stand in the environment: WORKBENCH_TEST is a folder with files that `gearcad build` wrote, WORKBENCH_PARTS names
the functions that are called.
"""

import json
import os
import sys
import traceback
from pathlib import Path

import FreeCAD
import Part

FOLDER = Path(os.environ["WORKBENCH_TEST"])
FILLET_RADIUS = 0.5
POCKET_RADIUS, POCKET_DEPTH = 1.5, 4.0


def volume_in(name):
    """Return the volume of the solids in a STEP file, as FreeCAD reads it."""
    return Part.read(str(FOLDER / name)).Volume


def bore_edges(shape):
    """Return the numbers, from 1, of the edges on the bore of 12 mm at z = 0."""
    found = []
    for number, edge in enumerate(shape.Edges, 1):
        if isinstance(edge.Curve, Part.Circle) and abs(edge.Curve.Radius - 6) < 1e-9 and abs(edge.CenterOfMass.z) < 1e-9:
            found.append(number)
    return found


def end_faces(shape):
    """Return the numbers, from 1, of the level plane faces by their heights."""
    level = (face for face in shape.Faces if isinstance(face.Surface, Part.Plane) and abs(face.Surface.Axis.z) > 0.999)
    return {round(face.CenterOfMass.z, 9): shape_number(shape, face) for face in level}


def shape_number(shape, wanted):
    """Return the number, from 1, of a face in a shape."""
    return next(number for number, face in enumerate(shape.Faces, 1) if face.isSame(wanted))


def single_gear():
    """Change a gear that has a fillet and a sketch, save and open it; return what was measured at each step."""
    from gearcad_features import add_feature, open_spec, save_spec

    document = FreeCAD.newDocument("gear")
    gear = add_feature("Gear", document)
    document.recompute()
    top = end_faces(gear.Shape)[20.0]
    fillet = document.addObject("Part::Fillet", "Fillet")
    fillet.Base = gear
    fillet.Edges = [(number, FILLET_RADIUS, FILLET_RADIUS) for number in bore_edges(gear.Shape)]
    sketch = document.addObject("Sketcher::SketchObject", "Sketch")
    sketch.Support = [(gear, f"Face{top}")]
    sketch.MapMode = "FlatFace"
    document.recompute()

    def measured():
        return {
            "volume": gear.Shape.Volume,
            "valid": [each.isValid() and each.Shape.isValid() for each in (gear, fillet)] + [sketch.isValid()],
            "removed": gear.Shape.Volume - fillet.Shape.Volume,
            "edges": bore_edges(gear.Shape),
            "ends": sorted(end_faces(gear.Shape).items()),
            "sketch": [*sketch.Placement.Base, sketch.Placement.Rotation.multVec(FreeCAD.Vector(0, 0, 1)).z],
            "faces": len(gear.Shape.Faces),
        }

    found = {"20": measured()}
    gear.Teeth = 31
    document.recompute()
    found["31"] = measured()
    gear.Teeth = 2
    document.recompute()
    found["wrong input is invalid"] = not gear.isValid()
    gear.Teeth = 31
    document.recompute()
    found["tooltips"] = {name: gear.getDocumentationOfProperty(name) for name in ("Teeth", "FaceWidth", "HelixAngle")}
    save_spec(gear, FOLDER / "saved.toml")
    file = str(FOLDER / "gear.FCStd")
    document.saveAs(file)
    FreeCAD.closeDocument(document.Name)

    document = FreeCAD.openDocument(file)
    gear, fillet, sketch = document.Gear, document.Fillet, document.Sketch
    found["reopened"] = measured() | {"teeth": gear.Teeth}
    gear.removeProperty("ToothThinning")  # as in a document of another version
    gear.removeProperty("BodyRimDiameter")
    gear.addProperty("App::PropertyString", "BodyRimDiameter")
    gear.Teeth, gear.HelixAngle, gear.ProfileShift = 25, 15, 0.25
    document.recompute()
    placed = gear.Placement
    gear.Placement = FreeCAD.Placement(FreeCAD.Vector(60, -7, 0), FreeCAD.Rotation())
    gear.Teeth = 26
    document.recompute()
    found["placed"] = [gear.Shape.CenterOfMass.x, gear.Shape.CenterOfMass.y]
    gear.Teeth, gear.Placement = 25, placed
    document.recompute()
    found["helical"] = measured()
    found["spec"] = open_spec(FOLDER / "commented.toml", document).Spec
    before = set(FreeCAD.listDocuments())
    FreeCAD.loadFile(str(FOLDER / "commented.toml"))  # as File > Open does, by the import type that Init.py registers
    (opened,) = set(FreeCAD.listDocuments()) - before
    found["opened"] = [(each.Name, each.Teeth, each.isValid()) for each in FreeCAD.getDocument(opened).Objects]
    return found | {"built": {name: volume_in(f"{name}.step") for name in ("20", "31", "helical")}}


def part_design_body():
    """Return volumes and places of a gear in a body of PartDesign, with a fillet and a pocket, at 20 and at 31 teeth."""
    from gearcad_features import add_feature

    document = FreeCAD.newDocument("body")
    gear = add_feature("Gear", document)
    document.recompute()
    body = document.addObject("PartDesign::Body", "Body")
    body.BaseFeature = gear
    document.recompute()
    (base,) = body.Group
    top = end_faces(base.Shape)[20.0]
    sketch = body.newObject("Sketcher::SketchObject", "Sketch")
    sketch.Support = [(base, f"Face{top}")]
    sketch.MapMode = "FlatFace"
    sketch.addGeometry(Part.Circle(FreeCAD.Vector(0, 11, 0), FreeCAD.Vector(0, 0, 1), POCKET_RADIUS), False)
    pocket = body.newObject("PartDesign::Pocket", "Pocket")
    pocket.Profile = sketch
    pocket.Length = POCKET_DEPTH
    document.recompute()
    fillet = body.newObject("PartDesign::Fillet", "Fillet")
    fillet.Base = (pocket, [f"Edge{number}" for number in bore_edges(pocket.Shape)])
    fillet.Radius = FILLET_RADIUS
    found = {}
    for teeth in (20, 31):
        gear.Teeth = teeth
        document.recompute()
        found[teeth] = {
            "valid": [each.isValid() for each in (gear, base, sketch, pocket, fillet)] + [body.Shape.isValid()],
            "gear": gear.Shape.Volume,
            "pocket": gear.Shape.Volume - pocket.Shape.Volume,
            "fillet": pocket.Shape.Volume - fillet.Shape.Volume,
            "sketch": sketch.Placement.Base.z,
            "edges": [fillet.Base[1], bore_edges(pocket.Shape)],
        }
    return found


def documents():
    """Return the numbers in the data sheet of a pair and of a gear, and what is on the pages with their drawings."""
    from gearcad_documents import add_data_sheet, add_drawing
    from gearcad_features import add_feature

    document = FreeCAD.newDocument("documents")
    found = {}
    for kind, names in (
        ("Pair", ("pinion_tip_diameter", "wheel_tip_diameter", "pair_centre_distance", "pair_transverse_contact_ratio")),
        ("Gear", ("gear_tip_diameter", "gear_base_diameter", "gear_span_teeth", "gear_transverse_pressure_angle")),
    ):
        feature = add_feature(kind, document)
        document.recompute()
        add_data_sheet(feature)
        sheet = add_data_sheet(feature)
        values = [sheet.get(name) for name in names]
        pages = add_drawing(feature)
        document.recompute()
        found[kind] = {
            "numbers": {name: getattr(value, "Value", value) for name, value in zip(names, values, strict=True)},
            "texts": [sheet.get(cell) for cell in ("A1", "A5", "B5", "D5")],
            "pages": [[page.Label, page.Template.Width.Value, page.Template.Height.Value] for page in pages],
            "symbols": [page.Views[0].Symbol for page in pages],
        }
        if kind == "Gear":  # the numbers are there for expressions
            box = document.addObject("Part::Box", "Box")
            box.setExpression("Length", f"{sheet.Name}.gear_tip_diameter")
            feature.Teeth = 31
            add_data_sheet(feature)
            add_drawing(feature)
            document.recompute()
            found["box"] = box.Length.Value
    found["count"] = {kind: len(document.findObjects(kind)) for kind in ("Spreadsheet::Sheet", "TechDraw::DrawPage")}
    return found


def mesh_of_pair():
    """Turn a pair; return volumes and the directions of the same tooth face of each gear before and after."""
    from gearcad_features import add_feature

    document = FreeCAD.newDocument("pair")
    pair = add_feature("Pair", document)
    document.recompute()

    def directions():
        pinion, wheel = pair.Shape.Solids
        distance = wheel.CenterOfMass.x
        return [
            (pinion.Faces[-1].CenterOfMass.x, pinion.Faces[-1].CenterOfMass.y),
            (wheel.Faces[-1].CenterOfMass.x - distance, wheel.Faces[-1].CenterOfMass.y),
        ]

    found = {"volume": pair.Shape.Volume, "built": volume_in("pair.step"), "before": directions()}
    found["distance"] = pair.Shape.Solids[1].CenterOfMass.x
    pair.Angle = 10
    document.recompute()
    return found | {"after": directions(), "overlap": pair.Shape.Solids[0].common(pair.Shape.Solids[1]).Volume}


def other_kinds():
    """Return, for the feature of each other kind, whether it is valid, its solids, its volume and that of `gearcad build`."""
    from gearcad_features import add_feature

    document = FreeCAD.newDocument("kinds")
    found = {}
    for kind in ("Ring", "Rack", "Planetary", "Spline"):
        feature = add_feature(kind, document)
        document.recompute()
        shape = feature.Shape
        found[kind] = [feature.isValid() and shape.isValid(), len(shape.Solids), shape.Volume, volume_in(f"{kind}.step")]
    return found


def twenty_changes():
    """Change the teeth of a gear, a ring and a pair twenty times; return validity, volume and faces of each change."""
    from gearcad_features import add_feature

    document = FreeCAD.newDocument("changes")
    found = {}
    for kind, name, start in (("Gear", "Teeth", 20), ("Ring", "Teeth", -60), ("Pair", "WheelTeeth", 41)):
        feature = add_feature(kind, document)
        if kind == "Ring":
            feature.BodyRimDiameter = 200  # room for 80 teeth
        found[kind] = []
        for change in range(1, 21):
            setattr(feature, name, start + change if start > 0 else start - change)
            document.recompute()
            valid = feature.isValid() and feature.Shape.isValid()
            found[kind].append([valid, feature.Shape.Volume, len(feature.Shape.Faces)])
        document.removeObject(feature.Name)
    return found


def random_designs():
    """Return the label, validity and volume of a feature of every spec random-*.toml, and the volume of `gearcad build`."""
    from gearcad_features import open_spec

    document = FreeCAD.newDocument("random")
    found = []
    for spec in sorted(FOLDER.glob("random-*.toml")):
        feature = open_spec(spec, document)
        document.recompute()
        valid = feature.isValid() and feature.Shape.isValid()
        found.append([spec.stem, valid, feature.Shape.Volume if valid else None, volume_in(f"{spec.stem}.step")])
        document.removeObject(feature.Name)
    return found


def bodies():
    """Return, for every spec body-*.toml, the walls and their edges by number before and after a change of teeth.

    A face is told by its surface and its centre, an edge by its length and its centre: none of them knows of teeth.
    """
    from gearcad_features import open_spec

    def told(part, size):
        return [round(value, 6) for value in (size, *part.CenterOfMass)]

    document = FreeCAD.newDocument("bodies")
    found = {}
    for spec in sorted(FOLDER.glob("body-*.toml")):
        feature = open_spec(spec, document)
        states = []
        for more in (0, 11):
            feature.Teeth += more if feature.Teeth > 0 else -more
            document.recompute()
            shape = feature.Shape
            ends = [number for number, face in enumerate(shape.Faces, 1) if len(face.Edges) > 60]
            walls = shape.Faces[: ends[0] - 1]
            edges = shape.Edges[: len(Part.Compound(walls).Edges)]
            heights = [round(shape.Faces[number - 1].CenterOfMass.z, 6) for number in ends]
            states.append(
                [ends, heights, [told(face, face.Area) for face in walls], [told(edge, edge.Length) for edge in edges]]
            )
        found[spec.stem] = states
    return found


try:
    answer = {name: globals()[name]() for name in os.environ["WORKBENCH_PARTS"].split()}
except Exception:
    answer = {"error": traceback.format_exc()}
(FOLDER / "figures.json").write_text(json.dumps(answer), encoding="utf-8")
sys.exit(0)
