// What the page carries for its figures: plain data, and meshes.

let all;

/** Data of the figure of that name. */
export function dataOf(name) {
  all ??= JSON.parse(document.getElementById("page-data").textContent);
  return all[name];
}

/** The bytes that a figure carries, unpacked; null where it has none. */
export async function binaryOf(name) {
  const held = document.getElementById(`binary-${name}`);
  if (!held) return null;
  const packed = Uint8Array.from(atob(held.textContent), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}
