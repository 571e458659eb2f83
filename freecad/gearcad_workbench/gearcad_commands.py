"""Commands of the workbench: a new feature of each kind, "open spec" and "save spec"."""

from pathlib import Path

import FreeCAD
import FreeCADGui
from gearcad_documents import add_data_sheet, add_drawing
from gearcad_features import SPECS, add_feature, open_spec, save_spec
from gearcad_panel import open_panel
from PySide import QtCore, QtGui

_FILTER = "gearcad spec (*.toml)"
_UNTIL_SHOWN = 500
"""Time (ms) until a page has its size in the window."""

_ICONS = Path(__file__).with_name("icons")


class _New:
    """The command that adds a feature of one kind."""

    def __init__(self, kind):
        self.kind = kind

    def GetResources(self):
        return {
            "MenuText": self.kind,
            "ToolTip": f"Add a feature: {self.kind.lower()}",
            "Pixmap": str(_ICONS / f"{self.kind.lower()}.svg"),
        }

    def IsActive(self):
        return True

    def Activated(self):
        document = FreeCAD.ActiveDocument or FreeCAD.newDocument()
        document.openTransaction(f"gearcad {self.kind}")
        feature = _reported(lambda: add_feature(self.kind, document))
        _show(document)
        if feature is None or not open_panel(feature):
            document.commitTransaction()


class _OpenSpec:
    """The command that makes a feature of a spec file."""

    def GetResources(self):
        return {"MenuText": "Open spec", "ToolTip": "Make a feature of a gearcad spec (TOML)", "Pixmap": "document-open"}

    def IsActive(self):
        return True

    def Activated(self):
        path, _ = QtGui.QFileDialog.getOpenFileName(FreeCADGui.getMainWindow(), "Open spec", "", _FILTER)
        if path:
            document = FreeCAD.ActiveDocument or FreeCAD.newDocument()
            _reported(lambda: open_spec(path, document))
            _show(document)


class _SaveSpec:
    """The command that writes the spec of the selected feature."""

    def GetResources(self):
        return {"MenuText": "Save spec", "ToolTip": "Write the selected feature as a gearcad spec", "Pixmap": "document-save"}

    def IsActive(self):
        return _selected() is not None

    def Activated(self):
        path, _ = QtGui.QFileDialog.getSaveFileName(FreeCADGui.getMainWindow(), "Save spec", "", _FILTER)
        if path:
            _reported(lambda: save_spec(_selected(), path if path.endswith(".toml") else f"{path}.toml"))


class _Describe:
    """A command that describes the selected feature: `describe(feature)` returns the objects to show."""

    def __init__(self, words, tip, icon, describe):
        self.resources = {"MenuText": words, "ToolTip": tip, "Pixmap": str(_ICONS / icon)}
        self.describe = describe

    def GetResources(self):
        return self.resources

    def IsActive(self):
        return _selected() is not None and not FreeCADGui.Control.activeDialog()

    def Activated(self):
        feature = _selected()
        feature.Document.openTransaction(f"gearcad {self.resources['MenuText']}")
        made = _reported(lambda: self.describe(feature))
        feature.Document.commitTransaction()
        feature.Document.recompute()
        QtCore.QTimer.singleShot(0, lambda: _show_documents(made or ()))


def _show_documents(made):
    """Show spreadsheets and pages, the last one in front."""
    for each in made:
        each.ViewObject.doubleClicked()
        if each.TypeId == "TechDraw::DrawPage":
            QtCore.QTimer.singleShot(_UNTIL_SHOWN, lambda: FreeCADGui.SendMsgToActiveView("ViewFit"))


def _selected():
    """Return the selected feature of gearcad; None unless exactly one object is selected and is one."""
    selection = FreeCADGui.Selection.getSelection()
    return selection[0] if len(selection) == 1 and hasattr(selection[0], "Spec") else None


def _reported(act):
    """Return what `act` returns; show an error as one line in the report view, and return None."""
    try:
        return act()
    except (ImportError, OSError, ValueError) as error:
        FreeCAD.Console.PrintError(f"gearcad: {error}\n")
        return None


def _show(document):
    document.recompute()
    if FreeCADGui.ActiveDocument is not None:
        FreeCADGui.SendMsgToActiveView("ViewFit")


def register():
    """Register all commands, and return their names."""
    commands = {f"gearcad_{kind.lower()}": _New(kind) for kind in SPECS}
    commands |= {"gearcad_open_spec": _OpenSpec(), "gearcad_save_spec": _SaveSpec()}
    sheet = "Make a spreadsheet of the selected feature's data sheet, or fill it again"
    pages = "Make pages of TechDraw with the drawings of the selected feature, or make them again"
    commands["gearcad_data_sheet"] = _Describe("Data sheet", sheet, "data_sheet.svg", lambda of: [add_data_sheet(of)])
    commands["gearcad_drawing"] = _Describe("Drawing", pages, "drawing.svg", add_drawing)
    for name, command in commands.items():
        FreeCADGui.addCommand(name, command)
    return list(commands)
