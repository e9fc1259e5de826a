// `wearwell open` itself in headless Chromium: from a messy table of lives with suspensions to a B10 with its bound, in at most
// ten actions, and `wearwell fit` of the study file that it leaves gives the same digits. At both widths, light and dark, each step
// is clean for axe-core, as wide as the screen, logs no error and fetches nothing from elsewhere; it is worked by keyboard, names
// in a hostile table stay names, and German is German.
//
//   node workbench.mjs NODE_MODULES SCREENSHOTS WEARWELL FOLDER [WALK...]    (default: all)
import {spawn, spawnSync} from 'node:child_process';
import {mkdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';
import {createInterface} from 'node:readline';
import {workbook} from './workbook.mjs';

const [modules, screenshots, wearwell, folder, ...wanted] = process.argv.slice(2);
const require = createRequire(join(resolve(modules), 'any.js'));
const {chromium} = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

const faults = [];
const check = (holds, fault) => { if (!holds) faults.push(fault); };

// A German file with lines above its headings, points for thousands, and a status in words.
const hours = [212.5, 305, 371, 418.5, 466, 509, 540, 588, 633, 702, 749, 1800, 1800, 1800, 1800];
const german = (x) => x.toLocaleString('de-DE', {minimumFractionDigits: 1});
const messy = ['Pumpenprüfstand Halle 3', 'Prüfer: Jürgen Müller', '', 'Nr.;Laufzeit [h];Status;Bemerkung',
               ...hours.map((each, i) => `P${i + 1};${german(each)};${i < 11 ? 'Ausfall' : 'läuft'};${i === 3 ? '"Lager; laut"' : ''}`), ''].join('\r\n');

// The same as a workbook, whose table is on the second sheet.
const messyBook = workbook([['Deckblatt', [['Halle 3'], ['', 'geprüft']]], ['Läufe', [['Pumpenprüfstand Halle 3'], ['Prüfer: Jürgen Müller'], [], ['Nr.', 'Laufzeit [h]', 'Status', 'Bemerkung'],
  ...hours.map((each, i) => [`P${i + 1}`, each, i < 11 ? 'Ausfall' : 'läuft', i === 3 ? 'Lager; laut' : ''])]]]);

async function serve(inside) {
  const child = spawn(wearwell, ['open', inside, '--no-browser'], {stdio: ['ignore', 'pipe', 'inherit']});
  const line = await new Promise((done, failed) => {
    createInterface(child.stdout).once('line', done);
    child.once('exit', () => failed(new Error('the program ended')));
  });
  const end = (signal) => () => new Promise((done) => { child.once('exit', done); child.kill(signal); });
  return {address: line.slice(line.indexOf('http')), stop: end('SIGINT'), kill: end('SIGKILL')};
}

function fresh(name) {
  const inside = join(folder, name);
  rmSync(inside, {recursive: true, force: true});
  mkdirSync(inside, {recursive: true});
  return inside;
}

async function open(context, address, complaints) {
  const page = await context.newPage();
  const base = address.slice(0, address.indexOf('#'));
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) complaints.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => complaints.push(`script: ${error.message}`));
  page.on('request', (request) => {
    if (!request.url().startsWith(base) && !/^(data|blob|about):/.test(request.url())) complaints.push(`request: ${request.url()}`);
  });
  await page.goto(address, {timeout: 60000});
  await page.waitForSelector('#connection[data-state="live"]', {timeout: 60000});
  return page;
}

async function looks(page, what, complaints) {
  // Loading axe takes as long as its run, and what passes needs no selectors.
  if (!await page.evaluate(() => Boolean(globalThis.axe))) await page.evaluate(axe);
  const {violations} = await page.evaluate(() => axe.run({exclude: ['iframe']}, {runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'],
    resultTypes: ['violations'], preload: false, iframes: false}));
  for (const {id, help, nodes} of violations)
    complaints.push(`${what}: ${id}: ${help}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 160)).join(' | ')}`);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  if (wide) complaints.push(`${what}: the page is wider than the screen`);
}

async function walk(browser, {name, book, ...options}) {
  const complaints = [];
  const inside = fresh(name);
  const {address, stop} = await serve(inside);
  const context = await browser.newContext(options);
  const page = await open(context, address, complaints);
  const shot = (step) => page.screenshot({path: join(screenshots, `workbench-${name}-${step}.png`), fullPage: true});
  let actions = 0;
  const act = async (does) => { actions += 1; await does(); };

  await act(() => page.setInputFiles('#choose', book ? {name: 'pumps.xlsx', mimeType: 'application/octet-stream', buffer: messyBook}
    : {name: 'pumps.csv', mimeType: 'text/csv', buffer: Buffer.from(messy, 'latin1')}));
  if (book) await act(() => page.click('button:text-is("Läufe")', {timeout: 60000}));
  await page.waitForSelector('#panel-data tbody tr', {timeout: 60000});
  await page.waitForSelector('#panel-data svg.plot');
  await looks(page, `${name} data`, complaints);
  await shot('data');
  await act(() => page.click('#step-model'));
  await page.waitForSelector('.check[data-state]', {timeout: 60000});
  await looks(page, `${name} model`, complaints);
  await shot('model');
  check(await page.getAttribute('.check', 'data-state') === 'good', `${name}: the guessed study cannot be fitted: ${await page.textContent('.check')}`);
  await act(() => page.fill('[id="key-predict.credible_level"]', '0.95'));
  await act(() => page.press('[id="key-predict.credible_level"]', 'Tab'));
  await page.waitForFunction(() => document.getElementById('study').value.includes('credible_level = 0.95'), null, {timeout: 60000});
  await act(() => page.click('#step-fit'));
  await act(() => page.click('#panel-fit button'));
  await page.waitForSelector('#trusted', {timeout: 240000});
  await looks(page, `${name} fit`, complaints);
  await shot('fit');
  await act(() => page.click('#step-ask'));
  await page.fill('#ask-level', '95 %');
  await act(() => page.click('#panel-ask form button'));
  await page.waitForSelector('.card .answer', {timeout: 60000});
  await looks(page, `${name} ask`, complaints);
  await shot('ask');
  check(actions <= 10, `${name}: ${actions} actions`);
  const command = await page.textContent('.card .command');
  const answer = await page.textContent('.card .answer');

  // The same by the program, from what the page left.
  const fit = spawnSync(wearwell, ['fit', 'pumps.toml', '-o', 'by-program', '--quiet'], {cwd: inside, encoding: 'utf8'});
  check(fit.status <= 1, `${name}: wearwell fit: ${fit.stderr}`);
  const summary = (result) => readFileSync(join(inside, result, 'summary.json'), 'utf8');
  check(summary('pumps-results') === summary('by-program'), `${name}: the program gives other digits`);
  const b10 = JSON.parse(summary('by-program')).quantities.find((each) => each.name.startsWith('B10'));
  check(b10 && b10.bound > 0 && b10.credible_level === 0.95, `${name}: no B10 with its bound`);
  const shown = await page.evaluate(() => [...document.querySelectorAll('#result tr')].map((each) => each.textContent).find((each) => each.startsWith('B10')));
  check(Boolean(shown), `${name}: the page shows no B10`);
  const asked = spawnSync('sh', ['-c', command.replace(/^wearwell/, '"$0"'), wearwell], {cwd: inside, encoding: 'utf8'});
  check(asked.stdout === answer, `${name}: ${command} prints ${asked.stdout}${asked.stderr}, the page ${answer}`);

  // When to replace, and two results side by side.
  await page.fill('#decide-failure_cost', '800 EUR');
  await page.fill('#decide-replacement_cost', '120 EUR');
  await page.click('#decide-form button');
  await page.waitForFunction(() => document.querySelectorAll('.card .command').length === 2, null, {timeout: 60000});
  await looks(page, `${name} decide`, complaints);
  await shot('decide');
  const decide = await page.textContent('.card .command'), decided = await page.textContent('.card .answer');
  const by = spawnSync('sh', ['-c', decide.replace(/^wearwell/, '"$0"'), wearwell], {cwd: inside, encoding: 'utf8'});
  check(by.stdout === decided, `${name}: ${decide} prints ${by.stdout}${by.stderr}, the page ${decided}`);
  await page.click('#step-compare');
  await page.waitForSelector('#panel-compare input', {timeout: 60000});
  for (const each of await page.$$('#panel-compare input')) await each.check();
  await page.click('#panel-compare form button');
  await page.waitForSelector('#table-ranking', {timeout: 60000});
  check((await page.$$('#table-ranking tbody tr')).length === 2, `${name}: two results are not compared`);
  await looks(page, `${name} compare`, complaints);
  await page.click('#comparison summary:has-text("overlaid")');
  await page.frameLocator('#comparison iframe').locator('section').first().waitFor({timeout: 60000});
  await shot('compare');

  await page.click('#step-data');
  await page.selectOption('#plot-by', {label: 'Status'});
  await page.waitForSelector('.legend .runouts', {timeout: 60000});
  await looks(page, `${name} colours`, complaints);
  await shot('colours');

  await page.click('#step-fit');
  await page.click('#panel-fit summary:has-text("Report")');
  await page.frameLocator('#result iframe').locator('section').first().waitFor({timeout: 60000});
  // A page that is opened again stands as it was left.
  await page.reload();
  await page.waitForSelector('#panel-data tbody tr', {timeout: 60000});
  check((await page.inputValue('#study')).includes('credible_level = 0.95'), `${name}: the study is lost after a reload`);
  await context.close();
  await stop();
  faults.push(...complaints.map((each) => `${name}: ${each}`));
}

// An error in the study under its line; the keyboard alone; a table whose names are markup.
async function errors(browser) {
  const complaints = [];
  const inside = fresh('errors');
  writeFileSync(join(inside, 'hostile.csv'), 'hours [h],status,"<img src=x onerror=alert(1)>"\n' + hours.map((each, i) => `${each},${i < 11 ? 'failure' : 'running'},=cmd|'/c calc'!A1\n`).join(''));
  const wide = (cell) => Array.from({length: 2000}, (_, i) => cell(i)).join();
  writeFileSync(join(inside, 'wide.csv'), [wide((i) => (i % 2 ? `<img src=x onerror=alert(${i})>` : `=cmd|'/c calc'!A${i}`)),
    ...[1, 2, 3, 4].map((row) => wide((i) => (i % 10 === 5 ? `2024-0${row}-1${i % 7}` : i % 10 === 7 ? `</li><script>alert(${row % 3})</script>` : `${row}.${i}`))), ''].join('\n'));
  const {address, stop} = await serve(join(inside, 'hostile.csv'));
  const context = await browser.newContext({viewport: {width: 1280, height: 900}});
  const page = await open(context, address, complaints);
  page.on('dialog', (dialog) => { complaints.push('a script of a table ran'); dialog.dismiss(); });
  await page.waitForSelector('#panel-data tbody tr');
  check(!(await page.$('main img')), 'a name became markup');
  await page.focus('#step-data');
  await page.keyboard.press('ArrowRight');
  check(await page.isVisible('#study') && !(await page.isVisible('#in-folder')), 'the arrow keys do not change the step');
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  const good = await page.inputValue('#study');
  await page.fill('#study', good.replace('family = "weibull"', 'family = "weibul"'));
  await page.waitForSelector('.check[data-state="bad"]', {timeout: 60000});
  check((await page.textContent('.check')).includes('weibul'), 'the message does not name the value');
  const line = good.split('\n').findIndex((each) => each.startsWith('family')) + 1;
  check(await page.textContent('.gutter .bad') === String(line), 'the line of the error is not marked');
  await page.fill('#study', good);
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});

  // Many columns, all of whose names are markup or formulas: roles, dates, colours and the next columns.
  await page.click('#step-data');
  await page.selectOption('#in-folder', 'wide.csv');
  await page.click('#panel-data .doors button');
  await page.waitForSelector('#type-5', {timeout: 60000});
  await page.selectOption('#type-5', 'dates');
  check((await page.textContent('#dates legend')).includes('<img src=x onerror=alert(5)>'), `errors: the dates are of ${await page.textContent('#dates legend')}`);
  check(await page.locator('#date-since option').count() < 1300, 'errors: the choice of a beginning has all columns');
  await page.selectOption('#plot-by', {index: 8});
  await page.waitForSelector('#panel-data .legend', {timeout: 60000});
  check((await page.textContent('#panel-data .legend')).includes('</li><script>alert(2)</script>'), `errors: the legend is ${await page.textContent('#panel-data .legend')}`);
  await looks(page, 'errors wide', complaints);
  await page.click('button:has-text("Later columns")');
  await page.waitForSelector('#role-25', {timeout: 60000});
  check(await page.locator('main :is(img, script, b)').count() === 0, 'errors: a name or cell of the wide table became markup');
  await context.close();
  await stop();
  faults.push(...complaints.filter((each) => !/status of 400/.test(each)).map((each) => `errors: ${each}`));
}

// Two tabs on one session, a file that another program changes, and a study that stays when another table is opened.
async function tabs(browser) {
  const complaints = [];
  const inside = fresh('tabs');
  writeFileSync(join(inside, 'pumps.csv'), messy, 'latin1');
  writeFileSync(join(inside, 'other.csv'), `hours [h],status\n${hours.slice(3).map((each, i) => `${each},${i < 8 ? 'failure' : 'running'}\n`).join('')}`);
  writeFileSync(join(inside, 'exact.csv'), 'a,b\n123456789012345,1e-7\n');
  const {address, stop} = await serve(join(inside, 'pumps.csv'));
  const context = await browser.newContext({viewport: {width: 1280, height: 900}});
  const first = await open(context, address, complaints), second = await open(context, address, complaints);
  const shows = (page, table) => page.waitForFunction((name) => document.querySelector('#panel-data caption')?.textContent.startsWith(name), table, {timeout: 60000});
  const opened = async (page, name) => {
    await page.click('#step-data');
    await page.selectOption('#in-folder', name);
    await page.click('#panel-data .doors button');
    if (name.endsWith('.csv')) await shows(page, name);
  };
  const good = (page) => page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  const value = (page, wanted) => page.waitForFunction((part) => document.getElementById('study').value.includes(part), wanted, {timeout: 60000});
  const save = (page) => page.click('.editing button:has-text("Save")');

  // What one tab opens the other shows, all of it.
  await opened(second, 'other.csv');
  await shows(first, 'other.csv');
  await first.waitForFunction(() => document.querySelectorAll('#panel-data tbody tr').length === 12, null, {timeout: 60000});
  await opened(first, 'exact.csv');
  const cells = await first.$$eval('#panel-data tbody td', (all) => all.map((each) => each.textContent));
  check(cells.join() === '123456789012345,1e-7', `tabs: cells lose digits: ${cells}`);
  await first.click('#banners button').catch(() => {});

  // A saved study stays when another table is opened, and the page says so.
  await opened(first, 'pumps.csv');
  await first.click('#step-model');
  await value(first, 'pumps.csv');
  await good(first);
  await save(first);
  await first.waitForFunction(() => document.querySelector('.editing').textContent.includes('Saved as pumps.toml'));
  const study = await first.inputValue('#study');
  await opened(first, 'other.csv');
  await first.waitForSelector('#notice .callout', {timeout: 60000});
  check(await first.inputValue('#study') === study, 'tabs: a table replaced a saved study');
  await looks(first, 'tabs notice', complaints);
  await first.screenshot({path: join(screenshots, 'workbench-notice.png')});
  await first.click('#step-model');
  check(!(await first.isVisible('.readings')), 'tabs: readings of another table are beside the study');
  await first.click('#notice button:has-text("Guess")');
  await value(first, 'other.csv');
  check(await first.inputValue('#study-file') === 'other.toml', 'tabs: the guess has the name of the other study');
  await first.click('button:has-text("Undo")');
  check(await first.inputValue('#study') === study && await first.inputValue('#study-file') === 'pumps.toml', 'tabs: undo does not bring the study back');

  // The same table with other settings.
  await first.waitForSelector('#notice button:has-text("Show the table")', {timeout: 60000});
  await first.click('#notice button:has-text("Show the table")');
  await shows(first, 'pumps.csv');
  await first.waitForFunction(() => !document.querySelector('#notice').children.length, null, {timeout: 60000});
  await first.click('#step-data');
  await first.click('#panel-data summary');
  await first.fill('#setting-decimal', ',');
  await first.click('#panel-data form button');
  await first.waitForSelector('#notice .callout:has-text("Decimal mark")', {timeout: 60000});
  await first.click('#notice button:has-text("Keep")');

  // A fit is of the text that is shown: another program changes the file.
  writeFileSync(join(inside, 'pumps.toml'), study.replace('credible_level = 0.9', 'credible_level = 0.5'));
  await first.click('#step-fit');
  await first.click('#panel-fit button');
  await first.waitForSelector('#banners .callout:has-text("has been changed")', {timeout: 60000});
  writeFileSync(join(inside, 'pumps.toml'), study);

  // A second run shows its own result.
  const b10 = () => first.evaluate(() => [...document.querySelectorAll('#result tr')].map((each) => each.textContent).find((each) => each.startsWith('B10')));
  await first.click('#panel-fit button');
  await first.waitForSelector('#trusted', {timeout: 240000});
  const before = await b10();
  // Another program changes the table: the one that is shown is old.
  writeFileSync(join(inside, 'pumps.csv'), `${messy}P16;800,5;läuft;\r\n`, 'latin1');
  await first.click('#step-model');
  await first.fill('[id="key-predict.credible_level"]', '0.99');
  await first.press('[id="key-predict.credible_level"]', 'Tab');
  await value(first, 'credible_level = 0.99');
  await first.waitForSelector('#notice .callout:has-text("pumps.csv has been changed or removed")', {timeout: 60000});
  await looks(first, 'tabs changed', complaints);
  await first.click('#notice button:has-text("Read again")');
  await first.waitForFunction(() => document.querySelector('#panel-data caption').textContent.includes('16 rows') && !document.querySelector('#notice').textContent.includes('changed or removed'), null, {timeout: 60000});
  await first.click('#step-fit');
  await first.click('#panel-fit button');
  await first.waitForFunction((old) => [...document.querySelectorAll('#result tr')].some((each) => each.textContent.startsWith('B10') && each.textContent !== old), before, {timeout: 240000});

  // An opened study does not take unsaved text away.
  await first.click('#step-model');
  await first.fill('#study', `${await first.inputValue('#study')}# mine\n`);
  await opened(first, 'pumps.toml');
  await first.waitForFunction(() => !document.getElementById('study').value.includes('# mine'), null, {timeout: 60000});
  await first.click('button:has-text("Undo")');
  await value(first, '# mine');
  await first.evaluate(() => { document.getElementById('study').value = ''; });
  await first.close();
  // The tab that listened for both is closed.
  writeFileSync(join(inside, 'late.csv'), 'a,b\n1,2\n');
  await second.reload();
  await opened(second, 'late.csv');
  await context.close();
  await stop();
  // Refusals that the above wants: the changed file (409), tables from whose headings no study follows (400).
  faults.push(...complaints.filter((each) => !/status of 40[09]/.test(each)).map((each) => `tabs: ${each}`));
}

// A large table is read while the page goes on; the reading can be stopped. Wear gets its failure threshold without TOML.
async function large(browser) {
  const complaints = [];
  const inside = fresh('large');
  writeFileSync(join(inside, 'lives.csv'), `unit,hours [h],status\n${Array.from({length: 400000}, (_, i) => `U${i},${100 + i % 997}.5,failure\n`).join('')}`);
  writeFileSync(join(inside, 'wear.csv'), `part,hours [h],wear [um]\n${['A', 'B', 'C', 'D'].flatMap((each, i) => [100, 200, 400, 700].map((at) => `${each},${at},${(0.05 + 0.01 * i) * at + (at % 3) / 10}\n`)).join('')}`);
  const {address, stop} = await serve(join(inside, 'wear.csv'));
  const context = await browser.newContext({viewport: {width: 1280, height: 900}});
  const page = await open(context, address, complaints);
  await page.waitForSelector('#panel-data tbody tr', {timeout: 60000});
  await page.click('#step-model');
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  await page.fill('#limit', '5 h');
  await page.press('#limit', 'Enter');
  await page.waitForSelector('#banners .callout:has-text("dimension")', {timeout: 60000});
  await page.fill('#limit', '0.12 mm');
  await page.press('#limit', 'Enter');
  await page.waitForFunction(() => document.getElementById('study').value.includes('0.12 mm'), null, {timeout: 60000});
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  // What is typed into a field stays when the form is made again.
  const made = page.waitForResponse((response) => response.url().endsWith('/api/form'), {timeout: 60000});
  await page.fill('#study', `${await page.inputValue('#study')}\n`);
  await page.focus('#key-title');
  await page.keyboard.press('End');
  await page.keyboard.type(' of liners');
  await made;
  await page.waitForFunction(() => !document.body.hasAttribute('aria-busy'), null, {timeout: 60000});
  check((await page.inputValue('#key-title')).endsWith(' of liners'), `large: a form that is made again has ${await page.inputValue('#key-title')}`);
  await page.keyboard.press('Tab');
  await page.waitForFunction(() => /^title = .* of liners"/m.test(document.getElementById('study').value), null, {timeout: 60000});

  await page.click('#step-data');
  await page.selectOption('#in-folder', 'lives.csv');
  await page.click('#panel-data .doors button');
  await page.waitForSelector('#reading pre', {timeout: 60000});
  check((await page.textContent('#reading pre')).startsWith('unit,hours [h],status\nU0,100.5,failure'), 'large: the first lines are not shown');
  check((await page.textContent('#panel-data caption')).startsWith('wear.csv'), 'large: the table before has gone');
  await page.click('#reading button');
  await page.waitForSelector('#reading', {state: 'hidden', timeout: 60000});
  // On a busy machine the reading may end before the click.
  const isRead = (await page.textContent('#panel-data caption')).startsWith('lives.csv');
  check(isRead || (await page.textContent('#panel-data')).includes('not read to its end'), 'large: the page does not say that the reading was stopped');
  await page.click('#panel-data .doors button');
  await page.waitForFunction(() => document.querySelector('#panel-data caption').textContent.startsWith('lives.csv'), null, {timeout: 60000});
  check(!(await page.textContent('#panel-data')).includes('Another page'), 'large: the page takes its own table for that of another');
  // Of many points in one place one is drawn, and the number is stated.
  await page.waitForFunction(() => document.querySelectorAll('#panel-data .plot path.many').length > 1, null, {timeout: 60000});
  const drawn = (await page.textContent('#panel-data .picture .note')).replace(/(\d)\D(?=\d)/g, '$1').match(/^(\d+) of (\d+) points/);
  const squares = await page.$$eval('#panel-data .plot path.many', (all) => all.reduce((sum, each) => sum + each.getAttribute('d').split('M').length - 1, 0));
  check(drawn && Number(drawn[1]) === squares && Number(drawn[2]) === 400000, `large: ${squares} points are drawn, the note says ${await page.textContent('#panel-data .picture .note')}`);
  await page.evaluate(() => { document.getElementById('study').value = ''; });
  await context.close();
  await stop();
  faults.push(...complaints.filter((each) => !/status of 400/.test(each)).map((each) => `large: ${each}`));
}

// From an S-N table in a workbook, with a mean below that is refused until it is stated, to its design values, in at most ten actions.
async function curve(browser, {name, ...options}) {
  const complaints = [], inside = fresh(name), {address, stop} = await serve(inside), context = await browser.newContext(options);
  const page = await open(context, address, complaints);
  let actions = 0;
  const act = async (does) => { actions += 1; await does(); };
  await act(() => page.setInputFiles('#choose', {name: 'tests.xlsx', mimeType: 'application/octet-stream', buffer: readFileSync(new URL('../../examples/messy/woehler.xlsx', import.meta.url))}));
  await act(() => page.click('button:text-is("Versuche")', {timeout: 60000}));
  await page.waitForSelector('#refused-summary_rows', {timeout: 60000});
  check((await page.textContent('#banners')).includes('Mittelwert'), `${name}: the row of a mean is not refused: ${await page.textContent('#banners')}`);
  await looks(page, `${name} refused`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-refused.png`), fullPage: true});
  await act(() => page.fill('#refused-summary_rows', 'last'));
  await act(() => page.press('#refused-summary_rows', 'Enter'));
  await page.waitForSelector('#panel-data tbody tr', {timeout: 60000});
  check(!(await page.textContent('#banners')) && !(await page.textContent('#refused')), `${name}: what was refused stays on the page`);
  await act(() => page.click('#step-model'));
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  await act(() => page.click('#step-fit'));
  await act(() => page.click('#panel-fit button'));
  await page.waitForSelector('#trusted', {timeout: 240000});
  const shown = await page.$$eval('#table-bounds tbody tr', (all) => all.map((each) => each.textContent));
  check(actions <= 10 && shown.some((each) => each.startsWith('B10')), `${name}: ${actions} actions, design values ${shown}`);
  await looks(page, `${name} fit`, complaints);
  const fit = spawnSync(wearwell, ['fit', 'tests.toml', '-o', 'by-program', '--quiet'], {cwd: inside, encoding: 'utf8'});
  check(fit.status <= 1, `${name}: wearwell fit: ${fit.stderr}`);
  const summary = (result) => readFileSync(join(inside, result, 'summary.json'), 'utf8');
  check(summary('tests-results') === summary('by-program'), `${name}: the program gives other digits`);
  await context.close();
  await stop();
  faults.push(...complaints.filter((each) => !/status of 400/.test(each)).map((each) => `${name}: ${each}`));
}

// From wear paths to remaining useful lives, in at most ten actions, and `wearwell fit` and `wearwell life` give the same. The liners are
// digits that the study reads as names; the formula is typeset while it is typed, sliders follow the threshold, and a test to do next is ranked.
async function wearPaths(browser, {name, ...options}) {
  const complaints = [];
  const inside = fresh(name);
  writeFileSync(join(inside, 'liners.csv'), `liner,hours [h],wear [um]\n${[7, 8, 9, 10, 11].flatMap((each, i) => [150, 300, 500, 800, 1000].map((at, j) => `${each},${at},${((0.05 + 0.008 * i) * at + [0.8, -1.1, 0.3, 1.2, -0.7][(i + j) % 5]).toFixed(1)}\n`)).join('')}`);
  const {address, stop} = await serve(inside);
  const context = await browser.newContext(options);
  const page = await open(context, address, complaints);
  const good = () => page.waitForSelector('.check[data-state="good"]', {state: 'attached', timeout: 60000});
  let actions = 0;
  const act = async (does) => { actions += 1; await does(); };
  await act(() => page.selectOption('#in-folder', 'liners.csv'));
  await act(() => page.click('#panel-data .doors button'));
  await page.waitForSelector('#panel-data tbody tr', {timeout: 60000});
  await good();
  await page.waitForFunction(() => document.querySelector('#role-0')?.value === 'liner', null, {timeout: 60000});
  check((await page.textContent('[data-column="0"]')).includes(await page.evaluate(() => wearwell.strings.readAsNames)), `${name}: digits of liners are not read as names`);
  await act(() => page.click('#step-model'));
  await act(() => page.fill('#limit', '95 um'));
  await act(() => page.press('#limit', 'Enter'));
  await page.waitForFunction(() => document.getElementById('study').value.includes('95 um'), null, {timeout: 60000});
  await good();
  await act(() => page.click('#step-fit'));
  await act(() => page.click('#panel-fit button'));
  await page.waitForSelector('#trusted', {timeout: 240000});
  await act(() => page.click('#step-ask'));
  await act(() => page.click('#ask-units button'));
  await page.waitForSelector('.card .command', {timeout: 240000});
  check(actions <= 10, `${name}: ${actions} actions`);
  const rows = await page.$$eval('#table-units tbody tr', (all) => all.map((each) => [...each.children].map((cell) => cell.textContent)));
  check(rows.length === 5 && rows[0][0] === '11', `${name}: remaining useful lives are ${JSON.stringify(rows)}`);
  await looks(page, `${name} units`, complaints);
  const program = (command) => spawnSync('sh', ['-c', `wearwell() { "$0" "$@"; }; ${command}`, wearwell], {cwd: inside, encoding: 'utf8'}).stdout;
  const printed = program(await page.textContent('.card .command'));
  check((printed.match(/^Remaining useful life of liner/gm) ?? []).length === 5, `${name}: the command of all units prints ${printed}`);
  spawnSync(wearwell, ['fit', 'liners.toml', '-o', 'by-program', '--quiet'], {cwd: inside});
  const summary = (result) => readFileSync(join(inside, result, 'summary.json'), 'utf8');
  check(summary('liners-results') === summary('by-program'), `${name}: the program gives other digits`);

  await page.fill('#next-goal', 'B10');
  await page.fill('#next-grid', 'hours [h] = 500 to 1500 by 500');
  await page.click('#next-form button');
  await page.waitForFunction(() => document.querySelectorAll('.card').length === 2, null, {timeout: 240000});
  const next = await page.textContent('.card .answer');
  check(next === program(await page.textContent('.card .command')), `${name}: plan next prints something else than ${next}`);
  await looks(page, `${name} next`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-ask.png`), fullPage: true});

  // A threshold by its slider; what it gives is what a fit of the study gives into which it is written.
  await page.click('#step-fit');
  await page.click('#live summary');
  await page.waitForFunction(() => document.querySelector('#live .command') && !document.querySelector('#live').hasAttribute('aria-busy'), null, {timeout: 120000});
  const answered = () => page.waitForFunction(() => !document.querySelector('#live').hasAttribute('aria-busy'), null, {timeout: 120000}).then(() => page.textContent('#live .answer'));
  const first = await answered();
  await page.focus('#live-varied-0');
  for (let i = 0; i < 10; ++i) await page.keyboard.press('ArrowRight');
  await page.waitForSelector('#live .choices button >> nth=0', {state: 'visible', timeout: 60000});
  const wider = await answered(), limit = await page.textContent('output[for="live-varied-0"]');
  check(wider !== first && wider.includes(limit), `${name}: with ${limit} the answer is ${wider}`);
  await looks(page, `${name} live`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-live.png`), fullPage: true});
  await page.click('#live .choices button >> nth=0');
  await page.waitForFunction((text) => document.getElementById('study').value.includes(text), limit, {timeout: 60000});
  await good();
  await page.click('#step-fit');
  await page.click('#panel-fit button');
  await page.waitForFunction((old) => document.querySelector('#live .answer') && document.querySelector('#live .answer').textContent !== old, wider, {timeout: 240000});
  const level = await page.textContent('output[for="live-level"]').catch(() => '95 %');
  check(program(`wearwell life liners-results --level='${level}'`) === wider, `${name}: the fit of the written study gives another life than the slider: ${wider}`);

  // Typeset while typing: an error keeps the formula that stood there.
  await page.click('#step-model');
  await page.waitForSelector('#formulas math mfrac, #formulas math mi', {timeout: 60000});
  const source = await page.inputValue('#study');
  await page.fill('#study', source.replace('wear = "rate * time"', 'wear = "rate * (time + 1 [h]) / 1"'));
  await page.waitForSelector('#formulas [data-path="formula.wear"] mfrac', {timeout: 60000});
  await page.fill('#study', source.replace('wear = "rate * time"', 'wear = "rate * (time"'));
  await page.waitForSelector('#formulas [data-path="formula.wear"].stale mfrac', {timeout: 60000});
  await page.waitForSelector('.check[data-state="bad"]', {timeout: 60000});
  await looks(page, `${name} formulas`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-formulas.png`), fullPage: true});
  await page.fill('#study', source);
  await good();

  await page.evaluate(() => { document.getElementById('study').value = ''; });
  await context.close();
  await stop();
  faults.push(...complaints.map((each) => `${name}: ${each}`));
}

// Nothing is taken where a table leaves a question open, or has readings that fit equally well (as if there were two).
async function readings(browser) {
  const complaints = [];
  const inside = fresh('readings');
  writeFileSync(join(inside, 'wear.csv'), `hours [h],volume [mm^3],distance [m]\n${hours.map((each, i) => `${each},${0.3 * i + 0.1},${12 * i + 3}\n`).join('')}`);
  const {address, stop} = await serve(join(inside, 'wear.csv'));
  const context = await browser.newContext({viewport: {width: 390, height: 844}, colorScheme: 'dark'});
  const page = await open(context, address, complaints);
  const refused = async (part) => {
    await page.click('.editing button:has-text("Save")');
    await page.waitForSelector(`#banners .callout:has-text("${part}")`, {timeout: 60000});
    await page.click('#banners button');
  };
  await page.click('#step-model');
  await page.waitForSelector('.question button', {timeout: 60000});
  await refused('Answer this question');
  await page.click('#step-fit');
  await page.click('#panel-fit button');
  await page.waitForSelector('#banners .callout:has-text("Answer this question")', {timeout: 60000});
  await page.click('#step-model');
  await page.click('.question button >> nth=0');
  await page.waitForSelector('.question', {state: 'detached', timeout: 60000});
  check(await page.evaluate(() => document.activeElement.closest('#panel-model') !== null), 'readings: after an answer the focus is at the top of the page');
  await page.click('.editing button:has-text("Save")');
  await page.waitForFunction(() => document.querySelector('.editing').textContent.includes('Saved as wear.toml'), null, {timeout: 60000});

  writeFileSync(join(inside, 'two.csv'), `hours [h],status\n${hours.map((each, i) => `${each},${i < 11 ? 'failure' : 'running'}\n`).join('')}`);
  await page.route('**/api/guess', async (route) => {
    const response = await route.fetch(), {readings: [first]} = await response.json();
    await route.fulfill({response, json: {readings: [{...first, equal: true}, {...first, preset: 'second', equal: true}]}});
  });
  await page.reload();
  await page.waitForSelector('#connection[data-state="live"]', {timeout: 60000});
  await page.waitForSelector('#in-folder option[value="two.csv"]', {state: 'attached', timeout: 60000});
  await page.click('#step-data');
  await page.selectOption('#in-folder', 'two.csv');
  await page.click('#panel-data .doors button');
  await page.click('#notice button:has-text("Guess")', {timeout: 60000});
  await page.click('#step-model');
  await page.waitForSelector('.readings input', {timeout: 60000});
  await page.waitForFunction(() => document.getElementById('study').value === '', null, {timeout: 60000});
  await refused('Choose one');
  await looks(page, 'readings', complaints);
  await page.screenshot({path: join(screenshots, 'workbench-readings.png'), fullPage: true});
  await page.click('.readings input >> nth=1');
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  check((await page.inputValue('#study')).includes('two.csv'), 'readings: the chosen reading has no study');
  await context.close();
  await stop();
  faults.push(...complaints.map((each) => `readings: ${each}`));
}

// A plain table of numbers becomes a formula study by clicks, in at most ten actions, and `wearwell fit` of it gives the same. The program is then
// killed while it fits: the page says so and keeps what was typed, the folder what was saved.
async function responses(browser, {name, ...options}) {
  const complaints = [];
  const inside = fresh(name);
  writeFileSync(join(inside, 'rates.csv'), `specimen,load,"<b>film</b>",loss\n${[10, 20, 40].flatMap((load, i) => [1, 2, 4, 8].map((film, j) => `${'abc'[i]}${j},${load},${film},${(0.3 * load ** 1.1 / film ** 0.5 * (1 + 0.05 * ((i + 2 * j) % 3))).toFixed(3)}\n`)).join('')}`);
  const {address, kill} = await serve(inside);
  const context = await browser.newContext(options);
  const page = await open(context, address, complaints);
  const study = () => page.inputValue('#study');
  let actions = 0;
  const act = async (does) => { actions += 1; await does(); };
  await act(() => page.selectOption('#in-folder', 'rates.csv'));
  await act(() => page.click('#panel-data .doors button'));
  await page.waitForSelector('#panel-data tbody tr', {timeout: 60000});
  await act(() => page.click('#step-model'));
  await page.waitForSelector('.question button', {timeout: 60000});
  await looks(page, `${name} question`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-question.png`), fullPage: true});
  await act(() => page.click('.question button:has-text("loss")'));
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  await looks(page, `${name} model`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-model.png`), fullPage: true});
  check(/^response = "level \* \(load\/load_reference\)\^load_exponent \* \(/m.test(await study()), `${name}: the formula is ${await study()}`);
  await act(() => page.click('#step-fit'));
  await act(() => page.click('#panel-fit button'));
  await page.waitForSelector('#trusted', {timeout: 240000});
  check(actions <= 10, `${name}: ${actions} actions`);
  await looks(page, `${name} fit`, complaints);
  spawnSync(wearwell, ['fit', 'rates.toml', '-o', 'by-program', '--quiet'], {cwd: inside});
  const summary = (result) => readFileSync(join(inside, result, 'summary.json'), 'utf8');
  const first = summary('rates-results');
  check(first === summary('by-program'), `${name}: the program gives other digits`);

  await page.click('#step-model');
  await page.fill('#study', (await study()).replace('scale = 1 }', 'scale = 2 }'));
  const saved = await study();
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  await page.click('#step-fit');
  const before = complaints.length;
  await page.click('#panel-fit button');
  await page.waitForSelector('#panel-fit button:has-text("Stop")', {timeout: 60000});
  await kill();
  await page.waitForSelector('#connection[data-state="lost"]', {timeout: 60000});
  check((await page.textContent('#progress')).includes('has written nothing'), `${name}: of a lost fit the page says ${await page.textContent('#progress')}`);
  await page.click('#step-model');
  await page.fill('#study', `${saved}# mine\n`);
  await page.click('.editing button:has-text("Save")');
  await page.waitForSelector('#banners .callout:has-text("Start wearwell open again")', {timeout: 60000});
  check((await study()).endsWith('# mine\n') && !(await page.textContent('.editing')).includes('Saved as'), `${name}: a text that cannot be saved is lost, or said to be saved`);
  await looks(page, `${name} lost`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-lost.png`), fullPage: true});
  check(readFileSync(join(inside, 'rates.toml'), 'utf8') === saved && summary('rates-results') === first, `${name}: the kill changed what was saved`);
  complaints.splice(before, complaints.length, ...complaints.slice(before).filter((each) => !/ERR_CONNECTION_REFUSED|ERR_INCOMPLETE_CHUNKED|ERR_EMPTY_RESPONSE|ERR_CONNECTION_RESET/.test(each)));
  await page.evaluate(() => { document.getElementById('study').value = ''; });
  await context.close();
  faults.push(...complaints.filter((each) => !/status of 400/.test(each)).map((each) => `${name}: ${each}`));
}

// In German: by the browser's language and by choice; what was typed into the study stays, and no English sentence of the page is seen.
async function inGerman(browser, {name, ...options}) {
  const complaints = [];
  const inside = fresh(name);
  writeFileSync(join(inside, 'pumps.csv'), `hours [h],status\n${hours.map((each, i) => `${each},${i < 11 ? 'failure' : 'running'}\n`).join('')}`);
  const {address, stop} = await serve(join(inside, 'pumps.csv'));
  const context = await browser.newContext({...options, locale: 'de-AT'});
  const page = await open(context, address, complaints);
  const shot = (step) => page.screenshot({path: join(screenshots, `workbench-${name}-${step}.png`), fullPage: true});
  const language = () => page.evaluate(() => document.documentElement.lang);
  await page.waitForSelector('#panel-data tbody tr', {timeout: 60000});
  check(await language() === 'de', `${name}: a German browser gets ${await language()}`);
  check(await page.textContent('#step-fit') === '3 Anpassung', `${name}: the step Fit is ${await page.textContent('#step-fit')}`);
  await looks(page, `${name} data`, complaints);
  await shot('data');
  await page.click('#step-model');
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  await looks(page, `${name} model`, complaints);
  await shot('model');
  const told = await page.textContent('.reasons');
  check(told.includes("life: Spalte 'hours [h]' in h") && await page.locator(':is(.reasons, .readings) [lang="en"]').count() === 0, `${name}: guesses are ${told}`);
  await page.click('#step-fit');
  await page.click('#panel-fit button');
  await page.waitForSelector('#trusted', {timeout: 240000});
  check(await page.locator('[role="status"] #trusted').count() === 1, `${name}: a screen reader does not hear the verdict`);
  check((await page.textContent('#result .command')).startsWith('wearwell fit ') && (await page.textContent('#result .python')).includes('ww.fit('), `${name}: the fit has no lines`);
  await looks(page, `${name} fit`, complaints);
  await shot('fit');
  await page.click('#step-ask');
  await page.fill('#ask-survived', '400 h');
  await page.click('#panel-ask form button');
  await page.waitForSelector('.card .python', {timeout: 60000});
  await looks(page, `${name} ask`, complaints);
  await shot('ask');
  // Program texts are marked as English; elsewhere none of its sentences is left.
  const left = await page.evaluate(() => {
    const sentences = [];
    const collect = (table) => { for (const each of Object.values(table)) { if (typeof each === 'object') collect(each); else if (typeof each === 'string') sentences.push(each); } };
    collect(wearwell.languages.en);
    const german = [];
    const collectGerman = (table) => { for (const each of Object.values(table)) { if (typeof each === 'object') collectGerman(each); else if (typeof each === 'string') german.push(each); } };
    collectGerman(wearwell.languages.de);
    const english = new Set(sentences.filter((each) => !german.includes(each) && /[a-z]{3}/.test(each)));
    const found = [], walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const {parentElement: parent, data} = walker.currentNode;
      if (english.has(data.trim()) && !parent.closest('[lang="en"], script, style, .form, td, tbody th')) found.push(data.trim());
    }
    for (const each of document.querySelectorAll('[aria-label], [placeholder]'))
      for (const label of [each.getAttribute('aria-label'), each.getAttribute('placeholder')]) if (english.has(label)) found.push(label);
    return found;
  });
  check(left.length === 0, `${name}: in English: ${left.join('; ')}`);

  await page.click('#step-model');
  await page.fill('#study', `${await page.inputValue('#study')}# mine\n`);
  await page.selectOption('#language', 'en');
  await page.waitForFunction(() => document.documentElement.lang === 'en' && document.querySelector('#study')?.value.includes('# mine'), null, {timeout: 60000});
  check((await page.textContent('.editing')).includes('not saved') && await page.inputValue('#study-file') === 'pumps.toml', `${name}: the text that is kept is not the one that was edited`);
  await page.waitForSelector('#panel-data tbody tr', {state: 'attached', timeout: 60000});
  check((await page.inputValue('#study')).includes('# mine'), `${name}: the table that is open replaced the edited text`);
  await page.evaluate(() => { document.getElementById('study').value = ''; });
  await page.reload();
  await page.waitForSelector('#panel-data tbody tr', {state: 'attached', timeout: 60000});
  check(await language() === 'en', `${name}: the choice is not kept`);
  check(!(await page.inputValue('#study')).includes('# mine'), `${name}: a text that was given up comes back`);
  await context.close();
  await stop();
  faults.push(...complaints.map((each) => `${name}: ${each}`));
}

// Priors by their handles: with the mouse and with the keyboard. Fields and text follow, the lives at the end; undo takes a whole drag back.
async function priors(browser, {name, ...options}) {
  const complaints = [];
  const inside = fresh(name);
  writeFileSync(join(inside, 'pumps.csv'), `hours [h],status\n${hours.map((each, i) => `${each},${i < 11 ? 'failure' : 'running'}\n`).join('')}`);
  const {address, stop} = await serve(join(inside, 'pumps.csv'));
  const context = await browser.newContext(options);
  const page = await open(context, address, complaints);
  const asked = {moves: 0, lives: 0};
  page.on('request', (request) => { asked.moves += request.url().endsWith('/api/prior'); asked.lives += request.url().endsWith('/api/priors'); });
  await page.click('#step-model');
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  await page.fill('#study', (await page.inputValue('#study')).replace(/^characteristic .*$/m, 'characteristic = { distribution = "lognormal", median = "1000 h", log_sd = 0.5 }'));
  await page.waitForFunction(() => document.getElementById('key-prior.characteristic.median')?.value === '1000 h', null, {timeout: 60000});
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  await page.click('#priors summary');
  await page.waitForSelector('#prior-characteristic-location', {timeout: 60000});
  const lives = () => page.textContent('#table-implied tbody');
  const median = () => page.inputValue('[id="key-prior.characteristic.median"]');
  const written = () => page.evaluate(() => /^characteristic .*median = "([^"]*)".*log_sd = ([0-9.]*)/m.exec(document.getElementById('study').value).slice(1));
  const before = await lives(), study = await page.inputValue('#study'), asks = {...asked};

  const grip = page.locator('#prior-characteristic-location .grip');
  await grip.scrollIntoViewIfNeeded();
  const {x, y, width, height} = await grip.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  for (let i = 1; i <= 30; ++i) await page.mouse.move(x + width / 2 + i, y + height / 2);
  await page.waitForFunction(() => document.getElementById('key-prior.characteristic.median').value !== '1000 h', null, {timeout: 60000});
  await page.mouse.up();
  await page.waitForFunction((old) => document.querySelector('#table-implied tbody').textContent !== old, before, {timeout: 60000});
  const moved = await median();
  check(/^\d+ h$/.test(moved) && parseFloat(moved) > 1050, `${name}: 30 pixels to the right make the median ${moved}`);
  check((await written()).join() === `${moved},0.5`, `${name}: the field has ${moved}, the text ${await written()}`);
  check(asked.moves > asks.moves && asked.lives === asks.lives + 1, `${name}: ${asked.moves - asks.moves} moves, lives are computed ${asked.lives - asks.lives} times`);

  await page.focus('#prior-characteristic-spread');
  const [, spread] = await written();
  const livesFollow = page.waitForResponse((response) => response.url().endsWith('/api/priors'), {timeout: 60000});
  for (let i = 0; i < 3; ++i) await page.keyboard.press('ArrowRight');
  await page.waitForFunction((old) => !document.getElementById('study').value.includes(`log_sd = ${old} }`), spread, {timeout: 60000});
  await page.waitForFunction(() => { const at = /log_sd = ([0-9.]*)/.exec(document.getElementById('study').value)[1]; return document.getElementById('key-prior.characteristic.log_sd').value === at; }, null, {timeout: 60000});
  await livesFollow;  // no move follows: check and lives come then
  await page.waitForFunction(() => !document.body.hasAttribute('aria-busy'), null, {timeout: 60000});
  check(await page.evaluate(() => document.activeElement.id) === 'prior-characteristic-spread', `${name}: the handle loses the focus`);
  check(/^[0-9].* h$/.test(await page.getAttribute('#prior-characteristic-spread', 'aria-valuetext')), `${name}: the handle has no value in words`);
  const [middle, wider] = await written();
  check(middle === moved && Number(wider) > 0.5 && Number(wider) < 0.8, `${name}: three keys make the spread ${wider} and the median ${middle}`);
  await looks(page, name, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}.png`), fullPage: true});
  // Keys that follow each other fast are one replacement; a slow machine makes several of them.
  for (let i = 0; i < 3 && (await written()).join() !== `${moved},0.5`; ++i) await page.click('.editing button.plain >> nth=-1');
  check((await written()).join() === `${moved},0.5`, `${name}: undo of the keys leaves ${await written()}`);
  await page.click('.editing button.plain >> nth=-1');
  check(await page.inputValue('#study') === study, `${name}: undo of the drag leaves ${await written()}`);

  // Families side by side; one is chosen, and undo goes back.
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  await page.click('#families summary');
  await page.waitForSelector('.family[data-family="lognormal"] .fitted', {timeout: 60000});
  // One whose likelihood has no maximum is last.
  const order = await page.$$eval('.family', (all) => all.map((each) => Number(each.textContent.match(/AIC[^0-9]*([0-9.]+)/)?.[1] ?? Infinity)));
  check(order.length === 9 && order.filter(Number.isFinite).length >= 7 && order.every((each, i) => !i || each >= order[i - 1]), `${name}: families are in the order ${order}`);
  check(await page.getAttribute('.family.own', 'data-family') === 'weibull', `${name}: the family of the study is not marked`);
  await looks(page, `${name} families`, complaints);
  await page.locator('#families').screenshot({path: join(screenshots, `workbench-${name}-families.png`)});
  await page.click('.family[data-family="lognormal"] button');
  await page.waitForFunction(() => /^family *= *"lognormal"/m.test(document.getElementById('study').value), null, {timeout: 60000});
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  check(await page.getAttribute('.family [aria-pressed="true"] >> nth=0', 'aria-pressed') === 'true' && await page.getAttribute('.family.own', 'data-family') === 'lognormal', `${name}: the chosen family is not marked`);
  await page.click('.editing button.plain >> nth=-1');
  check(await page.inputValue('#study') === study, `${name}: undo of the family leaves another study`);
  await page.evaluate(() => { document.getElementById('study').value = ''; });
  await context.close();
  await stop();
  faults.push(...complaints.map((each) => `${name}: ${each}`));
}

// The study and the table are corrected from the page: lines of headings and units by a click, a unit in its heading, and the advice of a check.
async function corrections(browser, {name, ...options}) {
  const complaints = [];
  const inside = fresh(name);
  writeFileSync(join(inside, 'wear.csv'), `part,hours,wear\n${['A', 'B', 'C', 'D'].flatMap((each, i) => [100, 200, 400, 700].map((at) => `${each},${at},${(0.05 + 0.01 * i) * at + (at % 3) / 10}\n`)).join('')}`);
  writeFileSync(join(inside, 'rig.csv'), `Rig 4\nrun by Smith\n\nspecimen,hours,status\n,h,\n${hours.map((each, i) => `S${i},${each},${i < 11 ? 'failure' : 'running'}\n`).join('')}`);
  writeFileSync(join(inside, 'words.csv'), `hours [h],state\n${hours.map((each, i) => `${each},${i < 11 ? 'failure' : i < 13 ? 'on the rig' : '<b>back</b>'}\n`).join('')}`);
  writeFileSync(join(inside, 'controllers.csv'), readFileSync(new URL('../../examples/life/controllers.csv', import.meta.url)));
  const {address, stop} = await serve(join(inside, 'wear.csv'));
  const context = await browser.newContext(options);
  const page = await open(context, address, complaints);
  const study = () => page.inputValue('#study');
  const good = () => page.waitForSelector('.check[data-state="good"]', {state: 'attached', timeout: 60000});
  const openTable = async (table) => {
    await page.click('#step-data');
    await page.selectOption('#in-folder', table);
    await page.click('#panel-data .doors button');
    await page.waitForFunction((file) => document.querySelector('#panel-data caption')?.textContent.startsWith(file), table, {timeout: 60000});
  };

  // The unit that the guess took stands in the heading, and is changed there.
  await page.waitForFunction(() => document.getElementById('unit-2')?.value === 'um', null, {timeout: 60000});
  await good();
  await page.fill('#unit-2', 'mm');
  await page.press('#unit-2', 'Enter');
  await page.waitForFunction(() => document.getElementById('study').value.includes('column = "wear", unit = "mm"'), null, {timeout: 60000});
  await page.waitForSelector('#panel-data .note:has-text("reads wear in this unit: mm")', {timeout: 60000});
  await good();
  await page.fill('#unit-2', 'kg');
  await page.press('#unit-2', 'Enter');
  await page.waitForSelector('#banners .callout:has-text("kg")', {timeout: 60000});
  check(await page.inputValue('#unit-2') === 'mm' && (await study()).includes('unit = "mm"'), `${name}: a unit that is refused stays`);
  await looks(page, `${name} unit`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-unit.png`), fullPage: true});
  await page.evaluate(() => { document.getElementById('study').value = ''; });
  const focus = () => page.evaluate(() => document.activeElement.id || document.activeElement.closest('[id]').id);
  await page.focus('#banners button');
  await page.keyboard.press('Enter');
  check(await focus() === 'unit-2', `${name}: after a message the focus is on ${await focus()}`);

  // Lines of the file become headings and units.
  await openTable('rig.csv');
  const head = () => page.$$eval('#panel-data thead th span', (all) => all.map((each) => each.textContent).join());
  const heads = (wanted) => page.waitForFunction((text) => [...document.querySelectorAll('#panel-data thead th span')].map((each) => each.textContent).join() === text, wanted, {timeout: 60000});
  check(await head() === 'specimen,hours,status', `${name}: headings are ${await head()}`);
  const rows = await page.textContent('#panel-data caption');
  await page.click('#line-6');
  await looks(page, `${name} line`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-line.png`), fullPage: true});
  await page.click('#heading-lines button:has-text("There is no line of units")');
  await page.waitForFunction((before) => document.querySelector('#panel-data caption').textContent !== before, rows, {timeout: 60000});
  check(await focus() === 'heading-lines', `${name}: after a choice the focus is on ${await focus()}`);
  check((await page.textContent('#panel-data caption')).includes('16 rows'), `${name}: without a line of units there are ${await page.textContent('#panel-data caption')}`);
  await page.click('#line-5');
  await page.click('#heading-lines button:has-text("These are units")');
  await page.waitForFunction((before) => document.querySelector('#panel-data caption').textContent === before, rows, {timeout: 60000});
  check(await page.inputValue('#setting-header_row') === '4' && await page.inputValue('#setting-units_row') === 'below', `${name}: the settings are not those of the click`);
  await page.click('#heading-lines summary');
  await page.click('#heading-lines li:nth-child(6) button');
  await page.click('#heading-lines button:has-text("These are the headings")');
  await heads('S0,212.5,failure');
  await page.click('#heading-lines li:nth-child(4) button');
  await page.click('#heading-lines button:has-text("These are the headings")');
  await heads('specimen,hours,status');

  // A word that is no status is given its meaning by a click; what stands in the line stays.
  await openTable('words.csv');
  await page.click('#notice button:has-text("Guess")', {timeout: 5000}).catch(() => {});
  await page.waitForFunction(() => document.getElementById('study').value.includes('words.csv'), null, {timeout: 60000});
  await page.click('#step-model');
  await page.waitForSelector('.check .choices:has-text("on the rig") button', {timeout: 60000});
  await looks(page, `${name} status`, complaints);
  await page.click('.check .choices button >> nth=1');
  await page.waitForSelector('.check .choices:has-text("<b>back</b>") button', {timeout: 60000});
  await page.click('.check .choices button >> nth=1');
  await good();
  check((await study()).includes('status = { column = "state", runout = ["on the rig", "<b>back</b>"] }'), `${name}: the words of the status are ${await study()}`);
  await page.evaluate(() => { document.getElementById('study').value = ''; });

  // The advice of a check is followed by a click: a mixture, under a name of its own.
  await openTable('controllers.csv');
  await page.click('#notice button:has-text("Guess")', {timeout: 5000}).catch(() => {});
  await page.waitForFunction(() => document.getElementById('study').value.includes('controllers.csv'), null, {timeout: 60000});
  await good();
  await page.click('#step-fit');
  await page.click('#panel-fit button');
  await page.waitForSelector('#trusted', {timeout: 240000});
  await looks(page, `${name} advice`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-advice.png`), fullPage: true});
  await page.click('.checks button:has-text("Fit a mixture")');
  await page.waitForFunction(() => document.getElementById('study').value.includes('[subpopulations]'), null, {timeout: 60000});
  await good();
  check(await page.inputValue('#study-file') === 'controllers-mixture.toml' && (await study()).includes('"characteristic[subpopulation]"'), `${name}: the mixture is ${await study()}`);
  await page.click('button:has-text("Undo")');
  check(!(await study()).includes('[subpopulations]') && await page.inputValue('#study-file') === 'controllers.toml', `${name}: undo leaves the mixture`);
  await page.evaluate(() => { document.getElementById('study').value = ''; });
  await context.close();
  await stop();
  // Refusals that the above wants: headings from which no study follows (400).
  faults.push(...complaints.filter((each) => !/status of 400/.test(each)).map((each) => `${name}: ${each}`));
}

// Dates as a type: of a table with the dates on which units were put into use and failed, by the heading to a B10; the study has the query, and
// `wearwell fit` the same digits. Dates that can be read in two ways are read in neither before one is chosen.
async function dates(browser, {name, ...options}) {
  const complaints = [], inside = fresh(name), {address, stop} = await serve(inside), context = await browser.newContext({locale: 'de-DE', ...options});
  const page = await open(context, address, complaints);
  const day = (at) => `${String(at % 12 + 1).padStart(2, '0')}/${String(at % 7 + 1).padStart(2, '0')}/202${at < 12 ? 3 : 4}`;
  const rows = Array.from({length: 12}, (_, i) => `<b>U${i}</b>,${day(i)},${i % 4 === 3 ? '' : day(12 + (i * 5) % 12)}`);
  await page.setInputFiles('#choose', {name: 'field.csv', mimeType: 'text/csv', buffer: Buffer.from(['unit,start,broke', ...rows, ''].join('\n'))});
  await page.waitForSelector('#type-2', {timeout: 60000});
  check((await page.textContent('#panel-data tbody')).includes('01/01/2023'), `${name}: a date is not shown as the file has it`);
  await page.selectOption('#type-2', 'dates');
  await looks(page, `${name} dates`, complaints);
  check(await page.isVisible('#date-until'), `${name}: units without a date are not asked for`);
  await page.fill('#date-until', '2025-01-31');
  await page.click('#dates form button');
  await page.waitForSelector('#banners .callout');
  check((await page.textContent('#banners')).includes('broke'), `${name}: dates with two readings are read`);
  await page.selectOption('#date-layout', '%d/%m/%Y');
  await page.fill('#date-until', '2023-12-31');
  await page.click('#dates form button');
  await page.waitForFunction(() => document.getElementById('banners').textContent.includes('field.csv'), null, {timeout: 60000});
  await page.selectOption('#date-layout', '%m/%d/%Y');
  await page.fill('#date-until', '2025-01-31');
  await page.click('#dates form button');
  await page.waitForFunction(() => document.querySelector('#panel-data thead')?.textContent.includes('life [d]'), null, {timeout: 60000});
  await looks(page, `${name} times`, complaints);
  await page.screenshot({path: join(screenshots, `workbench-${name}-times.png`), fullPage: true});
  await page.click('#step-model');
  await page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  check(/^sql = /m.test(await page.inputValue('#study')), `${name}: the study has no query`);
  await looks(page, `${name} model`, complaints);
  await page.click('#step-fit');
  await page.click('#panel-fit button');
  await page.waitForSelector('#trusted', {timeout: 240000});
  const fit = spawnSync(wearwell, ['fit', 'field.toml', '-o', 'by-program', '--quiet'], {cwd: inside, encoding: 'utf8'});
  check(fit.status <= 1, `${name}: wearwell fit: ${fit.stderr}`);
  const summary = (result) => readFileSync(join(inside, result, 'summary.json'), 'utf8');
  check(summary('field-results') === summary('by-program'), `${name}: the program gives other digits`);
  check(JSON.parse(summary('by-program')).quantities.some((each) => each.name.startsWith('B10')), `${name}: no B10`);
  await page.close();
  await stop();

  // Opened again, the table is as the study reads it; without the query it is that of the file.
  const again = await serve(inside), second = await open(context, again.address, complaints);
  await second.selectOption('#in-folder', 'field.toml');
  await second.click('#panel-data .doors button');
  await second.waitForSelector('.check[data-state="good"]', {timeout: 60000});
  await second.click('#step-data');
  await second.waitForFunction(() => document.querySelector('#panel-data thead')?.textContent.includes('life [d]'), null, {timeout: 60000});
  check(await second.textContent('#notice') === '', `${name}: the study opened again is said to differ: ${await second.textContent('#notice')}`);
  await second.click('#dates button');
  await second.waitForSelector('#type-2', {timeout: 60000});
  check((await second.textContent('#notice')).includes('field.toml'), `${name}: another reading of the table is not noticed`);
  await context.close();
  await again.stop();
  faults.push(...complaints.filter((each) => !/status of 400/.test(each)).map((each) => `${name}: ${each}`));
}

mkdirSync(screenshots, {recursive: true});
const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync'],
});
const light = {viewport: {width: 1280, height: 900}, colorScheme: 'light'}, dark = {viewport: {width: 1280, height: 900}, colorScheme: 'dark'};
const narrowLight = {viewport: {width: 390, height: 844}, colorScheme: 'light'}, narrowDark = {viewport: {width: 390, height: 844}, colorScheme: 'dark'};
const walks = {
  lives: async () => {
    await walk(browser, {name: 'wide-light', book: true, ...light});
    await walk(browser, {name: 'narrow-dark', ...narrowDark});
  },
  german: async () => {
    await inGerman(browser, {name: 'german-wide-dark', ...dark});
    await inGerman(browser, {name: 'german-narrow-light', ...narrowLight});
  },
  priors: async () => {
    await priors(browser, {name: 'priors-wide-light', ...light});
    await priors(browser, {name: 'priors-narrow-dark', ...narrowDark});
  },
  corrections: () => corrections(browser, {name: 'corrections-light', ...light}),
  curve: () => curve(browser, {name: 'curve-tablet-dark', viewport: {width: 820, height: 1180}, colorScheme: 'dark'}),
  dates: () => dates(browser, {name: 'dates-narrow-dark', ...narrowDark}),
  errors: () => errors(browser),
  tabs: () => tabs(browser),
  readings: () => readings(browser),
  large: () => large(browser),
  responses: () => responses(browser, {name: 'responses-narrow-light', ...narrowLight}),
  wear: () => wearPaths(browser, {name: 'wear-paths-tablet', viewport: {width: 820, height: 1180}, colorScheme: 'light'}),
};
for (const each of wanted.length ? wanted : Object.keys(walks)) await walks[each]();
await browser.close();
for (const each of faults) console.log(each);
process.exit(faults.length ? 1 : 0);
