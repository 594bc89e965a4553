"""Text files in every way they are written: encodings, separators, decimal signs, headings, and what is refused."""

import time
from pathlib import Path

import numpy as np
import pytest
from support import cases_of

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.reading.data_file import DataFile, read_data_file
from tvimdesign.simulation.measurement.reading.headings import column_map, read_column_map

PLAIN = "time [s];angle [deg]\n0;10\n0.5;-2.5\n1;1e1\n"


def read(place: Path, text: str | bytes, name: str = "data.csv", **mapped: object) -> DataFile:
    path = place / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_data_file(path, column_map(mapped, "the test") if mapped else None)


def degrees(file: DataFile) -> list[float]:
    return [round(float(angle), 9) for angle in np.degrees(file.blocks[0].values("angle"))]


@pytest.mark.parametrize(
    "encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "cp1252", "latin-1"]
)
@pytest.mark.parametrize("separator", ["\t", ";", ",", "|"])
def test_encoding_and_separator_change_nothing(tmp_path, encoding, separator):
    file = read(tmp_path, PLAIN.replace("[deg]", "[°]").replace(";", separator).encode(encoding))
    assert degrees(file) == [10.0, -2.5, 10.0]


@pytest.mark.parametrize("separator", ["\t", ";"])
def test_a_decimal_comma_is_read(tmp_path, separator):
    file = read(tmp_path, PLAIN.replace(".", ",").replace(";", separator))
    assert degrees(file) == [10.0, -2.5, 10.0]
    assert "decimal comma" in file.shown()[0]


def test_a_possible_thousands_separator_is_refused_until_it_is_stated(tmp_path):
    text = "time [s];angle [deg]\n1;1,234\n2;5,678\n3;9,012\n"
    with pytest.raises(InputError, match="'1,234' may be a decimal comma or a separator of thousands"):
        read(tmp_path, text)
    assert degrees(read(tmp_path, text, decimal="comma")) == [1.234, 5.678, 9.012]


def test_units_may_stand_in_a_row_of_their_own_or_after_a_slash(tmp_path):
    own = read(tmp_path, "Time\tAngle\tNote\ns\tmrad\t\n0\t1\ta\n1\t2\tb\n2\t3\tc\n")
    slash = read(tmp_path, "Time/ms;Angle/mrad\n0;1\n1000;2\n2000;3\n")
    for file in (own, slash):
        assert file.blocks[0].values("time") == pytest.approx([0.0, 1.0, 2.0])
        assert file.blocks[0].values("angle") == pytest.approx([1e-3, 2e-3, 3e-3])
    assert own.blocks[0].unused == ("Note",)


@cases_of("text_files", "short_names")
def test_the_unit_decides_what_a_short_name_stands_for(tmp_path, heading, quantity):
    (block,) = read(tmp_path, f"angle [deg];{heading}\n1;1\n2;2\n3;3\n").blocks
    assert set(block.columns) == {"angle", quantity}


@cases_of("text_files", "headings")
def test_headings_of_programs_are_read(tmp_path, heading, quantity, factor):
    (block,) = read(tmp_path, f"angle_deg;{heading}\n1;100\n2;200\n3;300\n").blocks
    assert set(block.columns) == {"angle", quantity}
    assert block.values(quantity) == pytest.approx(np.array([100.0, 200.0, 300.0]) * factor)


DSC = ["20.0 0.0 1.5", "21.0 6.0 1.6", "22.0 12.0 1.7"]


@cases_of("text_files", "calorimeters")
def test_layouts_of_calorimeters_are_read(tmp_path, head, separator):
    number = "{} " if head.startswith("Index") else ""
    rows = "\n".join((number.format(i) + row).replace(" ", separator) for i, row in enumerate(DSC))
    (block,) = read(tmp_path, f"{head}\n{rows}\n").blocks
    assert block.values("temperature") == pytest.approx([293.15, 294.15, 295.15])
    assert block.values("time") == pytest.approx([0.0, 6.0, 12.0])
    assert block.values("heat_flow") == pytest.approx([1.5e-3, 1.6e-3, 1.7e-3])


def test_every_table_of_a_file_is_a_block_with_its_lines(tmp_path):
    file = read(tmp_path, f"first run\n{PLAIN}\n\nsecond run\n{PLAIN}")
    assert [block.lines for block in file.blocks] == [(3, 5), (10, 12)]
    assert [block.title for block in file.blocks] == ["first run", "second run"]


def test_one_text_is_split_by_blanks(tmp_path):
    file = read(tmp_path, "time/s  angle/deg\n  0   1.0\n 1 2.0\n  2\t3.0\n")
    assert degrees(file) == [1.0, 2.0, 3.0]
    with pytest.raises(InputError, match=r"data.csv:2: 2 numbers under 4 headings; where blanks separate"):
        read(tmp_path, "time (s) angle (deg)\n  0   1.0\n 1 2.0\n  2 3.0\n")


@cases_of("text_files", "wrong_columns")
def test_a_wrong_column_stops_only_a_fit_that_needs_it(tmp_path, text, message):
    block = read(tmp_path, text).blocks[0]
    assert block.complete(["time"]) == 3
    with pytest.raises(InputError, match=message):
        block.complete(["time", "angle", "temperature", "torque"])


@cases_of("text_files", "wrong_files")
def test_a_file_that_does_not_go_together_is_refused_with_its_line(tmp_path, text, message):
    with pytest.raises(InputError, match=message):
        read(tmp_path, text)


def test_digits_without_end_take_no_longer_than_others(tmp_path):
    begin = time.process_time()
    file = read(tmp_path, f"{'9' * 20_000}x;y\n" * 3 + "time [s];angle [deg]\n0;1\n1;2\n2;3\n")
    assert degrees(file) == [1.0, 2.0, 3.0]
    assert time.process_time() - begin < 1.0


def test_a_column_map_says_what_a_file_does_not(tmp_path):
    rows, seconds = "0;1;7\n1;2;8\n2;3;9\n", {"column": 1, "unit": "s"}
    with pytest.raises(InputError, match=r"time: \{column: 1, unit: s\}"):
        read(tmp_path, rows)
    assert degrees(read(tmp_path, rows, time=seconds, angle={"column": 2, "unit": "deg"})) == [1.0, 2.0, 3.0]
    named = {"heading": "b", "unit": "deg"}
    assert degrees(read(tmp_path, f"a;b;c\n{rows}", time=seconds, angle=named)) == [1.0, 2.0, 3.0]
    path = tmp_path / "map.yaml"
    path.write_text("angle: {column: 3, unit: deg}\nseparator: semicolon\n")
    assert degrees(read_data_file(tmp_path / "data.csv", read_column_map(path))) == [7.0, 8.0, 9.0]


@pytest.mark.parametrize("gap", ["OPEN", "OL", "---", "#N/A", ""])
def test_a_gap_is_counted_and_drops_no_column(tmp_path, gap):
    data = read(tmp_path, f"time [s];angle [deg]\n0;1\n1;{gap}\n2;3\n3;4\n")
    assert data.blocks[0].complete(["time", "angle"]) == 3
    assert data.shown()[-1] == "    angle: 'angle [deg]' in °, 1 to 4, 1 gap"


@cases_of("text_files", "clock_times")
def test_clock_times_are_seconds_from_the_first_row(tmp_path, heading, cells, seconds):
    rows = "\n".join(f"{cell};{i}" for i, cell in enumerate(cells))
    (block,) = read(tmp_path, f"{heading};angle [deg]\n{rows}\n").blocks
    assert block.values("time") == pytest.approx(seconds, nan_ok=True)


def test_a_date_beside_its_time_of_day(tmp_path):
    text = "Date;Time;angle [deg]\n26.11.2026;23:59:58;1,5\n27.11.2026;00:00:03;2,5\n27.11.2026;00:00:13;4,0\n"
    (block,) = read(tmp_path, text).blocks
    assert block.values("time") == pytest.approx([0.0, 5.0, 15.0])


@cases_of("text_files", "wrong_clock_times")
def test_a_clock_time_that_is_none_is_refused(tmp_path, cells, message):
    rows = "\n".join(f"{cell};{i};{i}" for i, cell in enumerate(cells))
    (block,) = read(tmp_path, f"Time;angle [deg];torque [N.m]\n{rows}\n").blocks
    with pytest.raises(InputError, match=message):
        block.complete(["time"])


def test_of_two_columns_of_a_quantity_the_sample_s_counts(tmp_path):
    (block,) = read(tmp_path, "Furnace Temperature (°C);Sample Temperature (°C);t [s]\n9;1;0\n9;2;1\n9;3;2\n").blocks
    assert block.columns["temperature"].heading == "Sample Temperature (°C)"
    assert block.unused == ("Furnace Temperature (°C)",)


@cases_of("text_files", "wrong_column_maps")
def test_a_wrong_column_map_says_where(mapped, message):
    with pytest.raises(InputError, match=message):
        column_map(mapped, "map.yaml")
