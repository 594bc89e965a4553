"""A pair of small studies that can be compared: three variables each, one start, the same task."""

from pathlib import Path

from support import sample_text

from tvimdesign.study import read_study
from tvimdesign.study.conditions import Case

SHEAR, COMPRESSION = sample_text("compared_shear"), sample_text("compared_compression")
COARSE = SHEAR.replace("{starts: 1}", "{starts: 1, cells: 6, fineness: 0.67}")
"""The first on half the cells, for what does not hang on how exact its times are: half the work."""


def written(folder: Path, **texts: str) -> list[Path]:
    """Study files of these texts, named after the keywords."""
    paths = []
    for name, text in texts.items():
        paths.append(folder / f"{name}.yaml")
        paths[-1].write_text(text)
    return paths


def cases(folder: Path, *texts: str) -> list[Case]:
    """Studies of these texts as the comparison takes them."""
    paths = written(folder, **{f"study_{i}": text for i, text in enumerate(texts)})
    studies = [(path, read_study(path)) for path in paths]
    return [Case(path, study) for path, study in studies]
