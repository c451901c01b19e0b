export type SceneErrorCode =
  | "not-glb"
  | "truncated"
  | "damaged"
  | "version"
  | "needs"
  | "unsupported"
  | "network"
  | "address" // a file that names another one
  | "codec" // a codec that the browser lacks
  | "codec-unknown"; // one that this viewer does not know

/** What is wrong with a file, for people: one sentence with the remedy. `where` is a JSON pointer or a byte offset. */
export class SceneError extends Error {
  override readonly name = "SceneError";

  constructor(
    readonly code: SceneErrorCode,
    message: string,
    readonly where = "",
    options?: ErrorOptions,
  ) {
    super(message, options);
  }
}

/** Something in the file that cannot be. */
export function damaged(where: string, what: string): SceneError {
  return new SceneError("damaged", `The file is damaged (${where}: ${what}); make or download it again.`, where);
}

/** A file that ends before it should. */
export function truncated(has: number, needed: number): SceneError {
  return new SceneError(
    "truncated",
    `The file is cut off after ${has} of ${needed} bytes; download or copy it again.`,
    String(has),
  );
}

/** A part of the file that ends before it should. */
export function cutOff(where: string): SceneError {
  return new SceneError("truncated", `The file is cut off (${where}); download or copy it again.`, where);
}

/** Whatever was thrown, as an error for people. */
export function asSceneError(reason: unknown, where = ""): SceneError {
  if (reason instanceof SceneError) return reason;
  const text = (reason instanceof Error ? reason.message : String(reason)).replace(/^THREE\.GLTFLoader: /, "");
  return new SceneError("damaged", `The file cannot be read (${text}); make or download it again.`, where, {
    cause: reason,
  });
}
