"""Layouts of instruments' files, as the makers' software exports them.

The texts were written for these tests, after files in public repositories: RheoCompass, TRIOS and rSpace in
github.com/bsaintmichel/read-rheol, LIMS in github.com/3mcloud/hermes-rheo, .tts and .osc in
github.com/jorge-ramirez-upm/RepTate. `benchmarks/read_public.py` reads the files themselves.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from measured_files import workbook
from support import cases_of

from tvimdesign.base.errors import InputError
from tvimdesign.simulation.measurement.reading.data_file import Block, read_data_file

SWEEP = [(100.0, 2.0e4, 1.5e4), (10.0, 5.0e3, 9.0e3), (1.0, 4.0e2, 1.6e3)]


def blocks(place: Path, name: str, data: str | bytes) -> tuple[Block, ...]:
    path = place / name
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    return read_data_file(path).blocks


def is_the_sweep(block: Block, frequency: str = "angular_frequency", factor: float = 1.0) -> None:
    columns = [block.values(name) for name in (frequency, "storage_modulus", "loss_modulus")]
    assert np.column_stack(columns) == pytest.approx(np.array(SWEEP) * [factor, 1.0, 1.0])


def rheocompass(names: tuple[str, str, str, str]) -> bytes:
    interval, storage, loss, temperature = names
    lines = ["Projet:\tPCL", "", "Test:\tx", ""]
    for degrees in ("60,00", "80,00"):
        lines += [
            f"{interval} et points:\t1\t4",
            f"{interval} data:\tPoint No.\tFréquence\t{storage}\t{loss}\t{temperature}\tEtat",
            "\t\t\t\t\t\t",
            "\t\t[Hz]\t[Pa]\t[kPa]\t[°C]\t",
            "\t1  (invalide)\t\t\t\t\t",
        ]
        for i, (x, storage_, loss_) in enumerate(SWEEP, start=2):
            cells = f"\t{i}\t{x:.1f}\t{storage_:.3E}\t{loss_ / 1e3:.2f}\t{degrees}\tDy_auto"
            lines += [cells.replace(".", ","), *(["\t3  (invalide)\t\t\t\t\t"] if i == 2 else [])]
        lines += ["", ""]
    return "\r\n".join(lines).encode("utf-16")


@cases_of("instrument_files", "rheocompass")
def test_rheocompass_in_three_languages(tmp_path, names):
    tables = blocks(tmp_path, "sweep.csv", rheocompass(names))
    assert [round(float(block.values("temperature")[0] - 273.15), 9) for block in tables] == [60.0, 80.0]
    for block in tables:
        is_the_sweep(block, "frequency")
        assert len(block.skipped) == 1


def test_trios_text_with_steps_and_units_of_its_own(tmp_path):
    rows = "\n".join(f"{x}\t{a / 1e6}\t{b / 1e6}\t3.1\t\t80" for x, a, b in SWEEP)
    text = (
        "Filename\tpcl\nInstrument name\tHR\n[File Parameters]\nGap\t1000 µm\nStress constant\t79577.5 Pa/N.m\n[step]\n"
        "Frequency sweep - 1\n"
        "Angular frequency\tStorage modulus\tLoss modulus\tOscillation torque\tTan(delta)\tTemperature\n"
        f"rad/s\tMPa\tMPa\tg.cm\t\t°C\n{rows}\n\n[step]\nAnother - 2\nTime\tStress\ns\tPa\n0\t1\n1\t2\n2\t3\n"
    )
    first, second = blocks(tmp_path, "trios.txt", text)
    is_the_sweep(first)
    assert first.title == "Frequency sweep - 1"
    assert second.values("stress") == pytest.approx([1.0, 2.0, 3.0])


def test_trios_lims_export_with_labels_before_its_rows(tmp_path):
    rows = "\n".join(f"Data point\t{x}\t{a}\t{b}" for x, a, b in SWEEP)
    text = (
        "Windows setup INFormation\n[Step]\nStep name\tFrequency sweep (80.0 °C)\nNumber of points\t3\n"
        f"Variables\tAngular frequency\tStorage modulus\tLoss modulus\nUnits\trad/s\tPa\tPa\n{rows}\n"
    )
    (block,) = blocks(tmp_path, "lims.txt", text)
    is_the_sweep(block)
    assert block.title == "Frequency sweep (80.0 °C)"


def test_trios_json(tmp_path):
    names = {"Angular frequency": "rad/s", "Storage modulus": "Pa", "Loss modulus": "Pa", "Step": ""}
    columns = [{"name": name, "unit": unit} for name, unit in names.items()]
    data = {"columns": columns, "values": [[*row, 1] for row in SWEEP]}
    tree = {"Experiment": {"Results": [{"Properties": {"Name": "Sweep"}, "DataSet": [{"Data": data}]}]}}
    (block,) = blocks(tmp_path, "trios.json", json.dumps(tree))
    is_the_sweep(block)


def test_malvern_by_the_names_of_its_actions(tmp_path):
    head = (
        "Action Name;Time (action)(s);Frequency(Hz);Shear modulus (elastic component)(Pa);"
        "Shear modulus (viscous component)(Pa);Temperature(°C)"
    )
    rows = [f"Frequency Table;1,5;{x};{a};{b};80,00" for x, a, b in SWEEP]
    shear = [f"Pre Shear;{i},5;;;;80,00" for i in range(3)]
    first, second = blocks(tmp_path, "malvern.csv", "\n".join([head, *shear, *rows]).replace(".", ","))
    assert (first.title, second.title) == ("Pre Shear", "Frequency Table")
    is_the_sweep(second, "frequency")


def test_netzsch_with_its_header_and_decimal_comma(tmp_path):
    text = (
        "#EXPORTTYPE:DATA ALL\n#SAMPLE MASS /mg:4,98\n#EXO:-1\n##Temp./°C;Time/min;DSC/(mW/mg);Sensit./(uV/mW)\n"
        " 9,33910; 91,0;-8,719357e-02;3,42\n 9,23910; 91,1;-8,7e-02;3,42\n 9,13910; 91,2;-8,6e-02;3,42\n"
    )
    (block,) = blocks(tmp_path, "netzsch.csv", text)
    assert block.values("temperature")[0] == pytest.approx(273.15 + 9.3391)
    assert block.values("time")[1] == pytest.approx(91.1 * 60.0)
    assert block.values("specific_heat_flow")[0] == pytest.approx(-87.19357)
    assert block.number("sample_mass") == pytest.approx(4.98e-6)


def test_netzsch_of_an_sta_padded_with_a_blank_line_under_its_headings(tmp_path):
    text = (
        "#EXPORTTYPE: ;DATA ALL ;;;\n#DECIMAL:    ;COMMA    ;;;\n#SEPARATOR:  ;SEMICOLON;;;\n"
        "#SAMPLE MASS /mg: ;22,160;;;\n"
        "#RANGE: ;30,0°C/5,0(K/min)/1520,0°C;;;\n##Temp./°C;Time/min;DSC/(mW/mg);Mass/%;Segment\n\n"
        "29,958;0;7,67E-02;99,99772;1\n30,458;0,1;7,70E-02;99,99770;1\n30,958;0,2;7,75E-02;99,99771;1\n"
    )
    (block,) = blocks(tmp_path, "sta.csv", text.encode("latin-1"))
    assert block.lines == (8, 10)
    assert block.values("temperature") - 273.15 == pytest.approx([29.958, 30.458, 30.958])
    assert block.values("specific_heat_flow") == pytest.approx([76.7, 77.0, 77.5])
    assert block.number("sample_mass") == pytest.approx(22.16e-6)


def test_numbers_after_a_blank_line_take_no_sentence_for_headings(tmp_path):
    with pytest.raises(InputError, match=r"x.csv:3: numbers without a row of headings above them"):
        blocks(tmp_path, "x.csv", "measured on;a rainy day\n\n1;2\n2;3\n")


@pytest.mark.parametrize(
    "head",
    ["T=80;Mw=80;chem=PCL;\n", "T=80;\n#\n#\n", "T=80;\n# Frequency\tG'\tG\" some star, 80C\t\t\n",
     "T=80;\nFreq\tG'\tG\"\nrad/s\tPa\tPa\n"],
)  # fmt: skip
@pytest.mark.parametrize("ending", [".tts", ".osc"])
def test_reptate_with_and_without_headings(tmp_path, head, ending):
    rows = "\n".join(f" {x:.8E} {a}\t{b}   0" for x, a, b in SWEEP).replace("E+0", "E+000")
    (block,) = blocks(tmp_path, f"melt{ending}", head + rows + "\n")
    is_the_sweep(block)
    assert block.number("temperature") == pytest.approx(353.15)


@pytest.mark.parametrize(("heading", "good"), [("Status", "Dy_auto"), ("Etat", ""), ("Quality", "no error")])
def test_rows_that_the_instrument_flags_are_left_out_and_counted(tmp_path, heading, good):
    rows = [f"{x};{a};{b};{good}" for x, a, b in SWEEP]
    flagged = ["1e-1;5;9e9;ME-", "1e-2;5;9e9;ME-, taD", "1e-3;5;9e9;MV-"]
    head = f"Angular frequency [rad/s];Storage modulus [Pa];Loss modulus [Pa];{heading}"
    (block,) = blocks(tmp_path, "sweep.csv", "\n".join([head, *rows, *flagged]))
    is_the_sweep(block)
    assert block.flagged == "3 of 6 rows are flagged by the instrument (ME- 1, ME-, taD 1, MV- 1)"
    assert block.shown()[-1] == f"    left out: {block.flagged}"
    (none,) = blocks(tmp_path, "none.csv", "\n".join([head, *flagged]))
    with pytest.raises(InputError, match=r"none\.csv:2: 3 of 3 rows are flagged by the instrument .*: no row is left"):
        none.complete(["loss_modulus"])


def test_a_workbook(tmp_path):
    cells = [["sample", "PCL"], [], ["ω (rad/s)", "G' (Pa)", "G'' (Pa)"], *SWEEP]
    (block,) = blocks(tmp_path, "sweep.xlsx", workbook(cells))
    is_the_sweep(block)
    assert block.lines == (4, 6)
