'use strict';
// Events of a unit: what was reported, and a form that reports another.
(() => {
  const {element, quantity, clock} = wearwell;
  const meanings = {
    replaced: 'a new part is installed', repaired: 'repaired in part', removed: 'taken out of service', failed: 'failed',
    sensor: 'sensor exchanged', installed: 'a part goes into service',
    corrected: 'reading corrected', withdrawn: 'reading withdrawn', cancelled: 'event cancelled',
    acknowledged: 'alarm acknowledged',
  };
  const byTime = (fleet) => fleet.keys === 'time';
  const keyText = (fleet, key) => (byTime(fleet) ? clock(key) : `no. ${wearwell.count(key)}`);

  function description(fleet, each) {
    if (each.event === 'cancelled') return `event ${each.cancels} cancelled`;
    if (each.event === 'acknowledged') return `alarm since ${clock(each.alarm_ms)} acknowledged`;
    const more = each.use !== undefined ? `, ${fleet.axis} ${quantity(each.use, fleet.axis_unit)}`
        : each.values ? `: ${Object.entries(each.values).map(([name, value]) => `${name} ${wearwell.number(value, 6)}`).join(', ')}`
        : each.restored !== undefined ? `, ${quantity(each.restored, fleet.level_unit)} taken back`
        : each.offset !== undefined ? `, shows ${quantity(each.offset, fleet.level_unit)} too much` : '';
    return `${meanings[each.event]}, ${keyText(fleet, each.key)}${more}`;
  }

  function listed(fleet, view) {
    if (view.events.length === 0) return element('p', {class: 'note'}, 'Nothing was reported but readings.');
    return element('ol', {class: 'events-list'}, ...[...view.events].reverse().map((each) => element('li', {class: each.cancelled ? 'cancelled' : ''},
        element('span', {class: 'number'}, `${each.number}.`),
        element('span', {}, element('span', {class: 'what'}, wearwell.capital(description(fleet, each))), each.cancelled ? ' (cancelled)' : '',
                each.note ? `. ${each.note}` : '', element('span', {class: 'note'}, ` · ${each.by}, ${clock(each.received_ms)}`)))));
  }

  let serial = 0;
  function field(label, input, unit) {
    input.id = `event-field-${++serial}`;
    return element('div', {class: 'field'}, element('label', {for: input.id}, unit ? `${label} (${wearwell.unit(unit) || '1'})` : label), input);
  }
  const numeric = (name) => element('input', {name, type: 'number', step: 'any', required: true, autocomplete: 'off'});

  // A time of this browser's zone, to the minute, for its own kind of field.
  function localTime(ms) {
    const at = new Date(ms - new Date(ms).getTimezoneOffset() * 60000);
    return at.toISOString().slice(0, 16);
  }

  function keyField(fleet, view, kind) {
    const last = view.last_key;
    const ofReading = kind === 'corrected' || kind === 'withdrawn';
    if (!byTime(fleet) || ofReading) {
      const input = element('input', {name: 'key', type: 'number', step: 1, required: true, value: ofReading || kind === 'failed' || kind === 'removed' ? last : last + 1});
      return field(byTime(fleet) ? 'Reading of (Unix time, ms)' : ofReading ? 'Reading number' : kind === 'failed' || kind === 'removed' ? 'Last reading, number' : 'From reading number', input);
    }
    return field('Time', element('input', {name: 'time', type: 'datetime-local', required: true, value: localTime(wearwell.now())}));
  }

  // The fields that a kind of event needs.
  function fieldsOf(fleet, view, kind) {
    if (kind === 'cancelled') return [field('Number of the event', element('input', {name: 'number', type: 'number', step: 1, min: 1, required: true}))];
    const fields = [keyField(fleet, view, kind)];
    if (kind === 'installed' || kind === 'replaced' || kind === 'failed') fields.push(field(`${wearwell.capital(fleet.axis)} on the counter`, numeric(fleet.axis), fleet.axis_unit));
    if (kind === 'installed' || kind === 'replaced') fields.push(field('Name of the part, if the study has it', element('input', {name: 'part_name', maxlength: 200, autocomplete: 'off'})));
    if (kind === 'repaired') fields.push(field('Amount that the repair takes back', numeric('restored'), fleet.level_unit));
    if (kind === 'sensor') fields.push(field('What the new sensor shows too much', numeric(fleet.level_column), fleet.level_unit));
    if (kind === 'corrected') {
      // As messages have them: the use on the counter, the level as the sensor shows it.
      for (const {name, unit} of fleet.columns) fields.push(field(wearwell.capital(name), unit === null ? element('input', {name, required: true}) : numeric(name), unit ?? ''));
    }
    return fields;
  }

  function bodyOf(form) {
    const body = {};
    for (const input of form.querySelectorAll('input, select')) {
      if (input.value === '' || input.name === '') continue;
      if (input.type === 'datetime-local') body.key = new Date(input.value).getTime();
      else body[input.name] = input.type === 'number' ? Number(input.value) : input.value;
    }
    return body;
  }

  // One form a unit: it stays as it is while the values around it change. `latest` is the unit as it is now.
  wearwell.eventForm = (fleet, latest, done) => {
    const {unit} = latest();
    const kinds = Object.keys(meanings).filter((kind) => kind !== 'acknowledged' && (!['sensor', 'repaired'].includes(kind) || fleet.level_column));
    const kind = element('select', {name: 'event', id: 'event-kind'}, ...kinds.map((each) => element('option', {value: each}, meanings[each])));
    const own = element('div', {class: 'fields'});
    const message = element('p', {class: 'note', role: 'status'});
    const choose = () => own.replaceChildren(...fieldsOf(fleet, latest(), kind.value));
    kind.addEventListener('change', choose);
    choose();
    const form = element('form', {class: 'event-form'},
        element('div', {class: 'fields'}, element('div', {class: 'field'}, element('label', {for: 'event-kind'}, 'Event'), kind)), own,
        element('div', {class: 'fields'}, field('Reported by', element('input', {name: 'by', required: true, maxlength: 200, autocomplete: 'name'})),
                field('Note', element('input', {name: 'note', maxlength: 1000, autocomplete: 'off'}))),
        element('button', {}, 'Report'), message);
    form.addEventListener('submit', async (event) => {
      event.preventDefault();
      message.className = 'note';
      message.textContent = 'Sending';
      try {
        const answer = await wearwell.send(`/api/v1/units/${encodeURIComponent(unit)}/events`, bodyOf(form));
        message.textContent = answer.events ? 'Stored. The forecast follows in a moment.' : answer.problem || 'This event is stored already.';
        choose();
        document.activeElement?.blur();  // the list above may change again
        done();
      } catch (error) {
        message.className = 'wrong';
        message.textContent = error.message;
      }
    });
    const report = element('details', {class: 'report'}, element('summary', {}, 'Report an event'), form);
    report.addEventListener('toggle', () => { if (report.open) choose(); });
    return report;
  };

  // A unit that is not known yet: its first event may come before its readings.
  wearwell.installForm = (fleet) => {
    const name = element('input', {maxlength: 200, required: true, autocomplete: 'off', spellcheck: 'false'});
    const message = element('p', {class: 'note', role: 'status'});
    const form = element('form', {class: 'event-form'},
        element('div', {class: 'fields'}, field(wearwell.capital(fleet.noun), name), ...fieldsOf(fleet, {last_key: 0}, 'installed')),
        element('div', {class: 'fields'}, field('Reported by', element('input', {name: 'by', required: true, maxlength: 200, autocomplete: 'name'})),
                field('Note', element('input', {name: 'note', maxlength: 1000, autocomplete: 'off'}))),
        element('button', {}, 'Report'), message);
    const known = async (unit) => {
      const count = 100;
      for (let offset = 0; ; offset += count) {
        const {matching, units} = await wearwell.ask(`/api/v1/units?search=${encodeURIComponent(unit)}&offset=${offset}&count=${count}`);
        if (units.some((each) => each.unit === unit)) return true;
        if (offset + count >= matching) return false;
      }
    };
    form.addEventListener('submit', async (event) => {
      event.preventDefault();
      message.className = 'note';
      message.textContent = 'Sending';
      try {
        const path = `/api/v1/units/${encodeURIComponent(name.value)}`;
        if (await known(name.value)) throw new Error(`${name.value} is known already: open it and report the event there.`);
        const answer = await wearwell.send(`${path}/events`, {...bodyOf(form), event: 'installed'});
        message.textContent = answer.events ? `Stored: ${name.value} goes into service with its first reading.` : answer.problem || 'This event is stored already.';
        name.value = '';
      } catch (error) {
        message.className = 'wrong';
        message.textContent = error.message;
      }
    });
    return element('details', {class: 'report install'}, element('summary', {}, `Put a new ${fleet.noun} into service`), form);
  };

  // One a unit, as above: it says who has acknowledged the alarm, or asks.
  wearwell.acknowledgement = (latest, done) => {
    const message = element('p', {class: 'note', role: 'status'}), by = element('p', {class: 'note'});
    const form = element('form', {class: 'event-form'},
        element('div', {class: 'fields'}, field('Your name', element('input', {name: 'by', required: true, maxlength: 200, autocomplete: 'name'})),
                field('Note', element('input', {name: 'note', maxlength: 1000, autocomplete: 'off'})), element('button', {}, 'Acknowledge alarm')), message);
    form.addEventListener('submit', async (event) => {
      event.preventDefault();
      const {unit, alarm_ms: since} = latest();
      try {
        await wearwell.send(`/api/v1/units/${encodeURIComponent(unit)}/events`, {...bodyOf(form), event: 'acknowledged', alarm_ms: since});
        message.className = 'note';
        message.textContent = 'Stored.';
        document.activeElement?.blur();
        done();
      } catch (error) {
        message.className = 'wrong';
        message.textContent = error.message;
      }
    });
    const all = element('section', {class: 'acknowledgement'}, by, form);
    return {
      element: all,
      update: (view) => {
        const calls = ['watch', 'act', 'doubt'].includes(view.alarm) && view.alarm_ms > 0;
        all.hidden = !calls;
        by.hidden = !view.acknowledged_by;
        by.textContent = view.acknowledged_by ? `Alarm acknowledged by ${view.acknowledged_by}.` : '';
        form.hidden = Boolean(view.acknowledged_by);
        if (form.hidden) message.textContent = '';
      },
    };
  };

  wearwell.eventSection = (fleet, view, form) => element('section', {class: 'events'}, element('h3', {}, 'Events'), listed(fleet, view), form);
})();
