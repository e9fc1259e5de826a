'use strict';
// Plots as SVG: bands, lines and points over two axes, with a cross-hair that the pointer or the arrow keys move.
(() => {
  const {element} = wearwell;
  const margin = {left: 58, right: 14, top: 12, bottom: 40};

  function ticks(low, high, most) {
    const step0 = (high - low) / Math.max(1, most);
    const power = 10 ** Math.floor(Math.log10(step0));
    const step = [1, 2, 2.5, 5, 10].map((each) => each * power).find((each) => each >= step0) ?? step0;
    const found = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) found.push(i * step);
    return {found, step};
  }

  // As many decimals as distinguish neighbours.
  function label(x, step) {
    if (Math.abs(x) >= 1e7 || (step < 1e-3 && x !== 0)) return wearwell.number(x);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9) + (/^25/.test(String(step).replace(/[0.]/g, '') + '0') ? 1 : 0));
    const [whole, part] = Math.abs(x).toFixed(Math.min(decimals, 6)).split('.');
    return (x < 0 ? '−' : '') + whole.replace(/\B(?=(\d{3})+(?!\d))/g, whole.length > 4 ? '\u202f' : '') + (part ? `.${part}` : '');
  }

  const finite = (x) => typeof x === 'number' && Number.isFinite(x);

  // A null interrupts the line.
  function outline(points, x, y, key) {
    let path = '', pen = false;
    for (const each of points) {
      const at = each[key];
      if (!finite(each.x) || !finite(at)) { pen = false; continue; }
      path += `${pen ? 'L' : 'M'}${x(each.x).toFixed(1)} ${y(at).toFixed(1)}`;
      pen = true;
    }
    return path;
  }

  // An infinite end lies outside the frame.
  function area(points, x, y, beyond) {
    const seen = points.filter((each) => finite(each.x) && (finite(each.low) || finite(each.high)));
    if (seen.length < 2) return '';
    const up = seen.map((each) => `${x(each.x).toFixed(1)} ${y(finite(each.high) ? each.high : beyond).toFixed(1)}`);
    const down = seen.map((each) => `${x(each.x).toFixed(1)} ${y(finite(each.low) ? each.low : beyond).toFixed(1)}`).reverse();
    return `M${up.join('L')}L${down.join('L')}Z`;
  }

  function axes(box, x, y, specification) {
    const group = element('g', {'aria-hidden': 'true'});
    const across = ticks(...specification.x.domain, Math.max(2, box.width / 95));
    for (const at of across.found) {
      group.append(element('line', {class: 'tick', x1: x(at), x2: x(at), y1: box.bottom, y2: box.bottom + 4}),
                   element('text', {x: x(at), y: box.bottom + 17, 'text-anchor': 'middle'}, label(at, across.step)));
    }
    const up = ticks(...specification.y.domain, 4);
    for (const at of up.found) {
      const text = specification.y.percent ? `${Math.round(at * 100)} %` : label(at, up.step);
      group.append(element('line', {class: 'grid', x1: box.left, x2: box.right, y1: y(at), y2: y(at)}),
                   element('text', {x: box.left - 8, y: y(at) + 4, 'text-anchor': 'end'}, text));
    }
    group.append(element('line', {class: 'domain', x1: box.left, x2: box.right, y1: box.bottom, y2: box.bottom}),
                 element('text', {class: 'name', x: (box.left + box.right) / 2, y: box.bottom + 35, 'text-anchor': 'middle'},
                         specification.x.name));
    return group;
  }

  function marks(box, x, y, specification) {
    const group = element('g', {'clip-path': `url(#clip-${specification.id})`, 'aria-hidden': 'true'});
    const beyond = specification.y.domain[1] + (specification.y.domain[1] - specification.y.domain[0]);
    for (const mark of specification.marks) {
      if (mark.kind === 'band') group.append(element('path', {class: `band ${mark.look}`, d: area(mark.points, x, y, beyond)}));
      if (mark.kind === 'line') group.append(element('path', {class: `line ${mark.look}`, d: outline(mark.points, x, y, 'y')}));
      if (mark.kind === 'points') {
        for (const each of mark.points) {
          if (finite(each.x) && finite(each.y)) group.append(element('circle', {class: mark.look, cx: x(each.x).toFixed(1), cy: y(each.y).toFixed(1), r: mark.points.length > 120 ? 2 : 3.2}));
        }
      }
      if (mark.kind === 'wedge') {
        const [left, right, at] = mark.to;
        group.append(element('path', {class: `band ${mark.look}`, d: `M${x(mark.from[0])} ${y(mark.from[1])}L${x(left)} ${y(at)}L${x(right)} ${y(at)}Z`}));
      }
      if (mark.kind === 'span') {
        group.append(element('line', {class: `span ${mark.look}`, x1: x(mark.low), x2: x(mark.high), y1: y(mark.y), y2: y(mark.y)}));
        if (finite(mark.middle)) group.append(element('circle', {class: `span ${mark.look}`, cx: x(mark.middle), cy: y(mark.y), r: 4.5}));
      }
      if (mark.kind === 'rule') {
        const [x1, x2] = mark.x === undefined ? [box.left, box.right] : [x(mark.x), x(mark.x)];
        const [y1, y2] = mark.y === undefined ? [box.top, box.bottom] : [y(mark.y), y(mark.y)];
        group.append(element('line', {class: `rule ${mark.look}`, x1, x2, y1, y2}));
        if (mark.word) {
          const flat = mark.x === undefined, right = !flat && x1 > box.left + 0.7 * box.width;
          group.append(element('text', {class: `word ${mark.look}`, x: flat ? box.left + 6 : x1 + (right ? -5 : 5),
                                        y: flat ? y1 - 6 : mark.low ? box.bottom - 8 : box.top + 16, 'text-anchor': right ? 'end' : 'start'}, mark.word));
        }
      }
    }
    return group;
  }

  // `specification.at`: values of x with a readout, in order; `read`: its text.
  function crossHair(svg, box, x, specification, readout) {
    const hair = element('line', {class: 'hair', y1: box.top, y2: box.bottom, visibility: 'hidden'});
    svg.append(hair);
    const stops = specification.at;
    let place = -1;
    const show = (next) => {
      place = Math.min(Math.max(next, 0), stops.length - 1);
      hair.setAttribute('x1', x(stops[place]));
      hair.setAttribute('x2', x(stops[place]));
      hair.setAttribute('visibility', 'visible');
      readout.textContent = specification.read(place);
    };
    const hide = () => {
      place = -1;
      hair.setAttribute('visibility', 'hidden');
      readout.textContent = specification.hint;
    };
    svg.addEventListener('pointermove', (event) => {
      const shown = svg.getBoundingClientRect();
      const at = (event.clientX - shown.left) * (svg.viewBox.baseVal.width / shown.width);
      let best = 0;
      stops.forEach((each, i) => { if (Math.abs(x(each) - at) < Math.abs(x(stops[best]) - at)) best = i; });
      show(best);
    });
    svg.addEventListener('pointerleave', hide);
    svg.addEventListener('blur', hide);
    svg.addEventListener('keydown', (event) => {
      const steps = {ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10, Home: -stops.length, End: stops.length};
      if (!(event.key in steps)) return;
      event.preventDefault();
      event.stopPropagation();
      show(place < 0 && event.key.startsWith('Arrow') ? specification.start ?? 0 : place + steps[event.key]);
    });
  }

  // {id, title, description, x: {name, domain}, y: {name, domain, percent}, marks, at, read, start, hint, legend}
  wearwell.plot = (specification, width) => {
    const height = width < 480 ? 230 : 260;
    const box = {left: margin.left, right: width - margin.right, top: margin.top, bottom: height - margin.bottom};
    box.width = box.right - box.left;
    const scale = ([low, high], from, to) => (value) => from + (value - low) / (high - low || 1) * (to - from);
    const x = scale(specification.x.domain, box.left, box.right);
    const y = scale(specification.y.domain, box.bottom, box.top);
    const svg = element('svg', {viewBox: `0 0 ${width} ${height}`, width, height, role: 'img', tabindex: 0,
                                'aria-label': specification.description, class: 'plot'});
    svg.append(element('defs', {}, element('clipPath', {id: `clip-${specification.id}`},
        element('rect', {x: box.left, y: box.top - 6, width: box.width, height: box.bottom - box.top + 7}))));
    svg.append(axes(box, x, y, specification), marks(box, x, y, specification));
    const readout = element('p', {class: 'readout', 'aria-live': 'polite'}, specification.hint);
    if (specification.at.length) crossHair(svg, box, x, specification, readout);
    const legend = element('ul', {class: 'legend', role: 'list'}, ...specification.legend.map(([look, word]) =>
        element('li', {}, element('span', {class: `key ${look}`, 'aria-hidden': 'true'}), word)));
    return element('figure', {id: `figure-${specification.id}`},
        element('figcaption', {}, element('h3', {}, specification.title), element('p', {}, specification.y.name), legend), svg, readout);
  };
})();
