// The measuring points, as small discs in the colours of the scale.
import * as THREE from 'three';
import { falseColour } from './colour.js';

export class Marks {
  constructor(grids, header) {
    const geometry = new THREE.CircleGeometry(0.05 / header.metresPerUnit, 20);
    this.discs = new THREE.InstancedMesh(geometry, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, toneMapped: false }), grids.count);
    this.scene = new THREE.Scene();
    this.scene.add(this.discs);
    this.discs.frustumCulled = false;
    const z = new THREE.Vector3(0, 0, 1), p = grids.places;
    for (let i = 0; i < grids.count; ++i) {
      const n = new THREE.Vector3(p[6 * i + 3], p[6 * i + 4], p[6 * i + 5]);
      const at = new THREE.Vector3(p[6 * i], p[6 * i + 1], p[6 * i + 2]).addScaledVector(n, 0.004 / header.metresPerUnit);
      this.discs.setMatrixAt(i, new THREE.Matrix4().compose(at, new THREE.Quaternion().setFromUnitVectors(z, n), new THREE.Vector3(1, 1, 1)));
    }
  }

  show(lux, top, decades) {
    const c = new THREE.Color();
    lux.forEach((v, i) => {
      const t = v > 0 ? 1 + Math.log10(v / top) / decades : 0;
      this.discs.setColorAt(i, c.setRGB(...falseColour(t).map((b) => b / 255), THREE.LinearSRGBColorSpace));
    });
    if (this.discs.instanceColor) this.discs.instanceColor.needsUpdate = true;
  }
}
