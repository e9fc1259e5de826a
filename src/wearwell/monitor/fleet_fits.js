'use strict';
// The fit that forecasts come from, and how it moved them when it took the place of another.
(() => {
  const {element, range, quantity, clock} = wearwell;
  const panel = document.getElementById('fits'), line = document.getElementById('fit-line'), table = document.getElementById('fit-table');
  const most = 100;
  let shown = '';

  const life = ({remaining}, unit) => (remaining ? `${quantity(remaining.q50, unit)} (${range(remaining.q05, remaining.q95, unit)})` : 'unknown');

  function row(each) {
    const alarm = each.before.alarm === each.after.alarm ? each.after.alarm : `${each.before.alarm} → ${each.after.alarm}`;
    return element('tr', {}, element('th', {scope: 'row'}, element('a', {href: `#unit=${encodeURIComponent(each.unit)}`}, each.unit)),
        element('td', {}, life(each.before, each.axis_unit)), element('td', {}, life(each.after, each.axis_unit)), element('td', {}, alarm));
  }

  async function load() {
    try {
      const {all, moved} = await wearwell.ask(`/api/v1/fits?count=${most}`);
      if (all === 0) {
        table.replaceChildren(element('p', {class: 'note'}, 'It has not taken the place of another fit while the monitor was running.'));
        return;
      }
      table.replaceChildren(
          element('p', {class: 'note'}, `Remaining useful life from the same readings, by the earlier fit and by this one: median and 90 %. ` +
                  `${all > most ? `The ${most} largest changes of ${wearwell.count(all)}.` : 'The largest change first.'}`),
          element('div', {class: 'scroll'}, element('table', {},
              element('thead', {}, element('tr', {}, ...['Unit', 'Before', 'After', 'Alarm'].map((each) => element('th', {scope: 'col'}, each)))),
              element('tbody', {}, ...moved.map(row)))));
    } catch (error) {
      table.replaceChildren(element('p', {class: 'wrong'}, error.message));
    }
  }

  panel.addEventListener('toggle', () => { if (panel.open) load(); });

  wearwell.fits = {
    refresh: ({fit}) => {
      const key = `${fit.fingerprint} ${fit.since_ms}`;
      if (key === shown) return;
      shown = key;
      panel.hidden = !fit.fingerprint;
      line.textContent = `Fit ${fit.fingerprint.slice(0, 7)}${fit.written_ms ? ` of ${clock(fit.written_ms)}` : ''}` +
                         `${fit.since_ms ? `, in use since ${clock(fit.since_ms)}` : ''}`;
      if (panel.open) load();
    },
    // How this unit's forecast moved; null if it did not.
    moved: ({moved}) => (moved ? element('p', {class: 'note'}, `By the earlier fit, when the present one came: remaining useful life ${life(moved.before, moved.axis_unit)}; ` +
                                 `by the present one: ${life(moved.after, moved.axis_unit)}.`) : null),
  };
})();
