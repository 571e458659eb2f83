"""The steady vibration: harmonic balance, flanks that part, stability, charts over speed."""
