// The front of a result, or the cells of a sweep: a click on a point shows its module.
import { short } from "page/charts.js";
import { button, make } from "page/dom.js";
import { draw, FRONT } from "page/front.js";

const MOST_BUTTONS = 100; // points that have a button each; of more a number is typed

/** Draw the points once; one is chosen by a click, by its button, or by its number. */
export function frontOf(place, section, send) {
  let drawn = false;
  return {
    show(points) {
      if (!points || drawn) return;
      drawn = true;
      section.hidden = false;
      const words = points.words ?? FRONT;
      section.querySelector("h2").textContent = words.title;
      const see = (number) => send({ kind: "point", number });
      if (points.names.length) draw(place, points, { choose: see });
      place.append(points.points.length > MOST_BUTTONS ? "" : asButtons(points, words, see), byNumber(words, see));
    },
  };
}

/** A button for each point, with what it is drawn by. */
function asButtons({ of, names, labels, points }, words, see) {
  const drawn = [...of].reverse().map((name) => names.indexOf(name));
  const buttons = points.map(({ number, values }) => {
    const made = button(`${capital(words.one)} ${number}: ${drawn.map((i) => `${labels[i]} ${short(values[i])}`).join(", ")}`, () => see(number));
    made.className = "plain";
    return made;
  });
  return make("details", {}, make("summary", {}, `${capital(words.one)}s, as buttons`), ...buttons);
}

/** A field for a point's number: those that are not drawn have one too. */
function byNumber(words, see) {
  const field = make("input", { type: "number", min: "1", step: "1", "aria-label": `Number of a ${words.one}` });
  const show = () => { if (field.value !== "") see(Number(field.value)); };
  field.addEventListener("keydown", (/** @type {KeyboardEvent} */ { key }) => { if (key === "Enter") show(); });
  return make("p", { className: "by-number" }, field, button(`Show this ${words.one}`, show));
}

function capital(word) {
  return word[0].toUpperCase() + word.slice(1);
}
