// The page in a browser: node page_test.mjs DELTALUX SOURCES [SCREENSHOT.png]. Opens a page of the Cornell box from
// file://, moves a slider, and compares what it reads and shows with `deltalux probe` and `deltalux render`.
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

try {
  await main();
} finally {
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failures ? 1 : 0);
