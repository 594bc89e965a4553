// One control: a name, a field that takes a number with its unit, and a slider.
import { make } from "page/dom.js";
import { short } from "page/charts.js";

const STEPS = 500;
let count = 0;

/**
 * A control of a number. `asked(text, final)` is called as it moves; the field takes what a study takes.
 * `low` and `high` are the slider's ends in `unit`; without them there is no slider.
 */
export function numberKnob({ label, name: key, means, unit, text, value, low, high, before = "" }, asked) {
  const field = make("input", { type: "text", value: fitting(text), spellcheck: false, autocomplete: "off", id: `knob-${count += 1}` });
  const name = named(field.id, label, key, means);
  const refusal = make("p", { className: "refusal", role: "alert" });
  const stands = make("span", { className: "stands" });
  const row = make("div", { className: "knob" }, name, field);
  const one = { row, field, refusal, stands, held: false };
  const typed = () => { if (field.value !== one.sent) ask(field.value, true); };
  const ask = (words, final) => { one.sent = words; refusal.textContent = ""; asked(words, final); };
  one.sent = field.value;
  field.addEventListener("change", typed);
  field.addEventListener("keydown", (event) => { if (event.key === "Enter") typed(); });
  if (low !== undefined && high > low) {
    const slider = make("input", { type: "range", min: low, max: high, step: (high - low) / STEPS, value, "aria-label": `${label}, slider` });
    const written = () => `${Number(Number(slider.value).toPrecision(5))} ${unit}`.trim();
    slider.addEventListener("input", () => {
      one.held = true;
      field.value = written();
      slider.setAttribute("aria-valuetext", `${before}${written()}`);
      ask(written(), false);
    });
    slider.addEventListener("change", () => { one.held = false; ask(written(), true); });
    one.slider = slider;
    row.append(slider);
  }
  row.append(stands, refusal);
  /** Show a value that came from elsewhere, unless a hand is on the control. */
  one.show = (words, number) => {
    if (one.held || (document.activeElement === field && field.value !== one.sent)) return;
    field.value = one.sent = fitting(words);
    if (one.slider) {
      one.slider.value = number;
      one.slider.setAttribute("aria-valuetext", words);
    }
  };
  /** Light up: `active`, `violated`, or nothing. */
  one.light = (how, words) => {
    row.classList.toggle("active", how === "active");
    row.classList.toggle("violated", how === "violated");
    stands.textContent = words;
  };
  return one;
}

/** A label in words, with the name that a study has for it. */
function named(id, label, name, means) {
  const words = label === name ? [name] : [`${label} `, make("code", {}, name)];
  return make("label", { for: id, title: means }, ...words);
}

/** A text with its number in as many digits as a field shows; what stands is exact, and goes nowhere unless it is changed. */
const fitting = (text) => text.replace(/^-?\d+\.\d{5,}/, (number) => String(Number(Number(number).toPrecision(6))));

/** A control of a word out of some. */
export function choiceKnob({ label, name, means, text, options }, asked) {
  const select = make("select", { id: `knob-${count += 1}` }, ...options.map((value) => make("option", { value }, value)));
  select.value = text;
  const refusal = make("p", { className: "refusal", role: "alert" });
  const row = make("div", { className: "knob" }, named(select.id, label, name, means), select, refusal);
  select.addEventListener("change", () => { refusal.textContent = ""; asked(select.value, true); });
  return { row, field: select, refusal, show: (words) => { select.value = words; }, light() {} };
}

/** A number with its unit, short. */
export const withUnit = (value, unit) => (value === null ? "never" : `${short(value)} ${unit}`.trim());
