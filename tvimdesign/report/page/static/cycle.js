// The working cycle: curves over time with a cursor, and the temperatures through the layer at it.
import { axis, chart, frame, legendRows, lineOf, short } from "page/charts.js";
import { button, make, player, slider } from "page/dom.js";
import { moment, moveTo, onMoment, sampleAt, timeline } from "page/time.js";

const PLAYED_IN = 12; // s for the whole cycle

/** Draw the cycle; the sliders and the arrow keys move the cursor. */
export function draw(place, data) {
  const line = timeline(data);
  const charts = [];
  const controls = make("div", { className: "controls", role: "group", "aria-label": "Time in the cycle" });
  const told = make("p", { className: "told", "aria-live": "polite" });
  const time = slider("Time (s)", { max: line.end, step: line.end / 1000 }, moveTo);
  const plays = player((seconds) => {
    const next = moment() + (seconds * line.end) / PLAYED_IN;
    moveTo(next > line.end ? 0 : next);
  });
  const play = button("Play", () => {
    if (plays.plays) plays.stop(); else plays.play();
    play.textContent = plays.plays ? "Stop" : "Play";
    told.setAttribute("aria-live", plays.plays ? "off" : "polite");
  });
  controls.append(time.row, play);
  const panels = make("div", { className: "panels" });
  place.append(controls, told, panels);
  const over = (says, height, axes, lines) => charts.push(overTime(panels, { says, height }, line, axes, lines));

  const [start, end] = data.melting;
  over("Temperatures over time", 300, [{ name: "Temperature (°C)", band: [start, end] }],
    Object.entries(data.places).map(([column, name]) => ({ column, name, axis: 0 })));
  const profile = chart(panels, { says: "Temperatures through the layer at the cursor", height: 300 }, (look) => {
    const { phase, at } = sampleAt(line, moment());
    const pairs = data.depths.map((depth, i) => [depth, phase.through[at][i]]);
    const all = line.phases.flatMap(({ through }) => through.flat());
    return {
      ...frame(look), legend: { show: false },
      xAxis: axis("Depth from the pads (mm)", look, { scale: false }),
      yAxis: axis("Temperature (°C)", look, { nameGap: 38, min: 10 * Math.floor(Math.min(...all) / 10), max: 10 * Math.ceil(Math.max(...all) / 10) }),
      series: [{ ...lineOf("layer", pairs, 0, look), markArea: band([start, end], look) }],
    };
  });
  const labels = data.labels;
  over("Current and power over time", 260, [{ name: labels.current }, { name: labels.electrical_power }],
    [{ column: "current", name: "current", axis: 0 }, { column: "electrical_power", name: "electrical power", axis: 1 }]);
  over("Impedance of the joint over time", 260, [{ name: labels.joint_impedance, log: true, limits: { soft: data.soft, stiff: data.stiff } }],
    [{ column: "joint_impedance", name: "impedance", axis: 0 }]);
  over("Stiffness and damping of the joint over time", 260,
    [{ name: labels.joint_stiffness, log: true }, { name: labels.joint_damping, log: true }],
    [{ column: "joint_stiffness", name: "stiffness", axis: 0 }, { column: "joint_damping", name: "damping", axis: 1 }]);

  const show = () => {
    time.input.value = moment();
    for (const one of charts) one.cursor();
    profile.show();
    const { phase, at } = sampleAt(line, moment());
    const value = (column, name, unit) => `${name} ${short(phase[column][at])} ${unit}`;
    const unitOf = (column) => labels[column].match(/\(([^)]*)\)$/)?.[1] ?? "";
    told.textContent = `${phase.name} at ${short(phase.time[at])} s: ${[
      value("near_face", "near face", "°C"), value("far_face", "far face", "°C"),
      ...["current", "electrical_power", "joint_stiffness", "joint_damping"].map((column) =>
        value(column, column.replace("_", " "), unitOf(column))),
    ].join(", ")}`;
    time.input.setAttribute("aria-valuetext", told.textContent);
  };
  onMoment(show);
  show();
  return { line };
}

/** One chart over the whole cycle, with the cursor; a click moves it. */
function overTime(place, { says, height }, line, axes, lines) {
  const build = (look, width) => ({
    ...frame(look),
    grid: { ...frame(look).grid, top: 32 + 20 * legendRows(lines.map(({ name }) => name), width) },
    xAxis: axis("Time (s)", look, { scale: false, max: line.end, axisLabel: { color: look.quiet, formatter: short, showMaxLabel: false } }),
    yAxis: axes.map(({ name, log }, i) => axis(name, look, {
      type: log ? "log" : "value", nameGap: 42, position: i ? "right" : "left", splitLine: { show: !i, lineStyle: { color: look.line } },
    })),
    series: lines.map(({ column, name, axis: on }, i) => lineOf(name, pairsOf(line, column), i, look, {
      id: column, yAxisIndex: on,
      ...(i ? {} : { markLine: marks(line, axes[0], look), ...(axes[0].band ? { markArea: band(axes[0].band, look) } : {}) }),
    })),
  });
  const one = chart(place, { says, height }, build);
  one.made.getZr().on("click", (event) => {
    const [at] = one.made.convertFromPixel({ gridIndex: 0 }, [event.offsetX, event.offsetY]);
    if (at >= 0 && at <= line.end) moveTo(at);
  });
  one.cursor = () => one.made.setOption({ series: [{ id: lines[0].column, markLine: marks(line, axes[0], undefined) }] });
  return one;
}

/** Points of a column over the whole cycle. */
function pairsOf(line, column) {
  return line.phases.flatMap((phase) => phase.time.map((time, i) => [phase.begin + time, phase[column][i]]));
}

/** The cursor, where phases meet, and the limits of an axis. */
function marks(line, { limits = {} }, look) {
  const between = line.phases.slice(1).map(({ begin, name }) => ({ xAxis: begin, label: { formatter: name, position: "end", distance: 6 }, lineStyle: { type: "dotted", width: 1 } }));
  const level = Object.entries(limits).map(([name, yAxis]) => ({ yAxis, label: { formatter: name, position: "end" }, lineStyle: { type: "dashed", width: 1 } }));
  const cursor = { xAxis: moment(), label: { show: false }, lineStyle: { type: "solid", width: 2 } };
  const coloured = look ? { lineStyle: { color: look.accent }, label: { color: look.text } } : {};
  return { symbol: "none", silent: true, animation: false, ...coloured, data: [cursor, ...between, ...level] };
}

/** The melting range, named beside the plot: nothing stands on a line. */
function band([start, end], look) {
  return {
    silent: true, itemStyle: { color: look.colours[1], opacity: 0.14 }, label: { color: look.quiet, position: "right" },
    data: [[{ yAxis: start, name: "melting" }, { yAxis: end }]],
  };
}
