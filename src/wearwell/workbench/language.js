'use strict';
// The language of the page: the one that was chosen, else the browser's, else English.
(() => {
  const key = 'wearwell-language', {languages} = wearwell;
  // A browser may forbid storage; the page then follows the browser's language.
  const stored = () => { try { return localStorage.getItem(key); } catch { return null; } };
  const store = (name) => { try { localStorage.setItem(key, name); } catch { /* lasts until the page is loaded again */ } };
  const wanted = [stored(), ...navigator.languages.map((each) => each.slice(0, 2).toLowerCase())];
  const language = wanted.find((each) => Object.hasOwn(languages, each)) ?? 'en';
  wearwell.strings = languages[language];
  document.documentElement.lang = language;

  // What the program says of a table: its sentences are those of the English table. Of two that fit the one with more words counts.
  const special = /[.*+?^${}()|[\]\\]/g, name = '{}', any = '([^]*?)';
  const sentences = language === 'en' ? [] : Object.entries(languages.en.program).map(([entry, english]) => {
    const between = english.split(name), plain = between.map((each) => each.replace(special, '\\$&'));
    return {words: between.join('').length, isWhole: between.length === 1, own: wearwell.strings.program[entry], pattern: new RegExp(`^${plain.join(any)}$`),
            isQuoted: between.map((each) => each.endsWith('\u0027'))};
  }).sort((a, b) => b.words - a.words);

  // In this language; null if the table does not have it. A name in quotation marks stays as it is.
  function translated(text, least = 0) {
    for (const {words, isWhole, own, isQuoted, pattern} of sentences) {
      const found = words >= least || isWhole ? pattern.exec(text) : null;
      if (!found) continue;
      const names = found.slice(1).map((each, i) => (isQuoted[i] ? each : phrase(each)));
      return own.split(name).reduce((made, each, i) => made + names[i - 1] + each);
    }
    return null;
  }

  // A phrase within a sentence, or several with "and" between them.
  function phrase(text) {
    const and = ({program}) => ` ${program.and} `, all = text.split(and(languages.en)).map((each) => translated(each, 10));
    return translated(text, 10) ?? (all.includes(null) ? text : all.join(and(wearwell.strings)));
  }

  // An element with a text of the program, which is English where the table does not have it.
  wearwell.ofProgram = (text) => translated(text) ?? text;
  wearwell.programElement = (name, attributes, text) => {
    const own = language === 'en' ? text : translated(text);
    return wearwell.element(name, {...attributes, lang: own === null ? 'en' : undefined}, own ?? text);
  };

  // `leave` keeps what a page that is loaded again would lose.
  wearwell.languageSwitch = (leave) => {
    const {element, strings} = wearwell;
    const select = element('select', {id: 'language', 'aria-label': strings.languages, autocomplete: 'off'},
        ...Object.entries(languages).map(([name, {language: own}]) => element('option', {value: name, lang: name, selected: name === language}, own)));
    select.addEventListener('change', () => { store(select.value); leave(); location.reload(); });
    return select;
  };
})();
