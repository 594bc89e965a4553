// The parts as a tree of boxes to tick, and a description of the picked one.
import { button, make, tick } from "page/dom.js";

/**
 * The tree: kinds, and within a kind its parts. `changed` is called when one is hidden or shown, `picked` (where there
 * is more to tell) with the part to tell about.
 */
export function partsTree(parts, changed, /** @type {((part: any) => void) | null} */ picked = null) {
  const kinds = Map.groupBy ? Map.groupBy(parts.values(), ({ kind }) => kind) : grouped([...parts.values()]);
  const list = make("ul", {});
  for (const [kind, members] of kinds) list.append(branch(kind, members, changed, picked));
  const show = (yes) => {
    for (const input of list.querySelectorAll("input")) { input.checked = yes; input.indeterminate = false; }
    for (const part of parts.values()) part.hidden = !yes;
    changed();
  };
  const both = make("div", { className: "both" }, button("Show all", () => show(true)), button("Hide all", () => show(false)));
  return make("div", { className: "parts-tree", role: "group", "aria-label": "Parts shown" }, both, list);
}

function grouped(members) {
  const found = new Map();
  for (const part of members) found.set(part.kind, [...(found.get(part.kind) ?? []), part]);
  return found;
}

function branch(kind, members, changed, picked) {
  const words = kind.replaceAll("_", " ");
  const boxes = [];
  const whole = tick(members.length > 1 ? `${words} (${members.length})` : words, true, (yes) => {
    for (const part of members) part.hidden = !yes;
    for (const { input } of boxes) input.checked = yes;
    changed();
  });
  const line = make("div", { className: "branch" }, whole.row);
  if (picked) {
    const about = button("about", () => picked(members[0]));
    about.setAttribute("aria-label", `about ${words}`);
    line.append(about);
  }
  const item = make("li", {}, line);
  if (members.length < 2) return item;
  for (const part of members) {
    boxes.push(tick(part.name.replaceAll("_", " "), true, (yes) => {
      part.hidden = !yes;
      const shown = members.filter(({ hidden }) => !hidden).length;
      whole.input.checked = shown > 0;
      whole.input.indeterminate = shown > 0 && shown < members.length;
      changed();
    }));
  }
  item.append(make("details", {}, make("summary", {}, "each"), make("ul", {}, ...boxes.map(({ row }) => make("li", {}, row)))));
  return item;
}

/** Describe a part: its material, mass and files. */
export function aboutPart(part, folder) {
  if (!part) return [make("p", {}, "Pick a part in the picture, or press “about” in the list.")];
  const links = part.files.flatMap((file) => [make("a", { href: `${folder}/${file}` }, file.split("/").at(-1)), " "]);
  const rows = [
    [part.made ? "Made of" : "Bought", part.title],
    ["Mass of one", `${part.mass} g`],
    ["Files", links],
  ];
  const list = make("dl", { className: "facts" }, ...rows.map(([label, text]) =>
    make("div", {}, make("dt", {}, label), make("dd", {}, ...[text].flat()))));
  return [make("h3", {}, part.name.replaceAll("_", " ")), list];
}
