"""The catalogue: materials, wires and Peltier modules as records, every value with unit, source and status."""

from tvimdesign.catalog.catalog import Catalog
from tvimdesign.catalog.category import CATEGORIES

__all__ = ["CATEGORIES", "Catalog"]
