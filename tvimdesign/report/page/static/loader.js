// Unpacks the page's code, names its modules to the browser, and starts them.
(async () => {
  const held = document.getElementById("page-code")?.textContent ?? "";
  const packed = Uint8Array.from(atob(held), (letter) => letter.charCodeAt(0));
  const texts = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).json();
  const address = (text) => URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  const imports = Object.fromEntries(Object.entries(texts).map(([name, text]) => [name, address(text)]));
  const add = (type, text) => document.body.append(Object.assign(document.createElement("script"), { type, textContent: text }));
  add("importmap", JSON.stringify({ imports }));
  add("module", 'import { start } from "page/main.js"; start();');
})();
