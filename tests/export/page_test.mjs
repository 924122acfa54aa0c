// The page in a browser: node page_test.mjs DELTALUX SOURCES [SCREENSHOT.png]. Opens a page of the Cornell box from
// file://, moves a slider, and compares what it reads and shows with `deltalux probe` and `deltalux render`; then one of a
// room with a sun and two lamps, solved by light, whose lamps are dimmed apart.
// Exit 77: skipped, as there is no chromium, or no playwright-core (npm ci in web/).
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { delimiter, join } from 'node:path';

const [, , program, sources, screenshot] = process.argv;
const require = createRequire(join(sources, 'web', 'package.json'));

function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(77);
}
function browserPath() {
  const names = ['chromium', 'chromium-browser', 'google-chrome'];
  const all = process.env.PATH.split(delimiter).flatMap((folder) => names.map((name) => join(folder, name)));
  return all.find((path) => existsSync(path)) ?? skip('no chromium here');
}
function playwright() {
  try {
    return require('playwright-core');
  } catch {
    return skip('no playwright-core here: npm ci in web/');
  }
}
const executablePath = browserPath(), { chromium } = playwright();

let failures = 0;
function expect(holds, what) {
  console.log(`${holds ? 'ok  ' : 'FAIL'} ${what}`);
  if (!holds) ++failures;
}
const folder = mkdtempSync(join(tmpdir(), 'deltalux-page-'));
const at = (name) => join(folder, name);
const deltalux = (...args) => execFileSync(program, [...args, '--quiet'], { stdio: ['ignore', 'inherit', 'inherit'] });
function luxOf(file) {
  const [head, ...rows] = readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return rows.map((row) => Number(row[head.indexOf('lux')]));
}
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

const view = join(sources, 'scenes/cornell/cornell.vf'), size = 200, coarser = 5;  // pixels; of false colour, whose pixels are measured: one of so many squared
/** On the floor before the blocks, and on the walls. */
function grid() {
  const rows = ['x,y,z,nx,ny,nz,grid'];
  for (const x of [0.08, 0.28, 0.47]) for (const z of [0.03, 0.05]) rows.push(`${x},0,${z},0,1,0,floor`);
  for (const y of [0.1, 0.3, 0.5]) for (const z of [0.1, 0.3]) rows.push(`0,${y},${z},1,0,0,right`);
  return rows.join('\n') + '\n';
}

async function main() {
  const scene = join(sources, 'scenes/cornell/cornell.rad');
  deltalux('solve', scene, '--error', '0.02', '-o', at('box.dlx'));
  writeFileSync(at('grid.csv'), grid());
  deltalux('export', at('box.dlx'), '--view', view, '--points', at('grid.csv'), '-o', at('page.html'));
  deltalux('render', at('box.dlx'), '--view', view, '--size', `${size}x${size}`, '--mesh-direct', '--ev', '0', '-o', at('shown.png'));
  deltalux('render', at('box.dlx'), '--view', view, '--size', `${size / coarser}x${size / coarser}`, '--falsecolor', 'lux', '-o', at('lux.png'));

  const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
  const page = await browser.newPage({ viewport: { width: size + 320, height: size } });
  const asked = [], errors = [];
  page.on('request', (request) => asked.push(request.url()));
  page.on('pageerror', (error) => errors.push(error.message));
  page.on('console', (message) => message.type() === 'error' && errors.push(message.text()));
  await page.goto(`file://${at('page.html')}`);
  await page.waitForFunction(() => window.deltalux?.ready, null, { timeout: 120000 });
  expect(asked.every((url) => /^(file|data|blob):/.test(url)), `nothing is asked of a network (${asked.length} requests)`);

  await asExported(page);
  await aSliderMoves(page);
  await theAddressKeepsIt(browser, page);
  if (screenshot) await page.screenshot({ path: screenshot });
  await groupsApart(browser);
  expect(errors.length === 0, `no errors on the page ${errors.join('; ')}`);
  await browser.close();
}

/** Bytes of a picture, four a pixel: a file, or what the page shows. */
const pixelsOfFile = (page, file) =>
  page.evaluate(async (data) => {
    const image = await createImageBitmap(await (await fetch(data)).blob());
    const c = Object.assign(document.createElement('canvas'), { width: image.width, height: image.height }).getContext('2d');
    c.drawImage(image, 0, 0);
    return { width: image.width, height: image.height, bytes: Array.from(c.getImageData(0, 0, image.width, image.height).data) };
  }, `data:image/png;base64,${readFileSync(file).toString('base64')}`);
const pixelsOfPage = (page) =>
  page.evaluate(() => {
    window.deltalux.drawNow();
    const canvas = document.querySelector('#stage canvas'), { width, height } = canvas;
    const c = Object.assign(document.createElement('canvas'), { width, height }).getContext('2d');
    c.drawImage(canvas, 0, 0);
    return { width, height, bytes: Array.from(c.getImageData(0, 0, width, height).data) };
  });
const mean = (p) => p.bytes.reduce((s, v, i) => s + (i % 4 < 3 ? v : 0), 0) / (3 * p.width * p.height);

/** Share of pixels of b, from column `shift` on, whose channels differ by at most `step` from a's there. */
function agreement(a, b, shift, step) {
  const scale = a.height / b.height;
  let same = 0, all = 0;
  for (let y = 0; y < b.height; ++y)
    for (let x = 0; x + shift < b.width; ++x) {
      const i = 4 * (Math.floor((y + 0.5) * scale) * a.width + Math.floor((x + 0.5) * scale)), j = 4 * (y * b.width + x + shift);
      ++all;
      same += [0, 1, 2].every((c) => Math.abs(a.bytes[i + c] - b.bytes[j + c]) <= step);
    }
  return same / all;
}

async function asExported(page) {
  await page.evaluate(() => { window.deltalux.state.ev = 0; });
  const shown = await pixelsOfPage(page), rendered = await pixelsOfFile(page, at('shown.png'));
  expect(shown.width === rendered.width && shown.height === rendered.height, `the picture is ${shown.width} x ${shown.height}`);
  const [a, b] = [mean(shown), mean(rendered)];
  expect(Math.abs(a - b) < 0.03 * b, `mean of the picture: page ${a.toFixed(1)}, render ${b.toFixed(1)}`);
  const share = agreement(shown, rendered, 0, 12);
  expect(share > 0.93, `${(100 * share).toFixed(1)} % of pixels within 12/255 of render --mesh-direct`);

  const lux = await pixelsOfFile(page, at('lux.png')), shift = lux.width - shown.width / coarser;
  await page.evaluate((top) => { window.deltalux.state.falseColour = true; window.deltalux.hands.scaleTo(top); }, await topOf(page));
  const coloured = await pixelsOfPage(page);
  const same = agreement(coloured, lux, shift, 16);
  expect(same > 0.9, `${(100 * same).toFixed(1)} % of false colours within 16/255 of render --falsecolor`);
  await page.evaluate(() => { window.deltalux.hands.falseColour(false); });
}
/** The scale that render chooses: 99.5 % of pixels are below it, rounded up. */
const topOf = (page) => page.evaluate(() => window.deltalux.automaticTop());

async function aSliderMoves(page) {
  const before = await page.evaluate(() => window.deltalux.gridLux());
  await page.locator('[data-dim="0"]').evaluate((slider) => {
    slider.value = '0.3';  // 4 x 0.3 x 0.3 = 36 %
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    slider.dispatchEvent(new Event('change', { bubbles: true }));
  });
  const edits = await page.evaluate(() => window.deltalux.edits());
  writeFileSync(at('edits.json'), JSON.stringify(edits));
  deltalux('update', at('box.dlx'), '--edits', at('edits.json'), '-o', at('dimmed.dlx'));
  deltalux('probe', at('dimmed.dlx'), '--points', at('grid.csv'), '-o', at('dimmed.csv'));
  const after = await page.evaluate(() => window.deltalux.gridLux()), probed = luxOf(at('dimmed.csv'));
  const off = after.map((v, i) => Math.abs(v - probed[i]) / probed[i]);
  expect(Math.max(...off) < 0.01, `the grid reads as probe: at most ${(100 * Math.max(...off)).toFixed(2)} % off, median ${(100 * median(off)).toFixed(2)} %`);
  expect(after.every((v, i) => Math.abs(v / before[i] - 0.36) < 1e-3), 'the grid is dimmed to 36 %');

  // Under the cursor: what the page writes there, and probe at that very place.
  const places = [], readings = [];
  for (const [x, y] of [[0.5, 0.93], [0.3, 0.85], [0.15, 0.5], [0.85, 0.5], [0.5, 0.3], [0.45, 0.08], [0.72, 0.9]]) {
    await page.mouse.move(x * size, y * size);
    const found = await page.evaluate(([px, py]) => window.deltalux.readingAt(px, py), [x * size, y * size]);
    const text = await page.locator('#reading b').textContent();
    if (!found) continue;
    if (Math.abs(Number(text.replace(/[^0-9.]/g, '')) - found.lux) > 0.006 * found.lux + 0.01) expect(false, `'${text}' is what is under the cursor: ${found.lux}`);
    places.push([...found.position, ...found.normal].join(','));
    readings.push(found.lux);
  }
  writeFileSync(at('cursor.csv'), ['x,y,z,nx,ny,nz', ...places].join('\n') + '\n');
  deltalux('probe', at('dimmed.dlx'), '--points', at('cursor.csv'), '-o', at('cursor-lux.csv'));
  const there = luxOf(at('cursor-lux.csv')), difference = readings.map((v, i) => Math.abs(v - there[i]) / there[i]);
  console.log(`     cursor ${readings.map((v) => v.toFixed(1)).join(' ')}; probe ${there.map((v) => v.toFixed(1)).join(' ')}`);
  expect(median(difference) < 0.05, `the cursor reads as probe: median ${(100 * median(difference)).toFixed(2)} %, worst ${(100 * Math.max(...difference)).toFixed(2)} %`);
}

async function theAddressKeepsIt(browser, page) {
  const hash = await page.evaluate(() => window.deltalux.hash());
  const other = await browser.newPage({ viewport: { width: size + 320, height: size } });
  await other.goto(`file://${at('page.html')}${hash}`);
  await other.waitForFunction(() => window.deltalux?.ready, null, { timeout: 120000 });
  const [a, b] = await Promise.all([page, other].map((p) => p.evaluate(() => [window.deltalux.gridLux(), window.deltalux.state.view])));
  expect(a[0].every((v, i) => Math.abs(v - b[0][i]) < 1e-6 * v), 'the address keeps the dimmers');
  expect(a[1].position.every((v, i) => Math.abs(v - b[1].position[i]) < 1e-3), 'the address keeps the view');
  await other.close();
}

/** A room of 5 x 4 x 2.6 m with a window, a table, and two lamps; the sun stands in the window. */
function roomWithLamps() {
  const wall = (name, material, ...points) => `${material} polygon ${name}\n0\n0\n${3 * points.length} ${points.flat().join(' ')}\n`;
  const lamp = (name, x) => wall(name, name, [x, 1.8, 2.5], [x, 2.2, 2.5], [x + 0.4, 2.2, 2.5], [x + 0.4, 1.8, 2.5]);
  return [
    'void plastic white\n0\n0\n5 .7 .7 .7 0 0\nvoid plastic wood\n0\n0\n5 .4 .3 .2 0 0\n',
    'void light left\n0\n0\n3 12 10 7\nvoid light right\n0\n0\n3 6 8 11\n',
    'void light sun\n0\n0\n3 3e4 2.8e4 2.4e4\nsun source morning\n0\n0\n4 .3 -.8 .5 .533\n',
    wall('floor', 'white', [0, 0, 0], [5, 0, 0], [5, 4, 0], [0, 4, 0]),
    wall('ceiling', 'white', [0, 0, 2.6], [0, 4, 2.6], [5, 4, 2.6], [5, 0, 2.6]),
    wall('back', 'white', [0, 4, 0], [5, 4, 0], [5, 4, 2.6], [0, 4, 2.6]),
    wall('west', 'white', [0, 0, 0], [0, 4, 0], [0, 4, 2.6], [0, 0, 2.6]),
    wall('east', 'white', [5, 0, 0], [5, 0, 2.6], [5, 4, 2.6], [5, 4, 0]),
    wall('sill', 'white', [0, 0, 0], [0, 0, 1], [5, 0, 1], [5, 0, 0]),
    wall('lintel', 'white', [0, 0, 2.2], [0, 0, 2.6], [5, 0, 2.6], [5, 0, 2.2]),
    wall('pier1', 'white', [0, 0, 1], [0, 0, 2.2], [2, 0, 2.2], [2, 0, 1]),
    wall('pier2', 'white', [3, 0, 1], [3, 0, 2.2], [5, 0, 2.2], [5, 0, 1]),
    '!genbox wood table 1.2 .8 .05 | xform -t 1.9 1.9 .7\n',
    lamp('left', 0.8), lamp('right', 3.8),
  ].join('');
}

/** What a page reads under the cursor, and `probe` of the solution at those places. */
async function cursorAgainstProbe(page, places, width, height, solution) {
  const found = [];
  for (const [x, y] of places) {
    const reading = await page.evaluate(([px, py]) => window.deltalux.readingAt(px, py), [x * width, y * height]);
    if (reading) found.push(reading);
  }
  writeFileSync(at('places.csv'), ['x,y,z,nx,ny,nz', ...found.map((r) => [...r.position, ...r.normal].join(','))].join('\n') + '\n');
  deltalux('probe', solution, '--points', at('places.csv'), '-o', at('places-lux.csv'));
  const there = luxOf(at('places-lux.csv'));
  return found.map((r, i) => ({ lux: r.lux, probed: there[i], off: Math.abs(r.lux - there[i]) / there[i] }));
}

async function groupsApart(browser) {
  const width = 300, height = 200;
  writeFileSync(at('room.rad'), roomWithLamps());
  writeFileSync(at('room.vf'), 'rvu -vtv -vp 2.5 .1 1.6 -vd 0 1 -.22 -vu 0 0 1 -vh 90 -vv 67.38\n');
  deltalux('solve', at('room.rad'), '--error', '0.02', '--by-light', '-o', at('room.dlx'));
  deltalux('export', at('room.dlx'), '--view', at('room.vf'), '-o', at('room.html'));
  const page = await browser.newPage({ viewport: { width: width + 320, height } });
  await page.goto(`file://${at('room.html')}`);
  await page.waitForFunction(() => window.deltalux?.ready, null, { timeout: 120000 });
  const names = await page.evaluate(() => window.deltalux.header.groups.map((g) => g.name));
  expect(names.length === 3, `the room has three groups: ${names.join(', ')}`);

  const lamp = names.findIndex((name) => /left/.test(name)), sun = names.findIndex((name) => /sun|morning/.test(name));
  await page.locator(`[data-dim="${lamp}"]`).evaluate((slider) => {
    slider.value = '0.8';  // 4 x 0.8 x 0.8 = 256 %
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    slider.dispatchEvent(new Event('change', { bubbles: true }));
  });
  writeFileSync(at('left.json'), JSON.stringify(await page.evaluate(() => window.deltalux.edits())));
  deltalux('update', at('room.dlx'), '--edits', at('left.json'), '-o', at('left.dlx'));
  // On the floor, the walls, the ceiling and the table, away from the rims of shadows.
  const smooth = [[0.15, 0.9], [0.85, 0.9], [0.12, 0.5], [0.88, 0.5], [0.5, 0.3], [0.3, 0.28], [0.5, 0.1], [0.5, 0.5], [0.2, 0.75]];
  const read = await cursorAgainstProbe(page, smooth, width, height, at('left.dlx'));
  for (const r of read) console.log(`     cursor ${r.lux.toFixed(1)}, probe ${r.probed.toFixed(1)}: ${(100 * r.off).toFixed(2)} %`);
  expect(read.length >= 8 && median(read.map((r) => r.off)) < 0.01, `a lamp is dimmed by itself: median ${(100 * median(read.map((r) => r.off))).toFixed(2)} % off probe`);
  // Twice what the solution's irradiance is asked to be right to.
  expect(Math.max(...read.map((r) => r.off)) < 0.04, `worst ${(100 * Math.max(...read.map((r) => r.off))).toFixed(2)} %`);

  deltalux('render', at('left.dlx'), '--view', at('room.vf'), '--size', `${width}x${height}`, '--ev', '-3', '-o', at('left.png'));
  await page.evaluate(() => { window.deltalux.state.ev = -3; });
  const shown = await pixelsOfPage(page), rendered = await pixelsOfFile(page, at('left.png'));
  const share = agreement(shown, rendered, 0, 12);
  expect(shown.width === rendered.width && share > 0.95, `${(100 * share).toFixed(1)} % of pixels within 12/255 of render`);
  if (screenshot) await page.screenshot({ path: screenshot.replace(/\.png$/, '') + '-lamps.png' });
  await page.close();
}

try {
  await main();
} finally {
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failures ? 1 : 0);
