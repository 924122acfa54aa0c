// What the dimmers say: per group {on, dim, kelvin or null, colour or null}, and the weight of its light that follows.
import { blackBody, fromHex, gray, tint } from './colour.js';

/** The state in which the scene was exported. */
export function initialDimmer(group) {
  const dim = Math.max(...group.weight);
  return { on: dim > 0, dim: dim > 0 ? dim : 1, kelvin: null, colour: null };
}

/** The colour that a group's light has, and by what it is multiplied for that. */
function ownTint(group) {
  const most = Math.max(...group.weight);
  return most > 0 ? group.weight.map((v) => v / most) : [1, 1, 1];
}

/** Weight of a group's light at scale 1, per channel. Colour leaves its luminance as it is. */
export function weightOf(group, dimmer) {
  if (!dimmer.on) return [0, 0, 0];
  const own = ownTint(group);
  const light = own.map((v, c) => v * group.colour[c]);
  const wanted = dimmer.kelvin ? blackBody(dimmer.kelvin) : dimmer.colour ? fromHex(dimmer.colour) : null;
  if (!wanted || !(gray(wanted) > 0)) return own.map((v) => v * dimmer.dim);
  const t = tint(light, wanted);
  return own.map((v, c) => v * t[c] * dimmer.dim);
}

export const sameWeight = (a, b) => a.every((v, c) => Math.abs(v - b[c]) <= 1e-6 * Math.max(1, Math.abs(b[c])));

/**
 * The dimmers as an edits file of `deltalux update`: of the lights of groups that are not as they were exported.
 * `rgb` is absolute (1 1 1: the light as it was read), so the file fits whatever the scene is dimmed to.
 */
export function editsOf(groups, dimmers) {
  const edits = [];
  groups.forEach((group, g) => {
    const weight = weightOf(group, dimmers[g]);
    if (sameWeight(weight, group.weight)) return;
    for (const light of group.lights)
      if (!dimmers[g].on) {
        edits.push({ op: 'light', light: light.name, on: false });
      } else {
        if (light.off) edits.push({ op: 'light', light: light.name, on: true });
        edits.push({ op: 'light', light: light.name, rgb: weight.map((v, c) => Number((v * light.base[c]).toPrecision(6))) });
      }
  });
  // A name means all below it, too: the general before the particular.
  edits.sort((a, b) => a.light.length - b.light.length);
  return { edits };
}
