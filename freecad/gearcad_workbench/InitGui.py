"""Registration of the workbench; FreeCAD runs this file at the start of its window."""

import FreeCADGui


class GearcadWorkbench(FreeCADGui.Workbench):
    """The workbench gearcad: its commands in a menu and in a toolbar."""

    MenuText = "gearcad"
    ToolTip = "Cylindrical gears as parametric features"

    def __init__(self):
        from pathlib import Path

        import gearcad_commands

        self.__class__.Icon = str(Path(gearcad_commands.__file__).with_name("icons") / "gear.svg")

    def Initialize(self):
        """Register the commands; FreeCAD calls this before the workbench is shown for the first time."""
        import gearcad_commands

        names = gearcad_commands.register()
        self.appendToolbar("gearcad", names)
        self.appendMenu("gearcad", names)

    def GetClassName(self):
        """Return the class of FreeCAD that workbenches in Python have."""
        return "Gui::PythonWorkbench"


FreeCADGui.addWorkbench(GearcadWorkbench())
