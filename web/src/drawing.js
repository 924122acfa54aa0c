// Draws the solution: surfaces into a picture of linear light, panes over it, caustic textures added, then the screen.
import * as THREE from 'three';
import { falseColour, gray } from './colour.js';
import { undoDifferences } from './payload.js';
import * as shaders from './shaders.js';

const near = THREE.NearestFilter, linear = THREE.LinearFilter;
/** Of what is added to a surface: over it by a few steps of depth, and no more, or it would show through what is thin. */
const overSurface = { polygonOffset: true, polygonOffsetFactor: -0.1, polygonOffsetUnits: -4 };

function dataTexture(data, width, height, format, type, filter) {
  const t = new THREE.DataTexture(data, width, height, format, type);
  t.magFilter = t.minFilter = filter;
  t.generateMipmaps = false;
  t.needsUpdate = true;
  return t;
}

const rgb9e5 = (words, width, height) =>
  Object.assign(dataTexture(words, width, height, THREE.RGBFormat, THREE.UnsignedInt5999Type, linear), { unpackAlignment: 4 });

/** Vertices and triangles of the payload, unpacked. */
export function unpackMesh({ header, section }) {
  const count = header.vertexCount, positions = new Float32Array(3 * count);
  const whole = new Int32Array(count), coded = section('positions', Uint8Array);
  for (let c = 0; c < 3; ++c) {
    undoDifferences(coded.subarray(4 * count * c, 4 * count * (c + 1)), count, 4, whole);
    for (let i = 0; i < count; ++i) positions[3 * i + c] = header.lower[c] + whole[i] * header.step;
  }
  const triangles = new Uint32Array(undoDifferences(section('triangles', Uint8Array), header.indexCount, 4).buffer);
  const materials = new Float32Array(count);
  const sides = section('sides', Uint32Array);  // vertices and material of each, in order
  for (let s = 0, v = 0; s < sides.length; s += 2) {
    materials.fill(sides[s + 1], v, v + sides[s]);
    v += sides[s];
  }
  const bytes = section('normals', Int8Array), bends = new Float32Array(2 * count);
  for (let i = 0; i < count; ++i) {
    bends[2 * i] = bytes[i] / 127;
    bends[2 * i + 1] = bytes[count + i] / 127;
  }
  return { positions, triangles, materials, bends, uvs: header.sections.uvs ? section('uvs', Float32Array) : null };
}

const indicesOfAPart = 3 * 4096;

function sphereAbout(positions, vertices) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const v of vertices)
    for (let c = 0; c < 3; ++c) {
      const x = positions[3 * v + c];
      if (x < low[c]) low[c] = x;
      if (x > high[c]) high[c] = x;
    }
  const box = new THREE.Box3(new THREE.Vector3(...low), new THREE.Vector3(...high));
  return box.getBoundingSphere(new THREE.Sphere());
}

export class Drawing {
  constructor(payload, mesh, relight, canvasParent) {
    const { header } = payload;
    this.header = header;
    this.payload = payload;
    this.mesh = mesh;
    this.relight = relight;
    this.renderer = new THREE.WebGLRenderer({ antialias: false, powerPreference: 'high-performance', preserveDrawingBuffer: true });
    this.renderer.autoClear = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.toneMapping = THREE.NoToneMapping;
    canvasParent.append(this.renderer.domElement);
    this.camera = new THREE.PerspectiveCamera(60, 1, 0.05 / header.metresPerUnit, Math.max(header.step * 2 ** 25, 10 / header.metresPerUnit));
    this.camera.up.fromArray(header.up);
    this.shared = {
      materials: { value: this.makeMaterialTable() },
      showsIrradiance: { value: false },
      ambient: { value: new THREE.Vector3() },
      upwards: { value: new THREE.Vector3().fromArray(header.up) },
      eye: { value: new THREE.Vector3() },
    };
    this.attributes = {
      position: new THREE.BufferAttribute(mesh.positions, 3),
      irradiance: new THREE.BufferAttribute(relight.E, 3).setUsage(THREE.DynamicDrawUsage),
      bend: new THREE.BufferAttribute(mesh.bends, 2),
      material: new THREE.BufferAttribute(mesh.materials, 1),
    };
    if (mesh.uvs) this.attributes.uv = new THREE.BufferAttribute(mesh.uvs, 2);
    this.world = new THREE.Scene();
    this.world.matrixAutoUpdate = false;
    this.mirrors = [];
    this.caustics = [];
    for (const draw of header.draws) this.addDraw(draw);
    header.caustics.forEach((c, i) => this.addCaustics(c, i));
    this.makeScreen();
    this.targets();
  }

  shader(vertexDefines, options = {}, uniforms = {}, fragment = shaders.surfaceFragment, vertex = shaders.surfaceVertex) {
    return new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: vertex, fragmentShader: fragment,
      defines: Object.fromEntries(vertexDefines.map((d) => [d, 1])),
      uniforms: { ...this.shared, ...uniforms }, ...options,
    });
  }

  /** Parts are drawn where they are in sight. */
  add(geometry, material, order) {
    const object = new THREE.Mesh(geometry, material);
    object.frustumCulled = geometry.boundingSphere !== null;
    object.matrixAutoUpdate = false;
    object.renderOrder = order;
    this.world.add(object);
    return object;
  }

  /** Triangles that stand together, with the sphere that they lie in. */
  part(first, count) {
    const geometry = new THREE.BufferGeometry(), triangles = this.mesh.triangles.subarray(first, first + count);
    for (const [name, attribute] of Object.entries(this.attributes)) geometry.setAttribute(name, attribute);
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    geometry.boundingSphere = sphereAbout(this.mesh.positions, triangles);
    return geometry;
  }

  addDraw(draw) {
    if (draw.kind === 'mirror') return this.addMirror(this.part(draw.first, draw.count), draw);
    const layers = this.layersOf(draw);
    for (let i = 0; i < draw.count; i += indicesOfAPart) {
      const geometry = this.part(draw.first + i, Math.min(indicesOfAPart, draw.count - i));
      for (const { material, order, pane } of layers) this.add(geometry, material, order).userData.pane = pane;
    }
  }

  /** What is drawn of a surface, one over the other. `pane`: not where irradiance is shown. */
  layersOf(draw) {
    const textured = draw.texture >= 0 ? ['TEXTURED'] : [];
    const image = draw.texture >= 0 ? { image: { value: this.image(draw.texture) } } : {};
    const over = { depthWrite: false, transparent: true, blending: THREE.CustomBlending, blendEquation: THREE.AddEquation };
    const added = { ...over, blendSrc: THREE.OneFactor, blendDst: THREE.OneFactor };
    if (draw.kind === 'opaque') return [{ material: this.shader(textured, {}, image), order: 0 }];
    if (draw.kind === 'behind')
      return [{ material: this.shader(['BEHIND'], { ...added, ...overSurface, side: THREE.BackSide }), order: 1 }];
    const passes = { transmissivity: { value: new THREE.Vector3().fromArray(draw.transmissivity) }, index: { value: draw.index } };
    return [
      { material: this.shader(['PASSES'], { ...over, blendSrc: THREE.ZeroFactor, blendDst: THREE.SrcColorFactor,
        blendSrcAlpha: THREE.ZeroFactor, blendDstAlpha: THREE.OneFactor }, passes), order: 3 },
      // What it reflects or scatters itself.
      { material: this.shader(['OVER', ...textured], { ...added, blendSrcAlpha: THREE.ZeroFactor, blendDstAlpha: THREE.OneFactor }, image), order: 4, pane: true },
    ];
  }

  addMirror(geometry, draw) {
    const uniforms = { mirrored: { value: null }, pixels: { value: new THREE.Vector2(1, 1) }, mirrorOn: { value: 0 } };
    const object = this.add(geometry, this.shader(['MIRROR'], {}, uniforms), 0);
    this.mirrors.push({ object, uniforms, plane: draw.plane, corners: draw.corners.map((p) => new THREE.Vector3().fromArray(p)), target: null });
  }

  addCaustics({ group, width, height, vertexCount }, i) {
    const { section } = this.payload, geometry = new THREE.BufferGeometry();
    const positions = section(`caustic${i}.positions`, Float32Array), texels = section(`caustic${i}.texcoords`, Float32Array);
    const triangles = section(`caustic${i}.triangles`, Uint32Array);
    const owners = section(`caustic${i}.materials`, Uint32Array), words = section(`caustic${i}.texels`, Uint32Array);
    const shows = section(`caustic${i}.shows`, Uint8Array);
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute('texel', new THREE.BufferAttribute(texels, 2));
    geometry.setAttribute('material', new THREE.BufferAttribute(Float32Array.from(owners), 1));
    geometry.setAttribute('bend', new THREE.BufferAttribute(new Float32Array(2 * vertexCount), 2));
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    const light = rgb9e5(words, width, height);
    const mask = dataTexture(shows, width, height, THREE.RedFormat, THREE.UnsignedByteType, near);
    mask.unpackAlignment = 1;
    const weight = { value: new THREE.Vector3() };
    this.add(geometry, this.shader(['CAUSTIC'], {
      ...overSurface, transparent: true, depthWrite: false, blending: THREE.CustomBlending, blendEquation: THREE.AddEquation,
      blendSrc: THREE.OneFactor, blendDst: THREE.OneFactor,
    }, { light: { value: light }, shows: { value: mask }, weight }), 2);
    this.caustics.push({ group, width, height, positions, texels, triangles, words, shows, weight });
  }

  image(index) {
    const { width, height } = this.header.textures[index];
    const texture = dataTexture(this.payload.section(`texture${index}`, Uint8Array), width, height, THREE.RGBAFormat, THREE.UnsignedByteType, THREE.LinearFilter);
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.minFilter = THREE.LinearMipmapLinearFilter;
    texture.generateMipmaps = true;
    return texture;
  }

  makeMaterialTable() {
    const { materials } = this.header, width = shaders.kMaterialsPerRow * shaders.kMaterialTexels;
    const rows = Math.max(Math.ceil(materials.length / shaders.kMaterialsPerRow), 1);
    this.table = new Float32Array(4 * width * rows);
    materials.forEach((m, i) => {
      const at = 4 * shaders.kMaterialTexels * i;
      for (let c = 0; c < 3; ++c) {
        this.table[at + c] = m.rho[c] / Math.PI;
        this.table[at + 8 + c] = m.tau[c] / Math.PI;
        this.table[at + 12 + c] = m.gloss[c];
      }
    });
    return dataTexture(this.table, width, rows, THREE.RGBAFormat, THREE.FloatType, near);
  }

  makeScreen() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const pass = (fragment, uniforms) => {
      const material = this.shader([], { depthTest: false, depthWrite: false }, uniforms, fragment, shaders.screenVertex);
      const object = new THREE.Mesh(geometry, material);
      object.frustumCulled = false;
      const scene = new THREE.Scene();
      scene.add(object);
      return { scene, uniforms: material.uniforms };
    };
    const { header } = this, size = header.skySize;
    this.skyTable = new Float32Array(4 * size[0] * size[1]);
    const sky = dataTexture(this.skyTable, ...size, THREE.RGBAFormat, THREE.FloatType, near);
    this.sky = pass(shaders.skyFragment, {
      sky: { value: sky }, forward: { value: new THREE.Vector3() }, across: { value: new THREE.Vector3() }, above: { value: new THREE.Vector3() },
      suns: { value: [0, 1, 2, 3].map(() => new THREE.Vector4(0, 0, 0, -1)) }, sunRadiance: { value: [0, 1, 2, 3].map(() => new THREE.Vector3()) },
    });
    const ramp = new Uint8Array(4 * 256);
    for (let i = 0; i < 256; ++i) ramp.set([...falseColour(i / 255), 255], 4 * i);
    this.shown = pass(shaders.shownFragment, {
      picture: { value: null }, ramp: { value: dataTexture(ramp, 256, 1, THREE.RGBAFormat, THREE.UnsignedByteType, linear) },
      exposure: { value: 1 }, top: { value: 1000 }, decades: { value: 3 }, efficacy: { value: header.efficacy }, linearTone: { value: false },
    });
  }

  targets() {
    this.target = new THREE.WebGLRenderTarget(4, 4, { type: THREE.HalfFloatType, minFilter: near, magFilter: near });
    this.shown.uniforms.picture.value = this.target.texture;
  }

  /** From now on edges are smoothed: the first picture does without, which takes half its time where there is no card. */
  smoothEdges() {
    this.target.samples = 4;
    this.target.dispose();
  }

  resize(width, height, ratio) {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height);
    this.target.setSize(Math.round(width * ratio), Math.round(height * ratio));
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /** After the weights of the relight have changed. */
  takeWeights() {
    const { header, relight, table } = this;
    this.attributes.irradiance.needsUpdate = true;
    header.materials.forEach((_, i) => table.fill(0, 16 * i + 4, 16 * i + 7));
    for (const [material, group, ...L] of header.emission)
      for (let c = 0; c < 3; ++c) table[16 * material + 4 + c] += L[c] * (group < 0 ? 1 : relight.weights[group][c]);
    this.shared.materials.value.needsUpdate = true;
    for (const c of this.caustics) c.weight.value.fromArray(relight.weights[c.group]);
    const sky = this.skyTable;
    sky.fill(0);
    header.skies.forEach(({ group }, i) => {
      const L = this.payload.section(`sky${i}`, Float32Array), w = group < 0 ? [1, 1, 1] : relight.weights[group];
      for (let k = 0; k < L.length; ++k) sky[4 * Math.floor(k / 3) + (k % 3)] += w[k % 3] * L[k];
    });
    this.sky.uniforms.sky.value.needsUpdate = true;
    header.suns.slice(0, 4).forEach((sun, i) => {
      this.sky.uniforms.suns.value[i].set(...sun.direction, 2 * Math.sin(sun.angularRadius / 2));
      this.sky.uniforms.sunRadiance.value[i].fromArray(sun.radiance.map((v, c) => v * relight.weights[sun.group][c]));
    });
  }

  /** What mirrors show that nothing is drawn in: mean radiance of what is around the eye. */
  lookRound() {
    const { positions, materials } = this.mesh, { E } = this.relight, eye = this.camera.position.toArray(), sum = [0, 0, 0];
    let total = 0;
    for (let i = 0; i < materials.length; i += 7) {
      const d = (positions[3 * i] - eye[0]) ** 2 + (positions[3 * i + 1] - eye[1]) ** 2 + (positions[3 * i + 2] - eye[2]) ** 2;
      const w = 1 / (1 / this.header.metresPerUnit ** 2 + d) ** 2;
      total += w;
      for (let c = 0; c < 3; ++c) sum[c] += w * E[3 * i + c] * this.table[16 * materials[i] + c];
    }
    this.shared.ambient.value.fromArray(sum.map((v) => v / Math.max(total, 1e-30)));
  }

  /** Where a camera looks, and half its picture's width and height, at distance 1. */
  frameOf(camera) {
    const x = new THREE.Vector3(), y = new THREE.Vector3(), z = new THREE.Vector3(), P = camera.projectionMatrix.elements;
    camera.matrixWorld.extractBasis(x, y, z);
    return [z.negate(), x.divideScalar(P[0]), y.divideScalar(P[5])];
  }

  drawWorld(camera, target, frame = this.frameOf(camera)) {
    const { renderer, shared, sky } = this;
    shared.eye.value.copy(camera.position);
    renderer.setRenderTarget(target);
    renderer.setClearColor(0x000000, 0);
    renderer.clear();
    ['forward', 'across', 'above'].forEach((name, i) => sky.uniforms[name].value.copy(frame[i]));
    renderer.render(sky.scene, camera);
    renderer.render(this.world, camera);
  }

  /** Of a polygon's bounding rectangle; the whole picture has 4. */
  areaInPicture(corners) {
    const near = -0.01, box = new THREE.Box2();
    const inView = corners.map((p) => p.clone().applyMatrix4(this.camera.matrixWorldInverse));
    const put = (q) => {
      q = q.clone().applyMatrix4(this.camera.projectionMatrix);
      box.expandByPoint(new THREE.Vector2(q.x, q.y));
    };
    inView.forEach((p, i) => {
      const q = inView[(i + 1) % inView.length];
      if (p.z < near) put(p);
      if (p.z < near !== q.z < near) put(p.clone().lerp(q, (near - p.z) / (q.z - p.z)));
    });
    box.intersect(new THREE.Box2(new THREE.Vector2(-1, -1), new THREE.Vector2(1, 1)));
    if (box.isEmpty()) return 0;
    const size = box.getSize(new THREE.Vector2());
    return size.x * size.y;
  }

  /** The mirrors in sight, each drawn from behind itself: flat ones, the few that look largest. */
  drawMirrors(most) {
    const seen = [];
    for (const m of this.mirrors) {
      m.uniforms.mirrorOn.value = 0;
      const [nx, ny, nz, d] = m.plane, n = new THREE.Vector3(nx, ny, nz);
      const height = n.dot(this.camera.position) - d;
      if (height <= 0) continue;
      const area = this.seen && !this.seen(m, n) ? 0 : this.areaInPicture(m.corners);
      if (area > 0.004) seen.push({ m, area, n, d });
    }
    seen.sort((a, b) => b.area - a.area);
    const { width, height } = this.target;
    for (const { m, n, d } of seen.slice(0, most)) {
      m.target ??= new THREE.WebGLRenderTarget(4, 4, { type: THREE.HalfFloatType, minFilter: linear, magFilter: linear });
      m.target.setSize(width, height);
      m.object.visible = false;
      this.renderer.setRenderTarget(null);
      this.drawReflected(n, d, m.target);
      m.object.visible = true;
      m.uniforms.mirrored.value = m.target.texture;
      m.uniforms.pixels.value.set(width, height);
    }
    for (const { m } of seen.slice(0, most)) m.uniforms.mirrorOn.value = 1;
  }

  /** The world as it is seen in a plane n . p = d, left and right exchanged: triangles keep their winding so. */
  drawReflected(n, d, target) {
    const { camera } = this, virtual = camera.clone();
    const reflect = new THREE.Matrix4().set(
      1 - 2 * n.x * n.x, -2 * n.x * n.y, -2 * n.x * n.z, 2 * d * n.x,
      -2 * n.x * n.y, 1 - 2 * n.y * n.y, -2 * n.y * n.z, 2 * d * n.y,
      -2 * n.x * n.z, -2 * n.y * n.z, 1 - 2 * n.z * n.z, 2 * d * n.z,
      0, 0, 0, 1);
    virtual.matrixAutoUpdate = virtual.matrixWorldAutoUpdate = false;
    virtual.matrixWorld.multiplyMatrices(reflect, camera.matrixWorld);
    virtual.matrixWorldInverse.multiplyMatrices(camera.matrixWorldInverse, reflect);
    virtual.position.setFromMatrixPosition(virtual.matrixWorld);
    // The near plane is a millimetre before the mirror: what stands behind, its own back too, is not seen. [Lengyel05]
    const plane = new THREE.Plane(n.clone(), -d - 1e-3 / this.header.metresPerUnit).applyMatrix4(virtual.matrixWorldInverse);
    const P = virtual.projectionMatrix.elements;
    const q = new THREE.Vector4((Math.sign(plane.normal.x) + P[8]) / P[0], (Math.sign(plane.normal.y) + P[9]) / P[5], -1, (1 + P[10]) / P[14]);
    const c = new THREE.Vector4(plane.normal.x, plane.normal.y, plane.normal.z, plane.constant);
    c.multiplyScalar(2 / c.dot(q));
    P[2] = c.x, P[6] = c.y, P[10] = c.z + 1, P[14] = c.w;
    for (let column = 0; column < 4; ++column) P[4 * column] *= -1;
    virtual.projectionMatrixInverse.copy(virtual.projectionMatrix).invert();
    const frame = this.frameOf(camera).map((v) => v.addScaledVector(n, -2 * n.dot(v)));
    frame[1].negate();
    this.drawWorld(virtual, target, frame);
  }

  /** Surfaces alone: programs of panes, caustics and mirrors are left to the picture after the first. */
  drawFirst(state) {
    this.draw(state, (object) => object.renderOrder === 0, 0);
    this.smoothEdges();
  }

  draw({ ev, falseColour: on, top, linearTone }, shows = () => true, mirrors = 2) {
    this.camera.updateMatrixWorld();
    this.shared.showsIrradiance.value = on;
    for (const object of this.world.children) object.visible = shows(object) && !(on && object.userData.pane);
    if (!on) this.drawMirrors(mirrors);
    this.drawWorld(this.camera, this.target);
    const { uniforms } = this.shown;
    uniforms.exposure.value = 2 ** ev;
    uniforms.top.value = top;
    uniforms.linearTone.value = linearTone;
    this.renderer.setRenderTarget(null);
    this.renderer.render(this.shown.scene, this.camera);
  }

  /** Pixels of the picture as it is, four linear floats each, first row at the bottom; about `width` columns of it. */
  readPicture(width = 96) {
    const height = Math.max(Math.round(width / this.camera.aspect), 1);
    const small = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType });
    this.drawWorld(this.camera, small);
    const out = new Float32Array(4 * width * height);
    this.renderer.readRenderTargetPixels(small, 0, 0, width, height, out);
    this.renderer.setRenderTarget(null);
    small.dispose();
    return out;
  }

  /** The exposure for what is in sight: log-average luminance at 0.18. [Reinhard02 (1, 2)] */
  automaticEv() {
    this.shared.showsIrradiance.value = false;
    const pixels = this.readPicture(), Y = [];
    for (let i = 0; i < pixels.length; i += 4) {
      const y = gray([pixels[i], pixels[i + 1], pixels[i + 2]]);
      if (y > 0) Y.push(y);
    }
    if (Y.length === 0) return 0;
    const mean = Math.exp(Y.reduce((s, y) => s + Math.log(y), 0) / Y.length);
    Y.sort((a, b) => a - b);
    const most = Y[Math.floor(0.9 * (Y.length - 1))];
    return Math.round(10 * Math.min(Math.log2(0.18 / mean), Math.log2(1 / most))) / 10;
  }

  /** The lux that 99.5 % of what is in sight stays below. */
  automaticTop() {
    this.shared.showsIrradiance.value = true;
    const pixels = this.readPicture(), lux = [];
    for (let i = 0; i < pixels.length; i += 4)
      if (pixels[i + 3] > 0.5) lux.push(this.header.efficacy * gray([pixels[i], pixels[i + 1], pixels[i + 2]]));
    lux.sort((a, b) => a - b);
    return lux.length ? lux[Math.floor(0.995 * (lux.length - 1))] : 1000;
  }
}
