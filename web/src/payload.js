// The solution as `deltalux export` packs it (src/export/page_data.hpp has the same table):
// base64 of gzip of: u32 length of the header, the header (JSON), zeros up to a multiple of 4, sections.
// header.sections: name -> [offset from the end of the zeros, bytes]. A second part has sections alone: header.later.

function fromBase64(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflate(base64) {
  const bytes = fromBase64(base64);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

const viewOf = (buffer, start, table) => (name, Type) => {
  const [offset, bytes] = table[name];
  return new Type(buffer, start + offset, bytes / Type.BYTES_PER_ELEMENT);
};

/** What the first picture needs, of an element: {header, section(name, Type)}; sections are views into one buffer. */
export async function readPayload(element) {
  const text = element.textContent.trim();
  if (text.startsWith('@')) throw new Error('This is the empty template: deltalux export puts a solution into it.');
  performance.mark('found');
  const buffer = await inflate(text);
  performance.mark('inflated');
  element.textContent = '';
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  return { header, section: viewOf(buffer, Math.ceil((4 + length) / 4) * 4, header.sections) };
}

/** The sections of the page's second part, when the browser has read it: section(name, Type). */
export async function readLater({ header }) {
  if (document.readyState === 'loading') await new Promise((done) => document.addEventListener('DOMContentLoaded', done, { once: true }));
  const element = document.getElementById('later'), buffer = await inflate(element.textContent.trim());
  element.textContent = '';
  return viewOf(buffer, 0, header.later);
}

/** Whole numbers from byte planes of zigzag differences: `count` numbers of `planes` bytes. */
export function undoDifferences(bytes, count, planes, out = new Int32Array(count), stride = 1, at = 0) {
  let value = 0;
  for (let i = 0; i < count; ++i) {
    let z = 0;
    for (let b = planes - 1; b >= 0; --b) z = (z << 8) | bytes[b * count + i];
    value += (z >>> 1) ^ -(z & 1);
    out[at + i * stride] = value;
  }
  return out;
}

const power = Float64Array.from({ length: 32 }, (_, e) => 2 ** (e - 24));  // mantissa of 9 bits, bias 15

/** RGB9E5 words to three floats each. */
export function decodeRgb9e5(words, out = new Float32Array(3 * words.length)) {
  for (let i = 0; i < words.length; ++i) {
    const w = words[i], s = power[w >>> 27];
    out[3 * i] = (w & 511) * s;
    out[3 * i + 1] = ((w >>> 9) & 511) * s;
    out[3 * i + 2] = ((w >>> 18) & 511) * s;
  }
  return out;
}

/** Adds RGB9E5 words, times a weight by channel, to three floats each. */
export function addRgb9e5(words, [r, g, b], E) {
  for (let i = 0, k = 0; i < words.length; ++i, k += 3) {
    const w = words[i], s = power[w >>> 27];
    E[k] += r * s * (w & 511);
    E[k + 1] += g * s * ((w >>> 9) & 511);
    E[k + 2] += b * s * ((w >>> 18) & 511);
  }
}

const step = Float64Array.from({ length: 63 }, (_, d) => 2 ** (d - 31));  // by difference of exponents, from -31

/** RGB9E5 words from planes of what they differ in from their colour before (src/export/byte_planes.hpp). */
export function joinRgb9e5(bytes, count) {
  const words = new Uint32Array(count);
  let e0 = 0, r0 = 0, g0 = 0, b0 = 0;
  for (let i = 0; i < count; ++i) {
    const high = bytes[4 * count + i], e = (e0 + bytes[i]) & 255;
    let z = bytes[2 * count + i] | ((high & 12) << 6);
    const scaled = e === e0 ? g0 : Math.min(g0 * step[e0 - e + 31] + 0.5, 511) | 0;
    const g = scaled + ((z >>> 1) ^ -(z & 1));
    z = bytes[count + i] | ((high & 3) << 8);
    // Where green is as before, so are the others but for what is told.
    const same = g === g0 || g0 === 0;
    const r = (same ? r0 : Math.min((r0 * g) / g0 + 0.5, 511) | 0) + ((z >>> 1) ^ -(z & 1));
    z = bytes[3 * count + i] | ((high & 48) << 4);
    const b = (same ? b0 : Math.min((b0 * g) / g0 + 0.5, 511) | 0) + ((z >>> 1) ^ -(z & 1));
    words[i] = (e << 27) | (b << 18) | (g << 9) | r;
    e0 = e, r0 = r, g0 = g, b0 = b;
  }
  return words;
}
