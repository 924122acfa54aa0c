// The page: reads the solution, draws it, and does what hands say.
import * as THREE from 'three';
import { Eye } from './camera.js';
import { luxText, roundUp } from './colour.js';
import { editsOf, initialDimmer, sameWeight, weightOf } from './dimmers.js';
import { Drawing, unpackMesh } from './drawing.js';
import { Grids } from './grids.js';
import { hashOf, readHash } from './hash.js';
import { drawLegend } from './legend.js';
import { Marks } from './marks.js';
import { Meter } from './meter.js';
import { Panel } from './panel.js';
import { joinRgb9e5, readLater, readPayload } from './payload.js';
import { Relight } from './relight.js';

const decades = 3;
const byId = (id) => document.getElementById(id);

async function start() {
  const payload = await readPayload(byId('solution')), { header } = payload;
  document.title = `${header.title} - deltalux`;
  const mesh = unpackMesh(payload), relight = Relight.of(payload);
  performance.mark('unpacked');
  const stage = byId('stage'), drawing = new Drawing(payload, mesh, relight, stage), grids = new Grids(payload);
  const marks = grids.count ? new Marks(grids, header) : null;
  const initial = header.groups.map(initialDimmer), said = readHash(location.hash);
  const state = {
    dimmers: initial.map((d, g) => ({ ...d, ...said.dimmers[g] })),
    ev: said.ev ?? header.ev, falseColour: said.top > 0, top: said.top ?? null, linearTone: false,
    bookmarks: said.bookmarks.length ? said.bookmarks : stored('bookmarks', []), marks: false,
    get view() { return eye.view; },
  };
  const weights = () => state.dimmers.map((d, g) => weightOf(header.groups[g], d));

  const joined = (section, name) => joinRgb9e5(section(name, Uint8Array), header.vertexCount);
  /** Light for the first picture: as exported it is there; of other weights the sum has to wait for all groups. */
  async function lightUp() {
    const asExported = weights().every((w, g) => sameWeight(w, header.groups[g].weight));
    if (header.sections.sum && asExported) return relight.begin(weights(), joined(payload.section, 'sum'));
    relight.setWeights(weights());
    await groupsApart();
  }
  async function groupsApart() {
    if (relight.layerOf) return;
    const section = header.sections.sum ? await readLater(payload) : payload.section;
    relight.take((g) => joined(section, `layer${g}`));
    performance.mark('groups-apart');
  }

  let waiting = false, meter = null, panel = null, pointer = null;
  function redraw() {
    if (waiting || !panel) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      drawNow();
    });
  }
  function drawNow() {
    if ((state.falseColour || state.marks) && !state.top) chooseTop();
    drawing.lookRound();
    drawing.draw({ ...state });
    if (marks && state.marks) drawing.renderer.render(marks.scene, drawing.camera);
  }
  /** Once, when a scale is asked for: from what is in sight. */
  function chooseTop() {
    state.top = roundUp(drawing.automaticTop());
    panel?.update();
    showLegend();
    marks?.show(grids.lux(relight.weights), state.top, decades);
  }
  const eye = new Eye(drawing.camera, drawing.renderer.domElement, header, () => (redraw(), settle()));
  const goTo = (v) => (eye.view = fitted(v));
  /** Angles are those of the view's longer need: all of what it shows is in the picture. */
  function fitted(v) {
    if (!v.horizontal) return v;
    const half = Math.tan((v.horizontal * Math.PI) / 360) / drawing.camera.aspect;
    return { ...v, angle: Math.max(v.angle, (Math.atan(half) * 360) / Math.PI) };
  }

  let settling = 0;
  /** When hands rest: the address, and sums without rounding. */
  function settle() {
    clearTimeout(settling);
    settling = setTimeout(() => history.replaceState(null, '', hashOf(state, initial)), 300);
  }
  function relit() {
    drawing.takeWeights();
    panel?.update();
    panel?.showGrids(grids.figures(relight.weights));
    if (state.top) marks?.show(grids.lux(relight.weights), state.top, decades);
    showReading();
    redraw();
  }
  function setAll(dimmers) {
    state.dimmers = dimmers.map((d) => ({ ...d }));
    panel.state = state;
    relight.setWeights(weights());
    relit();
    settle();
  }

  /** What is under a place of the picture, in CSS pixels from the top left. */
  function readingAt(x, y) {
    if (!meter) return null;
    const { camera } = drawing, rect = drawing.renderer.domElement.getBoundingClientRect();
    camera.updateMatrixWorld();
    const far = new THREE.Vector3((2 * x) / rect.width - 1, 1 - (2 * y) / rect.height, 0.5).unproject(camera);
    return meter.at(camera.position.toArray(), far.sub(camera.position).normalize().toArray());
  }
  function showReading() {
    const box = byId('reading'), found = pointer && readingAt(pointer[0], pointer[1]);
    box.hidden = !found;
    panel?.showShares(found);
    if (!found) return;
    const p = found.position.map((v, c) => (v + header.origin[c]).toFixed(2)).join('  ');
    box.replaceChildren(Object.assign(document.createElement('b'), { textContent: `${luxText(found.lux)} lx` }), ` ${p}`);
    const rect = stage.getBoundingClientRect();
    box.style.left = `${Math.min(pointer[0] + 14, rect.width - 190)}px`;
    box.style.top = `${Math.max(pointer[1] - 30, 4)}px`;
  }

  const lampsOnly = (kinds) => header.groups.map((group, g) => ({ ...initial[g], on: kinds.includes(group.kind) && (initial[g].on || group.kind === 'lamp') }));
  const builtIn = [
    { name: 'As exported', dimmers: initial },
    { name: 'All on', dimmers: initial.map((d) => ({ ...d, on: true })) },
    { name: 'All off', dimmers: initial.map((d) => ({ ...d, on: false })) },
    ...(header.groups.some((g) => g.kind === 'lamp') && header.groups.some((g) => g.kind === 'sun' || g.kind === 'sky')
      ? [{ name: 'Daylight', dimmers: lampsOnly(['sun', 'sky']) }, { name: 'Lamps', dimmers: lampsOnly(['lamp']) }] : []),
  ];
  let ownPresets = stored('presets', []).filter((p) => p.dimmers?.length === header.groups.length);

  const hands = {
    three: THREE.REVISION,
    dim(g, change, done) {
      state.dimmers[g] = { ...state.dimmers[g], ...change };
      relight.setWeight(g, weightOf(header.groups[g], state.dimmers[g]));
      relit();
      if (done) hands.settle();
    },
    reset: (g) => hands.dim(g, initial[g], true),
    settle() {
      relight.setWeights(weights());
      relit();
      settle();
    },
    expose(ev) { state.ev = ev; panel.update(); redraw(); },
    autoExpose() { state.ev = drawing.automaticEv(); panel.update(); redraw(); settle(); },
    falseColour(on) { state.falseColour = on; showLegend(); redraw(); settle(); },
    scaleTo(top) { state.top = top; showLegend(); marks?.show(grids.lux(relight.weights), top, decades); redraw(); settle(); },
    walk: (on) => eye.walk(on),
    marks(on) { state.marks = on; showLegend(); redraw(); },
    goTo,
    presets: () => ({ presets: builtIn, own: ownPresets }),
    preset: (p) => setAll(p.dimmers),
    keepPreset() {
      const name = prompt('Name of the preset', `Preset ${ownPresets.length + 1}`);
      if (!name) return;
      ownPresets.push({ name, dimmers: state.dimmers.map((d) => ({ ...d })) });
      store('presets', ownPresets);
      panel.showPresets();
    },
    dropPreset(p) { ownPresets = ownPresets.filter((q) => q !== p); store('presets', ownPresets); panel.showPresets(); },
    keepView() {
      const name = prompt('Name of the view', `View ${state.bookmarks.length + 1}`);
      if (!name) return;
      state.bookmarks.push({ name, view: eye.view });
      keepBookmarks();
    },
    dropBookmark(b) { state.bookmarks = state.bookmarks.filter((c) => c !== b); keepBookmarks(); },
    saveEdits() {
      const text = JSON.stringify(editsOf(header.groups, state.dimmers), null, 1) + '\n';
      const link = Object.assign(document.createElement('a'), { download: 'edits.json', href: URL.createObjectURL(new Blob([text], { type: 'application/json' })) });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    },
    copyLink() {
      history.replaceState(null, '', hashOf(state, initial));
      navigator.clipboard?.writeText(location.href).catch(() => prompt('The address', location.href));
    },
    resized: resize,
  };
  function keepBookmarks() {
    store('bookmarks', state.bookmarks);
    panel.showViews();
    settle();
  }
  function showLegend() {
    const legend = byId('legend');
    legend.hidden = !state.falseColour && !state.marks;
    if (!legend.hidden && state.top) drawLegend(legend, state.top, decades);
  }
  function resize() {
    const { width, height } = stage.getBoundingClientRect();
    if (width < 1 || height < 1) return;
    drawing.resize(width, height, Math.min(window.devicePixelRatio || 1, 2));
    redraw();
  }

  resize();
  await lightUp();
  drawing.takeWeights();
  goTo(said.view ?? header.views[0] ?? header.overview);
  performance.mark('prepared');
  drawing.lookRound();
  drawing.drawFirst({ ...state });
  byId('message').remove();
  performance.mark('first-picture');

  panel = new Panel(byId('panel'), header, state, hands);
  showLegend();
  relit();
  new ResizeObserver(resize).observe(stage);
  const canvas = drawing.renderer.domElement;
  canvas.addEventListener('pointermove', (e) => {
    const rect = canvas.getBoundingClientRect();
    pointer = e.buttons ? null : [e.clientX - rect.left, e.clientY - rect.top];
    showReading();
  });
  canvas.addEventListener('pointerleave', () => ((pointer = null), showReading()));
  window.addEventListener('keydown', (e) => {
    if (e.target.matches?.('input, select, textarea') || e.ctrlKey || e.metaKey) return;
    if (e.key === 'h') panel.fold();
    if (e.key === 'v') hands.falseColour(!state.falseColour), panel.update();
    if (/^[1-9]$/.test(e.key) && header.views[e.key - 1]) goTo(header.views[e.key - 1]);
  });
  window.addEventListener('hashchange', () => location.reload());
  setTimeout(async () => {
    await groupsApart();
    relit();
    meter = new Meter(drawing);
    // Mirrors behind walls need no picture: one of their corners, or the middle, is to be seen.
    drawing.seen = ({ corners }) => {
      const from = drawing.camera.position, middle = corners.reduce((s, p) => s.add(p), new THREE.Vector3()).divideScalar(corners.length);
      return [middle, ...corners.map((p) => p.clone().lerp(middle, 0.1))].some((p) => {
        const way = p.clone().sub(from), distance = way.length();
        const hit = meter.tree.nearest(from.toArray(), way.divideScalar(distance).toArray());
        return !hit || hit.distance > distance * 0.999 - 0.002;
      });
    };
    redraw();
    performance.mark('ready');
    window.deltalux.ready = true;
  }, 0);
  // For scripts and tests: what the page shows, as numbers.
  window.deltalux = {
    ready: false, drawing, header, state, hands, readingAt, relight, drawNow, setAll, goTo,
    meterAt: (origin, direction) => meter.at(origin, direction),
    grids: () => grids.figures(relight.weights), gridLux: () => Array.from(grids.lux(relight.weights)),
    edits: () => editsOf(header.groups, state.dimmers), hash: () => hashOf(state, initial),
    automaticTop: () => roundUp(drawing.automaticTop()),
  };
}

function stored(key, otherwise) {
  try {
    return JSON.parse(localStorage.getItem(`deltalux ${location.pathname} ${key}`)) ?? otherwise;
  } catch {
    return otherwise;
  }
}
function store(key, value) {
  try {
    localStorage.setItem(`deltalux ${location.pathname} ${key}`, JSON.stringify(value));
  } catch { /* private windows keep nothing */ }
}

start().catch((error) => {
  console.error(error);
  const message = byId('message') ?? document.body.appendChild(Object.assign(document.createElement('div'), { id: 'message' }));
  message.textContent = `This page cannot be shown: ${error.message}`;
});
