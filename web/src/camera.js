// Orbit about a point, or walk: W A S D and drag.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

export class Eye {
  constructor(camera, element, header, changed) {
    this.camera = camera;
    this.metre = 1 / header.metresPerUnit;
    this.changed = changed;
    this.up = new THREE.Vector3().fromArray(header.up);
    this.sceneUp = this.up.clone();
    this.element = element;
    this.walking = false;
    this.controls();
    this.keys = new Set();
    this.listen(element);
  }

  /** OrbitControls learn once what is up. */
  controls() {
    this.orbit?.dispose();
    this.camera.up.copy(this.up);
    this.orbit = new OrbitControls(this.camera, this.element);
    this.orbit.enableDamping = false;
    this.orbit.zoomToCursor = true;
    this.orbit.enabled = !this.walking;
    this.orbit.addEventListener('change', this.changed);
  }

  listen(element) {
    let from = null;
    element.addEventListener('pointerdown', (e) => {
      if (this.walking) from = [e.clientX, e.clientY], element.setPointerCapture(e.pointerId);
    });
    element.addEventListener('pointerup', () => (from = null));
    element.addEventListener('pointermove', (e) => {
      if (!this.walking || !from) return;
      const perPixel = (this.camera.fov * Math.PI) / 180 / element.clientHeight;
      this.turn((from[0] - e.clientX) * -perPixel, (from[1] - e.clientY) * -perPixel);
      from = [e.clientX, e.clientY];
    });
    const walkKeys = ['KeyW', 'KeyA', 'KeyS', 'KeyD', 'KeyQ', 'KeyE', 'ArrowUp', 'ArrowDown', 'ArrowLeft', 'ArrowRight'];
    window.addEventListener('keydown', (e) => {
      if (!this.walking || e.target.matches?.('input, select, textarea') || e.ctrlKey || e.metaKey) return;
      if (!walkKeys.includes(e.code)) return;
      e.preventDefault();
      if (this.keys.size === 0) this.last = performance.now(), requestAnimationFrame((t) => this.step(t));
      this.keys.add(e.code);
      this.fast = e.shiftKey;
    });
    window.addEventListener('keyup', (e) => this.keys.delete(e.code));
    window.addEventListener('blur', () => this.keys.clear());
  }

  forward() {
    return this.camera.getWorldDirection(new THREE.Vector3());
  }

  /** Angles in radians: to the right, and up. */
  turn(yaw, pitch) {
    const d = this.forward(), right = d.clone().cross(this.up).normalize();
    const height = Math.asin(Math.min(Math.max(d.dot(this.up), -1), 1));
    pitch = Math.min(Math.max(height + pitch, -1.5), 1.5) - height;
    d.applyAxisAngle(right, pitch).applyAxisAngle(this.up, -yaw);
    this.look(this.camera.position, d);
  }

  step(now) {
    if (this.keys.size === 0) return;
    const seconds = Math.min((now - this.last) / 1000, 0.1), has = (...names) => names.some((n) => this.keys.has(n));
    this.last = now;
    const d = this.forward(), ahead = d.clone().addScaledVector(this.up, -d.dot(this.up)).normalize();
    const right = ahead.clone().cross(this.up), by = seconds * this.metre * (this.fast ? 4 : 1.4);
    const move = new THREE.Vector3();
    if (has('KeyW', 'ArrowUp')) move.add(ahead);
    if (has('KeyS', 'ArrowDown')) move.sub(ahead);
    if (has('KeyD', 'ArrowRight')) move.add(right);
    if (has('KeyA', 'ArrowLeft')) move.sub(right);
    if (has('KeyE')) move.add(this.up);
    if (has('KeyQ')) move.sub(this.up);
    this.look(this.camera.position.clone().addScaledVector(move, by), d);
    requestAnimationFrame((t) => this.step(t));
  }

  /** Orbits about what the ray of the middle meets, at `distance`. */
  look(position, direction, distance = this.distance ?? 3 * this.metre) {
    this.distance = distance;
    this.camera.position.copy(position);
    this.orbit.target.copy(position).addScaledVector(direction.clone().normalize(), distance);
    this.camera.lookAt(this.orbit.target);
    this.orbit.update();
    this.changed();
  }

  walk(on) {
    this.walking = on;
    this.orbit.enabled = !on;
    this.keys.clear();
  }

  /** {position, direction, up, angle}: angle is the full vertical one in degrees; up may be left out where it is the scene's. */
  get view() {
    const round = (v) => v.toArray().map((x) => Number(x.toFixed(4)));
    const up = this.up.equals(this.sceneUp) ? {} : { up: round(this.up) };
    return { position: round(this.camera.position), direction: round(this.forward()), ...up, angle: Number(this.camera.fov.toFixed(2)) };
  }

  set view({ position, direction, up, angle }) {
    const now = up ? new THREE.Vector3().fromArray(up) : this.sceneUp;
    // Views that tilt a little look straight all the same.
    const kept = now.dot(this.sceneUp) > 0.5 ? this.sceneUp : now;
    if (!kept.equals(this.up)) this.up.copy(kept), this.controls();
    this.camera.fov = angle;
    this.camera.updateProjectionMatrix();
    this.look(new THREE.Vector3().fromArray(position), new THREE.Vector3().fromArray(direction));
  }
}
