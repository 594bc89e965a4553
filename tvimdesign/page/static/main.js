// Starts the page: tables that sort, figures once they come near the screen or nothing else is to be done.
import { draw, drawWhenNear } from "page/figures.js";
import { makeSortable } from "page/tables.js";

/** Bring the page to life; without it all text and tables are there as they are. */
export function start() {
  for (const table of document.querySelectorAll(".grid table")) makeSortable(table);
  const figures = [...document.querySelectorAll(".drawn")];
  figures.forEach(drawWhenNear);
  document.documentElement.dataset.ready = "yes";
  finish(figures, [...document.querySelectorAll(".steps")]);
}

/** Draw what is left while the reader reads, so that all of it is there when the page is printed. */
async function finish(figures, lists) {
  for (const figure of figures) {
    await idle();
    await draw(figure);
  }
  for (const list of lists) {
    await idle();
    const { addPictures } = await import("page/solids/steps.js");
    await addPictures(list);
  }
  document.documentElement.dataset.ready = "all";
}

const idle = () => new Promise((resolve) => (window.requestIdleCallback ?? setTimeout)(resolve, { timeout: 2000 }));
