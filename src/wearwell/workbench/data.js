'use strict';
// The step Data: choose a table, look at it as it was read, plot its columns.
(() => {
  const {element, strings} = wearwell;
  const atOnce = 50, columnsAtOnce = 20;
  let table = null, from = 0, fromColumn = 0, opening = 0, announced = 0, drawnIn = 0, headings = {};
  const place = {};

  async function opened(answer) {
    if (answer.kind === 'sheets') return sheets(answer);
    if (answer.kind === 'table') await show(answer.table);
    if (answer.kind === 'reading') place.reading.began(answer);
    if (answer.kind === 'study') { wearwell.model.show(answer.study.file, answer.study.text); wearwell.step('model'); }
    if (answer.kind === 'result') { wearwell.step('fit'); wearwell.fit.result(); }
    return undefined;
  }

  // What a request about the table names: another page may have opened another one meanwhile.
  const named = () => ({file: table.file, number: table.number});

  async function reload() {
    const before = table;
    await show(await wearwell.get('/api/table'));
    place.moved.textContent = before && before.number !== table.number && !place.reading.isOwn(table.number) ? strings.otherPage(table.file) : '';
  }

  // Of a table that is not open any more the page shows nothing further.
  async function ofTable(act) {
    try {
      return await act();
    } catch (error) {
      if (error.status !== 409) throw error;
      await reload();
      return undefined;
    }
  }

  // While this page opens a file, events about it are its own.
  const opens = (act) => wearwell.attempt(async () => {
    opening += 1;
    place.moved.textContent = '';
    try {
      await opened(await act());
    } finally {
      opening -= 1;
      catchUp();
    }
  });
  function catchUp() { if (!opening && announced > (table?.number ?? 0)) wearwell.quietly(reload); }

  // The latest file that this page wants open.
  let wish = null;
  const begin = (next, ask) => opens(async () => {
    wish = next;
    place.refused.replaceChildren();
    try {
      return await ask();
    } catch (error) {
      if (error.status === 400) refused();
      throw error;
    }
  });
  const open = (file, settings = {}) => begin({file, settings, again: (wanted) => open(file, wanted)}, () => wearwell.post('/api/open', {file, settings}));
  const upload = (file, settings = {}) => begin({file: file.name, settings, again: (wanted) => upload(file, wanted)}, () => wearwell.upload(file, settings));

  // A table that is not read as it is stored may be read once it is stated how.
  function refused() {
    if (!/\.(csv|tsv|txt|dat|asc|json|ndjson|jsonl|gz|parquet|xlsx)$/i.test(wish.file)) return;
    place.refused.replaceChildren(element('details', {open: true}, element('summary', {}, `${wish.file}: ${strings.stored}`), storedForm('refused', wish.settings, wish.again)));
  }

  // A table that has been read is announced by its number.
  function ended({state, file, sheets: names, problem}) {
    if (state === 'sheets') sheets({file, sheets: names});
    if (state === 'stopped') place.moved.textContent = strings.readingStopped(file);
    if (state === 'failed' && wish?.file === file) refused();
    if (state === 'failed') wearwell.quietly(() => { throw new Error(problem); });
  }

  // The time that dates state; without them the columns of the file.
  const readDates = (dates) => opens(() => wearwell.post('/api/table', dates ? {...named(), dates} : {...named(), settings: {...table.settings, sql: ''}}));
  const readWith = (wanted) => opens(() => wearwell.post('/api/table', {...named(), settings: wanted}));

  function sheets({file, sheets: names}) {
    place.sheets.replaceChildren(element('fieldset', {class: 'choices'}, element('legend', {}, strings.sheetTitle(file)),
        ...names.map((name) => wearwell.button(name, () => open(file, {sheet: name}), 'plain'))));
    place.sheets.querySelector('button')?.focus();
  }

  function head(column, index) {
    const isNumber = column.kind === 'number' || column.refused !== undefined, notes = [strings.kinds[column.kind], isNumber ? '' : wearwell.unit(column.unit)];
    if (column.empty) notes.push(strings.empty(column.empty));
    const role = table.wide ? {} : wearwell.roleField(column, index, table, (name, chosen) => { place.moved.textContent = strings.roleChanged(name, chosen); });
    return element('th', {scope: 'col', 'data-column': index}, element('span', {}, column.name), element('small', {}, notes.filter(Boolean).join(', ')), role.field, role.note,
        column.dates ? wearwell.dateType(column, index, place.dates) : null,
        isNumber ? wearwell.unitField(column, index, (name, unit) => { place.moved.textContent = strings.unitChanged(name, unit || strings.noUnit); }) : null,
        column.refused ? element('small', {class: 'bad'}, strings.refused(column.refused)) : null,
        column.doubt ? element('small', {class: 'bad'}, column.doubt) : null);
  }

  function cell(value, refusal, index) {
    const number = table.columns[index].kind === 'number';
    const text = value === null ? '' : String(value);  // all digits
    const made = element('td', {class: `${number || text.length < 25 ? 'short' : ''}${number ? ' number' : ''}${refusal ? ' refused' : ''}`}, text);
    if (refusal) made.append(element('small', {}, `${strings.refusedCell}: ${wearwell.ofProgram(refusal)}`));
    return made;
  }

  async function rows() {
    const asked = table, columns = asked.columns.slice(fromColumn, fromColumn + columnsAtOnce);
    const {rows: found} = await wearwell.get('/api/rows', {...named(), from, count: atOnce, from_column: fromColumn, columns: columnsAtOnce});
    if (asked !== table) return;
    const body = element('tbody', {}, ...found.map((each) => element('tr', {}, place.lines.cell(each),
        ...each.cells.map((value, i) => cell(value, each.refused?.[fromColumn + i], fromColumn + i)))));
    // Other rows keep the headings.
    if (headings.of === asked && headings.from === fromColumn) place.grid.tBodies[0].replaceWith(body);
    else {
      place.grid.replaceChildren(element('caption', {}, strings.tableCaption(table.file, wearwell.count(table.rows), wearwell.count(table.columns.length))),
          element('thead', {}, element('tr', {}, element('th', {scope: 'col'}, strings.row), ...columns.map((each, i) => head(each, fromColumn + i)))), body);
      headings = {of: asked, from: fromColumn};
    }
    place.rowsShown.textContent = strings.rowsShown(wearwell.count(from + 1), wearwell.count(from + found.length), wearwell.count(table.rows));
    place.later.disabled = false;
    wearwell.disable(place.earlier, from === 0, place.later);
    wearwell.disable(place.later, from + atOnce >= table.rows, place.earlier);
    place.columnPager.hidden = table.columns.length <= columnsAtOnce;
    place.columnsShown.textContent = strings.columnsShown(fromColumn + 1, fromColumn + columns.length, table.columns.length);
    place.laterColumns.disabled = false;
    wearwell.disable(place.earlierColumns, fromColumn === 0, place.laterColumns);
    wearwell.disable(place.laterColumns, fromColumn + columnsAtOnce >= table.columns.length, place.earlierColumns);
  }

  const move = (rowsBy, columnsBy) => wearwell.attempt(() => {
    from = Math.min(Math.max(0, from + rowsBy), Math.max(0, table.rows - 1));
    fromColumn = Math.min(Math.max(0, fromColumn + columnsBy), table.columns.length - 1);
    return ofTable(rows);
  });

  // How a file stores its table, in fields.
  function storedForm(id, known, read) {
    const make = (key) => (key === 'sql' ? wearwell.area : wearwell.field);
    const inputs = Object.entries(strings.settings).map(([key, label]) => [key, make(key)(label, `${id}-${key}`, {value: known[key] ?? ''})]);
    const form = element('form', {class: 'fields'}, ...inputs.map(([, field]) => field), element('button', {}, strings.apply));
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      const wanted = {};
      for (const [key, field] of inputs) { const {value} = field.querySelector('input, textarea'); if (value) wanted[key] = value; }
      read(wanted);
    });
    return form;
  }

  const settings = () => place.settings.replaceChildren(element('summary', {}, strings.stored), element('p', {lang: 'en'}, table.layout), storedForm('setting', table.settings, readWith));

  // The axis on which a run-out would have gone on.
  const isLife = (column) => column && /^(ms|s|min|k?h|hours?|d|days?|weeks?|months?|years?|m?cycles?|rev|revolutions?|km|miles?)$/i.test(column.unit);
  const labelled = ({text, runout}) => ({runout, text: text || strings.emptyLabel});

  async function plot() {
    const x = place.x.value, y = Number(place.y.value), by = place.by.value;
    const log = [place.logX.checked, place.logY.checked], asked = table;
    const found = await wearwell.get('/api/plot', {...named(), ...(x === '' ? {} : {x}), ...(by === '' ? {} : {by}), y, log_x: Number(log[0]), log_y: Number(log[1])});
    if (asked !== table) return;
    drawnIn = place.plot.clientWidth;
    const names = [x === '' ? strings.rowNumber : table.columns[x].name, table.columns[y].name];
    const kept = wearwell.count(found.kept), notes = [found.shown < found.kept ? strings.pointsDrawn(kept, wearwell.count(found.shown)) : strings.rowsDrawn(wearwell.count(found.rows), kept)];
    if (found.left_out.empty) notes.push(strings.leftEmpty(wearwell.count(found.left_out.empty)));
    if (found.left_out.not_positive) notes.push(strings.leftNegative(wearwell.count(found.left_out.not_positive)));
    place.plot.replaceChildren(wearwell.scatter({
      points: found.points, labels: found.labels.map(labelled), others: strings.otherLabels, lifeUp: !isLife(table.columns[x]) && isLife(table.columns[y]), x: {name: names[0], log: log[0]}, y: {name: names[1], log: log[1]},
      description: strings.plotDescription(names[1], names[0]), hint: strings.plotHint,
      read: ([a, b, row, label]) => [strings.point(wearwell.count(row), wearwell.given(a), wearwell.given(b)), by === '' ? '' : found.labels[label]?.text ?? strings.otherLabels].filter(Boolean).join(', '),
    }, Math.min(760, Math.max(280, drawnIn || 600))), element('p', {class: 'note'}, notes.join(' ')));
  }

  function plotChoices() {
    const numbers = table.columns.map((each, i) => [each, i]).filter(([each]) => each.kind === 'number' || each.refused !== undefined);
    place.plotting.hidden = numbers.length === 0;
    if (!numbers.length) return;
    const options = () => numbers.slice(0, 1000).map(([each, i]) => element('option', {value: i}, each.name));
    place.x.replaceChildren(...options(), element('option', {value: ''}, strings.rowNumber));
    place.y.replaceChildren(...options());
    place.by.replaceChildren(element('option', {value: ''}, strings.noColour), ...table.columns.slice(0, 1000).map((each, i) => element('option', {value: i}, each.name)));
    place.x.selectedIndex = numbers.length > 1 ? 0 : 1;
    place.y.selectedIndex = Math.min(1, numbers.length - 1);
    wearwell.quietly(() => ofTable(plot));
  }

  async function show(next) {
    table = next;
    [from, fromColumn] = [0, 0];
    place.sheets.replaceChildren();
    place.refused.replaceChildren();
    place.table.hidden = false;
    place.wide.hidden = !table.wide;
    place.wide.textContent = table.wide ? `${wearwell.capital(wearwell.ofProgram(table.wide))}.` : '';
    settings();
    place.lines.show(table);
    place.dates.show(table);
    await rows();
    if (table !== next) return;
    plotChoices();
    wearwell.model.tableOpened(table);
  }

  function build(panel) {
    place.file = element('input', {type: 'file', id: 'choose', accept: '.csv,.tsv,.txt,.dat,.asc,.json,.ndjson,.jsonl,.gz,.parquet,.xlsx'});
    place.file.addEventListener('change', () => { if (place.file.files.length) upload(place.file.files[0]); });
    place.list = element('select', {id: 'in-folder'});
    place.openButton = wearwell.button(strings.open, () => open(place.list.value));
    const drop = element('div', {class: 'drop'}, element('label', {for: 'choose'}, strings.chooseFile), place.file, element('p', {}, strings.dropHere));
    drop.addEventListener('dragover', (event) => { event.preventDefault(); drop.classList.add('over'); });
    drop.addEventListener('dragleave', () => drop.classList.remove('over'));
    drop.addEventListener('drop', (event) => {
      event.preventDefault();
      drop.classList.remove('over');
      if (event.dataTransfer.files.length) upload(event.dataTransfer.files[0]);
    });
    place.sheets = element('div', {});
    place.refused = element('div', {id: 'refused'});
    place.reading = wearwell.reading(ended);
    place.lines = wearwell.headingLines(readWith);
    place.dates = wearwell.datePanel(readDates);
    place.grid = element('table', {});
    place.settings = element('details', {});
    place.rowsShown = element('p', {role: 'status'});
    place.earlier = wearwell.button(strings.earlier, () => move(-atOnce, 0), 'plain');
    place.later = wearwell.button(strings.later, () => move(atOnce, 0), 'plain');
    const go = wearwell.field(strings.goRow, 'go-row', {type: 'number', min: 1});
    go.querySelector('input').addEventListener('change', (event) => move(Number(event.target.value || 1) - 1 - from, 0));
    place.columnsShown = element('p', {role: 'status'});
    place.earlierColumns = wearwell.button(strings.earlierColumns, () => move(0, -columnsAtOnce), 'plain');
    place.laterColumns = wearwell.button(strings.laterColumns, () => move(0, columnsAtOnce), 'plain');
    place.columnPager = element('div', {class: 'pager'}, place.earlierColumns, place.columnsShown, place.laterColumns);
    place.x = element('select', {id: 'plot-x'});
    place.y = element('select', {id: 'plot-y'});
    place.by = element('select', {id: 'plot-by'});
    place.logX = element('input', {type: 'checkbox', id: 'log-x'});
    place.logY = element('input', {type: 'checkbox', id: 'log-y'});
    for (const each of [place.x, place.y, place.by, place.logX, place.logY]) each.addEventListener('change', () => wearwell.attempt(() => ofTable(plot)));
    const axis = (label, select, log) => element('div', {class: 'field'}, element('label', {for: select.id}, label), select,
        element('label', {class: 'tick', for: log.id}, log, strings.log));
    place.plot = element('div', {class: 'picture'});
    place.plotting = element('div', {hidden: true}, element('h3', {}, strings.plotTitle), element('div', {class: 'fields'}, axis(strings.up, place.y, place.logY), axis(strings.across, place.x, place.logX),
        element('div', {class: 'field'}, element('label', {for: 'plot-by'}, strings.colourBy), place.by)), place.plot);
    place.moved = element('p', {class: 'note', role: 'status'});
    place.wide = element('p', {class: 'note', hidden: true});
    place.table = element('div', {hidden: true}, place.wide, place.settings, place.lines.panel, place.dates.panel, element('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': strings.dataTitle}, place.grid),
        element('div', {class: 'pager'}, place.earlier, place.rowsShown, place.later, go), place.columnPager, place.plotting);
    panel.append(element('h2', {}, strings.dataTitle),
        element('div', {class: 'doors'}, drop, element('div', {class: 'field'}, element('label', {for: 'in-folder'}, strings.inFolder),
            element('div', {class: 'line'}, place.list, place.openButton))), place.sheets, place.refused, place.moved, place.reading.panel, place.table);
  }

  function files(all) {
    const chosen = place.list.value;
    const groups = ['tables', 'studies', 'results'].filter((kind) => all[kind].length).map((kind) =>
        element('optgroup', {label: strings[kind]}, ...all[kind].map((name) => element('option', {value: name}, name))));
    place.list.replaceChildren(...(groups.length ? groups : [element('option', {value: ''}, strings.nothingHere)]));
    place.openButton.disabled = !groups.length;
    if ([...place.list.options].some((each) => each.value === chosen)) place.list.value = chosen;
  }

  // Nothing is opened where the folder has no such table.
  const has = (file) => [...place.list.options].some((each) => each.value === file);
  const openNamed = (file, settings) => (has(file) ? open(file, settings) : undefined);

  // Another page has opened another table.
  function session(now) {
    place.reading.session(now);
    announced = now.table_number;
    if (table?.number === now.table_number) wearwell.model.fileChanged(now.table_changed);
    catchUp();
  }

  // The study states other units and roles, or none.
  const unitsChanged = () => place.grid.querySelectorAll('input, select').forEach((each) => each.update?.());

  // A page that is opened again shows what the program has open.
  wearwell.data = {build, files, session, has, open, openNamed, ofTable, named, unitsChanged, restore: reload, redraw: () => { if (table && !place.plotting.hidden && drawnIn !== place.plot.clientWidth) wearwell.quietly(() => ofTable(plot)); }};
})();
