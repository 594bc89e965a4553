"""The link released, turned and rubbed: the product's exact motion of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from comparisons.numbers import Array
from tvimdesign.physics.motions import motion
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.course import Plant

Values = Mapping[str, Any]
_RIGID = 1e9  # N*m/rad: a structure that does not give
_NOTHING = [(1.0, 1e-9)]


def _joint(inputs: Values, structure: float = _RIGID) -> motion.Joint:
    return motion.Joint(inputs["inertia"], inputs["springs"], inputs.get("structure", structure))


def _at(moved: Any, times: Any) -> Array:
    """Angle [rad] between the moments of a motion, by its angles and speeds."""
    first = np.concatenate([[True], np.diff(moved.times) > 0.0])
    between = CubicHermiteSpline(moved.times[first], moved.angle[first], moved.speed[first])
    return np.asarray(between(np.array(times, float)))


def natural_motion(inputs: Values) -> Values:
    """Natural frequency [Hz], critical damping, and the frequency that a release on springs alone shows."""
    joint = _joint(inputs)
    ringing = link.swings(joint, _NOTHING, 0.1, np.zeros(1)).ringing()
    return {
        "frequency": motion.natural_frequency(joint.spring_stiffness, joint.inertia),
        "seen": ringing[0],
        "critical_damping": motion.critical_damping(joint.spring_stiffness, joint.inertia),
    }


def released_on_a_dashpot(inputs: Values) -> Values:
    """Angle [rad] over time of a link let go beside a dashpot, a Maxwell mode of a very short time."""
    short = inputs["shortest"]
    modes = [(short, inputs["damping"] / short)]
    joint = _joint(inputs, 1e3 * inputs["damping"] / short)
    moved = link.released(Plant(joint, modes), inputs["start"], np.full(1, inputs["start"])).motion
    return {"angle": _at(moved, inputs["time"])}


def released_on_maxwell(inputs: Values) -> Values:
    """Angle [rad] over time of a link let go beside Maxwell modes behind a structure."""
    modes = [tuple(map(float, mode)) for mode in inputs["modes"]]
    start = np.full(len(modes), inputs["start"])
    moved = link.released(Plant(_joint(inputs), modes), inputs["start"], start).motion
    return {"angle": _at(moved, inputs["time"])}


def rubbed(inputs: Values) -> Values:
    """Amplitudes [rad] at which a link let go against dry friction turns, and where it comes to rest."""
    released = link.released(Plant(_joint(inputs), _NOTHING), inputs["start"], np.full(1, 0.0), inputs["friction"])
    moved = released.motion
    stops = np.flatnonzero(moved.speed == 0.0)
    turned = moved.angle[stops][np.abs(np.diff(moved.angle[stops], prepend=np.nan)) > 1e-9]
    return {"amplitude": np.abs(turned[: inputs["count"]]), "rest": abs(released.rest_angle or 0.0)}
