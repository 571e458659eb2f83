"""The check in the plane."""
