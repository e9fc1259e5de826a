'use strict';
// Longer than others: one part of the page, with its state.
// The step Model: how a table can be read, the study as a form and as text. The text is the study; the form is made from it.
(() => {
  const {element, strings} = wearwell;
  const place = {};
  const replaced = [];
  let choices = {columns: []}, generated = '', saved = null, savedName = '', table = null, timer = 0, slow = 0, checking = false, again = false;
  let keys = [], questions = [], unread = false, keptFor = 0, left = false, form = null, formulas = null;

  const text = () => place.text.value;
  const isSaved = () => saved !== null && text() === saved && place.name.value === savedName;
  const isEdited = () => text() !== '' && text() !== generated && !isSaved();
  // A study that was saved, opened or edited stays when another table is opened.
  const isKept = () => saved !== null || isEdited();

  function marks() {
    place.state.textContent = text() && !isSaved() ? strings.unsaved : '';
    wearwell.disable(place.undo, replaced.length === 0, place.text);
  }

  function gutter(bad) {
    const lines = text().split('\n').length;
    place.gutter.replaceChildren(...Array.from({length: lines}, (_, i) => element('span', {class: i + 1 === bad ? 'bad' : ''}, String(i + 1))));
    place.gutter.scrollTop = place.text.scrollTop;
  }

  function remember() { replaced.push({text: text(), name: place.name.value, saved, savedName}); }

  function replace(next, isValue = false) {
    if (next === text()) return;
    if (text() && (isValue || text() !== generated || saved !== null)) remember();
    place.text.value = next;
    changed();
  }

  // The file has what was last saved there, not what it had when the text was replaced.
  function undo() {
    const last = replaced.pop();
    if (!last) return;
    if (last.savedName !== savedName) [saved, savedName] = [last.saved, last.savedName];
    place.name.value = last.name;
    place.text.value = last.text;
    hideGuess();
    changed();
  }

  // A text that is a study of its own, not saved yet.
  function becomes(name, next) {
    remember();
    place.name.value = name;
    place.text.value = next;
    hideGuess();
    changed();
    place.text.focus();
  }

  function hideGuess() {
    [questions, unread] = [[], false];
    place.readings.hidden = true;
    place.roles.hidden = true;
    place.limit.hidden = true;
    place.chosen.replaceChildren();
    place.reasons.replaceChildren();
  }

  function changed() {
    marks();
    gutter();
    clearTimeout(timer);
    timer = setTimeout(() => wearwell.quietly(check), 40);
  }

  // The form follows at once. The check reads the tables: one at a time, and of the texts that come meanwhile the last.
  async function check() {
    const checked = text();
    if (!await showForm(checked)) return;
    await new Promise((done) => { setTimeout(done, 200); });
    if (checked !== text()) return;
    if (checking) { again = true; return; }
    checking = true;
    try {
      await checkText(checked);
    } finally {
      checking = false;
      if (again) { again = false; wearwell.quietly(check); }
    }
  }

  // Whether this is still the text, and TOML.
  async function showForm(checked) {
    keys = [];
    if (!checked) { place.check.replaceChildren(); place.form.replaceChildren(); formulas.show([]); delete place.check.dataset.state; compare(); return false; }
    const found = await wearwell.post('/api/form', {file: place.name.value || 'study.toml', text: checked});
    if (checked !== text()) return false;
    keys = found.keys;
    form.show(keys);
    if (found.formulas) formulas.show(found.formulas);
    wearwell.data.unitsChanged();
    compare();
    if (!found.problem) {
      place.check.dataset.state = 'checking';
      clearTimeout(slow);
      slow = setTimeout(() => place.check.replaceChildren(element('p', {class: 'note'}, strings.checking)), 300);
      return true;
    }
    verdict(found);
    return false;
  }

  function verdict(found) {
    clearTimeout(slow);
    gutter(found.line);
    place.text.setAttribute('aria-invalid', found.problem ? 'true' : 'false');
    place.check.replaceChildren(...(found.problem ? problem(found) : [element('p', {class: 'good'}, strings.checkGood),
        element('details', {}, element('summary', {}, strings.description), element('pre', {tabindex: 0, lang: 'en'}, found.description))]));
    place.check.dataset.state = found.problem ? 'bad' : 'good';
    for (const each of place.parts) each.update();
  }

  async function checkText(checked) {
    const found = await wearwell.post('/api/check', {file: place.name.value || 'study.toml', text: checked});
    if (checked !== text()) return;
    fileChanged(found.table_changed);
    verdict(found);
    if (table === null && saved !== null) openItsTable();
  }

  // The study, for the parts below the form: what they ask of it and how they change it.
  const study = {text, replace: (next) => replace(next, true), remember, changed,
    keys: () => keys,
    name: () => place.name.value,
    readsTable: () => table !== null && itsTable() === table.file,
    asked: () => ({file: place.name.value || 'study.toml', text: text()}),
    isGood: () => place.check.dataset.state === 'good',
    // Of one of the columns of .priors and .papers.
    width() {
      const whole = place.form.clientWidth || 600, gap = 18, columns = Math.max(1, Math.floor((whole + gap) / (260 + gap)));
      return Math.min(420, Math.floor((whole - gap * (columns - 1)) / columns));
    },
    put(next, values) {
      place.text.value = next;
      for (const {path, value} of values) Object.assign(document.getElementById(`key-${path}`) ?? {}, {value});
      marks();
    }};

  const valueOf = (path) => keys.find((each) => each.path === path)?.value;
  const itsTable = () => valueOf('data.file')?.replace(/^\.\//, '');

  // The table that a study names, read as the study says.
  function openItsTable() {
    const settings = {};
    for (const key of Object.keys(strings.settings)) if (valueOf(`data.${key}`) !== undefined) settings[key] = valueOf(`data.${key}`);
    if (itsTable()) return wearwell.data.openNamed(itsTable(), settings);
    return undefined;
  }

  // Of the file of the table that is shown.
  function fileChanged(changed) {
    if (!table || Boolean(table.changed) === changed) return;
    table.changed = changed;
    compare();
  }

  // A study that stays, beside a table that it does not read, or reads with other settings, says so.
  function compare() {
    const notice = document.getElementById('notice');
    notice.replaceChildren();
    if (table?.changed) notice.append(element('div', {class: 'callout warn'}, element('p', {}, strings.changedTable(table.file)), wearwell.button(strings.apply, () => wearwell.data.open(table.file, table.settings), 'plain')));
    if (!table || !keys.length || !isKept() || keptFor === table.number) return;
    const files = keys.filter(({path}) => /^data\b.*\bfile$/.test(path)).map(({value}) => value.replace(/^\.\//, ''));
    const read = {...table.settings, ...(table.wide ? {sql: table.sql} : {})};
    const differ = itsTable() === table.file ? Object.keys(strings.settings).filter((key) => (valueOf(`data.${key}`) ?? '') !== (read[key] ?? '')) : [];
    if (files.includes(table.file) && !differ.length) return;
    const shown = (value) => (value === undefined || value === '' ? strings.notSet : value);
    const buttons = [wearwell.button(strings.guessTable(table.file), () => wearwell.attempt(guessTable), 'plain')];
    if (wearwell.data.has(itsTable())) buttons.push(wearwell.button(strings.openAsRead, () => openItsTable(), 'plain'));
    buttons.push(wearwell.button(strings.keepStudy, () => { keptFor = table.number; compare(); }, 'plain'));
    notice.append(element('div', {class: 'callout warn'}, element('p', {}, differ.length
        ? strings.otherSettings(place.name.value, table.file, differ.map((key) => `${strings.settings[key]}: ${shown(valueOf(`data.${key}`))} / ${shown(read[key])}`).join('; '))
        : strings.otherTable(place.name.value, table.file)), element('div', {class: 'choices'}, ...buttons)));
  }

  function problem(found) {
    const parts = [element('p', {class: 'wrong'}, strings.checkBad), element('pre', {tabindex: 0, lang: 'en'}, found.problem)];
    const status = wearwell.statusChoice(found.problem);
    if (status) parts.push(status);
    if (found.line) parts.push(wearwell.button(strings.goTo(found.line), () => goTo(found.line, found.column), 'plain'));
    return parts;
  }

  function goTo(line, column = 1) {
    const before = text().split('\n').slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0);
    place.text.focus();
    place.text.setSelectionRange(before + column - 1, before + column - 1);
    place.text.scrollTop = Math.max(0, (line - 4) * parseFloat(getComputedStyle(place.text).lineHeight));
  }

  const list = (title, lines) => (lines.length ? element('div', {}, element('h3', {class: 'reason'}, title), element('ul', {}, ...lines.map((each) => wearwell.programElement('li', {}, each)))) : null);

  // The options of a reading, as `wearwell new` has them: {"--column", "depth=wear"}.
  function choose(options) {
    for (let i = 0; i + 1 < options.length; i += 2) {
      if (options[i] === '--column') choices.columns.push(options[i + 1]);
      if (options[i] === '--failure') choices.failure = Number(options[i + 1]);
      if (options[i] === 'PRESET') choices.preset = options[i + 1];
    }
    return wearwell.attempt(() => wearwell.data.ofTable(guess));
  }

  // The role of a column, from its heading, as `wearwell new --column` states it. A study that no guess wrote says it in its text.
  async function setRole(role, heading, before) {
    if (place.roles.hidden || !table) throw new Error(strings.roleInText(heading));
    const kept = choices.columns, name = role || before;
    choices.columns = [...kept.filter((each) => !each.startsWith(`${name}=`) && !each.endsWith(`=${heading}`)), role ? `${role}=${heading}` : `${before}=`];
    try {
      await wearwell.data.ofTable(guess);
    } catch (error) {
      choices.columns = kept;
      await wearwell.data.ofTable(guess);
      throw error;
    }
  }

  function take(reading) {
    [questions, unread] = [reading.questions, false];
    replace(reading.text);
    generated = text();
    reasons(reading);
  }

  function reasons(reading) {
    const asked = reading.questions.map((question) => element('fieldset', {class: 'choices question'}, wearwell.programElement('legend', {}, question.text),
        ...question.readings.map((each) => wearwell.button(wearwell.ofProgram(each.text), () => choose(each.options), 'plain'))));
    const wantsLimit = [...reading.guesses, ...reading.unstated].some((each) => each.includes('--limit'));
    place.limit.hidden = !wantsLimit && choices.limit === undefined;
    place.reasons.replaceChildren(...[...asked, list(strings.guesses, reading.guesses), list(strings.unstated, reading.unstated), list(strings.taken, reading.taken)].filter(Boolean));
  }

  // Of wear: without it there is no life. A value that is refused leaves what was there.
  async function setLimit(value) {
    const before = choices.limit;
    choices.limit = value.trim() || undefined;
    try {
      await wearwell.data.ofTable(guess);
    } catch (error) {
      choices.limit = before;
      await wearwell.data.ofTable(guess);
      place.limit.hidden = false;
      throw error;
    }
  }

  async function guess() {
    roles();
    const of = table;
    let readings = [];
    try {
      ({readings} = await wearwell.post('/api/guess', {...wearwell.data.named(), ...choices, preset: undefined}));
    } catch (error) {
      if (error.status === 409 || of !== table) throw error;
      hideGuess();
      if (text() === generated) replace('');  // a study of another table
      place.roles.hidden = false;
      place.roles.open = true;
      throw error;
    }
    if (of !== table) return;
    // Of readings that fit equally well none is the first: the user chooses.
    const equal = readings.filter((each) => each.equal).length, chosen = readings.findIndex((each) => each.preset === choices.preset);
    const first = chosen >= 0 ? chosen : equal > 1 ? -1 : 0;
    place.readings.replaceChildren(element('legend', {}, strings.readings), ...readings.map((each, i) => {
      const input = element('input', {type: 'radio', name: 'reading', value: each.preset, id: `reading-${i}`, checked: i === first});
      input.addEventListener('change', () => { choices.preset = each.preset; take(each); });
      return element('label', {class: 'tick', for: `reading-${i}`}, input, element('span', {}, `${each.preset}: `, wearwell.programElement('span', {}, each.reading)), equal > 1 && each.equal ? element('small', {}, ` (${strings.equal})`) : null);
    }));
    place.readings.hidden = false;
    if (first >= 0) { take(readings[first]); return; }
    [questions, unread] = [[], true];
    place.reasons.replaceChildren(element('p', {class: 'wrong'}, strings.chooseReading));
    replace('');
    generated = '';
  }

  function roles() {
    place.roles.hidden = false;
    place.role.replaceChildren(...table.roles.map((each) => element('option', {value: each, lang: 'en'}, each)));
    place.column.replaceChildren(element('option', {value: ''}, strings.noColumn), ...(table.headings ?? table.columns.map((each) => each.name)).slice(0, 1000).map((each) => element('option', {value: each}, each)));
    place.chosen.replaceChildren(...(choices.columns.length ? [element('p', {}, `${strings.chosenRoles}: ${choices.columns.join('; ')} `),
        wearwell.button(strings.forget, () => { choices = {columns: []}; wearwell.attempt(() => wearwell.data.ofTable(guess)); }, 'plain')] : []));
  }

  function guessTable() {
    if (text() && isKept()) remember();
    generated = text();
    place.name.value = `${table.file.replace(/\.gz$/, '').replace(/\.[^.]*$/, '')}.toml`;
    [saved, savedName] = [null, ''];
    compare();
    return wearwell.data.ofTable(guess);
  }

  function tableOpened(next) {
    table = next;
    choices = {columns: []};
    document.getElementById('limit').value = '';
    place.empty.hidden = true;
    place.work.hidden = false;
    hideGuess();
    if (isKept()) compare(); else wearwell.quietly(guessTable);
  }

  function show(file, content) {
    if (isEdited()) remember();
    hideGuess();
    place.empty.hidden = true;
    place.work.hidden = false;
    place.name.value = file;
    const lines = content.replace(/\r\n?/g, '\n');  // as the editor has them; the file keeps its own
    [saved, savedName, generated, keptFor] = [lines, file, '', 0];
    place.text.value = lines;
    changed();
  }

  // Returns {file, text}: the file has this text. Also of a text that is saved: the file may have changed since.
  async function save() {
    place.note.textContent = '';
    if (unread) throw new Error(strings.chooseReading);
    if (questions.length) throw new Error(strings.openQuestion(wearwell.ofProgram(questions[0].text)));
    const content = text(), name = place.name.value, before = name === savedName ? saved : null;
    await wearwell.post('/api/save', {file: name, text: content, before});
    [saved, savedName] = [content, name];
    place.note.textContent = strings.saved(name);
    marks();
    return {file: name, text: content};
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
        wearwell.button(strings.setRole, () => choose(['--column', `${place.role.value}=${place.column.value}`]))));
    const limit = wearwell.field(strings.limit[0], 'limit', {placeholder: strings.limit[1]});
    place.limit = element('form', {class: 'fields', hidden: true}, limit, element('button', {class: 'plain'}, strings.setRole));
    place.limit.addEventListener('submit', (event) => { event.preventDefault(); wearwell.attempt(() => setLimit(limit.querySelector('input').value)); });
    form = wearwell.valuesForm(study);
    place.form = form.panel;
    formulas = wearwell.formulas();
    place.parts = [wearwell.priors(study), wearwell.families(study)];
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
    place.undo = wearwell.button(strings.undo, undo, 'plain');
    place.work = element('div', {class: 'two', hidden: true},
        element('div', {}, place.readings, place.limit, place.reasons, place.chosen, place.roles, element('h3', {}, strings.formTitle), place.form, ...place.parts.map((each) => each.panel)),
        element('div', {class: 'editing'}, element('h3', {}, element('label', {for: 'study'}, strings.editorLabel)),
            element('div', {class: 'editor'}, place.gutter, place.text), place.check, formulas.panel,
            element('div', {class: 'line'}, name, wearwell.button(strings.save, () => wearwell.attempt(save)), place.undo, place.state), place.note));
    panel.append(element('h2', {}, strings.modelTitle), place.empty, place.work);
    addEventListener('beforeunload', (event) => { if (isEdited() && !left) event.preventDefault(); });
  }

  // A page that is loaded again in another language goes on with the text that was edited.
  const draft = 'wearwell-draft';
  function leave() {
    if (!isEdited()) return;
    sessionStorage.setItem(draft, JSON.stringify({content: text(), name: place.name.value, saved, savedName}));
    left = true;
  }

  function resume() {
    const kept = JSON.parse(sessionStorage.getItem(draft));
    if (!kept) return;
    sessionStorage.removeItem(draft);
    show(kept.name, kept.content);
    [saved, savedName] = [kept.saved, kept.savedName];
    marks();
  }

  wearwell.model = {build, leave, study, setRole, becomes, resume, tableOpened, fileChanged, show, save, hasText: () => Boolean(text()), restore: async () => { const {file, text: content} = await wearwell.get('/api/study'); show(file, content); }};
})();
