// Light is linear in the groups: one accumulated irradiance per vertex, into which a change of a weight is added. Layers
// stay as words, and are unpacked when their group first shines: the first picture waits for no other.
import { addRgb9e5, decodeRgb9e5, joinRgb9e5 } from './payload.js';

export class Relight {
  constructor(groups, count) {
    this.layers = Array.from({ length: groups }, () => null);
    this.weights = this.layers.map(() => [0, 0, 0]);
    this.E = new Float32Array(3 * count);
    this.layerOf = null;
  }

  static of({ header }) {
    return new Relight(header.groups.length, header.vertexCount);
  }

  /** Shows a sum that is known for these weights, until the groups are there. */
  begin(weights, words) {
    this.weights = weights;
    addRgb9e5(words, [1, 1, 1], this.E);
  }

  /** Groups are there from now on. layerOf(g): a group's irradiance, a word of RGB9E5 a vertex. */
  take(layerOf) {
    this.layerOf = layerOf;
    this.setWeights(this.weights);
  }

  layer(g) {
    return (this.layers[g] ??= this.layerOf(g));
  }

  /** Takes over one weight: what it differs by is added. */
  setWeight(g, weight) {
    const change = weight.map((v, c) => v - this.weights[g][c]);
    this.weights[g] = weight;
    if (this.layerOf && change.some((v) => v !== 0)) addRgb9e5(this.layer(g), change, this.E);
  }

  /** Takes over all weights and sums anew, without what adding has left of rounding. */
  setWeights(weights) {
    this.weights = weights;
    if (!this.layerOf) return;
    this.E.fill(0);
    weights.forEach((w, g) => {
      if (w.some((v) => v !== 0)) addRgb9e5(this.layer(g), w, this.E);
    });
  }

  /** Irradiance by group at a point of a triangle: corners are vertices, `at` barycentric. */
  groupsAt(corners, at) {
    return this.weights.map((weight, g) => {
      const E = [0, 0, 0];
      if (!weight.some((v) => v !== 0)) return E;
      const found = decodeRgb9e5(corners.map((v) => this.layer(g)[v]));
      for (let k = 0; k < 3; ++k)
        for (let c = 0; c < 3; ++c) E[c] += at[k] * found[3 * k + c] * weight[c];
      return E;
    });
  }
}
