"""Dynamics of several designs that differ in a few values, over each other in one chart and one table."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

from gearcad.designs import PairDesign, TrainDesign
from gearcad.designs.variants import Variants
from gearcad.dynamics.options import DynamicsOptions, PairModel
from gearcad.dynamics.pair_result import PairStudy
from gearcad.dynamics.side_by_side import SideBySide
from gearcad.dynamics.train_result import TrainStudy
from gearcad.errors import ParameterError
from gearcad.jobs.dynamics import Dynamics, Study
from gearcad.progress import Progress

__all__ = ["DynamicsBeside"]


@dataclass(frozen=True, kw_only=True)
class DynamicsBeside(Dynamics):
    """The studies that [dynamics] of each of the `variants` asks for; the design that is run is the first of them."""

    variants: Variants

    def _run(self, design: PairDesign | TrainDesign, progress: Progress | None) -> Study:
        designs = [self._accepted(each) for each in self.variants.designs]
        for each in designs:
            _require_chart(each)
        count, studies = len(designs), []
        for number, (label, each) in enumerate(zip(self.variants.labels, designs, strict=True)):
            own = None if progress is None else partial(_told, progress, label, number, count)
            studies.append(_over_speed(super()._run(each, own)))
        of = self.variants
        return SideBySide(name=design.name, what=of.what, labels=of.labels, studies=tuple(studies), key=of.key)


def _told(progress: Progress, label: str, before: int, count: int, step: str, done: float, of: float) -> None:
    """Tell how far one of several studies is."""
    progress(f"{label}: {step}", before + done / of, count)


def _require_chart(design: PairDesign | TrainDesign) -> None:
    """Raise ParameterError for what has no chart of K_v, or several."""
    if isinstance(design, TrainDesign):
        if design.other_models:
            listed = ", ".join(each.value for each in design.models)
            permitted = "must be one word beside other values that vary: write one, or give several by --vary train.model=..."
            raise ParameterError("train.model", listed, permitted)
        if not design.train.meshes:
            raise ParameterError(
                "vary", None, "needs meshes: without teeth a train has no load over speed to be laid over another"
            )
    elif (design.dynamics or DynamicsOptions()).pair_model is PairModel.CONTACT:
        permitted = (
            'must be "mesh" to vary something: a contact model has a Campbell diagram, and no K_v over speed to be laid over '
            "another; give one value at a time by --vary, with a folder of its own for each (-o)"
        )
        raise ParameterError("dynamics.model", PairModel.CONTACT.value, permitted)


def _over_speed(study: Study) -> TrainStudy:
    """That of a train, or of a pair as one, with all there is to know of it."""
    if isinstance(study, PairStudy):
        return replace(study.study, found=tuple(dict.fromkeys((*study.study.found, *study.notices))))
    assert isinstance(study, TrainStudy)  # _require_chart has seen to it
    return study
