// The monitor's page in headless Chromium: at both widths, light and dark, it renders, follows what machines report,
// is worked by keyboard alone, says when it lost its server, is clean for axe-core, covers no text of a plot, logs no error and fetches nothing
// from elsewhere.
//
//   node monitor.mjs NODE_MODULES SCREENSHOTS SERVE_GENERATED
import {spawn} from 'node:child_process';
import {mkdirSync, readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';
import {createInterface} from 'node:readline';
import {boxFaults} from './plot_boxes.mjs';

const [modules, screenshots, server] = process.argv.slice(2);
const require = createRequire(join(resolve(modules), 'any.js'));
const {chromium} = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
const token = 'a token that is long enough'.replaceAll(' ', '-');

const faults = [];
const check = (holds, fault) => { if (!holds) faults.push(fault); };

// Its address, and how to let a machine report; it ends with us, also where a check has thrown.
const children = [];
async function serve(units, ...more) {
  const child = spawn(server, [String(units), '0', ...more], {stdio: ['pipe', 'pipe', 'inherit']});
  children.push(child);
  const address = await new Promise((done, failed) => {
    createInterface(child.stdout).once('line', done);
    child.once('exit', () => failed(new Error('the server ended')));
  });
  return {
    address,
    report: (unit) => child.stdin.write(`${unit}\n`),
    stop: () => new Promise((done) => { child.once('exit', done); child.stdin.end(); }),
  };
}

async function open(context, address, complaints) {
  const page = await context.newPage();
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) complaints.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => complaints.push(`script: ${error.message}`));
  page.on('dialog', (dialog) => { complaints.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on('request', (request) => {
    if (!request.url().startsWith(address) && !request.url().startsWith('data:')) complaints.push(`request: ${request.url()}`);
  });
  await page.goto(address, {timeout: 60000});
  return page;
}

const live = (page) => page.waitForSelector('#connection[data-state="live"]', {timeout: 60000});
const drawn = (page) => page.waitForFunction(() => document.querySelectorAll('#detail figure').length === 3, null, {timeout: 60000});

async function accessibility(page, what, complaints) {
  await page.evaluate(axe);
  const {violations} = await page.evaluate(
      () => axe.run({runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice']}));
  for (const {id, help, nodes} of violations)
    complaints.push(`${what}: ${id}: ${help}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 160)).join(' | ')}`);
}

function layout(page) {
  return page.evaluate(() => {
    const wrong = [];
    if (document.documentElement.scrollWidth > innerWidth) wrong.push('the page is wider than the screen');
    for (const svg of document.querySelectorAll('svg.plot')) {
      if (svg.getBoundingClientRect().width === 0) continue;
      if (svg.getBoundingClientRect().right > innerWidth + 1) wrong.push(`${svg.parentNode.id} leaves the screen`);
      if (svg.querySelector('[d*="NaN"], [d*="Infinity"], [x1="NaN"], [y1="NaN"], [cy="NaN"]')) wrong.push(`${svg.parentNode.id} has NaN`);
      for (const mark of svg.querySelectorAll('.band, .line')) {
        const box = mark.getBoundingClientRect();
        if (mark.getAttribute('d') && box.width + box.height < 2) wrong.push(`${svg.parentNode.id} shows nothing`);
      }
      for (const text of svg.querySelectorAll('text')) {
        const box = text.getBoundingClientRect(), frame = svg.getBoundingClientRect();
        if (box.left < frame.left - 1 || box.right > frame.right + 1) wrong.push(`"${text.textContent}" of ${svg.parentNode.id} is cut off`);
      }
    }
    for (const each of document.querySelectorAll('.row .badge, .row .risk, .row .age, .tiles .value')) {
      if (each.scrollWidth > each.clientWidth + 1) wrong.push(`"${each.textContent}" does not fit`);
    }
    if (document.querySelector('img')) wrong.push('a name became markup');
    return [...new Set(wrong)];
  });
}

// Each look, with a fleet that nobody can show whole.
async function looks(browser, {name, ...options}) {
  const complaints = [];
  const {address, stop} = await serve(1500);
  const context = await browser.newContext(options);
  const page = await open(context, address, complaints);
  await live(page);
  await page.waitForSelector('.row .badge');
  complaints.push(...await layout(page));
  const elements = await page.evaluate(() => document.querySelectorAll('.row').length);
  check(elements > 4 && elements < 60, `${name}: ${elements} rows are elements`);
  await page.screenshot({path: join(screenshots, `monitor-${name}.png`)});
  await accessibility(page, 'fleet', complaints);
  if (options.viewport.width < 700) await page.click('.row >> nth=3');
  await drawn(page);
  complaints.push(...await layout(page), ...await boxFaults(page, 'svg.plot'));
  await page.screenshot({path: join(screenshots, `monitor-${name}-unit.png`), fullPage: true});
  await page.evaluate(() => { document.getElementById('detail').scrollTop = 600; });
  await page.screenshot({path: join(screenshots, `monitor-${name}-below.png`)});
  await accessibility(page, 'unit', complaints);
  // The one of which nothing was heard: no readings, an interval without end.
  await page.goto(`${address}#unit=never%20heard%20of`);
  await page.waitForSelector('#detail[data-unit="never heard of"]');
  complaints.push(...await layout(page), ...await boxFaults(page, 'svg.plot'));
  check(/more than/.test(await page.textContent('.tiles')), `${name}: an interval without end is not told`);
  await page.screenshot({path: join(screenshots, `monitor-${name}-unheard.png`)});
  // One whose forecast is in doubt: why stands above the forecast.
  const {units} = await (await fetch(`${address}api/v1/units?count=500`)).json();
  const doubted = units.find((each) => each.alarm === 'doubt');
  await page.goto(`${address}#unit=${encodeURIComponent(doubted.unit)}`);
  await page.waitForSelector(`#detail[data-unit="${doubted.unit}"] .callout.doubt`);
  check((await page.textContent('#detail .callout.doubt')).toLowerCase().includes(doubted.doubt), `${name}: the reason for doubt is not shown`);
  check((await page.textContent('#detail .badge')) === 'doubt', `${name}: the state of doubt is not shown`);
  complaints.push(...await layout(page));
  await page.screenshot({path: join(screenshots, `monitor-${name}-doubt.png`)});
  await accessibility(page, 'doubt', complaints);
  await context.close();
  await stop();
  for (const each of complaints) faults.push(`${name}: ${each}`);
}

async function lively(browser) {
  const complaints = [];
  const {address, report, stop} = await serve(40);
  const context = await browser.newContext({viewport: {width: 1280, height: 900}});
  const page = await open(context, address, complaints);
  await live(page);
  // Machine 20 reports: its plots and the count of messages go on, without a look at anything else.
  const name = await (await fetch(`${address}api/v1/units?search=M1020`)).json().then(({units}) => units[0].unit);
  await page.goto(`${address}#unit=${name}`);
  await page.waitForSelector(`#detail[data-unit="${name}"] .tally`);
  const before = await page.textContent('#detail .facts');
  await page.fill('#search', name);
  await page.waitForFunction(() => document.querySelectorAll('.row').length === 1, null, {timeout: 10000});
  for (let i = 0; i < 5; ++i) report(20);
  await page.waitForFunction((old) => document.querySelector('#detail .facts').textContent !== old, before, {timeout: 15000})
      .catch(() => faults.push('a reading does not show'));
  await page.waitForFunction((unit) => [...document.querySelectorAll('.row')].some((row) => row.dataset.unit === unit && /^\D*[0-9]+\ss$/.test(row.querySelector('.age').textContent)),
                             name, {timeout: 15000}).catch(() => faults.push('the list does not follow'));

  // By keyboard: search, down to a machine, open it, read values off a plot, back.
  await page.keyboard.press('Escape');
  await page.keyboard.press('/');
  await page.keyboard.press('Control+A');
  await page.keyboard.type('m103');
  await page.waitForFunction(() => document.querySelectorAll('.row').length === 10, null, {timeout: 10000})
      .catch(() => faults.push('the search does not narrow'));
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('Enter');
  const chosen = await page.evaluate(() => decodeURIComponent(location.hash.slice(6)));
  check(/^M103\d$/.test(chosen), `by keyboard "${chosen}" is opened`);
  await page.waitForSelector(`#detail[data-unit="${chosen}"] svg.plot`);
  await page.focus('#figure-survival svg');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  check(/last longer than/.test(await page.textContent('#figure-survival .readout')), 'arrow keys read nothing off a plot');
  await page.keyboard.press('Escape');
  check(await page.evaluate(() => document.activeElement.id) === 'list', 'Escape does not lead back to the list');
  // Names that would be markup, or a path, are names.
  for (const odd of ['<img src=x onerror=alert(1)>', 'hall 2/line 7 100%', 'Pumpe Süd "3" \\ µ']) {
    await page.fill('#search', odd);
    await page.waitForFunction((text) => document.querySelector('.row')?.dataset.unit === text, odd, {timeout: 10000})
        .catch(() => faults.push(`${odd} is not found`));
    await page.click('.row');
    await page.waitForFunction((text) => document.getElementById('unit-name')?.textContent === text, odd, {timeout: 10000})
        .catch(() => faults.push(`${odd} is not opened`));
  }
  complaints.push(...await layout(page));
  for (const each of complaints) faults.push(`lively: ${each}`);

  // Were a name to become markup, the policy would still not let it run.
  const length = complaints.length;
  await page.evaluate(() => {
    document.body.insertAdjacentHTML('beforeend', '<b onclick="window.owned = 1"></b>');
    document.body.lastChild.click();
    const script = document.createElement('script');
    script.textContent = 'window.owned = 2';
    document.body.append(script);
  });
  check(await page.evaluate(() => window.owned) === undefined, 'the policy lets a script run');
  complaints.length = length;

  // The server goes: the page says so; what it then logs is the browser's.
  await stop();
  await page.waitForSelector('#connection[data-state="lost"]', {timeout: 15000}).catch(() => faults.push('a lost connection is not told'));
  check(/Connection lost/.test(await page.textContent('#banners')), 'no banner tells that the connection is lost');
  await page.screenshot({path: join(screenshots, 'monitor-lost.png')});
  await context.close();
}

// A server that is starting is not a lost one; then the page goes on.
async function starting(browser) {
  const {address, stop} = await serve(20);
  const context = await browser.newContext({viewport: {width: 1280, height: 900}});
  let begun = false;
  await context.route('**/api/v1/fleet', (route) => (begun ? route.continue() : route.fulfill(
      {status: 503, contentType: 'application/json', body: '{"error": "the monitor is starting: ask again later"}'})));
  const page = await open(context, address, []);  // the browser logs each 503
  await page.waitForFunction(() => document.getElementById('connection').textContent === 'Starting', null, {timeout: 15000})
      .catch(() => faults.push('a start is not named'));
  const banners = await page.textContent('#banners');
  check(/The monitor is starting: ask again later/.test(banners) && !/lost/.test(banners), `while the monitor starts the page says: ${banners}`);
  begun = true;
  await live(page);
  check(!/tarting/.test(await page.textContent('#banners')), 'the page says that the monitor starts when it has');
  await context.close();
  await stop();
}

// With a token a form asks for it, once.
async function signed(browser) {
  const complaints = [];
  const {address, stop} = await serve(20, token);
  const context = await browser.newContext({viewport: {width: 390, height: 844}});
  const page = await open(context, address, complaints);
  check(page.url() === `${address}login`, `without a token ${page.url()} is shown`);
  await accessibility(page, 'sign in', complaints);
  await page.screenshot({path: join(screenshots, 'monitor-login.png')});
  await page.keyboard.press('Tab');
  await page.keyboard.type(token);
  await page.keyboard.press('Enter');
  await live(page);
  const cookies = await context.cookies();
  check(cookies.length === 1 && cookies[0].httpOnly && cookies[0].sameSite === 'Lax' && !cookies[0].value.includes(token), 'the cookie is not what it should be');
  await page.click('text=Sign out');
  await page.waitForURL(`${address}login`);
  check((await context.cookies()).length === 0, 'signing out leaves the cookie');
  for (const each of complaints) faults.push(`signed: ${each}`);
  await context.close();
  await stop();
}

mkdirSync(screenshots, {recursive: true});
const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync'],
});
try {
  await looks(browser, {name: 'wide', viewport: {width: 1280, height: 900}, colorScheme: 'light'});
  await looks(browser, {name: 'wide-dark', viewport: {width: 1280, height: 900}, colorScheme: 'dark'});
  await looks(browser, {name: 'phone', viewport: {width: 390, height: 844}, colorScheme: 'light'});
  await looks(browser, {name: 'phone-dark', viewport: {width: 390, height: 844}, colorScheme: 'dark'});
  await lively(browser);
  await starting(browser);
  await signed(browser);
} finally {
  for (const child of children) child.kill('SIGKILL');
  await browser.close();
}
for (const fault of faults) console.log(fault);
console.log(faults.length ? 'FAILED' : 'passed');
process.exit(faults.length ? 1 : 0);
