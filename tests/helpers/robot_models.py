"""A module of either mode as models for simulators, on bodies that have its inertia and no mesh."""

from functools import cache

from support import study_path

from tvimdesign.robot.joint_model import JointModel, RigidBody, joint_model
from tvimdesign.simulation.working_cycle.device_functions import ResolvedModule, resolve_study
from tvimdesign.study import read_study

STUDY = {"shear": "paper_reconstructed", "compression": "paper_compression"}


@cache
def module_of(mode: str) -> ResolvedModule:
    return resolve_study(read_study(study_path(STUDY[mode])))


@cache
def model_of(mode: str, step: float | None = None) -> JointModel:
    return joint_of(module_of(mode), step)


def joint_of(resolved: ResolvedModule, step: float | None = None) -> JointModel:
    inertia = float(resolved.quantity("parts_inertia"))
    base = RigidBody("base", 0.1, (0.0, 0.0, 0.0), ((1e-4, 0.0, 0.0), (0.0, 1e-4, 0.0), (0.0, 0.0, 1e-4)), "base.stl")
    off = min(0.004, (0.2 * inertia / 0.05) ** 0.5)
    about = inertia - 0.05 * off**2
    small = min(1e-7, 0.02 * about)
    tensor = ((0.6 * about, small, 2 * small), (small, 0.7 * about, 3 * small), (2 * small, 3 * small, about))
    return joint_model(resolved, base, RigidBody("moving", 0.05, (off, 0.0, 0.006), tensor, "moving.stl"), step)
