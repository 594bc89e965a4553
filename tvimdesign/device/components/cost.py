"""Cost of what is bought and fitted in a module, and of its material, by the records' prices.

Each price has one place: the offers that the list of parts is ordered from, or the record. Both reach the table as
`heater_price` and the like, which a study may set to its own quote. A screw costs the same whatever its length. Pieces
are counted, not packs, so that the cost falls smoothly with the module.

Not counted: supply, driver and controller, which the study's voltage and current choose; wires, sensors, adhesive and
grease, bought by the pack; a motor's parts; and work. What has no price counts nothing, and `unpriced_count` counts it.
"""

import numpy as np

from tvimdesign.device.components.axial_preload import WITH_PRELOAD
from tvimdesign.device.components.bearing import BEARINGS, WITH_BEARINGS
from tvimdesign.device.components.cover import WITH_COVER
from tvimdesign.device.components.dowels import WITH_DOWELS, WITH_LEG_PINS
from tvimdesign.device.components.fastening import WITH_INSERTS
from tvimdesign.device.components.liner_and_adhesive import WITH_LINER
from tvimdesign.device.components.preload_adjuster import WITH_ADJUSTERS
from tvimdesign.device.core.heater_form import WITH_CUTOUT, WITH_TILES
from tvimdesign.device.table import Feature, Module, QuantityGroup, Scalar

GROUP = "Cost"
COSTS = ("cost", "material_cost")  # Outputs that prices go into
costs = QuantityGroup(GROUP)
JOINTS: dict[str, tuple[Feature, ...]] = {"link": (), "retainer": (), "adjuster": WITH_ADJUSTERS, "cover": WITH_COVER}
_FITTINGS = (
    *((f"{joint}_screw", f"{joint}_screw", needs) for joint, needs in JOINTS.items()),
    *((f"{joint}_insert", f"{joint}_insert", (*WITH_INSERTS, *needs)) for joint, needs in JOINTS.items()),
    ("link_dowel", "link_dowel", WITH_DOWELS),
    ("leg_pin", "leg_pin", WITH_LEG_PINS),
    ("bearing", "bearing", WITH_BEARINGS),
    ("preload_spring", "axial_preload", WITH_PRELOAD),
    ("spring", "stock_spring", ()),
    ("heater", "heater_module", ()),
    ("spreader", "spreader_material", WITH_TILES),
    ("thermal_cutout", "heater_fuse", WITH_CUTOUT),
)
"""Kinds bought by the piece, the choice of their record, and the features of a module that has them."""
_MATERIALS = (
    ("structure", "structure_material", ()), ("liner", "liner_material", WITH_LINER), ("pcl", "pcl_grade", ()),
)  # fmt: skip
"""Kinds paid by their mass, likewise."""
for _kinds, _unit in ((_FITTINGS, "USD"), (_MATERIALS, "USD/kg")):
    for _kind, _choice, _needs in _kinds:
        _about = f"Price of the {_kind.replace('_', ' ')}{' a piece' if _unit == 'USD' else ''}; 0 where none is known"
        costs.property(f"{_kind}_price", _unit, (_choice, "price"), _about, default=0.0, requires=_needs)


@costs.helper(sprung=True, default=())
def spring_pieces(m: Module) -> tuple[tuple[Scalar, Scalar], ...]:
    """Springs and what fixes their adjusters, with the price of one [USD]; none in a mode without springs."""
    return (
        (m.spring_count, m.spring_price),
        (m.adjuster_screw_count, m.adjuster_screw_price),
        (m.adjuster_screw_count * np.sign(m.adjuster_insert_length), m.adjuster_insert_price),
    )


@costs.helper()
def pieces_bought(m: Module) -> tuple[tuple[Scalar, Scalar], ...]:
    """Pieces of each kind that is bought by the piece, with the price of one [USD]."""
    link, retainer = m.link_screw_count, m.retainer_screw_count
    return (
        (link, m.link_screw_price),
        (link * np.sign(m.link_insert_length), m.link_insert_price),
        (retainer, m.retainer_screw_price),
        (retainer * np.sign(m.retainer_insert_length), m.retainer_insert_price),
        (m.cover_screw_count, m.cover_screw_price),
        (m.cover_screw_count * np.sign(m.cover_insert_length), m.cover_insert_price),
        (m.dowels_fitted, m.link_dowel_price),
        (m.leg_pins_fitted, m.leg_pin_price),
        (BEARINGS * np.sign(m.bearing_width), m.bearing_price),
        (np.sign(m.preload_height), m.preload_spring_price),
        *m.spring_pieces,
        (m.heater_count, m.heater_price),
        (m.pocket_count * np.sign(m.spreader_depth), m.spreader_price),
        (np.sign(m.cutout_diameter), m.thermal_cutout_price),
    )


@costs.output("USD")
def material_cost(m: Module) -> Scalar:
    """Cost of the material of what is made, by its mass in the module: structure, liners and PCL."""
    made = m.housing_mass + m.rotor_mass + m.link_mass + m.retainer_mass + m.cover_mass + m.base_mass
    made += m.adjuster_volume * m.structure_density
    return made * m.structure_price + m.liner_mass * m.liner_price + m.pcl_mass * m.pcl_price


@costs.output("USD")
def cost(m: Module) -> Scalar:
    """Cost of what is bought and fitted in the module and of its material, as far as it has a price."""
    return m.material_cost + sum(count * price for count, price in m.pieces_bought)


@costs.output("1")
def unpriced_count(m: Module) -> Scalar:
    """Parts without a price, which the cost leaves out: pieces, parts made of the structure, liners, and the PCL."""
    made = _MADE + m.adjuster_screw_count + np.fmin(m.cover_screw_count, 1.0) + np.sign(m.base_height)
    by_mass = made * (1.0 - np.sign(m.structure_price)) + 1.0 - np.sign(m.pcl_price)
    by_mass += m.pocket_count * np.sign(m.liner_depth) * (1.0 - np.sign(m.liner_price))
    return by_mass + sum(count * (1.0 - np.sign(price)) for count, price in m.pieces_bought)


_MADE = 4.0  # Housing, rotor, link and retainer
