"""Exact geometry of cylindrical gears: numpy, and scipy inside functions. Lengths in mm, angles in degrees."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
