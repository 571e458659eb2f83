"""The report of a planetary train."""
