'use strict';
// The step Fit: run, progress, verdict, checks, tables and the report.
(() => {
  const {element, strings} = wearwell;
  const place = {};
  let live = null;
  let shown = '', report = '';

  // The focus goes from the button that is gone to the one in its place.
  function show(running) {
    const held = document.activeElement;
    if (running) place.stop.hidden = false;
    wearwell.disable(place.go, running, place.stop);
    if (!running && held === place.stop) place.go.focus();
    place.stop.hidden = !running;
  }

  // A screen reader hears a fit begin and end, and between them where it is every ten seconds.
  let heard = 0;
  function announce(running, text) {
    if (running && performance.now() - heard < 10000) return;
    heard = running ? performance.now() : 0;
    if (place.heard.textContent !== text) place.heard.textContent = text;
  }

  function progress(fit) {
    const running = fit.state === 'running';
    show(running);
    place.bar.hidden = !running;
    place.progress.replaceChildren();
    if (running) {
      if (fit.total) { place.bar.max = fit.total; place.bar.value = fit.done; } else { place.bar.removeAttribute('value'); }
      const what = wearwell.ofProgram(fit.what);
      const steps = fit.total ? strings.steps_of(wearwell.count(fit.done), wearwell.count(fit.total), what) : fit.done ? strings.steps_(wearwell.count(fit.done), what) : what;
      place.progress.append([strings.running(fit.study), steps, strings.seconds(Math.round(fit.seconds))].filter(Boolean).join(', '));
    }
    if (fit.state === 'stopped') place.progress.append(strings.stopped);
    announce(running, place.progress.textContent);
    place.problem.replaceChildren(...(fit.state === 'failed' ? [element('p', {class: 'wrong'}, strings.failed), element('pre', {tabindex: 0, lang: 'en'}, fit.problem)] : []));
  }

  const short = (text) => (text.length < 25 ? 'short' : '');

  // Columns without a cell are left out, as in the report.
  wearwell.table = function table({id, caption, columns: given, rows: every, all, lang}) {
    const kept = given.map((_, i) => i).filter((i) => i === 0 || every.some((cells) => cells[i] !== ''));
    const columns = kept.map((i) => given[i]), rows = every.map((cells) => kept.map((i) => cells[i]));
    const parts = [element('caption', {}, caption), element('thead', {}, element('tr', {}, ...columns.map((each) => element('th', {scope: 'col'}, each)))),
                   element('tbody', {}, ...rows.map((cells) => element('tr', {}, ...cells.map((each, i) => element(i ? 'td' : 'th', i ? {class: short(each)} : {scope: 'row'}, each)))))];
    return element('div', {}, element('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption, lang}, element('table', {id: `table-${id}`}, ...parts)),
        rows.length < all ? element('p', {class: 'note'}, strings.ofRows(rows.length, all)) : null);
  };

  const programTable = (found) => wearwell.table({...found, lang: 'en'});

  function checks(all, folder) {
    const advised = all.some((each) => each.advice);
    const heads = [strings.check, strings.verdict, strings.finding, ...(advised ? [strings.advice] : [])];
    return element('div', {class: 'scroll whole', tabindex: 0, role: 'region', 'aria-label': strings.checks}, element('table', {class: 'checks'}, element('caption', {}, strings.checks),
        element('thead', {}, element('tr', {}, ...heads.map((each) => element('th', {scope: 'col'}, each)))),
        element('tbody', {}, ...all.map((each) => element('tr', {}, element('th', {scope: 'row'}, each.name),
            element('td', {}, element('span', {class: `verdict ${each.verdict}`}, strings.verdicts[each.verdict])), element('td', {lang: 'en'}, each.detail), advised ? wearwell.adviceCell(each, folder) : null)))));
  }

  async function result() {
    const found = await wearwell.get('/api/result');
    const tiles = found.tiles.slice(0, 8).map((each) => element('div', {}, element('dt', {}, each.name), element('dd', {class: 'value'}, `${each.value} ${wearwell.unit(each.unit)}`), element('dd', {class: 'note'}, each.note)));
    // The table of the answers; the others are folded.
    const main = ['bounds', 'quantities', 'predictions'].map((id) => found.tables.find((each) => each.id === id)).find(Boolean);
    const frame = element('iframe', {title: strings.report, sandbox: 'allow-scripts allow-downloads allow-popups'});
    const details = element('details', {}, element('summary', {}, strings.report), frame);
    details.addEventListener('toggle', () => { if (details.open && !frame.src) frame.src = report; });
    place.verdict.replaceChildren(element('h3', {lang: 'en'}, found.title),
        element('p', {class: `callout ${found.trusted ? 'good' : 'fail'}`, id: 'trusted'}, found.trusted ? strings.trusted : strings.notTrusted));
    place.result.replaceChildren(...found.leads.map((each) => element('p', {class: 'lead', lang: 'en'}, each)), element('dl', {class: 'tiles', lang: 'en'}, ...tiles), ...(main ? [programTable(main)] : []), checks(found.checks, found.folder), live.panel,
        element('details', {}, element('summary', {}, strings.tablesTitle), ...found.tables.filter((each) => each !== main && each.id !== 'checks').map(programTable)),
        details, element('p', {}, element('a', {href: report, target: '_blank', rel: 'noopener'}, strings.reportTab)), element('p', {class: 'note'}, strings.filesIn(found.folder)),
        ...wearwell.sameLines(found));
    live.result(found);
    wearwell.askPanel.result(found);
  }

  // What became of a run is seen by the files alone.
  function lost() {
    if (place.stop.hidden) return;
    show(false);
    place.bar.hidden = true;
    place.progress.textContent = strings.fitLost;
    announce(false, strings.fitLost);
  }

  function session(now) {
    report = now.report ?? report;
    progress(now.fit);
    const key = `${now.result} ${now.fit.written}`;
    if (!now.result || key === shown || now.fit.state === 'running') return;
    shown = key;
    wearwell.quietly(result);
  }

  function build(panel) {
    place.go = wearwell.button(strings.fit, () => wearwell.attempt(async () => {
      if (!wearwell.model.hasText()) throw new Error(strings.noStudy);
      await wearwell.post('/api/fit', await wearwell.model.save());
    }));
    place.stop = wearwell.button(strings.stop, () => wearwell.attempt(() => wearwell.post('/api/stop')), 'plain');
    place.stop.hidden = true;
    place.bar = element('progress', {'aria-label': strings.fitTitle, hidden: true});
    place.progress = element('p', {id: 'progress'});
    place.heard = element('p', {class: 'heard', role: 'status'});
    place.problem = element('div', {role: 'alert'});
    live = wearwell.liveLife();
    place.verdict = element('div', {role: 'status'});
    place.result = element('div', {id: 'result'}, element('p', {}, strings.noResult));
    panel.append(element('h2', {}, strings.fitTitle), element('div', {class: 'line'}, place.go, place.stop, place.bar), place.progress, place.heard, place.problem, place.verdict, place.result);
  }

  wearwell.fit = {build, session, lost, result: () => wearwell.quietly(result)};
})();
