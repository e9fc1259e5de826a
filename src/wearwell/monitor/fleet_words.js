'use strict';
// Alarms, states of units, the server's clock and its answers, for the other scripts of this page.
(() => {
  // An alarm is distinguished by its shape and its word, not only by its color.
  const shapes = {
    ok: 'M8 2a6 6 0 1 0 .01 0z M5 8.2l2.2 2.2 4-4.6',
    watch: 'M8 1.8l6.6 12H1.4z M8 6v4 M8 11.6v.6',
    act: 'M8 1.2l6.8 6.8L8 14.8 1.2 8z M8 4.6v4.2 M8 10.6v.6',
    doubt: 'M8 1.4l5.8 3.3v6.6L8 14.6l-5.8-3.3V4.7z M4.8 9.6l2.2-3.4 2 3.4 2.2-3.4',
    unknown: 'M2.5 2.5h11v11h-11z M6.2 6.4c.2-2.6 3.8-2.4 3.6 0-.1 1.2-1.8 1.2-1.8 2.6 M8 11v.4',
  };
  wearwell.alarms = ['act', 'doubt', 'watch', 'ok', 'unknown'];
  wearwell.badge = (alarm, word = alarm) => {
    const known = shapes[alarm] ? alarm : 'unknown';
    return wearwell.element('span', {class: `badge ${known}`},
        wearwell.element('svg', {viewBox: '0 0 16 16', 'aria-hidden': 'true'}, wearwell.element('path', {d: shapes[known]})),
        wearwell.element('span', {}, word));
  };

  // The alarm; of a part out of service, why it is.
  wearwell.stateOf = (view) => (view.service === 'in service' ? view.alarm : view.service);

  // The server's clock: ages are correct even if this machine's clock is wrong.
  let ahead = 0;
  wearwell.hear = (now) => { ahead = now - Date.now(); };
  wearwell.now = () => Date.now() + ahead;

  async function answer(path, request) {
    const response = await fetch(path, {cache: 'no-store', ...request});
    if (response.status === 401) location.assign('/login');
    if (!response.ok) {
      const {error, problem} = await response.json().catch(() => ({}));
      throw Object.assign(new Error(error || problem || `the server responds with status ${response.status}`), {status: response.status});
    }
    return response.json();
  }
  wearwell.ask = (path) => answer(path, {});
  wearwell.send = (path, body) => answer(path, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
})();
