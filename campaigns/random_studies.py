"""Answers random studies whole, and attacks every answer.

    python campaigns/random_studies.py [--studies 20] [--seed 1] [--jobs 1] [--out FILE]

A study varies some inputs of a shipped one, asks limits around what its optimum does and minimises something. Then
 - "optimal": the design, written as a study and evaluated, meets every limit and has the same values, and COBYLA,
   started at it, finds no better one beside it;
 - "infeasible": random search and differential evolution look for a design that meets all limits;
 - anything else ends with what to do next.
Each study has a process of its own. Its time limit counts processor time, so that it means the same beside other work;
a search that takes twice that is a failure. Answers are appended to FILE, a line a study; studies in it are not
answered again, so that a campaign that was ended goes on.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import resource
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Literal

import numpy as np
from attack import Attack
from oracle.frozen_files import read_frozen
from oracle.study_outputs import frozen_file, load_study

from tvimdesign.base.deadline import CLOCK
from tvimdesign.base.errors import InfeasibleError, InputError, TvimError
from tvimdesign.report.run.reasons import complaint
from tvimdesign.solve.optimizer.verify_optimum import CYCLE_TOLERANCE
from tvimdesign.solve.result import StudyResult, answer
from tvimdesign.study import Study, read_tree
from tvimdesign.study.sections import written
from tvimdesign.study.study import Options, Range, Requirement
from tvimdesign.study.tree import tree_of_values
from tvimdesign.study.written_studies import evaluating

ROOT = Path(__file__).resolve().parents[1]
TIME_LIMIT = 60.0  # s of the processor, of one search
MOST_PROCESSOR = 600  # s, of a study with its attack; more is a hang
SAME = 1e-9
"""Share within which the design evaluated again has the same values."""
BETTER = 5e-3
"""Share of what is minimised by which a design beside an optimum is better than it; times of both differ by 2e-3."""
LIMITED: dict[Literal[">=", "<="], tuple[str, ...]] = {
    ">=": ("holding_torque", "spring_stiffness", "impedance_range", "spring_fatigue_safety", "stiffness_over_stroke"),
    "<=": ("module_mass", "envelope_diameter", "envelope_height", "response_time", "peak_power", "switch_energy"),
}
BASES = ("paper_shear", "elbow_machined", "machined_compression")
"""Studies whose frozen optimum the limits lie around."""
NARROWED, LISTED = 0.08, 0.1
"""Shares of the variables whose range is narrowed, or that are chosen from a list."""


def random_study(seed: int) -> Study:
    """Return a study that the reader takes: limits and fixed inputs lie around the base's optimum."""
    draw = random.Random(seed)
    name = draw.choice(BASES)
    base, optimum = load_study(name).resolved, frozen(name)
    numbers = [name for name, vary in base.vary.items() if isinstance(vary, Range)]
    names = draw.sample(numbers, draw.randint(min(4, len(numbers)), len(numbers)))
    vary: dict[str, Range | Options] = {}
    for name in names:
        whole = base.vary[name]
        assert isinstance(whole, Range)
        ends = sorted(draw.uniform(whole.lower, whole.upper) for _ in range(2))
        vary[name] = Range(lower=ends[0], upper=ends[1]) if draw.random() < NARROWED else whole
        if draw.random() < LISTED:
            vary[name] = Options(values=tuple(sorted(np.linspace(*ends, draw.randint(2, 5)).tolist())))
    require = []
    for sense, outputs in LIMITED.items():
        for name in draw.sample(outputs, draw.randint(0, 2)):
            factor = draw.choice((0.3, 0.6, 0.9, 1.0, 1.2)) ** (1 if sense == ">=" else -1)
            require.append(Requirement(output=name, sense=sense, limit=factor * optimum[name], text=""))
    minimize = dict.fromkeys(draw.sample(LIMITED["<="], draw.randint(1, 3)), 1.0)
    solver = {"starts": draw.randint(1, 4), "seed": seed, "cells": draw.randint(6, 16), "time_limit": TIME_LIMIT}
    fixed = {name: optimum[name] for name in numbers if name not in vary}
    module = {name: value for name, value in base.module.items() if name not in vary}
    limited = base.model_copy(
        update={
            "name": f"random {seed}", "vary": vary, "module": {**module, **fixed}, "require": tuple(require),
            "minimize": minimize, "front": None, "robust": None, "solver": base.solver.model_copy(update=solver),
        }
    )  # fmt: skip
    return read_tree(tree_of_values(written(limited), f"random {seed}", ROOT / "studies"))


def frozen(name: str) -> dict[str, float]:
    """Return what the frozen optimum of a base has and does, in SI."""
    outputs = read_frozen(frozen_file(name))["outputs"]
    return {quantity: value for quantity, value in outputs.items() if isinstance(value, float)}


def judged(seed: int) -> dict[str, Any]:
    """Answer and attack a study: return its status, what is wrong, and the processor time of the search [s]."""
    try:
        study = random_study(seed)
        Attack(study)
    except (InputError, InfeasibleError) as error:
        return {"status": "not drawn", "said": str(error)[:200], "wrong": ""}
    began = time.process_time()
    try:
        answered = answer(study)
    except InputError as error:
        return {"status": "refused", "said": str(error)[:300], "wrong": "" if str(error) else "no words"}
    except InfeasibleError as error:
        seconds = time.process_time() - began
        wrong = "a design meets all limits" if Attack(study).finds_a_design(seed) else ""
        return {"status": "infeasible", "said": str(error)[:300], "wrong": wrong, "seconds": seconds}
    seconds = time.process_time() - began
    status, _, why = answered.design.status.partition(":")
    message = "" if answered.has_design else complaint(answered)
    wrong = ""
    if answered.has_design:
        wrong = wrong_optimum(study, answered)
    elif status == "infeasible":
        wrong = "a design meets all limits" if Attack(study).finds_a_design(seed) else ""
    elif not any(word in message for word in ("raise", "try", "set ", "ease", "widen", "narrow", "ask")):
        wrong = "no next step"
    return {"status": status, "why": why.strip(), "said": message[:1500], "wrong": wrong, "seconds": seconds}


def wrong_optimum(study: Study, answered: StudyResult) -> str:
    """Return what differs in a design evaluated again from a study of its own; or what is better beside it."""
    if answered.design.current_profiles:
        return ""
    again = answer(evaluating(answered.design))
    broken = [check.text for check in again.checks if check.margin < -CYCLE_TOLERANCE]
    if broken:
        return f"breaks {broken[0]}"
    reported, again_values = answered.design.values, again.design.values
    off = {name: abs(reported[name] - again_values[name]) / max(abs(reported[name]), 1e-12) for name in reported
           if np.isfinite(reported[name]) and np.isfinite(again_values[name])}  # fmt: skip
    name = max(off, key=lambda output: off[output])
    if off[name] > SAME:
        return f"{name} is {off[name]:.1e} off"
    assert answered.solution is not None
    better = Attack(study).improved(reported, answered.solution.reference)
    return f"COBYLA betters it by {better:.2%}" if better > BETTER else ""


def in_a_process(seed: int) -> dict[str, Any]:
    """Judge a study in a process of its own, whose time limits count processor time."""
    command = [sys.executable, str(Path(__file__)), "--one", str(seed)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", CLOCK: "processor"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or [""])[-1]
        wrong = f"ends with {done.returncode}: {last}"
        return {"seed": seed, "status": "hang or crash", "said": done.stderr[-1500:], "wrong": wrong}
    verdict: dict[str, Any] = {"seed": seed, **json.loads(done.stdout.splitlines()[-1])}
    if not verdict["wrong"] and verdict.get("seconds", 0.0) > 2.0 * TIME_LIMIT:
        verdict["wrong"] = f"{verdict['seconds']:.0f} s of the processor, the limit is {TIME_LIMIT:g} s"
    return verdict


def judge_one(seed: int) -> int:
    """Judge a study here and print the answer; the kernel ends it after too much processor time."""
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_PROCESSOR, MOST_PROCESSOR))
    try:
        verdict = judged(seed)
    except TvimError as error:
        verdict = {"status": "error", "said": str(error), "wrong": f"{type(error).__name__}: {error}"}
    print(json.dumps(verdict))
    return 0


def campaign(seeds: Sequence[int], jobs: int, out: Path | None) -> list[dict[str, Any]]:
    """Judge the studies of these seeds that `out` has no answer for; every answer, the earlier ones too."""
    earlier = [json.loads(line) for line in out.read_text().splitlines()] if out and out.exists() else []
    there = {past["seed"] for past in earlier}
    answers = [past for past in earlier if past["seed"] in seeds]
    with ThreadPoolExecutor(jobs) as pool:
        for verdict in pool.map(in_a_process, [seed for seed in seeds if seed not in there]):
            answers.append(verdict)
            print(
                f"{verdict['seed']}: {verdict['status']}, {verdict.get('seconds', 0.0):.0f} s {verdict['wrong']}",
                flush=True,
            )
            if out:
                with out.open("a") as lines:
                    lines.write(json.dumps(verdict) + "\n")
    return answers


def main() -> int:
    """Run the campaign; 1 where an answer was wrong."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--studies", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1, help="of the first study; the others follow")
    parser.add_argument("--jobs", type=int, default=1, help="studies at once")
    parser.add_argument("--out", type=Path, help="file that answers are appended to, a line a study")
    parser.add_argument("--one", type=int, help="judge the study of this seed here")
    options = parser.parse_args()
    if options.one is not None:
        return judge_one(options.one)
    answers = campaign(range(options.seed, options.seed + options.studies), options.jobs, options.out)
    wrong = sum(bool(verdict["wrong"]) for verdict in answers)
    print(f"{len(answers)} studies, {wrong} wrong: {dict(Counter(verdict['status'] for verdict in answers))}")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
