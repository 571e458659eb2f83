"""Gears as solid bodies, in contact along lines that run across their flanks."""
