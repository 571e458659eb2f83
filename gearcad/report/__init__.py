"""HTML reports of a check, of a rating, of stiffness by several methods, of dynamics, and of a planetary train."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
