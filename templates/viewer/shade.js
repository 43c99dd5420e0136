// Computes the ambient occlusion of the vessels' surface, once, on the graphics card.
//
// The tree is drawn as shadow maps from directions all around. Each segment has 8 texels around its axis and 4 along
// it. A texel adds up the light of the directions from which it is visible, weighted by their cosines. The result does
// not depend on the view, so turning the tree costs nothing. The mean over many directions hides that a single shadow
// map is coarse.
import {
  Color, CustomBlending, DataTexture, DepthTexture, FloatType, GLSL3, HalfFloatType, Mesh, NearestFilter, OneFactor,
  OrthographicCamera, PlaneGeometry, RawShaderMaterial, RGBAFormat, Scene, UnsignedIntType, Vector3, WebGLRenderTarget,
} from "three";
import fragmentShader from "./shade.frag.glsl";

export const AROUND = 8, ALONG = 4, WIDTH = 2048;
const DIRECTIONS = 64, MAP = 1024; // number of shadow maps, and their side in texels

// Returns direction k: the directions divide the sphere evenly, and consecutive ones are far apart.
function direction(k) {
  const z = 1 - (2 * (((k * 29) % DIRECTIONS) + 0.5)) / DIRECTIONS, turn = k * 29 * Math.PI * (3 - Math.sqrt(5));
  const level = Math.sqrt(1 - z * z);
  return new Vector3(level * Math.cos(turn), level * Math.sin(turn), z);
}

// Returns a texture with two texels per segment: start and radius, then end.
function segmentTexture(geometry, n) {
  const height = Math.ceil((2 * n) / WIDTH), numbers = new Float32Array(4 * WIDTH * height);
  const [start, end, sizes] = ["start", "end", "sizes"].map((name) => geometry.getAttribute(name).array);
  for (let k = 0; k < n; k++) {
    numbers.set(start.subarray(3 * k, 3 * k + 3), 8 * k);
    numbers[8 * k + 3] = sizes[3 * k];
    numbers.set(end.subarray(3 * k, 3 * k + 3), 8 * k + 4);
  }
  const made = new DataTexture(numbers, WIDTH, height, RGBAFormat, FloatType);
  made.needsUpdate = true;
  return made;
}

function clearToZero(renderer) {
  const color = renderer.getClearColor(new Color());
  renderer.setClearColor(0, 0);
  renderer.clear();
  renderer.setClearColor(color, 1);
}

export class Shade {
  constructor(renderer, vessels) {
    this.renderer = renderer;
    this.vessels = vessels;
    this.done = 0;
    const n = vessels.tree.segments.length, rows = Math.ceil((n * AROUND) / WIDTH) * ALONG;
    this.sum = new WebGLRenderTarget(WIDTH, rows, {
      type: HalfFloatType, format: RGBAFormat, minFilter: NearestFilter, magFilter: NearestFilter, depthBuffer: false,
    });
    this.map = new WebGLRenderTarget(MAP, MAP, { depthTexture: new DepthTexture(MAP, MAP, UnsignedIntType) });
    this.half = vessels.material.uniforms.halfDiagonal.value;
    this.camera = new OrthographicCamera(-this.half, this.half, this.half, -this.half, 0, 2 * this.half);
    this.camera.zoom = 1;
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: "in vec3 position; void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }",
      fragmentShader,
      defines: { AROUND, ALONG, WIDTH },
      uniforms: {
        segments: { value: segmentTexture(vessels.mesh.geometry, n) }, count: { value: n },
        depths: { value: this.map.depthTexture }, fromWorld: { value: null },
        towards: { value: new Vector3() }, texel: { value: (2 * this.half) / MAP }, deep: { value: 2 * this.half },
      },
      depthTest: false,
      depthWrite: false,
      blending: CustomBlending,
      blendSrc: OneFactor,
      blendDst: OneFactor,
    });
    this.sky = new Scene();
    this.sky.add(new Mesh(new PlaneGeometry(2, 2), this.material));
    this.sky.children[0].frustumCulled = false;
    this.shadows = new Scene();
  }

  dispose() {
    const { segments, depths } = this.material.uniforms;
    for (const owned of [this.sum, this.map, this.material, segments.value, depths.value, this.sky.children[0].geometry])
      owned.dispose();
  }

  get isDone() { return this.done === DIRECTIONS; }

  // Adds the light of the next direction. Returns false if all directions are done.
  step() {
    if (this.isDone) return false;
    const { renderer, camera } = this, towards = direction(this.done);
    camera.position.copy(towards).multiplyScalar(this.half);
    camera.up.set(Math.abs(towards.y) < 0.9 ? 0 : 1, Math.abs(towards.y) < 0.9 ? 1 : 0, 0);
    camera.lookAt(0, 0, 0);
    renderer.setRenderTarget(this.map);
    renderer.clear();
    this.vessels.drawDepths(renderer, camera, MAP);
    this.material.uniforms.towards.value = towards;
    this.material.uniforms.fromWorld.value = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
    renderer.setRenderTarget(this.sum);
    renderer.autoClear = false;
    if (this.done === 0) clearToZero(renderer);
    renderer.render(this.sky, camera);
    renderer.autoClear = true;
    renderer.setRenderTarget(null);
    this.done++;
    return true;
  }
}
