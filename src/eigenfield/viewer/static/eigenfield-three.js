import { ClampToEdgeWrapping as e, DataArrayTexture as t, DataUtils as n, DoubleSide as r, EventDispatcher as i, ExternalTexture as a, FrontSide as o, GLSL3 as s, HalfFloatType as c, LinearFilter as l, Matrix3 as u, Matrix4 as d, MeshBasicMaterial as f, RGBAFormat as p, RawShaderMaterial as m, Vector3 as h } from "three";
import { GLTFLoader as g } from "three/addons/loaders/GLTFLoader.js";
// eigenfield-three/src/errors.ts
var _ = class extends Error {
	code;
	where;
	name = "SceneError";
	constructor(e, t, n = "", r) {
		super(t, r), this.code = e, this.where = n;
	}
};
function v(e, t) {
	return new _("damaged", `The file is damaged (${e}: ${t}); make or download it again.`, e);
}
function y(e, t) {
	return new _("truncated", `The file is cut off after ${e} of ${t} bytes; download or copy it again.`, String(e));
}
function b(e, t = "") {
	return e instanceof _ ? e : new _("damaged", `The file cannot be read (${(e instanceof Error ? e.message : String(e)).replace(/^THREE\.GLTFLoader: /, "")}); make or download it again.`, t, { cause: e });
}
// eigenfield-three/src/limits.ts
var x = "EIGENFIELD_eigen_textures", S = /* @__PURE__ */ new Set(), C = 64 * 2 ** 20, w = 16384, T = 16384, E = 2 ** 27, ee = 4096, te = 8 * 2 ** 30, ne = 1e5, re = 2 ** 29, D = 1024, ie = 2 ** 26, ae = 2 ** 27, oe = 2 ** 28, O = 1e30;
// eigenfield-three/src/info.ts
async function k(e, t, n) {
	let r = await n(e.view), i = t.views[e.view]?.length ?? Infinity;
	if (r.byteLength < i) throw se(e.where);
	let a = e.count * e.items, o = r.slice(e.offset, e.offset + 4 * a);
	if (e.type === 5125) return new Uint32Array(o);
	let s = new Float32Array(o);
	for (let t of s) if (!(Math.abs(t) <= 1e30)) throw v(e.where, `${t} among its numbers`);
	return s;
}
function se(e) {
	return new _("truncated", `The file is cut off (${e}); download or copy it again.`, e);
}
async function ce(e, t) {
	let [n, r, i, a] = await Promise.all([
		k(e.intrinsics, e, t),
		k(e.poses, e, t),
		k(e.sizes, e, t),
		e.colour ? k(e.colour, e, t) : null
	]);
	return e.names.map((t, o) => {
		let [s = 0, c = 0, l = 0, u = 0, d = 0] = n.subarray(5 * o, 5 * o + 5);
		if (!(s > 0 && c > 0)) throw v(e.intrinsics.where, `focal lengths of "${t}"`);
		let { R: f, t: p } = le([...r.subarray(12 * o, 12 * o + 12)], e.poses.where, t), [m = 0, h = 0] = i.subarray(2 * o, 2 * o + 2);
		if (!m || !h || Math.max(m, h) > 65535 || m * h > re) throw v(e.sizes.where, `"${t}" is ${m} x ${h} pixels`);
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
		], [_, y] = a ? ue([...a.subarray(6 * o, 6 * o + 6)], e, t) : [null, null];
		return {
			name: t,
			K: g,
			R: f,
			t: p,
			centre: he(f, p),
			width: m,
			height: h,
			gain: _,
			offset: y
		};
	});
}
function le(e, t, n) {
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
		let a = j(i[e], i[r]) - +(e === r);
		if (!(Math.abs(a) <= 2e-4)) throw v(t, `the pose of "${n}" is no rotation`);
	}
	if (!(j(M(i[0], i[1]), i[2]) > 0)) throw v(t, `the pose of "${n}" is mirrored`);
	return {
		R: i,
		t: a
	};
}
function ue(e, t, n) {
	let [r, i] = [e.slice(0, 3), e.slice(3)];
	if (!(r.every((e) => e >= 1 / 1e3 && e <= 1e3) && i.every((e) => Math.abs(e) <= 1e3))) throw v(t.colour?.where ?? "", `gain or offset of "${n}"`);
	return [r, i];
}
async function de(e, t) {
	let n = await Promise.all(e.weights.map((n) => k(n, e, t))), r = e.heldOut.filter((e) => !e).length, i = e.textures.length, a = new Float32Array(r * i), o = 0;
	for (let e of n) {
		let t = e.length / r;
		for (let n = 0; n < r; n++) a.set(e.subarray(n * t, (n + 1) * t), n * i + o);
		o += t;
	}
	return a;
}
async function fe(e, t) {
	if (!e.triangles) return /* @__PURE__ */ new Uint32Array();
	let { where: n } = e.triangles, r = Uint32Array.from(await k(e.triangles, e, t)), i = e.heldOut.filter((e) => !e).length;
	for (let e = 0; e < r.length; e += 3) {
		let [t = i, a = i, o = i] = r.subarray(e, e + 3);
		if (Math.max(t, a, o) >= i) throw v(n, `no encoded camera ${Math.max(t, a, o)}`);
		if (t === a || a === o || o === t) throw v(n, "a triangle with one camera twice");
	}
	return r;
}
function pe(e, t, n, r) {
	let { right: i, up: a } = e, o = M(i, a), s = [
		0,
		0,
		0
	];
	for (let { R: e } of t) for (let n = 0; n < 3; n++) s[n] += e[2][n] / t.length;
	let c = e.settings.metresPerUnit;
	return {
		version: e.version,
		generator: e.generator,
		names: e.names,
		heldOut: e.heldOut,
		reference: e.reference,
		cameras: t,
		viewPlane: {
			origin: e.origin,
			right: i,
			up: a,
			normal: o,
			extent: e.extent
		},
		grid: n && {
			rows: n.rows,
			columns: n.columns
		},
		settings: e.settings,
		scores: e.scores,
		metresPerUnit: typeof c == "number" && c > 0 && c <= 1e30 ? c : null,
		bytes: me(e, r),
		size: e.size,
		vertices: e.position.count,
		triangles: e.indices.count / 3,
		facesPlane: Math.abs(j(s, o)) > .7
	};
}
function me(e, t) {
	let n = /* @__PURE__ */ new Set(), r = (t) => n.has(t) ? 0 : (n.add(t), e.views[t]?.length ?? 0), i = (e) => e.reduce((e, t) => e + r(t), 0), a = i(e.preview === null ? [e.mean.view] : [e.preview, e.mean.view]), o = e.textures.map((e) => r(e.view)), s = i(e.weights.map((e) => e.view)), c = i([
		e.position.view,
		e.uv.view,
		e.indices.view
	]);
	return {
		total: t,
		mesh: c,
		mean: a,
		weights: s,
		other: t - a - s - c - o.reduce((e, t) => e + t, 0),
		textures: o
	};
}
function A(e, t) {
	let { origin: n, extent: r } = e, i = [
		t[0] - n[0],
		t[1] - n[1],
		t[2] - n[2]
	];
	return [r[0] > 0 ? j(i, e.right) / r[0] : 0, r[1] > 0 ? j(i, e.up) / r[1] : 0];
}
function he(e, t) {
	let n = (n) => -(e[0][n] * t[0] + e[1][n] * t[1] + e[2][n] * t[2]);
	return [
		n(0),
		n(1),
		n(2)
	];
}
function j(e, t) {
	return e[0] * t[0] + e[1] * t[1] + e[2] * t[2];
}
function M(e, t) {
	return [
		e[1] * t[2] - e[2] * t[1],
		e[2] * t[0] - e[0] * t[2],
		e[0] * t[1] - e[1] * t[0]
	];
}
// eigenfield-three/src/cameras.ts
function ge(e, t, n) {
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
		let r = _e(n, o, s);
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
	let u = ye(l), { origin: d, right: f, up: p, extent: m } = r.viewPlane, [h, g] = [ve(t) * m[0], ve(n) * m[1]], _ = [
		0,
		1,
		2
	].map((e) => d[e] + h * f[e] + g * p[e]), v = u.map((e) => -j(e, _));
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
function _e({ K: e, width: t, height: n }, r, i) {
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
function ve(e) {
	return Math.min(1, Math.max(-1, e));
}
function ye(e) {
	let t = e;
	for (let e = 0; e < 50; e++) {
		let e = [
			M(t[1], t[2]),
			M(t[2], t[0]),
			M(t[0], t[1])
		], n = j(t[0], e[0]);
		if (!(n > 1e-12)) break;
		let r = t.map((t, r) => t.map((t, i) => (t + e[r][i] / n) / 2)), i = Math.max(...r.flatMap((e, n) => e.map((e, r) => Math.abs(e - t[n][r]))));
		if (t = r, i < 1e-15) break;
	}
	return t;
}
function be(e, t, n, r, i = 1) {
	let a = n.width / n.height, o = i * Math.min(1, a / r), s = i * Math.min(1, r / a), c = {
		left: (1 - o) / 2,
		top: (1 - s) / 2,
		width: o,
		height: s
	};
	return xe(e, t, n), Se(e, t, n, c), t.aspect = r, t.fov = 2 * Math.atan(n.height / (2 * n.K[1][1] * s)) * 180 / Math.PI, c;
}
function xe(e, t, n) {
	let { R: r, centre: i } = n, a = new d().set(r[0][0], -r[1][0], -r[2][0], i[0], r[0][1], -r[1][1], -r[2][1], i[1], r[0][2], -r[1][2], -r[2][2], i[2], 0, 0, 0, 1);
	e.mesh.updateWorldMatrix(!0, !1), a.premultiply(e.mesh.matrixWorld), t.parent && (t.parent.updateWorldMatrix(!0, !1), a.premultiply(t.parent.matrixWorld.clone().invert())), a.decompose(t.position, t.quaternion, new h()), t.updateMatrixWorld(!0);
}
function Se(e, t, n, r) {
	let [[i, a, o], [, s, c]] = n.K, [l, u] = [2 * r.width / n.width, 2 * r.height / n.height], [d, f] = Ce(e, n);
	t.near = d, t.far = f, t.projectionMatrix.set(l * i, -l * a, -(2 * r.left - 1 + l * o), 0, 0, u * s, -(1 - 2 * r.top - u * c), 0, 0, 0, -(f + d) / (f - d), -2 * f * d / (f - d), 0, 0, -1, 0), t.projectionMatrixInverse.copy(t.projectionMatrix).invert();
}
function Ce(e, t) {
	let { geometry: n, matrixWorld: r } = e.mesh;
	n.boundingSphere || n.computeBoundingSphere();
	let { center: i, radius: a } = n.boundingSphere ?? {
		center: new h(),
		radius: 1
	}, o = r.getMaxScaleOnAxis(), s = i.distanceTo(new h(...t.centre)) * o, c = 1.01 * (s + a * o);
	return [Math.max(.5 * (s - a * o), c * 2e-4), c];
}
// eigenfield-three/src/footprint.ts
var we = 256;
function Te(e, t, n) {
	let { index: r } = e, i = e.getAttribute("position"), a = e.getAttribute("uv");
	if (!r || !i || !a) return 0;
	let o = r.count / 3, s = Math.max(1, Math.floor(o / we)), c = [];
	for (let e = 0; e < o; e += s) {
		let o = [
			0,
			1,
			2
		].map((t) => r.getX(3 * e + t)), s = o.map((e) => Ee(t, i.getX(e), i.getY(e), i.getZ(e))), l = De(s), [u = NaN, d = NaN] = [0, 1].map((e) => s.reduce((t, n) => t + (n[e] ?? NaN) / 3, 0));
		if (!(l > 0 && u >= 0 && d >= 0 && u < t.width && d < t.height)) continue;
		let f = De(o.map((e) => [a.getX(e) * n[0], a.getY(e) * n[1]]));
		c.push({
			footprint: Math.sqrt(f / l),
			area: l
		});
	}
	c.sort((e, t) => e.footprint - t.footprint);
	let l = c.reduce((e, { area: t }) => e + t, 0) / 2, u = 0;
	return c.find(({ area: e }) => (u += e) >= l)?.footprint ?? 0;
}
function Ee({ K: e, R: t, t: n }, r, i, a) {
	let o = (e) => t[e][0] * r + t[e][1] * i + t[e][2] * a + n[e], [s, c, l] = [
		o(0),
		o(1),
		o(2)
	];
	return l > 0 ? [(e[0][0] * s + e[0][1] * c) / l + e[0][2], e[1][1] * c / l + e[1][2]] : [NaN, NaN];
}
function De(e) {
	let [[t = 0, n = 0] = [], [r = 0, i = 0] = [], [a = 0, o = 0] = []] = e;
	return Math.abs((r - t) * (o - n) - (i - n) * (a - t)) / 2;
}
// eigenfield-three/src/memory.ts
var Oe = 4 / 3, ke = 2 ** 20;
function Ae() {
	let e = typeof navigator > "u" ? void 0 : navigator, t = e?.deviceMemory, n = e?.userAgent ?? "";
	return /Mobi|Android|iPhone|iPad|Quest/i.test(n) || /Macintosh/.test(n) && je(e) ? Math.min(t ?? 4, 6) * 128 * ke : Math.min(t ?? 8, 8) * 256 * ke;
}
function je(e) {
	return (e?.maxTouchPoints ?? 0) > 1;
}
function N([e, t], n = 1) {
	return Math.round(4 * Oe * Math.ceil(e / n) * Math.ceil(t / n));
}
function P(e, t) {
	return t * Math.max(1, Math.ceil(e / 4));
}
function Me(e) {
	return Math.max(1, Math.ceil(e / 4)) * 129 * 129 * 8;
}
function Ne(e, t) {
	let n = Math.floor((t.vectors - 40) / (2 * e.channels + 1)), r = Math.min(n, Math.floor(t.layers / e.channels)), i = Math.max(0, Math.min(e.total, 4 * r)), a = [
		1,
		2,
		4,
		8,
		16
	].find((n) => Math.max(...e.mean) / n <= t.side && N(e.mean, n) <= t.memory / 2) ?? 16, o = N(e.mean, a) + e.geometry, s = (t, n) => o + (n && P(n, e.channels) * N(e.size, t)) + Me(n), c = (n, r) => s(n, r) + Pe(e, n) <= t.memory, l = (n) => Math.max(...e.size) / n <= t.side, u = [
		1,
		2,
		4
	].find((e) => l(e) && c(e, i)) ?? 4, d = l(u) ? i : 0;
	for (; d > 0 && !c(u, d);) d--;
	let f = {
		meanDown: a,
		scaleDown: u,
		usable: d,
		bytes: s(u, d)
	};
	return {
		...f,
		limitation: Fe(f, e, t)
	};
}
function Pe({ size: e, total: t }, n) {
	return t && 4 * Math.ceil(e[0] / n) * Math.ceil(e[1] / n);
}
function Fe(e, t, n) {
	let r = [];
	if (e.usable < t.total && r.push(`${e.usable} of ${t.total} eigen textures are drawn`), e.usable && e.scaleDown > 1 && r.push(`eigen textures have 1/${e.scaleDown} of their size`), e.meanDown > 1 && r.push(`the mean texture has 1/${e.meanDown} of its size`), !r.length) return null;
	let i = N(t.mean) + P(t.total, t.channels) * N(t.size) + Pe(t, 1) + t.geometry + Me(t.total), a = i > n.memory ? `the scene needs ${Ie(i)} MB of graphics memory and ${Ie(n.memory)} MB may be used` : "this device's graphics allow no more";
	return `${Le(r.join(", "))}: ${a}.`;
}
function Ie(e) {
	return (e / 1e6).toFixed(+(e < 1e7));
}
function Le(e) {
	return e.charAt(0).toUpperCase() + e.slice(1);
}
// eigenfield-three/src/maps.ts
function Re(r, i, a, o, s) {
	let u = Math.max(1, Math.ceil(s / 4)), d = new Uint16Array(u * 129 * 129 * 4);
	for (let e = 0; e < 129; e++) for (let t = 0; t < 129; t++) {
		let { camera: c, weight: l } = r.at(2 * t / 128 - 1, 2 * e / 128 - 1, i), [u, f, p, m] = [
			c[0] * o,
			c[1] * o,
			c[2] * o,
			c[3] * o
		], [h, g, _, v] = l;
		for (let r = 0; r < s; r++) {
			let i = h * (a[u + r] ?? 0) + g * (a[f + r] ?? 0) + _ * (a[p + r] ?? 0) + v * (a[m + r] ?? 0);
			d[4 * (((r >> 2) * 129 + e) * 129 + t) + (r & 3)] = n.toHalfFloat(i);
		}
	}
	let f = new t(d, 129, 129, u);
	return f.format = p, f.type = c, f.minFilter = f.magFilter = l, f.wrapS = f.wrapT = e, f.needsUpdate = !0, f;
}
// ../src/eigenfield/rendering/shaders/surface.glsl?raw
var ze = "// Equations 7 and 8 on the surface of the proxy, one fragment at a time.\n//\n// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl.py and as GLSL ES 3.00 by the web viewer. Whoever\n// includes it writes the #version line, the precisions, and\n//   COUNT     eigen textures in the array, at least 1\n//   CHANNELS  of each as stored: 3, or 1 that stands for all three\n//   BICUBIC   where the finest level is read: 0 bilinear, 1 Catmull-Rom for the mean, 2 for the eigen textures too\n// Four eigen textures share a texel: layer CHANNELS g + c of the array holds channel c of textures 4 g .. 4 g + 3, so\n// that a channel of four is one read and one product with their weights (decision 13).\n// Pixels of more than `finest` texels are left to the samplers and their mip maps.\n// Colours are the photographs' own (sRGB-coded) numbers from end to end: no conversion, in or out.\n\n#define GROUPS ((COUNT + 3) / 4)\n\nuniform sampler2D meanTexture;\nuniform vec3 meanScale;               // mean = stored * meanScale + meanBias, stored in 0..1\nuniform vec3 meanBias;\n\nuniform int count;                    // eigen textures to sum, 0 to COUNT\nuniform sampler2DArray eigenTextures; // stored codes / 255; anything finite where there is no texture (yet)\nuniform vec4 eigenScale[CHANNELS * GROUPS]; // 255 * scale, of each layer\nuniform vec4 eigenBias[CHANNELS * GROUPS];  // -zero * scale\n\nuniform bool rayWeights;              // look the weights up where the ray to the eye meets the view plane\nuniform vec4 viewWeights[GROUPS];     // else these: weights 4 g .. 4 g + 3\nuniform sampler2DArray weightMaps;    // layer g: weights 4 g .. 4 g + 3 over X, Y in -1..1, nodes on the edges\n\nuniform float finest;                 // texels a pixel up to which the finest level is read: 1.5 times those a pixel\n                                      // of the photographs covers, which holds no more than its own average\nuniform float finestEigen;            // the same in texels of the eigen textures, which may be smaller than the mean\nuniform vec3 eye;                     // capture's world, as all that follows\nuniform vec3 planeOrigin;\nuniform vec3 planeNormal;\nuniform vec3 planeX;                  // right / extent[0], up / extent[1]; zero where the extent is\nuniform vec3 planeY;\n\nuniform mat3 toRGB;                   // channels as stored to R, G, B\nuniform vec3 exposureScale;           // picture = RGB * exposureScale + exposureBias: 1 / gain and -offset / gain of a\nuniform vec3 exposureBias;            // captured camera of a harmonised scene, else 1 and 0\n\n// Where the ray from a point of the surface to the eye meets the view plane, as X, Y; where it does not (the eye is\n// level with the point, or the point lies behind the cameras), where the eye itself stands.\nvec2 viewCoordinates(vec3 place) {\n  vec3 ray = eye - place;\n  float along = dot(planeNormal, ray);\n  float height = dot(planeNormal, planeOrigin - place);\n  bool meets = along * height > 0.0 && abs(along) > 1e-5 * length(ray);\n  vec3 offset = (meets ? place + ray * (height / along) : eye) - planeOrigin;\n  return clamp(vec2(dot(offset, planeX), dot(offset, planeY)), -1.0, 1.0);\n}\n\n#if BICUBIC > 0\n// Catmull-Rom's sixteen taps as nine bilinear ones: of the two middle taps of an axis one between them.\nstruct Taps {\n  vec2 at[3];      // texture coordinates\n  vec2 weight[3];\n  vec2 across;     // what a pixel covers, in texture coordinates\n  vec2 down;\n  bool fine;       // false: that is too many texels, let the sampler filter\n};\n\nTaps makeTaps(vec2 uv, vec2 size, float most) {\n  vec2 texel = clamp(uv * size, vec2(0.5), size - 0.5) - 0.5;\n  vec2 base = floor(texel);\n  vec2 f = texel - base;\n  vec2 f2 = f * f, f3 = f2 * f;\n  vec2 w0 = 0.5 * (2.0 * f2 - f3 - f), w1 = 0.5 * (3.0 * f3 - 5.0 * f2 + 2.0);\n  vec2 w2 = 0.5 * (4.0 * f2 - 3.0 * f3 + f), w3 = 0.5 * (f3 - f2);\n  Taps taps;\n  taps.at[0] = (base - 0.5) / size;\n  taps.at[1] = (base + 0.5 + w2 / (w1 + w2)) / size;\n  taps.at[2] = (base + 2.5) / size;\n  taps.weight[0] = w0;\n  taps.weight[1] = w1 + w2;\n  taps.weight[2] = w3;\n  taps.across = dFdx(uv);\n  taps.down = dFdy(uv);\n  vec2 across = taps.across * size, down = taps.down * size;\n  taps.fine = max(dot(across, across), dot(down, down)) <= most * most;\n  return taps;\n}\n\nvec3 readMean(Taps taps, vec2 uv) {\n  vec3 plain = texture(meanTexture, uv, -log2(finest)).rgb;\n  if (!taps.fine) return plain;\n  vec3 sum = vec3(0.0);\n  for (int row = 0; row < 3; row++)\n    for (int column = 0; column < 3; column++)\n      sum += taps.weight[column].x * taps.weight[row].y *\n             textureLod(meanTexture, vec2(taps.at[column].x, taps.at[row].y), 0.0).rgb;\n  return sum;\n}\n#endif\n\n#if BICUBIC > 1\nTaps eigenTaps; // of this fragment; whoever reads layers makes them first\n\nvec4 readLayer(vec2 uv, int layer) {\n  if (!eigenTaps.fine) { // the next fragment's may be: no derivatives here\n    vec2 across = eigenTaps.across / finestEigen, down = eigenTaps.down / finestEigen;\n    return textureGrad(eigenTextures, vec3(uv, float(layer)), across, down);\n  }\n  vec4 sum = vec4(0.0);\n  for (int row = 0; row < 3; row++)\n    for (int column = 0; column < 3; column++)\n      sum += eigenTaps.weight[column].x * eigenTaps.weight[row].y *\n             textureLod(eigenTextures, vec3(eigenTaps.at[column].x, eigenTaps.at[row].y, float(layer)), 0.0);\n  return sum;\n}\n\nvoid readyTaps(vec2 uv) { eigenTaps = makeTaps(uv, vec2(textureSize(eigenTextures, 0).xy), finestEigen); }\n#else\nvec4 readLayer(vec2 uv, int layer) {\n  return texture(eigenTextures, vec3(uv, float(layer)), -log2(finestEigen));\n}\n\nvoid readyTaps(vec2 uv) {}\n#endif\n\n// One channel of four eigen textures, weighted and summed.\nfloat sumLayer(vec2 uv, int layer, vec4 weights) {\n  return dot(weights, readLayer(uv, layer) * eigenScale[layer] + eigenBias[layer]);\n}\n\nvec3 sumGroup(vec2 uv, int group, vec4 weights) {\n#if CHANNELS == 1\n  return vec3(sumLayer(uv, group, weights));\n#else\n  int layer = 3 * group;\n  return vec3(sumLayer(uv, layer, weights), sumLayer(uv, layer + 1, weights), sumLayer(uv, layer + 2, weights));\n#endif\n}\n\nvec4 weightsOf(int group, vec2 view) {\n  if (!rayWeights) return viewWeights[group];\n  vec2 nodes = vec2(textureSize(weightMaps, 0).xy);\n  vec2 at = (0.5 + (0.5 + 0.5 * view) * (nodes - 1.0)) / nodes;\n  return textureLod(weightMaps, vec3(at, float(group)), 0.0);\n}\n\n// The mean alone, as R, G, B.\nvec3 meanColour(vec2 uv) {\n#if BICUBIC > 0\n  vec3 stored = readMean(makeTaps(uv, vec2(textureSize(meanTexture, 0)), finest), uv);\n#else\n  vec3 stored = texture(meanTexture, uv, -log2(finest)).rgb;\n#endif\n  return toRGB * (stored * meanScale + meanBias);\n}\n\n// One eigen texture's values, which are signed.\nvec3 eigenColour(vec2 uv, int j) {\n  readyTaps(uv);\n  return toRGB * sumGroup(uv, j / 4, vec4(equal(ivec4(j % 4), ivec4(0, 1, 2, 3))));\n}\n\n// mean + sum over j of w_j(view) E_j (equation 8) at texture coordinates uv of the surface point `place`.\nvec3 surfaceColour(vec2 uv, vec3 place) {\n  vec3 sum = vec3(0.0);\n  vec2 view = rayWeights ? viewCoordinates(place) : vec2(0.0);\n  readyTaps(uv);\n  for (int group = 0; group < GROUPS; group++) {\n    if (4 * group >= count) break;\n    vec4 summed = vec4(lessThan(ivec4(4 * group) + ivec4(0, 1, 2, 3), ivec4(count))); // 0 from `count` on\n    sum += sumGroup(uv, group, weightsOf(group, view) * summed);\n  }\n  vec3 colour = meanColour(uv) + toRGB * sum;\n  return clamp(colour * exposureScale + exposureBias, 0.0, 1.0);\n}\n", Be = {
	bilinear: 0,
	mixed: 1,
	bicubic: 2
}, Ve = {
	picture: 0,
	mean: 1,
	eigen: 2,
	error: 3
}, He = "\nprecision highp float;\nuniform mat4 modelViewMatrix;\nuniform mat4 projectionMatrix;\nin vec3 position;\nin vec2 uv;\nout vec2 surfaceUv;\nout vec3 surfacePlace;\nvoid main() {\n  surfaceUv = uv;\n  surfacePlace = position;\n  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));\n}\n", Ue = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
${ze}
uniform int shown;             // 0 the picture, 1 the mean, 2 one eigen texture, 3 the error
uniform int shownEigen;
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
  if (shown == 1) colour = clamp(meanColour(surfaceUv) * exposureScale + exposureBias, 0.0, 1.0);
  else if (shown == 2) colour = clamp(0.5 + shownGain * eigenColour(surfaceUv, shownEigen), 0.0, 1.0);
  else colour = surfaceColour(surfaceUv, surfacePlace);
  if (shown == 3) colour = errorColour(colour);
  fragment = vec4(colour, 1.0);
}
`;
function We(e, t, n, i) {
	let a = (e, t) => new h(...e).multiplyScalar(t > 0 ? 1 / t : 0), c = {
		meanTexture: { value: t },
		meanScale: { value: Ke(e.mean) },
		meanBias: { value: qe(e.mean) },
		count: { value: 0 },
		eigenTextures: { value: n },
		eigenScale: { value: new Float32Array(4 * e.channels) },
		eigenBias: { value: new Float32Array(4 * e.channels) },
		rayWeights: { value: !1 },
		viewWeights: { value: /* @__PURE__ */ new Float32Array(4) },
		weightMaps: { value: null },
		finest: { value: 1 },
		finestEigen: { value: 1 },
		eye: { value: new h() },
		planeOrigin: { value: new h(...e.origin) },
		planeNormal: { value: new h().crossVectors(new h(...e.right), new h(...e.up)) },
		planeX: { value: a(e.right, e.extent[0]) },
		planeY: { value: a(e.up, e.extent[1]) },
		toRGB: { value: new u() },
		exposureScale: { value: new h(1, 1, 1) },
		exposureBias: { value: new h() },
		shown: { value: Ve.picture },
		shownEigen: { value: 0 },
		shownGain: { value: 1 },
		photograph: { value: null },
		toPhotograph: { value: new d() }
	}, l = new m({
		glslVersion: s,
		vertexShader: He,
		fragmentShader: Ue,
		uniforms: c,
		defines: {
			COUNT: 1,
			CHANNELS: e.channels,
			BICUBIC: Be.mixed
		},
		side: i ? r : o
	});
	return l.name = "eigen textures", l;
}
function Ge(e, t, n) {
	let r = Math.max(1, n), { uniforms: i, defines: a } = e, o = P(r, a.CHANNELS), s = i.eigenScale.value = new Float32Array(4 * o), c = i.eigenBias.value = new Float32Array(4 * o);
	t.slice(0, n).forEach((e, t) => {
		let [n, r] = [Ke(e), qe(e)];
		for (let e = 0; e < a.CHANNELS; e++) {
			let i = 4 * (a.CHANNELS * Math.floor(t / 4) + e) + t % 4;
			s[i] = n.getComponent(e), c[i] = r.getComponent(e);
		}
	}), i.viewWeights.value = new Float32Array(4 * Math.ceil(r / 4)), e.defines.COUNT = r, e.needsUpdate = !0;
}
function Ke(e) {
	return new h().fromArray(e.scale).multiplyScalar(255);
}
function qe(e) {
	return new h().fromArray(e.scale.map((t, n) => -(e.zero[n] ?? 0) * t));
}
// eigenfield-three/src/headers.ts
function Je(e) {
	let t = new DataView(e);
	try {
		return Ye(t) ?? Xe(t) ?? Ze(t) ?? Qe(t);
	} catch (e) {
		if (e instanceof RangeError) return null;
		throw e;
	}
}
function F(e, t) {
	return String.fromCharCode(...[
		0,
		1,
		2,
		3
	].map((n) => e.getUint8(t + n)));
}
function Ye(e) {
	return e.getUint32(0) !== 2303741511 || e.getUint32(4) !== 218765834 || F(e, 12) !== "IHDR" ? null : {
		type: "image/png",
		width: e.getUint32(16),
		height: e.getUint32(20)
	};
}
function Xe(e) {
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
function Ze(e) {
	if (F(e, 0) !== "RIFF" || F(e, 8) !== "WEBP") return null;
	let t = "image/webp", n = F(e, 12), r = (t) => e.getUint16(t, !0) + 65536 * e.getUint8(t + 2);
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
function Qe(e) {
	if (F(e, 4) !== "ftyp") return null;
	let t = null, n = (r, i) => {
		for (let a = r; a + 8 <= i;) {
			let r = e.getUint32(a), o = F(e, a + 4), s = r === 0 ? i : a + r;
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
var $e = {
	colorSpaceConversion: "none",
	premultiplyAlpha: "none"
}, et = {
	"image/avif": "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOltZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAAAAABAAAAHmlsb2MAAAAARAAAAQABAAAAAQAAAQ0AAAAZAAAAKGlpbmYAAAAAAAEAAAAaaW5mZQIAAAAAAQAAYXYwMUNvbG9yAAAAAGhpcHJwAAAASWlwY28AAAAUaXNwZQAAAAAAAAAIAAAACAAAAA5waXhpAAAAAAEIAAAADGF2MUOBABwAAAAAE2NvbHJuY2x4AAEADQAGgAAAABdpcG1hAAAAAAAAAAEAAQQBAoMEAAAAIW1kYXQSAAoIGAi/aYCGg1AyCxlGIYeeaACQQNmg",
	"image/webp": "UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAAAdQwAIWsP+BiOh/AAA="
};
function tt(e, t, n) {
	let r = Je(e);
	if (!r) throw v(t.where, "no picture");
	let { width: i, height: a } = r;
	if (n && (i !== n[0] || a !== n[1])) throw v(t.where, `a picture of ${i} x ${a}, not of ${n[0]} x ${n[1]}`);
	let o = i * a;
	if (!o || Math.max(i, a) > 16384 || o > E) throw v(t.where, `a picture of ${i} x ${a}`);
	return [i, a];
}
async function I(e, t, n, r = 1) {
	let [i, a] = tt(e, t, n), [o, s] = [Math.ceil(i / r), Math.ceil(a / r)], c = r === 1 ? {} : {
		resizeWidth: o,
		resizeHeight: s,
		resizeQuality: "high"
	}, l = Je(e)?.type ?? t.mimeType, u;
	try {
		u = await createImageBitmap(new Blob([e], { type: l }), {
			...$e,
			...c
		});
	} catch (e) {
		throw await nt(l) ? v(t.where, "it cannot be decoded") : rt(l, t, e);
	}
	if (u.width === o && u.height === s) return u;
	throw u.close(), v(t.where, `decoded to ${u.width} x ${u.height}, not to ${o} x ${s}`);
}
async function nt(e) {
	let t = et[e];
	if (!t) return !0;
	let n = Uint8Array.from(atob(t), (e) => e.charCodeAt(0));
	try {
		return (await createImageBitmap(new Blob([n], { type: e }))).close(), !0;
	} catch {
		return !1;
	}
}
function rt(e, t, n) {
	return new _("codec", `This browser cannot decode ${e.replace("image/", "").toUpperCase()} pictures; use a newer one, or encode the scene with --codec png.`, t.where, { cause: n });
}
// eigenfield-three/src/strength.ts
var L = 128, it = .98;
async function at(e, t) {
	let n = await I(e, t, null), r = new OffscreenCanvas(L, L).getContext("2d", { willReadFrequently: !0 });
	if (!r) return 1;
	r.imageSmoothingEnabled = !1, r.drawImage(n, 0, 0, L, L), n.close();
	let { data: i } = r.getImageData(0, 0, L, L), a = [];
	for (let e = 0; e < i.length; e++) {
		let n = e & 3, r = ((i[e] ?? 0) - (t.zero[n] ?? 0)) * (t.scale[n] ?? 0);
		n < 3 && a.push(Math.abs(r));
	}
	a.sort((e, t) => e - t);
	let o = a[Math.floor(it * a.length)] ?? 0;
	return o > 0 ? .45 / o : 1;
}
// eigenfield-three/src/gpu.ts
function ot(e, t) {
	return {
		side: e.getParameter(e.MAX_TEXTURE_SIZE),
		layers: e.getParameter(e.MAX_ARRAY_TEXTURE_LAYERS),
		vectors: e.getParameter(e.MAX_FRAGMENT_UNIFORM_VECTORS),
		memory: t
	};
}
function st(e, t) {
	let n = e.createTexture();
	return R(e, e.TEXTURE_2D, n, () => {
		e.texStorage2D(e.TEXTURE_2D, ft(t.width, t.height), e.RGBA8, t.width, t.height), e.texSubImage2D(e.TEXTURE_2D, 0, 0, 0, e.RGBA, e.UNSIGNED_BYTE, t), e.generateMipmap(e.TEXTURE_2D), pt(e, e.TEXTURE_2D), mt(e, e.TEXTURE_2D);
	}), n;
}
function ct(e, t, n, r) {
	return ut(e, e.TEXTURE_2D_ARRAY, () => {
		e.texStorage3D(e.TEXTURE_2D_ARRAY, ft(t, n), e.RGBA8, t, n, r), pt(e, e.TEXTURE_2D_ARRAY), e.texParameteri(e.TEXTURE_2D_ARRAY, e.TEXTURE_MIN_FILTER, e.LINEAR), e.texParameteri(e.TEXTURE_2D_ARRAY, e.TEXTURE_MAG_FILTER, e.LINEAR);
	});
}
function lt(e, t, n) {
	return ut(e, e.TEXTURE_2D, () => {
		e.texStorage2D(e.TEXTURE_2D, 1, e.RGBA8, t, n), e.texParameteri(e.TEXTURE_2D, e.TEXTURE_MIN_FILTER, e.NEAREST);
	});
}
function ut(e, t, n) {
	for (; e.getError() !== e.NO_ERROR && !e.isContextLost(););
	let r = e.createTexture();
	return R(e, t, r, n), e.getError() === e.OUT_OF_MEMORY ? (e.deleteTexture(r), null) : r;
}
function dt(e, t) {
	R(e, e.TEXTURE_2D_ARRAY, t, () => {
		e.generateMipmap(e.TEXTURE_2D_ARRAY), mt(e, e.TEXTURE_2D_ARRAY);
	});
}
function ft(e, t) {
	return 1 + Math.floor(Math.log2(Math.max(e, t)));
}
function pt(e, t) {
	e.texParameteri(t, e.TEXTURE_WRAP_S, e.CLAMP_TO_EDGE), e.texParameteri(t, e.TEXTURE_WRAP_T, e.CLAMP_TO_EDGE);
}
function mt(e, t) {
	e.texParameteri(t, e.TEXTURE_MIN_FILTER, e.LINEAR_MIPMAP_LINEAR), e.texParameteri(t, e.TEXTURE_MAG_FILTER, e.LINEAR);
}
function R(e, t, n, r) {
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
var ht = "#version 300 es\nvoid main() {\n  gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);\n}\n", gt = "#version 300 es\nprecision highp float;\nuniform highp sampler2D picture;\nuniform int channel;\nout vec4 code;\nvoid main() {\n  code = vec4(texelFetch(picture, ivec2(gl_FragCoord.xy), 0)[channel]);\n}\n";
function _t(e, t, n, r) {
	let i = vt(e), [a, o] = [e.createFramebuffer(), e.createVertexArray()], s = e.getUniformLocation(i, "channel"), c = ({ width: n, height: c }, l) => {
		e.useProgram(i), e.bindVertexArray(o), e.bindFramebuffer(e.DRAW_FRAMEBUFFER, a), e.viewport(0, 0, n, c), e.colorMask(l % 4 == 0, l % 4 == 1, l % 4 == 2, l % 4 == 3);
		for (let n = 0; n < r; n++) {
			let i = r * Math.floor(l / 4) + n;
			e.framebufferTextureLayer(e.DRAW_FRAMEBUFFER, e.COLOR_ATTACHMENT0, t, 0, i), e.uniform1i(s, n), e.drawArrays(e.TRIANGLES, 0, 3);
		}
	};
	return {
		put(t, r) {
			yt(e, () => R(e, e.TEXTURE_2D, n, () => {
				e.texSubImage2D(e.TEXTURE_2D, 0, 0, 0, e.RGBA, e.UNSIGNED_BYTE, t), bt(e, () => c(t, r));
			}));
		},
		free() {
			e.deleteTexture(n), e.deleteVertexArray(o), e.deleteFramebuffer(a), e.deleteProgram(i);
		}
	};
}
function vt(e) {
	let t = e.createProgram();
	for (let [n, r] of [[e.VERTEX_SHADER, ht], [e.FRAGMENT_SHADER, gt]]) {
		let i = e.createShader(n);
		i && (e.shaderSource(i, r), e.compileShader(i), e.attachShader(t, i), e.deleteShader(i));
	}
	return e.linkProgram(t), t;
}
function yt(e, t) {
	let n = e.getParameter(e.ACTIVE_TEXTURE);
	e.activeTexture(e.TEXTURE0);
	let r = e.getParameter(e.SAMPLER_BINDING);
	e.bindSampler(0, null), t(), e.bindSampler(0, r), e.activeTexture(n);
}
function bt(e, t) {
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
var xt = 3, St = class {
	parts;
	geometry;
	options;
	mean = new a();
	eigen = new a();
	plan = null;
	loaded = 0;
	onPlan = () => void 0;
	onTexture = () => void 0;
	onComplete = () => void 0;
	onError = () => void 0;
	renderer = null;
	packer = null;
	bitmap;
	meanSize;
	turn = 0;
	disposed = !1;
	constructor(e, t, n) {
		this.parts = e, this.geometry = t, this.options = n, this.bitmap = e.mean, this.meanSize = [e.mean.width, e.mean.height];
	}
	get attached() {
		return this.renderer !== null || this.disposed;
	}
	attach(e) {
		if (this.disposed) return;
		let t = e.getContext();
		if (!(t instanceof WebGL2RenderingContext)) throw new _("unsupported", "Eigen textures need WebGL 2; use a newer browser.");
		this.detach(), this.renderer = e, e.domElement.addEventListener("webglcontextlost", this.onLost), e.domElement.addEventListener("webglcontextrestored", this.onRestored);
		let n = this.turn;
		this.load(t, n).catch((e) => {
			n === this.turn && this.onError(e);
		});
	}
	dispose() {
		this.detach(), this.disposed = !0, this.bitmap?.close(), this.bitmap = null;
	}
	detach() {
		this.turn += 1, this.loaded = 0;
		let e = this.renderer?.getContext();
		this.freePacker();
		for (let t of [this.mean, this.eigen]) e && t.sourceTexture instanceof WebGLTexture && e.deleteTexture(t.sourceTexture), t.sourceTexture = null;
		this.renderer?.domElement.removeEventListener("webglcontextlost", this.onLost), this.renderer?.domElement.removeEventListener("webglcontextrestored", this.onRestored), this.renderer = null;
	}
	onLost = () => {
		this.turn += 1, this.loaded = 0, this.mean.sourceTexture = this.eigen.sourceTexture = null, this.packer = null;
	};
	onRestored = () => {
		this.renderer && this.attach(this.renderer);
	};
	async load(e, t) {
		let { array: n, packer: r, plan: i } = this.makeRoom(e);
		this.plan = i, this.packer = r, this.eigen.sourceTexture = n, this.onPlan(i), await this.loadMean(e, t, i.meanDown);
		let a = [];
		try {
			for (let e = 0; e < i.usable; e++) {
				for (; a.length < xt && e + a.length < i.usable;) a.push(this.decode(e + a.length, i.scaleDown));
				let n = await a[0];
				if (a.shift(), t === this.turn && n && r.put(n, e), n?.close(), t !== this.turn) return;
				this.loaded = e + 1, this.onTexture();
			}
		} finally {
			for (let e of a) e.then((e) => e.close()).catch(() => void 0);
		}
		t === this.turn && (this.freePacker(), dt(e, n), this.onComplete());
	}
	makeRoom(e) {
		let { size: t, textures: n, channels: r } = this.parts.scene, i = {
			mean: this.meanSize,
			size: t,
			channels: r,
			total: n.length,
			geometry: this.geometry
		};
		for (let n = this.options.memory ?? Ae();; n /= 2) {
			let a = Ne(i, ot(e, n)), [o, s] = a.usable ? t : [1, 1], [c, l] = [Math.ceil(o / a.scaleDown), Math.ceil(s / a.scaleDown)], [u, d] = [ct(e, c, l, P(a.usable, r)), lt(e, c, l)];
			if (u && d) return {
				array: u,
				packer: _t(e, u, d, r),
				plan: a
			};
			if (e.deleteTexture(u), e.deleteTexture(d), !a.usable) throw new _("unsupported", "The graphics memory is full; close other pages and try again.");
		}
	}
	freePacker() {
		this.packer?.free(), this.packer = null;
	}
	async loadMean(e, t, n) {
		let { scene: r, bytes: i } = this.parts, { bitmap: a } = this;
		this.bitmap = null, (!a || n > 1) && (a?.close(), a = await I(await i(r.mean.view), r.mean, r.meanSize, n)), t === this.turn && (this.mean.sourceTexture = st(e, a)), a.close();
	}
	decode(e, t) {
		let { scene: n, bytes: r } = this.parts, i = n.textures[e];
		if (!i) return Promise.reject(/* @__PURE__ */ RangeError(`no eigen texture ${e}`));
		let a = r(i.view).then((e) => I(e, i, n.size, t));
		return a.catch(() => void 0), a;
	}
}, Ct = 1.5, wt = .001, z = class extends i {
	parts;
	mesh;
	info;
	total;
	count = Infinity;
	weightMode;
	mixing = "delaunay";
	filter;
	camera = null;
	exposure = null;
	view = "picture";
	eigen = 0;
	photograph = null;
	lastWeights = [];
	complete;
	material;
	textures;
	rowOf;
	gains = /* @__PURE__ */ new Map();
	detail;
	meanSize;
	maps = null;
	frame = -1;
	constructor(e, t = {}) {
		super(), this.parts = e;
		let { scene: n, info: r, meshes: i, mean: a } = e, [s] = i;
		if (!s) throw Error("a field needs a mesh");
		this.mesh = s, this.info = r, this.total = n.textures.length, this.filter = t.filter ?? "mixed", this.weightMode = r.facesPlane ? "ray" : "eye";
		let c = 0;
		this.rowOf = Int32Array.from(n.heldOut, (e) => e ? -1 : c++), this.textures = new St(e, Dt(s), t);
		let l = [s.material].flat().some((e) => e.side !== o);
		this.material = We(n, this.textures.mean, this.textures.eigen, l), this.complete = new Promise((e, t) => {
			this.addEventListener("complete", () => e()), this.addEventListener("error", ({ error: e }) => t(e));
		}), this.complete.catch(() => void 0);
		let u = r.cameras[r.reference];
		this.detail = u ? Te(s.geometry, u, [1, 1]) : 0, this.meanSize = [a.width, a.height], this.listen();
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
		let t = this.rowOf[e] ?? -1, n = this.info.cameras[e];
		if (t >= 0) return Float64Array.from(this.parts.omega.subarray(t * this.total, (t + 1) * this.total));
		if (!n) throw RangeError(`no camera ${e}`);
		return this.componentWeights(...A(this.info.viewPlane, n.centre));
	}
	restore(e) {
		this.textures.attach(e);
	}
	dispose() {
		this.textures.dispose(), this.maps?.texture.dispose(), this.material.dispose(), this.mesh.geometry.dispose();
	}
	listen() {
		this.textures.onPlan = ({ usable: e, meanDown: t, scaleDown: n, limitation: r }) => {
			let { scene: i } = this.parts;
			Ge(this.material, i.textures, e), this.material.uniforms.finest.value = this.finestOf(this.meanSize, t), this.material.uniforms.finestEigen.value = this.finestOf(i.size, n), r && queueMicrotask(() => this.dispatchEvent({ type: "limited" }));
		}, this.textures.onTexture = () => this.dispatchEvent({ type: "texture" }), this.textures.onComplete = () => this.dispatchEvent({ type: "complete" }), this.textures.onError = (e) => this.fail(e);
	}
	finestOf([e, t], n) {
		return Ct * Math.max(1, this.detail * Math.sqrt(e * t) / n);
	}
	mix({ camera: e, weight: t }) {
		let { omega: n } = this.parts, r = new Float64Array(this.total);
		for (let i = 0; i < 4; i++) {
			let a = t[i] ?? 0;
			if (!a) continue;
			let o = (e[i] ?? 0) * this.total;
			for (let e = 0; e < this.total; e++) r[e] = (r[e] ?? 0) + a * (n[o + e] ?? 0);
		}
		return r;
	}
	prepare(e, t, n) {
		this.textures.attached || this.textures.attach(e);
		let { uniforms: r } = this.material, i = Et(t, n, r.eye.value), [a, o] = A(this.info.viewPlane, i), s = this.camera !== null && this.info.cameras[this.camera] ? this.camera : null, c = s === null ? this.componentWeights(a, o) : this.cameraWeights(s);
		r.viewWeights.value.fill(0), r.viewWeights.value.set(c.subarray(0, this.usable)), r.rayWeights.value = s === null && this.weightMode === "ray" && this.info.facesPlane && !this.isOnPlane(i), r.rayWeights.value && (r.weightMaps.value = this.mapsOf(this.mixing)), r.count.value = Math.min(this.loaded, Math.max(0, Math.floor(this.count))), this.setView();
		let l = Be[this.filter];
		this.material.defines.BICUBIC !== l && (this.material.defines.BICUBIC = l, this.material.needsUpdate = !0), this.material.uniformsNeedUpdate = !0, e.info.render.frame !== this.frame && (this.lastWeights = []), this.frame = e.info.render.frame, this.lastWeights.push(c);
	}
	setView() {
		let { uniforms: e } = this.material, t = this.view === "error" && this.photograph !== null && this.camera !== null, n = this.exposure ?? (t ? this.camera : null), { gain: r = null, offset: i = null } = (n === null ? void 0 : this.info.cameras[n]) ?? {}, a = (r ?? [
			1,
			1,
			1
		]).map((e) => 1 / e);
		e.exposureScale.value.fromArray(a), e.exposureBias.value.fromArray(a.map((e, t) => -(i?.[t] ?? 0) * e));
		let o = this.view === "error" && !t ? "picture" : this.view, s = Math.min(Math.max(0, Math.floor(this.eigen)), this.total - 1);
		e.shown.value = Ve[o === "eigen" && s >= this.loaded ? "mean" : o], e.shownEigen.value = Math.max(0, s), o === "eigen" && (e.shownGain.value = this.gainOf(s)), t && this.aimPhotograph();
	}
	aimPhotograph() {
		let e = this.camera === null ? void 0 : this.info.cameras[this.camera], { photograph: t } = this;
		if (!e || !t) return;
		let { K: n, R: r, t: i, width: a, height: o } = e, s = new d().set(...r[0], i[0], ...r[1], i[1], ...r[2], i[2], 0, 0, 0, 1), c = new d().set(...n[0], 0, ...n[1], 0, 0, 0, 0, 0, ...n[2], 0), l = t.flipY && !Ot(t.image), u = new d().makeScale(1 / a, (l ? -1 : 1) / o, 1);
		l && (u.elements[13] = 1), this.material.uniforms.toPhotograph.value.multiplyMatrices(u, c.multiply(s)), this.material.uniforms.photograph.value = t;
	}
	gainOf(e) {
		let t = this.gains.get(e);
		if (t !== void 0) return t;
		let n = this.parts.scene.textures[e];
		return this.gains.set(e, 1), n && this.parts.bytes(n.view).then((e) => at(e, n)).then((t) => {
			this.gains.set(e, t), this.dispatchEvent({ type: "texture" });
		}).catch(() => void 0), 1;
	}
	isOnPlane(e) {
		let { origin: t, normal: n, extent: r } = this.info.viewPlane, i = e.reduce((e, r, i) => e + (r - (t[i] ?? 0)) * (n[i] ?? 0), 0);
		return Math.abs(i) <= wt * Math.max(...r);
	}
	mapsOf(e) {
		let { usable: t } = this;
		if (this.maps?.mixing === e && this.maps.usable === t) return this.maps.texture;
		this.maps?.texture.dispose();
		let n = Re(this.parts.weights, e, this.parts.omega, this.total, t);
		return this.maps = {
			texture: n,
			mixing: e,
			usable: t
		}, n;
	}
	fail(e) {
		if (kt(e)) return;
		let t = b(e), n = `The picture is drawn with ${this.loaded} of ${this.total} eigen textures.`;
		this.dispatchEvent({
			type: "error",
			error: new _(t.code, `${t.message} ${n}`, t.where)
		});
	}
}, Tt = new d(), B = new h();
function Et(e, t, n) {
	return B.setFromMatrixPosition(e.matrixWorld).applyMatrix4(Tt.copy(t.matrixWorld).invert()), n.copy(B), [
		B.x,
		B.y,
		B.z
	];
}
function Dt(e) {
	let { attributes: t, index: n } = e.geometry;
	return Object.values(t).reduce((e, t) => e + t.array.byteLength, 0) + (n?.array.byteLength ?? 0);
}
function Ot(e) {
	return typeof ImageBitmap < "u" && e instanceof ImageBitmap;
}
function kt(e) {
	return e instanceof DOMException && e.name === "AbortError";
}
// eigenfield-three/src/arrival.ts
var At = class {
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
		for (let t of this.waiters) t.to <= this.received ? t.resolve(this.copy(t.from, t.to)) : this.broken ? t.reject(this.broken.reason) : this.ended ? t.reject(y(this.received, t.to)) : e.push(t);
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
}, jt = 1179937895, Mt = 1313821514, Nt = 5130562;
async function Pt(e) {
	let t = await e.read(0, 4).catch((t) => {
		throw t instanceof _ && t.code === "truncated" ? zt(e.received === 0) : t;
	});
	if (new DataView(t).getUint32(0, !0) !== jt) throw zt(!1);
	let n = new DataView(await e.read(0, 12)), r = n.getUint32(4, !0), i = n.getUint32(8, !0);
	if (r !== 2) throw new _("version", `The file is GLB version ${r} and this viewer reads 2; save it as glTF 2.`, "4");
	if (i < 20) throw v("8", "a length of no file");
	let a = new DataView(await e.read(12, 20)), o = a.getUint32(0, !0);
	if (a.getUint32(4, !0) !== Mt) throw v("16", "it does not begin with JSON");
	if (o > C) throw v("12", `${o} bytes of JSON`);
	if (20 + o > i) throw v("12", "a chunk longer than the file");
	let s = It(await e.read(20, 20 + o));
	return {
		length: i,
		text: s,
		json: Lt(s),
		binary: () => Ft(e, 20 + o, i)
	};
}
async function Ft(e, t, n) {
	let r = t;
	for (let t = 1; t < 64 && r + 8 <= n; t++) {
		let t = new DataView(await e.read(r, r + 8)), i = t.getUint32(0, !0);
		if (r + 8 + i > n) throw v(String(r), "a chunk longer than the file");
		if (t.getUint32(4, !0) === Nt) return r + 8;
		r += 8 + i;
	}
	throw v(String(t), "no binary chunk");
}
function It(e) {
	try {
		return new TextDecoder("utf-8", { fatal: !0 }).decode(e);
	} catch {
		throw v("20", "its JSON is not UTF-8");
	}
}
function Lt(e) {
	if (Rt(e) > 64) throw v("20", "its JSON is nested too deep");
	try {
		return JSON.parse(e);
	} catch {
		throw v("20", "its JSON cannot be read");
	}
}
function Rt(e) {
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
function zt(e) {
	return new _("not-glb", e ? "The file is empty; take a .glb file that eigenfield wrote." : "The file is no GLB; take a .glb file that eigenfield wrote.", "0");
}
// eigenfield-three/src/json.ts
var V = class e {
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
	number(e = -O, t = O) {
		if (typeof this.raw != "number") throw this.wrong("no number");
		if (!(this.raw >= e && this.raw <= t)) throw this.wrong(`${this.raw} is not in ${e}..${t}`);
		return this.raw;
	}
	integer(e, t) {
		let n = this.number(e, t);
		if (!Number.isInteger(n)) throw this.wrong(`${n} is no whole number`);
		return n;
	}
	numbers(e, t = -O, n = O) {
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
		return v(this.where || "/", this.exists ? e : "missing");
	}
}, Bt = {
	5121: 1,
	5123: 2,
	5125: 4,
	5126: 4
}, Vt = {
	SCALAR: 1,
	VEC2: 2,
	VEC3: 3
}, H = 5126, U = 5125;
function Ht(e) {
	let t = new V(e, "");
	try {
		return t.key("extensions").key(x).exists;
	} catch {
		return !1;
	}
}
function Ut(e) {
	let t = new V(e, ""), n = t.key("extensions").key(x), r = Wt(n), i = Gt(t), a = qt(t, i), o = (e) => e.integer(0, i.length - 1);
	Kt(t);
	let s = Yt(t, o), c = Xt(n), l = Zt(c), u = n.key("cameras"), d = tn(u), f = nn(u, d.length), p = f.filter((e) => !e).length, m = en(c, l, p, a, o), { mean: h, meanSize: g } = $t(c, l, s, o), _ = d.length, v = u.key("colour");
	if (v.exists && l !== 3) throw v.wrong("needs a plane of three channels");
	let y = n.key("viewPlane"), b = y.key("triangles"), S = t.key("meshes").at(0).key("primitives").at(0), C = S.key("mode");
	if (C.exists && C.integer(0, 6) !== 4) throw C.wrong("no triangles");
	let w = S.key("attributes"), T = n.key("generator"), E = m.size[0] * m.size[1] * l * m.textures.length, ee = g ? g[0] * g[1] : 0;
	if (E + 4 * l * ee > te) throw c.wrong("too large when it is decoded");
	return {
		version: r,
		generator: T.exists ? T.text(D) : "",
		channels: l,
		mean: h,
		meanSize: g,
		...m,
		names: d,
		heldOut: f,
		reference: n.key("reference").integer(0, _ - 1),
		intrinsics: a(u.key("intrinsics"), "SCALAR", [H], 5 * _),
		poses: a(u.key("poses"), "SCALAR", [H], 12 * _),
		sizes: a(u.key("sizes"), "SCALAR", [U], 2 * _),
		colour: v.exists ? a(v, "SCALAR", [H], 6 * _) : null,
		...rn(y),
		triangles: b.exists ? Jt(a(b, "SCALAR", [U], null)) : null,
		settings: an(n.key("settings")),
		scores: an(n.key("scores")),
		views: i,
		position: W(a(w.key("POSITION"), "VEC3", [H], null), ie),
		uv: W(a(w.key("TEXCOORD_0"), "VEC2", [H], null), ie),
		indices: Jt(a(S.key("indices"), "SCALAR", [
			5121,
			5123,
			U
		], null)),
		preview: s
	};
}
function Wt(e) {
	let t = e.key("version").text(D);
	if (!/^1\.\d+$/.test(t)) throw new _("version", `The scene is of format version ${t.slice(0, 20)} and this viewer reads 1.x; take a newer viewer.`, `${e.where}/version`);
	let n = e.key("needs");
	for (let e of n.exists ? n.items(w) : []) {
		let t = e.text(D);
		if (!S.has(t)) throw new _("needs", `The scene needs "${t.slice(0, 60)}", which this viewer cannot draw; take a newer viewer.`, e.where);
	}
	return t;
}
function Gt(e) {
	let t = e.key("buffers").at(0);
	if (t.key("uri").exists) throw t.wrong("not the binary chunk");
	let n = t.key("byteLength").integer(0, 2 ** 32 - 1);
	return e.key("bufferViews").items(w).map((e) => {
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
function Kt(e) {
	let t = e.key("nodes").items(w), n = Array(t.length).fill(!1);
	for (let e of t) {
		let r = e.key("children");
		for (let e of r.exists ? r.items(t.length) : []) {
			let r = e.integer(0, t.length - 1);
			if (n[r]) throw e.wrong("a node with two parents");
			n[r] = !0;
		}
	}
	for (let r of e.key("scenes").items(w)) {
		let e = r.key("nodes");
		for (let r of e.exists ? e.items(t.length) : []) if (n[r.integer(0, t.length - 1)]) throw r.wrong("a node with two parents");
	}
}
function qt(e, t) {
	let n = e.key("accessors").items(w);
	return (e, r, i, a) => {
		let o = n[e.integer(0, n.length - 1)];
		if (!o) throw e.wrong("no such accessor");
		let s = o.key("componentType").integer(5120, 5126);
		if (!i.includes(s)) throw o.wrong(`component type ${s}`);
		if (o.key("type").text(1024) !== r) throw o.wrong(`not ${r}`);
		if (o.key("sparse").exists) throw o.wrong("sparse");
		let c = o.key("normalized");
		if (c.exists && c.raw !== !1) throw o.wrong("normalised");
		let l = Vt[r] ?? 1, u = o.key("count").integer(1, oe);
		if (a !== null && u !== a) throw o.wrong(`${a} numbers are needed, not ${u}`);
		let d = o.key("bufferView").integer(0, t.length - 1), f = t[d];
		if (!f) throw o.wrong("no such buffer view");
		let p = o.key("byteOffset"), m = p.exists ? p.integer(0, f.length) : 0, h = Bt[s] * l;
		if (f.stride && (f.stride < h || r === "SCALAR")) throw o.wrong("a stride that cannot be");
		if (m + (u - 1) * (f.stride || h) + h > f.length) throw o.wrong("outside its buffer view");
		if ((m + f.offset) % Bt[s]) throw o.wrong("not aligned");
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
function W(e, t) {
	if (e.count > t) throw v(e.where, `more than ${t}`);
	return e;
}
function Jt(e) {
	if (e.count % 3) throw v(e.where, "torn triangles");
	return W(e, 3 * ae);
}
function Yt(e, t) {
	let n = e.key("images");
	if (!n.exists) return null;
	let r = n.at(0).key("bufferView");
	return r.exists ? t(r) : null;
}
function Xt(e) {
	let t = e.key("planes").items(w), [n] = t;
	if (!n) throw e.key("planes").wrong("no plane");
	if (t.length > 1) throw G(`${t.length} planes`, n.where);
	return n;
}
function Zt(e) {
	let t = e.key("channels").integer(1, 64);
	if (t !== 1 && t !== 3) throw G(`${t} channels`, e.where);
	return t;
}
function G(e, t) {
	return new _("unsupported", `The scene has ${e}, which this viewer does not draw; draw it with "eigenfield render".`, t);
}
function Qt(e) {
	let [t = 0, n = 0] = e.items(2).map((e) => e.integer(1, T));
	if (!t || !n) throw e.wrong("two numbers are needed");
	if (t * n > E) throw e.wrong(`more than ${E} texels`);
	return [t, n];
}
function K(e, t, n) {
	let r = e.key("mimeType").text(D);
	if (!/^image\/(png|jpeg|webp|avif)$/.test(r)) throw e.key("mimeType").wrong("an unknown type");
	let i = (n) => {
		let r = e.key(n).numbers(t);
		return t === 3 ? r : [
			r[0] ?? 0,
			r[0] ?? 0,
			r[0] ?? 0
		];
	};
	return {
		view: n(e.key("bufferView")),
		mimeType: r,
		scale: i("scale"),
		zero: i("zero"),
		where: e.where
	};
}
function $t(e, t, n, r) {
	let i = e.key("mean"), a = {
		scale: [
			1 / 255,
			1 / 255,
			1 / 255
		],
		zero: [
			0,
			0,
			0
		]
	};
	if (!i.exists) {
		if (n === null) throw i.wrong("no mean");
		return {
			mean: {
				view: n,
				mimeType: "image/png",
				...a,
				where: "/images/0"
			},
			meanSize: null
		};
	}
	let o = Qt(i.key("size"));
	if (i.key("scale").exists || i.key("zero").exists) return {
		mean: K(i, t, r),
		meanSize: o
	};
	let s = Array(t).fill(0);
	return {
		mean: {
			...K(new V({
				...i.object(),
				scale: s,
				zero: s
			}, i.where), t, r),
			...a
		},
		meanSize: o
	};
}
function en(e, t, n, r, i) {
	let a = [], o = [], s = null;
	for (let c of e.key("bases").items(64)) {
		let e = Qt(c.key("size")), l = c.key("textures").items(ee);
		if (l.length) {
			if (s && (e[0] !== s[0] || e[1] !== s[1])) throw G("eigen textures of several sizes", c.where);
			if (s = e, a.push(...l.map((e) => K(e, t, i))), a.length > 4096) throw c.wrong(`more than ${ee} textures`);
			o.push(r(c.key("weights"), "SCALAR", [H], n * l.length));
		}
	}
	return {
		size: s ?? [1, 1],
		textures: a,
		weights: o
	};
}
function tn(e) {
	let t = e.key("names").items(ne).map((e) => e.text(D));
	if (!t.length) throw e.key("names").wrong("no cameras");
	if (new Set(t).size !== t.length) throw e.key("names").wrong("a name stands twice");
	let n = t.findIndex((e) => /[\u0000-\u001f\u007f-\u009f]/.test(e));
	if (n >= 0) throw e.key("names").at(n).wrong("control characters");
	return t;
}
function nn(e, t) {
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
function rn(e) {
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
function an(e) {
	return e.exists ? e.object() : {};
}
// eigenfield-three/src/grid.ts
function on(e) {
	let t = e.length / 2;
	for (let n = 1; n * n <= t; n++) {
		if (t % n) continue;
		let r = t / n, i = sn(e, n, r) ?? (n === r ? null : sn(e, r, n));
		if (i) return i;
	}
	return null;
}
function sn(e, t, n) {
	let [r, i] = [ln(e, 0), ln(e, 1)];
	if (t === 1 && un(i) > 0 || n === 1 && un(r) > 0) return null;
	let a = Array.from(r, (e, t) => t).sort((e, t) => q(i, e) - q(i, t));
	for (let e = 0; e < t; e++) {
		let t = a.slice(e * n, (e + 1) * n).sort((e, t) => q(r, e) - q(r, t));
		a.splice(e * n, n, ...t);
	}
	let o = (e, t) => a[e * n + t] ?? 0;
	return cn(n, t, (e, t) => q(r, o(t, e))) && cn(t, n, (e, t) => q(i, o(e, t))) ? {
		rows: t,
		columns: n,
		index: Int32Array.from(a)
	} : null;
}
function cn(e, t, n) {
	let r = Infinity, i = 0, a = NaN;
	for (let o = 0; o < e; o++) {
		let e = 0;
		for (let r = 0; r < t; r++) e += n(o, r) / t;
		for (let r = 0; r < t; r++) i = Math.max(i, Math.abs(n(o, r) - e));
		o && (r = Math.min(r, e - a)), a = e;
	}
	return r > 0 && (r === Infinity || i <= r / 4);
}
function ln(e, t) {
	return Float64Array.from({ length: e.length / 2 }, (n, r) => e[2 * r + t] ?? 0);
}
function un(e) {
	return e.reduce((e, t) => Math.max(e, t), -Infinity) - e.reduce((e, t) => Math.min(e, t), Infinity);
}
var q = (e, t) => e[t] ?? 0, dn = 1e-6, J = 32, fn = class {
	places;
	triangles;
	isLine;
	grid;
	rules = /* @__PURE__ */ new Map();
	constructor(e, t, n) {
		this.places = e, this.triangles = t, this.isLine = n, this.grid = on(e);
	}
	at(e, t, n) {
		let r = n === "bilinear" && !this.grid ? "delaunay" : n, i = this.rules.get(r);
		return i || this.rules.set(r, i = this.makeRule(r)), i(pn(e), this.isLine ? 0 : pn(t));
	}
	makeRule(e) {
		return e === "nearest3" ? (e, t) => xn(e, t, this.places) : e === "bilinear" && this.grid ? Cn(this.places, this.grid) : gn(this.places, this.triangles);
	}
};
function pn(e) {
	return Math.min(1, Math.max(-1, e));
}
function mn(e) {
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
function hn(e, t, n, r, i, a) {
	let [o, s] = [Y(n, r), X(n, r)], [c, l] = [Y(n, i) - o, X(n, i) - s], [u, d] = [Y(n, a) - o, X(n, a) - s], f = c * d - l * u, p = ((e - o) * d - (t - s) * u) / f, m = (c * (t - s) - l * (e - o)) / f;
	return [
		1 - p - m,
		p,
		m
	];
}
function gn(e, t) {
	if (!t.length) {
		let t = bn(e, yn(e));
		return (n, r) => $(n, r, e, t);
	}
	let n = _n(e, t, 3), r = vn(t);
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
			], d = hn(i, a, e, n, l, u), f = Math.min(...d);
			f > s && ([o, s, c] = [
				r,
				f,
				d
			]);
		}
		return s < 0 ? $(i, a, e, r) : mn(c.map((e, n) => [Z(t, o, n), e]));
	};
}
var Z = (e, t, n) => e[3 * t + n] ?? 0;
function Q(e) {
	return Math.min(31, Math.max(0, Math.floor((e + 1) / 2 * J)));
}
function _n(e, t, n) {
	let r = Array.from({ length: 1024 }, () => []);
	for (let i = 0; i < t.length / n; i++) {
		let a = Array.from({ length: n }, (e, r) => t[n * i + r] ?? 0), o = a.map((t) => Y(e, t)), s = a.map((t) => X(e, t));
		for (let e = Q(Math.min(...s)); e <= Q(Math.max(...s)); e++) for (let t = Q(Math.min(...o)); t <= Q(Math.max(...o)); t++) r[e * J + t]?.push(i);
	}
	return r;
}
function vn(e) {
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
	return mn([[o, 1 - c], [s, c]]);
}
function yn(e) {
	return Array.from({ length: e.length / 2 }, (e, t) => t);
}
function bn(e, t) {
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
function xn(e, t, n) {
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
	if (a < 0 || Sn(n, r, i, a) <= dn) return $(e, t, n, bn(n, [
		r,
		i,
		a
	].filter((e) => e >= 0)));
	let [l, u, d] = hn(e, t, n, r, i, a);
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
function Sn(e, t, n, r) {
	let [i, a] = [Y(e, n) - Y(e, t), X(e, n) - X(e, t)], [o, s] = [Y(e, r) - Y(e, t), X(e, r) - X(e, t)], c = Math.max(i * i + a * a, o * o + s * s, (i - o) ** 2 + (a - s) ** 2);
	return c > 0 ? Math.abs(i * s - a * o) / c : 0;
}
function Cn(e, t) {
	let { rows: n, columns: r, index: i } = t;
	if (Math.min(n, r) === 1) {
		let t = bn(e, yn(e));
		return (n, r) => $(n, r, e, t);
	}
	let a = (e, t) => i[e * r + t] ?? 0, o = [];
	for (let e = 0; e + 1 < n; e++) for (let t = 0; t + 1 < r; t++) o.push([
		a(e, t),
		a(e, t + 1),
		a(e + 1, t + 1),
		a(e + 1, t)
	]);
	let s = _n(e, o.flat(), 4), c = [];
	for (let e = 0; e < r; e++) c.push(a(0, e));
	for (let e = 1; e < n; e++) c.push(a(e, r - 1));
	for (let e = r - 2; e >= 0; e--) c.push(a(n - 1, e));
	for (let e = n - 2; e >= 0; e--) c.push(a(e, 0));
	let l = Int32Array.from(c.slice(1).flatMap((e, t) => [c[t] ?? 0, e]));
	return (t, n) => {
		let r = null, i = -Infinity;
		for (let a of s[Q(n) * J + Q(t)] ?? []) {
			let s = o[a], c = s ? wn(t, n, e, s) : -Infinity;
			s && c > i && ([r, i] = [s, c]);
		}
		if (!r || i < 0) return $(t, n, e, l);
		let [a, c] = Tn(t, n, e, r);
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
function wn(e, t, n, r) {
	let i = Infinity;
	for (let a = 0; a < 4; a++) {
		let [o, s] = [r[a], r[(a + 1) % 4]], [c, l] = [Y(n, o), X(n, o)];
		i = Math.min(i, (Y(n, s) - c) * (t - l) - (X(n, s) - l) * (e - c));
	}
	return i;
}
function Tn(e, t, n, r) {
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
	], [v, y] = [i - o + c - u, a - s + l - d], b = f * h - p * m, x = f * y - p * v - (g * h - _ * m), S = -(g * y - _ * v), C = Math.sqrt(Math.max(x * x - 4 * b * S, 0)), w = En(-2 * b / (x + (x < 0 ? -C : C))), [T, E] = [m + w * v, h + w * y];
	return [En(((f - w * g) * T + (p - w * _) * E) / (T * T + E * E)), w];
}
function En(e) {
	return Math.min(1, Math.max(0, e));
}
// eigenfield-three/src/plugin.ts
var Dn = class {
	parser;
	options;
	name = x;
	scene = null;
	ours;
	constructor(e, t = {}) {
		this.parser = e, this.options = t, this.ours = Ht(e.json);
	}
	async beforeRoot() {
		this.ours && (this.scene = Ut(this.parser.json));
	}
	loadMaterial(e) {
		let t = this.scene && this.parser.json.meshes[0].primitives[0];
		if (!t || t.material !== e) return null;
		let { doubleSided: n } = this.parser.json.materials?.[e] ?? {}, r = new f();
		return r.side = n === !0 ? 2 : 0, Promise.resolve(r);
	}
	loadBufferView(e) {
		let t = this.scene?.views[e];
		return t && this.options.stream ? this.options.stream.read(t.offset, t.length) : null;
	}
	async afterRoot(e) {
		let { scene: t } = this;
		if (!t) return;
		let n = On(e, this.parser), [r] = n;
		if (!r) throw v("/meshes/0", "no node shows it");
		An(r.geometry, t);
		let i = async (e) => {
			let n = await this.parser.getDependency("bufferView", e);
			if (n.byteLength < (t.views[e]?.length ?? 0)) throw se(`/bufferViews/${e}`);
			return n;
		}, a = await i(t.mean.view), [o, s, c, l] = await Promise.all([
			I(a, t.mean, t.meanSize),
			ce(t, i),
			de(t, i),
			fe(t, i)
		]), u = s.filter((e, n) => !t.heldOut[n]), d = new fn(Float64Array.from(u.flatMap((e) => A(t, e.centre))), l, t.extent[1] === 0), f = pe(t, s, d.grid, this.fileBytes());
		e.userData.eigenfield = new z({
			scene: t,
			info: f,
			meshes: n,
			mean: o,
			omega: c,
			weights: d,
			bytes: i
		}, this.options);
	}
	fileBytes() {
		if (this.options.stream) return this.options.stream.total;
		let { extensions: e, json: t } = this.parser;
		return e.KHR_binary_glTF?.header?.length ?? t.buffers[0]?.byteLength ?? 0;
	}
};
function On(e, t) {
	let n = [];
	return e.scene.traverse((e) => {
		let r = t.associations.get(e);
		kn(e) && r?.meshes === 0 && (r.primitives ?? 0) === 0 && n.push(e);
	}), n;
}
function kn(e) {
	return e.isMesh === !0;
}
function An(e, t) {
	let n = e.getAttribute("position"), r = e.getAttribute("uv"), { index: i } = e;
	if (!i) throw new _("damaged", "The proxy mesh has no triangles; make or download the file again.");
	if (r.count < n.count) throw v(t.uv.where, "too few texture coordinates");
	for (let e = 0; e < n.count; e++) {
		if (!(Math.max(Math.abs(n.getX(e)), Math.abs(n.getY(e)), Math.abs(n.getZ(e))) <= 1e30)) throw v(t.position.where, `vertex ${e} is not finite`);
		if (!(Math.max(Math.abs(r.getX(e)), Math.abs(r.getY(e))) <= 1e30)) throw v(t.uv.where, `texture coordinates of vertex ${e} are not finite`);
	}
	for (let e of i.array) if (e >= n.count) throw v(t.indices.where, `no vertex ${e}`);
}
// eigenfield-three/src/load.ts
async function jn(e, t = {}) {
	let { signal: n } = t;
	n?.throwIfAborted();
	let r = new At(), i = new AbortController(), a = () => {
		r.fail(new DOMException("The load was stopped.", "AbortError")), i.abort();
	};
	n?.addEventListener("abort", a);
	let o = Pn(e, r, i.signal, t.onBytes).catch((e) => r.fail(e)).finally(() => n?.removeEventListener("abort", a));
	try {
		let e = await Pt(r);
		if (!Ht(e.json)) return {
			gltf: await Nn(r, e, o),
			field: null
		};
		let i = await Mn(r, e, t);
		n?.throwIfAborted();
		let a = i.userData.eigenfield;
		return {
			gltf: i,
			field: a instanceof z ? a : null
		};
	} catch (e) {
		throw i.abort(), n?.throwIfAborted(), b(e);
	}
}
async function Mn(e, t, n) {
	let r = new g(), i = t.binary();
	i.catch(() => void 0);
	let a = {
		total: t.length,
		read: async (t, n) => {
			let r = await i + t;
			return e.read(r, r + n);
		}
	};
	return r.register((e) => new Dn(e, {
		...n,
		stream: a
	})), r.parseAsync(t.text, "");
}
async function Nn(e, t, n) {
	await n;
	let r = await e.read(0, t.length);
	try {
		return await new g().parseAsync(r, "");
	} catch (e) {
		let t = b(e).message;
		throw new _("unsupported", `${t} It has no eigen textures either.`, "", { cause: e });
	}
}
async function Pn(e, t, n, r) {
	if (e instanceof ArrayBuffer) return t.push(new Uint8Array(e)), r?.(e.byteLength, e.byteLength), t.end();
	let { body: i, total: a } = e instanceof Blob ? Fn(e) : await In(e, n), o = i.getReader();
	for (n.addEventListener("abort", () => void o.cancel().catch(() => void 0));;) {
		let { done: e, value: i } = await o.read().catch((e) => {
			throw n.aborted ? e : Ln(t.received, e);
		});
		if (e) break;
		t.push(i), r?.(t.received, a);
	}
	n.throwIfAborted(), t.end();
}
function Fn(e) {
	return {
		body: e.stream(),
		total: e.size
	};
}
async function In(e, t) {
	let n = await fetch(e, { signal: t }).catch((n) => {
		throw t.aborted ? n : new _("network", "The scene cannot be fetched; check its address and the connection.", e, { cause: n });
	});
	if (!n.ok || !n.body) throw await n.body?.cancel(), new _("network", `The server answered ${n.status} for the scene; check its address.`, e);
	let r = n.headers.get("Content-Encoding") ? null : n.headers.get("Content-Length");
	return {
		body: n.body,
		total: r && /^\d+$/.test(r) ? Number(r) : void 0
	};
}
function Ln(e, t) {
	return new _("network", `The connection broke after ${e} bytes of the scene; load it again.`, String(e), { cause: t });
}
export { z as EigenField, Dn as EigenfieldPlugin, _ as SceneError, Ae as defaultMemory, jn as loadEigenfield, ge as novelCamera, be as placeCamera };
