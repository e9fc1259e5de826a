// Makes the pictures of docs/how-to/workbench.md in docs/images, in headless Chromium:
//
//   node docs/_tools/workbench_pictures.mjs NODE_MODULES WEARWELL
import {spawn} from 'node:child_process';
import {mkdirSync, mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {dirname, join, resolve} from 'node:path';
import {createInterface} from 'node:readline';
import {fileURLToPath} from 'node:url';

const [modules, wearwell] = process.argv.slice(2);
const {chromium} = createRequire(join(resolve(modules), 'any.js'))('playwright-core');
const images = join(dirname(fileURLToPath(import.meta.url)), '..', 'images');
const scratch = mkdtempSync(join(tmpdir(), 'pictures-')), folder = join(scratch, 'pumps');
mkdirSync(folder);
const hours = [212.5, 305, 371, 418.5, 466, 509, 540, 588, 633, 702, 749, 800, 800, 800, 800];
writeFileSync(join(folder, 'pumps.csv'), `pump,running hours [h],status\n${hours.map((each, i) => `P${i + 1},${each},${i < 11 ? 'failure' : 'running'}\n`).join('')}`);

const child = spawn(wearwell, ['open', join(folder, 'pumps.csv'), '--no-browser'], {stdio: ['ignore', 'pipe', 'inherit']});
const address = await new Promise((done) => { createInterface(child.stdout).once('line', (line) => done(line.slice(line.indexOf('http')))); });
const browser = await chromium.launch({executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--disable-gpu']});
const page = await browser.newPage({viewport: {width: 1280, height: 860}, colorScheme: 'light', locale: 'en-GB'});
await page.goto(address);
await page.waitForSelector('#panel-data tbody tr');
await page.evaluate(() => { document.getElementById('folder').textContent = 'pumps'; });
await page.click('#step-model');
const good = () => page.waitForSelector('.check[data-state="good"]', {timeout: 60000});
await good();
await page.screenshot({path: join(images, 'workbench-model.png')});

await page.click('#priors summary');
const grip = page.locator('#priors [id$="-location"] .grip').first();
await grip.waitFor();
await grip.scrollIntoViewIfNeeded();
const {x, y, width, height} = await grip.boundingBox();
await page.mouse.move(x + width / 2, y + height / 2);
await page.mouse.down();
await page.mouse.move(x + width / 2 + 24, y + height / 2, {steps: 12});
await page.mouse.up();
await page.waitForTimeout(1000);  // check and lives follow the last move
await good();
await page.locator('#priors').screenshot({path: join(images, 'workbench-priors.png')});

await page.click('#priors summary');
await page.click('#families summary');
await page.waitForSelector('.family .fitted', {timeout: 60000});
// The first four of nine.
await page.setViewportSize({width: 1280, height: 4200});
await page.evaluate(() => scrollTo(0, 0));
const first = await page.locator('#families').boundingBox(), fifth = await page.locator('.family').nth(4).boundingBox();
await page.screenshot({path: join(images, 'workbench-families.png'), clip: {x: first.x, y: first.y, width: first.width, height: fifth.y - first.y}});

await page.setViewportSize({width: 1280, height: 1400});
await page.click('#step-fit');
await page.click('#panel-fit button');
await page.waitForSelector('#trusted', {timeout: 240000});
await page.click('#live summary');
const answered = () => page.waitForFunction(() => document.querySelector('#live .plot') && !document.querySelector('#live').hasAttribute('aria-busy'), null, {timeout: 60000});
await answered();
await page.focus('#live-survived');
for (let i = 0; i < 15; ++i) await page.keyboard.press('ArrowRight');
await page.waitForFunction(() => /after|from/.test(document.querySelector('#live .answer').textContent), null, {timeout: 60000});
await answered();
await page.evaluate(() => document.querySelectorAll('#live pre.command, #live pre.python').forEach((each) => { each.textContent = each.textContent.replaceAll(/\/[^ "]*\/(pumps-results)/g, '$1'); }));
await page.locator('#live').screenshot({path: join(images, 'workbench-live.png')});

// Wear paths, whose next test is asked for.
await page.evaluate(() => { document.getElementById('study').value = ''; });
writeFileSync(join(folder, 'liners.csv'), `liner,hours [h],wear [um]\n${['A', 'B', 'C', 'D', 'E'].flatMap((each, i) => [150, 300, 500, 800, 1000].map((at, j) => `${each},${at},${((0.05 + 0.008 * i) * at + [0.8, -1.1, 0.3, 1.2, -0.7][(i + j) % 5]).toFixed(1)}\n`)).join('')}`);
await page.reload();
await page.click('#step-data');
await page.selectOption('#in-folder', 'liners.csv');
await page.click('#panel-data .doors button');
await page.waitForFunction(() => document.querySelector('#panel-data caption')?.textContent.startsWith('liners.csv'), null, {timeout: 60000});
await page.click('#step-model');
await page.click('#notice button:has-text("Guess")', {timeout: 10000}).catch(() => {});
await page.waitForFunction(() => document.getElementById('study').value.includes('liners.csv'), null, {timeout: 60000});
await page.fill('#limit', '95 um');
await page.press('#limit', 'Enter');
await page.waitForFunction(() => document.getElementById('study').value.includes('95 um'), null, {timeout: 60000});
await good();
await page.click('#step-fit');
await page.click('#panel-fit button');
await page.waitForFunction(() => document.querySelector('#result .command')?.textContent.includes('liners'), null, {timeout: 240000});
await page.click('#step-ask');
await page.fill('#next-goal', 'B10');
await page.fill('#next-grid', 'hours [h] = 500 to 2000 by 500');
await page.click('#next-form button');
await page.waitForSelector('.card .command', {timeout: 240000});
await page.evaluate(() => document.querySelectorAll('.card pre').forEach((each) => { each.textContent = each.textContent.replaceAll(/\/[^ "]*\/(liners-results)/g, '$1'); }));
await page.setViewportSize({width: 1000, height: 1400});
await page.locator('.card').screenshot({path: join(images, 'workbench-next.png')});
await browser.close();
child.kill('SIGINT');
await new Promise((done) => { child.once('exit', done); });
rmSync(scratch, {recursive: true, force: true});
