// The panel: dimmers, presets, exposure, false colour, views, grids. It shows a state and tells what hands do to it.
import { luxText, toHex } from './colour.js';

function element(tag, properties = {}, ...children) {
  const { dataset, ...rest } = properties, e = Object.assign(document.createElement(tag), rest);
  if (dataset) Object.assign(e.dataset, dataset);
  e.append(...children.filter((c) => c != null));
  return e;
}

const button = (text, onclick, properties = {}) => element('button', { type: 'button', textContent: text, onclick, ...properties });

function section(title, ...children) {
  return element('details', { open: true }, element('summary', { textContent: title }), ...children);
}

/** The slider's place for a dimmer: the middle is 1, the ends are 0 and 4; finer near 0, as eyes are. */
const placeOf = (dim) => Math.sqrt(Math.min(dim, 4)) / 2;
const dimOf = (place) => Number((4 * place * place).toPrecision(3));

export class Panel {
  /** hands: what the panel calls, see main.js. */
  constructor(root, header, state, hands) {
    this.root = root;
    this.header = header;
    this.state = state;
    this.hands = hands;
    this.rows = header.groups.map((group, g) => this.lightRow(group, g));
    root.append(...[
      element('header', {}, element('h1', { textContent: header.title }), button('Hide', () => this.fold(), { id: 'fold', title: 'Hide the panel (H)' })),
      section('Presets', (this.presets = element('div', { className: 'buttons', id: 'presets' }))),
      section('Lights', ...this.rows.map((r) => r.row)),
      section('Picture', ...this.picture()),
      section('Views', (this.views = element('div', { className: 'buttons', id: 'views' })), this.moving()),
      header.points.count ? section('Grids', (this.grids = element('table', { id: 'grids' })), this.gridSwitch()) : null,
      section('Take along', element('div', { className: 'buttons' },
        button('edits.json', hands.saveEdits, { id: 'save-edits', title: 'For deltalux update SOLUTION --edits edits.json' }),
        button('Copy link', hands.copyLink, { title: 'The whole state stands in the address' }))),
      element('footer', {}, ...this.notes().map((n) => element('p', { textContent: n }))),
    ].filter(Boolean));
    this.showPresets();
    this.showViews();
    this.update();
  }

  notes() {
    const out = ['Lux: irradiance of the solution, without maintenance factor.'];
    if (!this.header.byLight) out.push('The solution was not solved by light: its lights are dimmed together.');
    if (this.header.specular) out.push('Flat mirrors reflect what is drawn; curved mirrors, metal and gloss are shown in the mean light around the eye.');
    out.push(`deltalux ${this.header.version}; three.js ${this.hands.three}, MIT`);
    return out;
  }

  lightRow(group, g) {
    const { hands } = this;
    const on = element('input', { type: 'checkbox', title: 'On and off', dataset: { on: g }, onchange: () => hands.dim(g, { on: on.checked }, true) });
    const dim = element('input', { type: 'range', min: 0, max: 1, step: 0.005, dataset: { dim: g }, title: 'Dims; double click: as exported',
      oninput: () => hands.dim(g, { dim: dimOf(Number(dim.value)), on: true }, false), onchange: () => hands.settle(),
      ondblclick: () => hands.reset(g) });
    const percent = element('input', { type: 'number', min: 0, step: 1, className: 'percent', dataset: { percent: g },
      onchange: () => hands.dim(g, { dim: Math.max(Number(percent.value) || 0, 0) / 100, on: true }, true) });
    const kelvin = element('select', { title: 'Colour temperature', dataset: { kelvin: g }, onchange: () => {
      if (kelvin.value === 'own') hands.dim(g, { kelvin: null, colour: null }, true);
      else if (kelvin.value === 'colour') hands.dim(g, { kelvin: null, colour: colour.value }, true);
      else hands.dim(g, { kelvin: Number(kelvin.value), colour: null }, true);
    } }, element('option', { value: 'own', textContent: 'own' }),
      ...[1800, 2200, 2700, 3000, 3500, 4000, 5000, 6500, 8000, 10000].map((k) => element('option', { value: k, textContent: `${k} K` })),
      element('option', { value: 'colour', textContent: 'colour' }));
    const colour = element('input', { type: 'color', title: 'Colour, at the same luminance', dataset: { colour: g }, value: toHex(group.colour),
      oninput: () => hands.dim(g, { kelvin: null, colour: colour.value }, false), onchange: () => hands.settle() });
    const share = element('span', { className: 'share' });
    const names = group.lights.map((l) => l.name).join(', ');
    const row = element('div', { className: 'light', title: group.lights.length > 1 ? names : '' },
      element('label', {}, on, element('span', { className: 'name', textContent: group.name })), share,
      element('div', { className: 'dimmer' }, dim, percent, element('span', { textContent: '%' }), kelvin, colour));
    return { row, on, dim, percent, kelvin, colour, share };
  }

  picture() {
    const { hands } = this;
    this.ev = element('input', { type: 'range', min: -16, max: 12, step: 0.1, id: 'ev', oninput: () => hands.expose(Number(this.ev.value)), onchange: hands.settle });
    this.evText = element('span', { className: 'value' });
    this.fc = element('input', { type: 'checkbox', id: 'false-colour', onchange: () => hands.falseColour(this.fc.checked) });
    this.top = element('select', { id: 'top', title: 'Upper end of the scale', onchange: () => hands.scaleTo(Number(this.top.value)) },
      ...[10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000, 200000].map((v) =>
        element('option', { value: v, textContent: `${v.toLocaleString('en-GB')} lx` })));
    return [
      element('div', { className: 'line' }, element('span', { textContent: 'Exposure' }), this.ev, this.evText, button('Auto', hands.autoExpose)),
      element('div', { className: 'line' }, element('label', {}, this.fc, ' False colour, to '), this.top),
    ];
  }

  moving() {
    this.walk = element('input', { type: 'checkbox', id: 'walk', onchange: () => this.hands.walk(this.walk.checked) });
    return element('label', { title: 'W A S D or arrows, Q E down and up, Shift faster; drag looks round' }, this.walk, ' Walk (W A S D, drag)');
  }

  gridSwitch() {
    this.marks = element('input', { type: 'checkbox', id: 'marks', onchange: () => this.hands.marks(this.marks.checked) });
    return element('label', {}, this.marks, ' Show the points');
  }

  fold() {
    document.body.classList.toggle('folded');
    document.getElementById('fold').textContent = document.body.classList.contains('folded') ? 'Panel' : 'Hide';
    this.hands.resized();
  }

  showPresets() {
    const { presets, own } = this.hands.presets();
    this.presets.replaceChildren(...presets.map((p) => button(p.name, () => this.hands.preset(p))),
      ...own.map((p) => button(p.name, () => this.hands.preset(p), { className: 'own', oncontextmenu: (e) => (e.preventDefault(), this.hands.dropPreset(p)), title: 'Right click removes it' })),
      button('+', () => this.hands.keepPreset(), { title: 'Keep these dimmers as a preset' }));
  }

  showViews() {
    this.views.replaceChildren(...this.header.views.map((v) => button(v.name, () => this.hands.goTo(v))),
      ...this.state.bookmarks.map((b) => button(b.name, () => this.hands.goTo(b.view), { className: 'own', oncontextmenu: (e) => (e.preventDefault(), this.hands.dropBookmark(b)), title: 'Right click removes it' })),
      button('+', () => this.hands.keepView(), { title: 'Keep this view' }));
  }

  update() {
    const { state } = this;
    state.dimmers.forEach((d, g) => {
      const r = this.rows[g];
      r.on.checked = d.on;
      r.row.classList.toggle('off', !d.on);
      if (document.activeElement !== r.dim || !r.dim.matches(':active')) r.dim.value = placeOf(d.dim);
      if (document.activeElement !== r.percent) r.percent.value = Number((100 * d.dim).toPrecision(3));
      r.kelvin.value = d.kelvin ? String(d.kelvin) : d.colour ? 'colour' : 'own';
      if (r.kelvin.selectedIndex < 0) {
        r.kelvin.append(element('option', { value: d.kelvin, textContent: `${d.kelvin} K` }));
        r.kelvin.value = String(d.kelvin);
      }
      if (d.colour) r.colour.value = d.colour;
    });
    this.ev.value = state.ev;
    this.evText.textContent = `${state.ev >= 0 ? '+' : ''}${state.ev.toFixed(1)} EV`;
    this.fc.checked = state.falseColour;
    if (state.top) this.top.value = String(state.top);
    if (state.top && this.top.selectedIndex < 0) {
      this.top.append(element('option', { value: state.top, textContent: `${state.top.toLocaleString('en-GB')} lx` }));
      this.top.value = String(state.top);
    }
  }

  /** By what the groups bring to the point under the cursor; null: nothing there. */
  showShares(reading) {
    this.rows.forEach(({ share }, g) => (share.textContent = reading ? `${luxText(reading.groups[g])} lx` : ''));
  }

  showGrids(figures) {
    if (!this.grids) return;
    const cell = (text) => element('td', { textContent: text });
    this.grids.replaceChildren(
      element('tr', {}, ...['', 'Em', 'Emin', 'Emax', 'U0', 'Ud'].map((t) => element('th', { textContent: t }))),
      ...figures.map((f) => element('tr', {}, element('th', { textContent: f.name }), cell(luxText(f.Em)), cell(luxText(f.Emin)), cell(luxText(f.Emax)), cell(f.U0.toFixed(2)), cell(f.Ud.toFixed(2)))));
  }
}
