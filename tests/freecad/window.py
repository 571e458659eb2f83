"""What FreeCAD runs in its window for test_freecad_window.py: features made, changed in their panels, kept and cancelled.

WORKBENCH_TEST is a folder for figures.json, documents and pictures of the screen.
"""

import json
import os
import traceback
from pathlib import Path

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

FOLDER = Path(os.environ["WORKBENCH_TEST"])
CHANGES = 20
PATIENCE = 120_000
"""Longest wait (ms) for what the window does by itself."""

CHANGED = {
    "Gear": ("Teeth", [20 + change for change in range(1, CHANGES + 1)]),
    "Ring": ("Teeth", [-60 + change for change in range(1, CHANGES + 1)]),
    "Pair": ("WheelTeeth", [41 + change for change in range(1, CHANGES + 1)]),
    "Rack": ("FaceWidth", [20.0 + change for change in range(1, CHANGES + 1)]),
    "Planetary": ("SunProfileShift", [f"{0.3 + 0.005 * change:.3f}" for change in range(1, CHANGES + 1)]),
    "Spline": ("Length", [25.0 + change for change in range(1, CHANGES + 1)]),
}
"""For each kind the field that is changed, and its values."""


def pause(milliseconds):
    """Let the window work for some time."""
    loop = QtCore.QEventLoop()
    QtCore.QTimer.singleShot(milliseconds, loop.quit)
    loop.exec_()


def wait_for(condition, what):
    """Let the window work until a condition holds. Raises TimeoutError."""
    clock = QtCore.QElapsedTimer()
    clock.start()
    while not condition():
        if clock.elapsed() > PATIENCE:
            raise TimeoutError(what)
        pause(20)


def field_of(name):
    """Return the field of a property in the open panel."""
    return FreeCADGui.getMainWindow().findChild(QtGui.QWidget, name)


def put(name, value):
    """Give a field a value, as a user does."""
    field = field_of(name)
    if isinstance(value, str):
        field.setText(value)
        field.textEdited.emit(value)
    else:
        field.setValue(value)


def press(words):
    """Press a button of the open panel, and wait until the panel is closed."""

    def buttons():
        boxes = FreeCADGui.getMainWindow().findChildren(QtGui.QDialogButtonBox)
        found = [each for box in boxes for each in box.buttons()]
        return [each for each in found if each.isVisible() and each.text().replace("&", "") == words]

    wait_for(buttons, f"button {words}")
    buttons()[0].click()
    wait_for(lambda: not FreeCADGui.Control.activeDialog(), f"{words} closes the panel")


def picture(name):
    """Save a picture of the whole screen, and return its number of colours."""
    pause(600)
    image = QtGui.QApplication.primaryScreen().grabWindow(0)
    image.save(str(FOLDER / f"{name}.png"))
    small = image.toImage().scaled(160, 120)
    return len({small.pixel(x, y) for x in range(small.width()) for y in range(small.height())})


def made(kind, document):
    """Return a feature of a kind, made by its command; its panel is open."""
    FreeCAD.setActiveDocument(document.Name)
    before = set(document.Objects)
    FreeCADGui.runCommand(f"gearcad_{kind.lower()}")
    (feature,) = set(document.Objects) - before
    wait_for(lambda: FreeCADGui.Control.activeDialog(), f"panel of {kind}")
    return feature


def changes_of(kind):
    """Make a feature, change it in its panel, keep it, save the document and open it again; return what was measured."""
    document = FreeCAD.newDocument(kind)
    feature = made(kind, document)
    name, values = CHANGED[kind]
    found = {"fields": [each for each in feature.PropertiesList if field_of(each) is not None], "volumes": []}
    for value in values:
        before = feature.Shape.Volume
        put(name, value)
        wait_for(lambda before=before: feature.Shape.Volume != before or not feature.isValid(), f"{kind}: {name} = {value}")
        found["volumes"].append([feature.isValid() and feature.Shape.isValid(), feature.Shape.Volume])
    FreeCADGui.SendMsgToActiveView("ViewFit")
    found["colours"] = picture(f"panel-{kind}")
    press("OK")
    file = str(FOLDER / f"{kind}.FCStd")
    document.saveAs(file)
    FreeCAD.closeDocument(document.Name)
    document = FreeCAD.openDocument(file)
    feature = document.Objects[0]
    document.recompute()
    value = getattr(feature, name)
    found["reopened"] = [feature.isValid(), feature.Shape.Volume, getattr(value, "Value", value)]
    feature.ViewObject.Proxy.doubleClicked(feature.ViewObject)
    wait_for(lambda: FreeCADGui.Control.activeDialog(), f"panel of {kind} by double click")
    found["icon"] = Path(feature.ViewObject.Proxy.getIcon()).name
    press("Cancel")
    FreeCAD.closeDocument(document.Name)
    return found


def ok_and_cancel():
    """Cancel a new feature, keep one, and cancel a change of it; return names and teeth after each step."""
    document = FreeCAD.newDocument("cancel")
    made("Gear", document)
    put("Teeth", 25)
    press("Cancel")
    found = {"new and cancelled": [each.Name for each in document.Objects]}
    gear = made("Gear", document)
    put("Teeth", 25)
    press("OK")  # before the pause is over
    found["kept"] = [gear.Teeth, gear.Shape.Volume]
    gear.ViewObject.Proxy.doubleClicked(gear.ViewObject)
    put("Teeth", 2)
    wait_for(lambda: not gear.isValid(), "2 teeth are not permitted")
    line = FreeCADGui.getMainWindow().findChild(QtGui.QLabel, "line")
    found["line"] = [line.isVisible(), line.text()]
    picture("not-permitted")
    put("Teeth", 31)
    wait_for(gear.isValid, "31 teeth are permitted")
    found["line after"] = line.isVisible()
    press("Cancel")
    found["cancelled"] = [gear.Teeth, gear.Shape.Volume, gear.isValid(), field_of("Teeth") is not None]
    document.undo()
    found["undone"] = [each.Name for each in document.Objects]
    FreeCAD.closeDocument(document.Name)
    return found


def documents():
    """Make the data sheet and the drawings of a pair by their commands, twice; return their objects and pictures."""
    document = FreeCAD.newDocument("documents")
    pair = made("Pair", document)
    press("OK")
    found = {}
    for times in ("once", "twice"):
        for command in ("data_sheet", "drawing"):
            FreeCADGui.Selection.clearSelection()
            FreeCADGui.Selection.addSelection(pair)
            FreeCADGui.runCommand(f"gearcad_{command}")
            pause(1500)
            found[f"{command} {times}"] = picture(f"{command}-{times}")
        found[times] = sorted([each.TypeId, each.Label] for each in document.Objects)
    FreeCAD.closeDocument(document.Name)
    return found


def main():
    """Write figures.json, and end FreeCAD."""
    try:
        FreeCADGui.getMainWindow().showMaximized()
        FreeCADGui.activateWorkbench("GearcadWorkbench")
        pause(500)
        answer = {"kinds": {kind: changes_of(kind) for kind in CHANGED}}
        answer |= {"ok and cancel": ok_and_cancel(), "documents": documents()}
    except Exception:
        answer = {"error": traceback.format_exc()}
    (FOLDER / "figures.json").write_text(json.dumps(answer), encoding="utf-8")
    os._exit(0)  # FreeCAD asks for documents that are not saved


QtCore.QTimer.singleShot(1500, main)
