"""Where results go that nobody gave a folder for."""

from __future__ import annotations

from pathlib import Path


def default_folder(source: Path) -> Path:
    """results/<study>; for a design a folder of its own beside the run's, with -cad after the design's name."""
    if source.suffix != ".json":
        return Path("results") / source.stem
    folder = source.resolve().parent
    beside = folder.parent.parent if folder.name == "front" and source.name != "design.json" else folder.parent
    return beside / f"{name_of(source)}-cad"


def name_of(source: Path) -> str:
    """What folders of a study or a design are named by: <run>, or <run>-front-03 of one of several in a folder."""
    if source.suffix != ".json":
        return source.resolve().name if source.is_dir() else source.stem
    folder, own = source.resolve().parent, source.name.removesuffix(".json").removesuffix(".design")
    if own == "design":
        return folder.name
    return f"{folder.parent.name}-front-{own}" if folder.name == "front" else f"{folder.name}-{own}"
