// Controls that show the inside: parts lifted from one another, and a plane that cuts them.
import { Plane, Vector3 } from "page/vendor/three.js";
import { choice, slider } from "page/dom.js";

/** The parts lifted from one another. */
export function explode(parts, changed, stage) {
  return slider("Apart", {}, (share) => {
    const lowest = Math.min(...[...parts.values()].map(({ lift }) => lift));
    for (const part of parts.values()) part.lifted = share * (part.lift - lowest);
    changed();
    stage.look();
  }).row;
}

/** A plane that cuts everything across an axis. */
export function cut(parts, stage) {
  const box = stage.bounds();
  const plane = new Plane(new Vector3(0, 1, 0), 0);
  const place = () => {
    const axis = which.select.value;
    where.input.disabled = axis === "none";
    if (axis !== "none") {
      const [low, high] = [box.min[axis], box.max[axis]];
      plane.normal.set(0, 0, 0)[axis] = axis === "z" ? -1 : 1;
      const at = low + Number(where.input.value) * (high - low);
      plane.constant = axis === "z" ? at : -at;
    }
    for (const part of parts.values()) part.cut(axis === "none" ? [] : [plane]);
    stage.renew();
  };
  const which = choice("Cut", { none: "not cut", y: "upright, front", x: "upright, side", z: "level" }, place);
  const where = slider("Cut at", { value: 0.5 }, place);
  where.input.disabled = true;
  return [which.row, where.row];
}
