#!/usr/bin/env python3
"""Flux that the sun of a Radiance scene, or where there is none its lamps, send over one mirror to the surfaces met
first behind it: L S D.

Geometry alone: uniform points on the mirror, uniform directions of the sun's disc or points on the lamps, panes passed
straight on both ways. Writes CSV: surface, area, flux of both sides and its standard error [W, with the scene's unit of
length]; TOTAL_mirror_output is what leaves the mirror.

usage: light_by_mirror.py SCENE.rad OUT.csv MIRROR SAMPLES [NAME_PARTS [SEED]]
MIRROR: an identifier, or its first parts; SAMPLES in all, shared by the mirror's faces by their area."""
import math, sys

import numpy as np

from mirror_flux import BATCHES, GLASS, LIGHT, MIRROR, Geometry, Materials, Scene, dot, frame, reflect


def straight(g, m, o, d, reach):
    """What panes leave of light that goes straight from `o` along `d` for `reach`, and what it meets before: -1 if
    nothing."""
    left = np.ones((len(o), 3))
    o, met, alive, gone = o.copy(), np.full(len(o), -1), np.arange(len(o)), np.zeros(len(o))
    while len(alive):
        t, prim = g.cast(o[alive], d[alive])
        ok = (prim >= 0) & (gone[alive] + t < reach[alive])
        alive, t, prim = alive[ok], t[ok], prim[ok]
        pane = m.kind[prim] == GLASS
        met[alive[~pane]] = prim[~pane]
        alive, t, prim = alive[pane], t[pane], prim[pane]
        o[alive] += t[:, None] * d[alive]
        gone[alive] += t
        n = g.normal(prim, o[alive])
        left[alive] *= m.pane(prim, np.abs(dot(d[alive], n)))[1]
    return left, met


def arrivals(g, m, scene, at, n, rng):
    """Irradiance at the mirror's points, one sample of every light, as (direction, value) pairs."""
    for direction, angle, radiance in scene.suns:
        half = math.radians(angle / 2)
        u = rng.random((len(at), 2))
        c = 1 - u[:, 0] * (1 - math.cos(half))
        s = np.sqrt(1 - c * c)
        axis = np.tile(direction, (len(at), 1))
        x, y = frame(axis)
        phi = 2 * math.pi * u[:, 1:]
        d = s[:, None] * (np.cos(phi) * x + np.sin(phi) * y) + c[:, None] * axis
        solid = 2 * math.pi * (1 - math.cos(half))
        left, met = straight(g, m, at, d, np.full(len(at), np.inf))
        yield d, left * np.where(met < 0, np.maximum(0, dot(d, n)), 0)[:, None] * solid * radiance
    for i in [] if scene.suns else np.flatnonzero(m.kind == LIGHT):
        kind, radiance = scene.prims[i][1]
        if kind != 'light':
            raise SystemExit('a ' + kind)
        p = np.zeros((0, 3))
        while len(p) < len(at):
            p = np.concatenate([p, g.sample(i, rng.random((len(at), 2)))])
        p = p[:len(at)]
        d = p - at
        r = np.linalg.norm(d, axis=1)
        d /= r[:, None]
        cosines = np.maximum(0, dot(d, n)) * np.maximum(0, -dot(d, g.normal(np.full(len(at), i), p)))
        left, met = straight(g, m, at, d, r * (1 - 1e-9) - 1e-9)
        value = np.where((met < 0) | (met == i), cosines / r ** 2, 0) * g.area[i]
        yield d, left * value[:, None] * radiance[:3]


def run(scene_path, out_path, mirror, samples, parts, seed):
    scene = Scene(scene_path)
    g, m = Geometry(scene.prims), Materials(scene.prims)
    rng = np.random.default_rng(seed)
    faces = [i for i, p in enumerate(scene.prims)
             if m.kind[i] == MIRROR and (p[2] == mirror or p[2].startswith(mirror + '.'))]
    if not faces:
        raise SystemExit('no mirror ' + mirror)
    names = ['.'.join(p[2].split('.')[:parts]) for p in scene.prims]
    groups = sorted(set(names))
    group = np.array([groups.index(x) for x in names])
    area = np.bincount(group, weights=g.area, minlength=len(groups))
    flux, output, total = np.zeros((BATCHES, len(groups), 3)), np.zeros((BATCHES, 3)), g.area[faces].sum()
    for b in range(BATCHES):
        for i in faces:
            count = int(samples / BATCHES * g.area[i] / total)
            at = np.zeros((0, 3))
            while len(at) < count:
                at = np.concatenate([at, g.sample(i, rng.random((count, 2)))])
            at = at[:count]
            n = g.normal(np.full(count, i), at)
            for d, value in arrivals(g, m, scene, at, n, rng):
                value = value * m.specular[i] * g.area[i] / count
                k = np.flatnonzero(value.any(axis=1))
                output[b] += value[k].sum(0)
                left, met = straight(g, m, at[k], reflect(-d[k], n[k]), np.full(len(k), np.inf))
                hit = met >= 0
                for c in range(3):
                    flux[b, :, c] += np.bincount(group[met[hit]], weights=(value[k] * left)[hit, c],
                                                 minlength=len(groups))
    with open(out_path, 'w') as f:
        f.write('surface,area,Phi_r,Phi_g,Phi_b,se_r,se_g,se_b\n')

        def row(name, a, v):
            mean, se = v.mean(0), v.std(0, ddof=1) / math.sqrt(BATCHES)
            f.write('%s,%.7g,%s,%s\n' % (name, a, ','.join('%.6g' % q for q in mean), ','.join('%.3g' % q for q in se)))
        row('TOTAL_mirror_output', total, output)
        for i in np.argsort(-flux.sum((0, 2))):
            if flux[:, i].any():
                row(groups[i], area[i], flux[:, i])


if __name__ == '__main__':
    if len(sys.argv) < 5:
        raise SystemExit(__doc__)
    extra = [int(x) for x in sys.argv[5:]] + [1, 1][len(sys.argv) - 5:]
    run(sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4]), *extra)
