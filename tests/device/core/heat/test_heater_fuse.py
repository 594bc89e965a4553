"""Which thermal cut-out a heater takes: the first of the maker's table that it does not open."""

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import ZERO_CELSIUS
from tvimdesign.catalog import Catalog
from tvimdesign.device.core.heat.heater_fuse import heater_fuse

RECORD = Catalog().record("thermal_fuses", "ultimheat_5ma3")


@pytest.mark.parametrize(
    ("hottest", "current", "designation", "opens", "holds"),
    [  # rows of the sheet, in degC: Tf and Th
        (84.0, 2.0, "5MA3SPF109019340", 113.0, 84.0),
        (84.1, 2.0, "5MA3SPF121019340", 122.0, 94.0),
        (105.0, 12.0, "5MA3SPF139H19340", 142.0, 114.0),
        (189.5, 10.0, "5MA3SPF227019340", 227.0, 190.0),  # of the two that hold 190 degC the one that opens first
    ],
)
def test_it_is_the_lowest_that_holds_the_heater(
    hottest: float, current: float, designation: str, opens: float, holds: float
) -> None:
    found = heater_fuse(RECORD, hottest + ZERO_CELSIUS, current)
    assert found.designation == designation
    assert (found.opens_at - ZERO_CELSIUS, found.holds - ZERO_CELSIUS) == pytest.approx((opens, holds))
    assert found.opens_at - found.opens_from == pytest.approx(10.0)


def test_what_no_type_holds_or_bears_is_named() -> None:
    with pytest.raises(InputError, match="no type holds the heater's 195 degC, the highest 190 degC"):
        heater_fuse(RECORD, 195.0 + ZERO_CELSIUS, 1.0)
    with pytest.raises(InputError, match=r"no type bears the heater's 20 A, the strongest 16 A"):
        heater_fuse(RECORD, 80.0 + ZERO_CELSIUS, 20.0)
