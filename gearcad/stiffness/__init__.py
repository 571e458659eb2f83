"""Mesh stiffness by every method, each in the form GearPair, Material, Load -> MeshCycle."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
