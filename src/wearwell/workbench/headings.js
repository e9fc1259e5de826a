'use strict';
// Corrections of what was taken from the headings: by a click the line of the headings and that of the units, in its fields the unit and the role of a column.
(() => {
  const {element, strings} = wearwell;
  const near = 20;  // rows below the headings that can be headings or units themselves

  // Of Parquet and JSON the headings are no line. The rows of a wide table and of a query are not those of the file.
  const hasLines = (table) => !table.settings.sql && /\.(csv|tsv|txt|dat|asc|xlsx)(\.gz)?$/i.test(table.file) && !table.settings.range;

  // {panel, show(table), cell(row)}. `read(settings)` reads the table again.
  wearwell.headingLines = (read) => {
    let table = null;
    const choice = element('div', {}), first = element('details', {}), panel = element('div', {id: 'heading-lines'}, first, choice);

    function choose(line) {
      const with_ = (change) => wearwell.button(change.label, () => read({...table.settings, ...change.settings}), 'plain');
      const close = wearwell.button(strings.closeChoice, () => { choice.replaceChildren(); document.getElementById(`line-${line}`)?.focus(); }, 'plain');
      choice.replaceChildren(element('fieldset', {class: 'choices'}, element('legend', {}, strings.lineOf(line, table.file)),
          with_({label: strings.asHeadings, settings: {header_row: String(line), units_row: ''}}),
          line > 1 ? with_({label: strings.asUnits, settings: {header_row: String(line - 1), units_row: 'below'}}) : null,
          with_({label: strings.noUnits, settings: {units_row: 'none'}}), with_({label: strings.asFound, settings: {header_row: '', units_row: ''}}), close));
      choice.querySelector('button').focus();
    }

    function show(next) {
      table = next;
      choice.replaceChildren();
      const lines = hasLines(table) ? table.first_lines ?? [] : [];
      first.hidden = !lines.length;
      first.replaceChildren(element('summary', {}, strings.firstLines), element('p', {class: 'note'}, strings.chooseLine),
          element('ol', {class: 'lines'}, ...lines.map((each, i) => element('li', {}, wearwell.button(each || strings.emptyLabel, () => choose(i + 1), 'line-of-file')))));
    }

    // The number of a row; of one near the headings a button.
    function cell({row, line = row + 1}) {
      if (!hasLines(table) || table.wide || row > near || !line) return element('th', {scope: 'row'}, wearwell.count(row));
      const button = wearwell.button(wearwell.count(row), () => choose(line), 'row-number');
      button.setAttribute('aria-label', strings.rowChoice(wearwell.count(row)));
      button.id = `line-${line}`;
      return element('th', {scope: 'row'}, button);
    }
    return {panel, show, cell};
  };

  const study = () => wearwell.model.study;

  // The key of [data.columns] that names a heading.
  function columnKey(heading) {
    for (const {path, value, line} of study().readsTable() ? study().keys() : []) {
      const found = /^(data\.columns\.[^.]+?)(\.column)?$/.exec(path);
      if (found && value === heading) return {path: found[1], line};
    }
    return null;
  }
  const statedUnit = (key) => study().keys().find(({path}) => path === `${key?.path}.unit`)?.value;

  // The study with the unit of a column; the key keeps its line.
  async function withUnit(before, key, unit) {
    if (statedUnit(key) !== undefined && unit) return (await wearwell.post('/api/set', {text: before, path: `${key.path}.unit`, value: unit})).text;
    const lines = before.split('\n'), at = key.line - 1, quoted = JSON.stringify(unit);
    if (!unit) lines[at] = lines[at].replace(/,\s*unit\s*=\s*("[^"]*"|'[^']*')/, '');
    else if (/=\s*\{/.test(lines[at])) lines[at] = lines[at].replace(/(\bcolumn\s*=\s*("(?:[^"\\]|\\.)*"|'[^']*'))/, (found) => `${found}, unit = ${quoted}`);
    else lines[at] = lines[at].replace(/=\s*("(?:[^"\\]|\\.)*"|'[^']*')/, (_, name) => `= { column = ${name}, unit = ${quoted} }`);
    return lines.join('\n');
  }

  // A unit that does not fit leaves the study as it was.
  async function setUnit(heading, unit) {
    const key = columnKey(heading), before = study().text(), wasGood = study().isGood();
    if (!key) throw new Error(strings.unitWithoutRole(heading));
    const next = await withUnit(before, key, unit), found = await wearwell.post('/api/check', {...study().asked(), text: next});
    if (found.problem && (wasGood || found.line === key.line || found.problem.includes(`'${heading}'`))) throw new Error(found.problem);
    const stated = found.keys.find(({path}) => path === `${key.path}.unit`)?.value ?? '';
    if (before !== study().text() || stated !== unit) throw new Error(strings.unitInText(key.line));
    study().replace(next);
  }

  // The field with the unit of a column of numbers. The study states it; the table is as it was read.
  wearwell.unitField = (column, index, changed) => {
    const shown = () => statedUnit(columnKey(column.name)) ?? column.unit;
    const field = element('input', {id: `unit-${index}`, class: 'unit', size: 8, autocomplete: 'off', spellcheck: 'false', 'aria-label': strings.unitOf(column.name), placeholder: strings.noUnit, value: shown()});
    field.addEventListener('change', () => wearwell.attempt(async () => {
      const before = shown(), unit = field.value.trim();
      if (unit === before || (!unit && statedUnit(columnKey(column.name)) === undefined)) { field.value = before; return; }  // the heading states it
      try {
        await setUnit(column.name, unit);
        changed(column.name, unit);
      } catch (error) {
        field.value = before;
        throw error;
      }
    }));
    field.update = () => { if (field !== document.activeElement) field.value = shown(); };
    return field;
  };

  // How a study reads a column depends on its role: numbers in a unit, or names, also where the cells are digits.
  const roleOf = (heading) => /^data\.columns\.(.+)$/.exec(columnKey(heading)?.path ?? '')?.[1] ?? '';
  const isNames = (role, names) => names.includes(role) || study().keys().some(({path}) => path.startsWith(`random_effects.${role}.`) || path === `random_effects.${role}`);

  // {field, note}: the choice of a role, and what it makes of the cells. `changed(heading, role)` after a choice.
  wearwell.roleField = ({name, kind}, index, {roles, names}, changed) => {
    const note = element('small', {}), select = element('select', {id: `role-${index}`, class: 'role', autocomplete: 'off', 'aria-label': strings.roleOf(name)});
    let shown = null;

    function update() {
      const role = roleOf(name);
      note.textContent = !role ? strings.unusedColumn : isNames(role, names) ? strings.readAsNames : kind === 'number' ? strings.readAsNumbers : '';
      if (role === shown || select === document.activeElement) return;
      shown = role;
      const own = role && !roles.includes(role) ? [role] : [];
      select.replaceChildren(element('option', {value: ''}, strings.noRole), ...[...own, ...roles].map((each) => element('option', {value: each, lang: 'en', selected: each === role}, each)));
    }
    select.addEventListener('change', () => wearwell.attempt(async () => {
      const role = select.value, before = shown;
      shown = null;
      select.blur();
      try {
        await wearwell.model.setRole(role, name, before);
        changed(name, role || strings.noRole);
      } finally {
        update();
        select.focus();
      }
    }));
    update();
    return {field: Object.assign(select, {update}), note};
  };
})();
