// The report's sections of the last exact design, as report.html has them.
import { make } from "page/dom.js";
import { replaceData } from "page/data.js";
import { bring } from "page/main.js";
import { forgetListeners } from "page/time.js";

/** Put the sections in place, links pointing into the design's own folder. */
export function reportPanel(place) {
  return {
    show({ folder, status, first, sections, data, binaries }) {
      forgetListeners();
      replaceData(data, binaries);
      const open = new Set([...place.querySelectorAll("details[open] > summary")].map(({ textContent }) => textContent));
      const made = [{ name: "first", title: `Report: ${status}`, html: first, folded: false }, ...sections].map(({ name, title, html, folded }) => {
        const heading = make("h2", {}, title);
        const content = folded ? make("details", { className: "section" }, make("summary", {}, heading)) : make("div", {}, heading);
        content.insertAdjacentHTML("beforeend", html);
        return make("section", { id: name }, content);
      });
      for (const link of made.flatMap((one) => [...one.querySelectorAll("a[href]")])) {
        if (!/^(#|[a-z]+:)/.test(link.getAttribute("href"))) link.setAttribute("href", `${folder}/${link.getAttribute("href")}`);
      }
      for (const one of made.flatMap((section) => [...section.querySelectorAll("details")])) {
        if (open.has(one.querySelector("summary").textContent)) one.open = true;
      }
      place.replaceChildren(...made);
      bring(place);
      place.dataset.report = String(Number(place.dataset.report ?? 0) + 1);
    },
  };
}
