"""What a fitted spectrum is in a record: as many modes as its solid has, viscosity, plateau and activation energy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tvimdesign.simulation.measurement.fitting.fit import Fit
from tvimdesign.simulation.measurement.kinds.measurement import Measurement, RecordTableFound

_SPLIT = 0.02
"""A mode that stands for two in a record is split this share above and below its time: no test could tell."""


def spectrum_record(best: Fit, count: int, most: int, reference: float, notes: Sequence[str]) -> Measurement:
    """The measurement of a spectrum of `count` modes, in a record of `most`."""
    values = {name: best[name] for name in ("zero_shear_viscosity", "plateau_modulus")}
    if any(one.name == "flow_activation_energy" for one in best.parameters):
        values["flow_activation_energy"] = best["flow_activation_energy"]
    modes = sorted(((best.value(f"time_{i}"), best.value(f"modulus_{i}")) for i in range(1, count + 1)), reverse=True)
    table = RecordTableFound({"relaxation_time": "s", "modulus": "Pa"}, split_to(modes, most))
    return Measurement(
        best, tuple(notes), values, {"melt_spectrum": table}, {"melt_reference_temperature": (reference, "degC")}
    )


def split_to(modes: Sequence[tuple[float, float]], count: int) -> list[tuple[float, float]]:
    """The same spectrum in `count` rows: the strongest modes split in two of half the modulus, times falling."""
    rows = list(modes)
    while len(rows) < count:
        at = max(range(len(rows)), key=lambda i: rows[i][0] * rows[i][1])
        time, modulus = rows[at]
        near = min([abs(np.log(time / other)) for i, (other, _) in enumerate(rows) if i != at], default=1.0)
        step = 1.0 + min(_SPLIT, 0.3 * float(near))
        rows[at : at + 1] = [(time * step, 0.5 * modulus), (time / step, 0.5 * modulus)]
    return sorted(rows, reverse=True)
