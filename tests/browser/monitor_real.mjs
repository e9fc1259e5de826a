// `wearwell monitor` itself: it follows a result of the degradation study, machines report by HTTP, and the page in headless
// Chromium shows them as they do. What it shows of the riskiest is what the program prints of it at its end.
//
//   node monitor_real.mjs NODE_MODULES WEARWELL RESULT FOLDER
import {spawn} from 'node:child_process';
import {cpSync, mkdirSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {createServer} from 'node:net';
import {join, resolve} from 'node:path';

const [modules, wearwell, result, folder] = process.argv.slice(2);
const require = createRequire(join(resolve(modules), 'any.js'));
const {chromium} = require('playwright-core');

const faults = [];
const check = (holds, fault) => { if (!holds) faults.push(fault); };

rmSync(folder, {recursive: true, force: true});
mkdirSync(folder, {recursive: true});
cpSync(result, join(folder, 'result'), {recursive: true});
const port = await new Promise((done) => {
  const probe = createServer();
  probe.listen(0, '127.0.0.1', () => { const {port: free} = probe.address(); probe.close(() => done(free)); });
});
writeFileSync(join(folder, 'fleet.toml'), `title = "Lasers in the field"
result = "result"
[source.web]
kind = "http"
[reading]
unit = "laser"
time = "ts"
time_format = "unix s"
[reading.columns]
increase = { field = "increase", unit = "%" }
time = { field = "hours", unit = "h" }
[alarm]
horizon = "500 h"
watch = 0.05
act = 0.3
[http]
listen = "127.0.0.1:${port}"
`);

const address = `http://127.0.0.1:${port}/`;
const program = spawn(wearwell, ['monitor', join(folder, 'fleet.toml'), '--json'], {stdio: ['ignore', 'pipe', 'pipe']});
let out = '', err = '';
program.stdout.on('data', (data) => { out += data; });
program.stderr.on('data', (data) => { err += data; });
const ended = new Promise((done) => program.once('exit', done));
const sleep = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
for (let i = 0; i < 600; ++i) {
  if (await fetch(`${address}health`).then((answer) => answer.ok, () => false)) break;
  await sleep(100);
}

// Laser 0 wears fastest. Paths that any machine draws: what is tested is how they show.
const lasers = 12, begin = Math.floor(Date.now() / 1000) - 3600;
async function report(step) {
  const lines = [];
  for (let i = 0; i < lasers; ++i) {
    lines.push(JSON.stringify({laser: `L${String(i).padStart(2, '0')}`, ts: begin + 60 * step, hours: 250 * step,
                               increase: Number((step * (0.9 - 0.05 * i)).toFixed(3))}));
  }
  const answer = await fetch(`${address}api/v1/readings`, {method: 'POST', body: lines.join('\n')});
  return {status: answer.status, ...await answer.json()};
}

const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync'],
});
try {
  const page = await browser.newPage({viewport: {width: 1280, height: 900}});
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) faults.push(`console: ${message.text()}`); });
  page.on('pageerror', (error) => faults.push(`script: ${error.message}`));
  await page.goto(address, {timeout: 60000});
  await page.waitForSelector('#connection[data-state="live"]', {timeout: 60000});
  check((await page.textContent('#subtitle')).startsWith('0 lasers'), 'a fleet of none is not told');
  for (let step = 1; step <= 10; ++step) {
    const {status, readings} = await report(step);
    check(status === 200 && readings === lasers, `report ${step}: ${status}, ${readings} readings`);
  }
  const again = await report(10);
  check(again.status === 200 && again.repeated === lasers, 'the same again is not found as repeated');
  const wrong = await fetch(`${address}api/v1/readings`, {method: 'POST', body: '{"laser": "L00", "hours": "many"}'});
  check(wrong.status === 400, `nonsense is answered with ${wrong.status}`);
  // All of it arrives by events, with nobody touching the page.
  const arrived = () => [...document.querySelectorAll('.row')].length === 12 && document.querySelector('.row[id="row-0"]').dataset.unit === 'L00';
  await page.waitForFunction(arrived, null, {timeout: 60000}).catch(() => faults.push('twelve lasers do not show'));
  await page.goto(`${address}#unit=L00`);
  const known = await fetch(`${address}api/v1/units/L00`).then((answer) => answer.json());
  const ahead = known.path.filter((each) => each.at > known.at);
  check(ahead.length > 20 && ahead.every((each, i) => each.level.q05 <= each.level.q50 && each.level.q50 <= each.level.q95 &&
                                                      (i === 0 || each.level.q50 >= ahead[i - 1].level.q50)), 'the path ahead is none');
  await page.waitForFunction(() => document.querySelector('#figure-path path.band.ahead')?.getAttribute('d').length > 100, null, {timeout: 60000})
      .catch(() => faults.push('no band ahead shows'));
  await page.waitForFunction(() => /^10\D/.test(document.querySelector('.facts dd')?.textContent + ' '), null, {timeout: 60000})
      .catch(() => faults.push('ten readings do not show'));
  check(await page.evaluate(() => document.querySelectorAll('#detail figure').length) === 3, 'not all of three plots are drawn');
  check(/Of 9 earlier forecasts/.test(await page.textContent('.tally')), 'forecasts that were judged are not told');
  const risk = await page.evaluate(() => document.querySelector('.lead').textContent);
  const view = await (await fetch(`${address}api/v1/units/L00`)).json();
  check(risk.includes(`${(100 * view.risk).toFixed(0)}\u202f%`) || view.risk > 0.999, `"${risk}", and the risk is ${view.risk}`);
  await page.screenshot({path: join(folder, 'page.png')});

  // A part is replaced, by the form; then the replacement is cancelled.
  await page.click('#detail .report summary');
  await page.fill('#detail .report .event-form input[name="by"]', 'A. <b>Smith</b>');
  await page.fill('#detail .report .event-form input[name="note"]', 'new laser');
  await page.fill('#detail .report .event-form .fields input[type="number"]', '2500');
  await page.fill('#detail .report .event-form input[type="datetime-local"]', '2100-01-01T00:00');
  await page.screenshot({path: join(folder, 'form.png'), fullPage: true});
  await page.click('#detail .report .event-form button');
  await page.waitForFunction(() => document.querySelector('.events-list li')?.textContent.includes('A new part is installed'), null, {timeout: 60000})
      .catch(() => faults.push('the reported event does not show'));
  check((await page.textContent('.events-list')).includes('A. <b>Smith</b>'), 'who reported it does not show as text');
  check((await page.textContent('.named')).includes('part 2'), 'the part is not named');
  const replaced = await (await fetch(`${address}api/v1/units/L00`)).json();
  check(replaced.part === 2 && replaced.events[0].use === 2500 && replaced.quality.readings === 0, `part ${replaced.part} after the replacement`);
  const event = (body) => fetch(`${address}api/v1/units/L00/events`, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
  check((await event({event: 'cancelled', number: 1})).status === 400, 'an event that names no one is taken');
  check((await event({event: 'cancelled', number: 1, by: 'x'})).status === 200, 'an event cannot be cancelled');
  await page.waitForFunction(() => document.querySelector('.events-list li.cancelled'), null, {timeout: 60000}).catch(() => faults.push('a cancelled event does not show'));
  const back = await (await fetch(`${address}api/v1/units/L00`)).json();
  check(back.part === 1 && back.risk === view.risk && back.quality.readings === 10, 'a cancelled event changes the forecast');
  await page.screenshot({path: join(folder, 'events.png'), fullPage: true});

  // A unit that is not known yet goes into service; the name of a known one is refused.
  const install = async (name) => {
    await page.fill('#install input:not([name])', name);
    await page.fill('#install input[name="by"]', 'A. Smith');
    await page.fill('#install input[name="time"][type="number"]', '100');
    await page.click('#install button');
  };
  await page.click('#install summary');
  await install('L00');
  await page.waitForFunction(() => /is known already/.test(document.querySelector('#install .wrong')?.textContent), null, {timeout: 60000}).catch(() => faults.push('a known unit is put into service'));
  await install('L 77/b');
  await page.waitForFunction(() => /^Stored/.test(document.querySelector('#install .note')?.textContent), null, {timeout: 60000}).catch(() => faults.push('a new unit is not put into service'));
  await page.waitForFunction(() => /L 77\/b/.test(document.querySelector('#rows').textContent), null, {timeout: 60000}).catch(() => faults.push('a new unit does not show'));
  const fresh = await (await fetch(`${address}api/v1/units/${encodeURIComponent('L 77/b')}`)).json();
  check(fresh.part === 1 && fresh.events[0].use === 100, `part ${fresh.part} of a unit that begins with its installation`);
} finally {
  await browser.close();
  program.kill('SIGTERM');
}
const status = await ended;
check(status === 0, `the program ended with ${status}: ${err}`);
try {
  JSON.parse(out);
} catch {
  faults.push(`what the program prints is no JSON: ${out.slice(0, 200)}`);
}
for (const fault of faults) console.log(fault);
console.log(faults.length ? 'FAILED' : 'passed');
process.exit(faults.length ? 1 : 0);
