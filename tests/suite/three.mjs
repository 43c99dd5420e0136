// Draws JSON scenes of `corcast suite --format json` with three.js in headless Chromium, as a page would: meshes of
// 256 sides, MeshLambertMaterial or MeshPhongMaterial, fog, shadow maps of 4096 x 4096 texels. One browser draws all scenes.
//
//   node three.mjs FOLDER_OF_THREE.JS SCENE.json PICTURE.png [SCENE.json PICTURE.png]...
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

const SIDES = 256;

// Runs in the page. Returns the picture as a data URL.
function draw(T, renderer, scene, sides) {
  const v = (a) => new T.Vector3(...a), rgb = (a) => new T.Color().setRGB(...a, T.LinearSRGBColorSpace);
  const world = new T.Scene(), camera = scene.camera, direction = v(camera.direction);
  const bounds = new T.Box3();
  world.background = rgb(scene.background);
  const material = (finish, color, extra) => {
    const body = { color: rgb(color).multiplyScalar(finish.diffuse), emissive: rgb(color).multiplyScalar(finish.ambient), ...extra };
    const highlight = finish.phong || finish.specular; // MeshPhongMaterial shines at grazing angles even if this is 0
    return highlight ? new T.MeshPhongMaterial({ ...body, specular: new T.Color().setScalar(highlight),
      shininess: finish.phong ? finish.phong_size : 1 / finish.roughness }) : new T.MeshLambertMaterial(body);
  };
  const add = (geometry, look) => {
    const mesh = new T.Mesh(geometry, look);
    mesh.castShadow = mesh.receiveShadow = true;
    world.add(mesh);
    return mesh;
  };
  for (const s of scene.shapes) {
    const a = v(s.a), b = v(s.b), axis = b.clone().sub(a), look = material(scene.finish, s.color);
    const mesh = s.kind === 'sphere' ? add(new T.SphereGeometry(s.radius, sides, sides / 2), look)
      : add(new T.CylinderGeometry(s.radius, s.radius, axis.length(), sides), look);
    mesh.position.copy(s.kind === 'sphere' ? a : a.clone().add(b).multiplyScalar(0.5));
    if (s.kind !== 'sphere')
      mesh.quaternion.setFromUnitVectors(new T.Vector3(0, 1, 0), axis.normalize());
    bounds.expandByPoint(a).expandByPoint(b);
  }
  bounds.expandByScalar(Math.max(...scene.shapes.map((s) => s.radius)));
  const ball = bounds.getBoundingSphere(new T.Sphere());
  if (scene.ground) {
    const normal = v(scene.ground.normal);
    const plane = add(new T.PlaneGeometry(100 * ball.radius, 100 * ball.radius),
      material(scene.ground.finish, scene.ground.color, { side: T.DoubleSide, fog: false }));
    plane.position.copy(normal.clone().multiplyScalar(scene.ground.offset));
    plane.quaternion.setFromUnitVectors(new T.Vector3(0, 0, 1), normal);
  }
  for (const light of scene.lights) {
    // three.js divides diffuse light by pi.
    const made = light.parallel ? new T.DirectionalLight(0xffffff, Math.PI) : new T.PointLight(0xffffff, Math.PI, 0, 0);
    made.color = rgb(light.color);
    made.position.copy(v(light.location));
    if (light.parallel) {
      const towards = v(light.location).sub(v(light.target)).normalize(), half = ball.radius, box = made.shadow.camera;
      made.target.position.copy(ball.center);
      made.position.copy(ball.center).addScaledVector(towards, 3 * half);
      Object.assign(box, { left: -half, right: half, top: half, bottom: -half, near: half, far: 5 * half });
      world.add(made.target);
    } else {
      const distance = made.position.distanceTo(ball.center);
      Object.assign(made.shadow.camera, { near: Math.max(distance - 2 * ball.radius, 0.01 * distance), far: distance + 50 * ball.radius });
    }
    made.castShadow = scene.shadows && light.casts_shadows;
    made.shadow.mapSize.set(4096, 4096);
    made.shadow.bias = -0.0005;
    world.add(made);
  }
  const location = v(camera.location), distance = location.distanceTo(ball.center);
  const width = v(camera.right).length(), height = v(camera.up).length();
  const near = Math.max(distance - 2 * ball.radius, 1e-3 * distance), far = distance + (scene.ground ? 60 : 2) * ball.radius;
  const eye = camera.projection === 'orthographic' ? new T.OrthographicCamera(-width / 2, width / 2, height / 2, -height / 2, near, far)
    : new T.PerspectiveCamera(2 * Math.atan(height / 2 / direction.length()) * 180 / Math.PI, width / height, near, far);
  eye.position.copy(location);
  eye.up.copy(v(camera.up));
  eye.lookAt(location.clone().add(direction));
  const [nearest, farthest, fade_near, fade_far] = scene.fade;
  if (fade_far > fade_near) { // fog grows linearly from 0 to 1
    const slope = (farthest - nearest) / (fade_far - fade_near), from = fade_near - nearest / slope;
    world.fog = new T.Fog(rgb(scene.background), from, from + 1 / slope);
  }
  renderer.setSize(camera.width, camera.height);
  renderer.render(world, eye);
  return renderer.domElement.toDataURL('image/png');
}

const [three, ...files] = process.argv.slice(2);
const scenes = files.filter((_, i) => i % 2 === 0).map((name) => JSON.parse(readFileSync(name)));
const work = mkdtempSync(join(tmpdir(), 'three-'));
const page = `<script type="module">import * as T from 'file://${resolve(three)}/build/three.module.js';
${draw}
const renderer = new T.WebGLRenderer({ preserveDrawingBuffer: true });
renderer.shadowMap.enabled = true;
renderer.shadowMap.type = T.BasicShadowMap;
document.title = JSON.stringify(${JSON.stringify(scenes)}.map((scene) => draw(T, renderer, scene, ${SIDES})));
</script>`;
try {
  writeFileSync(join(work, 'page.html'), page);
  const shown = execFileSync('chromium', ['--headless', '--no-sandbox', '--allow-file-access-from-files', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
    `--user-data-dir=${work}/profile`, '--virtual-time-budget=600000', '--dump-dom', `file://${work}/page.html`],
  { maxBuffer: 1 << 28, stdio: ['ignore', 'pipe', 'pipe'] }).toString();
  const pictures = shown.match(/<title>(.*)<\/title>/s);
  if (!pictures)
    throw new Error('the page drew nothing');
  JSON.parse(pictures[1]).forEach((url, i) => writeFileSync(files[2 * i + 1], Buffer.from(url.split(',')[1], 'base64')));
} finally {
  rmSync(work, { recursive: true, force: true });
}
