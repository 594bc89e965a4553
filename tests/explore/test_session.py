"""A session of the explorer and its worker process."""

import asyncio
import json
import os
import signal
from contextlib import suppress
from typing import Any

import pytest
from answers import shipped_answer
from explored import SMALL, TOKEN, Talk, awaited, served, small_study, talking

from tvimdesign.base.units import from_si
from tvimdesign.explore.answer_worker import _done
from tvimdesign.explore.engine import Answer, Engine, Progress, Stage
from tvimdesign.explore.source import open_source
from tvimdesign.explore.state import State
from tvimdesign.explore.worker_process import Job, WorkerProcess
from tvimdesign.report.run.answered_study import answer_study
from tvimdesign.study.design import write_design
from tvimdesign.study.tree import tree_of_file


@pytest.mark.gate
def test_the_newest_state_of_a_drag_is_answered(tmp_path):
    async def drag() -> tuple[list[dict[str, Any]], dict[str, Any], dict[str, Any]]:
        async with talking(small_study(tmp_path), tmp_path / "out") as page:
            first = await page.answer("quick")
            page.heard.clear()
            for step in range(60):
                await page.send(
                    kind="require", name="peak_power", texts=[f"<= {11.9 - 0.05 * step} W"], final=step == 59
                )
            last = await page.until(lambda item: item["kind"] == "answer" and item["number"] == 61)
            return [item for item in page.heard if item["kind"] == "answer"], first, last

    answers, first, last = awaited(drag())
    assert len(answers) < 50
    assert [item["number"] for item in answers] == sorted(item["number"] for item in answers)
    power = next(item for item in last["shown"]["limits"] if item["of"] == "peak_power")
    assert (power["stands"], power["got"], power["text"]) == ("active", "8.95 W", "peak power <= 8.95 W")
    met = [(item["of"], item["sense"]) for item in last["shown"]["limits"] if item["stands"] == "kept"]
    assert len(set(met)) == len(met)  # one row for a stiffness that is limited at five angles
    assert last["shown"]["variables"]["current"]["value"] < first["shown"]["variables"]["current"]["value"]


@pytest.mark.slow
def test_an_impossible_module_has_a_reason_in_place_of_a_draft(tmp_path):
    async def dragged() -> list[dict[str, Any]]:
        async with talking(small_study(tmp_path), tmp_path / "out") as page:
            await page.send(kind="way", way="evaluate")
            reported = []
            for text in ("20 mm", "38 mm", "20.1 mm"):  # between them is one without room for the heaters' windows
                await page.send(kind="set", name="pcl_inner_radius", text=text, final=False)
                number = len(reported) + 3
                reported.append(
                    await page.until(lambda item, of=number: item["kind"] == "draft" and item["number"] == of)
                )
            return reported

    before, none, after = awaited(dragged())
    assert before["meshes"]
    assert none["words"].startswith("there is no such module")
    assert "meshes" not in none
    assert after["meshes"]


@pytest.mark.slow
def test_the_exact_answer_is_the_one_of_run_and_comes_with_the_report(tmp_path):
    study = small_study(tmp_path)

    async def settled() -> dict[str, Any]:
        async with talking(study, tmp_path / "out") as page:
            await page.answer("quick")
            await page.send(kind="require", name="peak_power", texts=["<= 9 W"])
            exact = await page.answer("exact")
            await page.save("saved.yaml")
            return exact

    exact = awaited(settled())
    again = answer_study(tree_of_file(tmp_path / "out" / "saved.yaml"), lambda _: None).result.design
    for name, shown in exact["shown"]["variables"].items():
        assert shown["value"] == pytest.approx(again.values[name] * (1e3 if name == "pcl_thickness" else 1.0), rel=1e-5)
    assert exact["shown"]["found"]
    assert [section["name"] for section in exact["report"]["sections"]][:2] == ["cycle", "why"]


@pytest.mark.slow
def test_an_exact_answer_gives_way_to_what_is_asked_meanwhile(tmp_path):
    async def superseded() -> tuple[list[tuple[int, str]], bool]:
        async with (
            served(small_study(tmp_path), tmp_path / "out") as (server, client),
            client.ws_connect(f"/{TOKEN}/socket") as socket,
        ):
            page, process = Talk(socket), server.session.solver.process
            await page.answer("quick")
            while (job := server.session.solver.under_way) is None or job.stage != "exact":
                await asyncio.sleep(0.01)
            await page.send(kind="require", name="peak_power", texts=["<= 10 W"])
            await page.answer("exact")
            answers = [(item["number"], item["shown"]["stage"]) for item in page.heard if item["kind"] == "answer"]
            return answers, server.session.solver.process == process

    answers, same = awaited(superseded())
    assert answers == [(1, "quick"), (2, "quick"), (2, "exact")]
    assert same


@pytest.mark.slow
def test_an_infeasible_state_reports_the_conflict(tmp_path):
    async def reply_of() -> dict[str, Any]:
        async with talking(small_study(tmp_path), tmp_path / "out") as page:
            await page.answer("quick")
            await page.send(kind="require", name="response_time", texts=["<= 20 s"])
            return await page.until(
                lambda item: item["kind"] == "answer" and item["number"] == 2 and item["shown"]["stage"] == "exact"
            )

    shown = awaited(reply_of())["shown"]
    assert not shown["found"]
    assert "no feasible design found" in shown["status"]
    assert shown["values"]
    assert any(item["stands"] == "violated" for item in shown["limits"])


@pytest.mark.slow
def test_two_pages_share_a_study_a_design_is_pinned_and_gone_back_to(tmp_path):
    async def pinned() -> tuple[list[dict[str, Any]], dict[str, Any]]:
        async with (
            served(small_study(tmp_path), tmp_path / "out") as (_, client),
            client.ws_connect(f"/{TOKEN}/socket") as item,
            client.ws_connect(f"/{TOKEN}/socket") as two,
        ):
            first, second = Talk(item), Talk(two)
            await first.kind("state")
            await second.answer("quick")
            await first.send(kind="pin", name="as it was")
            pins = (await second.until(lambda reported: reported["kind"] == "state" and reported["pins"] != []))["pins"]
            await first.send(kind="way", way="evaluate")
            await first.send(kind="set", name="current", text="1.1 A")
            await second.until(lambda reported: reported["kind"] == "state" and _current(reported) == "1.1 A")
            await second.send(kind="recall", number=0)
            back = await first.until(
                lambda reported: reported["kind"] == "state" and reported["undo"] and reported["way"] == "optimize"
            )
            return pins, back

    pins, back = awaited(pinned())
    assert pins[0]["name"] == "as it was"
    assert pins[0]["values"]["peak_power"].endswith("W")
    thickness = back["controls"]["variables"][0]["text"]
    assert float(thickness.split()[0]) == pytest.approx(float(pins[0]["values"]["pcl_thickness"].split()[0]), rel=1e-3)


def _current(state: dict[str, Any]) -> str:
    return str(next(item["text"] for item in state["controls"]["variables"] if item["name"] == "current"))


@pytest.mark.slow
def test_a_worker_that_dies_is_started_again_and_the_state_is_there(tmp_path):
    async def killed() -> dict[str, Any]:
        async with (
            served(small_study(tmp_path), tmp_path / "out") as (server, client),
            client.ws_connect(f"/{TOKEN}/socket") as socket,
        ):
            page = Talk(socket)
            await page.answer("quick")
            os.kill(server.session.solver.process, signal.SIGKILL)
            await page.send(kind="require", name="peak_power", texts=["<= 9 W"])
            return await page.until(lambda item: item["kind"] == "answer" and item["number"] == 2)

    shown = awaited(killed())["shown"]
    assert any(item["text"] == "peak power <= 9 W" for item in shown["limits"])


@pytest.mark.slow
def test_a_result_is_opened_with_its_own_optimum(tmp_path):
    result = shipped_answer("paper_shear").design
    write_design(result, tmp_path / "design.json")
    source = open_source(tmp_path)
    shown = Engine(source.tree, compiled=False).answer(source.first, "quick").shown
    for name in ("wire_diameter", "coil_diameter", "placement_radius", "current"):
        unit = source.study.table.unit(name)
        value, reported = shown["at"][name].split(" ", 1)
        assert reported == unit
        assert float(value) == pytest.approx(from_si(result.values[name], unit), rel=0.01)  # another is 2 to 5 % off


def test_built_parts_are_drafted_as_they_were_drawn(tmp_path):
    built = SMALL + "as_drawn: {running_clearance: 0.31 mm}\n"
    source = open_source(small_study(tmp_path, built))
    measured = State(way="evaluate", at={**source.first.at, "running_clearance": "0.4 mm"})
    answer = Engine(source.tree, compiled=False).answer(measured, "quick")
    assert answer.module is not None
    assert answer.module["values"]["running_clearance"] == pytest.approx(0.31e-3)


@pytest.mark.slow
def test_a_quick_evaluation_is_the_exact_one_to_two_thousandths(tmp_path):
    source = open_source(small_study(tmp_path))
    engine = Engine(source.tree)
    for thickness in ("0.7 mm", "1 mm", "1.6 mm"):
        state = State(way="evaluate", at={**source.first.at, "pcl_thickness": thickness})
        engine.answer(state, "quick")
        engine.wait()
        quick, exact = (engine.answer(state, stage).shown["values"] for stage in ("quick", "exact"))
        names = [row.name for row in source.study.table.supplied]
        assert names
        units = [item for item in zip(quick, exact, strict=True) if None not in item]
        assert len(units) > 200
        assert all(a == pytest.approx(b, rel=2e-3, abs=1e-2) for a, b in units)


class _Counted(WorkerProcess):
    """Counts how often it starts its process."""

    starts = 0

    def _start(self) -> None:
        self.starts += 1
        super()._start()


def test_a_worker_that_cannot_start_is_tried_again_per_job():
    async def reply_of() -> tuple[list[tuple[int, str]], int]:
        reported: list[tuple[int, str]] = []
        worker = _Counted(
            "tvimdesign.no_such_module", [], lambda job, reply: reported.append((job.number, reply["words"]))
        )
        started = worker.starts
        for number in (1, 2):
            worker.ask(Job(number, {}, {"words": "given up"}))
            async with asyncio.timeout(600.0):
                while (number, "given up") not in reported:
                    await asyncio.sleep(0.02)
        await asyncio.sleep(0.3)
        worker.close()
        return reported, worker.starts - started

    reported, starts = awaited(reply_of())
    assert reported == [(1, "given up"), (2, "given up")]
    assert starts <= 2


class _Interrupted(Engine):
    """Interrupted while it answers an exact job, which a library swallows."""

    went_on = False

    def answer(self, state: State, stage: Stage, progress: Progress = lambda _: None) -> Answer:
        if stage == "exact":
            with suppress(KeyboardInterrupt):
                os.kill(os.getpid(), signal.SIGINT)
            progress("the next start")
            self.went_on = True
        return super().answer(state, stage, progress)


def test_a_job_ends_at_the_next_thing_it_says_and_another_is_answered(tmp_path):
    source = open_source(small_study(tmp_path))
    engine, written = _Interrupted(source.tree), list[Any]()
    state = json.loads(source.first.model_dump_json())

    def done(number: int, stage: str) -> dict[str, Any]:
        return _done(engine, {"number": number, "stage": stage, "state": state}, tmp_path, written.append)

    assert done(1, "exact") == {"superseded": True}
    assert not engine.went_on
    assert written == []
    assert done(2, "quick")["shown"]["stage"] == "quick"
