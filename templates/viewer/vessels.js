// Draws all segments as one mesh with one box per segment. In the pixels of a box, the fragment shader intersects the
// ray with the cylinder and its round ends exactly. So a segment costs 8 corners at any distance, and outlines are
// equal to those of corcast's pictures.
import {
  BackSide, BufferAttribute, Color, CustomBlending, GLSL3, InstancedBufferAttribute, InstancedBufferGeometry, Mesh,
  OneFactor, RawShaderMaterial, Scene, Vector3, ZeroFactor,
} from "three";
import vertexShader from "./vessels.vert.glsl";
import fragmentShader from "./vessels.frag.glsl";
import { ALONG, AROUND, WIDTH } from "./shade.js";

const CORNERS = [-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1];
const FACES = [
  0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5,
];

function geometry(tree) {
  const { segments, parent, position, radius, pathLength } = tree, n = segments.length;
  const start = new Float32Array(3 * n), end = new Float32Array(3 * n), sizes = new Float32Array(3 * n);
  segments.forEach((i, k) => {
    for (let c = 0; c < 3; c++) {
      start[3 * k + c] = position[3 * parent[i] + c];
      end[3 * k + c] = position[3 * i + c];
    }
    sizes.set([radius[i], pathLength[parent[i]] / tree.longest, pathLength[i] / tree.longest], 3 * k);
  });
  const made = new InstancedBufferGeometry();
  made.instanceCount = n;
  made.setAttribute("position", new BufferAttribute(new Float32Array(CORNERS), 3));
  made.setIndex(FACES);
  made.setAttribute("start", new InstancedBufferAttribute(start, 3));
  made.setAttribute("end", new InstancedBufferAttribute(end, 3));
  made.setAttribute("sizes", new InstancedBufferAttribute(sizes, 3));
  made.setAttribute("color", new InstancedBufferAttribute(new Uint8Array(4 * n), 4, true));
  return made;
}

function uniforms(look) {
  const value = (v) => ({ value: v });
  const lights = look.lights.length ? look.lights : [{ point: false, direction: [0, 0, 1], color: [0, 0, 0] }];
  return {
    ambient: value(look.ambient),
    diffuse: value(look.diffuse),
    brilliance: value(look.brilliance),
    phong: value(look.phong),
    phongSize: value(look.phongSize),
    specular: value(look.specular),
    sharpness: value(look.roughness > 0 ? 1 / look.roughness : 0),
    lightIsPoint: value(lights.map((light) => (light.point ? 1 : 0))),
    lightPosition: value(lights.map((light) => new Vector3(...light.direction))),
    lightColor: value(lights.map((light) => new Vector3(...light.color))),
    eye: value(new Vector3()),
    gaze: value(new Vector3()),
    parallel: value(false),
    pixel: value(0),
    halfDiagonal: value(1), // of the box of the tree
    paper: value(new Color()),
    fade: value(0),
    grown: value(1),
    picked: value(-1),
    accent: value(new Color()),
    open: value(null), // texture of the ambient occlusion [shade.js]
    shade: value(0), // strength of the ambient occlusion, 0..1
    rim: value(0), // light at outlines, linear
    edge: value(0), // darkness at outlines, 0..1
    isSoft: value(false),
    form: value(1), // strength of light and dark of the soft light, 0..1
  };
}

export class Vessels {
  constructor(tree) {
    this.tree = tree;
    const look = tree.properties.look;
    const defines = { LIGHTS: Math.max(1, look.lights.length), ALONG, AROUND, WIDTH };
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      defines,
      uniforms: uniforms(look),
      side: BackSide, // so that a box is drawn also for a viewer inside it
      alphaToCoverage: true, // with the blending below, partly covered pixels stay opaque:
      blending: CustomBlending,
      blendSrc: OneFactor,
      blendDst: ZeroFactor,
      blendSrcAlpha: ZeroFactor,
      blendDstAlpha: OneFactor,
    });
    this.depths = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      defines: { ...defines, DEPTHS: 1 },
      uniforms: uniforms(look),
      side: BackSide,
    });
    this.mesh = new Mesh(geometry(tree), this.material);
    this.scene = new Scene();
    this.scene.add(this.mesh);
    this.mesh.frustumCulled = false;
    this.set("halfDiagonal", tree.half);
    this.plain = Uint8Array.from(encoded(look.color));
  }

  set(name, value) {
    this.material.uniforms[name].value = value;
  }

  draw(renderer, camera, height) {
    aim(this.material.uniforms, camera, height);
    renderer.render(this.scene, camera);
  }

  // Draws depths alone, into the renderer's target.
  drawDepths(renderer, camera, height) {
    this.mesh.material = this.depths;
    aim(this.depths.uniforms, camera, height);
    renderer.render(this.scene, camera);
    this.mesh.material = this.material;
  }

  dispose() {
    for (const owned of [this.material, this.depths, this.mesh.geometry]) owned.dispose();
  }

  // Colors all segments by a scale and the values at one time. If `scale` is null, uses the color `plain`.
  paint(scale, plain, moment) {
    const attribute = this.mesh.geometry.getAttribute("color"), { segments, n } = this.tree;
    segments.forEach((i, k) => {
      if (scale) scale.put(scale.field.values[moment * n + i], attribute.array, 4 * k);
      else attribute.array.set(plain, 4 * k);
    });
    attribute.needsUpdate = true;
  }
}

// Sets the shader's parameters for a camera and a picture of this height in pixels.
function aim({ eye, gaze, parallel, pixel }, camera, height) {
  camera.updateMatrixWorld();
  eye.value.setFromMatrixPosition(camera.matrixWorld);
  camera.getWorldDirection(gaze.value);
  parallel.value = !!camera.isOrthographicCamera;
  pixel.value = camera.isOrthographicCamera
    ? (camera.top - camera.bottom) / camera.zoom / height
    : (2 * Math.tan((camera.fov * Math.PI) / 360)) / camera.zoom / height;
}

// Returns a linear color as sRGB bytes.
function encoded(linear) {
  return linear.map((v) => Math.round(255 * (v < 0.0031308 ? 12.92 * v : 1.055 * Math.pow(v, 1 / 2.4) - 0.055)));
}
