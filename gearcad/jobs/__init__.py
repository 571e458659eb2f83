"""The jobs that gearcad does with a design: a class and a function for each verb."""

from gearcad.jobs.verbs import VERBS, WITHOUT_DESIGN, job_of

__all__ = ["VERBS", "WITHOUT_DESIGN", "job_of"]
