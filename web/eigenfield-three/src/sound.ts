// The sound of a clip, which follows the clock of its frames.

import type { SoundPlace } from "./timeline.js";

const AWAY = 0.3; // seconds of sound off the clock from which on it is sought; below, it plays faster or slower
const NUDGE = 0.2; // by which part, at most
const GAIN = 2; // part of the speed a second that it is off

/** Follows a clock while that goes. Where a page may make no sound yet, it is muted. */
export class Sound {
  private audio: HTMLAudioElement | null = null;
  private loading = false;
  private starting = false;
  private silent = false; // this browser cannot play it
  private mute = false;
  private disposed = false;

  /** `read`: its bytes. `changed`: whether it is muted, or can be played at all, is another. */
  constructor(
    private readonly place: SoundPlace,
    private readonly read: () => Promise<ArrayBuffer>,
    private readonly changed: () => void,
  ) {}

  /** Whether this browser can play it, as far as is known. */
  get playable(): boolean {
    return !this.silent;
  }

  get muted(): boolean {
    return this.mute;
  }

  set muted(on: boolean) {
    this.mute = on;
    if (this.audio) this.audio.muted = on;
    this.changed();
  }

  /** Seconds of the clip at which it is; null: it stands. */
  get time(): number | null {
    return this.audio && !this.audio.paused ? this.audio.currentTime + this.place.first : null;
  }

  /** The clock is at a second of the clip, and goes on at a speed. */
  follow(time: number, speed: number): void {
    const { audio } = this;
    if (!audio) return this.load();
    const due = time - this.place.first;
    if (due < 0 || due >= audio.duration) return audio.pause();
    const off = due - audio.currentTime;
    if (Math.abs(off) > AWAY * Math.max(speed, 1)) {
      if (!audio.seeking) audio.currentTime = due;
    } else {
      audio.playbackRate = speed * (1 + Math.min(Math.max(GAIN * off, -NUDGE), NUDGE));
    }
    if (audio.paused && !this.starting) this.start(audio);
  }

  /** The clock stands. */
  rest(): void {
    this.audio?.pause();
  }

  dispose(): void {
    this.disposed = true;
    this.rest();
    if (this.audio) URL.revokeObjectURL(this.audio.src);
  }

  private load(): void {
    if (this.loading || this.silent) return;
    this.loading = true;
    this.read()
      .then((bytes) => {
        if (this.disposed) return;
        const audio = new Audio(URL.createObjectURL(new Blob([bytes], { type: this.place.mimeType })));
        audio.muted = this.mute;
        audio.addEventListener("loadedmetadata", () => (this.audio = audio));
        audio.addEventListener("error", () => this.fail());
      })
      .catch(() => this.fail());
  }

  private start(audio: HTMLAudioElement): void {
    this.starting = true;
    audio
      .play()
      .catch((reason: unknown) => {
        const refused = reason instanceof DOMException && reason.name === "NotAllowedError";
        if (refused && !this.mute) this.muted = true; // the next call plays on without sound
      })
      .finally(() => (this.starting = false));
  }

  private fail(): void {
    this.silent = true;
    this.audio = null;
    this.changed();
  }
}
