"""The device's working cycle: soft by heating, stiff again by cooling."""

from __future__ import annotations

from tvimdesign.device.table.quantity import Phase

SOFTENING = Phase(
    name="softening", description="heating from ambient until the joint is soft",
    after=None, ends="response_time", current_input="current", sign=1.0, history=False,
)  # fmt: skip
STIFFENING = Phase(
    name="stiffening", description="cooling from there until the joint is stiff again",
    after="softening", ends="return_time", current_input="cooling_current", sign=-1.0, history=True,
)  # fmt: skip
EQUILIBRIUM_STIFFENING = Phase(
    name="equilibrium_stiffening",
    description="the same, as if the layer froze where it melts",
    after="softening",
    ends="equilibrium_stiffening_time",
    current_input="cooling_current",
    sign=-1.0,
    like="stiffening",
    history=False,
)
PHASES = (SOFTENING, STIFFENING, EQUILIBRIUM_STIFFENING)
