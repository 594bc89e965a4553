// The panel of controls: variables, requirements, weights, choices and inputs, each in its unit.
import { make } from "page/dom.js";
import { choiceKnob, numberKnob, withUnit } from "explore/knob.js";

/** Build the panel; `send` takes messages. */
export function controlPanel(place, send) {
  const knobs = new Map();
  let shape = "";
  /** What the server has told last. @type {any} */
  let state = null;

  const fieldset = (title, rows, open = true) => {
    const legend = make("legend", {}, title);
    if (open) return make("fieldset", {}, legend, ...rows);
    return make("details", {}, make("summary", {}, `${title} (${rows.length})`), make("fieldset", {}, ...rows));
  };
  const keep = (key, knob) => { knobs.set(key, knob); return knob.row; };

  function variable(one) {
    const asked = (text, final) => send({ kind: "set", name: one.name, text, final });
    if (one.options) return keep(one.name, choiceKnob(one, asked));
    const knob = numberKnob(one, asked);
    if (state.way === "optimize") {
      const ends = ["low", "high"].map((end) => make("input", { type: "text", value: one[`${end}_text`], "aria-label": `${one.name}, ${end === "low" ? "least" : "largest"}` }));
      const ask = () => send({ kind: "range", name: one.name, low: ends[0].value, high: ends[1].value, final: true });
      for (const end of ends) end.addEventListener("change", ask);
      knob.row.append(make("div", { className: "ends" }, "from", ends[0], "to", ends[1]));
      knob.field.readOnly = true;
      if (knob.slider) knob.slider.disabled = true;
    }
    return keep(one.name, knob);
  }

  function requirement(one) {
    const asked = (text, final) => {
      const texts = state.controls.requirements.filter(({ name }) => name === one.name)
        .map((other) => `${other.sense} ${other.place === one.place ? text.replace(/^[<>]=\s*/, "") : other.text}`);
      send({ kind: "require", name: one.name, texts, final });
    };
    const size = Math.abs(one.value) || 1;
    const knob = numberKnob({ ...one, name: `${one.name} ${one.sense}`, low: one.value - 0.5 * size, high: one.value + 0.5 * size, before: `${one.sense} ` }, asked);
    return keep(`${one.name} ${one.sense}`, knob);
  }

  /** Choices and inputs in their groups, and a search that opens the groups with a match. */
  function grouped(choices, inputs) {
    const rows = new Map();
    const add = ({ group, name, label, means }, row) => {
      row.dataset.words = `${name} ${label} ${means} ${group}`.toLowerCase();
      rows.set(group, [...(rows.get(group) ?? []), row]);
    };
    for (const one of choices) add(one, keep(one.name, choiceKnob(one, (text) => send({ kind: "set", name: one.name, text, final: true }))));
    for (const one of inputs) add(one, keep(one.name, numberKnob(one, (text, final) => send({ kind: "set", name: one.name, text, final }))));
    const groups = [...rows].sort(([a], [b]) => a.localeCompare(b)).map(([group, of]) => fieldset(group, of, false));
    const search = make("input", { type: "search", placeholder: "name or meaning", "aria-label": "Search inputs and choices" });
    search.addEventListener("input", () => {
      const word = search.value.trim().toLowerCase();
      for (const group of groups) {
        let shown = 0;
        for (const row of group.querySelectorAll("[data-words]")) {
          row.hidden = !row.dataset.words.includes(word);
          if (!row.hidden) shown += 1;
        }
        group.hidden = !shown;
        group.open = Boolean(word);
      }
    });
    return make("fieldset", { className: "inputs" }, make("legend", {}, `Inputs and choices (${choices.length + inputs.length})`), search, ...groups);
  }

  function build() {
    knobs.clear();
    const { variables, requirements, weights, choices } = state.controls;
    const weight = (one) => keep(`weight ${one.name}`, numberKnob(
      { label: one.label, name: one.name, means: one.means, unit: "", text: String(one.value), value: one.value, low: 0, high: Math.max(5, 2 * one.value) },
      (text, final) => send({ kind: "weight", name: one.name, text, final })));
    place.replaceChildren(
      ...(variables.length ? [fieldset(state.way === "optimize" ? "Variables, as the optimum has them" : "Variables", variables.map(variable))] : []),
      ...(requirements.length ? [fieldset("Requirements", requirements.map(requirement))] : []),
      ...(weights.length ? [fieldset("Weights of what is minimised", weights.map(weight))] : []),
      grouped(choices, state.controls.inputs));
  }

  return {
    /** Show a state; the controls themselves are built anew only where there are others. */
    show(told) {
      state = told;
      const { controls } = told;
      const now = JSON.stringify([told.way, controls.variables.map(({ name, low_text, high_text, options }) => [name, low_text, high_text, options]),
        controls.requirements.map(({ name, sense }) => [name, sense]), controls.weights.map(({ name }) => name), controls.inputs.map(({ name }) => name)]);
      if (now !== shape) { shape = now; build(); }
      for (const one of controls.variables) if (told.way === "evaluate") knobs.get(one.name)?.show(one.text, one.value);
      for (const one of controls.requirements) knobs.get(`${one.name} ${one.sense}`)?.show(one.text, one.value);
      for (const one of [...controls.choices, ...controls.inputs]) knobs.get(one.name)?.show(one.text, one.value);
      for (const one of controls.weights) knobs.get(`weight ${one.name}`)?.show(String(one.value), one.value);
    },
    /** Light up what is active and what is violated; in the way of optimising, move the variables to the optimum. */
    answer(shown) {
      for (const one of state.controls.requirements) {
        const of = shown.limits.filter((limit) => limit.of === one.name && limit.sense === one.sense);
        const how = ["violated", "active", "met"].find((word) => of.some(({ stands }) => stands === word)) ?? "met";
        const worst = of.find(({ stands }) => stands === how);
        knobs.get(`${one.name} ${one.sense}`)?.light(how, [how === "met" ? "" : how, worst ? `got ${worst.got}` : ""].filter(Boolean).join(", "));
      }
      for (const one of state.controls.variables) {
        const found = shown.variables[one.name];
        if (!found || one.options) continue;
        if (state.way === "optimize") knobs.get(one.name)?.show(withUnit(found.value, one.unit), found.value);
        knobs.get(one.name)?.light(found.end ? "active" : "", found.end ? `at its ${found.end} end` : "");
      }
    },
    /** Say why what was typed is refused, beside where it was typed. */
    refuse(name, words) {
      const found = [...knobs.entries()].find(([key]) => key === name || key.split(" ")[0] === name || key === `weight ${name}`);
      if (found) found[1].refusal.textContent = words;
      return Boolean(found);
    },
  };
}
