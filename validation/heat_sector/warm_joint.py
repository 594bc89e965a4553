"""Stiffness of a joint by the temperatures of polymer and structure where each of them is.

The product's own stack has one column of polymer; here every column has its own temperatures, as a plane
finds them. What the polymer and the structure are at a temperature is the product's.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tvimdesign.device import Table
from tvimdesign.device.core.impedance.warm_structure import WAY_OUT, PartTemperatures, in_series
from tvimdesign.physics.layers import block
from tvimdesign.physics.polymers import polymer

Array = NDArray[np.float64]
_WANTED = ("pcl_rheology", "pcl_moment", "pcl_depth", "spring_stiffness", "soft_threshold", "structure_compliances",
           "structure_softening", "lossless_compliance", "pcl_melting")  # fmt: skip


class WarmJoint:
    """A module's joint, by the temperatures of its parts."""

    def __init__(self, table: Table, values: Mapping[str, Any]) -> None:
        """Take what the joint is beside its heat off the table; `values` are all inputs in SI."""
        self.values, self.sheared = values, "arc_span" in values
        self.quantity = table.evaluate(values, _WANTED if self.sheared else [*_WANTED, "shape_factor"])
        self.omega = 2.0 * np.pi * float(values["frequency@hot"])

    @property
    def soft(self) -> float:
        """Size of the dynamic stiffness below which the joint is soft [N*m/rad]."""
        return float(self.quantity["soft_threshold"])

    def molten(self, celsius: Array) -> Array:
        """Share of the polymer that is molten as it is heated, even between the ends of its melting range."""
        melting = self.quantity["pcl_melting"]
        share = (celsius + 273.15 - melting.start) / (melting.end - melting.start)
        return np.asarray(np.clip(share, 0.0, 1.0))

    def parts(self, core: float, edge: float, plate: Array, hot: float, cold: float) -> PartTemperatures:
        """Return temperatures of the structure's parts [K] by those of core, plate beside the polymer, what lies on the
        polymer in slices, and the pads' sides [degC]."""
        kelvin, beside = 273.15, core + WAY_OUT * (edge - core)
        walls = 0.5 * (hot + cold) + kelvin
        return PartTemperatures(core + kelvin, beside + kelvin, list(plate + kelvin), walls, cold + kelvin)

    def stiffness(self, celsius: Array, shares: Array, slices: Array, parts: PartTemperatures) -> float:
        """Size of the dynamic stiffness at the hot point's frequency [N*m/rad].

        `celsius` has the shape (columns, slices); `shares` are the columns' of the stiffness where all are alike,
        `slices` are of the depth; of a block they are alike, as a squeezed film's share of them is counted.
        """
        q = self.quantity
        if not self.sheared and np.ptp(slices) > 1e-9:
            raise ValueError("a block's slices are alike")
        storage, loss = polymer.moduli(celsius + 273.15, 1.0 - self.molten(celsius), self.omega, q["pcl_rheology"])
        moments = np.full(len(celsius), q["pcl_moment"])
        if not self.sheared:
            soft = np.array([block.soft_share(*pair) for pair in zip(storage, loss, strict=True)])
            shape = q["shape_factor"]
            moments = moments * (1.0 + 2.0 * (shape / soft) ** 2) / (1.0 + 2.0 * shape**2)
        layer = np.sum(shares * moments / ((1.0 / (storage + 1j * loss)) @ slices)) / q["pcl_depth"]
        law = (q["structure_softening"], self.values["clamped_loss_factor"], q["lossless_compliance"])
        support = complex(*in_series(q["structure_compliances"], parts, *law))
        return float(abs(q["spring_stiffness"] + 1.0 / (1.0 / layer + 1.0 / support)))
