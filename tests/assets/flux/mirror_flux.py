#!/usr/bin/env python3
"""Flux that each surface of a Radiance scene gets from diffusely reflecting surfaces by way of mirrors, polished or
rough lobes, reflecting panes and refracting bodies: D S+ D, straight passage through panes not counted as an S.

Independent of the library but for the irradiance at the senders, which `deltalux reference` gives. Paths start on the
specular surfaces, one half towards the receiver (cosine-distributed), the other (sampled by the material) towards the
sender; a path over several specular surfaces could start on each, which the balance heuristic [Veach97] allows for:
path value / sum of the densities of all its starts. Rays meet the true shapes, in double precision, by trial of all
whose bounding spheres they cross. Needs numpy. Writes CSV: surface, area, flux of both sides and its standard error
[W, with the scene's unit of length].

usage: mirror_flux.py DELTALUX SCENE.rad OUT.csv PATHS [NAME_PARTS [SAMPLES [SEED]]]
NAME_PARTS: parts of a dotted identifier that name a surface (1); SAMPLES: of the reference at each sender (16)."""
import csv, math, os, re, shlex, subprocess, sys, tempfile

import numpy as np

BATCHES = 20  # independent, for the standard error


# ---- reading ----------------------------------------------------------------------------------------------------
def transform(words):
    """Name prefix, and matrices with their scales, one a copy, of an xform command; takes its options off `words`."""
    name, blocks = None, [['-i', 1, []]]
    while words and words[0].startswith('-'):
        option = words.pop(0)
        m, s = np.eye(4), 1.0
        if option == '-n':
            name = words.pop(0)
            continue
        if option in ('-a', '-i'):
            blocks.append([option, int(words.pop(0)), []])
            continue
        if option == '-t':
            m[:3, 3] = [float(words.pop(0)) for _ in range(3)]
        elif option in ('-rx', '-ry', '-rz'):
            a = math.radians(float(words.pop(0)))
            i, j = {'x': (1, 2), 'y': (2, 0), 'z': (0, 1)}[option[2]]
            m[i, i] = m[j, j] = math.cos(a)
            m[i, j], m[j, i] = -math.sin(a), math.sin(a)
        elif option == '-s':
            s = float(words.pop(0))
            m[:3, :3] *= s
        elif option in ('-mx', '-my', '-mz'):
            k = 'xyz'.index(option[2])
            m[k, k] = -1
        else:
            raise SystemExit('xform ' + option)
        blocks[-1][2].append((m, s))
    result = [(np.eye(4), 1.0)]
    for kind, count, parts in blocks:
        powers = [(np.eye(4), 1.0)]
        for _ in range(count):
            for m, s in [powers[-1]]:
                for a, b in parts:
                    m, s = a @ m, s * b
                powers.append((m, s))
        chosen = powers[:count] if kind == '-a' else powers[count:]
        result = [(p @ m, q * s) for p, q in chosen for m, s in result]
    return name, result


def function(text, names):
    text = re.sub(r'\bPI\b', 'pi', text).replace('^', '**')
    return eval('lambda %s: %s' % (names, text), vars(math).copy())


def genbox(w):
    size, rest, out = np.array([float(x) for x in w[2:5]]), w[5:], []
    inset = float(rest[1]) if rest and rest[0] in ('-r', '-b') else 0.0
    at = lambda corner, axes: np.array([(size[k] - (inset if k in axes else 0)) if corner[k] else
                                        (inset if k in axes else 0.0) for k in range(3)])
    corners = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    edges = [(a, b) for n, a in enumerate(corners) for b in corners[n + 1:] if sum(map(abs, np.subtract(a, b))) == 1]

    def polygon(points):
        p = np.array(points)
        inwards = (p.mean(0) - size / 2) @ newell(p) < 0
        out.append(('polygon', (p if inwards == ('-i' in rest) else p[::-1]).ravel().tolist()))
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in (0, 1):
            ring = []
            for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
                c = [0, 0, 0]
                c[axis], c[u], c[v] = end, i, j
                ring.append(at(c, (u, v)))
            polygon(ring)
    if '-b' in rest:
        for a, b in edges:
            axis = int(np.argmax(np.abs(np.subtract(a, b))))
            u, v = (axis + 1) % 3, (axis + 2) % 3
            polygon([at(a, (axis, u)), at(b, (axis, u)), at(b, (axis, v)), at(a, (axis, v))])
        for c in corners:
            polygon([at(c, (0, 1)), at(c, (1, 2)), at(c, (0, 2))])
    if '-r' in rest:
        out += [('sphere', [*at(c, (0, 1, 2)), inset]) for c in corners]
        out += [('cylinder', [*at(a, (0, 1, 2)), *at(b, (0, 1, 2)), inset]) for a, b in edges]
    return out


def genprism(w):
    count = int(w[2])
    xy = np.array([float(x) for x in w[3:3 + 2 * count]]).reshape(-1, 2)
    rest, ends, completed, length = w[3 + 2 * count:], True, True, np.array([0, 0, 1.0])
    while rest:
        option = rest.pop(0)
        if option == '-e':
            ends = False
        elif option == '-c':
            completed = False
        elif option == '-l':
            length = np.array([float(rest.pop(0)) for _ in range(3)])
        else:
            raise SystemExit('genprism ' + option)
    low = np.column_stack([xy, np.zeros(count)])
    out = [('polygon', low.ravel().tolist()), ('polygon', (low[::-1] + length).ravel().tolist())] if ends else []
    for i in range(count if completed else count - 1):
        a, b = low[i], low[(i + 1) % count]
        out.append(('polygon', np.concatenate([a, a + length, b + length, b]).tolist()))
    return out


def genrev(w):
    z, r, count = function(w[2], 't'), function(w[3], 't'), int(w[4])
    out = []
    for i in range(count):
        z0, z1, r0, r1 = (f(t) for f in (z, r) for t in (i / count, (i + 1) / count))
        if abs(z1 - z0) <= 1e-9 and abs(r1 - r0) <= 1e-9:
            continue
        if abs(z1 - z0) <= 1e-9:
            out.append(('ring', [0, 0, z1, 0, 0, 1 if r1 < r0 else -1, r0, r1]))
        else:
            out.append(('cone' if z1 > z0 else 'cup', [0, 0, z0, 0, 0, z1, max(r0, 0.0), max(r1, 0.0)]))
    return out


def genworm(w):
    f = [function(text, 't') for text in w[2:6]]
    count, out, last = int(w[6]), [], None
    for i in range(count + 1):
        *c, r = (g(i / count) for g in f)
        c = np.array(c)
        if last is not None:
            p, q = last
            axis = c - p
            along, sine2 = axis * ((q - r) / (axis @ axis)), (q - r) ** 2 / (axis @ axis)
            if sine2 < 1:
                k = math.sqrt(1 - sine2)
                out.append(('cone', [*(p + q * along), *(c + r * along), k * q, k * r]))
        out.append(('sphere', [*c, r]))
        last = (c, r)
    return out


class Scene:
    def __init__(self, path):
        self.prims = []  # (type, material, name, numbers)
        self.materials = {}
        self.suns = []  # (direction, full angle in degrees, radiance)
        self.read(path, '', np.eye(4), 1.0)

    def read(self, path, prefix, m, s):
        with open(path) as file:
            lines = file.read().split('\n')
        here = os.path.dirname(os.path.abspath(path))
        tokens = []
        for line in lines:
            if line.startswith('!'):
                self.objects(tokens, prefix, m, s)
                tokens = []
                self.command(line[1:], here, prefix, m, s)
            else:
                tokens += line.split('#')[0].split()
        self.objects(tokens, prefix, m, s)

    def command(self, line, here, prefix, m, s):
        stages = [shlex.split(x) for x in line.split('|')]
        first = stages.pop(0)
        placed = [(prefix, m, s)]
        for words in reversed(stages + ([first] if first[0] == 'xform' else [])):
            words = list(words)
            assert words.pop(0) == 'xform'
            name, copies = transform(words)
            placed = [(p + (name + '.' if name else ''), a @ b, k * q) for p, a, k in placed for b, q in copies]
            rest = words
        if first[0] == 'xform':
            for p, a, k in placed:
                file = rest[0] if os.path.isabs(rest[0]) else os.path.join(here, rest[0])
                self.read(file, p, a, k)
        elif first[0] in GENERATORS:
            for kind, numbers in GENERATORS[first[0]](first[1:]):
                for p, a, k in placed:
                    self.add(kind, first[1], p + first[2], numbers, a, k)
        elif first[0] != 'gensky':
            raise SystemExit(first[0])

    def objects(self, t, prefix, m, s):
        i = 0
        while i < len(t):
            modifier, kind, name = t[i:i + 3]
            if kind == 'alias':
                self.materials[name] = self.materials[t[i + 3]]
                i += 4
                continue
            i += 3
            words = t[i + 1:i + 1 + int(t[i])]
            i += 1 + int(t[i])
            i += 1 + int(t[i])
            numbers = [float(x) for x in t[i + 1:i + 1 + int(t[i])]]
            i += 1 + int(t[i])
            if kind in MATERIALS:
                self.materials[name] = (kind, numbers)
            elif kind in SHAPES:
                self.add(kind, modifier, prefix + name, numbers, m, s)
            elif kind == 'source' and self.materials[modifier][0] == 'light':
                d = m[:3, :3] @ np.array(numbers[:3])
                self.suns.append((d / np.linalg.norm(d), numbers[3], np.array(self.materials[modifier][1][:3])))
            elif kind not in ('source', 'brightfunc'):
                raise SystemExit('a ' + kind)

    def add(self, kind, material, name, numbers, m, s):
        n = np.array(numbers, dtype=float)
        point = lambda p: m[:3, :3] @ p + m[:3, 3]
        if kind == 'polygon':
            n = np.concatenate([point(p) for p in n.reshape(-1, 3)])
        elif kind in ('sphere', 'bubble'):
            n = np.array([*point(n[:3]), n[3] * s])
        elif kind == 'ring':
            d = m[:3, :3] @ n[3:6]
            n = np.array([*point(n[:3]), *(d / np.linalg.norm(d)), *sorted(n[6:8] * s)])
        else:
            r = np.array([n[6], n[6]] if kind in ('cylinder', 'tube') else n[6:8]) * s
            n = np.array([*point(n[:3]), *point(n[3:6]), *r])
        self.prims.append((kind, self.materials[material], name, n))


GENERATORS = {'genbox': genbox, 'genprism': genprism, 'genrev': genrev, 'genworm': genworm}
MATERIALS = ('plastic', 'metal', 'mirror', 'glass', 'dielectric', 'light', 'glow', 'spotlight')
SHAPES = ('polygon', 'sphere', 'bubble', 'ring', 'cone', 'cup', 'cylinder', 'tube')


# ---- geometry ---------------------------------------------------------------------------------------------------
def dot(a, b):
    return np.einsum('ij,ij->i', a, b)


def unit(a):
    return a / np.linalg.norm(a, axis=-1, keepdims=True)


def newell(p):
    q = np.roll(p, -1, axis=0)
    return np.array([np.sum((p[:, (k + 1) % 3] - q[:, (k + 1) % 3]) * (p[:, (k + 2) % 3] + q[:, (k + 2) % 3]))
                     for k in range(3)]) / 2


class Geometry:
    def __init__(self, prims):
        self.kind, self.area = [], []
        self.center, self.radius = [], []
        self.data = []
        for i, (kind, _, _, n) in enumerate(prims):
            if kind == 'polygon':
                p = n.reshape(-1, 3)
                v = newell(p)
                a = np.linalg.norm(v)
                normal = v / a
                k = int(np.argmax(np.abs(normal)))
                axes = [(k + 1) % 3, (k + 2) % 3]
                self.data.append(('polygon', p, normal, axes))
                c = (p.min(0) + p.max(0)) / 2
                r = np.max(np.linalg.norm(p - c, axis=1))
            elif kind in ('sphere', 'bubble'):
                c, r = n[:3], n[3]
                self.data.append(('sphere', c, r, -1 if kind == 'bubble' else 1))
                a = 4 * math.pi * r * r
            elif kind == 'ring':
                c, r = n[:3], n[7]
                self.data.append(('ring', c, n[3:6], n[6], n[7]))
                a = math.pi * (n[7] ** 2 - n[6] ** 2)
            else:
                p, q, r0, r1 = n[:3], n[3:6], n[6], n[7]
                length = np.linalg.norm(q - p)
                slope = (r1 - r0) / length
                self.data.append(('cone', p, (q - p) / length, length, r0, slope,
                                  -1 if kind in ('cup', 'tube') else 1))
                a = math.pi * (r0 + r1) * math.hypot(length, r1 - r0)
                c, r = (p + q) / 2, math.hypot(length / 2, max(r0, r1))
            self.kind.append(self.data[-1][0])
            self.area.append(a)
            self.center.append(c)
            self.radius.append(r)
        self.kind, self.area = np.array(self.kind), np.array(self.area)
        self.center, self.radius = np.array(self.center), np.array(self.radius)
        self.middle = self.center.mean(0)
        self.c32 = (self.center - self.middle).astype(np.float32)
        self.corners = np.array([len(d[1]) if d[0] == 'polygon' else 0 for d in self.data])
        self.table()

    def table(self):
        """Shapes' numbers as arrays by kind; `row` is a primitive's row in its kind's arrays."""
        n = len(self.data)
        self.row = np.zeros(n, dtype=int)
        self.polygons = {}
        for count in set(self.corners[self.corners > 0]):
            ids = np.flatnonzero(self.corners == count)
            self.row[ids] = np.arange(len(ids))
            flat = []
            for i in ids:
                _, p, _, axes = self.data[i]
                flat.append(p[:, axes])
            self.polygons[count] = np.array(flat)
        self.plane = np.zeros((n, 4))
        self.axes = np.zeros((n, 2), dtype=int)
        for i, d in enumerate(self.data):
            if d[0] == 'polygon':
                self.plane[i, :3], self.plane[i, 3], self.axes[i] = d[2], d[2] @ d[1].mean(0), d[3]
            elif d[0] == 'ring':
                self.plane[i, :3], self.plane[i, 3] = d[2], d[2] @ d[1]
        def rows(kind, width):
            ids = np.flatnonzero(self.kind == kind)
            self.row[ids] = np.arange(len(ids))
            return np.array([np.hstack(self.data[i][1:]) for i in ids]).reshape(-1, width)
        self.spheres, self.rings, self.cones = rows('sphere', 5), rows('ring', 8), rows('cone', 10)

    def normal(self, prim, at):
        """Unit normals of the front sides."""
        out = self.plane[prim, :3].copy()
        k = self.kind[prim]
        m = np.flatnonzero(k == 'sphere')
        if len(m):
            s = self.spheres[self.row[prim[m]]]
            out[m] = unit(at[m] - s[:, :3]) * s[:, 4:5]
        m = np.flatnonzero(k == 'cone')
        if len(m):
            c = self.cones[self.row[prim[m]]]
            d = at[m] - c[:, :3]
            axis = c[:, 3:6]
            radial = unit(d - dot(d, axis)[:, None] * axis)
            out[m] = unit(radial - axis * c[:, 8:9]) * c[:, 9:10]
        return out

    def cast(self, o, d):
        """Nearest hits: distance (inf: none) and primitive."""
        t, prim = np.full(len(o), np.inf), np.full(len(o), -1)
        for b in range(0, len(o), 4096):
            e = min(len(o), b + 4096)
            t[b:e], prim[b:e] = self.cast_block(o[b:e], d[b:e])
        return t, prim

    def cast_block(self, o, d):
        o32, d32 = (o - self.middle).astype(np.float32), d.astype(np.float32)
        along = d32 @ self.c32.T
        along -= dot(o32, d32)[:, None]
        away = -2 * (o32 @ self.c32.T)
        away += dot(o32, o32)[:, None]
        away += dot(self.c32, self.c32)[None]
        slack = 1e-5 * float(np.max(dot(o32, o32)) + 1)
        r2 = (self.radius ** 2 * 1.0001 + slack).astype(np.float32)
        reach = (self.radius * 1.0001 + math.sqrt(slack)).astype(np.float32)
        ray, prim = np.nonzero((away - along * along <= r2) & (along >= -reach))
        t = np.full(len(ray), np.inf)
        kind = self.kind[prim]
        ro, rd = o[ray], d[ray]
        m = np.flatnonzero(kind == 'sphere')
        if len(m):
            s = self.spheres[self.row[prim[m]]]
            oc = ro[m] - s[:, :3]
            t[m] = first_root(np.ones(len(m)), dot(oc, rd[m]), dot(oc, oc) - s[:, 3] ** 2)
        m = np.flatnonzero(kind == 'cone')
        if len(m):
            t[m] = self.cone_hits(self.cones[self.row[prim[m]]], ro[m], rd[m])
        m = np.flatnonzero((kind == 'polygon') | (kind == 'ring'))
        if len(m):
            p = self.plane[prim[m]]
            with np.errstate(divide='ignore', invalid='ignore'):
                h = (p[:, 3] - dot(p[:, :3], ro[m])) / dot(p[:, :3], rd[m])
            ok = (h > TINY) & np.isfinite(h)
            m, h = m[ok], h[ok]
            at = ro[m] + h[:, None] * rd[m]
            inside = np.zeros(len(m), dtype=bool)
            k = np.flatnonzero(kind[m] == 'ring')
            if len(k):
                g = self.rings[self.row[prim[m[k]]]]
                x = np.linalg.norm(at[k] - g[:, :3], axis=1)
                inside[k] = (x >= g[:, 6]) & (x <= g[:, 7])
            count = self.corners[prim[m]]
            for c, flat in self.polygons.items():
                k = np.flatnonzero(count == c)
                if len(k):
                    ax = self.axes[prim[m[k]]]
                    q = np.take_along_axis(at[k], ax, axis=1)
                    inside[k] = in_polygon(flat[self.row[prim[m[k]]]], q)
            t[m[inside]] = h[inside]
        hit = np.flatnonzero(np.isfinite(t))
        hit = hit[np.lexsort((t[hit], ray[hit]))]
        first = np.concatenate([[True], ray[hit][1:] != ray[hit][:-1]]) if len(hit) else np.zeros(0, bool)
        out_t, out_p = np.full(len(o), np.inf), np.full(len(o), -1)
        hit = hit[first]
        out_t[ray[hit]], out_p[ray[hit]] = t[hit], prim[hit]
        return out_t, out_p

    @staticmethod
    def cone_hits(c, o, d):
        p, axis, length, r0, k = c[:, :3], c[:, 3:6], c[:, 6], c[:, 7], c[:, 8]
        oc = o - p
        od, dd = dot(oc, axis), dot(d, axis)
        r = r0 + k * od
        a = dot(d, d) - dd ** 2 - (k * dd) ** 2
        b = dot(oc, d) - od * dd - k * dd * r
        cc = dot(oc, oc) - od ** 2 - r ** 2
        best = np.full(len(o), np.inf)
        with np.errstate(divide='ignore', invalid='ignore'):
            root = np.sqrt(b * b - a * cc)
            q = -(b + np.copysign(root, b))
            for t in (q / a, cc / q):
                h = od + t * dd
                ok = (t > TINY) & (h >= 0) & (h <= length) & (r0 + k * h >= 0) & (t < best)
                best = np.where(ok, t, best)
        return best

    def sample(self, i, u):
        """Points uniform over primitive `i`, from an (n, 2) array of uniform numbers, or fewer."""
        d = self.data[i]
        if d[0] == 'polygon':
            p, normal, axes = d[1], d[2], d[3]
            flat = p[:, axes]
            lo, hi = flat.min(0), flat.max(0)
            q = lo + u * (hi - lo)
            q = q[in_polygon(np.broadcast_to(flat, (len(q),) + flat.shape), q)]
            at = np.zeros((len(q), 3))
            at[:, axes] = q
            k = 3 - axes[0] - axes[1]
            at[:, k] = (normal @ p.mean(0) - q @ normal[axes]) / normal[k]
            return at
        phi = 2 * math.pi * u[:, 0]
        if d[0] == 'sphere':
            z = 2 * u[:, 1] - 1
            s = np.sqrt(1 - z * z)
            return d[1] + d[2] * np.column_stack([s * np.cos(phi), s * np.sin(phi), z])
        axis = d[2]
        e = np.eye(3)[int(np.argmin(np.abs(axis)))]
        x = unit(np.cross(axis, e))
        circle = np.cos(phi)[:, None] * x + np.sin(phi)[:, None] * np.cross(axis, x)
        if d[0] == 'ring':
            r = np.sqrt(d[3] ** 2 + u[:, 1] * (d[4] ** 2 - d[3] ** 2))
            return d[1] + r[:, None] * circle
        length, r0, k = d[3], d[4], d[5]
        r1 = r0 + k * length
        r = np.sqrt(r0 * r0 + u[:, 1] * (r1 * r1 - r0 * r0)) if abs(k) > 1e-9 else np.full(len(u), r0)
        h = (r - r0) / k if abs(k) > 1e-9 else u[:, 1] * length
        return d[1] + h[:, None] * axis + r[:, None] * circle


TINY = 1e-6


def first_root(a, b, c):
    """Least root above TINY of a t^2 + 2 b t + c."""
    with np.errstate(invalid='ignore'):
        root = np.sqrt(b * b - a * c)
        near, far = (-b - root) / a, (-b + root) / a
        return np.where(near > TINY, near, np.where(far > TINY, far, np.inf))


def in_polygon(p, q):
    """Parity of crossings; p (n, corners, 2), q (n, 2)."""
    a, b = p, np.roll(p, -1, axis=1)
    y = q[:, None, 1]
    cross = (a[:, :, 1] > y) != (b[:, :, 1] > y)
    with np.errstate(divide='ignore', invalid='ignore'):
        x = a[:, :, 0] + (y - a[:, :, 1]) / (b[:, :, 1] - a[:, :, 1]) * (b[:, :, 0] - a[:, :, 0])
    return np.sum(cross & (x > q[:, None, 0]), axis=1) % 2 == 1


# ---- materials --------------------------------------------------------------------------------------------------
OPAQUE, MIRROR, GLASS, BODY, LIGHT = range(5)


class Materials:
    def __init__(self, prims):
        n = len(prims)
        self.kind = np.zeros(n, dtype=int)
        self.diffuse, self.specular = np.zeros((n, 3)), np.zeros((n, 3))
        self.rough, self.ior = np.zeros(n), np.full(n, 1.52)
        for i, (_, (kind, v), _, _) in enumerate(prims):
            if kind in ('plastic', 'metal'):
                c, s = np.array(v[:3]), v[3]
                self.diffuse[i] = c * (1 - s)
                self.specular[i] = c * s if kind == 'metal' else s
                self.rough[i] = v[4]
            elif kind == 'mirror':
                self.kind[i], self.specular[i] = MIRROR, v[:3]
            elif kind == 'glass':
                self.kind[i], self.specular[i] = GLASS, v[:3]
                if len(v) > 3:
                    self.ior[i] = v[3]
            elif kind == 'dielectric':
                self.kind[i], self.specular[i], self.ior[i] = BODY, v[:3], v[3]
            else:
                self.kind[i] = LIGHT

    def pane(self, i, cosine):
        """Reflectance and transmittance of panes, Radiance's formula for its glass."""
        c2 = np.sqrt(1 - (1 - cosine ** 2) / self.ior[i] ** 2)
        d = self.specular[i] ** (1 / c2)[:, None]
        R, T = 0, 0
        for r in (((cosine - self.ior[i] * c2) / (cosine + self.ior[i] * c2)) ** 2,
                  ((self.ior[i] * cosine - c2) / (self.ior[i] * cosine + c2)) ** 2):
            r = r[:, None]
            R = R + .5 * r * (1 + (1 - 2 * r) * d * d) / (1 - r * r * d * d)
            T = T + .5 * (1 - r) ** 2 * d / (1 - r * r * d * d)
        return R, T


def reflect(d, n):
    return d - 2 * dot(d, n)[:, None] * n


def frame(n):
    e = np.where(np.abs(n[:, :1]) < .7, np.array([[1.0, 0, 0]]), np.array([[0, 1.0, 0]]))
    x = unit(np.cross(e, n))
    return x, np.cross(n, x)


class Paths:
    """Walks over specular surfaces. Arrays of one row a path; `d` is the direction of travel, `thr` what is carried on."""

    def __init__(self, geometry, materials, rng):
        self.g, self.m, self.rng = geometry, materials, rng

    def scatter(self, prim, n, d, inside, start=False):
        """One specular event where light (or importance) that travels along `d` meets side `n` (n . d < 0) of `prim`.
        Gives new direction, weight, whether it counts as an event, and whether the way goes on."""
        m, k = self.m, len(prim)
        new, weight = reflect(d, n), np.zeros((k, 3))
        counts, inside = np.ones(k, dtype=bool), inside.copy()
        kind = m.kind[prim]
        u = self.rng.random(k)
        i = np.flatnonzero((kind == OPAQUE) | (kind == MIRROR))
        weight[i] = m.specular[prim[i]]
        i = i[m.rough[prim[i]] > 0]
        if len(i):  # Ward's lobe, bounded form [GMD10]; sampled by its half vector
            a, v = m.rough[prim[i]], self.rng.random((len(i), 2))
            tan2 = -a * a * np.log1p(-v[:, 0])
            c = 1 / np.sqrt(1 + tan2)
            s = np.sqrt(1 - c * c)
            x, y = frame(n[i])
            phi = 2 * math.pi * v[:, 1:]
            h = s[:, None] * (np.cos(phi) * x + np.sin(phi) * y) + c[:, None] * n[i]
            w = -d[i]
            out = 2 * dot(w, h)[:, None] * h - w
            cos_out = dot(out, n[i])
            hh = w + out
            h2, hz = dot(hh, hh), dot(hh, n[i])
            f = np.exp(-(h2 - hz ** 2) / hz ** 2 / a ** 2) * h2 / (math.pi * a ** 2 * hz ** 4)
            cos_h = hz / np.sqrt(h2)
            half = np.exp(-(h2 - hz ** 2) / hz ** 2 / a ** 2) / (math.pi * a ** 2 * cos_h ** 3)
            pdf = half / (4 * dot(w, hh) / np.sqrt(h2))
            ok = (cos_out > 0) & (dot(w, h) > 0)
            weight[i] *= np.where(ok, f * cos_out / np.where(ok, pdf, 1), 0)[:, None]
            new[i] = out
        i = np.flatnonzero(kind == GLASS)
        if len(i):
            R, T = m.pane(prim[i], -dot(d[i], n[i]))
            p = np.ones(len(i)) if start else R.mean(1) / (R.mean(1) + T.mean(1))
            bounced = u[i] < p
            weight[i] = np.where(bounced[:, None], R / p[:, None], T / np.where(p < 1, 1 - p, 1)[:, None])
            new[i] = np.where(bounced[:, None], new[i], d[i])
            counts[i] = bounced
        i = np.flatnonzero(kind == BODY)
        if len(i):
            c = -dot(d[i], n[i])
            eta = np.where(inside[i], m.ior[prim[i]], 1 / m.ior[prim[i]])
            s2 = eta ** 2 * (1 - c * c)
            ct = np.sqrt(np.maximum(0, 1 - s2))
            a = ((c - ct / eta) / (c + ct / eta)) ** 2
            b = ((c / eta - ct) / (c / eta + ct)) ** 2
            R = np.where(s2 >= 1, 1, .5 * (a + b))
            bounced = u[i] < R
            through = eta[:, None] * d[i] + (eta * c - ct)[:, None] * n[i]
            new[i] = np.where(bounced[:, None], new[i], through)
            inside[i] ^= ~bounced
            weight[i] = 1
        return new, weight, counts, inside

    def meet(self, o, d, inside, thr):
        """Next hit of each ray: primitive (-1: none), place, its normal towards the ray; `thr` takes absorption."""
        t, prim = self.g.cast(o, d)
        ok = prim >= 0
        at = o + np.where(ok, t, 0)[:, None] * d
        front = self.g.normal(np.maximum(prim, 0), at)
        side = np.sign(dot(front, -d))
        side[side == 0] = 1
        body = inside & ok
        if np.any(body):
            thr[body] *= self.m.specular[prim[body]] ** t[body][:, None]
        return prim, at, front * side[:, None], side > 0


def run(program, scene_path, out_path, paths, parts, samples, seed):
    scene = Scene(scene_path)
    prims = scene.prims
    g, m = Geometry(prims), Materials(prims)
    gray = m.specular.mean(1)
    gray[m.kind == GLASS] = .1
    gray[m.kind == BODY] = 1
    gray[m.kind == LIGHT] = 0
    both = np.where((m.kind == MIRROR) | (m.kind == BODY), 1, 2)
    rng = np.random.default_rng(seed)
    boost = np.select([m.kind == MIRROR, m.kind == BODY], [3.0, 10.0], 1.0)
    w = boost * gray / np.sum(boost * gray * g.area * both)  # density of starts per area and side, of one path
    names = ['.'.join(p[2].split('.')[:parts]) for p in prims]
    groups = sorted(set(names))
    group = np.array([groups.index(x) for x in names])
    area = np.bincount(group, weights=g.area, minlength=len(groups))
    flux = np.zeros((BATCHES, len(groups), 3))
    print('%d primitives, %d of them specular' % (len(prims), np.sum(w > 0)), flush=True)
    walk = Paths(g, m, rng)
    per = max(1, paths // BATCHES)
    senders = []  # (batch, group, value per unit exitance, sender place, normal, prim)
    for batch in range(BATCHES):
        # Starts: primitives by w * area * sides, then places on them.
        p = np.sort(rng.choice(len(prims), per, p=w * g.area * both / np.sum(w * g.area * both)))
        at = np.zeros((per, 3))
        for i in np.unique(p):
            rows, have = np.flatnonzero(p == i), []
            need = len(rows)
            while need > 0:
                got = g.sample(i, rng.random((2 * need + 4, 2)))[:need]
                have.append(got)
                need -= len(got)
            at[rows] = np.concatenate(have)
        front = g.normal(p, at)
        flip = (both[p] == 2) & (rng.random(per) < .5)
        n = np.where(flip[:, None], -front, front)
        u = rng.random((per, 2))
        r = np.sqrt(u[:, 0])
        x, y = frame(n)
        a = (2 * math.pi * u[:, 1])[:, None]
        out = r[:, None] * (np.cos(a) * x + np.sin(a) * y) + np.sqrt(1 - u[:, :1]) * n
        senders += trace(walk, g, m, w, p, at, n, out, batch, group)
        print('batch %d: %d connections' % (batch, sum(len(s[0]) for s in senders)), flush=True)
    cat = [np.concatenate([s[k] for s in senders]) for k in range(6)]
    batch, grp, value, at, n, prim = cat
    E = irradiance(program, scene_path, at, n, samples, seed)
    contribution = value * m.diffuse[prim] * E / per
    for b in range(BATCHES):
        for c in range(3):
            k = batch == b
            flux[b, :, c] = np.bincount(grp[k], weights=contribution[k, c], minlength=len(groups))
    mean, se = flux.mean(0), flux.std(0, ddof=1) / math.sqrt(BATCHES)
    total, total_se = flux.sum(1).mean(0), flux.sum(1).std(0, ddof=1) / math.sqrt(BATCHES)
    with open(out_path, 'w') as f:
        f.write('surface,area,Phi_r,Phi_g,Phi_b,se_r,se_g,se_b\n')
        row = lambda name, a, v, s: f.write('%s,%.7g,%s,%s\n' % (name, a, ','.join('%.6g' % q for q in v),
                                                                ','.join('%.3g' % q for q in s)))
        row('TOTAL', area.sum(), total, total_se)
        for i in np.argsort(-mean.mean(1)):
            if mean[i].any():
                row(groups[i], area[i], mean[i], se[i])


def trace(walk, g, m, w, start, at, n, out, batch, group):
    """Both halves of paths from their starts; rows (batch, group, value, sender's place, normal, primitive)."""
    rng, k = walk.rng, len(start)
    inside = np.zeros(k, dtype=bool)
    thr = np.repeat(1 / w[start][:, None], 3, axis=1)
    # Towards the sender: importance arrives along -out at the start and goes on. Sums over the path's other possible
    # starts, relative to this one's density: forward from start to sender and to receiver.
    d, weight, _, inside_back = walk.scatter(start, n, -out, inside, start=True)
    thr *= weight
    ratio = np.ones(k)  # s_j / s_start of the last event towards the sender
    total = np.ones(k)
    a_cos, b_cos = dot(out, n), np.abs(dot(d, n))
    step_in = np.where(m.rough[start] == 0, 1.0, b_cos / a_cos)  # b / a of the last event
    last_w = w[start]
    alive = np.flatnonzero(thr.any(axis=1))
    o = at.copy()
    sender = np.full(k, -1)
    s_at, s_n = np.zeros((k, 3)), np.zeros((k, 3))
    for _ in range(64):
        if not len(alive):
            break
        t = thr[alive]
        prim, hit, hn, is_front = walk.meet(o[alive], d[alive], inside_back[alive], t)
        thr[alive] = t
        ok = prim >= 0
        ok &= m.kind[np.maximum(prim, 0)] != LIGHT
        ok &= ~((m.kind[np.maximum(prim, 0)] == MIRROR) & ~is_front)
        alive, prim, hit, hn = alive[ok], prim[ok], hit[ok], hn[ok]
        # A surface that is partly diffuse either ends the path or passes it on.
        kd, ks = m.diffuse[prim].mean(1), m.specular[prim].mean(1)
        opaque = m.kind[prim] == OPAQUE
        q = np.where(opaque, ks / np.maximum(kd + ks, 1e-30), 1.0)
        go = rng.random(len(alive)) < q
        ends = ~go & (kd > 0)
        e = alive[ends]
        thr[e] /= (1 - q[ends])[:, None]
        sender[e], s_at[e], s_n[e] = prim[ends], hit[ends], hn[ends]
        alive, prim, hit, hn, q = alive[go], prim[go], hit[go], hn[go], q[go]
        new, weight, counts, ins = walk.scatter(prim, hn, d[alive], inside_back[alive])
        thr[alive] *= weight / q[:, None]
        # Here the event's receiver side is where we come from. It could be a start if that side is outside.
        a_side, b_side = np.abs(dot(d[alive], hn)), np.abs(dot(new, hn))
        could = counts & ~inside_back[alive]
        i = alive[counts]
        kk = np.flatnonzero(counts)
        # Relative density of starting there, skipping over events that could not: the cosines' product runs on.
        ratio_here = ratio[i] * step_in[i] * w[prim[kk]] / last_w[i]
        total[i] += np.where(could[kk], ratio_here, 0)
        ratio[i], last_w[i] = ratio_here, w[prim[kk]]
        # Refraction keeps the beam's extent: its cosines count as one.
        straight = (m.rough[prim[kk]] == 0)
        step_in[i] = np.where(straight, 1.0, b_side[kk] / np.maximum(a_side[kk], 1e-12))
        d[alive], o[alive], inside_back[alive] = new, hit, ins
        alive = alive[thr[alive].any(axis=1)]
        # Roulette on weak paths.
        strength = thr[alive].max(axis=1) * w[start[alive]]
        p = np.minimum(1, strength / .05)
        live = rng.random(len(alive)) < p
        thr[alive[live]] /= p[live][:, None]
        alive = alive[live]
    rows = []
    # Towards the receivers.
    alive = np.flatnonzero((sender >= 0) & thr.any(axis=1))
    d, o = out.copy(), at.copy()
    ratio = np.ones(k)
    last_w = w[start].copy()
    base = thr.copy()
    ins = np.zeros(k, dtype=bool)
    extra = total.copy()
    for _ in range(64):
        if not len(alive):
            break
        t = base[alive]
        prim, hit, hn, is_front = walk.meet(o[alive], d[alive], ins[alive], t)
        base[alive] = t
        ok = prim >= 0
        alive, prim, hit, hn, is_front = alive[ok], prim[ok], hit[ok], hn[ok], is_front[ok]
        kind = m.kind[prim]
        lands = (kind == OPAQUE)
        i = alive[lands]
        rows.append((np.full(len(i), batch), group[prim[lands]], base[i] / extra[i][:, None], s_at[i], s_n[i],
                     sender[i]))
        go = ((kind == GLASS) | (kind == BODY) | ((kind == MIRROR) & is_front)
              | (lands & (m.specular[prim].mean(1) > 0)))
        q = np.where(lands, np.minimum(1, 2 * m.specular[prim].mean(1)), 1.0)
        go &= rng.random(len(alive)) < q
        alive, prim, hit, hn, q = alive[go], prim[go], hit[go], hn[go], q[go]
        new, weight, counts, now = walk.scatter(prim, hn, d[alive], ins[alive])
        base[alive] *= weight / q[:, None]
        # The event's receiver side is where the way goes on to.
        a_side, b_side = np.abs(dot(new, hn)), np.abs(dot(d[alive], hn))
        kk = np.flatnonzero(counts)
        i = alive[kk]
        rough = m.rough[prim[kk]] > 0
        step = np.where(rough, a_side[kk] / np.maximum(b_side[kk], 1e-12), 1.0)
        # s_j / s_{j+1} = (w_j / w_{j+1}) (a_j / b_j)
        here = ratio[i] * w[prim[kk]] / last_w[i] * step
        extra[i] += np.where(~now[kk], here, 0)
        ratio[i], last_w[i] = here, w[prim[kk]]
        d[alive], o[alive], ins[alive] = new, hit, now
        alive = alive[base[alive].any(axis=1)]
        strength = base[alive].max(axis=1) * w[start[alive]]
        p = np.minimum(1, strength / .02)
        live = rng.random(len(alive)) < p
        base[alive[live]] /= p[live][:, None]
        alive = alive[live]
    return rows


def irradiance(program, scene_path, at, n, samples, seed):
    """By the reference integrator, at each distinct place once."""
    key, back = np.unique(np.round(at, 12), axis=0, return_inverse=True)
    _, first = np.unique(back, return_index=True)
    E = np.zeros((len(key), 3))
    print('%d senders' % len(key), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        p, o = os.path.join(folder, 'p.csv'), os.path.join(folder, 'o.csv')
        with open(p, 'w') as f:
            f.write('x,y,z,nx,ny,nz\n')
            for i in first:
                f.write('%.15g,%.15g,%.15g,%.15g,%.15g,%.15g\n' % (*at[i], *n[i]))
        subprocess.run([program, 'reference', scene_path, '--points', p, '-o', o, '--samples', str(samples), '--seed',
                        str(seed), '--quiet', '--threads', '2'], check=True)
        with open(o) as f:
            for i, row in enumerate(csv.DictReader(x for x in f if not x.startswith('#'))):
                E[i] = [float(row[c]) for c in ('E_r', 'E_g', 'E_b')]
    return E[back.ravel()]


if __name__ == '__main__':
    if len(sys.argv) < 5:
        raise SystemExit(__doc__)
    extra = [int(x) for x in sys.argv[5:]] + [1, 16, 1][len(sys.argv) - 5:]
    run(sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4]), *extra)
