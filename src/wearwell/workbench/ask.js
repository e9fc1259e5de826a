'use strict';
// The step Ask: questions about lives, each answer a card.
(() => {
  const {element, strings} = wearwell;
  const place = {};
  let count = 0, folder = '';

  const width = () => Math.min(560, Math.max(280, place.cards.clientWidth - 40));

  function survival({answer}) {
    const points = answer.survival.filter((each) => each.life !== null && each.survival > 0.004).map((each) => [each.life, each.survival]);
    if (points.length < 3) return null;
    return wearwell.scatter({points, line: true, x: {name: `${answer.name} [${wearwell.unit(answer.unit)}]`}, y: {name: strings.probability},
      description: `${strings.survivalTitle}: ${strings.probability}`, hint: '', read: ([a, b]) => `${wearwell.quantity(a, answer.unit, 4)}: ${wearwell.given(b)}`}, width());
  }

  function cost({curve}) {
    if (!curve || curve.age.length < 3) return null;
    const points = curve.age.map((each, i) => [each, curve.cost[i]]), unit = wearwell.unit(curve.cost_unit);
    return wearwell.scatter({points, line: true, x: {name: strings.replacedAt(wearwell.unit(curve.age_unit))}, y: {name: strings.costName(unit)},
      description: strings.costDescription, hint: '', read: ([a, b]) => `${wearwell.quantity(a, curve.age_unit, 4)}: ${wearwell.given(Number(b.toPrecision(4)))} ${unit}`}, width());
  }

  async function ask({path, picture}, form) {
    const question = {result: folder};
    for (const each of form.elements) if (each.name && each.value) question[each.name] = each.value;
    if (!question.level) delete question.sides;
    const found = await wearwell.post(path, question);
    count += 1;
    place.cards.prepend(element('article', {class: 'card', 'aria-label': strings.askedFor(count)}, element('pre', {class: 'answer', tabindex: 0, lang: 'en'}, found.text), picture(found),
        ...wearwell.sameLines(found)));
  }

  function result(found) {
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
    const decide = form('decide', {path: '/api/decide', picture: cost}, ...inputs('decide', strings.costs));
    place.questions = element('div', {hidden: true}, element('h3', {}, strings.lifeTitle), life, element('h3', {}, strings.decideTitle), element('p', {class: 'note'}, strings.decideLead), decide);
    place.none = element('p', {}, strings.noLives);
    place.cards = element('div', {class: 'cards', 'aria-live': 'polite'});
    panel.append(element('h2', {}, strings.askTitle), place.none, place.questions, place.cards);
  }

  wearwell.askPanel = {build, result};
})();
