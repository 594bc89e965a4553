"""The compression module: what blocks between vanes add to the quantities that all modes share.

The drawing in words. Housing, floor, hub, springs on posts, core, rotor plate, link and retainer are those of the shear
module; so are axes, origin and signs. Between the radii `pcl_inner_radius` and `pcl_outer_radius`, above the floor and
below the rotor plate, lies the chamber. It is `block_height` high, and a `running_clearance` more at either end, so
that no block and no vane rubs; the hub, as high, carries the plate.

Seen from above, the chamber is divided by radial lines into annular sectors. Counter-clockwise stand in turn a housing
vane, a block, a rotor vane, a block, `vane_count` times around: 2 N blocks, N against either sense of
rotation. Angles are lengths at the mean radius over the mean radius: `block_depth` and `vane_thickness` (of the rotor
vanes) are given, the housing vanes take what is left of the circle. A sector's stroke and its depth both grow with the
radius, so a block is strained alike from its inner to its outer end and K = n E A r^2/L is exact with the mean radius.

- A rotor vane hangs from the plate to a running clearance above the floor.
- A housing vane stands on the floor and reaches to a running clearance below the plate. A flat heater, of block
  width by block height, is let into each of its two faces flush with it, from a running clearance above the floor to
  the vane's top: hot side to the block, cold side to the inside of the vane.
- Between its two pads the vane has a slot, open to the air below through the floor: `slot_share` of the block's width,
  in the middle of it; the slot ends a `window_ledge` below the vane's top. The pads bear on what is left of the vane.
  Beside the pads the slot's corners open into their pockets; below them the slot is wider by its rounded corners, so
  that a cutter of their `corner_radius` comes by, and the pads stand on the `pad_seat` that is left. With a negative
  `slot_corner_offset` it is wider by less: of its corners a part stays beside the pads, up to edges of 60 degrees.
- Rigid modules stand in the same pockets, made deeper by a spreader before them: `vane_tiles` has their drawing in
  words.
- Rotor vanes hang at azimuths 0, 360/N, ... degrees, housing vanes stand half a pitch further.

The blocks touch both faces at rest and are bonded to at most one of them. They do not slip there while pressed. They
have no keys, as the arcs of the shear module have: the face a block may be bonded to is its pad, which is bought and
covers the vane, and a block that is keyed to the rotor's vane would pull as well as push.

Turned by an angle, the solids stand like this: each block stays on its pad. The one ahead of a rotor vane is drawn as
the sector that the vane leaves of it, so block and vane touch in one radial face; the one behind keeps its shape, and
between it and the vane is air. A squeezed block bulges at its free sides, which is not drawn: it has the
running clearances, the gap to the hub, and outside all the room up to the springs, which `squeezed_block_gap` tells.

It goes together from above: pads into their pockets, which are open upwards, the wires down through the slots; blocks
beside them; then the rotor, whose vanes come down between the blocks. So no part reaches over another in the chamber.
"""
