// Light is linear in the groups: one accumulated irradiance per vertex, into which a change of a weight is added.
import { decodeRgb9e5, joinRgb9e5 } from './payload.js';

export class Relight {
  /** layers: per group three floats a vertex. */
  constructor(layers, count) {
    this.layers = layers;
    this.weights = layers.map(() => [0, 0, 0]);
    this.E = new Float32Array(3 * count);
  }

  static of(payload) {
    const { header } = payload;
    const layers = header.groups.map((_, g) =>
      decodeRgb9e5(joinRgb9e5(payload.section(`layer${g}`, Uint8Array), header.vertexCount)));
    return new Relight(layers, header.vertexCount);
  }

  add(g, [r, g_, b]) {
    const { E } = this, layer = this.layers[g];
    for (let i = 0; i < E.length; i += 3) {
      E[i] += r * layer[i];
      E[i + 1] += g_ * layer[i + 1];
      E[i + 2] += b * layer[i + 2];
    }
  }

  /** Takes over one weight: what it differs by is added. */
  setWeight(g, weight) {
    const change = weight.map((v, c) => v - this.weights[g][c]);
    this.weights[g] = weight;
    if (change.some((v) => v !== 0)) this.add(g, change);
  }

  /** Takes over all weights and sums anew, without what adding has left of rounding. */
  setWeights(weights) {
    this.weights = weights;
    this.E.fill(0);
    weights.forEach((w, g) => {
      if (w.some((v) => v !== 0)) this.add(g, w);
    });
  }

  /** Irradiance by group at a point of a triangle: corners are vertices, `at` barycentric. */
  groupsAt(corners, at) {
    return this.layers.map((layer, g) => {
      const E = [0, 0, 0];
      for (let k = 0; k < 3; ++k)
        for (let c = 0; c < 3; ++c) E[c] += at[k] * layer[3 * corners[k] + c] * this.weights[g][c];
      return E;
    });
  }
}
