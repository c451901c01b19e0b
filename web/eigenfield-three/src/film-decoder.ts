// A film of the codec `film-1`, decoded by the browser: a temporal unit of AV1 goes in, a frame comes out.

import { readSequenceHeader } from "./av1-picture.js";
import { SceneError, damaged } from "./errors.js";
import { codesOf } from "./film-codes.js";
import type { Codes } from "./pieces.js";

const MOST_OPEN = 4; // frames that are on their way: decoders have few, and wait for them
const LADDER: HardwareAcceleration[] = ["prefer-software", "no-preference"]; // what hardware decodes is slow to read back

/** What makes frames of the units of a film. */
export interface FilmSource {
  /** Frames of the browser that are not closed. */
  readonly open: number;
  /** Units that were given are to become frames. */
  readonly busy: boolean;
  /** Whether there is room for another unit, or the decoder is gone, which `decode` says. */
  readonly ready: boolean;
  /** Makes it what the first unit of a group needs. Raises SceneError: `codec`, `damaged`. */
  start(unit: Uint8Array): Promise<void>;
  /** Only after `start`, and while `ready`. `key`: the first unit of a group. */
  decode(unit: Uint8Array, position: number, key: boolean): void;
  /** All units have become frames. */
  flush(): Promise<void>;
  /** What was given is needed no more. */
  reset(): void;
  dispose(): void;
}

export interface FilmUser {
  /** What becomes of a frame. Until that is settled `read` gives its codes, in a room that they may have; `opacity`: of
   * sheets. */
  take(position: number, read: (room: Codes["room"], opacity: boolean) => Promise<Codes>): Promise<void>;
  /** A frame is closed: there may be room for another unit. */
  closed(): void;
  /** A unit could not be decoded; what was given is thrown away. */
  failed(reason: unknown): void;
  /** The browser took the decoder back, as it does where a page is not looked at; `start` makes another. */
  lost(): void;
}

export class FilmDecoder implements FilmSource {
  private decoder: VideoDecoder | null = null;
  private config: VideoDecoderConfig | null = null;
  private turn = 0; // of decoding: what belongs to one before is thrown away
  private onTheWay = 0;
  private opened = 0;

  /** `size`: of its frames. */
  constructor(
    private readonly size: [number, number],
    private readonly where: string,
    private readonly user: FilmUser,
  ) {}

  get open(): number {
    return this.opened;
  }

  get busy(): boolean {
    return this.onTheWay > 0;
  }

  get ready(): boolean {
    return this.onTheWay < MOST_OPEN || this.decoder?.state === "closed";
  }

  async start(unit: Uint8Array): Promise<void> {
    const { level, tier, width, height } = readSequenceHeader(unit, this.where);
    if (width !== this.size[0] || height !== this.size[1]) throw damaged(this.where, `frames of ${width} x ${height}`);
    const codec = `av01.0.${String(level).padStart(2, "0")}${tier ? "H" : "M"}.10`;
    const { turn } = this;
    const same = this.config?.codec === codec;
    const config = same ? this.config : await supported(codec, this.size, this.where);
    if (turn !== this.turn || !config) return;
    if (same && this.decoder?.state === "configured") return;
    this.config = config;
    if (!this.decoder || this.decoder.state === "closed") this.decoder = this.made();
    this.decoder.configure(config);
  }

  decode(unit: Uint8Array, position: number, key: boolean): void {
    if (this.decoder?.state === "closed") return this.user.lost();
    this.onTheWay += 1;
    this.decoder?.decode(new EncodedVideoChunk({ type: key ? "key" : "delta", timestamp: position, data: unit }));
  }

  async flush(): Promise<void> {
    await this.decoder?.flush().catch(() => undefined); // stopped, or `failed` has heard of it
  }

  reset(): void {
    this.turn += 1;
    this.onTheWay = 0;
    if (this.decoder?.state === "configured") this.decoder.reset();
  }

  dispose(): void {
    this.reset();
    if (this.decoder && this.decoder.state !== "closed") this.decoder.close();
    this.decoder = null;
  }

  private made(): VideoDecoder {
    const made = new VideoDecoder({
      output: (frame) => void this.receive(frame),
      error: (reason) => {
        if (this.decoder !== made) return;
        if (reason.name === "QuotaExceededError") this.user.lost();
        else if (reason.name === "NotSupportedError") this.fail(this.turn, noDecoder(this.where));
        else this.fail(this.turn, damaged(this.where, reason.message));
      },
    });
    return made;
  }

  private async receive(frame: VideoFrame): Promise<void> {
    const { turn } = this;
    this.opened += 1;
    try {
      await this.user.take(frame.timestamp, (...how) => codesOf(frame, ...how));
    } catch (reason) {
      this.fail(turn, reason);
    } finally {
      frame.close();
      this.opened -= 1;
      if (turn === this.turn) this.onTheWay -= 1;
      this.user.closed();
    }
  }

  private fail(turn: number, reason: unknown): void {
    if (turn !== this.turn) return;
    this.reset();
    this.user.failed(reason);
  }
}

async function supported(codec: string, [width, height]: [number, number], where: string): Promise<VideoDecoderConfig> {
  for (const hardwareAcceleration of typeof VideoDecoder === "undefined" ? [] : LADDER) {
    const size = { codedWidth: width, codedHeight: height };
    const config = { codec, ...size, hardwareAcceleration, optimizeForLatency: true };
    const answer = await VideoDecoder.isConfigSupported(config).catch(() => null); // a browser that knows no such codec
    if (answer?.supported) return config;
  }
  throw noDecoder(where);
}

function noDecoder(where: string): SceneError {
  const why = globalThis.isSecureContext ? "decodes no AV1 of 10 bits" : "plays clips from https and localhost only";
  const remedy = globalThis.isSecureContext ? "use a newer browser" : "open the page from there";
  return new SceneError("codec", `This browser ${why}; ${remedy}. The first frame is shown.`, where);
}
