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
})();
