// Pinned designs beside the one that is shown.
import { button, make } from "page/dom.js";
import { withUnit } from "explore/knob.js";

/** A column for each pinned design, and one for what is shown now. */
export function pinsTable(place, section, send) {
  return {
    show(state, shown) {
      section.hidden = !state.pins.length;
      if (!state.pins.length || !shown?.values) return;
      const names = [...new Set([...state.asked, ...state.quantities.filter(({ headline }) => headline).map(({ name }) => name)])];
      const now = Object.fromEntries(state.quantities.map(({ name, unit }, i) => [name, withUnit(shown.values[i], unit)]));
      for (const one of state.controls.variables) {
        const found = shown.variables[one.name];
        now[one.name] = found ? withUnit(found.value, one.unit ?? "") : one.text;
      }
      const rows = [...state.controls.variables.map(({ name }) => name), ...names];
      const heads = state.pins.map((one, number) => make("th", { scope: "col" }, `pin ${one.name}`,
        make("div", { className: "pins-actions" },
          labelled(button("Back to it", () => send({ kind: "recall", number })), `Back to pin ${one.name}`),
          labelled(button("Let go", () => send({ kind: "unpin", number })), `Let pin ${one.name} go`))));
      place.replaceChildren(make("div", { className: "grid", role: "group", tabIndex: 0, "aria-label": "Pinned designs" },
        make("table", {}, make("caption", {}, "Pinned designs beside the one that is shown"),
          make("thead", {}, make("tr", {}, make("th", { scope: "col" }, "quantity"), make("th", { scope: "col" }, "now"), ...heads)),
          make("tbody", {}, ...rows.map((name) => make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, now[name] ?? ""),
            ...state.pins.map((one) => make("td", {}, one.values[name] ?? ""))))))));
    },
  };
}

function labelled(made, label) {
  made.className = "plain";
  made.setAttribute("aria-label", label);
  return made;
}
