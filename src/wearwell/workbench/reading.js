'use strict';
// What is seen while a table is read: its name, the time, its first lines as they stand in the file, and a button that stops it.
(() => {
  const {element, strings} = wearwell;

  // {panel, began(answer), session(now), isOwn(number)}. `ended(reading)` is called once for a reading that this page began or showed.
  wearwell.reading = (ended) => {
    let own = 0, shown = 0, last = null, since = 0, ticking = 0, delay = 0;
    const what = element('span', {role: 'status'}), seconds = element('span', {class: 'note'}), lines = element('div', {});
    const panel = element('div', {id: 'reading', hidden: true}, element('div', {class: 'line'}, element('progress', {'aria-label': strings.progress}), what, seconds,
        wearwell.button(strings.stopReading, () => wearwell.attempt(() => wearwell.post('/api/stop-reading')), 'plain')), lines);

    const tick = () => { seconds.textContent = strings.seconds(Math.round((performance.now() - since) / 1000)); };

    function show(reading) {
      clearTimeout(delay);
      if (!panel.hidden && shown === reading.number) return;
      shown = reading.number;
      since = performance.now() - 1000 * (reading.seconds ?? 0);
      what.textContent = strings.reading(reading.file);
      lines.replaceChildren();
      panel.hidden = false;
      tick();
      clearInterval(ticking);
      ticking = setInterval(tick, 1000);
    }

    function end(reading) {
      clearTimeout(delay);
      clearInterval(ticking);
      panel.hidden = true;
      const wanted = reading.number === shown;
      shown = 0;
      if (wanted) ended(reading);
    }

    function began(answer) {
      own = answer.number;
      show(answer);
      if (answer.lines.length) lines.replaceChildren(element('p', {class: 'note'}, strings.firstLines), element('pre', {tabindex: 0, class: 'lines'}, answer.lines.join('\n')));
      if (last?.number === own && last.state !== 'running') end(last);
    }

    // Most tables are read before anything of this could be seen.
    function session({reading, table}) {
      const isFirst = !last;
      last = reading;
      clearTimeout(delay);
      if (reading.state === 'running') delay = setTimeout(() => show(reading), shown === reading.number ? 0 : 150);
      else if (shown) end(reading);
      else if (isFirst && !table && reading.state === 'failed') ended(reading);  // of the command line
    }

    return {panel, began, session, isOwn: (number) => number === own};
  };
})();
