// The module in 3-D while it is dragged: drafts that follow the hand, shown from where one looks.
import { BufferAttribute, BufferGeometry, Color, Matrix4 } from "page/vendor/three.js";
import { choice, make } from "page/dom.js";
import { cut, explode } from "page/solids/apart.js";
import { Part } from "page/solids/parts.js";
import { Stage, VIEWS } from "page/solids/stage.js";
import { partsTree } from "page/solids/tree.js";

const SAYS = "The module as it is drafted now.";

/** @typedef {{ geometry: BufferGeometry, edges: BufferGeometry }} Shape */

/** Show drafts in a place; one that has the same parts moves those that are there. */
export function draftOf(place) {
  const words = make("p", { className: "told", role: "status" });
  /** @type {{ names: string, parts: Map<string, Part>, renew: () => void, shapes: Map<string, Shape> } | null} */
  let shown = null;
  return {
    show(message) {
      words.textContent = message.words ? `${shown ? "The drawing is the last module that could be drawn. " : ""}No draft: ${message.words}` : "";
      place.classList.toggle("stale", Boolean(message.words));
      if (message.words) {
        if (!shown) place.replaceChildren(words);
        return;
      }
      const shapes = new Map(Object.entries(message.meshes).map(([kind, mesh]) => [kind, shapeOf(mesh)]));
      const names = message.parts.map(({ name }) => name).join();
      const of = (part) => ({ .../** @type {Shape} */ (shapes.get(part.kind)), rest: new Matrix4().fromArray(part.matrix).transpose(), colour: new Color().setRGB(part.colour[0], part.colour[1], part.colour[2], "srgb") });
      const before = shown;
      if (before && before.names === names) {
        for (const part of message.parts) before.parts.get(part.name)?.reshape(of(part), part.lift);
        before.renew();
        shown = { ...before, shapes };
      } else {
        const parts = new Map(message.parts.map((part) => [part.name, new Part(of(part), part)]));
        shown = { names, parts, renew: build(place, parts, words), shapes };
      }
      for (const old of before?.shapes.values() ?? []) {
        old.geometry.dispose();
        old.edges.dispose();
      }
      place.dataset.draft = message.number;
    },
  };
}

/** A new stage with its controls; returns what draws the parts again after they have moved. */
function build(place, parts, words) {
  const scene = make("div", { className: "stage" });
  const stage = new Stage(scene, SAYS);
  for (const part of parts.values()) stage.scene.add(part.object);
  const changed = () => {
    for (const part of parts.values()) part.place();
    stage.renew();
  };
  const apart = explode(parts, changed, stage);
  const controls = make("div", { className: "controls", role: "group", "aria-label": "The draft" },
    choice("View", Object.fromEntries(Object.keys(VIEWS).map((name) => [name, name])), (view) => stage.look(view)).row,
    apart, ...cut(parts, stage));
  const side = make("details", {}, make("summary", {}, "Parts shown"), partsTree(parts, changed));
  place.replaceChildren(controls, scene, words, side);
  for (const part of parts.values()) part.cut([]);
  stage.fit();
  stage.look("corner");
  place.viewer = { parts, stage };
  return () => {
    const input = apart.querySelector("input");
    if (Number(input.value)) input.dispatchEvent(new Event("input"));
    stage.renew();
  };
}

/** Triangles and edges of one kind of part. @returns {Shape} */
function shapeOf({ points, normals, triangles, edges }) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(bytes(points)), 3));
  geometry.setAttribute("normal", new BufferAttribute(new Int8Array(bytes(normals)), 3, true));
  geometry.setIndex(new BufferAttribute(new Uint32Array(bytes(triangles)), 1));
  const lines = new BufferGeometry();
  lines.setAttribute("position", new BufferAttribute(new Float32Array(bytes(edges)), 3));
  return { geometry, edges: lines };
}

const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
