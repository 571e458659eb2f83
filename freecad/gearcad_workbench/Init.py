"""Registration of TOML specs among the files that FreeCAD opens and imports; FreeCAD runs this file at its start."""

import FreeCAD

FreeCAD.addImportType("gearcad spec (*.toml)", "gearcad_features")
