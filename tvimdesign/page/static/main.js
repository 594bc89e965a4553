// Starts the page: tables that sort, then each figure when it comes near the screen.
import { binaryOf, dataOf } from "page/data.js";
import { makeSortable } from "page/tables.js";

/** Bring the page to life; without it all text and tables are there as they are. */
export function start() {
  for (const table of document.querySelectorAll(".grid table")) makeSortable(table);
  const waiting = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) if (isIntersecting) draw(target);
  }, { rootMargin: "400px" });
  for (const figure of document.querySelectorAll(".drawn")) waiting.observe(figure);
  addEventListener("beforeprint", () => document.querySelectorAll(".drawn").forEach(draw));
  document.documentElement.dataset.ready = "yes";
}

/** Draw a figure, once. What fails is said in its place. */
async function draw(figure) {
  if (figure.dataset.state) return;
  figure.dataset.state = "drawing";
  const place = figure.querySelector(".canvas");
  try {
    const module = await import(`page/${figure.dataset.by}`);
    const name = figure.dataset.name;
    place.replaceChildren();
    await module.draw(place, dataOf(name), () => binaryOf(name), figure.querySelector("figcaption").textContent);
    figure.dataset.state = "drawn";
  } catch (error) {
    figure.dataset.state = "failed";
    const words = document.createElement("p");
    words.className = "waits";
    words.textContent = `This figure cannot be drawn here: ${error.message}`;
    place.replaceChildren(words);
    console.warn(error);
  }
}
