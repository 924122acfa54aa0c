// node three_lux.cjs FILE.glb POINTS.csv [PICTURE.png [exposure]]: loads a file of `deltalux export` in three.js, in a
// headless Chromium, and prints the lux that its lightmap and its .exr have at points (columns x,y,z,nx,ny,nz, and lux to
// compare with: the output of `deltalux probe --mesh`). Needs three and playwright-core in NODE_PATH.
const fs = require('fs'), http = require('http'), path = require('path');
const {chromium} = require('playwright-core');

const three = path.resolve(path.dirname(require.resolve('three')), '..');
const [file, points, picture, exposure] = process.argv.slice(2);

const page = `<!doctype html><canvas id=c width=960 height=640></canvas>
<script type=importmap>{"imports": {"three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/"}}</script>
<script type=module>
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {EXRLoader} from 'three/addons/loaders/EXRLoader.js';
import {MeshoptDecoder} from 'three/addons/libs/meshopt_decoder.module.js';

class Lightmaps {  // MOZ_lightmap: linear irradiance
  constructor(parser) { this.parser = parser; this.name = 'MOZ_lightmap'; }
  extendMaterialParams(index, params) {
    const light = this.parser.json.materials[index].extensions?.[this.name];
    if (!light) return Promise.resolve();
    params.lightMapIntensity = light.intensity ?? 1;
    return this.parser.assignTexture(params, 'lightMap', {texCoord: 1, ...light}, THREE.NoColorSpace);
  }
}

function bilinear(read, width, height, uv) {
  const x = uv.x * width - 0.5, y = uv.y * height - 0.5, x0 = Math.floor(x), y0 = Math.floor(y), sum = [0, 0, 0];
  for (const [dx, dy] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
    const w = (dx ? x - x0 : 1 - x + x0) * (dy ? y - y0 : 1 - y + y0);
    const texel = read(Math.min(Math.max(x0 + dx, 0), width - 1), Math.min(Math.max(y0 + dy, 0), height - 1));
    for (let c = 0; c < 3; ++c) sum[c] += w * texel[c];
  }
  return sum;
}

window.load = async (name) => {
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
  loader.register((parser) => new Lightmaps(parser));
  const gltf = await loader.loadAsync('/file/' + encodeURIComponent(name));
  gltf.scene.updateMatrixWorld(true);
  window.gltf = gltf;
  const extras = gltf.parser.json.asset.extras.deltalux;
  window.exrs = [];
  for (const p of extras.lightmap?.pages ?? [])
    window.exrs.push(await new EXRLoader().setDataType(THREE.FloatType).loadAsync('/file/' + encodeURIComponent(p.exr)));
  return {extras, lightMaps: [...new Set(gltf.scene.children[0].children.map((m) => m.material?.lightMap?.channel))]};
};

window.luxAt = (p) => {
  const root = gltf.scene.children[0], extras = gltf.parser.json.asset.extras.deltalux;
  const normal = new THREE.Vector3(p.nx, p.ny, p.nz).normalize();
  const at = new THREE.Vector3(p.x, p.y, p.z).sub(new THREE.Vector3(...(extras.origin ?? [0, 0, 0])));
  const from = root.localToWorld(at.clone().addScaledVector(normal, 1e-3));
  const ray = new THREE.Raycaster(from, normal.clone().transformDirection(root.matrixWorld).negate());
  const hit = ray.intersectObject(root, true).find((h) => h.object.material.lightMap);
  if (!hit) return null;
  const map = hit.object.material.lightMap, image = map.image;
  const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, image.width, image.height).data;
  const lux = (E) => extras.luminousEfficacy * E.reduce((sum, v, c) => sum + v * extras.luminanceWeights[c], 0);
  const byte = (x, y) => [0, 1, 2].map((c) => pixels[4 * (y * image.width + x) + c] / 255 * hit.object.material.lightMapIntensity);
  const page = extras.lightmap.pages.findIndex((q) => q.intensity === hit.object.material.lightMapIntensity);
  const exr = exrs[Math.max(page, 0)].image, flip = (y) => exr.height - 1 - y;  // its rows run upwards
  const float = (x, y) => [0, 1, 2].map((c) => exr.data[4 * (flip(y) * exr.width + x) + c]);
  const uv = hit.uv1;
  return {png: lux(bilinear(byte, image.width, image.height, uv)), exr: lux(bilinear(float, exr.width, exr.height, uv))};
};

window.draw = (camera, exposure) => {
  const renderer = new THREE.WebGLRenderer({canvas: document.getElementById('c'), preserveDrawingBuffer: true});
  renderer.toneMapping = THREE.ReinhardToneMapping, renderer.toneMappingExposure = exposure;
  const scene = new THREE.Scene();
  scene.add(gltf.scene);
  const box = new THREE.Box3().setFromObject(gltf.scene), center = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3());
  const eye = new THREE.PerspectiveCamera(60, 1.5, 0.01, 1000), back = camera ?? [0, 0, 1.6];
  eye.position.copy(center).add(new THREE.Vector3(...back).multiplyScalar(size.length() / 2));
  eye.lookAt(center);
  renderer.render(scene, eye);
  return renderer.info.render;
};
window.ready = true;
</script>`;

function serve(request, response) {
  const url = decodeURIComponent(request.url.split('?')[0]);
  if (url === '/') return response.end(page);
  for (const [prefix, folder] of [['/three/', three], ['/file/', path.dirname(path.resolve(file))]])
    if (url.startsWith(prefix)) {
      const name = path.join(folder, url.slice(prefix.length));
      if (!fs.existsSync(name)) break;
      if (/\.m?js$/.test(name)) response.setHeader('Content-Type', 'text/javascript');
      return response.end(fs.readFileSync(name));
    }
  response.statusCode = 404;
  response.end();
}

function readCsv(name) {
  const lines = fs.readFileSync(name, 'utf8').split('\n').filter((l) => l && !l.startsWith('#'));
  const columns = lines[0].split(',').map((c) => c.trim());
  return lines.slice(1).map((l) => Object.fromEntries(l.split(',').map((v, i) => [columns[i], Number(v)])));
}

(async () => {
  const server = http.createServer(serve).listen(0, '127.0.0.1');
  await new Promise((resolve) => server.on('listening', resolve));
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--ignore-gpu-blocklist']
  });
  let worst = 0;
  try {
    const tab = await browser.newPage();
    tab.on('console', (m) => console.log('console:', m.text()));
    tab.on('pageerror', (e) => console.log('error:', e.message));
    await tab.goto(`http://127.0.0.1:${server.address().port}/`);
    await tab.waitForFunction('window.ready');
    console.log(JSON.stringify(await tab.evaluate((name) => load(name), path.basename(file))));
    for (const p of points && points !== '-' ? readCsv(points) : []) {
      const lux = await tab.evaluate((q) => luxAt(q), p);
      const off = lux && p.lux > 0 ? (v) => (100 * (v / p.lux - 1)).toFixed(2) + ' %' : () => '';
      if (lux && p.lux > 0) worst = Math.max(worst, Math.abs(lux.exr / p.lux - 1));
      console.log(p.x, p.y, p.z, 'probe', p.lux, 'exr', lux?.exr?.toFixed(2), off(lux?.exr), 'png', lux?.png?.toFixed(2), off(lux?.png));
    }
    console.log('worst of the .exr', (100 * worst).toFixed(2), '%');
    if (picture) {
      const back = process.env.CAMERA ? JSON.parse(process.env.CAMERA) : null;
      console.log(JSON.stringify(await tab.evaluate(([b, e]) => draw(b, e), [back, Number(exposure || 1)])));
      await tab.locator('#c').screenshot({path: picture});
    }
  } finally {
    await browser.close();
    server.close();
  }
  process.exit(worst > 0.03 ? 1 : 0);
})();
