// The lux under the cursor: what the mesh and the caustic textures show there, by group.
import { gray } from './colour.js';
import { decodeRgb9e5 } from './payload.js';
import { TriangleTree } from './pick.js';

export class Meter {
  constructor(drawing) {
    const { header, mesh, relight } = drawing;
    this.drawing = drawing;
    this.relight = relight;
    this.efficacy = header.efficacy;
    // Panes are looked through; draws of light from behind repeat triangles.
    const runs = header.draws.filter((d) => d.kind === 'opaque' || d.kind === 'mirror');
    const triangles = new Uint32Array(runs.reduce((n, d) => n + d.count, 0));
    let at = 0;
    for (const d of runs) {
      triangles.set(mesh.triangles.subarray(d.first, d.first + d.count), at);
      at += d.count;
    }
    this.tree = new TriangleTree(mesh.positions, triangles);
    this.caustics = drawing.caustics.map((c) => ({ ...c, tree: new TriangleTree(c.positions, c.triangles) }));
  }

  /** {position, normal, lux, groups: lux by group}; null where no surface is seen. */
  at(origin, direction) {
    const { tree } = this, hit = tree.nearest(origin, direction);
    if (!hit) return null;
    const corners = [0, 1, 2].map((k) => tree.triangles[3 * hit.triangle + k]);
    const E = this.relight.groupsAt(corners, hit.at);
    this.addCaustics(E, origin, direction, hit.distance);
    const groups = E.map((e) => this.efficacy * gray(e));
    const [a, b, c] = corners.map((v) => tree.positions.subarray(3 * v, 3 * v + 3));
    const normal = unit(cross(difference(b, a), difference(c, a)));
    const position = origin.map((o, c) => o + hit.distance * direction[c]);
    return { position, normal, lux: groups.reduce((s, v) => s + v, 0), groups, material: this.drawing.mesh.materials[corners[0]] };
  }

  addCaustics(E, origin, direction, distance) {
    const slack = 1e-4 * distance + 5e-4 / this.drawing.header.metresPerUnit;
    for (const c of this.caustics) {
      let best = null;
      c.tree.cast(origin, direction, distance - slack, distance + slack, (hit) => {
        const place = [0, 1].map((k) => hit.at.reduce((s, w, j) => s + w * c.texels[2 * c.triangles[3 * hit.triangle + j] + k], 0));
        if (texelShows(c, place)) best = place;
      });
      if (!best) continue;
      const found = texelAt(c, best), w = this.relight.weights[c.group];
      for (let k = 0; k < 3; ++k) E[c.group][k] += w[k] * found[k];
    }
  }
}

const difference = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((v) => v / Math.hypot(...a));
const clamp = (v, n) => Math.min(Math.max(v, 0), n - 1);

function texelShows({ width, height, shows }, [u, v]) {
  return shows[clamp(Math.floor(v * height), height) * width + clamp(Math.floor(u * width), width)] > 127;
}

function texelAt({ width, height, words }, [u, v]) {
  const x = u * width - 0.5, y = v * height - 0.5, i = Math.floor(x), j = Math.floor(y), out = [0, 0, 0];
  for (const [di, dj] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
    const w = (di ? x - i : 1 - x + i) * (dj ? y - j : 1 - y + j);
    const c = decodeRgb9e5([words[clamp(j + dj, height) * width + clamp(i + di, width)]]);
    for (let k = 0; k < 3; ++k) out[k] += w * c[k];
  }
  return out;
}
