// Colour: luminance, colour temperature, tone mapping's numbers and the scale of false colour, as the library has them.

export const luminanceWeights = [0.265, 0.67, 0.065];
export const gray = (c) => 0.265 * c[0] + 0.67 * c[1] + 0.065 * c[2];

// XYZ to Radiance's primaries (.640 .330, .290 .600, .150 .060) with equal energy as white.
const fromXyz = (() => {
  const xy = [[0.64, 0.33], [0.29, 0.6], [0.15, 0.06]];
  const columns = xy.map(([x, y]) => [x / y, 1, (1 - x - y) / y]);
  const m = [0, 1, 2].map((row) => columns.map((c) => c[row]));
  const inverse = invert(m);
  const white = inverse.map((row) => row[0] + row[1] + row[2]);
  return inverse.map((row, i) => row.map((v) => v / white[i]));
})();

function invert(m) {
  const [a, b, c] = m[0], [d, e, f] = m[1], [g, h, i] = m[2];
  const A = e * i - f * h, B = f * g - d * i, C = d * h - e * g, det = a * A + b * B + c * C;
  return [
    [A / det, (c * h - b * i) / det, (b * f - c * e) / det],
    [B / det, (a * i - c * g) / det, (c * d - a * f) / det],
    [C / det, (b * g - a * h) / det, (a * e - b * d) / det],
  ];
}

/** Linear RGB of a black body, of luminance 1; Kim et al.'s cubics for its chromaticity, 1667 to 25000 K. */
export function blackBody(kelvin) {
  const t = 1000 / Math.min(Math.max(kelvin, 1667), 25000);
  const x = kelvin <= 4000
    ? ((-0.2661239 * t - 0.234358) * t + 0.8776956) * t + 0.17991
    : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.24039;
  const y = kelvin <= 2222
    ? ((-1.1063814 * x - 1.3481102) * x + 2.18555832) * x - 0.20219683
    : kelvin <= 4000
      ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
      : ((3.081758 * x - 5.8733867) * x + 3.75112997) * x - 0.37001483;
  const xyz = [x / y, 1, (1 - x - y) / y];
  const rgb = fromXyz.map((row) => Math.max(row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2], 0));
  const Y = gray(rgb);
  return rgb.map((v) => v / Y);
}

export const fromSrgb = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
export const toSrgb = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
export const fromHex = (hex) => [1, 3, 5].map((i) => fromSrgb(parseInt(hex.slice(i, i + 2), 16) / 255));
export function toHex(rgb) {
  const most = Math.max(...rgb, 1e-9);
  return '#' + rgb.map((v) => Math.round(255 * toSrgb(v / most)).toString(16).padStart(2, '0')).join('');
}

/** What to multiply light of colour `own` by for it to have the colour `wanted`, at the same luminance. */
export function tint(own, wanted) {
  const factor = own.map((v, c) => (v > 1e-4 * Math.max(...own) ? wanted[c] / v : 0));
  const Y = gray(own.map((v, c) => v * factor[c]));
  return Y > 0 ? factor.map((f) => (f * gray(own)) / Y) : [1, 1, 1];
}

/** Cubehelix as the library's falseColor(): t in [0,1] to bytes. */
export function falseColour(t) {
  const lambda = 0.08 + 0.87 * Math.min(Math.max(t, 0), 1);
  const phi = 2 * Math.PI * (0.5 / 3 + 1 - 1.5 * lambda), a = (1.2 * lambda * (1 - lambda)) / 2;
  const channel = (c, s) =>
    Math.round(255 * Math.min(Math.max(lambda + a * (c * Math.cos(phi) + s * Math.sin(phi)), 0), 1));
  return [channel(-0.14861, 1.78277), channel(-0.29227, -0.90649), channel(1.97294, 0)];
}

/** The smallest 1, 2 or 5 times a power of ten that is at least `v`. */
export function roundUp(v) {
  const decade = 10 ** Math.floor(Math.log10(v));
  return [1, 2, 5, 10].map((s) => s * decade).find((s) => s >= v * (1 - 1e-9));
}

/** "0.52", "4.31", "118", "12,400". */
export function luxText(lux) {
  if (!(lux >= 0)) return '-';
  if (lux >= 1000) return Math.round(lux).toLocaleString('en-GB');
  return lux >= 100 ? lux.toFixed(0) : lux >= 10 ? lux.toFixed(1) : lux.toFixed(2);
}
