// The assembly in 3-D: turned, hidden by the tree, taken apart, put together step by step, cut, moved, coloured.
import { dataOf } from "page/data.js";
import { button, choice, make, player, slider, tick } from "page/dom.js";
import { moment, onMoment, sampleAt, timeline } from "page/time.js";
import { cut, explode } from "page/solids/apart.js";
import { layerColours } from "page/solids/layer.js";
import { turner } from "page/solids/motion.js";
import { readParts } from "page/solids/parts.js";
import { Stage, VIEWS } from "page/solids/stage.js";
import { aboutPart, partsTree } from "page/solids/tree.js";

const SWING = 2.5; // s for the rotor to go to and fro once

/** Draw the assembly with its controls. Resolves to what else the page can ask of it. */
export async function draw(place, data, { binary, says }) {
  const parts = await readParts(await binary(), data.parts);
  const scene = make("div", { className: "stage" });
  const about = make("div", { className: "about", "aria-live": "polite" }, ...aboutPart(null));
  const stage = new Stage(scene, says);
  for (const part of parts.values()) stage.scene.add(part.object);
  /** @type {import("page/solids/parts.js").Part | null} */
  let last = null;
  const pick = (part) => {
    last?.mark(false);
    part?.mark(true);
    last = part;
    about.replaceChildren(...aboutPart(part, data.folder));
    stage.renew();
  };
  stage.onPick(pick);
  const changed = () => {
    for (const part of parts.values()) part.place();
    stage.renew();
  };
  const steps = stepper(parts, data.steps, changed);
  const controls = make("div", { className: "controls", role: "group", "aria-label": "The assembly" },
    choice("View", Object.fromEntries(Object.keys(VIEWS).map((name) => [name, name])), (view) => stage.look(view)).row,
    explode(parts, changed, stage), ...cut(parts, stage), ...stroke(parts, data, stage), colours(parts, data, stage), steps.row);
  const side = make("div", { className: "side" }, partsTree(parts, changed, pick), about);
  place.className += " solids";
  place.append(controls, steps.told, make("div", { className: "beside" }, scene, side));
  for (const part of parts.values()) part.cut([]);
  stage.fit();
  stage.look("corner");
  stage.drawNow();
  place.closest("figure").viewer = { parts, stage };
  return { parts, stage, showStep: steps.show };
}

/** The rotor turned by hand, or to and fro. */
function stroke(parts, data, stage) {
  const turn = turner(parts, data);
  const show = (share) => {
    turn(share);
    moved.input.setAttribute("aria-valuetext", `${(share * data.stroke * 180 / Math.PI).toFixed(2)} degrees`);
    stage.renew();
  };
  const moved = slider("Rotor", { min: -1, max: 1, step: 0.02 }, show);
  let at = 0;
  const plays = player((seconds) => {
    at += (seconds * 2 * Math.PI) / SWING;
    moved.input.value = Math.sin(at);
    show(Math.sin(at));
  });
  const play = button("Swing", () => {
    if (plays.plays) plays.stop(); else plays.play();
    play.textContent = plays.plays ? "Stop" : "Swing";
  });
  return [moved.row, play];
}

/** The layer in the colours of its temperature at the moment of the cycle. */
function colours(parts, data, stage) {
  const cycle = dataOf(data.cycle);
  if (!cycle) return "";
  const line = timeline(cycle);
  const all = line.phases.flatMap(({ through }) => through.flat());
  const colour = layerColours(parts, data.mode, cycle.melting, Math.max(...all), Math.min(...all));
  const show = () => {
    const { phase, at } = sampleAt(line, moment());
    colour(box.input.checked ? phase.through[at] : null);
    stage.renew();
  };
  const box = tick("Layer by its temperature (blue solid, white melting, red molten)", false, show);
  onMoment(() => { if (box.input.checked) show(); });
  return box.row;
}

/** The assembly as far as a step: what comes later is not there yet, what comes now is marked. */
function stepper(parts, steps, changed) {
  const told = make("p", { className: "told", "aria-live": "polite" });
  const placing = steps.map(({ parts: names }) => names);
  const stepOf = new Map(placing.flatMap((names, i) => names.map((name) => [name, i])));
  const show = (number) => {
    for (const part of parts.values()) {
      const at = stepOf.get(part.name) ?? -1;
      part.later = number < steps.length && at >= number;
      part.mark(number < steps.length && at === number - 1);
    }
    const text = number ? steps[number - 1].text : "nothing yet";
    told.textContent = number === steps.length ? "" : `Step ${number}: ${text}`;
    input.value = number;
    input.setAttribute("aria-valuetext", number === steps.length ? "complete" : `step ${number}`);
    changed();
  };
  const { input, row } = slider("Assembly step", { max: steps.length, step: 1, value: steps.length }, show);
  return { row, told, show };
}
