// The state in the URL's hash, as short as it can be read: v=x,y,z,dx,dy,dz,angle[,ux,uy,uz] & e=EV & f=top lux (false colour)
// & l=group:state;... (only those that are not as exported) & b=name:view;... (bookmarks)
const number = (x) => Number(Number(x).toFixed(4)).toString();

const viewText = ({ position, direction, angle, up = [] }) => [...position, ...direction, angle, ...up].map(number).join(',');
function viewOf(text) {
  const n = text.split(',').map(Number);
  if ((n.length !== 7 && n.length !== 10) || n.some((x) => !Number.isFinite(x))) return null;
  return { position: n.slice(0, 3), direction: n.slice(3, 6), angle: Math.min(Math.max(n[6], 5), 150), ...(n.length === 10 ? { up: n.slice(7) } : {}) };
}

const dimmerText = (d) => (d.on ? '' : '!') + number(d.dim) + (d.kelvin ? 'k' + d.kelvin : d.colour ? 'c' + d.colour.slice(1) : '');
function dimmerOf(text) {
  const m = /^(!?)([0-9.]+)(?:k(\d+)|c([0-9a-f]{6}))?$/.exec(text);
  if (!m) return null;
  return { on: !m[1], dim: Number(m[2]), kelvin: m[3] ? Number(m[3]) : null, colour: m[4] ? '#' + m[4] : null };
}

export function hashOf(state, initial) {
  const parts = [`v=${viewText(state.view)}`, `e=${number(state.ev)}`];
  if (state.falseColour && state.top) parts.push(`f=${number(state.top)}`);
  const lights = state.dimmers
    .map((d, g) => (dimmerText(d) === dimmerText(initial[g]) ? null : `${g}:${dimmerText(d)}`)).filter(Boolean);
  if (lights.length) parts.push(`l=${lights.join(';')}`);
  if (state.bookmarks.length)
    parts.push(`b=${state.bookmarks.map((b) => `${encodeURIComponent(b.name)}:${viewText(b.view)}`).join(';')}`);
  return '#' + parts.join('&');
}

/** What a hash says, as far as it can be read: any of view, ev, top, dimmers (by group), bookmarks. */
export function readHash(hash) {
  const out = { dimmers: {}, bookmarks: [] };
  for (const part of hash.replace(/^#/, '').split('&')) {
    const [key, value = ''] = part.split('=');
    if (key === 'v') out.view = viewOf(value);
    if (key === 'e' && value !== '' && Number.isFinite(Number(value))) out.ev = Number(value);
    if (key === 'f' && Number(value) > 0) out.top = Number(value);
    if (key === 'l')
      for (const item of value.split(';')) {
        const [g, text = ''] = item.split(':'), d = dimmerOf(text);
        if (d) out.dimmers[Number(g)] = d;
      }
    if (key === 'b')
      for (const item of value.split(';')) {
        const [name, text = ''] = item.split(':'), view = viewOf(text);
        if (view) out.bookmarks.push({ name: decodeURIComponent(name), view });
      }
  }
  return out;
}
