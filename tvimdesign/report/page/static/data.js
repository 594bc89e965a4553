// What the page carries for its figures: plain data, and meshes.

let all;

/** Data of the figure of that name. */
export function dataOf(name) {
  all ??= JSON.parse(document.getElementById("page-data")?.textContent ?? "{}");
  return all[name];
}

/** The bytes that a figure carries, unpacked; null where it has none. */
export async function binaryOf(name) {
  const held = document.getElementById(`binary-${name}`);
  return held ? unpacked(held) : null;
}

/** What an element of the page holds packed. */
export function unpacked(held) {
  const packed = Uint8Array.from(atob(held.textContent), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

/** Take other data and meshes from now on: a page that is open was given another design. */
export function replaceData(data, binaries) {
  all = data;
  for (const old of document.querySelectorAll("script[type='application/gzip'][id]")) old.remove();
  for (const [name, packed] of Object.entries(binaries)) {
    const held = document.createElement("script");
    held.type = "application/gzip";
    held.id = `binary-${name}`;
    held.textContent = packed;
    document.body.append(held);
  }
}
