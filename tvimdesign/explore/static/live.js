// What follows the hand: limits, outputs and the curves of the cycle.
import { axis, chart, frame, legendRows, lineOf } from "page/charts.js";
import { make } from "page/dom.js";
import { withUnit } from "explore/knob.js";

/** A table that is filled again at every answer; rows are [cells, class]. */
export function liveTable(place, caption, heads) {
  const body = make("tbody");
  place.replaceChildren(make("div", { className: "grid", role: "group", tabIndex: 0, "aria-label": caption },
    make("table", {}, make("caption", {}, caption), make("thead", {}, make("tr", {}, ...heads.map((head) => make("th", { scope: "col" }, head)))), body)));
  return (rows) => body.replaceChildren(...rows.map(([cells, how]) => make("tr", { className: how },
    ...cells.map((cell, i) => make(i ? "td" : "th", i ? {} : { scope: "row" }, cell)))));
}

/** The study's requirements, then the machine's rules that are active or violated; what is violated stands first. */
export function limitsTable(place) {
  const fill = liveTable(place, "Requirements, then active and violated rules", ["limit", "got", "margin", ""]);
  return (shown) => {
    const row = ({ stands, text, got, margin }) => [[text, got, margin, stands], stands === "met" ? "" : stands];
    const own = shown.limits.filter(({ origin }) => origin === "require");
    fill([
      ...shown.warnings.filter(({ accepted }) => !accepted).map(({ text }) => [[text, "", "", "rating"], "violated"]),
      ...own.map(row), ...shown.limits.filter((one) => !own.includes(one)).map(row),
    ]);
  };
}

/** Outputs: those that are asked about and the headlines first, all others behind a line. */
export function outputsTable(place) {
  const first = make("div");
  const rest = make("div");
  place.replaceChildren(first, make("details", {}, make("summary", {}, "All outputs"), rest));
  const heads = ["quantity", "value", "meaning"];
  const fills = [liveTable(first, "Asked about, and headlines", heads), liveTable(rest, "All outputs", heads)];
  return (quantities, asked, values) => {
    const rows = quantities.map(({ name, label, unit, means, headline }, i) => ({ row: [[label, withUnit(values[i], unit), `${means} (${name})`], ""], near: headline || asked.includes(name), of: asked.indexOf(name) }));
    const near = rows.filter((one) => one.near).sort((a, b) => (a.of < 0 ? 1e3 : a.of) - (b.of < 0 ? 1e3 : b.of));
    fills[0](near.map(({ row }) => row));
    if (rest.closest("details").open) fills[1](rows.map(({ row }) => row));
  };
}

const CHARTS = [
  { says: "Temperatures over the cycle", label: "Temperature (°C)", columns: { near_face: "layer, near face", far_face: "layer, far face", hot_side: "pads, inner side" } },
  { says: "Impedance of the joint over the cycle", label: "Impedance (N·m/rad)", columns: { joint_impedance: "impedance" }, log: true },
  { says: "Electrical power over the cycle", label: "Power (W)", columns: { electrical_power: "power" } },
];

/** Curves of softening and stiffening on one axis of time. */
export function liveCurves(place) {
  let curves = {};
  let waits = 0;
  const pairs = (column) => {
    let begin = 0;
    return Object.values(curves).filter(({ time }) => time).flatMap((phase) => {
      const found = phase.time.map((time, i) => [begin + time, phase[column][i]]);
      begin += phase.time.at(-1);
      return found;
    });
  };
  const charts = CHARTS.map(({ says, label, columns, log }) => chart(place, { says, height: 230 }, (look, width) => ({
    ...frame(look), grid: { left: 62, right: 20, top: 12 + 20 * legendRows(Object.values(columns), width), bottom: 42 },
    xAxis: axis("Time (s)", look, { scale: false }), yAxis: axis(label, look, { type: log ? "log" : "value", nameGap: 44 }),
    series: Object.entries(columns).map(([column, name], i) => lineOf(name, pairs(column), i, look)),
  })));
  const draw = () => {
    waits = 0;
    for (const one of charts) one.show();
  };
  // Numbers stand before curves are drawn, which takes longer; of several answers before a frame the last is drawn.
  return (told) => {
    if (told === curves) return;
    curves = told;
    waits ||= requestAnimationFrame(draw);
  };
}
