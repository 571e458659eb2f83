"""The task panel of a feature: the properties that matter most, with a new shape after each change."""

import tomllib
from pathlib import Path

import FreeCADGui
from gearcad_keys import panel_keys, panel_kind
from gearcad_packages import prepare
from PySide import QtCore, QtGui

_ICONS = Path(__file__).with_name("icons")

_PAUSE = 300
"""Time (ms) without a further change after which the shape is made anew."""

_ANY = 1_000_000
"""Limit of the fields. The permitted ranges are those of the keys; the line below the fields tells what is not permitted."""

_DECIMALS = 4
_NARROWEST = 90
"""Least width (pixels) of a field; longer words then stand above it."""

_UNITS = {"App::PropertyDistance": " mm", "App::PropertyAngle": " °"}
_STEPS = {"App::PropertyDistance": 0.5, "App::PropertyAngle": 1.0}


class GearcadView:
    """The behaviour of a feature in the window: its icon, and its task panel, which a double click opens."""

    def __init__(self, view):
        view.Proxy = self

    def attach(self, view):
        """Keep the view; FreeCAD calls this when it has one."""
        self._view = view

    def getIcon(self):
        """Return the path of the icon in the tree."""
        return icon_of(getattr(self._view.Object, "Spec", ""))

    def doubleClicked(self, view):
        """Open the task panel; FreeCAD calls this for a double click in the tree."""
        return open_panel(view.Object)

    def setEdit(self, view, mode=0):
        """Show the task panel; FreeCAD calls this when the feature is edited. Moving it, a mode above 0, is FreeCAD's own."""
        if mode:
            return None
        FreeCADGui.Control.showDialog(GearcadPanel(view.Object))
        return True

    def unsetEdit(self, view, mode=0):
        """Close the task panel; FreeCAD calls this when editing ends."""
        if mode:
            return None
        FreeCADGui.Control.closeDialog()
        return True

    def __getstate__(self):
        return None

    def __setstate__(self, state):
        return None

    dumps, loads = __getstate__, __setstate__


def icon_of(spec):
    """Return the path of the icon for the kind of design in the text of a spec."""
    file = _ICONS / f"{panel_kind(tomllib.loads(spec))}.svg" if spec else _ICONS / "gear.svg"
    return str(file if file.is_file() else _ICONS / "gear.svg")


def panel_rows(feature):
    """Return the name of the property and the words of each row of the panel, the angle of a pair last."""
    prepare()
    rows = []
    for key in panel_keys(tomllib.loads(feature.Spec)):
        if hasattr(feature, key.name):  # a document of an earlier version may lack some
            table, symbol = key.dotted.partition(".")[0], key.field.symbol
            words = f"{table}: {symbol.words}" if key.own else symbol.words
            shown = symbol.unit if key.type not in _UNITS else ""  # the fields of the others show it
            rows.append((key.name, f"{words} ({shown})" if shown else words))
    return [*rows, ("Angle", "angle of the pinion")] if hasattr(feature, "Angle") else rows


def open_panel(feature):
    """Open the task panel of a feature. Return True; False if another panel is open."""
    if FreeCADGui.Control.activeDialog():
        return False
    return bool(FreeCADGui.getDocument(feature.Document.Name).setEdit(feature.Name, 0) or True)


class GearcadPanel:
    """The task panel. Each change is a change of the feature; Cancel undoes all of them, and a feature that is new."""

    def __init__(self, feature):
        self.feature = feature
        self.document = feature.Document
        if not self.document.HasPendingTransaction:
            self.document.openTransaction(f"Edit {feature.Label}")
        self.form = QtGui.QWidget()
        self.form.setWindowTitle(feature.Label)
        self.form.setWindowIcon(QtGui.QIcon(icon_of(feature.Spec)))
        self.fields = {}
        self._timer = QtCore.QTimer(self.form)
        self._timer.setSingleShot(True)
        self._timer.setInterval(_PAUSE)
        self._timer.timeout.connect(self.recompute)
        rows = QtGui.QFormLayout(self.form)
        rows.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        bound = {expression[0].lstrip(".") for expression in feature.ExpressionEngine}
        for name, words in panel_rows(feature):
            field = self.fields[name] = self._field(name)
            field.setObjectName(name)
            field.setToolTip(feature.getDocumentationOfProperty(name))
            field.setEnabled(name not in bound)
            field.setMinimumWidth(_NARROWEST)
            rows.addRow(words, field)
        self._line = QtGui.QLabel()
        self._line.setObjectName("line")
        self._line.setWordWrap(True)
        self._line.setStyleSheet("color: #c00000")
        rows.addRow(self._line)
        self._tell()

    def _field(self, name):
        """Return a field with the value of a property; a change of the field is one of the property."""
        kind, value = self.feature.getTypeIdOfProperty(name), getattr(self.feature, name)
        if kind == "App::PropertyInteger":
            field = QtGui.QSpinBox()
            field.setRange(-_ANY, _ANY)
            field.setValue(value)
            field.valueChanged.connect(lambda new: self.change(name, new))
        elif kind == "App::PropertyFloat" or kind in _UNITS:
            field = QtGui.QDoubleSpinBox()
            field.setRange(-_ANY, _ANY)
            field.setDecimals(_DECIMALS)
            field.setSingleStep(_STEPS.get(kind, 0.05))
            field.setSuffix(_UNITS.get(kind, ""))
            field.setValue(getattr(value, "Value", value))
            field.valueChanged.connect(lambda new: self.change(name, new))
        elif kind == "App::PropertyEnumeration":
            field = QtGui.QComboBox()
            field.addItems(self.feature.getEnumerationsOfProperty(name))
            field.setCurrentText(value)
            field.currentTextChanged.connect(lambda new: self.change(name, new))
        elif kind == "App::PropertyBool":
            field = QtGui.QCheckBox()
            field.setChecked(value)
            field.toggled.connect(lambda new: self.change(name, new))
        else:
            field = QtGui.QLineEdit(value)
            field.setPlaceholderText("not given")
            field.textEdited.connect(lambda new: self.change(name, new))
        return field

    def change(self, name, value):
        """Give a property a value; the shape follows after a pause."""
        setattr(self.feature, name, value)
        self._timer.start()

    def recompute(self):
        """Make the shape anew, and tell below the fields what is not permitted."""
        self._timer.stop()
        self.document.recompute()
        self._tell()

    def _tell(self):
        valid = self.feature.isValid()
        self._line.setText("" if valid else self.feature.getStatusString())
        self._line.setVisible(not valid)

    def accept(self):
        """Keep all changes; FreeCAD calls this for OK."""
        self.recompute()
        self.document.commitTransaction()
        self._close()
        return True

    def reject(self):
        """Undo all changes; FreeCAD calls this for Cancel."""
        self._timer.stop()
        self.document.abortTransaction()
        self._close()
        self.document.recompute()
        return True

    def _close(self):
        if FreeCADGui.activeDocument() is not None:
            FreeCADGui.getDocument(self.document.Name).resetEdit()
