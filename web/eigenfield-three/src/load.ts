import { GLTFLoader, type GLTF } from "three/addons/loaders/GLTFLoader.js";
import { refuseAddresses } from "./addresses.js";
import { Arrival } from "./arrival.js";
import { type Beside, besideHere, BesideUrl } from "./beside.js";
import { openContainer, type Container } from "./container.js";
import { isScene } from "./document.js";
import { SceneError, asSceneError } from "./errors.js";
import { EigenField } from "./field.js";
import type { ByteStream, EigenfieldOptions } from "./options.js";
import { EigenfieldPlugin } from "./plugin.js";
import { Ranges } from "./ranges.js";

export interface LoadOptions extends EigenfieldOptions {
  signal?: AbortSignal | undefined;
  onBytes?: ((loaded: number, total: number | undefined) => void) | undefined;
  files?: ReadonlyMap<string, Blob> | undefined; // of a clip's folder, by their paths in it, where no address leads to them
}

export interface Loaded {
  gltf: GLTF;
  field: EigenField | null; // null: a glTF file without eigen textures, or one with an `error`
  error: SceneError | null; // why a clip is shown as other viewers show it
}

/**
 * Loads a scene while it arrives: resolves when mesh and mean can be drawn; eigen textures follow in order, and what
 * goes wrong with them is an `error` event of the field. Rejects with a SceneError, the signal's reason, or a TypeError
 * for what is no source.
 */
export async function loadEigenfield(
  from: string | URL | Blob | ArrayBuffer | ArrayBufferView,
  options: LoadOptions = {},
): Promise<Loaded> {
  const { signal } = options;
  const source = sourceOf(from);
  signal?.throwIfAborted();
  const arrival = new Arrival();
  const [stop, first] = [new AbortController(), new AbortController()]; // of all, and of the first answer alone
  const onAbort = (): void => {
    arrival.fail(new DOMException("The load was stopped.", "AbortError"));
    stop.abort();
  };
  signal?.addEventListener("abort", onAbort);
  stop.signal.addEventListener("abort", () => first.abort());
  const fetching = receive(source, arrival, first.signal, options.onBytes)
    .catch((reason: unknown) => arrival.fail(reason))
    .finally(() => signal?.removeEventListener("abort", onAbort));
  try {
    const container = await openContainer(arrival);
    if (!isScene(container.json)) {
      return { gltf: await parsePlain(arrival, container, fetching), field: null, error: null };
    }
    const ranges = (file: string | Blob): Ranges =>
      new Ranges(file, arrival, container.length, () => first.abort(), stop.signal);
    const far = source instanceof Uint8Array ? arrival : ranges(source);
    const brought = options.files ? besideHere(options.files) : null;
    const beside = typeof source === "string" ? new BesideUrl(source, stop.signal) : brought;
    const gltf = await parseScene(arrival, container, far, beside, options);
    const { eigenfield: made, eigenfieldError: error }: Record<string, unknown> = gltf.userData;
    const field = made instanceof EigenField ? made : null;
    if (signal?.aborted) field?.dispose(); // nobody else would free its textures
    signal?.throwIfAborted();
    return { gltf, field, error: error instanceof SceneError ? error : null };
  } catch (reason) {
    stop.abort();
    signal?.throwIfAborted();
    throw asSceneError(reason);
  }
}

/** What is loaded. A page within another one has classes of its own, and so it is known by its kind. Raises TypeError. */
function sourceOf(from: unknown): string | Blob | Uint8Array<ArrayBuffer> {
  if (typeof from === "string") return from;
  if (ArrayBuffer.isView(from)) return new Uint8Array(from.buffer as ArrayBuffer, from.byteOffset, from.byteLength);
  const kind = Object.prototype.toString.call(from).slice("[object ".length, -1);
  if (kind === "URL") return String(from);
  if (kind === "Blob" || kind === "File") return from as Blob;
  if (kind === "ArrayBuffer") return new Uint8Array(from as ArrayBuffer);
  throw new TypeError("A scene is loaded from an address, a Blob or an ArrayBuffer.");
}

/** `far`: where groups of a clip are read, unless they are files `beside` it; null: of which nothing is known. */
async function parseScene(
  arrival: Arrival,
  container: Container,
  far: Pick<Arrival, "read">,
  beside: Beside | null,
  options: EigenfieldOptions,
): Promise<GLTF> {
  const loader = new GLTFLoader();
  const from = (start: Promise<number>, bytes = far) => async (offset: number, length: number): Promise<ArrayBuffer> => {
    const at = (await start) + offset;
    return bytes.read(at, at + length);
  };
  const start = container.binary();
  start.catch(() => undefined); // reads hear of it
  const readGroups: ByteStream["read"] = (...place) => from(container.groups())(...place);
  const readFile: ByteStream["readFile"] = (...file) => beside?.read(...file) ?? Promise.reject(apart(file[0]));
  const stream: ByteStream = { total: container.length, read: from(start, arrival), readGroups, readFile };
  loader.register((parser) => new EigenfieldPlugin(parser, { ...options, stream }));
  return loader.parseAsync(container.text, "");
}

function apart(name: string): SceneError {
  const message = `The clip is a folder, and its file ${name} cannot be found from here; make one file of it, with \`eigenfield export\`.`;
  return new SceneError("unsupported", message, name);
}

/** A glTF file of another kind: as three.js draws it, once all of it is there. */
async function parsePlain(arrival: Arrival, container: Container, fetching: Promise<void>): Promise<GLTF> {
  await fetching;
  const bytes = await arrival.read(0, container.length);
  try {
    const loader = new GLTFLoader();
    loader.register(refuseAddresses);
    return await loader.parseAsync(bytes, "");
  } catch (reason) {
    if (reason instanceof SceneError) throw reason;
    const text = asSceneError(reason).message;
    throw new SceneError("unsupported", `${text} It has no eigen textures either.`, "", { cause: reason });
  }
}

async function receive(
  source: string | Blob | Uint8Array<ArrayBuffer>,
  arrival: Arrival,
  signal: AbortSignal,
  onBytes: LoadOptions["onBytes"],
): Promise<void> {
  if (source instanceof Uint8Array) {
    arrival.push(source);
    onBytes?.(source.length, source.length);
    return arrival.end();
  }
  const { body, total } = typeof source === "string" ? await open(source, signal) : openBlob(source);
  const reader = body.getReader();
  signal.addEventListener("abort", () => void reader.cancel().catch(() => undefined));
  for (;;) {
    const { done, value } = await reader.read().catch((reason: unknown) => {
      throw signal.aborted ? reason : broken(arrival.received, reason);
    });
    if (done) break;
    arrival.push(value);
    onBytes?.(arrival.received, total);
  }
  signal.throwIfAborted();
  arrival.end();
}

interface Opened {
  body: ReadableStream<Uint8Array>;
  total: number | undefined; // bytes, if known
}

function openBlob(blob: Blob): Opened {
  return { body: blob.stream(), total: blob.size };
}

async function open(url: string, signal: AbortSignal): Promise<Opened> {
  const response = await fetch(url, { signal }).catch((cause: unknown) => {
    if (signal.aborted) throw cause;
    const message = "The scene cannot be fetched; check its address and the connection.";
    throw new SceneError("network", message, url, { cause });
  });
  if (!response.ok || !response.body) {
    await response.body?.cancel();
    const message = `The server answered ${response.status} for the scene; check its address.`;
    throw new SceneError("network", message, url);
  }
  const length = response.headers.get("Content-Encoding") ? null : response.headers.get("Content-Length");
  return { body: response.body, total: length && /^\d+$/.test(length) ? Number(length) : undefined };
}

function broken(received: number, cause: unknown): SceneError {
  const message = `The connection broke after ${received} bytes of the scene; load it again.`;
  return new SceneError("network", message, String(received), { cause });
}
