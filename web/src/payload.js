// The solution as `deltalux export` packs it (src/export/page_data.hpp has the same table):
// base64 of gzip of: u32 length of the header, the header (JSON), zeros up to a multiple of 4, sections.
// header.sections: name -> [offset from the end of the zeros, bytes].

async function inflate(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

/** The payload of an element: {header, section(name, Type)}; sections are views into one buffer. */
export async function readPayload(element) {
  const text = element.textContent.trim();
  if (text.startsWith('@')) throw new Error('This is the empty template: deltalux export puts a solution into it.');
  performance.mark('found');
  const buffer = await inflate(text);
  performance.mark('inflated');
  element.textContent = '';
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const start = Math.ceil((4 + length) / 4) * 4;
  return {
    header,
    section(name, Type) {
      const [offset, bytes] = header.sections[name];
      return new Type(buffer, start + offset, bytes / Type.BYTES_PER_ELEMENT);
    },
  };
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

/** RGB9E5 words from planes of what they differ in from their colour before (src/export/byte_planes.hpp). */
export function joinRgb9e5(bytes, count) {
  const words = new Uint32Array(count);
  let e0 = 0, r0 = 0, g0 = 0, b0 = 0;
  for (let i = 0; i < count; ++i) {
    const high = bytes[4 * count + i], e = (e0 + bytes[i]) & 255;
    let z = bytes[2 * count + i] | ((high & 12) << 6);
    const scaled = e === e0 ? g0 : Math.min(Math.floor(g0 * 2 ** (e0 - e) + 0.5), 511);
    const g = scaled + ((z >>> 1) ^ -(z & 1));
    z = bytes[count + i] | ((high & 3) << 8);
    const r = (g0 > 0 ? Math.min(Math.floor((r0 * g) / g0 + 0.5), 511) : r0) + ((z >>> 1) ^ -(z & 1));
    z = bytes[3 * count + i] | ((high & 48) << 4);
    const b = (g0 > 0 ? Math.min(Math.floor((b0 * g) / g0 + 0.5), 511) : b0) + ((z >>> 1) ^ -(z & 1));
    words[i] = ((e << 27) | (b << 18) | (g << 9) | r) >>> 0;
    e0 = e, r0 = r, g0 = g, b0 = b;
  }
  return words;
}
