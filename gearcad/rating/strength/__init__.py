"""Full rating of a pair by ISO 6336 or DIN 3990: strength, safeties, life and permissible torque."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
