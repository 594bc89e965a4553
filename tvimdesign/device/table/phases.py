"""The device's working cycle: soft by heating, stiff again by cooling."""

from __future__ import annotations

from tvimdesign.device.table.quantity import Stage

SOFTENING = Stage(
    name="softening", description="heating from ambient until the joint is soft",
    after=None, ends="response_time", drive="current", sign=1.0, history=False,
)  # fmt: skip
STIFFENING = Stage(
    name="stiffening", description="cooling from there until the joint is stiff again",
    after="softening", ends="return_time", drive="cooling_current", sign=-1.0, history=True,
)  # fmt: skip
EQUILIBRIUM_STIFFENING = Stage(
    name="equilibrium_stiffening", description="the same, as if the layer froze where it melts",
    after="softening", ends="equilibrium_stiffening_time", drive="cooling_current", sign=-1.0, like="stiffening",
    history=False,
)  # fmt: skip
STAGES = (SOFTENING, STIFFENING, EQUILIBRIUM_STIFFENING)
