"""FE of the frozen joint as drawn: housing on its feet, pads, PCL, rotor, all tied; the core's top turns as one.

Finds the joint's stiffness and each part's share of the compliance as 1/C_i with C_i = 2 U_i/T^2 [N*m/rad], U_i its
strain energy: the C_i add up to the whole. Stresses [MPa] are at one newton metre. `frequency` [Hz] is that of the
lowest mode in which the core's top turns, with link and load on it.
"""

import json
from collections.abc import Callable
from math import pi
from pathlib import Path
from typing import Any

import elastic
import joint_samples
import joint_solids
import ngsolve as ngs
import numpy as np
from netgen.occ import Glue, OCCGeometry
from ngsolve import CF, H1, L2, TET, VOL, BilinearForm, IfPos, InnerProduct, Integrate, Trace, dx, sqrt, x, y, z

BETWEEN_PLATES = 0.25
"""Poisson's ratio of rigid modules: pressed between stiff plates they are as stiff as three times the shear modulus."""
RUBBER = 100.0  # Bulk over shear modulus from which a pad hardly changes its volume
LOWER, HIGHER = 2, 3  # Order of displacements, and in pads of rubber that are pressed
GRADING, GRADING_AT_SEATS = 0.6, 0.4
"""Growth of elements from one to the next; at the larger one lips beside a thin seat of adhesive get no mesh."""
TURN = (-y, x, 0)  # Motion of the core's top about the axis
METAL = 0.33  # Poisson's ratio of a spreader where its shear modulus is not given


def solve(folder: Path, coarser: float = 1.0, field: Path | None = None) -> elastic.Results:
    """Return the stiffness of the joint at the core's top and of each part [N*m/rad]; stresses at 1 N*m [MPa]."""
    inputs = json.loads((folder / "inputs.json").read_text())
    mm, values = inputs["mm"], inputs["values"]
    keeps_volume = values.get("heater_bulk_modulus", 0.0) > RUBBER * values["heater_shear_modulus"]
    is_rubber = keeps_volume and mm.get("vane_count", 0.0) > 0.0
    pressed = joint_solids.RUBBER if is_rubber else joint_solids.PRESSED
    whole = Glue(joint_solids.parts(folder, mm, coarser, pressed))
    joint_solids.refine(whole, mm, coarser)
    joint_solids.name_faces(whole, mm)
    grading = GRADING_AT_SEATS if "spreader_gap" in mm and mm["spreader_depth"] and not is_rubber else GRADING
    sizes = {"maxh": 12.0 * coarser, "grading": grading, "curvaturesafety": 1.0, "segmentsperedge": 0.5}
    mesh = elastic.meshed(OCCGeometry(whole), 2, **sizes)
    shear, lame = _moduli(mesh, values)
    with ngs.TaskManager():
        held = Held(mesh, shear, lame, HIGHER if is_rubber else LOWER)
        displacement = held.turned()
        strain = elastic.strain_of(displacement)
        even = ngs.GridFunction(L2(mesh, order=held.order - LOWER))
        even.Set(Trace(strain))
        dilation = mesh.MaterialCF({"pad": even}, default=Trace(strain))
        tensor = elastic.stress(strain, shear, lame, dilation)
        torque = held.work(displacement)
        shares = _energies(mesh, InnerProduct(tensor, strain), mm, torque)
        frequency = turning_frequency(mesh, values, held.solved, displacement, torque)
        feet = joint_samples.at_feet(held.space, tensor, torque, round(mm["spring_count"]))
        tilt = held.tilt(mm)
    result = {"elements": mesh.ne, "unknowns": held.space.ndof, "hub": torque * 1e-3, "frequency": frequency, **feet}
    result["tilt"] = tilt * 1e3
    result |= {name: torque**2 / share * 1e-3 for name, share in shares.items()}
    result |= joint_samples.in_bodies(mesh, tensor, mm, torque) | joint_samples.at_foot(mesh, tensor, mm, torque)
    result |= joint_samples.at_plate(mesh, tensor, mm, torque)
    if not mm.get("vane_count"):
        result |= joint_samples.at_edges(mesh, tensor, mm, torque)
    if "seat" in mesh.GetMaterials():
        result |= joint_samples.at_seats(mesh, tensor, mm, torque)
    if field:
        elastic.write_field(field, mesh, elastic.mises(tensor) * 1e3 / torque, displacement)
    return result


def _moduli(mesh: Any, values: dict[str, float]) -> tuple[Any, Any]:
    """Return shear modulus and Lame's first constant of each material [N/mm^2]."""
    own = values["structure_poissons_ratio"]
    structure = values["structure_youngs_modulus"] * 1e-6 / 2 / (1 + own)
    shear = {"pcl": values["storage_modulus@cold"] * 1e-6, "pad": values["heater_shear_modulus"] * 1e-6}
    poisson = {"pcl": values["pcl_poissons_ratio"], "pad": BETWEEN_PLATES, "rotor": own, "housing": own}
    bulk = values.get("heater_bulk_modulus", 0.0) * 1e-6
    if bulk:
        poisson["pad"] = (3 * bulk - 2 * shear["pad"]) / (6 * bulk + 2 * shear["pad"])
    if "spreader_youngs_modulus" in values:
        youngs = values["spreader_youngs_modulus"] * 1e-6
        shear["spreader"] = values.get("spreader_shear_modulus", youngs / 2e-6 / (1 + METAL)) * 1e-6
        poisson["spreader"] = youngs / 2 / shear["spreader"] - 1
    if "seat" in mesh.GetMaterials():
        poisson["seat"] = values["heater_adhesive_poissons_ratio"]
        shear["seat"] = values["heater_adhesive_youngs_modulus"] * 1e-6 / 2 / (1 + poisson["seat"])
    if "liner" in mesh.GetMaterials():
        poisson["liner"] = values["liner_poissons_ratio"]
        shear["liner"] = values["liner_youngs_modulus"] * 1e-6 / 2 / (1 + poisson["liner"])
    mu = mesh.MaterialCF({**shear, "rotor": structure, "housing": structure})
    return mu, elastic.lame_of(mu, mesh.MaterialCF(poisson))


def _displacements(mesh: Any, order: int) -> Any:
    """Return quadratic displacements, of another order in the pads and on their faces."""
    component = H1(mesh, order=LOWER, dirichlet="turned|fixed")
    if order != LOWER:
        for element in mesh.Elements(VOL):
            for node in (*element.edges, *element.faces) if element.mat == "pad" else ():
                component.SetOrder(node, order)
        component.UpdateDofTables()
    return component**3


class Held:
    """The joint with its feet and the core's top held, and what bends it."""

    def __init__(self, mesh: Any, shear: Any, lame: Any, order: int = LOWER) -> None:
        """Assemble the stiffness and factor it; `order` is that of displacements in pads."""
        self.order, self.space = order, _displacements(mesh, order)
        u, v = self.space.TnT()
        sheared = InnerProduct(2 * shear * elastic.strain_of(u), elastic.strain_of(v))
        dilated = lame * Trace(elastic.strain_of(u)) * Trace(elastic.strain_of(v))
        # Pads hardly change their volume, and whole tetrahedra of theirs would lock: one point of each is asked, or
        # four of a cubic one.
        others, few = (
            mesh.Materials("pcl|rotor|housing|spreader|liner|seat"),
            {TET: ngs.IntegrationRule(TET, order - 1)},
        )
        worked = sheared * dx + dilated * dx(definedon=others) + dilated * dx("pad", intrules=few)
        self.form = BilinearForm(worked, symmetric=True).Assemble()
        self.inverse = self.form.mat.Inverse(self.space.FreeDofs(), "sparsecholesky")

    def solved(self, force: Any) -> Any:
        """Return displacement under a vector of forces; what is held does not move."""
        moved = force.CreateVector()
        moved.data = self.inverse * force
        return moved

    def work(self, displacement: Any) -> float:
        """Return twice the strain energy of a displacement [N*mm]."""
        pulled = displacement.vec.CreateVector()
        pulled.data = self.form.mat * displacement.vec
        return float(InnerProduct(pulled, displacement.vec))

    def turned(self) -> Any:
        """Return displacement where the core's top is turned by one radian."""
        return self.moved(TURN)

    def tilt(self, mm: elastic.Results) -> float:
        """Return the angle of the link over a torque by a force in its tool hole, less what it is without tilt.

        [rad/(N*mm)]; the core's top moves as one, free to lean and to shift.
        """
        up = z - mm["link_bottom_level"]
        motions = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -up, y), (up, 0, -x), TURN]
        vectors = [self.moved(motion).vec for motion in motions]
        force = vectors[0].CreateVector()
        stiffness = np.empty((len(vectors), len(vectors)))
        for row, vector in enumerate(vectors):
            force.data = self.form.mat * vector
            stiffness[row] = [InnerProduct(force, other) for other in vectors]
        load = np.array([0.0, 1.0, 0.0, -0.5 * mm["link_thickness"], 0.0, mm["link_length"]])
        free = load @ np.linalg.solve(stiffness, load) / mm["link_length"] ** 2
        return float(free - 1.0 / stiffness[-1, -1])

    def moved(self, motion: Any) -> Any:
        """Return displacement where the core's top moves as one."""
        displacement = ngs.GridFunction(self.space)
        displacement.Set(CF(motion), definedon=self.space.mesh.Boundaries("turned"))
        right = displacement.vec.CreateVector()
        right.data = -self.form.mat * displacement.vec
        displacement.vec.data += self.solved(right)
        return displacement


def _energies(mesh: Any, density: Any, mm: elastic.Results, torque: float) -> elastic.Results:
    """Return twice the strain energy of each part [N*mm], of all the torque at one radian.

    The pads have what is left.
    """
    core = IfPos(mm["core_radius"] + 0.01 - sqrt(x * x + y * y), 1, 0)
    shares = {name: Integrate(density, mesh, definedon=mesh.Materials(name)) for name in ("pcl", "housing")}
    rotor = mesh.Materials("rotor")
    shares["pad"] = torque - sum(shares.values()) - Integrate(density, mesh, definedon=rotor)
    if mm.get("vane_count"):
        shares["housing_vanes"] = Integrate(IfPos(z, 1, 0) * density, mesh, definedon=mesh.Materials("housing"))
        shares["housing"] -= shares["housing_vanes"]
        shares["rotor_vanes"] = Integrate(IfPos(mm["rotor_bottom_level"] - z, 1, 0) * density, mesh, definedon=rotor)
    shares["core"] = Integrate(core * density, mesh, definedon=rotor)
    shares["plate"] = Integrate((1 - core) * density, mesh, definedon=rotor) - shares.get("rotor_vanes", 0.0)
    return shares


SETTLED = 1e-4  # Share of the squared frequency below which a step's change ends the iteration
MOST = 12


def turning_frequency(
    mesh: Any, values: dict[str, float], solved: Callable[[Any], Any], shape: Any, torque: float
) -> float:
    """Return the frequency [Hz] of the lowest mode in which the core's top turns, by inverse iteration.

    The motion is the static shape w, turned by one radian (`torque` [N*mm]), times an angle, and what bends besides,
    which leaves the core's top where it is. w is orthogonal to that in stiffness, so that a step needs one solution
    with the core's top held. Link and load are an inertia on the core's top; the springs hold it to the ground. The
    first quotient is Rayleigh's of the static shape. Raises ValueError where the iteration does not settle.
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
            return float(squared**0.5) / (2.0 * pi)
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
    kinds = {"rotor": structure, "housing": structure, "pcl": values["pcl_density"], "pad": values["heater_density"]}
    kinds |= {name: values.get(f"{name}_density", 0.0) for name in ("spreader", "liner")}
    return mesh.MaterialCF({name: density * 1e-9 for name, density in kinds.items()})


if __name__ == "__main__":
    elastic.main(solve, __doc__)
