// Values of a JSON document with the place they stand at, so that each refusal can name it.

import { damaged } from "./errors.js";
import { MAX_NUMBER } from "./limits.js";

export type Json = null | boolean | number | string | Json[] | JsonObject;
export interface JsonObject {
  [key: string]: Json | undefined;
}

type Keys<T> = T extends readonly unknown[] ? never : T extends object ? keyof T & string : never;
type Member<T, K> = T extends object ? (K extends keyof T ? NonNullable<T[K]> : never) : never;
type Item<T> = T extends readonly (infer Each)[] ? Each : never;
type KeyOf<T> = unknown extends T ? string : Keys<T>;
type MemberOf<T, K> = unknown extends T ? unknown : Member<T, K>;
type ItemOf<T> = unknown extends T ? unknown : Item<T>;

/**
 * A value and its JSON pointer. T is its type by the schema, `unknown` where no schema of ours has it. The compiler
 * checks the names of keys by T; the value itself may be anything until a method has checked it.
 */
export class Value<T = unknown> {
  constructor(
    readonly raw: Json | undefined,
    readonly where: string,
  ) {}

  get exists(): boolean {
    return this.raw !== undefined;
  }

  object(): JsonObject {
    if (this.raw === null || typeof this.raw !== "object" || Array.isArray(this.raw)) throw this.wrong("no object");
    return this.raw;
  }

  key<K extends KeyOf<T>>(name: K): Value<MemberOf<T, K>> {
    const object = this.object();
    const found = Object.hasOwn(object, name) ? object[name] : undefined;
    return new Value(found, `${this.where}/${name}`);
  }

  items(most: number): Value<ItemOf<T>>[] {
    if (!Array.isArray(this.raw)) throw this.wrong("no list");
    if (this.raw.length > most) throw this.wrong(`more than ${most} entries`);
    return this.raw.map((item, index) => new Value(item, `${this.where}/${index}`));
  }

  at(index: number): Value<ItemOf<T>> {
    if (!Array.isArray(this.raw)) throw this.wrong("no list");
    return new Value(this.raw[index], `${this.where}/${index}`);
  }

  text(longest: number): string {
    if (typeof this.raw !== "string") throw this.wrong("no text");
    if (this.raw.length > longest) throw this.wrong(`longer than ${longest} characters`);
    return this.raw;
  }

  number(low = -MAX_NUMBER, high = MAX_NUMBER): number {
    if (typeof this.raw !== "number") throw this.wrong("no number");
    if (!(this.raw >= low && this.raw <= high)) throw this.wrong(`${this.raw} is not in ${low}..${high}`);
    return this.raw;
  }

  integer(low: number, high: number): number {
    const value = this.number(low, high);
    if (!Number.isInteger(value)) throw this.wrong(`${value} is no whole number`);
    return value;
  }

  numbers(count: number, low = -MAX_NUMBER, high = MAX_NUMBER): number[] {
    const items = this.items(count);
    if (items.length !== count) throw this.wrong(`${count} numbers are needed`);
    return items.map((item) => item.number(low, high));
  }

  triple(): [number, number, number] {
    const [a = 0, b = 0, c = 0] = this.numbers(3);
    return [a, b, c];
  }

  wrong(what: string): Error {
    return damaged(this.where || "/", this.exists ? what : "missing");
  }
}
