"""Spec files (TOML) and design tables (CSV, .xlsx): the same keys in, a Design out."""

from gearcad.designs.design import Design, DesignKind, as_design
from gearcad.designs.reader import design_from_tables, read_spec
from gearcad.designs.table import Row, Table, open_table

__all__ = ["Design", "DesignKind", "Row", "Table", "as_design", "design_from_tables", "open_table", "read_spec"]
