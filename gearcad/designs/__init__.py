"""Spec files (TOML) and design tables (CSV, .xlsx): the same keys in, a Design out."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
