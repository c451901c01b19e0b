import { BufferAttribute as e, BufferGeometry as t, Camera as n, ClampToEdgeWrapping as r, Color as i, CustomBlending as a, DataArrayTexture as o, DataUtils as s, DoubleSide as c, EventDispatcher as l, ExternalTexture as u, FrontSide as d, GLSL3 as f, HalfFloatType as p, InstancedBufferGeometry as m, LinearFilter as h, LinearMipmapLinearFilter as g, Matrix4 as _, Mesh as v, MeshBasicMaterial as y, NearestFilter as b, NoBlending as x, OneFactor as ee, RGBAFormat as te, RawShaderMaterial as S, Scene as C, Sphere as w, Vector2 as ne, Vector3 as T, Vector4 as re, WebGLRenderTarget as ie } from "three";
import { GLTFLoader as ae } from "three/addons/loaders/GLTFLoader.js";
// eigenfield-three/src/errors.ts
var E = class extends Error {
	code;
	where;
	name = "SceneError";
	constructor(e, t, n = "", r) {
		super(t, r), this.code = e, this.where = n;
	}
};
function D(e, t) {
	return new E("damaged", `The file is damaged (${e}: ${t}); make or download it again.`, e);
}
function oe(e, t) {
	return new E("truncated", `The file is cut off after ${e} of ${t} bytes; download or copy it again.`, String(e));
}
function se(e, t = "") {
	return e instanceof E ? e : new E("damaged", `The file cannot be read (${(e instanceof Error ? e.message : String(e)).replace(/^THREE\.GLTFLoader: /, "")}); make or download it again.`, t, { cause: e });
}
// eigenfield-three/src/limits.ts
var ce = "EIGENFIELD_eigen_textures", le = /* @__PURE__ */ new Set([
	"toRGB",
	"regions",
	"stacks"
]), ue = 64 * 2 ** 20, O = 16384, de = 16384, k = 2 ** 27, A = 4096, fe = 8 * 2 ** 30, pe = 1e5, me = 2 ** 29, j = 1024, he = 2 ** 26, ge = 2 ** 27, _e = 2 ** 28, M = 1e30;
// eigenfield-three/src/info.ts
async function N(e, t, n) {
	let r = await n(e.view), i = t.views[e.view]?.length ?? Infinity;
	if (r.byteLength < i) throw ve(e.where);
	let a = e.count * e.items, o = r.slice(e.offset, e.offset + 4 * a);
	if (e.type === 5125) return new Uint32Array(o);
	let s = new Float32Array(o);
	for (let t of s) if (!(Math.abs(t) <= 1e30)) throw D(e.where, `${t} among its numbers`);
	return s;
}
function ve(e) {
	return new E("truncated", `The file is cut off (${e}); download or copy it again.`, e);
}
async function ye(e, t) {
	let [n, r, i, a] = await Promise.all([
		N(e.intrinsics, e, t),
		N(e.poses, e, t),
		N(e.sizes, e, t),
		e.colour ? N(e.colour, e, t) : null
	]);
	return e.names.map((t, o) => {
		let [s = 0, c = 0, l = 0, u = 0, d = 0] = n.subarray(5 * o, 5 * o + 5);
		if (!(s > 0 && c > 0)) throw D(e.intrinsics.where, `focal lengths of "${t}"`);
		let { R: f, t: p } = be([...r.subarray(12 * o, 12 * o + 12)], e.poses.where, t), [m = 0, h = 0] = i.subarray(2 * o, 2 * o + 2);
		if (!m || !h || Math.max(m, h) > 65535 || m * h > me) throw D(e.sizes.where, `"${t}" is ${m} x ${h} pixels`);
		let g = [
			[
				s,
				l,
				u
			],
			[
				0,
				c,
				d
			],
			[
				0,
				0,
				1
			]
		], [_, v] = a ? xe([...a.subarray(6 * o, 6 * o + 6)], e, t) : [null, null];
		return {
			name: t,
			K: g,
			R: f,
			t: p,
			centre: Oe(f, p),
			width: m,
			height: h,
			gain: _,
			offset: v
		};
	});
}
function be(e, t, n) {
	let r = (t) => [
		e[4 * t] ?? NaN,
		e[4 * t + 1] ?? NaN,
		e[4 * t + 2] ?? NaN
	], i = [
		r(0),
		r(1),
		r(2)
	], a = [
		e[3] ?? NaN,
		e[7] ?? NaN,
		e[11] ?? NaN
	];
	for (let e = 0; e < 3; e++) for (let r = e; r < 3; r++) {
		let a = I(i[e], i[r]) - +(e === r);
		if (!(Math.abs(a) <= 2e-4)) throw D(t, `the pose of "${n}" is no rotation`);
	}
	if (!(I(L(i[0], i[1]), i[2]) > 0)) throw D(t, `the pose of "${n}" is mirrored`);
	return {
		R: i,
		t: a
	};
}
function xe(e, t, n) {
	let [r, i] = [e.slice(0, 3), e.slice(3)];
	if (!(r.every((e) => e >= 1 / 1e3 && e <= 1e3) && i.every((e) => Math.abs(e) <= 1e3))) throw D(t.colour?.where ?? "", `gain or offset of "${n}"`);
	return [r, i];
}
async function Se(e, t) {
	let n = P(e), r = n.flatMap(({ weights: e }) => e ? [e] : []), i = await Promise.all(r.map((n) => N(n, e, t))), a = e.heldOut.filter((e) => !e).length, o = n.reduce((e, { count: t }) => e + t, 0), s = new Float32Array(a * o), c = 0;
	for (let e of i) {
		let t = e.length / a;
		for (let n = 0; n < a; n++) s.set(e.subarray(n * t, (n + 1) * t), n * o + c);
		c += t;
	}
	return s;
}
function P(e) {
	return e.planes.flatMap(({ bases: e }) => e);
}
function Ce(e) {
	return Math.max(0, ...P(e).map(({ count: e }) => e));
}
function we(e, t) {
	let n = [...t, ...P(e).map(({ grid: e }) => e)];
	return [Math.max(...n.map(([e]) => e)), Math.max(...n.map(([, e]) => e))];
}
async function Te(e, t) {
	if (!e.triangles) return /* @__PURE__ */ new Uint32Array();
	let { where: n } = e.triangles, r = Uint32Array.from(await N(e.triangles, e, t)), i = e.heldOut.filter((e) => !e).length;
	for (let e = 0; e < r.length; e += 3) {
		let [t = i, a = i, o = i] = r.subarray(e, e + 3);
		if (Math.max(t, a, o) >= i) throw D(n, `no encoded camera ${Math.max(t, a, o)}`);
		if (t === a || a === o || o === t) throw D(n, "a triangle with one camera twice");
	}
	return r;
}
function Ee(e, t, n, r, i) {
	let { right: a, up: o } = e, s = L(a, o), c = [
		0,
		0,
		0
	];
	for (let { R: e } of t) for (let n = 0; n < 3; n++) c[n] += e[2][n] / t.length;
	let l = e.settings.metresPerUnit;
	return {
		version: e.version,
		generator: e.generator,
		names: e.names,
		heldOut: e.heldOut,
		reference: e.reference,
		cameras: t,
		viewPlane: {
			origin: e.origin,
			right: a,
			up: o,
			normal: s,
			extent: e.extent
		},
		grid: r && {
			rows: r.rows,
			columns: r.columns
		},
		settings: e.settings,
		scores: e.scores,
		metresPerUnit: typeof l == "number" && l > 0 && l <= 1e30 ? l : null,
		bytes: De(e, i),
		size: we(e, n),
		planes: e.planes.map(({ channels: e, bases: t }, r) => ({
			channels: e,
			mean: n[r] ?? [1, 1],
			bases: t.map(({ count: e, size: t, grid: n }) => ({
				textures: e,
				size: t,
				grid: n
			}))
		})),
		vertices: e.position.count,
		triangles: e.indices.count / 3,
		facesPlane: Math.abs(I(c, s)) > .7
	};
}
function De(e, t) {
	let n = /* @__PURE__ */ new Set(), r = (t) => n.has(t) ? 0 : (n.add(t), e.views[t]?.length ?? 0), i = (e) => e.reduce((e, t) => e + r(t), 0), a = e.planes.map((e) => e.mean.view), o = i(e.preview === null ? a : [e.preview, ...a]), s = Array(Ce(e)).fill(0);
	for (let { pictures: t } of P(e)) {
		let e = 0;
		for (let { view: n, textures: i } of t) {
			let t = r(n);
			for (let n = 0; n < i; n++) {
				let r = Math.floor(t * (n + 1) / i) - Math.floor(t * n / i);
				s[e] = (s[e++] ?? 0) + r;
			}
		}
	}
	let c = i(P(e).flatMap((e) => e.weights ? [e.weights.view] : [])), l = i([
		e.position.view,
		e.uv.view,
		e.indices.view
	]);
	return {
		total: t,
		mesh: l,
		mean: o,
		weights: c,
		other: t - o - c - l - s.reduce((e, t) => e + t, 0),
		textures: s
	};
}
function F(e, t) {
	let { origin: n, extent: r } = e, i = [
		t[0] - n[0],
		t[1] - n[1],
		t[2] - n[2]
	];
	return [r[0] > 0 ? I(i, e.right) / r[0] : 0, r[1] > 0 ? I(i, e.up) / r[1] : 0];
}
function Oe(e, t) {
	let n = (n) => -(e[0][n] * t[0] + e[1][n] * t[1] + e[2][n] * t[2]);
	return [
		n(0),
		n(1),
		n(2)
	];
}
function I(e, t) {
	return e[0] * t[0] + e[1] * t[1] + e[2] * t[2];
}
function L(e, t) {
	return [
		e[1] * t[2] - e[2] * t[1],
		e[2] * t[0] - e[0] * t[2],
		e[0] * t[1] - e[1] * t[0]
	];
}
// eigenfield-three/src/cameras.ts
function ke(e, t, n) {
	let { info: r } = e, i = r.cameras.filter((e, t) => !r.heldOut[t]), a = r.cameras[r.reference];
	if (!a) throw RangeError(`no camera ${r.reference}`);
	let { width: o, height: s } = a, c = [
		[
			0,
			0,
			0
		],
		[
			0,
			0,
			0
		],
		[
			0,
			0,
			1
		]
	], l = [
		[
			0,
			0,
			0
		],
		[
			0,
			0,
			0
		],
		[
			0,
			0,
			0
		]
	];
	e.viewWeights(t, n, "delaunay").forEach((e, t) => {
		let n = i[t];
		if (!e || !n) return;
		let r = Ae(n, o, s);
		for (let t of [
			0,
			1,
			2
		]) for (let i of [
			0,
			1,
			2
		]) t < 2 && (c[t][i] += e * r[t][i]), l[t][i] += e * n.R[t][i];
	});
	let u = Me(l), { origin: d, right: f, up: p, extent: m } = r.viewPlane, [h, g] = [je(t) * m[0], je(n) * m[1]], _ = [
		0,
		1,
		2
	].map((e) => d[e] + h * f[e] + g * p[e]), v = u.map((e) => -I(e, _));
	return {
		name: `${t.toFixed(3)}, ${n.toFixed(3)}`,
		K: c,
		R: u,
		t: v,
		centre: _,
		width: o,
		height: s,
		gain: null,
		offset: null
	};
}
function Ae({ K: e, width: t, height: n }, r, i) {
	let a = Math.max(r / t, i / n), [o, s] = [(r - a * t) / 2, (i - a * n) / 2];
	return [
		[
			a * e[0][0],
			a * e[0][1],
			a * e[0][2] + o
		],
		[
			0,
			a * e[1][1],
			a * e[1][2] + s
		],
		[
			0,
			0,
			1
		]
	];
}
function je(e) {
	return Math.min(1, Math.max(-1, e));
}
function Me(e) {
	let t = e;
	for (let e = 0; e < 50; e++) {
		let e = [
			L(t[1], t[2]),
			L(t[2], t[0]),
			L(t[0], t[1])
		], n = I(t[0], e[0]);
		if (!(n > 1e-12)) break;
		let r = t.map((t, r) => t.map((t, i) => (t + e[r][i] / n) / 2)), i = Math.max(...r.flatMap((e, n) => e.map((e, r) => Math.abs(e - t[n][r]))));
		if (t = r, i < 1e-15) break;
	}
	return t;
}
function Ne(e, t, n, r, i = 1) {
	let a = n.width / n.height, o = i * Math.min(1, a / r), s = i * Math.min(1, r / a), c = {
		left: (1 - o) / 2,
		top: (1 - s) / 2,
		width: o,
		height: s
	};
	return Pe(e, t, n), Fe(e, t, n, c), t.aspect = r, t.fov = 2 * Math.atan(n.height / (2 * n.K[1][1] * s)) * 180 / Math.PI, c;
}
function Pe(e, t, n) {
	let { R: r, centre: i } = n, a = new _().set(r[0][0], -r[1][0], -r[2][0], i[0], r[0][1], -r[1][1], -r[2][1], i[1], r[0][2], -r[1][2], -r[2][2], i[2], 0, 0, 0, 1);
	e.mesh.updateWorldMatrix(!0, !1), a.premultiply(e.mesh.matrixWorld), t.parent && (t.parent.updateWorldMatrix(!0, !1), a.premultiply(t.parent.matrixWorld.clone().invert())), a.decompose(t.position, t.quaternion, new T()), t.updateMatrixWorld(!0);
}
function Fe(e, t, n, r) {
	let [[i, a, o], [, s, c]] = n.K, [l, u] = [2 * r.width / n.width, 2 * r.height / n.height], [d, f] = Ie(e, n);
	t.near = d, t.far = f, t.projectionMatrix.set(l * i, -l * a, -(2 * r.left - 1 + l * o), 0, 0, u * s, -(1 - 2 * r.top - u * c), 0, 0, 0, -(f + d) / (f - d), -2 * f * d / (f - d), 0, 0, -1, 0), t.projectionMatrixInverse.copy(t.projectionMatrix).invert();
}
function Ie(e, t) {
	let { geometry: n, matrixWorld: r } = e.mesh;
	n.boundingSphere || n.computeBoundingSphere();
	let { center: i, radius: a } = n.boundingSphere ?? {
		center: new T(),
		radius: 1
	}, o = r.getMaxScaleOnAxis(), s = i.distanceTo(new T(...t.centre)) * o, c = 1.01 * (s + a * o);
	return [Math.max(.5 * (s - a * o), c * 2e-4), c];
}
// eigenfield-three/src/footprint.ts
var Le = 256;
function Re(e, t, n) {
	let { index: r } = e, i = e.getAttribute("position"), a = e.getAttribute("uv");
	if (!r || !i || !a) return 0;
	let o = r.count / 3, s = Math.max(1, Math.floor(o / Le)), c = [];
	for (let e = 0; e < o; e += s) {
		let o = [
			0,
			1,
			2
		].map((t) => r.getX(3 * e + t)), s = o.map((e) => ze(t, i.getX(e), i.getY(e), i.getZ(e))), l = Be(s), [u = NaN, d = NaN] = [0, 1].map((e) => s.reduce((t, n) => t + (n[e] ?? NaN) / 3, 0));
		if (!(l > 0 && u >= 0 && d >= 0 && u < t.width && d < t.height)) continue;
		let f = Be(o.map((e) => [a.getX(e) * n[0], a.getY(e) * n[1]]));
		c.push({
			footprint: Math.sqrt(f / l),
			area: l
		});
	}
	c.sort((e, t) => e.footprint - t.footprint);
	let l = c.reduce((e, { area: t }) => e + t, 0) / 2, u = 0;
	return c.find(({ area: e }) => (u += e) >= l)?.footprint ?? 0;
}
function ze({ K: e, R: t, t: n }, r, i, a) {
	let o = (e) => t[e][0] * r + t[e][1] * i + t[e][2] * a + n[e], [s, c, l] = [
		o(0),
		o(1),
		o(2)
	];
	return l > 0 ? [(e[0][0] * s + e[0][1] * c) / l + e[0][2], e[1][1] * c / l + e[1][2]] : [NaN, NaN];
}
function Be(e) {
	let [[t = 0, n = 0] = [], [r = 0, i = 0] = [], [a = 0, o = 0] = []] = e;
	return Math.abs((r - t) * (o - n) - (i - n) * (a - t)) / 2;
}
// eigenfield-three/src/memory.ts
var Ve = 4 / 3, He = 4, Ue = 8, We = 2 ** 20;
function Ge() {
	let e = typeof navigator > "u" ? void 0 : navigator, t = e?.deviceMemory, n = e?.userAgent ?? "";
	return /Mobi|Android|iPhone|iPad|Quest/i.test(n) || /Macintosh/.test(n) && Ke(e) ? Math.min(t ?? 4, 6) * 128 * We : Math.min(t ?? 8, 8) * 256 * We;
}
function Ke(e) {
	return (e?.maxTouchPoints ?? 0) > 1;
}
function R([e, t], n) {
	return [Math.ceil(e / n), Math.ceil(t / n)];
}
function qe(e, t) {
	let [n, r] = R(e, t);
	return n * r;
}
function Je(e) {
	return Math.ceil(e / 4);
}
function Ye(e, t) {
	return t * z(e);
}
function z(e) {
	return Math.max(1, Math.ceil(e / 4));
}
function Xe({ atlas: e, means: t, bases: n }) {
	let r = [
		e,
		...t.map(({ size: e }) => e),
		...n.map(({ grid: e }) => e)
	];
	return [...new Map(r.map((e) => [e.join(), e])).values()];
}
function Ze(e, t) {
	let n = Math.max(0, ...e.bases.map(({ count: e }) => e)), r = Math.max(1, ...e.bases.map((e) => e.channels)), i = Math.min(n, 4 * Math.floor(t.layers / r)), a = [
		1,
		2,
		4,
		8,
		16
	].find((n) => Math.max(...e.atlas) / n <= t.side && Qe(e, n) <= t.memory / 2) ?? 16, o = Qe(e, a) + e.geometry, s = (t, n) => o + $e(e, t, n), c = (n, r) => s(n, r) + tt(e, n) <= t.memory, l = Math.max(1, ...e.bases.flatMap(({ size: e }) => e)), u = (e) => l / e <= t.side, d = [
		1,
		2,
		4
	].find((e) => u(e) && c(e, i)) ?? 4, f = u(d) ? i : 0;
	for (; f > 0 && !c(d, f);) f--;
	let p = {
		meanDown: a,
		scaleDown: d,
		usable: f,
		bytes: s(d, f)
	};
	return {
		...p,
		limitation: nt(p, n, e, t)
	};
}
function Qe(e, t) {
	let n = e.means.map(({ size: e, channels: n }) => He * Je(n) * qe(e, t)), r = Xe(e).map((n) => {
		let r = n.join() === e.atlas.join() ? Ve : 1, i = e.rays && e.bases.some(({ grid: e }) => e.join() === n.join());
		return Ue * qe(n, t) * (r + +!!i);
	});
	return Math.round([...n, ...r].reduce((e, t) => e + t, 0));
}
function $e({ bases: e, rays: t }, n, r) {
	return e.reduce((e, i) => {
		let a = Math.min(r, i.count);
		if (!a) return e;
		let o = t ? z(a) * 129 * 129 * Ue : 0;
		return e + He * Ye(a, i.channels) * qe(i.size, n) + o;
	}, 0);
}
function et({ means: e, bases: t }, n, r) {
	let i = [...e.filter(({ channels: e }) => e !== 1 && e !== 3).map(({ size: e }) => R(e, n)), ...t.filter(({ count: e }) => e > 0).map(({ size: e }) => R(e, r))];
	return [Math.max(1, ...i.map(([e]) => e)), Math.max(1, ...i.map(([, e]) => e))];
}
function tt(e, t) {
	let [n, r] = et({
		means: [],
		bases: e.bases
	}, 1, t);
	return He * n * r;
}
function nt(e, t, n, r) {
	let i = [];
	if (e.usable < t && i.push(`${e.usable} of ${t} eigen textures are drawn`), e.usable && e.scaleDown > 1 && i.push(`eigen textures have 1/${e.scaleDown} of their size`), e.meanDown > 1 && i.push(`the mean texture has 1/${e.meanDown} of its size`), !i.length) return null;
	let a = Qe(n, 1) + $e(n, 1, t) + tt(n, 1) + n.geometry, o = a > r.memory ? `the scene needs ${rt(a)} MB of graphics memory and ${rt(r.memory)} MB may be used` : "this device's graphics allow no more";
	return `${it(i.join(", "))}: ${o}.`;
}
function rt(e) {
	return (e / 1e6).toFixed(+(e < 1e7));
}
function it(e) {
	return e.charAt(0).toUpperCase() + e.slice(1);
}
// ../src/eigenfield/rendering/shaders/compose.glsl?raw
var at = "// Equations 7 and 8, texel by texel: means and eigen textures, weighted and summed into one texture of the whole atlas,\n// which surface.glsl then draws (decision 15).\n//\n// This body is compiled as GLSL 3.30 by eigenfield/rendering/composer.py and as GLSL ES 3.00 by the web viewer. Whoever\n// includes it writes the #version line, the precisions, cubic.glsl before it, and a main for each of three passes. All\n// draw into textures whose row 0 is v = 0, and the second and third add to what is there:\n//   placeOf       once, the mesh laid out by its texture coordinates: where each texel lies\n//   sumTextures   for each mean and basis, a rectangle of a grid: its textures, weighted, as R, G, B\n//   finerValue    for each grid coarser than the atlas, all of the atlas: what the grid holds there\n// Four numbers share a texel of what is stored: one channel of four eigen textures (decision 13), or four channels of a\n// mean. Colours are the photographs' own (sRGB-coded) numbers from end to end: no conversion, in or out.\n\n#define LAYERS 64  // most that one draw sums\n#define LEVEL 1e-4 // a height of no more than this is as good as none\n#define MOST 6e4   // halves end at 65504\n\nuniform sampler2DArray stored; // codes / 255, or values; anything finite where there is no texture (yet)\nuniform int firstLayer;\nuniform int sharing;           // 1: each of `entries` has a layer; 4: four channels of a mean share one\nuniform int channels;\nuniform int entries;           // entry e is channel e % channels, of group e / channels; at most LAYERS\nuniform vec4 scale[LAYERS];    // value = stored * scale + bias, of each entry: 0 for textures that are not summed\nuniform vec4 bias[LAYERS];\nuniform vec3 colours[LAYERS];  // R, G, B of the value 1 of each channel\n\nuniform bool rayWeights;       // look weights up where the ray to the eye meets the view plane; else they are in `scale`\nuniform sampler2DArray weightMaps; // layer g: weights 4 g .. 4 g + 3 over X, Y in -1..1, nodes on the edges\nuniform int firstGroup;\nuniform sampler2D places;      // of each texel that is drawn, as `placeOf` makes them; w is 0 where there is no surface\nuniform vec3 eye;              // X, Y and height above the view plane\n\nuniform sampler2D coarse;      // a grid's sum\n\n// A point of the surface, given as X, Y and height above the view plane, as it is seen from the plane: X, Y and 1 over\n// the height. Halves keep that well enough for points near and far.\nvec4 placeOf(vec3 point) {\n  float height = point.z < 0.0 ? min(point.z, -LEVEL) : max(point.z, LEVEL);\n  return vec4(clamp(vec3(point.xy, 1.0) / height, -MOST, MOST), 1.0);\n}\n\n// Where the ray from a point of the surface to the eye meets the view plane, as X, Y; where it does not (the eye is\n// level with the point, or the point lies behind the cameras) and where there is no surface, where the eye itself stands.\nvec2 viewCoordinates(vec4 place) {\n  float part = 1.0 - eye.z * place.z;\n  bool meets = place.w > 0.0 && part > 1e-5;\n  return clamp(meets ? (eye.xy - eye.z * place.xy) / part : eye.xy, -1.0, 1.0);\n}\n\n// The sum of a mean's or a basis's textures at `own` texture coordinates of theirs, as R, G, B.\nvec3 sumTextures(vec2 own) {\n  vec2 nodes = vec2(textureSize(weightMaps, 0).xy);\n  vec2 view = rayWeights ? viewCoordinates(texelFetch(places, ivec2(gl_FragCoord.xy), 0)) : vec2(0.0);\n  vec2 at = (0.5 + (0.5 + 0.5 * view) * (nodes - 1.0)) / nodes;\n  vec4 weights = vec4(1.0);\n  vec3 sum = vec3(0.0);\n  int entry = 0;\n  for (int group = firstGroup; entry < entries; group++) {\n    if (rayWeights) weights = textureLod(weightMaps, vec3(at, float(group)), 0.0);\n    for (int channel = 0; channel < channels; channel++) {\n      vec4 four = textureLod(stored, vec3(own, float(firstLayer + entry / sharing)), 0.0) * scale[entry] + bias[entry];\n      sum += colours[channel] * dot(weights, four);\n      entry++;\n    }\n  }\n  return sum;\n}\n\n// The value of the grid `coarse` at texture coordinates of the atlas.\nvec3 finerValue(vec2 uv) { return readCubic(coarse, uv * vec2(textureSize(coarse, 0)) - 0.5); }\n", ot = "// Weights of the texels -1, 0, 1 and 2 for a place between texels 0 and 1: Catmull-Rom, a = -1/2.\nvec4 catmullRom(float f) {\n  float f2 = f * f, f3 = f2 * f;\n  return 0.5 * vec4(2.0 * f2 - f3 - f, 3.0 * f3 - 5.0 * f2 + 2.0, 4.0 * f2 - 3.0 * f3 + f, f3 - f2);\n}\n\n// A texture's finest level at `texel`, whole at texel centres, taps clamped to the border. Sixteen texels are read one\n// by one: nine bilinear reads between them take longer where no hardware filters, and hardware keeps 8 bits of a weight.\nvec3 readCubic(sampler2D source, vec2 texel) {\n  ivec2 last = textureSize(source, 0) - 1;\n  ivec2 base = ivec2(floor(texel));\n  vec2 f = texel - vec2(base);\n  vec4 across = catmullRom(f.x), down = catmullRom(f.y);\n  vec3 sum = vec3(0.0);\n  for (int row = 0; row < 4; row++) {\n    vec3 line = vec3(0.0);\n    for (int column = 0; column < 4; column++) {\n      ivec2 at = clamp(base + ivec2(column, row) - 1, ivec2(0), last);\n      line += across[column] * texelFetch(source, at, 0).rgb;\n    }\n    sum += down[row] * line;\n  }\n  return sum;\n}\n", st = 2, ct = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
${ot}${at}`, lt = "\nprecision highp float;\nuniform vec4 rectangle; // of the target: left, top, right, bottom in 0..1\nin vec3 position;\nout vec2 own;\nvoid main() {\n  own = position.xy;\n  gl_Position = vec4(2.0 * mix(rectangle.xy, rectangle.zw, position.xy) - 1.0, 0.0, 1.0);\n}\n", ut = "\nprecision highp float;\nuniform vec2 texel;     // of the target, in clip space\nuniform vec2 shifts[SHIFTS];\nin vec2 position;       // texture coordinates\nin vec3 onPlane;\nout vec3 point;\nvoid main() {\n  point = onPlane;\n  gl_Position = vec4(2.0 * position - 1.0 + texel * shifts[gl_InstanceID], 0.0, 1.0);\n}\n", dt = `${ct}
in vec3 point;
out vec4 place;
void main() { place = placeOf(point); }
`, ft = "sumTextures", pt = "finerValue";
function mt(n, r, i) {
	let o = new S({
		glslVersion: f,
		vertexShader: lt,
		fragmentShader: `${ct}in vec2 own;\nout vec4 colour;\nvoid main() { colour = vec4(${n}(own), 1.0); }\n`,
		uniforms: {
			rectangle: { value: new re(...r) },
			...i
		},
		side: c,
		blending: a,
		blendSrc: ee,
		blendDst: ee,
		depthTest: !1,
		depthWrite: !1
	}), s = new t();
	s.setAttribute("position", new e(new Float32Array([
		0,
		0,
		0,
		1,
		0,
		0,
		0,
		1,
		0,
		1,
		1,
		0
	]), 3)), s.setIndex([
		0,
		1,
		2,
		2,
		1,
		3
	]), s.boundingSphere = new w();
	let l = new v(s, o);
	return l.frustumCulled = !1, l;
}
function ht([e, t], n) {
	return new ie(e, t, {
		type: p,
		depthBuffer: !1,
		generateMipmaps: n,
		minFilter: n ? g : b,
		magFilter: n ? h : b
	});
}
function gt(e, t) {
	let n = L(e.right, e.up), r = [
		t[0] - e.origin[0],
		t[1] - e.origin[1],
		t[2] - e.origin[2]
	];
	return [...F(e, t), I(r, n) / (Math.max(...e.extent) || 1)];
}
function _t(t, n, r) {
	let i = t.geometry.getAttribute("position"), a = t.geometry.getAttribute("uv"), o = new Float32Array(3 * i.count), s = new Float32Array(2 * i.count);
	for (let e = 0; e < i.count; e++) o.set(gt(n, [
		i.getX(e),
		i.getY(e),
		i.getZ(e)
	]), 3 * e), s.set([a.getX(e), a.getY(e)], 2 * e);
	let l = Array.from({ length: 5 }, (e, t) => t - st), u = l.flatMap((e) => l.map((t) => new ne(t, e)));
	u.sort((e, t) => t.lengthSq() - e.lengthSq());
	let d = new m();
	d.setAttribute("position", new e(s, 2)), d.setAttribute("onPlane", new e(o, 3)), d.setIndex(t.geometry.index ? new e(t.geometry.index.array, 1) : null), d.instanceCount = u.length, d.boundingSphere = new w();
	let p = new S({
		glslVersion: f,
		vertexShader: ut.replace("SHIFTS", String(u.length)),
		fragmentShader: dt,
		uniforms: {
			texel: { value: new ne(2 / r.width, 2 / r.height) },
			shifts: { value: u }
		},
		side: c,
		blending: x,
		depthTest: !1,
		depthWrite: !1
	}), h = new v(d, p);
	h.frustumCulled = !1;
	let g = new C();
	return g.add(h), {
		scene: g,
		free: () => {
			d.dispose(), p.dispose();
		}
	};
}
// eigenfield-three/src/composer.ts
var vt = class {
	mesh;
	plane;
	grids;
	composed = null;
	camera = new n();
	constructor(e, t, n, r, i) {
		this.mesh = r, this.plane = i;
		let [a, ...o] = Xe({
			atlas: e,
			means: t.filter(({ basis: e }) => !e).map(({ grid: e }) => ({
				size: e,
				channels: 1
			})),
			bases: t.filter(({ basis: e }) => e).map(({ grid: e }) => ({
				size: e,
				grid: e,
				channels: 1,
				count: 1
			}))
		}), s = (e, r) => {
			let i = t.filter(({ grid: t }) => t.join() === e.join()).flatMap(yt), a = new C();
			return i.forEach(({ quad: e }, t) => a.add(Object.assign(e, { renderOrder: t }))), {
				target: ht(R(e, n), r),
				scene: a,
				steps: i,
				places: null
			};
		}, c = s(a ?? e, !0);
		this.grids = o.map((e) => s(e, !1));
		for (let { target: e } of this.grids) {
			let t = mt(pt, [
				0,
				0,
				1,
				1
			], { coarse: { value: e.texture } });
			c.scene.add(Object.assign(t, { renderOrder: c.scene.children.length }));
		}
		this.grids.push(c);
	}
	get texture() {
		return this.grids.at(-1)?.target.texture ?? null;
	}
	compose(e, t, n) {
		this.composed && St(this.composed, n) || (this.composed = n, Tt(e, t, () => {
			for (let t of this.grids) {
				n.eye && !t.places && t.steps.some(({ part: e }) => e.basis) && this.findPlaces(e, t);
				for (let e of t.steps) bt(e, t, n);
				this.draw(e, t.scene, t.target);
			}
		}));
	}
	dispose() {
		for (let { target: e, places: t, scene: n } of this.grids) {
			e.dispose(), t?.dispose();
			for (let e of n.children) e.geometry.dispose(), e.material.dispose();
		}
	}
	findPlaces(e, t) {
		t.places = ht([t.target.width, t.target.height], !1);
		let { scene: n, free: r } = _t(this.mesh, this.plane, t.places);
		this.draw(e, n, t.places), r();
	}
	draw(e, t, n) {
		e.setRenderTarget(n), e.state.buffers.color.setMask(!0), e.clear(!0, !1, !1), e.render(t, this.camera);
	}
};
function yt(e) {
	let t = e.colours.length, [n, r] = [e.scale.length / (4 * t), Math.floor(64 / t)], i = [];
	for (let a = 0; a < n; a += r) {
		let o = Array.from({ length: 64 }, (t, n) => new T(...e.colours[n] ?? [
			0,
			0,
			0
		])), s = e.basis ? 1 : 4, c = mt(ft, e.rectangle, {
			stored: { value: e.stored },
			firstLayer: { value: Math.floor(a * t / s) },
			sharing: { value: s },
			channels: { value: t },
			entries: { value: 0 },
			scale: { value: /* @__PURE__ */ new Float32Array(256) },
			bias: { value: /* @__PURE__ */ new Float32Array(256) },
			colours: { value: o },
			rayWeights: { value: !1 },
			weightMaps: { value: null },
			firstGroup: { value: (e.basis?.group ?? 0) + a },
			places: { value: null },
			eye: { value: new T() }
		});
		i.push({
			part: e,
			first: a,
			groups: Math.min(r, n - a),
			quad: c
		});
	}
	return i;
}
function bt({ part: e, first: t, groups: n, quad: r }, { places: i }, a) {
	let { basis: o, colours: s } = e, { uniforms: c } = r.material, l = (e, t) => {
		let n = c[e];
		n && (n.value = t);
	}, u = o !== null && a.eye !== null && a.only === null, d = Array.from({ length: 4 * n }, (e, n) => xt(o, 4 * t + n, a, u)), f = Math.ceil((d.findLastIndex((e) => e !== 0) + 1) / 4), [p, m] = [c.scale?.value, c.bias?.value], h = s.length;
	for (let n = 0; n < 4 * h * f; n++) {
		let r = d[4 * Math.floor(n / (4 * h)) + n % 4] ?? 0;
		p[n] = r * (e.scale[4 * h * t + n] ?? 0), m[n] = r * (e.bias[4 * h * t + n] ?? 0);
	}
	l("entries", h * f), l("rayWeights", u), l("weightMaps", u ? a.maps : null), l("places", u ? i?.texture ?? null : null), a.eye && (c.eye?.value).set(...a.eye), r.visible = f > 0, r.material.uniformsNeedUpdate = !0;
}
function xt(e, t, n, r) {
	return e ? e.ready[t] ? n.only === null ? t >= n.count ? 0 : r ? 1 : n.weights[e.column + t] ?? 0 : +(t === n.only) : 0 : +!!n.mean;
}
function St(e, t) {
	let { weights: n, eye: r, ...i } = e;
	return !Object.entries(i).every(([e, n]) => t[e] === n) || r === null != (t.eye === null) ? !1 : e.only === null ? r ? r.every((e, n) => e === t.eye?.[n]) : n.every((e, n) => e === t.weights[n]) : !0;
}
var Ct = new i(0), wt = new i();
function Tt(e, t, n) {
	let r = e.getRenderTarget(), [i, a] = [e.getActiveCubeFace(), e.getActiveMipmapLevel()], { autoClear: o, info: s } = e, [c, l, u] = [
		e.xr.enabled,
		e.shadowMap.autoUpdate,
		e.getClearAlpha()
	], [d, f] = [s.render.frame, s.autoReset];
	e.getClearColor(wt), e.setClearColor(Ct, 0), e.autoClear = e.xr.enabled = e.shadowMap.autoUpdate = s.autoReset = !1, n(), s.render.frame = d, Object.assign(s, { autoReset: f }), Object.assign(e, { autoClear: o }), e.xr.enabled = c, e.shadowMap.autoUpdate = l, e.setClearColor(wt, u), e.setRenderTarget(r, i, a);
	let { viewport: p } = t;
	p && e.state.viewport(p);
}
// eigenfield-three/src/maps.ts
function Et(e, t, n, i, a) {
	let c = i.reduce((e, t) => e + t, 0), l = [], [u, d] = [0, 0];
	for (let e of i) {
		let t = Math.min(e, a);
		for (let e = 0; e < t; e++) l.push([u + e, 4 * d + e]);
		u += e, d += t ? z(t) : 0;
	}
	let f = new Uint16Array(Math.max(1, d) * 129 * 129 * 4);
	for (let r = 0; r < 129; r++) for (let i = 0; i < 129; i++) {
		let { camera: a, weight: o } = e.at(2 * i / 128 - 1, 2 * r / 128 - 1, t), [u, d, p, m] = [
			a[0] * c,
			a[1] * c,
			a[2] * c,
			a[3] * c
		], [h, g, _, v] = o;
		for (let [e, t] of l) {
			let a = h * (n[u + e] ?? 0) + g * (n[d + e] ?? 0) + _ * (n[p + e] ?? 0) + v * (n[m + e] ?? 0);
			f[4 * (((t >> 2) * 129 + r) * 129 + i) + (t & 3)] = s.toHalfFloat(a);
		}
	}
	let m = new o(f, 129, 129, Math.max(1, d));
	return m.format = te, m.type = p, m.minFilter = m.magFilter = h, m.wrapS = m.wrapT = r, m.needsUpdate = !0, m;
}
// ../src/eigenfield/rendering/shaders/surface.glsl?raw
var Dt = "// The composed texture (compose.glsl) on the surface of the proxy.\n//\n// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl.py and as GLSL ES 3.00 by the web viewer. Whoever\n// includes it writes the #version line, the precisions, cubic.glsl before it, and\n//   BICUBIC   how the finest level is read: 0 bilinear, 1 Catmull-Rom\n// Pixels of more than `finest` texels are left to the sampler and its mip maps.\n\nuniform sampler2D composed;\nuniform float finest;       // texels a pixel up to which the finest level is read: 1.5 times those a pixel of the\n                            // photographs covers, which holds no more than its own average\nuniform vec3 exposureScale; // picture = RGB * exposureScale + exposureBias: 1 / gain and -offset / gain of a captured\nuniform vec3 exposureBias;  // camera of a harmonised scene, else 1 and 0\n\n// R, G, B at texture coordinates; nothing is cut off.\nvec3 surfaceValue(vec2 uv) {\n  vec3 plain = texture(composed, uv, -log2(finest)).rgb;\n#if BICUBIC == 1\n  vec2 size = vec2(textureSize(composed, 0));\n  vec2 across = dFdx(uv) * size, down = dFdy(uv) * size;\n  bool fine = max(dot(across, across), dot(down, down)) <= finest * finest;\n  if (fine) return readCubic(composed, clamp(uv * size, vec2(0.5), size - 0.5) - 0.5);\n#endif\n  return plain;\n}\n\n// What the surface shows at texture coordinates.\nvec3 surfaceColour(vec2 uv) {\n  return clamp(surfaceValue(uv) * exposureScale + exposureBias, 0.0, 1.0);\n}\n", Ot = {
	bilinear: 0,
	bicubic: 1
}, B = {
	picture: 0,
	mean: 1,
	eigen: 2,
	error: 3
}, kt = "\nprecision highp float;\nuniform mat4 modelViewMatrix;\nuniform mat4 projectionMatrix;\nin vec3 position;\nin vec2 uv;\nout vec2 surfaceUv;\nout vec3 surfacePlace;\nvoid main() {\n  surfaceUv = uv;\n  surfacePlace = position;\n  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));\n}\n", At = `
precision highp float;
precision highp int;
precision highp sampler2D;
${ot}${Dt}
uniform int shown;             // 0 the picture, 1 the mean, 2 one eigen texture, 3 the error
uniform float shownGain;       // of the eigen texture around mid grey
uniform sampler2D photograph;  // row 0 on top
uniform mat4 toPhotograph;     // homogeneous texture coordinates of a place, in x, y and w

in vec2 surfaceUv;
in vec3 surfacePlace;
out vec4 fragment;

vec3 heat(float t) {
  return clamp(vec3(3.0 * t, 3.0 * t - 1.0, 3.0 * t - 2.0), 0.0, 1.0);
}

vec3 errorColour(vec3 drawn) {
  vec4 at = toPhotograph * vec4(surfacePlace, 1.0);
  vec2 uv = at.xy / at.w;
  if (at.w <= 0.0 || any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return vec3(0.2);
  vec3 off = abs(drawn - textureLod(photograph, uv, 0.0).rgb);
  return heat(5.0 * (off.r + off.g + off.b) / 3.0);
}

void main() {
  vec3 colour;
  if (shown == 2) colour = clamp(0.5 + shownGain * surfaceValue(surfaceUv), 0.0, 1.0);
  else colour = surfaceColour(surfaceUv);
  if (shown == 3) colour = errorColour(colour);
  fragment = vec4(colour, 1.0);
}
`;
function jt(e) {
	let t = {
		composed: { value: null },
		finest: { value: 1 },
		exposureScale: { value: new T(1, 1, 1) },
		exposureBias: { value: new T() },
		shown: { value: B.picture },
		shownGain: { value: 1 },
		photograph: { value: null },
		toPhotograph: { value: new _() }
	}, n = new S({
		glslVersion: f,
		vertexShader: kt,
		fragmentShader: At,
		uniforms: t,
		defines: { BICUBIC: Ot.bicubic },
		side: e ? c : d
	});
	return n.name = "eigen textures", n;
}
// eigenfield-three/src/parts.ts
function Mt(e, t, n) {
	let r = [], [i, a, o, s] = [
		0,
		0,
		0,
		0
	];
	return e.planes.forEach(({ channels: c, mean: l, bases: u }, d) => {
		let f = e.colours.slice(i, i + c);
		i += c;
		let p = t.needs.means[d]?.size ?? [1, 1], m = t.means[d], h = Nt(l, c);
		m && r.push({
			stored: m,
			grid: p,
			rectangle: [
				0,
				0,
				1,
				1
			],
			colours: f,
			...h,
			basis: null
		});
		for (let { size: e, grid: i, corner: l, pictures: d, count: p } of u) {
			let u = t.bases[a], m = t.ready[a++] ?? [], h = Math.min(p, n.usable);
			if (h && u) {
				let [t, n] = [l[0] / i[0], l[1] / i[1]], a = d.flatMap((e) => e.scale), p = d.flatMap((e) => e.zero);
				r.push({
					stored: u,
					grid: i,
					rectangle: [
						t,
						n,
						t + e[0] / i[0],
						n + e[1] / i[1]
					],
					colours: f,
					...Pt(a, p, c, h),
					basis: {
						ready: m,
						column: o,
						group: s
					}
				});
			}
			o += p, s += h ? z(h) : 0;
		}
	}), r;
}
function Nt({ scale: e, zero: t }, n) {
	let r = {
		scale: new Float32Array(4 * n),
		bias: new Float32Array(4 * n)
	};
	for (let i = 0; i < n; i++) {
		let n = 4 * i + i % 4;
		r.scale[n] = 255 * (e[i] ?? 0), r.bias[n] = -(t[i] ?? 0) * (e[i] ?? 0);
	}
	return r;
}
function Pt(e, t, n, r) {
	let i = 4 * n * z(r), a = {
		scale: new Float32Array(i),
		bias: new Float32Array(i)
	};
	for (let i = 0; i < r; i++) for (let r = 0; r < n; r++) {
		let o = 4 * (n * Math.floor(i / 4) + r) + i % 4, s = e[n * i + r] ?? 0;
		a.scale[o] = 255 * s, a.bias[o] = -(t[n * i + r] ?? 0) * s;
	}
	return a;
}
// eigenfield-three/src/json.ts
var Ft = class e {
	raw;
	where;
	constructor(e, t) {
		this.raw = e, this.where = t;
	}
	get exists() {
		return this.raw !== void 0;
	}
	object() {
		if (this.raw === null || typeof this.raw != "object" || Array.isArray(this.raw)) throw this.wrong("no object");
		return this.raw;
	}
	key(t) {
		let n = this.object(), r = Object.hasOwn(n, t) ? n[t] : void 0;
		return new e(r, `${this.where}/${t}`);
	}
	items(t) {
		if (!Array.isArray(this.raw)) throw this.wrong("no list");
		if (this.raw.length > t) throw this.wrong(`more than ${t} entries`);
		return this.raw.map((t, n) => new e(t, `${this.where}/${n}`));
	}
	at(t) {
		if (!Array.isArray(this.raw)) throw this.wrong("no list");
		return new e(this.raw[t], `${this.where}/${t}`);
	}
	text(e) {
		if (typeof this.raw != "string") throw this.wrong("no text");
		if (this.raw.length > e) throw this.wrong(`longer than ${e} characters`);
		return this.raw;
	}
	number(e = -M, t = M) {
		if (typeof this.raw != "number") throw this.wrong("no number");
		if (!(this.raw >= e && this.raw <= t)) throw this.wrong(`${this.raw} is not in ${e}..${t}`);
		return this.raw;
	}
	integer(e, t) {
		let n = this.number(e, t);
		if (!Number.isInteger(n)) throw this.wrong(`${n} is no whole number`);
		return n;
	}
	numbers(e, t = -M, n = M) {
		let r = this.items(e);
		if (r.length !== e) throw this.wrong(`${e} numbers are needed`);
		return r.map((e) => e.number(t, n));
	}
	triple() {
		let [e = 0, t = 0, n = 0] = this.numbers(3);
		return [
			e,
			t,
			n
		];
	}
	wrong(e) {
		return D(this.where || "/", this.exists ? e : "missing");
	}
}, V = 5126;
function It(e, t) {
	return new E("unsupported", `The scene has ${e}, which this viewer does not draw; draw it with "eigenfield render".`, t);
}
function Lt(e) {
	let [t = 0, n = 0] = e.items(2).map((e) => e.integer(1, de));
	if (!t || !n) throw e.wrong("two numbers are needed");
	if (t * n > k) throw e.wrong(`more than ${k} texels`);
	return [t, n];
}
function Rt(e, t, n, r, i) {
	let a = e.key("planes").items(16);
	if (!a.length) throw e.key("planes").wrong("no plane");
	let o = a.map((e, a) => {
		let o = e.key("channels").integer(1, 64), s = Vt(e, o, a === 0 ? n : null, i), c = e.key("bases").items(64), l = (e) => Ht(e, o, t, r, i);
		return {
			channels: o,
			...s,
			bases: c.map(l)
		};
	}), [s, c] = [0, 0];
	for (let { channels: e, meanSize: t, bases: n } of o) {
		s += 4 * e * (t ? t[0] * t[1] : 0);
		for (let { size: t, count: r } of n) s += t[0] * t[1] * e * r, c += r;
	}
	if (c > 4096) throw e.key("planes").wrong(`more than ${A} textures`);
	if (s > fe) throw e.key("planes").wrong("too large when it is decoded");
	return o;
}
function zt(e, t) {
	let n = t.reduce((e, { channels: t }) => e + t, 0), r = e.key("toRGB");
	if (r.exists) {
		let e = r.numbers(3 * n), t = (t, r) => e[t * n + r] ?? 0;
		return Array.from({ length: n }, (e, n) => [
			t(0, n),
			t(1, n),
			t(2, n)
		]);
	}
	if (t.length === 1 && n === 1) return [[
		1,
		1,
		1
	]];
	if (t.length === 1 && n === 3) return [
		[
			1,
			0,
			0
		],
		[
			0,
			1,
			0
		],
		[
			0,
			0,
			1
		]
	];
	throw It(`${t.length > 1 ? `${t.length} planes` : `${n} channels`} and no colours for them`, `${e.where}/planes`);
}
function Bt(e, t, n, r) {
	let i = e.key("mimeType").text(j);
	if (!/^image\/(png|jpeg|webp|avif)$/.test(i)) throw e.key("mimeType").wrong("an unknown type");
	return {
		view: r(e.key("bufferView")),
		mimeType: i,
		scale: e.key("scale").numbers(t * n),
		zero: e.key("zero").numbers(t * n),
		textures: n,
		where: e.where
	};
}
function Vt(e, t, n, r) {
	let i = e.key("mean"), a = {
		scale: Array(t).fill(1 / 255),
		zero: Array(t).fill(0)
	};
	if (!i.exists) {
		if (n === null || t !== 1 && t !== 3) throw i.wrong("no mean");
		return {
			mean: {
				view: n,
				mimeType: "image/png",
				...a,
				textures: 1,
				where: "/images/0"
			},
			meanSize: null
		};
	}
	let o = Lt(i.key("size")), s = Bt(i.key("scale").exists || i.key("zero").exists ? i : new Ft({
		...i.object(),
		...a
	}, i.where), t, 1, r);
	return Wt(i, t, o, 1), {
		mean: s,
		meanSize: o
	};
}
function Ht(e, t, n, r, i) {
	let a = Lt(e.key("size")), [o, s] = [e.key("grid"), e.key("corner")], c = o.exists ? Lt(o) : a, [l = 0, u = 0] = s.exists ? s.numbers(2, 0, de) : [];
	if (!Number.isInteger(l) || !Number.isInteger(u)) throw s.wrong("no whole numbers");
	if (l + a[0] > c[0] || u + a[1] > c[1]) throw e.wrong("textures beyond their grid");
	let d = 0, f = e.key("textures").items(A).map((e) => {
		let n = e.key("count"), r = n.exists ? n.integer(1, A) : 1;
		return d += r, Wt(e, t, a, r), Bt(e, t, r, i);
	});
	if (d > 4096) throw e.wrong(`more than ${A} textures`);
	let p = d ? r(e.key("weights"), "SCALAR", [V], n * d) : null;
	return {
		size: a,
		grid: c,
		corner: [l, u],
		pictures: f,
		count: d,
		weights: p,
		where: e.where
	};
}
function Ut(e, t, n) {
	return (e === 3 ? 1 : e) * t * n;
}
function Wt(e, t, [n, r], i) {
	let a = Ut(t, r, i);
	if (a > r && a > 32768) throw e.wrong(`a picture of ${a} rows`);
	if (n * a > k) throw e.wrong(`more than ${k} texels`);
}
// eigenfield-three/src/headers.ts
function Gt(e) {
	let t = new DataView(e);
	try {
		return Kt(t) ?? qt(t) ?? Jt(t) ?? Yt(t);
	} catch (e) {
		if (e instanceof RangeError) return null;
		throw e;
	}
}
function H(e, t) {
	return String.fromCharCode(...[
		0,
		1,
		2,
		3
	].map((n) => e.getUint8(t + n)));
}
function Kt(e) {
	return e.getUint32(0) !== 2303741511 || e.getUint32(4) !== 218765834 || H(e, 12) !== "IHDR" ? null : {
		type: "image/png",
		width: e.getUint32(16),
		height: e.getUint32(20)
	};
}
function qt(e) {
	if (e.getUint16(0) !== 65496) return null;
	for (let t = 2;;) {
		let n = e.getUint16(t);
		if (n === 65535) t += 1;
		else {
			if (n >= 65472 && n <= 65487 && ![
				65476,
				65480,
				65484
			].includes(n)) return {
				type: "image/jpeg",
				height: e.getUint16(t + 5),
				width: e.getUint16(t + 7)
			};
			if (n < 65281 || n === 65498 || n === 65497) return null;
			t += 2 + e.getUint16(t + 2);
		}
	}
}
function Jt(e) {
	if (H(e, 0) !== "RIFF" || H(e, 8) !== "WEBP") return null;
	let t = "image/webp", n = H(e, 12), r = (t) => e.getUint16(t, !0) + 65536 * e.getUint8(t + 2);
	if (n === "VP8X") return {
		type: t,
		width: 1 + r(24),
		height: 1 + r(27)
	};
	if (n === "VP8L") {
		let n = e.getUint32(21, !0);
		return {
			type: t,
			width: 1 + (n & 16383),
			height: 1 + (n >>> 14 & 16383)
		};
	}
	return n === "VP8 " ? {
		type: t,
		width: e.getUint16(26, !0) & 16383,
		height: e.getUint16(28, !0) & 16383
	} : null;
}
function Yt(e) {
	if (H(e, 4) !== "ftyp") return null;
	let t = null, n = (r, i) => {
		for (let a = r; a + 8 <= i;) {
			let r = e.getUint32(a), o = H(e, a + 4), s = r === 0 ? i : a + r;
			if (r === 1 || s < a + 8 || s > i) return;
			if (o === "meta" && n(a + 12, s), (o === "iprp" || o === "ipco") && n(a + 8, s), o === "ispe") {
				let [n, r] = [e.getUint32(a + 12), e.getUint32(a + 16)];
				(!t || n * r > t.width * t.height) && (t = {
					type: "image/avif",
					width: n,
					height: r
				});
			}
			a = s;
		}
	};
	return n(0, e.byteLength), t;
}
// eigenfield-three/src/decode.ts
var Xt = {
	colorSpaceConversion: "none",
	premultiplyAlpha: "none"
}, Zt = {
	"image/avif": "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOltZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAAAAABAAAAHmlsb2MAAAAARAAAAQABAAAAAQAAAQ0AAAAZAAAAKGlpbmYAAAAAAAEAAAAaaW5mZQIAAAAAAQAAYXYwMUNvbG9yAAAAAGhpcHJwAAAASWlwY28AAAAUaXNwZQAAAAAAAAAIAAAACAAAAA5waXhpAAAAAAEIAAAADGF2MUOBABwAAAAAE2NvbHJuY2x4AAEADQAGgAAAABdpcG1hAAAAAAAAAAEAAQQBAoMEAAAAIW1kYXQSAAoIGAi/aYCGg1AyCxlGIYeeaACQQNmg",
	"image/webp": "UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAAAdQwAIWsP+BiOh/AAA="
};
function Qt(e, t, n) {
	let r = Gt(e);
	if (!r) throw D(t.where, "no picture");
	let { width: i, height: a } = r;
	if (n && (i !== n[0] || a !== n[1])) throw D(t.where, `a picture of ${i} x ${a}, not of ${n[0]} x ${n[1]}`);
	let o = i * a;
	if (!o || i > 16384 || a > 32768 || o > k) throw D(t.where, `a picture of ${i} x ${a}`);
	return [i, a];
}
async function $t(e, t, n, r = 1) {
	let [i, a] = Qt(e, t, n), [o, s] = [Math.ceil(i / r), Math.ceil(a / r)], c = r === 1 ? {} : {
		resizeWidth: o,
		resizeHeight: s,
		resizeQuality: "high"
	}, l = Gt(e)?.type ?? t.mimeType, u;
	try {
		u = await createImageBitmap(new Blob([e], { type: l }), {
			...Xt,
			...c
		});
	} catch (e) {
		throw await en(l) ? D(t.where, "it cannot be decoded") : tn(l, t, e);
	}
	if (u.width === o && u.height === s) return u;
	throw u.close(), D(t.where, `decoded to ${u.width} x ${u.height}, not to ${o} x ${s}`);
}
async function U(e, t, n, r, i = 1) {
	let a = Ut(n, 1, t.textures), [o, s] = Qt(e, t, r && [r[0], a * r[1]]), c = await $t(e, t, [o, s], a === 1 ? i : 1);
	if (a === 1) return [{
		bitmap: c,
		row: 0,
		rows: c.height
	}];
	let l = s / a, u = Array.from({ length: a }, (e, t) => ({
		bitmap: c,
		row: t * l,
		rows: l
	}));
	if (i === 1) return u;
	let [d, f] = [Math.ceil(o / i), Math.ceil(l / i)], p = {
		...Xt,
		resizeWidth: d,
		resizeHeight: f,
		resizeQuality: "high"
	}, m = await Promise.all(u.map(({ row: e }) => createImageBitmap(c, 0, e, o, l, p)));
	return c.close(), m.map((e) => ({
		bitmap: e,
		row: 0,
		rows: f
	}));
}
function W(e) {
	for (let { bitmap: t } of e) t.close();
}
async function en(e) {
	let t = Zt[e];
	if (!t) return !0;
	let n = Uint8Array.from(atob(t), (e) => e.charCodeAt(0));
	try {
		return (await createImageBitmap(new Blob([n], { type: e }))).close(), !0;
	} catch {
		return !1;
	}
}
function tn(e, t, n) {
	return new E("codec", `This browser cannot decode ${e.replace("image/", "").toUpperCase()} pictures; use a newer one, or encode the scene with --codec png.`, t.where, { cause: n });
}
// eigenfield-three/src/strength.ts
var G = 128, nn = .98;
async function rn(e, t, n, r) {
	let i = n.length, a = 0, o = e.pictures.find(({ textures: e }) => (a += e) > t);
	if (!o) return 1;
	let s = t - (a - o.textures), c = i === 3 ? 1 : i, l = await U(await r(o.view), o, i, e.size), u = new OffscreenCanvas(G, G).getContext("2d", { willReadFrequently: !0 });
	if (!u) return 1;
	u.imageSmoothingEnabled = !1;
	let d = [];
	l.slice(c * s, c * (s + 1)).forEach(({ bitmap: e, row: t, rows: r }, a) => {
		u.drawImage(e, 0, t, e.width, r, 0, 0, G, G);
		let { data: c } = u.getImageData(0, 0, G, G);
		(i === 3 ? [
			0,
			1,
			2
		] : [a]).forEach((e) => {
			let [t, r] = [o.scale, o.zero].map((t) => t[i * s + e] ?? 0), a = Math.max(...(n[e] ?? [0]).map(Math.abs)) * (t ?? 0);
			for (let t = i === 3 ? e : 0; t < c.length; t += 4) d.push(Math.abs(((c[t] ?? 0) - (r ?? 0)) * a));
		});
	}), W(l), d.sort((e, t) => e - t);
	let f = d[Math.floor(nn * d.length)] ?? 0;
	return f > 0 ? .45 / f : 1;
}
// eigenfield-three/src/gpu.ts
function an(e, t) {
	return {
		side: e.getParameter(e.MAX_TEXTURE_SIZE),
		layers: e.getParameter(e.MAX_ARRAY_TEXTURE_LAYERS),
		memory: t
	};
}
function on(e, [t, n], r, i) {
	return ln(e, e.TEXTURE_2D_ARRAY, () => {
		e.texStorage3D(e.TEXTURE_2D_ARRAY, 1, e.RGBA8, t, n, r);
		for (let t of [e.TEXTURE_WRAP_S, e.TEXTURE_WRAP_T]) e.texParameteri(e.TEXTURE_2D_ARRAY, t, e.CLAMP_TO_EDGE);
		for (let t of [e.TEXTURE_MIN_FILTER, e.TEXTURE_MAG_FILTER]) e.texParameteri(e.TEXTURE_2D_ARRAY, t, i ? e.LINEAR : e.NEAREST);
	});
}
function sn(e, t, n) {
	let { width: r, height: i } = n;
	un(e, e.TEXTURE_2D_ARRAY, t, () => e.texSubImage3D(e.TEXTURE_2D_ARRAY, 0, 0, 0, 0, r, i, 1, e.RGBA, e.UNSIGNED_BYTE, n));
}
function cn(e, [t, n]) {
	return ln(e, e.TEXTURE_2D, () => {
		e.texStorage2D(e.TEXTURE_2D, 1, e.RGBA8, t, n), e.texParameteri(e.TEXTURE_2D, e.TEXTURE_MIN_FILTER, e.NEAREST);
	});
}
function ln(e, t, n) {
	for (; e.getError() !== e.NO_ERROR && !e.isContextLost(););
	let r = e.createTexture();
	return un(e, t, r, n), e.getError() === e.OUT_OF_MEMORY ? (e.deleteTexture(r), null) : r;
}
function un(e, t, n, r) {
	let i = t === e.TEXTURE_2D_ARRAY, a = e.getParameter(i ? e.TEXTURE_BINDING_2D_ARRAY : e.TEXTURE_BINDING_2D), o = [
		[e.UNPACK_FLIP_Y_WEBGL, !1],
		[e.UNPACK_PREMULTIPLY_ALPHA_WEBGL, !1],
		[e.UNPACK_COLORSPACE_CONVERSION_WEBGL, e.NONE],
		[e.UNPACK_ALIGNMENT, 4],
		[e.UNPACK_ROW_LENGTH, 0],
		[e.UNPACK_IMAGE_HEIGHT, 0],
		[e.UNPACK_SKIP_PIXELS, 0],
		[e.UNPACK_SKIP_ROWS, 0],
		[e.UNPACK_SKIP_IMAGES, 0]
	], s = o.map(([t]) => [t, e.getParameter(t)]), c = e.getParameter(e.PIXEL_UNPACK_BUFFER_BINDING);
	c && e.bindBuffer(e.PIXEL_UNPACK_BUFFER, null), o.forEach(([t, n]) => e.pixelStorei(t, n)), e.bindTexture(t, n), r(), e.bindTexture(t, a), s.forEach(([t, n]) => e.pixelStorei(t, n)), c && e.bindBuffer(e.PIXEL_UNPACK_BUFFER, c);
}
// eigenfield-three/src/packing.ts
var dn = "#version 300 es\nvoid main() {\n  gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);\n}\n", fn = "#version 300 es\nprecision highp float;\nuniform highp sampler2D picture;\nuniform int channel;\nout vec4 code;\nvoid main() {\n  code = vec4(texelFetch(picture, ivec2(gl_FragCoord.xy), 0)[channel]);\n}\n";
function pn(e, t) {
	let n = mn(e), [r, i] = [e.createFramebuffer(), e.createVertexArray()], a = e.getUniformLocation(n, "channel"), o = ({ bitmap: t, rows: o }, s, c) => {
		e.useProgram(n), e.bindVertexArray(i), e.bindFramebuffer(e.DRAW_FRAMEBUFFER, r), e.viewport(0, 0, t.width, o);
		for (let { channel: t, layer: n, component: r } of c) e.colorMask(r === 0, r === 1, r === 2, r === 3), e.framebufferTextureLayer(e.DRAW_FRAMEBUFFER, e.COLOR_ATTACHMENT0, s, 0, n), e.uniform1i(a, t), e.drawArrays(e.TRIANGLES, 0, 3);
	};
	return {
		put(n, r, i) {
			let { bitmap: a, row: s, rows: c } = n;
			hn(e, () => un(e, e.TEXTURE_2D, t, () => {
				e.pixelStorei(e.UNPACK_SKIP_ROWS, s), e.texSubImage2D(e.TEXTURE_2D, 0, 0, 0, a.width, c, e.RGBA, e.UNSIGNED_BYTE, a), gn(e, () => o(n, r, i));
			}));
		},
		free() {
			e.deleteTexture(t), e.deleteVertexArray(i), e.deleteFramebuffer(r), e.deleteProgram(n);
		}
	};
}
function mn(e) {
	let t = e.createProgram();
	for (let [n, r] of [[e.VERTEX_SHADER, dn], [e.FRAGMENT_SHADER, fn]]) {
		let i = e.createShader(n);
		i && (e.shaderSource(i, r), e.compileShader(i), e.attachShader(t, i), e.deleteShader(i));
	}
	return e.linkProgram(t), t;
}
function hn(e, t) {
	let n = e.getParameter(e.ACTIVE_TEXTURE);
	e.activeTexture(e.TEXTURE0);
	let r = e.getParameter(e.SAMPLER_BINDING);
	e.bindSampler(0, null), t(), e.bindSampler(0, r), e.activeTexture(n);
}
function gn(e, t) {
	let n = [
		e.BLEND,
		e.CULL_FACE,
		e.DEPTH_TEST,
		e.DITHER,
		e.RASTERIZER_DISCARD,
		e.SAMPLE_ALPHA_TO_COVERAGE,
		e.SAMPLE_COVERAGE,
		e.SCISSOR_TEST,
		e.STENCIL_TEST
	].filter((t) => e.isEnabled(t)), r = e.getParameter(e.CURRENT_PROGRAM), i = e.getParameter(e.VERTEX_ARRAY_BINDING), a = e.getParameter(e.DRAW_FRAMEBUFFER_BINDING), [o = 0, s = 0, c = 0, l = 0] = e.getParameter(e.VIEWPORT), [u, d, f, p] = e.getParameter(e.COLOR_WRITEMASK);
	n.forEach((t) => e.disable(t)), t(), n.forEach((t) => e.enable(t)), e.useProgram(r), e.bindVertexArray(i), e.bindFramebuffer(e.DRAW_FRAMEBUFFER, a), e.viewport(o, s, c, l), e.colorMask(u ?? !0, d ?? !0, f ?? !0, p ?? !0);
}
// eigenfield-three/src/textures.ts
var _n = 3, vn = class {
	parts;
	options;
	means;
	bases;
	ready;
	plan = null;
	hasMeans = !1;
	version = 0;
	onPlan = () => void 0;
	onTexture = () => void 0;
	onComplete = () => void 0;
	onError = () => void 0;
	needs;
	entries;
	renderer = null;
	packer = null;
	decoded;
	turn = 0;
	disposed = !1;
	constructor(e, t, n) {
		this.parts = e, this.options = n;
		let { scene: r, meanSizes: i, rays: a } = e;
		this.decoded = e.means;
		let o = r.planes.flatMap(({ channels: e, bases: t }) => t.map((t) => ({
			...t,
			channels: e
		}))), s = r.planes.map(({ channels: e }, t) => ({
			size: i[t] ?? [1, 1],
			channels: e
		}));
		this.needs = {
			atlas: we(r, i),
			means: [...s],
			bases: o,
			rays: a,
			geometry: t
		}, this.means = s.map(() => new u()), this.bases = o.map(() => new u()), this.ready = o.map(({ count: e }) => Array(e).fill(!1)), this.entries = o.flatMap((e, t) => {
			let n = 0;
			return e.pictures.map((r) => {
				let i = n;
				return n += r.textures, {
					basis: e,
					number: t,
					channels: e.channels,
					picture: r,
					first: i
				};
			});
		}), this.entries.sort((e, t) => e.first - t.first || e.number - t.number);
	}
	get loaded() {
		let e = this.ready.map((e) => e.indexOf(!1)).filter((e) => e >= 0), t = Math.max(0, ...this.ready.map((e) => e.length));
		return Math.min(t, ...e);
	}
	get attached() {
		return this.renderer !== null || this.disposed;
	}
	attach(e) {
		if (this.disposed) return;
		let t = e.getContext();
		if (!(t instanceof WebGL2RenderingContext)) throw new E("unsupported", "Eigen textures need WebGL 2; use a newer browser.");
		this.detach(), this.renderer = e, e.domElement.addEventListener("webglcontextlost", this.onLost), e.domElement.addEventListener("webglcontextrestored", this.onRestored);
		let n = this.turn;
		this.load(t, n).catch((e) => {
			n === this.turn && this.onError(e);
		});
	}
	dispose() {
		this.detach(), this.disposed = !0, this.decoded?.forEach(W), this.decoded = null;
	}
	detach() {
		let e = this.renderer?.getContext();
		this.packer?.free(), this.renderer?.domElement.removeEventListener("webglcontextlost", this.onLost), this.renderer?.domElement.removeEventListener("webglcontextrestored", this.onRestored), this.renderer = null;
		for (let { sourceTexture: t } of [...this.means, ...this.bases]) e && t instanceof WebGLTexture && e.deleteTexture(t);
		this.forget();
	}
	forget = () => {
		this.turn += 1, this.version += 1, this.packer = null, this.hasMeans = !1, this.ready.forEach((e) => e.fill(!1));
		for (let e of [...this.means, ...this.bases]) e.sourceTexture = null;
	};
	onLost = this.forget;
	onRestored = () => {
		this.renderer && this.attach(this.renderer);
	};
	async load(e, t) {
		if (!e.getExtension("EXT_color_buffer_float") && !e.getExtension("EXT_color_buffer_half_float")) throw new E("unsupported", "These graphics draw no half-floats; use a newer device or browser.");
		let { packer: n, plan: r } = this.makeRoom(e);
		if (this.plan = r, this.packer = n, this.onPlan(r), await this.loadMeans(e, t, r.meanDown), t !== this.turn) return;
		let i = this.entries.filter(({ first: e }) => e < r.usable), a = [], o = 0;
		try {
			for (let e of i) {
				for (; a.length < _n && o < i.length;) a.push(this.decode(i[o++], r.scaleDown));
				let s = await a[0] ?? [];
				if (a.shift(), t === this.turn && this.pack(s, e, n, r.usable), W(s), t !== this.turn) return;
				this.onTexture();
			}
		} finally {
			for (let e of a) e.then(W).catch(() => void 0);
		}
		n.free(), this.packer = null, this.onComplete();
	}
	pack(e, t, n, r) {
		let { number: i, channels: a, first: o, picture: s } = t, c = this.bases[i]?.sourceTexture, l = this.ready[i];
		if (!(c instanceof WebGLTexture) || !l) return;
		let u = a === 3 ? 1 : a;
		for (let t = o; t < Math.min(o + s.textures, r); t++) {
			for (let r = 0; r < u; r++) {
				let i = (e) => a * Math.floor(t / 4) + e, s = (a === 3 ? [
					0,
					1,
					2
				] : [r]).map((e) => ({
					channel: a === 3 ? e : 0,
					layer: i(e),
					component: t % 4
				})), l = e[(t - o) * u + r];
				l && n.put(l, c, s);
			}
			l[t] = !0;
		}
		this.version += 1;
	}
	makeRoom(e) {
		let { means: t, bases: n } = this.needs;
		for (let r = this.options.memory ?? Ge();; r /= 2) {
			let i = Ze(this.needs, an(e, r)), { meanDown: a, scaleDown: o, usable: s } = i, c = a > 1 || o > 1, l = [...t.map(({ size: t, channels: n }) => on(e, R(t, a), Je(n), c)), ...n.map(({ size: t, channels: n, count: r }) => {
				let i = Math.min(r, s);
				return on(e, i ? R(t, o) : [1, 1], i ? Ye(i, n) : 1, c);
			})], u = cn(e, et(this.needs, a, o));
			if (u && l.every((e) => e !== null)) return [...this.means, ...this.bases].forEach((e, t) => e.sourceTexture = l[t] ?? null), {
				packer: pn(e, u),
				plan: i
			};
			for (let t of [...l, u]) e.deleteTexture(t);
			if (!s) throw new E("unsupported", "The graphics memory is full; close other pages and try again.");
		}
	}
	async loadMeans(e, t, n) {
		let { scene: r, bytes: i, meanSizes: a } = this.parts, { decoded: o } = this;
		this.decoded = null, (!o || n > 1) && (o?.forEach(W), o = await Promise.all(r.planes.map(async ({ mean: e, channels: t }, r) => U(await i(e.view), e, t, a[r] ?? null, n)))), o.forEach((n, r) => {
			let [i] = n, a = this.means[r]?.sourceTexture;
			t === this.turn && i && a instanceof WebGLTexture && (n.length === 1 ? sn(e, a, i.bitmap) : n.forEach((e, t) => {
				this.packer?.put(e, a, [{
					channel: 0,
					layer: Math.floor(t / 4),
					component: t % 4
				}]);
			})), W(n);
		}), t === this.turn && (this.hasMeans = !0, this.version += 1);
	}
	decode(e, t) {
		if (!e) return Promise.reject(/* @__PURE__ */ RangeError("no such eigen texture"));
		let { basis: n, channels: r, picture: i } = e, a = this.parts.bytes(i.view).then((e) => U(e, i, r, n.size, t));
		return a.catch(() => void 0), a;
	}
}, yn = 1.5, bn = .001, xn = class extends l {
	parts;
	mesh;
	info;
	total;
	count = Infinity;
	weightMode;
	mixing = "delaunay";
	filter;
	coarser = 1;
	camera = null;
	exposure = null;
	view = "picture";
	eigen = 0;
	photograph = null;
	lastWeights = [];
	lastByRay = !1;
	complete;
	material;
	textures;
	counts;
	composers = /* @__PURE__ */ new Map();
	rowOf;
	gains = /* @__PURE__ */ new Map();
	detail;
	maps = null;
	frame = -1;
	constructor(e, t = {}) {
		super(), this.parts = e;
		let { scene: n, info: r, meshes: i } = e, [a] = i;
		if (!a) throw Error("a field needs a mesh");
		this.mesh = a, this.info = r, this.total = Ce(n), this.counts = P(n).map(({ count: e }) => e), this.filter = t.filter ?? "bicubic", this.weightMode = r.facesPlane ? "ray" : "eye";
		let o = 0;
		this.rowOf = Int32Array.from(n.heldOut, (e) => e ? -1 : o++), this.textures = new vn(e, wn(a), t);
		let s = [a.material].flat().some((e) => e.side !== d);
		this.material = jt(s), this.complete = new Promise((e, t) => {
			this.addEventListener("complete", () => e()), this.addEventListener("error", ({ error: e }) => t(e));
		}), this.complete.catch(() => void 0);
		let c = r.cameras[r.reference];
		this.detail = c ? Re(a.geometry, c, [1, 1]) : 0, this.listen();
		for (let e of i) e.material = this.material, e.onBeforeRender = (t, n, r) => this.prepare(t, r, e);
		t.renderer && this.textures.attach(t.renderer);
	}
	get usable() {
		return this.textures.plan?.usable ?? this.total;
	}
	get loaded() {
		return this.textures.loaded;
	}
	get scaleDown() {
		return this.textures.plan?.scaleDown ?? 1;
	}
	get limitation() {
		return this.textures.plan?.limitation ?? null;
	}
	get gpuBytes() {
		return this.textures.plan?.bytes ?? 0;
	}
	viewWeights(e, t, n = this.mixing) {
		let r = new Float64Array(this.parts.weights.places.length / 2), { camera: i, weight: a } = this.parts.weights.at(e, t, n);
		return i.forEach((e, t) => r[e] = (r[e] ?? 0) + (a[t] ?? 0)), r;
	}
	componentWeights(e, t) {
		return this.mix(this.parts.weights.at(e, t, this.mixing));
	}
	cameraWeights(e) {
		let t = this.rowOf[e] ?? -1, n = this.info.cameras[e], r = this.columns;
		if (t >= 0) return Float64Array.from(this.parts.omega.subarray(t * r, (t + 1) * r));
		if (!n) throw RangeError(`no camera ${e}`);
		return this.componentWeights(...F(this.info.viewPlane, n.centre));
	}
	restore(e) {
		this.textures.attach(e);
	}
	dispose() {
		this.textures.dispose(), this.freeComposers(), this.maps?.texture.dispose(), this.material.dispose(), this.mesh.geometry.dispose();
	}
	listen() {
		this.textures.onPlan = ({ limitation: e }) => {
			this.freeComposers(), e && queueMicrotask(() => this.dispatchEvent({ type: "limited" }));
		}, this.textures.onTexture = () => this.dispatchEvent({ type: "texture" }), this.textures.onComplete = () => this.dispatchEvent({ type: "complete" }), this.textures.onError = (e) => this.fail(e);
	}
	finestOf([e, t], n) {
		return yn * Math.max(1, this.detail * Math.sqrt(e * t) / n);
	}
	get columns() {
		return this.counts.reduce((e, t) => e + t, 0);
	}
	mix({ camera: e, weight: t }) {
		let { omega: n } = this.parts, r = this.columns, i = new Float64Array(r);
		for (let a = 0; a < 4; a++) {
			let o = t[a] ?? 0;
			if (!o) continue;
			let s = (e[a] ?? 0) * r;
			for (let e = 0; e < r; e++) i[e] = (i[e] ?? 0) + o * (n[s + e] ?? 0);
		}
		return i;
	}
	prepare(e, t, n) {
		this.textures.attached || this.textures.attach(e);
		let r = Cn(t, n), [i, a] = F(this.info.viewPlane, r), o = this.camera !== null && this.info.cameras[this.camera] ? this.camera : null, s = o === null ? this.componentWeights(i, a) : this.cameraWeights(o), c = o === null && this.weightMode === "ray" && this.info.facesPlane && !this.isOnPlane(r);
		this.setView();
		let l = Ot[this.filter];
		this.material.defines.BICUBIC !== l && (this.material.defines.BICUBIC = l, this.material.needsUpdate = !0), this.material.uniformsNeedUpdate = !0, this.compose(e, t, this.recipe(s, c ? r : null)), e.info.render.frame !== this.frame && (this.lastWeights = []), this.frame = e.info.render.frame, this.lastWeights.push(s), this.lastByRay = c;
	}
	compose(e, t, n) {
		let { plan: r } = this.textures, { size: i, viewPlane: a } = this.info;
		if (!r) return;
		let o = r.meanDown * this.coarser, s = this.composers.get(o);
		s || (s = new vt(i, Mt(this.parts.scene, this.textures, r), o, this.mesh, a), this.composers.set(o, s)), s.compose(e, t, n), this.material.uniforms.composed.value = s.texture, this.material.uniforms.finest.value = this.finestOf(i, o);
	}
	freeComposers() {
		for (let e of this.composers.values()) e.dispose();
		this.composers.clear();
	}
	recipe(e, t) {
		let n = this.material.uniforms.shown.value, r = n === B.eigen ? this.shownEigen : null;
		return {
			version: this.textures.version,
			mean: this.textures.hasMeans && r === null,
			only: r,
			count: n === B.mean ? 0 : Math.max(0, Math.floor(Math.min(this.count, this.total))),
			weights: e,
			eye: t && gt(this.info.viewPlane, t),
			maps: t && this.mapsOf(this.mixing)
		};
	}
	setView() {
		let { uniforms: e } = this.material, t = this.view === "error" && this.photograph !== null && this.camera !== null, n = this.exposure ?? (t ? this.camera : null), { gain: r = null, offset: i = null } = (n === null ? void 0 : this.info.cameras[n]) ?? {}, a = (r ?? [
			1,
			1,
			1
		]).map((e) => 1 / e);
		e.exposureScale.value.fromArray(a), e.exposureBias.value.fromArray(a.map((e, t) => -(i?.[t] ?? 0) * e));
		let o = this.view === "error" && !t ? "picture" : this.view, s = this.shownEigen;
		e.shown.value = B[o === "eigen" && s >= this.loaded ? "mean" : o], o === "eigen" && (e.shownGain.value = this.gainOf(s)), t && this.aimPhotograph();
	}
	get shownEigen() {
		return Math.min(Math.max(0, Math.floor(this.eigen)), this.total - 1);
	}
	aimPhotograph() {
		let e = this.camera === null ? void 0 : this.info.cameras[this.camera], { photograph: t } = this;
		if (!e || !t) return;
		let { K: n, R: r, t: i, width: a, height: o } = e, s = new _().set(...r[0], i[0], ...r[1], i[1], ...r[2], i[2], 0, 0, 0, 1), c = new _().set(...n[0], 0, ...n[1], 0, 0, 0, 0, 0, ...n[2], 0), l = t.flipY && !Tn(t.image), u = new _().makeScale(1 / a, (l ? -1 : 1) / o, 1);
		l && (u.elements[13] = 1), this.material.uniforms.toPhotograph.value.multiplyMatrices(u, c.multiply(s)), this.material.uniforms.photograph.value = t;
	}
	gainOf(e) {
		let t = this.gains.get(e);
		if (t !== void 0) return t;
		this.gains.set(e, 1);
		let { scene: n, bytes: r } = this.parts, i = 0;
		for (let { channels: t, bases: a } of n.planes) {
			let o = n.colours.slice(i, i += t), s = a.find(({ count: t }) => t > e);
			if (!(!s || e < 0)) {
				rn(s, e, o, r).then((t) => {
					this.gains.set(e, t), this.dispatchEvent({ type: "texture" });
				}).catch(() => void 0);
				break;
			}
		}
		return 1;
	}
	isOnPlane(e) {
		let { origin: t, normal: n, extent: r } = this.info.viewPlane, i = e.reduce((e, r, i) => e + (r - (t[i] ?? 0)) * (n[i] ?? 0), 0);
		return Math.abs(i) <= bn * Math.max(...r);
	}
	mapsOf(e) {
		let { usable: t } = this;
		if (this.maps?.mixing === e && this.maps.usable === t) return this.maps.texture;
		this.maps?.texture.dispose();
		let n = Et(this.parts.weights, e, this.parts.omega, this.counts, t);
		return this.maps = {
			texture: n,
			mixing: e,
			usable: t
		}, n;
	}
	fail(e) {
		if (En(e)) return;
		let t = se(e), n = `The picture is drawn with ${this.loaded} of ${this.total} eigen textures.`;
		this.dispatchEvent({
			type: "error",
			error: new E(t.code, `${t.message} ${n}`, t.where)
		});
	}
}, Sn = new _(), K = new T();
function Cn(e, t) {
	return K.setFromMatrixPosition(e.matrixWorld).applyMatrix4(Sn.copy(t.matrixWorld).invert()), [
		K.x,
		K.y,
		K.z
	];
}
function wn(e) {
	let { attributes: t, index: n } = e.geometry;
	return Object.values(t).reduce((e, t) => e + t.array.byteLength, 0) + (n?.array.byteLength ?? 0);
}
function Tn(e) {
	return typeof ImageBitmap < "u" && e instanceof ImageBitmap;
}
function En(e) {
	return e instanceof DOMException && e.name === "AbortError";
}
// eigenfield-three/src/arrival.ts
var Dn = class {
	received = 0;
	chunks = [];
	waiters = [];
	ended = !1;
	broken = null;
	read(e, t) {
		let n = new Promise((n, r) => {
			this.waiters.push({
				from: e,
				to: t,
				resolve: n,
				reject: r
			});
		});
		return n.catch(() => void 0), this.settle(), n;
	}
	push(e) {
		e.length && (this.chunks.push({
			start: this.received,
			bytes: e
		}), this.received += e.length, this.settle());
	}
	end() {
		this.ended = !0, this.settle();
	}
	fail(e) {
		this.broken ??= { reason: e }, this.settle();
	}
	settle() {
		let e = [];
		for (let t of this.waiters) t.to <= this.received ? t.resolve(this.copy(t.from, t.to)) : this.broken ? t.reject(this.broken.reason) : this.ended ? t.reject(oe(this.received, t.to)) : e.push(t);
		this.waiters = e;
	}
	copy(e, t) {
		let n = new Uint8Array(t - e);
		for (let { start: r, bytes: i } of this.chunks) {
			if (r >= t || r + i.length <= e) continue;
			let a = i.subarray(Math.max(0, e - r), Math.min(i.length, t - r));
			n.set(a, Math.max(0, r - e));
		}
		return n.buffer;
	}
}, On = 1179937895, kn = 1313821514, An = 5130562;
async function jn(e) {
	let t = await e.read(0, 4).catch((t) => {
		throw t instanceof E && t.code === "truncated" ? In(e.received === 0) : t;
	});
	if (new DataView(t).getUint32(0, !0) !== On) throw In(!1);
	let n = new DataView(await e.read(0, 12)), r = n.getUint32(4, !0), i = n.getUint32(8, !0);
	if (r !== 2) throw new E("version", `The file is GLB version ${r} and this viewer reads 2; save it as glTF 2.`, "4");
	if (i < 20) throw D("8", "a length of no file");
	let a = new DataView(await e.read(12, 20)), o = a.getUint32(0, !0);
	if (a.getUint32(4, !0) !== kn) throw D("16", "it does not begin with JSON");
	if (o > ue) throw D("12", `${o} bytes of JSON`);
	if (20 + o > i) throw D("12", "a chunk longer than the file");
	let s = Nn(await e.read(20, 20 + o));
	return {
		length: i,
		text: s,
		json: Pn(s),
		binary: () => Mn(e, 20 + o, i)
	};
}
async function Mn(e, t, n) {
	let r = t;
	for (let t = 1; t < 64 && r + 8 <= n; t++) {
		let t = new DataView(await e.read(r, r + 8)), i = t.getUint32(0, !0);
		if (r + 8 + i > n) throw D(String(r), "a chunk longer than the file");
		if (t.getUint32(4, !0) === An) return r + 8;
		r += 8 + i;
	}
	throw D(String(t), "no binary chunk");
}
function Nn(e) {
	try {
		return new TextDecoder("utf-8", { fatal: !0 }).decode(e);
	} catch {
		throw D("20", "its JSON is not UTF-8");
	}
}
function Pn(e) {
	if (Fn(e) > 64) throw D("20", "its JSON is nested too deep");
	try {
		return JSON.parse(e);
	} catch {
		throw D("20", "its JSON cannot be read");
	}
}
function Fn(e) {
	let [t, n] = [0, 0], r = !1;
	for (let i = 0; i < e.length; i++) {
		let a = e[i];
		if (a === "\"") r = !r;
		else if (r && a === "\\") i += 1;
		else if (r) continue;
		else a === "[" || a === "{" ? n = Math.max(n, ++t) : (a === "]" || a === "}") && --t;
	}
	return n;
}
function In(e) {
	return new E("not-glb", e ? "The file is empty; take a .glb file that eigenfield wrote." : "The file is no GLB; take a .glb file that eigenfield wrote.", "0");
}
// eigenfield-three/src/document.ts
var Ln = {
	5121: 1,
	5123: 2,
	5125: 4,
	5126: 4
}, Rn = {
	SCALAR: 1,
	VEC2: 2,
	VEC3: 3
}, zn = 5125;
function Bn(e) {
	let t = new Ft(e, "");
	try {
		return t.key("extensions").key(ce).exists;
	} catch {
		return !1;
	}
}
function Vn(e) {
	let t = new Ft(e, ""), n = t.key("extensions").key(ce), r = Hn(n), i = Un(t), a = Gn(t, i), o = (e) => e.integer(0, i.length - 1);
	Wn(t);
	let s = Jn(t, o), c = n.key("cameras"), l = Yn(c), u = Xn(c, l.length), d = u.filter((e) => !e).length, f = Rt(n, d, s, a, o), p = zt(n, f), m = l.length, h = c.key("colour");
	if (h.exists && p.length < 3) throw h.wrong("needs three channels");
	let g = n.key("viewPlane"), _ = g.key("triangles"), v = t.key("meshes").at(0).key("primitives").at(0), y = v.key("mode");
	if (y.exists && y.integer(0, 6) !== 4) throw y.wrong("no triangles");
	let b = v.key("attributes"), x = n.key("generator");
	return {
		version: r,
		generator: x.exists ? x.text(j) : "",
		planes: f,
		colours: p,
		names: l,
		heldOut: u,
		reference: n.key("reference").integer(0, m - 1),
		intrinsics: a(c.key("intrinsics"), "SCALAR", [V], 5 * m),
		poses: a(c.key("poses"), "SCALAR", [V], 12 * m),
		sizes: a(c.key("sizes"), "SCALAR", [zn], 2 * m),
		colour: h.exists ? a(h, "SCALAR", [V], 6 * m) : null,
		...Zn(g),
		triangles: _.exists ? qn(a(_, "SCALAR", [zn], null)) : null,
		settings: Qn(n.key("settings")),
		scores: Qn(n.key("scores")),
		views: i,
		position: Kn(a(b.key("POSITION"), "VEC3", [V], null), he),
		uv: Kn(a(b.key("TEXCOORD_0"), "VEC2", [V], null), he),
		indices: qn(a(v.key("indices"), "SCALAR", [
			5121,
			5123,
			zn
		], null)),
		preview: s
	};
}
function Hn(e) {
	let t = e.key("version").text(j);
	if (!/^1\.\d+$/.test(t)) throw new E("version", `The scene is of format version ${t.slice(0, 20)} and this viewer reads 1.x; take a newer viewer.`, `${e.where}/version`);
	let n = e.key("needs");
	for (let e of n.exists ? n.items(O) : []) {
		let t = e.text(j);
		if (!le.has(t)) throw new E("needs", `The scene needs "${t.slice(0, 60)}", which this viewer cannot draw; take a newer viewer.`, e.where);
	}
	return t;
}
function Un(e) {
	let t = e.key("buffers").at(0);
	if (t.key("uri").exists) throw t.wrong("not the binary chunk");
	let n = t.key("byteLength").integer(0, 2 ** 32 - 1);
	return e.key("bufferViews").items(O).map((e) => {
		let t = e.key("byteOffset"), r = e.key("byteStride");
		e.key("buffer").integer(0, 0);
		let i = {
			offset: t.exists ? t.integer(0, n) : 0,
			length: e.key("byteLength").integer(1, n),
			stride: r.exists ? r.integer(4, 252) : 0
		};
		if (i.offset + i.length > n) throw e.wrong("outside the buffer");
		return i;
	});
}
function Wn(e) {
	let t = e.key("nodes").items(O), n = Array(t.length).fill(!1);
	for (let e of t) {
		let r = e.key("children");
		for (let e of r.exists ? r.items(t.length) : []) {
			let r = e.integer(0, t.length - 1);
			if (n[r]) throw e.wrong("a node with two parents");
			n[r] = !0;
		}
	}
	for (let r of e.key("scenes").items(O)) {
		let e = r.key("nodes");
		for (let r of e.exists ? e.items(t.length) : []) if (n[r.integer(0, t.length - 1)]) throw r.wrong("a node with two parents");
	}
}
function Gn(e, t) {
	let n = e.key("accessors").items(O);
	return (e, r, i, a) => {
		let o = n[e.integer(0, n.length - 1)];
		if (!o) throw e.wrong("no such accessor");
		let s = o.key("componentType").integer(5120, 5126);
		if (!i.includes(s)) throw o.wrong(`component type ${s}`);
		if (o.key("type").text(1024) !== r) throw o.wrong(`not ${r}`);
		if (o.key("sparse").exists) throw o.wrong("sparse");
		let c = o.key("normalized");
		if (c.exists && c.raw !== !1) throw o.wrong("normalised");
		let l = Rn[r] ?? 1, u = o.key("count").integer(1, _e);
		if (a !== null && u !== a) throw o.wrong(`${a} numbers are needed, not ${u}`);
		let d = o.key("bufferView").integer(0, t.length - 1), f = t[d];
		if (!f) throw o.wrong("no such buffer view");
		let p = o.key("byteOffset"), m = p.exists ? p.integer(0, f.length) : 0, h = Ln[s] * l;
		if (f.stride && (f.stride < h || r === "SCALAR")) throw o.wrong("a stride that cannot be");
		if (m + (u - 1) * (f.stride || h) + h > f.length) throw o.wrong("outside its buffer view");
		if ((m + f.offset) % Ln[s]) throw o.wrong("not aligned");
		return {
			view: d,
			offset: m,
			count: u,
			items: l,
			type: s,
			where: o.where
		};
	};
}
function Kn(e, t) {
	if (e.count > t) throw D(e.where, `more than ${t}`);
	return e;
}
function qn(e) {
	if (e.count % 3) throw D(e.where, "torn triangles");
	return Kn(e, 3 * ge);
}
function Jn(e, t) {
	let n = e.key("images");
	if (!n.exists) return null;
	let r = n.at(0).key("bufferView");
	return r.exists ? t(r) : null;
}
function Yn(e) {
	let t = e.key("names").items(pe).map((e) => e.text(j));
	if (!t.length) throw e.key("names").wrong("no cameras");
	if (new Set(t).size !== t.length) throw e.key("names").wrong("a name stands twice");
	let n = t.findIndex((e) => /[\u0000-\u001f\u007f-\u009f]/.test(e));
	if (n >= 0) throw e.key("names").at(n).wrong("control characters");
	return t;
}
function Xn(e, t) {
	let n = Array(t).fill(!1), r = e.key("heldOut");
	if (!r.exists) return n;
	for (let e of r.items(t)) {
		let r = e.integer(0, t - 1);
		if (n[r]) throw e.wrong("named twice");
		n[r] = !0;
	}
	if (n.every((e) => e)) throw r.wrong("all cameras are held out");
	return n;
}
function Zn(e) {
	let [t, n] = [e.key("right").triple(), e.key("up").triple()], r = (e, t) => e.reduce((e, n, r) => e + n * (t[r] ?? 0), 0);
	for (let i of [
		r(t, t) - 1,
		r(n, n) - 1,
		r(t, n)
	]) if (!(Math.abs(i) <= 2e-4)) throw e.wrong("axes not at right angles, or not of length 1");
	let [i = 0, a = 0] = e.key("extent").numbers(2, 0);
	return {
		origin: e.key("origin").triple(),
		right: t,
		up: n,
		extent: [i, a]
	};
}
function Qn(e) {
	return e.exists ? e.object() : {};
}
// eigenfield-three/src/grid.ts
function $n(e) {
	let t = e.length / 2;
	for (let n = 1; n * n <= t; n++) {
		if (t % n) continue;
		let r = t / n, i = er(e, n, r) ?? (n === r ? null : er(e, r, n));
		if (i) return i;
	}
	return null;
}
function er(e, t, n) {
	let [r, i] = [nr(e, 0), nr(e, 1)];
	if (t === 1 && rr(i) > 0 || n === 1 && rr(r) > 0) return null;
	let a = Array.from(r, (e, t) => t).sort((e, t) => q(i, e) - q(i, t));
	for (let e = 0; e < t; e++) {
		let t = a.slice(e * n, (e + 1) * n).sort((e, t) => q(r, e) - q(r, t));
		a.splice(e * n, n, ...t);
	}
	let o = (e, t) => a[e * n + t] ?? 0;
	return tr(n, t, (e, t) => q(r, o(t, e))) && tr(t, n, (e, t) => q(i, o(e, t))) ? {
		rows: t,
		columns: n,
		index: Int32Array.from(a)
	} : null;
}
function tr(e, t, n) {
	let r = Infinity, i = 0, a = NaN;
	for (let o = 0; o < e; o++) {
		let e = 0;
		for (let r = 0; r < t; r++) e += n(o, r) / t;
		for (let r = 0; r < t; r++) i = Math.max(i, Math.abs(n(o, r) - e));
		o && (r = Math.min(r, e - a)), a = e;
	}
	return r > 0 && (r === Infinity || i <= r / 4);
}
function nr(e, t) {
	return Float64Array.from({ length: e.length / 2 }, (n, r) => e[2 * r + t] ?? 0);
}
function rr(e) {
	return e.reduce((e, t) => Math.max(e, t), -Infinity) - e.reduce((e, t) => Math.min(e, t), Infinity);
}
var q = (e, t) => e[t] ?? 0, ir = 1e-6, J = 32, ar = class {
	places;
	triangles;
	isLine;
	grid;
	rules = /* @__PURE__ */ new Map();
	constructor(e, t, n) {
		this.places = e, this.triangles = t, this.isLine = n, this.grid = $n(e);
	}
	at(e, t, n) {
		let r = n === "bilinear" && !this.grid ? "delaunay" : n, i = this.rules.get(r);
		return i || this.rules.set(r, i = this.makeRule(r)), i(or(e), this.isLine ? 0 : or(t));
	}
	makeRule(e) {
		return e === "nearest3" ? (e, t) => mr(e, t, this.places) : e === "bilinear" && this.grid ? gr(this.places, this.grid) : lr(this.places, this.triangles);
	}
};
function or(e) {
	return Math.min(1, Math.max(-1, e));
}
function sr(e) {
	let t = {
		camera: [
			0,
			0,
			0,
			0
		],
		weight: [
			0,
			0,
			0,
			0
		]
	};
	return e.forEach(([e, n], r) => {
		t.camera[r] = e, t.weight[r] = n;
	}), t;
}
var Y = (e, t) => e[2 * t] ?? 0, X = (e, t) => e[2 * t + 1] ?? 0;
function cr(e, t, n, r, i, a) {
	let [o, s] = [Y(n, r), X(n, r)], [c, l] = [Y(n, i) - o, X(n, i) - s], [u, d] = [Y(n, a) - o, X(n, a) - s], f = c * d - l * u, p = ((e - o) * d - (t - s) * u) / f, m = (c * (t - s) - l * (e - o)) / f;
	return [
		1 - p - m,
		p,
		m
	];
}
function lr(e, t) {
	if (!t.length) {
		let t = pr(e, fr(e));
		return (n, r) => $(n, r, e, t);
	}
	let n = ur(e, t, 3), r = dr(t);
	return (i, a) => {
		let o = -1, s = -Infinity, c = [
			0,
			0,
			0
		];
		for (let r of n[Q(a) * J + Q(i)] ?? []) {
			let [n, l, u] = [
				Z(t, r, 0),
				Z(t, r, 1),
				Z(t, r, 2)
			], d = cr(i, a, e, n, l, u), f = Math.min(...d);
			f > s && ([o, s, c] = [
				r,
				f,
				d
			]);
		}
		return s < -1e-9 ? $(i, a, e, r) : sr(c.map((e, n) => [Z(t, o, n), e]));
	};
}
var Z = (e, t, n) => e[3 * t + n] ?? 0;
function Q(e) {
	return Math.min(31, Math.max(0, Math.floor((e + 1) / 2 * J)));
}
function ur(e, t, n) {
	let r = Array.from({ length: 1024 }, () => []);
	for (let i = 0; i < t.length / n; i++) {
		let a = Array.from({ length: n }, (e, r) => t[n * i + r] ?? 0), o = a.map((t) => Y(e, t)), s = a.map((t) => X(e, t));
		for (let e = Q(Math.min(...s)); e <= Q(Math.max(...s)); e++) for (let t = Q(Math.min(...o)); t <= Q(Math.max(...o)); t++) r[e * J + t]?.push(i);
	}
	return r;
}
function dr(e) {
	let t = /* @__PURE__ */ new Map();
	for (let n = 0; n < e.length / 3; n++) for (let r = 0; r < 3; r++) {
		let [i, a] = [Z(e, n, r), Z(e, n, (r + 1) % 3)], o = i < a ? [i, a] : [a, i], s = t.get(o.join());
		s ? s.times += 1 : t.set(o.join(), {
			edge: o,
			times: 1
		});
	}
	let n = [...t.values()].filter((e) => e.times === 1).map((e) => e.edge);
	return n.sort((e, t) => e[0] - t[0] || e[1] - t[1]), Int32Array.from(n.flat());
}
function $(e, t, n, r) {
	let i = Infinity, a = [
		r[0] ?? 0,
		r[0] ?? 0,
		0
	];
	for (let o = 0; o + 1 < r.length; o += 2) {
		let [s, c] = [r[o] ?? 0, r[o + 1] ?? 0], [l, u] = [Y(n, s), X(n, s)], [d, f] = [Y(n, c) - l, X(n, c) - u], p = d * d + f * f, m = p > 0 ? Math.min(1, Math.max(0, ((e - l) * d + (t - u) * f) / p)) : 0, h = (l + m * d - e) ** 2 + (u + m * f - t) ** 2;
		h < i && ([i, a] = [h, [
			s,
			c,
			m
		]]);
	}
	let [o, s, c] = a;
	return sr([[o, 1 - c], [s, c]]);
}
function fr(e) {
	return Array.from({ length: e.length / 2 }, (e, t) => t);
}
function pr(e, t) {
	let [n = 0] = t;
	if (t.length === 1) return Int32Array.of(n, n);
	let r = [0, 0];
	for (let n of t) r[0] = (r[0] ?? 0) + Y(e, n) / t.length, r[1] = (r[1] ?? 0) + X(e, n) / t.length;
	let [i, a, o] = [
		0,
		0,
		0
	];
	for (let n of t) {
		let [t, s] = [Y(e, n) - (r[0] ?? 0), X(e, n) - (r[1] ?? 0)];
		[i, a, o] = [
			i + t * t,
			a + t * s,
			o + s * s
		];
	}
	let s = .5 * Math.atan2(2 * a, i - o), c = (t) => Y(e, t) * Math.cos(s) + X(e, t) * Math.sin(s), l = [...t].sort((e, t) => c(e) - c(t));
	return Int32Array.from(l.slice(1).flatMap((e, t) => [l[t] ?? 0, e]));
}
function mr(e, t, n) {
	let [r, i, a] = [
		-1,
		-1,
		-1
	], [o, s, c] = [
		Infinity,
		Infinity,
		Infinity
	];
	for (let l = 0; 2 * l < n.length; l++) {
		let [u, d] = [Y(n, l) - e, X(n, l) - t], f = u * u + d * d;
		f >= c || (a = l, c = f, f < s && ([a, c] = [i, s], [i, s] = [l, f]), f < o && ([i, s] = [r, o], [r, o] = [l, f]));
	}
	if (a < 0 || hr(n, r, i, a) <= ir) return $(e, t, n, pr(n, [
		r,
		i,
		a
	].filter((e) => e >= 0)));
	let [l, u, d] = cr(e, t, n, r, i, a);
	return {
		camera: [
			r,
			i,
			a,
			0
		],
		weight: [
			l,
			u,
			d,
			0
		]
	};
}
function hr(e, t, n, r) {
	let [i, a] = [Y(e, n) - Y(e, t), X(e, n) - X(e, t)], [o, s] = [Y(e, r) - Y(e, t), X(e, r) - X(e, t)], c = Math.max(i * i + a * a, o * o + s * s, (i - o) ** 2 + (a - s) ** 2);
	return c > 0 ? Math.abs(i * s - a * o) / c : 0;
}
function gr(e, t) {
	let { rows: n, columns: r, index: i } = t;
	if (Math.min(n, r) === 1) {
		let t = pr(e, fr(e));
		return (n, r) => $(n, r, e, t);
	}
	let a = (e, t) => i[e * r + t] ?? 0, o = [];
	for (let e = 0; e + 1 < n; e++) for (let t = 0; t + 1 < r; t++) o.push([
		a(e, t),
		a(e, t + 1),
		a(e + 1, t + 1),
		a(e + 1, t)
	]);
	let s = ur(e, o.flat(), 4), c = [];
	for (let e = 0; e < r; e++) c.push(a(0, e));
	for (let e = 1; e < n; e++) c.push(a(e, r - 1));
	for (let e = r - 2; e >= 0; e--) c.push(a(n - 1, e));
	for (let e = n - 2; e >= 0; e--) c.push(a(e, 0));
	let l = Int32Array.from(c.slice(1).flatMap((e, t) => [c[t] ?? 0, e]));
	return (t, n) => {
		let r = null, i = -Infinity;
		for (let a of s[Q(n) * J + Q(t)] ?? []) {
			let s = o[a], c = s ? _r(t, n, e, s) : -Infinity;
			s && c > i && ([r, i] = [s, c]);
		}
		if (!r || i < -1e-9) return $(t, n, e, l);
		let [a, c] = vr(t, n, e, r);
		return {
			camera: r,
			weight: [
				(1 - a) * (1 - c),
				a * (1 - c),
				a * c,
				(1 - a) * c
			]
		};
	};
}
function _r(e, t, n, r) {
	let i = Infinity;
	for (let a = 0; a < 4; a++) {
		let [o, s] = [r[a], r[(a + 1) % 4]], [c, l] = [Y(n, o), X(n, o)];
		i = Math.min(i, (Y(n, s) - c) * (t - l) - (X(n, s) - l) * (e - c));
	}
	return i;
}
function vr(e, t, n, r) {
	let [i, a, o, s] = [
		Y(n, r[0]),
		X(n, r[0]),
		Y(n, r[1]),
		X(n, r[1])
	], [c, l, u, d] = [
		Y(n, r[2]),
		X(n, r[2]),
		Y(n, r[3]),
		X(n, r[3])
	], [f, p, m, h, g, _] = [
		e - i,
		t - a,
		o - i,
		s - a,
		u - i,
		d - a
	], [v, y] = [i - o + c - u, a - s + l - d], b = f * h - p * m, x = f * y - p * v - (g * h - _ * m), ee = -(g * y - _ * v), te = Math.sqrt(Math.max(x * x - 4 * b * ee, 0)), S = yr(-2 * b / (x + (x < 0 ? -te : te))), [C, w] = [m + S * v, h + S * y];
	return [yr(((f - S * g) * C + (p - S * _) * w) / (C * C + w * w)), S];
}
function yr(e) {
	return Math.min(1, Math.max(0, e));
}
// eigenfield-three/src/plugin.ts
var br = class {
	parser;
	options;
	name = ce;
	scene = null;
	ours;
	constructor(e, t = {}) {
		this.parser = e, this.options = t, this.ours = Bn(e.json);
	}
	async beforeRoot() {
		this.ours && (this.scene = Vn(this.parser.json));
	}
	loadMaterial(e) {
		let t = this.scene && this.parser.json.meshes[0].primitives[0];
		if (!t || t.material !== e) return null;
		let { doubleSided: n } = this.parser.json.materials?.[e] ?? {}, r = new y();
		return r.side = n === !0 ? 2 : 0, Promise.resolve(r);
	}
	loadBufferView(e) {
		let t = this.scene?.views[e];
		return t && this.options.stream ? this.options.stream.read(t.offset, t.length) : null;
	}
	async afterRoot(e) {
		let { scene: t } = this;
		if (!t) return;
		let n = xr(e, this.parser), [r] = n;
		if (!r) throw D("/meshes/0", "no node shows it");
		Cr(r.geometry, t);
		let i = async (e) => {
			let n = await this.parser.getDependency("bufferView", e);
			if (n.byteLength < (t.views[e]?.length ?? 0)) throw ve(`/bufferViews/${e}`);
			return n;
		}, a = await Promise.all(t.planes.map(({ mean: e }) => i(e.view))), [o, s, c, l] = await Promise.all([
			Promise.all(t.planes.map(({ mean: e, channels: t, meanSize: n }, r) => U(a[r] ?? /* @__PURE__ */ new ArrayBuffer(0), e, t, n))),
			ye(t, i),
			Se(t, i),
			Te(t, i)
		]), u = s.filter((e, n) => !t.heldOut[n]), d = new ar(Float64Array.from(u.flatMap((e) => F(t, e.centre))), l, t.extent[1] === 0), f = o.map(([e]) => [e?.bitmap.width ?? 1, e?.rows ?? 1]), p = Ee(t, s, f, d.grid, this.fileBytes()), m = {
			scene: t,
			info: p,
			meshes: n,
			means: o,
			meanSizes: f,
			rays: p.facesPlane,
			omega: c,
			weights: d,
			bytes: i
		};
		e.userData.eigenfield = new xn(m, this.options);
	}
	fileBytes() {
		if (this.options.stream) return this.options.stream.total;
		let { extensions: e, json: t } = this.parser;
		return e.KHR_binary_glTF?.header?.length ?? t.buffers[0]?.byteLength ?? 0;
	}
};
function xr(e, t) {
	let n = [];
	return e.scene.traverse((e) => {
		let r = t.associations.get(e);
		Sr(e) && r?.meshes === 0 && (r.primitives ?? 0) === 0 && n.push(e);
	}), n;
}
function Sr(e) {
	return e.isMesh === !0;
}
function Cr(e, t) {
	let n = e.getAttribute("position"), r = e.getAttribute("uv"), { index: i } = e;
	if (!i) throw new E("damaged", "The proxy mesh has no triangles; make or download the file again.");
	if (r.count < n.count) throw D(t.uv.where, "too few texture coordinates");
	for (let e = 0; e < n.count; e++) {
		if (!(Math.max(Math.abs(n.getX(e)), Math.abs(n.getY(e)), Math.abs(n.getZ(e))) <= 1e30)) throw D(t.position.where, `vertex ${e} is not finite`);
		if (!(Math.max(Math.abs(r.getX(e)), Math.abs(r.getY(e))) <= 1e30)) throw D(t.uv.where, `texture coordinates of vertex ${e} are not finite`);
	}
	for (let e of i.array) if (e >= n.count) throw D(t.indices.where, `no vertex ${e}`);
}
// eigenfield-three/src/load.ts
async function wr(e, t = {}) {
	let { signal: n } = t;
	n?.throwIfAborted();
	let r = new Dn(), i = new AbortController(), a = () => {
		r.fail(new DOMException("The load was stopped.", "AbortError")), i.abort();
	};
	n?.addEventListener("abort", a);
	let o = Dr(e, r, i.signal, t.onBytes).catch((e) => r.fail(e)).finally(() => n?.removeEventListener("abort", a));
	try {
		let e = await jn(r);
		if (!Bn(e.json)) return {
			gltf: await Er(r, e, o),
			field: null
		};
		let i = await Tr(r, e, t);
		n?.throwIfAborted();
		let a = i.userData.eigenfield;
		return {
			gltf: i,
			field: a instanceof xn ? a : null
		};
	} catch (e) {
		throw i.abort(), n?.throwIfAborted(), se(e);
	}
}
async function Tr(e, t, n) {
	let r = new ae(), i = t.binary();
	i.catch(() => void 0);
	let a = {
		total: t.length,
		read: async (t, n) => {
			let r = await i + t;
			return e.read(r, r + n);
		}
	};
	return r.register((e) => new br(e, {
		...n,
		stream: a
	})), r.parseAsync(t.text, "");
}
async function Er(e, t, n) {
	await n;
	let r = await e.read(0, t.length);
	try {
		return await new ae().parseAsync(r, "");
	} catch (e) {
		let t = se(e).message;
		throw new E("unsupported", `${t} It has no eigen textures either.`, "", { cause: e });
	}
}
async function Dr(e, t, n, r) {
	if (e instanceof ArrayBuffer) return t.push(new Uint8Array(e)), r?.(e.byteLength, e.byteLength), t.end();
	let { body: i, total: a } = e instanceof Blob ? Or(e) : await kr(e, n), o = i.getReader();
	for (n.addEventListener("abort", () => void o.cancel().catch(() => void 0));;) {
		let { done: e, value: i } = await o.read().catch((e) => {
			throw n.aborted ? e : Ar(t.received, e);
		});
		if (e) break;
		t.push(i), r?.(t.received, a);
	}
	n.throwIfAborted(), t.end();
}
function Or(e) {
	return {
		body: e.stream(),
		total: e.size
	};
}
async function kr(e, t) {
	let n = await fetch(e, { signal: t }).catch((n) => {
		throw t.aborted ? n : new E("network", "The scene cannot be fetched; check its address and the connection.", e, { cause: n });
	});
	if (!n.ok || !n.body) throw await n.body?.cancel(), new E("network", `The server answered ${n.status} for the scene; check its address.`, e);
	let r = n.headers.get("Content-Encoding") ? null : n.headers.get("Content-Length");
	return {
		body: n.body,
		total: r && /^\d+$/.test(r) ? Number(r) : void 0
	};
}
function Ar(e, t) {
	return new E("network", `The connection broke after ${e} bytes of the scene; load it again.`, String(e), { cause: t });
}
export { xn as EigenField, br as EigenfieldPlugin, E as SceneError, Ge as defaultMemory, wr as loadEigenfield, ke as novelCamera, Ne as placeCamera };
