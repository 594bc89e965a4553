// Draws the page's figures, each once, by the module that it names.
import { binaryOf, dataOf } from "page/data.js";

const drawn = new WeakMap();
const near = new IntersectionObserver((entries) => {
  for (const { isIntersecting, target } of entries) if (isIntersecting) draw(target);
}, { rootMargin: "400px" });

/** Draw a figure once it comes near the screen. */
export function drawWhenNear(figure) {
  near.observe(figure);
}

/** Draw a figure, once; resolves to what its module gives back, or to null where it cannot be drawn. */
export function draw(figure) {
  if (!drawn.has(figure)) drawn.set(figure, attempt(figure));
  return drawn.get(figure);
}

/** Draw; a failure is reported in the place of the figure. */
async function attempt(figure) {
  const place = figure.querySelector(".canvas");
  const { name, by } = figure.dataset;
  try {
    const module = await import(`page/${by}`);
    const says = figure.querySelector("figcaption").textContent;
    place.replaceChildren();
    const made = await module.draw(place, dataOf(name), { binary: () => binaryOf(name), says });
    figure.dataset.state = "drawn";
    return made;
  } catch (error) {
    figure.dataset.state = "failed";
    const words = document.createElement("p");
    words.className = "waits";
    words.textContent = `This figure cannot be drawn here: ${error instanceof Error ? error.message : error}`;
    place.replaceChildren(words);
    console.info(error);
    return null;
  }
}
