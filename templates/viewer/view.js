// The camera of the page. Its pose has the terms of `corcast render`, in either projection: degrees to the right about
// the vertical axis and then up (--turn), the point in the middle of the picture (--look-at), and the height of the
// picture at this point in mm (--height).
import { OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const ANGLE = 26; // vertical angle of view of a perspective picture, degrees
const MARGIN = 0.05; // fraction of the window that is left free on each side of the whole tree
const STEEPEST = 89.9;
const GLIDE = 300; // duration of a movement to another target, ms
const radians = (degrees) => (degrees * Math.PI) / 180;
const degrees = (radian) => (radian * 180) / Math.PI;

export const VIEWS = {
  Front: [0, 0], Right: [90, 0], Back: [180, 0], Left: [-90, 0], Top: [0, STEEPEST], Bottom: [0, -STEEPEST],
  Oblique: [45, degrees(Math.atan(Math.SQRT1_2))],
};

function towardsEye(turn, rise) {
  const level = Math.cos(radians(rise));
  return new Vector3(level * Math.sin(radians(turn)), Math.sin(radians(rise)), level * Math.cos(radians(turn)));
}

export class View {
  constructor(canvas, tree, changed) {
    this.canvas = canvas;
    this.changed = changed;
    this.setTree(tree);
    this.perspective = new PerspectiveCamera(ANGLE, 1, 0.1, 10);
    this.orthographic = new OrthographicCamera(-0.5, 0.5, 0.5, -0.5, 0, 10);
    this.camera = this.perspective;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.minPolarAngle = radians(90 - STEEPEST);
    this.controls.maxPolarAngle = radians(90 + STEEPEST);
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", () => { this.goal = null; });
    const still = matchMedia("(prefers-reduced-motion: reduce)");
    const settle = () => { this.controls.enableDamping = !still.matches; };
    still.addEventListener("change", settle);
    settle();
  }

  setTree(tree) {
    this.tree = tree;
    this.half = tree.half;
  }

  get isOrthographic() { return this.camera === this.orthographic; }

  get pose() {
    const away = this.camera.position.clone().sub(this.controls.target), distance = away.length();
    return {
      turn: degrees(Math.atan2(away.x, away.z)),
      rise: degrees(Math.asin(Math.min(1, Math.max(-1, away.y / distance)))),
      target: this.controls.target.toArray(),
      height: this.isOrthographic ? 1 / this.orthographic.zoom : 2 * distance * Math.tan(radians(ANGLE / 2)),
    };
  }

  set pose({ turn, rise, target, height }) {
    const distance = this.isOrthographic ? 8 * this.half : height / (2 * Math.tan(radians(ANGLE / 2)));
    const steep = Math.min(STEEPEST, Math.max(-STEEPEST, rise));
    this.controls.target.fromArray(target);
    this.camera.position.copy(towardsEye(turn, steep)).multiplyScalar(distance).add(this.controls.target);
    this.camera.zoom = this.isOrthographic ? 1 / height : 1;
    this.camera.lookAt(this.controls.target);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.changed();
  }

  get eye() { return this.camera.position.toArray(); }

  // The horizontal angle of view of a perspective picture, degrees.
  get angleAcross() { return 2 * degrees(Math.atan(Math.tan(radians(ANGLE / 2)) * this.perspective.aspect)); }

  change(what) { this.pose = { ...this.pose, ...what }; }

  project(orthographic) {
    if (orthographic === this.isOrthographic) return;
    const { pose } = this;
    this.camera = orthographic ? this.orthographic : this.perspective;
    this.controls.object = this.camera;
    this.pose = pose;
  }

  // Moves the camera within GLIDE so that a point comes to the middle; at once if the user wants no motion.
  center(point) {
    const duration = this.controls.enableDamping ? GLIDE : 0;
    this.goal = { from: this.controls.target.clone(), to: new Vector3(...point), end: performance.now() + duration };
    this.changed();
  }

  glide() {
    const { from, to, end } = this.goal, time = 1 - Math.max(0, end - performance.now()) / GLIDE;
    if (time === 1) this.goal = null;
    this.change({ target: from.clone().lerp(to, time * time * (3 - 2 * time)).toArray() });
  }

  // Returns the position of a point in the window, in CSS pixels.
  onScreen(point) {
    const { x, y } = new Vector3(...point).project(this.camera), box = this.canvas.getBoundingClientRect();
    return [box.left + (0.5 + x / 2) * box.width, box.top + (0.5 - y / 2) * box.height];
  }

  // Shows the whole tree from a direction.
  frame(turn, rise) {
    const back = towardsEye(turn, rise), right = new Vector3(0, 1, 0).cross(back).normalize();
    const up = back.clone().cross(right);
    const { position, radius, segments, parent } = this.tree;
    const axes = [right, up, back], low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const at = new Vector3();
    for (const i of segments)
      for (const node of [i, parent[i]]) {
        at.fromArray(position, 3 * node);
        axes.forEach((axis, k) => {
          const along = at.dot(axis);
          low[k] = Math.min(low[k], along - radius[i]);
          high[k] = Math.max(high[k], along + radius[i]);
        });
      }
    const target = new Vector3();
    axes.forEach((axis, k) => target.addScaledVector(axis, (low[k] + high[k]) / 2));
    const { free } = this, all = this.orthographic.view.fullHeight / (1 - 2 * MARGIN);
    const span = all * Math.max((high[1] - low[1]) / free.height, (high[0] - low[0]) / free.width);
    // In perspective, nearer vessels are larger and need more room.
    const height = this.isOrthographic ? span : span + (high[2] - low[2]) * Math.tan(radians(ANGLE / 2));
    this.pose = { turn, rise, target: target.toArray(), height };
  }

  // Sets the size of the window, and the part of it that the panels leave free, in CSS pixels.
  resize(width, height, free) {
    this.free = free;
    this.perspective.aspect = width / height;
    this.orthographic.left = -width / height / 2;
    this.orthographic.right = width / height / 2;
    const right = free.left + free.width / 2 - width / 2, down = free.top + free.height / 2 - height / 2;
    for (const camera of [this.perspective, this.orthographic])
      camera.setViewOffset(width, height, -right, -down, width, height);
  }

  // To be called before each picture: continues a movement, and sets the depth range to hold the whole tree.
  step() {
    if (this.goal) this.glide();
    this.controls.update();
    const { camera } = this, away = camera.position.length();
    const near = this.isOrthographic ? 0 : Math.max(away - 1.1 * this.half, this.pose.height / 200);
    camera.near = near;
    camera.far = Math.max(away, 0) + 1.1 * this.half + near;
    camera.updateProjectionMatrix();
  }

  // Returns the ray through a point of the canvas, given in CSS pixels, and the width of a pixel on it: `least` mm plus
  // `slack` mm per mm along the ray.
  ray(x, y) {
    const box = this.canvas.getBoundingClientRect();
    const point = [((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2];
    const from = new Vector3(...point, -1).unproject(this.camera);
    const along = new Vector3(...point, 1).unproject(this.camera).sub(from).normalize();
    if (this.isOrthographic) return { from, along, least: this.pose.height / box.height, slack: 0 };
    return { from, along, least: 0, slack: (2 * Math.tan(radians(ANGLE / 2))) / box.height };
  }
}
