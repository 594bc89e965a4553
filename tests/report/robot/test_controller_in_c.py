"""The controller's C code, as a compiler builds it, steps as Python's does."""

import ctypes
import subprocess

import numpy as np
import pytest
from robot_models import module_of

from tvimdesign.robot.fmu_file import compiler, controller_files
from tvimdesign.simulation.control.controller import RunningController
from tvimdesign.simulation.control.sizing import controller_of

MAIN = """
#include "controller.h"
static Controller c;
void start(double at) { controller_start(&c, at); }
double step(double at, double impedance) { return controller_step(&c, at, impedance); }
double impedance(void) { return c.impedance; }
"""


@pytest.mark.gate
def test_it_steps_as_the_simulated_one(mode, tmp_path):
    constants = controller_of(module_of(mode))
    assert constants is not None
    for name, text in {**controller_files(constants), "main.c": MAIN}.items():
        (tmp_path / name).write_text(text)
    flags = ("-std=c99", "-Wall", "-Werror", "-O1", "-fPIC", "-shared", "-o", "controller.so")
    subprocess.run([*compiler(), *flags, "main.c", "controller.c", "-lm"], cwd=tmp_path, check=True)
    built = ctypes.CDLL(str(tmp_path / "controller.so"))
    built.step.restype = built.impedance.restype = ctypes.c_double
    built.step.argtypes, built.start.argtypes = [ctypes.c_double] * 2, [ctypes.c_double]
    running = RunningController(constants, 295.15)
    built.start(295.15)
    count = 4000
    rise = constants.hottest + 2.0 - 295.15
    readings = 295.15 + rise * np.sin(np.linspace(0.0, 3.0, count)) + 0.05 * np.sin(np.arange(count))
    requested = np.repeat(
        [0.01, np.sqrt(constants.soft * constants.stiff), constants.soft, 2.0 * constants.stiff], count // 4
    )
    for reading, impedance in zip(readings.tolist(), requested.tolist(), strict=True):
        current = running.step(reading, impedance)
        assert built.step(reading, impedance) == pytest.approx(current, rel=1e-9, abs=1e-9)
        assert built.impedance() == pytest.approx(running.impedance, rel=1e-9)


def test_a_module_that_never_gets_soft_has_none():
    assert controller_files(None) == {}
