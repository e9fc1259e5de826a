// A folder of results that somebody else made: wherever a text may stand in summary.json, report.json and the draws there
// is one that would run a script or fetch something, were it taken for markup or code. `wearwell report` makes a page of it,
// and headless Chromium opens the page: nothing may have run, and nothing may have been asked for.
//
//   node hostile.mjs NODE_MODULES WEARWELL FOLDER     FOLDER: as wearwell fit wrote it
import {spawnSync} from 'node:child_process';
import {readdirSync, readFileSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [modules, wearwell, folder] = process.argv.slice(2);
const require = createRequire(join(resolve(modules), 'any.js'));
const {chromium} = require('playwright-core');

const evil = '"\'><img src=x onerror="window.owned=1"><svg onload="window.owned=2"><script>window.owned=3</script>' +
             '</script><script>window.owned=4</script><!--<iframe src="javascript:parent.owned=5"></iframe>\u2028\u202e\u001b[2J';
// Without what would break lines and cells of the draws, where the names of parameters stand as well.
const evilName = 'k"><img src=x onerror="window.owned=6"><script>window.owned=7</script>';

// Words of which only some may stand there; anything else is refused.
const fixed = new Set(['at', 'verdict', 'outcome', 'callout', 'badge', 'format']);
const isFixed = (key, value) => key !== 'at' || /^(inside|lower bound|upper bound)$/.test(value);

function poisoned(value, key = '') {
  if (typeof value === 'string') return fixed.has(key) && isFixed(key, value) ? value : value + evil;
  if (Array.isArray(value)) return value.map((each) => poisoned(each, key));
  if (value === null || typeof value !== 'object') return value;
  // Our own plots stay as they are; hostile ones are put beside them.
  return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, name === 'specification' ? each : poisoned(each, name)]));
}

const hostileFigure = {
  id: evil,
  title: evil,
  caption: evil,
  specification: {
    $schema: 'https://vega.github.io/schema/vega-lite/v6.json',
    usermeta: {embedOptions: {ast: false, sourceHeader: '<script>opener.owned=8;window.owned=8</script>'}},
    description: evil,
    title: evil,
    width: 'container',
    data: {values: [{x: 1, y: 2, t: evil, l: 'javascript:window.owned=9'}]},
    layer: [
      {mark: {type: 'point', tooltip: {content: 'data'}},
       encoding: {x: {field: 'x', title: evil}, y: {field: 'y'}, href: {field: 'l'}, color: {datum: evil}}},
      {transform: [{calculate: 'constructor.constructor("window.owned=10")()', as: 'z'}],
       mark: 'point', encoding: {x: {field: 'z'}}},
      {mark: {type: 'image', url: 'https://example.invalid/x.png', width: 9, height: 9}, encoding: {x: {field: 'x'}}},
    ],
  },
};
const fetchingFigure = {
  id: 'fetching',
  title: 'fetching',
  caption: '',
  specification: {data: {url: 'https://example.invalid/data.csv'}, layer: [{mark: 'point', encoding: {}}]},
};

function poison() {
  const read = (name) => JSON.parse(readFileSync(join(folder, name), 'utf8'));
  const write = (name, value) => writeFileSync(join(folder, name), JSON.stringify(value));
  const summary = read('summary.json');
  const first = Object.keys(summary.parameters)[0];
  const renamed = (object) => {
    if (Array.isArray(object)) return object.map(renamed);
    if (object === null || typeof object !== 'object') return object;
    return Object.fromEntries(Object.entries(object).map(([key, each]) => [key === first ? evilName : key, renamed(each)]));
  };
  write('summary.json', poisoned(renamed(summary)));
  const own = read('report.json');
  const report = poisoned(own);
  report.sections.forEach((section, i) => { section.id = own.sections[i].id; });
  const fit = report.sections.find((section) => section.id === 'fit');
  fit.blocks.push({figures: [hostileFigure, fetchingFigure]},
                  {table: evil, caption: evil, words: true,
                   columns: [{name: evil, unit: evil, format: 'significant', digits: 4, range: false}],
                   rows: [[evil], [{badge: 'warn', word: evil}]]});
  report.sections.push({id: evil, name: evil, title: evil, blocks: [{prose: evil, lead: true}]});
  write('report.json', report);
  for (const name of readdirSync(folder).filter((each) => each.startsWith('draws_'))) {
    const lines = readFileSync(join(folder, name), 'utf8').split('\n');
    const heading = lines.findIndex((line) => line !== '' && !line.startsWith('#'));
    lines[heading] = lines[heading].split(',').map((each) => each === first ? `"${evilName.replaceAll('"', '""')}"` : each).join(',');
    writeFileSync(join(folder, name), lines.join('\n'));
  }
}

const faults = [];
poison();
const run = spawnSync(wearwell, ['report', folder], {encoding: 'utf8'});
if (run.status !== 0) {
  console.log(`wearwell report: ${run.status} ${run.stderr}`);
  process.exit(1);
}

const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync'],
});
try {
  const context = await browser.newContext();
  const page = await context.newPage();
  const address = pathToFileURL(resolve(folder, 'report.html')).href;
  const asked = [];
  context.on('request', (request) => asked.push(request.url()));
  page.on('dialog', (dialog) => {
    faults.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  await page.goto(address, {timeout: 120000});
  await page.waitForFunction(
      () => [...document.querySelectorAll('figure')].every((each) => each.dataset.drawn || each.dataset.failed), null,
      {timeout: 120000});
  // Our own figures are drawn in spite of it: only what is not ours may fail.
  const failed = await page.evaluate(() => [...document.querySelectorAll('figure[data-failed]')].map((each) => each.id));
  for (const id of failed) {
    if (id !== hostileFigure.id && id !== 'fetching' && !id.startsWith('"')) faults.push(`${id} is not drawn`);
  }
  const drawn = await page.evaluate(() => document.querySelectorAll('figure[data-drawn]').length);
  if (drawn < 5) faults.push(`only ${drawn} plots are drawn`);
  // Marks are touched, links followed, and every source is looked at.
  for (const mark of await page.$$('#fit svg .role-mark path, #fit svg a')) {
    await mark.hover({force: true, timeout: 2000}).catch(() => {});
    await mark.click({force: true, timeout: 2000}).catch(() => {});
  }
  const popups = [];
  context.on('page', (popup) => popups.push(popup));
  const actions = await page.$$('.vega-actions a:text("View Source")');
  for (const action of actions) await action.evaluate((link) => link.click());
  if (actions.length === 0) faults.push('no source can be viewed');
  await page.waitForTimeout(500);
  for (const each of [page, ...popups]) {
    const owned = await each.evaluate(() => window.owned).catch(() => undefined);
    if (owned !== undefined) faults.push(`script ${owned} ran in ${each.url()}`);
    const markup = await each.evaluate(() => document.querySelectorAll('img[src="x"], iframe').length).catch(() => 0);
    if (each === page && markup > 0) faults.push(`${markup} elements came out of texts`);
  }
  for (const url of asked) {
    if (url !== address && !url.startsWith('data:') && !url.startsWith('blob:') && url !== 'about:blank')
      faults.push(`request: ${url}`);
  }
  // Were a text to become markup, the page's policy would still not let it run.
  await page.evaluate(() => {
    document.body.insertAdjacentHTML('beforeend', '<img src="x" onerror="window.owned = \'handler\'">');
    const script = document.createElement('script');
    script.textContent = 'window.owned = "inline script"';
    document.body.append(script);
    const link = document.createElement('a');
    link.href = 'javascript:window.owned = "link"';
    document.body.append(link);
    link.click();
  });
  await page.waitForTimeout(500);
  const owned = await page.evaluate(() => window.owned);
  if (owned !== undefined) faults.push(`the policy lets run: ${owned}`);
} finally {
  await browser.close();
}
for (const fault of faults) console.log(fault);
console.log(faults.length ? 'FAILED' : 'passed');
process.exit(faults.length ? 1 : 0);
