// The sentences of the workbench: both languages have the same keys, none is empty or in the other language, each is used, and no
// sentence stands in the scripts outside the tables. Without a browser.
// What the program says of a table (strings.program) stands in its sources, and what these say there is in the tables.
//
//   node workbench_strings.mjs SCRIPTS
import {readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';
import {runInNewContext} from 'node:vm';

const [scripts] = process.argv.slice(2);
const read = (name) => readFileSync(join(scripts, name), 'utf8');
const faults = [];
const check = (holds, fault) => { if (!holds) faults.push(fault); };

const {languages} = runInNewContext(`const wearwell = {};\n${read('strings_en.js')}\n${read('strings_de.js')}\nwearwell`, {});

// Keys that an object literal has twice: the later one would silently take the place of the earlier.
function repeatedKeys(text) {
  const open = [], repeated = [];
  let before = '';
  // After the quotation that begins at i; in a template, expressions can have quotations of their own.
  function behind(i) {
    const mark = text[i];
    for (i += 1; text[i] !== mark; i += 1) {
      if (text[i] === '\\') i += 1;
      else if (mark === '`' && text.startsWith('${', i)) {
        for (let depth = 0; ; i += 1) {
          if ('\'"`'.includes(text[i])) { i = behind(i) - 1; continue; }
          depth += text[i] === '{' ? 1 : text[i] === '}' ? -1 : 0;
          if (text[i] === '}' && depth === 0) break;
        }
      }
    }
    return i + 1;
  }
  for (let i = 0; i < text.length;) {
    if ('\'"`'.includes(text[i])) { i = behind(i); before = "'"; continue; }
    if (text.startsWith('//', i)) { i = text.indexOf('\n', i); continue; }
    const name = /^(\w+)(\s*:)?/.exec(text.slice(i, i + 80));
    if (name) {
      if (name[2] && '{,'.includes(before)) {
        if (open.at(-1)?.has(name[1])) repeated.push(name[1]);
        open.at(-1)?.add(name[1]);
      }
      before = 'a';
      i += name[0].length;
      continue;
    }
    if (text[i] === '{') open.push(new Set());
    if (text[i] === '}') open.pop();
    if (!/\s/.test(text[i])) before = text[i];
    i += 1;
  }
  return repeated;
}
check(repeatedKeys('x = {a: `${f({b: 1})}`, b: 2, c: {a: 1}}').length === 0 && repeatedKeys("x = {a: 'b: {', b: 1, a: 2}").join() === 'a', 'repeated keys are not found');
for (const name of ['strings_en.js', 'strings_de.js']) check(!repeatedKeys(read(name)).length, `${name} has twice: ${repeatedKeys(read(name))}`);

// Of each sentence its place, its text and its kind. A function is called with rising and with falling numbers, and shows each argument.
function sentences(table, place = '') {
  return Object.entries(table).flatMap(([key, value]) => {
    const here = place ? `${place}.${key}` : key;
    if (typeof value === 'object') return sentences(value, here);
    if (typeof value !== 'function') return [[here, String(value), 'text']];
    const rising = Array.from({length: value.length}, (_, i) => 7001 + i), falling = rising.toReversed();
    const texts = [value(...rising), value(...falling)];
    rising.forEach((each, i) => check(texts[0].includes(each) || texts[1].includes(falling[i]), `${here} drops its argument ${i + 1}: ${texts[0]}`));
    return [[here, texts[0], `function of ${value.length}`]];
  });
}

const tables = Object.entries(languages).map(([name, table]) => [name, new Map(sentences(table).map(([place, ...rest]) => [place, rest]))]);
check(tables.map(([name]) => name).join() === 'en,de', `languages: ${tables.map(([name]) => name)}`);
const [[, english], ...others] = tables;
check(english.size > 150, `only ${english.size} sentences`);
// Names of formats, numbers with units and abbreviations are the same in both.
const same = /^([^a-zA-Z]|Text|EUR|cycles|e|s)*$/;
for (const [name, table] of others) {
  for (const [place, [text, kind]] of english) {
    const [own, ownKind] = table.get(place) ?? [];
    check(own !== undefined, `${name} lacks ${place}`);
    if (own === undefined) continue;
    check(ownKind === kind, `${name}: ${place} is a ${ownKind}, in English a ${kind}`);
    check(own !== text || same.test(text), `${name}: ${place} is in English: ${text}`);
  }
  for (const place of table.keys()) check(english.has(place), `en lacks ${place} of ${name}`);
}
for (const [name, table] of tables)
  for (const [place, [text]] of table) check(text.trim() === text && text.length > 0, `${name}: ${place} is empty or has blanks at its ends`);

// Sentences of the program. Adjacent literals of C++ are one; between those of a table stand names.
const sources = join(scripts, '..'), literal = /"((?:[^"\\\n]|\\.)*)"(?:\s*"((?:[^"\\\n]|\\.)*)")*/g;
const literals = (code) => [...code.matchAll(literal)].map(([all]) => [...all.matchAll(/"((?:[^"\\\n]|\\.)*)"/g)].map(([, each]) => each).join('').replaceAll('\\"', '"'));
const said = readdirSync(sources, {recursive: true}).filter((each) => /^(study|workbench|models|input|infer)\/.*\.cpp$/.test(each)).map((each) => [each, readFileSync(join(sources, each), 'utf8')]);
const inSources = said.flatMap(([, code]) => literals(code)).join('\n');
const fragments = (sentence) => sentence.split(/\{[^}]*\}/);
for (const [key, english] of Object.entries(languages.en.program)) {
  for (const each of fragments(english)) check(inSources.includes(each.trim()), `program.${key}: the program does not say "${each}"`);
  for (const [name, {program}] of Object.entries(languages)) check(program[key]?.split('{}').length === english.split('{}').length, `${name}: program.${key} has other names`);
}
// Of readings, guesses and questions of a table.
const known = Object.values(languages.en.program).join('\n'), calls = /\b(?:guesses|taken|unstated|questions|readings)\.(?:push_back|emplace_back)\(|\bunstated_line\(|\bor_state\(|TableQuestion question\{|\bsaid\.(?:push_back|emplace_back)\(|\bstudy\.(?:taken|guesses|reading) = |\broles\.study\(/g;
let seen = 0;
for (const [name, code] of said.filter(([each]) => /^(study|models|workbench)/.test(each))) {
  for (const {0: call, index} of code.matchAll(calls)) {
    const end = code.slice(index).search(call.includes('study(') ? /ReadingFit/ : /;\n/);
    for (const sentence of literals(code.slice(index, index + end)).flatMap(fragments).filter((each) => /[a-z]{3} [a-z]{2}/.test(each))) {
      seen += 1;
      check(known.includes(sentence.trim()), `${name}: not in the tables: ${sentence}`);
    }
  }
}
check(seen > 60, `only ${seen} sentences of the program are found`);

// What scripts use, and what stands in them beside that.
const top = new Set(Object.keys(languages.en)), used = new Set();
const technical = /^(button:not\(:disabled\), .*|use strict|input:checked|allow-scripts allow-downloads allow-popups|study\.toml|data\..*|Bearer .*|Content-Type|scroll whole|callout (warn|fail)|fields sliders|random_effects\..*|http:\/\/www\.w3\.org\/1998\/Math\/MathML|choices question| label label-.*|\/api\/.*|M\$\{.*|(weak|p) = \{ distribution = .*|\\n\\n\[subpopulations\].*)$/;
for (const name of readdirSync(scripts).filter((each) => each.endsWith('.js') && !each.startsWith('strings_'))) {
  const code = read(name).replace(/^\s*\/\/.*$/gm, '').replace(/ \/\/ .*$/gm, '');
  for (const [, key] of code.matchAll(/\bstrings\.([A-Za-z_]+)/g)) {
    used.add(key);
    check(top.has(key), `${name}: strings.${key} is in no table`);
  }
  if (code.includes('strings[kind]')) for (const key of ['tables', 'studies', 'results']) used.add(key);
  for (const [, plain, filled] of code.matchAll(/'((?:[^'\\\n]|\\.)*)'|`((?:[^`\\]|\\.)*)`/g)) {
    const text = plain ?? filled.replace(/\$\{[^}]*\}/g, '');
    check(technical.test(text) || !/[A-Z][a-z]+|[a-z]+ [a-z]+|[a-z]{2}[.!?:]/.test(text) || /strings\b/.test(filled ?? ''), `${name}: not in the tables: ${text}`);
  }
  for (const [found] of code.matchAll(/(element\('[a-z]+', \{[^}]*\}, |textContent = |['"]aria-label['"]: |placeholder: |title: |button\(|field\()'[^']*[A-Za-z][^']*'/g)) check(false, `${name}: not in the tables: ${found}`);
}
const markup = read('workbench.html').replace(/<[^>]*>/g, '').replace(/\s+/g, ' ').trim();
check(markup === 'wearwell', `workbench.html: not in the tables: ${markup}`);
check(!/aria-label=|title=|alt=|placeholder=/.test(read('workbench.html')), 'workbench.html: a label is not in the tables');
for (const key of top) check(used.has(key) || key === 'language', `strings.${key} is used by no script`);

for (const each of faults) console.log(each);
process.exit(faults.length ? 1 : 0);
