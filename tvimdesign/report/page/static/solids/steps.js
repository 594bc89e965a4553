// A picture of the module after each step of its assembly, where the step brings a part into its place.
import { draw } from "page/figures.js";
import { dataOf } from "page/data.js";
import { button, make } from "page/dom.js";

const [WIDE, HIGH] = [360, 270];

/** Add pictures to the steps; the assembly stands as it stood before. */
export async function addPictures(list) {
  const figure = document.getElementById(`figure-${list.dataset.figure}`);
  if (!figure) return;
  const viewer = await draw(figure);
  if (!viewer) return;
  const steps = dataOf(list.dataset.figure).steps;
  for (const [i, item] of [...list.children].entries()) {
    if (!steps[i].parts.length) continue;
    viewer.showStep(i + 1);
    const names = steps[i].parts.join(", ").replaceAll("_", " ");
    const src = viewer.stage.picture(WIDE, HIGH, steps[i].from === "below" ? "below" : "corner");
    const picture = make("img", { src, width: WIDE, height: HIGH, alt: `The module after this step, which places ${names}` });
    const text = make("div", {}, ...item.firstElementChild.childNodes, button("Show in 3-D", () => {
      viewer.showStep(i + 1);
      figure.scrollIntoView();
    }));
    item.firstElementChild.className = "with-picture";
    item.firstElementChild.append(text, picture);
    await new Promise(requestAnimationFrame);
  }
  viewer.showStep(steps.length);
  list.dataset.state = "drawn";
}
