"""Commands of the workbench: a new feature of each kind, "open spec" and "save spec"."""

from pathlib import Path

import FreeCAD
import FreeCADGui
from gearcad_features import SPECS, add_feature, open_spec, save_spec

_FILTER = "gearcad spec (*.toml)"
_ICON = str(Path(__file__).with_name("gearcad.svg"))


class _New:
    """The command that adds a feature of one kind."""

    def __init__(self, kind):
        self.kind = kind

    def GetResources(self):
        return {"MenuText": self.kind, "ToolTip": f"Add a feature: {self.kind.lower()}", "Pixmap": _ICON}

    def IsActive(self):
        return True

    def Activated(self):
        document = FreeCAD.ActiveDocument or FreeCAD.newDocument()
        document.openTransaction(f"gearcad {self.kind}")
        _reported(lambda: add_feature(self.kind, document))
        document.commitTransaction()
        _show(document)


class _OpenSpec:
    """The command that makes a feature of a spec file."""

    def GetResources(self):
        return {"MenuText": "Open spec", "ToolTip": "Make a feature of a gearcad spec (TOML)", "Pixmap": "document-open"}

    def IsActive(self):
        return True

    def Activated(self):
        from PySide import QtGui

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
        return len(FreeCADGui.Selection.getSelection()) == 1 and hasattr(FreeCADGui.Selection.getSelection()[0], "Spec")

    def Activated(self):
        from PySide import QtGui

        path, _ = QtGui.QFileDialog.getSaveFileName(FreeCADGui.getMainWindow(), "Save spec", "", _FILTER)
        if path:
            feature = FreeCADGui.Selection.getSelection()[0]
            _reported(lambda: save_spec(feature, path if path.endswith(".toml") else f"{path}.toml"))


def _reported(act):
    """Call `act`; show an error as one line in the report view."""
    try:
        act()
    except (ImportError, OSError, ValueError) as error:
        FreeCAD.Console.PrintError(f"gearcad: {error}\n")


def _show(document):
    document.recompute()
    if FreeCADGui.ActiveDocument is not None:
        FreeCADGui.SendMsgToActiveView("ViewFit")


def register():
    """Register all commands, and return their names."""
    commands = {f"gearcad_{kind.lower()}": _New(kind) for kind in SPECS}
    commands |= {"gearcad_open_spec": _OpenSpec(), "gearcad_save_spec": _SaveSpec()}
    for name, command in commands.items():
        FreeCADGui.addCommand(name, command)
    return list(commands)
