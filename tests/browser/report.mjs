// Opens reports in headless Chromium and refuses what a reader would stumble over: an error on the console, a request to
// the network, a plot without marks, a line that leaves the order of its points, a text of a plot that is cut off or covered, a table that is cut off or has a column
// without content, a violation of WCAG AA, a page wider than the screen, something folded on paper.
//
//   [WEARWELL_SCREENSHOTS=1] node report.mjs NODE_MODULES SCREENSHOTS LEAST_PLOTS REPORT.html...
import {createRequire} from 'node:module';
import {mkdirSync, readFileSync} from 'node:fs';
import {basename, dirname, join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {boxFaults} from './plot_boxes.mjs';

const [modules, screenshots, least, ...reports] = process.argv.slice(2);
const require = createRequire(join(resolve(modules), 'any.js'));
const {chromium} = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

// The layout depends on the width alone and the colours on the scheme alone: two views show both of each.
const views = [
  {name: 'wide', viewport: {width: 1280, height: 900}, colorScheme: 'light'},
  {name: 'phone-dark', viewport: {width: 390, height: 844}, colorScheme: 'dark'},
];

// What is wrong with the plots, in words.
function plotFaults(page) {
  return page.evaluate((atLeast) => {
    const wrong = [];
    const figures = [...document.querySelectorAll('figure')];
    if (figures.length < atLeast) wrong.push(`only ${figures.length} plots`);
    for (const figure of figures) {
      // A mark counts when it is seen: some length on the screen.
      const marks = [...figure.querySelectorAll('svg .role-mark path, svg .role-mark line')];
      const seen = marks.filter((mark) => {
        const box = mark.getBoundingClientRect();
        return box.width + box.height > 1;
      });
      if (seen.length === 0) wrong.push(`plot ${figure.id} shows nothing`);
      // A curve runs through its points in their order, back and forth.
      const turns = (x) => x.slice(2).filter((each, i) => (each - x[i + 1]) * (x[i + 1] - x[i]) < 0).length;
      const source = figure.querySelector('script[type="application/json"]');
      (source ? JSON.parse(source.textContent).layer : []).forEach(({mark, data}, i) => {
        const path = figure.querySelector(`.layer_${i}_marks path`)?.getAttribute('d');
        if (mark?.type !== 'line' || mark.interpolate || !path) return;
        const [names, ...rows] = data.values.split('\n');
        const of = names.split(',').indexOf('x');
        const wanted = turns(rows.map((row) => Number(row.split(',')[of])));
        const drawn = turns([...path.matchAll(/[ML](-?[\d.e-]+)/g)].map((each) => Number(each[1])));
        if (wanted !== drawn) wrong.push(`plot ${figure.id}: a line turns ${drawn} times where its points turn ${wanted} times`);
      });
      if (figure.querySelector('[d*="NaN"], [x1="NaN"], [y1="NaN"]')) wrong.push(`plot ${figure.id} has NaN`);
      const svg = figure.querySelector('svg.marks');
      if (svg.getBoundingClientRect().right > innerWidth + 1) wrong.push(`plot ${figure.id} leaves the screen`);
      if (getComputedStyle(svg).backgroundColor !== 'rgba(0, 0, 0, 0)') wrong.push(`plot ${figure.id} has a ground of its own`);
    }
    if (document.documentElement.scrollWidth > innerWidth) wrong.push('the page is wider than the screen');
    return wrong;
  }, Number(least));
}

// Tables that a reader of a wide screen has to scroll, folded ones too; columns without content; numbers on axes as programs
// write them.
function tableFaults(page, wide) {
  return page.evaluate((isWide) => {
    const wrong = [];
    const folded = [...document.querySelectorAll('main details:not([open])')].filter((each) => !each.closest('.plot'));
    folded.forEach((each) => each.open = true);
    for (const box of document.querySelectorAll('.scroll')) {
      const name = box.getAttribute('aria-label');
      if (isWide && box.scrollWidth > box.clientWidth) wrong.push(`table "${name}" is cut: ${box.scrollWidth} of ${box.clientWidth} pixels`);
      const rows = [...box.querySelectorAll('tbody tr')];
      box.querySelectorAll('thead th').forEach((heading, column) => {
        if (column > 0 && rows.length > 0 && rows.every((row) => ['', '–'].includes(row.children[column].textContent.trim())))
          wrong.push(`table "${name}": column "${heading.textContent}" is empty`);
      });
      if (rows.length > 12 && !box.querySelector('table.words') && !box.closest('details')) wrong.push(`table "${name}": ${rows.length} rows are not folded`);
    }
    // A word of a language is not broken within.
    for (const part of document.querySelectorAll('.scroll th, .scroll td')) {
      const walker = document.createTreeWalker(part, NodeFilter.SHOW_TEXT), range = document.createRange();
      while (walker.nextNode()) {
        for (const {0: word, index} of walker.currentNode.data.matchAll(/(?<=^| )[A-Za-z]{2,16}(?=$|[ ,.;:])/g)) {
          range.setStart(walker.currentNode, index);
          range.setEnd(walker.currentNode, index + word.length);
          if (new Set([...range.getClientRects()].map((each) => Math.round(each.top))).size > 1) wrong.push(`"${word}" is broken in the table "${part.closest('.scroll').getAttribute('aria-label')}"`);
        }
      }
    }
    folded.forEach((each) => each.open = false);
    for (const label of document.querySelectorAll('figure .role-axis-label text')) {
      if (/\de[+−-]?\d|\d[kMGµ]$|NaN|undefined|Infinity/.test(label.textContent)) wrong.push(`plot ${label.closest('figure').id}: "${label.textContent}" on an axis`);
    }
    return wrong;
  }, wide);
}

// On paper: what is folded is open, and nothing is wider than the page. The page stays that of paper.
async function printFaults(page) {
  await page.emulateMedia({media: 'print'});
  await page.setViewportSize({width: 690, height: 1000});  // A4 less its margins
  const wrong = await page.evaluate(() => {
    const wrong = [];
    dispatchEvent(new Event('beforeprint'));
    if ([...document.querySelectorAll('main details')].some((each) => !each.closest('.plot') && !each.open))
      wrong.push('on paper something stays folded');
    for (const ground of [document.body, document.querySelector('section')]) {
      if (!['rgb(255, 255, 255)', 'rgba(0, 0, 0, 0)'].includes(getComputedStyle(ground).backgroundColor)) wrong.push('on paper the ground is not white');
    }
    return wrong;
  });
  return wrong;
}

async function accessibilityFaults(page) {
  // Thousands of marks are hidden from screen readers; axe would take seconds to walk over them.
  await page.evaluate(() => document.querySelectorAll('svg .role-mark > *').forEach((mark) => mark.remove()));
  // Evaluated, not added as an element, so that the page's Content-Security-Policy stays in force.
  await page.evaluate(axe);
  const {violations} = await page.evaluate(
      () => axe.run({runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'], resultTypes: ['violations']}));
  return violations.map(
      ({id, help, nodes}) => `${id}: ${help}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 160)).join(' | ')}`);
}

// To look at: drawing a whole report takes as long as all checks.
async function picture(page, name, view) {
  mkdirSync(screenshots, {recursive: true});
  await page.screenshot({path: join(screenshots, `${name}.png`), fullPage: true});
  if (view !== 'wide') return;
  // What is seen first; docs/images/joint-report.png is the one of joint/study.
  await page.screenshot({path: join(screenshots, `${name}-first.png`), clip: {x: 0, y: 0, width: 1280, height: 1180}, fullPage: true});
  await page.pdf({path: join(screenshots, `${name}.pdf`), format: 'A4'});
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
  await page.goto(address, {timeout: 120000});
  await page.waitForFunction(
      () => document.querySelectorAll('figure').length === document.querySelectorAll('figure[data-drawn]').length,
      null, {timeout: 120000});
  return page;
}

// Playwright gives the browser an empty folder for its profile and removes it.
const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
         '--disable-component-update', '--disable-sync'],
});
let failed = false;
try {
  for (const {name: view, ...options} of views) {
    const context = await browser.newContext(options);
    for (const report of reports) {
      const name = `${basename(dirname(resolve(report)))}-${view}`;
      const complaints = [];
      const page = await open(context, report, complaints);
      complaints.push(...await plotFaults(page));
      if (Number(least) > 0) complaints.push(...await boxFaults(page));
      complaints.push(...await tableFaults(page, options.viewport.width >= 1280));
      if (process.env.WEARWELL_SCREENSHOTS) await picture(page, name, view);
      complaints.push(...await accessibilityFaults(page));
      if (view === 'wide') complaints.push(...await printFaults(page));
      await page.close();
      for (const complaint of complaints) console.log(`${name}: ${complaint}`);
      console.log(`${name}: ${complaints.length ? 'FAILED' : 'passed'}`);
      failed ||= complaints.length > 0;
    }
    await context.close();
  }
} finally {
  await browser.close();
}
process.exit(failed ? 1 : 0);
