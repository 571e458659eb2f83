"""Shafts on their bearings: deflection, reactions, bearing life, and the gap that shafts leave over the face of a mesh."""

import sys

import lazy_loader

from gearcad.callable_room import CallableRoom

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
sys.modules[__name__].__class__ = CallableRoom
