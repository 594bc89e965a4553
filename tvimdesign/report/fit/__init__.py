"""Fits of measured data told: screen, folder, figure, record; and what the doors to them need of the room below."""

from tvimdesign.simulation.measurement.measure_files import Measured, kind_sheets, measure_files
from tvimdesign.simulation.measurement.reading.headings import column_map, read_column_map
from tvimdesign.simulation.measurement.record_file import write_record

__all__ = ["Measured", "column_map", "kind_sheets", "measure_files", "read_column_map", "write_record"]
