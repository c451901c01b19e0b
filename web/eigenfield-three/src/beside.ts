// The files of a clip beside its own: each has a group, or the sound, and is handed out as it arrives.

import { Arrival, pour } from "./arrival.js";
import { SceneError, damaged } from "./errors.js";
import { retried } from "./ranges.js";

/** Where the files of a clip's folder are read: the first `length` bytes of one that has `size`. Rejects with a SceneError:
 * `network`, `damaged`, `truncated`, or the reason of a signal. */
export interface Beside {
  read(name: string, size: number, length: number): Promise<ArrayBuffer>;
}

/** Files that somebody brought, by their paths in the folder. */
export function besideHere(files: ReadonlyMap<string, Blob>): Beside {
  const read = async (name: string, size: number, length: number): Promise<ArrayBuffer> => {
    const file = files.get(name);
    if (!file) throw new SceneError("damaged", `The folder has no file ${name}; copy the clip's whole folder.`, name);
    if (file.size !== size) throw damaged(name, `${file.size} bytes of ${size}`);
    return file.slice(0, length).arrayBuffer();
  };
  return { read };
}

/** Files in the folder of a clip that lies on a server. */
export class BesideUrl implements Beside {
  private readonly arriving = new Map<string, Arrival>(); // of which not all was read yet

  /** `scene`: the address of the clip. */
  constructor(
    private readonly scene: string,
    private readonly signal: AbortSignal,
  ) {}

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
