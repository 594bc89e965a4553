// The front of the result: a click on a point shows its module.
import { axis, chart, frame, short } from "page/charts.js";
import { button, make } from "page/dom.js";

/** Draw the front once; a point is chosen by a click, or by its button. */
export function frontOf(place, section, send) {
  let drawn = false;
  return {
    show({ front }) {
      section.hidden = !front;
      if (!front || drawn) return;
      drawn = true;
      const [y, x] = front.of.map((name) => front.names.indexOf(name));
      const see = (number) => send({ kind: "point", number });
      const one = chart(place, { says: `Front: ${front.labels[y]} against ${front.labels[x]}`, height: 300 }, (look) => ({
        ...frame(look), legend: { show: false }, xAxis: axis(front.labels[x], look), yAxis: axis(front.labels[y], look, { nameGap: 46 }),
        tooltip: { ...frame(look).tooltip, trigger: "item", formatter: ({ data }) => `point ${data.number}` },
        series: [{ type: "scatter", symbolSize: 12, color: look.colours[0],
          data: front.points.map(({ number, values }) => ({ value: [values[x], values[y]], number })) }],
      }));
      one.made.on("click", (/** @type {any} */ { data }) => see(data.number));
      place.append(make("details", {}, make("summary", {}, "Points, as buttons"), ...front.points.map(({ number, values }) => {
        const made = button(`Point ${number}: ${front.of.map((name, i) => `${front.labels[[y, x][i] ?? front.names.indexOf(name)]} ${short(values[front.names.indexOf(name)])}`).join(", ")}`, () => see(number));
        made.className = "plain";
        return made;
      })));
    },
  };
}
