'use strict';
// Families of lives side by side, each fitted by maximum likelihood and drawn on its probability paper. One is chosen.
(() => {
  const {element, strings} = wearwell;

  const rounded = (value) => wearwell.given(Number(value.toPrecision(4)));
  const percent = (share) => `${Number((100 * share).toPrecision(4))} %`;

  function paper(each, found, width) {
    const unit = wearwell.unit(found.unit), name = `${found.life}${unit ? ` [${unit}]` : ''}`;
    return wearwell.scatter({points: each.points, curve: each.line, x: {name, log: true}, y: {name: strings.paperOf(each.paper), ticks: each.ticks.map(({at, share}) => ({at, text: percent(share)}))},
      description: strings.paperDescription(each.name, each.paper), hint: '', read: ([life]) => wearwell.quantity(life, found.unit, 4)}, width);
  }

  function card(each, found, width, choose) {
    const least = Math.min(...found.families.map(({aic}) => aic ?? Infinity)), own = each.name === found.family;
    const parameters = each.parameters.map(({name, value, unit}) => `${name} ${wearwell.quantity(value, unit, 4)}`).join(', ');
    const facts = each.problem ? strings.noMaximum : [strings.aic(rounded(each.aic), rounded(each.aic - least)), strings.logLikelihood(rounded(each.log_likelihood))].join('; ');
    const button = wearwell.button(strings.chooseFamily(each.name), () => choose(each), 'plain');
    button.setAttribute('aria-pressed', own);
    return element('article', {class: `family${own ? ' own' : ''}`, 'data-family': each.name, 'aria-label': each.name}, element('h4', {}, each.name), element('p', {class: 'note'}, facts),
        parameters ? element('p', {class: 'note', lang: 'en'}, parameters) : null, paper(each, found, width), button);
  }

  // A part of the step Model: {panel, update()}. After a choice the same families stay, and with them the way back.
  wearwell.families = (study) => {
    let found = null;
    const inside = element('div', {'aria-live': 'polite'}), panel = element('details', {id: 'families'}, element('summary', {}, strings.familiesTitle), inside);

    function show() {
      const choose = (each) => { found.family = each.name; study.replace(each.text); show(); inside.querySelector('[aria-pressed="true"]').focus(); };
      inside.replaceChildren(element('p', {class: 'note'}, strings.familiesLead(wearwell.count(found.lives), wearwell.count(found.failures))),
          element('div', {class: 'papers'}, ...found.families.map((each) => card(each, found, study.width() - 26, choose))));
    }

    function update() {
      if (!panel.open) return;
      const asked = study.asked(), known = found?.families.find(({text}) => text === asked.text);
      if (known) {
        if (found.family !== known.name) { found.family = known.name; show(); }
        return;
      }
      found = null;
      if (!study.isGood()) { inside.replaceChildren(element('p', {class: 'note'}, strings.checkBad)); return; }
      wearwell.quietly(async () => {
        try {
          const next = await wearwell.post('/api/families', asked);
          if (asked.text !== study.text()) return;
          found = next;
          show();
        } catch (error) {
          if (error.status !== 400) throw error;
          inside.replaceChildren(element('pre', {lang: 'en'}, error.message.split('\n')[0]));
        }
      });
    }
    panel.addEventListener('toggle', update);
    return {panel, update};
  };
})();
