"""The catalogue: materials, wires and Peltier modules as records, every value with unit, source and status."""

from tvimdesign.catalog.catalog import Catalog, check_records
from tvimdesign.catalog.categories import SHELVES
from tvimdesign.catalog.record import Entry, Record, Sheet

__all__ = ["SHELVES", "Catalog", "Entry", "Record", "Sheet", "check_records"]
