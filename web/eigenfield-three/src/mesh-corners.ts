// Which vertex of its place each face's corner is, and the charts that vertices form. As mesh_corner_kernels.py.

import { damaged } from "./errors.js";
import { FACES, type Built } from "./mesh-faces.js";
import { type RangeDecoder, binaryDigits } from "./range-decoder.js";

const MOST = 32;
const CHOICES = 4;
const [UNKNOWN, AGREES, CUT, NONE] = [0, 1, 2, 3] as const;
const ASKED = FACES;
const NEW = ASKED + CHOICES * 16 + CHOICES * 3 + 16;
const CHART = NEW + CHOICES + 1;
export const CORNERS = CHART + 4; // contexts so far
const [M_ASKED, M_NEW, M_CHART] = [9, 10, 11] as const;
export const PLAIN = 0;
export const MAPPED = 1;
export const MIRRORED = 2;

export interface Vertices {
  faces: Int32Array;
  place: Int32Array; // of each vertex
  chart: Int32Array; // of each vertex
  kinds: Uint8Array; // of the charts
  maps: Uint32Array; // of each chart the bits of four float32 numbers, and the codes of two offsets
}

/** Corners (3 face + k) at every vertex: those of vertex v from first[v] to first[v + 1]. */
export function cornerLists(faces: Int32Array, vertices: number): { first: Int32Array; corners: Int32Array } {
  const first = new Int32Array(vertices + 1);
  for (const vertex of faces) first[vertex + 1]! += 1;
  for (let vertex = 0; vertex < vertices; vertex++) first[vertex + 1]! += first[vertex]!;
  const at = first.slice();
  const corners = new Int32Array(faces.length);
  faces.forEach((vertex, corner) => (corners[at[vertex]!++] = corner));
  return { first, corners };
}

export function readCorners(
  decoder: RangeDecoder,
  built: Built,
  count: number,
  first: Int32Array,
  corners: Int32Array,
  offsetDigits: number,
  where: string,
): Vertices {
  const faces = built.faces.length / 3;
  const charts = Math.min(faces, Math.floor(count / 3));
  const out: Vertices = {
    faces: new Int32Array(3 * faces),
    place: new Int32Array(count),
    chart: new Int32Array(count),
    kinds: new Uint8Array(charts),
    maps: new Uint32Array(6 * charts),
  };
  const latest = new Int32Array(built.points.length / 3).fill(-1);
  const older = new Int32Array(count);
  const beside = [-1, -1, -1];
  const state: number[] = [0, 0, 0];
  const choice = new Int32Array(CHOICES);
  const support = new Int32Array(2 * CHOICES);
  let [known, made, lastMap] = [0, 0, -1];

  const cornerOf = (face: number, place: number) => {
    for (let k = 0; k < 3; k++) if (built.faces[3 * face + k] === place) return k;
    return -1;
  };
  const across = (face: number, k: number) => {
    const [a, b] = [built.faces[3 * face + k]!, built.faces[3 * face + ((k + 1) % 3)]!];
    for (let i = first[a]!; i < Math.min(first[a + 1]!, first[a]! + MOST); i++) {
      const other = Math.floor(corners[i]! / 3);
      if (other >= face) break;
      if (cornerOf(other, b) >= 0) return other;
    }
    return -1;
  };
  const theirs = (face: number, place: number) => out.faces[3 * face + cornerOf(face, place)]!;

  /** The vertex at corner k; -1 for a new one. */
  const corner = (face: number, k: number) => {
    const place = built.faces[3 * face + k]!;
    let there = latest[place]!;
    if (there < 0) return -1;
    support.fill(NONE);
    let options = 0;
    for (const edge of [k, (k + 2) % 3]) {
      if (beside[edge]! < 0) continue;
      const candidate = theirs(beside[edge]!, place);
      if (options === 1 && choice[0] === candidate) support[1] = state[edge]!;
      else {
        choice[options] = candidate;
        support[2 * options] = state[edge]!;
        options += 1;
      }
    }
    for (let tries = 0; tries < MOST && options < CHOICES && there >= 0; tries++) {
      if ((options < 1 || there !== choice[0]) && (options < 2 || there !== choice[1])) choice[options++] = there;
      there = older[there]!;
    }
    let found = -1;
    for (let j = 0; j < options && found < 0; j++) {
      const [one, two] = [support[2 * j]!, support[2 * j + 1]!];
      const third = ASKED + CHOICES * 19 + Math.min(options, 3) * 4 + one;
      if (decoder.flag(ASKED + j * 16 + one * 4 + two, ASKED + CHOICES * 16 + j * 3 + k, third, M_ASKED))
        found = choice[j]!;
    }
    if (found < 0) {
      if (decoder.flag(NEW + options, NEW + options, NEW + CHOICES, M_NEW)) return -1;
      found = decoder.raw(binaryDigits(known - 1));
      if (found >= known || out.place[found] !== place) throw damaged(where, "a corner that is elsewhere");
    }
    for (const edge of [k, (k + 2) % 3])
      if (beside[edge]! >= 0) state[edge] = theirs(beside[edge]!, place) === found ? AGREES : CUT;
    return found;
  };

  const readChart = () => {
    const chart = made++;
    if (!decoder.flag(CHART, CHART, CHART, M_CHART)) {
      out.kinds[chart] = decoder.flag(CHART + 1, CHART + 1, CHART + 1, M_CHART) ? MIRRORED : PLAIN;
      return chart;
    }
    out.kinds[chart] = MAPPED;
    const last = lastMap;
    lastMap = chart;
    if (last >= 0 && decoder.flag(CHART + 2, CHART + 2, CHART + 2, M_CHART)) {
      const same = decoder.raw(binaryDigits(chart - 1));
      if (same >= chart || out.kinds[same] !== MAPPED) throw damaged(where, "a map that is not there");
      out.maps.copyWithin(6 * chart, 6 * same, 6 * same + 6);
      return chart;
    }
    const linear = last >= 0 && decoder.flag(CHART + 3, CHART + 3, CHART + 3, M_CHART);
    for (let k = 0; k < 4; k++) out.maps[6 * chart + k] = linear ? out.maps[6 * last + k]! : decoder.raw(32);
    for (let k = 4; k < 6; k++) out.maps[6 * chart + k] = decoder.raw(offsetDigits);
    return chart;
  };

  for (let face = 0; face < faces; face++) {
    for (let k = 0; k < 3; k++) {
      beside[k] = across(face, k);
      state[k] = UNKNOWN;
    }
    let chart = -1;
    const fresh: number[] = [];
    for (let k = 0; k < 3; k++) {
      let vertex = corner(face, k);
      if (vertex >= 0) chart = out.chart[vertex]!;
      else {
        if (known >= count) throw damaged(where, "more vertices than announced");
        vertex = known++;
        const place = built.faces[3 * face + k]!;
        out.place[vertex] = place;
        older[vertex] = latest[place]!;
        latest[place] = vertex;
        fresh.push(vertex);
      }
      out.faces[3 * face + k] = vertex;
    }
    if (chart < 0) chart = readChart();
    for (const vertex of fresh) out.chart[vertex] = chart;
  }
  if (known !== count) throw damaged(where, "fewer vertices than announced");
  return out;
}
