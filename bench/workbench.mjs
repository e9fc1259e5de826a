// What the page of `wearwell open` takes for each interaction with a large table, in headless Chromium. Two times in ms: from the
// input to the next frame, in which the page shows that it has understood (Event Timing), and from the input to the frame with the answer.
//
//   node bench/workbench.mjs NODE_MODULES WEARWELL [ROWS]
import {spawn} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';
import {createInterface} from 'node:readline';

const [modules, wearwell, given] = process.argv.slice(2);
const count = Number(given ?? 1e5);
const {chromium} = createRequire(join(resolve(modules), 'any.js'))('playwright-core');

// Weibull lives with suspensions, seven columns; one column has another name in each row. The generator is mulberry32.
let state = 7;
function uniform() {
  state = (state + 0x6D2B79F5) | 0;
  let t = Math.imul(state ^ (state >>> 15), 1 | state);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return (((t ^ (t >>> 14)) >>> 0) + 0.5) / 4294967296;
}
const folder = mkdtempSync(join(tmpdir(), 'workbench-'));
const lines = ['unit,life [h],status,plant,batch,shift,clerk'];
for (let i = 0; i < count; ++i) {
  const life = 1200 * (-Math.log(uniform())) ** (1 / 1.8), runs = life > 1500;
  lines.push(`U${i},${Math.min(life, 1500).toFixed(2)},${runs ? 'running' : 'failure'},${'ABCD'[Math.floor(4 * uniform())]},${1 + (i % 211)},${1 + (i % 3)},n${i % 977}`);
}
writeFileSync(join(folder, 'lives.csv'), `${lines.join('\n')}\n`);

const child = spawn(wearwell, ['open', folder, '--no-browser'], {stdio: ['ignore', 'pipe', 'inherit']});
const address = await new Promise((done) => { createInterface(child.stdout).once('line', (line) => done(line.slice(line.indexOf('http')))); });
const browser = await chromium.launch({executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--disable-gpu']});
const page = await browser.newPage({viewport: {width: 1280, height: 900}});
page.on('pageerror', (error) => console.error(error.message));
await page.addInitScript(() => {
  globalThis.frames_ = [];
  new PerformanceObserver((list) => { for (const each of list.getEntries()) globalThis.frames_.push([each.startTime, each.duration]); })
      .observe({type: 'event', durationThreshold: 16, buffered: true});
  for (const each of ['pointerdown', 'keydown', 'change', 'input'])
    addEventListener(each, (event) => { globalThis.began_ ??= event.timeStamp; }, {capture: true});
});
await page.goto(address);
await page.waitForSelector('#connection[data-state="live"]');

// `shown`: a function of the page, true once the answer stands.
async function measure(what, act, shown, argument = null) {
  await page.waitForTimeout(400);
  await page.evaluate(() => { globalThis.frames_.length = 0; globalThis.began_ = undefined; });
  await act();
  await page.waitForFunction(shown, argument, {polling: 'raf', timeout: 600000});
  const answer = await page.evaluate(() => performance.now() - globalThis.began_);
  await page.waitForTimeout(200);
  const frame = await page.evaluate(() => Math.max(16, ...globalThis.frames_.map(([, duration]) => duration)));
  console.log(`${what.padEnd(44)} ${String(Math.round(frame)).padStart(6)} ${String(Math.round(answer)).padStart(8)}`);
}

console.log(`${count} rows${' '.repeat(36)} frame   answer`.slice(0, 60));
await page.selectOption('#in-folder', 'lives.csv');
const openButton = page.locator('#panel-data .doors button');
await measure('open: the first lines stand there', () => openButton.click(), () => document.querySelector('#reading pre')?.textContent.startsWith('unit,') || document.querySelector('#panel-data tbody tr'));
const begun = Date.now();
await page.waitForSelector('#panel-data tbody tr', {timeout: 600000});
console.log(`  (the whole table ${Date.now() - begun + 600} ms after it)`);
await page.waitForSelector('#panel-data svg.plot', {timeout: 600000});
await page.waitForSelector('.check[data-state="good"]', {state: 'attached', timeout: 600000});
await measure('later rows', () => page.click('button:has-text("Later rows")'), () => document.querySelector('#panel-data tbody th').textContent === '51');
await measure('go to a row', async () => { await page.fill('#go-row', String(Math.floor(count / 2))); await page.press('#go-row', 'Enter'); }, (row) => document.querySelector('#panel-data tbody th').textContent.replace(/\D/g, '') === row, String(Math.floor(count / 2)));
const plotted = () => { const now = document.querySelector('#panel-data svg.plot'); return now && now !== globalThis.plot_; };
const plots = async (what, act) => { await page.evaluate(() => { globalThis.plot_ = document.querySelector('#panel-data svg.plot'); }); await measure(what, act, plotted); };
await plots('another column in the plot', () => page.selectOption('#plot-y', {label: 'batch'}));
await plots('a logarithmic axis', () => page.check('#log-x'));
await plots('colours by a column of few words', () => page.selectOption('#plot-by', {label: 'status'}));
await plots('colours by a column of as many as rows', () => page.selectOption('#plot-by', {label: 'unit'}));
const box = await page.locator('#panel-data svg.plot').boundingBox();
await measure('pointing at the plot', async () => { await page.mouse.move(box.x + 200, box.y + 100); await page.mouse.down(); await page.mouse.up(); await page.mouse.move(box.x + 260, box.y + 120, {steps: 10}); }, () => document.querySelector('#panel-data .readout').textContent.startsWith('Row'));
await measure('the step Model', () => page.click('#step-model'), () => !document.querySelector('#panel-model').hidden);
const typed = (await page.inputValue('#study')).indexOf('\n');
await page.focus('#study');
await page.evaluate((at) => document.getElementById('study').setSelectionRange(at - 1, at - 1), typed);
await measure('a letter typed: it stands there', () => page.keyboard.type('x'), () => document.getElementById('study').value.split('\n')[0].includes('x"'));
await page.waitForSelector('.check[data-state="good"]', {timeout: 600000});
await measure('a letter typed: the form follows', () => page.keyboard.type('y'), () => document.getElementById('key-title').value.endsWith('xy'));
await measure('an error typed: its line is marked', () => page.keyboard.type('"'), () => document.querySelector('.gutter .bad')?.textContent === '1');
await page.keyboard.press('Backspace');
await page.waitForSelector('.check[data-state="good"]', {timeout: 600000});
await measure('a value typed: it is checked with the data', () => page.keyboard.type('z'), () => document.querySelector('.check').dataset.state === 'good' && document.getElementById('key-title').value.endsWith('xyz'));
await measure('a field of the form', async () => { await page.fill('[id="key-predict.credible_level"]', '0.95'); await page.press('[id="key-predict.credible_level"]', 'Tab'); }, () => document.getElementById('study').value.includes('0.95'));
await page.waitForSelector('.check[data-state="good"]', {timeout: 600000});
await measure('priors as curves', () => page.click('#priors summary'), () => document.querySelector('#priors .grip'));
const grip = page.locator('#priors .grip').first();
await grip.scrollIntoViewIfNeeded();
const at = await grip.boundingBox(), study = await page.inputValue('#study');
await measure('a handle of a prior dragged: text follows', async () => {
  await page.mouse.move(at.x + at.width / 2, at.y + at.height / 2);
  await page.mouse.down();
  await page.mouse.move(at.x + at.width / 2 + 20, at.y + at.height / 2, {steps: 10});
}, (old) => document.getElementById('study').value !== old, study);
await page.mouse.up();
await page.waitForSelector('.check[data-state="good"]', {timeout: 600000});
await measure('families on probability paper', () => page.click('#families summary'), () => document.querySelector('.family .fitted') || document.querySelector('#families pre'));
await measure('undo', () => page.click('button:has-text("Undo")'), (now) => document.getElementById('study').value === now, study);
await measure('the step Data', () => page.click('#step-data'), () => !document.querySelector('#panel-data').hidden);
await browser.close();
child.kill('SIGINT');
await new Promise((done) => { child.once('exit', done); });
rmSync(folder, {recursive: true, force: true});
