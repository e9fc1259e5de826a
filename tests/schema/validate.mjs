// Validates results against docs/reference/summary.schema.json, and sees that the schema can refuse: every result with a key taken away, renamed
// or of another kind must be refused.
//
//   node validate.mjs NODE_MODULES SCHEMA SUMMARY...
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';

const [modules, schemaFile, ...summaries] = process.argv.slice(2);
const require = createRequire(join(resolve(modules), 'any.js'));
const Ajv = require('ajv/dist/2020').default;
const validate = new Ajv({allErrors: false, strict: true, strictTypes: false, strictRequired: false})
    .compile(JSON.parse(readFileSync(schemaFile, 'utf8')));

const faults = [];
const header = ['wearwell', 'schema', 'title', 'model', 'equation', 'data', 'seed', 'trusted', 'checks'];
for (const file of summaries) {
  const text = readFileSync(file, 'utf8');
  const result = JSON.parse(text);
  if (!validate(result)) faults.push(`${file}: ${validate.errors.map((e) => `${e.instancePath} ${e.message} ${JSON.stringify(e.params)}`).join('; ')}`);
  const first = Object.keys(result).slice(0, header.length);
  if (first.join() !== header.join()) faults.push(`${file} begins with ${first}`);
  for (const key of [...header, ...(result.model === 'selection' ? ['models', 'candidates'] : ['life-fleet', 'readings-fleet'].includes(result.model) ? ['fleet', 'failures'] : ['parameters', 'loo'])]) {
    for (const change of [(r) => delete r[key], (r) => { r[key] = {unknown: []}; }, (r) => { r[`${key}_`] = r[key]; }]) {
      if (key === 'loo' && change(structuredClone(result)) === true && result.model !== 'clutch-wear') continue;  // may be absent
      const changed = structuredClone(result);
      change(changed);
      if (validate(changed)) faults.push(`${file}: ${key} may be changed: ${change}`);
    }
  }
}
if (summaries.length === 0) faults.push('no summary given');
for (const fault of faults) console.log(fault);
console.log(faults.length ? 'FAILED' : 'passed');
process.exit(faults.length ? 1 : 0);
