"""Common parts of contact in the plane and of solid bodies."""
