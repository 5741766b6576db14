'use strict';
// The connection: pictures in, input out, and what else the page shows.

const element = (id) => document.getElementById(id);
const canvas = element('picture');
const MAX_PX = 2.1e6;

/** What the page knows, and a promise of what it waits for. */
const status = {connected: false, viewer: -1, driver: -1, asking: -1, viewers: 0, frame: null, frames: 0, files: [], copied: '', said: ''};
const waiting = new Set();
function changed() {
  for (const one of [...waiting]) {
    if (!one.holds(status)) continue;
    waiting.delete(one);
    one.done(true);
  }
}
function until(holds) {
  return new Promise((done) => {
    waiting.add({holds, done});
    changed();
  });
}

// The token stays in this tab alone: a page that is loaded again still has it.
const TOKEN_KEY = 'sweepscope token';
function takeToken() {
  const given = new URLSearchParams(location.hash.slice(1)).get('token');
  if (given) {
    sessionStorage.setItem(TOKEN_KEY, given);
    history.replaceState(null, '', location.pathname);
  }
  return sessionStorage.getItem(TOKEN_KEY) || '';
}

let token = takeToken();
let socket = null;
let retry_ms = 500;

function note(text) {
  element('note').textContent = text;
  element('note').hidden = !text;
}

/** A note that a click removes; pictures do not. */
function say(text) {
  status.said = text;
  note(text);
  element('note').onclick = () => say('');
  changed();
}

function tell(message) {
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

const sender = new EventSender(tell);
const keys = new MouseAndKeys(canvas, element('keys'), sender, tell);
const touch = new Touch(canvas, keys, sender);
const uploader = new Uploader(tell, element('sending'), say);
let painter = null;

/** What the buttons for fingers leave of the window. */
const room = () => [innerWidth, Math.max(1, innerHeight - element('touch').offsetHeight)];

function ratio() {
  const [width, height] = room();
  const area = Math.max(1, width * height);
  return Math.max(1, Math.min(devicePixelRatio || 1, Math.sqrt(MAX_PX / area)));
}

function tellSize() {
  const scale = ratio(), [width, height] = room();
  tell({type: 'size', width: Math.round(width * scale), height: Math.round(height * scale), scale});
}

/** The driver's picture has the size of the window; another's is fitted into it. */
function fit() {
  const [width, height] = room();
  const scale = Math.min(width / canvas.width, height / canvas.height);
  canvas.style.width = `${canvas.width * scale}px`;
  canvas.style.height = `${canvas.height * scale}px`;
}

function shown(frame, of) {
  if (of !== socket) return;
  frame.at = performance.now();
  status.frame = frame;
  status.frames += 1;
  tell({type: 'shown', frame: frame.number});
  fit();
  note(status.said);
  changed();
}

function showCrew() {
  const drives = status.viewer === status.driver;
  const asked = drives && status.asking >= 0;
  element('who').textContent = asked ? `Viewer ${status.asking} asks for control.`
      : drives ? `${status.viewers} viewers, you drive` : `Viewer ${status.driver} drives`;
  element('ask').hidden = drives;
  element('ask').disabled = status.asking === status.viewer;
  element('give').hidden = element('keep').hidden = !asked;
  element('crew').hidden = status.viewers < 2;
}

function showFile(name, address) {
  const line = document.createElement('div');
  line.className = 'file';
  const link = document.createElement('a');
  link.href = address.replace(/^\//, '');
  link.download = name;
  link.textContent = `Download ${name}`;
  const away = document.createElement('button');
  away.textContent = '×';
  away.title = 'Dismiss';
  away.onclick = () => line.remove();
  line.append(link, away);
  for (const old of element('files').children) if (old.dataset.name === name) old.remove();
  line.dataset.name = name;
  element('files').append(line);
  while (element('files').children.length > 5) element('files').firstChild.remove();
}

function copied(text) {
  status.copied = text;
  const offer = () => {
    say('Click here to copy.');
    element('note').onclick = () => navigator.clipboard.writeText(text).finally(() => say(''));
  };
  if (navigator.clipboard) navigator.clipboard.writeText(text).catch(offer);
}

function hear(message) {
  if (message.type === 'state') {
    Object.assign(status, {viewer: message.viewer, driver: message.driver, asking: message.asking, viewers: message.viewers});
    document.title = message.title;
    canvas.style.cursor = message.cursor;
    showCrew();
  }
  if (message.type === 'download') {
    status.files.push(message);
    showFile(message.name, message.address);
  }
  if (message.type === 'upload') uploader.answered(message);
  if (message.type === 'copied') copied(message.text);
  changed();
}

/** Why the program will never let this page in; empty if it may. */
async function refusal() {
  try {
    const headers = {'Authorization': `Bearer ${token}`, 'X-Page-Origin': location.origin};
    const answer = await fetch('check', {headers, cache: 'no-store'});
    if (answer.status === 403)
      return 'The token of this address is not valid. Use the address that the program printed when it was started.';
    return answer.status === 409 || answer.status === 421 ? await answer.text() : '';
  } catch {
    return '';  // nobody answers: it may come back
  }
}

async function lost(event) {
  status.connected = false;
  socket = null;
  changed();
  if (event.code === 1008) return note(`The program ended the connection: ${event.reason}. Load the page again to continue.`);
  const why = await refusal();
  if (why) return note(why);
  note(event.code === 1013 ? 'Too many viewers. Trying again.' : 'The connection is lost. Trying again.');
  setTimeout(connect, retry_ms);
  retry_ms = Math.min(5000, retry_ms * 1.6);
}

function connect() {
  const address = new URL('socket', location.href);
  address.protocol = address.protocol.replace('http', 'ws');
  address.hash = '';
  const mine = new WebSocket(address, ['sweepscope.1', `token.${token}`]);
  mine.binaryType = 'arraybuffer';
  socket = mine;
  painter = new FramePainter(canvas, (frame) => shown(frame, mine));
  mine.onopen = () => {
    status.connected = true;
    retry_ms = 500;
    tellSize();
    changed();
  };
  mine.onmessage = (event) => {
    if (typeof event.data === 'string') hear(JSON.parse(event.data));
    else painter.paint(event.data);
  };
  mine.onclose = lost;
}

let resizing = null;
window.addEventListener('resize', () => {
  fit();
  clearTimeout(resizing);
  resizing = setTimeout(tellSize, 100);
});
window.addEventListener('hashchange', () => {
  token = takeToken();
  if (!socket) connect();
});
// Whoever leaves says so; a connection that breaks may come back.
window.addEventListener('pagehide', () => socket && socket.close(1000));
for (const what of ['ask', 'give', 'keep']) element(what).onclick = () => tell({type: 'control', what});
for (const button of document.querySelectorAll('[data-chord]')) {
  const parts = button.dataset.chord.split('+');
  const modifiers = (parts.includes('Shift') ? 1 : 0) | (parts.includes('Ctrl') ? 2 : 0);
  button.onclick = () => {
    sender.stroke(parts[parts.length - 1], modifiers);
    button.blur();  // keys are the explorer's again
  };
}
element('keyboard').onclick = () => keys.focus();
// A tablet may get or lose its mouse.
const coarse = matchMedia('(pointer: coarse)');
function showTouch() {
  element('touch').hidden = !coarse.matches;
  tellSize();
  changed();
}
coarse.addEventListener('change', showTouch);
showTouch();
// For tests, and for who looks under the hood.
window.sweepscope = {status, until, sender, uploader, canvas, connect, drop: () => socket && socket.close()};

if (token) connect();
else note('This address has no token. Use the address that the program printed when it was started.');
