"""Limits that the modules bring along, headlines, and what a search may choose."""

import pytest

from tvimdesign.device import MODES, table_for


@pytest.mark.parametrize("mode", MODES)
def test_rules_and_headlines_are_those_of_the_table(mode: str) -> None:
    for found in table_for(mode).outputs:
        for rule in found.rules:
            if rule.exists_above is not None:
                assert rule.sense == ">=", found.name
                # A coil of a little more than its wire is one, all else begins at nothing.
                assert rule.exists_above == (1.2 if found.name == "spring_index" else 0.0), found.name
                assert rule.exists_above <= rule.value, found.name
    headlines = {found.name for found in table_for(mode).outputs if found.headline}
    assert {"envelope_diameter", "module_mass", "joint_stiffness", "holding_torque", "response_time"} <= headlines
    # A tenth of the table at most: no gap, and nothing that is one of several screwed joints' alike.
    assert len(headlines) < 0.1 * len(table_for(mode).outputs)
    for found in table_for(mode).outputs:
        assert not (found.headline and (found.group == "Gaps" or found.hidden or "screw" in found.name)), found.name
    numbers = {found.name: found for found in table_for(mode).inputs}
    free = {name for name, found in numbers.items() if found.variable}
    assert {"wire_diameter", "coil_diameter", "coil_count", "placement_radius", "preload_angle"} <= free
    # A property of a material or of what is bought, the air, or what the user asks for is nobody's to choose.
    of_records = {name for name, found in numbers.items() if found.record is not None and not found.falls_back}
    assert not free & of_records
    assert not free & {"stroke", "ambient_temperature", "temperature", "frequency", "pcl_density", "target_temperature"}
