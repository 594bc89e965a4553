"""Makes the small pictures of the studies in docs/pictures/studies from the previews that runs have left."""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
_VIEWS = 0.845
"""Share of a preview's height that its two views take; the legend is below."""
_WIDTH = 460
_COLOURS = 48


def small(preview: Path, picture: Path) -> None:
    """Write the two views of a preview, small and with few colours: some 25 kB."""
    with Image.open(preview) as whole:
        views = whole.convert("RGB").crop((0, 0, whole.width, round(_VIEWS * whole.height)))
    drawn = Image.eval(views.convert("L"), lambda level: 255 if level < 250 else 0).getbbox()
    if drawn is None:
        raise ValueError(f"{preview}: nothing is drawn in it")
    views = views.crop((0, drawn[1], views.width, drawn[3]))
    shrunk = views.resize((_WIDTH, round(_WIDTH * views.height / views.width)), Image.Resampling.LANCZOS)
    picture.parent.mkdir(parents=True, exist_ok=True)
    shrunk.quantize(_COLOURS, dither=Image.Dither.NONE).save(picture, optimize=True)


def main() -> None:
    """Make the pictures of all studies from a folder of runs; says which study has no preview there."""
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
