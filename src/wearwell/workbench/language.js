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

  // `leave` keeps what a page that is loaded again would lose.
  wearwell.languageSwitch = (leave) => {
    const {element, strings} = wearwell;
    const select = element('select', {id: 'language', 'aria-label': strings.languages, autocomplete: 'off'},
        ...Object.entries(languages).map(([name, {language: own}]) => element('option', {value: name, lang: name, selected: name === language}, own)));
    select.addEventListener('change', () => { store(select.value); leave(); location.reload(); });
    return select;
  };
})();
