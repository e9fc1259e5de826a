'use strict';
// Functions that the other scripts share: elements, and texts of numbers and times.
const wearwell = {};

// Text is inserted as text: no input becomes markup.
wearwell.element = (name, attributes = {}, ...children) => {
  const svg = ['svg', 'g', 'path', 'line', 'circle', 'text', 'rect', 'clipPath', 'defs', 'title'].includes(name);
  const made = svg ? document.createElementNS('http://www.w3.org/2000/svg', name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== undefined && value !== null && value !== false) made.setAttribute(key, value === true ? '' : value);
  }
  made.append(...children.filter((each) => each !== undefined && each !== null));
  return made;
};

(() => {
  const thin = '\u202f';
  const group = (digits) => digits.replace(/\B(?=(\d{3})+(?!\d))/g, digits.length > 4 ? thin : '');
  const raised = {'-': '⁻', 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹'};

  // Three significant digits; null stands for infinity.
  wearwell.number = (x, digits = 3) => {
    if (x === null || x === undefined) return '∞';
    if (x === 0) return '0';
    const size = Math.floor(Math.log10(Math.abs(Number(x.toPrecision(digits)))));
    if (size < -3 || size > 6) {
      const [mantissa, power] = x.toExponential(digits - 1).split('e');
      return `${mantissa.replace('-', '−')}${thin}×${thin}10${[...String(Number(power))].map((each) => raised[each]).join('')}`;
    }
    const text = size >= digits ? String(Math.round(x / 10 ** (size - digits + 1)) * 10 ** (size - digits + 1))
                                : x.toFixed(Math.max(0, digits - 1 - size));
    const [whole, part] = text.replace('-', '−').split('.');
    return group(whole) + (part ? `.${part}` : '');
  };

  // Counts and given numbers: all their digits.
  wearwell.count = (x) => group(String(x));
  wearwell.given = (x, unit) => {
    if (x === null || x === undefined) return 'never';
    const digits = String(Number(x.toPrecision(12)));
    const [whole, part] = digits.split('.');
    const text = digits.includes('e') ? wearwell.number(x) : group(whole.replace('-', '−')) + (part ? `.${part}` : '');
    return `${text}${wearwell.unit(unit) ? thin + wearwell.unit(unit) : ''}`;
  };

  wearwell.unit = (text) => {
    if (!text || text === '1') return '';
    return text.replace(/\^(-?\d+)/g, (_, digits) => [...digits].map((each) => raised[each]).join('')).replace(/^um\b/, 'µm');
  };
  wearwell.quantity = (x, unit, digits) => {
    if (x === null || x === undefined) return 'never';
    return `${wearwell.number(x, digits)}${wearwell.unit(unit) ? thin + wearwell.unit(unit) : ''}`;
  };
  // 800 – 1900 h. null is an infinite end.
  wearwell.range = (low, high, unit) => {
    if (low === null && high === null) return 'never';
    if (high === null) return `more than ${wearwell.quantity(low, unit)}`;
    if (low === high) return wearwell.quantity(low, unit);
    return `${wearwell.number(low)} – ${wearwell.quantity(high, unit)}`;
  };
  wearwell.probability = (p) => {
    if (p === null || p === undefined) return '–';
    if (p < 0.001) return `< 0.1${thin}%`;
    if (p > 0.999) return `> 99.9${thin}%`;
    return `${(100 * p).toFixed(p < 0.1 ? 1 : 0)}${thin}%`;
  };
  wearwell.age = (milliseconds) => {
    const seconds = Math.max(0, Math.round(milliseconds / 1000));
    if (seconds < 100) return `${seconds}${thin}s`;
    if (seconds < 100 * 60) return `${Math.round(seconds / 60)}${thin}min`;
    if (seconds < 48 * 3600) return `${Math.round(seconds / 3600)}${thin}h`;
    return `${Math.round(seconds / 86400)}${thin}d`;
  };
  wearwell.clock = (milliseconds) => new Date(milliseconds).toLocaleString([], {dateStyle: 'medium', timeStyle: 'short'});
  wearwell.capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
  // "machine" -> "machines", also for a user's own noun.
  wearwell.plural = (noun) => /(s|x|ch|sh)$/.test(noun) ? `${noun}es` : /[^aeiou]y$/.test(noun) ? `${noun.slice(0, -1)}ies` : `${noun}s`;

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
