"""The verbs of gearcad, in the order of use. A job is entered here, once by its name and once for type checkers.

Its module `gearcad/jobs/VERB.py` has the class and the function of its name: `Check` is what commands and tables do, `check` is
`gearcad.check`. A module `gearcad/cli/VERB.py` makes it a command, and a step of `gearcad batch --do`.

What begins without a design is no job, but a function in a module of its name.
"""

from __future__ import annotations

TYPE_CHECKING = False  # as in guard.py
if TYPE_CHECKING:
    from gearcad.jobs.build import build as build
    from gearcad.jobs.check import check as check
    from gearcad.jobs.data import data as data
    from gearcad.jobs.draw import draw as draw
    from gearcad.jobs.dynamics import dynamics as dynamics
    from gearcad.jobs.identify import identify as identify
    from gearcad.jobs.mesh import mesh as mesh
    from gearcad.jobs.modify import modify as modify
    from gearcad.jobs.picture import picture as picture
    from gearcad.jobs.planetary import planetary as planetary
    from gearcad.jobs.rate import rate as rate
    from gearcad.jobs.stiffness import stiffness as stiffness

VERBS = ("data", "build", "draw", "picture", "check", "mesh", "rate", "stiffness", "dynamics", "planetary", "modify")
WITHOUT_DESIGN = ("identify",)
