"""Heat-set inserts: the holes and walls they ask for, what they weigh, and whether the screws reach through them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.catalog import Catalog
from tvimdesign.device import MODES, table_for
from tvimdesign.solve.nlp.constraints import limits_of, refuse_impossible
from tvimdesign.study import given, read_study_text

MM = 1e-3
TABLE = table_for("shear")
MISFITS = tuple(f"{joint}_insert_misfit" for joint in ("link", "retainer", "adjuster", "cover"))
RULES = ("insert_ground", *MISFITS)


def inputs_with(**module: str) -> dict[str, Any]:
    """Inputs of the default shear module but for what is said."""
    lines = "\n".join(f"  {name}: {value}" for name, value in module.items())
    return given(read_study_text(f"mode: shear\nmodule:\n{lines}\n", "a test"), Catalog(), TABLE)


def values_of(rows: str, **module: str) -> dict[str, float]:
    return {name: float(value) for name, value in TABLE.evaluate(inputs_with(**module), rows.split()).items()}


def test_printed_plastic_has_no_inserts_unless_they_are_asked_for() -> None:
    rows = "inserts_mass inserts_inertia link_insert_volume link_insert_length link_screw_hole link_hole_wall"
    plain = values_of(rows)
    assert inputs_with()["thread_insert"] == "none"
    assert [plain[name] for name in rows.split()] == pytest.approx([0.0, 0.0, 0.0, 0.0, 2.5 * MM, 1.2 * MM])


def test_an_insert_sets_the_hole_the_wall_and_the_thread_of_its_screw() -> None:
    rows = "link_screw_hole link_hole_wall link_thread_reserve link_screw_wall link_screw_wall_reserve link_screw_depth"
    values = values_of(rows, thread_insert="heat_set")
    assert values["link_screw_hole"] == pytest.approx(4.0 * MM)
    assert values["link_hole_wall"] == pytest.approx(1.6 * MM)
    # Screws of 12 mm through a link of 4 mm, inserts of 5.7 mm: 8 mm are in the core, and half a millimetre of room.
    assert values["link_thread_reserve"] == pytest.approx((8.0 - 5.7) * MM)
    assert values["link_screw_depth"] == pytest.approx(8.5 * MM)
    # A core of 10 mm with its screws at 0.65 of that.
    assert values["link_screw_wall"] == pytest.approx((10.0 - 6.5 - 2.0) * MM)
    assert values["link_screw_wall_reserve"] == pytest.approx((1.5 - 1.6) * MM)
    # A bore is measured from the screw: an M4 needs 8.1 mm, and the retainer's of 10 mm has 7.5.
    assert values_of("retainer_thread_reserve", thread_insert="heat_set")["retainer_thread_reserve"] < 0.0


def test_inserts_take_the_place_of_plastic_and_are_counted_once() -> None:
    module = {"cover": "plate", "preload_adjuster": "rotary", "radial_clearance": "1.7 mm"}
    rows = (
        "inserts_mass inserts_inertia parts_inertia rotor_inertia rotor_volume housing_volume adjuster_volume "
        "module_mass link_insert_volume housing_mass rotor_mass adjusters_mass"
    )
    bare, brass = values_of(rows, **module), values_of(rows, thread_insert="heat_set", **module)
    # Four M3 in the core and four in the posts, an M4 for the retainer, four M2 in the wall.
    assert brass["inserts_mass"] == pytest.approx((8 * 0.35 + 1.0 + 4 * 0.19) * 1e-3)
    assert brass["link_insert_volume"] == pytest.approx(4 * 0.25 * np.pi * (4.0**2 - 2.5**2) * 5.7e-9)
    radius = 6.5 * MM
    m3 = 4 * 0.35e-3 * (radius**2 + 0.5 * (2.0**2 + 1.25**2) * 1e-6)
    m4 = 1.0e-3 * 0.5 * (2.8**2 + 1.65**2) * 1e-6
    assert brass["inserts_inertia"] == pytest.approx(m3 + m4)
    holes = 0.25 * np.pi * (4 * (4.0**2 - 2.5**2) * 8.5 + (5.6**2 - 3.3**2) * 8.0) * 1e-9
    assert bare["rotor_volume"] - brass["rotor_volume"] == pytest.approx(holes)
    posts = 4 * 0.25 * np.pi * (4.0**2 - 2.5**2) * 9.3e-9  # screws of 10 mm through 1.2 mm of floor
    assert bare["adjuster_volume"] - brass["adjuster_volume"] == pytest.approx(posts)
    gained = sum(brass[name] - bare[name] for name in ("housing_mass", "rotor_mass", "adjusters_mass", "inserts_mass"))
    assert brass["module_mass"] - bare["module_mass"] == pytest.approx(gained)
    turning = brass["rotor_inertia"] - bare["rotor_inertia"] + brass["inserts_inertia"]
    assert brass["parts_inertia"] - bare["parts_inertia"] == pytest.approx(turning)


def test_a_screw_without_an_insert_on_the_shelf_cuts_its_thread() -> None:
    rows = "retainer_screw_hole retainer_insert_length retainer_insert_volume retainer_insert_misfit"
    values = values_of(rows, thread_insert="heat_set", retainer_screw="iso_7380_m5")
    assert [values[name] for name in rows.split()] == pytest.approx([4.2 * MM, 0.0, 0.0, 0.0])


def test_an_insert_with_another_thread_is_refused() -> None:
    right = values_of(" ".join(MISFITS), thread_insert="heat_set", cover="plate")
    assert max(right.values()) == 0.0
    wrong = values_of(" ".join(MISFITS), thread_insert="heat_set", link_insert="heat_set_m2")
    assert wrong["link_insert_misfit"] == pytest.approx(1.0 * MM)
    (rule,) = TABLE.output("link_insert_misfit").rules
    assert wrong["link_insert_misfit"] > rule.value


def test_inserts_are_melted_into_plastic_and_not_into_metal() -> None:
    (rule,) = TABLE.output("insert_ground").rules
    assert values_of("insert_ground", process="print_pc", thread_insert="heat_set")["insert_ground"] == rule.value
    milled = values_of("insert_ground", process="machine_6061", thread_insert="heat_set")
    assert milled["insert_ground"] < rule.value
    assert values_of("insert_ground", process="machine_6061")["insert_ground"] == rule.value
    # A joint that the module does not have has no inserts to hold either.
    bare = {"insert_ground", "link_insert_misfit", "retainer_insert_misfit"}
    for module, held in (
        ("thread_insert: none, cover: plate, preload_adjuster: rotary", set()),
        ("thread_insert: heat_set", bare),
        ("thread_insert: heat_set, cover: plate", bare | {"cover_insert_misfit"}),
        ("thread_insert: heat_set, cover: plate, preload_adjuster: rotary", set(RULES)),
    ):
        study = read_study_text(f"mode: shear\nmodule: {{{module}}}\n", "a test")
        assert {limit.output for limit in limits_of(study, TABLE)} & set(RULES) == held


def test_a_process_that_says_nothing_else_holds_no_rule_of_inserts() -> None:
    """Whether threads are in inserts is left to the process's record where a study does not say it."""
    study = read_study_text("mode: shear\n", "a test")
    chosen = given(study, Catalog(), TABLE)
    for word, held in (
        ("none", set()),
        ("heat_set", {"insert_ground", "link_insert_misfit", "retainer_insert_misfit"}),
    ):
        limits = limits_of(study, TABLE, chosen | {"thread_insert": word})
        assert {limit.output for limit in limits} & set(RULES) == held
    assert chosen["thread_insert"] == "none"


@pytest.mark.parametrize("mode", MODES)
def test_an_insert_that_is_not_asked_for_is_refused(mode: str) -> None:
    study = read_study_text(f"mode: {mode}\nmodule:\n  link_insert: heat_set_m3\n", "a test")
    with pytest.raises(InputError, match="add `thread_insert: heat_set` under `module`"):
        refuse_impossible(study, Catalog(), table_for(mode))
