"""Published devices: each has its quote and source, and what it gives can be read."""

import pytest
from atlas import COLUMNS, MARKS, PAGE, UNITS, devices, table

from tvimdesign.base.units import parse_quantity


@pytest.mark.parametrize("device", devices(), ids=lambda device: device["name"])
def test_device_has_quote_source_and_readable_quantities(device):
    assert all(device[name] for name in ("quote", "source", "read"))
    assert device["kind"] in MARKS
    assert set(device) - set(COLUMNS) <= {"name", "kind", "quote", "verbatim", "source", "read"}
    assert any(name in device for name in COLUMNS)
    for name, unit in UNITS.items():
        assert name not in device or parse_quantity(device[name], unit) > 0


def test_the_page_has_the_table_of_the_data():
    assert table() in PAGE.read_text(encoding="utf-8")
