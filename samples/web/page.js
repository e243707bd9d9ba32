// One scene, light and camera, drawn twice by three.js: with its own point-light shadow as it comes, and with the GLSL
// ES that `gnomon export --map cube --bias two-plane-depth --lang glsl-es` wrote, put in the place of getPointShadow().
// Beside each picture, its visibility a pixel: lit, in shadow, or nothing drawn. `run` serves this page, takes what it
// posts, and has Gnomon label it.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

const setup = await (await fetch('setup.json')).json(); // of `run`: side, mapSide
const exported = await (await fetch('shadow.glsl')).text();

const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
renderer.setSize(setup.side, setup.side);
renderer.shadowMap.enabled = true;

// Flat normals, of triangles: a shadow needs the surface that is there, not the one it is shaded as.
function flat(geometry) {
  const plain = geometry.index ? geometry.toNonIndexed() : geometry;
  plain.computeVertexNormals();
  return plain;
}

const gltf = await new GLTFLoader().loadAsync('scene.glb');
const scene = new THREE.Scene();
const bounds = new THREE.Box3();
const meshes = [];
gltf.scene.updateMatrixWorld(true);
gltf.scene.traverse((node) => {
  if (!node.isMesh) return;
  const mesh = new THREE.Mesh(flat(node.geometry.clone().applyMatrix4(node.matrixWorld)), node.material);
  mesh.castShadow = mesh.receiveShadow = true;
  meshes.push(mesh);
  bounds.expandByObject(mesh);
  scene.add(mesh);
});
const camera = gltf.cameras[0];
camera.aspect = 1;
camera.updateProjectionMatrix();
camera.matrixAutoUpdate = false;
camera.matrix.copy(camera.matrixWorld);
camera.parent?.remove(camera);
camera.updateMatrixWorld(true);

// The file's first point light, and as near and far ends what the scene needs: the farthest corner, a hundredth of that.
let source = null;
gltf.scene.traverse((node) => { if (node.isPointLight && !source) source = node; });
const place = new THREE.Vector3().setFromMatrixPosition(source.matrixWorld);
const far = Math.max(...[0, 1, 2, 3, 4, 5, 6, 7].map((i) => new THREE.Vector3(
  i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y, i & 4 ? bounds.max.z : bounds.min.z)
  .distanceTo(place))) * 1.01;
const near = far / 100;

const light = new THREE.PointLight(0xffffff, setup.candela, 0, 2);
light.position.copy(place);
light.castShadow = true;
light.shadow.mapSize.set(setup.mapSide, setup.mapSide);
light.shadow.camera.near = near;
light.shadow.camera.far = far;
scene.add(light, new THREE.AmbientLight(0xffffff, 0.15));

// The depth of six faces in an array texture, as the exported file asks for it: clip space is (s, t, depth, m) of the
// table in it, so that row 0 is t = -1 here as there.
const depthMap = new THREE.WebGLArrayRenderTarget(setup.mapSide, setup.mapSide, 6, { depthBuffer: true });
Object.assign(depthMap.texture, { format: THREE.RedFormat, type: THREE.FloatType, // the constructor takes no format
  minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
const clipDepth = new THREE.Vector2(far / (far - near), -near * far / (far - near));

function facePlaces(face) {
  const sign = face % 2 ? -1 : 1, axis = face >> 1;
  const rows = [
    axis === 0 ? [0, 0, -sign] : axis === 1 ? [1, 0, 0] : [sign, 0, 0],
    axis === 1 ? [0, 0, sign] : [0, -1, 0],
    [0, 1, 2].map((i) => (i === axis ? sign : 0)),
  ];
  const m = new THREE.Matrix4();
  const dots = rows.map((r) => -(r[0] * place.x + r[1] * place.y + r[2] * place.z));
  // WebGL's depth goes from -w to w: twice the stored depth less w.
  const depth = rows[2].map((v) => v * (2 * clipDepth.x - 1));
  m.set(...rows[0], dots[0], ...rows[1], dots[1],
    ...depth, dots[2] * (2 * clipDepth.x - 1) + 2 * clipDepth.y, ...rows[2], dots[2]);
  return { clip: m, face: new THREE.Matrix3().set(...rows[0], ...rows[1], ...rows[2]) };
}

// Stored is where a texel's ray meets the triangle's plane, (s, t, 1) m, and not what the rasterizer interpolates: those of
// browsers are off by more than the few 2^-24 that two-plane-depth allows for.
const drawDepth = new THREE.RawShaderMaterial({
  glslVersion: THREE.GLSL3, side: THREE.DoubleSide,
  uniforms: { clipFromWorld: { value: new THREE.Matrix4() }, faceFromWorld: { value: new THREE.Matrix3() },
    gnomonLight: { value: place }, gnomonClipDepth: { value: clipDepth }, texel: { value: 1 / setup.mapSide } },
  vertexShader: `in vec3 position; in vec3 normal; uniform mat4 clipFromWorld; uniform vec3 gnomonLight;
    flat out vec4 plane;
    void main() {
      plane = vec4(normal, dot(normal, position - gnomonLight));
      gl_Position = clipFromWorld * vec4(position, 1.0);
    }`,
  fragmentShader: `precision highp float; flat in vec4 plane; out vec4 depth;
    uniform mat3 faceFromWorld; uniform vec2 gnomonClipDepth; uniform float texel;
    void main() {
      vec3 direction = vec3(gl_FragCoord.xy * (2.0 * texel) - 1.0, 1.0) * faceFromWorld;
      float m = plane.w / dot(plane.xyz, direction);
      float exact = gnomonClipDepth.x + gnomonClipDepth.y / m;
      depth = vec4(abs(exact - gl_FragCoord.z) < 1e-3 ? exact : gl_FragCoord.z);
    }`,
});

function drawDepths() {
  const everywhere = new THREE.Camera();
  const old = scene.overrideMaterial;
  for (const mesh of meshes) mesh.frustumCulled = false; // the faces' cameras are not three's
  scene.overrideMaterial = drawDepth;
  renderer.shadowMap.autoUpdate = false;
  renderer.setClearColor(0xffffff, 1);
  for (let face = 0; face < 6; ++face) {
    const { clip, face: axes } = facePlaces(face);
    drawDepth.uniforms.clipFromWorld.value = clip;
    drawDepth.uniforms.faceFromWorld.value = axes;
    drawDepth.uniformsNeedUpdate = true;
    renderer.setRenderTarget(depthMap, face);
    renderer.clear();
    renderer.render(scene, everywhere);
  }
  renderer.setRenderTarget(null);
  scene.overrideMaterial = old;
  renderer.shadowMap.autoUpdate = true;
}

// three.js calls getPointShadow(): its own, or ours under its name.
const uniforms = { gnomonDepth: { value: depthMap.texture }, gnomonClipDepth: { value: clipDepth }, gnomonNear: { value: near },
  gnomonLight: { value: place } };
function withExported(material) {
  const patched = material.clone();
  patched.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('void main() {', 'out vec3 gnomonPosition;\nflat out vec3 gnomonNormal;\nvoid main() {\n' +
        'gnomonPosition = position;\ngnomonNormal = normal;');
    const own = THREE.ShaderChunk.shadowmap_pars_fragment.replace('float getPointShadow(', 'float threePointShadow(');
    const parameters = /float getPointShadow\(([^)]*)\)/.exec(THREE.ShaderChunk.shadowmap_pars_fragment)[1];
    const call = `
      uniform vec2 gnomonClipDepth;
      uniform float gnomonNear;
      uniform vec3 gnomonLight;
      in vec3 gnomonPosition;
      flat in vec3 gnomonNormal;
      float getPointShadow(${parameters}) {
        GnomonShadowMap map;
        map.zNear = gnomonNear;
        map.clipDepth = gnomonClipDepth;
        GnomonLightFrame frame;
        frame.originW = gnomonLight;
        frame.rightW = vec3(1.0, 0.0, 0.0);
        frame.upW = vec3(0.0, 1.0, 0.0);
        frame.backW = vec3(0.0, 0.0, 1.0);
        vec3 normal = normalize(gnomonNormal);
        if (dot(normal, gnomonLight - gnomonPosition) < 0.0) normal = -normal;
        return gnomonVisibility(map, gnomonReceiverAt(frame, gnomonPosition, normal));
      }`;
    shader.fragmentShader = shader.fragmentShader.replace('#include <shadowmap_pars_fragment>', own + exported + call);
  };
  patched.customProgramCacheKey = () => 'gnomon';
  return patched;
}

// The scene by its own materials, and by one that shows the shadow alone.
// It casts as theirs do.
const own = new Map(meshes.map((mesh) => [mesh, mesh.material]));
function shadowOnly(material) {
  const shown = new THREE.ShadowMaterial({ color: 0x000000, side: material.side, blending: THREE.NoBlending });
  shown.shadowSide = material.shadowSide;
  return shown;
}

function picture(patch) {
  for (const mesh of meshes) mesh.material = patch ? withExported(own.get(mesh)) : own.get(mesh);
  renderer.setClearColor(0x202428, 1);
  renderer.setRenderTarget(null);
  renderer.render(scene, camera);
  const copy = document.createElement('canvas');
  copy.width = copy.height = setup.side;
  copy.getContext('2d').drawImage(renderer.domElement, 0, 0);
  document.getElementById('pictures').append(copy);
  return copy;
}

// One byte a pixel, from the top: 0 in shadow, 255 lit, 128 nothing drawn.
function visibility(patch) {
  for (const mesh of meshes) {
    const shown = shadowOnly(own.get(mesh));
    mesh.material = patch ? withExported(shown) : shown;
  }
  const target = new THREE.WebGLRenderTarget(setup.side, setup.side, { type: THREE.FloatType });
  renderer.setClearColor(0xffffff, 1);
  renderer.setRenderTarget(target);
  renderer.clear();
  renderer.render(scene, camera);
  const values = new Float32Array(setup.side * setup.side * 4);
  renderer.readRenderTargetPixels(target, 0, 0, setup.side, setup.side, values);
  renderer.setRenderTarget(null);
  const mask = new Uint8Array(setup.side * setup.side);
  for (let y = 0; y < setup.side; ++y)
    for (let x = 0; x < setup.side; ++x) {
      const at = 4 * ((setup.side - 1 - y) * setup.side + x);
      // ShadowMaterial writes black, and as alpha how much of the light is missing; the background is white.
      mask[y * setup.side + x] = values[at] > 0.5 ? 128 : values[at + 3] < 0.5 ? 255 : 0;
    }
  return mask;
}

async function post(name, body) {
  await fetch(name, { method: 'POST', body });
}
const png = (canvas) => new Promise((done) => canvas.toBlob(done, 'image/png'));

try {
  drawDepths();
  for (const [name, patch] of [['three', false], ['two-plane-depth', true]]) {
    await post(`${name}.mask`, visibility(patch));
    await post(`${name}.png`, await png(picture(patch)));
  }
  const errors = renderer.info.programs.map((program) => program.diagnostics).filter((d) => d && !d.runnable);
  await post('done', JSON.stringify({ three: THREE.REVISION, near, far, errors, renderer: renderer.getContext().getParameter(
    renderer.getContext().RENDERER) }));
  document.getElementById('told').textContent = 'done';
} catch (error) {
  await post('done', JSON.stringify({ failed: String(error.stack || error) }));
}
