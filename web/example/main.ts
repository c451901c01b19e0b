// A plain three.js page. Three lines are eigenfield's; everything else any page with GLTFLoader has.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { EigenfieldPlugin, refuseAddresses, type EigenField } from "eigenfield-three"; // 1

const renderer = new THREE.WebGLRenderer({ antialias: true });
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera();
const controls = new OrbitControls(camera, renderer.domElement);

const loader = new GLTFLoader();
loader.register((parser) => new EigenfieldPlugin(parser)); // 2
loader.register(refuseAddresses); // for files of strangers: nothing but the scene is fetched
const gltf = await loader.loadAsync(new URLSearchParams(location.search).get("scene") ?? "scene.glb");
scene.add(gltf.scene);
const field = gltf.userData["eigenfield"] as EigenField | undefined; // 3, to know when there is more to draw

// The camera that the file brings: it stands in the middle of the captured array.
const start = gltf.cameras[0];
if (start instanceof THREE.PerspectiveCamera) {
  camera.copy(start);
  start.getWorldPosition(camera.position);
  start.getWorldQuaternion(camera.quaternion);
}
const middle = new THREE.Box3().setFromObject(gltf.scene).getCenter(new THREE.Vector3());
const ahead = camera.getWorldDirection(new THREE.Vector3());
controls.target.copy(camera.position).addScaledVector(ahead, middle.sub(camera.position).dot(ahead));

function draw(): void {
  renderer.render(scene, camera);
}

function resize(): void {
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
  renderer.setPixelRatio(devicePixelRatio);
  renderer.setSize(innerWidth, innerHeight);
  draw();
}

addEventListener("resize", resize);
controls.addEventListener("change", draw);
field?.addEventListener("texture", draw);
field?.addEventListener("complete", draw);
controls.update();
resize();
