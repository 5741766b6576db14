'use strict';
// Mouse and keyboard of the page, as the program's events.

const KEY_NAMES = {
  ' ': 'Space', 'Escape': 'Escape', 'Enter': 'Enter', 'Tab': 'Tab', 'Backspace': 'Backspace', 'Delete': 'Delete',
  'ArrowRight': 'Right', 'ArrowLeft': 'Left', 'ArrowUp': 'Up', 'ArrowDown': 'Down', 'PageUp': 'PageUp',
  'PageDown': 'PageDown', 'Home': 'Home', 'End': 'End', 'F1': 'F1', 'F10': 'F10',
};
// By the place on the keyboard, since their characters change with Shift.
const CODE_NAMES = {Comma: 'Comma', Period: 'Period', Minus: 'Minus', Equal: 'Plus', NumpadAdd: 'Plus', NumpadSubtract: 'Minus'};
const MOVES_MS = 8;

function keyName(event) {
  if (/^[a-z]$/i.test(event.key)) return event.key.toUpperCase();
  if (/^[0-9]$/.test(event.key)) return event.key;
  if (event.key === '+') return 'Plus';
  if (KEY_NAMES[event.key]) return KEY_NAMES[event.key];
  if (/^Digit[0-9]$/.test(event.code)) return event.code[5];
  return CODE_NAMES[event.code];
}

// Shift, Ctrl, Alt. A Mac's command key is Ctrl.
function modifiersOf(event) {
  return (event.shiftKey ? 1 : 0) | (event.ctrlKey || event.metaKey ? 2 : 0) | (event.altKey ? 4 : 0);
}

/** Collects events and sends them in order. Of moves in a row the last one counts. */
class EventSender {
  constructor(send) {
    this.send = send;
    this.number = 0;
    this.move = null;
    this.timer = null;
    this.sentAt = -Infinity;
  }

  moved(x, y) {
    this.move = ['move', x, y];
    const wait = this.sentAt + MOVES_MS - performance.now();
    if (wait <= 0) this.flush([]);
    else if (this.timer === null) this.timer = setTimeout(() => this.flush([]), wait);
  }

  flush(events) {
    clearTimeout(this.timer);
    this.timer = null;
    const all = this.move ? [this.move, ...events] : events;
    this.move = null;
    if (all.length === 0) return this.number;
    this.sentAt = performance.now();
    this.send({type: 'input', number: ++this.number, events: all});
    return this.number;
  }

  stroke(name, modifiers) {
    return this.flush([['key', name, true, modifiers], ['key', name, false, modifiers], ['key', name, false, 0]]);
  }
}

class MouseAndKeys {
  constructor(canvas, field, sender, tell) {
    this.canvas = canvas;
    this.field = field;
    this.sender = sender;
    this.tell = tell;
    canvas.addEventListener('pointerdown', (event) => this.button(event, true));
    canvas.addEventListener('pointerup', (event) => this.button(event, false));
    canvas.addEventListener('pointermove', (event) => this.moved(event));
    canvas.addEventListener('wheel', (event) => this.wheel(event), {passive: false});
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    document.addEventListener('keydown', (event) => this.key(event, true));
    document.addEventListener('keyup', (event) => this.key(event, false));
    document.addEventListener('paste', (event) => this.paste(event));
    window.addEventListener('blur', () => tell({type: 'blur'}));
    field.addEventListener('input', () => this.typed());
  }

  at(event) {
    const box = this.canvas.getBoundingClientRect();
    return [(event.clientX - box.left) * this.canvas.width / box.width,
            (event.clientY - box.top) * this.canvas.height / box.height];
  }

  button(event, down) {
    if (event.pointerType === 'touch') return;
    event.preventDefault();
    this.focus();
    if (down) this.canvas.setPointerCapture(event.pointerId);
    this.changed(event);
  }

  // Of several buttons only the first comes as an event of its own; the others are moves.
  changed(event) {
    this.sender.move = ['move', ...this.at(event)];
    const events = [];
    for (const [bit, button] of [[1, 0], [2, 1], [4, 2]]) {
      const down = (event.buttons & bit) !== 0;
      if (down !== ((this.held & bit) !== 0)) events.push(['press', button, down, modifiersOf(event)]);
    }
    this.held = event.buttons & 7;
    this.sender.flush(events);
  }

  moved(event) {
    if (event.pointerType === 'touch') return;
    if ((event.buttons & 7) !== (this.held & 7)) return this.changed(event);
    this.sender.moved(...this.at(event));
  }

  wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 100 : event.deltaY / 3;
    this.sender.move = ['move', ...this.at(event)];
    this.sender.flush([['wheel', Math.max(-20, Math.min(20, -lines))]]);
  }

  focus() {
    if (document.activeElement !== this.field) this.field.focus({preventScroll: true});
  }

  key(event, down) {
    const onButton = event.target instanceof Element && event.target.closest('button, a');
    if (event.isComposing || event.key === 'Process' || (onButton && event.key !== 'Escape')) return;
    const modifiers = modifiersOf(event);
    const name = keyName(event);
    // The paste event brings the text.
    if ((modifiers & 2) !== 0 && name === 'V') return;
    const character = [...event.key].length === 1 && (modifiers & 6) === 0;
    const altGr = event.getModifierState && event.getModifierState('AltGraph') && [...event.key].length === 1;
    if (!name && !character && !altGr) return;
    event.preventDefault();
    const events = [];
    if (name && !altGr) events.push(['key', name, down, modifiers]);
    if (down && (character || altGr)) events.push(['text', event.key]);
    if (events.length > 0) this.sender.flush(events);
  }

  // What a screen keyboard or an input method writes.
  typed() {
    const text = this.field.value;
    this.field.value = '';
    if (text) this.sender.flush([['text', text.slice(0, 60)]]);
  }

  paste(event) {
    event.preventDefault();
    const text = event.clipboardData ? event.clipboardData.getData('text/plain') : '';
    if (text) this.tell({type: 'paste', text: text.slice(0, 8000)});
  }
}
MouseAndKeys.prototype.held = 0;
