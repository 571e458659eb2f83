"""Errors of teeth, drawn many times: single pairs of teeth as springs that may meet too early; K_v as it lies over gears."""
