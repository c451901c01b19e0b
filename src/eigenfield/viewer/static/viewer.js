/**
* @license
* Copyright 2010-2026 Three.js Authors
* SPDX-License-Identifier: MIT
*/
var e=1e3,t=1001,n=1002,r=1003,i=1004,a=1005,o=1006,s=1007,c=1008,l=1009,u=1012,d=1014,f=1015,p=1016,m=1017,h=1018,g=1020,_=1023,v=1026,y=1027,b=1028,x=1029,S=1030,C=1031,w=1033,T=2300,E=2301,D=2302,O=2303,k=2400,A=2401,j=2402,M=`srgb`,N=`srgb-linear`,P=`linear`,ee=`srgb`,te=7680,F=7682,ne=35044,I=`300 es`,re=2e3;function ie(e){for(let t=e.length-1;t>=0;--t)if(e[t]>=65535)return!0;return!1}function ae(e){return ArrayBuffer.isView(e)&&!(e instanceof DataView)}function oe(e){return document.createElementNS(`http://www.w3.org/1999/xhtml`,e)}function se(){let e=oe(`canvas`);return e.style.display=`block`,e}var ce={};function le(...e){let t=`THREE.`+e.shift();console.log(t,...e)}function ue(e){let t=e[0];if(typeof t==`string`&&t.startsWith(`TSL:`)){let t=e[1];t&&t.isStackTrace?e[0]+=` `+t.getLocation():e[1]=`Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.`}return e}function L(...e){e=ue(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.warn(n.getError(t)):console.warn(t,...e)}}function R(...e){e=ue(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.error(n.getError(t)):console.error(t,...e)}}function de(...e){let t=e.join(` `);t in ce||(ce[t]=!0,L(...e))}function fe(e,t,n){return new Promise(function(r,i){function a(){switch(e.clientWaitSync(t,e.SYNC_FLUSH_COMMANDS_BIT,0)){case e.WAIT_FAILED:i();break;case e.TIMEOUT_EXPIRED:setTimeout(a,n);break;default:r()}}setTimeout(a,n)})}var pe={0:0,2:6,4:4,3:5,1:1,6:2,7:7,5:3},me=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this._listeners;return n!==void 0&&n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this._listeners;if(n===void 0)return;let r=n[e];if(r!==void 0){let e=r.indexOf(t);e!==-1&&r.splice(e,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let t=n.slice(0);for(let n=0,r=t.length;n<r;n++)t[n].call(this,e);e.target=null}}},he=`00.01.02.03.04.05.06.07.08.09.0a.0b.0c.0d.0e.0f.10.11.12.13.14.15.16.17.18.19.1a.1b.1c.1d.1e.1f.20.21.22.23.24.25.26.27.28.29.2a.2b.2c.2d.2e.2f.30.31.32.33.34.35.36.37.38.39.3a.3b.3c.3d.3e.3f.40.41.42.43.44.45.46.47.48.49.4a.4b.4c.4d.4e.4f.50.51.52.53.54.55.56.57.58.59.5a.5b.5c.5d.5e.5f.60.61.62.63.64.65.66.67.68.69.6a.6b.6c.6d.6e.6f.70.71.72.73.74.75.76.77.78.79.7a.7b.7c.7d.7e.7f.80.81.82.83.84.85.86.87.88.89.8a.8b.8c.8d.8e.8f.90.91.92.93.94.95.96.97.98.99.9a.9b.9c.9d.9e.9f.a0.a1.a2.a3.a4.a5.a6.a7.a8.a9.aa.ab.ac.ad.ae.af.b0.b1.b2.b3.b4.b5.b6.b7.b8.b9.ba.bb.bc.bd.be.bf.c0.c1.c2.c3.c4.c5.c6.c7.c8.c9.ca.cb.cc.cd.ce.cf.d0.d1.d2.d3.d4.d5.d6.d7.d8.d9.da.db.dc.dd.de.df.e0.e1.e2.e3.e4.e5.e6.e7.e8.e9.ea.eb.ec.ed.ee.ef.f0.f1.f2.f3.f4.f5.f6.f7.f8.f9.fa.fb.fc.fd.fe.ff`.split(`.`),ge=1234567,_e=Math.PI/180,ve=180/Math.PI;function ye(){let e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0,r=Math.random()*4294967295|0;return(he[e&255]+he[e>>8&255]+he[e>>16&255]+he[e>>24&255]+`-`+he[t&255]+he[t>>8&255]+`-`+he[t>>16&15|64]+he[t>>24&255]+`-`+he[n&63|128]+he[n>>8&255]+`-`+he[n>>16&255]+he[n>>24&255]+he[r&255]+he[r>>8&255]+he[r>>16&255]+he[r>>24&255]).toLowerCase()}function z(e,t,n){return Math.max(t,Math.min(n,e))}function be(e,t){return(e%t+t)%t}function xe(e,t,n,r,i){return r+(e-t)*(i-r)/(n-t)}function Se(e,t,n){return e===t?0:(n-e)/(t-e)}function Ce(e,t,n){return(1-n)*e+n*t}function we(e,t,n,r){return Ce(e,t,1-Math.exp(-n*r))}function Te(e,t=1){return t-Math.abs(be(e,t*2)-t)}function Ee(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*(3-2*e))}function De(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*e*(e*(e*6-15)+10))}function Oe(e,t){return e+Math.floor(Math.random()*(t-e+1))}function ke(e,t){return e+Math.random()*(t-e)}function Ae(e){return e*(.5-Math.random())}function je(e){e!==void 0&&(ge=e);let t=ge+=1831565813;return t=Math.imul(t^t>>>15,t|1),t^=t+Math.imul(t^t>>>7,t|61),((t^t>>>14)>>>0)/4294967296}function Me(e){return e*_e}function Ne(e){return e*ve}function Pe(e){return e>0&&Number.isInteger(e)&&2**Math.round(Math.log2(e))===e}function Fe(e){return 2**Math.ceil(Math.log(e)/Math.LN2)}function Ie(e){return 2**Math.floor(Math.log(e)/Math.LN2)}function B(e,t,n,r,i){let a=Math.cos,o=Math.sin,s=a(n/2),c=o(n/2),l=a((t+r)/2),u=o((t+r)/2),d=a((t-r)/2),f=o((t-r)/2),p=a((r-t)/2),m=o((r-t)/2);switch(i){case`XYX`:e.set(s*u,c*d,c*f,s*l);break;case`YZY`:e.set(c*f,s*u,c*d,s*l);break;case`ZXZ`:e.set(c*d,c*f,s*u,s*l);break;case`XZX`:e.set(s*u,c*m,c*p,s*l);break;case`YXY`:e.set(c*p,s*u,c*m,s*l);break;case`ZYZ`:e.set(c*m,c*p,s*u,s*l);break;default:L(`MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: `+i)}}function Le(e){switch(e.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function Re(e,t){if(t.constructor===Float32Array)return e;let n=Le(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.max(e/n,-1)}function ze(e,t){if(t.constructor===Float32Array)return e;let n=Le(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.round(e*n)}var V={DEG2RAD:_e,RAD2DEG:ve,generateUUID:ye,clamp:z,euclideanModulo:be,mapLinear:xe,inverseLerp:Se,lerp:Ce,damp:we,pingpong:Te,smoothstep:Ee,smootherstep:De,randInt:Oe,randFloat:ke,randFloatSpread:Ae,seededRandom:je,degToRad:Me,radToDeg:Ne,isPowerOfTwo:Pe,ceilPowerOfTwo:Fe,floorPowerOfTwo:Ie,setQuaternionFromProperEuler:B,normalize:ze,denormalize:Re},H=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw Error(`THREE.Vector2: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw Error(`THREE.Vector2: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6],this.y=r[1]*t+r[4]*n+r[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=z(this.x,e.x,t.x),this.y=z(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=z(this.x,e,t),this.y=z(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(z(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(z(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),r=Math.sin(t),i=this.x-e.x,a=this.y-e.y;return this.x=i*n-a*r+e.x,this.y=i*r+a*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},U=class{constructor(e=0,t=0,n=0,r=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=r}static slerpFlat(e,t,n,r,i,a,o){let s=n[r+0],c=n[r+1],l=n[r+2],u=n[r+3],d=i[a+0],f=i[a+1],p=i[a+2],m=i[a+3];if(u!==m||s!==d||c!==f||l!==p){let e=s*d+c*f+l*p+u*m;e<0&&(d=-d,f=-f,p=-p,m=-m,e=-e);let t=1-o;if(e<.9995){let n=Math.acos(e),r=Math.sin(n);t=Math.sin(t*n)/r,o=Math.sin(o*n)/r,s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o}else{s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o;let e=1/Math.sqrt(s*s+c*c+l*l+u*u);s*=e,c*=e,l*=e,u*=e}}e[t]=s,e[t+1]=c,e[t+2]=l,e[t+3]=u}static multiplyQuaternionsFlat(e,t,n,r,i,a){let o=n[r],s=n[r+1],c=n[r+2],l=n[r+3],u=i[a],d=i[a+1],f=i[a+2],p=i[a+3];return e[t]=o*p+l*u+s*f-c*d,e[t+1]=s*p+l*d+c*u-o*f,e[t+2]=c*p+l*f+o*d-s*u,e[t+3]=l*p-o*u-s*d-c*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,r){return this._x=e,this._y=t,this._z=n,this._w=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let n=e._x,r=e._y,i=e._z,a=e._order,o=Math.cos,s=Math.sin,c=o(n/2),l=o(r/2),u=o(i/2),d=s(n/2),f=s(r/2),p=s(i/2);switch(a){case`XYZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`YXZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`ZXY`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`ZYX`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`YZX`:this._x=d*l*u+c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u-d*f*p;break;case`XZY`:this._x=d*l*u-c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u+d*f*p;break;default:L(`Quaternion: .setFromEuler() encountered an unknown order: `+a)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let n=t/2,r=Math.sin(n);return this._x=e.x*r,this._y=e.y*r,this._z=e.z*r,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],r=t[4],i=t[8],a=t[1],o=t[5],s=t[9],c=t[2],l=t[6],u=t[10],d=n+o+u;if(d>0){let e=.5/Math.sqrt(d+1);this._w=.25/e,this._x=(l-s)*e,this._y=(i-c)*e,this._z=(a-r)*e}else if(n>o&&n>u){let e=2*Math.sqrt(1+n-o-u);this._w=(l-s)/e,this._x=.25*e,this._y=(r+a)/e,this._z=(i+c)/e}else if(o>u){let e=2*Math.sqrt(1+o-n-u);this._w=(i-c)/e,this._x=(r+a)/e,this._y=.25*e,this._z=(s+l)/e}else{let e=2*Math.sqrt(1+u-n-o);this._w=(a-r)/e,this._x=(i+c)/e,this._y=(s+l)/e,this._z=.25*e}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(z(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let r=Math.min(1,t/n);return this.slerp(e,r),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x*=e,this._y*=e,this._z*=e,this._w*=e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=t._x,s=t._y,c=t._z,l=t._w;return this._x=n*l+a*o+r*c-i*s,this._y=r*l+a*s+i*o-n*c,this._z=i*l+a*c+n*s-r*o,this._w=a*l-n*o-r*s-i*c,this._onChangeCallback(),this}slerp(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=this.dot(e);o<0&&(n=-n,r=-r,i=-i,a=-a,o=-o);let s=1-t;if(o<.9995){let e=Math.acos(o),c=Math.sin(e);s=Math.sin(s*e)/c,t=Math.sin(t*e)/c,this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this._onChangeCallback()}else this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),r=Math.sqrt(1-n),i=Math.sqrt(n);return this.set(r*Math.sin(e),r*Math.cos(e),i*Math.sin(t),i*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},W=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw Error(`THREE.Vector3: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw Error(`THREE.Vector3: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(Ve.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(Ve.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[3]*n+i[6]*r,this.y=i[1]*t+i[4]*n+i[7]*r,this.z=i[2]*t+i[5]*n+i[8]*r,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=e.elements,a=1/(i[3]*t+i[7]*n+i[11]*r+i[15]);return this.x=(i[0]*t+i[4]*n+i[8]*r+i[12])*a,this.y=(i[1]*t+i[5]*n+i[9]*r+i[13])*a,this.z=(i[2]*t+i[6]*n+i[10]*r+i[14])*a,this}applyQuaternion(e){let t=this.x,n=this.y,r=this.z,i=e.x,a=e.y,o=e.z,s=e.w,c=2*(a*r-o*n),l=2*(o*t-i*r),u=2*(i*n-a*t);return this.x=t+s*c+a*u-o*l,this.y=n+s*l+o*c-i*u,this.z=r+s*u+i*l-a*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[4]*n+i[8]*r,this.y=i[1]*t+i[5]*n+i[9]*r,this.z=i[2]*t+i[6]*n+i[10]*r,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=z(this.x,e.x,t.x),this.y=z(this.y,e.y,t.y),this.z=z(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=z(this.x,e,t),this.y=z(this.y,e,t),this.z=z(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(z(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,r=e.y,i=e.z,a=t.x,o=t.y,s=t.z;return this.x=r*s-i*o,this.y=i*a-n*s,this.z=n*o-r*a,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return Be.copy(this).projectOnVector(e),this.sub(Be)}reflect(e){return this.sub(Be.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(z(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,r=this.z-e.z;return t*t+n*n+r*r}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let r=Math.sin(t)*e;return this.x=r*Math.sin(n),this.y=Math.cos(t)*e,this.z=r*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),r=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=r,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},Be=new W,Ve=new U,G=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,r,i,a,o,s,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c)}set(e,t,n,r,i,a,o,s,c){let l=this.elements;return l[0]=e,l[1]=r,l[2]=o,l[3]=t,l[4]=i,l[5]=s,l[6]=n,l[7]=a,l[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[3],s=n[6],c=n[1],l=n[4],u=n[7],d=n[2],f=n[5],p=n[8],m=r[0],h=r[3],g=r[6],_=r[1],v=r[4],y=r[7],b=r[2],x=r[5],S=r[8];return i[0]=a*m+o*_+s*b,i[3]=a*h+o*v+s*x,i[6]=a*g+o*y+s*S,i[1]=c*m+l*_+u*b,i[4]=c*h+l*v+u*x,i[7]=c*g+l*y+u*S,i[2]=d*m+f*_+p*b,i[5]=d*h+f*v+p*x,i[8]=d*g+f*y+p*S,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8];return t*a*l-t*o*c-n*i*l+n*o*s+r*i*c-r*a*s}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=l*a-o*c,d=o*s-l*i,f=c*i-a*s,p=t*u+n*d+r*f;if(p===0)return this.set(0,0,0,0,0,0,0,0,0);let m=1/p;return e[0]=u*m,e[1]=(r*c-l*n)*m,e[2]=(o*n-r*a)*m,e[3]=d*m,e[4]=(l*t-r*s)*m,e[5]=(r*i-o*t)*m,e[6]=f*m,e[7]=(n*s-c*t)*m,e[8]=(a*t-n*i)*m,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,r,i,a,o){let s=Math.cos(i),c=Math.sin(i);return this.set(n*s,n*c,-n*(s*a+c*o)+a+e,-r*c,r*s,-r*(-c*a+s*o)+o+t,0,0,1),this}scale(e,t){return de(`Matrix3: .scale() is deprecated. Use .makeScale() instead.`),this.premultiply(He.makeScale(e,t)),this}rotate(e){return de(`Matrix3: .rotate() is deprecated. Use .makeRotation() instead.`),this.premultiply(He.makeRotation(-e)),this}translate(e,t){return de(`Matrix3: .translate() is deprecated. Use .makeTranslation() instead.`),this.premultiply(He.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<9;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},He=new G,Ue=new G().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),We=new G().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function Ge(){let e={enabled:!0,workingColorSpace:N,spaces:{},convert:function(e,t,n){return this.enabled===!1||t===n||!t||!n||(this.spaces[t].transfer===`srgb`&&(e.r=qe(e.r),e.g=qe(e.g),e.b=qe(e.b)),this.spaces[t].primaries!==this.spaces[n].primaries&&(e.applyMatrix3(this.spaces[t].toXYZ),e.applyMatrix3(this.spaces[n].fromXYZ)),this.spaces[n].transfer===`srgb`&&(e.r=Je(e.r),e.g=Je(e.g),e.b=Je(e.b))),e},workingToColorSpace:function(e,t){return this.convert(e,this.workingColorSpace,t)},colorSpaceToWorking:function(e,t){return this.convert(e,t,this.workingColorSpace)},getPrimaries:function(e){return this.spaces[e].primaries},getTransfer:function(e){return e===``?P:this.spaces[e].transfer},getToneMappingMode:function(e){return this.spaces[e].outputColorSpaceConfig.toneMappingMode||`standard`},getLuminanceCoefficients:function(e,t=this.workingColorSpace){return e.fromArray(this.spaces[t].luminanceCoefficients)},define:function(e){Object.assign(this.spaces,e)},_getMatrix:function(e,t,n){return e.copy(this.spaces[n].fromXYZ).multiply(this.spaces[t].toXYZ)},_getDrawingBufferColorSpace:function(e){return this.spaces[e].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(e=this.workingColorSpace){return this.spaces[e].workingColorSpaceConfig.unpackColorSpace}},t=[.64,.33,.3,.6,.15,.06],n=[.2126,.7152,.0722],r=[.3127,.329];return e.define({[N]:{primaries:t,whitePoint:r,transfer:P,toXYZ:Ue,fromXYZ:We,luminanceCoefficients:n,workingColorSpaceConfig:{unpackColorSpace:M},outputColorSpaceConfig:{drawingBufferColorSpace:M}},[M]:{primaries:t,whitePoint:r,transfer:ee,toXYZ:Ue,fromXYZ:We,luminanceCoefficients:n,outputColorSpaceConfig:{drawingBufferColorSpace:M}}}),e}var Ke=Ge();function qe(e){return e<.04045?e*.0773993808:(e*.9478672986+.0521327014)**2.4}function Je(e){return e<.0031308?e*12.92:1.055*e**.41666-.055}var Ye,Xe=class{static getDataURL(e,t=`image/png`){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>`u`)return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{Ye===void 0&&(Ye=oe(`canvas`)),Ye.width=e.width,Ye.height=e.height;let t=Ye.getContext(`2d`);e instanceof ImageData?t.putImageData(e,0,0):t.drawImage(e,0,0,e.width,e.height),n=Ye}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap){let t=oe(`canvas`);t.width=e.width,t.height=e.height;let n=t.getContext(`2d`);n.drawImage(e,0,0,e.width,e.height);let r=n.getImageData(0,0,e.width,e.height),i=r.data;for(let e=0;e<i.length;e++)i[e]=qe(i[e]/255)*255;return n.putImageData(r,0,0),t}if(e.data){let t=e.data.slice(0);for(let e=0;e<t.length;e++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[e]=Math.floor(qe(t[e]/255)*255):t[e]=qe(t[e]);return{data:t,width:e.width,height:e.height}}return L(`ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied.`),e}},Ze=0,Qe=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:Ze++}),this.uuid=ye(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<`u`&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<`u`&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t===null?e.set(0,0,0):e.set(t.width||0,t.height||0,t.depth||0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:``},r=this.data;if(r!==null){let e;if(Array.isArray(r)){e=[];for(let t=0,n=r.length;t<n;t++)r[t].isDataTexture?e.push($e(r[t].image)):e.push($e(r[t]))}else e=$e(r);n.url=e}return t||(e.images[this.uuid]=n),n}};function $e(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap?Xe.getDataURL(e):e.data?{data:Array.from(e.data),width:e.width,height:e.height,type:e.data.constructor.name}:(L(`Texture: Unable to serialize Texture.`),{})}var et=0,tt=new W,nt=class r extends me{constructor(e=r.DEFAULT_IMAGE,n=r.DEFAULT_MAPPING,i=t,a=t,s=o,u=c,d=_,f=l,p=r.DEFAULT_ANISOTROPY,m=``){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:et++}),this.uuid=ye(),this.name=``,this.source=new Qe(e),this.mipmaps=[],this.mapping=n,this.channel=0,this.wrapS=i,this.wrapT=a,this.magFilter=s,this.minFilter=u,this.anisotropy=p,this.format=d,this.internalFormat=null,this.type=f,this.offset=new H(0,0),this.repeat=new H(1,1),this.center=new H(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new G,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=m,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(e&&e.depth&&e.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(tt).x}get height(){return this.source.getSize(tt).y}get depth(){return this.source.getSize(tt).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){L(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?L(`Texture.setValues(): property '${t}' does not exist.`):r&&n&&r.isVector2&&n.isVector2||r&&n&&r.isVector3&&n.isVector3||r&&n&&r.isMatrix3&&n.isMatrix3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:`Texture`,generator:`Texture.toJSON`},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:`dispose`})}transformUv(r){if(this.mapping!==300)return r;if(r.applyMatrix3(this.matrix),r.x<0||r.x>1)switch(this.wrapS){case e:r.x-=Math.floor(r.x);break;case t:r.x=r.x<0?0:1;break;case n:Math.abs(Math.floor(r.x)%2)===1?r.x=Math.ceil(r.x)-r.x:r.x-=Math.floor(r.x)}if(r.y<0||r.y>1)switch(this.wrapT){case e:r.y-=Math.floor(r.y);break;case t:r.y=r.y<0?0:1;break;case n:Math.abs(Math.floor(r.y)%2)===1?r.y=Math.ceil(r.y)-r.y:r.y-=Math.floor(r.y)}return this.flipY&&(r.y=1-r.y),r}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};nt.DEFAULT_IMAGE=null,nt.DEFAULT_MAPPING=300,nt.DEFAULT_ANISOTROPY=1;var rt=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,r=1){this.x=e,this.y=t,this.z=n,this.w=r}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,r){return this.x=e,this.y=t,this.z=n,this.w=r,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw Error(`THREE.Vector4: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw Error(`THREE.Vector4: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w===void 0?1:e.w,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=this.w,a=e.elements;return this.x=a[0]*t+a[4]*n+a[8]*r+a[12]*i,this.y=a[1]*t+a[5]*n+a[9]*r+a[13]*i,this.z=a[2]*t+a[6]*n+a[10]*r+a[14]*i,this.w=a[3]*t+a[7]*n+a[11]*r+a[15]*i,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,r,i,a=.01,o=.1,s=e.elements,c=s[0],l=s[4],u=s[8],d=s[1],f=s[5],p=s[9],m=s[2],h=s[6],g=s[10];if(Math.abs(l-d)<a&&Math.abs(u-m)<a&&Math.abs(p-h)<a){if(Math.abs(l+d)<o&&Math.abs(u+m)<o&&Math.abs(p+h)<o&&Math.abs(c+f+g-3)<o)return this.set(1,0,0,0),this;t=Math.PI;let e=(c+1)/2,s=(f+1)/2,_=(g+1)/2,v=(l+d)/4,y=(u+m)/4,b=(p+h)/4;return e>s&&e>_?e<a?(n=0,r=.707106781,i=.707106781):(n=Math.sqrt(e),r=v/n,i=y/n):s>_?s<a?(n=.707106781,r=0,i=.707106781):(r=Math.sqrt(s),n=v/r,i=b/r):_<a?(n=.707106781,r=.707106781,i=0):(i=Math.sqrt(_),n=y/i,r=b/i),this.set(n,r,i,t),this}let _=Math.sqrt((h-p)*(h-p)+(u-m)*(u-m)+(d-l)*(d-l));return Math.abs(_)<.001&&(_=1),this.x=(h-p)/_,this.y=(u-m)/_,this.z=(d-l)/_,this.w=Math.acos((c+f+g-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=z(this.x,e.x,t.x),this.y=z(this.y,e.y,t.y),this.z=z(this.z,e.z,t.z),this.w=z(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=z(this.x,e,t),this.y=z(this.y,e,t),this.z=z(this.z,e,t),this.w=z(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(z(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},it=class extends me{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:o,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new rt(0,0,e,t),this.scissorTest=!1,this.viewport=new rt(0,0,e,t),this.textures=[];let r=n.count;for(let i=0;i<r;i++)this.textures[i]=new nt({width:e,height:t,depth:n.depth}),this.textures[i].isRenderTargetTexture=!0,this.textures[i].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:o,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let e=0;e<this.textures.length;e++)this.textures[e].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let r=0,i=this.textures.length;r<i;r++)this.textures[r].image.width=e,this.textures[r].image.height=t,this.textures[r].image.depth=n,this.textures[r].isData3DTexture!==!0&&(this.textures[r].isArrayTexture=this.textures[r].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let n=Object.assign({},e.textures[t].image);this.textures[t].source=new Qe(n)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null){if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture}else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:`dispose`})}},at=class extends it{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},ot=class extends nt{constructor(e=null,n=1,i=1,a=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:n,height:i,depth:a},this.magFilter=r,this.minFilter=r,this.wrapR=t,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}},st=class extends nt{constructor(e=null,n=1,i=1,a=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:n,height:i,depth:a},this.magFilter=r,this.minFilter=r,this.wrapR=t,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}},K=class e{static{this.prototype.isMatrix4=!0}constructor(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h)}set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){let g=this.elements;return g[0]=e,g[4]=t,g[8]=n,g[12]=r,g[1]=i,g[5]=a,g[9]=o,g[13]=s,g[2]=c,g[6]=l,g[10]=u,g[14]=d,g[3]=f,g[7]=p,g[11]=m,g[15]=h,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new e().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,r=1/ct.setFromMatrixColumn(e,0).length(),i=1/ct.setFromMatrixColumn(e,1).length(),a=1/ct.setFromMatrixColumn(e,2).length();return t[0]=n[0]*r,t[1]=n[1]*r,t[2]=n[2]*r,t[3]=0,t[4]=n[4]*i,t[5]=n[5]*i,t[6]=n[6]*i,t[7]=0,t[8]=n[8]*a,t[9]=n[9]*a,t[10]=n[10]*a,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,r=e.y,i=e.z,a=Math.cos(n),o=Math.sin(n),s=Math.cos(r),c=Math.sin(r),l=Math.cos(i),u=Math.sin(i);if(e.order===`XYZ`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=-s*u,t[8]=c,t[1]=n+r*c,t[5]=e-i*c,t[9]=-o*s,t[2]=i-e*c,t[6]=r+n*c,t[10]=a*s}else if(e.order===`YXZ`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e+i*o,t[4]=r*o-n,t[8]=a*c,t[1]=a*u,t[5]=a*l,t[9]=-o,t[2]=n*o-r,t[6]=i+e*o,t[10]=a*s}else if(e.order===`ZXY`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e-i*o,t[4]=-a*u,t[8]=r+n*o,t[1]=n+r*o,t[5]=a*l,t[9]=i-e*o,t[2]=-a*c,t[6]=o,t[10]=a*s}else if(e.order===`ZYX`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=r*c-n,t[8]=e*c+i,t[1]=s*u,t[5]=i*c+e,t[9]=n*c-r,t[2]=-c,t[6]=o*s,t[10]=a*s}else if(e.order===`YZX`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=i-e*u,t[8]=r*u+n,t[1]=u,t[5]=a*l,t[9]=-o*l,t[2]=-c*l,t[6]=n*u+r,t[10]=e-i*u}else if(e.order===`XZY`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=-u,t[8]=c*l,t[1]=e*u+i,t[5]=a*l,t[9]=n*u-r,t[2]=r*u-n,t[6]=o*l,t[10]=i*u+e}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(ut,e,dt)}lookAt(e,t,n){let r=this.elements;return mt.subVectors(e,t),mt.lengthSq()===0&&(mt.z=1),mt.normalize(),ft.crossVectors(n,mt),ft.lengthSq()===0&&(Math.abs(n.z)===1?mt.x+=1e-4:mt.z+=1e-4,mt.normalize(),ft.crossVectors(n,mt)),ft.normalize(),pt.crossVectors(mt,ft),r[0]=ft.x,r[4]=pt.x,r[8]=mt.x,r[1]=ft.y,r[5]=pt.y,r[9]=mt.y,r[2]=ft.z,r[6]=pt.z,r[10]=mt.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[4],s=n[8],c=n[12],l=n[1],u=n[5],d=n[9],f=n[13],p=n[2],m=n[6],h=n[10],g=n[14],_=n[3],v=n[7],y=n[11],b=n[15],x=r[0],S=r[4],C=r[8],w=r[12],T=r[1],E=r[5],D=r[9],O=r[13],k=r[2],A=r[6],j=r[10],M=r[14],N=r[3],P=r[7],ee=r[11],te=r[15];return i[0]=a*x+o*T+s*k+c*N,i[4]=a*S+o*E+s*A+c*P,i[8]=a*C+o*D+s*j+c*ee,i[12]=a*w+o*O+s*M+c*te,i[1]=l*x+u*T+d*k+f*N,i[5]=l*S+u*E+d*A+f*P,i[9]=l*C+u*D+d*j+f*ee,i[13]=l*w+u*O+d*M+f*te,i[2]=p*x+m*T+h*k+g*N,i[6]=p*S+m*E+h*A+g*P,i[10]=p*C+m*D+h*j+g*ee,i[14]=p*w+m*O+h*M+g*te,i[3]=_*x+v*T+y*k+b*N,i[7]=_*S+v*E+y*A+b*P,i[11]=_*C+v*D+y*j+b*ee,i[15]=_*w+v*O+y*M+b*te,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[12],a=e[1],o=e[5],s=e[9],c=e[13],l=e[2],u=e[6],d=e[10],f=e[14],p=e[3],m=e[7],h=e[11],g=e[15],_=s*f-c*d,v=o*f-c*u,y=o*d-s*u,b=a*f-c*l,x=a*d-s*l,S=a*u-o*l;return t*(m*_-h*v+g*y)-n*(p*_-h*b+g*x)+r*(p*v-m*b+g*S)-i*(p*y-m*x+h*S)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[1],a=e[5],o=e[9],s=e[2],c=e[6],l=e[10];return t*(a*l-o*c)-n*(i*l-o*s)+r*(i*c-a*s)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let r=this.elements;return e.isVector3?(r[12]=e.x,r[13]=e.y,r[14]=e.z):(r[12]=e,r[13]=t,r[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=e[9],d=e[10],f=e[11],p=e[12],m=e[13],h=e[14],g=e[15],_=t*o-n*a,v=t*s-r*a,y=t*c-i*a,b=n*s-r*o,x=n*c-i*o,S=r*c-i*s,C=l*m-u*p,w=l*h-d*p,T=l*g-f*p,E=u*h-d*m,D=u*g-f*m,O=d*g-f*h,k=_*O-v*D+y*E+b*T-x*w+S*C;if(k===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let A=1/k;return e[0]=(o*O-s*D+c*E)*A,e[1]=(r*D-n*O-i*E)*A,e[2]=(m*S-h*x+g*b)*A,e[3]=(d*x-u*S-f*b)*A,e[4]=(s*T-a*O-c*w)*A,e[5]=(t*O-r*T+i*w)*A,e[6]=(h*y-p*S-g*v)*A,e[7]=(l*S-d*y+f*v)*A,e[8]=(a*D-o*T+c*C)*A,e[9]=(n*T-t*D-i*C)*A,e[10]=(p*x-m*y+g*_)*A,e[11]=(u*y-l*x-f*_)*A,e[12]=(o*w-a*E-s*C)*A,e[13]=(t*E-n*w+r*C)*A,e[14]=(m*v-p*b-h*_)*A,e[15]=(l*b-u*v+d*_)*A,this}scale(e){let t=this.elements,n=e.x,r=e.y,i=e.z;return t[0]*=n,t[4]*=r,t[8]*=i,t[1]*=n,t[5]*=r,t[9]*=i,t[2]*=n,t[6]*=r,t[10]*=i,t[3]*=n,t[7]*=r,t[11]*=i,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],r=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,r))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),r=Math.sin(t),i=1-n,a=e.x,o=e.y,s=e.z,c=i*a,l=i*o;return this.set(c*a+n,c*o-r*s,c*s+r*o,0,c*o+r*s,l*o+n,l*s-r*a,0,c*s-r*o,l*s+r*a,i*s*s+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,r,i,a){return this.set(1,n,i,0,e,1,a,0,t,r,1,0,0,0,0,1),this}compose(e,t,n){let r=this.elements,i=t._x,a=t._y,o=t._z,s=t._w,c=i+i,l=a+a,u=o+o,d=i*c,f=i*l,p=i*u,m=a*l,h=a*u,g=o*u,_=s*c,v=s*l,y=s*u,b=n.x,x=n.y,S=n.z;return r[0]=(1-(m+g))*b,r[1]=(f+y)*b,r[2]=(p-v)*b,r[3]=0,r[4]=(f-y)*x,r[5]=(1-(d+g))*x,r[6]=(h+_)*x,r[7]=0,r[8]=(p+v)*S,r[9]=(h-_)*S,r[10]=(1-(d+m))*S,r[11]=0,r[12]=e.x,r[13]=e.y,r[14]=e.z,r[15]=1,this}decompose(e,t,n){let r=this.elements;e.x=r[12],e.y=r[13],e.z=r[14];let i=this.determinantAffine();if(i===0)return n.set(1,1,1),t.identity(),this;let a=ct.set(r[0],r[1],r[2]).length(),o=ct.set(r[4],r[5],r[6]).length(),s=ct.set(r[8],r[9],r[10]).length();i<0&&(a=-a),lt.copy(this);let c=1/a,l=1/o,u=1/s;return lt.elements[0]*=c,lt.elements[1]*=c,lt.elements[2]*=c,lt.elements[4]*=l,lt.elements[5]*=l,lt.elements[6]*=l,lt.elements[8]*=u,lt.elements[9]*=u,lt.elements[10]*=u,t.setFromRotationMatrix(lt),n.x=a,n.y=o,n.z=s,this}makePerspective(e,t,n,r,i,a,o=re,s=!1){let c=this.elements,l=2*i/(t-e),u=2*i/(n-r),d=(t+e)/(t-e),f=(n+r)/(n-r),p,m;if(s)p=i/(a-i),m=a*i/(a-i);else if(o===2e3)p=-(a+i)/(a-i),m=-2*a*i/(a-i);else if(o===2001)p=-a/(a-i),m=-a*i/(a-i);else throw Error(`THREE.Matrix4.makePerspective(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=d,c[12]=0,c[1]=0,c[5]=u,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,n,r,i,a,o=re,s=!1){let c=this.elements,l=2/(t-e),u=2/(n-r),d=-(t+e)/(t-e),f=-(n+r)/(n-r),p,m;if(s)p=1/(a-i),m=a/(a-i);else if(o===2e3)p=-2/(a-i),m=-(a+i)/(a-i);else if(o===2001)p=-1/(a-i),m=-i/(a-i);else throw Error(`THREE.Matrix4.makeOrthographic(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=0,c[12]=d,c[1]=0,c[5]=u,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<16;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},ct=new W,lt=new K,ut=new W(0,0,0),dt=new W(1,1,1),ft=new W,pt=new W,mt=new W,ht=new K,gt=new U,_t=class e{constructor(t=0,n=0,r=0,i=e.DEFAULT_ORDER){this.isEuler=!0,this._x=t,this._y=n,this._z=r,this._order=i}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,r=this._order){return this._x=e,this._y=t,this._z=n,this._order=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){let r=e.elements,i=r[0],a=r[4],o=r[8],s=r[1],c=r[5],l=r[9],u=r[2],d=r[6],f=r[10];switch(t){case`XYZ`:this._y=Math.asin(z(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(-l,f),this._z=Math.atan2(-a,i)):(this._x=Math.atan2(d,c),this._z=0);break;case`YXZ`:this._x=Math.asin(-z(l,-1,1)),Math.abs(l)<.9999999?(this._y=Math.atan2(o,f),this._z=Math.atan2(s,c)):(this._y=Math.atan2(-u,i),this._z=0);break;case`ZXY`:this._x=Math.asin(z(d,-1,1)),Math.abs(d)<.9999999?(this._y=Math.atan2(-u,f),this._z=Math.atan2(-a,c)):(this._y=0,this._z=Math.atan2(s,i));break;case`ZYX`:this._y=Math.asin(-z(u,-1,1)),Math.abs(u)<.9999999?(this._x=Math.atan2(d,f),this._z=Math.atan2(s,i)):(this._x=0,this._z=Math.atan2(-a,c));break;case`YZX`:this._z=Math.asin(z(s,-1,1)),Math.abs(s)<.9999999?(this._x=Math.atan2(-l,c),this._y=Math.atan2(-u,i)):(this._x=0,this._y=Math.atan2(o,f));break;case`XZY`:this._z=Math.asin(-z(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(d,c),this._y=Math.atan2(o,i)):(this._x=Math.atan2(-l,f),this._y=0);break;default:L(`Euler: .setFromRotationMatrix() encountered an unknown order: `+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return ht.makeRotationFromQuaternion(e),this.setFromRotationMatrix(ht,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return gt.setFromEuler(this),this.setFromQuaternion(gt,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};_t.DEFAULT_ORDER=`XYZ`;var vt=class{constructor(){this.mask=1}set(e){this.mask=1<<e>>>0}enable(e){this.mask|=1<<e}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e}disable(e){this.mask&=~(1<<e)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return!!(this.mask&1<<e)}},yt=0,bt=new W,xt=new U,St=new K,Ct=new W,wt=new W,Tt=new W,Et=new U,Dt=new W(1,0,0),Ot=new W(0,1,0),kt=new W(0,0,1),At={type:`added`},jt={type:`removed`},Mt={type:`childadded`,child:null},Nt={type:`childremoved`,child:null},Pt=class e extends me{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:yt++}),this.uuid=ye(),this.name=``,this.type=`Object3D`,this.parent=null,this.children=[],this.up=e.DEFAULT_UP.clone();let t=new W,n=new _t,r=new U,i=new W(1,1,1);function a(){r.setFromEuler(n,!1)}function o(){n.setFromQuaternion(r,void 0,!1)}n._onChange(a),r._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:t},rotation:{configurable:!0,enumerable:!0,value:n},quaternion:{configurable:!0,enumerable:!0,value:r},scale:{configurable:!0,enumerable:!0,value:i},modelViewMatrix:{value:new K},normalMatrix:{value:new G}}),this.matrix=new K,this.matrixWorld=new K,this.matrixAutoUpdate=e.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=e.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new vt,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return xt.setFromAxisAngle(e,t),this.quaternion.multiply(xt),this}rotateOnWorldAxis(e,t){return xt.setFromAxisAngle(e,t),this.quaternion.premultiply(xt),this}rotateX(e){return this.rotateOnAxis(Dt,e)}rotateY(e){return this.rotateOnAxis(Ot,e)}rotateZ(e){return this.rotateOnAxis(kt,e)}translateOnAxis(e,t){return bt.copy(e).applyQuaternion(this.quaternion),this.position.add(bt.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(Dt,e)}translateY(e){return this.translateOnAxis(Ot,e)}translateZ(e){return this.translateOnAxis(kt,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(St.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?Ct.copy(e):Ct.set(e,t,n);let r=this.parent;this.updateWorldMatrix(!0,!1),wt.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?St.lookAt(wt,Ct,this.up):St.lookAt(Ct,wt,this.up),this.quaternion.setFromRotationMatrix(St),r&&(St.extractRotation(r.matrixWorld),xt.setFromRotationMatrix(St),this.quaternion.premultiply(xt.invert()))}add(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.add(arguments[e]);return this}return e===this?(R(`Object3D.add: object can't be added as a child of itself.`,e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(At),Mt.child=e,this.dispatchEvent(Mt),Mt.child=null):R(`Object3D.add: object not an instance of THREE.Object3D.`,e),this)}remove(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.remove(arguments[e]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(jt),Nt.child=e,this.dispatchEvent(Nt),Nt.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),St.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),St.multiply(e.parent.matrixWorld)),e.applyMatrix4(St),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(At),Mt.child=e,this.dispatchEvent(Mt),Mt.child=null,this}getObjectById(e){return this.getObjectByProperty(`id`,e)}getObjectByName(e){return this.getObjectByProperty(`name`,e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,r=this.children.length;n<r;n++){let r=this.children[n].getObjectByProperty(e,t);if(r!==void 0)return r}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let r=this.children;for(let i=0,a=r.length;i<a;i++)r[i].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(wt,e,Tt),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(wt,Et,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,r=e.z,i=this.matrix.elements;i[12]+=t-i[0]*t-i[4]*n-i[8]*r,i[13]+=n-i[1]*t-i[5]*n-i[9]*r,i[14]+=r-i[2]*t-i[6]*n-i[10]*r}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let r=this.parent;if(e===!0&&r!==null&&r.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let e=this.children;for(let t=0,r=e.length;t<r;t++)e[t].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e==`string`,n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:`Object`,generator:`Object3D.toJSON`});let r={};r.uuid=this.uuid,r.type=this.type,r.name=this.name,r.castShadow=this.castShadow,r.receiveShadow=this.receiveShadow,r.visible=this.visible,r.frustumCulled=this.frustumCulled,r.renderOrder=this.renderOrder,r.static=this.static,r.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(r.userData=this.userData),r.layers=this.layers.mask,r.matrix=this.matrix.toArray(),r.up=this.up.toArray(),this.pivot!==null&&(r.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(r.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(r.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(r.type=`InstancedMesh`,r.count=this.count,r.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(r.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(r.type=`BatchedMesh`,r.perObjectFrustumCulled=this.perObjectFrustumCulled,r.sortObjects=this.sortObjects,r.drawRanges=this._drawRanges,r.reservedRanges=this._reservedRanges,r.geometryInfo=this._geometryInfo.map(e=>({...e,boundingBox:e.boundingBox?e.boundingBox.toJSON():void 0,boundingSphere:e.boundingSphere?e.boundingSphere.toJSON():void 0})),r.instanceInfo=this._instanceInfo.map(e=>({...e})),r.availableInstanceIds=this._availableInstanceIds.slice(),r.availableGeometryIds=this._availableGeometryIds.slice(),r.nextIndexStart=this._nextIndexStart,r.nextVertexStart=this._nextVertexStart,r.geometryCount=this._geometryCount,r.maxInstanceCount=this._maxInstanceCount,r.maxVertexCount=this._maxVertexCount,r.maxIndexCount=this._maxIndexCount,r.geometryInitialized=this._geometryInitialized,r.matricesTexture=this._matricesTexture.toJSON(e),r.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(r.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(r.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(r.boundingBox=this.boundingBox.toJSON()));function i(t,n){return t[n.uuid]===void 0&&(t[n.uuid]=n.toJSON(e)),n.uuid}if(this.isScene)this.background&&(this.background.isColor?r.background=this.background.toJSON():this.background.isTexture&&(r.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(r.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){r.geometry=i(e.geometries,this.geometry);let t=this.geometry.parameters;if(t!==void 0&&t.shapes!==void 0){let n=t.shapes;if(Array.isArray(n))for(let t=0,r=n.length;t<r;t++){let r=n[t];i(e.shapes,r)}else i(e.shapes,n)}}if(this.isSkinnedMesh&&(r.bindMode=this.bindMode,r.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(i(e.skeletons,this.skeleton),r.skeleton=this.skeleton.uuid)),this.material!==void 0){if(Array.isArray(this.material)){let t=[];for(let n=0,r=this.material.length;n<r;n++)t.push(i(e.materials,this.material[n]));r.material=t}else r.material=i(e.materials,this.material)}if(this.children.length>0){r.children=[];for(let t=0;t<this.children.length;t++)r.children.push(this.children[t].toJSON(e).object)}if(this.animations.length>0){r.animations=[];for(let t=0;t<this.animations.length;t++){let n=this.animations[t];r.animations.push(i(e.animations,n))}}if(t){let t=a(e.geometries),r=a(e.materials),i=a(e.textures),o=a(e.images),s=a(e.shapes),c=a(e.skeletons),l=a(e.animations),u=a(e.nodes);t.length>0&&(n.geometries=t),r.length>0&&(n.materials=r),i.length>0&&(n.textures=i),o.length>0&&(n.images=o),s.length>0&&(n.shapes=s),c.length>0&&(n.skeletons=c),l.length>0&&(n.animations=l),u.length>0&&(n.nodes=u)}return n.object=r,n;function a(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot===null?null:e.pivot.clone(),this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let t=0;t<e.children.length;t++){let n=e.children[t];this.add(n.clone())}return this}dispose(){this.dispatchEvent({type:`dispose`})}};Pt.DEFAULT_UP=new W(0,1,0),Pt.DEFAULT_MATRIX_AUTO_UPDATE=!0,Pt.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var Ft=class extends Pt{constructor(){super(),this.isGroup=!0,this.type=`Group`}},It={type:`move`},Lt=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new Ft,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new Ft,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new W,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new W),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new Ft,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new W,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new W,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:`connected`,data:e}),this}disconnect(e){return this.dispatchEvent({type:`disconnected`,data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let r=null,i=null,a=null,o=this._targetRay,s=this._grip,c=this._hand;if(e&&t.session.visibilityState!==`visible-blurred`){if(c&&e.hand){a=!0;for(let r of e.hand.values()){let e=t.getJointPose(r,n),i=this._getHandJoint(c,r);e!==null&&(i.matrix.fromArray(e.transform.matrix),i.matrix.decompose(i.position,i.quaternion,i.scale),i.matrixWorldNeedsUpdate=!0,i.jointRadius=e.radius),i.visible=e!==null}let r=c.joints[`index-finger-tip`],i=c.joints[`thumb-tip`],o=r.position.distanceTo(i.position);c.inputState.pinching&&o>.025?(c.inputState.pinching=!1,this.dispatchEvent({type:`pinchend`,handedness:e.handedness,target:this})):!c.inputState.pinching&&o<=.015&&(c.inputState.pinching=!0,this.dispatchEvent({type:`pinchstart`,handedness:e.handedness,target:this}))}else s!==null&&e.gripSpace&&(i=t.getPose(e.gripSpace,n),i!==null&&(s.matrix.fromArray(i.transform.matrix),s.matrix.decompose(s.position,s.quaternion,s.scale),s.matrixWorldNeedsUpdate=!0,i.linearVelocity?(s.hasLinearVelocity=!0,s.linearVelocity.copy(i.linearVelocity)):s.hasLinearVelocity=!1,i.angularVelocity?(s.hasAngularVelocity=!0,s.angularVelocity.copy(i.angularVelocity)):s.hasAngularVelocity=!1,s.eventsEnabled&&s.dispatchEvent({type:`gripUpdated`,data:e,target:this})));o!==null&&(r=t.getPose(e.targetRaySpace,n),r===null&&i!==null&&(r=i),r!==null&&(o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.matrixWorldNeedsUpdate=!0,r.linearVelocity?(o.hasLinearVelocity=!0,o.linearVelocity.copy(r.linearVelocity)):o.hasLinearVelocity=!1,r.angularVelocity?(o.hasAngularVelocity=!0,o.angularVelocity.copy(r.angularVelocity)):o.hasAngularVelocity=!1,this.dispatchEvent(It)))}return o!==null&&(o.visible=r!==null),s!==null&&(s.visible=i!==null),c!==null&&(c.visible=a!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let n=new Ft;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},Rt={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},zt={h:0,s:0,l:0},Bt={h:0,s:0,l:0};function Vt(e,t,n){return n<0&&(n+=1),n>1&&--n,n<1/6?e+(t-e)*6*n:n<1/2?t:n<2/3?e+(t-e)*6*(2/3-n):e}var q=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let t=e;t&&t.isColor?this.copy(t):typeof t==`number`?this.setHex(t):typeof t==`string`&&this.setStyle(t)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=M){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,Ke.colorSpaceToWorking(this,t),this}setRGB(e,t,n,r=Ke.workingColorSpace){return this.r=e,this.g=t,this.b=n,Ke.colorSpaceToWorking(this,r),this}setHSL(e,t,n,r=Ke.workingColorSpace){if(e=be(e,1),t=z(t,0,1),n=z(n,0,1),t===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+t):n+t-n*t,i=2*n-r;this.r=Vt(i,r,e+1/3),this.g=Vt(i,r,e),this.b=Vt(i,r,e-1/3)}return Ke.colorSpaceToWorking(this,r),this}setStyle(e,t=M){function n(t){t!==void 0&&parseFloat(t)<1&&L(`Color: Alpha component of `+e+` will be ignored.`)}let r;if(r=/^(\w+)\(([^\)]*)\)/.exec(e)){let i,a=r[1],o=r[2];switch(a){case`rgb`:case`rgba`:if(i=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(255,parseInt(i[1],10))/255,Math.min(255,parseInt(i[2],10))/255,Math.min(255,parseInt(i[3],10))/255,t);if(i=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(100,parseFloat(i[1]))/100,Math.min(100,parseFloat(i[2]))/100,Math.min(100,parseFloat(i[3]))/100,t);break;case`hsl`:case`hsla`:if(i=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setHSL(parseFloat(i[1])/360,parseFloat(i[2])/100,parseFloat(i[3])/100,t);break;default:L(`Color: Unknown color model `+e)}}else if(r=/^\#([A-Fa-f\d]+)$/.exec(e)){let n=r[1],i=n.length;if(i===3)return this.setRGB(parseInt(n.charAt(0),16)/15,parseInt(n.charAt(1),16)/15,parseInt(n.charAt(2),16)/15,t);if(i===6)return this.setHex(parseInt(n,16),t);L(`Color: Invalid hex color `+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=M){let n=Rt[e.toLowerCase()];return n===void 0?L(`Color: Unknown color `+e):this.setHex(n,t),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=qe(e.r),this.g=qe(e.g),this.b=qe(e.b),this}copyLinearToSRGB(e){return this.r=Je(e.r),this.g=Je(e.g),this.b=Je(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=M){return Ke.workingToColorSpace(Ht.copy(this),e),Math.round(z(Ht.r*255,0,255))*65536+Math.round(z(Ht.g*255,0,255))*256+Math.round(z(Ht.b*255,0,255))}getHexString(e=M){return(`000000`+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=Ke.workingColorSpace){Ke.workingToColorSpace(Ht.copy(this),t);let n=Ht.r,r=Ht.g,i=Ht.b,a=Math.max(n,r,i),o=Math.min(n,r,i),s,c,l=(o+a)/2;if(o===a)s=0,c=0;else{let e=a-o;switch(c=l<=.5?e/(a+o):e/(2-a-o),a){case n:s=(r-i)/e+(r<i?6:0);break;case r:s=(i-n)/e+2;break;case i:s=(n-r)/e+4}s/=6}return e.h=s,e.s=c,e.l=l,e}getRGB(e,t=Ke.workingColorSpace){return Ke.workingToColorSpace(Ht.copy(this),t),e.r=Ht.r,e.g=Ht.g,e.b=Ht.b,e}getStyle(e=M){Ke.workingToColorSpace(Ht.copy(this),e);let t=Ht.r,n=Ht.g,r=Ht.b;return e===`srgb`?`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(r*255)})`:`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${r.toFixed(3)})`}offsetHSL(e,t,n){return this.getHSL(zt),this.setHSL(zt.h+e,zt.s+t,zt.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(zt),e.getHSL(Bt);let n=Ce(zt.h,Bt.h,t),r=Ce(zt.s,Bt.s,t),i=Ce(zt.l,Bt.l,t);return this.setHSL(n,r,i),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,r=this.b,i=e.elements;return this.r=i[0]*t+i[3]*n+i[6]*r,this.g=i[1]*t+i[4]*n+i[7]*r,this.b=i[2]*t+i[5]*n+i[8]*r,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Ht=new q;q.NAMES=Rt;var Ut=class extends Pt{constructor(){super(),this.isScene=!0,this.type=`Scene`,this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new _t,this.environmentIntensity=1,this.environmentRotation=new _t,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background===null?null:e.background.clone(),this.environment=e.environment===null?null:e.environment.clone(),this.fog=e.fog===null?null:e.fog.clone(),this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial===null?null:e.overrideMaterial.clone(),this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},Wt=new W,Gt=new W,Kt=new W,qt=new W,Jt=new W,Yt=new W,Xt=new W,Zt=new W,Qt=new W,$t=new W,en=new rt,tn=new rt,nn=new rt,rn=class e{constructor(e=new W,t=new W,n=new W){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,r){r.subVectors(n,t),Wt.subVectors(e,t),r.cross(Wt);let i=r.lengthSq();return i>0?r.multiplyScalar(1/Math.sqrt(i)):r.set(0,0,0)}static getBarycoord(e,t,n,r,i){Wt.subVectors(r,t),Gt.subVectors(n,t),Kt.subVectors(e,t);let a=Wt.dot(Wt),o=Wt.dot(Gt),s=Wt.dot(Kt),c=Gt.dot(Gt),l=Gt.dot(Kt),u=a*c-o*o;if(u===0)return i.set(0,0,0),null;let d=1/u,f=(c*s-o*l)*d,p=(a*l-o*s)*d;return i.set(1-f-p,p,f)}static containsPoint(e,t,n,r){return this.getBarycoord(e,t,n,r,qt)!==null&&qt.x>=0&&qt.y>=0&&qt.x+qt.y<=1}static getInterpolation(e,t,n,r,i,a,o,s){return this.getBarycoord(e,t,n,r,qt)===null?(s.x=0,s.y=0,`z`in s&&(s.z=0),`w`in s&&(s.w=0),null):(s.setScalar(0),s.addScaledVector(i,qt.x),s.addScaledVector(a,qt.y),s.addScaledVector(o,qt.z),s)}static getInterpolatedAttribute(e,t,n,r,i,a){return en.setScalar(0),tn.setScalar(0),nn.setScalar(0),en.fromBufferAttribute(e,t),tn.fromBufferAttribute(e,n),nn.fromBufferAttribute(e,r),a.setScalar(0),a.addScaledVector(en,i.x),a.addScaledVector(tn,i.y),a.addScaledVector(nn,i.z),a}static isFrontFacing(e,t,n,r){return Wt.subVectors(n,t),Gt.subVectors(e,t),Wt.cross(Gt).dot(r)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,r){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[r]),this}setFromAttributeAndIndices(e,t,n,r){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,r),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return Wt.subVectors(this.c,this.b),Gt.subVectors(this.a,this.b),Wt.cross(Gt).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(t){return e.getNormal(this.a,this.b,this.c,t)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(t,n){return e.getBarycoord(t,this.a,this.b,this.c,n)}getInterpolation(t,n,r,i,a){return e.getInterpolation(t,this.a,this.b,this.c,n,r,i,a)}containsPoint(t){return e.containsPoint(t,this.a,this.b,this.c)}isFrontFacing(t){return e.isFrontFacing(this.a,this.b,this.c,t)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,r=this.b,i=this.c,a,o;Jt.subVectors(r,n),Yt.subVectors(i,n),Zt.subVectors(e,n);let s=Jt.dot(Zt),c=Yt.dot(Zt);if(s<=0&&c<=0)return t.copy(n);Qt.subVectors(e,r);let l=Jt.dot(Qt),u=Yt.dot(Qt);if(l>=0&&u<=l)return t.copy(r);let d=s*u-l*c;if(d<=0&&s>=0&&l<=0&&s-l>0)return a=s/(s-l),t.copy(n).addScaledVector(Jt,a);$t.subVectors(e,i);let f=Jt.dot($t),p=Yt.dot($t);if(p>=0&&f<=p)return t.copy(i);let m=f*c-s*p;if(m<=0&&c>=0&&p<=0)return o=c/(c-p),t.copy(n).addScaledVector(Yt,o);let h=l*p-f*u;if(h<=0&&u-l>=0&&f-p>=0)return Xt.subVectors(i,r),o=(u-l)/(u-l+(f-p)),t.copy(r).addScaledVector(Xt,o);let g=1/(h+m+d);return a=m*g,o=d*g,t.copy(n).addScaledVector(Jt,a).addScaledVector(Yt,o)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},an=class{constructor(e=new W(1/0,1/0,1/0),t=new W(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(sn.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(sn.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=sn.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let r=n.getAttribute(`position`);if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let t=0,n=r.count;t<n;t++)e.isMesh===!0?e.getVertexPosition(t,sn):sn.fromBufferAttribute(r,t),sn.applyMatrix4(e.matrixWorld),this.expandByPoint(sn);else e.boundingBox===void 0?(n.boundingBox===null&&n.computeBoundingBox(),cn.copy(n.boundingBox)):(e.boundingBox===null&&e.computeBoundingBox(),cn.copy(e.boundingBox)),cn.applyMatrix4(e.matrixWorld),this.union(cn)}let r=e.children;for(let e=0,n=r.length;e<n;e++)this.expandByObject(r[e],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,sn),sn.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(hn),gn.subVectors(this.max,hn),ln.subVectors(e.a,hn),un.subVectors(e.b,hn),dn.subVectors(e.c,hn),fn.subVectors(un,ln),pn.subVectors(dn,un),mn.subVectors(ln,dn);let t=[0,-fn.z,fn.y,0,-pn.z,pn.y,0,-mn.z,mn.y,fn.z,0,-fn.x,pn.z,0,-pn.x,mn.z,0,-mn.x,-fn.y,fn.x,0,-pn.y,pn.x,0,-mn.y,mn.x,0];return!yn(t,ln,un,dn,gn)||(t=[1,0,0,0,1,0,0,0,1],!yn(t,ln,un,dn,gn))?!1:(_n.crossVectors(fn,pn),t=[_n.x,_n.y,_n.z],yn(t,ln,un,dn,gn))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,sn).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(sn).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()||(on[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),on[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),on[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),on[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),on[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),on[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),on[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),on[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(on)),this}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},on=[new W,new W,new W,new W,new W,new W,new W,new W],sn=new W,cn=new an,ln=new W,un=new W,dn=new W,fn=new W,pn=new W,mn=new W,hn=new W,gn=new W,_n=new W,vn=new W;function yn(e,t,n,r,i){for(let a=0,o=e.length-3;a<=o;a+=3){vn.fromArray(e,a);let o=i.x*Math.abs(vn.x)+i.y*Math.abs(vn.y)+i.z*Math.abs(vn.z),s=t.dot(vn),c=n.dot(vn),l=r.dot(vn);if(Math.max(-Math.max(s,c,l),Math.min(s,c,l))>o)return!1}return!0}var bn=xn();function xn(){let e=new ArrayBuffer(4),t=new Float32Array(e),n=new Uint32Array(e),r=new Uint32Array(512),i=new Uint32Array(512);for(let e=0;e<256;++e){let t=e-127;t<-27?(r[e]=0,r[e|256]=32768,i[e]=24,i[e|256]=24):t<-14?(r[e]=1024>>-t-14,r[e|256]=1024>>-t-14|32768,i[e]=-t-1,i[e|256]=-t-1):t<=15?(r[e]=t+15<<10,r[e|256]=t+15<<10|32768,i[e]=13,i[e|256]=13):t<128?(r[e]=31744,r[e|256]=64512,i[e]=24,i[e|256]=24):(r[e]=31744,r[e|256]=64512,i[e]=13,i[e|256]=13)}let a=new Uint32Array(2048),o=new Uint32Array(64),s=new Uint32Array(64);for(let e=1;e<1024;++e){let t=e<<13,n=0;for(;!(t&8388608);)t<<=1,n-=8388608;t&=-8388609,n+=947912704,a[e]=t|n}for(let e=1024;e<2048;++e)a[e]=939524096+(e-1024<<13);for(let e=1;e<31;++e)o[e]=e<<23;o[31]=1199570944,o[32]=2147483648;for(let e=33;e<63;++e)o[e]=2147483648+(e-32<<23);o[63]=3347054592;for(let e=1;e<64;++e)e!==32&&(s[e]=1024);return{floatView:t,uint32View:n,baseTable:r,shiftTable:i,mantissaTable:a,exponentTable:o,offsetTable:s}}function Sn(e){Math.abs(e)>65504&&L(`DataUtils.toHalfFloat(): Value out of range.`),e=z(e,-65504,65504),bn.floatView[0]=e;let t=bn.uint32View[0],n=t>>23&511;return bn.baseTable[n]+((t&8388607)>>bn.shiftTable[n])}function Cn(e){let t=e>>10;return bn.uint32View[0]=bn.mantissaTable[bn.offsetTable[t]+(e&1023)]+bn.exponentTable[t],bn.floatView[0]}var wn=class{static toHalfFloat(e){return Sn(e)}static fromHalfFloat(e){return Cn(e)}},Tn=new W,En=new H,Dn=0,On=class extends me{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw TypeError(`THREE.BufferAttribute: array should be a Typed Array.`);this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Dn++}),this.name=``,this.array=e,this.itemSize=t,this.count=e===void 0?0:e.length/t,this.normalized=n,this.usage=ne,this.updateRanges=[],this.gpuType=f,this.version=0,this._normalizationScale=e===void 0?void 0:Le(e)}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let r=0,i=this.itemSize;r<i;r++)this.array[e+r]=t.array[n+r];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)En.fromBufferAttribute(this,t),En.applyMatrix3(e),this.setXY(t,En.x,En.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)Tn.fromBufferAttribute(this,t),Tn.applyMatrix3(e),this.setXYZ(t,Tn.x,Tn.y,Tn.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)Tn.fromBufferAttribute(this,t),Tn.applyMatrix4(e),this.setXYZ(t,Tn.x,Tn.y,Tn.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)Tn.fromBufferAttribute(this,t),Tn.applyNormalMatrix(e),this.setXYZ(t,Tn.x,Tn.y,Tn.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)Tn.fromBufferAttribute(this,t),Tn.transformDirection(e),this.setXYZ(t,Tn.x,Tn.y,Tn.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this}setXYZW(e,t,n,r,i){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r),i=this._normalize(i)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this.array[e+3]=i,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:`dispose`})}_denormalize(e){let t=this._normalizationScale;return t===void 0?Re(e,this.array):Math.max(e/t,-1)}_normalize(e){let t=this._normalizationScale;return t===void 0?ze(e,this.array):Math.round(e*t)}},kn=class extends On{constructor(e,t,n){super(new Uint16Array(e),t,n)}},An=class extends On{constructor(e,t,n){super(new Uint32Array(e),t,n)}},jn=class extends On{constructor(e,t,n){super(new Float32Array(e),t,n)}},Mn=new an,Nn=new W,Pn=new W,Fn=class{constructor(e=new W,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t===void 0?Mn.setFromPoints(e).getCenter(n):n.copy(t);let r=0;for(let t=0,i=e.length;t<i;t++)r=Math.max(r,n.distanceToSquared(e[t]));return this.radius=Math.sqrt(r),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius*=e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;Nn.subVectors(e,this.center);let t=Nn.lengthSq();if(t>this.radius*this.radius){let e=Math.sqrt(t),n=(e-this.radius)*.5;this.center.addScaledVector(Nn,n/e),this.radius+=n}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(Pn.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(Nn.copy(e.center).add(Pn)),this.expandByPoint(Nn.copy(e.center).sub(Pn))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},In=0,Ln=new K,Rn=new Pt,zn=new W,Bn=new an,Vn=new an,Hn=new W,Un=class e extends me{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:In++}),this.uuid=ye(),this.name=``,this.type=`BufferGeometry`,this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return this.index=Array.isArray(e)?new(ie(e)?An:kn)(e,1):e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let t=new G().getNormalMatrix(e);n.applyNormalMatrix(t),n.needsUpdate=!0}let r=this.attributes.tangent;return r!==void 0&&(r.transformDirection(e),r.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return Ln.makeRotationFromQuaternion(e),this.applyMatrix4(Ln),this}rotateX(e){return Ln.makeRotationX(e),this.applyMatrix4(Ln),this}rotateY(e){return Ln.makeRotationY(e),this.applyMatrix4(Ln),this}rotateZ(e){return Ln.makeRotationZ(e),this.applyMatrix4(Ln),this}translate(e,t,n){return Ln.makeTranslation(e,t,n),this.applyMatrix4(Ln),this}scale(e,t,n){return Ln.makeScale(e,t,n),this.applyMatrix4(Ln),this}lookAt(e){return Rn.lookAt(e),Rn.updateMatrix(),this.applyMatrix4(Rn.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(zn).negate(),this.translate(zn.x,zn.y,zn.z),this}setFromPoints(e){let t=this.getAttribute(`position`);if(t===void 0){let t=[];for(let n=0,r=e.length;n<r;n++){let r=e[n];t.push(r.x,r.y,r.z||0)}this.setAttribute(`position`,new jn(t,3))}else{let n=Math.min(e.length,t.count);for(let r=0;r<n;r++){let n=e[r];t.setXYZ(r,n.x,n.y,n.z||0)}e.length>t.count&&L(`BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry.`),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new an);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)R(`BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.`,this),this.boundingBox.set(new W(-1/0,-1/0,-1/0),new W(1/0,1/0,1/0));else{if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];Bn.setFromBufferAttribute(n),this.morphTargetsRelative?(Hn.addVectors(this.boundingBox.min,Bn.min),this.boundingBox.expandByPoint(Hn),Hn.addVectors(this.boundingBox.max,Bn.max),this.boundingBox.expandByPoint(Hn)):(this.boundingBox.expandByPoint(Bn.min),this.boundingBox.expandByPoint(Bn.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&R(`BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.`,this)}}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new Fn);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)R(`BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.`,this),this.boundingSphere.set(new W,1/0);else if(e){let n=this.boundingSphere.center;if(Bn.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];Vn.setFromBufferAttribute(n),this.morphTargetsRelative?(Hn.addVectors(Bn.min,Vn.min),Bn.expandByPoint(Hn),Hn.addVectors(Bn.max,Vn.max),Bn.expandByPoint(Hn)):(Bn.expandByPoint(Vn.min),Bn.expandByPoint(Vn.max))}Bn.getCenter(n);let r=0;for(let t=0,i=e.count;t<i;t++)Hn.fromBufferAttribute(e,t),r=Math.max(r,n.distanceToSquared(Hn));if(t)for(let i=0,a=t.length;i<a;i++){let a=t[i],o=this.morphTargetsRelative;for(let t=0,i=a.count;t<i;t++)Hn.fromBufferAttribute(a,t),o&&(zn.fromBufferAttribute(e,t),Hn.add(zn)),r=Math.max(r,n.distanceToSquared(Hn))}this.boundingSphere.radius=Math.sqrt(r),isNaN(this.boundingSphere.radius)&&R(`BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.`,this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){R(`BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)`);return}let n=t.position,r=t.normal,i=t.uv,a=this.getAttribute(`tangent`);(a===void 0||a.count!==n.count)&&(a=new On(new Float32Array(4*n.count),4),this.setAttribute(`tangent`,a));let o=[],s=[],c=new Uint8Array(n.count);for(let e=0;e<n.count;e++)o[e]=new W,s[e]=new W;let l=new W,u=new W,d=new W,f=new H,p=new H,m=new H,h=new W,g=new W;function _(e,t,r){c[e]=c[t]=c[r]=1,l.fromBufferAttribute(n,e),u.fromBufferAttribute(n,t),d.fromBufferAttribute(n,r),f.fromBufferAttribute(i,e),p.fromBufferAttribute(i,t),m.fromBufferAttribute(i,r),u.sub(l),d.sub(l),p.sub(f),m.sub(f);let a=1/(p.x*m.y-m.x*p.y);isFinite(a)&&(h.copy(u).multiplyScalar(m.y).addScaledVector(d,-p.y).multiplyScalar(a),g.copy(d).multiplyScalar(p.x).addScaledVector(u,-m.x).multiplyScalar(a),o[e].add(h),o[t].add(h),o[r].add(h),s[e].add(g),s[t].add(g),s[r].add(g))}let v=this.groups;v.length===0&&(v=[{start:0,count:e.count}]);for(let t=0,n=v.length;t<n;++t){let n=v[t],r=n.start,i=n.count;for(let t=r,n=r+i;t<n;t+=3)_(e.getX(t+0),e.getX(t+1),e.getX(t+2))}let y=new W,b=new W,x=new W,S=new W;function C(e){x.fromBufferAttribute(r,e),S.copy(x);let t=o[e];y.copy(t),y.sub(x.multiplyScalar(x.dot(t))).normalize(),b.crossVectors(S,t);let n=b.dot(s[e])<0?-1:1;a.setXYZW(e,y.x,y.y,y.z,n)}for(let e=0,t=n.count;e<t;++e)c[e]&&C(e);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute(`position`);if(t!==void 0){let n=this.getAttribute(`normal`);if(n===void 0||n.count!==t.count)n=new On(new Float32Array(t.count*3),3),this.setAttribute(`normal`,n);else for(let e=0,t=n.count;e<t;e++)n.setXYZ(e,0,0,0);let r=new W,i=new W,a=new W,o=new W,s=new W,c=new W,l=new W,u=new W;if(e)for(let d=0,f=e.count;d<f;d+=3){let f=e.getX(d+0),p=e.getX(d+1),m=e.getX(d+2);r.fromBufferAttribute(t,f),i.fromBufferAttribute(t,p),a.fromBufferAttribute(t,m),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),o.fromBufferAttribute(n,f),s.fromBufferAttribute(n,p),c.fromBufferAttribute(n,m),o.add(l),s.add(l),c.add(l),n.setXYZ(f,o.x,o.y,o.z),n.setXYZ(p,s.x,s.y,s.z),n.setXYZ(m,c.x,c.y,c.z)}else for(let e=0,o=t.count;e<o;e+=3)r.fromBufferAttribute(t,e+0),i.fromBufferAttribute(t,e+1),a.fromBufferAttribute(t,e+2),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),n.setXYZ(e+0,l.x,l.y,l.z),n.setXYZ(e+1,l.x,l.y,l.z),n.setXYZ(e+2,l.x,l.y,l.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)Hn.fromBufferAttribute(e,t),Hn.normalize(),e.setXYZ(t,Hn.x,Hn.y,Hn.z)}toNonIndexed(){function t(e,t){let n=e.array,r=e.itemSize,i=e.normalized,a=new n.constructor(t.length*r),o=0,s=0;for(let i=0,c=t.length;i<c;i++){o=e.isInterleavedBufferAttribute?t[i]*e.data.stride+e.offset:t[i]*r;for(let e=0;e<r;e++)a[s++]=n[o++]}return new On(a,r,i)}if(this.index===null)return L(`BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed.`),this;let n=new e,r=this.index.array,i=this.attributes;for(let e in i){let a=i[e],o=t(a,r);n.setAttribute(e,o)}let a=this.morphAttributes;for(let e in a){let i=[],o=a[e];for(let e=0,n=o.length;e<n;e++){let n=o[e],a=t(n,r);i.push(a)}n.morphAttributes[e]=i}n.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let e=0,t=o.length;e<t;e++){let t=o[e];n.addGroup(t.start,t.count,t.materialIndex)}return n}toJSON(){let e={metadata:{version:4.7,type:`BufferGeometry`,generator:`BufferGeometry.toJSON`}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?`BufferGeometry`:this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let t=this.parameters;for(let n in t)t[n]!==void 0&&(e[n]=t[n]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let t in n){let r=n[t];e.data.attributes[t]=r.toJSON(e.data)}let r={},i=!1;for(let t in this.morphAttributes){let n=this.morphAttributes[t],a=[];for(let t=0,r=n.length;t<r;t++){let r=n[t];a.push(r.toJSON(e.data))}a.length>0&&(r[t]=a,i=!0)}i&&(e.data.morphAttributes=r,e.data.morphTargetsRelative=this.morphTargetsRelative);let a=this.groups;a.length>0&&(e.data.groups=JSON.parse(JSON.stringify(a)));let o=this.boundingSphere;return o!==null&&(e.data.boundingSphere=o.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let r=e.attributes;for(let e in r){let n=r[e];this.setAttribute(e,n.clone(t))}let i=e.morphAttributes;for(let e in i){let n=[],r=i[e];for(let e=0,i=r.length;e<i;e++)n.push(r[e].clone(t));this.morphAttributes[e]=n}this.morphTargetsRelative=e.morphTargetsRelative;let a=e.groups;for(let e=0,t=a.length;e<t;e++){let t=a[e];this.addGroup(t.start,t.count,t.materialIndex)}let o=e.boundingBox;o!==null&&(this.boundingBox=o.clone());let s=e.boundingSphere;return s!==null&&(this.boundingSphere=s.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:`dispose`})}},Wn=class{constructor(e,t){this.isInterleavedBuffer=!0,this.array=e,this.stride=t,this.count=e===void 0?0:e.length/t,this.usage=ne,this.updateRanges=[],this.version=0,this.uuid=ye()}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.array=new e.array.constructor(e.array),this.count=e.count,this.stride=e.stride,this.usage=e.usage,this}copyAt(e,t,n){e*=this.stride,n*=t.stride;for(let r=0,i=this.stride;r<i;r++)this.array[e+r]=t.array[n+r];return this}set(e,t=0){return this.array.set(e,t),this}clone(e){e.arrayBuffers===void 0&&(e.arrayBuffers={});let t=Gn(this.array);e.arrayBuffers[t]===void 0&&(e.arrayBuffers[t]=this.array.slice(0).buffer);let n=new this.array.constructor(e.arrayBuffers[t]),r=new this.constructor(n,this.stride);return r.setUsage(this.usage),r}onUpload(e){return this.onUploadCallback=e,this}toJSON(e){e.arrayBuffers===void 0&&(e.arrayBuffers={});let t=Gn(this.array);e.arrayBuffers[t]===void 0&&(e.arrayBuffers[t]=Array.from(new Uint32Array(this.array.slice(0).buffer)));let n={uuid:this.uuid,buffer:t,type:this.array.constructor.name,stride:this.stride};return n.usage=this.usage,n}};function Gn(e){return e.buffer._uuid===void 0&&(e.buffer._uuid=ye()),e.byteOffset===0&&e.byteLength===e.buffer.byteLength?e.buffer._uuid:e.buffer._uuid+`:`+e.byteOffset+`:`+e.byteLength}var Kn=new W,qn=class e{constructor(e,t,n,r=!1){this.isInterleavedBufferAttribute=!0,this.name=``,this.data=e,this.itemSize=t,this.offset=n,this.normalized=r,this._normalizationScale=e===void 0?void 0:Le(e.array)}get count(){return this.data.count}get array(){return this.data.array}set needsUpdate(e){this.data.needsUpdate=e}applyMatrix4(e){for(let t=0,n=this.data.count;t<n;t++)Kn.fromBufferAttribute(this,t),Kn.applyMatrix4(e),this.setXYZ(t,Kn.x,Kn.y,Kn.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)Kn.fromBufferAttribute(this,t),Kn.applyNormalMatrix(e),this.setXYZ(t,Kn.x,Kn.y,Kn.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)Kn.fromBufferAttribute(this,t),Kn.transformDirection(e),this.setXYZ(t,Kn.x,Kn.y,Kn.z);return this}getComponent(e,t){let n=this.array[e*this.data.stride+this.offset+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.data.array[e*this.data.stride+this.offset+t]=n,this}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset]=t,this}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+1]=t,this}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+2]=t,this}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+3]=t,this}getX(e){let t=this.data.array[e*this.data.stride+this.offset];return this.normalized&&(t=this._denormalize(t)),t}getY(e){let t=this.data.array[e*this.data.stride+this.offset+1];return this.normalized&&(t=this._denormalize(t)),t}getZ(e){let t=this.data.array[e*this.data.stride+this.offset+2];return this.normalized&&(t=this._denormalize(t)),t}getW(e){let t=this.data.array[e*this.data.stride+this.offset+3];return this.normalized&&(t=this._denormalize(t)),t}setXY(e,t,n){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.data.array[e+0]=t,this.data.array[e+1]=n,this}setXYZ(e,t,n,r){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=r,this}setXYZW(e,t,n,r,i){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r),i=this._normalize(i)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=r,this.data.array[e+3]=i,this}clone(t){if(t===void 0){le(`InterleavedBufferAttribute.clone(): Cloning an interleaved buffer attribute will de-interleave buffer data.`);let e=[];for(let t=0;t<this.count;t++){let n=t*this.data.stride+this.offset;for(let t=0;t<this.itemSize;t++)e.push(this.data.array[n+t])}return new On(new this.array.constructor(e),this.itemSize,this.normalized)}return t.interleavedBuffers===void 0&&(t.interleavedBuffers={}),t.interleavedBuffers[this.data.uuid]===void 0&&(t.interleavedBuffers[this.data.uuid]=this.data.clone(t)),new e(t.interleavedBuffers[this.data.uuid],this.itemSize,this.offset,this.normalized)}toJSON(e){if(e===void 0){le(`InterleavedBufferAttribute.toJSON(): Serializing an interleaved buffer attribute will de-interleave buffer data.`);let e=[];for(let t=0;t<this.count;t++){let n=t*this.data.stride+this.offset;for(let t=0;t<this.itemSize;t++)e.push(this.data.array[n+t])}return{itemSize:this.itemSize,type:this.array.constructor.name,array:e,normalized:this.normalized}}return e.interleavedBuffers===void 0&&(e.interleavedBuffers={}),e.interleavedBuffers[this.data.uuid]===void 0&&(e.interleavedBuffers[this.data.uuid]=this.data.toJSON(e)),{isInterleavedBufferAttribute:!0,itemSize:this.itemSize,data:this.data.uuid,offset:this.offset,normalized:this.normalized}}_denormalize(e){let t=this._normalizationScale;return t===void 0?Re(e,this.data.array):Math.max(e/t,-1)}_normalize(e){let t=this._normalizationScale;return t===void 0?ze(e,this.data.array):Math.round(e*t)}},Jn=new W,Yn=new W,Xn=new G,Zn=class{constructor(e=new W(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,r){return this.normal.set(e,t,n),this.constant=r,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let r=Jn.subVectors(n,t).cross(Yn.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(r,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let r=e.delta(Jn),i=this.normal.dot(r);if(i===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let a=-(e.start.dot(this.normal)+this.constant)/i;return n===!0&&(a<0||a>1)?null:t.copy(e.start).addScaledVector(r,a)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||Xn.getNormalMatrix(e),r=this.coplanarPoint(Jn).applyMatrix4(e),i=this.normal.applyMatrix3(n).normalize();return this.constant=-r.dot(i),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},Qn=0,$n=class extends me{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:Qn++}),this.uuid=ye(),this.name=``,this.type=`Material`,this.blending=1,this.side=0,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=204,this.blendDst=205,this.blendEquation=100,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new q(0,0,0),this.blendAlpha=0,this.depthFunc=3,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=519,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=te,this.stencilZFail=te,this.stencilZPass=te,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){L(`Material: parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?L(`Material: '${t}' is not a property of THREE.${this.type}.`):r&&r.isColor?r.set(n):r&&r.isVector2&&n&&n.isVector2||r&&r.isEuler&&n&&n.isEuler||r&&r.isVector3&&n&&n.isVector3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:`Material`,generator:`Material.toJSON`}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(e=>e.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function r(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}if(t){let t=r(e.textures),i=r(e.images);t.length>0&&(n.textures=t),i.length>0&&(n.images=i)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new q().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(e=>new Zn().fromJSON(e))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(this.vertexColors=typeof e.vertexColors==`number`?e.vertexColors>0:e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let t=e.normalScale;Array.isArray(t)===!1&&(t=[t,t]),this.normalScale=new H().fromArray(t)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new H().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let e=t.length;n=Array(e);for(let r=0;r!==e;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:`dispose`})}set needsUpdate(e){e===!0&&this.version++}},er=new W,tr=new W,nr=new W,rr=new W,ir=class{constructor(e=new W,t=new W(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,er)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=er.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(er.copy(this.origin).addScaledVector(this.direction,t),er.distanceToSquared(e))}distanceSqToSegment(e,t,n,r){tr.copy(e).add(t).multiplyScalar(.5),nr.copy(t).sub(e).normalize(),rr.copy(this.origin).sub(tr);let i=e.distanceTo(t)*.5,a=-this.direction.dot(nr),o=rr.dot(this.direction),s=-rr.dot(nr),c=rr.lengthSq(),l=Math.abs(1-a*a),u,d,f,p;if(l>0){if(u=a*s-o,d=a*o-s,p=i*l,u>=0){if(d>=-p){if(d<=p){let e=1/l;u*=e,d*=e,f=u*(u+a*d+2*o)+d*(a*u+d+2*s)+c}else d=i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d=-i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d<=-p?(u=Math.max(0,-(-a*i+o)),d=u>0?-i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c):d<=p?(u=0,d=Math.min(Math.max(-i,-s),i),f=d*(d+2*s)+c):(u=Math.max(0,-(a*i+o)),d=u>0?i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c)}else d=a>0?-i:i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,u),r&&r.copy(tr).addScaledVector(nr,d),f}intersectSphere(e,t){if(e.radius<0)return null;er.subVectors(e.center,this.origin);let n=er.dot(this.direction),r=er.dot(er)-n*n,i=e.radius*e.radius;if(r>i)return null;let a=Math.sqrt(i-r),o=n-a,s=n+a;return s<0?null:o<0?this.at(s,t):this.at(o,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,r,i,a,o,s,c=1/this.direction.x,l=1/this.direction.y,u=1/this.direction.z,d=this.origin;return c>=0?(n=(e.min.x-d.x)*c,r=(e.max.x-d.x)*c):(n=(e.max.x-d.x)*c,r=(e.min.x-d.x)*c),l>=0?(i=(e.min.y-d.y)*l,a=(e.max.y-d.y)*l):(i=(e.max.y-d.y)*l,a=(e.min.y-d.y)*l),n>a||i>r||((i>n||isNaN(n))&&(n=i),(a<r||isNaN(r))&&(r=a),u>=0?(o=(e.min.z-d.z)*u,s=(e.max.z-d.z)*u):(o=(e.max.z-d.z)*u,s=(e.min.z-d.z)*u),n>s||o>r)||((o>n||n!==n)&&(n=o),(s<r||r!==r)&&(r=s),r<0)?null:this.at(n>=0?n:r,t)}intersectsBox(e){return this.intersectBox(e,er)!==null}intersectTriangle(e,t,n,r,i){let a=this.origin,o=this.direction,s=o.x,c=o.y,l=o.z,u=e.x-a.x,d=e.y-a.y,f=e.z-a.z,p=t.x-a.x,m=t.y-a.y,h=t.z-a.z,g=n.x-a.x,_=n.y-a.y,v=n.z-a.z,y=Math.abs(s),b=Math.abs(c),x=Math.abs(l),S,C,w,T,E,D,O,k,A,j,M,N;if(y>=b&&y>=x?(w=s,D=u,A=p,N=g,s>=0?(S=c,C=l,T=d,E=f,O=m,k=h,j=_,M=v):(S=l,C=c,T=f,E=d,O=h,k=m,j=v,M=_)):b>=x?(w=c,D=d,A=m,N=_,c>=0?(S=l,C=s,T=f,E=u,O=h,k=p,j=v,M=g):(S=s,C=l,T=u,E=f,O=p,k=h,j=g,M=v)):(w=l,D=f,A=h,N=v,l>=0?(S=s,C=c,T=u,E=d,O=p,k=m,j=g,M=_):(S=c,C=s,T=d,E=u,O=m,k=p,j=_,M=g)),w===0)return null;let P=S/w,ee=C/w,te=1/w,F=T-P*D,ne=E-ee*D,I=O-P*A,re=k-ee*A,ie=j-P*N,ae=M-ee*N,oe=ie*re-ae*I,se=F*ae-ne*ie,ce=I*ne-re*F;if(r){if(oe<0||se<0||ce<0)return null}else if((oe<0||se<0||ce<0)&&(oe>0||se>0||ce>0))return null;let le=oe+se+ce;if(le===0)return null;let ue=te*(oe*D+se*A+ce*N);return(le>0?ue<0:ue>0)?null:this.at(ue/le,i)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},ar=class extends $n{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type=`MeshBasicMaterial`,this.color=new q(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new _t,this.combine=0,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap=`round`,this.wireframeLinejoin=`round`,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},or=new K,sr=new ir,cr=new Fn,lr=new W,ur=new W,dr=new W,fr=new W,pr=new W,mr=new W,hr=new W,gr=new W,_r=class extends Pt{constructor(e=new Un,t=new ar){super(),this.isMesh=!0,this.type=`Mesh`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}getVertexPosition(e,t){let n=this.geometry,r=n.attributes.position,i=n.morphAttributes.position,a=n.morphTargetsRelative;t.fromBufferAttribute(r,e);let o=this.morphTargetInfluences;if(i&&o){mr.set(0,0,0);for(let n=0,r=i.length;n<r;n++){let r=o[n],s=i[n];r!==0&&(pr.fromBufferAttribute(s,e),a?mr.addScaledVector(pr,r):mr.addScaledVector(pr.sub(t),r))}t.add(mr)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.material,i=this.matrixWorld;r!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),cr.copy(n.boundingSphere),cr.applyMatrix4(i),sr.copy(e.ray).recast(e.near),cr.containsPoint(sr.origin)===!1&&(sr.intersectSphere(cr,lr)===null||sr.origin.distanceToSquared(lr)>(e.far-e.near)**2)||(or.copy(i).invert(),sr.copy(e.ray).applyMatrix4(or),(n.boundingBox===null||sr.intersectsBox(n.boundingBox)!==!1)&&this._computeIntersections(e,t,sr)))}_computeIntersections(e,t,n){let r,i=this.geometry,a=this.material,o=i.index,s=i.attributes.position,c=i.attributes.uv,l=i.attributes.uv1,u=i.attributes.normal,d=i.groups,f=i.drawRange;if(o!==null){if(Array.isArray(a))for(let i=0,s=d.length;i<s;i++){let s=d[i],p=a[s.materialIndex],m=Math.max(s.start,f.start),h=Math.min(o.count,Math.min(s.start+s.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=o.getX(i),d=o.getX(i+1),f=o.getX(i+2);r=yr(this,p,e,n,c,l,u,a,d,f),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=s.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),s=Math.min(o.count,f.start+f.count);for(let d=i,f=s;d<f;d+=3){let i=o.getX(d),s=o.getX(d+1),f=o.getX(d+2);r=yr(this,a,e,n,c,l,u,i,s,f),r&&(r.faceIndex=Math.floor(d/3),t.push(r))}}}else if(s!==void 0){if(Array.isArray(a))for(let i=0,o=d.length;i<o;i++){let o=d[i],p=a[o.materialIndex],m=Math.max(o.start,f.start),h=Math.min(s.count,Math.min(o.start+o.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=i,s=i+1,d=i+2;r=yr(this,p,e,n,c,l,u,a,s,d),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=o.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),o=Math.min(s.count,f.start+f.count);for(let s=i,d=o;s<d;s+=3){let i=s,o=s+1,d=s+2;r=yr(this,a,e,n,c,l,u,i,o,d),r&&(r.faceIndex=Math.floor(s/3),t.push(r))}}}}};function vr(e,t,n,r,i,a,o,s){let c;if(c=t.side===1?r.intersectTriangle(o,a,i,!0,s):r.intersectTriangle(i,a,o,t.side===0,s),c===null)return null;gr.copy(s),gr.applyMatrix4(e.matrixWorld);let l=n.ray.origin.distanceTo(gr);return l<n.near||l>n.far?null:{distance:l,point:gr.clone(),object:e}}function yr(e,t,n,r,i,a,o,s,c,l){e.getVertexPosition(s,ur),e.getVertexPosition(c,dr),e.getVertexPosition(l,fr);let u=vr(e,t,n,r,ur,dr,fr,hr);if(u){let e=new W;rn.getBarycoord(hr,ur,dr,fr,e),i&&(u.uv=rn.getInterpolatedAttribute(i,s,c,l,e,new H)),a&&(u.uv1=rn.getInterpolatedAttribute(a,s,c,l,e,new H)),o&&(u.normal=rn.getInterpolatedAttribute(o,s,c,l,e,new W),u.normal.dot(r.direction)>0&&u.normal.multiplyScalar(-1));let t={a:s,b:c,c:l,normal:new W,materialIndex:0};rn.getNormal(ur,dr,fr,t.normal),u.face=t,u.barycoord=e}return u}var br=new rt,xr=new rt,Sr=new rt,Cr=new rt,wr=new K,Tr=new W,Er=new Fn,Dr=new K,Or=new ir,kr=class extends _r{constructor(e,t){super(e,t),this.isSkinnedMesh=!0,this.type=`SkinnedMesh`,this.bindMode=`attached`,this.bindMatrix=new K,this.bindMatrixInverse=new K,this.boundingBox=null,this.boundingSphere=null}computeBoundingBox(){let e=this.geometry;this.boundingBox===null&&(this.boundingBox=new an),this.boundingBox.makeEmpty();let t=e.getAttribute(`position`);for(let e=0;e<t.count;e++)this.getVertexPosition(e,Tr),this.boundingBox.expandByPoint(Tr)}computeBoundingSphere(){let e=this.geometry;this.boundingSphere===null&&(this.boundingSphere=new Fn),this.boundingSphere.makeEmpty();let t=e.getAttribute(`position`);for(let e=0;e<t.count;e++)this.getVertexPosition(e,Tr),this.boundingSphere.expandByPoint(Tr)}copy(e,t){return super.copy(e,t),this.bindMode=e.bindMode,this.bindMatrix.copy(e.bindMatrix),this.bindMatrixInverse.copy(e.bindMatrixInverse),this.skeleton=e.skeleton,this.boundingBox=e.boundingBox===null?null:e.boundingBox.clone(),this.boundingSphere=e.boundingSphere===null?null:e.boundingSphere.clone(),this}raycast(e,t){let n=this.material,r=this.matrixWorld;n!==void 0&&(this.boundingSphere===null&&this.computeBoundingSphere(),Er.copy(this.boundingSphere),Er.applyMatrix4(r),e.ray.intersectsSphere(Er)!==!1&&(Dr.copy(r).invert(),Or.copy(e.ray).applyMatrix4(Dr),(this.boundingBox===null||Or.intersectsBox(this.boundingBox)!==!1)&&this._computeIntersections(e,t,Or)))}getVertexPosition(e,t){return super.getVertexPosition(e,t),this.applyBoneTransform(e,t),t}bind(e,t){this.skeleton=e,t===void 0&&(this.updateMatrixWorld(!0),this.skeleton.calculateInverses(),t=this.matrixWorld),this.bindMatrix.copy(t),this.bindMatrixInverse.copy(t).invert()}pose(){this.skeleton.pose()}normalizeSkinWeights(){let e=new rt,t=this.geometry.attributes.skinWeight;for(let n=0,r=t.count;n<r;n++){e.fromBufferAttribute(t,n);let r=1/e.manhattanLength();r===1/0?e.set(1,0,0,0):e.multiplyScalar(r),t.setXYZW(n,e.x,e.y,e.z,e.w)}}updateMatrixWorld(e){super.updateMatrixWorld(e),this.bindMode===`attached`?this.bindMatrixInverse.copy(this.matrixWorld).invert():this.bindMode===`detached`?this.bindMatrixInverse.copy(this.bindMatrix).invert():L(`SkinnedMesh: Unrecognized bindMode: `+this.bindMode)}applyBoneTransform(e,t){let n=this.skeleton,r=this.geometry;xr.fromBufferAttribute(r.attributes.skinIndex,e),Sr.fromBufferAttribute(r.attributes.skinWeight,e),t.isVector4?(br.copy(t),t.set(0,0,0,0)):(br.set(t.x,t.y,t.z,1),t.set(0,0,0)),br.applyMatrix4(this.bindMatrix);for(let e=0;e<4;e++){let r=Sr.getComponent(e);if(r!==0){let i=xr.getComponent(e);wr.multiplyMatrices(n.bones[i].matrixWorld,n.boneInverses[i]),t.addScaledVector(Cr.copy(br).applyMatrix4(wr),r)}}return t.isVector4&&(t.w=br.w),t.applyMatrix4(this.bindMatrixInverse)}},Ar=class extends Pt{constructor(){super(),this.isBone=!0,this.type=`Bone`}},jr=class extends nt{constructor(e=null,t=1,n=1,i,a,o,s,c,l=r,u=r,d,f){super(null,o,s,c,l,u,i,a,d,f),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}},Mr=new K,Nr=new K,Pr=class e{constructor(e=[],t=[]){this.uuid=ye(),this.bones=e.slice(0),this.boneInverses=t,this.boneMatrices=null,this.previousBoneMatrices=null,this.boneTexture=null,this.previousBoneTexture=null,this.init()}init(){let e=this.bones,t=this.boneInverses;if(this.boneMatrices=new Float32Array(e.length*16),t.length===0)this.calculateInverses();else if(e.length!==t.length){L(`Skeleton: Number of inverse bone matrices does not match amount of bones.`),this.boneInverses=[];for(let e=0,t=this.bones.length;e<t;e++)this.boneInverses.push(new K)}}calculateInverses(){this.boneInverses.length=0;for(let e=0,t=this.bones.length;e<t;e++){let t=new K;this.bones[e]&&t.copy(this.bones[e].matrixWorld).invert(),this.boneInverses.push(t)}}pose(){for(let e=0,t=this.bones.length;e<t;e++){let t=this.bones[e];t&&t.matrixWorld.copy(this.boneInverses[e]).invert()}for(let e=0,t=this.bones.length;e<t;e++){let t=this.bones[e];t&&(t.parent&&t.parent.isBone?(t.matrix.copy(t.parent.matrixWorld).invert(),t.matrix.multiply(t.matrixWorld)):t.matrix.copy(t.matrixWorld),t.matrix.decompose(t.position,t.quaternion,t.scale))}}update(){let e=this.bones,t=this.boneInverses,n=this.boneMatrices,r=this.boneTexture;for(let r=0,i=e.length;r<i;r++){let i=e[r]?e[r].matrixWorld:Nr;Mr.multiplyMatrices(i,t[r]),Mr.toArray(n,r*16)}r!==null&&(r.needsUpdate=!0)}clone(){return new e(this.bones,this.boneInverses)}computeBoneTexture(){let e=Math.sqrt(this.bones.length*4);e=Math.ceil(e/4)*4,e=Math.max(e,4);let t=new Float32Array(e*e*4);t.set(this.boneMatrices);let n=new jr(t,e,e,_,f);return n.needsUpdate=!0,this.boneMatrices=t,this.boneTexture=n,this}getBoneByName(e){for(let t=0,n=this.bones.length;t<n;t++){let n=this.bones[t];if(n.name===e)return n}}dispose(){this.boneTexture!==null&&(this.boneTexture.dispose(),this.boneTexture=null),this.previousBoneTexture!==null&&(this.previousBoneTexture.dispose(),this.previousBoneTexture=null)}fromJSON(e,t){this.uuid=e.uuid;for(let n=0,r=e.bones.length;n<r;n++){let r=e.bones[n],i=t[r];i===void 0&&(L(`Skeleton: No bone found with UUID:`,r),i=new Ar),this.bones.push(i),this.boneInverses.push(new K().fromArray(e.boneInverses[n]))}return this.init(),this}toJSON(){let e={metadata:{version:4.7,type:`Skeleton`,generator:`Skeleton.toJSON`},bones:[],boneInverses:[]};e.uuid=this.uuid;let t=this.bones,n=this.boneInverses;for(let r=0,i=t.length;r<i;r++){let i=t[r];e.bones.push(i.uuid);let a=n[r];e.boneInverses.push(a.toArray())}return e}},Fr=class extends On{constructor(e,t,n,r=1){super(e,t,n),this.isInstancedBufferAttribute=!0,this.meshPerAttribute=r}copy(e){return super.copy(e),this.meshPerAttribute=e.meshPerAttribute,this}toJSON(){let e=super.toJSON();return e.meshPerAttribute=this.meshPerAttribute,e.isInstancedBufferAttribute=!0,e}},Ir=new K,Lr=new K,Rr=[],zr=new an,Br=new K,Vr=new _r,Hr=new Fn,Ur=class extends _r{constructor(e,t,n){super(e,t),this.isInstancedMesh=!0,this.instanceMatrix=new Fr(new Float32Array(n*16),16),this.instanceColor=null,this.morphTexture=null,this.count=n,this.boundingBox=null,this.boundingSphere=null;for(let e=0;e<n;e++)this.setMatrixAt(e,Br)}computeBoundingBox(){let e=this.geometry,t=this.count;this.boundingBox===null&&(this.boundingBox=new an),e.boundingBox===null&&e.computeBoundingBox(),this.boundingBox.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,Ir),zr.copy(e.boundingBox).applyMatrix4(Ir),this.boundingBox.union(zr)}computeBoundingSphere(){let e=this.geometry,t=this.count;this.boundingSphere===null&&(this.boundingSphere=new Fn),e.boundingSphere===null&&e.computeBoundingSphere(),this.boundingSphere.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,Ir),Hr.copy(e.boundingSphere).applyMatrix4(Ir),this.boundingSphere.union(Hr)}copy(e,t){return super.copy(e,t),this.instanceMatrix.copy(e.instanceMatrix),this.morphTexture=e.morphTexture===null?null:e.morphTexture.clone(),this.instanceColor=e.instanceColor===null?null:e.instanceColor.clone(),this.count=e.count,this.boundingBox=e.boundingBox===null?null:e.boundingBox.clone(),this.boundingSphere=e.boundingSphere===null?null:e.boundingSphere.clone(),this}getColorAt(e,t){return this.instanceColor===null?t.setRGB(1,1,1):t.fromArray(this.instanceColor.array,e*3)}getMatrixAt(e,t){return t.fromArray(this.instanceMatrix.array,e*16)}getMorphAt(e,t){let n=t.morphTargetInfluences,r=this.morphTexture.source.data.data,i=e*(n.length+1)+1;for(let e=0;e<n.length;e++)n[e]=r[i+e]}raycast(e,t){let n=this.matrixWorld,r=this.count;if(Vr.geometry=this.geometry,Vr.material=this.material,Vr.material!==void 0&&(this.boundingSphere===null&&this.computeBoundingSphere(),Hr.copy(this.boundingSphere),Hr.applyMatrix4(n),e.ray.intersectsSphere(Hr)!==!1))for(let i=0;i<r;i++){this.getMatrixAt(i,Ir),Lr.multiplyMatrices(n,Ir),Vr.matrixWorld=Lr,Vr.raycast(e,Rr);for(let e=0,n=Rr.length;e<n;e++){let n=Rr[e];n.instanceId=i,n.object=this,t.push(n)}Rr.length=0}}setColorAt(e,t){return this.instanceColor===null&&(this.instanceColor=new Fr(new Float32Array(this.instanceMatrix.count*3).fill(1),3)),t.toArray(this.instanceColor.array,e*3),this}setMatrixAt(e,t){return t.toArray(this.instanceMatrix.array,e*16),this}setMorphAt(e,t){let n=t.morphTargetInfluences,r=n.length+1;this.morphTexture===null&&(this.morphTexture=new jr(new Float32Array(r*this.count),r,this.count,b,f));let i=this.morphTexture.source.data.data,a=0;for(let e=0;e<n.length;e++)a+=n[e];let o=this.geometry.morphTargetsRelative?1:1-a,s=r*e;return i[s]=o,i.set(n,s+1),this}updateMorphTargets(){}dispose(){super.dispose(),this.instanceMatrix.dispose(),this.instanceColor!==null&&this.instanceColor.dispose(),this.morphTexture!==null&&(this.morphTexture.dispose(),this.morphTexture=null)}},Wr=new Fn,Gr=new H(.5,.5),Kr=new W,qr=class{constructor(e=new Zn,t=new Zn,n=new Zn,r=new Zn,i=new Zn,a=new Zn){this.planes=[e,t,n,r,i,a]}set(e,t,n,r,i,a){let o=this.planes;return o[0].copy(e),o[1].copy(t),o[2].copy(n),o[3].copy(r),o[4].copy(i),o[5].copy(a),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=re,n=!1){let r=this.planes,i=e.elements,a=i[0],o=i[1],s=i[2],c=i[3],l=i[4],u=i[5],d=i[6],f=i[7],p=i[8],m=i[9],h=i[10],g=i[11],_=i[12],v=i[13],y=i[14],b=i[15];if(r[0].setComponents(c-a,f-l,g-p,b-_).normalize(),r[1].setComponents(c+a,f+l,g+p,b+_).normalize(),r[2].setComponents(c+o,f+u,g+m,b+v).normalize(),r[3].setComponents(c-o,f-u,g-m,b-v).normalize(),n)r[4].setComponents(s,d,h,y).normalize(),r[5].setComponents(c-s,f-d,g-h,b-y).normalize();else if(r[4].setComponents(c-s,f-d,g-h,b-y).normalize(),t===2e3)r[5].setComponents(c+s,f+d,g+h,b+y).normalize();else if(t===2001)r[5].setComponents(s,d,h,y).normalize();else throw Error(`THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: `+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Wr.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Wr.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Wr)}intersectsSprite(e){return Wr.center.set(0,0,0),Wr.radius=.7071067811865476+Gr.distanceTo(e.center),Wr.applyMatrix4(e.matrixWorld),this.intersectsSphere(Wr)}intersectsSphere(e){let t=this.planes,n=e.center,r=-e.radius;for(let e=0;e<6;e++)if(t[e].distanceToPoint(n)<r)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let r=t[n];if(Kr.x=r.normal.x>0?e.max.x:e.min.x,Kr.y=r.normal.y>0?e.max.y:e.min.y,Kr.z=r.normal.z>0?e.max.z:e.min.z,r.distanceToPoint(Kr)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},Jr=new K,Yr=class e{constructor(){this.coordinateSystem=re,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,n=this._frustums;for(let e=0;e<t.length;e++){let r=t[e];Jr.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[e]===void 0&&(n[e]=new qr),n[e].setFromProjectionMatrix(Jr,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,n=e._frustums;for(let r=0;r<e._count;r++)t[r]===void 0&&(t[r]=new qr),t[r].copy(n[r]);return this._count=e._count,this}clone(){return new e().copy(this)}},Xr=class extends $n{constructor(e){super(),this.isLineBasicMaterial=!0,this.type=`LineBasicMaterial`,this.color=new q(16777215),this.map=null,this.linewidth=1,this.linecap=`round`,this.linejoin=`round`,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}},Zr=new W,Qr=new W,$r=new K,ei=new ir,ti=new Fn,ni=new W,ri=new W,ii=class extends Pt{constructor(e=new Un,t=new Xr){super(),this.isLine=!0,this.type=`Line`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[0];for(let e=1,r=t.count;e<r;e++)Zr.fromBufferAttribute(t,e-1),Qr.fromBufferAttribute(t,e),n[e]=n[e-1],n[e]+=Zr.distanceTo(Qr);e.setAttribute(`lineDistance`,new jn(n,1))}else L(`Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.`);return this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.matrixWorld,i=e.params.Line.threshold,a=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),ti.copy(n.boundingSphere),ti.applyMatrix4(r),ti.radius+=i,e.ray.intersectsSphere(ti)===!1)return;$r.copy(r).invert(),ei.copy(e.ray).applyMatrix4($r);let o=i/((this.scale.x+this.scale.y+this.scale.z)/3),s=o*o,c=this.isLineSegments?2:1,l=n.index,u=n.attributes.position;if(l!==null){let n=Math.max(0,a.start),r=Math.min(l.count,a.start+a.count);for(let i=n,a=r-1;i<a;i+=c){let n=l.getX(i),r=l.getX(i+1),a=ai(this,e,ei,s,n,r,i);a&&t.push(a)}if(this.isLineLoop){let i=l.getX(r-1),a=l.getX(n),o=ai(this,e,ei,s,i,a,r-1);o&&t.push(o)}}else{let n=Math.max(0,a.start),r=Math.min(u.count,a.start+a.count);for(let i=n,a=r-1;i<a;i+=c){let n=ai(this,e,ei,s,i,i+1,i);n&&t.push(n)}if(this.isLineLoop){let i=ai(this,e,ei,s,r-1,n,r-1);i&&t.push(i)}}}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}};function ai(e,t,n,r,i,a,o){let s=e.geometry.attributes.position;if(Zr.fromBufferAttribute(s,i),Qr.fromBufferAttribute(s,a),n.distanceSqToSegment(Zr,Qr,ni,ri)>r)return;ni.applyMatrix4(e.matrixWorld);let c=t.ray.origin.distanceTo(ni);if(!(c<t.near||c>t.far))return{distance:c,point:ri.clone().applyMatrix4(e.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:e}}var oi=new W,si=new W,ci=class extends ii{constructor(e,t){super(e,t),this.isLineSegments=!0,this.type=`LineSegments`}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[];for(let e=0,r=t.count;e<r;e+=2)oi.fromBufferAttribute(t,e),si.fromBufferAttribute(t,e+1),n[e]=e===0?0:n[e-1],n[e+1]=n[e]+oi.distanceTo(si);e.setAttribute(`lineDistance`,new jn(n,1))}else L(`LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.`);return this}},li=class extends ii{constructor(e,t){super(e,t),this.isLineLoop=!0,this.type=`LineLoop`}},ui=class extends $n{constructor(e){super(),this.isPointsMaterial=!0,this.type=`PointsMaterial`,this.color=new q(16777215),this.map=null,this.alphaMap=null,this.size=1,this.sizeAttenuation=!0,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.alphaMap=e.alphaMap,this.size=e.size,this.sizeAttenuation=e.sizeAttenuation,this.fog=e.fog,this}},di=new K,fi=new ir,pi=new Fn,mi=new W,hi=class extends Pt{constructor(e=new Un,t=new ui){super(),this.isPoints=!0,this.type=`Points`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.matrixWorld,i=e.params.Points.threshold,a=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),pi.copy(n.boundingSphere),pi.applyMatrix4(r),pi.radius+=i,e.ray.intersectsSphere(pi)===!1)return;di.copy(r).invert(),fi.copy(e.ray).applyMatrix4(di);let o=i/((this.scale.x+this.scale.y+this.scale.z)/3),s=o*o,c=n.index,l=n.attributes.position;if(c!==null){let n=Math.max(0,a.start),i=Math.min(c.count,a.start+a.count);for(let a=n,o=i;a<o;a++){let n=c.getX(a);mi.fromBufferAttribute(l,n),gi(mi,n,s,r,e,t,this)}}else{let n=Math.max(0,a.start),i=Math.min(l.count,a.start+a.count);for(let a=n,o=i;a<o;a++)mi.fromBufferAttribute(l,a),gi(mi,a,s,r,e,t,this)}}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}};function gi(e,t,n,r,i,a,o){let s=fi.distanceSqToPoint(e);if(s<n){let n=new W;fi.closestPointToPoint(e,n),n.applyMatrix4(r);let c=i.ray.origin.distanceTo(n);if(c<i.near||c>i.far)return;a.push({distance:c,distanceToRay:Math.sqrt(s),point:n,index:t,face:null,faceIndex:null,barycoord:null,object:o})}}var _i=class extends nt{constructor(e=[],t=301,n,r,i,a,o,s,c,l){super(e,t,n,r,i,a,o,s,c,l),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}},vi=class extends nt{constructor(e,t,n=d,i,a,o,s=r,c=r,l,u=v,f=1){if(u!==1026&&u!==1027)throw Error(`THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat`);super({width:e,height:t,depth:f},i,a,o,s,c,u,n,l),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new Qe(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},yi=class extends vi{constructor(e,t=d,n=301,i,a,o=r,s=r,c,l=v){let u={width:e,height:e,depth:1},f=[u,u,u,u,u,u];super(e,e,t,n,i,a,o,s,c,l),this.image=f,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},bi=class extends nt{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},xi=class e extends Un{constructor(e=1,t=1,n=1,r=1,i=1,a=1){super(),this.type=`BoxGeometry`,this.parameters={width:e,height:t,depth:n,widthSegments:r,heightSegments:i,depthSegments:a};let o=this;r=Math.floor(r),i=Math.floor(i),a=Math.floor(a);let s=[],c=[],l=[],u=[],d=0,f=0;p(`z`,`y`,`x`,-1,-1,n,t,e,a,i,0),p(`z`,`y`,`x`,1,-1,n,t,-e,a,i,1),p(`x`,`z`,`y`,1,1,e,n,t,r,a,2),p(`x`,`z`,`y`,1,-1,e,n,-t,r,a,3),p(`x`,`y`,`z`,1,-1,e,t,n,r,i,4),p(`x`,`y`,`z`,-1,-1,e,t,-n,r,i,5),this.setIndex(s),this.setAttribute(`position`,new jn(c,3)),this.setAttribute(`normal`,new jn(l,3)),this.setAttribute(`uv`,new jn(u,2));function p(e,t,n,r,i,a,p,m,h,g,_){let v=a/h,y=p/g,b=a/2,x=p/2,S=m/2,C=h+1,w=g+1,T=0,E=0,D=new W;for(let a=0;a<w;a++){let o=a*y-x;for(let s=0;s<C;s++)D[e]=(s*v-b)*r,D[t]=o*i,D[n]=S,c.push(D.x,D.y,D.z),D[e]=0,D[t]=0,D[n]=m>0?1:-1,l.push(D.x,D.y,D.z),u.push(s/h),u.push(1-a/g),T+=1}for(let e=0;e<g;e++)for(let t=0;t<h;t++){let n=d+t+C*e,r=d+t+C*(e+1),i=d+(t+1)+C*(e+1),a=d+(t+1)+C*e;s.push(n,r,a),s.push(r,i,a),E+=6}o.addGroup(f,E,_),f+=E,d+=T}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.depth,t.widthSegments,t.heightSegments,t.depthSegments)}},Si=class e extends Un{constructor(e=1,t=1,n=1,r=1){super(),this.type=`PlaneGeometry`,this.parameters={width:e,height:t,widthSegments:n,heightSegments:r};let i=e/2,a=t/2,o=Math.floor(n),s=Math.floor(r),c=o+1,l=s+1,u=e/o,d=t/s,f=[],p=[],m=[],h=[];for(let e=0;e<l;e++){let t=e*d-a;for(let n=0;n<c;n++){let r=n*u-i;p.push(r,-t,0),m.push(0,0,1),h.push(n/o),h.push(1-e/s)}}for(let e=0;e<s;e++)for(let t=0;t<o;t++){let n=t+c*e,r=t+c*(e+1),i=t+1+c*(e+1),a=t+1+c*e;f.push(n,r,a),f.push(r,i,a)}this.setIndex(f),this.setAttribute(`position`,new jn(p,3)),this.setAttribute(`normal`,new jn(m,3)),this.setAttribute(`uv`,new jn(h,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.widthSegments,t.heightSegments)}};function Ci(e){let t={};for(let n in e){t[n]={};for(let r in e[n]){let i=e[n][r];if(Ti(i))i.isRenderTargetTexture?(L(`UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms().`),t[n][r]=null):t[n][r]=i.clone();else if(Array.isArray(i)){if(Ti(i[0])){let e=[];for(let t=0,n=i.length;t<n;t++)e[t]=i[t].clone();t[n][r]=e}else t[n][r]=i.slice()}else t[n][r]=i}}return t}function wi(e){let t={};for(let n=0;n<e.length;n++){let r=Ci(e[n]);for(let e in r)t[e]=r[e]}return t}function Ti(e){return e&&(e.isColor||e.isMatrix3||e.isMatrix4||e.isVector2||e.isVector3||e.isVector4||e.isTexture||e.isQuaternion)}function Ei(e){let t=[];for(let n=0;n<e.length;n++)t.push(e[n].clone());return t}function Di(e){let t=e.getRenderTarget();return t===null?e.outputColorSpace:t.isXRRenderTarget===!0?t.texture.colorSpace:Ke.workingColorSpace}var Oi={clone:Ci,merge:wi},ki=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Ai=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,ji=class extends $n{constructor(e){super(),this.isShaderMaterial=!0,this.type=`ShaderMaterial`,this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=ki,this.fragmentShader=Ai,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=Ci(e.uniforms),this.uniformsGroups=Ei(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let n in this.uniforms){let r=this.uniforms[n].value;r&&r.isTexture?t.uniforms[n]={type:`t`,value:r.toJSON(e).uuid}:r&&r.isColor?t.uniforms[n]={type:`c`,value:r.getHex()}:r&&r.isVector2?t.uniforms[n]={type:`v2`,value:r.toArray()}:r&&r.isVector3?t.uniforms[n]={type:`v3`,value:r.toArray()}:r&&r.isVector4?t.uniforms[n]={type:`v4`,value:r.toArray()}:r&&r.isMatrix3?t.uniforms[n]={type:`m3`,value:r.toArray()}:r&&r.isMatrix4?t.uniforms[n]={type:`m4`,value:r.toArray()}:t.uniforms[n]={value:r}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let e in this.extensions)this.extensions[e]===!0&&(n[e]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let r=e.uniforms[n];switch(this.uniforms[n]={},r.type){case`t`:this.uniforms[n].value=t[r.value]||null;break;case`c`:this.uniforms[n].value=new q().setHex(r.value);break;case`v2`:this.uniforms[n].value=new H().fromArray(r.value);break;case`v3`:this.uniforms[n].value=new W().fromArray(r.value);break;case`v4`:this.uniforms[n].value=new rt().fromArray(r.value);break;case`m3`:this.uniforms[n].value=new G().fromArray(r.value);break;case`m4`:this.uniforms[n].value=new K().fromArray(r.value);break;default:this.uniforms[n].value=r.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let t in e.extensions)this.extensions[t]=e.extensions[t];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},Mi=class extends ji{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type=`RawShaderMaterial`}},Ni=class extends $n{constructor(e){super(),this.isMeshStandardMaterial=!0,this.type=`MeshStandardMaterial`,this.defines={STANDARD:``},this.color=new q(16777215),this.roughness=1,this.metalness=0,this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new q(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=0,this.normalScale=new H(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.roughnessMap=null,this.metalnessMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new _t,this.envMapIntensity=1,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap=`round`,this.wireframeLinejoin=`round`,this.flatShading=!1,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.defines={STANDARD:``},this.color.copy(e.color),this.roughness=e.roughness,this.metalness=e.metalness,this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.emissive.copy(e.emissive),this.emissiveMap=e.emissiveMap,this.emissiveIntensity=e.emissiveIntensity,this.bumpMap=e.bumpMap,this.bumpScale=e.bumpScale,this.normalMap=e.normalMap,this.normalMapType=e.normalMapType,this.normalScale.copy(e.normalScale),this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.roughnessMap=e.roughnessMap,this.metalnessMap=e.metalnessMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.envMapIntensity=e.envMapIntensity,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.flatShading=e.flatShading,this.fog=e.fog,this}},Pi=class extends Ni{constructor(e){super(),this.isMeshPhysicalMaterial=!0,this.defines={STANDARD:``,PHYSICAL:``},this.type=`MeshPhysicalMaterial`,this.anisotropyRotation=0,this.anisotropyMap=null,this.clearcoatMap=null,this.clearcoatRoughness=0,this.clearcoatRoughnessMap=null,this.clearcoatNormalScale=new H(1,1),this.clearcoatNormalMap=null,this.diffuseRoughnessMap=null,this.ior=1.5,Object.defineProperty(this,"reflectivity",{get:function(){return z(2.5*(this.ior-1)/(this.ior+1),0,1)},set:function(e){this.ior=(1+.4*e)/(1-.4*e)}}),this.iridescenceMap=null,this.iridescenceIOR=1.3,this.iridescenceThicknessMinimum=100,this.iridescenceThicknessMaximum=400,this.iridescenceThicknessMap=null,this.sheenColor=new q(0),this.sheenColorMap=null,this.sheenRoughness=1,this.sheenRoughnessMap=null,this.transmissionMap=null,this.thickness=0,this.thicknessMap=null,this.attenuationDistance=1/0,this.attenuationColor=new q(1,1,1),this.specularIntensity=1,this.specularIntensityMap=null,this.specularColor=new q(1,1,1),this.specularColorMap=null,this._anisotropy=0,this._clearcoat=0,this._diffuseRoughness=0,this._dispersion=0,this._iridescence=0,this._retroreflectivity=0,this._sheen=0,this._transmission=0,this.setValues(e)}get anisotropy(){return this._anisotropy}set anisotropy(e){this._anisotropy>0!=e>0&&this.version++,this._anisotropy=e}get clearcoat(){return this._clearcoat}set clearcoat(e){this._clearcoat>0!=e>0&&this.version++,this._clearcoat=e}get diffuseRoughness(){return this._diffuseRoughness}set diffuseRoughness(e){this._diffuseRoughness>0!=e>0&&this.version++,this._diffuseRoughness=e}get iridescence(){return this._iridescence}set iridescence(e){this._iridescence>0!=e>0&&this.version++,this._iridescence=e}get dispersion(){return this._dispersion}set dispersion(e){this._dispersion>0!=e>0&&this.version++,this._dispersion=e}get retroreflectivity(){return this._retroreflectivity}set retroreflectivity(e){this._retroreflectivity>0!=e>0&&this.version++,this._retroreflectivity=e}get sheen(){return this._sheen}set sheen(e){this._sheen>0!=e>0&&this.version++,this._sheen=e}get transmission(){return this._transmission}set transmission(e){this._transmission>0!=e>0&&this.version++,this._transmission=e}get iridescenceThicknessRange(){return de(`MeshPhysicalMaterial: The "iridescenceThicknessRange" property has been replaced by "iridescenceThicknessMinimum" and "iridescenceThicknessMaximum".`),[this.iridescenceThicknessMinimum,this.iridescenceThicknessMaximum]}set iridescenceThicknessRange(e){de(`MeshPhysicalMaterial: The "iridescenceThicknessRange" property has been replaced by "iridescenceThicknessMinimum" and "iridescenceThicknessMaximum".`),this.iridescenceThicknessMinimum=e[0],this.iridescenceThicknessMaximum=e[1]}copy(e){return super.copy(e),this.defines={STANDARD:``,PHYSICAL:``},this.anisotropy=e.anisotropy,this.anisotropyRotation=e.anisotropyRotation,this.anisotropyMap=e.anisotropyMap,this.clearcoat=e.clearcoat,this.clearcoatMap=e.clearcoatMap,this.clearcoatRoughness=e.clearcoatRoughness,this.clearcoatRoughnessMap=e.clearcoatRoughnessMap,this.clearcoatNormalMap=e.clearcoatNormalMap,this.clearcoatNormalScale.copy(e.clearcoatNormalScale),this.diffuseRoughness=e.diffuseRoughness,this.diffuseRoughnessMap=e.diffuseRoughnessMap,this.dispersion=e.dispersion,this.ior=e.ior,this.iridescence=e.iridescence,this.iridescenceMap=e.iridescenceMap,this.iridescenceIOR=e.iridescenceIOR,this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum,this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum,this.iridescenceThicknessMap=e.iridescenceThicknessMap,this.retroreflectivity=e.retroreflectivity,this.sheen=e.sheen,this.sheenColor.copy(e.sheenColor),this.sheenColorMap=e.sheenColorMap,this.sheenRoughness=e.sheenRoughness,this.sheenRoughnessMap=e.sheenRoughnessMap,this.transmission=e.transmission,this.transmissionMap=e.transmissionMap,this.thickness=e.thickness,this.thicknessMap=e.thicknessMap,this.attenuationDistance=e.attenuationDistance,this.attenuationColor.copy(e.attenuationColor),this.specularIntensity=e.specularIntensity,this.specularIntensityMap=e.specularIntensityMap,this.specularColor.copy(e.specularColor),this.specularColorMap=e.specularColorMap,this}},Fi=class extends $n{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type=`MeshDepthMaterial`,this.depthPacking=3200,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},Ii=class extends $n{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type=`MeshDistanceMaterial`,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function Li(e,t){return!e||e.constructor===t?e:typeof t.BYTES_PER_ELEMENT==`number`?new t(e):Array.prototype.slice.call(e)}function Ri(e){return e!==void 0&&e.inTangents!==void 0&&e.outTangents!==void 0}function zi(e){function t(t,n){return e[t]-e[n]}let n=e.length,r=Array(n);for(let e=0;e!==n;++e)r[e]=e;return r.sort(t),r}function Bi(e,t,n){let r=e.length,i=new e.constructor(r);for(let a=0,o=0;o!==r;++a){let r=n[a]*t;for(let n=0;n!==t;++n)i[o++]=e[r+n]}return i}function Vi(e,t,n,r){let i=1,a=e[0];for(;a!==void 0&&a[r]===void 0;)a=e[i++];if(a===void 0)return;let o=a[r];if(o!==void 0){if(Array.isArray(o))do o=a[r],o!==void 0&&(t.push(a.time),n.push(...o)),a=e[i++];while(a!==void 0);else if(o.toArray!==void 0)do o=a[r],o!==void 0&&(t.push(a.time),o.toArray(n,n.length)),a=e[i++];while(a!==void 0);else do o=a[r],o!==void 0&&(t.push(a.time),n.push(o)),a=e[i++];while(a!==void 0)}}var Hi=class{constructor(e,t,n,r){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=r===void 0?new t.constructor(n):r,this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this._cachedIndex,r=t[n],i=t[n-1];validate_interval:{seek:{let a;linear_scan:{forward_scan:if(!(e<r)){for(let a=n+2;;){if(r===void 0){if(e<i)break forward_scan;return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===a)break;if(i=r,r=t[++n],e<r)break seek}a=t.length;break linear_scan}if(!(e>=i)){let o=t[1];e<o&&(n=2,i=o);for(let a=n-2;;){if(i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===a)break;if(r=i,i=t[--n-1],e>=i)break seek}a=n,n=0;break linear_scan}break validate_interval}for(;n<a;){let r=n+a>>>1;e<t[r]?a=r:n=r+1}if(r=t[n],i=t[n-1],i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(r===void 0)return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,i,r)}return this.interpolate_(n,i,e,r)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,r=this.valueSize,i=e*r;for(let e=0;e!==r;++e)t[e]=n[i+e];return t}interpolate_(){throw Error(`THREE.Interpolant: Call to abstract method.`)}intervalChanged_(){}},Ui=class extends Hi{constructor(e,t,n,r){super(e,t,n,r),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:k,endingEnd:k}}intervalChanged_(e,t,n){let r=this.parameterPositions,i=e-2,a=e+1,o=r[i],s=r[a];if(o===void 0)switch(this.getSettings_().endingStart){case A:i=e,o=2*t-n;break;case j:i=r.length-2,o=t+r[i]-r[i+1];break;default:i=e,o=n}if(s===void 0)switch(this.getSettings_().endingEnd){case A:a=e,s=2*n-t;break;case j:a=1,s=n+r[1]-r[0];break;default:a=e-1,s=t}let c=(n-t)*.5,l=this.valueSize;this._weightPrev=c/(t-o),this._weightNext=c/(s-n),this._offsetPrev=i*l,this._offsetNext=a*l}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this._offsetPrev,u=this._offsetNext,d=this._weightPrev,f=this._weightNext,p=(n-t)/(r-t),m=p*p,h=m*p,g=-d*h+2*d*m-d*p,_=(1+d)*h+(-1.5-2*d)*m+(-.5+d)*p+1,v=(-1-f)*h+(1.5+f)*m+.5*p,y=f*h-f*m;for(let e=0;e!==o;++e)i[e]=g*a[l+e]+_*a[c+e]+v*a[s+e]+y*a[u+e];return i}},Wi=class extends Hi{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=(n-t)/(r-t),u=1-l;for(let e=0;e!==o;++e)i[e]=a[c+e]*u+a[s+e]*l;return i}},Gi=class extends Hi{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e){return this.copySampleValue_(e-1)}},Ki=class extends Hi{interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this.inTangents,u=this.outTangents;if(!l||!u){let e=(n-t)/(r-t),l=1-e;for(let t=0;t!==o;++t)i[t]=a[c+t]*l+a[s+t]*e;return i}let d=o*2,f=e-1;for(let p=0;p!==o;++p){let o=a[c+p],m=a[s+p],h=f*d+p*2,g=u[h],_=u[h+1],v=e*d+p*2,y=l[v],b=l[v+1],x=Yi(n,t,g,y,r);i[p]=qi(x,o,_,b,m)}return i}};function qi(e,t,n,r,i){let a=1-e;return a*a*a*t+3*a*a*e*n+3*a*e*e*r+e*e*e*i}function Ji(e,t,n,r,i){let a=1-e;return 3*a*a*(n-t)+6*a*e*(r-n)+3*e*e*(i-r)}function Yi(e,t,n,r,i){let a=(e-t)/(i-t);for(let o=0;o<8;o++){let o=qi(a,t,n,r,i)-e;if(Math.abs(o)<1e-10)break;let s=Ji(a,t,n,r,i);if(Math.abs(s)<1e-10)break;a=Math.max(0,Math.min(1,a-o/s))}return a}var Xi=class{constructor(e,t,n,r){if(e===void 0)throw Error(`THREE.KeyframeTrack: track name is undefined`);if(t===void 0||t.length===0)throw Error(`THREE.KeyframeTrack: no keyframes in track named `+e);this.name=e,this.times=Li(t,this.TimeBufferType),this.values=Li(n,this.ValueBufferType),this.setInterpolation(r||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:Li(e.times,Array),values:Li(e.values,Array)};let t=e.getInterpolation();t!==e.DefaultInterpolation&&(n.interpolation=t),Ri(e.settings)&&(n.settings={inTangents:Li(e.settings.inTangents,Array),outTangents:Li(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new Gi(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new Wi(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new Ui(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new Ki(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case T:t=this.InterpolantFactoryMethodDiscrete;break;case E:t=this.InterpolantFactoryMethodLinear;break;case D:t=this.InterpolantFactoryMethodSmooth;break;case O:t=this.InterpolantFactoryMethodBezier}if(t===void 0){let t=`unsupported interpolation for `+this.ValueTypeName+` keyframe track named `+this.name;if(this.createInterpolant===void 0){if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw Error(t)}return L(`KeyframeTrack:`,t),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return T;case this.InterpolantFactoryMethodLinear:return E;case this.InterpolantFactoryMethodSmooth:return D;case this.InterpolantFactoryMethodBezier:return O}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]+=e;Ri(this.settings)&&(Zi(this.settings.inTangents,e),Zi(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]*=e;Ri(this.settings)&&(Qi(this.settings.inTangents,e),Qi(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,r=n.length,i=0,a=r-1;for(;i!==r&&n[i]<e;)++i;for(;a!==-1&&n[a]>t;)--a;if(++a,i!==0||a!==r){i>=a&&(a=Math.max(a,1),i=a-1);let e=this.getValueSize();this.times=n.slice(i,a),this.values=this.values.slice(i*e,a*e)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(R(`KeyframeTrack: Invalid value size in track.`,this),e=!1);let n=this.times,r=this.values,i=n.length;i===0&&(R(`KeyframeTrack: Track is empty.`,this),e=!1);let a=null;for(let t=0;t!==i;t++){let r=n[t];if(typeof r==`number`&&isNaN(r)){R(`KeyframeTrack: Time is not a valid number.`,this,t,r),e=!1;break}if(a!==null&&a>r){R(`KeyframeTrack: Out of order keys.`,this,t,r,a),e=!1;break}a=r}if(r!==void 0&&ae(r))for(let t=0,n=r.length;t!==n;++t){let n=r[t];if(isNaN(n)){R(`KeyframeTrack: Value is not a valid number.`,this,t,n),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),r=this.getInterpolation()===D,i=e.length-1,a=1;for(let o=1;o<i;++o){let i=!1,s=e[o];if(s!==e[o+1]&&(o!==1||s!==e[0])){if(r)i=!0;else{let e=o*n,r=e-n,a=e+n;for(let o=0;o!==n;++o){let n=t[e+o];if(n!==t[r+o]||n!==t[a+o]){i=!0;break}}}}if(i){if(o!==a){e[a]=e[o];let r=o*n,i=a*n;for(let e=0;e!==n;++e)t[i+e]=t[r+e]}++a}}if(i>0){e[a]=e[i];for(let e=i*n,r=a*n,o=0;o!==n;++o)t[r+o]=t[e+o];++a}return a===e.length?(this.times=e,this.values=t):(this.times=e.slice(0,a),this.values=t.slice(0,a*n)),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,r=new n(this.name,e,t);return r.createInterpolant=this.createInterpolant,Ri(this.settings)&&(r.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),r}};function Zi(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]+=t}function Qi(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]*=t}Xi.prototype.ValueTypeName=``,Xi.prototype.TimeBufferType=Float32Array,Xi.prototype.ValueBufferType=Float32Array,Xi.prototype.DefaultInterpolation=E;var $i=class extends Xi{constructor(e,t,n){super(e,t,n)}};$i.prototype.ValueTypeName=`bool`,$i.prototype.ValueBufferType=Array,$i.prototype.DefaultInterpolation=T,$i.prototype.InterpolantFactoryMethodLinear=void 0,$i.prototype.InterpolantFactoryMethodSmooth=void 0;var ea=class extends Xi{constructor(e,t,n,r){super(e,t,n,r)}};ea.prototype.ValueTypeName=`color`;var ta=class extends Xi{constructor(e,t,n,r){super(e,t,n,r)}};ta.prototype.ValueTypeName=`number`;var na=class extends Hi{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=(n-t)/(r-t),c=e*o;for(let e=c+o;c!==e;c+=4)U.slerpFlat(i,0,a,c-o,a,c,s);return i}},ra=class extends Xi{constructor(e,t,n,r){super(e,t,n,r)}InterpolantFactoryMethodLinear(e){return new na(this.times,this.values,this.getValueSize(),e)}};ra.prototype.ValueTypeName=`quaternion`,ra.prototype.InterpolantFactoryMethodSmooth=void 0;var ia=class extends Xi{constructor(e,t,n){super(e,t,n)}};ia.prototype.ValueTypeName=`string`,ia.prototype.ValueBufferType=Array,ia.prototype.DefaultInterpolation=T,ia.prototype.InterpolantFactoryMethodLinear=void 0,ia.prototype.InterpolantFactoryMethodSmooth=void 0;var aa=class extends Xi{constructor(e,t,n,r){super(e,t,n,r)}};aa.prototype.ValueTypeName=`vector`;var oa=class{constructor(e=``,t=-1,n=[],r=2500){this.name=e,this.tracks=n,this.duration=t,this.blendMode=r,this.uuid=ye(),this.userData={},this.duration<0&&this.resetDuration()}static parse(e){let t=[],n=e.tracks,r=1/(e.fps||1);for(let e=0,i=n.length;e!==i;++e)t.push(ca(n[e]).scale(r));let i=new this(e.name,e.duration,t,e.blendMode);return i.uuid=e.uuid,i.userData=JSON.parse(e.userData||`{}`),i}static toJSON(e){let t=[],n=e.tracks,r={name:e.name,duration:e.duration,tracks:t,uuid:e.uuid,blendMode:e.blendMode,userData:JSON.stringify(e.userData)};for(let e=0,r=n.length;e!==r;++e)t.push(Xi.toJSON(n[e]));return r}static CreateFromMorphTargetSequence(e,t,n,r){let i=t.length,a=[];for(let e=0;e<i;e++){let o=[],s=[];o.push((e+i-1)%i,e,(e+1)%i),s.push(0,1,0);let c=zi(o);o=Bi(o,1,c),s=Bi(s,1,c),!r&&o[0]===0&&(o.push(i),s.push(s[0])),a.push(new ta(`.morphTargetInfluences[`+t[e].name+`]`,o,s).scale(1/n))}return new this(e,-1,a)}static findByName(e,t){let n=e;if(!Array.isArray(e)){let t=e;n=t.geometry&&t.geometry.animations||t.animations}for(let e=0;e<n.length;e++)if(n[e].name===t)return n[e];return null}static CreateClipsFromMorphTargetSequences(e,t,n){let r={},i=/^([\w-]*?)([\d]+)$/;for(let t=0,n=e.length;t<n;t++){let n=e[t],a=n.name.match(i);if(a&&a.length>1){let e=a[1],t=r[e];t||(r[e]=t=[]),t.push(n)}}let a=[];for(let e in r)a.push(this.CreateFromMorphTargetSequence(e,r[e],t,n));return a}resetDuration(){let e=this.tracks,t=0;for(let n=0,r=e.length;n!==r;++n){let e=this.tracks[n];t=Math.max(t,e.times[e.times.length-1])}return this.duration=t,this}trim(){for(let e=0;e<this.tracks.length;e++)this.tracks[e].trim(0,this.duration);return this}validate(){let e=!0;for(let t=0;t<this.tracks.length;t++)e&&=this.tracks[t].validate();return e}optimize(){for(let e=0;e<this.tracks.length;e++)this.tracks[e].optimize();return this}clone(){let e=[];for(let t=0;t<this.tracks.length;t++)e.push(this.tracks[t].clone());let t=new this.constructor(this.name,this.duration,e,this.blendMode);return t.userData=JSON.parse(JSON.stringify(this.userData)),t}toJSON(){return this.constructor.toJSON(this)}};function sa(e){switch(e.toLowerCase()){case`scalar`:case`double`:case`float`:case`number`:case`integer`:return ta;case`vector`:case`vector2`:case`vector3`:case`vector4`:return aa;case`color`:return ea;case`quaternion`:return ra;case`bool`:case`boolean`:return $i;case`string`:return ia}throw Error(`THREE.KeyframeTrack: Unsupported typeName: `+e)}function ca(e){if(e.type===void 0)throw Error(`THREE.KeyframeTrack: track type undefined, can not parse`);let t=sa(e.type);if(e.times===void 0){let t=[],n=[];Vi(e.keys,t,n,`value`),e.times=t,e.values=n}let n;return n=t.parse===void 0?new t(e.name,e.times,e.values,e.interpolation):t.parse(e),Ri(e.settings)&&(n.settings={inTangents:Li(e.settings.inTangents,Float32Array),outTangents:Li(e.settings.outTangents,Float32Array)}),n}var la={enabled:!1,files:{},add:function(e,t){this.enabled!==!1&&(ua(e)||(this.files[e]=t))},get:function(e){if(this.enabled!==!1&&!ua(e))return this.files[e]},remove:function(e){delete this.files[e]},clear:function(){this.files={}}};function ua(e){try{let t=e.slice(e.indexOf(`:`)+1);return new URL(t).protocol===`blob:`}catch{return!1}}var da=new class{constructor(e,t,n){let r=this,i=!1,a=0,o=0,s,c=[];this.onStart=void 0,this.onLoad=e,this.onProgress=t,this.onError=n,this._abortController=null,this.itemStart=function(e){o++,i===!1&&r.onStart!==void 0&&r.onStart(e,a,o),i=!0},this.itemEnd=function(e){a++,r.onProgress!==void 0&&r.onProgress(e,a,o),a===o&&(i=!1,r.onLoad!==void 0&&r.onLoad())},this.itemError=function(e){r.onError!==void 0&&r.onError(e)},this.resolveURL=function(e){return e=e.normalize(`NFC`),s?s(e):e},this.setURLModifier=function(e){return s=e,this},this.addHandler=function(e,t){return c.push(e,t),this},this.removeHandler=function(e){let t=c.indexOf(e);return t!==-1&&c.splice(t,2),this},this.getHandler=function(e){for(let t=0,n=c.length;t<n;t+=2){let n=c[t],r=c[t+1];if(n.global&&(n.lastIndex=0),n.test(e))return r}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||=new AbortController,this._abortController}},fa=class{constructor(e){this.manager=e===void 0?da:e,this.crossOrigin=`anonymous`,this.withCredentials=!1,this.path=``,this.resourcePath=``,this.requestHeader={},this.priority=`auto`,this.cache=`default`,typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}load(){}loadAsync(e,t){let n=this;return new Promise(function(r,i){n.load(e,r,t,i)})}parse(){}setCrossOrigin(e){return this.crossOrigin=e,this}setWithCredentials(e){return this.withCredentials=e,this}setPath(e){return this.path=e,this}setResourcePath(e){return this.resourcePath=e,this}setRequestHeader(e){return this.requestHeader=e,this}setPriority(e){return this.priority=e,this}setCache(e){return this.cache=e,this}abort(){return this}};fa.DEFAULT_MATERIAL_NAME=`__DEFAULT`;var pa={},ma=class extends Error{constructor(e,t){super(e),this.response=t}},ha=class extends fa{constructor(e){super(e),this.mimeType=``,this.responseType=``,this._abortController=new AbortController}load(e,t,n,r){e===void 0&&(e=``),this.path!==void 0&&(e=this.path+e),e=this.manager.resolveURL(e);let i=la.get(`file:${e}`);if(i!==void 0){this.manager.itemStart(e),setTimeout(()=>{t&&t(i),this.manager.itemEnd(e)},0);return}if(pa[e]!==void 0){pa[e].push({onLoad:t,onProgress:n,onError:r});return}pa[e]=[],pa[e].push({onLoad:t,onProgress:n,onError:r});let a=new Request(e,{headers:new Headers(this.requestHeader),credentials:this.withCredentials?`include`:`same-origin`,priority:this.priority,cache:this.cache,signal:typeof AbortSignal.any==`function`?AbortSignal.any([this._abortController.signal,this.manager.abortController.signal]):this._abortController.signal}),o=this.mimeType,s=this.responseType;fetch(a).then(t=>{if(t.status===200||t.status===0){if(t.status===0&&L(`FileLoader: HTTP Status 0 received.`),typeof ReadableStream>`u`||t.body===void 0||t.body.getReader===void 0)return t;let n=pa[e],r=t.body.getReader(),i=t.headers.get(`X-File-Size`)||t.headers.get(`Content-Length`),a=i?parseInt(i):0,o=a!==0,s=0,c=new ReadableStream({start(e){t();function t(){r.read().then(({done:r,value:i})=>{if(r)e.close();else{s+=i.byteLength;let r=new ProgressEvent(`progress`,{lengthComputable:o,loaded:s,total:a});for(let e=0,t=n.length;e<t;e++){let t=n[e];t.onProgress&&t.onProgress(r)}e.enqueue(i),t()}},t=>{e.error(t)})}}});return new Response(c)}throw new ma(`fetch for "${t.url}" responded with ${t.status}: ${t.statusText}`,t)}).then(e=>{switch(s){case`arraybuffer`:return e.arrayBuffer();case`blob`:return e.blob();case`document`:return e.text().then(e=>new DOMParser().parseFromString(e,o));case`json`:return e.json();default:if(o===``)return e.text();{let t=/charset="?([^;"\s]*)"?/i.exec(o),n=t&&t[1]?t[1].toLowerCase():void 0,r=new TextDecoder(n);return e.arrayBuffer().then(e=>r.decode(e))}}}).then(t=>{la.add(`file:${e}`,t);let n=pa[e];delete pa[e];for(let e=0,r=n.length;e<r;e++){let r=n[e];r.onLoad&&r.onLoad(t)}}).catch(t=>{let n=pa[e];if(n===void 0)throw this.manager.itemError(e),t;delete pa[e];for(let e=0,r=n.length;e<r;e++){let r=n[e];r.onError&&r.onError(t)}this.manager.itemError(e)}).finally(()=>{this.manager.itemEnd(e)}),this.manager.itemStart(e)}setResponseType(e){return this.responseType=e,this}setMimeType(e){return this.mimeType=e,this}abort(){return this._abortController.abort(),this._abortController=new AbortController,this}},ga=new WeakMap,_a=class extends fa{constructor(e){super(e)}load(e,t,n,r){this.path!==void 0&&(e=this.path+e),e=this.manager.resolveURL(e);let i=this,a=la.get(`image:${e}`);if(a!==void 0){if(a.complete===!0)i.manager.itemStart(e),setTimeout(function(){t&&t(a),i.manager.itemEnd(e)},0);else{let e=ga.get(a);e===void 0&&(e=[],ga.set(a,e)),e.push({onLoad:t,onError:r})}return a}let o=oe(`img`);function s(){l(),t&&t(this);let n=ga.get(this)||[];for(let e=0;e<n.length;e++){let t=n[e];t.onLoad&&t.onLoad(this)}ga.delete(this),i.manager.itemEnd(e)}function c(t){l(),r&&r(t),la.remove(`image:${e}`);let n=ga.get(this)||[];for(let e=0;e<n.length;e++){let r=n[e];r.onError&&r.onError(t)}ga.delete(this),i.manager.itemError(e),i.manager.itemEnd(e)}function l(){o.removeEventListener(`load`,s,!1),o.removeEventListener(`error`,c,!1)}return o.addEventListener(`load`,s,!1),o.addEventListener(`error`,c,!1),e.slice(0,5)!==`data:`&&this.crossOrigin!==void 0&&(o.crossOrigin=this.crossOrigin),la.add(`image:${e}`,o),i.manager.itemStart(e),o.fetchPriority=this.priority,o.src=e,o}},va=class extends fa{constructor(e){super(e)}load(e,t,n,r){let i=new nt,a=new _a(this.manager);return a.setPriority(this.priority),a.setCache(this.cache),a.setCrossOrigin(this.crossOrigin),a.setPath(this.path),a.load(e,function(e){i.image=e,i.needsUpdate=!0,t!==void 0&&t(i)},n,r),i}},ya=class extends Pt{static registerNode(e){this.prototype._lightNode=e}constructor(e,t=1){super(),this.isLight=!0,this.type=`Light`,this.color=new q(e),this.intensity=t}copy(e,t){return super.copy(e,t),this.color.copy(e.color),this.intensity=e.intensity,this}toJSON(e){let t=super.toJSON(e);return t.object.color=this.color.getHex(),t.object.intensity=this.intensity,t}},ba=class extends ya{constructor(e,t,n){super(e,n),this.isHemisphereLight=!0,this.type=`HemisphereLight`,this.position.copy(Pt.DEFAULT_UP),this.updateMatrix(),this.groundColor=new q(t)}copy(e,t){return super.copy(e,t),this.groundColor.copy(e.groundColor),this}toJSON(e){let t=super.toJSON(e);return t.object.groundColor=this.groundColor.getHex(),t}},xa=new K,Sa=new W,Ca=new W,wa=class{constructor(e){this.camera=e,this.intensity=1,this.bias=0,this.biasNode=null,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new H(512,512),this.mapType=l,this.map=null,this.mapPass=null,this.matrix=new K,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new qr,this._frameExtents=new H(1,1),this._viewportCount=1,this._viewports=[new rt(0,0,1,1)]}getViewportCount(){return this._viewportCount}getCamera(){return this.camera}getFrustum(){return this._frustum}updateMatrices(e){let t=this.camera;Sa.setFromMatrixPosition(e.matrixWorld),t.position.copy(Sa),Ca.setFromMatrixPosition(e.target.matrixWorld),t.lookAt(Ca),t.updateMatrixWorld(),this._updateMatrix(t,this.matrix,this._frustum)}_updateMatrix(e,t,n,r){xa.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),n.setFromProjectionMatrix(xa,e.coordinateSystem,e.reversedDepth);let i=this._frameExtents,a=r?r.z/i.x:1,o=r?r.w/i.y:1,s=r?r.x/i.x:0,c=r?r.y/i.y:0;e.coordinateSystem===2001||e.reversedDepth?t.set(.5*a,0,0,.5*a+s,0,.5*o,0,.5*o+c,0,0,1,0,0,0,0,1):t.set(.5*a,0,0,.5*a+s,0,.5*o,0,.5*o+c,0,0,.5,.5,0,0,0,1),t.multiply(xa)}getViewport(e){return this._viewports[e]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(e){return this.camera=e.camera.clone(),this.intensity=e.intensity,this.bias=e.bias,this.radius=e.radius,this.autoUpdate=e.autoUpdate,this.needsUpdate=e.needsUpdate,this.normalBias=e.normalBias,this.blurSamples=e.blurSamples,this.mapSize.copy(e.mapSize),this.mapType=e.mapType,this.biasNode=e.biasNode,this}clone(){return new this.constructor().copy(this)}toJSON(){let e={};return e.intensity=this.intensity,e.bias=this.bias,e.normalBias=this.normalBias,e.radius=this.radius,e.blurSamples=this.blurSamples,e.mapSize=this.mapSize.toArray(),e.mapType=this.mapType,e.camera=this.camera.toJSON(!1).object,delete e.camera.matrix,e}},Ta=new W,Ea=new U,Da=new W,Oa=class extends Pt{constructor(){super(),this.isCamera=!0,this.type=`Camera`,this.matrixWorldInverse=new K,this.projectionMatrix=new K,this.projectionMatrixInverse=new K,this.coordinateSystem=re,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(Ta,Ea,Da),Da.x===1&&Da.y===1&&Da.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Ta,Ea,Da.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(Ta,Ea,Da),Da.x===1&&Da.y===1&&Da.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Ta,Ea,Da.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},ka=new W,Aa=new H,ja=new H,Ma=class extends Oa{constructor(e=50,t=1,n=.1,r=2e3){super(),this.isPerspectiveCamera=!0,this.type=`PerspectiveCamera`,this.fov=e,this.zoom=1,this.near=n,this.far=r,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=ve*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(_e*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return ve*2*Math.atan(Math.tan(_e*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){ka.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(ka.x,ka.y).multiplyScalar(-e/ka.z),ka.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(ka.x,ka.y).multiplyScalar(-e/ka.z)}getViewSize(e,t){return this.getViewBounds(e,Aa,ja),t.subVectors(ja,Aa)}setViewOffset(e,t,n,r,i,a){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(_e*.5*this.fov)/this.zoom,n=2*t,r=this.aspect*n,i=-.5*r,a=this.view;if(this.view!==null&&this.view.enabled){let e=a.fullWidth,o=a.fullHeight;i+=a.offsetX*r/e,t-=a.offsetY*n/o,r*=a.width/e,n*=a.height/o}let o=this.filmOffset;o!==0&&(i+=e*o/this.getFilmWidth()),this.projectionMatrix.makePerspective(i,i+r,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}},Na=class extends wa{constructor(){super(new Ma(50,1,.5,500)),this.isSpotLightShadow=!0,this.focus=1,this.aspect=1}updateMatrices(e){let t=this.camera,n=ve*2*e.angle*this.focus,r=this.mapSize.width/this.mapSize.height*this.aspect,i=e.distance||t.far;(n!==t.fov||r!==t.aspect||i!==t.far)&&(t.fov=n,t.aspect=r,t.far=i,t.updateProjectionMatrix()),super.updateMatrices(e)}copy(e){return super.copy(e),this.focus=e.focus,this.aspect=e.aspect,this}toJSON(){let e=super.toJSON();return e.focus=this.focus,e.aspect=this.aspect,e}},Pa=class extends ya{constructor(e,t,n=0,r=Math.PI/3,i=0,a=2){super(e,t),this.isSpotLight=!0,this.type=`SpotLight`,this.position.copy(Pt.DEFAULT_UP),this.updateMatrix(),this.target=new Pt,this.distance=n,this.angle=r,this.penumbra=i,this.decay=a,this.map=null,this.shadow=new Na}get power(){return this.intensity*Math.PI}set power(e){this.intensity=e/Math.PI}dispose(){super.dispose(),this.shadow.dispose()}copy(e,t){return super.copy(e,t),this.distance=e.distance,this.angle=e.angle,this.penumbra=e.penumbra,this.decay=e.decay,this.target=e.target.clone(),this.map=e.map,this.shadow=e.shadow.clone(),this}toJSON(e){let t=super.toJSON(e);return t.object.distance=this.distance,t.object.angle=this.angle,t.object.decay=this.decay,t.object.penumbra=this.penumbra,t.object.target=this.target.uuid,this.map&&this.map.isTexture&&(t.object.map=this.map.toJSON(e).uuid),t.object.shadow=this.shadow.toJSON(),t}},Fa=class extends wa{constructor(){super(new Ma(90,1,.5,500)),this.isPointLightShadow=!0}},Ia=class extends ya{constructor(e,t,n=0,r=2){super(e,t),this.isPointLight=!0,this.type=`PointLight`,this.distance=n,this.decay=r,this.shadow=new Fa}get power(){return this.intensity*4*Math.PI}set power(e){this.intensity=e/(4*Math.PI)}dispose(){super.dispose(),this.shadow.dispose()}copy(e,t){return super.copy(e,t),this.distance=e.distance,this.decay=e.decay,this.shadow=e.shadow.clone(),this}toJSON(e){let t=super.toJSON(e);return t.object.distance=this.distance,t.object.decay=this.decay,t.object.shadow=this.shadow.toJSON(),t}},La=class extends Oa{constructor(e=-1,t=1,n=1,r=-1,i=.1,a=2e3){super(),this.isOrthographicCamera=!0,this.type=`OrthographicCamera`,this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=r,this.near=i,this.far=a,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,r,i,a){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,r=(this.top+this.bottom)/2,i=n-e,a=n+e,o=r+t,s=r-t;if(this.view!==null&&this.view.enabled){let e=(this.right-this.left)/this.view.fullWidth/this.zoom,t=(this.top-this.bottom)/this.view.fullHeight/this.zoom;i+=e*this.view.offsetX,a=i+e*this.view.width,o-=t*this.view.offsetY,s=o-t*this.view.height}this.projectionMatrix.makeOrthographic(i,a,o,s,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}},Ra=class extends wa{constructor(){super(new La(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}},za=class extends ya{constructor(e,t){super(e,t),this.isDirectionalLight=!0,this.type=`DirectionalLight`,this.position.copy(Pt.DEFAULT_UP),this.updateMatrix(),this.target=new Pt,this.shadow=new Ra}dispose(){super.dispose(),this.shadow.dispose()}copy(e){return super.copy(e),this.target=e.target.clone(),this.shadow=e.shadow.clone(),this}toJSON(e){let t=super.toJSON(e);return t.object.shadow=this.shadow.toJSON(),t.object.target=this.target.uuid,t}},Ba=class{static extractUrlBase(e){let t=e.lastIndexOf(`/`);return t===-1?`./`:e.slice(0,t+1)}static resolveURL(e,t){return typeof e!=`string`||e===``?``:(/^https?:\/\//i.test(t)&&/^\//.test(e)&&(t=t.replace(/(^https?:\/\/[^\/]+).*/i,`$1`)),/^(https?:)?\/\//i.test(e)||/^data:.*,.*$/i.test(e)||/^blob:.*$/i.test(e)?e:t+e)}},Va=class extends Un{constructor(){super(),this.isInstancedBufferGeometry=!0,this.type=`InstancedBufferGeometry`,this.instanceCount=1/0}copy(e){return super.copy(e),this.instanceCount=e.instanceCount,this}toJSON(){let e=super.toJSON();return e.instanceCount=this.instanceCount,e.isInstancedBufferGeometry=!0,e}},Ha=new WeakMap,Ua=class extends fa{constructor(e){super(e),this.isImageBitmapLoader=!0,typeof createImageBitmap>`u`&&L(`ImageBitmapLoader: createImageBitmap() not supported.`),typeof fetch>`u`&&L(`ImageBitmapLoader: fetch() not supported.`),this.options={premultiplyAlpha:`none`},this._abortController=new AbortController}setOptions(e){return this.options=e,this}load(e,t,n,r){e===void 0&&(e=``),this.path!==void 0&&(e=this.path+e),e=this.manager.resolveURL(e);let i=this,a=la.get(`image-bitmap:${e}`);if(a!==void 0){if(i.manager.itemStart(e),a.then){a.then(n=>{Ha.has(a)===!0?(r&&r(Ha.get(a)),i.manager.itemError(e),i.manager.itemEnd(e)):(t&&t(n),i.manager.itemEnd(e))});return}setTimeout(function(){t&&t(a),i.manager.itemEnd(e)},0);return}let o={};o.credentials=this.withCredentials||this.crossOrigin!==`anonymous`?`include`:`same-origin`,o.headers=this.requestHeader,o.priority=this.priority,o.cache=this.cache,o.signal=typeof AbortSignal.any==`function`?AbortSignal.any([this._abortController.signal,this.manager.abortController.signal]):this._abortController.signal;let s=fetch(e,o).then(function(e){return e.blob()}).then(function(e){return createImageBitmap(e,Object.assign({},i.options,{colorSpaceConversion:`none`}))}).then(function(n){return la.add(`image-bitmap:${e}`,n),t&&t(n),i.manager.itemEnd(e),n}).catch(function(t){r&&r(t),Ha.set(s,t),la.remove(`image-bitmap:${e}`),i.manager.itemError(e),i.manager.itemEnd(e)});la.add(`image-bitmap:${e}`,s),i.manager.itemStart(e)}abort(){return this._abortController.abort(),this._abortController=new AbortController,this}},Wa=-90,Ga=1,Ka=class extends Pt{constructor(e,t,n){super(),this.type=`CubeCamera`,this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let r=new Ma(Wa,Ga,e,t);r.layers=this.layers,this.add(r);let i=new Ma(Wa,Ga,e,t);i.layers=this.layers,this.add(i);let a=new Ma(Wa,Ga,e,t);a.layers=this.layers,this.add(a);let o=new Ma(Wa,Ga,e,t);o.layers=this.layers,this.add(o);let s=new Ma(Wa,Ga,e,t);s.layers=this.layers,this.add(s);let c=new Ma(Wa,Ga,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,r,i,a,o,s]=t;for(let e of t)this.remove(e);if(e===2e3)n.up.set(0,1,0),n.lookAt(1,0,0),r.up.set(0,1,0),r.lookAt(-1,0,0),i.up.set(0,0,-1),i.lookAt(0,1,0),a.up.set(0,0,1),a.lookAt(0,-1,0),o.up.set(0,1,0),o.lookAt(0,0,1),s.up.set(0,1,0),s.lookAt(0,0,-1);else if(e===2001)n.up.set(0,-1,0),n.lookAt(-1,0,0),r.up.set(0,-1,0),r.lookAt(1,0,0),i.up.set(0,0,1),i.lookAt(0,1,0),a.up.set(0,0,-1),a.lookAt(0,-1,0),o.up.set(0,-1,0),o.lookAt(0,0,1),s.up.set(0,-1,0),s.lookAt(0,0,-1);else throw Error(`THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: `+e);for(let e of t)this.add(e),e.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:r}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[i,a,o,s,c,l]=this.children,u=e.getRenderTarget(),d=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),p=e.xr.enabled;e.xr.enabled=!1;let m=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let h=!1;h=e.isWebGLRenderer===!0?e.state.buffers.depth.getReversed():e.reversedDepthBuffer,e.setRenderTarget(n,0,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,i),e.setRenderTarget(n,1,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(n,2,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,3,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,s),e.setRenderTarget(n,4,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),n.texture.mipmapsAutoUpdate=m,e.setRenderTarget(n,5,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(u,d,f),e.xr.enabled=p,n.texture.needsPMREMUpdate=!0}},qa=class extends Ma{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}},Ja=`\\[\\]\\.:\\/`,Ya=RegExp(`[\\[\\]\\.:\\/]`,`g`),Xa=`[^\\[\\]\\.:\\/]`,Za=`[^`+Ja.replace(`\\.`,``)+`]`,Qa=`((?:WC+[\\/:])*)`.replace(`WC`,Xa),$a=`(WCOD+)?`.replace(`WCOD`,Za),eo=`(?:\\.(WC+)(?:\\[(.+)\\])?)?`.replace(`WC`,Xa),to=`\\.(WC+)(?:\\[(.+)\\])?`.replace(`WC`,Xa),no=RegExp(`^`+Qa+$a+eo+to+`$`),ro=[`material`,`materials`,`bones`,`map`],io=class{constructor(e,t,n){let r=n||ao.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,r)}getValue(e,t){this.bind();let n=this._targetGroup.nCachedObjects_,r=this._bindings[n];r!==void 0&&r.getValue(e,t)}setValue(e,t){let n=this._bindings;for(let r=this._targetGroup.nCachedObjects_,i=n.length;r!==i;++r)n[r].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},ao=class e{constructor(t,n,r){this.path=n,this.parsedPath=r||e.parseTrackName(n),this.node=e.findNode(t,this.parsedPath.nodeName),this.rootNode=t,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(t,n,r){return t&&t.isAnimationObjectGroup?new e.Composite(t,n,r):new e(t,n,r)}static sanitizeNodeName(e){return e.replace(/\s/g,`_`).replace(Ya,``)}static parseTrackName(e){let t=no.exec(e);if(t===null)throw Error(`THREE.PropertyBinding: Cannot parse trackName: `+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},r=n.nodeName&&n.nodeName.lastIndexOf(`.`);if(r!==void 0&&r!==-1){let e=n.nodeName.substring(r+1);ro.indexOf(e)!==-1&&(n.nodeName=n.nodeName.substring(0,r),n.objectName=e)}if(n.propertyName===null||n.propertyName.length===0)throw Error(`THREE.PropertyBinding: can not parse propertyName from trackName: `+e);return n}static findNode(e,t){if(t===void 0||t===``||t===`.`||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(e){for(let r=0;r<e.length;r++){let i=e[r];if(i.name===t||i.uuid===t)return i;let a=n(i.children);if(a)return a}return null},r=n(e.children);if(r)return r}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)e[t++]=n[r]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let t=this.node,n=this.parsedPath,r=n.objectName,i=n.propertyName,a=n.propertyIndex;if(t||(t=e.findNode(this.rootNode,n.nodeName),this.node=t),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!t){L(`PropertyBinding: No target node found for track: `+this.path+`.`);return}if(r){let e=n.objectIndex;switch(r){case`materials`:if(!t.material){R(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.materials){R(`PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.`,this);return}t=t.material.materials;break;case`bones`:if(!t.skeleton){R(`PropertyBinding: Can not bind to bones as node does not have a skeleton.`,this);return}t=t.skeleton.bones;for(let n=0;n<t.length;n++)if(t[n].name===e){e=n;break}break;case`map`:if(`map`in t){t=t.map;break}if(!t.material){R(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.map){R(`PropertyBinding: Can not bind to material.map as node.material does not have a map.`,this);return}t=t.material.map;break;default:if(t[r]===void 0){R(`PropertyBinding: Can not bind to objectName of node undefined.`,this);return}t=t[r]}if(e!==void 0){if(t[e]===void 0){R(`PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.`,this,t);return}t=t[e]}}let o=t[i];if(o===void 0){let e=n.nodeName;R(`PropertyBinding: Trying to update property for track: `+e+`.`+i+` but it wasn't found.`,t);return}let s=this.Versioning.None;this.targetObject=t,t.isMaterial===!0?s=this.Versioning.NeedsUpdate:t.isObject3D===!0&&(s=this.Versioning.MatrixWorldNeedsUpdate);let c=this.BindingType.Direct;if(a!==void 0){if(i===`morphTargetInfluences`){if(!t.geometry){R(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.`,this);return}if(!t.geometry.morphAttributes){R(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.`,this);return}t.morphTargetDictionary[a]!==void 0&&(a=t.morphTargetDictionary[a])}c=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=a}else o.fromArray!==void 0&&o.toArray!==void 0?(c=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(c=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=i;this.getValue=this.GetterByBindingType[c],this.setValue=this.SetterByBindingTypeAndVersioning[c][s]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};ao.Composite=io,ao.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3},ao.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2},ao.prototype.GetterByBindingType=[ao.prototype._getValue_direct,ao.prototype._getValue_array,ao.prototype._getValue_arrayElement,ao.prototype._getValue_toArray],ao.prototype.SetterByBindingTypeAndVersioning=[[ao.prototype._setValue_direct,ao.prototype._setValue_direct_setNeedsUpdate,ao.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[ao.prototype._setValue_array,ao.prototype._setValue_array_setNeedsUpdate,ao.prototype._setValue_array_setMatrixWorldNeedsUpdate],[ao.prototype._setValue_arrayElement,ao.prototype._setValue_arrayElement_setNeedsUpdate,ao.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[ao.prototype._setValue_fromArray,ao.prototype._setValue_fromArray_setNeedsUpdate,ao.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var oo=new K,so=class{constructor(e,t,n=0,r=1/0){this.ray=new ir(e,t),this.near=n,this.far=r,this.camera=null,this.layers=new vt,this.params={Mesh:{},Line:{threshold:1},LOD:{},Points:{threshold:1},Sprite:{}}}set(e,t){this.ray.set(e,t)}setFromCamera(e,t){t.isPerspectiveCamera?(this.ray.origin.setFromMatrixPosition(t.matrixWorld),this.ray.direction.set(e.x,e.y,.5).unproject(t).sub(this.ray.origin).normalize(),this.camera=t):t.isOrthographicCamera?(this.ray.origin.set(e.x,e.y,t.projectionMatrix.elements[14]).unproject(t),this.ray.direction.set(0,0,-1).transformDirection(t.matrixWorld),this.camera=t):R(`Raycaster: Unsupported camera type: `+t.type)}setFromXRController(e){return oo.identity().extractRotation(e.matrixWorld),this.ray.origin.setFromMatrixPosition(e.matrixWorld),this.ray.direction.set(0,0,-1).applyMatrix4(oo),this}intersectObject(e,t=!0,n=[]){return lo(e,this,n,t),n.sort(co),n}intersectObjects(e,t=!0,n=[]){for(let r=0,i=e.length;r<i;r++)lo(e[r],this,n,t);return n.sort(co),n}};function co(e,t){return e.distance-t.distance}function lo(e,t,n,r){let i=!0;if(e.layers.test(t.layers)&&e.raycast(t,n)===!1&&(i=!1),i===!0&&r===!0){let r=e.children;for(let e=0,i=r.length;e<i;e++)lo(r[e],t,n,!0)}}(class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,r){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,r)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,r){let i=this.elements;return i[0]=e,i[2]=t,i[1]=n,i[3]=r,this}});function uo(e,t,n,r){let i=fo(r);switch(n){case 1021:return e*t;case b:return e*t/i.components*i.byteLength;case x:return e*t/i.components*i.byteLength;case S:return e*t*2/i.components*i.byteLength;case C:return e*t*2/i.components*i.byteLength;case 1022:return e*t*3/i.components*i.byteLength;case _:return e*t*4/i.components*i.byteLength;case w:return e*t*4/i.components*i.byteLength;case 33776:case 33777:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case 33778:case 33779:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case 35841:case 35843:return Math.max(e,16)*Math.max(t,8)/4;case 35840:case 35842:return Math.max(e,8)*Math.max(t,8)/2;case 36196:case 37492:case 37488:case 37489:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case 37496:case 37490:case 37491:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case 37808:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case 37809:return Math.floor((e+4)/5)*Math.floor((t+3)/4)*16;case 37810:return Math.floor((e+4)/5)*Math.floor((t+4)/5)*16;case 37811:return Math.floor((e+5)/6)*Math.floor((t+4)/5)*16;case 37812:return Math.floor((e+5)/6)*Math.floor((t+5)/6)*16;case 37813:return Math.floor((e+7)/8)*Math.floor((t+4)/5)*16;case 37814:return Math.floor((e+7)/8)*Math.floor((t+5)/6)*16;case 37815:return Math.floor((e+7)/8)*Math.floor((t+7)/8)*16;case 37816:return Math.floor((e+9)/10)*Math.floor((t+4)/5)*16;case 37817:return Math.floor((e+9)/10)*Math.floor((t+5)/6)*16;case 37818:return Math.floor((e+9)/10)*Math.floor((t+7)/8)*16;case 37819:return Math.floor((e+9)/10)*Math.floor((t+9)/10)*16;case 37820:return Math.floor((e+11)/12)*Math.floor((t+9)/10)*16;case 37821:return Math.floor((e+11)/12)*Math.floor((t+11)/12)*16;case 36492:case 36494:case 36495:return Math.ceil(e/4)*Math.ceil(t/4)*16;case 36283:case 36284:return Math.ceil(e/4)*Math.ceil(t/4)*8;case 36285:case 36286:return Math.ceil(e/4)*Math.ceil(t/4)*16}throw Error(`Unable to determine texture byte length for ${n} format.`)}function fo(e){switch(e){case l:case 1010:return{byteLength:1,components:1};case u:case 1011:case p:return{byteLength:2,components:1};case m:case h:return{byteLength:2,components:4};case d:case 1013:case f:return{byteLength:4,components:1};case 35902:case 35899:return{byteLength:4,components:3}}throw Error(`THREE.TextureUtils: Unknown texture type ${e}.`)}typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`register`,{detail:{revision:`187`}})),typeof window<`u`&&(window.__THREE__?L(`WARNING: Multiple instances of Three.js being imported.`):window.__THREE__=`187`);
/**
* @license
* Copyright 2010-2026 Three.js Authors
* SPDX-License-Identifier: MIT
*/
function po(){let e=null,t=!1,n=null,r=null;function i(t,a){r=e.requestAnimationFrame(i),n(t,a)}return{start:function(){t!==!0&&n!==null&&e!==null&&(r=e.requestAnimationFrame(i),t=!0)},stop:function(){e!==null&&e.cancelAnimationFrame(r),t=!1},setAnimationLoop:function(e){n=e},setContext:function(t){e=t}}}function mo(e){let t=new WeakMap;function n(t,n){let r=t.array,i=t.usage,a=r.byteLength,o=e.createBuffer();e.bindBuffer(n,o),e.bufferData(n,r,i),t.onUploadCallback();let s;if(r instanceof Float32Array)s=e.FLOAT;else if(typeof Float16Array<`u`&&r instanceof Float16Array)s=e.HALF_FLOAT;else if(r instanceof Uint16Array)s=t.isFloat16BufferAttribute?e.HALF_FLOAT:e.UNSIGNED_SHORT;else if(r instanceof Int16Array)s=e.SHORT;else if(r instanceof Uint32Array)s=e.UNSIGNED_INT;else if(r instanceof Int32Array)s=e.INT;else if(r instanceof Int8Array)s=e.BYTE;else if(r instanceof Uint8Array)s=e.UNSIGNED_BYTE;else if(r instanceof Uint8ClampedArray)s=e.UNSIGNED_BYTE;else throw Error(`THREE.WebGLAttributes: Unsupported buffer data format: `+r);return{buffer:o,type:s,bytesPerElement:r.BYTES_PER_ELEMENT,version:t.version,size:a}}function r(t,n,r){let i=n.array,a=n.updateRanges;if(e.bindBuffer(r,t),a.length===0)e.bufferSubData(r,0,i);else{a.sort((e,t)=>e.start-t.start);let t=0;for(let e=1;e<a.length;e++){let n=a[t],r=a[e];r.start<=n.start+n.count+1?n.count=Math.max(n.count,r.start+r.count-n.start):(++t,a[t]=r)}a.length=t+1;for(let t=0,n=a.length;t<n;t++){let n=a[t];e.bufferSubData(r,n.start*i.BYTES_PER_ELEMENT,i,n.start,n.count)}n.clearUpdateRanges()}n.onUploadCallback()}function i(e){return e.isInterleavedBufferAttribute&&(e=e.data),t.get(e)}function a(n){n.isInterleavedBufferAttribute&&(n=n.data);let r=t.get(n);r&&(e.deleteBuffer(r.buffer),t.delete(n))}function o(e,i){if(e.isInterleavedBufferAttribute&&(e=e.data),e.isGLBufferAttribute){let n=t.get(e);(!n||n.version<e.version)&&t.set(e,{buffer:e.buffer,type:e.type,bytesPerElement:e.elementSize,version:e.version});return}let a=t.get(e);if(a===void 0)t.set(e,n(e,i));else if(a.version<e.version){if(a.size!==e.array.byteLength)throw Error(`THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.`);r(a.buffer,e,i),a.version=e.version}}return{get:i,remove:a,update:o}}var J={alphahash_fragment:`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,alphahash_pars_fragment:`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,alphamap_fragment:`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,alphamap_pars_fragment:`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,alphatest_fragment:`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,alphatest_pars_fragment:`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,aomap_fragment:`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,aomap_pars_fragment:`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,batching_pars_vertex:`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,batching_vertex:`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,begin_vertex:`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,beginnormal_vertex:`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,bsdfs:`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,iridescence_fragment:`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,bumpmap_pars_fragment:`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,clipping_planes_fragment:`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,clipping_planes_pars_fragment:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,clipping_planes_pars_vertex:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,clipping_planes_vertex:`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,color_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,color_pars_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,color_pars_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,color_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,common:`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,defaultnormal_vertex:`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,displacementmap_pars_vertex:`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,displacementmap_vertex:`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,emissivemap_fragment:`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,emissivemap_pars_fragment:`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,colorspace_fragment:`gl_FragColor = linearToOutputTexel( gl_FragColor );`,colorspace_pars_fragment:`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,envmap_fragment:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,envmap_common_pars_fragment:`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,envmap_pars_fragment:`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,envmap_pars_vertex:`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,envmap_physical_pars_fragment:`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,envmap_vertex:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,fog_vertex:`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,fog_pars_vertex:`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,fog_fragment:`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,fog_pars_fragment:`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,gradientmap_pars_fragment:`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,lightmap_pars_fragment:`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,lights_lambert_fragment:`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,lights_lambert_pars_fragment:`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,lights_pars_begin:`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,lights_toon_fragment:`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,lights_toon_pars_fragment:`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,lights_phong_fragment:`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,lights_phong_pars_fragment:`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,lights_physical_fragment:`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,lights_physical_pars_fragment:`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,lights_fragment_begin:`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,lights_fragment_maps:`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,lights_fragment_end:`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,lightprobes_pars_fragment:`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,logdepthbuf_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,logdepthbuf_pars_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_pars_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,map_fragment:`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,map_pars_fragment:`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,map_particle_fragment:`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,map_particle_pars_fragment:`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,metalnessmap_fragment:`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,metalnessmap_pars_fragment:`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,morphinstance_vertex:`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,morphcolor_vertex:`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,morphnormal_vertex:`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,morphtarget_pars_vertex:`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,morphtarget_vertex:`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,normal_fragment_begin:`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,normal_fragment_maps:`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,normal_pars_fragment:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_pars_vertex:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_vertex:`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,normalmap_pars_fragment:`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,clearcoat_normal_fragment_begin:`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,clearcoat_normal_fragment_maps:`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,clearcoat_pars_fragment:`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,iridescence_pars_fragment:`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,opaque_fragment:`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,packing:`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,premultiplied_alpha_fragment:`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,project_vertex:`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,dithering_fragment:`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,dithering_pars_fragment:`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,roughnessmap_fragment:`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,roughnessmap_pars_fragment:`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,shadowmap_pars_fragment:`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,shadowmap_pars_vertex:`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,shadowmap_vertex:`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,shadowmask_pars_fragment:`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,skinbase_vertex:`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,skinning_pars_vertex:`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,skinning_vertex:`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,skinnormal_vertex:`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,specularmap_fragment:`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,specularmap_pars_fragment:`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,tonemapping_fragment:`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,tonemapping_pars_fragment:`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,transmission_fragment:`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,transmission_pars_fragment:`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,uv_pars_fragment:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_pars_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,worldpos_vertex:`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,background_vert:`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,background_frag:`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,backgroundCube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,backgroundCube_frag:`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,cube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,cube_frag:`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,depth_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,depth_frag:`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,distance_vert:`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,distance_frag:`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,equirect_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,equirect_frag:`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,linedashed_vert:`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,linedashed_frag:`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,meshbasic_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,meshbasic_frag:`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshlambert_vert:`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshlambert_frag:`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshmatcap_vert:`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,meshmatcap_frag:`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshnormal_vert:`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,meshnormal_frag:`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,meshphong_vert:`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshphong_frag:`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshphysical_vert:`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,meshphysical_frag:`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshtoon_vert:`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshtoon_frag:`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,points_vert:`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,points_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,shadow_vert:`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,shadow_frag:`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,sprite_vert:`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,sprite_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`},Y={common:{diffuse:{value:new q(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new G},alphaMap:{value:null},alphaMapTransform:{value:new G},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new G}},envmap:{envMap:{value:null},envMapRotation:{value:new G},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new G}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new G}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new G},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new G},normalScale:{value:new H(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new G},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new G}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new G}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new G}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new q(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new q(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new G},alphaTest:{value:0},uvTransform:{value:new G}},sprite:{diffuse:{value:new q(16777215)},opacity:{value:1},center:{value:new H(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new G},alphaMap:{value:null},alphaMapTransform:{value:new G},alphaTest:{value:0}}},ho={basic:{uniforms:wi([Y.common,Y.specularmap,Y.envmap,Y.aomap,Y.lightmap,Y.fog]),vertexShader:J.meshbasic_vert,fragmentShader:J.meshbasic_frag},lambert:{uniforms:wi([Y.common,Y.specularmap,Y.envmap,Y.aomap,Y.lightmap,Y.emissivemap,Y.bumpmap,Y.normalmap,Y.displacementmap,Y.fog,Y.lights,{emissive:{value:new q(0)},envMapIntensity:{value:1}}]),vertexShader:J.meshlambert_vert,fragmentShader:J.meshlambert_frag},phong:{uniforms:wi([Y.common,Y.specularmap,Y.envmap,Y.aomap,Y.lightmap,Y.emissivemap,Y.bumpmap,Y.normalmap,Y.displacementmap,Y.fog,Y.lights,{emissive:{value:new q(0)},specular:{value:new q(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:J.meshphong_vert,fragmentShader:J.meshphong_frag},standard:{uniforms:wi([Y.common,Y.envmap,Y.aomap,Y.lightmap,Y.emissivemap,Y.bumpmap,Y.normalmap,Y.displacementmap,Y.roughnessmap,Y.metalnessmap,Y.fog,Y.lights,{emissive:{value:new q(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:J.meshphysical_vert,fragmentShader:J.meshphysical_frag},toon:{uniforms:wi([Y.common,Y.aomap,Y.lightmap,Y.emissivemap,Y.bumpmap,Y.normalmap,Y.displacementmap,Y.gradientmap,Y.fog,Y.lights,{emissive:{value:new q(0)}}]),vertexShader:J.meshtoon_vert,fragmentShader:J.meshtoon_frag},matcap:{uniforms:wi([Y.common,Y.bumpmap,Y.normalmap,Y.displacementmap,Y.fog,{matcap:{value:null}}]),vertexShader:J.meshmatcap_vert,fragmentShader:J.meshmatcap_frag},points:{uniforms:wi([Y.points,Y.fog]),vertexShader:J.points_vert,fragmentShader:J.points_frag},dashed:{uniforms:wi([Y.common,Y.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:J.linedashed_vert,fragmentShader:J.linedashed_frag},depth:{uniforms:wi([Y.common,Y.displacementmap]),vertexShader:J.depth_vert,fragmentShader:J.depth_frag},normal:{uniforms:wi([Y.common,Y.bumpmap,Y.normalmap,Y.displacementmap,{opacity:{value:1}}]),vertexShader:J.meshnormal_vert,fragmentShader:J.meshnormal_frag},sprite:{uniforms:wi([Y.sprite,Y.fog]),vertexShader:J.sprite_vert,fragmentShader:J.sprite_frag},background:{uniforms:{uvTransform:{value:new G},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:J.background_vert,fragmentShader:J.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new G}},vertexShader:J.backgroundCube_vert,fragmentShader:J.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:J.cube_vert,fragmentShader:J.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:J.equirect_vert,fragmentShader:J.equirect_frag},distance:{uniforms:wi([Y.common,Y.displacementmap,{referencePosition:{value:new W},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:J.distance_vert,fragmentShader:J.distance_frag},shadow:{uniforms:wi([Y.lights,Y.fog,{color:{value:new q(0)},opacity:{value:1}}]),vertexShader:J.shadow_vert,fragmentShader:J.shadow_frag}};ho.physical={uniforms:wi([ho.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new G},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new G},clearcoatNormalScale:{value:new H(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new G},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new G},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new G},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new G},sheen:{value:0},sheenColor:{value:new q(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new G},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new G},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new G},transmissionSamplerSize:{value:new H},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new G},attenuationDistance:{value:0},attenuationColor:{value:new q(0)},specularColor:{value:new q(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new G},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new G},anisotropyVector:{value:new H},anisotropyMap:{value:null},anisotropyMapTransform:{value:new G}}]),vertexShader:J.meshphysical_vert,fragmentShader:J.meshphysical_frag};var go={r:0,b:0,g:0},_o=new K,vo=new G;vo.set(-1,0,0,0,1,0,0,0,1);function yo(e,t,n,r,i,a){let o=new q(0),s=i===!0?0:1,c,l,u=null,d=0,f=null;function p(e){let n=e.isScene===!0?e.background:null;if(n&&n.isTexture){let r=e.backgroundBlurriness>0;n=t.get(n,r)}return n}function m(t){let r=!1,i=p(t);i===null?g(o,s):i&&i.isColor&&(g(i,1),r=!0);let c=e.xr.getEnvironmentBlendMode();c===`additive`?n.buffers.color.setClear(0,0,0,1,a):c===`alpha-blend`&&n.buffers.color.setClear(0,0,0,0,a),(e.autoClear||r)&&(n.buffers.depth.setTest(!0),n.buffers.depth.setMask(!0),n.buffers.color.setMask(!0),e.clear(e.autoClearColor,e.autoClearDepth,e.autoClearStencil))}function h(t,n){let i=p(n);i&&i.isCubeTexture?(l===void 0&&(l=new _r(new xi(1,1,1),new ji({name:`BackgroundCubeMaterial`,uniforms:Ci(ho.backgroundCube.uniforms),vertexShader:ho.backgroundCube.vertexShader,fragmentShader:ho.backgroundCube.fragmentShader,side:1,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute(`normal`),l.geometry.deleteAttribute(`uv`),l.onBeforeRender=function(e,t,n){this.matrixWorld.copyPosition(n.matrixWorld)},Object.defineProperty(l.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),r.update(l)),l.material.uniforms.envMap.value=i,l.material.uniforms.backgroundBlurriness.value=n.backgroundBlurriness,l.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,l.material.uniforms.backgroundRotation.value.setFromMatrix4(_o.makeRotationFromEuler(n.backgroundRotation)).transpose(),i.isRenderTargetTexture===!1&&l.material.uniforms.backgroundRotation.value.premultiply(vo),l.material.toneMapped=Ke.getTransfer(i.colorSpace)!==ee,(u!==i||d!==i.version||f!==e.toneMapping)&&(l.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),l.layers.enableAll(),t.unshift(l,l.geometry,l.material,0,0,null)):i&&i.isTexture&&(c===void 0&&(c=new _r(new Si(2,2),new ji({name:`BackgroundMaterial`,uniforms:Ci(ho.background.uniforms),vertexShader:ho.background.vertexShader,fragmentShader:ho.background.fragmentShader,side:0,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute(`normal`),Object.defineProperty(c.material,"map",{get:function(){return this.uniforms.t2D.value}}),r.update(c)),c.material.uniforms.t2D.value=i,c.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,c.material.toneMapped=Ke.getTransfer(i.colorSpace)!==ee,i.matrixAutoUpdate===!0&&i.updateMatrix(),c.material.uniforms.uvTransform.value.copy(i.matrix),(u!==i||d!==i.version||f!==e.toneMapping)&&(c.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),c.layers.enableAll(),t.unshift(c,c.geometry,c.material,0,0,null))}function g(t,r){t.getRGB(go,Di(e)),n.buffers.color.setClear(go.r,go.g,go.b,r,a)}function _(){l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0),c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0)}return{getClearColor:function(){return o},setClearColor:function(e,t=1){o.set(e),s=t,g(o,s)},getClearAlpha:function(){return s},setClearAlpha:function(e){s=e,g(o,s)},render:m,addToRenderList:h,dispose:_}}function bo(e,t){let n=e.getParameter(e.MAX_VERTEX_ATTRIBS),r={},i=f(null),a=i,o=!1;function s(n,r,i,s,c){let u=!1,f=d(n,s,i,r);a!==f&&(a=f,l(a.object)),u=p(n,s,i,c),u&&m(n,s,i,c),c!==null&&t.update(c,e.ELEMENT_ARRAY_BUFFER),(u||o)&&(o=!1,b(n,r,i,s),c!==null&&e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,t.get(c).buffer))}function c(){return e.createVertexArray()}function l(t){return e.bindVertexArray(t)}function u(t){return e.deleteVertexArray(t)}function d(e,t,n,i){let a=i.wireframe===!0,o=r[t.id];o===void 0&&(o={},r[t.id]=o);let s=e.isInstancedMesh===!0?e.id:0,l=o[s];l===void 0&&(l={},o[s]=l);let u=l[n.id];u===void 0&&(u={},l[n.id]=u);let d=u[a];return d===void 0&&(d=f(c()),u[a]=d),d}function f(e){let t=[],r=[],i=[];for(let e=0;e<n;e++)t[e]=0,r[e]=0,i[e]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:t,enabledAttributes:r,attributeDivisors:i,object:e,attributes:{},index:null}}function p(e,t,n,r){let i=a.attributes,o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=i[t],r=o[t];if(r===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(r=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(r=e.instanceColor)),n===void 0||n.attribute!==r||r&&n.data!==r.data)return!0;s++}return a.attributesNum!==s||a.index!==r}function m(e,t,n,r){let i={},o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=o[t];n===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(n=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(n=e.instanceColor));let r={};r.attribute=n,n&&n.data&&(r.data=n.data),i[t]=r,s++}a.attributes=i,a.attributesNum=s,a.index=r}function h(){let e=a.newAttributes;for(let t=0,n=e.length;t<n;t++)e[t]=0}function g(e){_(e,0)}function _(t,n){let r=a.newAttributes,i=a.enabledAttributes,o=a.attributeDivisors;r[t]=1,i[t]===0&&(e.enableVertexAttribArray(t),i[t]=1),o[t]!==n&&(e.vertexAttribDivisor(t,n),o[t]=n)}function v(){let t=a.newAttributes,n=a.enabledAttributes;for(let r=0,i=n.length;r<i;r++)n[r]!==t[r]&&(e.disableVertexAttribArray(r),n[r]=0)}function y(t,n,r,i,a,o,s){s===!0?e.vertexAttribIPointer(t,n,r,a,o):e.vertexAttribPointer(t,n,r,i,a,o)}function b(n,r,i,a){h();let o=a.attributes,s=i.getAttributes(),c=r.defaultAttributeValues;for(let r in s){let i=s[r];if(i.location>=0){let s=o[r];if(s===void 0&&(r===`instanceMatrix`&&n.instanceMatrix&&(s=n.instanceMatrix),r===`instanceColor`&&n.instanceColor&&(s=n.instanceColor)),s!==void 0){let r=s.normalized,o=s.itemSize,c=t.get(s);if(c===void 0)continue;let l=c.buffer,u=c.type,d=c.bytesPerElement,f=u===e.INT||u===e.UNSIGNED_INT||s.gpuType===1013;if(s.isInterleavedBufferAttribute){let t=s.data,c=t.isInterleavedBuffer===!0?t.stride:t.itemSize,p=s.offset;if(t.isInstancedInterleavedBuffer||t.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,t.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=t.meshPerAttribute*t.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,c*d,(p+o/i.locationSize*e)*d,f)}else{if(s.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,s.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=s.meshPerAttribute*s.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,o*d,o/i.locationSize*e*d,f)}}else if(c!==void 0){let t=c[r];if(t!==void 0)switch(t.length){case 2:e.vertexAttrib2fv(i.location,t);break;case 3:e.vertexAttrib3fv(i.location,t);break;case 4:e.vertexAttrib4fv(i.location,t);break;default:e.vertexAttrib1fv(i.location,t)}}}}v()}function x(){T();for(let e in r){let t=r[e];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e]}}function S(e){if(r[e.id]===void 0)return;let t=r[e.id];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e.id]}function C(e){for(let t in r){let n=r[t];for(let t in n){let r=n[t];if(r[e.id]===void 0)continue;let i=r[e.id];for(let e in i)u(i[e].object),delete i[e];delete r[e.id]}}}function w(e){for(let t in r){let n=r[t],i=e.isInstancedMesh===!0?e.id:0,a=n[i];if(a!==void 0){for(let e in a){let t=a[e];for(let e in t)u(t[e].object),delete t[e];delete a[e]}delete n[i],Object.keys(n).length===0&&delete r[t]}}}function T(){E(),o=!0,a!==i&&(a=i,l(a.object))}function E(){i.geometry=null,i.program=null,i.wireframe=!1}return{setup:s,reset:T,resetDefaultState:E,dispose:x,releaseStatesOfGeometry:S,releaseStatesOfObject:w,releaseStatesOfProgram:C,initAttributes:h,enableAttribute:g,disableUnusedAttributes:v}}function xo(e,t,n){let r;function i(e){r=e}function a(t,i){e.drawArrays(r,t,i),n.update(i,r,1)}function o(t,i,a){a!==0&&(e.drawArraysInstanced(r,t,i,a),n.update(i,r,a))}function s(e,i,a){if(a===0)return;t.get(`WEBGL_multi_draw`).multiDrawArraysWEBGL(r,e,0,i,0,a);let o=0;for(let e=0;e<a;e++)o+=i[e];n.update(o,r,1)}this.setMode=i,this.render=a,this.renderInstances=o,this.renderMultiDraw=s}function So(e,t,n,r){let i;function a(){if(i!==void 0)return i;if(t.has(`EXT_texture_filter_anisotropic`)===!0){let n=t.get(`EXT_texture_filter_anisotropic`);i=e.getParameter(n.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else i=0;return i}function o(t){return t===1023||r.convert(t)===e.getParameter(e.IMPLEMENTATION_COLOR_READ_FORMAT)}function s(n){let i=n===1016&&(t.has(`EXT_color_buffer_half_float`)||t.has(`EXT_color_buffer_float`));return!(n!==1009&&n!==1015&&!i&&r.convert(n)!==e.getParameter(e.IMPLEMENTATION_COLOR_READ_TYPE))}function c(t){if(t===`highp`){if(e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.HIGH_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.HIGH_FLOAT).precision>0)return`highp`;t=`mediump`}return t===`mediump`&&e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.MEDIUM_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.MEDIUM_FLOAT).precision>0?`mediump`:`lowp`}let l=n.precision===void 0?`highp`:n.precision,u=c(l);u!==l&&(L(`WebGLRenderer:`,l,`not supported, using`,u,`instead.`),l=u);let d=n.reversedDepthBuffer===!0&&t.has(`EXT_clip_control`),f=n.logarithmicDepthBuffer===!0&&d===!1;n.reversedDepthBuffer===!0&&d===!1&&L(`WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer.`),n.logarithmicDepthBuffer===!0&&d===!0&&L(`WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.`);let p=e.getParameter(e.MAX_TEXTURE_IMAGE_UNITS),m=e.getParameter(e.MAX_VERTEX_TEXTURE_IMAGE_UNITS),h=e.getParameter(e.MAX_TEXTURE_SIZE),g=e.getParameter(e.MAX_CUBE_MAP_TEXTURE_SIZE),_=e.getParameter(e.MAX_VERTEX_ATTRIBS),v=e.getParameter(e.MAX_VERTEX_UNIFORM_VECTORS),y=e.getParameter(e.MAX_VARYING_VECTORS),b=e.getParameter(e.MAX_FRAGMENT_UNIFORM_VECTORS),x=e.getParameter(e.MAX_SAMPLES),S=e.getParameter(e.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:a,getMaxPrecision:c,textureFormatReadable:o,textureTypeReadable:s,precision:l,logarithmicDepthBuffer:f,reversedDepthBuffer:d,maxTextures:p,maxVertexTextures:m,maxTextureSize:h,maxCubemapSize:g,maxAttributes:_,maxVertexUniforms:v,maxVaryings:y,maxFragmentUniforms:b,maxSamples:x,samples:S}}function Co(e){let t=this,n=null,r=0,i=!1,a=!1,o=new Zn,s=new G,c={value:null,needsUpdate:!1};this.uniform=c,this.numPlanes=0,this.numIntersection=0,this.init=function(e,t){let n=e.length!==0||t||r!==0||i;return i=t,r=e.length,n},this.beginShadows=function(){a=!0,u(null)},this.endShadows=function(){a=!1},this.setGlobalState=function(e,t){n=u(e,t,0)},this.setState=function(t,o,s){let d=t.clippingPlanes,f=t.clipIntersection,p=t.clipShadows,m=e.get(t);if(!i||d===null||d.length===0||a&&!p)a?u(null):l();else{let e=a?0:r,t=e*4,i=m.clippingState||null;c.value=i,i=u(d,o,t,s);for(let e=0;e!==t;++e)i[e]=n[e];m.clippingState=i,this.numIntersection=f?this.numPlanes:0,this.numPlanes+=e}};function l(){c.value!==n&&(c.value=n,c.needsUpdate=r>0),t.numPlanes=r,t.numIntersection=0}function u(e,n,r,i){let a=e===null?0:e.length,l=null;if(a!==0){if(l=c.value,i!==!0||l===null){let t=r+a*4,i=n.matrixWorldInverse;s.getNormalMatrix(i),(l===null||l.length<t)&&(l=new Float32Array(t));for(let t=0,n=r;t!==a;++t,n+=4)o.copy(e[t]).applyMatrix4(i,s),o.normal.toArray(l,n),l[n+3]=o.constant}c.value=l,c.needsUpdate=!0}return t.numPlanes=a,t.numIntersection=0,l}}var wo=class extends at{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},r=[n,n,n,n,n,n];this.texture=new _i(r),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},r=new xi(5,5,5),i=new ji({name:`CubemapFromEquirect`,uniforms:Ci(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:1,blending:0});i.uniforms.tEquirect.value=t;let a=new _r(r,i),s=t.minFilter;return t.minFilter===1008&&(t.minFilter=o),new Ka(1,10,this).update(e,a),t.minFilter=s,a.geometry.dispose(),a.material.dispose(),this}clear(e,t=!0,n=!0,r=!0){let i=e.getRenderTarget();for(let i=0;i<6;i++)e.setRenderTarget(this,i),e.clear(t,n,r);e.setRenderTarget(i)}},To=256,Eo=3,Do=20,Oo=256,ko=16,Ao=3,jo=new W,Mo=new q,No=class e{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new Ka(1,10,null),this._boxMesh=new _r(new xi(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,n=.1,r=100,i={}){let{size:a=256,position:o=jo}=i,s=this._renderer;this._setSize(a);let c=this._allocateTarget(),l=this._getSourceTarget(!0);t>0&&(l.texture.mipmapsAutoUpdate=!1);let u=s.autoClear,d=s.autoClearColor,f=s.autoClearDepth,p=s.autoClearStencil,m=e.background;s.autoClear=!0,s.autoClearColor=!0,s.autoClearDepth=!0,s.autoClearStencil=!0,m===null&&(e.background=s.getClearColor(Mo));let h=new Ka(n,r,l);return h.position.copy(o),h.update(s,e),s.autoClear=u,s.autoClearColor=d,s.autoClearDepth=f,s.autoClearStencil=p,e.background=m,t>0&&(l.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=Bo(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=zo(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(To,Ie(e))}_fromTexture(e,t){e.mapping===301||e.mapping===302?this._setSize(e.image.length===0?To:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let n=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(n),n}_allocateTarget(){let e=this._cubeSize,t=Po(e,!1,!1),n=Math.log2(e)-Eo;for(let r=0;r<=n;r++)t.texture.mipmaps.push({width:e>>r,height:e>>r});return t.texture.name=`PMREM`,t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=Po(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,n){let r=this._boxMesh,i=this._cubeCamera;r.material=n,i.renderTarget=e,i.activeMipmapLevel=t;let a=e.width>>t;e.viewport.set(0,0,a,a),i.update(this._renderer,r),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===301||e.mapping===302?(this._cubemapMaterial===null&&(this._cubemapMaterial=Bo()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=zo()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(t){this._ggxMaterial===null&&(this._ggxMaterial=Io(),this._integrationMaterial=Lo());let n=this._cubeSize,r=t.texture.mipmaps.length-1,i=this._ggxMaterial.uniforms;i.envMap.value=this._sourceTarget.texture;let a=this._integrationMaterial.uniforms;a.envMap.value=this._sourceTarget.texture,a.sourceLod.value=Math.log2(n/ko);for(let o=0;o<=r;o++){let s=e.lodToRoughness(o,r);if(o>r-Ao)a.roughness.value=s,this._renderCube(t,o,this._integrationMaterial);else{let e=s>0?Math.log2(n)+.5*Math.log2(6/(Oo*s**4))+.5:0;i.roughness.value=s,i.lodBias.value=e,this._renderCube(t,o,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=Ro());let n=this._blurMaterial,r=n.uniforms,i=this._sourceTarget;r.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,r.envMap.value=i.texture,this._renderCube(e,0,n),r.envMap.value=e.texture,this._renderCube(i,0,n)}};function Po(e,t,n){return new wo(e,{minFilter:c,generateMipmaps:t,type:p,colorSpace:N,depthBuffer:n})}function Fo(e,t,n){return new ji({name:e,uniforms:t,vertexShader:J.cube_vert,fragmentShader:n,side:1,blending:0,depthTest:!1,depthWrite:!1})}function Io(){return Fo(`PMREMGGXConvolution`,{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${Oo}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function Lo(){return Fo(`PMREMGGXIntegration`,{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:ko}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function Ro(){return Fo(`PMREMSphericalGaussianBlur`,{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${Do}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function zo(){return Fo(`PMREMEquirectangularToCubemap`,{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function Bo(){return Fo(`PMREMCubemapToCubemap`,{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function Vo(e){let t=new WeakMap,n=new WeakMap,r=null;function i(e,t=!1){return e==null?null:t?o(e):a(e)}function a(n){if(n&&n.isTexture){let r=n.mapping;if(r===303||r===304){if(t.has(n)){let e=t.get(n).texture;return s(e,n.mapping)}{let r=n.image;if(r&&r.height>0){let i=new wo(r.height);return i.fromEquirectangularTexture(e,n),t.set(n,i),n.addEventListener(`dispose`,l),s(i.texture,n.mapping)}return null}}}return n}function o(t){if(t&&t.isTexture&&t.isPMREMTexture!==!0){let i=t.mapping,a=i===303||i===304,o=i===301||i===302;if(a||o){let i=n.get(t),s=i===void 0?0:i.texture.pmremVersion;if(t.isRenderTargetTexture&&t.pmremVersion!==s)return r===null&&(r=new No(e)),i=a?r.fromEquirectangular(t,i):r.fromCubemap(t,i),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),i.texture;if(i!==void 0)return i.texture;{let s=t.image;return a&&s&&s.height>0||o&&s&&c(s)?(r===null&&(r=new No(e)),i=a?r.fromEquirectangular(t):r.fromCubemap(t),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),t.addEventListener(`dispose`,u),i.texture):null}}}return t}function s(e,t){return t===303?e.mapping=301:t===304&&(e.mapping=302),e}function c(e){let t=0;for(let n=0;n<6;n++)e[n]!==void 0&&t++;return t===6}function l(e){let n=e.target;n.removeEventListener(`dispose`,l);let r=t.get(n);r!==void 0&&(t.delete(n),r.dispose())}function u(e){let t=e.target;t.removeEventListener(`dispose`,u);let r=n.get(t);r!==void 0&&(n.delete(t),r.dispose())}function d(){t=new WeakMap,n=new WeakMap,r!==null&&(r.dispose(),r=null)}return{get:i,dispose:d}}function Ho(e){let t={};function n(n){if(t[n]!==void 0)return t[n];let r=e.getExtension(n);return t[n]=r,r}return{has:function(e){return n(e)!==null},init:function(){n(`EXT_color_buffer_float`),n(`WEBGL_clip_cull_distance`),n(`OES_texture_float_linear`),n(`EXT_color_buffer_half_float`),n(`WEBGL_multisampled_render_to_texture`),n(`WEBGL_render_shared_exponent`)},get:function(e){let t=n(e);return t===null&&de(`WebGLRenderer: `+e+` extension not supported.`),t}}}function Uo(e,t,n,r){let i={},a=new WeakMap,o=new FinalizationRegistry(e=>delete i[e]);function s(e){c(e.target)}function c(e){e.index!==null&&t.remove(e.index);for(let n in e.attributes)t.remove(e.attributes[n]);e.removeEventListener(`dispose`,s),delete i[e.id],o.unregister(e);let c=a.get(e);c&&(t.remove(c),a.delete(e)),r.releaseStatesOfGeometry(e),e.isInstancedBufferGeometry===!0&&delete e._maxInstanceCount,n.memory.geometries--}function l(e,t){return i[t.id]===void 0&&(t.addEventListener(`dispose`,s),i[t.id]=new WeakRef(t),o.register(t,t.id,t),n.memory.geometries++),t}function u(n){let r=n.attributes;for(let n in r)t.update(r[n],e.ARRAY_BUFFER)}function d(e){let n=e.index,r=e.attributes.position,i=0;if(r===void 0)return;let o=n===null?r.array.length/3-1:n.array.length,s=new(r.count>=65535?An:kn)(Math.ceil(o/3)*6,1),c=s.array;if(n!==null){let e=n.array;i=n.version;for(let t=0,n=0;t<o;t+=3){let r=e[t+0],i=e[t+1],a=e[t+2];c[n++]=r,c[n++]=i,c[n++]=i,c[n++]=a,c[n++]=a,c[n++]=r}}else{i=r.version;for(let e=0,t=0;e<o;e+=3){let n=e+0,r=e+1,i=e+2;c[t++]=n,c[t++]=r,c[t++]=r,c[t++]=i,c[t++]=i,c[t++]=n}}s.version=i;let l=a.get(e);l&&t.remove(l),a.set(e,s)}function f(e){let t=a.get(e);if(t){let n=e.index;n!==null&&t.version<n.version&&d(e)}else d(e);return a.get(e)}function p(){for(let e in i){let t=i[e].deref();t!==void 0&&c(t)}}return{get:l,update:u,getWireframeAttribute:f,dispose:p}}function Wo(e,t,n){let r;function i(e){r=e}let a,o;function s(e){a=e.type,o=e.bytesPerElement}function c(t,i){e.drawElements(r,i,a,t*o),n.update(i,r,1)}function l(t,i,s){s!==0&&(e.drawElementsInstanced(r,i,a,t*o,s),n.update(i,r,s))}function u(e,i,o){if(o===0)return;t.get(`WEBGL_multi_draw`).multiDrawElementsWEBGL(r,i,0,a,e,0,o);let s=0;for(let e=0;e<o;e++)s+=i[e];n.update(s,r,1)}this.setMode=i,this.setIndex=s,this.render=c,this.renderInstances=l,this.renderMultiDraw=u}function Go(e){let t={geometries:0,textures:0},n={frame:0,calls:0,triangles:0,points:0,lines:0};function r(t,r,i){switch(n.calls++,r){case e.TRIANGLES:n.triangles+=t/3*i;break;case e.LINES:n.lines+=t/2*i;break;case e.LINE_STRIP:n.lines+=i*(t-1);break;case e.LINE_LOOP:n.lines+=i*t;break;case e.POINTS:n.points+=i*t;break;default:R(`WebGLInfo: Unknown draw mode:`,r)}}function i(){n.calls=0,n.triangles=0,n.points=0,n.lines=0}return{memory:t,render:n,programs:null,autoReset:!0,reset:i,update:r}}function Ko(e,t,n){let r=new WeakMap,i=new rt;function a(a,o,s){let c=a.morphTargetInfluences,l=o.morphAttributes.position||o.morphAttributes.normal||o.morphAttributes.color,u=l===void 0?0:l.length,d=r.get(o);if(d===void 0||d.count!==u){d!==void 0&&d.texture.dispose();let e=o.morphAttributes.position!==void 0,n=o.morphAttributes.normal!==void 0,a=o.morphAttributes.color!==void 0,s=o.morphAttributes.position||[],c=o.morphAttributes.normal||[],l=o.morphAttributes.color||[],p=0;e===!0&&(p=1),n===!0&&(p=2),a===!0&&(p=3);let m=o.attributes.position.count*p,h=1;m>t.maxTextureSize&&(h=Math.ceil(m/t.maxTextureSize),m=t.maxTextureSize);let g=new Float32Array(m*h*4*u),_=new ot(g,m,h,u);_.type=f,_.needsUpdate=!0;let v=p*4;for(let t=0;t<u;t++){let r=s[t],o=c[t],u=l[t],d=m*h*4*t;for(let t=0;t<r.count;t++){let s=t*v;e===!0&&(i.fromBufferAttribute(r,t),g[d+s+0]=i.x,g[d+s+1]=i.y,g[d+s+2]=i.z,g[d+s+3]=0),n===!0&&(i.fromBufferAttribute(o,t),g[d+s+4]=i.x,g[d+s+5]=i.y,g[d+s+6]=i.z,g[d+s+7]=0),a===!0&&(i.fromBufferAttribute(u,t),g[d+s+8]=i.x,g[d+s+9]=i.y,g[d+s+10]=i.z,g[d+s+11]=u.itemSize===4?i.w:1)}}d={count:u,texture:_,size:new H(m,h)},r.set(o,d);function y(){_.dispose(),r.delete(o),o.removeEventListener(`dispose`,y)}o.addEventListener(`dispose`,y)}if(a.isInstancedMesh===!0&&a.morphTexture!==null)s.getUniforms().setValue(e,`morphTexture`,a.morphTexture,n);else{let t=0;for(let e=0;e<c.length;e++)t+=c[e];let n=o.morphTargetsRelative?1:1-t;s.getUniforms().setValue(e,`morphTargetBaseInfluence`,n),s.getUniforms().setValue(e,`morphTargetInfluences`,c)}s.getUniforms().setValue(e,`morphTargetsTexture`,d.texture,n),s.getUniforms().setValue(e,`morphTargetsTextureSize`,d.size)}return{update:a}}function qo(e,t,n,r,i){let a=new WeakMap;function o(r){let o=i.render.frame,s=r.geometry,l=t.get(r,s);if(a.get(l)!==o&&(t.update(l),a.set(l,o)),r.isInstancedMesh&&(r.hasEventListener(`dispose`,c)===!1&&r.addEventListener(`dispose`,c),a.get(r)!==o&&(n.update(r.instanceMatrix,e.ARRAY_BUFFER),r.instanceColor!==null&&n.update(r.instanceColor,e.ARRAY_BUFFER),a.set(r,o))),r.isSkinnedMesh){let e=r.skeleton;a.get(e)!==o&&(e.update(),a.set(e,o))}return l}function s(){a=new WeakMap}function c(e){let t=e.target;t.removeEventListener(`dispose`,c),r.releaseStatesOfObject(t),n.remove(t.instanceMatrix),t.instanceColor!==null&&n.remove(t.instanceColor)}return{update:o,dispose:s}}var Jo={1:`LINEAR_TONE_MAPPING`,2:`REINHARD_TONE_MAPPING`,3:`CINEON_TONE_MAPPING`,4:`ACES_FILMIC_TONE_MAPPING`,6:`AGX_TONE_MAPPING`,7:`NEUTRAL_TONE_MAPPING`,5:`CUSTOM_TONE_MAPPING`};function Yo(e,t,n,r,i,a){let o=new at(t,n,{type:e,depthBuffer:i,stencilBuffer:a,samples:r?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),s=null,c=null,l=null,u=new Un;u.setAttribute(`position`,new jn([-1,3,0,-1,-1,0,3,-1,0],3)),u.setAttribute(`uv`,new jn([0,2,0,0,2,0],2));let d=new Mi({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),f=new _r(u,d),m=new La(-1,1,1,-1,0,1),h=null,_=null,v=!1,b,x=null,S=[],C=!1;this.setSize=function(e,t){o.setSize(e,t),s!==null&&s.setSize(e,t),c!==null&&c.setSize(e,t);for(let n=0;n<S.length;n++){let r=S[n];r.setSize&&r.setSize(e,t)}},this.setEffects=function(e){S=e,C=S.length>0&&S[0].isRenderPass===!0;let t=o.width,n=o.height;S.length>0&&s===null&&(s=new at(t,n,{type:p,depthBuffer:!1,stencilBuffer:!1}),c=new at(t,n,{type:p,depthBuffer:!1,stencilBuffer:!1}));let r=i===!0&&S.some(e=>e.needsDepthTexture===!0);r!==(o.depthTexture!==null)&&(r===!0&&l===null&&(l=new vi(t,n),a===!0&&(l.format=y,l.type=g)),o.dispose(),o.depthTexture=r?l:null,o.resolveDepthBuffer=r,o.storeMultisampledDepthBuffer=r);for(let e=0;e<S.length;e++){let i=S[e];i.setSize&&i.setSize(t,n),r&&i.needsDepthTexture===!0&&i.setDepthTexture&&i.setDepthTexture(l)}},this.begin=function(e,t){if(v||e.toneMapping===0&&S.length===0)return!1;if(x=t,t!==null){let e=t.width,n=t.height;(o.width!==e||o.height!==n)&&this.setSize(e,n)}return C===!1&&e.setRenderTarget(o),b=e.toneMapping,e.toneMapping=0,!0},this.hasRenderPass=function(){return C},this.end=function(e,t){e.toneMapping=b,v=!0;let n=o,r=s;for(let i=0;i<S.length;i++){let a=S[i];a.enabled!==!1&&(a.render(e,r,n,t),a.needsSwap!==!1&&(n=r,r=r===s?c:s))}if(h!==e.outputColorSpace||_!==e.toneMapping){h=e.outputColorSpace,_=e.toneMapping,d.defines={},Ke.getTransfer(h)===`srgb`&&(d.defines.SRGB_TRANSFER=``);let t=Jo[_];t&&(d.defines[t]=``),d.needsUpdate=!0}d.uniforms.tDiffuse.value=n.texture,e.setRenderTarget(x),e.render(f,m),x=null,v=!1},this.isCompositing=function(){return v},this.dispose=function(){o.dispose(),s!==null&&s.dispose(),c!==null&&c.dispose(),u.dispose(),d.dispose()}}var Xo=new nt,Zo=new vi(1,1),Qo=new yi(1),$o=new ot,es=new st,ts=new _i,ns=[],rs=[],is=new Float32Array(16),as=new Float32Array(9),os=new Float32Array(4);function ss(e,t,n){let r=e[0];if(r<=0||r>0)return e;let i=t*n,a=ns[i];if(a===void 0&&(a=new Float32Array(i),ns[i]=a),t!==0){r.toArray(a,0);for(let r=1,i=0;r!==t;++r)i+=n,e[r].toArray(a,i)}return a}function cs(e,t){if(e.length!==t.length)return!1;for(let n=0,r=e.length;n<r;n++)if(e[n]!==t[n])return!1;return!0}function ls(e,t){for(let n=0,r=t.length;n<r;n++)e[n]=t[n]}function us(e,t){let n=rs[t];n===void 0&&(n=new Int32Array(t),rs[t]=n);for(let r=0;r!==t;++r)n[r]=e.allocateTextureUnit();return n}function ds(e,t){let n=this.cache;n[0]!==t&&(e.uniform1f(this.addr,t),n[0]=t)}function fs(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2f(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(cs(n,t))return;e.uniform2fv(this.addr,t),ls(n,t)}}function ps(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3f(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else if(t.r!==void 0)(n[0]!==t.r||n[1]!==t.g||n[2]!==t.b)&&(e.uniform3f(this.addr,t.r,t.g,t.b),n[0]=t.r,n[1]=t.g,n[2]=t.b);else{if(cs(n,t))return;e.uniform3fv(this.addr,t),ls(n,t)}}function ms(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4f(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(cs(n,t))return;e.uniform4fv(this.addr,t),ls(n,t)}}function hs(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(cs(n,t))return;e.uniformMatrix2fv(this.addr,!1,t),ls(n,t)}else{if(cs(n,r))return;os.set(r),e.uniformMatrix2fv(this.addr,!1,os),ls(n,r)}}function gs(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(cs(n,t))return;e.uniformMatrix3fv(this.addr,!1,t),ls(n,t)}else{if(cs(n,r))return;as.set(r),e.uniformMatrix3fv(this.addr,!1,as),ls(n,r)}}function _s(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(cs(n,t))return;e.uniformMatrix4fv(this.addr,!1,t),ls(n,t)}else{if(cs(n,r))return;is.set(r),e.uniformMatrix4fv(this.addr,!1,is),ls(n,r)}}function vs(e,t){let n=this.cache;n[0]!==t&&(e.uniform1i(this.addr,t),n[0]=t)}function ys(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2i(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(cs(n,t))return;e.uniform2iv(this.addr,t),ls(n,t)}}function bs(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3i(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(cs(n,t))return;e.uniform3iv(this.addr,t),ls(n,t)}}function xs(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4i(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(cs(n,t))return;e.uniform4iv(this.addr,t),ls(n,t)}}function Ss(e,t){let n=this.cache;n[0]!==t&&(e.uniform1ui(this.addr,t),n[0]=t)}function Cs(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2ui(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(cs(n,t))return;e.uniform2uiv(this.addr,t),ls(n,t)}}function ws(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3ui(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(cs(n,t))return;e.uniform3uiv(this.addr,t),ls(n,t)}}function Ts(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4ui(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(cs(n,t))return;e.uniform4uiv(this.addr,t),ls(n,t)}}function Es(e){return e.version===0&&(e.compareFunction=519,e.needsUpdate=!0),e}function Ds(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_2D_SHADOW?Es(Zo):Xo,n.setTexture2D(t||a,i)}function Os(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture3D(t||es,i)}function ks(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_CUBE_SHADOW?Es(Qo):ts,n.setTextureCube(t||a,i)}function As(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture2DArray(t||$o,i)}function js(e){switch(e){case 5126:return ds;case 35664:return fs;case 35665:return ps;case 35666:return ms;case 35674:return hs;case 35675:return gs;case 35676:return _s;case 5124:case 35670:return vs;case 35667:case 35671:return ys;case 35668:case 35672:return bs;case 35669:case 35673:return xs;case 5125:return Ss;case 36294:return Cs;case 36295:return ws;case 36296:return Ts;case 35678:case 36198:case 36298:case 36306:case 35682:return Ds;case 35679:case 36299:case 36307:return Os;case 35680:case 36300:case 36308:case 36293:return ks;case 36289:case 36303:case 36311:case 36292:return As}}function Ms(e,t){e.uniform1fv(this.addr,t)}function Ns(e,t){let n=ss(t,this.size,2);e.uniform2fv(this.addr,n)}function Ps(e,t){let n=ss(t,this.size,3);e.uniform3fv(this.addr,n)}function Fs(e,t){let n=ss(t,this.size,4);e.uniform4fv(this.addr,n)}function Is(e,t){let n=ss(t,this.size,4);e.uniformMatrix2fv(this.addr,!1,n)}function Ls(e,t){let n=ss(t,this.size,9);e.uniformMatrix3fv(this.addr,!1,n)}function Rs(e,t){let n=ss(t,this.size,16);e.uniformMatrix4fv(this.addr,!1,n)}function zs(e,t){e.uniform1iv(this.addr,t)}function Bs(e,t){e.uniform2iv(this.addr,t)}function Vs(e,t){e.uniform3iv(this.addr,t)}function Hs(e,t){e.uniform4iv(this.addr,t)}function Us(e,t){e.uniform1uiv(this.addr,t)}function Ws(e,t){e.uniform2uiv(this.addr,t)}function Gs(e,t){e.uniform3uiv(this.addr,t)}function Ks(e,t){e.uniform4uiv(this.addr,t)}function qs(e,t,n){let r=this.cache,i=t.length,a=us(n,i);cs(r,a)||(e.uniform1iv(this.addr,a),ls(r,a));let o;o=this.type===e.SAMPLER_2D_SHADOW?Es(Zo):Xo;for(let e=0;e!==i;++e)n.setTexture2D(t[e]||o,a[e])}function Js(e,t,n){let r=this.cache,i=t.length,a=us(n,i);cs(r,a)||(e.uniform1iv(this.addr,a),ls(r,a));for(let e=0;e!==i;++e)n.setTexture3D(t[e]||es,a[e])}function Ys(e,t,n){let r=this.cache,i=t.length,a=us(n,i);cs(r,a)||(e.uniform1iv(this.addr,a),ls(r,a));let o;o=this.type===e.SAMPLER_CUBE_SHADOW?Es(Qo):ts;for(let e=0;e!==i;++e)n.setTextureCube(t[e]||o,a[e])}function Xs(e,t,n){let r=this.cache,i=t.length,a=us(n,i);cs(r,a)||(e.uniform1iv(this.addr,a),ls(r,a));for(let e=0;e!==i;++e)n.setTexture2DArray(t[e]||$o,a[e])}function Zs(e){switch(e){case 5126:return Ms;case 35664:return Ns;case 35665:return Ps;case 35666:return Fs;case 35674:return Is;case 35675:return Ls;case 35676:return Rs;case 5124:case 35670:return zs;case 35667:case 35671:return Bs;case 35668:case 35672:return Vs;case 35669:case 35673:return Hs;case 5125:return Us;case 36294:return Ws;case 36295:return Gs;case 36296:return Ks;case 35678:case 36198:case 36298:case 36306:case 35682:return qs;case 35679:case 36299:case 36307:return Js;case 35680:case 36300:case 36308:case 36293:return Ys;case 36289:case 36303:case 36311:case 36292:return Xs}}var Qs=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=js(t.type)}},$s=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=Zs(t.type)}},ec=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let r=this.seq;for(let i=0,a=r.length;i!==a;++i){let a=r[i];a.setValue(e,t[a.id],n)}}},tc=/(\w+)(\])?(\[|\.)?/g;function nc(e,t){e.seq.push(t),e.map[t.id]=t}function rc(e,t,n){let r=e.name,i=r.length;for(tc.lastIndex=0;;){let a=tc.exec(r),o=tc.lastIndex,s=a[1],c=a[2]===`]`,l=a[3];if(c&&(s|=0),l===void 0||l===`[`&&o+2===i){nc(n,l===void 0?new Qs(s,e,t):new $s(s,e,t));break}{let e=n.map[s];e===void 0&&(e=new ec(s),nc(n,e)),n=e}}}var ic=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let r=0;r<n;++r){let n=e.getActiveUniform(t,r);rc(n,e.getUniformLocation(t,n.name),this)}let r=[],i=[];for(let t of this.seq)t.type===e.SAMPLER_2D_SHADOW||t.type===e.SAMPLER_CUBE_SHADOW||t.type===e.SAMPLER_2D_ARRAY_SHADOW?r.push(t):i.push(t);r.length>0&&(this.seq=r.concat(i))}setValue(e,t,n,r){let i=this.map[t];i!==void 0&&i.setValue(e,n,r)}setOptional(e,t,n){let r=t[n];r!==void 0&&this.setValue(e,n,r)}static upload(e,t,n,r){for(let i=0,a=t.length;i!==a;++i){let a=t[i],o=n[a.id];o.needsUpdate!==!1&&a.setValue(e,o.value,r)}}static seqWithValue(e,t){let n=[];for(let r=0,i=e.length;r!==i;++r){let i=e[r];i.id in t&&n.push(i)}return n}};function ac(e,t,n){let r=e.createShader(t);return e.shaderSource(r,n),e.compileShader(r),r}var oc=37297,sc=0;function cc(e,t){let n=e.split(`
`),r=[],i=Math.max(t-6,0),a=Math.min(t+6,n.length);for(let e=i;e<a;e++){let i=e+1;r.push(`${i===t?`>`:` `} ${i}: ${n[e]}`)}return r.join(`
`)}var lc=new G;function uc(e){Ke._getMatrix(lc,Ke.workingColorSpace,e);let t=`mat3( ${lc.elements.map(e=>e.toFixed(4))} )`;switch(Ke.getTransfer(e)){case P:return[t,`LinearTransferOETF`];case ee:return[t,`sRGBTransferOETF`];default:return L(`WebGLProgram: Unsupported color space: `,e),[t,`LinearTransferOETF`]}}function dc(e,t,n){let r=e.getShaderParameter(t,e.COMPILE_STATUS),i=(e.getShaderInfoLog(t)||``).trim();if(r&&i===``)return``;let a=/ERROR: 0:(\d+)/.exec(i);if(a){let r=parseInt(a[1]);return n.toUpperCase()+`

`+i+`

`+cc(e.getShaderSource(t),r)}return i}function fc(e,t){let n=uc(t);return[`vec4 ${e}( vec4 value ) {`,`	return ${n[1]}( vec4( ${n[0]} * value.rgb, value.a ) );`,`}`].join(`
`)}var pc={1:`Linear`,2:`Reinhard`,3:`Cineon`,4:`ACESFilmic`,6:`AgX`,7:`Neutral`,5:`Custom`};function mc(e,t){let n=pc[t];return n===void 0?(L(`WebGLProgram: Unsupported toneMapping:`,t),`vec3 `+e+`( vec3 color ) { return LinearToneMapping( color ); }`):`vec3 `+e+`( vec3 color ) { return `+n+`ToneMapping( color ); }`}var hc=new W;function gc(){return Ke.getLuminanceCoefficients(hc),[`float luminance( const in vec3 rgb ) {`,`	const vec3 weights = vec3( ${hc.x.toFixed(4)}, ${hc.y.toFixed(4)}, ${hc.z.toFixed(4)} );`,`	return dot( weights, rgb );`,`}`].join(`
`)}function _c(e){return[e.extensionClipCullDistance?`#extension GL_ANGLE_clip_cull_distance : require`:``,e.extensionMultiDraw?`#extension GL_ANGLE_multi_draw : require`:``].filter(bc).join(`
`)}function vc(e){let t=[];for(let n in e){let r=e[n];r!==!1&&t.push(`#define `+n+` `+r)}return t.join(`
`)}function yc(e,t){let n={},r=e.getProgramParameter(t,e.ACTIVE_ATTRIBUTES);for(let i=0;i<r;i++){let r=e.getActiveAttrib(t,i),a=r.name,o=1;r.type===e.FLOAT_MAT2&&(o=2),r.type===e.FLOAT_MAT3&&(o=3),r.type===e.FLOAT_MAT4&&(o=4),n[a]={type:r.type,location:e.getAttribLocation(t,a),locationSize:o}}return n}function bc(e){return e!==``}function xc(e,t){let n=t.numSpotLightShadows+t.numSpotLightMaps-t.numSpotLightShadowsWithMaps;return e.replace(/NUM_SUN_LIGHTS/g,t.numSunLights).replace(/NUM_DIR_LIGHTS/g,t.numDirLights).replace(/NUM_SPOT_LIGHTS/g,t.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,t.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,n).replace(/NUM_RECT_AREA_LIGHTS/g,t.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,t.numPointLights).replace(/NUM_HEMI_LIGHTS/g,t.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,t.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,t.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,t.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,t.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,t.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,t.numLightProbeGrids)}function Sc(e,t){return e.replace(/NUM_CLIPPING_PLANES/g,t.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,t.numClippingPlanes-t.numClipIntersection)}var Cc=/^[ \t]*#include +<([\w\d./]+)>/gm;function wc(e){return e.replace(Cc,Tc)}function Tc(e,t){let n=J[t];if(n===void 0)throw Error(`THREE.WebGLProgram: Can not resolve #include <`+t+`>`);return wc(n)}var Ec=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function Dc(e){return e.replace(Ec,Oc)}function Oc(e,t,n,r){let i=``;for(let e=parseInt(t);e<parseInt(n);e++)i+=r.replace(/\[\s*i\s*\]/g,`[ `+e+` ]`).replace(/UNROLLED_LOOP_INDEX/g,e);return i}function kc(e){let t=`precision ${e.precision} float;
	precision ${e.precision} int;
	precision ${e.precision} sampler2D;
	precision ${e.precision} samplerCube;
	precision ${e.precision} sampler3D;
	precision ${e.precision} sampler2DArray;
	precision ${e.precision} sampler2DShadow;
	precision ${e.precision} samplerCubeShadow;
	precision ${e.precision} sampler2DArrayShadow;
	precision ${e.precision} isampler2D;
	precision ${e.precision} isampler3D;
	precision ${e.precision} isamplerCube;
	precision ${e.precision} isampler2DArray;
	precision ${e.precision} usampler2D;
	precision ${e.precision} usampler3D;
	precision ${e.precision} usamplerCube;
	precision ${e.precision} usampler2DArray;
	`;return e.precision===`highp`?t+=`
#define HIGH_PRECISION`:e.precision===`mediump`?t+=`
#define MEDIUM_PRECISION`:e.precision===`lowp`&&(t+=`
#define LOW_PRECISION`),t}var Ac={1:`SHADOWMAP_TYPE_PCF`,3:`SHADOWMAP_TYPE_VSM`};function jc(e){return Ac[e.shadowMapType]||`SHADOWMAP_TYPE_BASIC`}var Mc={302:`ENVMAP_MODE_REFRACTION`};function Nc(e){return e.envMap===!1?`ENVMAP_MODE_REFLECTION`:Mc[e.envMapMode]||`ENVMAP_MODE_REFLECTION`}var Pc={0:`ENVMAP_BLENDING_MULTIPLY`,1:`ENVMAP_BLENDING_MIX`,2:`ENVMAP_BLENDING_ADD`};function Fc(e){return e.envMap===!1?`ENVMAP_BLENDING_NONE`:Pc[e.combine]||`ENVMAP_BLENDING_NONE`}function Ic(e,t,n,r){let i=e.getContext(),a=n.defines,o=n.vertexShader,s=n.fragmentShader,c=jc(n),l=n.envMapPMREM===!0?`ENVMAP_TYPE_PMREM`:`ENVMAP_TYPE_CUBE`,u=Nc(n),d=Fc(n),f=_c(n),p=vc(a),m=i.createProgram(),h,g,_=n.glslVersion?`#version `+n.glslVersion+`
`:``;n.isRawShaderMaterial?(h=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(bc).join(`
`),h.length>0&&(h+=`
`),g=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(bc).join(`
`),g.length>0&&(g+=`
`)):(h=[kc(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.extensionClipCullDistance?`#define USE_CLIP_DISTANCE`:``,n.batching?`#define USE_BATCHING`:``,n.batchingColor?`#define USE_BATCHING_COLOR`:``,n.instancing?`#define USE_INSTANCING`:``,n.instancingColor?`#define USE_INSTANCING_COLOR`:``,n.instancingMorph?`#define USE_INSTANCING_MORPH`:``,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.map?`#define USE_MAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+u:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.displacementMap?`#define USE_DISPLACEMENTMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.mapUv?`#define MAP_UV `+n.mapUv:``,n.alphaMapUv?`#define ALPHAMAP_UV `+n.alphaMapUv:``,n.lightMapUv?`#define LIGHTMAP_UV `+n.lightMapUv:``,n.aoMapUv?`#define AOMAP_UV `+n.aoMapUv:``,n.emissiveMapUv?`#define EMISSIVEMAP_UV `+n.emissiveMapUv:``,n.bumpMapUv?`#define BUMPMAP_UV `+n.bumpMapUv:``,n.normalMapUv?`#define NORMALMAP_UV `+n.normalMapUv:``,n.displacementMapUv?`#define DISPLACEMENTMAP_UV `+n.displacementMapUv:``,n.metalnessMapUv?`#define METALNESSMAP_UV `+n.metalnessMapUv:``,n.roughnessMapUv?`#define ROUGHNESSMAP_UV `+n.roughnessMapUv:``,n.anisotropyMapUv?`#define ANISOTROPYMAP_UV `+n.anisotropyMapUv:``,n.clearcoatMapUv?`#define CLEARCOATMAP_UV `+n.clearcoatMapUv:``,n.clearcoatNormalMapUv?`#define CLEARCOAT_NORMALMAP_UV `+n.clearcoatNormalMapUv:``,n.clearcoatRoughnessMapUv?`#define CLEARCOAT_ROUGHNESSMAP_UV `+n.clearcoatRoughnessMapUv:``,n.diffuseRoughnessMapUv?`#define DIFFUSE_ROUGHNESSMAP_UV `+n.diffuseRoughnessMapUv:``,n.iridescenceMapUv?`#define IRIDESCENCEMAP_UV `+n.iridescenceMapUv:``,n.iridescenceThicknessMapUv?`#define IRIDESCENCE_THICKNESSMAP_UV `+n.iridescenceThicknessMapUv:``,n.sheenColorMapUv?`#define SHEEN_COLORMAP_UV `+n.sheenColorMapUv:``,n.sheenRoughnessMapUv?`#define SHEEN_ROUGHNESSMAP_UV `+n.sheenRoughnessMapUv:``,n.specularMapUv?`#define SPECULARMAP_UV `+n.specularMapUv:``,n.specularColorMapUv?`#define SPECULAR_COLORMAP_UV `+n.specularColorMapUv:``,n.specularIntensityMapUv?`#define SPECULAR_INTENSITYMAP_UV `+n.specularIntensityMapUv:``,n.transmissionMapUv?`#define TRANSMISSIONMAP_UV `+n.transmissionMapUv:``,n.thicknessMapUv?`#define THICKNESSMAP_UV `+n.thicknessMapUv:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexNormals?`#define HAS_NORMAL`:``,n.vertexColors?`#define USE_COLOR`:``,n.vertexAlphas?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.flatShading?`#define FLAT_SHADED`:``,n.skinning?`#define USE_SKINNING`:``,n.morphTargets?`#define USE_MORPHTARGETS`:``,n.morphNormals&&n.flatShading===!1?`#define USE_MORPHNORMALS`:``,n.morphColors?`#define USE_MORPHCOLORS`:``,n.morphTargetsCount>0?`#define MORPHTARGETS_TEXTURE_STRIDE `+n.morphTextureStride:``,n.morphTargetsCount>0?`#define MORPHTARGETS_COUNT `+n.morphTargetsCount:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.sizeAttenuation?`#define USE_SIZEATTENUATION`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 modelMatrix;`,`uniform mat4 modelViewMatrix;`,`uniform mat4 projectionMatrix;`,`uniform mat4 viewMatrix;`,`uniform mat3 normalMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,`#ifdef USE_INSTANCING`,`	attribute mat4 instanceMatrix;`,`#endif`,`#ifdef USE_INSTANCING_COLOR`,`	attribute vec3 instanceColor;`,`#endif`,`#ifdef USE_INSTANCING_MORPH`,`	uniform sampler2D morphTexture;`,`#endif`,`attribute vec3 position;`,`attribute vec3 normal;`,`attribute vec2 uv;`,`#ifdef USE_UV1`,`	attribute vec2 uv1;`,`#endif`,`#ifdef USE_UV2`,`	attribute vec2 uv2;`,`#endif`,`#ifdef USE_UV3`,`	attribute vec2 uv3;`,`#endif`,`#ifdef USE_TANGENT`,`	attribute vec4 tangent;`,`#endif`,`#if defined( USE_COLOR_ALPHA )`,`	attribute vec4 color;`,`#elif defined( USE_COLOR )`,`	attribute vec3 color;`,`#endif`,`#ifdef USE_SKINNING`,`	attribute vec4 skinIndex;`,`	attribute vec4 skinWeight;`,`#endif`,`
`].filter(bc).join(`
`),g=[kc(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.alphaToCoverage?`#define ALPHA_TO_COVERAGE`:``,n.map?`#define USE_MAP`:``,n.matcap?`#define USE_MATCAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+l:``,n.envMap?`#define `+u:``,n.envMap?`#define `+d:``,n.envMapPMREM?`#define ENVMAP_MAX_LOD `+n.envMapMaxLod+`.0`:``,n.envMapPMREM?`#define ENVMAP_SIZE `+n.envMapSize+`.0`:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.packedNormalMap?`#define USE_PACKED_NORMALMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoat?`#define USE_CLEARCOAT`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughness?`#define USE_DIFFUSE_ROUGHNESS`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.dispersion?`#define USE_DISPERSION`:``,n.retroreflection?`#define USE_RETROREFLECTION`:``,n.iridescence?`#define USE_IRIDESCENCE`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaTest?`#define USE_ALPHATEST`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.sheen?`#define USE_SHEEN`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexColors||n.instancingColor?`#define USE_COLOR`:``,n.vertexAlphas||n.batchingColor?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.gradientMap?`#define USE_GRADIENTMAP`:``,n.flatShading?`#define FLAT_SHADED`:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.premultipliedAlpha?`#define PREMULTIPLIED_ALPHA`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.decodeVideoTexture?`#define DECODE_VIDEO_TEXTURE`:``,n.decodeVideoTextureEmissive?`#define DECODE_VIDEO_TEXTURE_EMISSIVE`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 viewMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,n.toneMapping===0?``:`#define TONE_MAPPING`,n.toneMapping===0?``:J.tonemapping_pars_fragment,n.toneMapping===0?``:mc(`toneMapping`,n.toneMapping),n.dithering?`#define DITHERING`:``,n.opaque?`#define OPAQUE`:``,J.colorspace_pars_fragment,fc(`linearToOutputTexel`,n.outputColorSpace),gc(),n.useDepthPacking?`#define DEPTH_PACKING `+n.depthPacking:``,`
`].filter(bc).join(`
`)),o=wc(o),o=xc(o,n),o=Sc(o,n),s=wc(s),s=xc(s,n),s=Sc(s,n),o=Dc(o),s=Dc(s),n.isRawShaderMaterial!==!0&&(_=`#version 300 es
`,h=[f,`#define attribute in`,`#define varying out`,`#define texture2D texture`].join(`
`)+`
`+h,g=[`#define varying in`,n.glslVersion===`300 es`?``:`layout(location = 0) out highp vec4 pc_fragColor;`,n.glslVersion===`300 es`?``:`#define gl_FragColor pc_fragColor`,`#define gl_FragDepthEXT gl_FragDepth`,`#define texture2D texture`,`#define textureCube texture`,`#define texture2DProj textureProj`,`#define texture2DLodEXT textureLod`,`#define texture2DProjLodEXT textureProjLod`,`#define textureCubeLodEXT textureLod`,`#define texture2DGradEXT textureGrad`,`#define texture2DProjGradEXT textureProjGrad`,`#define textureCubeGradEXT textureGrad`].join(`
`)+`
`+g);let v=_+h+o,y=_+g+s,b=ac(i,i.VERTEX_SHADER,v),x=ac(i,i.FRAGMENT_SHADER,y);i.attachShader(m,b),i.attachShader(m,x),n.index0AttributeName===void 0?n.hasPositionAttribute===!0&&i.bindAttribLocation(m,0,`position`):i.bindAttribLocation(m,0,n.index0AttributeName),i.linkProgram(m);function S(t){if(e.debug.checkShaderErrors){let n=i.getProgramInfoLog(m)||``,r=i.getShaderInfoLog(b)||``,a=i.getShaderInfoLog(x)||``,o=n.trim(),s=r.trim(),c=a.trim(),l=!0,u=!0;if(i.getProgramParameter(m,i.LINK_STATUS)===!1){if(l=!1,typeof e.debug.onShaderError==`function`)e.debug.onShaderError(i,m,b,x);else{let e=dc(i,b,`vertex`),n=dc(i,x,`fragment`);R(`WebGLProgram: Shader Error `+i.getError()+` - VALIDATE_STATUS `+i.getProgramParameter(m,i.VALIDATE_STATUS)+`

Material Name: `+t.name+`
Material Type: `+t.type+`

Program Info Log: `+o+`
`+e+`
`+n)}}else o===``?(s===``||c===``)&&(u=!1):L(`WebGLProgram: Program Info Log:`,o);u&&(t.diagnostics={runnable:l,programLog:o,vertexShader:{log:s,prefix:h},fragmentShader:{log:c,prefix:g}})}i.deleteShader(b),i.deleteShader(x),C=new ic(i,m),w=yc(i,m)}let C;this.getUniforms=function(){return C===void 0&&S(this),C};let w;this.getAttributes=function(){return w===void 0&&S(this),w};let T=n.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return T===!1&&(T=i.getProgramParameter(m,oc)),T},this.destroy=function(){r.releaseStatesOfProgram(this),i.deleteProgram(m),this.program=void 0},this.type=n.shaderType,this.name=n.shaderName,this.id=sc++,this.cacheKey=t,this.usedTimes=1,this.program=m,this.vertexShader=b,this.fragmentShader=x,this}var Lc=0,Rc=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let r=this._getShaderCacheForMaterial(e);return r.has(t)===!1&&(r.add(t),t.usedTimes++),r.has(n)===!1&&(r.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let e of t)e.usedTimes--,e.usedTimes===0&&this.shaderCache.delete(e.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new zc(e),t.set(e,n)),n}},zc=class{constructor(e){this.id=Lc++,this.code=e,this.usedTimes=0}};function Bc(e){return e===1030||e===37490||e===36285}function Vc(e,t,n,r,i,a){let o=new vt,s=new Rc,c=new Set,l=[],u=new Map,d=r.logarithmicDepthBuffer,f={MeshDepthMaterial:`depth`,MeshDistanceMaterial:`distance`,MeshNormalMaterial:`normal`,MeshBasicMaterial:`basic`,MeshLambertMaterial:`lambert`,MeshPhongMaterial:`phong`,MeshToonMaterial:`toon`,MeshStandardMaterial:`physical`,MeshPhysicalMaterial:`physical`,MeshMatcapMaterial:`matcap`,LineBasicMaterial:`basic`,LineDashedMaterial:`dashed`,PointsMaterial:`points`,ShadowMaterial:`shadow`,SpriteMaterial:`sprite`};function p(e){return c.add(e),e===0?`uv`:`uv${e}`}function m(i,o,l,u,m,h){let g=u.fog,_=m.geometry,v=i.isMeshStandardMaterial||i.isMeshLambertMaterial||i.isMeshPhongMaterial?u.environment:null,y=i.isMeshStandardMaterial||i.isMeshLambertMaterial&&!i.envMap||i.isMeshPhongMaterial&&!i.envMap,b=t.get(i.envMap||v,y),x=f[i.type],S=r.precision;i.precision!==null&&(S=r.getMaxPrecision(i.precision),S!==i.precision&&L(`WebGLProgram.getParameters:`,i.precision,`not supported, using`,S,`instead.`));let C=_.morphAttributes.position||_.morphAttributes.normal||_.morphAttributes.color,w=C===void 0?0:C.length,T=0;_.morphAttributes.position!==void 0&&(T=1),_.morphAttributes.normal!==void 0&&(T=2),_.morphAttributes.color!==void 0&&(T=3);let E,D,O,k;if(x){let e=ho[x];E=e.vertexShader,D=e.fragmentShader}else{E=i.vertexShader,D=i.fragmentShader;let e=s.getVertexShaderStage(i),t=s.getFragmentShaderStage(i);s.update(i,e,t),O=e.id,k=t.id}let A=e.getRenderTarget(),j=e.state.buffers.depth.getReversed(),M=m.isInstancedMesh===!0,N=m.isBatchedMesh===!0,P=!!i.map,ee=!!i.matcap,te=!!b,F=te&&b.isPMREMTexture===!0,ne=!!i.aoMap,I=!!i.lightMap,re=!!i.bumpMap&&i.wireframe===!1,ie=!!i.normalMap,ae=!!i.displacementMap,oe=!!i.emissiveMap,se=!!i.metalnessMap,ce=!!i.roughnessMap,le=i.anisotropy>0,ue=i.clearcoat>0,R=i.diffuseRoughness>0,de=i.dispersion>0,fe=i.retroreflectivity>0,pe=i.iridescence>0,me=i.sheen>0,he=i.transmission>0,ge=le&&!!i.anisotropyMap,_e=ue&&!!i.clearcoatMap,ve=ue&&!!i.clearcoatNormalMap,ye=ue&&!!i.clearcoatRoughnessMap,z=R&&!!i.diffuseRoughnessMap,be=pe&&!!i.iridescenceMap,xe=pe&&!!i.iridescenceThicknessMap,Se=me&&!!i.sheenColorMap,Ce=me&&!!i.sheenRoughnessMap,we=!!i.specularMap,Te=!!i.specularColorMap,Ee=!!i.specularIntensityMap,De=he&&!!i.transmissionMap,Oe=he&&!!i.thicknessMap,ke=!!i.gradientMap,Ae=!!i.alphaMap,je=i.alphaTest>0,Me=!!i.alphaHash,Ne=!!i.extensions,Pe=0;i.toneMapped&&(A===null||A.isXRRenderTarget===!0)&&(Pe=e.toneMapping);let Fe=F?b.isCompressedCubeTexture?b.image[0].mipmaps:b.mipmaps:null,Ie={shaderID:x,shaderType:i.type,shaderName:i.name,vertexShader:E,fragmentShader:D,defines:i.defines,customVertexShaderID:O,customFragmentShaderID:k,isRawShaderMaterial:i.isRawShaderMaterial===!0,glslVersion:i.glslVersion,precision:S,batching:N,batchingColor:N&&m._colorsTexture!==null,instancing:M,instancingColor:M&&m.instanceColor!==null,instancingMorph:M&&m.morphTexture!==null,outputColorSpace:A===null?e.outputColorSpace:A.isXRRenderTarget===!0?A.texture.colorSpace:Ke.workingColorSpace,alphaToCoverage:!!i.alphaToCoverage,map:P,matcap:ee,envMap:te,envMapMode:te&&b.mapping,envMapPMREM:F,envMapMaxLod:F?Fe.length-1:null,envMapSize:F?Fe[0].width:null,aoMap:ne,lightMap:I,bumpMap:re,normalMap:ie,displacementMap:ae,emissiveMap:oe,normalMapObjectSpace:ie&&i.normalMapType===1,normalMapTangentSpace:ie&&i.normalMapType===0,packedNormalMap:ie&&i.normalMapType===0&&Bc(i.normalMap.format),metalnessMap:se,roughnessMap:ce,anisotropy:le,anisotropyMap:ge,clearcoat:ue,clearcoatMap:_e,clearcoatNormalMap:ve,clearcoatRoughnessMap:ye,diffuseRoughness:R,diffuseRoughnessMap:z,dispersion:de,retroreflection:fe,iridescence:pe,iridescenceMap:be,iridescenceThicknessMap:xe,sheen:me,sheenColorMap:Se,sheenRoughnessMap:Ce,specularMap:we,specularColorMap:Te,specularIntensityMap:Ee,transmission:he,transmissionMap:De,thicknessMap:Oe,gradientMap:ke,opaque:i.transparent===!1&&i.blending===1&&i.alphaToCoverage===!1,alphaMap:Ae,alphaTest:je,alphaHash:Me,combine:i.combine,mapUv:P&&p(i.map.channel),aoMapUv:ne&&p(i.aoMap.channel),lightMapUv:I&&p(i.lightMap.channel),bumpMapUv:re&&p(i.bumpMap.channel),normalMapUv:ie&&p(i.normalMap.channel),displacementMapUv:ae&&p(i.displacementMap.channel),emissiveMapUv:oe&&p(i.emissiveMap.channel),metalnessMapUv:se&&p(i.metalnessMap.channel),roughnessMapUv:ce&&p(i.roughnessMap.channel),anisotropyMapUv:ge&&p(i.anisotropyMap.channel),clearcoatMapUv:_e&&p(i.clearcoatMap.channel),clearcoatNormalMapUv:ve&&p(i.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:ye&&p(i.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:z&&p(i.diffuseRoughnessMap.channel),iridescenceMapUv:be&&p(i.iridescenceMap.channel),iridescenceThicknessMapUv:xe&&p(i.iridescenceThicknessMap.channel),sheenColorMapUv:Se&&p(i.sheenColorMap.channel),sheenRoughnessMapUv:Ce&&p(i.sheenRoughnessMap.channel),specularMapUv:we&&p(i.specularMap.channel),specularColorMapUv:Te&&p(i.specularColorMap.channel),specularIntensityMapUv:Ee&&p(i.specularIntensityMap.channel),transmissionMapUv:De&&p(i.transmissionMap.channel),thicknessMapUv:Oe&&p(i.thicknessMap.channel),alphaMapUv:Ae&&p(i.alphaMap.channel),vertexTangents:!!_.attributes.tangent&&(ie||le),vertexNormals:!!_.attributes.normal,vertexColors:i.vertexColors,vertexAlphas:i.vertexColors===!0&&!!_.attributes.color&&_.attributes.color.itemSize===4,pointsUvs:m.isPoints===!0&&!!_.attributes.uv&&(P||Ae),fog:!!g,useFog:i.fog===!0,fogExp2:!!g&&g.isFogExp2,flatShading:i.wireframe===!1&&(i.flatShading===!0||_.attributes.normal===void 0&&ie===!1&&(i.isMeshLambertMaterial||i.isMeshPhongMaterial||i.isMeshStandardMaterial||i.isMeshPhysicalMaterial)),sizeAttenuation:i.sizeAttenuation===!0,logarithmicDepthBuffer:d,reversedDepthBuffer:j,skinning:m.isSkinnedMesh===!0,hasPositionAttribute:_.attributes.position!==void 0,morphTargets:_.morphAttributes.position!==void 0,morphNormals:_.morphAttributes.normal!==void 0,morphColors:_.morphAttributes.color!==void 0,morphTargetsCount:w,morphTextureStride:T,numSunLights:o.sun.length,numDirLights:o.directional.length,numPointLights:o.point.length,numSpotLights:o.spot.length,numSpotLightMaps:o.spotLightMap.length,numRectAreaLights:o.rectArea.length,numHemiLights:o.hemi.length,numSunLightShadows:o.sunShadowMap.length,numDirLightShadows:o.directionalShadowMap.length,numPointLightShadows:o.pointShadowMap.length,numSpotLightShadows:o.spotShadowMap.length,numSpotLightShadowsWithMaps:o.numSpotLightShadowsWithMaps,numLightProbes:o.numLightProbes,numLightProbeGrids:h.filter(e=>e.texture!==null).length,numClippingPlanes:a.numPlanes,numClipIntersection:a.numIntersection,dithering:i.dithering,shadowMapEnabled:e.shadowMap.enabled&&l.length>0,shadowMapType:e.shadowMap.type,toneMapping:Pe,decodeVideoTexture:P&&i.map.isVideoTexture===!0&&Ke.getTransfer(i.map.colorSpace)===`srgb`,decodeVideoTextureEmissive:oe&&i.emissiveMap.isVideoTexture===!0&&Ke.getTransfer(i.emissiveMap.colorSpace)===`srgb`,premultipliedAlpha:i.premultipliedAlpha,doubleSided:i.side===2,flipSided:i.side===1,useDepthPacking:i.depthPacking>=0,depthPacking:i.depthPacking||0,index0AttributeName:i.index0AttributeName,extensionClipCullDistance:Ne&&i.extensions.clipCullDistance===!0&&n.has(`WEBGL_clip_cull_distance`),extensionMultiDraw:(Ne&&i.extensions.multiDraw===!0||N)&&n.has(`WEBGL_multi_draw`),rendererExtensionParallelShaderCompile:n.has(`KHR_parallel_shader_compile`),customProgramCacheKey:i.customProgramCacheKey()};return Ie.vertexUv1s=c.has(1),Ie.vertexUv2s=c.has(2),Ie.vertexUv3s=c.has(3),c.clear(),Ie}function h(t){let n=[];if(t.shaderID?n.push(t.shaderID):(n.push(t.customVertexShaderID),n.push(t.customFragmentShaderID)),t.defines!==void 0)for(let e in t.defines)n.push(e),n.push(t.defines[e]);return t.isRawShaderMaterial===!1&&(g(n,t),_(n,t),n.push(e.outputColorSpace)),n.push(t.customProgramCacheKey),n.join()}function g(e,t){e.push(t.precision),e.push(t.outputColorSpace),e.push(t.envMapMode),e.push(t.envMapPMREM),e.push(t.envMapMaxLod),e.push(t.envMapSize),e.push(t.mapUv),e.push(t.alphaMapUv),e.push(t.lightMapUv),e.push(t.aoMapUv),e.push(t.bumpMapUv),e.push(t.normalMapUv),e.push(t.displacementMapUv),e.push(t.emissiveMapUv),e.push(t.metalnessMapUv),e.push(t.roughnessMapUv),e.push(t.anisotropyMapUv),e.push(t.clearcoatMapUv),e.push(t.clearcoatNormalMapUv),e.push(t.clearcoatRoughnessMapUv),e.push(t.diffuseRoughnessMapUv),e.push(t.iridescenceMapUv),e.push(t.iridescenceThicknessMapUv),e.push(t.sheenColorMapUv),e.push(t.sheenRoughnessMapUv),e.push(t.specularMapUv),e.push(t.specularColorMapUv),e.push(t.specularIntensityMapUv),e.push(t.transmissionMapUv),e.push(t.thicknessMapUv),e.push(t.combine),e.push(t.fogExp2),e.push(t.sizeAttenuation),e.push(t.morphTargetsCount),e.push(t.numSunLights),e.push(t.numDirLights),e.push(t.numPointLights),e.push(t.numSpotLights),e.push(t.numSpotLightMaps),e.push(t.numHemiLights),e.push(t.numRectAreaLights),e.push(t.numSunLightShadows),e.push(t.numDirLightShadows),e.push(t.numPointLightShadows),e.push(t.numSpotLightShadows),e.push(t.numSpotLightShadowsWithMaps),e.push(t.numLightProbes),e.push(t.numLightProbeGrids),e.push(t.shadowMapType),e.push(t.toneMapping),e.push(t.numClippingPlanes),e.push(t.numClipIntersection),e.push(t.depthPacking)}function _(e,t){o.disableAll(),t.instancing&&o.enable(0),t.instancingColor&&o.enable(1),t.instancingMorph&&o.enable(2),t.matcap&&o.enable(3),t.envMap&&o.enable(4),t.normalMapObjectSpace&&o.enable(5),t.normalMapTangentSpace&&o.enable(6),t.clearcoat&&o.enable(7),t.iridescence&&o.enable(8),t.alphaTest&&o.enable(9),t.vertexColors&&o.enable(10),t.vertexAlphas&&o.enable(11),t.vertexUv1s&&o.enable(12),t.vertexUv2s&&o.enable(13),t.vertexUv3s&&o.enable(14),t.vertexTangents&&o.enable(15),t.anisotropy&&o.enable(16),t.alphaHash&&o.enable(17),t.batching&&o.enable(18),t.dispersion&&o.enable(19),t.retroreflection&&o.enable(24),t.diffuseRoughness&&o.enable(25),t.batchingColor&&o.enable(20),t.gradientMap&&o.enable(21),t.packedNormalMap&&o.enable(22),t.vertexNormals&&o.enable(23),e.push(o.mask),o.disableAll(),t.fog&&o.enable(0),t.useFog&&o.enable(1),t.flatShading&&o.enable(2),t.logarithmicDepthBuffer&&o.enable(3),t.reversedDepthBuffer&&o.enable(4),t.skinning&&o.enable(5),t.morphTargets&&o.enable(6),t.morphNormals&&o.enable(7),t.morphColors&&o.enable(8),t.premultipliedAlpha&&o.enable(9),t.shadowMapEnabled&&o.enable(10),t.doubleSided&&o.enable(11),t.flipSided&&o.enable(12),t.useDepthPacking&&o.enable(13),t.dithering&&o.enable(14),t.transmission&&o.enable(15),t.sheen&&o.enable(16),t.opaque&&o.enable(17),t.pointsUvs&&o.enable(18),t.decodeVideoTexture&&o.enable(19),t.decodeVideoTextureEmissive&&o.enable(20),t.alphaToCoverage&&o.enable(21),t.numLightProbeGrids>0&&o.enable(22),t.hasPositionAttribute&&o.enable(23),e.push(o.mask)}function v(e){let t=f[e.type],n;if(t){let e=ho[t];n=Oi.clone(e.uniforms)}else n=e.uniforms;return n}function y(t,n){let r=u.get(n);return r===void 0?(r=new Ic(e,n,t,i),l.push(r),u.set(n,r)):++r.usedTimes,r}function b(e){if(--e.usedTimes===0){let t=l.indexOf(e);l[t]=l[l.length-1],l.pop(),u.delete(e.cacheKey),e.destroy()}}function x(e){s.remove(e)}function S(){s.dispose()}return{getParameters:m,getProgramCacheKey:h,getUniforms:v,acquireProgram:y,releaseProgram:b,releaseShaderCache:x,programs:l,dispose:S}}function Hc(){let e=new WeakMap;function t(t){return e.has(t)}function n(t){let n=e.get(t);return n===void 0&&(n={},e.set(t,n)),n}function r(t){e.delete(t)}function i(t,n,r){e.get(t)[n]=r}function a(){e=new WeakMap}return{has:t,get:n,remove:r,update:i,dispose:a}}function Uc(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.material.id===t.material.id?e.materialVariant===t.materialVariant?e.z===t.z?e.id-t.id:e.z-t.z:e.materialVariant-t.materialVariant:e.material.id-t.material.id:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function Wc(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.z===t.z?e.id-t.id:t.z-e.z:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function Gc(){let e=[],t=0,n=[],r=[],i=[];function a(){t=0,n.length=0,r.length=0,i.length=0}function o(e){let t=0;return e.isInstancedMesh&&(t+=2),e.isSkinnedMesh&&(t+=1),t}function s(n,r,i,a,s,c){let l=e[t];return l===void 0?(l={id:n.id,object:n,geometry:r,material:i,materialVariant:o(n),groupOrder:a,renderOrder:n.renderOrder,z:s,group:c},e[t]=l):(l.id=n.id,l.object=n,l.geometry=r,l.material=i,l.materialVariant=o(n),l.groupOrder=a,l.renderOrder=n.renderOrder,l.z=s,l.group=c),t++,l}function c(e,t,a,o,c,l,u){u.reversedDepth===!0&&(c=-c);let d=s(e,t,a,o,c,l);a.transmission>0?r.push(d):a.transparent===!0?i.push(d):n.push(d)}function l(e,t,a,o,c,l){let u=s(e,t,a,o,c,l);a.transmission>0?r.unshift(u):a.transparent===!0?i.unshift(u):n.unshift(u)}function u(e,t){n.length>1&&n.sort(e||Uc),r.length>1&&r.sort(t||Wc),i.length>1&&i.sort(t||Wc)}function d(){for(let n=t,r=e.length;n<r;n++){let t=e[n];if(t.id===null)break;t.id=null,t.object=null,t.geometry=null,t.material=null,t.group=null}}return{opaque:n,transmissive:r,transparent:i,init:a,push:c,unshift:l,finish:d,sort:u}}function Kc(){let e=new WeakMap;function t(t,n){let r=e.get(t),i;return r===void 0?(i=new Gc,e.set(t,[i])):n>=r.length?(i=new Gc,r.push(i)):i=r[n],i}function n(){e=new WeakMap}return{get:t,dispose:n}}function qc(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={direction:new W,color:new q};break;case`SpotLight`:n={position:new W,direction:new W,color:new q,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case`PointLight`:n={position:new W,color:new q,distance:0,decay:0};break;case`HemisphereLight`:n={direction:new W,skyColor:new q,groundColor:new q};break;case`RectAreaLight`:n={color:new q,position:new W,halfWidth:new W,halfHeight:new W}}return e[t.id]=n,n}}}function Jc(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new H};break;case`SpotLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new H};break;case`PointLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new H,shadowCameraNear:1,shadowCameraFar:1e3}}return e[t.id]=n,n}}}var Yc=0;function Xc(e,t){return(t.castShadow?2:0)-(e.castShadow?2:0)+ +!!t.map-!!e.map}function Zc(e){let t=new qc,n=Jc(),r={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let e=0;e<9;e++)r.probe.push(new W);let i=new W,a=new K,o=new K;function s(i){let a=0,o=0,s=0;for(let e=0;e<9;e++)r.probe[e].set(0,0,0);let c=0,l=0,u=0,d=0,f=0,p=0,m=0,h=0,g=0,_=0,v=0,y=0,b=0,x=0;i.sort(Xc);for(let e=0,S=i.length;e<S;e++){let S=i[e],C=S.color,w=S.intensity,T=S.distance,E=null;if(S.shadow&&S.shadow.map&&(E=S.shadow.map.texture.format===1030?S.shadow.map.texture:S.shadow.map.depthTexture||S.shadow.map.texture),S.isAmbientLight)a+=C.r*w,o+=C.g*w,s+=C.b*w;else if(S.isLightProbe){for(let e=0;e<9;e++)r.probe[e].addScaledVector(S.sh.coefficients[e],w);x++}else if(S.isSunLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize.copy(e.mapSize).multiply(e.getFrameExtents()),r.sunShadow[l]=t,r.sunShadowMap[l]=E;let i=e.getViewportCount();for(let t=0;t<i;t++)r.sunShadowMatrix[u+t]=e.getMatrix(t),r.sunShadowCascade[u+t]=e._cascadeData[t];u+=i,l++}r.sun[c]=e,c++}else if(S.isDirectionalLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,r.directionalShadow[d]=t,r.directionalShadowMap[d]=E,r.directionalShadowMatrix[d]=S.shadow.matrix,g++}r.directional[d]=e,d++}else if(S.isSpotLight){let e=t.get(S);e.position.setFromMatrixPosition(S.matrixWorld),e.color.copy(C).multiplyScalar(w),e.distance=T,e.coneCos=Math.cos(S.angle),e.penumbraCos=Math.cos(S.angle*(1-S.penumbra)),e.decay=S.decay,r.spot[p]=e;let i=S.shadow;if(S.map&&(r.spotLightMap[y]=S.map,y++,i.updateMatrices(S),S.castShadow&&b++),r.spotLightMatrix[p]=i.matrix,S.castShadow){let e=n.get(S);e.shadowIntensity=i.intensity,e.shadowBias=i.bias,e.shadowNormalBias=i.normalBias,e.shadowRadius=i.radius,e.shadowMapSize=i.mapSize,r.spotShadow[p]=e,r.spotShadowMap[p]=E,v++}p++}else if(S.isRectAreaLight){let e=t.get(S);e.color.copy(C).multiplyScalar(w),e.halfWidth.set(S.width*.5,0,0),e.halfHeight.set(0,S.height*.5,0),r.rectArea[m]=e,m++}else if(S.isPointLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),e.distance=S.distance,e.decay=S.decay,S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,t.shadowCameraNear=e.camera.near,t.shadowCameraFar=e.camera.far,r.pointShadow[f]=t,r.pointShadowMap[f]=E,r.pointShadowMatrix[f]=S.shadow.matrix,_++}r.point[f]=e,f++}else if(S.isHemisphereLight){let e=t.get(S);e.skyColor.copy(S.color).multiplyScalar(w),e.groundColor.copy(S.groundColor).multiplyScalar(w),r.hemi[h]=e,h++}}m>0&&(e.has(`OES_texture_float_linear`)===!0?(r.rectAreaLTC1=Y.LTC_FLOAT_1,r.rectAreaLTC2=Y.LTC_FLOAT_2):(r.rectAreaLTC1=Y.LTC_HALF_1,r.rectAreaLTC2=Y.LTC_HALF_2)),r.ambient[0]=a,r.ambient[1]=o,r.ambient[2]=s;let S=r.hash;(S.sunLength!==c||S.directionalLength!==d||S.pointLength!==f||S.spotLength!==p||S.rectAreaLength!==m||S.hemiLength!==h||S.numSunShadows!==l||S.numDirectionalShadows!==g||S.numPointShadows!==_||S.numSpotShadows!==v||S.numSpotMaps!==y||S.numLightProbes!==x)&&(r.sun.length=c,r.directional.length=d,r.spot.length=p,r.rectArea.length=m,r.point.length=f,r.hemi.length=h,r.sunShadow.length=l,r.sunShadowMap.length=l,r.sunShadowMatrix.length=u,r.sunShadowCascade.length=u,r.directionalShadow.length=g,r.directionalShadowMap.length=g,r.directionalShadowMatrix.length=g,r.pointShadow.length=_,r.pointShadowMap.length=_,r.pointShadowMatrix.length=_,r.spotShadow.length=v,r.spotShadowMap.length=v,r.spotLightMatrix.length=v+y-b,r.spotLightMap.length=y,r.numSpotLightShadowsWithMaps=b,r.numLightProbes=x,S.sunLength=c,S.directionalLength=d,S.pointLength=f,S.spotLength=p,S.rectAreaLength=m,S.hemiLength=h,S.numSunShadows=l,S.numDirectionalShadows=g,S.numPointShadows=_,S.numSpotShadows=v,S.numSpotMaps=y,S.numLightProbes=x,r.version=Yc++)}function c(e,t){let n=0,s=0,c=0,l=0,u=0,d=0,f=t.matrixWorldInverse;for(let t=0,p=e.length;t<p;t++){let p=e[t];if(p.isSunLight){let e=r.sun[n];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),n++}else if(p.isDirectionalLight){let e=r.directional[s];e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),s++}else if(p.isSpotLight){let e=r.spot[l];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),l++}else if(p.isRectAreaLight){let e=r.rectArea[u];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),o.identity(),a.copy(p.matrixWorld),a.premultiply(f),o.extractRotation(a),e.halfWidth.set(p.width*.5,0,0),e.halfHeight.set(0,p.height*.5,0),e.halfWidth.applyMatrix4(o),e.halfHeight.applyMatrix4(o),u++}else if(p.isPointLight){let e=r.point[c];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),c++}else if(p.isHemisphereLight){let e=r.hemi[d];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),d++}}}return{setup:s,setupView:c,state:r}}function Qc(e){let t=new Zc(e),n=[],r=[],i=[];function a(e){u.camera=e,n.length=0,r.length=0,i.length=0}function o(e){e.isLightProbeGrid?i.push(e):n.push(e)}function s(e){r.push(e)}function c(){t.setup(n),i.sort((e,t)=>e.priority-t.priority||e.id-t.id)}function l(e){t.setupView(n,e)}let u={lightsArray:n,shadowsArray:r,lightProbeGridArray:i,camera:null,lights:t,transmissionRenderTarget:{},textureUnits:0};return{init:a,state:u,setupLights:c,setupLightsView:l,pushLight:o,pushShadow:s}}function $c(e){let t=new WeakMap;function n(n,r=0){let i=t.get(n),a;return i===void 0?(a=new Qc(e),t.set(n,[a])):r>=i.length?(a=new Qc(e),i.push(a)):a=i[r],a}function r(){t=new WeakMap}return{get:n,dispose:r}}var el=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,tl=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,nl=[new W(1,0,0),new W(-1,0,0),new W(0,1,0),new W(0,-1,0),new W(0,0,1),new W(0,0,-1)],rl=[new W(0,-1,0),new W(0,-1,0),new W(0,0,1),new W(0,0,-1),new W(0,-1,0),new W(0,-1,0)],il=new K,al=new W,ol=new W;function sl(e,t,n){let i=new qr,a=new H,s=new H,c=new rt,l=new Fi,u=new Ii,m={},h=n.maxTextureSize,g={0:1,1:0,2:2},_=new ji({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new H},radius:{value:4}},vertexShader:el,fragmentShader:tl}),y=_.clone();y.defines.HORIZONTAL_PASS=1;let b=new Un;b.setAttribute(`position`,new On(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let x=new _r(b,_),C=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=1;let w=this.type;this.render=function(t,n,l){if(C.enabled===!1||C.autoUpdate===!1&&C.needsUpdate===!1||t.length===0)return;this.type===2&&(L(`WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead.`),this.type=1);let u=e.getRenderTarget(),m=e.getActiveCubeFace(),g=e.getActiveMipmapLevel(),_=e.state;_.setBlending(0),_.buffers.depth.getReversed()===!0?_.buffers.color.setClear(0,0,0,0):_.buffers.color.setClear(1,1,1,1),_.buffers.depth.setTest(!0),_.setScissorTest(!1);let y=w!==this.type;y&&n.traverse(function(e){e.material&&(Array.isArray(e.material)?e.material.forEach(e=>e.needsUpdate=!0):e.material.needsUpdate=!0)});for(let u=0,m=t.length;u<m;u++){let m=t[u],g=m.shadow;if(g===void 0){L(`WebGLShadowMap:`,m,`has no shadow.`);continue}if(g.autoUpdate===!1&&g.needsUpdate===!1)continue;a.copy(g.mapSize);let b=g.getFrameExtents();a.multiply(b),s.copy(g.mapSize),(a.x>h||a.y>h)&&(a.x>h&&(s.x=Math.floor(h/b.x),a.x=s.x*b.x,g.mapSize.x=s.x),a.y>h&&(s.y=Math.floor(h/b.y),a.y=s.y*b.y,g.mapSize.y=s.y));let x=e.state.buffers.depth.getReversed();if(g.camera._reversedDepth=x,g.map===null||y===!0){if(g.map!==null&&(g.map.depthTexture!==null&&(g.map.depthTexture.dispose(),g.map.depthTexture=null),g.map.dispose()),this.type===3){if(m.isPointLight){L(`WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.`);continue}g.map=new at(a.x,a.y,{format:S,type:p,minFilter:o,magFilter:o,generateMipmaps:!1}),g.map.texture.name=m.name+`.shadowMap`,g.map.depthTexture=new vi(a.x,a.y,f),g.map.depthTexture.name=m.name+`.shadowMapDepth`,g.map.depthTexture.format=v,g.map.depthTexture.compareFunction=null,g.map.depthTexture.minFilter=r,g.map.depthTexture.magFilter=r}else m.isPointLight?(g.map=new wo(a.x),g.map.depthTexture=new yi(a.x,d)):(g.map=new at(a.x,a.y),g.map.depthTexture=new vi(a.x,a.y,d)),g.map.depthTexture.name=m.name+`.shadowMap`,g.map.depthTexture.format=v,this.type===1?(g.map.depthTexture.compareFunction=x?518:515,g.map.depthTexture.minFilter=o,g.map.depthTexture.magFilter=o):(g.map.depthTexture.compareFunction=null,g.map.depthTexture.minFilter=r,g.map.depthTexture.magFilter=r);g.camera.updateProjectionMatrix()}g.map.isWebGLCubeRenderTarget!==!0&&(g.map.width!==a.x||g.map.height!==a.y)&&g.map.setSize(a.x,a.y);let C=g.map.isWebGLCubeRenderTarget?6:g.getViewportCount();m.isPointLight!==!0&&g.updateMatrices(m,l);let w=g.camera.layers.mask&4294967294?g.camera.layers:l.layers;for(let t=0;t<C;t++){let r=g.getCamera(t);if(m.isPointLight){let e=g.camera,n=g.matrix,r=m.distance||e.far;r!==e.far&&(e.far=r,e.updateProjectionMatrix()),al.setFromMatrixPosition(m.matrixWorld),e.position.copy(al),ol.copy(e.position),ol.add(nl[t]),e.up.copy(rl[t]),e.lookAt(ol),e.updateMatrixWorld(),n.makeTranslation(-al.x,-al.y,-al.z),il.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),g._frustum.setFromProjectionMatrix(il,e.coordinateSystem,e.reversedDepth)}if(g.map.isWebGLCubeRenderTarget)e.setRenderTarget(g.map,t),e.clear();else{t===0&&(e.setRenderTarget(g.map),e.clear());let n=g.getViewport(t);c.set(s.x*n.x,s.y*n.y,s.x*n.z,s.y*n.w),_.viewport(c)}i=g.getFrustum(t),D(n,l,r,m,w,this.type)}g.isPointLightShadow!==!0&&this.type===3&&T(g,l),g.needsUpdate=!1}w=this.type,C.needsUpdate=!1,e.setRenderTarget(u,m,g)};function T(n,r){let i=t.update(x);_.defines.VSM_SAMPLES!==n.blurSamples&&(_.defines.VSM_SAMPLES=n.blurSamples,y.defines.VSM_SAMPLES=n.blurSamples,_.needsUpdate=!0,y.needsUpdate=!0),n.mapPass===null?n.mapPass=new at(a.x,a.y,{format:S,type:p}):(n.mapPass.width!==n.map.width||n.mapPass.height!==n.map.height)&&n.mapPass.setSize(n.map.width,n.map.height),_.uniforms.shadow_pass.value=n.map.depthTexture,_.uniforms.resolution.value.set(n.map.width,n.map.height),_.uniforms.radius.value=n.radius,e.setRenderTarget(n.mapPass),e.clear(),e.renderBufferDirect(r,null,i,_,x,null),y.uniforms.shadow_pass.value=n.mapPass.texture,y.uniforms.resolution.value.set(n.map.width,n.map.height),y.uniforms.radius.value=n.radius,e.setRenderTarget(n.map),e.clear(),e.renderBufferDirect(r,null,i,y,x,null)}function E(t,n,r,i){let a=null,o=r.isPointLight===!0?t.customDistanceMaterial:t.customDepthMaterial;if(o!==void 0)a=o;else if(a=r.isPointLight===!0?u:l,e.localClippingEnabled&&n.clipShadows===!0&&Array.isArray(n.clippingPlanes)&&n.clippingPlanes.length!==0||n.displacementMap&&n.displacementScale!==0||n.alphaMap&&n.alphaTest>0||n.map&&n.alphaTest>0||n.alphaToCoverage===!0){let e=a.uuid,t=n.uuid,r=m[e];r===void 0&&(r={},m[e]=r);let i=r[t];i===void 0&&(i=a.clone(),r[t]=i,n.addEventListener(`dispose`,O)),a=i}if(a.visible=n.visible,a.wireframe=n.wireframe,i===3?a.side=n.shadowSide===null?n.side:n.shadowSide:a.side=n.shadowSide===null?g[n.side]:n.shadowSide,a.alphaMap=n.alphaMap,a.alphaTest=n.alphaToCoverage===!0?.5:n.alphaTest,a.map=n.map,a.clipShadows=n.clipShadows,a.clippingPlanes=n.clippingPlanes,a.clipIntersection=n.clipIntersection,a.displacementMap=n.displacementMap,a.displacementScale=n.displacementScale,a.displacementBias=n.displacementBias,a.wireframeLinewidth=n.wireframeLinewidth,a.linewidth=n.linewidth,r.isPointLight===!0&&a.isMeshDistanceMaterial===!0){let t=e.properties.get(a);t.light=r}return a}function D(n,r,a,o,s,c){if(n.visible===!1)return;if(n.layers.test(s)&&(n.isMesh||n.isLine||n.isPoints)&&(n.castShadow||n.receiveShadow&&c===3)&&(!n.frustumCulled||n.intersectsFrustum(i))){n.modelViewMatrix.multiplyMatrices(a.matrixWorldInverse,n.matrixWorld);let i=t.update(n),s=n.material;if(Array.isArray(s)){let t=i.groups;for(let l=0,u=t.length;l<u;l++){let u=t[l],d=s[u.materialIndex];if(d&&d.visible){let t=E(n,d,o,c);n.onBeforeShadow(e,n,r,a,i,t,u),e.renderBufferDirect(a,null,i,t,n,u),n.onAfterShadow(e,n,r,a,i,t,u)}}}else if(s.visible){let t=E(n,s,o,c);n.onBeforeShadow(e,n,r,a,i,t,null),e.renderBufferDirect(a,null,i,t,n,null),n.onAfterShadow(e,n,r,a,i,t,null)}}let l=n.children;for(let e=0,t=l.length;e<t;e++)D(l[e],r,a,o,s,c)}function O(e){e.target.removeEventListener(`dispose`,O);for(let t in m){let n=m[t],r=e.target.uuid;r in n&&(n[r].dispose(),delete n[r])}}}function cl(e,t){function n(){let t=!1,n=new rt,r=null,i=new rt(0,0,0,0);return{setMask:function(n){r!==n&&!t&&(e.colorMask(n,n,n,n),r=n)},setLocked:function(e){t=e},setClear:function(t,r,a,o,s){s===!0&&(t*=o,r*=o,a*=o),n.set(t,r,a,o),i.equals(n)===!1&&(e.clearColor(t,r,a,o),i.copy(n))},reset:function(){t=!1,r=null,i.set(-1,0,0,0)}}}function r(){let n=!1,r=!1,i=null,a=null,o=null;return{setReversed:function(e){if(r!==e){let n=t.get(`EXT_clip_control`);e?n.clipControlEXT(n.LOWER_LEFT_EXT,n.ZERO_TO_ONE_EXT):n.clipControlEXT(n.LOWER_LEFT_EXT,n.NEGATIVE_ONE_TO_ONE_EXT),r=e;let i=o;o=null,this.setClear(i)}},getReversed:function(){return r},setTest:function(t){t?se(e.DEPTH_TEST):ce(e.DEPTH_TEST)},setMask:function(t){i!==t&&!n&&(e.depthMask(t),i=t)},setFunc:function(t){if(r&&(t=pe[t]),a!==t){switch(t){case 0:e.depthFunc(e.NEVER);break;case 1:e.depthFunc(e.ALWAYS);break;case 2:e.depthFunc(e.LESS);break;case 3:e.depthFunc(e.LEQUAL);break;case 4:e.depthFunc(e.EQUAL);break;case 5:e.depthFunc(e.GEQUAL);break;case 6:e.depthFunc(e.GREATER);break;case 7:e.depthFunc(e.NOTEQUAL);break;default:e.depthFunc(e.LEQUAL)}a=t}},setLocked:function(e){n=e},setClear:function(t){o!==t&&(o=t,r&&(t=1-t),e.clearDepth(t))},reset:function(){n=!1,i=null,a=null,o=null,r=!1}}}function i(){let t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null;return{setTest:function(n){t||(n?se(e.STENCIL_TEST):ce(e.STENCIL_TEST))},setMask:function(r){n!==r&&!t&&(e.stencilMask(r),n=r)},setFunc:function(t,n,o){(r!==t||i!==n||a!==o)&&(e.stencilFunc(t,n,o),r=t,i=n,a=o)},setOp:function(t,n,r){(o!==t||s!==n||c!==r)&&(e.stencilOp(t,n,r),o=t,s=n,c=r)},setLocked:function(e){t=e},setClear:function(t){l!==t&&(e.clearStencil(t),l=t)},reset:function(){t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null}}}let a=new n,o=new r,s=new i,c={},l=new WeakMap,u={},d={},f={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new q(0,0,0),T=0,E=!1,D=null,O=null,k=null,A=null,j=null,M=e.getParameter(e.MAX_COMBINED_TEXTURE_IMAGE_UNITS),N=!1,P=0,ee=e.getParameter(e.VERSION);ee.indexOf(`WebGL`)===-1?ee.indexOf(`OpenGL ES`)!==-1&&(P=parseFloat(/^OpenGL ES (\d)/.exec(ee)[1]),N=P>=2):(P=parseFloat(/^WebGL (\d)/.exec(ee)[1]),N=P>=1);let te=null,F={},ne=e.getParameter(e.SCISSOR_BOX),I=e.getParameter(e.VIEWPORT),re=new rt().fromArray(ne),ie=new rt().fromArray(I);function ae(t,n,r,i){let a=new Uint8Array(4),o=e.createTexture();e.bindTexture(t,o),e.texParameteri(t,e.TEXTURE_MIN_FILTER,e.NEAREST),e.texParameteri(t,e.TEXTURE_MAG_FILTER,e.NEAREST);for(let o=0;o<r;o++)t===e.TEXTURE_3D||t===e.TEXTURE_2D_ARRAY?e.texImage3D(n,0,e.RGBA,1,1,i,0,e.RGBA,e.UNSIGNED_BYTE,a):e.texImage2D(n+o,0,e.RGBA,1,1,0,e.RGBA,e.UNSIGNED_BYTE,a);return o}let oe={};oe[e.TEXTURE_2D]=ae(e.TEXTURE_2D,e.TEXTURE_2D,1),oe[e.TEXTURE_CUBE_MAP]=ae(e.TEXTURE_CUBE_MAP,e.TEXTURE_CUBE_MAP_POSITIVE_X,6),oe[e.TEXTURE_2D_ARRAY]=ae(e.TEXTURE_2D_ARRAY,e.TEXTURE_2D_ARRAY,1,1),oe[e.TEXTURE_3D]=ae(e.TEXTURE_3D,e.TEXTURE_3D,1,1),a.setClear(0,0,0,1),o.setClear(1),s.setClear(0),se(e.DEPTH_TEST),o.setFunc(3),ge(!1),_e(1),se(e.CULL_FACE),me(0);function se(t){u[t]!==!0&&(e.enable(t),u[t]=!0)}function ce(t){u[t]!==!1&&(e.disable(t),u[t]=!1)}function le(t,n){return f[t]!==n&&(e.bindFramebuffer(t,n),f[t]=n,t===e.DRAW_FRAMEBUFFER&&(f[e.FRAMEBUFFER]=n),t===e.FRAMEBUFFER&&(f[e.DRAW_FRAMEBUFFER]=n),!0)}function ue(t,n){let r=m,i=!1;if(t){r=p.get(n),r===void 0&&(r=[],p.set(n,r));let a=t.textures;if(r.length!==a.length||r[0]!==e.COLOR_ATTACHMENT0){for(let t=0,n=a.length;t<n;t++)r[t]=e.COLOR_ATTACHMENT0+t;r.length=a.length,i=!0}}else r[0]!==e.BACK&&(r[0]=e.BACK,i=!0);i&&e.drawBuffers(r)}function L(t){return h!==t&&(e.useProgram(t),h=t,!0)}let de={100:e.FUNC_ADD,101:e.FUNC_SUBTRACT,102:e.FUNC_REVERSE_SUBTRACT};de[103]=e.MIN,de[104]=e.MAX;let fe={200:e.ZERO,201:e.ONE,202:e.SRC_COLOR,204:e.SRC_ALPHA,210:e.SRC_ALPHA_SATURATE,208:e.DST_COLOR,206:e.DST_ALPHA,203:e.ONE_MINUS_SRC_COLOR,205:e.ONE_MINUS_SRC_ALPHA,209:e.ONE_MINUS_DST_COLOR,207:e.ONE_MINUS_DST_ALPHA,211:e.CONSTANT_COLOR,212:e.ONE_MINUS_CONSTANT_COLOR,213:e.CONSTANT_ALPHA,214:e.ONE_MINUS_CONSTANT_ALPHA};function me(t,n,r,i,a,o,s,c,l,u){if(t===0)g===!0&&(ce(e.BLEND),g=!1);else if(g===!1&&(se(e.BLEND),g=!0),t!==5){if(t!==_||u!==E){if((v!==100||x!==100)&&(e.blendEquation(e.FUNC_ADD),v=100,x=100),u)switch(t){case 1:e.blendFuncSeparate(e.ONE,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFunc(e.ONE,e.ONE);break;case 3:e.blendFuncSeparate(e.ZERO,e.ONE_MINUS_SRC_COLOR,e.ZERO,e.ONE);break;case 4:e.blendFuncSeparate(e.DST_COLOR,e.ONE_MINUS_SRC_ALPHA,e.ZERO,e.ONE);break;default:R(`WebGLState: Invalid blending: `,t)}else switch(t){case 1:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE,e.ONE,e.ONE);break;case 3:R(`WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true`);break;case 4:R(`WebGLState: MultiplyBlending requires material.premultipliedAlpha = true`);break;default:R(`WebGLState: Invalid blending: `,t)}y=null,b=null,S=null,C=null,w.set(0,0,0),T=0,_=t,E=u}}else a||=n,o||=r,s||=i,(n!==v||a!==x)&&(e.blendEquationSeparate(de[n],de[a]),v=n,x=a),(r!==y||i!==b||o!==S||s!==C)&&(e.blendFuncSeparate(fe[r],fe[i],fe[o],fe[s]),y=r,b=i,S=o,C=s),(c.equals(w)===!1||l!==T)&&(e.blendColor(c.r,c.g,c.b,l),w.copy(c),T=l),_=t,E=!1}function he(t,n){t.side===2?ce(e.CULL_FACE):se(e.CULL_FACE);let r=t.side===1;n&&(r=!r),ge(r),t.blending===1&&t.transparent===!1?me(0):me(t.blending,t.blendEquation,t.blendSrc,t.blendDst,t.blendEquationAlpha,t.blendSrcAlpha,t.blendDstAlpha,t.blendColor,t.blendAlpha,t.premultipliedAlpha),o.setFunc(t.depthFunc),o.setTest(t.depthTest),o.setMask(t.depthWrite),a.setMask(t.colorWrite);let i=t.stencilWrite;s.setTest(i),i&&(s.setMask(t.stencilWriteMask),s.setFunc(t.stencilFunc,t.stencilRef,t.stencilFuncMask),s.setOp(t.stencilFail,t.stencilZFail,t.stencilZPass)),ye(t.polygonOffset,t.polygonOffsetFactor,t.polygonOffsetUnits),t.alphaToCoverage===!0?se(e.SAMPLE_ALPHA_TO_COVERAGE):ce(e.SAMPLE_ALPHA_TO_COVERAGE)}function ge(t){D!==t&&(t?e.frontFace(e.CW):e.frontFace(e.CCW),D=t)}function _e(t){t===0?ce(e.CULL_FACE):(se(e.CULL_FACE),t!==O&&(t===1?e.cullFace(e.BACK):t===2?e.cullFace(e.FRONT):e.cullFace(e.FRONT_AND_BACK))),O=t}function ve(t){t!==k&&(N&&e.lineWidth(t),k=t)}function ye(t,n,r){t?(se(e.POLYGON_OFFSET_FILL),(A!==n||j!==r)&&(A=n,j=r,o.getReversed()&&(n=-n,r=-r),e.polygonOffset(n,r))):ce(e.POLYGON_OFFSET_FILL)}function z(t){t?se(e.SCISSOR_TEST):ce(e.SCISSOR_TEST)}function be(t){t===void 0&&(t=e.TEXTURE0+M-1),te!==t&&(e.activeTexture(t),te=t)}function xe(t,n,r){r===void 0&&(r=te===null?e.TEXTURE0+M-1:te);let i=F[r];i===void 0&&(i={type:void 0,texture:void 0},F[r]=i),(i.type!==t||i.texture!==n)&&(te!==r&&(e.activeTexture(r),te=r),e.bindTexture(t,n||oe[t]),i.type=t,i.texture=n)}function Se(){let t=F[te];t!==void 0&&t.type!==void 0&&(e.bindTexture(t.type,null),t.type=void 0,t.texture=void 0)}function Ce(){try{e.compressedTexImage2D(...arguments)}catch(e){R(`WebGLState:`,e)}}function we(){try{e.compressedTexImage3D(...arguments)}catch(e){R(`WebGLState:`,e)}}function Te(){try{e.texSubImage2D(...arguments)}catch(e){R(`WebGLState:`,e)}}function Ee(){try{e.texSubImage3D(...arguments)}catch(e){R(`WebGLState:`,e)}}function De(){try{e.compressedTexSubImage2D(...arguments)}catch(e){R(`WebGLState:`,e)}}function Oe(){try{e.compressedTexSubImage3D(...arguments)}catch(e){R(`WebGLState:`,e)}}function ke(){try{e.texStorage2D(...arguments)}catch(e){R(`WebGLState:`,e)}}function Ae(){try{e.texStorage3D(...arguments)}catch(e){R(`WebGLState:`,e)}}function je(){try{e.texImage2D(...arguments)}catch(e){R(`WebGLState:`,e)}}function Me(){try{e.texImage3D(...arguments)}catch(e){R(`WebGLState:`,e)}}function Ne(t){return d[t]===void 0?e.getParameter(t):d[t]}function Pe(t,n){d[t]!==n&&(e.pixelStorei(t,n),d[t]=n)}function Fe(t){re.equals(t)===!1&&(e.scissor(t.x,t.y,t.z,t.w),re.copy(t))}function Ie(t){ie.equals(t)===!1&&(e.viewport(t.x,t.y,t.z,t.w),ie.copy(t))}function B(t,n){let r=l.get(n);r===void 0&&(r=new WeakMap,l.set(n,r));let i=r.get(t);i===void 0&&(i=e.getUniformBlockIndex(n,t.name),e.uniformBlockBinding(n,i,i),r.set(t,i))}function Le(t,n,r){let i=l.get(n).get(t);c[i]!==r&&(e.bindBufferBase(e.UNIFORM_BUFFER,i,r),c[i]=r)}function Re(){e.disable(e.BLEND),e.disable(e.CULL_FACE),e.disable(e.DEPTH_TEST),e.disable(e.POLYGON_OFFSET_FILL),e.disable(e.SCISSOR_TEST),e.disable(e.STENCIL_TEST),e.disable(e.SAMPLE_ALPHA_TO_COVERAGE),e.blendEquation(e.FUNC_ADD),e.blendFunc(e.ONE,e.ZERO),e.blendFuncSeparate(e.ONE,e.ZERO,e.ONE,e.ZERO),e.blendColor(0,0,0,0),e.colorMask(!0,!0,!0,!0),e.clearColor(0,0,0,0),e.depthMask(!0),e.depthFunc(e.LESS),o.setReversed(!1),e.clearDepth(1),e.stencilMask(4294967295),e.stencilFunc(e.ALWAYS,0,4294967295),e.stencilOp(e.KEEP,e.KEEP,e.KEEP),e.clearStencil(0),e.cullFace(e.BACK),e.frontFace(e.CCW),e.polygonOffset(0,0),e.activeTexture(e.TEXTURE0),e.bindFramebuffer(e.FRAMEBUFFER,null),e.bindFramebuffer(e.DRAW_FRAMEBUFFER,null),e.bindFramebuffer(e.READ_FRAMEBUFFER,null),e.useProgram(null),e.lineWidth(1),e.scissor(0,0,e.canvas.width,e.canvas.height),e.viewport(0,0,e.canvas.width,e.canvas.height),e.pixelStorei(e.PACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,!1),e.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),e.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,e.BROWSER_DEFAULT_WEBGL),e.pixelStorei(e.PACK_ROW_LENGTH,0),e.pixelStorei(e.PACK_SKIP_PIXELS,0),e.pixelStorei(e.PACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_ROW_LENGTH,0),e.pixelStorei(e.UNPACK_IMAGE_HEIGHT,0),e.pixelStorei(e.UNPACK_SKIP_PIXELS,0),e.pixelStorei(e.UNPACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_SKIP_IMAGES,0),u={},d={},te=null,F={},f={},c={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new q(0,0,0),T=0,E=!1,D=null,O=null,k=null,A=null,j=null,re.set(0,0,e.canvas.width,e.canvas.height),ie.set(0,0,e.canvas.width,e.canvas.height),a.reset(),o.reset(),s.reset()}return{buffers:{color:a,depth:o,stencil:s},enable:se,disable:ce,bindFramebuffer:le,drawBuffers:ue,useProgram:L,setBlending:me,setMaterial:he,setFlipSided:ge,setCullFace:_e,setLineWidth:ve,setPolygonOffset:ye,setScissorTest:z,activeTexture:be,bindTexture:xe,unbindTexture:Se,compressedTexImage2D:Ce,compressedTexImage3D:we,texImage2D:je,texImage3D:Me,pixelStorei:Pe,getParameter:Ne,updateUBOMapping:B,uniformBlockBinding:Le,texStorage2D:ke,texStorage3D:Ae,texSubImage2D:Te,texSubImage3D:Ee,compressedTexSubImage2D:De,compressedTexSubImage3D:Oe,scissor:Fe,viewport:Ie,reset:Re}}function ll(l,u,d,f,p,m,h){let g=u.has(`WEBGL_multisampled_render_to_texture`)?u.get(`WEBGL_multisampled_render_to_texture`):null,_=typeof navigator>`u`?!1:/OculusBrowser/g.test(navigator.userAgent),v=new H,b=new WeakMap,x=new Set,S,C=new WeakMap,w=new Set,T=new FinalizationRegistry(e=>w.delete(e)),E=!1;try{E=typeof OffscreenCanvas<`u`&&new OffscreenCanvas(1,1).getContext(`2d`)!==null}catch{}function D(e,t){return E?new OffscreenCanvas(e,t):oe(`canvas`)}function O(e,t,n){let r=1,i=V(e);if((i.width>n||i.height>n)&&(r=n/Math.max(i.width,i.height)),r<1){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap||typeof VideoFrame<`u`&&e instanceof VideoFrame){let n=Math.floor(r*i.width),a=Math.floor(r*i.height);S===void 0&&(S=D(n,a));let o=t?D(n,a):S;return o.width=n,o.height=a,o.getContext(`2d`).drawImage(e,0,0,n,a),L(`WebGLRenderer: Texture has been resized from (`+i.width+`x`+i.height+`) to (`+n+`x`+a+`).`),o}return`data`in e&&L(`WebGLRenderer: Image in DataTexture is too big (`+i.width+`x`+i.height+`).`),e}return e}function k(e){return e.generateMipmaps}function A(e){l.generateMipmap(e)}function j(e){return e.isWebGLCubeRenderTarget?l.TEXTURE_CUBE_MAP:e.isWebGL3DRenderTarget?l.TEXTURE_3D:e.isWebGLArrayRenderTarget||e.isCompressedArrayTexture?l.TEXTURE_2D_ARRAY:l.TEXTURE_2D}function M(e,t,n,r,i,a=!1){if(e!==null){if(l[e]!==void 0)return l[e];L(`WebGLRenderer: Attempt to use non-existing WebGL internal format '`+e+`'`)}let o;r&&(o=u.get(`EXT_texture_norm16`),o||L(`WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension`));let s=t;if(t===l.RED&&(n===l.FLOAT&&(s=l.R32F),n===l.HALF_FLOAT&&(s=l.R16F),n===l.UNSIGNED_BYTE&&(s=l.R8),n===l.UNSIGNED_SHORT&&o&&(s=o.R16_EXT),n===l.SHORT&&o&&(s=o.R16_SNORM_EXT)),t===l.RED_INTEGER&&(n===l.UNSIGNED_BYTE&&(s=l.R8UI),n===l.UNSIGNED_SHORT&&(s=l.R16UI),n===l.UNSIGNED_INT&&(s=l.R32UI),n===l.BYTE&&(s=l.R8I),n===l.SHORT&&(s=l.R16I),n===l.INT&&(s=l.R32I)),t===l.RG&&(n===l.FLOAT&&(s=l.RG32F),n===l.HALF_FLOAT&&(s=l.RG16F),n===l.UNSIGNED_BYTE&&(s=l.RG8),n===l.UNSIGNED_SHORT&&o&&(s=o.RG16_EXT),n===l.SHORT&&o&&(s=o.RG16_SNORM_EXT)),t===l.RG_INTEGER&&(n===l.UNSIGNED_BYTE&&(s=l.RG8UI),n===l.UNSIGNED_SHORT&&(s=l.RG16UI),n===l.UNSIGNED_INT&&(s=l.RG32UI),n===l.BYTE&&(s=l.RG8I),n===l.SHORT&&(s=l.RG16I),n===l.INT&&(s=l.RG32I)),t===l.RGB_INTEGER&&(n===l.UNSIGNED_BYTE&&(s=l.RGB8UI),n===l.UNSIGNED_SHORT&&(s=l.RGB16UI),n===l.UNSIGNED_INT&&(s=l.RGB32UI),n===l.BYTE&&(s=l.RGB8I),n===l.SHORT&&(s=l.RGB16I),n===l.INT&&(s=l.RGB32I)),t===l.RGBA_INTEGER&&(n===l.UNSIGNED_BYTE&&(s=l.RGBA8UI),n===l.UNSIGNED_SHORT&&(s=l.RGBA16UI),n===l.UNSIGNED_INT&&(s=l.RGBA32UI),n===l.BYTE&&(s=l.RGBA8I),n===l.SHORT&&(s=l.RGBA16I),n===l.INT&&(s=l.RGBA32I)),t===l.RGB&&(n===l.UNSIGNED_SHORT&&o&&(s=o.RGB16_EXT),n===l.SHORT&&o&&(s=o.RGB16_SNORM_EXT),n===l.UNSIGNED_INT_5_9_9_9_REV&&(s=l.RGB9_E5),n===l.UNSIGNED_INT_10F_11F_11F_REV&&(s=l.R11F_G11F_B10F)),t===l.RGBA){let e=a?P:Ke.getTransfer(i);n===l.FLOAT&&(s=l.RGBA32F),n===l.HALF_FLOAT&&(s=l.RGBA16F),n===l.UNSIGNED_BYTE&&(s=e===`srgb`?l.SRGB8_ALPHA8:l.RGBA8),n===l.UNSIGNED_SHORT&&o&&(s=o.RGBA16_EXT),n===l.SHORT&&o&&(s=o.RGBA16_SNORM_EXT),n===l.UNSIGNED_SHORT_4_4_4_4&&(s=l.RGBA4),n===l.UNSIGNED_SHORT_5_5_5_1&&(s=l.RGB5_A1)}return(s===l.R16F||s===l.R32F||s===l.RG16F||s===l.RG32F||s===l.RGBA16F||s===l.RGBA32F)&&u.get(`EXT_color_buffer_float`),s}function N(e,t){let n;return e?t===null||t===1014||t===1020?n=l.DEPTH24_STENCIL8:t===1015?n=l.DEPTH32F_STENCIL8:t===1012&&(n=l.DEPTH24_STENCIL8,L(`DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.`)):t===null||t===1014||t===1020?n=l.DEPTH_COMPONENT24:t===1015?n=l.DEPTH_COMPONENT32F:t===1012&&(n=l.DEPTH_COMPONENT16),n}function ee(e,t){return k(e)===!0||e.isFramebufferTexture&&e.minFilter!==1003&&e.minFilter!==1006?Math.log2(Math.max(t.width,t.height))+1:e.mipmaps.length>0?e.mipmaps.length:e.isCompressedTexture&&Array.isArray(e.image)?t.mipmaps.length:1}function te(e){let t=new WeakRef(e);f.get(e).__ref=t,w.add(t),T.register(e,t,t)}function F(e){let t=f.get(e).__ref;t!==void 0&&(w.delete(t),T.unregister(t))}function ne(e){re(e.target)}function I(e){ie(e.target)}function re(e){e.removeEventListener(`dispose`,ne),F(e),se(e),e.isVideoTexture&&b.delete(e),e.isHTMLTexture&&x.delete(e)}function ie(e){e.removeEventListener(`dispose`,I),F(e),le(e)}function ae(){for(let e of w){let t=e.deref();t!==void 0&&(t.isRenderTarget===!0?ie(t):re(t))}w.clear(),x.clear()}function se(e){let t=f.get(e);if(t.__webglInit===void 0)return;let n=e.source,r=C.get(n);if(r){let i=r[t.__cacheKey];i.usedTimes--,i.usedTimes===0&&ce(e),Object.keys(r).length===0&&C.delete(n)}f.remove(e)}function ce(e){let t=f.get(e);l.deleteTexture(t.__webglTexture);let n=e.source,r=C.get(n);delete r[t.__cacheKey],h.memory.textures--}function le(e){let t=f.get(e);t.__depthDisposeCallback&&t.__depthDisposeCallback();let n=e.depthTexture;if(n&&n.renderTarget===e&&re(n),e.isWebGLCubeRenderTarget)for(let e=0;e<6;e++){if(Array.isArray(t.__webglFramebuffer[e]))for(let n=0;n<t.__webglFramebuffer[e].length;n++)l.deleteFramebuffer(t.__webglFramebuffer[e][n]);else l.deleteFramebuffer(t.__webglFramebuffer[e]);t.__webglDepthbuffer&&l.deleteRenderbuffer(t.__webglDepthbuffer[e])}else{if(Array.isArray(t.__webglFramebuffer))for(let e=0;e<t.__webglFramebuffer.length;e++)l.deleteFramebuffer(t.__webglFramebuffer[e]);else l.deleteFramebuffer(t.__webglFramebuffer);if(t.__webglDepthbuffer&&l.deleteRenderbuffer(t.__webglDepthbuffer),t.__webglMultisampledFramebuffer&&l.deleteFramebuffer(t.__webglMultisampledFramebuffer),t.__webglColorRenderbuffer)for(let e=0;e<t.__webglColorRenderbuffer.length;e++)t.__webglColorRenderbuffer[e]&&l.deleteRenderbuffer(t.__webglColorRenderbuffer[e]);t.__webglDepthRenderbuffer&&l.deleteRenderbuffer(t.__webglDepthRenderbuffer)}let r=e.textures;for(let e=0,t=r.length;e<t;e++){let t=f.get(r[e]);t.__webglTexture&&(l.deleteTexture(t.__webglTexture),h.memory.textures--),f.remove(r[e])}f.remove(e)}let ue=0;function de(){ue=0}function fe(){return ue}function pe(e){ue=e}function me(){let e=ue;return e>=p.maxTextures&&L(`WebGLTextures: Trying to use `+(e+1)+` texture units while this GPU supports only `+p.maxTextures),ue+=1,e}function he(e){let t=[];return t.push(e.wrapS),t.push(e.wrapT),t.push(e.wrapR||0),t.push(e.magFilter),t.push(e.minFilter),t.push(e.anisotropy),t.push(e.internalFormat),t.push(e.format),t.push(e.type),t.push(e.generateMipmaps),t.push(e.mipmapsAutoUpdate),t.push(e.premultiplyAlpha),t.push(e.flipY),t.push(e.unpackAlignment),t.push(e.colorSpace),t.join()}function ge(e,t){let n=f.get(e);if(e.isVideoTexture&&Re(e),e.isRenderTargetTexture===!1&&e.isExternalTexture!==!0&&e.version>0&&n.__version!==e.version){let r=e.image;if(r===null)L(`WebGLRenderer: Texture marked for update but no image data found.`);else if(r.complete===!1)L(`WebGLRenderer: Texture marked for update but image is incomplete`);else{Ee(n,e,t);return}}else e.isExternalTexture&&(n.__webglTexture=e.sourceTexture?e.sourceTexture:null);d.bindTexture(l.TEXTURE_2D,n.__webglTexture,l.TEXTURE0+t)}function _e(e,t){let n=f.get(e);e.isRenderTargetTexture===!1&&e.version>0&&n.__version!==e.version?Ee(n,e,t):(e.isExternalTexture&&(n.__webglTexture=e.sourceTexture?e.sourceTexture:null),d.bindTexture(l.TEXTURE_2D_ARRAY,n.__webglTexture,l.TEXTURE0+t))}function ve(e,t){let n=f.get(e);e.isRenderTargetTexture===!1&&e.version>0&&n.__version!==e.version?Ee(n,e,t):d.bindTexture(l.TEXTURE_3D,n.__webglTexture,l.TEXTURE0+t)}function ye(e,t){let n=f.get(e);e.version>0&&n.__version!==e.version?De(n,e,t):d.bindTexture(l.TEXTURE_CUBE_MAP,n.__webglTexture,l.TEXTURE0+t)}let z={[e]:l.REPEAT,[t]:l.CLAMP_TO_EDGE,[n]:l.MIRRORED_REPEAT},be={[r]:l.NEAREST,[i]:l.NEAREST_MIPMAP_NEAREST,[a]:l.NEAREST_MIPMAP_LINEAR,[o]:l.LINEAR,[s]:l.LINEAR_MIPMAP_NEAREST,[c]:l.LINEAR_MIPMAP_LINEAR},xe={512:l.NEVER,519:l.ALWAYS,513:l.LESS,515:l.LEQUAL,514:l.EQUAL,518:l.GEQUAL,516:l.GREATER,517:l.NOTEQUAL};function Se(e,t){if(t.type===1015&&u.has(`OES_texture_float_linear`)===!1&&(t.magFilter===1006||t.magFilter===1007||t.magFilter===1005||t.magFilter===1008||t.minFilter===1006||t.minFilter===1007||t.minFilter===1005||t.minFilter===1008)&&L(`WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device.`),l.texParameteri(e,l.TEXTURE_WRAP_S,z[t.wrapS]),l.texParameteri(e,l.TEXTURE_WRAP_T,z[t.wrapT]),(e===l.TEXTURE_3D||e===l.TEXTURE_2D_ARRAY)&&l.texParameteri(e,l.TEXTURE_WRAP_R,z[t.wrapR]),l.texParameteri(e,l.TEXTURE_MAG_FILTER,be[t.magFilter]),l.texParameteri(e,l.TEXTURE_MIN_FILTER,be[t.minFilter]),t.compareFunction&&(l.texParameteri(e,l.TEXTURE_COMPARE_MODE,l.COMPARE_REF_TO_TEXTURE),l.texParameteri(e,l.TEXTURE_COMPARE_FUNC,xe[t.compareFunction])),u.has(`EXT_texture_filter_anisotropic`)===!0){if(t.magFilter===1003||t.minFilter!==1005&&t.minFilter!==1008||t.type===1015&&u.has(`OES_texture_float_linear`)===!1)return;if(t.anisotropy>1||f.get(t).__currentAnisotropy){let n=u.get(`EXT_texture_filter_anisotropic`);l.texParameterf(e,n.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(t.anisotropy,p.getMaxAnisotropy())),f.get(t).__currentAnisotropy=t.anisotropy}}}function Ce(e,t){let n=!1;e.__webglInit===void 0&&(e.__webglInit=!0,t.addEventListener(`dispose`,ne),te(t));let r=t.source,i=C.get(r);i===void 0&&(i={},C.set(r,i));let a=he(t);if(a!==e.__cacheKey){i[a]===void 0&&(i[a]={texture:l.createTexture(),usedTimes:0},h.memory.textures++,n=!0),i[a].usedTimes++;let r=i[e.__cacheKey];r!==void 0&&(i[e.__cacheKey].usedTimes--,r.usedTimes===0&&ce(t)),e.__cacheKey=a,e.__webglTexture=i[a].texture}return n}function we(e,t,n){return Math.floor(Math.floor(e/n)/t)}function Te(e,t,n,r){let i=e.updateRanges;if(i.length===0)d.texSubImage2D(l.TEXTURE_2D,0,0,0,t.width,t.height,n,r,t.data);else{i.sort((e,t)=>e.start-t.start);let a=0;for(let e=1;e<i.length;e++){let n=i[a],r=i[e],o=n.start+n.count,s=we(r.start,t.width,4),c=we(n.start,t.width,4);r.start<=o+1&&s===c&&we(r.start+r.count-1,t.width,4)===s?n.count=Math.max(n.count,r.start+r.count-n.start):(++a,i[a]=r)}i.length=a+1;let o=d.getParameter(l.UNPACK_ROW_LENGTH),s=d.getParameter(l.UNPACK_SKIP_PIXELS),c=d.getParameter(l.UNPACK_SKIP_ROWS);d.pixelStorei(l.UNPACK_ROW_LENGTH,t.width);for(let e=0,a=i.length;e<a;e++){let a=i[e],o=Math.floor(a.start/4),s=Math.ceil(a.count/4),c=o%t.width,u=Math.floor(o/t.width),f=s;d.pixelStorei(l.UNPACK_SKIP_PIXELS,c),d.pixelStorei(l.UNPACK_SKIP_ROWS,u),d.texSubImage2D(l.TEXTURE_2D,0,c,u,f,1,n,r,t.data)}e.clearUpdateRanges(),d.pixelStorei(l.UNPACK_ROW_LENGTH,o),d.pixelStorei(l.UNPACK_SKIP_PIXELS,s),d.pixelStorei(l.UNPACK_SKIP_ROWS,c)}}function Ee(e,t,n){let r=l.TEXTURE_2D;(t.isDataArrayTexture||t.isCompressedArrayTexture)&&(r=l.TEXTURE_2D_ARRAY),t.isData3DTexture&&(r=l.TEXTURE_3D);let i=Ce(e,t),a=t.source;d.bindTexture(r,e.__webglTexture,l.TEXTURE0+n);let o=f.get(a);if(a.version!==o.__version||i===!0){if(d.activeTexture(l.TEXTURE0+n),!(typeof ImageBitmap<`u`&&t.image instanceof ImageBitmap)){let e=Ke.getPrimaries(Ke.workingColorSpace),n=t.colorSpace===``?null:Ke.getPrimaries(t.colorSpace),r=t.colorSpace===``||e===n?l.NONE:l.BROWSER_DEFAULT_WEBGL;d.pixelStorei(l.UNPACK_FLIP_Y_WEBGL,t.flipY),d.pixelStorei(l.UNPACK_PREMULTIPLY_ALPHA_WEBGL,t.premultiplyAlpha),d.pixelStorei(l.UNPACK_COLORSPACE_CONVERSION_WEBGL,r)}d.pixelStorei(l.UNPACK_ALIGNMENT,t.unpackAlignment);let e=O(t.image,!1,p.maxTextureSize);e=ze(t,e);let s=m.convert(t.format,t.colorSpace),c=m.convert(t.type),u=M(t.internalFormat,s,c,t.normalized,t.colorSpace,t.isVideoTexture);Se(r,t);let f,h=t.mipmaps,g=t.isVideoTexture!==!0,_=o.__version===void 0||i===!0,v=a.dataReady,b=ee(t,e);if(t.isDepthTexture)u=N(t.format===y,t.type),_&&(g?d.texStorage2D(l.TEXTURE_2D,1,u,e.width,e.height):d.texImage2D(l.TEXTURE_2D,0,u,e.width,e.height,0,s,c,null));else if(t.isDataTexture){if(h.length>0){g&&_&&d.texStorage2D(l.TEXTURE_2D,b,u,h[0].width,h[0].height);for(let e=0,t=h.length;e<t;e++)f=h[e],g?v&&d.texSubImage2D(l.TEXTURE_2D,e,0,0,f.width,f.height,s,c,f.data):d.texImage2D(l.TEXTURE_2D,e,u,f.width,f.height,0,s,c,f.data);t.generateMipmaps=!1}else g?(_&&d.texStorage2D(l.TEXTURE_2D,b,u,e.width,e.height),v&&Te(t,e,s,c)):d.texImage2D(l.TEXTURE_2D,0,u,e.width,e.height,0,s,c,e.data)}else if(t.isCompressedTexture){if(t.isCompressedArrayTexture){g&&_&&d.texStorage3D(l.TEXTURE_2D_ARRAY,b,u,h[0].width,h[0].height,e.depth);for(let n=0,r=h.length;n<r;n++)if(f=h[n],t.format!==1023){if(s!==null){if(g){if(v){if(t.layerUpdates.size>0){let e=uo(f.width,f.height,t.format,t.type);for(let r of t.layerUpdates){let t=f.data.subarray(r*e/f.data.BYTES_PER_ELEMENT,(r+1)*e/f.data.BYTES_PER_ELEMENT);d.compressedTexSubImage3D(l.TEXTURE_2D_ARRAY,n,0,0,r,f.width,f.height,1,s,t)}}else d.compressedTexSubImage3D(l.TEXTURE_2D_ARRAY,n,0,0,0,f.width,f.height,e.depth,s,f.data)}}else d.compressedTexImage3D(l.TEXTURE_2D_ARRAY,n,u,f.width,f.height,e.depth,0,f.data,0,0)}else L(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`)}else g?v&&d.texSubImage3D(l.TEXTURE_2D_ARRAY,n,0,0,0,f.width,f.height,e.depth,s,c,f.data):d.texImage3D(l.TEXTURE_2D_ARRAY,n,u,f.width,f.height,e.depth,0,s,c,f.data);t.layerUpdates.size>0&&t.clearLayerUpdates()}else{g&&_&&d.texStorage2D(l.TEXTURE_2D,b,u,h[0].width,h[0].height);for(let e=0,n=h.length;e<n;e++)f=h[e],t.format===1023?g?v&&d.texSubImage2D(l.TEXTURE_2D,e,0,0,f.width,f.height,s,c,f.data):d.texImage2D(l.TEXTURE_2D,e,u,f.width,f.height,0,s,c,f.data):s===null?L(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`):g?v&&d.compressedTexSubImage2D(l.TEXTURE_2D,e,0,0,f.width,f.height,s,f.data):d.compressedTexImage2D(l.TEXTURE_2D,e,u,f.width,f.height,0,f.data)}}else if(t.isDataArrayTexture){if(g){if(_&&d.texStorage3D(l.TEXTURE_2D_ARRAY,b,u,e.width,e.height,e.depth),v){if(t.layerUpdates.size>0){let n=uo(e.width,e.height,t.format,t.type);for(let r of t.layerUpdates){let t=e.data.subarray(r*n/e.data.BYTES_PER_ELEMENT,(r+1)*n/e.data.BYTES_PER_ELEMENT);d.texSubImage3D(l.TEXTURE_2D_ARRAY,0,0,0,r,e.width,e.height,1,s,c,t)}t.clearLayerUpdates()}else d.texSubImage3D(l.TEXTURE_2D_ARRAY,0,0,0,0,e.width,e.height,e.depth,s,c,e.data)}}else d.texImage3D(l.TEXTURE_2D_ARRAY,0,u,e.width,e.height,e.depth,0,s,c,e.data)}else if(t.isData3DTexture)g?(_&&d.texStorage3D(l.TEXTURE_3D,b,u,e.width,e.height,e.depth),v&&d.texSubImage3D(l.TEXTURE_3D,0,0,0,0,e.width,e.height,e.depth,s,c,e.data)):d.texImage3D(l.TEXTURE_3D,0,u,e.width,e.height,e.depth,0,s,c,e.data);else if(t.isFramebufferTexture){if(_){if(g)d.texStorage2D(l.TEXTURE_2D,b,u,e.width,e.height);else{let t=e.width,n=e.height;for(let e=0;e<b;e++)d.texImage2D(l.TEXTURE_2D,e,u,t,n,0,s,c,null),t>>=1,n>>=1}}}else if(t.isHTMLTexture){if(`texElementImage2D`in l){let n=l.canvas;if(n.hasAttribute(`layoutsubtree`)||n.setAttribute(`layoutsubtree`,`true`),e.parentNode!==n){n.appendChild(e),x.add(t),n.onpaint=e=>{let t=e.changedElements;for(let e of x)t.includes(e.image)&&(e.needsUpdate=!0)},n.requestPaint();return}if(l.texElementImage2D.length===3)l.texElementImage2D(l.TEXTURE_2D,l.RGBA8,e);else{let t=l.RGBA,n=l.RGBA,r=l.UNSIGNED_BYTE;l.texElementImage2D(l.TEXTURE_2D,0,t,n,r,e)}l.texParameteri(l.TEXTURE_2D,l.TEXTURE_MIN_FILTER,l.LINEAR),l.texParameteri(l.TEXTURE_2D,l.TEXTURE_WRAP_S,l.CLAMP_TO_EDGE),l.texParameteri(l.TEXTURE_2D,l.TEXTURE_WRAP_T,l.CLAMP_TO_EDGE)}}else if(h.length>0){if(g&&_){let e=V(h[0]);d.texStorage2D(l.TEXTURE_2D,b,u,e.width,e.height)}for(let e=0,t=h.length;e<t;e++)f=h[e],g?v&&d.texSubImage2D(l.TEXTURE_2D,e,0,0,s,c,f):d.texImage2D(l.TEXTURE_2D,e,u,s,c,f);t.generateMipmaps=!1}else if(g){if(_){let t=V(e);d.texStorage2D(l.TEXTURE_2D,b,u,t.width,t.height)}v&&d.texSubImage2D(l.TEXTURE_2D,0,0,0,s,c,e)}else d.texImage2D(l.TEXTURE_2D,0,u,s,c,e);k(t)&&t.mipmapsAutoUpdate===!0&&A(r),o.__version=a.version,t.onUpdate&&t.onUpdate(t)}e.__version=t.version}function De(e,t,n){if(t.image.length!==6)return;let r=Ce(e,t),i=t.source;d.bindTexture(l.TEXTURE_CUBE_MAP,e.__webglTexture,l.TEXTURE0+n);let a=f.get(i);if(i.version!==a.__version||r===!0){d.activeTexture(l.TEXTURE0+n);let e=Ke.getPrimaries(Ke.workingColorSpace),o=t.colorSpace===``?null:Ke.getPrimaries(t.colorSpace),s=t.colorSpace===``||e===o?l.NONE:l.BROWSER_DEFAULT_WEBGL;d.pixelStorei(l.UNPACK_FLIP_Y_WEBGL,t.flipY),d.pixelStorei(l.UNPACK_PREMULTIPLY_ALPHA_WEBGL,t.premultiplyAlpha),d.pixelStorei(l.UNPACK_ALIGNMENT,t.unpackAlignment),d.pixelStorei(l.UNPACK_COLORSPACE_CONVERSION_WEBGL,s);let c=t.isCompressedTexture||t.image[0].isCompressedTexture,u=t.image[0]&&t.image[0].isDataTexture,f=[];for(let e=0;e<6;e++)!c&&!u?f[e]=O(t.image[e],!0,p.maxCubemapSize):f[e]=u?t.image[e].image:t.image[e],f[e]=ze(t,f[e]);let h=f[0],g=m.convert(t.format,t.colorSpace),_=m.convert(t.type),v=M(t.internalFormat,g,_,t.normalized,t.colorSpace),b=t.isVideoTexture!==!0,x=a.__version===void 0||r===!0,S=i.dataReady,C=ee(t,h);Se(l.TEXTURE_CUBE_MAP,t);let w;if(t.isDepthTexture){if(v=N(t.format===y,t.type),x){if(b)d.texStorage2D(l.TEXTURE_CUBE_MAP,1,v,h.width,h.height);else for(let e=0;e<6;e++)d.texImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,0,v,h.width,h.height,0,g,_,null)}}else if(c){b&&x&&d.texStorage2D(l.TEXTURE_CUBE_MAP,C,v,h.width,h.height);for(let e=0;e<6;e++){w=f[e].mipmaps;for(let n=0;n<w.length;n++){let r=w[n];t.format===1023?b?S&&d.texSubImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,n,0,0,r.width,r.height,g,_,r.data):d.texImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,n,v,r.width,r.height,0,g,_,r.data):g===null?L(`WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()`):b?S&&d.compressedTexSubImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,n,0,0,r.width,r.height,g,r.data):d.compressedTexImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,n,v,r.width,r.height,0,r.data)}}}else{if(w=t.mipmaps,b&&x){w.length>0&&C++;let e=V(f[0]);d.texStorage2D(l.TEXTURE_CUBE_MAP,C,v,e.width,e.height)}for(let e=0;e<6;e++)if(u){b?S&&d.texSubImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,0,0,0,f[e].width,f[e].height,g,_,f[e].data):d.texImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,0,v,f[e].width,f[e].height,0,g,_,f[e].data);for(let t=0;t<w.length;t++){let n=w[t].image[e].image;b?S&&d.texSubImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,t+1,0,0,n.width,n.height,g,_,n.data):d.texImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,t+1,v,n.width,n.height,0,g,_,n.data)}}else{b?S&&d.texSubImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,0,0,0,g,_,f[e]):d.texImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,0,v,g,_,f[e]);for(let t=0;t<w.length;t++){let n=w[t];b?S&&d.texSubImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,t+1,0,0,g,_,n.image[e]):d.texImage2D(l.TEXTURE_CUBE_MAP_POSITIVE_X+e,t+1,v,g,_,n.image[e])}}}k(t)&&t.mipmapsAutoUpdate===!0&&A(l.TEXTURE_CUBE_MAP),a.__version=i.version,t.onUpdate&&t.onUpdate(t)}e.__version=t.version}function Oe(e,t,n,r,i,a){let o=m.convert(n.format,n.colorSpace),s=m.convert(n.type),c=M(n.internalFormat,o,s,n.normalized,n.colorSpace),u=f.get(t),p=f.get(n);if(p.__renderTarget=t,!u.__hasExternalTextures){let e=Math.max(1,t.width>>a),n=Math.max(1,t.height>>a);i===l.TEXTURE_3D||i===l.TEXTURE_2D_ARRAY?d.texImage3D(i,a,c,e,n,t.depth,0,o,s,null):d.texImage2D(i,a,c,e,n,0,o,s,null)}d.bindFramebuffer(l.FRAMEBUFFER,e),Le(t)?g.framebufferTexture2DMultisampleEXT(l.FRAMEBUFFER,r,i,p.__webglTexture,0,B(t)):(i===l.TEXTURE_2D||i>=l.TEXTURE_CUBE_MAP_POSITIVE_X&&i<=l.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&l.framebufferTexture2D(l.FRAMEBUFFER,r,i,p.__webglTexture,a),d.bindFramebuffer(l.FRAMEBUFFER,null)}function ke(e,t,n){if(l.bindRenderbuffer(l.RENDERBUFFER,e),t.depthBuffer){let r=t.depthTexture,i=r&&r.isDepthTexture?r.type:null,a=N(t.stencilBuffer,i),o=t.stencilBuffer?l.DEPTH_STENCIL_ATTACHMENT:l.DEPTH_ATTACHMENT;Le(t)?g.renderbufferStorageMultisampleEXT(l.RENDERBUFFER,B(t),a,t.width,t.height):n?l.renderbufferStorageMultisample(l.RENDERBUFFER,B(t),a,t.width,t.height):l.renderbufferStorage(l.RENDERBUFFER,a,t.width,t.height),l.framebufferRenderbuffer(l.FRAMEBUFFER,o,l.RENDERBUFFER,e)}else{let e=t.textures;for(let r=0;r<e.length;r++){let i=e[r],a=m.convert(i.format,i.colorSpace),o=m.convert(i.type),s=M(i.internalFormat,a,o,i.normalized,i.colorSpace);Le(t)?g.renderbufferStorageMultisampleEXT(l.RENDERBUFFER,B(t),s,t.width,t.height):n?l.renderbufferStorageMultisample(l.RENDERBUFFER,B(t),s,t.width,t.height):l.renderbufferStorage(l.RENDERBUFFER,s,t.width,t.height)}}l.bindRenderbuffer(l.RENDERBUFFER,null)}function Ae(e,t,n){let r=t.isWebGLCubeRenderTarget===!0;if(d.bindFramebuffer(l.FRAMEBUFFER,e),!(t.depthTexture&&t.depthTexture.isDepthTexture))throw Error(`THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.`);let i=f.get(t.depthTexture);i.__renderTarget=t;let a=r?t.depthTexture.image[0]:t.depthTexture.image;i.__webglTexture&&a.width===t.width&&a.height===t.height||(a.width=t.width,a.height=t.height,t.depthTexture.needsUpdate=!0),r?ye(t.depthTexture,0):ge(t.depthTexture,0);let o=i.__webglTexture,s=B(t),c=r?l.TEXTURE_CUBE_MAP_POSITIVE_X+n:l.TEXTURE_2D,u=t.depthTexture.format===1027?l.DEPTH_STENCIL_ATTACHMENT:l.DEPTH_ATTACHMENT;if(t.depthTexture.format===1026)Le(t)?g.framebufferTexture2DMultisampleEXT(l.FRAMEBUFFER,u,c,o,0,s):l.framebufferTexture2D(l.FRAMEBUFFER,u,c,o,0);else if(t.depthTexture.format===1027)Le(t)?g.framebufferTexture2DMultisampleEXT(l.FRAMEBUFFER,u,c,o,0,s):l.framebufferTexture2D(l.FRAMEBUFFER,u,c,o,0);else throw Error(`THREE.WebGLTextures: Unknown depthTexture format.`)}function je(e){let t=f.get(e),n=e.isWebGLCubeRenderTarget===!0;if(t.__boundDepthTexture!==e.depthTexture){let n=e.depthTexture;if(t.__depthDisposeCallback&&t.__depthDisposeCallback(),n){let e=()=>{delete t.__boundDepthTexture,delete t.__depthDisposeCallback,n.removeEventListener(`dispose`,e)};n.addEventListener(`dispose`,e),t.__depthDisposeCallback=e}t.__boundDepthTexture=n}if(e.depthTexture&&!t.__autoAllocateDepthBuffer){if(n)for(let n=0;n<6;n++)Ae(t.__webglFramebuffer[n],e,n);else e.texture.mipmaps.length>0?Ae(t.__webglFramebuffer[0],e,0):Ae(t.__webglFramebuffer,e,0)}else if(n){t.__webglDepthbuffer=[];for(let n=0;n<6;n++)if(d.bindFramebuffer(l.FRAMEBUFFER,t.__webglFramebuffer[n]),t.__webglDepthbuffer[n]===void 0)t.__webglDepthbuffer[n]=l.createRenderbuffer(),ke(t.__webglDepthbuffer[n],e,!1);else{let r=e.stencilBuffer?l.DEPTH_STENCIL_ATTACHMENT:l.DEPTH_ATTACHMENT,i=t.__webglDepthbuffer[n];l.bindRenderbuffer(l.RENDERBUFFER,i),l.framebufferRenderbuffer(l.FRAMEBUFFER,r,l.RENDERBUFFER,i)}}else if(e.texture.mipmaps.length>0?d.bindFramebuffer(l.FRAMEBUFFER,t.__webglFramebuffer[0]):d.bindFramebuffer(l.FRAMEBUFFER,t.__webglFramebuffer),t.__webglDepthbuffer===void 0)t.__webglDepthbuffer=l.createRenderbuffer(),ke(t.__webglDepthbuffer,e,!1);else{let n=e.stencilBuffer?l.DEPTH_STENCIL_ATTACHMENT:l.DEPTH_ATTACHMENT,r=t.__webglDepthbuffer;l.bindRenderbuffer(l.RENDERBUFFER,r),l.framebufferRenderbuffer(l.FRAMEBUFFER,n,l.RENDERBUFFER,r)}d.bindFramebuffer(l.FRAMEBUFFER,null)}function Me(e,t,n){let r=f.get(e);t!==void 0&&Oe(r.__webglFramebuffer,e,e.texture,l.COLOR_ATTACHMENT0,l.TEXTURE_2D,0),n!==void 0&&je(e)}function Ne(e){let t=e.texture,n=f.get(e),r=f.get(t);e.addEventListener(`dispose`,I),te(e);let i=e.textures,a=e.isWebGLCubeRenderTarget===!0,o=i.length>1;if(o||(r.__webglTexture===void 0&&(r.__webglTexture=l.createTexture()),r.__version=t.version,h.memory.textures++),a){n.__webglFramebuffer=[];for(let e=0;e<6;e++)if(t.mipmaps.length>0){n.__webglFramebuffer[e]=[];for(let r=0;r<t.mipmaps.length;r++)n.__webglFramebuffer[e][r]=l.createFramebuffer()}else n.__webglFramebuffer[e]=l.createFramebuffer()}else{if(t.mipmaps.length>0){n.__webglFramebuffer=[];for(let e=0;e<t.mipmaps.length;e++)n.__webglFramebuffer[e]=l.createFramebuffer()}else n.__webglFramebuffer=l.createFramebuffer();if(o)for(let e=0,t=i.length;e<t;e++){let t=f.get(i[e]);t.__webglTexture===void 0&&(t.__webglTexture=l.createTexture(),h.memory.textures++)}if(e.samples>0&&Le(e)===!1){n.__webglMultisampledFramebuffer=l.createFramebuffer(),n.__webglColorRenderbuffer=[],d.bindFramebuffer(l.FRAMEBUFFER,n.__webglMultisampledFramebuffer);for(let t=0;t<i.length;t++){let r=i[t];n.__webglColorRenderbuffer[t]=l.createRenderbuffer(),l.bindRenderbuffer(l.RENDERBUFFER,n.__webglColorRenderbuffer[t]);let a=m.convert(r.format,r.colorSpace),o=m.convert(r.type),s=M(r.internalFormat,a,o,r.normalized,r.colorSpace,e.isXRRenderTarget===!0),c=B(e);l.renderbufferStorageMultisample(l.RENDERBUFFER,c,s,e.width,e.height),l.framebufferRenderbuffer(l.FRAMEBUFFER,l.COLOR_ATTACHMENT0+t,l.RENDERBUFFER,n.__webglColorRenderbuffer[t])}l.bindRenderbuffer(l.RENDERBUFFER,null),e.depthBuffer&&(n.__webglDepthRenderbuffer=l.createRenderbuffer(),ke(n.__webglDepthRenderbuffer,e,!0)),d.bindFramebuffer(l.FRAMEBUFFER,null)}}if(a){d.bindTexture(l.TEXTURE_CUBE_MAP,r.__webglTexture),Se(l.TEXTURE_CUBE_MAP,t);for(let r=0;r<6;r++)if(t.mipmaps.length>0)for(let i=0;i<t.mipmaps.length;i++)Oe(n.__webglFramebuffer[r][i],e,t,l.COLOR_ATTACHMENT0,l.TEXTURE_CUBE_MAP_POSITIVE_X+r,i);else Oe(n.__webglFramebuffer[r],e,t,l.COLOR_ATTACHMENT0,l.TEXTURE_CUBE_MAP_POSITIVE_X+r,0);k(t)?A(l.TEXTURE_CUBE_MAP):t.mipmaps.length>0&&l.texParameteri(l.TEXTURE_CUBE_MAP,l.TEXTURE_MAX_LEVEL,t.mipmaps.length-1),d.unbindTexture()}else if(o){for(let t=0,r=i.length;t<r;t++){let r=i[t],a=f.get(r),o=l.TEXTURE_2D;(e.isWebGL3DRenderTarget||e.isWebGLArrayRenderTarget)&&(o=e.isWebGL3DRenderTarget?l.TEXTURE_3D:l.TEXTURE_2D_ARRAY),d.bindTexture(o,a.__webglTexture),Se(o,r),Oe(n.__webglFramebuffer,e,r,l.COLOR_ATTACHMENT0+t,o,0),k(r)&&A(o)}d.unbindTexture()}else{let i=l.TEXTURE_2D;if((e.isWebGL3DRenderTarget||e.isWebGLArrayRenderTarget)&&(i=e.isWebGL3DRenderTarget?l.TEXTURE_3D:l.TEXTURE_2D_ARRAY),d.bindTexture(i,r.__webglTexture),Se(i,t),t.mipmaps.length>0)for(let r=0;r<t.mipmaps.length;r++)Oe(n.__webglFramebuffer[r],e,t,l.COLOR_ATTACHMENT0,i,r);else Oe(n.__webglFramebuffer,e,t,l.COLOR_ATTACHMENT0,i,0);k(t)?A(i):t.mipmaps.length>0&&l.texParameteri(i,l.TEXTURE_MAX_LEVEL,t.mipmaps.length-1),d.unbindTexture()}e.depthBuffer&&je(e)}function Pe(e){let t=e.textures;for(let n=0,r=t.length;n<r;n++){let r=t[n];if(k(r)&&r.mipmapsAutoUpdate===!0){let t=j(e),n=f.get(r).__webglTexture;d.bindTexture(t,n),A(t),d.unbindTexture()}}}let Fe=[];function Ie(e){if(e.samples>0){if(Le(e)===!1){let t=e.textures,n=e.width,r=e.height,i=l.COLOR_BUFFER_BIT,a=e.stencilBuffer?l.DEPTH_STENCIL_ATTACHMENT:l.DEPTH_ATTACHMENT,o=f.get(e),s=t.length>1;if(s)for(let e=0;e<t.length;e++)d.bindFramebuffer(l.FRAMEBUFFER,o.__webglMultisampledFramebuffer),l.framebufferRenderbuffer(l.FRAMEBUFFER,l.COLOR_ATTACHMENT0+e,l.RENDERBUFFER,null),d.bindFramebuffer(l.FRAMEBUFFER,o.__webglFramebuffer),l.framebufferTexture2D(l.DRAW_FRAMEBUFFER,l.COLOR_ATTACHMENT0+e,l.TEXTURE_2D,null,0);d.bindFramebuffer(l.READ_FRAMEBUFFER,o.__webglMultisampledFramebuffer),e.texture.mipmaps.length>0?d.bindFramebuffer(l.DRAW_FRAMEBUFFER,o.__webglFramebuffer[0]):d.bindFramebuffer(l.DRAW_FRAMEBUFFER,o.__webglFramebuffer);for(let c=0;c<t.length;c++){if(e.resolveDepthBuffer&&(e.depthBuffer&&(i|=l.DEPTH_BUFFER_BIT),e.stencilBuffer&&e.resolveStencilBuffer&&(i|=l.STENCIL_BUFFER_BIT)),s){l.framebufferRenderbuffer(l.READ_FRAMEBUFFER,l.COLOR_ATTACHMENT0,l.RENDERBUFFER,o.__webglColorRenderbuffer[c]);let e=f.get(t[c]).__webglTexture;l.framebufferTexture2D(l.DRAW_FRAMEBUFFER,l.COLOR_ATTACHMENT0,l.TEXTURE_2D,e,0)}l.blitFramebuffer(0,0,n,r,0,0,n,r,i,l.NEAREST),_===!0&&(Fe.length=0,Fe.push(l.COLOR_ATTACHMENT0+c),e.depthBuffer&&e.storeMultisampledDepthBuffer===!1&&Fe.push(a),l.invalidateFramebuffer(l.READ_FRAMEBUFFER,Fe))}if(d.bindFramebuffer(l.READ_FRAMEBUFFER,null),d.bindFramebuffer(l.DRAW_FRAMEBUFFER,null),s)for(let e=0;e<t.length;e++){d.bindFramebuffer(l.FRAMEBUFFER,o.__webglMultisampledFramebuffer),l.framebufferRenderbuffer(l.FRAMEBUFFER,l.COLOR_ATTACHMENT0+e,l.RENDERBUFFER,o.__webglColorRenderbuffer[e]);let n=f.get(t[e]).__webglTexture;d.bindFramebuffer(l.FRAMEBUFFER,o.__webglFramebuffer),l.framebufferTexture2D(l.DRAW_FRAMEBUFFER,l.COLOR_ATTACHMENT0+e,l.TEXTURE_2D,n,0)}d.bindFramebuffer(l.DRAW_FRAMEBUFFER,o.__webglMultisampledFramebuffer)}else if(e.depthBuffer&&e.storeMultisampledDepthBuffer===!1&&_){let t=e.stencilBuffer?l.DEPTH_STENCIL_ATTACHMENT:l.DEPTH_ATTACHMENT;l.invalidateFramebuffer(l.DRAW_FRAMEBUFFER,[t])}}}function B(e){return Math.min(p.maxSamples,e.samples)}function Le(e){let t=f.get(e);return e.samples>0&&u.has(`WEBGL_multisampled_render_to_texture`)===!0&&t.__useRenderToTexture!==!1}function Re(e){let t=h.render.frame;b.get(e)!==t&&(b.set(e,t),e.update())}function ze(e,t){let n=e.colorSpace,r=e.format,i=e.type;return e.isCompressedTexture===!0||e.isVideoTexture===!0||n!==`srgb-linear`&&n!==``&&(Ke.getTransfer(n)===`srgb`?(r!==1023||i!==1009)&&L(`WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType.`):R(`WebGLTextures: Unsupported texture color space:`,n)),t}function V(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement?(v.width=e.naturalWidth||e.width,v.height=e.naturalHeight||e.height):typeof VideoFrame<`u`&&e instanceof VideoFrame?(v.width=e.displayWidth,v.height=e.displayHeight):(v.width=e.width,v.height=e.height),v}this.allocateTextureUnit=me,this.resetTextureUnits=de,this.getTextureUnits=fe,this.setTextureUnits=pe,this.setTexture2D=ge,this.setTexture2DArray=_e,this.setTexture3D=ve,this.setTextureCube=ye,this.rebindTextures=Me,this.setupRenderTarget=Ne,this.updateRenderTargetMipmap=Pe,this.updateMultisampleRenderTarget=Ie,this.setupDepthRenderbuffer=je,this.setupFrameBufferTexture=Oe,this.useMultisampledRTT=Le,this.dispose=ae}function ul(e,t){function n(n,r=``){let i,a=Ke.getTransfer(r);if(n===1009)return e.UNSIGNED_BYTE;if(n===1017)return e.UNSIGNED_SHORT_4_4_4_4;if(n===1018)return e.UNSIGNED_SHORT_5_5_5_1;if(n===35902)return e.UNSIGNED_INT_5_9_9_9_REV;if(n===35899)return e.UNSIGNED_INT_10F_11F_11F_REV;if(n===1010)return e.BYTE;if(n===1011)return e.SHORT;if(n===1012)return e.UNSIGNED_SHORT;if(n===1013)return e.INT;if(n===1014)return e.UNSIGNED_INT;if(n===1015)return e.FLOAT;if(n===1016)return e.HALF_FLOAT;if(n===1021)return e.ALPHA;if(n===1022)return e.RGB;if(n===1023)return e.RGBA;if(n===1026)return e.DEPTH_COMPONENT;if(n===1027)return e.DEPTH_STENCIL;if(n===1028)return e.RED;if(n===1029)return e.RED_INTEGER;if(n===1030)return e.RG;if(n===1031)return e.RG_INTEGER;if(n===1033)return e.RGBA_INTEGER;if(n===33776||n===33777||n===33778||n===33779){if(a===`srgb`){if(i=t.get(`WEBGL_compressed_texture_s3tc_srgb`),i!==null){if(n===33776)return i.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null}else if(i=t.get(`WEBGL_compressed_texture_s3tc`),i!==null){if(n===33776)return i.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null}if(n===35840||n===35841||n===35842||n===35843){if(i=t.get(`WEBGL_compressed_texture_pvrtc`),i!==null){if(n===35840)return i.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===35841)return i.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===35842)return i.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===35843)return i.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null}if(n===36196||n===37492||n===37496||n===37488||n===37489||n===37490||n===37491){if(i=t.get(`WEBGL_compressed_texture_etc`),i!==null){if(n===36196||n===37492)return a===`srgb`?i.COMPRESSED_SRGB8_ETC2:i.COMPRESSED_RGB8_ETC2;if(n===37496)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:i.COMPRESSED_RGBA8_ETC2_EAC;if(n===37488)return i.COMPRESSED_R11_EAC;if(n===37489)return i.COMPRESSED_SIGNED_R11_EAC;if(n===37490)return i.COMPRESSED_RG11_EAC;if(n===37491)return i.COMPRESSED_SIGNED_RG11_EAC}else return null}if(n===37808||n===37809||n===37810||n===37811||n===37812||n===37813||n===37814||n===37815||n===37816||n===37817||n===37818||n===37819||n===37820||n===37821){if(i=t.get(`WEBGL_compressed_texture_astc`),i!==null){if(n===37808)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:i.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===37809)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:i.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===37810)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:i.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===37811)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:i.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===37812)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:i.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===37813)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:i.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===37814)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:i.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===37815)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:i.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===37816)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:i.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===37817)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:i.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===37818)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:i.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===37819)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:i.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===37820)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:i.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===37821)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:i.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null}if(n===36492||n===36494||n===36495){if(i=t.get(`EXT_texture_compression_bptc`),i!==null){if(n===36492)return a===`srgb`?i.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:i.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===36494)return i.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===36495)return i.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null}if(n===36283||n===36284||n===36285||n===36286){if(i=t.get(`EXT_texture_compression_rgtc`),i!==null){if(n===36283)return i.COMPRESSED_RED_RGTC1_EXT;if(n===36284)return i.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===36285)return i.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===36286)return i.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null}return n===1020?e.UNSIGNED_INT_24_8:e[n]===void 0?null:e[n]}return{convert:n}}var dl=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,fl=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,pl=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new bi(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new ji({vertexShader:dl,fragmentShader:fl,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new _r(new Si(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},ml=class extends me{constructor(e,t){super();let n=this,r=null,i=1,a=null,o=`local-floor`,s=1,c=null,u=null,f=null,p=null,m=null,h=null,b=typeof XRWebGLBinding<`u`,x=new pl,S={},C=t.getContextAttributes(),w=null,T=null,E=[],D=[],O=new H,k=null,A=null,j=new Ma;j.viewport=new rt;let M=new Ma;M.viewport=new rt;let N=[j,M],P=new qa,ee=null,te=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(e){let t=E[e];return t===void 0&&(t=new Lt,E[e]=t),t.getTargetRaySpace()},this.getControllerGrip=function(e){let t=E[e];return t===void 0&&(t=new Lt,E[e]=t),t.getGripSpace()},this.getHand=function(e){let t=E[e];return t===void 0&&(t=new Lt,E[e]=t),t.getHandSpace()};function F(e){let t=D.indexOf(e.inputSource);if(t===-1)return;let n=E[t];n!==void 0&&(n.update(e.inputSource,e.frame,c||a),n.dispatchEvent({type:e.type,data:e.inputSource}))}function ne(){r.removeEventListener(`select`,F),r.removeEventListener(`selectstart`,F),r.removeEventListener(`selectend`,F),r.removeEventListener(`squeeze`,F),r.removeEventListener(`squeezestart`,F),r.removeEventListener(`squeezeend`,F),r.removeEventListener(`end`,ne),r.removeEventListener(`inputsourceschange`,I);for(let e=0;e<E.length;e++){let t=D[e];t!==null&&(D[e]=null,E[e].disconnect(t))}ee=null,te=null,x.reset();for(let e in S)delete S[e];if(e.setRenderTarget(w),m=null,p=null,f=null,r=null,T=null,se.stop(),n.isPresenting=!1,e.setPixelRatio(k),e.setSize(O.width,O.height,!1),A!==null){let e=A.camera;e.fov=A.fov,e.zoom=A.zoom,e.updateProjectionMatrix(),A=null}n.dispatchEvent({type:`sessionend`})}this.setFramebufferScaleFactor=function(e){i=e,n.isPresenting===!0&&L(`WebXRManager: Cannot change framebuffer scale while presenting.`)},this.setReferenceSpaceType=function(e){o=e,n.isPresenting===!0&&L(`WebXRManager: Cannot change reference space type while presenting.`)},this.getReferenceSpace=function(){return c||a},this.setReferenceSpace=function(e){c=e},this.getBaseLayer=function(){return p===null?m:p},this.getBinding=function(){return f===null&&b&&(f=new XRWebGLBinding(r,t)),f},this.getFrame=function(){return h},this.getSession=function(){return r},this.setSession=async function(u){if(r=u,r!==null){if(w=e.getRenderTarget(),r.addEventListener(`select`,F),r.addEventListener(`selectstart`,F),r.addEventListener(`selectend`,F),r.addEventListener(`squeeze`,F),r.addEventListener(`squeezestart`,F),r.addEventListener(`squeezeend`,F),r.addEventListener(`end`,ne),r.addEventListener(`inputsourceschange`,I),C.xrCompatible!==!0&&await t.makeXRCompatible(),k=e.getPixelRatio(),e.getSize(O),b&&`createProjectionLayer`in XRWebGLBinding.prototype){let n=null,a=null,o=null;C.depth&&(o=C.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,n=C.stencil?y:v,a=C.stencil?g:d);let s={colorFormat:t.RGBA8,depthFormat:o,scaleFactor:i};f=this.getBinding(),p=f.createProjectionLayer(s),r.updateRenderState({layers:[p]}),e.setPixelRatio(1),e.setSize(p.textureWidth,p.textureHeight,!1),T=new at(p.textureWidth,p.textureHeight,{format:_,type:l,depthTexture:new vi(p.textureWidth,p.textureHeight,a,void 0,void 0,void 0,void 0,void 0,void 0,n),stencilBuffer:C.stencil,colorSpace:e.outputColorSpace,samples:C.antialias?4:0,resolveDepthBuffer:p.ignoreDepthValues===!1,resolveStencilBuffer:p.ignoreDepthValues===!1,storeMultisampledDepthBuffer:p.ignoreDepthValues===!1,storeMultisampledStencilBuffer:p.ignoreDepthValues===!1})}else{let n={antialias:C.antialias,alpha:!0,depth:C.depth,stencil:C.stencil,framebufferScaleFactor:i};m=new XRWebGLLayer(r,t,n),r.updateRenderState({baseLayer:m}),e.setPixelRatio(1),e.setSize(m.framebufferWidth,m.framebufferHeight,!1),T=new at(m.framebufferWidth,m.framebufferHeight,{format:_,type:l,colorSpace:e.outputColorSpace,stencilBuffer:C.stencil,resolveDepthBuffer:m.ignoreDepthValues===!1,resolveStencilBuffer:m.ignoreDepthValues===!1,storeMultisampledDepthBuffer:m.ignoreDepthValues===!1,storeMultisampledStencilBuffer:m.ignoreDepthValues===!1})}T.isXRRenderTarget=!0,this.setFoveation(s),c=null,a=await r.requestReferenceSpace(o),se.setContext(r),se.start(),n.isPresenting=!0,n.dispatchEvent({type:`sessionstart`})}},this.getEnvironmentBlendMode=function(){if(r!==null)return r.environmentBlendMode},this.getDepthTexture=function(){return x.getDepthTexture()};function I(e){for(let t=0;t<e.removed.length;t++){let n=e.removed[t],r=D.indexOf(n);r>=0&&(D[r]=null,E[r].disconnect(n))}for(let t=0;t<e.added.length;t++){let n=e.added[t],r=D.indexOf(n);if(r===-1){for(let e=0;e<E.length;e++)if(e>=D.length){D.push(n),r=e;break}else if(D[e]===null){D[e]=n,r=e;break}if(r===-1)break}let i=E[r];i&&i.connect(n)}}function re(e,t){t===null?e.matrixWorld.copy(e.matrix):e.matrixWorld.multiplyMatrices(t.matrixWorld,e.matrix),e.matrixWorldInverse.copy(e.matrixWorld).invert()}this.updateCamera=function(e){if(r===null)return;let t=e.near,n=e.far;x.texture!==null&&(x.depthNear>0&&(t=x.depthNear),x.depthFar>0&&(n=x.depthFar)),P.near=M.near=j.near=t,P.far=M.far=j.far=n,(ee!==P.near||te!==P.far)&&(r.updateRenderState({depthNear:P.near,depthFar:P.far}),ee=P.near,te=P.far),P.layers.mask=e.layers.mask|6,j.layers.mask=P.layers.mask&-5,M.layers.mask=P.layers.mask&-3;let i=e.parent,a=P.cameras;re(P,i);for(let e=0;e<a.length;e++)re(a[e],i);P.projectionMatrix.copy(j.projectionMatrix),P.projectionMatrixInverse.copy(j.projectionMatrixInverse),A===null&&e.isPerspectiveCamera&&(A={camera:e,fov:e.fov,zoom:e.zoom}),ie(e,P,i)};function ie(e,t,n){n===null?e.matrix.copy(t.matrixWorld):(e.matrix.copy(n.matrixWorld),e.matrix.invert(),e.matrix.multiply(t.matrixWorld)),e.matrix.decompose(e.position,e.quaternion,e.scale),e.updateMatrixWorld(!0),e.projectionMatrix.copy(t.projectionMatrix),e.projectionMatrixInverse.copy(t.projectionMatrixInverse),e.isPerspectiveCamera&&(e.fov=ve*2*Math.atan(1/e.projectionMatrix.elements[5]),e.zoom=1)}this.getCamera=function(){return P},this.getFoveation=function(){if(p!==null||m!==null)return s},this.setFoveation=function(e){s=e,p!==null&&(p.fixedFoveation=e),m!==null&&m.fixedFoveation!==void 0&&(m.fixedFoveation=e)},this.hasDepthSensing=function(){return x.texture!==null},this.getDepthSensingMesh=function(){return x.getMesh(P)},this.getCameraTexture=function(e){return S[e]};let ae=null;function oe(t,i){if(u=i.getViewerPose(c||a),h=i,u!==null){let t=u.views;m!==null&&(e.setRenderTargetFramebuffer(T,m.framebuffer),e.setRenderTarget(T));let i=!1;t.length!==P.cameras.length&&(P.cameras.length=0,i=!0);for(let n=0;n<t.length;n++){let r=t[n],a=null;if(m!==null)a=m.getViewport(r);else{let t=f.getViewSubImage(p,r);a=t.viewport,n===0&&(e.setRenderTargetTextures(T,t.colorTexture,t.depthStencilTexture),e.setRenderTarget(T))}let o=N[n];o===void 0&&(o=new Ma,o.layers.enable(n),o.viewport=new rt,N[n]=o),o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.projectionMatrix.fromArray(r.projectionMatrix),o.projectionMatrixInverse.copy(o.projectionMatrix).invert(),o.viewport.set(a.x,a.y,a.width,a.height),n===0&&(P.matrix.copy(o.matrix),P.matrix.decompose(P.position,P.quaternion,P.scale)),i===!0&&P.cameras.push(o)}let a=r.enabledFeatures;if(a&&a.includes(`depth-sensing`)&&r.depthUsage==`gpu-optimized`&&b){f=n.getBinding();let e=f.getDepthInformation(t[0]);e&&e.isValid&&e.texture&&x.init(e,r.renderState)}if(a&&a.includes(`camera-access`)&&b){e.state.unbindTexture(),f=n.getBinding();for(let e=0;e<t.length;e++){let n=t[e].camera;if(n){let e=S[n];e||(e=new bi,S[n]=e);let t=f.getCameraImage(n);e.sourceTexture=t}}}}for(let e=0;e<E.length;e++){let t=D[e],n=E[e];t!==null&&n!==void 0&&n.update(t,i,c||a)}ae&&ae(t,i),i.detectedPlanes&&n.dispatchEvent({type:`planesdetected`,data:i}),h=null}let se=new po;se.setAnimationLoop(oe),this.setAnimationLoop=function(e){ae=e},this.dispose=function(){}}},hl=new K,gl=new G;gl.set(-1,0,0,0,1,0,0,0,1);function _l(e,t){function n(e,t){e.matrixAutoUpdate===!0&&e.updateMatrix(),t.value.copy(e.matrix)}function r(t,n){n.color.getRGB(t.fogColor.value,Di(e)),n.isFog?(t.fogNear.value=n.near,t.fogFar.value=n.far):n.isFogExp2&&(t.fogDensity.value=n.density)}function i(e,t,n,r,i){t.isNodeMaterial?t.uniformsNeedUpdate=!1:t.isMeshBasicMaterial?a(e,t):t.isMeshLambertMaterial?(a(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshToonMaterial?(a(e,t),d(e,t)):t.isMeshPhongMaterial?(a(e,t),u(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshStandardMaterial?(a(e,t),f(e,t),t.isMeshPhysicalMaterial&&p(e,t,i)):t.isMeshMatcapMaterial?(a(e,t),m(e,t)):t.isMeshDepthMaterial?a(e,t):t.isMeshDistanceMaterial?(a(e,t),h(e,t)):t.isMeshNormalMaterial?a(e,t):t.isLineBasicMaterial?(o(e,t),t.isLineDashedMaterial&&s(e,t)):t.isPointsMaterial?c(e,t,n,r):t.isSpriteMaterial?l(e,t):t.isShadowMaterial?(e.color.value.copy(t.color),e.opacity.value=t.opacity):t.isShaderMaterial&&(t.uniformsNeedUpdate=!1)}function a(e,r){e.opacity.value=r.opacity,r.color&&e.diffuse.value.copy(r.color),r.emissive&&e.emissive.value.copy(r.emissive).multiplyScalar(r.emissiveIntensity),r.map&&(e.map.value=r.map,n(r.map,e.mapTransform)),r.alphaMap&&(e.alphaMap.value=r.alphaMap,n(r.alphaMap,e.alphaMapTransform)),r.bumpMap&&(e.bumpMap.value=r.bumpMap,n(r.bumpMap,e.bumpMapTransform),e.bumpScale.value=r.bumpScale,r.side===1&&(e.bumpScale.value*=-1)),r.normalMap&&(e.normalMap.value=r.normalMap,n(r.normalMap,e.normalMapTransform),e.normalScale.value.copy(r.normalScale),r.side===1&&e.normalScale.value.negate()),r.displacementMap&&(e.displacementMap.value=r.displacementMap,n(r.displacementMap,e.displacementMapTransform),e.displacementScale.value=r.displacementScale,e.displacementBias.value=r.displacementBias),r.emissiveMap&&(e.emissiveMap.value=r.emissiveMap,n(r.emissiveMap,e.emissiveMapTransform)),r.specularMap&&(e.specularMap.value=r.specularMap,n(r.specularMap,e.specularMapTransform)),r.alphaTest>0&&(e.alphaTest.value=r.alphaTest);let i=t.get(r),a=i.envMap,o=i.envMapRotation;a&&(e.envMap.value=a,e.envMapRotation.value.setFromMatrix4(hl.makeRotationFromEuler(o)).transpose(),a.isCubeTexture&&a.isRenderTargetTexture===!1&&e.envMapRotation.value.premultiply(gl),e.reflectivity.value=r.reflectivity,e.ior.value=r.ior,e.refractionRatio.value=r.refractionRatio),r.lightMap&&(e.lightMap.value=r.lightMap,e.lightMapIntensity.value=r.lightMapIntensity,n(r.lightMap,e.lightMapTransform)),r.aoMap&&(e.aoMap.value=r.aoMap,e.aoMapIntensity.value=r.aoMapIntensity,n(r.aoMap,e.aoMapTransform))}function o(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform))}function s(e,t){e.dashSize.value=t.dashSize,e.totalSize.value=t.dashSize+t.gapSize,e.scale.value=t.scale}function c(e,t,r,i){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.size.value=t.size*r,e.scale.value=i*.5,t.map&&(e.map.value=t.map,n(t.map,e.uvTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function l(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.rotation.value=t.rotation,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function u(e,t){e.specular.value.copy(t.specular),e.shininess.value=Math.max(t.shininess,1e-4)}function d(e,t){t.gradientMap&&(e.gradientMap.value=t.gradientMap)}function f(e,t){e.metalness.value=t.metalness,t.metalnessMap&&(e.metalnessMap.value=t.metalnessMap,n(t.metalnessMap,e.metalnessMapTransform)),e.roughness.value=t.roughness,t.roughnessMap&&(e.roughnessMap.value=t.roughnessMap,n(t.roughnessMap,e.roughnessMapTransform)),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)}function p(e,t,r){e.ior.value=t.ior,t.diffuseRoughness>0&&(e.diffuseRoughness.value=t.diffuseRoughness,t.diffuseRoughnessMap&&(e.diffuseRoughnessMap.value=t.diffuseRoughnessMap,n(t.diffuseRoughnessMap,e.diffuseRoughnessMapTransform))),t.sheen>0&&(e.sheenColor.value.copy(t.sheenColor).multiplyScalar(t.sheen),e.sheenRoughness.value=t.sheenRoughness,t.sheenColorMap&&(e.sheenColorMap.value=t.sheenColorMap,n(t.sheenColorMap,e.sheenColorMapTransform)),t.sheenRoughnessMap&&(e.sheenRoughnessMap.value=t.sheenRoughnessMap,n(t.sheenRoughnessMap,e.sheenRoughnessMapTransform))),t.clearcoat>0&&(e.clearcoat.value=t.clearcoat,e.clearcoatRoughness.value=t.clearcoatRoughness,t.clearcoatMap&&(e.clearcoatMap.value=t.clearcoatMap,n(t.clearcoatMap,e.clearcoatMapTransform)),t.clearcoatRoughnessMap&&(e.clearcoatRoughnessMap.value=t.clearcoatRoughnessMap,n(t.clearcoatRoughnessMap,e.clearcoatRoughnessMapTransform)),t.clearcoatNormalMap&&(e.clearcoatNormalMap.value=t.clearcoatNormalMap,n(t.clearcoatNormalMap,e.clearcoatNormalMapTransform),e.clearcoatNormalScale.value.copy(t.clearcoatNormalScale),t.side===1&&e.clearcoatNormalScale.value.negate())),t.dispersion>0&&(e.dispersion.value=t.dispersion),t.retroreflectivity>0&&(e.retroreflectivity.value=t.retroreflectivity),t.iridescence>0&&(e.iridescence.value=t.iridescence,e.iridescenceIOR.value=t.iridescenceIOR,e.iridescenceThicknessMinimum.value=t.iridescenceThicknessMinimum,e.iridescenceThicknessMaximum.value=t.iridescenceThicknessMaximum,t.iridescenceMap&&(e.iridescenceMap.value=t.iridescenceMap,n(t.iridescenceMap,e.iridescenceMapTransform)),t.iridescenceThicknessMap&&(e.iridescenceThicknessMap.value=t.iridescenceThicknessMap,n(t.iridescenceThicknessMap,e.iridescenceThicknessMapTransform))),t.transmission>0&&(e.transmission.value=t.transmission,e.transmissionSamplerMap.value=r.texture,e.transmissionSamplerSize.value.set(r.width,r.height),t.transmissionMap&&(e.transmissionMap.value=t.transmissionMap,n(t.transmissionMap,e.transmissionMapTransform)),e.thickness.value=t.thickness,t.thicknessMap&&(e.thicknessMap.value=t.thicknessMap,n(t.thicknessMap,e.thicknessMapTransform)),e.attenuationDistance.value=t.attenuationDistance,e.attenuationColor.value.copy(t.attenuationColor)),t.anisotropy>0&&(e.anisotropyVector.value.set(t.anisotropy*Math.cos(t.anisotropyRotation),t.anisotropy*Math.sin(t.anisotropyRotation)),t.anisotropyMap&&(e.anisotropyMap.value=t.anisotropyMap,n(t.anisotropyMap,e.anisotropyMapTransform))),e.specularIntensity.value=t.specularIntensity,e.specularColor.value.copy(t.specularColor),t.specularColorMap&&(e.specularColorMap.value=t.specularColorMap,n(t.specularColorMap,e.specularColorMapTransform)),t.specularIntensityMap&&(e.specularIntensityMap.value=t.specularIntensityMap,n(t.specularIntensityMap,e.specularIntensityMapTransform))}function m(e,t){t.matcap&&(e.matcap.value=t.matcap)}function h(e,n){let r=t.get(n).light;e.referencePosition.value.setFromMatrixPosition(r.matrixWorld),e.nearDistance.value=r.shadow.camera.near,e.farDistance.value=r.shadow.camera.far}return{refreshFogUniforms:r,refreshMaterialUniforms:i}}function vl(e,t,n,r){let i={},a={};function o(e,t){let n=t.program;r.uniformBlockBinding(e,n,i[e.id])}function s(e,n){let o=i[e.id];o===void 0&&(m(e),o=c(e),i[e.id]=o,e.addEventListener(`dispose`,g));let s=n.program;r.updateUBOMapping(e,s);let u=t.render.frame;a[e.id]!==u&&(l(e),a[e.id]=u)}function c(t){let n=e.createBuffer(),r=t.__size,i=t.usage;return e.bindBuffer(e.UNIFORM_BUFFER,n),e.bufferData(e.UNIFORM_BUFFER,r,i),e.bindBuffer(e.UNIFORM_BUFFER,null),n}function l(t){let n=i[t.id],r=t.uniforms,a=t.__cache;e.bindBuffer(e.UNIFORM_BUFFER,n);for(let e=0,t=r.length;e<t;e++){let t=r[e];if(Array.isArray(t))for(let n=0,r=t.length;n<r;n++)u(t[n],e,n,a);else u(t,e,0,a)}e.bindBuffer(e.UNIFORM_BUFFER,null)}function u(t,n,r,i){if(f(t,n,r,i)===!0){let n=t.__offset,r=t.value;if(Array.isArray(r)){let e=0;for(let n=0;n<r.length;n++){let i=r[n],a=h(i,!0);d(i,t.__data,e),e+=a.storage/Float32Array.BYTES_PER_ELEMENT}}else d(r,t.__data,0);e.bufferSubData(e.UNIFORM_BUFFER,n,t.__data)}}function d(e,t,n){typeof e==`number`||typeof e==`boolean`?t[n]=e:e.isMatrix3?(t[n]=e.elements[0],t[n+1]=e.elements[1],t[n+2]=e.elements[2],t[n+3]=0,t[n+4]=e.elements[3],t[n+5]=e.elements[4],t[n+6]=e.elements[5],t[n+7]=0,t[n+8]=e.elements[6],t[n+9]=e.elements[7],t[n+10]=e.elements[8],t[n+11]=0):ArrayBuffer.isView(e)?t.set(e.subarray(0,t.length-n),n):e.toArray(t,n)}function f(e,t,n,r){let i=e.value,a=t+`_`+n;if(Array.isArray(i)){r[a]===void 0&&(r[a]=[]);let e=r[a],t=!1;for(let n=0;n<i.length;n++)p(i[n],e,n)===!0&&(t=!0);return t}return p(i,r,a)}function p(e,t,n){if(t[n]===void 0)return t[n]=typeof e==`number`||typeof e==`boolean`?e:ArrayBuffer.isView(e)?e.slice():e.clone(),!0;{let r=t[n];if(typeof e==`number`||typeof e==`boolean`){if(r!==e)return t[n]=e,!0}else if(ArrayBuffer.isView(e))return!0;else if(r.equals(e)===!1)return r.copy(e),!0}return!1}function m(e){let t=e.uniforms,n=0;for(let e=0,r=t.length;e<r;e++){let r=Array.isArray(t[e])?t[e]:[t[e]];for(let i=0,a=r.length;i<a;i++){let a=r[i],o=Array.isArray(a.value)?a.value:[a.value],s=Array.isArray(t[e])||Array.isArray(a.value),c=n;for(let e=0,t=o.length;e<t;e++){let t=o[e],r=h(t,s),i=n%16,a=i%r.boundary,l=i+a;n+=a,l!==0&&16-l<r.storage&&(n+=16-l),e===0&&(c=n),n+=r.storage}a.__data=new(a.type===`int`?Int32Array:a.type===`uint`?Uint32Array:Float32Array)((n-c)/Float32Array.BYTES_PER_ELEMENT),a.__offset=c}}let r=n%16;return r>0&&(n+=16-r),e.__size=n,e.__cache={},this}function h(e,t){let n={boundary:0,storage:0};return typeof e==`number`||typeof e==`boolean`?(n.boundary=4,n.storage=4):e.isVector2?(n.boundary=8,n.storage=8):e.isVector3||e.isColor?(n.boundary=16,n.storage=12):e.isVector4?(n.boundary=16,n.storage=16):e.isMatrix3?(n.boundary=16,n.storage=48):e.isMatrix4?(n.boundary=16,n.storage=64):e.isTexture?L(`WebGLRenderer: Texture samplers can not be part of an uniforms group.`):ArrayBuffer.isView(e)?(n.boundary=16,n.storage=e.byteLength):L(`WebGLRenderer: Unsupported uniform value type.`,e),t===!0&&(n.boundary=16,n.storage=Math.ceil(n.storage/16)*16),n}function g(t){let n=t.target;n.removeEventListener(`dispose`,g),e.deleteBuffer(i[n.id]),delete i[n.id],delete a[n.id]}function _(){for(let t in i)e.deleteBuffer(i[t]);i={},a={}}return{bind:o,update:s,dispose:_}}var yl=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),bl=null;function xl(){return bl===null&&(bl=new jr(yl,16,16,S,p),bl.name=`DFG_LUT`,bl.minFilter=o,bl.magFilter=o,bl.wrapS=t,bl.wrapT=t,bl.generateMipmaps=!1,bl.needsUpdate=!0),bl}var Sl=class{constructor(e={}){let{canvas:t=se(),context:n=null,depth:r=!0,stencil:i=!1,alpha:a=!1,antialias:o=!1,premultipliedAlpha:s=!0,preserveDrawingBuffer:f=!1,powerPreference:_=`default`,failIfMajorPerformanceCaveat:v=!1,reversedDepthBuffer:y=!1,outputBufferType:b=l}=e;this.isWebGLRenderer=!0;let S;if(n!==null){if(typeof WebGLRenderingContext<`u`&&n instanceof WebGLRenderingContext)throw Error(`THREE.WebGLRenderer: WebGL 1 is not supported since r163.`);S=n.getContextAttributes().alpha}else S=a;let T=b,E=new Set([w,C,x]),D=new Set([l,d,u,g,m,h]),O=new Uint32Array(4),k=new Int32Array(4),A={textures:[],min:[],max:[],resolution:[]},j=null,N=null,P=[],ee=[],te=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=0,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let F=this,ne=!1,I=null,ie=null,ae=null,oe=null;this._outputColorSpace=M;let ce=0,ue=0,de=null,pe=-1,me=null,he=new rt,ge=new rt,_e=null,ve=new q(0),ye=0,z=t.width,be=t.height,xe=1,Se=null,Ce=null,we=new rt(0,0,z,be),Te=new rt(0,0,z,be),Ee=!1,De=new qr,Oe=new Yr,ke=!1,Ae=!1,je=new K,Me=new W,Ne=new rt,Pe={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},Fe=!1;function Ie(){return de===null?xe:1}let B=n;function Le(e,n){return t.getContext(e,n)}let Re,ze,V,H,U,Be,Ve,G,He,Ue,We,Ge,qe,Je,Ye,Xe,Ze,Qe,$e,et,tt,nt,it;try{let e={alpha:!0,depth:r,stencil:i,antialias:o,premultipliedAlpha:s,preserveDrawingBuffer:f,powerPreference:_,failIfMajorPerformanceCaveat:v};if(`setAttribute`in t&&t.setAttribute(`data-engine`,`three.js r187`),t.addEventListener(`webglcontextlost`,ct,!1),t.addEventListener(`webglcontextrestored`,lt,!1),t.addEventListener(`webglcontextcreationerror`,ut,!1),B===null){let t=`webgl2`;if(B=Le(t,e),B===null)throw Le(t)?Error(`THREE.WebGLRenderer: Error creating WebGL context with your selected attributes.`):Error(`THREE.WebGLRenderer: Error creating WebGL context.`)}ot()}catch(e){throw t.removeEventListener(`webglcontextlost`,ct,!1),t.removeEventListener(`webglcontextrestored`,lt,!1),t.removeEventListener(`webglcontextcreationerror`,ut,!1),R(`WebGLRenderer: `+e.message),e}function ot(){Re=new Ho(B),Re.init(),tt=new ul(B,Re),ze=new So(B,Re,e,tt),V=new cl(B,Re),ze.reversedDepthBuffer&&y&&V.buffers.depth.setReversed(!0),ie=B.createFramebuffer(),ae=B.createFramebuffer(),oe=B.createFramebuffer(),H=new Go(B),U=new Hc,Be=new ll(B,Re,V,U,ze,tt,H),Ve=new Vo(F),G=new mo(B),nt=new bo(B,G),He=new Uo(B,G,H,nt),Ue=new qo(B,He,G,nt,H),Qe=new Ko(B,ze,Be),Ye=new Co(U),We=new Vc(F,Ve,Re,ze,nt,Ye),Ge=new _l(F,U),qe=new Kc,Je=new $c(Re),Ze=new yo(F,Ve,V,Ue,S,s),Xe=new sl(F,Ue,ze),it=new vl(B,H,ze,V),$e=new xo(B,Re,H),et=new Wo(B,Re,H),H.programs=We.programs,F.capabilities=ze,F.extensions=Re,F.properties=U,F.renderLists=qe,F.shadowMap=Xe,F.state=V,F.info=H}T!==1009&&(te=new Yo(T,t.width,t.height,o,r,i));let st=new ml(F,B);this.xr=st,this.getContext=function(){return B},this.getContextAttributes=function(){return B.getContextAttributes()},this.forceContextLoss=function(){let e=Re.get(`WEBGL_lose_context`);e&&e.loseContext()},this.forceContextRestore=function(){let e=Re.get(`WEBGL_lose_context`);e&&e.restoreContext()},this.getPixelRatio=function(){return xe},this.setPixelRatio=function(e){e!==void 0&&(xe=e,this.setSize(z,be,!1))},this.getSize=function(e){return e.set(z,be)},this.setSize=function(e,n,r=!0){st.isPresenting?L(`WebGLRenderer: Can't change size while VR device is presenting.`):(z=e,be=n,t.width=Math.floor(e*xe),t.height=Math.floor(n*xe),r===!0&&(t.style.width=e+`px`,t.style.height=n+`px`),te!==null&&te.setSize(t.width,t.height),this.setViewport(0,0,e,n))},this.getDrawingBufferSize=function(e){return e.set(z*xe,be*xe).floor()},this.setDrawingBufferSize=function(e,n,r){z=e,be=n,xe=r,t.width=Math.floor(e*r),t.height=Math.floor(n*r),this.setViewport(0,0,e,n)},this.setEffects=function(e){if(T===1009)R(`WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.`);else{if(e){for(let t=0;t<e.length;t++)if(e[t].isOutputPass===!0){L(`WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.`);break}}te.setEffects(e||[])}},this.getCurrentViewport=function(e){return e.copy(he)},this.getViewport=function(e){return e.copy(we)},this.setViewport=function(e,t,n,r){e.isVector4?we.set(e.x,e.y,e.z,e.w):we.set(e,t,n,r),V.viewport(he.copy(we).multiplyScalar(Ie()).round())},this.getScissor=function(e){return e.copy(Te)},this.setScissor=function(e,t,n,r){e.isVector4?Te.set(e.x,e.y,e.z,e.w):Te.set(e,t,n,r),V.scissor(ge.copy(Te).multiplyScalar(Ie()).round())},this.getScissorTest=function(){return Ee},this.setScissorTest=function(e){V.setScissorTest(Ee=e)},this.setOpaqueSort=function(e){Se=e},this.setTransparentSort=function(e){Ce=e},this.getClearColor=function(e){return e.copy(Ze.getClearColor())},this.setClearColor=function(){Ze.setClearColor(...arguments)},this.getClearAlpha=function(){return Ze.getClearAlpha()},this.setClearAlpha=function(){Ze.setClearAlpha(...arguments)},this.clear=function(e=!0,t=!0,n=!0){let r=0;if(e){let e=!1;if(de!==null){let t=de.texture.format;e=E.has(t)}if(e){let e=de.texture.type,t=D.has(e),n=Ze.getClearColor(),r=Ze.getClearAlpha(),i=n.r,a=n.g,o=n.b;t?(O[0]=i,O[1]=a,O[2]=o,O[3]=r,B.clearBufferuiv(B.COLOR,0,O)):(k[0]=i,k[1]=a,k[2]=o,k[3]=r,B.clearBufferiv(B.COLOR,0,k))}else r|=B.COLOR_BUFFER_BIT}t&&(r|=B.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),n&&(r|=B.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),r!==0&&B.clear(r)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(e){e.setRenderer(this),I=e},this.dispose=function(){t.removeEventListener(`webglcontextlost`,ct,!1),t.removeEventListener(`webglcontextrestored`,lt,!1),t.removeEventListener(`webglcontextcreationerror`,ut,!1),Ze.dispose(),qe.dispose(),Je.dispose(),Be.dispose(),U.dispose(),Ve.dispose(),Ue.dispose(),He.dispose(),nt.dispose(),it.dispose(),We.dispose(),st.dispose(),st.removeEventListener(`sessionstart`,_t),st.removeEventListener(`sessionend`,vt),yt.stop()};function ct(e){e.preventDefault(),le(`WebGLRenderer: Context Lost.`),ne=!0}function lt(){le(`WebGLRenderer: Context Restored.`),ne=!1;let e=H.autoReset,t=Xe.enabled,n=Xe.autoUpdate,r=Xe.needsUpdate,i=Xe.type;ot(),H.autoReset=e,Xe.enabled=t,Xe.autoUpdate=n,Xe.needsUpdate=r,Xe.type=i}function ut(e){R(`WebGLRenderer: A WebGL context could not be created. Reason: `,e.statusMessage)}function dt(e){let t=e.target;t.removeEventListener(`dispose`,dt),ft(t)}function ft(e){pt(e),U.remove(e)}function pt(e){let t=U.get(e).programs;t!==void 0&&(t.forEach(function(e){We.releaseProgram(e)}),e.isShaderMaterial&&We.releaseShaderCache(e))}this.renderBufferDirect=function(e,t,n,r,i,a){t===null&&(t=Pe);let o=i.isMesh&&i.matrixWorld.determinantAffine()<0,s=At(e,t,n,r,i);V.setMaterial(r,o);let c=n.index,l=1;if(r.wireframe===!0){if(c=He.getWireframeAttribute(n),c===void 0)return;l=2}let u=n.drawRange,d=n.attributes.position,f=u.start*l,p=(u.start+u.count)*l;a!==null&&(f=Math.max(f,a.start*l),p=Math.min(p,(a.start+a.count)*l)),c===null?d!=null&&(f=Math.max(f,0),p=Math.min(p,d.count)):(f=Math.max(f,0),p=Math.min(p,c.count));let m=p-f;if(m<0||m===1/0)return;nt.setup(i,r,s,n,c);let h,g=$e;if(c!==null&&(h=G.get(c),g=et,g.setIndex(h)),i.isMesh)r.wireframe===!0?(V.setLineWidth(r.wireframeLinewidth*Ie()),g.setMode(B.LINES)):g.setMode(B.TRIANGLES);else if(i.isLine){let e=r.linewidth;e===void 0&&(e=1),V.setLineWidth(e*Ie()),i.isLineSegments?g.setMode(B.LINES):i.isLineLoop?g.setMode(B.LINE_LOOP):g.setMode(B.LINE_STRIP)}else i.isPoints?g.setMode(B.POINTS):i.isSprite&&g.setMode(B.TRIANGLES);if(i.isBatchedMesh){if(Re.get(`WEBGL_multi_draw`))g.renderMultiDraw(i._multiDrawStarts,i._multiDrawCounts,i._multiDrawCount);else{let e=i._multiDrawStarts,t=i._multiDrawCounts,n=i._multiDrawCount,a=c?G.get(c).bytesPerElement:1,o=U.get(r).currentProgram.getUniforms();for(let r=0;r<n;r++)o.setValue(B,`_gl_DrawID`,r),g.render(e[r]/a,t[r])}}else if(i.isInstancedMesh)g.renderInstances(f,m,i.count);else if(n.isInstancedBufferGeometry){let e=n._maxInstanceCount===void 0?1/0:n._maxInstanceCount,t=Math.min(n.instanceCount,e);g.renderInstances(f,m,t)}else g.render(f,m)};function mt(e,t,n,r){I!==null&&e.isNodeMaterial&&I.setObject(r,e),ke===!0&&Ye.setState(e,n,!1),e.transparent===!0&&e.side===2&&e.forceSinglePass===!1?(e.side=1,e.needsUpdate=!0,Et(e,t,r),e.side=0,e.needsUpdate=!0,Et(e,t,r),e.side=2):Et(e,t,r)}this.compile=function(e,t,n=null){n===null&&(n=e),I!==null&&I.renderStart(e,t,n),N=Je.get(n),N.init(t),ee.push(N),n.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(N.pushLight(e),e.castShadow&&N.pushShadow(e))}),e!==n&&e.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(N.pushLight(e),e.castShadow&&N.pushShadow(e))}),N.setupLights(),I!==null&&I.updateLights(N.state.lightsArray),Ae=this.localClippingEnabled,ke=Ye.init(this.clippingPlanes,Ae),ke===!0&&Ye.setGlobalState(this.clippingPlanes,t),I!==null&&Xe.render(N.state.shadowsArray,n,t);let r=new Set;return e.traverse(function(e){if(!(e.isMesh||e.isPoints||e.isLine||e.isSprite))return;let i=e.material;if(i){if(Array.isArray(i))for(let a=0;a<i.length;a++){let o=i[a];mt(o,n,t,e),r.add(o)}else mt(i,n,t,e),r.add(i)}}),N=ee.pop(),I!==null&&I.renderEnd(),r},this.compileAsync=function(e,t,n=null){let r=this.compile(e,t,n);return new Promise(t=>{function n(){r.forEach(function(e){let t=U.get(e).currentProgram;(t===void 0||t.isReady())&&r.delete(e)}),r.size===0?t(e):setTimeout(n,10)}Re.get(`KHR_parallel_shader_compile`)===null?setTimeout(n,10):n()})};let ht=null;function gt(e){ht&&ht(e)}function _t(){yt.stop()}function vt(){yt.start()}let yt=new po;yt.setAnimationLoop(gt),typeof self<`u`&&yt.setContext(self),this.setAnimationLoop=function(e){ht=e,st.setAnimationLoop(e),e===null?yt.stop():yt.start()},st.addEventListener(`sessionstart`,_t),st.addEventListener(`sessionend`,vt),this.render=function(e,t){if(t!==void 0&&t.isCamera!==!0){R(`WebGLRenderer.render: camera is not an instance of THREE.Camera.`);return}if(ne===!0)return;I!==null&&I.renderStart(e,t);let n=st.enabled===!0&&st.isPresenting===!0,r=te!==null&&(de===null||n)&&te.begin(F,de);if(e.matrixWorldAutoUpdate===!0&&e.updateMatrixWorld(),t.parent===null&&t.matrixWorldAutoUpdate===!0&&t.updateMatrixWorld(),st.enabled===!0&&st.isPresenting===!0&&(te===null||te.isCompositing()===!1)&&(st.cameraAutoUpdate===!0&&st.updateCamera(t),t=st.getCamera()),e.isScene===!0&&e.onBeforeRender(F,e,t,de),N=Je.get(e,ee.length),N.init(t),N.state.textureUnits=Be.getTextureUnits(),ee.push(N),je.multiplyMatrices(t.projectionMatrix,t.matrixWorldInverse),t.isArrayCamera?Oe.setFromArrayCamera(t):De.setFromProjectionMatrix(je,re,t.reversedDepth),Ae=this.localClippingEnabled,ke=Ye.init(this.clippingPlanes,Ae),j=qe.get(e,P.length),j.init(),P.push(j),this.info.render.frame++,st.enabled===!0&&st.isPresenting===!0){let e=F.xr.getDepthSensingMesh();e!==null&&bt(e,t,-1/0,F.sortObjects)}bt(e,t,0,F.sortObjects),j.finish(),I!==null&&I.updateLights(N.state.lightsArray),F.sortObjects===!0&&j.sort(Se,Ce),Fe=st.enabled===!1||st.isPresenting===!1||st.hasDepthSensing()===!1,Fe&&Ze.addToRenderList(j,e),this.info.autoReset===!0&&this.info.reset(),ke===!0&&Ye.beginShadows();let i=N.state.shadowsArray;if(Xe.render(i,e,t),ke===!0&&Ye.endShadows(),(r&&te.hasRenderPass())===!1){let n=j.opaque,r=j.transmissive;if(N.setupLights(),t.isArrayCamera){let i=t.cameras;if(r.length>0)for(let t=0,a=i.length;t<a;t++){let a=i[t];St(n,r,e,a)}Fe&&Ze.render(e);for(let t=0,n=i.length;t<n;t++){let n=i[t];xt(j,e,n,n.viewport)}}else r.length>0&&St(n,r,e,t),Fe&&Ze.render(e),xt(j,e,t)}de!==null&&ue===0&&(Be.updateMultisampleRenderTarget(de),Be.updateRenderTargetMipmap(de)),r&&te.end(F),e.isScene===!0&&e.onAfterRender(F,e,t),nt.resetDefaultState(),pe=-1,me=null,ee.pop(),ee.length>0?(N=ee[ee.length-1],Be.setTextureUnits(N.state.textureUnits),ke===!0&&Ye.setGlobalState(F.clippingPlanes,N.state.camera)):N=null,P.pop(),j=P.length>0?P[P.length-1]:null,I!==null&&I.renderEnd()};function bt(e,t,n,r){if(e.visible===!1)return;if(e.layers.test(t.layers)){if(e.isGroup)n=e.renderOrder;else if(e.isLOD)e.autoUpdate===!0&&e.update(t);else if(e.isLight)N.pushLight(e),e.castShadow&&N.pushShadow(e);else if(e.isSprite){let i=t.isArrayCamera?Oe:De;if(!e.frustumCulled||e.intersectsFrustum(i)){r&&Ne.setFromMatrixPosition(e.matrixWorld).applyMatrix4(je);let i=Ue.update(e),a=e.material;a.visible&&j.push(e,i,a,n,Ne.z,null,t)}}else if(e.isMesh||e.isLine||e.isPoints){let i=t.isArrayCamera?Oe:De;if(!e.frustumCulled||e.intersectsFrustum(i)){let i=Ue.update(e),a=e.material;if(r&&(e.boundingSphere===void 0?(i.boundingSphere===null&&i.computeBoundingSphere(),Ne.copy(i.boundingSphere.center)):(e.boundingSphere===null&&e.computeBoundingSphere(),Ne.copy(e.boundingSphere.center)),Ne.applyMatrix4(e.matrixWorld).applyMatrix4(je)),Array.isArray(a)){let r=i.groups;for(let o=0,s=r.length;o<s;o++){let s=r[o],c=a[s.materialIndex];c&&c.visible&&j.push(e,i,c,n,Ne.z,s,t)}}else a.visible&&j.push(e,i,a,n,Ne.z,null,t)}}}let i=e.children;for(let e=0,a=i.length;e<a;e++)bt(i[e],t,n,r)}function xt(e,t,n,r){let{opaque:i,transmissive:a,transparent:o}=e;N.setupLightsView(n),ke===!0&&Ye.setGlobalState(F.clippingPlanes,n),r&&V.viewport(he.copy(r)),i.length>0&&Ct(i,t,n),a.length>0&&Ct(a,t,n),o.length>0&&Ct(o,t,n),V.buffers.depth.setTest(!0),V.buffers.depth.setMask(!0),V.buffers.color.setMask(!0),V.setPolygonOffset(!1)}function St(e,t,n,r){if((n.isScene===!0?n.overrideMaterial:null)!==null)return;if(N.state.transmissionRenderTarget[r.id]===void 0){let e=Re.has(`EXT_color_buffer_half_float`)||Re.has(`EXT_color_buffer_float`);N.state.transmissionRenderTarget[r.id]=new at(1,1,{generateMipmaps:!0,type:e?p:l,minFilter:c,samples:Math.max(4,ze.samples),stencilBuffer:i,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:Ke.workingColorSpace})}let a=N.state.transmissionRenderTarget[r.id],o=r.viewport||he;a.setSize(o.z*F.transmissionResolutionScale,o.w*F.transmissionResolutionScale);let s=F.getRenderTarget(),u=F.getActiveCubeFace(),d=F.getActiveMipmapLevel();F.setRenderTarget(a),F.getClearColor(ve),ye=F.getClearAlpha(),ye<1&&F.setClearColor(16777215,.5),F.clear(),Fe&&Ze.render(n);let f=F.toneMapping;F.toneMapping=0;let m=r.viewport;if(r.viewport!==void 0&&(r.viewport=void 0),N.setupLightsView(r),ke===!0&&Ye.setGlobalState(F.clippingPlanes,r),Ct(e,n,r),Be.updateMultisampleRenderTarget(a),Be.updateRenderTargetMipmap(a),Re.has(`WEBGL_multisampled_render_to_texture`)===!1){let e=!1;for(let i=0,a=t.length;i<a;i++){let{object:a,geometry:o,material:s,group:c}=t[i];if(s.side===2&&a.layers.test(r.layers)){let t=s.side;s.side=1,s.needsUpdate=!0,wt(a,n,r,o,s,c),s.side=t,s.needsUpdate=!0,e=!0}}e===!0&&(Be.updateMultisampleRenderTarget(a),Be.updateRenderTargetMipmap(a))}F.setRenderTarget(s,u,d),F.setClearColor(ve,ye),m!==void 0&&(r.viewport=m),F.toneMapping=f}function Ct(e,t,n){let r=t.isScene===!0?t.overrideMaterial:null;for(let i=0,a=e.length;i<a;i++){let a=e[i],{object:o,geometry:s,group:c}=a,l=a.material;l.allowOverride===!0&&r!==null&&(l=r),o.layers.test(n.layers)&&wt(o,t,n,s,l,c)}}function wt(e,t,n,r,i,a){I!==null&&i.isNodeMaterial&&I.setObject(e,i),e.onBeforeRender(F,t,n,r,i,a),e.modelViewMatrix.multiplyMatrices(n.matrixWorldInverse,e.matrixWorld),e.normalMatrix.getNormalMatrix(e.modelViewMatrix),i.onBeforeRender(F,t,n,r,e,a),i.transparent===!0&&i.side===2&&i.forceSinglePass===!1?(i.side=1,i.needsUpdate=!0,F.renderBufferDirect(n,t,r,i,e,a),i.side=0,i.needsUpdate=!0,F.renderBufferDirect(n,t,r,i,e,a),i.side=2):F.renderBufferDirect(n,t,r,i,e,a),e.onAfterRender(F,t,n,r,i,a)}function Tt(e){let t=0;for(let n of e)n.texture!==null&&t++;return t}function Et(e,t,n){t.isScene!==!0&&(t=Pe);let r=U.get(e),i=N.state.lights,a=N.state.shadowsArray,o=i.state.version,s=We.getParameters(e,i.state,a,t,n,N.state.lightProbeGridArray),c=We.getProgramCacheKey(s),l=r.programs;r.environment=e.isMeshStandardMaterial||e.isMeshLambertMaterial||e.isMeshPhongMaterial?t.environment:null,r.fog=t.fog;let u=e.isMeshStandardMaterial||e.isMeshLambertMaterial&&!e.envMap||e.isMeshPhongMaterial&&!e.envMap;r.envMap=Ve.get(e.envMap||r.environment,u),r.envMapRotation=r.environment!==null&&e.envMap===null?t.environmentRotation:e.envMapRotation,l===void 0&&(e.addEventListener(`dispose`,dt),l=new Map,r.programs=l,r.programVariants=new Map);let d=l.get(c);if(d!==void 0){if(r.currentProgram===d&&r.lightsStateVersion===o)return kt(e,s),d}else s.uniforms=We.getUniforms(e),I!==null&&e.isNodeMaterial&&I.build(e,n,s),e.onBeforeCompile(s,F),d=We.acquireProgram(s,c),l.set(c,d),r.uniforms=s.uniforms;let f=r.uniforms;return(!e.isShaderMaterial&&!e.isRawShaderMaterial||e.clipping===!0)&&(f.clippingPlanes=Ye.uniform),kt(e,s),r.needsLights=Mt(e),r.lightsStateVersion=o,r.needsLights&&(f.ambientLightColor.value=i.state.ambient,f.lightProbe.value=i.state.probe,f.sunLights.value=i.state.sun,f.sunLightShadows.value=i.state.sunShadow,f.directionalLights.value=i.state.directional,f.directionalLightShadows.value=i.state.directionalShadow,f.spotLights.value=i.state.spot,f.spotLightShadows.value=i.state.spotShadow,f.rectAreaLights.value=i.state.rectArea,f.ltc_1.value=i.state.rectAreaLTC1,f.ltc_2.value=i.state.rectAreaLTC2,f.pointLights.value=i.state.point,f.pointLightShadows.value=i.state.pointShadow,f.hemisphereLights.value=i.state.hemi,f.sunShadowMatrix.value=i.state.sunShadowMatrix,f.sunShadowCascade.value=i.state.sunShadowCascade,f.directionalShadowMatrix.value=i.state.directionalShadowMatrix,f.spotLightMatrix.value=i.state.spotLightMatrix,f.spotLightMap.value=i.state.spotLightMap,f.pointShadowMatrix.value=i.state.pointShadowMatrix),r.numLightProbeGrids=Tt(N.state.lightProbeGridArray),r.currentProgram=d,r.uniformsList=null,d}function Dt(e,t,n,r,i){let a=U.get(e),o=a.currentProgram.id+`,`+r+`,`+i,s=a.programVariants.get(o);return s===void 0?(s=Et(e,t,n),a.programVariants.set(o,s)):(a.currentProgram=s,a.uniformsList=null,a.outputColorSpace=r,a.toneMapping=i),s}function Ot(e){if(e.uniformsList===null){let t=e.currentProgram.getUniforms();e.uniformsList=ic.seqWithValue(t.seq,e.uniforms)}return e.uniformsList}function kt(e,t){let n=U.get(e);n.outputColorSpace=t.outputColorSpace,n.batching=t.batching,n.batchingColor=t.batchingColor,n.instancing=t.instancing,n.instancingColor=t.instancingColor,n.instancingMorph=t.instancingMorph,n.skinning=t.skinning,n.morphTargets=t.morphTargets,n.morphNormals=t.morphNormals,n.morphColors=t.morphColors,n.morphTargetsCount=t.morphTargetsCount,n.numClippingPlanes=t.numClippingPlanes,n.numIntersection=t.numClipIntersection,n.vertexAlphas=t.vertexAlphas,n.vertexTangents=t.vertexTangents,n.toneMapping=t.toneMapping}function At(e,t,n,r,i){t.isScene!==!0&&(t=Pe),Be.resetTextureUnits();let a=t.fog,o=r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial?t.environment:null,s=de===null?F.outputColorSpace:de.isXRRenderTarget===!0?de.texture.colorSpace:Ke.workingColorSpace,c=r.isMeshStandardMaterial||r.isMeshLambertMaterial&&!r.envMap||r.isMeshPhongMaterial&&!r.envMap,l=Ve.get(r.envMap||o,c),u=r.vertexColors===!0&&!!n.attributes.color&&n.attributes.color.itemSize===4,d=!!n.attributes.tangent&&(!!r.normalMap||r.anisotropy>0),f=!!n.morphAttributes.position,p=!!n.morphAttributes.normal,m=!!n.morphAttributes.color,h=0;r.toneMapped&&(de===null||de.isXRRenderTarget===!0)&&(h=F.toneMapping);let g=n.morphAttributes.position||n.morphAttributes.normal||n.morphAttributes.color,_=g===void 0?0:g.length,v=U.get(r),y=N.state.lights;if(ke===!0&&(Ae===!0||e!==me)){let t=e===me&&r.id===pe;Ye.setState(r,e,t)}let b=!1,x=!1;r.version===v.__version?v.needsLights&&v.lightsStateVersion!==y.state.version||i.isBatchedMesh&&v.batching===!1||!i.isBatchedMesh&&v.batching===!0||i.isBatchedMesh&&v.batchingColor===!0&&i._colorsTexture===null||i.isBatchedMesh&&v.batchingColor===!1&&i._colorsTexture!==null||i.isInstancedMesh&&v.instancing===!1||!i.isInstancedMesh&&v.instancing===!0||i.isSkinnedMesh&&v.skinning===!1||!i.isSkinnedMesh&&v.skinning===!0||i.isInstancedMesh&&v.instancingColor===!0&&i.instanceColor===null||i.isInstancedMesh&&v.instancingColor===!1&&i.instanceColor!==null||i.isInstancedMesh&&v.instancingMorph===!0&&i.morphTexture===null||i.isInstancedMesh&&v.instancingMorph===!1&&i.morphTexture!==null?b=!0:v.envMap===l?r.fog===!0&&v.fog!==a||v.numClippingPlanes!==void 0&&(v.numClippingPlanes!==Ye.numPlanes||v.numIntersection!==Ye.numIntersection)?b=!0:v.vertexAlphas===u&&v.vertexTangents===d&&v.morphTargets===f&&v.morphNormals===p&&v.morphColors===m&&v.morphTargetsCount===_&&v.numLightProbeGrids===Tt(N.state.lightProbeGridArray)?(v.outputColorSpace!==s||v.toneMapping!==h)&&(x=!0):b=!0:b=!0:(b=!0,v.__version=r.version);let S=v.currentProgram;(b===!0||x===!0)&&(S=x===!0?Dt(r,t,i,s,h):Et(r,t,i),I&&r.isNodeMaterial&&I.onUpdateProgram(r,S,v));let C=!1,w=!1,T=!1,E=S.getUniforms(),D=v.uniforms;if(V.useProgram(S.program)&&(C=!0,w=!0,T=!0),r.id!==pe&&(pe=r.id,w=!0),C||me!==e){V.buffers.depth.getReversed()&&e.reversedDepth!==!0&&(e._reversedDepth=!0,e.updateProjectionMatrix()),E.setValue(B,`projectionMatrix`,e.projectionMatrix),E.setValue(B,`viewMatrix`,e.matrixWorldInverse);let t=E.map.cameraPosition;t!==void 0&&t.setValue(B,Me.setFromMatrixPosition(e.matrixWorld)),ze.logarithmicDepthBuffer&&E.setValue(B,`logDepthBufFC`,2/(Math.log(e.far+1)/Math.LN2)),(r.isMeshPhongMaterial||r.isMeshToonMaterial||r.isMeshLambertMaterial||r.isMeshBasicMaterial||r.isMeshStandardMaterial||r.isShaderMaterial)&&E.setValue(B,`isOrthographic`,e.isOrthographicCamera===!0),me!==e&&(me=e,w=!0,T=!0)}if(v.needsLights&&(y.state.sunShadowMap.length>0&&E.setValue(B,`sunShadowMap`,y.state.sunShadowMap,Be),y.state.directionalShadowMap.length>0&&E.setValue(B,`directionalShadowMap`,y.state.directionalShadowMap,Be),y.state.spotShadowMap.length>0&&E.setValue(B,`spotShadowMap`,y.state.spotShadowMap,Be),y.state.pointShadowMap.length>0&&E.setValue(B,`pointShadowMap`,y.state.pointShadowMap,Be)),i.isSkinnedMesh){E.setOptional(B,i,`bindMatrix`),E.setOptional(B,i,`bindMatrixInverse`);let e=i.skeleton;e&&(e.boneTexture===null&&e.computeBoneTexture(),E.setValue(B,`boneTexture`,e.boneTexture,Be))}i.isBatchedMesh&&(E.setOptional(B,i,`batchingTexture`),E.setValue(B,`batchingTexture`,i._matricesTexture,Be),E.setOptional(B,i,`batchingIdTexture`),E.setValue(B,`batchingIdTexture`,i._indirectTexture,Be),E.setOptional(B,i,`batchingColorTexture`),i._colorsTexture!==null&&E.setValue(B,`batchingColorTexture`,i._colorsTexture,Be));let O=n.morphAttributes;if((O.position!==void 0||O.normal!==void 0||O.color!==void 0)&&Qe.update(i,n,S),(w||v.receiveShadow!==i.receiveShadow)&&(v.receiveShadow=i.receiveShadow,E.setValue(B,`receiveShadow`,i.receiveShadow)),(r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial)&&r.envMap===null&&t.environment!==null&&(D.envMapIntensity.value=t.environmentIntensity),D.dfgLUT!==void 0&&(D.dfgLUT.value=xl()),w){if(E.setValue(B,`toneMappingExposure`,F.toneMappingExposure),v.needsLights&&jt(D,T),a&&r.fog===!0&&Ge.refreshFogUniforms(D,a),Ge.refreshMaterialUniforms(D,r,xe,be,N.state.transmissionRenderTarget[e.id]),v.needsLights&&v.numLightProbeGrids>0){let e=A,t=0;for(let n of N.state.lightProbeGridArray)n.texture!==null&&(e.textures[t]=n.texture,e.min[t]=n.boundingBox.min,e.max[t]=n.boundingBox.max,e.resolution[t]=n.resolution,t++);for(let n in e)e[n].length=t;D.probesSH.value=e.textures,D.probesMin.value=e.min,D.probesMax.value=e.max,D.probesResolution.value=e.resolution}ic.upload(B,Ot(v),D,Be)}if(r.isShaderMaterial&&r.uniformsNeedUpdate===!0&&(ic.upload(B,Ot(v),D,Be),r.uniformsNeedUpdate=!1),r.isSpriteMaterial&&E.setValue(B,`center`,i.center),E.setValue(B,`modelViewMatrix`,i.modelViewMatrix),E.setValue(B,`normalMatrix`,i.normalMatrix),E.setValue(B,`modelMatrix`,i.matrixWorld),r.uniformsGroups!==void 0){let e=r.uniformsGroups;for(let t=0,n=e.length;t<n;t++){let n=e[t];it.update(n,S),it.bind(n,S)}}return S}function jt(e,t){e.ambientLightColor.needsUpdate=t,e.lightProbe.needsUpdate=t,e.sunLights.needsUpdate=t,e.sunLightShadows.needsUpdate=t,e.directionalLights.needsUpdate=t,e.directionalLightShadows.needsUpdate=t,e.pointLights.needsUpdate=t,e.pointLightShadows.needsUpdate=t,e.spotLights.needsUpdate=t,e.spotLightShadows.needsUpdate=t,e.rectAreaLights.needsUpdate=t,e.hemisphereLights.needsUpdate=t}function Mt(e){return e.isMeshLambertMaterial||e.isMeshToonMaterial||e.isMeshPhongMaterial||e.isMeshStandardMaterial||e.isShadowMaterial||e.isShaderMaterial&&e.lights===!0}this.getActiveCubeFace=function(){return ce},this.getActiveMipmapLevel=function(){return ue},this.getRenderTarget=function(){return de},this.setRenderTargetTextures=function(e,t,n){let r=U.get(e);r.__autoAllocateDepthBuffer=e.resolveDepthBuffer===!1,r.__autoAllocateDepthBuffer===!1&&(r.__useRenderToTexture=!1),U.get(e.texture).__webglTexture=t,U.get(e.depthTexture).__webglTexture=r.__autoAllocateDepthBuffer?void 0:n,r.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(e,t){let n=U.get(e);n.__webglFramebuffer=t,n.__useDefaultFramebuffer=t===void 0},this.setRenderTarget=function(e,t=0,n=0){de=e,ce=t,ue=n;let r=null,i=!1,a=!1;if(e){let o=U.get(e);if(o.__useDefaultFramebuffer!==void 0){V.bindFramebuffer(B.FRAMEBUFFER,o.__webglFramebuffer),he.copy(e.viewport),ge.copy(e.scissor),_e=e.scissorTest,V.viewport(he),V.scissor(ge),V.setScissorTest(_e),pe=-1;return}if(o.__webglFramebuffer===void 0)Be.setupRenderTarget(e);else if(o.__hasExternalTextures)Be.rebindTextures(e,U.get(e.texture).__webglTexture,U.get(e.depthTexture).__webglTexture);else if(e.depthBuffer){let t=e.depthTexture;if(o.__boundDepthTexture!==t){if(t!==null&&U.has(t)&&(e.width!==t.image.width||e.height!==t.image.height))throw Error(`THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.`);Be.setupDepthRenderbuffer(e)}}let s=e.texture;(s.isData3DTexture||s.isDataArrayTexture||s.isCompressedArrayTexture)&&(a=!0);let c=U.get(e).__webglFramebuffer;e.isWebGLCubeRenderTarget?(r=Array.isArray(c[t])?c[t][n]:c[t],i=!0):r=e.samples>0&&Be.useMultisampledRTT(e)===!1?U.get(e).__webglMultisampledFramebuffer:Array.isArray(c)?c[n]:c,he.copy(e.viewport),ge.copy(e.scissor),_e=e.scissorTest}else he.copy(we).multiplyScalar(xe).floor(),ge.copy(Te).multiplyScalar(xe).floor(),_e=Ee;if(n!==0&&(r=ie),V.bindFramebuffer(B.FRAMEBUFFER,r)&&V.drawBuffers(e,r),V.viewport(he),V.scissor(ge),V.setScissorTest(_e),i){let r=U.get(e.texture);B.framebufferTexture2D(B.FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_CUBE_MAP_POSITIVE_X+t,r.__webglTexture,n)}else if(a){let r=t;for(let t=0;t<e.textures.length;t++){let i=U.get(e.textures[t]);B.framebufferTextureLayer(B.FRAMEBUFFER,B.COLOR_ATTACHMENT0+t,i.__webglTexture,n,r)}}else if(e!==null&&n!==0){let t=U.get(e.texture);B.framebufferTexture2D(B.FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_2D,t.__webglTexture,n)}pe=-1};function Nt(e){let t=U.get(e);return(t.__readFormat!==e.format||t.__readType!==e.type)&&(t.__readFormat=e.format,t.__readType=e.type,t.__formatReadable=ze.textureFormatReadable(e.format),t.__typeReadable=ze.textureTypeReadable(e.type)),t}this.readRenderTargetPixels=function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget)){R(`WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);return}let c=U.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){V.bindFramebuffer(B.FRAMEBUFFER,c);try{let o=e.textures[s],c=o.format,l=o.type;e.textures.length>1&&B.readBuffer(B.COLOR_ATTACHMENT0+s);let u=Nt(o);if(u.__formatReadable===!1){R(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.`);return}if(u.__typeReadable===!1){R(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.`);return}t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i&&B.readPixels(t,n,r,i,tt.convert(c),tt.convert(l),a)}finally{let e=de===null?null:U.get(de).__webglFramebuffer;V.bindFramebuffer(B.FRAMEBUFFER,e)}}},this.readRenderTargetPixelsAsync=async function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget))throw Error(`THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);let c=U.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){if(t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i){V.bindFramebuffer(B.FRAMEBUFFER,c);let o=e.textures[s],l=o.format,u=o.type;e.textures.length>1&&B.readBuffer(B.COLOR_ATTACHMENT0+s);let d=Nt(o);if(d.__formatReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.`);if(d.__typeReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.`);let f=B.createBuffer();B.bindBuffer(B.PIXEL_PACK_BUFFER,f),B.bufferData(B.PIXEL_PACK_BUFFER,a.byteLength,B.STREAM_READ),B.readPixels(t,n,r,i,tt.convert(l),tt.convert(u),0),B.bindBuffer(B.PIXEL_PACK_BUFFER,null);let p=de===null?null:U.get(de).__webglFramebuffer;V.bindFramebuffer(B.FRAMEBUFFER,p);let m=B.fenceSync(B.SYNC_GPU_COMMANDS_COMPLETE,0);return B.flush(),await fe(B,m,4),B.bindBuffer(B.PIXEL_PACK_BUFFER,f),B.getBufferSubData(B.PIXEL_PACK_BUFFER,0,a),B.bindBuffer(B.PIXEL_PACK_BUFFER,null),B.deleteBuffer(f),B.deleteSync(m),a}throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.`)}},this.copyFramebufferToTexture=function(e,t=null,n=0){let r=2**-n,i=Math.floor(e.image.width*r),a=Math.floor(e.image.height*r),o=t===null?0:t.x,s=t===null?0:t.y;Be.setTexture2D(e,0),B.copyTexSubImage2D(B.TEXTURE_2D,n,0,0,o,s,i,a),V.unbindTexture()},this.copyTextureToTexture=function(e,t,n=null,r=null,i=0,a=0){let o,s,c,l,u,d,f,p,m,h=e.isCompressedTexture?e.mipmaps[a]:e.image;if(n!==null)o=n.max.x-n.min.x,s=n.max.y-n.min.y,c=n.isBox3?n.max.z-n.min.z:1,l=n.min.x,u=n.min.y,d=n.isBox3?n.min.z:0;else{let t=2**-i;o=Math.floor(h.width*t),s=Math.floor(h.height*t),c=e.isDataArrayTexture?h.depth:e.isData3DTexture?Math.floor(h.depth*t):1,l=0,u=0,d=0}r===null?(f=0,p=0,m=0):(f=r.x,p=r.y,m=r.z);let g=tt.convert(t.format),_=tt.convert(t.type),v;t.isData3DTexture?(Be.setTexture3D(t,0),v=B.TEXTURE_3D):t.isDataArrayTexture||t.isCompressedArrayTexture?(Be.setTexture2DArray(t,0),v=B.TEXTURE_2D_ARRAY):(Be.setTexture2D(t,0),v=B.TEXTURE_2D),V.activeTexture(B.TEXTURE0),V.pixelStorei(B.UNPACK_FLIP_Y_WEBGL,t.flipY),V.pixelStorei(B.UNPACK_PREMULTIPLY_ALPHA_WEBGL,t.premultiplyAlpha),V.pixelStorei(B.UNPACK_ALIGNMENT,t.unpackAlignment);let y=V.getParameter(B.UNPACK_ROW_LENGTH),b=V.getParameter(B.UNPACK_IMAGE_HEIGHT),x=V.getParameter(B.UNPACK_SKIP_PIXELS),S=V.getParameter(B.UNPACK_SKIP_ROWS),C=V.getParameter(B.UNPACK_SKIP_IMAGES);V.pixelStorei(B.UNPACK_ROW_LENGTH,h.width),V.pixelStorei(B.UNPACK_IMAGE_HEIGHT,h.height),V.pixelStorei(B.UNPACK_SKIP_PIXELS,l),V.pixelStorei(B.UNPACK_SKIP_ROWS,u),V.pixelStorei(B.UNPACK_SKIP_IMAGES,d);let w=e.isDataArrayTexture||e.isData3DTexture,T=t.isDataArrayTexture||t.isData3DTexture;if(e.isDepthTexture){let n=U.get(e),r=U.get(t),h=U.get(n.__renderTarget),g=U.get(r.__renderTarget);V.bindFramebuffer(B.READ_FRAMEBUFFER,h.__webglFramebuffer),V.bindFramebuffer(B.DRAW_FRAMEBUFFER,g.__webglFramebuffer);for(let n=0;n<c;n++)w&&(B.framebufferTextureLayer(B.READ_FRAMEBUFFER,B.COLOR_ATTACHMENT0,U.get(e).__webglTexture,i,d+n),B.framebufferTextureLayer(B.DRAW_FRAMEBUFFER,B.COLOR_ATTACHMENT0,U.get(t).__webglTexture,a,m+n)),B.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,B.DEPTH_BUFFER_BIT,B.NEAREST);V.bindFramebuffer(B.READ_FRAMEBUFFER,null),V.bindFramebuffer(B.DRAW_FRAMEBUFFER,null)}else if(i!==0||e.isRenderTargetTexture||U.has(e)){let n=U.get(e),r=U.get(t);V.bindFramebuffer(B.READ_FRAMEBUFFER,ae),V.bindFramebuffer(B.DRAW_FRAMEBUFFER,oe);for(let e=0;e<c;e++)w?B.framebufferTextureLayer(B.READ_FRAMEBUFFER,B.COLOR_ATTACHMENT0,n.__webglTexture,i,d+e):B.framebufferTexture2D(B.READ_FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_2D,n.__webglTexture,i),T?B.framebufferTextureLayer(B.DRAW_FRAMEBUFFER,B.COLOR_ATTACHMENT0,r.__webglTexture,a,m+e):B.framebufferTexture2D(B.DRAW_FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_2D,r.__webglTexture,a),i===0?T?B.copyTexSubImage3D(v,a,f,p,m+e,l,u,o,s):B.copyTexSubImage2D(v,a,f,p,l,u,o,s):B.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,B.COLOR_BUFFER_BIT,B.NEAREST);V.bindFramebuffer(B.READ_FRAMEBUFFER,null),V.bindFramebuffer(B.DRAW_FRAMEBUFFER,null)}else T?e.isDataTexture||e.isData3DTexture?B.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h.data):t.isCompressedArrayTexture?B.compressedTexSubImage3D(v,a,f,p,m,o,s,c,g,h.data):B.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h):e.isDataTexture?B.texSubImage2D(B.TEXTURE_2D,a,f,p,o,s,g,_,h.data):e.isCompressedTexture?B.compressedTexSubImage2D(B.TEXTURE_2D,a,f,p,h.width,h.height,g,h.data):B.texSubImage2D(B.TEXTURE_2D,a,f,p,o,s,g,_,h);V.pixelStorei(B.UNPACK_ROW_LENGTH,y),V.pixelStorei(B.UNPACK_IMAGE_HEIGHT,b),V.pixelStorei(B.UNPACK_SKIP_PIXELS,x),V.pixelStorei(B.UNPACK_SKIP_ROWS,S),V.pixelStorei(B.UNPACK_SKIP_IMAGES,C),a===0&&t.generateMipmaps===!0&&t.mipmapsAutoUpdate===!0&&B.generateMipmap(v),V.unbindTexture()},this.initRenderTarget=function(e){U.get(e).__webglFramebuffer===void 0&&Be.setupRenderTarget(e)},this.initTexture=function(e){e.isCubeTexture?Be.setTextureCube(e,0):e.isData3DTexture?Be.setTexture3D(e,0):e.isDataArrayTexture||e.isCompressedArrayTexture?Be.setTexture2DArray(e,0):Be.setTexture2D(e,0),V.unbindTexture()},this.resetState=function(){ce=0,ue=0,de=null,V.reset(),nt.reset()},typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}get coordinateSystem(){return re}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=Ke._getDrawingBufferColorSpace(e),t.unpackColorSpace=Ke._getUnpackColorSpace()}},Cl={units:`B kB MB GB`,outOf:`{part} von {whole}`,keyHome:`Pos1`,keySpace:`Leertaste`,keyEscape:`Esc`,canvas:`Die Szene: Pfeiltasten bewegen, H zeigt die ganze Bedienung`,canvasPlain:`Die Szene: Pfeiltasten bewegen`,scene:`Szene`,sceneFile:`Szenendatei`,tools:`Werkzeuge`,firstView:`Erste Ansicht`,orbit:`Umkreisen`,tilt:`Durch Neigen des Geräts bewegen`,savePicture:`Bild speichern`,share:`Link zu dieser Ansicht kopieren`,linkCopied:`Link kopiert`,copyEmbed:`Einbettungscode kopieren`,embedCopied:`Einbettungscode kopiert`,download:`Szene herunterladen`,draft:`Ein Entwurf. Die Szene selbst folgt.`,draftMinutes:`Ein Entwurf. Die Szene selbst folgt in etwa {minutes} min.`,draftLost:`Dies ist ein Entwurf: Der Befehl, der die Szene selbst erzeugt, ist beendet.`,openFile:`Datei öffnen`,controls:`Bedienung`,fullScreen:`Vollbild`,enterVr:`VR starten`,playback:`Wiedergabe`,play:`Abspielen`,pause:`Anhalten`,time:`Zeit`,speed:`Geschwindigkeit`,sound:`Ton`,noSound:`Dieser Browser kann den Ton nicht abspielen.`,repeat:`Wiederholen`,panel:`Seitenleiste`,laboratory:`Labor`,map:`Karte der Aufnahmekameras mit der Stelle des Auges`,row:`Reihe {row} von {rows}`,loading:`Wird geladen`,textureOf:`Eigentextur {part} von {whole}`,dropHere:`Eine .glb-Datei hier ablegen oder auswählen`,chooseFile:`Datei auswählen`,chooseAnother:`Andere Datei auswählen`,staysHere:`Nichts wird hochgeladen: Die Datei bleibt auf diesem Gerät.`,samples:`Oder eine von diesen ansehen`,dropToOpen:`Zum Öffnen loslassen`,dismiss:`Schließen`,outside:`Außerhalb der aufgenommenen Ansichten`,comeBack:`Zurück`,hint:`Ziehen, um sich umzusehen`,drawn:`gerendert`,mean:`Mittel`,eigenNumber:`Eigentextur {number}`,errorTimes:`Fehler × 5`,greyLevels:`Graustufen Abweichung`,photograph:`Foto`,noWebgl:`Hierfür wird WebGL 2 benötigt, das dieser Browser hier nicht anbietet. Ein aktueller Browser mit eingeschalteter Grafikbeschleunigung zeigt die Szene.`,tiltDenied:`Dieser Browser verrät der Seite nicht, wie das Gerät gehalten wird: Erlauben Sie ihr die Bewegungssensoren.`,vrRefused:`Die VR-Brille kann die Szene nicht zeigen: {reason}`,contextLost:`Das Grafiksystem hat seinen Speicher zurückgeholt. Sobald es wieder zeichnen kann, geht es weiter …`,cannotOpen:`{name} lässt sich nicht öffnen: {reason}`,otherSite:`Die Szene konnte nicht von {site} geladen werden. Vielleicht stimmt die Adresse nicht, das Netz fehlt, oder der Server erlaubt anderen Seiten nicht, seine Dateien zu lesen (CORS). Laden Sie die Datei herunter und legen Sie sie hier ab.`,photographLost:"Das Foto von {name} konnte nicht geladen werden: Läuft `eigenfield view` noch?",camerasDiffer:`Die Kameras der beiden Szenen unterscheiden sich: das Auge steht in jeder Anordnung an derselben Stelle.`,byDrag:`Ziehen · ein Finger`,byFinger:`Ein Finger`,byArrows:`Pfeiltasten · W A S D`,byWheel:`Mausrad · zwei Finger spreizen · Q E`,byPinch:`Zwei Finger spreizen`,byShiftWheel:`Umschalt + Mausrad · R F`,byRightDrag:`Mit rechter Taste ziehen · zwei Finger`,byTwoFingers:`Zwei Finger`,byDoubleClick:`Doppelklick`,byDoubleTap:`Doppeltippen`,byMap:`Karte`,byTilt:`Schaltfläche zum Neigen`,byGamepad:`Gamepad`,byHeadset:`VR-Brille`,doesMove:`den Kopf vor der Kameraanordnung bewegen; beim Umkreisen um einen Punkt`,doesSteps:`dasselbe, Schritt für Schritt`,doesZoom:`kleiner, größer`,doesDolly:`vor und zurück, aus der Ansichtsebene heraus`,doesShift:`beim Umkreisen: verschieben`,doesTurnAbout:`beim Umkreisen: um diesen Punkt der Oberfläche drehen`,doesMap:`an diese Stelle gehen; Punkte sind Kameras`,doesOrbit:`umkreisen, und zurück zur Ansichtsebene`,doesCameras:`vorige, nächste Aufnahmekamera`,doesNearest:`die Aufnahmekamera, die dem Auge am nächsten ist`,doesFlip:`zwischen gerendertem Bild und Foto wechseln`,doesPlay:`bei einem Clip: abspielen oder anhalten, ein Bild zurück, ein Bild weiter`,doesSound:`bei einem Clip: Ton an oder aus`,doesSpeed:`bei einem Clip: langsamer, schneller`,doesDivide:`gerendertes Bild und Foto nebeneinander`,doesViews:`Bild, nur das Mittel, einzelne Eigentextur, Fehler × 5`,doesCount:`weniger, mehr Eigentexturen`,doesWeights:`Gewichte je Strahl oder für das Auge`,doesWireframe:`Drahtgitter`,doesHome:`die erste Ansicht`,doesBack:`zurück zu den aufgenommenen Ansichten`,doesSave:`das Bild speichern`,doesTilt:`durch Neigen des Geräts bewegen`,doesPanel:`Seitenleiste ein- oder ausblenden`,doesHelp:`diese Liste`,doesGamepad:`Sticks bewegen; Schultertasten wechseln die Kamera; A wechselt zum Foto; B zur ersten Ansicht`,doesGamepadClip:`bei einem Clip: A spielt ab oder hält an; das Steuerkreuz geht bildweise; die Trigger eine Sekunde zurück oder weiter`,doesHeadset:`bei einem Clip: Trigger spielt ab oder hält an; Griff links oder rechts: eine Sekunde zurück oder weiter`,close:`Schließen`,about:`{program}. Dateien bleiben auf diesem Gerät: Die Seite sendet nichts.`,panelLabel:`Bedienung und Angaben`,show:`Anzeige`,showPicture:`Bild`,showMean:`Mittel`,showEigen:`Eigen`,showError:`Fehler ×5`,eigenTexture:`Eigentextur`,eigenTextures:`Eigentexturen`,noEigenTextures:`Die Datei hat keine Eigentexturen.`,capturedCamera:`Aufnahmekamera`,freeView:`freie Ansicht`,previousCamera:`Vorige Kamera`,nextCamera:`Nächste Kamera`,nearestCamera:`Dem Auge nächste Kamera`,heldOut:`zurückgehalten`,heldOutNote:`{count} zurückgehalten: Der Encoder hat sie nie gesehen.`,showPhotograph:`Foto zeigen`,showDrawing:`Foto – gerendertes Bild zeigen`,divider:`Gerendertes Bild neben Foto`,dividerScenes:`Linie zwischen den beiden Szenen`,toCompare:`Zum Vergleichen:`,noPhotographs:`Die Fotos sind nicht hier. Mit der Aufnahme: eigenfield view scene.glb CAPTURE`,noPlane:`Die Kameras stehen um das Objekt herum: Es gibt keine Ebene, aus der sie alle blicken.`,noGrid:`Die Kameras bilden kein Raster.`,move:`Bewegung`,onPlane:`Auf der Ansichtsebene`,drawing:`Darstellung`,weightsOffPlane:`Gewichte abseits der Ebene`,eachRay:`Je Strahl`,theEye:`Für das Auge`,betweenCameras:`Zwischen Kameras`,nearestThree:`Nächste 3`,delaunay:`Delaunay`,texels:`Texel`,bilinear:`Bilinear`,bicubic:`Bikubisch`,background:`Hintergrund`,black:`schwarz`,dark:`dunkel`,grey:`grau`,white:`weiß`,wireframe:`Drahtgitter`,plainGltf:`Eine gewöhnliche glTF-Datei ohne Eigentexturen.`,plainGltfShown:`Sie wird so gezeigt, wie sie ist.`,inFull:`Vollständig gezeichnet`,inFullNear:`Vollständig gezeichnet, nächste Kamera {name}`,rate:`{rate} Bilder je Sekunde`,rateCoarser:`{rate} Bilder je Sekunde, gröber bis zur Ruhe`,rateLinear:`{rate} Bilder je Sekunde, linear bis zur Ruhe`,frame:`Einzelbild`,group:`Gruppe`,leftOut:`ausgelassene Bilder`,shownHere:`hier gezeigt`,shownBits:`8 von 10 Bit`,shownMeans:`beim Abspielen keine Eigentexturen: Das Decodieren ist hier zu langsam`,shownKeys:`Schlüsselbilder: Dieser Browser decodiert keine AV1-Videos mit 10 Bit`,shownInsecure:`Schlüsselbilder: Browser spielen Clips nur von https und localhost ab`,aboutFile:`Über diese Datei`,quality:`Qualität, an den Fotos gemessen`,encodedViews:`codierte Ansichten`,heldOutViews:`zurückgehaltene Ansichten`,betweenViews:`zwischen den Ansichten`,atLeastLuma:`mindestens {value} Luma`,aboutValue:`etwa {value}`,textureMaps:`Texturkarten`,ratio:`kleiner als die Fotos`,notMeasured:`nicht gemessen`,bytes:`Bytes`,file:`Datei`,mesh:`Netz`,opacity:`Deckkraft`,countTextures:`{count} Eigentextur|{count} Eigentexturen`,weights:`Gewichte`,groups:`Gruppen von Bildern`,rest:`Kalibrierung und Übriges`,sceneFacts:`Szene`,cameras:`Kameras`,countCameras:`{count} Kamera|{count} Kameras`,countHeldOut:`{count} zurückgehalten`,photographs:`Fotos`,texelCount:`Texel`,plane:`Bildebene {number}`,channels:`{count} Kanal|{count} Kanäle`,meanOf:`Mittel von {size}`,texturesOf:`{count} Eigentextur von {size}|{count} Eigentexturen von {size}`,vertices:`Eckpunkte`,triangles:`Dreiecke`,sheets:`Schichten`,sheetsOver:`{count}, übereinander`,format:`Format`,madeBy:`erzeugt von`,rights:`Rechte`,title:`Titel`,author:`Urheber`,licence:`Lizenz`,source:`Quelle`,here:`Auf diesem Gerät`,gpuMemory:`Grafikspeicher`,eigenTexturesHere:`Eigentexturen`,howMade:`Wie sie entstanden ist`,"plugin.not-glb":`Das ist keine .glb-Datei. Nehmen Sie eine, die eigenfield geschrieben hat.`,"plugin.truncated":`Die Datei ist unvollständig. Laden oder kopieren Sie sie noch einmal.`,"plugin.damaged":`Die Datei ist beschädigt. Erzeugen oder laden Sie sie noch einmal.`,"plugin.version":`Diese Anzeige kennt die Version der Datei nicht. Nehmen Sie eine neuere.`,"plugin.needs":`Die Szene braucht etwas, das diese Anzeige nicht zeichnen kann. Nehmen Sie eine neuere.`,"plugin.unsupported":`Diese Anzeige oder dieses Gerät kann die Datei nicht zeichnen.`,"plugin.network":`Die Szene konnte nicht geladen werden. Prüfen Sie Adresse und Verbindung.`,"plugin.address":`Die Datei verweist auf eine andere, die nicht geholt wird. Exportieren Sie alles in eine .glb-Datei.`,"plugin.codec":`Dieser Browser kann die Bilder der Szene nicht decodieren. Nehmen Sie einen neueren.`,"plugin.codec-unknown":`Die Datei verwendet eine Codierung, die diese Anzeige nicht kennt. Nehmen Sie eine neuere.`,"plugin.limited":`Der Grafikspeicher reicht nicht für alles: {what}.`,"plugin.limited.count":`{part} von {whole} Eigentexturen werden gezeichnet`,"plugin.limited.bits":`Eigentexturen haben 8 Bit`,"plugin.limited.scale":`Eigentexturen haben {percent} % ihrer Breite und Höhe`,"plugin.limited.mean":`die mittlere Textur hat {percent} % ihrer Breite und Höhe`},wl={units:`B kB MB GB`,outOf:`{part} of {whole}`,keyHome:`Home`,keySpace:`Space`,keyEscape:`Esc`,canvas:`The scene: arrow keys move, H lists all controls`,canvasPlain:`The scene: arrow keys move`,scene:`scene`,sceneFile:`Scene file`,tools:`Tools`,firstView:`First view`,orbit:`Orbit`,tilt:`Move by tilting the device`,savePicture:`Save the picture`,share:`Copy a link to this view`,linkCopied:`Link copied`,copyEmbed:`Copy embed code`,embedCopied:`Embed code copied`,download:`Download the scene`,draft:`A draft. The scene itself follows.`,draftMinutes:`A draft. The scene itself follows in about {minutes} min.`,draftLost:`This is a draft: the command that makes the scene itself has ended.`,openFile:`Open a file`,controls:`Controls`,fullScreen:`Full screen`,enterVr:`Enter VR`,playback:`Playback`,play:`Play`,pause:`Pause`,time:`Time`,speed:`Speed`,sound:`Sound`,noSound:`This browser cannot play the sound.`,repeat:`Repeat`,panel:`Panel`,laboratory:`Laboratory`,map:`Map of the captured cameras with the place of the eye`,row:`Row {row} of {rows}`,loading:`Loading`,textureOf:`eigen texture {part} of {whole}`,dropHere:`Drop a .glb here, or choose a file`,chooseFile:`Choose a file`,chooseAnother:`Choose another file`,staysHere:`Nothing is uploaded: the file stays on this device.`,samples:`Or look at one of these`,dropToOpen:`Drop to open`,dismiss:`Dismiss`,outside:`Outside the captured views`,comeBack:`Come back`,hint:`Drag to look around`,drawn:`drawn`,mean:`mean`,eigenNumber:`eigen texture {number}`,errorTimes:`error × 5`,greyLevels:`grey levels off`,photograph:`photograph`,noWebgl:`This needs WebGL 2, which this browser does not offer here. A current browser with its graphics acceleration switched on shows the scene.`,tiltDenied:`This browser does not tell the page how the device is held: allow it motion sensors.`,vrRefused:`The headset cannot show the scene: {reason}`,contextLost:`The graphics system took its memory back. Waiting until it can draw again …`,cannotOpen:`{name} cannot be opened: {reason}`,otherSite:`The scene could not be fetched from {site}. The address may be wrong, the network down, or that server lets no other page read its files (CORS). Download the file and drop it here.`,photographLost:"The photograph of {name} could not be loaded: is `eigenfield view` still running?",camerasDiffer:`The cameras of the two scenes differ: the eye has the same place on each array.`,byDrag:`Drag · one finger`,byFinger:`One finger`,byArrows:`Arrow keys · W A S D`,byWheel:`Wheel · pinch · Q E`,byPinch:`Pinch`,byShiftWheel:`Shift + wheel · R F`,byRightDrag:`Right drag · two fingers`,byTwoFingers:`Two fingers`,byDoubleClick:`Double click`,byDoubleTap:`Double tap`,byMap:`Map`,byTilt:`Tilt button`,byGamepad:`Gamepad`,byHeadset:`Headset`,doesMove:`move the head within the captured array; around a point in orbit`,doesSteps:`the same, step by step`,doesZoom:`smaller, larger`,doesDolly:`forward and back, off the view plane`,doesShift:`in orbit: shift`,doesTurnAbout:`in orbit: turn about that point of the surface`,doesMap:`go to that place; dots are cameras`,doesOrbit:`orbit, and back to the view plane`,doesCameras:`previous, next captured camera`,doesNearest:`the captured camera nearest to the eye`,doesFlip:`flip between drawn view and photograph`,doesPlay:`of a clip: play or pause, one frame back, one frame on`,doesSound:`of a clip: sound on or off`,doesSpeed:`of a clip: slower, faster`,doesDivide:`drawing and photograph side by side`,doesViews:`picture, mean only, single eigen texture, error × 5`,doesCount:`fewer, more eigen textures`,doesWeights:`weights for each ray, or for the eye`,doesWireframe:`wireframe`,doesHome:`the first view`,doesBack:`back inside the captured views`,doesSave:`save the picture`,doesTilt:`move by tilting the device`,doesPanel:`show or hide the panel`,doesHelp:`this list`,doesGamepad:`sticks move; bumpers change camera; A flips; B goes home`,doesGamepadClip:`of a clip: A plays or pauses; the cross steps; triggers go a second back or on`,doesHeadset:`of a clip: trigger plays or pauses; grip left or right: a second back or on`,close:`Close`,about:`{program}. Files stay on this device: the page sends nothing.`,panelLabel:`Controls and information`,show:`Show`,showPicture:`Picture`,showMean:`Mean`,showEigen:`Eigen`,showError:`Error ×5`,eigenTexture:`Eigen texture`,eigenTextures:`Eigen textures`,noEigenTextures:`The file has no eigen textures.`,capturedCamera:`Captured camera`,freeView:`free view`,previousCamera:`Previous camera`,nextCamera:`Next camera`,nearestCamera:`Nearest camera`,heldOut:`held out`,heldOutNote:`{count} held out: the encoder never saw it.|{count} held out: the encoder never saw them.`,showPhotograph:`Show the photograph`,showDrawing:`Photograph – show the drawing`,divider:`Drawing beside photograph`,dividerScenes:`Line between the two scenes`,toCompare:`To compare:`,noPhotographs:`The photographs are not here. With the capture: eigenfield view scene.glb CAPTURE`,noPlane:`The cameras stand around the object: there is no plane that they look across.`,noGrid:`The cameras form no grid.`,move:`Move`,onPlane:`On the view plane`,drawing:`Drawing`,weightsOffPlane:`Weights off the plane`,eachRay:`Each ray`,theEye:`The eye`,betweenCameras:`Between cameras`,nearestThree:`Nearest 3`,delaunay:`Delaunay`,texels:`Texels`,bilinear:`Bilinear`,bicubic:`Bicubic`,background:`Background`,black:`black`,dark:`dark`,grey:`grey`,white:`white`,wireframe:`Wireframe`,plainGltf:`A plain glTF file: no eigen textures.`,plainGltfShown:`It is shown as it is.`,inFull:`Drawn in full`,inFullNear:`Drawn in full, nearest camera {name}`,rate:`{rate} frames per second`,rateCoarser:`{rate} frames per second, coarser until it rests`,rateLinear:`{rate} frames per second, linear until it rests`,frame:`frame`,group:`group`,leftOut:`frames left out`,shownHere:`shown here`,shownBits:`8 of 10 bits`,shownMeans:`no eigen textures while it plays: decoding is too slow here`,shownKeys:`key pictures: this browser decodes no AV1 videos of 10 bits`,shownInsecure:`key pictures: browsers play clips from https and localhost alone`,aboutFile:`About this file`,quality:`Quality, as measured on the photographs`,encodedViews:`encoded views`,heldOutViews:`held-out views`,betweenViews:`between its views`,atLeastLuma:`at least {value} of luma`,aboutValue:`about {value}`,textureMaps:`texture maps`,ratio:`smaller than its photographs`,notMeasured:`not measured`,bytes:`Bytes`,file:`file`,mesh:`mesh`,opacity:`opacity`,countTextures:`{count} eigen texture|{count} eigen textures`,weights:`weights`,groups:`groups of frames`,rest:`calibration and the rest`,sceneFacts:`Scene`,cameras:`cameras`,countCameras:`{count} camera|{count} cameras`,countHeldOut:`{count} held out`,photographs:`photographs`,texelCount:`texels`,plane:`plane {number}`,channels:`{count} channel|{count} channels`,meanOf:`mean of {size}`,texturesOf:`{count} eigen texture of {size}|{count} eigen textures of {size}`,vertices:`vertices`,triangles:`triangles`,sheets:`sheets`,sheetsOver:`{count}, one over the other`,format:`format`,madeBy:`made by`,rights:`Rights`,title:`title`,author:`author`,licence:`licence`,source:`source`,here:`Here`,gpuMemory:`GPU memory`,eigenTexturesHere:`eigen textures`,howMade:`How it was made`},Tl={de:Cl,fr:{units:`o ko Mo Go`,outOf:`{part} sur {whole}`,keyHome:`Origine`,keySpace:`Espace`,keyEscape:`Échap`,canvas:`La scène\xA0: les flèches déplacent, H affiche toutes les commandes`,canvasPlain:`La scène : les flèches déplacent`,scene:`scène`,sceneFile:`Fichier de scène`,tools:`Outils`,firstView:`Première vue`,orbit:`Orbite`,tilt:`Se déplacer en inclinant l’appareil`,savePicture:`Enregistrer l’image`,share:`Copier un lien vers cette vue`,linkCopied:`Lien copié`,copyEmbed:`Copier le code d’intégration`,embedCopied:`Code d’intégration copié`,download:`Télécharger la scène`,draft:`Une ébauche. La scène elle-même suit.`,draftMinutes:`Une ébauche. La scène elle-même suit dans environ {minutes} min.`,draftLost:`Ceci est une ébauche : la commande qui produit la scène elle-même est terminée.`,openFile:`Ouvrir un fichier`,controls:`Commandes`,fullScreen:`Plein écran`,enterVr:`Passer en VR`,playback:`Lecture du clip`,play:`Lire`,pause:`Mettre en pause`,time:`Temps`,speed:`Vitesse`,sound:`Son`,noSound:`Ce navigateur ne peut pas lire le son.`,repeat:`Répéter`,panel:`Panneau`,laboratory:`Laboratoire`,map:`Plan des caméras de prise de vue avec la position de l’œil`,row:`Rangée {row} sur {rows}`,loading:`Chargement`,textureOf:`texture propre {part} sur {whole}`,dropHere:`Déposez un .glb ici ou choisissez un fichier`,chooseFile:`Choisir un fichier`,chooseAnother:`Choisir un autre fichier`,staysHere:`Rien n’est envoyé\xA0: le fichier reste sur cet appareil.`,samples:`Ou regardez l’une de celles-ci`,dropToOpen:`Déposez pour ouvrir`,dismiss:`Fermer`,outside:`Hors des vues enregistrées`,comeBack:`Revenir`,hint:`Faites glisser pour regarder autour`,drawn:`rendu`,mean:`moyenne`,eigenNumber:`texture propre {number}`,errorTimes:`erreur × 5`,greyLevels:`niveaux de gris d’écart`,photograph:`photo`,noWebgl:`Cette page a besoin de WebGL 2, que ce navigateur ne propose pas ici. Un navigateur à jour, avec l’accélération graphique activée, affiche la scène.`,tiltDenied:`Ce navigateur n’indique pas à la page comment l’appareil est tenu\xA0: autorisez-lui les capteurs de mouvement.`,vrRefused:`Le casque ne peut pas afficher la scène\xA0: {reason}`,contextLost:`Le système graphique a repris sa mémoire. En attente de pouvoir dessiner à nouveau…`,cannotOpen:`Impossible d’ouvrir {name}\xA0: {reason}`,otherSite:`La scène n’a pas pu être chargée depuis {site}. L’adresse est peut-être fausse, le réseau coupé, ou ce serveur interdit aux autres pages de lire ses fichiers (CORS). Téléchargez le fichier et déposez-le ici.`,photographLost:"La photo de {name} n’a pas pu être chargée\xA0: `eigenfield view` est-il toujours en marche ?",camerasDiffer:`Les caméras des deux scènes diffèrent : l’œil a la même place dans chaque réseau.`,byDrag:`Glisser · un doigt`,byFinger:`Un doigt`,byArrows:`Flèches · W A S D ou Z Q S D`,byWheel:`Molette · pincer · Q E ou A E`,byPinch:`Pincer`,byShiftWheel:`Maj + molette · R F`,byRightDrag:`Clic droit et glisser · deux doigts`,byTwoFingers:`Deux doigts`,byDoubleClick:`Double-clic`,byDoubleTap:`Toucher deux fois`,byMap:`Plan`,byTilt:`Bouton d’inclinaison`,byGamepad:`Manette`,byHeadset:`Casque VR`,doesMove:`déplacer la tête parmi les vues enregistrées ; en orbite, autour d’un point`,doesSteps:`la même chose, pas à pas`,doesZoom:`plus petit, plus grand`,doesDolly:`avancer et reculer, hors du plan des vues`,doesShift:`en orbite\xA0: décaler`,doesTurnAbout:`en orbite\xA0: tourner autour de ce point de la surface`,doesMap:`aller à cet endroit ; les points sont des caméras`,doesOrbit:`orbite, puis retour au plan des vues`,doesCameras:`caméra de prise de vue précédente, suivante`,doesNearest:`la caméra de prise de vue la plus proche de l’œil`,doesFlip:`alterner entre le rendu et la photo`,doesPlay:`pour un clip : lecture ou pause, une image en arrière, une image en avant`,doesSound:`pour un clip : son activé ou coupé`,doesSpeed:`pour un clip : plus lent, plus rapide`,doesDivide:`rendu et photo côte à côte`,doesViews:`image, moyenne seule, une texture propre, erreur × 5`,doesCount:`moins, plus de textures propres`,doesWeights:`poids par rayon ou pour l’œil`,doesWireframe:`maillage`,doesHome:`la première vue`,doesBack:`retour parmi les vues enregistrées`,doesSave:`enregistrer l’image`,doesTilt:`se déplacer en inclinant l’appareil`,doesPanel:`afficher ou masquer le panneau`,doesHelp:`cette liste`,doesGamepad:`les sticks déplacent ; les gâchettes hautes changent de caméra ; A alterne avec la photo ; B revient à la première vue`,doesGamepadClip:`pour un clip : A lit ou met en pause ; la croix avance image par image ; les gâchettes reculent ou avancent d'une seconde`,doesHeadset:`pour un clip : la gâchette lit ou met en pause ; la poignée gauche ou droite recule ou avance d'une seconde`,close:`Fermer`,about:`{program}. Les fichiers restent sur cet appareil\xA0: la page n’envoie rien.`,panelLabel:`Commandes et informations`,show:`Afficher`,showPicture:`Image`,showMean:`Moyenne`,showEigen:`Propre`,showError:`Erreur ×5`,eigenTexture:`Texture propre`,eigenTextures:`Textures propres`,noEigenTextures:`Le fichier n’a pas de textures propres.`,capturedCamera:`Caméra de prise de vue`,freeView:`vue libre`,previousCamera:`Caméra précédente`,nextCamera:`Caméra suivante`,nearestCamera:`Caméra la plus proche`,heldOut:`mise de côté`,heldOutNote:`{count} mise de côté\xA0: l’encodeur ne l’a jamais vue.|{count} mises de côté\xA0: l’encodeur ne les a jamais vues.`,showPhotograph:`Afficher la photo`,showDrawing:`Photo – afficher le rendu`,divider:`Rendu à côté de la photo`,dividerScenes:`Ligne entre les deux scènes`,toCompare:`Pour comparer\xA0:`,noPhotographs:`Les photos ne sont pas ici. Avec la prise de vue\xA0: eigenfield view scene.glb CAPTURE`,noPlane:`Les caméras entourent l’objet\xA0: il n’y a pas de plan d’où elles regardent toutes.`,noGrid:`Les caméras ne forment pas de grille.`,move:`Déplacement`,onPlane:`Dans le plan des vues`,drawing:`Rendu`,weightsOffPlane:`Poids hors du plan`,eachRay:`Par rayon`,theEye:`Pour l’œil`,betweenCameras:`Entre les caméras`,nearestThree:`3 plus proches`,delaunay:`Delaunay`,texels:`Texels`,bilinear:`Bilinéaire`,bicubic:`Bicubique`,background:`Arrière-plan`,black:`noir`,dark:`sombre`,grey:`gris`,white:`blanc`,wireframe:`Maillage`,plainGltf:`Un fichier glTF ordinaire, sans textures propres.`,plainGltfShown:`Il est affiché tel quel.`,inFull:`Rendu complet`,inFullNear:`Rendu complet, caméra la plus proche {name}`,rate:`{rate} images par seconde`,rateCoarser:`{rate} images par seconde, plus grossier jusqu’à l’arrêt`,rateLinear:`{rate} images par seconde, linéaire jusqu’à l’arrêt`,frame:`image`,group:`groupe`,leftOut:`images sautées`,shownHere:`affiché ici`,shownBits:`8 bits sur 10`,shownMeans:`pas de textures propres pendant la lecture : le décodage est trop lent ici`,shownKeys:`images clés : ce navigateur ne décode pas les vidéos AV1 de 10 bits`,shownInsecure:`images clés : les navigateurs ne lisent les clips que depuis https et localhost`,aboutFile:`À propos de ce fichier`,quality:`Qualité, mesurée sur les photos`,encodedViews:`vues encodées`,heldOutViews:`vues mises de côté`,betweenViews:`entre ses vues`,atLeastLuma:`au moins {value} en luminance`,aboutValue:`environ {value}`,textureMaps:`cartes de texture`,ratio:`plus petit que ses photos`,notMeasured:`non mesurée`,bytes:`Octets`,file:`fichier`,mesh:`maillage`,opacity:`opacité`,countTextures:`{count} texture propre|{count} textures propres`,weights:`poids`,groups:`groupes d’images`,rest:`calibrage et reste`,sceneFacts:`Scène`,cameras:`caméras`,countCameras:`{count} caméra|{count} caméras`,countHeldOut:`{count} mise de côté|{count} mises de côté`,photographs:`photos`,texelCount:`texels`,plane:`plan {number}`,channels:`{count} canal|{count} canaux`,meanOf:`moyenne de {size}`,texturesOf:`{count} texture propre de {size}|{count} textures propres de {size}`,vertices:`sommets`,triangles:`triangles`,sheets:`couches`,sheetsOver:`{count}, superposées`,format:`format`,madeBy:`créé par`,rights:`Droits`,title:`titre`,author:`auteur`,licence:`licence`,source:`source`,here:`Sur cet appareil`,gpuMemory:`mémoire GPU`,eigenTexturesHere:`textures propres`,howMade:`Comment il a été créé`,"plugin.not-glb":`Ce n’est pas un fichier .glb. Prenez-en un qu’eigenfield a écrit.`,"plugin.truncated":`Le fichier est incomplet. Téléchargez-le ou copiez-le à nouveau.`,"plugin.damaged":`Le fichier est endommagé. Créez-le ou téléchargez-le à nouveau.`,"plugin.version":`Cette visionneuse ne connaît pas la version du fichier. Utilisez-en une plus récente.`,"plugin.needs":`La scène a besoin d’une fonction que cette visionneuse n’a pas. Utilisez-en une plus récente.`,"plugin.unsupported":`Cette visionneuse ou cet appareil ne peut pas afficher ce fichier.`,"plugin.network":`La scène n’a pas pu être chargée. Vérifiez l’adresse et la connexion.`,"plugin.address":`Le fichier renvoie à un autre, qui n’est pas chargé. Exportez tout dans un seul fichier .glb.`,"plugin.codec":`Ce navigateur ne peut pas décoder les images de la scène. Utilisez-en un plus récent.`,"plugin.codec-unknown":`Le fichier utilise un codage que cette visionneuse ne connaît pas. Utilisez-en une plus récente.`,"plugin.limited":`La mémoire graphique ne suffit pas à tout : {what}.`,"plugin.limited.count":`{part} textures propres sur {whole} sont dessinées`,"plugin.limited.bits":`les textures propres ont 8 bits`,"plugin.limited.scale":`les textures propres ont {percent} % de leur largeur et de leur hauteur`,"plugin.limited.mean":`la texture moyenne a {percent} % de sa largeur et de sa hauteur`},ja:{units:`B kB MB GB`,outOf:`{part} / {whole}`,keyHome:`Home`,keySpace:`スペース`,keyEscape:`Esc`,canvas:`シーン：矢印キーで移動、Hで操作方法の一覧`,canvasPlain:`シーン：矢印キーで移動します`,scene:`シーン`,sceneFile:`シーンファイル`,tools:`ツール`,firstView:`最初の視点`,orbit:`周回`,tilt:`端末を傾けて移動`,savePicture:`画像を保存`,share:`この視点へのリンクをコピー`,linkCopied:`リンクをコピーしました`,copyEmbed:`埋め込みコードをコピー`,embedCopied:`埋め込みコードをコピーしました`,download:`シーンをダウンロード`,draft:`下書きです。本番のシーンはこの後に表示されます。`,draftMinutes:`下書きです。本番のシーンは約{minutes}分後に表示されます。`,draftLost:`これは下書きです。本番のシーンを作るコマンドは終了しました。`,openFile:`ファイルを開く`,controls:`操作方法`,fullScreen:`全画面表示`,enterVr:`VRで見る`,playback:`再生の操作`,play:`再生`,pause:`一時停止`,time:`時刻`,speed:`速度`,sound:`音声`,noSound:`このブラウザーでは音声を再生できません。`,repeat:`繰り返し`,panel:`パネル`,laboratory:`ラボ`,map:`撮影カメラと現在の視点の位置を示す地図`,row:`{rows}行中{row}行目`,loading:`読み込み中`,textureOf:`固有テクスチャ {part} / {whole}`,dropHere:`.glbファイルをここにドロップするか、選択してください`,chooseFile:`ファイルを選択`,chooseAnother:`別のファイルを選択`,staysHere:`アップロードは行われません。ファイルはこの端末から外に出ません。`,samples:`サンプルを見る`,dropToOpen:`ドロップして開く`,dismiss:`閉じる`,outside:`撮影範囲の外です`,comeBack:`戻る`,hint:`ドラッグして見回す`,drawn:`描画`,mean:`平均`,eigenNumber:`固有テクスチャ {number}`,errorTimes:`誤差 × 5`,greyLevels:`階調の差`,photograph:`写真`,noWebgl:`表示にはWebGL 2が必要ですが、このブラウザでは使えません。グラフィックアクセラレーションを有効にした最新のブラウザで開いてください。`,tiltDenied:`端末の傾きを取得できません。このページにモーションセンサーの使用を許可してください。`,vrRefused:`ヘッドセットでシーンを表示できません：{reason}`,contextLost:`グラフィックメモリが解放されました。描画できるようになるまでお待ちください…`,cannotOpen:`{name}を開けません：{reason}`,otherSite:`{site}からシーンを取得できませんでした。アドレスの誤り、ネットワークの切断、または他のページからの読み込みをサーバーが許可していないこと（CORS）が考えられます。ファイルをダウンロードして、ここにドロップしてください。`,photographLost:"{name}の写真を読み込めませんでした。`eigenfield view`はまだ動いていますか？",camerasDiffer:`二つのシーンのカメラは異なります。視点はそれぞれの配列の同じ位置にあります。`,byDrag:`ドラッグ · 1本指`,byFinger:`1本指`,byArrows:`矢印キー · W A S D`,byWheel:`ホイール · ピンチ · Q E`,byPinch:`ピンチ`,byShiftWheel:`Shift＋ホイール · R F`,byRightDrag:`右ドラッグ · 2本指`,byTwoFingers:`2本指`,byDoubleClick:`ダブルクリック`,byDoubleTap:`ダブルタップ`,byMap:`地図`,byTilt:`傾きボタン`,byGamepad:`ゲームパッド`,byHeadset:`ヘッドセット`,doesMove:`撮影したカメラ配列の範囲で視点を移動、周回では点のまわりを回転`,doesSteps:`同じ動きを少しずつ`,doesZoom:`縮小、拡大`,doesDolly:`前後に移動（視点平面から離れる）`,doesShift:`周回で：平行移動`,doesTurnAbout:`周回で：表面のその点を中心にする`,doesMap:`その位置へ移動（点はカメラ）`,doesOrbit:`周回に切り替え、視点平面に戻る`,doesCameras:`前、次の撮影カメラ`,doesNearest:`視点に最も近い撮影カメラ`,doesFlip:`描画と写真を切り替え`,doesPlay:`クリップ：再生・一時停止、1 フレーム戻る、1 フレーム進む`,doesSound:`クリップ：音声のオン・オフ`,doesSpeed:`クリップ：遅く、速く`,doesDivide:`描画と写真を並べて表示`,doesViews:`画像、平均のみ、固有テクスチャ1枚、誤差 × 5`,doesCount:`固有テクスチャを減らす、増やす`,doesWeights:`重みを光線ごと、または視点ごとに`,doesWireframe:`ワイヤーフレーム`,doesHome:`最初の視点`,doesBack:`撮影範囲に戻る`,doesSave:`画像を保存`,doesTilt:`端末を傾けて移動`,doesPanel:`パネルの表示を切り替え`,doesHelp:`この一覧`,doesGamepad:`スティックで移動、バンパーでカメラ変更、Aで写真と切り替え、Bで最初の視点`,doesGamepadClip:`クリップ：Aで再生・一時停止、十字キーで1フレームずつ、トリガーで1秒戻る・進む`,doesHeadset:`クリップ：トリガーで再生・一時停止、左右のグリップで1秒戻る・進む`,close:`閉じる`,about:`{program}。ファイルはこの端末から外に出ません。このページは何も送信しません。`,panelLabel:`操作と情報`,show:`表示`,showPicture:`画像`,showMean:`平均`,showEigen:`固有`,showError:`誤差×5`,eigenTexture:`固有テクスチャ`,eigenTextures:`固有テクスチャ数`,noEigenTextures:`このファイルには固有テクスチャがありません。`,capturedCamera:`撮影カメラ`,freeView:`自由視点`,previousCamera:`前のカメラ`,nextCamera:`次のカメラ`,nearestCamera:`最も近いカメラ`,heldOut:`評価用`,heldOutNote:`評価用{count}台：エンコーダーは見ていません。`,showPhotograph:`写真を表示`,showDrawing:`写真 – 描画を表示`,divider:`描画と写真を並べる`,dividerScenes:`二つのシーンの境界線`,toCompare:`比較するには：`,noPhotographs:`写真がありません。撮影データと一緒に開くには：eigenfield view scene.glb CAPTURE`,noPlane:`カメラが被写体を囲んでいるため、視点平面がありません。`,noGrid:`カメラが格子状に並んでいません。`,move:`移動`,onPlane:`視点平面上`,drawing:`描画`,weightsOffPlane:`平面外での重み`,eachRay:`光線ごと`,theEye:`視点ごと`,betweenCameras:`カメラ間の補間`,nearestThree:`近い3台`,delaunay:`ドロネー`,texels:`テクセル`,bilinear:`バイリニア`,bicubic:`バイキュービック`,background:`背景`,black:`黒`,dark:`暗`,grey:`灰`,white:`白`,wireframe:`ワイヤーフレーム`,plainGltf:`通常のglTFファイルです（固有テクスチャなし）。`,plainGltfShown:`そのまま表示しています。`,inFull:`フル画質で描画`,inFullNear:`フル画質で描画、最も近いカメラ {name}`,rate:`毎秒{rate}フレーム`,rateCoarser:`毎秒{rate}フレーム、静止するまで粗く描画`,rateLinear:`毎秒{rate}フレーム、静止するまで線形補間`,frame:`フレーム`,group:`グループ`,leftOut:`飛ばしたフレーム`,shownHere:`ここでの表示`,shownBits:`10ビットのうち8ビット`,shownMeans:`再生中は固有テクスチャなし：ここでは復号が間に合いません`,shownKeys:`キーフレームのみ：このブラウザは10ビットのAV1動画を復号できません`,shownInsecure:`キーフレームのみ：ブラウザはhttpsとlocalhostからのみクリップを再生します`,aboutFile:`このファイルについて`,quality:`品質（写真との比較）`,encodedViews:`エンコード対象`,heldOutViews:`評価用`,betweenViews:`視点の間`,atLeastLuma:`輝度で{value}以上`,aboutValue:`約{value}`,textureMaps:`テクスチャマップ`,ratio:`写真との容量比`,notMeasured:`未測定`,bytes:`バイト数`,file:`ファイル`,mesh:`メッシュ`,opacity:`不透明度`,countTextures:`固有テクスチャ{count}枚`,weights:`重み`,groups:`フレームのグループ`,rest:`校正など`,sceneFacts:`シーン`,cameras:`カメラ`,countCameras:`カメラ{count}台`,countHeldOut:`評価用{count}台`,photographs:`写真`,texelCount:`テクセル`,plane:`プレーン{number}`,channels:`{count}チャンネル`,meanOf:`平均 {size}`,texturesOf:`固有テクスチャ{count}枚 {size}`,vertices:`頂点`,triangles:`三角形`,sheets:`レイヤー`,sheetsOver:`{count}枚を重ねて描画`,format:`フォーマット`,madeBy:`作成ソフト`,rights:`権利`,title:`タイトル`,author:`作者`,licence:`ライセンス`,source:`出典`,here:`この端末`,gpuMemory:`GPUメモリ`,eigenTexturesHere:`固有テクスチャ`,howMade:`作成時の設定`,"plugin.not-glb":`.glbファイルではありません。eigenfieldで作成したファイルを選んでください。`,"plugin.truncated":`ファイルが途中で切れています。もう一度ダウンロードまたはコピーしてください。`,"plugin.damaged":`ファイルが壊れています。作成し直すか、もう一度ダウンロードしてください。`,"plugin.version":`このビューアーはファイルのバージョンに対応していません。新しいビューアーをお使いください。`,"plugin.needs":`このシーンに必要な機能がビューアーにありません。新しいビューアーをお使いください。`,"plugin.unsupported":`このビューアーまたは端末では、このファイルを描画できません。`,"plugin.network":`シーンを読み込めませんでした。アドレスと接続を確認してください。`,"plugin.address":`このファイルは別のファイルを参照していますが、それは読み込まれません。すべてを 1 つの .glb に書き出してください。`,"plugin.codec":`このブラウザではシーンの画像を復号できません。新しいブラウザをお使いください。`,"plugin.codec-unknown":`ファイルの符号化方式にビューアーが対応していません。新しいビューアーをお使いください。`,"plugin.limited":`グラフィックメモリが足りないため、次のように減らしています：{what}。`,"plugin.limited.count":`固有テクスチャは{whole}枚中{part}枚を描画`,"plugin.limited.bits":`固有テクスチャは8ビット`,"plugin.limited.scale":`固有テクスチャの幅と高さは{percent}%`,"plugin.limited.mean":`平均テクスチャの幅と高さは{percent}%`},zh:{units:`B kB MB GB`,outOf:`{part} / {whole}`,keyHome:`Home`,keySpace:`空格`,keyEscape:`Esc`,canvas:`场景：方向键移动，H 键列出全部操作`,canvasPlain:`场景：用方向键移动`,scene:`场景`,sceneFile:`场景文件`,tools:`工具`,firstView:`初始视图`,orbit:`环绕`,tilt:`倾斜设备来移动`,savePicture:`保存图像`,share:`复制此视图的链接`,linkCopied:`链接已复制`,copyEmbed:`复制嵌入代码`,embedCopied:`已复制嵌入代码`,download:`下载场景`,draft:`这是草稿，完整场景随后显示。`,draftMinutes:`这是草稿，完整场景将在约 {minutes} 分钟后显示。`,draftLost:`这是草稿：生成完整场景的命令已结束。`,openFile:`打开文件`,controls:`操作说明`,fullScreen:`全屏`,enterVr:`进入 VR`,playback:`播放控制`,play:`播放`,pause:`暂停`,time:`时间`,speed:`速度`,sound:`声音`,noSound:`此浏览器无法播放声音。`,repeat:`循环`,panel:`面板`,laboratory:`实验室`,map:`拍摄相机分布图，标有当前视点的位置`,row:`第 {row} 行，共 {rows} 行`,loading:`正在加载`,textureOf:`特征纹理 {part} / {whole}`,dropHere:`将 .glb 文件拖到这里，或选择文件`,chooseFile:`选择文件`,chooseAnother:`选择其他文件`,staysHere:`不会上传任何内容：文件只留在此设备上。`,samples:`或查看以下示例`,dropToOpen:`松开即可打开`,dismiss:`关闭`,outside:`已超出拍摄范围`,comeBack:`返回`,hint:`拖动即可环视`,drawn:`渲染图`,mean:`均值`,eigenNumber:`特征纹理 {number}`,errorTimes:`误差 × 5`,greyLevels:`灰度级误差`,photograph:`照片`,noWebgl:`此页面需要 WebGL 2，而当前浏览器未提供。请使用开启了图形加速的新版浏览器。`,tiltDenied:`浏览器没有提供设备的姿态：请允许此页面使用运动传感器。`,vrRefused:`头戴设备无法显示场景：{reason}`,contextLost:`图形系统收回了显存。正在等待恢复绘制…`,cannotOpen:`无法打开 {name}：{reason}`,otherSite:`无法从 {site} 获取场景。可能是地址有误、网络中断，或该服务器不允许其他页面读取其文件（CORS）。请下载文件后拖到这里。`,photographLost:"无法加载 {name} 的照片：`eigenfield view` 是否仍在运行？",camerasDiffer:`两个场景的相机不同：视点位于各自阵列中的相同位置。`,byDrag:`拖动 · 单指`,byFinger:`单指`,byArrows:`方向键 · W A S D`,byWheel:`滚轮 · 双指捏合 · Q E`,byPinch:`双指捏合`,byShiftWheel:`Shift + 滚轮 · R F`,byRightDrag:`右键拖动 · 双指`,byTwoFingers:`双指`,byDoubleClick:`双击`,byDoubleTap:`双击`,byMap:`分布图`,byTilt:`倾斜按钮`,byGamepad:`手柄`,byHeadset:`头戴设备`,doesMove:`在拍摄阵列范围内移动视点；环绕时绕一点旋转`,doesSteps:`同上，逐步移动`,doesZoom:`缩小、放大`,doesDolly:`前后移动，离开视点平面`,doesShift:`环绕时：平移`,doesTurnAbout:`环绕时：以表面上的该点为中心`,doesMap:`移到该处；圆点是相机`,doesOrbit:`切换环绕，再按返回视点平面`,doesCameras:`上一台、下一台拍摄相机`,doesNearest:`离视点最近的拍摄相机`,doesFlip:`在渲染图与照片之间切换`,doesPlay:`片段：播放或暂停，后退一帧，前进一帧`,doesSound:`片段：开启或关闭声音`,doesSpeed:`片段：减速，加速`,doesDivide:`渲染图与照片并排显示`,doesViews:`图像、仅均值、单个特征纹理、误差 × 5`,doesCount:`减少、增加特征纹理`,doesWeights:`按光线或按视点取权重`,doesWireframe:`线框`,doesHome:`初始视图`,doesBack:`回到拍摄范围内`,doesSave:`保存图像`,doesTilt:`倾斜设备来移动`,doesPanel:`显示或隐藏面板`,doesHelp:`本列表`,doesGamepad:`摇杆移动；肩键切换相机；A 切换照片；B 回到初始视图`,doesGamepadClip:`片段：A 播放或暂停；十字键逐帧；扳机后退或前进一秒`,doesHeadset:`片段：扳机播放或暂停；左右握键后退或前进一秒`,close:`关闭`,about:`{program}。文件只留在此设备上：此页面不发送任何内容。`,panelLabel:`控制与信息`,show:`显示`,showPicture:`图像`,showMean:`均值`,showEigen:`特征`,showError:`误差 ×5`,eigenTexture:`特征纹理`,eigenTextures:`特征纹理数`,noEigenTextures:`文件中没有特征纹理。`,capturedCamera:`拍摄相机`,freeView:`自由视角`,previousCamera:`上一台相机`,nextCamera:`下一台相机`,nearestCamera:`最近的相机`,heldOut:`留出`,heldOutNote:`留出 {count} 台：编码器从未见过。`,showPhotograph:`显示照片`,showDrawing:`照片 – 显示渲染图`,divider:`并排显示渲染图和照片`,dividerScenes:`两个场景之间的分隔线`,toCompare:`如需对比：`,noPhotographs:`这里没有照片。与拍摄数据一起打开：eigenfield view scene.glb CAPTURE`,noPlane:`相机环绕物体排列，不存在共同的视点平面。`,noGrid:`相机没有排成网格。`,move:`移动方式`,onPlane:`在视点平面上`,drawing:`渲染`,weightsOffPlane:`平面外的权重`,eachRay:`按光线`,theEye:`按视点`,betweenCameras:`相机之间`,nearestThree:`最近 3 台`,delaunay:`Delaunay`,texels:`纹素`,bilinear:`双线性`,bicubic:`双三次`,background:`背景`,black:`黑`,dark:`暗`,grey:`灰`,white:`白`,wireframe:`线框`,plainGltf:`普通的 glTF 文件，没有特征纹理。`,plainGltfShown:`按原样显示。`,inFull:`已完整绘制`,inFullNear:`已完整绘制，最近的相机 {name}`,rate:`每秒 {rate} 帧`,rateCoarser:`每秒 {rate} 帧，静止前较粗略`,rateLinear:`每秒 {rate} 帧，静止前用线性插值`,frame:`帧`,group:`组`,leftOut:`跳过的帧`,shownHere:`此处显示`,shownBits:`10 位中的 8 位`,shownMeans:`播放时不含特征纹理：此处解码过慢`,shownKeys:`仅关键帧：此浏览器无法解码 10 位 AV1 视频`,shownInsecure:`仅关键帧：浏览器只在 https 和 localhost 上播放片段`,aboutFile:`关于此文件`,quality:`质量（对照照片测得）`,encodedViews:`编码视图`,heldOutViews:`留出视图`,betweenViews:`视图之间`,atLeastLuma:`亮度至少 {value}`,aboutValue:`约 {value}`,textureMaps:`纹理贴图`,ratio:`比照片小`,notMeasured:`未测量`,bytes:`字节数`,file:`文件`,mesh:`网格`,opacity:`不透明度`,countTextures:`{count} 个特征纹理`,weights:`权重`,groups:`帧组`,rest:`标定及其他`,sceneFacts:`场景`,cameras:`相机`,countCameras:`{count} 台相机`,countHeldOut:`留出 {count} 台`,photographs:`照片`,texelCount:`纹素`,plane:`平面 {number}`,channels:`{count} 个通道`,meanOf:`均值 {size}`,texturesOf:`{count} 个特征纹理 {size}`,vertices:`顶点`,triangles:`三角形`,sheets:`层`,sheetsOver:`{count}，逐层叠加`,format:`格式`,madeBy:`生成程序`,rights:`权利`,title:`标题`,author:`作者`,licence:`许可`,source:`来源`,here:`此设备`,gpuMemory:`显存`,eigenTexturesHere:`特征纹理`,howMade:`生成参数`,"plugin.not-glb":`这不是 .glb 文件。请选择由 eigenfield 生成的文件。`,"plugin.truncated":`文件不完整。请重新下载或复制。`,"plugin.damaged":`文件已损坏。请重新生成或下载。`,"plugin.version":`此查看器不支持该文件的版本。请使用更新的查看器。`,"plugin.needs":`场景所需的功能此查看器尚不具备。请使用更新的查看器。`,"plugin.unsupported":`此查看器或设备无法绘制该文件。`,"plugin.network":`无法加载场景。请检查地址和网络连接。`,"plugin.address":`该文件引用了另一个文件，而后者不会被加载。请将所有内容导出为一个 .glb 文件。`,"plugin.codec":`此浏览器无法解码场景中的图像。请使用更新的浏览器。`,"plugin.codec-unknown":`文件使用了此查看器不认识的编码。请使用更新的查看器。`,"plugin.limited":`显存不足，已作如下缩减：{what}。`,"plugin.limited.count":`绘制 {whole} 个特征纹理中的 {part} 个`,"plugin.limited.bits":`特征纹理为 8 位`,"plugin.limited.scale":`特征纹理的宽和高为 {percent}%`,"plugin.limited.mean":`平均纹理的宽和高为 {percent}%`}},El={zh:`zh-Hans`},Dl=[new URLSearchParams(location.search).get(`lang`)??``,...navigator.languages].map(e=>e.toLowerCase().split(`-`)[0]??``).find(e=>e===`en`||Object.hasOwn(Tl,e))??`en`,Ol=Tl[Dl],kl=Ol??wl,Al=new Intl.PluralRules(Dl),jl=El[Dl]??Dl;function X(e,t={}){let[n=``,r=n]=kl[e].split(`|`);return Ml(Al.select(Number(t.count))===`one`?n:r,t)}function Ml(e,t){return e.replaceAll(/\{(\w+)\}/g,(e,n)=>String(t[n]))}var Nl=(e,t)=>Ol?.[`plugin.${e}`]??t;function Pl({limitation:e,reductions:t}){if(e===null||!Ol)return e;let n=t.map(e=>Ml(Ol[`plugin.limited.${e.kind}`],{...e}));return Ml(Ol[`plugin.limited`],{what:new Intl.ListFormat(Dl).format(n)})}function Fl(e){let[t,n,r,i]=X(`units`).split(` `);return e<1e3?`${e}\u00a0${t}`:e<999500?`${Il(e/1e3,+(e<99950))}\u00a0${n}`:e<9995e5?`${Il(e/1e6,2)}\u00a0${r}`:`${Il(e/1e9,2)}\u00a0${i}`}var Il=(e,t)=>e.toLocaleString(jl,{minimumFractionDigits:t,maximumFractionDigits:t,useGrouping:!1}),Ll=e=>e.toLocaleString(`en-GB`).replaceAll(`,`,` `);function Rl(e,...t){let n=t.reduce((e,t)=>typeof e==`object`&&e?e[t]:void 0,e);return typeof n==`number`&&Number.isFinite(n)?n:null}var zl=(e,t,n=``)=>e===null?`–`:`${Il(e,t)}${n}`;function Bl(e,t){let{total:n,textures:r}=e.bytes;return n-(e=>e.reduce((e,t)=>e+t,0))(r.slice(Math.min(t,r.length)))}function Vl(e,t){let{curve:n}=e.scores;if(Array.isArray(n)){let e=Rl(n.find(e=>Rl(e,`textures`)===t),`uv_ssim`);if(e!==null)return e}return Rl(e.scores,`textures`)===t?Rl(e.scores,`uv`,`ssim`):null}function Hl(e){return{get field(){return e.scene()?.field??null},state:()=>{let t=e.scene(),n=t?.field,r=e.captured(),i=n?.total??0,a=Math.min(e.options().count,i);return{...e.options(),count:a,status:e.status(),message:e.message(),title:t?.source.name??null,mode:e.modeName(),camera:r===null?null:n?.info.names[r]??null,photograph:e.photographShown(),...e.coordinates(),zoom:t?.plane?.at().zoom??1,dolly:t?.plane?.at().dolly??0,outside:e.outside(),frame:e.frame(),detail:e.detail(),frames:e.drawn(),loaded:n?.loaded??0,total:i,bytes:n?Bl(n.info,e.summed()):null,uvSsim:n?Vl(n.info,e.summed()):null,time:n?.player?.time??null,playing:n?.player?.playing??!1}},goTo:e.goTo,goToCamera:t=>{let n=e.scene()?.field?.info.names.indexOf(t)??-1;return n<0?!1:(e.toCamera(n),!0)},set:({mode:t,photograph:n,...r})=>{t!==void 0&&e.setMode(t),e.set(r),n!==void 0&&e.showPhotograph(n)},open:(t,n=X(`scene`))=>e.open({name:n,from:t,bytes:typeof t==`string`?null:t.size,own:!1}),settled:e.settled,pixels:()=>(e.drawNow(),e.stage.pixels()),eyes:()=>{let t=e.scene()?.field?.mesh,{renderer:n,camera:r}=e.stage,i=n.xr.isPresenting?n.xr.getCamera().cameras:[r];return t?i.map(e=>t.worldToLocal(new W().setFromMatrixPosition(e.matrixWorld)).toArray()):[]}}}function Z(e,t={},...n){let r=document.createElement(e);for(let[e,n]of Object.entries(t))r.setAttribute(e,n);return r.append(...n),r}function Ul(e){let t=`http://www.w3.org/2000/svg`,n=document.createElementNS(t,`svg`);n.setAttribute(`viewBox`,`0 0 24 24`),n.setAttribute(`aria-hidden`,`true`);let r=document.createElementNS(t,`path`);return r.setAttribute(`d`,e),n.append(r),n}function Wl(e,t,n,r){let i=Z(`button`,{type:`button`,class:`icon`,"aria-label":e,title:e},Ul(t));return r!==void 0&&i.append(Gl(r)),i.addEventListener(`click`,n),i}var Gl=e=>Z(`kbd`,{"aria-hidden":`true`},e),Kl={home:`M4 11.5 12 5l8 6.5M6.5 10v9h11v-9M10 19v-5h4v5`,orbit:`M12 10a2 2 0 1 0 0 4 2 2 0 0 0 0-4ZM19.5 8.5a8.5 8.5 0 0 0-15 0M4.5 15.5a8.5 8.5 0 0 0 15 0M19.5 4v4.5H15`,tilt:`M8 3.5h8v17H8zM3 9l-1 3 1 3M21 9l1 3-1 3M11 17.5h2`,camera:`M4 8h3.5L9 5.5h6L16.5 8H20v11H4zM12 10a3.2 3.2 0 1 0 0 6.4 3.2 3.2 0 0 0 0-6.4Z`,headset:`M3 8h18v9h-6l-2-2.5h-2L9 17H3zM7.5 11v2.5M16.5 11v2.5`,open:`M4 19V6h6l2 2.5h8V19zM12 17v-5M9.8 14 12 11.8l2.2 2.2`,help:`M12 3.5a8.5 8.5 0 1 0 0 17 8.5 8.5 0 0 0 0-17ZM9.6 9.6c0-3.2 5-3.2 5 0 0 2-2.6 2.1-2.6 4.1M12 16.4v.4`,panel:`M4 7h10M18 7h2M14 5v4h4V5zM4 17h2M10 17h10M6 15v4h4v-4z`,nearest:`M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8ZM12 3v3M12 18v3M3 12h3M18 12h3`,previous:`M14.5 6 8.5 12l6 6`,next:`M9.5 6l6 6-6 6`,fullscreen:`M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5`,share:`M12 4v11M8 8l4-4 4 4M6 12H4.5v8h15v-8H18`,embed:`M8.5 7.5 4 12l4.5 4.5M15.5 7.5 20 12l-4.5 4.5M13.5 6l-3 12`,download:`M12 4v11M8 11l4 4 4-4M5 19.5h14`,info:`M12 3.5a8.5 8.5 0 1 0 0 17 8.5 8.5 0 0 0 0-17ZM12 11v5.5M12 7.6v.4`,close:`M6 6l12 12M18 6 6 18`,play:`M8 5.5v13l10.5-6.5z`,pause:`M8.5 6v12M15.5 6v12`,sound:`M4 9.5v5h3.5l4.5 4v-13l-4.5 4zM15.5 9.5a4 4 0 0 1 0 5M18 7a8 8 0 0 1 0 10`,muted:`M4 9.5v5h3.5l4.5 4v-13l-4.5 4zM15.5 9.5l5 5M20.5 9.5l-5 5`,loop:`M5 12V9.5A3 3 0 0 1 8 6.5h10.5L16 4M19 12v2.5a3 3 0 0 1-3 3H5.5L8 20`},ql={left:0,top:0,width:1,height:1},Jl=()=>matchMedia(`(prefers-reduced-motion: reduce)`).matches;function Yl(e,t,n,r,i){return Jl()||Math.abs(t-e)<i?t:t+(e-t)*Math.exp(-n/r)}var Xl=e=>e<1&&matchMedia(`(pointer: coarse)`).matches,Zl=(e,t,n)=>Math.min(Math.max(e,t),n),Ql=132,$l=96,eu=`(max-width: 720px)`,tu=44;function nu(e){let t=Z(`canvas`),n=Z(`div`,{class:`map`,role:`img`,"aria-label":X(`map`)},t),r={width:Ql,height:Ql},i=null,a=``,o=()=>{let t=e.scene()?.field?.info.viewPlane.extent??[1,1],n=matchMedia(eu).matches?$l:Ql,i=Math.max(...t,1e-12);r.width=Math.max(tu,t[0]/i*(n-24)+24),r.height=Math.max(tu,t[1]/i*(n-24)+24)},s=(e,t)=>[r.width/2+e*(r.width-24)/2,r.height/2-t*(r.height-24)/2],c=()=>{let n=e.scene()?.field?.info;if(!n)return;let c=e.coordinates(),l=e.captured(),u=Math.min(devicePixelRatio,2),d=[c.x.toFixed(3),c.y.toFixed(3),l,u].join();if(n!==i&&(a=``),i=n,d===a)return;a=d,o(),t.width=Math.round(r.width*u),t.height=Math.round(r.height*u),t.style.width=`${r.width}px`,t.style.height=`${r.height}px`;let f=t.getContext(`2d`);if(!f)return;f.scale(u,u);let{origin:p,right:m,up:h,extent:g}=n.viewPlane,_=n.cameras.length>150?1.3:2;n.cameras.forEach((e,t)=>{let r=e.centre.map((e,t)=>e-(p[t]??0)),i=(e,t)=>t>0?e.reduce((e,t,n)=>e+t*(r[n]??0),0)/t:0,[a,o]=s(i(m,g[0]),i(h,g[1]));f.fillStyle=n.heldOut[t]===!0?`#e5a14b`:`#b4bac3`,f.beginPath(),f.arc(a,o,t===l?_+1.5:_,0,2*Math.PI),f.fill()});let[v,y]=s(c.x,c.y),[b,x]=[Zl(v,7,r.width-7),Zl(y,7,r.height-7)];f.beginPath(),f.arc(b,x,5,0,2*Math.PI),f.strokeStyle=`#10131a`,f.lineWidth=4,f.stroke(),f.strokeStyle=`#6cb2ff`,f.lineWidth=2,f.stroke()},l=n=>{let i=t.getBoundingClientRect(),a=(n.clientX-i.left-r.width/2)/(r.width-24)*2,o=(n.clientY-i.top-r.height/2)/(r.height-24)*-2;e.goTo(Zl(a,-1,1),Zl(o,-1,1))};return t.addEventListener(`pointerdown`,e=>{t.setPointerCapture(e.pointerId),l(e)}),t.addEventListener(`pointermove`,e=>{t.hasPointerCapture(e.pointerId)&&l(e)}),{root:n,update:()=>{n.hidden=!e.scene()?.field,c()}}}var ru=[`picture`,`mean`,`eigen`,`error`],iu=[`delaunay`,`bilinear`,`nearest3`],au=[`#000000`,`#15171a`,`#6b6f76`,`#ffffff`],ou={view:`picture`,eigen:0,count:1/0,weights:`ray`,mixing:`delaunay`,filter:`bicubic`,wireframe:!1,divider:null,background:`#15171a`},su=(e,t)=>e.find(e=>e===t),cu=[`none`,`plain`,`full`];function lu(e,t){let n=mu(e.getElementById(`eigenfield-config`)?.textContent??`{}`),r=e=>{let t=n[e];return typeof t==`string`&&t!==``?t:null},i=e=>{let t=n[e];return typeof t==`number`&&Number.isFinite(t)&&t>0?t:null},a=r(`url`),o=n.photographs,[s,c]=(Array.isArray(n.start)?n.start:[]).map(e=>typeof e==`number`&&Math.abs(e)<=1?e:void 0),l=Array.isArray(n.samples)?n.samples:[],u=t.searchParams.get(`ui`),d=su(cu,u===`0`?`none`:u),f=su(cu,n.ui)??`full`,p=Number(t.searchParams.get(`memory`));return{title:r(`title`),scene:r(`scene`),bytes:i(`bytes`),url:a!==null&&pu(a)?a:null,embedded:n.embedded===!0,photographs:new Map(hu(o)?Object.entries(o).filter(e=>typeof e[1]==`string`):[]),metresPerUnit:i(`metresPerUnit`),version:r(`version`),start:s===void 0||c===void 0?null:{x:s,y:c},ui:d??f,laboratory:f===`full`||d===`full`,poster:t.searchParams.get(`poster`),ownView:t.hash.length<2,samples:l.filter(hu).flatMap(({name:e,url:t,bytes:n,picture:r})=>typeof e==`string`&&typeof t==`string`?[{name:e,url:t,bytes:typeof n==`number`?n:null,picture:typeof r==`string`?r:null}]:[]),beside:uu(n.beside),draft:r(`draft`),download:n.download!==!1,worker:r(`worker`),memory:p>0&&Number.isFinite(p)?p*1e6:null}}function uu(e){if(!hu(e))return null;let{names:t,scene:n,bytes:r}=e,[i,a]=Array.isArray(t)?t:[];return typeof i!=`string`||typeof a!=`string`?null:{names:[i,a],scene:typeof n==`string`?n:null,bytes:typeof r==`number`?r:null}}function du(e,t=`eigenfield-scene`){let n=e.getElementById(t)?.textContent?.trim();return n?fu(n):null}function fu(e){let t=[],n=1<<20;for(let r=0;r<e.length;r+=n){let i=atob(e.slice(r,r+n)),a=new Uint8Array(i.length);for(let e=0;e<i.length;e++)a[e]=i.charCodeAt(e);t.push(a)}return new Blob(t)}var pu=e=>/^https?:/i.test(e)&&URL.canParse(e);function mu(e){try{let t=JSON.parse(e);return hu(t)?t:{}}catch{return{}}}function hu(e){return typeof e==`object`&&!!e&&!Array.isArray(e)}function gu(e){let t=Z(`div`,{class:`facts`});return{root:t,update:()=>{let n=e.scene(),r=n?.field;if(!n)return t.replaceChildren();if(!r)return t.replaceChildren(Z(`p`,{},n.lacks??`${X(`plainGltf`)} ${X(`plainGltfShown`)}`));let i=Pl(r);t.replaceChildren(...xu(X(`quality`),Ou(r.info)),...xu(X(`bytes`),ku(r.info)),...xu(X(`sceneFacts`),Au(r.info)),...xu(X(`rights`),wu(r.info)),...xu(X(`here`),[[X(`gpuMemory`),Fl(r.gpuBytes)],[X(`eigenTexturesHere`),X(`outOf`,{part:r.loaded,whole:r.total})]]),...i===null?[]:[Z(`p`,{class:`warning`},i)],...Mu(r))}}}function _u({info:e,gpuBytes:t,player:n}){return Su([...Eu(e),[X(`gpuMemory`),Fl(t)],...n?bu(n):[]])}function vu(e){let t=e.scores,[n,r]=[Rl(t,`image`,`encoded`,`psnr`),Rl(t,`between`,`psnr`)],i=n===null?[]:[zl(n,1,`\xA0dB`)];return n===null&&r!==null&&i.push(X(`aboutValue`,{value:zl(r,1,`\xA0dB`)})),[Fl(e.bytes.total),...i].join(` · `)}function yu(e){return X(e===`bits`?`shownBits`:e===`textures`?`shownMeans`:globalThis.isSecureContext?`shownKeys`:`shownInsecure`)}function bu({frame:e,frames:t,rate:n,group:r,late:i,fallbacks:a}){let o=(e,t)=>X(`outOf`,{part:e+1,whole:t});return[[X(`frame`),`${o(e,t)}\u00a0· ${zl(n,Number.isInteger(n)?0:2)}\u00a0Hz`],[X(`group`),`${o(r.index,r.count)}\u00a0· ${Fl(r.bytes)}`],[X(`leftOut`),Ll(i)],...a.length?[[X(`shownHere`),a.map(yu).join(`; `)]]:[]]}function xu(e,t){return t.length===0?[]:[Z(`h3`,{},e),Su(t)]}function Su(e){return Z(`table`,{},...e.map(([e,t])=>Z(`tr`,{},Z(`th`,{scope:`row`},e),Z(`td`,{},Cu(t)))))}function Cu(e){return pu(e)?Z(`a`,{href:e,target:`_blank`,rel:`noopener noreferrer`},e):e}function wu({rights:{title:e,author:t,licence:n,source:r}}){return[[X(`title`),e],[X(`author`),t],[X(`licence`),n],[X(`source`),r]].filter(([,e])=>e!==``)}function Tu({scores:e},t,...n){let[r,i]=[Rl(e,...n,`psnr`),Rl(e,...n,`ssim`)];if(r===null&&i===null)return[];let a=i===null?``:`\u00a0· SSIM\u00a0${zl(i,4)}`;return[[t,`${zl(r,2,`\xA0dB`)}${a}`]]}var Eu=e=>[...Tu(e,X(`encodedViews`),`image`,`encoded`),...Tu(e,X(`heldOutViews`),`image`,`held_out`),...Du(e)];function Du({scores:e}){let[t,n]=[Rl(e,`between`,`psnr_luma_at_least`),Rl(e,`between`,`psnr`)],r=zl(t??n,1,`\xA0dB`);return t===null&&n===null?[]:[[X(`betweenViews`),X(t===null?`aboutValue`:`atLeastLuma`,{value:r})]]}function Ou(e){let t=[...Tu(e,X(`textureMaps`),`uv`),...Eu(e)],n=Rl(e.scores,`ratio`,`photographs`);return n!==null&&t.push([X(`ratio`),`${zl(n,1)} ×`]),t.length>0?t:[[X(`notMeasured`),`eigenfield evaluate --store`]]}function ku({bytes:e}){let t=e.textures.reduce((e,t)=>e+t,0),n=[[X(`mean`),Fl(e.mean)],[X(`countTextures`,{count:e.textures.length}),Fl(t)],[X(`weights`),Fl(e.weights)]];return[[X(`file`),Fl(e.total)],[X(`mesh`),Fl(e.mesh)],...e.opacity?[[X(`opacity`),Fl(e.opacity)]]:[],...e.groups?[[X(`groups`),Fl(e.groups)]]:n,[X(`rest`),Fl(e.other)]]}function Au(e){let t=e.heldOut.filter(Boolean).length,n=t>0?[X(`countHeldOut`,{count:t})]:[],r=e.grid?` (${e.grid.columns} × ${e.grid.rows})`:``,i=e.cameras[e.reference];return[[X(`cameras`),[`${e.cameras.length}${r}`,...n].join(`, `)],...i?[[X(`photographs`),`${i.width} × ${i.height}`]]:[],[X(`texelCount`),`${e.size[0]} × ${e.size[1]}`],...e.planes.length>1?e.planes.map(ju):[],[X(`vertices`),Ll(e.vertices)],[X(`triangles`),Ll(e.triangles)],...e.sheets?[[X(`sheets`),X(`sheetsOver`,{count:e.sheets})]]:[],[X(`format`),e.version],...e.generator===``?[]:[[X(`madeBy`),e.generator]]]}function ju({channels:e,mean:t,bases:n},r){let i=([e,t])=>`${e} × ${t}`,a=n.map(({textures:e,size:t})=>X(`texturesOf`,{count:e,size:i(t)})),o=[X(`channels`,{count:e}),X(`meanOf`,{size:i(t)}),...a];return[X(`plane`,{number:r+1}),o.join(`, `)]}function Mu({info:e}){let t=Object.entries(e.settings).filter(([,e])=>e!==null);if(t.length===0)return[];let n=e=>typeof e==`string`?e:JSON.stringify(e),r=t.map(([e,t])=>[e,n(t)]);return[Z(`details`,{},Z(`summary`,{},X(`howMade`)),...xu(``,r).slice(1))]}function Nu(e){let t=Z(`p`,{class:`compared left`,hidden:``}),n=Z(`p`,{class:`compared right`,hidden:``}),r=(e,t,n)=>{let[r,i]=[Z(`strong`,{},t),Z(`span`,{},n?vu(n.info):``)];e.replaceChildren(r,i)};return{roots:[t,n],update:()=>{let[i,a]=[e.scene(),e.beside()],o=e.config.beside?.names;for(let e of[t,n])e.hidden=!a?.scene||!i||!o;a?.scene&&i&&o&&(r(t,o[0],i.field),r(n,o[1],a.scene.field))}}}var Pu=`connect-src 'self' blob: data:`,Fu=`img-src 'self' blob: data:`,Iu=/^https?:\/\/[\w.-]+(:\d+)?$/;function Lu(e,t=``){let n=e.querySelectorAll(`meta[http-equiv="Content-Security-Policy"]`);if(n.length===0||[...n].some(({content:e})=>e.startsWith(Pu)))return;let r=e.createElement(`meta`);r.httpEquiv=`Content-Security-Policy`;let{origin:i=``}=typeof t==`string`&&zu(t)||{};r.content=`${Pu}${Iu.test(i)?` ${i}`:``}; ${Fu}`,e.head.append(r)}function Ru(e){return e.some(e=>(zu(e??``)??location).origin!==location.origin)}function zu(e){try{return new URL(e,location.href)}catch{return null}}var Bu=.02;function Vu(e){let t=Z(`div`,{class:`divider`,role:`slider`,tabindex:`0`,hidden:``,"aria-valuemin":`0`,"aria-valuemax":`100`}),n=t=>e.set({divider:Zl(t,0,1)});return t.addEventListener(`pointerdown`,e=>t.setPointerCapture(e.pointerId)),t.addEventListener(`pointermove`,r=>{let i=t.parentElement?.getBoundingClientRect();if(!i||!t.hasPointerCapture(r.pointerId))return;let{left:a,width:o}=e.frame();n(((r.clientX-i.left)/i.width-a)/o)}),t.addEventListener(`keydown`,({key:t})=>{let{divider:r}=e.options(),i={ArrowLeft:-.02,ArrowRight:Bu}[t];i!==void 0&&r!==null&&n(r+i)}),{root:t,tick:()=>{let{divider:n}=e.options(),r=e.beside()!==null&&!e.photographShown();if(t.hidden=n===null||!(e.photographShown()||e.beside()?.scene),t.classList.toggle(`scenes`,r),t.setAttribute(`aria-label`,X(r?`dividerScenes`:`divider`)),n===null)return;let{left:i,top:a,width:o,height:s}=e.frame(),c=e=>`${(100*e).toFixed(3)}%`;Object.assign(t.style,{left:c(i+n*o),top:c(a),height:c(s)}),t.setAttribute(`aria-valuenow`,(100*n).toFixed(0))}}}var Hu=1e4;function Uu({name:e,from:t}){Wu(t,`${e.replaceAll(/[^\p{L}\p{N}._+-]+/gu,`-`).slice(0,100)||`scene`}.glb`)}function Wu(e,t){let n=typeof e==`string`?e:URL.createObjectURL(e);Z(`a`,{href:n,download:t}).click(),e instanceof Blob&&setTimeout(()=>URL.revokeObjectURL(n),Hu)}var Gu=300,Ku=1e9;function qu(e){let t=null,n=location.hash,r=null,i=()=>{if(t=null,e.scene()?.source!==r||e.status()!==`ready`||e.untouched())return;let i=Xu(e);if(location.hash===n&&i!==n)try{history.replaceState(history.state,``,i),n=location.hash}catch{}};e.onDraw(()=>{t??=window.setTimeout(i,Gu)}),e.onChange(()=>{let t=e.scene();if(!t||t.source===r)return;let i=r===null;r=t.source,i&&Zu(e,n)}),addEventListener(`hashchange`,()=>{location.hash!==n&&Zu(e,n=location.hash)})}var Ju=e=>String(Number(e.toFixed(4))),Yu=e=>e.toArray().map(e=>Number(e.toPrecision(5))).join();function Xu(e){let{scene:t,options:n}={scene:e.scene(),options:e.options()},r=new URLSearchParams,i=e.captured(),a=i===null?void 0:t?.field?.info.names[i];if(a!==void 0)r.set(`camera`,a);else if(e.modeName()===`plane`&&t?.plane){let{x:e,y:n,zoom:i,dolly:a}=t.plane.at();r.set(`x`,Ju(e)),r.set(`y`,Ju(n)),i!==1&&r.set(`zoom`,Ju(i)),a!==0&&r.set(`dolly`,Ju(a))}else if(t){let{eye:e,target:n}=t.orbit.pose();r.set(`eye`,Yu(e)),r.set(`at`,Yu(n))}let o=e.player();return o&&!o.playing&&r.set(`t`,Ju(o.time)),t?.plane&&r.set(`mode`,e.modeName()),e.photographShown()&&r.set(`photograph`,`1`),(e.photographShown()||e.beside()!==null)&&n.divider!==null&&r.set(`divider`,Ju(n.divider)),Number.isFinite(n.count)&&r.set(`n`,String(n.count)),n.view!==`picture`&&r.set(`view`,n.view),n.view===`eigen`&&r.set(`eigen`,String(n.eigen+1)),n.weights!==`ray`&&r.set(`weights`,n.weights),n.mixing!==`delaunay`&&r.set(`mixing`,n.mixing),n.wireframe&&r.set(`wireframe`,`1`),`#${r.toString().replaceAll(`%2C`,`,`)}`}function Zu(e,t){let n=e.scene();if(!n||t.length<2)return;let r=new URLSearchParams(t.slice(1)),i=e=>{let t=r.get(e);return t===null||t.trim()===``||!Number.isFinite(Number(t))?null:Number(t)},a=e=>{let t=(r.get(e)??``).split(`,`).map(Number),[n,i,a]=t;return n===void 0||i===void 0||a===void 0||!t.every(e=>Math.abs(e)<=Ku)?null:new W(n,i,a)},o=su([`plane`,`orbit`],r.get(`mode`)),[s,c]=[i(`x`),i(`y`)];n.plane&&(s!==null||c!==null)&&(e.goTo(s??0,c??0),n.plane.setZoom(i(`zoom`)??1),n.plane.setDolly(i(`dolly`)??0),n.plane.step(10));let[l,u]=[a(`eye`),a(`at`)];o&&e.setMode(o),l&&u&&(e.setMode(`orbit`),n.orbit.set(l,u));let d=n.field?.info.names.indexOf(r.get(`camera`)??``)??-1;d>=0&&e.toCamera(d);let[f,p]=[e.player(),i(`t`)];f&&p!==null&&(f.pause(),f.seek(p)),e.set({count:i(`n`)??1/0,eigen:(i(`eigen`)??1)-1,weights:su([`ray`,`eye`],r.get(`weights`))??`ray`,mixing:su(iu,r.get(`mixing`))??`delaunay`,wireframe:r.get(`wireframe`)===`1`,view:su(ru,r.get(`view`))??`picture`});let m=i(`divider`);m===null?r.get(`photograph`)===`1`&&e.showPhotograph(!0):e.set({divider:m})}var Qu=2e3;function $u(e,t){let n=Z(`p`,{class:`draft`,role:`status`,hidden:``}),r=e.config.draft;if(r===null)return n;let i=e=>{n.textContent!==e&&(n.textContent=e),n.hidden=!1},a=async()=>{let n=await fetch(r,{cache:`no-store`}).catch(()=>null);if(n===null)i(X(`draftLost`));else if(n.status===404&&!t())ed(e);else{if(n.ok){let{seconds:e}=await n.json();i(e===null?X(`draft`):X(`draftMinutes`,{minutes:Math.max(1,Math.ceil(e/60))}))}window.setTimeout(()=>void a(),Qu)}};return a(),n}function ed(e){if(!e.untouched()){let t=new URLSearchParams({camera:e.nearestName()??``,mode:e.modeName()});history.replaceState(history.state,``,e.modeName()===`plane`?Xu(e):`#${t}`)}location.reload()}function td(e,t,n){let r=e.title??X(`scene`);if(e.embedded){let e=du(t);if(e)return{name:r,from:e,bytes:e.size,own:!0}}if(e.scene!==null)return{name:r,from:e.scene,bytes:e.bytes,own:!0};let i=n.searchParams.get(`load`);return i!==null&&i!==``?{name:ad(i),from:i,bytes:null,own:!1}:null}function nd({beside:e},t){let n=e&&(e.scene??du(t,`eigenfield-beside`));return e&&n?{name:e.names[1],from:n,bytes:e.bytes,own:!0}:null}function rd(e){return{name:od(e.name),from:e,bytes:e.size,own:!1}}function id(e,t){let n=t.get(`scene.glb`)??t.values().next().value;return n?{...rd(n),...n.name===`scene.glb`&&{name:e},files:t}:null}function ad(e){let t=e.split(/[?#]/)[0]?.split(`/`).pop()??``;try{return od(decodeURIComponent(t))||X(`scene`)}catch{return od(t)||X(`scene`)}}var od=e=>e.replace(/\.(glb|gltf)$/i,``);function sd(e,t){let n=t=>e(rd(t)),r=Z(`input`,{type:`file`,accept:`.glb,model/gltf-binary`,hidden:``,"aria-label":X(`sceneFile`)});r.addEventListener(`change`,()=>{let e=r.files?.[0];r.value=``,e&&n(e)});let i=0,a=()=>{i=0,t(!1)};addEventListener(`dragenter`,e=>{e.dataTransfer?.types.includes(`Files`)&&(e.preventDefault(),i++,t(!0))}),addEventListener(`dragleave`,()=>{i>0&&--i===0&&a()}),addEventListener(`dragover`,e=>e.preventDefault()),addEventListener(`drop`,e=>{e.preventDefault(),a();let[t,r]=[e.dataTransfer?.items[0]?.webkitGetAsEntry(),e.dataTransfer?.files[0]];t&&cd(t)?o(t):r&&n(r)});let o=async t=>{let n=id(t.name,new Map(await ud(t)));n&&e(n)};return window.launchQueue?.setConsumer(({files:e})=>void e?.[0]?.getFile().then(n)),{root:r,choose:()=>r.click()}}var cd=e=>e.isDirectory,ld=e=>e.isFile;async function ud(e,t=``){let n=e.createReader(),r=[];for(;;){let e=await new Promise((e,t)=>n.readEntries(e,t));if(!e.length)return r;for(let n of e)ld(n)?r.push([t+n.name,await new Promise((e,t)=>n.file(e,t))]):cd(n)&&t===``&&r.push(...await ud(n,`${n.name}/`))}}var dd={BracketLeft:`[`,BracketRight:`]`,Minus:`-`,Equal:`=`};function fd(e){let{code:t,ctrlKey:n,altKey:r,metaKey:i,shiftKey:a}=e,o=e.key.toUpperCase().toLowerCase();if(o===`[`||o===`]`)return i||n&&!r?``:o;if(n||i||r)return``;let[,s,c=``]=/^(Key|Digit)(.)$/.exec(t)??[];return s===`Digit`?a||e.getModifierState(`AltGraph`)||`-+=?`.includes(o)?o:c:/^[\p{L}\p{M}]/u.test(o)&&!/^\p{Script=Latin}/u.test(o)?dd[t]??c.toLowerCase():o}var pd=[[X(`byDrag`),X(`doesMove`),X(`byFinger`)],[X(`byArrows`),X(`doesSteps`)],[X(`byWheel`),X(`doesZoom`),X(`byPinch`)],[X(`byShiftWheel`),X(`doesDolly`)],[X(`byRightDrag`),X(`doesShift`),X(`byTwoFingers`)],[X(`byDoubleClick`),X(`doesTurnAbout`),X(`byDoubleTap`)],[X(`byMap`),X(`doesMap`),X(`byMap`)],[`O`,X(`doesOrbit`)],[`[ ]`,X(`doesCameras`)],[`N`,X(`doesNearest`)],[X(`keySpace`),X(`doesFlip`)],[`${X(`keySpace`)} · , · .`,X(`doesPlay`)],[`[ ]`,X(`doesSpeed`)],[`V`,X(`doesSound`)],[`B`,X(`doesDivide`)],[`1 2 3 4`,X(`doesViews`)],[`− +`,X(`doesCount`)],[`T`,X(`doesWeights`)],[`M`,X(`doesWireframe`)],[`${X(`keyHome`)} · 0`,X(`doesHome`)],[X(`keyEscape`),X(`doesBack`)],[`P`,X(`doesSave`)],[X(`byTilt`),X(`doesTilt`),X(`byTilt`)],[`I`,X(`doesPanel`)],[`H · ?`,X(`doesHelp`)],[X(`byGamepad`),X(`doesGamepad`)],[X(`byGamepad`),X(`doesGamepadClip`)],[X(`byHeadset`),X(`doesHeadset`)]];function md(e){let t=Z(`h2`,{tabindex:`-1`},X(`controls`)),n=Z(`dl`),r=matchMedia(`(hover: none)`).matches;for(let[e,t,i]of pd)r&&i===void 0||n.append(Z(`dt`,{},r?i??e:e),Z(`dd`,{},t));let i=Z(`form`,{method:`dialog`},Z(`button`,{type:`submit`},X(`close`))),a=e===null?`eigenfield`:`eigenfield ${e}`,o=Z(`dialog`,{class:`help`,"aria-label":X(`controls`)},t,n,Z(`p`,{class:`quiet`},X(`about`,{program:a})),i);return o.addEventListener(`click`,e=>{e.target===o&&o.close()}),o.addEventListener(`keydown`,e=>{o.open&&[`h`,`?`].includes(fd(e))&&(e.stopPropagation(),o.close())}),{root:o,toggle:()=>{if(o.open)return o.close();o.showModal(),t.focus()}}}var hd=[.25,.5,1,2,4];function gd(e,t,n){let r=()=>e.scene?.field?.player??null,i=null;return{player:r,playOrPause:()=>{let e=r();e?.playing?e.pause():e?.play()},toFrame:e=>void r()?.toFrame(e),scrub:e=>{let t=r();t?.playing&&(i=t),t?.pause(),t?.toFrame(e)},letGo:()=>{i===r()&&i?.play(),i=null},skip:e=>{let t=r();t?.toFrame(t.sought+e*t.rate)},step:e=>void r()?.step(e),changeSpeed:(e,t=!1)=>{let n=r();if(!n)return;let i=hd.indexOf(n.speed)+e,a=hd[t?i%hd.length:Math.min(Math.max(i,0),hd.length-1)];a!==void 0&&(n.speed=a)},setLoop:e=>{let t=r();t&&(t.loop=e)},mute:e=>{let t=r()?.sound;t&&(t.muted=e)},opened:()=>{let e=r();e?.addEventListener(`frame`,t),e?.addEventListener(`change`,n),Jl()||e?.play()},stopped:async()=>{let e=r();e?.pause(),e?.waiting&&await e.toFrame(e.sought)}}}var _d=.14,vd=0,yd=1,bd=4,xd=5,[Sd,Cd]=[6,7],[wd,Td]=[14,15];function Ed(e){let t=null,n=!1,r=new Set,i=()=>{let a=navigator.getGamepads().filter(e=>e!==null);if(n=a.length>0,!n){t=null;return}let o=e=>{let t=a.reduce((t,n)=>t+(n.axes[e]??0),0);return Math.abs(t)<_d?0:Math.min(Math.max(t,-1),1)},s={x:o(0),y:-o(1)||0,closer:-o(3)||0,forward:0};t=s.x!==0||s.y!==0||s.closer!==0?s:null,t&&e.request();let c=new Set(a.flatMap(e=>e.buttons.flatMap((e,t)=>e.pressed?[t]:[]))),l=e=>c.has(e)&&!r.has(e);l(bd)&&e.nextCamera(-1),l(xd)&&e.nextCamera(1),l(yd)&&e.home(),e.player()?(l(vd)&&e.playOrPause(),l(wd)&&e.step(-1),l(Td)&&e.step(1),l(Sd)&&e.skip(-1),l(Cd)&&e.skip(1)):l(vd)&&e.showPhotograph(!e.photographShown()),r=c,requestAnimationFrame(i)};return addEventListener(`gamepadconnected`,()=>{n||i()}),{wish:()=>t}}var Dd={ArrowLeft:[`x`,-1],KeyA:[`x`,-1],ArrowRight:[`x`,1],KeyD:[`x`,1],ArrowUp:[`y`,1],KeyW:[`y`,1],ArrowDown:[`y`,-1],KeyS:[`y`,-1],KeyE:[`closer`,1],KeyQ:[`closer`,-1],KeyR:[`forward`,1],KeyF:[`forward`,-1]},Od=[`0`,`home`,`escape`],kd=[`[`,`]`,`-`,`+`,`=`,`,`,`.`];function Ad(e,t){let n=new Set,r=n=>{let{view:r,count:i,weights:a,wireframe:o}=e.options(),s=e.scene()?.field,c=t=>()=>e.set({view:t===r?`picture`:t}),l=t=>()=>e.set({count:Math.min(Math.max(Math.min(i,s?.total??0)+t,0),s?.total??0)});return{o:()=>e.setMode(e.modeName()===`plane`?`orbit`:`plane`),"[":()=>e.nextCamera(-1),"]":()=>e.nextCamera(1),n:e.nearestCamera," ":()=>e.showPhotograph(!e.photographShown()),b:t.divide,1:()=>e.set({view:`picture`}),2:c(`mean`),3:c(`eigen`),4:c(`error`),"-":l(-1),"+":l(1),"=":l(1),t:()=>e.set({weights:a===`ray`?`eye`:`ray`}),m:()=>e.set({wireframe:!o}),0:e.home,home:e.home,escape:()=>{e.captured()===null?e.modeName()===`orbit`&&e.comeBack():e.moving()},p:t.screenshot,i:t.panel,h:t.help,"?":t.help}[n]},i=t=>{let n={" ":e.playOrPause,",":()=>e.step(-1),".":()=>e.step(1),"[":()=>e.changeSpeed(-1),"]":()=>e.changeSpeed(1),v:()=>e.mute(e.player()?.sound?.muted===!1)};return e.player()?n[t]:void 0};return addEventListener(`keydown`,a=>{let o=fd(a);if(o===``||jd(a))return;let s=i(o)??(t.plain()&&!Od.includes(o)?void 0:r(o));(s||Dd[a.code])&&(document.body.dataset.keys=``),!s&&Dd[a.code]?(a.preventDefault(),n.add(a.code),e.request()):!s||a.repeat&&!kd.includes(o)||(a.preventDefault(),s())}),addEventListener(`keyup`,e=>void n.delete(e.code)),addEventListener(`blur`,()=>n.clear()),{wish:()=>{if(n.size===0)return null;let e={x:0,y:0,closer:0,forward:0};for(let t of n){let n=Dd[t];n&&(e[n[0]]+=n[1])}return e}}}function jd(e){let{target:t,key:n}=e;return t instanceof HTMLElement?t.closest(`dialog[open]`)?!0:n===`Escape`?!1:t.closest(`[role=slider]`)?n.startsWith(`Arrow`):t instanceof HTMLSelectElement?!0:t instanceof HTMLInputElement?n===` `&&t.type!==`range`||n===`Home`||n.startsWith(`Arrow`):n===` `&&t.closest(`button, summary, a`)!==null:!1}var Md=.0015,Nd=6e-4;function Pd(e){let{canvas:t}=e.stage,n=new Map,r=null,i=()=>Math.max(Math.min(t.clientWidth,t.clientHeight),1),a=()=>{let[e,t]=[...n.values()];return e&&t?Math.hypot(e.x-t.x,e.y-t.y):0};t.addEventListener(`pointerdown`,r=>{t.setPointerCapture(r.pointerId),e.hold(),n.set(r.pointerId,{x:r.clientX,y:r.clientY})}),t.addEventListener(`pointermove`,t=>{let o=n.get(t.pointerId);if(!o)return;let s=a(),[c,l]=[t.clientX-o.x,t.clientY-o.y];if(c===0&&l===0)return;Object.assign(o,{x:t.clientX,y:t.clientY});let u=e.moving();u!==r&&r?.release(),r=u,u?.grab();let d=t.pointerType!==`touch`&&(!!(t.buttons&6)||t.shiftKey);u?.drag(c/i()/n.size,l/i()/n.size,d||n.size>1);let f=a();s>0&&f>0&&u?.closer(f/s)});let o=t=>{!n.delete(t.pointerId)||n.size>0||(r?.release(),r=null,e.captured()===null&&e.moving())};t.addEventListener(`pointerup`,o),t.addEventListener(`pointercancel`,o),t.addEventListener(`contextmenu`,e=>e.preventDefault()),t.addEventListener(`wheel`,t=>{t.preventDefault();let n=t.deltaMode===WheelEvent.DOM_DELTA_LINE?30:1,r=(t.deltaY||t.deltaX)*n;t.shiftKey?e.moving()?.forward(-r*Nd):e.moving()?.closer(Math.exp(-r*Md))},{passive:!1}),t.addEventListener(`dblclick`,n=>{let r=e.scene();if(!r||e.moving()!==r.orbit)return;let i=t.getBoundingClientRect(),a=new H(2*(n.clientX-i.left)/i.width-1,1-2*(n.clientY-i.top)/i.height);r.orbit.aim(e.stage.camera,a)})}var Fd=18;function Id(e,t){let n=!1,r=null,i=null,a=t=>{if(t.beta===null||t.gamma===null)return;let n=(screen.orientation?.angle??0)*Math.PI/180,a=t.gamma*Math.cos(n)+t.beta*Math.sin(n),o=t.beta*Math.cos(n)-t.gamma*Math.sin(n),s=e.scene()?.plane;if(!s||e.modeName()!==`plane`||e.captured()!==null){r=null;return}let{x:c,y:l}=s.goal();(c!==i?.x||l!==i.y)&&(r=null),r??={across:a,down:o,x:c,y:l},s.goTo(r.x+(a-r.across)/Fd,r.y+(o-r.down)/Fd),i=s.goal(),e.moving()};return{possible:typeof DeviceOrientationEvent<`u`&&matchMedia(`(pointer: coarse)`).matches,on:()=>n,toggle:async()=>{if(n)removeEventListener(`deviceorientation`,a),n=!1;else{let{requestPermission:t}=DeviceOrientationEvent;(t?await t.call(DeviceOrientationEvent):`granted`)===`granted`?(r=null,addEventListener(`deviceorientation`,a),n=!0):e.say(X(`tiltDenied`))}t()}}}function Ld(){let e=Wl(X(`fullScreen`),Kl.fullscreen,()=>{document.fullscreenElement?document.exitFullscreen():document.documentElement.requestFullscreen()});return e.hidden=!document.fullscreenEnabled,document.addEventListener(`fullscreenchange`,()=>{e.setAttribute(`aria-pressed`,String(document.fullscreenElement!==null))}),e}var Rd=`eigenfield`;function zd(e,t){let{serviceWorker:n}=navigator;if(!n)return;let r=n.controller&&new URL(`.`,new URL(e,location.href)).href;n.register(e).catch(()=>void 0);let i=async e=>{let{href:t,origin:n}=new URL(e,location.href);n!==location.origin||r!==null&&t.startsWith(r)||await(await caches.open(Rd)).add(new Request(t,{cache:`force-cache`}))};t?.then(e=>typeof e==`string`?i(e):void 0).catch(()=>void 0)}function Bd(e,t){let n=Z(`progress`,{"aria-label":X(`loading`)}),r=Z(`p`,{}),i=Z(`div`,{class:`progress`},n,r),a=Z(`p`,{}),o=Z(`p`,{class:`quiet`}),s=Z(`button`,{type:`button`},X(`chooseAnother`));s.addEventListener(`click`,t);let c=Wl(X(`dismiss`),Kl.close,e.dismiss),l=Z(`div`,{class:`message`,role:`alert`,hidden:``},a,o,s,c),u=Z(`button`,{type:`button`,class:`primary`},X(`chooseFile`));u.addEventListener(`click`,t);let d=Z(`div`,{class:`invitation`,hidden:``},Z(`p`,{class:`large`},X(`dropHere`)),u,Z(`p`,{class:`quiet`},X(`staysHere`)),...e.config.samples.length>0?[Hd(e.config.samples)]:[]),f=Vd(),p=Z(`div`,{class:`drop`,hidden:``},Z(`p`,{class:`large`},X(`dropToOpen`))),m=Z(`button`,{type:`button`},X(`comeBack`));m.addEventListener(`click`,e.comeBack);let h=Z(`div`,{class:`cue`,hidden:``,role:`status`},Z(`p`,{},X(`outside`),Gl(X(`keyEscape`))),m),g=Z(`p`,{class:`tag`,hidden:``}),_=Z(`span`),v=Z(`small`,{}),y=Z(`p`,{class:`title`},_,v),b=Z(`p`,{class:`hint`,hidden:``},X(`hint`)),x=()=>{let t=e.scene(),u=t?.field,f=e.status(),{loaded:p,total:m}=e.progress(),h=f===`loading`||f===`ready`&&e.arriving();if(i.hidden=!h,h){m===null?n.removeAttribute(`value`):(n.max=Math.max(m,1),n.value=p);let e=[m===null?Fl(p):X(`outOf`,{part:Fl(p),whole:Fl(m)})];u&&e.push(X(`textureOf`,{part:u.loaded,whole:u.usable})),r.textContent=e.join(` · `)}let g=e.message();l.hidden=g===null,l.classList.toggle(`small`,t!==null&&f!==`lost`);let b=[g?.code,g?.detail].filter(Boolean).join(` · `);g&&(a.textContent!==g.text||o.textContent!==b)&&(a.textContent=g.text,o.textContent=b),s.hidden=f!==`failed`,c.hidden=f!==`ready`,d.hidden=f!==`empty`,_.textContent=t?.source.name??e.config.title??``;let{author:x=``,licence:C=``}=u?.info.rights??{};v.textContent=[x,C].filter(Boolean).join(` · `),y.hidden=_.textContent===``&&v.textContent===``,S()},S=()=>{b.hidden=!e.untouched()||e.status()!==`ready`||e.arriving()||e.message()!==null;let t=e.outside();h.hidden=!t,e.stage.canvas.parentElement?.classList.toggle(`outside`,t),f.hidden=e.options().view!==`error`||!e.hasPhotograph();let n=e.captured(),r=n===null?void 0:e.scene()?.field?.info.names[n];if(g.hidden=r===void 0,r===void 0)return;let{view:i,eigen:a}=e.options(),o={picture:X(`drawn`),mean:X(`mean`),eigen:X(`eigenNumber`,{number:a+1}),error:X(`errorTimes`)}[i],s=`${r} · ${e.photographShown()?X(`photograph`):o}`;g.textContent!==s&&(g.textContent=s)};return{roots:[y,g,h,b,f,i,l,d,p],update:x,tick:S,hover:e=>void(p.hidden=!e)}}function Vd(){let e=[0,1,2,3].map(e=>Z(`span`,{},String(e*255/5/3)));return Z(`div`,{class:`scale`,hidden:``},Z(`div`,{class:`heat`}),Z(`p`,{class:`marks`},...e),Z(`p`,{},X(`greyLevels`)))}function Hd(e){let t=e.map(({name:e,url:t,bytes:n,picture:r})=>{let i=new URLSearchParams(location.search);i.set(`load`,t);let a=n===null?[]:[Z(`span`,{class:`quiet`},Fl(n))],o=r===null?[]:[Z(`img`,{src:r,alt:``,loading:`lazy`})];return Z(`li`,{},Z(`a`,{href:`?${i}`},...o,e,...a))});return Z(`section`,{},Z(`h2`,{},X(`samples`)),Z(`ul`,{},...t))}var Ud=e=>e===void 0?[]:[Gl(e)],Wd=0,Gd=()=>`control-${++Wd}`;function Kd(e,t,n,r){let i=Gd(),a=new Map,o=Z(`div`,{class:`segments`});for(let[e,r]of t){let t=Z(`input`,{type:`radio`,name:i,value:e});t.addEventListener(`change`,()=>n(e)),a.set(e,t),o.append(Z(`label`,{},t,Z(`span`,{},r)))}let s=Z(`fieldset`,{class:`control`},Z(`legend`,{},e,...Ud(r)),o);return{root:s,show:e=>{let t=a.get(e);t&&(t.checked=!0)},enable:(e,t=``)=>{s.disabled=!e,s.title=e?``:t},allow:(e,t,n)=>{let r=a.get(e);r&&(r.disabled=!t,r.parentElement&&(r.parentElement.title=t?``:n))}}}function qd(e,t,n){let r=Gd(),i=Z(`input`,{type:`range`,id:r,step:`1`,min:`0`,max:`0`}),a=Z(`output`,{for:r});return i.addEventListener(`input`,()=>t(Number(i.value))),{root:Z(`div`,{class:`control`},Z(`div`,{class:`pair`},Z(`label`,{for:r},e,...Ud(n)),a),i),setRange:(e,t)=>{i.min=String(e),i.max=String(t)},show:e=>{i.value=String(e);let[t,n]=[Number(i.min),Number(i.max)];i.style.setProperty(`--part`,`${n>t?100*(e-t)/(n-t):0}%`)},say:e=>{a.textContent=e,i.setAttribute(`aria-valuetext`,e)},enable:e=>void(i.disabled=!e)}}function Jd(e,t,n){let r=Z(`input`,{type:`checkbox`});return r.addEventListener(`change`,()=>t(r.checked)),{root:Z(`label`,{class:`control tick`},r,Z(`span`,{},e,...Ud(n))),show:e=>void(r.checked=e),enable:e=>void(r.disabled=!e)}}function Yd(e,t){let n=Z(`select`,{"aria-label":e});return n.addEventListener(`change`,()=>t(n.value)),{root:n,input:n,fill:e=>{let t=e.flatMap(({label:e,entries:t})=>{let n=t.map(([e,t])=>Z(`option`,{value:e},t));return e===null?n:[Z(`optgroup`,{label:e},...n)]});n.replaceChildren(...t)},show:e=>void(n.value=e),enable:e=>void(n.disabled=!e)}}var Xd=[X(`black`),X(`dark`),X(`grey`),X(`white`)],Zd=({names:e,heldOut:t},n)=>`${e[n]??n}${t[n]===!0?` ○ ${X(`heldOut`)}`:``}`;function Qd(e){let t=Z(`h1`),n=Z(`p`,{class:`quiet`}),r=Z(`div`,{class:`brief`}),i=Kd(X(`show`),[[`picture`,X(`showPicture`)],[`mean`,X(`showMean`)],[`eigen`,X(`showEigen`)],[`error`,X(`showError`)]],t=>e.set({view:t}),`1 2 3 4`),a=qd(X(`eigenTexture`),t=>e.set({view:`eigen`,eigen:t-1})),o=qd(X(`eigenTextures`),t=>e.set({count:t}),`− +`),s=Z(`p`,{class:`quiet figures`}),c=Z(`p`,{class:`warning`}),l=Yd(X(`capturedCamera`),t=>{t===``?e.moving():e.toCamera(Number(t))}),u=Wl(X(`previousCamera`),Kl.previous,()=>e.nextCamera(-1),`[`),d=Wl(X(`nextCamera`),Kl.next,()=>e.nextCamera(1),`]`),f=Wl(X(`nearestCamera`),Kl.nearest,e.nearestCamera,`N`),p=Z(`button`,{type:`button`,class:`wide`,"aria-pressed":`false`});p.addEventListener(`click`,()=>e.showPhotograph(!e.photographShown()));let m=Z(`button`,{type:`button`,class:`wide`,"aria-pressed":`false`});m.append(X(`divider`),Gl(`B`)),m.addEventListener(`click`,e.divide);let h=Z(`p`,{class:`quiet held`}),g=Z(`p`,{class:`quiet`},`${X(`toCompare`)} `,Z(`code`,{},`eigenfield view scene.glb CAPTURE`)),_=Kd(X(`move`),[[`plane`,X(`onPlane`)],[`orbit`,X(`orbit`)]],t=>e.setMode(t),`O`),v=Kd(X(`weightsOffPlane`),[[`ray`,X(`eachRay`)],[`eye`,X(`theEye`)]],t=>e.set({weights:t}),`T`),y=Kd(X(`betweenCameras`),[[`delaunay`,X(`delaunay`)],[`bilinear`,X(`bilinear`)],[`nearest3`,X(`nearestThree`)]],t=>e.set({mixing:t})),b=Kd(X(`texels`),[[`bilinear`,X(`bilinear`)],[`bicubic`,X(`bicubic`)]],t=>e.set({filter:t})),x=Jd(X(`wireframe`),t=>e.set({wireframe:t}),`M`),S=Kd(X(`background`),au.map((e,t)=>[e,Xd[t]??e]),t=>e.set({background:t})),C=Z(`details`,{},Z(`summary`,{},X(`drawing`)),v.root,y.root,b.root,S.root,x.root),w=gu(e),T=Z(`details`,{},Z(`summary`,{},X(`aboutFile`)),w.root);T.addEventListener(`toggle`,w.update);let E=Z(`p`,{class:`quiet rate`,"aria-hidden":`true`}),D=Z(`fieldset`,{class:`control`},Z(`legend`,{},X(`capturedCamera`)),Z(`div`,{class:`cameras`},u,l.root,d,f),h,p,m,g),O=Z(`div`,{class:`own`},i.root,a.root,o.root,s,c,D,_.root),k=Z(`aside`,{class:`panel`,"aria-label":X(`panelLabel`),id:`panel`},Z(`header`,{},t,n,r),O,C,T,E),A=null,j=s=>{A=s;let c=s.field;t.textContent=e.scene()?.source.name??`eigenfield`,O.hidden=c===null;for(let e of[v,y,b])e.root.hidden=c===null;if(!c){n.textContent=s.lacks??X(`plainGltf`),r.replaceChildren();return}let{info:u}=c;n.textContent=[X(`countCameras`,{count:u.names.length}),X(`countTextures`,{count:c.total}),Fl(u.bytes.total)].join(` · `),l.fill([{label:null,entries:[[``,X(`freeView`)]]},...e.cameraOrder().map(({label:e,indices:t})=>({label:e,entries:t.map(e=>[String(e),Zd(u,e)])}))]);let d=u.heldOut.filter(Boolean).length;h.hidden=d===0,h.textContent=X(`heldOutNote`,{count:d}),o.setRange(0,c.total),a.setRange(1,Math.max(c.total,1)),i.allow(`eigen`,c.total>0,X(`noEigenTextures`)),_.allow(`plane`,s.plane!==null,X(`noPlane`)),y.allow(`bilinear`,u.grid!==null,X(`noGrid`)),v.enable(u.facesPlane,X(`noPlane`))};return{root:k,update:()=>{let u=e.scene();if(k.classList.toggle(`empty`,u===null),!u){t.textContent=e.config.title??`eigenfield`,n.textContent=``,A=null;return}u!==A&&j(u);let d=e.options();x.show(d.wireframe),S.show(d.background),T.open&&w.update();let{field:f}=u;if(!f)return;r.replaceChildren(_u(f));let h=e.hasPhotograph();i.show(d.view),i.allow(`error`,h,X(`noPhotographs`)),a.root.hidden=d.view!==`eigen`,a.show(d.eigen+1),a.say(X(`outOf`,{part:d.eigen+1,whole:f.total}));let C=Math.min(d.count,f.total),E=e.summed();o.show(C),o.say(X(`outOf`,{part:E,whole:E<C?C:f.total}));let D=Vl(f.info,E);s.textContent=Fl(Bl(f.info,E))+(D===null?``:` · UV SSIM ${zl(D,4)}`),c.hidden=f.limitation===null,c.textContent=Pl(f);let O=e.captured();l.show(O===null?``:String(O)),p.disabled=!h,p.title=h?``:X(`noPhotographs`);let M=e.photographShown();p.replaceChildren(X(M?`showDrawing`:`showPhotograph`),Gl(X(`keySpace`)));let N=e.beside()?.scene!=null;m.disabled=!h&&!N,m.title=m.disabled?X(`noPhotographs`):``,m.setAttribute(`aria-pressed`,String((M||N)&&d.divider!==null)),p.setAttribute(`aria-pressed`,String(M)),g.hidden=h||e.player()!==null,p.hidden=m.hidden=e.player()!==null,_.show(e.modeName()),v.show(d.weights),y.show(d.mixing),b.show(d.filter)},tick:()=>{let t=e.rate(),{scale:n,linear:i}=e.detail(),a=e.nearestName(),o=a===null?X(`inFull`):X(`inFullNear`,{name:a}),{field:s}=e.scene()??{};s?.player&&!k.hidden&&r.replaceChildren(_u(s)),E.textContent=t===null?o:X(n<1?`rateCoarser`:i?`rateLinear`:`rate`,{rate:t.toFixed(0)})}}}function $d(e){let t=Wl(X(`play`),Kl.play,e.playOrPause),n=Z(`input`,{type:`range`,min:`0`,max:`0`,step:`1`,"aria-label":X(`time`)}),r=!1;n.addEventListener(`input`,()=>{r=!0,e.scrub(Number(n.value))});for(let t of[`change`,`pointerup`,`pointercancel`,`blur`])n.addEventListener(t,()=>{r=!1,e.letGo()});let i=Z(`output`,{class:`figures`,"aria-hidden":`true`}),a=Z(`button`,{type:`button`,class:`speed figures`});a.addEventListener(`click`,()=>e.changeSpeed(1,!0));let o=Wl(X(`repeat`),Kl.loop,()=>e.setLoop(e.player()?.loop===!1)),s=Wl(X(`sound`),Kl.sound,()=>e.mute(e.player()?.sound?.muted===!1)),c=Z(`div`,{class:`playbar`,role:`group`,"aria-label":X(`playback`)},t,n,i,a,s,o),l=()=>{let t=e.player();if(!t)return;let a=r?t.sought:t.frame,o=zl(t.first+a/t.rate,2,`\xA0s`);n.value=String(a),n.style.setProperty(`--part`,`${100*a/Math.max(t.frames-1,1)}%`),n.setAttribute(`aria-valuetext`,o),i.textContent=o};return{root:c,tick:l,update:()=>{let r=e.player();if(c.hidden=r===null,document.body.toggleAttribute(`data-clip`,r!==null),!r)return;let i=X(r.playing?`pause`:`play`);t.replaceChildren(Ul(r.playing?Kl.pause:Kl.play),Gl(X(`keySpace`))),t.title=i,t.setAttribute(`aria-label`,i),n.max=String(r.frames-1);let u=String(r.speed).split(`.`)[1]?.length??0,d=zl(r.speed,u,`×`);a.textContent=d,a.title=X(`speed`),a.setAttribute(`aria-label`,`${X(`speed`)} ${d}`);let f=r.sound?.playable===!0&&!r.sound.muted;s.hidden=r.sound===null,s.disabled=r.sound?.playable===!1,s.title=X(s.disabled?`noSound`:`sound`),s.replaceChildren(Ul(f?Kl.sound:Kl.muted),Gl(`V`)),s.setAttribute(`aria-pressed`,String(f)),o.setAttribute(`aria-pressed`,String(r.loop)),l()}}}function ef(e){let t=e.querySelector(`img.poster`);if(!t||e.hidden)return null;let n=e=>void requestAnimationFrame(()=>setTimeout(e));return t.decode().catch(()=>void 0).then(()=>new Promise(n))}function tf(e,t){return e.querySelector(`img.poster`)||(t===null||t===``?null:Z(`img`,{class:`poster`,src:t,alt:``}))}function nf(e){let t=e.scene();if(!t)return;e.drawNow();let{x:n,y:r}=e.coordinates(),i=e.captured(),a=i===null?`${n.toFixed(2)} ${r.toFixed(2)}`:t.field?.info.names[i],o=`${t.source.name} ${a??``}`.replaceAll(/[^\p{L}\p{N}._+-]+/gu,`-`).slice(0,100);e.stage.canvas.toBlob(e=>{e&&Wu(e,`${o}.png`)},`image/png`)}var rf=2500,af=640,of=200,sf=`fullscreen; xr-spatial-tracking; gyroscope; accelerometer`;function cf(e){let{url:t}=e.config,n=t!==null||/^https?:$/.test(location.protocol),r=Z(`p`,{class:`said`,role:`status`,hidden:``}),i=0,a=async(e,t)=>{r.textContent=await df(e)?t:e,r.hidden=!1,clearTimeout(i),i=window.setTimeout(()=>void(r.hidden=!0),rf)},o=()=>new URL(Xu(e),t??location.href);return{link:Wl(X(`share`),Kl.share,()=>void a(o().href,X(`linkCopied`))),embed:Wl(X(`copyEmbed`),Kl.embed,()=>void a(lf(e,o()),X(`embedCopied`))),said:r,possible:n}}function lf(e,t){e.config.ui===`full`&&t.searchParams.set(`ui`,`plain`);let{source:n,field:r}=e.scene()??{},i=r?.info.cameras[r.info.reference],a=Math.round(af*(i?i.height/i.width:3/4)),[o,s]=[t.href,n?.name.slice(0,of)??``].map(uf);return`<iframe src="${o}" title="${s}" ${`width="${af}" height="${a}"`} style="border: 0" allow="${sf}"></iframe>`}var uf=e=>e.replaceAll(`&`,`&amp;`).replaceAll(`"`,`&quot;`).replaceAll(`<`,`&lt;`).replaceAll(`>`,`&gt;`);async function df(e){try{return await navigator.clipboard.writeText(e),!0}catch{let t=Z(`textarea`,{readonly:``,class:`copied`});t.value=e;let n=document.activeElement;document.body.append(t),t.select();let r=document.execCommand(`copy`);return t.remove(),n instanceof HTMLElement&&n.focus(),r}}var ff=class extends Error{code;where;name=`SceneError`;constructor(e,t,n=``,r){super(t,r),this.code=e,this.where=n}};function Q(e,t){return new ff(`damaged`,`The file is damaged (${e}: ${t}); make or download it again.`,e)}function pf(e,t){return new ff(`truncated`,`The file is cut off after ${e} of ${t} bytes; download or copy it again.`,String(e))}function mf(e){return new ff(`truncated`,`The file is cut off (${e}); download or copy it again.`,e)}function hf(e,t=``){return e instanceof ff?e:new ff(`damaged`,`The file cannot be read (${(e instanceof Error?e.message:String(e)).replace(/^THREE\.GLTFLoader: /,``)}); make or download it again.`,t,{cause:e})}var gf=60;function _f(e){return{name:`EIGENFIELD_addresses`,beforeRoot:async()=>vf(e.json)}}function vf(e){let t=[[``,e]];for(let e=t.pop();e;e=t.pop()){let[n,r]=e;if(typeof r==`object`&&r)for(let[e,i]of Object.entries(r)){if(e===`extras`&&!Array.isArray(r))continue;let a=`${n}/${e}`;if(e===`uri`&&!(typeof i==`string`&&/^data:/i.test(i)))throw yf(a,JSON.stringify(i));t.push([a,i])}}}function yf(e,t){return new ff(`address`,`The file names another one (${e}: ${t.length>gf?`${t.slice(0,gf)}…`:t}), which is not fetched; export all of it as one .glb.`,e)}var bf=1,xf=7;function Sf(e,t){let{level:n,tier:r,width:i,height:a}=Cf(new Uint8Array(e),t),o=r<<7|76,s=wf(`ipco`,[...wf(`ispe`,[...Tf(0),...Tf(i),...Tf(a)]),...wf(`pixi`,[...Tf(0),3,10,10,10]),...wf(`av1C`,[129,n,o,0]),...wf(`colr`,[...Ef(`nclx`),0,2,0,2,0,2,128])]),c=wf(`ftyp`,[...Ef(`avif`),...Tf(0),...Ef(`avifmif1miafMA1B`)]),l=t=>wf(`meta`,[...Tf(0),...wf(`hdlr`,[...Tf(0),...Tf(0),...Ef(`pict`),...Array(13).fill(0)]),...wf(`pitm`,[...Tf(0),0,1]),...wf(`iloc`,[...Tf(0),68,0,0,1,0,1,0,0,0,1,...Tf(t),...Tf(e.byteLength)]),...wf(`iinf`,[...Tf(0),0,1,...wf(`infe`,[2,0,0,0,0,1,0,0,...Ef(`av01`),0])]),...wf(`iprp`,[...s,...wf(`ipma`,[...Tf(0),...Tf(1),0,1,4,1,2,131,4])])]),u=c.length+l(0).length+8,d=[...c,...l(u),...Tf(8+e.byteLength),...Ef(`mdat`)],f=new Uint8Array(u+e.byteLength);return f.set(d),f.set(new Uint8Array(e),u),f.buffer}function Cf(e,t){let n=e[0]??0,r=8*(1+(n>>2&1)+(n>>1&1)),i=t=>{let n=0;for(let i=r+t;r<i;r++)n=2*n+((e[r>>3]??0)>>7-(r&7)&1);return n};i(4);let a=i(1)===1,o=!a&&i(7)!==0;a||i(12);let s=i(5),c=!a&&s>xf?i(1):0,[l,u]=[i(4)+1,i(4)+1],[d,f]=[i(l)+1,i(u)+1];if(n>>3!==bf||o||r>8*e.length)throw Q(t,`no AV1 sequence header`);return{level:s,tier:c,width:d,height:f}}function wf(e,t){return[...Tf(8+t.length),...Ef(e),...t]}function Tf(e){return[24,16,8,0].map(t=>e>>>t&255)}function Ef(e){return Array.from(e,e=>e.charCodeAt(0))}async function Df(e,t,n,r){let i=[],a=0,o=new Blob([e]).stream().pipeThrough(new DecompressionStream(t)).getReader();try{for(let e=await o.read();!e.done&&a<=n;e=await o.read())i.push(e.value),a+=e.value.length}catch{throw Q(r,`it does not inflate`)}if(a>n)throw await o.cancel(),Q(r,`more than ${n} bytes`);let s=new Uint8Array(a),c=0;for(let e of i)s.set(e,c),c+=e.length;return s}var Of=`EIGENFIELD_eigen_textures`,kf=64*2**20,Af=16384,jf=16384,Mf=1024,Nf=2**27,Pf=4096,Ff=8*2**30,If=1e5,Lf=65535,Rf=2**29,zf=1024,Bf=2**25,Vf=2**26,Hf=2**27,Uf=8192,Wf=2**24,Gf=2**25,Kf=2**20,qf=2**16,Jf=2**30,Yf=1024,Xf=2**22,Zf=2**28,Qf=2**31-1,$f=2**28,ep=1e30,tp=65536,np=126,rp=64,ip=0,ap=1,op=2,sp=24,cp=44,lp=21,up=26214,dp=4,fp=Float64Array.from({length:4095},(e,t)=>Math.round(tp/(1+Math.exp((2047-t)/256)))),pp=Float64Array.from({length:4096},(e,t)=>Math.round(256*Math.log((t+.5)/(4095.5-t)))),mp=Float64Array.from({length:127},(e,t)=>Math.round(tp/(t+1.5)));function hp(e){return e<4294967296?32-Math.clz32(e):32+hp(Math.floor(e/4294967296))}var gp=class{bytes;low=0;high=4294967295;code=0;at=0;probability;seen;weights;constructor(e,t,n){this.bytes=e,this.probability=new Uint16Array(t*rp).fill(tp/2),this.seen=new Uint8Array(t*rp),this.weights=new Float64Array(n*rp*3).fill(up);for(let e=0;e<dp;e++)this.code=this.code*256+this.next()}checkEnd(e){if(this.at>this.bytes.length+dp)throw mf(e)}flag(e,t,n,r){return this.node(e,t,n,r,0)===1}raw(e){let t=0;for(let n=0;n<e;n++)t=t*2+this.split(tp/2);return t}integer(e,t,n,r){let i=this.magnitude(e,t,n,r);return i===0?0:this.node(e,t,n,r,ap)?-i:i}magnitude(e,t,n,r){if(!this.node(e,t,n,r,ip))return 0;let i=0;for(;i<lp&&this.node(e,t,n,r,op+i);)i+=1;if(i<2)return i+1;let a=1;for(let o=i-2;o>=0;o--){let s;s=o===i-2?this.node(e,t,n,r,sp+i):o===i-3?this.node(e,t,n,r,cp+2*Math.min(i,9)+(a&1)):this.split(tp/2),a=a*2+s}return a+1}node(e,t,n,r,i){return this.bit(e*rp+i,t*rp+i,n*rp+i,(r*rp+i)*3)}bit(e,t,n,r){let{probability:i,weights:a}=this,o=pp[i[e]>>4],s=pp[i[t]>>4],c=pp[i[n]>>4],l=Math.floor((a[r]*o+a[r+1]*s+a[r+2]*c)/tp),u=fp[Math.min(Math.max(l,-2047),2047)+2047],d=this.split(u),f=d?tp-u:-u;return a[r]+=o*f>>14,a[r+1]+=s*f>>14,a[r+2]+=c*f>>14,this.learn(e,d),this.learn(t,d),this.learn(n,d),d}learn(e,t){let[n,r]=[this.probability[e],this.seen[e]];this.probability[e]=n+Math.floor(((t?65535:0)-n)*mp[r]/tp),r<np&&(this.seen[e]=r+1)}split(e){let t=this.low+Math.floor((this.high-this.low)*e/tp),n=+(this.code<=t);for(n?this.high=t:this.low=t+1;!((this.low^this.high)>>>24);)this.low=this.low<<8>>>0,this.high=(this.high<<8|255)>>>0,this.code=(this.code<<8|this.next())>>>0;return n}next(){return this.bytes[this.at++]??0}};function _p(e,t,n,r=1){if(e.length<t)throw mf(n);if(e[0]!==r)throw Q(n,`coded numbers of version ${e[0]}`);return new DataView(e.buffer,e.byteOffset,e.byteLength)}function vp(e,t,n,r){if(t>n||t>16*e.length+1024)throw Q(r,`${t} numbers announced`)}var yp=12,bp=1,xp=3,Sp=312,Cp=xp*Sp,wp=938,Tp=24,Ep=16,Dp=1722,Op=1726,kp=4,Ap=5;function jp(e){return new gp(e,Op,21)}function Mp(e){return e.flag(Cp,Cp,Cp,xp)?2:e.flag(937,937,937,xp)?bp:0}function Np(e){return Math.min(hp(e),11)}function Pp(e,t,n,r){let i=new Float64Array(n.length),a=n.length/t,o=(e,n,r)=>n<0||r<0||r>=t?0:e[n*t+r],s=0;for(let c=0;c<a;c++)for(let a=0;a<t;a++){let[l,u]=[o(i,c,a-1),o(i,c-1,a)],[d,f]=[o(i,c-1,a-1),o(i,c-1,a+1)],[p,m,h]=[0,0,s];r===bp?(p=c===0?l:a===0?u:Math.max(Math.min(l,u),Math.min(Math.max(l,u),l+u-d)),m=Math.abs(l-d)+Math.abs(u-d)+Math.abs(f-u)):(m=2*Math.abs(l)+2*Math.abs(u)+Math.abs(d)+Math.abs(f),h=Math.abs(o(i,c,a-2))+Math.abs(o(i,c-2,a)));let g=2*Math.abs(o(n,c,a))+Math.abs(o(n,c,a-1))+Math.abs(o(n,c,a+1)),_=r===2?Math.min(c,2)*4+Math.min(a,3):Math.min(c,1),v=r*Sp,y=e.integer(v+Np(m)*yp+Np(g),v+144+Np(m+h),v+144+24+_*yp+Np(g+Math.abs(l)),r);i[c*t+a]=p+y,s=Math.abs(y)}return i}function Fp(e,t,n,r){let i=new Float64Array(t*n),a=new Float64Array(n);for(let o=0;o<t;o++){let t=0;for(let s=0;s<n;s++){let c=r&&o>0?i[(o-1)*n+s]:0,l=Math.min(s,15),u=Math.min(hp(a[s]),23),d=Math.min(hp(t),23),f=e.integer(wp+l*Tp+u,wp+(Ep+l)*Tp+d,1706+l,Ap+l);i[o*n+s]=c+f,t=Math.abs(f),a[s]=Math.floor((a[s]+t+1)/2)}}return i}function Ip(e,t,n,r){let i=new Float64Array(t).fill(-1),a=new Uint8Array(n),[o,s,c]=[0,1,0];for(let l=0;l<t;l++){if(s=+!!e.flag(Dp+s,Dp+s,1724,kp),!s)continue;let t=o+e.integer(1725,1725,1725,kp);if(!(t>=0&&t<n)||a[t])throw Q(r,`a grid with a camera out of place`);a[t]=1,i[l]=t,o=t+1,c+=1}if(c!==n)throw Q(r,`a grid without all cameras`);return i}var Lp=130,Rp=11,zp=1,Bp=2,Vp=2,Hp=44*If+1024;async function Up(e,t){if(e[0]!==Vp)throw Q(t,`version ${e[0]}`);let n=await Df(Uint8Array.from(e.subarray(1)),`deflate-raw`,Hp,t);return Wp(Uint8Array.from([1,...n]),t)}function Wp(e,t){let n=_p(e,Lp,t),[r,i]=[n.getUint8(1),n.getUint32(6,!0)],a=(r&zp)!==0,[o,s]=a?[n.getUint16(2,!0),n.getUint16(4,!0)]:[0,0],c=Float64Array.from({length:15},(e,t)=>n.getFloat64(10+8*t,!0));if(r>3||i===0||!c.every(Number.isFinite))throw Q(t,`cameras that cannot be`);if(i>1e5||a&&o*s<i)throw Q(t,`${i} cameras`);vp(e,Math.max(Rp*i,o*s),Rp*If,t);let l=Lp+(a?132:0);_p(e,l,t);let u=(e,t)=>a?n.getFloat32(Lp+4*(e*Rp+t),!0):0,d=jp(e.subarray(l)),f=a?Ip(d,o*s,i,t):null,p=Fp(d,i,Rp,(r&Bp)!==0);d.checkEnd(t);let m={intrinsics:new Float32Array(5*i),poses:new Float32Array(12*i)},h=[...c.subarray(7,12),0,0,0,...c.subarray(12)],g=Kp(c[3],c[4],c[5],c[6]),_=new Float64Array(Rp),v=0;for(let e=0;e<(f?f.length:i);e++){let t=f?f[e]:e;if(t<0)continue;let[n,r]=f?[Math.floor(e/s),e%s]:[0,0];for(let e=0;e<Rp;e++){let t=c[e<5?0:e<8?1:2],i=u(0,e)+u(1,e)*n+u(2,e)*r;_[e]=p[v*Rp+e]*t+h[e]+i}Gp(_,g,m,t),v+=1}if(!m.intrinsics.every(Number.isFinite)||!m.poses.every(Number.isFinite))throw Q(t,`cameras that are not finite`);return m}function Gp(e,t,n,r){n.intrinsics.set(e.subarray(0,5),5*r);let[i,a,o]=[e[5],e[6],e[7]],s=i*i+a*a+o*o,c=1+s,l=Kp(2*i/c,2*a/c,2*o/c,(1-s)/c);for(let i=0;i<3;i++){let a=0;for(let o=0;o<3;o++){let s=0;for(let e=0;e<3;e++)s+=l[3*i+e]*t[3*e+o];n.poses[12*r+4*i+o]=s,a-=s*e[8+o]}n.poses[12*r+4*i+3]=a}}function Kp(e,t,n,r){return[[1-2*(t*t+n*n),2*(e*t-n*r),2*(e*n+t*r)],[2*(e*t+n*r),1-2*(e*e+n*n),2*(t*n-e*r)],[2*(e*n-t*r),2*(t*n+e*r),1-2*(e*e+t*t)]].flat()}var qp=new Set([`I420P10`,`I422P10`,`I444P10`]),Jp=new Set([`I420`,`I420A`,`I422`,`I444`,`NV12`]),Yp=new Set([`RGBA`,`RGBX`,`BGRA`,`BGRX`]),Xp=1,Zp=Uint16Array.from({length:256},(e,t)=>Math.round(t*1023/255)),Qp=Uint16Array.from({length:256},(e,t)=>Zp[16+Math.round(t*219/255)]),$p=Qp.map((e,t)=>t===0?0:t===255?1023:e);async function em(e,t,n=!1){let r=e.format??``,{width:i,height:a}=e.visibleRect??{width:0,height:0};if(!qp.has(r)&&!Jp.has(r)&&!Yp.has(r)){let t=nm(e,[i,a]);if(t)return rm(t,4*i,4,[i,a],tm(e,n));throw new ff(`unsupported`,`This browser does not hand out its frames (${r||`no format`}).`,``)}let o=e.allocationSize(),s=t&&t.length>=o?t:new Uint8Array(o),[c]=await e.copyTo(s),{offset:l,stride:u}=c??{offset:0,stride:0};if(qp.has(r))return{data:s.subarray(l),width:i,height:a,stride:u,room:s};let d=Yp.has(r),[f,p]=d?[4,l+Xp]:[1,l],m=d?tm(e,n):Zp;return rm(s.subarray(p),u,f,[i,a],m)}function tm(e,t){return e.colorSpace?.fullRange===!1?t?$p:Qp:Zp}function nm(e,t){if(typeof OffscreenCanvas>`u`||!t[0])return null;let n=new OffscreenCanvas(...t).getContext(`2d`,{willReadFrequently:!0});return n?.drawImage(e,0,0),n?.getImageData(0,0,...t).data??null}function rm(e,t,n,[r,i],a=Zp){let o=new Uint16Array(r*i);for(let s=0;s<i;s++)for(let i=0;i<r;i++)o[s*r+i]=a[e[s*t+n*i]];return{data:new Uint8Array(o.buffer),width:r,height:i,stride:2*r,grown:!0}}function im({data:e,stride:t},{size:[n,r],at:i}){return i.map(([i,a])=>({data:e.subarray(a*t+2*i),width:n,height:r,stride:t}))}var am=4,om=[`prefer-software`,`no-preference`],sm=class{size;where;user;decoder=null;config=null;turn=0;onTheWay=0;opened=0;constructor(e,t,n){this.size=e,this.where=t,this.user=n}get open(){return this.opened}get busy(){return this.onTheWay>0}get ready(){return this.onTheWay<am||this.decoder?.state===`closed`}async start(e){let{level:t,tier:n,width:r,height:i}=Cf(e,this.where);if(r!==this.size[0]||i!==this.size[1])throw Q(this.where,`frames of ${r} x ${i}`);let a=`av01.0.${String(t).padStart(2,`0`)}${n?`H`:`M`}.10`,{turn:o}=this,s=this.config?.codec===a,c=s?this.config:await cm(a,this.size,this.where);o===this.turn&&c&&(s&&this.decoder?.state===`configured`||(this.config=c,this.decoder&&this.decoder.state!==`closed`||(this.decoder=this.made()),this.decoder.configure(c)))}decode(e,t,n){if(this.decoder?.state===`closed`)return this.user.lost();this.onTheWay+=1,this.decoder?.decode(new EncodedVideoChunk({type:n?`key`:`delta`,timestamp:t,data:e}))}async flush(){await this.decoder?.flush().catch(()=>void 0)}reset(){this.turn+=1,this.onTheWay=0,this.decoder?.state===`configured`&&this.decoder.reset()}dispose(){this.reset(),this.decoder&&this.decoder.state!==`closed`&&this.decoder.close(),this.decoder=null}made(){let e=new VideoDecoder({output:e=>void this.receive(e),error:t=>{this.decoder===e&&(t.name===`QuotaExceededError`?this.user.lost():t.name===`NotSupportedError`?this.fail(this.turn,lm(this.where)):this.fail(this.turn,Q(this.where,t.message)))}});return e}async receive(e){let{turn:t}=this;this.opened+=1;try{await this.user.take(e.timestamp,(...t)=>em(e,...t))}catch(e){this.fail(t,e)}finally{e.close(),--this.opened,t===this.turn&&--this.onTheWay,this.user.closed()}}fail(e,t){e===this.turn&&(this.reset(),this.user.failed(t))}};async function cm(e,[t,n],r){for(let r of typeof VideoDecoder>`u`?[]:om){let i={codec:e,codedWidth:t,codedHeight:n,hardwareAcceleration:r,optimizeForLatency:!0};if((await VideoDecoder.isConfigSupported(i).catch(()=>null))?.supported)return i}throw lm(r)}function lm(e){return new ff(`codec`,`This browser ${globalThis.isSecureContext?`decodes no AV1 of 10 bits`:`plays clips from https and localhost only`}; ${globalThis.isSecureContext?`use a newer browser`:`open the page from there`}. The first frame is shown.`,e)}var um=0,dm=2**24,fm=class{points;start;end;opposite;before;after;status;into;heap;key;gates=0;waiting=0;constructor(e,t){this.points=e;let n=3*t;this.start=new Int32Array(n),this.end=new Int32Array(n),this.opposite=new Int32Array(n),this.before=new Int32Array(n),this.after=new Int32Array(n),this.status=new Uint8Array(n),this.into=new Int32Array(e.length/3).fill(-1),this.heap=new Int32Array(n),this.key=new Float64Array(n)}seed(e){let t=this.gates;for(let t=0;t<3;t++)this.add(e[t],e[(t+1)%3],e[(t+2)%3]);for(let e=0;e<3;e++)this.link(t+e,t+(e+1)%3)}next(){let{heap:e,key:t}=this;for(;this.waiting>0;){let n=e[0],r=--this.waiting,[i,a]=[e[r],t[r]],o=0;for(;2*o+1<r;){let n=2*o+1;if(n+1<r&&t[n+1]<t[n]&&(n+=1),t[n]>=a)break;e[o]=e[n],t[o]=t[n],o=n}if(e[o]=i,t[o]=a,this.status[n]===1)return n}return-1}closeLeft(e){let[t,n]=[this.before[e],this.after[e]],r=this.start[t];if(this.status[e]=this.status[t]=um,this.status[n]===1&&this.end[n]===r&&n!==t){this.status[n]=um,this.link(this.before[t],this.after[n]);return}let i=this.before[t],a=this.add(r,this.end[e],this.start[e]);this.link(i,a),this.link(a,n)}closeRight(e){let[t,n]=[this.before[e],this.after[e]];this.status[e]=this.status[n]=um;let r=this.after[n],i=this.add(this.start[e],this.end[n],this.end[e]);this.link(t,i),this.link(i,r)}openOut(e,t){let[n,r,i]=[this.before[e],this.after[e],this.into[t]];this.status[e]=um;let a=this.add(this.start[e],t,this.end[e]),o=this.add(t,this.end[e],this.start[e]);i>=0&&this.status[i]!==um?(this.link(a,this.after[i]),this.link(i,o)):this.link(a,o),this.link(n,a),this.link(o,r),this.into[t]=a}link(e,t){this.after[e]=t,this.before[t]=e}add(e,t,n){let{heap:r,key:i,points:a}=this,o=this.gates++;this.start[o]=e,this.end[o]=t,this.opposite[o]=n,this.status[o]=1,this.into[t]=o;let s=(a[3*e]+a[3*t])*dm+a[3*e+1]+a[3*t+1],c=this.waiting++;for(;c>0;){let e=c-1>>1;if(i[e]<=s)break;r[c]=r[e],i[c]=i[e],c=e}return r[c]=o,i[c]=s,o}},pm=2**20,mm=.8,hm=44,gm=385,_m=897,vm=1086,ym=1095,[bm,xm,Sm,Cm,wm]=[0,1,2,3,15];function Tm(e){return Math.floor(Math.min(Math.max(e,-pm),pm)+.5)}function Em(e,t,n){let r=Math.max((1<<n)-1,1);return(e[3*t]&r?1:0)+(e[3*t+1]&r?2:0)}function Dm(e,t,n,r,i){i.flat?Om(e,t,n,r,i.fine):km(e,t,n,r)}function Om(e,t,n,r,i){let{a,b:o,o:s,pair:c}=r,[l,u,d,f]=[t[3*a],t[3*a+1],t[3*o],t[3*o+1]],[p,m]=[d-l,f-u],h=p*(t[3*s+1]-u)-m*(t[3*s]-l),g=h>0?mm:-.8,_=1<<i>>1,v=Tm((l+d)*.5+g*m)+_>>i,y=Tm((u+f)*.5-g*p)+_>>i,b=4**i,x=Math.min(hp(Math.floor((p*p+m*m)/b)),23),S=Math.min(hp(Math.floor(Math.abs(h)/b)),23),C=+(p<0)+(m<0?2:0)+(Math.abs(m)>Math.abs(p)?4:0),w=e.integer(x*8+C,192+S,216+c,bm),T=Math.min(hp(Math.abs(w)),7),[E,D]=[577,705],O=T*2+ +(w>0),k=e.integer(gm+x*8+C,E+O*8+C,D+S*8+T,xm);if(t[3*n]=v+w<<i,t[3*n+1]=y+k<<i,i===0)return;let A=Em(t,a,i)+4*Em(t,o,i);if(e.flag(_m+A,913+Em(t,s,i),917+c,wm))for(let r=0;r<2;r++)t[3*n+r]+=e.raw(i)-_}function km(e,t,n,{a:r,b:i,o:a}){let o=0;for(let e=0;e<3;e++)o+=(t[3*i+e]-t[3*r+e])**2;let s=Math.min(hp(o),43),c=0;for(let o=0;o<3;o++){let l=Tm(t[3*r+o]+t[3*i+o]-t[3*a+o]),u=e.integer(s,hm+o*24+c,116+o*hm+s,Sm);t[3*n+o]=l+u,c=Math.min(hp(Math.abs(u)),23)}}function Am(e,t,n,r,i){for(let a=0;a<(i?2:3);a++){let i=r>=0?Math.min(Math.max(t[3*r+a],-pm),pm):0,o=vm+a;t[3*n+a]=i+e.integer(o,o+3,o+6,Cm)}}var jm=13,Mm=11,Nm=12,Pm=169,Fm=8,Im=ym,Lm=Im+Pm+104+26,Rm=Lm+Pm+104+jm,zm=Rm+64+64+Pm,Bm=zm+Pm+4+1,Vm=Bm+6,[Hm,Um,Wm,Gm,Km]=[4,5,6,7,8],qm=[-1,-.4,0,.3,.6,.9,1.3,2,4];function Jm(e,t,n,r,i){let a=new Int32Array(3*t),o={points:a,faces:new Int32Array(3*n),parents:new Int32Array(3*t).fill(-1)},s=new Int32Array(t),c=new fm(a,n),[l,u]=[0,0],d=(e,t,n)=>{o.faces.set([e,t,n],3*u),u+=1;for(let r of[e,t,n])s[r]+=1},f=()=>{if(l>=t)throw Q(i,`more places than announced`);return l++},p=()=>{let t=e.raw(hp(l-1));if(t>=l)throw Q(i,`a place that is not there yet`);return t},m=()=>{let t=[-1,-1,-1];for(let n=0;n<3;n++)if(l>0&&e.flag(Bm+n,Bm+3+n,Bm+n,Km))t[n]=p();else{let i=t[n]=f();Am(e,a,i,n>0?t[n-1]:i-1,r.flat)}let[n,o,s]=t;if(n===o||o===s||s===n)throw Q(i,`a face of two corners`);d(n,o,s),c.seed(t)},h=(e,t,n,i)=>c.status[t]===2?Nm:c.status[t]!==1||n===i||t===e?Mm:Ym(a,c.start[e],c.end[e],n,c.opposite[e],r.flat);for(;u<n;){let t=c.next();if(t<0){m();continue}let[n,l]=[c.start[t],c.end[t]],[u,g]=[c.before[t],c.after[t]],[_,v]=[c.start[u],c.end[g]],[y,b]=[h(t,u,_,l),h(t,g,v,n)],x=y*jm+b,[S,C]=[Math.min(s[n],7),Math.min(s[l],7)],w=Im+Pm+104+2*y+ +(_===v);if(y<Mm&&e.flag(Im+x,Im+Pm+y*Fm+S,w,Hm)){d(l,n,_),c.closeLeft(t);continue}if(b<Mm&&(v!==_||y>=Mm)&&e.flag(Lm+x,Lm+Pm+b*Fm+C,Lm+Pm+104+b,Um)){d(l,n,v),c.closeRight(t);continue}let T=+(y===Nm)+(b===Nm?2:0),E=Em(a,n,r.fine)+4*Em(a,l,r.fine),D=Rm+64+S*Fm+C;if(e.flag(Rm+T*16+E,D,Rm+64+64+x,Wm)){c.status[t]=2;continue}let O;if(e.flag(zm+x,zm+Pm+T,zm+Pm+4,Gm)){O=f();let i=c.opposite[t];o.parents.set([n,l,i],3*O),Dm(e,a,O,{a:n,b:l,o:i,pair:x},r)}else if(O=p(),O===n||O===l)throw Q(i,`a face of two corners`);d(l,n,O),c.openOut(t,O)}if(l!==t)throw Q(i,`fewer places than announced`);return o}function Ym(e,t,n,r,i,a){let o=(n,r)=>a&&r===2?0:e[3*n+r]-e[3*t+r],[s,c,l]=[o(n,0),o(n,1),o(n,2)],[u,d,f]=[o(r,0),o(r,1),o(r,2)],[p,m,h]=[o(i,0),o(i,1),o(i,2)],[g,_,v]=[c*f-l*d,l*u-s*f,s*d-c*u],[y,b,x]=[c*h-l*m,l*p-s*h,s*m-c*p],S=Math.sqrt(g*g+_*_+v*v);if(S===0||g*y+_*b+v*x>0)return 0;let C=(u*(u-s)+d*(d-c)+f*(f-l))/S,w=qm.findIndex(e=>C<e);return w<0?10:w+1}var Xm=32,Zm=4,[Qm,$m,eh,th]=[0,1,2,3],nh=Vm,rh=nh+64+12+16,ih=rh+Zm+1,ah=ih+4,[oh,sh,ch]=[9,10,11];function lh(e,t){let n=new Int32Array(t+1);for(let t of e)n[t+1]+=1;for(let e=0;e<t;e++)n[e+1]+=n[e];let r=n.slice(),i=new Int32Array(e.length);return e.forEach((e,t)=>i[r[e]++]=t),{first:n,corners:i}}function uh(e,t,n,r,i,a,o){let s=t.faces.length/3,c=Math.min(s,Math.floor(n/3)),l={faces:new Int32Array(3*s),place:new Int32Array(n),chart:new Int32Array(n),kinds:new Uint8Array(c),maps:new Uint32Array(6*c)},u=new Int32Array(t.points.length/3).fill(-1),d=new Int32Array(n),f=[-1,-1,-1],p=[0,0,0],m=new Int32Array(Zm),h=new Int32Array(8),[g,_,v]=[0,0,-1],y=(e,n)=>{for(let r=0;r<3;r++)if(t.faces[3*e+r]===n)return r;return-1},b=(e,n)=>{let[a,o]=[t.faces[3*e+n],t.faces[3*e+(n+1)%3]];for(let t=r[a];t<Math.min(r[a+1],r[a]+Xm);t++){let n=Math.floor(i[t]/3);if(n>=e)break;if(y(n,o)>=0)return n}return-1},x=(e,t)=>l.faces[3*e+y(e,t)],S=(n,r)=>{let i=t.faces[3*n+r],a=u[i];if(a<0)return-1;h.fill(th);let s=0;for(let e of[r,(r+2)%3]){if(f[e]<0)continue;let t=x(f[e],i);s===1&&m[0]===t?h[1]=p[e]:(m[s]=t,h[2*s]=p[e],s+=1)}for(let e=0;e<Xm&&s<Zm&&a>=0;e++)(s<1||a!==m[0])&&(s<2||a!==m[1])&&(m[s++]=a),a=d[a];let c=-1;for(let t=0;t<s&&c<0;t++){let[n,i]=[h[2*t],h[2*t+1]],a=nh+76+Math.min(s,3)*4+n;e.flag(nh+t*16+n*4+i,nh+64+t*3+r,a,oh)&&(c=m[t])}if(c<0){if(e.flag(rh+s,rh+s,rh+Zm,sh))return-1;if(c=e.raw(hp(g-1)),c>=g||l.place[c]!==i)throw Q(o,`a corner that is elsewhere`)}for(let e of[r,(r+2)%3])f[e]>=0&&(p[e]=x(f[e],i)===c?$m:eh);return c},C=()=>{let t=_++;if(!e.flag(ih,ih,ih,ch))return l.kinds[t]=e.flag(ih+1,ih+1,ih+1,ch)?2:0,t;l.kinds[t]=1;let n=v;if(v=t,n>=0&&e.flag(ih+2,ih+2,ih+2,ch)){let n=e.raw(hp(t-1));if(n>=t||l.kinds[n]!==1)throw Q(o,`a map that is not there`);return l.maps.copyWithin(6*t,6*n,6*n+6),t}let r=n>=0&&e.flag(ih+3,ih+3,ih+3,ch);for(let i=0;i<4;i++)l.maps[6*t+i]=r?l.maps[6*n+i]:e.raw(32);for(let n=4;n<6;n++)l.maps[6*t+n]=e.raw(a);return t};for(let e=0;e<s;e++){for(let t=0;t<3;t++)f[t]=b(e,t),p[t]=Qm;let r=-1,i=[];for(let a=0;a<3;a++){let s=S(e,a);if(s>=0)r=l.chart[s];else{if(g>=n)throw Q(o,`more vertices than announced`);s=g++;let r=t.faces[3*e+a];l.place[s]=r,d[s]=u[r],u[r]=s,i.push(s)}l.faces[3*e+a]=s}r<0&&(r=C());for(let e of i)l.chart[e]=r}if(g!==n)throw Q(o,`fewer vertices than announced`);return l}var dh=16,fh=6,ph=13,mh=14,hh=20,gh=ah,_h=gh+169+280+182,vh=_h+144+576+48,[yh,bh]=[12,13],xh=[.5,1.5,3,6,12,30];function Sh(e,t){return Tm(Number.isNaN(e)?t:e)}function Ch(e){let t=xh.filter(t=>Math.abs(e)>=t).length;return e<0?fh-t:fh+t}function wh(e,t,n,r){let{points:i,faces:a,parents:o}=t,s=new Float64Array(9),c=e=>i[3*e],l=e=>i[3*e+1],u=e=>i[3*e+2],d=(e,t)=>{let[n,r,i]=[c(t)-c(e),l(t)-l(e),u(t)],a=1/(1+n*n+r*r);return s[0]+=a,s[1]+=a*n,s[2]+=a*r,s[3]+=a*n*n,s[4]+=a*n*r,s[5]+=a*r*r,s[6]+=a*i,s[7]+=a*n*i,s[8]+=a*r*i,a},[f,p,m]=[0,0,0];for(let t=0;t<i.length/3;t++){s.fill(0);let[h,g,_,v]=[0,0,1/0,-1/0];for(let e=n[t];e<Math.min(n[t+1],n[t]+dh);e++)for(let i=1;i<3;i++){let o=Th(a,r[e],i);if(o>=t)continue;let s=d(t,o);h+=s*u(o),g+=s,_=Math.min(_,u(o)),v=Math.max(v,u(o));for(let e=n[o];e<Math.min(n[o+1],n[o]+dh);e++)for(let n=1;n<3;n++){let i=Th(a,r[e],n);i<t&&d(t,i)}}let y=13,b=t>0?u(t-1):0,x=b;g>0&&(y=Math.min(hp(v-_),12),b=h/g,x=Math.min(Math.max(Eh(s),p),m));let S=b,[C,w,T]=[o[3*t],o[3*t+1],o[3*t+2]];if(C>=0){let[e,n,r,i]=[c(w)-c(C),l(w)-l(C),c(T)-c(C),l(T)-l(C)],[a,o]=[c(t)-c(C),l(t)-l(C)],s=e*i-n*r;if(s!==0){let[t,c]=[(a*i-o*r)/s,(e*o-n*a)/s];S=Math.min(Math.max(u(C)+t*(u(w)-u(C))+c*(u(T)-u(C)),p),m)}}let E=Sh(x,b),[D,O]=[Ch(S-E),Ch(b-E)],k=e.integer(gh+D*ph+O,gh+169+y*hh+f,gh+169+280+D*mh+y,yh),A=E+k;i[3*t+2]=A,f=Math.min(hp(Math.abs(k)),19),p=t===0?A:Math.min(p,A),m=t===0?A:Math.max(m,A)}}function Th(e,t,n){let r=t%3;return e[t-r+(r+n)%3]}function Eh(e){let[t,n,r]=[e[0],e[1],e[2]],[i,a,o]=[e[3]+1,e[4],e[5]+1],[s,c,l]=[e[6],e[7],e[8]],[u,d,f]=[i*o-a*a,n*o-a*r,n*a-i*r];return(s*u-c*d+l*f)/(t*u-n*d+r*f)}function Dh(e,t,n,r,i){let{faces:a,chart:o,kinds:s,place:c}=t,l=new Int32Array(2*c.length),u=[0,0],d=-1;for(let t=0;t<c.length;t++){let f=s[o[t]];if(f===1)continue;let[p,m,h,g,_]=[0,0,0,-1,0];for(let e=r[t];e<Math.min(r[t+1],r[t]+dh);e++){let[r,s]=[Th(a,i[e],1),Th(a,i[e],2)];if(r<t&&o[r]===o[t]&&(g=Math.max(g,r)),s<t&&o[s]===o[t]&&(g=Math.max(g,s)),r>=t||s>=t)continue;let[u,d]=Oh(n,c,l,t,r,s,f===2);if(!Number.isFinite(u)||!Number.isFinite(d))continue;p+=u,m+=d,h+=1;let v=Math.abs(l[2*r]-l[2*s])+Math.abs(l[2*r+1]-l[2*s+1]);_=Math.max(_,hp(v))}g<0&&(g=d),d=t;let v=[g>=0?l[2*g]:0,g>=0?l[2*g+1]:0],y=h>0?[p/h,m/h]:v,[b,x]=[Math.min(h,2),Math.min(_,23)],S=_h+144;for(let n=0;n<2;n++){let r=e.integer(_h+(n*24+x)*3+b,S+u[0]*24+x,S+576+n*24+u[n],bh+n);l[2*t+n]=Sh(y[n],0)+r,u[n]=Math.min(hp(Math.abs(r)),23)}}return l}function Oh(e,t,n,r,i,a,o){let[s,c,l]=[0,0,0];for(let n=0;n<3;n++){let o=e[3*t[i]+n],u=e[3*t[a]+n]-o,d=e[3*t[r]+n]-o;s+=u*u,c+=u*d,l+=d*d}let[u,d]=[n[2*a]-n[2*i],n[2*a+1]-n[2*i+1]],f=c/s,p=Math.sqrt(Math.max(l/s-f*f,0)),m=o?-p:p;return[n[2*i]+f*u-m*d,n[2*i+1]+f*d+m*u]}var kh=144,Ah=2,jh=3,Mh=18,Nh=8;function Ph(e,t){return Ih(e,t,1)}function Fh(e,t){return Ih(e,t,Ah)}function Ih(e,t,n){let r=_p(e,kh,t,n),[i,a,o]=[r.getUint8(1),r.getUint8(2),r.getUint8(3)],[s,c,l]=[4,8,12].map(e=>r.getUint32(e,!0)),u=Float64Array.from({length:16},(e,t)=>r.getFloat64(16+8*t,!0));if(s>Vf||l>Vf||c>Hf)throw Q(t,`${l} vertices and ${c} faces`);if(vp(e,Math.max(s,c,l),Hf,t),i>1||o>Nh*i||a<1||a>Mh||!u.every(Number.isFinite))throw Q(t,`a lattice that cannot be`);let d=new gp(e.subarray(kh),vh,16),f=Jm(d,s,c,{flat:i===1,fine:o},t);d.checkEnd(t);let p=lh(f.faces,s);i&&wh(d,f,p.first,p.corners);let m=n===Ah?a+jh:32,h=uh(d,f,l,p.first,p.corners,m,t),g=Lh(f.points,u),_=lh(h.faces,l),v=Dh(d,h,g,_.first,_.corners);d.checkEnd(t);let y=new Float32Array(h.maps.buffer);return zh({...Rh(f,h,g,v,2**a,e=>n===Ah?h.maps[e]/2**(a+1)-2:y[e]),matrix:u},t)}function Lh(e,t){let n=new Float64Array(e.length);for(let r=0;r<e.length;r+=3){let i=n=>t[4*n]*e[r]+t[4*n+1]*e[r+1]+t[4*n+2]*e[r+2]+t[4*n+3],a=i(3);for(let e=0;e<3;e++)n[r+e]=i(e)/a}return n}function Rh(e,{faces:t,place:n,chart:r,kinds:i,maps:a},o,s,c,l){let u=new Float32Array(3*n.length),d=new Int32Array(3*n.length),f=new Float32Array(2*n.length),p=new Float32Array(a.buffer);return n.forEach((t,n)=>{u.set(o.subarray(3*t,3*t+3),3*n),d.set(e.points.subarray(3*t,3*t+3),3*n);let a=6*r[n],m=i[r[n]]===1;for(let r=0;r<2;r++){let i=a+2*r;f[2*n+r]=m?p[i]*e.points[3*t]+p[i+1]*e.points[3*t+1]+l(a+4+r):s[2*n+r]/c}}),{positions:u,uv:f,indices:new Uint32Array(t),places:d}}function zh(e,t){let n=e=>Math.abs(e)<=ep;if(!e.positions.every(n)||!e.uv.every(n))throw Q(t,`positions or texture coordinates that are not finite`);return e}var Bh=11,Vh=2**20,Hh=8,[Uh,Wh]=[7,8],Gh=12,[Kh,qh,Jh,Yh]=[0,1,2,3],Xh=576,Zh=720,Qh=1152,$h=1159,eg=3,tg=4,ng=class{mesh;where;frames;flags;decoder=null;moving;around;steps;off;decoded=0;constructor(e,t,n){this.mesh=t,this.where=n;let r=_p(e,Bh,n),i=t.places.length/3,a=r.getUint32(5,!0);this.frames=r.getUint16(9,!0);let o=Bh+this.frames;if(r.getUint32(1,!0)!==i||a>i)throw Q(n,`${a} vertices that move, of another mesh`);if(this.frames<1||this.frames>1024||this.frames*a>Gf)throw Q(n,`${a} vertices that move in ${this.frames} frames`);if(_p(e,o,n),this.flags=e.slice(Bh,o),this.flags.some(e=>e>Uh+Wh))throw Q(n,`frames that cannot be`);if(vp(e,this.flags.reduce((e,t)=>e+(t&1)+(t>>1&1)+(t>>2&1),0)*a,3*Gf,n),this.moving=new Int32Array(a),this.steps=new Int32Array(a&&3*a*(2+this.frames)),this.off=new Int32Array(3*a),this.around=og(t.places,t.indices),!a)return;this.decoder=new gp(e.subarray(o),$h,tg);let s=ag(this.decoder,i,this.around);if(s.reduce((e,t)=>e+t,0)!==a)throw Q(n,`other vertices that move`);this.around=this.start(s)}read(e){for(;this.decoded<=Math.min(e,this.frames-1);this.decoded+=1)this.decoder&&this.readFrame(this.decoder,this.decoded)}place(e,t){let{matrix:n}=this.mesh;t.set(this.mesh.positions);let r=this.moving.length;if(!r)return;let i=this.steps.subarray(3*r*(2+e),3*r*(3+e));this.moving.forEach((e,r)=>t.set(rg(i,3*r,n),3*e))}start(e){let{places:t,indices:n}=this.mesh,r=new Int32Array(e.length).fill(-1),i=0;e.forEach((e,t)=>{e&&(this.moving[i]=t,r[t]=i++)});let a=new Int32Array(3*i);return this.moving.forEach((e,n)=>a.set(t.subarray(3*e,3*e+3),3*n)),this.steps.set(a),this.steps.set(a,a.length),og(a,Int32Array.from(n,e=>r[e]))}readFrame(e,t){let{steps:n,around:r,off:i}=this,{near:a,starts:o,twins:s}=r,c=3*this.moving.length,[l,u,d,f]=[this.flags[t],c*(2+t),c*(1+t),c*t],p=(l&Wh)!==0,m=new Int32Array(c);for(let t=0;t<this.moving.length;t++){let[r,c]=[o[t],o[t+1]],h=c-r,g=s[t]?Kh:h===0?Yh:h===1?Jh:qh;for(let o=0;o<3;o++){let s=3*t+o;if(!(l>>o&1)){n[u+s]=n[d+s];continue}let[_,v,y,b]=[1/0,-1/0,0,0];for(let e=r;e<c;e++){let t=3*a[e]+o,r=n[u+t]-n[d+t];p&&(r-=n[d+t]-n[f+t]),_=Math.min(_,r),v=Math.max(v,r),y+=r,b+=Math.abs(m[t])}let x=n[d+s];p&&(x+=x-n[f+s]),h&&(x+=Math.floor((2*y+h)/(2*h))),x=Math.min(Math.max(x,-Vh),Vh);let S=ig(h&&Math.floor(4*b/h)),C=ig(4*Math.abs(i[s])),w=ig(h&&v-_);m[s]=e.integer((g*Gh+S)*Gh+C,Xh+(o*4+g)*Gh+w,Zh+(o*Gh+w)*Gh+S,o),n[u+s]=x+m[s]}}this.off=m,e.checkEnd(this.where),this.check(u,c)}check(e,t){for(let n=e;n<e+t;n+=3)if(!rg(this.steps,n,this.mesh.matrix).every(e=>Math.abs(e)<=1e30))throw Q(this.where,`positions that are not finite`)}};function rg(e,t,n){let[r,i,a]=[e[t],e[t+1],e[t+2]],o=e=>n[4*e]*r+n[4*e+1]*i+n[4*e+2]*a+n[4*e+3],s=o(3);return[o(0)/s,o(1)/s,o(2)/s]}function ig(e){return Math.min(hp(e),11)}function ag(e,t,{near:n,starts:r}){let i=new Uint8Array(t),a=0;for(let o=0;o<t;o++){let[t,s]=[r[o],r[o+1]],c=0;for(let e=t;e<s;e++)c+=i[n[e]];let l=s===t?3:c===0?0:c===s-t?2:1;a=Number(e.flag(Qh+l,1156+a,1158,eg)),i[o]=a}return i}function og(e,t){let n=e.length/3,r=Array.from({length:n},()=>[]),i=new Uint8Array(n),a=new Map;for(let t=0;t<n;t++){let n=`${e[3*t]} ${e[3*t+1]} ${e[3*t+2]}`,o=a.get(n);o===void 0?a.set(n,t):(i[t]=1,r[t].push(o))}for(let e=0;e<t.length;e++){let n=t[e];if(n<0||i[n])continue;let a=e-e%3;for(let i of[1,2]){let o=t[a+(e+i)%3];o>=0&&o<n&&r[n].length<Hh&&r[n].push(o)}}let o=new Int32Array(n+1);return r.forEach((e,t)=>o[t+1]=o[t]+e.length),{near:r.flat(),starts:o,twins:i}}var sg=4*zf;async function cg(e,t,n){let r=Math.min(Bf,sg*t),i=await Df(Uint8Array.from(e),`deflate`,r,n),a=i.length/t;if(a===0||!Number.isInteger(a))throw Q(n,`${i.length} bytes of ${t} names`);let o=new TextDecoder(`utf-8`,{fatal:!0,ignoreBOM:!0}),s=new Uint8Array(a),c=[];for(let e=0;e<t;e++){for(let n=0;n<a;n++)s[n]=i[n*t+e];let r=a;for(;r>0&&s[r-1]===0;)--r;try{c.push(o.decode(s.subarray(0,r)))}catch{throw Q(n,`names that are not UTF-8`)}}return c}function lg(e){let t=new DataView(e);try{return dg(t)??fg(t)??pg(t)??mg(t)}catch(e){if(e instanceof RangeError)return null;throw e}}function ug(e,t){return String.fromCharCode(...[0,1,2,3].map(n=>e.getUint8(t+n)))}function dg(e){return e.getUint32(0)!==2303741511||e.getUint32(4)!==218765834||ug(e,12)!==`IHDR`?null:{type:`image/png`,width:e.getUint32(16),height:e.getUint32(20),bits:null}}function fg(e){if(e.getUint16(0)!==65496)return null;for(let t=2;;){let n=e.getUint16(t);if(n===65535){t+=1;continue}let r=n>=65472&&n<=65487&&![65476,65480,65484].includes(n),i=n=>e.getUint16(t+n);if(r)return{type:`image/jpeg`,width:i(7),height:i(5),bits:null};if(n<65281||n===65498||n===65497)return null;t+=2+e.getUint16(t+2)}}function pg(e){if(ug(e,0)!==`RIFF`||ug(e,8)!==`WEBP`)return null;let t={type:`image/webp`,bits:null},n=ug(e,12),r=t=>e.getUint16(t,!0)+65536*e.getUint8(t+2);if(n===`VP8X`)return{...t,width:1+r(24),height:1+r(27)};if(n===`VP8L`){let n=e.getUint32(21,!0);return{...t,width:1+(n&16383),height:1+(n>>>14&16383)}}return n===`VP8 `?{...t,width:e.getUint16(26,!0)&16383,height:e.getUint16(28,!0)&16383}:null}function mg(e){if(ug(e,4)!==`ftyp`)return null;let t=null,n=null,r=(i,a)=>{for(let o=i;o+8<=a;){let i=e.getUint32(o),s=ug(e,o+4),c=i===0?a:o+i;if(i===1||c<o+8||c>a)return;if(s===`meta`&&r(o+12,c),(s===`iprp`||s===`ipco`)&&r(o+8,c),s===`ispe`){let[n,r]=[e.getUint32(o+12),e.getUint32(o+16)];(!t||n*r>t.width*t.height)&&(t={width:n,height:r})}if(s===`av1C`){let t=e.getUint8(o+10);n??=t&64?t&32?12:10:8}o=c}};return r(0,e.byteLength),t&&{type:`image/avif`,...t,bits:n}}var hg={colorSpaceConversion:`none`,premultiplyAlpha:`none`},gg={"image/avif":`AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOltZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAAAAABAAAAHmlsb2MAAAAARAAAAQABAAAAAQAAAQ0AAAAZAAAAKGlpbmYAAAAAAAEAAAAaaW5mZQIAAAAAAQAAYXYwMUNvbG9yAAAAAGhpcHJwAAAASWlwY28AAAAUaXNwZQAAAAAAAAAIAAAACAAAAA5waXhpAAAAAAEIAAAADGF2MUOBABwAAAAAE2NvbHJuY2x4AAEADQAGgAAAABdpcG1hAAAAAAAAAAEAAQQBAoMEAAAAIW1kYXQSAAoIGAi/aYCGg1AyCxlGIYeeaACQQNmg`,"image/webp":`UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAAAdQwAIWsP+BiOh/AAA=`};function _g(e,t,n){let r=lg(e);if(!r)throw Q(t.where,`no picture`);let{width:i,height:a,bits:o}=r;if(n&&(i!==n[0]||a!==n[1]))throw Q(t.where,`a picture of ${i} x ${a}, not of ${n[0]} x ${n[1]}`);if(t.codec.bits!==8&&t.codec.bits!==o)throw Q(t.where,`no picture of ${t.codec.bits} bits`);let s=i*a;if(!s||i>16384||a>32768||s>Nf)throw Q(t.where,`a picture of ${i} x ${a}`);return[i,a]}var vg=async(e,t,n)=>{let r=t.pieces*t.textures,[i,a]=_g(e,t,n&&[n[0],r*n[1]]),o=lg(e)?.type??t.codec.mimeType,s;try{s=await createImageBitmap(new Blob([e],{type:o}),hg)}catch(e){throw await yg(o)?Q(t.where,`it cannot be decoded`):bg(o,t,e)}if(s.width!==i||s.height!==a)throw s.close(),Q(t.where,`decoded to ${s.width} x ${s.height}, not to ${i} x ${a}`);let c=a/r;return Array.from({length:r},(e,t)=>({picture:s,row:t*c,rows:c}))};async function yg(e){let t=gg[e];if(!t)return!0;let n=Uint8Array.from(atob(t),e=>e.charCodeAt(0));try{return(await createImageBitmap(new Blob([n],{type:e}))).close(),!0}catch{return!1}}function bg(e,t,n){return new ff(`codec`,`This browser cannot decode ${e.replace(`image/`,``).toUpperCase()} pictures; use a newer one, or encode the scene with --codec png.`,t.where,{cause:n})}var xg=new Set([`I420P10`,`I422P10`,`I444P10`]),Sg=async(e,t,n)=>{let r=t.pieces*t.textures,[i,a]=_g(e,t,n&&[n[0],r*n[1]]),o=await Cg(e,i,a);if(!o)return vg(e,t,n);let s=a/r;return Array.from({length:r},(e,t)=>({picture:o,row:t*s,rows:s}))};async function Cg(e,t,n){if(typeof ImageDecoder>`u`)return null;let r=null,i=null;try{r=new ImageDecoder({data:e,type:`image/avif`}),i=(await r.decode()).image;let a=i.visibleRect;if(!xg.has(i.format??``)||a?.width!==t||a.height!==n)return null;let o=new Uint8Array(i.allocationSize()),[s]=await i.copyTo(o);return s?{data:o.subarray(s.offset),width:t,height:n,stride:s.stride}:null}catch{return null}finally{i?.close(),r?.close()}}var wg=5;function Tg(e,t){let n=_p(e,wg,t).getUint32(1,!0);vp(e,3*n,6*If,t);let r=jp(e.subarray(wg)),i=Fp(r,n,3,!0);r.checkEnd(t);let a=i.map((e,t)=>t%3?i[t-t%3]+e:e);if(!a.every(e=>e>=0&&e<1e5))throw Q(t,`triangles of cameras that there cannot be`);return{corners:Uint32Array.from(a)}}var Eg=14,Dg=2**20;function Og(e,t){let n=_p(e,Eg,t),r=n.getUint8(1)===1,[i,a]=[n.getUint32(6,!0),n.getUint32(10,!0)],o=r?n.getUint16(2,!0):1,s=r?n.getUint16(4,!0):i;if(n.getUint8(1)>1||i===0)throw Q(t,`weights of no camera, or of an unknown kind`);vp(e,o*s*Math.max(a,1),$f,t),_p(e,Eg+4*a,t);let c=o*s;if(c<i)throw Q(t,`a grid with too few cells`);let l=jp(e.subarray(Eg+4*a)),u=r?Ip(l,c,i,t):null,d=u!==null&&i===c,f=[0,1,2].map(()=>new Float64Array(c)),p=new Float32Array(i*a),m=4*Dg*Math.max(o,s);for(let e=0;e<a;e++){let r=n.getFloat32(Eg+4*e,!0);if(!(r>0&&r<1/0))throw Q(t,`a step that is not positive`);let i=Mp(l),h=Pp(l,s,f[i],i);if(i===2&&!d||h.some(e=>Math.abs(e)>m))throw Q(t,`numbers of component ${e} that cannot be`);f[i]=h;let g=i===2?kg(h,o,s):h;for(let t=0;t<c;t++){let n=u?u[t]:t;n>=0&&(p[n*a+e]=g[t]*r)}l.checkEnd(t)}if(!p.every(Number.isFinite))throw Q(t,`weights that are not finite`);return{cameras:i,components:a,values:p}}function kg(e,t,n){let r=new Float64Array(t*n),i=new Float64Array(t*n),a=Ag(n);for(let i=0;i<t;i++)for(let t=0;t<n;t++){let o=0;for(let r=0;r<n;r++)o+=a(r,t)*e[i*n+r];r[i*n+t]=o}let o=Ag(t);for(let e=0;e<t;e++)for(let a=0;a<n;a++){let s=0;for(let i=0;i<t;i++)s+=o(i,e)*r[i*n+a];i[e*n+a]=s}return i}function Ag(e){let[t,n]=[Math.sqrt(1/e),Math.sqrt(2/e)],r=Float64Array.from({length:4*e},(t,r)=>n*Math.cos(Math.PI*r/(2*e)));return(n,i)=>n===0?t:r[(2*i+1)*n%(4*e)]}function jg(e){let[t,n]=[vg,vg];return{kind:`picture`,decode:t,bitmaps:n,needs:null,limits:[`MAX_SIDE`,`MAX_STACKED`,`MAX_TEXELS`],mimeType:e,bits:8}}var Mg={"mesh-1":{kind:`mesh`,decode:Ph,needs:`codedMesh`,limits:[`MAX_VERTICES`,`MAX_TRIANGLES`]},"mesh-2":{kind:`mesh`,decode:Fh,needs:`mesh-2`,limits:[`MAX_VERTICES`,`MAX_TRIANGLES`]},"cameras-1":{kind:`cameras`,decode:Wp,needs:`codedCameras`,limits:[`MAX_CAMERAS`]},"cameras-2":{kind:`cameras`,decode:Up,needs:`cameras-2`,limits:[`MAX_CAMERAS`]},"names-1":{kind:`names`,decode:cg,needs:`codedNames`,limits:[`MAX_NAMES`,`MAX_CAMERAS`]},"triangles-1":{kind:`triangles`,decode:Tg,needs:`codedTriangles`,limits:[`MAX_CAMERAS`]},"weights-1":{kind:`weights`,decode:Og,needs:`codedWeights`,limits:[`MAX_WEIGHTS`]},"film-1":{kind:`film`,decode:(...e)=>new sm(...e),needs:`film-1`,limits:[`MAX_FILM_SIDE`,`MAX_FILM_PIXELS`]},"motion-1":{kind:`motion`,decode:(...e)=>new ng(...e),needs:`motion-1`,limits:[`MAX_GROUP_FRAMES`,`MAX_MOTION`]},png:jg(`image/png`),webp:jg(`image/webp`),avif:jg(`image/avif`),jpeg:jg(`image/jpeg`),"av1-10bit-1":{...jg(`image/avif`),bits:10,decode:Sg,needs:`bits`},"av1-10bit-2":{...jg(`video/AV1`),bits:10,decode:(e,t,n)=>Sg(Sf(e,t.where),t,n),bitmaps:(e,t,n)=>vg(Sf(e,t.where),t,n),needs:`av1-10bit-2`}},Ng={mesh:`mesh-1`,cameras:`cameras-1`,names:`names-1`,triangles:`triangles-1`,weights:`weights-1`};function Pg(e,t,n){let r=t.exists?t.text(zf):n,i=Object.hasOwn(Mg,r)?Mg[r]:null;if(i?.kind===e)return i;throw new ff(`codec-unknown`,`${`A ${e} stream has the codec "${r.slice(0,60)}", which this viewer does not know`}; take a newer viewer.`,t.where)}function Fg(e,t){return Object.keys(Mg).find(n=>{let r=Mg[n];return r.kind===`picture`&&r.mimeType===e&&(t??r.bits)===r.bits})}var Ig=class e{raw;where;constructor(e,t){this.raw=e,this.where=t}get exists(){return this.raw!==void 0}object(){if(this.raw===null||typeof this.raw!=`object`||Array.isArray(this.raw))throw this.wrong(`no object`);return this.raw}key(t){let n=this.object(),r=Object.hasOwn(n,t)?n[t]:void 0;return new e(r,`${this.where}/${t}`)}items(t){if(!Array.isArray(this.raw))throw this.wrong(`no list`);if(this.raw.length>t)throw this.wrong(`more than ${t} entries`);return this.raw.map((t,n)=>new e(t,`${this.where}/${n}`))}at(t){if(!Array.isArray(this.raw))throw this.wrong(`no list`);return new e(this.raw[t],`${this.where}/${t}`)}text(e){if(typeof this.raw!=`string`)throw this.wrong(`no text`);if(this.raw.length>e)throw this.wrong(`longer than ${e} characters`);return this.raw}number(e=-ep,t=ep){if(typeof this.raw!=`number`)throw this.wrong(`no number`);if(!(this.raw>=e&&this.raw<=t))throw this.wrong(`${this.raw} is not in ${e}..${t}`);return this.raw}integer(e,t){let n=this.number(e,t);if(!Number.isInteger(n))throw this.wrong(`${n} is no whole number`);return n}numbers(e,t=-ep,n=ep){let r=this.items(e);if(r.length!==e)throw this.wrong(`${e} numbers are needed`);return r.map(e=>e.number(t,n))}triple(){let[e=0,t=0,n=0]=this.numbers(3);return[e,t,n]}wrong(e){return Q(this.where||`/`,this.exists?e:`missing`)}},Lg=5121,Rg=5123,zg=5125,Bg=5126,Vg={[Lg]:1,[Rg]:2,[zg]:4,[Bg]:4},Hg=new Set([`cameras`,`triangles`,`weights`]),Ug={SCALAR:1,VEC2:2,VEC3:3};function Wg(e){let t=e.key(`buffers`).at(0);if(t.key(`uri`).exists)throw t.wrong(`not the binary chunk`);let n=t.key(`byteLength`).integer(0,2**32-1);return e.key(`bufferViews`).items(Af).map(e=>{let t=e.key(`byteOffset`),r=e.key(`byteStride`);e.key(`buffer`).integer(0,0);let i={offset:t.exists?t.integer(0,n):0,length:e.key(`byteLength`).integer(1,n),stride:r.exists?r.integer(4,252):0};if(i.offset+i.length>n)throw e.wrong(`outside the buffer`);return i})}function Gg(e){return t=>t.integer(0,e.length-1)}function Kg(e,t){let n=e.key(`accessors`),r=n.exists?n.items(Af):[];return(e,n,i,a)=>{let o=r[e.integer(0,r.length-1)];if(!o)throw e.wrong(`no such accessor`);let s=o.key(`componentType`).integer(5120,5126);if(!i.includes(s))throw o.wrong(`component type ${s}`);if(o.key(`type`).text(1024)!==n)throw o.wrong(`not ${n}`);if(o.key(`sparse`).exists)throw o.wrong(`sparse`);let c=o.key(`normalized`);if(c.exists&&c.raw!==!1)throw o.wrong(`normalised`);let l=Ug[n]??1,u=o.key(`count`).integer(1,$f);if(a!==null&&u!==a)throw o.wrong(`${a} numbers are needed, not ${u}`);let d=o.key(`bufferView`).integer(0,t.length-1),f=t[d];if(!f)throw o.wrong(`no such buffer view`);let p=o.key(`byteOffset`),m=p.exists?p.integer(0,f.length):0,h=Vg[s]*l;if(f.stride&&(f.stride<h||n===`SCALAR`))throw o.wrong(`a stride that cannot be`);if(m+(u-1)*(f.stride||h)+h>f.length)throw o.wrong(`outside its buffer view`);if((m+f.offset)%Vg[s])throw o.wrong(`not aligned`);return{view:d,offset:m,count:u,items:l,type:s,where:o.where}}}function qg(e,t,n){let r=typeof t.raw==`number`&&Hg.has(e),i=Pg(e,r?new Ig(void 0,t.where):t.key(`codec`),Ng[e]);return{view:n(r?t:t.key(`bufferView`)),codec:i,where:t.where}}async function Jg(e,t,n){let r=await n(e.view),i=t[e.view]?.length??1/0;if(r.byteLength<i)throw mf(e.where);let{offset:a,count:o,items:s,type:c}=e,l=r.slice(a,a+Vg[c]*o*s);return c===5125?new Uint32Array(l):c===5123?new Uint16Array(l):Yg(new Float32Array(l),e.where)}function Yg(e,t){for(let n of e)if(!(Math.abs(n)<=1e30))throw Q(t,`${n} among its numbers`);return e}var Xg=8,Zg=16,Qg=`av1-10bit-2`;function $g(e,t){return new ff(`unsupported`,`The scene has ${e}, which this viewer does not draw; draw it with "eigenfield render".`,t)}function e_(e,t=jf){let[n=0,r=0]=e.items(2).map(e=>e.integer(1,t));if(!n||!r)throw e.wrong(`two numbers are needed`);if(n*r>Nf)throw e.wrong(`more than ${Nf} texels`);return[n,r]}function t_(e,t,n,r,i){let a=e.key(`planes`).items(16);if(!a.length)throw e.key(`planes`).wrong(`no plane`);let o=a.map((e,a)=>{let o=e.key(`channels`).integer(1,64),s=f_(e,o,a===0?n:null,i),c=e.key(`bases`).items(64),l=e=>h_(e,o,t,r,i);return{channels:o,...s,bases:c.map(l)}}),[s,c]=[0,0];for(let{channels:e,meanSize:t,bases:n}of o){s+=4*e*(t?t[0]*t[1]:0);for(let{size:t,count:r,pictures:i}of n){let n=i.reduce((e,{textures:t,codec:n})=>e+t*(n.bits===Xg?1:2),0);s+=t[0]*t[1]*e*n,c+=r}}if(c>4096)throw e.key(`planes`).wrong(`more than ${Pf} textures`);if(s>Ff)throw e.key(`planes`).wrong(`too large when it is decoded`);return o}function n_(e,t){let n=t.reduce((e,{channels:t})=>e+t,0),r=e.key(`toRGB`);if(r.exists){let e=r.numbers(3*n),t=(t,r)=>e[t*n+r]??0;return Array.from({length:n},(e,n)=>[t(0,n),t(1,n),t(2,n)])}if(t.length===1&&n===1)return[[1,1,1]];if(t.length===1&&n===3)return[[1,0,0],[0,1,0],[0,0,1]];throw $g(`${t.length>1?`${t.length} planes`:`${n} channels`} and no colours for them`,`${e.where}/planes`)}function r_(e,t,n,r,i,a=!1){let o=i_(e),s=t===3&&o.bits===Xg?1:t;r&&g_(e,s*n,r);let[c,l]=[e.key(`scale`),e.key(`zero`)],u={view:i(e.key(`bufferView`)),codec:o,textures:n,pieces:s,where:e.where,part:null};return a&&o.bits===Xg&&!c.exists&&!l.exists?{...u,...s_(t)}:{...u,scale:d_(c,t,n),zero:d_(l,t,n)}}function i_(e){let t=e.key(`mimeType`).text(zf);if(!Fg(t))throw e.key(`mimeType`).wrong(`an unknown type`);let n=e.key(`bits`),r=n.exists?n.integer(1,Zg):Xg,i=Fg(t,r);if(!i)throw n.wrong(`${r} bits of ${t}`);let a=e.key(`codec`),o=Pg(`picture`,a,i);if(o.mimeType!==t||o.bits!==r)throw a.wrong(`${r} bits of ${t}`);return o}function a_(e,t,n){let r=e.key(`at`).items(Pf*t).map(e=>{let[t=0,n=0]=e.numbers(2,0,Uf);if(!Number.isInteger(t)||!Number.isInteger(n))throw e.wrong(`no whole numbers`);return[t,n]});if(!r.length||r.length%t)throw e.key(`at`).wrong(`places of ${t} channels are needed`);let{where:i}=e,a={film:e.key(`film`).integer(0,3),size:n,at:r,where:i},o={scale:Array(r.length).fill(0),zero:Array(r.length).fill(0)};return{view:-1,codec:Mg[Qg],textures:r.length/t,pieces:t,where:i,part:a,...o}}function o_(e,t,n){let r=a_(e,t,n);if(r.textures!==1)throw e.key(`at`).wrong(`${t} places are needed`);return r}function s_(e){return{scale:Array(e).fill(1/255),zero:Array(e).fill(0)}}function c_(e){return e.some(({codec:e})=>e.bits>Xg)}function l_({codec:e}){return(2**e.bits-1)/255}function u_(e,t){return t?1:1/(255*l_(e))}function d_(e,t,n){let r=e.items(t*n).map(e=>e.number());if(r.length===t*n)return r;if(r.length!==t)throw e.wrong(`${t} or ${t*n} numbers are needed`);return Array(n).fill(r).flat()}function f_(e,t,n,r){let i=e.key(`mean`);if(!i.exists){if(n===null||t!==1&&t!==3)throw i.wrong(`no mean`);return{mean:{view:n,codec:Mg.png,textures:1,pieces:1,where:`/images/0`,part:null,...s_(t)},meanSize:null,precision:null}}let a=e_(i.key(`size`));if(i.key(`film`).exists)return{mean:o_(i,t,a),meanSize:a,precision:null};let o=r_(i,t,1,a,r,!0);return{mean:o,meanSize:a,precision:m_(i.key(`precision`),o,r)}}function p_(e,t){let n=e_(e.key(`size`)),r=e.key(`film`).exists?o_(e,1,n):(()=>{let r=i_(e);return g_(e,1,n),{view:t(e.key(`bufferView`)),codec:r,textures:1,pieces:1,where:e.where,part:null}})();return{channels:1,mean:{...r,scale:[1/(2**r.codec.bits-1)],zero:[0]},meanSize:n,precision:null}}function m_(e,t,n){if(!e.exists)return null;if(t.codec.bits===Xg)throw e.wrong(`of a mean of ${Xg} bits`);let r=e_(e.key(`size`),Mf),i=Pg(`picture`,e.key(`codec`),`png`);if(i!==Mg.png)throw e.key(`codec`).wrong(`no PNG`);return{view:n(e.key(`bufferView`)),codec:i,size:r,textures:1,pieces:1,where:e.where}}function h_(e,t,n,r,i){let a=e_(e.key(`size`)),[o,s]=[e.key(`grid`),e.key(`corner`)],c=o.exists?e_(o):a,[l=0,u=0]=s.exists?s.numbers(2,0,jf):[];if(!Number.isInteger(l)||!Number.isInteger(u))throw s.wrong(`no whole numbers`);if(l+a[0]>c[0]||u+a[1]>c[1])throw e.wrong(`textures beyond their grid`);let d=e.where;if(e.key(`film`).exists){let n=a_(e,t,a),{textures:r}=n;if(r>4096)throw e.wrong(`more than ${Pf} textures`);return{size:a,grid:c,corner:[l,u],pictures:[n],count:r,weights:null,where:d}}let f=0,p=e.key(`picture`),m=p.exists?p.object():{},h=e.key(`textures`).items(Pf).map(e=>{let n=new Ig({...m,...e.object()},e.where),r=n.key(`count`),o=r.exists?r.integer(1,Pf):1;return f+=o,r_(n,t,o,a,i)});if(f>4096)throw e.wrong(`more than ${Pf} textures`);let g=e.key(`codedWeights`),_=f?g.exists?qg(`weights`,g,i):r(e.key(`weights`),`SCALAR`,[Bg],n*f):null;return{size:a,grid:c,corner:[l,u],pictures:h,count:f,weights:_,where:d}}function g_(e,t,[n,r]){let i=t*r;if(t>1&&i>32768)throw e.wrong(`a picture of ${i} rows`);if(n*i>Nf)throw e.wrong(`more than ${Nf} texels`)}var __=`KHR_xmp_json_ld`,v_=/[\p{Cc}\p{Cs}\p{Zl}\p{Zp}\u202a-\u202e\u2066-\u2069]/u;function y_(e){let t=x_(e,`asset`,`extensions`,__,`packet`),n=x_(e,`extensions`,__,`packets`),r=Array.isArray(n)&&typeof t==`number`?n[t]:void 0,i=e=>{let t=b_(x_(r,e))??``;return[...t].length>1e3||v_.test(t)?``:t};return{title:i(`dc:title`),author:i(`dc:creator`),licence:i(`dc:rights`),source:i(`dc:source`)}}function b_(e){let t=x_(e,`@list`)??x_(e,`@set`);if(Array.isArray(t)&&t.every(e=>typeof e==`string`))return t.join(`, `);let n=typeof e==`string`?e:x_(e,`rdf:_1`,`@value`);return typeof n==`string`?n:null}function x_(e,...t){for(let n of t){if(typeof e!=`object`||!e||Array.isArray(e)||!Object.hasOwn(e,n))return;e=e[n]}return e}function S_(e,t){if(!e.exists)return null;let n=e.key(`faces`).items(32).map(e=>e.integer(1,Hf));if(!n.length)throw e.key(`faces`).wrong(`no sheet`);return{faces:n,opacity:p_(e.key(`opacity`),t),where:e.where}}function C_({faces:e,where:t},{index:n,attributes:r}){let i=e.reduce((e,t)=>e+t,0),a=(n?.count??0)/3;if(i!==a)throw Q(`${t}/faces`,`the sheets have ${i} triangles, the mesh has ${a}`);let o=new Uint8Array(r.position?.count??0),s=0;e.forEach((e,r)=>{for(let i=s+3*e;s<i;s++){let e=n?.getX(s)??0,i=o[e]||r+1,a=`sheets ${i-1} and ${r} share vertex ${e}`;if(i!==r+1)throw Q(`${t}/faces`,a);o[e]=i}})}var w_=64,T_=16,E_=`audio/ogg`,D_=`sound.opus`,O_=/^[0-9a-f]{64}$/;function k_(e,t,n){let r=[...P_(t),...n?[n]:[]];if(!e.exists){let e=r.find(({part:e})=>e);if(e)throw Q(e.where,`a texture in a film, and no timeline`);return null}let[i=1,a=1]=e.key(`rate`).numbers(2,1,Qf),o=i/a;if(!(Number.isInteger(i)&&Number.isInteger(a))||o>1e3||o<1/1e3)throw e.key(`rate`).wrong(`no rate`);let s=e.key(`first`),c=e.key(`films`).items(4).map(j_),l=e.key(`frames`).integer(1,Kf);F_(r,c);let u=new Set([...t.map(({mean:e})=>e),n].map(e=>c[e?.part?.film??-1]));for(let e of c)e.opacity=e===c[n?.part?.film??-1],e.detail=!u.has(e);let d=N_(e,l);return{rate:o,first:s.exists?s.number():0,frames:l,films:c,groups:d,sound:A_(e,d)}}function A_(e,t){let n=e.key(`audio`);if(!n.exists)return null;if(n.key(`mimeType`).text(64)!==E_)throw n.key(`mimeType`).wrong(`no ${E_}`);let r=t.at(-1),i=r.file===null?null:D_,a=i?0:M_(n.key(`offset`),r.offset+r.length),o=n.key(`first`),s=n.key(`length`).integer(1,Zf);return{mimeType:E_,first:o.exists?o.number():0,offset:a,length:s,file:i}}function j_(e){let t=Pg(`film`,e.key(`codec`),`film-1`),[n=0,r=0]=e.key(`size`).numbers(2,w_,Uf);if(n%w_||r%w_||n*r>Wf)throw e.key(`size`).wrong(`a film of ${n} x ${r}`);return{codec:t,size:[n,r],opacity:!1,detail:!1,where:e.where}}function M_(e,t){let n=e.integer(t,2**53-1);if(n%4)throw e.wrong(`no multiple of 4`);return n}function N_(e,t){let[n,r]=[0,0],i=e.key(`groupFiles`);if(i.exists&&i.raw!==!0)throw i.wrong(`not true`);let a=e.key(`groups`).items(qf).map((e,t)=>{let a=i.exists?`groups/${String(t).padStart(5,`0`)}.eftg`:null,o=e.key(`frames`).integer(1,Yf),s=e.key(`length`).integer(1,Jf),c=a?0:M_(e.key(`offset`),r),l=e.key(`sha256`).text(64);if(!O_.test(l))throw e.key(`sha256`).wrong(`no SHA-256`);return[n,r]=[n+o,c+s],{first:n-o,frames:o,offset:c,length:s,file:a,sha256:l,where:e.where}});if(n!==t)throw e.key(`groups`).wrong(`${n} frames in groups, and ${t} in all`);return a}function P_(e){return e.flatMap(({mean:e,bases:t})=>[e,...t.flatMap(e=>e.pictures)])}function F_(e,t){let n=t.map(({size:e})=>new Uint8Array(e[0]*e[1]/T_**2));for(let{part:r,where:i}of e){let e=r&&t[r.film];if(!r||!e)throw Q(i,`it lies in no film`);let[a,o]=[e.size[0]/T_,n[r.film]],[s,c]=r.size.map(e=>Math.ceil(e/T_));for(let[t,n]of r.at){let l=t+r.size[0]<=e.size[0]&&n+r.size[1]<=e.size[1];if(t%T_||n%T_||!l)throw Q(i,`a texture at ${t}, ${n} of its film`);for(let e=n/T_;e<n/T_+c;e++){let r=o.subarray(e*a+t/T_,e*a+t/T_+s);if(r.includes(1))throw Q(i,`two textures at ${t}, ${n} of a film`);r.fill(1)}}}}function I_({rate:e,first:t,frames:n},r){return Math.min(Math.max(Math.floor((r-t)*e+.5),0),n-1)}function L_({rate:e,first:t},n){return t+n/e}function R_({groups:e},t){let[n,r]=[0,e.length-1];for(;n<r;){let i=n+r+1>>1;(e[i]?.first??1/0)<=t?n=i:r=i-1}return n}var z_=[`groupFiles`,`namePattern`,`noFallback`,`packed`,`precision`,`regions`,`sharedPicture`,`sheets`,`stacks`,`timeline`,`toRGB`],B_=Object.values(Mg).flatMap(({needs:e})=>e??[]),V_=new Set([...z_,...B_]),H_=64,U_=9,W_=10**U_;function G_(e){let t=new Ig(e,``);try{return t.key(`extensions`).key(Of).exists}catch{return!1}}function K_(e){let t=new Ig(e,``),n=t.key(`extensions`).key(Of),r=Y_(n),i=Wg(t),a=Kg(t,i),o=Gg(i);X_(t);let s=$_(t,o),c=n.key(`cameras`),{count:l,names:u}=ev(c,o),d=rv(c,l),f=d.filter(e=>!e).length,p=t_(n,f,s,a,o),m=n_(n,p),h=c.key(`colour`),g=c.key(`codedColour`);if((h.exists||g.exists)&&m.length<3)throw h.wrong(`needs three channels`);let _=n.key(`viewPlane`),[v,y]=[_.key(`triangles`),_.key(`codedTriangles`)],b=n.key(`generator`),[x,S]=[n.key(`mesh`),n.key(`timeline`)],C=S_(n.key(`sheets`),o);return{version:r,generator:b.exists?b.text(zf):``,rights:y_(e),planes:p,colours:m,names:u,heldOut:d,reference:n.key(`reference`).integer(0,l-1),calibration:iv(c,l,a,o),sizes:av(c,l,a),colour:g.exists?qg(`weights`,g,o):h.exists?a(h,`SCALAR`,[Bg],6*l):null,...ov(_),triangles:y.exists?qg(`triangles`,y,o):v.exists?Q_(a(v,`SCALAR`,[Rg,zg],null),2*If):null,settings:sv(n.key(`settings`)),scores:sv(n.key(`scores`)),views:i,mesh:x.exists||S.exists?qg(`mesh`,x,o):null,sheets:C,shown:x.exists&&!t.key(`meshes`).exists?null:q_(t,a),preview:s,timeline:k_(S,p,C&&C.opacity.mean)}}function q_(e,t){let n=e.key(`meshes`).at(0).key(`primitives`).at(0),r=n.key(`mode`);if(r.exists&&r.integer(0,6)!==4)throw r.wrong(`no triangles`);let[i,a]=[n.key(`attributes`),n.key(`indices`)];return{position:Z_(t(i.key(`POSITION`),`VEC3`,[Bg],null),Vf),uv:Z_(t(i.key(`TEXCOORD_0`),`VEC2`,[Bg],null),Vf),indices:Q_(t(a,`SCALAR`,[Lg,Rg,zg],null),Hf)}}function J_({planes:e,sheets:t}){return t?[...e,t.opacity]:e}function Y_(e){let t=e.key(`version`).text(zf);if(!/^1\.\d+$/.test(t))throw new ff(`version`,`The scene is of format version ${t.slice(0,20)} and this viewer reads 1.x; take a newer viewer.`,`${e.where}/version`);let n=e.key(`needs`);for(let e of n.exists?n.items(Af):[]){let t=e.text(zf);if(!V_.has(t))throw new ff(`needs`,`The scene needs "${t.slice(0,60)}", which this viewer cannot draw; take a newer viewer.`,e.where)}return t}function X_(e){let t=e.key(`nodes`).items(Af),n=Array(t.length).fill(!1);for(let e of t){let r=e.key(`children`);for(let e of r.exists?r.items(t.length):[]){let r=e.integer(0,t.length-1);if(n[r])throw e.wrong(`a node with two parents`);n[r]=!0}}for(let r of e.key(`scenes`).items(Af)){let e=r.key(`nodes`);for(let r of e.exists?e.items(t.length):[])if(n[r.integer(0,t.length-1)])throw r.wrong(`a node with two parents`)}}function Z_(e,t){if(e.count>t)throw Q(e.where,`more than ${t}`);return e}function Q_(e,t){if(e.count%3)throw Q(e.where,`torn triangles`);return Z_(e,3*t)}function $_(e,t){let n=e.key(`images`);if(!n.exists)return null;let r=n.at(0).key(`bufferView`);return r.exists?t(r):null}function ev(e,t){let n=e.key(`codedNames`);if(n.exists)return{count:n.key(`count`).integer(1,If),names:qg(`names`,n,t)};let r=e.key(`pattern`),i=r.exists?r:e.key(`names`),a=r.exists?nv(r):i.items(If).map(e=>e.text(zf));if(!a.length)throw i.wrong(`no cameras`);let o=tv(a);if(o)throw i.wrong(o);return{count:a.length,names:a}}function tv(e){return new Set(e).size===e.length?e.some(e=>/[\u0000-\u001f\u007f-\u009f]/.test(e))?`control characters`:null:`a name stands twice`}function nv(e){let[t=0,n=0]=e.key(`counts`).items(2).map(e=>e.integer(1,If));if(!n||t*n>1e5)throw e.wrong(`no counts of rows and columns`);let r=e.key(`parts`).items(H_).map(e=>{if(typeof e.raw==`string`)return[0,Array(t).fill(e.text(zf))];let r=e.key(`axis`).integer(0,1),i=r?n:t,a=e.key(`texts`);if(a.exists){let e=a.items(i).map(e=>e.text(zf));if(e.length!==i)throw a.wrong(`${i} texts are needed`);return[r,e]}let[o,s]=[e.key(`first`).integer(0,W_),e.key(`step`).integer(0,W_)],c=e.key(`digits`).integer(1,U_);return[r,Array.from({length:i},(e,t)=>String(o+s*t).padStart(c,`0`))]});return Array.from({length:t*n},(t,i)=>{let a=[Math.floor(i/n),i%n],o=r.map(([e,t])=>t[a[e]??0]).join(``);if(o.length>1024)throw e.wrong(`names of more than ${zf} characters`);return o})}function rv(e,t){let n=Array(t).fill(!1),r=e.key(`heldOut`);if(!r.exists)return n;for(let e of r.items(t)){let r=e.integer(0,t-1);if(n[r])throw e.wrong(`named twice`);n[r]=!0}if(n.every(e=>e))throw r.wrong(`all cameras are held out`);return n}function iv(e,t,n,r){let i=e.key(`coded`);return i.exists?qg(`cameras`,i,r):{intrinsics:n(e.key(`intrinsics`),`SCALAR`,[Bg],5*t),poses:n(e.key(`poses`),`SCALAR`,[Bg],12*t)}}function av(e,t,n){let r=e.key(`size`);if(!r.exists)return n(e.key(`sizes`),`SCALAR`,[zg],2*t);let[i=0,a=0]=r.numbers(2,1,Lf);if(!Number.isInteger(i)||!Number.isInteger(a))throw r.wrong(`no whole numbers`);return[i,a]}function ov(e){let[t,n]=[e.key(`right`).triple(),e.key(`up`).triple()],r=(e,t)=>e.reduce((e,n,r)=>e+n*(t[r]??0),0);for(let i of[r(t,t)-1,r(n,n)-1,r(t,n)])if(!(Math.abs(i)<=2e-4))throw e.wrong(`axes not at right angles, or not of length 1`);let[i=0,a=0]=e.key(`extent`).numbers(2,0);return{origin:e.key(`origin`).triple(),right:t,up:n,extent:[i,a]}}function sv(e){return e.exists?e.object():{}}var cv=1e-6;async function lv(e,t){let[n,{lenses:r,poses:i},a,o]=await Promise.all([dv(e,t),pv(e,t),mv(e,t),uv(e,t)]);return n.map((t,n)=>{let[s=0,c=0,l=0,u=0,d=0]=r.numbers.subarray(5*n,5*n+5);if(!(s>cv&&c>cv))throw Q(r.where,`focal lengths of "${t}"`);let{R:f,t:p}=hv([...i.numbers.subarray(12*n,12*n+12)],i.where,t),[m=0,h=0]=a.numbers.subarray(2*n,2*n+2);if(!m||!h||Math.max(m,h)>65535||m*h>Rf)throw Q(a.where,`"${t}" is ${m} x ${h} pixels`);let g=[[s,l,u],[0,c,d],[0,0,1]],[_,v]=o?gv([...o.subarray(6*n,6*n+6)],e,t):[null,null];return{name:t,K:g,R:f,t:p,centre:kv(f,p),width:m,height:h,gain:_,offset:v}})}async function uv({colour:e,heldOut:t,views:n},r){if(!e||`type`in e)return e&&Jg(e,n,r);let{cameras:i,components:a,values:o}=await e.codec.decode(new Uint8Array(await r(e.view)),e.where);if(a!==6||i!==t.filter(e=>!e).length)throw Q(e.where,`${i} x ${a} colours`);let s=0;return Float32Array.from(t.flatMap(e=>e?[1,1,1,0,0,0]:[...o.subarray(6*s,6*++s)]))}async function dv({names:e,heldOut:t},n){if(Array.isArray(e))return e;let r=await e.codec.decode(new Uint8Array(await n(e.view)),t.length,e.where),i=r.some(e=>e.length>1024)?`names that are too long`:tv(r);if(i)throw Q(e.where,i);return r}async function fv(e,t,n){return{numbers:await Jg(e,t.views,n),where:e.where}}async function pv(e,t){let{calibration:n,heldOut:r}=e;if(`intrinsics`in n){let{intrinsics:r,poses:i}=n;return{lenses:await fv(r,e,t),poses:await fv(i,e,t)}}let{view:i,codec:a,where:o}=n,s=await a.decode(new Uint8Array(await t(i)),o),c=s.poses.length/12;if(c!==r.length)throw Q(o,`${c} cameras in it, and ${r.length} names`);let l=e=>({numbers:Yg(e,o),where:o});return{lenses:l(s.intrinsics),poses:l(s.poses)}}async function mv(e,t){if(!Array.isArray(e.sizes))return fv(e.sizes,e,t);let[n,r]=e.sizes;return{numbers:Uint32Array.from({length:2*e.heldOut.length},(e,t)=>t%2?r:n),where:`its cameras' size`}}function hv(e,t,n){let r=t=>[e[4*t]??NaN,e[4*t+1]??NaN,e[4*t+2]??NaN],i=[r(0),r(1),r(2)],a=[e[3]??NaN,e[7]??NaN,e[11]??NaN];for(let e=0;e<3;e++)for(let r=e;r<3;r++){let a=Av(i[e],i[r])-+(e===r);if(!(Math.abs(a)<=2e-4))throw Q(t,`the pose of "${n}" is no rotation`)}if(!(Av(jv(i[0],i[1]),i[2])>0))throw Q(t,`the pose of "${n}" is mirrored`);return{R:i,t:a}}function gv(e,t,n){let[r,i]=[e.slice(0,3),e.slice(3)];if(!(r.every(e=>e>=1/1e3&&e<=1e3)&&i.every(e=>Math.abs(e)<=1e3)))throw Q(t.colour?.where??``,`gain or offset of "${n}"`);return[r,i]}async function _v(e,t){let n=e.heldOut.filter(e=>!e).length;return vv(n,await Promise.all(xv(e).map(r=>yv(r,n,e,t))))}function vv(e,t){let n=t.reduce((e,{length:t})=>e+t,0)/e,r=new Float32Array(e*n),i=0;for(let a of t){let t=a.length/e;for(let o=0;o<e;o++)r.set(a.subarray(o*t,(o+1)*t),o*n+i);i+=t}return r}async function yv({weights:e,count:t},n,r,i){if(!e)return new Float32Array;if(`type`in e)return Jg(e,r.views,i);let{view:a,codec:o,where:s}=e;return bv(o.decode(new Uint8Array(await i(a)),s),n,t,s)}function bv({cameras:e,components:t,values:n},r,i,a){if(e===r&&t===i)return Yg(n,a);throw Q(a,`${e} x ${t} weights, and ${r} encoded cameras x ${i} textures`)}function xv(e){return e.planes.flatMap(({bases:e})=>e)}function Sv(e){return Math.max(0,...xv(e).map(({count:e})=>e))}function Cv(e,t){let n=[...t.slice(0,e.planes.length),...xv(e).map(({grid:e})=>e)];return[Math.max(...n.map(([e])=>e)),Math.max(...n.map(([,e])=>e))]}async function wv(e,t){if(!e.triangles)return new Uint32Array;let{where:n}=e.triangles,r=await Tv(e.triangles,e,t),i=e.heldOut.filter(e=>!e).length;for(let e=0;e<r.length;e+=3){let[t=i,a=i,o=i]=r.subarray(e,e+3);if(Math.max(t,a,o)>=i)throw Q(n,`no encoded camera ${Math.max(t,a,o)}`);if(t===a||a===o||o===t)throw Q(n,`a triangle with one camera twice`)}return r}async function Tv(e,t,n){return`type`in e?Uint32Array.from(await Jg(e,t.views,n)):e.codec.decode(new Uint8Array(await n(e.view)),e.where).corners}function Ev(e,t,n,r,i,a){let{right:o,up:s}=e,c=jv(o,s),l=[0,0,0];for(let{R:e}of t)for(let n=0;n<3;n++)l[n]+=e[2][n]/t.length;let u=e.settings.metresPerUnit;return{version:e.version,generator:e.generator,rights:e.rights,names:t.map(({name:e})=>e),heldOut:e.heldOut,reference:e.reference,cameras:t,viewPlane:{origin:e.origin,right:o,up:s,normal:c,extent:e.extent},grid:r&&{rows:r.rows,columns:r.columns},settings:e.settings,scores:e.scores,metresPerUnit:typeof u==`number`&&u>0&&u<=1e30?u:null,bytes:Dv(e,i),size:Cv(e,n),planes:e.planes.map(({channels:e,bases:t},r)=>({channels:e,mean:n[r]??[1,1],bases:t.map(({count:e,size:t,grid:n})=>({textures:e,size:t,grid:n}))})),...a,mixedColours:e.colour!==null&&!(`type`in e.colour),sheets:e.sheets?.faces.length??0,inFiles:e.timeline?.groups.some(({file:e})=>e!==null)??!1,facesPlane:Math.abs(Av(l,c))>.7}}function Dv(e,t){let n=new Set,r=t=>n.has(t)?0:(n.add(t),e.views[t]?.length??0),i=e=>e.reduce((e,t)=>e+r(t),0),a=e.planes.flatMap(({mean:e,precision:t})=>[e.view,...t?[t.view]:[]]),o=i(e.preview===null?a:[e.preview,...a]),s=Array(Sv(e)).fill(0);for(let{pictures:t}of xv(e)){let e=0;for(let{view:n,textures:i}of t){let t=r(n);for(let n=0;n<i;n++){let r=Math.floor(t*(n+1)/i)-Math.floor(t*n/i);s[e]=(s[e++]??0)+r}}}let c=i(xv(e).flatMap(e=>e.weights?[e.weights.view]:[])),l=i([...Object.values(e.shown??{}),...e.mesh?[e.mesh]:[]].map(({view:e})=>e)),u=e.sheets?r(e.sheets.opacity.mean.view):0,d=e.timeline?.groups.reduce((e,{length:t})=>e+t,0)??0;return{total:t,mesh:l,opacity:u,mean:o,weights:c,groups:d,other:t-o-c-l-u-d-s.reduce((e,t)=>e+t,0),textures:s}}function Ov(e,t){let{origin:n,extent:r}=e,i=[t[0]-n[0],t[1]-n[1],t[2]-n[2]];return[r[0]>0?Av(i,e.right)/r[0]:0,r[1]>0?Av(i,e.up)/r[1]:0]}function kv(e,t){let n=n=>-(e[0][n]*t[0]+e[1][n]*t[1]+e[2][n]*t[2]);return[n(0),n(1),n(2)]}function Av(e,t){return e[0]*t[0]+e[1]*t[1]+e[2]*t[2]}function jv(e,t){return[e[1]*t[2]-e[2]*t[1],e[2]*t[0]-e[0]*t[2],e[0]*t[1]-e[1]*t[0]]}function Mv(e,t,n){let{info:r}=e,i=r.cameras.filter((e,t)=>!r.heldOut[t]),a=r.cameras[r.reference];if(!a)throw RangeError(`no camera ${r.reference}`);let{width:o,height:s}=a,c=[[0,0,0],[0,0,0],[0,0,1]],l=[[0,0,0],[0,0,0],[0,0,0]];e.viewWeights(t,n,`delaunay`).forEach((e,t)=>{let n=i[t];if(!e||!n)return;let r=Nv(n,o,s);for(let t of[0,1,2])for(let i of[0,1,2])t<2&&(c[t][i]+=e*r[t][i]),l[t][i]+=e*n.R[t][i]});let u=Fv(l),{origin:d,right:f,up:p,extent:m}=r.viewPlane,[h,g]=[Pv(t)*m[0],Pv(n)*m[1]],_=[0,1,2].map(e=>d[e]+h*f[e]+g*p[e]),v=u.map(e=>-Av(e,_));return{name:`${t.toFixed(3)}, ${n.toFixed(3)}`,K:c,R:u,t:v,centre:_,width:o,height:s,gain:null,offset:null}}function Nv({K:e,width:t,height:n},r,i){let a=Math.max(r/t,i/n),[o,s]=[(r-a*t)/2,(i-a*n)/2];return[[a*e[0][0],a*e[0][1],a*e[0][2]+o],[0,a*e[1][1],a*e[1][2]+s],[0,0,1]]}function Pv(e){return Math.min(1,Math.max(-1,e))}function Fv(e){let t=e;for(let e=0;e<50;e++){let e=[jv(t[1],t[2]),jv(t[2],t[0]),jv(t[0],t[1])],n=Av(t[0],e[0]);if(!(n>1e-12))break;let r=t.map((t,r)=>t.map((t,i)=>(t+e[r][i]/n)/2)),i=Math.max(...r.flatMap((e,n)=>e.map((e,r)=>Math.abs(e-t[n][r]))));if(t=r,i<1e-15)break}return t}function Iv(e,t,n,r,i=1){let a=n.width/n.height,o=i*Math.min(1,a/r),s=i*Math.min(1,r/a),c={left:(1-o)/2,top:(1-s)/2,width:o,height:s};return Lv(e,t,n),Rv(e,t,n,c),t.aspect=r,t.fov=2*Math.atan(n.height/(2*n.K[1][1]*s))*180/Math.PI,c}function Lv(e,t,n){let{R:r,centre:i}=n,a=new K().set(r[0][0],-r[1][0],-r[2][0],i[0],r[0][1],-r[1][1],-r[2][1],i[1],r[0][2],-r[1][2],-r[2][2],i[2],0,0,0,1);e.mesh.updateWorldMatrix(!0,!1),a.premultiply(e.mesh.matrixWorld),t.parent&&(t.parent.updateWorldMatrix(!0,!1),a.premultiply(t.parent.matrixWorld.clone().invert())),a.decompose(t.position,t.quaternion,new W),t.updateMatrixWorld(!0)}function Rv(e,t,n,r){let[[i,a,o],[,s,c]]=n.K,[l,u]=[2*r.width/n.width,2*r.height/n.height],[d,f]=zv(e,n);t.near=d,t.far=f,t.projectionMatrix.set(l*i,-l*a,-(2*r.left-1+l*o),0,0,u*s,-(1-2*r.top-u*c),0,0,0,-(f+d)/(f-d),-2*f*d/(f-d),0,0,-1,0),t.projectionMatrixInverse.copy(t.projectionMatrix).invert()}function zv(e,t){let{geometry:n,matrixWorld:r}=e.mesh;n.boundingSphere||n.computeBoundingSphere();let{center:i,radius:a}=n.boundingSphere??{center:new W,radius:1},o=r.getMaxScaleOnAxis(),s=i.distanceTo(new W(...t.centre))*o,c=1.01*(s+a*o);return[Math.max(.5*(s-a*o),c*2e-4),c]}function Bv(e){let[t,n]=[[1,1,1],[0,0,0]];for(let[r,i]of e)if(r?.gain&&r.offset)for(let e=0;e<3;e++){let a=1/(r.gain[e]??1);t[e]=(t[e]??1)+i*(a-1),n[e]=(n[e]??0)-i*a*(r.offset[e]??0)}return{scale:t,bias:n}}var Vv=4/3,Hv=Xv({components:4,halves:!0}),Uv={components:4,halves:!1},Wv={components:2,halves:!1},Gv={components:2,halves:!0},Kv=16,qv=2**20,Jv=1/64,Yv=34;function Xv({components:e,halves:t}){return(e>2?4:e)*(t?2:1)}function Zv(){let e=typeof navigator>`u`?void 0:navigator,t=e?.deviceMemory,n=e?.userAgent??``;return/Mobi|Android|iPhone|iPad|Quest/i.test(n)||/Macintosh/.test(n)&&Qv(e)?Math.min(t??4,6)*128*qv:Math.min(t??8,8)*256*qv}function Qv(e){return(e?.maxTouchPoints??0)>1}function $v([e,t],n){return[Math.ceil(e/n),Math.ceil(t/n)]}function ey(e,t){let[n,r]=$v(e,t);return n*r}function ty(e){return Math.ceil(e/4)}function ny(e,t){return t*ry(e)}function ry(e){return Math.max(1,Math.ceil(e/4))}function iy(e){let{atlas:t,means:n,bases:r}=e,i=[t,...n.map(({size:e})=>e),...r.map(({grid:e})=>e)];return[...new Map(i.map(e=>[e.join(),e])).values()]}var ay=[1,1.5,2,3,4,6,8,12,16],oy={meanDown:1,scaleDown:1,halves:!0,words:!1},sy=[oy,...ay.flatMap(e=>[1,1.5,2].map(t=>({meanDown:e,scaleDown:t*e,halves:!1,words:!1})))];function cy(e,t){let n=Math.max(0,...e.bases.map(({count:e})=>e)),r=Math.max(1,...e.bases.map(e=>e.channels)),i=Math.min(n,4*Math.floor(t.layers/r)),a=(t,n)=>ly(e,t.meanDown)+e.geometry+uy(e,t,n),o=(n,r)=>a(n,r)+py(e,n,t.memory)<=t.memory,s=Math.max(1,...e.atlas,...e.bases.flatMap(({size:e})=>e)),c=Math.max(r,...e.means.map(e=>e.channels)),l=n*r<=t.layers&&c<=Kv,u=[...e.films&&l?[{...oy,words:!0}]:[],...sy].filter(({meanDown:e})=>s/e<=t.side),d=u.length?i:0,f=u.find(e=>o(e,d));for(;!f&&d>0;d--)f=u.find(e=>o(e,d-1));f??=sy.at(-1);let p=my({...f,usable:d},e),m=hy(p,e,t);return{...f,usable:d,bytes:a(f,d),reductions:p,limitation:m}}function ly(e,t){let n=e.means.map(({size:e,channels:n,tenBits:r,opacity:i})=>{let a=i?Hv:0;return(Xv({components:n,halves:r})*ty(n)+a)*ey(e,t)}),r=iy({...e,means:e.means.filter(({opacity:e})=>!e)}).map(n=>{let r=n.join()===e.atlas.join()?Vv:1,i=e.rays&&e.bases.some(({grid:e})=>e.join()===n.join());return Hv*ey(n,t)*(r+ +!!i)});return Math.round([...n,...r].reduce((e,t)=>e+t,0))}function uy({bases:e,rays:t},{scaleDown:n,halves:r},i){return e.reduce((e,a)=>{let o=Math.min(i,a.count);if(!o)return e;let s=t?ry(o)*129*129*Hv:0;return e+Xv({components:o,halves:r&&a.tenBits})*ny(o,a.channels)*ey(a.size,n)+s},0)}function dy({means:e,bases:t},{meanDown:n,scaleDown:r},i){let a=e.filter(({pieces:e,tenBits:t})=>e>1||t||n>1),o=t.filter(({count:e})=>e>0),[s,c]=fy([...a,...o].map(({size:e})=>e)),l=Math.floor(Jv*i/(Xv(Uv)*s)),u=[s,Math.min(c,Math.max(Yv,l))],d=[...n>1?a.map(e=>$v(e.size,n)):[],...r>1?o.map(e=>$v(e.size,r)):[]];return{picture:{size:u,format:Uv},codes:[...a,...o].some(({tenBits:e})=>e)?{size:u,format:Wv}:null,smaller:d.length?{size:fy(d),format:Gv}:null}}function fy(e){return[Math.max(1,...e.map(([e])=>e)),Math.max(1,...e.map(([,e])=>e))]}function py(e,t,n){if(t.words)return 0;let r=Object.values(dy(e,t,n)).map(e=>e?Xv(e.format)*ey(e.size,1):0),i=t.scaleDown>1?Math.max(...iy(e).map(e=>ey(e,1))):0;return[...r,i].reduce((e,t)=>e+t,0)}function my({usable:e,meanDown:t,scaleDown:n,halves:r},i){let a=Math.max(0,...i.bases.map(({count:e})=>e)),o=[];return e<a&&o.push({kind:`count`,part:e,whole:a}),e&&n>1&&o.push({kind:`scale`,percent:Math.round(100/n)}),e&&!r&&i.bases.some(({tenBits:e})=>e)&&o.push({kind:`bits`}),t>1&&o.push({kind:`mean`,percent:Math.round(100/t)}),o}function hy(e,t,n){if(!e.length)return null;let r=e.map(e=>e.kind===`count`?`${e.part} of ${e.whole} eigen textures are drawn`:e.kind===`bits`?`eigen textures have 8 bits`:`${e.kind===`mean`?`the mean texture has`:`eigen textures have`} ${e.percent} % of ${e.kind===`mean`?`its`:`their`} width and height`),i=ly(t,1)+uy(t,oy,1/0)+py(t,oy,n.memory)+t.geometry,a=i>n.memory?`the scene needs ${gy(i)} MB of graphics memory and ${gy(n.memory)} MB may be used`:`this device's graphics allow no more`;return`${_y(r.join(`, `))}: ${a}.`}function gy(e){return(e/1e6).toFixed(+(e<1e7))}function _y(e){return e.charAt(0).toUpperCase()+e.slice(1)}var vy=`
#define LAYERS 64
#define LEVEL 1e-4
#define MOST 6e4
#define REACH 2
uniform sampler2DArray stored;
uniform int firstLayer;
uniform int sharing;
uniform bool words;
uniform int channels;
uniform int entries;
uniform vec4 scale[LAYERS];
uniform vec4 bias[LAYERS];
uniform vec3 colours[LAYERS];
uniform bool rayWeights;
uniform sampler2DArray weightMaps;
uniform int firstGroup;
uniform sampler2D places;
uniform vec2 beside;
uniform vec3 eye;
uniform sampler2D coarse;
vec4 placeOf(vec3 point) {
  float height = point.z < 0.0 ? min(point.z, -LEVEL) : max(point.z, LEVEL);
  return vec4(clamp(vec3(point.xy, 1.0) / height, -MOST, MOST), 1.0);
}
vec2 viewCoordinates(vec4 place) {
  float part = 1.0 - eye.z * place.z;
  bool meets = place.w > 0.0 && part > 1e-5;
  return clamp(meets ? (eye.xy - eye.z * place.xy) / part : eye.xy, -1.0, 1.0);
}
float codeOf(vec2 shift) { return shift.x + float(REACH) + float(2 * REACH + 1) * (shift.y + float(REACH)); }
vec2 shiftOf(vec4 place) {
  int code = int(place.w + 0.5) - 1;
  return code < 0 ? vec2(0.0) : vec2(code % (2 * REACH + 1) - REACH, code / (2 * REACH + 1) - REACH);
}
vec4 sumTextures(vec2 own) {
  vec2 nodes = vec2(textureSize(weightMaps, 0).xy);
  vec4 place = rayWeights || beside.x > 0.0 ? texelFetch(places, ivec2(gl_FragCoord.xy), 0) : vec4(0.0);
  vec2 view = rayWeights ? viewCoordinates(place) : vec2(0.0);
  own -= beside * shiftOf(place);
  vec2 at = (0.5 + (0.5 + 0.5 * view) * (nodes - 1.0)) / nodes;
  vec4 four = vec4(1.0), weights = four;
  vec3 sum = vec3(0.0);
  int entry = 0;
  for (int group = 0; entry < entries; group++) {
    if (rayWeights && (!words || group % 4 == 0)) {
      four = textureLod(weightMaps, vec3(at, float(firstGroup + (words ? group / 4 : group))), 0.0);
    }
    weights = words ? vec4(four[group % 4]) : four;
    for (int channel = 0; channel < channels; channel++) {
      vec4 read = textureLod(stored, vec3(own, float(firstLayer + entry / sharing)), 0.0) * scale[entry] + bias[entry];
      sum += colours[channel] * dot(weights, read);
      entry++;
    }
  }
  return vec4(sum, 0.0);
}
vec4 finerValue(vec2 uv) { return readCubic(coarse, uv * vec2(textureSize(coarse, 0)) - 0.5); }
vec4 finerOpacity(vec2 uv) { return vec4(vec3(0.0), finerValue(uv).r); }
`,yy=`
vec4 catmullRom(float f) {
  float f2 = f * f, f3 = f2 * f;
  return 0.5 * vec4(2.0 * f2 - f3 - f, 3.0 * f3 - 5.0 * f2 + 2.0, 4.0 * f2 - 3.0 * f3 + f, f3 - f2);
}
vec4 readCubic(sampler2D source, vec2 texel) {
  ivec2 last = textureSize(source, 0) - 1;
  ivec2 base = ivec2(floor(texel));
  vec2 f = texel - vec2(base);
  vec4 across = catmullRom(f.x), down = catmullRom(f.y);
  vec4 sum = vec4(0.0);
  for (int row = 0; row < 4; row++) {
    vec4 line = vec4(0.0);
    for (int column = 0; column < 4; column++) {
      ivec2 at = clamp(base + ivec2(column, row) - 1, ivec2(0), last);
      line += across[column] * texelFetch(source, at, 0);
    }
    sum += down[row] * line;
  }
  return sum;
}
`,by=2,xy=`
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
${yy}${vy}`,Sy=`
precision highp float;
uniform vec4 rectangle; // of the target: left, top, right, bottom in 0..1
in vec3 position;
out vec2 own;
void main() {
  own = position.xy;
  gl_Position = vec4(2.0 * mix(rectangle.xy, rectangle.zw, position.xy) - 1.0, 0.0, 1.0);
}
`,Cy=`
precision highp float;
uniform vec2 texel;     // of the target, in clip space
uniform vec2 shifts[SHIFTS];
in vec2 position;       // texture coordinates
in vec3 onPlane;
out vec3 point;
flat out vec2 shift;
void main() {
  point = onPlane;
  shift = shifts[gl_InstanceID];
  gl_Position = vec4(2.0 * position - 1.0 + texel * shift, 0.0, 1.0);
}
`,wy=`${xy}
in vec3 point;
flat in vec2 shift;
out vec4 place;
void main() {
  place = placeOf(point);
  place.w += codeOf(shift);
}
`,Ty=`sumTextures`,Ey=`finerValue`,Dy=`finerOpacity`;function Oy(e,t,n){let r=new Mi({glslVersion:I,vertexShader:Sy,fragmentShader:`${xy}in vec2 own;\nout vec4 colour;\nvoid main() { colour = ${e}(own); }\n`,uniforms:{rectangle:{value:new rt(...t)},...n},side:2,blending:5,blendSrc:201,blendDst:201,depthTest:!1,depthWrite:!1}),i=new Un;i.setAttribute(`position`,new On(new Float32Array([0,0,0,1,0,0,0,1,0,1,1,0]),3)),i.setIndex([0,1,2,2,1,3]),i.boundingSphere=new Fn;let a=new _r(i,r);return a.frustumCulled=!1,a}function ky([e,t],n){return new at(e,t,{type:p,depthBuffer:!1,generateMipmaps:n,minFilter:n?c:r,magFilter:n?o:r})}function Ay(e,t){let n=jv(e.right,e.up),r=[t[0]-e.origin[0],t[1]-e.origin[1],t[2]-e.origin[2]];return[...Ov(e,t),Av(r,n)/(Math.max(...e.extent)||1)]}var jy=Array.from({length:5},(e,t)=>t-by),My=jy.flatMap(e=>jy.map(t=>new H(t,e))).sort((e,t)=>t.lengthSq()-e.lengthSq());function Ny(e){return new Mi({glslVersion:I,vertexShader:Cy.replace(`SHIFTS`,String(My.length)),fragmentShader:wy,uniforms:{texel:{value:new H(2/e.width,2/e.height)},shifts:{value:My}},side:2,blending:0,depthTest:!1,depthWrite:!1})}function Py(e,t,n){let{index:r}=e,i=e.getAttribute(`position`),a=e.getAttribute(`uv`),o=new Float32Array(3*i.count),s=new Float32Array(2*i.count);for(let e=0;e<i.count;e++)o.set(Ay(t,[i.getX(e),i.getY(e),i.getZ(e)]),3*e),s.set([a.getX(e),a.getY(e)],2*e);let c=new Va;c.setAttribute(`position`,new On(s,2)),c.setAttribute(`onPlane`,new On(o,3)),c.setIndex(r&&new On(r.array,1)),c.instanceCount=My.length,c.boundingSphere=new Fn;let l=new _r(c,n);return l.frustumCulled=!1,l}var Fy=new q(0),Iy=new q;function Ly(e,t,n){let r=e.getRenderTarget(),[i,a]=[e.getActiveCubeFace(),e.getActiveMipmapLevel()],{autoClear:o,info:s}=e,[c,l,u]=[e.xr.enabled,e.shadowMap.autoUpdate,e.getClearAlpha()],[d,f]=[s.render.frame,s.autoReset];e.getClearColor(Iy),e.setClearColor(Fy,0),e.autoClear=e.xr.enabled=e.shadowMap.autoUpdate=s.autoReset=!1,n(),s.render.frame=d,Object.assign(s,{autoReset:f}),Object.assign(e,{autoClear:o}),e.xr.enabled=c,e.shadowMap.autoUpdate=l,e.setClearColor(Iy,u),e.setRenderTarget(r,i,a);let{viewport:p}=t;p&&e.state.viewport(p)}var Ry={version:0,mean:!0,opacity:0,only:null,count:0,weights:new Float64Array,eye:null,places:0,maps:null},zy=class{snaps;surface;plane;grids;composed=null;opacity;opacityDrawn=0;camera=new Oa;constructor(e,t,n,r,i,a,o){this.snaps=i,this.surface=a,this.plane=o;let[s,...c]=iy({atlas:e,means:t.filter(({basis:e})=>!e).map(({grid:e})=>({size:e})),bases:t.filter(({basis:e})=>e)}),l=(e,n)=>{let a=t.filter(({grid:t})=>t.join()===e.join()).flatMap(t=>Hy(t,i?$v(e,r):null)),o=new Ut;return a.forEach(({quad:e},t)=>o.add(Object.assign(e,{renderOrder:t}))),{target:ky($v(e,r),n),scene:o,steps:a,places:null}},u=l(s??e,!0);this.grids=c.map(e=>l(e,!1));for(let{target:e}of this.grids){let t=Oy(Ey,[0,0,1,1],{coarse:{value:e.texture}});u.scene.add(Object.assign(t,{renderOrder:u.scene.children.length}))}this.grids.push(u),this.opacity=n&&By(n,r)}get texture(){return this.grids.at(-1)?.target.texture??null}compose(e,t,n){this.composed&&Gy(this.composed,n)||(this.composed=n,Ly(e,t,()=>{n.opacity>this.opacityDrawn&&this.drawOpacity(e,n.opacity);for(let t of this.grids){(n.eye!==null&&t.steps.some(({part:e})=>e.basis)||this.snaps)&&this.findPlaces(e,t,n.places);for(let e of t.steps)Uy(e,t.places?.target.texture??null,n);this.draw(e,t.scene,t.target,this.opacityDrawn>0&&t===this.grids.at(-1))}}))}dispose(){for(let{target:e,places:t,scene:n}of this.grids)e.dispose(),t?.target.dispose(),t?.material.dispose(),Vy(n);this.opacity?.target.dispose(),this.opacity&&[this.opacity.sum,this.opacity.finer].forEach(Vy)}drawOpacity(e,t){let[n,r]=[this.grids.at(-1),this.opacity];r&&n&&(this.draw(e,r.sum,r.target),this.draw(e,r.finer,n.target),this.opacityDrawn=t)}findPlaces(e,t,n){if(t.places&&t.places.version>=n)return;let r=t.places?.target??ky([t.target.width,t.target.height],!1),i=t.places?.material??Ny(r),a=Py(this.surface.geometry,this.plane,i);this.draw(e,new Ut().add(a),r),a.geometry.dispose(),t.places={target:r,material:i,version:this.surface.version}}draw(e,t,n,r=!1){e.setRenderTarget(n),e.state.buffers.color.setMask(!0);let i=e.getContext();r&&i.colorMask(!0,!0,!0,!1),e.clear(!0,!1,!1),r&&i.colorMask(!0,!0,!0,!0),e.render(t,this.camera)}};function By(e,t){let n=ky($v(e.grid,t),!1),r=Hy(e,null);for(let e of r)Uy(e,null,Ry);let[i,a]=[new Ut,new Ut];return i.add(...r.map(({quad:e})=>e)),a.add(Oy(Dy,[0,0,1,1],{coarse:{value:n.texture}})),{target:n,sum:i,finer:a}}function Vy(e){for(let{geometry:t,material:n}of e.children)t.dispose(),n.dispose()}function Hy(e,t){let[n,r,i,a]=e.rectangle,o=t&&new H(1/((i-n)*t[0]),1/((a-r)*t[1])),s=e.colours.length,[c,l]=[e.scale.length/(4*s),Math.floor(64/s)],u=e.words?4*Math.floor(l/4):l,d=[];for(let t=0;t<c;t+=u){let n=Array.from({length:64},(t,n)=>new W(...e.colours[n]??[0,0,0])),r=e.basis||e.words?1:4,i=Oy(Ty,e.rectangle,{stored:{value:e.stored},firstLayer:{value:Math.floor(t*s/r)},sharing:{value:r},words:{value:e.words},channels:{value:s},entries:{value:0},scale:{value:new Float32Array(256)},bias:{value:new Float32Array(256)},colours:{value:n},rayWeights:{value:!1},weightMaps:{value:null},firstGroup:{value:(e.basis?.group??0)+(e.words?t/4:t)},places:{value:null},beside:{value:o??new H},eye:{value:new W}});d.push({part:e,first:t,groups:Math.min(u,c-t),quad:i})}return d}function Uy({part:e,first:t,groups:n,quad:r},i,a){let{basis:o,colours:s,words:c}=e,{uniforms:l}=r.material,u=(e,t)=>{let n=l[e];n&&(n.value=t)},d=o!==null&&a.eye!==null&&a.only===null,f=c?1:4,p=Array.from({length:f*n},(e,n)=>Wy(o,f*t+n,a,d)),m=Math.ceil((p.findLastIndex(e=>e!==0)+1)/f),[h,g]=[l.scale?.value,l.bias?.value],_=s.length;for(let n=0;n<4*_*m;n++){let r=p[f*Math.floor(n/(4*_))+n%f]??0;h[n]=r*(e.scale[4*_*t+n]??0),g[n]=r*(e.bias[4*_*t+n]??0)}u(`entries`,_*m),u(`rayWeights`,d),u(`weightMaps`,d?a.maps:null),u(`places`,i),a.eye&&(l.eye?.value).set(...a.eye),r.visible=m>0,r.material.uniformsNeedUpdate=!0}function Wy(e,t,n,r){return e?e.ready[t]?n.only===null?t>=n.count?0:r?1:n.weights[e.column+t]??0:+(t===n.only):0:+!!n.mean}function Gy(e,t){let{weights:n,eye:r,...i}=e;return!Object.entries(i).every(([e,n])=>t[e]===n)||r===null!=(t.eye===null)?!1:e.only===null?r?r.every((e,n)=>e===t.eye?.[n]):n.every((e,n)=>e===t.weights[n]):!0}function Ky(e,n,r,i,a){let s=i.reduce((e,t)=>e+t,0),c=[],[l,u]=[0,0];for(let e of i){let t=Math.min(e,a);for(let e=0;e<t;e++)c.push([l+e,4*u+e]);l+=e,u+=t?ry(t):0}let d=new Uint16Array(Math.max(1,u)*129*129*4);for(let t=0;t<129;t++)for(let i=0;i<129;i++){let{camera:a,weight:o}=e.at(2*i/128-1,2*t/128-1,n),[l,u,f,p]=[a[0]*s,a[1]*s,a[2]*s,a[3]*s],[m,h,g,_]=o;for(let[e,n]of c){let a=m*(r[l+e]??0)+h*(r[u+e]??0)+g*(r[f+e]??0)+_*(r[p+e]??0);d[4*(((n>>2)*129+t)*129+i)+(n&3)]=wn.toHalfFloat(a)}}let f=new ot(d,129,129,Math.max(1,u));return f.format=_,f.type=p,f.minFilter=f.magFilter=o,f.wrapS=f.wrapT=t,f.needsUpdate=!0,f}var qy=class{info;counts;omega;views;total;rowOf;made=null;constructor(e,t,n,r){this.info=e,this.counts=t,this.omega=n,this.views=r,this.total=t.reduce((e,t)=>e+t,0);let i=0;this.rowOf=Int32Array.from(e.heldOut,e=>e?-1:i++)}viewsAt(e,t,n){let r=new Float64Array(this.views.places.length/2),{camera:i,weight:a}=this.views.at(e,t,n);return i.forEach((e,t)=>r[e]=(r[e]??0)+(a[t]??0)),r}at(e,t,n){let{camera:r,weight:i}=this.views.at(e,t,n),a=new Float64Array(this.total);for(let e=0;e<4;e++){let t=i[e]??0;if(!t)continue;let n=(r[e]??0)*this.total;for(let e=0;e<this.total;e++)a[e]=(a[e]??0)+t*(this.omega[n+e]??0)}return a}ofCamera(e,t){let n=this.rowOf[e]??-1;if(n>=0)return Float64Array.from(this.omega.subarray(n*this.total,(n+1)*this.total));let r=this.info.cameras[e];if(!r)throw RangeError(`no camera ${e}`);return this.at(...Ov(this.info.viewPlane,r.centre),t)}maps(e,t){if(this.made?.mixing===e&&this.made.usable===t)return this.made.texture;this.dispose();let n=Ky(this.views,e,this.omega,this.counts,t);return this.made={texture:n,mixing:e,usable:t},n}dispose(){this.made?.texture.dispose()}},Jy=`
uniform sampler2D composed;
uniform float finest;
uniform vec3 exposureScale;
uniform vec3 exposureBias;
vec4 surfaceValue(vec2 uv) {
  vec4 plain = texture(composed, uv, -log2(finest));
#if BICUBIC == 1
  vec2 size = vec2(textureSize(composed, 0));
  vec2 across = dFdx(uv) * size, down = dFdy(uv) * size;
  bool fine = max(dot(across, across), dot(down, down)) <= finest * finest;
  if (fine) return readCubic(composed, clamp(uv * size, vec2(0.5), size - 0.5) - 0.5);
#endif
  return plain;
}
vec3 seenColour(vec4 value) { return value.rgb * exposureScale + exposureBias; }
vec3 surfaceColour(vec2 uv) { return clamp(seenColour(surfaceValue(uv)), 0.0, 1.0); }
vec4 sheetColour(vec2 uv) {
  vec4 value = surfaceValue(uv);
  float opacity = clamp(value.a, 0.0, 1.0);
  return vec4(seenColour(value) * opacity, opacity);
}
`,Yy={bilinear:0,bicubic:1},Xy={picture:0,mean:1,eigen:2,error:3},Zy=`
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
in vec2 uv;
out vec2 surfaceUv;
out vec3 surfacePlace;
void main() {
  surfaceUv = uv;
  surfacePlace = position;
  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
}
`,Qy=Zy.replace(`void main`,`invariant gl_Position;
void main`),$y=`
precision highp float;
precision highp int;
precision highp sampler2D;
uniform int shown;             // 0 the picture, 1 the mean, 2 one eigen texture, 3 the error
`,eb=`
uniform sampler2D photograph;  // row 0 on top
uniform mat4 toPhotograph;     // homogeneous texture coordinates of a place, in x, y and w

vec3 heat(float t) {
  return clamp(vec3(3.0 * t, 3.0 * t - 1.0, 3.0 * t - 2.0), 0.0, 1.0);
}

vec3 errorColour(vec3 drawn, vec3 place) {
  vec4 at = toPhotograph * vec4(place, 1.0);
  vec2 uv = at.xy / at.w;
  if (at.w <= 0.0 || any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return vec3(0.2);
  vec3 off = abs(drawn - textureLod(photograph, uv, 0.0).rgb);
  return heat(5.0 * (off.r + off.g + off.b) / 3.0);
}
`,tb=`${$y}
${yy}${Jy}
uniform float shownGain;       // of the eigen texture around mid grey
in vec2 surfaceUv;
vec3 eigenColour(vec3 value) { return clamp(0.5 + shownGain * value, 0.0, 1.0); }
`,nb=`${tb}${eb}
in vec3 surfacePlace;
out vec4 fragment;
void main() {
  vec3 colour;
  if (shown == 2) colour = eigenColour(surfaceValue(surfaceUv).rgb);
  else colour = surfaceColour(surfaceUv);
  if (shown == 3) colour = errorColour(colour, surfacePlace);
  fragment = vec4(colour, 1.0);
}
`,rb=`${tb}
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
`,ib=`
precision highp float;
layout(location = 0) out vec4 fragment;
layout(location = 1) out vec4 solid;
void main() { fragment = solid = vec4(0.0); }
`,ab={blending:5,blendSrc:201,blendDst:205},ob={depthWrite:!1,stencilWrite:!0,stencilFunc:514,stencilZPass:F};function sb(e,t){let n={composed:{value:null},finest:{value:1},exposureScale:{value:new W(1,1,1)},exposureBias:{value:new W},shown:{value:Xy.picture},shownGain:{value:1},photograph:{value:null},toPhotograph:{value:new K}},r=new Mi({glslVersion:I,vertexShader:t?Qy:Zy,fragmentShader:t?rb:nb,uniforms:n,defines:{BICUBIC:Yy.bicubic},side:e?2:0,...t?{...ab,...ob}:{}});return r.name=`eigen textures`,r}function cb(e){let{side:t}=e;return new Mi({name:`depth of sheets`,glslVersion:I,vertexShader:Qy,fragmentShader:ib,colorWrite:!1,side:t,stencilWrite:!0,stencilZPass:0})}function lb(e,t,n){let{K:r,R:i,t:a,width:o,height:s}=t,c=new K().set(...i[0],a[0],...i[1],a[1],...i[2],a[2],0,0,0,1),l=new K().set(...r[0],0,...r[1],0,0,0,0,0,...r[2],0),u=n.flipY&&!ub(n.image),d=new K().makeScale(1/o,(u?-1:1)/s,1);u&&(d.elements[13]=1),e.toPhotograph.value.multiplyMatrices(d,l.multiply(c)),e.photograph.value=n}function ub(e){return typeof ImageBitmap<`u`&&e instanceof ImageBitmap}function db(e){for(let{picture:t}of e)`close`in t&&t.close()}var fb=128,pb=.98;async function mb(e,t,n,r){let i=n.length,a=0,o=e.pictures.find(({textures:e})=>(a+=e)>t);if(!o)return 1;let s=t-(a-o.textures),c=l_(o),l=o.pieces<i,u=await o.codec.bitmaps(await r(o.view),o,e.size),d=new OffscreenCanvas(fb,fb).getContext(`2d`,{willReadFrequently:!0});if(!d)return 1;d.imageSmoothingEnabled=!1;let f=[];return u.slice(o.pieces*s,o.pieces*(s+1)).forEach(({picture:e,row:t,rows:r},a)=>{d.drawImage(e,0,t,e.width,r,0,0,fb,fb);let{data:u}=d.getImageData(0,0,fb,fb);(l?[0,1,2]:[a]).forEach(e=>{let[t,r]=[o.scale,o.zero].map(t=>t[i*s+e]??0),a=Math.max(...(n[e]??[0]).map(Math.abs))*(t??0);for(let t=l?e:0;t<u.length;t+=4)f.push(Math.abs((c*(u[t]??0)-(r??0))*a))})}),db(u),hb(f)}function hb(e){e.sort((e,t)=>e-t);let t=e[Math.floor(pb*e.length)]??0;return t>0?.45/t:1}var gb=class{scene;films;filling=null;constructor(e,t){this.scene=e,this.films=t}fill(e){return this.filling=e,this.put(e),e.announce(),Promise.resolve()}show(e){this.films=e,this.filling&&this.put(this.filling)}gain(e){let t=0;for(let{channels:n,bases:r}of this.scene.planes){let i=this.scene.colours.slice(t,t+=n),a=r.find(({count:t})=>t>e)?.pictures[0];if(a)return Promise.resolve(this.gainOf(a,e,i))}return Promise.resolve(1)}dispose(){this.filling=null}put(e){J_(this.scene).forEach(({mean:t},n)=>e.putMean(n,{pieces:this.piecesOf(t),precision:null})),xv(this.scene).forEach(({pictures:[t]},n)=>{let r=t?this.piecesOf(t):[];t&&r.length&&e.putTextures(n,0,r,t)})}piecesOf({part:e}){let t=e&&this.films[e.film];return t?im(t,e).map(e=>({picture:e,row:0,rows:e.height})):[]}gainOf({part:e,pieces:t,scale:n,zero:r},i,a){let o=e&&this.films[e.film];return o?hb(im(o,e).slice(t*i,t*(i+1)).flatMap((e,o)=>{let s=t*i+o,c=Math.max(...(a[o]??[0]).map(Math.abs))*(n[s]??0);return vb(e).map(e=>Math.abs((e-(r[s]??0))*c))})):1}},_b=8;function vb({data:e,width:t,height:n,stride:r}){let i=[];for(let a=0;a<n;a+=_b)for(let n=0;n<t;n+=_b){let t=a*r+2*n;i.push(e[t]+256*e[t+1])}return i}var yb=1179937895,bb=1313821514,xb=5130562,Sb=1280591429;async function Cb(e){let t=await e.read(0,4).catch(t=>{throw t instanceof ff&&t.code===`truncated`?Ob(e.received===0):t});if(new DataView(t).getUint32(0,!0)!==yb)throw Ob(!1);let n=new DataView(await e.read(0,12)),r=n.getUint32(4,!0),i=n.getUint32(8,!0);if(r!==2)throw new ff(`version`,`The file is GLB version ${r} and this viewer reads 2; save it as glTF 2.`,`4`);if(i<20)throw Q(`8`,`a length of no file`);let a=new DataView(await e.read(12,20)),o=a.getUint32(0,!0);if(a.getUint32(4,!0)!==bb)throw Q(`16`,`it does not begin with JSON`);if(o>kf)throw Q(`12`,`${o} bytes of JSON`);if(20+o>i)throw Q(`12`,`a chunk longer than the file`);let s=Tb(await e.read(20,20+o)),c=(t,n)=>()=>wb(e,20+o,i,t,n);return{length:i,text:s,json:Eb(s,`20`),binary:c(xb,`binary chunk`),groups:c(Sb,`chunk of groups`)}}async function wb(e,t,n,r,i){let a=t;for(let t=1;t<64&&a+8<=n;t++){let t=new DataView(await e.read(a,a+8)),i=t.getUint32(0,!0);if(a+8+i>n)throw Q(String(a),`a chunk longer than the file`);if(t.getUint32(4,!0)===r)return a+8;a+=8+i}throw Q(String(t),`no ${i}`)}function Tb(e){try{return new TextDecoder(`utf-8`,{fatal:!0}).decode(e)}catch{throw Q(`20`,`its JSON is not UTF-8`)}}function Eb(e,t){if(Db(e)>64)throw Q(t,`its JSON is nested too deep`);try{return JSON.parse(e)}catch{throw Q(t,`its JSON cannot be read`)}}function Db(e){let[t,n]=[0,0],r=!1;for(let i=0;i<e.length;i++){let a=e[i];if(a===`"`)r=!r;else if(r&&a===`\\`)i+=1;else if(r)continue;else a===`[`||a===`{`?n=Math.max(n,++t):(a===`]`||a===`}`)&&--t}return n}function Ob(e){return new ff(`not-glb`,e?`The file is empty; take a .glb file that eigenfield wrote.`:`The file is no GLB; take a .glb file that eigenfield wrote.`,`0`)}var kb=3,Ab=4,jb=class{scene;timeline;mesh;read;kept=new Map;constructor(e,t,n,r){this.scene=e,this.timeline=t,this.mesh=n,this.read=r}open(e){let t=this.kept.get(e)??this.opened(e);t.catch(()=>this.kept.get(e)===t&&this.kept.delete(e)),this.kept.delete(e),this.kept.set(e,t);for(let[e]of this.kept)this.kept.size>kb&&this.kept.delete(e);return t}async begin(){let e=this.placeOf(0),t=async t=>new Uint8Array(await this.read(e,Math.min(t,e.length))),{head:n,at:r}=await Ib(await t(Ab+Pb(await t(Ab),e)),e),i=[n.key(`weights`),n.key(`mesh`),n.key(`motion`),n.key(`frames`).at(0)].reduce((e,{raw:t})=>e+Fb(t),r);return this.build(0,await t(i),n,r,1)}placeOf(e){let t=this.timeline.groups[e];if(!t)throw RangeError(`no group ${e}`);return t}async opened(e){let t=this.placeOf(e),n=new Uint8Array(await this.read(t,t.length));await Nb(n,t);let{head:r,at:i}=await Ib(n,t);return this.build(e,n,r,i,t.frames)}build(e,t,n,r,i){let a=this.placeOf(e),o=Lb(t,r,a),s=this.weightsOf(n,o),c=this.meshOf(n,o),l=Rb(n,o,c,a),{first:u,frames:d}=a,f=zb(n,a,this.timeline.films.length,o,i);return{index:e,first:u,frames:d,omega:s,...this.scalesOf(n),units:f,mesh:c,motion:l}}meshOf(e,t){let n=e.key(`mesh`);if(!n.exists)return this.mesh;if(this.scene.sheets)throw n.wrong(`a mesh of its own, in a clip with sheets`);let r=Mg[`mesh-2`].decode(t(n),n.where);if(!r.indices.length)throw Q(n.where,`a mesh without faces`);return r}weightsOf(e,t){let n=this.scene.heldOut.filter(e=>!e).length,r=Vb(e.key(`weights`),this.scene.planes.length);return vv(n,this.scene.planes.flatMap(({bases:e},i)=>{let a=r[i]&&Vb(r[i],e.length);return e.map(({count:e},r)=>{let i=a[r];return bv(Mg[`weights-1`].decode(t(i),i.where),n,e,i.where)})}))}scalesOf(e){let{planes:t}=this.scene;return{means:Vb(e.key(`means`),t.length).map((e,n)=>Bb(e,t[n].mean)),bases:Vb(e.key(`bases`),t.length).flatMap((e,n)=>{let{bases:r}=t[n];return Vb(e,r.length).map((e,t)=>Bb(e,r[t].pictures[0]))})}}};function Mb(e,{means:t,bases:n}){e.planes.forEach(({mean:e},n)=>Object.assign(e,t[n])),xv(e).forEach(({pictures:[e]},t)=>e&&Object.assign(e,n[t]))}async function Nb(e,{sha256:t,file:n,where:r}){let i=globalThis.crypto?.subtle;if(!i)return;let a=new Uint8Array(await i.digest(`SHA-256`,e));if(Array.from(a,e=>e.toString(16).padStart(2,`0`)).join(``)!==t)throw Q(n??r,`other bytes than its SHA-256 says`)}function Pb(e,{where:t}){if(e.length<Ab)throw Q(t,`no head`);return new DataView(e.buffer).getUint32(0,!0)}function Fb(e){return typeof e==`number`?e:Array.isArray(e)?e.reduce((e,t)=>e+Fb(t),0):0}async function Ib(e,{where:t}){let n=Ab+Pb(e,{where:t});if(n>e.length)throw Q(t,`a head longer than the group`);let r=await Df(e.subarray(Ab,n),`deflate-raw`,Xf,t);return{head:new Ig(Eb(new TextDecoder(`utf-8`).decode(r),t),t),at:n}}function Lb(e,t,n){let r=t;return t=>{let i=r;if(r+=t.integer(1,n.length),r>e.length)throw t.wrong(`beyond the end of the group`);return e.subarray(i,r)}}function Rb(e,t,n,{frames:r}){let i=e.key(`motion`);if(!i.exists)return null;let a=Mg[`motion-1`].decode(t(i),n,i.where);if(a.frames!==r)throw i.wrong(`${a.frames} frames of ${r}`);return a}function zb(e,t,n,r,i){return Vb(e.key(`frames`),t.frames).slice(0,i).map(e=>Vb(e,n).map(e=>r(e)))}function Bb(e,{pieces:t,textures:n}){let r=e;return{scale:d_(r.key(`scale`),t,n),zero:d_(r.key(`zero`),t,n)}}function Vb(e,t){let n=e.items(t);if(n.length!==t)throw e.wrong(`${t} entries are needed`);return n}var Hb=3,Ub=`#version 300 es
void main() {
  gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);
}
`,Wb=`#version 300 es
precision highp float;
uniform highp sampler2D picture;
uniform vec4 factors;
uniform int first; // row of the picture with which the texture begins
out vec4 stored;
void main() {
  stored = vec4(dot(texelFetch(picture, ivec2(gl_FragCoord.xy) - ivec2(0, first), 0), factors));
}
`,Gb=`#version 300 es
precision highp float;
precision highp int;
#define EDGE 1e-3 // of a texel: less is rounding
uniform highp sampler2D picture;
uniform highp sampler2D precisions;
uniform highp sampler2D covered; // texels of the grid that lie in charts
uniform vec4 factors;
uniform ivec2 size; // of the picture
uniform ivec2 made; // of what is stored
uniform int first; // row of the picture with which the texture begins
uniform ivec2 corner; // of the picture in its grid
uniform ivec2 nodes; // columns and rows of the precisions that are used; 0: codes are stored as they are
uniform float zero;
out vec4 stored;
float nodeAt(ivec2 at) {
  return texelFetch(precisions, clamp(at, ivec2(0), nodes - 1), 0).r;
}
float precisionAt(vec2 uv) {
  vec2 at = uv * vec2(nodes) - 0.5;
  ivec2 low = ivec2(floor(at));
  vec2 part = at - vec2(low);
  float upper = mix(nodeAt(low), nodeAt(low + ivec2(1, 0)), part.x);
  float lower = mix(nodeAt(low + ivec2(0, 1)), nodeAt(low + ivec2(1, 1)), part.x);
  return (255.0 * mix(upper, lower, part.y) + 1.0) / 256.0;
}
float valueAt(ivec2 texel) {
  float code = dot(texelFetch(picture, texel - ivec2(0, first), 0), factors);
  if (nodes.x == 0) return code;
  float fine = precisionAt((vec2(texel) + 0.5) / vec2(size));
  return clamp((code - zero) / fine / 4.0, -65504.0, 65504.0);
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (made == size) {
    stored = vec4(valueAt(at));
    return;
  }
  vec2 ratio = vec2(size) / vec2(made), low = vec2(at) * ratio, high = low + ratio;
  vec2 charts = vec2(0.0), all = vec2(0.0);
  for (int y = int(low.y); float(y) < high.y - EDGE; y++) {
    for (int x = int(low.x); float(x) < high.x - EDGE; x++) {
      vec2 part = min(high, vec2(x + 1, y + 1)) - max(low, vec2(x, y));
      vec2 one = part.x * part.y * vec2(valueAt(ivec2(x, y)), 1.0);
      all += one;
      charts += one * texelFetch(covered, corner + ivec2(x, y), 0).r;
    }
  }
  vec2 sum = charts.y > EDGE ? charts : all;
  stored = vec4(sum.x / sum.y, step(EDGE, charts.y), 0.0, 0.0);
}
`,Kb=`#version 300 es
precision highp float;
precision highp int;
uniform highp sampler2D picture; // values, and whether they are of a chart
uniform ivec2 size; // as much of it as is used
out vec4 stored;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 own = texelFetch(picture, at, 0).rg;
  vec2 sum = vec2(own.r * own.g, own.g);
  for (int far = 1; far <= ${Hb} && sum.y == 0.0; far++) {
    for (int y = -far; y <= far; y++) {
      for (int x = -far; x <= far; x++) {
        vec2 near = texelFetch(picture, clamp(at + ivec2(x, y), ivec2(0), size - 1), 0).rg;
        sum += vec2(near.r * near.g, near.g);
      }
    }
  }
  stored = vec4(sum.y > 0.0 ? sum.x / sum.y : own.r);
}
`,qb=[`#version 300 es
in vec2 uv;
void main() { gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0); }
`,`#version 300 es
precision mediump float;
out vec4 covered;
void main() { covered = vec4(1.0); }
`];function Jb(e,t,n){let r=[],[i,a,o,s]=[0,0,0,0],{words:c}=n;return e.planes.forEach((l,u)=>{let{channels:d,bases:f}=l,p=e.colours.slice(i,i+d);i+=d;let m=t.needs.means[u]?.size??[1,1],h=t.means[u],g=c?Qb([l.mean]):Zb(l);h&&r.push({stored:h,grid:m,rectangle:[0,0,1,1],colours:p,...g,words:c,basis:null});for(let{size:e,grid:i,corner:l,pictures:u,count:m}of f){let f=t.bases[a],h=t.ready[a++]??[],g=Math.min(m,n.usable);if(g&&f){let[t,a]=[l[0]/i[0],l[1]/i[1]];r.push({stored:f,grid:i,rectangle:[t,a,t+e[0]/i[0],a+e[1]/i[1]],colours:p,...c?Qb(u):$b(u,d,g,n.halves&&c_(u)),words:c,basis:{ready:h,column:o,group:s}})}o+=m,s+=g?ry(g):0}}),r}function Yb(e,t,n,r){Jb(t,n,r).forEach(({scale:t,bias:n},r)=>Object.assign(e[r]??{},{scale:t,bias:n}))}function Xb({planes:e,sheets:t},{means:n,needs:r},{words:i}){let a=n[e.length],o=r.means[e.length]?.size;return!t||!a||!o?null:{stored:a,grid:o,rectangle:[0,0,1,1],colours:[[1,0,0]],...i?Qb([t.opacity.mean]):Zb(t.opacity),words:i,basis:null}}function Zb({mean:e,channels:t,precision:n}){let{scale:r,zero:i}=e,a=n?4:1/u_(e,c_([e])),o={scale:new Float32Array(4*t),bias:new Float32Array(4*t)};for(let e=0;e<t;e++){let t=4*e+e%4;o.scale[t]=a*(r[e]??0),o.bias[t]=n?0:-(i[e]??0)*(r[e]??0)}return o}function Qb(e){let t=e.flatMap(e=>e.scale),n=e.flatMap(e=>e.zero);return{scale:Float32Array.from(t.flatMap(e=>[255*e,65280*e,0,0])),bias:Float32Array.from(t.flatMap((e,t)=>[-(n[t]??0)*e,0,0,0]))}}function $b(e,t,n,r){let i=e.flatMap(e=>Array(e.textures).fill(u_(e,r))),a=e.flatMap(e=>e.scale),o=e.flatMap(e=>e.zero),s=4*t*ry(n),c={scale:new Float32Array(s),bias:new Float32Array(s)};for(let e=0;e<n;e++)for(let n=0;n<t;n++){let r=4*(t*Math.floor(e/4)+n)+e%4,s=a[t*e+n]??0;c.scale[r]=s/(i[e]??1),c.bias[r]=-(o[t*e+n]??0)*s}return c}var ex=.25,tx=100,nx=2,rx=.25,ix=.1,ax=class extends me{timeline;user;first;duration;frames;rate;sound;ring;shown;clock;last=null;plays=!1;pace=1;goal=null;following=null;waiters=[];asked=null;disposed=!1;lacking=[];watched={seconds:0,due:0,short:0};constructor(e,t,n,r=null){super(),this.timeline=e,this.user=n,this.rate=e.rate,this.frames=e.frames,this.first=e.first,this.duration=e.frames/e.rate,this.shown={position:0,number:0},this.clock=0,this.ring=t({ready:()=>this.wake(),failed:(e,t)=>this.fail(e,t),thinned:()=>this.thin()}),this.sound=r&&r(()=>void this.dispatchEvent({type:`change`})),globalThis.document?.addEventListener(`visibilitychange`,this.hide)}get playing(){return this.plays}get frame(){return this.shown.number}get time(){return L_(this.timeline,this.shown.number)}get sought(){return(this.following??this.goal??this.shown.position)%this.frames}get waiting(){return this.goal!==null}get group(){let{groups:e}=this.timeline,t=R_(this.timeline,this.shown.number);return{index:t,count:e.length,bytes:e[t]?.length??0}}get late(){return this.ring.late}get open(){return this.ring.open}get fallbacks(){return this.lacking}get loop(){return this.ring.loop}set loop(e){this.ring.loop=e,this.ring.feed(),this.dispatchEvent({type:`change`})}get speed(){return this.pace}set speed(e){if(!(e>0&&e<1/0))throw RangeError(`A speed is above 0.`);this.pace=e,this.watch(),this.dispatchEvent({type:`change`})}play(){this.plays||this.disposed||(this.plays=!0,this.last=null,this.watch(),this.ring.retry(),!this.loop&&(this.following??this.goal??this.shown.position)>=this.end&&this.toFrame(0),this.dispatchEvent({type:`change`}),this.wake())}pause(){this.plays&&(this.plays=!1,this.clock=this.shown.position,this.sound?.rest(),this.ring.plain&&this.begin(this.shown.position),this.dispatchEvent({type:`change`}))}seek(e){return ox(e),this.toFrame(I_(this.timeline,e))}toFrame(e){return ox(e),this.toPosition(this.lap+Math.min(Math.max(Math.round(e),0),this.frames-1))}step(e){ox(e),this.pause();let t=this.ring.stepped(this.following??this.goal??this.shown.position,Math.round(e));return this.loop?this.toPosition(t<0?t+this.frames:t):this.toPosition(Math.min(Math.max(t,this.lap),this.end))}update(e=performance.now()){if(this.disposed)return;let t=Math.max(e,this.last??e),n=this.last===null?0:Math.min((t-this.last)/1e3,ex);if(this.last=this.plays&&this.goal===null?t:null,this.goal===null&&!this.plays)return;this.goal===null?(this.advance(n),this.sound?.follow(this.first+this.clock%this.frames/this.rate,this.pace)):this.sound?.rest();let r=this.ring.take(this.goal??Math.floor(this.clock));r&&this.show(r),this.goal===null&&!this.loop&&this.clock>=this.end&&this.ring.isOver(this.end)&&this.pause()}dispose(){this.disposed=!0,this.plays=!1,globalThis.document?.removeEventListener(`visibilitychange`,this.hide),this.ring.dispose(),this.sound?.dispose(),this.settle()}get lap(){return this.shown.position-this.shown.number}get end(){return this.lap+this.frames-1}advance(e){let[t,n]=[this.clock,e*this.pace*this.rate],r=this.loop?this.ring.reach:Math.min(this.ring.reach,this.end);if(this.clock=Math.max(t,Math.min(t+n,r)),e>ix)return;let{watched:i}=this;i.seconds+=e,i.due+=n,this.ring.busy&&(i.short+=n-(this.clock-t)),i.seconds<nx||(i.short>rx*i.due&&this.ring.leaveOut(),this.watch())}watch(){this.watched={seconds:0,due:0,short:0}}hide=()=>{document.hidden&&this.sound?.rest()};toPosition(e){let t=new Promise(e=>void this.waiters.push(e));return this.goal===null?this.begin(e):this.following=e,t}begin(e){let t=this.ring.standIn(e);if(this.following=null,this.watch(),t===this.shown.position&&this.ring.follows(t))return this.goal=null,this.clock=t,this.settle();if(this.goal=this.ring.seek(t)?t:null,this.preview(),this.goal===null)return this.settle();this.dispatchEvent({type:`change`}),this.wake()}show(e){let{position:t,number:n}=e;this.shown={position:t,number:n},this.user.show(e),this.note(e),this.goal!==null&&t!==this.goal&&this.following===null?this.preview():this.goal!==null&&(this.goal=null,this.clock=t,this.following===null?this.settle():this.begin(this.following)),this.dispatchEvent({type:`frame`})}preview(){this.ring.previewsFrom=this.goal===null?1/0:performance.now()+tx}note({films:e}){let t=[];this.ring.sparse&&t.push(`keys`),e.some(e=>e?.grown)&&t.push(`bits`),e.includes(null)&&t.push(`textures`),t.join()!==this.lacking.join()&&(this.lacking=t,this.dispatchEvent({type:`change`}))}thin(){let e=this.following??this.goal;this.lacking=[`keys`],e!==null&&this.begin(e),this.dispatchEvent({type:`change`}),this.wake()}settle(){for(let e of this.waiters.splice(0))e();this.dispatchEvent({type:`change`})}wake(){this.asked!==null||this.disposed||!this.plays&&this.goal===null||(this.asked=requestAnimationFrame(e=>{this.asked=null,this.update(e),this.plays&&this.wake()}))}fail(e,t){if(this.disposed)return;this.user.failed(e),t===null&&(this.lacking=[],this.pause());let n=this.goal!==null&&R_(this.timeline,this.goal%this.frames);n===!1||t!==null&&n!==t||(this.goal!==null&&(this.clock=this.goal),this.goal=this.following=null,this.settle())}};function ox(e){if(!Number.isFinite(e))throw RangeError(`Times and numbers of frames are finite.`)}var sx=65535;function cx(e,t){let n=e.getAttribute(`position`),r=e.getAttribute(`uv`),{index:i}=e;if(!i)throw new ff(`damaged`,`The proxy mesh has no triangles; make or download the file again.`);if(r.count!==n.count)throw Q(t.uv.where,`${r.count} for ${n.count} vertices`);for(let e=0;e<n.count;e++){if(!(Math.max(Math.abs(n.getX(e)),Math.abs(n.getY(e)),Math.abs(n.getZ(e)))<=1e30))throw Q(t.position.where,`vertex ${e} is not finite`);if(!(Math.max(Math.abs(r.getX(e)),Math.abs(r.getY(e)))<=1e30))throw Q(t.uv.where,`texture coordinates of vertex ${e} are not finite`)}for(let e of i.array)if(e>=n.count)throw Q(t.indices.where,`no vertex ${e}`)}async function lx({view:e,codec:t,where:n},r){let i=t.decode(new Uint8Array(await r(e)),n);if(!i.indices.length)throw Q(n,`a mesh without faces`);return i}function ux({positions:e,uv:t,indices:n}){let r=new Un;r.setAttribute(`position`,new On(e.slice(),3)),r.setAttribute(`uv`,new On(t,2));let i=e.length/3<=sx;return r.setIndex(new On(i?Uint16Array.from(n):n,1)),r}function dx(e){return{vertices:e.getAttribute(`position`).count,triangles:(e.index?.count??0)/3}}var fx=256;function px(e,t,n){let{index:r}=e,i=e.getAttribute(`position`),a=e.getAttribute(`uv`);if(!r||!i||!a)return 0;let o=r.count/3,s=Math.max(1,Math.floor(o/fx)),c=[];for(let e=0;e<o;e+=s){let o=[0,1,2].map(t=>r.getX(3*e+t)),s=o.map(e=>mx(t,i.getX(e),i.getY(e),i.getZ(e))),l=hx(s),[u=NaN,d=NaN]=[0,1].map(e=>s.reduce((t,n)=>t+(n[e]??NaN)/3,0));if(!(l>0&&u>=0&&d>=0&&u<t.width&&d<t.height))continue;let f=hx(o.map(e=>[a.getX(e)*n[0],a.getY(e)*n[1]]));c.push({footprint:Math.sqrt(f/l),area:l})}c.sort((e,t)=>e.footprint-t.footprint);let l=c.reduce((e,{area:t})=>e+t,0)/2,u=0;return c.find(({area:e})=>(u+=e)>=l)?.footprint??0}function mx({K:e,R:t,t:n},r,i,a){let o=e=>t[e][0]*r+t[e][1]*i+t[e][2]*a+n[e],[s,c,l]=[o(0),o(1),o(2)];return l>0?[(e[0][0]*s+e[0][1]*c)/l+e[0][2],e[1][1]*c/l+e[1][2]]:[NaN,NaN]}function hx(e){let[[t=0,n=0]=[],[r=0,i=0]=[],[a=0,o=0]=[]]=e;return Math.abs((r-t)*(o-n)-(i-n)*(a-t))/2}var gx=`sheets`,_x=16,vx=`
precision highp float;
in vec3 position;
void main() { gl_Position = vec4(position, 1.0); }
`,yx=`${$y}${eb}
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
`,bx=new rt,xx=class{material;scene=new Ut;camera=new Oa;sheets=new _r;depth;screen;everywhere=new Un;target=null;constructor(e){this.material=e,this.depth=cb(e),this.depth.transparent=e.transparent=!0,this.sheets.frustumCulled=!1,this.sheets.onBeforeRender=(e,t,n,r,i,a)=>{let{materialIndex:o=0}=a,s=this.sheets.material.length/2,c=s-1-(o>>1);e.getContext().depthRange(c/s,(c+1)/s)},this.scene.add(this.sheets),this.scene.matrixWorldAutoUpdate=this.camera.matrixWorldAutoUpdate=!1;let{shown:t,photograph:n,toPhotograph:r}=e.uniforms;this.screen=new Mi({name:gx,glslVersion:I,vertexShader:vx,fragmentShader:yx,uniforms:{shown:t,photograph:n,toPhotograph:r,sheets:{value:null},solid:{value:null},nearest:{value:null},slices:{value:1},corner:{value:new H},size:{value:new H},toPlace:{value:new K}},transparent:!0,...ab});let i=new Float32Array([-1,-1,0,3,-1,0,-1,3,0]);this.everywhere.setAttribute(`position`,new On(i,3))}get bytes(){return this.target?_x*this.target.width*this.target.height:0}setGeometry(e,t){e.clearGroups();let n=0;t.forEach((t,r)=>{for(let i of[0,1])e.addGroup(n,3*t,2*r+i);n+=3*t}),this.sheets.geometry=e,this.sheets.material=t.flatMap(()=>[this.depth,this.material]),this.set(`slices`,t.length),e.computeBoundingBox(),e.computeBoundingSphere();let{boundingBox:r,boundingSphere:i}=e;Object.assign(this.everywhere,{boundingBox:r,boundingSphere:i})}attach(e,t){for(let t of[e.material].flat())t.visible=!1;let n=new _r(this.everywhere,this.screen);n.name=gx,n.raycast=()=>void 0,n.onBeforeRender=(n,r,i)=>{t(n,i),this.draw(n,i,e)},e.add(n)}set(e,t){Object.assign(this.screen.uniforms[e]??{},{value:t})}dispose(){this.target?.dispose(),this.depth.dispose(),this.screen.dispose()}draw(e,t,n){let{x:r,y:i,z:a,w:o}=t.viewport??e.getCurrentViewport(bx);if(!a||!o)return;(this.target?.width!==a||this.target.height!==o)&&(this.target?.dispose(),this.target=Sx(a,o));let{target:s}=this;this.sheets.matrixWorld.copy(n.matrixWorld),this.camera.matrixWorld.copy(t.matrixWorld),this.camera.matrixWorldInverse.copy(t.matrixWorldInverse),this.camera.projectionMatrix.copy(t.projectionMatrix),Ly(e,t,()=>{e.setRenderTarget(s),e.state.buffers.color.setMask(!0),e.clear(!0,!0,!1),e.render(this.scene,this.camera)}),e.getContext().depthRange(0,1);let{uniforms:c}=this.screen;this.set(`sheets`,s.textures[0]),this.set(`solid`,s.textures[1]),this.set(`nearest`,s.depthTexture),c.corner?.value.set(r,i),c.size?.value.set(a,o),(c.toPlace?.value).multiplyMatrices(t.projectionMatrix,t.matrixWorldInverse).multiply(n.matrixWorld).invert(),this.screen.uniformsNeedUpdate=!0}};function Sx(e,t){let n=new vi(e,t,g);n.format=y;let i=new at(e,t,{count:2,type:p,stencilBuffer:!0,depthTexture:n,minFilter:r,magFilter:r}),[,a]=i.textures;return a&&(a.type=l),i}var Cx=class{meshes;faces;reference;mesh;material;version=0;laid=0;detail=0;stack;constructor(e,t,n,r){this.meshes=e,this.faces=t,this.reference=n;let[i]=e;if(!i)throw Error(`a field needs a mesh`);this.mesh=i;let a=[i.material].flat().some(e=>e.side!==0);this.material=sb(a,t!==null),this.stack=t&&new xx(this.material);for(let t of e){let e=(e,n)=>r(e,n,t);this.stack?this.stack.attach(t,e):(t.material=this.material,t.onBeforeRender=(t,n,r)=>e(t,r))}this.show(t)}get geometry(){return this.mesh.geometry}get bytes(){return this.stack?.bytes??0}setGeometry(e,t=this.faces){let n=this.geometry;if(n!==e){let{index:r,attributes:i}=e;if(!r||!i.position||!i.uv)throw TypeError(`A surface needs position, uv and an index.`);this.stack&&t&&C_({faces:t,where:`the geometry`},e),n.dispose()}for(let t of this.meshes)t.geometry=e;e.boundingBox=e.boundingSphere=null,this.faces=t,this.version+=1,n!==e&&(this.laid=this.version),this.show(t)}show(e){e&&this.stack?.setGeometry(this.geometry,e),this.detail=this.reference?px(this.geometry,this.reference,[1,1]):0}dispose(){this.stack?.dispose(),this.material.dispose(),this.geometry.dispose()}};function wx(e){let t=e.getContext();if(!(t instanceof WebGL2RenderingContext))throw new ff(`unsupported`,`Eigen textures need WebGL 2; use a newer browser.`);if((t.getExtension(`EXT_color_buffer_float`)??t.getExtension(`EXT_color_buffer_half_float`))||t.isContextLost())return t;throw new ff(`unsupported`,`The graphics of this device draw no half-floats; use a newer device or browser, or switch graphics acceleration on.`)}function Tx(e,t){return{side:e.getParameter(e.MAX_TEXTURE_SIZE),layers:e.getParameter(e.MAX_ARRAY_TEXTURE_LAYERS),memory:t}}function Ex(e,{components:t,halves:n}){return t>2?n?e.RGBA16F:e.RGBA8:t>1?n?e.RG16F:e.RG8:n?e.R16F:e.R8}function Dx(e,[t,n],r,i,a){return jx(e,e.TEXTURE_2D_ARRAY,()=>{e.texStorage3D(e.TEXTURE_2D_ARRAY,1,Ex(e,a),t,n,r);for(let t of[e.TEXTURE_WRAP_S,e.TEXTURE_WRAP_T])e.texParameteri(e.TEXTURE_2D_ARRAY,t,e.CLAMP_TO_EDGE);for(let t of[e.TEXTURE_MIN_FILTER,e.TEXTURE_MAG_FILTER])e.texParameteri(e.TEXTURE_2D_ARRAY,t,i?e.LINEAR:e.NEAREST)})}function Ox(e,t,n,r){let{width:i,height:a}=n,o=r>2?e.RGBA:r>1?e.RG:e.RED;Mx(e,e.TEXTURE_2D_ARRAY,t,()=>e.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,0,i,a,1,o,e.UNSIGNED_BYTE,n))}function kx(e,t,n,r){Mx(e,e.TEXTURE_2D_ARRAY,t,()=>{e.pixelStorei(e.UNPACK_ALIGNMENT,1),r.forEach(({data:t,width:r,height:i,stride:a},o)=>{e.pixelStorei(e.UNPACK_ROW_LENGTH,a/2),e.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,n+o,r,i,1,e.RG,e.UNSIGNED_BYTE,t)})})}function Ax(e,[t,n],r){return jx(e,e.TEXTURE_2D,()=>{e.texStorage2D(e.TEXTURE_2D,1,Ex(e,r),t,n);for(let t of[e.TEXTURE_MIN_FILTER,e.TEXTURE_MAG_FILTER])e.texParameteri(e.TEXTURE_2D,t,e.NEAREST)})}function jx(e,t,n){for(;e.getError()!==e.NO_ERROR&&!e.isContextLost(););let r=e.createTexture();return Mx(e,t,r,n),e.getError()===e.OUT_OF_MEMORY?(e.deleteTexture(r),null):r}function Mx(e,t,n,r){let i=t===e.TEXTURE_2D_ARRAY,a=e.getParameter(i?e.TEXTURE_BINDING_2D_ARRAY:e.TEXTURE_BINDING_2D),o=[[e.UNPACK_FLIP_Y_WEBGL,!1],[e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1],[e.UNPACK_COLORSPACE_CONVERSION_WEBGL,e.NONE],[e.UNPACK_ALIGNMENT,4],[e.UNPACK_ROW_LENGTH,0],[e.UNPACK_IMAGE_HEIGHT,0],[e.UNPACK_SKIP_PIXELS,0],[e.UNPACK_SKIP_ROWS,0],[e.UNPACK_SKIP_IMAGES,0]],s=o.map(([t])=>[t,e.getParameter(t)]),c=e.getParameter(e.PIXEL_UNPACK_BUFFER_BINDING);c&&e.bindBuffer(e.PIXEL_UNPACK_BUFFER,null),o.forEach(([t,n])=>e.pixelStorei(t,n)),e.bindTexture(t,n),r(),e.bindTexture(t,a),s.forEach(([t,n])=>e.pixelStorei(t,n)),c&&e.bindBuffer(e.PIXEL_UNPACK_BUFFER,c)}function Nx(e,t,n){let r=e.createProgram();for(let[i,a]of[[e.VERTEX_SHADER,t],[e.FRAGMENT_SHADER,n]]){let t=e.createShader(i);t&&(e.shaderSource(t,a),e.compileShader(t),e.attachShader(r,t),e.deleteShader(t))}return e.linkProgram(r),r}function Px(e,t,n,r){if(!n){r();return}let i=e.getParameter(e.ACTIVE_TEXTURE);e.activeTexture(e.TEXTURE0+t);let a=e.getParameter(e.SAMPLER_BINDING);e.bindSampler(t,null),Mx(e,e.TEXTURE_2D,n,r),e.bindSampler(t,a),e.activeTexture(i)}function Fx(e,t){let n=[e.BLEND,e.CULL_FACE,e.DEPTH_TEST,e.DITHER,e.RASTERIZER_DISCARD,e.SAMPLE_ALPHA_TO_COVERAGE,e.SAMPLE_COVERAGE,e.SCISSOR_TEST,e.STENCIL_TEST].filter(t=>e.isEnabled(t)),r=e.getParameter(e.CURRENT_PROGRAM),i=e.getParameter(e.VERTEX_ARRAY_BINDING),a=e.getParameter(e.DRAW_FRAMEBUFFER_BINDING),[o=0,s=0,c=0,l=0]=e.getParameter(e.VIEWPORT),[u,d,f,p]=e.getParameter(e.COLOR_WRITEMASK);n.forEach(t=>e.disable(t)),t(),n.forEach(t=>e.enable(t)),e.useProgram(r&&e.isProgram(r)?r:null),e.bindVertexArray(i),e.bindFramebuffer(e.DRAW_FRAMEBUFFER,a),e.viewport(o,s,c,l),e.colorMask(u??!0,d??!0,f??!0,p??!0)}function Ix(e,t){let n=Nx(e,...qb),r=e.createFramebuffer(),i=null,a=(t,i,a)=>{let{index:o}=t,s=t.getAttribute(`uv`),c=Float32Array.from({length:2*(o?.count??0)},(e,t)=>{let n=o?.getX(t>>1)??0;return t%2?s.getY(n):s.getX(n)}),[l,u]=[e.createVertexArray(),e.createBuffer()],d=e.getParameter(e.ARRAY_BUFFER_BINDING);Fx(e,()=>{e.useProgram(n),e.bindVertexArray(l),e.bindBuffer(e.ARRAY_BUFFER,u),e.bufferData(e.ARRAY_BUFFER,c,e.STREAM_DRAW);let t=e.getAttribLocation(n,`uv`);e.enableVertexAttribArray(t),e.vertexAttribPointer(t,2,e.FLOAT,!1,0,0),e.bindFramebuffer(e.DRAW_FRAMEBUFFER,r),e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,a,0),e.viewport(0,0,...i),e.colorMask(!0,!0,!0,!0),e.drawArrays(e.TRIANGLES,0,c.length/2)}),e.bindBuffer(e.ARRAY_BUFFER,d),e.deleteBuffer(u),e.deleteVertexArray(l)};return{covered(n){let{geometry:r}=t;if(i?.grid.join()!==n.join()||i.geometry!==r){e.deleteTexture(i?.texture??null);let t=Ax(e,n,{components:1,halves:!1});t&&a(r,n,t),i={geometry:r,grid:n,texture:t}}return i.texture},free(){e.deleteTexture(i?.texture??null),e.deleteFramebuffer(r),e.deleteProgram(n)}}}var Lx=[`precisions`,`covered`,`factors`,`size`,`made`,`first`,`corner`,`nodes`,`zero`];function Rx(e,t,n,r){let[i,a,o]=[Nx(e,Ub,Wb),Nx(e,Ub,Gb),Nx(e,Ub,Kb)],[s,c]=[e.createFramebuffer(),e.createVertexArray()],l=t.smaller&&Ix(e,r),u=t=>Object.fromEntries(Lx.map(n=>[n,e.getUniformLocation(t,n)])),[d,f]=[u(i),u(a)],p=(t,n,r,i,a,o,s)=>{let{picture:c,rows:l}=n,{size:u,corner:d,unit:f,codes:p}=i;zx(c)?e.uniform4f(t.factors,255*f,65280*f,0,0):e.uniform4fv(t.factors,[0,1,2,3].map(e=>e===r?p*f:0)),e.uniform2i(t.size,c.width,l),e.uniform2i(t.made,...u),e.uniform2i(t.corner,...d),e.uniform1i(t.first,a),e.viewport(0,o,u[0],s),e.drawArrays(e.TRIANGLES,0,3)},m=(t,n)=>{e.bindFramebuffer(e.DRAW_FRAMEBUFFER,s),n===null?e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,t,0):e.framebufferTextureLayer(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0,t,0,n)},h=(t,{layer:n,component:r})=>{m(t,n),e.colorMask(r===0,r===1,r===2,r===3)},g=(r,s,u,g,_,v)=>{let{picture:y,row:b,rows:x}=r,[S,C]=_.size,w=S<y.width||C<x?t.smaller:null,T=Math.max(1,Math.floor((w?n-2:n)*C/x)),E=(w&&l?.covered(_.grid))??null;Px(e,0,s,()=>{for(let t=0;t<C;t+=T){let n=Math.min(T,C-t),o=Math.floor(t*x/C),s=Math.ceil((t+n)*x/C);zx(y)?Vx(e,y,b+o,s-o):Bx(e,y,b+o,s-o),Px(e,2,E,()=>Fx(e,()=>{let s=w||v?f:d;e.useProgram(w||v?a:i),e.bindVertexArray(c),e.uniform1i(s.precisions,+!!v),e.uniform1i(s.covered,w?2:0),e.uniform2i(s.nodes,v?.precision.width??0,v?.precision.height??0),e.uniform1f(s.zero,v?.zero??0),w?(m(w,null),e.colorMask(!0,!0,!0,!0)):h(u,g),p(s,r,g.channel,_,o,t,n)}))}}),w&&Px(e,0,w,()=>Fx(e,()=>{e.useProgram(o),e.bindVertexArray(c),e.uniform2i(e.getUniformLocation(o,`size`),S,C),h(u,g),e.viewport(0,0,S,C),e.drawArrays(e.TRIANGLES,0,3)}))};return{put(n,r,i,a,o=null){let s=zx(n.picture)?t.codes:t.picture;if(!s)return;let c=()=>i.forEach(e=>g(n,s,r,e,a,o));o?Px(e,1,t.precision,()=>{Bx(e,o.precision,0,o.precision.height),c()}):c()},free(){for(let n of Object.values(t))e.deleteTexture(n);l?.free(),e.deleteVertexArray(c),e.deleteFramebuffer(s);for(let t of[i,a,o])e.deleteProgram(t)}}}function zx(e){return`data`in e}function Bx(e,t,n,r){e.pixelStorei(e.UNPACK_SKIP_ROWS,n),e.texSubImage2D(e.TEXTURE_2D,0,0,0,t.width,r,e.RGBA,e.UNSIGNED_BYTE,t)}function Vx(e,{data:t,width:n,stride:r},i,a){e.pixelStorei(e.UNPACK_ALIGNMENT,1),e.pixelStorei(e.UNPACK_ROW_LENGTH,r/2),e.texSubImage2D(e.TEXTURE_2D,0,0,0,n,a,e.RG,e.UNSIGNED_BYTE,t,i*r)}var Hx=class{parts;source;surface;options;means;bases;ready;plan=null;version=0;onPlan=()=>void 0;onTexture=()=>void 0;onComplete=()=>void 0;onError=()=>void 0;needs;layout;stillVersions;renderer=null;packer=null;turn=new AbortController;disposed=!1;constructor(e,t,n,r){this.parts=e,this.source=t,this.surface=n,this.options=r;let{scene:i,info:a,meanSizes:o}=e,s=i.planes.flatMap(({channels:e,bases:t})=>t.map(t=>({...t,channels:e,tenBits:c_(t.pictures)})));this.layout=s;let c=J_(i).map(({channels:e,mean:t},n)=>{let r=n===i.planes.length;return{size:o[n]??[1,1],channels:e,pieces:t.pieces,tenBits:c_([t]),opacity:r}}),l=J_(i).some(({mean:e})=>e.part),u=Wx(n.geometry);this.needs={atlas:a.size,means:c,bases:s,films:l,rays:a.facesPlane,geometry:u},this.means=c.map(()=>new bi),this.bases=s.map(()=>new bi),this.ready=s.map(({count:e})=>Array(e).fill(!1)),this.stillVersions=c.map(()=>0)}get hasMeans(){return this.stillVersions.every(e=>e>0)}get opacityVersion(){return this.stillVersions[this.parts.scene.planes.length]??0}get loaded(){let e=this.ready.map(e=>e.indexOf(!1)).filter(e=>e>=0),t=Math.max(0,...this.ready.map(e=>e.length));return Math.min(t,...e)}get bytes(){return this.plan?this.plan.bytes-this.needs.geometry+Wx(this.surface.geometry):0}serves(e){return this.disposed||this.renderer===e?!0:this.renderer!==null&&!this.renderer.getContext().isContextLost()}attach(e){if(this.disposed)return;this.detach(),this.renderer=e,e.domElement.addEventListener(`webglcontextlost`,this.forget),e.domElement.addEventListener(`webglcontextrestored`,this.onRestored);let{signal:t}=this.turn;this.load(e,t).catch(e=>{t.aborted||this.onError(e)})}dispose(){this.detach(),this.disposed=!0,this.source.dispose()}detach(){let e=this.renderer?.getContext();this.packer?.free(),this.renderer?.domElement.removeEventListener(`webglcontextlost`,this.forget),this.renderer?.domElement.removeEventListener(`webglcontextrestored`,this.onRestored),this.renderer=null;for(let{sourceTexture:t}of[...this.means,...this.bases])e&&t instanceof WebGLTexture&&e.deleteTexture(t);this.forget()}forget=()=>{this.turn.abort(),this.turn=new AbortController,this.version+=1,this.packer=null,this.stillVersions.fill(0),this.ready.forEach(e=>e.fill(!1));for(let e of[...this.means,...this.bases])e.sourceTexture=null};onRestored=()=>{this.renderer&&this.attach(this.renderer)};async load(e,t){let n=wx(e);if(n.isContextLost())return;let{packer:r,plan:i}=this.makeRoom(n);this.plan=i,this.packer=r,this.onPlan(i),await this.source.fill(this.filling(n,i,t)),t.aborted||this.onComplete()}filling(e,t,n){return{plan:t,signal:n,putMean:(r,i)=>{n.aborted||this.putMean(e,t,r,i)},putTextures:(r,i,a,o)=>{n.aborted||this.putTextures(e,t,r,i,a,o)},announce:()=>{n.aborted||this.onTexture()},end:()=>{n.aborted||(this.packer?.free(),this.packer=null)}}}putTextures(e,t,n,r,i,a){let{usable:o,scaleDown:s,halves:c,words:l}=t,[u,d,f]=[this.bases[n]?.sourceTexture,this.ready[n],this.layout[n]];if(!(u instanceof WebGLTexture)||!d||!f)return;let{size:p,grid:m,corner:h,channels:g,tenBits:_}=f;l&&kx(e,u,g*r,Ux(i.slice(0,g*(o-r))));let v=u_(a,c&&_),y={size:$v(p,s),grid:m,corner:h,unit:v,codes:255*l_(a)};for(let e=r;e<Math.min(r+a.textures,o);e++){let t=i.slice((e-r)*a.pieces,(e-r+1)*a.pieces),n=g*Math.floor(e/4);l||this.put(t,u,g,y,t=>({layer:n+t,component:e%4})),d[e]=!0}this.version+=1}putMean(e,t,n,{pieces:r,precision:i}){let[a,o]=[this.means[n]?.sourceTexture,J_(this.parts.scene)[n]],{size:s,tenBits:c}=this.needs.means[n]??{};if(!(a instanceof WebGLTexture)||!o||!s)return;if(this.stillVersions[n]=this.version+=1,t.words)return kx(e,a,0,Ux(r));let{mean:l,channels:u}=o,d=$v(s,t.meanDown),[f]=r;if(f&&r.length===1&&`close`in f.picture&&!c&&d.join()===s.join()){Ox(e,a,f.picture,u);return}let p={size:d,grid:s,corner:[0,0],unit:u_(l,c===!0),codes:255*l_(l)};this.put(r,a,u,p,e=>({layer:Math.floor(e/4),component:e%4}),e=>i&&{precision:i,zero:l.zero[e]??0})}put(e,t,n,r,i,a=()=>null){let o=e.length<n;e.forEach((e,n)=>{let s=(o?[0,1,2]:[n]).map(e=>({channel:o?e:0,...i(e)}));this.packer?.put(e,t,s,r,a(n))})}makeRoom(e){let{means:t,bases:n}=this.needs;this.needs.geometry=Wx(this.surface.geometry);let r=this.parts.scene.planes.flatMap(({precision:e})=>e?[e.size]:[]);for(let i=this.options.memory??Zv();;i/=2){let a=cy(this.needs,Tx(e,i)),{meanDown:o,scaleDown:s,usable:c,halves:l,words:u}=a,d=o!==s,f=[...t.map(({size:t,channels:n,tenBits:r})=>{if(u)return Dx(e,t,n,!1,Wv);let i={components:n,halves:r};return Dx(e,$v(t,o),ty(n),!1,i)}),...n.map(({size:t,channels:n,count:r,tenBits:i})=>{let a=Math.min(r,c);return u&&a?Dx(e,t,n*a,!1,Wv):Dx(e,a?$v(t,s):[1,1],a?ny(a,n):1,d,{components:Math.max(1,a),halves:l&&i})})],p=()=>{[...this.means,...this.bases].forEach((e,t)=>e.sourceTexture=f[t]??null)};if(u&&!f.includes(null))return p(),{packer:null,plan:a};let m=dy(this.needs,a,i),[h,g,_]=[m.picture,m.codes,m.smaller].map(t=>t?Ax(e,t.size,t.format):null),v=Ax(e,fy(r),Uv);if(h&&v&&(g||!m.codes)&&(_||!m.smaller)&&!f.includes(null))return p(),{packer:Rx(e,{picture:h,codes:g??null,precision:v,smaller:_??null},m.picture.size[1],this.surface),plan:a};for(let t of[...f,h,g,_,v])e.deleteTexture(t??null);if(!c)throw new ff(`unsupported`,`The graphics memory is full; close other pages and try again.`)}}};function Ux(e){return e.map(({picture:e})=>e)}function Wx({attributes:e,index:t}){return Object.values(e).reduce((e,t)=>e+t.array.byteLength,0)+(t?.array.byteLength??0)}var Gx=1.5,Kx=.001,qx=class extends me{parts;source;mesh;info;total;count=1/0;weightMode;mixing=`delaunay`;filter;coarser=1;camera=null;exposure=null;view=`picture`;eigen=0;photograph=null;lastWeights=[];lastByRay=!1;player;complete;giveUp=()=>void 0;surface;textures;weights;group;plain=!1;moved;summed={parts:[],opacity:null};composers=new Map;encoded;gains=new Map;frame=-1;constructor(e,t,n={}){super(),this.parts=e,this.source=t;let{scene:r,info:i}=e,a=r.sheets?.faces??null;this.surface=new Cx(e.meshes,a,i.cameras[i.reference],(...e)=>this.prepare(...e)),this.mesh=this.surface.mesh,this.info=i,this.total=Sv(r),this.filter=n.filter??`bicubic`,this.weightMode=i.facesPlane?`ray`:`eye`,this.encoded=i.cameras.filter((e,t)=>!i.heldOut[t]),this.weights=this.weightsOf(e.omega),this.group=e.clip&&e.clip.group,this.player=e.clip&&this.makePlayer(e.clip),this.moved=e.clip&&this.surface.geometry,e.clip&&this.shape(e.clip.group,0,e.clip.mesh,!1),this.textures=new Hx(e,t,this.surface,n),this.complete=new Promise((e,t)=>{this.giveUp=t,this.addEventListener(`complete`,()=>e()),this.addEventListener(`error`,({error:e})=>t(e))}),this.complete.catch(()=>void 0),this.listen(),n.renderer&&this.textures.attach(n.renderer)}get usable(){return this.textures.plan?.usable??this.total}get loaded(){return this.textures.loaded}get scaleDown(){return this.textures.plan?.scaleDown??1}get reductions(){return this.textures.plan?.reductions??[]}get limitation(){return this.textures.plan?.limitation??null}get gpuBytes(){return this.textures.bytes+this.surface.bytes}viewWeights(e,t,n=this.mixing){return this.weights.viewsAt(e,t,n)}componentWeights(e,t){return this.weights.at(e,t,this.mixing)}cameraWeights(e){return this.weights.ofCamera(e,this.mixing)}setGeometry(e,t){this.surface.setGeometry(e,t)}restore(e){this.textures.attach(e)}dispose(){this.giveUp(new DOMException(`The field was disposed of.`,`AbortError`)),this.player?.dispose(),this.textures.dispose(),this.freeComposers(),this.surface.dispose(),this.weights.dispose()}listen(){this.textures.onPlan=e=>{let{scene:t}=this.parts;this.freeComposers(),this.summed={parts:Jb(t,this.textures,e),opacity:Xb(t,this.textures,e)},e.limitation&&queueMicrotask(()=>this.dispatchEvent({type:`limited`}))},this.textures.onTexture=()=>this.dispatchEvent({type:`texture`}),this.textures.onComplete=()=>this.dispatchEvent({type:`complete`}),this.textures.onError=e=>this.fail(e)}finestOf([e,t],n){return Gx*Math.max(1,this.surface.detail*Math.sqrt(e*t)/n)}weightsOf(e){let{scene:t,info:n,weights:r}=this.parts;return new qy(n,xv(t).map(({count:e})=>e),e,r)}makePlayer({timeline:e,ring:t,sound:n}){return new ax(e,t,{show:e=>this.showFrame(e),failed:e=>this.dispatchEvent({type:`error`,error:hf(e)})},n)}showFrame({number:e,group:t,films:n}){this.group&&this.shape(t,e-t.first,this.group.mesh,this.group.motion!==null),t!==this.group&&this.enter(t),this.plain=n.includes(null),this.source instanceof gb&&this.source.show(n)}shape({mesh:e,motion:t},n,r,i){if(this.surface.geometry!==this.moved||e===r&&!t&&!i)return;let a=e===r?this.moved:ux(e),o=a.getAttribute(`position`);t?t.place(n,o.array):o.copyArray(e.positions),o.needsUpdate=!0,this.moved=a,this.surface.setGeometry(a)}enter(e){let{scene:t}=this.parts,{plan:n}=this.textures;this.group=e,this.weights.dispose(),this.weights=this.weightsOf(e.omega),Mb(t,e),n&&Yb(this.summed.parts,t,this.textures,n)}prepare(e,t,n){this.textures.serves(e)||this.textures.attach(e);let r=Xx(t,n),[i,a]=Ov(this.info.viewPlane,r),o=this.camera!==null&&this.info.cameras[this.camera]?this.camera:null,s=o===null?this.componentWeights(i,a):this.cameraWeights(o),c=o===null&&this.weightMode===`ray`&&this.info.facesPlane&&!this.isOnPlane(r),{material:l}=this.surface;this.setView(),this.setExposure(o,[i,a]);let u=Yy[this.filter];l.defines.BICUBIC!==u&&(l.defines.BICUBIC=u,l.needsUpdate=!0),l.uniformsNeedUpdate=!0,this.compose(e,t,this.recipe(s,c?r:null)),e.info.render.frame!==this.frame&&(this.lastWeights=[]),this.frame=e.info.render.frame,this.lastWeights.push(s),this.lastByRay=c}compose(e,t,n){let{plan:r}=this.textures,{size:i,viewPlane:a}=this.info;if(!r)return;let o=r.meanDown*this.coarser,s=this.composers.get(o);if(!s){let{parts:e,opacity:t}=this.summed;s=new zy(i,e,t,o,this.coarser>1,this.surface,a),this.composers.set(o,s)}s.compose(e,t,n);let{composed:c,finest:l}=this.surface.material.uniforms;c.value=s.texture,l.value=this.finestOf(i,o)}freeComposers(){for(let e of this.composers.values())e.dispose();this.composers.clear()}recipe(e,t){let n=this.surface.material.uniforms.shown.value,r=n===Xy.eigen?this.shownEigen:null;return{version:this.textures.version,mean:this.textures.hasMeans&&r===null,opacity:this.textures.opacityVersion,only:r,count:n===Xy.mean||this.plain?0:Math.max(0,Math.floor(Math.min(this.count,this.total))),weights:e,eye:t&&Ay(this.info.viewPlane,t),places:t?this.surface.version:this.coarser>1?this.surface.laid:0,maps:t&&this.weights.maps(this.mixing,this.usable)}}setExposure(e,t){let{cameras:n,heldOut:r,mixedColours:i,viewPlane:a}=this.info,o=this.exposure??(i||this.showsErrors?e:null),s=o===null?void 0:n[o],c=[[s,1]];if(i&&(o===null||r[o])){let e=s?Ov(a,s.centre):t,{camera:n,weight:r}=this.parts.weights.at(...e,this.mixing);c=[0,1,2,3].map(e=>[this.encoded[n[e]??0],r[e]??0])}let{scale:l,bias:u}=Bv(c),{exposureScale:d,exposureBias:f}=this.surface.material.uniforms;d.value.fromArray(l),f.value.fromArray(u)}get showsErrors(){return this.view===`error`&&this.photograph!==null&&this.camera!==null}setView(){let{uniforms:e}=this.surface.material,t=this.showsErrors,n=this.view===`error`&&!t?`picture`:this.view,r=this.shownEigen;e.shown.value=Xy[n===`eigen`&&(this.plain||r>=this.loaded)?`mean`:n],n===`eigen`&&(e.shownGain.value=this.gainOf(r));let i=t&&this.info.cameras[this.camera??0];i&&this.photograph&&lb(e,i,this.photograph)}get shownEigen(){return Math.min(Math.max(0,Math.floor(this.eigen)),this.total-1)}gainOf(e){let t=this.gains.get(e);return t!==void 0||e<0?t??1:(this.gains.set(e,1),this.source.gain(e).then(t=>{this.gains.set(e,t),this.dispatchEvent({type:`texture`})}).catch(()=>void 0),1)}isOnPlane(e){let{origin:t,normal:n,extent:r}=this.info.viewPlane,i=e.reduce((e,r,i)=>e+(r-(t[i]??0))*(n[i]??0),0);return Math.abs(i)<=Kx*Math.max(...r)}fail(e){if(Zx(e))return;let t=hf(e),n=`${t.message} The picture is drawn with ${this.loaded} of ${this.total} eigen textures.`,r=this.textures.hasMeans?n:t.message;this.dispatchEvent({type:`error`,error:new ff(t.code,r,t.where)})}},Jx=new K,Yx=new W;function Xx(e,t){return Yx.setFromMatrixPosition(e.matrixWorld).applyMatrix4(Jx.copy(t.matrixWorld).invert()),[Yx.x,Yx.y,Yx.z]}function Zx(e){return e instanceof DOMException&&e.name===`AbortError`}function Qx(e,t){if(t===0)return console.warn(`THREE.BufferGeometryUtils.toTrianglesDrawMode(): Geometry already defined as triangles.`),e;if(t===2||t===1){let n=e.getIndex();if(n===null){let t=[],r=e.getAttribute(`position`);if(r!==void 0){for(let e=0;e<r.count;e++)t.push(e);e.setIndex(t),n=e.getIndex()}else return console.error(`THREE.BufferGeometryUtils.toTrianglesDrawMode(): Undefined position attribute. Processing not possible.`),e}let r=n.count-2,i=[];if(t===2)for(let e=1;e<=r;e++)i.push(n.getX(0)),i.push(n.getX(e)),i.push(n.getX(e+1));else for(let e=0;e<r;e++)e%2==0?(i.push(n.getX(e)),i.push(n.getX(e+1)),i.push(n.getX(e+2))):(i.push(n.getX(e+2)),i.push(n.getX(e+1)),i.push(n.getX(e)));return i.length/3!==r&&console.error(`THREE.BufferGeometryUtils.toTrianglesDrawMode(): Unable to generate correct amount of triangles.`),e.setIndex(i),e.clearGroups(),e}return console.error(`THREE.BufferGeometryUtils.toTrianglesDrawMode(): Unknown draw mode:`,t),e}function $x(e){let t=new Map,n=new Map,r=e.clone();return eS(e,r,function(e,r){t.set(r,e),n.set(e,r)}),r.traverse(function(e){if(!e.isSkinnedMesh)return;let r=e,i=t.get(e),a=i.skeleton.bones;r.skeleton=i.skeleton.clone(),r.bindMatrix.copy(i.bindMatrix),r.skeleton.bones=a.map(function(e){return n.get(e)}),r.bind(r.skeleton,r.bindMatrix)}),r}function eS(e,t,n){n(e,t);for(let r=0;r<e.children.length;r++)eS(e.children[r],t.children[r],n)}var tS=class extends fa{constructor(e){super(e),this.dracoLoader=null,this.ktx2Loader=null,this.meshoptDecoder=null,this.pluginCallbacks=[],this.register(function(e){return new sS(e)}),this.register(function(e){return new cS(e)}),this.register(function(e){return new lS(e)}),this.register(function(e){return new vS(e)}),this.register(function(e){return new yS(e)}),this.register(function(e){return new bS(e)}),this.register(function(e){return new dS(e)}),this.register(function(e){return new fS(e)}),this.register(function(e){return new pS(e)}),this.register(function(e){return new mS(e)}),this.register(function(e){return new oS(e)}),this.register(function(e){return new hS(e)}),this.register(function(e){return new uS(e)}),this.register(function(e){return new _S(e)}),this.register(function(e){return new gS(e)}),this.register(function(e){return new iS(e)}),this.register(function(e){return new xS(e,$.EXT_MESHOPT_COMPRESSION)}),this.register(function(e){return new xS(e,$.KHR_MESHOPT_COMPRESSION)}),this.register(function(e){return new SS(e)})}load(e,t,n,r){let i=this,a;if(this.resourcePath!==``)a=this.resourcePath;else if(this.path!==``){let t=Ba.extractUrlBase(e);a=Ba.resolveURL(t,this.path)}else a=Ba.extractUrlBase(e);this.manager.itemStart(e);let o=function(t){r?r(t):console.error(t),i.manager.itemError(e),i.manager.itemEnd(e)},s=new ha(this.manager);s.setPriority(this.priority),s.setCache(this.cache),s.setPath(this.path),s.setResponseType(`arraybuffer`),s.setRequestHeader(this.requestHeader),s.setWithCredentials(this.withCredentials),s.load(e,function(n){try{i.parse(n,a,function(n){t(n),i.manager.itemEnd(e)},o)}catch(e){o(e)}},n,o)}setDRACOLoader(e){return this.dracoLoader=e,this}setKTX2Loader(e){return this.ktx2Loader=e,this}setMeshoptDecoder(e){return this.meshoptDecoder=e,this}register(e){return this.pluginCallbacks.indexOf(e)===-1&&this.pluginCallbacks.push(e),this}unregister(e){return this.pluginCallbacks.indexOf(e)!==-1&&this.pluginCallbacks.splice(this.pluginCallbacks.indexOf(e),1),this}parse(e,t,n,r){let i,a={},o={},s=new TextDecoder;if(typeof e==`string`)i=JSON.parse(e);else if(e instanceof ArrayBuffer){if(s.decode(new Uint8Array(e,0,4))===CS){try{a[$.KHR_BINARY_GLTF]=new ES(e)}catch(e){r&&r(e);return}i=JSON.parse(a[$.KHR_BINARY_GLTF].content)}else i=JSON.parse(s.decode(e))}else i=e;if(i.asset===void 0||i.asset.version[0]<2){r&&r(Error(`THREE.GLTFLoader: Unsupported asset. glTF versions >=2.0 are supported.`));return}let c=new QS(i,{path:t||this.resourcePath||``,crossOrigin:this.crossOrigin,priority:this.priority,cache:this.cache,withCredentials:this.withCredentials,requestHeader:this.requestHeader,manager:this.manager,ktx2Loader:this.ktx2Loader,meshoptDecoder:this.meshoptDecoder});c.fileLoader.setRequestHeader(this.requestHeader);for(let e=0;e<this.pluginCallbacks.length;e++){let t=this.pluginCallbacks[e](c);t.name||console.error(`THREE.GLTFLoader: Invalid plugin found: missing name`),o[t.name]=t,a[t.name]=!0}if(i.extensionsUsed)for(let e=0;e<i.extensionsUsed.length;++e){let t=i.extensionsUsed[e],n=i.extensionsRequired||[];switch(t){case $.KHR_MATERIALS_UNLIT:a[t]=new aS;break;case $.KHR_DRACO_MESH_COMPRESSION:a[t]=new DS(i,this.dracoLoader);break;case $.KHR_TEXTURE_TRANSFORM:a[t]=new OS;break;case $.KHR_MESH_QUANTIZATION:a[t]=new kS;break;default:n.indexOf(t)>=0&&o[t]===void 0&&console.warn(`THREE.GLTFLoader: Unknown extension "`+t+`".`)}}c.setExtensions(a),c.setPlugins(o),c.parse(n,r)}parseAsync(e,t){let n=this;return new Promise(function(r,i){n.parse(e,t,r,i)})}};function nS(){let e={};return{get:function(t){return e[t]},add:function(t,n){e[t]=n},remove:function(t){delete e[t]},removeAll:function(){e={}}}}function rS(e,t,n){let r=e.json.materials[t];return r.extensions&&r.extensions[n]?r.extensions[n]:null}var $={KHR_BINARY_GLTF:`KHR_binary_glTF`,KHR_DRACO_MESH_COMPRESSION:`KHR_draco_mesh_compression`,KHR_LIGHTS_PUNCTUAL:`KHR_lights_punctual`,KHR_MATERIALS_CLEARCOAT:`KHR_materials_clearcoat`,KHR_MATERIALS_DIFFUSE_ROUGHNESS:`KHR_materials_diffuse_roughness`,KHR_MATERIALS_DISPERSION:`KHR_materials_dispersion`,KHR_MATERIALS_IOR:`KHR_materials_ior`,KHR_MATERIALS_SHEEN:`KHR_materials_sheen`,KHR_MATERIALS_SPECULAR:`KHR_materials_specular`,KHR_MATERIALS_TRANSMISSION:`KHR_materials_transmission`,KHR_MATERIALS_IRIDESCENCE:`KHR_materials_iridescence`,KHR_MATERIALS_ANISOTROPY:`KHR_materials_anisotropy`,KHR_MATERIALS_UNLIT:`KHR_materials_unlit`,KHR_MATERIALS_VOLUME:`KHR_materials_volume`,KHR_TEXTURE_BASISU:`KHR_texture_basisu`,KHR_TEXTURE_TRANSFORM:`KHR_texture_transform`,KHR_MESH_QUANTIZATION:`KHR_mesh_quantization`,KHR_MATERIALS_EMISSIVE_STRENGTH:`KHR_materials_emissive_strength`,EXT_MATERIALS_BUMP:`EXT_materials_bump`,EXT_TEXTURE_WEBP:`EXT_texture_webp`,EXT_TEXTURE_AVIF:`EXT_texture_avif`,EXT_MESHOPT_COMPRESSION:`EXT_meshopt_compression`,KHR_MESHOPT_COMPRESSION:`KHR_meshopt_compression`,EXT_MESH_GPU_INSTANCING:`EXT_mesh_gpu_instancing`},iS=class{constructor(e){this.parser=e,this.name=$.KHR_LIGHTS_PUNCTUAL,this.cache={refs:{},uses:{}}}_markDefs(){let e=this.parser,t=this.parser.json.nodes||[];for(let n=0,r=t.length;n<r;n++){let r=t[n];r.extensions&&r.extensions[this.name]&&r.extensions[this.name].light!==void 0&&e._addNodeRef(this.cache,r.extensions[this.name].light)}}_loadLight(e){let t=this.parser,n=`light:`+e,r=t.cache.get(n);if(r)return r;let i=t.json,a=((i.extensions&&i.extensions[this.name]||{}).lights||[])[e],o,s=new q(16777215);a.color!==void 0&&s.setRGB(a.color[0],a.color[1],a.color[2],N);let c=a.range===void 0?0:a.range;switch(a.type){case`directional`:o=new za(s),o.target.position.set(0,0,-1),o.add(o.target);break;case`point`:o=new Ia(s),o.distance=c;break;case`spot`:o=new Pa(s),o.distance=c,a.spot=a.spot||{},a.spot.innerConeAngle=a.spot.innerConeAngle===void 0?0:a.spot.innerConeAngle,a.spot.outerConeAngle=a.spot.outerConeAngle===void 0?Math.PI/4:a.spot.outerConeAngle,o.angle=a.spot.outerConeAngle,o.penumbra=1-a.spot.innerConeAngle/a.spot.outerConeAngle,o.target.position.set(0,0,-1),o.add(o.target);break;default:throw Error(`THREE.GLTFLoader: Unexpected light type: `+a.type)}return o.position.set(0,0,0),WS(o,a),a.intensity!==void 0&&(o.intensity=a.intensity),o.name=t.createUniqueName(a.name||`light_`+e),r=Promise.resolve(o),t.cache.add(n,r),r}getDependency(e,t){if(e===`light`)return this._loadLight(t)}createNodeAttachment(e){let t=this,n=this.parser,r=n.json.nodes[e],i=(r.extensions&&r.extensions[this.name]||{}).light;return i===void 0?null:this._loadLight(i).then(function(e){return n._getNodeRef(t.cache,i,e)})}},aS=class{constructor(){this.name=$.KHR_MATERIALS_UNLIT}getMaterialType(){return ar}extendParams(e,t,n){let r=[];e.color=new q(1,1,1),e.opacity=1;let i=t.pbrMetallicRoughness;if(i){if(Array.isArray(i.baseColorFactor)){let t=i.baseColorFactor;e.color.setRGB(t[0],t[1],t[2],N),e.opacity=t[3]}i.baseColorTexture!==void 0&&r.push(n.assignTexture(e,`map`,i.baseColorTexture,M))}return Promise.all(r)}},oS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_EMISSIVE_STRENGTH}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);return n===null||n.emissiveStrength!==void 0&&(t.emissiveIntensity=n.emissiveStrength),Promise.resolve()}},sS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_CLEARCOAT}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);if(n===null)return Promise.resolve();let r=[];if(n.clearcoatFactor!==void 0&&(t.clearcoat=n.clearcoatFactor),n.clearcoatTexture!==void 0&&r.push(this.parser.assignTexture(t,`clearcoatMap`,n.clearcoatTexture)),n.clearcoatRoughnessFactor!==void 0&&(t.clearcoatRoughness=n.clearcoatRoughnessFactor),n.clearcoatRoughnessTexture!==void 0&&r.push(this.parser.assignTexture(t,`clearcoatRoughnessMap`,n.clearcoatRoughnessTexture)),n.clearcoatNormalTexture!==void 0&&(r.push(this.parser.assignTexture(t,`clearcoatNormalMap`,n.clearcoatNormalTexture)),n.clearcoatNormalTexture.scale!==void 0)){let e=n.clearcoatNormalTexture.scale;t.clearcoatNormalScale=new H(e,e)}return Promise.all(r)}},cS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_DIFFUSE_ROUGHNESS}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);if(n===null)return Promise.resolve();let r=[];return t.diffuseRoughness=n.diffuseRoughnessFactor===void 0?0:n.diffuseRoughnessFactor,n.diffuseRoughnessTexture!==void 0&&r.push(this.parser.assignTexture(t,`diffuseRoughnessMap`,n.diffuseRoughnessTexture)),Promise.all(r)}},lS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_DISPERSION}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);return n===null||(t.dispersion=n.dispersion===void 0?0:n.dispersion),Promise.resolve()}},uS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_IRIDESCENCE}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);if(n===null)return Promise.resolve();let r=[];return n.iridescenceFactor!==void 0&&(t.iridescence=n.iridescenceFactor),n.iridescenceTexture!==void 0&&r.push(this.parser.assignTexture(t,`iridescenceMap`,n.iridescenceTexture)),n.iridescenceIor!==void 0&&(t.iridescenceIOR=n.iridescenceIor),n.iridescenceThicknessMinimum!==void 0&&(t.iridescenceThicknessMinimum=n.iridescenceThicknessMinimum),n.iridescenceThicknessMaximum!==void 0&&(t.iridescenceThicknessMaximum=n.iridescenceThicknessMaximum),n.iridescenceThicknessTexture!==void 0&&r.push(this.parser.assignTexture(t,`iridescenceThicknessMap`,n.iridescenceThicknessTexture)),Promise.all(r)}},dS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_SHEEN}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);if(n===null)return Promise.resolve();let r=[];if(t.sheenColor=new q(0,0,0),t.sheenRoughness=0,t.sheen=1,n.sheenColorFactor!==void 0){let e=n.sheenColorFactor;t.sheenColor.setRGB(e[0],e[1],e[2],N)}return n.sheenRoughnessFactor!==void 0&&(t.sheenRoughness=n.sheenRoughnessFactor),n.sheenColorTexture!==void 0&&r.push(this.parser.assignTexture(t,`sheenColorMap`,n.sheenColorTexture,M)),n.sheenRoughnessTexture!==void 0&&r.push(this.parser.assignTexture(t,`sheenRoughnessMap`,n.sheenRoughnessTexture)),Promise.all(r)}},fS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_TRANSMISSION}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);if(n===null)return Promise.resolve();let r=[];return n.transmissionFactor!==void 0&&(t.transmission=n.transmissionFactor),n.transmissionTexture!==void 0&&r.push(this.parser.assignTexture(t,`transmissionMap`,n.transmissionTexture)),Promise.all(r)}},pS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_VOLUME}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);if(n===null)return Promise.resolve();let r=[];t.thickness=n.thicknessFactor===void 0?0:n.thicknessFactor,n.thicknessTexture!==void 0&&r.push(this.parser.assignTexture(t,`thicknessMap`,n.thicknessTexture)),t.attenuationDistance=n.attenuationDistance||1/0;let i=n.attenuationColor||[1,1,1];return t.attenuationColor=new q().setRGB(i[0],i[1],i[2],N),Promise.all(r)}},mS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_IOR}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);return n===null||(t.ior=n.ior===void 0?1.5:n.ior,t.ior===0&&(t.ior=1e3)),Promise.resolve()}},hS=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_SPECULAR}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);if(n===null)return Promise.resolve();let r=[];t.specularIntensity=n.specularFactor===void 0?1:n.specularFactor,n.specularTexture!==void 0&&r.push(this.parser.assignTexture(t,`specularIntensityMap`,n.specularTexture));let i=n.specularColorFactor||[1,1,1];return t.specularColor=new q().setRGB(i[0],i[1],i[2],N),n.specularColorTexture!==void 0&&r.push(this.parser.assignTexture(t,`specularColorMap`,n.specularColorTexture,M)),Promise.all(r)}},gS=class{constructor(e){this.parser=e,this.name=$.EXT_MATERIALS_BUMP}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);if(n===null)return Promise.resolve();let r=[];return t.bumpScale=n.bumpFactor===void 0?1:n.bumpFactor,n.bumpTexture!==void 0&&r.push(this.parser.assignTexture(t,`bumpMap`,n.bumpTexture)),Promise.all(r)}},_S=class{constructor(e){this.parser=e,this.name=$.KHR_MATERIALS_ANISOTROPY}getMaterialType(e){return rS(this.parser,e,this.name)===null?null:Pi}extendMaterialParams(e,t){let n=rS(this.parser,e,this.name);if(n===null)return Promise.resolve();let r=[];return n.anisotropyStrength!==void 0&&(t.anisotropy=n.anisotropyStrength),n.anisotropyRotation!==void 0&&(t.anisotropyRotation=n.anisotropyRotation),n.anisotropyTexture!==void 0&&r.push(this.parser.assignTexture(t,`anisotropyMap`,n.anisotropyTexture)),Promise.all(r)}},vS=class{constructor(e){this.parser=e,this.name=$.KHR_TEXTURE_BASISU}loadTexture(e){let t=this.parser,n=t.json,r=n.textures[e];if(!r.extensions||!r.extensions[this.name])return null;let i=r.extensions[this.name],a=t.options.ktx2Loader;if(!a){if(n.extensionsRequired&&n.extensionsRequired.indexOf(this.name)>=0)throw Error(`THREE.GLTFLoader: setKTX2Loader must be called before loading KTX2 textures`);return null}return t.loadTextureImage(e,i.source,a)}},yS=class{constructor(e){this.parser=e,this.name=$.EXT_TEXTURE_WEBP}loadTexture(e){let t=this.name,n=this.parser,r=n.json,i=r.textures[e];if(!i.extensions||!i.extensions[t])return null;let a=i.extensions[t],o=r.images[a.source],s=n.textureLoader;if(o.uri){let e=n.options.manager.getHandler(o.uri);e!==null&&(s=e)}return n.loadTextureImage(e,a.source,s)}},bS=class{constructor(e){this.parser=e,this.name=$.EXT_TEXTURE_AVIF}loadTexture(e){let t=this.name,n=this.parser,r=n.json,i=r.textures[e];if(!i.extensions||!i.extensions[t])return null;let a=i.extensions[t],o=r.images[a.source],s=n.textureLoader;if(o.uri){let e=n.options.manager.getHandler(o.uri);e!==null&&(s=e)}return n.loadTextureImage(e,a.source,s)}},xS=class{constructor(e,t){this.name=t,this.parser=e}loadBufferView(e){let t=this.parser.json,n=t.bufferViews[e];if(n.extensions&&n.extensions[this.name]){let e=n.extensions[this.name],r=this.parser.getDependency(`buffer`,e.buffer),i=this.parser.options.meshoptDecoder;if(!i||!i.supported){if(t.extensionsRequired&&t.extensionsRequired.indexOf(this.name)>=0)throw Error(`THREE.GLTFLoader: setMeshoptDecoder must be called before loading compressed files`);return null}return r.then(function(t){let n=e.byteOffset||0,r=e.byteLength||0,a=e.count,o=e.byteStride,s=new Uint8Array(t,n,r);return i.decodeGltfBufferAsync?i.decodeGltfBufferAsync(a,o,s,e.mode,e.filter).then(function(e){return e.buffer}):i.ready.then(function(){let t=new ArrayBuffer(a*o);return i.decodeGltfBuffer(new Uint8Array(t),a,o,s,e.mode,e.filter),t})})}return null}},SS=class{constructor(e){this.name=$.EXT_MESH_GPU_INSTANCING,this.parser=e}createNodeMesh(e){let t=this.parser.json,n=t.nodes[e];if(!n.extensions||!n.extensions[this.name]||n.mesh===void 0)return null;let r=t.meshes[n.mesh];for(let e of r.primitives)if(e.mode!==NS.TRIANGLES&&e.mode!==NS.TRIANGLE_STRIP&&e.mode!==NS.TRIANGLE_FAN&&e.mode!==void 0)return null;let i=n.extensions[this.name].attributes,a=[],o={};for(let e in i)a.push(this.parser.getDependency(`accessor`,i[e]).then(t=>(o[e]=t,o[e])));return a.length<1?null:(a.push(this.parser.createNodeMesh(e)),Promise.all(a).then(e=>{let t=e.pop(),n=t.isGroup?t.children:[t],r=e[0].count,i=[];for(let e of n){let t=new K,n=new W,a=new U,s=new W(1,1,1),c=new Ur(e.geometry,e.material,r);for(let e=0;e<r;e++)o.TRANSLATION&&n.fromBufferAttribute(o.TRANSLATION,e),o.ROTATION&&a.fromBufferAttribute(o.ROTATION,e),o.SCALE&&s.fromBufferAttribute(o.SCALE,e),c.setMatrixAt(e,t.compose(n,a,s));let l=null;for(let e in o)if(e===`_COLOR_0`){let t=o[e];c.instanceColor=new Fr(t.array,t.itemSize,t.normalized)}else if(e!==`TRANSLATION`&&e!==`ROTATION`&&e!==`SCALE`){if(l===null){let e=c.geometry;l=new Un,l.name=e.name;for(let t in e.attributes)l.setAttribute(t,e.attributes[t]);for(let t in e.morphAttributes)l.morphAttributes[t]=e.morphAttributes[t];e.index!==null&&l.setIndex(e.index),l.morphTargetsRelative=e.morphTargetsRelative;for(let t of e.groups)l.addGroup(t.start,t.count,t.materialIndex);e.boundingBox!==null&&(l.boundingBox=e.boundingBox.clone()),e.boundingSphere!==null&&(l.boundingSphere=e.boundingSphere.clone()),l.drawRange.start=e.drawRange.start,l.drawRange.count=e.drawRange.count,l.userData=Object.assign({},e.userData),c.geometry=l}let t=o[e];l.setAttribute(e,new Fr(t.array,t.itemSize,t.normalized))}Pt.prototype.copy.call(c,e),this.parser.assignFinalMaterial(c),i.push(c)}return t.isGroup?(t.clear(),t.add(...i),t):i[0]}))}},CS=`glTF`,wS=12,TS={JSON:1313821514,BIN:5130562},ES=class{constructor(e){this.name=$.KHR_BINARY_GLTF,this.content=null,this.body=null;let t=new DataView(e,0,wS),n=new TextDecoder;if(this.header={magic:n.decode(new Uint8Array(e.slice(0,4))),version:t.getUint32(4,!0),length:t.getUint32(8,!0)},this.header.magic!==CS)throw Error(`THREE.GLTFLoader: Unsupported glTF-Binary header.`);if(this.header.version<2)throw Error(`THREE.GLTFLoader: Legacy binary file detected.`);let r=this.header.length-wS,i=new DataView(e,wS),a=0;for(;a<r;){let t=i.getUint32(a,!0);a+=4;let r=i.getUint32(a,!0);if(a+=4,r===TS.JSON){let r=new Uint8Array(e,wS+a,t);this.content=n.decode(r)}else if(r===TS.BIN){let n=wS+a;this.body=e.slice(n,n+t)}a+=t}if(this.content===null)throw Error(`THREE.GLTFLoader: JSON content not found.`)}},DS=class{constructor(e,t){if(!t)throw Error(`THREE.GLTFLoader: No DRACOLoader instance provided.`);this.name=$.KHR_DRACO_MESH_COMPRESSION,this.json=e,this.dracoLoader=t,this.dracoLoader.preload()}decodePrimitive(e,t){let n=this.json,r=this.dracoLoader,i=e.extensions[this.name].bufferView,a=e.extensions[this.name].attributes,o={},s={},c={};for(let e in a){let t=RS[e]||e.toLowerCase();o[t]=a[e]}for(let t in e.attributes){let r=RS[t]||t.toLowerCase();if(a[t]!==void 0){let i=n.accessors[e.attributes[t]];c[r]=PS[i.componentType].name,s[r]=i.normalized===!0}}return t.getDependency(`bufferView`,i).then(function(e){return new Promise(function(t,n){r.decodeDracoFile(e,function(e){for(let t in e.attributes){let n=e.attributes[t],r=s[t];r!==void 0&&(n.normalized=r)}t(e)},o,c,N,n)})})}},OS=class{constructor(){this.name=$.KHR_TEXTURE_TRANSFORM}extendTexture(e,t){if((t.texCoord===void 0||t.texCoord===e.channel)&&t.offset===void 0&&t.rotation===void 0&&t.scale===void 0)return e;if(e=e.clone(),t.texCoord!==void 0&&(e.channel=t.texCoord),t.offset!==void 0&&e.offset.fromArray(t.offset),t.rotation!==void 0&&(e.rotation=t.rotation),t.scale!==void 0&&e.repeat.fromArray(t.scale),t.rotation!==void 0){let t=Math.cos(e.rotation),n=Math.sin(e.rotation);e.matrix.set(e.repeat.x*t,e.repeat.y*n,e.offset.x,-e.repeat.x*n,e.repeat.y*t,e.offset.y,0,0,1),e.matrixAutoUpdate=!1}return e.needsUpdate=!0,e}},kS=class{constructor(){this.name=$.KHR_MESH_QUANTIZATION}},AS=class extends Hi{constructor(e,t,n,r){super(e,t,n,r)}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,r=this.valueSize,i=e*r*3+r;for(let e=0;e!==r;e++)t[e]=n[i+e];return t}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=o*2,c=o*3,l=r-t,u=(n-t)/l,d=u*u,f=d*u,p=e*c,m=p-c,h=-2*f+3*d,g=f-d,_=1-h,v=g-d+u;for(let e=0;e!==o;e++){let t=a[m+e+o],n=a[m+e+s]*l,r=a[p+e+o],c=a[p+e]*l;i[e]=_*t+v*n+h*r+g*c}return i}},jS=new U,MS=class extends AS{interpolate_(e,t,n,r){let i=super.interpolate_(e,t,n,r);return jS.fromArray(i).normalize().toArray(i),i}},NS={FLOAT:5126,FLOAT_MAT3:35675,FLOAT_MAT4:35676,FLOAT_VEC2:35664,FLOAT_VEC3:35665,FLOAT_VEC4:35666,LINEAR:9729,REPEAT:10497,SAMPLER_2D:35678,POINTS:0,LINES:1,LINE_LOOP:2,LINE_STRIP:3,TRIANGLES:4,TRIANGLE_STRIP:5,TRIANGLE_FAN:6,UNSIGNED_BYTE:5121,UNSIGNED_SHORT:5123},PS={5120:Int8Array,5121:Uint8Array,5122:Int16Array,5123:Uint16Array,5125:Uint32Array,5126:Float32Array},FS={9728:r,9729:o,9984:i,9985:s,9986:a,9987:c},IS={33071:t,33648:n,10497:e},LS={SCALAR:1,VEC2:2,VEC3:3,VEC4:4,MAT2:4,MAT3:9,MAT4:16},RS={POSITION:`position`,NORMAL:`normal`,TANGENT:`tangent`,TEXCOORD_0:`uv`,TEXCOORD_1:`uv1`,TEXCOORD_2:`uv2`,TEXCOORD_3:`uv3`,COLOR_0:`color`,WEIGHTS_0:`skinWeight`,JOINTS_0:`skinIndex`},zS={scale:`scale`,translation:`position`,rotation:`quaternion`,weights:`morphTargetInfluences`},BS={CUBICSPLINE:void 0,LINEAR:E,STEP:T},VS={OPAQUE:`OPAQUE`,MASK:`MASK`,BLEND:`BLEND`};function HS(e){return e.DefaultMaterial===void 0&&(e.DefaultMaterial=new Ni({color:16777215,emissive:0,metalness:1,roughness:1,transparent:!1,depthTest:!0,side:0})),e.DefaultMaterial}function US(e,t,n){for(let r in n.extensions)e[r]===void 0&&(t.userData.gltfExtensions=t.userData.gltfExtensions||{},t.userData.gltfExtensions[r]=n.extensions[r])}function WS(e,t){t.extras!==void 0&&(typeof t.extras==`object`?Object.assign(e.userData,t.extras):console.warn(`THREE.GLTFLoader: Ignoring primitive type .extras, `+t.extras))}function GS(e,t,n){let r=!1,i=!1,a=!1;for(let e=0,n=t.length;e<n;e++){let n=t[e];if(n.POSITION!==void 0&&(r=!0),n.NORMAL!==void 0&&(i=!0),n.COLOR_0!==void 0&&(a=!0),r&&i&&a)break}if(!r&&!i&&!a)return Promise.resolve(e);let o=[],s=[],c=[];for(let l=0,u=t.length;l<u;l++){let u=t[l];if(r){let t=u.POSITION===void 0?e.attributes.position:n.getDependency(`accessor`,u.POSITION);o.push(t)}if(i){let t=u.NORMAL===void 0?e.attributes.normal:n.getDependency(`accessor`,u.NORMAL);s.push(t)}if(a){let t=u.COLOR_0===void 0?e.attributes.color:n.getDependency(`accessor`,u.COLOR_0);c.push(t)}}return Promise.all([Promise.all(o),Promise.all(s),Promise.all(c)]).then(function(t){let n=t[0],o=t[1],s=t[2];return r&&(e.morphAttributes.position=n),i&&(e.morphAttributes.normal=o),a&&(e.morphAttributes.color=s),e.morphTargetsRelative=!0,e})}function KS(e,t){if(e.updateMorphTargets(),t.weights!==void 0)for(let n=0,r=t.weights.length;n<r;n++)e.morphTargetInfluences[n]=t.weights[n];if(t.extras&&Array.isArray(t.extras.targetNames)){let n=t.extras.targetNames;if(e.morphTargetInfluences.length===n.length){e.morphTargetDictionary={};for(let t=0,r=n.length;t<r;t++)e.morphTargetDictionary[n[t]]=t}else console.warn(`THREE.GLTFLoader: Invalid extras.targetNames length. Ignoring names.`)}}function qS(e){let t,n=e.extensions&&e.extensions[$.KHR_DRACO_MESH_COMPRESSION];if(t=n?`draco:`+n.bufferView+`:`+n.indices+`:`+JS(n.attributes):e.indices+`:`+JS(e.attributes)+`:`+e.mode,e.targets!==void 0)for(let n=0,r=e.targets.length;n<r;n++)t+=`:`+JS(e.targets[n]);return t}function JS(e){let t=``,n=Object.keys(e).sort();for(let r=0,i=n.length;r<i;r++)t+=n[r]+`:`+e[n[r]]+`;`;return t}function YS(e){switch(e){case Int8Array:return 1/127;case Uint8Array:return 1/255;case Int16Array:return 1/32767;case Uint16Array:return 1/65535;default:throw Error(`THREE.GLTFLoader: Unsupported normalized accessor component type.`)}}function XS(e){return e.search(/\.jpe?g($|\?)/i)>0||e.search(/^data\:image\/jpeg/)===0?`image/jpeg`:e.search(/\.webp($|\?)/i)>0||e.search(/^data\:image\/webp/)===0?`image/webp`:e.search(/\.ktx2($|\?)/i)>0||e.search(/^data\:image\/ktx2/)===0?`image/ktx2`:`image/png`}var ZS=new K,QS=class{constructor(e={},t={}){this.json=e,this.extensions={},this.plugins={},this.options=t,this.cache=new nS,this.associations=new Map,this.primitiveCache={},this.nodeCache={},this.meshCache={refs:{},uses:{}},this.cameraCache={refs:{},uses:{}},this.lightCache={refs:{},uses:{}},this.sourceCache={},this.textureCache={},this.nodeNamesUsed={};let n=!1,r=-1,i=!1,a=-1;if(typeof navigator<`u`&&navigator.userAgent!==void 0){let e=navigator.userAgent;n=/^((?!chrome|android).)*safari/i.test(e)===!0;let t=e.match(/Version\/(\d+)/);r=n&&t?parseInt(t[1],10):-1,i=e.indexOf(`Firefox`)>-1,a=i?e.match(/Firefox\/([0-9]+)\./)[1]:-1}typeof createImageBitmap>`u`||n&&r<17||i&&a<98?(this.textureLoader=new va(this.options.manager),this.textureLoader.setPriority(this.options.priority),this.textureLoader.setCache(this.options.cache)):(this.textureLoader=new Ua(this.options.manager),this.textureLoader.setPriority(this.options.priority),this.textureLoader.setCache(this.options.cache)),this.textureLoader.setCrossOrigin(this.options.crossOrigin),this.textureLoader.setWithCredentials(this.options.withCredentials),this.textureLoader.setRequestHeader(this.options.requestHeader),this.fileLoader=new ha(this.options.manager),this.fileLoader.setPriority(this.options.priority),this.fileLoader.setCache(this.options.cache),this.fileLoader.setResponseType(`arraybuffer`),(this.options.withCredentials||this.options.crossOrigin===`use-credentials`)&&this.fileLoader.setWithCredentials(!0)}setExtensions(e){this.extensions=e}setPlugins(e){this.plugins=e}parse(e,t){let n=this,r=this.json,i=this.extensions;this.cache.removeAll(),this.nodeCache={},this._invokeAll(function(e){return e._markDefs&&e._markDefs()}),Promise.all(this._invokeAll(function(e){return e.beforeRoot&&e.beforeRoot()})).then(function(){return Promise.all([n.getDependencies(`scene`),n.getDependencies(`animation`),n.getDependencies(`camera`)])}).then(function(t){let a={scene:t[0][r.scene||0],scenes:t[0],animations:t[1],cameras:t[2],asset:r.asset,parser:n,userData:{}};return US(i,a,r),WS(a,r),Promise.all(n._invokeAll(function(e){return e.afterRoot&&e.afterRoot(a)})).then(function(){for(let e of a.scenes)e.updateMatrixWorld();e(a)})}).catch(t)}_markDefs(){let e=this.json.nodes||[],t=this.json.skins||[],n=this.json.meshes||[];for(let n=0,r=t.length;n<r;n++){let r=t[n].joints;for(let t=0,n=r.length;t<n;t++)e[r[t]].isBone=!0}for(let t=0,r=e.length;t<r;t++){let r=e[t];r.mesh!==void 0&&(this._addNodeRef(this.meshCache,r.mesh),r.skin!==void 0&&(n[r.mesh].isSkinnedMesh=!0)),r.camera!==void 0&&this._addNodeRef(this.cameraCache,r.camera)}}_addNodeRef(e,t){t!==void 0&&(e.refs[t]===void 0&&(e.refs[t]=e.uses[t]=0),e.refs[t]++)}_getNodeRef(e,t,n){if(e.refs[t]<=1)return n;let r=n.clone(),i=(e,t)=>{let n=this.associations.get(e);n!=null&&this.associations.set(t,n);for(let[n,r]of e.children.entries())i(r,t.children[n])};return i(n,r),r.name+=`_instance_`+e.uses[t]++,r}_invokeOne(e){let t=Object.values(this.plugins);t.push(this);for(let n=0;n<t.length;n++){let r=e(t[n]);if(r)return r}return null}_invokeAll(e){let t=Object.values(this.plugins);t.unshift(this);let n=[];for(let r=0;r<t.length;r++){let i=e(t[r]);i&&n.push(i)}return n}getDependency(e,t){let n=e+`:`+t,r=this.cache.get(n);if(!r){switch(e){case`scene`:r=this.loadScene(t);break;case`node`:r=this._invokeOne(function(e){return e.loadNode&&e.loadNode(t)});break;case`mesh`:r=this._invokeOne(function(e){return e.loadMesh&&e.loadMesh(t)});break;case`accessor`:r=this.loadAccessor(t);break;case`bufferView`:r=this._invokeOne(function(e){return e.loadBufferView&&e.loadBufferView(t)});break;case`buffer`:r=this.loadBuffer(t);break;case`material`:r=this._invokeOne(function(e){return e.loadMaterial&&e.loadMaterial(t)});break;case`texture`:r=this._invokeOne(function(e){return e.loadTexture&&e.loadTexture(t)});break;case`skin`:r=this.loadSkin(t);break;case`animation`:r=this._invokeOne(function(e){return e.loadAnimation&&e.loadAnimation(t)});break;case`camera`:r=this.loadCamera(t);break;default:if(r=this._invokeOne(function(n){return n!=this&&n.getDependency&&n.getDependency(e,t)}),!r)throw Error(`Unknown type: `+e)}this.cache.add(n,r)}return r}getDependencies(e){let t=this.cache.get(e);if(!t){let n=this,r=this.json[e+(e===`mesh`?`es`:`s`)]||[];t=Promise.all(r.map(function(t,r){return n.getDependency(e,r)})),this.cache.add(e,t)}return t}loadBuffer(e){let t=this.json.buffers[e],n=this.fileLoader;if(t.type&&t.type!==`arraybuffer`)throw Error(`THREE.GLTFLoader: `+t.type+` buffer type is not supported.`);if(t.uri===void 0&&e===0)return Promise.resolve(this.extensions[$.KHR_BINARY_GLTF].body);let r=this.options;return new Promise(function(e,i){n.load(Ba.resolveURL(t.uri,r.path),e,void 0,function(){i(Error(`THREE.GLTFLoader: Failed to load buffer "`+t.uri+`".`))})})}loadBufferView(e){let t=this.json.bufferViews[e];return this.getDependency(`buffer`,t.buffer).then(function(e){let n=t.byteLength||0,r=t.byteOffset||0;return e.slice(r,r+n)})}loadAccessor(e){let t=this,n=this.json,r=this.json.accessors[e];if(r.bufferView===void 0&&r.sparse===void 0){let e=LS[r.type],t=PS[r.componentType],n=r.normalized===!0,i=new t(r.count*e);return Promise.resolve(new On(i,e,n))}let i=[];return r.bufferView===void 0?i.push(null):i.push(this.getDependency(`bufferView`,r.bufferView)),r.sparse!==void 0&&(i.push(this.getDependency(`bufferView`,r.sparse.indices.bufferView)),i.push(this.getDependency(`bufferView`,r.sparse.values.bufferView))),Promise.all(i).then(function(e){let i=e[0],a=LS[r.type],o=PS[r.componentType],s=o.BYTES_PER_ELEMENT,c=s*a,l=r.byteOffset||0,u=r.bufferView===void 0?void 0:n.bufferViews[r.bufferView].byteStride,d=r.normalized===!0,f,p;if(u&&u!==c){let e=Math.floor(l/u),n=`InterleavedBuffer:`+r.bufferView+`:`+r.componentType+`:`+e+`:`+r.count,c=t.cache.get(n);c||(f=new o(i,e*u,r.count*u/s),c=new Wn(f,u/s),t.cache.add(n,c)),p=new qn(c,a,l%u/s,d)}else f=i===null?new o(r.count*a):new o(i,l,r.count*a),p=new On(f,a,d);if(r.sparse!==void 0){let t=LS.SCALAR,n=PS[r.sparse.indices.componentType],s=r.sparse.indices.byteOffset||0,c=r.sparse.values.byteOffset||0,l=new n(e[1],s,r.sparse.count*t),u=new o(e[2],c,r.sparse.count*a);i!==null&&(p=new On(p.array.slice(),p.itemSize,p.normalized)),p.normalized=!1;for(let e=0,t=l.length;e<t;e++){let t=l[e];if(p.setX(t,u[e*a]),a>=2&&p.setY(t,u[e*a+1]),a>=3&&p.setZ(t,u[e*a+2]),a>=4&&p.setW(t,u[e*a+3]),a>=5)throw Error(`THREE.GLTFLoader: Unsupported itemSize in sparse BufferAttribute.`)}p.normalized=d}return p})}loadTexture(e){let t=this.json,n=this.options,r=t.textures[e].source,i=t.images[r],a=this.textureLoader;if(i.uri){let e=n.manager.getHandler(i.uri);e!==null&&(a=e)}return this.loadTextureImage(e,r,a)}loadTextureImage(e,t,n){let r=this,i=this.json,a=i.textures[e],o=i.images[t],s=(o.uri||o.bufferView)+`:`+a.sampler;if(this.textureCache[s])return this.textureCache[s];let c=this.loadImageSource(t,n).then(function(t){t.flipY=!1,t.name=a.name||o.name||``,t.name===``&&typeof o.uri==`string`&&o.uri.startsWith(`data:image/`)===!1&&(t.name=o.uri);let n=(i.samplers||{})[a.sampler]||{};return t.magFilter=FS[n.magFilter]||1006,t.minFilter=FS[n.minFilter]||1008,t.wrapS=IS[n.wrapS]||1e3,t.wrapT=IS[n.wrapT]||1e3,t.generateMipmaps=!t.isCompressedTexture&&t.minFilter!==1003&&t.minFilter!==1006,r.associations.set(t,{textures:e}),t}).catch(function(){return null});return this.textureCache[s]=c,c}loadImageSource(e,t){let n=this,r=this.json,i=this.options;if(this.sourceCache[e]!==void 0)return this.sourceCache[e].then(e=>e.clone());let a=r.images[e],o=self.URL||self.webkitURL,s=a.uri||``,c=!1,l;if(t.isKTX2Loader===!0&&a.bufferView!==void 0)l=n.getDependency(`bufferView`,a.bufferView).then(function(e){return new Promise(function(n,r){t.parse(e,n,r)})});else{if(a.bufferView!==void 0)s=n.getDependency(`bufferView`,a.bufferView).then(function(e){c=!0;let t=new Blob([e],{type:a.mimeType});return s=o.createObjectURL(t),s});else if(a.uri===void 0)throw Error(`THREE.GLTFLoader: Image `+e+` is missing URI and bufferView`);l=Promise.resolve(s).then(function(e){return new Promise(function(n,r){let a=n;t.isImageBitmapLoader===!0&&(a=function(e){let t=new nt(e);t.needsUpdate=!0,n(t)}),t.load(Ba.resolveURL(e,i.path),a,void 0,r)})})}let u=l.then(function(e){return c===!0&&o.revokeObjectURL(s),WS(e,a),e.userData.mimeType=a.mimeType||XS(a.uri),e}).catch(function(e){throw console.error(`THREE.GLTFLoader: Couldn't load texture`,s),e});return this.sourceCache[e]=u,u}assignTexture(e,t,n,r){let i=this;return this.getDependency(`texture`,n.index).then(function(a){if(!a)return null;if(n.texCoord!==void 0&&n.texCoord>0&&(a=a.clone(),a.channel=n.texCoord),i.extensions[$.KHR_TEXTURE_TRANSFORM]){let e=n.extensions===void 0?void 0:n.extensions[$.KHR_TEXTURE_TRANSFORM];if(e){let t=i.associations.get(a);a=i.extensions[$.KHR_TEXTURE_TRANSFORM].extendTexture(a,e),i.associations.set(a,t)}}return r!==void 0&&(a.colorSpace=r),e[t]=a,a})}assignFinalMaterial(e){let t=e.geometry,n=e.material,r=t.attributes.tangent===void 0,i=t.attributes.color!==void 0,a=t.attributes.normal===void 0;if(e.isPoints){let e=`PointsMaterial:`+n.uuid,t=this.cache.get(e);t||(t=new ui,$n.prototype.copy.call(t,n),t.color.copy(n.color),t.map=n.map,t.sizeAttenuation=!1,this.cache.add(e,t)),n=t}else if(e.isLine){let e=`LineBasicMaterial:`+n.uuid,t=this.cache.get(e);t||(t=new Xr,$n.prototype.copy.call(t,n),t.color.copy(n.color),t.map=n.map,this.cache.add(e,t)),n=t}if(r||i||a){let e=`ClonedMaterial:`+n.uuid+`:`;r&&(e+=`derivative-tangents:`),i&&(e+=`vertex-colors:`),a&&(e+=`flat-shading:`);let t=this.cache.get(e);t||(t=n.clone(),i&&(t.vertexColors=!0),a&&(t.flatShading=!0),r&&(t.normalScale&&(t.normalScale.y*=-1),t.clearcoatNormalScale&&(t.clearcoatNormalScale.y*=-1)),this.cache.add(e,t),this.associations.set(t,this.associations.get(n))),n=t}e.material=n}getMaterialType(){return Ni}loadMaterial(e){let t=this,n=this.json,r=this.extensions,i=n.materials[e],a,o={},s=i.extensions||{},c=[];if(s[$.KHR_MATERIALS_UNLIT]){let e=r[$.KHR_MATERIALS_UNLIT];a=e.getMaterialType(),c.push(e.extendParams(o,i,t))}else{let n=i.pbrMetallicRoughness||{};if(o.color=new q(1,1,1),o.opacity=1,Array.isArray(n.baseColorFactor)){let e=n.baseColorFactor;o.color.setRGB(e[0],e[1],e[2],N),o.opacity=e[3]}n.baseColorTexture!==void 0&&c.push(t.assignTexture(o,`map`,n.baseColorTexture,M)),o.metalness=n.metallicFactor===void 0?1:n.metallicFactor,o.roughness=n.roughnessFactor===void 0?1:n.roughnessFactor,n.metallicRoughnessTexture!==void 0&&(c.push(t.assignTexture(o,`metalnessMap`,n.metallicRoughnessTexture)),c.push(t.assignTexture(o,`roughnessMap`,n.metallicRoughnessTexture))),a=this._invokeOne(function(t){return t.getMaterialType&&t.getMaterialType(e)}),c.push(Promise.all(this._invokeAll(function(t){return t.extendMaterialParams&&t.extendMaterialParams(e,o)})))}i.doubleSided===!0&&(o.side=2);let l=i.alphaMode||VS.OPAQUE;if(l===VS.BLEND?(o.transparent=!0,o.depthWrite=!1):(o.transparent=!1,l===VS.MASK&&(o.alphaTest=i.alphaCutoff===void 0?.5:i.alphaCutoff)),i.normalTexture!==void 0&&a!==ar&&(c.push(t.assignTexture(o,`normalMap`,i.normalTexture)),o.normalScale=new H(1,1),i.normalTexture.scale!==void 0)){let e=i.normalTexture.scale;o.normalScale.set(e,e)}if(i.occlusionTexture!==void 0&&a!==ar&&(c.push(t.assignTexture(o,`aoMap`,i.occlusionTexture)),i.occlusionTexture.strength!==void 0&&(o.aoMapIntensity=i.occlusionTexture.strength)),i.emissiveFactor!==void 0&&a!==ar){let e=i.emissiveFactor;o.emissive=new q().setRGB(e[0],e[1],e[2],N)}return i.emissiveTexture!==void 0&&a!==ar&&c.push(t.assignTexture(o,`emissiveMap`,i.emissiveTexture,M)),Promise.all(c).then(function(){let n=new a(o);return i.name&&(n.name=i.name),WS(n,i),t.associations.set(n,{materials:e}),i.extensions&&US(r,n,i),n})}createUniqueName(e){let t=ao.sanitizeNodeName(e||``);return t in this.nodeNamesUsed?t+`_`+ ++this.nodeNamesUsed[t]:(this.nodeNamesUsed[t]=0,t)}loadGeometries(e){let t=this,n=this.extensions,r=this.primitiveCache;function i(e){return n[$.KHR_DRACO_MESH_COMPRESSION].decodePrimitive(e,t).then(function(n){return eC(n,e,t)})}let a=[];for(let n=0,o=e.length;n<o;n++){let o=e[n],s=qS(o),c=r[s];if(c)a.push(c.promise);else{let e;e=o.extensions&&o.extensions[$.KHR_DRACO_MESH_COMPRESSION]?i(o):eC(new Un,o,t),o.mode===NS.TRIANGLE_STRIP?e=e.then(e=>Qx(e,1)):o.mode===NS.TRIANGLE_FAN&&(e=e.then(e=>Qx(e,2))),r[s]={primitive:o,promise:e},a.push(e)}}return Promise.all(a)}loadMesh(e){let t=this,n=this.json,r=this.extensions,i=n.meshes[e],a=i.primitives,o=[];for(let e=0,t=a.length;e<t;e++){let t=a[e].material===void 0?HS(this.cache):this.getDependency(`material`,a[e].material);o.push(t)}return o.push(t.loadGeometries(a)),Promise.all(o).then(async function(n){let o=n.slice(0,n.length-1),s=n[n.length-1],c=[];for(let n=0,l=s.length;n<l;n++){let l=s[n],u=a[n],d,f=o[n];if(u.mode===NS.TRIANGLES||u.mode===NS.TRIANGLE_STRIP||u.mode===NS.TRIANGLE_FAN||u.mode===void 0){let e=i.isSkinnedMesh===!0,t=l.hasAttribute(`skinIndex`)&&l.hasAttribute(`skinWeight`);e&&t===!1&&console.warn(`THREE.GLTFLoader: Missing skinIndex or skinWeight attributes. Skinning disabled.`),d=e&&t?new kr(l,f):new _r(l,f),d.isSkinnedMesh===!0&&d.normalizeSkinWeights()}else if(u.mode===NS.LINES)d=new ci(l,f);else if(u.mode===NS.LINE_STRIP)d=new ii(l,f);else if(u.mode===NS.LINE_LOOP)d=new li(l,f);else if(u.mode===NS.POINTS)d=new hi(l,f);else throw Error(`THREE.GLTFLoader: Primitive mode unsupported: `+u.mode);Object.keys(d.geometry.morphAttributes).length>0&&KS(d,i),d.name=t.createUniqueName(i.name||`mesh_`+e),WS(d,i),u.extensions&&US(r,d,u),t.assignFinalMaterial(d),c.push(d)}for(let n=0,r=c.length;n<r;n++)t.associations.set(c[n],{meshes:e,primitives:n});if(c.length===1)return i.extensions&&US(r,c[0],i),c[0];let l=new Ft;i.extensions&&US(r,l,i),t.associations.set(l,{meshes:e});for(let e=0,t=c.length;e<t;e++)l.add(c[e]);return l})}loadCamera(e){let t,n=this.json.cameras[e],r=n[n.type];if(!r)console.warn(`THREE.GLTFLoader: Missing camera parameters.`);else return n.type===`perspective`?t=new Ma(V.radToDeg(r.yfov),r.aspectRatio||1,r.znear||1,r.zfar||2e6):n.type===`orthographic`&&(t=new La(-r.xmag,r.xmag,r.ymag,-r.ymag,r.znear,r.zfar)),n.name&&(t.name=this.createUniqueName(n.name)),WS(t,n),Promise.resolve(t)}loadSkin(e){let t=this.json.skins[e],n=[];for(let e=0,r=t.joints.length;e<r;e++)n.push(this._loadNodeShallow(t.joints[e]));return t.inverseBindMatrices===void 0?n.push(null):n.push(this.getDependency(`accessor`,t.inverseBindMatrices)),Promise.all(n).then(function(e){let n=e.pop(),r=e,i=[],a=[];for(let e=0,o=r.length;e<o;e++){let o=r[e];if(o){i.push(o);let t=new K;n!==null&&t.fromArray(n.array,e*16),a.push(t)}else console.warn(`THREE.GLTFLoader: Joint "%s" could not be found.`,t.joints[e])}return new Pr(i,a)})}loadAnimation(e){let t=this.json,n=this,r=t.animations[e],i=r.name?r.name:`animation_`+e,a=[],o=[],s=[],c=[],l=[];for(let e=0,t=r.channels.length;e<t;e++){let t=r.channels[e],n=r.samplers[t.sampler],i=t.target,u=i.node,d=r.parameters===void 0?n.input:r.parameters[n.input],f=r.parameters===void 0?n.output:r.parameters[n.output];i.node!==void 0&&(a.push(this.getDependency(`node`,u)),o.push(this.getDependency(`accessor`,d)),s.push(this.getDependency(`accessor`,f)),c.push(n),l.push(i))}return Promise.all([Promise.all(a),Promise.all(o),Promise.all(s),Promise.all(c),Promise.all(l)]).then(function(e){let t=e[0],a=e[1],o=e[2],s=e[3],c=e[4],l=[];for(let e=0,r=t.length;e<r;e++){let r=t[e],i=a[e],u=o[e],d=s[e],f=c[e];if(r===void 0)continue;r.updateMatrix&&r.updateMatrix();let p=n._createAnimationTracks(r,i,u,d,f);if(p)for(let e=0;e<p.length;e++)l.push(p[e])}let u=new oa(i,void 0,l);return WS(u,r),u})}createNodeMesh(e){let t=this.json,n=this,r=t.nodes[e];return r.mesh===void 0?null:n.getDependency(`mesh`,r.mesh).then(function(e){let t=n._getNodeRef(n.meshCache,r.mesh,e);return r.weights!==void 0&&t.traverse(function(e){if(e.isMesh)for(let t=0,n=r.weights.length;t<n;t++)e.morphTargetInfluences[t]=r.weights[t]}),t})}loadNode(e){let t=this.json,n=this,r=t.nodes[e],i=n._loadNodeShallow(e),a=[],o=r.children||[];for(let e=0,t=o.length;e<t;e++)a.push(n.getDependency(`node`,o[e]));let s=r.skin===void 0?Promise.resolve(null):n.getDependency(`skin`,r.skin);return Promise.all([i,Promise.all(a),s]).then(function(e){let t=e[0],n=e[1],r=e[2];r!==null&&t.traverse(function(e){e.isSkinnedMesh&&e.bind(r,ZS)});for(let e=0,r=n.length;e<r;e++)t.add(n[e]);if(t.userData.pivot!==void 0&&n.length>0){let e=t.userData.pivot,r=n[0];t.pivot=new W().fromArray(e),t.position.x-=e[0],t.position.y-=e[1],t.position.z-=e[2],r.position.set(0,0,0),delete t.userData.pivot}return t})}_loadNodeShallow(e){let t=this.json,n=this.extensions,r=this;if(this.nodeCache[e]!==void 0)return this.nodeCache[e];let i=t.nodes[e],a=i.name?r.createUniqueName(i.name):``,o=[],s=r._invokeOne(function(t){return t.createNodeMesh&&t.createNodeMesh(e)});return s&&o.push(s),i.camera!==void 0&&o.push(r.getDependency(`camera`,i.camera).then(function(e){return r._getNodeRef(r.cameraCache,i.camera,e)})),r._invokeAll(function(t){return t.createNodeAttachment&&t.createNodeAttachment(e)}).forEach(function(e){o.push(e)}),this.nodeCache[e]=Promise.all(o).then(function(t){let o;if(o=i.isBone===!0?new Ar:t.length>1?new Ft:t.length===1?t[0]:new Pt,o!==t[0])for(let e=0,n=t.length;e<n;e++)o.add(t[e]);if(i.name&&(o.userData.name=i.name,o.name=a),WS(o,i),i.extensions&&US(n,o,i),i.matrix!==void 0){let e=new K;e.fromArray(i.matrix),o.applyMatrix4(e)}else i.translation!==void 0&&o.position.fromArray(i.translation),i.rotation!==void 0&&o.quaternion.fromArray(i.rotation),i.scale!==void 0&&o.scale.fromArray(i.scale);if(!r.associations.has(o))r.associations.set(o,{});else if(i.mesh!==void 0&&r.meshCache.refs[i.mesh]>1){let e=r.associations.get(o);r.associations.set(o,{...e})}return r.associations.get(o).nodes=e,o}),this.nodeCache[e]}loadScene(e){let t=this.extensions,n=this.json.scenes[e],r=this,i=new Ft;n.name&&(i.name=r.createUniqueName(n.name)),WS(i,n),n.extensions&&US(t,i,n);let a=n.nodes||[],o=[];for(let e=0,t=a.length;e<t;e++)o.push(r.getDependency(`node`,a[e]));return Promise.all(o).then(function(e){for(let t=0,n=e.length;t<n;t++){let n=e[t];n.parent===null?i.add(n):i.add($x(n))}return r.associations=(e=>{let t=new Map;for(let[e,n]of r.associations)(e instanceof $n||e instanceof nt)&&t.set(e,n);return e.traverse(e=>{let n=r.associations.get(e);n!=null&&t.set(e,n)}),t})(i),i})}_createAnimationTracks(e,t,n,r,i){let a=[],o=e.name?e.name:e.uuid,s=[];function c(e){e.morphTargetInfluences&&s.push(e.name?e.name:e.uuid)}zS[i.path]===zS.weights?(c(e),e.isGroup&&e.children.forEach(c)):s.push(o);let l;switch(zS[i.path]){case zS.weights:l=ta;break;case zS.rotation:l=ra;break;case zS.translation:case zS.scale:l=aa;break;default:switch(n.itemSize){case 1:l=ta;break;default:l=aa}}let u=r.interpolation===void 0?E:BS[r.interpolation],d=this._getArrayFromAccessor(n);for(let e=0,n=s.length;e<n;e++){let n=new l(s[e]+`.`+zS[i.path],t.array,d,u);r.interpolation===`CUBICSPLINE`&&this._createCubicSplineTrackInterpolant(n),a.push(n)}return a}_getArrayFromAccessor(e){let t=e.array;if(e.normalized){let e=YS(t.constructor),n=new Float32Array(t.length);for(let r=0,i=t.length;r<i;r++)n[r]=t[r]*e;t=n}return t}_createCubicSplineTrackInterpolant(e){e.createInterpolant=function(e){return new(this instanceof ra?MS:AS)(this.times,this.values,this.getValueSize()/3,e)},e.createInterpolant.isInterpolantFactoryMethodGLTFCubicSpline=!0}};function $S(e,t,n){let r=t.attributes,i=new an;if(r.POSITION!==void 0){let e=n.json.accessors[r.POSITION],t=e.min,a=e.max;if(t!==void 0&&a!==void 0){if(i.set(new W(t[0],t[1],t[2]),new W(a[0],a[1],a[2])),e.normalized){let t=YS(PS[e.componentType]);i.min.multiplyScalar(t),i.max.multiplyScalar(t)}}else{console.warn(`THREE.GLTFLoader: Missing min/max properties for accessor POSITION.`);return}}else return;let a=t.targets;if(a!==void 0){let e=new W,t=new W;for(let r=0,i=a.length;r<i;r++){let i=a[r];if(i.POSITION!==void 0){let r=n.json.accessors[i.POSITION],a=r.min,o=r.max;if(a!==void 0&&o!==void 0){if(t.setX(Math.max(Math.abs(a[0]),Math.abs(o[0]))),t.setY(Math.max(Math.abs(a[1]),Math.abs(o[1]))),t.setZ(Math.max(Math.abs(a[2]),Math.abs(o[2]))),r.normalized){let e=YS(PS[r.componentType]);t.multiplyScalar(e)}e.max(t)}else console.warn(`THREE.GLTFLoader: Missing min/max properties for accessor POSITION.`)}}i.expandByVector(e)}e.boundingBox=i;let o=new Fn;i.getCenter(o.center),o.radius=i.min.distanceTo(i.max)/2,e.boundingSphere=o}function eC(e,t,n){let r=t.attributes,i=[];function a(t,r){return n.getDependency(`accessor`,t).then(function(t){e.setAttribute(r,t)})}for(let t in r){let n=RS[t]||t.toLowerCase();n in e.attributes||i.push(a(r[t],n))}if(t.indices!==void 0&&!e.index){let r=n.getDependency(`accessor`,t.indices).then(function(t){e.setIndex(t)});i.push(r)}return Ke.workingColorSpace!==`srgb-linear`&&`COLOR_0`in r&&console.warn(`THREE.GLTFLoader: Converting vertex colors from "srgb-linear" to "${Ke.workingColorSpace}" not supported.`),WS(e,t),$S(e,t,n),Promise.all(i).then(function(){return t.targets===void 0?e:GS(e,t.targets,n)})}var tC=class{received=0;onPush=()=>void 0;chunks=[];waiters=[];ended=!1;broken=null;read(e,t){let n=new Promise((n,r)=>{this.waiters.push({from:e,to:t,resolve:n,reject:r})});return n.catch(()=>void 0),this.settle(),n}push(e){e.length&&(this.chunks.push({start:this.received,bytes:e}),this.received+=e.length,this.settle(),this.onPush())}end(){this.ended=!0,this.settle()}fail(e){this.broken??={reason:e},this.settle()}settle(){let e=[];for(let t of this.waiters)t.to<=this.received?t.resolve(this.copy(t.from,t.to)):this.broken?t.reject(this.broken.reason):this.ended?t.reject(pf(this.received,t.to)):e.push(t);this.waiters=e}copy(e,t){let n=new Uint8Array(t-e);for(let{start:r,bytes:i}of this.chunks){if(r>=t||r+i.length<=e)continue;let a=i.subarray(Math.max(0,e-r),Math.min(i.length,t-r));n.set(a,Math.max(0,r-e))}return n.buffer}};async function nC(e,t,n){let r=e.getReader();for(n.addEventListener(`abort`,()=>void r.cancel().catch(()=>void 0));;){let{done:e,value:n}=await r.read();if(e)break;t.push(n)}n.throwIfAborted(),t.end()}var rC=2**20,iC=2**25,aC=3,oC=500,sC=class{source;arrival;length;part;signal;parted=!1;begun=!1;whole=null;constructor(e,t,n,r,i){this.source=e,this.arrival=t,this.length=n,this.part=r,this.signal=i}async read(e,t){let{arrival:n}=this;if(t<=n.received||!this.begun||!this.parted&&e<=n.received+rC){let r=await n.read(e,t).catch(e=>{if(this.signal.aborted||!(this.parted||this.begun&&lC(e)))throw e});if(this.begun||this.limit(),r)return r}if(this.giveUp(),typeof this.source!=`string`)return this.slice(this.source,e,t);let r=this.source;return cC(this.signal,()=>this.whole?.read(e,t)??this.fetch(r,e,t),()=>this.whole===null)}limit(){let{arrival:e}=this;this.begun=!0,e.onPush=()=>{e.received>=iC&&e.received<this.length&&this.giveUp()},e.onPush()}giveUp(){this.parted||(this.parted=!0,this.part())}async slice(e,t,n){let r=await e.slice(t,n).arrayBuffer();if(r.byteLength<n-t)throw pf(t+r.byteLength,n);return r}async fetch(e,t,n){let r={Range:`bytes=${t}-${n-1}`},i=await fetch(e,{headers:r,signal:this.signal}).catch(e=>{throw this.signal.aborted?e:this.broken(t,e)});if(i.status===200&&i.body)return this.receive(i.body).read(t,n);if(i.status!==206)throw await i.body?.cancel(),this.broken(t,`The server answered ${i.status}`);let a=await i.arrayBuffer().catch(e=>{throw this.signal.aborted?e:this.broken(t,e)});if(a.byteLength!==n-t)throw this.broken(t+a.byteLength,`a range that was cut short`);return a}receive(e){let t=this.whole=new tC;return nC(e,t,this.signal).catch(e=>t.fail(this.signal.aborted?e:this.broken(t.received,e))),t}broken(e,t){return new ff(`network`,`The connection broke at byte ${e} of ${this.length} of the clip; it is tried again when it plays on.`,String(e),{cause:t})}};async function cC(e,t,n=()=>!0){for(let r=1;;r++)try{return await t()}catch(t){if(e.throwIfAborted(),r===aC||!lC(t)||!n())throw t;await new Promise(e=>setTimeout(e,oC*2**(r-1))),e.throwIfAborted()}}function lC(e){return e instanceof ff&&e.code===`network`}function uC(e){return{read:async(t,n,r)=>{let i=e.get(t);if(!i)throw new ff(`damaged`,`The folder has no file ${t}; copy the clip's whole folder.`,t);if(i.size!==n)throw Q(t,`${i.size} bytes of ${n}`);return i.slice(0,r).arrayBuffer()}}}var dC=class{scene;signal;arriving=new Map;constructor(e,t){this.scene=e,this.signal=t}read(e,t,n){return cC(this.signal,async()=>{let r=this.arriving.get(e)??this.fetch(e,t);try{let i=await r.read(0,n);return n===t&&this.arriving.delete(e),i}catch(t){throw this.arriving.delete(e),t}})}fetch(e,t){let n=new tC;return this.arriving.set(e,n),this.receive(e,t,n).catch(t=>{n.fail(this.signal.aborted||t instanceof ff?t:fC(e,t))}),n}async receive(e,t,n){let r=new URL(e,new URL(this.scene,document.baseURI)),{ok:i,status:a,headers:o,body:s}=await fetch(r,{signal:this.signal}),c=o.get(`Content-Encoding`)?null:o.get(`Content-Length`),l=i&&c!==null&&Number(c)!==t;if(i&&s&&!l)return nC(s,n,this.signal);throw await s?.cancel(),l?Q(e,`${c} bytes of ${t}`):fC(e,`The server answered ${a}`)}};function fC(e,t){return new ff(`network`,`The clip's file ${e} cannot be fetched; put it beside the clip's own. It is tried again when it plays on.`,e,{cause:t})}var pC={mimeType:`video/AV1`,bits:10};async function mC(e,t,n){let r={view:-1,codec:pC,textures:1,pieces:1,where:n},i=await Sg(Sf(e.slice().buffer,n),r,t),a=i[0].picture;if(`data`in a)return a;let o=nm(a,t);return db(i),rm(o,4*t[0],4,t)}var hC=class{size;where;user;decoding=new Set;turn=0;constructor(e,t,n){this.size=e,this.where=t,this.user=n}open=0;get busy(){return this.decoding.size>0}get ready(){return this.decoding.size===0}start(){return Promise.resolve()}decode(e,t,n){if(!n)return;let{turn:r}=this,i=mC(e,this.size,this.where).then(e=>r===this.turn?this.user.take(t,()=>Promise.resolve(e)):void 0).catch(e=>{r===this.turn&&this.user.failed(e)}).finally(()=>{this.decoding.delete(i),this.user.closed()});this.decoding.add(i)}async flush(){await Promise.all(this.decoding)}reset(){this.turn+=1}dispose(){this.reset()}},gC=8,_C=2,vC=2/3,yC=new Set([`damaged`,`truncated`,`network`]),bC=class{timeline;groups;user;loop=!0;late=0;previewsFrom=1/0;decoders;keysAlone=null;meansAlone=!1;slots=new Map;skipped=new Set;rooms;shown=null;wanted=0;from=1;next=0;given=null;fed=0;tried=new Set;broken=new Set;newest=-1;turn=0;feeding=!1;hopeless=!1;constructor(e,t,n){this.timeline=e,this.groups=t,this.user=n,this.rooms=e.films.map(()=>[]),this.decoders=this.makeDecoders()}get open(){return this.decoders.reduce((e,t)=>e+t.open,0)}get reach(){return Math.max(this.newestEnd,this.from)+gC/2}get busy(){return this.decoders.some(({busy:e})=>e)}get sparse(){return this.keysAlone!==null}get plain(){return this.meansAlone}follows(e){return!this.meansAlone&&this.from<=e+1}leaveOut(){this.meansAlone||this.keysAlone||this.timeline.films.every(({detail:e})=>!e)||(this.meansAlone=!0,this.decoders.forEach((e,t)=>this.needs(t)||e.reset()),this.user.ready(),this.feed())}isOver(e){return this.newestEnd>=e&&![...this.slots.keys()].some(t=>t<=e)}standIn(e){return this.keysAlone?this.startOf(e):e}stepped(e,t){if(!this.keysAlone)return e+t;let{groups:n,frames:r}=this.timeline,i=R_(this.timeline,this.numberOf(e))+t,a=Math.floor(i/n.length);return e-this.numberOf(e)+a*r+n[i-a*n.length].first}seek(e){if(this.broken.has(R_(this.timeline,this.numberOf(e))))return!1;let t=this.startOf(e),n=e>=this.from&&this.slots.has(e)&&![...this.skipped].some(t=>t>e);(this.meansAlone||this.given===null||this.next<=t||e<this.next&&!n)&&(this.meansAlone=!1,this.stop(),this.next=t),this.wanted=this.from=e;for(let[t,n]of this.slots)t<e&&this.forget(t,n);return this.feed(),!0}retry(){this.hopeless&&this.keysAlone&&(this.keysAlone=null,this.decoders=this.makeDecoders()),this.hopeless=!1,this.next===1/0&&this.seek(this.from)}take(e){this.next===1/0&&!this.hopeless&&!this.seek(this.from)&&this.pass(R_(this.timeline,this.numberOf(this.from)),this.from),this.wanted=e;let t=[...this.slots].filter(([t,{films:n}])=>t<=e&&this.isWhole(n)),n=Math.max(...t.map(([e])=>e)),r=this.slots.get(n);if(!r)return this.feed(),null;for(let[e,t]of this.slots)e>=n||(e>=this.from&&(this.late+=1),this.forget(e,t));this.slots.delete(n);for(let e of this.skipped)e<n&&this.skipped.delete(e);return this.reuse(this.shown?.films??[]),this.from=Math.max(this.from,n+1),this.shown={position:n,number:this.numberOf(n),...r},this.feed(),this.shown}feed(){if(this.feeding)return;this.feeding=!0;let{turn:e}=this;this.feedAll().catch(t=>{e===this.turn&&this.fail(t)}).finally(()=>{this.feeding=!1,e!==this.turn&&this.feed()})}dispose(){this.rest(),this.hopeless=!0;for(let e of this.decoders)e.dispose()}numberOf(e){return e%this.timeline.frames}startOf(e){let t=this.numberOf(e);return e-t+this.timeline.groups[R_(this.timeline,t)].first}get newestEnd(){if(!this.keysAlone||this.newest<0)return this.newest;let e=this.timeline.groups[R_(this.timeline,this.numberOf(this.newest))];return this.startOf(this.newest)+e.frames-1}makeDecoders(){return this.timeline.films.map(({codec:e,size:t,where:n},r)=>e.decode(t,n,this.userOf(r)))}userOf(e){let{opacity:t}=this.timeline.films[e];return{take:(n,r)=>this.receive(e,n,e=>r(e,t)),closed:()=>this.feed(),failed:e=>this.fail(e),lost:()=>this.rest()}}needs(e){return!this.meansAlone||!this.timeline.films[e].detail}isWhole(e){return e.every((e,t)=>e!==null||!this.needs(t))}get hasRoom(){let{frames:e}=this.timeline,t=this.loop?1/0:e*(Math.floor(this.wanted/e)+1),n=this.keysAlone?this.slots.size<_C?1/0:0:Math.max(this.from,this.wanted)+gC;return this.next<Math.min(n,t)&&this.decoders.every(({ready:e},t)=>e||!this.needs(t))}async feedAll(){for(;this.hasRoom;){let[{turn:e},t,n]=[this,this.next,this.numberOf(this.next)],r=R_(this.timeline,n);if(this.broken.has(r)){this.pass(r,t);continue}this.fed=r;let i=this.given?.index===r?this.given:await this.groups.open(r),a=n-i.first,o=i.units[a]??[];a>=i.frames*vC&&this.prepare((r+1)%this.timeline.groups.length),i.motion?.read(a);let s=()=>this.decoders.map((e,t)=>[e,o[t]]).filter((e,t)=>this.needs(t));if(a===0&&await Promise.all(s().map(([e,t])=>e.start(t))),e!==this.turn)return;this.given=i,this.next=this.keysAlone?t+i.frames:t+1;for(let[e,n]of s())e.decode(n,t,a===0);if(a===i.frames-1&&await Promise.all(this.decoders.map(e=>e.flush())),e!==this.turn)return}}prepare(e){(e||this.loop)&&!this.broken.has(e)&&this.groups.open(e).catch(()=>void 0)}async receive(e,t,n){let[{turn:r},i]=[this,this.slotOf(t)];if(!i)return;let a=await n(this.rooms[e]?.pop());if(r!==this.turn||this.slots.get(t)!==i)return this.reuseOne(e,a);i.films[e]=a,this.isWhole(i.films)&&this.user.ready()}slotOf(e){let t=this.slots.get(e);if(t||this.skipped.has(e))return t??null;this.newest=Math.max(this.newest,e);let n=e<this.from;if(!this.given||n&&performance.now()<this.previewsFrom)return null;if(!n&&e<this.wanted&&this.slots.size>0)return this.late+=1,this.skipped.add(e),null;let r={group:this.given,films:this.decoders.map(()=>null)};return this.slots.set(e,r),r}fail(e){let t=e instanceof ff&&e.code===`codec`?e:null;if(t&&!this.keysAlone)return this.thin(t);if(!(e instanceof ff)||!yC.has(e.code))return this.rest(),this.hopeless=!0,this.user.failed(t?this.keysAlone:e,null);let n=e.code===`damaged`&&this.given?.index===this.fed&&!this.tried.has(this.fed),r=this.startOf(Math.max(this.next-1,0));this.halt();for(let[e,t]of this.slots)this.isWhole(t.films)||this.forget(e,t);n?(this.tried.add(this.fed),this.next=r):(this.broken.add(this.fed),this.user.failed(e,this.fed)),this.feed()}thin(e){for(let e of this.decoders)e.dispose();this.keysAlone=e,this.meansAlone=!1,this.decoders=this.timeline.films.map(({size:e,where:t},n)=>new hC(e,t,this.userOf(n))),this.stop(),this.next=this.startOf(this.from),this.user.thinned(),this.feed()}rest(){this.stop(),this.next=1/0}pass(e,t){let{first:n,frames:r}=this.timeline.groups[e];this.next=t-this.numberOf(t)+n+r,this.newest=this.next-1}stop(){this.halt(),this.newest=-1;for(let[e,t]of this.slots)this.forget(e,t)}halt(){this.turn+=1,this.given=null,this.skipped.clear();for(let e of this.decoders)e.reset()}forget(e,{films:t}){this.slots.delete(e),this.reuse(t)}reuse(e){e.forEach((e,t)=>e&&this.reuseOne(t,e))}reuseOne(e,{room:t}){t&&this.rooms[e]?.push(t)}},xC=.3,SC=.2,CC=2,wC=class{place;read;changed;audio=null;loading=!1;starting=!1;silent=!1;mute=!1;disposed=!1;constructor(e,t,n){this.place=e,this.read=t,this.changed=n}get playable(){return!this.silent}get muted(){return this.mute}set muted(e){this.mute=e,this.audio&&(this.audio.muted=e),this.changed()}get time(){return this.audio&&!this.audio.paused?this.audio.currentTime+this.place.first:null}follow(e,t){let{audio:n}=this;if(!n)return this.load();let r=e-this.place.first;if(r<0||r>=n.duration)return n.pause();let i=r-n.currentTime;Math.abs(i)>xC*Math.max(t,1)?n.seeking||(n.currentTime=r):n.playbackRate=t*(1+Math.min(Math.max(CC*i,-.2),SC)),n.paused&&!this.starting&&this.start(n)}rest(){this.audio?.pause()}dispose(){this.disposed=!0,this.rest(),this.audio&&URL.revokeObjectURL(this.audio.src)}load(){this.loading||this.silent||(this.loading=!0,this.read().then(e=>{if(this.disposed)return;let t=new Audio(URL.createObjectURL(new Blob([e],{type:this.place.mimeType})));t.muted=this.mute,t.addEventListener(`loadedmetadata`,()=>this.audio=t),t.addEventListener(`error`,()=>this.fail())}).catch(()=>this.fail()))}start(e){this.starting=!0,e.play().catch(e=>{e instanceof DOMException&&e.name===`NotAllowedError`&&!this.mute&&(this.muted=!0)}).finally(()=>this.starting=!1)}fail(){this.silent=!0,this.audio=null,this.changed()}};async function TC(e,t,n,r){let i=new jb(e,t,n,r),a=await i.begin();a.motion?.read(0),Mb(e,a);let o=await Promise.all(t.films.map(({size:e,where:t},n)=>mC(a.units[0][n],e,t))),{sound:s}=t;return{timeline:t,group:a,films:o,mesh:n,ring:e=>new bC(t,i,e),sound:s&&(e=>new wC(s,()=>r(s,s.length),e))}}async function EC(e,t){let{mean:n,meanSize:r}=e,i=e.precision&&await DC(await t(e.precision.view),e.precision);return{pieces:await n.codec.decode(await t(n.view),n,r),precision:i}}async function DC(e,t){let{type:n}=lg(e)??{},{mimeType:r}=t.codec;if(n&&n!==r)throw Q(t.where,`${n}, not ${r}`);let[i]=await t.codec.bitmaps(e,t,t.size);if(!i)throw Q(t.where,`no picture`);return i.picture}function OC({pieces:e,precision:t}){db(e),t?.close()}var kC=`"names":["texts":["heldOut":[1,2,"lenses":[null,"harmonise":"gain","affine","align":true,"residual":{"quality":40},"metresPerUnit":0."sharedPicture","times","codec":"codedNames":{"bufferView":10,"count":20},"sizes":3,"colour":4,"times":[0,"residual":{"size":[512,512],"scale":[0.00,0.00],"full":true,"smooth":true,"order":3,"holdOut":"odd","every:"scores":{"psnr":{"mean":"ssim":{"mean":"captured":"heldOut":{"needs":["av1-10bit-2","cameras-2","codedNames","codedTriangles","codedWeights","mesh-2","namePattern","precision","regions","stacks","toRGB"],"mesh":{"bufferView":5,"codec":"mesh-2"},"planes":[{"channels":1,"mean":{"bufferView":6,"size":[1024,768],"mimeType":"video/AV1","bits":10,"scale":[0.0009775171065493646],"zero":[0],"precision":{"bufferView":7,"size":[13,12]}},"bases":[{"size":[480,480],"codedWeights":8,"textures":[{"bufferView":11,"mimeType":"video/AV1","bits":10,"count":2,"scale":[0.0001],"zero":[341]}]},{"size":[64,464],"grid":[464,464],"corner":[0,0],"codedWeights":9,"picture":{"mimeType":"video/AV1","bits":10,"count":8,"scale":[0.0002],"zero":[341]},"textures":[{"bufferView":12},{"bufferView":13}]}]},{"channels":2,"mean":{"bufferView":9,"size":[512,384],"mimeType":"video/AV1","bits":10,"scale":[0.0004,0.0004],"zero":[341,341],"precision":{"bufferView":7,"size":[13,12]}},"bases":[]}],"toRGB":[1,-0.027444022,-0.9585462,1,-0.092323445,0.284937,1,0.9953508,0],"cameras":{"pattern":{"counts":[81,1],"parts":["image_",{"axis":0,"first":0,"step":1,"digits":3},".png",".jpg",".webp"]},"size":[640,480],"coded":{"bufferView":4,"codec":"cameras-2"}},"viewPlane":{"origin":[0,0,0],"right":[1,0,0],"up":[0,-1,0],"extent":[0.5,0.5],"codedTriangles":10},"reference":40,"settings":{"textures":2,"atlas":[1024,768],"density":1.3,"fit":"photographs","fitted":{"quality":78,"psnr":{"luma":{"uncoded":50.0,"coded":40.0},"chroma":{"uncoded":50.0,"coded":40.0}}},"photographs":{"count":81,"bytes":10000000,"pixels":10000000}},"generator":"eigenfield 0.1.0","lengths":[`,AC=4;async function jC(e,t){let n=new Ig(e,``),r=n.key(`extensions`).key(Of),i=r.key(`packed`);if(!i.exists)return e;Y_(r);let a=Wg(n),o=a[i.integer(a.length-1,a.length-1)];if(!o||o.length<AC)throw i.wrong(`no length`);let s=new DataView(await t(o.offset,AC)).getUint32(0,!0);if(AC+s>o.length)throw i.wrong(`JSON of ${s} bytes`);let{lengths:c,...l}=new Ig(Eb(await NC(await t(o.offset+AC,s),i.where),i.where),i.where).object(),u=MC(new Ig(c,`${i.where}/lengths`),o,AC+s),{packed:d,...f}=r.object();return{...e,bufferViews:[...n.key(`bufferViews`).items(Af).slice(0,-1).map(({raw:e})=>e??null),...u],extensions:{...n.key(`extensions`).object(),[Of]:{...f,...l}}}}function MC(e,t,n){let r=n,i=e.items(Af).map(e=>{let n=e.integer(1,t.length);return r+=n,{buffer:0,byteOffset:t.offset+r-n,byteLength:n}});if(r!==t.length)throw e.wrong(`${r} bytes of ${t.length}`);return i}async function NC(e,t){let n=new TextEncoder().encode(kC),[r,i]=[n.length&255,n.length>>8],a=new Uint8Array(5+n.length+e.byteLength);a.set([0,r,i,~r,~i]),a.set(n,5),a.set(new Uint8Array(e),5+n.length);let o=await Df(a,`deflate-raw`,n.length+kf,t);try{return new TextDecoder(`utf-8`,{fatal:!0,ignoreBOM:!0}).decode(o.subarray(n.length))}catch{throw Q(t,`its JSON is not UTF-8`)}}var PC=3;function FC(e){return xv(e).flatMap((e,t)=>{let n=0;return e.pictures.map(r=>{let i=n;return n+=r.textures,{basis:e,number:t,picture:r,first:i}})}).sort((e,t)=>e.first-t.first||e.number-t.number)}function IC(e,t,n){let r=FC(e),i=n,a=({basis:e,picture:n})=>{let r=t(n.view).then(t=>n.codec.decode(t,n,e.size));return r.catch(()=>void 0),r};return{async fill(n){let{plan:o,signal:s}=n,c=i??await Promise.all(J_(e).map(e=>EC(e,t)));i=null,c.forEach((e,t)=>{n.putMean(t,e),OC(e)});let l=r.filter(({first:e})=>e<o.usable),u=[],d=0;try{for(let{number:e,first:t,picture:r}of l){if(s.aborted)return;for(let e of l.slice(d,d+PC-u.length))u.push(a(e)),d+=1;let i=await u[0]??[];u.shift(),n.putTextures(e,t,i,r),db(i),n.announce()}}finally{for(let e of u)e.then(db).catch(()=>void 0)}n.end()},gain(n){let r=0;for(let{channels:i,bases:a}of e.planes){let o=e.colours.slice(r,r+=i),s=a.find(({count:e})=>e>n);if(s)return mb(s,n,o,t)}return Promise.resolve(1)},dispose(){i?.forEach(OC),i=null}}}function LC(e){let t=e.length/2;for(let n=1;n*n<=t;n++){if(t%n)continue;let r=t/n,i=RC(e,n,r)??(n===r?null:RC(e,r,n));if(i)return i}return null}function RC(e,t,n){let[r,i]=[BC(e,0),BC(e,1)];if(t===1&&VC(i)>0||n===1&&VC(r)>0)return null;let a=Array.from(r,(e,t)=>t).sort((e,t)=>HC(i,e)-HC(i,t));for(let e=0;e<t;e++){let t=a.slice(e*n,(e+1)*n).sort((e,t)=>HC(r,e)-HC(r,t));a.splice(e*n,n,...t)}let o=(e,t)=>a[e*n+t]??0;return zC(n,t,(e,t)=>HC(r,o(t,e)))&&zC(t,n,(e,t)=>HC(i,o(e,t)))?{rows:t,columns:n,index:Int32Array.from(a)}:null}function zC(e,t,n){let r=1/0,i=0,a=NaN;for(let o=0;o<e;o++){let e=0;for(let r=0;r<t;r++)e+=n(o,r)/t;for(let r=0;r<t;r++)i=Math.max(i,Math.abs(n(o,r)-e));o&&(r=Math.min(r,e-a)),a=e}return r>0&&(r===1/0||i<=r/4)}function BC(e,t){return Float64Array.from({length:e.length/2},(n,r)=>e[2*r+t]??0)}function VC(e){return e.reduce((e,t)=>Math.max(e,t),-1/0)-e.reduce((e,t)=>Math.min(e,t),1/0)}var HC=(e,t)=>e[t]??0,UC=1e-6,WC=32,GC=class{places;triangles;isLine;grid;rules=new Map;constructor(e,t,n){this.places=e,this.triangles=t,this.isLine=n,this.grid=LC(e)}at(e,t,n){let r=n===`bilinear`&&!this.grid?`delaunay`:n,i=this.rules.get(r);return i||this.rules.set(r,i=this.makeRule(r)),i(KC(e),this.isLine?0:KC(t))}makeRule(e){return e===`nearest3`?(e,t)=>aw(e,t,this.places):e===`bilinear`&&this.grid?sw(this.places,this.grid):ZC(this.places,this.triangles)}};function KC(e){return Math.min(1,Math.max(-1,e))}function qC(e){let t={camera:[0,0,0,0],weight:[0,0,0,0]};return e.forEach(([e,n],r)=>{t.camera[r]=e,t.weight[r]=n}),t}var JC=(e,t)=>e[2*t]??0,YC=(e,t)=>e[2*t+1]??0;function XC(e,t,n,r,i,a){let[o,s]=[JC(n,r),YC(n,r)],[c,l]=[JC(n,i)-o,YC(n,i)-s],[u,d]=[JC(n,a)-o,YC(n,a)-s],f=c*d-l*u,p=((e-o)*d-(t-s)*u)/f,m=(c*(t-s)-l*(e-o))/f;return[1-p-m,p,m]}function ZC(e,t){if(!t.length){let t=iw(e,rw(e));return(n,r)=>nw(n,r,e,t)}let n=ew(e,t,3),r=tw(t);return(i,a)=>{let o=-1,s=-1/0,c=[0,0,0];for(let r of n[$C(a)*WC+$C(i)]??[]){let[n,l,u]=[QC(t,r,0),QC(t,r,1),QC(t,r,2)],d=XC(i,a,e,n,l,u),f=Math.min(...d);f>s&&([o,s,c]=[r,f,d])}return s<-1e-9?nw(i,a,e,r):qC(c.map((e,n)=>[QC(t,o,n),e]))}}var QC=(e,t,n)=>e[3*t+n]??0;function $C(e){return Math.min(31,Math.max(0,Math.floor((e+1)/2*WC)))}function ew(e,t,n){let r=Array.from({length:1024},()=>[]);for(let i=0;i<t.length/n;i++){let a=Array.from({length:n},(e,r)=>t[n*i+r]??0),o=a.map(t=>JC(e,t)),s=a.map(t=>YC(e,t));for(let e=$C(Math.min(...s));e<=$C(Math.max(...s));e++)for(let t=$C(Math.min(...o));t<=$C(Math.max(...o));t++)r[e*WC+t]?.push(i)}return r}function tw(e){let t=new Map;for(let n=0;n<e.length/3;n++)for(let r=0;r<3;r++){let[i,a]=[QC(e,n,r),QC(e,n,(r+1)%3)],o=i<a?[i,a]:[a,i],s=t.get(o.join());s?s.times+=1:t.set(o.join(),{edge:o,times:1})}let n=[...t.values()].filter(e=>e.times===1).map(e=>e.edge);return n.sort((e,t)=>e[0]-t[0]||e[1]-t[1]),Int32Array.from(n.flat())}function nw(e,t,n,r){let i=1/0,a=[r[0]??0,r[0]??0,0];for(let o=0;o+1<r.length;o+=2){let[s,c]=[r[o]??0,r[o+1]??0],[l,u]=[JC(n,s),YC(n,s)],[d,f]=[JC(n,c)-l,YC(n,c)-u],p=d*d+f*f,m=p>0?Math.min(1,Math.max(0,((e-l)*d+(t-u)*f)/p)):0,h=(l+m*d-e)**2+(u+m*f-t)**2;h<i&&([i,a]=[h,[s,c,m]])}let[o,s,c]=a;return qC([[o,1-c],[s,c]])}function rw(e){return Array.from({length:e.length/2},(e,t)=>t)}function iw(e,t){let[n=0]=t;if(t.length===1)return Int32Array.of(n,n);let r=[0,0];for(let n of t)r[0]=(r[0]??0)+JC(e,n)/t.length,r[1]=(r[1]??0)+YC(e,n)/t.length;let[i,a,o]=[0,0,0];for(let n of t){let[t,s]=[JC(e,n)-(r[0]??0),YC(e,n)-(r[1]??0)];[i,a,o]=[i+t*t,a+t*s,o+s*s]}let s=.5*Math.atan2(2*a,i-o),c=t=>JC(e,t)*Math.cos(s)+YC(e,t)*Math.sin(s),l=[...t].sort((e,t)=>c(e)-c(t));return Int32Array.from(l.slice(1).flatMap((e,t)=>[l[t]??0,e]))}function aw(e,t,n){let[r,i,a]=[-1,-1,-1],[o,s,c]=[1/0,1/0,1/0];for(let l=0;2*l<n.length;l++){let[u,d]=[JC(n,l)-e,YC(n,l)-t],f=u*u+d*d;f>=c||(a=l,c=f,f<s&&([a,c]=[i,s],[i,s]=[l,f]),f<o&&([i,s]=[r,o],[r,o]=[l,f]))}if(a<0||ow(n,r,i,a)<=UC)return nw(e,t,n,iw(n,[r,i,a].filter(e=>e>=0)));let[l,u,d]=XC(e,t,n,r,i,a);return{camera:[r,i,a,0],weight:[l,u,d,0]}}function ow(e,t,n,r){let[i,a]=[JC(e,n)-JC(e,t),YC(e,n)-YC(e,t)],[o,s]=[JC(e,r)-JC(e,t),YC(e,r)-YC(e,t)],c=Math.max(i*i+a*a,o*o+s*s,(i-o)**2+(a-s)**2);return c>0?Math.abs(i*s-a*o)/c:0}function sw(e,t){let{rows:n,columns:r,index:i}=t;if(Math.min(n,r)===1){let t=iw(e,rw(e));return(n,r)=>nw(n,r,e,t)}let a=(e,t)=>i[e*r+t]??0,o=[];for(let e=0;e+1<n;e++)for(let t=0;t+1<r;t++)o.push([a(e,t),a(e,t+1),a(e+1,t+1),a(e+1,t)]);let s=ew(e,o.flat(),4),c=[];for(let e=0;e<r;e++)c.push(a(0,e));for(let e=1;e<n;e++)c.push(a(e,r-1));for(let e=r-2;e>=0;e--)c.push(a(n-1,e));for(let e=n-2;e>=0;e--)c.push(a(e,0));let l=Int32Array.from(c.slice(1).flatMap((e,t)=>[c[t]??0,e]));return(t,n)=>{let r=null,i=-1/0;for(let a of s[$C(n)*WC+$C(t)]??[]){let s=o[a],c=s?cw(t,n,e,s):-1/0;s&&c>i&&([r,i]=[s,c])}if(!r||i<-1e-9)return nw(t,n,e,l);let[a,c]=lw(t,n,e,r);return{camera:r,weight:[(1-a)*(1-c),a*(1-c),a*c,(1-a)*c]}}}function cw(e,t,n,r){let i=1/0;for(let a=0;a<4;a++){let[o,s]=[r[a],r[(a+1)%4]],[c,l]=[JC(n,o),YC(n,o)];i=Math.min(i,(JC(n,s)-c)*(t-l)-(YC(n,s)-l)*(e-c))}return i}function lw(e,t,n,r){let[i,a,o,s]=[JC(n,r[0]),YC(n,r[0]),JC(n,r[1]),YC(n,r[1])],[c,l,u,d]=[JC(n,r[2]),YC(n,r[2]),JC(n,r[3]),YC(n,r[3])],[f,p,m,h,g,_]=[e-i,t-a,o-i,s-a,u-i,d-a],[v,y]=[i-o+c-u,a-s+l-d],b=f*h-p*m,x=f*y-p*v-(g*h-_*m),S=-(g*y-_*v),C=Math.sqrt(Math.max(x*x-4*b*S,0)),w=uw(-2*b/(x+(x<0?-C:C))),[T,E]=[m+w*v,h+w*y];return[uw(((f-w*g)*T+(p-w*_)*E)/(T*T+E*E)),w]}function uw(e){return Math.min(1,Math.max(0,e))}var dw=class{parser;options;name=Of;scene=null;views=[];lacks=null;ours;constructor(e,t={}){this.parser=e,this.options=t,this.ours=G_(e.json)}async beforeRoot(){if(!this.ours)return;this.options.renderer&&wx(this.options.renderer);let{json:e}=this.parser;vf(e),Object.assign(e,await jC(e,(e,t)=>this.read(e,t)));let t=K_(e),{stream:n}=this.options,r=t.timeline?.groups[0]?.file?n?.readFile:n?.readGroups;(!t.timeline||r)&&(this.views=t.views,t.timeline&&t.shown&&!await yg(`image/avif`)?this.lacks=new ff(`codec`,`This browser decodes no AV1; use a newer browser. The first frame is shown.`,``):(this.scene=t,this.scene.shown||fw(e)))}async read(e,t){if(this.options.stream)return this.options.stream.read(e,t);let n=(await this.parser.getDependency(`buffer`,0)).slice(e,e+t);if(n.byteLength<t)throw mf(`/buffers/0`);return n}loadMaterial(e){let t=this.scene&&this.parser.json.meshes[0].primitives[0];if(!t||t.material!==e)return null;let{doubleSided:n}=this.parser.json.materials?.[e]??{},r=new ar;return r.side=n===!0?2:0,Promise.resolve(r)}loadBufferView(e){let t=this.views[e];return t&&this.options.stream?this.options.stream.read(t.offset,t.length):null}async afterRoot(e){let{scene:t}=this;if(this.lacks&&(e.userData.eigenfieldError=this.lacks),!t)return;let n=pw(e,this.parser),[r]=n;if(!r)throw Q(`/meshes/0`,`no node shows it`);t.shown&&cx(r.geometry,t.shown);let i=async e=>{let n=await this.parser.getDependency(`bufferView`,e);if(n.byteLength<(t.views[e]?.length??0))throw mf(`/bufferViews/${e}`);return n},a=t.mesh&&await lx(t.mesh,i),o=t.timeline&&a&&await this.openClip(t,t.timeline,a);if(a){let e=ux(a);r.geometry.dispose();for(let t of n)t.geometry=e}t.sheets&&C_(t.sheets,r.geometry);let[s,c,l,u]=await Promise.all([Promise.all(o?[]:J_(t).map(e=>EC(e,i))),lv(t,i),o?o.group.omega:_v(t,i),wv(t,i)]),d=c.filter((e,n)=>!t.heldOut[n]),f=new GC(Float64Array.from(d.flatMap(e=>Ov(t,e.centre))),u,t.extent[1]===0),p=o?J_(t).map(({meanSize:e})=>e??[1,1]):s.map(({pieces:[e]})=>[e?.picture.width??1,e?.rows??1]),m={scene:t,info:Ev(t,c,p,f.grid,this.fileBytes(),dx(r.geometry)),meshes:n,meanSizes:p,omega:l,weights:f,clip:o},h=o?new gb(t,o.films):IC(t,i,s);e.userData.eigenfield=new qx(m,h,this.options)}openClip(e,t,n){let r=this.options.stream;return TC(e,t,n,({offset:e,length:t,file:n},i)=>n===null?r.readGroups(e,i):r.readFile(n,t,i))}fileBytes(){let{groups:e=[],sound:t=null}=this.scene?.timeline??{},n=[...e,...t?[t]:[]].reduce((e,t)=>e+(t.file?t.length:0),0);if(this.options.stream)return this.options.stream.total+n;let{extensions:r,json:i}=this.parser;return r.KHR_binary_glTF?.header?.length??i.buffers[0]?.byteLength??0}};function fw(e){let[t]=e.nodes;t&&(t.mesh=0),e.meshes=[{primitives:[{attributes:{},material:0}]}],e.materials=[{doubleSided:!0}]}function pw(e,t){let n=[];return e.scene.traverse(e=>{let r=t.associations.get(e);mw(e)&&r?.meshes===0&&(r.primitives??0)===0&&n.push(e)}),n}function mw(e){return e.isMesh===!0}async function hw(e,t={}){let{signal:n}=t,r=gw(e);n?.throwIfAborted();let i=new tC,[a,o]=[new AbortController,new AbortController],s=()=>{i.fail(new DOMException(`The load was stopped.`,`AbortError`)),a.abort()};n?.addEventListener(`abort`,s),a.signal.addEventListener(`abort`,()=>o.abort());let c=bw(r,i,o.signal,t.onBytes).catch(e=>i.fail(e)).finally(()=>n?.removeEventListener(`abort`,s));try{let e=await Cb(i);if(!G_(e.json))return{gltf:await yw(i,e,c),field:null,error:null};let s=r instanceof Uint8Array?i:(t=>new sC(t,i,e.length,()=>o.abort(),a.signal))(r),l=t.files?uC(t.files):null,u=await _w(i,e,s,typeof r==`string`?new dC(r,a.signal):l,t),{eigenfield:d,eigenfieldError:f}=u.userData,p=d instanceof qx?d:null;return n?.aborted&&p?.dispose(),n?.throwIfAborted(),{gltf:u,field:p,error:f instanceof ff?f:null}}catch(e){throw a.abort(),n?.throwIfAborted(),hf(e)}}function gw(e){if(typeof e==`string`)return e;if(ArrayBuffer.isView(e))return new Uint8Array(e.buffer,e.byteOffset,e.byteLength);let t=Object.prototype.toString.call(e).slice(8,-1);if(t===`URL`)return String(e);if(t===`Blob`||t===`File`)return e;if(t===`ArrayBuffer`)return new Uint8Array(e);throw TypeError(`A scene is loaded from an address, a Blob or an ArrayBuffer.`)}async function _w(e,t,n,r,i){let a=new tS,o=(e,t=n)=>async(n,r)=>{let i=await e+n;return t.read(i,i+r)},s=t.binary();s.catch(()=>void 0);let c={total:t.length,read:o(s,e),readGroups:(...e)=>o(t.groups())(...e),readFile:(...e)=>r?.read(...e)??Promise.reject(vw(e[0]))};return a.register(e=>new dw(e,{...i,stream:c})),a.parseAsync(t.text,``)}function vw(e){return new ff(`unsupported`,`The clip is a folder, and its file ${e} cannot be found from here; make one file of it, with \`eigenfield export\`.`,e)}async function yw(e,t,n){await n;let r=await e.read(0,t.length);try{let e=new tS;return e.register(_f),await e.parseAsync(r,``)}catch(e){if(e instanceof ff)throw e;let t=hf(e).message;throw new ff(`unsupported`,`${t} It has no eigen textures either.`,``,{cause:e})}}async function bw(e,t,n,r){if(e instanceof Uint8Array)return t.push(e),r?.(e.length,e.length),t.end();let{body:i,total:a}=typeof e==`string`?await Sw(e,n):xw(e),o=i.getReader();for(n.addEventListener(`abort`,()=>void o.cancel().catch(()=>void 0));;){let{done:e,value:i}=await o.read().catch(e=>{throw n.aborted?e:Cw(t.received,e)});if(e)break;t.push(i),r?.(t.received,a)}n.throwIfAborted(),t.end()}function xw(e){return{body:e.stream(),total:e.size}}async function Sw(e,t){let n=await fetch(e,{signal:t}).catch(n=>{throw t.aborted?n:new ff(`network`,`The scene cannot be fetched; check its address and the connection.`,e,{cause:n})});if(!n.ok||!n.body)throw await n.body?.cancel(),new ff(`network`,`The server answered ${n.status} for the scene; check its address.`,e);let r=n.headers.get(`Content-Encoding`)?null:n.headers.get(`Content-Length`);return{body:n.body,total:r&&/^\d+$/.test(r)?Number(r):void 0}}function Cw(e,t){return new ff(`network`,`The connection broke after ${e} bytes of the scene; load it again.`,String(e),{cause:t})}var ww=2.4,Tw=1.45,Ew=.07,Dw=.1,Ow=12;function kw(e,t){let n=new U().setFromUnitVectors(new W(0,1,0),t.up),r=n.clone().invert(),i={yaw:0,pitch:0,roll:0,distance:t.radius,target:t.centre.clone()},a={...i,target:i.target.clone()},o=new so,s=1,c=e=>new W(Math.sin(e.yaw)*Math.cos(e.pitch),Math.sin(e.pitch),Math.cos(e.yaw)*Math.cos(e.pitch)).applyQuaternion(n),l=e=>c(e).multiplyScalar(e.distance).add(e.target),u=()=>{Object.assign(i,a,{target:a.target.clone()})},d=(e,n)=>{let i=e.clone().sub(n);a.distance=Math.max(i.length(),t.radius*.001),i.divideScalar(a.distance).applyQuaternion(r),a.pitch=Math.asin(Zl(i.y,-1,1)),a.yaw=Math.atan2(i.x,i.z),a.target.copy(n),a.roll=0},f=e=>{a.distance=Zl(e,t.radius*.02,t.radius*12)},p=()=>{let e=c(a),n=new W().crossVectors(t.up,e).normalize();return[n,new W().crossVectors(e,n)]},m=(e,n)=>{let[r,i]=p();a.target.addScaledVector(r,e).addScaledVector(i,n);let o=a.target.clone().sub(t.centre);o.length()>2*t.radius&&a.target.copy(t.centre).add(o.setLength(2*t.radius))},h=()=>{let{x:e,y:n}=t.tangents;return t.framed&&Xl(s)?Math.min(n,e/s):Math.max(n,e/s)},g=e=>{let n={...a,target:a.target.clone()},r=r=>(Object.assign(a,n,{target:n.target.clone()}),e(r),t.beyond(l(a),a.target)),i=t.beyond(l(a),a.target),o=r(1);if(o<=i)return;let s=Dw*Math.log(Math.exp(i/Dw)+(o-i)/Dw),[c,u]=[0,1];for(let e=0;e<Ow;e++){let e=(c+u)/2;r(e)<s?c=e:u=e}r(c)},_=(e,t)=>{a.yaw+=e,a.pitch=Zl(a.pitch+t,-1.45,Tw)},v=(t,n)=>(o.setFromCamera(n,t),o.intersectObject(e,!0)[0]?.point??null);return{enter:(e,n)=>{let r=new W().setFromMatrixPosition(e.matrixWorld);o.setFromCamera(n,e);let a=o.ray.direction.clone(),s=t.focus?t.focus.clone().sub(r).dot(a):0,l=s>0?r.clone().addScaledVector(a,s):v(e,n);d(r,l??r.clone().addScaledVector(a,Math.max(r.distanceTo(t.centre),.001))),u();let[,f]=p(),m=new W().setFromMatrixColumn(e.matrixWorld,1).projectOnPlane(a).normalize(),h=new W().crossVectors(f,m).dot(c(i));i.roll=f.angleTo(m)*Math.sign(h)},aim:(e,t)=>{let n=v(e,t);n&&d(l(a),n)},set:(e,t)=>{d(e,t),u()},pose:()=>({eye:l(i),target:i.target.clone()}),grab:()=>{},drag:(e,t,n)=>{if(n){let n=2*a.distance*Math.min(h(),h()*s);g(r=>m(-e*n*r,t*n*r))}else g(n=>_(-e*ww*n,t*ww*n))},release:()=>{},push:(e,t)=>{g(n=>_(e.x*t*n,e.y*t*n)),f(a.distance*Math.exp(-(e.closer+e.forward)*t))},closer:e=>f(a.distance/e),forward:e=>f(a.distance*(1-e)),step:e=>{let n=1e-4;i.yaw=Yl(i.yaw,a.yaw,e,Ew,n),i.pitch=Yl(i.pitch,a.pitch,e,Ew,n),i.roll=Yl(i.roll,a.roll,e,2*Ew,n),i.distance=Yl(i.distance,a.distance,e,Ew,n*a.distance);let r=Yl(1,0,e,Ew,0);return i.target.distanceTo(a.target)*r<n*t.radius?i.target.copy(a.target):i.target.lerp(a.target,1-r),i.yaw!==a.yaw||i.pitch!==a.pitch||i.roll!==a.roll||i.distance!==a.distance||!i.target.equals(a.target)},place:(e,n)=>(s=n,e.position.copy(l(i)),e.up.copy(t.up),e.lookAt(i.target),e.rotateZ(i.roll),e.near=Math.max(i.distance-3*t.radius,i.distance*.01),e.far=i.distance+20*t.radius,e.fov=2*V.radToDeg(Math.atan(h())),e.aspect=n,e.zoom=1,e.view=null,e.updateProjectionMatrix(),e.updateMatrixWorld(!0),ql),beyond:()=>t.beyond(l(i),i.target)}}var Aw=(e,t)=>[e[0]+t[0],e[1]+t[1],e[2]+t[2]],jw=(e,t)=>[e[0]*t,e[1]*t,e[2]*t],Mw=(e,t)=>e[0]*t[0]+e[1]*t[1]+e[2]*t[2],Nw=(e,t)=>{let n=e[t];return[n?.[0]??0,n?.[1]??0,n?.[2]??0]},Pw=(e,t)=>[Mw(Nw(e,0),t),Mw(Nw(e,1),t),Mw(Nw(e,2),t)],Fw=2.6,Iw=.14,Lw=1.1,Rw=8,zw=.07,Bw=-.6,Vw=.6;function Hw(e,t){let{viewPlane:n}=e.info,r=n.extent[1]===0,i={x:0,y:0,zoom:1,dolly:0},a={x:0,y:0,zoom:1,dolly:0},o=Gw(e),s=Vw*o.nearest/o.middle,c=!1,l=!1,u=(e,t,n)=>{a.x=Zl(e,-n,n),a.y=r?0:Zl(t,-n,n)},d=e=>void(a.dolly=Zl(e,Bw,s)),f=Uw(Mv(e,0,0),t),p=e=>void(a.zoom=Zl(e,1/f,Rw)),m=()=>{let t=Zl(i.x,-1,1),r=Zl(i.y,-1,1),a=Mv(e,t,r),s=Aw(Aw(jw(n.right,(i.x-t)*n.extent[0]),jw(n.up,(i.y-r)*n.extent[1])),jw(o.forward,i.dolly*o.middle)),c=Aw(a.centre,s);return{...a,centre:c,t:[...jw(Pw(a.R,c),-1)]}};return{at:()=>({...i}),goal:()=>({x:a.x,y:a.y}),goTo:(e,t,n=!1)=>{u(e,t,1),n&&Object.assign(i,a)},setZoom:p,setDolly:d,grab:()=>void(c=!0),drag:(e,t)=>u(a.x-e*Fw,a.y+t*Fw,3),release:()=>{c=!1,u(a.x,a.y,1)},push:(e,t)=>{let n=Lw*t;u(a.x+e.x*n,a.y+e.y*n,1.28),p(a.zoom*Math.exp(e.closer*t)),d(a.dolly+.4*e.forward*t),l=e.x!==0||e.y!==0},closer:e=>p(a.zoom*e),forward:e=>d(a.dolly+e),step:e=>(p(a.zoom),!c&&!l&&u(a.x,a.y,1),l=!1,i.x=Yl(i.x,Ww(a.x),e,zw,2e-4),i.y=Yl(i.y,Ww(a.y),e,zw,2e-4),i.zoom=Yl(i.zoom,a.zoom,e,zw,.001),i.dolly=Yl(i.dolly,a.dolly,e,zw,2e-4),i.x!==Ww(a.x)||i.y!==Ww(a.y)||i.zoom!==a.zoom||i.dolly!==a.dolly),place:(t,n)=>{let r=m();return f=Uw(r,n),Iv(e,t,r,n,f*i.zoom)},beyond:()=>0}}var Uw=({width:e,height:t},n)=>Xl(n)?Math.max(1,e/t/n):1;function Ww(e){let t=Math.abs(e)-1;return t<=0?e:Math.sign(e)*(1+Iw*(1-Math.exp(-t/(2*Iw))))}function Gw(e){let{normal:t,origin:n}=e.info.viewPlane,r=jw(t,-1),i=e.mesh.geometry.getAttribute(`position`),a=Math.max(1,Math.floor(i.count/2e4)),o=[];for(let e=0;e<i.count;e+=a){let t=[i.getX(e),i.getY(e),i.getZ(e)];o.push(Mw(Aw(t,jw(n,-1)),r))}let s=o.filter(e=>e>0).sort((e,t)=>e-t),c=e=>s[Math.floor(e*(s.length-1))]??1;return{forward:r,nearest:c(.01),middle:c(.5)}}var Kw=.5,qw=1e-5,Jw=.15;function Yw(e){let{cameras:t,reference:n,viewPlane:r,facesPlane:i}=e.info;e.mesh.updateWorldMatrix(!0,!1);let a=e.mesh.matrixWorld,o=e=>new W(e[0],e[1],e[2]).transformDirection(a),s=e=>new W(e[0],e[1],e[2]).applyMatrix4(a),c=new W;for(let e of t)c.sub(o(Nw(e.R,1)));let l=o(i?r.up:r.normal),u=c.length()>Kw*t.length?c:l.multiplyScalar(c.dot(l)<0?-1:1),{centre:d,radius:f}=Zw(e.mesh),[p,m]=[o(r.right),o(r.up)],h=new W().crossVectors(p,m),g=s(r.origin),[_,v]=r.extent,y=.030000000000000027*Math.max(_,v),b=(e,t)=>{let n=e.clone().sub(t).normalize(),r=g.clone().sub(t).dot(h),i=Math.max(n.dot(h)*Math.sign(r),qw),a=t.clone().addScaledVector(n,Math.abs(r)/i).sub(g),[o,s]=[a.dot(p),a.dot(m)],[c,l]=[_+y,v+y];if(i>qw&&Math.abs(o)<=c&&Math.abs(s)<=l)return 0;let u=g.clone().addScaledVector(p,Zl(o,-c,c));return u.addScaledVector(m,Zl(s,-l,l)),n.angleTo(u.sub(t))},x=t.map(e=>s(e.centre)),S=Math.max(Jw,Qw(x,d)),C=(e,t)=>{let n=e.clone().sub(t);return Math.max(0,Math.min(...x.map(e=>e.clone().sub(t).angleTo(n)))-S)},w=t[n],T=w?new H(w.width/(2*Nw(w.K,0)[0]),w.height/(2*Nw(w.K,1)[1])):new H(.5,.5),E=i?null:Xw(x,t.map(e=>o(Nw(e.R,2)))),D=i?b:C;return{up:u.normalize(),centre:d,radius:f,tangents:T,focus:E,framed:i,beyond:D}}function Xw(e,t){let n=Array(9).fill(0),r=new W;e.forEach((e,i)=>{let a=t[i];if(!a)return;r.add(e).addScaledVector(a,-e.dot(a));let o=a.toArray();for(let e=0;e<9;e++){let[t,r]=[Math.floor(e/3),e%3];n[e]=(n[e]??0)+ +(t===r)-(o[t]??0)*(o[r]??0)}});let i=new G().fromArray(n);return Math.abs(i.determinant())<1e-6*e.length**3?null:r.applyMatrix3(i.invert())}function Zw(e){let t=new an().setFromObject(e).getBoundingSphere(new Fn);return{centre:t.center,radius:Math.max(t.radius,1e-6)}}function Qw(e,t){let n=e.slice(0,200).map(e=>e.clone().sub(t)),r=n.map((e,t)=>n.reduce((n,r,i)=>t===i?n:Math.min(n,e.angleTo(r)),1/0)).filter(Number.isFinite).sort((e,t)=>e-t);return 1.5*(r[r.length>>1]??0)}function $w(e,{gltf:t,field:n},r,i){t.scene.updateWorldMatrix(!0,!0);let a=n?Yw(n):eT(t);return{source:e,gltf:t,field:n,around:a,lacks:r,plane:n?.info.facesPlane?Hw(n,i):null,orbit:kw(n?.mesh??t.scene,a)}}function eT(e){let{centre:t,radius:n}=Zw(e.scene),r=new H(.4,.4);return{up:new W(0,1,0),centre:t,radius:n,tangents:r,focus:null,framed:!1,beyond:()=>0}}function tT(e,t,n,r){let{changed:i}=r,a=[],o=Promise.resolve(),s=()=>void 0,c=()=>{e.scene&&(r.closing(),e.scene.field?.dispose(),t.clear(),s(),Object.assign(e,{scene:null,captured:null,photographShown:!1}))},l=(a,{gltf:o,field:s,error:l})=>{c(),t.put(o.scene,s!==null);let u=l&&rT(l,null),d=$w(a,{gltf:o,field:s,error:l},u?.text??null,t.aspect());s&&n.metresPerUnit!==null&&a.own&&(s.info.metresPerUnit=n.metresPerUnit),Object.assign(e,{scene:d,status:`ready`,mode:d.plane?`plane`:`orbit`}),e.message=u,r.opened();let f=e.beside?.5:null;Object.assign(e.options,{eigen:0,count:1/0,view:`picture`,divider:f}),d.plane?.step(10),i()},u=async t=>{e.arriving=!0,t.addEventListener(`texture`,()=>{document.querySelector(`.poster`)||i()}),t.addEventListener(`limited`,i);let n=n=>{e.scene?.field===t&&(e.message=rT(n,null),i())};t.addEventListener(`error`,({error:e})=>n(e)),await t.complete.catch(n)},d=async r=>{let o=new AbortController;a.push(o);let s=()=>o.signal.aborted,c=()=>a.at(-1)===o;Object.assign(e,{status:`loading`,arriving:!1,message:null}),e.progress={loaded:0,total:r.bytes},i();try{let d=await hw(r.from,{renderer:t.renderer,signal:o.signal,memory:n.memory??void 0,files:r.files,onBytes:(t,n)=>{Lu(document,r.from),c()&&(e.progress={loaded:t,total:n??r.bytes},i())}}),{field:f}=d;if(s()){f?.dispose();return}for(;a[0]!==o;)a.shift()?.abort();if(l(r,d),!f||(await u(f),e.scene?.field!==f))return;e.arriving=!1,i()}catch(t){if(s())return;let n=c();if(a.splice(a.indexOf(o),1),!n)return;let l=e.scene?.field,u=rT(t,r),d=e.scene?X(`cannotOpen`,{name:r.name,reason:u.text}):u.text;e.message={...u,text:d},e.status=e.scene?`ready`:`failed`,e.arriving=l?l.loaded<l.usable:!1,i()}};return t.canvas.addEventListener(`webglcontextlost`,()=>{e.status=`lost`,e.message={text:X(`contextLost`),code:null,detail:null},i()}),t.canvas.addEventListener(`webglcontextrestored`,()=>{let{scene:n,options:r}=e;e.message=null,e.status=n?`ready`:a.length>0?`loading`:`empty`,t.setBackground(r.background);let c=new Promise(e=>s=e);n?.field&&(o=Promise.race([nT(n.field),c])),i()}),{open:e=>o=d(e),done:async()=>{let e=null;for(;e!==o;)e=o,await o}}}function nT(e){return new Promise(t=>{e.addEventListener(`complete`,()=>t()),e.addEventListener(`error`,()=>t())})}function rT(e,t){let n=e instanceof Error?e.message:String(e);if(!(e instanceof ff))return{text:n,code:null,detail:null};let{code:r}=e,i=typeof t?.from==`string`?t.from:``,a=e.cause&&e.where===i?iT(i):null;if(a!==null)return{text:X(`otherSite`,{site:a}),code:r,detail:null};let o=Nl(r,n);return{text:o,code:r,detail:o===n?null:n}}function iT(e){let{origin:t,host:n}=zu(e)??location;return t===location.origin?null:n}var aT=.02,oT=.5,sT=.3;function cT(e,t,n,r){let{changed:i,request:a,touch:o,say:s}=r,c=Promise.resolve(),l=null,u=(e,t)=>{if(l?.first!==e){let n=!!e.field&&!!t.field&&dT(e.field.info,t.field.info);l={first:e,same:n},n||s(X(`camerasDiffer`))}return l.same},d=async r=>{let c={source:r,scene:null};e.beside=c;try{let s=await hw(r.from,{renderer:t.renderer,memory:n.memory??void 0}),{field:l}=s;if(e.beside!==c)return l?.dispose();t.setBeside(s.gltf.scene),c.scene=$w(r,s,null,t.aspect());let u=l?.player;u?.addEventListener(`frame`,o),u&&!Jl()&&u.play(),u?.sound&&(u.sound.muted=!0),l?.addEventListener(`texture`,a),i(),await l?.complete}catch(t){e.beside===c&&s(X(`cannotOpen`,{name:r.name,reason:rT(t,r).text}))}},f=(n,r)=>{let[i,a]=[e.scene,e.beside?.scene];if(!i||!a)return ql;if(i.field&&a.field&&u(i,a))return n.copy(t.camera,!1),new K().copy(i.field.mesh.matrixWorld).invert().premultiply(a.field.mesh.matrixWorld).multiply(t.camera.matrixWorld).decompose(n.position,n.quaternion,new W),n.updateMatrixWorld(!0),r;if(e.mode===`plane`&&i.plane&&a.plane){let{x:e,y:r,zoom:o,dolly:s}=i.plane.at();return a.plane.goTo(e,r,!0),a.plane.setZoom(o),a.plane.setDolly(s),a.plane.step(10),a.plane.place(n,t.aspect())}let o=new W().setFromMatrixPosition(t.camera.matrixWorld),s=new W(0,0,-1).transformDirection(t.camera.matrixWorld);s.multiplyScalar(o.distanceTo(i.around.centre)).add(o);let[c,l]=[i.around,a.around],d=lT(a).multiply(lT(i).transpose());for(let e of[o,s])e.sub(c.centre).multiplyScalar(l.radius/c.radius).applyMatrix4(d).add(l.centre);return a.orbit.set(o,s),a.orbit.place(n,t.aspect())},p=()=>[e.scene?.field?.player,e.beside?.scene?.field?.player],m=()=>{let[e,t]=p();e&&t&&uT(t,e)};return{open:e=>c=d(e),done:()=>c,place:f,close:()=>{e.beside?.scene?.field?.dispose(),e.beside=null,l=null,t.setBeside(null)},keepStep:m,stopped:async()=>{m();let[,e]=p();e?.waiting&&await e.toFrame(e.sought)}}}function lT({field:e,around:t}){let n=e?.info.cameras[e.info.reference];if(!e||!n)return new K;let r=new W(...n.centre).applyMatrix4(e.mesh.matrixWorld).sub(t.centre),i=new W().crossVectors(t.up,r).normalize();return i.lengthSq()===0?new K:new K().makeBasis(i,t.up,new W().crossVectors(i,t.up))}function uT(e,t){e.speed!==t.speed&&(e.speed=t.speed),e.loop!==t.loop&&(e.loop=t.loop),e.playing!==t.playing&&(t.playing?e.play():e.pause());let n=t.sought/t.rate,r=Math.abs(n-e.sought/e.rate),i=t.playing?sT:.5/e.rate;r>i&&r<t.duration-i&&!e.waiting&&n<e.duration&&e.seek(e.first+n)}function dT(e,t){let n=aT*Math.max(...e.viewPlane.extent),r=new Map(e.cameras.map(e=>[e.name,e])),i=t.cameras.flatMap(e=>{let t=r.get(e.name);return t?[[t,e]]:[]});return i.length<oT*Math.min(e.cameras.length,t.cameras.length)?!1:i.every(([e,t])=>Math.hypot(...e.centre.map((e,n)=>e-(t.centre[n]??NaN)))<=n&&e.R.flat().every((e,n)=>Math.abs(e-(t.R.flat()[n]??NaN))<=aT))}var fT=24;function pT(e){let{cameras:t,names:n,grid:r,viewPlane:i}=e,a=t.map((e,t)=>t);if(!r||r.rows<2||t.length<fT){let e=new Intl.Collator(`en`,{numeric:!0});return[{label:null,indices:a.sort((t,r)=>e.compare(n[t]??``,n[r]??``))}]}let o=t.map(({centre:e})=>Aw(e,jw(i.origin,-1))),s=o.map(e=>Mw(e,i.right)),c=o.map(e=>Mw(e,i.up)),l=(e,t)=>e[t]??0,u=a.sort((e,t)=>l(c,t)-l(c,e)),d=u.map((e,t)=>t===0?0:l(c,l(u,t-1))-l(c,e)),f=[...[...d.keys()].sort((e,t)=>l(d,t)-l(d,e)).slice(0,r.rows-1).sort((e,t)=>e-t),u.length];return f.map((e,t)=>({label:X(`row`,{row:t+1,rows:r.rows}),indices:u.slice(t===0?0:f[t-1],e).sort((e,t)=>l(s,e)-l(s,t))}))}function mT(e,t,n,r){let i=null,a=t=>t===null?null:e.scene?.field?.info.names[t]??null,o=t=>{let r=a(t);return r!==null&&e.scene?.source.own===!0&&n.has(r)},s=()=>o(e.captured??t.nearest()),c=n=>{let{scene:i}=e,a=i?.field?.info.cameras[n];if(!i||!a)return;e.captured=n;let{x:s,y:c}=t.dropped(a.centre);i.plane?.goTo(s,c,!0),i.plane?.setDolly(0),i.plane?.setZoom(1),i.plane?.step(10),o(n)||(e.photographShown=!1,e.options.view===`error`&&(e.options.view=`picture`)),r()},l=()=>{let e=t.nearest();e!==null&&c(e)},u=()=>{let{scene:t}=e;return t?.field?(i?.scene!==t&&(i={scene:t,order:pT(t.field.info)}),i.order):[]};return{to:c,nearest:l,nearestName:()=>a(e.captured??t.nearest()),order:u,hasPhotograph:s,leave:()=>{e.photographShown=!1,e.captured=null,e.options.view===`error`&&(e.options.view=`picture`)},next:t=>{if(e.captured===null)return l();let n=u().flatMap(e=>e.indices),r=n[(n.indexOf(e.captured)+t+n.length)%n.length];r!==void 0&&c(r)},showPhotograph:n=>{n&&e.captured===null&&o(t.nearest())&&l(),e.photographShown=n&&e.captured!==null&&s(),e.photographShown&&e.options.view===`error`&&(e.options.view=`picture`),r()},findError:()=>{e.photographShown=!1,e.captured===null&&o(t.nearest())&&l(),s()||(e.options.view=`picture`)},picture:()=>{let t=a(e.captured),r=e.photographShown||e.options.view===`error`;return t!==null&&r&&s()?n.get(t):null}}}var hT=.1,gT=30;function _T(e,t,n,r){let i=null,a=null,o=0,s=!1,c=!1,l=!1,u=[],d=s=>{i=null;let d=a!==null,m=a===null?1/60:Math.min((s-a)/1e3,hT);a===null&&(u.length=0),a=s;let h=e.map(e=>e.step(m)).includes(!0),g=t(),_=n({now:s,moves:h||c||g,follows:d,wanted:h||l});c=l=!1,_&&(o++,u.push(s),u.length>gT&&u.shift()),h?p():g&&f(),i===null&&(a=null,r())},f=()=>{s||(i??=requestAnimationFrame(d))},p=()=>{l=!0,f()};return{request:p,next:f,touch:()=>{c=!0,p()},frames:()=>o,rate:()=>{let[e]=u,t=u[u.length-1];return a===null||u.length<5||e===void 0||t===void 0?null:1e3*(u.length-1)/(t-e)},idle:()=>i===null,pause:()=>{s=!0,i!==null&&cancelAnimationFrame(i),i=null,a=null},resume:()=>{s=!1,p()}}}var vT=40,yT=200,bT=100,xT=3,ST=400,CT=2e4,wT=.5,TT={bilinear:1,bicubic:1.5},ET={scale:1,linear:!1},DT=[ET,...[1,.71,.5,.35,.25].map(e=>({scale:e,linear:!0}))];function OT(e,t,n){let r=[],i=0,a=null,o=[],s=null,c=e=>{let{scale:n,linear:r}=DT[e]??ET;return n*n*TT[r?`bilinear`:t()]},l=()=>Math.max(1,DT.filter(({scale:e})=>e*n()>=wT).length-1),u=e=>{i=e,o=[],a=null},d=e=>{let t=o.reduce((e,t)=>e+t,0);return o.length<xT&&t<ST?null:t/o.length*c(e)/c(i)},f=e=>{let t=i-1,n=r[t],a=i>0&&(n===void 0||e-n>CT)?d(t):null;a!==null&&a<.9*vT&&u(t)},p=(e,t)=>{a!==null&&(t||e-a<bT)&&(o=[...o,e-a].slice(-5)),a=e;let n=d(i);if(n===null||n<=vT||i>=l())return;r[i]=e;let s=i+1;for(;s<l()&&(d(s)??0)>vT;)s++;u(s)};return{waiting:()=>s!==null,frame:(t,n,r)=>n?(s===null&&a===null&&f(t),p(t,r),s!==null&&clearTimeout(s),s=i===0?null:window.setTimeout(()=>{s=null,e()},yT),DT[i]??ET):(a=null,(s===null?ET:DT[i])??ET)}}function kT(e,t,n,r,i){let a=[],o=[],s=[],c=!1,l=!1,u=ET,d=e=>{u=e,i(u);for(let e of o)e()},f=_T(n,r,({now:e,moves:t,follows:n,wanted:r})=>{let i=p.frame(e,t,n);return!r&&i===u?!1:(d(i),!0)},()=>{for(let e of s.splice(0))e();for(let e of o)e()}),p=OT(f.request,()=>e.options.filter,t.ratio),m=()=>{f.next(),c||(c=!0,queueMicrotask(()=>{c=!1;for(let e of a)e()}))},h=()=>{f.request(),m()};return{changed:h,told:m,request:f.request,touch:f.touch,drawn:f.frames,rate:f.rate,detail:()=>u,drawNow:()=>{l||d(ET)},rested:async e=>{do await new Promise(e=>void(s.push(e),f.request()));while(e()||!f.idle()||p.waiting())},suspend:()=>{l=!0,t.setScale(ET.scale),f.pause(),h()},resume:()=>{l=!1,f.resume(),h()},onChange:e=>void a.push(e),onDraw:e=>void o.push(e)}}var AT=new H;function jT(e,t,n,r,i,a){let o=i=>{let{scene:o}=e;if(!o||i===`plane`&&!o.plane||i===e.mode&&e.captured===null)return;let{x:s,y:c}=n.coordinates();i===`orbit`?(e.captured!==null&&n.stand(e.captured),o.orbit.enter(t.camera,AT)):e.mode===`orbit`&&(o.plane?.goTo(s,c,!0),o.plane?.setDolly(0)),r.leave(),e.mode=i,a()};return{setMode:o,moving:()=>{let{scene:t}=e;if(t&&e.captured!==null){let i=e.captured;r.leave(),n.mode()===t.orbit&&t.orbit.enter(n.stand(i),AT),a()}return n.mode()},home:()=>{let{scene:t}=e;if(!t)return;r.leave();let{field:o,plane:s,orbit:c,around:l}=t,u=t.source.own?i:null;if(!o){let e=new W(.35,.25,1).setLength(l.radius/Math.sin(Math.atan(l.tangents.y)));c.set(l.centre.clone().add(e),l.centre)}else if(s){e.mode=`plane`;let{cameras:t,reference:r,viewPlane:i}=o.info,{x:a,y:c}=u??n.dropped(t[r]?.centre??i.origin);s.goTo(a,c),s.setDolly(0),s.setZoom(1)}else{c.enter(n.stand((u&&n.nearestTo(u))??o.info.reference),AT);let{eye:e,target:t}=c.pose();c.set(e,t)}a()},goTo:(t,i)=>{let{scene:o}=e;if(o?.field){if(r.leave(),o.plane)e.mode=`plane`,o.plane.goTo(t,i);else{let e=n.nearestTo({x:t,y:i});e!==null&&r.to(e)}a()}},comeBack:()=>{let{scene:t}=e;if(t?.plane)return o(`plane`);let r=n.nearest();t?.field&&r!==null&&t.orbit.enter(n.stand(r),AT),a()}}}var MT=6;function NT(e,t,n){let r=new Map,i=new Set,a=new Set,s=async(e,s)=>{i.add(e);try{let t=new nt(await createImageBitmap(await PT(s),{colorSpaceConversion:`none`,premultiplyAlpha:`none`}));t.colorSpace=``,t.flipY=!1,t.minFilter=c,t.magFilter=o,t.generateMipmaps=!0,t.needsUpdate=!0,r.set(e,t);for(let[e,t]of r){if(r.size<=MT)break;t.dispose(),r.delete(e)}}catch{a.add(e),n(e)}finally{i.delete(e),t()}};return{has:t=>e.has(t)&&!a.has(t),get:t=>{let n=e.get(t),o=r.get(t);return o||n===void 0||i.has(t)||a.has(t)||s(t,n),o??null},pending:()=>i.size>0,forget:()=>{for(let e of r.values())e.dispose();r.clear()}}}async function PT(e){let t=/^data:[^,]*;base64,(.*)$/s.exec(e)?.[1];if(t!==void 0)return fu(t);let n=await fetch(e);if(!n.ok)throw Error(`${n.status}`);return n.blob()}var FT=.3;function IT(e,t,n,r,i){let a=ql,o=()=>{let e=Math.min(n.beyond()/FT,1);return e*e*(3-2*e)},s=()=>{let r=e.scene?.field,i=e.captured===null?void 0:r?.info.cameras[e.captured];return r&&i?Iv(r,t.camera,i,t.aspect()):n.mode()?.place(t.camera,t.aspect())??ql};return{frame:()=>a,draw:({scale:n,linear:c})=>{t.setScale(n),a=s();let l=r.picture(),{scene:u,options:d}=e,f=e.mode===`plane`&&u?.plane?.at().dolly===0,p=(e,t)=>{e.camera=t,e.exposure=t,e.count=d.count,e.eigen=d.eigen,e.mixing=d.mixing,e.filter=c?`bilinear`:d.filter,e.coarser=n>.7?1:n>.3?2:4,e.photograph=l,e.view=d.view===`error`&&!l?`picture`:d.view,e.weightMode=f||!e.info.facesPlane?`eye`:d.weights};u?.field&&p(u.field,e.captured);let m=e.beside?.scene;if(m?.field){let t=m.field.info.names.indexOf(u?.field?.info.names[e.captured??-1]??``);p(m.field,t<0?null:t)}e.photographShown&&l?t.compare(a,l,d.divider):m&&d.divider!==null?(i.keepStep(),t.split(a,d.divider,e=>i.place(e,a))):t.draw(a===ql?null:a,e.fades?o():0)}}}function LT(e,t){let n=()=>e.scene?.field?.info.cameras??[],r=()=>{let{scene:t}=e;return e.mode===`plane`&&t?.plane?t.plane:t?.orbit??null},i=()=>{let n=e.scene?.field;return n?n.mesh.worldToLocal(new W().setFromMatrixPosition(t.camera.matrixWorld)):null},a=t=>{let n=e.scene?.field?.info.viewPlane;if(!n)return{x:0,y:0};let r=Aw(t,jw(n.origin,-1)),[i,a]=n.extent;return{x:i>0?Mw(r,n.right)/i:0,y:a>0?Mw(r,n.up)/a:0}};return{mode:r,dropped:a,coordinates:()=>{let{scene:t,captured:n}=e;if(n===null&&e.mode===`plane`&&t?.plane){let{x:e,y:n}=t.plane.at();return{x:e,y:n}}let r=i();return r?a([r.x,r.y,r.z]):{x:0,y:0}},nearest:()=>{let e=i();return e&&RT(n().map(({centre:t})=>e.distanceToSquared(new W(...t))))},nearestTo:({x:e,y:t})=>RT(n().map(({centre:n})=>{let r=a(n);return Math.hypot(r.x-e,r.y-t)})),stand:r=>{let i=e.scene?.field,a=n()[r];return i&&a&&Iv(i,t.camera,a,t.aspect()),t.camera},beyond:()=>e.status===`ready`&&e.scene?.field&&e.captured===null?r()?.beyond()??0:0}}function RT(e){return e.length===0?null:e.indexOf(Math.min(...e))}function zT(){return{scene:null,beside:null,status:`empty`,message:null,progress:{loaded:0,total:null},arriving:!1,mode:`plane`,captured:null,photographShown:!1,fades:!1,options:{...ou}}}var BT=24,VT=new q(0),HT=4;function UT(){let e=new at(1,1,{samples:HT,generateMipmaps:!0,minFilter:c,magFilter:o}),t={picture:{value:e.texture},amount:{value:0},coarsest:{value:0},ground:{value:new q}},n=new ji({glslVersion:I,depthTest:!1,depthWrite:!1,uniforms:t,vertexShader:`
      out vec2 at;
      void main() {
        at = uv;
        gl_Position = vec4(position.xy, 0.0, 1.0);
      }`,fragmentShader:`
      uniform sampler2D picture; // R, G, B times coverage, and coverage
      uniform float amount, coarsest;
      uniform vec3 ground;
      in vec2 at;
      out vec4 colour;
      vec4 softly(float level) { // bilinear texels of coarse levels would be seen as squares
        vec2 texel = 0.75 * exp2(level) / vec2(textureSize(picture, 0));
        vec4 sum = vec4(0.0);
        for (int i = 0; i < 4; i++)
          sum += textureLod(picture, at + texel * vec2(i % 2 == 0 ? -1 : 1, i < 2 ? -1 : 1), level);
        return 0.25 * sum;
      }
      void main() {
        vec4 sharp = textureLod(picture, at, 0.0);
        float first = amount * coarsest;
        float last = log2(float(max(textureSize(picture, 0).x, textureSize(picture, 0).y)));
        vec4 sum = first < 0.1 ? sharp : softly(first);
        for (float level = floor(first) + 1.0; level <= last && sum.a < 0.996; level++)
          sum += (1.0 - sum.a) * softly(level);
        vec3 blurred = sum.a > 0.0 ? sum.rgb / sum.a : ground;
        colour = vec4(mix(sharp.rgb + (1.0 - sharp.a) * ground, blurred, min(4.0 * amount, 1.0)), 1.0);
      }`}),r=new _r(new Si(2,2),n);r.frustumCulled=!1;let i=new Ut().add(r),a=new H;return{draw:(n,r,o,s)=>{n.getDrawingBufferSize(a),e.setSize(a.x,a.y),t.amount.value=s,t.coarsest.value=Math.max(Math.log2(Math.min(a.x,a.y)/BT),0),n.getClearColor(t.ground.value),n.setClearColor(VT,0),n.setRenderTarget(e),n.clear(),n.render(r,o),n.setRenderTarget(null),n.setClearColor(t.ground.value,1),n.render(i,o)}}}var WT=2;function GT(e){let t=new Sl({canvas:e,antialias:!0,powerPreference:`high-performance`});t.autoClear=!1,t.outputColorSpace=N;let n=new Ut,r=new Ft,i=new Ft;i.add(new ba(16777215,5264218,2.2));let a=new za(16777215,1.6);a.position.set(.5,1,.8),i.add(a);let o=new Ft;o.visible=!1,n.add(r,o,i);let s=new Ma,c=new Ma,l=qT(),u=UT(),d={colour:`#000000`,coded:!0},f={width:1,height:1},p=()=>Math.min(devicePixelRatio,WT),m=1,h=(e,n)=>{if(e){let{left:n,top:r,width:i,height:a}=e;t.setScissor(n*f.width,(1-r-a)*f.height,i*f.width,a*f.height)}t.setScissorTest(e!==null),n(),t.setScissorTest(!1)},g=()=>{let e=d.coded?N:M;t.setClearColor(new q().setStyle(d.colour,e),1)};return{canvas:e,renderer:t,camera:s,root:r,put:(e,n)=>{r.add(e),i.visible=!n,d.coded=n,t.outputColorSpace=n?N:M,g()},clear:()=>{for(let e of[...r.children])JT(e);r.clear()},setBackground:e=>{d.colour=e,g()},draw:(e,r)=>{t.clear(),r>0?u.draw(t,n,s,r):h(e,()=>t.render(n,s))},compare:(e,r,i)=>{t.clear();let a=i??0;a>0&&h(e,()=>t.render(n,s));let o={...e,left:e.left+a*e.width,width:(1-a)*e.width};h(o,()=>l.draw(t,r,e))},setBeside:e=>{for(let e of[...o.children])JT(e);o.clear(),e&&o.add(e)},split:(e,i,a)=>{t.clear();let l=e.left+i*e.width,u=KT(e,0,l);u.width>0&&h(u,()=>t.render(n,s));let d=KT(a(c),l,1);[r.visible,o.visible]=[!1,!0],d.width>0&&h(d,()=>t.render(n,c)),[r.visible,o.visible]=[!0,!1]},resize:(e,n)=>{Object.assign(f,{width:Math.max(e,1),height:Math.max(n,1)}),t.setPixelRatio(p()*m),t.setSize(f.width,f.height,!1)},ratio:p,setScale:e=>{e!==m&&(m=e,t.setPixelRatio(p()*m))},aspect:()=>f.width/f.height,pixels:()=>{let e=t.getContext(),{drawingBufferWidth:n,drawingBufferHeight:r}=e,i=new Uint8Array(4*n*r);e.readPixels(0,0,n,r,e.RGBA,e.UNSIGNED_BYTE,i);let a=new Uint8Array(i.length);for(let e=0;e<r;e++)a.set(i.subarray(4*n*(r-1-e),4*n*(r-e)),4*n*e);return{width:n,height:r,data:a}}}}function KT(e,t,n){let r=Math.max(e.left,t);return{...e,left:r,width:Math.max(Math.min(e.left+e.width,n)-r,0)}}function qT(){let e=new ji({glslVersion:I,depthTest:!1,depthWrite:!1,uniforms:{picture:{value:null},corners:{value:new rt}},vertexShader:`
      uniform vec4 corners;
      out vec2 at;
      void main() {
        at = vec2(uv.x, 1.0 - uv.y);
        gl_Position = vec4(mix(corners.xy, corners.zw, uv), 0.0, 1.0);
      }`,fragmentShader:`
      uniform sampler2D picture;
      in vec2 at;
      out vec4 colour;
      void main() { colour = vec4(texture(picture, at).rgb, 1.0); }`}),t=new _r(new Si(2,2),e);t.frustumCulled=!1;let n=new Ut().add(t),r=new Ma;return{draw:(t,i,{left:a,top:o,width:s,height:c})=>{e.uniforms.picture={value:i};let[l,u]=[a+s,o+c];e.uniforms.corners={value:new rt(2*a-1,1-2*u,2*l-1,1-2*o)},t.render(n,r)}}}function JT(e){e.traverse(e=>{if(e instanceof _r){e.geometry.dispose();for(let t of[e.material].flat()){for(let e of Object.values(t))typeof e==`object`&&e&&`isTexture`in e&&e.dispose();t.dispose()}}})}var YT=9,XT=.1,ZT=.03;function QT(e,t,n,r,i){let a=t,o=!t,s=0,c=null,l=()=>{let e=2*Math.PI*s/YT;return[XT*Math.sin(e),ZT*Math.sin(2*e)]},u=()=>{!o&&s>0&&r(),o=!0};return{untouched:()=>a,step:t=>{let{scene:r}=e;if(o||!r?.field||e.status!==`ready`||e.arriving||(c??=r,c!==r||Jl()?o=!0:(i()||s>=63)&&u(),o))return!1;let[a,d]=l();s+=t;let[f,p]=l();return n()?.drag(a-f,p-d,!1),!0},stop:()=>void(o=!0),settle:u,end:()=>{o=!0,a=!1}}}function $T(){let e=new ar({color:16777215,wireframe:!0,transparent:!0,opacity:.22,depthWrite:!1}),t=[];return n=>{for(let e of t)e.removeFromParent();e.dispose();let r=[];n?.traverse(e=>{e instanceof _r&&e.name!==`sheets`&&r.push(e)}),t=r.map(t=>new _r(t.geometry,e)),t.forEach((e,t)=>r[t]?.add(e))}}function eE(e,t,n){let r=zT(),{options:i}=r,a=GT(e),o=[{step:n}],s=kT(r,a,o,()=>[r.scene,r.beside?.scene].map(e=>e?.field?.player).some(e=>e?.playing||e?.waiting),e=>_.draw(e)),{changed:c}=s,l=e=>{r.message={text:e,code:null,detail:null},c()},u=NT(t.photographs,c,e=>{r.photographShown=!1,l(X(`photographLost`,{name:e}))}),d=LT(r,a),f=mT(r,d,u,c),p=jT(r,a,d,f,t.start,c),m=QT(r,t.ownView,d.mode,p.home,()=>s.detail().scale<1);o.push(m,{step:e=>r.captured===null&&d.mode()?.step(e)===!0});let h=e=>(...t)=>(m.end(),e(...t)),g=cT(r,a,t,{...s,say:l}),_=IT(r,a,d,f,g),v=$T(),y=()=>{let{scene:e}=r;v(i.wireframe&&e?e.field?.mesh??e.gltf.scene:null)},b=gd(r,s.touch,s.told),x=tT(r,a,t,{changed:c,opened:()=>{r.scene?.source.own!==!0&&g.close(),p.home(),y(),b.opened()},closing:()=>{v(null),u.forget()}});a.setBackground(i.background);let S=e=>{Object.assign(i,e);let t=r.scene?.field;t&&(i.eigen=Math.min(Math.max(Math.round(i.eigen),0),Math.max(t.total-1,0)),i.count>=t.total&&(i.count=1/0),i.count=Math.max(Math.round(i.count),0)),e.background!==void 0&&a.setBackground(i.background),e.wireframe!==void 0&&y(),e.divider!=null&&(i.divider=Zl(e.divider,0,1),r.beside||f.showPhotograph(!0)),i.view===`error`&&f.findError(),c()},C=async()=>{await x.done(),await g.done(),m.settle(),await b.stopped(),await g.stopped(),await s.rested(u.pending)};return{...s,stage:a,config:t,set:h(S),say:l,settled:C,scene:()=>r.scene,beside:()=>r.beside,status:()=>r.status,message:()=>r.message,dismiss:()=>{r.message=null,c()},arriving:()=>r.arriving,summed:()=>{let e=r.scene?.field;return e?Math.min(i.count,e.total,e.usable,e.loaded):0},progress:()=>r.progress,options:()=>i,modeName:()=>r.mode,setMode:h(p.setMode),captured:()=>r.captured,toCamera:h(f.to),nextCamera:h(f.next),nearestCamera:h(f.nearest),nearestName:f.nearestName,cameraOrder:f.order,coordinates:d.coordinates,goTo:h((e,t)=>{p.goTo(e,t),s.touch()}),home:h(p.home),comeBack:h(p.comeBack),outside:()=>d.beyond()>0,setFading:e=>{r.fades=e,c()},hasPhotograph:f.hasPhotograph,photographShown:()=>r.photographShown,showPhotograph:h(f.showPhotograph),divide:h(()=>{let e=(r.beside!==null||r.photographShown)&&i.divider!==null;S({divider:e?null:.5})}),untouched:m.untouched,hold:m.stop,player:b.player,playOrPause:h(b.playOrPause),toFrame:h(b.toFrame),scrub:h(b.scrub),letGo:b.letGo,skip:h(b.skip),step:h(b.step),changeSpeed:b.changeSpeed,setLoop:b.setLoop,mute:b.mute,moving:h(()=>(s.touch(),p.moving())),frame:_.frame,open:x.open,openBeside:g.open,suspend:()=>{m.end(),f.leave(),s.suspend()}}}var tE=.25,nE=.6,rE=.15,iE=.03,[aE,oE,sE]=[0,1,4];function cE(e,t){let{renderer:n,camera:r,root:i}=e.stage,a=Wl(X(`enterVr`),Kl.headset,()=>void _());a.hidden=!0,n.xr.setReferenceSpaceType(`local`);let o=null,s={x:0,y:0},c=null,l=new Set,u=0,d=async()=>{let t=await navigator.xr?.isSessionSupported(`immersive-vr`).catch(()=>!1);a.hidden=t!==!0||!e.scene()?.field};navigator.xr?.addEventListener(`devicechange`,()=>void d()),e.onChange(()=>void d());let f=()=>{let t=e.scene()?.field?.info;if(!t)return 1;let n=Math.max(...t.viewPlane.extent);return t.metresPerUnit??(n>0?tE/n:1)},p=t=>{let n=e.scene()?.field;if(!n)return new K;let{viewPlane:r,cameras:a,reference:o,facesPlane:s}=n.info,c=new K().copy(i.matrixWorld).invert().multiply(n.mesh.matrixWorld),l=a[o],u=new W(...s||!l?r.origin:l.centre).applyMatrix4(c),d=new W(0,0,-1);!s&&l&&d.set(...lE(l.R[2])).transformDirection(c);let{x:p,y:m,z:h,w:g}=t.orientation,_=new W(0,0,-1).applyQuaternion(new U(p,m,h,g)),v=Math.atan2(-_.x,-_.z)-Math.atan2(-d.x,-d.z),y=t.position;return new K().makeTranslation(y.x,y.y,y.z).multiply(new K().makeRotationY(v)).multiply(new K().makeScale(f(),f(),f())).multiply(new K().makeTranslation(-u.x,-u.y,-u.z))},m=t=>{let n=!1,r=new Set;for(let{handedness:i,gamepad:a}of o?.inputSources??[]){let o=a?.axes??[],c=e=>{let t=o[e]??0;return Math.abs(t)<rE?0:t};s.x+=c(2)*nE*t,s.y-=c(3)*nE*t,n||=a?.buttons[sE]?.pressed===!0;let u=e=>{let t=`${i} ${e}`;return a?.buttons[e]?.pressed===!0&&r.add(t),r.has(t)&&!l.has(t)};u(aE)&&e.playOrPause(),u(oE)&&e.skip(i===`left`?-1:1)}l=r,s.x=Math.min(Math.max(s.x,-1),1),s.y=Math.min(Math.max(s.y,-1),1),n&&(Object.assign(s,{x:0,y:0}),c=null)},h=(t,a)=>{let o=e.scene()?.field,l=n.xr.getReferenceSpace(),d=a&&l?a.getViewerPose(l):void 0;if(!o||!d)return;o.player?.update(t),m(Math.min((t-u)/1e3,.1)),u=t,c??=p(d.transform);let{right:f,up:h,extent:g}=o.info.viewPlane,_=new W(...Aw(jw(f,s.x*g[0]),jw(h,s.y*g[1]))).applyQuaternion(o.mesh.getWorldQuaternion(new U)),v=new W().setFromMatrixScale(c).x;_.applyQuaternion(i.getWorldQuaternion(new U).invert()),i.matrixAutoUpdate=!1,i.matrix.copy(c).multiply(new K().makeTranslation(_.multiplyScalar(-1))),i.updateMatrixWorld(!0),r.near=iE,r.far=Math.max(100,4*v*Zw(o.mesh).radius),o.camera=null,o.exposure=null,o.photograph=null,o.view===`error`&&(o.view=`picture`),o.filter=`bilinear`,o.coarser=1,o.weightMode=o.info.facesPlane?e.options().weights:`eye`,e.stage.draw(null,0)},g=()=>{o=null,n.setAnimationLoop(null),n.xr.enabled=!1,i.matrixAutoUpdate=!0,i.matrix.identity(),i.matrix.decompose(i.position,i.quaternion,i.scale),i.updateMatrixWorld(!0),t(!1),e.resume()},_=async()=>{if(o){await o.end();return}if(!navigator.xr||!e.scene()?.field)return;let r=null;try{r=o=await navigator.xr.requestSession(`immersive-vr`),e.suspend(),c=null,Object.assign(s,{x:0,y:0}),n.xr.enabled=!0,n.setAnimationLoop(h),await n.xr.setSession(r),t(!0)}catch(t){await r?.end().catch(()=>void 0),e.say(X(`vrRefused`,{reason:t instanceof Error?t.message:String(t)}))}};return n.xr.addEventListener(`sessionend`,g),{root:a,presenting:()=>o!==null,enter:_}}var lE=e=>[e?.[0]??0,e?.[1]??0,e?.[2]??-1],uE=`(max-width: 720px), (max-height: 500px)`,dE=500;function fE(){document.querySelector(`.unscripted`)?.remove(),document.documentElement.lang=jl;let e=new URL(location.href),t=lu(document,e);document.body.dataset.ui=t.ui,Ru([t.scene,e.searchParams.get(`load`),t.poster])||Lu(document);let n=e=>{document.title=t.ui===`full`?`${e} – eigenfield`:e};t.title!==null&&n(t.title);let r=Z(`canvas`,{class:`view`,tabindex:`0`,role:`application`,"aria-label":X(`canvas`)}),i=Z(`main`,{class:`stage`},r),a=null,o=null,s=e=>{let t=[a?.wish(),o?.wish()].filter(e=>e!=null);for(let n of t)c.moving()?.push(n,e);return t.length>0},c;try{c=eE(r,t,s)}catch{let e=Z(`div`,{class:`message small`,role:`alert`},Z(`p`,{},X(`noWebgl`))),n=Z(`p`,{class:`title`},Z(`span`,{},t.title??``)),r=tf(document,t.poster);document.body.append(Z(`main`,{class:`stage`},...r?[r]:[],n,e));return}let l=sd(e=>void c.open(e),e=>u.hover(e)),u=Bd(c,l.choose),d=Qd(c),f=nu(c),p=Vu(c),m=Nu(c),h=$d(c),g=md(t.version),_=cE(c,e=>{ee(),e||F()}),v=$u(c,_.presenting),y=Id(c,()=>ee()),b=e=>{d.root.hidden=!e,x.setAttribute(`aria-expanded`,String(e))},x=Wl(X(`panel`),Kl.panel,()=>b(d.root.hidden!==!1),`I`);x.setAttribute(`aria-controls`,`panel`);let S=Wl(X(`orbit`),Kl.orbit,()=>c.setMode(c.modeName()===`plane`?`orbit`:`plane`),`O`),C=Wl(X(`tilt`),Kl.tilt,()=>void y.toggle()),w=Ld(),T=t.ui,E=Wl(X(`laboratory`),Kl.info,()=>N(T===`full`?`plain`:`full`)),D=Wl(X(`savePicture`),Kl.camera,()=>nf(c),`P`),O=cf(c),k=Wl(X(`firstView`),Kl.home,c.home,X(`keyHome`)),A=Wl(X(`download`),Kl.download,()=>{let e=c.scene()?.source;e&&Uu(e)}),j=[k,O.link,O.embed,A,w,_.root,E];for(let e of j)e.classList.add(`plain`);let M=Z(`div`,{class:`tools`,role:`toolbar`,"aria-label":X(`tools`)},k,S,C,D,O.link,O.embed,A,Wl(X(`openFile`),Kl.open,l.choose),Wl(X(`controls`),Kl.help,g.toggle,`H`),w,_.root,x,E),N=e=>{T=e,document.body.dataset.ui=T,c.setFading(T!==`full`),r.setAttribute(`aria-label`,X(T===`full`?`canvas`:`canvasPlain`)),E.setAttribute(`aria-pressed`,String(T===`full`)),b(T===`full`&&!matchMedia(uE).matches)},P=tf(document,t.poster);i.append(...P?[P]:[],p.root,...m.roots,...u.roots,v,O.said,f.root,h.root,M),document.body.append(i,d.root,g.root,l.root);let ee=()=>{document.body.dataset.status=c.status(),d.update(),u.update(),m.update(),f.update(),h.update(),S.setAttribute(`aria-pressed`,String(c.modeName()===`orbit`)),S.hidden=!c.scene()?.plane,C.hidden=!y.possible||!c.scene()?.plane,C.setAttribute(`aria-pressed`,String(y.on()));for(let e of[k,D,x])e.hidden=c.scene()===null;E.hidden=!t.laboratory||c.status()===`empty`;let{source:e,field:r}=c.scene()??{};O.link.hidden=!O.possible||!e||e.from!==ne?.from,O.embed.hidden=O.link.hidden,A.hidden=!t.download||e?.own!==!0||r?.info.inFiles===!0;let i=c.scene()?.source.name;i!==void 0&&n(i)};c.onChange(ee),c.onDraw(()=>{u.tick(),p.tick(),h.tick(),f.update(),d.tick(),c.scene()===null||c.arriving()&&c.untouched()||P?.remove()}),Pd(c),a=Ad(c,{plain:()=>T!==`full`,help:g.toggle,divide:c.divide,panel:()=>b(d.root.hidden!==!1),screenshot:()=>nf(c)}),o=Ed(c),qu(c),N(T);let te=devicePixelRatio,F=()=>{_.presenting()||(te=devicePixelRatio,c.stage.resize(i.clientWidth,i.clientHeight),c.drawNow(),c.request())};new ResizeObserver(F).observe(i),setInterval(()=>{devicePixelRatio!==te&&F()},dE),window.eigenfield=Hl(c),c.stage.resize(i.clientWidth,i.clientHeight);let ne=td(t,document,e);ee();let I=ne&&c.open(ne),re=ne?.own?nd(t,document):null;re&&c.openBeside(re),t.worker!==null&&zd(t.worker,I?.then(()=>c.scene()?.source.from))}var pE=ef(document);pE?pE.then(fE):fE();