// The real command and the real library, as the tests of finished pages call them.
//
//   EIGENFIELD_PYTHON   the Python that has eigenfield; else python3

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { delimiter } from "node:path";
import { fileURLToPath } from "node:url";

const PYTHON = process.env.EIGENFIELD_PYTHON ?? "python3";

/** Runs `eigenfield` to its end. Returns what it printed. */
export const eigenfield = (...args) => python("-m", "eigenfield", ...args);

export function python(...args) {
  const paths = [fileURLToPath(new URL("../../tests", import.meta.url)), process.env.PYTHONPATH];
  const env = { ...process.env, PYTHONPATH: paths.filter(Boolean).join(delimiter) };
  return execFileSync(PYTHON, args, { encoding: "utf8", env, stdio: ["ignore", "pipe", "inherit"] });
}

/** Starts `eigenfield view`. Returns its address and `stop`: Ctrl-C, then the exit code. */
export async function view(...args) {
  const child = spawn(PYTHON, ["-m", "eigenfield", "view", ...args, "--no-browser"]);
  process.once("exit", () => child.kill()); // a test that failed leaves nothing behind
  const exit = new Promise((resolve) => child.on("exit", (code, signal) => resolve(code ?? signal)));
  let [said, complained] = ["", ""];
  child.stderr.on("data", (data) => (complained += data));
  const address = await new Promise((resolve, reject) => {
    child.stdout.on("data", (data) => {
      said += data;
      const line = /^(http:\S+)\n/.exec(said);
      if (line) resolve(line[1]);
    });
    child.on("error", reject);
    child.on("exit", (code) => reject(new Error(`eigenfield view ended with ${code}: ${complained}`)));
  });
  assert.match(address, /^http:\/\/127\.0\.0\.1:\d+\/$/);
  const stop = () => {
    child.kill("SIGINT");
    return exit;
  };
  return { address, stop };
}
