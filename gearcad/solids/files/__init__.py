"""Files of the exact solid, of facets and of the outline: a module a format, `formats.py` tells which there are."""
