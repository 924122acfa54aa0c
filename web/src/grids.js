// Measuring points, evaluated by `deltalux probe`'s own meters at export, per group: Em, U0 and Ud are sums of columns.
import { gray } from './colour.js';

export class Grids {
  constructor({ header, section }) {
    this.grids = header.points.grids;
    this.count = header.points.count;
    this.efficacy = header.efficacy;
    this.places = this.count ? section('points.places', Float32Array) : new Float32Array();
    this.light = this.count ? section('points.light', Float32Array) : new Float32Array();  // group, point, channel
  }

  /** Lux at every point. */
  lux(weights) {
    const out = new Float64Array(this.count), { light, count } = this;
    weights.forEach((w, g) => {
      for (let i = 0; i < count; ++i) {
        const at = 3 * (g * count + i);
        out[i] += this.efficacy * gray([w[0] * light[at], w[1] * light[at + 1], w[2] * light[at + 2]]);
      }
    });
    return out;
  }

  /** Of each grid: {name, Em, Emin, Emax, U0, Ud}. */
  figures(weights) {
    const lux = this.lux(weights);
    return this.grids.map(({ name, points }) => {
      const values = points.map((i) => lux[i]);
      const Em = values.reduce((s, v) => s + v, 0) / values.length;
      const Emin = Math.min(...values), Emax = Math.max(...values);
      return { name, Em, Emin, Emax, U0: Em > 0 ? Emin / Em : 0, Ud: Emax > 0 ? Emin / Emax : 0 };
    });
  }
}
