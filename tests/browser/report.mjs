// Opens reports in headless Chromium and refuses what a reader would stumble over: an error on the console, a request to
// the network, a plot without marks, a violation of WCAG AA, a page wider than the screen.
//
//   node report.mjs NODE_MODULES SCREENSHOTS REPORT.html...
import {createRequire} from 'node:module';
import {mkdtempSync, mkdirSync, rmSync} from 'node:fs';
import {basename, dirname, join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {tmpdir} from 'node:os';

const [modules, screenshots, ...reports] = process.argv.slice(2);
const require = createRequire(join(resolve(modules), 'any.js'));
const {chromium} = require('playwright-core');
const axe = require.resolve('axe-core/axe.min.js');

const views = [
  {name: 'wide', viewport: {width: 1280, height: 900}, colorScheme: 'light'},
  {name: 'phone', viewport: {width: 390, height: 844}, colorScheme: 'light'},
  {name: 'wide-dark', viewport: {width: 1280, height: 900}, colorScheme: 'dark'},
  {name: 'phone-dark', viewport: {width: 390, height: 844}, colorScheme: 'dark'},
];

// What is wrong with the page as it stands, in words.
async function faults(page) {
  const found = await page.evaluate(() => {
    const wrong = [];
    const figures = [...document.querySelectorAll('figure')];
    if (figures.length < 10) wrong.push(`only ${figures.length} plots`);
    for (const figure of figures) {
      // A mark counts when it is seen: some area or length on the screen.
      const marks = [...figure.querySelectorAll('svg .role-mark path, svg .role-mark line, svg .role-mark text')];
      const seen = marks.filter((mark) => {
        const box = mark.getBoundingClientRect();
        return box.width + box.height > 1;
      });
      if (seen.length === 0) wrong.push(`plot ${figure.id} shows nothing`);
      for (const group of figure.querySelectorAll('svg .role-mark')) {
        if (group.classList.contains('role-scope')) continue;
        if (group.querySelector('[d*="NaN"], [x1="NaN"], [y1="NaN"]')) wrong.push(`plot ${figure.id} has NaN`);
      }
      const svg = figure.querySelector('svg.marks');
      if (svg && svg.getBoundingClientRect().right > innerWidth + 1) wrong.push(`plot ${figure.id} leaves the screen`);
    }
    if (document.documentElement.scrollWidth > innerWidth) wrong.push('the page is wider than the screen');
    return wrong;
  });
  await page.addScriptTag({path: axe});
  const {violations} = await page.evaluate(
      () => axe.run({runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice']}));
  for (const violation of violations) {
    found.push(`${violation.id}: ${violation.help}: ${violation.nodes.slice(0, 3).map((n) => n.html.slice(0, 160)).join(' | ')}`);
  }
  return found;
}

async function open(context, report, complaints) {
  const page = await context.newPage();
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) complaints.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => complaints.push(`script: ${error.message}`));
  const address = pathToFileURL(report).href;
  page.on('request', (request) => {
    const url = request.url();
    if (url !== address && !url.startsWith('data:') && !url.startsWith('blob:')) complaints.push(`request: ${url}`);
  });
  await page.goto(address);
  await page.waitForFunction(
      () => document.querySelectorAll('figure').length === document.querySelectorAll('figure[data-drawn]').length,
      null, {timeout: 30000});
  return page;
}

mkdirSync(screenshots, {recursive: true});
const profile = mkdtempSync(join(tmpdir(), 'wearwell-browser-'));
let failed = false;
try {
  for (const view of views) {
    const context = await chromium.launchPersistentContext(join(profile, view.name), {
      executablePath: '/usr/bin/chromium',
      headless: true,
      // A report needs the Content-Security-Policy; axe has to be added in spite of it.
      bypassCSP: true,
      viewport: view.viewport,
      colorScheme: view.colorScheme,
      args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
             '--disable-component-update', '--disable-sync'],
    });
    for (const report of reports) {
      const complaints = [];
      const page = await open(context, report, complaints);
      const name = basename(dirname(resolve(report)));
      complaints.push(...await faults(page));
      await page.screenshot({path: join(screenshots, `${name}-${view.name}.png`), fullPage: true});
      if (view.name === 'wide') await page.pdf({path: join(screenshots, `${name}.pdf`), format: 'A4', printBackground: false});
      await page.close();
      for (const complaint of complaints) console.log(`${name}, ${view.name}: ${complaint}`);
      console.log(`${complaints.length ? 'FAILED' : 'passed'}: ${name}, ${view.name}`);
      failed ||= complaints.length > 0;
    }
    await context.close();
  }
} finally {
  rmSync(profile, {recursive: true, force: true});
}
process.exit(failed ? 1 : 0);
