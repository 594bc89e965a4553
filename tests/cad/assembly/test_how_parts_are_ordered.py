"""The bill names standard parts as they are ordered: by standard, size, length and class."""

from cad_designs import design_of

from tvimdesign.base.record import Record
from tvimdesign.cad.jobs.main import _ordered_by, _titles
from tvimdesign.catalog.catalog import Catalog


def test_screws_and_pins_have_their_length_and_class() -> None:
    design = design_of("paper", {"link_screw_length": 16e-3, "link_dowel_length": 10e-3})
    titles = _titles(design)
    assert titles["link_screw"] == "Button head screw ISO 7380-1 - M3 x 16 - 10.9"
    assert titles["link_dowel"] == "Dowel pin ISO 8734 - 2.5 m6 x 10 - A, hardened steel"
    assert titles["peltier_module"] == Catalog().record("peltiers", str(design.choices["peltier_module"])).title


def test_a_record_that_says_nothing_of_orders_is_called_by_its_title() -> None:
    own = Record("screws", "own", "Screw from the drawer")
    assert _ordered_by(own, design_of("paper", {}), "link_screw") == "Screw from the drawer"


def test_every_screw_and_pin_of_the_catalogue_says_how_it_is_ordered() -> None:
    for category in ("screws", "dowel_pins"):
        for record in (Catalog().record(category, name) for name in Catalog().names(category)):
            assert record.words["designation"].count("{length}") == 1, record.name
            assert record.words["designation"].startswith(record.title.split(" ISO ")[0]), record.name
