"""Planetary trains: sets of planets of any type, their speeds, torques, assembly, phases and poses. Numpy only."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
