import { BufferAttribute as e, BufferGeometry as t, Camera as n, ClampToEdgeWrapping as r, Color as i, CustomBlending as a, DataArrayTexture as o, DataUtils as s, DepthStencilFormat as c, DepthTexture as l, DoubleSide as u, EqualStencilFunc as d, EventDispatcher as f, ExternalTexture as p, FrontSide as m, GLSL3 as h, HalfFloatType as g, IncrementStencilOp as _, InstancedBufferGeometry as v, LinearFilter as y, LinearMipmapLinearFilter as b, Matrix4 as x, Mesh as S, MeshBasicMaterial as C, NearestFilter as w, NoBlending as T, OneFactor as E, OneMinusSrcAlphaFactor as ee, RGBAFormat as D, RawShaderMaterial as O, Scene as k, Sphere as te, UnsignedByteType as ne, UnsignedInt248Type as re, Vector2 as ie, Vector3 as A, Vector4 as ae, WebGLRenderTarget as oe, ZeroStencilOp as se } from "three";
import { GLTFLoader as ce } from "three/addons/loaders/GLTFLoader.js";
// eigenfield-three/src/errors.ts
var j = class extends Error {
	code;
	where;
	name = "SceneError";
	constructor(e, t, n = "", r) {
		super(t, r), this.code = e, this.where = n;
	}
};
function M(e, t) {
	return new j("damaged", `The file is damaged (${e}: ${t}); make or download it again.`, e);
}
function le(e, t) {
	return new j("truncated", `The file is cut off after ${e} of ${t} bytes; download or copy it again.`, String(e));
}
function ue(e) {
	return new j("truncated", `The file is cut off (${e}); download or copy it again.`, e);
}
function de(e, t = "") {
	return e instanceof j ? e : new j("damaged", `The file cannot be read (${(e instanceof Error ? e.message : String(e)).replace(/^THREE\.GLTFLoader: /, "")}); make or download it again.`, t, { cause: e });
}
// eigenfield-three/src/addresses.ts
var fe = 60;
function pe(e) {
	return {
		name: "EIGENFIELD_addresses",
		beforeRoot: async () => me(e.json)
	};
}
function me(e) {
	let t = [["", e]];
	for (let e = t.pop(); e; e = t.pop()) {
		let [n, r] = e;
		if (typeof r == "object" && r) for (let [e, i] of Object.entries(r)) {
			if (e === "extras" && !Array.isArray(r)) continue;
			let a = `${n}/${e}`;
			if (e === "uri" && !(typeof i == "string" && /^data:/i.test(i))) throw he(a, JSON.stringify(i));
			t.push([a, i]);
		}
	}
}
function he(e, t) {
	return new j("address", `The file names another one (${e}: ${t.length > fe ? `${t.slice(0, fe)}…` : t}), which is not fetched; export all of it as one .glb.`, e);
}
// eigenfield-three/src/av1-picture.ts
var ge = 1, _e = 7;
function ve(e, t) {
	let { level: n, tier: r, width: i, height: a } = ye(new Uint8Array(e), t), o = r << 7 | 76, s = N("ipco", [
		...N("ispe", [
			...P(0),
			...P(i),
			...P(a)
		]),
		...N("pixi", [
			...P(0),
			3,
			10,
			10,
			10
		]),
		...N("av1C", [
			129,
			n,
			o,
			0
		]),
		...N("colr", [
			...F("nclx"),
			0,
			2,
			0,
			2,
			0,
			2,
			128
		])
	]), c = N("ftyp", [
		...F("avif"),
		...P(0),
		...F("avifmif1miafMA1B")
	]), l = (t) => N("meta", [
		...P(0),
		...N("hdlr", [
			...P(0),
			...P(0),
			...F("pict"),
			...Array(13).fill(0)
		]),
		...N("pitm", [
			...P(0),
			0,
			1
		]),
		...N("iloc", [
			...P(0),
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
			...P(t),
			...P(e.byteLength)
		]),
		...N("iinf", [
			...P(0),
			0,
			1,
			...N("infe", [
				2,
				0,
				0,
				0,
				0,
				1,
				0,
				0,
				...F("av01"),
				0
			])
		]),
		...N("iprp", [...s, ...N("ipma", [
			...P(0),
			...P(1),
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
		...P(8 + e.byteLength),
		...F("mdat")
	], f = new Uint8Array(u + e.byteLength);
	return f.set(d), f.set(new Uint8Array(e), u), f.buffer;
}
function ye(e, t) {
	let n = e[0] ?? 0, r = 8 * (1 + (n >> 2 & 1) + (n >> 1 & 1)), i = (t) => {
		let n = 0;
		for (let i = r + t; r < i; r++) n = 2 * n + ((e[r >> 3] ?? 0) >> 7 - (r & 7) & 1);
		return n;
	};
	i(4);
	let a = i(1) === 1, o = !a && i(7) !== 0;
	a || i(12);
	let s = i(5), c = !a && s > _e ? i(1) : 0, [l, u] = [i(4) + 1, i(4) + 1], [d, f] = [i(l) + 1, i(u) + 1];
	if (n >> 3 !== ge || o || r > 8 * e.length) throw M(t, "no AV1 sequence header");
	return {
		level: s,
		tier: c,
		width: d,
		height: f
	};
}
function N(e, t) {
	return [
		...P(8 + t.length),
		...F(e),
		...t
	];
}
function P(e) {
	return [
		24,
		16,
		8,
		0
	].map((t) => e >>> t & 255);
}
function F(e) {
	return Array.from(e, (e) => e.charCodeAt(0));
}
// eigenfield-three/src/inflate.ts
async function be(e, t, n, r) {
	let i = [], a = 0, o = new Blob([e]).stream().pipeThrough(new DecompressionStream(t)).getReader();
	try {
		for (let e = await o.read(); !e.done && a <= n; e = await o.read()) i.push(e.value), a += e.value.length;
	} catch {
		throw M(r, "it does not inflate");
	}
	if (a > n) throw await o.cancel(), M(r, `more than ${n} bytes`);
	let s = new Uint8Array(a), c = 0;
	for (let e of i) s.set(e, c), c += e.length;
	return s;
}
// eigenfield-three/src/limits.ts
var xe = "EIGENFIELD_eigen_textures", Se = 64 * 2 ** 20, I = 16384, Ce = 16384, we = 1024, Te = 2 ** 27, Ee = 4096, De = 8 * 2 ** 30, L = 1e5, Oe = 65535, ke = 2 ** 29, R = 1024, Ae = 2 ** 25, je = 2 ** 26, Me = 2 ** 27, Ne = 8192, Pe = 2 ** 24, Fe = 2 ** 25, Ie = 2 ** 20, Le = 2 ** 16, Re = 2 ** 30, ze = 1024, Be = 2 ** 22, Ve = 2 ** 28, He = 2 ** 31 - 1, Ue = 2 ** 28, We = 1e30, z = 65536, Ge = 126, Ke = 64, qe = 0, Je = 1, Ye = 2, Xe = 24, Ze = 44, Qe = 21, $e = 26214, et = 4, tt = Float64Array.from({ length: 4095 }, (e, t) => Math.round(z / (1 + Math.exp((2047 - t) / 256)))), nt = Float64Array.from({ length: 4096 }, (e, t) => Math.round(256 * Math.log((t + .5) / (4095.5 - t)))), rt = Float64Array.from({ length: 127 }, (e, t) => Math.round(z / (t + 1.5)));
function B(e) {
	return e < 4294967296 ? 32 - Math.clz32(e) : 32 + B(Math.floor(e / 4294967296));
}
var it = class {
	bytes;
	low = 0;
	high = 4294967295;
	code = 0;
	at = 0;
	probability;
	seen;
	weights;
	constructor(e, t, n) {
		this.bytes = e, this.probability = new Uint16Array(t * Ke).fill(z / 2), this.seen = new Uint8Array(t * Ke), this.weights = new Float64Array(n * Ke * 3).fill($e);
		for (let e = 0; e < et; e++) this.code = this.code * 256 + this.next();
	}
	checkEnd(e) {
		if (this.at > this.bytes.length + et) throw ue(e);
	}
	flag(e, t, n, r) {
		return this.node(e, t, n, r, 0) === 1;
	}
	raw(e) {
		let t = 0;
		for (let n = 0; n < e; n++) t = t * 2 + this.split(z / 2);
		return t;
	}
	integer(e, t, n, r) {
		let i = this.magnitude(e, t, n, r);
		return i === 0 ? 0 : this.node(e, t, n, r, Je) ? -i : i;
	}
	magnitude(e, t, n, r) {
		if (!this.node(e, t, n, r, qe)) return 0;
		let i = 0;
		for (; i < Qe && this.node(e, t, n, r, Ye + i);) i += 1;
		if (i < 2) return i + 1;
		let a = 1;
		for (let o = i - 2; o >= 0; o--) {
			let s;
			s = o === i - 2 ? this.node(e, t, n, r, Xe + i) : o === i - 3 ? this.node(e, t, n, r, Ze + 2 * Math.min(i, 9) + (a & 1)) : this.split(z / 2), a = a * 2 + s;
		}
		return a + 1;
	}
	node(e, t, n, r, i) {
		return this.bit(e * Ke + i, t * Ke + i, n * Ke + i, (r * Ke + i) * 3);
	}
	bit(e, t, n, r) {
		let { probability: i, weights: a } = this, o = nt[i[e] >> 4], s = nt[i[t] >> 4], c = nt[i[n] >> 4], l = Math.floor((a[r] * o + a[r + 1] * s + a[r + 2] * c) / z), u = tt[Math.min(Math.max(l, -2047), 2047) + 2047], d = this.split(u), f = d ? z - u : -u;
		return a[r] += o * f >> 14, a[r + 1] += s * f >> 14, a[r + 2] += c * f >> 14, this.learn(e, d), this.learn(t, d), this.learn(n, d), d;
	}
	learn(e, t) {
		let [n, r] = [this.probability[e], this.seen[e]];
		this.probability[e] = n + Math.floor(((t ? 65535 : 0) - n) * rt[r] / z), r < Ge && (this.seen[e] = r + 1);
	}
	split(e) {
		let t = this.low + Math.floor((this.high - this.low) * e / z), n = +(this.code <= t);
		for (n ? this.high = t : this.low = t + 1; !((this.low ^ this.high) >>> 24);) this.low = this.low << 8 >>> 0, this.high = (this.high << 8 | 255) >>> 0, this.code = (this.code << 8 | this.next()) >>> 0;
		return n;
	}
	next() {
		return this.bytes[this.at++] ?? 0;
	}
};
function V(e, t, n, r = 1) {
	if (e.length < t) throw ue(n);
	if (e[0] !== r) throw M(n, `coded numbers of version ${e[0]}`);
	return new DataView(e.buffer, e.byteOffset, e.byteLength);
}
function at(e, t, n, r) {
	if (t > n || t > 16 * e.length + 1024) throw M(r, `${t} numbers announced`);
}
// eigenfield-three/src/table-decoder.ts
var ot = 12, st = 1, ct = 3, lt = 312, ut = ct * lt, dt = 938, ft = 24, pt = 16, mt = 1722, ht = 1726, gt = 4, _t = 5;
function vt(e) {
	return new it(e, ht, 21);
}
function yt(e) {
	return e.flag(ut, ut, ut, ct) ? 2 : e.flag(937, 937, 937, ct) ? st : 0;
}
function bt(e) {
	return Math.min(B(e), 11);
}
function xt(e, t, n, r) {
	let i = new Float64Array(n.length), a = n.length / t, o = (e, n, r) => n < 0 || r < 0 || r >= t ? 0 : e[n * t + r], s = 0;
	for (let c = 0; c < a; c++) for (let a = 0; a < t; a++) {
		let [l, u] = [o(i, c, a - 1), o(i, c - 1, a)], [d, f] = [o(i, c - 1, a - 1), o(i, c - 1, a + 1)], [p, m, h] = [
			0,
			0,
			s
		];
		r === st ? (p = c === 0 ? l : a === 0 ? u : Math.max(Math.min(l, u), Math.min(Math.max(l, u), l + u - d)), m = Math.abs(l - d) + Math.abs(u - d) + Math.abs(f - u)) : (m = 2 * Math.abs(l) + 2 * Math.abs(u) + Math.abs(d) + Math.abs(f), h = Math.abs(o(i, c, a - 2)) + Math.abs(o(i, c - 2, a)));
		let g = 2 * Math.abs(o(n, c, a)) + Math.abs(o(n, c, a - 1)) + Math.abs(o(n, c, a + 1)), _ = r === 2 ? Math.min(c, 2) * 4 + Math.min(a, 3) : Math.min(c, 1), v = r * lt, y = e.integer(v + bt(m) * ot + bt(g), v + 144 + bt(m + h), v + 144 + 24 + _ * ot + bt(g + Math.abs(l)), r);
		i[c * t + a] = p + y, s = Math.abs(y);
	}
	return i;
}
function St(e, t, n, r) {
	let i = new Float64Array(t * n), a = new Float64Array(n);
	for (let o = 0; o < t; o++) {
		let t = 0;
		for (let s = 0; s < n; s++) {
			let c = r && o > 0 ? i[(o - 1) * n + s] : 0, l = Math.min(s, 15), u = Math.min(B(a[s]), 23), d = Math.min(B(t), 23), f = e.integer(dt + l * ft + u, dt + (pt + l) * ft + d, 1706 + l, _t + l);
			i[o * n + s] = c + f, t = Math.abs(f), a[s] = Math.floor((a[s] + t + 1) / 2);
		}
	}
	return i;
}
function Ct(e, t, n, r) {
	let i = new Float64Array(t).fill(-1), a = new Uint8Array(n), [o, s, c] = [
		0,
		1,
		0
	];
	for (let l = 0; l < t; l++) {
		if (s = +!!e.flag(mt + s, mt + s, 1724, gt), !s) continue;
		let t = o + e.integer(1725, 1725, 1725, gt);
		if (!(t >= 0 && t < n) || a[t]) throw M(r, "a grid with a camera out of place");
		a[t] = 1, i[l] = t, o = t + 1, c += 1;
	}
	if (c !== n) throw M(r, "a grid without all cameras");
	return i;
}
// eigenfield-three/src/camera-decoder.ts
var wt = 130, Tt = 11, Et = 1, Dt = 2, Ot = 2, kt = 44 * L + 1024;
async function At(e, t) {
	if (e[0] !== Ot) throw M(t, `version ${e[0]}`);
	let n = await be(Uint8Array.from(e.subarray(1)), "deflate-raw", kt, t);
	return jt(Uint8Array.from([1, ...n]), t);
}
function jt(e, t) {
	let n = V(e, wt, t), [r, i] = [n.getUint8(1), n.getUint32(6, !0)], a = (r & Et) !== 0, [o, s] = a ? [n.getUint16(2, !0), n.getUint16(4, !0)] : [0, 0], c = Float64Array.from({ length: 15 }, (e, t) => n.getFloat64(10 + 8 * t, !0));
	if (r > 3 || i === 0 || !c.every(Number.isFinite)) throw M(t, "cameras that cannot be");
	if (i > 1e5 || a && o * s < i) throw M(t, `${i} cameras`);
	at(e, Math.max(Tt * i, o * s), Tt * L, t);
	let l = wt + (a ? 132 : 0);
	V(e, l, t);
	let u = (e, t) => a ? n.getFloat32(wt + 4 * (e * Tt + t), !0) : 0, d = vt(e.subarray(l)), f = a ? Ct(d, o * s, i, t) : null, p = St(d, i, Tt, (r & Dt) !== 0);
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
	], g = Nt(c[3], c[4], c[5], c[6]), _ = new Float64Array(Tt), v = 0;
	for (let e = 0; e < (f ? f.length : i); e++) {
		let t = f ? f[e] : e;
		if (t < 0) continue;
		let [n, r] = f ? [Math.floor(e / s), e % s] : [0, 0];
		for (let e = 0; e < Tt; e++) {
			let t = c[e < 5 ? 0 : e < 8 ? 1 : 2], i = u(0, e) + u(1, e) * n + u(2, e) * r;
			_[e] = p[v * Tt + e] * t + h[e] + i;
		}
		Mt(_, g, m, t), v += 1;
	}
	if (!m.intrinsics.every(Number.isFinite) || !m.poses.every(Number.isFinite)) throw M(t, "cameras that are not finite");
	return m;
}
function Mt(e, t, n, r) {
	n.intrinsics.set(e.subarray(0, 5), 5 * r);
	let [i, a, o] = [
		e[5],
		e[6],
		e[7]
	], s = i * i + a * a + o * o, c = 1 + s, l = Nt(2 * i / c, 2 * a / c, 2 * o / c, (1 - s) / c);
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
function Nt(e, t, n, r) {
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
// eigenfield-three/src/film-codes.ts
var Pt = /* @__PURE__ */ new Set([
	"I420P10",
	"I422P10",
	"I444P10"
]), Ft = /* @__PURE__ */ new Set([
	"I420",
	"I420A",
	"I422",
	"I444",
	"NV12"
]), It = /* @__PURE__ */ new Set([
	"RGBA",
	"RGBX",
	"BGRA",
	"BGRX"
]), Lt = 1, Rt = Uint16Array.from({ length: 256 }, (e, t) => Math.round(t * 1023 / 255)), zt = Uint16Array.from({ length: 256 }, (e, t) => Rt[16 + Math.round(t * 219 / 255)]), Bt = zt.map((e, t) => t === 0 ? 0 : t === 255 ? 1023 : e);
async function Vt(e, t, n = !1) {
	let r = e.format ?? "", { width: i, height: a } = e.visibleRect ?? {
		width: 0,
		height: 0
	};
	if (!Pt.has(r) && !Ft.has(r) && !It.has(r)) {
		let t = Ut(e, [i, a]);
		if (t) return Wt(t, 4 * i, 4, [i, a], Ht(e, n));
		throw new j("unsupported", `This browser does not hand out its frames (${r || "no format"}).`, "");
	}
	let o = e.allocationSize(), s = t && t.length >= o ? t : new Uint8Array(o), [c] = await e.copyTo(s), { offset: l, stride: u } = c ?? {
		offset: 0,
		stride: 0
	};
	if (Pt.has(r)) return {
		data: s.subarray(l),
		width: i,
		height: a,
		stride: u,
		room: s
	};
	let d = It.has(r), [f, p] = d ? [4, l + Lt] : [1, l], m = d ? Ht(e, n) : Rt;
	return Wt(s.subarray(p), u, f, [i, a], m);
}
function Ht(e, t) {
	return e.colorSpace?.fullRange === !1 ? t ? Bt : zt : Rt;
}
function Ut(e, t) {
	if (typeof OffscreenCanvas > "u" || !t[0]) return null;
	let n = new OffscreenCanvas(...t).getContext("2d", { willReadFrequently: !0 });
	return n?.drawImage(e, 0, 0), n?.getImageData(0, 0, ...t).data ?? null;
}
function Wt(e, t, n, [r, i], a = Rt) {
	let o = new Uint16Array(r * i);
	for (let s = 0; s < i; s++) for (let i = 0; i < r; i++) o[s * r + i] = a[e[s * t + n * i]];
	return {
		data: new Uint8Array(o.buffer),
		width: r,
		height: i,
		stride: 2 * r,
		grown: !0
	};
}
function Gt({ data: e, stride: t }, { size: [n, r], at: i }) {
	return i.map(([i, a]) => ({
		data: e.subarray(a * t + 2 * i),
		width: n,
		height: r,
		stride: t
	}));
}
// eigenfield-three/src/film-decoder.ts
var Kt = 4, qt = ["prefer-software", "no-preference"], Jt = class {
	size;
	where;
	user;
	decoder = null;
	config = null;
	turn = 0;
	onTheWay = 0;
	opened = 0;
	constructor(e, t, n) {
		this.size = e, this.where = t, this.user = n;
	}
	get open() {
		return this.opened;
	}
	get busy() {
		return this.onTheWay > 0;
	}
	get ready() {
		return this.onTheWay < Kt || this.decoder?.state === "closed";
	}
	async start(e) {
		let { level: t, tier: n, width: r, height: i } = ye(e, this.where);
		if (r !== this.size[0] || i !== this.size[1]) throw M(this.where, `frames of ${r} x ${i}`);
		let a = `av01.0.${String(t).padStart(2, "0")}${n ? "H" : "M"}.10`, { turn: o } = this, s = this.config?.codec === a, c = s ? this.config : await Yt(a, this.size, this.where);
		o === this.turn && c && (s && this.decoder?.state === "configured" || (this.config = c, this.decoder && this.decoder.state !== "closed" || (this.decoder = this.made()), this.decoder.configure(c)));
	}
	decode(e, t, n) {
		if (this.decoder?.state === "closed") return this.user.lost();
		this.onTheWay += 1, this.decoder?.decode(new EncodedVideoChunk({
			type: n ? "key" : "delta",
			timestamp: t,
			data: e
		}));
	}
	async flush() {
		await this.decoder?.flush().catch(() => void 0);
	}
	reset() {
		this.turn += 1, this.onTheWay = 0, this.decoder?.state === "configured" && this.decoder.reset();
	}
	dispose() {
		this.reset(), this.decoder && this.decoder.state !== "closed" && this.decoder.close(), this.decoder = null;
	}
	made() {
		let e = new VideoDecoder({
			output: (e) => void this.receive(e),
			error: (t) => {
				this.decoder === e && (t.name === "QuotaExceededError" ? this.user.lost() : t.name === "NotSupportedError" ? this.fail(this.turn, Xt(this.where)) : this.fail(this.turn, M(this.where, t.message)));
			}
		});
		return e;
	}
	async receive(e) {
		let { turn: t } = this;
		this.opened += 1;
		try {
			await this.user.take(e.timestamp, (...t) => Vt(e, ...t));
		} catch (e) {
			this.fail(t, e);
		} finally {
			e.close(), --this.opened, t === this.turn && --this.onTheWay, this.user.closed();
		}
	}
	fail(e, t) {
		e === this.turn && (this.reset(), this.user.failed(t));
	}
};
async function Yt(e, [t, n], r) {
	for (let r of typeof VideoDecoder > "u" ? [] : qt) {
		let i = {
			codec: e,
			codedWidth: t,
			codedHeight: n,
			hardwareAcceleration: r,
			optimizeForLatency: !0
		};
		if ((await VideoDecoder.isConfigSupported(i).catch(() => null))?.supported) return i;
	}
	throw Xt(r);
}
function Xt(e) {
	return new j("codec", `This browser ${globalThis.isSecureContext ? "decodes no AV1 of 10 bits" : "plays clips from https and localhost only"}; ${globalThis.isSecureContext ? "use a newer browser" : "open the page from there"}. The first frame is shown.`, e);
}
// eigenfield-three/src/mesh-front.ts
var Zt = 0, Qt = 2 ** 24, $t = class {
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
		if (this.status[e] = this.status[t] = Zt, this.status[n] === 1 && this.end[n] === r && n !== t) {
			this.status[n] = Zt, this.link(this.before[t], this.after[n]);
			return;
		}
		let i = this.before[t], a = this.add(r, this.end[e], this.start[e]);
		this.link(i, a), this.link(a, n);
	}
	closeRight(e) {
		let [t, n] = [this.before[e], this.after[e]];
		this.status[e] = this.status[n] = Zt;
		let r = this.after[n], i = this.add(this.start[e], this.end[n], this.end[e]);
		this.link(t, i), this.link(i, r);
	}
	openOut(e, t) {
		let [n, r, i] = [
			this.before[e],
			this.after[e],
			this.into[t]
		];
		this.status[e] = Zt;
		let a = this.add(this.start[e], t, this.end[e]), o = this.add(t, this.end[e], this.start[e]);
		i >= 0 && this.status[i] !== Zt ? (this.link(a, this.after[i]), this.link(i, o)) : this.link(a, o), this.link(n, a), this.link(o, r), this.into[t] = a;
	}
	link(e, t) {
		this.after[e] = t, this.before[t] = e;
	}
	add(e, t, n) {
		let { heap: r, key: i, points: a } = this, o = this.gates++;
		this.start[o] = e, this.end[o] = t, this.opposite[o] = n, this.status[o] = 1, this.into[t] = o;
		let s = (a[3 * e] + a[3 * t]) * Qt + a[3 * e + 1] + a[3 * t + 1], c = this.waiting++;
		for (; c > 0;) {
			let e = c - 1 >> 1;
			if (i[e] <= s) break;
			r[c] = r[e], i[c] = i[e], c = e;
		}
		return r[c] = o, i[c] = s, o;
	}
}, en = 2 ** 20, tn = .8, nn = 44, rn = 385, an = 897, on = 1086, sn = 1095, [cn, ln, un, dn, fn] = [
	0,
	1,
	2,
	3,
	15
];
function pn(e) {
	return Math.floor(Math.min(Math.max(e, -en), en) + .5);
}
function mn(e, t, n) {
	let r = Math.max((1 << n) - 1, 1);
	return (e[3 * t] & r ? 1 : 0) + (e[3 * t + 1] & r ? 2 : 0);
}
function hn(e, t, n, r, i) {
	i.flat ? gn(e, t, n, r, i.fine) : _n(e, t, n, r);
}
function gn(e, t, n, r, i) {
	let { a, b: o, o: s, pair: c } = r, [l, u, d, f] = [
		t[3 * a],
		t[3 * a + 1],
		t[3 * o],
		t[3 * o + 1]
	], [p, m] = [d - l, f - u], h = p * (t[3 * s + 1] - u) - m * (t[3 * s] - l), g = h > 0 ? tn : -.8, _ = 1 << i >> 1, v = pn((l + d) * .5 + g * m) + _ >> i, y = pn((u + f) * .5 - g * p) + _ >> i, b = 4 ** i, x = Math.min(B(Math.floor((p * p + m * m) / b)), 23), S = Math.min(B(Math.floor(Math.abs(h) / b)), 23), C = +(p < 0) + (m < 0 ? 2 : 0) + (Math.abs(m) > Math.abs(p) ? 4 : 0), w = e.integer(x * 8 + C, 192 + S, 216 + c, cn), T = Math.min(B(Math.abs(w)), 7), [E, ee] = [577, 705], D = T * 2 + +(w > 0), O = e.integer(rn + x * 8 + C, E + D * 8 + C, ee + S * 8 + T, ln);
	if (t[3 * n] = v + w << i, t[3 * n + 1] = y + O << i, i === 0) return;
	let k = mn(t, a, i) + 4 * mn(t, o, i);
	if (e.flag(an + k, 913 + mn(t, s, i), 917 + c, fn)) for (let r = 0; r < 2; r++) t[3 * n + r] += e.raw(i) - _;
}
function _n(e, t, n, { a: r, b: i, o: a }) {
	let o = 0;
	for (let e = 0; e < 3; e++) o += (t[3 * i + e] - t[3 * r + e]) ** 2;
	let s = Math.min(B(o), 43), c = 0;
	for (let o = 0; o < 3; o++) {
		let l = pn(t[3 * r + o] + t[3 * i + o] - t[3 * a + o]), u = e.integer(s, nn + o * 24 + c, 116 + o * nn + s, un);
		t[3 * n + o] = l + u, c = Math.min(B(Math.abs(u)), 23);
	}
}
function vn(e, t, n, r, i) {
	for (let a = 0; a < (i ? 2 : 3); a++) {
		let i = r >= 0 ? Math.min(Math.max(t[3 * r + a], -en), en) : 0, o = on + a;
		t[3 * n + a] = i + e.integer(o, o + 3, o + 6, dn);
	}
}
// eigenfield-three/src/mesh-faces.ts
var yn = 13, bn = 11, xn = 12, H = 169, Sn = 8, Cn = sn, wn = Cn + H + 104 + 26, Tn = wn + H + 104 + yn, En = Tn + 64 + 64 + H, Dn = En + H + 4 + 1, On = Dn + 6, [kn, An, jn, Mn, Nn] = [
	4,
	5,
	6,
	7,
	8
], Pn = [
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
function Fn(e, t, n, r, i) {
	let a = new Int32Array(3 * t), o = {
		points: a,
		faces: new Int32Array(3 * n),
		parents: new Int32Array(3 * t).fill(-1)
	}, s = new Int32Array(t), c = new $t(a, n), [l, u] = [0, 0], d = (e, t, n) => {
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
		if (l >= t) throw M(i, "more places than announced");
		return l++;
	}, p = () => {
		let t = e.raw(B(l - 1));
		if (t >= l) throw M(i, "a place that is not there yet");
		return t;
	}, m = () => {
		let t = [
			-1,
			-1,
			-1
		];
		for (let n = 0; n < 3; n++) if (l > 0 && e.flag(Dn + n, Dn + 3 + n, Dn + n, Nn)) t[n] = p();
		else {
			let i = t[n] = f();
			vn(e, a, i, n > 0 ? t[n - 1] : i - 1, r.flat);
		}
		let [n, o, s] = t;
		if (n === o || o === s || s === n) throw M(i, "a face of two corners");
		d(n, o, s), c.seed(t);
	}, h = (e, t, n, i) => c.status[t] === 2 ? xn : c.status[t] !== 1 || n === i || t === e ? bn : In(a, c.start[e], c.end[e], n, c.opposite[e], r.flat);
	for (; u < n;) {
		let t = c.next();
		if (t < 0) {
			m();
			continue;
		}
		let [n, l] = [c.start[t], c.end[t]], [u, g] = [c.before[t], c.after[t]], [_, v] = [c.start[u], c.end[g]], [y, b] = [h(t, u, _, l), h(t, g, v, n)], x = y * yn + b, [S, C] = [Math.min(s[n], 7), Math.min(s[l], 7)], w = Cn + H + 104 + 2 * y + +(_ === v);
		if (y < bn && e.flag(Cn + x, Cn + H + y * Sn + S, w, kn)) {
			d(l, n, _), c.closeLeft(t);
			continue;
		}
		if (b < bn && (v !== _ || y >= bn) && e.flag(wn + x, wn + H + b * Sn + C, wn + H + 104 + b, An)) {
			d(l, n, v), c.closeRight(t);
			continue;
		}
		let T = +(y === xn) + (b === xn ? 2 : 0), E = mn(a, n, r.fine) + 4 * mn(a, l, r.fine), ee = Tn + 64 + S * Sn + C;
		if (e.flag(Tn + T * 16 + E, ee, Tn + 64 + 64 + x, jn)) {
			c.status[t] = 2;
			continue;
		}
		let D;
		if (e.flag(En + x, En + H + T, En + H + 4, Mn)) {
			D = f();
			let i = c.opposite[t];
			o.parents.set([
				n,
				l,
				i
			], 3 * D), hn(e, a, D, {
				a: n,
				b: l,
				o: i,
				pair: x
			}, r);
		} else if (D = p(), D === n || D === l) throw M(i, "a face of two corners");
		d(l, n, D), c.openOut(t, D);
	}
	if (l !== t) throw M(i, "fewer places than announced");
	return o;
}
function In(e, t, n, r, i, a) {
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
	let C = (u * (u - s) + d * (d - c) + f * (f - l)) / S, w = Pn.findIndex((e) => C < e);
	return w < 0 ? 10 : w + 1;
}
// eigenfield-three/src/mesh-corners.ts
var Ln = 32, Rn = 4, [zn, Bn, Vn, Hn] = [
	0,
	1,
	2,
	3
], Un = On, Wn = Un + 64 + 12 + 16, U = Wn + Rn + 1, Gn = U + 4, [Kn, qn, Jn] = [
	9,
	10,
	11
];
function Yn(e, t) {
	let n = new Int32Array(t + 1);
	for (let t of e) n[t + 1] += 1;
	for (let e = 0; e < t; e++) n[e + 1] += n[e];
	let r = n.slice(), i = new Int32Array(e.length);
	return e.forEach((e, t) => i[r[e]++] = t), {
		first: n,
		corners: i
	};
}
function Xn(e, t, n, r, i, a, o) {
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
	], m = new Int32Array(Rn), h = /* @__PURE__ */ new Int32Array(8), [g, _, v] = [
		0,
		0,
		-1
	], y = (e, n) => {
		for (let r = 0; r < 3; r++) if (t.faces[3 * e + r] === n) return r;
		return -1;
	}, b = (e, n) => {
		let [a, o] = [t.faces[3 * e + n], t.faces[3 * e + (n + 1) % 3]];
		for (let t = r[a]; t < Math.min(r[a + 1], r[a] + Ln); t++) {
			let n = Math.floor(i[t] / 3);
			if (n >= e) break;
			if (y(n, o) >= 0) return n;
		}
		return -1;
	}, x = (e, t) => l.faces[3 * e + y(e, t)], S = (n, r) => {
		let i = t.faces[3 * n + r], a = u[i];
		if (a < 0) return -1;
		h.fill(Hn);
		let s = 0;
		for (let e of [r, (r + 2) % 3]) {
			if (f[e] < 0) continue;
			let t = x(f[e], i);
			s === 1 && m[0] === t ? h[1] = p[e] : (m[s] = t, h[2 * s] = p[e], s += 1);
		}
		for (let e = 0; e < Ln && s < Rn && a >= 0; e++) (s < 1 || a !== m[0]) && (s < 2 || a !== m[1]) && (m[s++] = a), a = d[a];
		let c = -1;
		for (let t = 0; t < s && c < 0; t++) {
			let [n, i] = [h[2 * t], h[2 * t + 1]], a = Un + 76 + Math.min(s, 3) * 4 + n;
			e.flag(Un + t * 16 + n * 4 + i, Un + 64 + t * 3 + r, a, Kn) && (c = m[t]);
		}
		if (c < 0) {
			if (e.flag(Wn + s, Wn + s, Wn + Rn, qn)) return -1;
			if (c = e.raw(B(g - 1)), c >= g || l.place[c] !== i) throw M(o, "a corner that is elsewhere");
		}
		for (let e of [r, (r + 2) % 3]) f[e] >= 0 && (p[e] = x(f[e], i) === c ? Bn : Vn);
		return c;
	}, C = () => {
		let t = _++;
		if (!e.flag(U, U, U, Jn)) return l.kinds[t] = e.flag(U + 1, U + 1, U + 1, Jn) ? 2 : 0, t;
		l.kinds[t] = 1;
		let n = v;
		if (v = t, n >= 0 && e.flag(U + 2, U + 2, U + 2, Jn)) {
			let n = e.raw(B(t - 1));
			if (n >= t || l.kinds[n] !== 1) throw M(o, "a map that is not there");
			return l.maps.copyWithin(6 * t, 6 * n, 6 * n + 6), t;
		}
		let r = n >= 0 && e.flag(U + 3, U + 3, U + 3, Jn);
		for (let i = 0; i < 4; i++) l.maps[6 * t + i] = r ? l.maps[6 * n + i] : e.raw(32);
		for (let n = 4; n < 6; n++) l.maps[6 * t + n] = e.raw(a);
		return t;
	};
	for (let e = 0; e < s; e++) {
		for (let t = 0; t < 3; t++) f[t] = b(e, t), p[t] = zn;
		let r = -1, i = [];
		for (let a = 0; a < 3; a++) {
			let s = S(e, a);
			if (s >= 0) r = l.chart[s];
			else {
				if (g >= n) throw M(o, "more vertices than announced");
				s = g++;
				let r = t.faces[3 * e + a];
				l.place[s] = r, d[s] = u[r], u[r] = s, i.push(s);
			}
			l.faces[3 * e + a] = s;
		}
		r < 0 && (r = C());
		for (let e of i) l.chart[e] = r;
	}
	if (g !== n) throw M(o, "fewer vertices than announced");
	return l;
}
// eigenfield-three/src/mesh-values.ts
var Zn = 16, Qn = 6, $n = 13, er = 14, tr = 20, nr = Gn, rr = nr + 169 + 280 + 182, ir = rr + 144 + 576 + 48, [ar, or] = [12, 13], sr = [
	.5,
	1.5,
	3,
	6,
	12,
	30
];
function cr(e, t) {
	return pn(Number.isNaN(e) ? t : e);
}
function lr(e) {
	let t = sr.filter((t) => Math.abs(e) >= t).length;
	return e < 0 ? Qn - t : Qn + t;
}
function ur(e, t, n, r) {
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
		for (let e = n[t]; e < Math.min(n[t + 1], n[t] + Zn); e++) for (let i = 1; i < 3; i++) {
			let o = dr(a, r[e], i);
			if (o >= t) continue;
			let s = d(t, o);
			h += s * u(o), g += s, _ = Math.min(_, u(o)), v = Math.max(v, u(o));
			for (let e = n[o]; e < Math.min(n[o + 1], n[o] + Zn); e++) for (let n = 1; n < 3; n++) {
				let i = dr(a, r[e], n);
				i < t && d(t, i);
			}
		}
		let y = 13, b = t > 0 ? u(t - 1) : 0, x = b;
		g > 0 && (y = Math.min(B(v - _), 12), b = h / g, x = Math.min(Math.max(fr(s), p), m));
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
		let E = cr(x, b), [ee, D] = [lr(S - E), lr(b - E)], O = e.integer(nr + ee * $n + D, nr + 169 + y * tr + f, nr + 169 + 280 + ee * er + y, ar), k = E + O;
		i[3 * t + 2] = k, f = Math.min(B(Math.abs(O)), 19), p = t === 0 ? k : Math.min(p, k), m = t === 0 ? k : Math.max(m, k);
	}
}
function dr(e, t, n) {
	let r = t % 3;
	return e[t - r + (r + n) % 3];
}
function fr(e) {
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
function pr(e, t, n, r, i) {
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
		for (let e = r[t]; e < Math.min(r[t + 1], r[t] + Zn); e++) {
			let [r, s] = [dr(a, i[e], 1), dr(a, i[e], 2)];
			if (r < t && o[r] === o[t] && (g = Math.max(g, r)), s < t && o[s] === o[t] && (g = Math.max(g, s)), r >= t || s >= t) continue;
			let [u, d] = mr(n, c, l, t, r, s, f === 2);
			if (!Number.isFinite(u) || !Number.isFinite(d)) continue;
			p += u, m += d, h += 1;
			let v = Math.abs(l[2 * r] - l[2 * s]) + Math.abs(l[2 * r + 1] - l[2 * s + 1]);
			_ = Math.max(_, B(v));
		}
		g < 0 && (g = d), d = t;
		let v = [g >= 0 ? l[2 * g] : 0, g >= 0 ? l[2 * g + 1] : 0], y = h > 0 ? [p / h, m / h] : v, [b, x] = [Math.min(h, 2), Math.min(_, 23)], S = rr + 144;
		for (let n = 0; n < 2; n++) {
			let r = e.integer(rr + (n * 24 + x) * 3 + b, S + u[0] * 24 + x, S + 576 + n * 24 + u[n], or + n);
			l[2 * t + n] = cr(y[n], 0) + r, u[n] = Math.min(B(Math.abs(r)), 23);
		}
	}
	return l;
}
function mr(e, t, n, r, i, a, o) {
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
var hr = 144, gr = 2, _r = 3, vr = 18, yr = 8;
function br(e, t) {
	return Sr(e, t, 1);
}
function xr(e, t) {
	return Sr(e, t, gr);
}
function Sr(e, t, n) {
	let r = V(e, hr, t, n), [i, a, o] = [
		r.getUint8(1),
		r.getUint8(2),
		r.getUint8(3)
	], [s, c, l] = [
		4,
		8,
		12
	].map((e) => r.getUint32(e, !0)), u = Float64Array.from({ length: 16 }, (e, t) => r.getFloat64(16 + 8 * t, !0));
	if (s > je || l > je || c > Me) throw M(t, `${l} vertices and ${c} faces`);
	if (at(e, Math.max(s, c, l), Me, t), i > 1 || o > yr * i || a < 1 || a > vr || !u.every(Number.isFinite)) throw M(t, "a lattice that cannot be");
	let d = new it(e.subarray(hr), ir, 16), f = Fn(d, s, c, {
		flat: i === 1,
		fine: o
	}, t);
	d.checkEnd(t);
	let p = Yn(f.faces, s);
	i && ur(d, f, p.first, p.corners);
	let m = n === gr ? a + _r : 32, h = Xn(d, f, l, p.first, p.corners, m, t), g = Cr(f.points, u), _ = Yn(h.faces, l), v = pr(d, h, g, _.first, _.corners);
	d.checkEnd(t);
	let y = new Float32Array(h.maps.buffer);
	return Tr({
		...wr(f, h, g, v, 2 ** a, (e) => n === gr ? h.maps[e] / 2 ** (a + 1) - 2 : y[e]),
		matrix: u
	}, t);
}
function Cr(e, t) {
	let n = new Float64Array(e.length);
	for (let r = 0; r < e.length; r += 3) {
		let i = (n) => t[4 * n] * e[r] + t[4 * n + 1] * e[r + 1] + t[4 * n + 2] * e[r + 2] + t[4 * n + 3], a = i(3);
		for (let e = 0; e < 3; e++) n[r + e] = i(e) / a;
	}
	return n;
}
function wr(e, { faces: t, place: n, chart: r, kinds: i, maps: a }, o, s, c, l) {
	let u = new Float32Array(3 * n.length), d = new Int32Array(3 * n.length), f = new Float32Array(2 * n.length), p = new Float32Array(a.buffer);
	return n.forEach((t, n) => {
		u.set(o.subarray(3 * t, 3 * t + 3), 3 * n), d.set(e.points.subarray(3 * t, 3 * t + 3), 3 * n);
		let a = 6 * r[n], m = i[r[n]] === 1;
		for (let r = 0; r < 2; r++) {
			let i = a + 2 * r;
			f[2 * n + r] = m ? p[i] * e.points[3 * t] + p[i + 1] * e.points[3 * t + 1] + l(a + 4 + r) : s[2 * n + r] / c;
		}
	}), {
		positions: u,
		uv: f,
		indices: new Uint32Array(t),
		places: d
	};
}
function Tr(e, t) {
	let n = (e) => Math.abs(e) <= We;
	if (!e.positions.every(n) || !e.uv.every(n)) throw M(t, "positions or texture coordinates that are not finite");
	return e;
}
// eigenfield-three/src/mesh-motion.ts
var Er = 11, Dr = 2 ** 20, Or = 8, [kr, Ar] = [7, 8], jr = 12, [Mr, Nr, Pr, Fr] = [
	0,
	1,
	2,
	3
], Ir = 576, Lr = 720, Rr = 1152, zr = 1159, Br = 3, Vr = 4, Hr = class {
	mesh;
	where;
	frames;
	flags;
	decoder = null;
	moving;
	around;
	steps;
	off;
	decoded = 0;
	constructor(e, t, n) {
		this.mesh = t, this.where = n;
		let r = V(e, Er, n), i = t.places.length / 3, a = r.getUint32(5, !0);
		this.frames = r.getUint16(9, !0);
		let o = Er + this.frames;
		if (r.getUint32(1, !0) !== i || a > i) throw M(n, `${a} vertices that move, of another mesh`);
		if (this.frames < 1 || this.frames > 1024 || this.frames * a > Fe) throw M(n, `${a} vertices that move in ${this.frames} frames`);
		if (V(e, o, n), this.flags = e.slice(Er, o), this.flags.some((e) => e > kr + Ar)) throw M(n, "frames that cannot be");
		if (at(e, this.flags.reduce((e, t) => e + (t & 1) + (t >> 1 & 1) + (t >> 2 & 1), 0) * a, 3 * Fe, n), this.moving = new Int32Array(a), this.steps = new Int32Array(a && 3 * a * (2 + this.frames)), this.off = new Int32Array(3 * a), this.around = Kr(t.places, t.indices), !a) return;
		this.decoder = new it(e.subarray(o), zr, Vr);
		let s = Gr(this.decoder, i, this.around);
		if (s.reduce((e, t) => e + t, 0) !== a) throw M(n, "other vertices that move");
		this.around = this.start(s);
	}
	read(e) {
		for (; this.decoded <= Math.min(e, this.frames - 1); this.decoded += 1) this.decoder && this.readFrame(this.decoder, this.decoded);
	}
	place(e, t) {
		let { matrix: n } = this.mesh;
		t.set(this.mesh.positions);
		let r = this.moving.length;
		if (!r) return;
		let i = this.steps.subarray(3 * r * (2 + e), 3 * r * (3 + e));
		this.moving.forEach((e, r) => t.set(Ur(i, 3 * r, n), 3 * e));
	}
	start(e) {
		let { places: t, indices: n } = this.mesh, r = new Int32Array(e.length).fill(-1), i = 0;
		e.forEach((e, t) => {
			e && (this.moving[i] = t, r[t] = i++);
		});
		let a = new Int32Array(3 * i);
		return this.moving.forEach((e, n) => a.set(t.subarray(3 * e, 3 * e + 3), 3 * n)), this.steps.set(a), this.steps.set(a, a.length), Kr(a, Int32Array.from(n, (e) => r[e]));
	}
	readFrame(e, t) {
		let { steps: n, around: r, off: i } = this, { near: a, starts: o, twins: s } = r, c = 3 * this.moving.length, [l, u, d, f] = [
			this.flags[t],
			c * (2 + t),
			c * (1 + t),
			c * t
		], p = (l & Ar) !== 0, m = new Int32Array(c);
		for (let t = 0; t < this.moving.length; t++) {
			let [r, c] = [o[t], o[t + 1]], h = c - r, g = s[t] ? Mr : h === 0 ? Fr : h === 1 ? Pr : Nr;
			for (let o = 0; o < 3; o++) {
				let s = 3 * t + o;
				if (!(l >> o & 1)) {
					n[u + s] = n[d + s];
					continue;
				}
				let [_, v, y, b] = [
					Infinity,
					-Infinity,
					0,
					0
				];
				for (let e = r; e < c; e++) {
					let t = 3 * a[e] + o, r = n[u + t] - n[d + t];
					p && (r -= n[d + t] - n[f + t]), _ = Math.min(_, r), v = Math.max(v, r), y += r, b += Math.abs(m[t]);
				}
				let x = n[d + s];
				p && (x += x - n[f + s]), h && (x += Math.floor((2 * y + h) / (2 * h))), x = Math.min(Math.max(x, -Dr), Dr);
				let S = Wr(h && Math.floor(4 * b / h)), C = Wr(4 * Math.abs(i[s])), w = Wr(h && v - _);
				m[s] = e.integer((g * jr + S) * jr + C, Ir + (o * 4 + g) * jr + w, Lr + (o * jr + w) * jr + S, o), n[u + s] = x + m[s];
			}
		}
		this.off = m, e.checkEnd(this.where), this.check(u, c);
	}
	check(e, t) {
		for (let n = e; n < e + t; n += 3) if (!Ur(this.steps, n, this.mesh.matrix).every((e) => Math.abs(e) <= 1e30)) throw M(this.where, "positions that are not finite");
	}
};
function Ur(e, t, n) {
	let [r, i, a] = [
		e[t],
		e[t + 1],
		e[t + 2]
	], o = (e) => n[4 * e] * r + n[4 * e + 1] * i + n[4 * e + 2] * a + n[4 * e + 3], s = o(3);
	return [
		o(0) / s,
		o(1) / s,
		o(2) / s
	];
}
function Wr(e) {
	return Math.min(B(e), 11);
}
function Gr(e, t, { near: n, starts: r }) {
	let i = new Uint8Array(t), a = 0;
	for (let o = 0; o < t; o++) {
		let [t, s] = [r[o], r[o + 1]], c = 0;
		for (let e = t; e < s; e++) c += i[n[e]];
		let l = s === t ? 3 : c === 0 ? 0 : c === s - t ? 2 : 1;
		a = Number(e.flag(Rr + l, 1156 + a, 1158, Br)), i[o] = a;
	}
	return i;
}
function Kr(e, t) {
	let n = e.length / 3, r = Array.from({ length: n }, () => []), i = new Uint8Array(n), a = /* @__PURE__ */ new Map();
	for (let t = 0; t < n; t++) {
		let n = `${e[3 * t]} ${e[3 * t + 1]} ${e[3 * t + 2]}`, o = a.get(n);
		o === void 0 ? a.set(n, t) : (i[t] = 1, r[t].push(o));
	}
	for (let e = 0; e < t.length; e++) {
		let n = t[e];
		if (n < 0 || i[n]) continue;
		let a = e - e % 3;
		for (let i of [1, 2]) {
			let o = t[a + (e + i) % 3];
			o >= 0 && o < n && r[n].length < Or && r[n].push(o);
		}
	}
	let o = new Int32Array(n + 1);
	return r.forEach((e, t) => o[t + 1] = o[t] + e.length), {
		near: r.flat(),
		starts: o,
		twins: i
	};
}
// eigenfield-three/src/name-decoder.ts
var qr = 4 * R;
async function Jr(e, t, n) {
	let r = Math.min(Ae, qr * t), i = await be(Uint8Array.from(e), "deflate", r, n), a = i.length / t;
	if (a === 0 || !Number.isInteger(a)) throw M(n, `${i.length} bytes of ${t} names`);
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
			throw M(n, "names that are not UTF-8");
		}
	}
	return c;
}
// eigenfield-three/src/headers.ts
function Yr(e) {
	let t = new DataView(e);
	try {
		return Zr(t) ?? Qr(t) ?? $r(t) ?? ei(t);
	} catch (e) {
		if (e instanceof RangeError) return null;
		throw e;
	}
}
function Xr(e, t) {
	return String.fromCharCode(...[
		0,
		1,
		2,
		3
	].map((n) => e.getUint8(t + n)));
}
function Zr(e) {
	return e.getUint32(0) !== 2303741511 || e.getUint32(4) !== 218765834 || Xr(e, 12) !== "IHDR" ? null : {
		type: "image/png",
		width: e.getUint32(16),
		height: e.getUint32(20),
		bits: null
	};
}
function Qr(e) {
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
function $r(e) {
	if (Xr(e, 0) !== "RIFF" || Xr(e, 8) !== "WEBP") return null;
	let t = {
		type: "image/webp",
		bits: null
	}, n = Xr(e, 12), r = (t) => e.getUint16(t, !0) + 65536 * e.getUint8(t + 2);
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
function ei(e) {
	if (Xr(e, 4) !== "ftyp") return null;
	let t = null, n = null, r = (i, a) => {
		for (let o = i; o + 8 <= a;) {
			let i = e.getUint32(o), s = Xr(e, o + 4), c = i === 0 ? a : o + i;
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
var ti = {
	colorSpaceConversion: "none",
	premultiplyAlpha: "none"
}, ni = {
	"image/avif": "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOltZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAAAAABAAAAHmlsb2MAAAAARAAAAQABAAAAAQAAAQ0AAAAZAAAAKGlpbmYAAAAAAAEAAAAaaW5mZQIAAAAAAQAAYXYwMUNvbG9yAAAAAGhpcHJwAAAASWlwY28AAAAUaXNwZQAAAAAAAAAIAAAACAAAAA5waXhpAAAAAAEIAAAADGF2MUOBABwAAAAAE2NvbHJuY2x4AAEADQAGgAAAABdpcG1hAAAAAAAAAAEAAQQBAoMEAAAAIW1kYXQSAAoIGAi/aYCGg1AyCxlGIYeeaACQQNmg",
	"image/webp": "UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAAAdQwAIWsP+BiOh/AAA="
};
function ri(e, t, n) {
	let r = Yr(e);
	if (!r) throw M(t.where, "no picture");
	let { width: i, height: a, bits: o } = r;
	if (n && (i !== n[0] || a !== n[1])) throw M(t.where, `a picture of ${i} x ${a}, not of ${n[0]} x ${n[1]}`);
	if (t.codec.bits !== 8 && t.codec.bits !== o) throw M(t.where, `no picture of ${t.codec.bits} bits`);
	let s = i * a;
	if (!s || i > 16384 || a > 32768 || s > Te) throw M(t.where, `a picture of ${i} x ${a}`);
	return [i, a];
}
var ii = async (e, t, n) => {
	let r = t.pieces * t.textures, [i, a] = ri(e, t, n && [n[0], r * n[1]]), o = Yr(e)?.type ?? t.codec.mimeType, s;
	try {
		s = await createImageBitmap(new Blob([e], { type: o }), ti);
	} catch (e) {
		throw await ai(o) ? M(t.where, "it cannot be decoded") : oi(o, t, e);
	}
	if (s.width !== i || s.height !== a) throw s.close(), M(t.where, `decoded to ${s.width} x ${s.height}, not to ${i} x ${a}`);
	let c = a / r;
	return Array.from({ length: r }, (e, t) => ({
		picture: s,
		row: t * c,
		rows: c
	}));
};
async function ai(e) {
	let t = ni[e];
	if (!t) return !0;
	let n = Uint8Array.from(atob(t), (e) => e.charCodeAt(0));
	try {
		return (await createImageBitmap(new Blob([n], { type: e }))).close(), !0;
	} catch {
		return !1;
	}
}
function oi(e, t, n) {
	return new j("codec", `This browser cannot decode ${e.replace("image/", "").toUpperCase()} pictures; use a newer one, or encode the scene with --codec png.`, t.where, { cause: n });
}
// eigenfield-three/src/pictures-10bit.ts
var si = /* @__PURE__ */ new Set([
	"I420P10",
	"I422P10",
	"I444P10"
]), ci = async (e, t, n) => {
	let r = t.pieces * t.textures, [i, a] = ri(e, t, n && [n[0], r * n[1]]), o = await li(e, i, a);
	if (!o) return ii(e, t, n);
	let s = a / r;
	return Array.from({ length: r }, (e, t) => ({
		picture: o,
		row: t * s,
		rows: s
	}));
};
async function li(e, t, n) {
	if (typeof ImageDecoder > "u") return null;
	let r = null, i = null;
	try {
		r = new ImageDecoder({
			data: e,
			type: "image/avif"
		}), i = (await r.decode()).image;
		let a = i.visibleRect;
		if (!si.has(i.format ?? "") || a?.width !== t || a.height !== n) return null;
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
// eigenfield-three/src/triangle-decoder.ts
var ui = 5;
function di(e, t) {
	let n = V(e, ui, t).getUint32(1, !0);
	at(e, 3 * n, 6 * L, t);
	let r = vt(e.subarray(ui)), i = St(r, n, 3, !0);
	r.checkEnd(t);
	let a = i.map((e, t) => t % 3 ? i[t - t % 3] + e : e);
	if (!a.every((e) => e >= 0 && e < 1e5)) throw M(t, "triangles of cameras that there cannot be");
	return { corners: Uint32Array.from(a) };
}
// eigenfield-three/src/weight-decoder.ts
var fi = 14, pi = 2 ** 20;
function mi(e, t) {
	let n = V(e, fi, t), r = n.getUint8(1) === 1, [i, a] = [n.getUint32(6, !0), n.getUint32(10, !0)], o = r ? n.getUint16(2, !0) : 1, s = r ? n.getUint16(4, !0) : i;
	if (n.getUint8(1) > 1 || i === 0) throw M(t, "weights of no camera, or of an unknown kind");
	at(e, o * s * Math.max(a, 1), Ue, t), V(e, fi + 4 * a, t);
	let c = o * s;
	if (c < i) throw M(t, "a grid with too few cells");
	let l = vt(e.subarray(fi + 4 * a)), u = r ? Ct(l, c, i, t) : null, d = u !== null && i === c, f = [
		0,
		1,
		2
	].map(() => new Float64Array(c)), p = new Float32Array(i * a), m = 4 * pi * Math.max(o, s);
	for (let e = 0; e < a; e++) {
		let r = n.getFloat32(fi + 4 * e, !0);
		if (!(r > 0 && r < Infinity)) throw M(t, "a step that is not positive");
		let i = yt(l), h = xt(l, s, f[i], i);
		if (i === 2 && !d || h.some((e) => Math.abs(e) > m)) throw M(t, `numbers of component ${e} that cannot be`);
		f[i] = h;
		let g = i === 2 ? hi(h, o, s) : h;
		for (let t = 0; t < c; t++) {
			let n = u ? u[t] : t;
			n >= 0 && (p[n * a + e] = g[t] * r);
		}
		l.checkEnd(t);
	}
	if (!p.every(Number.isFinite)) throw M(t, "weights that are not finite");
	return {
		cameras: i,
		components: a,
		values: p
	};
}
function hi(e, t, n) {
	let r = new Float64Array(t * n), i = new Float64Array(t * n), a = gi(n);
	for (let i = 0; i < t; i++) for (let t = 0; t < n; t++) {
		let o = 0;
		for (let r = 0; r < n; r++) o += a(r, t) * e[i * n + r];
		r[i * n + t] = o;
	}
	let o = gi(t);
	for (let e = 0; e < t; e++) for (let a = 0; a < n; a++) {
		let s = 0;
		for (let i = 0; i < t; i++) s += o(i, e) * r[i * n + a];
		i[e * n + a] = s;
	}
	return i;
}
function gi(e) {
	let [t, n] = [Math.sqrt(1 / e), Math.sqrt(2 / e)], r = Float64Array.from({ length: 4 * e }, (t, r) => n * Math.cos(Math.PI * r / (2 * e)));
	return (n, i) => n === 0 ? t : r[(2 * i + 1) * n % (4 * e)];
}
// eigenfield-three/src/codecs.ts
function _i(e) {
	let [t, n] = [ii, ii];
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
var W = {
	"mesh-1": {
		kind: "mesh",
		decode: br,
		needs: "codedMesh",
		limits: ["MAX_VERTICES", "MAX_TRIANGLES"]
	},
	"mesh-2": {
		kind: "mesh",
		decode: xr,
		needs: "mesh-2",
		limits: ["MAX_VERTICES", "MAX_TRIANGLES"]
	},
	"cameras-1": {
		kind: "cameras",
		decode: jt,
		needs: "codedCameras",
		limits: ["MAX_CAMERAS"]
	},
	"cameras-2": {
		kind: "cameras",
		decode: At,
		needs: "cameras-2",
		limits: ["MAX_CAMERAS"]
	},
	"names-1": {
		kind: "names",
		decode: Jr,
		needs: "codedNames",
		limits: ["MAX_NAMES", "MAX_CAMERAS"]
	},
	"triangles-1": {
		kind: "triangles",
		decode: di,
		needs: "codedTriangles",
		limits: ["MAX_CAMERAS"]
	},
	"weights-1": {
		kind: "weights",
		decode: mi,
		needs: "codedWeights",
		limits: ["MAX_WEIGHTS"]
	},
	"film-1": {
		kind: "film",
		decode: (...e) => new Jt(...e),
		needs: "film-1",
		limits: ["MAX_FILM_SIDE", "MAX_FILM_PIXELS"]
	},
	"motion-1": {
		kind: "motion",
		decode: (...e) => new Hr(...e),
		needs: "motion-1",
		limits: ["MAX_GROUP_FRAMES", "MAX_MOTION"]
	},
	png: _i("image/png"),
	webp: _i("image/webp"),
	avif: _i("image/avif"),
	jpeg: _i("image/jpeg"),
	"av1-10bit-1": {
		..._i("image/avif"),
		bits: 10,
		decode: ci,
		needs: "bits"
	},
	"av1-10bit-2": {
		..._i("video/AV1"),
		bits: 10,
		decode: (e, t, n) => ci(ve(e, t.where), t, n),
		bitmaps: (e, t, n) => ii(ve(e, t.where), t, n),
		needs: "av1-10bit-2"
	}
}, vi = {
	mesh: "mesh-1",
	cameras: "cameras-1",
	names: "names-1",
	triangles: "triangles-1",
	weights: "weights-1"
};
function yi(e, t, n) {
	let r = t.exists ? t.text(R) : n, i = Object.hasOwn(W, r) ? W[r] : null;
	if (i?.kind === e) return i;
	throw new j("codec-unknown", `${`A ${e} stream has the codec "${r.slice(0, 60)}", which this viewer does not know`}; take a newer viewer.`, t.where);
}
function bi(e, t) {
	return Object.keys(W).find((n) => {
		let r = W[n];
		return r.kind === "picture" && r.mimeType === e && (t ?? r.bits) === r.bits;
	});
}
// eigenfield-three/src/json.ts
var G = class e {
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
	number(e = -We, t = We) {
		if (typeof this.raw != "number") throw this.wrong("no number");
		if (!(this.raw >= e && this.raw <= t)) throw this.wrong(`${this.raw} is not in ${e}..${t}`);
		return this.raw;
	}
	integer(e, t) {
		let n = this.number(e, t);
		if (!Number.isInteger(n)) throw this.wrong(`${n} is no whole number`);
		return n;
	}
	numbers(e, t = -We, n = We) {
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
		return M(this.where || "/", this.exists ? e : "missing");
	}
}, xi = 5121, Si = 5123, Ci = 5125, wi = 5126, Ti = {
	[xi]: 1,
	[Si]: 2,
	[Ci]: 4,
	[wi]: 4
}, Ei = /* @__PURE__ */ new Set([
	"cameras",
	"triangles",
	"weights"
]), Di = {
	SCALAR: 1,
	VEC2: 2,
	VEC3: 3
};
function Oi(e) {
	let t = e.key("buffers").at(0);
	if (t.key("uri").exists) throw t.wrong("not the binary chunk");
	let n = t.key("byteLength").integer(0, 2 ** 32 - 1);
	return e.key("bufferViews").items(I).map((e) => {
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
function ki(e) {
	return (t) => t.integer(0, e.length - 1);
}
function Ai(e, t) {
	let n = e.key("accessors"), r = n.exists ? n.items(I) : [];
	return (e, n, i, a) => {
		let o = r[e.integer(0, r.length - 1)];
		if (!o) throw e.wrong("no such accessor");
		let s = o.key("componentType").integer(5120, 5126);
		if (!i.includes(s)) throw o.wrong(`component type ${s}`);
		if (o.key("type").text(1024) !== n) throw o.wrong(`not ${n}`);
		if (o.key("sparse").exists) throw o.wrong("sparse");
		let c = o.key("normalized");
		if (c.exists && c.raw !== !1) throw o.wrong("normalised");
		let l = Di[n] ?? 1, u = o.key("count").integer(1, Ue);
		if (a !== null && u !== a) throw o.wrong(`${a} numbers are needed, not ${u}`);
		let d = o.key("bufferView").integer(0, t.length - 1), f = t[d];
		if (!f) throw o.wrong("no such buffer view");
		let p = o.key("byteOffset"), m = p.exists ? p.integer(0, f.length) : 0, h = Ti[s] * l;
		if (f.stride && (f.stride < h || n === "SCALAR")) throw o.wrong("a stride that cannot be");
		if (m + (u - 1) * (f.stride || h) + h > f.length) throw o.wrong("outside its buffer view");
		if ((m + f.offset) % Ti[s]) throw o.wrong("not aligned");
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
function ji(e, t, n) {
	let r = typeof t.raw == "number" && Ei.has(e), i = yi(e, r ? new G(void 0, t.where) : t.key("codec"), vi[e]);
	return {
		view: n(r ? t : t.key("bufferView")),
		codec: i,
		where: t.where
	};
}
async function Mi(e, t, n) {
	let r = await n(e.view), i = t[e.view]?.length ?? Infinity;
	if (r.byteLength < i) throw ue(e.where);
	let { offset: a, count: o, items: s, type: c } = e, l = r.slice(a, a + Ti[c] * o * s);
	return c === 5125 ? new Uint32Array(l) : c === 5123 ? new Uint16Array(l) : Ni(new Float32Array(l), e.where);
}
function Ni(e, t) {
	for (let n of e) if (!(Math.abs(n) <= 1e30)) throw M(t, `${n} among its numbers`);
	return e;
}
// eigenfield-three/src/planes.ts
var Pi = 8, Fi = 16, Ii = "av1-10bit-2";
function Li(e, t) {
	return new j("unsupported", `The scene has ${e}, which this viewer does not draw; draw it with "eigenfield render".`, t);
}
function Ri(e, t = Ce) {
	let [n = 0, r = 0] = e.items(2).map((e) => e.integer(1, t));
	if (!n || !r) throw e.wrong("two numbers are needed");
	if (n * r > Te) throw e.wrong(`more than ${Te} texels`);
	return [n, r];
}
function zi(e, t, n, r, i) {
	let a = e.key("planes").items(16);
	if (!a.length) throw e.key("planes").wrong("no plane");
	let o = a.map((e, a) => {
		let o = e.key("channels").integer(1, 64), s = Xi(e, o, a === 0 ? n : null, i), c = e.key("bases").items(64), l = (e) => $i(e, o, t, r, i);
		return {
			channels: o,
			...s,
			bases: c.map(l)
		};
	}), [s, c] = [0, 0];
	for (let { channels: e, meanSize: t, bases: n } of o) {
		s += 4 * e * (t ? t[0] * t[1] : 0);
		for (let { size: t, count: r, pictures: i } of n) {
			let n = i.reduce((e, { textures: t, codec: n }) => e + t * (n.bits === Pi ? 1 : 2), 0);
			s += t[0] * t[1] * e * n, c += r;
		}
	}
	if (c > 4096) throw e.key("planes").wrong(`more than ${Ee} textures`);
	if (s > De) throw e.key("planes").wrong("too large when it is decoded");
	return o;
}
function Bi(e, t) {
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
	throw Li(`${t.length > 1 ? `${t.length} planes` : `${n} channels`} and no colours for them`, `${e.where}/planes`);
}
function Vi(e, t, n, r, i, a = !1) {
	let o = Hi(e), s = t === 3 && o.bits === Pi ? 1 : t;
	r && ea(e, s * n, r);
	let [c, l] = [e.key("scale"), e.key("zero")], u = {
		view: i(e.key("bufferView")),
		codec: o,
		textures: n,
		pieces: s,
		where: e.where,
		part: null
	};
	return a && o.bits === Pi && !c.exists && !l.exists ? {
		...u,
		...Gi(t)
	} : {
		...u,
		scale: Yi(c, t, n),
		zero: Yi(l, t, n)
	};
}
function Hi(e) {
	let t = e.key("mimeType").text(R);
	if (!bi(t)) throw e.key("mimeType").wrong("an unknown type");
	let n = e.key("bits"), r = n.exists ? n.integer(1, Fi) : Pi, i = bi(t, r);
	if (!i) throw n.wrong(`${r} bits of ${t}`);
	let a = e.key("codec"), o = yi("picture", a, i);
	if (o.mimeType !== t || o.bits !== r) throw a.wrong(`${r} bits of ${t}`);
	return o;
}
function Ui(e, t, n) {
	let r = e.key("at").items(Ee * t).map((e) => {
		let [t = 0, n = 0] = e.numbers(2, 0, Ne);
		if (!Number.isInteger(t) || !Number.isInteger(n)) throw e.wrong("no whole numbers");
		return [t, n];
	});
	if (!r.length || r.length % t) throw e.key("at").wrong(`places of ${t} channels are needed`);
	let { where: i } = e, a = {
		film: e.key("film").integer(0, 3),
		size: n,
		at: r,
		where: i
	}, o = {
		scale: Array(r.length).fill(0),
		zero: Array(r.length).fill(0)
	};
	return {
		view: -1,
		codec: W[Ii],
		textures: r.length / t,
		pieces: t,
		where: i,
		part: a,
		...o
	};
}
function Wi(e, t, n) {
	let r = Ui(e, t, n);
	if (r.textures !== 1) throw e.key("at").wrong(`${t} places are needed`);
	return r;
}
function Gi(e) {
	return {
		scale: Array(e).fill(1 / 255),
		zero: Array(e).fill(0)
	};
}
function Ki(e) {
	return e.some(({ codec: e }) => e.bits > Pi);
}
function qi({ codec: e }) {
	return (2 ** e.bits - 1) / 255;
}
function Ji(e, t) {
	return t ? 1 : 1 / (255 * qi(e));
}
function Yi(e, t, n) {
	let r = e.items(t * n).map((e) => e.number());
	if (r.length === t * n) return r;
	if (r.length !== t) throw e.wrong(`${t} or ${t * n} numbers are needed`);
	return Array(n).fill(r).flat();
}
function Xi(e, t, n, r) {
	let i = e.key("mean");
	if (!i.exists) {
		if (n === null || t !== 1 && t !== 3) throw i.wrong("no mean");
		return {
			mean: {
				view: n,
				codec: W.png,
				textures: 1,
				pieces: 1,
				where: "/images/0",
				part: null,
				...Gi(t)
			},
			meanSize: null,
			precision: null
		};
	}
	let a = Ri(i.key("size"));
	if (i.key("film").exists) return {
		mean: Wi(i, t, a),
		meanSize: a,
		precision: null
	};
	let o = Vi(i, t, 1, a, r, !0);
	return {
		mean: o,
		meanSize: a,
		precision: Qi(i.key("precision"), o, r)
	};
}
function Zi(e, t) {
	let n = Ri(e.key("size")), r = e.key("film").exists ? Wi(e, 1, n) : (() => {
		let r = Hi(e);
		return ea(e, 1, n), {
			view: t(e.key("bufferView")),
			codec: r,
			textures: 1,
			pieces: 1,
			where: e.where,
			part: null
		};
	})();
	return {
		channels: 1,
		mean: {
			...r,
			scale: [1 / (2 ** r.codec.bits - 1)],
			zero: [0]
		},
		meanSize: n,
		precision: null
	};
}
function Qi(e, t, n) {
	if (!e.exists) return null;
	if (t.codec.bits === Pi) throw e.wrong(`of a mean of ${Pi} bits`);
	let r = Ri(e.key("size"), we), i = yi("picture", e.key("codec"), "png");
	if (i !== W.png) throw e.key("codec").wrong("no PNG");
	return {
		view: n(e.key("bufferView")),
		codec: i,
		size: r,
		textures: 1,
		pieces: 1,
		where: e.where
	};
}
function $i(e, t, n, r, i) {
	let a = Ri(e.key("size")), [o, s] = [e.key("grid"), e.key("corner")], c = o.exists ? Ri(o) : a, [l = 0, u = 0] = s.exists ? s.numbers(2, 0, Ce) : [];
	if (!Number.isInteger(l) || !Number.isInteger(u)) throw s.wrong("no whole numbers");
	if (l + a[0] > c[0] || u + a[1] > c[1]) throw e.wrong("textures beyond their grid");
	let d = e.where;
	if (e.key("film").exists) {
		let n = Ui(e, t, a), { textures: r } = n;
		if (r > 4096) throw e.wrong(`more than ${Ee} textures`);
		return {
			size: a,
			grid: c,
			corner: [l, u],
			pictures: [n],
			count: r,
			weights: null,
			where: d
		};
	}
	let f = 0, p = e.key("picture"), m = p.exists ? p.object() : {}, h = e.key("textures").items(Ee).map((e) => {
		let n = new G({
			...m,
			...e.object()
		}, e.where), r = n.key("count"), o = r.exists ? r.integer(1, Ee) : 1;
		return f += o, Vi(n, t, o, a, i);
	});
	if (f > 4096) throw e.wrong(`more than ${Ee} textures`);
	let g = e.key("codedWeights"), _ = f ? g.exists ? ji("weights", g, i) : r(e.key("weights"), "SCALAR", [wi], n * f) : null;
	return {
		size: a,
		grid: c,
		corner: [l, u],
		pictures: h,
		count: f,
		weights: _,
		where: d
	};
}
function ea(e, t, [n, r]) {
	let i = t * r;
	if (t > 1 && i > 32768) throw e.wrong(`a picture of ${i} rows`);
	if (n * i > Te) throw e.wrong(`more than ${Te} texels`);
}
// eigenfield-three/src/rights.ts
var ta = "KHR_xmp_json_ld", na = /[\p{Cc}\p{Cs}\p{Zl}\p{Zp}\u202a-\u202e\u2066-\u2069]/u;
function ra(e) {
	let t = aa(e, "asset", "extensions", ta, "packet"), n = aa(e, "extensions", ta, "packets"), r = Array.isArray(n) && typeof t == "number" ? n[t] : void 0, i = (e) => {
		let t = ia(aa(r, e)) ?? "";
		return [...t].length > 1e3 || na.test(t) ? "" : t;
	};
	return {
		title: i("dc:title"),
		author: i("dc:creator"),
		licence: i("dc:rights"),
		source: i("dc:source")
	};
}
function ia(e) {
	let t = aa(e, "@list") ?? aa(e, "@set");
	if (Array.isArray(t) && t.every((e) => typeof e == "string")) return t.join(", ");
	let n = typeof e == "string" ? e : aa(e, "rdf:_1", "@value");
	return typeof n == "string" ? n : null;
}
function aa(e, ...t) {
	for (let n of t) {
		if (typeof e != "object" || !e || Array.isArray(e) || !Object.hasOwn(e, n)) return;
		e = e[n];
	}
	return e;
}
// eigenfield-three/src/sheets.ts
function oa(e, t) {
	if (!e.exists) return null;
	let n = e.key("faces").items(32).map((e) => e.integer(1, Me));
	if (!n.length) throw e.key("faces").wrong("no sheet");
	return {
		faces: n,
		opacity: Zi(e.key("opacity"), t),
		where: e.where
	};
}
function sa({ faces: e, where: t }, { index: n, attributes: r }) {
	let i = e.reduce((e, t) => e + t, 0), a = (n?.count ?? 0) / 3;
	if (i !== a) throw M(`${t}/faces`, `the sheets have ${i} triangles, the mesh has ${a}`);
	let o = new Uint8Array(r.position?.count ?? 0), s = 0;
	e.forEach((e, r) => {
		for (let i = s + 3 * e; s < i; s++) {
			let e = n?.getX(s) ?? 0, i = o[e] || r + 1, a = `sheets ${i - 1} and ${r} share vertex ${e}`;
			if (i !== r + 1) throw M(`${t}/faces`, a);
			o[e] = i;
		}
	});
}
// eigenfield-three/src/timeline.ts
var ca = 64, K = 16, la = "audio/ogg", ua = "sound.opus", da = /^[0-9a-f]{64}$/;
function fa(e, t, n) {
	let r = [..._a(t), ...n ? [n] : []];
	if (!e.exists) {
		let e = r.find(({ part: e }) => e);
		if (e) throw M(e.where, "a texture in a film, and no timeline");
		return null;
	}
	let [i = 1, a = 1] = e.key("rate").numbers(2, 1, He), o = i / a;
	if (!(Number.isInteger(i) && Number.isInteger(a)) || o > 1e3 || o < 1 / 1e3) throw e.key("rate").wrong("no rate");
	let s = e.key("first"), c = e.key("films").items(4).map(ma), l = e.key("frames").integer(1, Ie);
	va(r, c);
	let u = new Set([...t.map(({ mean: e }) => e), n].map((e) => c[e?.part?.film ?? -1]));
	for (let e of c) e.opacity = e === c[n?.part?.film ?? -1], e.detail = !u.has(e);
	let d = ga(e, l);
	return {
		rate: o,
		first: s.exists ? s.number() : 0,
		frames: l,
		films: c,
		groups: d,
		sound: pa(e, d)
	};
}
function pa(e, t) {
	let n = e.key("audio");
	if (!n.exists) return null;
	if (n.key("mimeType").text(64) !== la) throw n.key("mimeType").wrong(`no ${la}`);
	let r = t.at(-1), i = r.file === null ? null : ua, a = i ? 0 : ha(n.key("offset"), r.offset + r.length), o = n.key("first"), s = n.key("length").integer(1, Ve);
	return {
		mimeType: la,
		first: o.exists ? o.number() : 0,
		offset: a,
		length: s,
		file: i
	};
}
function ma(e) {
	let t = yi("film", e.key("codec"), "film-1"), [n = 0, r = 0] = e.key("size").numbers(2, ca, Ne);
	if (n % ca || r % ca || n * r > Pe) throw e.key("size").wrong(`a film of ${n} x ${r}`);
	return {
		codec: t,
		size: [n, r],
		opacity: !1,
		detail: !1,
		where: e.where
	};
}
function ha(e, t) {
	let n = e.integer(t, 2 ** 53 - 1);
	if (n % 4) throw e.wrong("no multiple of 4");
	return n;
}
function ga(e, t) {
	let [n, r] = [0, 0], i = e.key("groupFiles");
	if (i.exists && i.raw !== !0) throw i.wrong("not true");
	let a = e.key("groups").items(Le).map((e, t) => {
		let a = i.exists ? `groups/${String(t).padStart(5, "0")}.eftg` : null, o = e.key("frames").integer(1, ze), s = e.key("length").integer(1, Re), c = a ? 0 : ha(e.key("offset"), r), l = e.key("sha256").text(64);
		if (!da.test(l)) throw e.key("sha256").wrong("no SHA-256");
		return [n, r] = [n + o, c + s], {
			first: n - o,
			frames: o,
			offset: c,
			length: s,
			file: a,
			sha256: l,
			where: e.where
		};
	});
	if (n !== t) throw e.key("groups").wrong(`${n} frames in groups, and ${t} in all`);
	return a;
}
function _a(e) {
	return e.flatMap(({ mean: e, bases: t }) => [e, ...t.flatMap((e) => e.pictures)]);
}
function va(e, t) {
	let n = t.map(({ size: e }) => new Uint8Array(e[0] * e[1] / K ** 2));
	for (let { part: r, where: i } of e) {
		let e = r && t[r.film];
		if (!r || !e) throw M(i, "it lies in no film");
		let [a, o] = [e.size[0] / K, n[r.film]], [s, c] = r.size.map((e) => Math.ceil(e / K));
		for (let [t, n] of r.at) {
			let l = t + r.size[0] <= e.size[0] && n + r.size[1] <= e.size[1];
			if (t % K || n % K || !l) throw M(i, `a texture at ${t}, ${n} of its film`);
			for (let e = n / K; e < n / K + c; e++) {
				let r = o.subarray(e * a + t / K, e * a + t / K + s);
				if (r.includes(1)) throw M(i, `two textures at ${t}, ${n} of a film`);
				r.fill(1);
			}
		}
	}
}
function ya({ rate: e, first: t, frames: n }, r) {
	return Math.min(Math.max(Math.floor((r - t) * e + .5), 0), n - 1);
}
function ba({ rate: e, first: t }, n) {
	return t + n / e;
}
function q({ groups: e }, t) {
	let [n, r] = [0, e.length - 1];
	for (; n < r;) {
		let i = n + r + 1 >> 1;
		(e[i]?.first ?? Infinity) <= t ? n = i : r = i - 1;
	}
	return n;
}
// eigenfield-three/src/document.ts
var xa = [
	"groupFiles",
	"namePattern",
	"noFallback",
	"packed",
	"precision",
	"regions",
	"sharedPicture",
	"sheets",
	"stacks",
	"timeline",
	"toRGB"
], Sa = Object.values(W).flatMap(({ needs: e }) => e ?? []), Ca = /* @__PURE__ */ new Set([...xa, ...Sa]), wa = 64, Ta = 9, Ea = 10 ** Ta;
function Da(e) {
	let t = new G(e, "");
	try {
		return t.key("extensions").key(xe).exists;
	} catch {
		return !1;
	}
}
function Oa(e) {
	let t = new G(e, ""), n = t.key("extensions").key(xe), r = ja(n), i = Oi(t), a = Ai(t, i), o = ki(i);
	Ma(t);
	let s = Fa(t, o), c = n.key("cameras"), { count: l, names: u } = Ia(c, o), d = za(c, l), f = d.filter((e) => !e).length, p = zi(n, f, s, a, o), m = Bi(n, p), h = c.key("colour"), g = c.key("codedColour");
	if ((h.exists || g.exists) && m.length < 3) throw h.wrong("needs three channels");
	let _ = n.key("viewPlane"), [v, y] = [_.key("triangles"), _.key("codedTriangles")], b = n.key("generator"), [x, S] = [n.key("mesh"), n.key("timeline")], C = oa(n.key("sheets"), o);
	return {
		version: r,
		generator: b.exists ? b.text(R) : "",
		rights: ra(e),
		planes: p,
		colours: m,
		names: u,
		heldOut: d,
		reference: n.key("reference").integer(0, l - 1),
		calibration: Ba(c, l, a, o),
		sizes: Va(c, l, a),
		colour: g.exists ? ji("weights", g, o) : h.exists ? a(h, "SCALAR", [wi], 6 * l) : null,
		...Ha(_),
		triangles: y.exists ? ji("triangles", y, o) : v.exists ? Pa(a(v, "SCALAR", [Si, Ci], null), 2 * L) : null,
		settings: Ua(n.key("settings")),
		scores: Ua(n.key("scores")),
		views: i,
		mesh: x.exists || S.exists ? ji("mesh", x, o) : null,
		sheets: C,
		shown: x.exists && !t.key("meshes").exists ? null : ka(t, a),
		preview: s,
		timeline: fa(S, p, C && C.opacity.mean)
	};
}
function ka(e, t) {
	let n = e.key("meshes").at(0).key("primitives").at(0), r = n.key("mode");
	if (r.exists && r.integer(0, 6) !== 4) throw r.wrong("no triangles");
	let [i, a] = [n.key("attributes"), n.key("indices")];
	return {
		position: Na(t(i.key("POSITION"), "VEC3", [wi], null), je),
		uv: Na(t(i.key("TEXCOORD_0"), "VEC2", [wi], null), je),
		indices: Pa(t(a, "SCALAR", [
			xi,
			Si,
			Ci
		], null), Me)
	};
}
function Aa({ planes: e, sheets: t }) {
	return t ? [...e, t.opacity] : e;
}
function ja(e) {
	let t = e.key("version").text(R);
	if (!/^1\.\d+$/.test(t)) throw new j("version", `The scene is of format version ${t.slice(0, 20)} and this viewer reads 1.x; take a newer viewer.`, `${e.where}/version`);
	let n = e.key("needs");
	for (let e of n.exists ? n.items(I) : []) {
		let t = e.text(R);
		if (!Ca.has(t)) throw new j("needs", `The scene needs "${t.slice(0, 60)}", which this viewer cannot draw; take a newer viewer.`, e.where);
	}
	return t;
}
function Ma(e) {
	let t = e.key("nodes").items(I), n = Array(t.length).fill(!1);
	for (let e of t) {
		let r = e.key("children");
		for (let e of r.exists ? r.items(t.length) : []) {
			let r = e.integer(0, t.length - 1);
			if (n[r]) throw e.wrong("a node with two parents");
			n[r] = !0;
		}
	}
	for (let r of e.key("scenes").items(I)) {
		let e = r.key("nodes");
		for (let r of e.exists ? e.items(t.length) : []) if (n[r.integer(0, t.length - 1)]) throw r.wrong("a node with two parents");
	}
}
function Na(e, t) {
	if (e.count > t) throw M(e.where, `more than ${t}`);
	return e;
}
function Pa(e, t) {
	if (e.count % 3) throw M(e.where, "torn triangles");
	return Na(e, 3 * t);
}
function Fa(e, t) {
	let n = e.key("images");
	if (!n.exists) return null;
	let r = n.at(0).key("bufferView");
	return r.exists ? t(r) : null;
}
function Ia(e, t) {
	let n = e.key("codedNames");
	if (n.exists) return {
		count: n.key("count").integer(1, L),
		names: ji("names", n, t)
	};
	let r = e.key("pattern"), i = r.exists ? r : e.key("names"), a = r.exists ? Ra(r) : i.items(L).map((e) => e.text(R));
	if (!a.length) throw i.wrong("no cameras");
	let o = La(a);
	if (o) throw i.wrong(o);
	return {
		count: a.length,
		names: a
	};
}
function La(e) {
	return new Set(e).size === e.length ? e.some((e) => /[\u0000-\u001f\u007f-\u009f]/.test(e)) ? "control characters" : null : "a name stands twice";
}
function Ra(e) {
	let [t = 0, n = 0] = e.key("counts").items(2).map((e) => e.integer(1, L));
	if (!n || t * n > 1e5) throw e.wrong("no counts of rows and columns");
	let r = e.key("parts").items(wa).map((e) => {
		if (typeof e.raw == "string") return [0, Array(t).fill(e.text(R))];
		let r = e.key("axis").integer(0, 1), i = r ? n : t, a = e.key("texts");
		if (a.exists) {
			let e = a.items(i).map((e) => e.text(R));
			if (e.length !== i) throw a.wrong(`${i} texts are needed`);
			return [r, e];
		}
		let [o, s] = [e.key("first").integer(0, Ea), e.key("step").integer(0, Ea)], c = e.key("digits").integer(1, Ta);
		return [r, Array.from({ length: i }, (e, t) => String(o + s * t).padStart(c, "0"))];
	});
	return Array.from({ length: t * n }, (t, i) => {
		let a = [Math.floor(i / n), i % n], o = r.map(([e, t]) => t[a[e] ?? 0]).join("");
		if (o.length > 1024) throw e.wrong(`names of more than ${R} characters`);
		return o;
	});
}
function za(e, t) {
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
function Ba(e, t, n, r) {
	let i = e.key("coded");
	return i.exists ? ji("cameras", i, r) : {
		intrinsics: n(e.key("intrinsics"), "SCALAR", [wi], 5 * t),
		poses: n(e.key("poses"), "SCALAR", [wi], 12 * t)
	};
}
function Va(e, t, n) {
	let r = e.key("size");
	if (!r.exists) return n(e.key("sizes"), "SCALAR", [Ci], 2 * t);
	let [i = 0, a = 0] = r.numbers(2, 1, Oe);
	if (!Number.isInteger(i) || !Number.isInteger(a)) throw r.wrong("no whole numbers");
	return [i, a];
}
function Ha(e) {
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
function Ua(e) {
	return e.exists ? e.object() : {};
}
// eigenfield-three/src/info.ts
var Wa = 1e-6;
async function Ga(e, t) {
	let [n, { lenses: r, poses: i }, a, o] = await Promise.all([
		qa(e, t),
		Ya(e, t),
		Xa(e, t),
		Ka(e, t)
	]);
	return n.map((t, n) => {
		let [s = 0, c = 0, l = 0, u = 0, d = 0] = r.numbers.subarray(5 * n, 5 * n + 5);
		if (!(s > Wa && c > Wa)) throw M(r.where, `focal lengths of "${t}"`);
		let { R: f, t: p } = Za([...i.numbers.subarray(12 * n, 12 * n + 12)], i.where, t), [m = 0, h = 0] = a.numbers.subarray(2 * n, 2 * n + 2);
		if (!m || !h || Math.max(m, h) > 65535 || m * h > ke) throw M(a.where, `"${t}" is ${m} x ${h} pixels`);
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
		], [_, v] = o ? Qa([...o.subarray(6 * n, 6 * n + 6)], e, t) : [null, null];
		return {
			name: t,
			K: g,
			R: f,
			t: p,
			centre: uo(f, p),
			width: m,
			height: h,
			gain: _,
			offset: v
		};
	});
}
async function Ka({ colour: e, heldOut: t, views: n }, r) {
	if (!e || "type" in e) return e && Mi(e, n, r);
	let { cameras: i, components: a, values: o } = await e.codec.decode(new Uint8Array(await r(e.view)), e.where);
	if (a !== 6 || i !== t.filter((e) => !e).length) throw M(e.where, `${i} x ${a} colours`);
	let s = 0;
	return Float32Array.from(t.flatMap((e) => e ? [
		1,
		1,
		1,
		0,
		0,
		0
	] : [...o.subarray(6 * s, 6 * ++s)]));
}
async function qa({ names: e, heldOut: t }, n) {
	if (Array.isArray(e)) return e;
	let r = await e.codec.decode(new Uint8Array(await n(e.view)), t.length, e.where), i = r.some((e) => e.length > 1024) ? "names that are too long" : La(r);
	if (i) throw M(e.where, i);
	return r;
}
async function Ja(e, t, n) {
	return {
		numbers: await Mi(e, t.views, n),
		where: e.where
	};
}
async function Ya(e, t) {
	let { calibration: n, heldOut: r } = e;
	if ("intrinsics" in n) {
		let { intrinsics: r, poses: i } = n;
		return {
			lenses: await Ja(r, e, t),
			poses: await Ja(i, e, t)
		};
	}
	let { view: i, codec: a, where: o } = n, s = await a.decode(new Uint8Array(await t(i)), o), c = s.poses.length / 12;
	if (c !== r.length) throw M(o, `${c} cameras in it, and ${r.length} names`);
	let l = (e) => ({
		numbers: Ni(e, o),
		where: o
	});
	return {
		lenses: l(s.intrinsics),
		poses: l(s.poses)
	};
}
async function Xa(e, t) {
	if (!Array.isArray(e.sizes)) return Ja(e.sizes, e, t);
	let [n, r] = e.sizes;
	return {
		numbers: Uint32Array.from({ length: 2 * e.heldOut.length }, (e, t) => t % 2 ? r : n),
		where: "its cameras' size"
	};
}
function Za(e, t, n) {
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
		if (!(Math.abs(a) <= 2e-4)) throw M(t, `the pose of "${n}" is no rotation`);
	}
	if (!(Y(fo(i[0], i[1]), i[2]) > 0)) throw M(t, `the pose of "${n}" is mirrored`);
	return {
		R: i,
		t: a
	};
}
function Qa(e, t, n) {
	let [r, i] = [e.slice(0, 3), e.slice(3)];
	if (!(r.every((e) => e >= 1 / 1e3 && e <= 1e3) && i.every((e) => Math.abs(e) <= 1e3))) throw M(t.colour?.where ?? "", `gain or offset of "${n}"`);
	return [r, i];
}
async function $a(e, t) {
	let n = e.heldOut.filter((e) => !e).length;
	return eo(n, await Promise.all(J(e).map((r) => to(r, n, e, t))));
}
function eo(e, t) {
	let n = t.reduce((e, { length: t }) => e + t, 0) / e, r = new Float32Array(e * n), i = 0;
	for (let a of t) {
		let t = a.length / e;
		for (let o = 0; o < e; o++) r.set(a.subarray(o * t, (o + 1) * t), o * n + i);
		i += t;
	}
	return r;
}
async function to({ weights: e, count: t }, n, r, i) {
	if (!e) return /* @__PURE__ */ new Float32Array();
	if ("type" in e) return Mi(e, r.views, i);
	let { view: a, codec: o, where: s } = e;
	return no(o.decode(new Uint8Array(await i(a)), s), n, t, s);
}
function no({ cameras: e, components: t, values: n }, r, i, a) {
	if (e === r && t === i) return Ni(n, a);
	throw M(a, `${e} x ${t} weights, and ${r} encoded cameras x ${i} textures`);
}
function J(e) {
	return e.planes.flatMap(({ bases: e }) => e);
}
function ro(e) {
	return Math.max(0, ...J(e).map(({ count: e }) => e));
}
function io(e, t) {
	let n = [...t.slice(0, e.planes.length), ...J(e).map(({ grid: e }) => e)];
	return [Math.max(...n.map(([e]) => e)), Math.max(...n.map(([, e]) => e))];
}
async function ao(e, t) {
	if (!e.triangles) return /* @__PURE__ */ new Uint32Array();
	let { where: n } = e.triangles, r = await oo(e.triangles, e, t), i = e.heldOut.filter((e) => !e).length;
	for (let e = 0; e < r.length; e += 3) {
		let [t = i, a = i, o = i] = r.subarray(e, e + 3);
		if (Math.max(t, a, o) >= i) throw M(n, `no encoded camera ${Math.max(t, a, o)}`);
		if (t === a || a === o || o === t) throw M(n, "a triangle with one camera twice");
	}
	return r;
}
async function oo(e, t, n) {
	return "type" in e ? Uint32Array.from(await Mi(e, t.views, n)) : e.codec.decode(new Uint8Array(await n(e.view)), e.where).corners;
}
function so(e, t, n, r, i, a) {
	let { right: o, up: s } = e, c = fo(o, s), l = [
		0,
		0,
		0
	];
	for (let { R: e } of t) for (let n = 0; n < 3; n++) l[n] += e[2][n] / t.length;
	let u = e.settings.metresPerUnit;
	return {
		version: e.version,
		generator: e.generator,
		rights: e.rights,
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
		bytes: co(e, i),
		size: io(e, n),
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
		mixedColours: e.colour !== null && !("type" in e.colour),
		sheets: e.sheets?.faces.length ?? 0,
		inFiles: e.timeline?.groups.some(({ file: e }) => e !== null) ?? !1,
		facesPlane: Math.abs(Y(l, c)) > .7
	};
}
function co(e, t) {
	let n = /* @__PURE__ */ new Set(), r = (t) => n.has(t) ? 0 : (n.add(t), e.views[t]?.length ?? 0), i = (e) => e.reduce((e, t) => e + r(t), 0), a = e.planes.flatMap(({ mean: e, precision: t }) => [e.view, ...t ? [t.view] : []]), o = i(e.preview === null ? a : [e.preview, ...a]), s = Array(ro(e)).fill(0);
	for (let { pictures: t } of J(e)) {
		let e = 0;
		for (let { view: n, textures: i } of t) {
			let t = r(n);
			for (let n = 0; n < i; n++) {
				let r = Math.floor(t * (n + 1) / i) - Math.floor(t * n / i);
				s[e] = (s[e++] ?? 0) + r;
			}
		}
	}
	let c = i(J(e).flatMap((e) => e.weights ? [e.weights.view] : [])), l = i([...Object.values(e.shown ?? {}), ...e.mesh ? [e.mesh] : []].map(({ view: e }) => e)), u = e.sheets ? r(e.sheets.opacity.mean.view) : 0, d = e.timeline?.groups.reduce((e, { length: t }) => e + t, 0) ?? 0;
	return {
		total: t,
		mesh: l,
		opacity: u,
		mean: o,
		weights: c,
		groups: d,
		other: t - o - c - l - u - d - s.reduce((e, t) => e + t, 0),
		textures: s
	};
}
function lo(e, t) {
	let { origin: n, extent: r } = e, i = [
		t[0] - n[0],
		t[1] - n[1],
		t[2] - n[2]
	];
	return [r[0] > 0 ? Y(i, e.right) / r[0] : 0, r[1] > 0 ? Y(i, e.up) / r[1] : 0];
}
function uo(e, t) {
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
function fo(e, t) {
	return [
		e[1] * t[2] - e[2] * t[1],
		e[2] * t[0] - e[0] * t[2],
		e[0] * t[1] - e[1] * t[0]
	];
}
// eigenfield-three/src/cameras.ts
function po(e, t, n) {
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
		let r = mo(n, o, s);
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
	let u = go(l), { origin: d, right: f, up: p, extent: m } = r.viewPlane, [h, g] = [ho(t) * m[0], ho(n) * m[1]], _ = [
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
function mo({ K: e, width: t, height: n }, r, i) {
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
function ho(e) {
	return Math.min(1, Math.max(-1, e));
}
function go(e) {
	let t = e;
	for (let e = 0; e < 50; e++) {
		let e = [
			fo(t[1], t[2]),
			fo(t[2], t[0]),
			fo(t[0], t[1])
		], n = Y(t[0], e[0]);
		if (!(n > 1e-12)) break;
		let r = t.map((t, r) => t.map((t, i) => (t + e[r][i] / n) / 2)), i = Math.max(...r.flatMap((e, n) => e.map((e, r) => Math.abs(e - t[n][r]))));
		if (t = r, i < 1e-15) break;
	}
	return t;
}
function _o(e, t, n, r, i = 1) {
	let a = n.width / n.height, o = i * Math.min(1, a / r), s = i * Math.min(1, r / a), c = {
		left: (1 - o) / 2,
		top: (1 - s) / 2,
		width: o,
		height: s
	};
	return vo(e, t, n), yo(e, t, n, c), t.aspect = r, t.fov = 2 * Math.atan(n.height / (2 * n.K[1][1] * s)) * 180 / Math.PI, c;
}
function vo(e, t, n) {
	let { R: r, centre: i } = n, a = new x().set(r[0][0], -r[1][0], -r[2][0], i[0], r[0][1], -r[1][1], -r[2][1], i[1], r[0][2], -r[1][2], -r[2][2], i[2], 0, 0, 0, 1);
	e.mesh.updateWorldMatrix(!0, !1), a.premultiply(e.mesh.matrixWorld), t.parent && (t.parent.updateWorldMatrix(!0, !1), a.premultiply(t.parent.matrixWorld.clone().invert())), a.decompose(t.position, t.quaternion, new A()), t.updateMatrixWorld(!0);
}
function yo(e, t, n, r) {
	let [[i, a, o], [, s, c]] = n.K, [l, u] = [2 * r.width / n.width, 2 * r.height / n.height], [d, f] = bo(e, n);
	t.near = d, t.far = f, t.projectionMatrix.set(l * i, -l * a, -(2 * r.left - 1 + l * o), 0, 0, u * s, -(1 - 2 * r.top - u * c), 0, 0, 0, -(f + d) / (f - d), -2 * f * d / (f - d), 0, 0, -1, 0), t.projectionMatrixInverse.copy(t.projectionMatrix).invert();
}
function bo(e, t) {
	let { geometry: n, matrixWorld: r } = e.mesh;
	n.boundingSphere || n.computeBoundingSphere();
	let { center: i, radius: a } = n.boundingSphere ?? {
		center: new A(),
		radius: 1
	}, o = r.getMaxScaleOnAxis(), s = i.distanceTo(new A(...t.centre)) * o, c = 1.01 * (s + a * o);
	return [Math.max(.5 * (s - a * o), c * 2e-4), c];
}
// eigenfield-three/src/exposure.ts
function xo(e) {
	let [t, n] = [[
		1,
		1,
		1
	], [
		0,
		0,
		0
	]];
	for (let [r, i] of e) if (r?.gain && r.offset) for (let e = 0; e < 3; e++) {
		let a = 1 / (r.gain[e] ?? 1);
		t[e] = (t[e] ?? 1) + i * (a - 1), n[e] = (n[e] ?? 0) - i * a * (r.offset[e] ?? 0);
	}
	return {
		scale: t,
		bias: n
	};
}
// eigenfield-three/src/memory.ts
var So = 4 / 3, Co = jo({
	components: 4,
	halves: !0
}), wo = {
	components: 4,
	halves: !1
}, To = {
	components: 2,
	halves: !1
}, Eo = {
	components: 2,
	halves: !0
}, Do = 16, Oo = 2 ** 20, ko = 1 / 64, Ao = 34;
function jo({ components: e, halves: t }) {
	return (e > 2 ? 4 : e) * (t ? 2 : 1);
}
function Mo() {
	let e = typeof navigator > "u" ? void 0 : navigator, t = e?.deviceMemory, n = e?.userAgent ?? "";
	return /Mobi|Android|iPhone|iPad|Quest/i.test(n) || /Macintosh/.test(n) && No(e) ? Math.min(t ?? 4, 6) * 128 * Oo : Math.min(t ?? 8, 8) * 256 * Oo;
}
function No(e) {
	return (e?.maxTouchPoints ?? 0) > 1;
}
function X([e, t], n) {
	return [Math.ceil(e / n), Math.ceil(t / n)];
}
function Po(e, t) {
	let [n, r] = X(e, t);
	return n * r;
}
function Fo(e) {
	return Math.ceil(e / 4);
}
function Io(e, t) {
	return t * Lo(e);
}
function Lo(e) {
	return Math.max(1, Math.ceil(e / 4));
}
function Ro(e) {
	let { atlas: t, means: n, bases: r } = e, i = [
		t,
		...n.map(({ size: e }) => e),
		...r.map(({ grid: e }) => e)
	];
	return [...new Map(i.map((e) => [e.join(), e])).values()];
}
var zo = [
	1,
	1.5,
	2,
	3,
	4,
	6,
	8,
	12,
	16
], Bo = {
	meanDown: 1,
	scaleDown: 1,
	halves: !0,
	words: !1
}, Vo = [Bo, ...zo.flatMap((e) => [
	1,
	1.5,
	2
].map((t) => ({
	meanDown: e,
	scaleDown: t * e,
	halves: !1,
	words: !1
})))];
function Ho(e, t) {
	let n = Math.max(0, ...e.bases.map(({ count: e }) => e)), r = Math.max(1, ...e.bases.map((e) => e.channels)), i = Math.min(n, 4 * Math.floor(t.layers / r)), a = (t, n) => Uo(e, t.meanDown) + e.geometry + Wo(e, t, n), o = (n, r) => a(n, r) + qo(e, n, t.memory) <= t.memory, s = Math.max(1, ...e.atlas, ...e.bases.flatMap(({ size: e }) => e)), c = Math.max(r, ...e.means.map((e) => e.channels)), l = n * r <= t.layers && c <= Do, u = [...e.films && l ? [{
		...Bo,
		words: !0
	}] : [], ...Vo].filter(({ meanDown: e }) => s / e <= t.side), d = u.length ? i : 0, f = u.find((e) => o(e, d));
	for (; !f && d > 0; d--) f = u.find((e) => o(e, d - 1));
	f ??= Vo.at(-1);
	let p = Jo({
		...f,
		usable: d
	}, e), m = Yo(p, e, t);
	return {
		...f,
		usable: d,
		bytes: a(f, d),
		reductions: p,
		limitation: m
	};
}
function Uo(e, t) {
	let n = e.means.map(({ size: e, channels: n, tenBits: r, opacity: i }) => {
		let a = i ? Co : 0;
		return (jo({
			components: n,
			halves: r
		}) * Fo(n) + a) * Po(e, t);
	}), r = Ro({
		...e,
		means: e.means.filter(({ opacity: e }) => !e)
	}).map((n) => {
		let r = n.join() === e.atlas.join() ? So : 1, i = e.rays && e.bases.some(({ grid: e }) => e.join() === n.join());
		return Co * Po(n, t) * (r + +!!i);
	});
	return Math.round([...n, ...r].reduce((e, t) => e + t, 0));
}
function Wo({ bases: e, rays: t }, { scaleDown: n, halves: r }, i) {
	return e.reduce((e, a) => {
		let o = Math.min(i, a.count);
		if (!o) return e;
		let s = t ? Lo(o) * 129 * 129 * Co : 0;
		return e + jo({
			components: o,
			halves: r && a.tenBits
		}) * Io(o, a.channels) * Po(a.size, n) + s;
	}, 0);
}
function Go({ means: e, bases: t }, { meanDown: n, scaleDown: r }, i) {
	let a = e.filter(({ pieces: e, tenBits: t }) => e > 1 || t || n > 1), o = t.filter(({ count: e }) => e > 0), [s, c] = Ko([...a, ...o].map(({ size: e }) => e)), l = Math.floor(ko * i / (jo(wo) * s)), u = [s, Math.min(c, Math.max(Ao, l))], d = [...n > 1 ? a.map((e) => X(e.size, n)) : [], ...r > 1 ? o.map((e) => X(e.size, r)) : []];
	return {
		picture: {
			size: u,
			format: wo
		},
		codes: [...a, ...o].some(({ tenBits: e }) => e) ? {
			size: u,
			format: To
		} : null,
		smaller: d.length ? {
			size: Ko(d),
			format: Eo
		} : null
	};
}
function Ko(e) {
	return [Math.max(1, ...e.map(([e]) => e)), Math.max(1, ...e.map(([, e]) => e))];
}
function qo(e, t, n) {
	if (t.words) return 0;
	let r = Object.values(Go(e, t, n)).map((e) => e ? jo(e.format) * Po(e.size, 1) : 0), i = t.scaleDown > 1 ? Math.max(...Ro(e).map((e) => Po(e, 1))) : 0;
	return [...r, i].reduce((e, t) => e + t, 0);
}
function Jo({ usable: e, meanDown: t, scaleDown: n, halves: r }, i) {
	let a = Math.max(0, ...i.bases.map(({ count: e }) => e)), o = [];
	return e < a && o.push({
		kind: "count",
		part: e,
		whole: a
	}), e && n > 1 && o.push({
		kind: "scale",
		percent: Math.round(100 / n)
	}), e && !r && i.bases.some(({ tenBits: e }) => e) && o.push({ kind: "bits" }), t > 1 && o.push({
		kind: "mean",
		percent: Math.round(100 / t)
	}), o;
}
function Yo(e, t, n) {
	if (!e.length) return null;
	let r = e.map((e) => e.kind === "count" ? `${e.part} of ${e.whole} eigen textures are drawn` : e.kind === "bits" ? "eigen textures have 8 bits" : `${e.kind === "mean" ? "the mean texture has" : "eigen textures have"} ${e.percent} % of ${e.kind === "mean" ? "its" : "their"} width and height`), i = Uo(t, 1) + Wo(t, Bo, Infinity) + qo(t, Bo, n.memory) + t.geometry, a = i > n.memory ? `the scene needs ${Xo(i)} MB of graphics memory and ${Xo(n.memory)} MB may be used` : "this device's graphics allow no more";
	return `${Zo(r.join(", "))}: ${a}.`;
}
function Xo(e) {
	return (e / 1e6).toFixed(+(e < 1e7));
}
function Zo(e) {
	return e.charAt(0).toUpperCase() + e.slice(1);
}
// ../src/eigenfield/rendering/shaders/compose.glsl?raw
var Qo = "\n#define LAYERS 64\n#define LEVEL 1e-4\n#define MOST 6e4\n#define REACH 2\nuniform sampler2DArray stored;\nuniform int firstLayer;\nuniform int sharing;\nuniform bool words;\nuniform int channels;\nuniform int entries;\nuniform vec4 scale[LAYERS];\nuniform vec4 bias[LAYERS];\nuniform vec3 colours[LAYERS];\nuniform bool rayWeights;\nuniform sampler2DArray weightMaps;\nuniform int firstGroup;\nuniform sampler2D places;\nuniform vec2 beside;\nuniform vec3 eye;\nuniform sampler2D coarse;\nvec4 placeOf(vec3 point) {\n  float height = point.z < 0.0 ? min(point.z, -LEVEL) : max(point.z, LEVEL);\n  return vec4(clamp(vec3(point.xy, 1.0) / height, -MOST, MOST), 1.0);\n}\nvec2 viewCoordinates(vec4 place) {\n  float part = 1.0 - eye.z * place.z;\n  bool meets = place.w > 0.0 && part > 1e-5;\n  return clamp(meets ? (eye.xy - eye.z * place.xy) / part : eye.xy, -1.0, 1.0);\n}\nfloat codeOf(vec2 shift) { return shift.x + float(REACH) + float(2 * REACH + 1) * (shift.y + float(REACH)); }\nvec2 shiftOf(vec4 place) {\n  int code = int(place.w + 0.5) - 1;\n  return code < 0 ? vec2(0.0) : vec2(code % (2 * REACH + 1) - REACH, code / (2 * REACH + 1) - REACH);\n}\nvec4 sumTextures(vec2 own) {\n  vec2 nodes = vec2(textureSize(weightMaps, 0).xy);\n  vec4 place = rayWeights || beside.x > 0.0 ? texelFetch(places, ivec2(gl_FragCoord.xy), 0) : vec4(0.0);\n  vec2 view = rayWeights ? viewCoordinates(place) : vec2(0.0);\n  own -= beside * shiftOf(place);\n  vec2 at = (0.5 + (0.5 + 0.5 * view) * (nodes - 1.0)) / nodes;\n  vec4 four = vec4(1.0), weights = four;\n  vec3 sum = vec3(0.0);\n  int entry = 0;\n  for (int group = 0; entry < entries; group++) {\n    if (rayWeights && (!words || group % 4 == 0)) {\n      four = textureLod(weightMaps, vec3(at, float(firstGroup + (words ? group / 4 : group))), 0.0);\n    }\n    weights = words ? vec4(four[group % 4]) : four;\n    for (int channel = 0; channel < channels; channel++) {\n      vec4 read = textureLod(stored, vec3(own, float(firstLayer + entry / sharing)), 0.0) * scale[entry] + bias[entry];\n      sum += colours[channel] * dot(weights, read);\n      entry++;\n    }\n  }\n  return vec4(sum, 0.0);\n}\nvec4 finerValue(vec2 uv) { return readCubic(coarse, uv * vec2(textureSize(coarse, 0)) - 0.5); }\nvec4 finerOpacity(vec2 uv) { return vec4(vec3(0.0), finerValue(uv).r); }\n", $o = "\nvec4 catmullRom(float f) {\n  float f2 = f * f, f3 = f2 * f;\n  return 0.5 * vec4(2.0 * f2 - f3 - f, 3.0 * f3 - 5.0 * f2 + 2.0, 4.0 * f2 - 3.0 * f3 + f, f3 - f2);\n}\nvec4 readCubic(sampler2D source, vec2 texel) {\n  ivec2 last = textureSize(source, 0) - 1;\n  ivec2 base = ivec2(floor(texel));\n  vec2 f = texel - vec2(base);\n  vec4 across = catmullRom(f.x), down = catmullRom(f.y);\n  vec4 sum = vec4(0.0);\n  for (int row = 0; row < 4; row++) {\n    vec4 line = vec4(0.0);\n    for (int column = 0; column < 4; column++) {\n      ivec2 at = clamp(base + ivec2(column, row) - 1, ivec2(0), last);\n      line += across[column] * texelFetch(source, at, 0);\n    }\n    sum += down[row] * line;\n  }\n  return sum;\n}\n", es = 2, ts = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
${$o}${Qo}`, ns = "\nprecision highp float;\nuniform vec4 rectangle; // of the target: left, top, right, bottom in 0..1\nin vec3 position;\nout vec2 own;\nvoid main() {\n  own = position.xy;\n  gl_Position = vec4(2.0 * mix(rectangle.xy, rectangle.zw, position.xy) - 1.0, 0.0, 1.0);\n}\n", rs = "\nprecision highp float;\nuniform vec2 texel;     // of the target, in clip space\nuniform vec2 shifts[SHIFTS];\nin vec2 position;       // texture coordinates\nin vec3 onPlane;\nout vec3 point;\nflat out vec2 shift;\nvoid main() {\n  point = onPlane;\n  shift = shifts[gl_InstanceID];\n  gl_Position = vec4(2.0 * position - 1.0 + texel * shift, 0.0, 1.0);\n}\n", is = `${ts}
in vec3 point;
flat in vec2 shift;
out vec4 place;
void main() {
  place = placeOf(point);
  place.w += codeOf(shift);
}
`, as = "sumTextures", os = "finerValue", ss = "finerOpacity";
function cs(n, r, i) {
	let o = new O({
		glslVersion: h,
		vertexShader: ns,
		fragmentShader: `${ts}in vec2 own;\nout vec4 colour;\nvoid main() { colour = ${n}(own); }\n`,
		uniforms: {
			rectangle: { value: new ae(...r) },
			...i
		},
		side: u,
		blending: a,
		blendSrc: E,
		blendDst: E,
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
	]), s.boundingSphere = new te();
	let c = new S(s, o);
	return c.frustumCulled = !1, c;
}
function ls([e, t], n) {
	return new oe(e, t, {
		type: g,
		depthBuffer: !1,
		generateMipmaps: n,
		minFilter: n ? b : w,
		magFilter: n ? y : w
	});
}
function us(e, t) {
	let n = fo(e.right, e.up), r = [
		t[0] - e.origin[0],
		t[1] - e.origin[1],
		t[2] - e.origin[2]
	];
	return [...lo(e, t), Y(r, n) / (Math.max(...e.extent) || 1)];
}
var ds = Array.from({ length: 5 }, (e, t) => t - es), fs = ds.flatMap((e) => ds.map((t) => new ie(t, e))).sort((e, t) => t.lengthSq() - e.lengthSq());
function ps(e) {
	return new O({
		glslVersion: h,
		vertexShader: rs.replace("SHIFTS", String(fs.length)),
		fragmentShader: is,
		uniforms: {
			texel: { value: new ie(2 / e.width, 2 / e.height) },
			shifts: { value: fs }
		},
		side: u,
		blending: T,
		depthTest: !1,
		depthWrite: !1
	});
}
function ms(t, n, r) {
	let { index: i } = t, a = t.getAttribute("position"), o = t.getAttribute("uv"), s = new Float32Array(3 * a.count), c = new Float32Array(2 * a.count);
	for (let e = 0; e < a.count; e++) s.set(us(n, [
		a.getX(e),
		a.getY(e),
		a.getZ(e)
	]), 3 * e), c.set([o.getX(e), o.getY(e)], 2 * e);
	let l = new v();
	l.setAttribute("position", new e(c, 2)), l.setAttribute("onPlane", new e(s, 3)), l.setIndex(i && new e(i.array, 1)), l.instanceCount = fs.length, l.boundingSphere = new te();
	let u = new S(l, r);
	return u.frustumCulled = !1, u;
}
var hs = new i(0), gs = new i();
function _s(e, t, n) {
	let r = e.getRenderTarget(), [i, a] = [e.getActiveCubeFace(), e.getActiveMipmapLevel()], { autoClear: o, info: s } = e, [c, l, u] = [
		e.xr.enabled,
		e.shadowMap.autoUpdate,
		e.getClearAlpha()
	], [d, f] = [s.render.frame, s.autoReset];
	e.getClearColor(gs), e.setClearColor(hs, 0), e.autoClear = e.xr.enabled = e.shadowMap.autoUpdate = s.autoReset = !1, n(), s.render.frame = d, Object.assign(s, { autoReset: f }), Object.assign(e, { autoClear: o }), e.xr.enabled = c, e.shadowMap.autoUpdate = l, e.setClearColor(gs, u), e.setRenderTarget(r, i, a);
	let { viewport: p } = t;
	p && e.state.viewport(p);
}
// eigenfield-three/src/composer.ts
var vs = {
	version: 0,
	mean: !0,
	opacity: 0,
	only: null,
	count: 0,
	weights: /* @__PURE__ */ new Float64Array(),
	eye: null,
	places: 0,
	maps: null
}, ys = class {
	snaps;
	surface;
	plane;
	grids;
	composed = null;
	opacity;
	opacityDrawn = 0;
	camera = new n();
	constructor(e, t, n, r, i, a, o) {
		this.snaps = i, this.surface = a, this.plane = o;
		let [s, ...c] = Ro({
			atlas: e,
			means: t.filter(({ basis: e }) => !e).map(({ grid: e }) => ({ size: e })),
			bases: t.filter(({ basis: e }) => e)
		}), l = (e, n) => {
			let a = t.filter(({ grid: t }) => t.join() === e.join()).flatMap((t) => Ss(t, i ? X(e, r) : null)), o = new k();
			return a.forEach(({ quad: e }, t) => o.add(Object.assign(e, { renderOrder: t }))), {
				target: ls(X(e, r), n),
				scene: o,
				steps: a,
				places: null
			};
		}, u = l(s ?? e, !0);
		this.grids = c.map((e) => l(e, !1));
		for (let { target: e } of this.grids) {
			let t = cs(os, [
				0,
				0,
				1,
				1
			], { coarse: { value: e.texture } });
			u.scene.add(Object.assign(t, { renderOrder: u.scene.children.length }));
		}
		this.grids.push(u), this.opacity = n && bs(n, r);
	}
	get texture() {
		return this.grids.at(-1)?.target.texture ?? null;
	}
	compose(e, t, n) {
		this.composed && Ts(this.composed, n) || (this.composed = n, _s(e, t, () => {
			n.opacity > this.opacityDrawn && this.drawOpacity(e, n.opacity);
			for (let t of this.grids) {
				(n.eye !== null && t.steps.some(({ part: e }) => e.basis) || this.snaps) && this.findPlaces(e, t, n.places);
				for (let e of t.steps) Cs(e, t.places?.target.texture ?? null, n);
				this.draw(e, t.scene, t.target, this.opacityDrawn > 0 && t === this.grids.at(-1));
			}
		}));
	}
	dispose() {
		for (let { target: e, places: t, scene: n } of this.grids) e.dispose(), t?.target.dispose(), t?.material.dispose(), xs(n);
		this.opacity?.target.dispose(), this.opacity && [this.opacity.sum, this.opacity.finer].forEach(xs);
	}
	drawOpacity(e, t) {
		let [n, r] = [this.grids.at(-1), this.opacity];
		r && n && (this.draw(e, r.sum, r.target), this.draw(e, r.finer, n.target), this.opacityDrawn = t);
	}
	findPlaces(e, t, n) {
		if (t.places && t.places.version >= n) return;
		let r = t.places?.target ?? ls([t.target.width, t.target.height], !1), i = t.places?.material ?? ps(r), a = ms(this.surface.geometry, this.plane, i);
		this.draw(e, new k().add(a), r), a.geometry.dispose(), t.places = {
			target: r,
			material: i,
			version: this.surface.version
		};
	}
	draw(e, t, n, r = !1) {
		e.setRenderTarget(n), e.state.buffers.color.setMask(!0);
		let i = e.getContext();
		r && i.colorMask(!0, !0, !0, !1), e.clear(!0, !1, !1), r && i.colorMask(!0, !0, !0, !0), e.render(t, this.camera);
	}
};
function bs(e, t) {
	let n = ls(X(e.grid, t), !1), r = Ss(e, null);
	for (let e of r) Cs(e, null, vs);
	let [i, a] = [new k(), new k()];
	return i.add(...r.map(({ quad: e }) => e)), a.add(cs(ss, [
		0,
		0,
		1,
		1
	], { coarse: { value: n.texture } })), {
		target: n,
		sum: i,
		finer: a
	};
}
function xs(e) {
	for (let { geometry: t, material: n } of e.children) t.dispose(), n.dispose();
}
function Ss(e, t) {
	let [n, r, i, a] = e.rectangle, o = t && new ie(1 / ((i - n) * t[0]), 1 / ((a - r) * t[1])), s = e.colours.length, [c, l] = [e.scale.length / (4 * s), Math.floor(64 / s)], u = e.words ? 4 * Math.floor(l / 4) : l, d = [];
	for (let t = 0; t < c; t += u) {
		let n = Array.from({ length: 64 }, (t, n) => new A(...e.colours[n] ?? [
			0,
			0,
			0
		])), r = e.basis || e.words ? 1 : 4, i = cs(as, e.rectangle, {
			stored: { value: e.stored },
			firstLayer: { value: Math.floor(t * s / r) },
			sharing: { value: r },
			words: { value: e.words },
			channels: { value: s },
			entries: { value: 0 },
			scale: { value: /* @__PURE__ */ new Float32Array(256) },
			bias: { value: /* @__PURE__ */ new Float32Array(256) },
			colours: { value: n },
			rayWeights: { value: !1 },
			weightMaps: { value: null },
			firstGroup: { value: (e.basis?.group ?? 0) + (e.words ? t / 4 : t) },
			places: { value: null },
			beside: { value: o ?? new ie() },
			eye: { value: new A() }
		});
		d.push({
			part: e,
			first: t,
			groups: Math.min(u, c - t),
			quad: i
		});
	}
	return d;
}
function Cs({ part: e, first: t, groups: n, quad: r }, i, a) {
	let { basis: o, colours: s, words: c } = e, { uniforms: l } = r.material, u = (e, t) => {
		let n = l[e];
		n && (n.value = t);
	}, d = o !== null && a.eye !== null && a.only === null, f = c ? 1 : 4, p = Array.from({ length: f * n }, (e, n) => ws(o, f * t + n, a, d)), m = Math.ceil((p.findLastIndex((e) => e !== 0) + 1) / f), [h, g] = [l.scale?.value, l.bias?.value], _ = s.length;
	for (let n = 0; n < 4 * _ * m; n++) {
		let r = p[f * Math.floor(n / (4 * _)) + n % f] ?? 0;
		h[n] = r * (e.scale[4 * _ * t + n] ?? 0), g[n] = r * (e.bias[4 * _ * t + n] ?? 0);
	}
	u("entries", _ * m), u("rayWeights", d), u("weightMaps", d ? a.maps : null), u("places", i), a.eye && (l.eye?.value).set(...a.eye), r.visible = m > 0, r.material.uniformsNeedUpdate = !0;
}
function ws(e, t, n, r) {
	return e ? e.ready[t] ? n.only === null ? t >= n.count ? 0 : r ? 1 : n.weights[e.column + t] ?? 0 : +(t === n.only) : 0 : +!!n.mean;
}
function Ts(e, t) {
	let { weights: n, eye: r, ...i } = e;
	return !Object.entries(i).every(([e, n]) => t[e] === n) || r === null != (t.eye === null) ? !1 : e.only === null ? r ? r.every((e, n) => e === t.eye?.[n]) : n.every((e, n) => e === t.weights[n]) : !0;
}
// eigenfield-three/src/maps.ts
function Es(e, t, n, i, a) {
	let c = i.reduce((e, t) => e + t, 0), l = [], [u, d] = [0, 0];
	for (let e of i) {
		let t = Math.min(e, a);
		for (let e = 0; e < t; e++) l.push([u + e, 4 * d + e]);
		u += e, d += t ? Lo(t) : 0;
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
	let p = new o(f, 129, 129, Math.max(1, d));
	return p.format = D, p.type = g, p.minFilter = p.magFilter = y, p.wrapS = p.wrapT = r, p.needsUpdate = !0, p;
}
// eigenfield-three/src/eigen-weights.ts
var Ds = class {
	info;
	counts;
	omega;
	views;
	total;
	rowOf;
	made = null;
	constructor(e, t, n, r) {
		this.info = e, this.counts = t, this.omega = n, this.views = r, this.total = t.reduce((e, t) => e + t, 0);
		let i = 0;
		this.rowOf = Int32Array.from(e.heldOut, (e) => e ? -1 : i++);
	}
	viewsAt(e, t, n) {
		let r = new Float64Array(this.views.places.length / 2), { camera: i, weight: a } = this.views.at(e, t, n);
		return i.forEach((e, t) => r[e] = (r[e] ?? 0) + (a[t] ?? 0)), r;
	}
	at(e, t, n) {
		let { camera: r, weight: i } = this.views.at(e, t, n), a = new Float64Array(this.total);
		for (let e = 0; e < 4; e++) {
			let t = i[e] ?? 0;
			if (!t) continue;
			let n = (r[e] ?? 0) * this.total;
			for (let e = 0; e < this.total; e++) a[e] = (a[e] ?? 0) + t * (this.omega[n + e] ?? 0);
		}
		return a;
	}
	ofCamera(e, t) {
		let n = this.rowOf[e] ?? -1;
		if (n >= 0) return Float64Array.from(this.omega.subarray(n * this.total, (n + 1) * this.total));
		let r = this.info.cameras[e];
		if (!r) throw RangeError(`no camera ${e}`);
		return this.at(...lo(this.info.viewPlane, r.centre), t);
	}
	maps(e, t) {
		if (this.made?.mixing === e && this.made.usable === t) return this.made.texture;
		this.dispose();
		let n = Es(this.views, e, this.omega, this.counts, t);
		return this.made = {
			texture: n,
			mixing: e,
			usable: t
		}, n;
	}
	dispose() {
		this.made?.texture.dispose();
	}
}, Os = "\nuniform sampler2D composed;\nuniform float finest;\nuniform vec3 exposureScale;\nuniform vec3 exposureBias;\nvec4 surfaceValue(vec2 uv) {\n  vec4 plain = texture(composed, uv, -log2(finest));\n#if BICUBIC == 1\n  vec2 size = vec2(textureSize(composed, 0));\n  vec2 across = dFdx(uv) * size, down = dFdy(uv) * size;\n  bool fine = max(dot(across, across), dot(down, down)) <= finest * finest;\n  if (fine) return readCubic(composed, clamp(uv * size, vec2(0.5), size - 0.5) - 0.5);\n#endif\n  return plain;\n}\nvec3 seenColour(vec4 value) { return value.rgb * exposureScale + exposureBias; }\nvec3 surfaceColour(vec2 uv) { return clamp(seenColour(surfaceValue(uv)), 0.0, 1.0); }\nvec4 sheetColour(vec2 uv) {\n  vec4 value = surfaceValue(uv);\n  float opacity = clamp(value.a, 0.0, 1.0);\n  return vec4(seenColour(value) * opacity, opacity);\n}\n", ks = {
	bilinear: 0,
	bicubic: 1
}, As = {
	picture: 0,
	mean: 1,
	eigen: 2,
	error: 3
}, js = "\nprecision highp float;\nuniform mat4 modelViewMatrix;\nuniform mat4 projectionMatrix;\nin vec3 position;\nin vec2 uv;\nout vec2 surfaceUv;\nout vec3 surfacePlace;\nvoid main() {\n  surfaceUv = uv;\n  surfacePlace = position;\n  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));\n}\n", Ms = js.replace("void main", "invariant gl_Position;\nvoid main"), Ns = "\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\nuniform int shown;             // 0 the picture, 1 the mean, 2 one eigen texture, 3 the error\n", Ps = "\nuniform sampler2D photograph;  // row 0 on top\nuniform mat4 toPhotograph;     // homogeneous texture coordinates of a place, in x, y and w\n\nvec3 heat(float t) {\n  return clamp(vec3(3.0 * t, 3.0 * t - 1.0, 3.0 * t - 2.0), 0.0, 1.0);\n}\n\nvec3 errorColour(vec3 drawn, vec3 place) {\n  vec4 at = toPhotograph * vec4(place, 1.0);\n  vec2 uv = at.xy / at.w;\n  if (at.w <= 0.0 || any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return vec3(0.2);\n  vec3 off = abs(drawn - textureLod(photograph, uv, 0.0).rgb);\n  return heat(5.0 * (off.r + off.g + off.b) / 3.0);\n}\n", Fs = `${Ns}
${$o}${Os}
uniform float shownGain;       // of the eigen texture around mid grey
in vec2 surfaceUv;
vec3 eigenColour(vec3 value) { return clamp(0.5 + shownGain * value, 0.0, 1.0); }
`, Is = `${Fs}${Ps}
in vec3 surfacePlace;
out vec4 fragment;
void main() {
  vec3 colour;
  if (shown == 2) colour = eigenColour(surfaceValue(surfaceUv).rgb);
  else colour = surfaceColour(surfaceUv);
  if (shown == 3) colour = errorColour(colour, surfacePlace);
  fragment = vec4(colour, 1.0);
}
`, Ls = `${Fs}
layout(location = 0) out vec4 fragment;
layout(location = 1) out vec4 solid;
vec3 threeBytes(float depth) {
  uint code = uint(clamp(depth, 0.0, 1.0) * 16777215.0);
  return vec3(uvec3(code >> 16, code >> 8, code) & 255u) / 255.0;
}
void main() {
  vec4 colour = sheetColour(surfaceUv);
  if (shown == 2) colour.rgb = eigenColour(surfaceValue(surfaceUv).rgb) * colour.a;
  fragment = colour;
  float depth = (gl_FragCoord.z - gl_DepthRange.near) / gl_DepthRange.diff;
  solid = colour.a < 0.5 ? vec4(0.0) : vec4(threeBytes(depth), 1.0);
}
`, Rs = "\nprecision highp float;\nlayout(location = 0) out vec4 fragment;\nlayout(location = 1) out vec4 solid;\nvoid main() { fragment = solid = vec4(0.0); }\n", zs = {
	blending: a,
	blendSrc: E,
	blendDst: ee
}, Bs = {
	depthWrite: !1,
	stencilWrite: !0,
	stencilFunc: d,
	stencilZPass: _
};
function Vs(e, t) {
	let n = {
		composed: { value: null },
		finest: { value: 1 },
		exposureScale: { value: new A(1, 1, 1) },
		exposureBias: { value: new A() },
		shown: { value: As.picture },
		shownGain: { value: 1 },
		photograph: { value: null },
		toPhotograph: { value: new x() }
	}, r = new O({
		glslVersion: h,
		vertexShader: t ? Ms : js,
		fragmentShader: t ? Ls : Is,
		uniforms: n,
		defines: { BICUBIC: ks.bicubic },
		side: e ? u : m,
		...t ? {
			...zs,
			...Bs
		} : {}
	});
	return r.name = "eigen textures", r;
}
function Hs(e) {
	let { side: t } = e;
	return new O({
		name: "depth of sheets",
		glslVersion: h,
		vertexShader: Ms,
		fragmentShader: Rs,
		colorWrite: !1,
		side: t,
		stencilWrite: !0,
		stencilZPass: se
	});
}
function Us(e, t, n) {
	let { K: r, R: i, t: a, width: o, height: s } = t, c = new x().set(...i[0], a[0], ...i[1], a[1], ...i[2], a[2], 0, 0, 0, 1), l = new x().set(...r[0], 0, ...r[1], 0, 0, 0, 0, 0, ...r[2], 0), u = n.flipY && !Ws(n.image), d = new x().makeScale(1 / o, (u ? -1 : 1) / s, 1);
	u && (d.elements[13] = 1), e.toPhotograph.value.multiplyMatrices(d, l.multiply(c)), e.photograph.value = n;
}
function Ws(e) {
	return typeof ImageBitmap < "u" && e instanceof ImageBitmap;
}
// eigenfield-three/src/pieces.ts
function Gs(e) {
	for (let { picture: t } of e) "close" in t && t.close();
}
// eigenfield-three/src/strength.ts
var Ks = 128, qs = .98;
async function Js(e, t, n, r) {
	let i = n.length, a = 0, o = e.pictures.find(({ textures: e }) => (a += e) > t);
	if (!o) return 1;
	let s = t - (a - o.textures), c = qi(o), l = o.pieces < i, u = await o.codec.bitmaps(await r(o.view), o, e.size), d = new OffscreenCanvas(Ks, Ks).getContext("2d", { willReadFrequently: !0 });
	if (!d) return 1;
	d.imageSmoothingEnabled = !1;
	let f = [];
	return u.slice(o.pieces * s, o.pieces * (s + 1)).forEach(({ picture: e, row: t, rows: r }, a) => {
		d.drawImage(e, 0, t, e.width, r, 0, 0, Ks, Ks);
		let { data: u } = d.getImageData(0, 0, Ks, Ks);
		(l ? [
			0,
			1,
			2
		] : [a]).forEach((e) => {
			let [t, r] = [o.scale, o.zero].map((t) => t[i * s + e] ?? 0), a = Math.max(...(n[e] ?? [0]).map(Math.abs)) * (t ?? 0);
			for (let t = l ? e : 0; t < u.length; t += 4) f.push(Math.abs((c * (u[t] ?? 0) - (r ?? 0)) * a));
		});
	}), Gs(u), Ys(f);
}
function Ys(e) {
	e.sort((e, t) => e - t);
	let t = e[Math.floor(qs * e.length)] ?? 0;
	return t > 0 ? .45 / t : 1;
}
// eigenfield-three/src/film-textures.ts
var Xs = class {
	scene;
	films;
	filling = null;
	constructor(e, t) {
		this.scene = e, this.films = t;
	}
	fill(e) {
		return this.filling = e, this.put(e), e.announce(), Promise.resolve();
	}
	show(e) {
		this.films = e, this.filling && this.put(this.filling);
	}
	gain(e) {
		let t = 0;
		for (let { channels: n, bases: r } of this.scene.planes) {
			let i = this.scene.colours.slice(t, t += n), a = r.find(({ count: t }) => t > e)?.pictures[0];
			if (a) return Promise.resolve(this.gainOf(a, e, i));
		}
		return Promise.resolve(1);
	}
	dispose() {
		this.filling = null;
	}
	put(e) {
		Aa(this.scene).forEach(({ mean: t }, n) => e.putMean(n, {
			pieces: this.piecesOf(t),
			precision: null
		})), J(this.scene).forEach(({ pictures: [t] }, n) => {
			let r = t ? this.piecesOf(t) : [];
			t && r.length && e.putTextures(n, 0, r, t);
		});
	}
	piecesOf({ part: e }) {
		let t = e && this.films[e.film];
		return t ? Gt(t, e).map((e) => ({
			picture: e,
			row: 0,
			rows: e.height
		})) : [];
	}
	gainOf({ part: e, pieces: t, scale: n, zero: r }, i, a) {
		let o = e && this.films[e.film];
		return o ? Ys(Gt(o, e).slice(t * i, t * (i + 1)).flatMap((e, o) => {
			let s = t * i + o, c = Math.max(...(a[o] ?? [0]).map(Math.abs)) * (n[s] ?? 0);
			return Qs(e).map((e) => Math.abs((e - (r[s] ?? 0)) * c));
		})) : 1;
	}
}, Zs = 8;
function Qs({ data: e, width: t, height: n, stride: r }) {
	let i = [];
	for (let a = 0; a < n; a += Zs) for (let n = 0; n < t; n += Zs) {
		let t = a * r + 2 * n;
		i.push(e[t] + 256 * e[t + 1]);
	}
	return i;
}
// eigenfield-three/src/container.ts
var $s = 1179937895, ec = 1313821514, tc = 5130562, nc = 1280591429;
async function rc(e) {
	let t = await e.read(0, 4).catch((t) => {
		throw t instanceof j && t.code === "truncated" ? cc(e.received === 0) : t;
	});
	if (new DataView(t).getUint32(0, !0) !== $s) throw cc(!1);
	let n = new DataView(await e.read(0, 12)), r = n.getUint32(4, !0), i = n.getUint32(8, !0);
	if (r !== 2) throw new j("version", `The file is GLB version ${r} and this viewer reads 2; save it as glTF 2.`, "4");
	if (i < 20) throw M("8", "a length of no file");
	let a = new DataView(await e.read(12, 20)), o = a.getUint32(0, !0);
	if (a.getUint32(4, !0) !== ec) throw M("16", "it does not begin with JSON");
	if (o > Se) throw M("12", `${o} bytes of JSON`);
	if (20 + o > i) throw M("12", "a chunk longer than the file");
	let s = ac(await e.read(20, 20 + o)), c = (t, n) => () => ic(e, 20 + o, i, t, n);
	return {
		length: i,
		text: s,
		json: oc(s, "20"),
		binary: c(tc, "binary chunk"),
		groups: c(nc, "chunk of groups")
	};
}
async function ic(e, t, n, r, i) {
	let a = t;
	for (let t = 1; t < 64 && a + 8 <= n; t++) {
		let t = new DataView(await e.read(a, a + 8)), i = t.getUint32(0, !0);
		if (a + 8 + i > n) throw M(String(a), "a chunk longer than the file");
		if (t.getUint32(4, !0) === r) return a + 8;
		a += 8 + i;
	}
	throw M(String(t), `no ${i}`);
}
function ac(e) {
	try {
		return new TextDecoder("utf-8", { fatal: !0 }).decode(e);
	} catch {
		throw M("20", "its JSON is not UTF-8");
	}
}
function oc(e, t) {
	if (sc(e) > 64) throw M(t, "its JSON is nested too deep");
	try {
		return JSON.parse(e);
	} catch {
		throw M(t, "its JSON cannot be read");
	}
}
function sc(e) {
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
function cc(e) {
	return new j("not-glb", e ? "The file is empty; take a .glb file that eigenfield wrote." : "The file is no GLB; take a .glb file that eigenfield wrote.", "0");
}
// eigenfield-three/src/groups.ts
var lc = 3, uc = 4, dc = class {
	scene;
	timeline;
	mesh;
	read;
	kept = /* @__PURE__ */ new Map();
	constructor(e, t, n, r) {
		this.scene = e, this.timeline = t, this.mesh = n, this.read = r;
	}
	open(e) {
		let t = this.kept.get(e) ?? this.opened(e);
		t.catch(() => this.kept.get(e) === t && this.kept.delete(e)), this.kept.delete(e), this.kept.set(e, t);
		for (let [e] of this.kept) this.kept.size > lc && this.kept.delete(e);
		return t;
	}
	async begin() {
		let e = this.placeOf(0), t = async (t) => new Uint8Array(await this.read(e, Math.min(t, e.length))), { head: n, at: r } = await gc(await t(uc + mc(await t(uc), e)), e), i = [
			n.key("weights"),
			n.key("mesh"),
			n.key("motion"),
			n.key("frames").at(0)
		].reduce((e, { raw: t }) => e + hc(t), r);
		return this.build(0, await t(i), n, r, 1);
	}
	placeOf(e) {
		let t = this.timeline.groups[e];
		if (!t) throw RangeError(`no group ${e}`);
		return t;
	}
	async opened(e) {
		let t = this.placeOf(e), n = new Uint8Array(await this.read(t, t.length));
		await pc(n, t);
		let { head: r, at: i } = await gc(n, t);
		return this.build(e, n, r, i, t.frames);
	}
	build(e, t, n, r, i) {
		let a = this.placeOf(e), o = _c(t, r, a), s = this.weightsOf(n, o), c = this.meshOf(n, o), l = vc(n, o, c, a), { first: u, frames: d } = a, f = yc(n, a, this.timeline.films.length, o, i);
		return {
			index: e,
			first: u,
			frames: d,
			omega: s,
			...this.scalesOf(n),
			units: f,
			mesh: c,
			motion: l
		};
	}
	meshOf(e, t) {
		let n = e.key("mesh");
		if (!n.exists) return this.mesh;
		if (this.scene.sheets) throw n.wrong("a mesh of its own, in a clip with sheets");
		let r = W["mesh-2"].decode(t(n), n.where);
		if (!r.indices.length) throw M(n.where, "a mesh without faces");
		return r;
	}
	weightsOf(e, t) {
		let n = this.scene.heldOut.filter((e) => !e).length, r = xc(e.key("weights"), this.scene.planes.length);
		return eo(n, this.scene.planes.flatMap(({ bases: e }, i) => {
			let a = r[i] && xc(r[i], e.length);
			return e.map(({ count: e }, r) => {
				let i = a[r];
				return no(W["weights-1"].decode(t(i), i.where), n, e, i.where);
			});
		}));
	}
	scalesOf(e) {
		let { planes: t } = this.scene;
		return {
			means: xc(e.key("means"), t.length).map((e, n) => bc(e, t[n].mean)),
			bases: xc(e.key("bases"), t.length).flatMap((e, n) => {
				let { bases: r } = t[n];
				return xc(e, r.length).map((e, t) => bc(e, r[t].pictures[0]));
			})
		};
	}
};
function fc(e, { means: t, bases: n }) {
	e.planes.forEach(({ mean: e }, n) => Object.assign(e, t[n])), J(e).forEach(({ pictures: [e] }, t) => e && Object.assign(e, n[t]));
}
async function pc(e, { sha256: t, file: n, where: r }) {
	let i = globalThis.crypto?.subtle;
	if (!i) return;
	let a = new Uint8Array(await i.digest("SHA-256", e));
	if (Array.from(a, (e) => e.toString(16).padStart(2, "0")).join("") !== t) throw M(n ?? r, "other bytes than its SHA-256 says");
}
function mc(e, { where: t }) {
	if (e.length < uc) throw M(t, "no head");
	return new DataView(e.buffer).getUint32(0, !0);
}
function hc(e) {
	return typeof e == "number" ? e : Array.isArray(e) ? e.reduce((e, t) => e + hc(t), 0) : 0;
}
async function gc(e, { where: t }) {
	let n = uc + mc(e, { where: t });
	if (n > e.length) throw M(t, "a head longer than the group");
	let r = await be(e.subarray(uc, n), "deflate-raw", Be, t);
	return {
		head: new G(oc(new TextDecoder("utf-8").decode(r), t), t),
		at: n
	};
}
function _c(e, t, n) {
	let r = t;
	return (t) => {
		let i = r;
		if (r += t.integer(1, n.length), r > e.length) throw t.wrong("beyond the end of the group");
		return e.subarray(i, r);
	};
}
function vc(e, t, n, { frames: r }) {
	let i = e.key("motion");
	if (!i.exists) return null;
	let a = W["motion-1"].decode(t(i), n, i.where);
	if (a.frames !== r) throw i.wrong(`${a.frames} frames of ${r}`);
	return a;
}
function yc(e, t, n, r, i) {
	return xc(e.key("frames"), t.frames).slice(0, i).map((e) => xc(e, n).map((e) => r(e)));
}
function bc(e, { pieces: t, textures: n }) {
	let r = e;
	return {
		scale: Yi(r.key("scale"), t, n),
		zero: Yi(r.key("zero"), t, n)
	};
}
function xc(e, t) {
	let n = e.items(t);
	if (n.length !== t) throw e.wrong(`${t} entries are needed`);
	return n;
}
var Sc = 3, Cc = "#version 300 es\nvoid main() {\n  gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);\n}\n", wc = "#version 300 es\nprecision highp float;\nuniform highp sampler2D picture;\nuniform vec4 factors;\nuniform int first; // row of the picture with which the texture begins\nout vec4 stored;\nvoid main() {\n  stored = vec4(dot(texelFetch(picture, ivec2(gl_FragCoord.xy) - ivec2(0, first), 0), factors));\n}\n", Tc = "#version 300 es\nprecision highp float;\nprecision highp int;\n#define EDGE 1e-3 // of a texel: less is rounding\nuniform highp sampler2D picture;\nuniform highp sampler2D precisions;\nuniform highp sampler2D covered; // texels of the grid that lie in charts\nuniform vec4 factors;\nuniform ivec2 size; // of the picture\nuniform ivec2 made; // of what is stored\nuniform int first; // row of the picture with which the texture begins\nuniform ivec2 corner; // of the picture in its grid\nuniform ivec2 nodes; // columns and rows of the precisions that are used; 0: codes are stored as they are\nuniform float zero;\nout vec4 stored;\nfloat nodeAt(ivec2 at) {\n  return texelFetch(precisions, clamp(at, ivec2(0), nodes - 1), 0).r;\n}\nfloat precisionAt(vec2 uv) {\n  vec2 at = uv * vec2(nodes) - 0.5;\n  ivec2 low = ivec2(floor(at));\n  vec2 part = at - vec2(low);\n  float upper = mix(nodeAt(low), nodeAt(low + ivec2(1, 0)), part.x);\n  float lower = mix(nodeAt(low + ivec2(0, 1)), nodeAt(low + ivec2(1, 1)), part.x);\n  return (255.0 * mix(upper, lower, part.y) + 1.0) / 256.0;\n}\nfloat valueAt(ivec2 texel) {\n  float code = dot(texelFetch(picture, texel - ivec2(0, first), 0), factors);\n  if (nodes.x == 0) return code;\n  float fine = precisionAt((vec2(texel) + 0.5) / vec2(size));\n  return clamp((code - zero) / fine / 4.0, -65504.0, 65504.0);\n}\nvoid main() {\n  ivec2 at = ivec2(gl_FragCoord.xy);\n  if (made == size) {\n    stored = vec4(valueAt(at));\n    return;\n  }\n  vec2 ratio = vec2(size) / vec2(made), low = vec2(at) * ratio, high = low + ratio;\n  vec2 charts = vec2(0.0), all = vec2(0.0);\n  for (int y = int(low.y); float(y) < high.y - EDGE; y++) {\n    for (int x = int(low.x); float(x) < high.x - EDGE; x++) {\n      vec2 part = min(high, vec2(x + 1, y + 1)) - max(low, vec2(x, y));\n      vec2 one = part.x * part.y * vec2(valueAt(ivec2(x, y)), 1.0);\n      all += one;\n      charts += one * texelFetch(covered, corner + ivec2(x, y), 0).r;\n    }\n  }\n  vec2 sum = charts.y > EDGE ? charts : all;\n  stored = vec4(sum.x / sum.y, step(EDGE, charts.y), 0.0, 0.0);\n}\n", Ec = `#version 300 es
precision highp float;
precision highp int;
uniform highp sampler2D picture; // values, and whether they are of a chart
uniform ivec2 size; // as much of it as is used
out vec4 stored;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 own = texelFetch(picture, at, 0).rg;
  vec2 sum = vec2(own.r * own.g, own.g);
  for (int far = 1; far <= ${Sc} && sum.y == 0.0; far++) {
    for (int y = -far; y <= far; y++) {
      for (int x = -far; x <= far; x++) {
        vec2 near = texelFetch(picture, clamp(at + ivec2(x, y), ivec2(0), size - 1), 0).rg;
        sum += vec2(near.r * near.g, near.g);
      }
    }
  }
  stored = vec4(sum.y > 0.0 ? sum.x / sum.y : own.r);
}
`, Dc = ["#version 300 es\nin vec2 uv;\nvoid main() { gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0); }\n", "#version 300 es\nprecision mediump float;\nout vec4 covered;\nvoid main() { covered = vec4(1.0); }\n"];
// eigenfield-three/src/parts.ts
function Oc(e, t, n) {
	let r = [], [i, a, o, s] = [
		0,
		0,
		0,
		0
	], { words: c } = n;
	return e.planes.forEach((l, u) => {
		let { channels: d, bases: f } = l, p = e.colours.slice(i, i + d);
		i += d;
		let m = t.needs.means[u]?.size ?? [1, 1], h = t.means[u], g = c ? Mc([l.mean]) : jc(l);
		h && r.push({
			stored: h,
			grid: m,
			rectangle: [
				0,
				0,
				1,
				1
			],
			colours: p,
			...g,
			words: c,
			basis: null
		});
		for (let { size: e, grid: i, corner: l, pictures: u, count: m } of f) {
			let f = t.bases[a], h = t.ready[a++] ?? [], g = Math.min(m, n.usable);
			if (g && f) {
				let [t, a] = [l[0] / i[0], l[1] / i[1]];
				r.push({
					stored: f,
					grid: i,
					rectangle: [
						t,
						a,
						t + e[0] / i[0],
						a + e[1] / i[1]
					],
					colours: p,
					...c ? Mc(u) : Nc(u, d, g, n.halves && Ki(u)),
					words: c,
					basis: {
						ready: h,
						column: o,
						group: s
					}
				});
			}
			o += m, s += g ? Lo(g) : 0;
		}
	}), r;
}
function kc(e, t, n, r) {
	Oc(t, n, r).forEach(({ scale: t, bias: n }, r) => Object.assign(e[r] ?? {}, {
		scale: t,
		bias: n
	}));
}
function Ac({ planes: e, sheets: t }, { means: n, needs: r }, { words: i }) {
	let a = n[e.length], o = r.means[e.length]?.size;
	return !t || !a || !o ? null : {
		stored: a,
		grid: o,
		rectangle: [
			0,
			0,
			1,
			1
		],
		colours: [[
			1,
			0,
			0
		]],
		...i ? Mc([t.opacity.mean]) : jc(t.opacity),
		words: i,
		basis: null
	};
}
function jc({ mean: e, channels: t, precision: n }) {
	let { scale: r, zero: i } = e, a = n ? 4 : 1 / Ji(e, Ki([e])), o = {
		scale: new Float32Array(4 * t),
		bias: new Float32Array(4 * t)
	};
	for (let e = 0; e < t; e++) {
		let t = 4 * e + e % 4;
		o.scale[t] = a * (r[e] ?? 0), o.bias[t] = n ? 0 : -(i[e] ?? 0) * (r[e] ?? 0);
	}
	return o;
}
function Mc(e) {
	let t = e.flatMap((e) => e.scale), n = e.flatMap((e) => e.zero);
	return {
		scale: Float32Array.from(t.flatMap((e) => [
			255 * e,
			65280 * e,
			0,
			0
		])),
		bias: Float32Array.from(t.flatMap((e, t) => [
			-(n[t] ?? 0) * e,
			0,
			0,
			0
		]))
	};
}
function Nc(e, t, n, r) {
	let i = e.flatMap((e) => Array(e.textures).fill(Ji(e, r))), a = e.flatMap((e) => e.scale), o = e.flatMap((e) => e.zero), s = 4 * t * Lo(n), c = {
		scale: new Float32Array(s),
		bias: new Float32Array(s)
	};
	for (let e = 0; e < n; e++) for (let n = 0; n < t; n++) {
		let r = 4 * (t * Math.floor(e / 4) + n) + e % 4, s = a[t * e + n] ?? 0;
		c.scale[r] = s / (i[e] ?? 1), c.bias[r] = -(o[t * e + n] ?? 0) * s;
	}
	return c;
}
// eigenfield-three/src/player.ts
var Pc = .25, Fc = 100, Ic = 2, Lc = .25, Rc = .1, zc = class extends f {
	timeline;
	user;
	first;
	duration;
	frames;
	rate;
	sound;
	ring;
	shown;
	clock;
	last = null;
	plays = !1;
	pace = 1;
	goal = null;
	following = null;
	waiters = [];
	asked = null;
	disposed = !1;
	lacking = [];
	watched = {
		seconds: 0,
		due: 0,
		short: 0
	};
	constructor(e, t, n, r = null) {
		super(), this.timeline = e, this.user = n, this.rate = e.rate, this.frames = e.frames, this.first = e.first, this.duration = e.frames / e.rate, this.shown = {
			position: 0,
			number: 0
		}, this.clock = 0, this.ring = t({
			ready: () => this.wake(),
			failed: (e, t) => this.fail(e, t),
			thinned: () => this.thin()
		}), this.sound = r && r(() => void this.dispatchEvent({ type: "change" })), globalThis.document?.addEventListener("visibilitychange", this.hide);
	}
	get playing() {
		return this.plays;
	}
	get frame() {
		return this.shown.number;
	}
	get time() {
		return ba(this.timeline, this.shown.number);
	}
	get sought() {
		return (this.following ?? this.goal ?? this.shown.position) % this.frames;
	}
	get waiting() {
		return this.goal !== null;
	}
	get group() {
		let { groups: e } = this.timeline, t = q(this.timeline, this.shown.number);
		return {
			index: t,
			count: e.length,
			bytes: e[t]?.length ?? 0
		};
	}
	get late() {
		return this.ring.late;
	}
	get open() {
		return this.ring.open;
	}
	get fallbacks() {
		return this.lacking;
	}
	get loop() {
		return this.ring.loop;
	}
	set loop(e) {
		this.ring.loop = e, this.ring.feed(), this.dispatchEvent({ type: "change" });
	}
	get speed() {
		return this.pace;
	}
	set speed(e) {
		if (!(e > 0 && e < Infinity)) throw RangeError("A speed is above 0.");
		this.pace = e, this.watch(), this.dispatchEvent({ type: "change" });
	}
	play() {
		this.plays || this.disposed || (this.plays = !0, this.last = null, this.watch(), this.ring.retry(), !this.loop && (this.following ?? this.goal ?? this.shown.position) >= this.end && this.toFrame(0), this.dispatchEvent({ type: "change" }), this.wake());
	}
	pause() {
		this.plays && (this.plays = !1, this.clock = this.shown.position, this.sound?.rest(), this.ring.plain && this.begin(this.shown.position), this.dispatchEvent({ type: "change" }));
	}
	seek(e) {
		return Bc(e), this.toFrame(ya(this.timeline, e));
	}
	toFrame(e) {
		return Bc(e), this.toPosition(this.lap + Math.min(Math.max(Math.round(e), 0), this.frames - 1));
	}
	step(e) {
		Bc(e), this.pause();
		let t = this.ring.stepped(this.following ?? this.goal ?? this.shown.position, Math.round(e));
		return this.loop ? this.toPosition(t < 0 ? t + this.frames : t) : this.toPosition(Math.min(Math.max(t, this.lap), this.end));
	}
	update(e = performance.now()) {
		if (this.disposed) return;
		let t = Math.max(e, this.last ?? e), n = this.last === null ? 0 : Math.min((t - this.last) / 1e3, Pc);
		if (this.last = this.plays && this.goal === null ? t : null, this.goal === null && !this.plays) return;
		this.goal === null ? (this.advance(n), this.sound?.follow(this.first + this.clock % this.frames / this.rate, this.pace)) : this.sound?.rest();
		let r = this.ring.take(this.goal ?? Math.floor(this.clock));
		r && this.show(r), this.goal === null && !this.loop && this.clock >= this.end && this.ring.isOver(this.end) && this.pause();
	}
	dispose() {
		this.disposed = !0, this.plays = !1, globalThis.document?.removeEventListener("visibilitychange", this.hide), this.ring.dispose(), this.sound?.dispose(), this.settle();
	}
	get lap() {
		return this.shown.position - this.shown.number;
	}
	get end() {
		return this.lap + this.frames - 1;
	}
	advance(e) {
		let [t, n] = [this.clock, e * this.pace * this.rate], r = this.loop ? this.ring.reach : Math.min(this.ring.reach, this.end);
		if (this.clock = Math.max(t, Math.min(t + n, r)), e > Rc) return;
		let { watched: i } = this;
		i.seconds += e, i.due += n, this.ring.busy && (i.short += n - (this.clock - t)), i.seconds < Ic || (i.short > Lc * i.due && this.ring.leaveOut(), this.watch());
	}
	watch() {
		this.watched = {
			seconds: 0,
			due: 0,
			short: 0
		};
	}
	hide = () => {
		document.hidden && this.sound?.rest();
	};
	toPosition(e) {
		let t = new Promise((e) => void this.waiters.push(e));
		return this.goal === null ? this.begin(e) : this.following = e, t;
	}
	begin(e) {
		let t = this.ring.standIn(e);
		if (this.following = null, this.watch(), t === this.shown.position && this.ring.follows(t)) return this.goal = null, this.clock = t, this.settle();
		if (this.goal = this.ring.seek(t) ? t : null, this.preview(), this.goal === null) return this.settle();
		this.dispatchEvent({ type: "change" }), this.wake();
	}
	show(e) {
		let { position: t, number: n } = e;
		this.shown = {
			position: t,
			number: n
		}, this.user.show(e), this.note(e), this.goal !== null && t !== this.goal && this.following === null ? this.preview() : this.goal !== null && (this.goal = null, this.clock = t, this.following === null ? this.settle() : this.begin(this.following)), this.dispatchEvent({ type: "frame" });
	}
	preview() {
		this.ring.previewsFrom = this.goal === null ? Infinity : performance.now() + Fc;
	}
	note({ films: e }) {
		let t = [];
		this.ring.sparse && t.push("keys"), e.some((e) => e?.grown) && t.push("bits"), e.includes(null) && t.push("textures"), t.join() !== this.lacking.join() && (this.lacking = t, this.dispatchEvent({ type: "change" }));
	}
	thin() {
		let e = this.following ?? this.goal;
		this.lacking = ["keys"], e !== null && this.begin(e), this.dispatchEvent({ type: "change" }), this.wake();
	}
	settle() {
		for (let e of this.waiters.splice(0)) e();
		this.dispatchEvent({ type: "change" });
	}
	wake() {
		this.asked !== null || this.disposed || !this.plays && this.goal === null || (this.asked = requestAnimationFrame((e) => {
			this.asked = null, this.update(e), this.plays && this.wake();
		}));
	}
	fail(e, t) {
		if (this.disposed) return;
		this.user.failed(e), t === null && (this.lacking = [], this.pause());
		let n = this.goal !== null && q(this.timeline, this.goal % this.frames);
		n === !1 || t !== null && n !== t || (this.goal !== null && (this.clock = this.goal), this.goal = this.following = null, this.settle());
	}
};
function Bc(e) {
	if (!Number.isFinite(e)) throw RangeError("Times and numbers of frames are finite.");
}
// eigenfield-three/src/proxy.ts
var Vc = 65535;
function Hc(e, t) {
	let n = e.getAttribute("position"), r = e.getAttribute("uv"), { index: i } = e;
	if (!i) throw new j("damaged", "The proxy mesh has no triangles; make or download the file again.");
	if (r.count !== n.count) throw M(t.uv.where, `${r.count} for ${n.count} vertices`);
	for (let e = 0; e < n.count; e++) {
		if (!(Math.max(Math.abs(n.getX(e)), Math.abs(n.getY(e)), Math.abs(n.getZ(e))) <= 1e30)) throw M(t.position.where, `vertex ${e} is not finite`);
		if (!(Math.max(Math.abs(r.getX(e)), Math.abs(r.getY(e))) <= 1e30)) throw M(t.uv.where, `texture coordinates of vertex ${e} are not finite`);
	}
	for (let e of i.array) if (e >= n.count) throw M(t.indices.where, `no vertex ${e}`);
}
async function Uc({ view: e, codec: t, where: n }, r) {
	let i = t.decode(new Uint8Array(await r(e)), n);
	if (!i.indices.length) throw M(n, "a mesh without faces");
	return i;
}
function Wc({ positions: n, uv: r, indices: i }) {
	let a = new t();
	a.setAttribute("position", new e(n.slice(), 3)), a.setAttribute("uv", new e(r, 2));
	let o = n.length / 3 <= Vc;
	return a.setIndex(new e(o ? Uint16Array.from(i) : i, 1)), a;
}
function Gc(e) {
	return {
		vertices: e.getAttribute("position").count,
		triangles: (e.index?.count ?? 0) / 3
	};
}
// eigenfield-three/src/footprint.ts
var Kc = 256;
function qc(e, t, n) {
	let { index: r } = e, i = e.getAttribute("position"), a = e.getAttribute("uv");
	if (!r || !i || !a) return 0;
	let o = r.count / 3, s = Math.max(1, Math.floor(o / Kc)), c = [];
	for (let e = 0; e < o; e += s) {
		let o = [
			0,
			1,
			2
		].map((t) => r.getX(3 * e + t)), s = o.map((e) => Jc(t, i.getX(e), i.getY(e), i.getZ(e))), l = Yc(s), [u = NaN, d = NaN] = [0, 1].map((e) => s.reduce((t, n) => t + (n[e] ?? NaN) / 3, 0));
		if (!(l > 0 && u >= 0 && d >= 0 && u < t.width && d < t.height)) continue;
		let f = Yc(o.map((e) => [a.getX(e) * n[0], a.getY(e) * n[1]]));
		c.push({
			footprint: Math.sqrt(f / l),
			area: l
		});
	}
	c.sort((e, t) => e.footprint - t.footprint);
	let l = c.reduce((e, { area: t }) => e + t, 0) / 2, u = 0;
	return c.find(({ area: e }) => (u += e) >= l)?.footprint ?? 0;
}
function Jc({ K: e, R: t, t: n }, r, i, a) {
	let o = (e) => t[e][0] * r + t[e][1] * i + t[e][2] * a + n[e], [s, c, l] = [
		o(0),
		o(1),
		o(2)
	];
	return l > 0 ? [(e[0][0] * s + e[0][1] * c) / l + e[0][2], e[1][1] * c / l + e[1][2]] : [NaN, NaN];
}
function Yc(e) {
	let [[t = 0, n = 0] = [], [r = 0, i = 0] = [], [a = 0, o = 0] = []] = e;
	return Math.abs((r - t) * (o - n) - (i - n) * (a - t)) / 2;
}
// eigenfield-three/src/sheet-stack.ts
var Xc = "sheets", Zc = 16, Qc = "\nprecision highp float;\nin vec3 position;\nvoid main() { gl_Position = vec4(position, 1.0); }\n", $c = `${Ns}${Ps}
uniform sampler2D sheets;      // R, G, B times coverage, and coverage
uniform sampler2D solid;       // depth of what is at least half opaque
uniform sampler2D nearest;     // depth of the last sheet, within its slice
uniform float slices;
uniform vec2 corner;           // of the viewport in what is drawn into
uniform vec2 size;             // of the viewport
uniform mat4 toPlace;          // from clip space
out vec4 fragment;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy - corner);
  vec4 colour = texelFetch(sheets, at, 0);
  if (colour.a <= 0.0) discard;
  colour.rgb = clamp(colour.rgb, 0.0, 1.0);
  vec4 known = texelFetch(solid, at, 0);
  float depth = fract(texelFetch(nearest, at, 0).r * slices);
  if (known.a > 0.5) depth = dot(floor(255.0 * known.rgb + 0.5), vec3(65536.0, 256.0, 1.0)) / 16777215.0;
  if (shown == 3) {
    vec2 pixel = (gl_FragCoord.xy - corner) / size;
    vec4 place = toPlace * vec4(2.0 * vec3(pixel, depth) - 1.0, 1.0);
    colour.rgb = errorColour(min(colour.rgb / colour.a, 1.0), place.xyz / place.w) * colour.a;
  }
  gl_FragDepth = depth;
  fragment = colour;
}
`, el = new ae(), tl = class {
	material;
	scene = new k();
	camera = new n();
	sheets = new S();
	depth;
	screen;
	everywhere = new t();
	target = null;
	constructor(t) {
		this.material = t, this.depth = Hs(t), this.depth.transparent = t.transparent = !0, this.sheets.frustumCulled = !1, this.sheets.onBeforeRender = (e, t, n, r, i, a) => {
			let { materialIndex: o = 0 } = a, s = this.sheets.material.length / 2, c = s - 1 - (o >> 1);
			e.getContext().depthRange(c / s, (c + 1) / s);
		}, this.scene.add(this.sheets), this.scene.matrixWorldAutoUpdate = this.camera.matrixWorldAutoUpdate = !1;
		let { shown: n, photograph: r, toPhotograph: i } = t.uniforms;
		this.screen = new O({
			name: Xc,
			glslVersion: h,
			vertexShader: Qc,
			fragmentShader: $c,
			uniforms: {
				shown: n,
				photograph: r,
				toPhotograph: i,
				sheets: { value: null },
				solid: { value: null },
				nearest: { value: null },
				slices: { value: 1 },
				corner: { value: new ie() },
				size: { value: new ie() },
				toPlace: { value: new x() }
			},
			transparent: !0,
			...zs
		});
		let a = new Float32Array([
			-1,
			-1,
			0,
			3,
			-1,
			0,
			-1,
			3,
			0
		]);
		this.everywhere.setAttribute("position", new e(a, 3));
	}
	get bytes() {
		return this.target ? Zc * this.target.width * this.target.height : 0;
	}
	setGeometry(e, t) {
		e.clearGroups();
		let n = 0;
		t.forEach((t, r) => {
			for (let i of [0, 1]) e.addGroup(n, 3 * t, 2 * r + i);
			n += 3 * t;
		}), this.sheets.geometry = e, this.sheets.material = t.flatMap(() => [this.depth, this.material]), this.set("slices", t.length), e.computeBoundingBox(), e.computeBoundingSphere();
		let { boundingBox: r, boundingSphere: i } = e;
		Object.assign(this.everywhere, {
			boundingBox: r,
			boundingSphere: i
		});
	}
	attach(e, t) {
		for (let t of [e.material].flat()) t.visible = !1;
		let n = new S(this.everywhere, this.screen);
		n.name = Xc, n.raycast = () => void 0, n.onBeforeRender = (n, r, i) => {
			t(n, i), this.draw(n, i, e);
		}, e.add(n);
	}
	set(e, t) {
		Object.assign(this.screen.uniforms[e] ?? {}, { value: t });
	}
	dispose() {
		this.target?.dispose(), this.depth.dispose(), this.screen.dispose();
	}
	draw(e, t, n) {
		let { x: r, y: i, z: a, w: o } = t.viewport ?? e.getCurrentViewport(el);
		if (!a || !o) return;
		(this.target?.width !== a || this.target.height !== o) && (this.target?.dispose(), this.target = nl(a, o));
		let { target: s } = this;
		this.sheets.matrixWorld.copy(n.matrixWorld), this.camera.matrixWorld.copy(t.matrixWorld), this.camera.matrixWorldInverse.copy(t.matrixWorldInverse), this.camera.projectionMatrix.copy(t.projectionMatrix), _s(e, t, () => {
			e.setRenderTarget(s), e.state.buffers.color.setMask(!0), e.clear(!0, !0, !1), e.render(this.scene, this.camera);
		}), e.getContext().depthRange(0, 1);
		let { uniforms: c } = this.screen;
		this.set("sheets", s.textures[0]), this.set("solid", s.textures[1]), this.set("nearest", s.depthTexture), c.corner?.value.set(r, i), c.size?.value.set(a, o), (c.toPlace?.value).multiplyMatrices(t.projectionMatrix, t.matrixWorldInverse).multiply(n.matrixWorld).invert(), this.screen.uniformsNeedUpdate = !0;
	}
};
function nl(e, t) {
	let n = new l(e, t, re);
	n.format = c;
	let r = new oe(e, t, {
		count: 2,
		type: g,
		stencilBuffer: !0,
		depthTexture: n,
		minFilter: w,
		magFilter: w
	}), [, i] = r.textures;
	return i && (i.type = ne), r;
}
// eigenfield-three/src/surface.ts
var rl = class {
	meshes;
	faces;
	reference;
	mesh;
	material;
	version = 0;
	laid = 0;
	detail = 0;
	stack;
	constructor(e, t, n, r) {
		this.meshes = e, this.faces = t, this.reference = n;
		let [i] = e;
		if (!i) throw Error("a field needs a mesh");
		this.mesh = i;
		let a = [i.material].flat().some((e) => e.side !== m);
		this.material = Vs(a, t !== null), this.stack = t && new tl(this.material);
		for (let t of e) {
			let e = (e, n) => r(e, n, t);
			this.stack ? this.stack.attach(t, e) : (t.material = this.material, t.onBeforeRender = (t, n, r) => e(t, r));
		}
		this.show(t);
	}
	get geometry() {
		return this.mesh.geometry;
	}
	get bytes() {
		return this.stack?.bytes ?? 0;
	}
	setGeometry(e, t = this.faces) {
		let n = this.geometry;
		if (n !== e) {
			let { index: r, attributes: i } = e;
			if (!r || !i.position || !i.uv) throw TypeError("A surface needs position, uv and an index.");
			this.stack && t && sa({
				faces: t,
				where: "the geometry"
			}, e), n.dispose();
		}
		for (let t of this.meshes) t.geometry = e;
		e.boundingBox = e.boundingSphere = null, this.faces = t, this.version += 1, n !== e && (this.laid = this.version), this.show(t);
	}
	show(e) {
		e && this.stack?.setGeometry(this.geometry, e), this.detail = this.reference ? qc(this.geometry, this.reference, [1, 1]) : 0;
	}
	dispose() {
		this.stack?.dispose(), this.material.dispose(), this.geometry.dispose();
	}
};
// eigenfield-three/src/gpu.ts
function il(e) {
	let t = e.getContext();
	if (!(t instanceof WebGL2RenderingContext)) throw new j("unsupported", "Eigen textures need WebGL 2; use a newer browser.");
	if ((t.getExtension("EXT_color_buffer_float") ?? t.getExtension("EXT_color_buffer_half_float")) || t.isContextLost()) return t;
	throw new j("unsupported", "The graphics of this device draw no half-floats; use a newer device or browser, or switch graphics acceleration on.");
}
function al(e, t) {
	return {
		side: e.getParameter(e.MAX_TEXTURE_SIZE),
		layers: e.getParameter(e.MAX_ARRAY_TEXTURE_LAYERS),
		memory: t
	};
}
function ol(e, { components: t, halves: n }) {
	return t > 2 ? n ? e.RGBA16F : e.RGBA8 : t > 1 ? n ? e.RG16F : e.RG8 : n ? e.R16F : e.R8;
}
function sl(e, [t, n], r, i, a) {
	return dl(e, e.TEXTURE_2D_ARRAY, () => {
		e.texStorage3D(e.TEXTURE_2D_ARRAY, 1, ol(e, a), t, n, r);
		for (let t of [e.TEXTURE_WRAP_S, e.TEXTURE_WRAP_T]) e.texParameteri(e.TEXTURE_2D_ARRAY, t, e.CLAMP_TO_EDGE);
		for (let t of [e.TEXTURE_MIN_FILTER, e.TEXTURE_MAG_FILTER]) e.texParameteri(e.TEXTURE_2D_ARRAY, t, i ? e.LINEAR : e.NEAREST);
	});
}
function cl(e, t, n, r) {
	let { width: i, height: a } = n, o = r > 2 ? e.RGBA : r > 1 ? e.RG : e.RED;
	fl(e, e.TEXTURE_2D_ARRAY, t, () => e.texSubImage3D(e.TEXTURE_2D_ARRAY, 0, 0, 0, 0, i, a, 1, o, e.UNSIGNED_BYTE, n));
}
function ll(e, t, n, r) {
	fl(e, e.TEXTURE_2D_ARRAY, t, () => {
		e.pixelStorei(e.UNPACK_ALIGNMENT, 1), r.forEach(({ data: t, width: r, height: i, stride: a }, o) => {
			e.pixelStorei(e.UNPACK_ROW_LENGTH, a / 2), e.texSubImage3D(e.TEXTURE_2D_ARRAY, 0, 0, 0, n + o, r, i, 1, e.RG, e.UNSIGNED_BYTE, t);
		});
	});
}
function ul(e, [t, n], r) {
	return dl(e, e.TEXTURE_2D, () => {
		e.texStorage2D(e.TEXTURE_2D, 1, ol(e, r), t, n);
		for (let t of [e.TEXTURE_MIN_FILTER, e.TEXTURE_MAG_FILTER]) e.texParameteri(e.TEXTURE_2D, t, e.NEAREST);
	});
}
function dl(e, t, n) {
	for (; e.getError() !== e.NO_ERROR && !e.isContextLost(););
	let r = e.createTexture();
	return fl(e, t, r, n), e.getError() === e.OUT_OF_MEMORY ? (e.deleteTexture(r), null) : r;
}
function fl(e, t, n, r) {
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
function pl(e, t, n) {
	let r = e.createProgram();
	for (let [i, a] of [[e.VERTEX_SHADER, t], [e.FRAGMENT_SHADER, n]]) {
		let t = e.createShader(i);
		t && (e.shaderSource(t, a), e.compileShader(t), e.attachShader(r, t), e.deleteShader(t));
	}
	return e.linkProgram(r), r;
}
function ml(e, t, n, r) {
	if (!n) {
		r();
		return;
	}
	let i = e.getParameter(e.ACTIVE_TEXTURE);
	e.activeTexture(e.TEXTURE0 + t);
	let a = e.getParameter(e.SAMPLER_BINDING);
	e.bindSampler(t, null), fl(e, e.TEXTURE_2D, n, r), e.bindSampler(t, a), e.activeTexture(i);
}
function hl(e, t) {
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
	n.forEach((t) => e.disable(t)), t(), n.forEach((t) => e.enable(t)), e.useProgram(r && e.isProgram(r) ? r : null), e.bindVertexArray(i), e.bindFramebuffer(e.DRAW_FRAMEBUFFER, a), e.viewport(o, s, c, l), e.colorMask(u ?? !0, d ?? !0, f ?? !0, p ?? !0);
}
// eigenfield-three/src/charts.ts
function gl(e, t) {
	let n = pl(e, ...Dc), r = e.createFramebuffer(), i = null, a = (t, i, a) => {
		let { index: o } = t, s = t.getAttribute("uv"), c = Float32Array.from({ length: 2 * (o?.count ?? 0) }, (e, t) => {
			let n = o?.getX(t >> 1) ?? 0;
			return t % 2 ? s.getY(n) : s.getX(n);
		}), [l, u] = [e.createVertexArray(), e.createBuffer()], d = e.getParameter(e.ARRAY_BUFFER_BINDING);
		hl(e, () => {
			e.useProgram(n), e.bindVertexArray(l), e.bindBuffer(e.ARRAY_BUFFER, u), e.bufferData(e.ARRAY_BUFFER, c, e.STREAM_DRAW);
			let t = e.getAttribLocation(n, "uv");
			e.enableVertexAttribArray(t), e.vertexAttribPointer(t, 2, e.FLOAT, !1, 0, 0), e.bindFramebuffer(e.DRAW_FRAMEBUFFER, r), e.framebufferTexture2D(e.DRAW_FRAMEBUFFER, e.COLOR_ATTACHMENT0, e.TEXTURE_2D, a, 0), e.viewport(0, 0, ...i), e.colorMask(!0, !0, !0, !0), e.drawArrays(e.TRIANGLES, 0, c.length / 2);
		}), e.bindBuffer(e.ARRAY_BUFFER, d), e.deleteBuffer(u), e.deleteVertexArray(l);
	};
	return {
		covered(n) {
			let { geometry: r } = t;
			if (i?.grid.join() !== n.join() || i.geometry !== r) {
				e.deleteTexture(i?.texture ?? null);
				let t = ul(e, n, {
					components: 1,
					halves: !1
				});
				t && a(r, n, t), i = {
					geometry: r,
					grid: n,
					texture: t
				};
			}
			return i.texture;
		},
		free() {
			e.deleteTexture(i?.texture ?? null), e.deleteFramebuffer(r), e.deleteProgram(n);
		}
	};
}
// eigenfield-three/src/packing.ts
var _l = [
	"precisions",
	"covered",
	"factors",
	"size",
	"made",
	"first",
	"corner",
	"nodes",
	"zero"
];
function vl(e, t, n, r) {
	let [i, a, o] = [
		pl(e, Cc, wc),
		pl(e, Cc, Tc),
		pl(e, Cc, Ec)
	], [s, c] = [e.createFramebuffer(), e.createVertexArray()], l = t.smaller && gl(e, r), u = (t) => Object.fromEntries(_l.map((n) => [n, e.getUniformLocation(t, n)])), [d, f] = [u(i), u(a)], p = (t, n, r, i, a, o, s) => {
		let { picture: c, rows: l } = n, { size: u, corner: d, unit: f, codes: p } = i;
		yl(c) ? e.uniform4f(t.factors, 255 * f, 65280 * f, 0, 0) : e.uniform4fv(t.factors, [
			0,
			1,
			2,
			3
		].map((e) => e === r ? p * f : 0)), e.uniform2i(t.size, c.width, l), e.uniform2i(t.made, ...u), e.uniform2i(t.corner, ...d), e.uniform1i(t.first, a), e.viewport(0, o, u[0], s), e.drawArrays(e.TRIANGLES, 0, 3);
	}, m = (t, n) => {
		e.bindFramebuffer(e.DRAW_FRAMEBUFFER, s), n === null ? e.framebufferTexture2D(e.DRAW_FRAMEBUFFER, e.COLOR_ATTACHMENT0, e.TEXTURE_2D, t, 0) : e.framebufferTextureLayer(e.DRAW_FRAMEBUFFER, e.COLOR_ATTACHMENT0, t, 0, n);
	}, h = (t, { layer: n, component: r }) => {
		m(t, n), e.colorMask(r === 0, r === 1, r === 2, r === 3);
	}, g = (r, s, u, g, _, v) => {
		let { picture: y, row: b, rows: x } = r, [S, C] = _.size, w = S < y.width || C < x ? t.smaller : null, T = Math.max(1, Math.floor((w ? n - 2 : n) * C / x)), E = (w && l?.covered(_.grid)) ?? null;
		ml(e, 0, s, () => {
			for (let t = 0; t < C; t += T) {
				let n = Math.min(T, C - t), o = Math.floor(t * x / C), s = Math.ceil((t + n) * x / C);
				yl(y) ? xl(e, y, b + o, s - o) : bl(e, y, b + o, s - o), ml(e, 2, E, () => hl(e, () => {
					let s = w || v ? f : d;
					e.useProgram(w || v ? a : i), e.bindVertexArray(c), e.uniform1i(s.precisions, +!!v), e.uniform1i(s.covered, w ? 2 : 0), e.uniform2i(s.nodes, v?.precision.width ?? 0, v?.precision.height ?? 0), e.uniform1f(s.zero, v?.zero ?? 0), w ? (m(w, null), e.colorMask(!0, !0, !0, !0)) : h(u, g), p(s, r, g.channel, _, o, t, n);
				}));
			}
		}), w && ml(e, 0, w, () => hl(e, () => {
			e.useProgram(o), e.bindVertexArray(c), e.uniform2i(e.getUniformLocation(o, "size"), S, C), h(u, g), e.viewport(0, 0, S, C), e.drawArrays(e.TRIANGLES, 0, 3);
		}));
	};
	return {
		put(n, r, i, a, o = null) {
			let s = yl(n.picture) ? t.codes : t.picture;
			if (!s) return;
			let c = () => i.forEach((e) => g(n, s, r, e, a, o));
			o ? ml(e, 1, t.precision, () => {
				bl(e, o.precision, 0, o.precision.height), c();
			}) : c();
		},
		free() {
			for (let n of Object.values(t)) e.deleteTexture(n);
			l?.free(), e.deleteVertexArray(c), e.deleteFramebuffer(s);
			for (let t of [
				i,
				a,
				o
			]) e.deleteProgram(t);
		}
	};
}
function yl(e) {
	return "data" in e;
}
function bl(e, t, n, r) {
	e.pixelStorei(e.UNPACK_SKIP_ROWS, n), e.texSubImage2D(e.TEXTURE_2D, 0, 0, 0, t.width, r, e.RGBA, e.UNSIGNED_BYTE, t);
}
function xl(e, { data: t, width: n, stride: r }, i, a) {
	e.pixelStorei(e.UNPACK_ALIGNMENT, 1), e.pixelStorei(e.UNPACK_ROW_LENGTH, r / 2), e.texSubImage2D(e.TEXTURE_2D, 0, 0, 0, n, a, e.RG, e.UNSIGNED_BYTE, t, i * r);
}
// eigenfield-three/src/textures.ts
var Sl = class {
	parts;
	source;
	surface;
	options;
	means;
	bases;
	ready;
	plan = null;
	version = 0;
	onPlan = () => void 0;
	onTexture = () => void 0;
	onComplete = () => void 0;
	onError = () => void 0;
	needs;
	layout;
	stillVersions;
	renderer = null;
	packer = null;
	turn = new AbortController();
	disposed = !1;
	constructor(e, t, n, r) {
		this.parts = e, this.source = t, this.surface = n, this.options = r;
		let { scene: i, info: a, meanSizes: o } = e, s = i.planes.flatMap(({ channels: e, bases: t }) => t.map((t) => ({
			...t,
			channels: e,
			tenBits: Ki(t.pictures)
		})));
		this.layout = s;
		let c = Aa(i).map(({ channels: e, mean: t }, n) => {
			let r = n === i.planes.length;
			return {
				size: o[n] ?? [1, 1],
				channels: e,
				pieces: t.pieces,
				tenBits: Ki([t]),
				opacity: r
			};
		}), l = Aa(i).some(({ mean: e }) => e.part), u = wl(n.geometry);
		this.needs = {
			atlas: a.size,
			means: c,
			bases: s,
			films: l,
			rays: a.facesPlane,
			geometry: u
		}, this.means = c.map(() => new p()), this.bases = s.map(() => new p()), this.ready = s.map(({ count: e }) => Array(e).fill(!1)), this.stillVersions = c.map(() => 0);
	}
	get hasMeans() {
		return this.stillVersions.every((e) => e > 0);
	}
	get opacityVersion() {
		return this.stillVersions[this.parts.scene.planes.length] ?? 0;
	}
	get loaded() {
		let e = this.ready.map((e) => e.indexOf(!1)).filter((e) => e >= 0), t = Math.max(0, ...this.ready.map((e) => e.length));
		return Math.min(t, ...e);
	}
	get bytes() {
		return this.plan ? this.plan.bytes - this.needs.geometry + wl(this.surface.geometry) : 0;
	}
	serves(e) {
		return this.disposed || this.renderer === e ? !0 : this.renderer !== null && !this.renderer.getContext().isContextLost();
	}
	attach(e) {
		if (this.disposed) return;
		this.detach(), this.renderer = e, e.domElement.addEventListener("webglcontextlost", this.forget), e.domElement.addEventListener("webglcontextrestored", this.onRestored);
		let { signal: t } = this.turn;
		this.load(e, t).catch((e) => {
			t.aborted || this.onError(e);
		});
	}
	dispose() {
		this.detach(), this.disposed = !0, this.source.dispose();
	}
	detach() {
		let e = this.renderer?.getContext();
		this.packer?.free(), this.renderer?.domElement.removeEventListener("webglcontextlost", this.forget), this.renderer?.domElement.removeEventListener("webglcontextrestored", this.onRestored), this.renderer = null;
		for (let { sourceTexture: t } of [...this.means, ...this.bases]) e && t instanceof WebGLTexture && e.deleteTexture(t);
		this.forget();
	}
	forget = () => {
		this.turn.abort(), this.turn = new AbortController(), this.version += 1, this.packer = null, this.stillVersions.fill(0), this.ready.forEach((e) => e.fill(!1));
		for (let e of [...this.means, ...this.bases]) e.sourceTexture = null;
	};
	onRestored = () => {
		this.renderer && this.attach(this.renderer);
	};
	async load(e, t) {
		let n = il(e);
		if (n.isContextLost()) return;
		let { packer: r, plan: i } = this.makeRoom(n);
		this.plan = i, this.packer = r, this.onPlan(i), await this.source.fill(this.filling(n, i, t)), t.aborted || this.onComplete();
	}
	filling(e, t, n) {
		return {
			plan: t,
			signal: n,
			putMean: (r, i) => {
				n.aborted || this.putMean(e, t, r, i);
			},
			putTextures: (r, i, a, o) => {
				n.aborted || this.putTextures(e, t, r, i, a, o);
			},
			announce: () => {
				n.aborted || this.onTexture();
			},
			end: () => {
				n.aborted || (this.packer?.free(), this.packer = null);
			}
		};
	}
	putTextures(e, t, n, r, i, a) {
		let { usable: o, scaleDown: s, halves: c, words: l } = t, [u, d, f] = [
			this.bases[n]?.sourceTexture,
			this.ready[n],
			this.layout[n]
		];
		if (!(u instanceof WebGLTexture) || !d || !f) return;
		let { size: p, grid: m, corner: h, channels: g, tenBits: _ } = f;
		l && ll(e, u, g * r, Cl(i.slice(0, g * (o - r))));
		let v = Ji(a, c && _), y = {
			size: X(p, s),
			grid: m,
			corner: h,
			unit: v,
			codes: 255 * qi(a)
		};
		for (let e = r; e < Math.min(r + a.textures, o); e++) {
			let t = i.slice((e - r) * a.pieces, (e - r + 1) * a.pieces), n = g * Math.floor(e / 4);
			l || this.put(t, u, g, y, (t) => ({
				layer: n + t,
				component: e % 4
			})), d[e] = !0;
		}
		this.version += 1;
	}
	putMean(e, t, n, { pieces: r, precision: i }) {
		let [a, o] = [this.means[n]?.sourceTexture, Aa(this.parts.scene)[n]], { size: s, tenBits: c } = this.needs.means[n] ?? {};
		if (!(a instanceof WebGLTexture) || !o || !s) return;
		if (this.stillVersions[n] = this.version += 1, t.words) return ll(e, a, 0, Cl(r));
		let { mean: l, channels: u } = o, d = X(s, t.meanDown), [f] = r;
		if (f && r.length === 1 && "close" in f.picture && !c && d.join() === s.join()) {
			cl(e, a, f.picture, u);
			return;
		}
		let p = {
			size: d,
			grid: s,
			corner: [0, 0],
			unit: Ji(l, c === !0),
			codes: 255 * qi(l)
		};
		this.put(r, a, u, p, (e) => ({
			layer: Math.floor(e / 4),
			component: e % 4
		}), (e) => i && {
			precision: i,
			zero: l.zero[e] ?? 0
		});
	}
	put(e, t, n, r, i, a = () => null) {
		let o = e.length < n;
		e.forEach((e, n) => {
			let s = (o ? [
				0,
				1,
				2
			] : [n]).map((e) => ({
				channel: o ? e : 0,
				...i(e)
			}));
			this.packer?.put(e, t, s, r, a(n));
		});
	}
	makeRoom(e) {
		let { means: t, bases: n } = this.needs;
		this.needs.geometry = wl(this.surface.geometry);
		let r = this.parts.scene.planes.flatMap(({ precision: e }) => e ? [e.size] : []);
		for (let i = this.options.memory ?? Mo();; i /= 2) {
			let a = Ho(this.needs, al(e, i)), { meanDown: o, scaleDown: s, usable: c, halves: l, words: u } = a, d = o !== s, f = [...t.map(({ size: t, channels: n, tenBits: r }) => {
				if (u) return sl(e, t, n, !1, To);
				let i = {
					components: n,
					halves: r
				};
				return sl(e, X(t, o), Fo(n), !1, i);
			}), ...n.map(({ size: t, channels: n, count: r, tenBits: i }) => {
				let a = Math.min(r, c);
				return u && a ? sl(e, t, n * a, !1, To) : sl(e, a ? X(t, s) : [1, 1], a ? Io(a, n) : 1, d, {
					components: Math.max(1, a),
					halves: l && i
				});
			})], p = () => {
				[...this.means, ...this.bases].forEach((e, t) => e.sourceTexture = f[t] ?? null);
			};
			if (u && !f.includes(null)) return p(), {
				packer: null,
				plan: a
			};
			let m = Go(this.needs, a, i), [h, g, _] = [
				m.picture,
				m.codes,
				m.smaller
			].map((t) => t ? ul(e, t.size, t.format) : null), v = ul(e, Ko(r), wo);
			if (h && v && (g || !m.codes) && (_ || !m.smaller) && !f.includes(null)) return p(), {
				packer: vl(e, {
					picture: h,
					codes: g ?? null,
					precision: v,
					smaller: _ ?? null
				}, m.picture.size[1], this.surface),
				plan: a
			};
			for (let t of [
				...f,
				h,
				g,
				_,
				v
			]) e.deleteTexture(t ?? null);
			if (!c) throw new j("unsupported", "The graphics memory is full; close other pages and try again.");
		}
	}
};
function Cl(e) {
	return e.map(({ picture: e }) => e);
}
function wl({ attributes: e, index: t }) {
	return Object.values(e).reduce((e, t) => e + t.array.byteLength, 0) + (t?.array.byteLength ?? 0);
}
// eigenfield-three/src/field.ts
var Tl = 1.5, El = .001, Dl = class extends f {
	parts;
	source;
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
	player;
	complete;
	giveUp = () => void 0;
	surface;
	textures;
	weights;
	group;
	plain = !1;
	moved;
	summed = {
		parts: [],
		opacity: null
	};
	composers = /* @__PURE__ */ new Map();
	encoded;
	gains = /* @__PURE__ */ new Map();
	frame = -1;
	constructor(e, t, n = {}) {
		super(), this.parts = e, this.source = t;
		let { scene: r, info: i } = e, a = r.sheets?.faces ?? null;
		this.surface = new rl(e.meshes, a, i.cameras[i.reference], (...e) => this.prepare(...e)), this.mesh = this.surface.mesh, this.info = i, this.total = ro(r), this.filter = n.filter ?? "bicubic", this.weightMode = i.facesPlane ? "ray" : "eye", this.encoded = i.cameras.filter((e, t) => !i.heldOut[t]), this.weights = this.weightsOf(e.omega), this.group = e.clip && e.clip.group, this.player = e.clip && this.makePlayer(e.clip), this.moved = e.clip && this.surface.geometry, e.clip && this.shape(e.clip.group, 0, e.clip.mesh, !1), this.textures = new Sl(e, t, this.surface, n), this.complete = new Promise((e, t) => {
			this.giveUp = t, this.addEventListener("complete", () => e()), this.addEventListener("error", ({ error: e }) => t(e));
		}), this.complete.catch(() => void 0), this.listen(), n.renderer && this.textures.attach(n.renderer);
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
	get reductions() {
		return this.textures.plan?.reductions ?? [];
	}
	get limitation() {
		return this.textures.plan?.limitation ?? null;
	}
	get gpuBytes() {
		return this.textures.bytes + this.surface.bytes;
	}
	viewWeights(e, t, n = this.mixing) {
		return this.weights.viewsAt(e, t, n);
	}
	componentWeights(e, t) {
		return this.weights.at(e, t, this.mixing);
	}
	cameraWeights(e) {
		return this.weights.ofCamera(e, this.mixing);
	}
	setGeometry(e, t) {
		this.surface.setGeometry(e, t);
	}
	restore(e) {
		this.textures.attach(e);
	}
	dispose() {
		this.giveUp(new DOMException("The field was disposed of.", "AbortError")), this.player?.dispose(), this.textures.dispose(), this.freeComposers(), this.surface.dispose(), this.weights.dispose();
	}
	listen() {
		this.textures.onPlan = (e) => {
			let { scene: t } = this.parts;
			this.freeComposers(), this.summed = {
				parts: Oc(t, this.textures, e),
				opacity: Ac(t, this.textures, e)
			}, e.limitation && queueMicrotask(() => this.dispatchEvent({ type: "limited" }));
		}, this.textures.onTexture = () => this.dispatchEvent({ type: "texture" }), this.textures.onComplete = () => this.dispatchEvent({ type: "complete" }), this.textures.onError = (e) => this.fail(e);
	}
	finestOf([e, t], n) {
		return Tl * Math.max(1, this.surface.detail * Math.sqrt(e * t) / n);
	}
	weightsOf(e) {
		let { scene: t, info: n, weights: r } = this.parts;
		return new Ds(n, J(t).map(({ count: e }) => e), e, r);
	}
	makePlayer({ timeline: e, ring: t, sound: n }) {
		return new zc(e, t, {
			show: (e) => this.showFrame(e),
			failed: (e) => this.dispatchEvent({
				type: "error",
				error: de(e)
			})
		}, n);
	}
	showFrame({ number: e, group: t, films: n }) {
		this.group && this.shape(t, e - t.first, this.group.mesh, this.group.motion !== null), t !== this.group && this.enter(t), this.plain = n.includes(null), this.source instanceof Xs && this.source.show(n);
	}
	shape({ mesh: e, motion: t }, n, r, i) {
		if (this.surface.geometry !== this.moved || e === r && !t && !i) return;
		let a = e === r ? this.moved : Wc(e), o = a.getAttribute("position");
		t ? t.place(n, o.array) : o.copyArray(e.positions), o.needsUpdate = !0, this.moved = a, this.surface.setGeometry(a);
	}
	enter(e) {
		let { scene: t } = this.parts, { plan: n } = this.textures;
		this.group = e, this.weights.dispose(), this.weights = this.weightsOf(e.omega), fc(t, e), n && kc(this.summed.parts, t, this.textures, n);
	}
	prepare(e, t, n) {
		this.textures.serves(e) || this.textures.attach(e);
		let r = Al(t, n), [i, a] = lo(this.info.viewPlane, r), o = this.camera !== null && this.info.cameras[this.camera] ? this.camera : null, s = o === null ? this.componentWeights(i, a) : this.cameraWeights(o), c = o === null && this.weightMode === "ray" && this.info.facesPlane && !this.isOnPlane(r), { material: l } = this.surface;
		this.setView(), this.setExposure(o, [i, a]);
		let u = ks[this.filter];
		l.defines.BICUBIC !== u && (l.defines.BICUBIC = u, l.needsUpdate = !0), l.uniformsNeedUpdate = !0, this.compose(e, t, this.recipe(s, c ? r : null)), e.info.render.frame !== this.frame && (this.lastWeights = []), this.frame = e.info.render.frame, this.lastWeights.push(s), this.lastByRay = c;
	}
	compose(e, t, n) {
		let { plan: r } = this.textures, { size: i, viewPlane: a } = this.info;
		if (!r) return;
		let o = r.meanDown * this.coarser, s = this.composers.get(o);
		if (!s) {
			let { parts: e, opacity: t } = this.summed;
			s = new ys(i, e, t, o, this.coarser > 1, this.surface, a), this.composers.set(o, s);
		}
		s.compose(e, t, n);
		let { composed: c, finest: l } = this.surface.material.uniforms;
		c.value = s.texture, l.value = this.finestOf(i, o);
	}
	freeComposers() {
		for (let e of this.composers.values()) e.dispose();
		this.composers.clear();
	}
	recipe(e, t) {
		let n = this.surface.material.uniforms.shown.value, r = n === As.eigen ? this.shownEigen : null;
		return {
			version: this.textures.version,
			mean: this.textures.hasMeans && r === null,
			opacity: this.textures.opacityVersion,
			only: r,
			count: n === As.mean || this.plain ? 0 : Math.max(0, Math.floor(Math.min(this.count, this.total))),
			weights: e,
			eye: t && us(this.info.viewPlane, t),
			places: t ? this.surface.version : this.coarser > 1 ? this.surface.laid : 0,
			maps: t && this.weights.maps(this.mixing, this.usable)
		};
	}
	setExposure(e, t) {
		let { cameras: n, heldOut: r, mixedColours: i, viewPlane: a } = this.info, o = this.exposure ?? (i || this.showsErrors ? e : null), s = o === null ? void 0 : n[o], c = [[s, 1]];
		if (i && (o === null || r[o])) {
			let e = s ? lo(a, s.centre) : t, { camera: n, weight: r } = this.parts.weights.at(...e, this.mixing);
			c = [
				0,
				1,
				2,
				3
			].map((e) => [this.encoded[n[e] ?? 0], r[e] ?? 0]);
		}
		let { scale: l, bias: u } = xo(c), { exposureScale: d, exposureBias: f } = this.surface.material.uniforms;
		d.value.fromArray(l), f.value.fromArray(u);
	}
	get showsErrors() {
		return this.view === "error" && this.photograph !== null && this.camera !== null;
	}
	setView() {
		let { uniforms: e } = this.surface.material, t = this.showsErrors, n = this.view === "error" && !t ? "picture" : this.view, r = this.shownEigen;
		e.shown.value = As[n === "eigen" && (this.plain || r >= this.loaded) ? "mean" : n], n === "eigen" && (e.shownGain.value = this.gainOf(r));
		let i = t && this.info.cameras[this.camera ?? 0];
		i && this.photograph && Us(e, i, this.photograph);
	}
	get shownEigen() {
		return Math.min(Math.max(0, Math.floor(this.eigen)), this.total - 1);
	}
	gainOf(e) {
		let t = this.gains.get(e);
		return t !== void 0 || e < 0 ? t ?? 1 : (this.gains.set(e, 1), this.source.gain(e).then((t) => {
			this.gains.set(e, t), this.dispatchEvent({ type: "texture" });
		}).catch(() => void 0), 1);
	}
	isOnPlane(e) {
		let { origin: t, normal: n, extent: r } = this.info.viewPlane, i = e.reduce((e, r, i) => e + (r - (t[i] ?? 0)) * (n[i] ?? 0), 0);
		return Math.abs(i) <= El * Math.max(...r);
	}
	fail(e) {
		if (jl(e)) return;
		let t = de(e), n = `${t.message} The picture is drawn with ${this.loaded} of ${this.total} eigen textures.`, r = this.textures.hasMeans ? n : t.message;
		this.dispatchEvent({
			type: "error",
			error: new j(t.code, r, t.where)
		});
	}
}, Ol = new x(), kl = new A();
function Al(e, t) {
	return kl.setFromMatrixPosition(e.matrixWorld).applyMatrix4(Ol.copy(t.matrixWorld).invert()), [
		kl.x,
		kl.y,
		kl.z
	];
}
function jl(e) {
	return e instanceof DOMException && e.name === "AbortError";
}
// eigenfield-three/src/arrival.ts
var Ml = class {
	received = 0;
	onPush = () => void 0;
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
		}), this.received += e.length, this.settle(), this.onPush());
	}
	end() {
		this.ended = !0, this.settle();
	}
	fail(e) {
		this.broken ??= { reason: e }, this.settle();
	}
	settle() {
		let e = [];
		for (let t of this.waiters) t.to <= this.received ? t.resolve(this.copy(t.from, t.to)) : this.broken ? t.reject(this.broken.reason) : this.ended ? t.reject(le(this.received, t.to)) : e.push(t);
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
};
async function Nl(e, t, n) {
	let r = e.getReader();
	for (n.addEventListener("abort", () => void r.cancel().catch(() => void 0));;) {
		let { done: e, value: n } = await r.read();
		if (e) break;
		t.push(n);
	}
	n.throwIfAborted(), t.end();
}
// eigenfield-three/src/ranges.ts
var Pl = 2 ** 20, Fl = 2 ** 25, Il = 3, Ll = 500, Rl = class {
	source;
	arrival;
	length;
	part;
	signal;
	parted = !1;
	begun = !1;
	whole = null;
	constructor(e, t, n, r, i) {
		this.source = e, this.arrival = t, this.length = n, this.part = r, this.signal = i;
	}
	async read(e, t) {
		let { arrival: n } = this;
		if (t <= n.received || !this.begun || !this.parted && e <= n.received + Pl) {
			let r = await n.read(e, t).catch((e) => {
				if (this.signal.aborted || !(this.parted || this.begun && Bl(e))) throw e;
			});
			if (this.begun || this.limit(), r) return r;
		}
		if (this.giveUp(), typeof this.source != "string") return this.slice(this.source, e, t);
		let r = this.source;
		return zl(this.signal, () => this.whole?.read(e, t) ?? this.fetch(r, e, t), () => this.whole === null);
	}
	limit() {
		let { arrival: e } = this;
		this.begun = !0, e.onPush = () => {
			e.received >= Fl && e.received < this.length && this.giveUp();
		}, e.onPush();
	}
	giveUp() {
		this.parted || (this.parted = !0, this.part());
	}
	async slice(e, t, n) {
		let r = await e.slice(t, n).arrayBuffer();
		if (r.byteLength < n - t) throw le(t + r.byteLength, n);
		return r;
	}
	async fetch(e, t, n) {
		let r = { Range: `bytes=${t}-${n - 1}` }, i = await fetch(e, {
			headers: r,
			signal: this.signal
		}).catch((e) => {
			throw this.signal.aborted ? e : this.broken(t, e);
		});
		if (i.status === 200 && i.body) return this.receive(i.body).read(t, n);
		if (i.status !== 206) throw await i.body?.cancel(), this.broken(t, `The server answered ${i.status}`);
		let a = await i.arrayBuffer().catch((e) => {
			throw this.signal.aborted ? e : this.broken(t, e);
		});
		if (a.byteLength !== n - t) throw this.broken(t + a.byteLength, "a range that was cut short");
		return a;
	}
	receive(e) {
		let t = this.whole = new Ml();
		return Nl(e, t, this.signal).catch((e) => t.fail(this.signal.aborted ? e : this.broken(t.received, e))), t;
	}
	broken(e, t) {
		return new j("network", `The connection broke at byte ${e} of ${this.length} of the clip; it is tried again when it plays on.`, String(e), { cause: t });
	}
};
async function zl(e, t, n = () => !0) {
	for (let r = 1;; r++) try {
		return await t();
	} catch (t) {
		if (e.throwIfAborted(), r === Il || !Bl(t) || !n()) throw t;
		await new Promise((e) => setTimeout(e, Ll * 2 ** (r - 1))), e.throwIfAborted();
	}
}
function Bl(e) {
	return e instanceof j && e.code === "network";
}
// eigenfield-three/src/beside.ts
function Vl(e) {
	return { read: async (t, n, r) => {
		let i = e.get(t);
		if (!i) throw new j("damaged", `The folder has no file ${t}; copy the clip's whole folder.`, t);
		if (i.size !== n) throw M(t, `${i.size} bytes of ${n}`);
		return i.slice(0, r).arrayBuffer();
	} };
}
var Hl = class {
	scene;
	signal;
	arriving = /* @__PURE__ */ new Map();
	constructor(e, t) {
		this.scene = e, this.signal = t;
	}
	read(e, t, n) {
		return zl(this.signal, async () => {
			let r = this.arriving.get(e) ?? this.fetch(e, t);
			try {
				let i = await r.read(0, n);
				return n === t && this.arriving.delete(e), i;
			} catch (t) {
				throw this.arriving.delete(e), t;
			}
		});
	}
	fetch(e, t) {
		let n = new Ml();
		return this.arriving.set(e, n), this.receive(e, t, n).catch((t) => {
			n.fail(this.signal.aborted || t instanceof j ? t : Ul(e, t));
		}), n;
	}
	async receive(e, t, n) {
		let r = new URL(e, new URL(this.scene, document.baseURI)), { ok: i, status: a, headers: o, body: s } = await fetch(r, { signal: this.signal }), c = o.get("Content-Encoding") ? null : o.get("Content-Length"), l = i && c !== null && Number(c) !== t;
		if (i && s && !l) return Nl(s, n, this.signal);
		throw await s?.cancel(), l ? M(e, `${c} bytes of ${t}`) : Ul(e, `The server answered ${a}`);
	}
};
function Ul(e, t) {
	return new j("network", `The clip's file ${e} cannot be fetched; put it beside the clip's own. It is tried again when it plays on.`, e, { cause: t });
}
// eigenfield-three/src/film-pictures.ts
var Wl = {
	mimeType: "video/AV1",
	bits: 10
};
async function Gl(e, t, n) {
	let r = {
		view: -1,
		codec: Wl,
		textures: 1,
		pieces: 1,
		where: n
	}, i = await ci(ve(e.slice().buffer, n), r, t), a = i[0].picture;
	if ("data" in a) return a;
	let o = Ut(a, t);
	return Gs(i), Wt(o, 4 * t[0], 4, t);
}
var Kl = class {
	size;
	where;
	user;
	decoding = /* @__PURE__ */ new Set();
	turn = 0;
	constructor(e, t, n) {
		this.size = e, this.where = t, this.user = n;
	}
	open = 0;
	get busy() {
		return this.decoding.size > 0;
	}
	get ready() {
		return this.decoding.size === 0;
	}
	start() {
		return Promise.resolve();
	}
	decode(e, t, n) {
		if (!n) return;
		let { turn: r } = this, i = Gl(e, this.size, this.where).then((e) => r === this.turn ? this.user.take(t, () => Promise.resolve(e)) : void 0).catch((e) => {
			r === this.turn && this.user.failed(e);
		}).finally(() => {
			this.decoding.delete(i), this.user.closed();
		});
		this.decoding.add(i);
	}
	async flush() {
		await Promise.all(this.decoding);
	}
	reset() {
		this.turn += 1;
	}
	dispose() {
		this.reset();
	}
}, ql = 8, Jl = 2, Yl = 2 / 3, Xl = /* @__PURE__ */ new Set([
	"damaged",
	"truncated",
	"network"
]), Zl = class {
	timeline;
	groups;
	user;
	loop = !0;
	late = 0;
	previewsFrom = Infinity;
	decoders;
	keysAlone = null;
	meansAlone = !1;
	slots = /* @__PURE__ */ new Map();
	skipped = /* @__PURE__ */ new Set();
	rooms;
	shown = null;
	wanted = 0;
	from = 1;
	next = 0;
	given = null;
	fed = 0;
	tried = /* @__PURE__ */ new Set();
	broken = /* @__PURE__ */ new Set();
	newest = -1;
	turn = 0;
	feeding = !1;
	hopeless = !1;
	constructor(e, t, n) {
		this.timeline = e, this.groups = t, this.user = n, this.rooms = e.films.map(() => []), this.decoders = this.makeDecoders();
	}
	get open() {
		return this.decoders.reduce((e, t) => e + t.open, 0);
	}
	get reach() {
		return Math.max(this.newestEnd, this.from) + ql / 2;
	}
	get busy() {
		return this.decoders.some(({ busy: e }) => e);
	}
	get sparse() {
		return this.keysAlone !== null;
	}
	get plain() {
		return this.meansAlone;
	}
	follows(e) {
		return !this.meansAlone && this.from <= e + 1;
	}
	leaveOut() {
		this.meansAlone || this.keysAlone || this.timeline.films.every(({ detail: e }) => !e) || (this.meansAlone = !0, this.decoders.forEach((e, t) => this.needs(t) || e.reset()), this.user.ready(), this.feed());
	}
	isOver(e) {
		return this.newestEnd >= e && ![...this.slots.keys()].some((t) => t <= e);
	}
	standIn(e) {
		return this.keysAlone ? this.startOf(e) : e;
	}
	stepped(e, t) {
		if (!this.keysAlone) return e + t;
		let { groups: n, frames: r } = this.timeline, i = q(this.timeline, this.numberOf(e)) + t, a = Math.floor(i / n.length);
		return e - this.numberOf(e) + a * r + n[i - a * n.length].first;
	}
	seek(e) {
		if (this.broken.has(q(this.timeline, this.numberOf(e)))) return !1;
		let t = this.startOf(e), n = e >= this.from && this.slots.has(e) && ![...this.skipped].some((t) => t > e);
		(this.meansAlone || this.given === null || this.next <= t || e < this.next && !n) && (this.meansAlone = !1, this.stop(), this.next = t), this.wanted = this.from = e;
		for (let [t, n] of this.slots) t < e && this.forget(t, n);
		return this.feed(), !0;
	}
	retry() {
		this.hopeless && this.keysAlone && (this.keysAlone = null, this.decoders = this.makeDecoders()), this.hopeless = !1, this.next === Infinity && this.seek(this.from);
	}
	take(e) {
		this.next === Infinity && !this.hopeless && !this.seek(this.from) && this.pass(q(this.timeline, this.numberOf(this.from)), this.from), this.wanted = e;
		let t = [...this.slots].filter(([t, { films: n }]) => t <= e && this.isWhole(n)), n = Math.max(...t.map(([e]) => e)), r = this.slots.get(n);
		if (!r) return this.feed(), null;
		for (let [e, t] of this.slots) e >= n || (e >= this.from && (this.late += 1), this.forget(e, t));
		this.slots.delete(n);
		for (let e of this.skipped) e < n && this.skipped.delete(e);
		return this.reuse(this.shown?.films ?? []), this.from = Math.max(this.from, n + 1), this.shown = {
			position: n,
			number: this.numberOf(n),
			...r
		}, this.feed(), this.shown;
	}
	feed() {
		if (this.feeding) return;
		this.feeding = !0;
		let { turn: e } = this;
		this.feedAll().catch((t) => {
			e === this.turn && this.fail(t);
		}).finally(() => {
			this.feeding = !1, e !== this.turn && this.feed();
		});
	}
	dispose() {
		this.rest(), this.hopeless = !0;
		for (let e of this.decoders) e.dispose();
	}
	numberOf(e) {
		return e % this.timeline.frames;
	}
	startOf(e) {
		let t = this.numberOf(e);
		return e - t + this.timeline.groups[q(this.timeline, t)].first;
	}
	get newestEnd() {
		if (!this.keysAlone || this.newest < 0) return this.newest;
		let e = this.timeline.groups[q(this.timeline, this.numberOf(this.newest))];
		return this.startOf(this.newest) + e.frames - 1;
	}
	makeDecoders() {
		return this.timeline.films.map(({ codec: e, size: t, where: n }, r) => e.decode(t, n, this.userOf(r)));
	}
	userOf(e) {
		let { opacity: t } = this.timeline.films[e];
		return {
			take: (n, r) => this.receive(e, n, (e) => r(e, t)),
			closed: () => this.feed(),
			failed: (e) => this.fail(e),
			lost: () => this.rest()
		};
	}
	needs(e) {
		return !this.meansAlone || !this.timeline.films[e].detail;
	}
	isWhole(e) {
		return e.every((e, t) => e !== null || !this.needs(t));
	}
	get hasRoom() {
		let { frames: e } = this.timeline, t = this.loop ? Infinity : e * (Math.floor(this.wanted / e) + 1), n = this.keysAlone ? this.slots.size < Jl ? Infinity : 0 : Math.max(this.from, this.wanted) + ql;
		return this.next < Math.min(n, t) && this.decoders.every(({ ready: e }, t) => e || !this.needs(t));
	}
	async feedAll() {
		for (; this.hasRoom;) {
			let [{ turn: e }, t, n] = [
				this,
				this.next,
				this.numberOf(this.next)
			], r = q(this.timeline, n);
			if (this.broken.has(r)) {
				this.pass(r, t);
				continue;
			}
			this.fed = r;
			let i = this.given?.index === r ? this.given : await this.groups.open(r), a = n - i.first, o = i.units[a] ?? [];
			a >= i.frames * Yl && this.prepare((r + 1) % this.timeline.groups.length), i.motion?.read(a);
			let s = () => this.decoders.map((e, t) => [e, o[t]]).filter((e, t) => this.needs(t));
			if (a === 0 && await Promise.all(s().map(([e, t]) => e.start(t))), e !== this.turn) return;
			this.given = i, this.next = this.keysAlone ? t + i.frames : t + 1;
			for (let [e, n] of s()) e.decode(n, t, a === 0);
			if (a === i.frames - 1 && await Promise.all(this.decoders.map((e) => e.flush())), e !== this.turn) return;
		}
	}
	prepare(e) {
		(e || this.loop) && !this.broken.has(e) && this.groups.open(e).catch(() => void 0);
	}
	async receive(e, t, n) {
		let [{ turn: r }, i] = [this, this.slotOf(t)];
		if (!i) return;
		let a = await n(this.rooms[e]?.pop());
		if (r !== this.turn || this.slots.get(t) !== i) return this.reuseOne(e, a);
		i.films[e] = a, this.isWhole(i.films) && this.user.ready();
	}
	slotOf(e) {
		let t = this.slots.get(e);
		if (t || this.skipped.has(e)) return t ?? null;
		this.newest = Math.max(this.newest, e);
		let n = e < this.from;
		if (!this.given || n && performance.now() < this.previewsFrom) return null;
		if (!n && e < this.wanted && this.slots.size > 0) return this.late += 1, this.skipped.add(e), null;
		let r = {
			group: this.given,
			films: this.decoders.map(() => null)
		};
		return this.slots.set(e, r), r;
	}
	fail(e) {
		let t = e instanceof j && e.code === "codec" ? e : null;
		if (t && !this.keysAlone) return this.thin(t);
		if (!(e instanceof j) || !Xl.has(e.code)) return this.rest(), this.hopeless = !0, this.user.failed(t ? this.keysAlone : e, null);
		let n = e.code === "damaged" && this.given?.index === this.fed && !this.tried.has(this.fed), r = this.startOf(Math.max(this.next - 1, 0));
		this.halt();
		for (let [e, t] of this.slots) this.isWhole(t.films) || this.forget(e, t);
		n ? (this.tried.add(this.fed), this.next = r) : (this.broken.add(this.fed), this.user.failed(e, this.fed)), this.feed();
	}
	thin(e) {
		for (let e of this.decoders) e.dispose();
		this.keysAlone = e, this.meansAlone = !1, this.decoders = this.timeline.films.map(({ size: e, where: t }, n) => new Kl(e, t, this.userOf(n))), this.stop(), this.next = this.startOf(this.from), this.user.thinned(), this.feed();
	}
	rest() {
		this.stop(), this.next = Infinity;
	}
	pass(e, t) {
		let { first: n, frames: r } = this.timeline.groups[e];
		this.next = t - this.numberOf(t) + n + r, this.newest = this.next - 1;
	}
	stop() {
		this.halt(), this.newest = -1;
		for (let [e, t] of this.slots) this.forget(e, t);
	}
	halt() {
		this.turn += 1, this.given = null, this.skipped.clear();
		for (let e of this.decoders) e.reset();
	}
	forget(e, { films: t }) {
		this.slots.delete(e), this.reuse(t);
	}
	reuse(e) {
		e.forEach((e, t) => e && this.reuseOne(t, e));
	}
	reuseOne(e, { room: t }) {
		t && this.rooms[e]?.push(t);
	}
}, Ql = .3, $l = .2, eu = 2, tu = class {
	place;
	read;
	changed;
	audio = null;
	loading = !1;
	starting = !1;
	silent = !1;
	mute = !1;
	disposed = !1;
	constructor(e, t, n) {
		this.place = e, this.read = t, this.changed = n;
	}
	get playable() {
		return !this.silent;
	}
	get muted() {
		return this.mute;
	}
	set muted(e) {
		this.mute = e, this.audio && (this.audio.muted = e), this.changed();
	}
	get time() {
		return this.audio && !this.audio.paused ? this.audio.currentTime + this.place.first : null;
	}
	follow(e, t) {
		let { audio: n } = this;
		if (!n) return this.load();
		let r = e - this.place.first;
		if (r < 0 || r >= n.duration) return n.pause();
		let i = r - n.currentTime;
		Math.abs(i) > Ql * Math.max(t, 1) ? n.seeking || (n.currentTime = r) : n.playbackRate = t * (1 + Math.min(Math.max(eu * i, -.2), $l)), n.paused && !this.starting && this.start(n);
	}
	rest() {
		this.audio?.pause();
	}
	dispose() {
		this.disposed = !0, this.rest(), this.audio && URL.revokeObjectURL(this.audio.src);
	}
	load() {
		this.loading || this.silent || (this.loading = !0, this.read().then((e) => {
			if (this.disposed) return;
			let t = new Audio(URL.createObjectURL(new Blob([e], { type: this.place.mimeType })));
			t.muted = this.mute, t.addEventListener("loadedmetadata", () => this.audio = t), t.addEventListener("error", () => this.fail());
		}).catch(() => this.fail()));
	}
	start(e) {
		this.starting = !0, e.play().catch((e) => {
			e instanceof DOMException && e.name === "NotAllowedError" && !this.mute && (this.muted = !0);
		}).finally(() => this.starting = !1);
	}
	fail() {
		this.silent = !0, this.audio = null, this.changed();
	}
};
// eigenfield-three/src/clip.ts
async function nu(e, t, n, r) {
	let i = new dc(e, t, n, r), a = await i.begin();
	a.motion?.read(0), fc(e, a);
	let o = await Promise.all(t.films.map(({ size: e, where: t }, n) => Gl(a.units[0][n], e, t))), { sound: s } = t;
	return {
		timeline: t,
		group: a,
		films: o,
		mesh: n,
		ring: (e) => new Zl(t, i, e),
		sound: s && ((e) => new tu(s, () => r(s, s.length), e))
	};
}
// eigenfield-three/src/means.ts
async function ru(e, t) {
	let { mean: n, meanSize: r } = e, i = e.precision && await iu(await t(e.precision.view), e.precision);
	return {
		pieces: await n.codec.decode(await t(n.view), n, r),
		precision: i
	};
}
async function iu(e, t) {
	let { type: n } = Yr(e) ?? {}, { mimeType: r } = t.codec;
	if (n && n !== r) throw M(t.where, `${n}, not ${r}`);
	let [i] = await t.codec.bitmaps(e, t, t.size);
	if (!i) throw M(t.where, "no picture");
	return i.picture;
}
function au({ pieces: e, precision: t }) {
	Gs(e), t?.close();
}
// eigenfield-three/src/packed.ts
var ou = "\"names\":[\"texts\":[\"heldOut\":[1,2,\"lenses\":[null,\"harmonise\":\"gain\",\"affine\",\"align\":true,\"residual\":{\"quality\":40},\"metresPerUnit\":0.\"sharedPicture\",\"times\",\"codec\":\"codedNames\":{\"bufferView\":10,\"count\":20},\"sizes\":3,\"colour\":4,\"times\":[0,\"residual\":{\"size\":[512,512],\"scale\":[0.00,0.00],\"full\":true,\"smooth\":true,\"order\":3,\"holdOut\":\"odd\",\"every:\"scores\":{\"psnr\":{\"mean\":\"ssim\":{\"mean\":\"captured\":\"heldOut\":{\"needs\":[\"av1-10bit-2\",\"cameras-2\",\"codedNames\",\"codedTriangles\",\"codedWeights\",\"mesh-2\",\"namePattern\",\"precision\",\"regions\",\"stacks\",\"toRGB\"],\"mesh\":{\"bufferView\":5,\"codec\":\"mesh-2\"},\"planes\":[{\"channels\":1,\"mean\":{\"bufferView\":6,\"size\":[1024,768],\"mimeType\":\"video/AV1\",\"bits\":10,\"scale\":[0.0009775171065493646],\"zero\":[0],\"precision\":{\"bufferView\":7,\"size\":[13,12]}},\"bases\":[{\"size\":[480,480],\"codedWeights\":8,\"textures\":[{\"bufferView\":11,\"mimeType\":\"video/AV1\",\"bits\":10,\"count\":2,\"scale\":[0.0001],\"zero\":[341]}]},{\"size\":[64,464],\"grid\":[464,464],\"corner\":[0,0],\"codedWeights\":9,\"picture\":{\"mimeType\":\"video/AV1\",\"bits\":10,\"count\":8,\"scale\":[0.0002],\"zero\":[341]},\"textures\":[{\"bufferView\":12},{\"bufferView\":13}]}]},{\"channels\":2,\"mean\":{\"bufferView\":9,\"size\":[512,384],\"mimeType\":\"video/AV1\",\"bits\":10,\"scale\":[0.0004,0.0004],\"zero\":[341,341],\"precision\":{\"bufferView\":7,\"size\":[13,12]}},\"bases\":[]}],\"toRGB\":[1,-0.027444022,-0.9585462,1,-0.092323445,0.284937,1,0.9953508,0],\"cameras\":{\"pattern\":{\"counts\":[81,1],\"parts\":[\"image_\",{\"axis\":0,\"first\":0,\"step\":1,\"digits\":3},\".png\",\".jpg\",\".webp\"]},\"size\":[640,480],\"coded\":{\"bufferView\":4,\"codec\":\"cameras-2\"}},\"viewPlane\":{\"origin\":[0,0,0],\"right\":[1,0,0],\"up\":[0,-1,0],\"extent\":[0.5,0.5],\"codedTriangles\":10},\"reference\":40,\"settings\":{\"textures\":2,\"atlas\":[1024,768],\"density\":1.3,\"fit\":\"photographs\",\"fitted\":{\"quality\":78,\"psnr\":{\"luma\":{\"uncoded\":50.0,\"coded\":40.0},\"chroma\":{\"uncoded\":50.0,\"coded\":40.0}}},\"photographs\":{\"count\":81,\"bytes\":10000000,\"pixels\":10000000}},\"generator\":\"eigenfield 0.1.0\",\"lengths\":[", su = 4;
async function cu(e, t) {
	let n = new G(e, ""), r = n.key("extensions").key(xe), i = r.key("packed");
	if (!i.exists) return e;
	ja(r);
	let a = Oi(n), o = a[i.integer(a.length - 1, a.length - 1)];
	if (!o || o.length < su) throw i.wrong("no length");
	let s = new DataView(await t(o.offset, su)).getUint32(0, !0);
	if (su + s > o.length) throw i.wrong(`JSON of ${s} bytes`);
	let { lengths: c, ...l } = new G(oc(await uu(await t(o.offset + su, s), i.where), i.where), i.where).object(), u = lu(new G(c, `${i.where}/lengths`), o, su + s), { packed: d, ...f } = r.object();
	return {
		...e,
		bufferViews: [...n.key("bufferViews").items(I).slice(0, -1).map(({ raw: e }) => e ?? null), ...u],
		extensions: {
			...n.key("extensions").object(),
			[xe]: {
				...f,
				...l
			}
		}
	};
}
function lu(e, t, n) {
	let r = n, i = e.items(I).map((e) => {
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
async function uu(e, t) {
	let n = new TextEncoder().encode(ou), [r, i] = [n.length & 255, n.length >> 8], a = new Uint8Array(5 + n.length + e.byteLength);
	a.set([
		0,
		r,
		i,
		~r,
		~i
	]), a.set(n, 5), a.set(new Uint8Array(e), 5 + n.length);
	let o = await be(a, "deflate-raw", n.length + Se, t);
	try {
		return new TextDecoder("utf-8", {
			fatal: !0,
			ignoreBOM: !0
		}).decode(o.subarray(n.length));
	} catch {
		throw M(t, "its JSON is not UTF-8");
	}
}
// eigenfield-three/src/still-textures.ts
var du = 3;
function fu(e) {
	return J(e).flatMap((e, t) => {
		let n = 0;
		return e.pictures.map((r) => {
			let i = n;
			return n += r.textures, {
				basis: e,
				number: t,
				picture: r,
				first: i
			};
		});
	}).sort((e, t) => e.first - t.first || e.number - t.number);
}
function pu(e, t, n) {
	let r = fu(e), i = n, a = ({ basis: e, picture: n }) => {
		let r = t(n.view).then((t) => n.codec.decode(t, n, e.size));
		return r.catch(() => void 0), r;
	};
	return {
		async fill(n) {
			let { plan: o, signal: s } = n, c = i ?? await Promise.all(Aa(e).map((e) => ru(e, t)));
			i = null, c.forEach((e, t) => {
				n.putMean(t, e), au(e);
			});
			let l = r.filter(({ first: e }) => e < o.usable), u = [], d = 0;
			try {
				for (let { number: e, first: t, picture: r } of l) {
					if (s.aborted) return;
					for (let e of l.slice(d, d + du - u.length)) u.push(a(e)), d += 1;
					let i = await u[0] ?? [];
					u.shift(), n.putTextures(e, t, i, r), Gs(i), n.announce();
				}
			} finally {
				for (let e of u) e.then(Gs).catch(() => void 0);
			}
			n.end();
		},
		gain(n) {
			let r = 0;
			for (let { channels: i, bases: a } of e.planes) {
				let o = e.colours.slice(r, r += i), s = a.find(({ count: e }) => e > n);
				if (s) return Js(s, n, o, t);
			}
			return Promise.resolve(1);
		},
		dispose() {
			i?.forEach(au), i = null;
		}
	};
}
// eigenfield-three/src/grid.ts
function mu(e) {
	let t = e.length / 2;
	for (let n = 1; n * n <= t; n++) {
		if (t % n) continue;
		let r = t / n, i = hu(e, n, r) ?? (n === r ? null : hu(e, r, n));
		if (i) return i;
	}
	return null;
}
function hu(e, t, n) {
	let [r, i] = [_u(e, 0), _u(e, 1)];
	if (t === 1 && vu(i) > 0 || n === 1 && vu(r) > 0) return null;
	let a = Array.from(r, (e, t) => t).sort((e, t) => yu(i, e) - yu(i, t));
	for (let e = 0; e < t; e++) {
		let t = a.slice(e * n, (e + 1) * n).sort((e, t) => yu(r, e) - yu(r, t));
		a.splice(e * n, n, ...t);
	}
	let o = (e, t) => a[e * n + t] ?? 0;
	return gu(n, t, (e, t) => yu(r, o(t, e))) && gu(t, n, (e, t) => yu(i, o(e, t))) ? {
		rows: t,
		columns: n,
		index: Int32Array.from(a)
	} : null;
}
function gu(e, t, n) {
	let r = Infinity, i = 0, a = NaN;
	for (let o = 0; o < e; o++) {
		let e = 0;
		for (let r = 0; r < t; r++) e += n(o, r) / t;
		for (let r = 0; r < t; r++) i = Math.max(i, Math.abs(n(o, r) - e));
		o && (r = Math.min(r, e - a)), a = e;
	}
	return r > 0 && (r === Infinity || i <= r / 4);
}
function _u(e, t) {
	return Float64Array.from({ length: e.length / 2 }, (n, r) => e[2 * r + t] ?? 0);
}
function vu(e) {
	return e.reduce((e, t) => Math.max(e, t), -Infinity) - e.reduce((e, t) => Math.min(e, t), Infinity);
}
var yu = (e, t) => e[t] ?? 0, bu = 1e-6, xu = 32, Su = class {
	places;
	triangles;
	isLine;
	grid;
	rules = /* @__PURE__ */ new Map();
	constructor(e, t, n) {
		this.places = e, this.triangles = t, this.isLine = n, this.grid = mu(e);
	}
	at(e, t, n) {
		let r = n === "bilinear" && !this.grid ? "delaunay" : n, i = this.rules.get(r);
		return i || this.rules.set(r, i = this.makeRule(r)), i(Cu(e), this.isLine ? 0 : Cu(t));
	}
	makeRule(e) {
		return e === "nearest3" ? (e, t) => Nu(e, t, this.places) : e === "bilinear" && this.grid ? Fu(this.places, this.grid) : Eu(this.places, this.triangles);
	}
};
function Cu(e) {
	return Math.min(1, Math.max(-1, e));
}
function wu(e) {
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
function Tu(e, t, n, r, i, a) {
	let [o, s] = [Z(n, r), Q(n, r)], [c, l] = [Z(n, i) - o, Q(n, i) - s], [u, d] = [Z(n, a) - o, Q(n, a) - s], f = c * d - l * u, p = ((e - o) * d - (t - s) * u) / f, m = (c * (t - s) - l * (e - o)) / f;
	return [
		1 - p - m,
		p,
		m
	];
}
function Eu(e, t) {
	if (!t.length) {
		let t = Mu(e, ju(e));
		return (n, r) => Au(n, r, e, t);
	}
	let n = Ou(e, t, 3), r = ku(t);
	return (i, a) => {
		let o = -1, s = -Infinity, c = [
			0,
			0,
			0
		];
		for (let r of n[$(a) * xu + $(i)] ?? []) {
			let [n, l, u] = [
				Du(t, r, 0),
				Du(t, r, 1),
				Du(t, r, 2)
			], d = Tu(i, a, e, n, l, u), f = Math.min(...d);
			f > s && ([o, s, c] = [
				r,
				f,
				d
			]);
		}
		return s < -1e-9 ? Au(i, a, e, r) : wu(c.map((e, n) => [Du(t, o, n), e]));
	};
}
var Du = (e, t, n) => e[3 * t + n] ?? 0;
function $(e) {
	return Math.min(31, Math.max(0, Math.floor((e + 1) / 2 * xu)));
}
function Ou(e, t, n) {
	let r = Array.from({ length: 1024 }, () => []);
	for (let i = 0; i < t.length / n; i++) {
		let a = Array.from({ length: n }, (e, r) => t[n * i + r] ?? 0), o = a.map((t) => Z(e, t)), s = a.map((t) => Q(e, t));
		for (let e = $(Math.min(...s)); e <= $(Math.max(...s)); e++) for (let t = $(Math.min(...o)); t <= $(Math.max(...o)); t++) r[e * xu + t]?.push(i);
	}
	return r;
}
function ku(e) {
	let t = /* @__PURE__ */ new Map();
	for (let n = 0; n < e.length / 3; n++) for (let r = 0; r < 3; r++) {
		let [i, a] = [Du(e, n, r), Du(e, n, (r + 1) % 3)], o = i < a ? [i, a] : [a, i], s = t.get(o.join());
		s ? s.times += 1 : t.set(o.join(), {
			edge: o,
			times: 1
		});
	}
	let n = [...t.values()].filter((e) => e.times === 1).map((e) => e.edge);
	return n.sort((e, t) => e[0] - t[0] || e[1] - t[1]), Int32Array.from(n.flat());
}
function Au(e, t, n, r) {
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
	return wu([[o, 1 - c], [s, c]]);
}
function ju(e) {
	return Array.from({ length: e.length / 2 }, (e, t) => t);
}
function Mu(e, t) {
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
function Nu(e, t, n) {
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
	if (a < 0 || Pu(n, r, i, a) <= bu) return Au(e, t, n, Mu(n, [
		r,
		i,
		a
	].filter((e) => e >= 0)));
	let [l, u, d] = Tu(e, t, n, r, i, a);
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
function Pu(e, t, n, r) {
	let [i, a] = [Z(e, n) - Z(e, t), Q(e, n) - Q(e, t)], [o, s] = [Z(e, r) - Z(e, t), Q(e, r) - Q(e, t)], c = Math.max(i * i + a * a, o * o + s * s, (i - o) ** 2 + (a - s) ** 2);
	return c > 0 ? Math.abs(i * s - a * o) / c : 0;
}
function Fu(e, t) {
	let { rows: n, columns: r, index: i } = t;
	if (Math.min(n, r) === 1) {
		let t = Mu(e, ju(e));
		return (n, r) => Au(n, r, e, t);
	}
	let a = (e, t) => i[e * r + t] ?? 0, o = [];
	for (let e = 0; e + 1 < n; e++) for (let t = 0; t + 1 < r; t++) o.push([
		a(e, t),
		a(e, t + 1),
		a(e + 1, t + 1),
		a(e + 1, t)
	]);
	let s = Ou(e, o.flat(), 4), c = [];
	for (let e = 0; e < r; e++) c.push(a(0, e));
	for (let e = 1; e < n; e++) c.push(a(e, r - 1));
	for (let e = r - 2; e >= 0; e--) c.push(a(n - 1, e));
	for (let e = n - 2; e >= 0; e--) c.push(a(e, 0));
	let l = Int32Array.from(c.slice(1).flatMap((e, t) => [c[t] ?? 0, e]));
	return (t, n) => {
		let r = null, i = -Infinity;
		for (let a of s[$(n) * xu + $(t)] ?? []) {
			let s = o[a], c = s ? Iu(t, n, e, s) : -Infinity;
			s && c > i && ([r, i] = [s, c]);
		}
		if (!r || i < -1e-9) return Au(t, n, e, l);
		let [a, c] = Lu(t, n, e, r);
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
function Iu(e, t, n, r) {
	let i = Infinity;
	for (let a = 0; a < 4; a++) {
		let [o, s] = [r[a], r[(a + 1) % 4]], [c, l] = [Z(n, o), Q(n, o)];
		i = Math.min(i, (Z(n, s) - c) * (t - l) - (Q(n, s) - l) * (e - c));
	}
	return i;
}
function Lu(e, t, n, r) {
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
	], [v, y] = [i - o + c - u, a - s + l - d], b = f * h - p * m, x = f * y - p * v - (g * h - _ * m), S = -(g * y - _ * v), C = Math.sqrt(Math.max(x * x - 4 * b * S, 0)), w = Ru(-2 * b / (x + (x < 0 ? -C : C))), [T, E] = [m + w * v, h + w * y];
	return [Ru(((f - w * g) * T + (p - w * _) * E) / (T * T + E * E)), w];
}
function Ru(e) {
	return Math.min(1, Math.max(0, e));
}
// eigenfield-three/src/plugin.ts
var zu = class {
	parser;
	options;
	name = xe;
	scene = null;
	views = [];
	lacks = null;
	ours;
	constructor(e, t = {}) {
		this.parser = e, this.options = t, this.ours = Da(e.json);
	}
	async beforeRoot() {
		if (!this.ours) return;
		this.options.renderer && il(this.options.renderer);
		let { json: e } = this.parser;
		me(e), Object.assign(e, await cu(e, (e, t) => this.read(e, t)));
		let t = Oa(e), { stream: n } = this.options, r = t.timeline?.groups[0]?.file ? n?.readFile : n?.readGroups;
		(!t.timeline || r) && (this.views = t.views, t.timeline && t.shown && !await ai("image/avif") ? this.lacks = new j("codec", "This browser decodes no AV1; use a newer browser. The first frame is shown.", "") : (this.scene = t, this.scene.shown || Bu(e)));
	}
	async read(e, t) {
		if (this.options.stream) return this.options.stream.read(e, t);
		let n = (await this.parser.getDependency("buffer", 0)).slice(e, e + t);
		if (n.byteLength < t) throw ue("/buffers/0");
		return n;
	}
	loadMaterial(e) {
		let t = this.scene && this.parser.json.meshes[0].primitives[0];
		if (!t || t.material !== e) return null;
		let { doubleSided: n } = this.parser.json.materials?.[e] ?? {}, r = new C();
		return r.side = n === !0 ? 2 : 0, Promise.resolve(r);
	}
	loadBufferView(e) {
		let t = this.views[e];
		return t && this.options.stream ? this.options.stream.read(t.offset, t.length) : null;
	}
	async afterRoot(e) {
		let { scene: t } = this;
		if (this.lacks && (e.userData.eigenfieldError = this.lacks), !t) return;
		let n = Vu(e, this.parser), [r] = n;
		if (!r) throw M("/meshes/0", "no node shows it");
		t.shown && Hc(r.geometry, t.shown);
		let i = async (e) => {
			let n = await this.parser.getDependency("bufferView", e);
			if (n.byteLength < (t.views[e]?.length ?? 0)) throw ue(`/bufferViews/${e}`);
			return n;
		}, a = t.mesh && await Uc(t.mesh, i), o = t.timeline && a && await this.openClip(t, t.timeline, a);
		if (a) {
			let e = Wc(a);
			r.geometry.dispose();
			for (let t of n) t.geometry = e;
		}
		t.sheets && sa(t.sheets, r.geometry);
		let [s, c, l, u] = await Promise.all([
			Promise.all(o ? [] : Aa(t).map((e) => ru(e, i))),
			Ga(t, i),
			o ? o.group.omega : $a(t, i),
			ao(t, i)
		]), d = c.filter((e, n) => !t.heldOut[n]), f = new Su(Float64Array.from(d.flatMap((e) => lo(t, e.centre))), u, t.extent[1] === 0), p = o ? Aa(t).map(({ meanSize: e }) => e ?? [1, 1]) : s.map(({ pieces: [e] }) => [e?.picture.width ?? 1, e?.rows ?? 1]), m = {
			scene: t,
			info: so(t, c, p, f.grid, this.fileBytes(), Gc(r.geometry)),
			meshes: n,
			meanSizes: p,
			omega: l,
			weights: f,
			clip: o
		}, h = o ? new Xs(t, o.films) : pu(t, i, s);
		e.userData.eigenfield = new Dl(m, h, this.options);
	}
	openClip(e, t, n) {
		let r = this.options.stream;
		return nu(e, t, n, ({ offset: e, length: t, file: n }, i) => n === null ? r.readGroups(e, i) : r.readFile(n, t, i));
	}
	fileBytes() {
		let { groups: e = [], sound: t = null } = this.scene?.timeline ?? {}, n = [...e, ...t ? [t] : []].reduce((e, t) => e + (t.file ? t.length : 0), 0);
		if (this.options.stream) return this.options.stream.total + n;
		let { extensions: r, json: i } = this.parser;
		return r.KHR_binary_glTF?.header?.length ?? i.buffers[0]?.byteLength ?? 0;
	}
};
function Bu(e) {
	let [t] = e.nodes;
	t && (t.mesh = 0), e.meshes = [{ primitives: [{
		attributes: {},
		material: 0
	}] }], e.materials = [{ doubleSided: !0 }];
}
function Vu(e, t) {
	let n = [];
	return e.scene.traverse((e) => {
		let r = t.associations.get(e);
		Hu(e) && r?.meshes === 0 && (r.primitives ?? 0) === 0 && n.push(e);
	}), n;
}
function Hu(e) {
	return e.isMesh === !0;
}
// eigenfield-three/src/load.ts
async function Uu(e, t = {}) {
	let { signal: n } = t, r = Wu(e);
	n?.throwIfAborted();
	let i = new Ml(), [a, o] = [new AbortController(), new AbortController()], s = () => {
		i.fail(new DOMException("The load was stopped.", "AbortError")), a.abort();
	};
	n?.addEventListener("abort", s), a.signal.addEventListener("abort", () => o.abort());
	let c = Ju(r, i, o.signal, t.onBytes).catch((e) => i.fail(e)).finally(() => n?.removeEventListener("abort", s));
	try {
		let e = await rc(i);
		if (!Da(e.json)) return {
			gltf: await qu(i, e, c),
			field: null,
			error: null
		};
		let s = r instanceof Uint8Array ? i : ((t) => new Rl(t, i, e.length, () => o.abort(), a.signal))(r), l = t.files ? Vl(t.files) : null, u = await Gu(i, e, s, typeof r == "string" ? new Hl(r, a.signal) : l, t), { eigenfield: d, eigenfieldError: f } = u.userData, p = d instanceof Dl ? d : null;
		return n?.aborted && p?.dispose(), n?.throwIfAborted(), {
			gltf: u,
			field: p,
			error: f instanceof j ? f : null
		};
	} catch (e) {
		throw a.abort(), n?.throwIfAborted(), de(e);
	}
}
function Wu(e) {
	if (typeof e == "string") return e;
	if (ArrayBuffer.isView(e)) return new Uint8Array(e.buffer, e.byteOffset, e.byteLength);
	let t = Object.prototype.toString.call(e).slice(8, -1);
	if (t === "URL") return String(e);
	if (t === "Blob" || t === "File") return e;
	if (t === "ArrayBuffer") return new Uint8Array(e);
	throw TypeError("A scene is loaded from an address, a Blob or an ArrayBuffer.");
}
async function Gu(e, t, n, r, i) {
	let a = new ce(), o = (e, t = n) => async (n, r) => {
		let i = await e + n;
		return t.read(i, i + r);
	}, s = t.binary();
	s.catch(() => void 0);
	let c = {
		total: t.length,
		read: o(s, e),
		readGroups: (...e) => o(t.groups())(...e),
		readFile: (...e) => r?.read(...e) ?? Promise.reject(Ku(e[0]))
	};
	return a.register((e) => new zu(e, {
		...i,
		stream: c
	})), a.parseAsync(t.text, "");
}
function Ku(e) {
	return new j("unsupported", `The clip is a folder, and its file ${e} cannot be found from here; make one file of it, with \`eigenfield export\`.`, e);
}
async function qu(e, t, n) {
	await n;
	let r = await e.read(0, t.length);
	try {
		let e = new ce();
		return e.register(pe), await e.parseAsync(r, "");
	} catch (e) {
		if (e instanceof j) throw e;
		let t = de(e).message;
		throw new j("unsupported", `${t} It has no eigen textures either.`, "", { cause: e });
	}
}
async function Ju(e, t, n, r) {
	if (e instanceof Uint8Array) return t.push(e), r?.(e.length, e.length), t.end();
	let { body: i, total: a } = typeof e == "string" ? await Xu(e, n) : Yu(e), o = i.getReader();
	for (n.addEventListener("abort", () => void o.cancel().catch(() => void 0));;) {
		let { done: e, value: i } = await o.read().catch((e) => {
			throw n.aborted ? e : Zu(t.received, e);
		});
		if (e) break;
		t.push(i), r?.(t.received, a);
	}
	n.throwIfAborted(), t.end();
}
function Yu(e) {
	return {
		body: e.stream(),
		total: e.size
	};
}
async function Xu(e, t) {
	let n = await fetch(e, { signal: t }).catch((n) => {
		throw t.aborted ? n : new j("network", "The scene cannot be fetched; check its address and the connection.", e, { cause: n });
	});
	if (!n.ok || !n.body) throw await n.body?.cancel(), new j("network", `The server answered ${n.status} for the scene; check its address.`, e);
	let r = n.headers.get("Content-Encoding") ? null : n.headers.get("Content-Length");
	return {
		body: n.body,
		total: r && /^\d+$/.test(r) ? Number(r) : void 0
	};
}
function Zu(e, t) {
	return new j("network", `The connection broke after ${e} bytes of the scene; load it again.`, String(e), { cause: t });
}
export { Dl as EigenField, zu as EigenfieldPlugin, zc as Player, Xc as SHEETS, j as SceneError, Mo as defaultMemory, Uu as loadEigenfield, po as novelCamera, _o as placeCamera, pe as refuseAddresses };
