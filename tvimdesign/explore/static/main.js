// The explorer's page: what comes over the socket is shown, what a hand does is sent.
import { button, make } from "page/dom.js";
import { controlPanel } from "explore/controls.js";
import { connect } from "explore/connection.js";
import { draftOf } from "explore/draft.js";
import { frontOf } from "explore/front.js";
import { limitsTable, liveCurves, outputsTable } from "explore/live.js";
import { pinsTable } from "explore/pins.js";
import { reportPanel } from "explore/report.js";

/** An element that the template has. @returns {HTMLElement} */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));
const status = at("status");
const send = (message) => {
  if (connection.send(message)) document.documentElement.dataset.sent = String(Number(document.documentElement.dataset.sent ?? 0) + 1);
  else status.textContent = "Not sent: there is no connection.";
};
const controls = controlPanel(at("controls"), send);
const limits = limitsTable(at("limits"));
const outputs = outputsTable(at("outputs"));
const curves = liveCurves(at("curves"));
const draft = draftOf(at("draft"));
const pins = pinsTable(at("pins"), at("pins-section"), send);
const front = frontOf(at("front"), at("front-section"), send);
const report = reportPanel(at("report"));
/** What the server has told last: its state, and the last design with values. @type {any} */
let state = null;
/** @type {any} */
let last = null;

const ways = Object.fromEntries([["evaluate", "Evaluate"], ["optimize", "Optimise"]].map(([way, label]) =>
  [way, button(label, () => send({ kind: "way", way }))]));
const undo = button("Undo", () => send({ kind: "undo" }));
const redo = button("Redo", () => send({ kind: "redo" }));
const parts = button("Make CAD", () => send({ kind: "cad" }));
const confirm = button("Search every start", () => send({ kind: "confirm" }));
const pin = button("Pin", () => send({ kind: "pin", name: `${1 + Math.max(0, ...state.pins.map(({ name }) => Number(name) || 0))}` }));
const file = make("input", { type: "text", value: "study.yaml", "aria-label": "File to save the study as", size: 14 });
const save = button("Save as study", () => send({ kind: "save", file: file.value }));
const told = make("span", { role: "status", "aria-live": "polite", id: "told" });
at("toolbar").append(...Object.values(ways), undo, redo, button("Start again", () => send({ kind: "reset" })), pin, confirm, parts, file, save, told);
/** The options of `tvimdesign size`, each with a label and an example. */
const SIZED = { torque: ["Torque held when frozen", "8 N.m"], stiffness: ["Stiffness when soft", "1.5 N.m/rad"],
  diameter: ["Largest diameter", "70 mm"], time: ["Soft within", "60 s"], supply: ["Supply (current if limited)", "24 V, 3 A"],
  stroke: ["Stroke to either side", "0.104 rad"], stiff_time: ["Stiff again within (any if empty)", ""],
  process: ["Printing process (any if empty)", ""] };
const sized = make("form", {}, ...Object.entries(SIZED).map(([name, [label, value]]) =>
  make("label", {}, label, make("input", { type: "text", name, value, size: 12, required: value !== "" }))), make("button", {}, "Size it"));
sized.addEventListener("submit", (event) => {
  event.preventDefault();
  send({ kind: "size", ...Object.fromEntries(new FormData(sized)) });
});
at("size").append(sized);
addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || /** @type {Element} */ (event.target).matches("input[type=text], input[type=search]")) return;
  if (event.key === "z") { event.preventDefault(); send({ kind: event.shiftKey ? "redo" : "undo" }); }
});

const SOON = 150; // ms; a drag's answer comes sooner, and shows all that a state does
let shows = 0;
const HEARD = {
  state(message) {
    state = message;
    document.title = `${state.name}: explorer`;
    at("title").textContent = state.name;
    at("kind").textContent = `${state.mode} module, explorer`;
    at("folder").textContent = `Kept in ${state.folder}.`;
    for (const [way, one] of Object.entries(ways)) one.setAttribute("aria-pressed", String(way === state.way));
    ways.optimize.disabled = confirm.disabled = !state.optimizes;
    undo.disabled = !state.undo;
    redo.disabled = !state.redo;
    controls.show(state);
    pins.show(state, last);
    HEARD.parts(state.parts);
    shows ||= setTimeout(() => { shows = 0; if (last) show(last); }, SOON);
  },
  answer(message) {
    clearTimeout(shows);
    shows = 0;
    document.documentElement.dataset.number = message.number;
    document.documentElement.dataset.stage = message.shown.stage;
    told.textContent = "";
    if (message.shown.values) last = message.shown;
    if (state) show(message.shown);
    if (message.report) report.show(message.report);
  },
  points({ points }) { front.show(points); },
  draft(message) { draft.show(message); },
  refused({ name, words }) {
    if (!controls.refuse(name, words)) told.textContent = words;
  },
  progress({ text }) { told.textContent = text; },
  saved({ path }) { told.textContent = `Saved: ${path}`; },
  parts({ text, busy }) {
    parts.disabled = busy;
    if (text) told.textContent = text;
  },
};

const NAMED = 4; // violated limits that the status names

/** Names, of many the first ones and how many more there are. */
function listed(names) {
  return names.length > NAMED ? `${names.slice(0, NAMED).join(", ")} and ${names.length - NAMED} more` : names.join(", ");
}

function show(shown) {
  const violated = [...new Set((shown.limits ?? []).filter(({ stands }) => stands === "violated").map(({ label }) => label))];
  const words = shown.status || (violated.length ? `Violated: ${listed(violated)}` : shown.verdict || "All limits are met");
  const [first, ...reasons] = words.split("\n");
  if (status.textContent !== first) status.textContent = first;
  at("reasons").hidden = !reasons.length;
  at("reasons-text").textContent = reasons.join("\n");
  status.className = `status ${shown.found === false || violated.length ? "bad" : shown.status ? "warn" : shown.tone || "good"}`;
  if (!shown.values) return;
  controls.answer(shown);
  limits(shown);
  outputs(state.quantities, state.asked, shown.values);
  if (shown.curves) curves(shown.curves);
  pins.show(state, shown);
}

const connection = connect((message) => HEARD[message.kind](message), (connected) => {
  document.documentElement.dataset.connected = connected ? "yes" : "no";
  at("connection").textContent = connected ? "" : "No connection to the server: it has ended, or restarts. What you did is kept; this page tries again by itself.";
});
