'use strict';
// The step Compare: results of the folder side by side.
(() => {
  const {element, strings} = wearwell;
  const place = {};
  let page = '', known = '';

  const chosen = () => [...place.list.querySelectorAll('input:checked')].map((each) => each.value);

  // Best first, as the program ranks them.
  function ranking({comparable, studies}) {
    const number = (value) => (value === undefined ? '' : wearwell.given(Number(value.toPrecision(4))));
    const heads = [strings.result, strings.elpd, ...(comparable ? [strings.behind, strings.weight] : []), strings.trustedHead];
    const rows = studies.map((each) => [each.study, each.loo ? `${number(each.loo.elpd)} ± ${number(each.loo.se)}` : '',
      ...(comparable ? [each.behind ? `${number(each.behind.elpd)} ± ${number(each.behind.se)}` : '', each.weight === undefined ? '' : `${Math.round(100 * each.weight)} %`] : []),
      each.trusted ? strings.yes : strings.no]);
    return wearwell.table({id: 'ranking', caption: comparable ? strings.ranked : strings.notRanked, columns: heads, rows, all: rows.length});
  }

  async function compare() {
    const found = await wearwell.post('/api/compare', {results: chosen()});
    const {answer} = found;
    const frame = element('iframe', {title: strings.comparisonPage, sandbox: 'allow-scripts allow-downloads allow-popups'});
    const details = element('details', {}, element('summary', {}, strings.comparisonPage), frame);
    details.addEventListener('toggle', () => { if (details.open && !frame.src) frame.src = page; });
    const sentences = [answer.conclusion, answer.obstacle].filter(Boolean);
    place.answer.replaceChildren(...sentences.map((each) => element('p', {class: 'lead', lang: 'en'}, each)), ranking(answer),
        ...answer.cautions.map((each) => element('p', {class: 'note', lang: 'en'}, each)),
        element('details', {}, element('summary', {}, strings.wholeAnswer), element('pre', {class: 'answer', tabindex: 0, lang: 'en'}, found.text)), details,
        element('p', {}, element('a', {href: page, target: '_blank', rel: 'noopener'}, strings.comparisonTab)), ...wearwell.sameLines(found));
  }

  function session(now) {
    page = now.comparison ?? page;
    const names = now.files.results, key = names.join('\n');
    place.none.hidden = names.length > 1;
    place.form.hidden = names.length < 2;
    if (key === known) return;
    known = key;
    const before = new Set(chosen());
    place.list.replaceChildren(element('legend', {}, strings.results), ...names.map((name, i) => {
      const tick = element('input', {type: 'checkbox', id: `compare-${i}`, value: name});
      tick.checked = before.has(name);
      return element('label', {class: 'tick', for: tick.id}, tick, name);
    }));
  }

  function build(panel) {
    place.list = element('fieldset', {});
    place.form = element('form', {hidden: true}, place.list, element('button', {}, strings.compare));
    place.form.addEventListener('submit', (event) => { event.preventDefault(); wearwell.attempt(compare); });
    place.none = element('p', {}, strings.oneResult);
    place.answer = element('div', {id: 'comparison', 'aria-live': 'polite'});
    panel.append(element('h2', {}, strings.compareTitle), element('p', {}, strings.compareLead), place.none, place.form, place.answer);
  }

  wearwell.compare = {build, session};
})();
