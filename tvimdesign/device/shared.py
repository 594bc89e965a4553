"""The rooms whose rows all modes share; what differs between modes stands in a folder for each."""

from __future__ import annotations

from tvimdesign.device import bodies, gaps, hold, impedance, layout, materials, softening, springs, stiffening, thermal

ROOMS = (materials, layout, springs, impedance, hold, thermal, softening, stiffening, bodies, gaps)
BOOKS = tuple(room.book for room in ROOMS)
