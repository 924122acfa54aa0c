// The scale of false colour: logarithmic, three decades, lux.
import { falseColour } from './colour.js';

export function drawLegend(canvas, top, decades) {
  const c = canvas.getContext('2d'), { width, height } = canvas, y0 = 26, y1 = height - 12, bar = 16;
  c.clearRect(0, 0, width, height);
  c.fillStyle = 'rgba(24,24,24,.85)';
  c.fillRect(0, 0, width, height);
  for (let y = y0; y < y1; ++y) {
    c.fillStyle = `rgb(${falseColour(1 - (y - y0) / (y1 - y0))})`;
    c.fillRect(8, y, bar, 1);
  }
  c.fillStyle = '#eee';
  c.font = '12px system-ui, sans-serif';
  c.fillText('lux', 8, 16);
  c.textBaseline = 'middle';
  for (let e = Math.floor(Math.log10(top) - decades); e <= Math.log10(top); ++e)
    for (const s of [1, 2, 5]) {
      const lux = s * 10 ** e, t = 1 + Math.log10(lux / top) / decades;
      if (t < -1e-9 || t > 1 + 1e-9) continue;
      const y = y1 - t * (y1 - y0);
      c.fillRect(8 + bar, y - 0.5, 4, 1);
      c.fillText(lux >= 1e4 ? `${lux / 1e3}k` : String(Number(lux.toPrecision(2))), 8 + bar + 8, y);
    }
}
