'use strict';
// The step Ask: questions about lives, each answer a card.
(() => {
  const {element, strings} = wearwell;
  const place = {};
  let count = 0, folder = '';

  function survival(answer) {
    const points = answer.survival.filter((each) => each.life !== null && each.survival > 0.004).map((each) => [each.life, each.survival]);
    if (points.length < 3) return null;
    return wearwell.scatter({points, line: true, x: {name: `${answer.name} [${wearwell.unit(answer.unit)}]`}, y: {name: strings.probability},
      description: `${strings.survivalTitle}: ${strings.probability}`, hint: '', read: ([a, b]) => `${wearwell.quantity(a, answer.unit, 4)}: ${wearwell.given(b)}`},
        Math.min(560, Math.max(280, place.cards.clientWidth - 40)));
  }

  async function ask() {
    const question = {result: folder};
    for (const each of place.form.elements) if (each.name && each.value) question[each.name] = each.value;
    if (!question.level) delete question.sides;
    const found = await wearwell.post('/api/life', question);
    count += 1;
    const picture = survival(found.answer);
    place.cards.prepend(element('article', {class: 'card', 'aria-label': strings.askedFor(count)}, element('pre', {class: 'answer', tabindex: 0}, found.text), picture,
        element('p', {class: 'note'}, strings.sameCommand), element('pre', {class: 'command', tabindex: 0}, found.command)));
  }

  function result(found) {
    folder = found.folder;
    place.none.hidden = found.lives;
    place.none.textContent = found.no_lives ?? strings.noLives;
    place.form.hidden = !found.lives;
    place.cards.replaceChildren();
  }

  function build(panel) {
    const sides = element('select', {id: 'ask-sides', name: 'sides'}, ...Object.entries(strings.sideNames).map(([value, text]) => element('option', {value}, text)));
    place.form = element('form', {class: 'fields', hidden: true}, ...Object.entries(strings.fields).map(([name, [label, example]]) => wearwell.field(label, `ask-${name}`, {name, placeholder: example})),
        element('div', {class: 'field'}, element('label', {for: 'ask-sides'}, strings.sides), sides), element('button', {}, strings.ask));
    place.form.addEventListener('submit', (event) => { event.preventDefault(); wearwell.attempt(ask); });
    place.none = element('p', {}, strings.noLives);
    place.cards = element('div', {class: 'cards', 'aria-live': 'polite'});
    panel.append(element('h2', {}, strings.askTitle), element('p', {}, strings.askLead), place.none, place.form, place.cards);
  }

  wearwell.askPanel = {build, result};
})();
