// Short ways to make elements.

/** An element with properties and children; `data` and names with a dash become attributes. */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-") || name === "for" || name === "role") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children);
  return element;
}

/** A slider with its label; `told` is called with its value whenever it moves. */
export function slider(label, { min = 0, max = 1, step = 0.01, value = 0 }, told) {
  const input = make("input", { type: "range", min, max, step, value });
  input.addEventListener("input", () => told(Number(input.value)));
  return { input, row: make("label", { className: "control" }, make("span", {}, label), input) };
}

/** A button. */
export function button(label, pressed) {
  const made = make("button", { type: "button" }, label);
  made.addEventListener("click", () => pressed(made));
  return made;
}

/** A choice between named things. */
export function choice(label, names, told) {
  const select = make("select", {}, ...Object.entries(names).map(([value, text]) => make("option", { value }, text)));
  select.addEventListener("change", () => told(select.value));
  return { select, row: make("label", { className: "control" }, make("span", {}, label), select) };
}

/** A box to tick. */
export function tick(label, checked, told) {
  const input = make("input", { type: "checkbox", checked });
  input.addEventListener("change", () => told(input.checked));
  return { input, row: make("label", { className: "tick" }, input, make("span", {}, label)) };
}

/** Calls `step` with the seconds since the last frame, while it plays. */
export function player(step) {
  /** @type {number | null} */
  let last = null;
  const frame = (now) => {
    if (last === null) return;
    step(Math.min((now - last) / 1000, 0.1));
    last = now;
    requestAnimationFrame(frame);
  };
  return {
    get plays() { return last !== null; },
    play() { if (last === null) { last = performance.now(); requestAnimationFrame(frame); } },
    stop() { last = null; },
  };
}
