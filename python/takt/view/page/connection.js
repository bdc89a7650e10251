// The socket to the server: what it says, as events; tries again for ever when it breaks.

const PATIENCE_MS = [300, 600, 1200, 2000];
const SILENT_LOOKS = 4; // of one second each: a page that was busy itself has not looked

export class Connection extends EventTarget {
  constructor() {
    super();
    this.tries = 0;
    this.frames = 0;
    this.open();
    setInterval(() => {
      if (this.connected && ++this.silent > SILENT_LOOKS) this.socket.close();
    }, 1000);
  }

  get connected() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  open() {
    const socket = new WebSocket(`ws://${location.host}/live`);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.tries = 0;
      this.silent = 0;
      this.say("connected");
    };
    socket.onmessage = ({ data }) => {
      this.silent = 0;
      if (typeof data === "string") this.tell(JSON.parse(data));
      else this.take(data);
    };
    socket.onclose = () => {
      this.say("lost");
      setTimeout(() => this.open(), PATIENCE_MS[Math.min(this.tries++, PATIENCE_MS.length - 1)]);
    };
  }

  say(what, detail) {
    this.dispatchEvent(new CustomEvent(what, { detail }));
  }

  tell(said) {
    if ("waiting" in said) this.say("waiting", said.trouble || `no engine is heard on ${said.waiting}`);
    for (const what of ["machine", "complaint"]) if (what in said) this.say(what, said[what]);
  }

  // A JSON header, and numbers behind it.
  take(data) {
    const length = new DataView(data).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    const numbers = new Float64Array(data, Math.ceil((4 + length) / 8) * 8);
    ++this.frames;
    this.say("frame", { header, numbers });
    this.send({ ack: header.n });
  }

  // False: there is nobody to hear it.
  send(request) {
    if (this.connected) this.socket.send(JSON.stringify(request));
    return this.connected;
  }
}
