'use strict';
// The step Model: how a table can be read, the study as a form and as text. The text is the study; the form is made from it.
(() => {
  const {element, strings} = wearwell;
  const place = {};
  const replaced = [];
  let choices = {columns: []}, generated = '', saved = null, savedName = '', table = null, asked = 0, timer = 0;

  const text = () => place.text.value;
  const isSaved = () => saved !== null && text() === saved && place.name.value === savedName;

  function marks() {
    place.state.textContent = text() && !isSaved() ? strings.unsaved : '';
    place.undo.disabled = replaced.length === 0;
  }

  function gutter(bad) {
    const lines = text().split('\n').length;
    place.gutter.replaceChildren(...Array.from({length: lines}, (_, i) => element('span', {class: i + 1 === bad ? 'bad' : ''}, String(i + 1))));
    place.gutter.scrollTop = place.text.scrollTop;
  }

  function replace(next) {
    if (next === text()) return;
    if (text() && text() !== generated) replaced.push(text());
    place.text.value = next;
    changed();
  }

  function changed() {
    marks();
    gutter();
    clearTimeout(timer);
    timer = setTimeout(() => wearwell.quietly(check), 250);
  }

  async function check() {
    const mine = ++asked, checked = text();
    if (!checked) { place.check.replaceChildren(); place.form.replaceChildren(); return; }
    const found = await wearwell.post('/api/check', {file: place.name.value || 'study.toml', text: checked});
    if (mine !== asked || checked !== text()) return;
    gutter(found.line);
    place.text.setAttribute('aria-invalid', found.problem ? 'true' : 'false');
    place.check.replaceChildren(...(found.problem ? problem(found) : [element('p', {class: 'good'}, strings.checkGood),
        element('details', {}, element('summary', {}, strings.description), element('pre', {tabindex: 0}, found.description))]));
    form(found.keys);
    if (table === null) openItsTable(found.keys);
    place.check.dataset.state = found.problem ? 'bad' : 'good';
  }

  // The table that an opened study names, read as the study says.
  function openItsTable(keys) {
    const settings = {};
    for (const {path, value} of keys) {
      const key = path.startsWith('data.') ? path.slice(5) : '';
      if (key in strings.settings) settings[key] = value;
    }
    const file = keys.find((each) => each.path === 'data.file');
    if (file && saved !== null) wearwell.data.openNamed(file.value, settings);
  }

  function problem(found) {
    const parts = [element('p', {class: 'wrong'}, strings.checkBad), element('pre', {tabindex: 0}, found.problem)];
    if (found.line) parts.push(wearwell.button(strings.goTo(found.line), () => goTo(found.line, found.column), 'plain'));
    return parts;
  }

  function goTo(line, column = 1) {
    const before = text().split('\n').slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0);
    place.text.focus();
    place.text.setSelectionRange(before + column - 1, before + column - 1);
    place.text.scrollTop = Math.max(0, (line - 4) * parseFloat(getComputedStyle(place.text).lineHeight));
  }

  // The meanings of keys are those of the reference, whose pages are not here.
  const plain = (text) => text.replace(/\s*\(?\[[^\]]*\]\([^)]*\)\)?/g, '').replaceAll('`', '').replace(/[:,]? see$/, '');

  function form(keys) {
    if (place.form.contains(document.activeElement) && document.activeElement.matches('input')) place.form.dataset.focus = document.activeElement.id;
    const groups = new Map();
    for (const key of keys) {
      const at = key.path.lastIndexOf('.');
      const group = at < 0 ? '' : key.path.slice(0, at);
      if (!groups.has(group)) groups.set(group, []);
      groups.get(group).push([key, key.path.slice(at + 1)]);
    }
    place.form.replaceChildren(...[...groups].map(([group, inside]) => element('fieldset', {}, element('legend', {}, group || strings.wholeStudy),
        ...inside.map(([key, name]) => {
          const id = `key-${key.path}`;
          const field = wearwell.field(name, id, {value: key.value, placeholder: key.example, 'aria-describedby': key.meaning ? `${id}-meaning` : undefined});
          if (key.meaning) field.append(element('small', {id: `${id}-meaning`}, plain(key.meaning)));
          field.querySelector('input').addEventListener('change', (event) => wearwell.attempt(async () => {
            const before = text();
            try {
              const {text: next} = await wearwell.post('/api/set', {text: before, path: key.path, value: event.target.value});
              if (text() === before) replace(next);
            } catch (error) {
              event.target.value = key.value;
              throw error;
            }
          }));
          return field;
        }))));
    const focus = place.form.dataset.focus;
    delete place.form.dataset.focus;
    if (focus) document.getElementById(focus)?.focus();
  }

  const list = (title, lines) => (lines.length ? element('div', {}, element('h3', {class: 'reason'}, title), element('ul', {}, ...lines.map((each) => element('li', {}, each)))) : null);

  // The options of a reading, as `wearwell new` has them: {"--column", "depth=wear"}.
  function choose(options) {
    for (let i = 0; i + 1 < options.length; i += 2) {
      if (options[i] === '--column') choices.columns.push(options[i + 1]);
      if (options[i] === '--failure') choices.failure = Number(options[i + 1]);
      if (options[i] === 'PRESET') choices.preset = options[i + 1];
    }
    return wearwell.attempt(guess);
  }

  function take(reading) {
    replace(reading.text);
    generated = text();
  }

  function reasons(reading) {
    const questions = reading.questions.map((question) => element('fieldset', {class: 'choices question'}, element('legend', {}, question.text),
        ...question.readings.map((each) => wearwell.button(each.text, () => choose(each.options), 'plain'))));
    place.reasons.replaceChildren(...[...questions, list(strings.guesses, reading.guesses), list(strings.unstated, reading.unstated), list(strings.taken, reading.taken)].filter(Boolean));
  }

  async function guess() {
    roles();
    let readings = [];
    try {
      ({readings} = await wearwell.post('/api/guess', {...choices, preset: undefined}));
    } catch (error) {
      place.readings.hidden = true;
      place.reasons.replaceChildren();
      place.roles.open = true;
      throw error;
    }
    const first = Math.max(0, readings.findIndex((each) => each.preset === choices.preset));
    place.readings.replaceChildren(element('legend', {}, strings.readings), ...readings.map((each, i) => {
      const input = element('input', {type: 'radio', name: 'reading', value: each.preset, id: `reading-${i}`, checked: i === first});
      input.addEventListener('change', () => { choices.preset = each.preset; take(each); reasons(each); });
      return element('label', {class: 'tick', for: `reading-${i}`}, input, `${each.preset}: ${each.reading}`, i > 0 && each.equal ? element('small', {}, ` (${strings.equal})`) : null);
    }));
    place.readings.hidden = false;
    reasons(readings[first]);
    take(readings[first]);
  }

  function roles() {
    place.roles.hidden = false;
    place.role.replaceChildren(...table.roles.map((each) => element('option', {value: each}, each)));
    place.column.replaceChildren(element('option', {value: ''}, strings.noColumn), ...table.columns.slice(0, 1000).map((each) => element('option', {value: each.name}, each.name)));
    place.chosen.replaceChildren(...(choices.columns.length ? [element('p', {}, `${strings.chosenRoles}: ${choices.columns.join('; ')} `),
        wearwell.button(strings.forget, () => { choices = {columns: []}; wearwell.attempt(guess); }, 'plain')] : []));
  }

  // A study that is open and not of this table stays.
  function tableOpened(next) {
    table = next;
    choices = {columns: []};
    place.empty.hidden = true;
    if (saved !== null && text().includes(JSON.stringify(next.file))) return;
    place.name.value = `${next.file.replace(/\.gz$/, '').replace(/\.[^.]*$/, '')}.toml`;
    saved = null;
    place.work.hidden = false;
    wearwell.quietly(guess);
  }

  function show(file, content) {
    place.empty.hidden = true;
    place.work.hidden = false;
    place.name.value = file;
    [saved, savedName, generated] = [content, file, content];
    place.text.value = content;
    replaced.length = 0;
    changed();
  }

  // Returns the name of the file, which has what the editor shows.
  async function save() {
    const content = text(), name = place.name.value;
    if (!isSaved()) {
      await wearwell.post('/api/save', {file: name, text: content, before: name === savedName ? saved : null});
      [saved, savedName] = [content, name];
      place.note.textContent = strings.saved(name);
      marks();
    }
    return name;
  }

  function build(panel) {
    place.empty = element('p', {}, strings.noTable);
    place.readings = element('fieldset', {class: 'readings', hidden: true});
    place.reasons = element('div', {class: 'reasons'});
    place.role = element('select', {id: 'role'});
    place.column = element('select', {id: 'role-column'});
    place.chosen = element('div', {});
    place.roles = element('details', {hidden: true}, element('summary', {}, strings.columnRole), element('div', {class: 'fields'},
        element('div', {class: 'field'}, element('label', {for: 'role'}, strings.role), place.role),
        element('div', {class: 'field'}, element('label', {for: 'role-column'}, strings.column), place.column),
        wearwell.button(strings.setRole, () => choose(['--column', `${place.role.value}=${place.column.value}`]))), place.chosen);
    place.form = element('div', {class: 'form'});
    place.text = element('textarea', {id: 'study', spellcheck: 'false', wrap: 'off', autocomplete: 'off', 'aria-describedby': 'check'});
    place.gutter = element('div', {class: 'gutter', 'aria-hidden': 'true'});
    place.text.addEventListener('input', changed);
    place.text.addEventListener('scroll', () => { place.gutter.scrollTop = place.text.scrollTop; });
    place.check = element('div', {id: 'check', class: 'check', role: 'status'});
    const name = wearwell.field(strings.fileName, 'study-file', {});
    place.name = name.querySelector('input');
    place.name.addEventListener('input', marks);
    place.state = element('span', {class: 'note', role: 'status'});
    place.note = element('p', {class: 'note', role: 'status'});
    place.undo = wearwell.button(strings.undo, () => { const last = replaced.pop(); if (last !== undefined) { place.text.value = last; changed(); } }, 'plain');
    place.work = element('div', {class: 'two', hidden: true},
        element('div', {}, place.readings, place.reasons, place.roles, element('h3', {}, strings.formTitle), place.form),
        element('div', {class: 'editing'}, element('h3', {}, element('label', {for: 'study'}, strings.editorLabel)),
            element('div', {class: 'editor'}, place.gutter, place.text), place.check,
            element('div', {class: 'line'}, name, wearwell.button(strings.save, () => wearwell.attempt(save)), place.undo, place.state), place.note));
    panel.append(element('h2', {}, strings.modelTitle), place.empty, place.work);
    addEventListener('beforeunload', (event) => { if (text() && !isSaved() && text() !== generated) event.preventDefault(); });
  }

  wearwell.model = {build, tableOpened, show, save, hasText: () => Boolean(text()), restore: async () => { const {file, text: content} = await wearwell.get('/api/study'); show(file, content); }};
})();
