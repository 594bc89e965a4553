"""A constant load on the link while the layer melts or freezes: slices in series, each as its temperature leaves it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tvimdesign.base.errors import InputError, SimulationError
from tvimdesign.physics.layers import lasting_load
from tvimdesign.physics.motions import motion
from tvimdesign.physics.polymers import polymer
from tvimdesign.simulation.joint_tests.case import joint_of
from tvimdesign.simulation.link_motion.sampled_motion import RIGID, spectrum
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.resolved_module import ResolvedModule

Array = NDArray[np.float64]
TOLERANCE = 1e-6
NEVER = 1e15
"""Relaxation time of what does not relax [s]."""
ABSENT = (1.0, 1e-12, 0.0)
"""Relaxation time [s], stiffness [N*m/rad] and growth of a mode that a slice does not have: it bears nothing."""
FIRST_CELL = 3  # in a phase's `temperatures`, after cold side, hot side and near face


@dataclass(frozen=True)
class SliceHistory:
    """Temperature [K] and solid fraction of each slice, one row a slice, over times [s] that rise."""

    times: Array
    temperatures: Array
    fractions: Array

    def __post_init__(self) -> None:
        """Refuse times that do not rise, and arrays that do not fit them."""
        if len(self.times) < 2 or not np.all(np.diff(self.times) > 0.0):
            raise InputError("the times of a layer's history must rise, and be two at least")
        shape = (len(self.temperatures), len(self.times))
        if self.temperatures.shape != shape or self.fractions.shape != shape:
            raise InputError("a layer's history wants one row of temperatures and of solid fractions a slice")


@dataclass(frozen=True)
class Carried:
    """A load carried through a history: angle [rad], torque of the layer [N*m] and stored energy [J] over time."""

    times: Array
    angle: Array
    layer_torque: Array
    energy: Array
    torques: Array
    """Torque of each mode of each slice [N*m]: mode, slice, time."""
    unloaded_angle: float
    """Angle right after the load is taken off at the end [rad], of a layer that is bonded."""
    set_angle: float
    """Angle at which the layer is free of stress at the end [rad]."""


def slice_histories(resolved: ResolvedModule) -> SliceHistory:
    """Return temperatures and solid fractions of the layer's cells over the working cycle."""
    model = resolved.functions
    cycle = Simulator(model).run(model.start, resolved.current_profiles, ["stiffening"])
    begins = 0.0
    pieces: list[tuple[Array, Array, Array]] = []
    for name, trajectory in cycle.trajectories.items():
        count, phase = len(trajectory.times), model.phases[name]
        arguments = (trajectory.states, trajectory.currents[None, :], np.repeat(model.start[:, None], count, axis=1))
        stack = np.asarray(phase.temperatures.map(count)(*arguments))
        fractions = np.asarray(phase.fractions.map(count)(*arguments))
        first = 1 if pieces else 0  # a phase begins where the one before has ended
        pieces.append(
            (begins + trajectory.times[first:], stack[FIRST_CELL:][: model.cells, first:], fractions[:, first:])
        )
        begins += trajectory.times[-1]
    times, cells, solid = (np.concatenate([piece[k] for piece in pieces], axis=-1) for k in range(3))
    return SliceHistory(times, cells, np.clip(solid, 0.0, 1.0))


class Changing:
    """Stiffness and relaxation time of every mode of every slice over a history, smooth between its times.

    A structure that relaxes is one slice more, the last, which no history changes.
    """

    def __init__(self, logarithms: Array, times: Array, structure: motion.Modes = ()) -> None:
        """Take logarithms of (relaxation time [s], stiffness [N*m/rad]): which, mode, slice, time; no structure's."""
        from scipy.interpolate import PchipInterpolator

        self._curves = PchipInterpolator(times, logarithms, axis=-1)
        self._slopes = self._curves.derivative()
        self._structure = structure

    def at(self, time: float) -> lasting_load.Slices:
        """Return the slices at one time."""
        relaxation_times, stiffnesses = np.exp(self._curves(time))
        fields = relaxation_times, stiffnesses, self._slopes(time)[1]
        if not self._structure:
            return lasting_load.Slices(*map(list, fields))
        own = np.column_stack([*zip(*self._structure, strict=True), np.zeros(len(self._structure))])
        return lasting_load.Slices(*(_beside(*pair) for pair in zip(fields, own.T, ABSENT, strict=True)))


def _beside(layer: Array, structure: Array, absent: float) -> list[Array]:
    """Return one field of the slices with the structure's last; modes that either has not are `absent`."""
    count = max(len(layer), len(structure))
    both = np.full((count, layer.shape[1] + 1), absent)
    both[: len(layer), :-1] = layer
    both[: len(structure), -1] = structure
    return list(both)


def changing(resolved: ResolvedModule, history: SliceHistory) -> Changing:
    """Return slices of a module's layer over a history, of one thickness, and its structure as warm as when cold."""
    rheology, moment, thickness = (resolved.quantity(n) for n in ("pcl_rheology", "pcl_moment", "pcl_depth"))
    spectrum = polymer.spectrum(history.temperatures, history.fractions, rheology)
    modes = motion.layer_modes(spectrum, moment, thickness / len(history.temperatures))
    both = [[time for time, _ in modes], [stiffness for _, stiffness in modes]]
    return Changing(np.log(np.array(both)), history.times, _structure_of(resolved))


def _structure_of(resolved: ResolvedModule) -> motion.Modes:
    """Return Maxwell elements of a lossy structure at the cold point; its spring is one that never relaxes."""
    stiffness, loss = (float(part) for part in resolved.quantity("support@cold"))
    if loss <= 0.0:
        return ()
    spring, elements = spectrum(stiffness, loss, float(resolved.quantity("frequency@cold")))
    return [*([(NEVER, spring)] if spring > 0.0 else []), *elements]


def carry(layer: Changing, support: lasting_load.Support, load: float, times: Array) -> Carried:
    """Put a load [N*m] on the link of a layer free of stress and keep it there over the times; inertia left out.

    Raises SimulationError where the integration fails.
    """
    from scipy.integrate import solve_ivp

    begin = layer.at(float(times[0]))
    angle, torques = lasting_load.loaded_start(load, begin, support)
    shape = np.shape(torques)

    def rates(time: float, state: Array) -> Array:
        speed, changes = lasting_load.loaded_rates(list(state[1:].reshape(shape)), 0.0, layer.at(time), support)
        return np.concatenate([[speed], np.ravel(changes)])

    def jacobian(time: float, _: Array) -> Array:
        now = lasting_load.Slices(*([row[:, None] for row in field] for field in layer.at(time)))
        inner = np.eye(1 + shape[0] * shape[1])[1:].reshape(*shape, -1)
        speed, changes = lasting_load.loaded_rates(list(inner), 0.0, now, support)
        return np.concatenate([speed[None, :], np.reshape(changes, (-1, inner.shape[-1]))])

    solved = solve_ivp(
        rates, (times[0], times[-1]), np.append(angle, np.ravel(torques)), method="BDF", t_eval=times, jac=jacobian,
        rtol=TOLERANCE, atol=TOLERANCE * 1e-2 * abs(load),
    )  # fmt: skip
    if not solved.success:
        raise SimulationError(f"the loaded layer cannot be followed through its switch ({solved.message})")
    inner = solved.y[1:].reshape(*shape, -1)
    states = [layer.at(float(time)) for time in times]
    energies = [
        float(lasting_load.stored_energy(solved.y[0, i], list(inner[..., i]), now, support))
        for i, now in enumerate(states)
    ]
    given_back, _ = lasting_load.loaded_start(load, states[-1], support)
    layer_torque, last = np.sum(inner, axis=0)[0], solved.y[0, -1]
    free = last - layer_torque[-1] * lasting_load.compliance(states[-1], support)
    return Carried(times, solved.y[0], layer_torque, np.array(energies), inner, float(last - given_back), float(free))


def support_of(resolved: ResolvedModule) -> lasting_load.Support:
    """Return springs and structure on the bench, as warm as at the cold point; a lossy one gives as a slice."""
    joint = joint_of(resolved, "cold")
    return lasting_load.Support(joint.spring_stiffness, RIGID if _structure_of(resolved) else joint.structure_stiffness)
