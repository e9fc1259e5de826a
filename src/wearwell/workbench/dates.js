'use strict';
// Dates as a type of a column, chosen in its heading: the column becomes a time since another date.
(() => {
  const {element, strings} = wearwell;

  // "%d.%m.%Y" -> "day.month.year".
  const layoutName = (layout) => Object.entries(strings.dateParts).reduce((text, [part, word]) => text.replace(`%${part}`, word), layout);

  // The choice in the heading. `panel`: the one below.
  wearwell.dateType = (column, index, panel) => {
    const select = element('select', {id: `type-${index}`, class: 'role', autocomplete: 'off', 'aria-label': strings.typeOf(column.name)},
        element('option', {value: ''}, strings.asText), element('option', {value: 'dates'}, strings.asDates));
    select.addEventListener('change', () => { if (select.value) panel.ask(column, () => { select.value = ''; select.focus(); }); else panel.close(); });
    return select;
  };

  // {panel, ask(column, left), show(table), close()}. `read(dates)` reads the table again with the time that the dates state, `read(null)` as the file has it. The
  // program writes the query, and the study keeps it.
  wearwell.datePanel = (read) => {
    const place = element('div', {id: 'dates'});
    const choice = (label, id, options) => element('div', {class: 'field'}, element('label', {for: id}, label),
        element('select', {id, autocomplete: 'off'}, ...options.map(([value, text]) => element('option', {value}, text))));
    const close = () => place.replaceChildren();
    let table = null;

    function ask(column, left) {
      const others = table.columns.filter((each) => each !== column), dates = others.filter((each) => each.dates), groups = others.filter((each) => !each.dates).slice(0, 1000);
      const layouts = column.dates.map((each) => [each, layoutName(each)]);
      // Dates that can be read in two ways are read in neither until one is chosen.
      const layout = choice(strings.dateLayout, 'date-layout', layouts.length > 1 ? [['', strings.chooseLayout], ...layouts] : layouts);
      const since = choice(strings.timeSince, 'date-since', [...dates.map((each) => [`since ${each.name}`, each.name]), ['', strings.sinceFirst],
        ...groups.map((each) => [`unit ${each.name}`, strings.sinceFirstOf(each.name)])]);
      const until = wearwell.field(strings.inUseUntil(wearwell.count(column.empty)), 'date-until', {type: 'date'});
      const chosen = () => since.querySelector('select').value;
      const update = () => { until.hidden = !column.empty || !chosen().startsWith('since '); };
      since.addEventListener('change', update);
      const cancel = wearwell.button(strings.closeChoice, () => { close(); left(); }, 'plain');
      const form = element('form', {class: 'fields'}, layout, since, until, element('button', {}, strings.readTimes), cancel);
      form.addEventListener('submit', (event) => {
        event.preventDefault();
        const [kind, ...name] = chosen().split(' '), heading = name.join(' ');
        if (!layout.querySelector('select').value) { wearwell.quietly(() => { throw new Error(strings.chooseLayoutFirst(column.name)); }); return; }
        read({column: column.name, layout: layout.querySelector('select').value, since: kind === 'since' ? heading : '', unit: kind === 'unit' ? heading : '',
          until: until.hidden ? '' : until.querySelector('input').value});
      });
      place.replaceChildren(element('fieldset', {class: 'choices'}, element('legend', {}, strings.datesOf(column.name)), element('p', {class: 'note'}, strings.datesLead), form));
      update();
      form.querySelector('select').focus();
    }

    // A table that a query has made says so.
    function show(next) {
      table = next;
      close();
      if (!table.settings.sql) return;
      place.append(element('p', {class: 'note'}, strings.byQuery), wearwell.button(strings.withoutQuery, () => read(null), 'plain'));
    }
    return {panel: place, ask, show, close: () => show(table)};
  };
})();
