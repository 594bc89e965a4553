"""The module as functions: what is wanted again is not written again."""

from typing import Any

import pytest

from tvimdesign.device import table_for
from tvimdesign.simulation.working_cycle.device_functions import DeviceFunctions
from tvimdesign.study import given, read_study_text


def test_outputs_that_are_wanted_again_are_not_built_again(monkeypatch: pytest.MonkeyPatch) -> None:
    built, outputs = [], DeviceFunctions.outputs

    def counted(model: DeviceFunctions, wanted: Any, *more: Any) -> Any:
        built.append(tuple(wanted))
        return outputs(model, wanted, *more)

    monkeypatch.setattr(DeviceFunctions, "outputs", counted)
    values = given(read_study_text("mode: shear\n", "a test"))
    model = DeviceFunctions(table_for("shear"), values, ("cold", "hot"), 6)
    never = dict.fromkeys(model.switch_names, float("nan"))
    first = model.some_values(["module_mass", "envelope_height"], model.start, never)
    heavier = model.start.copy()
    heavier[model.index["pcl_thickness"]] *= 2.0
    second = model.some_values(["module_mass", "envelope_height"], heavier, never)
    assert second["module_mass"] > first["module_mass"]
    assert set(model.some_values(["envelope_height"], model.start, never)) == {"envelope_height"}
    assert built == [("module_mass", "envelope_height"), ("envelope_height",)]
