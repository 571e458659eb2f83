"""Features gear, pair, ring, rack, planetary set and spline of FreeCAD; specs read and written."""

import tomllib
from pathlib import Path

import FreeCAD
from gearcad_keys import SPECS, keys_of
from gearcad_packages import prepare


class GearcadFeature:
    """The behaviour of a feature: properties from the spec in its property Spec, and its shape from these.

    Spec stays as it was read, with its comments; properties that differ from it are what the user changed.
    """

    def __init__(self, feature, text):
        feature.addProperty("App::PropertyString", "Spec", "gearcad", "the spec from which this was made", 0, False, True)
        feature.Spec = text
        self._shapes = None
        add_properties(feature)
        feature.Proxy = self

    def execute(self, feature):
        """Make the shape anew; FreeCAD calls this when a property has changed. Raises ValueError, one line, for wrong input."""
        prepare()
        from gearcad_shapes import posed, shapes_of

        from gearcad.core.errors import GearcadError

        try:
            text = spec_text(feature)
            if self._shapes is None or self._shapes[0] != text:
                design = design_of(feature)
                self._shapes = text, design, shapes_of(design)
        except GearcadError as error:
            raise ValueError(str(error)) from None
        _, design, shapes = self._shapes
        feature.Shape = posed(design, shapes, feature.Angle.Value if hasattr(feature, "Angle") else 0.0)

    def onDocumentRestored(self, feature):
        """Forget shapes, and give the view its task panel; FreeCAD calls this when a document has been opened."""
        self._shapes = None
        _attach_view(feature)

    def __getstate__(self):
        return None

    def __setstate__(self, state):
        self._shapes = None

    dumps, loads = __getstate__, __setstate__


def add_properties(feature):
    """Give a feature the properties of all keys of its spec, with the values of that."""
    prepare()
    tables = tomllib.loads(feature.Spec)
    for key in keys_of(tables):
        if not hasattr(feature, key.name):
            feature.addProperty(key.type, key.name, key.group, key.tooltip)
            if key.type == "App::PropertyEnumeration":
                setattr(feature, key.name, [each.value for each in key.field.choices])
        setattr(feature, key.name, key.shown(tables))
    if "pair" in tables and "rack" not in tables and not hasattr(feature, "Angle"):
        said = "Turns the pinion by this angle, and the wheel with it"
        feature.addProperty("App::PropertyAngle", "Angle", "pose", said)


def spec_text(feature):
    """Return the spec of a feature: the one that was read, with the values of all properties that were changed."""
    prepare()
    from gearcad.designs.reader import edit_spec

    tables = tomllib.loads(feature.Spec)
    changed = {}
    for key in keys_of(tables):
        if not hasattr(feature, key.name):
            continue  # a document of an earlier version
        value = key.given(getattr(feature, key.name))
        if value != key.given(key.shown(tables)):
            changed[key.dotted] = value
    return edit_spec(feature.Spec, changed) if changed else feature.Spec


def design_of(feature):
    """Return the design of a feature, as gearcad reads it from its spec. Raises ValueError, one line, for wrong input."""
    prepare()
    from gearcad.core.errors import GearcadError
    from gearcad.designs.reader import design_from_tables

    label = feature.Label
    try:
        return design_from_tables(tomllib.loads(spec_text(feature)), where=lambda key: label, default_name=label)
    except GearcadError as error:
        raise ValueError(str(error)) from None


def add_feature(kind, document=None, text=None):
    """Return a new feature of a kind ("Gear", "Pair", "Ring", "Rack", "Planetary" or "Spline") in a document.

    `text` is its spec, else that of SPECS. The shape is there after `document.recompute()`.
    """
    prepare()
    if text is None:
        text = SPECS[kind]
        if "\n" not in text:
            from gearcad.designs.reader import starter_text

            text = starter_text(text)[1]
    document = document or FreeCAD.ActiveDocument or FreeCAD.newDocument()
    feature = document.addObject("Part::FeaturePython", kind)
    GearcadFeature(feature, text)
    _attach_view(feature)
    return feature


def _attach_view(feature):
    """Give a feature its icon and task panel, if there is a window and it has none."""
    if FreeCAD.GuiUp:
        from gearcad_panel import GearcadView

        if not isinstance(feature.ViewObject.Proxy, GearcadView):
            GearcadView(feature.ViewObject)


def open_spec(path, document=None):
    """Return a new feature of the design in a spec file. Raises ValueError, one line, for a wrong spec."""
    prepare()
    from gearcad.core.errors import GearcadError
    from gearcad.designs.reader import read_spec

    try:
        kind = read_spec(path).kind.value
    except GearcadError as error:
        raise ValueError(str(error)) from None
    if kind in ("train", "shaft"):
        raise ValueError(f"{path}: a {kind} is no feature of FreeCAD; open a gear, pair, rack, planetary set or spline")
    text = Path(path).read_text(encoding="utf-8")
    return add_feature("".join(map(str.capitalize, kind.split("_"))), document, text)


def save_spec(feature, path):
    """Write the spec of a feature to a file, with its changed properties and the comments of the spec that was read."""
    Path(path).write_text(spec_text(feature), encoding="utf-8")


def insert(path, name):
    """Add the design in a spec to the document called `name`, or to a new one; FreeCAD calls this for File > Import."""
    document = FreeCAD.getDocument(name) if name in FreeCAD.listDocuments() else FreeCAD.newDocument(Path(path).stem)
    open_spec(path, document)
    document.recompute()
    return document


def open(path):
    """Return a new document with the design in a spec; FreeCAD calls this for File > Open."""
    return insert(path, "")
