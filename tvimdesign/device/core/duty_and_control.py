"""Outputs of a design in repeated use and under its controller; a study may require them by `name@state`."""

from tvimdesign.device.table.quantity_group import QuantityGroup

DUTY, CONTROL = "duty", "control"
quantities = QuantityGroup("Switch")
quantities.simulated(
    "highest_switch_rate", "1/h", DUTY, "Most switches an hour, each to soft and back, that exceed no rating"
)
quantities.simulated(
    "overshoot", "K", CONTROL, "Hot face of the layer above its controller's highest set-point, in 95 % of modules"
)
quantities.simulated(
    "slowdown", "1", CONTROL, "Time until soft, controlled, over that by the switch's current, in 95 % of modules"
)
quantities.simulated(
    "controlled_share", "1", CONTROL, "Share of modules that overshoot by less than 3 K and are soft within 1.1 of "
    "their own time"
)  # fmt: skip
