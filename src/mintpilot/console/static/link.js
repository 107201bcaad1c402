// The link to the drone: one WebSocket that comes back by itself and loses no command.

const QUIET_MS = 3000; // the server says something every second
const MOST_WAITING = 64 * 1024; // bytes of sound
const token = location.hash.slice(1);
const WAITING = `waiting ${token}`; // what was pressed for another mission is never sent to this one

const browser = (() => {
  let name = sessionStorage.getItem("browser");
  if (!name) {
    name = [...crypto.getRandomValues(new Uint8Array(8))].map((b) => b.toString(16).padStart(2, "0")).join("");
    sessionStorage.setItem("browser", name);
  }
  return name;
})();

export class Link extends EventTarget {
  #socket = null;
  #waiting = JSON.parse(sessionStorage.getItem(WAITING) || "[]"); // commands that were not acknowledged yet
  #n = Number(sessionStorage.getItem("n") || 0);
  #heard = 0;
  #state = "";
  #tries = 0;

  constructor() {
    super();
    setInterval(() => this.#watch(), 500);
    this.#open();
  }

  get up() { return this.#state === "up"; }

  send(command) {
    sessionStorage.setItem("n", ++this.#n);
    const message = { ...command, n: this.#n };
    this.#keep([...this.#waiting, message]);
    if (this.up) this.#socket.send(JSON.stringify(message));
  }

  #keep(waiting) { // over a reload, too
    this.#waiting = waiting;
    sessionStorage.setItem(WAITING, JSON.stringify(waiting));
  }

  // Sound is worth nothing later: what the link cannot take now is left out.
  sound(buffer) { if (this.up && this.#socket.bufferedAmount < MOST_WAITING) this.#socket.send(buffer); }

  #tell(kind, detail) { this.dispatchEvent(new CustomEvent(kind, { detail })); }

  #set(state) {
    if (state === this.#state) return;
    this.#state = state;
    this.#tell("state", state);
  }

  #open() {
    const socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    this.#heard = performance.now();
    socket.onopen = () => socket.send(JSON.stringify({ kind: "hello", token, browser }));
    socket.onmessage = (event) => { if (socket === this.#socket) this.#take(event.data); };
    socket.onclose = (event) => {
      if (socket !== this.#socket) return;
      this.#socket = null;
      if (event.code === 4401) { this.#set("refused"); return; }
      this.#set("lost");
      setTimeout(() => this.#open(), Math.min(3000, 250 * 2 ** this.#tries++));
    };
  }

  #watch() {
    if (this.#socket && performance.now() - this.#heard > QUIET_MS) {
      this.#set("lost");
      this.#socket.close();
      if (performance.now() - this.#heard > 2 * QUIET_MS) this.#socket.onclose({ code: 1006 });
    }
  }

  #take(data) {
    this.#heard = performance.now();
    if (this.#state !== "up") {
      this.#tries = 0;
      this.#set("up");
      for (const message of this.#waiting) this.#socket.send(JSON.stringify(message));
    }
    let payload = null;
    if (data instanceof ArrayBuffer) {
      const size = new DataView(data).getUint32(0);
      payload = new Blob([data.slice(4 + size)]);
      data = new TextDecoder().decode(new Uint8Array(data, 4, size));
    }
    const message = JSON.parse(data);
    if (message.pane) this.#tell(message.pane, { data: message.data, payload });
    else if (message.stream) this.#tell(message.stream, message);
    else if (message.ack) {
      this.#keep(this.#waiting.filter((m) => m.n !== message.ack));
      if (!message.taken) this.#tell("not-taken", message.ack);
    }
  }
}
