"""Tooth errors of many samples: single pairs of teeth as springs that may meet too early, and the distribution of K_v."""
