// The rotor turned through its stroke, and the springs that it winds.

/** Turns the rotor: `angle` is a share of the stroke, from -1 to 1. */
export function turner(parts, { stroke, wires }) {
  const springs = Object.entries(wires.moved).map(([kind, moved]) => {
    const first = [...parts.values()].find((part) => part.kind === kind);
    return first && spring(first.geometry, wires.ring, moved);
  }).filter(Boolean);
  const shares = [...wires.shares];
  return (share) => {
    for (const part of parts.values()) {
      part.angle = share * stroke;
      part.place();
    }
    for (const { geometry, rest, rings, moved } of springs) wind(geometry, rest, rings, blended(shares, moved, share));
  };
}

/** A spring's mesh at rest, and for each of its vertices the ring of the wire it is on. */
function spring(geometry, ring, moved) {
  const { array, count } = geometry.getAttribute("position");
  const length = moved[0].length / 3;
  const rings = Array.from({ length: count }, (_, i) =>
    i < length * ring ? Math.floor(i / ring) : i < (length + 1) * ring ? 0 : length - 1);
  return { geometry, rest: array.slice(), rings, moved };
}

/** How far each ring has moved at a share of the stroke: straight between the shares that are known, rest among them. */
function blended(shares, moved, share) {
  const known = [...shares.map((at, i) => [at, moved[i]]), [0, null]].sort((a, b) => a[0] - b[0]);
  const above = Math.max(known.findIndex(([at]) => at >= share), 1);
  const [[low, from], [high, to]] = [known[above - 1], known[above]];
  const part = (share - low) / (high - low);
  return (i) => (1 - part) * (from?.[i] ?? 0) + part * (to?.[i] ?? 0);
}

/** Move every vertex with its ring; meshes of the GLB are in millimetres of their own frame. */
function wind(geometry, rest, rings, moved) {
  const position = geometry.getAttribute("position");
  for (let i = 0; i < rings.length; i += 1) {
    for (let k = 0; k < 3; k += 1) position.array[3 * i + k] = rest[3 * i + k] + moved(3 * rings[i] + k);
  }
  position.needsUpdate = true;
}
