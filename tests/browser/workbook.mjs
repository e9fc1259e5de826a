// A workbook (.xlsx) of sheets, as a Buffer: [[name, [[cells of a row], ...]], ...]. Numbers are cells of numbers, all else is text.
import {crc32} from 'node:zlib';

const xml = (text) => `<?xml version="1.0" encoding="UTF-8"?>${text}`;
const escaped = (text) => String(text).replace(/[&<>]/g, (each) => `&#${each.charCodeAt(0)};`);
const main = 'http://schemas.openxmlformats.org/spreadsheetml/2006/main', office = 'http://schemas.openxmlformats.org/officeDocument/2006/relationships';
const package_ = 'http://schemas.openxmlformats.org/package/2006', kind = 'application/vnd.openxmlformats-officedocument.spreadsheetml';

const cell = (value, at) => (value === '' ? '' : typeof value === 'number' ? `<c r="${at}"><v>${value}</v></c>` : `<c r="${at}" t="inlineStr"><is><t>${escaped(value)}</t></is></c>`);
const sheet = (rows) => xml(`<worksheet xmlns="${main}"><sheetData>${rows.map((cells, i) => `<row r="${i + 1}">${cells.map((each, k) => cell(each, `${'ABCDEFGH'[k]}${i + 1}`)).join('')}</row>`).join('')}</sheetData></worksheet>`);

// A zip without compression.
function zip(files) {
  const parts = [], directory = [];
  let at = 0;
  for (const [name, text] of files) {
    const path = Buffer.from(name), content = Buffer.from(text), head = Buffer.alloc(26);
    head.writeUInt16LE(20, 0);
    head.writeUInt32LE(crc32(content), 10);
    head.writeUInt32LE(content.length, 14);
    head.writeUInt32LE(content.length, 18);
    head.writeUInt16LE(path.length, 22);
    const end = Buffer.alloc(14);
    end.writeUInt32LE(at, 10);
    directory.push(Buffer.from('PK\x01\x02\x14\x00', 'latin1'), head, end, path);
    parts.push(Buffer.from('PK\x03\x04', 'latin1'), head, path, content);
    at += 30 + path.length + content.length;
  }
  const listed = Buffer.concat(directory), last = Buffer.alloc(22);
  last.write('PK\x05\x06', 'latin1');
  last.writeUInt16LE(files.length, 8);
  last.writeUInt16LE(files.length, 10);
  last.writeUInt32LE(listed.length, 12);
  last.writeUInt32LE(at, 16);
  return Buffer.concat([...parts, listed, last]);
}

export const workbook = (sheets) => zip([
  ['[Content_Types].xml', xml(`<Types xmlns="${package_}/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Override PartName="/xl/workbook.xml" ContentType="${kind}.sheet.main+xml"/>${sheets.map((_, i) => `<Override PartName="/xl/worksheets/sheet${i + 1}.xml" ContentType="${kind}.worksheet+xml"/>`).join('')}</Types>`)],
  ['_rels/.rels', xml(`<Relationships xmlns="${package_}/relationships"><Relationship Id="r1" Type="${office}/officeDocument" Target="xl/workbook.xml"/></Relationships>`)],
  ['xl/workbook.xml', xml(`<workbook xmlns="${main}" xmlns:r="${office}"><sheets>${sheets.map(([name], i) => `<sheet name="${escaped(name)}" sheetId="${i + 1}" r:id="s${i + 1}"/>`).join('')}</sheets></workbook>`)],
  ['xl/_rels/workbook.xml.rels', xml(`<Relationships xmlns="${package_}/relationships">${sheets.map((_, i) => `<Relationship Id="s${i + 1}" Type="${office}/worksheet" Target="worksheets/sheet${i + 1}.xml"/>`).join('')}</Relationships>`)],
  ...sheets.map(([, rows], i) => [`xl/worksheets/sheet${i + 1}.xml`, sheet(rows)])]);
