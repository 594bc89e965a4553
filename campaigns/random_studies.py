"""Whole searches of random valid studies, each answer attacked by means that know nothing of the solver.

    python campaigns/random_studies.py [--studies 20] [--seed 1] [--jobs 1] [--json FILE]

A study varies some inputs of a shipped one, asks limits around what its start does and minimises something. Then
 - "optimal": the design, written as a study and evaluated, keeps every limit and has the same values;
 - "infeasible": random search and differential evolution look for a design that keeps all limits;
 - anything else ends with what to do next.
Each study has a process of its own and a time limit, which the study states; twice that is a failure.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import differential_evolution

from tvimdesign.base.errors import InfeasibleError, InputError, SimulationError, TvimError
from tvimdesign.device import Input
from tvimdesign.report.run.infeasible_report import complaint
from tvimdesign.simulation.working_cycle.cycle import Simulator
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.solve.nlp.constraints import constraints_of
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import Study, given, read_study, read_tree
from tvimdesign.study.result_study import evaluating
from tvimdesign.study.study import Options, Range, Requirement
from tvimdesign.study.tree import tree_of_values
from tvimdesign.study.written_study import written

ROOT = Path(__file__).resolve().parents[1]
TIME_LIMIT = 60.0  # s, of one search
SAME = 1e-9
"""Share within which the design evaluated again has the same values."""
ASKED: dict[Literal[">=", "<="], tuple[str, ...]] = {
    ">=": ("holding_torque", "spring_stiffness", "impedance_range", "spring_fatigue_safety", "stiffness_over_stroke"),
    "<=": ("module_mass", "envelope_diameter", "envelope_height", "response_time", "peak_power", "switch_energy"),
}
BASES = ("paper_shear", "wrist_joint", "paper_compression", "machined_shear", "wrist_compression")
RANDOM, GENERATIONS, EACH = 80, 5, 5
"""Random designs of an attack, then generations of so many designs a variable."""


def random_study(seed: int) -> Study:
    """A study that the reader takes; its limits lie around what its start does."""
    draw = random.Random(seed)
    base = read_study(ROOT / f"studies/{draw.choice(BASES)}.yaml")
    numbers = [name for name, vary in base.vary.items() if isinstance(vary, Range)]
    names = draw.sample(numbers, draw.randint(min(4, len(numbers)), len(numbers)))
    vary: dict[str, Range | Options] = {}
    for name in names:
        whole = base.vary[name]
        assert isinstance(whole, Range)
        ends = sorted(draw.uniform(whole.lower, whole.upper) for _ in range(2))
        vary[name] = Range(lower=ends[0], upper=ends[1]) if draw.random() < 0.2 else whole
        if draw.random() < 0.15:
            vary[name] = Options(values=tuple(sorted(np.linspace(*ends, draw.randint(2, 5)).tolist())))
    values = {**start_values(base)}
    require = []
    for sense, outputs in ASKED.items():
        for name in draw.sample(outputs, draw.randint(0, 2)):
            if np.isfinite(values.get(name, np.inf)):
                factor = draw.choice((0.3, 0.6, 0.9, 1.0, 1.2)) ** (1 if sense == ">=" else -1)
                require.append(Requirement(output=name, sense=sense, limit=factor * values[name], text=""))
    minimize = dict.fromkeys(draw.sample(ASKED["<="], draw.randint(1, 3)), 1.0)
    solver = {"starts": draw.randint(1, 4), "seed": seed, "cells": draw.randint(6, 16), "time_limit": TIME_LIMIT}
    module = {name: value for name, value in base.module.items() if name not in vary}
    asked = base.model_copy(
        update={
            "name": f"random {seed}", "vary": vary, "module": module, "require": tuple(require), "minimize": minimize,
            "front": None, "robust": None, "solver": base.solver.model_copy(update=solver),
        }
    )  # fmt: skip
    return read_tree(tree_of_values(written(asked), f"random {seed}", ROOT / "studies"))


def start_values(study: Study) -> dict[str, float]:
    """What the module does that a study starts from."""
    model = DeviceFunctions(study.table, given(study), tuple(study.operating_points), study.solver.cells)
    return model.values(model.start, Simulator(model).run(model.start).values)


class Attack:
    """Evaluates designs of a study with none of the solver's code: how much the worst of them breaks a limit."""

    def __init__(self, study: Study) -> None:
        """Compile the module."""
        self.model = DeviceFunctions(study.table, given(study), tuple(study.operating_points), study.solver.cells)
        self.simulator = Simulator(self.model)
        self.limits = constraints_of(study, study.table, self.model.words)
        self.names = [name for name in study.vary if isinstance(study.table.quantity(name), Input)]
        self.ends = [
            (vary.lower, vary.upper) if isinstance(vary, Range) else (float(min(vary.values)), float(max(vary.values)))
            for vary in (study.vary[name] for name in self.names)
        ]
        self.sizes = [sorted(v.values) if isinstance(v := study.vary[name], Options) else [] for name in self.names]
        self.least = np.inf

    def worst(self, shares: NDArray[np.float64]) -> float:
        """The largest residual of any limit at a place between the ends; a hundred where there is no such module."""
        inputs = self.model.start.copy()
        for name, share, (low, high), sizes in zip(self.names, shares, self.ends, self.sizes, strict=True):
            value = low + share * (high - low)
            nearest = min((float(size) for size in sizes), key=lambda size: abs(size - value), default=value)
            inputs[self.model.index[name]] = nearest
        try:
            values = self.model.values(inputs, self.simulator.run(inputs).values)
        except SimulationError:
            return 100.0
        found = [float(limit.residual(values[limit.output])) for limit in self.limits]
        worst = 100.0 if any(np.isnan(found)) else min(max(found), 100.0)
        self.least = min(self.least, worst)
        return worst

    def finds_a_design(self, seed: int) -> bool:
        """Whether random search or differential evolution come to a design that keeps every limit."""
        draw = np.random.default_rng(seed)
        for shares in draw.random((RANDOM, len(self.names))):
            if self.worst(shares) <= 0.0:
                return True
        bounds = [(0.0, 1.0)] * len(self.names)
        differential_evolution(
            self.worst, bounds, maxiter=GENERATIONS, popsize=EACH, seed=seed, polish=False,
            callback=lambda *_, **__: self.least <= 0.0,
        )  # fmt: skip
        return bool(self.least <= 0.0)


def judged(seed: int) -> dict[str, Any]:
    """One study answered and attacked: its status, and what is wrong."""
    try:
        study = random_study(seed)
        Attack(study)
    except (InputError, InfeasibleError) as error:
        return {"status": "not drawn", "said": str(error)[:200], "wrong": ""}
    began = time.monotonic()
    try:
        answered = answer(study)
    except InputError as error:
        return {"status": "refused", "said": str(error)[:300], "wrong": "" if str(error) else "no words"}
    except InfeasibleError as error:
        seconds = time.monotonic() - began
        wrong = "a design keeps all limits" if Attack(study).finds_a_design(seed) else ""
        return {"status": "infeasible", "said": str(error)[:300], "wrong": wrong, "seconds": seconds}
    seconds = time.monotonic() - began
    status = answered.design.status.partition(":")[0]
    said = "" if answered.found else complaint(answered, study.table)
    wrong = ""
    if answered.found:
        wrong = wrong_optimum(answered)
    elif status == "infeasible":
        wrong = "a design keeps all limits" if Attack(study).finds_a_design(seed) else ""
    elif not any(word in said for word in ("raise", "try", "set ", "ease", "widen", "narrow", "ask")):
        wrong = "no next step"
    return {"status": status, "said": said[:400], "wrong": wrong, "seconds": seconds}


def wrong_optimum(answered: StudyResult) -> str:
    """What is not as told of a design, evaluated again from a study of its own."""
    if answered.design.current_profiles:
        return ""
    again = answer(evaluating(answered.design))
    broken = [check.text for check in again.checks if check.margin < -CYCLE_TOLERANCE]
    if broken:
        return f"breaks {broken[0]}"
    told, found = answered.design.values, again.design.values
    off = {name: abs(told[name] - found[name]) / max(abs(told[name]), 1e-12) for name in told
           if np.isfinite(told[name]) and np.isfinite(found[name])}  # fmt: skip
    name = max(off, key=lambda one: off[one])
    return f"{name} is {off[name]:.1e} off" if off[name] > SAME else ""


def in_a_process(seed: int) -> dict[str, Any]:
    """A study judged in a process of its own."""
    command = [sys.executable, str(Path(__file__)), "--one", str(seed)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=900.0, check=False, env=environment)
    except subprocess.TimeoutExpired:
        return {"seed": seed, "status": "hang", "said": "", "wrong": "no answer in 900 s"}
    if done.returncode != 0:
        last = done.stderr.strip().splitlines()[-1:] or [f"code {done.returncode}"]
        return {"seed": seed, "status": "crash", "said": last[0], "wrong": last[0]}
    found: dict[str, Any] = {"seed": seed, **json.loads(done.stdout.splitlines()[-1])}
    if not found["wrong"] and found.get("seconds", 0.0) > 2.0 * TIME_LIMIT:
        found["wrong"] = f"{found['seconds']:.0f} s, the limit is {TIME_LIMIT:g} s"
    return found


def main() -> int:
    """Run the campaign; 1 where an answer was wrong."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--studies", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1, help="of the first study; the others follow")
    parser.add_argument("--jobs", type=int, default=1, help="studies at once")
    parser.add_argument("--json", type=Path, help="file for every answer")
    parser.add_argument("--one", type=int, help="judge the study of this seed here")
    asked = parser.parse_args()
    if asked.one is not None:
        try:
            found = judged(asked.one)
        except TvimError as error:
            found = {"status": "error", "said": str(error), "wrong": f"{type(error).__name__}: {error}"}
        print(json.dumps(found))
        return 0
    count, answers = Counter[str](), []
    with ThreadPoolExecutor(asked.jobs) as pool:
        for found in pool.map(in_a_process, range(asked.seed, asked.seed + asked.studies)):
            answers.append(found)
            count[found["status"]] += 1
            count["wrong"] += bool(found["wrong"])
            print(f"{found['seed']}: {found['status']}, {found.get('seconds', 0.0):.0f} s {found['wrong']}", flush=True)
    print(dict(count))
    if asked.json:
        asked.json.write_text(json.dumps({"counts": dict(count), "answers": answers}, indent=2) + "\n")
    return int(count["wrong"] > 0)


if __name__ == "__main__":
    sys.exit(main())
