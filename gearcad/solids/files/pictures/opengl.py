"""A window in memory that VTK draws in: no display is needed, OpenGL is."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from gearcad.errors import OutputError

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

__all__ = ["require_opengl", "window_in_memory"]

_OSMESA = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")
"""What VTK draws with where neither an X server nor EGL is there."""


@contextmanager
def window_in_memory(size: tuple[int, int]) -> Iterator[vtkRenderWindow]:
    """A window of so many pixels, without what VTK says where there is no screen. Raises OutputError without OpenGL."""
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - registers the renderer
    from vtkmodules.vtkCommonCore import vtkLogger
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        window = vtkRenderWindow()
        require_opengl(window)
        try:
            window.SetOffScreenRendering(1)
            window.SetMultiSamples(0)
            window.SetAlphaBitPlanes(1)
            window.SetSize(*size)
            yield window
        finally:
            window.Finalize()
    finally:
        vtkLogger.SetStderrVerbosity(before)


def require_opengl(window: vtkRenderWindow) -> None:
    """Raise OutputError where VTK would draw with a library that is not there: it then ends the whole process."""
    if window.GetClassName() != "vtkOSOpenGLRenderWindow":
        return
    for name in _OSMESA:
        try:
            ctypes.CDLL(name)
        except OSError:
            continue
        return
    remedy = "install libegl1 (Debian, Ubuntu) or mesa-libEGL (Fedora)"
    raise OutputError("picture", "png", f"cannot be drawn, as there is no OpenGL here, neither EGL nor OSMesa: {remedy}")
