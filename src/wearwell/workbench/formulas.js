'use strict';
// The formulas of a study beneath its text, typeset as one types. The program reads the expressions; here they become elements.
(() => {
  const {element, strings} = wearwell;
  const namespace = 'http://www.w3.org/1998/Math/MathML';

  // [tag, text, [elements]] -> MathML. Text is inserted as text.
  function math([tag, text, children]) {
    const made = document.createElementNS(namespace, tag);
    made.append(text, ...children.map(math));
    return made;
  }

  // {panel, show(formulas)}. An expression with an error keeps what stood there; the check names the error.
  wearwell.formulas = () => {
    const list = element('ul', {class: 'formulas'}), panel = element('div', {id: 'formulas', hidden: true}, element('h3', {}, strings.formulasTitle),
        element('div', {class: 'scroll whole', tabindex: 0, role: 'region', 'aria-label': strings.formulasTitle}, list));
    const known = new Map();

    function line({path, math: found}) {
      if (found) known.set(path, found);
      const drawn = found ?? known.get(path);
      if (!drawn) return element('li', {'data-path': path}, element('code', {}, path), ' ', element('small', {}, strings.formulaError));
      const whole = document.createElementNS(namespace, 'math');
      whole.setAttribute('display', 'block');
      whole.append(math(drawn));
      return element('li', {'data-path': path, class: found ? '' : 'stale'}, whole, found ? null : element('small', {class: 'bad'}, strings.formulaError));
    }

    function show(formulas) {
      for (const path of known.keys()) if (!formulas.some((each) => each.path === path)) known.delete(path);
      panel.hidden = !formulas.length;
      list.replaceChildren(...formulas.map(line));
    }
    return {panel, show};
  };
})();
