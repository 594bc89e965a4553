"""The printed rotor stands on support where its print text says so: below the plate with its fillets, and its pins."""

from __future__ import annotations

import pytest
from cad_designs import BLOCKS, design_of

from tvimdesign.cad.assembly.assembly import drawn_part
from tvimdesign.cad.export.mesh import solid_mesh
from tvimdesign.cad.geometry.dimensions import dimensions
from tvimdesign.cad.geometry.kinds import PRODUCTION, supported_levels
from tvimdesign.cad.inspection.printing import printing_checks


@pytest.mark.parametrize(("mode", "changes"), [("shear", {}), ("compression", BLOCKS)])
def test_its_overhangs_are_those_that_the_print_text_tells(mode: str, changes: dict[str, float]) -> None:
    dims = dimensions(design_of("printed", changes, mode))
    mesh, levels = solid_mesh(drawn_part(dims, "rotor")), supported_levels("rotor", dims)
    bed = (dims.bed_length, dims.bed_width, dims.bed_height)

    def warned(supported: tuple[tuple[float, float], ...]) -> bool:
        checks = printing_checks("rotor", mesh, "top", dims.overhang_angle, dims.bridge_span, bed, supported)
        return next(check for check in checks if check.name == "rotor: overhang").warned

    assert not warned(levels)
    # Without either of the two it is a fault: the plate with its fillets, and the ends of the pins.
    assert warned(levels[:1])
    assert warned(levels[1:])
    assert warned(((dims.rotor_top_level, dims.rotor_top_level), levels[1]))
    said = PRODUCTION["rotor"].why
    assert "under the pins" in said
    assert "supports from the bed" in said
