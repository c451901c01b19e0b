// The files of a clip beside its own: each has a group, or the sound, and is handed out as it arrives.

import { Arrival, pour } from "./arrival.js";
import { SceneError, damaged } from "./errors.js";
import { retried } from "./ranges.js";

/** Files in the folder of a clip that lies on a server. */
export class Beside {
  private readonly arriving = new Map<string, Arrival>(); // of which not all was read yet

  /** `scene`: the address of the clip. */
  constructor(
    private readonly scene: string,
    private readonly signal: AbortSignal,
  ) {}

  /** The first `length` bytes of a file that has `size`. Rejects with a SceneError: `network`, `damaged`, `truncated`, or
   * the signal's reason. */
  read(name: string, size: number, length: number): Promise<ArrayBuffer> {
    return retried(this.signal, async () => {
      const arrival = this.arriving.get(name) ?? this.fetch(name, size);
      try {
        const bytes = await arrival.read(0, length);
        if (length === size) this.arriving.delete(name);
        return bytes;
      } catch (reason) {
        this.arriving.delete(name);
        throw reason;
      }
    });
  }

  private fetch(name: string, size: number): Arrival {
    const arrival = new Arrival();
    this.arriving.set(name, arrival);
    this.receive(name, size, arrival).catch((reason: unknown) => {
      arrival.fail(this.signal.aborted || reason instanceof SceneError ? reason : broken(name, reason));
    });
    return arrival;
  }

  private async receive(name: string, size: number, arrival: Arrival): Promise<void> {
    const url = new URL(name, new URL(this.scene, document.baseURI));
    const { ok, status, headers, body } = await fetch(url, { signal: this.signal });
    const found = headers.get("Content-Encoding") ? null : headers.get("Content-Length");
    const other = ok && found !== null && Number(found) !== size;
    if (ok && body && !other) return pour(body, arrival, this.signal);
    await body?.cancel();
    throw other ? damaged(name, `${found} bytes of ${size}`) : broken(name, `The server answered ${status}`);
  }
}

function broken(name: string, cause: unknown): SceneError {
  const message = `The clip's file ${name} cannot be fetched; put it beside the clip's own. It is tried again when it plays on.`;
  return new SceneError("network", message, name, { cause });
}
