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
// eigenfield-three/src/limits.ts
var ae = "EIGENFIELD_eigen_textures", oe = 64 * 2 ** 20, se = 16384, ce = 16384, le = 1024, ue = 2 ** 27, de = 4096, fe = 8 * 2 ** 30, M = 1e5, pe = 65535, me = 2 ** 29, N = 1024, he = 2 ** 25, ge = 2 ** 26, _e = 2 ** 27, ve = 2 ** 28, ye = 1e30, P = 65536, be = 126, F = 64, xe = 0, Se = 1, Ce = 2, we = 24, Te = 44, Ee = 21, De = 26214, Oe = 4, ke = Float64Array.from({ length: 4095 }, (e, t) => Math.round(P / (1 + Math.exp((2047 - t) / 256)))), Ae = Float64Array.from({ length: 4096 }, (e, t) => Math.round(256 * Math.log((t + .5) / (4095.5 - t)))), je = Float64Array.from({ length: 127 }, (e, t) => Math.round(P / (t + 1.5)));
function I(e) {
	return e < 4294967296 ? 32 - Math.clz32(e) : 32 + I(Math.floor(e / 4294967296));
}
var Me = class {
	bytes;
	low = 0;
	high = 4294967295;
	code = 0;
	at = 0;
	probability;
	seen;
	weights;
	constructor(e, t, n) {
		this.bytes = e, this.probability = new Uint16Array(t * F).fill(P / 2), this.seen = new Uint8Array(t * F), this.weights = new Float64Array(n * F * 3).fill(De);
		for (let e = 0; e < Oe; e++) this.code = this.code * 256 + this.next();
	}
	checkEnd(e) {
		if (this.at > this.bytes.length + Oe) throw re(e);
	}
	flag(e, t, n, r) {
		return this.node(e, t, n, r, 0) === 1;
	}
	raw(e) {
		let t = 0;
		for (let n = 0; n < e; n++) t = t * 2 + this.split(P / 2);
		return t;
	}
	integer(e, t, n, r) {
		let i = this.magnitude(e, t, n, r);
		return i === 0 ? 0 : this.node(e, t, n, r, Se) ? -i : i;
	}
	magnitude(e, t, n, r) {
		if (!this.node(e, t, n, r, xe)) return 0;
		let i = 0;
		for (; i < Ee && this.node(e, t, n, r, Ce + i);) i += 1;
		if (i < 2) return i + 1;
		let a = 1;
		for (let o = i - 2; o >= 0; o--) {
			let s;
			s = o === i - 2 ? this.node(e, t, n, r, we + i) : o === i - 3 ? this.node(e, t, n, r, Te + 2 * Math.min(i, 9) + (a & 1)) : this.split(P / 2), a = a * 2 + s;
		}
		return a + 1;
	}
	node(e, t, n, r, i) {
		return this.bit(e * F + i, t * F + i, n * F + i, (r * F + i) * 3);
	}
	bit(e, t, n, r) {
		let { probability: i, weights: a } = this, o = Ae[i[e] >> 4], s = Ae[i[t] >> 4], c = Ae[i[n] >> 4], l = Math.floor((a[r] * o + a[r + 1] * s + a[r + 2] * c) / P), u = ke[Math.min(Math.max(l, -2047), 2047) + 2047], d = this.split(u), f = d ? P - u : -u;
		return a[r] += o * f >> 14, a[r + 1] += s * f >> 14, a[r + 2] += c * f >> 14, this.learn(e, d), this.learn(t, d), this.learn(n, d), d;
	}
	learn(e, t) {
		let [n, r] = [this.probability[e], this.seen[e]];
		this.probability[e] = n + Math.floor(((t ? 65535 : 0) - n) * je[r] / P), r < be && (this.seen[e] = r + 1);
	}
	split(e) {
		let t = this.low + Math.floor((this.high - this.low) * e / P), n = +(this.code <= t);
		for (n ? this.high = t : this.low = t + 1; !((this.low ^ this.high) >>> 24);) this.low = this.low << 8 >>> 0, this.high = (this.high << 8 | 255) >>> 0, this.code = (this.code << 8 | this.next()) >>> 0;
		return n;
	}
	next() {
		return this.bytes[this.at++] ?? 0;
	}
};
function L(e, t, n) {
	if (e.length < t) throw re(n);
	if (e[0] !== 1) throw j(n, `coded numbers of version ${e[0]}`);
	return new DataView(e.buffer, e.byteOffset, e.byteLength);
}
function Ne(e, t, n, r) {
	if (t > n || t > 16 * e.length + 1024) throw j(r, `${t} numbers announced`);
}
// eigenfield-three/src/table-decoder.ts
var Pe = 12, Fe = 3, Ie = 312, Le = Fe * Ie, Re = 938, ze = 24, Be = 16, Ve = 1722, He = 1726, Ue = 4, We = 5;
function Ge(e) {
	return new Me(e, He, 21);
}
function Ke(e) {
	return e.flag(Le, Le, Le, Fe) ? 2 : +!!e.flag(937, 937, 937, Fe);
}
function qe(e) {
	return Math.min(I(e), 11);
}
function Je(e, t, n, r) {
	let i = new Float64Array(n.length), a = n.length / t, o = (e, n, r) => n < 0 || r < 0 || r >= t ? 0 : e[n * t + r], s = 0;
	for (let c = 0; c < a; c++) for (let a = 0; a < t; a++) {
		let [l, u] = [o(i, c, a - 1), o(i, c - 1, a)], [d, f] = [o(i, c - 1, a - 1), o(i, c - 1, a + 1)], [p, m, h] = [
			0,
			0,
			s
		];
		r === 1 ? (p = c === 0 ? l : a === 0 ? u : Math.max(Math.min(l, u), Math.min(Math.max(l, u), l + u - d)), m = Math.abs(l - d) + Math.abs(u - d) + Math.abs(f - u)) : (m = 2 * Math.abs(l) + 2 * Math.abs(u) + Math.abs(d) + Math.abs(f), h = Math.abs(o(i, c, a - 2)) + Math.abs(o(i, c - 2, a)));
		let g = 2 * Math.abs(o(n, c, a)) + Math.abs(o(n, c, a - 1)) + Math.abs(o(n, c, a + 1)), _ = r === 2 ? Math.min(c, 2) * 4 + Math.min(a, 3) : Math.min(c, 1), v = r * Ie, y = e.integer(v + qe(m) * Pe + qe(g), v + 144 + qe(m + h), v + 144 + 24 + _ * Pe + qe(g + Math.abs(l)), r);
		i[c * t + a] = p + y, s = Math.abs(y);
	}
	return i;
}
function Ye(e, t, n, r) {
	let i = new Float64Array(t * n), a = new Float64Array(n);
	for (let o = 0; o < t; o++) {
		let t = 0;
		for (let s = 0; s < n; s++) {
			let c = r && o > 0 ? i[(o - 1) * n + s] : 0, l = Math.min(s, 15), u = Math.min(I(a[s]), 23), d = Math.min(I(t), 23), f = e.integer(Re + l * ze + u, Re + (Be + l) * ze + d, 1706 + l, We + l);
			i[o * n + s] = c + f, t = Math.abs(f), a[s] = Math.floor((a[s] + t + 1) / 2);
		}
	}
	return i;
}
function Xe(e, t, n, r) {
	let i = new Float64Array(t).fill(-1), a = new Uint8Array(n), [o, s, c] = [
		0,
		1,
		0
	];
	for (let l = 0; l < t; l++) {
		if (s = +!!e.flag(Ve + s, Ve + s, 1724, Ue), !s) continue;
		let t = o + e.integer(1725, 1725, 1725, Ue);
		if (!(t >= 0 && t < n) || a[t]) throw j(r, "a grid with a camera out of place");
		a[t] = 1, i[l] = t, o = t + 1, c += 1;
	}
	if (c !== n) throw j(r, "a grid without all cameras");
	return i;
}
// eigenfield-three/src/camera-decoder.ts
var Ze = 130, R = 11, Qe = 1, $e = 2;
function et(e, t) {
	let n = L(e, Ze, t), [r, i] = [n.getUint8(1), n.getUint32(6, !0)], a = (r & Qe) !== 0, [o, s] = a ? [n.getUint16(2, !0), n.getUint16(4, !0)] : [0, 0], c = Float64Array.from({ length: 15 }, (e, t) => n.getFloat64(10 + 8 * t, !0));
	if (r > 3 || i === 0 || !c.every(Number.isFinite)) throw j(t, "cameras that cannot be");
	if (i > 1e5 || a && o * s < i) throw j(t, `${i} cameras`);
	Ne(e, Math.max(R * i, o * s), R * M, t);
	let l = Ze + (a ? 132 : 0);
	L(e, l, t);
	let u = (e, t) => a ? n.getFloat32(Ze + 4 * (e * R + t), !0) : 0, d = Ge(e.subarray(l)), f = a ? Xe(d, o * s, i, t) : null, p = Ye(d, i, R, (r & $e) !== 0);
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
	], g = nt(c[3], c[4], c[5], c[6]), _ = new Float64Array(R), v = 0;
	for (let e = 0; e < (f ? f.length : i); e++) {
		let t = f ? f[e] : e;
		if (t < 0) continue;
		let [n, r] = f ? [Math.floor(e / s), e % s] : [0, 0];
		for (let e = 0; e < R; e++) {
			let t = c[e < 5 ? 0 : e < 8 ? 1 : 2], i = u(0, e) + u(1, e) * n + u(2, e) * r;
			_[e] = p[v * R + e] * t + h[e] + i;
		}
		tt(_, g, m, t), v += 1;
	}
	if (!m.intrinsics.every(Number.isFinite) || !m.poses.every(Number.isFinite)) throw j(t, "cameras that are not finite");
	return m;
}
function tt(e, t, n, r) {
	n.intrinsics.set(e.subarray(0, 5), 5 * r);
	let [i, a, o] = [
		e[5],
		e[6],
		e[7]
	], s = i * i + a * a + o * o, c = 1 + s, l = nt(2 * i / c, 2 * a / c, 2 * o / c, (1 - s) / c);
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
function nt(e, t, n, r) {
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
var rt = 2 ** 24, it = class {
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
		let s = (a[3 * e] + a[3 * t]) * rt + a[3 * e + 1] + a[3 * t + 1], c = this.waiting++;
		for (; c > 0;) {
			let e = c - 1 >> 1;
			if (i[e] <= s) break;
			r[c] = r[e], i[c] = i[e], c = e;
		}
		return r[c] = o, i[c] = s, o;
	}
}, at = 2 ** 20, ot = .8, st = 44, ct = 385, lt = 897, ut = 1086, dt = 1095, [ft, pt, mt, ht, gt] = [
	0,
	1,
	2,
	3,
	15
];
function _t(e) {
	return Math.floor(Math.min(Math.max(e, -at), at) + .5);
}
function vt(e, t, n) {
	let r = Math.max((1 << n) - 1, 1);
	return (e[3 * t] & r ? 1 : 0) + (e[3 * t + 1] & r ? 2 : 0);
}
function yt(e, t, n, r, i) {
	i.flat ? bt(e, t, n, r, i.fine) : xt(e, t, n, r);
}
function bt(e, t, n, r, i) {
	let { a, b: o, o: s, pair: c } = r, [l, u, d, f] = [
		t[3 * a],
		t[3 * a + 1],
		t[3 * o],
		t[3 * o + 1]
	], [p, m] = [d - l, f - u], h = p * (t[3 * s + 1] - u) - m * (t[3 * s] - l), g = h > 0 ? ot : -.8, _ = 1 << i >> 1, v = _t((l + d) * .5 + g * m) + _ >> i, y = _t((u + f) * .5 - g * p) + _ >> i, b = 4 ** i, x = Math.min(I(Math.floor((p * p + m * m) / b)), 23), S = Math.min(I(Math.floor(Math.abs(h) / b)), 23), C = +(p < 0) + (m < 0 ? 2 : 0) + (Math.abs(m) > Math.abs(p) ? 4 : 0), w = e.integer(x * 8 + C, 192 + S, 216 + c, ft), T = Math.min(I(Math.abs(w)), 7), [E, D] = [577, 705], O = T * 2 + +(w > 0), ee = e.integer(ct + x * 8 + C, E + O * 8 + C, D + S * 8 + T, pt);
	if (t[3 * n] = v + w << i, t[3 * n + 1] = y + ee << i, i === 0) return;
	let k = vt(t, a, i) + 4 * vt(t, o, i);
	if (e.flag(lt + k, 913 + vt(t, s, i), 917 + c, gt)) for (let r = 0; r < 2; r++) t[3 * n + r] += e.raw(i) - _;
}
function xt(e, t, n, { a: r, b: i, o: a }) {
	let o = 0;
	for (let e = 0; e < 3; e++) o += (t[3 * i + e] - t[3 * r + e]) ** 2;
	let s = Math.min(I(o), 43), c = 0;
	for (let o = 0; o < 3; o++) {
		let l = _t(t[3 * r + o] + t[3 * i + o] - t[3 * a + o]), u = e.integer(s, st + o * 24 + c, 116 + o * st + s, mt);
		t[3 * n + o] = l + u, c = Math.min(I(Math.abs(u)), 23);
	}
}
function St(e, t, n, r, i) {
	for (let a = 0; a < (i ? 2 : 3); a++) {
		let i = r >= 0 ? Math.min(Math.max(t[3 * r + a], -at), at) : 0, o = ut + a;
		t[3 * n + a] = i + e.integer(o, o + 3, o + 6, ht);
	}
}
// eigenfield-three/src/mesh-faces.ts
var Ct = 13, wt = 11, Tt = 12, z = 169, Et = 8, Dt = dt, Ot = Dt + z + 104 + 26, kt = Ot + z + 104 + Ct, At = kt + 64 + 64 + z, jt = At + z + 4 + 1, Mt = jt + 6, [Nt, Pt, Ft, It, Lt] = [
	4,
	5,
	6,
	7,
	8
], Rt = [
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
function zt(e, t, n, r, i) {
	let a = new Int32Array(3 * t), o = {
		points: a,
		faces: new Int32Array(3 * n),
		parents: new Int32Array(3 * t).fill(-1)
	}, s = new Int32Array(t), c = new it(a, n), [l, u] = [0, 0], d = (e, t, n) => {
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
		let t = e.raw(I(l - 1));
		if (t >= l) throw j(i, "a place that is not there yet");
		return t;
	}, m = () => {
		let t = [
			-1,
			-1,
			-1
		];
		for (let n = 0; n < 3; n++) if (l > 0 && e.flag(jt + n, jt + 3 + n, jt + n, Lt)) t[n] = p();
		else {
			let i = t[n] = f();
			St(e, a, i, n > 0 ? t[n - 1] : i - 1, r.flat);
		}
		let [n, o, s] = t;
		if (n === o || o === s || s === n) throw j(i, "a face of two corners");
		d(n, o, s), c.seed(t);
	}, h = (e, t, n, i) => c.status[t] === 2 ? Tt : c.status[t] !== 1 || n === i || t === e ? wt : Bt(a, c.start[e], c.end[e], n, c.opposite[e], r.flat);
	for (; u < n;) {
		let t = c.next();
		if (t < 0) {
			m();
			continue;
		}
		let [n, l] = [c.start[t], c.end[t]], [u, g] = [c.before[t], c.after[t]], [_, v] = [c.start[u], c.end[g]], [y, b] = [h(t, u, _, l), h(t, g, v, n)], x = y * Ct + b, [S, C] = [Math.min(s[n], 7), Math.min(s[l], 7)], w = Dt + z + 104 + 2 * y + +(_ === v);
		if (y < wt && e.flag(Dt + x, Dt + z + y * Et + S, w, Nt)) {
			d(l, n, _), c.closeLeft(t);
			continue;
		}
		if (b < wt && (v !== _ || y >= wt) && e.flag(Ot + x, Ot + z + b * Et + C, Ot + z + 104 + b, Pt)) {
			d(l, n, v), c.closeRight(t);
			continue;
		}
		let T = +(y === Tt) + (b === Tt ? 2 : 0), E = vt(a, n, r.fine) + 4 * vt(a, l, r.fine), D = kt + 64 + S * Et + C;
		if (e.flag(kt + T * 16 + E, D, kt + 64 + 64 + x, Ft)) {
			c.status[t] = 2;
			continue;
		}
		let O;
		if (e.flag(At + x, At + z + T, At + z + 4, It)) {
			O = f();
			let i = c.opposite[t];
			o.parents.set([
				n,
				l,
				i
			], 3 * O), yt(e, a, O, {
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
function Bt(e, t, n, r, i, a) {
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
	let C = (u * (u - s) + d * (d - c) + f * (f - l)) / S, w = Rt.findIndex((e) => C < e);
	return w < 0 ? 10 : w + 1;
}
// eigenfield-three/src/mesh-corners.ts
var Vt = 32, Ht = 4, [Ut, Wt, Gt, Kt] = [
	0,
	1,
	2,
	3
], qt = Mt, Jt = qt + 64 + 12 + 16, B = Jt + Ht + 1, Yt = B + 4, [Xt, Zt, Qt] = [
	9,
	10,
	11
];
function $t(e, t) {
	let n = new Int32Array(t + 1);
	for (let t of e) n[t + 1] += 1;
	for (let e = 0; e < t; e++) n[e + 1] += n[e];
	let r = n.slice(), i = new Int32Array(e.length);
	return e.forEach((e, t) => i[r[e]++] = t), {
		first: n,
		corners: i
	};
}
function en(e, t, n, r, i, a) {
	let o = t.faces.length / 3, s = Math.min(o, Math.floor(n / 3)), c = {
		faces: new Int32Array(3 * o),
		place: new Int32Array(n),
		chart: new Int32Array(n),
		kinds: new Uint8Array(s),
		maps: new Uint32Array(6 * s)
	}, l = new Int32Array(t.points.length / 3).fill(-1), u = new Int32Array(n), d = [
		-1,
		-1,
		-1
	], f = [
		0,
		0,
		0
	], p = new Int32Array(Ht), m = /* @__PURE__ */ new Int32Array(8), [h, g, _] = [
		0,
		0,
		-1
	], v = (e, n) => {
		for (let r = 0; r < 3; r++) if (t.faces[3 * e + r] === n) return r;
		return -1;
	}, y = (e, n) => {
		let [a, o] = [t.faces[3 * e + n], t.faces[3 * e + (n + 1) % 3]];
		for (let t = r[a]; t < Math.min(r[a + 1], r[a] + Vt); t++) {
			let n = Math.floor(i[t] / 3);
			if (n >= e) break;
			if (v(n, o) >= 0) return n;
		}
		return -1;
	}, b = (e, t) => c.faces[3 * e + v(e, t)], x = (n, r) => {
		let i = t.faces[3 * n + r], o = l[i];
		if (o < 0) return -1;
		m.fill(Kt);
		let s = 0;
		for (let e of [r, (r + 2) % 3]) {
			if (d[e] < 0) continue;
			let t = b(d[e], i);
			s === 1 && p[0] === t ? m[1] = f[e] : (p[s] = t, m[2 * s] = f[e], s += 1);
		}
		for (let e = 0; e < Vt && s < Ht && o >= 0; e++) (s < 1 || o !== p[0]) && (s < 2 || o !== p[1]) && (p[s++] = o), o = u[o];
		let g = -1;
		for (let t = 0; t < s && g < 0; t++) {
			let [n, i] = [m[2 * t], m[2 * t + 1]], a = qt + 76 + Math.min(s, 3) * 4 + n;
			e.flag(qt + t * 16 + n * 4 + i, qt + 64 + t * 3 + r, a, Xt) && (g = p[t]);
		}
		if (g < 0) {
			if (e.flag(Jt + s, Jt + s, Jt + Ht, Zt)) return -1;
			if (g = e.raw(I(h - 1)), g >= h || c.place[g] !== i) throw j(a, "a corner that is elsewhere");
		}
		for (let e of [r, (r + 2) % 3]) d[e] >= 0 && (f[e] = b(d[e], i) === g ? Wt : Gt);
		return g;
	}, S = () => {
		let t = g++;
		if (!e.flag(B, B, B, Qt)) return c.kinds[t] = e.flag(B + 1, B + 1, B + 1, Qt) ? 2 : 0, t;
		c.kinds[t] = 1;
		let n = _;
		if (_ = t, n >= 0 && e.flag(B + 2, B + 2, B + 2, Qt)) {
			let n = e.raw(I(t - 1));
			if (n >= t || c.kinds[n] !== 1) throw j(a, "a map that is not there");
			return c.maps.copyWithin(6 * t, 6 * n, 6 * n + 6), t;
		}
		let r = n >= 0 && e.flag(B + 3, B + 3, B + 3, Qt);
		for (let i = 0; i < 6; i++) c.maps[6 * t + i] = r && i < 4 ? c.maps[6 * n + i] : e.raw(32);
		return t;
	};
	for (let e = 0; e < o; e++) {
		for (let t = 0; t < 3; t++) d[t] = y(e, t), f[t] = Ut;
		let r = -1, i = [];
		for (let o = 0; o < 3; o++) {
			let s = x(e, o);
			if (s >= 0) r = c.chart[s];
			else {
				if (h >= n) throw j(a, "more vertices than announced");
				s = h++;
				let r = t.faces[3 * e + o];
				c.place[s] = r, u[s] = l[r], l[r] = s, i.push(s);
			}
			c.faces[3 * e + o] = s;
		}
		r < 0 && (r = S());
		for (let e of i) c.chart[e] = r;
	}
	if (h !== n) throw j(a, "fewer vertices than announced");
	return c;
}
// eigenfield-three/src/mesh-values.ts
var tn = 16, nn = 6, rn = 13, an = 14, on = 20, sn = Yt, cn = sn + 169 + 280 + 182, ln = cn + 144 + 576 + 48, [un, dn] = [12, 13], fn = [
	.5,
	1.5,
	3,
	6,
	12,
	30
];
function pn(e, t) {
	return _t(Number.isNaN(e) ? t : e);
}
function mn(e) {
	let t = fn.filter((t) => Math.abs(e) >= t).length;
	return e < 0 ? nn - t : nn + t;
}
function hn(e, t, n, r) {
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
		for (let e = n[t]; e < Math.min(n[t + 1], n[t] + tn); e++) for (let i = 1; i < 3; i++) {
			let o = gn(a, r[e], i);
			if (o >= t) continue;
			let s = d(t, o);
			h += s * u(o), g += s, _ = Math.min(_, u(o)), v = Math.max(v, u(o));
			for (let e = n[o]; e < Math.min(n[o + 1], n[o] + tn); e++) for (let n = 1; n < 3; n++) {
				let i = gn(a, r[e], n);
				i < t && d(t, i);
			}
		}
		let y = 13, b = t > 0 ? u(t - 1) : 0, x = b;
		g > 0 && (y = Math.min(I(v - _), 12), b = h / g, x = Math.min(Math.max(_n(s), p), m));
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
		let E = pn(x, b), [D, O] = [mn(S - E), mn(b - E)], ee = e.integer(sn + D * rn + O, sn + 169 + y * on + f, sn + 169 + 280 + D * an + y, un), k = E + ee;
		i[3 * t + 2] = k, f = Math.min(I(Math.abs(ee)), 19), p = t === 0 ? k : Math.min(p, k), m = t === 0 ? k : Math.max(m, k);
	}
}
function gn(e, t, n) {
	let r = t % 3;
	return e[t - r + (r + n) % 3];
}
function _n(e) {
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
function vn(e, t, n, r, i) {
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
		for (let e = r[t]; e < Math.min(r[t + 1], r[t] + tn); e++) {
			let [r, s] = [gn(a, i[e], 1), gn(a, i[e], 2)];
			if (r < t && o[r] === o[t] && (g = Math.max(g, r)), s < t && o[s] === o[t] && (g = Math.max(g, s)), r >= t || s >= t) continue;
			let [u, d] = yn(n, c, l, t, r, s, f === 2);
			if (!Number.isFinite(u) || !Number.isFinite(d)) continue;
			p += u, m += d, h += 1;
			let v = Math.abs(l[2 * r] - l[2 * s]) + Math.abs(l[2 * r + 1] - l[2 * s + 1]);
			_ = Math.max(_, I(v));
		}
		g < 0 && (g = d), d = t;
		let v = [g >= 0 ? l[2 * g] : 0, g >= 0 ? l[2 * g + 1] : 0], y = h > 0 ? [p / h, m / h] : v, [b, x] = [Math.min(h, 2), Math.min(_, 23)], S = cn + 144;
		for (let n = 0; n < 2; n++) {
			let r = e.integer(cn + (n * 24 + x) * 3 + b, S + u[0] * 24 + x, S + 576 + n * 24 + u[n], dn + n);
			l[2 * t + n] = pn(y[n], 0) + r, u[n] = Math.min(I(Math.abs(r)), 23);
		}
	}
	return l;
}
function yn(e, t, n, r, i, a, o) {
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
var bn = 144, xn = 18, Sn = 8;
function Cn(e, t) {
	let n = L(e, bn, t), [r, i, a] = [
		n.getUint8(1),
		n.getUint8(2),
		n.getUint8(3)
	], [o, s, c] = [
		4,
		8,
		12
	].map((e) => n.getUint32(e, !0)), l = Float64Array.from({ length: 16 }, (e, t) => n.getFloat64(16 + 8 * t, !0));
	if (o > ge || c > ge || s > _e) throw j(t, `${c} vertices and ${s} faces`);
	if (Ne(e, Math.max(o, s, c), _e, t), r > 1 || a > Sn * r || i < 1 || i > xn || !l.every(Number.isFinite)) throw j(t, "a lattice that cannot be");
	let u = new Me(e.subarray(bn), ln, 16), d = zt(u, o, s, {
		flat: r === 1,
		fine: a
	}, t);
	u.checkEnd(t);
	let f = $t(d.faces, o);
	r && hn(u, d, f.first, f.corners);
	let p = en(u, d, c, f.first, f.corners, t), m = wn(d.points, l), h = $t(p.faces, c), g = vn(u, p, m, h.first, h.corners);
	return u.checkEnd(t), En(Tn(d, p, m, g, 2 ** i), t);
}
function wn(e, t) {
	let n = new Float64Array(e.length);
	for (let r = 0; r < e.length; r += 3) {
		let i = (n) => t[4 * n] * e[r] + t[4 * n + 1] * e[r + 1] + t[4 * n + 2] * e[r + 2] + t[4 * n + 3], a = i(3);
		for (let e = 0; e < 3; e++) n[r + e] = i(e) / a;
	}
	return n;
}
function Tn(e, { faces: t, place: n, chart: r, kinds: i, maps: a }, o, s, c) {
	let l = new Float32Array(3 * n.length), u = new Float32Array(2 * n.length), d = new Float32Array(a.buffer);
	return n.forEach((t, n) => {
		l.set(o.subarray(3 * t, 3 * t + 3), 3 * n);
		let a = 6 * r[n], f = i[r[n]] === 1;
		for (let r = 0; r < 2; r++) {
			let i = a + 2 * r;
			u[2 * n + r] = f ? d[i] * e.points[3 * t] + d[i + 1] * e.points[3 * t + 1] + d[a + 4 + r] : s[2 * n + r] / c;
		}
	}), {
		positions: l,
		uv: u,
		indices: new Uint32Array(t)
	};
}
function En(e, t) {
	let n = (e) => Math.abs(e) <= ye;
	if (!e.positions.every(n) || !e.uv.every(n)) throw j(t, "positions or texture coordinates that are not finite");
	return e;
}
// eigenfield-three/src/name-decoder.ts
var Dn = 4 * N;
async function On(e, t, n) {
	let r = await kn(e, Math.min(he, Dn * t), n), i = r.length / t;
	if (i === 0 || !Number.isInteger(i)) throw j(n, `${r.length} bytes of ${t} names`);
	let a = new TextDecoder("utf-8", {
		fatal: !0,
		ignoreBOM: !0
	}), o = new Uint8Array(i), s = [];
	for (let e = 0; e < t; e++) {
		for (let n = 0; n < i; n++) o[n] = r[n * t + e];
		let c = i;
		for (; c > 0 && o[c - 1] === 0;) --c;
		try {
			s.push(a.decode(o.subarray(0, c)));
		} catch {
			throw j(n, "names that are not UTF-8");
		}
	}
	return s;
}
async function kn(e, t, n) {
	let r = [], i = 0, a = new Blob([Uint8Array.from(e)]).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
	try {
		for (let e = await a.read(); !e.done && i <= t; e = await a.read()) r.push(e.value), i += e.value.length;
	} catch {
		throw j(n, "names that do not inflate");
	}
	if (i > t) throw await a.cancel(), j(n, `more than ${t} bytes of names`);
	let o = new Uint8Array(i), s = 0;
	for (let e of r) o.set(e, s), s += e.length;
	return o;
}
// eigenfield-three/src/headers.ts
function An(e) {
	let t = new DataView(e);
	try {
		return jn(t) ?? Mn(t) ?? Nn(t) ?? Pn(t);
	} catch (e) {
		if (e instanceof RangeError) return null;
		throw e;
	}
}
function V(e, t) {
	return String.fromCharCode(...[
		0,
		1,
		2,
		3
	].map((n) => e.getUint8(t + n)));
}
function jn(e) {
	return e.getUint32(0) !== 2303741511 || e.getUint32(4) !== 218765834 || V(e, 12) !== "IHDR" ? null : {
		type: "image/png",
		width: e.getUint32(16),
		height: e.getUint32(20),
		bits: null
	};
}
function Mn(e) {
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
function Nn(e) {
	if (V(e, 0) !== "RIFF" || V(e, 8) !== "WEBP") return null;
	let t = {
		type: "image/webp",
		bits: null
	}, n = V(e, 12), r = (t) => e.getUint16(t, !0) + 65536 * e.getUint8(t + 2);
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
function Pn(e) {
	if (V(e, 4) !== "ftyp") return null;
	let t = null, n = null, r = (i, a) => {
		for (let o = i; o + 8 <= a;) {
			let i = e.getUint32(o), s = V(e, o + 4), c = i === 0 ? a : o + i;
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
var Fn = {
	colorSpaceConversion: "none",
	premultiplyAlpha: "none"
}, In = {
	"image/avif": "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOltZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAAAAABAAAAHmlsb2MAAAAARAAAAQABAAAAAQAAAQ0AAAAZAAAAKGlpbmYAAAAAAAEAAAAaaW5mZQIAAAAAAQAAYXYwMUNvbG9yAAAAAGhpcHJwAAAASWlwY28AAAAUaXNwZQAAAAAAAAAIAAAACAAAAA5waXhpAAAAAAEIAAAADGF2MUOBABwAAAAAE2NvbHJuY2x4AAEADQAGgAAAABdpcG1hAAAAAAAAAAEAAQQBAoMEAAAAIW1kYXQSAAoIGAi/aYCGg1AyCxlGIYeeaACQQNmg",
	"image/webp": "UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAAAdQwAIWsP+BiOh/AAA="
};
function Ln(e, t, n) {
	let r = An(e);
	if (!r) throw j(t.where, "no picture");
	let { width: i, height: a, bits: o } = r;
	if (n && (i !== n[0] || a !== n[1])) throw j(t.where, `a picture of ${i} x ${a}, not of ${n[0]} x ${n[1]}`);
	if (t.codec.bits !== 8 && t.codec.bits !== o) throw j(t.where, `no picture of ${t.codec.bits} bits`);
	let s = i * a;
	if (!s || i > 16384 || a > 32768 || s > ue) throw j(t.where, `a picture of ${i} x ${a}`);
	return [i, a];
}
async function Rn(e, t, n, r) {
	let [i, a] = Ln(e, t, n), [o, s] = [Math.ceil(i / r), Math.ceil(a / r)], c = r === 1 ? {} : {
		resizeWidth: o,
		resizeHeight: s,
		resizeQuality: "high"
	}, l = An(e)?.type ?? t.codec.mimeType, u;
	try {
		u = await createImageBitmap(new Blob([e], { type: l }), {
			...Fn,
			...c
		});
	} catch (e) {
		throw await Bn(l) ? j(t.where, "it cannot be decoded") : Vn(l, t, e);
	}
	if (u.width === o && u.height === s) return u;
	throw u.close(), j(t.where, `decoded to ${u.width} x ${u.height}, not to ${o} x ${s}`);
}
var zn = async (e, t, n, r = 1) => {
	let i = t.pieces * t.textures, [a, o] = Ln(e, t, n && [n[0], i * n[1]]), s = await Rn(e, t, [a, o], i === 1 ? r : 1);
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
		...Fn,
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
async function Bn(e) {
	let t = In[e];
	if (!t) return !0;
	let n = Uint8Array.from(atob(t), (e) => e.charCodeAt(0));
	try {
		return (await createImageBitmap(new Blob([n], { type: e }))).close(), !0;
	} catch {
		return !1;
	}
}
function Vn(e, t, n) {
	return new A("codec", `This browser cannot decode ${e.replace("image/", "").toUpperCase()} pictures; use a newer one, or encode the scene with --codec png.`, t.where, { cause: n });
}
// eigenfield-three/src/pictures-10bit.ts
var Hn = /* @__PURE__ */ new Set([
	"I420P10",
	"I422P10",
	"I444P10"
]), Un = async (e, t, n, r = 1) => {
	let i = t.pieces * t.textures, [a, o] = Ln(e, t, n && [n[0], i * n[1]]), s = await Wn(e, a, o);
	if (!s) return zn(e, t, n, r);
	let c = o / i;
	return Array.from({ length: i }, (e, t) => {
		if (r === 1) return {
			picture: s,
			row: t * c,
			rows: c
		};
		let n = Gn(s, t * c, c, r);
		return {
			picture: n,
			row: 0,
			rows: n.height
		};
	});
};
async function Wn(e, t, n) {
	if (typeof ImageDecoder > "u") return null;
	let r = null, i = null;
	try {
		r = new ImageDecoder({
			data: e,
			type: "image/avif"
		}), i = (await r.decode()).image;
		let a = i.visibleRect;
		if (!Hn.has(i.format ?? "") || a?.width !== t || a.height !== n) return null;
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
function Gn(e, t, n, r) {
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
var Kn = 5;
function qn(e, t) {
	let n = L(e, Kn, t).getUint32(1, !0);
	Ne(e, 3 * n, 6 * M, t);
	let r = Ge(e.subarray(Kn)), i = Ye(r, n, 3, !0);
	r.checkEnd(t);
	let a = i.map((e, t) => t % 3 ? i[t - t % 3] + e : e);
	if (!a.every((e) => e >= 0 && e < 1e5)) throw j(t, "triangles of cameras that there cannot be");
	return { corners: Uint32Array.from(a) };
}
// eigenfield-three/src/weight-decoder.ts
var Jn = 14, Yn = 2 ** 20;
function Xn(e, t) {
	let n = L(e, Jn, t), r = n.getUint8(1) === 1, [i, a] = [n.getUint32(6, !0), n.getUint32(10, !0)], o = r ? n.getUint16(2, !0) : 1, s = r ? n.getUint16(4, !0) : i;
	if (n.getUint8(1) > 1 || i === 0) throw j(t, "weights of no camera, or of an unknown kind");
	Ne(e, o * s * Math.max(a, 1), ve, t), L(e, Jn + 4 * a, t);
	let c = o * s;
	if (c < i) throw j(t, "a grid with too few cells");
	let l = Ge(e.subarray(Jn + 4 * a)), u = r ? Xe(l, c, i, t) : null, d = u !== null && i === c, f = [
		0,
		1,
		2
	].map(() => new Float64Array(c)), p = new Float32Array(i * a), m = 4 * Yn * Math.max(o, s);
	for (let e = 0; e < a; e++) {
		let r = n.getFloat32(Jn + 4 * e, !0);
		if (!(r > 0 && r < Infinity)) throw j(t, "a step that is not positive");
		let i = Ke(l), h = Je(l, s, f[i], i);
		if (i === 2 && !d || h.some((e) => Math.abs(e) > m)) throw j(t, `numbers of component ${e} that cannot be`);
		f[i] = h;
		let g = i === 2 ? Zn(h, o, s) : h;
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
function Zn(e, t, n) {
	let r = new Float64Array(t * n), i = new Float64Array(t * n), a = Qn(n);
	for (let i = 0; i < t; i++) for (let t = 0; t < n; t++) {
		let o = 0;
		for (let r = 0; r < n; r++) o += a(r, t) * e[i * n + r];
		r[i * n + t] = o;
	}
	let o = Qn(t);
	for (let e = 0; e < t; e++) for (let a = 0; a < n; a++) {
		let s = 0;
		for (let i = 0; i < t; i++) s += o(i, e) * r[i * n + a];
		i[e * n + a] = s;
	}
	return i;
}
function Qn(e) {
	let [t, n] = [Math.sqrt(1 / e), Math.sqrt(2 / e)], r = Float64Array.from({ length: 4 * e }, (t, r) => n * Math.cos(Math.PI * r / (2 * e)));
	return (n, i) => n === 0 ? t : r[(2 * i + 1) * n % (4 * e)];
}
// eigenfield-three/src/codecs.ts
function $n(e) {
	let [t, n] = [zn, zn];
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
var H = {
	"mesh-1": {
		kind: "mesh",
		decode: Cn,
		needs: "codedMesh",
		limits: ["MAX_VERTICES", "MAX_TRIANGLES"]
	},
	"cameras-1": {
		kind: "cameras",
		decode: et,
		needs: "codedCameras",
		limits: ["MAX_CAMERAS"]
	},
	"names-1": {
		kind: "names",
		decode: On,
		needs: "codedNames",
		limits: ["MAX_NAMES", "MAX_CAMERAS"]
	},
	"triangles-1": {
		kind: "triangles",
		decode: qn,
		needs: "codedTriangles",
		limits: ["MAX_CAMERAS"]
	},
	"weights-1": {
		kind: "weights",
		decode: Xn,
		needs: "codedWeights",
		limits: ["MAX_WEIGHTS"]
	},
	png: $n("image/png"),
	webp: $n("image/webp"),
	avif: $n("image/avif"),
	jpeg: $n("image/jpeg"),
	"av1-10bit-1": {
		...$n("image/avif"),
		bits: 10,
		decode: Un,
		needs: "bits"
	}
}, er = {
	mesh: "mesh-1",
	cameras: "cameras-1",
	names: "names-1",
	triangles: "triangles-1",
	weights: "weights-1"
};
function tr(e, t, n) {
	let r = t.exists ? t.text(N) : n, i = Object.hasOwn(H, r) ? H[r] : null;
	if (i?.kind === e) return i;
	throw new A("codec-unknown", `${`A ${e} stream has the codec "${r.slice(0, 60)}", which this viewer does not know`}; take a newer viewer.`, t.where);
}
function nr(e, t) {
	return Object.keys(H).find((n) => {
		let r = H[n];
		return r.kind === "picture" && r.mimeType === e && r.bits === t;
	});
}
// eigenfield-three/src/json.ts
var rr = class e {
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
	number(e = -ye, t = ye) {
		if (typeof this.raw != "number") throw this.wrong("no number");
		if (!(this.raw >= e && this.raw <= t)) throw this.wrong(`${this.raw} is not in ${e}..${t}`);
		return this.raw;
	}
	integer(e, t) {
		let n = this.number(e, t);
		if (!Number.isInteger(n)) throw this.wrong(`${n} is no whole number`);
		return n;
	}
	numbers(e, t = -ye, n = ye) {
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
}, ir = 5121, ar = 5123, or = 5125, U = 5126, sr = {
	[ir]: 1,
	[ar]: 2,
	[or]: 4,
	[U]: 4
}, cr = /* @__PURE__ */ new Set([
	"cameras",
	"triangles",
	"weights"
]), lr = {
	SCALAR: 1,
	VEC2: 2,
	VEC3: 3
};
function ur(e) {
	let t = e.key("buffers").at(0);
	if (t.key("uri").exists) throw t.wrong("not the binary chunk");
	let n = t.key("byteLength").integer(0, 2 ** 32 - 1);
	return e.key("bufferViews").items(se).map((e) => {
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
function dr(e) {
	return (t) => t.integer(0, e.length - 1);
}
function fr(e, t) {
	let n = e.key("accessors").items(se);
	return (e, r, i, a) => {
		let o = n[e.integer(0, n.length - 1)];
		if (!o) throw e.wrong("no such accessor");
		let s = o.key("componentType").integer(5120, 5126);
		if (!i.includes(s)) throw o.wrong(`component type ${s}`);
		if (o.key("type").text(1024) !== r) throw o.wrong(`not ${r}`);
		if (o.key("sparse").exists) throw o.wrong("sparse");
		let c = o.key("normalized");
		if (c.exists && c.raw !== !1) throw o.wrong("normalised");
		let l = lr[r] ?? 1, u = o.key("count").integer(1, ve);
		if (a !== null && u !== a) throw o.wrong(`${a} numbers are needed, not ${u}`);
		let d = o.key("bufferView").integer(0, t.length - 1), f = t[d];
		if (!f) throw o.wrong("no such buffer view");
		let p = o.key("byteOffset"), m = p.exists ? p.integer(0, f.length) : 0, h = sr[s] * l;
		if (f.stride && (f.stride < h || r === "SCALAR")) throw o.wrong("a stride that cannot be");
		if (m + (u - 1) * (f.stride || h) + h > f.length) throw o.wrong("outside its buffer view");
		if ((m + f.offset) % sr[s]) throw o.wrong("not aligned");
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
function pr(e, t, n) {
	let r = typeof t.raw == "number" && cr.has(e), i = tr(e, r ? new rr(void 0, t.where) : t.key("codec"), er[e]);
	return {
		view: n(r ? t : t.key("bufferView")),
		codec: i,
		where: t.where
	};
}
async function mr(e, t, n) {
	let r = await n(e.view), i = t[e.view]?.length ?? Infinity;
	if (r.byteLength < i) throw re(e.where);
	let { offset: a, count: o, items: s, type: c } = e, l = r.slice(a, a + sr[c] * o * s);
	return c === 5125 ? new Uint32Array(l) : c === 5123 ? new Uint16Array(l) : hr(new Float32Array(l), e.where);
}
function hr(e, t) {
	for (let n of e) if (!(Math.abs(n) <= 1e30)) throw j(t, `${n} among its numbers`);
	return e;
}
// eigenfield-three/src/planes.ts
var W = 8, gr = 16;
function _r(e, t) {
	return new A("unsupported", `The scene has ${e}, which this viewer does not draw; draw it with "eigenfield render".`, t);
}
function vr(e, t = ce) {
	let [n = 0, r = 0] = e.items(2).map((e) => e.integer(1, t));
	if (!n || !r) throw e.wrong("two numbers are needed");
	if (n * r > ue) throw e.wrong(`more than ${ue} texels`);
	return [n, r];
}
function yr(e, t, n, r, i) {
	let a = e.key("planes").items(16);
	if (!a.length) throw e.key("planes").wrong("no plane");
	let o = a.map((e, a) => {
		let o = e.key("channels").integer(1, 64), s = Dr(e, o, a === 0 ? n : null, i), c = e.key("bases").items(64), l = (e) => kr(e, o, t, r, i);
		return {
			channels: o,
			...s,
			bases: c.map(l)
		};
	}), [s, c] = [0, 0];
	for (let { channels: e, meanSize: t, bases: n } of o) {
		s += 4 * e * (t ? t[0] * t[1] : 0);
		for (let { size: t, count: r, pictures: i } of n) {
			let n = i.reduce((e, { textures: t, codec: n }) => e + t * (n.bits === W ? 1 : 2), 0);
			s += t[0] * t[1] * e * n, c += r;
		}
	}
	if (c > 4096) throw e.key("planes").wrong(`more than ${de} textures`);
	if (s > fe) throw e.key("planes").wrong("too large when it is decoded");
	return o;
}
function br(e, t) {
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
	throw _r(`${t.length > 1 ? `${t.length} planes` : `${n} channels`} and no colours for them`, `${e.where}/planes`);
}
function xr(e, t, n, r, i, a = !1) {
	let o = Sr(e), s = t === 3 && o.bits === W ? 1 : t;
	r && Ar(e, s * n, r);
	let [c, l] = [e.key("scale"), e.key("zero")], u = {
		view: i(e.key("bufferView")),
		codec: o,
		textures: n,
		pieces: s,
		where: e.where
	};
	return a && o.bits === W && !c.exists && !l.exists ? {
		...u,
		...Cr(t)
	} : {
		...u,
		scale: Er(c, t, n),
		zero: Er(l, t, n)
	};
}
function Sr(e) {
	let t = e.key("mimeType").text(N);
	if (!nr(t, W)) throw e.key("mimeType").wrong("an unknown type");
	let n = e.key("bits"), r = n.exists ? n.integer(1, gr) : W, i = nr(t, r);
	if (!i) throw n.wrong(`${r} bits of ${t}`);
	let a = e.key("codec"), o = tr("picture", a, i);
	if (o.mimeType !== t || o.bits !== r) throw a.wrong(`${r} bits of ${t}`);
	return o;
}
function Cr(e) {
	return {
		scale: Array(e).fill(1 / 255),
		zero: Array(e).fill(0)
	};
}
function wr(e) {
	return e.some(({ codec: e }) => e.bits > W);
}
function Tr({ codec: e }) {
	return (2 ** e.bits - 1) / 255;
}
function Er(e, t, n) {
	let r = e.items(t * n).map((e) => e.number());
	if (r.length === t * n) return r;
	if (r.length !== t) throw e.wrong(`${t} or ${t * n} numbers are needed`);
	return Array(n).fill(r).flat();
}
function Dr(e, t, n, r) {
	let i = e.key("mean");
	if (!i.exists) {
		if (n === null || t !== 1 && t !== 3) throw i.wrong("no mean");
		return {
			mean: {
				view: n,
				codec: H.png,
				textures: 1,
				pieces: 1,
				where: "/images/0",
				...Cr(t)
			},
			meanSize: null,
			precision: null
		};
	}
	let a = vr(i.key("size")), o = xr(i, t, 1, a, r, !0);
	return {
		mean: o,
		meanSize: a,
		precision: Or(i.key("precision"), o, r)
	};
}
function Or(e, t, n) {
	if (!e.exists) return null;
	if (t.codec.bits === W) throw e.wrong(`of a mean of ${W} bits`);
	let r = vr(e.key("size"), le), i = tr("picture", e.key("codec"), "png");
	if (i !== H.png) throw e.key("codec").wrong("no PNG");
	return {
		view: n(e.key("bufferView")),
		codec: i,
		size: r,
		textures: 1,
		pieces: 1,
		where: e.where
	};
}
function kr(e, t, n, r, i) {
	let a = vr(e.key("size")), [o, s] = [e.key("grid"), e.key("corner")], c = o.exists ? vr(o) : a, [l = 0, u = 0] = s.exists ? s.numbers(2, 0, ce) : [];
	if (!Number.isInteger(l) || !Number.isInteger(u)) throw s.wrong("no whole numbers");
	if (l + a[0] > c[0] || u + a[1] > c[1]) throw e.wrong("textures beyond their grid");
	let d = 0, f = e.key("picture"), p = f.exists ? f.object() : {}, m = e.key("textures").items(de).map((e) => {
		let n = new rr({
			...p,
			...e.object()
		}, e.where), r = n.key("count"), o = r.exists ? r.integer(1, de) : 1;
		return d += o, xr(n, t, o, a, i);
	});
	if (d > 4096) throw e.wrong(`more than ${de} textures`);
	let h = e.key("codedWeights"), g = d ? h.exists ? pr("weights", h, i) : r(e.key("weights"), "SCALAR", [U], n * d) : null;
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
function Ar(e, t, [n, r]) {
	let i = t * r;
	if (t > 1 && i > 32768) throw e.wrong(`a picture of ${i} rows`);
	if (n * i > ue) throw e.wrong(`more than ${ue} texels`);
}
// eigenfield-three/src/document.ts
var jr = [
	"namePattern",
	"precision",
	"regions",
	"sharedPicture",
	"stacks",
	"toRGB"
], Mr = Object.values(H).flatMap(({ needs: e }) => e ?? []), Nr = /* @__PURE__ */ new Set([...jr, ...Mr]), Pr = 64, Fr = 9, Ir = 10 ** Fr;
function Lr(e) {
	let t = new rr(e, "");
	try {
		return t.key("extensions").key(ae).exists;
	} catch {
		return !1;
	}
}
function Rr(e) {
	let t = new rr(e, ""), n = t.key("extensions").key(ae), r = zr(n), i = ur(t), a = fr(t, i), o = dr(i);
	Br(t);
	let s = Ur(t, o), c = n.key("cameras"), { count: l, names: u } = Wr(c, o), d = qr(c, l), f = d.filter((e) => !e).length, p = yr(n, f, s, a, o), m = br(n, p), h = c.key("colour");
	if (h.exists && m.length < 3) throw h.wrong("needs three channels");
	let g = n.key("viewPlane"), [_, v] = [g.key("triangles"), g.key("codedTriangles")], y = t.key("meshes").at(0).key("primitives").at(0), b = y.key("mode");
	if (b.exists && b.integer(0, 6) !== 4) throw b.wrong("no triangles");
	let [x, S] = [y.key("attributes"), y.key("indices")], C = n.key("generator"), w = n.key("mesh");
	return {
		version: r,
		generator: C.exists ? C.text(N) : "",
		planes: p,
		colours: m,
		names: u,
		heldOut: d,
		reference: n.key("reference").integer(0, l - 1),
		calibration: Jr(c, l, a, o),
		sizes: Yr(c, l, a),
		colour: h.exists ? a(h, "SCALAR", [U], 6 * l) : null,
		...Xr(g),
		triangles: v.exists ? pr("triangles", v, o) : _.exists ? Hr(a(_, "SCALAR", [ar, or], null), 2 * M) : null,
		settings: Zr(n.key("settings")),
		scores: Zr(n.key("scores")),
		views: i,
		mesh: w.exists ? pr("mesh", w, o) : null,
		position: Vr(a(x.key("POSITION"), "VEC3", [U], null), ge),
		uv: Vr(a(x.key("TEXCOORD_0"), "VEC2", [U], null), ge),
		indices: Hr(a(S, "SCALAR", [
			ir,
			ar,
			or
		], null), _e),
		preview: s
	};
}
function zr(e) {
	let t = e.key("version").text(N);
	if (!/^1\.\d+$/.test(t)) throw new A("version", `The scene is of format version ${t.slice(0, 20)} and this viewer reads 1.x; take a newer viewer.`, `${e.where}/version`);
	let n = e.key("needs");
	for (let e of n.exists ? n.items(se) : []) {
		let t = e.text(N);
		if (!Nr.has(t)) throw new A("needs", `The scene needs "${t.slice(0, 60)}", which this viewer cannot draw; take a newer viewer.`, e.where);
	}
	return t;
}
function Br(e) {
	let t = e.key("nodes").items(se), n = Array(t.length).fill(!1);
	for (let e of t) {
		let r = e.key("children");
		for (let e of r.exists ? r.items(t.length) : []) {
			let r = e.integer(0, t.length - 1);
			if (n[r]) throw e.wrong("a node with two parents");
			n[r] = !0;
		}
	}
	for (let r of e.key("scenes").items(se)) {
		let e = r.key("nodes");
		for (let r of e.exists ? e.items(t.length) : []) if (n[r.integer(0, t.length - 1)]) throw r.wrong("a node with two parents");
	}
}
function Vr(e, t) {
	if (e.count > t) throw j(e.where, `more than ${t}`);
	return e;
}
function Hr(e, t) {
	if (e.count % 3) throw j(e.where, "torn triangles");
	return Vr(e, 3 * t);
}
function Ur(e, t) {
	let n = e.key("images");
	if (!n.exists) return null;
	let r = n.at(0).key("bufferView");
	return r.exists ? t(r) : null;
}
function Wr(e, t) {
	let n = e.key("codedNames");
	if (n.exists) return {
		count: n.key("count").integer(1, M),
		names: pr("names", n, t)
	};
	let r = e.key("pattern"), i = r.exists ? r : e.key("names"), a = r.exists ? Kr(r) : i.items(M).map((e) => e.text(N));
	if (!a.length) throw i.wrong("no cameras");
	let o = Gr(a);
	if (o) throw i.wrong(o);
	return {
		count: a.length,
		names: a
	};
}
function Gr(e) {
	return new Set(e).size === e.length ? e.some((e) => /[\u0000-\u001f\u007f-\u009f]/.test(e)) ? "control characters" : null : "a name stands twice";
}
function Kr(e) {
	let [t = 0, n = 0] = e.key("counts").items(2).map((e) => e.integer(1, M));
	if (!n || t * n > 1e5) throw e.wrong("no counts of rows and columns");
	let r = e.key("parts").items(Pr).map((e) => {
		if (typeof e.raw == "string") return [0, Array(t).fill(e.text(N))];
		let r = e.key("axis").integer(0, 1), i = r ? n : t, a = e.key("texts");
		if (a.exists) {
			let e = a.items(i).map((e) => e.text(N));
			if (e.length !== i) throw a.wrong(`${i} texts are needed`);
			return [r, e];
		}
		let [o, s] = [e.key("first").integer(0, Ir), e.key("step").integer(0, Ir)], c = e.key("digits").integer(1, Fr);
		return [r, Array.from({ length: i }, (e, t) => String(o + s * t).padStart(c, "0"))];
	});
	return Array.from({ length: t * n }, (t, i) => {
		let a = [Math.floor(i / n), i % n], o = r.map(([e, t]) => t[a[e] ?? 0]).join("");
		if (o.length > 1024) throw e.wrong(`names of more than ${N} characters`);
		return o;
	});
}
function qr(e, t) {
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
function Jr(e, t, n, r) {
	let i = e.key("coded");
	return i.exists ? pr("cameras", i, r) : {
		intrinsics: n(e.key("intrinsics"), "SCALAR", [U], 5 * t),
		poses: n(e.key("poses"), "SCALAR", [U], 12 * t)
	};
}
function Yr(e, t, n) {
	let r = e.key("size");
	if (!r.exists) return n(e.key("sizes"), "SCALAR", [or], 2 * t);
	let [i = 0, a = 0] = r.numbers(2, 1, pe);
	if (!Number.isInteger(i) || !Number.isInteger(a)) throw r.wrong("no whole numbers");
	return [i, a];
}
function Xr(e) {
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
function Zr(e) {
	return e.exists ? e.object() : {};
}
// eigenfield-three/src/info.ts
var Qr = 1e-6;
async function $r(e, t) {
	let [n, { lenses: r, poses: i }, a, o] = await Promise.all([
		ei(e, t),
		ni(e, t),
		ri(e, t),
		e.colour ? mr(e.colour, e.views, t) : null
	]);
	return n.map((t, n) => {
		let [s = 0, c = 0, l = 0, u = 0, d = 0] = r.numbers.subarray(5 * n, 5 * n + 5);
		if (!(s > Qr && c > Qr)) throw j(r.where, `focal lengths of "${t}"`);
		let { R: f, t: p } = ii([...i.numbers.subarray(12 * n, 12 * n + 12)], i.where, t), [m = 0, h = 0] = a.numbers.subarray(2 * n, 2 * n + 2);
		if (!m || !h || Math.max(m, h) > 65535 || m * h > me) throw j(a.where, `"${t}" is ${m} x ${h} pixels`);
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
		], [_, v] = o ? ai([...o.subarray(6 * n, 6 * n + 6)], e, t) : [null, null];
		return {
			name: t,
			K: g,
			R: f,
			t: p,
			centre: hi(f, p),
			width: m,
			height: h,
			gain: _,
			offset: v
		};
	});
}
async function ei({ names: e, heldOut: t }, n) {
	if (Array.isArray(e)) return e;
	let r = await e.codec.decode(new Uint8Array(await n(e.view)), t.length, e.where), i = r.some((e) => e.length > 1024) ? "names that are too long" : Gr(r);
	if (i) throw j(e.where, i);
	return r;
}
async function ti(e, t, n) {
	return {
		numbers: await mr(e, t.views, n),
		where: e.where
	};
}
async function ni(e, t) {
	let { calibration: n, heldOut: r } = e;
	if ("intrinsics" in n) {
		let { intrinsics: r, poses: i } = n;
		return {
			lenses: await ti(r, e, t),
			poses: await ti(i, e, t)
		};
	}
	let { view: i, codec: a, where: o } = n, s = a.decode(new Uint8Array(await t(i)), o), c = s.poses.length / 12;
	if (c !== r.length) throw j(o, `${c} cameras in it, and ${r.length} names`);
	let l = (e) => ({
		numbers: hr(e, o),
		where: o
	});
	return {
		lenses: l(s.intrinsics),
		poses: l(s.poses)
	};
}
async function ri(e, t) {
	if (!Array.isArray(e.sizes)) return ti(e.sizes, e, t);
	let [n, r] = e.sizes;
	return {
		numbers: Uint32Array.from({ length: 2 * e.heldOut.length }, (e, t) => t % 2 ? r : n),
		where: "its cameras' size"
	};
}
function ii(e, t, n) {
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
		let a = K(i[e], i[r]) - +(e === r);
		if (!(Math.abs(a) <= 2e-4)) throw j(t, `the pose of "${n}" is no rotation`);
	}
	if (!(K(q(i[0], i[1]), i[2]) > 0)) throw j(t, `the pose of "${n}" is mirrored`);
	return {
		R: i,
		t: a
	};
}
function ai(e, t, n) {
	let [r, i] = [e.slice(0, 3), e.slice(3)];
	if (!(r.every((e) => e >= 1 / 1e3 && e <= 1e3) && i.every((e) => Math.abs(e) <= 1e3))) throw j(t.colour?.where ?? "", `gain or offset of "${n}"`);
	return [r, i];
}
async function oi(e, t) {
	let n = G(e), r = e.heldOut.filter((e) => !e).length, i = await Promise.all(n.map((n) => si(n, r, e, t))), a = n.reduce((e, { count: t }) => e + t, 0), o = new Float32Array(r * a), s = 0;
	for (let e of i) {
		let t = e.length / r;
		for (let n = 0; n < r; n++) o.set(e.subarray(n * t, (n + 1) * t), n * a + s);
		s += t;
	}
	return o;
}
async function si({ weights: e, count: t }, n, r, i) {
	if (!e) return /* @__PURE__ */ new Float32Array();
	if ("type" in e) return mr(e, r.views, i);
	let { view: a, codec: o, where: s } = e, { cameras: c, components: l, values: u } = o.decode(new Uint8Array(await i(a)), s);
	if (c === n && l === t) return hr(u, s);
	throw j(s, `${c} x ${l} weights, and ${n} encoded cameras x ${t} textures`);
}
function G(e) {
	return e.planes.flatMap(({ bases: e }) => e);
}
function ci(e) {
	return Math.max(0, ...G(e).map(({ count: e }) => e));
}
function li(e, t) {
	let n = [...t, ...G(e).map(({ grid: e }) => e)];
	return [Math.max(...n.map(([e]) => e)), Math.max(...n.map(([, e]) => e))];
}
async function ui(e, t) {
	if (!e.triangles) return /* @__PURE__ */ new Uint32Array();
	let { where: n } = e.triangles, r = await di(e.triangles, e, t), i = e.heldOut.filter((e) => !e).length;
	for (let e = 0; e < r.length; e += 3) {
		let [t = i, a = i, o = i] = r.subarray(e, e + 3);
		if (Math.max(t, a, o) >= i) throw j(n, `no encoded camera ${Math.max(t, a, o)}`);
		if (t === a || a === o || o === t) throw j(n, "a triangle with one camera twice");
	}
	return r;
}
async function di(e, t, n) {
	return "type" in e ? Uint32Array.from(await mr(e, t.views, n)) : e.codec.decode(new Uint8Array(await n(e.view)), e.where).corners;
}
function fi(e, t, n, r, i, a) {
	let { right: o, up: s } = e, c = q(o, s), l = [
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
		bytes: pi(e, i),
		size: li(e, n),
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
		facesPlane: Math.abs(K(l, c)) > .7
	};
}
function pi(e, t) {
	let n = /* @__PURE__ */ new Set(), r = (t) => n.has(t) ? 0 : (n.add(t), e.views[t]?.length ?? 0), i = (e) => e.reduce((e, t) => e + r(t), 0), a = e.planes.flatMap(({ mean: e, precision: t }) => [e.view, ...t ? [t.view] : []]), o = i(e.preview === null ? a : [e.preview, ...a]), s = Array(ci(e)).fill(0);
	for (let { pictures: t } of G(e)) {
		let e = 0;
		for (let { view: n, textures: i } of t) {
			let t = r(n);
			for (let n = 0; n < i; n++) {
				let r = Math.floor(t * (n + 1) / i) - Math.floor(t * n / i);
				s[e] = (s[e++] ?? 0) + r;
			}
		}
	}
	let c = i(G(e).flatMap((e) => e.weights ? [e.weights.view] : [])), { position: l, uv: u, indices: d } = e, f = i([
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
function mi(e, t) {
	let { origin: n, extent: r } = e, i = [
		t[0] - n[0],
		t[1] - n[1],
		t[2] - n[2]
	];
	return [r[0] > 0 ? K(i, e.right) / r[0] : 0, r[1] > 0 ? K(i, e.up) / r[1] : 0];
}
function hi(e, t) {
	let n = (n) => -(e[0][n] * t[0] + e[1][n] * t[1] + e[2][n] * t[2]);
	return [
		n(0),
		n(1),
		n(2)
	];
}
function K(e, t) {
	return e[0] * t[0] + e[1] * t[1] + e[2] * t[2];
}
function q(e, t) {
	return [
		e[1] * t[2] - e[2] * t[1],
		e[2] * t[0] - e[0] * t[2],
		e[0] * t[1] - e[1] * t[0]
	];
}
// eigenfield-three/src/cameras.ts
function gi(e, t, n) {
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
		let r = _i(n, o, s);
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
	let u = yi(l), { origin: d, right: f, up: p, extent: m } = r.viewPlane, [h, g] = [vi(t) * m[0], vi(n) * m[1]], _ = [
		0,
		1,
		2
	].map((e) => d[e] + h * f[e] + g * p[e]), v = u.map((e) => -K(e, _));
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
function _i({ K: e, width: t, height: n }, r, i) {
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
function vi(e) {
	return Math.min(1, Math.max(-1, e));
}
function yi(e) {
	let t = e;
	for (let e = 0; e < 50; e++) {
		let e = [
			q(t[1], t[2]),
			q(t[2], t[0]),
			q(t[0], t[1])
		], n = K(t[0], e[0]);
		if (!(n > 1e-12)) break;
		let r = t.map((t, r) => t.map((t, i) => (t + e[r][i] / n) / 2)), i = Math.max(...r.flatMap((e, n) => e.map((e, r) => Math.abs(e - t[n][r]))));
		if (t = r, i < 1e-15) break;
	}
	return t;
}
function bi(e, t, n, r, i = 1) {
	let a = n.width / n.height, o = i * Math.min(1, a / r), s = i * Math.min(1, r / a), c = {
		left: (1 - o) / 2,
		top: (1 - s) / 2,
		width: o,
		height: s
	};
	return xi(e, t, n), Si(e, t, n, c), t.aspect = r, t.fov = 2 * Math.atan(n.height / (2 * n.K[1][1] * s)) * 180 / Math.PI, c;
}
function xi(e, t, n) {
	let { R: r, centre: i } = n, a = new _().set(r[0][0], -r[1][0], -r[2][0], i[0], r[0][1], -r[1][1], -r[2][1], i[1], r[0][2], -r[1][2], -r[2][2], i[2], 0, 0, 0, 1);
	e.mesh.updateWorldMatrix(!0, !1), a.premultiply(e.mesh.matrixWorld), t.parent && (t.parent.updateWorldMatrix(!0, !1), a.premultiply(t.parent.matrixWorld.clone().invert())), a.decompose(t.position, t.quaternion, new O()), t.updateMatrixWorld(!0);
}
function Si(e, t, n, r) {
	let [[i, a, o], [, s, c]] = n.K, [l, u] = [2 * r.width / n.width, 2 * r.height / n.height], [d, f] = Ci(e, n);
	t.near = d, t.far = f, t.projectionMatrix.set(l * i, -l * a, -(2 * r.left - 1 + l * o), 0, 0, u * s, -(1 - 2 * r.top - u * c), 0, 0, 0, -(f + d) / (f - d), -2 * f * d / (f - d), 0, 0, -1, 0), t.projectionMatrixInverse.copy(t.projectionMatrix).invert();
}
function Ci(e, t) {
	let { geometry: n, matrixWorld: r } = e.mesh;
	n.boundingSphere || n.computeBoundingSphere();
	let { center: i, radius: a } = n.boundingSphere ?? {
		center: new O(),
		radius: 1
	}, o = r.getMaxScaleOnAxis(), s = i.distanceTo(new O(...t.centre)) * o, c = 1.01 * (s + a * o);
	return [Math.max(.5 * (s - a * o), c * 2e-4), c];
}
// eigenfield-three/src/footprint.ts
var wi = 256;
function Ti(e, t, n) {
	let { index: r } = e, i = e.getAttribute("position"), a = e.getAttribute("uv");
	if (!r || !i || !a) return 0;
	let o = r.count / 3, s = Math.max(1, Math.floor(o / wi)), c = [];
	for (let e = 0; e < o; e += s) {
		let o = [
			0,
			1,
			2
		].map((t) => r.getX(3 * e + t)), s = o.map((e) => Ei(t, i.getX(e), i.getY(e), i.getZ(e))), l = Di(s), [u = NaN, d = NaN] = [0, 1].map((e) => s.reduce((t, n) => t + (n[e] ?? NaN) / 3, 0));
		if (!(l > 0 && u >= 0 && d >= 0 && u < t.width && d < t.height)) continue;
		let f = Di(o.map((e) => [a.getX(e) * n[0], a.getY(e) * n[1]]));
		c.push({
			footprint: Math.sqrt(f / l),
			area: l
		});
	}
	c.sort((e, t) => e.footprint - t.footprint);
	let l = c.reduce((e, { area: t }) => e + t, 0) / 2, u = 0;
	return c.find(({ area: e }) => (u += e) >= l)?.footprint ?? 0;
}
function Ei({ K: e, R: t, t: n }, r, i, a) {
	let o = (e) => t[e][0] * r + t[e][1] * i + t[e][2] * a + n[e], [s, c, l] = [
		o(0),
		o(1),
		o(2)
	];
	return l > 0 ? [(e[0][0] * s + e[0][1] * c) / l + e[0][2], e[1][1] * c / l + e[1][2]] : [NaN, NaN];
}
function Di(e) {
	let [[t = 0, n = 0] = [], [r = 0, i = 0] = [], [a = 0, o = 0] = []] = e;
	return Math.abs((r - t) * (o - n) - (i - n) * (a - t)) / 2;
}
// eigenfield-three/src/memory.ts
var Oi = 4 / 3, ki = 4, Ai = 8, ji = 2, Mi = 2 ** 20;
function Ni() {
	let e = typeof navigator > "u" ? void 0 : navigator, t = e?.deviceMemory, n = e?.userAgent ?? "";
	return /Mobi|Android|iPhone|iPad|Quest/i.test(n) || /Macintosh/.test(n) && Pi(e) ? Math.min(t ?? 4, 6) * 128 * Mi : Math.min(t ?? 8, 8) * 256 * Mi;
}
function Pi(e) {
	return (e?.maxTouchPoints ?? 0) > 1;
}
function J([e, t], n) {
	return [Math.ceil(e / n), Math.ceil(t / n)];
}
function Fi(e, t) {
	let [n, r] = J(e, t);
	return n * r;
}
function Ii(e) {
	return Math.ceil(e / 4);
}
function Li(e, t) {
	return t * Ri(e);
}
function Ri(e) {
	return Math.max(1, Math.ceil(e / 4));
}
function zi(e) {
	let { atlas: t, means: n, bases: r } = e, i = [
		t,
		...n.map(({ size: e }) => e),
		...r.map(({ grid: e }) => e)
	];
	return [...new Map(i.map((e) => [e.join(), e])).values()];
}
function Bi(e, t) {
	let n = Math.max(0, ...e.bases.map(({ count: e }) => e)), r = Math.max(1, ...e.bases.map((e) => e.channels)), i = Math.min(n, 4 * Math.floor(t.layers / r)), a = [
		1,
		2,
		4,
		8,
		16
	].find((n) => Math.max(...e.atlas) / n <= t.side && Vi(e, n) <= t.memory / 2) ?? 16, o = Vi(e, a) + e.geometry, s = (t, n) => o + Ui(e, t, n), c = (n, r) => s(n, r) + Ki(e, n) <= t.memory, l = Math.max(1, ...e.bases.flatMap(({ size: e }) => e)), u = (e) => l / e <= t.side, d = [
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
		limitation: qi(p, n, e, t)
	};
}
function Vi(e, t) {
	let n = e.means.map((e) => Hi(e) * Ii(e.channels) * Fi(e.size, t)), r = zi(e).map((n) => {
		let r = n.join() === e.atlas.join() ? Oi : 1, i = e.rays && e.bases.some(({ grid: e }) => e.join() === n.join());
		return Ai * Fi(n, t) * (r + +!!i);
	});
	return Math.round([...n, ...r].reduce((e, t) => e + t, 0));
}
function Hi({ tenBits: e }) {
	return e ? Ai : ki;
}
function Ui({ bases: e, rays: t }, n, r) {
	return e.reduce((e, i) => {
		let a = Math.min(r, i.count);
		if (!a) return e;
		let o = t ? Ri(a) * 129 * 129 * Ai : 0;
		return e + Hi(i) * Li(a, i.channels) * Fi(i.size, n) + o;
	}, 0);
}
function Wi({ means: e, bases: t }, n, r) {
	return Gi([...e.filter(({ pieces: e, tenBits: t }) => e > 1 || t).map(({ size: e }) => J(e, n)), ...t.filter(({ count: e }) => e > 0).map(({ size: e }) => J(e, r))]);
}
function Gi(e) {
	return [Math.max(1, ...e.map(([e]) => e)), Math.max(1, ...e.map(([, e]) => e))];
}
function Ki(e, t) {
	let [n, r] = Wi({
		means: [],
		bases: e.bases
	}, 1, t);
	return (ki + (e.bases.some(({ tenBits: e }) => e) ? ji : 0)) * n * r;
}
function qi(e, t, n, r) {
	let i = [];
	if (e.usable < t && i.push(`${e.usable} of ${t} eigen textures are drawn`), e.usable && e.scaleDown > 1 && i.push(`eigen textures have 1/${e.scaleDown} of their size`), e.meanDown > 1 && i.push(`the mean texture has 1/${e.meanDown} of its size`), !i.length) return null;
	let a = Vi(n, 1) + Ui(n, 1, t) + Ki(n, 1) + n.geometry, o = a > r.memory ? `the scene needs ${Ji(a)} MB of graphics memory and ${Ji(r.memory)} MB may be used` : "this device's graphics allow no more";
	return `${Yi(i.join(", "))}: ${o}.`;
}
function Ji(e) {
	return (e / 1e6).toFixed(+(e < 1e7));
}
function Yi(e) {
	return e.charAt(0).toUpperCase() + e.slice(1);
}
// ../src/eigenfield/rendering/shaders/compose.glsl?raw
var Xi = "// Equations 7 and 8, texel by texel: means and eigen textures, weighted and summed into one texture of the whole atlas,\n// which surface.glsl then draws (decision 15).\n//\n// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl/composer.py and as GLSL ES 3.00 by the web viewer. Whoever\n// includes it writes the #version line, the precisions, cubic.glsl before it, and a main for each of three passes. All\n// draw into textures whose row 0 is v = 0, and the second and third add to what is there:\n//   placeOf       once, the mesh laid out by its texture coordinates: where each texel lies\n//   sumTextures   for each mean and basis, a rectangle of a grid: its textures, weighted, as R, G, B\n//   finerValue    for each grid coarser than the atlas, all of the atlas: what the grid holds there\n// Four numbers share a texel of what is stored: one channel of four eigen textures (decision 13), or four channels of a\n// mean. Colours are the photographs' own (sRGB-coded) numbers from end to end: no conversion, in or out.\n\n#define LAYERS 64  // most that one draw sums\n#define LEVEL 1e-4 // a height of no more than this is as good as none\n#define MOST 6e4   // halves end at 65504\n\nuniform sampler2DArray stored; // codes / 255, or values; anything finite where there is no texture (yet)\nuniform int firstLayer;\nuniform int sharing;           // 1: each of `entries` has a layer; 4: four channels of a mean share one\nuniform int channels;\nuniform int entries;           // entry e is channel e % channels, of group e / channels; at most LAYERS\nuniform vec4 scale[LAYERS];    // value = stored * scale + bias, of each entry: 0 for textures that are not summed\nuniform vec4 bias[LAYERS];\nuniform vec3 colours[LAYERS];  // R, G, B of the value 1 of each channel\n\nuniform bool rayWeights;       // look weights up where the ray to the eye meets the view plane; else they are in `scale`\nuniform sampler2DArray weightMaps; // layer g: weights 4 g .. 4 g + 3 over X, Y in -1..1, nodes on the edges\nuniform int firstGroup;\nuniform sampler2D places;      // of each texel that is drawn, as `placeOf` makes them; w is 0 where there is no surface\nuniform vec3 eye;              // X, Y and height above the view plane\n\nuniform sampler2D coarse;      // a grid's sum\n\n// A point of the surface, given as X, Y and height above the view plane, as it is seen from the plane: X, Y and 1 over\n// the height. Halves keep that well enough for points near and far.\nvec4 placeOf(vec3 point) {\n  float height = point.z < 0.0 ? min(point.z, -LEVEL) : max(point.z, LEVEL);\n  return vec4(clamp(vec3(point.xy, 1.0) / height, -MOST, MOST), 1.0);\n}\n\n// Where the ray from a point of the surface to the eye meets the view plane, as X, Y; where it does not (the eye is\n// level with the point, or the point lies behind the cameras) and where there is no surface, where the eye itself stands.\nvec2 viewCoordinates(vec4 place) {\n  float part = 1.0 - eye.z * place.z;\n  bool meets = place.w > 0.0 && part > 1e-5;\n  return clamp(meets ? (eye.xy - eye.z * place.xy) / part : eye.xy, -1.0, 1.0);\n}\n\n// The sum of a mean's or a basis's textures at `own` texture coordinates of theirs, as R, G, B.\nvec3 sumTextures(vec2 own) {\n  vec2 nodes = vec2(textureSize(weightMaps, 0).xy);\n  vec2 view = rayWeights ? viewCoordinates(texelFetch(places, ivec2(gl_FragCoord.xy), 0)) : vec2(0.0);\n  vec2 at = (0.5 + (0.5 + 0.5 * view) * (nodes - 1.0)) / nodes;\n  vec4 weights = vec4(1.0);\n  vec3 sum = vec3(0.0);\n  int entry = 0;\n  for (int group = firstGroup; entry < entries; group++) {\n    if (rayWeights) weights = textureLod(weightMaps, vec3(at, float(group)), 0.0);\n    for (int channel = 0; channel < channels; channel++) {\n      vec4 four = textureLod(stored, vec3(own, float(firstLayer + entry / sharing)), 0.0) * scale[entry] + bias[entry];\n      sum += colours[channel] * dot(weights, four);\n      entry++;\n    }\n  }\n  return sum;\n}\n\n// The value of the grid `coarse` at texture coordinates of the atlas.\nvec3 finerValue(vec2 uv) { return readCubic(coarse, uv * vec2(textureSize(coarse, 0)) - 0.5); }\n", Zi = "// Weights of the texels -1, 0, 1 and 2 for a place between texels 0 and 1: Catmull-Rom, a = -1/2.\nvec4 catmullRom(float f) {\n  float f2 = f * f, f3 = f2 * f;\n  return 0.5 * vec4(2.0 * f2 - f3 - f, 3.0 * f3 - 5.0 * f2 + 2.0, 4.0 * f2 - 3.0 * f3 + f, f3 - f2);\n}\n\n// A texture's finest level at `texel`, whole at texel centres, taps clamped to the border. Sixteen texels are read one\n// by one: nine bilinear reads between them take longer where no hardware filters, and hardware keeps 8 bits of a weight.\nvec3 readCubic(sampler2D source, vec2 texel) {\n  ivec2 last = textureSize(source, 0) - 1;\n  ivec2 base = ivec2(floor(texel));\n  vec2 f = texel - vec2(base);\n  vec4 across = catmullRom(f.x), down = catmullRom(f.y);\n  vec3 sum = vec3(0.0);\n  for (int row = 0; row < 4; row++) {\n    vec3 line = vec3(0.0);\n    for (int column = 0; column < 4; column++) {\n      ivec2 at = clamp(base + ivec2(column, row) - 1, ivec2(0), last);\n      line += across[column] * texelFetch(source, at, 0).rgb;\n    }\n    sum += down[row] * line;\n  }\n  return sum;\n}\n", Qi = 2, $i = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
${Zi}${Xi}`, ea = "\nprecision highp float;\nuniform vec4 rectangle; // of the target: left, top, right, bottom in 0..1\nin vec3 position;\nout vec2 own;\nvoid main() {\n  own = position.xy;\n  gl_Position = vec4(2.0 * mix(rectangle.xy, rectangle.zw, position.xy) - 1.0, 0.0, 1.0);\n}\n", ta = "\nprecision highp float;\nuniform vec2 texel;     // of the target, in clip space\nuniform vec2 shifts[SHIFTS];\nin vec2 position;       // texture coordinates\nin vec3 onPlane;\nout vec3 point;\nvoid main() {\n  point = onPlane;\n  gl_Position = vec4(2.0 * position - 1.0 + texel * shifts[gl_InstanceID], 0.0, 1.0);\n}\n", na = `${$i}
in vec3 point;
out vec4 place;
void main() { place = placeOf(point); }
`, ra = "sumTextures", ia = "finerValue";
function aa(n, r, i) {
	let o = new w({
		glslVersion: f,
		vertexShader: ea,
		fragmentShader: `${$i}in vec2 own;\nout vec4 colour;\nvoid main() { colour = vec4(${n}(own), 1.0); }\n`,
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
function oa([e, t], n) {
	return new k(e, t, {
		type: p,
		depthBuffer: !1,
		generateMipmaps: n,
		minFilter: n ? g : b,
		magFilter: n ? h : b
	});
}
function sa(e, t) {
	let n = q(e.right, e.up), r = [
		t[0] - e.origin[0],
		t[1] - e.origin[1],
		t[2] - e.origin[2]
	];
	return [...mi(e, t), K(r, n) / (Math.max(...e.extent) || 1)];
}
function ca(t, n, r) {
	let i = t.geometry.getAttribute("position"), a = t.geometry.getAttribute("uv"), o = new Float32Array(3 * i.count), s = new Float32Array(2 * i.count);
	for (let e = 0; e < i.count; e++) o.set(sa(n, [
		i.getX(e),
		i.getY(e),
		i.getZ(e)
	]), 3 * e), s.set([a.getX(e), a.getY(e)], 2 * e);
	let l = Array.from({ length: 5 }, (e, t) => t - Qi), u = l.flatMap((e) => l.map((t) => new D(t, e)));
	u.sort((e, t) => t.lengthSq() - e.lengthSq());
	let d = new m();
	d.setAttribute("position", new e(s, 2)), d.setAttribute("onPlane", new e(o, 3)), d.setIndex(t.geometry.index ? new e(t.geometry.index.array, 1) : null), d.instanceCount = u.length, d.boundingSphere = new E();
	let p = new w({
		glslVersion: f,
		vertexShader: ta.replace("SHIFTS", String(u.length)),
		fragmentShader: na,
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
var la = class {
	mesh;
	plane;
	grids;
	composed = null;
	camera = new n();
	constructor(e, t, n, r, i) {
		this.mesh = r, this.plane = i;
		let [a, ...o] = zi({
			atlas: e,
			means: t.filter(({ basis: e }) => !e).map(({ grid: e }) => ({ size: e })),
			bases: t.filter(({ basis: e }) => e)
		}), s = (e, r) => {
			let i = t.filter(({ grid: t }) => t.join() === e.join()).flatMap(ua), a = new T();
			return i.forEach(({ quad: e }, t) => a.add(Object.assign(e, { renderOrder: t }))), {
				target: oa(J(e, n), r),
				scene: a,
				steps: i,
				places: null
			};
		}, c = s(a ?? e, !0);
		this.grids = o.map((e) => s(e, !1));
		for (let { target: e } of this.grids) {
			let t = aa(ia, [
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
		this.composed && pa(this.composed, n) || (this.composed = n, ga(e, t, () => {
			for (let t of this.grids) {
				n.eye && !t.places && t.steps.some(({ part: e }) => e.basis) && this.findPlaces(e, t);
				for (let e of t.steps) da(e, t, n);
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
		t.places = oa([t.target.width, t.target.height], !1);
		let { scene: n, free: r } = ca(this.mesh, this.plane, t.places);
		this.draw(e, n, t.places), r();
	}
	draw(e, t, n) {
		e.setRenderTarget(n), e.state.buffers.color.setMask(!0), e.clear(!0, !1, !1), e.render(t, this.camera);
	}
};
function ua(e) {
	let t = e.colours.length, [n, r] = [e.scale.length / (4 * t), Math.floor(64 / t)], i = [];
	for (let a = 0; a < n; a += r) {
		let o = Array.from({ length: 64 }, (t, n) => new O(...e.colours[n] ?? [
			0,
			0,
			0
		])), s = e.basis ? 1 : 4, c = aa(ra, e.rectangle, {
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
function da({ part: e, first: t, groups: n, quad: r }, { places: i }, a) {
	let { basis: o, colours: s } = e, { uniforms: c } = r.material, l = (e, t) => {
		let n = c[e];
		n && (n.value = t);
	}, u = o !== null && a.eye !== null && a.only === null, d = Array.from({ length: 4 * n }, (e, n) => fa(o, 4 * t + n, a, u)), f = Math.ceil((d.findLastIndex((e) => e !== 0) + 1) / 4), [p, m] = [c.scale?.value, c.bias?.value], h = s.length;
	for (let n = 0; n < 4 * h * f; n++) {
		let r = d[4 * Math.floor(n / (4 * h)) + n % 4] ?? 0;
		p[n] = r * (e.scale[4 * h * t + n] ?? 0), m[n] = r * (e.bias[4 * h * t + n] ?? 0);
	}
	l("entries", h * f), l("rayWeights", u), l("weightMaps", u ? a.maps : null), l("places", u ? i?.texture ?? null : null), a.eye && (c.eye?.value).set(...a.eye), r.visible = f > 0, r.material.uniformsNeedUpdate = !0;
}
function fa(e, t, n, r) {
	return e ? e.ready[t] ? n.only === null ? t >= n.count ? 0 : r ? 1 : n.weights[e.column + t] ?? 0 : +(t === n.only) : 0 : +!!n.mean;
}
function pa(e, t) {
	let { weights: n, eye: r, ...i } = e;
	return !Object.entries(i).every(([e, n]) => t[e] === n) || r === null != (t.eye === null) ? !1 : e.only === null ? r ? r.every((e, n) => e === t.eye?.[n]) : n.every((e, n) => e === t.weights[n]) : !0;
}
var ma = new i(0), ha = new i();
function ga(e, t, n) {
	let r = e.getRenderTarget(), [i, a] = [e.getActiveCubeFace(), e.getActiveMipmapLevel()], { autoClear: o, info: s } = e, [c, l, u] = [
		e.xr.enabled,
		e.shadowMap.autoUpdate,
		e.getClearAlpha()
	], [d, f] = [s.render.frame, s.autoReset];
	e.getClearColor(ha), e.setClearColor(ma, 0), e.autoClear = e.xr.enabled = e.shadowMap.autoUpdate = s.autoReset = !1, n(), s.render.frame = d, Object.assign(s, { autoReset: f }), Object.assign(e, { autoClear: o }), e.xr.enabled = c, e.shadowMap.autoUpdate = l, e.setClearColor(ha, u), e.setRenderTarget(r, i, a);
	let { viewport: p } = t;
	p && e.state.viewport(p);
}
// eigenfield-three/src/maps.ts
function _a(e, t, n, i, a) {
	let c = i.reduce((e, t) => e + t, 0), l = [], [u, d] = [0, 0];
	for (let e of i) {
		let t = Math.min(e, a);
		for (let e = 0; e < t; e++) l.push([u + e, 4 * d + e]);
		u += e, d += t ? Ri(t) : 0;
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
var va = "// The composed texture (compose.glsl) on the surface of the proxy.\n//\n// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl/renderer.py and as GLSL ES 3.00 by the web viewer. Whoever\n// includes it writes the #version line, the precisions, cubic.glsl before it, and\n//   BICUBIC   how the finest level is read: 0 bilinear, 1 Catmull-Rom\n// Pixels of more than `finest` texels are left to the sampler and its mip maps.\n\nuniform sampler2D composed;\nuniform float finest;       // texels a pixel up to which the finest level is read: 1.5 times those a pixel of the\n                            // photographs covers, which holds no more than its own average\nuniform vec3 exposureScale; // picture = RGB * exposureScale + exposureBias: 1 / gain and -offset / gain of a captured\nuniform vec3 exposureBias;  // camera of a harmonised scene, else 1 and 0\n\n// R, G, B at texture coordinates; nothing is cut off.\nvec3 surfaceValue(vec2 uv) {\n  vec3 plain = texture(composed, uv, -log2(finest)).rgb;\n#if BICUBIC == 1\n  vec2 size = vec2(textureSize(composed, 0));\n  vec2 across = dFdx(uv) * size, down = dFdy(uv) * size;\n  bool fine = max(dot(across, across), dot(down, down)) <= finest * finest;\n  if (fine) return readCubic(composed, clamp(uv * size, vec2(0.5), size - 0.5) - 0.5);\n#endif\n  return plain;\n}\n\n// What the surface shows at texture coordinates.\nvec3 surfaceColour(vec2 uv) {\n  return clamp(surfaceValue(uv) * exposureScale + exposureBias, 0.0, 1.0);\n}\n", ya = {
	bilinear: 0,
	bicubic: 1
}, ba = {
	picture: 0,
	mean: 1,
	eigen: 2,
	error: 3
}, xa = "\nprecision highp float;\nuniform mat4 modelViewMatrix;\nuniform mat4 projectionMatrix;\nin vec3 position;\nin vec2 uv;\nout vec2 surfaceUv;\nout vec3 surfacePlace;\nvoid main() {\n  surfaceUv = uv;\n  surfacePlace = position;\n  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));\n}\n", Sa = `
precision highp float;
precision highp int;
precision highp sampler2D;
${Zi}${va}
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
function Ca(e) {
	let t = {
		composed: { value: null },
		finest: { value: 1 },
		exposureScale: { value: new O(1, 1, 1) },
		exposureBias: { value: new O() },
		shown: { value: ba.picture },
		shownGain: { value: 1 },
		photograph: { value: null },
		toPhotograph: { value: new _() }
	}, n = new w({
		glslVersion: f,
		vertexShader: xa,
		fragmentShader: Sa,
		uniforms: t,
		defines: { BICUBIC: ya.bicubic },
		side: e ? c : d
	});
	return n.name = "eigen textures", n;
}
// eigenfield-three/src/gpu.ts
function wa(e, t) {
	return {
		side: e.getParameter(e.MAX_TEXTURE_SIZE),
		layers: e.getParameter(e.MAX_ARRAY_TEXTURE_LAYERS),
		memory: t
	};
}
function Ta(e, [t, n], r, i, a) {
	return Oa(e, e.TEXTURE_2D_ARRAY, () => {
		e.texStorage3D(e.TEXTURE_2D_ARRAY, 1, a ? e.RGBA16F : e.RGBA8, t, n, r);
		for (let t of [e.TEXTURE_WRAP_S, e.TEXTURE_WRAP_T]) e.texParameteri(e.TEXTURE_2D_ARRAY, t, e.CLAMP_TO_EDGE);
		for (let t of [e.TEXTURE_MIN_FILTER, e.TEXTURE_MAG_FILTER]) e.texParameteri(e.TEXTURE_2D_ARRAY, t, i ? e.LINEAR : e.NEAREST);
	});
}
function Ea(e, t, n) {
	let { width: r, height: i } = n;
	ka(e, e.TEXTURE_2D_ARRAY, t, () => e.texSubImage3D(e.TEXTURE_2D_ARRAY, 0, 0, 0, 0, r, i, 1, e.RGBA, e.UNSIGNED_BYTE, n));
}
function Da(e, [t, n], r = !1) {
	return Oa(e, e.TEXTURE_2D, () => {
		e.texStorage2D(e.TEXTURE_2D, 1, r ? e.RG8 : e.RGBA8, t, n), e.texParameteri(e.TEXTURE_2D, e.TEXTURE_MIN_FILTER, e.NEAREST);
	});
}
function Oa(e, t, n) {
	for (; e.getError() !== e.NO_ERROR && !e.isContextLost(););
	let r = e.createTexture();
	return ka(e, t, r, n), e.getError() === e.OUT_OF_MEMORY ? (e.deleteTexture(r), null) : r;
}
function ka(e, t, n, r) {
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
var Aa = "#version 300 es\nvoid main() {\n  gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);\n}\n", ja = "#version 300 es\nprecision highp float;\nuniform highp sampler2D picture;\nuniform vec4 factors;\nuniform vec2 size; // of what is drawn\nuniform highp sampler2D precisions;\nuniform ivec2 nodes; // columns and rows of it that are used; 0: codes are stored as they are\nuniform float zero;\nout vec4 stored;\nfloat nodeAt(ivec2 at) {\n  return texelFetch(precisions, clamp(at, ivec2(0), nodes - 1), 0).r;\n}\nfloat precisionAt(vec2 uv) {\n  vec2 at = uv * vec2(nodes) - 0.5;\n  ivec2 low = ivec2(floor(at));\n  vec2 part = at - vec2(low);\n  float upper = mix(nodeAt(low), nodeAt(low + ivec2(1, 0)), part.x);\n  float lower = mix(nodeAt(low + ivec2(0, 1)), nodeAt(low + ivec2(1, 1)), part.x);\n  return (255.0 * mix(upper, lower, part.y) + 1.0) / 256.0;\n}\nvoid main() {\n  float code = dot(texelFetch(picture, ivec2(gl_FragCoord.xy), 0), factors);\n  if (nodes.x == 0) stored = vec4(code);\n  else stored = vec4(clamp((code - zero) / precisionAt(gl_FragCoord.xy / size) / 4.0, -65504.0, 65504.0));\n}\n";
function Ma(e, t) {
	let n = Ia(e), [r, i] = [e.createFramebuffer(), e.createVertexArray()], [a, o, s, c, l] = [
		"factors",
		"size",
		"precisions",
		"nodes",
		"zero"
	].map((t) => e.getUniformLocation(n, t)), u = ({ picture: t, rows: u }, d, f, p, m) => {
		e.useProgram(n), e.uniform2f(o ?? null, t.width, u), e.uniform1i(s ?? null, +!!m), e.uniform2i(c ?? null, m?.precision.width ?? 0, m?.precision.height ?? 0), e.uniform1f(l ?? null, m?.zero ?? 0), e.bindVertexArray(i), e.bindFramebuffer(e.DRAW_FRAMEBUFFER, r), e.viewport(0, 0, t.width, u);
		for (let { channel: n, layer: r, component: i } of f) e.colorMask(i === 0, i === 1, i === 2, i === 3), e.framebufferTextureLayer(e.DRAW_FRAMEBUFFER, e.COLOR_ATTACHMENT0, d, 0, r), Na(t) ? e.uniform4f(a ?? null, 255, 65280, 0, 0) : e.uniform4fv(a ?? null, [
			0,
			1,
			2,
			3
		].map((e) => e === n ? p : 0)), e.drawArrays(e.TRIANGLES, 0, 3);
	};
	return {
		put(n, r, i, a, o = null) {
			let { picture: s, row: c, rows: l } = n, d = Na(s) ? t.codes : t.picture;
			if (!d) return;
			let f = () => La(e, 0, d, () => {
				Na(s) ? Fa(e, s, c, l) : Pa(e, s, c, l), Ra(e, () => u(n, r, i, a, o));
			});
			o ? La(e, 1, t.precision, () => {
				Pa(e, o.precision, 0, o.precision.height), f();
			}) : f();
		},
		free() {
			e.deleteTexture(t.picture), e.deleteTexture(t.codes), e.deleteTexture(t.precision), e.deleteVertexArray(i), e.deleteFramebuffer(r), e.deleteProgram(n);
		}
	};
}
function Na(e) {
	return "data" in e;
}
function Pa(e, t, n, r) {
	e.pixelStorei(e.UNPACK_SKIP_ROWS, n), e.texSubImage2D(e.TEXTURE_2D, 0, 0, 0, t.width, r, e.RGBA, e.UNSIGNED_BYTE, t);
}
function Fa(e, { data: t, width: n, stride: r }, i, a) {
	e.pixelStorei(e.UNPACK_ALIGNMENT, 1), e.pixelStorei(e.UNPACK_ROW_LENGTH, r / 2), e.texSubImage2D(e.TEXTURE_2D, 0, 0, 0, n, a, e.RG, e.UNSIGNED_BYTE, t, i * r);
}
function Ia(e) {
	let t = e.createProgram();
	for (let [n, r] of [[e.VERTEX_SHADER, Aa], [e.FRAGMENT_SHADER, ja]]) {
		let i = e.createShader(n);
		i && (e.shaderSource(i, r), e.compileShader(i), e.attachShader(t, i), e.deleteShader(i));
	}
	return e.linkProgram(t), t;
}
function La(e, t, n, r) {
	let i = e.getParameter(e.ACTIVE_TEXTURE);
	e.activeTexture(e.TEXTURE0 + t);
	let a = e.getParameter(e.SAMPLER_BINDING);
	e.bindSampler(t, null), ka(e, e.TEXTURE_2D, n, r), e.bindSampler(t, a), e.activeTexture(i);
}
function Ra(e, t) {
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
function za(e, t, n) {
	let r = [], [i, a, o, s] = [
		0,
		0,
		0,
		0
	];
	return e.planes.forEach((c, l) => {
		let { channels: u, bases: d } = c, f = e.colours.slice(i, i + u);
		i += u;
		let p = t.needs.means[l]?.size ?? [1, 1], m = t.means[l], h = Ba(c);
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
					...Ha(l, u, h),
					basis: {
						ready: m,
						column: o,
						group: s
					}
				});
			}
			o += p, s += h ? Ri(h) : 0;
		}
	}), r;
}
function Ba({ mean: e, channels: t, precision: n }) {
	let { scale: r, zero: i } = e, a = n ? 4 : Va([e]), o = {
		scale: new Float32Array(4 * t),
		bias: new Float32Array(4 * t)
	};
	for (let e = 0; e < t; e++) {
		let t = 4 * e + e % 4;
		o.scale[t] = a * (r[e] ?? 0), o.bias[t] = n ? 0 : -(i[e] ?? 0) * (r[e] ?? 0);
	}
	return o;
}
function Va(e) {
	return wr(e) ? 1 : 255;
}
function Ha(e, t, n) {
	let r = e.flatMap((e) => e.scale), i = e.flatMap((e) => e.zero), a = Va(e), o = 4 * t * Ri(n), s = {
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
function Ua(e) {
	for (let { picture: t } of e) "close" in t && t.close();
}
// eigenfield-three/src/strength.ts
var Y = 128, Wa = .98;
async function Ga(e, t, n, r) {
	let i = n.length, a = 0, o = e.pictures.find(({ textures: e }) => (a += e) > t);
	if (!o) return 1;
	let s = t - (a - o.textures), c = Tr(o), l = o.pieces < i, u = await o.codec.bitmaps(await r(o.view), o, e.size), d = new OffscreenCanvas(Y, Y).getContext("2d", { willReadFrequently: !0 });
	if (!d) return 1;
	d.imageSmoothingEnabled = !1;
	let f = [];
	u.slice(o.pieces * s, o.pieces * (s + 1)).forEach(({ picture: e, row: t, rows: r }, a) => {
		d.drawImage(e, 0, t, e.width, r, 0, 0, Y, Y);
		let { data: u } = d.getImageData(0, 0, Y, Y);
		(l ? [
			0,
			1,
			2
		] : [a]).forEach((e) => {
			let [t, r] = [o.scale, o.zero].map((t) => t[i * s + e] ?? 0), a = Math.max(...(n[e] ?? [0]).map(Math.abs)) * (t ?? 0);
			for (let t = l ? e : 0; t < u.length; t += 4) f.push(Math.abs((c * (u[t] ?? 0) - (r ?? 0)) * a));
		});
	}), Ua(u), f.sort((e, t) => e - t);
	let p = f[Math.floor(Wa * f.length)] ?? 0;
	return p > 0 ? .45 / p : 1;
}
// eigenfield-three/src/means.ts
async function Ka(e, t, n = 1) {
	let { mean: r, meanSize: i } = e, a = e.precision && await qa(await t(e.precision.view), e.precision);
	return {
		pieces: await r.codec.decode(await t(r.view), r, i, n),
		precision: a
	};
}
async function qa(e, t) {
	let { type: n } = An(e) ?? {}, { mimeType: r } = t.codec;
	if (n && n !== r) throw j(t.where, `${n}, not ${r}`);
	let [i] = await t.codec.bitmaps(e, t, t.size);
	if (!i) throw j(t.where, "no picture");
	return i.picture;
}
function Ja({ pieces: e, precision: t }) {
	Ua(e), t?.close();
}
// eigenfield-three/src/textures.ts
var Ya = 3, Xa = class {
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
			tenBits: wr(t.pictures)
		}))), s = r.planes.map(({ channels: e, mean: t }, n) => ({
			size: i[n] ?? [1, 1],
			channels: e,
			pieces: t.pieces,
			tenBits: wr([t])
		}));
		this.needs = {
			atlas: li(r, i),
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
		this.detach(), this.disposed = !0, this.decoded?.forEach(Ja), this.decoded = null;
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
				for (; a.length < Ya && o < i.length;) a.push(this.decode(i[o++], r.scaleDown));
				let s = await a[0] ?? [];
				if (a.shift(), t === this.turn && this.pack(s, e, n, r.usable), Ua(s), t !== this.turn) return;
				this.onTexture();
			}
		} finally {
			for (let e of a) e.then(Ua).catch(() => void 0);
		}
		n.free(), this.packer = null, this.onComplete();
	}
	pack(e, t, n, r) {
		let { number: i, channels: a, first: o, picture: s } = t, c = this.bases[i]?.sourceTexture, l = this.ready[i];
		if (!(c instanceof WebGLTexture) || !l) return;
		let u = this.needs.bases[i]?.tenBits ? 255 * Tr(s) : 1, d = s.pieces < a;
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
		for (let i = this.options.memory ?? Ni();; i /= 2) {
			let a = Bi(this.needs, wa(e, i)), { meanDown: o, scaleDown: s, usable: c } = a, l = o > 1 || s > 1, u = [...t.map(({ size: t, channels: n, tenBits: r }) => Ta(e, J(t, o), Ii(n), l, r)), ...n.map(({ size: t, channels: n, count: r, tenBits: i }) => {
				let a = Math.min(r, c);
				return Ta(e, a ? J(t, s) : [1, 1], a ? Li(a, n) : 1, l, i);
			})], d = Wi(this.needs, o, s), f = Da(e, d), p = [...t, ...n].some(({ tenBits: e }) => e), m = p ? Da(e, d, !0) : null, h = Da(e, Gi(r));
			if (f && h && (m || !p) && u.every((e) => e !== null)) return [...this.means, ...this.bases].forEach((e, t) => e.sourceTexture = u[t] ?? null), {
				packer: Ma(e, {
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
		this.decoded = null, (!a || n > 1) && (a?.forEach(Ja), a = await Promise.all(r.planes.map((e) => Ka(e, i, n)))), a.forEach((n, i) => {
			let a = this.means[i]?.sourceTexture, o = r.planes[i]?.mean;
			t === this.turn && o && a instanceof WebGLTexture && this.putMean(e, n, o, a), Ja(n);
		}), t === this.turn && (this.hasMeans = !0, this.version += 1);
	}
	putMean(e, t, n, r) {
		let { pieces: i, precision: a } = t, o = wr([n]), [s] = i;
		if (s && i.length === 1 && !o && "close" in s.picture) {
			Ea(e, r, s.picture);
			return;
		}
		let c = o ? 255 * Tr(n) : 1;
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
}, Za = 1.5, Qa = .001, $a = class extends l {
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
		this.mesh = a, this.info = r, this.total = ci(n), this.counts = G(n).map(({ count: e }) => e), this.filter = t.filter ?? "bicubic", this.weightMode = r.facesPlane ? "ray" : "eye";
		let o = 0;
		this.rowOf = Int32Array.from(n.heldOut, (e) => e ? -1 : o++), this.textures = new Xa(e, ro(a), t);
		let s = [a.material].flat().some((e) => e.side !== d);
		this.material = Ca(s), this.complete = new Promise((e, t) => {
			this.addEventListener("complete", () => e()), this.addEventListener("error", ({ error: e }) => t(e));
		}), this.complete.catch(() => void 0);
		let c = r.cameras[r.reference];
		this.detail = c ? Ti(a.geometry, c, [1, 1]) : 0, this.listen();
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
		return this.componentWeights(...mi(this.info.viewPlane, n.centre));
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
		return Za * Math.max(1, this.detail * Math.sqrt(e * t) / n);
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
		let r = no(t, n), [i, a] = mi(this.info.viewPlane, r), o = this.camera !== null && this.info.cameras[this.camera] ? this.camera : null, s = o === null ? this.componentWeights(i, a) : this.cameraWeights(o), c = o === null && this.weightMode === "ray" && this.info.facesPlane && !this.isOnPlane(r);
		this.setView();
		let l = ya[this.filter];
		this.material.defines.BICUBIC !== l && (this.material.defines.BICUBIC = l, this.material.needsUpdate = !0), this.material.uniformsNeedUpdate = !0, this.compose(e, t, this.recipe(s, c ? r : null)), e.info.render.frame !== this.frame && (this.lastWeights = []), this.frame = e.info.render.frame, this.lastWeights.push(s), this.lastByRay = c;
	}
	compose(e, t, n) {
		let { plan: r } = this.textures, { size: i, viewPlane: a } = this.info;
		if (!r) return;
		let o = r.meanDown * this.coarser, s = this.composers.get(o);
		s || (s = new la(i, za(this.parts.scene, this.textures, r), o, this.mesh, a), this.composers.set(o, s)), s.compose(e, t, n), this.material.uniforms.composed.value = s.texture, this.material.uniforms.finest.value = this.finestOf(i, o);
	}
	freeComposers() {
		for (let e of this.composers.values()) e.dispose();
		this.composers.clear();
	}
	recipe(e, t) {
		let n = this.material.uniforms.shown.value, r = n === ba.eigen ? this.shownEigen : null;
		return {
			version: this.textures.version,
			mean: this.textures.hasMeans && r === null,
			only: r,
			count: n === ba.mean ? 0 : Math.max(0, Math.floor(Math.min(this.count, this.total))),
			weights: e,
			eye: t && sa(this.info.viewPlane, t),
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
		e.shown.value = ba[o === "eigen" && s >= this.loaded ? "mean" : o], o === "eigen" && (e.shownGain.value = this.gainOf(s)), t && this.aimPhotograph();
	}
	get shownEigen() {
		return Math.min(Math.max(0, Math.floor(this.eigen)), this.total - 1);
	}
	aimPhotograph() {
		let e = this.camera === null ? void 0 : this.info.cameras[this.camera], { photograph: t } = this;
		if (!e || !t) return;
		let { K: n, R: r, t: i, width: a, height: o } = e, s = new _().set(...r[0], i[0], ...r[1], i[1], ...r[2], i[2], 0, 0, 0, 1), c = new _().set(...n[0], 0, ...n[1], 0, 0, 0, 0, 0, ...n[2], 0), l = t.flipY && !io(t.image), u = new _().makeScale(1 / a, (l ? -1 : 1) / o, 1);
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
				Ga(s, e, o, r).then((t) => {
					this.gains.set(e, t), this.dispatchEvent({ type: "texture" });
				}).catch(() => void 0);
				break;
			}
		}
		return 1;
	}
	isOnPlane(e) {
		let { origin: t, normal: n, extent: r } = this.info.viewPlane, i = e.reduce((e, r, i) => e + (r - (t[i] ?? 0)) * (n[i] ?? 0), 0);
		return Math.abs(i) <= Qa * Math.max(...r);
	}
	mapsOf(e) {
		let { usable: t } = this;
		if (this.maps?.mixing === e && this.maps.usable === t) return this.maps.texture;
		this.maps?.texture.dispose();
		let n = _a(this.parts.weights, e, this.parts.omega, this.counts, t);
		return this.maps = {
			texture: n,
			mixing: e,
			usable: t
		}, n;
	}
	fail(e) {
		if (ao(e)) return;
		let t = ie(e), n = `The picture is drawn with ${this.loaded} of ${this.total} eigen textures.`;
		this.dispatchEvent({
			type: "error",
			error: new A(t.code, `${t.message} ${n}`, t.where)
		});
	}
}, eo = new _(), to = new O();
function no(e, t) {
	return to.setFromMatrixPosition(e.matrixWorld).applyMatrix4(eo.copy(t.matrixWorld).invert()), [
		to.x,
		to.y,
		to.z
	];
}
function ro(e) {
	let { attributes: t, index: n } = e.geometry;
	return Object.values(t).reduce((e, t) => e + t.array.byteLength, 0) + (n?.array.byteLength ?? 0);
}
function io(e) {
	return typeof ImageBitmap < "u" && e instanceof ImageBitmap;
}
function ao(e) {
	return e instanceof DOMException && e.name === "AbortError";
}
// eigenfield-three/src/arrival.ts
var oo = class {
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
}, so = 1179937895, co = 1313821514, lo = 5130562;
async function uo(e) {
	let t = await e.read(0, 4).catch((t) => {
		throw t instanceof A && t.code === "truncated" ? go(e.received === 0) : t;
	});
	if (new DataView(t).getUint32(0, !0) !== so) throw go(!1);
	let n = new DataView(await e.read(0, 12)), r = n.getUint32(4, !0), i = n.getUint32(8, !0);
	if (r !== 2) throw new A("version", `The file is GLB version ${r} and this viewer reads 2; save it as glTF 2.`, "4");
	if (i < 20) throw j("8", "a length of no file");
	let a = new DataView(await e.read(12, 20)), o = a.getUint32(0, !0);
	if (a.getUint32(4, !0) !== co) throw j("16", "it does not begin with JSON");
	if (o > oe) throw j("12", `${o} bytes of JSON`);
	if (20 + o > i) throw j("12", "a chunk longer than the file");
	let s = po(await e.read(20, 20 + o));
	return {
		length: i,
		text: s,
		json: mo(s),
		binary: () => fo(e, 20 + o, i)
	};
}
async function fo(e, t, n) {
	let r = t;
	for (let t = 1; t < 64 && r + 8 <= n; t++) {
		let t = new DataView(await e.read(r, r + 8)), i = t.getUint32(0, !0);
		if (r + 8 + i > n) throw j(String(r), "a chunk longer than the file");
		if (t.getUint32(4, !0) === lo) return r + 8;
		r += 8 + i;
	}
	throw j(String(t), "no binary chunk");
}
function po(e) {
	try {
		return new TextDecoder("utf-8", { fatal: !0 }).decode(e);
	} catch {
		throw j("20", "its JSON is not UTF-8");
	}
}
function mo(e) {
	if (ho(e) > 64) throw j("20", "its JSON is nested too deep");
	try {
		return JSON.parse(e);
	} catch {
		throw j("20", "its JSON cannot be read");
	}
}
function ho(e) {
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
function go(e) {
	return new A("not-glb", e ? "The file is empty; take a .glb file that eigenfield wrote." : "The file is no GLB; take a .glb file that eigenfield wrote.", "0");
}
// eigenfield-three/src/proxy.ts
var _o = 65535;
function vo(e, t) {
	let n = e.getAttribute("position"), r = e.getAttribute("uv"), { index: i } = e;
	if (!i) throw new A("damaged", "The proxy mesh has no triangles; make or download the file again.");
	if (r.count !== n.count) throw j(t.uv.where, `${r.count} for ${n.count} vertices`);
	for (let e = 0; e < n.count; e++) {
		if (!(Math.max(Math.abs(n.getX(e)), Math.abs(n.getY(e)), Math.abs(n.getZ(e))) <= 1e30)) throw j(t.position.where, `vertex ${e} is not finite`);
		if (!(Math.max(Math.abs(r.getX(e)), Math.abs(r.getY(e))) <= 1e30)) throw j(t.uv.where, `texture coordinates of vertex ${e} are not finite`);
	}
	for (let e of i.array) if (e >= n.count) throw j(t.indices.where, `no vertex ${e}`);
}
async function yo({ view: n, codec: r, where: i }, a) {
	let { positions: o, uv: s, indices: c } = r.decode(new Uint8Array(await a(n)), i);
	if (!c.length) throw j(i, "a mesh without faces");
	let l = new t();
	l.setAttribute("position", new e(o, 3)), l.setAttribute("uv", new e(s, 2));
	let u = o.length / 3 <= _o;
	return l.setIndex(new e(u ? Uint16Array.from(c) : c, 1)), l;
}
function bo(e) {
	return {
		vertices: e.getAttribute("position").count,
		triangles: (e.index?.count ?? 0) / 3
	};
}
// eigenfield-three/src/grid.ts
function xo(e) {
	let t = e.length / 2;
	for (let n = 1; n * n <= t; n++) {
		if (t % n) continue;
		let r = t / n, i = So(e, n, r) ?? (n === r ? null : So(e, r, n));
		if (i) return i;
	}
	return null;
}
function So(e, t, n) {
	let [r, i] = [wo(e, 0), wo(e, 1)];
	if (t === 1 && To(i) > 0 || n === 1 && To(r) > 0) return null;
	let a = Array.from(r, (e, t) => t).sort((e, t) => X(i, e) - X(i, t));
	for (let e = 0; e < t; e++) {
		let t = a.slice(e * n, (e + 1) * n).sort((e, t) => X(r, e) - X(r, t));
		a.splice(e * n, n, ...t);
	}
	let o = (e, t) => a[e * n + t] ?? 0;
	return Co(n, t, (e, t) => X(r, o(t, e))) && Co(t, n, (e, t) => X(i, o(e, t))) ? {
		rows: t,
		columns: n,
		index: Int32Array.from(a)
	} : null;
}
function Co(e, t, n) {
	let r = Infinity, i = 0, a = NaN;
	for (let o = 0; o < e; o++) {
		let e = 0;
		for (let r = 0; r < t; r++) e += n(o, r) / t;
		for (let r = 0; r < t; r++) i = Math.max(i, Math.abs(n(o, r) - e));
		o && (r = Math.min(r, e - a)), a = e;
	}
	return r > 0 && (r === Infinity || i <= r / 4);
}
function wo(e, t) {
	return Float64Array.from({ length: e.length / 2 }, (n, r) => e[2 * r + t] ?? 0);
}
function To(e) {
	return e.reduce((e, t) => Math.max(e, t), -Infinity) - e.reduce((e, t) => Math.min(e, t), Infinity);
}
var X = (e, t) => e[t] ?? 0, Eo = 1e-6, Do = 32, Oo = class {
	places;
	triangles;
	isLine;
	grid;
	rules = /* @__PURE__ */ new Map();
	constructor(e, t, n) {
		this.places = e, this.triangles = t, this.isLine = n, this.grid = xo(e);
	}
	at(e, t, n) {
		let r = n === "bilinear" && !this.grid ? "delaunay" : n, i = this.rules.get(r);
		return i || this.rules.set(r, i = this.makeRule(r)), i(ko(e), this.isLine ? 0 : ko(t));
	}
	makeRule(e) {
		return e === "nearest3" ? (e, t) => zo(e, t, this.places) : e === "bilinear" && this.grid ? Vo(this.places, this.grid) : Mo(this.places, this.triangles);
	}
};
function ko(e) {
	return Math.min(1, Math.max(-1, e));
}
function Ao(e) {
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
function jo(e, t, n, r, i, a) {
	let [o, s] = [Z(n, r), Q(n, r)], [c, l] = [Z(n, i) - o, Q(n, i) - s], [u, d] = [Z(n, a) - o, Q(n, a) - s], f = c * d - l * u, p = ((e - o) * d - (t - s) * u) / f, m = (c * (t - s) - l * (e - o)) / f;
	return [
		1 - p - m,
		p,
		m
	];
}
function Mo(e, t) {
	if (!t.length) {
		let t = Ro(e, Lo(e));
		return (n, r) => Io(n, r, e, t);
	}
	let n = Po(e, t, 3), r = Fo(t);
	return (i, a) => {
		let o = -1, s = -Infinity, c = [
			0,
			0,
			0
		];
		for (let r of n[$(a) * Do + $(i)] ?? []) {
			let [n, l, u] = [
				No(t, r, 0),
				No(t, r, 1),
				No(t, r, 2)
			], d = jo(i, a, e, n, l, u), f = Math.min(...d);
			f > s && ([o, s, c] = [
				r,
				f,
				d
			]);
		}
		return s < -1e-9 ? Io(i, a, e, r) : Ao(c.map((e, n) => [No(t, o, n), e]));
	};
}
var No = (e, t, n) => e[3 * t + n] ?? 0;
function $(e) {
	return Math.min(31, Math.max(0, Math.floor((e + 1) / 2 * Do)));
}
function Po(e, t, n) {
	let r = Array.from({ length: 1024 }, () => []);
	for (let i = 0; i < t.length / n; i++) {
		let a = Array.from({ length: n }, (e, r) => t[n * i + r] ?? 0), o = a.map((t) => Z(e, t)), s = a.map((t) => Q(e, t));
		for (let e = $(Math.min(...s)); e <= $(Math.max(...s)); e++) for (let t = $(Math.min(...o)); t <= $(Math.max(...o)); t++) r[e * Do + t]?.push(i);
	}
	return r;
}
function Fo(e) {
	let t = /* @__PURE__ */ new Map();
	for (let n = 0; n < e.length / 3; n++) for (let r = 0; r < 3; r++) {
		let [i, a] = [No(e, n, r), No(e, n, (r + 1) % 3)], o = i < a ? [i, a] : [a, i], s = t.get(o.join());
		s ? s.times += 1 : t.set(o.join(), {
			edge: o,
			times: 1
		});
	}
	let n = [...t.values()].filter((e) => e.times === 1).map((e) => e.edge);
	return n.sort((e, t) => e[0] - t[0] || e[1] - t[1]), Int32Array.from(n.flat());
}
function Io(e, t, n, r) {
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
	return Ao([[o, 1 - c], [s, c]]);
}
function Lo(e) {
	return Array.from({ length: e.length / 2 }, (e, t) => t);
}
function Ro(e, t) {
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
function zo(e, t, n) {
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
	if (a < 0 || Bo(n, r, i, a) <= Eo) return Io(e, t, n, Ro(n, [
		r,
		i,
		a
	].filter((e) => e >= 0)));
	let [l, u, d] = jo(e, t, n, r, i, a);
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
function Bo(e, t, n, r) {
	let [i, a] = [Z(e, n) - Z(e, t), Q(e, n) - Q(e, t)], [o, s] = [Z(e, r) - Z(e, t), Q(e, r) - Q(e, t)], c = Math.max(i * i + a * a, o * o + s * s, (i - o) ** 2 + (a - s) ** 2);
	return c > 0 ? Math.abs(i * s - a * o) / c : 0;
}
function Vo(e, t) {
	let { rows: n, columns: r, index: i } = t;
	if (Math.min(n, r) === 1) {
		let t = Ro(e, Lo(e));
		return (n, r) => Io(n, r, e, t);
	}
	let a = (e, t) => i[e * r + t] ?? 0, o = [];
	for (let e = 0; e + 1 < n; e++) for (let t = 0; t + 1 < r; t++) o.push([
		a(e, t),
		a(e, t + 1),
		a(e + 1, t + 1),
		a(e + 1, t)
	]);
	let s = Po(e, o.flat(), 4), c = [];
	for (let e = 0; e < r; e++) c.push(a(0, e));
	for (let e = 1; e < n; e++) c.push(a(e, r - 1));
	for (let e = r - 2; e >= 0; e--) c.push(a(n - 1, e));
	for (let e = n - 2; e >= 0; e--) c.push(a(e, 0));
	let l = Int32Array.from(c.slice(1).flatMap((e, t) => [c[t] ?? 0, e]));
	return (t, n) => {
		let r = null, i = -Infinity;
		for (let a of s[$(n) * Do + $(t)] ?? []) {
			let s = o[a], c = s ? Ho(t, n, e, s) : -Infinity;
			s && c > i && ([r, i] = [s, c]);
		}
		if (!r || i < -1e-9) return Io(t, n, e, l);
		let [a, c] = Uo(t, n, e, r);
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
function Ho(e, t, n, r) {
	let i = Infinity;
	for (let a = 0; a < 4; a++) {
		let [o, s] = [r[a], r[(a + 1) % 4]], [c, l] = [Z(n, o), Q(n, o)];
		i = Math.min(i, (Z(n, s) - c) * (t - l) - (Q(n, s) - l) * (e - c));
	}
	return i;
}
function Uo(e, t, n, r) {
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
	], [v, y] = [i - o + c - u, a - s + l - d], b = f * h - p * m, x = f * y - p * v - (g * h - _ * m), S = -(g * y - _ * v), C = Math.sqrt(Math.max(x * x - 4 * b * S, 0)), w = Wo(-2 * b / (x + (x < 0 ? -C : C))), [T, E] = [m + w * v, h + w * y];
	return [Wo(((f - w * g) * T + (p - w * _) * E) / (T * T + E * E)), w];
}
function Wo(e) {
	return Math.min(1, Math.max(0, e));
}
// eigenfield-three/src/plugin.ts
var Go = class {
	parser;
	options;
	name = ae;
	scene = null;
	ours;
	constructor(e, t = {}) {
		this.parser = e, this.options = t, this.ours = Lr(e.json);
	}
	async beforeRoot() {
		this.ours && (this.scene = Rr(this.parser.json));
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
		let n = Ko(e, this.parser), [r] = n;
		if (!r) throw j("/meshes/0", "no node shows it");
		vo(r.geometry, t);
		let i = async (e) => {
			let n = await this.parser.getDependency("bufferView", e);
			if (n.byteLength < (t.views[e]?.length ?? 0)) throw re(`/bufferViews/${e}`);
			return n;
		}, a = t.mesh && await yo(t.mesh, i);
		if (a) {
			r.geometry.dispose();
			for (let e of n) e.geometry = a;
		}
		let [o, s, c, l] = await Promise.all([
			Promise.all(t.planes.map((e) => Ka(e, i))),
			$r(t, i),
			oi(t, i),
			ui(t, i)
		]), u = s.filter((e, n) => !t.heldOut[n]), d = new Oo(Float64Array.from(u.flatMap((e) => mi(t, e.centre))), l, t.extent[1] === 0), f = o.map(({ pieces: [e] }) => [e?.picture.width ?? 1, e?.rows ?? 1]), p = fi(t, s, f, d.grid, this.fileBytes(), bo(r.geometry)), m = {
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
		e.userData.eigenfield = new $a(m, this.options);
	}
	fileBytes() {
		if (this.options.stream) return this.options.stream.total;
		let { extensions: e, json: t } = this.parser;
		return e.KHR_binary_glTF?.header?.length ?? t.buffers[0]?.byteLength ?? 0;
	}
};
function Ko(e, t) {
	let n = [];
	return e.scene.traverse((e) => {
		let r = t.associations.get(e);
		qo(e) && r?.meshes === 0 && (r.primitives ?? 0) === 0 && n.push(e);
	}), n;
}
function qo(e) {
	return e.isMesh === !0;
}
// eigenfield-three/src/load.ts
async function Jo(e, t = {}) {
	let { signal: n } = t;
	n?.throwIfAborted();
	let r = new oo(), i = new AbortController(), a = () => {
		r.fail(new DOMException("The load was stopped.", "AbortError")), i.abort();
	};
	n?.addEventListener("abort", a);
	let o = Zo(e, r, i.signal, t.onBytes).catch((e) => r.fail(e)).finally(() => n?.removeEventListener("abort", a));
	try {
		let e = await uo(r);
		if (!Lr(e.json)) return {
			gltf: await Xo(r, e, o),
			field: null
		};
		let i = await Yo(r, e, t);
		n?.throwIfAborted();
		let a = i.userData.eigenfield;
		return {
			gltf: i,
			field: a instanceof $a ? a : null
		};
	} catch (e) {
		throw i.abort(), n?.throwIfAborted(), ie(e);
	}
}
async function Yo(e, t, n) {
	let r = new te(), i = t.binary();
	i.catch(() => void 0);
	let a = {
		total: t.length,
		read: async (t, n) => {
			let r = await i + t;
			return e.read(r, r + n);
		}
	};
	return r.register((e) => new Go(e, {
		...n,
		stream: a
	})), r.parseAsync(t.text, "");
}
async function Xo(e, t, n) {
	await n;
	let r = await e.read(0, t.length);
	try {
		return await new te().parseAsync(r, "");
	} catch (e) {
		let t = ie(e).message;
		throw new A("unsupported", `${t} It has no eigen textures either.`, "", { cause: e });
	}
}
async function Zo(e, t, n, r) {
	if (e instanceof ArrayBuffer) return t.push(new Uint8Array(e)), r?.(e.byteLength, e.byteLength), t.end();
	let { body: i, total: a } = e instanceof Blob ? Qo(e) : await $o(e, n), o = i.getReader();
	for (n.addEventListener("abort", () => void o.cancel().catch(() => void 0));;) {
		let { done: e, value: i } = await o.read().catch((e) => {
			throw n.aborted ? e : es(t.received, e);
		});
		if (e) break;
		t.push(i), r?.(t.received, a);
	}
	n.throwIfAborted(), t.end();
}
function Qo(e) {
	return {
		body: e.stream(),
		total: e.size
	};
}
async function $o(e, t) {
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
function es(e, t) {
	return new A("network", `The connection broke after ${e} bytes of the scene; load it again.`, String(e), { cause: t });
}
export { $a as EigenField, Go as EigenfieldPlugin, A as SceneError, Ni as defaultMemory, Jo as loadEigenfield, gi as novelCamera, bi as placeCamera };
