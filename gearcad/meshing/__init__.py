"""Finite element meshes: of sections, tooth by tooth, of bodies with their named sides, and as files."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
