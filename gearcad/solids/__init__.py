"""Solids and files: exact boundary representations, structured meshes, contours and points.

Everything starts from the ToothProfile; CadQuery and ezdxf are imported when a function needs them.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
