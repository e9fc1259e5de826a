'use strict';
// The step Ask: questions about lives, each answer a card.
(() => {
  const {element, strings} = wearwell;
  const place = {};
  let count = 0, folder = '';

  const width = () => Math.min(560, Math.max(280, place.cards.clientWidth - 40));

  // Also of the step Fit, in its own width.
  function survival({answer}, wide = width()) {
    const points = answer.survival.filter((each) => each.life !== null && each.survival > 0.004).map((each) => [each.life, each.survival]);
    if (points.length < 3) return null;
    return wearwell.scatter({points, line: true, x: {name: `${answer.name} [${wearwell.unit(answer.unit)}]`}, y: {name: strings.probability},
      description: `${strings.survivalTitle}: ${strings.probability}`, hint: '', read: ([a, b]) => `${wearwell.quantity(a, answer.unit, 4)}: ${wearwell.given(b)}`}, wide);
  }
  wearwell.survivalPlot = survival;

  function cost({curve}) {
    if (!curve || curve.age.length < 3) return null;
    const points = curve.age.map((each, i) => [each, curve.cost[i]]), unit = wearwell.unit(curve.cost_unit);
    return wearwell.scatter({points, line: true, x: {name: strings.replacedAt(wearwell.unit(curve.age_unit))}, y: {name: strings.costName(unit)},
      description: strings.costDescription, hint: '', read: ([a, b]) => `${wearwell.quantity(a, curve.age_unit, 4)}: ${wearwell.given(Number(b.toPrecision(4)))} ${unit}`}, width());
  }

  async function ask({path, picture, look = ''}, form) {
    const question = {result: folder};
    for (const each of form.elements) if (each.name && each.value) question[each.name] = each.value;
    if (!question.level) delete question.sides;
    const found = await wearwell.post(path, question);
    addCard(element('pre', {class: `answer ${look}`, tabindex: 0, lang: 'en'}, found.text), picture(found), ...wearwell.sameLines(found));
  }

  function addCard(...parts) {
    count += 1;
    const made = element('article', {class: 'card', 'aria-label': strings.askedFor(count)}, ...parts);
    place.cards.prepend(made);
    return made;
  }

  // The expected narrowing of each candidate, the best first.
  function narrowing({answer}) {
    const points = (answer.candidates ?? []).filter((each) => each.narrowing !== null && each.narrowing !== undefined).map((each, i) => [i + 1, 100 * each.narrowing, i + 1]);
    if (points.length < 3) return null;
    return wearwell.scatter({points, x: {name: strings.candidateRank, ticks: points.filter((_, i) => i % Math.ceil(points.length / 10) === 0).map(([rank]) => ({at: rank, text: String(rank)}))}, y: {name: strings.narrowing}, labels: [], description: strings.narrowing, hint: '',
      read: ([rank, share]) => `${rank}: ${Number(share.toPrecision(3))} %`}, width());
  }

  // One unit after another; the table grows, and can be stopped.
  async function askUnits() {
    const of = folder, {names, all, ...lines} = await wearwell.get('/api/units'), rows = [];
    if (!names.length) throw new Error(strings.noneFollowed);
    let stopped = false, unit = '';
    const grid = element('div', {}), stop = wearwell.button(strings.unitsStop, () => { stopped = true; }, 'plain'), card = addCard(grid, stop);
    const shown = (value) => (value === null ? strings.never : wearwell.number(value, 4));
    const draw = () => grid.replaceChildren(wearwell.table({id: 'units', caption: strings.unitsCaption(rows.length, all), all: rows.length,
      columns: [strings.unit, `${strings.unitsFrom} [${unit}]`, ...['5 %', strings.median, '95 %'].map((each) => strings.unitHead(each, unit)), strings.unitsFailed],
      rows: [...rows].sort((a, b) => (a.median ?? Infinity) - (b.median ?? Infinity)).map(({cells}) => cells)}));
    for (const name of names) {
      if (stopped || folder !== of || !card.isConnected) break;
      try {
        const {answer} = await wearwell.post('/api/life', {result: of, unit: name});
        unit = wearwell.unit(answer.unit);
        rows.push({name, median: answer.q50, cells: [name, answer.from === undefined ? '' : wearwell.number(answer.from, 4), shown(answer.q05), shown(answer.q50), shown(answer.q95), '']});
      } catch (error) {
        if (error.status !== 400) throw error;
        rows.push({name, median: null, cells: [name, '', '', '', '', error.message.split('\n')[0]]});
      }
      draw();
    }
    stop.remove();
    if (rows.length) card.append(...wearwell.sameLines(lines));
  }

  // Units and lives have other names in another result.
  function result(found) {
    if (folder !== found.folder) for (const id of ['ask-unit', 'decide-at']) document.getElementById(id).value = '';
    folder = found.folder;
    place.none.hidden = found.lives;
    place.none.textContent = found.no_lives ?? strings.noLives;
    place.questions.hidden = !found.lives;
    place.cards.replaceChildren();
  }

  const inputs = (kind, fields) => Object.entries(fields).map(([name, [label, example]]) => wearwell.field(label, `${kind}-${name}`, {name, placeholder: example}));

  function form(kind, question, ...parts) {
    const made = element('form', {id: `${kind}-form`, class: 'fields'}, ...parts, element('button', {}, strings.ask));
    made.addEventListener('submit', (event) => { event.preventDefault(); wearwell.attempt(() => ask(question, made)); });
    return made;
  }

  function build(panel) {
    const sides = element('select', {id: 'ask-sides', name: 'sides'}, ...Object.entries(strings.sideNames).map(([value, text]) => element('option', {value}, text)));
    const life = form('ask', {path: '/api/life', picture: survival}, ...inputs('ask', strings.fields), element('div', {class: 'field'}, element('label', {for: 'ask-sides'}, strings.sides), sides));
    const decide = form('decide', {path: '/api/decide', picture: cost, look: 'lines'}, ...inputs('decide', strings.costs));
    const next = form('next', {path: '/api/next', picture: narrowing, look: 'lines'}, ...inputs('next', strings.nextFields));
    place.units = element('div', {id: 'ask-units'}, element('h3', {}, strings.unitsTitle), element('p', {class: 'note'}, strings.unitsLead), wearwell.button(strings.unitsAsk, () => wearwell.attempt(askUnits)));
    place.questions = element('div', {hidden: true}, element('h3', {}, strings.lifeTitle), life, place.units, element('h3', {}, strings.decideTitle), element('p', {class: 'note'}, strings.decideLead), decide,
        element('h3', {}, strings.nextTitle), element('p', {class: 'note'}, strings.nextLead), next);
    place.none = element('p', {}, strings.noLives);
    place.cards = element('div', {class: 'cards', 'aria-live': 'polite'});
    panel.append(element('h2', {}, strings.askTitle), place.none, place.questions, place.cards);
  }

  wearwell.askPanel = {build, result};
})();
