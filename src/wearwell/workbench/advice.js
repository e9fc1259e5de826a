'use strict';
// Advice of a check that the page can follow: it changes the text of the study as the documents describe it.
(() => {
  const {element, strings} = wearwell;

  // The lines below the head of the one likelihood: [from, end].
  function likelihood(lines) {
    const heads = lines.flatMap((each, i) => (/^\s*\[likelihood(\.[^\]]+)?\]/.test(each) ? [i] : []));
    if (heads.length !== 1) return null;
    const end = lines.findIndex((each, i) => i > heads[0] && /^\s*\[/.test(each));
    return [heads[0] + 1, end < 0 ? lines.length : end];
  }

  const hasName = (text, name) => new RegExp(`^\\s*${name}\\s*=`, 'm').test(text);

  // A prior becomes the first line of [prior].
  function withPrior(lines, line) {
    const at = lines.findIndex((each) => /^\s*\[prior\]/.test(each));
    if (at >= 0) lines.splice(at + 1, 0, line);
    return at >= 0;
  }

  const changes = {
    // Each parameter that has a prior becomes one of each subpopulation.
    mixture(text) {
      const lines = text.split('\n'), inside = likelihood(lines);
      if (!inside || /^\s*\[subpopulations\]/m.test(text) || hasName(text, 'weak')) return null;
      let changed = 0;
      for (let i = inside[0]; i < inside[1]; ++i) {
        const found = /^(\s*\w+\s*=\s*")(\w+)(".*)$/.exec(lines[i]);
        if (!found || /^\s*(family|share_)/.test(lines[i]) || !hasName(text, found[2])) continue;
        lines[i] = `${found[1]}${found[2]}[subpopulation]${found[3]}`;
        changed += 1;
      }
      if (!changed || !withPrior(lines, 'weak = { distribution = "beta", alpha = 1, beta = 3 }')) return null;
      return `${lines.join('\n').trimEnd()}\n\n[subpopulations]\nnames = ["early", "wear-out"]\nshare = { early = "weak" }\n`;
    },
    share(text) {
      const lines = text.split('\n'), inside = likelihood(lines);
      if (!inside || hasName(text, 'share_defective') || hasName(text, 'p')) return null;
      const noted = lines.findIndex((each, i) => i >= inside[0] && i < inside[1] && /^\s*#\s*share_defective\b/.test(each));
      lines.splice(noted < 0 ? inside[0] : noted, noted < 0 ? 0 : 1, 'share_defective = "p"');
      return withPrior(lines, 'p = { distribution = "uniform", lower = 0, upper = 1 }') ? lines.join('\n') : null;
    },
    family(text, name) {
      const lines = text.split('\n'), inside = likelihood(lines);
      const at = inside ? lines.findIndex((each, i) => i >= inside[0] && i < inside[1] && /^\s*family\s*=\s*"/.test(each)) : -1;
      if (at < 0) return null;
      lines[at] = lines[at].replace(/"[^"]*"/, `"${name}"`);
      return lines.join('\n');
    },
  };

  // What an advice changes in the study of a result: under another name, so that both can be compared. Without a change: the families.
  function follow(folder, change, suffix) {
    const stem = wearwell.model.study.name().replace(/\.toml$/, '');
    if (folder !== `${stem}-results`) throw new Error(strings.adviceOf(folder));
    const next = change ? change(wearwell.model.study.text()) : wearwell.model.study.text();
    if (next === null) throw new Error(strings.adviceByHand);
    wearwell.step('model');
    if (!change) { const families = document.getElementById('families'); families.open = true; families.querySelector('summary').focus(); return; }
    wearwell.model.becomes(`${stem}-${suffix}.toml`, next);
  }

  // `line`: that of the status in [data.columns]; its comment stays. Null in another form.
  function withStatusWord(line, key, column, word) {
    const found = /^(\s*status\s*=\s*)("(?:[^"\\]|\\.)*"|'[^']*'|\{[^}#]*\})(\s*(?:#.*)?)$/.exec(line);
    if (!found) return null;
    const [, head, value, rest] = found;
    if (!value.startsWith('{')) return `${head}{ column = ${column}, ${key} = ${word} }${rest}`;
    const known = new RegExp(`\\b${key}\\s*=\\s*(?:\\[(.*?)\\]|("(?:[^"\\\\]|\\\\.)*"|'[^']*'|[^\\s,}"'\\[]+))`).exec(value);
    if (known ? /^\d/.test(known[2] ?? '') : new RegExp(`\\b${key}\\s*=`).test(value)) return null;  // a code 0 or 1 has no further words
    const next = known ? value.replace(known[0], () => `${key} = [${known[1] ?? known[2]}, ${word}]`) : value.replace(/\s*\}$/, () => `, ${key} = ${word} }`);
    return `${head}${next}${rest}`;
  }

  // What a word of the data means that is no status: null if the problem of a check is another one.
  wearwell.statusChoice = (problem) => {
    const named = /is not a status;[^]*status = \{ column = "([^"\\\n]*)", failure = "([^"\\\n]*)" \}/.exec(problem);
    if (!named) return null;
    const [column, word] = named.slice(1).map((each) => JSON.stringify(each)), {study} = wearwell.model;
    const write = (key) => wearwell.attempt(() => {
      const lines = study.text().split('\n'), at = study.keys().find(({path}) => /^data\.columns\.status(\.column)?$/.test(path))?.line;
      const next = at ? withStatusWord(lines[at - 1], key, column, word) : null;
      if (next === null) throw new Error(strings.adviceByHand);
      lines[at - 1] = next;
      study.replace(lines.join('\n'));
    });
    return element('fieldset', {class: 'choices'}, element('legend', {}, strings.statusWord(named[2])),
        ...Object.entries(strings.statusMeanings).map(([key, label]) => wearwell.button(label, () => write(key), 'plain')));
  };

  // The cell of an advice: its text, and a button for each change that the program names. `folder`: of the result.
  wearwell.adviceCell = ({advice, changes: named}, folder) => {
    const offer = (label, change, suffix) => wearwell.button(label, () => wearwell.attempt(() => follow(folder, change, suffix)), 'plain');
    const buttons = named.map((each) => {
      const [kind, name] = each.split(' ');
      if (kind === 'families') return offer(strings.tryFamilies, null);
      if (kind === 'family') return offer(strings.tryFamily(name), (text) => changes.family(text, name), name);
      return offer({mixture: strings.tryMixture, share: strings.tryShare}[kind], changes[kind], kind);
    });
    return element('td', {}, element('span', {lang: 'en'}, advice ?? ''), buttons.length ? element('div', {class: 'choices'}, ...buttons) : null);
  };
})();
