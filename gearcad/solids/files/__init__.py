"""Files of solids, facets and outlines."""
