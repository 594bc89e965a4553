// Starts the page: tables that sort, figures when they come near the screen, pictures of the assembly's steps.
import { draw, drawWhenNear } from "page/figures.js";
import { makeSortable } from "page/tables.js";

/** Bring the page to life; without it all text and tables are there as they are. */
export function start() {
  for (const table of document.querySelectorAll(".grid table")) makeSortable(table);
  const figures = [...document.querySelectorAll(".drawn")];
  figures.forEach(drawWhenNear);
  addEventListener("beforeprint", () => figures.forEach(draw));
  for (const list of document.querySelectorAll(".steps")) {
    import("page/solids/steps.js").then(({ addPictures }) => addPictures(list));
  }
  document.documentElement.dataset.ready = "yes";
}
