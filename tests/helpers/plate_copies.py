"""Copies of parts where a 3MF lays them on its bed."""

import io
import zipfile
from xml.etree import ElementTree as ET

import numpy as np
import trimesh

_SPACE = {"m": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}


def copies_on_a_plate(data: bytes) -> list[tuple[str, trimesh.Trimesh]]:
    """Return name and body of every copy."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        root = ET.fromstring(archive.read("3D/3dmodel.model"))
    objects = {thing.attrib["id"]: thing for thing in root.iterfind(".//m:object", _SPACE)}
    copies = []
    for item in root.iterfind(".//m:item", _SPACE):
        thing = objects[item.attrib["objectid"]]
        points = [[float(vertex.attrib[axis]) for axis in "xyz"] for vertex in thing.iterfind(".//m:vertex", _SPACE)]
        corners = [
            [int(face.attrib[key]) for key in ("v1", "v2", "v3")] for face in thing.iterfind(".//m:triangle", _SPACE)
        ]
        rows = np.array([float(number) for number in item.attrib["transform"].split()]).reshape(4, 3)
        moved = np.array(points) @ rows[:3] + rows[3]  # 3MF core specification, 3.3: row vectors
        copies.append((thing.attrib["name"], trimesh.Trimesh(moved, corners, process=False)))
    return copies
