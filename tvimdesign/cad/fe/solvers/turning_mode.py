"""The lowest mode of the frozen joint in which the core's top turns, with link and load on it, by inverse iteration.

The motion is the static shape w, turned by one radian, times an angle, and what bends besides, which leaves the core's
top where it is. w is orthogonal to that in stiffness, so that a step needs one solution with the core's top held. Link
and load are an inertia on the core's top; the springs hold it to the ground. The first quotient is Rayleigh's of the
static shape; iterations go on until it changes no more.
"""

from math import pi, sqrt
from typing import Any, Protocol

from ngsolve import BilinearForm, InnerProduct, dx

SETTLED = 1e-4
"""Share of the squared frequency below which a step's change ends the iteration."""
MOST = 12


class Solves(Protocol):
    """Displacement under a vector of forces with feet and core's top held."""

    def __call__(self, force: Any) -> Any:
        """Return solve; the force is changed."""


def frequency(mesh: Any, values: dict[str, float], solved: Solves, shape: Any, torque: float) -> float:
    """Return frequency [Hz] by the static shape and the torque [N*mm] of one radian.

    Raises ValueError where none is found.
    """
    u, v = shape.space.TnT()
    mass = BilinearForm(_density(mesh, values) * InnerProduct(u, v) * dx, symmetric=True, nonassemble=True)
    carried = (values["moving_inertia"] - values["rotor_inertia"]) * 1e6  # kg*mm^2
    stiffness = torque + values["spring_stiffness"] * 1e3  # N*mm
    pulled, moved = shape.vec.CreateVector(), shape.vec.CreateVector()
    moved[:] = 0.0
    angle, bent, before = 1.0, 0.0, 0.0
    for _ in range(MOST):
        # Momentum of the whole motion, over its angular speed.
        whole = shape.vec.CreateVector()
        whole.data = angle * shape.vec + moved
        pulled.data = mass.mat * whole
        swung = InnerProduct(whole, pulled) + carried * angle**2
        squared = 1e3 * (stiffness * angle**2 + bent) / swung  # N/mm and kg to 1/s^2
        if before and abs(squared / before - 1.0) < SETTLED:
            return sqrt(squared) / (2.0 * pi)
        before = squared
        angle = (InnerProduct(shape.vec, pulled) + carried * angle) / stiffness
        # What holds the core's top and the feet takes its part of the force.
        force = pulled.CreateVector()
        force.data = pulled
        moved.data = solved(force)
        bent = InnerProduct(moved, pulled)
        moved.data = 1.0 / angle * moved
        angle, bent = 1.0, bent / angle**2
    raise ValueError(f"the joint's lowest mode is not found in {MOST} steps")


def _density(mesh: Any, values: dict[str, float]) -> Any:
    """Return of every material [kg/mm^3]."""
    structure = values["structure_density"]
    kinds = {"rotor": structure, "housing": structure, "pcl": values["pcl_density"], "pad": values["peltier_density"]}
    kinds |= {name: values.get(f"{name}_density", 0.0) for name in ("spreader", "liner")}
    return mesh.MaterialCF({name: density * 1e-9 for name, density in kinds.items()})
