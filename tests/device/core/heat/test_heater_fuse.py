"""Which thermal cut-out a heater takes: one that stays closed in work and opens before anything is too hot."""

import pytest

from tvimdesign.base.errors import InputError
from tvimdesign.base.units import ZERO_CELSIUS
from tvimdesign.catalog import Catalog
from tvimdesign.device.core.heat.heater_fuse import HeaterFuse, heater_fuse

RECORD = Catalog().record("thermal_fuses", "ultimheat_5ma3")


def chosen(hottest: float, current: float, **bears: float) -> HeaterFuse:
    """For a heater in degC and A, with what each thing bears in degC."""
    ratings = {what: one + ZERO_CELSIUS for what, one in bears.items()}
    return heater_fuse(RECORD, hottest + ZERO_CELSIUS, current, ratings)


@pytest.mark.parametrize(
    ("hottest", "current", "bears", "designation", "opens", "holds", "above"),
    [  # rows of the sheet, in degC: Tf and Th
        (84.0, 2.0, {"heater": 120.0, "structure": 170.0}, "5MA3SPF109019340", 113.0, 84.0, ()),
        (95.4, 2.0, {"heater": 120.0, "structure": 113.0}, "5MA3SPF109019340", 113.0, 84.0, ()),
        (95.9, 2.5, {"heater": 120.0, "structure": 105.0}, "5MA3SPF109019340", 113.0, 84.0, ("structure",)),
        (83.1, 12.0, {"heater": 160.0, "structure": 122.0}, "5MA3SPF121H19340", 122.0, 94.0, ()),
        (107.0, 3.0, {"heater": 120.0, "structure": 110.0}, "5MA3SPF121019340", 122.0, 94.0, ("structure", "heater")),
        (98.1, 1.0, {"heater": 112.9}, "5MA3SPF121019340", 122.0, 94.0, ("heater",)),  # 113 - 10 < 98.1 + 5
    ],
)
def test_it_stays_closed_in_work_and_is_the_highest_that_opens_before_the_least_rating(
    hottest: float, current: float, bears: dict[str, float], designation: str, opens: float, holds: float,
    above: tuple[str, ...],
) -> None:  # fmt: skip
    found = chosen(hottest, current, **bears)
    assert found.designation == designation
    assert (found.opens_at - ZERO_CELSIUS, found.holds - ZERO_CELSIUS) == pytest.approx((opens, holds))
    assert found.opens_at - found.opens_from == pytest.approx(10.0)
    assert found.opens_from >= hottest + ZERO_CELSIUS + 5.0
    assert found.above == above


@pytest.mark.parametrize(
    ("hottest", "structure", "designation", "above"),
    [  # in degC; what opens at 104 may open from 94, by IEC 60691
        (89.0, 105.0, "G4A01104C", ()),
        (88.0, 103.0, "G4A01104C", ("structure",)),  # what opens at 98 may open from 88
        (83.0, 103.0, "G4A01098C", ()),
        (89.1, 105.0, "G4A01216C", ("structure",)),
    ],
)
def test_a_second_makers_table_has_a_type_between_a_working_heater_and_polycarbonate(
    hottest: float, structure: float, designation: str, above: tuple[str, ...]
) -> None:
    record = Catalog().record("thermal_fuses", "microtemp_g4a")
    found = heater_fuse(record, hottest + ZERO_CELSIUS, 2.5, {"structure": structure + ZERO_CELSIUS})
    assert (found.designation, found.above) == (designation, above)
    with pytest.raises(InputError, match=r"no type bears the heater's 10\.1 A, the strongest 10 A"):
        heater_fuse(record, 330.0, 10.1, {"structure": 400.0})


def test_what_no_type_holds_or_bears_is_named() -> None:
    with pytest.raises(InputError, match="no type stays closed at the heater's 230 degC, the highest at 225 degC"):
        chosen(230.0, 1.0, heater=250.0)
    with pytest.raises(InputError, match=r"no type bears the heater's 20 A, the strongest 16 A"):
        chosen(80.0, 20.0, heater=120.0)
