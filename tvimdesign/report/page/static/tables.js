// Tables that sort by a column, and filter by a word where they are long.

const LONG = 25;

/** Let a table sort by its heads, and filter if it is long. */
export function makeSortable(table) {
  const rows = [...table.tBodies[0].rows];
  if (rows.length < 2) return;
  table.tHead.querySelectorAll("th").forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    if (!button.textContent.trim()) button.setAttribute("aria-label", "first column");
    head.append(button);
    button.addEventListener("click", () => sort(table, head, column));
  });
  if (rows.length > LONG) addFilter(table, rows);
}

/** Sort by a column: upwards, then downwards, then as written. */
function sort(table, head, column) {
  const body = table.tBodies[0];
  body.written ??= [...body.rows];
  const next = { none: "ascending", ascending: "descending", descending: "none" }[head.ariaSort ?? "none"];
  for (const other of table.tHead.querySelectorAll("th")) other.removeAttribute("aria-sort");
  const rows = [...body.written];
  if (next !== "none") {
    head.setAttribute("aria-sort", next);
    const sign = next === "ascending" ? 1 : -1;
    rows.sort((a, b) => sign * compare(a.cells[column], b.cells[column]));
  }
  body.append(...rows);
}

/** Numbers by size, texts by letters, empty cells last. */
function compare(a, b) {
  const [one, other] = [a.dataset.sort, b.dataset.sort];
  if (one !== undefined && other !== undefined) return Number(one) - Number(other);
  if ((one === undefined) !== (other === undefined)) return one === undefined ? 1 : -1;
  return a.textContent.localeCompare(b.textContent, undefined, { numeric: true });
}

function addFilter(table, rows) {
  const label = document.createElement("label");
  label.className = "filter";
  const input = document.createElement("input");
  input.type = "search";
  const count = document.createElement("span");
  count.setAttribute("aria-live", "polite");
  label.append(`Only rows with `, input);
  table.closest(".grid").before(label, count);
  input.addEventListener("input", () => {
    const word = input.value.trim().toLowerCase();
    let shown = 0;
    for (const row of rows) {
      row.hidden = !row.textContent.toLowerCase().includes(word);
      if (!row.hidden) shown += 1;
    }
    count.textContent = word ? ` ${shown} of ${rows.length} rows` : "";
  });
}
