// Rays against triangles: a tree of boxes over them, cut at the middle of the longest side.

const kLeaf = 8;

export class TriangleTree {
  /** positions: three floats a vertex; triangles: three indices each. */
  constructor(positions, triangles) {
    this.positions = positions;
    this.triangles = triangles;
    const count = triangles.length / 3;
    this.order = Uint32Array.from({ length: count }, (_, i) => i);
    const middles = new Float32Array(3 * count);
    this.bounds = [];  // six numbers a node
    this.nodes = [];   // first, count (leaf) or child, 0
    for (let i = 0; i < count; ++i) {
      const a = 3 * triangles[3 * i], b = 3 * triangles[3 * i + 1], d = 3 * triangles[3 * i + 2];
      for (let c = 0; c < 3; ++c) {
        const p = positions[a + c], q = positions[b + c], r = positions[d + c];
        middles[3 * i + c] = (Math.min(p, q, r) + Math.max(p, q, r)) / 2;
      }
    }
    this.middles = middles;
    if (count > 0) {
      this.addNode();
      this.build(0, 0, count);
    }
    this.middles = null;
    this.bounds = Float32Array.from(this.bounds);
    this.nodes = Uint32Array.from(this.nodes);
  }

  addNode() {
    this.nodes.push(0, 0);
    for (let k = 0; k < 6; ++k) this.bounds.push(0);
    return this.nodes.length / 2 - 1;
  }

  build(root, first0, end0) {
    const { positions, triangles, order, middles } = this;
    const stack = [[root, first0, end0]];
    while (stack.length) {
      const [node, first, end] = stack.pop();
      const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
      const lowM = [...low], highM = [...high];
      for (let i = first; i < end; ++i) {
        const t = order[i];
        for (let c = 0; c < 3; ++c) {
          for (let k = 0; k < 3; ++k) {
            const v = positions[3 * triangles[3 * t + k] + c];
            if (v < low[c]) low[c] = v;
            if (v > high[c]) high[c] = v;
          }
          const m = middles[3 * t + c];
          if (m < lowM[c]) lowM[c] = m;
          if (m > highM[c]) highM[c] = m;
        }
      }
      for (let c = 0; c < 3; ++c) {
        this.bounds[6 * node + c] = low[c];
        this.bounds[6 * node + 3 + c] = high[c];
      }
      const size = [0, 1, 2].map((c) => highM[c] - lowM[c]);
      const axis = size.indexOf(Math.max(...size));
      let middle = first;
      if (end - first > kLeaf && size[axis] > 0) {
        const at = (lowM[axis] + highM[axis]) / 2;
        for (let i = first; i < end; ++i)
          if (middles[3 * order[i] + axis] < at) {
            const t = order[i];
            order[i] = order[middle];
            order[middle++] = t;
          }
      }
      if (middle === first || middle === end) {
        this.nodes[2 * node] = first;
        this.nodes[2 * node + 1] = end - first;
        continue;
      }
      const child = this.addNode();
      this.addNode();
      this.nodes[2 * node] = child;
      this.nodes[2 * node + 1] = 0;
      stack.push([child, first, middle], [child + 1, middle, end]);
    }
  }

  /** visit({triangle, distance, at}) for hits of front sides between the distances; its answer is the new farthest. */
  cast(origin, direction, nearest, farthest, visit) {
    if (this.nodes.length === 0) return;
    const { nodes, bounds, order, positions, triangles } = this;
    const inverse = direction.map((d) => 1 / d);
    const stack = [0];
    while (stack.length) {
      const node = stack.pop();
      let a = nearest, b = farthest;
      for (let c = 0; c < 3; ++c) {
        let t0 = (bounds[6 * node + c] - origin[c]) * inverse[c], t1 = (bounds[6 * node + 3 + c] - origin[c]) * inverse[c];
        if (t0 > t1) [t0, t1] = [t1, t0];
        if (t0 > a) a = t0;
        if (t1 < b) b = t1;
      }
      if (a > b + 1e-6 * Math.abs(b)) continue;
      const first = nodes[2 * node], count = nodes[2 * node + 1];
      if (count === 0) {
        stack.push(first, first + 1);
        continue;
      }
      for (let i = first; i < first + count; ++i) {
        const hit = meet(positions, triangles, order[i], origin, direction);
        if (hit && hit.distance >= nearest && hit.distance <= farthest) farthest = visit(hit) ?? farthest;
      }
    }
  }

  /** The nearest hit, or null; `accepts(triangle)` may refuse some. */
  nearest(origin, direction, accepts = () => true) {
    let found = null;
    this.cast(origin, direction, 1e-5, Infinity, (hit) => {
      if (!accepts(hit.triangle)) return undefined;
      found = hit;
      return hit.distance;
    });
    return found;
  }
}

/** Of a ray and the front side of a triangle [MT97]: its distance and barycentric place. */
function meet(p, triangles, t, o, d) {
  const a = 3 * triangles[3 * t], b = 3 * triangles[3 * t + 1], c = 3 * triangles[3 * t + 2];
  const e1x = p[b] - p[a], e1y = p[b + 1] - p[a + 1], e1z = p[b + 2] - p[a + 2];
  const e2x = p[c] - p[a], e2y = p[c + 1] - p[a + 1], e2z = p[c + 2] - p[a + 2];
  const hx = d[1] * e2z - d[2] * e2y, hy = d[2] * e2x - d[0] * e2z, hz = d[0] * e2y - d[1] * e2x;
  const det = e1x * hx + e1y * hy + e1z * hz;
  if (!(det > 0)) return null;
  const sx = o[0] - p[a], sy = o[1] - p[a + 1], sz = o[2] - p[a + 2];
  const u = (sx * hx + sy * hy + sz * hz) / det;
  if (u < -1e-7 || u > 1 + 1e-7) return null;
  const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
  const v = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
  if (v < -1e-7 || u + v > 1 + 1e-7) return null;
  return { triangle: t, distance: (e2x * qx + e2y * qy + e2z * qz) / det, at: [1 - u - v, u, v] };
}
