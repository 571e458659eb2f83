"""The report of dynamics."""
