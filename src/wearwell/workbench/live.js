'use strict';
// A life as its conditions, its failure threshold and the question change: sliders, and the survival curve that follows them.
(() => {
  const {element, strings} = wearwell;
  const digits = (value) => Number(value.toPrecision(3));
  const percent = (value) => `${digits(100 * value)} %`;

  // A slider over `values`, which begins at the one with the index `start`; `text(value)` is what is shown and asked.
  function slider({id, label, values, start, text, moved}) {
    const input = element('input', {type: 'range', id, min: 0, max: values.length - 1, step: 1, value: start, autocomplete: 'off'});
    const output = element('output', {for: id});
    const value = () => text(values[Number(input.value)]);
    const show = () => { output.textContent = value(); input.setAttribute('aria-valuetext', value()); };
    input.addEventListener('input', () => { show(); moved(); });
    show();
    return {field: element('div', {class: 'field'}, element('label', {for: id}, label), input, output), value,
            isMoved: () => Number(input.value) !== start, reset: () => { input.value = start; show(); }};
  }

  const places = (count, at) => Array.from({length: count + 1}, (_, i) => at(i / count));
  // From half to twice the value, in equal ratios; itself with all its digits.
  const around = (middle) => places(80, (part) => (part === 0.5 ? middle : digits(middle * 2 ** (2 * part - 1))));
  const risks = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5], levels = [0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.975, 0.99, 0.995, 0.999];

  // {panel, result(found)} of the step Fit.
  wearwell.liveLife = () => {
    let found = null, sliders = null, asking = false, again = false, longest = null;
    const controls = element('div', {class: 'fields sliders'}), picture = element('div', {class: 'picture'}), answer = element('pre', {class: 'answer', tabindex: 0, lang: 'en', 'aria-live': 'polite'}), same = element('div', {});
    const unit = element('select', {id: 'live-unit'});
    const wrong = element('p', {class: 'wrong', role: 'status'});
    const write = wearwell.button(strings.writeValues, () => wearwell.attempt(writeValues), 'plain'), reset = wearwell.button(strings.resetSliders, () => { for (const each of all()) each.reset(); ask(); }, 'plain');
    const panel = element('details', {id: 'live'}, element('summary', {}, strings.liveTitle), element('p', {class: 'note'}, strings.liveLead), controls,
        element('div', {class: 'live'}, picture, element('div', {}, answer, wrong)), element('div', {class: 'choices'}, write, reset), same);
    const all = () => (sliders ? [...Object.values(sliders.question), ...sliders.varied.map((each) => each.slider)] : []);
    const changes = () => Object.fromEntries(sliders.varied.filter((each) => each.slider.isMoved()).map((each) => [each.path, each.slider.value()]));

    function question() {
      const asked = {result: found.folder, unit: unit.value, changes: changes()};
      for (const [name, each] of Object.entries(sliders?.question ?? {})) if (each.isMoved() || name === 'level') asked[name] = each.value();
      return asked;
    }

    function show(next) {
      answer.textContent = next.text;
      picture.replaceChildren(...[wearwell.survivalPlot(next, Math.min(560, Math.max(280, picture.clientWidth || 480)))].filter(Boolean));
      same.replaceChildren(...(next.command ? wearwell.sameLines(next) : [element('p', {class: 'note'}, strings.changedLines)]));
      write.hidden = Boolean(next.command);
    }

    // One question at a time; of those that come meanwhile the last.
    async function ask() {
      if (asking) { again = true; return; }
      asking = true;
      panel.setAttribute('aria-busy', 'true');
      const of = found;
      try {
        const next = await wearwell.post('/api/life', question());
        if (of === found) { wrong.textContent = ''; show(next); }
      } catch (error) {
        if (of === found) wrong.textContent = error.message;
      } finally {
        asking = false;
        panel.removeAttribute('aria-busy');
        if (again) { again = false; ask(); }
      }
    }

    function build() {
      const lifeUnit = longest.unit, moved = ask;
      const text = (value, of) => (of ? `${value} ${of}` : String(value));
      sliders = {
        question: {
          survived: slider({id: 'live-survived', label: strings.fields.survived[0], start: 0, values: places(100, (part) => digits(longest.from + longest.most * part)), text: (value) => text(value, lifeUnit), moved}),
          risk: slider({id: 'live-risk', label: strings.fields.risk[0], start: risks.indexOf(0.01), values: risks, text: percent, moved}),
          level: slider({id: 'live-level', label: strings.fields.level[0], start: levels.indexOf(0.95), values: levels, text: percent, moved}),
        },
        varied: found.varied.map(({path, number, unit: of}, i) => ({path, slider: slider({id: `live-varied-${i}`, label: path.replace(/^predict\./, ''), start: 40, values: around(number), text: (value) => text(value, of), moved})})),
      };
      controls.replaceChildren(unitField(), ...all().map((each) => each.field));
    }

    const unitField = () => element('div', {class: 'field'}, element('label', {for: 'live-unit'}, strings.fields.unit[0]), unit);

    // Units of the data, and stresses that the study names.
    async function lives() {
      const {names} = await wearwell.get('/api/units');
      const stresses = found.varied.map(({path}) => /^predict\.stress\.([^.]+)\./.exec(path)?.[1]).filter(Boolean);
      unit.replaceChildren(element('option', {value: ''}, strings.newUnit), ...[...new Set([...stresses, ...names])].map((each) => element('option', {value: each}, each)));
      if (stresses.length && !names.length) unit.value = stresses[0];
      controls.replaceChildren(unitField());
    }

    // The first answer says how long lives are; the sliders reach that far.
    async function begin() {
      const of = found;
      if (!unit.options.length) await lives();
      const first = await wearwell.post('/api/life', {result: of.folder, unit: unit.value});
      if (of !== found) return;
      const finite = first.answer.survival.map((each) => each.life).filter((each) => each !== null);
      longest = {unit: first.answer.unit, from: first.answer.from ?? 0, most: finite.at(-1) ?? 1};
      build();
      await ask();
    }
    const start = () => { if (panel.open && found?.lives && !sliders) wearwell.quietly(async () => { try { await begin(); } catch (error) { if (error.status !== 400) throw error; wrong.textContent = error.message; } }); };
    panel.addEventListener('toggle', start);
    unit.addEventListener('change', () => { sliders = null; wrong.textContent = ''; start(); });

    async function writeValues() {
      const {study} = wearwell.model, wanted = changes();
      if (`${study.name().replace(/\.toml$/, '')}-results` !== found.folder) throw new Error(strings.adviceOf(found.folder));
      let text = study.text();
      for (const [path, value] of Object.entries(wanted)) ({text} = await wearwell.post('/api/set', {text, path, value}));
      study.replace(text);
      wearwell.step('model');
    }

    function result(next) {
      [found, sliders] = [next, null];
      panel.hidden = !next.lives;
      unit.replaceChildren();
      for (const each of [controls, picture, answer, same]) each.replaceChildren();
      write.hidden = true;
      wrong.textContent = '';
      start();
    }
    return {panel, result};
  };
})();
