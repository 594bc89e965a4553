"""Data of joints and springs: the product's own equations with normal noise."""

from __future__ import annotations

import numpy as np

from made_measurements.made import Made, block, numbers
from tvimdesign.physics.motions import motion
from tvimdesign.simulation.measurement.kinds import release, torque_angle


def torque_angle_data(noise: np.random.Generator) -> Made:
    """Return a joint loaded to 1 N.m both ways and back in steps of 0.1 N.m; angles read to 0.06 deg."""
    truth = {"stiffness": 5.0, "friction": 0.05, "backlash": 0.01, "zero_angle": 0.02}
    steps = np.linspace(0.1, 1.0, 10)
    torque = np.concatenate([steps, steps[::-1], -steps, -steps[::-1], steps])
    angle = np.asarray(torque_angle.angle_of(torque)(truth)).ravel() + noise.normal(0.0, 1e-3, len(torque))
    return [block(torque=torque, angle=angle)], {}, truth


def release_data(noise: np.random.Generator) -> Made:
    """Return a joint of known inertia let go at 0.12 rad, sampled at 500 Hz for half a second; angles to 1 mrad."""
    truth = {"stiffness": 5.0, "damping": 3e-3, "friction": 0.01, "zero_angle": 0.01}
    moments = np.linspace(0.0, 0.5, 250)
    known = {**truth, "inertia": 4e-4, "first_angle": 0.12, "first_speed": 0.0}
    corner = 0.01 * 0.22 * np.pi / 0.0562
    angle = numbers(release.swing(moments, known, 6, corner)) + noise.normal(0.0, 1e-3, len(moments))
    follows = {
        "first_angle": 0.12, "first_speed": 0.0, "natural_frequency": np.sqrt(5.0 / 4e-4) / (2.0 * np.pi),
        "damping_ratio": 3e-3 / (2.0 * np.sqrt(5.0 * 4e-4)),
    }  # fmt: skip
    return [block(time=moments, angle=angle)], {"inertia": "4e-4 kg.m^2"}, {**truth, **follows}


def sine_data(noise: np.random.Generator) -> Made:
    """Return a joint turned by 0.1 rad at 2 and 6 Hz for three periods; angles to 0.5 mrad, torques to 10 mN.m."""
    truth = {"inertia": 2e-3, "stiffness": 5.0, "damping": 0.02, "friction": 0.05, "zero_angle": 0.01}
    blocks = []
    for hertz in (2.0, 6.0):
        omega = 2.0 * np.pi * hertz
        time = np.linspace(0.0, 3.0 / hertz, 150)
        angle, speed = 0.1 * np.sin(omega * time), 0.1 * omega * np.cos(omega * time)
        spring = motion.kelvin_voigt_torque(angle - truth["zero_angle"], speed, truth["damping"], truth["stiffness"])
        torque = -truth["inertia"] * omega**2 * angle - spring
        torque = torque + truth["friction"] * np.tanh(speed / (release.CORNER * 0.1 * omega))
        blocks.append(
            block(time=time, angle=angle + noise.normal(0.0, 5e-4, 150), torque=torque + noise.normal(0.0, 0.01, 150))
        )
    loss = truth["damping"] * 2.0 * np.pi * 2.0 + 4.0 * truth["friction"] / (np.pi * 0.1)
    return blocks, {}, {**truth, "loss": loss}


def frozen_torque_data(noise: np.random.Generator) -> Made:
    """Three joints turned by 80 mrad that give at 12 N.m, from zeros of their own; torques to 0.1 N.m."""
    truth = {"stiffness": 250.0, "holding_torque": 12.0}
    moment = 4.0 * np.radians(49.0) / 4.0 * (0.040**4 - 0.026**4)
    blocks = []
    zeros = (0.0, 0.005, -0.003)
    for zero in zeros:
        angle = np.linspace(zero, zero + 0.08, 60)
        torque = numbers(torque_angle.torque_of(angle, {**truth, "zero_angle": zero}))
        blocks.append(block(angle=angle, torque=torque + noise.normal(0.0, 0.1, 60)))
    sizes = {"layer_inner_radius": "26 mm", "layer_outer_radius": "40 mm", "layer_span": "49 deg"}
    own = {f"zero_angle_{i}": zero for i, zero in enumerate(zeros, start=1)}
    return blocks, sizes, {**truth, **own, "bond_strength": 12.0 * 0.040 / moment}
