"""Dynamics and statics of planetary trains: springs between their members, sharing, vibration. In SI units inside."""
