'use strict';
// Updates the page from the server's events, and reports a lost connection.
(() => {
  const {element} = wearwell;
  const connection = document.getElementById('connection'), banners = document.getElementById('banners');
  const quiet = 25000;  // the server beats every 10 s
  let fleet = null, source = null, heard = Date.now(), lost = 0, polling = 0, starting = '';

  const wide = matchMedia('(min-width: 1000px)');
  const chosen = () => (location.hash.startsWith('#unit=') ? decodeURIComponent(location.hash.slice(6)) : '');

  function state(name, words) {
    if (connection.dataset.state === name && connection.textContent === words) return;
    connection.dataset.state = name;
    connection.textContent = words;
    document.body.classList.toggle('stale', name === 'lost');
  }

  function counts() {
    const bar = element('div', {class: 'bar', 'aria-hidden': 'true'});
    const words = element('ul', {role: 'list'});
    for (const alarm of wearwell.alarms) {
      const count = fleet.units[alarm];
      if (count > 0) {
        const part = element('span', {class: alarm});
        part.style.flexGrow = count;
        bar.append(part);
      }
      words.append(element('li', {}, wearwell.badge(alarm), element('strong', {}, wearwell.count(count))));
    }
    document.getElementById('counts').replaceChildren(bar, words);
  }

  function banner(kind, word, text) {
    return element('p', {class: `callout ${kind}`, role: kind === 'fail' ? 'alert' : 'status'}, element('strong', {}, `${word} `), text);
  }

  function complaints() {
    const all = [];
    if (starting) all.push(['warn', 'Starting.', `${starting[0].toUpperCase()}${starting.slice(1)}.`]);
    else if (lost) all.push(['fail', 'Connection lost.', `The page shows the state of ${wearwell.clock(lost)} and tries to reconnect.`]);
    if (fleet && !fleet.trusted) all.push(['warn', 'Not trusted.', 'The result that the population comes from did not pass its checks: the values here may be wrong.']);
    if (fleet && fleet.units.all > 0 && fleet.units.unknown === fleet.units.all) all.push(['warn', 'No news.', `No ${fleet.noun} has reported for a long time.`]);
    if (fleet && fleet.webhook && fleet.webhook.waiting > 0 && fleet.webhook.failed > 0) all.push(['warn', 'Alarms are not sent.', `The webhook has not accepted the alarms of ${wearwell.count(fleet.webhook.waiting)} ${fleet.webhook.waiting === 1 ? fleet.noun : wearwell.plural(fleet.noun)}; the monitor tries again.`]);
    if (fleet && fleet.messages.lag_ms > 5000) all.push(['warn', 'Behind.', `Readings arrive faster than they are processed: the page lags behind the stored readings.`]);
    // An alert is announced once, not whenever something else changes.
    const text = JSON.stringify(all);
    if (banners.dataset.text === text) return;
    banners.dataset.text = text;
    banners.replaceChildren(...all.map((each) => banner(...each)));
  }

  function head() {
    if (!fleet) return;
    const last = fleet.messages.last_ms;
    document.getElementById('title').textContent = fleet.title || 'wearwell monitor';
    document.title = `${fleet.units.act ? `(${fleet.units.act}) ` : ''}${fleet.title || 'wearwell monitor'}`;
    const noun = fleet.units.all === 1 ? fleet.noun : wearwell.plural(fleet.noun);
    document.getElementById('subtitle').textContent = `${wearwell.count(fleet.units.all)} ${noun}, ` +
        (last ? `last message ${wearwell.age(wearwell.now() - last)} ago` : `no message since the start ${wearwell.age(wearwell.now() - fleet.started_ms)} ago`);
    complaints();
    wearwell.fits.refresh(fleet);
  }

  function take(view) {
    fleet = view;
    wearwell.hear(view.now_ms);
    head();
    counts();
  }

  function show() {
    const unit = chosen();
    document.body.dataset.view = unit ? 'unit' : 'fleet';
    wearwell.list.opened(unit);
    if (unit) wearwell.detail.open(fleet, unit).then(() => { if (!wide.matches) scrollTo(0, 0); });
    else wearwell.detail.close();
  }

  function alive() {
    heard = Date.now();
    lost = 0;
    starting = '';
    state(polling ? 'wait' : 'live', polling ? 'Every 10 s' : 'Live');
    complaints();
  }

  // Without an answer; 503: the monitor is starting, and says so.
  function cut(error) {
    if (!lost) lost = heard;
    starting = error?.status === 503 ? error.message : '';
    if (starting) heard = Date.now();
    state(starting ? 'wait' : 'lost', starting ? 'Starting' : 'Not connected');
    complaints();
  }

  function news(view, all, changed) {
    take(view);
    wearwell.list.refresh(fleet, all || changed.length > 0);
    if (all || changed.includes(wearwell.detail.opened())) wearwell.detail.refresh(fleet);
  }

  // If no event stream is free, the page polls.
  async function poll() {
    try {
      news(await wearwell.ask('/api/v1/fleet'), true, []);
      alive();
    } catch (error) {
      cut(error);
    }
  }

  function listen() {
    source?.close();
    source = new EventSource('/api/v1/events');
    source.addEventListener('open', () => {
      clearInterval(polling);
      polling = 0;
      alive();
    });
    source.addEventListener('fleet', (event) => {
      const {fleet: view, all, changed} = JSON.parse(event.data);
      alive();
      news(view, all, changed);
    });
    source.addEventListener('beat', (event) => {
      wearwell.hear(JSON.parse(event.data).now_ms);
      alive();
    });
    source.addEventListener('error', () => {
      if (source.readyState !== EventSource.CLOSED) return cut();  // the browser tries again
      if (!polling) polling = setInterval(poll, 10000);
      setTimeout(listen, 30000);
      return poll();
    });
  }

  setInterval(() => {
    head();
    if (fleet && !lost) wearwell.list.refresh(fleet, false);
    if (!polling && Date.now() - heard > quiet) {
      cut();
      heard = Date.now();
      listen();
    }
  }, 5000);

  addEventListener('hashchange', () => {
    const before = document.body.dataset.view;
    show();
    if (!chosen() && before === 'unit') wearwell.list.focus();
    else if (!wide.matches) document.getElementById('detail').focus({preventScroll: true});
  });
  addEventListener('keydown', (event) => {
    const typing = event.target.matches?.('input');
    if (event.key === '/' && !typing && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      if (!wide.matches) location.hash = '';
      document.getElementById('search').focus();
    }
    if (event.key === 'Escape' && !typing && chosen() && !wide.matches) location.hash = '';
    else if (event.key === 'Escape' && !typing) wearwell.list.focus();
  });
  document.querySelector('.skip').addEventListener('click', (event) => {
    event.preventDefault();
    wearwell.list.focus();
  });

  async function begin() {
    try {
      take(await wearwell.ask('/api/v1/fleet'));
      document.getElementById('install').replaceChildren(wearwell.installForm(fleet));
      const first = await wearwell.list.begin(fleet);
      if (!chosen() && wide.matches && first !== undefined) history.replaceState(null, '', `#unit=${encodeURIComponent(first)}`);
      show();
      listen();
    } catch (error) {
      cut(error);
      setTimeout(begin, 3000);
    }
  }
  begin();
})();
