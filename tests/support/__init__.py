"""Helpers shared by the tests: reference data, independent measurements of gears, and random gears."""
