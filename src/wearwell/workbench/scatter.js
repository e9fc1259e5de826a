'use strict';
// A plot of points or a line over two axes, each linear or logarithmic.
(() => {
  const {element} = wearwell;
  const margin = {left: 64, right: 16, top: 12, bottom: 44};

  function linearTicks(low, high, most) {
    const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= rough);
    const found = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) found.push(Number((i * step).toPrecision(12)));
    return found.length < 2 && most < 12 ? linearTicks(low, high, 2 * most) : found;
  }

  function logTicks(low, high, most) {
    const found = [], first = Math.floor(low), last = Math.ceil(high);
    const every = Math.max(1, Math.ceil((last - first) / most));
    const within = high - low < 2.5 ? [1, 2, 5] : [1];
    for (let power = first; power <= last; power += every) {
      for (const each of within) {
        const at = power + Math.log10(each);
        if (at >= low - 1e-9 && at <= high + 1e-9) found.push(at);
      }
    }
    return found;
  }

  // {name, log, values, ticks: their own, if any} -> {place: value -> 0 to 1, value: its inverse, ticks: [{at, text}]}
  function axisOf({log, values, ticks: given}, most) {
    const scaled = (value) => (log ? Math.log10(value) : value);
    let low = Infinity, high = -Infinity;
    for (const each of values) { const at = scaled(each); low = Math.min(low, at); high = Math.max(high, at); }
    if (!(low <= high)) [low, high] = [0, 1];
    const room = high > low ? 0.04 * (high - low) : Math.abs(low) || 1;
    [low, high] = [low - room, high + room];
    const part = (at) => (at - low) / (high - low);
    if (given) return {place: (value) => part(scaled(value)), ticks: given.map(({at, text}) => ({part: part(at), text})).filter((each) => each.part >= 0 && each.part <= 1)};
    const ticks = log ? logTicks(low, high, most) : linearTicks(low, high, most);
    return {
      place: (value) => part(scaled(value)),
      value: (part) => (log ? 10 ** (low + part * (high - low)) : low + part * (high - low)),
      ticks: ticks.map((at) => ({part: part(at), text: wearwell.given(log ? Number((10 ** at).toPrecision(6)) : at)})),
    };
  }

  // The ticks whose texts stand beside each other without touching; powers of ten come first.
  function labelled(ticks, length) {
    const kept = [], half = ({text}) => 3.6 * text.length + 4, isPower = ({text}) => /^1\D*(0\D*)*$/.test(text);
    for (const each of [...ticks.filter(isPower), ...ticks.filter((tick) => !isPower(tick))])
      if (kept.every((other) => Math.abs(other.part - each.part) * length >= half(other) + half(each))) kept.push(each);
    return new Set(kept);
  }

  // Dots are lines without length, with round ends; a run-out is an arrow: its life would have been longer.
  const dots = (places) => places.map(([a, b]) => `M${a.toFixed(1)} ${b.toFixed(1)}h0`).join('');
  // Many of them are squares, which are painted in a tenth of the time; one path for each part of the picture, so that a tile of the screen paints its own.
  const partSize = 80;
  function squares(places) {
    const parts = new Map();
    for (const [a, b] of places) {
      const key = 1000 * Math.floor(a / partSize) + Math.floor(b / partSize);
      parts.set(key, `${parts.get(key) ?? ''}M${(a - 1.5).toFixed(1)} ${(b - 1.5).toFixed(1)}h3v3h-3z`);
    }
    return [...parts.values()];
  }
  const arrows = (places, up) => places.map(([a, b]) => (up ? `M${a.toFixed(1)} ${(b + 4).toFixed(1)}v-12m-4 5l4 -5l4 5` : `M${(a - 4).toFixed(1)} ${b.toFixed(1)}h12m-5 -4l5 4l-5 4`)).join('');

  const curve = (places) => `M${places.map(([a, b]) => `${a.toFixed(1)} ${b.toFixed(1)}`).join('L')}`;

  // The points of each label, and a legend of the labels.
  function marks(plot, places) {
    const labels = plot.labels?.length ? [...plot.labels, {text: plot.others}] : [{text: ''}];
    const parts = labels.map(() => []);
    places.forEach((each, i) => parts[plot.labels?.length ? plot.points[i][3] : 0].push(each));
    const many = places.length > 1000;
    const look = (i) => (plot.labels?.length ? ` label label-${i}` : '');
    const drawn = (each, i) => (labels[i].runout ? [element('path', {class: `runouts${look(i)}`, d: arrows(each, plot.lifeUp)})]
      : (many ? squares(each) : [dots(each)]).map((d) => element('path', {class: `dots${many ? ' many' : ''}${look(i)}`, d})));
    const paths = parts.flatMap((each, i) => (each.length ? drawn(each, i) : []));
    const legend = plot.labels?.length ? element('ul', {class: 'legend'}, ...labels.flatMap(({text, runout}, i) => (parts[i].length ? [element('li', {},
        element('svg', {width: 18, height: 14, 'aria-hidden': 'true'}, element('path', runout ? {class: `runouts${look(i)}`, d: arrows([[8, 7]], false)} : {class: `dots${look(i)}`, d: dots([[8, 7]])})), text)] : []))) : null;
    return {paths, legend};
  }

  // {points: [[x, y, row, label]], labels: [{text, runout}], others, x: {name, log}, y: {name, log, ticks}, line, curve (a line over the points), lifeUp, bare (a small picture without the axis up), movable (it will
  // have handles), description, read: (point) -> text, hint}. The figure has `plane`: where things stand, for what is drawn over it.
  wearwell.scatter = (plot, width) => {
    const height = plot.bare ? 140 : Math.min(360, Math.max(240, Math.round(width * 0.55)));
    const box = {left: plot.bare ? margin.right : margin.left, right: width - margin.right, top: margin.top, bottom: height - margin.bottom};
    const all = [...plot.points, ...(plot.curve ?? [])];
    const across = axisOf({...plot.x, values: all.map((each) => each[0])}, Math.max(3, Math.floor((box.right - box.left) / 80)));
    const up = axisOf({...plot.y, values: all.map((each) => each[1])}, 5);
    if (plot.bare) up.ticks = [];
    const x = (value) => box.left + across.place(value) * (box.right - box.left);
    const y = (value) => box.bottom - up.place(value) * (box.bottom - box.top);
    const svg = element('svg', {viewBox: `0 0 ${width} ${height}`, width, height, role: plot.movable ? 'group' : 'img', 'aria-label': plot.description, class: 'plot'});
    const texts = labelled(across.ticks, box.right - box.left);
    for (const tick of across.ticks) {
      const at = box.left + tick.part * (box.right - box.left);
      svg.append(element('line', {class: 'grid', x1: at, x2: at, y1: box.top, y2: box.bottom}));
      if (texts.has(tick)) svg.append(element('text', {x: at, y: box.bottom + 17, 'text-anchor': 'middle'}, tick.text));
    }
    for (const {part, text} of up.ticks) {
      const at = box.bottom - part * (box.bottom - box.top);
      svg.append(element('line', {class: 'grid', x1: box.left, x2: box.right, y1: at, y2: at}),
                 element('text', {x: box.left - 8, y: at + 4, 'text-anchor': 'end'}, text));
    }
    const places = plot.points.map(([a, b]) => [x(a), y(b)]);
    const {paths, legend} = plot.line ? {paths: [element('path', {class: 'curve', d: curve(places)})], legend: null} : marks(plot, places);
    if (places.length) svg.append(...paths);
    if (plot.curve?.length) svg.append(element('path', {class: 'fitted', d: curve(plot.curve.map(([a, b]) => [x(a), y(b)]))}));
    svg.append(element('text', {class: 'name', x: (box.left + box.right) / 2, y: height - 6, 'text-anchor': 'middle'}, plot.x.name));
    const readout = element('p', {class: 'readout'}, plot.hint);
    const mark = element('circle', {class: 'mark', r: 6, visibility: 'hidden'});
    svg.append(mark);
    svg.addEventListener('pointermove', (event) => {
      if (event.buttons) return;
      const frame = svg.getBoundingClientRect(), ratio = width / frame.width;
      const [a, b] = [(event.clientX - frame.left) * ratio, (event.clientY - frame.top) * ratio];
      let best = -1, least = Infinity;
      places.forEach(([px, py], i) => { const d = (px - a) ** 2 + (py - b) ** 2; if (d < least) { least = d; best = i; } });
      if (best < 0) return;
      mark.setAttribute('cx', places[best][0]);
      mark.setAttribute('cy', places[best][1]);
      mark.setAttribute('visibility', 'visible');
      readout.textContent = plot.read(plot.points[best]);
    });
    svg.addEventListener('pointerleave', () => { mark.setAttribute('visibility', 'hidden'); readout.textContent = plot.hint; });
    const figure = element('figure', {}, element('figcaption', {}, plot.y.name), svg, legend, readout);
    return Object.assign(figure, {plane: {svg, box, readout, across, log: plot.x.log}});
  };
})();
