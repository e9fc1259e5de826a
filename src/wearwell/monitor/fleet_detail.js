'use strict';
// One unit: its present state, its forecast, and the coverage of earlier forecasts.
(() => {
  const {element, given, quantity, range, probability, unit: words} = wearwell;
  const detail = document.getElementById('detail');
  let fleet = null, opened = '', serial = 0, waiting = null, shown = null, form = null, acknowledgement = null;

  const finite = (x) => typeof x === 'number' && Number.isFinite(x);
  const name = (what, unit) => (words(unit) ? `${wearwell.capital(what)} (${words(unit)})` : wearwell.capital(what));

  // Starts at 0 if that is near; clips values far beyond the rest.
  function domain(values) {
    const seen = values.filter(finite);
    if (seen.length === 0) return [0, 1];
    let low = Math.min(...seen), high = Math.max(...seen);
    if (low > 0 && low < 0.6 * high) low = 0;
    if (low === high) { low -= Math.abs(low) / 2 || 1; high += Math.abs(high) / 2 || 1; }
    return [low, high + 0.04 * (high - low)];
  }

  function pathFigure(view) {
    const points = view.path.map(({at, level}) => ({x: at, low: level.q05, y: level.q50, high: level.q95}));
    const read = view.moments.filter((each) => finite(each.measured)).map((each) => ({x: each.at, y: each.measured}));
    const split = points.findIndex((each) => each.x > view.at);
    const behind = split < 0 ? points : points.slice(0, split + 1), ahead = split < 0 ? [] : points.slice(Math.max(0, split - 1));
    // The interval of the life lies on the limit. A wedge leads there if there is no forecast band.
    const life = view.passed > 0.5 ? null : {low: view.at + view.remaining.q05, y: finite(view.remaining.q50) ? view.at + view.remaining.q50 : null,
                                            high: finite(view.remaining.q95) ? view.at + view.remaining.q95 : null};
    const far = life ? Math.min(life.high ?? Infinity, view.at + 3 * (view.remaining.q50 ?? view.remaining.q05 ?? 0)) : 0;
    const x = domain([...points.map((each) => each.x), ...read.map((each) => each.x), view.at]);
    // The forecast band up to the end of the life interval; all of it if the limit is never reached.
    const reach = finite(far) && far > view.at ? 1.04 * far : Infinity;
    x[1] = Math.max(view.at, finite(reach) && ahead.length < 3 ? reach : 0, ...points.map((each) => each.x).filter((each) => finite(each) && each <= Math.max(reach, view.at)), ...read.map((each) => each.x));
    const wedge = life && ahead.length < 3 && finite(life.low);
    const y = domain([1.15 * fleet.limit, ...behind.flatMap((each) => [each.low, each.high]), ...ahead.map((each) => each.low),
                      ...ahead.filter((each) => each.y < 1.3 * fleet.limit).map((each) => each.y), ...read.map((each) => each.y)]);
    const stops = points.filter((each) => finite(each.x) && each.x <= x[1]);
    return {
      id: 'path', title: `${wearwell.capital(fleet.limited)}, past and forecast`,
      description: `${wearwell.capital(fleet.limited)} along ${fleet.axis}: now ${range(view.level.q05, view.level.q95, fleet.level_unit)} (90 %), limit ${given(fleet.limit, fleet.level_unit)}. ${read.length} readings.`,
      x: {name: name(fleet.axis, fleet.axis_unit), domain: x}, y: {name: name(fleet.limited, fleet.level_unit), domain: y},
      marks: [
        {kind: 'band', look: 'behind', points: behind}, {kind: 'band', look: 'ahead', points: ahead},
        {kind: 'line', look: 'behind', points: behind}, {kind: 'line', look: 'ahead', points: ahead},
        ...(wedge ? [{kind: 'wedge', look: 'ahead', from: [view.at, view.level.q50], to: [life.low, life.high ?? 2 * x[1], fleet.limit]}] : []),
        ...(wedge && finite(life.y) ? [{kind: 'line', look: 'ahead', points: [{x: view.at, y: view.level.q50}, {x: life.y, y: fleet.limit}]}] : []),
        {kind: 'rule', look: 'limit', y: fleet.limit, word: `limit ${given(fleet.limit, fleet.level_unit)}`},
        {kind: 'rule', look: 'now', x: view.at, word: 'now', low: true},
        ...(life && finite(life.low) ? [{kind: 'span', look: 'life', y: fleet.limit, low: life.low, high: life.high ?? 2 * x[1], middle: life.y}] : []),
        {kind: 'points', look: 'reading', points: read}],
      at: stops.map((each) => each.x), start: Math.max(0, split - 1),
      read: (i) => `At ${quantity(stops[i].x, fleet.axis_unit)}: ${fleet.limited} ${quantity(stops[i].y, fleet.level_unit)}, 90 % within ${range(stops[i].low, stops[i].high, fleet.level_unit)}`,
      hint: 'Point at it, or use the arrow keys, to read values.',
      legend: [['reading', 'readings'], ['behind', 'median and 90 %, past'], ...(life ? [['life', 'time of reaching the limit, 90 %']] : []), ...(ahead.length < 3 ? [] : [['ahead', 'median and 90 %, forecast']])],
    };
  }

  function survivalFigure(view) {
    const points = view.survival.filter((each) => finite(each.remaining)).map((each) => ({x: each.remaining, low: 0, y: each.survival, high: each.survival}));
    const end = Math.max(...points.map((each) => each.x), 0) || 1;
    const marks = [{kind: 'band', look: 'behind', points}, {kind: 'line', look: 'behind', points}];
    if (fleet.horizon < end) marks.push({kind: 'rule', look: 'horizon', x: fleet.horizon, word: `horizon ${given(fleet.horizon, fleet.axis_unit)}`});
    return {
      id: 'survival', title: 'Remaining useful life',
      description: `Probability of not reaching the limit, by remaining useful life: median ${quantity(view.remaining.q50, fleet.axis_unit)}, 90 % within ${range(view.remaining.q05, view.remaining.q95, fleet.axis_unit)}.`,
      x: {name: `Remaining useful life (${words(fleet.axis_unit) || fleet.axis})`, domain: [0, end]},
      y: {name: 'Probability of lasting longer', domain: [0, 1], percent: true}, marks,
      at: points.map((each) => each.x), start: 0,
      read: (i) => `${probability(points[i].y)} last longer than ${quantity(points[i].x, fleet.axis_unit)}`,
      hint: 'Point at it, or use the arrow keys, to read values.',
      legend: [['behind', 'probability'], ['horizon', 'horizon of the risk']],
    };
  }

  function historyFigure(view) {
    const moments = view.moments.filter((each) => finite(each.at)).sort((a, b) => a.at - b.at);
    const points = moments.map(({at, life}) => ({x: at, low: life.q05, y: life.q50, high: life.q95}));
    const last = points.at(-1), x = [0, Math.max(last?.x ?? 1, 1e-300)];
    const later = points.slice(Math.floor(points.length / 4));
    const top = Math.max(...later.map((each) => each.high).filter(finite), finite(last?.y) ? 1.2 * last.y : 0, x[1]);
    const y = [0, finite(last?.y) ? Math.min(top, 4 * Math.max(last.y, x[1])) : top];
    return {
      id: 'history', title: 'Earlier forecasts',
      description: `Predicted life at ${points.length} times, with 90 % intervals. Last: ${range(view.moments.at(-1)?.life.q05 ?? null, view.moments.at(-1)?.life.q95 ?? null, fleet.axis_unit)}.`,
      x: {name: `Forecast at ${name(fleet.axis, fleet.axis_unit).toLowerCase().replace(/\((.*)\)/, () => `(${words(fleet.axis_unit)})`)}`, domain: x},
      y: {name: `Predicted life (${words(fleet.axis_unit) || fleet.axis})`, domain: y},
      marks: [{kind: 'band', look: 'forecast', points}, {kind: 'line', look: 'forecast', points},
              {kind: 'line', look: 'age', points: [{x: 0, y: 0}, {x: x[1], y: x[1]}]}],
      at: points.map((each) => each.x), start: points.length - 1,
      read: (i) => `At ${quantity(points[i].x, fleet.axis_unit)} the predicted life was ${quantity(points[i].y, fleet.axis_unit)}, 90 % within ${range(points[i].low, points[i].high, fleet.axis_unit)} (${wearwell.clock(moments[i].time_ms)})`,
      hint: 'If forecasts are correct, the band narrows around one life.',
      legend: [['forecast', 'median and 90 % of the life'], ['age', 'age at that time']],
    };
  }

  // P(X <= k) for n forecasts with a coverage of 0.9 each.
  function binomial(k, n) {
    let sum = 0, logarithm = n * Math.log(0.1);
    for (let i = 0; i <= k; ++i) {
      sum += Math.exp(logarithm);
      logarithm += Math.log((n - i) / (i + 1)) + Math.log(9);
    }
    return sum;
  }

  function tally({judged, held}) {
    if (!judged) return element('p', {class: 'tally'}, 'No forecast has been compared with a reading yet.');
    const low = binomial(held, judged) < 0.01;
    const text = `Of ${wearwell.count(judged)} earlier forecasts of the next reading, ${wearwell.count(held)} covered it with their 90 % interval; ` +
                 `about ${wearwell.count(Math.round(0.9 * judged))} are expected.`;
    return element('p', {class: low ? 'tally callout warn' : 'tally'}, low ? element('strong', {}, 'Fewer than expected by chance. ') : null, text);
  }

  const tile = (what, value, note) => element('div', {}, element('dt', {}, what), element('dd', {class: 'value'}, value), element('dd', {class: 'note'}, note));

  function lead(view) {
    if (view.service !== 'in service') return element('p', {class: 'lead'}, `This ${fleet.noun} is out of service: ${view.service}. Below is what was known when it was last in use.`);
    if (!view.known) return element('p', {class: 'lead'}, `There is no forecast for this ${fleet.noun} yet: its readings do not determine how it continues.`);
    const sure = view.passed > 0.5 ? `This ${fleet.noun} has already reached its limit of ${given(fleet.limit, fleet.level_unit)} with probability ${probability(view.passed)}.`
                                   : `This ${fleet.noun} reaches its limit of ${given(fleet.limit, fleet.level_unit)} within the next ${given(fleet.horizon, fleet.axis_unit)} with probability ${probability(view.risk)}.`;
    return element('p', {class: 'lead'}, sure);
  }

  // Reasons to believe the readings before the forecast.
  function warnings(view) {
    const all = [];
    const say = (kind, word, text) => all.push(element('p', {class: `callout ${kind}`}, element('strong', {}, `${word} `), text));
    if (view.beyond) say('fail', 'Beyond the limit.', `The last reading is beyond the limit of ${given(fleet.limit, fleet.level_unit)}, whatever the forecast.`);
    const change = view.rate_change;
    if (change && change.probability > 0.5) {
      say('doubt', 'The rate has probably changed.', `Probability ${probability(change.probability)}: since ${range(change.since.q05, change.since.q95, fleet.axis_unit)} it is ${wearwell.number(change.factor.q05)} to ${wearwell.number(change.factor.q95)} times the earlier rate (90 %). The forecast below takes it into account.`);
    }
    if (view.doubt) say('doubt', 'Forecast in doubt.', `${wearwell.capital(view.doubt)}. Level, remaining useful life and risk below rest on a ${fleet.noun} that ${change ? 'changes its rate at most once' : 'does not change'}.`);
    return all;
  }

  function tiles(view) {
    const last = view.last_reading_ms;
    if (!view.known) return element('dl', {class: 'tiles'}, tile('Last reading', last ? `${wearwell.age(wearwell.now() - last)} ago` : 'none', last ? wearwell.clock(last) : 'none yet'));
    return element('dl', {class: 'tiles'},
        tile('Remaining useful life', quantity(view.remaining.q50, fleet.axis_unit), `90 %: ${range(view.remaining.q05, view.remaining.q95, fleet.axis_unit)}${view.passed > 0.01 ? '; if the limit is not reached yet' : ''}`),
        tile('B10', quantity(view.b10, fleet.axis_unit), '90 % last longer'),
        tile(`${wearwell.capital(fleet.limited)} now`, quantity(view.level.q50, fleet.level_unit),
             view.level.q05 === view.level.q95 ? `limit: ${given(fleet.limit, fleet.level_unit)}` : `90 %: ${range(view.level.q05, view.level.q95, fleet.level_unit)}`),
        tile('Last reading', last ? `${wearwell.age(wearwell.now() - last)} ago` : 'none', last ? `at ${quantity(view.at, fleet.axis_unit)}, ${wearwell.clock(last)}` : 'the values are those of the population'));
  }

  function quality({readings, repeated, late, contradicting, refused, last_problem: problem}) {
    const fact = (what, count, poor) => element('div', {class: poor && count > 0 ? 'poor' : ''}, element('dt', {}, what), element('dd', {}, wearwell.count(count)));
    return element('section', {class: 'quality'}, element('h3', {}, 'Data quality'),
        element('dl', {class: 'facts'}, fact('counted', readings), fact('repeated', repeated), fact('late', late),
                fact('contradicting', contradicting, true), fact('refused', refused, true)),
        problem ? element('p', {class: 'problem'}, `Last problem: ${problem}`) : null);
  }

  function head(view) {
    return element('div', {class: 'head'},
        element('a', {class: 'back', href: '#'}, '← Fleet'),
        element('div', {class: 'named'}, element('h2', {id: 'unit-name'}, view.unit), wearwell.badge(view.alarm, wearwell.stateOf(view)), view.part > 1 ? element('span', {class: 'note'}, `part ${view.part}`) : null),
        ...warnings(view), lead(view), tiles(view), wearwell.fits.moved(view));
  }

  // A plot stays while the user reads it, and a form while it is filled in; the values above are updated.
  const busy = () => detail.querySelector('svg.plot:hover, svg.plot:focus, .event-form input:focus, .event-form select:focus') !== null;

  function figures(view) {
    if (!view.known) return element('div', {class: 'figures'});
    const room = detail.clientWidth - 2 * parseFloat(getComputedStyle(detail).paddingLeft);
    const half = room > 860 ? (room - 28) / 2 : room;
    const made = element('div', {class: 'figures'}, wearwell.plot(pathFigure(view), room));
    if (view.survival.length > 1) made.append(wearwell.plot(survivalFigure(view), half));
    if (view.moments.length > 1) made.append(wearwell.plot(historyFigure(view), half));
    return made;
  }

  function draw(view) {
    shown = view;
    const same = detail.dataset.unit === view.unit;
    const old = detail.querySelector('.figures');
    const keep = same && old && busy();
    if (keep) {
      waiting = view;
      detail.querySelector('.head').replaceWith(head(view));
      return;
    }
    waiting = null;
    const focused = document.activeElement?.closest?.('figure')?.id;
    if (!same || !form) {
      form = wearwell.eventForm(fleet, () => shown, load);
      acknowledgement = wearwell.acknowledgement(() => shown, load);
    }
    acknowledgement.update(view);
    detail.dataset.unit = view.unit;
    detail.replaceChildren(head(view), acknowledgement.element, figures(view), tally(view.forecasts), wearwell.eventSection(fleet, view, form), quality(view.quality));
    if (same && focused) document.querySelector(`#${focused} svg`)?.focus({preventScroll: true});
    if (!same) detail.scrollTop = 0;
  }

  async function load() {
    const mine = ++serial, unit = opened;
    try {
      const view = await wearwell.ask(`/api/v1/units/${encodeURIComponent(unit)}`);
      if (mine === serial) draw(view);
    } catch (error) {
      if (mine !== serial) return;
      delete detail.dataset.unit;
      detail.replaceChildren(element('a', {class: 'back', href: '#'}, '← Fleet'), element('h2', {id: 'unit-name'}, unit), element('p', {class: 'callout warn', role: 'alert'}, error.message));
    }
  }

  setInterval(() => { if (waiting && !busy()) draw(waiting); }, 500);
  let width = 0;
  new ResizeObserver(() => {
    if (detail.clientWidth === width) return;
    width = detail.clientWidth;
    if (opened && detail.dataset.unit === opened && width > 0) load();
  }).observe(detail);

  wearwell.detail = {
    open: (view, unit) => {
      fleet = view;
      opened = unit;
      waiting = null;
      return load();
    },
    close: () => {
      opened = '';
      ++serial;
      delete detail.dataset.unit;
      detail.replaceChildren(element('h2', {id: 'unit-name', class: 'none'}, `No ${fleet?.noun ?? 'unit'} is selected.`));
    },
    refresh: (view) => {
      fleet = view;
      if (opened) load();
    },
    opened: () => opened,
  };
})();
