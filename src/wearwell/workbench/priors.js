'use strict';
// What the priors of a study say before any data: their curves, and the lives that they imply.
(() => {
  const {element, strings} = wearwell;

  const number = (value) => (value === null ? strings.never : wearwell.given(Number(value.toPrecision(3))));
  const range = ({q05, q50, q95, unit}) => strings.priorRange(number(q05), number(q95), number(q50), unit === '1' ? '' : wearwell.unit(unit));

  function picture(prior, width) {
    const name = prior.meaning && prior.meaning !== 'parameter' ? `${prior.name}: ${prior.meaning}` : prior.name;
    if (!prior.proper) return element('div', {}, element('p', {class: 'note'}, `${name}: ${strings.improper}`));
    const points = prior.x.map((each, i) => [each, prior.y[i]]);
    return element('div', {}, wearwell.scatter({points, line: true, bare: true, x: {name: prior.unit === '1' ? '' : `[${wearwell.unit(prior.unit)}]`, log: prior.log}, y: {name},
      description: `${name}: ${range(prior)}`, hint: range(prior), read: ([a]) => `${number(a)} ${prior.unit === '1' ? '' : wearwell.unit(prior.unit)}`}, width));
  }

  function table(quantities) {
    return wearwell.table({id: 'implied', caption: strings.implied, columns: [strings.quantity, '5 %', '50 %', '95 %', strings.unit],
      rows: quantities.map((each) => [each.name, number(each.q05), number(each.q50), number(each.q95), each.unit === '1' ? '' : wearwell.unit(each.unit)]), all: quantities.length});
  }

  // `asked`: {file, text} of a study that can be read.
  wearwell.priors = async (asked, width) => {
    const found = await wearwell.post('/api/priors', asked);
    return [element('div', {class: 'priors'}, ...found.priors.map((each) => picture(each, width))), found.quantities.length ? table(found.quantities) : null,
            found.obstacle ? element('p', {class: 'note'}, found.obstacle) : null].filter(Boolean);
  };
})();
