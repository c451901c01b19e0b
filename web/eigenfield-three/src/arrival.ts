// Bytes that arrive: kept as they come, handed out when they are there. Nothing is allocated ahead of them.

import { truncated } from "./errors.js";

interface Waiter {
  from: number;
  to: number;
  resolve: (bytes: ArrayBuffer) => void;
  reject: (reason: unknown) => void;
}

export class Arrival {
  received = 0;
  onPush: () => void = () => undefined; // after bytes came
  private readonly chunks: { start: number; bytes: Uint8Array }[] = [];
  private waiters: Waiter[] = [];
  private ended = false;
  private broken: { reason: unknown } | null = null;

  /** Bytes `from`..`to`, once they are there. Rejects if they will not come: SceneError `truncated`, or why not. */
  read(from: number, to: number): Promise<ArrayBuffer> {
    const promise = new Promise<ArrayBuffer>((resolve, reject) => {
      this.waiters.push({ from, to, resolve, reject });
    });
    promise.catch(() => undefined); // whoever waits hears of it; nobody has to
    this.settle();
    return promise;
  }

  push(bytes: Uint8Array): void {
    if (!bytes.length) return;
    this.chunks.push({ start: this.received, bytes });
    this.received += bytes.length;
    this.settle();
    this.onPush();
  }

  end(): void {
    this.ended = true;
    this.settle();
  }

  fail(reason: unknown): void {
    this.broken ??= { reason };
    this.settle();
  }

  private settle(): void {
    const waiting: Waiter[] = [];
    for (const waiter of this.waiters) {
      if (waiter.to <= this.received) waiter.resolve(this.copy(waiter.from, waiter.to));
      else if (this.broken) waiter.reject(this.broken.reason);
      else if (this.ended) waiter.reject(truncated(this.received, waiter.to));
      else waiting.push(waiter);
    }
    this.waiters = waiting;
  }

  private copy(from: number, to: number): ArrayBuffer {
    const out = new Uint8Array(to - from);
    for (const { start, bytes } of this.chunks) {
      if (start >= to || start + bytes.length <= from) continue;
      const part = bytes.subarray(Math.max(0, from - start), Math.min(bytes.length, to - start));
      out.set(part, Math.max(0, start - from));
    }
    return out.buffer;
  }
}

/** Pushes all of a body, and ends. Rejects as reading it does, or with the signal's reason. */
export async function pour(body: ReadableStream<Uint8Array>, arrival: Arrival, signal: AbortSignal): Promise<void> {
  const reader = body.getReader();
  signal.addEventListener("abort", () => void reader.cancel().catch(() => undefined));
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    arrival.push(value);
  }
  signal.throwIfAborted();
  arrival.end();
}
