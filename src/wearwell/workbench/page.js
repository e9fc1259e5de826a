'use strict';
// The page: its steps, messages, and what the program has open.
(() => {
  const {element, strings} = wearwell;
  const steps = Object.keys(strings.steps);
  const part = (id) => document.getElementById(id);

  wearwell.button = (text, act, look = '') => {
    const made = element('button', {type: 'button', class: look}, text);
    made.addEventListener('click', act);
    return made;
  };
  // The focus goes from a button that is disabled to another.
  wearwell.disable = (button, off, next) => {
    const held = document.activeElement === button;
    button.disabled = off;
    if (off && held) next.focus();
  };
  wearwell.field = (label, id, attributes) => element('div', {class: 'field'}, element('label', {for: id}, label),
      element('input', {id, autocomplete: 'off', spellcheck: 'false', ...attributes}));
  wearwell.area = (label, id, {value, ...attributes}) => {
    const area = element('textarea', {id, rows: Math.min(12, value.split('\n').length + 1), autocomplete: 'off', spellcheck: 'false', wrap: 'off', ...attributes});
    area.value = value;
    return element('div', {class: 'field'}, element('label', {for: id}, label), area);
  };

  // What gives the same without the page.
  wearwell.sameLines = ({command, python}) => (command ? [element('p', {class: 'note'}, strings.sameCommand), element('pre', {class: 'command', tabindex: 0}, command),
      element('p', {class: 'note'}, strings.samePython), element('pre', {class: 'python', tabindex: 0}, python)] : []);

  // What the program refuses is in English. The focus goes back from the message to what was in use.
  function complain({message, status}) {
    const before = document.activeElement, shown = element('div', {class: 'callout fail'}, element('pre', {lang: status ? 'en' : undefined}, message));
    shown.append(wearwell.button(strings.close, () => { if (before.isConnected) before.focus(); shown.remove(); }, 'plain'));
    part('banners').replaceChildren(shown);
  }

  // Does what the user wants; a refusal is shown until the next wish.
  wearwell.attempt = (act) => {
    part('banners').replaceChildren();
    return wearwell.quietly(act);
  };

  // Does what follows from it.
  wearwell.quietly = async (act) => {
    document.body.setAttribute('aria-busy', 'true');
    try {
      await act();
    } catch (error) {
      complain(error);
    } finally {
      document.body.removeAttribute('aria-busy');
    }
  };

  wearwell.step = (name, focus = false) => {
    for (const each of steps) {
      const chosen = each === name, tab = part(`step-${each}`);
      part(`panel-${each}`).hidden = !chosen;
      if (chosen) part(`panel-${each}`).removeAttribute('aria-hidden'); else part(`panel-${each}`).setAttribute('aria-hidden', 'true');
      tab.setAttribute('aria-selected', chosen);
      tab.tabIndex = chosen ? 0 : -1;
      if (chosen && focus) tab.focus();
    }
    if (name === 'data') wearwell.data.redraw();
    // Other programs write into the folder, too.
    if (name === 'compare' && wearwell.hasToken()) wearwell.quietly(async () => session(await wearwell.get('/api/session')));
  };

  function tabs() {
    part('steps').append(...steps.map((each, i) => {
      const tab = element('button', {type: 'button', role: 'tab', id: `step-${each}`, 'aria-controls': `panel-${each}`}, element('span', {class: 'count'}, `${i + 1} `), strings.steps[each]);
      tab.addEventListener('click', () => wearwell.step(each));
      return tab;
    }));
    part('steps').addEventListener('keydown', (event) => {
      const at = steps.findIndex((each) => part(`step-${each}`).getAttribute('aria-selected') === 'true');
      const next = {ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: steps.length - 1}[event.key];
      if (next === undefined) return;
      event.preventDefault();
      wearwell.step(steps[(next + steps.length) % steps.length], true);
    });
  }

  function connection(state) {
    part('connection').dataset.state = state;
    if (state === 'lost') wearwell.fit.lost();
    part('connection').textContent = {live: strings.connected, lost: strings.lost, wait: strings.connecting}[state];
  }

  function session(now) {
    part('folder').textContent = now.folder;
    wearwell.data.files(now.files);
    wearwell.fit.session(now);
    wearwell.compare.session(now);
  }

  async function start() {
    wearwell.keepFocus(() => document.querySelector('#steps [aria-selected="true"]'));
    part('skip').textContent = strings.skip;
    for (const each of [part('navigation'), part('steps')]) each.setAttribute('aria-label', strings.stepsLabel);
    part('connection').before(wearwell.languageSwitch(() => wearwell.model.leave()));
    for (const [name, built] of [['data', wearwell.data], ['model', wearwell.model], ['fit', wearwell.fit], ['compare', wearwell.compare], ['ask', wearwell.askPanel]]) built.build(part(`panel-${name}`));
    tabs();
    connection('wait');
    wearwell.step('data');
    if (!wearwell.hasToken()) { connection('lost'); complain({message: strings.noToken}); return; }
    await wearwell.attempt(async () => {
      const now = await wearwell.get('/api/session');
      session(now);
      if (now.study) await wearwell.model.restore();
      wearwell.model.resume();
      if (now.table) await wearwell.data.restore();
      else if (now.workbook) await wearwell.data.openNamed(now.workbook);
      wearwell.step(now.table ? 'data' : now.study ? 'model' : now.result ? 'fit' : 'data');
    });
    wearwell.follow((now) => { session(now); wearwell.data.session(now); }, connection);
  }
  start();
})();
