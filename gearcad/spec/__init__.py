"""Spec files: TOML in, a Design out. Design tables will use the same keys."""

from gearcad.spec.design import Design, DesignKind
from gearcad.spec.reader import design_from_tables, read_spec

__all__ = ["Design", "DesignKind", "design_from_tables", "read_spec"]
