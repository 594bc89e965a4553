// Panels of lines, such as the curves of a virtual test or the fronts of a comparison.
import { axis, chart, frame, legendRows, lineOf } from "page/charts.js";

/** Draw each panel: lines with labels, bands where history leaves an interval, points where it says so, hollow or apart. */
export function draw(place, { panels }) {
  place.className += " panels";
  for (const panel of panels) {
    const says = [panel.title, `${panel.y_label} over ${panel.x_label}`, panel.lines.map(({ label }) => label).join(", ")];
    chart(place, { says: says.filter(Boolean).join("; "), height: 330 }, (look, width) => {
      const below = panel.title ? 26 : 0;
      const top = below + 20 * legendRows(panel.lines.map(({ label }) => label), width) + 16;
      return {
        ...frame(look, { title: { text: panel.title ?? "", left: 8, textStyle: { color: look.text, fontSize: 14 } } }),
        grid: { left: 62, right: 24, top, bottom: 46 },
        legend: { top: below, textStyle: { color: look.text }, itemWidth: 26 },
        xAxis: axis(panel.x_label, look, { type: panel.log_x ? "log" : "value", scale: true }),
        yAxis: axis(panel.y_label, look, { type: panel.log_y ? "log" : "value", nameGap: 46 }),
        series: panel.lines.flatMap((line, i) => series(line, i, look)),
      };
    });
  }
}

function series(line, number, look) {
  const pairs = line.x.map((x, i) => line.hollow?.[i] ? { value: [x, line.y[i]], symbol: "emptyCircle" } : [x, line.y[i]]);
  const made = [lineOf(line.label, pairs, number, look, line.points ? { showSymbol: true, symbolSize: 6 } : {})];
  if (line.hollow) made[0].symbol = "circle"; // else the library's own, which is hollow
  if (line.apart) made[0].lineStyle.width = 0;
  if (line.dashed) made[0].lineStyle.type = [3, 3];
  for (const edge of line.band ?? []) {
    made.push({ ...lineOf(line.label, line.x.map((x, i) => [x, edge[i]]), number, look), lineStyle: { width: 1, opacity: 0.5, type: "dotted", color: look.colours[number % look.colours.length] }, silent: true });
  }
  return made;
}
