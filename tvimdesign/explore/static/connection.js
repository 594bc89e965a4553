// The socket to the server: says when it is cut, comes back by itself, and sends no more than can be answered.

const FIRST = 300; // ms before it is tried again
const LONGEST = 5000;

/** Connect; `told` is called with every message, `changed` with whether there is a connection. */
export function connect(told, changed) {
  /** @type {WebSocket} */
  let socket;
  let wait = FIRST;
  const open = () => {
    const address = new URL("socket", document.baseURI);
    address.protocol = "ws:";
    socket = new WebSocket(address);
    socket.addEventListener("open", () => { wait = FIRST; changed(true); });
    socket.addEventListener("message", ({ data }) => told(JSON.parse(data)));
    socket.addEventListener("close", () => {
      changed(false);
      setTimeout(open, wait);
      wait = Math.min(2 * wait, LONGEST);
    });
  };
  open();
  return {
    /** Send a message; false where there is no connection. */
    send(message) {
      if (socket.readyState !== WebSocket.OPEN) return false;
      socket.send(JSON.stringify(message));
      return true;
    },
  };
}
