"""The rooms whose rows all modes share; what differs between modes stands in a folder for each."""

from __future__ import annotations

from tvimdesign.device import (
    adjuster,
    bearing,
    bodies,
    cover,
    drive,
    drive_bodies,
    drive_gaps,
    flange,
    gaps,
    hold,
    housing_inertia,
    impedance,
    layout,
    materials,
    motor,
    process,
    screws,
    softening,
    springs,
    stiffening,
    thermal,
)

ROOMS = (materials, layout, springs, impedance, hold, thermal, softening, stiffening, bodies, gaps, process)
BOOKS = (
    materials.book,
    process.limits,
    *(room.book for room in ROOMS[1:]),
    *screws.books,
    *bearing.books,
    *adjuster.books,
    *cover.books,
    *flange.books,
    motor.book,
    drive.book,
    drive_bodies.book,
    *drive_gaps.books,
    housing_inertia.book,
)
