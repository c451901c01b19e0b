import { BufferAttribute as e, BufferGeometry as t, Camera as n, ClampToEdgeWrapping as r, Color as i, CustomBlending as a, DataArrayTexture as o, DataUtils as s, DoubleSide as c, EventDispatcher as l, ExternalTexture as u, FrontSide as d, GLSL3 as f, HalfFloatType as p, InstancedBufferGeometry as m, LinearFilter as h, LinearMipmapLinearFilter as g, Matrix4 as _, Mesh as v, MeshBasicMaterial as y, NearestFilter as b, NoBlending as x, OneFactor as S, RGBAFormat as C, RawShaderMaterial as w, Scene as T, Sphere as E, Vector2 as D, Vector3 as O, Vector4 as ee, WebGLRenderTarget as k } from "three";
import { GLTFLoader as te } from "three/addons/loaders/GLTFLoader.js";
// eigenfield-three/src/errors.ts
var A = class extends Error {
	code;
	where;
	name = "SceneError";
	constructor(e, t, n = "", r) {
		super(t, r), this.code = e, this.where = n;
	}
};
function j(e, t) {
	return new A("damaged", `The file is damaged (${e}: ${t}); make or download it again.`, e);
}
function ne(e, t) {
	return new A("truncated", `The file is cut off after ${e} of ${t} bytes; download or copy it again.`, String(e));
}
function re(e) {
	return new A("truncated", `The file is cut off (${e}); download or copy it again.`, e);
}
function ie(e, t = "") {
	return e instanceof A ? e : new A("damaged", `The file cannot be read (${(e instanceof Error ? e.message : String(e)).replace(/^THREE\.GLTFLoader: /, "")}); make or download it again.`, t, { cause: e });
}
// eigenfield-three/src/av1-picture.ts
var ae = 1, oe = 7;
function se(e, t) {
	let { level: n, tier: r, width: i, height: a } = ce(new Uint8Array(e), t), o = r << 7 | 76, s = M("ipco", [
		...M("ispe", [
			...N(0),
			...N(i),
			...N(a)
		]),
		...M("pixi", [
			...N(0),
			3,
			10,
			10,
			10
		]),
		...M("av1C", [
			129,
			n,
			o,
			0
		]),
		...M("colr", [
			...P("nclx"),
			0,
			2,
			0,
			2,
			0,
			2,
			128
		])
	]), c = M("ftyp", [
		...P("avif"),
		...N(0),
		...P("avifmif1miafMA1B")
	]), l = (t) => M("meta", [
		...N(0),
		...M("hdlr", [
			...N(0),
			...N(0),
			...P("pict"),
			...Array(13).fill(0)
		]),
		...M("pitm", [
			...N(0),
			0,
			1
		]),
		...M("iloc", [
			...N(0),
			68,
			0,
			0,
			1,
			0,
			1,
			0,
			0,
			0,
			1,
			...N(t),
			...N(e.byteLength)
		]),
		...M("iinf", [
			...N(0),
			0,
			1,
			...M("infe", [
				2,
				0,
				0,
				0,
				0,
				1,
				0,
				0,
				...P("av01"),
				0
			])
		]),
		...M("iprp", [...s, ...M("ipma", [
			...N(0),
			...N(1),
			0,
			1,
			4,
			1,
			2,
			131,
			4
		])])
	]), u = c.length + l(0).length + 8, d = [
		...c,
		...l(u),
		...N(8 + e.byteLength),
		...P("mdat")
	], f = new Uint8Array(u + e.byteLength);
	return f.set(d), f.set(new Uint8Array(e), u), f.buffer;
}
function ce(e, t) {
	let n = e[0] ?? 0, r = 8 * (1 + (n >> 2 & 1) + (n >> 1 & 1)), i = (t) => {
		let n = 0;
		for (let i = r + t; r < i; r++) n = 2 * n + ((e[r >> 3] ?? 0) >> 7 - (r & 7) & 1);
		return n;
	};
	i(4);
	let a = i(1) === 1, o = !a && i(7) !== 0;
	a || i(12);
	let s = i(5), c = !a && s > oe ? i(1) : 0, [l, u] = [i(4) + 1, i(4) + 1], [d, f] = [i(l) + 1, i(u) + 1];
	if (n >> 3 !== ae || o || r > 8 * e.length) throw j(t, "no AV1 sequence header");
	return {
		level: s,
		tier: c,
		width: d,
		height: f
	};
}
function M(e, t) {
	return [
		...N(8 + t.length),
		...P(e),
		...t
	];
}
function N(e) {
	return [
		24,
		16,
		8,
		0
	].map((t) => e >>> t & 255);
}
function P(e) {
	return Array.from(e, (e) => e.charCodeAt(0));
}
// eigenfield-three/src/inflate.ts
async function le(e, t, n, r) {
	let i = [], a = 0, o = new Blob([e]).stream().pipeThrough(new DecompressionStream(t)).getReader();
	try {
		for (let e = await o.read(); !e.done && a <= n; e = await o.read()) i.push(e.value), a += e.value.length;
	} catch {
		throw j(r, "it does not inflate");
	}
	if (a > n) throw await o.cancel(), j(r, `more than ${n} bytes`);
	let s = new Uint8Array(a), c = 0;
	for (let e of i) s.set(e, c), c += e.length;
	return s;
}
// eigenfield-three/src/limits.ts
var ue = "EIGENFIELD_eigen_textures", de = 64 * 2 ** 20, F = 16384, fe = 16384, pe = 1024, me = 2 ** 27, he = 4096, ge = 8 * 2 ** 30, I = 1e5, _e = 65535, ve = 2 ** 29, L = 1024, ye = 2 ** 25, be = 2 ** 26, xe = 2 ** 27, Se = 2 ** 28, Ce = 1e30, R = 65536, we = 126, z = 64, Te = 0, Ee = 1, De = 2, Oe = 24, ke = 44, Ae = 21, je = 26214, Me = 4, Ne = Float64Array.from({ length: 4095 }, (e, t) => Math.round(R / (1 + Math.exp((2047 - t) / 256)))), Pe = Float64Array.from({ length: 4096 }, (e, t) => Math.round(256 * Math.log((t + .5) / (4095.5 - t)))), Fe = Float64Array.from({ length: 127 }, (e, t) => Math.round(R / (t + 1.5)));
function B(e) {
	return e < 4294967296 ? 32 - Math.clz32(e) : 32 + B(Math.floor(e / 4294967296));
}
var Ie = class {
	bytes;
	low = 0;
	high = 4294967295;
	code = 0;
	at = 0;
	probability;
	seen;
	weights;
	constructor(e, t, n) {
		this.bytes = e, this.probability = new Uint16Array(t * z).fill(R / 2), this.seen = new Uint8Array(t * z), this.weights = new Float64Array(n * z * 3).fill(je);
		for (let e = 0; e < Me; e++) this.code = this.code * 256 + this.next();
	}
	checkEnd(e) {
		if (this.at > this.bytes.length + Me) throw re(e);
	}
	flag(e, t, n, r) {
		return this.node(e, t, n, r, 0) === 1;
	}
	raw(e) {
		let t = 0;
		for (let n = 0; n < e; n++) t = t * 2 + this.split(R / 2);
		return t;
	}
	integer(e, t, n, r) {
		let i = this.magnitude(e, t, n, r);
		return i === 0 ? 0 : this.node(e, t, n, r, Ee) ? -i : i;
	}
	magnitude(e, t, n, r) {
		if (!this.node(e, t, n, r, Te)) return 0;
		let i = 0;
		for (; i < Ae && this.node(e, t, n, r, De + i);) i += 1;
		if (i < 2) return i + 1;
		let a = 1;
		for (let o = i - 2; o >= 0; o--) {
			let s;
			s = o === i - 2 ? this.node(e, t, n, r, Oe + i) : o === i - 3 ? this.node(e, t, n, r, ke + 2 * Math.min(i, 9) + (a & 1)) : this.split(R / 2), a = a * 2 + s;
		}
		return a + 1;
	}
	node(e, t, n, r, i) {
		return this.bit(e * z + i, t * z + i, n * z + i, (r * z + i) * 3);
	}
	bit(e, t, n, r) {
		let { probability: i, weights: a } = this, o = Pe[i[e] >> 4], s = Pe[i[t] >> 4], c = Pe[i[n] >> 4], l = Math.floor((a[r] * o + a[r + 1] * s + a[r + 2] * c) / R), u = Ne[Math.min(Math.max(l, -2047), 2047) + 2047], d = this.split(u), f = d ? R - u : -u;
		return a[r] += o * f >> 14, a[r + 1] += s * f >> 14, a[r + 2] += c * f >> 14, this.learn(e, d), this.learn(t, d), this.learn(n, d), d;
	}
	learn(e, t) {
		let [n, r] = [this.probability[e], this.seen[e]];
		this.probability[e] = n + Math.floor(((t ? 65535 : 0) - n) * Fe[r] / R), r < we && (this.seen[e] = r + 1);
	}
	split(e) {
		let t = this.low + Math.floor((this.high - this.low) * e / R), n = +(this.code <= t);
		for (n ? this.high = t : this.low = t + 1; !((this.low ^ this.high) >>> 24);) this.low = this.low << 8 >>> 0, this.high = (this.high << 8 | 255) >>> 0, this.code = (this.code << 8 | this.next()) >>> 0;
		return n;
	}
	next() {
		return this.bytes[this.at++] ?? 0;
	}
};
function V(e, t, n, r = 1) {
	if (e.length < t) throw re(n);
	if (e[0] !== r) throw j(n, `coded numbers of version ${e[0]}`);
	return new DataView(e.buffer, e.byteOffset, e.byteLength);
}
function Le(e, t, n, r) {
	if (t > n || t > 16 * e.length + 1024) throw j(r, `${t} numbers announced`);
}
// eigenfield-three/src/table-decoder.ts
var Re = 12, ze = 3, Be = 312, Ve = ze * Be, He = 938, Ue = 24, We = 16, Ge = 1722, Ke = 1726, qe = 4, Je = 5;
function Ye(e) {
	return new Ie(e, Ke, 21);
}
function Xe(e) {
	return e.flag(Ve, Ve, Ve, ze) ? 2 : +!!e.flag(937, 937, 937, ze);
}
function Ze(e) {
	return Math.min(B(e), 11);
}
function Qe(e, t, n, r) {
	let i = new Float64Array(n.length), a = n.length / t, o = (e, n, r) => n < 0 || r < 0 || r >= t ? 0 : e[n * t + r], s = 0;
	for (let c = 0; c < a; c++) for (let a = 0; a < t; a++) {
		let [l, u] = [o(i, c, a - 1), o(i, c - 1, a)], [d, f] = [o(i, c - 1, a - 1), o(i, c - 1, a + 1)], [p, m, h] = [
			0,
			0,
			s
		];
		r === 1 ? (p = c === 0 ? l : a === 0 ? u : Math.max(Math.min(l, u), Math.min(Math.max(l, u), l + u - d)), m = Math.abs(l - d) + Math.abs(u - d) + Math.abs(f - u)) : (m = 2 * Math.abs(l) + 2 * Math.abs(u) + Math.abs(d) + Math.abs(f), h = Math.abs(o(i, c, a - 2)) + Math.abs(o(i, c - 2, a)));
		let g = 2 * Math.abs(o(n, c, a)) + Math.abs(o(n, c, a - 1)) + Math.abs(o(n, c, a + 1)), _ = r === 2 ? Math.min(c, 2) * 4 + Math.min(a, 3) : Math.min(c, 1), v = r * Be, y = e.integer(v + Ze(m) * Re + Ze(g), v + 144 + Ze(m + h), v + 144 + 24 + _ * Re + Ze(g + Math.abs(l)), r);
		i[c * t + a] = p + y, s = Math.abs(y);
	}
	return i;
}
function $e(e, t, n, r) {
	let i = new Float64Array(t * n), a = new Float64Array(n);
	for (let o = 0; o < t; o++) {
		let t = 0;
		for (let s = 0; s < n; s++) {
			let c = r && o > 0 ? i[(o - 1) * n + s] : 0, l = Math.min(s, 15), u = Math.min(B(a[s]), 23), d = Math.min(B(t), 23), f = e.integer(He + l * Ue + u, He + (We + l) * Ue + d, 1706 + l, Je + l);
			i[o * n + s] = c + f, t = Math.abs(f), a[s] = Math.floor((a[s] + t + 1) / 2);
		}
	}
	return i;
}
function et(e, t, n, r) {
	let i = new Float64Array(t).fill(-1), a = new Uint8Array(n), [o, s, c] = [
		0,
		1,
		0
	];
	for (let l = 0; l < t; l++) {
		if (s = +!!e.flag(Ge + s, Ge + s, 1724, qe), !s) continue;
		let t = o + e.integer(1725, 1725, 1725, qe);
		if (!(t >= 0 && t < n) || a[t]) throw j(r, "a grid with a camera out of place");
		a[t] = 1, i[l] = t, o = t + 1, c += 1;
	}
	if (c !== n) throw j(r, "a grid without all cameras");
	return i;
}
// eigenfield-three/src/camera-decoder.ts
var tt = 130, H = 11, nt = 1, rt = 2, it = 2, at = 44 * I + 1024;
async function ot(e, t) {
	if (e[0] !== it) throw j(t, `version ${e[0]}`);
	let n = await le(Uint8Array.from(e.subarray(1)), "deflate-raw", at, t);
	return st(Uint8Array.from([1, ...n]), t);
}
function st(e, t) {
	let n = V(e, tt, t), [r, i] = [n.getUint8(1), n.getUint32(6, !0)], a = (r & nt) !== 0, [o, s] = a ? [n.getUint16(2, !0), n.getUint16(4, !0)] : [0, 0], c = Float64Array.from({ length: 15 }, (e, t) => n.getFloat64(10 + 8 * t, !0));
	if (r > 3 || i === 0 || !c.every(Number.isFinite)) throw j(t, "cameras that cannot be");
	if (i > 1e5 || a && o * s < i) throw j(t, `${i} cameras`);
	Le(e, Math.max(H * i, o * s), H * I, t);
	let l = tt + (a ? 132 : 0);
	V(e, l, t);
	let u = (e, t) => a ? n.getFloat32(tt + 4 * (e * H + t), !0) : 0, d = Ye(e.subarray(l)), f = a ? et(d, o * s, i, t) : null, p = $e(d, i, H, (r & rt) !== 0);
	d.checkEnd(t);
	let m = {
		intrinsics: new Float32Array(5 * i),
		poses: new Float32Array(12 * i)
	}, h = [
		...c.subarray(7, 12),
		0,
		0,
		0,
		...c.subarray(12)
	], g = lt(c[3], c[4], c[5], c[6]), _ = new Float64Array(H), v = 0;
	for (let e = 0; e < (f ? f.length : i); e++) {
		let t = f ? f[e] : e;
		if (t < 0) continue;
		let [n, r] = f ? [Math.floor(e / s), e % s] : [0, 0];
		for (let e = 0; e < H; e++) {
			let t = c[e < 5 ? 0 : e < 8 ? 1 : 2], i = u(0, e) + u(1, e) * n + u(2, e) * r;
			_[e] = p[v * H + e] * t + h[e] + i;
		}
		ct(_, g, m, t), v += 1;
	}
	if (!m.intrinsics.every(Number.isFinite) || !m.poses.every(Number.isFinite)) throw j(t, "cameras that are not finite");
	return m;
}
function ct(e, t, n, r) {
	n.intrinsics.set(e.subarray(0, 5), 5 * r);
	let [i, a, o] = [
		e[5],
		e[6],
		e[7]
	], s = i * i + a * a + o * o, c = 1 + s, l = lt(2 * i / c, 2 * a / c, 2 * o / c, (1 - s) / c);
	for (let i = 0; i < 3; i++) {
		let a = 0;
		for (let o = 0; o < 3; o++) {
			let s = 0;
			for (let e = 0; e < 3; e++) s += l[3 * i + e] * t[3 * e + o];
			n.poses[12 * r + 4 * i + o] = s, a -= s * e[8 + o];
		}
		n.poses[12 * r + 4 * i + 3] = a;
	}
}
function lt(e, t, n, r) {
	return [
		[
			1 - 2 * (t * t + n * n),
			2 * (e * t - n * r),
			2 * (e * n + t * r)
		],
		[
			2 * (e * t + n * r),
			1 - 2 * (e * e + n * n),
			2 * (t * n - e * r)
		],
		[
			2 * (e * n - t * r),
			2 * (t * n + e * r),
			1 - 2 * (e * e + t * t)
		]
	].flat();
}
var ut = 2 ** 24, dt = class {
	points;
	start;
	end;
	opposite;
	before;
	after;
	status;
	into;
	heap;
	key;
	gates = 0;
	waiting = 0;
	constructor(e, t) {
		this.points = e;
		let n = 3 * t;
		this.start = new Int32Array(n), this.end = new Int32Array(n), this.opposite = new Int32Array(n), this.before = new Int32Array(n), this.after = new Int32Array(n), this.status = new Uint8Array(n), this.into = new Int32Array(e.length / 3).fill(-1), this.heap = new Int32Array(n), this.key = new Float64Array(n);
	}
	seed(e) {
		let t = this.gates;
		for (let t = 0; t < 3; t++) this.add(e[t], e[(t + 1) % 3], e[(t + 2) % 3]);
		for (let e = 0; e < 3; e++) this.link(t + e, t + (e + 1) % 3);
	}
	next() {
		let { heap: e, key: t } = this;
		for (; this.waiting > 0;) {
			let n = e[0], r = --this.waiting, [i, a] = [e[r], t[r]], o = 0;
			for (; 2 * o + 1 < r;) {
				let n = 2 * o + 1;
				if (n + 1 < r && t[n + 1] < t[n] && (n += 1), t[n] >= a) break;
				e[o] = e[n], t[o] = t[n], o = n;
			}
			if (e[o] = i, t[o] = a, this.status[n] === 1) return n;
		}
		return -1;
	}
	closeLeft(e) {
		let [t, n] = [this.before[e], this.after[e]], r = this.start[t];
		if (this.status[e] = this.status[t] = 0, this.status[n] === 1 && this.end[n] === r && n !== t) {
			this.status[n] = 0, this.link(this.before[t], this.after[n]);
			return;
		}
		let i = this.before[t], a = this.add(r, this.end[e], this.start[e]);
		this.link(i, a), this.link(a, n);
	}
	closeRight(e) {
		let [t, n] = [this.before[e], this.after[e]];
		this.status[e] = this.status[n] = 0;
		let r = this.after[n], i = this.add(this.start[e], this.end[n], this.end[e]);
		this.link(t, i), this.link(i, r);
	}
	openOut(e, t) {
		let [n, r, i] = [
			this.before[e],
			this.after[e],
			this.into[t]
		];
		this.status[e] = 0;
		let a = this.add(this.start[e], t, this.end[e]), o = this.add(t, this.end[e], this.start[e]);
		i >= 0 && this.status[i] !== 0 ? (this.link(a, this.after[i]), this.link(i, o)) : this.link(a, o), this.link(n, a), this.link(o, r), this.into[t] = a;
	}
	link(e, t) {
		this.after[e] = t, this.before[t] = e;
	}
	add(e, t, n) {
		let { heap: r, key: i, points: a } = this, o = this.gates++;
		this.start[o] = e, this.end[o] = t, this.opposite[o] = n, this.status[o] = 1, this.into[t] = o;
		let s = (a[3 * e] + a[3 * t]) * ut + a[3 * e + 1] + a[3 * t + 1], c = this.waiting++;
		for (; c > 0;) {
			let e = c - 1 >> 1;
			if (i[e] <= s) break;
			r[c] = r[e], i[c] = i[e], c = e;
		}
		return r[c] = o, i[c] = s, o;
	}
}, ft = 2 ** 20, pt = .8, mt = 44, ht = 385, gt = 897, _t = 1086, vt = 1095, [yt, bt, xt, St, Ct] = [
	0,
	1,
	2,
	3,
	15
];
function wt(e) {
	return Math.floor(Math.min(Math.max(e, -ft), ft) + .5);
}
function Tt(e, t, n) {
	let r = Math.max((1 << n) - 1, 1);
	return (e[3 * t] & r ? 1 : 0) + (e[3 * t + 1] & r ? 2 : 0);
}
function Et(e, t, n, r, i) {
	i.flat ? Dt(e, t, n, r, i.fine) : Ot(e, t, n, r);
}
function Dt(e, t, n, r, i) {
	let { a, b: o, o: s, pair: c } = r, [l, u, d, f] = [
		t[3 * a],
		t[3 * a + 1],
		t[3 * o],
		t[3 * o + 1]
	], [p, m] = [d - l, f - u], h = p * (t[3 * s + 1] - u) - m * (t[3 * s] - l), g = h > 0 ? pt : -.8, _ = 1 << i >> 1, v = wt((l + d) * .5 + g * m) + _ >> i, y = wt((u + f) * .5 - g * p) + _ >> i, b = 4 ** i, x = Math.min(B(Math.floor((p * p + m * m) / b)), 23), S = Math.min(B(Math.floor(Math.abs(h) / b)), 23), C = +(p < 0) + (m < 0 ? 2 : 0) + (Math.abs(m) > Math.abs(p) ? 4 : 0), w = e.integer(x * 8 + C, 192 + S, 216 + c, yt), T = Math.min(B(Math.abs(w)), 7), [E, D] = [577, 705], O = T * 2 + +(w > 0), ee = e.integer(ht + x * 8 + C, E + O * 8 + C, D + S * 8 + T, bt);
	if (t[3 * n] = v + w << i, t[3 * n + 1] = y + ee << i, i === 0) return;
	let k = Tt(t, a, i) + 4 * Tt(t, o, i);
	if (e.flag(gt + k, 913 + Tt(t, s, i), 917 + c, Ct)) for (let r = 0; r < 2; r++) t[3 * n + r] += e.raw(i) - _;
}
function Ot(e, t, n, { a: r, b: i, o: a }) {
	let o = 0;
	for (let e = 0; e < 3; e++) o += (t[3 * i + e] - t[3 * r + e]) ** 2;
	let s = Math.min(B(o), 43), c = 0;
	for (let o = 0; o < 3; o++) {
		let l = wt(t[3 * r + o] + t[3 * i + o] - t[3 * a + o]), u = e.integer(s, mt + o * 24 + c, 116 + o * mt + s, xt);
		t[3 * n + o] = l + u, c = Math.min(B(Math.abs(u)), 23);
	}
}
function kt(e, t, n, r, i) {
	for (let a = 0; a < (i ? 2 : 3); a++) {
		let i = r >= 0 ? Math.min(Math.max(t[3 * r + a], -ft), ft) : 0, o = _t + a;
		t[3 * n + a] = i + e.integer(o, o + 3, o + 6, St);
	}
}
// eigenfield-three/src/mesh-faces.ts
var At = 13, jt = 11, Mt = 12, U = 169, Nt = 8, Pt = vt, Ft = Pt + U + 104 + 26, It = Ft + U + 104 + At, Lt = It + 64 + 64 + U, Rt = Lt + U + 4 + 1, zt = Rt + 6, [Bt, Vt, Ht, Ut, Wt] = [
	4,
	5,
	6,
	7,
	8
], Gt = [
	-1,
	-.4,
	0,
	.3,
	.6,
	.9,
	1.3,
	2,
	4
];
function Kt(e, t, n, r, i) {
	let a = new Int32Array(3 * t), o = {
		points: a,
		faces: new Int32Array(3 * n),
		parents: new Int32Array(3 * t).fill(-1)
	}, s = new Int32Array(t), c = new dt(a, n), [l, u] = [0, 0], d = (e, t, n) => {
		o.faces.set([
			e,
			t,
			n
		], 3 * u), u += 1;
		for (let r of [
			e,
			t,
			n
		]) s[r] += 1;
	}, f = () => {
		if (l >= t) throw j(i, "more places than announced");
		return l++;
	}, p = () => {
		let t = e.raw(B(l - 1));
		if (t >= l) throw j(i, "a place that is not there yet");
		return t;
	}, m = () => {
		let t = [
			-1,
			-1,
			-1
		];
		for (let n = 0; n < 3; n++) if (l > 0 && e.flag(Rt + n, Rt + 3 + n, Rt + n, Wt)) t[n] = p();
		else {
			let i = t[n] = f();
			kt(e, a, i, n > 0 ? t[n - 1] : i - 1, r.flat);
		}
		let [n, o, s] = t;
		if (n === o || o === s || s === n) throw j(i, "a face of two corners");
		d(n, o, s), c.seed(t);
	}, h = (e, t, n, i) => c.status[t] === 2 ? Mt : c.status[t] !== 1 || n === i || t === e ? jt : qt(a, c.start[e], c.end[e], n, c.opposite[e], r.flat);
	for (; u < n;) {
		let t = c.next();
		if (t < 0) {
			m();
			continue;
		}
		let [n, l] = [c.start[t], c.end[t]], [u, g] = [c.before[t], c.after[t]], [_, v] = [c.start[u], c.end[g]], [y, b] = [h(t, u, _, l), h(t, g, v, n)], x = y * At + b, [S, C] = [Math.min(s[n], 7), Math.min(s[l], 7)], w = Pt + U + 104 + 2 * y + +(_ === v);
		if (y < jt && e.flag(Pt + x, Pt + U + y * Nt + S, w, Bt)) {
			d(l, n, _), c.closeLeft(t);
			continue;
		}
		if (b < jt && (v !== _ || y >= jt) && e.flag(Ft + x, Ft + U + b * Nt + C, Ft + U + 104 + b, Vt)) {
			d(l, n, v), c.closeRight(t);
			continue;
		}
		let T = +(y === Mt) + (b === Mt ? 2 : 0), E = Tt(a, n, r.fine) + 4 * Tt(a, l, r.fine), D = It + 64 + S * Nt + C;
		if (e.flag(It + T * 16 + E, D, It + 64 + 64 + x, Ht)) {
			c.status[t] = 2;
			continue;
		}
		let O;
		if (e.flag(Lt + x, Lt + U + T, Lt + U + 4, Ut)) {
			O = f();
			let i = c.opposite[t];
			o.parents.set([
				n,
				l,
				i
			], 3 * O), Et(e, a, O, {
				a: n,
				b: l,
				o: i,
				pair: x
			}, r);
		} else if (O = p(), O === n || O === l) throw j(i, "a face of two corners");
		d(l, n, O), c.openOut(t, O);
	}
	if (l !== t) throw j(i, "fewer places than announced");
	return o;
}
function qt(e, t, n, r, i, a) {
	let o = (n, r) => a && r === 2 ? 0 : e[3 * n + r] - e[3 * t + r], [s, c, l] = [
		o(n, 0),
		o(n, 1),
		o(n, 2)
	], [u, d, f] = [
		o(r, 0),
		o(r, 1),
		o(r, 2)
	], [p, m, h] = [
		o(i, 0),
		o(i, 1),
		o(i, 2)
	], [g, _, v] = [
		c * f - l * d,
		l * u - s * f,
		s * d - c * u
	], [y, b, x] = [
		c * h - l * m,
		l * p - s * h,
		s * m - c * p
	], S = Math.sqrt(g * g + _ * _ + v * v);
	if (S === 0 || g * y + _ * b + v * x > 0) return 0;
	let C = (u * (u - s) + d * (d - c) + f * (f - l)) / S, w = Gt.findIndex((e) => C < e);
	return w < 0 ? 10 : w + 1;
}
// eigenfield-three/src/mesh-corners.ts
var Jt = 32, Yt = 4, [Xt, Zt, Qt, $t] = [
	0,
	1,
	2,
	3
], en = zt, tn = en + 64 + 12 + 16, W = tn + Yt + 1, nn = W + 4, [rn, an, on] = [
	9,
	10,
	11
];
function sn(e, t) {
	let n = new Int32Array(t + 1);
	for (let t of e) n[t + 1] += 1;
	for (let e = 0; e < t; e++) n[e + 1] += n[e];
	let r = n.slice(), i = new Int32Array(e.length);
	return e.forEach((e, t) => i[r[e]++] = t), {
		first: n,
		corners: i
	};
}
function cn(e, t, n, r, i, a, o) {
	let s = t.faces.length / 3, c = Math.min(s, Math.floor(n / 3)), l = {
		faces: new Int32Array(3 * s),
		place: new Int32Array(n),
		chart: new Int32Array(n),
		kinds: new Uint8Array(c),
		maps: new Uint32Array(6 * c)
	}, u = new Int32Array(t.points.length / 3).fill(-1), d = new Int32Array(n), f = [
		-1,
		-1,
		-1
	], p = [
		0,
		0,
		0
	], m = new Int32Array(Yt), h = /* @__PURE__ */ new Int32Array(8), [g, _, v] = [
		0,
		0,
		-1
	], y = (e, n) => {
		for (let r = 0; r < 3; r++) if (t.faces[3 * e + r] === n) return r;
		return -1;
	}, b = (e, n) => {
		let [a, o] = [t.faces[3 * e + n], t.faces[3 * e + (n + 1) % 3]];
		for (let t = r[a]; t < Math.min(r[a + 1], r[a] + Jt); t++) {
			let n = Math.floor(i[t] / 3);
			if (n >= e) break;
			if (y(n, o) >= 0) return n;
		}
		return -1;
	}, x = (e, t) => l.faces[3 * e + y(e, t)], S = (n, r) => {
		let i = t.faces[3 * n + r], a = u[i];
		if (a < 0) return -1;
		h.fill($t);
		let s = 0;
		for (let e of [r, (r + 2) % 3]) {
			if (f[e] < 0) continue;
			let t = x(f[e], i);
			s === 1 && m[0] === t ? h[1] = p[e] : (m[s] = t, h[2 * s] = p[e], s += 1);
		}
		for (let e = 0; e < Jt && s < Yt && a >= 0; e++) (s < 1 || a !== m[0]) && (s < 2 || a !== m[1]) && (m[s++] = a), a = d[a];
		let c = -1;
		for (let t = 0; t < s && c < 0; t++) {
			let [n, i] = [h[2 * t], h[2 * t + 1]], a = en + 76 + Math.min(s, 3) * 4 + n;
			e.flag(en + t * 16 + n * 4 + i, en + 64 + t * 3 + r, a, rn) && (c = m[t]);
		}
		if (c < 0) {
			if (e.flag(tn + s, tn + s, tn + Yt, an)) return -1;
			if (c = e.raw(B(g - 1)), c >= g || l.place[c] !== i) throw j(o, "a corner that is elsewhere");
		}
		for (let e of [r, (r + 2) % 3]) f[e] >= 0 && (p[e] = x(f[e], i) === c ? Zt : Qt);
		return c;
	}, C = () => {
		let t = _++;
		if (!e.flag(W, W, W, on)) return l.kinds[t] = e.flag(W + 1, W + 1, W + 1, on) ? 2 : 0, t;
		l.kinds[t] = 1;
		let n = v;
		if (v = t, n >= 0 && e.flag(W + 2, W + 2, W + 2, on)) {
			let n = e.raw(B(t - 1));
			if (n >= t || l.kinds[n] !== 1) throw j(o, "a map that is not there");
			return l.maps.copyWithin(6 * t, 6 * n, 6 * n + 6), t;
		}
		let r = n >= 0 && e.flag(W + 3, W + 3, W + 3, on);
		for (let i = 0; i < 4; i++) l.maps[6 * t + i] = r ? l.maps[6 * n + i] : e.raw(32);
		for (let n = 4; n < 6; n++) l.maps[6 * t + n] = e.raw(a);
		return t;
	};
	for (let e = 0; e < s; e++) {
		for (let t = 0; t < 3; t++) f[t] = b(e, t), p[t] = Xt;
		let r = -1, i = [];
		for (let a = 0; a < 3; a++) {
			let s = S(e, a);
			if (s >= 0) r = l.chart[s];
			else {
				if (g >= n) throw j(o, "more vertices than announced");
				s = g++;
				let r = t.faces[3 * e + a];
				l.place[s] = r, d[s] = u[r], u[r] = s, i.push(s);
			}
			l.faces[3 * e + a] = s;
		}
		r < 0 && (r = C());
		for (let e of i) l.chart[e] = r;
	}
	if (g !== n) throw j(o, "fewer vertices than announced");
	return l;
}
// eigenfield-three/src/mesh-values.ts
var ln = 16, un = 6, dn = 13, fn = 14, pn = 20, mn = nn, hn = mn + 169 + 280 + 182, gn = hn + 144 + 576 + 48, [_n, vn] = [12, 13], yn = [
	.5,
	1.5,
	3,
	6,
	12,
	30
];
function bn(e, t) {
	return wt(Number.isNaN(e) ? t : e);
}
function xn(e) {
	let t = yn.filter((t) => Math.abs(e) >= t).length;
	return e < 0 ? un - t : un + t;
}
function Sn(e, t, n, r) {
	let { points: i, faces: a, parents: o } = t, s = /* @__PURE__ */ new Float64Array(9), c = (e) => i[3 * e], l = (e) => i[3 * e + 1], u = (e) => i[3 * e + 2], d = (e, t) => {
		let [n, r, i] = [
			c(t) - c(e),
			l(t) - l(e),
			u(t)
		], a = 1 / (1 + n * n + r * r);
		return s[0] += a, s[1] += a * n, s[2] += a * r, s[3] += a * n * n, s[4] += a * n * r, s[5] += a * r * r, s[6] += a * i, s[7] += a * n * i, s[8] += a * r * i, a;
	}, [f, p, m] = [
		0,
		0,
		0
	];
	for (let t = 0; t < i.length / 3; t++) {
		s.fill(0);
		let [h, g, _, v] = [
			0,
			0,
			Infinity,
			-Infinity
		];
		for (let e = n[t]; e < Math.min(n[t + 1], n[t] + ln); e++) for (let i = 1; i < 3; i++) {
			let o = Cn(a, r[e], i);
			if (o >= t) continue;
			let s = d(t, o);
			h += s * u(o), g += s, _ = Math.min(_, u(o)), v = Math.max(v, u(o));
			for (let e = n[o]; e < Math.min(n[o + 1], n[o] + ln); e++) for (let n = 1; n < 3; n++) {
				let i = Cn(a, r[e], n);
				i < t && d(t, i);
			}
		}
		let y = 13, b = t > 0 ? u(t - 1) : 0, x = b;
		g > 0 && (y = Math.min(B(v - _), 12), b = h / g, x = Math.min(Math.max(wn(s), p), m));
		let S = b, [C, w, T] = [
			o[3 * t],
			o[3 * t + 1],
			o[3 * t + 2]
		];
		if (C >= 0) {
			let [e, n, r, i] = [
				c(w) - c(C),
				l(w) - l(C),
				c(T) - c(C),
				l(T) - l(C)
			], [a, o] = [c(t) - c(C), l(t) - l(C)], s = e * i - n * r;
			if (s !== 0) {
				let [t, c] = [(a * i - o * r) / s, (e * o - n * a) / s];
				S = Math.min(Math.max(u(C) + t * (u(w) - u(C)) + c * (u(T) - u(C)), p), m);
			}
		}
		let E = bn(x, b), [D, O] = [xn(S - E), xn(b - E)], ee = e.integer(mn + D * dn + O, mn + 169 + y * pn + f, mn + 169 + 280 + D * fn + y, _n), k = E + ee;
		i[3 * t + 2] = k, f = Math.min(B(Math.abs(ee)), 19), p = t === 0 ? k : Math.min(p, k), m = t === 0 ? k : Math.max(m, k);
	}
}
function Cn(e, t, n) {
	let r = t % 3;
	return e[t - r + (r + n) % 3];
}
function wn(e) {
	let [t, n, r] = [
		e[0],
		e[1],
		e[2]
	], [i, a, o] = [
		e[3] + 1,
		e[4],
		e[5] + 1
	], [s, c, l] = [
		e[6],
		e[7],
		e[8]
	], [u, d, f] = [
		i * o - a * a,
		n * o - a * r,
		n * a - i * r
	];
	return (s * u - c * d + l * f) / (t * u - n * d + r * f);
}
function Tn(e, t, n, r, i) {
	let { faces: a, chart: o, kinds: s, place: c } = t, l = new Int32Array(2 * c.length), u = [0, 0], d = -1;
	for (let t = 0; t < c.length; t++) {
		let f = s[o[t]];
		if (f === 1) continue;
		let [p, m, h, g, _] = [
			0,
			0,
			0,
			-1,
			0
		];
		for (let e = r[t]; e < Math.min(r[t + 1], r[t] + ln); e++) {
			let [r, s] = [Cn(a, i[e], 1), Cn(a, i[e], 2)];
			if (r < t && o[r] === o[t] && (g = Math.max(g, r)), s < t && o[s] === o[t] && (g = Math.max(g, s)), r >= t || s >= t) continue;
			let [u, d] = En(n, c, l, t, r, s, f === 2);
			if (!Number.isFinite(u) || !Number.isFinite(d)) continue;
			p += u, m += d, h += 1;
			let v = Math.abs(l[2 * r] - l[2 * s]) + Math.abs(l[2 * r + 1] - l[2 * s + 1]);
			_ = Math.max(_, B(v));
		}
		g < 0 && (g = d), d = t;
		let v = [g >= 0 ? l[2 * g] : 0, g >= 0 ? l[2 * g + 1] : 0], y = h > 0 ? [p / h, m / h] : v, [b, x] = [Math.min(h, 2), Math.min(_, 23)], S = hn + 144;
		for (let n = 0; n < 2; n++) {
			let r = e.integer(hn + (n * 24 + x) * 3 + b, S + u[0] * 24 + x, S + 576 + n * 24 + u[n], vn + n);
			l[2 * t + n] = bn(y[n], 0) + r, u[n] = Math.min(B(Math.abs(r)), 23);
		}
	}
	return l;
}
function En(e, t, n, r, i, a, o) {
	let [s, c, l] = [
		0,
		0,
		0
	];
	for (let n = 0; n < 3; n++) {
		let o = e[3 * t[i] + n], u = e[3 * t[a] + n] - o, d = e[3 * t[r] + n] - o;
		s += u * u, c += u * d, l += d * d;
	}
	let [u, d] = [n[2 * a] - n[2 * i], n[2 * a + 1] - n[2 * i + 1]], f = c / s, p = Math.sqrt(Math.max(l / s - f * f, 0)), m = o ? -p : p;
	return [n[2 * i] + f * u - m * d, n[2 * i + 1] + f * d + m * u];
}
// eigenfield-three/src/mesh-decoder.ts
var Dn = 144, On = 2, kn = 3, An = 18, jn = 8;
function Mn(e, t) {
	return Pn(e, t, 1);
}
function Nn(e, t) {
	return Pn(e, t, On);
}
function Pn(e, t, n) {
	let r = V(e, Dn, t, n), [i, a, o] = [
		r.getUint8(1),
		r.getUint8(2),
		r.getUint8(3)
	], [s, c, l] = [
		4,
		8,
		12
	].map((e) => r.getUint32(e, !0)), u = Float64Array.from({ length: 16 }, (e, t) => r.getFloat64(16 + 8 * t, !0));
	if (s > be || l > be || c > xe) throw j(t, `${l} vertices and ${c} faces`);
	if (Le(e, Math.max(s, c, l), xe, t), i > 1 || o > jn * i || a < 1 || a > An || !u.every(Number.isFinite)) throw j(t, "a lattice that cannot be");
	let d = new Ie(e.subarray(Dn), gn, 16), f = Kt(d, s, c, {
		flat: i === 1,
		fine: o
	}, t);
	d.checkEnd(t);
	let p = sn(f.faces, s);
	i && Sn(d, f, p.first, p.corners);
	let m = n === On ? a + kn : 32, h = cn(d, f, l, p.first, p.corners, m, t), g = Fn(f.points, u), _ = sn(h.faces, l), v = Tn(d, h, g, _.first, _.corners);
	d.checkEnd(t);
	let y = new Float32Array(h.maps.buffer);
	return Ln(In(f, h, g, v, 2 ** a, (e) => n === On ? h.maps[e] / 2 ** (a + 1) - 2 : y[e]), t);
}
function Fn(e, t) {
	let n = new Float64Array(e.length);
	for (let r = 0; r < e.length; r += 3) {
		let i = (n) => t[4 * n] * e[r] + t[4 * n + 1] * e[r + 1] + t[4 * n + 2] * e[r + 2] + t[4 * n + 3], a = i(3);
		for (let e = 0; e < 3; e++) n[r + e] = i(e) / a;
	}
	return n;
}
function In(e, { faces: t, place: n, chart: r, kinds: i, maps: a }, o, s, c, l) {
	let u = new Float32Array(3 * n.length), d = new Float32Array(2 * n.length), f = new Float32Array(a.buffer);
	return n.forEach((t, n) => {
		u.set(o.subarray(3 * t, 3 * t + 3), 3 * n);
		let a = 6 * r[n], p = i[r[n]] === 1;
		for (let r = 0; r < 2; r++) {
			let i = a + 2 * r;
			d[2 * n + r] = p ? f[i] * e.points[3 * t] + f[i + 1] * e.points[3 * t + 1] + l(a + 4 + r) : s[2 * n + r] / c;
		}
	}), {
		positions: u,
		uv: d,
		indices: new Uint32Array(t)
	};
}
function Ln(e, t) {
	let n = (e) => Math.abs(e) <= Ce;
	if (!e.positions.every(n) || !e.uv.every(n)) throw j(t, "positions or texture coordinates that are not finite");
	return e;
}
// eigenfield-three/src/name-decoder.ts
var Rn = 4 * L;
async function zn(e, t, n) {
	let r = Math.min(ye, Rn * t), i = await le(Uint8Array.from(e), "deflate", r, n), a = i.length / t;
	if (a === 0 || !Number.isInteger(a)) throw j(n, `${i.length} bytes of ${t} names`);
	let o = new TextDecoder("utf-8", {
		fatal: !0,
		ignoreBOM: !0
	}), s = new Uint8Array(a), c = [];
	for (let e = 0; e < t; e++) {
		for (let n = 0; n < a; n++) s[n] = i[n * t + e];
		let r = a;
		for (; r > 0 && s[r - 1] === 0;) --r;
		try {
			c.push(o.decode(s.subarray(0, r)));
		} catch {
			throw j(n, "names that are not UTF-8");
		}
	}
	return c;
}
// eigenfield-three/src/headers.ts
function Bn(e) {
	let t = new DataView(e);
	try {
		return Hn(t) ?? Un(t) ?? Wn(t) ?? Gn(t);
	} catch (e) {
		if (e instanceof RangeError) return null;
		throw e;
	}
}
function Vn(e, t) {
	return String.fromCharCode(...[
		0,
		1,
		2,
		3
	].map((n) => e.getUint8(t + n)));
}
function Hn(e) {
	return e.getUint32(0) !== 2303741511 || e.getUint32(4) !== 218765834 || Vn(e, 12) !== "IHDR" ? null : {
		type: "image/png",
		width: e.getUint32(16),
		height: e.getUint32(20),
		bits: null
	};
}
function Un(e) {
	if (e.getUint16(0) !== 65496) return null;
	for (let t = 2;;) {
		let n = e.getUint16(t);
		if (n === 65535) {
			t += 1;
			continue;
		}
		let r = n >= 65472 && n <= 65487 && ![
			65476,
			65480,
			65484
		].includes(n), i = (n) => e.getUint16(t + n);
		if (r) return {
			type: "image/jpeg",
			width: i(7),
			height: i(5),
			bits: null
		};
		if (n < 65281 || n === 65498 || n === 65497) return null;
		t += 2 + e.getUint16(t + 2);
	}
}
function Wn(e) {
	if (Vn(e, 0) !== "RIFF" || Vn(e, 8) !== "WEBP") return null;
	let t = {
		type: "image/webp",
		bits: null
	}, n = Vn(e, 12), r = (t) => e.getUint16(t, !0) + 65536 * e.getUint8(t + 2);
	if (n === "VP8X") return {
		...t,
		width: 1 + r(24),
		height: 1 + r(27)
	};
	if (n === "VP8L") {
		let n = e.getUint32(21, !0);
		return {
			...t,
			width: 1 + (n & 16383),
			height: 1 + (n >>> 14 & 16383)
		};
	}
	return n === "VP8 " ? {
		...t,
		width: e.getUint16(26, !0) & 16383,
		height: e.getUint16(28, !0) & 16383
	} : null;
}
function Gn(e) {
	if (Vn(e, 4) !== "ftyp") return null;
	let t = null, n = null, r = (i, a) => {
		for (let o = i; o + 8 <= a;) {
			let i = e.getUint32(o), s = Vn(e, o + 4), c = i === 0 ? a : o + i;
			if (i === 1 || c < o + 8 || c > a) return;
			if (s === "meta" && r(o + 12, c), (s === "iprp" || s === "ipco") && r(o + 8, c), s === "ispe") {
				let [n, r] = [e.getUint32(o + 12), e.getUint32(o + 16)];
				(!t || n * r > t.width * t.height) && (t = {
					width: n,
					height: r
				});
			}
			if (s === "av1C") {
				let t = e.getUint8(o + 10);
				n ??= t & 64 ? t & 32 ? 12 : 10 : 8;
			}
			o = c;
		}
	};
	return r(0, e.byteLength), t && {
		type: "image/avif",
		...t,
		bits: n
	};
}
// eigenfield-three/src/pictures-8bit.ts
var Kn = {
	colorSpaceConversion: "none",
	premultiplyAlpha: "none"
}, qn = {
	"image/avif": "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOltZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAAAAABAAAAHmlsb2MAAAAARAAAAQABAAAAAQAAAQ0AAAAZAAAAKGlpbmYAAAAAAAEAAAAaaW5mZQIAAAAAAQAAYXYwMUNvbG9yAAAAAGhpcHJwAAAASWlwY28AAAAUaXNwZQAAAAAAAAAIAAAACAAAAA5waXhpAAAAAAEIAAAADGF2MUOBABwAAAAAE2NvbHJuY2x4AAEADQAGgAAAABdpcG1hAAAAAAAAAAEAAQQBAoMEAAAAIW1kYXQSAAoIGAi/aYCGg1AyCxlGIYeeaACQQNmg",
	"image/webp": "UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAAAdQwAIWsP+BiOh/AAA="
};
function Jn(e, t, n) {
	let r = Bn(e);
	if (!r) throw j(t.where, "no picture");
	let { width: i, height: a, bits: o } = r;
	if (n && (i !== n[0] || a !== n[1])) throw j(t.where, `a picture of ${i} x ${a}, not of ${n[0]} x ${n[1]}`);
	if (t.codec.bits !== 8 && t.codec.bits !== o) throw j(t.where, `no picture of ${t.codec.bits} bits`);
	let s = i * a;
	if (!s || i > 16384 || a > 32768 || s > me) throw j(t.where, `a picture of ${i} x ${a}`);
	return [i, a];
}
async function Yn(e, t, n, r) {
	let [i, a] = Jn(e, t, n), [o, s] = [Math.ceil(i / r), Math.ceil(a / r)], c = r === 1 ? {} : {
		resizeWidth: o,
		resizeHeight: s,
		resizeQuality: "high"
	}, l = Bn(e)?.type ?? t.codec.mimeType, u;
	try {
		u = await createImageBitmap(new Blob([e], { type: l }), {
			...Kn,
			...c
		});
	} catch (e) {
		throw await Zn(l) ? j(t.where, "it cannot be decoded") : Qn(l, t, e);
	}
	if (u.width === o && u.height === s) return u;
	throw u.close(), j(t.where, `decoded to ${u.width} x ${u.height}, not to ${o} x ${s}`);
}
var Xn = async (e, t, n, r = 1) => {
	let i = t.pieces * t.textures, [a, o] = Jn(e, t, n && [n[0], i * n[1]]), s = await Yn(e, t, [a, o], i === 1 ? r : 1);
	if (i === 1) return [{
		picture: s,
		row: 0,
		rows: s.height
	}];
	let c = o / i, l = Array.from({ length: i }, (e, t) => ({
		picture: s,
		row: t * c,
		rows: c
	}));
	if (r === 1) return l;
	let [u, d] = [Math.ceil(a / r), Math.ceil(c / r)], f = {
		...Kn,
		resizeWidth: u,
		resizeHeight: d,
		resizeQuality: "high"
	}, p = await Promise.all(l.map(({ row: e }) => createImageBitmap(s, 0, e, a, c, f)));
	return s.close(), p.map((e) => ({
		picture: e,
		row: 0,
		rows: d
	}));
};
async function Zn(e) {
	let t = qn[e];
	if (!t) return !0;
	let n = Uint8Array.from(atob(t), (e) => e.charCodeAt(0));
	try {
		return (await createImageBitmap(new Blob([n], { type: e }))).close(), !0;
	} catch {
		return !1;
	}
}
function Qn(e, t, n) {
	return new A("codec", `This browser cannot decode ${e.replace("image/", "").toUpperCase()} pictures; use a newer one, or encode the scene with --codec png.`, t.where, { cause: n });
}
// eigenfield-three/src/pictures-10bit.ts
var $n = /* @__PURE__ */ new Set([
	"I420P10",
	"I422P10",
	"I444P10"
]), er = async (e, t, n, r = 1) => {
	let i = t.pieces * t.textures, [a, o] = Jn(e, t, n && [n[0], i * n[1]]), s = await tr(e, a, o);
	if (!s) return Xn(e, t, n, r);
	let c = o / i;
	return Array.from({ length: i }, (e, t) => {
		if (r === 1) return {
			picture: s,
			row: t * c,
			rows: c
		};
		let n = nr(s, t * c, c, r);
		return {
			picture: n,
			row: 0,
			rows: n.height
		};
	});
};
async function tr(e, t, n) {
	if (typeof ImageDecoder > "u") return null;
	let r = null, i = null;
	try {
		r = new ImageDecoder({
			data: e,
			type: "image/avif"
		}), i = (await r.decode()).image;
		let a = i.visibleRect;
		if (!$n.has(i.format ?? "") || a?.width !== t || a.height !== n) return null;
		let o = new Uint8Array(i.allocationSize()), [s] = await i.copyTo(o);
		return s ? {
			data: o.subarray(s.offset),
			width: t,
			height: n,
			stride: s.stride
		} : null;
	} catch {
		return null;
	} finally {
		i?.close(), r?.close();
	}
}
function nr(e, t, n, r) {
	let [i, a] = [Math.ceil(e.width / r), Math.ceil(n / r)], o = new Uint8Array(2 * i * a);
	for (let s = 0; s < a; s++) for (let a = 0; a < i; a++) {
		let [c, l] = [0, 0];
		for (let i = s * r; i < Math.min((s + 1) * r, n); i++) for (let n = a * r; n < Math.min((a + 1) * r, e.width); n++) {
			let r = (t + i) * e.stride + 2 * n;
			c += (e.data[r] ?? 0) + 256 * (e.data[r + 1] ?? 0), l += 1;
		}
		let u = Math.round(c / l);
		o.set([u & 255, u >> 8], 2 * (s * i + a));
	}
	return {
		data: o,
		width: i,
		height: a,
		stride: 2 * i
	};
}
// eigenfield-three/src/triangle-decoder.ts
var rr = 5;
function ir(e, t) {
	let n = V(e, rr, t).getUint32(1, !0);
	Le(e, 3 * n, 6 * I, t);
	let r = Ye(e.subarray(rr)), i = $e(r, n, 3, !0);
	r.checkEnd(t);
	let a = i.map((e, t) => t % 3 ? i[t - t % 3] + e : e);
	if (!a.every((e) => e >= 0 && e < 1e5)) throw j(t, "triangles of cameras that there cannot be");
	return { corners: Uint32Array.from(a) };
}
// eigenfield-three/src/weight-decoder.ts
var ar = 14, or = 2 ** 20;
function sr(e, t) {
	let n = V(e, ar, t), r = n.getUint8(1) === 1, [i, a] = [n.getUint32(6, !0), n.getUint32(10, !0)], o = r ? n.getUint16(2, !0) : 1, s = r ? n.getUint16(4, !0) : i;
	if (n.getUint8(1) > 1 || i === 0) throw j(t, "weights of no camera, or of an unknown kind");
	Le(e, o * s * Math.max(a, 1), Se, t), V(e, ar + 4 * a, t);
	let c = o * s;
	if (c < i) throw j(t, "a grid with too few cells");
	let l = Ye(e.subarray(ar + 4 * a)), u = r ? et(l, c, i, t) : null, d = u !== null && i === c, f = [
		0,
		1,
		2
	].map(() => new Float64Array(c)), p = new Float32Array(i * a), m = 4 * or * Math.max(o, s);
	for (let e = 0; e < a; e++) {
		let r = n.getFloat32(ar + 4 * e, !0);
		if (!(r > 0 && r < Infinity)) throw j(t, "a step that is not positive");
		let i = Xe(l), h = Qe(l, s, f[i], i);
		if (i === 2 && !d || h.some((e) => Math.abs(e) > m)) throw j(t, `numbers of component ${e} that cannot be`);
		f[i] = h;
		let g = i === 2 ? cr(h, o, s) : h;
		for (let t = 0; t < c; t++) {
			let n = u ? u[t] : t;
			n >= 0 && (p[n * a + e] = g[t] * r);
		}
		l.checkEnd(t);
	}
	if (!p.every(Number.isFinite)) throw j(t, "weights that are not finite");
	return {
		cameras: i,
		components: a,
		values: p
	};
}
function cr(e, t, n) {
	let r = new Float64Array(t * n), i = new Float64Array(t * n), a = lr(n);
	for (let i = 0; i < t; i++) for (let t = 0; t < n; t++) {
		let o = 0;
		for (let r = 0; r < n; r++) o += a(r, t) * e[i * n + r];
		r[i * n + t] = o;
	}
	let o = lr(t);
	for (let e = 0; e < t; e++) for (let a = 0; a < n; a++) {
		let s = 0;
		for (let i = 0; i < t; i++) s += o(i, e) * r[i * n + a];
		i[e * n + a] = s;
	}
	return i;
}
function lr(e) {
	let [t, n] = [Math.sqrt(1 / e), Math.sqrt(2 / e)], r = Float64Array.from({ length: 4 * e }, (t, r) => n * Math.cos(Math.PI * r / (2 * e)));
	return (n, i) => n === 0 ? t : r[(2 * i + 1) * n % (4 * e)];
}
// eigenfield-three/src/codecs.ts
function ur(e) {
	let [t, n] = [Xn, Xn];
	return {
		kind: "picture",
		decode: t,
		bitmaps: n,
		needs: null,
		limits: [
			"MAX_SIDE",
			"MAX_STACKED",
			"MAX_TEXELS"
		],
		mimeType: e,
		bits: 8
	};
}
var G = {
	"mesh-1": {
		kind: "mesh",
		decode: Mn,
		needs: "codedMesh",
		limits: ["MAX_VERTICES", "MAX_TRIANGLES"]
	},
	"mesh-2": {
		kind: "mesh",
		decode: Nn,
		needs: "mesh-2",
		limits: ["MAX_VERTICES", "MAX_TRIANGLES"]
	},
	"cameras-1": {
		kind: "cameras",
		decode: st,
		needs: "codedCameras",
		limits: ["MAX_CAMERAS"]
	},
	"cameras-2": {
		kind: "cameras",
		decode: ot,
		needs: "cameras-2",
		limits: ["MAX_CAMERAS"]
	},
	"names-1": {
		kind: "names",
		decode: zn,
		needs: "codedNames",
		limits: ["MAX_NAMES", "MAX_CAMERAS"]
	},
	"triangles-1": {
		kind: "triangles",
		decode: ir,
		needs: "codedTriangles",
		limits: ["MAX_CAMERAS"]
	},
	"weights-1": {
		kind: "weights",
		decode: sr,
		needs: "codedWeights",
		limits: ["MAX_WEIGHTS"]
	},
	png: ur("image/png"),
	webp: ur("image/webp"),
	avif: ur("image/avif"),
	jpeg: ur("image/jpeg"),
	"av1-10bit-1": {
		...ur("image/avif"),
		bits: 10,
		decode: er,
		needs: "bits"
	},
	"av1-10bit-2": {
		...ur("video/AV1"),
		bits: 10,
		decode: (e, t, n, r) => er(se(e, t.where), t, n, r),
		bitmaps: (e, t, n, r) => Xn(se(e, t.where), t, n, r),
		needs: "av1-10bit-2"
	}
}, dr = {
	mesh: "mesh-1",
	cameras: "cameras-1",
	names: "names-1",
	triangles: "triangles-1",
	weights: "weights-1"
};
function fr(e, t, n) {
	let r = t.exists ? t.text(L) : n, i = Object.hasOwn(G, r) ? G[r] : null;
	if (i?.kind === e) return i;
	throw new A("codec-unknown", `${`A ${e} stream has the codec "${r.slice(0, 60)}", which this viewer does not know`}; take a newer viewer.`, t.where);
}
function pr(e, t) {
	return Object.keys(G).find((n) => {
		let r = G[n];
		return r.kind === "picture" && r.mimeType === e && (t ?? r.bits) === r.bits;
	});
}
// eigenfield-three/src/json.ts
var K = class e {
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
	number(e = -Ce, t = Ce) {
		if (typeof this.raw != "number") throw this.wrong("no number");
		if (!(this.raw >= e && this.raw <= t)) throw this.wrong(`${this.raw} is not in ${e}..${t}`);
		return this.raw;
	}
	integer(e, t) {
		let n = this.number(e, t);
		if (!Number.isInteger(n)) throw this.wrong(`${n} is no whole number`);
		return n;
	}
	numbers(e, t = -Ce, n = Ce) {
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
		return j(this.where || "/", this.exists ? e : "missing");
	}
}, mr = 5121, hr = 5123, gr = 5125, q = 5126, _r = {
	[mr]: 1,
	[hr]: 2,
	[gr]: 4,
	[q]: 4
}, vr = /* @__PURE__ */ new Set([
	"cameras",
	"triangles",
	"weights"
]), yr = {
	SCALAR: 1,
	VEC2: 2,
	VEC3: 3
};
function br(e) {
	let t = e.key("buffers").at(0);
	if (t.key("uri").exists) throw t.wrong("not the binary chunk");
	let n = t.key("byteLength").integer(0, 2 ** 32 - 1);
	return e.key("bufferViews").items(F).map((e) => {
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
function xr(e) {
	return (t) => t.integer(0, e.length - 1);
}
function Sr(e, t) {
	let n = e.key("accessors").items(F);
	return (e, r, i, a) => {
		let o = n[e.integer(0, n.length - 1)];
		if (!o) throw e.wrong("no such accessor");
		let s = o.key("componentType").integer(5120, 5126);
		if (!i.includes(s)) throw o.wrong(`component type ${s}`);
		if (o.key("type").text(1024) !== r) throw o.wrong(`not ${r}`);
		if (o.key("sparse").exists) throw o.wrong("sparse");
		let c = o.key("normalized");
		if (c.exists && c.raw !== !1) throw o.wrong("normalised");
		let l = yr[r] ?? 1, u = o.key("count").integer(1, Se);
		if (a !== null && u !== a) throw o.wrong(`${a} numbers are needed, not ${u}`);
		let d = o.key("bufferView").integer(0, t.length - 1), f = t[d];
		if (!f) throw o.wrong("no such buffer view");
		let p = o.key("byteOffset"), m = p.exists ? p.integer(0, f.length) : 0, h = _r[s] * l;
		if (f.stride && (f.stride < h || r === "SCALAR")) throw o.wrong("a stride that cannot be");
		if (m + (u - 1) * (f.stride || h) + h > f.length) throw o.wrong("outside its buffer view");
		if ((m + f.offset) % _r[s]) throw o.wrong("not aligned");
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
function Cr(e, t, n) {
	let r = typeof t.raw == "number" && vr.has(e), i = fr(e, r ? new K(void 0, t.where) : t.key("codec"), dr[e]);
	return {
		view: n(r ? t : t.key("bufferView")),
		codec: i,
		where: t.where
	};
}
async function wr(e, t, n) {
	let r = await n(e.view), i = t[e.view]?.length ?? Infinity;
	if (r.byteLength < i) throw re(e.where);
	let { offset: a, count: o, items: s, type: c } = e, l = r.slice(a, a + _r[c] * o * s);
	return c === 5125 ? new Uint32Array(l) : c === 5123 ? new Uint16Array(l) : Tr(new Float32Array(l), e.where);
}
function Tr(e, t) {
	for (let n of e) if (!(Math.abs(n) <= 1e30)) throw j(t, `${n} among its numbers`);
	return e;
}
// eigenfield-three/src/planes.ts
var J = 8, Er = 16;
function Dr(e, t) {
	return new A("unsupported", `The scene has ${e}, which this viewer does not draw; draw it with "eigenfield render".`, t);
}
function Or(e, t = fe) {
	let [n = 0, r = 0] = e.items(2).map((e) => e.integer(1, t));
	if (!n || !r) throw e.wrong("two numbers are needed");
	if (n * r > me) throw e.wrong(`more than ${me} texels`);
	return [n, r];
}
function kr(e, t, n, r, i) {
	let a = e.key("planes").items(16);
	if (!a.length) throw e.key("planes").wrong("no plane");
	let o = a.map((e, a) => {
		let o = e.key("channels").integer(1, 64), s = Lr(e, o, a === 0 ? n : null, i), c = e.key("bases").items(64), l = (e) => zr(e, o, t, r, i);
		return {
			channels: o,
			...s,
			bases: c.map(l)
		};
	}), [s, c] = [0, 0];
	for (let { channels: e, meanSize: t, bases: n } of o) {
		s += 4 * e * (t ? t[0] * t[1] : 0);
		for (let { size: t, count: r, pictures: i } of n) {
			let n = i.reduce((e, { textures: t, codec: n }) => e + t * (n.bits === J ? 1 : 2), 0);
			s += t[0] * t[1] * e * n, c += r;
		}
	}
	if (c > 4096) throw e.key("planes").wrong(`more than ${he} textures`);
	if (s > ge) throw e.key("planes").wrong("too large when it is decoded");
	return o;
}
function Ar(e, t) {
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
	throw Dr(`${t.length > 1 ? `${t.length} planes` : `${n} channels`} and no colours for them`, `${e.where}/planes`);
}
function jr(e, t, n, r, i, a = !1) {
	let o = Mr(e), s = t === 3 && o.bits === J ? 1 : t;
	r && Br(e, s * n, r);
	let [c, l] = [e.key("scale"), e.key("zero")], u = {
		view: i(e.key("bufferView")),
		codec: o,
		textures: n,
		pieces: s,
		where: e.where
	};
	return a && o.bits === J && !c.exists && !l.exists ? {
		...u,
		...Nr(t)
	} : {
		...u,
		scale: Ir(c, t, n),
		zero: Ir(l, t, n)
	};
}
function Mr(e) {
	let t = e.key("mimeType").text(L);
	if (!pr(t)) throw e.key("mimeType").wrong("an unknown type");
	let n = e.key("bits"), r = n.exists ? n.integer(1, Er) : J, i = pr(t, r);
	if (!i) throw n.wrong(`${r} bits of ${t}`);
	let a = e.key("codec"), o = fr("picture", a, i);
	if (o.mimeType !== t || o.bits !== r) throw a.wrong(`${r} bits of ${t}`);
	return o;
}
function Nr(e) {
	return {
		scale: Array(e).fill(1 / 255),
		zero: Array(e).fill(0)
	};
}
function Pr(e) {
	return e.some(({ codec: e }) => e.bits > J);
}
function Fr({ codec: e }) {
	return (2 ** e.bits - 1) / 255;
}
function Ir(e, t, n) {
	let r = e.items(t * n).map((e) => e.number());
	if (r.length === t * n) return r;
	if (r.length !== t) throw e.wrong(`${t} or ${t * n} numbers are needed`);
	return Array(n).fill(r).flat();
}
function Lr(e, t, n, r) {
	let i = e.key("mean");
	if (!i.exists) {
		if (n === null || t !== 1 && t !== 3) throw i.wrong("no mean");
		return {
			mean: {
				view: n,
				codec: G.png,
				textures: 1,
				pieces: 1,
				where: "/images/0",
				...Nr(t)
			},
			meanSize: null,
			precision: null
		};
	}
	let a = Or(i.key("size")), o = jr(i, t, 1, a, r, !0);
	return {
		mean: o,
		meanSize: a,
		precision: Rr(i.key("precision"), o, r)
	};
}
function Rr(e, t, n) {
	if (!e.exists) return null;
	if (t.codec.bits === J) throw e.wrong(`of a mean of ${J} bits`);
	let r = Or(e.key("size"), pe), i = fr("picture", e.key("codec"), "png");
	if (i !== G.png) throw e.key("codec").wrong("no PNG");
	return {
		view: n(e.key("bufferView")),
		codec: i,
		size: r,
		textures: 1,
		pieces: 1,
		where: e.where
	};
}
function zr(e, t, n, r, i) {
	let a = Or(e.key("size")), [o, s] = [e.key("grid"), e.key("corner")], c = o.exists ? Or(o) : a, [l = 0, u = 0] = s.exists ? s.numbers(2, 0, fe) : [];
	if (!Number.isInteger(l) || !Number.isInteger(u)) throw s.wrong("no whole numbers");
	if (l + a[0] > c[0] || u + a[1] > c[1]) throw e.wrong("textures beyond their grid");
	let d = 0, f = e.key("picture"), p = f.exists ? f.object() : {}, m = e.key("textures").items(he).map((e) => {
		let n = new K({
			...p,
			...e.object()
		}, e.where), r = n.key("count"), o = r.exists ? r.integer(1, he) : 1;
		return d += o, jr(n, t, o, a, i);
	});
	if (d > 4096) throw e.wrong(`more than ${he} textures`);
	let h = e.key("codedWeights"), g = d ? h.exists ? Cr("weights", h, i) : r(e.key("weights"), "SCALAR", [q], n * d) : null;
	return {
		size: a,
		grid: c,
		corner: [l, u],
		pictures: m,
		count: d,
		weights: g,
		where: e.where
	};
}
function Br(e, t, [n, r]) {
	let i = t * r;
	if (t > 1 && i > 32768) throw e.wrong(`a picture of ${i} rows`);
	if (n * i > me) throw e.wrong(`more than ${me} texels`);
}
// eigenfield-three/src/document.ts
var Vr = [
	"namePattern",
	"packed",
	"precision",
	"regions",
	"sharedPicture",
	"stacks",
	"toRGB"
], Hr = Object.values(G).flatMap(({ needs: e }) => e ?? []), Ur = /* @__PURE__ */ new Set([...Vr, ...Hr]), Wr = 64, Gr = 9, Kr = 10 ** Gr;
function qr(e) {
	let t = new K(e, "");
	try {
		return t.key("extensions").key(ue).exists;
	} catch {
		return !1;
	}
}
function Jr(e) {
	let t = new K(e, ""), n = t.key("extensions").key(ue), r = Yr(n), i = br(t), a = Sr(t, i), o = xr(i);
	Xr(t);
	let s = $r(t, o), c = n.key("cameras"), { count: l, names: u } = ei(c, o), d = ri(c, l), f = d.filter((e) => !e).length, p = kr(n, f, s, a, o), m = Ar(n, p), h = c.key("colour");
	if (h.exists && m.length < 3) throw h.wrong("needs three channels");
	let g = n.key("viewPlane"), [_, v] = [g.key("triangles"), g.key("codedTriangles")], y = t.key("meshes").at(0).key("primitives").at(0), b = y.key("mode");
	if (b.exists && b.integer(0, 6) !== 4) throw b.wrong("no triangles");
	let [x, S] = [y.key("attributes"), y.key("indices")], C = n.key("generator"), w = n.key("mesh");
	return {
		version: r,
		generator: C.exists ? C.text(L) : "",
		planes: p,
		colours: m,
		names: u,
		heldOut: d,
		reference: n.key("reference").integer(0, l - 1),
		calibration: ii(c, l, a, o),
		sizes: ai(c, l, a),
		colour: h.exists ? a(h, "SCALAR", [q], 6 * l) : null,
		...oi(g),
		triangles: v.exists ? Cr("triangles", v, o) : _.exists ? Qr(a(_, "SCALAR", [hr, gr], null), 2 * I) : null,
		settings: si(n.key("settings")),
		scores: si(n.key("scores")),
		views: i,
		mesh: w.exists ? Cr("mesh", w, o) : null,
		position: Zr(a(x.key("POSITION"), "VEC3", [q], null), be),
		uv: Zr(a(x.key("TEXCOORD_0"), "VEC2", [q], null), be),
		indices: Qr(a(S, "SCALAR", [
			mr,
			hr,
			gr
		], null), xe),
		preview: s
	};
}
function Yr(e) {
	let t = e.key("version").text(L);
	if (!/^1\.\d+$/.test(t)) throw new A("version", `The scene is of format version ${t.slice(0, 20)} and this viewer reads 1.x; take a newer viewer.`, `${e.where}/version`);
	let n = e.key("needs");
	for (let e of n.exists ? n.items(F) : []) {
		let t = e.text(L);
		if (!Ur.has(t)) throw new A("needs", `The scene needs "${t.slice(0, 60)}", which this viewer cannot draw; take a newer viewer.`, e.where);
	}
	return t;
}
function Xr(e) {
	let t = e.key("nodes").items(F), n = Array(t.length).fill(!1);
	for (let e of t) {
		let r = e.key("children");
		for (let e of r.exists ? r.items(t.length) : []) {
			let r = e.integer(0, t.length - 1);
			if (n[r]) throw e.wrong("a node with two parents");
			n[r] = !0;
		}
	}
	for (let r of e.key("scenes").items(F)) {
		let e = r.key("nodes");
		for (let r of e.exists ? e.items(t.length) : []) if (n[r.integer(0, t.length - 1)]) throw r.wrong("a node with two parents");
	}
}
function Zr(e, t) {
	if (e.count > t) throw j(e.where, `more than ${t}`);
	return e;
}
function Qr(e, t) {
	if (e.count % 3) throw j(e.where, "torn triangles");
	return Zr(e, 3 * t);
}
function $r(e, t) {
	let n = e.key("images");
	if (!n.exists) return null;
	let r = n.at(0).key("bufferView");
	return r.exists ? t(r) : null;
}
function ei(e, t) {
	let n = e.key("codedNames");
	if (n.exists) return {
		count: n.key("count").integer(1, I),
		names: Cr("names", n, t)
	};
	let r = e.key("pattern"), i = r.exists ? r : e.key("names"), a = r.exists ? ni(r) : i.items(I).map((e) => e.text(L));
	if (!a.length) throw i.wrong("no cameras");
	let o = ti(a);
	if (o) throw i.wrong(o);
	return {
		count: a.length,
		names: a
	};
}
function ti(e) {
	return new Set(e).size === e.length ? e.some((e) => /[\u0000-\u001f\u007f-\u009f]/.test(e)) ? "control characters" : null : "a name stands twice";
}
function ni(e) {
	let [t = 0, n = 0] = e.key("counts").items(2).map((e) => e.integer(1, I));
	if (!n || t * n > 1e5) throw e.wrong("no counts of rows and columns");
	let r = e.key("parts").items(Wr).map((e) => {
		if (typeof e.raw == "string") return [0, Array(t).fill(e.text(L))];
		let r = e.key("axis").integer(0, 1), i = r ? n : t, a = e.key("texts");
		if (a.exists) {
			let e = a.items(i).map((e) => e.text(L));
			if (e.length !== i) throw a.wrong(`${i} texts are needed`);
			return [r, e];
		}
		let [o, s] = [e.key("first").integer(0, Kr), e.key("step").integer(0, Kr)], c = e.key("digits").integer(1, Gr);
		return [r, Array.from({ length: i }, (e, t) => String(o + s * t).padStart(c, "0"))];
	});
	return Array.from({ length: t * n }, (t, i) => {
		let a = [Math.floor(i / n), i % n], o = r.map(([e, t]) => t[a[e] ?? 0]).join("");
		if (o.length > 1024) throw e.wrong(`names of more than ${L} characters`);
		return o;
	});
}
function ri(e, t) {
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
function ii(e, t, n, r) {
	let i = e.key("coded");
	return i.exists ? Cr("cameras", i, r) : {
		intrinsics: n(e.key("intrinsics"), "SCALAR", [q], 5 * t),
		poses: n(e.key("poses"), "SCALAR", [q], 12 * t)
	};
}
function ai(e, t, n) {
	let r = e.key("size");
	if (!r.exists) return n(e.key("sizes"), "SCALAR", [gr], 2 * t);
	let [i = 0, a = 0] = r.numbers(2, 1, _e);
	if (!Number.isInteger(i) || !Number.isInteger(a)) throw r.wrong("no whole numbers");
	return [i, a];
}
function oi(e) {
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
function si(e) {
	return e.exists ? e.object() : {};
}
// eigenfield-three/src/info.ts
var ci = 1e-6;
async function li(e, t) {
	let [n, { lenses: r, poses: i }, a, o] = await Promise.all([
		ui(e, t),
		fi(e, t),
		pi(e, t),
		e.colour ? wr(e.colour, e.views, t) : null
	]);
	return n.map((t, n) => {
		let [s = 0, c = 0, l = 0, u = 0, d = 0] = r.numbers.subarray(5 * n, 5 * n + 5);
		if (!(s > ci && c > ci)) throw j(r.where, `focal lengths of "${t}"`);
		let { R: f, t: p } = mi([...i.numbers.subarray(12 * n, 12 * n + 12)], i.where, t), [m = 0, h = 0] = a.numbers.subarray(2 * n, 2 * n + 2);
		if (!m || !h || Math.max(m, h) > 65535 || m * h > ve) throw j(a.where, `"${t}" is ${m} x ${h} pixels`);
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
		], [_, v] = o ? hi([...o.subarray(6 * n, 6 * n + 6)], e, t) : [null, null];
		return {
			name: t,
			K: g,
			R: f,
			t: p,
			centre: Ei(f, p),
			width: m,
			height: h,
			gain: _,
			offset: v
		};
	});
}
async function ui({ names: e, heldOut: t }, n) {
	if (Array.isArray(e)) return e;
	let r = await e.codec.decode(new Uint8Array(await n(e.view)), t.length, e.where), i = r.some((e) => e.length > 1024) ? "names that are too long" : ti(r);
	if (i) throw j(e.where, i);
	return r;
}
async function di(e, t, n) {
	return {
		numbers: await wr(e, t.views, n),
		where: e.where
	};
}
async function fi(e, t) {
	let { calibration: n, heldOut: r } = e;
	if ("intrinsics" in n) {
		let { intrinsics: r, poses: i } = n;
		return {
			lenses: await di(r, e, t),
			poses: await di(i, e, t)
		};
	}
	let { view: i, codec: a, where: o } = n, s = await a.decode(new Uint8Array(await t(i)), o), c = s.poses.length / 12;
	if (c !== r.length) throw j(o, `${c} cameras in it, and ${r.length} names`);
	let l = (e) => ({
		numbers: Tr(e, o),
		where: o
	});
	return {
		lenses: l(s.intrinsics),
		poses: l(s.poses)
	};
}
async function pi(e, t) {
	if (!Array.isArray(e.sizes)) return di(e.sizes, e, t);
	let [n, r] = e.sizes;
	return {
		numbers: Uint32Array.from({ length: 2 * e.heldOut.length }, (e, t) => t % 2 ? r : n),
		where: "its cameras' size"
	};
}
function mi(e, t, n) {
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
		let a = Y(i[e], i[r]) - +(e === r);
		if (!(Math.abs(a) <= 2e-4)) throw j(t, `the pose of "${n}" is no rotation`);
	}
	if (!(Y(Di(i[0], i[1]), i[2]) > 0)) throw j(t, `the pose of "${n}" is mirrored`);
	return {
		R: i,
		t: a
	};
}
function hi(e, t, n) {
	let [r, i] = [e.slice(0, 3), e.slice(3)];
	if (!(r.every((e) => e >= 1 / 1e3 && e <= 1e3) && i.every((e) => Math.abs(e) <= 1e3))) throw j(t.colour?.where ?? "", `gain or offset of "${n}"`);
	return [r, i];
}
async function gi(e, t) {
	let n = vi(e), r = e.heldOut.filter((e) => !e).length, i = await Promise.all(n.map((n) => _i(n, r, e, t))), a = n.reduce((e, { count: t }) => e + t, 0), o = new Float32Array(r * a), s = 0;
	for (let e of i) {
		let t = e.length / r;
		for (let n = 0; n < r; n++) o.set(e.subarray(n * t, (n + 1) * t), n * a + s);
		s += t;
	}
	return o;
}
async function _i({ weights: e, count: t }, n, r, i) {
	if (!e) return /* @__PURE__ */ new Float32Array();
	if ("type" in e) return wr(e, r.views, i);
	let { view: a, codec: o, where: s } = e, { cameras: c, components: l, values: u } = o.decode(new Uint8Array(await i(a)), s);
	if (c === n && l === t) return Tr(u, s);
	throw j(s, `${c} x ${l} weights, and ${n} encoded cameras x ${t} textures`);
}
function vi(e) {
	return e.planes.flatMap(({ bases: e }) => e);
}
function yi(e) {
	return Math.max(0, ...vi(e).map(({ count: e }) => e));
}
function bi(e, t) {
	let n = [...t, ...vi(e).map(({ grid: e }) => e)];
	return [Math.max(...n.map(([e]) => e)), Math.max(...n.map(([, e]) => e))];
}
async function xi(e, t) {
	if (!e.triangles) return /* @__PURE__ */ new Uint32Array();
	let { where: n } = e.triangles, r = await Si(e.triangles, e, t), i = e.heldOut.filter((e) => !e).length;
	for (let e = 0; e < r.length; e += 3) {
		let [t = i, a = i, o = i] = r.subarray(e, e + 3);
		if (Math.max(t, a, o) >= i) throw j(n, `no encoded camera ${Math.max(t, a, o)}`);
		if (t === a || a === o || o === t) throw j(n, "a triangle with one camera twice");
	}
	return r;
}
async function Si(e, t, n) {
	return "type" in e ? Uint32Array.from(await wr(e, t.views, n)) : e.codec.decode(new Uint8Array(await n(e.view)), e.where).corners;
}
function Ci(e, t, n, r, i, a) {
	let { right: o, up: s } = e, c = Di(o, s), l = [
		0,
		0,
		0
	];
	for (let { R: e } of t) for (let n = 0; n < 3; n++) l[n] += e[2][n] / t.length;
	let u = e.settings.metresPerUnit;
	return {
		version: e.version,
		generator: e.generator,
		names: t.map(({ name: e }) => e),
		heldOut: e.heldOut,
		reference: e.reference,
		cameras: t,
		viewPlane: {
			origin: e.origin,
			right: o,
			up: s,
			normal: c,
			extent: e.extent
		},
		grid: r && {
			rows: r.rows,
			columns: r.columns
		},
		settings: e.settings,
		scores: e.scores,
		metresPerUnit: typeof u == "number" && u > 0 && u <= 1e30 ? u : null,
		bytes: wi(e, i),
		size: bi(e, n),
		planes: e.planes.map(({ channels: e, bases: t }, r) => ({
			channels: e,
			mean: n[r] ?? [1, 1],
			bases: t.map(({ count: e, size: t, grid: n }) => ({
				textures: e,
				size: t,
				grid: n
			}))
		})),
		...a,
		facesPlane: Math.abs(Y(l, c)) > .7
	};
}
function wi(e, t) {
	let n = /* @__PURE__ */ new Set(), r = (t) => n.has(t) ? 0 : (n.add(t), e.views[t]?.length ?? 0), i = (e) => e.reduce((e, t) => e + r(t), 0), a = e.planes.flatMap(({ mean: e, precision: t }) => [e.view, ...t ? [t.view] : []]), o = i(e.preview === null ? a : [e.preview, ...a]), s = Array(yi(e)).fill(0);
	for (let { pictures: t } of vi(e)) {
		let e = 0;
		for (let { view: n, textures: i } of t) {
			let t = r(n);
			for (let n = 0; n < i; n++) {
				let r = Math.floor(t * (n + 1) / i) - Math.floor(t * n / i);
				s[e] = (s[e++] ?? 0) + r;
			}
		}
	}
	let c = i(vi(e).flatMap((e) => e.weights ? [e.weights.view] : [])), { position: l, uv: u, indices: d } = e, f = i([
		l,
		u,
		d,
		...e.mesh ? [e.mesh] : []
	].map(({ view: e }) => e));
	return {
		total: t,
		mesh: f,
		mean: o,
		weights: c,
		other: t - o - c - f - s.reduce((e, t) => e + t, 0),
		textures: s
	};
}
function Ti(e, t) {
	let { origin: n, extent: r } = e, i = [
		t[0] - n[0],
		t[1] - n[1],
		t[2] - n[2]
	];
	return [r[0] > 0 ? Y(i, e.right) / r[0] : 0, r[1] > 0 ? Y(i, e.up) / r[1] : 0];
}
function Ei(e, t) {
	let n = (n) => -(e[0][n] * t[0] + e[1][n] * t[1] + e[2][n] * t[2]);
	return [
		n(0),
		n(1),
		n(2)
	];
}
function Y(e, t) {
	return e[0] * t[0] + e[1] * t[1] + e[2] * t[2];
}
function Di(e, t) {
	return [
		e[1] * t[2] - e[2] * t[1],
		e[2] * t[0] - e[0] * t[2],
		e[0] * t[1] - e[1] * t[0]
	];
}
// eigenfield-three/src/cameras.ts
function Oi(e, t, n) {
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
		let r = ki(n, o, s);
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
	let u = ji(l), { origin: d, right: f, up: p, extent: m } = r.viewPlane, [h, g] = [Ai(t) * m[0], Ai(n) * m[1]], _ = [
		0,
		1,
		2
	].map((e) => d[e] + h * f[e] + g * p[e]), v = u.map((e) => -Y(e, _));
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
function ki({ K: e, width: t, height: n }, r, i) {
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
function Ai(e) {
	return Math.min(1, Math.max(-1, e));
}
function ji(e) {
	let t = e;
	for (let e = 0; e < 50; e++) {
		let e = [
			Di(t[1], t[2]),
			Di(t[2], t[0]),
			Di(t[0], t[1])
		], n = Y(t[0], e[0]);
		if (!(n > 1e-12)) break;
		let r = t.map((t, r) => t.map((t, i) => (t + e[r][i] / n) / 2)), i = Math.max(...r.flatMap((e, n) => e.map((e, r) => Math.abs(e - t[n][r]))));
		if (t = r, i < 1e-15) break;
	}
	return t;
}
function Mi(e, t, n, r, i = 1) {
	let a = n.width / n.height, o = i * Math.min(1, a / r), s = i * Math.min(1, r / a), c = {
		left: (1 - o) / 2,
		top: (1 - s) / 2,
		width: o,
		height: s
	};
	return Ni(e, t, n), Pi(e, t, n, c), t.aspect = r, t.fov = 2 * Math.atan(n.height / (2 * n.K[1][1] * s)) * 180 / Math.PI, c;
}
function Ni(e, t, n) {
	let { R: r, centre: i } = n, a = new _().set(r[0][0], -r[1][0], -r[2][0], i[0], r[0][1], -r[1][1], -r[2][1], i[1], r[0][2], -r[1][2], -r[2][2], i[2], 0, 0, 0, 1);
	e.mesh.updateWorldMatrix(!0, !1), a.premultiply(e.mesh.matrixWorld), t.parent && (t.parent.updateWorldMatrix(!0, !1), a.premultiply(t.parent.matrixWorld.clone().invert())), a.decompose(t.position, t.quaternion, new O()), t.updateMatrixWorld(!0);
}
function Pi(e, t, n, r) {
	let [[i, a, o], [, s, c]] = n.K, [l, u] = [2 * r.width / n.width, 2 * r.height / n.height], [d, f] = Fi(e, n);
	t.near = d, t.far = f, t.projectionMatrix.set(l * i, -l * a, -(2 * r.left - 1 + l * o), 0, 0, u * s, -(1 - 2 * r.top - u * c), 0, 0, 0, -(f + d) / (f - d), -2 * f * d / (f - d), 0, 0, -1, 0), t.projectionMatrixInverse.copy(t.projectionMatrix).invert();
}
function Fi(e, t) {
	let { geometry: n, matrixWorld: r } = e.mesh;
	n.boundingSphere || n.computeBoundingSphere();
	let { center: i, radius: a } = n.boundingSphere ?? {
		center: new O(),
		radius: 1
	}, o = r.getMaxScaleOnAxis(), s = i.distanceTo(new O(...t.centre)) * o, c = 1.01 * (s + a * o);
	return [Math.max(.5 * (s - a * o), c * 2e-4), c];
}
// eigenfield-three/src/footprint.ts
var Ii = 256;
function Li(e, t, n) {
	let { index: r } = e, i = e.getAttribute("position"), a = e.getAttribute("uv");
	if (!r || !i || !a) return 0;
	let o = r.count / 3, s = Math.max(1, Math.floor(o / Ii)), c = [];
	for (let e = 0; e < o; e += s) {
		let o = [
			0,
			1,
			2
		].map((t) => r.getX(3 * e + t)), s = o.map((e) => Ri(t, i.getX(e), i.getY(e), i.getZ(e))), l = zi(s), [u = NaN, d = NaN] = [0, 1].map((e) => s.reduce((t, n) => t + (n[e] ?? NaN) / 3, 0));
		if (!(l > 0 && u >= 0 && d >= 0 && u < t.width && d < t.height)) continue;
		let f = zi(o.map((e) => [a.getX(e) * n[0], a.getY(e) * n[1]]));
		c.push({
			footprint: Math.sqrt(f / l),
			area: l
		});
	}
	c.sort((e, t) => e.footprint - t.footprint);
	let l = c.reduce((e, { area: t }) => e + t, 0) / 2, u = 0;
	return c.find(({ area: e }) => (u += e) >= l)?.footprint ?? 0;
}
function Ri({ K: e, R: t, t: n }, r, i, a) {
	let o = (e) => t[e][0] * r + t[e][1] * i + t[e][2] * a + n[e], [s, c, l] = [
		o(0),
		o(1),
		o(2)
	];
	return l > 0 ? [(e[0][0] * s + e[0][1] * c) / l + e[0][2], e[1][1] * c / l + e[1][2]] : [NaN, NaN];
}
function zi(e) {
	let [[t = 0, n = 0] = [], [r = 0, i = 0] = [], [a = 0, o = 0] = []] = e;
	return Math.abs((r - t) * (o - n) - (i - n) * (a - t)) / 2;
}
// eigenfield-three/src/memory.ts
var Bi = 4 / 3, Vi = 4, Hi = 8, Ui = 2, Wi = 2 ** 20;
function Gi() {
	let e = typeof navigator > "u" ? void 0 : navigator, t = e?.deviceMemory, n = e?.userAgent ?? "";
	return /Mobi|Android|iPhone|iPad|Quest/i.test(n) || /Macintosh/.test(n) && Ki(e) ? Math.min(t ?? 4, 6) * 128 * Wi : Math.min(t ?? 8, 8) * 256 * Wi;
}
function Ki(e) {
	return (e?.maxTouchPoints ?? 0) > 1;
}
function qi([e, t], n) {
	return [Math.ceil(e / n), Math.ceil(t / n)];
}
function Ji(e, t) {
	let [n, r] = qi(e, t);
	return n * r;
}
function Yi(e) {
	return Math.ceil(e / 4);
}
function Xi(e, t) {
	return t * Zi(e);
}
function Zi(e) {
	return Math.max(1, Math.ceil(e / 4));
}
function Qi(e) {
	let { atlas: t, means: n, bases: r } = e, i = [
		t,
		...n.map(({ size: e }) => e),
		...r.map(({ grid: e }) => e)
	];
	return [...new Map(i.map((e) => [e.join(), e])).values()];
}
function $i(e, t) {
	let n = Math.max(0, ...e.bases.map(({ count: e }) => e)), r = Math.max(1, ...e.bases.map((e) => e.channels)), i = Math.min(n, 4 * Math.floor(t.layers / r)), a = [
		1,
		2,
		4,
		8,
		16
	].find((n) => Math.max(...e.atlas) / n <= t.side && ea(e, n) <= t.memory / 2) ?? 16, o = ea(e, a) + e.geometry, s = (t, n) => o + na(e, t, n), c = (n, r) => s(n, r) + aa(e, n) <= t.memory, l = Math.max(1, ...e.bases.flatMap(({ size: e }) => e)), u = (e) => l / e <= t.side, d = [
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
		limitation: oa(p, n, e, t)
	};
}
function ea(e, t) {
	let n = e.means.map((e) => ta(e) * Yi(e.channels) * Ji(e.size, t)), r = Qi(e).map((n) => {
		let r = n.join() === e.atlas.join() ? Bi : 1, i = e.rays && e.bases.some(({ grid: e }) => e.join() === n.join());
		return Hi * Ji(n, t) * (r + +!!i);
	});
	return Math.round([...n, ...r].reduce((e, t) => e + t, 0));
}
function ta({ tenBits: e }) {
	return e ? Hi : Vi;
}
function na({ bases: e, rays: t }, n, r) {
	return e.reduce((e, i) => {
		let a = Math.min(r, i.count);
		if (!a) return e;
		let o = t ? Zi(a) * 129 * 129 * Hi : 0;
		return e + ta(i) * Xi(a, i.channels) * Ji(i.size, n) + o;
	}, 0);
}
function ra({ means: e, bases: t }, n, r) {
	return ia([...e.filter(({ pieces: e, tenBits: t }) => e > 1 || t).map(({ size: e }) => qi(e, n)), ...t.filter(({ count: e }) => e > 0).map(({ size: e }) => qi(e, r))]);
}
function ia(e) {
	return [Math.max(1, ...e.map(([e]) => e)), Math.max(1, ...e.map(([, e]) => e))];
}
function aa(e, t) {
	let [n, r] = ra({
		means: [],
		bases: e.bases
	}, 1, t);
	return (Vi + (e.bases.some(({ tenBits: e }) => e) ? Ui : 0)) * n * r;
}
function oa(e, t, n, r) {
	let i = [];
	if (e.usable < t && i.push(`${e.usable} of ${t} eigen textures are drawn`), e.usable && e.scaleDown > 1 && i.push(`eigen textures have 1/${e.scaleDown} of their size`), e.meanDown > 1 && i.push(`the mean texture has 1/${e.meanDown} of its size`), !i.length) return null;
	let a = ea(n, 1) + na(n, 1, t) + aa(n, 1) + n.geometry, o = a > r.memory ? `the scene needs ${sa(a)} MB of graphics memory and ${sa(r.memory)} MB may be used` : "this device's graphics allow no more";
	return `${ca(i.join(", "))}: ${o}.`;
}
function sa(e) {
	return (e / 1e6).toFixed(+(e < 1e7));
}
function ca(e) {
	return e.charAt(0).toUpperCase() + e.slice(1);
}
// ../src/eigenfield/rendering/shaders/compose.glsl?raw
var la = "// Equations 7 and 8, texel by texel: means and eigen textures, weighted and summed into one texture of the whole atlas,\n// which surface.glsl then draws (decision 15).\n//\n// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl/composer.py and as GLSL ES 3.00 by the web viewer. Whoever\n// includes it writes the #version line, the precisions, cubic.glsl before it, and a main for each of three passes. All\n// draw into textures whose row 0 is v = 0, and the second and third add to what is there:\n//   placeOf       once, the mesh laid out by its texture coordinates: where each texel lies\n//   sumTextures   for each mean and basis, a rectangle of a grid: its textures, weighted, as R, G, B\n//   finerValue    for each grid coarser than the atlas, all of the atlas: what the grid holds there\n// Four numbers share a texel of what is stored: one channel of four eigen textures (decision 13), or four channels of a\n// mean. Colours are the photographs' own (sRGB-coded) numbers from end to end: no conversion, in or out.\n\n#define LAYERS 64  // most that one draw sums\n#define LEVEL 1e-4 // a height of no more than this is as good as none\n#define MOST 6e4   // halves end at 65504\n\nuniform sampler2DArray stored; // codes / 255, or values; anything finite where there is no texture (yet)\nuniform int firstLayer;\nuniform int sharing;           // 1: each of `entries` has a layer; 4: four channels of a mean share one\nuniform int channels;\nuniform int entries;           // entry e is channel e % channels, of group e / channels; at most LAYERS\nuniform vec4 scale[LAYERS];    // value = stored * scale + bias, of each entry: 0 for textures that are not summed\nuniform vec4 bias[LAYERS];\nuniform vec3 colours[LAYERS];  // R, G, B of the value 1 of each channel\n\nuniform bool rayWeights;       // look weights up where the ray to the eye meets the view plane; else they are in `scale`\nuniform sampler2DArray weightMaps; // layer g: weights 4 g .. 4 g + 3 over X, Y in -1..1, nodes on the edges\nuniform int firstGroup;\nuniform sampler2D places;      // of each texel that is drawn, as `placeOf` makes them; w is 0 where there is no surface\nuniform vec3 eye;              // X, Y and height above the view plane\n\nuniform sampler2D coarse;      // a grid's sum\n\n// A point of the surface, given as X, Y and height above the view plane, as it is seen from the plane: X, Y and 1 over\n// the height. Halves keep that well enough for points near and far.\nvec4 placeOf(vec3 point) {\n  float height = point.z < 0.0 ? min(point.z, -LEVEL) : max(point.z, LEVEL);\n  return vec4(clamp(vec3(point.xy, 1.0) / height, -MOST, MOST), 1.0);\n}\n\n// Where the ray from a point of the surface to the eye meets the view plane, as X, Y; where it does not (the eye is\n// level with the point, or the point lies behind the cameras) and where there is no surface, where the eye itself stands.\nvec2 viewCoordinates(vec4 place) {\n  float part = 1.0 - eye.z * place.z;\n  bool meets = place.w > 0.0 && part > 1e-5;\n  return clamp(meets ? (eye.xy - eye.z * place.xy) / part : eye.xy, -1.0, 1.0);\n}\n\n// The sum of a mean's or a basis's textures at `own` texture coordinates of theirs, as R, G, B.\nvec3 sumTextures(vec2 own) {\n  vec2 nodes = vec2(textureSize(weightMaps, 0).xy);\n  vec2 view = rayWeights ? viewCoordinates(texelFetch(places, ivec2(gl_FragCoord.xy), 0)) : vec2(0.0);\n  vec2 at = (0.5 + (0.5 + 0.5 * view) * (nodes - 1.0)) / nodes;\n  vec4 weights = vec4(1.0);\n  vec3 sum = vec3(0.0);\n  int entry = 0;\n  for (int group = firstGroup; entry < entries; group++) {\n    if (rayWeights) weights = textureLod(weightMaps, vec3(at, float(group)), 0.0);\n    for (int channel = 0; channel < channels; channel++) {\n      vec4 four = textureLod(stored, vec3(own, float(firstLayer + entry / sharing)), 0.0) * scale[entry] + bias[entry];\n      sum += colours[channel] * dot(weights, four);\n      entry++;\n    }\n  }\n  return sum;\n}\n\n// The value of the grid `coarse` at texture coordinates of the atlas.\nvec3 finerValue(vec2 uv) { return readCubic(coarse, uv * vec2(textureSize(coarse, 0)) - 0.5); }\n", ua = "// Weights of the texels -1, 0, 1 and 2 for a place between texels 0 and 1: Catmull-Rom, a = -1/2.\nvec4 catmullRom(float f) {\n  float f2 = f * f, f3 = f2 * f;\n  return 0.5 * vec4(2.0 * f2 - f3 - f, 3.0 * f3 - 5.0 * f2 + 2.0, 4.0 * f2 - 3.0 * f3 + f, f3 - f2);\n}\n\n// A texture's finest level at `texel`, whole at texel centres, taps clamped to the border. Sixteen texels are read one\n// by one: nine bilinear reads between them take longer where no hardware filters, and hardware keeps 8 bits of a weight.\nvec3 readCubic(sampler2D source, vec2 texel) {\n  ivec2 last = textureSize(source, 0) - 1;\n  ivec2 base = ivec2(floor(texel));\n  vec2 f = texel - vec2(base);\n  vec4 across = catmullRom(f.x), down = catmullRom(f.y);\n  vec3 sum = vec3(0.0);\n  for (int row = 0; row < 4; row++) {\n    vec3 line = vec3(0.0);\n    for (int column = 0; column < 4; column++) {\n      ivec2 at = clamp(base + ivec2(column, row) - 1, ivec2(0), last);\n      line += across[column] * texelFetch(source, at, 0).rgb;\n    }\n    sum += down[row] * line;\n  }\n  return sum;\n}\n", da = 2, fa = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
${ua}${la}`, pa = "\nprecision highp float;\nuniform vec4 rectangle; // of the target: left, top, right, bottom in 0..1\nin vec3 position;\nout vec2 own;\nvoid main() {\n  own = position.xy;\n  gl_Position = vec4(2.0 * mix(rectangle.xy, rectangle.zw, position.xy) - 1.0, 0.0, 1.0);\n}\n", ma = "\nprecision highp float;\nuniform vec2 texel;     // of the target, in clip space\nuniform vec2 shifts[SHIFTS];\nin vec2 position;       // texture coordinates\nin vec3 onPlane;\nout vec3 point;\nvoid main() {\n  point = onPlane;\n  gl_Position = vec4(2.0 * position - 1.0 + texel * shifts[gl_InstanceID], 0.0, 1.0);\n}\n", ha = `${fa}
in vec3 point;
out vec4 place;
void main() { place = placeOf(point); }
`, ga = "sumTextures", _a = "finerValue";
function va(n, r, i) {
	let o = new w({
		glslVersion: f,
		vertexShader: pa,
		fragmentShader: `${fa}in vec2 own;\nout vec4 colour;\nvoid main() { colour = vec4(${n}(own), 1.0); }\n`,
		uniforms: {
			rectangle: { value: new ee(...r) },
			...i
		},
		side: c,
		blending: a,
		blendSrc: S,
		blendDst: S,
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
	]), s.boundingSphere = new E();
	let l = new v(s, o);
	return l.frustumCulled = !1, l;
}
function ya([e, t], n) {
	return new k(e, t, {
		type: p,
		depthBuffer: !1,
		generateMipmaps: n,
		minFilter: n ? g : b,
		magFilter: n ? h : b
	});
}
function ba(e, t) {
	let n = Di(e.right, e.up), r = [
		t[0] - e.origin[0],
		t[1] - e.origin[1],
		t[2] - e.origin[2]
	];
	return [...Ti(e, t), Y(r, n) / (Math.max(...e.extent) || 1)];
}
function xa(t, n, r) {
	let i = t.geometry.getAttribute("position"), a = t.geometry.getAttribute("uv"), o = new Float32Array(3 * i.count), s = new Float32Array(2 * i.count);
	for (let e = 0; e < i.count; e++) o.set(ba(n, [
		i.getX(e),
		i.getY(e),
		i.getZ(e)
	]), 3 * e), s.set([a.getX(e), a.getY(e)], 2 * e);
	let l = Array.from({ length: 5 }, (e, t) => t - da), u = l.flatMap((e) => l.map((t) => new D(t, e)));
	u.sort((e, t) => t.lengthSq() - e.lengthSq());
	let d = new m();
	d.setAttribute("position", new e(s, 2)), d.setAttribute("onPlane", new e(o, 3)), d.setIndex(t.geometry.index ? new e(t.geometry.index.array, 1) : null), d.instanceCount = u.length, d.boundingSphere = new E();
	let p = new w({
		glslVersion: f,
		vertexShader: ma.replace("SHIFTS", String(u.length)),
		fragmentShader: ha,
		uniforms: {
			texel: { value: new D(2 / r.width, 2 / r.height) },
			shifts: { value: u }
		},
		side: c,
		blending: x,
		depthTest: !1,
		depthWrite: !1
	}), h = new v(d, p);
	h.frustumCulled = !1;
	let g = new T();
	return g.add(h), {
		scene: g,
		free: () => {
			d.dispose(), p.dispose();
		}
	};
}
// eigenfield-three/src/composer.ts
var Sa = class {
	mesh;
	plane;
	grids;
	composed = null;
	camera = new n();
	constructor(e, t, n, r, i) {
		this.mesh = r, this.plane = i;
		let [a, ...o] = Qi({
			atlas: e,
			means: t.filter(({ basis: e }) => !e).map(({ grid: e }) => ({ size: e })),
			bases: t.filter(({ basis: e }) => e)
		}), s = (e, r) => {
			let i = t.filter(({ grid: t }) => t.join() === e.join()).flatMap(Ca), a = new T();
			return i.forEach(({ quad: e }, t) => a.add(Object.assign(e, { renderOrder: t }))), {
				target: ya(qi(e, n), r),
				scene: a,
				steps: i,
				places: null
			};
		}, c = s(a ?? e, !0);
		this.grids = o.map((e) => s(e, !1));
		for (let { target: e } of this.grids) {
			let t = va(_a, [
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
		this.composed && Ea(this.composed, n) || (this.composed = n, ka(e, t, () => {
			for (let t of this.grids) {
				n.eye && !t.places && t.steps.some(({ part: e }) => e.basis) && this.findPlaces(e, t);
				for (let e of t.steps) wa(e, t, n);
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
		t.places = ya([t.target.width, t.target.height], !1);
		let { scene: n, free: r } = xa(this.mesh, this.plane, t.places);
		this.draw(e, n, t.places), r();
	}
	draw(e, t, n) {
		e.setRenderTarget(n), e.state.buffers.color.setMask(!0), e.clear(!0, !1, !1), e.render(t, this.camera);
	}
};
function Ca(e) {
	let t = e.colours.length, [n, r] = [e.scale.length / (4 * t), Math.floor(64 / t)], i = [];
	for (let a = 0; a < n; a += r) {
		let o = Array.from({ length: 64 }, (t, n) => new O(...e.colours[n] ?? [
			0,
			0,
			0
		])), s = e.basis ? 1 : 4, c = va(ga, e.rectangle, {
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
			eye: { value: new O() }
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
function wa({ part: e, first: t, groups: n, quad: r }, { places: i }, a) {
	let { basis: o, colours: s } = e, { uniforms: c } = r.material, l = (e, t) => {
		let n = c[e];
		n && (n.value = t);
	}, u = o !== null && a.eye !== null && a.only === null, d = Array.from({ length: 4 * n }, (e, n) => Ta(o, 4 * t + n, a, u)), f = Math.ceil((d.findLastIndex((e) => e !== 0) + 1) / 4), [p, m] = [c.scale?.value, c.bias?.value], h = s.length;
	for (let n = 0; n < 4 * h * f; n++) {
		let r = d[4 * Math.floor(n / (4 * h)) + n % 4] ?? 0;
		p[n] = r * (e.scale[4 * h * t + n] ?? 0), m[n] = r * (e.bias[4 * h * t + n] ?? 0);
	}
	l("entries", h * f), l("rayWeights", u), l("weightMaps", u ? a.maps : null), l("places", u ? i?.texture ?? null : null), a.eye && (c.eye?.value).set(...a.eye), r.visible = f > 0, r.material.uniformsNeedUpdate = !0;
}
function Ta(e, t, n, r) {
	return e ? e.ready[t] ? n.only === null ? t >= n.count ? 0 : r ? 1 : n.weights[e.column + t] ?? 0 : +(t === n.only) : 0 : +!!n.mean;
}
function Ea(e, t) {
	let { weights: n, eye: r, ...i } = e;
	return !Object.entries(i).every(([e, n]) => t[e] === n) || r === null != (t.eye === null) ? !1 : e.only === null ? r ? r.every((e, n) => e === t.eye?.[n]) : n.every((e, n) => e === t.weights[n]) : !0;
}
var Da = new i(0), Oa = new i();
function ka(e, t, n) {
	let r = e.getRenderTarget(), [i, a] = [e.getActiveCubeFace(), e.getActiveMipmapLevel()], { autoClear: o, info: s } = e, [c, l, u] = [
		e.xr.enabled,
		e.shadowMap.autoUpdate,
		e.getClearAlpha()
	], [d, f] = [s.render.frame, s.autoReset];
	e.getClearColor(Oa), e.setClearColor(Da, 0), e.autoClear = e.xr.enabled = e.shadowMap.autoUpdate = s.autoReset = !1, n(), s.render.frame = d, Object.assign(s, { autoReset: f }), Object.assign(e, { autoClear: o }), e.xr.enabled = c, e.shadowMap.autoUpdate = l, e.setClearColor(Oa, u), e.setRenderTarget(r, i, a);
	let { viewport: p } = t;
	p && e.state.viewport(p);
}
// eigenfield-three/src/maps.ts
function Aa(e, t, n, i, a) {
	let c = i.reduce((e, t) => e + t, 0), l = [], [u, d] = [0, 0];
	for (let e of i) {
		let t = Math.min(e, a);
		for (let e = 0; e < t; e++) l.push([u + e, 4 * d + e]);
		u += e, d += t ? Zi(t) : 0;
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
	return m.format = C, m.type = p, m.minFilter = m.magFilter = h, m.wrapS = m.wrapT = r, m.needsUpdate = !0, m;
}
// ../src/eigenfield/rendering/shaders/surface.glsl?raw
var ja = "// The composed texture (compose.glsl) on the surface of the proxy.\n//\n// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl/renderer.py and as GLSL ES 3.00 by the web viewer. Whoever\n// includes it writes the #version line, the precisions, cubic.glsl before it, and\n//   BICUBIC   how the finest level is read: 0 bilinear, 1 Catmull-Rom\n// Pixels of more than `finest` texels are left to the sampler and its mip maps.\n\nuniform sampler2D composed;\nuniform float finest;       // texels a pixel up to which the finest level is read: 1.5 times those a pixel of the\n                            // photographs covers, which holds no more than its own average\nuniform vec3 exposureScale; // picture = RGB * exposureScale + exposureBias: 1 / gain and -offset / gain of a captured\nuniform vec3 exposureBias;  // camera of a harmonised scene, else 1 and 0\n\n// R, G, B at texture coordinates; nothing is cut off.\nvec3 surfaceValue(vec2 uv) {\n  vec3 plain = texture(composed, uv, -log2(finest)).rgb;\n#if BICUBIC == 1\n  vec2 size = vec2(textureSize(composed, 0));\n  vec2 across = dFdx(uv) * size, down = dFdy(uv) * size;\n  bool fine = max(dot(across, across), dot(down, down)) <= finest * finest;\n  if (fine) return readCubic(composed, clamp(uv * size, vec2(0.5), size - 0.5) - 0.5);\n#endif\n  return plain;\n}\n\n// What the surface shows at texture coordinates.\nvec3 surfaceColour(vec2 uv) {\n  return clamp(surfaceValue(uv) * exposureScale + exposureBias, 0.0, 1.0);\n}\n", Ma = {
	bilinear: 0,
	bicubic: 1
}, Na = {
	picture: 0,
	mean: 1,
	eigen: 2,
	error: 3
}, Pa = "\nprecision highp float;\nuniform mat4 modelViewMatrix;\nuniform mat4 projectionMatrix;\nin vec3 position;\nin vec2 uv;\nout vec2 surfaceUv;\nout vec3 surfacePlace;\nvoid main() {\n  surfaceUv = uv;\n  surfacePlace = position;\n  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));\n}\n", Fa = `
precision highp float;
precision highp int;
precision highp sampler2D;
${ua}${ja}
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
function Ia(e) {
	let t = {
		composed: { value: null },
		finest: { value: 1 },
		exposureScale: { value: new O(1, 1, 1) },
		exposureBias: { value: new O() },
		shown: { value: Na.picture },
		shownGain: { value: 1 },
		photograph: { value: null },
		toPhotograph: { value: new _() }
	}, n = new w({
		glslVersion: f,
		vertexShader: Pa,
		fragmentShader: Fa,
		uniforms: t,
		defines: { BICUBIC: Ma.bicubic },
		side: e ? c : d
	});
	return n.name = "eigen textures", n;
}
// eigenfield-three/src/gpu.ts
function La(e, t) {
	return {
		side: e.getParameter(e.MAX_TEXTURE_SIZE),
		layers: e.getParameter(e.MAX_ARRAY_TEXTURE_LAYERS),
		memory: t
	};
}
function Ra(e, [t, n], r, i, a) {
	return Va(e, e.TEXTURE_2D_ARRAY, () => {
		e.texStorage3D(e.TEXTURE_2D_ARRAY, 1, a ? e.RGBA16F : e.RGBA8, t, n, r);
		for (let t of [e.TEXTURE_WRAP_S, e.TEXTURE_WRAP_T]) e.texParameteri(e.TEXTURE_2D_ARRAY, t, e.CLAMP_TO_EDGE);
		for (let t of [e.TEXTURE_MIN_FILTER, e.TEXTURE_MAG_FILTER]) e.texParameteri(e.TEXTURE_2D_ARRAY, t, i ? e.LINEAR : e.NEAREST);
	});
}
function za(e, t, n) {
	let { width: r, height: i } = n;
	Ha(e, e.TEXTURE_2D_ARRAY, t, () => e.texSubImage3D(e.TEXTURE_2D_ARRAY, 0, 0, 0, 0, r, i, 1, e.RGBA, e.UNSIGNED_BYTE, n));
}
function Ba(e, [t, n], r = !1) {
	return Va(e, e.TEXTURE_2D, () => {
		e.texStorage2D(e.TEXTURE_2D, 1, r ? e.RG8 : e.RGBA8, t, n), e.texParameteri(e.TEXTURE_2D, e.TEXTURE_MIN_FILTER, e.NEAREST);
	});
}
function Va(e, t, n) {
	for (; e.getError() !== e.NO_ERROR && !e.isContextLost(););
	let r = e.createTexture();
	return Ha(e, t, r, n), e.getError() === e.OUT_OF_MEMORY ? (e.deleteTexture(r), null) : r;
}
function Ha(e, t, n, r) {
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
var Ua = "#version 300 es\nvoid main() {\n  gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);\n}\n", Wa = "#version 300 es\nprecision highp float;\nuniform highp sampler2D picture;\nuniform vec4 factors;\nuniform vec2 size; // of what is drawn\nuniform highp sampler2D precisions;\nuniform ivec2 nodes; // columns and rows of it that are used; 0: codes are stored as they are\nuniform float zero;\nout vec4 stored;\nfloat nodeAt(ivec2 at) {\n  return texelFetch(precisions, clamp(at, ivec2(0), nodes - 1), 0).r;\n}\nfloat precisionAt(vec2 uv) {\n  vec2 at = uv * vec2(nodes) - 0.5;\n  ivec2 low = ivec2(floor(at));\n  vec2 part = at - vec2(low);\n  float upper = mix(nodeAt(low), nodeAt(low + ivec2(1, 0)), part.x);\n  float lower = mix(nodeAt(low + ivec2(0, 1)), nodeAt(low + ivec2(1, 1)), part.x);\n  return (255.0 * mix(upper, lower, part.y) + 1.0) / 256.0;\n}\nvoid main() {\n  float code = dot(texelFetch(picture, ivec2(gl_FragCoord.xy), 0), factors);\n  if (nodes.x == 0) stored = vec4(code);\n  else stored = vec4(clamp((code - zero) / precisionAt(gl_FragCoord.xy / size) / 4.0, -65504.0, 65504.0));\n}\n";
function Ga(e, t) {
	let n = Ya(e), [r, i] = [e.createFramebuffer(), e.createVertexArray()], [a, o, s, c, l] = [
		"factors",
		"size",
		"precisions",
		"nodes",
		"zero"
	].map((t) => e.getUniformLocation(n, t)), u = ({ picture: t, rows: u }, d, f, p, m) => {
		e.useProgram(n), e.uniform2f(o ?? null, t.width, u), e.uniform1i(s ?? null, +!!m), e.uniform2i(c ?? null, m?.precision.width ?? 0, m?.precision.height ?? 0), e.uniform1f(l ?? null, m?.zero ?? 0), e.bindVertexArray(i), e.bindFramebuffer(e.DRAW_FRAMEBUFFER, r), e.viewport(0, 0, t.width, u);
		for (let { channel: n, layer: r, component: i } of f) e.colorMask(i === 0, i === 1, i === 2, i === 3), e.framebufferTextureLayer(e.DRAW_FRAMEBUFFER, e.COLOR_ATTACHMENT0, d, 0, r), Ka(t) ? e.uniform4f(a ?? null, 255, 65280, 0, 0) : e.uniform4fv(a ?? null, [
			0,
			1,
			2,
			3
		].map((e) => e === n ? p : 0)), e.drawArrays(e.TRIANGLES, 0, 3);
	};
	return {
		put(n, r, i, a, o = null) {
			let { picture: s, row: c, rows: l } = n, d = Ka(s) ? t.codes : t.picture;
			if (!d) return;
			let f = () => Xa(e, 0, d, () => {
				Ka(s) ? Ja(e, s, c, l) : qa(e, s, c, l), Za(e, () => u(n, r, i, a, o));
			});
			o ? Xa(e, 1, t.precision, () => {
				qa(e, o.precision, 0, o.precision.height), f();
			}) : f();
		},
		free() {
			e.deleteTexture(t.picture), e.deleteTexture(t.codes), e.deleteTexture(t.precision), e.deleteVertexArray(i), e.deleteFramebuffer(r), e.deleteProgram(n);
		}
	};
}
function Ka(e) {
	return "data" in e;
}
function qa(e, t, n, r) {
	e.pixelStorei(e.UNPACK_SKIP_ROWS, n), e.texSubImage2D(e.TEXTURE_2D, 0, 0, 0, t.width, r, e.RGBA, e.UNSIGNED_BYTE, t);
}
function Ja(e, { data: t, width: n, stride: r }, i, a) {
	e.pixelStorei(e.UNPACK_ALIGNMENT, 1), e.pixelStorei(e.UNPACK_ROW_LENGTH, r / 2), e.texSubImage2D(e.TEXTURE_2D, 0, 0, 0, n, a, e.RG, e.UNSIGNED_BYTE, t, i * r);
}
function Ya(e) {
	let t = e.createProgram();
	for (let [n, r] of [[e.VERTEX_SHADER, Ua], [e.FRAGMENT_SHADER, Wa]]) {
		let i = e.createShader(n);
		i && (e.shaderSource(i, r), e.compileShader(i), e.attachShader(t, i), e.deleteShader(i));
	}
	return e.linkProgram(t), t;
}
function Xa(e, t, n, r) {
	let i = e.getParameter(e.ACTIVE_TEXTURE);
	e.activeTexture(e.TEXTURE0 + t);
	let a = e.getParameter(e.SAMPLER_BINDING);
	e.bindSampler(t, null), Ha(e, e.TEXTURE_2D, n, r), e.bindSampler(t, a), e.activeTexture(i);
}
function Za(e, t) {
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
// eigenfield-three/src/parts.ts
function Qa(e, t, n) {
	let r = [], [i, a, o, s] = [
		0,
		0,
		0,
		0
	];
	return e.planes.forEach((c, l) => {
		let { channels: u, bases: d } = c, f = e.colours.slice(i, i + u);
		i += u;
		let p = t.needs.means[l]?.size ?? [1, 1], m = t.means[l], h = $a(c);
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
		for (let { size: e, grid: i, corner: c, pictures: l, count: p } of d) {
			let d = t.bases[a], m = t.ready[a++] ?? [], h = Math.min(p, n.usable);
			if (h && d) {
				let [t, n] = [c[0] / i[0], c[1] / i[1]];
				r.push({
					stored: d,
					grid: i,
					rectangle: [
						t,
						n,
						t + e[0] / i[0],
						n + e[1] / i[1]
					],
					colours: f,
					...to(l, u, h),
					basis: {
						ready: m,
						column: o,
						group: s
					}
				});
			}
			o += p, s += h ? Zi(h) : 0;
		}
	}), r;
}
function $a({ mean: e, channels: t, precision: n }) {
	let { scale: r, zero: i } = e, a = n ? 4 : eo([e]), o = {
		scale: new Float32Array(4 * t),
		bias: new Float32Array(4 * t)
	};
	for (let e = 0; e < t; e++) {
		let t = 4 * e + e % 4;
		o.scale[t] = a * (r[e] ?? 0), o.bias[t] = n ? 0 : -(i[e] ?? 0) * (r[e] ?? 0);
	}
	return o;
}
function eo(e) {
	return Pr(e) ? 1 : 255;
}
function to(e, t, n) {
	let r = e.flatMap((e) => e.scale), i = e.flatMap((e) => e.zero), a = eo(e), o = 4 * t * Zi(n), s = {
		scale: new Float32Array(o),
		bias: new Float32Array(o)
	};
	for (let e = 0; e < n; e++) for (let n = 0; n < t; n++) {
		let o = 4 * (t * Math.floor(e / 4) + n) + e % 4, c = r[t * e + n] ?? 0;
		s.scale[o] = a * c, s.bias[o] = -(i[t * e + n] ?? 0) * c;
	}
	return s;
}
// eigenfield-three/src/pieces.ts
function no(e) {
	for (let { picture: t } of e) "close" in t && t.close();
}
// eigenfield-three/src/strength.ts
var ro = 128, io = .98;
async function ao(e, t, n, r) {
	let i = n.length, a = 0, o = e.pictures.find(({ textures: e }) => (a += e) > t);
	if (!o) return 1;
	let s = t - (a - o.textures), c = Fr(o), l = o.pieces < i, u = await o.codec.bitmaps(await r(o.view), o, e.size), d = new OffscreenCanvas(ro, ro).getContext("2d", { willReadFrequently: !0 });
	if (!d) return 1;
	d.imageSmoothingEnabled = !1;
	let f = [];
	u.slice(o.pieces * s, o.pieces * (s + 1)).forEach(({ picture: e, row: t, rows: r }, a) => {
		d.drawImage(e, 0, t, e.width, r, 0, 0, ro, ro);
		let { data: u } = d.getImageData(0, 0, ro, ro);
		(l ? [
			0,
			1,
			2
		] : [a]).forEach((e) => {
			let [t, r] = [o.scale, o.zero].map((t) => t[i * s + e] ?? 0), a = Math.max(...(n[e] ?? [0]).map(Math.abs)) * (t ?? 0);
			for (let t = l ? e : 0; t < u.length; t += 4) f.push(Math.abs((c * (u[t] ?? 0) - (r ?? 0)) * a));
		});
	}), no(u), f.sort((e, t) => e - t);
	let p = f[Math.floor(io * f.length)] ?? 0;
	return p > 0 ? .45 / p : 1;
}
// eigenfield-three/src/means.ts
async function oo(e, t, n = 1) {
	let { mean: r, meanSize: i } = e, a = e.precision && await so(await t(e.precision.view), e.precision);
	return {
		pieces: await r.codec.decode(await t(r.view), r, i, n),
		precision: a
	};
}
async function so(e, t) {
	let { type: n } = Bn(e) ?? {}, { mimeType: r } = t.codec;
	if (n && n !== r) throw j(t.where, `${n}, not ${r}`);
	let [i] = await t.codec.bitmaps(e, t, t.size);
	if (!i) throw j(t.where, "no picture");
	return i.picture;
}
function co({ pieces: e, precision: t }) {
	no(e), t?.close();
}
// eigenfield-three/src/textures.ts
var lo = 3, uo = class {
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
			channels: e,
			tenBits: Pr(t.pictures)
		}))), s = r.planes.map(({ channels: e, mean: t }, n) => ({
			size: i[n] ?? [1, 1],
			channels: e,
			pieces: t.pieces,
			tenBits: Pr([t])
		}));
		this.needs = {
			atlas: bi(r, i),
			means: s,
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
		if (!(t instanceof WebGL2RenderingContext)) throw new A("unsupported", "Eigen textures need WebGL 2; use a newer browser.");
		this.detach(), this.renderer = e, e.domElement.addEventListener("webglcontextlost", this.onLost), e.domElement.addEventListener("webglcontextrestored", this.onRestored);
		let n = this.turn;
		this.load(t, n).catch((e) => {
			n === this.turn && this.onError(e);
		});
	}
	dispose() {
		this.detach(), this.disposed = !0, this.decoded?.forEach(co), this.decoded = null;
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
		if (!e.getExtension("EXT_color_buffer_float") && !e.getExtension("EXT_color_buffer_half_float")) throw new A("unsupported", "These graphics draw no half-floats; use a newer device or browser.");
		let { packer: n, plan: r } = this.makeRoom(e);
		if (this.plan = r, this.packer = n, this.onPlan(r), await this.loadMeans(e, t, r.meanDown), t !== this.turn) return;
		let i = this.entries.filter(({ first: e }) => e < r.usable), a = [], o = 0;
		try {
			for (let e of i) {
				for (; a.length < lo && o < i.length;) a.push(this.decode(i[o++], r.scaleDown));
				let s = await a[0] ?? [];
				if (a.shift(), t === this.turn && this.pack(s, e, n, r.usable), no(s), t !== this.turn) return;
				this.onTexture();
			}
		} finally {
			for (let e of a) e.then(no).catch(() => void 0);
		}
		n.free(), this.packer = null, this.onComplete();
	}
	pack(e, t, n, r) {
		let { number: i, channels: a, first: o, picture: s } = t, c = this.bases[i]?.sourceTexture, l = this.ready[i];
		if (!(c instanceof WebGLTexture) || !l) return;
		let u = this.needs.bases[i]?.tenBits ? 255 * Fr(s) : 1, d = s.pieces < a;
		for (let t = o; t < Math.min(o + s.textures, r); t++) {
			for (let r = 0; r < s.pieces; r++) {
				let i = (e) => a * Math.floor(t / 4) + e, l = (d ? [
					0,
					1,
					2
				] : [r]).map((e) => ({
					channel: d ? e : 0,
					layer: i(e),
					component: t % 4
				})), f = e[(t - o) * s.pieces + r];
				f && n.put(f, c, l, u);
			}
			l[t] = !0;
		}
		this.version += 1;
	}
	makeRoom(e) {
		let { means: t, bases: n } = this.needs, r = this.parts.scene.planes.flatMap(({ precision: e }) => e ? [e.size] : []);
		for (let i = this.options.memory ?? Gi();; i /= 2) {
			let a = $i(this.needs, La(e, i)), { meanDown: o, scaleDown: s, usable: c } = a, l = o > 1 || s > 1, u = [...t.map(({ size: t, channels: n, tenBits: r }) => Ra(e, qi(t, o), Yi(n), l, r)), ...n.map(({ size: t, channels: n, count: r, tenBits: i }) => {
				let a = Math.min(r, c);
				return Ra(e, a ? qi(t, s) : [1, 1], a ? Xi(a, n) : 1, l, i);
			})], d = ra(this.needs, o, s), f = Ba(e, d), p = [...t, ...n].some(({ tenBits: e }) => e), m = p ? Ba(e, d, !0) : null, h = Ba(e, ia(r));
			if (f && h && (m || !p) && u.every((e) => e !== null)) return [...this.means, ...this.bases].forEach((e, t) => e.sourceTexture = u[t] ?? null), {
				packer: Ga(e, {
					picture: f,
					codes: m,
					precision: h
				}),
				plan: a
			};
			for (let t of [
				...u,
				f,
				m,
				h
			]) e.deleteTexture(t);
			if (!c) throw new A("unsupported", "The graphics memory is full; close other pages and try again.");
		}
	}
	async loadMeans(e, t, n) {
		let { scene: r, bytes: i } = this.parts, { decoded: a } = this;
		this.decoded = null, (!a || n > 1) && (a?.forEach(co), a = await Promise.all(r.planes.map((e) => oo(e, i, n)))), a.forEach((n, i) => {
			let a = this.means[i]?.sourceTexture, o = r.planes[i]?.mean;
			t === this.turn && o && a instanceof WebGLTexture && this.putMean(e, n, o, a), co(n);
		}), t === this.turn && (this.hasMeans = !0, this.version += 1);
	}
	putMean(e, t, n, r) {
		let { pieces: i, precision: a } = t, o = Pr([n]), [s] = i;
		if (s && i.length === 1 && !o && "close" in s.picture) {
			za(e, r, s.picture);
			return;
		}
		let c = o ? 255 * Fr(n) : 1;
		i.forEach((e, t) => {
			let i = [{
				channel: 0,
				layer: Math.floor(t / 4),
				component: t % 4
			}];
			this.packer?.put(e, r, i, c, a && {
				precision: a,
				zero: n.zero[t] ?? 0
			});
		});
	}
	decode(e, t) {
		if (!e) return Promise.reject(/* @__PURE__ */ RangeError("no such eigen texture"));
		let { basis: n, picture: r } = e, i = this.parts.bytes(r.view).then((e) => r.codec.decode(e, r, n.size, t));
		return i.catch(() => void 0), i;
	}
}, fo = 1.5, po = .001, mo = class extends l {
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
		this.mesh = a, this.info = r, this.total = yi(n), this.counts = vi(n).map(({ count: e }) => e), this.filter = t.filter ?? "bicubic", this.weightMode = r.facesPlane ? "ray" : "eye";
		let o = 0;
		this.rowOf = Int32Array.from(n.heldOut, (e) => e ? -1 : o++), this.textures = new uo(e, vo(a), t);
		let s = [a.material].flat().some((e) => e.side !== d);
		this.material = Ia(s), this.complete = new Promise((e, t) => {
			this.addEventListener("complete", () => e()), this.addEventListener("error", ({ error: e }) => t(e));
		}), this.complete.catch(() => void 0);
		let c = r.cameras[r.reference];
		this.detail = c ? Li(a.geometry, c, [1, 1]) : 0, this.listen();
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
		return this.componentWeights(...Ti(this.info.viewPlane, n.centre));
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
		return fo * Math.max(1, this.detail * Math.sqrt(e * t) / n);
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
		let r = _o(t, n), [i, a] = Ti(this.info.viewPlane, r), o = this.camera !== null && this.info.cameras[this.camera] ? this.camera : null, s = o === null ? this.componentWeights(i, a) : this.cameraWeights(o), c = o === null && this.weightMode === "ray" && this.info.facesPlane && !this.isOnPlane(r);
		this.setView();
		let l = Ma[this.filter];
		this.material.defines.BICUBIC !== l && (this.material.defines.BICUBIC = l, this.material.needsUpdate = !0), this.material.uniformsNeedUpdate = !0, this.compose(e, t, this.recipe(s, c ? r : null)), e.info.render.frame !== this.frame && (this.lastWeights = []), this.frame = e.info.render.frame, this.lastWeights.push(s), this.lastByRay = c;
	}
	compose(e, t, n) {
		let { plan: r } = this.textures, { size: i, viewPlane: a } = this.info;
		if (!r) return;
		let o = r.meanDown * this.coarser, s = this.composers.get(o);
		s || (s = new Sa(i, Qa(this.parts.scene, this.textures, r), o, this.mesh, a), this.composers.set(o, s)), s.compose(e, t, n), this.material.uniforms.composed.value = s.texture, this.material.uniforms.finest.value = this.finestOf(i, o);
	}
	freeComposers() {
		for (let e of this.composers.values()) e.dispose();
		this.composers.clear();
	}
	recipe(e, t) {
		let n = this.material.uniforms.shown.value, r = n === Na.eigen ? this.shownEigen : null;
		return {
			version: this.textures.version,
			mean: this.textures.hasMeans && r === null,
			only: r,
			count: n === Na.mean ? 0 : Math.max(0, Math.floor(Math.min(this.count, this.total))),
			weights: e,
			eye: t && ba(this.info.viewPlane, t),
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
		e.shown.value = Na[o === "eigen" && s >= this.loaded ? "mean" : o], o === "eigen" && (e.shownGain.value = this.gainOf(s)), t && this.aimPhotograph();
	}
	get shownEigen() {
		return Math.min(Math.max(0, Math.floor(this.eigen)), this.total - 1);
	}
	aimPhotograph() {
		let e = this.camera === null ? void 0 : this.info.cameras[this.camera], { photograph: t } = this;
		if (!e || !t) return;
		let { K: n, R: r, t: i, width: a, height: o } = e, s = new _().set(...r[0], i[0], ...r[1], i[1], ...r[2], i[2], 0, 0, 0, 1), c = new _().set(...n[0], 0, ...n[1], 0, 0, 0, 0, 0, ...n[2], 0), l = t.flipY && !yo(t.image), u = new _().makeScale(1 / a, (l ? -1 : 1) / o, 1);
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
				ao(s, e, o, r).then((t) => {
					this.gains.set(e, t), this.dispatchEvent({ type: "texture" });
				}).catch(() => void 0);
				break;
			}
		}
		return 1;
	}
	isOnPlane(e) {
		let { origin: t, normal: n, extent: r } = this.info.viewPlane, i = e.reduce((e, r, i) => e + (r - (t[i] ?? 0)) * (n[i] ?? 0), 0);
		return Math.abs(i) <= po * Math.max(...r);
	}
	mapsOf(e) {
		let { usable: t } = this;
		if (this.maps?.mixing === e && this.maps.usable === t) return this.maps.texture;
		this.maps?.texture.dispose();
		let n = Aa(this.parts.weights, e, this.parts.omega, this.counts, t);
		return this.maps = {
			texture: n,
			mixing: e,
			usable: t
		}, n;
	}
	fail(e) {
		if (bo(e)) return;
		let t = ie(e), n = `The picture is drawn with ${this.loaded} of ${this.total} eigen textures.`;
		this.dispatchEvent({
			type: "error",
			error: new A(t.code, `${t.message} ${n}`, t.where)
		});
	}
}, ho = new _(), go = new O();
function _o(e, t) {
	return go.setFromMatrixPosition(e.matrixWorld).applyMatrix4(ho.copy(t.matrixWorld).invert()), [
		go.x,
		go.y,
		go.z
	];
}
function vo(e) {
	let { attributes: t, index: n } = e.geometry;
	return Object.values(t).reduce((e, t) => e + t.array.byteLength, 0) + (n?.array.byteLength ?? 0);
}
function yo(e) {
	return typeof ImageBitmap < "u" && e instanceof ImageBitmap;
}
function bo(e) {
	return e instanceof DOMException && e.name === "AbortError";
}
// eigenfield-three/src/arrival.ts
var xo = class {
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
		for (let t of this.waiters) t.to <= this.received ? t.resolve(this.copy(t.from, t.to)) : this.broken ? t.reject(this.broken.reason) : this.ended ? t.reject(ne(this.received, t.to)) : e.push(t);
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
}, So = 1179937895, Co = 1313821514, wo = 5130562;
async function To(e) {
	let t = await e.read(0, 4).catch((t) => {
		throw t instanceof A && t.code === "truncated" ? Ao(e.received === 0) : t;
	});
	if (new DataView(t).getUint32(0, !0) !== So) throw Ao(!1);
	let n = new DataView(await e.read(0, 12)), r = n.getUint32(4, !0), i = n.getUint32(8, !0);
	if (r !== 2) throw new A("version", `The file is GLB version ${r} and this viewer reads 2; save it as glTF 2.`, "4");
	if (i < 20) throw j("8", "a length of no file");
	let a = new DataView(await e.read(12, 20)), o = a.getUint32(0, !0);
	if (a.getUint32(4, !0) !== Co) throw j("16", "it does not begin with JSON");
	if (o > de) throw j("12", `${o} bytes of JSON`);
	if (20 + o > i) throw j("12", "a chunk longer than the file");
	let s = Do(await e.read(20, 20 + o));
	return {
		length: i,
		text: s,
		json: Oo(s, "20"),
		binary: () => Eo(e, 20 + o, i)
	};
}
async function Eo(e, t, n) {
	let r = t;
	for (let t = 1; t < 64 && r + 8 <= n; t++) {
		let t = new DataView(await e.read(r, r + 8)), i = t.getUint32(0, !0);
		if (r + 8 + i > n) throw j(String(r), "a chunk longer than the file");
		if (t.getUint32(4, !0) === wo) return r + 8;
		r += 8 + i;
	}
	throw j(String(t), "no binary chunk");
}
function Do(e) {
	try {
		return new TextDecoder("utf-8", { fatal: !0 }).decode(e);
	} catch {
		throw j("20", "its JSON is not UTF-8");
	}
}
function Oo(e, t) {
	if (ko(e) > 64) throw j(t, "its JSON is nested too deep");
	try {
		return JSON.parse(e);
	} catch {
		throw j(t, "its JSON cannot be read");
	}
}
function ko(e) {
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
function Ao(e) {
	return new A("not-glb", e ? "The file is empty; take a .glb file that eigenfield wrote." : "The file is no GLB; take a .glb file that eigenfield wrote.", "0");
}
// eigenfield-three/src/packed.ts
var jo = "\"names\":[\"texts\":[\"heldOut\":[1,2,\"lenses\":[null,\"harmonise\":\"gain\",\"affine\",\"align\":true,\"residual\":{\"quality\":40},\"metresPerUnit\":0.\"sharedPicture\",\"times\",\"codec\":\"codedNames\":{\"bufferView\":10,\"count\":20},\"sizes\":3,\"colour\":4,\"times\":[0,\"residual\":{\"size\":[512,512],\"scale\":[0.00,0.00],\"full\":true,\"smooth\":true,\"order\":3,\"holdOut\":\"odd\",\"every:\"scores\":{\"psnr\":{\"mean\":\"ssim\":{\"mean\":\"captured\":\"heldOut\":{\"needs\":[\"av1-10bit-2\",\"cameras-2\",\"codedNames\",\"codedTriangles\",\"codedWeights\",\"mesh-2\",\"namePattern\",\"precision\",\"regions\",\"stacks\",\"toRGB\"],\"mesh\":{\"bufferView\":5,\"codec\":\"mesh-2\"},\"planes\":[{\"channels\":1,\"mean\":{\"bufferView\":6,\"size\":[1024,768],\"mimeType\":\"video/AV1\",\"bits\":10,\"scale\":[0.0009775171065493646],\"zero\":[0],\"precision\":{\"bufferView\":7,\"size\":[13,12]}},\"bases\":[{\"size\":[480,480],\"codedWeights\":8,\"textures\":[{\"bufferView\":11,\"mimeType\":\"video/AV1\",\"bits\":10,\"count\":2,\"scale\":[0.0001],\"zero\":[341]}]},{\"size\":[64,464],\"grid\":[464,464],\"corner\":[0,0],\"codedWeights\":9,\"picture\":{\"mimeType\":\"video/AV1\",\"bits\":10,\"count\":8,\"scale\":[0.0002],\"zero\":[341]},\"textures\":[{\"bufferView\":12},{\"bufferView\":13}]}]},{\"channels\":2,\"mean\":{\"bufferView\":9,\"size\":[512,384],\"mimeType\":\"video/AV1\",\"bits\":10,\"scale\":[0.0004,0.0004],\"zero\":[341,341],\"precision\":{\"bufferView\":7,\"size\":[13,12]}},\"bases\":[]}],\"toRGB\":[1,-0.027444022,-0.9585462,1,-0.092323445,0.284937,1,0.9953508,0],\"cameras\":{\"pattern\":{\"counts\":[81,1],\"parts\":[\"image_\",{\"axis\":0,\"first\":0,\"step\":1,\"digits\":3},\".png\",\".jpg\",\".webp\"]},\"size\":[640,480],\"coded\":{\"bufferView\":4,\"codec\":\"cameras-2\"}},\"viewPlane\":{\"origin\":[0,0,0],\"right\":[1,0,0],\"up\":[0,-1,0],\"extent\":[0.5,0.5],\"codedTriangles\":10},\"reference\":40,\"settings\":{\"textures\":2,\"atlas\":[1024,768],\"density\":1.3,\"fit\":\"photographs\",\"fitted\":{\"quality\":78,\"psnr\":{\"luma\":{\"uncoded\":50.0,\"coded\":40.0},\"chroma\":{\"uncoded\":50.0,\"coded\":40.0}}},\"photographs\":{\"count\":81,\"bytes\":10000000,\"pixels\":10000000}},\"generator\":\"eigenfield 0.1.0\",\"lengths\":[", Mo = 4;
async function No(e, t) {
	let n = new K(e, ""), r = n.key("extensions").key(ue), i = r.key("packed");
	if (!i.exists) return e;
	Yr(r);
	let a = br(n), o = a[i.integer(a.length - 1, a.length - 1)];
	if (!o || o.length < Mo) throw i.wrong("no length");
	let s = new DataView(await t(o.offset, Mo)).getUint32(0, !0);
	if (Mo + s > o.length) throw i.wrong(`JSON of ${s} bytes`);
	let { lengths: c, ...l } = new K(Oo(await Fo(await t(o.offset + Mo, s), i.where), i.where), i.where).object(), u = Po(new K(c, `${i.where}/lengths`), o, Mo + s), { packed: d, ...f } = r.object();
	return {
		...e,
		bufferViews: [...n.key("bufferViews").items(F).slice(0, -1).map(({ raw: e }) => e ?? null), ...u],
		extensions: {
			...n.key("extensions").object(),
			[ue]: {
				...f,
				...l
			}
		}
	};
}
function Po(e, t, n) {
	let r = n, i = e.items(F).map((e) => {
		let n = e.integer(1, t.length);
		return r += n, {
			buffer: 0,
			byteOffset: t.offset + r - n,
			byteLength: n
		};
	});
	if (r !== t.length) throw e.wrong(`${r} bytes of ${t.length}`);
	return i;
}
async function Fo(e, t) {
	let n = new TextEncoder().encode(jo), [r, i] = [n.length & 255, n.length >> 8], a = new Uint8Array(5 + n.length + e.byteLength);
	a.set([
		0,
		r,
		i,
		~r,
		~i
	]), a.set(n, 5), a.set(new Uint8Array(e), 5 + n.length);
	let o = await le(a, "deflate-raw", n.length + de, t);
	try {
		return new TextDecoder("utf-8", {
			fatal: !0,
			ignoreBOM: !0
		}).decode(o.subarray(n.length));
	} catch {
		throw j(t, "its JSON is not UTF-8");
	}
}
// eigenfield-three/src/proxy.ts
var Io = 65535;
function Lo(e, t) {
	let n = e.getAttribute("position"), r = e.getAttribute("uv"), { index: i } = e;
	if (!i) throw new A("damaged", "The proxy mesh has no triangles; make or download the file again.");
	if (r.count !== n.count) throw j(t.uv.where, `${r.count} for ${n.count} vertices`);
	for (let e = 0; e < n.count; e++) {
		if (!(Math.max(Math.abs(n.getX(e)), Math.abs(n.getY(e)), Math.abs(n.getZ(e))) <= 1e30)) throw j(t.position.where, `vertex ${e} is not finite`);
		if (!(Math.max(Math.abs(r.getX(e)), Math.abs(r.getY(e))) <= 1e30)) throw j(t.uv.where, `texture coordinates of vertex ${e} are not finite`);
	}
	for (let e of i.array) if (e >= n.count) throw j(t.indices.where, `no vertex ${e}`);
}
async function Ro({ view: n, codec: r, where: i }, a) {
	let { positions: o, uv: s, indices: c } = r.decode(new Uint8Array(await a(n)), i);
	if (!c.length) throw j(i, "a mesh without faces");
	let l = new t();
	l.setAttribute("position", new e(o, 3)), l.setAttribute("uv", new e(s, 2));
	let u = o.length / 3 <= Io;
	return l.setIndex(new e(u ? Uint16Array.from(c) : c, 1)), l;
}
function zo(e) {
	return {
		vertices: e.getAttribute("position").count,
		triangles: (e.index?.count ?? 0) / 3
	};
}
// eigenfield-three/src/grid.ts
function Bo(e) {
	let t = e.length / 2;
	for (let n = 1; n * n <= t; n++) {
		if (t % n) continue;
		let r = t / n, i = Vo(e, n, r) ?? (n === r ? null : Vo(e, r, n));
		if (i) return i;
	}
	return null;
}
function Vo(e, t, n) {
	let [r, i] = [Uo(e, 0), Uo(e, 1)];
	if (t === 1 && Wo(i) > 0 || n === 1 && Wo(r) > 0) return null;
	let a = Array.from(r, (e, t) => t).sort((e, t) => X(i, e) - X(i, t));
	for (let e = 0; e < t; e++) {
		let t = a.slice(e * n, (e + 1) * n).sort((e, t) => X(r, e) - X(r, t));
		a.splice(e * n, n, ...t);
	}
	let o = (e, t) => a[e * n + t] ?? 0;
	return Ho(n, t, (e, t) => X(r, o(t, e))) && Ho(t, n, (e, t) => X(i, o(e, t))) ? {
		rows: t,
		columns: n,
		index: Int32Array.from(a)
	} : null;
}
function Ho(e, t, n) {
	let r = Infinity, i = 0, a = NaN;
	for (let o = 0; o < e; o++) {
		let e = 0;
		for (let r = 0; r < t; r++) e += n(o, r) / t;
		for (let r = 0; r < t; r++) i = Math.max(i, Math.abs(n(o, r) - e));
		o && (r = Math.min(r, e - a)), a = e;
	}
	return r > 0 && (r === Infinity || i <= r / 4);
}
function Uo(e, t) {
	return Float64Array.from({ length: e.length / 2 }, (n, r) => e[2 * r + t] ?? 0);
}
function Wo(e) {
	return e.reduce((e, t) => Math.max(e, t), -Infinity) - e.reduce((e, t) => Math.min(e, t), Infinity);
}
var X = (e, t) => e[t] ?? 0, Go = 1e-6, Ko = 32, qo = class {
	places;
	triangles;
	isLine;
	grid;
	rules = /* @__PURE__ */ new Map();
	constructor(e, t, n) {
		this.places = e, this.triangles = t, this.isLine = n, this.grid = Bo(e);
	}
	at(e, t, n) {
		let r = n === "bilinear" && !this.grid ? "delaunay" : n, i = this.rules.get(r);
		return i || this.rules.set(r, i = this.makeRule(r)), i(Jo(e), this.isLine ? 0 : Jo(t));
	}
	makeRule(e) {
		return e === "nearest3" ? (e, t) => is(e, t, this.places) : e === "bilinear" && this.grid ? os(this.places, this.grid) : Zo(this.places, this.triangles);
	}
};
function Jo(e) {
	return Math.min(1, Math.max(-1, e));
}
function Yo(e) {
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
var Z = (e, t) => e[2 * t] ?? 0, Q = (e, t) => e[2 * t + 1] ?? 0;
function Xo(e, t, n, r, i, a) {
	let [o, s] = [Z(n, r), Q(n, r)], [c, l] = [Z(n, i) - o, Q(n, i) - s], [u, d] = [Z(n, a) - o, Q(n, a) - s], f = c * d - l * u, p = ((e - o) * d - (t - s) * u) / f, m = (c * (t - s) - l * (e - o)) / f;
	return [
		1 - p - m,
		p,
		m
	];
}
function Zo(e, t) {
	if (!t.length) {
		let t = rs(e, ns(e));
		return (n, r) => ts(n, r, e, t);
	}
	let n = $o(e, t, 3), r = es(t);
	return (i, a) => {
		let o = -1, s = -Infinity, c = [
			0,
			0,
			0
		];
		for (let r of n[$(a) * Ko + $(i)] ?? []) {
			let [n, l, u] = [
				Qo(t, r, 0),
				Qo(t, r, 1),
				Qo(t, r, 2)
			], d = Xo(i, a, e, n, l, u), f = Math.min(...d);
			f > s && ([o, s, c] = [
				r,
				f,
				d
			]);
		}
		return s < -1e-9 ? ts(i, a, e, r) : Yo(c.map((e, n) => [Qo(t, o, n), e]));
	};
}
var Qo = (e, t, n) => e[3 * t + n] ?? 0;
function $(e) {
	return Math.min(31, Math.max(0, Math.floor((e + 1) / 2 * Ko)));
}
function $o(e, t, n) {
	let r = Array.from({ length: 1024 }, () => []);
	for (let i = 0; i < t.length / n; i++) {
		let a = Array.from({ length: n }, (e, r) => t[n * i + r] ?? 0), o = a.map((t) => Z(e, t)), s = a.map((t) => Q(e, t));
		for (let e = $(Math.min(...s)); e <= $(Math.max(...s)); e++) for (let t = $(Math.min(...o)); t <= $(Math.max(...o)); t++) r[e * Ko + t]?.push(i);
	}
	return r;
}
function es(e) {
	let t = /* @__PURE__ */ new Map();
	for (let n = 0; n < e.length / 3; n++) for (let r = 0; r < 3; r++) {
		let [i, a] = [Qo(e, n, r), Qo(e, n, (r + 1) % 3)], o = i < a ? [i, a] : [a, i], s = t.get(o.join());
		s ? s.times += 1 : t.set(o.join(), {
			edge: o,
			times: 1
		});
	}
	let n = [...t.values()].filter((e) => e.times === 1).map((e) => e.edge);
	return n.sort((e, t) => e[0] - t[0] || e[1] - t[1]), Int32Array.from(n.flat());
}
function ts(e, t, n, r) {
	let i = Infinity, a = [
		r[0] ?? 0,
		r[0] ?? 0,
		0
	];
	for (let o = 0; o + 1 < r.length; o += 2) {
		let [s, c] = [r[o] ?? 0, r[o + 1] ?? 0], [l, u] = [Z(n, s), Q(n, s)], [d, f] = [Z(n, c) - l, Q(n, c) - u], p = d * d + f * f, m = p > 0 ? Math.min(1, Math.max(0, ((e - l) * d + (t - u) * f) / p)) : 0, h = (l + m * d - e) ** 2 + (u + m * f - t) ** 2;
		h < i && ([i, a] = [h, [
			s,
			c,
			m
		]]);
	}
	let [o, s, c] = a;
	return Yo([[o, 1 - c], [s, c]]);
}
function ns(e) {
	return Array.from({ length: e.length / 2 }, (e, t) => t);
}
function rs(e, t) {
	let [n = 0] = t;
	if (t.length === 1) return Int32Array.of(n, n);
	let r = [0, 0];
	for (let n of t) r[0] = (r[0] ?? 0) + Z(e, n) / t.length, r[1] = (r[1] ?? 0) + Q(e, n) / t.length;
	let [i, a, o] = [
		0,
		0,
		0
	];
	for (let n of t) {
		let [t, s] = [Z(e, n) - (r[0] ?? 0), Q(e, n) - (r[1] ?? 0)];
		[i, a, o] = [
			i + t * t,
			a + t * s,
			o + s * s
		];
	}
	let s = .5 * Math.atan2(2 * a, i - o), c = (t) => Z(e, t) * Math.cos(s) + Q(e, t) * Math.sin(s), l = [...t].sort((e, t) => c(e) - c(t));
	return Int32Array.from(l.slice(1).flatMap((e, t) => [l[t] ?? 0, e]));
}
function is(e, t, n) {
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
		let [u, d] = [Z(n, l) - e, Q(n, l) - t], f = u * u + d * d;
		f >= c || (a = l, c = f, f < s && ([a, c] = [i, s], [i, s] = [l, f]), f < o && ([i, s] = [r, o], [r, o] = [l, f]));
	}
	if (a < 0 || as(n, r, i, a) <= Go) return ts(e, t, n, rs(n, [
		r,
		i,
		a
	].filter((e) => e >= 0)));
	let [l, u, d] = Xo(e, t, n, r, i, a);
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
function as(e, t, n, r) {
	let [i, a] = [Z(e, n) - Z(e, t), Q(e, n) - Q(e, t)], [o, s] = [Z(e, r) - Z(e, t), Q(e, r) - Q(e, t)], c = Math.max(i * i + a * a, o * o + s * s, (i - o) ** 2 + (a - s) ** 2);
	return c > 0 ? Math.abs(i * s - a * o) / c : 0;
}
function os(e, t) {
	let { rows: n, columns: r, index: i } = t;
	if (Math.min(n, r) === 1) {
		let t = rs(e, ns(e));
		return (n, r) => ts(n, r, e, t);
	}
	let a = (e, t) => i[e * r + t] ?? 0, o = [];
	for (let e = 0; e + 1 < n; e++) for (let t = 0; t + 1 < r; t++) o.push([
		a(e, t),
		a(e, t + 1),
		a(e + 1, t + 1),
		a(e + 1, t)
	]);
	let s = $o(e, o.flat(), 4), c = [];
	for (let e = 0; e < r; e++) c.push(a(0, e));
	for (let e = 1; e < n; e++) c.push(a(e, r - 1));
	for (let e = r - 2; e >= 0; e--) c.push(a(n - 1, e));
	for (let e = n - 2; e >= 0; e--) c.push(a(e, 0));
	let l = Int32Array.from(c.slice(1).flatMap((e, t) => [c[t] ?? 0, e]));
	return (t, n) => {
		let r = null, i = -Infinity;
		for (let a of s[$(n) * Ko + $(t)] ?? []) {
			let s = o[a], c = s ? ss(t, n, e, s) : -Infinity;
			s && c > i && ([r, i] = [s, c]);
		}
		if (!r || i < -1e-9) return ts(t, n, e, l);
		let [a, c] = cs(t, n, e, r);
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
function ss(e, t, n, r) {
	let i = Infinity;
	for (let a = 0; a < 4; a++) {
		let [o, s] = [r[a], r[(a + 1) % 4]], [c, l] = [Z(n, o), Q(n, o)];
		i = Math.min(i, (Z(n, s) - c) * (t - l) - (Q(n, s) - l) * (e - c));
	}
	return i;
}
function cs(e, t, n, r) {
	let [i, a, o, s] = [
		Z(n, r[0]),
		Q(n, r[0]),
		Z(n, r[1]),
		Q(n, r[1])
	], [c, l, u, d] = [
		Z(n, r[2]),
		Q(n, r[2]),
		Z(n, r[3]),
		Q(n, r[3])
	], [f, p, m, h, g, _] = [
		e - i,
		t - a,
		o - i,
		s - a,
		u - i,
		d - a
	], [v, y] = [i - o + c - u, a - s + l - d], b = f * h - p * m, x = f * y - p * v - (g * h - _ * m), S = -(g * y - _ * v), C = Math.sqrt(Math.max(x * x - 4 * b * S, 0)), w = ls(-2 * b / (x + (x < 0 ? -C : C))), [T, E] = [m + w * v, h + w * y];
	return [ls(((f - w * g) * T + (p - w * _) * E) / (T * T + E * E)), w];
}
function ls(e) {
	return Math.min(1, Math.max(0, e));
}
// eigenfield-three/src/plugin.ts
var us = class {
	parser;
	options;
	name = ue;
	scene = null;
	ours;
	constructor(e, t = {}) {
		this.parser = e, this.options = t, this.ours = qr(e.json);
	}
	async beforeRoot() {
		if (!this.ours) return;
		let { json: e } = this.parser;
		Object.assign(e, await No(e, (e, t) => this.read(e, t))), this.scene = Jr(e);
	}
	async read(e, t) {
		if (this.options.stream) return this.options.stream.read(e, t);
		let n = (await this.parser.getDependency("buffer", 0)).slice(e, e + t);
		if (n.byteLength < t) throw re("/buffers/0");
		return n;
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
		let n = ds(e, this.parser), [r] = n;
		if (!r) throw j("/meshes/0", "no node shows it");
		Lo(r.geometry, t);
		let i = async (e) => {
			let n = await this.parser.getDependency("bufferView", e);
			if (n.byteLength < (t.views[e]?.length ?? 0)) throw re(`/bufferViews/${e}`);
			return n;
		}, a = t.mesh && await Ro(t.mesh, i);
		if (a) {
			r.geometry.dispose();
			for (let e of n) e.geometry = a;
		}
		let [o, s, c, l] = await Promise.all([
			Promise.all(t.planes.map((e) => oo(e, i))),
			li(t, i),
			gi(t, i),
			xi(t, i)
		]), u = s.filter((e, n) => !t.heldOut[n]), d = new qo(Float64Array.from(u.flatMap((e) => Ti(t, e.centre))), l, t.extent[1] === 0), f = o.map(({ pieces: [e] }) => [e?.picture.width ?? 1, e?.rows ?? 1]), p = Ci(t, s, f, d.grid, this.fileBytes(), zo(r.geometry)), m = {
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
		e.userData.eigenfield = new mo(m, this.options);
	}
	fileBytes() {
		if (this.options.stream) return this.options.stream.total;
		let { extensions: e, json: t } = this.parser;
		return e.KHR_binary_glTF?.header?.length ?? t.buffers[0]?.byteLength ?? 0;
	}
};
function ds(e, t) {
	let n = [];
	return e.scene.traverse((e) => {
		let r = t.associations.get(e);
		fs(e) && r?.meshes === 0 && (r.primitives ?? 0) === 0 && n.push(e);
	}), n;
}
function fs(e) {
	return e.isMesh === !0;
}
// eigenfield-three/src/load.ts
async function ps(e, t = {}) {
	let { signal: n } = t;
	n?.throwIfAborted();
	let r = new xo(), i = new AbortController(), a = () => {
		r.fail(new DOMException("The load was stopped.", "AbortError")), i.abort();
	};
	n?.addEventListener("abort", a);
	let o = gs(e, r, i.signal, t.onBytes).catch((e) => r.fail(e)).finally(() => n?.removeEventListener("abort", a));
	try {
		let e = await To(r);
		if (!qr(e.json)) return {
			gltf: await hs(r, e, o),
			field: null
		};
		let i = await ms(r, e, t);
		n?.throwIfAborted();
		let a = i.userData.eigenfield;
		return {
			gltf: i,
			field: a instanceof mo ? a : null
		};
	} catch (e) {
		throw i.abort(), n?.throwIfAborted(), ie(e);
	}
}
async function ms(e, t, n) {
	let r = new te(), i = t.binary();
	i.catch(() => void 0);
	let a = {
		total: t.length,
		read: async (t, n) => {
			let r = await i + t;
			return e.read(r, r + n);
		}
	};
	return r.register((e) => new us(e, {
		...n,
		stream: a
	})), r.parseAsync(t.text, "");
}
async function hs(e, t, n) {
	await n;
	let r = await e.read(0, t.length);
	try {
		return await new te().parseAsync(r, "");
	} catch (e) {
		let t = ie(e).message;
		throw new A("unsupported", `${t} It has no eigen textures either.`, "", { cause: e });
	}
}
async function gs(e, t, n, r) {
	if (e instanceof ArrayBuffer) return t.push(new Uint8Array(e)), r?.(e.byteLength, e.byteLength), t.end();
	let { body: i, total: a } = e instanceof Blob ? _s(e) : await vs(e, n), o = i.getReader();
	for (n.addEventListener("abort", () => void o.cancel().catch(() => void 0));;) {
		let { done: e, value: i } = await o.read().catch((e) => {
			throw n.aborted ? e : ys(t.received, e);
		});
		if (e) break;
		t.push(i), r?.(t.received, a);
	}
	n.throwIfAborted(), t.end();
}
function _s(e) {
	return {
		body: e.stream(),
		total: e.size
	};
}
async function vs(e, t) {
	let n = await fetch(e, { signal: t }).catch((n) => {
		throw t.aborted ? n : new A("network", "The scene cannot be fetched; check its address and the connection.", e, { cause: n });
	});
	if (!n.ok || !n.body) throw await n.body?.cancel(), new A("network", `The server answered ${n.status} for the scene; check its address.`, e);
	let r = n.headers.get("Content-Encoding") ? null : n.headers.get("Content-Length");
	return {
		body: n.body,
		total: r && /^\d+$/.test(r) ? Number(r) : void 0
	};
}
function ys(e, t) {
	return new A("network", `The connection broke after ${e} bytes of the scene; load it again.`, String(e), { cause: t });
}
export { mo as EigenField, us as EigenfieldPlugin, A as SceneError, Gi as defaultMemory, ps as loadEigenfield, Oi as novelCamera, Mi as placeCamera };
