// A front, or the cells of a sweep: two columns against each other, and all of them as parallel axes to brush.
import { axis, chart, frame, short } from "page/charts.js";
import { button, choice, make } from "page/dom.js";

/** What a front's points are called; a sweep calls them by its own words. */
export const FRONT = { title: "Front", one: "point", many: "designs" };

/**
 * Draw the points; a brush, or the ends typed in below, keep only those within, in the table too. A value that is null never happens.
 * `choose` is called with the number of a point that is clicked; without it the point's row in the table is marked.
 * @param {any} place
 * @param {any} data
 * @param {{ choose?: (number: number) => void }} [hooks]
 */
export function draw(place, data, { choose } = {}) {
  const words = data.words ?? FRONT;
  const varying = data.names.map((_, i) => i).filter((i) => varies(data.points.map(({ values }) => values[i])));
  const ends = data.names.map(() => [null, null]);
  const shown = { x: data.names.indexOf(data.of[1]), y: data.names.indexOf(data.of[0]) };
  const inside = ({ values }) => values.every((value, i) => value === null ? ends[i].every((end) => end === null) :
    (ends[i][0] === null || value >= ends[i][0]) && (ends[i][1] === null || value <= ends[i][1]));
  const named = Object.fromEntries(data.labels.map((label, i) => [i, label]));
  const controls = make("div", { className: "controls", role: "group", "aria-label": "What the figure shows" });
  const x = choice("Across", named, (value) => { shown.x = Number(value); scatter.show(); });
  const y = choice("Up", named, (value) => { shown.y = Number(value); scatter.show(); });
  x.select.value = shown.x;
  y.select.value = shown.y;
  const clear = button("Keep all", () => { ends.forEach((end) => { end[0] = end[1] = null; }); parallel.show(); renew(); });
  const count = make("p", { className: "told", "aria-live": "polite" });
  controls.append(x.row, y.row, clear);
  place.append(controls, count);

  const scatter = chart(place, { says: `${words.title}: ${data.labels[shown.y]} against ${data.labels[shown.x]}`, height: 340 }, (look) => ({
    ...frame(look), legend: { show: false },
    tooltip: { ...frame(look).tooltip, trigger: "item", formatter: ({ data: one }) => `${words.one} ${one.number}${one.status === "between" ? "" : `, ${one.status}`}<br>${one.said}` },
    xAxis: axis(data.labels[shown.x], look),
    yAxis: axis(data.labels[shown.y], look, { nameGap: 46 }),
    series: [{
      type: "scatter", color: look.colours[0],
      data: data.points.map((point) => ({
        value: [point.values[shown.x], point.values[shown.y]], number: point.number, status: point.status,
        said: [shown.x, shown.y].map((i) => `${data.labels[i]}: ${short(point.values[i])}`).join("<br>"),
        symbol: point.status === "knee" ? "diamond" : point.hollow ? "emptyCircle" : "circle", symbolSize: point.status === "knee" ? 16 : 9,
        itemStyle: { opacity: inside(point) ? 1 : 0.15, color: colourOf(point, look) },
        label: { show: point.status !== "between" && !point.hollow && inside(point), formatter: point.status.split(",")[0], position: "top", color: look.text },
      })),
      labelLayout: { hideOverlap: true },
    }],
  }));

  scatter.made.on("click", (/** @type {any} */ { data: one }) => (choose ?? mark)(one.number));

  const parallel = chart(place, { says: `Parallel coordinates of ${data.labels.join(", ")}`, height: 360 }, (look) => ({
    parallel: { left: 60, right: 60, top: 76, bottom: 24 },
    parallelAxis: varying.map((of, dim) => ({
      dim, name: inLines(data.labels[of]), nameTextStyle: { color: look.text, fontSize: 11, lineHeight: 13 }, scale: true,
      axisLabel: { color: look.quiet, formatter: short, fontSize: 11 }, axisLine: { lineStyle: { color: look.quiet } },
      areaSelectStyle: { color: look.colours[0], opacity: 0.25, borderColor: look.colours[0], width: 16 },
    })),
    series: [{
      type: "parallel", inactiveOpacity: 0.06, activeOpacity: 1, smooth: false,
      lineStyle: { width: 1.6, color: look.colours[0], opacity: 0.7 },
      data: data.points.map((point) => ({
        value: varying.map((i) => point.values[i]), lineStyle: { color: colourOf(point, look), width: point.status === "knee" ? 3 : 1.6, opacity: inside(point) ? 0.8 : 0.06 },
      })),
    }],
  }));
  parallel.box.dataset.brush = "";
  parallel.made.on("axisareaselected", (/** @type {any} */ { parallelAxisId, intervals }) => {
    const model = /** @type {any} */ (parallel.made).getModel(); // the library has no other way to ask which axis it is
    const at = model.queryComponents({ mainType: "parallelAxis", id: parallelAxisId })[0].componentIndex;
    ends[varying[at]] = intervals.length ? [Math.min(...intervals.flat()), Math.max(...intervals.flat())] : [null, null];
    renew();
  });

  const typed = make("details", { className: "ends" }, make("summary", {}, "Ends of the axes, typed"));
  const fields = data.labels.map((label, i) => ["from", "to"].map((word, end) => {
    const input = make("input", { type: "number", step: "any", "aria-label": `${label} ${word}` });
    input.addEventListener("change", () => { ends[i][end] = input.value === "" ? null : Number(input.value); parallel.show(); renew(false); });
    return input;
  }));
  typed.append(...data.labels.map((label, i) => make("p", { className: "control" }, make("span", {}, label), ...fields[i])));
  place.append(typed);

  const same = data.names.map((_, i) => i).filter((i) => !varying.includes(i)).map((i) => `${data.labels[i]}: ${short(data.points[0].values[i])}`);
  if (same.length) place.append(make("p", { className: "note" }, `The same in all ${words.many}: ${same.join(", ")}.`));

  const drawn = new Set(data.points.map(({ number }) => String(number)));
  const rows = [...place.closest("section").querySelectorAll("tbody tr")];
  const mark = (number) => {
    for (const row of rows) row.ariaCurrent = String(row.cells[0].textContent.trim() === String(number));
    rows.find((row) => row.ariaCurrent === "true")?.scrollIntoView({ block: "center" });
  };
  const renew = (write = true) => {
    const kept = new Set(data.points.filter(inside).map(({ number }) => String(number)));
    const brushed = ends.flat().some((end) => end !== null);
    for (const row of rows) {
      const number = row.cells[0].textContent.trim();
      row.hidden = drawn.has(number) ? !kept.has(number) : brushed;
    }
    count.textContent = kept.size === data.points.length ? `${kept.size} ${words.many}` : `${kept.size} of ${data.points.length} ${words.many} are within`;
    place.dataset.kept = kept.size;
    scatter.show();
    if (write) ends.forEach((end, i) => end.forEach((value, j) => { fields[i][j].value = value === null ? "" : short(value); }));
  };
  renew();
}

const SAME = 1e-4; // share of a value within which all designs have it

/** Whether values differ by more than rounding. */
function varies(values) {
  const numbers = values.filter((value) => value !== null);
  if (numbers.length && numbers.length < values.length) return true;
  const [low, high] = [Math.min(...numbers), Math.max(...numbers)];
  return high - low > SAME * Math.max(Math.abs(low), Math.abs(high));
}

/** The colour of a point: a knee stands out, one that violates a limit steps back. */
function colourOf(point, look) {
  return point.status === "knee" ? look.accent : point.hollow ? look.quiet : look.colours[(point.group ?? 0) % look.colours.length];
}

/** A label in short lines. */
function inLines(label) {
  return label.split(" ").reduce((lines, word) => {
    const last = lines.at(-1);
    return last && last.length + word.length < 12 ? [...lines.slice(0, -1), `${last} ${word}`] : [...lines, word];
  }, []).join("\n");
}
