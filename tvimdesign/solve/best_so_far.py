"""Best design so far of an interrupted search: the study, started at that design."""

from __future__ import annotations

from collections.abc import Sequence

from tvimdesign.solve.discrete.relaxation import Relaxation, order
from tvimdesign.study import Study
from tvimdesign.study.written_studies import started_at


class SearchInterrupted(KeyboardInterrupt):
    """A search that was interrupted."""

    def __init__(self, best: Study | None = None) -> None:
        """`best` is the study started at the best design so far; None if there is none yet."""
        super().__init__()
        self.best = best


def best_so_far(study: Study, trees: Sequence[Relaxation]) -> Study | None:
    """Return the study started at the best design its problems have reached; None if there is none yet."""
    bests = [(order(tree.best), tree.place, tree) for tree in trees if tree.best is not None]
    if not bests:
        return None
    tree = min(bests)[-1]
    assert tree.best is not None
    values = dict(zip(tree.optimizer.model.names, tree.best.inputs.tolist(), strict=True))
    return started_at(study, values, tree.best.start.choices)
