"""The process that drafts, `python -m tvimdesign.explore.draft_worker`: numbers in, meshes out, as lines of JSON."""

import base64
import json
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from tvimdesign.base.child_process import follow_parent, line_writer
from tvimdesign.base.errors import TvimError
from tvimdesign.cad.assembly.draft_module import Draft, DraftMesh, draft_module
from tvimdesign.cad.geometry.dimensions import dimensions_of
from tvimdesign.cad.geometry.kinds import KINDS, TURNING, kind_of

_DIGITS = 4  # Of millimetres


def main() -> None:
    """Answer jobs until there are no more."""
    follow_parent()
    write = line_writer()
    for line in sys.stdin:
        job = json.loads(line)
        write({"number": job["number"], **drafted(job)})


def drafted(job: Mapping[str, Any]) -> dict[str, Any]:
    """Parts and meshes of a job's module, or in words why there are none."""
    values = {name: float("inf") if value is None else value for name, value in job["values"].items()}
    try:
        draft = draft_module(dimensions_of(job["mode"], values, job["choices"]))
    except TvimError as error:
        return {"words": str(error)}
    return {"parts": _parts(draft), "meshes": {kind: _packed(mesh) for kind, mesh in draft.meshes.items()}}


def _parts(draft: Draft) -> list[dict[str, Any]]:
    """Return the viewer's data of each part; matrices row by row."""
    kinds = {name: kind_of(name) for name in draft.places}
    return [
        {
            "name": name, "kind": kinds[name], "colour": KINDS[kinds[name]].colour, "turns": kinds[name] in TURNING,
            "lift": round(draft.lifts[name], _DIGITS), "matrix": [round(float(number), 9) for number in matrix.ravel()],
        }
        for name, matrix in draft.places.items()
    ]  # fmt: skip


def _packed(mesh: DraftMesh) -> dict[str, str]:
    """Numbers as the page's typed arrays have them, in base64."""
    arrays: dict[str, tuple[Any, DTypeLike]] = {
        "points": (mesh.points, "<f4"),
        "normals": (np.round(127.0 * np.nan_to_num(mesh.normals)), "<i1"),
        "triangles": (mesh.triangles, "<u4"),
        "edges": (mesh.edges, "<f4"),
    }
    return {
        name: base64.b64encode(np.ascontiguousarray(array, kind).tobytes()).decode()
        for name, (array, kind) in arrays.items()
    }


if __name__ == "__main__":
    main()
