// Bytes of a long clip by place: those that arrived from its beginning on, and others by range.

import { Arrival, pour } from "./arrival.js";
import { SceneError, truncated } from "./errors.js";

const NEAR = 2 ** 20; // bytes ahead of what has arrived for which one waits
const HELD = 2 ** 25; // bytes that are kept of what arrives
const TRIES = 3; // of a range that breaks off
const PAUSE = 500; // milliseconds before the second of them, and twice as many before the next

/** A file on a server or at hand, of which what lies far behind is read by range. */
export class Ranges {
  private parted = false; // the first answer was given up
  private begun = false; // something was read, and so all before it has arrived
  private whole: Arrival | null = null; // all of the file, of a server that knows no ranges

  /** `arrival`: the file from its beginning on. `part`: gives that up. `length`: bytes of the file. */
  constructor(
    private readonly source: string | Blob,
    private readonly arrival: Arrival,
    private readonly length: number,
    private readonly part: () => void,
    private readonly signal: AbortSignal,
  ) {}

  /** Bytes `from`..`to` of the file. Rejects with a SceneError: `network`, `truncated`, or the signal's reason. */
  async read(from: number, to: number): Promise<ArrayBuffer> {
    const { arrival } = this;
    if (to <= arrival.received || !this.begun || (!this.parted && from <= arrival.received + NEAR)) {
      const bytes = await arrival.read(from, to).catch((reason: unknown) => {
        if (this.signal.aborted || !(this.parted || (this.begun && isNetwork(reason)))) throw reason;
      });
      if (!this.begun) this.limit();
      if (bytes) return bytes;
    }
    this.giveUp();
    if (typeof this.source !== "string") return this.slice(this.source, from, to);
    const url = this.source;
    const read = (): Promise<ArrayBuffer> => this.whole?.read(from, to) ?? this.fetch(url, from, to);
    return retried(this.signal, read, () => this.whole === null);
  }

  /** From now on no more is kept of what arrives than there is room for. */
  private limit(): void {
    const { arrival } = this;
    this.begun = true;
    arrival.onPush = () => {
      if (arrival.received >= HELD && arrival.received < this.length) this.giveUp();
    };
    arrival.onPush();
  }

  private giveUp(): void {
    if (this.parted) return;
    this.parted = true;
    this.part();
  }

  private async slice(blob: Blob, from: number, to: number): Promise<ArrayBuffer> {
    const bytes = await blob.slice(from, to).arrayBuffer();
    if (bytes.byteLength < to - from) throw truncated(from + bytes.byteLength, to);
    return bytes;
  }

  private async fetch(url: string, from: number, to: number): Promise<ArrayBuffer> {
    const headers = { Range: `bytes=${from}-${to - 1}` };
    const response = await fetch(url, { headers, signal: this.signal }).catch((cause: unknown) => {
      throw this.signal.aborted ? cause : this.broken(from, cause);
    });
    if (response.status === 200 && response.body) return this.receive(response.body).read(from, to);
    if (response.status !== 206) {
      await response.body?.cancel();
      throw this.broken(from, `The server answered ${response.status}`);
    }
    const bytes = await response.arrayBuffer().catch((cause: unknown) => {
      throw this.signal.aborted ? cause : this.broken(from, cause);
    });
    if (bytes.byteLength !== to - from) throw this.broken(from + bytes.byteLength, "a range that was cut short");
    return bytes;
  }

  /** The server sends all of the file, whatever is asked for: it is kept as it comes. */
  private receive(body: ReadableStream<Uint8Array>): Arrival {
    const whole = (this.whole = new Arrival());
    pour(body, whole, this.signal).catch((cause: unknown) => whole.fail(this.signal.aborted ? cause : this.broken(whole.received, cause)));
    return whole;
  }

  private broken(at: number, cause: unknown): SceneError {
    const message = `The connection broke at byte ${at} of ${this.length} of the clip; it is tried again when it plays on.`;
    return new SceneError("network", message, String(at), { cause });
  }
}

/** What `read` gives, which is tried again a few times while the network breaks off and `again` allows it. */
export async function retried<T>(signal: AbortSignal, read: () => Promise<T>, again = (): boolean => true): Promise<T> {
  for (let tried = 1; ; tried++) {
    try {
      return await read();
    } catch (reason) {
      signal.throwIfAborted();
      if (tried === TRIES || !isNetwork(reason) || !again()) throw reason;
      await new Promise((resolve) => setTimeout(resolve, PAUSE * 2 ** (tried - 1)));
      signal.throwIfAborted();
    }
  }
}

function isNetwork(reason: unknown): boolean {
  return reason instanceof SceneError && reason.code === "network";
}
