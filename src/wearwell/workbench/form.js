'use strict';
// The values of a study as a form. Each change is written into its text.
(() => {
  const {element, strings} = wearwell;

  // The meanings of keys are those of the reference, whose pages are not here.
  const plain = (text) => text.replace(/\s*\(?\[[^\]]*\]\([^)]*\)\)?/g, '').replaceAll('`', '').replace(/[:,]? see$/, '');

  // {panel, show(keys)}. A value that is refused leaves the text as it was.
  wearwell.valuesForm = (study) => {
    const panel = element('div', {class: 'form'});
    return {panel, show: (keys) => show(panel, study, keys)};
  };

  function show(panel, study, keys) {
    const typing = panel.contains(document.activeElement) && document.activeElement.matches('input, textarea') ? document.activeElement : null;
    const isTyped = typing && typing.value !== typing.dataset.built, caret = typing?.selectionStart;
    const groups = new Map();
    for (const key of keys) {
      const at = key.path.lastIndexOf('.');
      const group = at < 0 ? '' : key.path.slice(0, at);
      if (!groups.has(group)) groups.set(group, []);
      groups.get(group).push([key, key.path.slice(at + 1)]);
    }
    panel.replaceChildren(...[...groups].map(([group, inside]) => element('fieldset', {}, element('legend', {}, group || strings.wholeStudy),
        ...inside.map(([key, name]) => {
          const id = `key-${key.path}`;
          const make = key.value.includes('\n') ? wearwell.area : wearwell.field;
          const field = make(name, id, {value: key.value, placeholder: key.example, 'aria-describedby': key.meaning ? `${id}-meaning` : undefined});
          if (key.meaning) field.append(element('small', {id: `${id}-meaning`, lang: 'en'}, plain(key.meaning)));
          field.querySelector('input, textarea').dataset.built = key.value;
          field.querySelector('input, textarea').addEventListener('change', (event) => wearwell.attempt(async () => {
            const before = study.text();
            try {
              const {text: next} = await wearwell.post('/api/set', {text: before, path: key.path, value: event.target.value});
              if (study.text() === before) study.replace(next);
            } catch (error) {
              event.target.value = key.value;
              throw error;
            }
          }));
          return field;
        }))));
    const same = typing && document.getElementById(typing.id);
    if (!same) return;
    // What is being typed stays.
    if (isTyped) same.value = typing.value;
    same.focus();
    same.setSelectionRange(caret, caret);
  }
})();
