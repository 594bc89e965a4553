// Charts in the page's own colours: ECharts drawn as SVG, again when the colours or the width change.
import { init } from "page/vendor/echarts.js";

const LIGHT = ["#0072b2", "#b35900", "#007a5a", "#8a3a78", "#3d4652", "#3a86b5"];
const DARK = ["#6cb6ff", "#f0a860", "#5fd0ad", "#e39ad2", "#c9d1dc", "#9ad0f5"];
const DASHES = ["solid", [7, 3], [2, 2], [9, 3, 2, 3], [4, 4], [1, 3]];
const dark = matchMedia("(prefers-color-scheme: dark)");
const every = new Set();
const PAPER = 640; // px that a chart is wide on a sheet
let onPaper = false;

/** A chart in `place`: `build(look, width)` gives its options, at a width [px]; `says` describes it to readers who cannot see it. */
export function chart(place, { says, height = 260 }, build) {
  forgetGone();
  const box = document.createElement("div");
  box.className = "chart";
  box.setAttribute("role", "img");
  box.setAttribute("aria-label", says);
  box.style.height = `${height}px`;
  place.append(box);
  const made = init(box, null, { renderer: "svg" });
  const one = { box, made, show: () => made.setOption({ animation: false, ...build(lookNow(), onPaper ? PAPER : box.clientWidth) }, true) };
  one.show();
  every.add(one);
  let wide = box.clientWidth;
  new ResizeObserver(() => {
    if (onPaper || box.clientWidth === wide) return;
    wide = box.clientWidth;
    made.resize();
    one.show();
  }).observe(box);
  return one;
}

/** Let go of charts whose place is no longer on the page. */
function forgetGone() {
  for (const one of every) {
    if (one.box.isConnected) continue;
    one.made.dispose();
    every.delete(one);
  }
}

dark.addEventListener("change", () => every.forEach((one) => one.show()));
addEventListener("beforeprint", () => toPaper(true));
addEventListener("afterprint", () => toPaper(false));

/** Draw everything black on white and as wide as a sheet, or as the screen has it. */
function toPaper(yes) {
  onPaper = yes;
  for (const one of every) {
    one.made.resize(yes ? { width: PAPER } : { width: "auto" });
    one.show();
  }
}

/** Colours and line styles of now. */
export function lookNow() {
  const isDark = dark.matches && !onPaper;
  return {
    colours: isDark ? DARK : LIGHT,
    dashes: DASHES,
    text: isDark ? "#e6e9ee" : "#1d2430",
    quiet: isDark ? "#a8b1bf" : "#4a5462",
    line: isDark ? "#353e4b" : "#d9dde3",
    panel: isDark ? "#1b212a" : "#ffffff",
    accent: isDark ? "#ff9d94" : "#a8201a",
  };
}

/** An axis with its label. */
export function axis(name, look, more = {}) {
  return {
    type: "value", name, nameLocation: "middle", nameGap: 28, scale: true,
    nameTextStyle: { color: look.text }, axisLabel: { color: look.quiet, hideOverlap: true },
    axisLine: { lineStyle: { color: look.quiet } }, splitLine: { lineStyle: { color: look.line } }, ...more,
  };
}

/** What all charts of lines have. */
export function frame(look, more = {}) {
  return {
    grid: { left: 62, right: 62, top: 34, bottom: 42 },
    legend: { top: 0, textStyle: { color: look.text }, itemWidth: 26, type: "plain" },
    tooltip: {
      trigger: "axis", confine: true, backgroundColor: look.panel, borderColor: look.line,
      textStyle: { color: look.text }, valueFormatter: (value) => short(value),
    },
    ...more,
  };
}

/** One line. @returns {any} */
export function lineOf(name, pairs, number, look, more = {}) {
  const colour = look.colours[number % look.colours.length];
  return {
    type: "line", name, data: pairs, showSymbol: false, color: colour,
    lineStyle: { width: 2, type: look.dashes[number % look.dashes.length], color: colour }, ...more,
  };
}

/** A number in four digits. */
export function short(value) {
  const number = Array.isArray(value) ? value.at(-1) : value;
  return typeof number === "number" ? String(Number(number.toPrecision(4))) : String(number ?? "");
}

/** Lines that a legend takes at a width. */
export function legendRows(names, width) {
  let [rows, used] = [1, 0];
  for (const name of new Set(names)) {
    const needs = 46 + 6.4 * name.length;
    if (used && used + needs > width) { rows += 1; used = 0; }
    used += needs;
  }
  return rows;
}
