// The polymer coloured by its temperature at the moment of the cycle, through its depth.
import { BufferAttribute, Color, Vector3 } from "page/vendor/three.js";

const [SOLID, MELTING, LIQUID] = [new Color(0x1f5fb4), new Color(0xf2f2ee), new Color(0xc8321e)];

/** Colours the layer: call with the temperatures from the pads on, or with null for the colour of the part. */
export function layerColours(parts, mode, [start, end], hottest, coldest) {
  const layers = [...parts.values()].filter((part) => part.isLayer);
  const pads = [...parts.values()].filter(({ kind }) => kind === "heater" || kind === "spreader");
  const depths = new Map(layers.map((part) => [part, depthsOf(part, mode === "compression" ? pads : null)]));
  const own = new Map(layers.map((part) => [part, part.outside.color.clone()]));
  const colourOf = (temperature, colour) => {
    if (temperature < start) return colour.lerpColors(SOLID, MELTING, 0.75 * clamp((temperature - coldest) / (start - coldest)));
    if (temperature > end) return colour.lerpColors(MELTING, LIQUID, 0.25 + 0.75 * clamp((temperature - end) / (hottest - end)));
    return colour.copy(MELTING);
  };
  return (through) => {
    for (const part of layers) {
      part.outside.vertexColors = part.inside.vertexColors = through !== null;
      part.outside.color.copy(through ? new Color(1, 1, 1) : own.get(part));
      part.inside.color.copy(through ? new Color(0.85, 0.85, 0.85) : own.get(part).clone().multiplyScalar(0.55));
      part.outside.needsUpdate = part.inside.needsUpdate = true;
      if (through) paint(part.geometry, depths.get(part), through, colourOf);
    }
  };
}

const clamp = (share) => Math.min(Math.max(share, 0), 1);

/** Share of the layer's depth at each vertex: 0 at the pads. Upwards in shear, else away from the nearest pad. */
function depthsOf(part, pads) {
  const position = part.geometry.getAttribute("position");
  const points = Array.from({ length: position.count }, (_, i) => new Vector3().fromBufferAttribute(position, i).applyMatrix4(part.rest));
  const way = pads ? awayFrom(pads, middleOf(part)) : new Vector3(0, 0, 1);
  const along = points.map((point) => point.dot(way));
  const [low, high] = along.reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
  return along.map((value) => (value - low) / (high - low || 1));
}

/** Around the axis, from the nearest pad to a block. */
function awayFrom(pads, middle) {
  const nearest = pads.map(middleOf).sort((a, b) => a.distanceTo(middle) - b.distanceTo(middle))[0];
  const around = new Vector3(-middle.y, middle.x, 0).normalize();
  return around.dot(middle.clone().sub(nearest)) < 0 ? around.negate() : around;
}

function middleOf(part) {
  part.geometry.computeBoundingBox();
  return part.geometry.boundingBox.getCenter(new Vector3()).applyMatrix4(part.rest);
}

function paint(geometry, depths, through, colourOf) {
  const colours = new Float32Array(3 * depths.length);
  const colour = new Color();
  depths.forEach((depth, i) => {
    const at = depth * (through.length - 1);
    const low = Math.floor(at);
    const high = Math.min(low + 1, through.length - 1);
    colourOf(through[low] + (at - low) * (through[high] - through[low]), colour).toArray(colours, 3 * i);
  });
  geometry.setAttribute("color", new BufferAttribute(colours, 3));
}
