'use strict';
// Requests to the program, with the token of the address, and the stream of what changes.
(() => {
  const key = 'wearwell-token';
  if (/^#[0-9a-f]{32}$/.test(location.hash)) {
    sessionStorage.setItem(key, location.hash.slice(1));
    history.replaceState(null, '', location.pathname);
  }
  const token = sessionStorage.getItem(key);

  async function answer(path, request = {}) {
    const response = await fetch(path, {cache: 'no-store', ...request, headers: {Authorization: `Bearer ${token}`, ...request.headers}})
        .catch(() => { throw new Error(wearwell.strings.unreachable); });
    const json = await response.json().catch(() => ({}));
    if (!response.ok) throw Object.assign(new Error(json.error || wearwell.strings.status(response.status)), {status: response.status});
    return json;
  }

  wearwell.hasToken = () => Boolean(token);
  wearwell.get = (path, query = {}) => answer(`${path}?${new URLSearchParams(query)}`);
  wearwell.post = (path, body = {}) => answer(path, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
  wearwell.upload = (file, settings) => answer(`/api/upload?${new URLSearchParams({file: file.name, settings: JSON.stringify(settings)})}`,
      {method: 'POST', headers: {'Content-Type': 'application/octet-stream'}, body: file});

  async function listen(changed, state) {
    for (;;) {
      try {
        const response = await fetch('/api/events', {cache: 'no-store', headers: {Authorization: `Bearer ${token}`}});
        if (!response.ok) throw new Error(String(response.status));
        state('live');
        const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
        let text = '';
        for (;;) {
          const {done, value} = await reader.read();
          if (done) break;
          text += value;
          const events = text.split('\n\n');
          text = events.pop();
          for (const each of events) {
            const data = /^event: session\ndata: (.*)$/m.exec(each);
            if (data) changed(JSON.parse(data[1]));
          }
        }
      } catch {
        // tried again below
      }
      state('lost');
      await new Promise((done) => { setTimeout(done, 1500); });
    }
  }

  // Each event of the stream is the whole session; `state`: "live" or "lost". A browser has six connections to a program, so one tab
  // listens for all: the one that holds the lock, which passes on when it is closed.
  wearwell.follow = (changed, state) => {
    const name = `wearwell-${token}`, channel = new BroadcastChannel(name);
    let last = null;
    channel.addEventListener('message', ({data}) => {
      if (data === 'ask') { if (last) channel.postMessage(last); return; }
      state(data.state);
      if (data.session) changed(data.session);
    });
    channel.postMessage('ask');
    return navigator.locks.request(name, () => {
      last = {state: 'wait'};
      const pass = (next) => { last = {...last, ...next}; channel.postMessage(last); };
      return listen((session) => { changed(session); pass({session}); }, (now) => { state(now); pass({state: now}); });
    });
  };
})();
