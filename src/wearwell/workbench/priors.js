'use strict';
// What the priors of a study say before any data: their curves, whose handles are dragged, and the lives that they imply.
(() => {
  const {element, strings} = wearwell;

  const number = (value) => (value === null ? strings.never : wearwell.given(Number(value.toPrecision(3))));
  const unitOf = ({unit}) => (unit === '1' ? '' : wearwell.unit(unit));
  const range = (prior) => strings.priorRange(number(prior.q05), number(prior.q95), number(prior.q50), unitOf(prior));
  const titleOf = (prior) => (prior.meaning && prior.meaning !== 'parameter' ? `${prior.name}: ${prior.meaning}` : prior.name);

  // The curve on axes that stay while it is dragged: of a density of ln x, or of x, as the axis across is.
  function path({across, box, log}, prior) {
    const points = prior.x.map((x, i) => [x, log === prior.log ? prior.y[i] : log ? prior.y[i] * x : prior.y[i] / x]).filter(([x]) => !log || x > 0);
    const top = Math.max(...points.map(([, y]) => y)) * 1.04;
    return points.map(([x, y]) => [across.place(x), y / top]).filter(([part]) => part >= 0 && part <= 1)
        .map(([part, height]) => [box.left + part * (box.right - box.left), box.bottom - height * (box.bottom - box.top)]);
  }

  const heightAt = (line, x) => {
    const after = line.findIndex(([at]) => at >= x);
    if (after <= 0) return line.at(after)?.[1] ?? 0;
    const [[x0, y0], [x1, y1]] = [line[after - 1], line[after]];
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0 || 1);
  };

  // One of the handles of a picture. `move(part)`: to this part of the axis; `end()` after the last of its moves.
  function handleOf(prior, name, plane, {move, end}) {
    const {svg, box, across} = plane, group = element('g', {class: 'handle', role: 'slider', tabindex: 0, id: `prior-${prior.name}-${name}`,
      'aria-label': `${prior.name}: ${strings.handles[name]}`, 'aria-valuemin': across.value(0), 'aria-valuemax': across.value(1)},
    element('circle', {class: 'reach', r: 13}), name === 'location' ? element('circle', {class: 'grip', r: 6}) : element('rect', {class: 'grip', x: -5.5, y: -5.5, width: 11, height: 11}));
    const part = (event) => {
      const frame = svg.getBoundingClientRect();
      return Math.min(1, Math.max(0, ((event.clientX - frame.left) * svg.viewBox.baseVal.width / frame.width - box.left) / (box.right - box.left)));
    };
    group.addEventListener('pointerdown', (event) => { event.preventDefault(); group.focus(); group.setPointerCapture(event.pointerId); });
    group.addEventListener('pointermove', (event) => { if (group.hasPointerCapture(event.pointerId)) move(name, () => part(event)); });
    group.addEventListener('lostpointercapture', () => end(0));
    group.addEventListener('keydown', (event) => {
      const by = {ArrowRight: 0.01, ArrowUp: 0.01, ArrowLeft: -0.01, ArrowDown: -0.01, PageUp: 0.1, PageDown: -0.1}[event.key], to = {Home: 0, End: 1}[event.key];
      if (by === undefined && to === undefined) return;
      event.preventDefault();
      move(name, (at) => (to ?? at + by));
      end(500);
    });
    group.addEventListener('blur', () => end(0));
    return group;
  }

  // Handles over a picture. A move is answered before the next one is asked for; of those that come meanwhile the last counts.
  // `edit`: {text(), put(text, values, isFirst), end()} of the study.
  function movable(given, figure, edit) {
    const {plane} = figure, {svg, box, across, readout} = plane;
    let prior = given, wanted = null, asked = null, busy = false, moved = false, ending = 0;
    const handles = new Map();
    const atOf = (name) => prior.handles.find((each) => each.name === name)?.at;

    function draw() {
      const line = path(plane, prior);
      svg.querySelector('.curve').setAttribute('d', line.length ? `M${line.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join('L')}` : '');
      for (const [name, handle] of handles) {
        const at = atOf(name), x = box.left + Math.min(1, Math.max(0, across.place(at))) * (box.right - box.left);
        handle.setAttribute('transform', `translate(${x.toFixed(1)} ${heightAt(line, x).toFixed(1)})`);
        handle.setAttribute('aria-valuenow', at);
        handle.setAttribute('aria-valuetext', `${number(at)} ${unitOf(prior)}`.trim());
      }
    }

    async function follow() {
      busy = true;
      try {
        while (wanted) {
          const {name, place} = asked = wanted, before = edit.text();
          wanted = null;
          const {specification, meaning} = prior;
          const found = await wearwell.post('/api/prior', {text: before, specification, meaning, handle: name, at: across.value(place)});
          if (edit.text() !== before) return;
          prior = found.prior;
          moved = edit.put(found.text, found.values, !moved) || moved;
          draw();
          readout.textContent = range(prior);
        }
      } catch (error) {
        readout.textContent = error.message.split('\n')[0];
      } finally {
        [busy, asked] = [false, null];
        if (ending && !wanted) finish();
      }
    }

    // What follows from the study is found once, after the last move.
    function finish() {
      clearTimeout(ending);
      ending = 0;
      if (moved) edit.end();
      moved = false;
    }

    const move = (name, to) => {
      clearTimeout(ending);
      ending = 0;
      const last = wanted ?? asked;
      wanted = {name, place: to(last?.name === name ? last.place : across.place(atOf(name)))};
      if (!busy) follow();
    };
    const end = (wait) => {
      clearTimeout(ending);
      ending = setTimeout(() => { if (!busy) finish(); }, wait);
    };
    for (const {name} of prior.handles) handles.set(name, handleOf(prior, name, plane, {move, end}));
    svg.append(...handles.values());
    draw();
    return figure;
  }

  function picture(prior, width, edit) {
    const name = titleOf(prior);
    if (!prior.proper) return element('div', {}, element('p', {class: 'note'}, `${name}: ${strings.improper}`));
    const points = prior.x.map((each, i) => [each, prior.y[i]]), hasHandles = prior.handles.length > 0;
    const figure = wearwell.scatter({points, line: true, bare: true, movable: hasHandles, x: {name: unitOf(prior) ? `[${unitOf(prior)}]` : '', log: prior.log}, y: {name},
      description: `${name}: ${range(prior)}`, hint: range(prior), read: ([a]) => `${number(a)} ${unitOf(prior)}`}, width);
    return element('div', {}, hasHandles ? movable(prior, figure, edit) : figure);
  }

  function table(quantities) {
    return wearwell.table({id: 'implied', caption: strings.implied, columns: [strings.quantity, '5 %', '50 %', '95 %', strings.unit],
      rows: quantities.map((each) => [each.name, number(each.q05), number(each.q50), number(each.q95), unitOf(each)]), all: quantities.length});
  }

  // A part of the step Model: {panel, update()}. The handle that has the focus keeps it.
  wearwell.priors = (study) => {
    let isDragged = false;
    const inside = element('div', {'aria-live': 'polite'}), panel = element('details', {id: 'priors'}, element('summary', {}, strings.priorsTitle), inside);

    // Text and fields follow each move, check and lives wait for the end. The whole drag is one replacement.
    const edit = {text: study.text,
      put(next, values, isFirst) {
        if (next === study.text()) return false;
        if (isFirst) study.remember();
        isDragged = true;
        study.put(next, values);
        return true;
      },
      end() { isDragged = false; study.changed(); }};

    const parts = (found) => [found.priors.some((each) => each.handles.length) ? element('p', {class: 'note'}, strings.dragHint) : null,
      element('div', {class: 'priors'}, ...found.priors.map((each) => picture(each, study.width(), edit))), found.quantities.length ? table(found.quantities) : null,
      found.obstacle ? element('p', {class: 'note'}, found.obstacle) : null].filter(Boolean);

    // Of a study that can be fitted; the last text that is asked for is shown.
    function update() {
      if (!panel.open) return;
      if (!study.isGood()) { inside.replaceChildren(element('p', {class: 'note'}, strings.checkBad)); return; }
      const asked = study.asked();
      wearwell.quietly(async () => {
        const found = await wearwell.post('/api/priors', asked);
        if (asked.text !== study.text() || isDragged) return;
        const focus = inside.contains(document.activeElement) ? document.activeElement.id : '';
        inside.replaceChildren(...parts(found));
        if (focus) document.getElementById(focus)?.focus();
      });
    }
    panel.addEventListener('toggle', update);
    return {panel, update};
  };
})();
