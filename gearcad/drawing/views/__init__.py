"""Views of gears, rings, racks, teeth, pairs and planetary trains on a sheet."""
