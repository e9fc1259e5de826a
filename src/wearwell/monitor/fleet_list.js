'use strict';
// The fleet by risk. Only visible rows are elements, and only visible pages are requested, so that a
// thousand units cost as little as twenty.
(() => {
  const {element} = wearwell;
  const page = 60;
  const list = document.getElementById('list'), rows = document.getElementById('rows');
  const search = document.getElementById('search'), found = document.getElementById('found');
  const phone = matchMedia('(max-width: 700px)');
  let fleet = null, total = 0, active = -1, opened = '', serial = 0, touched = 0, pending = 0;
  let pages = new Map();  // number of the page -> its units

  const height = () => (phone.matches ? 74 : 46);
  const unit = (i) => pages.get(Math.floor(i / page))?.[i % page];
  const path = (number) => `/api/v1/units?search=${encodeURIComponent(search.value)}&offset=${number * page}&count=${page}`;

  // Position of a life relative to the horizon: the horizon in the middle, infinity at the right.
  const place = (x) => (x === null ? 100 : 100 * Math.max(0, x) / (Math.max(0, x) + fleet.horizon || 1));

  function interval(remaining) {
    const bar = element('span', {class: 'interval', 'aria-hidden': 'true'});
    const add = (name, left, right) => {
      const part = element('span', {class: name});
      part.style.left = `${left}%`;
      if (right !== undefined) part.style.width = `${Math.max(1.5, right - left)}%`;
      bar.append(part);
    };
    add('spread', place(remaining.q05), place(remaining.q95));
    add('horizon', 50);
    add('median', place(remaining.q50));
    return bar;
  }

  function cells(each) {
    const risk = element('span', {class: 'meter', 'aria-hidden': 'true'}, element('span', {}));
    risk.firstChild.style.width = `${100 * (each.risk ?? 0)}%`;
    // The remaining life given that the limit is not reached is irrelevant if it most likely is.
    const past = each.passed > 0.5 || each.beyond;
    const life = each.beyond ? 'beyond the limit'
                 : past ? `limit reached${each.passed > 0.99 ? '' : `, ${wearwell.probability(each.passed)}`}`
                 : each.doubt ? 'forecast in doubt'
                 : !each.known ? 'unknown'
                      : wearwell.range(each.remaining.q05, each.remaining.q95, fleet.axis_unit);
    return [
      wearwell.badge(each.alarm, wearwell.stateOf(each)),
      element('span', {class: 'name'}, each.unit, each.acknowledged_by ? element('span', {class: 'note'}, ` acknowledged: ${each.acknowledged_by}`) : null),
      element('span', {class: 'risk'}, element('span', {class: 'unseen'}, 'risk '), each.known ? risk : null, each.known ? wearwell.probability(each.risk) : '–'),
      element('span', {class: past ? 'life past' : 'life'}, past || !each.known || each.doubt ? null : interval(each.remaining),
              element('span', {class: 'unseen'}, 'remaining useful life '), element('span', {class: 'range'}, life)),
      element('span', {class: 'age'}, element('span', {class: 'unseen'}, 'last reading '),
              each.last_reading_ms ? wearwell.age(wearwell.now() - each.last_reading_ms) : 'none')];
  }

  // Rows keep their elements: a row that is recreated while the pointer is down
  // would not receive the click.
  const made = new Map();
  function row(i) {
    const each = unit(i);
    if (!made.has(i)) made.set(i, element('div', {class: 'row', role: 'option', id: `row-${i}`}));
    const shown = made.get(i);
    shown.setAttribute('aria-setsize', total);
    shown.setAttribute('aria-posinset', i + 1);
    shown.setAttribute('aria-selected', String(Boolean(each && each.unit === opened)));
    shown.style.top = `${i * height()}px`;
    shown.style.height = `${height()}px`;
    shown.classList.toggle('active', i === active);
    shown.title = each?.unit ?? '';
    shown.dataset.unit = each?.unit ?? '';
    shown.replaceChildren(...(each ? cells(each) : ['…']));
    return shown;
  }

  function visible() {
    const first = Math.max(0, Math.floor(list.scrollTop / height()) - 4);
    return [first, Math.min(total, first + Math.ceil(list.clientHeight / height()) + 8)];
  }

  function draw() {
    if (!fleet) return;
    rows.style.height = `${total * height()}px`;
    const [first, last] = visible();
    for (const [i, old] of made) {
      if (i >= first && i < last) continue;
      old.remove();
      made.delete(i);
    }
    for (let i = first; i < last; ++i) {
      const shown = row(i);
      if (!shown.isConnected) rows.append(shown);
    }
    if (active >= first && active < last) list.setAttribute('aria-activedescendant', `row-${active}`);
    else list.removeAttribute('aria-activedescendant');
    const noun = total === 1 ? fleet.noun : wearwell.plural(fleet.noun);
    found.textContent = search.value ? `${wearwell.count(total)} ${noun} found` : '';
    list.dataset.drawn = 'true';
  }

  // Requests missing visible pages, or all of them again; discards answers that are outdated.
  async function load(anew) {
    const [first, last] = visible();
    const wanted = new Set([Math.floor(first / page), Math.floor(Math.max(first, last - 1) / page)]);
    const mine = anew ? ++serial : serial;
    const fresh = anew ? new Map() : pages;
    const kept = active >= 0 ? unit(active)?.unit : undefined;
    for (const number of wanted) {
      if (fresh.has(number)) continue;
      const answer = await wearwell.ask(path(number));
      if (mine !== serial) return;
      fresh.set(number, answer.units);
      total = answer.matching;
    }
    pages = fresh;
    // The selection stays with its unit when the order changes.
    if (kept !== undefined) {
      for (const [number, units] of pages) {
        const at = units.findIndex((each) => each.unit === kept);
        if (at >= 0) active = number * page + at;
      }
    }
    active = Math.min(active, total - 1);
    draw();
  }

  const complain = (error) => { found.textContent = error.message; };
  const shown = (anew) => load(anew).catch(complain);

  function move(to) {
    if (total === 0) return;
    active = Math.min(Math.max(to, 0), total - 1);
    const top = active * height();
    if (top < list.scrollTop) list.scrollTop = top;
    if (top + height() > list.scrollTop + list.clientHeight) list.scrollTop = top + height() - list.clientHeight;
    draw();
    shown(false);
  }

  const open = (name) => { location.hash = `unit=${encodeURIComponent(name)}`; };

  list.addEventListener('scroll', () => { touched = Date.now(); draw(); shown(false); }, {passive: true});
  // Rows do not move while the pointer is about to press one.
  list.addEventListener('pointermove', () => { touched = Date.now(); }, {passive: true});
  list.addEventListener('click', (event) => {
    // By its position: the pressed element may have been redrawn since.
    const at = Math.floor((event.clientY - rows.getBoundingClientRect().top) / height());
    if (!unit(at)) return;
    active = at;
    open(unit(at).unit);
  });
  list.addEventListener('keydown', (event) => {
    const many = Math.max(1, Math.floor(list.clientHeight / height()) - 1);
    const steps = {ArrowUp: active - 1, ArrowDown: active + 1, PageUp: active - many, PageDown: active + many, Home: 0, End: total - 1};
    if (event.key in steps) {
      event.preventDefault();
      move(steps[event.key]);
    } else if ((event.key === 'Enter' || event.key === ' ') && unit(active)) {
      event.preventDefault();
      open(unit(active).unit);
    }
  });
  list.addEventListener('focus', () => { if (active < 0) move(Math.round(list.scrollTop / height())); });
  let typed = 0;
  search.addEventListener('input', () => {
    clearTimeout(typed);
    typed = setTimeout(() => {
      active = -1;
      list.scrollTop = 0;
      shown(true);
    }, 150);
  });
  search.addEventListener('keydown', (event) => {
    if (event.key === 'ArrowDown' || event.key === 'Enter') {
      event.preventDefault();
      list.focus();
      move(0);
    }
  });
  phone.addEventListener('change', draw);
  addEventListener('resize', draw);

  wearwell.list = {
    begin: async (view) => {
      fleet = view;
      document.getElementById('column-unit').textContent = wearwell.capital(fleet.noun);
      document.getElementById('column-risk').textContent = `Risk in ${wearwell.given(fleet.horizon, fleet.axis_unit)}`;
      await load(true);
      return unit(0)?.unit;
    },
    // Ages grow even if nothing else changes.
    refresh: (view, news) => {
      fleet = view;
      if (!news) return draw();
      if (pending) return undefined;
      const wait = Math.max(0, touched + 1500 - Date.now());
      pending = setTimeout(() => { pending = 0; shown(true); }, wait);
      return undefined;
    },
    opened: (name) => { opened = name; draw(); },
    focus: () => list.focus({preventScroll: true}),
  };
})();
