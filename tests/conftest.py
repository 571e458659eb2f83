"""Puts `tests/support` within reach of every test, as `support`, and makes random tests repeatable."""

from hypothesis import HealthCheck, settings

settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,  # examples differ in size, and the machine may be busy
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("repeatable")
