// The plate in space, slightly from above, as a seated person sees it.

import * as THREE from "./three.module.js";
import { pixelRatio, themeColor } from "./dom.js";
import { shapeOf } from "./scene_shape.js";

const elevation = (36 * Math.PI) / 180;
const towardsEye = new THREE.Vector3(0, -Math.cos(elevation), Math.sin(elevation));
const margin = 0.94;

const flat = (color, more = {}) => new THREE.MeshBasicMaterial({ color: themeColor(color), ...more });
const shaded = (color, more = {}) => new THREE.MeshLambertMaterial({ color: themeColor(color), ...more });

function plateGeometry(scene, shape) {
  if (scene.kind === "surface") {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(scene.points_m), 3));
    geometry.setIndex(scene.triangles);
    geometry.computeVertexNormals();
    return geometry;
  }
  const geometry = new THREE.BoxBufferGeometry(...scene.size_m);
  geometry.translate(0, 0, (shape.low[2] + shape.high[2]) / 2);
  return geometry;
}

function plate(scene, shape) {
  const geometry = plateGeometry(scene, shape);
  const group = new THREE.Group();
  group.add(new THREE.Mesh(geometry, shaded("--plate", {
    side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
  })));
  const edges = new THREE.EdgesGeometry(geometry, 40);
  group.add(new THREE.LineSegments(edges, new THREE.LineBasicMaterial({ color: themeColor("--plate-edge") })));
  return group;
}

// Drawn on the surface: never hidden by its unevenness.
function onSurface(geometry, material, [x, y, z], order) {
  material.depthTest = false;
  const mesh = new THREE.Mesh(geometry, material);
  mesh.position.set(x, y, z);
  mesh.renderOrder = order;
  return mesh;
}

const fixationGeometry = ({ radius, width, depth }) => (radius === undefined
  ? new THREE.PlaneBufferGeometry(width, depth)
  : new THREE.CircleBufferGeometry(radius, 32));

function marks(shape) {
  const group = new THREE.Group();
  for (const fixation of shape.fixations) {
    const { x, y, z } = fixation;
    group.add(onSurface(fixationGeometry(fixation), flat("--fixation"), [x, y, z], 1));
  }
  const outer = 0.028 * shape.extent;
  for (const point of shape.points) {
    group.add(onSurface(new THREE.RingBufferGeometry(0.72 * outer, outer, 40), flat("--ring"), point, 2));
  }
  return group;
}

// All of it is transparent to three.js, which draws what is transparent last, whatever its order:
// the shadow would cover the ball.
class Pointer {
  constructor(extent) {
    const radius = 0.018 * extent;
    this.group = new THREE.Group();
    this.extent = extent;
    this.shadow = onSurface(new THREE.CircleBufferGeometry(radius, 32), flat("--shadow", { transparent: true }), [0, 0, 0], 3);
    const rod = new THREE.CylinderBufferGeometry(0.003 * extent, 0.003 * extent, 1, 12);
    rod.rotateX(Math.PI / 2);
    this.guide = onSurface(rod, flat("--pointer", { transparent: true }), [0, 0, 0], 4);
    this.ball = new THREE.Mesh(new THREE.SphereBufferGeometry(radius, 32, 24), shaded("--pointer", { depthTest: false, transparent: true }));
    this.ball.renderOrder = 5;
    this.group.add(this.shadow, this.guide, this.ball);
  }

  place([x, y, z], isTouching, surface, top) {
    const foot = surface ?? top;
    const height = Math.max(z - foot, 0) / this.extent;
    this.ball.position.set(x, y, z);
    this.ball.material.color.set(themeColor(isTouching ? "--pointer-touching" : "--pointer"));
    this.guide.visible = z > foot;
    this.guide.position.set(x, y, (z + foot) / 2);
    this.guide.scale.z = Math.max(z - foot, 1e-6);
    this.shadow.visible = surface !== null;
    this.shadow.position.set(x, y, foot);
    this.shadow.scale.setScalar(1 + 4 * height);
    this.shadow.material.opacity = 0.75 / (1 + 8 * height);
  }
}

// As many as a processor paints in time where there is no graphics card: with more, the page's signs
// of life would be late, and the session paused.
const maxPixels = 2e6;

export class SpacePainter {
  constructor(frame, whenLost) {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.01, 10);
    this.camera.up.set(0, 0, 1);
    const canvas = this.renderer.domElement;
    canvas.setAttribute("aria-hidden", "true");
    canvas.addEventListener("webglcontextlost", () => whenLost());
    frame.replaceChildren(canvas);
  }

  setScene(scene) {
    this.#forgetWorld();
    this.shape = shapeOf(scene);
    this.pointer = new Pointer(this.shape.extent);
    this.world = new THREE.Scene();
    const sun = new THREE.DirectionalLight(0xffffff, 0.35);
    sun.position.set(-0.4, -0.5, 1);
    const sky = new THREE.HemisphereLight(0xffffff, 0xdddddd, 0.7);
    sky.position.set(0, 0, 1);
    this.world.add(sky, sun, plate(scene, this.shape), marks(this.shape), this.pointer.group);
  }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(pixelRatio(), Math.sqrt(maxPixels / (width * height))));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.#fit();
  }

  draw(hand) {
    this.pointer.group.visible = hand !== null;
    if (hand) {
      const [x, y] = hand.p;
      this.pointer.place(hand.p, hand.isTouching, this.shape.heightAt(x, y), this.shape.high[2]);
    }
    this.renderer.render(this.world, this.camera);
  }

  // The graphics card keeps what is not given back.
  #forgetWorld() {
    this.world?.traverse((part) => {
      part.geometry?.dispose();
      part.material?.dispose();
    });
  }

  // The nearest place from which the plate and the room above it are seen whole.
  #fit() {
    const { low, high, headroom, extent } = this.shape;
    const top = high[2] + headroom;
    const corners = [low[0], high[0]].flatMap((x) => [low[1], high[1]].flatMap((y) =>
      [new THREE.Vector3(x, y, low[2]), new THREE.Vector3(x, y, top)]));
    const middle = new THREE.Vector3((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, high[2] + headroom / 4);
    let [near, far] = [0.5 * extent, 40 * extent];
    for (let halving = 0; halving < 24; halving += 1) {
      const distance = (near + far) / 2;
      this.#lookFrom(middle, distance);
      const isWhole = corners.every((corner) => {
        const seen = corner.clone().project(this.camera);
        return Math.abs(seen.x) < margin && Math.abs(seen.y) < margin && seen.z < 1;
      });
      if (isWhole) far = distance;
      else near = distance;
    }
    this.#lookFrom(middle, far);
  }

  #lookFrom(middle, distance) {
    this.camera.position.copy(middle).addScaledVector(towardsEye, distance);
    this.camera.near = distance / 50;
    this.camera.far = distance * 10;
    this.camera.lookAt(middle);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }
}
