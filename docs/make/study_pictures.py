"""Small pictures of the studies in docs/pictures/studies, made from previews of runs."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
_BLANK = 6
"""Blank rows that separate the views from the legend."""
_WIDTH = 460
_COLOURS = 48


def small(preview: Path, picture: Path) -> None:
    """Write the two views of a preview, small and with few colours: some 25 kB."""
    with Image.open(preview) as opened:
        whole = opened.convert("RGB")
    first, last = views_between(np.asarray(whole.convert("L")))
    views = whole.crop((0, first, whole.width, last))
    shrunk = views.resize((_WIDTH, round(_WIDTH * views.height / views.width)), Image.Resampling.LANCZOS)
    picture.parent.mkdir(parents=True, exist_ok=True)
    shrunk.quantize(_COLOURS, dither=Image.Dither.NONE).save(picture, optimize=True)


def views_between(grey: NDArray[np.uint8]) -> tuple[int, int]:
    """Return the rows between which the two views are: from the first drawn one to several blank ones.

    Raise ValueError if nothing is drawn.
    """
    drawn = (grey < 250).any(axis=1)
    if not drawn.any():
        raise ValueError("nothing is drawn in the preview")
    first = int(np.argmax(drawn))
    blank = [not drawn[row : row + _BLANK].any() for row in range(first, len(drawn))]
    return first, first + int(np.argmax(blank)) if any(blank) else len(drawn)


def main() -> None:
    """Make the pictures of all studies from a folder of runs; name studies without a preview."""
    runs = Path(sys.argv[1]) if sys.argv[1:] else ROOT / "results"
    without = []
    for study in sorted((ROOT / "studies").glob("*.yaml")):
        preview = runs / study.stem / "cad/preview.png"
        if preview.exists():
            small(preview, ROOT / f"docs/pictures/studies/{study.stem}.png")
        else:
            without.append(study.stem)
    if without:
        sys.exit(f"no preview in {runs} of {', '.join(without)}: tvimdesign run studies/NAME.yaml makes one")


if __name__ == "__main__":
    main()
