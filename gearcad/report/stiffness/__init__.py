"""The report of a comparison of stiffness."""
