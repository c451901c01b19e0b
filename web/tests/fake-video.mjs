// A browser's decoder of videos that decodes nothing: a frame holds the timestamp of its unit, and the film's width.

export class FakeFrame {
  static open = 0;
  format = "I420P10";

  constructor(timestamp, [width, height]) {
    FakeFrame.open += 1;
    Object.assign(this, { timestamp, visibleRect: { width, height } });
  }

  allocationSize() {
    return 8;
  }

  async copyTo(data) {
    await later();
    if (this.closed) throw new Error("a frame that is closed");
    new Uint32Array(data.buffer).set([this.timestamp, this.visibleRect.width]);
    return [{ offset: 0, stride: 8 }];
  }

  close() {
    if (this.closed) throw new Error("closed twice");
    this.closed = true;
    FakeFrame.open -= 1;
  }
}

let seed = 1;
const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
const later = () => new Promise((resolve) => setTimeout(resolve, 4 * random()));

/** `manner`: delayed, how many units are kept before the first becomes a frame; shuffled, whether frames come in another
 * order; fails, (timestamp) => whether a unit is damaged; slow, milliseconds that each unit takes. */
export function installFakes(manner) {
  globalThis.EncodedVideoChunk = class {
    constructor(given) {
      Object.assign(this, given);
    }
  };
  globalThis.VideoDecoder = class {
    state = "unconfigured";
    queue = [];
    turn = 0;
    whole = false; // nothing but a key picture may come next

    static made = [];
    static isConfigSupported = async ({ codec }) => ({ supported: codec === "av01.0.00M.10" });

    constructor({ output, error }) {
      Object.assign(this, { output, error });
      globalThis.VideoDecoder.made.push(this);
    }

    configure({ codedWidth, codedHeight }) {
      Object.assign(this, { state: "configured", size: [codedWidth, codedHeight], whole: true });
    }

    decode({ type, timestamp }) {
      if (this.state !== "configured") throw new Error(`decode while ${this.state}`);
      if (this.whole && type !== "key") throw new Error("a key picture is needed");
      this.whole = false;
      this.queue.push(timestamp);
      void this.run(manner.delayed ?? 0);
    }

    async run(left) {
      const { turn } = this;
      await later();
      if (manner.slow) await new Promise((resolve) => setTimeout(resolve, manner.slow));
      if (turn !== this.turn || this.queue.length <= left) return;
      const at = manner.shuffled ? Math.floor(random() * this.queue.length) : 0;
      const [timestamp] = this.queue.splice(at, 1);
      if (manner.fails?.(timestamp)) {
        this.state = "closed";
        this.turn += 1;
        this.error(new DOMException("a unit that is damaged"));
        return;
      }
      this.output(new FakeFrame(timestamp, this.size));
    }

    /** As a browser does where a page is not looked at. */
    takeBack() {
      this.state = "closed";
      Object.assign(this, { queue: [], turn: this.turn + 1 });
      this.error(new DOMException("reclaimed", "QuotaExceededError"));
    }

    async flush() {
      const { turn } = this;
      while (turn === this.turn && this.queue.length) await this.run(0);
      if (turn !== this.turn) throw new DOMException("stopped", "AbortError");
      this.whole = true;
    }

    reset() {
      Object.assign(this, { state: "unconfigured", queue: [], turn: this.turn + 1 });
    }

    close() {
      this.reset();
      this.state = "closed";
    }
  };
}

/** The page's frames at sixty a second of a clock that goes as fast as they are asked for. */
export function installClock() {
  const clock = { now: 0 };
  globalThis.requestAnimationFrame = (call) =>
    setTimeout(() => {
      clock.now += 1000 / 60;
      call(clock.now);
    }, 1);
  return clock;
}
