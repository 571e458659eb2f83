"""Where the workbench finds gearcad and the packages that it needs.

They lie in the folder `packages` beside this file, or wherever FreeCAD's Python finds them. The folder comes last on the path,
so that nothing of FreeCAD's, such as its numpy, is replaced. FreeCAD has a module `lazy_loader` of its own, of the same name
as the package that gearcad needs. The functions of the package are added to the module; nothing in it is changed.
"""

import importlib.util
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent / "packages"
MISSING = f"gearcad cannot be loaded: {{}}. Install it and the packages of packages.txt into {FOLDER}; see docs/freecad.md"


def prepare(drawings=False):
    """Make `import gearcad` possible, and its `drawings`. Raises ImportError, one line, where a package is missing."""
    if str(FOLDER) not in sys.path:
        sys.path.append(str(FOLDER))
    _complete_lazy_loader()
    try:
        import tomlkit  # noqa: F401

        import gearcad.designs.reader  # noqa: F401

        if drawings:
            import ezdxf  # noqa: F401
            import fontTools.ttLib  # noqa: F401
    except ImportError as error:
        raise ImportError(MISSING.format(error)) from None


def _complete_lazy_loader():
    """Add the functions of the package lazy_loader to FreeCAD's module of the same name, if they are not there."""
    try:
        import lazy_loader
    except ImportError:
        return  # prepare() says that it is missing
    if hasattr(lazy_loader, "attach_stub"):
        return
    for folder in map(Path, sys.path):
        file = folder / "lazy_loader" / "__init__.py"
        if file.is_file() and "def attach_stub" in file.read_text(encoding="utf-8"):
            spec = importlib.util.spec_from_file_location("gearcad_lazy_loader", file)
            package = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(package)
            for name in ("attach", "attach_stub", "load"):
                setattr(lazy_loader, name, getattr(package, name))
            return
