// Files that the page carries: a link to one saves it, so that a page in a mail has them too.
import { unpacked } from "page/data.js";

/** Let links to carried files save them. What is not carried is looked for in the folder beside the page. */
export function serveFiles() {
  document.addEventListener("click", async (event) => {
    const link = /** @type {Element} */ (event.target).closest("a[href]");
    const address = link?.getAttribute("href");
    const held = address && document.querySelector(`script[data-file="${CSS.escape(address)}"]`);
    if (!held) return;
    event.preventDefault();
    const saved = document.createElement("a");
    saved.href = URL.createObjectURL(new Blob([await unpacked(held)]));
    saved.download = address.split("/").at(-1) ?? "";
    saved.click();
    // A browser reads the address after the click: one that is taken away at once may save nothing.
    setTimeout(() => URL.revokeObjectURL(saved.href), 60_000);
  });
}
