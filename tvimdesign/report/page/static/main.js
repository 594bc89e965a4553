// Starts the page: tables that sort, figures once they come near the screen or nothing else is to be done.
import { draw, drawWhenNear } from "page/figures.js";
import { serveFiles } from "page/files.js";
import { makeSortable } from "page/tables.js";

/** Bring the page to life; without it all text and tables are there as they are. */
export function start() {
  serveFiles();
  addEventListener("hashchange", openTarget);
  openTarget();
  const all = bring(document);
  document.documentElement.dataset.ready = "yes";
  all.then(() => { document.documentElement.dataset.ready = "all"; });
}

/** Unfold the section that the address names. */
function openTarget() {
  const target = location.hash ? document.getElementById(decodeURIComponent(location.hash.slice(1))) : null;
  const folded = /** @type {HTMLDetailsElement | null} */ (target?.querySelector(":scope > details") ?? null);
  if (!folded || folded.open) return;
  folded.open = true;
  target?.scrollIntoView();
}

/** Bring to life what stands in an element, what is near the screen first. */
export async function bring(root) {
  for (const table of root.querySelectorAll(".grid table")) makeSortable(table);
  const figures = [...root.querySelectorAll(".drawn")];
  figures.forEach(drawWhenNear);
  await finish(figures, [...root.querySelectorAll(".steps")]);
}

/** Draw what is left while the reader reads, so that all of it is there when the page is printed. */
async function finish(figures, lists) {
  for (const figure of figures) {
    await idle();
    if (figure.isConnected) await draw(figure);
  }
  for (const list of lists) {
    await idle();
    const { addPictures } = await import("page/solids/steps.js");
    if (list.isConnected) await addPictures(list);
  }
}

const idle = () => new Promise((resolve) => (window.requestIdleCallback ?? setTimeout)(resolve, { timeout: 2000 }));
