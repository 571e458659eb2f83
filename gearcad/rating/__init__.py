"""Analytic ratings of a gear pair: Hertz's line contact, and ISO 6336:2006 or DIN 3990:1987, Method B. Pure functions."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
