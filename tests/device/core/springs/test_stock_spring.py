"""A torsion spring from stock is chosen whole: its numbers follow from the record, and nothing else may set them."""

import math

import pytest
from cad_designs import design_of, whole

from tvimdesign.base.errors import InputError
from tvimdesign.catalog.catalog import Catalog
from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.resolved_module import resolve_design
from tvimdesign.study import brought_along, given, read_study_text

RECORDS = Catalog().names("torsion_springs")


def study_of(more: str = "", record: str = "central_t10180") -> str:
    return f"tvimdesign: 1\nname: a\nmode: shear\nmodule:\n  stock_spring: {record}\n{more}"


def test_springs_from_stock_have_their_record_s_sizes_and_margins() -> None:
    values = given(read_study_text(study_of(record="central_t20180")))
    # Central Springs, T20180: wire 0.51, 6 outside, 3.25 coils, stainless.
    found = [1e3 * values[name] for name in ("wire_diameter", "coil_diameter")]
    assert found == pytest.approx([0.51, 5.49])
    assert values["coil_count"] == 3.25
    assert values["spring_material"].name == "stainless_302"
    own = given(read_study_text("tvimdesign: 1\nname: a\nmode: shear\n"))
    assert (own["stock_spring"], own["wire_diameter"]) == ("none", pytest.approx(2.413e-3))
    table = table_for("shear")
    values = given(
        read_study_text(study_of("  placement_radius: 16 mm\n  leg_overhang: 1.5 mm\n  pin_diameter: 1.5 mm\n"))
    )
    names = ["stock_leg_margin", "stock_tang_margin", "stock_torque_margin", "leg_length", "tang_length"]
    found = table.evaluate(values, [*names, "spring_rate", "spring_winding"])
    # T10180: legs of 20 mm, 18 N.mm at most.
    assert found["stock_leg_margin"] == pytest.approx(20e-3 - found["leg_length"])
    assert found["stock_tang_margin"] == pytest.approx(20e-3 - found["tang_length"] - 0.5 * math.pi * 2.0 * 0.51e-3)
    turned = found["spring_rate"] * found["spring_winding"]
    assert found["stock_torque_margin"] == pytest.approx(18e-3 - turned)
    none = given(read_study_text("tvimdesign: 1\nname: a\nmode: shear\n"))
    assert table.evaluate(none, ["stock_leg_margin"])["stock_leg_margin"] == 0.0


@pytest.mark.parametrize(
    "more",
    [
        "  wire_diameter: 1 mm\n",
        "  spring_material: music_wire\n",
        "vary:\n  coil_count: [3, 5]\nminimize: module_mass\n",
    ],
)
def test_what_the_record_brings_along_may_not_be_set_beside_it(more: str) -> None:
    with pytest.raises(InputError, match=r"torsion_springs/central_t10180.*leave .* out"):
        given(read_study_text(study_of(more)))


def test_every_record_s_torque_is_that_of_its_coils_and_legs() -> None:
    """The printed torque over its deflection against E d^4/(64 D n) by hand, with the modulus of thin wire."""
    for record in (Catalog().record("torsion_springs", name) for name in RECORDS):
        modulus = {"music_wire": 203.4e9, "stainless_302": 187e9}[record.word("spring_material")]
        wire, coil, count = (record.value(name) for name in ("wire_diameter", "coil_diameter", "coil_count"))
        by_bending = modulus * wire**4 / (64.0 * coil * count)
        ratio = record.value("largest_torque") / record.value("deflection") / by_bending
        assert 0.7 < ratio < 1.1, (record.name, ratio)
        assert record.value("outer_diameter") == pytest.approx(coil + wire)


def test_a_design_with_a_spring_from_stock_is_tested_as_it_is() -> None:
    small = {"placement_radius": 16e-3, "leg_overhang": 1.5e-3, "pin_diameter": 1.5e-3}
    design = whole(design_of("from stock", {"stock_spring": "central_t10180", **small}))
    assert resolve_design(design).values["spring_material"].name == "music_wire"
    assert brought_along(design.choices, table_for("shear")) >= {"spring_material", "wire_diameter", "coil_count"}
    assert brought_along({**design.choices, "stock_spring": "none"}, table_for("shear")) == set()
