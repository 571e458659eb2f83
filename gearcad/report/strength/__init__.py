"""The report of a rating."""
