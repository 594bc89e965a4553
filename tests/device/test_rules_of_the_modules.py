"""Limits that the modules bring along: what is left must be left, safeties are above one, and who says the others."""

import pytest

from tvimdesign.device import MODES, table_for

MM = 1e-3
OTHERS: dict[str, set[tuple[str, float]]] = {
    "spring_index": {(">=", 4.0), ("<=", 20.0)},  # EN 13906-3, cold coiled
    "stiffness_over_stroke": {(">=", 0.9), ("<=", 1.1)},  # linear to a tenth
    "wire_range_margin": {(">=", 1.0)},
    "pin_wear": {("<=", 0.1 * MM)}, "friction_share": {("<=", 0.5)},  # springs bring the joint halfway back
    "sorted_share": {(">=", 0.2)},  # four of five stay out
    "stiffening_over_freezing": {(">=", 1.0)},
    "hot_structure_share": {(">=", 0.5)},  # half as stiff as at 23 degC
    "insert_ground": {(">=", 1.0)},
    "block_strain": {("<=", 0.5)}, "layer_play": {("<=", 0.1)}, "melt_loss": {("<=", 0.01)},
    # Least widths of what is made and of what air or a tool passes, and of what is left beyond zero.
    "leg_overhang_margin": {(">=", 0.5 * MM)}, "leg_reach_gap": {(">=", 1.0 * MM)}, "arc_gap": {(">=", 3.0 * MM)},
    "arc_width": {(">=", 5.0 * MM)}, "window_width": {(">=", 2.0 * MM)}, "link_screw_gap": {(">=", 0.3 * MM)},
    "core_web": {(">=", 1.0 * MM)}, "block_breadth": {(">=", 3.0 * MM)}, "slot_opening": {(">=", 2.0 * MM)},
    "slot_reach": {(">=", 1.0 * MM)}, "keys_in_liner": {("<=", 0.5)}, "pad_seat": {(">=", 0.2 * MM)},
    "pad_ledge": {(">=", 0.2 * MM)},
}  # fmt: skip
LEFT = ("_margin", "_gap", "_reach", "_apart", "_inertia", "_depth", "_web", "_thickness")


def usual(name: str) -> set[tuple[str, float]]:
    """The limit that a quantity's name asks for."""
    if name.endswith("_safety"):
        return {(">=", 1.0)}
    if name.endswith("_misfit"):
        return {("<=", 0.01 * MM)}
    assert name.endswith(LEFT), f"{name} has a rule: say here which, and why"
    return {(">=", 0.0)}


@pytest.mark.parametrize("mode", MODES)
def test_every_rule_has_the_usual_sense_and_limit(mode: str) -> None:
    limited = [found for found in table_for(mode).outputs if found.rules or found.ratings or found.advice]
    assert len(limited) > 80
    for found in limited:
        limits = {(rule.sense, rule.value) for rule in (*found.rules, *found.ratings, *found.advice)}
        assert limits == (OTHERS.get(found.name) or usual(found.name)), found.name


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
